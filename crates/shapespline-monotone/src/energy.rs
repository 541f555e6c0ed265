// SPDX-License-Identifier: MIT OR Apache-2.0

//! The two energies of a quintic segment, and how they are weighted.

use crate::data::{Data, PowerOfTwo, Units, parts};

/// What the C² quintic minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Fairness {
    /// The bending energy `∫ y''² dx`: equation (20) with each segment's term times `hᵢ⁻³`.
    #[default]
    Bending,
    /// The paper's unweighted sum (20), `Σ ∫₀¹ (d²R/dt²)² dt`.
    Parametric,
}

impl std::str::FromStr for Fairness {
    type Err = crate::MonotoneError;
    fn from_str(value: &str) -> Result<Self, Self::Err> {
        match value {
            "bending" => Ok(Self::Bending),
            "parametric" => Ok(Self::Parametric),
            _ => Err(crate::MonotoneError::UnknownOption {
                argument: "fairness",
                value: value.to_owned(),
                expected: "bending, parametric",
            }),
        }
    }
}

impl Units {
    /// A scaled energy in the data's units: y²/x³ for the bending energy, y² for the parametric one.
    pub(crate) fn energy_out(self, fairness: Fairness, energy: f64) -> f64 {
        let y = PowerOfTwo::new(self.ey);
        let mut value = y.scale(energy);
        if fairness == Fairness::Bending {
            // Alternate the factors so that only a result out of range leaves the range.
            let x = PowerOfTwo::new(-self.ex);
            value = x.scale(value);
            value = y.scale(value);
            return x.scale(x.scale(value));
        }
        y.scale(value)
    }
}

/// `35·∫₀¹ R_tt² dt / (hΔ)²` of a segment with slopes `(1 + a₀)Δ`, `(1 + a₁)Δ` and second derivatives
/// `4b₀Δ/h`, `4b₁Δ/h`.
///
/// Equation (20) in the Hermite unknowns. In the deviations aᵢ from the secant it is a homogeneous quadratic: no
/// cancellation on smooth data, where the printed form subtracts numbers a million times the result.
#[inline]
pub(crate) fn local(a0: f64, b0: f64, a1: f64, b1: f64) -> f64 {
    192.0 * (a0 * a0 + a1 * a1) + 216.0 * a0 * a1 + b0 * (88.0 * a0 + 32.0 * a1)
        - b1 * (32.0 * a0 + 88.0 * a1)
        + 48.0 * (b0 * b0 + b1 * b1)
        + 16.0 * b0 * b1
}

/// The Hessian of half of [`local`]'s double, that is the matrix K with gradient `K·(a₀, b₀, a₁, b₁)`.
pub(crate) const HESSIAN: [[f64; 4]; 4] = [
    [384.0, 88.0, 216.0, -32.0],
    [88.0, 96.0, 32.0, 16.0],
    [216.0, 32.0, 384.0, -88.0],
    [-32.0, 16.0, -88.0, 96.0],
];

/// The weight of a segment: `weight·local/35` is its energy in scaled units.
#[inline]
pub(crate) fn weight(fairness: Fairness, h: f64, delta: f64) -> f64 {
    match fairness {
        Fairness::Bending => delta * (delta / h),
        Fairness::Parametric => (delta * h) * (delta * h),
    }
}

/// A segment too flat to carry a slope: its nodes get zero slope and curvature.
#[inline]
pub(crate) fn is_flat(delta: f64) -> bool {
    delta.abs() < 1e-140
}

/// The energy of nodal slopes and second derivatives, in scaled units. O(N).
pub(crate) fn total(data: &Data, fairness: Fairness, d: &[f64], s: &[f64]) -> f64 {
    /// Segments whose energies are worked out together.
    const TILE: usize = 64;
    // Sums of parts of one size: the same number on any number of threads.
    let parts = parts(data.len(), |part| {
        let mut sum = 0.0;
        for from in part.clone().step_by(TILE) {
            let n = TILE.min(part.end - from);
            let (h, delta) = (&data.h[from..from + n], &data.delta[from..from + n]);
            let (d, s) = (&d[from..=from + n], &s[from..=from + n]);
            let mut energies = [0.0; TILE];
            for i in 0..n {
                energies[i] = segment(fairness, h[i], delta[i], [d[i], s[i]], [d[i + 1], s[i + 1]]);
            }
            // In four sums, which are made side by side.
            let mut sums = [0.0; 4];
            for four in energies.chunks_exact(4) {
                sums.iter_mut().zip(four).for_each(|(sum, energy)| *sum += energy);
            }
            sum += (sums[0] + sums[1]) + (sums[2] + sums[3]);
        }
        sum
    });
    parts.iter().sum::<f64>() / 35.0
}

/// A segment's share of [`total`], times 35.
#[inline(always)]
fn segment(fairness: Fairness, h: f64, delta: f64, v0: [f64; 2], v1: [f64; 2]) -> f64 {
    let inverse = 1.0 / delta;
    let curvature = 0.25 * h * inverse;
    let e = local(
        (v0[0] - delta) * inverse,
        v0[1] * curvature,
        (v1[0] - delta) * inverse,
        v1[1] * curvature,
    );
    let energy = weight(fairness, h, delta) * e;
    if is_flat(delta) { 0.0 } else { energy }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Against Gauss–Legendre quadrature of the second derivative from the Bernstein form.
    #[test]
    fn agrees_with_quadrature() {
        let cases = [
            (1.0, 2.0, 0.3, 1.2, -0.4, 2.0),
            (0.25, -1.0, -3.0, 0.0, 2.0, 0.1),
            (3.0, 0.7, 0.7, 0.0, 0.7, 0.0),
        ];
        for (h, delta, d0, s0, d1, s1) in cases {
            let b = [
                0.0,
                h * d0 / 5.0,
                2.0 * h * d0 / 5.0 + h * h * s0 / 20.0,
                h * delta - 2.0 * h * d1 / 5.0 + h * h * s1 / 20.0,
                h * delta - h * d1 / 5.0,
                h * delta,
            ];
            let second = |t: f64| {
                let c: Vec<f64> =
                    (0..4).map(|k| 20.0 * (b[k + 2] - 2.0 * b[k + 1] + b[k])).collect();
                let u = 1.0 - t;
                c[0] * u * u * u
                    + 3.0 * c[1] * u * u * t
                    + 3.0 * c[2] * u * t * t
                    + c[3] * t * t * t
            };
            // Four Gauss points integrate degree 7 exactly; the square has degree 6.
            let (x1, w1) = (0.339_981_043_584_856_3, 0.652_145_154_862_546_1);
            let (x2, w2) = (0.861_136_311_594_052_6, 0.347_854_845_137_453_85);
            let gauss: f64 = [(x1, w1), (-x1, w1), (x2, w2), (-x2, w2)]
                .iter()
                .map(|(x, w)| 0.5 * w * second(0.5 + 0.5 * x).powi(2))
                .sum();
            let k = h / (4.0 * delta);
            let ours = (delta * h)
                * (delta * h)
                * local((d0 - delta) / delta, s0 * k, (d1 - delta) / delta, s1 * k)
                / 35.0;
            assert!((gauss - ours).abs() <= 1e-13 * (1.0 + gauss), "{gauss} {ours}");
        }
    }
}
