// SPDX-License-Identifier: MIT OR Apache-2.0

//! Nodal slopes: Fritsch–Butland as the paper prints it (but for ends beside a turn), and limits for given slopes.
//!
//! Everything is in signed, scaled units; decreasing data are the reflection of increasing ones because every
//! formula here is odd in Δ.

use crate::data::{Data, parts_mut};

/// The sign of a segment or of the zero slope: −1, 0, 1.
#[inline]
pub(crate) fn sign(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// The harmonic mean `2Δₐ Δᵦ/(Δₐ + Δᵦ)` of secants of one sign, 0 otherwise.
#[inline(always)]
pub(crate) fn harmonic(a: f64, b: f64) -> f64 {
    // Selections, not branches: done for several nodes at once. Through the reciprocals' sum no product of secants is
    // formed: it could over- or underflow.
    let less = a.abs() < b.abs();
    let (small, large) = (if less { a } else { b }, if less { b } else { a });
    let mean = 2.0 * small / (1.0 + small / large);
    let (low, high) = (if a < b { a } else { b }, if a < b { b } else { a });
    let rising = if low > 0.0 { mean } else { 0.0 };
    if high < 0.0 { mean } else { rising }
}

/// The end slope. Where the two secants have one sign the paper's three-point formula
/// `(1 + Δ₀/Δ₁)Δ₀ − (Δ₀/Δ₁)(y₂−y₀)/(x₂−x₀)`, written as `Δ₀ + (Δ₀/Δ₁)(Δ₀ − Δ₁)h₁/(h₀+h₁)`, which needs no
/// cancellation. That formula is for monotone data. Beside a turn or a flat (Δ₁ of the other sign, or 0) use the slope of the
/// parabola through the three points, `Δ₀ + (Δ₀ − Δ₁)h₀/(h₀+h₁)`, as PCHIP does (Moler, *Numerical Computing with MATLAB*,
/// section 3.6). Both are limited to [0, 2Δ₀].
pub(crate) fn end(h0: f64, h1: f64, delta0: f64, delta1: f64) -> f64 {
    let change = if sign(delta0) == sign(delta1) {
        (delta0 / delta1) * ((delta0 - delta1) * (h1 / (h0 + h1)))
    } else {
        (delta0 - delta1) * (h0 / (h0 + h1))
    };
    limit(delta0 + change, delta0, delta0)
}

/// The nearest slope to `d` in the paper's region `0 ≤ d ≤ 2Δ` of both neighbours (mirrored for decreasing ones).
#[inline]
pub(crate) fn limit(d: f64, a: f64, b: f64) -> f64 {
    let s = sign(a);
    if s == 0.0 || s != sign(b) {
        return 0.0;
    }
    let cap = 2.0 * a.abs().min(b.abs());
    s * (s * d).max(0.0).min(cap)
}

/// Fritsch–Butland slopes at every node: harmonic means, and [`end`] at the ends. O(N).
pub(crate) fn fritsch_butland(data: &Data) -> Vec<f64> {
    let (h, delta) = (&data.h, &data.delta);
    let n = data.len();
    if n == 1 {
        // Two points: the line.
        return vec![delta[0]; 2];
    }
    let mut d = vec![0.0; n + 1];
    parts_mut(&mut d[1..n], |start, d| {
        let neighbours = delta[start..].iter().zip(&delta[start + 1..]);
        for (d, (a, b)) in d.iter_mut().zip(neighbours) {
            *d = harmonic(*a, *b);
        }
    });
    d[0] = end(h[0], h[1], delta[0], delta[1]);
    d[n] = end(h[n - 1], h[n - 2], delta[n - 1], delta[n - 2]);
    d
}

/// Slopes given by the caller, limited to the region in which the constructions are monotone. O(N).
pub(crate) fn limited(data: &Data, given: &[f64]) -> Vec<f64> {
    let delta = &data.delta;
    let n = data.len();
    let mut d = data.slopes_in(given);
    for (i, d) in d.iter_mut().enumerate() {
        *d = limit(*d, delta[i.max(1) - 1], delta[i.min(n - 1)]);
    }
    d
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_paper_s_formulas() {
        let data = Data::new(&[0.0, 1.0, 3.0, 4.0], &[0.0, 1.0, 2.0, 8.0]).unwrap();
        let d = data.units().derivatives_out(&fritsch_butland(&data), 1);
        // Printed end formula: d0* = (1 + 2)·1 − 2·(2/3) = 5/3; the far end is beyond 2Δ and clamped.
        assert!((d[0] - 5.0 / 3.0).abs() < 1e-15);
        assert!((d[1] - 2.0 * 0.5 / 1.5).abs() < 1e-15);
        assert!((d[2] - 2.0 * 3.0 / 6.5).abs() < 1e-15);
        assert_eq!(d[3], 12.0);
    }

    #[test]
    fn reflection_and_extremes() {
        assert_eq!(harmonic(-2.0, -2.0), -2.0);
        assert_eq!(harmonic(-2.0, 2.0), 0.0);
        assert_eq!(harmonic(1e300, 1e-300), 2e-300);
        assert_eq!(end(1.0, 1.0, -1.0, -3.0), -end(1.0, 1.0, 1.0, 3.0));
        assert_eq!(end(1.0, 1.0, 1e300, 1e-300), 2e300);
        // Beside a turn or a flat the parabola's slope, at most twice the secant; on a flat none.
        assert_eq!(end(1.0, 3.0, 2.0, -1.0), 2.75);
        assert_eq!(end(1.0, 1.0, 2.0, 0.0), 3.0);
        assert_eq!(end(1.0, 1.0, -2.0, 3.0), -4.0);
        assert_eq!((end(1.0, 1.0, 0.0, 2.0), end(1.0, 1.0, 0.0, 0.0)), (0.0, 0.0));
        assert_eq!(end(1.0, 1.0, 1e300, -1e300), 2e300);
        assert_eq!(limit(-5.0, 1.0, 2.0), 0.0);
        assert_eq!(limit(5.0, 1.0, 2.0), 2.0);
        assert_eq!(limit(-5.0, -1.0, -2.0), -2.0);
    }
}
