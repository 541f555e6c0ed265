// SPDX-License-Identifier: MIT OR Apache-2.0

//! The cubic pieces of a least-energy interpolant: knots, values, slopes and second derivatives.

use super::layer::between;
use super::piece::Level;
use super::problem::{Layers, Problem, Slopes};
use super::profile::{Profile, Profiles};
use crate::data::{Units, joined, parts};

/// Ulps of the places up to which a part is short; relative second derivatives that are nothing.
const SHORT: f64 = 4.0;
const NOTHING: f64 = 1e-13;

/// Pieces over the knots, as [`crate::MonotoneSpline`] takes them: slopes and second derivatives are signed and scaled.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) slope: Vec<f64>,
    /// At both ends of every piece.
    pub(crate) second: Vec<[f64; 2]>,
    /// The knots of the points.
    pub(crate) nodes: Vec<usize>,
    /// Intervals with a level part.
    pub(crate) level: Vec<usize>,
}

/// What lies between two points, in the direction of the data: inner knots and what holds there.
#[derive(Debug, Clone, Copy, Default)]
struct Interval {
    knots: usize,
    /// Distances from the nearer end, scaled; of the first knot from the left, of the last from the right.
    width: [f64; 2],
    /// From the point before, as a part of the rise.
    rise: [f64; 2],
    slope: [f64; 2],
    second: [[f64; 2]; 3],
    /// Whether the first knot belongs to the right end.
    right: bool,
    /// Whether it is level for a while.
    level: bool,
}

impl Interval {
    /// Interval i of a problem with slopes m.
    fn new(problem: &Problem, i: usize, m: &[f64], layers: Option<&Layers>) -> Self {
        let (d, h) = (problem.d[i], problem.h[i]);
        if d == 0.0 {
            return Self::default();
        }
        if let Some(layers) = layers
            && let Some(layered) = Self::layered(problem, i, m, layers)
        {
            return layered;
        }
        let piece = problem.piece(i, m);
        let [z0, z1] = piece.ends();
        if !piece.level {
            return Self { second: [[z0, z1], [0.0; 2], [0.0; 2]], ..Self::default() };
        }
        let c = problem.floor.get(i).copied().unwrap_or(0.0);
        let own = d - c * h;
        let level = Level::new([m[i], m[i + 1]].map(|m| (m - c).max(0.0).sqrt()), own);
        let [u0, u1] = level.widths;
        let rise = |t: f64| (c * t + own * level.share) / d;
        Self {
            knots: 2,
            width: [u0, u1],
            rise: [rise(u0), rise(h - u1)],
            slope: [c; 2],
            second: [[z0, 0.0], [0.0; 2], [0.0, z1]],
            right: false,
            level: true,
        }
    }

    /// With layers beside ends of slope 0, where there are any and they are needed.
    fn layered(problem: &Problem, i: usize, m: &[f64], layers: &Layers) -> Option<Self> {
        let (d, h, theta) = (problem.d[i], problem.h[i], layers.share);
        let level = [problem.is_level(i), problem.is_level(i + 1)];
        let own = [layers.second[i], layers.second[i + 1]];
        // Of h²y'' at the node and the knot: rise and slope over the layer.
        let rise = |s: f64, p: f64| theta * theta * (2.0 * s + p) / (6.0 * d);
        let slope = |s: f64, p: f64| 0.5 * theta * (s + p) / h;
        let square = h * h;
        if level == [true, true] {
            let [p, q] = between(theta, own, d, h);
            let [s0, s1] = own.map(|s| s * square);
            let z = |a: f64, b: f64| [a / square, b / square];
            return Some(Self {
                knots: 2,
                width: [theta * h; 2],
                rise: [rise(s0, p), 1.0 - rise(s1, -q)],
                slope: [slope(s0, p), slope(s1, -q)],
                second: [z(s0, p), z(p, q), z(q, -s1)],
                ..Self::default()
            });
        }
        let right = level[1];
        if !(level[0] || right) {
            return None;
        }
        let layer = problem.layer(layers, i + usize::from(right))?;
        let far = m[i + usize::from(!right)];
        if layer.is_level(far, d, h) {
            return None;
        }
        let seconds = layer.seconds(far, d, h);
        let (s, p, q) = (layer.second, seconds.knot / square, seconds.far / square);
        let over = rise(s * square, seconds.knot);
        let mut interval = Self {
            knots: 1,
            width: [theta * h, 0.0],
            rise: [over, 0.0],
            slope: [slope(s * square, seconds.knot), 0.0],
            second: [[s, p], [p, q], [0.0; 2]],
            right,
            level: false,
        };
        if right {
            interval.rise[0] = 1.0 - over;
            interval.second = [[-q, -p], [-p, -s], [0.0; 2]];
        }
        Some(interval)
    }

    /// The bending energy `∫ y''² dx` between widths that the knots cut, scaled.
    fn energy(&self, h: f64) -> f64 {
        let over = |h: f64, [a, b]: [f64; 2]| h / 3.0 * (a * a + a * b + b * b);
        let [u0, u1] = self.width;
        match (self.knots, self.right) {
            (0, _) => over(h, self.second[0]),
            (1, false) => over(u0, self.second[0]) + over(h - u0, self.second[1]),
            (1, true) => over(h - u0, self.second[0]) + over(u0, self.second[1]),
            _ => {
                let middle = over((h - u0 - u1).max(0.0), self.second[1]);
                over(u0, self.second[0]) + middle + over(u1, self.second[2])
            }
        }
    }
}

impl Pieces {
    /// Those of a problem's intervals between the points given, and their bending energy in scaled units.
    pub(crate) fn new(
        problem: &Problem,
        units: Units,
        [x, y]: [&[f64]; 2],
        m: &[f64],
        layers: Option<&Layers>,
        first: usize,
    ) -> (Self, f64) {
        Self::of(
            [x, y],
            |own, i| {
                let k = first + i;
                let interval = Interval::new(problem, k, m, layers);
                own.push(&interval, units, problem.sign[k], [x[i], x[i + 1]], [y[i], y[i + 1]]);
                (interval.energy(problem.h[k]), interval.level)
            },
            |i| signed_slope(problem, first + i, m),
        )
    }

    /// The same of intervals of which convexity is asked.
    pub(crate) fn bent(
        problem: &Problem,
        units: Units,
        [x, y]: [&[f64]; 2],
        found: &Slopes,
        profiles: &Profiles,
        first: usize,
    ) -> (Self, f64) {
        Self::of(
            [x, y],
            |own, i| {
                let k = first + i;
                let profile = profiles.of(problem, k, found);
                own.push_bent(&profile, units, problem.sign[k], [x[i], x[i + 1]], [y[i], y[i + 1]]);
                (profile.energy, profile.level)
            },
            |i| signed_slope(problem, first + i, &found.m),
        )
    }

    /// Interval by interval: `push` appends one and says its energy and whether it is level somewhere.
    fn of(
        [x, y]: [&[f64]; 2],
        push: impl Fn(&mut Self, usize) -> (f64, bool) + Sync,
        slope: impl Fn(usize) -> f64 + Sync,
    ) -> (Self, f64) {
        let n = x.len() - 1;
        let made = parts(n, |part| {
            let mut own = Self::with_capacity(part.len());
            let mut energy = 0.0;
            for i in part {
                let (part, level) = push(&mut own, i);
                energy += part;
                if level {
                    own.level.push(i);
                }
                let at = own.nodes[own.nodes.len() - 1];
                own.slope[at] = slope(i);
            }
            (own, energy)
        });
        let (mut all, energy) = Self::joined(made);
        let last = all.second.len();
        all.nodes.push(last);
        for (list, value) in [(&mut all.x, x[n]), (&mut all.y, y[n]), (&mut all.slope, slope(n))] {
            list.resize(last + 1, 0.0);
            list[last] = value;
        }
        (all, energy)
    }

    /// Room for some intervals, a knot or so in each, and the point after them.
    fn with_capacity(intervals: usize) -> Self {
        let knots = 2 * intervals + 1;
        Self {
            x: Vec::with_capacity(knots),
            y: Vec::with_capacity(knots),
            slope: Vec::with_capacity(knots),
            second: Vec::with_capacity(knots),
            nodes: Vec::with_capacity(intervals + 1),
            level: Vec::new(),
        }
    }

    /// Parts one after another, and the sum of their energies.
    fn joined(parts: Vec<(Self, f64)>) -> (Self, f64) {
        if parts.len() == 1 {
            return parts.into_iter().next().unwrap_or_default();
        }
        // Room for the last point.
        let list = |of: fn(&Self) -> &[f64]| {
            joined(&parts.iter().map(|(part, _)| of(part)).collect::<Vec<_>>(), 1)
        };
        let mut start = 0;
        let nodes = parts.iter().flat_map(|(part, _)| {
            let from = start;
            start += part.x.len();
            part.nodes.iter().map(move |k| from + k)
        });
        let all = Self {
            nodes: nodes.collect(),
            level: parts.iter().flat_map(|(part, _)| part.level.iter().copied()).collect(),
            x: list(|part| &part.x),
            y: list(|part| &part.y),
            slope: list(|part| &part.slope),
            second: joined(&parts.iter().map(|(part, _)| &part.second[..]).collect::<Vec<_>>(), 0),
        };
        (all, parts.iter().map(|(_, energy)| energy).sum())
    }

    /// A value between that of the last knot and that of the next point, which rounding can leave.
    fn onwards(&self, value: f64, end: f64) -> f64 {
        let last = self.y[self.y.len() - 1];
        value.clamp(last.min(end), last.max(end))
    }

    /// Where a knot at a distance from one of the ends x of an interval goes: a part shorter than an ulp becomes one of an
    /// ulp; where there is no room it is left out.
    fn place(&self, width: f64, from_right: bool, x: [f64; 2]) -> Option<f64> {
        let knot = if from_right { x[1] - width } else { x[0] + width };
        let before = self.x[self.x.len() - 1];
        // Beside 0 an ulp is that of the interval's width.
        let least = f64::EPSILON * (x[1] - x[0]);
        let knot = if knot <= before { before.next_up().max(before + least) } else { knot };
        let knot = if knot >= x[1] { x[1].next_down().min(x[1] - least) } else { knot };
        (knot > before).then_some(knot)
    }

    /// The point before an interval and the knots of its second derivative where that is to be convex or concave.
    fn push_bent(&mut self, profile: &Profile, units: Units, sign: f64, x: [f64; 2], y: [f64; 2]) {
        self.nodes.push(self.x.len());
        self.x.push(x[0]);
        self.y.push(y[0]);
        self.slope.push(0.0);
        let mut second = profile.ends[0];
        for knot in profile.knots() {
            let width = units.x().scale(knot.width);
            let Some(place) = self.place(width, knot.from_right, x) else { continue };
            let share = (y[1] - y[0]) * knot.rise.clamp(0.0, 1.0);
            self.second.push([sign * second, sign * knot.second]);
            self.x.push(place);
            let value = if knot.from_right { y[1] - share } else { y[0] + share };
            self.y.push(self.onwards(value, y[1]));
            self.slope.push(sign * knot.slope);
            second = knot.second;
        }
        self.second.push([sign * second, sign * profile.ends[1]]);
        if !profile.knots().is_empty() {
            self.straighten_short(units, sign, [x[1], y[1]]);
        }
    }

    /// The point before an interval and the inner knots.
    fn push(&mut self, interval: &Interval, units: Units, sign: f64, x: [f64; 2], y: [f64; 2]) {
        self.nodes.push(self.x.len());
        self.x.push(x[0]);
        self.y.push(y[0]);
        self.slope.push(0.0);
        let mut from = 0;
        for k in 0..interval.knots {
            if interval.width[k] == 0.0 {
                continue;
            }
            let width = units.x().scale(interval.width[k]);
            let from_right = if interval.knots == 1 { interval.right } else { k == 1 };
            let Some(knot) = self.place(width, from_right, x) else { continue };
            let rise = interval.rise[k].clamp(0.0, 1.0);
            // From the nearer value, so that small rises keep their digits.
            let value = if rise <= 0.5 {
                y[0] + (y[1] - y[0]) * rise
            } else {
                y[1] - (y[1] - y[0]) * (1.0 - rise)
            };
            self.second.push(interval.second[k].map(|z| sign * z));
            self.x.push(knot);
            self.y.push(self.onwards(value, y[1]));
            self.slope.push(sign * interval.slope[k]);
            from = k + 1;
        }
        self.second.push(interval.second[from].map(|z| sign * z));
        if interval.knots > 0 {
            self.straighten_short(units, sign, [x[1], y[1]]);
        }
    }

    /// On parts of the last interval, which ends at (x, y), that are some ulps long, rounding of the values can be larger
    /// than all that second derivatives make of them, and turn slopes the wrong way: such parts are straight, if those are
    /// nothing beside those of the other parts.
    fn straighten_short(&mut self, units: Units, sign: f64, end: [f64; 2]) {
        let start = self.nodes[self.nodes.len() - 1];
        let width = end[0] - self.x[start];
        let size = |z: &[f64; 2]| z[0].abs().max(z[1].abs());
        let largest = self.second[start..].iter().map(size).fold(0.0, f64::max);
        for k in start..self.second.len() {
            let (x0, y0) = (self.x[k], self.y[k]);
            let x1 = self.x.get(k + 1).copied().unwrap_or(end[0]);
            let y1 = self.y.get(k + 1).copied().unwrap_or(end[1]);
            let h = x1 - x0;
            let long = h > SHORT * f64::EPSILON * width.max(x0.abs()).max(x1.abs());
            if long || size(&self.second[k]) > NOTHING * largest {
                continue;
            }
            let [z0, z1] = self.second[k].map(|z| units.derivative_out(z, 2));
            let secant = (y1 - y0) / h;
            let slopes = [secant - h * (2.0 * z0 + z1) / 6.0, secant + h * (z0 + 2.0 * z1) / 6.0];
            if slopes.iter().any(|slope| sign * slope < 0.0) {
                self.second[k] = [0.0; 2];
            }
        }
    }
}

/// The slope at node i with its sign; 0 at turns and flats.
fn signed_slope(problem: &Problem, i: usize, m: &[f64]) -> f64 {
    let n = problem.sign.len();
    let sign = problem.sign[i.min(n - 1)];
    if m[i] == 0.0 { 0.0 } else { sign * m[i] }
}
