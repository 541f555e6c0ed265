// SPDX-License-Identifier: MIT OR Apache-2.0

//! `fit_many`: ragged collections of curves, fitted in parallel.
//!
//! The Python function of that name (`python/shapespline/_many.py`) fills in the defaults of each
//! family; here every option has a value.

use std::ops::ControlFlow;

use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};
use shapespline::{
    catmull_rom::{self, Continuity, Directions, HandleOptions},
    fair::{Constraints, Energy, FairOptions},
    geometry::{Boundary, DVec3, DataPolygon, InputMap, Parametrization, Ragged, Repeated},
    nu::{self, Strategy},
    search::{Collection, FitError, Tension},
    tension::{self, TangentScale},
};

use crate::{
    error::{curve_error, fit_error, input_error},
    fit::{FitOutcome, Request, SearchArguments, fit_fair},
    input::{Offsets, Points},
    options::{self, CriteriaNames, Ends, Method, Parameters},
    work::{GoOn, PARALLEL, interruptible, interruptible_each},
};

/// What the curves are made from, and on how many threads.
struct Rows {
    points: Points,
    offsets: Offsets,
    parametrization: Parametrization,
    boundary: Boundary,
    closed: bool,
    repeated: Repeated,
    threads: Option<usize>,
}

/// Fits all, and returns the curves (`None` where one failed) and the exceptions by index.
fn run<'py>(
    py: Python<'py>,
    rows: Rows,
    request: &Request,
    make: impl Fn(DataPolygon, InputMap, GoOn<'_>) -> Result<FitOutcome, FitError> + Sync,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
    let Rows { points, offsets, parametrization, boundary, closed, repeated, threads } = rows;
    // A line that every option suits: an error now is the options', not that of any curve.
    let named = match &parametrization {
        Parametrization::Given(_) => &Parametrization::Uniform,
        named => named,
    };
    let line = DataPolygon::new(vec![DVec3::ZERO, DVec3::X], named, Boundary::ZeroCurvature);
    make(line.map_err(input_error)?, InputMap::default(), &|| ControlFlow::Continue(()))
        .map_err(fit_error)?;

    let Points { points, dimension } = points;
    let points = Ragged::new(&points, &offsets.0).map_err(input_error)?;
    let collection = Collection { points, dimension, parametrization, boundary, closed, repeated };
    let ranges = collection.check().map_err(input_error)?;
    let fit = |k: usize, go_on: GoOn<'_>| {
        // Errors are large and rare.
        collection
            .fit(k, &ranges, |polygon, map| match go_on() {
                ControlFlow::Continue(()) => make(polygon, map, go_on).map(Some),
                ControlFlow::Break(()) => Ok(None),
            })
            .map_err(Box::new)
    };
    let longest = (0..points.len()).map(|k| points.range(k).len()).max().unwrap_or(0);
    // A fair curve has up to three pieces per segment.
    let fits = if threads.is_none() && 3 * longest < PARALLEL {
        interruptible_each(py, points.len(), fit)?
    } else {
        let fit_all = |go_on: GoOn<'_>| points.map(threads, |k, _| fit(k, go_on));
        interruptible(py, usize::MAX, fit_all)?.map_err(input_error)?
    };

    let (mut curves, errors) = (Vec::with_capacity(fits.len()), PyDict::new(py));
    for (k, fit) in fits.into_iter().enumerate() {
        let done = match fit {
            Ok(Some(made)) => made.into_python(py, request, Some(k)),
            // Interrupted: the exception has been raised above.
            Ok(None) => continue,
            Err(error) => Err(curve_error(k, &error)),
        };
        match done {
            Ok(curve) => curves.push(curve),
            Err(error) => {
                curves.push(py.None());
                errors.set_item(k, error.into_value(py))?;
            }
        }
    }
    Ok((PyTuple::new(py, curves)?, errors))
}

/// Fit every curve of a collection.
#[pyfunction]
// One argument an option: the Python function beside gives them by name.
#[allow(clippy::too_many_arguments)]
pub(crate) fn _fit_many<'py>(
    py: Python<'py>,
    points: Points,
    offsets: Offsets,
    #[pyo3(from_py_with = options::method)] method: Method,
    parameters: Parameters,
    boundary: Option<Ends>,
    #[pyo3(from_py_with = options::closed)] closed: bool,
    #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
    shape_preserving: bool,
    #[pyo3(from_py_with = options::threads)] threads: Option<usize>,
    criteria: CriteriaNames,
    #[pyo3(from_py_with = options::resolution)] resolution: f64,
    #[pyo3(from_py_with = options::coplanarity)] coplanarity: f64,
    #[pyo3(from_py_with = options::collinearity)] collinearity: f64,
    #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
    #[pyo3(from_py_with = options::strategy)] strategy: Strategy,
    #[pyo3(from_py_with = options::optional_step)] step: Option<f64>,
    #[pyo3(from_py_with = options::max_iterations)] max_iterations: Option<usize>,
    #[pyo3(from_py_with = options::safety)] safety: f64,
    #[pyo3(from_py_with = options::continuity)] continuity: Continuity,
    #[pyo3(from_py_with = options::directions)] directions: Directions,
    #[pyo3(from_py_with = options::tension)] tension: f64,
    #[pyo3(from_py_with = options::tangent_scale)] tangent_scale: f64,
    #[pyo3(from_py_with = options::energy)] energy: Energy,
    #[pyo3(from_py_with = options::straight)] straight: bool,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
    let boundary = boundary.unwrap_or(Ends::Default).of(points.dimension, closed)?;
    let parametrization = parameters.0;
    let rows = Rows { points, offsets, parametrization, boundary, closed, repeated, threads };
    let step = step.unwrap_or_else(|| method.default_step(strategy));
    let search = SearchArguments { criteria, strategy, step, max_iterations }.options(
        resolution,
        coplanarity,
        collinearity,
        tolerance,
    )?;
    let (criteria, tolerances) = (search.criteria, search.tolerances);
    let request = match method {
        Method::Fair | Method::CatmullRom => Request::without_strategy(criteria, tolerances),
        Method::Nu | Method::Tension => Request::from(&search),
    };
    match method {
        Method::Fair => run(py, rows, &request, |polygon, map, go_on| {
            let options = FairOptions {
                criteria,
                tolerances,
                energy,
                max_iterations,
                constraints: Constraints { straight, ..Constraints::default() },
            };
            fit_fair(polygon, map, repeated, &options, &request, go_on)
        }),
        Method::Nu => run(py, rows, &request, |polygon, map, go_on| {
            if !shape_preserving {
                return nu::NuSpline::new(polygon, Tension::Uniform(tension))
                    .map(|curve| FitOutcome::built(curve, map, repeated));
            }
            nu::NuSpline::shape_preserving_with(polygon, &search, &mut |_| go_on())
                .map(|fit| FitOutcome::searched(fit, &request, map, repeated))
        }),
        Method::Tension => run(py, rows, &request, |polygon, map, go_on| {
            if !shape_preserving {
                let scale = TangentScale::Uniform(tangent_scale);
                return tension::TensionSpline::new(polygon, scale)
                    .map(|curve| FitOutcome::built(curve, map, repeated));
            }
            tension::TensionSpline::shape_preserving_with(polygon, &search, &mut |_| go_on())
                .map(|fit| FitOutcome::searched(fit, &request, map, repeated))
        }),
        Method::CatmullRom => run(py, rows, &request, |polygon, map, go_on| {
            if !shape_preserving {
                let tension = Tension::Uniform(tension);
                return catmull_rom::CatmullRom::new(polygon, tension, continuity)
                    .map(|curve| FitOutcome::built(curve, map, repeated));
            }
            let options = HandleOptions { criteria, tolerances, safety, continuity, directions };
            catmull_rom::CatmullRom::shape_preserving_with(polygon, &options, &mut |_| go_on())
                .map(|fit| FitOutcome::searched(fit, &request, map, repeated))
        }),
    }
}
