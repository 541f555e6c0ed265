// SPDX-License-Identifier: MIT OR Apache-2.0

//! Cubic, quartic and quintic Bézier-like curves in any dimension (paper 003, equations (1)–(8)).
//!
//! All have four control points V₀ … V₃ and pass through the first and the last. With F₀ … F₃ the cubic basis (1):
//! - cubic: `r(t; a, b) = Σ Fᵢ(t; a, b) Vᵢ`;
//! - quartic: `Q = (1−t) r(t; a, b) + t r(t; p, q)` with shape parameters `α = p/a`, `β = b/q` (3);
//! - quintic: `R = (1−t)² r(t; a, b) + 2t(1−t) r(t; p, q) + t² r(t; f, g)` with `p = a/2, q = g/2` (erratum E11: the
//!   paper prints "p = a/2 and p = q/2") and shape parameters `α = f/a`, `β = b/g` (7).
//!
//! End derivatives are `a(V₁−V₀)` and `b(V₃−V₂)` (cubic), `a(V₁−V₀)` and `q(V₃−V₂)` (quartic), `a(V₁−V₀)` and
//! `g(V₃−V₂)` (quintic). The basis sums to 1 for all parameters, and is non-negative, so that the curve stays in the
//! convex hull of its control points, when all parameters of the cubic curves involved are in [0, 3]. Growing α (β)
//! sweeps a nested family: `∂Q/∂α = m₀u²t²`, `∂R/∂α = m₀u²t³` (9), `∂Q/∂β = −m₁u²t²`, `∂R/∂β = −m₁u³t²` (10).

use crate::MonotoneError;
use shapespline_polynomial::bernstein;

/// Which curve, with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BezierLike {
    /// The cubic (1) with parameters a, b.
    Cubic {
        /// Multiple of V₁ − V₀ at the start.
        a: f64,
        /// Multiple of V₃ − V₂ at the end.
        b: f64,
    },
    /// The quartic (3).
    Quartic {
        /// Multiple of V₁ − V₀ at the start.
        a: f64,
        /// Multiple of V₃ − V₂ at the end.
        q: f64,
        /// Shape parameter α = p/a.
        alpha: f64,
        /// Shape parameter β = b/q.
        beta: f64,
    },
    /// The quintic (7).
    Quintic {
        /// Multiple of V₁ − V₀ at the start.
        a: f64,
        /// Multiple of V₃ − V₂ at the end.
        g: f64,
        /// Shape parameter α = f/a.
        alpha: f64,
        /// Shape parameter β = b/g.
        beta: f64,
    },
}

/// The cubic Bézier-like basis F₀ … F₃ of (1) at t.
///
/// Non-negative on [0, 1] for 0 ≤ a, b ≤ 3; sums to 1 for all a, b. a = b = 3 is the Bernstein basis.
#[must_use]
pub fn cubic_basis(t: f64, a: f64, b: f64) -> [f64; 4] {
    let u = 1.0 - t;
    [u * u * (1.0 + t * (2.0 - a)), a * u * u * t, b * u * t * t, t * t * (1.0 + u * (2.0 - b))]
}

impl BezierLike {
    /// The degree in t.
    #[must_use]
    pub fn degree(&self) -> usize {
        match self {
            Self::Cubic { .. } => 3,
            Self::Quartic { .. } => 4,
            Self::Quintic { .. } => 5,
        }
    }

    /// The weights of V₀ … V₃ at t.
    #[must_use]
    pub fn basis(&self, t: f64) -> [f64; 4] {
        let mut out = [0.0; 4];
        for (weight, a, b) in self.cubics(t) {
            for (o, f) in out.iter_mut().zip(cubic_basis(t, a, b)) {
                *o += weight * f;
            }
        }
        out
    }

    /// The cubic curves that are mixed: weight at t and parameters.
    fn cubics(&self, t: f64) -> Vec<(f64, f64, f64)> {
        let u = 1.0 - t;
        match *self {
            Self::Cubic { a, b } => vec![(1.0, a, b)],
            Self::Quartic { a, q, alpha, beta } => {
                vec![(u, a, beta * q), (t, alpha * a, q)]
            }
            Self::Quintic { a, g, alpha, beta } => {
                vec![(u * u, a, beta * g), (2.0 * u * t, 0.5 * a, 0.5 * g), (t * t, alpha * a, g)]
            }
        }
    }

    /// Whether all parameters are in the range [0, 3] in which the basis is non-negative and the curve stays in the
    /// convex hull of its control points.
    #[must_use]
    pub fn is_positive(&self) -> bool {
        self.cubics(0.5).iter().all(|(_, a, b)| (0.0..=3.0).contains(a) && (0.0..=3.0).contains(b))
    }

    /// Bernstein weights: row k gives the k-th Bézier point as weights of V₀ … V₃.
    #[must_use]
    pub fn bernstein_weights(&self) -> Vec<[f64; 4]> {
        match *self {
            Self::Cubic { a, b } => vec![
                [1.0, 0.0, 0.0, 0.0],
                [1.0 - a / 3.0, a / 3.0, 0.0, 0.0],
                [0.0, 0.0, b / 3.0, 1.0 - b / 3.0],
                [0.0, 0.0, 0.0, 1.0],
            ],
            Self::Quartic { a, q, alpha, beta } => {
                // V₀, V₀+m₀/4, (V₀+V₃)/2 + (αm₀−βm₁)/6, V₃−m₁/4, V₃.
                let (s, e) = (alpha * a / 6.0, beta * q / 6.0);
                vec![
                    [1.0, 0.0, 0.0, 0.0],
                    [1.0 - a / 4.0, a / 4.0, 0.0, 0.0],
                    [0.5 - s, s, e, 0.5 - e],
                    [0.0, 0.0, q / 4.0, 1.0 - q / 4.0],
                    [0.0, 0.0, 0.0, 1.0],
                ]
            }
            Self::Quintic { a, g, alpha, beta } => {
                // V₀, V₀+m₀/5, (7V₀+3V₃+m₀−βm₁)/10, (3V₀+7V₃+αm₀−m₁)/10, V₃−m₁/5, V₃.
                let tenth = |v: f64| v / 10.0;
                vec![
                    [1.0, 0.0, 0.0, 0.0],
                    [1.0 - a / 5.0, a / 5.0, 0.0, 0.0],
                    [tenth(7.0 - a), tenth(a), tenth(beta * g), tenth(3.0 - beta * g)],
                    [tenth(3.0 - alpha * a), tenth(alpha * a), tenth(g), tenth(7.0 - g)],
                    [0.0, 0.0, g / 5.0, 1.0 - g / 5.0],
                    [0.0, 0.0, 0.0, 1.0],
                ]
            }
        }
    }

    /// Bézier points of the curve with the given control points: `degree + 1` points of the same dimension, flat.
    ///
    /// `control` holds V₀ … V₃ one after another; its length is four times the dimension.
    ///
    /// # Errors
    /// [`MonotoneError::Length`] when it is not, [`MonotoneError::NotFinite`] for NaN or infinity.
    pub fn bezier_points(&self, control: &[f64]) -> Result<Vec<f64>, MonotoneError> {
        let dim = control.len() / 4;
        if dim == 0 || control.len() != 4 * dim {
            let expected = 4 * (dim + 1);
            return Err(MonotoneError::Length {
                argument: "control",
                found: control.len(),
                expected,
            });
        }
        crate::data::check_finite("control", control)?;
        let mut out = Vec::with_capacity((self.degree() + 1) * dim);
        for weights in self.bernstein_weights() {
            for k in 0..dim {
                out.push((0..4).map(|j| weights[j] * control[j * dim + k]).sum());
            }
        }
        Ok(out)
    }

    /// The derivative of order `nu` (0: the point) at every parameter; one point after another.
    ///
    /// # Errors
    /// As [`Self::bezier_points`].
    pub fn evaluate(
        &self,
        control: &[f64],
        parameters: &[f64],
        nu: usize,
    ) -> Result<Vec<f64>, MonotoneError> {
        let points = self.bezier_points(control)?;
        let dim = control.len() / 4;
        let mut out = vec![0.0; dim * parameters.len()];
        for k in 0..dim {
            let mut b: Vec<f64> = points.iter().skip(k).step_by(dim).copied().collect();
            for _ in 0..nu {
                b = bernstein::derivative(&b);
            }
            for (row, &t) in out.chunks_mut(dim).zip(parameters) {
                row[k] = bernstein::value(&b, t);
            }
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn curves() -> Vec<BezierLike> {
        vec![
            BezierLike::Cubic { a: 2.0, b: 1.2 },
            BezierLike::Quartic { a: 2.5, q: 1.5, alpha: 0.8, beta: 1.7 },
            BezierLike::Quintic { a: 1.5, g: 2.5, alpha: 1.9, beta: 0.4 },
        ]
    }

    #[test]
    fn basis_is_a_partition_of_unity_and_positive_in_range() {
        for curve in curves() {
            assert!(curve.is_positive());
            for k in 0..=100 {
                let basis = curve.basis(f64::from(k) / 100.0);
                assert!((basis.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(basis.iter().all(|v| *v >= 0.0));
            }
        }
        let wide = BezierLike::Quartic { a: 2.0, q: 2.0, alpha: 8.0, beta: 1.0 };
        assert!(!wide.is_positive());
        assert!((0..100).any(|k| wide.basis(f64::from(k) / 100.0).iter().any(|v| *v < 0.0)));
    }

    #[test]
    fn bernstein_form_is_the_curve() {
        let control = [0.0, 1.0, 2.0, 1.0, -1.0, 0.5, 3.0, 2.0, 0.0, 4.0, 0.0, 1.0];
        let ts: Vec<f64> = (0..=40).map(|k| f64::from(k) / 40.0).collect();
        for curve in curves() {
            let points = curve.evaluate(&control, &ts, 0).unwrap();
            for (t, p) in ts.iter().zip(points.chunks(3)) {
                let basis = curve.basis(*t);
                for k in 0..3 {
                    let direct: f64 = (0..4).map(|j| basis[j] * control[3 * j + k]).sum();
                    assert!((direct - p[k]).abs() < 1e-13, "{curve:?} {t}");
                }
            }
        }
    }

    /// Equations (9), (10): nested families; figures 1–6 use m₀ = 3, m₁ = 4 and the values 0, 1, 3, 8, 20.
    #[test]
    fn shape_parameters_sweep_nested_families() {
        let (m0, m1) = (3.0, 4.0);
        let control = [0.0, 1.0, 1.0, 2.0];
        // a(V₁−V₀) = m₀, q(V₃−V₂) = m₁.
        let (a, q) = (m0, m1);
        let values = [0.0, 1.0, 3.0, 8.0, 20.0];
        for t in [0.1f64, 0.4, 0.7, 0.95] {
            let u = 1.0 - t;
            let at = |c: BezierLike| c.evaluate(&control, &[t], 0).unwrap()[0];
            for w in values.windows(2) {
                let step = w[1] - w[0];
                let quartic = |alpha, beta| at(BezierLike::Quartic { a, q, alpha, beta });
                let quintic = |alpha, beta| at(BezierLike::Quintic { a, g: q, alpha, beta });
                let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-12, "{x} {y}");
                close(quartic(w[1], 1.0) - quartic(w[0], 1.0), step * m0 * u * u * t * t);
                close(quartic(1.0, w[1]) - quartic(1.0, w[0]), -step * m1 * u * u * t * t);
                close(quintic(w[1], 1.0) - quintic(w[0], 1.0), step * m0 * u * u * t * t * t);
                close(quintic(1.0, w[1]) - quintic(1.0, w[0]), -step * m1 * u * u * u * t * t);
                // μ: (11).
                close(quartic(w[1], w[1]) - quartic(w[0], w[0]), step * (m0 - m1) * u * u * t * t);
            }
        }
    }

    #[test]
    fn end_derivatives_and_bad_input() {
        let control = [0.0, 1.0, 1.0, 2.0];
        for curve in curves() {
            let (start, end) = match curve {
                BezierLike::Cubic { a, b } => (a, b),
                BezierLike::Quartic { a, q, .. } => (a, q),
                BezierLike::Quintic { a, g, .. } => (a, g),
            };
            let d = curve.evaluate(&control, &[0.0, 1.0], 1).unwrap();
            assert!((d[0] - start).abs() < 1e-14 && (d[1] - end).abs() < 1e-14);
            assert!(curve.evaluate(&[1.0; 7], &[0.5], 0).is_err());
            assert!(curve.evaluate(&[f64::NAN; 4], &[0.5], 0).is_err());
        }
    }
}
