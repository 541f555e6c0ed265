// SPDX-License-Identifier: MIT OR Apache-2.0

//! The data as the least-energy program sees them: intervals in the direction of their data, and slopes that are held.

use super::layer::Layer;
use super::piece::{Piece, least};
use super::stretch::{Room, Steps, Stretch};
use crate::MonotoneError;
use crate::data::{Data, LONG, joined, parts};
use crate::energy::is_flat;
use crate::interrupt::{GoOn, check_interrupt};
use shapespline_polynomial::parallel;
use std::ops::Range;

/// Nodes that one part of long data answers for: with its arrays it fits into a core's cache.
const PART: usize = 4096;
/// Nodes that a part looks beyond on either side: 3⁻⁴⁸ is 1e−23.
pub(crate) const OVERLAP: usize = 48;

/// Intervals and nodes; slopes are sizes, in the direction of the data.
pub(crate) struct Problem {
    pub(crate) h: Vec<f64>,
    /// Sizes of the rises; 0 where the data are flat.
    pub(crate) d: Vec<f64>,
    /// 1, −1, or 0 where the data are flat.
    pub(crate) sign: Vec<f64>,
    /// The least slope of every interval; empty: 0.
    pub(crate) floor: Vec<f64>,
    /// What is asked of every interval, in the direction of its data; empty: nothing.
    pub(crate) bend: Vec<Bend>,
    /// Nodes whose slope is not free.
    pub(crate) held: Vec<bool>,
    /// Slopes of the held nodes.
    pub(crate) slope: Vec<f64>,
}

/// 1 for an interval on which the function is to be convex in the direction of its data, −1 for concave, 0 for neither.
pub(crate) type Bend = i8;

/// Slopes of some nodes, and the same as [`Slopes::fine`].
type Part = (Vec<f64>, Vec<[f64; 2]>);

/// Slopes of least energy.
pub(crate) struct Slopes {
    pub(crate) m: Vec<f64>,
    /// Where convexity is asked, every slope as a sum of which the first part is a secant that bounds it, if one does.
    pub(crate) fine: Vec<[f64; 2]>,
    /// Where that is known better than from `fine`, what the slopes at the ends of every interval are above its secant.
    pub(crate) over: Vec<[f64; 2]>,
    /// Linear solves of the stretch that took most.
    pub(crate) solves: usize,
    pub(crate) converged: bool,
}

impl Slopes {
    /// What the slopes at the ends of interval i are above its secant.
    pub(crate) fn over_secant(&self, i: usize, delta: f64) -> [f64; 2] {
        let over = |k: usize| (self.fine[k][0] - delta) + self.fine[k][1];
        self.over.get(i).copied().unwrap_or_else(|| [over(i), over(i + 1)])
    }
}

/// Second derivatives at nodes of slope 0, and the share of the intervals beside them that a layer takes.
pub(crate) struct Layers {
    pub(crate) share: f64,
    /// Sizes.
    pub(crate) second: Vec<f64>,
}

impl Problem {
    /// Nodes of slope 0 held, all others free, at the ends too.
    pub(crate) fn new(data: &Data) -> Self {
        let n = data.len();
        let sign = |delta: &f64| if is_flat(*delta) { 0.0 } else { delta.signum() };
        let rise = |(h, delta): (&f64, &f64)| if is_flat(*delta) { 0.0 } else { delta.abs() * h };
        let (sign, (h, d)): (Vec<f64>, (Vec<f64>, Vec<f64>)) = parallel::both(
            n >= LONG,
            || data.delta.iter().map(sign).collect(),
            || (data.h.clone(), data.h.iter().zip(&data.delta).map(rise).collect()),
        );
        let mut held = vec![false; n + 1];
        (held[0], held[n]) = (sign[0] == 0.0, sign[n - 1] == 0.0);
        for i in 1..n {
            held[i] = sign[i - 1] * sign[i] <= 0.0;
        }
        Self { h, d, sign, floor: Vec::new(), bend: Vec::new(), held, slope: vec![0.0; n + 1] }
    }

    /// Whether node i is a turn or the end of a flat.
    pub(crate) fn is_level(&self, i: usize) -> bool {
        let n = self.sign.len();
        if i == 0 || i == n {
            self.sign[i.min(n - 1)] == 0.0
        } else {
            self.sign[i - 1] * self.sign[i] <= 0.0
        }
    }

    pub(crate) fn secant(&self, i: usize) -> f64 {
        self.d[i] / self.h[i]
    }

    /// Let the slope on every interval of strictly monotone data fall no lower than this share of the smallest of the
    /// secants of the interval and its neighbours.
    pub(crate) fn set_floor(&mut self, share: f64) {
        let n = self.h.len();
        let floor = |i: usize| {
            if self.is_level(i) || self.is_level(i + 1) {
                return 0.0;
            }
            let neighbours = i.saturating_sub(1)..(i + 2).min(n);
            share * neighbours.map(|k| self.secant(k)).fold(f64::INFINITY, f64::min)
        };
        self.floor = (0..n).map(floor).collect();
    }

    /// The slopes of least energy; with `layers` those that give continuous second derivatives, started from `near`.
    pub(crate) fn solve(
        &self,
        layers: Option<(&Layers, &[f64])>,
        go_on: GoOn<'_>,
    ) -> Result<Slopes, MonotoneError> {
        let nodes = self.held.len();
        let count = (nodes / PART).max(1);
        let cut = |k: usize| nodes * k / count;
        let part = |room: &mut Room, k: usize| -> Result<(Part, Steps), MonotoneError> {
            check_interrupt(go_on)?;
            Ok(self.part(cut(k)..cut(k + 1), layers, room))
        };
        if count == 1 {
            let ((m, fine), steps) = part(&mut Room::default(), 0)?;
            let Steps { solves, converged } = steps;
            return Ok(Slopes { m, fine, over: Vec::new(), solves, converged });
        }
        let parts: Result<Vec<_>, _> = parallel::map_with(count, 0, Room::default, part);
        let parts = parts?;
        let slopes: Vec<&[f64]> = parts.iter().map(|((m, _), _)| &m[..]).collect();
        let fine: Vec<&[[f64; 2]]> = parts.iter().map(|((_, fine), _)| &fine[..]).collect();
        Ok(Slopes {
            m: joined(&slopes, 0),
            fine: joined(&fine, 0),
            over: Vec::new(),
            solves: parts.iter().map(|(_, steps)| steps.solves).max().unwrap_or(0),
            converged: parts.iter().all(|(_, steps)| steps.converged),
        })
    }

    /// The slopes of some nodes.
    fn part(
        &self,
        own: Range<usize>,
        layers: Option<(&Layers, &[f64])>,
        room: &mut Room,
    ) -> (Part, Steps) {
        let last = self.held.len() - 1;
        // What lies beyond a held node has no influence.
        let mut from = own.start;
        while from > 0 && from + OVERLAP > own.start && !(from < own.start && self.held[from]) {
            from -= 1;
        }
        let mut to = own.end - 1;
        while to < last && to < own.end + OVERLAP && !(to >= own.end && self.held[to]) {
            to += 1;
        }
        let mut m = match layers {
            Some((_, near)) => near[from..=to].to_vec(),
            None => self.slope[from..=to].to_vec(),
        };
        let bent = !self.bend.is_empty();
        let mut fine: Vec<_> = m.iter().filter(|_| bent).map(|m| [*m, 0.0]).collect();
        let mut all = Steps::default();
        let mut start = from;
        while start < to {
            let mut end = start + 1;
            while end < to && !self.held[end] {
                end += 1;
            }
            if self.d[start] > 0.0 {
                let steps = self.stretch(
                    start..end,
                    layers.map(|l| l.0),
                    &mut m[start - from..=end - from],
                    if bent { &mut fine[start - from..=end - from] } else { &mut [] },
                    room,
                );
                all.solves = all.solves.max(steps.solves);
                all.converged &= steps.converged;
            }
            start = end;
        }
        m.truncate(own.end - from);
        m.drain(..own.start - from);
        if bent {
            fine.truncate(own.end - from);
            fine.drain(..own.start - from);
        }
        ((m, fine), all)
    }

    /// The slopes of a stretch of intervals.
    fn stretch(
        &self,
        intervals: Range<usize>,
        layers: Option<&Layers>,
        m: &mut [f64],
        fine: &mut [[f64; 2]],
        room: &mut Room,
    ) -> Steps {
        let ends = [intervals.start, intervals.end];
        let layer = ends.map(|i| layers.and_then(|layers| self.layer(layers, i)));
        if layers.is_some() && layer.iter().all(Option::is_none) {
            return Steps::default();
        }
        let floor = if self.floor.is_empty() { &[][..] } else { &self.floor[intervals.clone()] };
        let bend = if self.bend.is_empty() { &[][..] } else { &self.bend[intervals.clone()] };
        let (h, d) = (&self.h[intervals.clone()], &self.d[intervals]);
        let mut stretch = Stretch {
            h,
            d,
            floor,
            bend,
            held: ends.map(|i| self.held[i]),
            layer,
            base: Vec::new(),
            opened: Vec::new(),
        };
        stretch.minimise(m, fine, layers.is_some(), room)
    }

    /// The layer beside node i, if its slope is 0.
    pub(crate) fn layer(&self, layers: &Layers, i: usize) -> Option<Layer> {
        self.is_level(i).then(|| Layer { share: layers.share, second: layers.second[i] })
    }

    /// Interval i with slopes m at all nodes.
    pub(crate) fn piece(&self, i: usize, m: &[f64]) -> Piece {
        if self.d[i] == 0.0 {
            return Piece::default();
        }
        let c = self.floor.get(i).copied().unwrap_or(0.0);
        let m = [(m[i] - c).max(0.0), (m[i + 1] - c).max(0.0)];
        Piece::new(m, self.d[i] - c * self.h[i], self.h[i])
    }

    /// The least energy of some intervals in scaled units, and what each is above its lower bound at most.
    ///
    /// At the optimum the second derivatives `p` from both sides agree at free nodes, and are 0 at free ends. Whatever
    /// they are, `Σ φ(p)` with the minimum φ of [`least`] is a bound from below of the energy of every monotone
    /// interpolant; slopes that are held add the same to both sides.
    pub(crate) fn certificate(&self, m: &[f64], own: Range<usize>) -> (f64, Vec<f64>) {
        let n = self.h.len();
        let found = parts(own.len(), |part| {
            let part = own.start + part.start..own.start + part.end;
            let (mut energy, mut gaps) = (0.0, Vec::with_capacity(part.len()));
            // Every interval is worked out once, and seen by its neighbours.
            let at = |i: usize| if i < n { self.piece(i, m) } else { Piece::default() };
            let mut before = if part.start > 0 { at(part.start - 1) } else { Piece::default() };
            let mut own = at(part.start);
            for i in part {
                let after = at(i + 1);
                energy += own.energy;
                gaps.push(self.gap(i, m, [&before, &own, &after]));
                (before, own) = (own, after);
            }
            (energy, gaps)
        });
        let energy = found.iter().map(|(energy, _)| energy).sum();
        (energy, joined(&found.iter().map(|(_, gaps)| &gaps[..]).collect::<Vec<_>>(), 0))
    }

    /// Of interval i, from the pieces before it, on it and after it.
    fn gap(&self, i: usize, m: &[f64], [before, own, after]: [&Piece; 3]) -> f64 {
        if self.d[i] == 0.0 {
            return 0.0;
        }
        let ends = own.ends();
        let p0 = if self.held[i] || self.is_pressed(i, m) {
            ends[0]
        } else if i == 0 {
            0.0
        } else {
            0.5 * (ends[0] + before.ends()[1])
        };
        let p1 = if self.held[i + 1] || self.is_pressed(i + 1, m) {
            ends[1]
        } else if i + 1 == self.h.len() {
            0.0
        } else {
            0.5 * (ends[1] + after.ends()[0])
        };
        let c = self.floor.get(i).copied().unwrap_or(0.0);
        let bound = least([p0, p1], self.d[i] - c * self.h[i], self.h[i]);
        let value = own.energy + 2.0 * p0 * (m[i] - c) - 2.0 * p1 * (m[i + 1] - c);
        (value - bound).max(0.0)
    }

    /// Whether the energy would fall if the slope of node i could fall below its least one.
    fn is_pressed(&self, i: usize, m: &[f64]) -> bool {
        if self.floor.is_empty() {
            return false;
        }
        let n = self.h.len();
        let before = (i > 0).then(|| (self.floor[i - 1], self.piece(i - 1, m).gradient[1]));
        let after = (i < n).then(|| (self.floor[i], self.piece(i, m).gradient[0]));
        let sides = before.into_iter().chain(after);
        let (bound, gradient) = sides.fold((0.0f64, 0.0), |(b, g), (c, d)| (b.max(c), g + d));
        bound > 0.0 && m[i] <= bound && gradient > 0.0
    }

    /// Second derivatives for the layers beside turns and flats: at turns the smaller of the two that the least energy
    /// has, 0 at flats.
    pub(crate) fn layers(&self, share: f64, m: &[f64]) -> Layers {
        let n = self.h.len();
        let second = |i: usize| {
            if i == 0 || i == n || !self.is_level(i) {
                return 0.0;
            }
            let before = self.piece(i - 1, m).ends()[1].abs();
            before.min(self.piece(i, m).ends()[0].abs())
        };
        let found = parts(n + 1, |part| part.map(second).collect::<Vec<_>>());
        Layers { share, second: found.concat() }
    }

    /// Take 0 at the turns beside which the slope would fall below 0; whether there was one.
    pub(crate) fn flatten(&self, layers: &mut Layers, m: &[f64]) -> bool {
        let dips = |i: usize| {
            let level = [self.is_level(i), self.is_level(i + 1)];
            if self.d[i] == 0.0 || level[0] == level[1] {
                return None;
            }
            let (node, far) = if level[0] { (i, m[i + 1]) } else { (i + 1, m[i]) };
            let layer = self.layer(layers, node)?;
            layer.dips(far, self.d[i], self.h[i]).then_some(node)
        };
        let found = parts(self.h.len(), |part| part.filter_map(dips).collect::<Vec<_>>());
        let nodes = found.concat();
        for &i in &nodes {
            layers.second[i] = 0.0;
        }
        !nodes.is_empty()
    }
}
