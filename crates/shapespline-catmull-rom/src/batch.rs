// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest handles of one batch of a polygon after another, with their check.
//!
//! The loops work on several segments at once (see [`SegmentBatch`]); what is rare, lines and ends,
//! comes after them.

use std::ops::Range;

use shapespline_criteria::{
    Criterion, Requirements, Violations,
    batch::{BatchChecker, BatchRequirements},
};
use shapespline_geometry::{
    DVec3, DataPolygon,
    batch::{SegmentBatch, VectorLanes},
    normalized_scale,
};

use crate::{
    Continuity, HandleOptions,
    bounds::{has_lines, of_lines, of_signs},
    handles::freed,
    tangents::{tangent, tangent_between},
};

/// One number a place.
type Row = [f64; SegmentBatch::ROOM];

/// The handles of a batch, with room to work in.
#[derive(Debug, Clone)]
pub(crate) struct BatchHandles {
    batch: SegmentBatch,
    required: BatchRequirements,
    tangents: VectorLanes,
    /// The legs of each segment.
    first: VectorLanes,
    last: VectorLanes,
    /// The factors that each segment allows at its ends; then those its legs have.
    at_start: Row,
    at_end: Row,
}

impl Default for BatchHandles {
    fn default() -> Self {
        Self {
            batch: SegmentBatch::default(),
            required: [Requirements::default(); SegmentBatch::ROOM],
            tangents: VectorLanes::default(),
            first: VectorLanes::default(),
            last: VectorLanes::default(),
            at_start: [1.0; SegmentBatch::ROOM],
            at_end: [1.0; SegmentBatch::ROOM],
        }
    }
}

/// What a check of handles found.
#[derive(Debug, Default)]
pub(crate) struct HandleScan {
    /// The segments that fail, ascending.
    pub(crate) violations: Vec<(usize, Violations)>,
    /// How many segments each criterion applies to.
    pub(crate) applicable: [usize; Criterion::COUNT],
    /// Whether some legs are not finite, or leave no room for sums of them.
    pub(crate) cramped: bool,
}

impl HandleScan {
    /// This and what was found on the segments after it.
    pub(crate) fn and(mut self, after: Self) -> Self {
        self.violations.extend(after.violations);
        self.count(after.applicable);
        self.cramped |= after.cramped;
        self
    }

    fn count(&mut self, applicable: [usize; Criterion::COUNT]) {
        for (sum, count) in self.applicable.iter_mut().zip(applicable) {
            *sum += count;
        }
    }
}

impl BatchHandles {
    /// The handles of some segments, at most [`SegmentBatch::OWN`], into `legs`; the smaller factor
    /// at the first node of each into `factors`. Returns that at the last node.
    ///
    /// `tangents`: one per point, or those of the parametrisation.
    pub(crate) fn make(
        &mut self,
        (polygon, tangents): (&DataPolygon, Option<&[DVec3]>),
        checker: &BatchChecker<'_>,
        options: &HandleOptions,
        own: Range<usize>,
        (legs, factors): (&mut [[DVec3; 2]], &mut [f64]),
        found: &mut HandleScan,
    ) -> f64 {
        self.batch.load(polygon, own);
        checker.requirements(&self.batch, &mut self.required);
        self.take_full_legs(polygon, tangents);
        self.limit(polygon, options);
        self.join(options.continuity);
        self.shorten(polygon);

        let all = [&self.first, &self.last];
        checker.unproved(&self.batch, &self.required, all, &mut found.violations);
        found.count(BatchChecker::applicable(&self.batch, &self.required));
        found.cramped |= !all.iter().all(|legs| legs.have_room(self.batch.own()));
        for (j, (legs, factor)) in self.batch.own().zip(legs.iter_mut().zip(factors)) {
            *legs = [self.first.get(j), self.last.get(j)];
            *factor = self.factor(j - 1);
        }
        self.factor(self.batch.own().end - 1)
    }

    /// The smaller factor at the node at the end of a place.
    #[inline(always)]
    fn factor(&self, j: usize) -> f64 {
        smaller(self.at_end[j], self.at_start[j + 1])
    }

    /// The full legs: a third of the spacing along the tangents at the nodes. A leg at an end of zero
    /// curvature is zero here.
    fn take_full_legs(&mut self, polygon: &DataPolygon, given: Option<&[DVec3]>) {
        let Self { batch, tangents, first, last, .. } = self;
        let (chords, spacings) = (batch.chords(), batch.spacings());
        if let Some(given) = given {
            for j in 0..batch.less(1) {
                tangents.set(j, given[batch.segment(polygon, j) + 1]);
            }
        } else {
            for j in 0..batch.less(1) {
                let around = [chords.get(j), chords.get(j + 1)];
                tangents.set(j, tangent_between(around, [spacings[j], spacings[j + 1]]));
            }
        }
        for (end, node) in ends(batch, polygon).into_iter().zip([0, polygon.segments()]) {
            if let Some(j) = end {
                tangents.set(j, tangent(polygon, node).unwrap_or_default());
            }
        }
        for j in 0..batch.less(2) {
            let third = spacings[j + 1] / 3.0;
            first.set(j + 1, tangents.get(j) * third);
            last.set(j + 1, tangents.get(j + 1) * third);
        }
    }

    /// The largest factors, up to one, that stay below `safety` times the bounds which the
    /// requirements of the polygon put on them.
    fn limit(&mut self, polygon: &DataPolygon, options: &HandleOptions) {
        let Self { batch, required, first, last, at_start, at_end, .. } = self;
        let (chords, binormals) = (batch.chords(), batch.binormals());
        let legs = |j: usize| [first.get(j), last.get(j)];
        // Written out: `map` on arrays keeps the loop from working on several at once.
        let around = |j: usize| {
            [binormals.get(j), binormals.get(j + 1), binormals.get(j + 2), binormals.get(j + 3)]
        };
        let safety = options.safety;
        if batch.is_ordinary() {
            for j in 0..batch.less(4) {
                let bounds = of_signs(required[j + 2], legs(j + 2), chords.get(j + 2), around(j));
                [at_start[j + 2], at_end[j + 2]] = limits(bounds, safety);
            }
        } else {
            for j in 0..batch.less(4) {
                let (legs, chord) = normalized_scale(legs(j + 2), chords.get(j + 2));
                let bounds = of_signs(required[j + 2], legs, chord, around(j));
                [at_start[j + 2], at_end[j + 2]] = limits(bounds, safety);
            }
        }
        let sine = options.tolerances.collinearity;
        let cotangent = ((1.0 - sine) * (1.0 + sine)).sqrt() / sine;
        for j in (2..batch.less(2)).filter(|&j| has_lines(required[j])) {
            let direction = batch.directions().get(j);
            let [p, q] = of_lines(required[j], legs(j), chords.get(j), direction, cotangent);
            at_start[j] = at_start[j].min(safety * p);
            at_end[j] = at_end[j].min(safety * q);
        }
        // At an open end there is one segment, and what it allows.
        let [start, end] = ends(batch, polygon);
        if let Some(j) = start {
            at_end[j] = at_start[j + 1];
        }
        if let Some(j) = end {
            at_start[j + 1] = at_end[j];
        }
    }

    /// From the factors that segments allow to those their legs have: the smaller one at a node, for
    /// both where they have to be one.
    fn join(&mut self, continuity: Continuity) {
        let Self { batch, required, at_start, at_end, .. } = self;
        for j in 0..batch.less(5) {
            let j = j + 2;
            let (q, p) = (at_end[j], at_start[j + 1]);
            // In an inflecting coplanar segment the legs decide where it inflects: one factor a node.
            let one = continuity == Continuity::C1
                || required[j].union(required[j + 1]).intersects(Requirements::SPLIT_COPLANARITY);
            let least = smaller(q, p);
            (at_end[j], at_start[j + 1]) = if one { (least, least) } else { (q, p) };
        }
    }

    /// Legs times their factors, and those at ends of zero curvature, for which `a = (L − c)/2`, or any
    /// part of it, makes `a × b` vanish.
    fn shorten(&mut self, polygon: &DataPolygon) {
        let Self { batch, first, last, at_start, at_end, .. } = self;
        for j in 0..batch.less(2 * SegmentBatch::BESIDE) {
            let j = j + SegmentBatch::BESIDE;
            first.set(j, first.get(j) * at_start[j]);
            last.set(j, last.get(j) * at_end[j]);
        }
        // The ends of closed polygons are none.
        let natural = polygon.tangents().map(|tangent| tangent.is_none());
        let [start, end] = ends(batch, polygon);
        let free = [start.map(|j| j + 1).filter(|_| natural[0]), end.filter(|_| natural[1])];
        for j in free.into_iter().flatten().filter(|j| batch.own().contains(j)) {
            let scale = |end: Option<usize>, factor: f64| (end == Some(j)).then_some(factor);
            let scales = [scale(free[0], at_start[j]), scale(free[1], at_end[j])];
            let [a, c] = freed(batch.chords().get(j), [first.get(j), last.get(j)], scales);
            first.set(j, a);
            last.set(j, c);
        }
    }
}

/// The smaller of two numbers that are not NaN: one instruction.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The factors that bounds allow.
#[inline(always)]
fn limits(bounds: [f64; 2], safety: f64) -> [f64; 2] {
    let limit = |bound: f64| if safety * bound < 1.0 { safety * bound } else { 1.0 };
    [limit(bounds[0]), limit(bounds[1])]
}

/// The places at the end of which the first and the last node of an open polygon lie.
fn ends(batch: &SegmentBatch, polygon: &DataPolygon) -> [Option<usize>; 2] {
    let segments = batch.segments(polygon);
    let last = segments.end - 1;
    let inner = !polygon.is_closed() && last + 1 < batch.places();
    [segments.start.checked_sub(1), inner.then_some(last)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_criteria::Checker;
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    /// Everything that is made of a polygon in batches of some width.
    fn in_batches(
        polygon: &DataPolygon,
        options: &HandleOptions,
        width: usize,
    ) -> (Vec<[DVec3; 2]>, Vec<f64>, HandleScan) {
        let n = polygon.segments();
        let checker = BatchChecker::new(polygon, options.criteria, options.tolerances);
        let mut handles = BatchHandles::default();
        let (mut legs, mut factors) = (vec![[DVec3::ZERO; 2]; n], vec![0.0; n]);
        let (mut found, mut last) = (HandleScan::default(), 0.0);
        for (k, out) in legs.chunks_mut(width).zip(factors.chunks_mut(width)).enumerate() {
            let own = k * width..k * width + out.0.len();
            last = handles.make((polygon, None), &checker, options, own, out, &mut found);
        }
        factors.push(last);
        (legs, factors, found)
    }

    /// To the same bits wherever batches begin and end, where planes, lines and turns lie across the
    /// seams and sizes are any; the verdicts are those of the checker that sees one segment at a time.
    #[test]
    fn stretches_agree_with_each_other_and_with_the_checker() {
        let at = |k: usize| {
            let t = 0.37 * k as f64;
            let lift = if (k / 70).is_multiple_of(3) { 0.0 } else { (1.3 * t).cos() };
            let bend = if k / 30 % 4 == 1 { 0.0 } else { (0.4 * t).sin() };
            DVec3::new(t, bend, lift)
        };
        let tangents = Boundary::tangents(DVec3::X, DVec3::Y);
        let ends = [Boundary::ZeroCurvature, Boundary::Circular, tangents, Boundary::Periodic];
        let mut shortened = [false; 4];
        for (n, planar, size) in [2, 3, 64, 65, 400]
            .into_iter()
            .flat_map(|n| [false, true].map(|planar| (n, planar)))
            .flat_map(|(n, planar)| [1e-200, 1e-38, 1.0, 1e39].map(|size| (n, planar, size)))
        {
            let flat = if planar { DVec3::new(1.0, 1.0, 0.0) } else { DVec3::ONE };
            for (k, boundary) in ends.into_iter().enumerate() {
                let mut points: Vec<DVec3> = (0..=n).map(|k| at(k) * flat * size).collect();
                if boundary == Boundary::Periodic {
                    points[n] = points[0];
                }
                let polygon =
                    DataPolygon::new(points, &Parametrization::Centripetal, boundary).unwrap();
                for continuity in [Continuity::C1, Continuity::G1] {
                    let options = HandleOptions { continuity, ..HandleOptions::default() };
                    let (legs, factors, found) = in_batches(&polygon, &options, SegmentBatch::OWN);
                    for width in [1, 7] {
                        let other = in_batches(&polygon, &options, width);
                        assert_eq!(legs, other.0);
                        assert_eq!(factors, other.1);
                        assert_eq!(found.violations, other.2.violations);
                        assert_eq!(found.applicable, other.2.applicable);
                    }
                    let checker = Checker::new(&polygon, options.criteria, options.tolerances);
                    assert_eq!(found.violations, checker.all_unproved(|i| legs[i]));
                    assert_eq!(found.applicable, checker.applicable(0..n));
                    if n == 400 {
                        shortened[k] |= factors.iter().any(|&f| f < 1.0);
                        // Coplanarity is asked for in space only.
                        assert_eq!(found.applicable[3] > 0, !planar);
                    }
                }
            }
        }
        assert_eq!(shortened, [true; 4]);
    }
}
