// SPDX-License-Identifier: MIT OR Apache-2.0

//! What smoothing asks of convexity: arms of intervals, and the function to start from.
//!
//! A convex interval has arms `a = δ − m₀ ≥ 0` and `b = m₁ − δ ≥ 0`, by which the slopes at its ends differ from its
//! secant (a concave one `m₀ − δ` and `δ − m₁`). Its least energy `E(a, b)` is convex and homogeneous, so that where both
//! arms are 0 the interval is straight, and the second derivative that the data ask for must have the other sign there.
//! Arms are unknowns of their own, with steps of their own: differences of slopes and secants would lose their digits.

use super::interior::{FAR, State, Task};
use super::interval::Model;
use super::system::Layout;
use std::ops::Range;

/// By which part slopes change over the line that the iteration starts from.
const CHANGE: f64 = 0.5;
/// Second derivatives of the wrong sign, relative to those of the other end, and arms in ulps of the slopes, that are
/// rounding.
const ROUNDING: f64 = 1e-9;
const ULPS: f64 = 16.0;
/// What a step leaves of an arm's share in the sum of both, and the share that it may take at once.
const GROWTH: f64 = 0.4;
const LEAST_SHARE: f64 = 0.2;

impl Task {
    /// 1 where interval i is to be convex, −1 where concave, else 0.
    pub(super) fn sense(&self, i: usize) -> f64 {
        self.bend.get(i).map_or(0.0, |bend| f64::from(*bend))
    }

    /// Whether the size k needs no constraint: a bound that is not there, an arm of an interval of which nothing is
    /// asked, and what arms and other slopes keep positive.
    pub(super) fn is_free(&self, k: usize, size: f64) -> bool {
        let layout = self.layout();
        if k < layout.n {
            self.sense(k) != 0.0
        } else if k < layout.low() {
            let i = k - layout.n;
            (i > 0 && self.sense(i - 1) > 0.0) || self.sense(i) < 0.0
        } else {
            size == FAR
        }
    }

    /// The energy of interval i.
    pub(super) fn model(&self, lambda: f64, i: usize, sizes: &[f64]) -> Model {
        let (layout, sense, h) = (self.layout(), self.sense(i), self.h[i]);
        if sense != 0.0 {
            return Model::bent(lambda, sense, arms(layout, sizes, i), h);
        }
        Model::new(lambda, [sizes[layout.m(i)], sizes[layout.m(i + 1)]], sizes[i], h)
    }

    /// What the slopes at the ends of all intervals with arms are above their secants.
    pub(super) fn over_secants(&self, sizes: &[f64]) -> Vec<[f64; 2]> {
        let over = |i: usize| {
            let sense = self.sense(i);
            if sense == 0.0 {
                return [0.0; 2];
            }
            let [a, b] = arms(self.layout(), sizes, i);
            [-sense * a, sense * b]
        };
        (0..self.bend.len()).map(over).collect()
    }

    /// Bend a line: second derivatives of one size, and of the signs asked for, with the same rise.
    pub(super) fn bend_line(&self, slope: f64, sizes: &mut Vec<f64>) {
        let (layout, n) = (self.layout(), self.h.len());
        let mut turned = vec![0.0];
        for i in 0..n {
            turned.push(turned[i] + self.sense(i) * self.h[i]);
        }
        let most = turned.iter().fold(f64::MIN_POSITIVE, |most, t| f64::max(most, t.abs()));
        let relative: Vec<f64> = turned.iter().map(|t| 1.0 + CHANGE * (t / most)).collect();
        let rises: Vec<f64> =
            (0..n).map(|i| 0.5 * self.h[i] * (relative[i] + relative[i + 1])).collect();
        let unit = slope * (self.h.iter().sum::<f64>() / rises.iter().sum::<f64>());
        for i in 0..n {
            sizes[i] = unit * rises[i];
        }
        for i in 0..=n {
            sizes[layout.m(i)] = unit * relative[i];
        }
        for i in 0..n {
            let arm =
                if self.sense(i) == 0.0 { FAR } else { 0.5 * CHANGE * unit * (self.h[i] / most) };
            sizes.extend([arm; 2]);
        }
    }

    /// The part of a step in which no ratio of two arms grows by more than it may: along a ray the energy of an interval is
    /// quadratic, as Newton's model has it, but across rays it is not.
    pub(super) fn reach_of_ratios(&self, sizes: &[f64], step: &[f64]) -> f64 {
        let layout = self.layout();
        let mut most = 1.0f64;
        for i in (0..self.bend.len()).filter(|i| self.bend[*i] != 0) {
            let (own, by) = (arms(layout, sizes, i), arms(layout, step, i));
            let (sum, sum_by) = (own[0] + own[1], by[0] + by[1]);
            for end in 0..2 {
                let share = (GROWTH * (own[end] / sum)).min(LEAST_SHARE);
                let (room, fall) = (own[end] - share * sum, share * sum_by - by[end]);
                if fall > room {
                    most = most.min(room / fall);
                }
            }
        }
        most
    }

    /// Whether cubics with these slopes and rises are convex and concave where that is asked, but for rounding (at free
    /// ends the second derivative is 0); their arms.
    pub(super) fn is_bent(&self, sizes: &mut [f64]) -> bool {
        let layout = self.layout();
        (0..self.bend.len()).filter(|i| self.bend[*i] != 0).all(|i| {
            let (sense, delta) = (self.sense(i), sizes[i] / self.h[i]);
            let [first, last] = [sizes[layout.m(i)], sizes[layout.m(i + 1)]];
            let rounding = ULPS * f64::EPSILON * (first + last + delta);
            let [a, b] = [sense * (delta - first), sense * (last - delta)];
            let straight = a.abs() <= rounding && b.abs() <= rounding;
            let arms = if straight { [0.0; 2] } else { [a, b] };
            sizes[layout.arm(i, 0)..=layout.arm(i, 1)].copy_from_slice(&arms);
            let more = |a: f64, b: f64| b - 2.0 * a <= ROUNDING * (a + b) + rounding;
            straight || (a > 0.0 && b > 0.0 && more(a, b) && more(b, a))
        })
    }
}

impl Task {
    /// Whether the size k is that of an interval with arms, its own or that of one of its ends.
    pub(super) fn is_beside_bent(&self, k: usize) -> bool {
        let layout = self.layout();
        if k < layout.n {
            self.sense(k) != 0.0
        } else if k < layout.low() {
            let i = k - layout.n;
            self.sense(i) != 0.0 || (i > 0 && self.sense(i - 1) != 0.0)
        } else {
            k > layout.high() && self.sense((k - layout.arm(0, 0)) / 2) != 0.0
        }
    }

    /// Whether interval i has arms that are held.
    pub(super) fn is_straight(&self, i: usize, held: &[bool]) -> bool {
        self.sense(i) != 0.0 && held[self.layout().arm(i, 0)]
    }

    /// Hold the arms of intervals that are straight at the optimum, and the slopes beside arms that are 0 there; keep
    /// products with multipliers where neither is clear.
    ///
    /// On the way to 0 arms are smaller than their multipliers, which make up a good part of what the data push with;
    /// where a narrow ramp remains, its energy pushes back instead.
    pub(super) fn active_arms(
        &self,
        near: &State,
        lambda: f64,
        [clear, least_share]: [f64; 2],
        held: &mut [bool],
        centred: &mut [f64],
    ) {
        let layout = self.layout();
        let unit = 1.0 / layout.n as f64;
        for i in (0..layout.n).filter(|i| self.sense(*i) != 0.0) {
            let own = [0, 1].map(|end| layout.arm(i, end));
            let [a, b, _] = self.model(lambda, i, &near.sizes).gradient;
            let multipliers = near.multipliers[own[0]] + near.multipliers[own[1]];
            let size = (near.sizes[own[0]] + near.sizes[own[1]]) * unit / self.h[i];
            let pushed = multipliers > least_share * (a.abs() + b.abs());
            for k in own {
                held[k] = pushed && size * clear < multipliers;
                if pushed && !held[k] && size < clear * multipliers {
                    centred[k] = near.sizes[k] * near.multipliers[k];
                }
            }
        }
        for i in 0..=layout.n {
            let k = layout.m(i);
            held[k] = self.is_beside_bent(k) && near.sizes[k] * unit < near.multipliers[k];
        }
    }

    /// Take 0 for what is held, and the slopes and rises that belong to the arms: steps keep them together.
    pub(super) fn settle(&self, held: &mut [bool], sizes: &mut [f64]) {
        let (layout, n) = (self.layout(), self.h.len());
        for k in (0..layout.len()).filter(|k| self.is_beside_bent(*k)) {
            if held[k] {
                sizes[k] = 0.0;
            }
        }
        let mut start = 0;
        while start < n {
            let mut end = start;
            while end < n && self.sense(end) != 0.0 {
                end += 1;
            }
            self.close(start..end, held, sizes);
            let change = |i: usize, sizes: &[f64]| {
                let [a, b] = arms(layout, sizes, i);
                self.sense(i) * (a + b)
            };
            let base = (start..=end).find(|i| held[layout.m(*i)]).unwrap_or(start);
            for i in base..end {
                let k = layout.m(i);
                let to = if held[k + 1] { 0.0 } else { (sizes[k] + change(i, sizes)).max(0.0) };
                sizes[k + 1] = to;
            }
            for i in (start..base).rev() {
                let k = layout.m(i);
                sizes[k] = (sizes[k + 1] - change(i, sizes)).max(0.0);
            }
            for i in start..end {
                let arm = self.sense(i) * sizes[layout.arm(i, 0)];
                sizes[i] = (self.h[i] * (sizes[layout.m(i)] + arm)).max(0.0);
            }
            start = end + 1;
        }
    }

    /// Between two slopes that are held at 0 the slope rises by as much as it falls: scale the arms, which do so nearly.
    fn close(&self, run: Range<usize>, held: &mut [bool], sizes: &mut [f64]) {
        let layout = self.layout();
        let nodes = run.start..=run.end;
        let level: Vec<usize> = nodes.filter(|i| held[layout.m(*i)]).collect();
        for ends in level.windows(2) {
            let sum = |sense: f64| -> f64 {
                let own = (ends[0]..ends[1]).filter(|i| self.sense(*i) == sense);
                own.map(|i| arms(layout, sizes, i).iter().sum::<f64>()).sum()
            };
            let [up, down] = [sum(1.0), sum(-1.0)];
            let nothing = up == 0.0 || down == 0.0;
            let factor = if nothing { 0.0 } else { (down / up).sqrt() };
            for i in ends[0]..ends[1] {
                for k in [layout.arm(i, 0), layout.arm(i, 1)] {
                    sizes[k] *= if self.sense(i) < 0.0 && !nothing { 1.0 / factor } else { factor };
                    held[k] |= nothing;
                }
            }
        }
    }

    /// Arms that are held although the data bend the interval as asked, and slopes beside arms that are held although
    /// they want to rise. `pulls` are the sums of the values' gradients up to every node, `bottom` the multiplier of the
    /// lower bound.
    ///
    /// The gradient of the energy in a slope from its left is a moment M (twice the second derivative). With the sum c of
    /// pulls it is `M − ch` behind an interval, whatever holds that; a straight one is to have no moments of its sign at
    /// its ends.
    pub(super) fn wrong_arms(
        &self,
        models: &[Model],
        held: &[bool],
        pulls: &[f64],
        bottom: f64,
        tolerance: f64,
    ) -> Vec<usize> {
        let (layout, n) = (self.layout(), self.h.len());
        let is_straight = |i: usize| self.is_straight(i, held);
        let shear = |i: usize| (pulls[i] - bottom) * self.h[i];
        // Moments at the left and the right end of every interval, NaN where they are not known.
        let mut moments = vec![[f64::NAN; 2]; n];
        for i in (0..n).filter(|i| !is_straight(*i) && !held[*i]) {
            let [_, left, right] = models[i].plain_gradient(self.h[i]);
            moments[i] = [-left, right];
        }
        let known = |i: usize| !held[layout.m(i)];
        for i in (0..n).filter(|i| is_straight(*i)) {
            let before = if i > 0 { moments[i - 1][1] } else { 0.0 };
            if known(i) {
                moments[i] = [before, before - shear(i)];
            }
        }
        for i in (0..n).rev().filter(|i| is_straight(*i)) {
            let after = if i + 1 < n { moments[i + 1][0] } else { 0.0 };
            if known(i + 1) && moments[i][0].is_nan() {
                moments[i] = [after + shear(i), after];
            }
        }
        let largest = moments.iter().flatten().fold(0.0f64, |size, m| size.max(m.abs()));
        let most = tolerance * largest;
        let mut wrong = Vec::new();
        for i in (0..n).filter(|i| is_straight(*i)) {
            if moments[i].iter().any(|m| self.sense(i) * m > most) {
                wrong.extend([layout.arm(i, 0), layout.arm(i, 1)]);
            }
        }
        for i in (0..=n).filter(|i| held[layout.m(*i)] && self.is_beside_bent(layout.m(*i))) {
            let left = if i > 0 { moments[i - 1][1] } else { 0.0 };
            let right = if i < n { moments[i][0] } else { 0.0 };
            if left - right < -most {
                wrong.push(layout.m(i));
            }
        }
        wrong
    }
}

/// The arms of interval i.
pub(super) fn arms(layout: Layout, sizes: &[f64], i: usize) -> [f64; 2] {
    [0, 1].map(|end| sizes[layout.arm(i, end)])
}
