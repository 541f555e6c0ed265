// SPDX-License-Identifier: MIT OR Apache-2.0

//! A system that is solved again only where its rows changed.
//!
//! In a strictly diagonally dominant system a change dies away geometrically: by at least `2^{−k}`
//! over `k` rows where the off-diagonal entries sum to at most half the diagonal, as in cubic spline
//! interpolation. In floating point it dies away altogether: elimination restarted at a changed row
//! meets, some tens of rows later, exactly the numbers it had stored, and from there on nothing can
//! differ. So the elimination is redone from each changed row until it meets the old one, and the
//! back substitution likewise.
//!
//! For an open system the result is that of a full solve, **bit for bit**, at a cost that follows
//! the number of changes. A cyclic system is run through round and round until the numbers repeat,
//! which is the same idea without an end.

use std::ops::Range;

use glam::DVec3;

use crate::{
    Rows, SolveError,
    elimination::{Eliminated, eliminate, eliminate_all, substitute, substitute_all},
};

/// Relative change from which an unknown counts as touched.
const SIGNIFICANT: f64 = 1e-13;

/// Solution of a tridiagonal or cyclic system, with what is needed to bring it up to date.
#[derive(Debug, Clone, Default)]
pub struct UpdatableSolver {
    /// Elimination: `x[i] = reduced[i] − ratio[i] x[i+1]`.
    ratio: Vec<f64>,
    reduced: Vec<DVec3>,
    solution: Vec<DVec3>,
    /// Rows whose elimination changed in the update under way.
    changed: Vec<Range<usize>>,
}

impl UpdatableSolver {
    /// Solves the whole system. O(n).
    ///
    /// # Errors
    /// A pivot that is zero or not finite.
    pub fn new<R: Rows + Sync>(rows: &R) -> Result<Self, SolveError> {
        let mut new = Self::default();
        new.solve(rows)?;
        Ok(new)
    }

    /// Solves a whole system, this one again or another, in the same memory. O(n).
    ///
    /// # Errors
    /// A pivot that is zero or not finite.
    pub fn solve<R: Rows + Sync>(&mut self, rows: &R) -> Result<(), SolveError> {
        let n = rows.count();
        self.ratio.resize(n, 0.0);
        self.reduced.resize(n, DVec3::ZERO);
        self.solution.resize(n, DVec3::ZERO);
        if rows.is_cyclic() {
            return self.solve_cyclic(rows);
        }
        eliminate_all(rows, &mut self.ratio, &mut self.reduced)?;
        self.solution.copy_from_slice(&self.reduced);
        if !substitute_all(&self.ratio, &mut self.solution) {
            self.solution.copy_from_slice(&self.reduced);
            substitute(&self.ratio, &mut self.solution, DVec3::ZERO);
        }
        Ok(())
    }

    /// The unknowns.
    #[must_use]
    pub fn solution(&self) -> &[DVec3] {
        &self.solution
    }

    /// Takes the unknowns, dropping the rest.
    #[must_use]
    pub fn into_solution(self) -> Vec<DVec3> {
        self.solution
    }

    /// Goes round and round until the numbers repeat.
    fn solve_cyclic<R: Rows>(&mut self, rows: &R) -> Result<(), SolveError> {
        let n = self.solution.len();
        let limit = Self::limit(rows);
        let mut before = (0.0, DVec3::ZERO);
        for step in 0..limit {
            let i = step % n;
            let now = eliminate(i, rows.row(i), before)?;
            if step >= n && self.holds(i, now) {
                break;
            }
            (self.ratio[i], self.reduced[i]) = now;
            before = now;
        }
        let mut after = DVec3::ZERO;
        for step in 0..limit {
            let i = n - 1 - step % n;
            let now = self.reduced[i] - after * self.ratio[i];
            if step >= n && self.solution[i] == now {
                break;
            }
            self.solution[i] = now;
            after = now;
        }
        Ok(())
    }

    /// Brings the solution up to date after the rows `changed` (ascending) have changed, and appends
    /// to `touched` ranges of unknowns (ascending, inside `0..n`, they may meet) that hold every one
    /// that changed by more than `1e−13` of its size.
    ///
    /// Cost: some tens of rows for each changed one, never more than a few full solves.
    ///
    /// # Errors
    /// A pivot that is zero or not finite.
    pub fn update<R: Rows + Sync>(
        &mut self,
        rows: &R,
        changed: &[usize],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        let n = self.solution.len();
        if rows.is_cyclic() && changed.len() * 8 > n {
            self.solve(rows)?;
            touched.push(0..n);
            return Ok(());
        }
        let mut ranges = std::mem::take(&mut self.changed);
        ranges.clear();
        let eliminated = self.eliminate_again(rows, changed, &mut ranges);
        if eliminated.is_ok() {
            self.substitute_again(rows, &ranges, touched);
        }
        self.changed = ranges;
        eliminated
    }

    /// Forward: from each changed row until the stored elimination is met.
    fn eliminate_again<R: Rows>(
        &mut self,
        rows: &R,
        changed: &[usize],
        ranges: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        let n = self.solution.len();
        let limit = Self::limit(rows);
        let mut pending = changed.iter().copied().peekable();
        while let Some(first) = pending.next() {
            // `at` counts on beyond n when a cyclic elimination runs through the first row again; `i` is
            // its row.
            let (mut at, mut i) = (first, first);
            let mut before = match (first, rows.is_cyclic()) {
                (0, false) => (0.0, DVec3::ZERO),
                (0, true) => (self.ratio[n - 1], self.reduced[n - 1]),
                _ => (self.ratio[first - 1], self.reduced[first - 1]),
            };
            while at < n || (rows.is_cyclic() && at - first < limit) {
                while pending.next_if(|&next| next <= at).is_some() {}
                let now = eliminate(i, rows.row(i), before)?;
                // A changed row can leave the elimination as it was; the first one always counts.
                if at > first && self.holds(i, now) && changed.binary_search(&i).is_err() {
                    break;
                }
                (self.ratio[i], self.reduced[i]) = now;
                before = now;
                at += 1;
                i = if i + 1 < n { i + 1 } else { 0 };
            }
            ranges.push(first..at);
        }
        Ok(())
    }

    /// Backward: through each changed range and on until the stored solution is met.
    fn substitute_again<R: Rows>(
        &mut self,
        rows: &R,
        ranges: &[Range<usize>],
        touched: &mut Vec<Range<usize>>,
    ) {
        let n = self.solution.len();
        let limit = Self::limit(rows);
        let first_touched = touched.len();
        // Everything at or above this row is done.
        let mut done = usize::MAX;
        for range in ranges.iter().rev() {
            if range.start >= done {
                continue;
            }
            let top = range.end.min(done);
            let mut after =
                if top < n || rows.is_cyclic() { self.solution[top % n] } else { DVec3::ZERO };
            // Counted from n·k upwards, so that a cyclic substitution can run below row 0.
            let lift = if rows.is_cyclic() { n * (limit / n + 2) } else { 0 };
            let (top, start) = (top + lift, range.start + lift);
            let (mut at, mut next) = (top, top % n);
            // The significant part of what changes: a change fades away over more rows than matter.
            let (mut lowest, mut highest) = (top, top);
            while at > 0 && top - at < limit + (top - start) {
                let i = if next > 0 { next - 1 } else { n - 1 };
                let now = self.reduced[i] - after * self.ratio[i];
                let was = self.solution[i];
                if at - 1 < start && was == now && !is_in(ranges, i) {
                    break;
                }
                if (now - was).abs().max_element() > SIGNIFICANT * now.abs().max_element() {
                    if lowest == top {
                        highest = at;
                    }
                    lowest = at - 1;
                }
                self.solution[i] = now;
                after = now;
                at -= 1;
                next = i;
            }
            record(lowest..highest, n, touched);
            done = at.saturating_sub(lift);
        }
        touched[first_touched..].sort_unstable_by_key(|r| r.start);
    }

    /// What row `i` hands on to the next.
    pub(crate) fn eliminated(&self, i: usize) -> Eliminated {
        (self.ratio[i], self.reduced[i])
    }

    #[inline]
    fn holds(&self, i: usize, (ratio, reduced): (f64, DVec3)) -> bool {
        self.ratio[i] == ratio && self.reduced[i] == reduced
    }

    /// Steps after which a cyclic run ends in any case: the influence of the start is then below
    /// 2^{−200}, and what still differs is the last bit going round.
    fn limit<R: Rows>(rows: &R) -> usize {
        if rows.is_cyclic() { rows.count() + 200 } else { rows.count() }
    }
}

/// Solves a system that will not change: the same numbers as [`UpdatableSolver::new`], with half
/// its memory.
///
/// # Errors
/// A pivot that is zero or not finite.
pub fn solve_once<R: Rows + Sync>(rows: &R) -> Result<Vec<DVec3>, SolveError> {
    if rows.is_cyclic() {
        return UpdatableSolver::new(rows).map(UpdatableSolver::into_solution);
    }
    let n = rows.count();
    let (mut ratio, mut solution) = (vec![0.0; n], vec![DVec3::ZERO; n]);
    eliminate_all(rows, &mut ratio, &mut solution)?;
    if !substitute_all(&ratio, &mut solution) {
        eliminate_all(rows, &mut ratio, &mut solution)?;
        substitute(&ratio, &mut solution, DVec3::ZERO);
    }
    Ok(solution)
}

/// Whether row `i` lies in one of the ranges (ascending, disjoint, possibly running past `n`).
fn is_in(ranges: &[Range<usize>], i: usize) -> bool {
    let k = ranges.partition_point(|r| r.start <= i);
    k > 0 && i < ranges[k - 1].end
}

/// Appends a range that may run across a multiple of `n` as ranges inside `0..n`.
fn record(range: Range<usize>, n: usize, touched: &mut Vec<Range<usize>>) {
    if range.len() >= n {
        touched.push(0..n);
        return;
    }
    let (start, end) = (range.start % n, range.end % n);
    if range.is_empty() {
    } else if start < end || end == 0 {
        touched.push(start..if end == 0 { n } else { end });
    } else {
        touched.push(start..n);
        touched.push(0..end);
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{Row, solve_cyclic, solve_tridiagonal};
    use proptest::prelude::*;

    pub(crate) struct Array {
        pub(crate) rows: Vec<Row>,
        pub(crate) cyclic: bool,
    }
    impl Rows for Array {
        fn count(&self) -> usize {
            self.rows.len()
        }
        fn is_cyclic(&self) -> bool {
            self.cyclic
        }
        fn row(&self, i: usize) -> Row {
            let mut row = self.rows[i];
            if !self.cyclic && i == 0 {
                row.lower = 0.0;
            }
            if !self.cyclic && i + 1 == self.rows.len() {
                row.upper = 0.0;
            }
            row
        }
    }

    fn direct(rows: &Array) -> Vec<DVec3> {
        let all: Vec<Row> = (0..rows.count()).map(|i| rows.row(i)).collect();
        let lower: Vec<f64> = all.iter().map(|r| r.lower).collect();
        let upper: Vec<f64> = all.iter().map(|r| r.upper).collect();
        let mut diagonal: Vec<f64> = all.iter().map(|r| r.diagonal).collect();
        let mut right: Vec<DVec3> = all.iter().map(|r| r.right).collect();
        let solve = if rows.cyclic { solve_cyclic } else { solve_tridiagonal };
        solve(&lower, &mut diagonal, &upper, &mut right).unwrap();
        right
    }

    fn rows(length: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Row>> {
        let row = (0.0..1.0f64, 0.0..50.0f64, proptest::array::uniform3(-9.0..9.0f64)).prop_map(
            |(w, nu, right)| Row {
                lower: w,
                diagonal: 2.0 + if nu > 25.0 { nu } else { 0.0 },
                upper: 1.0 - w,
                right: DVec3::from(right),
            },
        );
        prop::collection::vec(row, length)
    }

    proptest! {
        #[test]
        fn updates_equal_full_solves(
            rows in rows(1..400), cyclic: bool,
            rounds in prop::collection::vec(prop::collection::btree_set((0..400usize, 0..4u8), 1..6), 1..5),
        ) {
            let mut system = Array { rows, cyclic };
            let n = system.count();
            let mut solver = UpdatableSolver::new(&system).unwrap();
            for round in rounds {
                let mut changed: Vec<usize> = round.iter().map(|(i, _)| i % n).collect();
                changed.sort_unstable();
                changed.dedup();
                for (i, kind) in round {
                    system.rows[i % n].diagonal = [2.0, 3.0, 17.5, 1e9][kind as usize];
                }
                let old = solver.solution().to_vec();
                let mut touched = Vec::new();
                solver.update(&system, &changed, &mut touched).unwrap();
                let fresh = UpdatableSolver::new(&system).unwrap();
                prop_assert_eq!(&solve_once(&system).unwrap(), fresh.solution());
                if !cyclic {
                    prop_assert_eq!(solver.solution(), fresh.solution());
                }
                let scale = 9.0;
                for (found, expected) in solver.solution().iter().zip(direct(&system)) {
                    prop_assert!((*found - expected).length() < 1e-13 * scale);
                }
                for (i, (old, new)) in old.iter().zip(solver.solution()).enumerate() {
                    let marked = touched.iter().any(|r| r.contains(&i));
                    let close = (*old - *new).length() <= 2e-13 * new.length();
                    prop_assert!(marked || close, "{} unmarked", i);
                }
            }
        }
    }

    #[test]
    fn an_update_touches_a_neighbourhood_only() {
        let rows = (0..100_000)
            .map(|i| Row {
                lower: 0.5,
                diagonal: 2.0,
                upper: 0.5,
                right: DVec3::new((i as f64).sin(), (i as f64 * 0.7).cos(), 1.0),
            })
            .collect();
        let mut system = Array { rows, cyclic: false };
        let mut solver = UpdatableSolver::new(&system).unwrap();
        system.rows[50_000].diagonal = 4.0;
        let mut touched = Vec::new();
        solver.update(&system, &[50_000], &mut touched).unwrap();
        assert_eq!(touched.len(), 1);
        assert!(touched[0].len() < 120, "{touched:?}");
        assert_eq!(solver.solution(), UpdatableSolver::new(&system).unwrap().solution());
    }

    #[test]
    fn a_bad_pivot_names_its_row() {
        let row = Row { lower: 0.5, diagonal: 2.0, upper: 0.5, right: DVec3::X };
        let mut system = Array { rows: vec![row; 9], cyclic: false };
        let mut solver = UpdatableSolver::new(&system).unwrap();
        system.rows[4].diagonal = f64::NAN;
        let found = solver.update(&system, &[4], &mut Vec::new()).unwrap_err();
        assert!(matches!(found, SolveError::Pivot { row: 4, .. }));
        assert!(matches!(UpdatableSolver::new(&system), Err(SolveError::Pivot { row: 4, .. })));
    }

    /// Found by mutation: nobody solved a cyclic system again whose rows had changed since.
    #[test]
    fn solving_again_takes_in_whatever_changed() {
        for cyclic in [false, true] {
            let row = |i: usize| Row {
                lower: 0.5,
                diagonal: 2.0,
                upper: 0.5,
                right: DVec3::new((i as f64).sin(), (i as f64 * 0.7).cos(), 1.0),
            };
            let mut rows: Vec<Row> = (0..50).map(row).collect();
            if !cyclic {
                (rows[0].lower, rows[49].upper) = (0.0, 0.0);
            }
            let mut system = Array { rows, cyclic };
            let mut solver = UpdatableSolver::new(&system).unwrap();
            // Far from where the elimination begins.
            system.rows[30].right *= 3.0;
            system.rows[31].diagonal = 5.0;
            solver.solve(&system).unwrap();
            let fresh = UpdatableSolver::new(&system).unwrap();
            for (found, expected) in solver.solution().iter().zip(fresh.solution()) {
                assert!((*found - *expected).length() < 1e-14, "{cyclic}: {found} {expected}");
            }
        }
    }
}
