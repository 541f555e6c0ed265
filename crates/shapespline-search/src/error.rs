// SPDX-License-Identifier: MIT OR Apache-2.0

//! Why there is no curve.

use shapespline_banded::SolveError;
use shapespline_geometry::InputError;

/// Unusable input, or a system that f64 cannot hold.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Unusable input.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A system that cannot be solved (overflow: the system itself never is singular).
    #[error("the tangents cannot be computed: {0}")]
    Solve(#[from] SolveError),
}

/// For families that cannot fail: their tangents are in closed form.
impl From<std::convert::Infallible> for FitError {
    fn from(never: std::convert::Infallible) -> Self {
        match never {}
    }
}
