// SPDX-License-Identifier: MIT OR Apache-2.0

//! From the neighbourhood of the optimum to it: Newton's method with the active constraints held.
//!
//! Where a rise is smaller than its multiplier it is 0 at the optimum, and so are the slopes at its ends; the same holds
//! for the distances from the bounds. What is left is free and smooth, but for slopes that fall to 0 between two level
//! parts (terms in slope^{3/2}): those step in their root, as the interpolant's do. The end is checked: held rises must
//! have multipliers that are not negative, free ones must stay positive.

use super::interior::{State, Task};
use super::interval::Model;
use super::system::{HELD, Layout, System};
use crate::MonotoneError;
use crate::interrupt::{GoOn, ask};

const STEPS: usize = 15;
/// The part of a step below which it is none.
const LEAST_PART: f64 = 1e-5;
/// Steps of every rise and slope, relative to the secants beside them, at which the method ends; and that it must reach.
const ENOUGH: f64 = 1e-11;
const NEEDED: f64 = 1e-7;
/// What multipliers of held rises may be below 0, relative to the largest.
const TOLERANCE: f64 = 1e-7;
/// What the objective may rise by rounding, relative to it.
const ALLOWANCE: f64 = 1e-13;
const TINY_ROOT: f64 = 1e-160;
/// Changes of what is held, and the part of its first size below which a free rise has fallen to 0.
const ROUNDS: usize = 6;
/// Solves after which what is held no longer changes: the interior point has come near enough as it is.
const SOLVES: usize = 20;
/// Ratios of rises to multipliers beyond which it is clear what is 0; the least share of a multiplier in the push.
const CLEAR: f64 = 30.0;
const LEAST_SHARE: f64 = 0.01;
const COLLAPSED: f64 = 1e-4;

/// The optimum for one penalty.
#[derive(Debug, Clone)]
pub(super) struct Optimum {
    pub(super) first: f64,
    /// Rises, then slopes ([`Layout`]).
    pub(super) sizes: Vec<f64>,
    /// Which of the sizes are held at 0.
    pub(super) held: Vec<bool>,
    pub(super) residual: f64,
    /// The interior point's steps and Newton's.
    pub(super) steps: usize,
    pub(super) converged: bool,
}

/// Newton's method at a point, with room for its arrays.
struct Newton<'a> {
    task: &'a Task,
    lambda: f64,
    layout: Layout,
    held: Vec<bool>,
    /// Products that rises keep with their multipliers; 0 where they are held or free.
    centred: Vec<f64>,
    models: Vec<Model>,
    f: Vec<f64>,
    pull: Vec<f64>,
}

/// The optimum near an interior point's answer, or what is nearer to it than that; `None` where nothing is.
pub(super) fn finish(
    task: &Task,
    lambda: f64,
    near: &State,
    system: &mut System,
    go_on: GoOn<'_>,
) -> Result<Option<Optimum>, MonotoneError> {
    let layout = task.layout();
    let mut newton = Newton::new(task, lambda);
    newton.evaluate(near.first, &near.sizes);
    let before = (newton.models.clone(), newton.f.clone());
    (newton.held, newton.centred) = active(task, near);
    let (mut first, mut sizes) = (near.first, near.sizes.clone());
    let mut steps = near.steps;
    for round in 1..=ROUNDS {
        if newton.held[layout.low()] {
            first = task.bounds[0];
        }
        for k in 0..layout.low() {
            if newton.held[k] {
                sizes[k] = 0.0;
            } else if sizes[k] == 0.0 {
                sizes[k] = near.sizes[k];
            }
        }
        let (solves, ended) = newton.run(&mut first, &mut sizes, system, go_on)?;
        steps += solves;
        let (rise, size) = newton.rise(&before.0, &before.1);
        let better = rise <= ALLOWANCE * size && newton.is_between();
        // The sizes that `wrong` proposes are for another round.
        let answer = sizes.clone();
        let wrong = if ended { newton.wrong(&mut sizes) } else { Vec::new() };
        let last = round == ROUNDS || steps - near.steps >= SOLVES;
        if !wrong.is_empty() && !last {
            for k in wrong {
                newton.held[k] = !newton.held[k];
            }
            hold_slopes(&mut newton.held, layout);
        } else if !better {
            return Ok(None);
        } else {
            let residual = task.residual(&newton.f);
            let held = newton.held;
            return Ok(Some(Optimum {
                first,
                sizes: answer,
                held,
                residual,
                steps,
                converged: true,
            }));
        }
    }
    Ok(None)
}

/// Sizes that are 0 at the optimum: rises, the slopes at their ends, distances from bounds; and the products of rises
/// and multipliers of which neither is small, for which both may be 0.
///
/// On the way to 0 a rise is smaller than its multiplier, which makes up a good part of what the data push it with; where
/// a tiny rise remains, the energy of its level part pushes back instead.
pub(super) fn active(task: &Task, near: &State) -> (Vec<bool>, Vec<f64>) {
    let layout = task.layout();
    // Rises are as large as the intervals are wide.
    let unit = 1.0 / layout.n as f64;
    let ratio = |i: usize| near.sizes[i] * unit / (task.h[i] * near.multipliers[i]);
    let (mut f, mut pull) = (Vec::new(), Vec::new());
    task.values(near.first, &near.sizes, &mut f);
    task.pull(&f, &mut pull);
    let (mut held, mut centred) = (vec![false; layout.len()], vec![0.0; layout.n]);
    let mut push = near.multipliers[layout.low()];
    for i in 0..layout.n {
        push -= pull[i];
        let pushed = near.multipliers[i] > LEAST_SHARE * push;
        held[i] = pushed && ratio(i) < 1.0 / CLEAR;
        if pushed && !held[i] && ratio(i) < CLEAR {
            centred[i] = near.sizes[i] * near.multipliers[i];
        }
    }
    for k in [layout.low(), layout.high()] {
        held[k] = near.sizes[k] < near.multipliers[k];
    }
    hold_slopes(&mut held, layout);
    (held, centred)
}

/// Slopes are held at the ends of rises that are.
fn hold_slopes(held: &mut [bool], layout: Layout) {
    held[layout.m(0)] = held[0];
    for i in 0..layout.n {
        held[layout.m(i + 1)] = held[i] || (i + 1 < layout.n && held[i + 1]);
    }
}

impl<'a> Newton<'a> {
    fn new(task: &'a Task, lambda: f64) -> Self {
        let layout = task.layout();
        let (held, centred) = (vec![false; layout.len()], vec![0.0; layout.n]);
        Self { task, lambda, layout, held, centred, models: vec![], f: vec![], pull: vec![] }
    }

    fn evaluate(&mut self, first: f64, sizes: &[f64]) {
        let (layout, lambda) = (self.layout, self.lambda);
        self.models.clear();
        for (i, h) in self.task.h.iter().enumerate() {
            let m = [sizes[layout.m(i)], sizes[layout.m(i + 1)]];
            let held = self.held[i];
            self.models.push(if held { Model::HELD } else { Model::new(lambda, m, sizes[i], *h) });
        }
        self.task.values(first, sizes, &mut self.f);
        self.task.pull(&self.f, &mut self.pull);
    }

    /// Newton's steps until they are small; how many, and whether they became so.
    fn run(
        &mut self,
        first: &mut f64,
        sizes: &mut Vec<f64>,
        system: &mut System,
        go_on: GoOn<'_>,
    ) -> Result<(usize, bool), MonotoneError> {
        let (layout, h) = (self.layout, &self.task.h);
        let twice = self.task.twice();
        let (mut stiff, mut beside) = (vec![0.0; layout.len()], vec![0.0; layout.len()]);
        let (mut step, start) = (vec![0.0; layout.len()], sizes.clone());
        self.evaluate(*first, sizes);
        let mut last = f64::INFINITY;
        for solves in 1..=STEPS {
            ask(go_on)?;
            self.constrain(sizes, &mut stiff, &mut beside);
            system.factor(h, &self.models, &twice, &stiff);
            system.solve(h, &self.models, &self.pull, &beside, &mut step);
            let Some(largest) = self.advance(first, sizes, &step) else {
                return Ok((solves, false));
            };
            if self.hold_collapsed(sizes, &start) {
                self.evaluate(*first, sizes);
                last = f64::INFINITY;
                continue;
            }
            // It converges quadratically until only rounding errors are left.
            if largest <= ENOUGH || (largest <= NEEDED && largest > 0.25 * last) {
                return Ok((solves, true));
            }
            last = largest;
        }
        Ok((STEPS, false))
    }

    /// Stiffness and gradient of what is held or keeps its product with its multiplier.
    fn constrain(&self, sizes: &[f64], stiff: &mut [f64], beside: &mut [f64]) {
        for (k, held) in self.held.iter().enumerate() {
            (stiff[k], beside[k]) = (if *held { HELD } else { 0.0 }, 0.0);
        }
        let high = self.layout.high();
        if self.held[high] {
            // Held at the bound, wherever the sum of the rises is now.
            beside[high] = HELD * (self.task.bounds[1] - self.f[self.layout.n]);
        }
        for (i, product) in self.centred.iter().enumerate() {
            if *product > 0.0 && !self.held[i] {
                (beside[i], stiff[i]) = (-product / sizes[i], product / (sizes[i] * sizes[i]));
            }
        }
    }

    /// Take the step, or as much of it as makes the objective smaller: the largest relative change for all of it,
    /// `None` where hardly anything of it does.
    fn advance(&mut self, first: &mut f64, sizes: &mut Vec<f64>, step: &[f64]) -> Option<f64> {
        let (models, f) = (self.models.clone(), self.f.clone());
        let mut trial = sizes.clone();
        let mut t = 1.0;
        while t > LEAST_PART {
            self.moved(sizes, step, t, &mut trial, &models);
            let start = *first + t * step[self.layout.low()];
            self.evaluate(start, &trial);
            let (rise, size) = self.rise(&models, &f);
            if rise <= ALLOWANCE * size {
                let largest = self.largest(sizes, &trial) / t;
                (*first, *sizes) = (start, trial);
                return largest.is_finite().then_some(largest);
            }
            t *= 0.5;
        }
        self.evaluate(*first, sizes);
        None
    }

    /// Hold the free rises that have fallen to nothing from where they started; whether there were any.
    fn hold_collapsed(&mut self, sizes: &mut [f64], start: &[f64]) -> bool {
        let layout = self.layout;
        let mut any = false;
        for i in 0..layout.n {
            if !self.held[i] && self.centred[i] == 0.0 && sizes[i] < COLLAPSED * start[i] {
                for k in [i, layout.m(i), layout.m(i + 1)] {
                    (self.held[k], sizes[k], any) = (true, 0.0, true);
                }
            }
        }
        any
    }

    /// Whether the values are between the bounds, but for rounding.
    fn is_between(&self) -> bool {
        let ([low, high], [first, last]) = (self.task.bounds, [self.f[0], self.f[self.layout.n]]);
        first >= low - 1e-12 && last <= high + 1e-12
    }

    /// Sizes after a part of a step.
    fn moved(&self, sizes: &[f64], step: &[f64], t: f64, out: &mut [f64], models: &[Model]) {
        let layout = self.layout;
        for k in 0..layout.n {
            out[k] = if self.held[k] { 0.0 } else { (sizes[k] + t * step[k]).max(sizes[k] / 16.0) };
        }
        for i in 0..=layout.n {
            let k = layout.m(i);
            if self.held[k] {
                continue;
            }
            let (mut own, mut all) = (0.0, 0.0);
            for (j, side) in [(i.wrapping_sub(1), 1), (i, 0)] {
                if let Some(model) = models.get(j) {
                    let [a, b] = model.curvatures(self.task.h[j]);
                    (own, all) = (own + a[side], all + b[side]);
                }
            }
            let (m, by) = (sizes[k], t * step[k]);
            out[k] = if own > 0.5 * all {
                // A term in slope^(3/2) rules: the step is taken in the root of the slope.
                let root = m.sqrt().max(TINY_ROOT);
                let moved = (root + by / (2.0 * root)).max(0.0);
                moved * moved
            } else {
                (m + by).max(m / 16.0)
            };
        }
    }

    /// By how much the objective is above that before, and its size.
    fn rise(&self, models: &[Model], f: &[f64]) -> (f64, f64) {
        let (mut rise, mut size) = (0.0, 0.0);
        for (now, before) in self.models.iter().zip(models) {
            rise += now.energy - before.energy;
            size += before.energy;
        }
        for i in 0..f.len() {
            let (now, y, w) = (self.f[i], self.task.y[i], self.task.w[i]);
            rise += w * (now - f[i]) * ((now - y) + (f[i] - y));
            size += w * (f[i] - y) * (f[i] - y);
        }
        (rise, size)
    }

    /// The largest change of a rise or slope, relative to the secants beside it.
    fn largest(&self, sizes: &[f64], moved: &[f64]) -> f64 {
        let (layout, h) = (self.layout, &self.task.h);
        let mut largest = 0.0f64;
        for i in (0..layout.n).filter(|i| !self.held[*i]) {
            largest = largest.max((moved[i] - sizes[i]).abs() / moved[i]);
            for k in [layout.m(i), layout.m(i + 1)] {
                let change = (moved[k] - sizes[k]).abs();
                largest = largest.max(change * h[i] / (moved[i] + moved[k] * h[i]));
            }
        }
        if largest.is_nan() { f64::INFINITY } else { largest }
    }

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
    fn wrong(&self, sizes: &mut [f64]) -> Vec<usize> {
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
                let free = (0..n).find(|i| !self.held[*i]);
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
        for i in (0..n).filter(|i| !self.held[*i]) {
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
        wrong.sort_unstable();
        wrong.dedup();
        wrong
    }
}
