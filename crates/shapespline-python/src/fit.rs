//! From the arguments of a family's constructors to its curve, or to the exception.

use std::sync::Arc;

use pyo3::prelude::*;
use shapespline::{
    criteria::{self, Criteria, Criterion, Tolerances},
    geometry::{DataPolygon, InputMap, InputPoints, Repeated},
    search::{Diagnostics, Fit, FitError, Outcome, SearchOptions, Status, Strategy},
};

use crate::{
    asked::Asked,
    curve::{Fitted, Member, SpaceCurve},
    diagnostics::Search,
    error::{convergence_error, fit_error},
    input::Points,
    options::{CriteriaNames, Ends, Parameters, tolerances},
    report::{ShapeReport, Subject},
    work::{GoOn, detached, interruptible},
};

/// What every curve is made from.
pub(crate) struct CurveInput(pub(crate) InputPoints);

impl CurveInput {
    pub(crate) fn new(
        points: Points,
        parameters: Parameters,
        boundary: Ends,
        closed: bool,
        repeated: Repeated,
    ) -> PyResult<Self> {
        let Points { points, dimension } = points;
        let boundary = boundary.of(dimension, closed)?;
        let parametrization = parameters.0;
        Ok(Self(InputPoints { points, dimension, parametrization, boundary, closed, repeated }))
    }

    /// Makes something of the polygon; errors have indices of the input.
    fn make<T>(
        self,
        make: impl FnOnce(DataPolygon, InputMap) -> Result<T, FitError>,
    ) -> Result<T, FitError> {
        let (polygon, map) = self.0.polygon()?;
        let places = map.clone();
        make(polygon, map).map_err(|error| match error {
            FitError::Input(error) => FitError::Input(places.in_input(error)),
            other => other,
        })
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
        resolution: f64,
        coplanarity: f64,
        collinearity: f64,
        tolerance: f64,
    ) -> PyResult<SearchOptions> {
        let Self { criteria, strategy, step, max_iterations } = self;
        let tolerances = tolerances(resolution, coplanarity, collinearity, tolerance)?;
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
    input: CurveInput,
    make: impl FnOnce(DataPolygon, &InputMap) -> Result<C, FitError> + Send,
) -> PyResult<SpaceCurve> {
    let (size, repeated) = (input.0.points.len(), input.0.repeated);
    let made = detached(py, size, || {
        input.make(|polygon, map| Ok(Made::built(make(polygon, &map)?, map, repeated)))
    });
    Ok(made.map_err(fit_error)?.curve)
}

/// The shape-preserving curve, or the exception that carries the last one.
pub(crate) fn preserve<C: Member>(
    py: Python<'_>,
    input: CurveInput,
    request: &Request,
    search: impl FnOnce(DataPolygon, GoOn<'_>) -> Result<Fit<C>, FitError> + Send,
) -> PyResult<Py<PyAny>> {
    let (size, repeated) = (input.0.points.len(), input.0.repeated);
    let fit = |go_on: GoOn<'_>| {
        input.make(|polygon, map| {
            Ok(Made::searched(search(polygon, go_on)?, request, map, repeated))
        })
    };
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
    unsolved: Option<Box<(Diagnostics, criteria::ShapeReport)>>,
}

impl Made {
    /// A curve of given tension.
    pub(crate) fn built<C: Member>(curve: C, map: InputMap, repeated: Repeated) -> Self {
        let curve = Arc::new(Fitted::new(curve, map, repeated));
        Self { curve: SpaceCurve::of(curve, None), unsolved: None }
    }

    /// A curve that was searched for.
    pub(crate) fn searched<C: Member>(
        fit: Fit<C>,
        request: &Request,
        map: InputMap,
        repeated: Repeated,
    ) -> Self {
        let Fit { curve, outcome, report } = fit;
        let Outcome { diagnostics, history, .. } = outcome;
        let solved = diagnostics.status == Status::Solved;
        let unsolved = (!solved).then(|| Box::new((diagnostics, report)));
        let search = Search { diagnostics, history, asked: request.asked };
        let curve = Arc::new(Fitted::new(curve, map, repeated));
        Self { curve: SpaceCurve::of(curve, Some(search)), unsolved }
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
        let (Diagnostics { status, iterations, .. }, report) = *unsolved;
        let violations: Vec<String> = Criterion::ALL
            .iter()
            .map(|&criterion| (report.count(criterion).violated, criterion.name()))
            .filter(|(violated, _)| *violated > 0)
            .map(|(violated, name)| format!("{name} on {violated}"))
            .collect();
        let whose = index.map_or_else(String::new, |k| format!("curve {k}: "));
        let message = format!(
            "{whose}the shape is not preserved after {iterations} iterations: of {} segments, {} violate it; \
             {} (this exception carries the last curve and its report)",
            report.segments,
            violations.join(", "),
            if status == Status::IterationLimit { "raise max_iterations" } else { request.advice },
        );
        let curve = Arc::clone(&self.curve.curve);
        let report = curve.with_locations(report);
        let subject = Subject::Own(curve);
        let report = ShapeReport::of(report, subject, request.asked);
        let report = Py::new(py, report)?.into_any();
        Err(convergence_error(py, message, self.curve.into_python(py)?, report))
    }
}
