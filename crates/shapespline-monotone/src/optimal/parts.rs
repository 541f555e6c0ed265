// SPDX-License-Identifier: MIT OR Apache-2.0

//! Conditions on parts of a segment: the program as other solvers get it, for references and second opinions.

use crate::data::Data;
use crate::energy::{Fairness, HESSIAN, is_flat, weight};
use crate::slopes::sign;
use shapespline_polynomial::quartic::basis;

/// The energy as ½vᵀPv + qᵀv (but for a constant) of v = (d₀, s₀, d₁, s₁, …), and what is asked of v.
pub(crate) struct Quadratic {
    /// P by (row, column, value); entries of one place add up.
    pub(crate) hessian: Vec<(usize, usize, f64)>,
    /// q.
    pub(crate) linear: Vec<f64>,
    /// Unknowns that are zero: slopes at turns, all at flats. Some more than once.
    pub(crate) fixed: Vec<usize>,
    /// Rows r (by index and value) and constants c with r·v + c ≥ 0.
    pub(crate) positive: Vec<(Vec<(usize, f64)>, f64)>,
}

impl Quadratic {
    /// With the conditions on 2^`level` parts of every segment; scaled units.
    pub(crate) fn of(data: &Data, fairness: Fairness, level: u8) -> Self {
        let n = data.len();
        let linear = vec![0.0; 2 * (n + 1)];
        let mut q = Self { hessian: Vec::new(), linear, fixed: Vec::new(), positive: Vec::new() };
        for i in 0..n {
            let (h, delta) = (data.h[i], data.delta[i]);
            let index = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3];
            if is_flat(delta) {
                q.fixed.extend(index);
                continue;
            }
            if i > 0 && sign(delta) * sign(data.delta[i - 1]) < 0.0 {
                q.fixed.push(2 * i);
            }
            let scale = [1.0 / delta, 0.25 * h / delta, 1.0 / delta, 0.25 * h / delta];
            let w = weight(fairness, h, delta) / 35.0;
            for j in 0..4 {
                for k in 0..4 {
                    let value = w * HESSIAN[j][k] * scale[j] * scale[k];
                    q.hessian.push((index[j], index[k], value));
                    if k % 2 == 0 {
                        q.linear[index[j]] -= w * HESSIAN[j][k] * scale[j];
                    }
                }
            }
            let parts = f64::from(1u32 << level);
            for part in 0..1u32 << level {
                let (from, to) = (f64::from(part) / parts, f64::from(part + 1) / parts);
                for row in std::iter::once(basis(from)).chain(rows(from, to)) {
                    let gradient = gradient(&row);
                    // value = row·(1,…,1) + gradient·(a, b, …) with a = d/Δ − 1.
                    let constant = 1.0 - gradient[0] - gradient[2];
                    debug_assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                    let row = (0..4).map(|j| (index[j], gradient[j] * scale[j])).collect();
                    q.positive.push((row, constant));
                }
            }
        }
        q
    }
}

/// Bernstein coefficients 1…4 on [l, r] as weights of those on [0, 1]: coefficient j is the polar value at l (4 − j
/// times) and r (j times).
#[inline]
fn rows(l: f64, r: f64) -> [[f64; 5]; 4] {
    let (m, q) = (1.0 - l, 1.0 - r);
    let cubes = |u: f64, t: f64| [u * u * u, 3.0 * (u * u * t), 3.0 * (u * t * t), t * t * t];
    // A cubic and a linear factor.
    let mixed = |a: [f64; 4], u: f64, t: f64| {
        [a[0] * u, a[1] * u + a[0] * t, a[2] * u + a[1] * t, a[3] * u + a[2] * t, a[3] * t]
    };
    let (a, b) = ([m * m, 2.0 * (m * l), l * l], [q * q, 2.0 * (q * r), r * r]);
    let right = cubes(q, r);
    [
        mixed(cubes(m, l), q, r),
        [
            a[0] * b[0],
            a[0] * b[1] + a[1] * b[0],
            (a[0] * b[2] + a[2] * b[0]) + a[1] * b[1],
            a[1] * b[2] + a[2] * b[1],
            a[2] * b[2],
        ],
        mixed(right, m, l),
        mixed(right, q, r),
    ]
}

/// The gradient of a row in the segment's unknowns (d₀/Δ, h s₀/4Δ, d₁/Δ, h s₁/4Δ); its constant is 5w₂.
#[inline]
fn gradient(w: &[f64; 5]) -> [f64; 4] {
    [w[0] + w[1] - 2.0 * w[2], w[1] - w[2], w[3] + w[4] - 2.0 * w[2], w[2] - w[3]]
}
