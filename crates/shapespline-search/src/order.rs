//! The order in which tensions are lowered, and which of them tie.
//!
//! Keys are made of lengths and curvatures around a node, rounded, so that neither the direction in which
//! points are numbered nor position, orientation, mirror images and scale have a say.

use shapespline_geometry::{DataPolygon, length};

use crate::TensionFamily;

/// Logarithms are rounded to this: smaller differences are rounding, or where bisection happened to end.
const BUCKET: f64 = 1e-6;

/// Curvatures below this part of the reciprocal mean chord count as zero.
const STRAIGHT: f64 = 1e-6;

/// Which of two tensions that are alike else is tried first, by the chords beside them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Chords {
    /// The one beside the shorter chord.
    ShortFirst,
    /// The one beside the longer chord.
    LongFirst,
}

/// What tensions are sorted by, in this order.
type Key = [f64; 6];

fn bucket(x: f64) -> f64 {
    (x.ln() / BUCKET).round()
}

/// Tensions that tie, by index: those at the sharpest ends of segments first, then the heaviest, then by
/// the chords beside them.
pub(crate) fn sorted_groups<F: TensionFamily>(
    open: &[usize],
    polygon: &DataPolygon,
    family: &F,
    chords: Chords,
) -> Vec<Vec<usize>> {
    let unit = mean_chord(polygon);
    let key = |k: usize| -> Key {
        let (node, side) = (k / F::SIDES, k % F::SIDES);
        let sharp = |side| {
            let sharp = sharpness(polygon, family, node, side) * unit;
            // Of what is straight rounding has the say.
            if sharp > STRAIGHT { sharp } else { 0.0 }
        };
        let [before, after] = [0, 1].map(|side| chords_beside(polygon, node, side, unit));
        let (sharp, [own, other]) = match (F::SIDES, side) {
            // Either side counts.
            (1, _) => {
                let order = if before >= after { [before, after] } else { [after, before] };
                (sharp(0).max(sharp(1)), order)
            }
            (_, 0) => (sharp(0), [before, after]),
            _ => (sharp(1), [after, before]),
        };
        let sign = if chords == Chords::LongFirst { 1.0 } else { -1.0 };
        let [near, next, far, last] = [own[0], other[0], own[1], other[1]].map(|x| sign * x);
        [bucket(sharp), bucket(family.tension()[k]), near, next, far, last]
    };
    groups(open.iter().map(|&k| (key(k), vec![k])).collect())
}

/// Sorts by key, largest first, and joins what has the same.
fn groups(mut keyed: Vec<(Key, Vec<usize>)>) -> Vec<Vec<usize>> {
    let compare = |a: &Key, b: &Key| {
        let orders = a.iter().zip(b).map(|(a, b)| b.total_cmp(a));
        orders.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    keyed.sort_by(|a, b| compare(&a.0, &b.0));
    let same = |a: &(Key, _), b: &(Key, _)| compare(&a.0, &b.0).is_eq();
    let join = |tied: &[(Key, Vec<usize>)]| tied.iter().flat_map(|(_, k)| k).copied().collect();
    keyed.chunk_by(same).map(join).collect()
}

fn mean_chord(polygon: &DataPolygon) -> f64 {
    let n = polygon.segments();
    (0..n).map(|i| length(polygon.chord(i)) / n as f64).sum()
}

/// The segment on a side of a node, counted outwards; at an open end the last one again.
fn beside(polygon: &DataPolygon, node: usize, side: usize, steps: usize) -> usize {
    let n = polygon.segments();
    match (side, polygon.is_closed()) {
        (0, true) => (node + n - 1 - steps.min(n - 1)) % n,
        (0, false) => node.saturating_sub(1 + steps),
        (_, true) => (node + steps) % n,
        (_, false) => (node + steps).min(n - 1),
    }
}

/// Lengths of the two next chords on a side of a node.
fn chords_beside(polygon: &DataPolygon, node: usize, side: usize, unit: f64) -> [f64; 2] {
    [0, 1].map(|k| bucket(length(polygon.chord(beside(polygon, node, side, k))) / unit))
}

/// Curvature at a node, on the side of the segment before or after it.
fn sharpness<F: TensionFamily>(polygon: &DataPolygon, family: &F, node: usize, side: usize) -> f64 {
    if !polygon.is_closed() && node == [0, polygon.segments()][side] {
        return 0.0;
    }
    let segment = beside(polygon, node, side, 0);
    let chord = polygon.chord(segment);
    let [a, c] = family.end_legs(segment);
    let (own, other) = if side == 0 { (c, a) } else { (a, c) };
    let size = length(own);
    length((own / size).cross((chord - other) / size)) / size
}
