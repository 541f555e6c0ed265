// SPDX-License-Identifier: MIT OR Apache-2.0

//! `fairness`: the measures of fairness of any curve.

use pyo3::{prelude::*, types::PyTuple};
use shapespline::geometry::{self, Place, fairness_with};

use crate::{
    curve::SpaceCurve,
    pickle::{self, PickledKind, Reduced},
    piecewise::PiecewiseBezier,
    work::{GoOn, interrupted, interruptible},
};

/// How fair a curve is: six measures, and where it has cusps and corners.
///
/// ``bending``, ``variation`` and ``max_curvature_jump`` are free of scale: they are multiplied by the
/// power of the length that makes them so. Immutable and picklable.
///
/// Attributes
/// ----------
/// length : float
///     Arc length L, in units of the points.
/// bending : float
///     L∫κ²ds, without unit: 4π² for a circle, infinite at corners and cusps.
/// variation : float
///     L³∫(κ'² + κ²τ²)ds, without unit, derivatives by arc length (in the plane L³∫κ'²ds): 0 for lines and
///     circles, infinite where the curvature vector jumps.
/// max_curvature : float
///     The largest curvature, per unit of length; infinite at corners and cusps.
/// max_curvature_at : float
///     The parameter of it.
/// curvature_extrema : int
///     Number of extrema of curvature inside the curve, in the plane of signed curvature.
/// max_curvature_jump : float
///     L times the largest jump of the curvature vector, without unit.
/// cusps : tuple of float
///     Parameters at which the speed vanishes, to rounding.
/// corners : tuple of float
///     Parameters at which position or direction jumps.
///
/// Notes
/// -----
/// Extrema are sign changes of a polynomial, isolated by Bernstein subdivision with an error bound; nothing
/// is sampled. The integrals are taken between them, by adaptive quadrature. Directions that differ by less
/// than 1e-6 rad count as equal, and curvatures that differ by less than 1e-9 of themselves. Farin & Sapidis,
/// IEEE Comput. Graph. Appl. 9 (1989) 52–57, doi:10.1109/38.19051; Moreton & Séquin, Comput. Graph. 26 (1992)
/// 167–176, doi:10.1145/133994.134035.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> fairness = ss.fairness(ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]))
/// >>> fairness.curvature_extrema, fairness.max_curvature_jump, fairness.cusps
/// (2, 0.0, ())
#[pyclass(module = "shapespline", frozen, eq, weakref)]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Fairness {
    /// Arc length L, in units of the points.
    #[pyo3(get)]
    length: f64,
    /// L∫κ²ds, without unit.
    #[pyo3(get)]
    bending: f64,
    /// L³∫(κ'² + κ²τ²)ds, without unit.
    #[pyo3(get)]
    variation: f64,
    /// The largest curvature, per unit of length.
    #[pyo3(get)]
    max_curvature: f64,
    /// The parameter of the largest curvature.
    #[pyo3(get)]
    max_curvature_at: f64,
    /// Number of extrema of curvature inside the curve.
    #[pyo3(get)]
    curvature_extrema: usize,
    /// L times the largest jump of the curvature vector.
    #[pyo3(get)]
    max_curvature_jump: f64,
    cusps: Vec<f64>,
    corners: Vec<f64>,
}

impl Fairness {
    /// The measures of a curve, whose places have the parameters that `parameter` says; none after Ctrl-C.
    pub(crate) fn of(
        curve: &geometry::PiecewiseBezier,
        parameter: impl Fn(Place) -> f64,
        go_on: GoOn<'_>,
    ) -> Option<Self> {
        let found = fairness_with(curve, go_on)?;
        let of_break = |&k: &usize| parameter(Place { piece: k - 1, t: 1.0 });
        Some(Self {
            length: found.length,
            bending: found.bending,
            variation: found.variation,
            max_curvature: found.max_curvature,
            max_curvature_at: parameter(found.max_curvature_at),
            curvature_extrema: found.extrema.len(),
            max_curvature_jump: found.max_curvature_jump,
            cusps: found.cusps.iter().map(|&place| parameter(place)).collect(),
            corners: found.corners.iter().map(of_break).collect(),
        })
    }
}

#[pymethods]
impl Fairness {
    /// Parameters at which the speed vanishes, to rounding.
    #[getter]
    fn cusps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.cusps)
    }

    /// Parameters at which position or direction jumps.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.corners)
    }

    fn __repr__(&self) -> String {
        let list = |places: &[f64]| match places {
            [one] => format!("({one},)"),
            more => format!("({})", more.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
        };
        format!(
            "Fairness(length={}, bending={}, variation={}, max_curvature={}, max_curvature_at={}, \
             curvature_extrema={}, max_curvature_jump={}, cusps={}, corners={})",
            self.length,
            self.bending,
            self.variation,
            self.max_curvature,
            self.max_curvature_at,
            self.curvature_extrema,
            self.max_curvature_jump,
            list(&self.cusps),
            list(&self.corners),
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::Fairness)
    }
}

#[pymethods]
impl SpaceCurve {
    /// Measure how fair the curve is: bending, variation and extrema of its curvature.
    ///
    /// Returns
    /// -------
    /// Fairness
    ///     Six measures, and the parameters of cusps and corners.
    ///
    /// See Also
    /// --------
    /// fairness : the same of any curve, with the definitions.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4]]).fairness().length
    /// 5.0
    fn fairness(&self, py: Python<'_>) -> PyResult<Fairness> {
        let cubic = self.curve.cubic();
        let path = self.curve.path();
        let parameter = |place: Place| path.parameter(place.piece, place.t);
        let of = |go_on: GoOn<'_>| Fairness::of(&cubic.into(), parameter, go_on);
        interruptible(py, cubic.segments(), of)?.ok_or_else(interrupted)
    }
}

#[pymethods]
impl PiecewiseBezier {
    /// Measure how fair the curve is: bending, variation and extrema of its curvature.
    ///
    /// Returns
    /// -------
    /// Fairness
    ///     Six measures, and the parameters of cusps and corners.
    ///
    /// See Also
    /// --------
    /// fairness : the same of any curve, with the definitions.
    ///
    /// Examples
    /// --------
    /// A quarter of a circle:
    ///
    /// >>> import shapespline as ss
    /// >>> arc = ss.PiecewiseBezier([[[1, 0], [1, 1], [0, 1]]], [0, 1], weights=[[1, 0.5**0.5, 1]])
    /// >>> round(arc.fairness().max_curvature, 12), arc.fairness().curvature_extrema
    /// (1.0, 0)
    fn fairness(&self, py: Python<'_>) -> PyResult<Fairness> {
        let curve = &self.curve;
        let breaks = curve.breaks();
        let parameter =
            |Place { piece, t }: Place| breaks[piece] * (1.0 - t) + breaks[piece + 1] * t;
        let of = |go_on: GoOn<'_>| Fairness::of(curve, parameter, go_on);
        interruptible(py, curve.pieces(), of)?.ok_or_else(interrupted)
    }
}
