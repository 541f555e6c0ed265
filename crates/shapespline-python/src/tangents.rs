// SPDX-License-Identifier: MIT OR Apache-2.0

//! End tangents as a small value.

use std::hash::{Hash, Hasher};

use pyo3::prelude::*;
use shapespline::geometry::{Boundary, Coordinates, DVec3, Dimension};

use crate::{
    error::{Value, invalid, must},
    input::{Numbers, numbers},
    output::{FloatArray, vector},
    pickle::{self, PickledKind, Reduced},
};

/// Given tangents at the ends of a curve, or at one of them, for the argument ``boundary``.
///
/// Parameters
/// ----------
/// start, end : array_like, shape (3,) or (2,), optional
///     Derivatives of the curve with respect to its parameter at the first and the last point, in
///     units of the points over units of the parameter: any finite, non-zero vectors, with as many
///     components as the points. An end whose tangent is ``None`` is natural: it has no curvature.
///
/// Raises
/// ------
/// ValueError
///     If a vector is zero, not finite, of a wrong shape, the two have different lengths, or both are
///     ``None``.
/// TypeError
///     If a vector is not made of real numbers.
///
/// Notes
/// -----
/// Condition (3.8) of Karavelas & Kaklis, Numer. Algorithms 23 (2000): under tension ν the tangent of
/// a ν-spline at the end is the given one divided by 1 + ν. Objects are immutable, and equal when their
/// vectors are.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> ends = ss.Tangents([1, 0, 0], [0, 2, 0])
/// >>> ends
/// Tangents([1.0, 0.0, 0.0], [0.0, 2.0, 0.0])
/// >>> curve = ss.NuSpline([[0, 0, 0], [1, 1, 0], [1, 2, 1]], boundary=ends)
/// >>> curve.tangents[-1]
/// array([0., 2., 0.])
#[pyclass(module = "shapespline", frozen, eq, hash, weakref)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Tangents {
    start: Option<DVec3>,
    end: Option<DVec3>,
    pub(crate) dimension: Dimension,
}

impl Hash for Tangents {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for v in [self.start, self.end] {
            // −0 equals 0, and adding 0 makes it so in bits too.
            v.map(|v| v.to_array().map(|x| (x + 0.0).to_bits())).hash(state);
        }
    }
}

impl Tangents {
    pub(crate) fn new(start: Option<DVec3>, end: Option<DVec3>, dimension: Dimension) -> Self {
        Self { start, end, dimension }
    }

    pub(crate) fn boundary(&self) -> Boundary {
        Boundary::Tangents { start: self.start, end: self.end }
    }
}

/// A tangent: its vector and the number of its components.
fn tangent(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<(DVec3, Dimension)> {
    let (vector, dimension) = match numbers(argument, object)? {
        Numbers::Many(v) if v.len() == 3 => (DVec3::from_slice(&v), Dimension::Three),
        Numbers::Many(v) if v.len() == 2 => (DVec3::new(v[0], v[1], 0.0), Dimension::Two),
        Numbers::Many(v) => {
            return Err(must(argument, &[], "have 2 or 3 components", v.len()));
        }
        Numbers::One(value) => {
            return Err(must(argument, &[], "be a vector of 2 or 3 components", value));
        }
    };
    if let Some(i) = vector.to_array().iter().position(|x| !x.is_finite()) {
        return Err(must(argument, &[i], "be finite", vector.to_array()[i]));
    }
    if vector == DVec3::ZERO {
        let text = format!("{argument} must not be the zero vector");
        return Err(invalid(argument, &[], Coordinates { vector, dimension }, text));
    }
    Ok((vector, dimension))
}

#[pymethods]
impl Tangents {
    #[new]
    #[pyo3(signature = (start=None, end=None))]
    fn from_python(
        start: Option<&Bound<'_, PyAny>>,
        end: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let start = start.map(|object| tangent("start", object)).transpose()?;
        let end = end.map(|object| tangent("end", object)).transpose()?;
        let dimension = match (start, end) {
            (Some((_, own)), Some((_, other))) if own != other => {
                let [start, end] = [own, other].map(Dimension::count);
                let text = format!(
                    "start and end must have the same number of components, got {start} and {end}"
                );
                return Err(invalid("end", &[], end, text));
            }
            (Some((_, dimension)), _) | (None, Some((_, dimension))) => dimension,
            (None, None) => {
                let text =
                    "start and end must not both be None: boundary='natural' has no end tangents";
                return Err(invalid("start", &[], Value::Nothing, text.to_owned()));
            }
        };
        let [start, end] = [start, end].map(|tangent| tangent.map(|(vector, _)| vector));
        Ok(Self { start, end, dimension })
    }

    /// The tangent at the first point, shape (dim,), or ``None``; a fresh array.
    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> Option<FloatArray<'py>> {
        self.start.map(|tangent| vector(py, tangent, self.dimension.count()))
    }

    /// The tangent at the last point, shape (dim,), or ``None``; a fresh array.
    #[getter]
    fn end<'py>(&self, py: Python<'py>) -> Option<FloatArray<'py>> {
        self.end.map(|tangent| vector(py, tangent, self.dimension.count()))
    }

    fn __repr__(&self) -> String {
        let shown = |tangent: Option<DVec3>| match tangent {
            Some(v) => format!("{:?}", &v.to_array()[..self.dimension.count()]),
            None => "None".to_owned(),
        };
        format!("Tangents({}, {})", shown(self.start), shown(self.end))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::Tangents)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
