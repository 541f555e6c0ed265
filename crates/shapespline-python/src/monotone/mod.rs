// SPDX-License-Identifier: MIT OR Apache-2.0

//! Monotone interpolation in Python.
//!
//! [`function`] is what every function can do, [`spline`] what the interpolants add, [`families`] their
//! constructors; [`layout`] brings arrays with an axis to columns and back. [`rows`] are many functions, each with knots
//! of its own, [`places`] where they are asked, and [`many`] makes them.

use pyo3::prelude::*;

use crate::curve::document_call;

mod bezier_like;
mod calculus;
mod check;
mod cubic;
mod diagnostics;
mod export;
mod families;
mod fits;
mod function;
mod layout;
mod many;
mod options;
mod places;
mod row_calculus;
mod rows;
mod smooth;
mod spline;

pub(crate) use check::{MonotoneRecord, MonotoneReport};
pub(crate) use diagnostics::MonotoneDiagnostics;
pub(crate) use fits::Fits;
pub(crate) use function::PiecewisePolynomial;
pub(crate) use layout::Layout;
pub(crate) use rows::PiecewiseRows;
pub(crate) use smooth::MonotoneSmoothing;

/// Adds the classes and functions of this part to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<function::PiecewisePolynomial>()?;
    module.add_class::<spline::MonotoneSpline>()?;
    module.add_class::<cubic::MonotoneCubic>()?;
    module.add_class::<families::MonotoneQuartic>()?;
    module.add_class::<families::MonotoneQuintic>()?;
    module.add_class::<diagnostics::MonotoneDiagnostics>()?;
    module.add_class::<smooth::MonotoneSmoothing>()?;
    module.add_class::<rows::PiecewiseRows>()?;
    module.add_class::<rows::MonotoneRows>()?;
    module.add_class::<check::MonotoneRecord>()?;
    module.add_class::<check::MonotoneReport>()?;
    module.add_function(wrap_pyfunction!(check::_check_monotone, module)?)?;
    module.add_function(wrap_pyfunction!(cubic::minimal_bending, module)?)?;
    module.add_function(wrap_pyfunction!(smooth::smooth_monotone, module)?)?;
    module.add_function(wrap_pyfunction!(many::fit_many_monotone, module)?)?;
    module.add_function(wrap_pyfunction!(bezier_like::bezier_like, module)?)?;
    document_call::<function::PiecewisePolynomial>(module.py())?;
    document_call::<rows::PiecewiseRows>(module.py())
}
