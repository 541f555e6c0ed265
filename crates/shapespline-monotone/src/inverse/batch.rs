// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many queries at once, each in a segment of its own, and the step that all take.

use super::{FEW, STEPS};
use crate::chunked::TILE;
use crate::segment_polynomial::SegmentPolynomial;

/// Adding it rounds to integers.
const MAGIC: f64 = 4_503_599_627_370_496.0;

/// A segment in units of Δy: the cubic q of its polynomial and its end slopes.
#[derive(Clone, Copy)]
pub(super) struct Unit {
    pub(super) q: [f64; 4],
    m: [f64; 2],
}

impl Unit {
    /// Of a polynomial's q, and 1/Δy.
    #[inline(always)]
    pub(super) fn of(q: [f64; 4], unit: f64) -> Self {
        let q = [q[0] * unit, q[1] * unit, q[2] * unit, q[3] * unit];
        let (even, odd) = (q[0] + q[2], q[1] + q[3]);
        Self { q, m: [1.0 - (even - odd), 1.0 + (even + odd)] }
    }

    /// The start for `r = (y − y₀)/Δy`: the inverse of the rational function (t² + m₀t(1−t))/(1 + (m₀+m₁−2)t(1−t))
    /// through both ends with their slopes (Gregory and Delbourgo's monotone one), a quadratic equation.
    #[inline(always)]
    pub(super) fn start(self, r: f64) -> f64 {
        let b = self.m[0] - r * (self.m[0] + self.m[1] - 2.0);
        2.0 * r / (b + (b * b + 4.0 * r * (1.0 - b)).sqrt())
    }

    /// Whether the slope falls to 0, or rises from 0, as a parabola or nearly so: beside level parts of cubics, where
    /// f is a cube.
    #[inline(always)]
    pub(super) fn is_cube(self) -> bool {
        const NEAR: f64 = 1e-3;
        (self.q[0].abs() - 1.5).abs() < NEAR && (self.q[1] - 0.5).abs() < NEAR
    }

    /// The inverse of the cube, for `from = [(y − y₀)/Δy, (y − y₁)/Δy]`.
    pub(super) fn root(self, from: [f64; 2]) -> f64 {
        if self.q[0] > 0.0 { from[0].cbrt() } else { 1.0 + from[1].cbrt() }
    }

    /// The first and the second derivative at t.
    pub(super) fn derivatives(self, t: f64) -> (f64, f64) {
        let [q0, q1, q2, q3] = self.q;
        let (z, bubble) = (2.0 * t - 1.0, t * (t - 1.0));
        let q = ((q3 * z + q2) * z + q1) * z + q0;
        let dq = (3.0 * q3 * z + 2.0 * q2) * z + q1;
        let ddq = 6.0 * q3 * z + 2.0 * q2;
        (1.0 + z * q + 2.0 * bubble * dq, 2.0 * q + 4.0 * (z * dq + bubble * ddq))
    }
}

/// Householder's step of fourth order from t towards `from = [(y − y₀)/Δy, (y − y₁)/Δy]`, and a number that is
/// positive (or NaN) where the result is not known to be exact up to rounding.
#[inline(always)]
pub(super) fn step(q: [f64; 4], from: [f64; 2], t: f64) -> (f64, f64) {
    let [q0, q1, q2, q3] = q;
    let (z, bubble) = (2.0 * t - 1.0, t * (t - 1.0));
    let q = ((q3 * z + q2) * z + q1) * z + q0;
    let dq = (3.0 * q3 * z + 2.0 * q2) * z + q1;
    let ddq = 6.0 * q3 * z + 2.0 * q2;
    // From the nearer end, 0 or 1, by arithmetic alone: a choice of what to load keeps the compiler from taking several
    // queries at once.
    let end = (t + MAGIC) - MAGIC;
    let goal = (1.0 - end) * from[0] + end * from[1];
    // f and its first three derivatives.
    let f = ((t - end) + bubble * q) - goal;
    let d1 = 1.0 + z * q + 2.0 * bubble * dq;
    let d2 = 2.0 * q + 4.0 * (z * dq + bubble * ddq);
    let d3 = 12.0 * (dq + z * ddq) + 48.0 * bubble * q3;
    let square = d1 * d1;
    let bend = f * d2;
    let step = f * (square - 0.5 * bend) / (d1 * (square - bend) + f * f * d3 * (1.0 / 6.0));
    let next = t - step;
    // What is left is of fourth order: below rounding once the step is below 1e-4 of the way to the nearer end, and
    // what it corrects of Newton's step below 1e-4.
    let room = if next < 0.5 { next } else { 1.0 - next };
    let size = step.abs() - 1e-4 * room;
    let bent = bend.abs() - 2e-4 * square;
    (next, if size > bent { size } else { bent })
}

/// Whether the queries that are not known to be exact are too many to go on alone.
#[inline(always)]
pub(super) fn many(doubt: &[f64]) -> bool {
    let doubtful: usize = doubt.iter().map(|d| usize::from(!(*d <= 0.0))).sum();
    doubtful * FEW > doubt.len()
}

/// A tile of queries in their segments, in units of Δy, number by number: the compiler takes several queries at once.
pub(super) struct Batch {
    q: [[f64; TILE]; 4],
    /// `(y − y₀)/Δy` and `(y − y₁)/Δy`.
    pub(super) from: [[f64; TILE]; 2],
    pub(super) t: [f64; TILE],
    /// Positive (or NaN) where t is not known to be exact up to rounding.
    pub(super) doubt: [f64; TILE],
}

impl Batch {
    #[inline(always)]
    pub(super) fn new<'a>(
        polynomial: impl Fn(usize) -> &'a SegmentPolynomial,
        y: &[f64; TILE],
    ) -> Self {
        let mut l = Self {
            q: [[0.0; TILE]; 4],
            from: [[0.0; TILE]; 2],
            t: [0.0; TILE],
            doubt: [1.0; TILE],
        };
        let mut rise = [0.0; TILE];
        for j in 0..TILE {
            let r = polynomial(j);
            rise[j] = r.y[1] - r.y[0];
            (l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]) = (r.q[0], r.q[1], r.q[2], r.q[3]);
            (l.from[0][j], l.from[1][j]) = (y[j] - r.y[0], y[j] - r.y[1]);
        }
        for j in 0..TILE {
            let inverse = 1.0 / rise[j];
            let unit = Unit::of([l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]], inverse);
            let r = l.from[0][j] * inverse;
            l.t[j] = unit.start(r);
            [l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]] = unit.q;
            (l.from[0][j], l.from[1][j]) = (r, l.from[1][j] * inverse);
        }
        // A loop of its own: calls keep the compiler from taking several queries at once.
        for j in 0..TILE {
            let unit = Unit { q: [l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]], m: [0.0; 2] };
            if unit.is_cube() {
                l.t[j] = unit.root([l.from[0][j], l.from[1][j]]);
            }
        }
        l
    }

    /// Steps until nearly all are done.
    #[inline(always)]
    pub(super) fn solve(&mut self) {
        for k in 0..STEPS {
            for j in 0..TILE {
                let q = [self.q[0][j], self.q[1][j], self.q[2][j], self.q[3][j]];
                let from = [self.from[0][j], self.from[1][j]];
                (self.t[j], self.doubt[j]) = step(q, from, self.t[j]);
            }
            if k > 0 && !many(&self.doubt) {
                break;
            }
        }
    }
}
