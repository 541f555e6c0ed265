//! The checker: what a polygon calls for, held against segments.

use std::ops::Range;

use glam::DVec3;
use shapespline_geometry::DataPolygon;

use crate::{
    Calls, Criteria, Criterion, Faults, Record, ShapeReport, StretchChecker, Tolerances,
    WindowChecker,
    faults::{Cones, Situation, faults},
    margin, regular,
};

/// The shape criteria of one data polygon.
#[derive(Debug, Clone)]
pub struct Checker<'a> {
    local: StretchChecker<'a>,
    criteria: Criteria,
    calls: Vec<Calls>,
}

impl<'a> Checker<'a> {
    /// Finds out what each segment of the polygon calls for among `criteria`. Cost O(N).
    #[must_use]
    pub fn new(polygon: &'a DataPolygon, criteria: Criteria, tolerances: Tolerances) -> Self {
        let local = StretchChecker::new(polygon, criteria, tolerances);
        Self { local, criteria, calls: local.all_calls() }
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

    /// What each segment calls for.
    #[must_use]
    pub fn calls(&self) -> &[Calls] {
        &self.calls
    }

    /// The exact verdict on a segment with end legs `a, c`: which conditions fail.
    #[inline]
    #[must_use]
    pub fn faults(&self, segment: usize, legs: [DVec3; 2]) -> Faults {
        let calls = self.calls[segment];
        if calls.is_empty() {
            return Faults::default();
        }
        faults(&self.situation(segment, legs), calls, || self.cones(segment))
    }

    /// The segments that fail, ascending, with their faults. Cost O(N), on all threads for long
    /// curves.
    pub fn all_faults<L>(&self, legs: L) -> Vec<(usize, Faults)>
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        self.in_windows().all_faults(legs)
    }

    /// This checker, for those who ask of many segments and come back to the same ones.
    #[must_use]
    pub fn in_windows(&self) -> WindowChecker<'_> {
        WindowChecker::new(self.local, Some(&self.calls))
    }

    /// The record of one criterion on a segment: verdict, margin and place.
    #[must_use]
    pub fn record(&self, segment: usize, legs: [DVec3; 2], criterion: Criterion) -> Record {
        let calls = self.calls[segment];
        let applicable = calls.any(Calls::of(criterion));
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
        let s = self.situation(segment, legs);
        let margin = match criterion {
            Criterion::Convexity => margin::convexity(&s),
            Criterion::Inflection => margin::inflection(&s),
            Criterion::Turning => margin::turning(&s, calls),
            Criterion::Torsion => margin::torsion(&s, calls),
            Criterion::Coplanarity => margin::coplanarity(&s, calls, &self.cones(segment)),
            Criterion::Collinearity => margin::collinearity(&s, calls, &self.cones(segment)),
            Criterion::GlobalConvexity => margin::global_convexity(&s),
            Criterion::Regular => regular::margin(&s, calls),
        };
        record.satisfied = !self.faults(segment, legs).any(Faults::of(criterion));
        record.margin = margin.value;
        record.location =
            self.polygon().parameters()[segment] + margin.at * self.polygon().spacing(segment);
        record
    }

    /// The report on a curve, segment by segment. Memory follows the violations.
    pub fn report<L>(&self, legs: L) -> ShapeReport
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        self.report_of(&self.all_faults(&legs), legs)
    }

    /// The report that belongs to faults already found (by [`Checker::all_faults`]).
    pub fn report_of<L>(&self, faults: &[(usize, Faults)], legs: L) -> ShapeReport
    where
        L: Fn(usize) -> [DVec3; 2],
    {
        self.report_with(faults, |i, criterion| self.record(i, legs(i), criterion))
    }

    /// The same, given the records.
    pub(crate) fn report_with(
        &self,
        faults: &[(usize, Faults)],
        record: impl Fn(usize, Criterion) -> Record,
    ) -> ShapeReport {
        let mut report = self.blank_report();
        for &(i, faults) in faults {
            for criterion in Criterion::ALL {
                if faults.any(Faults::of(criterion)) {
                    report.counts[criterion as usize].violated += 1;
                    report.violations.push(record(i, criterion));
                }
            }
        }
        report
    }

    /// The report that says how often each criterion applies, and nothing else yet.
    pub(crate) fn blank_report(&self) -> ShapeReport {
        let n = self.calls.len();
        ShapeReport::clean(n, self.criteria, self.applicable(0..n))
    }

    /// How many of the segments each criterion applies to, in the order of [`Criterion::ALL`].
    #[must_use]
    pub fn applicable(&self, segments: Range<usize>) -> [usize; Criterion::COUNT] {
        Calls::count(&self.calls[segments])
    }

    #[inline]
    fn situation(&self, i: usize, legs: [DVec3; 2]) -> Situation {
        let [p, q] = self.polygon().binormals(i);
        let [before, after] = self.polygon().binormals_beside(i);
        Situation::new(legs, self.polygon().chord(i), [before, p, q, after])
    }

    pub(crate) fn cones(&self, i: usize) -> Cones {
        let around = self.polygon().directions_around(i);
        Cones::new(self.polygon(), i, around, self.calls[i], &self.tolerances())
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

impl Faults {
    /// The faults of a criterion.
    #[must_use]
    pub const fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::Convexity => {
                Self::CONVEXITY_AT_START.and(Self::CONVEXITY_AT_END).and(Self::CONVEXITY_BETWEEN)
            }
            Criterion::Inflection => Self::INFLECTION_AT_START.and(Self::INFLECTION_AT_END),
            Criterion::Turning => Self::TURNING_AT_START.and(Self::TURNING_AT_END),
            Criterion::Torsion => Self::TORSION,
            Criterion::Coplanarity => Self::COPLANARITY_AT_START
                .and(Self::COPLANARITY_AT_END)
                .and(Self::COPLANARITY_BETWEEN)
                .and(Self::COPLANARITY_SPLIT),
            Criterion::Collinearity => Self::LINE_AT_START
                .and(Self::LINE_AFTER_START)
                .and(Self::LINE_INSIDE_START)
                .and(Self::LINE_AT_END)
                .and(Self::LINE_BEFORE_END)
                .and(Self::LINE_INSIDE_END),
            Criterion::GlobalConvexity => Self::GLOBAL_CONVEXITY,
            Criterion::Regular => Self::NOT_REGULAR,
        }
    }
}
