// SPDX-License-Identifier: MIT OR Apache-2.0

//! Periodic functions, and their antiderivatives, which repeat up to polynomials that accumulate from period to period.
//!
//! Let G be an antiderivative of order m of a function of period T that starts at x₀. On the k-th period it is
//! `G(x₀ + kT + s) = G(x₀ + s) + Σⱼ cⱼ(k) sʲ/j!` with j < m, where `c(1)` are the rises of G and its derivatives over the
//! knots, and `c(a + b) = exp(bTD) c(a) + c(b)` (D takes every entry to the one before): k periods take some log₂ k steps.

/// The number of the period that contains x, and the corresponding place on the knots.
pub(crate) fn wrapped(x: f64, first: f64, last: f64) -> (f64, f64) {
    let period = last - first;
    let distance = x - first;
    let within = distance.rem_euclid(period);
    let place = first + within;
    // `min` would turn NaN into a number.
    (((distance - within) / period).round(), if place > last { last } else { place })
}

/// `c(count)` from `c(1)` for periods of length T.
pub(crate) fn accumulated(rises: &[f64], count: f64, period: f64) -> Vec<f64> {
    if let [rise] = rises {
        return vec![count * rise];
    }
    // Backwards: c(−1) = −exp(−TD) c(1).
    let (mut step, mut unit) = (period, rises.to_vec());
    if count < 0.0 {
        step = -period;
        unit = shifted(&unit, step).iter().map(|c| -c).collect();
    }
    let mut total = vec![0.0; rises.len()];
    // Above 2⁵³ periods the place within a period is lost to rounding anyway.
    let mut rest = count.abs() as u64;
    while rest > 0 {
        if rest % 2 == 1 {
            total = added(&shifted(&total, step), &unit);
        }
        unit = added(&shifted(&unit, step), &unit);
        step *= 2.0;
        rest /= 2;
    }
    total
}

/// `Σ cⱼ sʲ⁻ⁿ/(j − n)!` over j ≥ n: the derivative of order n of the polynomial with Taylor coefficients c/j!.
pub(crate) fn polynomial(c: &[f64], s: f64, n: usize) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    for (j, c) in c.iter().skip(n).enumerate() {
        sum += c * power;
        power *= s / (j + 1) as f64;
    }
    sum
}

/// `exp(sD) c`.
fn shifted(c: &[f64], s: f64) -> Vec<f64> {
    (0..c.len()).map(|j| polynomial(c, s, j)).collect()
}

fn added(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_periods_are_one_after_another() {
        let (rises, period) = ([0.5, -0.25, 2.0], 1.5);
        let mut direct = vec![0.0; 3];
        for k in 1..50 {
            direct = added(&shifted(&direct, period), &rises);
            let jumped = accumulated(&rises, f64::from(k), period);
            for (a, b) in direct.iter().zip(&jumped) {
                assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0), "{k}: {direct:?} {jumped:?}");
            }
            // There and back again: c(−k + k) = 0.
            let back = accumulated(&rises, -f64::from(k), period);
            let there = added(&shifted(&back, f64::from(k) * period), &direct);
            assert!(there.iter().all(|v| v.abs() < 1e-7), "{k}: {there:?}");
        }
    }

    #[test]
    fn places_are_on_the_knots() {
        assert_eq!(wrapped(7.25, 1.0, 3.0), (3.0, 1.25));
        assert_eq!(wrapped(-0.5, 1.0, 3.0), (-1.0, 1.5));
        let (k, at) = wrapped(-1e-30, 0.0, 2.0);
        assert!((k, at) == (-1.0, 2.0));
        assert!(wrapped(f64::INFINITY, 0.0, 1.0).1.is_nan());
    }
}
