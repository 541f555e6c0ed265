// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long fits that can be ended from outside.

use crate::MonotoneError;
use std::ops::ControlFlow;

/// A question whether to go on, asked from any thread.
pub(crate) type GoOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Asks whether to go on.
///
/// # Errors
/// [`MonotoneError::Interrupted`] where the answer is no.
pub(crate) fn ask(go_on: GoOn<'_>) -> Result<(), MonotoneError> {
    if go_on().is_break() { Err(MonotoneError::Interrupted) } else { Ok(()) }
}
