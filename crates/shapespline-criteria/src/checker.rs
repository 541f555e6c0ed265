// SPDX-License-Identifier: MIT OR Apache-2.0

//! The checker: what a polygon requires, held against segments.

use std::ops::Range;

use glam::DVec3;
use shapespline_geometry::DataPolygon;

use crate::{
    BatchChecker, CachedChecker, Criteria, Criterion, Record, Requirements, ShapeReport,
    Tolerances, Undecided, Violations, batch::far, cone::Cones, margin, regular,
    resolution::is_straight, rounding::Lean, segment_geometry::SegmentGeometry,
    violations::violations,
};

/// A cubic between two points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cubic {
    /// First and last leg.
    pub(crate) legs: [DVec3; 2],
    pub(crate) chord: DVec3,
    /// Its largest coordinate.
    pub(crate) far: f64,
}

/// The shape criteria of one data polygon.
#[derive(Debug, Clone)]
pub struct Checker<'a> {
    local: BatchChecker<'a>,
    criteria: Criteria,
    required: Vec<Requirements>,
    /// Segments on which the curve is straight by construction.
    straight: Vec<usize>,
}

impl<'a> Checker<'a> {
    /// Finds out what each segment of the polygon requires among `criteria`. Cost O(N).
    #[must_use]
    pub fn new(polygon: &'a DataPolygon, criteria: Criteria, tolerances: Tolerances) -> Self {
        let local = BatchChecker::new(polygon, criteria, tolerances);
        Self { local, criteria, required: local.all_requirements(), straight: Vec::new() }
    }

    /// Asks for nothing at some nodes, as at ends of zero curvature: where the curve is to have corners.
    #[must_use]
    pub fn with_free_nodes(mut self, nodes: &[usize]) -> Self {
        let n = self.required.len();
        for &node in nodes {
            let at = |k: isize| {
                let segment = node as isize + k;
                let inside = (0..n as isize).contains(&segment) || self.polygon().is_closed();
                inside.then_some(segment.rem_euclid(n as isize) as usize)
            };
            let touched = [
                (at(-2), Requirements::TURNING_AFTER),
                (
                    at(-1),
                    Requirements::AT_END
                        .union(Requirements::TURNING_AFTER)
                        .union(Requirements::OF_BOTH),
                ),
                (
                    at(0),
                    Requirements::AT_START
                        .union(Requirements::TURNING_BEFORE)
                        .union(Requirements::OF_BOTH),
                ),
                (at(1), Requirements::TURNING_BEFORE),
            ];
            for (segment, required) in touched {
                if let Some(segment) = segment {
                    self.leave_out(segment, required);
                }
            }
        }
        self
    }

    /// Takes requirements from a segment, which then has to be regular in any case.
    fn leave_out(&mut self, segment: usize, required: Requirements) {
        let left = self.required[segment].difference(required);
        let regular = Requirements::of(Criterion::Regular);
        let implied = left.intersects(Requirements::IMPLY_REGULAR) || left.intersects(regular);
        self.required[segment] = if implied { left } else { left.union(Requirements::REGULAR) };
    }

    /// Takes some segments (ascending) to be straight by construction: nothing that turns is asked of them,
    /// and beside them, but for free nodes, turning and torsion may be zero where they meet.
    #[must_use]
    pub fn with_straight_segments(mut self, segments: &[usize], free: &[usize]) -> Self {
        let (n, closed) = (self.required.len(), self.polygon().is_closed());
        let is_straight = |i: usize| segments.binary_search(&i).is_ok();
        for &i in segments {
            self.leave_out(i, Requirements::of(Criterion::Turning));
            let before = if i > 0 { Some(i - 1) } else { closed.then_some(n - 1) };
            let after = if i + 1 < n { Some(i + 1) } else { closed.then_some(0) };
            let nodes = [i, if closed { (i + 1) % n } else { i + 1 }];
            let flags = [Requirements::STRAIGHT_AFTER, Requirements::STRAIGHT_BEFORE];
            for ((beside, node), flag) in [before, after].into_iter().zip(nodes).zip(flags) {
                if let Some(k) = beside.filter(|&k| !is_straight(k) && !free.contains(&node)) {
                    self.required[k] = self.required[k].union(flag);
                }
            }
        }
        self.straight = segments.to_vec();
        self
    }

    /// Whether the polygon goes straight on at a node, as far as tolerance and resolution tell.
    #[must_use]
    pub fn goes_straight_on(&self, node: usize) -> bool {
        let (polygon, tolerances) = (self.polygon(), self.tolerances());
        let n = polygon.segments();
        let [u, v] = polygon.directions_at(node);
        let inner = polygon.is_closed() || (0 < node && node < n);
        let hidden = || {
            let [before, after] = [(node + n - 1) % n, node % n].map(|i| polygon.chord(i));
            inner && is_straight(before, after, tolerances.resolution)
        };
        u.dot(v) > 0.0 && (u.cross(v).length() <= tolerances.zero || hidden())
    }

    /// The polygon.
    #[must_use]
    pub fn polygon(&self) -> &'a DataPolygon {
        self.local.polygon()
    }

    /// What counts as near, and as zero.
    #[must_use]
    pub fn tolerances(&self) -> Tolerances {
        self.local.tolerances()
    }

    /// What each segment requires.
    #[must_use]
    pub fn requirements(&self) -> &[Requirements] {
        &self.required
    }

    /// What is not proved of a segment with end legs `a, c`: conditions that fail, and conditions of which
    /// rounding hides whether they do.
    #[inline]
    #[must_use]
    pub fn unproved(&self, segment: usize, legs: [DVec3; 2]) -> Violations {
        self.judge(segment, &self.cubic(segment, legs), Lean::Against)
    }

    /// What fails on a segment with end legs `a, c`, however control points and arithmetic round.
    #[inline]
    #[must_use]
    pub fn violations(&self, segment: usize, legs: [DVec3; 2]) -> Violations {
        self.judge(segment, &self.cubic(segment, legs), Lean::For)
    }

    #[inline]
    pub(crate) fn judge(&self, segment: usize, cubic: &Cubic, lean: Lean) -> Violations {
        let required = self.required[segment];
        if required.is_empty() {
            return Violations::default();
        }
        violations(&self.geometry(segment, cubic), required, lean, || self.cones(segment))
    }

    /// The cubic of end legs between two points of the polygon.
    #[inline]
    fn cubic(&self, segment: usize, legs: [DVec3; 2]) -> Cubic {
        let polygon = self.polygon();
        Cubic { legs, chord: polygon.chord(segment), far: far(polygon, segment) }
    }

    /// The segments that are not proved to keep the shape, ascending, with what is not proved. Cost O(N), on all threads for long
    /// curves.
    pub fn all_unproved<L>(&self, legs: L) -> Vec<(usize, Violations)>
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        self.cached().all_unproved(legs)
    }

    /// This checker with a cache, for callers that check the same segments again and again.
    #[must_use]
    pub fn cached(&self) -> CachedChecker<'_> {
        CachedChecker::new(self.local, Some(&self.required))
    }

    /// The record of one criterion on a segment: verdict, margin and place. Where rounding hides the verdict
    /// the record says unsatisfied with margin zero, and the report has an [`Undecided`].
    #[must_use]
    pub fn record(&self, segment: usize, legs: [DVec3; 2], criterion: Criterion) -> Record {
        self.record_of(segment, &self.cubic(segment, legs), criterion)
    }

    pub(crate) fn record_of(&self, segment: usize, cubic: &Cubic, criterion: Criterion) -> Record {
        let required = self.required[segment];
        let applicable = required.intersects(Requirements::of(criterion));
        let mut record = Record {
            segment,
            criterion,
            applicable,
            satisfied: true,
            margin: f64::NAN,
            location: f64::NAN,
        };
        if !applicable {
            return record;
        }
        let s = self.geometry(segment, cubic);
        let margin = match criterion {
            Criterion::Convexity => margin::convexity(&s),
            Criterion::Inflection => margin::inflection(&s),
            Criterion::Turning => margin::turning(&s, required),
            Criterion::Torsion => margin::torsion(&s, required),
            Criterion::Coplanarity => margin::coplanarity(&s, required, &self.cones(segment)),
            Criterion::Collinearity => margin::collinearity(&s, required, &self.cones(segment)),
            Criterion::GlobalConvexity => margin::global_convexity(&s),
            Criterion::Regular => regular::margin(&s, required),
        };
        let of = Violations::of(criterion);
        record.satisfied = !self.judge(segment, cubic, Lean::Against).intersects(of);
        // The proof decides on which side of zero the margin lies.
        record.margin = if record.satisfied {
            margin.value.max(f64::MIN_POSITIVE)
        } else if self.judge(segment, cubic, Lean::For).intersects(of) {
            margin.value.min(0.0)
        } else {
            0.0
        };
        record.location =
            self.polygon().parameters()[segment] + margin.at * self.polygon().spacing(segment);
        record
    }

    /// The report on a curve, segment by segment. Memory follows the violations.
    pub fn report<L>(&self, legs: L) -> ShapeReport
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        let open: Vec<usize> =
            self.all_unproved(&legs).into_iter().map(|violation| violation.0).collect();
        self.report_of(&open, legs)
    }

    /// The report on a curve of which all segments but some (ascending) are proved to keep the shape.
    pub fn report_of<L>(&self, open: &[usize], legs: L) -> ShapeReport
    where
        L: Fn(usize) -> [DVec3; 2],
    {
        let verdict = |i: usize| {
            let cubic = self.cubic(i, legs(i));
            [self.judge(i, &cubic, Lean::Against), self.judge(i, &cubic, Lean::For)]
        };
        self.report_with(open, verdict, |i, criterion| self.record(i, legs(i), criterion))
    }

    /// The same, given what is not proved and what is violated of a segment, and the records.
    pub(crate) fn report_with(
        &self,
        segments: &[usize],
        verdict: impl Fn(usize) -> [Violations; 2],
        record: impl Fn(usize, Criterion) -> Record,
    ) -> ShapeReport {
        let mut report = self.blank_report();
        for &i in segments {
            let [open, violated] = verdict(i);
            for criterion in Criterion::ALL {
                let of = Violations::of(criterion);
                if violated.intersects(of) {
                    report.counts[criterion as usize].violated += 1;
                    report.violations.push(record(i, criterion));
                } else if open.intersects(of) {
                    let interval = self.interval(i, open.intersection(of));
                    report.undecided.push(Undecided { segment: i, criterion, interval });
                }
            }
        }
        report
    }

    /// The parameters between which some conditions are asked.
    pub(crate) fn interval(&self, segment: usize, violations: Violations) -> [f64; 2] {
        let [start, end] = [segment, segment + 1].map(|i| self.polygon().parameters()[i]);
        if Violations::AT_START.contains(violations) {
            [start; 2]
        } else if Violations::AT_END.contains(violations) {
            [end; 2]
        } else {
            [start, end]
        }
    }

    /// The report that says how often each criterion applies, and nothing else yet.
    pub(crate) fn blank_report(&self) -> ShapeReport {
        let n = self.required.len();
        let clean = ShapeReport::clean(n, self.criteria, self.applicable(0..n));
        ShapeReport { straight: self.straight.clone(), ..clean }
    }

    /// How many of the segments each criterion applies to, in the order of [`Criterion::ALL`].
    #[must_use]
    pub fn applicable(&self, segments: Range<usize>) -> [usize; Criterion::COUNT] {
        Requirements::count(&self.required[segments])
    }

    #[inline]
    fn geometry(&self, i: usize, &Cubic { legs, chord, far }: &Cubic) -> SegmentGeometry {
        let [p, q] = self.polygon().binormals(i);
        let [before, after] = self.polygon().binormals_beside(i);
        SegmentGeometry::new(legs, chord, [before, p, q, after], far)
    }

    pub(crate) fn cones(&self, i: usize) -> Cones {
        let around = self.polygon().directions_around(i);
        Cones::new(self.polygon(), i, around, self.required[i], &self.tolerances())
    }
}

/// The report on a curve through the points of a polygon, given the end legs of its segments.
pub fn check<L>(
    polygon: &DataPolygon,
    legs: L,
    criteria: Criteria,
    tolerances: Tolerances,
) -> ShapeReport
where
    L: Fn(usize) -> [DVec3; 2] + Sync,
{
    Checker::new(polygon, criteria, tolerances).report(legs)
}

impl Violations {
    /// The violations of a criterion.
    #[must_use]
    pub const fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::Convexity => Self::CONVEXITY_AT_START
                .union(Self::CONVEXITY_AT_END)
                .union(Self::CONVEXITY_BETWEEN),
            Criterion::Inflection => Self::INFLECTION_AT_START.union(Self::INFLECTION_AT_END),
            Criterion::Turning => Self::TURNING_AT_START.union(Self::TURNING_AT_END),
            Criterion::Torsion => Self::TORSION,
            Criterion::Coplanarity => Self::COPLANARITY_AT_START
                .union(Self::COPLANARITY_AT_END)
                .union(Self::COPLANARITY_BETWEEN)
                .union(Self::COPLANARITY_SPLIT),
            Criterion::Collinearity => Self::LINE_AT_START
                .union(Self::LINE_AFTER_START)
                .union(Self::LINE_INSIDE_START)
                .union(Self::LINE_AT_END)
                .union(Self::LINE_BEFORE_END)
                .union(Self::LINE_INSIDE_END),
            Criterion::GlobalConvexity => Self::GLOBAL_CONVEXITY,
            Criterion::Regular => Self::NOT_REGULAR,
        }
    }
}
