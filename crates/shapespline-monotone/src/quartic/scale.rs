//! The largest admissible λ of a segment: conditions (12), (13), theorem 1 and the four cases.

/// λ is lowered by this much below the largest admissible one, so that the derivative stays strictly non-negative
/// after rounding.
const INSIDE: f64 = 1.0 - 1e-12;

/// Conditions (12), (13): whether the full e leaves both inner coefficients of the derivative non-negative. Both
/// cannot fail: their sum is 4 − a − d ≥ 0.
#[inline(always)]
pub(super) fn keeps(a: f64, d: f64, full: f64) -> bool {
    (2.0 - a + full >= 0.0) & (2.0 - d - full >= 0.0)
}

/// The largest λ ∈ [0, 1] for which the derivative (4) with `e = λ full` is non-negative on [0, 1]; `a`, `d` are
/// the end slopes over the secant, in [0, 2].
///
/// The admissible e form an interval around 0 (non-negativity is an intersection of half-planes), so the boundary in
/// one direction is a single point: there the derivative has a double root at some σ = t/(1−t), and with the
/// coefficients a, 3B, 3C, d in powers of s it is `d(s − σ)²(s + a/(dσ²))`. Hence `3C = a/σ² − 2dσ`, and B + C =
/// 4 − a − d = K leaves `dσ⁴ − 2dσ³ − 3Kσ² − 2aσ + a = 0`. Its signs + − − − + allow two positive roots, and at 1 it is
/// negative: one root below 1 (where the other coefficient fails, by symmetry the same case) and one above, which is
/// wanted. There the quartic rises and is convex: from close by Halley's iteration finds it and no other. Φ of theorem 1 is
/// the discriminant of the same cubic, with roots that mean nothing besides.
#[inline(always)]
pub(super) fn largest_scale(a: f64, d: f64, full: f64) -> f64 {
    let kept = keeps(a, d, full);
    // By symmetry (t ↔ 1 − t) let it be C that fails, at e > 0.
    let turn = 2.0 - a + full < 0.0;
    let (near, far) = (if turn { d } else { a }, if turn { a } else { d });
    let full = if turn { -full } else { full };
    let room = 2.0 - far;
    let k = 4.0 - a - d;
    let k = if k > 0.0 { 3.0 * k } else { 0.0 };
    let (a, d) = (near, far);
    // σ(σ − 2) = (3K + 2a/σ − a/σ²)/d ≤ (3K + a)/d, for the root is at least 2; and once more with the bound inserted:
    // now within 0.5 %, whatever a and d, and two steps of third order make that less than rounding.
    let inverse = 1.0 / d;
    let bound = 1.0 / (1.0 + (1.0 + (k + a) * inverse).sqrt());
    let start = 1.0 + (1.0 + (k + a * bound * (2.0 - bound)) * inverse).sqrt();
    let halley = |sigma: f64| {
        let value = ((d * sigma - 2.0 * d) * sigma - k) * (sigma * sigma) - a * (2.0 * sigma - 1.0);
        let slope = ((4.0 * d * sigma - 6.0 * d) * sigma - 2.0 * k) * sigma - 2.0 * a;
        let half_bend = (6.0 * d * sigma - 6.0 * d) * sigma - k;
        sigma - value * slope / (slope * slope - value * half_bend)
    };
    let sigma = halley(halley(start));
    let least = room + (2.0 * d * sigma - a / (sigma * sigma)) * (1.0 / 3.0);
    // Case 3 (D = 0): C ≥ 0 itself is necessary. So it is for a D that is nothing beside the other numbers.
    let least = if d < 1e-300 { room } else { least };
    let lambda = least * INSIDE / full;
    let lambda = if lambda < 1.0 { lambda } else { 1.0 };
    if kept { 1.0 } else { lambda }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quartic_form::least;

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
                        let lambda = largest_scale(a, d, full);
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
