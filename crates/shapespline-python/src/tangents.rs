//! End tangents as a small value.

use std::hash::{Hash, Hasher};

use pyo3::prelude::*;
use shapespline::geometry::{Boundary, Coordinates, DVec3, Dimension};

use crate::{
    error::{invalid, must},
    input::{Numbers, numbers},
    output::{FloatArray, vector},
    pickle::{self, Kind, Reduced},
};

/// Given tangents at the two ends of a curve, for the argument ``boundary``.
///
/// Parameters
/// ----------
/// start, end : array_like, shape (3,) or (2,)
///     Derivatives of the curve with respect to its parameter at the first and the last point, in
///     units of the points over units of the parameter: any finite, non-zero vectors, with as many
///     components as the points.
///
/// Raises
/// ------
/// ValueError
///     If a vector is zero, not finite, of a wrong shape, or the two have different lengths.
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
    start: DVec3,
    end: DVec3,
    pub(crate) dimension: Dimension,
}

impl Hash for Tangents {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for v in [self.start, self.end] {
            // −0 equals 0, and adding 0 makes it so in bits too.
            v.to_array().map(|x| (x + 0.0).to_bits()).hash(state);
        }
    }
}

impl Tangents {
    pub(crate) fn new(start: DVec3, end: DVec3, dimension: Dimension) -> Self {
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
    fn from_python(start: &Bound<'_, PyAny>, end: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (start, dimension) = tangent("start", start)?;
        let (end, other) = tangent("end", end)?;
        if dimension != other {
            let [start, end] = [dimension, other].map(Dimension::len);
            let text = format!(
                "start and end must have the same number of components, got {start} and {end}"
            );
            return Err(invalid("end", &[], end, text));
        }
        Ok(Self { start, end, dimension })
    }

    /// The tangent at the first point, shape (dim,); a fresh array.
    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> FloatArray<'py> {
        vector(py, self.start, self.dimension.len())
    }

    /// The tangent at the last point, shape (dim,); a fresh array.
    #[getter]
    fn end<'py>(&self, py: Python<'py>) -> FloatArray<'py> {
        vector(py, self.end, self.dimension.len())
    }

    fn __repr__(&self) -> String {
        let columns = self.dimension.len();
        let [start, end] = [self.start, self.end].map(|v| v.to_array()[..columns].to_vec());
        format!("Tangents({start:?}, {end:?})")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, Kind::Tangents)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
