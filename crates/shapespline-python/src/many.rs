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
    geometry::{Boundary, DVec3, DataPolygon, Parametrization, Ragged},
    nu::{self, Strategy},
    search::{Collection, FitError, Tension, fit_many},
    tension::{self, TangentScale},
};

use crate::{
    error::{curve_error, fit_error, input_error},
    fit::{Made, Request, Searching},
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
    threads: Option<usize>,
}

/// Fits all, and returns the curves (`None` where one failed) and the exceptions by index.
fn run<'py>(
    py: Python<'py>,
    rows: Rows,
    request: &Request,
    make: impl Fn(DataPolygon, GoOn<'_>) -> Result<Made, FitError> + Sync,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
    let Rows { points, offsets, parametrization, boundary, threads } = rows;
    // A line that every option suits: an error now is the options', not that of any curve.
    let named = match &parametrization {
        Parametrization::Given(_) => &Parametrization::Uniform,
        named => named,
    };
    let line = DataPolygon::new(vec![DVec3::ZERO, DVec3::X], named, Boundary::ZeroCurvature);
    make(line.map_err(input_error)?, &|| ControlFlow::Continue(())).map_err(fit_error)?;

    let Points { points, dimension } = points;
    let points = Ragged::new(&points, &offsets.0).map_err(input_error)?;
    let collection = Collection { points, dimension, parametrization, boundary };
    collection.check().map_err(input_error)?;
    let fit = |polygon, ask: GoOn<'_>| match ask() {
        ControlFlow::Continue(()) => make(polygon, ask).map(Some),
        ControlFlow::Break(()) => Ok(None),
    };
    let longest = (0..points.len()).map(|k| points.range(k).len()).max().unwrap_or(0);
    let fits = if threads.is_none() && longest < PARALLEL {
        // Errors are large and rare.
        let fit_one = |k, ask: GoOn<'_>| collection.fit(k, |p| fit(p, ask)).map_err(Box::new);
        interruptible_each(py, points.len(), fit_one)?
    } else {
        let fit_all = |ask: GoOn<'_>| fit_many(&collection, threads, |p| fit(p, ask));
        let fits = interruptible(py, usize::MAX, fit_all)?.map_err(input_error)?;
        fits.into_iter().map(|fit| fit.map_err(Box::new)).collect()
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

/// Fits every curve of a collection.
#[pyfunction]
// One argument an option: the Python function beside gives them by name.
#[allow(clippy::too_many_arguments)]
pub(crate) fn _fit_many<'py>(
    py: Python<'py>,
    points: Points,
    offsets: Offsets,
    #[pyo3(from_py_with = options::method)] method: Method,
    parameters: Parameters,
    boundary: Ends,
    shape_preserving: bool,
    #[pyo3(from_py_with = options::threads)] threads: Option<usize>,
    criteria: CriteriaNames,
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
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
    let boundary = boundary.of(points.dimension)?;
    let rows = Rows { points, offsets, parametrization: parameters.0, boundary, threads };
    let step = step.unwrap_or_else(|| method.default_step(strategy));
    let search = Searching { criteria, strategy, step, max_iterations }.options(
        coplanarity,
        collinearity,
        tolerance,
    )?;
    let (criteria, tolerances) = (search.criteria, search.tolerances);
    let request = match method {
        Method::CatmullRom => Request::of_handles(criteria, tolerances),
        Method::Nu | Method::Tension => Request::from(&search),
    };
    match method {
        Method::Nu => run(py, rows, &request, |polygon, ask| {
            if !shape_preserving {
                return nu::NuSpline::new(polygon, Tension::Uniform(tension)).map(Made::built);
            }
            nu::NuSpline::shape_preserving_with(polygon, &search, &mut |_| ask())
                .map(|fit| Made::searched(fit, &request))
        }),
        Method::Tension => run(py, rows, &request, |polygon, ask| {
            if !shape_preserving {
                let scale = TangentScale::Uniform(tangent_scale);
                return tension::TensionSpline::new(polygon, scale).map(Made::built);
            }
            tension::TensionSpline::shape_preserving_with(polygon, &search, &mut |_| ask())
                .map(|fit| Made::searched(fit, &request))
        }),
        Method::CatmullRom => run(py, rows, &request, |polygon, ask| {
            if !shape_preserving {
                let tension = Tension::Uniform(tension);
                return catmull_rom::CatmullRom::new(polygon, tension, continuity).map(Made::built);
            }
            let options = HandleOptions { criteria, tolerances, safety, continuity, directions };
            catmull_rom::CatmullRom::shape_preserving_with(polygon, &options, &mut |_| ask())
                .map(|fit| Made::searched(fit, &request))
        }),
    }
}
