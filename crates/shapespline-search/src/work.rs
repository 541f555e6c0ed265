// SPDX-License-Identifier: MIT OR Apache-2.0

//! Solving a system while its tension changes: the rows as they were made, and looks at other tension.

use std::{cell::Cell, convert::Infallible, ops::Range};

use shapespline_banded::{Place, Resolvable, Row, Rows, SolveError};
use shapespline_geometry::DVec3;

use crate::TensionSystem;

/// Rows that are kept: those of short curves, whose search comes back to them again and again.
pub(crate) const KEPT: usize = 2048;

/// A system whose first rows are kept as they were made.
struct Kept<'s, S> {
    system: &'s S,
    rows: &'s [Row],
}

impl<S: Rows> Rows for Kept<'_, S> {
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
        let kept = rows.start.min(self.rows.len())..rows.end.min(self.rows.len());
        kept.clone().zip(&self.rows[kept.clone()]).try_for_each(|(i, row)| take(i, *row))?;
        (kept.end.max(rows.start)..rows.end).try_for_each(|i| take(i, self.row(i)))
    }
}

/// Rows from which on looking at other tension costs what setting it does. Where a system has no more, a
/// change is felt by nearly all: all are solved.
pub(crate) const FEW: usize = 96;

/// What solving and looking take; all but the solution is scratch.
#[derive(Debug, Default)]
pub(crate) struct Work {
    solver: Resolvable,
    /// Made when tension first changes: most curves need none.
    kept: Vec<Row>,
    /// The tensions that were changed last, the rows that this changes, and the unknowns.
    indices: Vec<usize>,
    rows: Vec<usize>,
    unknowns: Vec<Range<usize>>,
    /// Where looks are taken, and whether the system is still the one that the place was made of.
    place: Place,
    place_is_valid: bool,
    /// Rows of the place that are those of the last look.
    looked: Vec<usize>,
    /// The tensions that a look sets aside, as they are.
    present: Vec<(usize, f64)>,
    /// Whether the solution is that of a solve of all rows, and not brought up to date.
    all_is_solved: bool,
}

thread_local! {
    /// For the next curve of this thread: short curves come in thousands, and memory for one costs a tenth
    /// of its search.
    static SPARE: Cell<Option<Box<Work>>> = const { Cell::new(None) };
}

impl Work {
    /// Solves a system as it is. O(N).
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub(crate) fn begin<S: TensionSystem>(system: &S) -> Result<Box<Self>, SolveError> {
        let mut work = SPARE.try_with(Cell::take).ok().flatten().unwrap_or_default();
        work.kept.clear();
        work.indices.clear();
        work.rows.clear();
        work.place_is_valid = false;
        work.all_is_solved = true;
        work.solver.solve(system)?;
        Ok(work)
    }

    /// Leaves the memory to the next curve of this thread.
    pub(crate) fn end(self: Box<Self>) {
        if self.solver.solution().len() <= KEPT {
            // A thread that ends keeps nothing.
            let _ = SPARE.try_with(|spare| spare.set(Some(self)));
        }
    }

    /// The tangents.
    #[inline]
    pub(crate) fn solution(&self) -> &[DVec3] {
        self.solver.solution()
    }

    /// Whether they are those of a solve of all rows, and not brought up to date.
    pub(crate) fn all_is_solved(&self) -> bool {
        self.all_is_solved
    }

    /// Solves all rows, made anew.
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub(crate) fn solve_again<S: TensionSystem>(&mut self, system: &S) -> Result<(), SolveError> {
        self.place_is_valid = false;
        self.all_is_solved = true;
        self.solver.solve_again(system)
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
        self.keep_rows(system);
        self.place_is_valid = false;
        self.change(system, changes);
        for &i in &self.rows {
            if let Some(row) = self.kept.get_mut(i) {
                system.renew(i, row);
            }
        }
        let kept = Kept { system: &*system, rows: &self.kept };
        self.all_is_solved = kept.count() <= FEW;
        if self.all_is_solved {
            self.solver.solve_again(&kept)?;
            return Ok(None);
        }
        self.unknowns.clear();
        self.solver.update(&kept, &self.rows, &mut self.unknowns)?;
        Ok(Some(&self.unknowns))
    }

    /// Fills `legs` with those of some segments under other tensions, nothing of which stays. False where
    /// that takes more than a few rows.
    pub(crate) fn legs_under<S: TensionSystem>(
        &mut self,
        system: &mut S,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> bool {
        legs.clear();
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else { return false };
        if last.0 - first.0 >= FEW * S::SIDES {
            return false;
        }
        self.keep_rows(system);
        let present = changes.iter().map(|&(index, _)| (index, system.tension()[index]));
        self.present.clear();
        self.present.extend(present);
        self.change(system, changes);
        // What cannot be solved is no answer: to set the tension will say why.
        let looked = self.look(system, changes, segments, legs).unwrap_or(false);
        self.restore(system);
        looked
    }

    fn keep_rows<S: TensionSystem>(&mut self, system: &S) {
        if self.kept.is_empty() {
            let few = 0..system.count().min(KEPT);
            let Ok(()) = system.try_each(few, |_, row| {
                self.kept.push(row);
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
        indices().for_each(|index| system.rows_of(index, &mut self.rows));
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

    /// The legs of some segments under the changes, which have been made in the system alone. False where
    /// that takes more than a few rows.
    fn look<S: TensionSystem>(
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
        if rows.len() > FEW || rows.end > system.count() {
            return Ok(false);
        }
        let place = self.place.rows();
        if !(self.place_is_valid && place.start <= rows.start && rows.end <= place.end) {
            self.restore(system);
            let kept = Kept { system: &*system, rows: &self.kept };
            self.place_is_valid = self.place.go(&self.solver, &kept, rows)?;
            self.looked.clear();
            self.change(system, changes);
        }
        if !self.place_is_valid {
            return Ok(false);
        }
        if self.looked != self.rows {
            let kept = Kept { system: &*system, rows: &self.kept };
            self.looked.iter().for_each(|&i| *self.place.row_mut(i) = kept.row(i));
            self.looked.clone_from(&self.rows);
        }
        self.rows.iter().for_each(|&i| system.renew(i, self.place.row_mut(i)));
        let skipped = segments.start - self.place.rows().start;
        let tangents = self.place.solve()?[skipped..].windows(2);
        legs.extend(segments.zip(tangents).map(|(i, ends)| system.legs(i, [ends[0], ends[1]])));
        Ok(true)
    }
}
