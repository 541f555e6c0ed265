// SPDX-License-Identifier: MIT OR Apache-2.0

//! Segments of which rounding hides whether they keep the shape.
//!
//! A search asks more of a curve than that nothing is violated: that everything is proved. Mostly more
//! tension brings that about. It cannot where legs are too short to show a direction beside their control
//! points, and more tension makes them shorter. So a segment that some rounds of raising leave undecided is
//! accepted, as long as the conditions on it hold as computed.

use std::collections::BTreeMap;

use shapespline_criteria::{Violations, batch::CachedChecker};
use shapespline_geometry::DVec3;

/// Rounds of raising after which a segment that is still undecided is accepted: tension that doubles has
/// grown 16-fold.
const ROUNDS: usize = 4;

/// How often segments were found undecided.
#[derive(Debug, Default)]
pub(crate) struct Doubts {
    rounds: BTreeMap<usize, usize>,
}

impl Doubts {
    /// Whether a segment may stay undecided.
    pub(crate) fn is_accepted(&self, segment: usize) -> bool {
        self.rounds.get(&segment).is_some_and(|&rounds| rounds > ROUNDS)
    }

    /// The segments that may stay undecided, ascending.
    pub(crate) fn accepted(&self) -> Vec<usize> {
        self.rounds.keys().copied().filter(|&i| self.is_accepted(i)).collect()
    }

    /// Whether a segment that is not proved to keep the shape is to be mended.
    pub(crate) fn is_violation(
        &self,
        windows: &mut CachedChecker<'_>,
        segment: usize,
        legs: [DVec3; 2],
    ) -> bool {
        !self.is_accepted(segment) || !windows.failures_at(segment, legs).is_empty()
    }

    /// Leaves those of the segments that are not proved to keep the shape that are to be mended.
    pub(crate) fn sift(
        &mut self,
        windows: &mut CachedChecker<'_>,
        violations: &mut Vec<(usize, Violations)>,
        legs: impl Fn(usize) -> [DVec3; 2],
    ) {
        let fails = |&(i, _): &(usize, Violations)| !windows.failures_at(i, legs(i)).is_empty();
        let fails: Vec<bool> = violations.iter().map(fails).collect();
        if fails.iter().all(|&fails| fails) {
            return;
        }
        let mut fails = fails.into_iter();
        violations.retain(|&(segment, _)| {
            if fails.next() == Some(true) {
                return true;
            }
            *self.rounds.entry(segment).or_default() += 1;
            !self.is_accepted(segment)
        });
    }

    /// Accepts all segments if none of them is violated, where tension can rise no further.
    pub(crate) fn accept(
        &mut self,
        windows: &mut CachedChecker<'_>,
        violations: &mut Vec<(usize, Violations)>,
        legs: impl Fn(usize) -> [DVec3; 2],
    ) {
        if violations.iter().all(|&(i, _)| windows.violations_at(i, legs(i)).is_empty()) {
            self.rounds.extend(violations.drain(..).map(|(i, _)| (i, ROUNDS + 1)));
        }
    }
}
