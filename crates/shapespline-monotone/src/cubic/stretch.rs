// SPDX-License-Identifier: MIT OR Apache-2.0

//! The slopes of least energy on a stretch of data: scalar sweeps, then Newton's method on a tridiagonal system.
//!
//! A stretch is a run of intervals between two nodes whose slopes are held (turns and flats, given slopes) or that end
//! the data; what lies beyond has no influence on it. The energy is convex in the slopes, and the system scaled by its
//! diagonal has a condition of at most 4 whatever the spacing: the influence of a node falls by a third at least from
//! node to node.

use super::layer::Layer;
use super::piece::Piece;
use std::ops::Range;

/// What the diagonal of the Hessian has beyond that of cubics, from the intervals before and after a node.
pub(super) type Barrier = [f64; 2];

/// Steps of Newton's method after which slopes that are asked for convexity are swept again: over many decades steps that
/// suit one slope may be wrong for the next.
const SWEEPS_AFTER: usize = 25;
/// Steps of Newton's method at most: data over hundreds of decades take a hundred or so, a million rough points thirty,
/// most others less than ten.
const STEPS: usize = 400;
/// Steps of every slope, relative to it or to the smaller secant beside it, at which Newton's method ends. It
/// converges quadratically: what is left then is rounding.
const ENOUGH: f64 = 1e-10;
/// Nodes beside those that still move that are solved for with them: 3⁻²⁴ is 4e−12.
const BESIDE: usize = 24;
/// Slopes below this part of the smaller secant beside them are 0.
const NOTHING: f64 = 7.888_609_052_210_118e-31; // 2⁻¹⁰⁰
/// What the energy may rise by rounding, relative to it.
const ALLOWANCE: f64 = 1e-13;
/// The slope of the energy at the end of a step, relative to that at its start, that shortens the step; not below this.
const OVERSHOT: f64 = 0.5;
const LEAST_CUT: f64 = 1.0 / 64.0;
const TINY_ROOT: f64 = 1e-160;

/// A stretch, in the direction of its data.
pub(crate) struct Stretch<'a> {
    /// Widths of the intervals.
    pub(crate) h: &'a [f64],
    /// Rises, positive.
    pub(crate) d: &'a [f64],
    /// The least slope of every interval; empty: 0.
    pub(crate) floor: &'a [f64],
    /// 1 for intervals on which the function is to be convex, −1 for concave, 0 for others; empty: 0.
    pub(crate) bend: &'a [i8],
    /// Whether the slopes at the two ends are held.
    pub(crate) held: [bool; 2],
    /// Layers beside ends of slope 0.
    pub(crate) layer: [Option<Layer>; 2],
    /// What slopes are measured from in Newton's method; empty: 0.
    pub(super) base: Vec<f64>,
    /// Intervals that are not straight although their arms are small; empty: none.
    pub(super) opened: Vec<bool>,
}

/// Sizes of quantities at a point in the space of slopes.
#[derive(Default)]
pub(super) struct Model {
    pub(super) energy: Vec<f64>,
    gradient: Vec<f64>,
    pub(super) diagonal: Vec<f64>,
    off_diagonal: Vec<f64>,
    singular: Vec<f64>,
    growing: Vec<f64>,
    /// The same of convex and concave intervals, whose slopes are bounded by secants: before and after every node.
    barrier: Vec<Barrier>,
}

/// Memory that stretches use one after another.
#[derive(Default)]
pub(crate) struct Room {
    now: Model,
    next: Model,
    trial: Vec<f64>,
    step: Vec<f64>,
    pivot: Vec<f64>,
}

/// How Newton's method went.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steps {
    pub(crate) solves: usize,
    pub(crate) converged: bool,
}

impl Default for Steps {
    fn default() -> Self {
        Self { solves: 0, converged: true }
    }
}

impl<'a> Stretch<'a> {
    fn nodes(&self) -> usize {
        self.h.len() + 1
    }

    pub(super) fn is_held(&self, i: usize) -> bool {
        (i == 0 && self.held[0]) || (i == self.h.len() && self.held[1])
    }

    /// The least slope at node i: the larger of its two intervals'.
    #[inline(always)]
    pub(super) fn bound(&self, i: usize) -> f64 {
        if self.floor.is_empty() {
            return 0.0;
        }
        let before = if i > 0 { self.floor[i - 1] } else { 0.0 };
        let after = if i < self.h.len() { self.floor[i] } else { 0.0 };
        before.max(after)
    }

    /// The smaller secant beside node i: the unit of its slope.
    #[inline(always)]
    pub(super) fn unit(&self, i: usize) -> f64 {
        let before = if i > 0 { self.d[i - 1] / self.h[i - 1] } else { f64::INFINITY };
        let after = if i < self.h.len() { self.d[i] / self.h[i] } else { f64::INFINITY };
        before.min(after)
    }

    /// Interval i with end slopes m.
    #[inline(always)]
    pub(super) fn piece(&self, i: usize, m: [f64; 2]) -> Piece {
        if i == 0
            && let Some(layer) = &self.layer[0]
        {
            return layer.piece(false, m, self.d[i], self.h[i]);
        }
        if i + 1 == self.h.len()
            && let Some(layer) = &self.layer[1]
        {
            return layer.piece(true, m, self.d[i], self.h[i]);
        }
        if !self.bend.is_empty() {
            return self.asked(i, m);
        }
        if self.floor.is_empty() {
            return Piece::new(m, self.d[i], self.h[i]);
        }
        let c = self.floor[i];
        let m = [(m[0] - c).max(0.0), (m[1] - c).max(0.0)];
        Piece::new(m, self.d[i] - c * self.h[i], self.h[i])
    }

    /// Slopes of least energy. `m` holds those of held ends, and with `warm` a start for the others.
    /// Where convexity is asked, `fine` gets every slope as a secant that bounds it and what it differs by.
    pub(crate) fn minimise(
        &mut self,
        m: &mut [f64],
        fine: &mut [[f64; 2]],
        warm: bool,
        room: &mut Room,
    ) -> Steps {
        if !warm {
            self.start(m);
            self.sweep(m);
        }
        self.set_base(m);
        let steps = self.settle(m, room);
        self.take_base(m, fine);
        for i in 0..m.len() {
            if !self.is_held(i) && m[i] < NOTHING * self.unit(i) && self.bound(i) == 0.0 {
                m[i] = 0.0;
            }
        }
        steps
    }

    /// Newton's method, until it ends or some intervals turn out to be straight.
    pub(super) fn newton(&mut self, m: &mut [f64], room: &mut Room) -> (Steps, Vec<usize>) {
        if self.nodes() == 2 && self.held == [true, true] {
            return (Steps::default(), Vec::new());
        }
        self.evaluate(m, &mut room.now);
        for solves in 1..=STEPS {
            if !self.bend.is_empty() && solves.is_multiple_of(SWEEPS_AFTER) {
                let (before, energy) = (m.to_vec(), room.now.energy.iter().sum::<f64>());
                self.sweep(m);
                self.evaluate(m, &mut room.now);
                // Negated: an energy that is not a number is not less.
                if !(room.now.energy.iter().sum::<f64>() <= energy) {
                    m.copy_from_slice(&before);
                    self.evaluate(m, &mut room.now);
                }
            }
            let Room { now, next, trial, step, pivot } = room;
            self.solve(m, now, step, pivot);
            let mut t = 1.0;
            loop {
                self.moved(m, now, step, t, trial);
                self.evaluate(trial, next);
                let (mut rise, mut energy, mut slope, mut ahead) = (0.0, 0.0, 0.0, 0.0);
                for (a, b) in now.energy.iter().zip(&next.energy) {
                    rise += b - a;
                    energy += a.abs();
                }
                for i in 0..m.len() {
                    slope += now.gradient[i] * (trial[i] - m[i]);
                    ahead += next.gradient[i] * (trial[i] - m[i]);
                }
                // Where energies differ by many decades, rounding of large ones hides that small ones rise.
                let far = !self.bend.is_empty() && ahead > OVERSHOT * slope.abs() && t > LEAST_CUT;
                // Negated: an energy that is not a number is no descent.
                if (rise <= 1e-4 * slope.min(0.0) + ALLOWANCE * energy && !far) || t < 1e-9 {
                    break;
                }
                t *= 0.5;
            }
            let open = if self.bend.is_empty() {
                self.open(m, trial, ENOUGH * t)
            } else {
                self.open_bent(m, trial, now, solves, ENOUGH * t)
            };
            m.copy_from_slice(trial);
            std::mem::swap(now, next);
            self.rebase(m);
            let straight = self.straight(m);
            if open.is_empty() || !straight.is_empty() {
                return (Steps { solves, converged: true }, straight);
            }
            if 2 * open.iter().map(Range::len).sum::<usize>() < self.nodes() {
                let mut all = Steps { solves, converged: true };
                for nodes in open {
                    let (part, _) = self.part(&nodes).newton(&mut m[nodes], room);
                    all.solves = all.solves.max(solves + part.solves);
                    all.converged &= part.converged;
                }
                return (all, Vec::new());
            }
        }
        (Steps { solves: STEPS, converged: false }, Vec::new())
    }

    /// Runs of nodes around those that still moved by more than `enough`, with as many beside them as these could move.
    fn open(&self, m: &[f64], moved: &[f64], enough: f64) -> Vec<Range<usize>> {
        let mut open: Vec<Range<usize>> = Vec::new();
        for i in (0..m.len()).filter(|&i| !self.is_held(i)) {
            let size = m[i].max(moved[i]).max(self.unit(i));
            if (moved[i] - m[i]).abs() <= enough * size {
                continue;
            }
            let nodes = i.saturating_sub(BESIDE)..(i + BESIDE + 1).min(m.len());
            match open.last_mut() {
                Some(last) if last.end >= nodes.start => last.end = nodes.end,
                _ => open.push(nodes),
            }
        }
        open
    }

    /// The stretch between two of its nodes, held there.
    pub(super) fn part(&self, nodes: &Range<usize>) -> Stretch<'a> {
        let (start, end) = (nodes.start, nodes.end - 1);
        let last = self.h.len();
        let floor = if self.floor.is_empty() { self.floor } else { &self.floor[start..end] };
        Stretch {
            h: &self.h[start..end],
            d: &self.d[start..end],
            floor,
            held: [start > 0 || self.held[0], end < last || self.held[1]],
            layer: [self.layer[0].filter(|_| start == 0), self.layer[1].filter(|_| end == last)],
            bend: self.bend.get(start..end).unwrap_or_default(),
            base: self.base.get(start..=end).unwrap_or_default().to_vec(),
            opened: self.opened.get(start..end).unwrap_or_default().to_vec(),
        }
    }

    /// Energies of the intervals, gradient and Hessian of their sum.
    fn evaluate(&self, m: &[f64], model: &mut Model) {
        let n = self.nodes();
        let Model { gradient, diagonal, singular, growing, .. } = model;
        for values in [gradient, diagonal, singular, growing] {
            values.clear();
            values.resize(n, 0.0);
        }
        if !self.bend.is_empty() {
            model.barrier.clear();
            model.barrier.resize(n, [0.0; 2]);
        }
        for values in [&mut model.energy, &mut model.off_diagonal] {
            values.clear();
            values.reserve(n);
        }
        for i in 0..n - 1 {
            let p = self.piece(i, [m[i], m[i + 1]]);
            model.energy.push(p.energy);
            model.off_diagonal.push(p.hessian[1]);
            for k in 0..2 {
                model.gradient[i + k] += p.gradient[k];
                model.diagonal[i + k] += p.hessian[2 * k];
                model.growing[i + k] += p.growing[k];
                if self.bend.get(i).is_some_and(|bend| *bend != 0) {
                    model.barrier[i + k][1 - k] = p.singular[k];
                } else {
                    model.singular[i + k] += p.singular[k];
                }
            }
        }
        // Held slopes, and those that the data's direction presses against their bound, stay where they are.
        for i in 0..n {
            let bound = self.bound(i);
            let bounded = bound > 0.0 || self.is_bent(i);
            let pressed = bounded && m[i] <= bound - self.base(i) && model.gradient[i] > 0.0;
            if self.is_held(i) || pressed {
                (model.gradient[i], model.diagonal[i], model.singular[i]) = (0.0, 1.0, 0.0);
                if i > 0 {
                    model.off_diagonal[i - 1] = 0.0;
                }
                if i + 1 < n {
                    model.off_diagonal[i] = 0.0;
                }
            }
        }
    }

    /// Newton's step: elimination without exchanges, for the system is positive definite and well conditioned when
    /// scaled, which changes nothing in it but ranges.
    fn solve(&self, m: &[f64], model: &Model, step: &mut Vec<f64>, pivot: &mut Vec<f64>) {
        let n = m.len();
        for values in [&mut *step, &mut *pivot] {
            values.clear();
            values.reserve(n);
        }
        for i in 0..n {
            let (mut diagonal, mut right) = (model.diagonal[i], -model.gradient[i]);
            if i > 0 {
                let factor = model.off_diagonal[i - 1] / pivot[i - 1];
                diagonal -= factor * model.off_diagonal[i - 1];
                right -= factor * step[i - 1];
            }
            pivot.push(diagonal);
            step.push(right);
        }
        for i in (0..n).rev() {
            let after = if i + 1 < n { model.off_diagonal[i] * step[i + 1] } else { 0.0 };
            step[i] = (step[i] - after) / pivot[i];
        }
    }

    /// The slopes after a part t of the step.
    fn moved(&self, m: &[f64], model: &Model, step: &[f64], t: f64, out: &mut Vec<f64>) {
        out.clear();
        out.reserve(m.len());
        for i in 0..m.len() {
            let (bound, by) = (self.bound(i) - self.base(i), t * step[i]);
            out.push(if self.is_held(i) || step[i] == 0.0 {
                m[i]
            } else if model.singular[i] > 0.5 * model.diagonal[i] {
                // A term in slope^(3/2) rules: the step is taken in the root of the slope.
                let root = (m[i] - bound).max(0.0).sqrt().max(TINY_ROOT);
                let moved = (root + by / (2.0 * root)).max(0.0);
                self.inside(i, m[i], bound + moved * moved)
            } else if self.is_bent(i) {
                self.after(i, m[i], by, model.diagonal[i], model.barrier[i])
            } else if by < 0.0 && model.growing[i] > 0.5 * model.diagonal[i] {
                // The gradient is nearly quadratic in the slope: a step in the square, where plain ones would halve it.
                let size = m[i] - bound;
                bound + size * (1.0 + 2.0 * by / size).max(1.0 / 256.0).sqrt()
            } else {
                bound + (m[i] - bound + by).max((m[i] - bound) / 16.0)
            });
        }
    }
}
