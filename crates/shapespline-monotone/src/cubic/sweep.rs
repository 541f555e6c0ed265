// SPDX-License-Identifier: MIT OR Apache-2.0

//! Red–black sweeps: every slope in turn is made the best for its neighbours.

use super::stretch::Stretch;

/// Sweeps that give Newton's method its start, and steps of a node in each.
const SWEEPS: usize = 3;
const SWEEP_STEPS: usize = 3;
/// Relative steps at which a sweep leaves a node.
const SWEEP_ENOUGH: f64 = 1.0 / 64.0;

impl Stretch<'_> {
    /// Red–black sweeps: every slope in turn is made the best for its neighbours.
    pub(super) fn sweep(&self, m: &mut [f64]) {
        for parity in (0..2 * SWEEPS).map(|k| (k + 1) % 2) {
            for i in (parity..m.len()).step_by(2).filter(|&i| !self.is_held(i)) {
                if self.is_bent(i) {
                    m[i] = self.bent(m, i);
                } else if self.base.is_empty() {
                    m[i] = self.relaxed(m, i);
                }
            }
        }
    }

    /// Harmonic means of the secants, with which every interval is one cubic; the secant at free ends.
    pub(super) fn start(&self, m: &mut [f64]) {
        let n = self.h.len();
        let secant = |i: usize| self.d[i] / self.h[i];
        for i in (0..=n).filter(|&i| !self.is_held(i)) {
            let mean = if i == 0 || i == n {
                secant(i.min(n - 1))
            } else {
                let (a, b) = (secant(i - 1), secant(i));
                2.0 * b * (a / (a + b))
            };
            m[i] = mean.max(self.bound(i));
        }
        self.start_bent(m);
    }

    /// The slope of node i that is best for those of its neighbours, nearly: the scalar convex problem, in a bracket.
    fn relaxed(&self, m: &[f64], i: usize) -> f64 {
        let bound = self.bound(i);
        let (mut low, mut high) = (bound, f64::INFINITY);
        let mut t = m[i];
        for _ in 0..SWEEP_STEPS {
            let (mut gradient, mut second) = (0.0, 0.0);
            if i > 0 {
                let p = self.piece(i - 1, [m[i - 1], t]);
                (gradient, second) = (p.gradient[1], p.hessian[2]);
            }
            if i < self.h.len() {
                let p = self.piece(i, [t, m[i + 1]]);
                (gradient, second) = (gradient + p.gradient[0], second + p.hessian[0]);
            }
            let next = if gradient < 0.0 {
                low = t;
                t - gradient / second
            } else if gradient > 0.0 {
                high = t;
                // In the square: the gradient of an interval with a level part is quadratic in the slope.
                let size = t - bound;
                let square = size * size - 2.0 * size * gradient / second;
                bound + if square > 0.0 { square.sqrt() } else { 0.25 * size }
            } else {
                return t;
            };
            let outside = !(next > low && next < high);
            let moved = if outside && high.is_finite() {
                let (a, b) = (low - bound, high - bound);
                bound + (a.max(1e-4 * b) * b).sqrt()
            } else {
                next
            };
            let small = (moved - t).abs() <= SWEEP_ENOUGH * moved;
            t = moved;
            if small {
                break;
            }
        }
        t
    }
}
