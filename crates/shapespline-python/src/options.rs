//! Options that users write by name.

use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
};
use shapespline::{
    criteria::{Criteria, Criterion, Tolerances},
    geometry::{Boundary, Dimension, Parametrization, Side},
    nu::Strategy,
};

use crate::{
    error::input_error,
    input::{Numbers, kind, numbers, text},
    tangents::Tangents,
};

/// The entry of a name, or a `ValueError` that lists the names.
pub(crate) fn choose<T: Copy>(argument: &str, name: &str, options: &[(&str, T)]) -> PyResult<T> {
    options.iter().find(|(known, _)| *known == name).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<String> = options.iter().map(|(known, _)| format!("'{known}'")).collect();
        unknown(argument, name, &names.join(", "))
    })
}

fn unknown(argument: &str, name: &str, options: &str) -> PyErr {
    PyValueError::new_err(format!("{argument} must be one of {options}; got '{name}'"))
}

pub(crate) fn side(name: &str) -> PyResult<Side> {
    match name {
        "right" => Ok(Side::Right),
        "left" => Ok(Side::Left),
        _ => Err(unknown("side", name, "'left', 'right'")),
    }
}

pub(crate) fn strategy(name: &str) -> PyResult<Strategy> {
    choose("strategy", name, &Strategy::NAMED)
}

/// `parameters`: a name, an exponent, or the parameters themselves.
pub(crate) struct Parameters(pub(crate) Parametrization);

impl Parameters {
    pub(crate) const CHORDAL: Self = Self(Parametrization::Chordal);
}

impl<'py> FromPyObject<'_, 'py> for Parameters {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Some(name) = text(&object) {
            return match name.as_str() {
                "uniform" => Ok(Self(Parametrization::Uniform)),
                "chordal" => Ok(Self(Parametrization::Chordal)),
                "centripetal" => Ok(Self(Parametrization::Centripetal)),
                _ => Err(unknown(
                    "parameters",
                    &name,
                    "'uniform', 'chordal', 'centripetal', an exponent, or an increasing array",
                )),
            };
        }
        Ok(Self(match numbers("parameters", &object)? {
            Numbers::One(exponent) => Parametrization::Exponent(exponent),
            Numbers::Many(values) => Parametrization::Given(values),
        }))
    }
}

/// `boundary`: a name or end tangents.
#[derive(Clone, Copy)]
pub(crate) enum Ends {
    Named(Boundary),
    Tangents(Tangents),
}

impl Ends {
    pub(crate) const ZERO_CURVATURE: Self = Self::Named(Boundary::ZeroCurvature);

    /// The boundary for points of a dimension.
    pub(crate) fn of(self, dimension: Dimension) -> PyResult<Boundary> {
        match self {
            Self::Named(boundary) => Ok(boundary),
            Self::Tangents(tangents) if tangents.dimension == dimension => Ok(tangents.boundary()),
            Self::Tangents(tangents) => Err(PyValueError::new_err(format!(
                "boundary: the tangents start and end have {} components, the points have {}",
                tangents.dimension.len(),
                dimension.len()
            ))),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for Ends {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        const NAMES: [(&str, Boundary); 4] = [
            ("zero-curvature", Boundary::ZeroCurvature),
            ("natural", Boundary::ZeroCurvature),
            ("periodic", Boundary::Periodic),
            ("circular", Boundary::Circular),
        ];
        if let Some(name) = text(&object) {
            return match NAMES.iter().find(|(known, _)| *known == name) {
                Some((_, boundary)) => Ok(Self::Named(*boundary)),
                None => Err(unknown(
                    "boundary",
                    &name,
                    "'zero-curvature', 'natural', 'periodic', 'circular', Tangents(start, end)",
                )),
            };
        }
        match object.cast::<Tangents>() {
            Ok(tangents) => Ok(Self::Tangents(*tangents.get())),
            Err(_) => Err(PyTypeError::new_err(format!(
                "must be 'zero-curvature', 'natural', 'periodic', 'circular' or \
                 Tangents(start, end), got {}",
                kind(&object)
            ))),
        }
    }
}

/// `criteria`: `None` for all, a name, or any iterable of names.
pub(crate) struct CriteriaNames(pub(crate) Criteria);

impl CriteriaNames {
    pub(crate) const ALL: Self = Self(Criteria::ALL);

    fn one(name: &str) -> PyResult<Criterion> {
        Criterion::from_name(name).ok_or_else(|| {
            let names: Vec<String> =
                Criterion::ALL.iter().map(|c| format!("'{}'", c.name())).collect();
            let names = names.join(", ") + " ('global-convexity' is still to come)";
            unknown("criteria", name, &names)
        })
    }
}

impl<'py> FromPyObject<'_, 'py> for CriteriaNames {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if object.is_none() {
            return Ok(Self::ALL);
        }
        if let Some(name) = text(&object) {
            return Ok(Self([Self::one(&name)?].into_iter().collect()));
        }
        let wrong = |given: &Bound<'_, PyAny>| {
            PyTypeError::new_err(format!(
                "must be None, a name or an iterable of names, got {}",
                kind(given)
            ))
        };
        let mut criteria = Criteria::NONE;
        for item in object.try_iter().map_err(|_| wrong(&object))? {
            let item = item?;
            let name = text(&item).ok_or_else(|| wrong(&item))?;
            criteria = criteria.with(Self::one(&name)?);
        }
        Ok(Self(criteria))
    }
}

/// The three tolerances, checked.
pub(crate) fn tolerances(coplanarity: f64, collinearity: f64, zero: f64) -> PyResult<Tolerances> {
    Tolerances { coplanarity, collinearity, zero }.validate().map_err(input_error)
}
