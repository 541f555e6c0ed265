// SPDX-License-Identifier: MIT OR Apache-2.0

//! The checker for curves that were not made here.

use std::ops::ControlFlow;

use glam::DVec3;
use shapespline_geometry::{DataPolygon, InputError, PiecewiseBezier, length};
use shapespline_polynomial::{Sign, parallel};

use super::{
    Question, Segment,
    corner::Beyond,
    error::CurveError,
    margin, prove_sign,
    single_pieces::{Single, single_pieces},
};
use crate::{
    Checker, Criteria, Criterion, NodeConditions, Record, ShapeReport, Tolerances, Undecided,
    Violations, checker::Cubic, node_conditions::node_conditions, rounding::LEG_ERROR,
};

/// Segments from on which they are checked on all threads.
const MANY: usize = 8192;

/// How far from the points a curve may pass by default, over the extent of the points.
pub const INTERPOLATION: f64 = 1e-9;

/// The shape criteria of a data polygon, held against any piecewise Bézier curve through its points.
///
/// Segments that are one cubic take the way of [`Checker`], the others that of certified subdivision.
#[derive(Debug, Clone)]
pub struct CurveChecker<'a> {
    checker: Checker<'a>,
    pub(super) curve: &'a PiecewiseBezier,
    /// The piece that each segment is, where it is one.
    pub(super) single: Single,
}

impl<'a> CurveChecker<'a> {
    /// Makes sure that the curve passes through the points at their parameters, to a distance of
    /// `interpolation` (see [`INTERPOLATION`]) times the extent of the points.
    ///
    /// # Errors
    /// Tolerances outside their range; another dimension; parameters outside the curve's domain; a
    /// curve that misses a point, or jumps.
    pub fn new(
        polygon: &'a DataPolygon,
        curve: &'a PiecewiseBezier,
        criteria: Criteria,
        tolerances: Tolerances,
        interpolation: f64,
    ) -> Result<Self, CurveError> {
        if !(interpolation >= 0.0) {
            let (argument, value) = ("interpolation", interpolation);
            return Err(InputError::Scalar { argument, value, allowed: "non-negative" }.into());
        }
        let dimensions = [polygon.dimension().count(), curve.dimension().count()];
        if dimensions[0] != dimensions[1] {
            let [points, curve] = dimensions;
            return Err(CurveError::Dimension { points, curve });
        }
        let checker = Checker::new(polygon, criteria, tolerances.validate()?);
        let single = single_pieces(polygon.parameters(), curve.breaks())?;
        let checked = Self { checker, curve, single };
        checked.check_position(interpolation)?;
        Ok(checked)
    }

    /// Asks for nothing at some nodes: where the curve is to have corners.
    #[must_use]
    pub fn with_free_nodes(self, nodes: &[usize]) -> Self {
        Self { checker: self.checker.with_free_nodes(nodes), ..self }
    }

    /// Takes some segments to be straight by construction, as [`Checker::with_straight_segments`].
    #[must_use]
    pub fn with_straight_segments(self, segments: &[usize], free: &[usize]) -> Self {
        Self { checker: self.checker.with_straight_segments(segments, free), ..self }
    }

    /// The criteria's own checker: what the polygon requires.
    #[must_use]
    pub fn checker(&self) -> &Checker<'a> {
        &self.checker
    }

    /// The report. Cost O(N); memory follows the violations and the open questions.
    #[must_use]
    pub fn report(&self) -> ShapeReport {
        let report = self.report_with(&|| ControlFlow::Continue(()));
        report.unwrap_or_else(|| self.checker.blank_report())
    }

    /// As [`CurveChecker::report`], but calls `go_on` before each segment that is not one cubic (from any
    /// thread), and returns `None` once that breaks.
    #[must_use]
    pub fn report_with(&self, go_on: &(dyn Fn() -> ControlFlow<()> + Sync)) -> Option<ShapeReport> {
        let of = |&i: &usize| match self.cubic(i) {
            Some(cubic) => Some(self.check_cubic(i, &cubic)),
            None => go_on().is_continue().then(|| self.check_segment(i)),
        };
        let open = self.open_segments();
        let found: Option<Vec<Scan>> = parallel::map(open.len(), MANY, |k| of(&open[k]));
        let mut report = self.checker.blank_report();
        for Scan { records, undecided } in found? {
            for record in &records {
                report.counts[record.criterion as usize].violated += 1;
            }
            report.violations.extend(records);
            report.undecided.extend(undecided);
        }
        Some(report)
    }

    /// The record of one criterion on a segment. Where the question stays open the record says
    /// unsatisfied with margin zero, and [`CurveChecker::undecided`] has the interval.
    #[must_use]
    pub fn record(&self, segment: usize, criterion: Criterion) -> Record {
        if let Some(cubic) = self.cubic(segment) {
            let record = self.checker.record_of(segment, &cubic, criterion);
            return self.with_corners(record);
        }
        let mut record = Record {
            segment,
            criterion,
            applicable: false,
            satisfied: true,
            margin: f64::NAN,
            location: f64::NAN,
        };
        let Some(question) = self.checker.question(segment, criterion) else { return record };
        let pieces = self.segment(segment);
        let sign = self.verdict(segment, &pieces, &question);
        let measured = margin(&pieces, &question);
        record.applicable = true;
        record.satisfied = sign == Sign::Positive;
        // The proof decides on which side of zero the margin lies.
        let (margin, at) = match sign {
            Sign::Positive => (measured.value.max(f64::MIN_POSITIVE), measured.at),
            Sign::Fails { at } if measured.value > 0.0 => (0.0, at),
            Sign::Fails { .. } => (measured.value, measured.at),
            Sign::Undecided { from, to } => (0.0, 0.5 * (from + to)),
        };
        (record.margin, record.location) = (margin, self.parameter(segment, at));
        self.with_corners(record)
    }

    /// What stays open of a criterion on a segment.
    #[must_use]
    pub fn undecided(&self, segment: usize, criterion: Criterion) -> Option<Undecided> {
        if let Some(cubic) = self.cubic(segment) {
            let (of, [open, violated]) =
                (Violations::of(criterion), self.cubic_verdict(segment, &cubic));
            let interval = self.checker.interval(segment, open.intersection(of));
            let is_open = open.intersects(of) && !violated.intersects(of);
            return is_open.then_some(Undecided { segment, criterion, interval });
        }
        let question = self.checker.question(segment, criterion)?;
        match self.verdict(segment, &self.segment(segment), &question) {
            Sign::Undecided { from, to } => {
                let interval = [self.parameter(segment, from), self.parameter(segment, to)];
                Some(Undecided { segment, criterion, interval })
            }
            _ => None,
        }
    }

    /// What the paper says of nodes and of oscillation, as information.
    #[must_use]
    pub fn node_conditions(&self) -> NodeConditions {
        self.node_conditions_with(&|| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// As [`CurveChecker::node_conditions`], but calls `go_on` before each node and segment, and
    /// returns `None` once that breaks.
    #[must_use]
    pub fn node_conditions_with(
        &self,
        go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Option<NodeConditions> {
        node_conditions(&self.checker, |i| self.segment(i), go_on)
    }

    fn check_segment(&self, i: usize) -> Scan {
        let mut found = Scan::default();
        let required = self.checker.requirements()[i];
        if required.is_empty() {
            return found;
        }
        if self.is_proved(i) {
            return found;
        }
        let pieces = self.segment(i);
        for criterion in required.criteria().iter() {
            let Some(question) = self.checker.question(i, criterion) else { continue };
            match self.verdict(i, &pieces, &question) {
                Sign::Positive => {}
                Sign::Fails { .. } => found.records.push(self.record(i, criterion)),
                Sign::Undecided { from, to } => {
                    let interval = [self.parameter(i, from), self.parameter(i, to)];
                    found.undecided.push(Undecided { segment: i, criterion, interval });
                }
            }
        }
        found
    }

    /// The verdict on a segment, corners at its ends included.
    fn verdict(&self, i: usize, pieces: &Segment, question: &Question) -> Sign {
        let sign = prove_sign(pieces, question);
        if question.criterion != Criterion::Turning {
            return sign;
        }
        [0, 1].into_iter().fold(sign, |sign, end| {
            let at = end as f64;
            sign.and(match self.beyond_chord(i, end, pieces.end_tangent(end)) {
                None => Sign::Positive,
                Some(Beyond { is_certain: true, .. }) => Sign::Fails { at },
                Some(_) => Sign::Undecided { from: at, to: at },
            })
        })
    }

    fn parameter(&self, segment: usize, local: f64) -> f64 {
        let polygon = self.checker.polygon();
        polygon.parameters()[segment] + local * polygon.spacing(segment)
    }

    /// A vector along the tangent at the start (0) or the end (1) of a segment, and what it may be off by.
    pub(super) fn end_tangent(&self, i: usize, end: usize) -> (DVec3, f64) {
        match self.cubic(i) {
            Some(Cubic { legs, far, .. }) => (legs[end], LEG_ERROR * far),
            None => self.segment(i).end_tangent(end),
        }
    }

    fn segment(&self, i: usize) -> Segment {
        let polygon = self.checker.polygon();
        let u = polygon.parameters();
        let origin = polygon.points()[i];
        let parts = self.curve.between([u[i], u[i + 1]], origin);
        Segment::new(&parts, self.curve.is_rational(), length(origin))
            .beside(self.checker.requirements()[i])
    }

    /// Whether the curve passes through the points and does not jump.
    fn check_position(&self, interpolation: f64) -> Result<(), CurveError> {
        let polygon = self.checker.polygon();
        let (points, u) = (polygon.points(), polygon.parameters());
        let first = points[0];
        let (low, high) = points.iter().fold((first, first), |(l, h), p| (l.min(*p), h.max(*p)));
        let largest = low.abs().max(high.abs()).max_element();
        let allowed = interpolation * length(high - low) + 16.0 * f64::EPSILON * largest;
        for i in 0..polygon.segments() {
            if let Some(piece) = self.single(i) {
                // Nothing to cut: the ends of the piece are all there is to compare.
                let p = self.curve.piece(piece);
                let off = |end: usize, k: usize| (p[k].truncate() / p[k].w - points[end]).length();
                if off(i, 0) <= allowed && off(i + 1, p.len() - 1) <= allowed {
                    continue;
                }
            }
            let parts = self.curve.between([u[i], u[i + 1]], points[i]);
            let at = |part: usize, last: bool| {
                let control = &parts[part].control;
                let p = control[if last { control.len() - 1 } else { 0 }];
                p.truncate() / p.w
            };
            let miss = |point: usize, distance: f64| {
                let parameter = u[point];
                // Written so that a NaN fails.
                if distance <= allowed {
                    return Ok(());
                }
                Err(CurveError::Mismatch { point, parameter, distance, allowed })
            };
            if parts.is_empty() {
                return miss(i, f64::NAN);
            }
            miss(i, length(at(0, false)))?;
            miss(i + 1, length(at(parts.len() - 1, true) - polygon.chord(i)))?;
            for k in 1..parts.len() {
                let distance = length(at(k, false) - at(k - 1, true));
                if !(distance <= allowed) {
                    let parameter = self.parameter(i, parts[k].local[0]);
                    return Err(CurveError::Jump { parameter, distance, allowed });
                }
            }
        }
        Ok(())
    }
}

#[derive(Debug, Default)]
pub(super) struct Scan {
    pub(super) records: Vec<Record>,
    pub(super) undecided: Vec<Undecided>,
}

/// The report on any piecewise Bézier curve through the points of a polygon.
///
/// # Errors
/// As [`CurveChecker::new`].
pub fn check_curve(
    polygon: &DataPolygon,
    curve: &PiecewiseBezier,
    criteria: Criteria,
    tolerances: Tolerances,
) -> Result<ShapeReport, CurveError> {
    Ok(CurveChecker::new(polygon, curve, criteria, tolerances, INTERPOLATION)?.report())
}
