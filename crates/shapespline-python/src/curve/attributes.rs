// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a curve was made of, and how: attributes, and the check of its shape.

use numpy::PyArray1;
use pyo3::{IntoPyObjectExt, exceptions::PyAttributeError, prelude::*, types::PyDict};
use shapespline::{
    criteria::Criterion,
    fair::FairSpline,
    geometry::{Boundary, Dimension, Repeated},
};

use super::{Family, SpaceCurve};
use crate::{
    asked::{Asked, Given},
    diagnostics::{Diagnostics, SearchStep, Work},
    fair_diagnostics::{FairDiagnostics, FairStep},
    options::{self, CriteriaNames},
    output::{FloatArray, vectors},
    report::{ShapeReport, Subject},
    tangents::Tangents,
    work::without_gil,
};

/// The name of a boundary that has one.
pub(super) fn boundary_name(boundary: Boundary) -> Option<&'static str> {
    match boundary {
        Boundary::ZeroCurvature => Some("zero-curvature"),
        Boundary::Periodic => Some("periodic"),
        Boundary::Circular => Some("circular"),
        Boundary::Tangents { .. } => None,
    }
}

/// A boundary as Python writes it: its name, or a `Tangents`.
pub(crate) fn boundary_object(
    py: Python<'_>,
    boundary: Boundary,
    dimension: Dimension,
) -> PyResult<Bound<'_, PyAny>> {
    match boundary {
        Boundary::Tangents { start, end } => {
            Ok(Bound::new(py, Tangents::new(start, end, dimension))?.into_any())
        }
        named => Ok(boundary_name(named).unwrap_or_default().into_pyobject(py)?.into_any()),
    }
}

#[pymethods]
impl SpaceCurve {
    /// The points that the curve interpolates, shape (n, dim); a fresh array.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [1, 2]]).points
    /// array([[0., 0.],
    ///        [1., 2.]])
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        let nodes = self.curve.at_nodes(self.curve.cubic().points());
        let points = self.curve.map.points(&nodes);
        vectors(py, &points, self.curve.cubic().dimension())
    }

    /// The parameters of the points, increasing, shape (n,); a fresh array.
    ///
    /// A point that was left out (``repeated="drop"``) has the parameter of the point it repeats.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4], [3, 5]]).parameters
    /// array([0., 5., 6.])
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let nodes = self.curve.at_nodes(self.curve.cubic().knots());
        PyArray1::from_vec(py, self.curve.of_points(&nodes))
    }

    /// The parameters at which the pieces of the curve meet, strictly increasing; a fresh array.
    ///
    /// Those of the points, but for points that were left out, and the extra knots of a `FairSpline`: one
    /// more than ``bezier`` has pieces.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> curve = ss.NuSpline([[0, 0], [3, 4], [3, 4], [3, 5]], repeated="drop")
    /// >>> curve.knots, curve.parameters
    /// (array([0., 5., 6.]), array([0., 5., 5., 6.]))
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.curve.cubic().knots())
    }

    /// The first derivatives at the points, shape (n, dim), in units of the points over units of the
    /// parameter; a fresh array.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4]]).tangents
    /// array([[0.6, 0.8],
    ///        [0.6, 0.8]])
    #[getter]
    fn tangents<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        let tangents = self.curve.of_points(&self.curve.tangents());
        vectors(py, &tangents, self.curve.cubic().dimension())
    }

    /// The tension at each point, shape (n,), without unit: 0 is none, and more of it pulls the curve
    /// towards the polygon; a fresh array.
    ///
    /// For a ν-spline this is ν, for a `TensionSpline` 1/λ − 1 (of the smaller λ beside the point), and
    /// for a `CatmullRom` the part by which its handles were shortened. Of closed data the first and the last point are one node and have
    /// one tension.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4], [3, 5]], tension=2).tension
    /// array([2., 2., 2.])
    #[getter]
    fn tension<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if self.curve.family() == Family::Fair {
            return Err(PyAttributeError::new_err("a FairSpline has no tension"));
        }
        Ok(PyArray1::from_vec(py, self.curve.of_points(self.curve.tension())))
    }

    /// The end conditions: ``"zero-curvature"``, ``"periodic"``, ``"circular"`` or a `Tangents`.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4]], boundary="natural").boundary
    /// 'zero-curvature'
    #[getter]
    fn boundary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        boundary_object(py, self.curve.boundary(), self.curve.cubic().dimension())
    }

    /// What the search took and which points were left out, a `Diagnostics`, or a `FairDiagnostics` of a
    /// `FairSpline`; ``None`` for a curve of given tension, unless it was made with
    /// ``repeated="drop"``.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline.shape_preserving([[0, 0], [3, 4], [3, 5]]).diagnostics.status
    /// 'solved'
    #[getter]
    fn diagnostics(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let dropped = self.curve.map.dropped();
        match self.search.as_ref().map(|search| &search.work) {
            None if self.curve.repeated == Repeated::Error => return Ok(None),
            None => Diagnostics::given(dropped).into_py_any(py),
            Some(Work::Tension(found, _)) => Diagnostics::of(found, dropped).into_py_any(py),
            Some(Work::Fair(found, _)) => {
                let Some(curve) = self.curve.as_any().downcast_ref::<FairSpline>() else {
                    return Ok(None);
                };
                let of = || FairDiagnostics::of(found, &self.curve.map, curve);
                without_gil(py, 0, of).into_py_any(py)
            }
        }
        .map(Some)
    }

    /// The steps of the search, a list of `SearchStep`, or of `FairStep` of a `FairSpline`; ``None`` for
    /// a curve of given tension.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> steps = ss.NuSpline.shape_preserving(points, "uniform").history
    /// >>> steps[0].violations, steps[-1].violations
    /// (2, 0)
    #[getter]
    fn history(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let Some(search) = &self.search else { return Ok(None) };
        match &search.work {
            Work::Tension(_, steps) => {
                steps.iter().map(SearchStep::from).collect::<Vec<_>>().into_py_any(py)
            }
            Work::Fair(_, steps) => {
                steps.iter().map(FairStep::from).collect::<Vec<_>>().into_py_any(py)
            }
        }
        .map(Some)
    }

    /// Return the options of the fit by the names of `check`, `None` for given tension. For files.
    fn _fit_options<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(search) = &self.search else { return Ok(None) };
        let Asked { criteria, tolerances, .. } = search.asked;
        let names: Vec<_> = criteria.iter().map(Criterion::name).collect();
        let options = PyDict::new(py);
        options.set_item("criteria", names)?;
        options.set_item("resolution", tolerances.resolution)?;
        options.set_item("coplanarity", tolerances.coplanarity)?;
        options.set_item("collinearity", tolerances.collinearity)?;
        options.set_item("tolerance", tolerances.zero)?;
        Ok(Some(options))
    }

    /// Discrete torsion of the data on each segment, in reciprocal units of the points, shape
    /// (segments,); NaN where there is none. For figures.
    fn _discrete_torsion<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let polygon = self.curve.polygon();
        let of_all = || (0..polygon.segments()).map(|i| polygon.discrete_torsion(i)).collect();
        PyArray1::from_vec(py, without_gil(py, polygon.segments(), of_all))
    }

    /// Check whether the curve keeps the shape of its points.
    ///
    /// Parameters
    /// ----------
    /// criteria : str or iterable of str, optional
    ///     Any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``, ``"coplanarity"``,
    ///     ``"collinearity"``, ``"global-convexity"`` and ``"regular"``. Default of a shape-preserving
    ///     curve: those it was fitted with; else all but the last two. Whether the curve is regular,
    ///     γ' ≠ 0, is asked in any case, and listed where it is not.
    /// resolution : float, optional
    ///     Accuracy of the points, in their units: what a move of the points by that much could undo is not
    ///     asked for. Default: that of the fit, else 0.
    /// coplanarity, collinearity : float, optional
    ///     ε₁ and ε₀ in (0, 1]: sine of the largest angle between binormal and plane normal where four
    ///     points lie in a plane, and between tangent and line where three lie on a line. Default:
    ///     those of the fit, else 0.2.
    /// tolerance : float, optional
    ///     In [0, 1): points whose turning angle has a smaller sine count as collinear, and four whose
    ///     unit chords span a smaller volume as coplanar. Default: that of the fit, else 1e-9.
    ///
    /// Returns
    /// -------
    /// ShapeReport
    ///     The violations, counts, and margins of all segments.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a criterion is unknown or a tolerance outside its range.
    ///
    /// Notes
    /// -----
    /// Every criterion is decided exactly, from the Bézier legs of each cubic segment; nothing is
    /// sampled. Karavelas & Kaklis, Numer. Algorithms 23 (2000), Problem (P) and (5.34)–(5.57), with
    /// inflection added; turning at the points is (i.3) of Manni, *Parametric shape-preserving spatial
    /// interpolation and ν-splines* (2001), with (12.1) of Gautam. Where the points double back on
    /// themselves a shape-preserving curve may have to stop, and its own check lets it, unless
    /// ``"regular"`` is named. Cost O(n), on all threads for long curves.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> ss.NuSpline(points, "uniform").check().counts()["convexity"]
    /// (2, 2)
    /// >>> ss.NuSpline.shape_preserving(points, "uniform").check().ok
    /// True
    #[pyo3(
        signature = (
            criteria=CriteriaNames::DEFAULT, *, resolution=None, coplanarity=None, collinearity=None, tolerance=None
        ),
        text_signature = "($self, criteria=None, *, resolution=None, coplanarity=None, collinearity=None, \
                          tolerance=None)"
    )]
    fn check(
        &self,
        py: Python<'_>,
        criteria: CriteriaNames,
        #[pyo3(from_py_with = options::optional_resolution)] resolution: Option<f64>,
        #[pyo3(from_py_with = options::optional_coplanarity)] coplanarity: Option<f64>,
        #[pyo3(from_py_with = options::optional_collinearity)] collinearity: Option<f64>,
        #[pyo3(from_py_with = options::optional_tolerance)] tolerance: Option<f64>,
    ) -> PyResult<ShapeReport> {
        let asked = self.search.as_ref().map_or_else(Asked::default, |search| search.asked);
        let asked =
            asked.with(Given { criteria, resolution, coplanarity, collinearity, tolerance })?;
        ShapeReport::make(py, Subject::Own(self.curve.clone()), asked)
    }
}
