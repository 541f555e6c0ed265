// SPDX-License-Identifier: MIT OR Apache-2.0

//! The second derivative of an interval where convexity is asked, from its least energy to one that is continuous.
//!
//! **Least energy.** With the slopes at the points an interval has the `y''` of least energy: that of
//! [`super::piece`] where nothing is asked, the positive part of a line ([`super::ramp`]) where it is convex. At most points
//! `y''` is then the same from both sides, by the optimality of the slopes. It jumps at turns and beside flats, and where a
//! convex interval, whose `y''` is 0 there, meets one that would be concave at once although the data bend the other way.
//! As knots can be put as near to the point as one likes, no function does better than these jumps, and no C² function as
//! well.
//!
//! **Continuity.** Beside such a point `y''` is led to a common value: 0, at turns the smaller one. It changes by c on
//! three equal parts of length τ, linear on each, with `c = c₀, −5c₀/6, c₀/3, 0`: `∫ c = ∫ t c = 0`, so neither slopes
//! nor values beyond feel it, nothing has to be solved again, and as c is orthogonal to lines the energy grows by
//! `∫ c² = τ c₀²/2` exactly. With τ = θ/8 of the width w of the ramp (the interval, where it is one cubic) and |c₀| ≤ |z|
//! that is at most `θ w z²/16`; the energy of a ramp is `w z²/3`, that of a cubic at least `w (z₀² + z₁²)/6`. So the whole
//! is at most `1 + 3θ/8` times the least energy.
//!
//! Convex intervals stay convex: c₀ takes y'' from z to between 0 and z, and the ramp is at least 8τ long, so `y'' + c`
//! is at least `(1 − 1/4 − 1/3) z > 0` at the knots. Elsewhere the slope falls by no more than `0.28 τ|c₀|` and, with
//! `τ ≤ m/(8|z|)`, stays positive.

use super::piece::{Level, Piece};
use super::problem::{Problem, Slopes};
use super::ramp::Ramp;

/// Parts of a layer to the three equal ones of a change; the rest is left as it is.
const PARTS: f64 = 8.0;
/// `c/c₀` at the knots of a change, and its integrals to there: once, over τ, and twice, over τ².
const CHANGE: [f64; 3] = [-5.0 / 6.0, 1.0 / 3.0, 0.0];
const ONCE: [f64; 3] = [1.0 / 12.0, -1.0 / 6.0, 0.0];
const TWICE: [f64; 3] = [7.0 / 36.0, 1.0 / 18.0, 0.0];
/// Jumps relative to the second derivatives, or in ulps of the slopes over the width, that are rounding.
const SAME: f64 = 1e-9;
const ULPS: f64 = 32.0;

/// A knot between two points.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Knot {
    /// Distance from an end, scaled, and the part of the rise between.
    pub(crate) width: f64,
    pub(crate) rise: f64,
    pub(crate) from_right: bool,
    pub(crate) slope: f64,
    pub(crate) second: f64,
}

/// The second derivative between two points, linear between knots, in the direction of the data.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Profile {
    pub(crate) ends: [f64; 2],
    knots: [Knot; 8],
    count: usize,
    pub(crate) energy: f64,
    /// Whether it is level for a while.
    pub(crate) level: bool,
    /// The distance from either end on which it is linear, and away from 0 if it is convex.
    reach: [f64; 2],
    /// What rounding of the slopes makes of the second derivatives at the ends.
    rounding: [f64; 2],
}

/// The second derivatives that all intervals take at their ends.
pub(crate) struct Profiles {
    /// The length of a layer, as a part of an interval; 0: as the least energy has it.
    share: f64,
    /// At every point, with the sign of the data.
    target: Vec<f64>,
    /// Intervals on which the data are straight.
    straight: Vec<bool>,
}

impl Profile {
    pub(crate) fn knots(&self) -> &[Knot] {
        &self.knots[..self.count]
    }

    fn push(&mut self, knot: Knot) {
        self.knots[self.count] = knot;
        self.count += 1;
    }

    /// Of least energy for interval i with slopes m.
    fn least(problem: &Problem, i: usize, found: &Slopes) -> Self {
        let (d, h) = (problem.d[i], problem.h[i]);
        let m = [found.m[i], found.m[i + 1]];
        if d == 0.0 {
            return Self::default();
        }
        if problem.bend[i] != 0 {
            return Self::bent(problem.bend[i], found.over_secant(i, d / h), m, d, h);
        }
        let mut piece = problem.piece(i, &found.m);
        if !piece.level {
            piece = Piece::cubic(found.over_secant(i, d / h), h);
        }
        let mut profile = Self { energy: piece.energy, ends: piece.ends(), ..Self::default() };
        profile.reach = [h, h];
        profile.rounding = [ULPS * f64::EPSILON * (m[0] + m[1]) / h; 2];
        if piece.level {
            let c = problem.floor.get(i).copied().unwrap_or(0.0);
            let own = d - c * h;
            let level = Level::new(m.map(|m| (m - c).max(0.0).sqrt()), own);
            let shares = [level.share, 1.0 - level.share];
            for (k, share) in shares.into_iter().enumerate() {
                let width = level.widths[k];
                let rise = (c * width + own * share) / d;
                if width > 0.0 {
                    profile.push(Knot { width, rise, from_right: k == 1, slope: c, second: 0.0 });
                }
            }
            (profile.level, profile.reach) = (true, level.widths);
        } else if profile.ends[0] * profile.ends[1] < 0.0 {
            let zero = profile.ends[0] / (profile.ends[0] - profile.ends[1]);
            profile.reach = [h * zero, h * (1.0 - zero)];
        }
        profile
    }

    /// Of least energy for a convex or concave interval.
    fn bent(bend: i8, over: [f64; 2], m: [f64; 2], d: f64, h: f64) -> Self {
        let shape = Ramp::beside(bend, over, h).shape();
        let (ends, energy) = (shape.ends, shape.energy);
        let ulps = ULPS * f64::EPSILON * (m[0] + m[1]);
        let (reach, rounding) = ([h; 2], [ulps / h; 2]);
        let mut profile = Self { ends, energy, reach, rounding, ..Self::default() };
        if let Some((end, width)) = shape.ramp {
            // Straight with the slope of the other end, then a parabola of slope.
            let (own, slope) = (m[end], m[1 - end]);
            let rise = width * (slope + (own - slope) / 3.0) / d;
            // A level part has no rise.
            let rise = if slope == 0.0 { 1.0 } else { rise };
            profile.push(Knot { width, rise, from_right: end == 1, slope, second: 0.0 });
            profile.reach[end] = width;
            profile.level = slope == 0.0;
        }
        profile
    }

    /// With another second derivative at an end.
    fn changed(
        self,
        to: [Option<f64>; 2],
        problem: &Problem,
        i: usize,
        m: &[f64],
        share: f64,
    ) -> Self {
        let (h, d) = (problem.h[i], problem.d[i]);
        let c = problem.floor.get(i).copied().unwrap_or(0.0);
        let mut out = Self { count: 0, ..self };
        let mut ends = [[Knot::default(); 3]; 2];
        for (end, to) in to.into_iter().enumerate() {
            let Some(to) = to else { continue };
            let (z, slope) = (self.ends[end], m[i + end]);
            let by = to - z;
            let mut tau = share / PARTS * self.reach[end];
            if problem.bend[i] == 0 && slope > c {
                let reach = if self.level { self.reach[end] } else { h };
                tau = (share / PARTS * reach).min((slope - c) / (8.0 * z.abs()));
            }
            // The slope of y'' away from the end; from the right end, slopes fall as they rise from the left.
            let gradient = self.gradient(end, h);
            let sense = if end == 0 { 1.0 } else { -1.0 };
            for k in 0..3 {
                let t = tau * (k + 1) as f64;
                let second = z + gradient * t + by * CHANGE[k];
                let over = z * t + 0.5 * gradient * t * t + by * tau * ONCE[k];
                let twice = t * t * (0.5 * z + gradient * t / 6.0) + by * tau * tau * TWICE[k];
                let second = match problem.bend[i] {
                    0 => second,
                    bend => f64::from(bend) * (f64::from(bend) * second).max(0.0),
                };
                let rise = (slope * t + sense * twice) / d;
                let slope = (slope + sense * over).max(c);
                ends[end][k] = Knot { width: t, rise, from_right: end == 1, slope, second };
            }
            out.ends[end] = to;
            out.energy += 0.5 * tau * by * by;
        }
        if to[0].is_some() {
            ends[0].into_iter().for_each(|knot| out.push(knot));
        }
        self.knots().iter().for_each(|knot| out.push(*knot));
        if to[1].is_some() {
            ends[1].into_iter().rev().for_each(|knot| out.push(knot));
        }
        out
    }

    /// The slope of the second derivative in the distance from an end, near it.
    fn gradient(&self, end: usize, h: f64) -> f64 {
        let own = self.knots().iter().find(|knot| knot.from_right == (end == 1));
        let (to, width) = own.map_or((self.ends[1 - end], h), |knot| (knot.second, knot.width));
        (to - self.ends[end]) / width
    }
}

impl Profiles {
    /// For slopes m; `bends` are the signs of the data's second differences at the points, 0 where nothing is asked, and
    /// `straight` the intervals that are straight.
    pub(crate) fn new(
        problem: &Problem,
        found: &Slopes,
        signs: &[i8],
        straight: Vec<bool>,
        share: f64,
    ) -> Self {
        let n = problem.h.len();
        // Second derivatives at the ends of the intervals, and their rounding.
        let mut sides = Vec::with_capacity(n);
        for i in 0..n {
            let own = Profile::least(problem, i, found);
            let ends = own.ends.map(|z| if straight[i] { 0.0 } else { problem.sign[i] * z });
            sides.push([0, 1].map(|end| (ends[end], own.rounding[end])));
        }
        let target = |i: usize| {
            let before = if i > 0 { sides[i - 1][1] } else { sides[i][0] };
            let after = if i < n { sides[i][0] } else { before };
            let wrong = |z: f64| z * f64::from(signs[i]) < 0.0;
            let (a, b) = (before.0, after.0);
            let room = before.1 + after.1 + SAME * a.abs().max(b.abs());
            if wrong(a) || wrong(b) || a * b <= 0.0 {
                0.0
            } else if (a - b).abs() <= room {
                if before.1 < after.1 { a } else { b }
            } else if a.abs() < b.abs() {
                a
            } else {
                b
            }
        };
        let target = (0..=n).map(target).collect();
        Self { share, target, straight }
    }

    /// The second derivative of interval i.
    pub(crate) fn of(&self, problem: &Problem, i: usize, found: &Slopes) -> Profile {
        let profile = Profile::least(problem, i, found);
        if problem.d[i] == 0.0 || self.straight[i] {
            return profile;
        }
        let size = profile.ends[0].abs().max(profile.ends[1].abs());
        let mut to = [None; 2];
        for end in 0..2 {
            let (target, own) = (problem.sign[i] * self.target[i + end], profile.ends[end]);
            if (target - own).abs() <= 2.0 * profile.rounding[end] + SAME * size {
                continue;
            }
            if self.share > 0.0 {
                to[end] = Some(target);
            }
        }
        if to == [None; 2] {
            profile
        } else {
            profile.changed(to, problem, i, &found.m, self.share)
        }
    }
}
