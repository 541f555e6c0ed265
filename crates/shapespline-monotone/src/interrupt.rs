// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long fits that can be ended from outside.

use crate::MonotoneError;
use std::ops::ControlFlow;

/// Called regularly, from any thread; returns `Break` to cancel.
pub(crate) type GoOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Calls `go_on`.
///
/// # Errors
/// [`MonotoneError::Interrupted`] if it breaks.
pub(crate) fn check_interrupt(go_on: GoOn<'_>) -> Result<(), MonotoneError> {
    if go_on().is_break() { Err(MonotoneError::Interrupted) } else { Ok(()) }
}
