// SPDX-License-Identifier: MIT OR Apache-2.0

//! The monotone cubic that maps a Bézier parameter to another one, and its inverse.

use shapespline_polynomial::bracketed_root;

/// The cubic on `[0, 1]` from 0 to 1 with slopes `0 < λ⁰, λ¹ ≤ 1` at its ends: (3.3) of paper 000 on
/// a segment brought to `[0, 1]`.
///
/// In Bernstein form it is `[0, λ⁰/3, 1 − λ¹/3, 1]`, so its derivative
/// `λ⁰(1−t)² + 2(3 − λ⁰ − λ¹) t(1−t) + λ¹t²` is positive: it increases strictly.
///
/// A parameter is passed as the pair `[1 − t, t]`, and a value as `[x, 1 − x]`: near either end the
/// small one of the two is what is known precisely, and what a slope of 1e−12 depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonotoneCubic {
    /// `λ⁰`, the slope at 0.
    pub start: f64,
    /// `λ¹`, the slope at 1.
    pub end: f64,
}

/// A Newton step of this part of `t` is the last: convergence is quadratic, so what remains is below
/// its square.
const LAST_STEP: f64 = 2e-8;

impl MonotoneCubic {
    /// First, second and third derivatives at `[1 − t, t]`.
    #[inline]
    #[must_use]
    pub fn derivatives(self, [s, t]: [f64; 2]) -> [f64; 3] {
        let Self { start, end } = self;
        let middle = 3.0 - start - end;
        [
            start * (s * s) + 2.0 * middle * (s * t) + end * (t * t),
            2.0 * ((middle - start) * s + (end - middle) * t),
            2.0 * ((end - middle) - (middle - start)),
        ]
    }

    /// Value at `t`.
    #[inline]
    #[must_use]
    pub fn value(self, t: f64) -> f64 {
        let Self { start, end } = self;
        let s = 1.0 - t;
        t * (start * (s * s) + 3.0 * (s * t) + (t * t)) - end * (s * t * t)
    }

    /// `[1 − t, t]` where the cubic has the value `x`, given as `[x, 1 − x]`.
    ///
    /// Exact at 0 and 1. Outside `[0, 1]` the map goes on as its end tangents. The half of the
    /// interval that holds the root is turned so that it begins at 0; there a quadratic guess is
    /// within 2 %, one step of fourth order leaves 1.3e−8 and one of Newton's iteration rounding
    /// (measured over all `λ`). If that last step was not small, Newton's iteration inside a shrinking
    /// bracket goes on.
    #[inline]
    #[must_use]
    pub fn solve(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let mut out = [[0.0; 2]; 1];
        let mut one = Batch::<1>::default();
        one.put(0, self, [x, y]);
        one.solve(&mut out);
        out[0]
    }
}

/// Values to be solved for together: without branches, so that the processor can do several at once.
pub(crate) struct Batch<const N: usize> {
    /// Slopes at the end that the root is nearer to, and at the other one.
    near: [f64; N],
    far: [f64; N],
    /// Value counted from the nearer end.
    value: [f64; N],
    /// Whether the nearer end is the first.
    first: [bool; N],
    count: usize,
}

impl<const N: usize> Default for Batch<N> {
    fn default() -> Self {
        let (ones, zeros) = ([1.0; N], [0.0; N]);
        Self { near: ones, far: ones, value: zeros, first: [true; N], count: 0 }
    }
}

impl<const N: usize> Batch<N> {
    /// Puts a map and `[x, 1 − x]` in place `j`.
    #[inline]
    pub(crate) fn put(&mut self, j: usize, map: MonotoneCubic, [x, y]: [f64; 2]) {
        // The map has the value ½ + (λ⁰ − λ¹)/8 at ½. Chosen, not branched on: which half it is
        // cannot be foreseen.
        let first = x <= 0.5 + 0.125 * (map.start - map.end);
        let select = |a: f64, b: f64| if first { a } else { b };
        self.near[j] = select(map.start, map.end);
        self.far[j] = select(map.end, map.start);
        self.value[j] = select(x, y);
        self.first[j] = first;
        self.count = j + 1;
    }

    /// `[1 − t, t]` of each.
    #[inline]
    pub(crate) fn solve(&self, out: &mut [[f64; 2]; N]) {
        let (mut root, mut step) = ([0.0; N], [0.0; N]);
        for j in 0..N {
            (root[j], step[j]) = near_zero(self.near[j], self.far[j], self.value[j]);
        }
        for j in 0..self.count {
            let (near, value, mut t) = (self.near[j], self.value[j], root[j]);
            // Beyond the end; or the last step was not small (or a NaN).
            if value < 0.0 {
                t = value / near;
            } else if !(step[j].abs() <= LAST_STEP * t) {
                t = bracketed(near, self.far[j], value, t);
            }
            let rest = 1.0 - t;
            out[j] = if self.first[j] { [rest, t] } else { [t, rest] };
        }
    }
}

/// The root `t ∈ [0, ½]` of `λt + kt² + ct³ = x` for `x` between 0 and the value at ½, and the last
/// step towards it.
#[inline]
fn near_zero(lambda: f64, far: f64, x: f64) -> (f64, f64) {
    let (k, c) = coefficients(lambda, far);
    // The cubic term as a quadratic one, with a rough t: `part` is x over the value at ½ (its
    // reciprocal as a series), and the factors are fitted.
    let bend = 0.25 * (lambda - far);
    let part = 2.0 * x * (1.0 - bend + bend * bend);
    let rough = k + c * (0.5 * part) * (1.0 + (1.0 - part) * (0.8 - 0.2 * lambda));
    let guess = 2.0 * x / (lambda + (lambda * lambda + 4.0 * rough * x).sqrt());
    let at = |t: f64| {
        let value = t * (lambda + t * (k + c * t)) - x;
        (value, lambda + t * (2.0 * k + 3.0 * c * t))
    };
    // Householder's step of third order.
    let (value, slope) = at(guess);
    let product = value * (k + 3.0 * c * guess);
    let square = slope * slope;
    let t =
        guess - value * (square - product) / (slope * (square - 2.0 * product) + value * value * c);
    let (value, slope) = at(t);
    let step = value / slope;
    (t - step, step)
}

/// `k` and `c` of `λt + kt² + ct³`.
#[inline]
fn coefficients(lambda: f64, far: f64) -> (f64, f64) {
    (3.0 - 2.0 * lambda - far, lambda + far - 2.0)
}

/// The same by Newton's iteration in a bracket, wherever the guess is.
#[cold]
fn bracketed(lambda: f64, far: f64, x: f64, guess: f64) -> f64 {
    let (k, c) = coefficients(lambda, far);
    // The root of zero is zero; a NaN stays one.
    if !(x > 0.0) {
        return x;
    }
    let at = |t: f64| (t * (lambda + t * (k + c * t)) - x, lambda + t * (2.0 * k + 3.0 * c * t));
    // At ½ rounding may leave the value on the wrong side.
    let end = at(0.5).0;
    if !(end > 0.0) {
        return 0.5;
    }
    bracketed_root(at, [0.0, 0.5], [-x, end], guess, [0.0, f64::EPSILON])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn slope() -> impl Strategy<Value = f64> {
        (-13.0..0.0f64, any::<bool>()).prop_map(|(e, one)| if one { 1.0 } else { 10f64.powf(e) })
    }

    /// The value at `t` near zero, without the cancellation of a general form.
    fn value(map: MonotoneCubic, t: f64) -> f64 {
        t * (map.start + t * ((3.0 - 2.0 * map.start - map.end) + t * (map.start + map.end - 2.0)))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn planted_roots_come_back(start in slope(), end in slope(), e in -40.0..0.0f64, turn: bool) {
            let map = MonotoneCubic { start, end };
            let planted = 0.5 * 10f64.powf(e);
            let x = value(map, planted);
            let [s, t] = if turn {
                let [s, t] = MonotoneCubic { start: end, end: start }.solve([1.0 - x, x]);
                [t, s]
            } else {
                map.solve([x, 1.0 - x])
            };
            prop_assert!((t - planted).abs() <= 1e-15 * planted, "{start} {end} {planted} {t}");
            prop_assert!((s - (1.0 - planted)).abs() <= 1e-15);
            prop_assert!((map.value(t) - x).abs() <= 1e-15);
        }

        #[test]
        fn any_value_is_met(start in slope(), end in slope(), x in 0.0..1.0f64) {
            let map = MonotoneCubic { start, end };
            let [s, t] = map.solve([x, 1.0 - x]);
            prop_assert!((0.0..=1.0).contains(&t) && (s + t - 1.0).abs() <= 2e-16);
            prop_assert!((map.value(t) - x).abs() <= 1e-15, "{} {}", map.value(t), x);
        }
    }

    #[test]
    fn ends_are_exact_and_nan_stays() {
        for start in [1.0, 0.3, 1e-12, 1e-200, 1e-308] {
            for end in [1.0, 0.7, 1e-12, 1e-200, 1e-308] {
                let map = MonotoneCubic { start, end };
                assert_eq!(map.solve([0.0, 1.0]), [1.0, 0.0]);
                assert_eq!(map.solve([1.0, 0.0]), [0.0, 1.0]);
                assert!(map.solve([f64::NAN, f64::NAN])[1].is_nan());
                let [s, t] = map.solve([0.5, 0.5]);
                assert!((0.0..=1.0).contains(&t) && (map.value(t) - 0.5).abs() < 1e-15);
                assert!((s + t - 1.0).abs() < 1e-15);
            }
        }
        let map = MonotoneCubic { start: 0.5, end: 0.25 };
        assert_eq!(map.solve([-1.0, 2.0])[1], -2.0);
        assert_eq!(map.solve([2.0, -1.0])[0], -4.0);
        let identity = MonotoneCubic { start: 1.0, end: 1.0 };
        assert_eq!(identity.solve([0.3, 0.7]), [0.7, 0.3]);
    }
}
