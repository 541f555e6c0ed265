//! Segments that consist of several pieces, without a curve around them.

use glam::DVec3;
use shapespline_geometry::{BezierPart, length, polynomial::Sign};

use super::{Question, Segment, decide};
use crate::{Calls, Checker, Criterion};

impl Checker<'_> {
    /// The criteria that a segment of several polynomial pieces is not proved to meet, each with what is
    /// known of it. The pieces' control points are seen from the segment's first point; their signs
    /// are decided as [`CurveChecker`](crate::CurveChecker) decides them. Corners at the points are not
    /// seen here.
    #[must_use]
    pub fn unproved(&self, segment: usize, parts: &[BezierPart]) -> Vec<(Criterion, Sign)> {
        let required = self.calls()[segment];
        if required.is_empty() {
            return Vec::new();
        }
        let pieces = Segment::new(parts, false, length(self.polygon().points()[segment]));
        let sign = |criterion| {
            let question = self.question(segment, criterion)?;
            let sign = decide(&pieces, &question);
            (sign != Sign::Positive).then_some((criterion, sign))
        };
        required.criteria().iter().filter_map(sign).collect()
    }

    /// What a segment of any degree is asked of a criterion.
    pub(crate) fn question(&self, segment: usize, criterion: Criterion) -> Option<Question> {
        let calls = self.calls()[segment];
        let polygon = self.polygon();
        let normals = [segment, segment + 1].map(|i| polygon.binormal(i).normalize_or_zero());
        let beside = polygon.binormals_beside(segment).map(DVec3::normalize_or_zero);
        let cones = self.cones(segment);
        let chord = polygon.direction(segment);
        let question = Question { criterion, calls, normals, beside, chord, cones };
        calls.any(Calls::of(criterion)).then_some(question)
    }
}
