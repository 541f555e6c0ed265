// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a search did, for Python.

use pyo3::{prelude::*, types::PyTuple};
use shapespline::{
    fair,
    search::{self, Phase, Status},
};

use crate::{
    asked::Asked,
    pickle::{self, PickledKind, Reduced},
};

/// Diagnostics and history, by what was searched for.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Work {
    /// Tension.
    Tension(search::Diagnostics, Vec<search::Step>),
    /// A fair curve.
    Fair(fair::Diagnostics, Vec<fair::Step>),
}

/// Diagnostics and history of the search that found a curve.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Search {
    pub(crate) work: Work,
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
///     ``"stalled"`` (a criterion fails where tension can rise no further). ``"given"``: there was no
///     search.
/// iterations : int
///     Checks of the curve while tension was raised, the last one, which found no violation, included.
/// solves : int
///     Solves of the system of tangents, complete or in part.
/// relaxations : int
///     How often tensions were tried to be lowered again (``strategy="fairest"``).
/// nodes_changed : int
///     Nodes whose tension is not zero in the end.
/// dropped : tuple of int
///     Indices of the points that were left out (``repeated="drop"``).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> ss.NuSpline.shape_preserving(points, "uniform").diagnostics
/// Diagnostics(status='solved', iterations=..., solves=..., relaxations=..., nodes_changed=2)
#[pyclass(module = "shapespline", frozen, eq, hash, weakref)]
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub(crate) struct Diagnostics {
    /// How the search ended: ``"solved"``, ``"iteration-limit"`` or ``"stalled"``; ``"given"`` without
    /// one.
    #[pyo3(get)]
    status: String,
    /// Checks of the curve while tension was raised, the last one included.
    #[pyo3(get)]
    iterations: usize,
    /// Solves of the system of tangents, complete or in part.
    #[pyo3(get)]
    solves: usize,
    /// How often tensions were tried to be lowered again.
    #[pyo3(get)]
    relaxations: usize,
    /// Nodes whose tension is not zero in the end.
    #[pyo3(get)]
    nodes_changed: usize,
    /// Indices of the points that were left out.
    dropped: Vec<usize>,
}

impl Diagnostics {
    /// Of a curve of given tension.
    pub(crate) fn given(dropped: &[usize]) -> Self {
        let (status, dropped) = ("given".to_owned(), dropped.to_vec());
        Self { status, iterations: 0, solves: 1, relaxations: 0, nodes_changed: 0, dropped }
    }

    pub(crate) fn of(d: &search::Diagnostics, dropped: &[usize]) -> Self {
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
            dropped: dropped.to_vec(),
        }
    }
}

#[pymethods]
impl Diagnostics {
    /// Indices of the points that were left out, ascending (``repeated="drop"``).
    #[getter]
    fn dropped<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.dropped)
    }

    fn __repr__(&self) -> String {
        let dropped = match self.dropped.len() {
            0 => String::new(),
            1 => ", 1 point left out".to_owned(),
            n => format!(", {n} points left out"),
        };
        format!(
            "Diagnostics(status='{}', iterations={}, solves={}, relaxations={}, nodes_changed={}{dropped})",
            self.status, self.iterations, self.solves, self.relaxations, self.nodes_changed
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::Diagnostics)
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
        pickle::reduce_whole(slf, PickledKind::SearchStep)
    }
}
