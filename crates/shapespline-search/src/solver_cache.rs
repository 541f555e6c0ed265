// SPDX-License-Identifier: MIT OR Apache-2.0

//! Solving a system while its tension changes: its rows are cached, and trials solve only a few of
//! them.

use std::{cell::Cell, convert::Infallible, ops::Range};

use shapespline_banded::{LocalSystem, Row, Rows, SolveError, UpdatableSolver};
use shapespline_geometry::DVec3;

use crate::TensionSystem;

/// Rows that are cached at most: enough for short curves, whose search reads them again and again.
pub(crate) const MAX_CACHED_ROWS: usize = 2048;

/// A system whose first rows are cached.
struct CachedRows<'s, S> {
    system: &'s S,
    rows: &'s [Row],
}

impl<S: Rows> Rows for CachedRows<'_, S> {
    fn count(&self) -> usize {
        self.system.count()
    }

    fn is_cyclic(&self) -> bool {
        self.system.is_cyclic()
    }

    #[inline]
    fn row(&self, i: usize) -> Row {
        match self.rows.get(i) {
            Some(row) => *row,
            None => self.system.row(i),
        }
    }

    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        mut take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let cached = rows.start.min(self.rows.len())..rows.end.min(self.rows.len());
        cached.clone().zip(&self.rows[cached.clone()]).try_for_each(|(i, row)| take(i, *row))?;
        (cached.end.max(rows.start)..rows.end).try_for_each(|i| take(i, self.row(i)))
    }
}

/// Above this many rows a trial solve costs as much as an update. Smaller systems are re-solved in
/// full: a change alters nearly all of their unknowns.
pub(crate) const MAX_TRIAL_ROWS: usize = 96;

/// The solver and the memory of solves and trials; all but the solution is scratch.
#[derive(Debug, Default)]
pub(crate) struct SolverCache {
    solver: UpdatableSolver,
    /// Made when tension first changes: most curves need none.
    cached: Vec<Row>,
    /// The tensions that were changed last, the rows that this changes, and the unknowns.
    indices: Vec<usize>,
    rows: Vec<usize>,
    unknowns: Vec<Range<usize>>,
    /// The rows that trials solve, and whether the system is still the one they were taken from.
    local: LocalSystem,
    local_is_valid: bool,
    /// Rows of the local system that hold the coefficients of the last trial.
    trial_rows: Vec<usize>,
    /// The current values of the tensions that a trial replaces.
    present: Vec<(usize, f64)>,
    /// Whether the solution comes from a full solve, not from an update.
    is_fully_solved: bool,
}

thread_local! {
    /// For the next curve of this thread: short curves come in thousands, and memory for one costs a tenth
    /// of its search.
    static SPARE: Cell<Option<Box<SolverCache>>> = const { Cell::new(None) };
}

impl SolverCache {
    /// Solves a system as it is. O(N).
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub(crate) fn begin<S: TensionSystem>(system: &S) -> Result<Box<Self>, SolveError> {
        let mut cache = SPARE.try_with(Cell::take).ok().flatten().unwrap_or_default();
        cache.cached.clear();
        cache.indices.clear();
        cache.rows.clear();
        cache.local_is_valid = false;
        cache.is_fully_solved = true;
        cache.solver.solve(system)?;
        Ok(cache)
    }

    /// Leaves the memory to the next curve of this thread.
    pub(crate) fn end(self: Box<Self>) {
        if self.solver.solution().len() <= MAX_CACHED_ROWS {
            // A thread that ends keeps nothing.
            let _ = SPARE.try_with(|spare| spare.set(Some(self)));
        }
    }

    /// The tangents.
    #[inline]
    pub(crate) fn solution(&self) -> &[DVec3] {
        self.solver.solution()
    }

    /// True if the tangents come from a full solve, not from an update.
    pub(crate) fn is_fully_solved(&self) -> bool {
        self.is_fully_solved
    }

    /// Solves the whole system.
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub(crate) fn solve<S: TensionSystem>(&mut self, system: &S) -> Result<(), SolveError> {
        self.local_is_valid = false;
        self.is_fully_solved = true;
        self.solver.solve(system)
    }

    /// Sets tensions and solves. The unknowns that change, or `None` where all are solved.
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub(crate) fn set<S: TensionSystem>(
        &mut self,
        system: &mut S,
        changes: &[(usize, f64)],
    ) -> Result<Option<&[Range<usize>]>, SolveError> {
        self.cache_rows(system);
        self.local_is_valid = false;
        self.change(system, changes);
        for &i in &self.rows {
            if let Some(row) = self.cached.get_mut(i) {
                system.refresh_row(i, row);
            }
        }
        let cached = CachedRows { system: &*system, rows: &self.cached };
        self.is_fully_solved = cached.count() <= MAX_TRIAL_ROWS;
        if self.is_fully_solved {
            self.solver.solve(&cached)?;
            return Ok(None);
        }
        self.unknowns.clear();
        self.solver.update(&cached, &self.rows, &mut self.unknowns)?;
        Ok(Some(&self.unknowns))
    }

    /// Fills `legs` with those that some segments would have under other tensions, and changes nothing
    /// else. False if that takes more than [`MAX_TRIAL_ROWS`].
    pub(crate) fn trial_legs<S: TensionSystem>(
        &mut self,
        system: &mut S,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> bool {
        legs.clear();
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else { return false };
        if last.0 - first.0 >= MAX_TRIAL_ROWS * S::SIDES {
            return false;
        }
        self.cache_rows(system);
        let present = changes.iter().map(|&(index, _)| (index, system.tension()[index]));
        self.present.clear();
        self.present.extend(present);
        self.change(system, changes);
        // What cannot be solved is no answer: to set the tension will say why.
        let solved = self.trial(system, changes, segments, legs).unwrap_or(false);
        self.restore(system);
        solved
    }

    fn cache_rows<S: TensionSystem>(&mut self, system: &S) {
        if self.cached.is_empty() {
            let few = 0..system.count().min(MAX_CACHED_ROWS);
            let Ok(()) = system.try_each(few, |_, row| {
                self.cached.push(row);
                Ok::<(), Infallible>(())
            });
        }
    }

    /// Sets tensions in the system, and finds the rows that change: mostly those of the last time.
    fn change<S: TensionSystem>(&mut self, system: &mut S, changes: &[(usize, f64)]) {
        changes.iter().for_each(|&(index, tension)| system.set_tension(index, tension));
        let indices = || changes.iter().map(|change| change.0);
        if self.indices.iter().copied().eq(indices()) {
            return;
        }
        self.indices.clear();
        self.indices.extend(indices());
        self.rows.clear();
        indices().for_each(|index| system.dependent_rows(index, &mut self.rows));
        if !self.rows.is_sorted_by(|a, b| a < b) {
            self.rows.sort_unstable();
            self.rows.dedup();
        }
    }

    /// Sets the tensions again that were there before.
    fn restore<S: TensionSystem>(&self, system: &mut S) {
        for &(index, tension) in &self.present {
            system.set_tension(index, tension);
        }
    }

    /// Computes the legs of some segments under the changes, which so far are set in the system only.
    /// False if that takes more than [`MAX_TRIAL_ROWS`].
    fn trial<S: TensionSystem>(
        &mut self,
        system: &mut S,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> Result<bool, SolveError> {
        let (Some(&first), Some(&last)) = (self.rows.first(), self.rows.last()) else {
            return Ok(false);
        };
        // The last segment of closed data ends where the first begins, in no few rows.
        let rows = first.min(segments.start)..(last + 1).max(segments.end + 1);
        if rows.len() > MAX_TRIAL_ROWS || rows.end > system.count() {
            return Ok(false);
        }
        let place = self.local.rows();
        if !(self.local_is_valid && place.start <= rows.start && rows.end <= place.end) {
            self.restore(system);
            let cached = CachedRows { system: &*system, rows: &self.cached };
            self.local_is_valid = self.local.reset(&self.solver, &cached, rows)?;
            self.trial_rows.clear();
            self.change(system, changes);
        }
        if !self.local_is_valid {
            return Ok(false);
        }
        if self.trial_rows != self.rows {
            let cached = CachedRows { system: &*system, rows: &self.cached };
            self.trial_rows.iter().for_each(|&i| *self.local.row_mut(i) = cached.row(i));
            self.trial_rows.clone_from(&self.rows);
        }
        self.rows.iter().for_each(|&i| system.refresh_row(i, self.local.row_mut(i)));
        let skipped = segments.start - self.local.rows().start;
        let tangents = self.local.solve()?[skipped..].windows(2);
        legs.extend(segments.zip(tangents).map(|(i, ends)| system.legs(i, [ends[0], ends[1]])));
        Ok(true)
    }
}
