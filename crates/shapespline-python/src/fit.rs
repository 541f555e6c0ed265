//! From the arguments of a family's constructors to its curve, or to the exception.

use std::sync::Arc;

use pyo3::prelude::*;
use shapespline::{
    criteria::{self, Criteria, Criterion, Tolerances},
    fair::{self, FairOptions},
    geometry::{Boundary, DVec3, DataPolygon, Dimension, InputError, Parametrization},
    search::{Fit, FitError, Outcome, SearchOptions, Status, Strategy},
};

use crate::{
    asked::Asked,
    curve::{Curve, Member, SpaceCurve},
    diagnostics::{Search, Work},
    error::{convergence_error, fit_error},
    input::Points,
    options::{CriteriaNames, Ends, Parameters, tolerances},
    report::{ShapeReport, Subject},
    work::{GoOn, detached, interruptible},
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
        Ok(SearchOptions {
            criteria: criteria.or(Criteria::OF_FITS),
            tolerances,
            strategy,
            step,
            max_iterations,
        })
    }
}

/// The curve of given tension.
pub(crate) fn build<C: Member>(
    py: Python<'_>,
    data: Data,
    make: impl FnOnce(DataPolygon) -> Result<C, FitError> + Send,
) -> PyResult<SpaceCurve> {
    let size = data.points.len();
    let made = detached(py, size, || Ok(Made::built(make(data.polygon()?)?)));
    Ok(made.map_err(fit_error)?.curve)
}

/// The shape-preserving curve, or the exception that carries the last one.
pub(crate) fn preserve<C: Member>(
    py: Python<'_>,
    data: Data,
    request: &Request,
    search: impl FnOnce(DataPolygon, GoOn<'_>) -> Result<Fit<C>, FitError> + Send,
) -> PyResult<Py<PyAny>> {
    let size = data.points.len();
    let fit = |go_on: GoOn<'_>| Ok(Made::searched(search(data.polygon()?, go_on)?, request));
    interruptible(py, size, fit)?.map_err(fit_error)?.into_python(py, request, None)
}

/// What a shape-preserving fit is asked for.
pub(crate) struct Request {
    pub(crate) asked: Asked,
    /// What the caller can do where tension can rise no further.
    advice: &'static str,
}

impl From<&SearchOptions> for Request {
    fn from(options: &SearchOptions) -> Self {
        let SearchOptions { criteria, tolerances, strategy, .. } = *options;
        let advice = match strategy {
            Strategy::Nussp | Strategy::Reduction => "use strategy=\"fairest\"",
            Strategy::Growth | Strategy::Fairest => ASK_FOR_LESS,
        };
        Self { asked: Asked::of_fit(criteria, tolerances), advice }
    }
}

const ASK_FOR_LESS: &str = "widen coplanarity or collinearity, or leave out a criterion";

impl Request {
    /// Of Catmull–Rom handles.
    pub(crate) fn of_handles(criteria: Criteria, tolerances: Tolerances) -> Self {
        Self { asked: Asked::of_fit(criteria, tolerances), advice: ASK_FOR_LESS }
    }
}

/// A curve as Python is going to see it. It is made by the thread that fitted: what one processor has
/// just written is dear to move by another.
pub(crate) struct Made {
    curve: SpaceCurve,
    /// What a search did that did not end well, and the report on its last curve.
    unsolved: Option<Box<Unsolved>>,
}

/// What is to be said of a search that did not end well.
struct Unsolved {
    iterations: usize,
    /// Whether more of them might help.
    limited: bool,
    report: criteria::ShapeReport,
}

/// The fair curve, or the exception that carries the last one.
pub(crate) fn fair(
    py: Python<'_>,
    data: Data,
    options: &FairOptions,
    request: &Request,
) -> PyResult<SpaceCurve> {
    let size = data.points.len();
    let fit = |go_on: GoOn<'_>| {
        let polygon = data.polygon().map_err(fair::FitError::from)?;
        let fit = fair::FairSpline::fit_with(polygon, options, &mut |_| go_on())?;
        Ok(Made::fair(fit, options.max_iterations.is_some(), request))
    };
    let made = interruptible(py, size, fit)?.map_err(|error: fair::FitError| match error {
        fair::FitError::Input(error) => fit_error(error.into()),
        fair::FitError::Solve(error) => fit_error(error.into()),
    })?;
    if made.unsolved.is_some() {
        made.into_python(py, request, None)?;
        return Err(pyo3::exceptions::PyRuntimeError::new_err("a curve that is not solved"));
    }
    Ok(made.curve)
}

impl Made {
    /// A fair curve.
    fn fair(fit: fair::Fit, limited: bool, request: &Request) -> Self {
        let fair::Fit { curve, diagnostics, history, report } = fit;
        let iterations = diagnostics.iterations;
        let solved = diagnostics.status == fair::Status::Solved;
        let unsolved = (!solved).then(|| Box::new(Unsolved { iterations, limited, report }));
        let search = Search { work: Work::Fair(diagnostics, history), asked: request.asked };
        Self { curve: SpaceCurve::of(Arc::new(curve), Some(search)), unsolved }
    }

    /// A curve of given tension.
    pub(crate) fn built<C: Member>(curve: C) -> Self {
        Self { curve: SpaceCurve::of(Arc::new(curve), None), unsolved: None }
    }

    /// A curve that was searched for.
    pub(crate) fn searched<C: Member>(fit: Fit<C>, request: &Request) -> Self {
        let Fit { curve, outcome, report } = fit;
        let Outcome { diagnostics, history, .. } = outcome;
        let solved = diagnostics.status == Status::Solved;
        let limited = diagnostics.status == Status::IterationLimit;
        let iterations = diagnostics.iterations;
        let unsolved = (!solved).then(|| Box::new(Unsolved { iterations, limited, report }));
        let search = Search { work: Work::Tension(diagnostics, history), asked: request.asked };
        Self { curve: SpaceCurve::of(Arc::new(curve), Some(search)), unsolved }
    }

    /// The object of the family's class, or the exception that carries it: its message begins with the
    /// index of one curve among many.
    pub(crate) fn into_python(
        self,
        py: Python<'_>,
        request: &Request,
        index: Option<usize>,
    ) -> PyResult<Py<PyAny>> {
        let Some(unsolved) = self.unsolved else { return self.curve.into_python(py) };
        let Unsolved { iterations, limited, report } = *unsolved;
        let violations: Vec<String> = Criterion::ALL
            .iter()
            .map(|&criterion| (report.count(criterion).violated, criterion.name()))
            .filter(|(violated, _)| *violated > 0)
            .map(|(violated, name)| format!("{name} on {violated}"))
            .collect();
        // Rounding may hide a sign where none is wrong.
        let failing = if violations.is_empty() {
            format!("{} criteria are undecided", report.undecided.len())
        } else {
            format!("{} violate it", violations.join(", "))
        };
        let whose = index.map_or_else(String::new, |k| format!("curve {k}: "));
        let message = format!(
            "{whose}the shape is not preserved after {iterations} iterations: of {} segments, {failing}; \
             {} (this exception carries the last curve and its report)",
            report.segments,
            if limited { "raise max_iterations" } else { request.advice },
        );
        let curve: Arc<dyn Curve> = Arc::clone(&self.curve.curve);
        let report = curve.with_locations(report);
        let subject = Subject::Own(curve);
        let report = ShapeReport::of(report, subject, request.asked);
        let report = Py::new(py, report)?.into_any();
        Err(convergence_error(py, message, self.curve.into_python(py)?, report))
    }
}
