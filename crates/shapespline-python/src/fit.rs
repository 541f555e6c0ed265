// SPDX-License-Identifier: MIT OR Apache-2.0

//! From the arguments of a family's constructors to its curve, or to the exception.

use std::sync::Arc;

use pyo3::prelude::*;
use shapespline::{
    criteria::{self, Criteria, Criterion, Tolerances},
    fair::{self, FairOptions},
    geometry::{DataPolygon, InputMap, InputPoints, Repeated},
    search::{Fit, FitError, Outcome, SearchOptions, Status, Strategy},
};

use crate::{
    asked::Asked,
    constraints::Given,
    curve::{Curve, Fitted, Member, SpaceCurve},
    diagnostics::{Search, Work},
    error::{convergence_error, fit_error},
    input::Points,
    options::{CriteriaNames, Ends, Parameters, tolerances},
    report::{ShapeReport, Subject},
    work::{GoOn, interruptible, without_gil},
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
pub(crate) struct SearchArguments {
    pub(crate) criteria: CriteriaNames,
    pub(crate) strategy: Strategy,
    pub(crate) step: f64,
    pub(crate) max_iterations: Option<usize>,
}

impl SearchArguments {
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
    let made = without_gil(py, size, || {
        input.make(|polygon, map| Ok(FitOutcome::built(make(polygon, &map)?, map, repeated)))
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
            Ok(FitOutcome::searched(search(polygon, go_on)?, request, map, repeated))
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
    /// Of a family whose fits know no strategy.
    pub(crate) fn without_strategy(criteria: Criteria, tolerances: Tolerances) -> Self {
        Self { asked: Asked::of_fit(criteria, tolerances), advice: ASK_FOR_LESS }
    }
}

/// A curve as Python is going to see it. It is made by the thread that fitted: what one processor has
/// just written is dear to move by another.
pub(crate) struct FitOutcome {
    curve: SpaceCurve,
    /// What a search did that did not end well, and the report on its last curve.
    unsolved: Option<Box<ConvergenceContext>>,
}

/// What is to be said of a search that did not end well.
struct ConvergenceContext {
    iterations: usize,
    /// Whether more of them might help.
    limited: bool,
    report: criteria::ShapeReport,
}

/// The fair curve of a polygon.
pub(crate) fn fit_fair(
    polygon: DataPolygon,
    map: InputMap,
    repeated: Repeated,
    options: &FairOptions,
    request: &Request,
    go_on: GoOn<'_>,
) -> Result<FitOutcome, FitError> {
    let fit = fair::FairSpline::fit_with(polygon, options, &mut |_| go_on());
    let fit = fit.map_err(|error| match error {
        fair::FitError::Input(error) => FitError::Input(error),
        fair::FitError::Solve(error) => FitError::Solve(error),
    })?;
    let fair::Fit { curve, diagnostics, history, report } = fit;
    let iterations = diagnostics.iterations;
    let limited = options.max_iterations.is_some_and(|most| iterations >= most);
    let solved = diagnostics.status == fair::Status::Solved;
    let unsolved = (!solved).then(|| Box::new(ConvergenceContext { iterations, limited, report }));
    let work = Work::Fair(diagnostics, history);
    Ok(FitOutcome::found(curve, work, request, map, repeated, unsolved))
}

/// The fair curve, or the exception that carries the last one.
pub(crate) fn preserve_fair(
    py: Python<'_>,
    input: CurveInput,
    options: FairOptions,
    given: &Given,
    request: &Request,
) -> PyResult<SpaceCurve> {
    // A fair curve has up to three pieces per segment.
    let (size, repeated) = (3 * input.0.points.len(), input.0.repeated);
    let fit = |go_on: GoOn<'_>| {
        input.make(|polygon, map| {
            let options = FairOptions { constraints: given.at_nodes(&polygon, &map)?, ..options };
            fit_fair(polygon, map, repeated, &options, request, go_on)
        })
    };
    let made = interruptible(py, size, fit)?.map_err(fit_error)?;
    match made.unsolved {
        None => Ok(made.curve),
        Some(unsolved) => Err(unsolved.raise(py, made.curve, request, None)?),
    }
}

impl FitOutcome {
    /// A curve that was searched for, and how.
    fn found(
        curve: impl Curve + 'static,
        work: Work,
        request: &Request,
        map: InputMap,
        repeated: Repeated,
        unsolved: Option<Box<ConvergenceContext>>,
    ) -> Self {
        let search = Search { work, asked: request.asked };
        let curve = Arc::new(Fitted::new(curve, map, repeated));
        Self { curve: SpaceCurve::of(curve, Some(search)), unsolved }
    }

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
        let limited = diagnostics.status == Status::IterationLimit;
        let iterations = diagnostics.iterations;
        let unsolved =
            (!solved).then(|| Box::new(ConvergenceContext { iterations, limited, report }));
        let work = Work::Tension(diagnostics, history);
        Self::found(curve, work, request, map, repeated, unsolved)
    }

    /// The object of the family's class, or the exception that carries it: its message begins with the
    /// index of one curve among many.
    pub(crate) fn into_python(
        self,
        py: Python<'_>,
        request: &Request,
        index: Option<usize>,
    ) -> PyResult<Py<PyAny>> {
        match self.unsolved {
            None => self.curve.into_python(py),
            Some(unsolved) => Err(unsolved.raise(py, self.curve, request, index)?),
        }
    }
}

impl ConvergenceContext {
    /// The exception that carries the curve.
    fn raise(
        self,
        py: Python<'_>,
        curve: SpaceCurve,
        request: &Request,
        index: Option<usize>,
    ) -> PyResult<PyErr> {
        let Self { iterations, limited, report } = self;
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
        let subject = Arc::clone(&curve.curve);
        let report = subject.with_locations(report);
        let report = ShapeReport::of(report, Subject::Own(subject), request.asked);
        let report = Py::new(py, report)?.into_any();
        Ok(convergence_error(py, message, curve.into_python(py)?, report))
    }
}
