//! What a report is about: one of our curves, or points and a curve made elsewhere.

use std::sync::Arc;

use shapespline::{
    criteria::{
        Checker, Criterion, CurveChecker, CurveError, INTERPOLATION, Notes, Record, ShapeReport,
    },
    geometry::{DVec3, DataPolygon, PiecewiseBezier},
};

use crate::{asked::Asked, curve::Curve};

/// A curve beside the points that it has to follow.
#[derive(Clone)]
pub(crate) enum Subject {
    /// A curve with the points it was made for.
    Own(Arc<dyn Curve>),
    /// Points, and any curve through them.
    Other {
        polygon: Arc<DataPolygon>,
        curve: Arc<PiecewiseBezier>,
        /// How far from the points the curve may pass, over their extent.
        interpolation: f64,
    },
}

/// A checker of either kind, for a while.
pub(crate) enum Judge<'a> {
    Own(Checker<'a>, &'a [[DVec3; 2]], &'a dyn Curve),
    Other(CurveChecker<'a>),
}

impl Judge<'_> {
    pub(crate) fn report(&self) -> ShapeReport {
        match self {
            Self::Own(checker, legs, curve) => curve.with_locations(checker.report(|i| legs[i])),
            Self::Other(checker) => checker.report(),
        }
    }

    pub(crate) fn record(&self, segment: usize, criterion: Criterion) -> Record {
        match self {
            Self::Own(checker, legs, curve) => {
                curve.located(checker.record(segment, legs[segment], criterion))
            }
            Self::Other(checker) => checker.record(segment, criterion),
        }
    }

    pub(crate) fn notes(&self) -> Notes {
        match self {
            Self::Own(checker, legs, curve) => {
                let mut notes = checker.notes(|i| legs[i]);
                let nodes = notes.nodes.iter_mut().map(|record| &mut record.location);
                let segments = notes.oscillations.iter_mut().map(|record| &mut record.location);
                nodes.chain(segments).for_each(|u| *u = curve.own_parameter(*u));
                notes
            }
            Self::Other(checker) => checker.notes(),
        }
    }
}

impl Subject {
    pub(crate) fn segments(&self) -> usize {
        match self {
            Self::Own(curve) => curve.points() - 1,
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
                let polygon = curve.polygon()?;
                if curve.nodes().is_some() {
                    // Several pieces per segment: decided piece by piece.
                    let pieces = PiecewiseBezier::from(curve.cubic());
                    return CurveChecker::new(
                        &polygon,
                        &pieces,
                        criteria,
                        tolerances,
                        INTERPOLATION,
                    )
                    .map(|checker| work(Judge::Other(checker)));
                }
                let checker = Checker::new(&polygon, criteria, tolerances);
                Ok(work(Judge::Own(checker, curve.cubic().legs(), curve.as_ref())))
            }
            Self::Other { polygon, curve, interpolation } => {
                CurveChecker::new(polygon, curve, criteria, tolerances, *interpolation)
                    .map(|checker| work(Judge::Other(checker)))
            }
        }
    }
}
