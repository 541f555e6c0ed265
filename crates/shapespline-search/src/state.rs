// SPDX-License-Identifier: MIT OR Apache-2.0

//! The curve of a search as it is, and what is known of it.

use std::{
    borrow::Cow,
    ops::{ControlFlow, Range},
};

use shapespline_criteria::{Violations, batch::CachedChecker};
use shapespline_geometry::DVec3;
use shapespline_polynomial::parallel;

use crate::{Diagnostics, Outcome, Phase, Status, Step, TensionFamily, doubts::Doubts};

/// Touched neighbourhoods from which on they are checked on all threads.
const MANY: usize = 8192;

/// Segments checked on each side of a trial change; beyond them its effect is negligible.
pub(crate) const AROUND: usize = 2;

/// The family, the checker, and what is known to fail.
pub(crate) struct State<'s, F> {
    pub(crate) family: &'s mut F,
    pub(crate) windows: CachedChecker<'s>,
    monitor: &'s mut dyn FnMut(&Step) -> ControlFlow<()>,
    /// Segments that fail, ascending: those not proved to keep the shape, without accepted doubts.
    pub(crate) violations: Vec<(usize, Violations)>,
    pub(crate) doubts: Doubts,
    /// Ranges of segments that the last solve touched, ascending and disjoint.
    touched: Vec<Range<usize>>,
    /// What a trial that failed left unchecked.
    unchecked: Vec<Range<usize>>,
    /// Whether all was solved at once and nothing of it failed.
    verified: bool,
    /// The segment on which the last trial failed: the first to be looked at in the next one.
    pub(crate) suspect: usize,
    /// Tensions (ascending by node) that are raised but not yet set.
    pub(crate) pending: Vec<(usize, f64)>,
    /// Scratch: the nodes that are raised, their tensions before, and the legs of a trial.
    pub(crate) nodes: Vec<usize>,
    pub(crate) before: Vec<f64>,
    pub(crate) legs: Vec<[DVec3; 2]>,
    history: Vec<Step>,
    pub(crate) iterations: usize,
    solves: usize,
    pub(crate) relaxations: usize,
    /// Whether the monitor asked to stop.
    pub(crate) stopped: bool,
}

impl<'s, F: TensionFamily> State<'s, F> {
    pub(crate) fn new(
        violations: Vec<(usize, Violations)>,
        family: &'s mut F,
        windows: CachedChecker<'s>,
        monitor: &'s mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Self {
        Self {
            family,
            windows,
            monitor,
            violations,
            doubts: Doubts::default(),
            touched: Vec::with_capacity(16),
            unchecked: Vec::new(),
            verified: false,
            suspect: 0,
            pending: Vec::with_capacity(32),
            nodes: Vec::with_capacity(32),
            before: Vec::with_capacity(32),
            legs: Vec::with_capacity(64),
            history: Vec::with_capacity(16),
            iterations: 1,
            solves: 1,
            relaxations: 0,
            stopped: false,
        }
    }

    /// Whether the data are closed.
    pub(crate) fn closed(&self) -> bool {
        self.windows.polygon().is_closed()
    }

    /// Whether the curve as it is was solved as a whole, and no segment of it failed.
    pub(crate) fn is_verified(&self) -> bool {
        self.verified
    }

    pub(crate) fn untouched(&self) -> bool {
        self.history.is_empty()
    }

    pub(crate) fn solve_and_check_anew(&mut self) -> Result<(), F::Error> {
        self.family.solve()?;
        self.solves += 1;
        let family = &*self.family;
        self.violations = self.windows.all_unproved(|i| family.end_legs(i));
        self.doubts.sift(&mut self.windows, &mut self.violations, |i| family.end_legs(i));
        self.verified = self.violations.is_empty();
        Ok(())
    }

    /// Fills `legs` with the end legs that segments around some tensions would have under other values of
    /// those, where that can be seen without setting them. Returns the segments.
    pub(crate) fn trial(&mut self, changes: &[(usize, f64)], reach: usize) -> Option<Range<usize>> {
        let [first, last] = [changes.first()?.0, changes.last()?.0].map(|index| index / F::SIDES);
        let segments = self.windows.polygon().segments();
        let around = first.saturating_sub(reach)..segments.min(last + reach);
        if !self.family.trial_legs(changes, around.clone(), &mut self.legs) {
            return None;
        }
        self.solves += 1;
        Some(around)
    }

    /// Whether segments around some tensions fail under other values of those, where that can be seen
    /// without setting them.
    pub(crate) fn seems_to_break(
        &mut self,
        changes: &[(usize, f64)],
        reach: usize,
    ) -> Option<bool> {
        let around = self.trial(changes, reach)?;
        let (legs, start) = (&self.legs, around.start);
        let suspect = self.suspect;
        let (windows, doubts) = (&mut self.windows, &self.doubts);
        if around.contains(&suspect)
            && !windows.unproved_at(suspect, legs[suspect - start]).is_empty()
            && doubts.is_violation(windows, suspect, legs[suspect - start])
        {
            return Some(true);
        }
        let violation = first_violation(windows, doubts, around, |i| legs[i - start]);
        self.suspect = violation.unwrap_or(suspect);
        Some(violation.is_some())
    }

    /// Sets the pending tensions, solves where that matters, and checks what it touched.
    pub(crate) fn set_pending(&mut self) -> Result<(), F::Error> {
        let changes = std::mem::take(&mut self.pending);
        let pending = on_all_sides::<F>(&changes);
        self.solve(&pending)?;
        self.pending = changes;
        self.pending.clear();
        let touched = &self.touched;
        self.violations.retain(|(i, _)| {
            let after = touched.partition_point(|r| r.start <= *i);
            after == 0 || *i >= touched[after - 1].end
        });
        let untouched = self.violations.len();
        let (family, windows) = (&*self.family, &mut self.windows);
        let legs = |i| family.end_legs(i);
        if touched.len() < MANY {
            for range in touched {
                windows.unproved(range.clone(), legs, &mut self.violations);
            }
        } else {
            let check = |windows: &mut CachedChecker<'_>, k: usize| {
                let mut found = Vec::new();
                windows.unproved(touched[k].clone(), legs, &mut found);
                found
            };
            let windows = &*windows;
            let found: Vec<Vec<_>> =
                parallel::map_with(touched.len(), MANY, || windows.another(), check);
            self.violations.extend(found.into_iter().flatten());
        }
        if untouched > 0 {
            self.violations.sort_unstable_by_key(|f| f.0);
        }
        self.doubts.sift(windows, &mut self.violations, legs);
        if let Some(&(segment, _)) = self.violations.first() {
            self.suspect = segment;
        }
        self.verified = self.violations.is_empty() && self.checks_all();
        Ok(())
    }

    /// Sets tensions of a curve without violations; whether it still has none. Ends at the first
    /// violation, and leaves it to the next solve to look at the rest.
    pub(crate) fn try_tension(&mut self, changes: &[(usize, f64)]) -> Result<bool, F::Error> {
        self.solve(changes)?;
        let (family, windows, doubts) = (&*self.family, &mut self.windows, &self.doubts);
        let legs = |i| family.end_legs(i);
        let known = self.suspect;
        let suspect = self.touched.iter().any(|r| r.contains(&known)).then_some(known..known + 1);
        let violation = suspect
            .into_iter()
            .chain(self.touched.iter().cloned())
            .find_map(|range| first_violation(windows, doubts, range, legs));
        if let Some(segment) = violation {
            self.suspect = segment;
            std::mem::swap(&mut self.unchecked, &mut self.touched);
        }
        self.verified = violation.is_none() && self.checks_all();
        Ok(violation.is_none())
    }

    /// Whether some of the segments fail as they are.
    pub(crate) fn has_violations_among(&mut self, segments: &[usize]) -> bool {
        let (family, windows, doubts) = (&*self.family, &mut self.windows, &self.doubts);
        let legs = |i| family.end_legs(i);
        segments.iter().any(|&i| first_violation(windows, doubts, i..i + 1, legs).is_some())
    }

    /// Sets tensions under which the curve is known to have no violations: solved, not checked again.
    pub(crate) fn return_to(&mut self, changes: &[(usize, f64)]) -> Result<(), F::Error> {
        self.solve(changes)?;
        self.verified = self.checks_all();
        self.touched.clear();
        Ok(())
    }

    /// Whether the last solve was one of all, and touched every segment.
    fn checks_all(&self) -> bool {
        let all = 0..self.windows.polygon().segments();
        self.family.is_fully_solved() && self.touched == [all]
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

    /// The number of nodes with tension.
    fn tense_nodes(&self) -> usize {
        let nodes = self.family.tension().chunks_exact(F::SIDES);
        nodes.filter(|sides| sides.iter().any(|&t| t > 0.0)).count()
    }

    pub(crate) fn outcome(self, status: Status) -> Outcome {
        let diagnostics = Diagnostics {
            status,
            iterations: self.iterations,
            solves: self.solves,
            relaxations: self.relaxations,
            nodes_changed: self.tense_nodes(),
        };
        let undecided = self.doubts.accepted();
        Outcome { diagnostics, history: self.history, violations: self.violations, undecided }
    }
}

/// The first of some segments that is not proved to keep the shape and is no accepted doubt.
fn first_violation(
    windows: &mut CachedChecker<'_>,
    doubts: &Doubts,
    mut segments: Range<usize>,
    legs: impl Fn(usize) -> [DVec3; 2],
) -> Option<usize> {
    while let Some(i) = windows.first_unproved(segments.clone(), &legs) {
        if doubts.is_violation(windows, i, legs(i)) {
            return Some(i);
        }
        segments.start = i + 1;
    }
    None
}

/// Changes by node as changes of the tensions on all of its sides.
pub(crate) fn on_all_sides<F: TensionFamily>(nodes: &[(usize, f64)]) -> Cow<'_, [(usize, f64)]> {
    if F::SIDES == 1 {
        return Cow::Borrowed(nodes);
    }
    let sides = |&(node, tension): &(usize, f64)| {
        (node * F::SIDES..(node + 1) * F::SIDES).map(move |index| (index, tension))
    };
    nodes.iter().flat_map(sides).collect()
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
