// SPDX-License-Identifier: MIT OR Apache-2.0

//! Segments that are polynomial cubics, or consist of them: decided by their legs.

use shapespline_geometry::DVec3;

use super::{CurveChecker, checker::Scan, single_pieces::Single};
use crate::{
    Criterion, Requirements, Undecided, Violations,
    checker::Cubic,
    rounding::{Lean, UNIT},
};

impl CurveChecker<'_> {
    /// The piece that a segment is, where it is one.
    pub(super) fn single(&self, i: usize) -> Option<usize> {
        match &self.single {
            Single::All => Some(i),
            Single::Some(pieces) => pieces[i],
        }
    }

    /// A segment that is one polynomial cubic, between its own end points.
    pub(super) fn cubic(&self, i: usize) -> Option<Cubic> {
        // The conditions on single cubics do not know what is zero by construction.
        let beside = Requirements::STRAIGHT_BEFORE.union(Requirements::STRAIGHT_AFTER);
        let subdivided = self.curve.degree() != 3 || self.curve.is_rational();
        if subdivided || self.checker().requirements()[i].intersects(beside) {
            return None;
        }
        let p = self.curve.piece(self.single(i)?);
        let far = p[0].abs().max(p[3].abs()).truncate().max_element();
        let legs = [(p[1] - p[0]).truncate(), (p[3] - p[2]).truncate()];
        Some(Cubic { legs, chord: (p[3] - p[0]).truncate(), far })
    }

    /// The segments that have to be looked at one by one, ascending: those that are not one polynomial cubic,
    /// and of those that are the ones that are not proved to keep the shape. Many of these are judged at once
    /// by the chords of the polygon; those that end off its points by more than rounding, by their own.
    pub(super) fn open_segments(&self) -> Vec<usize> {
        let n = self.checker().requirements().len();
        if self.curve.degree() != 3 || self.curve.is_rational() {
            return (0..n).collect();
        }
        let points = self.checker().polygon().points();
        let ends_off = |i: usize| {
            let (Some(piece), Some(cubic)) = (self.single(i), self.cubic(i)) else { return false };
            let p = self.curve.piece(piece);
            let off = |end: usize, k: usize| (p[k].truncate() - points[end]).abs().max_element();
            off(i, 0) + off(i + 1, 3) > 2.0 * UNIT * cubic.far
        };
        // Of several pieces nothing is known yet: what is said of these legs does not count.
        let legs = |i: usize| self.cubic(i).map_or([DVec3::ZERO; 2], |cubic| cubic.legs);
        let violations = self.checker().all_unproved(legs);
        let unproved = |i: usize| match self.cubic(i) {
            Some(cubic) => {
                ends_off(i) && !self.checker().judge(i, &cubic, Lean::Against).is_empty()
            }
            None => true,
        };
        let apart = (0..n).filter(|&i| unproved(i));
        let own = violations.iter().map(|violation| violation.0).filter(|&i| !ends_off(i));
        let corners = self.corner_violations().into_iter().map(|violation| violation.0);
        let mut open: Vec<usize> = own.chain(apart).chain(corners).collect();
        open.sort_unstable();
        open.dedup();
        open
    }

    /// What is not proved of a segment that is one polynomial cubic, and what is violated.
    pub(super) fn cubic_verdict(&self, i: usize, cubic: &Cubic) -> [Violations; 2] {
        [Lean::Against, Lean::For].map(|lean| {
            self.checker().judge(i, cubic, lean).union(self.corner_violations_of(i, lean))
        })
    }

    pub(super) fn check_cubic(&self, i: usize, cubic: &Cubic) -> Scan {
        let mut found = Scan::default();
        let [open, violated] = self.cubic_verdict(i, cubic);
        for criterion in Criterion::ALL {
            let of = Violations::of(criterion);
            if violated.intersects(of) {
                found.records.push(self.record(i, criterion));
            } else if open.intersects(of) {
                let interval = self.checker().interval(i, open.intersection(of));
                found.undecided.push(Undecided { segment: i, criterion, interval });
            }
        }
        found
    }

    /// Whether a segment of several cubics is proved to keep the shape, without subdivision.
    pub(super) fn is_proved(&self, i: usize) -> bool {
        if self.curve.degree() != 3 || self.curve.is_rational() {
            return false;
        }
        let (polygon, u) = (self.checker().polygon(), self.checker().polygon().parameters());
        let parts = self.curve.between([u[i], u[i + 1]], polygon.points()[i]);
        let smooth = |end: usize| {
            let part = if end == 0 { parts.first() } else { parts.last() };
            part.and_then(|part| self.checker().end_leg(i, part, end))
                .is_some_and(|leg| self.beyond_chord(i, end, leg).is_none())
        };
        self.checker().is_proved(i, &parts) && smooth(0) && smooth(1)
    }
}
