// SPDX-License-Identifier: MIT OR Apache-2.0

//! The criteria on one cubic in whole numbers: nothing is rounded, and roots are decided by squaring.
//!
//! All numbers are multiples of `2^−SHIFT`; each formula is homogeneous, so its sign needs no more.

use num_bigint::BigInt;
use shapespline::{
    criteria::{Requirements, inflection_parameter},
    prelude::*,
};

/// A vector of whole numbers.
pub type Whole = [BigInt; 3];

/// What is finer than this in the input would be lost, and is refused.
const SHIFT: i32 = 400;

/// Depth at which a polynomial that neither vanishes nor is positive is given up: a double root.
const DEPTH: usize = 400;

fn whole(x: f64, shift: i32) -> BigInt {
    let bits = x.abs().to_bits();
    let exponent = i32::try_from(bits >> 52).unwrap();
    assert!(exponent > 0 || x == 0.0, "{x:e}");
    let mantissa = (bits & ((1 << 52) - 1)) | (u64::from(exponent > 0) << 52);
    let shift = exponent - 1075 + shift;
    let sign = if x < 0.0 { -1 } else { 1 };
    let up = (BigInt::from(mantissa) * sign) << shift.max(0).cast_unsigned();
    let down = BigInt::from(1) << (-shift).max(0).cast_unsigned();
    assert!(&up % &down == BigInt::ZERO, "{x:e}");
    up / down
}

fn vector(v: DVec3) -> Whole {
    v.to_array().map(|x| whole(x, SHIFT))
}

fn difference(a: &Whole, b: &Whole) -> Whole {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn sum(a: &Whole, b: &Whole) -> Whole {
    [0, 1, 2].map(|i| &a[i] + &b[i])
}

fn times(a: &Whole, s: &BigInt) -> Whole {
    [0, 1, 2].map(|i| &a[i] * s)
}

fn cross(a: &Whole, b: &Whole) -> Whole {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &Whole, b: &Whole) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// A cubic between two points of a polygon, by its control points.
pub struct Cubic {
    a: Whole,
    b: Whole,
    c: Whole,
    chord: Whole,
    /// Chords of the polygon: two before, beside, two after it.
    around: [Whole; 5],
}

impl Cubic {
    /// The cubic of four control points on an inner segment of a polygon.
    #[must_use]
    pub fn new(polygon: &DataPolygon, segment: usize, control: [DVec3; 4]) -> Self {
        let [p0, p1, p2, p3] = control.map(vector);
        let points = polygon.points();
        let chord = |i: usize| difference(&vector(points[i + 1]), &vector(points[i]));
        Self {
            a: difference(&p1, &p0),
            b: difference(&p2, &p1),
            c: difference(&p3, &p2),
            chord: difference(&p3, &p0),
            around: [0, 1, 2, 3, 4].map(|k| chord(segment + k - 2)),
        }
    }

    /// Binormal vectors at both nodes.
    fn normals(&self) -> [Whole; 2] {
        [1, 2].map(|k| self.normal(k))
    }

    /// Binormal vector at the node before (0), at both nodes, and after (3).
    fn normal(&self, k: usize) -> Whole {
        cross(&self.around[k], &self.around[k + 1])
    }

    /// `a×b`, `a×c`, `b×c`.
    fn omega(&self) -> [Whole; 3] {
        [cross(&self.a, &self.b), cross(&self.a, &self.c), cross(&self.b, &self.c)]
    }

    /// Whether a criterion that applies holds; `None` for a double root.
    #[must_use]
    pub fn holds(
        &self,
        polygon: &DataPolygon,
        segment: usize,
        criterion: Criterion,
        around: [Requirements; 3],
        tolerances: &Tolerances,
    ) -> Option<bool> {
        let calls = around[1];
        match criterion {
            Criterion::Turning => Some(self.bends(around)),
            // Its verdict is one on rounding.
            Criterion::Regular => None,
            Criterion::Convexity => Some(self.normals().iter().all(|n| self.turns(n))),
            Criterion::GlobalConvexity => {
                let sees = |n: &Whole| {
                    self.turns(n)
                        && dot(&cross(&self.a, &self.chord), n) > BigInt::ZERO
                        && dot(&cross(&self.chord, &self.c), n) > BigInt::ZERO
                };
                Some(self.normals().iter().all(sees))
            }
            Criterion::Inflection => {
                let ([p, q], [start, _, end]) = (self.normals(), self.omega());
                let signs = [dot(&start, &p), -dot(&start, &q), -dot(&end, &p), dot(&end, &q)];
                Some(signs.iter().all(|x| *x > BigInt::ZERO))
            }
            Criterion::Torsion => {
                let twist = dot(&cross(&self.a, &self.b), &self.c);
                let right = calls.intersects(Requirements::RIGHT_TORSION);
                Some(if right { twist > BigInt::ZERO } else { twist < BigInt::ZERO })
            }
            Criterion::Coplanarity => {
                let parts = if calls.intersects(Requirements::COPLANARITY) {
                    vec![[0.0, 1.0]]
                } else {
                    let flip = inflection_parameter(polygon, segment);
                    vec![[0.0, 0.5 * flip], [0.5 * (1.0 + flip), 1.0]]
                };
                let [first, middle, last] = self.omega();
                let two = BigInt::from(2);
                let omega = [times(&first, &two), middle, times(&last, &two)];
                let normals = self.normals();
                let cases = parts.iter().flat_map(|part| normals.iter().map(move |n| (part, n)));
                all(cases.map(|(part, n)| inside(&omega, *part, n, tolerances.coplanarity)))
            }
            Criterion::Collinearity => {
                let tangent = [self.a.clone(), self.b.clone(), self.c.clone()];
                let line = |k: usize| mean_direction(&self.around[k + 1], &self.around[k + 2]);
                let epsilon = tolerances.collinearity;
                let start = calls.intersects(Requirements::LINE_AT_START);
                let end = calls.intersects(Requirements::LINE_AT_END);
                let start = start.then(|| inside(&tangent, [0.0, 0.5], &line(0), epsilon));
                let end = end.then(|| inside(&tangent, [0.5, 1.0], &line(1), epsilon));
                all(start.into_iter().chain(end))
            }
        }
    }

    /// Turning at both nodes, given what the segment and those beside it are asked.
    fn bends(&self, [before, calls, after]: [Requirements; 3]) -> bool {
        let [start, _, end] = self.omega();
        let sides = [cross(&self.a, &self.chord), cross(&self.chord, &self.c)];
        let sign = |calls: Requirements| {
            i32::from(calls.intersects(Requirements::CONVEXITY))
                - i32::from(calls.intersects(Requirements::INFLECTION))
        };
        let holds = |asked: Requirements,
                     bend: &Whole,
                     side: &Whole,
                     [own, other, far]: [usize; 3],
                     beside: Requirements| {
            let along = |k: usize| dot(bend, &self.normal(k));
            let agrees = |k: usize, sign: i32| sign == 0 || along(k) * sign > BigInt::ZERO;
            !calls.intersects(asked)
                || along(own) > BigInt::ZERO
                    && dot(side, &self.normal(own)) > BigInt::ZERO
                    && agrees(other, sign(calls))
                    && agrees(far, sign(beside))
        };
        holds(Requirements::TURNING_AT_START, &start, &sides[0], [1, 2, 0], before)
            && holds(Requirements::TURNING_AT_END, &end, &sides[1], [2, 1, 3], after)
    }

    /// `ω·n > 0` on the segment.
    fn turns(&self, n: &Whole) -> bool {
        let [alpha, gamma, beta] = self.omega().map(|w| dot(&w, n));
        let zero = BigInt::ZERO;
        let root = || &alpha * &beta * 4 > &gamma * &gamma;
        alpha > zero && beta > zero && (gamma >= zero || root())
    }
}

fn all(verdicts: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut known = Some(true);
    for verdict in verdicts {
        match verdict {
            Some(false) => return Some(false),
            Some(true) => {}
            None => known = None,
        }
    }
    known
}

/// The direction of `u/‖u‖ + v/‖v‖`, to 200 bits.
fn mean_direction(u: &Whole, v: &Whole) -> Whole {
    let length = |v: &Whole| (dot(v, v) << 400u32).sqrt();
    sum(&times(u, &length(v)), &times(v, &length(u)))
}

/// Whether a vector quadratic stays inside a double cone on a part of its interval.
fn inside(v: &[Whole; 3], [from, to]: [f64; 2], n: &Whole, epsilon: f64) -> Option<bool> {
    let one = BigInt::from(1) << SHIFT.cast_unsigned();
    let [from, to] = [from, to].map(|t| whole(t, SHIFT));
    let lerp = |u: &Whole, v: &Whole, t: &BigInt| sum(&times(u, &(&one - t)), &times(v, t));
    let blossom = |s: &BigInt, t: &BigInt| lerp(&lerp(&v[0], &v[1], s), &lerp(&v[1], &v[2], s), t);
    let part = [blossom(&from, &from), blossom(&from, &to), blossom(&to, &to)];
    let sine = whole(epsilon, SHIFT);
    let (within, beyond) = (&sine * &sine, &one * &one - &sine * &sine);
    let across = [0, 1, 2].map(|k| cross(&part[k], n));
    let depth = |i: usize, j: usize| {
        &within * dot(&part[i], n) * dot(&part[j], n) - &beyond * dot(&across[i], &across[j])
    };
    positive([
        depth(0, 0) * 6,
        depth(0, 1) * 6,
        depth(0, 2) * 2 + depth(1, 1) * 4,
        depth(1, 2) * 6,
        depth(2, 2) * 6,
    ])
}

/// Whether a quartic in Bernstein form is positive on `[0, 1]`.
fn positive(c: [BigInt; 5]) -> Option<bool> {
    let mut open = vec![(c, 0)];
    let mut known = Some(true);
    while let Some((c, depth)) = open.pop() {
        if c[0] <= BigInt::ZERO || c[4] <= BigInt::ZERO {
            return Some(false);
        }
        if c.iter().all(|x| *x > BigInt::ZERO) {
            continue;
        }
        if depth == DEPTH {
            known = None;
            continue;
        }
        let (mut right, mut left) = (c.clone(), c);
        for k in 1..5 {
            for j in 0..5 - k {
                right[j] = &right[j] + &right[j + 1];
            }
            left[k] = right[0].clone();
        }
        // Each sum in place of a mean is twice as much.
        for k in 0..5usize {
            left[k] = &left[k] << (4 - k);
            right[k] = &right[k] << k;
        }
        open.extend([(left, depth + 1), (right, depth + 1)]);
    }
    known
}
