// SPDX-License-Identifier: MIT OR Apache-2.0

//! The polynomial with which a function continues beyond an end knot.

use crate::extrapolation::Continuation;
use crate::roots::{horner, outward_roots, verified};
use shapespline_polynomial::bernstein;

/// `Σ aₖ τᵏ`, where τ ≥ 0 is the distance from the end knot divided by the length of the end segment. At x = ±∞ its value is
/// the limit.
#[derive(Debug, Clone)]
pub(crate) struct Beyond {
    a: Vec<f64>,
    /// The end knot.
    knot: f64,
    /// The length of the end segment: negative where τ grows as x falls.
    h: f64,
}

impl Beyond {
    /// The polynomial with Bernstein coefficients `base + c` on the end segment (a large base would cost c its digits), and
    /// `data`, the error in c that rounding of the data causes. `None` if the function does not continue as a polynomial.
    pub(crate) fn new(
        c: &[f64],
        [base, data]: [f64; 2],
        end: [f64; 2],
        right: bool,
        mode: Continuation,
    ) -> Option<Self> {
        let mut a = bernstein::taylor(c, right);
        match mode {
            Continuation::Polynomial => trim(&mut a, c, data),
            Continuation::Taylor(k) => {
                a.truncate(k.saturating_add(1));
                if k > 1 {
                    trim(&mut a, c, data);
                }
            }
            Continuation::Zero => a.clear(),
            Continuation::Nan | Continuation::Periodic(_) => return None,
        }
        match a.first_mut() {
            Some(first) => *first += base,
            None => a.push(0.0),
        }
        let [start, stop] = end;
        let (knot, h) = if right { (stop, stop - start) } else { (start, start - stop) };
        Some(Self { a, knot, h })
    }

    fn tau(&self, x: f64) -> f64 {
        (x - self.knot) / self.h
    }

    /// The derivative of order `nu` at x.
    pub(crate) fn evaluate(&self, x: f64, nu: usize) -> f64 {
        if nu == 0 {
            return horner(&self.a, self.tau(x));
        }
        if nu >= self.a.len() {
            return 0.0;
        }
        let falling = |k: usize| (k + 1 - nu..=k).map(|f| f as f64).product::<f64>();
        let a: Vec<f64> = (nu..self.a.len()).map(|k| falling(k) * self.a[k]).collect();
        (0..nu).fold(horner(&a, self.tau(x)), |v, _| v / self.h)
    }

    /// `∫ₐᵇ` over an interval beyond the knot. The polynomial is expanded about the nearer end, so that nothing cancels far
    /// from the knot.
    pub(crate) fn integrate(&self, a: f64, b: f64) -> f64 {
        let (near, far) = if self.h > 0.0 { (a, b) } else { (b, a) };
        let (tau, width) = (self.tau(near), (far - near) / self.h);
        let mut c = self.a.clone();
        // Taylor's shift by repeated synthetic division.
        for k in 0..c.len() {
            for j in (k..c.len() - 1).rev() {
                if c[j + 1] != 0.0 {
                    c[j] += tau * c[j + 1];
                }
            }
        }
        let terms: Vec<f64> = c.iter().enumerate().map(|(k, c)| c / (k + 1) as f64).collect();
        let mean = horner(&terms, width);
        // The integral of zero over an infinite width is zero, not NaN.
        if mean == 0.0 { 0.0 } else { mean * (width * self.h.abs()) }
    }

    /// The x at or beyond the knot with f(x) = y, from the knot outwards, each verified by values of f.
    pub(crate) fn solve(&self, y: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut less = self.a.clone();
        less[0] -= y;
        if !less[0].is_finite() {
            return Vec::new();
        }
        let noise = |x: f64| {
            let tau = self.tau(x);
            let terms: Vec<f64> = self.a.iter().map(|a| a.abs()).collect();
            f64::EPSILON * self.a.len() as f64 * (horner(&terms, tau) + y.abs())
        };
        let beyond = |x: f64| if self.h > 0.0 { x >= self.knot } else { x <= self.knot };
        let x = outward_roots(less).into_iter().map(|tau| self.knot + tau * self.h);
        x.filter_map(|x| verified(x, noise(x), |x| if beyond(x) { f(x) - y } else { f64::NAN }))
            .collect()
    }
}

/// Drop leading coefficients that are of rounding size. The k-th is a sum of Bernstein coefficients whose weights have
/// absolute values that sum to `C(n, k) 2ᵏ`. From k = 2 on the rounding of the data counts too, so that the end polynomial
/// through points on a line is that line.
fn trim(a: &mut Vec<f64>, c: &[f64], data: f64) {
    /// Error of the Bernstein coefficients, relative to the largest: they are sums of a few rounded terms.
    const NOISE: f64 = 4.0 * f64::EPSILON;
    let n = c.len() - 1;
    let size = c.iter().fold(0.0f64, |size, c| size.max(c.abs()));
    let mut weight = 1.0;
    let mut keep = 0;
    for k in 1..a.len() {
        weight *= 2.0 * (n + 1 - k) as f64 / k as f64;
        if a[k].abs() > weight * (NOISE * size + if k > 1 { data } else { 0.0 }) {
            keep = k;
        }
    }
    a.truncate(keep + 1);
}
