// SPDX-License-Identifier: MIT OR Apache-2.0

//! What is 0 at the optimum: a first answer from the interior point, and what the multipliers of Newton's answer say of it.

use super::interior::{State, Task};
use super::newton::Newton;

/// Ratios of rises to multipliers beyond which it is clear what is 0; the least share of a multiplier in the push.
const CLEAR: f64 = 30.0;
const LEAST_SHARE: f64 = 0.01;
/// What multipliers of held rises may be below 0, relative to the largest.
const TOLERANCE: f64 = 1e-7;

/// Sizes that are 0 at the optimum: rises, the slopes at their ends, distances from bounds, arms; and the products of
/// sizes and multipliers of which neither is small, for which both may be 0.
///
/// On the way to 0 a rise is smaller than its multiplier, which makes up a good part of what the data push it with; where
/// a tiny rise remains, the energy of its level part pushes back instead.
pub(super) fn active(task: &Task, lambda: f64, near: &State) -> (Vec<bool>, Vec<f64>) {
    let layout = task.layout();
    // Rises are as large as the intervals are wide.
    let unit = 1.0 / layout.n as f64;
    let ratio = |i: usize| near.sizes[i] * unit / (task.h[i] * near.multipliers[i]);
    let (mut f, mut pull) = (Vec::new(), Vec::new());
    task.values(near.first, &near.sizes, &mut f);
    task.pull(&f, &mut pull);
    let (mut held, mut centred) = (vec![false; layout.len()], vec![0.0; layout.len()]);
    let mut push = near.multipliers[layout.low()];
    for i in 0..layout.n {
        push -= pull[i];
        if near.multipliers[i] == 0.0 {
            continue;
        }
        let pushed = near.multipliers[i] > LEAST_SHARE * push;
        held[i] = pushed && ratio(i) < 1.0 / CLEAR;
        if pushed && !held[i] && ratio(i) < CLEAR {
            centred[i] = near.sizes[i] * near.multipliers[i];
        }
    }
    for k in [layout.low(), layout.high()] {
        held[k] = near.sizes[k] < near.multipliers[k];
    }
    if layout.bent {
        task.active_arms(near, lambda, [CLEAR, LEAST_SHARE], &mut held, &mut centred);
    }
    (task.with_slopes(held), centred)
}

impl Task {
    /// Slopes are held at the ends of rises that are. Beside arms they are held on their own.
    pub(super) fn with_slopes(&self, mut held: Vec<bool>) -> Vec<bool> {
        let layout = self.layout();
        for i in 0..=layout.n {
            let beside = (i > 0 && held[i - 1]) || (i < layout.n && held[i]);
            let k = layout.m(i);
            held[k] = beside || (held[k] && self.is_beside_bent(k));
        }
        held
    }
}

impl Newton<'_> {
    /// The slope at the end of a flat and the rise of the flat's last interval that balance a gradient in the slope and
    /// the rise's multiplier ζ: a level part has `E = (4/9)m³/d`, least with its rise for `d = (2/3)m^{3/2}√(λ/ζ)`, when
    /// it pulls the slope with `(4/3)√(λζm)`. Nothing without a multiplier.
    fn opened(&self, gradient: f64, curvature: f64, multiplier: f64) -> (f64, f64) {
        if !(multiplier > 0.0) {
            return (0.0, 0.0);
        }
        let pull = 4.0 / 3.0 * (self.lambda * multiplier).sqrt();
        let root = -2.0 * gradient / (pull + (pull * pull - 4.0 * curvature * gradient).sqrt());
        (root * root, 2.0 / 3.0 * root.powi(3) * (self.lambda / multiplier).sqrt())
    }

    /// What is held and should not be, or free and should be held: by the signs of multipliers and by the bounds.
    pub(super) fn wrong(&self, sizes: &mut [f64]) -> Vec<usize> {
        let (layout, n) = (self.layout, self.layout.n);
        let total: f64 = self.pull.iter().sum();
        let [low, high] = [self.held[layout.low()], self.held[layout.high()]];
        let gradient = |i: usize| self.models[i].plain_gradient(self.task.h[i]);
        let mut sum = 0.0;
        let mut summed = |pull: &f64| {
            sum += pull;
            sum
        };
        let before: Vec<f64> = self.pull[..n].iter().map(&mut summed).collect();
        // The multipliers of the bounds, by the stationarity of the first value and of a free rise.
        let bottom = match (low, high) {
            (false, _) => 0.0,
            (true, false) => total,
            (true, true) => {
                let known = |i: &usize| !self.held[*i] && !self.task.is_straight(*i, &self.held);
                let free = (0..n).find(known);
                free.map_or(0.0, |i| before[i] - gradient(i)[0])
            }
        };
        let top = bottom - total;
        let size = before.iter().fold(bottom.abs(), |size, v| size.max(v.abs()));
        let least = -TOLERANCE * size;
        let ([lowest, highest], [first, last]) = (self.task.bounds, [self.f[0], self.f[n]]);
        let mut wrong: Vec<usize> =
            (0..n).filter(|i| self.held[*i] && bottom - before[*i] < least).collect();
        if if low { bottom < least } else { first < lowest } {
            wrong.push(layout.low());
        }
        if if high { top < least } else { last > highest } {
            wrong.push(layout.high());
        }
        // Where the slope wants to rise beside a flat, the flat is too long: a level part with a rise ends it.
        for i in (0..n).filter(|i| !self.held[*i] && self.task.sense(*i) == 0.0) {
            let [_, left, right] = gradient(i);
            let [_, curvatures] = self.models[i].curvatures(self.task.h[i]);
            let wants = -1e-6 * left.abs().max(right.abs());
            if i > 0 && self.held[i - 1] && left < wants {
                wrong.push(i - 1);
                (sizes[layout.m(i)], sizes[i - 1]) =
                    self.opened(left, curvatures[0], bottom - before[i - 1]);
            }
            if i + 1 < n && self.held[i + 1] && right < wants {
                wrong.push(i + 1);
                let node = layout.m(i + 1);
                (sizes[node], sizes[i + 1]) =
                    self.opened(right, curvatures[1], bottom - before[i + 1]);
            }
        }
        if layout.bent {
            wrong.extend(self.task.wrong_arms(
                &self.models,
                &self.held,
                &before,
                bottom,
                TOLERANCE,
            ));
        }
        wrong.sort_unstable();
        wrong.dedup();
        wrong
    }
}
