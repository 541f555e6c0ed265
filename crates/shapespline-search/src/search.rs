// SPDX-License-Identifier: MIT OR Apache-2.0

//! The search: solve, check, raise; at the end solve and check everything anew.

use std::ops::ControlFlow;

use shapespline_criteria::{
    Checker, ShapeReport, Violations,
    batch::{BatchChecker, CachedChecker},
};
use shapespline_geometry::DataPolygon;
use shapespline_polynomial::parallel;

use crate::{
    FitError, FittedLegs, Outcome, Phase, SearchOptions, Status, Step, Strategy, TensionFamily,
    lower::lower, state::State, system::MANY,
};

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
    let mut windows = checker.cached();
    let violations = windows.all_unproved(|i| family.end_legs(i));
    search_from(violations, family, windows, options, monitor)
}

/// [`search`] on the polygon of a family: the legs that result, and the report on them.
///
/// # Errors
/// Options outside their range; those of the family's solver.
pub fn search_and_report<F>(
    family: &mut F,
    polygon: &DataPolygon,
    options: &SearchOptions,
    monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<FittedLegs, FitError>
where
    F: TensionFamily,
    FitError: From<F::Error>,
{
    options.validate()?;
    let criteria = BatchChecker::new(polygon, options.criteria, options.tolerances);
    let mut windows = criteria.cached();
    let mut legs: Vec<_> = parallel::map(polygon.segments(), MANY, |i| family.end_legs(i));
    let (violations, applicable) = windows.scan(|i| legs[i]);
    let clean = || ShapeReport::clean(polygon.segments(), options.criteria, applicable);
    if violations.is_empty() {
        return Ok(FittedLegs { legs, outcome: Outcome::solved(), report: clean() });
    }
    let outcome = search_from(violations, family, windows, options, monitor)?;
    parallel::fill(&mut legs, MANY, |i, legs| *legs = family.end_legs(i));
    let open = outcome
        .violations
        .iter()
        .map(|violation| violation.0)
        .chain(outcome.undecided.iter().copied());
    let mut open: Vec<usize> = open.collect();
    open.sort_unstable();
    open.dedup();
    let report = if open.is_empty() {
        clean()
    } else {
        options.checker(polygon)?.report_of(&open, |i| legs[i])
    };
    Ok(FittedLegs { legs, outcome, report })
}

/// [`search`], given the violations of the current curve.
fn search_from<F: TensionFamily>(
    violations: Vec<(usize, Violations)>,
    family: &mut F,
    windows: CachedChecker<'_>,
    options: &SearchOptions,
    monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<Outcome, F::Error> {
    let mut state = State::new(violations, family, windows, monitor);
    let mut status = state.raise(options)?;
    if status == Status::Solved && !state.untouched() {
        if options.strategy == Strategy::Fairest {
            lower(&mut state)?;
        }
        status = state.verify(options)?;
    }
    if status != Status::Solved && !state.untouched() {
        // Changes of a rounding or two were not looked at, and a verdict can hang on them.
        state.solve_and_check_anew()?;
        if status == Status::Stalled {
            state.accept_doubts();
        }
        if state.violations.is_empty() {
            status = Status::Solved;
        }
    }
    Ok(state.outcome(status))
}

impl<F: TensionFamily> State<'_, F> {
    /// Accepts what is undecided if that is all that is left.
    fn accept_doubts(&mut self) {
        let Self { family, windows, doubts, violations, .. } = self;
        doubts.accept(windows, violations, |i| family.end_legs(i));
    }

    /// Solves and checks everything anew, unless the curve as it is was solved as a whole and no segment of
    /// it failed; raises again in the (unseen) case that something fails.
    fn verify(&mut self, options: &SearchOptions) -> Result<Status, F::Error> {
        loop {
            if !self.is_verified() {
                self.solve_and_check_anew()?;
            }
            self.log(Phase::Verify, self.violations.len(), 0);
            if self.violations.is_empty() {
                return Ok(Status::Solved);
            }
            match self.raise(options)? {
                Status::Solved => {}
                status => return Ok(status),
            }
        }
    }
}
