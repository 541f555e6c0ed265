// SPDX-License-Identifier: MIT OR Apache-2.0

//! Stretches with convex and concave intervals: bounds of their slopes, and steps that respect them.
//!
//! Such an interval bounds the slopes at its ends by its secant, and its energy ([`Ramp`]) grows as `1/room` towards the
//! bound. Where that term rules, Newton's step is taken in `1/room²`, in which the derivative of such a term is linear.
//! Rooms of 1e-13 of the slope occur, so slopes are kept as the nearer bound and the difference from it: otherwise rounding
//! of the slope would decide about energies in the eighth digit.

use super::piece::Piece;
use super::ramp::Ramp;
use super::stretch::{Barrier, Model, Room, Steps, Stretch};
use std::ops::Range;

/// Steps of a node in a sweep.
const SWEEP_STEPS: usize = 8;
/// Steps, relative to the room, at which a sweep leaves a node.
const ENOUGH: f64 = 1.0 / 16.0;
/// The part of the room before a bound that a step leaves at least, and one over the square of what it adds at most.
const LEFT: f64 = 1.0 / 64.0;
const GROWTH: f64 = 1.0 / 256.0;
/// Arms of an interval, relative to the differences of slopes that bound them, below which it is straight; and where that
/// has turned out to be wrong once.
const STRAIGHT: [f64; 2] = [1e-8, 1e-25];
/// Second derivatives that are 0, relative to the secants over the widths.
const NO_SECOND: f64 = 1e-12;
/// What a step may lower the energy of the intervals beside a node by, relative to it, and be rounding: first, and where
/// that is not reached in some steps.
const NOTHING: [f64; 2] = [1e-26, 1e-16];
const PATIENCE: usize = 20;
/// The least room before a bound, relative to it, that sweeps leave, which do not know of smaller ones.
const COARSE: f64 = 1e-9;
/// Ulps above the least slope that are none: rounding of the sum.
const ULPS: f64 = 8.0;
/// A bound takes the place of another when it is nearer by this.
const NEARER: f64 = 0.25;

impl Stretch<'_> {
    fn bend(&self, i: usize) -> i8 {
        self.bend.get(i).copied().unwrap_or(0)
    }

    fn sides(&self, i: usize) -> [Option<usize>; 2] {
        [i.checked_sub(1), (i < self.h.len()).then_some(i)]
    }

    /// Whether an interval beside node i is to be convex or concave.
    #[inline(always)]
    pub(super) fn is_bent(&self, i: usize) -> bool {
        !self.bend.is_empty() && self.sides(i).into_iter().flatten().any(|k| self.bend[k] != 0)
    }

    fn secant(&self, i: usize) -> f64 {
        self.d[i] / self.h[i]
    }

    /// What the slope of node i is measured from.
    #[inline(always)]
    pub(super) fn base(&self, i: usize) -> f64 {
        if self.base.is_empty() { 0.0 } else { self.base[i] }
    }

    /// A convex or concave interval i with slopes m over their bases.
    fn ramp(&self, i: usize, m: [f64; 2]) -> Ramp {
        Ramp::beside(self.bend[i], self.beyond_secant(i, m), self.h[i])
    }

    /// Interval i with slopes m over their bases, as asked.
    pub(super) fn asked(&self, i: usize, m: [f64; 2]) -> Piece {
        if self.bend[i] != 0 {
            return self.ramp(i, m).piece();
        }
        let c = self.floor.get(i).copied().unwrap_or(0.0);
        let over = |slope: f64| if slope - c <= ULPS * f64::EPSILON * c { 0.0 } else { slope - c };
        let slopes = [0, 1].map(|end| over(self.base(i + end) + m[end]));
        let piece = Piece::new(slopes, self.d[i] - c * self.h[i], self.h[i]);
        if piece.level { piece } else { Piece::cubic(self.beyond_secant(i, m), self.h[i]) }
    }

    fn beyond_secant(&self, i: usize, m: [f64; 2]) -> [f64; 2] {
        let delta = self.secant(i);
        [0, 1].map(|end| (self.base(i + end) - delta) + m[end])
    }

    /// Measure slopes from the nearest secants beside them.
    pub(super) fn set_base(&mut self, m: &mut [f64]) {
        if self.bend.is_empty() {
            return;
        }
        let base = |i: usize| {
            let secants = self.sides(i).into_iter().flatten().map(|k| self.secant(k));
            let nearest = secants.min_by(|a, b| (a - m[i]).abs().total_cmp(&(b - m[i]).abs()));
            nearest.filter(|_| !self.is_held(i)).unwrap_or(0.0)
        };
        self.base = (0..m.len()).map(base).collect();
        m.iter_mut().zip(&self.base).for_each(|(m, base)| *m -= base);
    }

    /// Measure from other secants that have become much nearer.
    pub(super) fn rebase(&mut self, m: &mut [f64]) {
        for i in 0..self.base.len() {
            if self.base[i] == 0.0 {
                continue;
            }
            for k in self.sides(i).into_iter().flatten() {
                let edge = self.secant(k) - self.base[i];
                if edge != 0.0 && (m[i] - edge).abs() < NEARER * m[i].abs() {
                    m[i] -= edge;
                    self.base[i] = self.secant(k);
                }
            }
        }
    }

    /// The slopes themselves.
    pub(super) fn take_base(&mut self, m: &mut [f64], fine: &mut [[f64; 2]]) {
        for (i, base) in std::mem::take(&mut self.base).into_iter().enumerate() {
            let (slope, bound) = (base + m[i], self.bound(i));
            let pressed = !self.is_held(i) && slope <= bound * (1.0 + ULPS * f64::EPSILON);
            fine[i] = if pressed { [bound, 0.0] } else { [base, m[i]] };
            m[i] = fine[i][0] + fine[i][1];
        }
    }

    /// The slopes of least energy from some near them.
    pub(super) fn settle(&mut self, m: &mut [f64], room: &mut Room) -> Steps {
        let (mut all, mut straight) = self.newton(m, room);
        let mut done = straight.is_empty();
        while !done {
            let Steps { solves, converged } = self.cut(&straight, m, room);
            all = Steps { solves: all.solves + solves, converged };
            let before = straight.len();
            straight.retain(|&i| !self.opens(i, m));
            done = straight.len() == before;
        }
        all
    }

    /// Bend a straight interval if what is beside it asks for that.
    fn opens(&mut self, i: usize, m: &mut [f64]) -> bool {
        let (n, bend) = (self.h.len(), self.bend[i]);
        if self.opened.get(i) == Some(&true) {
            return false;
        }
        let asks = |k: usize, end: usize| {
            if k >= n {
                return 0.0;
            }
            let gradient = self.piece(k, [m[k], m[k + 1]]).gradient[end];
            0.5 * f64::from(bend) * if end == 0 { -gradient } else { gradient }
        };
        // Its second derivative at the ends, before its positive part is taken, convex and in the direction of the data.
        let asked = [asks(i.wrapping_sub(1), 1), asks(i + 1, 0)];
        let beside = [i.checked_sub(1), Some(i), (i + 1 < n).then_some(i + 1)];
        let size = |k: usize| self.secant(k) / self.h[k];
        let rounding = NO_SECOND * beside.into_iter().flatten().map(size).sum::<f64>();
        if asked.iter().all(|z| *z <= rounding) {
            return false;
        }
        let h = self.h[i];
        let [p, q] = asked;
        let [to, from] = if p > 0.0 && q > 0.0 {
            [h * (2.0 * p + q) / 6.0, h * (p + 2.0 * q) / 6.0]
        } else {
            // A ramp: its width and the change of slope, of which the far end has the smaller part.
            let share = p.max(q) / (p - q).abs();
            let sum = 0.5 * p.max(q) * share * h;
            let far = sum * share / 3.0;
            if p > 0.0 { [sum - far, far] } else { [far, sum - far] }
        };
        let sense = f64::from(bend);
        for (node, by) in [(i, -sense * to), (i + 1, sense * from)] {
            m[node] = self.inside(node, m[node], m[node] + by);
        }
        self.opened.resize(n, false);
        self.opened[i] = true;
        true
    }

    /// The secants that bound the slope of node i, over its base, with 1 where it lies above and −1 where below.
    fn edges(&self, i: usize) -> [Option<(f64, f64)>; 2] {
        let [before, after] = self.sides(i);
        let edge = |k: Option<usize>, side: f64| {
            let k = k.filter(|k| self.bend(*k) != 0)?;
            Some((self.secant(k) - self.base(i), side * f64::from(self.bend(k))))
        };
        [edge(before, 1.0), edge(after, -1.0)]
    }

    /// A slope of node i between its bounds on the way from `m` to `to`.
    pub(super) fn inside(&self, i: usize, m: f64, to: f64) -> f64 {
        let within = |to: f64, (edge, sense): (f64, f64)| {
            let least = LEFT * (sense * (m - edge));
            if sense * (to - edge) < least { edge + sense * least } else { to }
        };
        self.edges(i).into_iter().flatten().fold(to, within)
    }

    /// The slope of node i after Newton's step.
    pub(super) fn after(&self, i: usize, m: f64, by: f64, diagonal: f64, barrier: Barrier) -> f64 {
        let mut to = m + by;
        for (edge, barrier) in self.edges(i).into_iter().zip(barrier) {
            if let Some((edge, sense)) = edge
                && barrier > 0.5 * diagonal
            {
                let room = sense * (m - edge);
                let square = (1.0 - 2.0 * (sense * by / room)).max(GROWTH);
                to = edge + sense * (room / square.sqrt());
            }
        }
        self.inside(i, m, to.max(self.bound(i) - self.base(i)))
    }

    /// The slope of node i that is best for those of its neighbours, nearly.
    pub(super) fn bent(&self, m: &[f64], i: usize) -> f64 {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut t = m[i];
        for _ in 0..SWEEP_STEPS {
            let (mut gradient, mut second, mut barrier) = (0.0, 0.0, [0.0; 2]);
            for (end, k) in self.sides(i).into_iter().enumerate() {
                let Some(k) = k else { continue };
                // The node is the right end of the interval before it.
                let at = 1 - end;
                let mut slopes = [m[k], m[k + 1]];
                slopes[at] = t;
                let piece = self.piece(k, slopes);
                gradient += piece.gradient[at];
                second += piece.hessian[2 * at];
                if self.bend(k) != 0 {
                    barrier[end] = piece.singular[at];
                }
            }
            if gradient < 0.0 {
                low = t;
            } else if gradient > 0.0 {
                high = t;
            } else {
                break;
            }
            let next = self.after(i, t, -gradient / second, second, barrier);
            let outside = !(next > low && next < high) && low.is_finite() && high.is_finite();
            let next = if outside { 0.5 * (low + high) } else { next };
            let close = |(edge, sense): (f64, f64)| sense * (next - edge) < COARSE * edge;
            if self.edges(i).into_iter().flatten().any(close) {
                break;
            }
            let small = (next - t).abs() <= ENOUGH * self.size(i, next);
            t = next;
            if small {
                break;
            }
        }
        t
    }

    /// Slopes inside their bounds where the harmonic means of the secants are not.
    pub(super) fn start_bent(&self, m: &mut [f64]) {
        if self.bend.is_empty() {
            return;
        }
        let n = self.h.len();
        for i in (1..n).filter(|&i| !self.is_held(i) && self.is_bent(i)) {
            let (mut low, mut high) = (self.bound(i), f64::INFINITY);
            for (edge, sense) in self.edges(i).into_iter().flatten() {
                if sense > 0.0 { low = low.max(edge) } else { high = high.min(edge) }
            }
            if !(m[i] > low && m[i] < high) {
                m[i] = if high.is_finite() { 0.5 * (low + high) } else { 1.25 * low };
            }
        }
        // At free ends half the arm of the neighbour: the least energy for that.
        for (i, k, next) in [(0, 0, 1), (n, n - 1, n - 1)] {
            if !self.is_held(i) && self.bend(k) != 0 {
                let delta = self.secant(k);
                m[i] = (delta - 0.5 * (m[next] - delta)).max(self.bound(i));
            }
        }
    }

    /// What a step of node i is measured by: the room before the nearest bound.
    pub(super) fn size(&self, i: usize, m: f64) -> f64 {
        let room = |size: f64, (edge, sense): (f64, f64)| size.min(sense * (m - edge));
        self.edges(i).into_iter().flatten().fold(f64::INFINITY, room)
    }

    /// All nodes, or none where no slope moves any more.
    pub(super) fn open_bent(
        &self,
        m: &[f64],
        moved: &[f64],
        model: &Model,
        steps: usize,
        enough: f64,
    ) -> Vec<Range<usize>> {
        let moves = |i: usize| {
            let by = (moved[i] - m[i]).abs();
            let size = if self.is_bent(i) {
                self.size(i, moved[i])
            } else {
                m[i].max(moved[i]).max(self.unit(i))
            };
            by > enough * size && !self.is_rounding(i, model, by, steps)
        };
        let any = (0..m.len()).any(|i| !self.is_held(i) && moves(i));
        any.then_some(0..m.len()).into_iter().collect()
    }

    /// Whether a step of node i changes nothing in the energy beside it.
    pub(super) fn is_rounding(&self, i: usize, model: &Model, by: f64, steps: usize) -> bool {
        let beside = self.sides(i).into_iter().flatten().map(|k| model.energy[k]).sum::<f64>();
        let nothing = NOTHING[usize::from(steps > PATIENCE)];
        model.diagonal[i] * by * by <= nothing * beside
    }

    /// The intervals whose arms have both shrunk to nothing: what is beside them wants them bent the other way.
    pub(super) fn straight(&self, m: &[f64]) -> Vec<usize> {
        (0..self.bend.len()).filter(|&i| self.bend[i] != 0 && self.is_straight(i, m)).collect()
    }

    fn is_straight(&self, i: usize, m: &[f64]) -> bool {
        let delta = self.secant(i);
        let mut scale = delta;
        for (node, neighbour) in [(i, i.wrapping_sub(1)), (i + 1, i + 1)] {
            if self.bend(neighbour) != 0 {
                // The slope lies between the two secants.
                scale = scale.min((self.secant(neighbour) - delta).abs());
            } else if self.is_held(node) {
                scale = scale.min((self.base(node) + m[node] - delta).abs());
            }
        }
        let [a, b] = self.ramp(i, [m[i], m[i + 1]]).arms;
        a + b <= STRAIGHT[usize::from(self.opened.get(i) == Some(&true))] * scale
    }

    /// The slopes with some intervals straight, which cuts the stretch there.
    fn cut(&mut self, straight: &[usize], m: &mut [f64], room: &mut Room) -> Steps {
        for &i in straight {
            for node in [i, i + 1] {
                (self.base[node], m[node]) = (self.secant(i), 0.0);
            }
        }
        let mut all = Steps::default();
        let mut start = 0;
        for end in straight.iter().copied().chain([self.h.len()]) {
            if start < end {
                let mut part = self.part(&(start..end + 1));
                let steps = part.settle(&mut m[start..=end], room);
                self.base[start..=end].copy_from_slice(&part.base);
                all.solves = all.solves.max(steps.solves);
                all.converged &= steps.converged;
            }
            start = end + 1;
        }
        all
    }
}
