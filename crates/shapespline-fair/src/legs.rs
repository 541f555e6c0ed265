// SPDX-License-Identifier: MIT OR Apache-2.0

//! Gradient and Hessian with respect to the five scaled legs of a segment, and their way to the nodes.

use glam::{DMat3, DVec3};

use crate::element::{Legs, PAIRS, Span, T, TAU};

/// Gradient and Hessian of a function of the legs. Of the Hessian the blocks `(i, j)` with `i ≤ j` are
/// held.
#[derive(Debug, Clone)]
pub(crate) struct LegTerms {
    pub(crate) gradient: Legs,
    pub(crate) hessian: [[DMat3; 5]; 5],
}

/// Number of unknowns of a segment: first and second derivative at both ends.
pub(crate) const UNKNOWNS: usize = 12;

/// A gradient with respect to the unknowns of a segment.
pub(crate) type ElementGradient = [DVec3; 4];
/// A Hessian with respect to the unknowns of a segment.
pub(crate) type ElementHessian = [[f64; UNKNOWNS]; UNKNOWNS];

impl LegTerms {
    pub(crate) fn zero() -> Self {
        Self { gradient: [DVec3::ZERO; 5], hessian: [[DMat3::ZERO; 5]; 5] }
    }

    /// Adds `weight · g gᵀ` for a gradient `g` of the legs `first..first + N`.
    #[inline(always)]
    pub(crate) fn add_square<const N: usize>(&mut self, first: usize, g: &[DVec3; N], weight: f64) {
        for i in 0..N {
            let scaled = g[i] * weight;
            for j in i..N {
                self.hessian[first + i][first + j] += outer(scaled, g[j]);
            }
        }
    }

    /// Adds the Hessian of `Σ_k n_k · (d_i × d_j)` over the [`PAIRS`] `(i, j)`.
    pub(crate) fn add_products(&mut self, normals: &[DVec3; 7]) {
        for (&(i, j), &n) in PAIRS.iter().zip(normals) {
            // n · (x × y) = xᵀ K y with K y = y × n.
            self.hessian[i][j] += DMat3::from_cols(
                DVec3::new(0.0, -n.z, n.y),
                DVec3::new(n.z, 0.0, -n.x),
                DVec3::new(-n.y, n.x, 0.0),
            );
        }
    }

    /// The Hessian with respect to `q0, r0, q1, r1`: `TᵀHT`, where `T` makes legs of them.
    pub(crate) fn pull_back(&self, span: &Span) -> ElementHessian {
        let unit = span.spacing / span.length;
        let arm = 0.5 * TAU * span.spacing * unit;
        let h = |i: usize, j: usize| {
            if i <= j { self.hessian[i][j] } else { self.hessian[j][i].transpose() }
        };
        // Columns of H T, one for each unknown.
        let column = |i: usize, terms: &[(usize, f64)]| {
            terms.iter().fold(DMat3::ZERO, |sum, &(j, c)| sum + h(i, j) * c)
        };
        let terms: [&[(usize, f64)]; 4] = [
            &[(0, unit), (1, unit), (2, -unit)],
            &[(1, arm), (2, -T * arm)],
            &[(3, unit), (4, unit), (2, -unit)],
            &[(3, -arm), (2, T * arm)],
        ];
        let mut full = [[0.0; UNKNOWNS]; UNKNOWNS];
        for (b, columns) in terms.iter().enumerate() {
            let ht: [DMat3; 5] = std::array::from_fn(|i| column(i, columns));
            for (a, rows) in terms.iter().enumerate().take(b + 1) {
                let block = rows.iter().fold(DMat3::ZERO, |sum, &(i, c)| sum + ht[i] * c);
                for c in 0..3 {
                    let values = block.col(c).to_array();
                    for r in 0..3 {
                        full[3 * a + r][3 * b + c] = values[r];
                        full[3 * b + c][3 * a + r] = values[r];
                    }
                }
            }
        }
        full
    }
}

/// `x yᵀ`.
#[inline(always)]
pub(crate) fn outer(x: DVec3, y: DVec3) -> DMat3 {
    DMat3::from_cols(x * y.x, x * y.y, x * y.z)
}
