// SPDX-License-Identifier: MIT OR Apache-2.0

//! `SpaceCurve`: what every space curve is and can do, whatever its family.
//!
//! A family implements [`Curve`] for its Rust type, gets a [`Family`] tag and a Python class of its
//! own with the constructors; everything else is inherited. One file a group of methods:
//! [`attributes`], [`evaluate`], [`measure`], [`export`].

use std::{any::Any, fmt::Debug, sync::Arc};

use pyo3::{PyClass, PyClassInitializer, exceptions::PyTypeError, prelude::*};
use shapespline::{
    catmull_rom::CatmullRom,
    fair::FairSpline,
    geometry::{self, Boundary, DVec3, DataPolygon, PiecewiseCubic, Side},
    nu::NuSpline,
    search::Interpolant,
    tension::TensionSpline,
};

use crate::{
    catmull_rom,
    diagnostics::Search,
    fair, nu,
    pickle::{self, PickledKind, Reduced},
    tension,
};

mod attributes;
mod evaluate;
mod export;
mod fitted;
mod measure;

pub(crate) use attributes::boundary_object;
pub(crate) use fitted::{Fitted, in_input};

/// The families, by the numbers that pickles hold: append only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Family {
    /// ν-splines.
    Nu,
    /// C² tension cubics.
    Tension,
    /// Catmull–Rom curves.
    CatmullRom,
    /// Fair curves.
    Fair,
}

/// A family of curves: what the crate of its mathematics does not say.
pub(crate) trait Member:
    Interpolant + Debug + Send + Sync + serde::Serialize + 'static
{
    const FAMILY: Family;

    /// Whether what serde cannot know holds: of a curve that any constructor made it does.
    fn is_sound(&self) -> bool {
        true
    }
}

impl Member for NuSpline {
    const FAMILY: Family = Family::Nu;
}

impl Member for TensionSpline {
    const FAMILY: Family = Family::Tension;

    fn is_sound(&self) -> bool {
        let slopes = Interpolant::curve(self).slopes();
        let valid = |x: &f64| *x > 0.0 && *x <= 1.0;
        slopes.len() == Curve::cubic(self).segments() && slopes.iter().flatten().all(valid)
    }
}

impl Member for CatmullRom {
    const FAMILY: Family = Family::CatmullRom;
}

/// A space curve of any family.
pub(crate) trait Curve: Debug + Send + Sync {
    fn family(&self) -> Family;
    /// For what only one family has.
    fn as_any(&self) -> &dyn Any;
    /// The curve in its own parameter.
    fn path(&self) -> &dyn geometry::Curve;
    /// The cubic Bézier segments.
    fn cubic(&self) -> &PiecewiseCubic;
    /// One number a point, 0 = none.
    fn tension(&self) -> &[f64];
    /// One a point.
    fn tangents(&self) -> Vec<DVec3>;
    fn boundary(&self) -> Boundary;
    /// The knots that are data points, where not all are.
    fn nodes(&self) -> Option<&[usize]> {
        None
    }
    /// The nodes at which there are corners.
    fn corners(&self) -> &[usize] {
        &[]
    }
    /// The segments that are straight by construction.
    fn straight(&self) -> &[usize] {
        &[]
    }
    fn polygon(&self) -> &DataPolygon;
    fn is_sound(&self) -> bool;
    /// Appends the curve in postcard's form.
    fn write(&self, bytes: Vec<u8>) -> Result<Vec<u8>, postcard::Error>;
}

impl<C: Member> Curve for C {
    fn family(&self) -> Family {
        C::FAMILY
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
    fn path(&self) -> &dyn geometry::Curve {
        Interpolant::curve(self)
    }
    fn cubic(&self) -> &PiecewiseCubic {
        geometry::Curve::cubic(Interpolant::curve(self))
    }
    fn tension(&self) -> &[f64] {
        Interpolant::tension(self)
    }
    fn tangents(&self) -> Vec<DVec3> {
        Interpolant::tangents(self)
    }
    fn boundary(&self) -> Boundary {
        Interpolant::boundary(self)
    }
    fn polygon(&self) -> &DataPolygon {
        Interpolant::polygon(self)
    }
    fn is_sound(&self) -> bool {
        Member::is_sound(self)
    }
    fn write(&self, bytes: Vec<u8>) -> Result<Vec<u8>, postcard::Error> {
        postcard::to_extend(self, bytes)
    }
}

impl Curve for FairSpline {
    fn family(&self) -> Family {
        Family::Fair
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
    fn path(&self) -> &dyn geometry::Curve {
        self.curve()
    }
    fn cubic(&self) -> &PiecewiseCubic {
        self.curve()
    }
    fn tension(&self) -> &[f64] {
        &[]
    }
    fn tangents(&self) -> Vec<DVec3> {
        self.tangents()
    }
    fn boundary(&self) -> Boundary {
        self.boundary()
    }
    fn nodes(&self) -> Option<&[usize]> {
        Some(self.nodes())
    }
    fn corners(&self) -> &[usize] {
        self.corners()
    }
    fn straight(&self) -> &[usize] {
        self.straight()
    }
    fn polygon(&self) -> &DataPolygon {
        self.polygon()
    }
    fn is_sound(&self) -> bool {
        true
    }
    fn write(&self, bytes: Vec<u8>) -> Result<Vec<u8>, postcard::Error> {
        postcard::to_extend(self, bytes)
    }
}

impl dyn Curve + '_ {
    /// Number of nodes: the data points, but for those that were left out.
    pub(crate) fn count(&self) -> usize {
        self.nodes().map_or(self.cubic().points().len(), <[usize]>::len)
    }

    /// Those of some values, one per knot, that belong to nodes.
    pub(crate) fn at_nodes<T: Copy>(&self, values: &[T]) -> Vec<T> {
        match self.nodes() {
            Some(nodes) => nodes.iter().map(|&k| values[k]).collect(),
            None => values.to_vec(),
        }
    }

    /// The curve's own parameter where the image, run through linearly on each segment, has `u`.
    pub(crate) fn own_parameter(&self, u: f64) -> f64 {
        if self.family() != Family::Tension || !u.is_finite() {
            return u;
        }
        let (segment, t) = self.cubic().locate(u, Side::Right);
        self.path().parameter(segment, t)
    }
}

/// A curve through points in space or in the plane: the base of all families.
///
/// Not made directly: use `FairSpline`, `NuSpline`, `TensionSpline` or `CatmullRom`. A curve is immutable, compares and hashes by identity, can be
/// pickled and copied, and may be used from several threads at once.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> curve = ss.NuSpline([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]])
/// >>> isinstance(curve, ss.SpaceCurve)
/// True
/// >>> curve([0.0, 0.5]).shape
/// (2, 3)
#[pyclass(module = "shapespline", frozen, subclass, weakref)]
pub(crate) struct SpaceCurve {
    pub(crate) curve: Arc<Fitted>,
    pub(crate) search: Option<Arc<Search>>,
}

impl SpaceCurve {
    pub(crate) fn of(curve: Arc<Fitted>, search: Option<Search>) -> Self {
        Self { curve, search: search.map(Arc::new) }
    }

    /// The object of the family's class.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match self.curve.family() {
            Family::Nu => self.with_class(py, nu::NuSpline),
            Family::Tension => self.with_class(py, tension::TensionSpline),
            Family::CatmullRom => self.with_class(py, catmull_rom::CatmullRom),
            Family::Fair => self.with_class(py, fair::FairSpline),
        }
    }

    fn with_class<S>(self, py: Python<'_>, class: S) -> PyResult<Py<PyAny>>
    where
        S: PyClass<BaseType = Self>,
    {
        Ok(Py::new(py, PyClassInitializer::from(self).add_subclass(class))?.into_any())
    }

    /// Number of coordinates.
    fn columns(&self) -> usize {
        self.curve.cubic().dimension().count()
    }
}

#[pymethods]
impl SpaceCurve {
    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err(
            "SpaceCurve is the base of the curves: make a FairSpline, a NuSpline, a \
             TensionSpline or a CatmullRom",
        ))
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let curve = &slf.get().curve;
        let cubic = curve.cubic();
        let knots = cubic.knots();
        let points = curve.map.count();
        let boundary = attributes::boundary_name(curve.boundary()).unwrap_or("tangents");
        let tense = curve.tension().iter().filter(|&&t| t > 0.0).count();
        let tension = match tense {
            _ if curve.family() == Family::Fair => {
                format!("{} extra knots", knots.len() - curve.count())
            }
            0 => "no tension".to_owned(),
            _ => {
                let largest = curve.tension().iter().copied().fold(0.0, f64::max);
                format!("tension up to {} at {tense} of them", short(largest))
            }
        };
        Ok(format!(
            "<{}: {points} points in {}, {tension}; u from {} to {}, boundary {boundary}>",
            slf.get_type().name()?,
            if cubic.dimension().count() == 2 { "the plane" } else { "space" },
            short(knots[0]),
            short(knots[knots.len() - 1]),
        ))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickle::reduce(py, PickledKind::Curve, |bytes| {
            pickle::write_curve(&self.curve, self.search.as_deref(), bytes)
        })
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

/// A number with a few digits, for people.
fn short(x: f64) -> String {
    let magnitude = x.abs();
    if magnitude == 0.0 || (1e-3..1e6).contains(&magnitude) {
        let digits = 5i32.saturating_sub(magnitude.max(1e-3).log10().floor() as i32).clamp(0, 8);
        let text = format!("{x:.*}", digits as usize);
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    } else {
        format!("{x:.5e}")
    }
}

/// Makes calling a curve a documented method.
///
/// pyo3 puts `__call__` into a slot, and Python shows every slot as `(*args, **kwargs)` without a
/// word: the most used method would be the only one without help. Classes outlive a module that is
/// loaded again, so this may have been done.
pub(crate) fn document_call<C: PyClass>(py: Python<'_>) -> PyResult<()> {
    let class = py.get_type::<C>();
    if class.hasattr("_call")? {
        class.setattr("__call__", class.getattr("_call")?)?;
        class.delattr("_call")?;
    }
    Ok(())
}
