// SPDX-License-Identifier: MIT OR Apache-2.0

//! The method: moves of whole blocks between the bounds, and solves only where something moved.

use super::{BLOCK, Block, BoxQpError, TridiagonalBoxQp, VariableState, gradient};

/// A multiplier of the wrong sign within so much of its terms is rounding, not a contradiction.
const TOLERANCE: f64 = 8.0 * f64::EPSILON;

pub(super) struct ActiveSet<'a, 'b> {
    pub(super) program: &'a TridiagonalBoxQp<'b>,
    pub(super) x: Vec<f64>,
    pub(super) place: Vec<VariableState>,
    pub(super) work: Vec<f64>,
}

impl ActiveSet<'_, '_> {
    /// Rounds of block moves until nothing contradicts the guess (true) or patience is used up (false).
    pub(super) fn pivot(&mut self, patience: usize) -> Result<(usize, bool), BoxQpError> {
        let n = self.x.len();
        for i in 0..n {
            self.pin(i);
        }
        let mut changed = Vec::new();
        self.solve_between(0, n)?;
        self.contradictions(0, n, &mut changed);
        let (mut rounds, mut best, mut left) = (1, usize::MAX, patience);
        let mut next = Vec::new();
        while !changed.is_empty() {
            if changed.len() < best {
                best = changed.len();
                left = patience;
            } else if left == 0 {
                return Ok((rounds, false));
            } else {
                left -= 1;
            }
            // All moves first: a stretch may contain several.
            for &(i, place) in &changed {
                self.place[i] = place;
                self.pin(i);
            }
            next.clear();
            let mut done = 0;
            for &(i, _) in &changed {
                if i < done {
                    continue;
                }
                // The solution changes between the nearest active variables on either side and their multipliers.
                let mut from = i;
                while from > done && self.place[from - 1] == VariableState::Free {
                    from -= 1;
                }
                let from = from.saturating_sub(1).max(done);
                let mut to = i + 1;
                while to < n && self.place[to] == VariableState::Free {
                    to += 1;
                }
                let to = (to + 1).min(n);
                self.solve_between(from, to)?;
                self.contradictions(from, to, &mut next);
                // The stretch's last variable is active and its multiplier also depends on what follows: when
                // the next stretch starts there it must be looked at again.
                done = if to < n { to - 1 } else { to };
                while next.last().is_some_and(|&(last, _)| last >= done) {
                    // Re-derived below or by the closing check.
                    if to == n {
                        break;
                    }
                    next.pop();
                }
                if to < n {
                    self.contradictions(done, done + 1, &mut next);
                }
            }
            next.dedup_by_key(|c| c.0);
            std::mem::swap(&mut changed, &mut next);
            rounds += 1;
            if changed.is_empty() {
                // Boundary multipliers were judged before their other side was final: one closing look at all.
                self.contradictions(0, n, &mut changed);
            }
        }
        Ok((rounds, true))
    }

    fn pin(&mut self, i: usize) {
        match self.place[i] {
            VariableState::Lower => self.x[i] = self.program.lower[i],
            VariableState::Upper => self.x[i] = self.program.upper[i],
            VariableState::Free => {}
        }
    }

    /// Solve for the free variables of `from..to`, whose outer neighbours are active or absent.
    fn solve_between(&mut self, from: usize, to: usize) -> Result<(), BoxQpError> {
        let p = self.program;
        let n = self.x.len();
        let mut i = from;
        while i < to {
            if self.place[i] != VariableState::Free {
                i += 1;
                continue;
            }
            let start = i;
            let mut rhs_carry =
                if start > 0 { -p.off_diagonal[start - 1] * self.x[start - 1] } else { 0.0 };
            let mut factor = 0.0;
            while i < to && self.place[i] == VariableState::Free {
                let below = if i > start { p.off_diagonal[i - 1] } else { 0.0 };
                let pivot = p.diagonal[i] - below * factor;
                if !(pivot > 0.0) {
                    return Err(BoxQpError::NotPositiveDefinite { index: i, value: pivot });
                }
                let inverse = 1.0 / pivot;
                let rhs = -p.linear[i] + rhs_carry;
                self.x[i] = rhs * inverse;
                if i + 1 < n {
                    let o = p.off_diagonal[i];
                    factor = o * inverse;
                    self.work[i] = factor;
                    rhs_carry = -o * self.x[i];
                }
                i += 1;
            }
            if i < n {
                self.x[i - 1] -= self.work[i - 1] * self.x[i];
            }
            for k in (start..i - 1).rev() {
                self.x[k] -= self.work[k] * self.x[k + 1];
            }
        }
        Ok(())
    }

    /// Variables of `from..to` that contradict their place, with the place they should move to.
    fn contradictions(&self, from: usize, to: usize, out: &mut Vec<(usize, VariableState)>) {
        for from in (from..to).step_by(BLOCK) {
            let to = to.min(from + BLOCK);
            if !(to - from == BLOCK && self.settled(from)) {
                self.contradictions_one_by_one(from, to, out);
            }
        }
    }

    /// Whether nothing contradicts in a block, from the numbers alone: what is between its bounds is as good as free.
    fn settled(&self, from: usize) -> bool {
        let Some(block) = Block::of(self.program, &self.x, from) else { return false };
        (0..BLOCK).fold(true, |all, k| {
            let (g, size) = block.gradient(k);
            let (x, l, u) = (block.x[k], block.lower[k], block.upper[k]);
            let tolerance = TOLERANCE * size;
            let inside = (x >= l) & (x <= u);
            let low = (x > l) | (g >= -tolerance);
            let high = (x < u) | (g <= tolerance);
            all & inside & ((low & high) | (l == u))
        })
    }

    fn contradictions_one_by_one(
        &self,
        from: usize,
        to: usize,
        out: &mut Vec<(usize, VariableState)>,
    ) {
        let p = self.program;
        for i in from..to {
            let (x, l, u, place) = (self.x[i], p.lower[i], p.upper[i], self.place[i]);
            let (g, size) = gradient(p, &self.x, i);
            let tolerance = TOLERANCE * size;
            // Logic without branches: which variables are active cannot be predicted, that few contradict can.
            let beyond = (place == VariableState::Free) & ((x < l) | (x > u));
            let pulled = (place == VariableState::Lower) & (g < -tolerance);
            let pushed = (place == VariableState::Upper) & (g > tolerance);
            if beyond | ((pulled | pushed) & (l != u)) {
                let to = match place {
                    VariableState::Free if x < l => VariableState::Lower,
                    VariableState::Free => VariableState::Upper,
                    _ => VariableState::Free,
                };
                out.push((i, to));
            }
        }
    }
}
