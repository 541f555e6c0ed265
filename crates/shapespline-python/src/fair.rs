// SPDX-License-Identifier: MIT OR Apache-2.0

//! `FairSpline`: what is particular to fair curves.

use pyo3::{PyClassInitializer, prelude::*, types::PyTuple};
use shapespline::{
    criteria::Criteria,
    fair::{self, Energy, FairOptions},
    geometry::Repeated,
};

use crate::{
    constraints::Given,
    curve::SpaceCurve,
    fit::{CurveInput, Request, preserve_fair},
    input::Points,
    options::{self, CriteriaNames, Ends, Parameters, tolerances},
};

/// Fair curve: a C² cubic through points that keeps their shape with no more energy than that needs.
///
/// Each segment has at most two extra knots. Where the plain C² cubic keeps the shape, the curve of
/// least parametric energy is the plain cubic.
///
/// Parameters
/// ----------
/// points : array_like, shape (n, 3) or (n, 2)
///     Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
/// parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
///     Parameters of the points: by name, as the exponent e of ``u[i+1] - u[i] = ‖points[i+1] -
///     points[i]‖**e``, or strictly increasing numbers.
/// boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
///     No second derivative at both ends (two names); closed data, whose last point is the first; end
///     tangents of the circles through the first and the last three points; or given tangents at both
///     ends or at one.
/// closed : bool
///     Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
///     parameters then have one entry more, for the return to the first point, unless the points repeat
///     it; so have ``points`` and all other attributes.
/// repeated : {"error", "drop"}
///     What becomes of points that equal the one before them, or are given its parameter: they are
///     refused, or left out. Indices and arrays refer to the points as given in either case;
///     ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
///     nothing of them.
/// energy : {"parametric", "bending"}
///     What is minimised: ``∫|Q''|² du``, or ``∫κ² ds``, which is fairer where chords are uneven. A mended
///     stretch that nearly stops minimises ``∫κ² ds`` in either case.
/// criteria : str or iterable of str, optional
///     What to keep, as for ``NuSpline.shape_preserving``.
/// resolution : float
///     The accuracy of the points, a length: what a move of the points by that much could undo is not
///     asked for.
/// coplanarity, collinearity, tolerance : float
///     As for the method ``check``.
/// max_iterations : int, optional
///     Largest number of Newton steps; by default each phase has a limit of its own.
/// corners : sequence of int or float, optional
///     Points at which the curve has a corner: their indices, or as a float the turning angle in radians
///     from which on points are corners. The data are split there; each part has natural ends at its
///     corners, and the criteria ask for nothing there. Given end tangents hold at the ends of the whole.
/// tangents : dict of int to array_like, optional
///     Directions of the curve at points, by index; lengths do not matter. Those on the wrong side of a
///     chord are refused. Where no curve keeps the shape with them, the nearest directions are taken with
///     which it does, and ``diagnostics.turned`` says by how much they differ.
/// straight : bool
///     Whether the curve is exactly straight along collinear runs of three and more points. Where a run
///     ends in a turn the curve has no curvature and its tangent lies along the run; turning and torsion are
///     asked as ≥ 0 there, and reports say ``straight``. A turn in which two runs meet has to be a corner.
/// max_deviation : float, optional
///     How far at most the curve lies from the chord between its points, a length above a millionth of the
///     longest chord: control points are held within it, and with them the curve.
///
/// Raises
/// ------
/// ConvergenceError
///     If some criterion is violated in the end; it carries the last curve and its report.
/// ValueError, TypeError
///     As for `NuSpline`, and for options outside their ranges.
/// KeyboardInterrupt
///     If Ctrl-C is pressed meanwhile.
///
/// Notes
/// -----
/// The unknowns are first and second derivatives at the points; every criterion is a polynomial
/// inequality in them, and an interior-point method finds a local minimum. The exact check of the
/// control points has the last word. Cost: one solve and check of the plain cubic, O(n), and then what
/// the failing segments need; with the bending energy some tens of Newton steps of O(n) each.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 1], [1, 0], [2, 0], [3, 0.01], [4, 0.03], [5, 1]]
/// >>> curve = ss.FairSpline(points)
/// >>> curve.check().ok
/// True
/// >>> curve.diagnostics.method
/// 'elastic'
#[pyclass(module = "shapespline", frozen, extends = SpaceCurve)]
pub(crate) struct FairSpline;

#[pymethods]
impl FairSpline {
    #[new]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CHORDAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            energy=Energy::Parametric,
            criteria=CriteriaNames::DEFAULT,
            resolution=0.0,
            coplanarity=0.2,
            collinearity=0.2,
            tolerance=1e-9,
            max_iterations=None,
            corners=None,
            tangents=None,
            max_deviation=None,
            straight=false,
        ),
        text_signature = "(points, parameters='chordal', *, boundary='natural', \
                          closed=False, repeated='error', energy='parametric', criteria=None, resolution=0.0, coplanarity=0.2, collinearity=0.2, \
                          tolerance=1e-9, max_iterations=None, corners=None, tangents=None, max_deviation=None, \
                          straight=False)"
    )]
    // One argument a keyword: this is the signature that users see.
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        points: Points,
        parameters: Parameters,
        boundary: Ends,
        #[pyo3(from_py_with = options::closed)] closed: bool,
        #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
        #[pyo3(from_py_with = options::energy)] energy: Energy,
        criteria: CriteriaNames,
        #[pyo3(from_py_with = options::resolution)] resolution: f64,
        #[pyo3(from_py_with = options::coplanarity)] coplanarity: f64,
        #[pyo3(from_py_with = options::collinearity)] collinearity: f64,
        #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
        #[pyo3(from_py_with = options::max_iterations)] max_iterations: Option<usize>,
        corners: Option<&Bound<'_, PyAny>>,
        tangents: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = options::max_deviation)] max_deviation: Option<f64>,
        #[pyo3(from_py_with = options::straight)] straight: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let given = Given::new(corners, tangents, max_deviation, straight, points.dimension)?;
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let criteria = criteria.or(Criteria::OF_FITS);
        let tolerances = tolerances(resolution, coplanarity, collinearity, tolerance)?;
        let options =
            FairOptions { criteria, tolerances, energy, max_iterations, ..FairOptions::default() };
        let base = preserve_fair(
            py,
            input,
            options,
            &given,
            &Request::without_strategy(criteria, tolerances),
        )?;
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }

    /// The points at which the curve has corners, a tuple of indices.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.FairSpline([[0, 0], [2, 0], [2, 2], [3, 3]], corners=1.5).corners
    /// (1,)
    #[getter]
    fn corners<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let base = slf.as_super().get();
        let map = &base.curve.map;
        PyTuple::new(slf.py(), base.curve.corners().iter().map(|&node| map.node(node)))
    }

    /// The segments on which the curve is straight by construction, a tuple of indices.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.FairSpline([[0, 0], [1, 0], [3, 0], [4, 1]], straight=True).straight
    /// (0, 1)
    #[getter]
    fn straight<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let base = slf.as_super().get();
        let map = &base.curve.map;
        PyTuple::new(slf.py(), base.curve.straight().iter().map(|&segment| map.segment(segment)))
    }

    /// What was minimised: ``"parametric"`` or ``"bending"``.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.FairSpline([[0, 0], [3, 4], [3, 5]]).energy
    /// 'parametric'
    #[getter]
    fn energy(slf: &Bound<'_, Self>) -> &'static str {
        let base = slf.as_super().get();
        let curve = base.curve.as_any().downcast_ref::<fair::FairSpline>();
        curve.map_or("", |curve| options::energy_name(curve.energy()))
    }
}
