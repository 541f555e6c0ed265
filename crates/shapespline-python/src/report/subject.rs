// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a report is about: one of our curves, or points and a curve made elsewhere.

use std::sync::Arc;

use shapespline::{
    criteria::{
        Checker, Criterion, CurveChecker, CurveError, INTERPOLATION, NodeConditions, Record,
        ShapeReport,
    },
    geometry::{DVec3, DataPolygon, InputMap, PiecewiseBezier},
};

use crate::{
    asked::Asked,
    curve::{Fitted, in_input},
    work::GoOn,
};

/// A curve beside the points that it has to follow.
#[derive(Clone)]
pub(crate) enum Subject {
    /// A curve with the points it was made for.
    Own(Arc<Fitted>),
    /// Points, and any curve through them.
    Other {
        polygon: Arc<DataPolygon>,
        curve: Arc<PiecewiseBezier>,
        /// Where the points stand in the input.
        map: Arc<InputMap>,
        /// How far from the points the curve may pass, over their extent.
        interpolation: f64,
        /// The nodes at which the curve is to have corners: nothing is asked there.
        corners: Vec<usize>,
        /// The segments on which it is straight by construction.
        straight: Vec<usize>,
    },
}

/// A checker of either kind, for a while. Its records have the segments of the input.
pub(crate) enum Judge<'a> {
    Own(Checker<'a>, &'a [[DVec3; 2]], &'a Fitted),
    Other(CurveChecker<'a>, &'a InputMap),
}

impl Judge<'_> {
    /// The report; none after Ctrl-C.
    pub(crate) fn report(&self, go_on: GoOn<'_>) -> Option<ShapeReport> {
        Some(match self {
            Self::Own(checker, legs, curve) => curve.with_locations(checker.report(|i| legs[i])),
            Self::Other(checker, map) => {
                let mut report = checker.report_with(go_on)?;
                report.violations.iter_mut().for_each(|r| r.segment = map.segment(r.segment));
                report.undecided.iter_mut().for_each(|r| r.segment = map.segment(r.segment));
                report.straight.iter_mut().for_each(|i| *i = map.segment(*i));
                report
            }
        })
    }

    pub(crate) fn record(&self, segment: usize, criterion: Criterion) -> Record {
        match self {
            Self::Own(checker, legs, curve) => {
                curve.located(checker.record(segment, legs[segment], criterion))
            }
            Self::Other(checker, map) => {
                let record = checker.record(segment, criterion);
                Record { segment: map.segment(segment), ..record }
            }
        }
    }

    /// The notes; none after Ctrl-C.
    pub(crate) fn node_conditions(&self, go_on: GoOn<'_>) -> Option<NodeConditions> {
        Some(match self {
            Self::Own(checker, legs, curve) => {
                curve.with_places(checker.node_conditions_with(|i| legs[i], go_on)?)
            }
            Self::Other(checker, map) => in_input(map, checker.node_conditions_with(go_on)?),
        })
    }
}

/// The error with the indices of the input.
fn placed(map: &InputMap, error: CurveError) -> CurveError {
    match error {
        CurveError::Input(error) => CurveError::Input(map.in_input(error)),
        CurveError::Mismatch { point, parameter, distance, allowed } => {
            CurveError::Mismatch { point: map.node(point), parameter, distance, allowed }
        }
        CurveError::Domain { index, value, start, end } => {
            CurveError::Domain { index: map.node(index), value, start, end }
        }
        other => other,
    }
}

impl Subject {
    pub(crate) fn segments(&self) -> usize {
        match self {
            Self::Own(curve) => curve.count() - 1,
            Self::Other { polygon, .. } => polygon.segments(),
        }
    }

    /// Runs work with the checker of the subject.
    ///
    /// # Errors
    /// A curve that the points do not fit.
    pub(crate) fn judge<T>(
        &self,
        asked: Asked,
        work: impl FnOnce(Judge<'_>) -> T,
    ) -> Result<T, CurveError> {
        let (criteria, tolerances) = (asked.to_check(), asked.tolerances);
        match self {
            Self::Own(curve) => {
                let polygon = curve.polygon();
                let broken = |nodes: &[usize]| nodes.len() < curve.cubic().knots().len();
                let special = !curve.corners().is_empty() || !curve.straight().is_empty();
                if curve.nodes().is_some_and(broken) || special {
                    // Several pieces per segment, corners or straight runs: decided piece by piece.
                    let pieces = PiecewiseBezier::from(curve.cubic());
                    return CurveChecker::new(
                        polygon,
                        &pieces,
                        criteria,
                        tolerances,
                        INTERPOLATION,
                    )
                    .map(|checker| {
                        checker
                            .with_free_nodes(curve.corners())
                            .with_straight_segments(curve.straight(), curve.corners())
                    })
                    .map(|checker| work(Judge::Other(checker, &curve.map)))
                    .map_err(|error| placed(&curve.map, error));
                }
                let checker = Checker::new(polygon, criteria, tolerances);
                Ok(work(Judge::Own(checker, curve.cubic().legs(), curve)))
            }
            Self::Other { polygon, curve, map, interpolation, corners, straight } => {
                CurveChecker::new(polygon, curve, criteria, tolerances, *interpolation)
                    .map(|checker| checker.with_free_nodes(corners))
                    .map(|checker| checker.with_straight_segments(straight, corners))
                    .map(|checker| work(Judge::Other(checker, map)))
                    .map_err(|error| placed(map, error))
            }
        }
    }
}
