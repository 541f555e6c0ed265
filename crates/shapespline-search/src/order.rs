// SPDX-License-Identifier: MIT OR Apache-2.0

//! The order in which tensions are lowered, and which of them tie.
//!
//! Keys are made of lengths, curvatures and angles around a node, rounded, so that neither the direction in
//! which points are numbered nor position, orientation, mirror images and scale have a say.

use shapespline_geometry::{DVec3, DataPolygon, length};

use crate::{
    TensionFamily,
    bending::end_curvature,
    surroundings::{Surroundings, compare},
};

/// Logarithms are rounded to this: smaller differences are rounding, or where bisection happened to end.
const BUCKET: f64 = 1e-6;

/// Curvatures below this part of the reciprocal mean chord count as zero.
const STRAIGHT: f64 = 1e-6;

/// What a tension is sorted by, in this order; what is around it decides the rest.
#[derive(Clone, Copy)]
struct Key {
    /// Curvature, tension, and the chords on its own side and the other: where several tensions hold each other
    /// up, the curve mostly bends less if those beside long chords go first.
    numbers: [f64; 4],
    node: usize,
    /// The side that counts first: 0 before the node, 1 after it.
    side: usize,
    tension: usize,
}

/// A logarithm in whole buckets; minus infinity of zero.
fn bucket(x: f64) -> f64 {
    // Zero without a sign, which would break ties.
    (x.ln() / BUCKET).round() + 0.0
}

/// Tensions that tie, by index: those at the sharpest ends of segments first, then the heaviest, then
/// those beside the longest chords, then by what is around. `unit`: [`mean_chord`].
pub(crate) fn sorted_groups<F: TensionFamily>(
    open: &[usize],
    polygon: &DataPolygon,
    family: &F,
    unit: f64,
    around: &mut Surroundings,
) -> Vec<Vec<usize>> {
    let mut keys: Vec<Key> =
        open.iter().map(|&k| Key::new(k, polygon, family, unit, around)).collect();
    let mut compare = |a: &Key, b: &Key| {
        let numbers = compare(&a.numbers, &b.numbers);
        numbers.then_with(|| around.compare(polygon, [a.node, a.side], [b.node, b.side]))
    };
    // Largest first.
    keys.sort_by(|a, b| compare(b, a));
    keys.chunk_by(|a, b| compare(a, b).is_eq())
        .map(|tied| tied.iter().map(|key| key.tension).collect())
        .collect()
}

impl Key {
    fn new<F: TensionFamily>(
        tension: usize,
        polygon: &DataPolygon,
        family: &F,
        unit: f64,
        around: &mut Surroundings,
    ) -> Self {
        let node = tension / F::SIDES;
        let either = F::SIDES == 1;
        let side = if either {
            // The larger of the two.
            usize::from(around.compare(polygon, [node, 0], [node, 1]).is_lt())
        } else {
            tension % F::SIDES
        };
        let sharp = |side| sharpness(polygon, family, node, side) * unit;
        let sharp = if either { sharp(0).max(sharp(1)) } else { sharp(side) };
        // Of what is straight rounding has the say.
        let sharp = if sharp > STRAIGHT { sharp } else { 0.0 };
        let [own, other] = [side, 1 - side].map(|side| {
            let chord = beside(polygon, node, side).map_or(DVec3::ZERO, |i| polygon.chord(i));
            bucket(length(chord) / unit)
        });
        let numbers = [bucket(sharp), bucket(family.tension()[tension]), own, other];
        Self { numbers, node, side, tension }
    }
}

pub(crate) fn mean_chord(polygon: &DataPolygon) -> f64 {
    let n = polygon.segments();
    (0..n).map(|i| length(polygon.chord(i)) / n as f64).sum()
}

/// The segment on a side of a node, unless an open end is there.
fn beside(polygon: &DataPolygon, node: usize, side: usize) -> Option<usize> {
    let n = polygon.segments();
    match (side, polygon.is_closed()) {
        (0, true) => Some((node + n - 1) % n),
        (0, false) => node.checked_sub(1),
        (_, true) => Some(node % n),
        (_, false) => (node < n).then_some(node),
    }
}

/// Curvature at a node, on the side of the segment before or after it.
fn sharpness<F: TensionFamily>(polygon: &DataPolygon, family: &F, node: usize, side: usize) -> f64 {
    let Some(segment) = beside(polygon, node, side) else { return 0.0 };
    let [a, c] = family.end_legs(segment);
    end_curvature(polygon.chord(segment), if side == 0 { [c, a] } else { [a, c] })
}
