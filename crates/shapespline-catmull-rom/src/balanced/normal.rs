// SPDX-License-Identifier: MIT OR Apache-2.0

//! The steps of Newton's and of Gauss and Newton's method.

use std::ops::Range;

use shapespline_banded::{SolveError, solve_cyclic, solve_tridiagonal};

use super::node::At;

/// Weight of the parametrisation's own split. Measured on the shared data sets: 0.1 leaves the largest
/// curvature of the hiking track half as large again, 0.0001 bends the protein backbone by a tenth more.
pub(super) const ANCHOR: f64 = 0.01;

/// No split is changed by more than this at once.
pub(super) const STRIDE: f64 = 2.0;

/// A split that was changed by more than this counts as far from where it will end.
const MUCH: f64 = 0.3;

/// The normal equations of one step, tridiagonal and symmetric.
#[derive(Debug, Default)]
pub(super) struct Normal {
    /// What couples each node to the one before it; the first to the last, and again at the end.
    beside: Vec<f64>,
    diagonal: Vec<f64>,
    /// What the residuals' own second derivatives add to the diagonal.
    curvature: Vec<f64>,
    right: Vec<f64>,
    /// Scratch: the diagonal that is solved with.
    pivots: Vec<f64>,
    /// The last step of each node.
    pub(super) step: Vec<f64>,
}

impl Normal {
    /// Makes room for some nodes, none of which has moved.
    pub(super) fn begin(&mut self, n: usize) {
        self.beside.resize(n + 1, 0.0);
        for numbers in [&mut self.diagonal, &mut self.curvature, &mut self.right, &mut self.pivots]
        {
            numbers.resize(n, 0.0);
        }
        self.step.clear();
        self.step.resize(n, STRIDE);
    }

    /// Makes the row of a node that of its anchor alone.
    #[inline]
    pub(super) fn clear(&mut self, i: usize, anchor: f64) {
        self.diagonal[i] = ANCHOR;
        self.curvature[i] = 0.0;
        self.right[i] = anchor;
        [self.beside[i], self.beside[i + 1]] = [0.0; 2];
    }

    /// Adds the residual `log φ_i − log ψ_j` of a segment from node `i` to node `j`.
    #[inline]
    pub(super) fn add(&mut self, [i, j]: [usize; 2], [start, end]: [At; 2]) {
        let residual = start.phi - end.psi;
        let [di, dj] = [start.by_phi, end.by_psi];
        self.diagonal[i] += di * di;
        self.diagonal[j] += dj * dj;
        [self.beside[i + 1], self.beside[j]] = [di * dj; 2];
        self.right[i] -= di * residual;
        self.right[j] -= dj * residual;
        // (log σ)'' = −σ(s)σ(−s), and the two first derivatives of a node are σ(−s) and −σ(s).
        self.curvature[i] -= residual * start.by_phi * start.by_psi;
        self.curvature[j] += residual * end.by_phi * end.by_psi;
    }

    /// Finds the step of some nodes; whether it is Newton's.
    pub(super) fn solve(&mut self, nodes: Range<usize>, cyclic: bool) -> Result<bool, SolveError> {
        let moves = |i: usize| self.step.get(i).is_some_and(|step| step.abs() > MUCH);
        let mut is_newton = true;
        for i in nodes.clone() {
            let mut curvature = self.curvature[i];
            if curvature < 0.0 && (i.saturating_sub(1)..i + 2).any(moves) {
                (curvature, is_newton) = (0.0, false);
            }
            self.pivots[i] = self.diagonal[i] + curvature;
        }
        if self.solve_with_pivots(nodes.clone(), cyclic).is_ok()
            && self.leads_downhill(nodes.clone())
        {
            return Ok(is_newton);
        }
        for i in nodes.clone() {
            self.pivots[i] = self.diagonal[i] + self.curvature[i].max(0.0);
        }
        self.solve_with_pivots(nodes, cyclic).map(|()| false)
    }

    fn solve_with_pivots(&mut self, nodes: Range<usize>, cyclic: bool) -> Result<(), SolveError> {
        let Self { beside, right, pivots, step, .. } = self;
        let [lower, upper] = [&beside[nodes.clone()], &beside[nodes.start + 1..=nodes.end]];
        let (pivots, step) = (&mut pivots[nodes.clone()], &mut step[nodes.clone()]);
        step.copy_from_slice(&right[nodes]);
        let solve = if cyclic { solve_cyclic } else { solve_tridiagonal };
        solve(lower, pivots, upper, step)
    }

    /// Whether the step of some nodes does; it is not said of numbers that are none.
    fn leads_downhill(&self, nodes: Range<usize>) -> bool {
        let step = self.step[nodes.clone()].iter().zip(&self.right[nodes]);
        step.map(|(d, r)| d * r).sum::<f64>() >= 0.0
    }
}
