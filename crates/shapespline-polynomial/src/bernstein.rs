// SPDX-License-Identifier: MIT OR Apache-2.0

//! Polynomials on `[0, 1]` as their Bernstein coefficients: `Σ c_k B_k(t)`, `B_k = C(n, k) tᵏ (1−t)ⁿ⁻ᵏ`.
//!
//! Coefficients are in an array or a vector. They bound the polynomial, the first and the last are its end values,
//! and subdivision brings both together quadratically: that is what proofs of signs rest on ([`crate::Sign`]).

use std::ops::{Add, Mul, Sub};

/// What a coefficient has to be able to do.
pub trait Coefficient:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// Its size.
    fn size(self) -> f64;
}

impl Coefficient for f64 {
    #[inline]
    fn size(self) -> f64 {
        self.abs()
    }
}

#[cfg(feature = "glam")]
impl Coefficient for glam::DVec3 {
    #[inline]
    fn size(self) -> f64 {
        self.length()
    }
}

#[cfg(feature = "glam")]
impl Coefficient for glam::DVec4 {
    #[inline]
    fn size(self) -> f64 {
        self.length()
    }
}

/// De Casteljau's algorithm: so many steps of means `(1−t) c_j + t c_{j+1}` in place, each one shorter than that before.
/// `first` is called with the number of each step and the first mean it leaves.
#[inline(always)]
fn means<T: Coefficient>(c: &mut [T], t: f64, steps: usize, mut first: impl FnMut(usize, T)) {
    let (n, s) = (c.len(), 1.0 - t);
    for k in 1..=steps {
        for j in 0..n - k {
            c[j] = c[j] * s + c[j + 1] * t;
        }
        first(k, c[0]);
    }
}

/// How far rounding may move a value of a polynomial of so many coefficients, the largest of this size: one unit in the
/// last place of that for each of them, from de Casteljau's means.
#[inline]
#[must_use]
pub fn rounding(count: usize, size: f64) -> f64 {
    f64::EPSILON * size * count as f64
}

/// The coefficients on `[0, t]` and on `[t, 1]`, of an array or a vector.
///
/// De Casteljau's subdivision, O(n²). The end values stay to the bit, and both parts have the same value at `t`, that of
/// [`value`]. Halving rounds by less than [`rounding`] in all, however often it is repeated: each mean adds half a unit in
/// the last place, and the coefficients come together.
#[inline]
#[must_use]
pub fn split<T: Coefficient, C: AsMut<[T]> + Clone>(c: C, t: f64) -> (C, C) {
    let (mut left, mut right) = (c.clone(), c);
    let (ends, c) = (left.as_mut(), right.as_mut());
    let steps = c.len().saturating_sub(1);
    means(c, t, steps, |k, first| ends[k] = first);
    (left, right)
}

/// The coefficients on the part `[from, to]`, `0 ≤ from ≤ to ≤ 1`: cut at `to` and then at `from`.
#[must_use]
pub fn part<T: Coefficient, C: AsMut<[T]> + Clone>(c: C, [from, to]: [f64; 2]) -> C {
    let left = if to < 1.0 { split(c, to).0 } else { c };
    if from > 0.0 && to > 0.0 { split(left, from / to).1 } else { left }
}

/// The value at `t`, inside `[0, 1]` and beyond, by de Casteljau's algorithm: O(n²), with an error of at most [`rounding`]
/// inside. No memory is taken up to degree 7.
#[must_use]
pub fn value<T: Coefficient>(c: &[T], t: f64) -> T {
    // Loops of a length that is known beforehand take a quarter of the time.
    match c.len() {
        2 => value_of::<T, 2>(c, t),
        3 => value_of::<T, 3>(c, t),
        4 => value_of::<T, 4>(c, t),
        5 => value_of::<T, 5>(c, t),
        6 => value_of::<T, 6>(c, t),
        7 => value_of::<T, 7>(c, t),
        8 => value_of::<T, 8>(c, t),
        n => {
            let mut c = c.to_vec();
            means(&mut c, t, n - 1, |_, _| ());
            c[0]
        }
    }
}

#[inline(always)]
fn value_of<T: Coefficient, const N: usize>(c: &[T], t: f64) -> T {
    let mut w = [T::default(); N];
    w.copy_from_slice(c);
    means(&mut w, t, N - 1, |_, _| ());
    w[0]
}

/// The value and the first derivative at `t`, by de Casteljau's algorithm.
#[inline]
#[must_use]
pub fn value_and_slope<const N: usize>(mut c: [f64; N], t: f64) -> (f64, f64) {
    const { assert!(N > 1) };
    means(&mut c, t, N - 2, |_, _| ());
    (c[0] * (1.0 - t) + c[1] * t, (N - 1) as f64 * (c[1] - c[0]))
}

/// The value at `t ∈ [0, 1]` by Horner's rule in `t`, with the powers of `1 − t` taken along: no memory and O(n), where
/// [`value`] takes O(n²).
#[must_use]
pub fn horner<T: Coefficient>(c: &[T], t: f64) -> T {
    let n = c.len() - 1;
    let (s, mut weight) = (1.0 - t, 1.0);
    let mut sum = c[0];
    for (k, &c) in c.iter().enumerate().skip(1) {
        weight *= t * (n + 1 - k) as f64 / k as f64;
        sum = sum * s + c * weight;
    }
    sum
}

/// The coefficients of the derivative; of a constant the zero.
#[must_use]
pub fn derivative<T: Coefficient>(c: &[T]) -> Vec<T> {
    if c.len() < 2 {
        return vec![T::default()];
    }
    let n = (c.len() - 1) as f64;
    c.windows(2).map(|w| (w[1] - w[0]) * n).collect()
}

/// Taylor coefficients outwards from an end: of `p(1 + τ)`, or of `p(−τ)`.
#[must_use]
pub fn taylor(c: &[f64], right: bool) -> Vec<f64> {
    let n = c.len() - 1;
    let mut ordered: Vec<f64> = c.to_vec();
    if right {
        ordered.reverse();
    }
    // Forward differences at the end: aₖ = C(n, k) (−1)ᵏ Δᵏ for the outward direction.
    let mut out = Vec::with_capacity(n + 1);
    let mut binomial = 1.0;
    let mut outward = 1.0;
    for k in 0..=n {
        out.push(outward * binomial * ordered[0]);
        for j in 0..n - k {
            ordered[j] = ordered[j + 1] - ordered[j];
        }
        binomial *= (n - k) as f64 / (k + 1) as f64;
        outward = -outward;
    }
    out
}

/// The binomial coefficients of a row, as numbers (exact up to row 56).
#[must_use]
pub fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0; n + 1];
    for k in 1..=n {
        row[k] = (row[k - 1] * (n + 1 - k) as f64 / k as f64).round();
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn parts_and_forms_keep_values(
            c in proptest::collection::vec(-1.0..1.0f64, 2..14),
            f in 0.0..0.5f64, g in 0.5..1.0f64, t in 0.0..1.0f64,
        ) {
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            let at = f + (g - f) * t;
            prop_assert!(near(value(&part(c.clone(), [f, g]), t), value(&c, at)));
            prop_assert!(near(horner(&c, at), value(&c, at)));
            let (left, right) = split(c.clone(), f);
            prop_assert_eq!((left[0], right[c.len() - 1]), (c[0], c[c.len() - 1]));
            prop_assert_eq!(left[c.len() - 1], right[0]);
            prop_assert_eq!(right[0], value(&c, f));
            // Taylor's form about the end, back at t − 1.
            let outward = taylor(&c, true);
            let back: f64 = outward.iter().rev().fold(0.0, |sum, a| sum * (t - 1.0) + a);
            let size: f64 = outward.iter().map(|a| a.abs()).sum();
            prop_assert!((back - value(&c, t)).abs() < 1e-14 * (1.0 + size));
        }

        #[test]
        fn slopes_are_the_derivative(c in proptest::array::uniform5(-1.0..1.0f64), t in 0.0..1.0f64) {
            let (at, slope) = value_and_slope(c, t);
            prop_assert_eq!(at, value(&c, t));
            prop_assert!((slope - value(&derivative(&c), t)).abs() < 1e-14);
        }
    }
}
