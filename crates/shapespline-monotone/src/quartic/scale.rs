// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest admissible λ of a segment: conditions (12), (13), theorem 1 and the four cases.

use crate::segment_polynomial::TILE;

/// λ is lowered by this much below the largest admissible one, so that the derivative stays strictly non-negative
/// after rounding.
const INSIDE: f64 = 1.0 - 1e-12;

/// Conditions (12), (13): whether the full e leaves both inner coefficients of the derivative non-negative. Both
/// cannot fail: their sum is 4 − a − d ≥ 0.
#[inline(always)]
pub(super) fn keeps(a: f64, d: f64, full: f64) -> bool {
    (2.0 - a + full >= 0.0) & (2.0 - d - full >= 0.0)
}

/// Segments whose conditions fail, side by side, for their λ to be found several at once.
pub(super) struct Failing {
    /// The end slopes over the secant, in [0, 2], and the full e, all turned (t ↔ 1 − t) so that C fails.
    near: [f64; TILE],
    far: [f64; TILE],
    full: [f64; TILE],
    /// 3K, and σ.
    k: [f64; TILE],
    sigma: [f64; TILE],
    /// The answers.
    pub(super) lambda: [f64; TILE],
}

impl Default for Failing {
    fn default() -> Self {
        let zeros = [0.0; TILE];
        Self { near: zeros, far: zeros, full: zeros, k: zeros, sigma: zeros, lambda: zeros }
    }
}

impl Failing {
    /// Segment j is one with these end slopes over the secant and this full e.
    #[inline(always)]
    pub(super) fn set(&mut self, j: usize, a: f64, d: f64, full: f64) {
        let turn = 2.0 - a + full < 0.0;
        (self.near[j], self.far[j]) = (if turn { d } else { a }, if turn { a } else { d });
        self.full[j] = if turn { -full } else { full };
        let sum = 4.0 - a - d;
        self.k[j] = if sum > 0.0 { 3.0 * sum } else { 0.0 };
    }

    /// Of the first `count` the largest λ ∈ [0, 1] for which the derivative (4) with `e = λ full` is non-negative on
    /// [0, 1].
    ///
    /// The admissible e form an interval around 0 (non-negativity is an intersection of half-planes), so the boundary
    /// in one direction is a single point: there the derivative has a double root at some σ = t/(1−t), and with the
    /// coefficients a, 3B, 3C, d in powers of s it is `d(s − σ)²(s + a/(dσ²))`. Hence `3C = a/σ² − 2dσ`, and B + C =
    /// 4 − a − d = K leaves `dσ⁴ − 2dσ³ − 3Kσ² − 2aσ + a = 0`. Its signs + − − − + allow two positive roots, and at 1
    /// it is negative: one root below 1 (where the other coefficient fails, by symmetry the same case) and one above,
    /// which is wanted. There the quartic rises and is convex: from close by Halley's iteration finds it and no other.
    /// Φ of theorem 1 is the discriminant of the same cubic, with roots that mean nothing besides.
    #[inline(always)]
    pub(super) fn solve(&mut self, count: usize) {
        // One loop a step, with few selections in each: the compiler then does them for several segments at once, and
        // in one loop over all steps it does not.
        let Self { near, far, full, k, sigma, lambda } = self;
        for j in 0..count {
            let (a, d, k) = (near[j], far[j], k[j]);
            // σ(σ − 2) = (3K + 2a/σ − a/σ²)/d ≤ (3K + a)/d, for the root is at least 2; and once more with the bound
            // inserted: now within 0.5 %, whatever a and d, and two steps of third order make that less than rounding.
            let inverse = 1.0 / d;
            let bound = 1.0 / (1.0 + (1.0 + (k + a) * inverse).sqrt());
            sigma[j] = 1.0 + (1.0 + (k + a * bound * (2.0 - bound)) * inverse).sqrt();
        }
        for _ in 0..2 {
            for j in 0..count {
                let (a, d, k, s) = (near[j], far[j], k[j], sigma[j]);
                let value = ((d * s - 2.0 * d) * s - k) * (s * s) - a * (2.0 * s - 1.0);
                let slope = ((4.0 * d * s - 6.0 * d) * s - 2.0 * k) * s - 2.0 * a;
                let half_bend = (6.0 * d * s - 6.0 * d) * s - k;
                sigma[j] = s - value * slope / (slope * slope - value * half_bend);
            }
        }
        // The least C.
        for j in 0..count {
            let (a, d, s) = (near[j], far[j], sigma[j]);
            lambda[j] = 2.0 - d + (2.0 * d * s - a / (s * s)) * (1.0 / 3.0);
        }
        for j in 0..count {
            // Case 3 (D = 0): C ≥ 0 itself is necessary. So it is for a D that is nothing beside the other numbers.
            lambda[j] = if far[j] < 1e-300 { 2.0 - far[j] } else { lambda[j] };
        }
        for j in 0..count {
            let ratio = lambda[j] * INSIDE / full[j];
            lambda[j] = if ratio < 1.0 { ratio } else { 1.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shapespline_polynomial::quartic::least;

    /// The derivative (4) elevated to a quartic, so that the exact minimum of quartics can judge it.
    fn elevated(a: f64, d: f64, e: f64) -> [f64; 5] {
        let (b, c) = (2.0 - a + e, 2.0 - d - e);
        [a, (a + 3.0 * b) / 4.0, (b + c) / 2.0, (3.0 * c + d) / 4.0, d]
    }

    #[test]
    fn lambda_is_admissible_and_the_largest() {
        let grid = [0.0, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1.0, 1.3, 1.7, 1.999, 2.0];
        let mut scaled = 0;
        for a in grid {
            for d in grid {
                for alpha in [0.0, 0.5, 1.0, 3.0, 8.0, 20.0, 1e3] {
                    for beta in [0.0, 0.5, 1.0, 3.0, 8.0, 20.0, 1e3] {
                        let full = 2.0 / 3.0 * (alpha * a - beta * d);
                        let lambda = if keeps(a, d, full) {
                            1.0
                        } else {
                            let mut failing = Failing::default();
                            failing.set(0, a, d, full);
                            failing.solve(1);
                            failing.lambda[0]
                        };
                        assert!((0.0..=1.0).contains(&lambda));
                        let size = 1.0 + (lambda * full).abs();
                        let here = least(&elevated(a, d, lambda * full));
                        assert!(here >= -1e-13 * size, "{a} {d} {alpha} {beta}: {here:e}");
                        if lambda < 1.0 {
                            scaled += 1;
                            let beyond = (lambda * (1.0 + 1e-5)).min(1.0) * full;
                            let there = least(&elevated(a, d, beyond));
                            assert!(there < 0.0, "{a} {d} {alpha} {beta} λ {lambda}: {there:e}");
                        }
                    }
                }
            }
        }
        assert!(scaled > 1000);
    }
}
