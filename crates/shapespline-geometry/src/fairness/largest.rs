// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest curvature alone, where the other measures are not asked for: most segments are done with by a
//! bound.

use crate::{
    CubicSegment, DVec3, Dimension, PiecewiseCubic, fairness::piece::Piece, vector::power_of_two,
};

/// The largest curvature of the segments of a cubic curve, per unit of length: infinite at a cusp. What
/// jumps where segments meet does not count. Cost O(N); exact extrema are looked for only where a bound
/// of a segment's curvature exceeds what is attained elsewhere.
#[must_use]
pub fn largest_curvature(curve: &PiecewiseCubic) -> f64 {
    let segments = || (0..curve.segments()).map(|i| curve.segment(i));
    let ends = segments().flat_map(|s| [curvature_at(&s, 0.0), curvature_at(&s, 1.0)]);
    let mut largest = ends.filter(|k| !k.is_nan()).fold(0.0, f64::max);
    for segment in segments() {
        // Written so that no number is looked at closely.
        if !(bound(&segment) <= largest) {
            largest = largest.max(inside(&segment, curve.dimension() == Dimension::Two));
        }
    }
    largest
}

fn curvature_at(segment: &CubicSegment, t: f64) -> f64 {
    let [d1, d2, _] = segment.derivatives(t);
    let speed = d1.length();
    d1.cross(d2).length() / (speed * speed * speed)
}

/// At least the curvature anywhere on a segment: of the Bernstein coefficients of `γ′×γ″` the largest, over the
/// cube of the least speed along the chord of the legs.
fn bound(segment: &CubicSegment) -> f64 {
    let CubicSegment { a, b, c, .. } = *segment;
    let turn = [a.cross(b) * 2.0, a.cross(c), b.cross(c) * 2.0].map(DVec3::length);
    let toward = (a + b + c).normalize_or_zero();
    let speed = [a, b, c].map(|leg| leg.dot(toward)).into_iter().fold(f64::INFINITY, f64::min);
    // γ′ = 3 (a, b, c) and γ′×γ″ = 9 (2a×b, a×c, 2b×c) in Bernstein form; a little more for rounding.
    let largest = turn.into_iter().fold(0.0, f64::max);
    if speed > 0.0 { 1.001 * largest / (3.0 * speed * speed * speed) } else { f64::INFINITY }
}

/// The largest curvature inside a segment.
fn inside(segment: &CubicSegment, planar: bool) -> f64 {
    let CubicSegment { a, b, c, .. } = *segment;
    let size = [a, b, c].into_iter().map(|leg| leg.abs().max_element()).fold(0.0, f64::max);
    if size == 0.0 {
        return 0.0;
    }
    let unit = power_of_two(size);
    let [a, b, c] = [a, b, c].map(|leg| leg / unit);
    let control = [DVec3::ZERO, a, a + b, a + b + c].map(|p| p.extend(1.0)).to_vec();
    let piece = Piece::new(control, false, planar);
    if piece.cusp().is_some() {
        return f64::INFINITY;
    }
    let at = piece.extrema().at.into_iter().map(|t| piece.curvature(t).abs());
    at.filter(|k| !k.is_nan()).fold(0.0, f64::max) / unit
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Domain, PiecewiseBezier, fairness};

    /// The same as among all measures, on curves gentle and sharp.
    #[test]
    fn it_is_that_of_the_fairness() {
        for planar in [false, true] {
            for seed in 0..40 {
                let mut state = f64::from(seed);
                let mut next = || {
                    state += 1.0;
                    (state * 12.9898).sin()
                };
                let mut vector = || DVec3::new(next(), next(), if planar { 0.0 } else { next() });
                let points: Vec<DVec3> = (0..9).map(|_| vector() * 3.0).collect();
                let size = if seed % 2 == 0 { 1.0 } else { 0.05 };
                let legs = (0..8).map(|_| [vector() * size, vector() * size]).collect();
                let knots = (0..9).map(f64::from).collect();
                let dimension = if planar { Dimension::Two } else { Dimension::Three };
                let curve = PiecewiseCubic::new(knots, points, legs, dimension, Domain::Open);
                let curve = curve.unwrap();
                let found = largest_curvature(&curve);
                // The legs do not meet, so that the whole has corners: segment by segment.
                let bezier = PiecewiseBezier::from(&curve);
                let own = (0..8).map(|i| {
                    let points: Vec<DVec3> = bezier.piece(i).iter().map(|p| p.truncate()).collect();
                    let one = PiecewiseBezier::new(vec![0.0, 1.0], &points, 3, dimension).unwrap();
                    fairness(&one).max_curvature
                });
                let expected = own.fold(0.0, f64::max);
                assert!((found / expected - 1.0).abs() < 1e-9, "{seed}: {found} {expected}");
            }
        }
    }
}
