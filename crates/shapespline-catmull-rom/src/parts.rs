// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest handles with their check, batch by batch, so that what a batch needs stays in the
//! cache. Everything is local: batches know nothing of each other.

use shapespline_banded::SolveError;
use shapespline_criteria::{Requirements, batch::BatchChecker};
use shapespline_geometry::{DVec3, DataPolygon, batch::SegmentBatch};
use shapespline_polynomial::parallel;

use crate::{
    Directions, HandleOptions, balanced,
    batch::{BatchHandles, HandleScan},
};

/// Segments that a thread works through at least.
const PART: usize = 8 * SegmentBatch::OWN;

/// Parts from which on a curve counts as long.
const PARTS: usize = 16;

/// Handles, and what a check of them found.
pub(crate) struct Checked {
    pub(crate) legs: Vec<[DVec3; 2]>,
    /// What closed forms shortened the handles by; the smaller factor at each distinct node.
    pub(crate) factors: Vec<f64>,
    pub(crate) found: HandleScan,
}

/// The largest handles within the bounds, checked. Cost O(N), on all threads for long curves.
///
/// # Errors
/// Balanced directions of angles that f64 cannot hold.
pub(crate) fn limited(
    polygon: &DataPolygon,
    options: &HandleOptions,
) -> Result<Checked, SolveError> {
    let n = polygon.segments();
    let tangents = match options.directions {
        Directions::Balanced => {
            let planar = Requirements::is_planar(polygon, &options.tolerances);
            Some(balanced::tangents(polygon, options.tolerances.zero, planar)?)
        }
        Directions::Parametrization => None,
    };
    let tangents = tangents.as_deref();
    let checker = BatchChecker::new(polygon, options.criteria, options.tolerances);
    // Fresh memory from the system is zero: nothing is written twice.
    let mut legs: Vec<[DVec3; 2]> = bytemuck::zeroed_vec(n);
    let mut factors: Vec<f64> = bytemuck::zeroed_vec(polygon.nodes());

    // The part that begins at a segment, and the factor at its end.
    let work = |handles: &mut BatchHandles,
                start: usize,
                (legs, factors): (&mut [[DVec3; 2]], &mut [f64])| {
        let (mut found, mut last) = (HandleScan::default(), 1.0);
        let batches = legs.chunks_mut(SegmentBatch::OWN).zip(factors.chunks_mut(SegmentBatch::OWN));
        for (k, out) in batches.enumerate() {
            let first = start + k * SegmentBatch::OWN;
            let own = first..first + out.0.len();
            last = handles.make((polygon, tangents), &checker, options, own, out, &mut found);
        }
        (found, last)
    };
    let all = (&mut *legs, &mut factors[..n]);
    let parts: Vec<(HandleScan, f64)> =
        parallel::parts(all, PART, PARTS * PART, BatchHandles::default, work);
    let (found, last) = parts
        .into_iter()
        .fold((HandleScan::default(), 1.0), |(found, _), (part, last)| (found.and(part), last));
    // An open curve has one more node, its end.
    factors[n..].fill(last);
    Ok(Checked { legs, factors, found })
}
