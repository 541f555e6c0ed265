// SPDX-License-Identifier: MIT OR Apache-2.0

//! The Python face of shapespline: arrays in and out, options by name, errors to exceptions.
//!
//! No mathematics lives here. Every space curve is a `SpaceCurve`; a family adds its own
//! constructors (`NuSpline`, `TensionSpline`, `CatmullRom`, `FairSpline`). The package
//! `python/shapespline` around this module holds what is better written in Python, figures and the
//! command line; nothing of it is imported here.

// Doc comments on Python classes are numpydoc docstrings: `points[0]` in them is no link.
#![allow(rustdoc::broken_intra_doc_links)]

use pyo3::{exceptions::PyImportError, prelude::*, sync::PyOnceLock};

mod asked;
mod catmull_rom;
mod constraints;
mod curve;
mod diagnostics;
mod error;
mod fair;
mod fair_diagnostics;
mod fairness;
mod fit;
mod input;
mod many;
mod monotone;
mod nu;
mod options;
mod output;
mod pickle;
mod piecewise;
mod record;
mod report;
mod shape;
mod tangents;
mod tension;
mod work;

/// A fit of a million points takes and gives back a dozen arrays of tens of megabytes. The C library
/// returns each to the system at once and has every page zeroed and mapped anew by the next fit, which
/// took as long as the fit; this allocator keeps them for a moment.
#[cfg(not(target_family = "wasm"))]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The module itself: what it raises and what makes objects of pickles is found there, so that it
/// imports nothing of the package around it.
static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();

/// A member of the module by its name.
fn own<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let module =
        MODULE.get(py).ok_or_else(|| PyImportError::new_err("the module is incomplete"))?;
    module.bind(py).getattr(name)
}

/// Compiled part of shapespline: the curves, their reports, and checks of any curve.
#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    MODULE.get_or_init(module.py(), || module.clone().unbind());
    error::register(module)?;
    module.add_class::<curve::SpaceCurve>()?;
    module.add_class::<nu::NuSpline>()?;
    module.add_class::<tension::TensionSpline>()?;
    module.add_class::<catmull_rom::CatmullRom>()?;
    module.add_class::<fair::FairSpline>()?;
    module.add_class::<fair_diagnostics::FairDiagnostics>()?;
    module.add_class::<fair_diagnostics::FairStep>()?;
    module.add_class::<tangents::Tangents>()?;
    module.add_class::<piecewise::PiecewiseBezier>()?;
    module.add_class::<fairness::Fairness>()?;
    module.add_class::<report::ShapeReport>()?;
    module.add_class::<report::ShapeRecord>()?;
    module.add_class::<report::UndecidedRecord>()?;
    module.add_class::<report::NodeRecord>()?;
    module.add_class::<report::OscillationRecord>()?;
    module.add_class::<diagnostics::Diagnostics>()?;
    module.add_class::<diagnostics::SearchStep>()?;
    module.add_function(wrap_pyfunction!(pickle::_from_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(input::_floats, module)?)?;
    module.add_function(wrap_pyfunction!(many::_fit_many, module)?)?;
    module.add_function(wrap_pyfunction!(shape::_check_shape, module)?)?;
    module.add_function(wrap_pyfunction!(shape::_curve_inflections, module)?)?;
    module.add_function(wrap_pyfunction!(shape::_polygon_inflections, module)?)?;
    module.add_function(wrap_pyfunction!(shape::_polygon_shape, module)?)?;
    monotone::register(module)?;
    module.add("_NAMES", options::names(module.py())?)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    let py = module.py();
    curve::document_call::<curve::SpaceCurve>(py)?;
    curve::document_call::<piecewise::PiecewiseBezier>(py)
}
