// SPDX-License-Identifier: MIT OR Apache-2.0

//! The system that is solved: its rows, made when asked for.

use std::ops::Range;

use glam::DVec3;

/// A row `lower x[i−1] + diagonal x[i] + upper x[i+1] = right`, indices modulo `n` when cyclic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Coefficient of the unknown before.
    pub lower: f64,
    /// Coefficient of the row's own unknown.
    pub diagonal: f64,
    /// Coefficient of the unknown after.
    pub upper: f64,
    /// Right-hand side.
    pub right: DVec3,
}

/// The rows of a strictly diagonally dominant system, made when asked for.
pub trait Rows {
    /// Number of rows, at least one.
    fn count(&self) -> usize;
    /// Whether the first and the last unknown are neighbours.
    fn is_cyclic(&self) -> bool;
    /// Row `i`. In an open system `lower` of the first row and `upper` of the last must be zero.
    fn row(&self, i: usize) -> Row;

    /// Hands rows over one after the other, until one is refused. For systems that make a row at less cost
    /// when they know which comes next.
    ///
    /// # Errors
    /// That of the row that was refused.
    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        mut take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        rows.into_iter().try_for_each(|i| take(i, self.row(i)))
    }
}
