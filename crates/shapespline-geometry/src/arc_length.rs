// SPDX-License-Identifier: MIT OR Apache-2.0

//! Arc length, and parameters at given arc lengths.

use std::ops::ControlFlow;

use shapespline_polynomial::{bracketed_root, parallel};

use crate::{
    CubicSegment, Curve, DVec3, PiecewiseCubic, Side,
    vector::{length, power_of_two},
};

/// Nodes and weights of the ten-point Gauss–Legendre rule on `[−1, 1]`, positive half.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_3),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Error allowed in the length of a segment, relative to the length of its Bézier polygon.
const ACCURACY: f64 = 1e-13;

/// Segments from on which they are measured on all threads.
const MANY: usize = 8192;

impl CubicSegment {
    /// Length of the part `[from, to]`, by adaptive Gauss–Legendre quadrature: a ten-point rule is
    /// accepted when its two halves agree with it to `1e-13` of the segment's Bézier polygon
    /// (times `|t|³` beyond its ends). Where the curve all but stops the part is cut: no rule sees
    /// what happens beyond its last node. Backwards the length is negative.
    #[must_use]
    pub fn arc_length(&self, from: f64, to: f64) -> f64 {
        let largest = self.a.abs().max(self.b.abs()).max(self.c.abs()).max_element();
        if !(largest > 0.0 && largest.is_finite()) {
            // All points are one; or there is no length to be had.
            return largest * (to - from);
        }
        // In units of the longest leg, so that neither errors nor speeds leave the range of f64.
        let unit = power_of_two(largest);
        let [a, b, c] = [self.a, self.b, self.c].map(|leg| leg / unit);
        let scaled = Self { start: DVec3::ZERO, a, b, c };
        // Beyond the ends the speed grows as t², and its rounding errors with it: asking for less
        // than they are would halve intervals without end.
        let reach = 1.0f64.max(from.abs()).max(to.abs());
        let size = (length(a) + length(b) + length(c)) * (reach * reach * reach);
        let [low, high] = [from.min(to), from.max(to)];
        let [stop, other] = stops(&scaled, low, high);
        let part = |from: f64, to: f64| {
            adaptive(&scaled, from, to, rule(&scaled, from, to), ACCURACY * size, 40)
        };
        let sum = part(low, stop)
            + if stop < high { part(stop, other) } else { 0.0 }
            + if other < high { part(other, high) } else { 0.0 };
        if from <= to { unit * sum } else { -unit * sum }
    }
}

/// Speed, in terms of the longest leg, below which a minimum of it counts as a corner of its graph.
const SLOW: f64 = 0.25;

/// The parameters between two others, ascending, at which the speed has a minimum near zero; `high`
/// where there is none. The longest leg has about the length one.
fn stops(segment: &CubicSegment, low: f64, high: f64) -> [f64; 2] {
    // γ′/3 = A + Bt + Ct², and half the derivative of its square, a cubic.
    let CubicSegment { a, b, c, .. } = *segment;
    let (first, second) = ((b - a) * 2.0, (a - b) + (c - b));
    let q = [
        a.dot(first),
        first.dot(first) + 2.0 * a.dot(second),
        3.0 * first.dot(second),
        2.0 * second.dot(second),
    ];
    let at = |t: f64| q[0] + t * (q[1] + t * (q[2] + t * q[3]));
    // Between the extrema of the cubic there is one zero at most.
    let discriminant = q[2] * q[2] - 3.0 * q[1] * q[3];
    let mut turns = [high; 2];
    if discriminant > 0.0 {
        // No digits cancel in the larger root; the product of both is q₁/3q₃.
        let large = -(q[2] + discriminant.sqrt().copysign(q[2]));
        let roots = [large / (3.0 * q[3]), q[1] / large];
        turns = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        // What is no number, of a cubic that is none, is beyond the end.
        turns = turns.map(|t| if low < t && t < high { t } else { high });
        turns.sort_by(f64::total_cmp);
    }
    let mut found = [high; 2];
    let mut count = 0;
    for [mut from, mut to] in [[low, turns[0]], turns, [turns[1], high]] {
        if !(at(from) < 0.0 && at(to) > 0.0) {
            continue;
        }
        loop {
            let middle = 0.5 * (from + to);
            if !(from < middle && middle < to) {
                break;
            }
            if at(middle) < 0.0 { from = middle } else { to = middle }
        }
        // A cubic falls and rises again twice at most.
        if count < 2 && length(segment.derivatives(from)[0]) < SLOW {
            found[count] = from;
            count += 1;
        }
    }
    found
}

fn rule(segment: &CubicSegment, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let speed = |t: f64| length(segment.derivatives(t)[0]);
    half * GAUSS
        .iter()
        .map(|(x, w)| w * (speed(middle - half * x) + speed(middle + half * x)))
        .sum::<f64>()
}

fn adaptive(s: &CubicSegment, from: f64, to: f64, whole: f64, allowed: f64, depth: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let (left, right) = (rule(s, from, middle), rule(s, middle, to));
    // Written so that a NaN or an infinity ends it.
    if depth == 0 || !((left + right - whole).abs() > allowed) {
        return left + right;
    }
    adaptive(s, from, middle, left, 0.5 * allowed, depth - 1)
        + adaptive(s, middle, to, right, 0.5 * allowed, depth - 1)
}

/// Table of the arc length of a curve up to each knot.
#[derive(Debug, Clone)]
pub struct ArcLength<'a, C: ?Sized = PiecewiseCubic> {
    curve: &'a C,
    /// Length from the first knot to each knot.
    upto: Vec<f64>,
}

impl<'a, C: Curve + ?Sized> ArcLength<'a, C> {
    /// Measures every segment, each to `1e-13` of the length of its Bézier polygon. Cost O(N).
    #[must_use]
    pub fn new(curve: &'a C) -> Self {
        let measured = Self::new_with(curve, &|| ControlFlow::Continue(()));
        measured.unwrap_or_else(|| Self { curve, upto: vec![0.0] })
    }

    /// As [`ArcLength::new`], but calls `go_on` before each segment, and returns `None` once that breaks.
    #[must_use]
    pub fn new_with(curve: &'a C, go_on: &(dyn Fn() -> ControlFlow<()> + Sync)) -> Option<Self> {
        let cubic = curve.cubic();
        let n = cubic.segments();
        // The zero comes before the first; then the running sums take the lengths' places.
        let measure = |i: usize| match i.checked_sub(1) {
            None => Some(0.0),
            Some(i) => go_on().is_continue().then(|| cubic.segment(i).arc_length(0.0, 1.0)),
        };
        let mut upto: Vec<f64> = parallel::map::<_, Option<_>>(n + 1, MANY + 1, measure)?;
        let mut sum = 0.0;
        for length in &mut upto {
            sum += *length;
            *length = sum;
        }
        Some(Self { curve, upto })
    }

    /// Length of the whole curve.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.upto[self.upto.len() - 1]
    }

    /// Signed length from the first knot to a parameter; beyond an open end along the cubic that
    /// goes on there, around a closed curve as often as the parameter goes.
    #[must_use]
    pub fn upto(&self, u: f64) -> f64 {
        let cubic = self.curve.cubic();
        let knots = cubic.knots();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let wraps = cubic.domain() == crate::Domain::Closed && !(first <= u && u <= last);
        let turns = if wraps { ((u - first) / (last - first)).floor() } else { 0.0 };
        let (i, t) = self.curve.locate(u - turns * (last - first), Side::Right);
        turns * self.total() + self.upto[i] + cubic.segment(i).arc_length(0.0, t)
    }

    /// Signed length between two parameters.
    #[must_use]
    pub fn between(&self, from: f64, to: f64) -> f64 {
        self.upto(to) - self.upto(from)
    }

    /// The parameter at a length from the first knot, `0 ≤ length ≤ total`; values outside are
    /// taken to the ends. Newton's iteration in a bracket.
    #[must_use]
    pub fn parameter(&self, length: f64) -> f64 {
        let cubic = self.curve.cubic();
        let knots = cubic.knots();
        let n = cubic.segments();
        let i = self.upto[1..n].partition_point(|&l| l <= length);
        let wanted = length - self.upto[i];
        let whole = self.upto[i + 1] - self.upto[i];
        if !(wanted > 0.0) {
            return knots[i];
        }
        if wanted >= whole {
            return knots[i + 1];
        }
        let segment = cubic.segment(i);
        let excess = |t: f64| {
            (segment.arc_length(0.0, t) - wanted, crate::length(segment.derivatives(t)[0]))
        };
        let (values, accuracy) = ([-wanted, whole - wanted], 4.0 * f64::EPSILON * whole);
        let limits = [accuracy, f64::EPSILON];
        let t = bracketed_root(excess, [0.0, 1.0], values, wanted / whole, limits);
        self.curve.parameter(i, t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dimension, Domain};

    /// A parabola `(u, u²)` in two segments: its length is known in closed form.
    fn parabola() -> PiecewiseCubic {
        let knots = vec![0.0f64, 0.5, 2.0];
        let legs = knots
            .windows(2)
            .map(|w| [w[0], w[1]].map(|u| DVec3::new(1.0, 2.0 * u, 0.0) * (w[1] - w[0]) / 3.0))
            .collect();
        let points = knots.iter().map(|&u| DVec3::new(u, u * u, 0.0)).collect();
        PiecewiseCubic::new(knots, points, legs, Dimension::Two, Domain::Open).unwrap()
    }

    fn parabola_length(u: f64) -> f64 {
        0.5 * u * (1.0 + 4.0 * u * u).sqrt() + 0.25 * (2.0 * u).asinh()
    }

    /// There and back on a line: however the end of a part lies to the turn, its length is known.
    #[test]
    fn turns_are_seen_wherever_they_lie() {
        let (a, c) = (DVec3::new(0.0, 0.0, -6e204), DVec3::new(4e99, 0.0, 0.0));
        let [forth, back] = [1.0, -1.0]
            .map(|size| CubicSegment::from_end_legs(DVec3::ZERO, DVec3::X * 1e100, a * size, c));
        // 3a t(1 − t)² on the line, which turns at 1/3.
        let way = |t: f64| 18e204 * t * (1.0 - t) * (1.0 - t);
        let expected = |t: f64| if 3.0 * t < 1.0 { way(t) } else { 2.0 * way(1.0 / 3.0) - way(t) };
        for k in 0..=4000 {
            let t = f64::from(k) / 4000.0;
            for segment in [forth, back] {
                let size = 1e-13 * 18e204;
                assert!((segment.arc_length(0.0, t) - expected(t)).abs() < size, "{t}");
                assert!((segment.arc_length(t, 0.0) + expected(t)).abs() < size, "{t}");
            }
        }
    }

    #[test]
    fn length_of_a_parabola_and_back() {
        let curve = parabola();
        let table = ArcLength::new(&curve);
        for k in 0..=40 {
            let u = 0.05 * f64::from(k);
            let expected = parabola_length(u);
            assert!((table.upto(u) - expected).abs() < 1e-13, "{u}");
            assert!((table.parameter(expected) - u).abs() < 1e-13, "{u}");
        }
        assert!(
            (table.between(2.5, -0.5) + parabola_length(2.5) + parabola_length(0.5)).abs() < 1e-12
        );
        assert_eq!(table.parameter(-1.0), 0.0);
        assert_eq!(table.parameter(100.0), 2.0);
    }

    /// Found by fuzzing: both took longer than anybody waits.
    #[test]
    fn far_beyond_the_ends_and_at_every_scale() {
        let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::new(0.3, -0.2, 1.0)];
        let segment = CubicSegment { start: DVec3::ZERO, a, b, c };
        let inside = segment.arc_length(0.0, 1.0);
        for scale in [1e-320, 1e-300, 1e-160, 1e160, 1e300] {
            let [a, b, c] = [a, b, c].map(|leg| leg * scale);
            let found = CubicSegment { start: DVec3::ZERO, a, b, c }.arc_length(0.0, 1.0);
            let rounding = if scale < 1e-308 { 1e-2 } else { 1e-12 };
            assert!((found / scale / inside - 1.0).abs() < rounding, "{scale}: {found}");
        }
        // Far out the cubic is that of its leading coefficient.
        let leading = (c - 2.0 * b + a).length();
        for t in [-654_115_648_176.0f64, -1e20, 1e9, 1e60] {
            let found = segment.arc_length(0.0, t) / (t * t * t.abs());
            assert!((found.abs() / leading - 1.0).abs() < 1e-8, "{t}: {found} and {leading}");
        }
        assert_eq!(segment.arc_length(0.0, -18.4), -segment.arc_length(-18.4, 0.0));
        let long = segment.arc_length(0.0, -1e200);
        assert!(!long.is_finite(), "{long}");
        let point =
            CubicSegment { start: DVec3::X, a: DVec3::ZERO, b: DVec3::ZERO, c: DVec3::ZERO };
        assert_eq!(point.arc_length(0.0, 1.0), 0.0);
    }

    #[test]
    fn a_cusp_is_measured_too() {
        // Out along x and back on the same line: γ' vanishes inside.
        let segment =
            CubicSegment { start: DVec3::ZERO, a: DVec3::X, b: DVec3::ZERO, c: -DVec3::X };
        let top = segment.position(0.5).x;
        assert!((segment.arc_length(0.0, 1.0) - 2.0 * top).abs() < 1e-12);
    }
}
