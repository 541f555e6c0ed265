// SPDX-License-Identifier: MIT OR Apache-2.0

//! What is asked of convexity: of which intervals, and whether a function through the data can have it.
//!
//! A function that is convex on an interval has slopes at its ends on either side of the secant. So between two convex
//! intervals the slope lies between the secants, and where three points are collinear there the function is straight
//! from the first to the last. Between a convex and a concave interval the second derivative is 0.

use super::problem::Problem;
use super::{CubicOptions, Ends};
use crate::MonotoneError;

/// Where a [`super::MonotoneCubic`] is convex (`f'' ≥ 0`) or concave.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Convexity {
    /// Wherever the data are: on intervals at both of whose ends the secants turn the same way (at the last points
    /// nothing turns; they take their neighbour's way), straight where the data are. Nothing is asked of the intervals
    /// between convex and concave data.
    Data,
    /// As told for every interval: convex (1), concave (−1), or nothing asked (0).
    Signs(Vec<i8>),
}

/// Relative differences of secants up to which points are collinear.
const COLLINEAR: f64 = 1e-9;
/// The least arm of an estimated end slope, relative to that of the parabola through three points.
const LEAST_ARM: f64 = 0.25;
/// Arms, relative to the secant, that are straight.
const LEAST: f64 = 8.0 * f64::EPSILON;
/// An interval that is straight.
const STRAIGHT: i8 = 2;

const HELD: &str = "must lie on that side of the secant beside it which convex asks for (no convexity, or the slope free)";
const CONTRADICTS: &str =
    "but no C1 function through the data is convex (1) or concave (-1) there; give 0";

/// What is asked of all intervals and points.
pub(super) struct Asked {
    /// 1, −1, 0 or [`STRAIGHT`], in the direction of y.
    kinds: Vec<i8>,
    /// The sign that the second derivative has at every point; 0: not asked.
    pub(super) signs: Vec<i8>,
}

impl Asked {
    /// Of a problem whose held slopes are known. `first` is the first interval of `n` of the data. Slopes estimated at
    /// the ends are moved to where convexity allows them.
    pub(super) fn new(
        convexity: &Convexity,
        problem: &mut Problem,
        n: usize,
        options: &CubicOptions,
        first: usize,
    ) -> Result<Self, MonotoneError> {
        let source = Source { n, first, options };
        let mut asked = match convexity {
            Convexity::Data => Self::of_data(problem),
            Convexity::Signs(signs) => Self::of_signs(problem, signs, &source)?,
        };
        asked.move_ends(problem, &source);
        if *convexity == Convexity::Data {
            asked.relax(problem);
        }
        while let Some((node, i)) = asked.conflict(problem) {
            // Nothing is asked where the data themselves do not allow it.
            let given = !problem.is_level(node) && source.given(node).is_some();
            if *convexity != Convexity::Data || given {
                return Err(asked.refusal(problem, &source, node, i));
            }
            asked.kinds[i] = 0;
        }
        Ok(asked)
    }

    fn of_data(problem: &Problem) -> Self {
        let n = problem.h.len();
        let mut signs = vec![0; n + 1];
        for i in 1..n {
            signs[i] = turn(problem, i);
        }
        (signs[0], signs[n]) = (signs[1.min(n - 1)], signs[n - 1]);
        let kind = |i: usize| match (signs[i], signs[i + 1]) {
            _ if problem.d[i] == 0.0 => 0,
            (0, 0) if n > 1 => STRAIGHT,
            (a, b) if a == b => a,
            _ => 0,
        };
        let mut asked = Self { kinds: (0..n).map(kind).collect(), signs };
        let mut start = 0;
        while start < n {
            let mut end = start + 1;
            while end < n && asked.signs[end] == 0 {
                end += 1;
            }
            if end - start > 1 && problem.d[start] > 0.0 {
                asked.collinear(problem, start, end);
            }
            start = end;
        }
        asked
    }

    /// Collinear points from `start` to `end` within data that turn the same way at both: convex functions are straight
    /// there from the first to the last. Not where another slope is asked for at an end, beside more collinear points
    /// and turns: no C¹ function is convex there.
    fn collinear(&mut self, problem: &Problem, start: usize, end: usize) {
        let (n, signs) = (problem.h.len(), &self.signs);
        if signs[start] * signs[end] < 0 {
            return;
        }
        let mut straight = [
            signs[start] != 0 && !problem.is_level(start) && (start == 0 || signs[start - 1] != 0),
            signs[end] != 0 && !problem.is_level(end) && (end == n || signs[end + 1] != 0),
        ];
        if end - start == 2 && signs[start] != 0 && signs[end] != 0 {
            straight = [straight[0] && straight[1]; 2];
        }
        for (is, i) in straight.into_iter().zip([start, end - 1]) {
            if is {
                self.kinds[i] = STRAIGHT;
            }
        }
    }

    fn of_signs(
        problem: &Problem,
        given: &[i8],
        source: &Source<'_>,
    ) -> Result<Self, MonotoneError> {
        let n = problem.h.len();
        if given.len() != source.n {
            let (found, expected) = (given.len(), source.n);
            return Err(MonotoneError::Length { argument: "convex", found, expected });
        }
        if let Some(index) = given.iter().position(|s| !(-1..=1).contains(s)) {
            let rule = "but every sign must be -1, 0 or 1";
            return Err(MonotoneError::Convex { index, value: given[index], rule });
        }
        let sign = |i: usize| if problem.d[i] == 0.0 { 0 } else { given[source.interval(i)] };
        let mut kinds: Vec<i8> = (0..n).map(sign).collect();
        let mut signs = vec![0; n + 1];
        for i in 0..=n {
            let (a, b) = (sign(i.max(1) - 1), sign(i.min(n - 1)));
            signs[i] = (a + b).signum();
            if i > 0 && i < n && a == b && a != 0 && turn(problem, i) == 0 {
                kinds[i - 1..=i].fill(STRAIGHT);
            }
        }
        if n == 1 && kinds[0] != 0 && !problem.held[0] && !problem.held[1] {
            kinds[0] = STRAIGHT;
        }
        Ok(Self { kinds, signs })
    }

    /// Move estimated slopes at the ends to the side of the secant that is asked for, to a quarter of the arm of the
    /// parabola through three points at least: on smooth data they are there.
    fn move_ends(&mut self, problem: &mut Problem, source: &Source<'_>) {
        let n = problem.h.len();
        for (node, i, next) in [(0, 0, 1), (n, n - 1, n.max(2) - 2)] {
            if !source.is_estimated(problem, node) || self.kinds[i] == 0 {
                continue;
            }
            let delta = problem.secant(i);
            let parabola = if n > 1 {
                let turn =
                    (problem.sign[next] * problem.secant(next) - problem.sign[i] * delta).abs();
                turn * (problem.h[i] / (problem.h[i] + problem.h[next]))
            } else {
                0.0
            };
            let floor = problem.floor.get(i).copied().unwrap_or(0.0);
            let least = LEAST_ARM * parabola.min(delta - floor);
            if self.kinds[i] == STRAIGHT || least <= LEAST * delta {
                self.kinds[i] = STRAIGHT;
                problem.slope[node] = delta;
                continue;
            }
            // At the left end of an interval that is convex in the direction of its data the slope is below the secant.
            let side = if node == 0 { -1.0 } else { 1.0 } * self.bend(problem, i);
            let arm = side * (problem.slope[node] - delta);
            if arm < least {
                problem.slope[node] = delta + side * least;
            }
        }
    }

    /// Data that are straight are not asked to be where given slopes differ.
    fn relax(&mut self, problem: &Problem) {
        for i in 0..self.kinds.len() {
            let delta = problem.secant(i);
            let differs =
                |k: usize| problem.held[k] && (problem.slope[k] - delta).abs() > COLLINEAR * delta;
            if self.kinds[i] == STRAIGHT && (differs(i) || differs(i + 1)) {
                self.kinds[i] = 0;
            }
        }
    }

    /// 1 where interval i is to be convex in the direction of its data, −1 where concave, else 0.
    fn bend(&self, problem: &Problem, i: usize) -> f64 {
        if self.kinds[i] == STRAIGHT { 0.0 } else { problem.sign[i] * f64::from(self.kinds[i]) }
    }

    /// The slope of node i if it is held or beside a straight interval.
    fn held(&self, problem: &Problem, i: usize) -> Option<f64> {
        let n = self.kinds.len();
        let beside = [i.checked_sub(1), (i < n).then_some(i)];
        let straight = || beside.into_iter().flatten().filter(|&k| self.kinds[k] == STRAIGHT);
        let count = straight().count();
        if count > 0 {
            return Some(straight().map(|k| problem.secant(k)).sum::<f64>() / count as f64);
        }
        problem.held[i].then_some(problem.slope[i])
    }

    /// A node and an interval beside it of which something is asked that no function has.
    fn conflict(&self, problem: &Problem) -> Option<(usize, usize)> {
        for node in 0..=self.kinds.len() {
            let sides = [node.checked_sub(1), (node < self.kinds.len()).then_some(node)];
            let held = self.held(problem, node);
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            for (end, i) in sides.into_iter().enumerate() {
                let Some(i) = i else { continue };
                let delta = problem.secant(i);
                if self.kinds[i] == STRAIGHT {
                    // Straight with two slopes, at a turn, or against a slope that is given.
                    let own = if problem.held[node] { problem.slope[node] } else { delta };
                    let far = |slope: f64| (slope - delta).abs() > 2.0 * COLLINEAR * delta;
                    if far(own) || held.is_some_and(far) {
                        return Some((node, i));
                    }
                    continue;
                }
                let side = self.bend(problem, i) * if end == 0 { 1.0 } else { -1.0 };
                if side > 0.0 {
                    low = low.max(delta);
                } else if side < 0.0 {
                    high = high.min(delta);
                }
                if side != 0.0 && held.is_some_and(|slope| !(side * (slope - delta) > 0.0)) {
                    return Some((node, i));
                }
            }
            if !(low < high) {
                return Some((node, node.max(1) - 1));
            }
        }
        None
    }

    /// A given slope that stands against what is asked of interval i beside it, or a sign of the interval itself.
    fn refusal(
        &self,
        problem: &Problem,
        source: &Source<'_>,
        node: usize,
        i: usize,
    ) -> MonotoneError {
        if !problem.is_level(node)
            && let Some((argument, index, value)) = source.given(node)
        {
            return MonotoneError::HeldSlope { argument, index, value, rule: HELD };
        }
        let (index, rule) = (source.interval(i), CONTRADICTS);
        let value = match &source.options.convex {
            Some(Convexity::Signs(signs)) => signs[index],
            _ => self.kinds[i],
        };
        MonotoneError::Convex { index, value, rule }
    }

    /// Ask it of the problem. The straight intervals.
    pub(super) fn impose(&self, problem: &mut Problem) -> Vec<bool> {
        let n = self.kinds.len();
        problem.bend = (0..n).map(|i| self.bend(problem, i) as i8).collect();
        for i in 0..=n {
            if let Some(slope) = self.held(problem, i) {
                (problem.held[i], problem.slope[i]) = (true, slope);
            }
        }
        self.kinds.iter().map(|kind| *kind == STRAIGHT).collect()
    }
}

/// Which way the data turn at a point between two intervals: 0 where they do not.
fn turn(problem: &Problem, i: usize) -> i8 {
    let [a, b] = [i - 1, i].map(|k| problem.sign[k] * problem.secant(k));
    if (b - a).abs() <= COLLINEAR * (a.abs() + b.abs()) {
        0
    } else if b > a {
        1
    } else {
        -1
    }
}

/// Where nodes of a problem come from.
struct Source<'a> {
    /// Intervals of the data, and the problem's first of them.
    n: usize,
    first: usize,
    options: &'a CubicOptions,
}

impl Source<'_> {
    /// The interval of the data of which one of the problem's is (a copy).
    fn interval(&self, i: usize) -> usize {
        (i + self.n * self.first - self.first) % self.n
    }

    /// The argument, entry and value that held a node.
    fn given(&self, node: usize) -> Option<(&'static str, usize, f64)> {
        let periodic = self.options.ends == Ends::Periodic;
        let point = if periodic { self.interval(node) } else { node };
        if let Some(slopes) = &self.options.slopes {
            let copies = [Some(point), (periodic && point == 0).then_some(self.n)];
            let own = copies.into_iter().flatten().find(|k| !slopes[*k].is_nan());
            if let Some(k) = own {
                return Some(("slopes", k, slopes[k]));
            }
        }
        let k = usize::from(node != 0);
        match &self.options.ends {
            Ends::Slopes(slopes) if node == 0 || node == self.n => {
                slopes[k].map(|slope| ("ends", k, slope))
            }
            _ => None,
        }
    }

    fn is_estimated(&self, problem: &Problem, node: usize) -> bool {
        self.options.ends == Ends::Estimated
            && !problem.is_level(node)
            && self.given(node).is_none()
    }
}
