// SPDX-License-Identifier: MIT OR Apache-2.0

//! Why a system cannot be solved.

/// A system that cannot be solved; the row is named.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A pivot that is zero, infinite or NaN.
    #[error("pivot of row {row} is {pivot}: the system cannot be solved without pivoting")]
    Pivot {
        /// Row of the pivot.
        row: usize,
        /// Its value.
        pivot: f64,
    },
    /// Arrays whose lengths do not belong together.
    #[error("{argument} has length {found}, the diagonal has {expected}")]
    Length {
        /// Name of the array.
        argument: &'static str,
        /// Length of the diagonal.
        expected: usize,
        /// Length of the array.
        found: usize,
    },
}

/// The pivot, if one can divide by it.
#[inline]
pub(crate) fn checked_pivot(row: usize, pivot: f64) -> Result<f64, SolveError> {
    let size = pivot.abs();
    if size > 0.0 && size < f64::INFINITY {
        Ok(pivot)
    } else {
        Err(SolveError::Pivot { row, pivot })
    }
}

pub(crate) fn check_length(
    argument: &'static str,
    expected: usize,
    found: usize,
) -> Result<(), SolveError> {
    if found == expected { Ok(()) } else { Err(SolveError::Length { argument, expected, found }) }
}
