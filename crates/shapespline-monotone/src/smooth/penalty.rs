// SPDX-License-Identifier: MIT OR Apache-2.0

//! Optima for given penalties, and the choice of the penalty: by cross-validation or by the residual it leaves.

use super::active::active;
use super::finish::{Optimum, finish};
use super::input::Input;
use super::interior::{State, minimise, unconstrained};
use super::interval::Model;
use super::pool::isotonic;
use super::system::{HELD, System};
use crate::MonotoneError;
use crate::interrupt::GoOn;

/// The relative gap at which the interior point hands over to Newton's method.
const GAP: f64 = 1e-12;
/// The stiffness of a held value that makes degrees of freedom exact to 8 digits at least.
const HELD_VALUE: f64 = 1e16;
/// Scaled penalties from which the function is a straight line.
pub(super) const LINE: f64 = 1e12;
/// Scaled penalties below which rounding hides that the function is not the isotonic regression's.
const NOTHING: f64 = 1e-40;
/// The same where convexity is asked: the values no longer change in the tenth digit.
const NOTHING_BENT: f64 = 1e-24;
/// How near the residual comes to the one given, relative to it, and evaluations at most.
const NEAR: f64 = 1e-10;
const EVALUATIONS: usize = 60;
/// Decimal logarithms of scaled penalties that cross-validation tries first, and the width to which it narrows them.
const STRAIGHT: i32 = 2;
const NARROW: f64 = 0.02;
/// The gap at which scores are told: they are compared to four digits or so.
const SCORE_GAP: f64 = 1e-7;

/// Optima of one set of data.
pub(super) struct Optima<'a> {
    pub(super) input: &'a Input,
    system: System,
    go_on: GoOn<'a>,
    /// The scaled penalty that searches call 1, so that they do the same whatever the units are.
    unit: f64,
}

impl<'a> Optima<'a> {
    pub(super) fn new(input: &'a Input, go_on: GoOn<'a>) -> Self {
        let range: f64 = input.task.h.iter().sum();
        let unit = range.powi(3) * input.task.w.iter().sum::<f64>();
        Self { input, system: System::new(input.task.layout()), go_on, unit }
    }

    /// The optimum for a scaled penalty.
    pub(super) fn at(&mut self, lambda: f64) -> Result<Optimum, MonotoneError> {
        let task = &self.input.task;
        if self.is_isotonic(lambda) {
            return Ok(self.isotonic());
        }
        let lambda = self.clamped(lambda);
        if let Some(state) = unconstrained(task, lambda, &mut self.system) {
            return Ok(self.without_finish(lambda, &state));
        }
        let state = minimise(task, lambda, None, GAP, &mut self.system, self.go_on)?;
        let mut found = finish(task, lambda, &state, &mut self.system, self.go_on)?
            .unwrap_or_else(|| self.without_finish(lambda, &state));
        found.converged &= state.gap <= GAP;
        Ok(found)
    }

    /// Whether the optimum is the isotonic regression, which may have kinks: not where convexity is asked.
    fn is_isotonic(&self, lambda: f64) -> bool {
        self.input.rigid || (lambda < NOTHING && self.input.task.bend.is_empty())
    }

    fn clamped(&self, lambda: f64) -> f64 {
        let least = if self.input.task.bend.is_empty() { NOTHING } else { NOTHING_BENT };
        lambda.clamp(least, LINE)
    }

    /// A state as it stands: rises that are 0 at the optimum are tiny in it.
    fn without_finish(&self, lambda: f64, state: &State) -> Optimum {
        let task = &self.input.task;
        let mut f = Vec::new();
        task.values(state.first, &state.sizes, &mut f);
        let (first, steps, residual) = (state.first, state.steps, task.residual(&f));
        let (held, sizes) = (active(task, lambda, state).0, state.sizes.clone());
        Optimum { first, sizes, held, residual, steps, converged: true }
    }

    /// The isotonic regression.
    pub(super) fn isotonic(&self) -> Optimum {
        let task = &self.input.task;
        let layout = task.layout();
        let mut f = isotonic(&task.y, &task.w, task.bounds);
        if self.input.rigid {
            // The data are constant, or the bounds leave no room.
            let level = f[0];
            f.fill(level);
        }
        let mut sizes: Vec<f64> = f.windows(2).map(|f| f[1] - f[0]).collect();
        let mut held: Vec<bool> = sizes.iter().map(|d| *d == 0.0).collect();
        sizes.resize(layout.len(), 0.0);
        held.resize(layout.len(), false);
        held[layout.low()] = f[0] <= task.bounds[0];
        held[layout.high()] = f[layout.n] >= task.bounds[1];
        let residual = task.residual(&f);
        Optimum { first: f[0], sizes, held, residual, steps: 0, converged: true }
    }

    /// The trace of the derivative of the values in the data: degrees of freedom of what no constraint holds.
    pub(super) fn freedom(&mut self, lambda: f64, optimum: &Optimum) -> f64 {
        let task = &self.input.task;
        let layout = task.layout();
        let held = &optimum.held;
        if self.is_isotonic(lambda) || held[..layout.n].iter().all(|held| *held) {
            // One for every block, but for those at the bounds.
            let rises = held[..layout.n].iter().filter(|held| !**held).count() as f64;
            let at = |k: usize| f64::from(u8::from(held[k]));
            return (rises + 1.0 - at(layout.low()) - at(layout.high())).max(0.0);
        }
        let lambda = self.clamped(lambda);
        let model = |i: usize| {
            if held[i] { Model::HELD } else { task.model(lambda, i, &optimum.sizes) }
        };
        let models: Vec<Model> = (0..layout.n).map(model).collect();
        let mut stiff: Vec<f64> = held.iter().map(|held| if *held { HELD } else { 0.0 }).collect();
        for k in [layout.low(), layout.high()] {
            // Bounds at both ends meet in the middle, where larger numbers would hide the rest.
            stiff[k] = stiff[k].min(HELD_VALUE);
        }
        self.trace(&models, &stiff)
    }

    /// The trace of the derivative of the values in the data.
    fn trace(&mut self, models: &[Model], stiff: &[f64]) -> f64 {
        let (h, twice) = (&self.input.task.h, self.input.task.twice());
        self.system.factor(h, models, &twice, stiff);
        let variances = self.system.variances(h, models);
        variances.iter().zip(&twice).map(|(v, w)| v * w).sum()
    }

    /// The scaled penalty of a decimal logarithm.
    fn penalty(&self, k: f64) -> f64 {
        self.unit * 10f64.powf(k)
    }

    /// The generalised cross-validation score, `(Σ w(y − f)²/n)/(1 − freedom/n)²`, and the freedom: of the interior
    /// point's answer, whose stiffness is that of the constraints, nearly. It need not be as near as an answer.
    fn score(&mut self, k: f64) -> Result<[f64; 2], MonotoneError> {
        let task = &self.input.task;
        let lambda = self.clamped(self.penalty(k));
        let state = match unconstrained(task, lambda, &mut self.system) {
            Some(state) => state,
            None => minimise(task, lambda, None, SCORE_GAP, &mut self.system, self.go_on)?,
        };
        let (mut f, n) = (Vec::new(), task.h.len());
        task.values(state.first, &state.sizes, &mut f);
        let models: Vec<Model> = (0..n).map(|i| task.model(lambda, i, &state.sizes)).collect();
        let sizes = state.sizes.iter().zip(&state.multipliers);
        let stiff: Vec<f64> = sizes.map(|(v, z)| if *z > 0.0 { z / v } else { 0.0 }).collect();
        let freedom = self.trace(&models, &stiff);
        let left = 1.0 - freedom / self.input.count as f64;
        Ok([
            if left > 1e-9 { self.scored(task.residual(&f), left) } else { f64::INFINITY },
            freedom,
        ])
    }

    /// The score of a residual with a share of the freedom left.
    fn scored(&self, residual: f64, left: f64) -> f64 {
        (residual + self.input.within) / self.input.count as f64 / (left * left)
    }

    /// The scaled penalty of the least score: the best power of ten, then a golden-section search around it.
    pub(super) fn cross_validated(&mut self) -> Result<f64, MonotoneError> {
        if self.input.rigid {
            return Ok(0.0);
        }
        let least = -4.0 * (self.input.x.len() as f64).log10() - 4.0;
        // Smaller penalties leave no less than that of the isotonic regression, and no less freedom.
        let least_residual = self.isotonic().residual;
        let mut best = (f64::INFINITY, f64::from(STRAIGHT));
        let mut k = f64::from(STRAIGHT);
        while k >= least {
            let [score, freedom] = self.score(k)?;
            if score < best.0 {
                best = (score, k);
            }
            let left = 1.0 - freedom / self.input.count as f64;
            if score == f64::INFINITY || self.scored(least_residual, left) > best.0 {
                break;
            }
            k -= 1.0;
        }
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut from, mut to) = (best.1 - 1.0, best.1 + 1.0);
        let inside = |from: f64, to: f64| [to - golden * (to - from), from + golden * (to - from)];
        let [mut a, mut b] = inside(from, to);
        let (mut at_a, mut at_b) = (self.score(a)?[0], self.score(b)?[0]);
        while to - from > NARROW {
            if at_a <= at_b {
                (to, b, at_b) = (b, a, at_a);
                a = inside(from, to)[0];
                at_a = self.score(a)?[0];
            } else {
                (from, a, at_a) = (a, b, at_b);
                b = inside(from, to)[1];
                at_b = self.score(b)?[0];
            }
        }
        let found = if at_a <= at_b { (at_a, a) } else { (at_b, b) };
        // Where the score jumps (a constraint that becomes active) the search may end beside the better one.
        let best = if found.0 <= best.0 { found } else { best };
        Ok(self.penalty(best.1))
    }

    /// The scaled penalty whose optimum leaves this scaled residual, +∞ if a straight line leaves no more.
    pub(super) fn of_residual(&mut self, residual: f64, given: f64) -> Result<f64, MonotoneError> {
        let bent = !self.input.task.bend.is_empty();
        let least = if bent { self.at(0.0)? } else { self.isotonic() }.residual + self.input.within;
        if residual < least * (1.0 - 1e-12) {
            let least = self.input.residual_out(least);
            let of = if bent { "the nearest such function" } else { "the isotonic regression" };
            return Err(MonotoneError::Residual { of, value: given, least });
        }
        if self.input.rigid || residual <= least * (1.0 + 1e-12) {
            return Ok(0.0);
        }
        if self.at(LINE)?.residual + self.input.within <= residual {
            return Ok(f64::INFINITY);
        }
        let mut excess = |k: f64| -> Result<f64, MonotoneError> {
            let found = self.at(self.penalty(k))?.residual;
            // Logarithms: the residual is a power of the penalty over long stretches.
            Ok(((found + self.input.within) / residual).ln())
        };
        let (mut from, mut to) = (-4.0, -4.0);
        let start = excess(from)?;
        let (mut low, mut high) = (start, start);
        while low > 0.0 && from > -40.0 {
            (to, high) = (from, low);
            from -= 2.0;
            low = excess(from)?;
        }
        while high < 0.0 && to < LINE.log10() {
            (from, low) = (to, high);
            to += 2.0;
            high = excess(to)?;
        }
        let found = root(&mut excess, [from, to], [low, high])?;
        Ok(self.penalty(found))
    }
}

/// The root of an increasing function between two places by inverse interpolation, halving where that is slow
/// (the Anderson–Björck form of the regula falsi).
fn root(
    excess: &mut impl FnMut(f64) -> Result<f64, MonotoneError>,
    [mut from, mut to]: [f64; 2],
    [mut low, mut high]: [f64; 2],
) -> Result<f64, MonotoneError> {
    if low >= 0.0 {
        return Ok(from);
    }
    for _ in 0..EVALUATIONS {
        let k = to - high * (to - from) / (high - low);
        let value = excess(k)?;
        if value.abs() <= NEAR || (to - from).abs() < 1e-13 {
            return Ok(k);
        }
        let scale = |other: f64| {
            let share = 1.0 - value / other;
            if share > 0.0 { share } else { 0.5 }
        };
        if value > 0.0 {
            low *= scale(high);
            (to, high) = (k, value);
        } else {
            high *= scale(low);
            (from, low) = (k, value);
        }
    }
    Ok(to - high * (to - from) / (high - low))
}
