// SPDX-License-Identifier: MIT OR Apache-2.0

//! What keeps a condition `z > 0`: a logarithmic barrier, or an elastic one that takes any `z`.
//!
//! *Barrier*: `μ β(z)`, with `β(z) = −log ζ − (1 − ζ) − (1 − ζ)²/2`, `ζ = z/KNEE`, below the knee and 0
//! above it: twice continuously differentiable, as steep as the logarithm near zero, and silent where a
//! condition is clearly met. So the barrier moves nothing but what is near its bounds.
//!
//! *Elastic*: `ψ(z) = min_s ρ s − μ log(z + s) − μ log s`, the logarithmic barrier of the exact penalty
//! `ρ max(0, −z)` with its slack `s` eliminated in closed form: with `R = √(ρ²z² + 4μ²)`,
//! `z + s = (2μ + ρz + R)/2ρ` and `s = (2μ − ρz + R)/2ρ`.
//!
//! Both come with the primal–dual weight of their Hessian (A. Forsgren, P. E. Gill, SIAM J. Optim. 8
//! (1998) 1132–1152): a multiplier `λ` of its own in place of the primal `−β'(z)`, so that Newton's step
//! foresees how the barrier changes. Weight and gradient are those of the primal function otherwise, so a
//! step is a descent direction of it.

/// Above this size a condition is clearly met; the natural size is one.
const KNEE: f64 = 0.25;

/// Weight and kind of the barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Barrier {
    /// `μ`.
    pub(crate) weight: f64,
    /// `ρ`, of an elastic barrier.
    pub(crate) penalty: Option<f64>,
    /// Whether conditions that hold are kept by the barrier proper, and only those that fail are elastic.
    pub(crate) protects: bool,
}

/// Largest quotient of a multiplier and its primal value, by which it is safeguarded.
const SPREAD: f64 = 1e3;

impl Barrier {
    /// The barrier of a condition that is held, or not.
    pub(crate) fn of(self, held: bool) -> Self {
        if held { Self { penalty: None, ..self } } else { self }
    }

    /// The value at `z`, infinite where the barrier is not defined.
    pub(crate) fn value(&self, z: f64) -> f64 {
        let mu = self.weight;
        match self.penalty {
            None => {
                if z >= KNEE {
                    return 0.0;
                }
                if !(z > 0.0) {
                    return f64::INFINITY;
                }
                let zeta = z / KNEE;
                let rest = 1.0 - zeta;
                mu * (-zeta.ln() - rest - 0.5 * rest * rest)
            }
            Some(rho) => {
                let [gap, slack] = slacks(z, mu, rho);
                rho * slack - mu * (gap * slack).ln()
            }
        }
    }

    /// The primal multiplier `−β'(z)`.
    pub(crate) fn multiplier(&self, z: f64) -> f64 {
        let mu = self.weight;
        match self.penalty {
            None => {
                let zeta = z / KNEE;
                if zeta >= 1.0 { 0.0 } else { mu * (1.0 - zeta) * (1.0 - zeta) / z }
            }
            Some(rho) => mu / slacks(z, mu, rho)[0],
        }
    }

    /// The weight of `∇z ∇zᵀ` for a multiplier.
    pub(crate) fn stiffness(&self, z: f64, multiplier: f64) -> f64 {
        let mu = self.weight;
        match self.penalty {
            None => {
                let zeta = z / KNEE;
                if zeta >= 1.0 {
                    return 0.0;
                }
                (multiplier + 2.0 * mu * (1.0 - zeta) / KNEE) / z
            }
            Some(rho) => {
                let [gap, slack] = slacks(z, mu, rho);
                1.0 / (gap / multiplier + slack / (rho - multiplier))
            }
        }
    }

    /// A multiplier brought near its primal value at `z`.
    pub(crate) fn safeguarded(&self, z: f64, multiplier: f64) -> f64 {
        let primal = self.multiplier(z);
        // Outside of the barrier there is nothing to be near.
        if !(0.0..f64::INFINITY).contains(&primal) {
            return 0.0;
        }
        match self.penalty {
            None => multiplier.clamp(primal / SPREAD, primal * SPREAD),
            Some(rho) => {
                let rest = rho - primal;
                let low = (primal / SPREAD).max(rho - rest * SPREAD);
                let high = (primal * SPREAD).min(rho - rest / SPREAD);
                multiplier.clamp(low, high)
            }
        }
    }
}

/// `z + s` and `s` at the minimum over `s`, each without cancellation.
fn slacks(z: f64, mu: f64, rho: f64) -> [f64; 2] {
    let root = (rho * rho * z * z + 4.0 * mu * mu).sqrt();
    let x = rho * z;
    // The smaller of the two from their product: (2μ + R)² − x² = 4μ(2μ + R)… = 8μ² + 4μR.
    let product = (8.0 * mu * mu + 4.0 * mu * root) / (4.0 * rho * rho);
    let larger = (2.0 * mu + x.abs() + root) / (2.0 * rho);
    let smaller = product / larger;
    if x >= 0.0 { [larger, smaller] } else { [smaller, larger] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn barriers() -> [Barrier; 4] {
        let barrier = |weight, penalty| Barrier { weight, penalty, protects: false };
        [
            barrier(0.1, None),
            barrier(1e-3, None),
            barrier(0.1, Some(10.0)),
            barrier(1e-3, Some(1e4)),
        ]
    }

    proptest! {
        /// The multiplier is minus the slope, the stiffness at it minus the slope of the multiplier.
        #[test]
        fn derivatives_are_those_of_the_value(z in -0.5..0.5f64) {
            for barrier in barriers() {
                let z = if barrier.penalty.is_none() { z.abs() + 0.01 } else { z };
                let h = 1e-6 * z.abs().max(1e-3);
                let slope = (barrier.value(z + h) - barrier.value(z - h)) / (2.0 * h);
                let multiplier = barrier.multiplier(z);
                let size = multiplier.abs().max(barrier.weight);
                prop_assert!((slope + multiplier).abs() < 1e-5 * size, "{barrier:?} {z}");
                let change = (barrier.multiplier(z + h) - barrier.multiplier(z - h)) / (2.0 * h);
                let stiffness = barrier.stiffness(z, multiplier);
                let size = stiffness.abs().max(barrier.weight);
                let rounding = 4.0 * f64::EPSILON * multiplier / h;
                let error = (change + stiffness).abs();
                prop_assert!(error < 1e-4 * size + rounding, "{barrier:?} {z}");
                prop_assert!(stiffness >= 0.0 && multiplier >= 0.0);
            }
        }
    }

    #[test]
    fn far_from_zero_nothing_is_lost_to_cancellation() {
        let elastic = Barrier { weight: 1e-3, penalty: Some(1e4), protects: false };
        for z in [-1e3, -1.0, 1.0, 1e3] {
            let [gap, slack] = slacks(z, elastic.weight, 1e4);
            assert!(gap > 0.0 && slack > 0.0);
            // Both conditions of the minimum.
            let (x, y) = (elastic.weight / gap, elastic.weight / slack);
            assert!((x + y - 1e4).abs() < 1e-8, "{z}");
            assert!((gap - slack - z).abs() <= 1e-12 * z.abs());
        }
        let barrier = Barrier { weight: 1.0, penalty: None, protects: false };
        assert_eq!(barrier.value(0.0), f64::INFINITY);
        assert_eq!(barrier.value(-1.0), f64::INFINITY);
        assert_eq!((barrier.value(1.0), barrier.multiplier(1.0)), (0.0, 0.0));
    }
}
