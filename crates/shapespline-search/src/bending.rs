// SPDX-License-Identifier: MIT OR Apache-2.0

//! How much segments bend, to about a thousandth: a search compares curves by it again and again.

use shapespline_geometry::{DVec3, DataPolygon, length};

use crate::{TensionFamily, group::segments_around};

/// Segments on each side of a node whose bending is compared before and after its tension is lowered.
const REACH: usize = 4;

/// Nodes and weights of the five-point rule of Gauss on `[−1, 1]`.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The segments that feel the tensions at some nodes most, ascending.
pub(crate) fn bent_by(polygon: &DataPolygon, nodes: impl Iterator<Item = usize>) -> Vec<usize> {
    segments_around(polygon, nodes, REACH)
}

/// The end legs of segments.
pub(crate) fn legs_of_segments<F: TensionFamily>(
    family: &F,
    segments: &[usize],
) -> Vec<[DVec3; 2]> {
    segments.iter().map(|&i| family.end_legs(i)).collect()
}

/// `∫κ² ds` over segments with some end legs; `unit` is that of length.
pub(crate) fn bending(
    polygon: &DataPolygon,
    segments: &[usize],
    legs: &[[DVec3; 2]],
    unit: f64,
) -> f64 {
    let of = |(&i, legs): (&usize, &[DVec3; 2])| {
        let [a, c] = legs.map(|leg| leg / unit);
        let b = polygon.chord(i) / unit - a - c;
        // Backwards it bends as much.
        of_half([a, b, c]) + of_half([c, b, a])
    };
    segments.iter().zip(legs).map(of).sum()
}

/// The first half of a segment with three legs. Where its first leg is short it has a corner there, over
/// parameters of that leg's share: parts grow with the distance from them.
fn of_half([a, b, c]: [DVec3; 3]) -> f64 {
    /// No corner is narrower.
    const NARROWEST: f64 = 1e-15;
    let share = length(a) / (length(a) + 2.0 * length(b));
    let width = share.max(NARROWEST);
    let [first, last] = [b - a, c - b];
    let density = |t: f64| {
        let speed = a + (first * 2.0 + (last - first) * t) * t;
        let change = first + (last - first) * t;
        let square = speed.length_squared();
        // Derivatives are three times and six times these.
        let turn = speed.cross(change).length_squared();
        [square, turn / (square * square * square.sqrt()) * (4.0 / 3.0)]
    };
    let (mut start, mut sum) = (0.0, 0.0);
    while start < 0.5 {
        let end = start + 2.0 * (start + width);
        let end = if end < 0.35 { end } else { 0.5 };
        sum += of_part(&density, [start, end], DEPTH);
        start = end;
    }
    sum
}

/// Parts are halved so often where the curve nearly stops inside: a peak narrower than that is not resolved.
const DEPTH: u32 = 8;

/// The integral over a part of a density that comes with the square of speed. Where speeds differ much the part
/// is halved.
fn of_part(density: &impl Fn(f64) -> [f64; 2], [start, end]: [f64; 2], depth: u32) -> f64 {
    /// The least of the squares over the largest.
    const DIFFERENT: f64 = 0.05;
    let half = 0.5 * (end - start);
    let ends = [start, end].map(|t| density(t)[0]);
    let (mut sum, mut least, mut most) = (0.0, ends[0].min(ends[1]), ends[0].max(ends[1]));
    for (x, w) in GAUSS {
        let [square, value] = density(start + half * (1.0 + x));
        (least, most) = (least.min(square), most.max(square));
        sum += w * value;
    }
    if depth > 0 && least < DIFFERENT * most {
        let middle = start + half;
        return of_part(density, [start, middle], depth - 1)
            + of_part(density, [middle, end], depth - 1);
    }
    half * sum
}

/// Curvature at an end of a segment, but for a factor of 2/3; the leg at that end comes first.
pub(crate) fn end_curvature(chord: DVec3, [own, other]: [DVec3; 2]) -> f64 {
    let size = length(own);
    length((own / size).cross((chord - other) / size)) / size
}

#[cfg(test)]
mod tests {
    use shapespline_geometry::CubicSegment;

    use super::*;

    /// From even legs to corners at one end or both, in the plane and out of it, and to curves that nearly
    /// stop inside.
    #[test]
    fn bending_is_the_integral_to_a_thousandth() {
        for (k, size) in [1.0, 0.5, 1e-1, 1e-2, 1e-4, 1e-7].into_iter().enumerate() {
            for other in [1.0, 0.3, 1e-3] {
                let a = DVec3::new(0.3, 0.1, 0.05 * k as f64) * size;
                let c = DVec3::new(0.25, -0.2, 0.1) * other;
                let b = DVec3::X - a - c;
                let found = of_half([a, b, c]) + of_half([c, b, a]);
                let exact = CubicSegment { start: DVec3::ZERO, a, b, c }.bending(1e-9);
                assert!((found / exact - 1.0).abs() < 1e-3, "{size} {other}: {found} {exact}");
            }
        }
        for height in [0.5, 0.2, 0.05] {
            let (a, c) = (DVec3::new(1.2, height, 0.0), DVec3::new(1.2, -height, 0.0));
            let b = DVec3::X - a - c;
            let found = of_half([a, b, c]) + of_half([c, b, a]);
            let exact = CubicSegment { start: DVec3::ZERO, a, b, c }.bending(1e-9);
            assert!((found / exact - 1.0).abs() < 1e-2, "{height}: {found} {exact}");
        }
    }
}
