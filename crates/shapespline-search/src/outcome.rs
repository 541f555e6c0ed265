// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a search did.

use shapespline_criteria::{ShapeReport, Violations};
use shapespline_geometry::DVec3;

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Status {
    /// No criterion is violated, by a complete solve and check at the end; what is undecided, tension did
    /// not help.
    Solved,
    /// The caller's limit of iterations was reached first.
    IterationLimit,
    /// A segment fails at whose nodes tension can rise no further: it is as large as it can be.
    Stalled,
    /// The caller's monitor asked to stop.
    Interrupted,
}

/// What a step of the search did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Phase {
    /// Tension was raised where criteria failed.
    Raise,
    /// Tensions were lowered, each by itself.
    Lower,
    /// Everything was solved and checked anew.
    Verify,
}

/// One step of the history.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step {
    /// What the step did.
    pub phase: Phase,
    /// Segments that violated a criterion when it began.
    pub violated: usize,
    /// Nodes whose tension it changed.
    pub changed: usize,
}

/// Counts of the work done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Diagnostics {
    /// How the search ended.
    pub status: Status,
    /// Checks of the curve while raising, the last one (that found no violation) included.
    pub iterations: usize,
    /// Solves, complete or in part.
    pub solves: usize,
    /// Tensions that were tried to be lowered.
    pub relaxations: usize,
    /// Nodes whose tension is not zero in the end.
    pub nodes_changed: usize,
}

/// Diagnostics, history, and what still fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Counts of the work done.
    pub diagnostics: Diagnostics,
    /// The steps in order.
    pub history: Vec<Step>,
    /// Segments that fail still, with their violations: empty when solved.
    pub violations: Vec<(usize, Violations)>,
    /// Segments of which rounding hides whether they keep the shape: tension did not help.
    pub undecided: Vec<usize>,
}

impl Outcome {
    /// The outcome of a first check that found no violation.
    #[must_use]
    pub fn solved() -> Self {
        let status = Status::Solved;
        let diagnostics =
            Diagnostics { status, iterations: 1, solves: 1, relaxations: 0, nodes_changed: 0 };
        Self { diagnostics, history: Vec::new(), violations: Vec::new(), undecided: Vec::new() }
    }
}

/// What a search leaves of a curve that is still to be put together.
#[derive(Debug, Clone)]
pub struct FittedLegs {
    /// First and last leg of each segment.
    pub legs: Vec<[DVec3; 2]>,
    /// How they were found.
    pub outcome: Outcome,
    /// The last complete check.
    pub report: ShapeReport,
}

/// A curve together with how it was found and what a check says of it.
#[derive(Debug, Clone)]
pub struct Fit<C> {
    /// The curve.
    pub curve: C,
    /// How it was found; see the status before trusting the curve.
    pub outcome: Outcome,
    /// The last complete check.
    pub report: ShapeReport,
}
