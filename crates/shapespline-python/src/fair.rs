//! `FairSpline`: what is particular to fair curves.

use pyo3::{
    PyClassInitializer,
    prelude::*,
    types::{PyDict, PyList, PyTuple},
};
use shapespline::{
    criteria::Criteria,
    fair::{self, Energy, FairOptions, Phase, Status},
    geometry::{InputMap, Repeated, largest_curvature},
};

use crate::{
    constraints::Given,
    curve::SpaceCurve,
    fit::{CurveInput, Request, preserve_fair},
    input::Points,
    options::{self, CriteriaNames, Ends, Parameters, tolerances},
    pickle::{self, Kind, Reduced},
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
///     tangents of the circles through the first and the last three points; or given end tangents.
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
///     What is minimised: ``∫|Q''|² du``, or ``∫κ² ds``, which is fairer where chords are uneven.
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
///     from which on points are corners. The data are split there; each part has natural ends, and the
///     criteria ask for nothing at a corner. Needs natural or periodic ends.
/// tangents : dict of int to array_like, optional
///     Directions of the curve at points, by index; lengths do not matter. What torsion asks may not go
///     together with them.
/// max_deviation : float, optional
///     How far at most the curve lies from the chord between its points, a length: control points are held
///     within it, and with them the curve.
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
        ),
        text_signature = "(points, parameters='chordal', *, boundary='natural', \
                          closed=False, repeated='error', energy='parametric', criteria=None, resolution=0.0, coplanarity=0.2, collinearity=0.2, \
                          tolerance=1e-9, max_iterations=None, corners=None, tangents=None, max_deviation=None)"
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
    ) -> PyResult<PyClassInitializer<Self>> {
        let given = Given::new(corners, tangents, max_deviation, points.dimension)?;
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

/// How a `FairSpline` was found, and what it came to.
///
/// Attributes
/// ----------
/// status : str
///     ``"solved"``: no criterion is violated, and ``check().undecided`` is empty but for signs that
///     rounding hides in nearly degenerate data. Curves that a `ConvergenceError` carries say
///     ``"iteration-limit"``.
/// method : str
///     The rung of the ladder that the hardest part needed: ``"cubic"`` (the plain C² cubic keeps the
///     shape), ``"elastic"``, ``"windows"``, ``"sweeps"`` or ``"start"``.
/// iterations, solves : int
///     Newton steps, and linear systems solved.
/// energy, energy_cubic : float
///     The energy that was asked for, in the user's units, and that of the plain C² cubic with the same
///     parameters and ends.
/// gap : float or None
///     ``energy / energy_cubic - 1``: no curve through the points has less parametric energy than the
///     plain cubic. ``None`` with ``energy="bending"``, where given tangents were shortened, and where
///     the cubic is a line.
/// active : dict
///     The criteria that hold the curve back, each with the segments where it does.
/// dropped : tuple of int
///     Indices of the points that were left out (``repeated="drop"``).
/// tangent_scale : tuple of float
///     By how much given end tangents were shortened, where no curve of their length keeps the shape, at
///     the start and at the end: 1 where they were not.
/// extra_knots : int
///     Knots beside those at the points.
/// max_curvature : float
///     The largest curvature, per unit of length.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> ss.FairSpline([[0, 0], [3, 4], [3, 5]]).diagnostics
/// FairDiagnostics(status='solved', method='cubic', iterations=0, extra_knots=0)
#[pyclass(module = "shapespline", frozen, eq, weakref)]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct FairDiagnostics {
    found: fair::Diagnostics,
    dropped: Vec<usize>,
    parametric: bool,
    max_curvature: f64,
}

impl FairDiagnostics {
    pub(crate) fn of(found: &fair::Diagnostics, map: &InputMap, curve: &fair::FairSpline) -> Self {
        let mut found = found.clone();
        for segment in found.active.iter_mut().flat_map(|(_, segments)| segments) {
            *segment = map.segment(*segment);
        }
        Self {
            found,
            dropped: map.dropped().to_vec(),
            parametric: curve.energy() == Energy::Parametric,
            max_curvature: largest_curvature(curve.curve()),
        }
    }
}

#[pymethods]
impl FairDiagnostics {
    /// ``"solved"`` or ``"iteration-limit"``.
    #[getter]
    fn status(&self) -> &'static str {
        match self.found.status {
            Status::Solved => "solved",
            Status::IterationLimit => "iteration-limit",
            Status::Interrupted => "interrupted",
        }
    }

    /// The rung of the ladder that the hardest part needed.
    #[getter]
    fn method(&self) -> &'static str {
        self.found.method.name()
    }

    /// Number of Newton steps, in all windows together.
    #[getter]
    fn iterations(&self) -> usize {
        self.found.iterations
    }

    /// Number of linear systems solved.
    #[getter]
    fn solves(&self) -> usize {
        self.found.solves
    }

    /// The energy that was asked for, in the user's units.
    #[getter]
    fn energy(&self) -> f64 {
        self.found.energy
    }

    /// That of the plain C² cubic with the same parameters and ends.
    #[getter]
    fn energy_cubic(&self) -> f64 {
        self.found.energy_cubic
    }

    /// How far the parametric energy lies above its lower bound; ``None`` with the bending energy.
    #[getter]
    fn gap(&self) -> Option<f64> {
        let fair::Diagnostics { energy, energy_cubic, tangent_scale, .. } = self.found;
        let same_ends = tangent_scale == [1.0; 2];
        (self.parametric && same_ends && energy_cubic > 0.0).then(|| energy / energy_cubic - 1.0)
    }

    /// The criteria that hold the curve back, each with the segments where it does; a fresh dict.
    #[getter]
    fn active<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let active = PyDict::new(py);
        for (criterion, segments) in &self.found.active {
            active.set_item(criterion.name(), PyList::new(py, segments)?)?;
        }
        Ok(active)
    }

    /// By how much given end tangents were shortened, at the start and at the end: 1 where they were not.
    #[getter]
    fn tangent_scale(&self) -> (f64, f64) {
        self.found.tangent_scale.into()
    }

    /// Indices of the points that were left out, ascending (``repeated="drop"``).
    #[getter]
    fn dropped<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.dropped)
    }

    /// Knots beside those at the points.
    #[getter]
    fn extra_knots(&self) -> usize {
        self.found.extra_knots
    }

    /// The largest curvature, per unit of length.
    #[getter]
    fn max_curvature(&self) -> f64 {
        self.max_curvature
    }

    fn __repr__(&self) -> String {
        format!(
            "FairDiagnostics(status='{}', method='{}', iterations={}, extra_knots={})",
            self.status(),
            self.method(),
            self.found.iterations,
            self.found.extra_knots
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, Kind::FairDiagnostics)
    }
}

/// One phase of the search for a `FairSpline`, on one window.
///
/// Attributes
/// ----------
/// phase : str
///     ``"elastic"``: pulling a failing curve into shape; ``"restart"``: from the closed-form start where
///     that stopped short; ``"improve"``: bringing the energy down.
/// violations : int
///     Segments of the window that failed when the phase began.
/// iterations : int
///     Newton steps that it took.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 1], [1, 0], [2, 0], [3, 0.01], [4, 0.03], [5, 1]]
/// >>> ss.FairSpline(points).history[0]
/// FairStep(phase='elastic', violations=..., iterations=...)
#[pyclass(module = "shapespline", frozen, get_all, eq, hash, weakref)]
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub(crate) struct FairStep {
    /// ``"elastic"``, ``"restart"`` or ``"improve"``.
    phase: String,
    /// Segments of the window that failed when the phase began.
    violations: usize,
    /// Newton steps that it took.
    iterations: usize,
}

impl From<&fair::Step> for FairStep {
    fn from(step: &fair::Step) -> Self {
        let phase = match step.phase {
            Phase::Elastic => "elastic",
            Phase::Restart => "restart",
            Phase::Improve => "improve",
        };
        let (violations, iterations) = (step.failing, step.iterations);
        Self { phase: phase.to_owned(), violations, iterations }
    }
}

#[pymethods]
impl FairStep {
    fn __repr__(&self) -> String {
        let Self { phase, violations, iterations } = self;
        format!("FairStep(phase='{phase}', violations={violations}, iterations={iterations})")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, Kind::FairStep)
    }
}
