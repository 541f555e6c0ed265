//! From the arguments of a family's constructors to its curve, or to the exception.

use std::sync::Arc;

use pyo3::prelude::*;
use shapespline::{
    criteria::{Criteria, Criterion, Tolerances},
    geometry::{Boundary, DVec3, DataPolygon, Dimension, InputError, Parametrization},
    search::{Fit, FitError, SearchOptions, Status, Strategy},
};

use crate::{
    curve::{Curve, Member, SpaceCurve},
    diagnostics::Search,
    error::{convergence_error, fit_error},
    input::Points,
    options::{CriteriaNames, Ends, Parameters, tolerances},
    report::{ShapeReport, Subject},
    work::{Monitor, detached, interruptible},
};

/// What every curve is made from.
pub(crate) struct Data {
    pub(crate) points: Vec<DVec3>,
    pub(crate) dimension: Dimension,
    pub(crate) parametrization: Parametrization,
    pub(crate) boundary: Boundary,
}

impl Data {
    pub(crate) fn new(points: Points, parameters: Parameters, boundary: Ends) -> PyResult<Self> {
        let Points { points, dimension } = points;
        let boundary = boundary.of(dimension)?;
        Ok(Self { points, dimension, parametrization: parameters.0, boundary })
    }

    fn polygon(self) -> Result<DataPolygon, InputError> {
        let Self { points, dimension, parametrization, boundary } = self;
        DataPolygon::with_dimension(points, dimension, &parametrization, boundary)
    }
}

/// The options of the tension search, as the families take them.
pub(crate) struct Searching {
    pub(crate) criteria: CriteriaNames,
    pub(crate) strategy: Strategy,
    pub(crate) step: f64,
    pub(crate) max_iterations: Option<usize>,
}

impl Searching {
    pub(crate) fn options(
        self,
        coplanarity: f64,
        collinearity: f64,
        tolerance: f64,
    ) -> PyResult<SearchOptions> {
        let Self { criteria, strategy, step, max_iterations } = self;
        let tolerances = tolerances(coplanarity, collinearity, tolerance)?;
        Ok(SearchOptions { criteria: criteria.0, tolerances, strategy, step, max_iterations })
    }
}

/// The curve of given tension.
pub(crate) fn build<C: Member>(
    py: Python<'_>,
    data: Data,
    make: impl FnOnce(DataPolygon) -> Result<C, FitError> + Send,
) -> PyResult<SpaceCurve> {
    let curve = detached(py, data.points.len(), || make(data.polygon()?)).map_err(fit_error)?;
    Ok(SpaceCurve::of(Arc::new(curve), None))
}

/// The shape-preserving curve, or the exception that carries the last one.
pub(crate) fn preserve<C: Member>(
    py: Python<'_>,
    data: Data,
    failure: &Failure,
    search: impl FnOnce(DataPolygon, Monitor<'_>) -> Result<Fit<C>, FitError> + Send,
) -> PyResult<Py<PyAny>> {
    let fit = interruptible(py, data.points.len(), |monitor| search(data.polygon()?, monitor))?
        .map_err(fit_error)?;
    finish(py, fit, failure, "")
}

/// What the report of a failure must know.
pub(crate) struct Failure {
    pub(crate) criteria: Criteria,
    pub(crate) tolerances: Tolerances,
    /// What the caller can do.
    advice: &'static str,
}

impl From<&SearchOptions> for Failure {
    fn from(options: &SearchOptions) -> Self {
        let SearchOptions { criteria, tolerances, .. } = *options;
        Self { criteria, tolerances, advice: "raise max_iterations" }
    }
}

impl Failure {
    /// Of Catmull–Rom handles, whose search has no limit that the caller sets.
    pub(crate) fn of_handles(criteria: Criteria, tolerances: Tolerances) -> Self {
        let advice = "widen coplanarity or collinearity, or leave out a criterion";
        Self { criteria, tolerances, advice }
    }
}

/// The curve of a fit that ended well, or the exception that carries it; `whose` begins its message.
pub(crate) fn finish<C: Member>(
    py: Python<'_>,
    fit: Fit<C>,
    failure: &Failure,
    whose: &str,
) -> PyResult<Py<PyAny>> {
    let Fit { curve, outcome, report } = fit;
    let (status, iterations) = (outcome.diagnostics.status, outcome.diagnostics.iterations);
    let search = Search { diagnostics: outcome.diagnostics, history: outcome.history };
    let base = SpaceCurve::of(Arc::new(curve), Some(search));
    if status == Status::Solved {
        return base.into_python(py);
    }
    let violations: Vec<String> = Criterion::ALL
        .iter()
        .map(|&criterion| (report.count(criterion).violated, criterion.name()))
        .filter(|(violated, _)| *violated > 0)
        .map(|(violated, name)| format!("{name} on {violated}"))
        .collect();
    let message = format!(
        "{whose}the shape is not preserved after {iterations} iterations: of {} segments, {} violate it; \
         {} (this exception carries the last curve and its report)",
        report.segments,
        violations.join(", "),
        failure.advice,
    );
    let curve: Arc<dyn Curve> = Arc::clone(&base.curve);
    let report = curve.with_locations(report);
    let subject = Subject::Own(curve);
    let report = ShapeReport::of(report, subject, failure.criteria, failure.tolerances);
    let report = Py::new(py, report)?.into_any();
    Err(convergence_error(py, message, base.into_python(py)?, report))
}
