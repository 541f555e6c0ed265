// SPDX-License-Identifier: MIT OR Apache-2.0

//! What points do not ask for whose places are known to a resolution `δ` only: all that a move of the
//! points by as much could undo.
//!
//! - Three points lie on a line where their width, the least altitude of the triangle, is at most `2δ`. The node
//!   between them then asks for nothing.
//! - Four points lie in a plane where the width of their tetrahedron is at most `2δ`: then neither torsion nor
//!   coplanarity is asked. The width is `|det|` over the largest of the cross products of its faces and of its
//!   opposite edges.
//! - The plane of three points of width `w` may tilt by `α`, `tan α = 2δ/w`. How two nodes turn to each other is
//!   asked where `|cos φ| > sin(α + α')`, `φ` being the angle between their binormal vectors; of points in
//!   the plane always.

use glam::DVec3;
use shapespline_geometry::{DataPolygon, Dimension, batch::SegmentBatch};

use crate::{Criterion, Requirements};

/// Takes from the requirements of a batch what a resolution cannot know. Places as in
/// [`Requirements::of_batch`].
pub(crate) fn leave_known(
    polygon: &DataPolygon,
    batch: &SegmentBatch,
    resolution: f64,
    required: &mut [Requirements; SegmentBatch::ROOM],
) {
    let segments = batch.segments(polygon);
    let chord = |j: usize| batch.chords().get(j);
    // The node at the end of place j; at ends with a tangent there are no three points.
    let node = |j: usize| {
        let inside = segments.contains(&j) && segments.contains(&(j + 1));
        if inside { Turn::of(chord(j), chord(j + 1), resolution) } else { Turn::GIVEN }
    };
    let planar = polygon.dimension() == Dimension::Two;
    for j in segments.start.max(2)..segments.end.min(batch.places() - 2) {
        let nodes = [j - 2, j - 1, j, j + 1].map(node);
        let binormal = |k: usize| batch.binormals().get(j - 2 + k);
        let known = |k: usize| {
            let [one, other] = [nodes[k], nodes[k + 1]];
            let agree = || one.agrees_clearly(other, binormal(k), binormal(k + 1));
            !one.is_straight && !other.is_straight && (planar || agree())
        };
        let mut kept = required[j];
        let mut leave_out = |what: bool, required: Requirements| {
            kept = if what { kept.difference(required) } else { kept };
        };
        leave_out(nodes[1].is_straight, Requirements::AT_START);
        leave_out(nodes[2].is_straight, Requirements::AT_END);
        leave_out(!known(0), Requirements::TURNING_BEFORE);
        leave_out(!known(1), Requirements::PAIR);
        leave_out(!known(2), Requirements::TURNING_AFTER);
        let straight = nodes[1].is_straight || nodes[2].is_straight;
        let flat = || {
            let four = (j - 1..=j + 1).all(|k| segments.contains(&k));
            four && width_of_four([j - 1, j, j + 1].map(chord)) <= 2.0 * resolution
        };
        leave_out(straight || flat(), Requirements::of(Criterion::Torsion));
        leave_out(straight || !known(1) || flat(), Requirements::of(Criterion::Coplanarity));
        required[j] = kept;
    }
}

/// Whether three points with these chords count as lying on a line.
pub(crate) fn is_straight(before: DVec3, after: DVec3, resolution: f64) -> bool {
    resolution > 0.0 && width_of_three(before, after) <= 2.0 * resolution
}

/// What is known of the turn at a node.
#[derive(Debug, Clone, Copy)]
struct Turn {
    is_straight: bool,
    /// `tan α`.
    tilt: f64,
}

impl Turn {
    /// Beside an end tangent, which is known exactly.
    const GIVEN: Self = Self { is_straight: false, tilt: 0.0 };

    fn of(before: DVec3, after: DVec3, resolution: f64) -> Self {
        let tilt = 2.0 * resolution / width_of_three(before, after);
        // Written so that a width of zero, or no number, counts as straight.
        Self { is_straight: !(tilt < 1.0), tilt }
    }

    /// Whether two binormal vectors are clearly on one side of each other, or clearly on opposite ones.
    fn agrees_clearly(self, other: Self, p: DVec3, q: DVec3) -> bool {
        let cosine = (p.dot(q) / (p.length() * q.length())).abs();
        cosine > (self.tilt.atan() + other.tilt.atan()).sin()
    }
}

/// The least altitude of the triangle of two chords.
fn width_of_three(a: DVec3, b: DVec3) -> f64 {
    let size = [a, b].into_iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let [a, b] = [a, b].map(|v| v / size);
    let longest = a.length().max(b.length()).max((a + b).length());
    size * (a.cross(b).length() / longest)
}

/// The width of the tetrahedron of three chords: the least distance of two parallel planes that hold it between
/// them.
fn width_of_four(chords: [DVec3; 3]) -> f64 {
    let size = chords.into_iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let [a, b, c] = chords.map(|v| v / size);
    let faces = [a.cross(b), b.cross(c), a.cross(b + c), (a + b).cross(c)];
    let edges = [a.cross(c), b.cross(a + b + c), (a + b).cross(b + c)];
    let largest = faces.into_iter().chain(edges).map(DVec3::length).fold(0.0, f64::max);
    size * (a.cross(b).dot(c).abs() / largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least over all directions, found by trying many.
    fn tried(points: &[DVec3]) -> f64 {
        let directions = (0..200_000).map(|k| {
            let (k, n) = (f64::from(k), 200_000.0);
            let z = 1.0 - (2.0 * k + 1.0) / n;
            let (s, c) = (k * 2.399_963_229_728_653).sin_cos();
            DVec3::new(c, s, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
        });
        let extent = |d: DVec3| {
            let along = points.iter().map(|p| p.dot(d));
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        directions.map(extent).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_width_of_four_points_is_the_least_of_all_directions() {
        for k in 0..12 {
            let at = |j: u32| {
                let t = f64::from(3 * k + j);
                DVec3::new((1.7 * t).sin(), (2.9 * t).cos(), (0.4 * t * t).sin())
            };
            let points = [0, 1, 2, 3].map(at);
            let chords = [0, 1, 2].map(|i| points[i + 1] - points[i]);
            let (found, expected) = (width_of_four(chords), tried(&points));
            let missed = expected - found;
            assert!((-1e-12..0.02).contains(&missed), "{k}: {found} {expected}");
            let scaled = width_of_four(chords.map(|c| c * 1e-200));
            assert!((scaled / found * 1e200 - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_width_of_three_points_is_the_least_altitude() {
        let [a, b] = [DVec3::new(3.0, 4.0, 0.0), DVec3::new(-3.0, 0.0, 0.0)];
        // Twice the area is 12, the longest side 5.
        assert!((width_of_three(a, b) - 2.4).abs() < 1e-15);
        assert!(is_straight(a, b, 1.2001) && !is_straight(a, b, 1.1999));
        assert!(!is_straight(a, a, 0.0));
    }
}
