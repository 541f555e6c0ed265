// SPDX-License-Identifier: MIT OR Apache-2.0

//! Segments that consist of several pieces, without a curve around them.

use glam::DVec3;
use shapespline_geometry::{BezierPart, length};
use shapespline_polynomial::Sign;

use super::{Question, Segment, prove_sign};
use crate::{
    Checker, Criterion, Requirements,
    regular::leads_along,
    rounding::{Coarse, LEG_ERROR, Lean, UNIT, sum},
    segment_geometry::SegmentGeometry,
    violations::{unproved, violations},
};

/// What is decided piece by piece: no part of a segment that begins or ends within a piece is asked.
const BY_PIECES: Requirements = Requirements::CONVEXITY
    .union(Requirements::INFLECTION)
    .union(Requirements::RIGHT_TORSION)
    .union(Requirements::LEFT_TORSION)
    .union(Requirements::COPLANARITY)
    .union(Requirements::TURNING_AT_START)
    .union(Requirements::TURNING_AT_END)
    .union(Requirements::TURNING_PAIR)
    .union(Requirements::TURNING_BEFORE)
    .union(Requirements::TURNING_AFTER)
    .union(Requirements::REGULAR)
    .union(Requirements::LEGS);

/// Sine of the angle between tangents where pieces meet that were meant to be smooth.
const SMOOTH: f64 = 1e-12;

impl Checker<'_> {
    /// The criteria that a segment of several polynomial pieces is not proved to meet, each with what is
    /// known of it. The pieces' control points are seen from the segment's first point; their signs
    /// are decided as [`CurveChecker`](crate::CurveChecker) decides them. Corners at the points are not
    /// seen here.
    #[must_use]
    pub fn unproved_pieces(&self, segment: usize, parts: &[BezierPart]) -> Vec<(Criterion, Sign)> {
        let required = self.requirements()[segment];
        if required.is_empty() || self.is_proved(segment, parts) {
            return Vec::new();
        }
        self.left_by_subdivision(segment, parts)
    }

    /// The same, whatever is clear from the legs.
    fn left_by_subdivision(&self, segment: usize, parts: &[BezierPart]) -> Vec<(Criterion, Sign)> {
        let required = self.requirements()[segment];
        let pieces = Segment::new(parts, false, length(self.polygon().points()[segment]));
        let pieces = pieces.beside(required);
        let sign = |criterion| {
            let question = self.question(segment, criterion)?;
            let sign = prove_sign(&pieces, &question);
            (sign != Sign::Positive).then_some((criterion, sign))
        };
        required.criteria().iter().filter_map(sign).collect()
    }

    /// Whether all that is asked of a segment of several cubics is clear from its legs: what nearly every
    /// segment of a smooth curve is, in a fraction of the time that subdivision takes. `ω` is to keep its
    /// sides on every piece (Lemma 5.1), or to change all of them on one, and the torsion its sign.
    pub(crate) fn is_proved(&self, segment: usize, parts: &[BezierPart]) -> bool {
        let required = self.requirements()[segment];
        let bends = required.intersects(Requirements::CONVEXITY.union(Requirements::INFLECTION));
        let sided = required.intersects(Requirements::TURNING_PAIR) && !bends;
        // Near a plane, on the side that convexity says.
        let lost = required.intersects(Requirements::COPLANARITY)
            && !required.intersects(Requirements::CONVEXITY);
        if !required.difference(BY_PIECES).is_empty() || sided || lost {
            return false;
        }
        let Some(pieces) = self.cubics(segment, parts) else { return false };
        let p = self.polygon().binormal(segment);
        // The side at the start of each piece, and the piece on which it changes.
        let before = pieces.iter().filter(|s| s.omega[0].dot(p) > 0.0).count();
        let change = if required.intersects(Requirements::INFLECTION) {
            before.wrapping_sub(1)
        } else {
            usize::MAX
        };
        let last = pieces.len() - 1;
        let proved = |(k, s): (usize, &SegmentGeometry)| {
            let mut own = required
                .difference(Requirements::TURNING_PAIR)
                .difference(Requirements::REGULAR.union(Requirements::LEGS));
            if k != 0 {
                own = own
                    .difference(Requirements::TURNING_AT_START.union(Requirements::TURNING_BEFORE));
            }
            if k != last {
                own =
                    own.difference(Requirements::TURNING_AT_END.union(Requirements::TURNING_AFTER));
            }
            let mut s = *s;
            if required.intersects(Requirements::INFLECTION) && k != change {
                // All of it on one side of the change.
                own = own.difference(Requirements::INFLECTION).union(Requirements::CONVEXITY);
                (s.p, s.q) = if k < change { (s.p, -s.q) } else { (-s.p, s.q) };
            }
            self.is_clear(segment, &s, own)
        };
        let regular = |s: &SegmentGeometry| leads_along([s.a, s.c], s.chord);
        pieces.iter().enumerate().all(proved)
            && (!required.intersects(Requirements::REGULAR) || pieces.iter().all(regular))
            && pieces.windows(2).all(|pair| {
                let (u, v) = (pair[0].c.normalize_or_zero(), pair[1].a.normalize_or_zero());
                u.cross(v).length() <= SMOOTH && u.dot(v) > 0.0
            })
            && self.leans_to_its_chord(segment, parts)
    }

    /// Whether what is asked of a piece is met beyond doubt.
    fn is_clear(&self, segment: usize, s: &SegmentGeometry, required: Requirements) -> bool {
        let turns = [s.before, s.p, s.q, s.after].map(sum);
        let bounds = Coarse::new(sum(s.a) + sum(s.chord) + sum(s.c), s.slack, turns);
        let clear = !required.intersects(Requirements::COPLANARITY)
            && unproved(s, bounds, required.bits()) == 0;
        clear || violations(s, required, Lean::Against, || self.cones(segment)).is_empty()
    }

    /// The cubic pieces as the conditions see them; none where they are not cubics.
    fn cubics(&self, segment: usize, parts: &[BezierPart]) -> Option<Vec<SegmentGeometry>> {
        let polygon = self.polygon();
        let ([p, q], [before, after]) =
            (polygon.binormals(segment), polygon.binormals_beside(segment));
        let origin = polygon.points()[segment];
        let one = |part: &BezierPart| {
            let [a, b, c, d] = part.control.as_slice() else { return None };
            if [a, b, c, d].iter().any(|p| p.w != 1.0) {
                return None;
            }
            let [a, b, c, d] = [a, b, c, d].map(|p| p.truncate());
            let far = (origin + a).abs().max((origin + d).abs()).max_element();
            Some(SegmentGeometry::new([b - a, d - c], d - a, [before, p, q, after], far))
        };
        let pieces: Option<Vec<_>> = parts.iter().map(one).collect();
        pieces.filter(|pieces| !pieces.is_empty())
    }

    /// Whether the end tangents, where turning is asked, lie on their own sides of the segment's chord.
    fn leans_to_its_chord(&self, segment: usize, parts: &[BezierPart]) -> bool {
        let (polygon, required) = (self.polygon(), self.requirements()[segment]);
        let direction = polygon.direction(segment);
        let leans = |end: usize, part: &BezierPart| {
            let Some((leg, error)) = self.end_leg(segment, part, end) else { return false };
            let normal = polygon.binormal(segment + end);
            let product = if end == 0 { leg.cross(direction) } else { direction.cross(leg) };
            // The unit chord has a sum of coordinates of √3 at most; it and the products round by a few units.
            let error = (2.0 * error + 8.0 * UNIT * sum(leg)) * 1.75 * sum(normal);
            product.dot(normal) > error
        };
        let asked = [Requirements::TURNING_AT_START, Requirements::TURNING_AT_END];
        [parts.first(), parts.last()].into_iter().enumerate().all(|(end, part)| {
            !required.intersects(asked[end]) || part.is_some_and(|part| leans(end, part))
        })
    }

    /// The first (0) or the last (1) leg of a part of a segment, and what its coordinates may be off by.
    pub(super) fn end_leg(
        &self,
        segment: usize,
        part: &BezierPart,
        end: usize,
    ) -> Option<(DVec3, f64)> {
        let control = &part.control;
        let k = if end == 0 { 0 } else { control.len().checked_sub(2)? };
        let [a, b] = [control.get(k)?, control.get(k + 1)?].map(|p| p.truncate());
        let origin = self.polygon().points()[segment];
        let far = (origin + a).abs().max((origin + b).abs()).max_element();
        Some((b - a, LEG_ERROR * far))
    }

    /// What a segment of any degree is asked of a criterion.
    pub(crate) fn question(&self, segment: usize, criterion: Criterion) -> Option<Question> {
        let required = self.requirements()[segment];
        let polygon = self.polygon();
        let normals = [segment, segment + 1].map(|i| polygon.binormal(i).normalize_or_zero());
        let beside = polygon.binormals_beside(segment).map(DVec3::normalize_or_zero);
        let cones = self.cones(segment);
        let chord = polygon.direction(segment);
        let question = Question { criterion, required, normals, beside, chord, cones };
        required.intersects(Requirements::of(criterion)).then_some(question)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use glam::DVec4;
    use shapespline_geometry::{Boundary, DataPolygon, Parametrization};
    use shapespline_polynomial::bernstein::split;

    use super::*;
    use crate::{Criteria, Tolerances};

    /// A cubic in three pieces, of which the inner joints are moved, along with the points beside them.
    fn parts(control: [DVec3; 4], moves: [DVec3; 2]) -> Vec<BezierPart> {
        let whole: Vec<DVec4> = control.iter().map(|p| p.extend(1.0)).collect();
        let (first, rest) = split(whole, 0.25);
        let (middle, last) = split(rest, 2.0 / 3.0);
        let [x, y] = moves.map(|v| v.extend(0.0));
        let shift = |mut c: Vec<DVec4>, from: [DVec4; 2]| {
            (c[0], c[1]) = (c[0] + from[0], c[1] + from[0]);
            (c[2], c[3]) = (c[2] + from[1], c[3] + from[1]);
            c
        };
        let none = DVec4::ZERO;
        let part = |control, local| BezierPart { control, local };
        vec![
            part(shift(first, [none, x]), [0.0, 0.25]),
            part(shift(middle, [x, y]), [0.25, 0.75]),
            part(shift(last, [y, none]), [0.75, 1.0]),
        ]
    }

    #[test]
    fn what_legs_prove_subdivision_proves() {
        let at = |k: usize| {
            let t = k as f64;
            let bend = if k / 9 % 4 == 1 { 0.0 } else { (0.7 * t).sin() };
            DVec3::new(
                t,
                bend,
                if (k / 40).is_multiple_of(2) { 0.3 * (1.3 * t).sin() } else { 0.0 },
            )
        };
        let points = (0..400).map(at).collect();
        let boundary = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
        for (criteria, least) in [(Criteria::DEFAULT, 0.4), (Criteria::ALL, 0.1)] {
            let checker = Checker::new(&polygon, criteria, Tolerances::default());
            let (mut proved, mut held, mut failed) = (0usize, 0usize, 0usize);
            for (scale, size) in [(0.3, 0.0), (0.6, 1e-3), (1.0, 0.0), (1.0, 1e-2), (2.0, 0.1)] {
                for i in 0..polygon.segments() {
                    let slope = |node: usize| {
                        let [before, after] = polygon.directions_at(node);
                        (before + after) * (0.4 * scale)
                    };
                    let (chord, [a, c]) = (polygon.chord(i), [slope(i), slope(i + 1)]);
                    let moves = [0.3, 0.8].map(|k| {
                        let x = i as f64 + k;
                        DVec3::new((5.1 * x).sin(), (3.3 * x).cos(), (7.7 * x).sin()) * size
                    });
                    let parts = parts([DVec3::ZERO, a, chord - c, chord], moves);
                    let holds = checker.left_by_subdivision(i, &parts).is_empty();
                    let clear = checker.is_proved(i, &parts);
                    assert!(holds || !clear, "{i}: {:?}", checker.left_by_subdivision(i, &parts));
                    proved += usize::from(clear);
                    held += usize::from(holds);
                    failed += usize::from(!holds);
                }
            }
            assert!(
                failed > 100 && proved as f64 > least * held as f64,
                "{proved} {held} {failed}"
            );
        }
    }
}
