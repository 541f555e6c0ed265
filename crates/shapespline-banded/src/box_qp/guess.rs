// SPDX-License-Identifier: MIT OR Apache-2.0

//! Guesses of the active set: where the iteration begins, and where it begins anew.

use super::active_set::ActiveSet;
use super::{VariableState, gradient};

/// Sweeps of the first guess.
const GUESSES: usize = 2;
/// Sweeps of a safeguard phase. Each sweep contracts the error by the matrix's diagonal dominance.
const SWEEPS: usize = 40;

impl ActiveSet<'_, '_> {
    /// A first guess of the active set: what a few sweeps of projected Jacobi steps leave at its bounds. Where the
    /// diagonal dominates (a sixth is gained a sweep on splines) few variables are guessed wrong; elsewhere the guess
    /// is as good as any.
    pub(super) fn guess(&mut self) {
        let p = self.program;
        let n = self.x.len();
        if n == 0 {
            return;
        }
        let clamp = |x: f64, i: usize| {
            let x = if x < p.lower[i] { p.lower[i] } else { x };
            if x > p.upper[i] { p.upper[i] } else { x }
        };
        for i in 0..n {
            self.x[i] = clamp(-p.linear[i] / p.diagonal[i], i);
        }
        for _ in 0..GUESSES {
            std::mem::swap(&mut self.x, &mut self.work);
            let (from, to) = (&self.work[..n], &mut self.x[..n]);
            let row = |left: f64, right: f64, i: usize| {
                clamp(-(p.linear[i] + (left + right)) / p.diagonal[i], i)
            };
            if n == 1 {
                to[0] = row(0.0, 0.0, 0);
                continue;
            }
            to[0] = row(0.0, p.off_diagonal[0] * from[1], 0);
            for i in 1..n - 1 {
                let left = p.off_diagonal[i - 1] * from[i - 1];
                to[i] = row(left, p.off_diagonal[i] * from[i + 1], i);
            }
            to[n - 1] = row(p.off_diagonal[n - 2] * from[n - 2], 0.0, n - 1);
        }
        for i in 0..n {
            let (l, u) = (p.lower[i], p.upper[i]);
            // An infinite bound is none, whatever the sweeps made of x.
            let low = (self.x[i] <= l) & (l > f64::NEG_INFINITY);
            let high = (self.x[i] >= u) & (u < f64::INFINITY);
            let upper = if high { VariableState::Upper } else { VariableState::Free };
            self.place[i] = if low | (l == u) { VariableState::Lower } else { upper };
        }
    }

    /// Projected Gauss–Seidel from the clamped iterate; leaves `place` at the active set it finds.
    pub(super) fn gauss_seidel(&mut self) {
        let p = self.program;
        let n = self.x.len();
        for i in 0..n {
            self.x[i] = self.x[i].max(p.lower[i]).min(p.upper[i]);
        }
        for sweep in 0..SWEEPS {
            for k in 0..n {
                let i = if sweep % 2 == 0 { k } else { n - 1 - k };
                let (g, _) = gradient(p, &self.x, i);
                let x = self.x[i] - g / p.diagonal[i];
                self.x[i] = x.max(p.lower[i]).min(p.upper[i]);
            }
        }
        for i in 0..n {
            let g = gradient(p, &self.x, i).0;
            self.place[i] = if p.lower[i] == p.upper[i] || (self.x[i] <= p.lower[i] && g > 0.0) {
                VariableState::Lower
            } else if self.x[i] >= p.upper[i] && g < 0.0 {
                VariableState::Upper
            } else {
                VariableState::Free
            };
        }
    }
}
