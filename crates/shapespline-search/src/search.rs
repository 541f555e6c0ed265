//! The search: solve, check, raise; at the end solve and check everything anew.

use std::ops::{ControlFlow, Range};

use rayon::prelude::*;
use shapespline_criteria::{Checker, Faults, ShapeReport, StretchChecker, WindowChecker};
use shapespline_geometry::DataPolygon;

use crate::{
    Diagnostics, FitError, Outcome, Pattern, Phase, SearchOptions, Status, Step, Strategy,
    TensionFamily, relax::relax,
};

/// Touched neighbourhoods from which on they are checked on all threads.
const MANY: usize = 256;

/// Searches for tensions under which a family's curve keeps the shape of its data.
///
/// `monitor` sees every step and can end the search; the curve is then what it is at that moment, and
/// the status says so.
///
/// # Errors
/// Those of the family's solver.
pub fn search<F: TensionFamily>(
    family: &mut F,
    checker: &Checker<'_>,
    options: &SearchOptions,
    monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<Outcome, F::Error> {
    let faults = checker.all_faults(|i| family.end_legs(i));
    search_from(faults, family, checker, options, monitor)
}

/// [`search`] on the polygon of a family, and the report on the curve that results.
///
/// # Errors
/// Options outside their range; those of the family's solver.
pub fn search_and_report<F>(
    family: &mut F,
    polygon: &DataPolygon,
    options: &SearchOptions,
    monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<(Outcome, ShapeReport), FitError>
where
    F: TensionFamily,
    FitError: From<F::Error>,
{
    // Most curves need no tension: those are looked at once, and nothing is kept of it.
    options.validate()?;
    let first = StretchChecker::new(polygon, options.criteria, options.tolerances);
    let (faults, applicable) = first.look(|i| family.end_legs(i));
    if faults.is_empty() {
        let report = ShapeReport::clean(polygon.segments(), options.criteria, applicable);
        return Ok((Outcome::solved(), report));
    }
    let checker = options.checker(polygon)?;
    let outcome = search_from(faults, family, &checker, options, monitor)?;
    let report = checker.report_of(&outcome.faults, |i| family.end_legs(i));
    Ok((outcome, report))
}

/// [`search`], the faults of the curve as it is being known.
fn search_from<F: TensionFamily>(
    faults: Vec<(usize, Faults)>,
    family: &mut F,
    checker: &Checker<'_>,
    options: &SearchOptions,
    monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<Outcome, F::Error> {
    let mut state = State::new(faults, family, checker, monitor);
    let mut status = state.raise(options)?;
    if status == Status::Solved && !state.untouched() {
        if options.strategy == Strategy::Fairest {
            relax(&mut state)?;
        }
        status = state.verify(options)?;
    }
    if status != Status::Solved && !state.untouched() {
        // Changes of a rounding or two were not looked at, and a verdict can hang on them.
        state.solve_and_check_anew()?;
        if state.faults.is_empty() {
            status = Status::Solved;
        }
    }
    Ok(state.outcome(status))
}

/// The family, the checker, and what is known to fail.
pub(crate) struct State<'s, 'p, F> {
    pub(crate) family: &'s mut F,
    checker: &'s Checker<'p>,
    /// The same, for a few segments at a time.
    windows: WindowChecker<'s, 'p>,
    monitor: &'s mut dyn FnMut(&Step) -> ControlFlow<()>,
    /// Segments that fail, ascending.
    faults: Vec<(usize, Faults)>,
    /// Ranges of segments that the last solve touched, ascending and disjoint.
    touched: Vec<Range<usize>>,
    /// What a trial that failed left unchecked.
    unchecked: Vec<Range<usize>>,
    /// The segment on which the last trial failed: the first to be looked at in the next one.
    suspect: usize,
    /// Whether the curve without any tension is known to have faults: mostly the search began with it.
    pub(crate) plain_fails: bool,
    history: Vec<Step>,
    iterations: usize,
    solves: usize,
    pub(crate) relaxations: usize,
    /// Whether the monitor asked to stop.
    pub(crate) stopped: bool,
}

impl<'s, 'p, F: TensionFamily> State<'s, 'p, F> {
    fn new(
        faults: Vec<(usize, Faults)>,
        family: &'s mut F,
        checker: &'s Checker<'p>,
        monitor: &'s mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Self {
        let plain_fails = !faults.is_empty() && family.tension().iter().all(|&t| t == 0.0);
        Self {
            family,
            checker,
            windows: checker.in_windows(),
            monitor,
            faults,
            touched: Vec::new(),
            unchecked: Vec::new(),
            suspect: 0,
            plain_fails,
            history: Vec::new(),
            iterations: 1,
            solves: 1,
            relaxations: 0,
            stopped: false,
        }
    }

    /// Whether the data are closed.
    pub(crate) fn closed(&self) -> bool {
        self.checker.polygon().is_closed()
    }

    fn untouched(&self) -> bool {
        self.history.is_empty()
    }

    /// Raises tension until nothing fails.
    fn raise(&mut self, options: &SearchOptions) -> Result<Status, F::Error> {
        while !self.faults.is_empty() {
            if self.stopped {
                return Ok(Status::Interrupted);
            }
            if self.iterations >= options.limit() {
                return Ok(Status::IterationLimit);
            }
            let changes = self.raised(options);
            let violated = self.faults.len();
            self.set_tension(&changes)?;
            self.iterations += 1;
            self.log(Phase::Raise, violated, changes.len());
        }
        Ok(Status::Solved)
    }

    /// Solves and checks everything anew; raises again in the (unseen) case that something fails.
    fn verify(&mut self, options: &SearchOptions) -> Result<Status, F::Error> {
        loop {
            self.solve_and_check_anew()?;
            self.log(Phase::Verify, self.faults.len(), 0);
            if self.faults.is_empty() {
                return Ok(Status::Solved);
            }
            match self.raise(options)? {
                Status::Solved => {}
                status => return Ok(status),
            }
        }
    }

    fn solve_and_check_anew(&mut self) -> Result<(), F::Error> {
        self.family.solve_again()?;
        self.solves += 1;
        let family = &*self.family;
        self.faults = self.windows.all_faults(|i| family.end_legs(i));
        Ok(())
    }

    /// The changes of tension that the faults call for: (5.58)–(5.65), with the index m + k (E4).
    fn raised(&self, options: &SearchOptions) -> Vec<(usize, f64)> {
        let tension = self.family.tension();
        let n = tension.len();
        let node = |at: usize, offset: usize| -> Option<usize> {
            // Offsets count from −1.
            if self.closed() {
                Some((at + n + offset - 1) % n)
            } else {
                (at + offset).checked_sub(1).filter(|&i| i < n)
            }
        };
        let mut changes = Vec::with_capacity(4 * self.faults.len());
        let mut equal = Vec::new();
        for &(segment, faults) in &self.faults {
            let pattern = Pattern::of(faults);
            for (offset, _) in pattern.raise.iter().enumerate().filter(|(_, raise)| **raise) {
                if let Some(i) = node(segment, offset) {
                    changes.push((i, options.raised(tension[i])));
                }
            }
            if pattern.equal {
                equal.push(segment);
            }
        }
        changes.sort_unstable_by_key(|c| c.0);
        changes.dedup_by_key(|c| c.0);
        // (5.65): over a run of non-convex coplanar segments the pull is one and the same.
        for run in consecutive(&equal, self.closed().then_some(n)) {
            let nodes = || run.iter().flat_map(|&m| [m % n, (m + 1) % n]);
            let pull = |i: usize| tension[i] / self.family.weight(i);
            let level = options.raised(nodes().map(pull).fold(0.0, f64::max));
            for i in nodes() {
                if let Ok(at) = changes.binary_search_by_key(&i, |c| c.0) {
                    changes[at].1 = level * self.family.weight(i);
                }
            }
        }
        changes
    }

    /// Sets tensions (ascending by node), solves where that matters, and checks what it touched.
    fn set_tension(&mut self, changes: &[(usize, f64)]) -> Result<(), F::Error> {
        self.solve(changes)?;
        let touched = &self.touched;
        self.faults.retain(|(i, _)| {
            let after = touched.partition_point(|r| r.start <= *i);
            after == 0 || *i >= touched[after - 1].end
        });
        let untouched = self.faults.len();
        let (family, checker) = (&*self.family, self.checker);
        let legs = |i| family.end_legs(i);
        if touched.len() < MANY {
            for range in touched {
                self.windows.faults(range.clone(), legs, &mut self.faults);
            }
        } else {
            let check = |windows: &mut WindowChecker<'_, '_>, range: &Range<usize>| {
                let mut found = Vec::new();
                windows.faults(range.clone(), legs, &mut found);
                found
            };
            let ranges = touched.par_iter().with_min_len(MANY / 4);
            let found: Vec<_> =
                ranges.map_init(|| checker.in_windows(), check).flatten_iter().collect();
            self.faults.extend(found);
        }
        if untouched > 0 {
            self.faults.sort_unstable_by_key(|f| f.0);
        }
        Ok(())
    }

    /// Sets tensions of a curve without faults; whether it still has none. Ends at the first fault, and
    /// leaves it to the next solve to look at the rest.
    pub(crate) fn try_tension(&mut self, changes: &[(usize, f64)]) -> Result<bool, F::Error> {
        self.solve(changes)?;
        let (family, windows) = (&*self.family, &mut self.windows);
        let legs = |i| family.end_legs(i);
        let known = self.suspect;
        let suspect = self.touched.iter().any(|r| r.contains(&known)).then_some(known..known + 1);
        let fault = suspect
            .into_iter()
            .chain(self.touched.iter().cloned())
            .find_map(|range| windows.any_fault(range, legs));
        if let Some(segment) = fault {
            self.suspect = segment;
            std::mem::swap(&mut self.unchecked, &mut self.touched);
        }
        Ok(fault.is_none())
    }

    /// Sets tensions under which the curve is known to have no faults: solved, not checked again.
    pub(crate) fn return_to(&mut self, changes: &[(usize, f64)]) -> Result<(), F::Error> {
        self.solve(changes)?;
        self.touched.clear();
        Ok(())
    }

    /// Sets tensions and finds what has to be checked.
    fn solve(&mut self, changes: &[(usize, f64)]) -> Result<(), F::Error> {
        self.touched.clear();
        self.touched.append(&mut self.unchecked);
        self.family.set_tension(changes, &mut self.touched)?;
        self.solves += 1;
        merge(&mut self.touched);
        Ok(())
    }

    /// Adds a step to the history and shows it to the monitor.
    pub(crate) fn log(&mut self, phase: Phase, violated: usize, changed: usize) {
        let step = Step { phase, violated, changed };
        self.stopped |= (self.monitor)(&step).is_break();
        self.history.push(step);
    }

    /// Shows the monitor a step that is still under way; whether it asks to stop.
    pub(crate) fn wants_to_stop(&mut self, phase: Phase, changed: usize) -> bool {
        self.stopped |= (self.monitor)(&Step { phase, violated: 0, changed }).is_break();
        self.stopped
    }

    fn outcome(self, status: Status) -> Outcome {
        let diagnostics = Diagnostics {
            status,
            iterations: self.iterations,
            solves: self.solves,
            relaxations: self.relaxations,
            nodes_changed: self.family.tension().iter().filter(|&&t| t > 0.0).count(),
        };
        Outcome { diagnostics, history: self.history, faults: self.faults }
    }
}

/// Maximal runs of consecutive numbers in an ascending list; in a cycle of length `n` the last run
/// joins the first where they meet (paper 001, (5.63)–(5.64), modulo N by E5).
fn consecutive(list: &[usize], cycle: Option<usize>) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    for &m in list {
        match runs.last_mut() {
            Some(run) if run.last() == Some(&(m.wrapping_sub(1))) => run.push(m),
            _ => runs.push(vec![m]),
        }
    }
    if let Some(n) = cycle
        && runs.len() > 1
        && runs[0][0] == 0
        && list.last() == Some(&(n - 1))
    {
        let head = runs.remove(0);
        if let Some(tail) = runs.last_mut() {
            tail.extend(head);
        }
    }
    runs
}

/// Sorts ranges and joins those that meet.
fn merge(ranges: &mut Vec<Range<usize>>) {
    ranges.sort_unstable_by_key(|r| r.start);
    ranges.dedup_by(|next, kept| {
        let meets = next.start <= kept.end;
        if meets {
            kept.end = kept.end.max(next.end);
        }
        meets
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_join_over_the_seam_of_closed_data_only() {
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], None), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(10)), [vec![4, 5], vec![9, 0, 1]]);
        // Another segment comes after the last one here.
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(11)), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 2], Some(3)), [vec![0, 1, 2]]);
    }
}
