// SPDX-License-Identifier: MIT OR Apache-2.0

//! A chain of segments whose nodes are to be found: the whole curve, or a window of it.

use std::ops::Range;

use glam::DVec3;
use shapespline_criteria::Criterion;

use crate::{
    barrier::Barrier,
    element::{Legs, Node},
    energy::{self, Energy, Gauss},
    rows::{Kind, Row, Rules, best_change, rows},
    segment::{FORWARD, Segment},
    shape::Shape,
    workspace::Workspace,
};

/// How far a node may move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Freedom {
    /// Both derivatives.
    Free,
    /// The first derivative along a unit vector alone, and the second.
    Along(DVec3),
    /// Neither.
    Held,
    /// The second derivative alone: given tangents.
    TangentHeld,
    /// Both derivatives along a unit vector.
    Straight(DVec3),
    /// The second derivative along a unit vector: a given tangent at the end of a straight run.
    StraightHeld(DVec3),
}

impl Freedom {
    /// Whether a given tangent is held.
    pub(crate) fn holds_tangent(self) -> bool {
        matches!(self, Self::TangentHeld | Self::StraightHeld(_))
    }

    /// The line that the first and that the second derivative keep to.
    pub(crate) fn lines(self) -> [Option<DVec3>; 2] {
        match self {
            Self::Free | Self::Held | Self::TangentHeld => [None, None],
            Self::Along(t) => [Some(t), None],
            Self::Straight(t) => [Some(t), Some(t)],
            Self::StraightHeld(t) => [None, Some(t)],
        }
    }
}

/// Segments in a row, the nodes between them, and the conditions on them.
#[derive(Debug)]
pub(crate) struct Chain {
    pub(crate) segments: Vec<Segment>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) freedom: Vec<Freedom>,
    /// Index of the first node along the curve.
    pub(crate) first: usize,
    pub(crate) rules: Rules,
    /// The piece of each inflection.
    changes: Vec<usize>,
    pub(crate) rows: Vec<Row>,
    /// Rows of each segment.
    pub(crate) ranges: Vec<Range<usize>>,
    /// Multiplier of each row; none before the first step.
    pub(crate) multipliers: Vec<f64>,
    /// Whether the barrier proper keeps a row, not the elastic one.
    pub(crate) kept: Vec<bool>,
    /// Quadrature of each segment, for the bending energy.
    quadrature: Vec<Vec<Gauss>>,
    pub(crate) workspace: Workspace,
}

/// A condition that has come to hold is kept by the barrier from this value on: from less, the barrier
/// would take a step for each doubling.
const CLEAR: f64 = 1e-3;

/// Multiplier from which on a condition counts as binding: at the last weight of the barrier its value
/// is then below 3 % of its natural size.
const BINDING: f64 = 0.03;

/// Bending energy times length above which a segment nearly stops: half a turn evenly spread has π².
const SLOW: f64 = 20.0;

/// Speeds forward that may be asked for.
const SPEEDS: [f64; 7] = [FORWARD, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3];

impl Chain {
    pub(crate) fn new(
        segments: Vec<Segment>,
        nodes: Vec<Node>,
        freedom: Vec<Freedom>,
        first: usize,
        rules: Rules,
    ) -> Self {
        let changes = vec![1; segments.len()];
        let mut chain = Self {
            segments,
            nodes,
            freedom,
            first,
            rules,
            changes,
            rows: Vec::new(),
            ranges: Vec::new(),
            multipliers: Vec::new(),
            kept: Vec::new(),
            quadrature: Vec::new(),
            workspace: Workspace::default(),
        };
        chain.choose_changes();
        chain
    }

    /// Whether the last segment ends at the first node.
    pub(crate) fn is_ring(&self) -> bool {
        self.segments.len() == self.nodes.len()
    }

    /// The nodes at the ends of a segment.
    pub(crate) fn ends(&self, k: usize) -> [usize; 2] {
        [k, if k + 1 == self.nodes.len() { 0 } else { k + 1 }]
    }

    /// The legs of a segment.
    pub(crate) fn legs(&self, k: usize) -> Legs {
        let [start, end] = self.ends(k).map(|i| self.nodes[i]);
        self.segments[k].span.legs(start, end)
    }

    /// Chooses the piece of each inflection anew, and lists the conditions.
    pub(crate) fn choose_changes(&mut self) {
        for k in 0..self.segments.len() {
            self.changes[k] = best_change(&self.segments[k], &self.legs(k));
        }
        self.list_rows();
    }

    /// Whether middle coefficients may be negative as far as the outer two allow.
    pub(crate) fn set_exact_middles(&mut self, exact: bool) {
        self.rules.exact_middles = exact;
        self.list_rows();
    }

    fn list_rows(&mut self) {
        self.rows.clear();
        self.ranges.clear();
        for (segment, &change) in self.segments.iter().zip(&self.changes) {
            let from = self.rows.len();
            rows(segment, change, &self.rules, &mut self.rows);
            self.ranges.push(from..self.rows.len());
        }
        self.multipliers.clear();
        self.kept.clear();
    }

    /// Asks of each segment no more speed forward than it has.
    pub(crate) fn relax_speeds(&mut self) {
        for k in 0..self.segments.len() {
            self.segments[k].speed = 0.0;
            let legs = self.legs(k);
            let shape = Shape::new(&self.segments[k], &self.rules, &legs);
            let mut slowest = f64::INFINITY;
            for row in &self.rows[self.ranges[k].clone()] {
                if let Kind::Forward { leg } = row.kind {
                    let share = if leg == 0 || leg == 4 { 1.0 } else { 2.0 };
                    slowest = slowest.min(share * shape.value(row));
                }
            }
            let speed = SPEEDS.into_iter().find(|&v| v < slowest);
            self.segments[k].speed = speed.unwrap_or(0.0);
        }
        self.choose_changes();
    }

    /// Asks for no speed forward: what the closed-form start promises.
    pub(crate) fn ask_no_speed(&mut self) {
        self.segments.iter_mut().for_each(|segment| segment.speed = 0.0);
        self.choose_changes();
    }

    /// The criteria that hold a segment back: those with a condition whose multiplier exceeds its value by
    /// far.
    pub(crate) fn binding(&self, k: usize) -> Vec<Criterion> {
        let mut binding: Vec<Criterion> = Vec::new();
        for i in self.ranges[k].clone() {
            let held = self.multipliers.get(i).is_some_and(|&multiplier| multiplier > BINDING);
            let criterion = self.rows[i].kind.criterion(self.segments[k].bend);
            if let Some(criterion) = criterion.filter(|c| held && !binding.contains(c)) {
                binding.push(criterion);
            }
        }
        binding
    }

    /// Calls back with each row of a segment and its value.
    pub(crate) fn each_row(&self, k: usize, legs: &Legs, mut f: impl FnMut(usize, f64)) {
        let shape = Shape::new(&self.segments[k], &self.rules, legs);
        for i in self.ranges[k].clone() {
            f(i, shape.value(&self.rows[i]));
        }
    }

    /// The least value of all conditions of a segment.
    fn least(&self, k: usize) -> f64 {
        let mut least = f64::INFINITY;
        // Written so that a NaN counts as least.
        self.each_row(k, &self.legs(k), |_, z| least = if z >= least { least } else { z });
        least
    }

    /// The segments some of whose conditions fail.
    pub(crate) fn failing(&self) -> Vec<usize> {
        (0..self.segments.len()).filter(|&k| !(self.least(k) > 0.0)).collect()
    }

    /// Whether all conditions hold.
    pub(crate) fn all_hold(&self) -> bool {
        (0..self.segments.len()).all(|k| self.least(k) > 0.0)
    }

    /// Whether all conditions hold clearly.
    pub(crate) fn all_hold_clearly(&self) -> bool {
        (0..self.segments.len()).all(|k| self.least(k) > CLEAR)
    }

    /// Whether a segment turns in a small part of its length: the curve nearly stops there.
    pub(crate) fn nearly_stops(&self, k: usize) -> bool {
        let span = self.segments[k].span;
        energy::bending(&span, &self.legs(k)) * span.length > SLOW
    }

    /// Quadrature of a segment.
    pub(crate) fn rule(&self, k: usize) -> &[Gauss] {
        self.quadrature.get(k).map_or(&[], Vec::as_slice)
    }

    /// What is minimised, without the barrier.
    pub(crate) fn objective(&self) -> f64 {
        let value = |k: usize| {
            let (segment, legs) = (&self.segments[k], self.legs(k));
            energy::value(segment.energy, &segment.span, &legs, &energy::rule(&legs))
        };
        (0..self.segments.len()).map(value).sum()
    }

    /// Value of objective and barrier on a segment, infinite outside of the barrier; adds the values of its
    /// conditions to `margins`.
    pub(crate) fn value(&self, k: usize, barrier: &Barrier, margins: &mut Vec<f64>) -> f64 {
        let segment = &self.segments[k];
        let legs = self.legs(k);
        let mut barriers = 0.0;
        self.each_row(k, &legs, |i, z| {
            barriers += barrier.of(self.kept[i]).value(z);
            margins.push(z);
        });
        if barriers == f64::INFINITY {
            return barriers;
        }
        let (mut rule, finer) = (self.rule(k), energy_rule(segment.energy, &legs));
        // A rule that was made elsewhere may miss a cusp that lies here.
        if finer.len() > rule.len() {
            rule = &finer;
        }
        let value = energy::value(segment.energy, &segment.span, &legs, rule);
        let value = value + segment.weight * barriers;
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Chooses how finely each segment is integrated.
    pub(crate) fn choose_quadrature(&mut self) {
        let rule = |k: usize| energy_rule(self.segments[k].energy, &self.legs(k));
        self.quadrature = (0..self.segments.len()).map(rule).collect();
    }

    /// From now on minimises the bending energy.
    pub(crate) fn bend(&mut self) {
        for segment in &mut self.segments {
            segment.energy = Energy::Bending;
        }
    }

    /// Whether any segment's bending energy is minimised.
    pub(crate) fn bends(&self) -> bool {
        self.segments.iter().any(|segment| segment.energy == Energy::Bending)
    }

    /// Decides which conditions the barrier proper keeps: those that hold, where it protects them.
    pub(crate) fn keep_what_holds(&mut self, barrier: &Barrier) {
        let mut kept = std::mem::take(&mut self.kept);
        kept.resize(self.rows.len(), false);
        if barrier.protects {
            for k in 0..self.segments.len() {
                self.each_row(k, &self.legs(k), |i, z| kept[i] |= z > CLEAR);
            }
        }
        self.kept = kept;
    }
}

/// The rule that an energy is integrated by: none is needed where it is known exactly.
fn energy_rule(energy: Energy, legs: &Legs) -> Vec<Gauss> {
    match energy {
        Energy::Parametric => Vec::new(),
        Energy::Bending => energy::rule(legs),
    }
}
