// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest handles with their check, stretch by stretch, so that what a stretch needs stays in the
//! cache. Everything is local: stretches know nothing of each other.

use rayon::prelude::*;
use shapespline_banded::SolveError;
use shapespline_criteria::{Calls, StretchChecker};
use shapespline_geometry::{DVec3, DataPolygon, Stretch};

use crate::{
    Directions, HandleOptions, balanced,
    stretch::{Found, StretchHandles},
};

/// Segments that a thread works through at least.
const PART: usize = 8 * Stretch::OWN;

/// Parts from which on a curve counts as long.
const PARTS: usize = 16;

/// Handles, and what a check of them found.
pub(crate) struct Checked {
    pub(crate) legs: Vec<[DVec3; 2]>,
    /// What closed forms shortened the handles by; the smaller factor at each distinct node.
    pub(crate) factors: Vec<f64>,
    pub(crate) found: Found,
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
            let planar = Calls::is_planar(polygon, &options.tolerances);
            Some(balanced::tangents(polygon, options.tolerances.zero, planar)?)
        }
        Directions::Parametrization => None,
    };
    let tangents = tangents.as_deref();
    let checker = StretchChecker::new(polygon, options.criteria, options.tolerances);
    // Fresh memory from the system is zero: nothing is written twice.
    let mut legs: Vec<[DVec3; 2]> = bytemuck::zeroed_vec(n);
    let mut factors: Vec<f64> = bytemuck::zeroed_vec(polygon.nodes());

    // The part that begins at a segment, and the factor at its end.
    let work = |handles: &mut StretchHandles,
                start: usize,
                (legs, factors): (&mut [[DVec3; 2]], &mut [f64])| {
        let (mut found, mut last) = (Found::default(), 1.0);
        let stretches = legs.chunks_mut(Stretch::OWN).zip(factors.chunks_mut(Stretch::OWN));
        for (k, out) in stretches.enumerate() {
            let first = start + k * Stretch::OWN;
            let own = first..first + out.0.len();
            last = handles.make((polygon, tangents), &checker, options, own, out, &mut found);
        }
        (found, last)
    };
    let (found, last) = if n < PARTS * PART {
        let handles = &mut StretchHandles::default();
        work(handles, 0, (&mut legs, &mut factors[..n]))
    } else {
        let parts = legs.par_chunks_mut(PART).zip(factors[..n].par_chunks_mut(PART)).enumerate();
        let parts: Vec<(Found, f64)> = parts
            .map_init(StretchHandles::default, |handles, (k, out)| work(handles, k * PART, out))
            .collect();
        parts
            .into_iter()
            .fold((Found::default(), 1.0), |(found, _), (part, last)| (found.and(part), last))
    };
    // An open curve has one more node, its end.
    factors[n..].fill(last);
    Ok(Checked { legs, factors, found })
}
