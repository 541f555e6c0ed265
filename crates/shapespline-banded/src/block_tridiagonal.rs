// SPDX-License-Identifier: MIT OR Apache-2.0

//! Symmetric positive definite block-tridiagonal systems with 2×2 blocks, eliminated while they are assembled.
//!
//! An interior-point step over a chain of nodes with two unknowns each needs one such system. The matrix is
//! never stored: the caller pushes node after node, the eliminated rows are kept (nine numbers a node), and one
//! backward sweep gives the solution. O(n) time and memory.
// Negated comparisons are meant: they catch NaN as well.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

/// The elimination of a block-tridiagonal system `A x = r` with symmetric positive definite `A`, node by node.
///
/// Row `i` reads `Oᵢ₋₁ᵀ xᵢ₋₁ + Dᵢ xᵢ + Oᵢ xᵢ₊₁ = rᵢ`. No pivoting: elimination of a positive definite matrix is
/// backward stable whatever the scaling of its rows, so unknowns of very different size need no preparation.
///
/// ```
/// use shapespline_banded::block_tridiagonal::BlockElimination;
/// // Two nodes: D = [[4,1],[1,3]] at both, O = identity; the planted solution is (1, 2), (3, 4).
/// let mut system = BlockElimination::with_capacity(2);
/// system.push([4.0, 1.0, 3.0], [1.0, 0.0, 0.0, 1.0], [4.0 + 2.0 + 3.0, 1.0 + 6.0 + 4.0]);
/// system.push([4.0, 1.0, 3.0], [0.0; 4], [12.0 + 4.0 + 1.0, 3.0 + 12.0 + 2.0]);
/// let x = system.solve();
/// for (found, expected) in x.iter().flatten().zip([1.0, 2.0, 3.0, 4.0]) {
///     assert!((found - expected).abs() < 1e-14);
/// }
/// ```
#[derive(Debug, Clone, Default)]
pub struct BlockElimination {
    /// Of every node `D'⁻¹ O`, row by row, and `1/a`, `b/a`, `1/e` of the diagonal block's factors.
    rows: Vec<[f64; 7]>,
    /// `D'⁻¹ r'` of every node, later the solution.
    g: Vec<[f64; 2]>,
    /// What the previous node subtracts from the next diagonal block and right-hand side.
    carry_diagonal: [f64; 3],
    carry_rhs: [f64; 2],
    quadratic: f64,
    repaired: usize,
}

impl BlockElimination {
    /// An empty system with room for `nodes` nodes.
    #[must_use]
    pub fn with_capacity(nodes: usize) -> Self {
        Self { rows: Vec::with_capacity(nodes), g: Vec::with_capacity(nodes), ..Self::default() }
    }

    /// Forget the system, keep the memory.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.g.clear();
        self.carry_diagonal = [0.0; 3];
        self.carry_rhs = [0.0; 2];
        self.quadratic = 0.0;
        self.repaired = 0;
    }

    /// The number of pivots that rounding had made non-positive and that were replaced: 0 for a system that is
    /// positive definite to working accuracy.
    #[must_use]
    pub fn repaired(&self) -> usize {
        self.repaired
    }

    /// `rᵀ A⁻¹ r` of the system pushed so far: the Newton decrement when r is a negative gradient.
    #[must_use]
    pub fn quadratic(&self) -> f64 {
        self.quadratic
    }

    /// Append the next node: diagonal block `[D₀₀, D₀₁, D₁₁]`, coupling to the following node
    /// `[O₀₀, O₀₁, O₁₀, O₁₁]` (zeros at the last), right-hand side `[r₀, r₁]`.
    #[inline]
    pub fn push(&mut self, diagonal: [f64; 3], coupling: [f64; 4], rhs: [f64; 2]) {
        let mut a = diagonal[0] - self.carry_diagonal[0];
        let b = diagonal[1] - self.carry_diagonal[1];
        let c = diagonal[2] - self.carry_diagonal[2];
        let r0 = rhs[0] - self.carry_rhs[0];
        let r1 = rhs[1] - self.carry_rhs[1];
        // A pivot can only turn non-positive by cancellation: the original diagonal bounds its size.
        if !(a > diagonal[0] * f64::EPSILON) {
            a = diagonal[0];
            self.repaired += 1;
        }
        let inverse_a = 1.0 / a;
        let l = b * inverse_a;
        let mut e = c - l * b;
        if !(e > diagonal[2] * f64::EPSILON) {
            e = diagonal[2];
            self.repaired += 1;
        }
        let inverse_e = 1.0 / e;
        let solve = |p: f64, q: f64| {
            let second = (q - l * p) * inverse_e;
            [p * inverse_a - l * second, second]
        };
        let [w00, w10] = solve(coupling[0], coupling[2]);
        let [w01, w11] = solve(coupling[1], coupling[3]);
        let g = solve(r0, r1);
        self.quadratic += r0 * g[0] + r1 * g[1];
        self.carry_diagonal = [
            coupling[0] * w00 + coupling[2] * w10,
            coupling[0] * w01 + coupling[2] * w11,
            coupling[1] * w01 + coupling[3] * w11,
        ];
        self.carry_rhs =
            [coupling[0] * g[0] + coupling[2] * g[1], coupling[1] * g[0] + coupling[3] * g[1]];
        self.rows.push([w00, w01, w10, w11, inverse_a, l, inverse_e]);
        self.g.push(g);
    }

    /// The solution of the system pushed so far, a pair a node. O(n). Call it once; for another right-hand side
    /// there is [`BlockElimination::solve_again`].
    pub fn solve(&mut self) -> &[[f64; 2]] {
        self.backward();
        &self.g
    }

    /// The solution for another right-hand side, given node by node in order. O(n), no factorisation.
    pub fn solve_again(&mut self, mut rhs: impl FnMut(usize) -> [f64; 2]) -> &[[f64; 2]] {
        let mut carry = [0.0; 2];
        for (i, (g, w)) in self.g.iter_mut().zip(&self.rows).enumerate() {
            let r = rhs(i);
            let (p, q) = (r[0] - carry[0], r[1] - carry[1]);
            let second = (q - w[5] * p) * w[6];
            *g = [p * w[4] - w[5] * second, second];
            // Oᵀ D'⁻¹ r' = (D'⁻¹ O)ᵀ r'.
            carry = [w[0] * p + w[2] * q, w[1] * p + w[3] * q];
        }
        self.backward();
        &self.g
    }

    fn backward(&mut self) {
        let mut next = [0.0; 2];
        for (g, w) in self.g.iter_mut().zip(&self.rows).rev() {
            g[0] -= w[0] * next[0] + w[1] * next[1];
            g[1] -= w[2] * next[0] + w[3] * next[1];
            next = *g;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Planted solution on a positive definite chain whose unknowns differ by ten decades in size.
    #[test]
    fn planted_solution_survives_bad_scaling() {
        let n = 200;
        let scale = |i: usize, k: usize| 10f64.powi(((i * 7 + k * 3) % 11) as i32 - 5);
        let planted =
            |i: usize, k: usize| ((i * 13 + k * 5) % 17) as f64 / scale(i, k) - 4.0 / scale(i, k);
        let diagonal = |i: usize| {
            let (s, t) = (scale(i, 0), scale(i, 1));
            [5.0 * s * s, 1.5 * s * t, 4.0 * t * t]
        };
        let coupling = |i: usize| {
            if i + 1 == n {
                return [0.0; 4];
            }
            let (s, t, u, v) = (scale(i, 0), scale(i, 1), scale(i + 1, 0), scale(i + 1, 1));
            [0.7 * s * u, -0.4 * s * v, 0.3 * t * u, 0.6 * t * v]
        };
        let mut system = BlockElimination::with_capacity(n);
        let mut rhs = Vec::new();
        for i in 0..n {
            let (d, o) = (diagonal(i), coupling(i));
            let (p, q) = (planted(i, 0), planted(i, 1));
            let mut r = [d[0] * p + d[1] * q, d[1] * p + d[2] * q];
            if i + 1 < n {
                let (pn, qn) = (planted(i + 1, 0), planted(i + 1, 1));
                r[0] += o[0] * pn + o[1] * qn;
                r[1] += o[2] * pn + o[3] * qn;
            }
            if i > 0 {
                let m = coupling(i - 1);
                let (pp, qp) = (planted(i - 1, 0), planted(i - 1, 1));
                r[0] += m[0] * pp + m[2] * qp;
                r[1] += m[1] * pp + m[3] * qp;
            }
            rhs.push(r);
            system.push(d, o, r);
        }
        assert_eq!(system.repaired(), 0);
        let quadratic = system.quadratic();
        let solution = system.solve().to_vec();
        let direct: f64 = solution.iter().zip(&rhs).map(|(x, r)| x[0] * r[0] + x[1] * r[1]).sum();
        assert!((quadratic - direct).abs() <= 1e-12 * direct);
        let again = system.solve_again(|i| rhs[i]).to_vec();
        for (i, (a, b)) in again.iter().zip(&solution).enumerate() {
            for k in 0..2 {
                assert!((a[k] - b[k]).abs() * scale(i, k) < 1e-12, "node {i} unknown {k}");
            }
        }
        for (i, x) in solution.iter().enumerate() {
            for (k, value) in x.iter().enumerate() {
                let error = (value - planted(i, k)).abs() * scale(i, k);
                assert!(error < 1e-12, "node {i} unknown {k}: error {error}");
            }
        }
    }

    /// Found by mutation: nobody looked at the count.
    #[test]
    fn pivots_that_cancel_are_counted() {
        let mut system = BlockElimination::with_capacity(2);
        system.push([1.0, 0.0, 1.0], [2.0, 0.0, 0.0, 2.0], [1.0, 1.0]);
        assert_eq!(system.repaired(), 0);
        // Both pivots would be 1 − 2·2.
        system.push([1.0, 0.0, 1.0], [0.0; 4], [1.0, 1.0]);
        assert_eq!(system.repaired(), 2);
    }
}
