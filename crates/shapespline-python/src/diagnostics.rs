//! What a search did, for Python.

use pyo3::prelude::*;
use shapespline::search::{self, Phase, Status};

use crate::{
    asked::Asked,
    pickle::{self, Kind, Reduced},
};

/// Diagnostics and history of the search that found a curve.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Search {
    pub(crate) diagnostics: search::Diagnostics,
    pub(crate) history: Vec<search::Step>,
    /// What it was asked for: what a check of the curve asks unless told otherwise.
    pub(crate) asked: Asked,
}

/// Counts of the work that a shape-preserving fit took.
///
/// Attributes
/// ----------
/// status : str
///     ``"solved"``: every criterion holds, by a complete solve and check at the end. Curves that a
///     `ConvergenceError` carries say ``"iteration-limit"`` (``max_iterations`` was reached) or
///     ``"stalled"`` (a criterion fails where tension can rise no further).
/// iterations : int
///     Checks of the curve while tension was raised, the last one, which found no fault, included.
/// solves : int
///     Solves of the system of tangents, complete or in part.
/// relaxations : int
///     Rounds in which tension was lowered again (``strategy="fairest"``).
/// nodes_changed : int
///     Nodes whose tension is not zero in the end.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> ss.NuSpline.shape_preserving(points, "uniform").diagnostics
/// Diagnostics(status='solved', iterations=..., solves=..., relaxations=..., nodes_changed=5)
#[pyclass(module = "shapespline", frozen, get_all, eq, hash, weakref)]
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub(crate) struct Diagnostics {
    /// How the search ended: ``"solved"``, ``"iteration-limit"`` or ``"stalled"``.
    status: String,
    /// Checks of the curve while tension was raised, the last one included.
    iterations: usize,
    /// Solves of the system of tangents, complete or in part.
    solves: usize,
    /// Rounds in which tension was lowered again.
    relaxations: usize,
    /// Nodes whose tension is not zero in the end.
    nodes_changed: usize,
}

impl From<&search::Diagnostics> for Diagnostics {
    fn from(d: &search::Diagnostics) -> Self {
        let status = match d.status {
            Status::Solved => "solved",
            Status::IterationLimit => "iteration-limit",
            Status::Stalled => "stalled",
            Status::Interrupted => "interrupted",
        };
        Self {
            status: status.to_owned(),
            iterations: d.iterations,
            solves: d.solves,
            relaxations: d.relaxations,
            nodes_changed: d.nodes_changed,
        }
    }
}

#[pymethods]
impl Diagnostics {
    fn __repr__(&self) -> String {
        format!(
            "Diagnostics(status='{}', iterations={}, solves={}, relaxations={}, nodes_changed={})",
            self.status, self.iterations, self.solves, self.relaxations, self.nodes_changed
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, Kind::Diagnostics)
    }
}

/// One step of the search for tension.
///
/// Attributes
/// ----------
/// phase : str
///     ``"raise"``: tension was raised where criteria failed; ``"lower"``: tensions were
///     lowered; ``"verify"``: everything was solved and checked anew.
/// violations : int
///     Segments that violated a criterion when the step began.
/// changed : int
///     Nodes whose tension the step changed.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> ss.NuSpline.shape_preserving(points, "uniform").history[0]
/// SearchStep(phase='raise', violations=2, changed=5)
#[pyclass(module = "shapespline", frozen, get_all, eq, hash, weakref)]
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub(crate) struct SearchStep {
    /// ``"raise"``, ``"lower"`` or ``"verify"``.
    phase: String,
    /// Segments that violated a criterion when the step began.
    violations: usize,
    /// Nodes whose tension the step changed.
    changed: usize,
}

impl From<&search::Step> for SearchStep {
    fn from(step: &search::Step) -> Self {
        let phase = match step.phase {
            Phase::Raise => "raise",
            Phase::Lower => "lower",
            Phase::Verify => "verify",
        };
        Self { phase: phase.to_owned(), violations: step.violated, changed: step.changed }
    }
}

#[pymethods]
impl SearchStep {
    fn __repr__(&self) -> String {
        let Self { phase, violations, changed } = self;
        format!("SearchStep(phase='{phase}', violations={violations}, changed={changed})")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, Kind::SearchStep)
    }
}
