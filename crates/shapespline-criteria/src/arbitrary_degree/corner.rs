// SPDX-License-Identifier: MIT OR Apache-2.0

//! Corners at the points: the part of turning that no segment sees of itself.
//!
//! The tangent at a node is held against the chord of its own segment, for on the other side of the node the
//! segment there does the same with the same tangent. Where the two differ, each of them is held against the
//! other chord as well.

use std::ops::Range;

use shapespline_geometry::{DVec3, length, normalize};
use shapespline_polynomial::parallel;

use super::CurveChecker;
use crate::{
    Criterion, Record, Requirements, Violations,
    rounding::{Lean, UNIT, sum},
};

/// Segments that a thread looks at, at least.
const BLOCK: usize = 4096;

impl CurveChecker<'_> {
    /// What is not proved of turning at corners, ascending by segment: of those that are one cubic.
    pub(super) fn corner_violations(&self) -> Vec<(usize, Violations)> {
        let n = self.checker().requirements().len();
        let of = |i: usize| (i, self.corner_violations_of(i, Lean::Against));
        let fails = |violation: &(usize, Violations)| !violation.1.is_empty();
        let is_cubic = |&i: &usize| self.cubic(i).is_some();
        let block = |i: Range<usize>| i.filter(is_cubic).map(of).filter(fails).collect::<Vec<_>>();
        parallel::blocks::<_, Vec<_>>(n, BLOCK, block).concat()
    }

    /// The same of one segment: what is not proved, or what certainly fails.
    pub(super) fn corner_violations_of(&self, i: usize, lean: Lean) -> Violations {
        let at = |end: usize, violation: Violations| {
            let beyond = self.beyond_chord(i, end, self.end_tangent(i, end));
            let fails = beyond.is_some_and(|beyond| beyond.is_certain || lean == Lean::Against);
            if fails { violation } else { Violations::default() }
        };
        at(0, Violations::TURNING_AT_START).union(at(1, Violations::TURNING_AT_END))
    }

    /// A record with what the corners at the ends of its segment add to it.
    pub(super) fn with_corners(&self, record: Record) -> Record {
        if !record.applicable || record.criterion != Criterion::Turning {
            return record;
        }
        let segment = record.segment;
        let beyond = |end| self.beyond_chord(segment, end, self.end_tangent(segment, end));
        [0, 1].into_iter().fold(record, |record, end| match beyond(end) {
            Some(Beyond { margin, .. }) if margin < record.margin => {
                let location = self.checker().polygon().parameters()[segment + end];
                Record { satisfied: false, margin, location, ..record }
            }
            Some(_) => Record { satisfied: false, ..record },
            None => record,
        })
    }

    /// How far the tangent at the start (0) or the end (1) of a segment, given with what it may be off by,
    /// lies beyond the chord of the segment beside. None where it certainly does not, and none where both
    /// segments have the same tangent.
    pub(super) fn beyond_chord(
        &self,
        segment: usize,
        end: usize,
        (own, error): (DVec3, f64),
    ) -> Option<Beyond> {
        let polygon = self.checker().polygon();
        let asked = [Requirements::TURNING_AT_START, Requirements::TURNING_AT_END][end];
        if !self.checker().requirements()[segment].intersects(asked) {
            return None;
        }
        let n = polygon.segments();
        let at_end = if end == 0 { segment == 0 } else { segment + 1 == n };
        // The tangent that was given there is the curve's own.
        if at_end && !polygon.is_closed() {
            return None;
        }
        let beside = if end == 0 { segment + n - 1 } else { segment + 1 } % n;
        let [before, after] = polygon.directions_at(segment + end);
        let normal = polygon.binormal(segment + end);
        let product = if end == 0 { before.cross(own) } else { own.cross(after) }.dot(normal);
        // The unit chord has a sum of coordinates of √3 at most; it and the products round by a few units.
        let error = (2.0 * error + 8.0 * UNIT * sum(own)) * 1.75 * sum(normal);
        // Written so that a NaN fails.
        if product > error {
            return None;
        }
        let other = normalize(self.end_tangent(beside, 1 - end).0);
        let direction = normalize(own);
        let off = direction.cross(other).length();
        if off <= self.checker().tolerances().zero && direction.dot(other) > 0.0 {
            return None;
        }
        let size = length(own) * normal.length();
        let is_certain = !(product > -error);
        let sine = if is_certain && size > 0.0 { product / size } else { 0.0 };
        Some(Beyond { margin: sine.clamp(-1.0, 0.0), is_certain })
    }
}

/// A tangent beyond a chord.
pub(super) struct Beyond {
    /// The sine between them; not positive, and zero where rounding hides it.
    pub(super) margin: f64,
    /// Whether it is there however the tangent rounds.
    pub(super) is_certain: bool,
}
