// SPDX-License-Identifier: MIT OR Apache-2.0

//! A few rows of a solved system, solved again and again while the rest stays.

use std::ops::Range;

use glam::DVec3;

use crate::{
    Row, Rows, SolveError, UpdatableSolver,
    elimination::{EARLY, Eliminated, eliminate, substitute},
};

/// Some neighbouring rows of a [`UpdatableSolver`] system, to be solved with other coefficients while
/// nothing else changes.
///
/// The rows before them are eliminated as they are stored, those after them from the other end as far
/// as they are felt: a solve then costs these rows and no others, where [`UpdatableSolver::update`]
/// goes on until its changes have died away. Solutions are those of a full solve up to rounding.
#[derive(Debug, Clone, Default)]
pub struct LocalSystem {
    rows: Vec<Row>,
    first: usize,
    /// What the rows before hand on to the first, and those after to the last.
    around: [Eliminated; 2],
    ratio: Vec<f64>,
    solution: Vec<DVec3>,
}

impl LocalSystem {
    /// Takes some neighbouring rows of a system. O(rows), and up to 128 rows after them.
    ///
    /// False in a cyclic system where the rows would be felt all the way round.
    ///
    /// # Errors
    /// A pivot that is zero or not finite.
    pub fn reset<R: Rows>(
        &mut self,
        solver: &UpdatableSolver,
        system: &R,
        rows: Range<usize>,
    ) -> Result<bool, SolveError> {
        let (n, cyclic) = (system.count(), system.is_cyclic());
        if cyclic && rows.len() + EARLY > n {
            return Ok(false);
        }
        let nothing = (0.0, DVec3::ZERO);
        let before = match rows.start {
            0 if cyclic => solver.eliminated(n - 1),
            0 => nothing,
            first => solver.eliminated(first - 1),
        };
        let end = if cyclic { rows.end + EARLY } else { n.min(rows.end + EARLY) };
        let backward = |after, i: usize| {
            let row = system.row(if i < n { i } else { i - n });
            eliminate(i, Row { lower: row.upper, upper: row.lower, ..row }, after)
        };
        let after = (rows.end..end).rev().try_fold(nothing, backward)?;
        self.around = [before, after];
        self.first = rows.start;
        self.rows.clear();
        self.rows.extend(rows.map(|i| system.row(i)));
        self.ratio.resize(self.rows.len(), 0.0);
        self.solution.resize(self.rows.len(), DVec3::ZERO);
        Ok(true)
    }

    /// The rows of this local system, empty before the first [`LocalSystem::reset`].
    #[must_use]
    pub fn rows(&self) -> Range<usize> {
        self.first..self.first + self.rows.len()
    }

    /// A row of this local system, to be made another one. It stays that until the next
    /// [`LocalSystem::reset`].
    pub fn row_mut(&mut self, i: usize) -> &mut Row {
        &mut self.rows[i - self.first]
    }

    /// The unknowns of these rows as they are now.
    ///
    /// # Errors
    /// A pivot that is zero or not finite.
    pub fn solve(&mut self) -> Result<&[DVec3], SolveError> {
        let [mut before, (after, reduced)] = self.around;
        let Some((&last, others)) = self.rows.split_last() else { return Ok(&[]) };
        // What is left over is the last one's.
        let mut unknowns = self.ratio.iter_mut().zip(&mut self.solution);
        for ((i, row), (ratio, x)) in (self.first..).zip(others).zip(&mut unknowns) {
            before = eliminate(i, *row, before)?;
            (*ratio, *x) = before;
        }
        let diagonal = last.diagonal - last.upper * after;
        let right = last.right - reduced * last.upper;
        let row = Row { diagonal, right, ..last };
        for (ratio, x) in unknowns {
            (*ratio, *x) = eliminate(self.first + others.len(), row, before)?;
        }
        // Nothing is left of what comes after the last row.
        substitute(&self.ratio, &mut self.solution, DVec3::ZERO);
        Ok(&self.solution)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::updatable::tests::Array;

    fn system(n: usize, cyclic: bool) -> Array {
        let row = |i: usize| {
            let x = i as f64;
            let lower = 0.5 + 0.4 * (1.3 * x).sin();
            let right = DVec3::new(x.sin(), 1.0, (0.7 * x).cos());
            Row { lower, diagonal: 2.0 + (x * 0.9).sin().abs(), upper: 1.0 - lower, right }
        };
        let mut rows: Vec<Row> = (0..n).map(row).collect();
        if !cyclic {
            (rows[0].lower, rows[n - 1].upper) = (0.0, 0.0);
        }
        Array { rows, cyclic }
    }

    /// At both ends, inside, whole systems, and again after the rows of the local system have
    /// become others.
    #[test]
    fn a_local_system_is_solved_as_the_whole_system_is() {
        for (n, cyclic, first, count) in [
            (40, false, 0, 5),
            (40, false, 33, 7),
            (40, false, 12, 1),
            (40, false, 0, 40),
            (1, false, 0, 1),
            (900, false, 400, 30),
            (900, true, 0, 20),
            (900, true, 450, 9),
            (900, true, 880, 20),
        ] {
            let mut system = system(n, cyclic);
            let solver = UpdatableSolver::new(&system).unwrap();
            let mut local = LocalSystem::default();
            let rows = first..first + count;
            assert!(local.reset(&solver, &system, rows.clone()).unwrap());
            assert_eq!(local.rows(), rows);
            for factor in [1.0, 7.0, 1e6] {
                for i in rows.clone().step_by(2) {
                    system.rows[i].diagonal *= factor;
                    *local.row_mut(i) = system.rows[i];
                }
                let whole = UpdatableSolver::new(&system).unwrap();
                let found = local.solve().unwrap();
                assert_eq!(found.len(), count);
                for (found, expected) in found.iter().zip(&whole.solution()[rows.clone()]) {
                    let error = (*found - *expected).length();
                    assert!(error < 1e-14, "{n} {cyclic} {first}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn a_local_system_that_is_felt_all_the_way_round_is_refused() {
        let system = system(140, true);
        let solver = UpdatableSolver::new(&system).unwrap();
        let mut local = LocalSystem::default();
        assert!(local.reset(&solver, &system, 20..32).unwrap());
        assert!(!local.reset(&solver, &system, 20..33).unwrap());
    }

    #[test]
    fn a_bad_pivot_names_its_row() {
        for (row, bad) in [(22, 22), (30, 30)] {
            let mut system = system(60, false);
            let solver = UpdatableSolver::new(&system).unwrap();
            let mut local = LocalSystem::default();
            assert!(local.reset(&solver, &system, 20..25).unwrap());
            system.rows[row].diagonal = f64::NAN;
            let found = if row < 25 {
                *local.row_mut(row) = system.rows[row];
                local.solve().map(|_| true)
            } else {
                local.reset(&solver, &system, 20..25)
            };
            assert!(matches!(found, Err(SolveError::Pivot { row, .. }) if row == bad));
        }
    }
}
