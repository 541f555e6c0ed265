//! The largest handles with their check: of short curves in one, of long ones part by part, so that
//! what a part needs stays in the cache.
//!
//! Everything is local. A part that begins and ends some segments early and late is a polygon of its
//! own, worked on by the same code as a whole one, to the same bits.

use std::ops::{Range, RangeInclusive};

use rayon::prelude::*;
use shapespline_criteria::{Calls, Checker, Faults};
use shapespline_geometry::{DVec3, DataPolygon};

use crate::{HandleOptions, handles::Handles};

/// Segments of a part.
const PART: usize = 512;

/// Segments on either side of it that its handles and their check depend on: the handles at a node
/// depend on the bounds of two segments, these on the tangents at three nodes.
const BESIDE: usize = 2;

/// Parts from which on a curve counts as long.
const PARTS: usize = 16;

/// Handles, and what a check of them found.
pub(crate) struct Checked {
    pub(crate) legs: Vec<[DVec3; 2]>,
    /// What closed forms shortened the handles by; the smaller factor at each distinct node.
    pub(crate) factors: Vec<f64>,
    /// The segments that fail, ascending.
    pub(crate) faults: Vec<(usize, Faults)>,
    /// How many segments each criterion applies to.
    pub(crate) applicable: [usize; 6],
}

/// The largest handles within the bounds, checked. Cost O(N), on all threads for long open curves.
pub(crate) fn limited(polygon: &DataPolygon, options: &HandleOptions) -> Checked {
    let n = polygon.segments();
    // The parts of a closed curve would wrap around.
    if polygon.is_closed() || n < PARTS * PART {
        let planar = Calls::is_planar(polygon, &options.tolerances);
        return of_part(polygon, 0..n, planar, options, |handles| handles.into_legs_and_factors());
    }
    let parts = n.div_ceil(PART);
    let nodes = |k: usize| -> RangeInclusive<usize> {
        (k * PART).saturating_sub(BESIDE)..=((k + 1) * PART + BESIDE).min(n)
    };
    let planar = (0..parts)
        .into_par_iter()
        .all(|k| Calls::is_planar(&polygon.part(nodes(k)), &options.tolerances));
    let work = |(k, legs): (usize, &mut [[DVec3; 2]])| {
        let (nodes, last) = (nodes(k), k + 1 == parts);
        let offset = *nodes.start();
        let own = k * PART - offset..k * PART - offset + legs.len();
        let part = polygon.part(nodes);
        let mut checked = of_part(&part, own.clone(), planar, options, |handles| {
            legs.copy_from_slice(&handles.legs()[own.clone()]);
            // The last part has one more node, the end of the curve.
            (Vec::new(), handles.factors()[own.start..own.end + usize::from(last)].to_vec())
        });
        checked.faults.iter_mut().for_each(|(segment, _)| *segment += offset);
        checked
    };
    // Fresh memory from the system is zero: nothing is written twice.
    let mut legs = bytemuck::zeroed_vec(n);
    let checked: Vec<Checked> = legs.par_chunks_mut(PART).enumerate().map(work).collect();
    let (factors, faults) = (Vec::with_capacity(n + 1), Vec::new());
    let mut whole = Checked { legs, factors, faults, applicable: [0; 6] };
    for part in checked {
        whole.factors.extend(part.factors);
        whole.faults.extend(part.faults);
        for (sum, count) in whole.applicable.iter_mut().zip(part.applicable) {
            *sum += count;
        }
    }
    whole
}

/// The same of its own segments of a part; `take` takes the legs and factors that are wanted.
fn of_part(
    part: &DataPolygon,
    own: Range<usize>,
    planar: bool,
    options: &HandleOptions,
    take: impl FnOnce(Handles<'_>) -> (Vec<[DVec3; 2]>, Vec<f64>),
) -> Checked {
    let checker = Checker::of_part(part, planar, options.criteria, options.tolerances);
    let handles = Handles::limited(part, checker.calls(), options);
    let faults = own
        .clone()
        .map(|i| (i, checker.faults(i, handles.legs()[i])))
        .filter(|(_, faults)| !faults.is_empty())
        .collect();
    let (legs, factors) = take(handles);
    Checked { legs, factors, faults, applicable: checker.applicable(own) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::Continuity;

    /// Part by part to the same bits as in one, where planes, lines and turns lie across the seams.
    #[test]
    fn parts_agree_with_the_whole() {
        let n = PARTS * PART + 77;
        let at = |k: usize| {
            let t = 0.37 * k as f64;
            let lift = if (k / 700).is_multiple_of(3) { 0.0 } else { (1.3 * t).cos() };
            let bend = if k / 300 % 4 == 1 { 0.0 } else { (0.4 * t).sin() };
            DVec3::new(t, bend, lift)
        };
        for planar in [false, true] {
            let points = |k| if planar { at(k) * DVec3::new(1.0, 1.0, 0.0) } else { at(k) };
            let points: Vec<DVec3> = (0..=n).map(points).collect();
            let tangents = Boundary::Tangents { start: DVec3::X, end: DVec3::Y };
            for boundary in [Boundary::ZeroCurvature, Boundary::Circular, tangents] {
                let polygon =
                    DataPolygon::new(points.clone(), &Parametrization::Centripetal, boundary)
                        .unwrap();
                for continuity in [Continuity::C1, Continuity::G1] {
                    let options = HandleOptions { continuity, ..HandleOptions::default() };
                    let parts = limited(&polygon, &options);
                    let flat = Calls::is_planar(&polygon, &options.tolerances);
                    assert_eq!(flat, planar);
                    let whole = of_part(&polygon, 0..n, flat, &options, |handles| {
                        handles.into_legs_and_factors()
                    });
                    assert_eq!(parts.legs, whole.legs);
                    assert_eq!(parts.factors, whole.factors);
                    assert_eq!(parts.faults, whole.faults);
                    assert_eq!(parts.applicable, whole.applicable);
                    assert!(whole.factors.iter().any(|&f| f < 1.0));
                    // Coplanarity is asked for in space only.
                    assert_eq!(whole.applicable[3] > 0, !planar);
                }
            }
        }
    }
}
