// SPDX-License-Identifier: MIT OR Apache-2.0

//! Options that users write by name.

use pyo3::{
    exceptions::PyTypeError,
    prelude::*,
    types::{IntoPyDict, PyDict},
};
use shapespline::{
    catmull_rom::{Continuity, Directions},
    criteria::{Criteria, Criterion, Tolerances},
    fair::Energy,
    geometry::{Boundary, Dimension, InputError, InputMap, Parametrization, Repeated, Side},
    search::{SearchOptions, Strategy, Tension},
    tension::TensionSpline,
};

use crate::{
    error::{input_error, invalid, must},
    input::{Numbers, count, float, kind, numbers, reworded, text},
    tangents::Tangents,
};

/// The entry of a name, or an error that lists the names.
pub(crate) fn choose<T: Copy>(argument: &str, name: &str, options: &[(&str, T)]) -> PyResult<T> {
    options.iter().find(|(known, _)| *known == name).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<String> = options.iter().map(|(known, _)| format!("'{known}'")).collect();
        unknown(argument, name, &names.join(", "))
    })
}

pub(crate) fn unknown(argument: &str, name: &str, options: &str) -> PyErr {
    let text = format!("{argument} must be one of {options}; got '{name}'");
    invalid(argument, &[], name, text)
}

/// The name in a string argument.
fn name(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<String> {
    text(object).ok_or_else(|| {
        PyTypeError::new_err(format!("{argument} must be a string, got {}", kind(object)))
    })
}

const ENERGIES: [(&str, Energy); 2] =
    [("parametric", Energy::Parametric), ("bending", Energy::Bending)];

const CONTINUITIES: [(&str, Continuity); 2] = [("C1", Continuity::C1), ("G1", Continuity::G1)];
const DIRECTIONS: [(&str, Directions); 2] =
    [("balanced", Directions::Balanced), ("parametrization", Directions::Parametrization)];
const SPACINGS: [(&str, Spacing); 2] =
    [("parameter", Spacing::Parameter), ("arc-length", Spacing::ArcLength)];
const REPEATED: [(&str, Repeated); 2] = [("error", Repeated::Error), ("drop", Repeated::Drop)];
const BOUNDARIES: [(&str, Boundary); 4] = [
    ("zero-curvature", Boundary::ZeroCurvature),
    ("natural", Boundary::ZeroCurvature),
    ("periodic", Boundary::Periodic),
    ("circular", Boundary::Circular),
];

/// The names that options of curves take, for the command line and for the types in the stub.
pub(crate) fn names(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    fn of<T>(table: &[(&'static str, T)]) -> Vec<&'static str> {
        table.iter().map(|(name, _)| *name).collect()
    }
    let all = [
        ("boundary", of(&BOUNDARIES)),
        ("by", of(&SPACINGS)),
        ("continuity", of(&CONTINUITIES)),
        ("criteria", Criterion::ALL.iter().map(|criterion| criterion.name()).collect()),
        ("directions", of(&DIRECTIONS)),
        ("energy", of(&ENERGIES)),
        ("repeated", of(&REPEATED)),
        ("strategy", of(&Strategy::NAMED)),
    ];
    all.into_py_dict(py)
}

pub(crate) fn energy(object: &Bound<'_, PyAny>) -> PyResult<Energy> {
    choose("energy", &name("energy", object)?, &ENERGIES)
}

/// The name of an energy.
pub(crate) fn energy_name(energy: Energy) -> &'static str {
    ENERGIES.iter().find(|(_, known)| *known == energy).map_or("", |(name, _)| name)
}

pub(crate) fn side(object: &Bound<'_, PyAny>) -> PyResult<Side> {
    choose("side", &name("side", object)?, &[("left", Side::Left), ("right", Side::Right)])
}

pub(crate) fn strategy(object: &Bound<'_, PyAny>) -> PyResult<Strategy> {
    choose("strategy", &name("strategy", object)?, &Strategy::NAMED)
}

pub(crate) fn continuity(object: &Bound<'_, PyAny>) -> PyResult<Continuity> {
    choose("continuity", &name("continuity", object)?, &CONTINUITIES)
}

pub(crate) fn directions(object: &Bound<'_, PyAny>) -> PyResult<Directions> {
    choose("directions", &name("directions", object)?, &DIRECTIONS)
}

/// The name of what is continuous.
pub(crate) fn continuity_name(continuity: Continuity) -> &'static str {
    match continuity {
        Continuity::C1 => "C1",
        Continuity::G1 => "G1",
    }
}

/// A family by the name that `fit_many` knows it by.
#[derive(Clone, Copy)]
pub(crate) enum Method {
    Fair,
    Nu,
    Tension,
    CatmullRom,
}

impl Method {
    /// The step of a strategy where none is given.
    pub(crate) fn default_step(self, strategy: Strategy) -> f64 {
        match self {
            // As published for the reduction, else tuned for 1/λ − 1.
            Self::Tension if strategy != Strategy::Reduction => TensionSpline::options().step,
            _ => SearchOptions::default().step,
        }
    }
}

pub(crate) fn method(object: &Bound<'_, PyAny>) -> PyResult<Method> {
    let names = [
        ("fair", Method::Fair),
        ("nu", Method::Nu),
        ("tension", Method::Tension),
        ("catmull-rom", Method::CatmullRom),
    ];
    choose("method", &name("method", object)?, &names)
}

/// What is even between samples.
#[derive(Clone, Copy)]
pub(crate) enum Spacing {
    Parameter,
    ArcLength,
}

pub(crate) fn by(object: &Bound<'_, PyAny>) -> PyResult<Spacing> {
    choose("by", &name("by", object)?, &SPACINGS)
}

pub(crate) fn repeated(object: &Bound<'_, PyAny>) -> PyResult<Repeated> {
    choose("repeated", &name("repeated", object)?, &REPEATED)
}

pub(crate) fn closed(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    flag("closed", object)
}
pub(crate) fn straight(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    flag("straight", object)
}

/// Python's bool or NumPy's.
fn flag(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<bool> {
    object.extract::<bool>().map_err(|error| {
        reworded(object.py(), error, |_| {
            PyTypeError::new_err(format!("{argument} must be True or False, got {}", kind(object)))
        })
    })
}

// Plain numbers: pyo3 tells a converter the value, not the argument it is for.

pub(crate) fn nu(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("nu", 0, object)
}
pub(crate) fn n(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("n", 1, object)
}
pub(crate) fn degree(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("degree", 1, object)
}
pub(crate) fn max_iterations(object: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if object.is_none() { Ok(None) } else { count("max_iterations", 1, object).map(Some) }
}
pub(crate) fn step(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("step", object)
}
pub(crate) fn optional_step(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { step(object).map(Some) }
}
pub(crate) fn threads(object: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if object.is_none() { Ok(None) } else { count("threads", 1, object).map(Some) }
}
pub(crate) fn tension(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("tension", object)
}
pub(crate) fn tangent_scale(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("tangent_scale", object)
}
pub(crate) fn safety(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("safety", object)
}
pub(crate) fn resolution(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("resolution", object)
}
pub(crate) fn optional_resolution(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { resolution(object).map(Some) }
}
pub(crate) fn max_deviation(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { float("max_deviation", object).map(Some) }
}
pub(crate) fn coplanarity(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("coplanarity", object)
}
pub(crate) fn optional_coplanarity(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { coplanarity(object).map(Some) }
}
pub(crate) fn collinearity(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("collinearity", object)
}
pub(crate) fn optional_collinearity(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { collinearity(object).map(Some) }
}
pub(crate) fn tolerance(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("tolerance", object)
}
pub(crate) fn optional_tolerance(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { tolerance(object).map(Some) }
}
pub(crate) fn a(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    end("a", object)
}
pub(crate) fn b(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    end("b", object)
}

/// A finite end of an interval, or `None`.
fn end(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() {
        return Ok(None);
    }
    let value = float(argument, object)?;
    if value.is_finite() {
        return Ok(Some(value));
    }
    Err(must(argument, &[], "be finite", value))
}

/// `parameters`: a name, an exponent, or the parameters themselves.
pub(crate) struct Parameters(pub(crate) Parametrization);

impl Parameters {
    pub(crate) const CHORDAL: Self = Self(Parametrization::Chordal);
    pub(crate) const CENTRIPETAL: Self = Self(Parametrization::Centripetal);
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
                    "'uniform', 'chordal', 'centripetal', an exponent from 0 to 1, or an increasing array",
                )),
            };
        }
        Ok(Self(match numbers("parameters", &object)? {
            Numbers::One(exponent) => Parametrization::Exponent(exponent),
            Numbers::Many(values) => Parametrization::Given(values),
        }))
    }
}

/// `tension`: one number, or one a point.
pub(crate) struct NodalTension(Numbers);

impl<'py> FromPyObject<'_, 'py> for NodalTension {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        numbers("tension", &object).map(Self)
    }
}

impl NodalTension {
    pub(crate) const NONE: Self = Self(Numbers::One(0.0));

    /// The tension of the nodes, from that of the points.
    ///
    /// # Errors
    /// Another number of values than of points.
    pub(crate) fn at_nodes(self, map: &InputMap) -> Result<Self, InputError> {
        Ok(match self.0 {
            Numbers::Many(values) if !map.is_plain() => {
                Self(Numbers::Many(map.node_values("tension", &values)?))
            }
            numbers => Self(numbers),
        })
    }

    pub(crate) fn tension(&self) -> Tension<'_> {
        match &self.0 {
            Numbers::One(value) => Tension::Uniform(*value),
            Numbers::Many(values) => Tension::Nodes(values),
        }
    }
}

/// `boundary`: a name or end tangents.
#[derive(Clone, Copy)]
pub(crate) enum Ends {
    /// None is given: natural ends, or periodic ones for closed data.
    Default,
    Named(Boundary),
    Tangents(Tangents),
}

impl Ends {
    /// The boundary for points of a dimension, whose first point may also be their last.
    pub(crate) fn of(self, dimension: Dimension, closed: bool) -> PyResult<Boundary> {
        match self {
            Self::Default if closed => Ok(Boundary::Periodic),
            Self::Default => Ok(Boundary::ZeroCurvature),
            Self::Named(Boundary::Periodic) => Ok(Boundary::Periodic),
            _ if closed => {
                let name = match self {
                    Self::Named(Boundary::Circular) => "circular",
                    Self::Named(_) => "natural",
                    _ => "Tangents",
                };
                Err(must("boundary", &[], "be 'periodic' with closed=True", name))
            }
            Self::Named(boundary) => Ok(boundary),
            Self::Tangents(tangents) if tangents.dimension == dimension => Ok(tangents.boundary()),
            Self::Tangents(tangents) => {
                let components = tangents.dimension.count();
                let text = format!(
                    "boundary: the tangents start and end have {components} components, the points \
                     have {}",
                    dimension.count()
                );
                Err(invalid("boundary", &[], components, text))
            }
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for Ends {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Some(name) = text(&object) {
            return match BOUNDARIES.iter().find(|(known, _)| *known == name) {
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
                "boundary must be 'zero-curvature', 'natural', 'periodic', 'circular' or \
                 Tangents(start, end), got {}",
                kind(&object)
            ))),
        }
    }
}

/// `criteria`: `None` for the default, a name, or any iterable of names.
pub(crate) struct CriteriaNames(Option<Criteria>);

impl CriteriaNames {
    pub(crate) const DEFAULT: Self = Self(None);

    /// The criteria that were named, or else the default.
    pub(crate) fn or(self, default: Criteria) -> Criteria {
        self.0.unwrap_or(default)
    }

    fn one(name: &str) -> PyResult<Criterion> {
        Criterion::from_name(name).ok_or_else(|| {
            let names: Vec<String> =
                Criterion::ALL.iter().map(|c| format!("'{}'", c.name())).collect();
            unknown("criteria", name, &names.join(", "))
        })
    }
}

impl<'py> FromPyObject<'_, 'py> for CriteriaNames {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if object.is_none() {
            return Ok(Self::DEFAULT);
        }
        if let Some(name) = text(&object) {
            return Ok(Self(Some([Self::one(&name)?].into_iter().collect())));
        }
        let wrong = |given: &Bound<'_, PyAny>| {
            PyTypeError::new_err(format!(
                "criteria must be None, a name or an iterable of names, got {}",
                kind(given)
            ))
        };
        let py = object.py();
        let mut criteria = Criteria::NONE;
        for item in object.try_iter().map_err(|error| reworded(py, error, |_| wrong(&object)))? {
            let item = item?;
            let name = text(&item).ok_or_else(|| wrong(&item))?;
            criteria = criteria.with(Self::one(&name)?);
        }
        Ok(Self(Some(criteria)))
    }
}

/// The three tolerances, checked.
pub(crate) fn tolerances(
    resolution: f64,
    coplanarity: f64,
    collinearity: f64,
    zero: f64,
) -> PyResult<Tolerances> {
    Tolerances { coplanarity, collinearity, zero, resolution }.validate().map_err(input_error)
}
