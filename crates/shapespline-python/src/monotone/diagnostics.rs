// SPDX-License-Identifier: MIT OR Apache-2.0

//! How a monotone fit went, for Python.

use pyo3::prelude::*;
use shapespline::monotone::{Diagnostics, MonotoneQuartic, SolverKind};

use crate::pickle::{self, PickledKind, Reduced};

/// How the optimisation of one column went. The function is monotone whatever these numbers say.
///
/// Attributes
/// ----------
/// solver : str
///     ``"newton"`` (cubic), ``"active-set"`` (quintic, slopes of Fritsch and Butland), ``"interior-point"`` (quintic, optimal
///     or given slopes) or ``"local"`` (quartic).
/// iterations : int
///     Linear solves.
/// active : int
///     Conditions that hold with equality; of the cubic: intervals with a level part; of the quartic:
///     segments whose α, β were scaled down.
/// kkt_residual : float
///     Largest violation of the optimality conditions, scaled. Of the interior point, and of the cubic
///     without layers: a bound of how far the energy is above the exact optimum, as a part of it
///     (infinite where none was reached).
/// converged : bool
///     Whether the method ended by its own criterion.
/// certified : bool
///     Whether Bernstein coefficients certify every segment to be monotone.
/// energy : float
///     The minimised energy, in the data's units.
/// limited : list of int
///     Points whose given slopes were limited (``clip=True``).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> how = ss.MonotoneQuintic([0, 1, 2, 5], [0, 0.1, 3, 3.2]).diagnostics
/// >>> how.solver, how.converged, how.certified
/// ('interior-point', True, True)
#[pyclass(module = "shapespline", frozen, get_all, eq, weakref)]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct MonotoneDiagnostics {
    /// The method: ``"newton"``, ``"active-set"``, ``"interior-point"`` or ``"local"``.
    solver: String,
    /// Linear solves of the optimisation.
    iterations: usize,
    /// Conditions that hold with equality.
    active: usize,
    /// Scaled violation of the optimality conditions, or bound of the distance from the optimum.
    kkt_residual: f64,
    /// Whether the method ended by its own criterion.
    converged: bool,
    /// Whether every segment was certified to be monotone.
    certified: bool,
    /// The minimised energy, in the data's units.
    energy: f64,
    /// Points whose given slopes were limited.
    limited: Vec<usize>,
}

impl MonotoneDiagnostics {
    pub(crate) fn of(d: &Diagnostics) -> Self {
        let solver = match d.solver {
            SolverKind::ActiveSet => "active-set",
            SolverKind::InteriorPoint => "interior-point",
            SolverKind::Newton => "newton",
        };
        Self {
            solver: solver.to_owned(),
            iterations: d.iterations,
            active: d.active,
            kkt_residual: d.kkt_residual,
            converged: d.converged,
            certified: d.certified,
            energy: d.energy,
            limited: d.limited.clone(),
        }
    }

    pub(crate) fn quartic(fit: &MonotoneQuartic) -> Self {
        Self {
            solver: "local".to_owned(),
            iterations: 0,
            active: fit.scale().iter().filter(|s| **s < 1.0).count(),
            kkt_residual: 0.0,
            converged: true,
            certified: true,
            energy: fit.bending_energy(),
            limited: Vec::new(),
        }
    }
}

#[pymethods]
impl MonotoneDiagnostics {
    fn __repr__(&self) -> String {
        let truth = |value| if value { "True" } else { "False" };
        format!(
            "MonotoneDiagnostics(solver='{}', iterations={}, active={}, kkt_residual={:e}, \
             converged={}, certified={}, energy={}, limited={:?})",
            self.solver,
            self.iterations,
            self.active,
            self.kkt_residual,
            truth(self.converged),
            truth(self.certified),
            self.energy,
            self.limited,
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::MonotoneDiagnostics)
    }
}
