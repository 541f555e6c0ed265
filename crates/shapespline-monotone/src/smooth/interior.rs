// SPDX-License-Identifier: MIT OR Apache-2.0

//! The smoothing program by a primal–dual interior point, and the unconstrained smoothing spline.
//!
//! Unknowns are the first value, the rises and the slopes; rises, slopes and the distances from the bounds are kept
//! positive, each with a multiplier. Mehrotra's predictor and corrector on [`System`]; the energy is not quadratic where
//! intervals have level parts, and Newton's model of it is good enough: 10 to 25 steps for a gap of 1e−9 in all trials.

use super::interval::{Model, is_cubic};
use super::system::{Layout, System};
use crate::MonotoneError;
use crate::interrupt::{GoOn, check_interrupt};

/// Distance from a bound that is not there.
pub(super) const FAR: f64 = 1e300;
/// Share of the way to the boundary that a step takes.
const FRACTION: f64 = 0.99;
const STEPS: usize = 100;
/// The least slope of the line that the iteration starts from, in scaled units.
const LEAST_START: f64 = 0.1;

/// The data in scaled units: ranges of x and y and the sum of the weights are about 1; increasing functions are sought.
#[derive(Debug, Clone)]
pub(super) struct Task {
    pub(super) h: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) w: Vec<f64>,
    pub(super) bounds: [f64; 2],
    /// 1 for intervals on which the function is to be convex, −1 for concave, 0 for others; empty: 0.
    pub(super) bend: Vec<i8>,
}

/// A monotone function at the nodes, with multipliers.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) first: f64,
    /// Rises, slopes, distances from the bounds, arms ([`Layout`]).
    pub(super) sizes: Vec<f64>,
    /// Those of sizes that need no constraint are 0.
    pub(super) multipliers: Vec<f64>,
    /// `Σ` of their products, relative to the objective: a bound of what is above the optimum, nearly.
    pub(super) gap: f64,
    pub(super) steps: usize,
}

impl Task {
    pub(super) fn layout(&self) -> Layout {
        Layout { n: self.h.len(), bent: !self.bend.is_empty() }
    }

    /// Values from the first one and the rises.
    pub(super) fn values(&self, first: f64, rises: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.push(first);
        let mut f = first;
        for d in &rises[..self.h.len()] {
            f += d;
            out.push(f);
        }
    }

    /// `Σ w(y − f)²`.
    pub(super) fn residual(&self, f: &[f64]) -> f64 {
        self.y.iter().zip(f).zip(&self.w).map(|((y, f), w)| w * (y - f) * (y - f)).sum()
    }

    /// Its gradient in the values.
    pub(super) fn pull(&self, f: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend(self.y.iter().zip(f).zip(&self.w).map(|((y, f), w)| 2.0 * w * (f - y)));
    }

    pub(super) fn twice(&self) -> Vec<f64> {
        self.w.iter().map(|w| 2.0 * w).collect()
    }

    /// Intercept at the first node and slope of the weighted regression line.
    pub(super) fn line(&self) -> [f64; 2] {
        let (mut x, mut sums) = (0.0, [0.0; 3]);
        for i in 0..self.y.len() {
            for (sum, v) in sums.iter_mut().zip([1.0, x, self.y[i]]) {
                *sum += self.w[i] * v;
            }
            x += self.h.get(i).copied().unwrap_or(0.0);
        }
        let (mx, my) = (sums[1] / sums[0], sums[2] / sums[0]);
        let (mut x, mut xx, mut xy) = (0.0, 0.0, 0.0);
        for i in 0..self.y.len() {
            xx += self.w[i] * (x - mx) * (x - mx);
            xy += self.w[i] * (x - mx) * (self.y[i] - my);
            x += self.h.get(i).copied().unwrap_or(0.0);
        }
        let slope = xy / xx;
        [my - slope * mx, slope]
    }

    /// An increasing line inside the bounds near the regression line.
    fn start(&self) -> [f64; 2] {
        let [at, slope] = self.line();
        let width: f64 = self.h.iter().sum();
        let steep = slope.max(LEAST_START);
        let middle = at + 0.5 * slope * width;
        let [low, high] = self.bounds;
        let (mut from, mut to) = (middle - 0.5 * steep * width, middle + 0.5 * steep * width);
        // A share of the room between bounds, or of the line's rise beside one alone.
        let margin = 0.05 * (high - low).min(to - from);
        from = from.max(low + margin);
        to = to.min(high - margin);
        if !(from + margin < to) {
            let rise = margin.min(0.1 * (high - low));
            if from > to {
                from = to - rise
            } else {
                to = from + rise
            }
            if from <= low {
                (from, to) = (low + rise, low + 2.0 * rise);
            }
            if to >= high {
                (from, to) = (high - 2.0 * rise, high - rise);
            }
        }
        [from, (to - from) / width]
    }

    /// A line as a state, with multipliers that centre it.
    fn state(&self, [first, slope]: [f64; 2], mu: impl Fn(f64) -> f64) -> State {
        let layout = self.layout();
        let mut sizes: Vec<f64> = self.h.iter().map(|h| slope * h).collect();
        sizes.resize(2 * layout.n + 1, slope);
        let last = first + sizes[..layout.n].iter().sum::<f64>();
        let [low, high] = self.bounds;
        let room = |v: f64| if v.is_finite() { v } else { FAR };
        sizes.extend([room(first - low), room(high - last)]);
        if layout.bent {
            self.bend_line(slope, &mut sizes);
        }
        let mut f = Vec::new();
        self.values(first, &sizes, &mut f);
        let mu = mu(self.residual(&f));
        let multiplier = |k: usize| if self.is_free(k, sizes[k]) { 0.0 } else { mu / sizes[k] };
        let multipliers = (0..sizes.len()).map(multiplier).collect();
        State { first, sizes, multipliers, gap: f64::INFINITY, steps: 0 }
    }
}

/// Whether the smoothing spline without constraints is monotone and between the bounds: then it is the answer.
pub(super) fn unconstrained(task: &Task, lambda: f64, system: &mut System) -> Option<State> {
    let layout = task.layout();
    let n = layout.n;
    let mut state = task.state(task.line(), |_| 0.0);
    let (twice, none) = (task.twice(), vec![0.0; layout.len()]);
    let (mut f, mut pull, mut step) = (Vec::new(), Vec::new(), vec![0.0; layout.len()]);
    // A quadratic program: the first solve is the answer, the others only take off rounding errors.
    for round in 0..3 {
        let cubic = |i| Model::cubic(lambda, state.slopes(layout, i), state.sizes[i], task.h[i]);
        let models: Vec<Model> = (0..n).map(cubic).collect();
        if round == 0 {
            system.factor(&task.h, &models, &twice, &none);
        }
        task.values(state.first, &state.sizes, &mut f);
        task.pull(&f, &mut pull);
        system.solve(&task.h, &models, &pull, &none, &mut step);
        state.first += step[layout.low()];
        for (v, by) in state.sizes.iter_mut().zip(&step) {
            *v += by;
        }
        // The first tells enough where it is not monotone by far.
        if (0..n).any(|i| state.sizes[i] < -1e-9) {
            return None;
        }
    }
    state.steps = 1;
    state.gap = 0.0;
    let last = state.first + state.sizes[..n].iter().sum::<f64>();
    let inside = task.bounds[0] <= state.first && last <= task.bounds[1];
    let monotone = |i: usize| {
        let m = state.slopes(layout, i);
        m[0] >= 0.0 && m[1] >= 0.0 && is_cubic(m, state.sizes[i], task.h[i])
    };
    let idle = inside && (0..n).all(monotone) && task.is_bent(&mut state.sizes);
    idle.then_some(state)
}

impl State {
    fn slopes(&self, layout: Layout, i: usize) -> [f64; 2] {
        [self.sizes[layout.m(i)], self.sizes[layout.m(i + 1)]]
    }
}

/// The monotone function of least `Σ w(y − f)² + λE`, to a relative gap; from `start`, else from a line.
pub(super) fn minimise(
    task: &Task,
    lambda: f64,
    start: Option<State>,
    tolerance: f64,
    system: &mut System,
    go_on: GoOn<'_>,
) -> Result<State, MonotoneError> {
    let layout = task.layout();
    let n = layout.n;
    let centred = |residual: f64| (residual + 1e-3) / n as f64;
    let mut state = start.unwrap_or_else(|| task.state(task.start(), centred));
    let count = state.multipliers.iter().filter(|z| **z > 0.0).count() as f64;
    let twice = task.twice();
    let (mut models, mut f, mut pull) = (Vec::new(), Vec::new(), Vec::new());
    let mut stiff = vec![0.0; layout.len()];
    let nothing = vec![0.0; layout.len()];
    let (mut sizes, mut targets) = (nothing.clone(), nothing.clone());
    let (mut predicted, mut step) = (nothing.clone(), nothing.clone());
    loop {
        check_interrupt(go_on)?;
        models.clear();
        models.extend((0..n).map(|i| task.model(lambda, i, &state.sizes)));
        task.values(state.first, &state.sizes, &mut f);
        let energy: f64 = models.iter().map(|model: &Model| model.energy).sum();
        let product = dot(&state.sizes, &state.multipliers);
        state.gap = product / (task.residual(&f) + energy).max(f64::MIN_POSITIVE);
        if state.gap <= tolerance || state.steps >= STEPS || !state.gap.is_finite() {
            return Ok(state);
        }
        task.pull(&f, &mut pull);
        for ((s, v), z) in stiff.iter_mut().zip(&state.sizes).zip(&state.multipliers) {
            *s = z / v;
        }
        system.factor(&task.h, &models, &twice, &stiff);
        system.solve(&task.h, &models, &pull, &nothing, &mut predicted);
        let products = (&state.sizes[..], &state.multipliers[..]);
        let part = reach(products, &stiff, &predicted, &nothing).min(1.0);
        let mu = product / count;
        let ahead = ahead(products, &stiff, &predicted, part) / count;
        let centre = (ahead / mu).powi(3).max(1e-4) * mu;
        for k in 0..layout.len() {
            // The wanted product over the size, less what the predicted step would add to it: the gradient's other sign.
            let (v, z, by) = (state.sizes[k], state.multipliers[k], predicted[k]);
            let wanted = (centre + part * part * by * (z + stiff[k] * by)) / v;
            targets[k] = if z == 0.0 { 0.0 } else { wanted };
            sizes[k] = -targets[k];
        }
        system.solve(&task.h, &models, &pull, &sizes, &mut step);
        let products = (&state.sizes[..], &state.multipliers[..]);
        let part = (FRACTION * reach(products, &stiff, &step, &targets)).min(1.0);
        let part = part.min(task.reach_of_ratios(&state.sizes, &step));
        state.advance(&stiff, (step[layout.low()], &step), part, &targets);
        state.steps += 1;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// How far a step can go before a size or a multiplier is 0; at most 1 over [`FRACTION`]. The step of a multiplier is
/// `target − z − z/v·step`, with a target that is the wanted product over the size.
fn reach(
    (sizes, multipliers): (&[f64], &[f64]),
    stiff: &[f64],
    step: &[f64],
    targets: &[f64],
) -> f64 {
    let mut most = FRACTION;
    for k in 0..step.len() {
        let (v, z) = (sizes[k], multipliers[k]);
        // Shares that one whole step takes away of the size and of the multiplier; quotients only of the few that count.
        let [by, down] = [-step[k], z + stiff[k] * step[k] - targets[k]];
        if by > most * v {
            most = by / v;
        }
        if down > most * z {
            most = down / z;
        }
    }
    1.0 / most
}

/// The sum of products after a part of the predicted step, that of target 0.
fn ahead((sizes, multipliers): (&[f64], &[f64]), stiff: &[f64], step: &[f64], part: f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..step.len() {
        let (v, z, by) = (sizes[k], multipliers[k], step[k]);
        let product = (v + part * by) * (z - part * (z + stiff[k] * by));
        sum += if z == 0.0 { 0.0 } else { product };
    }
    sum
}

impl State {
    fn advance(&mut self, stiff: &[f64], (first, step): (f64, &[f64]), part: f64, targets: &[f64]) {
        self.first += part * first;
        for k in 0..step.len() {
            let (v, z) = (self.sizes[k], self.multipliers[k]);
            if v != FAR {
                self.sizes[k] = v + part * step[k];
            }
            if z > 0.0 {
                self.multipliers[k] = z + part * (targets[k] - z - stiff[k] * step[k]);
            }
        }
    }
}
