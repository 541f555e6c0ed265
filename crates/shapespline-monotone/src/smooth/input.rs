// SPDX-License-Identifier: MIT OR Apache-2.0

//! Checks of the data to be smoothed; near-equal abscissae merged, everything scaled by powers of two.

use super::interior::Task;
use super::{PenaltyChoice, SmoothOptions};
use crate::MonotoneError;
use crate::data::{PowerOfTwo, check_finite, exponent, out_of_range};

/// Abscissae within this part of their range are one: the function changes by less than rounding between them, and
/// quotients of smaller differences have no digits. 2⁻³⁰.
const NEAR: f64 = 9.313_225_746_154_785e-10;
/// Bounds closer than this part of the range of y leave only a constant.
const NARROW: f64 = 1e-12;

/// What is smoothed, and how it is scaled.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) task: Task,
    /// The abscissae after merging.
    pub(super) x: Vec<f64>,
    /// Values are measured from here.
    base: f64,
    /// 1, or −1 where a decreasing function is sought.
    pub(super) sign: f64,
    /// Exponents of the units of x, y and the weights.
    pub(super) ex: i32,
    pub(super) ey: i32,
    ew: i32,
    /// What merged data add to the residual whatever the function is, scaled.
    pub(super) within: f64,
    /// Data before merging.
    pub(super) count: usize,
    /// Whether only the isotonic regression can be meant: constant data, bounds that leave no room.
    pub(super) rigid: bool,
    bounds: [f64; 2],
}

impl Input {
    pub(super) fn new(
        x: &[f64],
        y: &[f64],
        options: &SmoothOptions,
    ) -> Result<Self, MonotoneError> {
        let range = check_data(x, y)?;
        check_options(x.len(), options)?;
        let n = x.len() - 1;
        let (ex, base) = (exponent(range), y[0]);
        let spread = y.iter().fold(0.0f64, |spread, v| spread.max((v - base).abs()));
        let ey = if spread > 0.0 { exponent(spread) } else { 0 };
        let ones;
        let weights = if let Some(weights) = &options.weights {
            weights
        } else {
            ones = vec![1.0; n + 1];
            &ones
        };
        let (scaled, ew) = scaled_weights(weights);
        let to_y = PowerOfTwo::new(-ey);
        let mut own = Self {
            task: Task { h: vec![], y: vec![], w: vec![], bounds: [0.0; 2], bend: vec![] },
            x: Vec::new(),
            base,
            sign: 1.0,
            ex,
            ey,
            ew,
            within: 0.0,
            count: n + 1,
            rigid: spread == 0.0,
            bounds: options.bounds.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
        };
        let mut from = 0;
        while from <= n {
            let near = |k: &usize| x[*k] - x[from] <= NEAR * range;
            let to = (from + 1..=n).take_while(near).last().unwrap_or(from) + 1;
            if from > 0 {
                own.task.bend.extend(options.convex.as_ref().map(|signs| signs[from - 1]));
            }
            let cluster = Cluster::new(&x[from..to], &y[from..to], &scaled[from..to], base, to_y);
            own.push(&cluster);
            from = to;
        }
        if own.x.len() < 2 {
            return Err(MonotoneError::Distinct { found: own.x.len() });
        }
        let to_x = PowerOfTwo::new(-ex);
        own.task.h = own.x.windows(2).map(|x| to_x.scale(x[1] - x[0])).collect();
        if own.task.bend.iter().all(|bend| *bend == 0) {
            own.task.bend.clear();
        }
        own.direct(options.increasing, to_y);
        Ok(own)
    }

    fn push(&mut self, cluster: &Cluster) {
        self.x.push(cluster.x);
        self.task.y.push(cluster.y);
        self.task.w.push(cluster.w);
        self.within += cluster.within;
    }

    /// Reflect where a decreasing function is sought.
    fn direct(&mut self, increasing: Option<bool>, to_y: PowerOfTwo) {
        let bounds = self.bounds.map(|b| to_y.scale(b - self.base));
        self.task.bounds = bounds;
        if !increasing.unwrap_or_else(|| self.task.line()[1] >= 0.0) {
            self.sign = -1.0;
            self.task.y.iter_mut().for_each(|y| *y = -*y);
            self.task.bounds = [-bounds[1], -bounds[0]];
            self.task.bend.iter_mut().for_each(|bend| *bend = -*bend);
        }
        let [low, high] = self.task.bounds;
        self.rigid |= high - low <= NARROW * low.abs().min(high.abs()).clamp(1.0, f64::MAX);
    }

    /// A penalty in scaled units.
    pub(super) fn penalty_in(&self, penalty: f64) -> f64 {
        PowerOfTwo::new(-(self.ew + 3 * self.ex)).scale(penalty)
    }

    pub(super) fn penalty_out(&self, penalty: f64) -> f64 {
        PowerOfTwo::new(self.ew + 3 * self.ex).scale(penalty)
    }

    pub(super) fn residual_in(&self, residual: f64) -> f64 {
        PowerOfTwo::new(-(self.ew + 2 * self.ey)).scale(residual)
    }

    pub(super) fn residual_out(&self, residual: f64) -> f64 {
        PowerOfTwo::new(self.ew + 2 * self.ey).scale(residual)
    }

    /// Scaled values in the data's units, between the bounds, and on them exactly where they are on the scaled ones.
    pub(super) fn values_out(&self, f: &[f64]) -> Vec<f64> {
        let unit = PowerOfTwo::new(self.ey);
        let ([lowest, highest], [low, high]) = (self.task.bounds, self.bounds);
        let [first, last] = if self.sign > 0.0 { [low, high] } else { [high, low] };
        let value = |f: &f64| {
            if *f <= lowest {
                first
            } else if *f >= highest {
                last
            } else {
                (self.base + self.sign * unit.scale(*f)).max(low).min(high)
            }
        };
        f.iter().map(value).collect()
    }
}

/// Data at one abscissa.
struct Cluster {
    x: f64,
    y: f64,
    w: f64,
    within: f64,
}

impl Cluster {
    fn new(x: &[f64], y: &[f64], w: &[f64], base: f64, to_y: PowerOfTwo) -> Self {
        let total: f64 = w.iter().sum();
        let mean = |values: &mut dyn Iterator<Item = f64>| {
            values.zip(w).map(|(v, w)| v * (w / total)).sum::<f64>()
        };
        if let ([x], [y]) = (x, y) {
            return Self { x: *x, y: to_y.scale(y - base), w: total, within: 0.0 };
        }
        let scaled: Vec<f64> = y.iter().map(|y| to_y.scale(y - base)).collect();
        let middle = mean(&mut scaled.iter().copied());
        let within = scaled.iter().zip(w).map(|(y, w)| w * (y - middle) * (y - middle)).sum();
        let off = mean(&mut x.iter().map(|v| v - x[0]));
        Self { x: x[0] + off, y: middle, w: total, within }
    }
}

/// Weights whose sum is about 1, and the exponent of their unit.
fn scaled_weights(weights: &[f64]) -> (Vec<f64>, i32) {
    let largest = exponent(weights.iter().fold(0.0f64, |a, b| a.max(*b)));
    let unit = PowerOfTwo::new(-largest);
    let total = exponent(weights.iter().map(|w| unit.scale(*w)).sum());
    let unit = PowerOfTwo::new(-largest - total);
    (weights.iter().map(|w| unit.scale(*w)).collect(), largest + total)
}

/// Finite data, x not decreasing; the range of x.
fn check_data(x: &[f64], y: &[f64]) -> Result<f64, MonotoneError> {
    if y.len() != x.len() {
        return Err(MonotoneError::Length { argument: "y", found: y.len(), expected: x.len() });
    }
    check_finite("x", x)?;
    check_finite("y", y)?;
    if let Some(i) = x.windows(2).position(|x| x[1] < x[0]) {
        let rule = "must not be below its predecessor";
        return Err(MonotoneError::Entry { argument: "x", index: i + 1, value: x[i + 1], rule });
    }
    let n = x.len();
    if n < 2 || x[0] == x[n - 1] {
        return Err(MonotoneError::Distinct { found: n.min(1) });
    }
    let range = x[n - 1] - x[0];
    if !range.is_finite() {
        return Err(out_of_range("spread", "x", n - 1, x[n - 1]));
    }
    // Room for differences of all kinds.
    let fits = |v: &f64| (v / 4.0 - y[0] / 4.0).abs() < f64::MAX / 1024.0;
    match y.iter().position(|v| !fits(v)) {
        Some(i) => Err(out_of_range("spread", "y", i, y[i])),
        None => Ok(range),
    }
}

fn check_options(count: usize, options: &SmoothOptions) -> Result<(), MonotoneError> {
    if let Some(weights) = &options.weights {
        if weights.len() != count {
            let (found, expected) = (weights.len(), count);
            return Err(MonotoneError::Length { argument: "weights", found, expected });
        }
        if let Some(index) = weights.iter().position(|w| !(*w > 0.0 && w.is_finite())) {
            let rule = "must be positive and finite";
            let value = weights[index];
            return Err(MonotoneError::Entry { argument: "weights", index, value, rule });
        }
    }
    if let Some(signs) = &options.convex {
        if signs.len() + 1 != count {
            let (found, expected) = (signs.len(), count - 1);
            return Err(MonotoneError::Length { argument: "convex", found, expected });
        }
        if let Some(index) = signs.iter().position(|sign| !(-1..=1).contains(sign)) {
            let rule = "but every sign must be -1, 0 or 1";
            return Err(MonotoneError::Convex { index, value: signs[index], rule });
        }
        if signs.iter().any(|sign| *sign != 0) && options.penalty == PenaltyChoice::Fixed(0.0) {
            let rule =
                "must be positive with convex (without a penalty the function would have kinks)";
            return Err(MonotoneError::Number { argument: "penalty", value: 0.0, rule });
        }
    }
    let rule = "must be finite and not negative";
    let number = |argument, value: f64| {
        let fits = value >= 0.0 && value.is_finite();
        if fits { Ok(()) } else { Err(MonotoneError::Number { argument, value, rule }) }
    };
    match options.penalty {
        PenaltyChoice::CrossValidated => {}
        PenaltyChoice::Fixed(value) => number("penalty", value)?,
        PenaltyChoice::FromResidual(value) => number("residual", value)?,
    }
    if let Some([low, high]) = options.bounds
        && !(low < high)
    {
        let (argument, rule) = ("bounds", "must exceed the lower bound");
        let (index, value) = if low.is_nan() { (0, low) } else { (1, high) };
        return Err(MonotoneError::Entry { argument, index, value, rule });
    }
    Ok(())
}
