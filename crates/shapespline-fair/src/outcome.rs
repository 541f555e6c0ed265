// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a fit did, and what it came to.

use shapespline_banded::SolveError;
use shapespline_criteria::{Criterion, ShapeReport};
use shapespline_geometry::InputError;

use crate::FairSpline;

/// Unusable input, or a system that f64 cannot hold.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Unusable input.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The plain cubic cannot be solved for (overflow: the system itself never is singular).
    #[error("the tangents cannot be computed: {0}")]
    Solve(#[from] SolveError),
}

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Status {
    /// No criterion is violated on the exported control points. All are proved but those that the report
    /// lists as undecided: no rung of the ladder has a curve on which rounding does not hide them.
    Solved,
    /// Some criterion is violated, and nothing more is to be tried.
    IterationLimit,
    /// The caller's monitor asked to stop.
    Interrupted,
}

/// The rung of the ladder that the curve, or the hardest part of it, needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Method {
    /// The plain C² cubic keeps the shape.
    Cubic,
    /// The elastic barrier led from the plain cubic to a feasible curve.
    Elastic,
    /// Parts were restarted from the closed-form start.
    Windows,
    /// All of a stretch was put to the closed-form start, and improved from there.
    Sweeps,
    /// The closed-form start itself.
    Start,
}

impl Method {
    /// The name users read.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cubic => "cubic",
            Self::Elastic => "elastic",
            Self::Windows => "windows",
            Self::Sweeps => "sweeps",
            Self::Start => "start",
        }
    }
}

/// What a step of the search is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Phase {
    /// Pulling a failing curve into shape.
    Elastic,
    /// Restarting where that stopped short, or where the curve nearly stops.
    Restart,
    /// Bringing the energy down inside the barrier.
    Improve,
}

/// One step of the history: a phase on one window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step {
    /// What the step was part of.
    pub phase: Phase,
    /// Segments of the window that failed when it began.
    pub failing: usize,
    /// Newton steps that it took.
    pub iterations: usize,
}

/// Counts of the work done, and measures of the curve.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Diagnostics {
    /// How the fit ended.
    pub status: Status,
    /// How the curve was found.
    pub method: Method,
    /// Newton steps, in all windows together.
    pub iterations: usize,
    /// Linear systems solved.
    pub solves: usize,
    /// The energy that was asked for, in the user's units: `∫|Q''|²du`, or `∫κ²ds`.
    pub energy: f64,
    /// The same of the plain C² cubic with the same parameters and ends: a lower bound of the parametric
    /// energy of any curve through the data.
    pub energy_cubic: f64,
    /// Knots beside those at the data points.
    pub extra_knots: usize,
    /// The criteria that hold the curve back, each with the segments where it does.
    pub active: Vec<(Criterion, Vec<usize>)>,
    /// By how much given end tangents were shortened, at the start and at the end: 1 where they were not.
    pub tangent_scale: [f64; 2],
    /// Nodes at which the curve leads in another direction than was asked for, where no curve was found that
    /// keeps the shape with it, and the angle between the two.
    pub turned: Vec<(usize, f64)>,
}

/// A curve together with how it was found and what a check says of it.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The curve.
    pub curve: FairSpline,
    /// How it was found; see the status before trusting the curve.
    pub diagnostics: Diagnostics,
    /// The phases in order.
    pub history: Vec<Step>,
    /// The exact check of the curve.
    pub report: ShapeReport,
}
