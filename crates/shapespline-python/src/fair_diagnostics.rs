// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the search for a `FairSpline` did, for Python.

use pyo3::{
    prelude::*,
    types::{PyDict, PyList, PyTuple},
};
use shapespline::{
    fair::{self, Energy, Phase, Status},
    geometry::{InputMap, largest_curvature},
};

use crate::pickle::{self, PickledKind, Reduced};

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
/// iterations : int
///     Newton steps.
/// solves : int
///     Linear systems solved.
/// energy : float
///     The energy that was asked for, in the user's units.
/// energy_cubic : float
///     That energy of the plain C² cubic with the same parameters and ends.
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
/// turned : dict
///     Where no curve was found that keeps the shape in the directions ``tangents=``: the points at which it
///     has the nearest that were, each with the angle between the two in radians.
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
        found.turned.iter_mut().for_each(|(node, _)| *node = map.node(*node));
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

    /// The points at which the curve has another direction than was asked for, each with the angle between
    /// the two; a fresh dict.
    #[getter]
    fn turned<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let turned = PyDict::new(py);
        for (point, angle) in &self.found.turned {
            turned.set_item(point, angle)?;
        }
        Ok(turned)
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
        pickle::reduce_whole(slf, PickledKind::FairDiagnostics)
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
        pickle::reduce_whole(slf, PickledKind::FairStep)
    }
}
