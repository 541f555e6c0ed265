// SPDX-License-Identifier: MIT OR Apache-2.0

//! Bernstein polynomials and their signs on an interval, decided, not sampled.
//!
//! A polynomial of degree `n` is held as its `n + 1` Bernstein coefficients on `[0, 1]`. All of them
//! positive prove it positive; its end coefficients are its end values; and de Casteljau's
//! subdivision halves the interval and closes in on the polynomial quadratically. So a sign is
//! either proved, or refuted by a value, or left open on an interval so small that the polynomial
//! is below rounding there (a double root).

/// What is known of the sign of a polynomial on an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Positivity {
    /// Greater than zero everywhere.
    Positive,
    /// Not greater than zero at a parameter.
    Fails {
        /// The parameter.
        at: f64,
    },
    /// Zero to rounding on an interval around a parameter, positive elsewhere as far as seen.
    Undecided {
        /// The parameter.
        at: f64,
    },
}

impl Positivity {
    /// Whether positivity is proved.
    #[must_use]
    pub fn holds(self) -> bool {
        self == Self::Positive
    }
}

/// Whether `α(1−t)² + γ t(1−t) + β t² > 0` on `[0, 1]`: exactly when `α, β > 0` and
/// `2√(αβ) + γ > 0` (paper 001, Lemma 5.1).
#[inline]
#[must_use]
pub fn quadratic_is_positive(alpha: f64, gamma: f64, beta: f64) -> bool {
    alpha > 0.0 && beta > 0.0 && (gamma >= 0.0 || 2.0 * (alpha.sqrt() * beta.sqrt()) + gamma > 0.0)
}

/// Where the quadratic of [`quadratic_is_positive`] is smallest on `[0, 1]`.
#[must_use]
pub fn quadratic_minimum(alpha: f64, gamma: f64, beta: f64) -> f64 {
    let end = if alpha <= beta { 0.0 } else { 1.0 };
    let curvature = alpha - gamma + beta;
    let t = (alpha - 0.5 * gamma) / curvature;
    if curvature > 0.0 && t > 0.0 && t < 1.0 { t } else { end }
}

/// Bernstein coefficients of the product of two quadratics.
#[inline]
#[must_use]
pub fn multiply_quadratics(p: [f64; 3], q: [f64; 3]) -> [f64; 5] {
    [
        p[0] * q[0],
        0.5 * (p[0] * q[1] + p[1] * q[0]),
        (p[0] * q[2] + 4.0 * p[1] * q[1] + p[2] * q[0]) / 6.0,
        0.5 * (p[1] * q[2] + p[2] * q[1]),
        p[2] * q[2],
    ]
}

/// De Casteljau's subdivision at `t`: the coefficients on `[0, t]` and on `[t, 1]`.
#[must_use]
pub fn subdivide<const N: usize>(mut c: [f64; N], t: f64) -> ([f64; N], [f64; N]) {
    let mut left = c;
    for k in 1..N {
        for j in 0..N - k {
            c[j] = c[j] * (1.0 - t) + c[j + 1] * t;
        }
        left[k] = c[0];
    }
    // `c` now holds the right part: c[j] was last written at the step that made it final.
    (left, c)
}

/// Coefficients on the part `[from, to]` of `[0, 1]`.
#[must_use]
pub fn restrict<const N: usize>(c: [f64; N], from: f64, to: f64) -> [f64; N] {
    let (_, right) = if from > 0.0 { subdivide(c, from) } else { (c, c) };
    if to < 1.0 { subdivide(right, (to - from) / (1.0 - from)).0 } else { right }
}

/// Whether the polynomial is positive on all of `[0, 1]`.
///
/// Cost: one pass over the coefficients when they are all positive, else one subdivision a level
/// around each place where the polynomial is near zero; at most 60 levels.
#[must_use]
pub fn positivity<const N: usize>(c: [f64; N]) -> Positivity {
    let size = c.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    search(c, 0.0, 1.0, size * f64::EPSILON * N as f64, 60)
}

fn search<const N: usize>(c: [f64; N], from: f64, to: f64, noise: f64, depth: u32) -> Positivity {
    // Written so that a NaN fails.
    if !(c[0] > 0.0) {
        return Positivity::Fails { at: from };
    }
    if !(c[N - 1] > 0.0) {
        return Positivity::Fails { at: to };
    }
    if c.iter().all(|&x| x > 0.0) {
        return Positivity::Positive;
    }
    let middle = 0.5 * (from + to);
    if depth == 0 || c.iter().all(|x| x.abs() <= noise) {
        return Positivity::Undecided { at: middle };
    }
    let (left, right) = subdivide(c, 0.5);
    match search(left, from, middle, noise, depth - 1) {
        Positivity::Positive => search(right, middle, to, noise, depth - 1),
        found => found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value<const N: usize>(c: [f64; N], t: f64) -> f64 {
        subdivide(c, t).1[0]
    }

    /// Bernstein coefficients of `scale · (t − r)(t − s)((t − p)² + q)`.
    fn planted_quartic(r: f64, s: f64, p: f64, q: f64) -> [f64; 5] {
        let first = [r * s, 0.5 * (2.0 * r * s - r - s), (1.0 - r) * (1.0 - s)];
        let second = [p * p + q, p * p - p + q, (1.0 - p).powi(2) + q];
        multiply_quadratics(first, second)
    }

    proptest! {
        #[test]
        fn planted_roots_decide(r in -1.0..2.0f64, s in -1.0..2.0f64, p in -1.0..2.0f64, q in 0.01..1.0f64) {
            let inside = |x: f64| (0.0..=1.0).contains(&x);
            prop_assume!((r - s).abs() > 1e-6);
            let c = planted_quartic(r, s, p, q);
            let positive = !inside(r) && !inside(s) && (r < 0.0) == (s < 0.0);
            prop_assert_eq!(positivity(c).holds(), positive);
            if let Positivity::Fails { at } = positivity(c) {
                prop_assert!(value(c, at) <= 1e-14);
            }
        }

        #[test]
        fn restriction_keeps_values(c in proptest::array::uniform5(-1.0..1.0f64), f in 0.0..0.5f64, g in 0.5..1.0f64, t in 0.0..1.0f64) {
            let part = restrict(c, f, g);
            prop_assert!((value(part, t) - value(c, f + (g - f) * t)).abs() < 1e-13);
        }

        #[test]
        fn lemma_5_1_agrees_with_subdivision(alpha in -1.0..1.0f64, gamma in -3.0..3.0f64, beta in -1.0..1.0f64) {
            let closed = quadratic_is_positive(alpha, gamma, beta);
            prop_assert_eq!(closed, positivity([alpha, 0.5 * gamma, beta]).holds());
            let at = quadratic_minimum(alpha, gamma, beta);
            let least = value([alpha, 0.5 * gamma, beta], at);
            for k in 0..=50 {
                prop_assert!(value([alpha, 0.5 * gamma, beta], k as f64 / 50.0) >= least - 1e-15);
            }
        }
    }

    #[test]
    fn a_double_root_is_not_called_positive() {
        let root = 1.0 / 3.0;
        let square = [root * root, -root * (1.0 - root), (1.0 - root) * (1.0 - root)];
        assert!(!positivity(square).holds());
        assert!(!positivity(multiply_quadratics(square, [1.0, 2.0, 1.0])).holds());
        let mut lifted = square;
        lifted.iter_mut().for_each(|c| *c += 1e-12);
        assert!(positivity(lifted).holds());
    }
}
