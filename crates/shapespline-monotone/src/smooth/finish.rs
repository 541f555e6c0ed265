// SPDX-License-Identifier: MIT OR Apache-2.0

//! From the neighbourhood of the optimum to it: Newton's method with the active constraints held.
//!
//! Where a rise is smaller than its multiplier it is 0 at the optimum, and so are the slopes at its ends; the same holds
//! for the distances from the bounds. What is left is free and smooth, but for slopes that fall to 0 between two level
//! parts (terms in slope^{3/2}): those step in their root, as the interpolant's do. The end is checked: held rises must
//! have multipliers that are not negative, free ones must stay positive.

use super::active::active;
use super::bent::arms;
use super::interior::{State, Task};
use super::interval::Model;
use super::newton::Newton;
use super::system::{HELD, System};
use crate::MonotoneError;
use crate::interrupt::{GoOn, check_interrupt};

const STEPS: usize = 15;
/// The part of a step below which it is none.
const LEAST_PART: f64 = 1e-5;
/// Steps of every rise and slope, relative to the secants beside them, at which the method ends; and that it must reach.
const ENOUGH: f64 = 1e-11;
const NEEDED: f64 = 1e-7;
/// What the objective may rise by rounding, relative to it.
const ALLOWANCE: f64 = 1e-13;
/// The same of all that is taken to be 0 where convexity is asked: straight and level parts are to be so exactly.
const BENT_ALLOWANCE: f64 = 1e-11;
const TINY_ROOT: f64 = 1e-160;
/// The part of the way to 0 that a step takes arms.
const FRACTION: f64 = 15.0 / 16.0;
/// Changes of what is held, and the part of its first size below which a free rise has fallen to 0.
const ROUNDS: usize = 6;
/// Solves after which what is held no longer changes: the interior point has come near enough as it is.
const SOLVES: usize = 20;
const COLLAPSED: f64 = 1e-4;
/// The part of the slopes beside an interval that its arms are measured by at least.
const LEAST_BEND: f64 = 1e-3;

/// The optimum for one penalty.
#[derive(Debug, Clone)]
pub(super) struct Optimum {
    pub(super) first: f64,
    /// Rises, then slopes ([`Layout`](super::system::Layout)).
    pub(super) sizes: Vec<f64>,
    /// Which of the sizes are held at 0.
    pub(super) held: Vec<bool>,
    pub(super) residual: f64,
    /// The interior point's steps and Newton's.
    pub(super) steps: usize,
    pub(super) converged: bool,
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
    (newton.held, newton.centred) = active(task, lambda, near);
    let (mut first, mut sizes) = (near.first, near.sizes.clone());
    let mut steps = near.steps;
    for round in 1..=ROUNDS {
        if layout.bent {
            (first, sizes) = (near.first, near.sizes.clone());
            task.settle(&mut newton.held, &mut sizes);
        }
        if newton.held[layout.low()] {
            first = task.bounds[0];
        }
        for k in 0..layout.low() {
            if newton.held[k] {
                sizes[k] = 0.0;
            } else if sizes[k] == 0.0 && !task.is_beside_bent(k) {
                sizes[k] = near.sizes[k];
            }
        }
        let (solves, ended) = newton.run(&mut first, &mut sizes, system, go_on)?;
        steps += solves;
        let (rise, size) = newton.rise(&before.0, &before.1);
        let allowance = if layout.bent { BENT_ALLOWANCE } else { ALLOWANCE };
        let better = rise <= allowance * size && newton.is_between();
        // The sizes that `wrong` proposes are for another round.
        let mut answer = sizes.clone();
        if layout.bent {
            task.settle(&mut newton.held, &mut answer);
        }
        let wrong = if ended { newton.wrong(&mut sizes) } else { Vec::new() };
        let last = round == ROUNDS || steps - near.steps >= SOLVES;
        if !wrong.is_empty() && !last {
            for k in wrong {
                newton.held[k] = !newton.held[k];
            }
            newton.held = task.with_slopes(std::mem::take(&mut newton.held));
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

impl Newton<'_> {
    fn evaluate(&mut self, first: f64, sizes: &[f64]) {
        let (task, lambda) = (self.task, self.lambda);
        self.models.clear();
        let model = |i| if self.held[i] { Model::HELD } else { task.model(lambda, i, sizes) };
        self.models.extend((0..self.layout.n).map(model));
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
            check_interrupt(go_on)?;
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
        // Memory is used again: fresh pages cost as much as the arithmetic.
        let (mut models, mut f) = std::mem::take(&mut self.before);
        std::mem::swap(&mut models, &mut self.models);
        std::mem::swap(&mut f, &mut self.f);
        let mut trial = std::mem::take(&mut self.trial);
        trial.clone_from(sizes);
        let (mut t, mut found) = (self.reach(sizes, step), None);
        while t > LEAST_PART && found.is_none() {
            self.moved(sizes, step, t, &mut trial, &models);
            let start = *first + t * step[self.layout.low()];
            self.evaluate(start, &trial);
            let (rise, size) = self.rise(&models, &f);
            if rise <= ALLOWANCE * size {
                found = Some(self.largest(sizes, &trial) / t);
                *first = start;
                std::mem::swap(sizes, &mut trial);
            }
            t *= 0.5;
        }
        if found.is_none() {
            self.evaluate(*first, sizes);
        }
        (self.before, self.trial) = ((models, f), trial);
        found.filter(|largest| largest.is_finite())
    }

    /// The part of a step that leaves something of all arms, and of the slopes beside them.
    fn reach(&self, sizes: &[f64], step: &[f64]) -> f64 {
        let from = self.layout.m(0);
        let over = |k: &usize| {
            let kept = self.task.is_beside_bent(*k) && !self.task.is_free(*k, sizes[*k]);
            kept && !self.held[*k]
        };
        let mut least = 1.0f64;
        for k in (from..self.layout.len()).filter(over) {
            if step[k] < 0.0 {
                least = least.min(-FRACTION * sizes[k] / step[k]);
            }
        }
        least
    }

    /// Hold the free rises that have fallen to nothing from where they started; whether there were any.
    fn hold_collapsed(&mut self, sizes: &mut [f64], start: &[f64]) -> bool {
        let layout = self.layout;
        let mut any = false;
        for i in 0..layout.n {
            let plain = self.task.sense(i) == 0.0 && !self.held[i] && self.centred[i] == 0.0;
            if plain && sizes[i] < COLLAPSED * start[i] {
                for k in [i, layout.m(i), layout.m(i + 1)] {
                    (self.held[k], sizes[k], any) = (true, 0.0, true);
                }
            }
            let arms =
                if self.task.sense(i) == 0.0 { [i, i] } else { [0, 1].map(|k| layout.arm(i, k)) };
            let fallen = |k: usize| {
                !self.held[k] && self.centred[k] == 0.0 && sizes[k] < COLLAPSED * start[k]
            };
            if arms[0] != arms[1] && arms.into_iter().all(fallen) {
                any = true;
                arms.into_iter().for_each(|k| self.held[k] = true);
            }
        }
        if any && layout.bent {
            self.task.settle(&mut self.held, sizes);
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
        for k in 0..if layout.bent { layout.len() } else { 0 } {
            if self.task.is_beside_bent(k) {
                // What arms and other slopes keep positive may be 0, and rounding less.
                let moved = (sizes[k] + t * step[k]).max(0.0);
                out[k] = if self.held[k] { sizes[k] } else { moved };
            }
        }
        for i in 0..=layout.n {
            let k = layout.m(i);
            if self.held[k] || self.task.is_beside_bent(k) {
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
        for i in (0..layout.n).filter(|i| !self.held[*i] && self.task.sense(*i) == 0.0) {
            largest = largest.max((moved[i] - sizes[i]).abs() / moved[i]);
            for k in [layout.m(i), layout.m(i + 1)] {
                let change = (moved[k] - sizes[k]).abs();
                largest = largest.max(change * h[i] / (moved[i] + moved[k] * h[i]));
            }
        }
        for i in (0..layout.n).filter(|i| self.task.sense(*i) != 0.0) {
            // Second derivatives, relative to the larger of the interval's own and of a share of the slopes over all.
            let unit = moved[i] + h[i] * (moved[layout.m(i)] + moved[layout.m(i + 1)]);
            let [a, b] = arms(layout, moved, i);
            for k in [layout.arm(i, 0), layout.arm(i, 1)].into_iter().filter(|k| !self.held[*k]) {
                largest = largest.max((moved[k] - sizes[k]).abs() / (a + b + LEAST_BEND * unit));
            }
        }
        if largest.is_nan() { f64::INFINITY } else { largest }
    }
}
