// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a data polygon looks like from a node, in whichever direction its points are numbered.

use std::cmp::Ordering;

use shapespline_geometry::{DVec3, DataPolygon, length};

/// Segments on each side of a node that are looked at. What is further away is not felt: a change dies
/// away as `2^{−k}` over `k` nodes.
const LOOK: usize = 64;

/// Angles and ratios are rounded to this: smaller differences are rounding.
const ROUNDING: f64 = 1e-6;

/// Angles of a segment's direction with those of this many that follow. They say how the polygon turns,
/// whether it winds on or back, and whether it twists on or back.
const ANGLES: usize = 3;

/// The numbers by which surroundings are compared, each found when it is first asked for.
#[derive(Debug, Default)]
pub(crate) struct Surroundings {
    /// Those of the segments from here on, round and round.
    first: usize,
    segments: Vec<Option<Segment>>,
}

/// The length of a segment over that of the next, as a logarithm, and its angles.
#[derive(Debug, Clone, Copy)]
struct Segment {
    ratio: f64,
    angles: [f64; ANGLES],
}

impl Surroundings {
    /// Goes to nodes from some node on, and forgets what was seen elsewhere.
    pub(crate) fn go(&mut self, polygon: &DataPolygon, node: usize) {
        let n = polygon.segments();
        let beside = (LOOK + ANGLES + 1).min(n);
        self.first =
            if polygon.is_closed() { node + n - beside } else { node.saturating_sub(beside) };
        self.segments.clear();
    }

    /// Compares what is seen from nodes by looking to one side (0: before, 1: after) and the other in
    /// turn, ever further away. Equal if nothing within sight differs.
    pub(crate) fn compare(
        &mut self,
        polygon: &DataPolygon,
        [i, side]: [usize; 2],
        [j, other_side]: [usize; 2],
    ) -> Ordering {
        if [i, side] == [j, other_side] {
            return Ordering::Equal;
        }
        for step in 0..LOOK.min(polygon.segments()) {
            for turned in [0, 1] {
                let [a, b] = [[i, side ^ turned], [j, other_side ^ turned]]
                    .map(|[node, side]| self.seen(polygon, node, side, step as isize));
                let order = compare(&a, &b);
                if order.is_ne() {
                    return order;
                }
            }
        }
        Ordering::Equal
    }

    /// How a segment differs from those before it on the way outwards.
    fn seen(
        &mut self,
        polygon: &DataPolygon,
        node: usize,
        side: usize,
        step: isize,
    ) -> [f64; 1 + ANGLES] {
        let at = |step: isize| place(polygon, node, side, step);
        let Some(own) = at(step) else { return [f64::NEG_INFINITY; 1 + ANGLES] };
        let mut seen = [0.0; 1 + ANGLES];
        for back in 1..=ANGLES {
            let Some(before) = at(step - back as isize) else { continue };
            // The one of the two that comes first in the polygon.
            let first = self.segment(polygon, if side == 0 { own } else { before });
            seen[back] = first.angles[back - 1];
            if back == 1 {
                seen[0] = if side == 0 { first.ratio } else { -first.ratio } + 0.0;
            }
        }
        seen
    }

    fn segment(&mut self, polygon: &DataPolygon, i: usize) -> Segment {
        let n = polygon.segments();
        let place = (i + n - self.first % n) % n;
        if place >= self.segments.len() {
            self.segments.resize(place + 1, None);
        }
        *self.segments[place].get_or_insert_with(|| Segment::new(polygon, i))
    }
}

impl Segment {
    fn new(polygon: &DataPolygon, i: usize) -> Self {
        let after = |k: usize| place(polygon, i, 1, k as isize);
        let size = |k| length(polygon.chord(k));
        let ratio = after(1).map_or(0.0, |k| round((size(i) / size(k)).ln()));
        let to = |k| round(angle(polygon.direction(i), polygon.direction(k)));
        let angles = std::array::from_fn(|k| after(k + 1).map_or(0.0, to));
        Self { ratio, angles }
    }
}

/// The segment so many steps outwards from a node; −1 is the first one on the other side.
fn place(polygon: &DataPolygon, node: usize, side: usize, step: isize) -> Option<usize> {
    let n = polygon.segments();
    let at = if side == 0 { node as isize - 1 - step } else { node as isize + step };
    if polygon.is_closed() {
        return Some(at.rem_euclid(n as isize) as usize);
    }
    usize::try_from(at).ok().filter(|&i| i < n)
}

fn angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}

/// Compares numbers in order.
pub(crate) fn compare(a: &[f64], b: &[f64]) -> Ordering {
    a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).fold(Ordering::Equal, Ordering::then)
}

/// In whole units of [`ROUNDING`]; zero without a sign.
fn round(x: f64) -> f64 {
    (x / ROUNDING).round() + 0.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    fn polygon(points: Vec<DVec3>, boundary: Boundary) -> DataPolygon {
        DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap()
    }

    /// A helix with one kink: the nodes on either side of the kink see the same, and no others do.
    #[test]
    fn nodes_tie_if_a_mirror_or_a_turn_takes_one_to_the_other() {
        let step = |k: usize| {
            let t = 0.4 * (k as f64 - 9.5);
            let kink = if k == 9 || k == 10 { 0.3 } else { 0.0 };
            DVec3::new(t.cos() + kink, t.sin(), 0.5)
        };
        let mut points = vec![DVec3::ZERO];
        (0..20).for_each(|k| points.push(points[k] + step(k)));
        let open = polygon(points, Boundary::ZeroCurvature);
        let mut around = Surroundings::default();
        let mut ties = |i, j| around.compare(&open, i, j).is_eq();
        for i in 0..=20 {
            for j in 0..=20 {
                assert_eq!(ties([i, 0], [j, 0]), i == j, "{i} {j}");
                assert_eq!(ties([i, 0], [j, 1]), i == 20 - j, "{i} {j}");
            }
        }
    }

    #[test]
    fn all_nodes_of_a_regular_polygon_tie() {
        let at = |k: usize| {
            let t = std::f64::consts::TAU * (k % 7) as f64 / 7.0;
            DVec3::new(t.cos(), t.sin(), 0.0)
        };
        let closed = polygon((0..=7).map(at).collect(), Boundary::Periodic);
        let mut around = Surroundings::default();
        for i in 0..7 {
            for (j, side) in (0..7).flat_map(|j| [(j, 0), (j, 1)]) {
                assert!(around.compare(&closed, [i, 0], [j, side]).is_eq());
            }
        }
    }
}
