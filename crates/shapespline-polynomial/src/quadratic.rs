// SPDX-License-Identifier: MIT OR Apache-2.0

//! Quadratics on `[0, 1]`: their sign and least value in closed form, and their products.

/// Whether `α(1−t)² + γ t(1−t) + β t² > 0` on `[0, 1]`: exactly when `α, β > 0` and
/// `2√(αβ) + γ > 0` (Karavelas and Kaklis 2000, Lemma 5.1).
#[inline]
#[must_use]
pub fn is_positive(alpha: f64, gamma: f64, beta: f64) -> bool {
    alpha > 0.0 && beta > 0.0 && (gamma >= 0.0 || 2.0 * (alpha.sqrt() * beta.sqrt()) + gamma > 0.0)
}

/// Where the quadratic of [`is_positive`] is smallest on `[0, 1]`.
#[must_use]
pub fn minimum(alpha: f64, gamma: f64, beta: f64) -> f64 {
    let end = if alpha <= beta { 0.0 } else { 1.0 };
    let curvature = alpha - gamma + beta;
    let t = (alpha - 0.5 * gamma) / curvature;
    if curvature > 0.0 && t > 0.0 && t < 1.0 { t } else { end }
}

/// Bernstein coefficients of the product of two quadratics.
#[inline]
#[must_use]
pub fn multiply(p: [f64; 3], q: [f64; 3]) -> [f64; 5] {
    [
        p[0] * q[0],
        0.5 * (p[0] * q[1] + p[1] * q[0]),
        (p[0] * q[2] + 4.0 * p[1] * q[1] + p[2] * q[0]) / 6.0,
        0.5 * (p[1] * q[2] + p[2] * q[1]),
        p[2] * q[2],
    ]
}

/// The value of a quadratic, such that rounding cannot change its sign where it is of one sign on `[0, 1]`: with the roots
/// `r` of the sizes of its end coefficients it is `(r₀(1−t) − r₁t)² + 2(b + r₀r₁)t(1−t)`, whose terms are not negative then.
#[inline]
#[must_use]
pub fn value(c: [f64; 3], t: f64) -> f64 {
    /// Error of b, a sum of terms of its size, relative to r₀r₁.
    const NOISE: f64 = 16.0 * f64::EPSILON;
    let falls = c[0] + c[2] < 0.0;
    let [a0, b, a1] = if falls { [0.0 - c[0], 0.0 - c[1], 0.0 - c[2]] } else { c };
    let s = 1.0 - t;
    let inside = 0.0 < t && t < 1.0 && a0 >= 0.0 && a1 >= 0.0 && b < 0.0;
    let product = if inside { a0.sqrt() * a1.sqrt() } else { 0.0 };
    let value = if inside && b >= -(1.0 + NOISE) * product {
        let difference = a0.sqrt() * s - a1.sqrt() * t;
        difference * difference + 2.0 * (b + product).max(0.0) * (t * s)
    } else {
        (a0 * s + b * t) * s + (b * s + a1 * t) * t
    };
    if falls { 0.0 - value } else { value }
}

/// Bernstein coefficients of `(t − r)(t − s)`.
#[cfg(test)]
pub(crate) fn planted(r: f64, s: f64) -> [f64; 3] {
    [r * s, 0.5 * (2.0 * r * s - r - s), (1.0 - r) * (1.0 - s)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Sign, bernstein};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_lemma_agrees_with_subdivision(alpha in -1.0..1.0f64, gamma in -3.0..3.0f64, beta in -1.0..1.0f64) {
            let c = [alpha, 0.5 * gamma, beta];
            prop_assert_eq!(is_positive(alpha, gamma, beta), Sign::of(&c).holds());
            let least = bernstein::value(&c, minimum(alpha, gamma, beta));
            for k in 0..=50 {
                prop_assert!(bernstein::value(&c, k as f64 / 50.0) >= least - 1e-15);
            }
        }

        #[test]
        fn a_double_root_never_looks_negative(r in 0.0..1.0f64, t in 0.0..1.0f64, size in -1e3..1e3f64) {
            let c = planted(r, r).map(|c| size * c);
            prop_assert!(value(c, t) * size >= 0.0);
            prop_assert!((value(c, t) - bernstein::value(&c, t)).abs() <= 1e-14 * size.abs());
        }
    }
}
