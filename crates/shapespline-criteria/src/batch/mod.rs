// SPDX-License-Identifier: MIT OR Apache-2.0

//! The checker that goes through a polygon batch by batch: for local methods, and for a single check
//! that keeps nothing.

mod cached;

use std::ops::Range;

pub use cached::CachedChecker;
use shapespline_geometry::{
    DVec3, DataPolygon,
    batch::{SegmentBatch, VectorLanes},
};

use crate::{
    Criteria, Criterion, Requirements, Tolerances, Violations,
    cone::Cones,
    regular::leads_along,
    rounding::{Coarse, Lean, leg_error, sum},
    segment_geometry::SegmentGeometry,
    violations::{unproved, violations},
};

/// The shape criteria of a polygon, asked batch by batch: to the bit what a
/// [`Checker`](crate::Checker) finds, with nothing kept in memory that grows with the polygon.
#[derive(Debug, Clone, Copy)]
pub struct BatchChecker<'a> {
    polygon: &'a DataPolygon,
    tolerances: Tolerances,
    wanted: Requirements,
}

/// What the segments of a batch require, by place.
pub type BatchRequirements = [Requirements; SegmentBatch::ROOM];

impl<'a> BatchChecker<'a> {
    /// Some criteria, asked of a polygon. Cost O(N) at most, to find out whether it is planar.
    #[must_use]
    pub fn new(polygon: &'a DataPolygon, criteria: Criteria, tolerances: Tolerances) -> Self {
        let planar = Requirements::is_planar(polygon, &tolerances);
        Self { polygon, tolerances, wanted: Requirements::wanted(criteria, planar) }
    }

    /// What the segments of a batch require, except at its first and its last two places.
    pub fn requirements(&self, batch: &SegmentBatch, required: &mut BatchRequirements) {
        Requirements::of_batch(self.polygon, batch, self.wanted, &self.tolerances, required);
    }

    /// What each segment of the polygon requires. Cost O(N), on all threads for long polygons.
    pub(crate) fn all_requirements(&self) -> Vec<Requirements> {
        Requirements::among(self.polygon, &self.tolerances, self.wanted)
    }

    /// How many of a batch's own segments each criterion applies to.
    #[must_use]
    pub fn applicable(
        batch: &SegmentBatch,
        required: &BatchRequirements,
    ) -> [usize; Criterion::COUNT] {
        Requirements::count(&required[batch.own()])
    }

    /// Adds those of a batch's own segments that are not proved to keep the shape with the end legs
    /// `first, last`.
    pub fn unproved(
        &self,
        batch: &SegmentBatch,
        required: &BatchRequirements,
        legs: [&VectorLanes; 2],
        found: &mut Vec<(usize, Violations)>,
    ) {
        self.unproved_among(batch.own(), batch, required, legs, found);
    }

    /// The same criteria with a cache, for callers that check the same segments again and again.
    #[must_use]
    pub fn cached(&self) -> CachedChecker<'a> {
        CachedChecker::new(*self, None)
    }

    /// The polygon.
    #[must_use]
    pub fn polygon(&self) -> &'a DataPolygon {
        self.polygon
    }

    /// What counts as near, and as zero.
    #[must_use]
    pub fn tolerances(&self) -> Tolerances {
        self.tolerances
    }

    /// Adds the segments at some of a batch's own places that are not proved to keep the shape with the
    /// end legs `first, last`.
    pub(crate) fn unproved_among(
        &self,
        places: Range<usize>,
        batch: &SegmentBatch,
        required: &BatchRequirements,
        [first, last]: [&VectorLanes; 2],
        found: &mut Vec<(usize, Violations)>,
    ) {
        let (chords, binormals) = (batch.chords(), batch.binormals());
        // Where sizes are not ordinary every segment is decided by itself.
        let mut doubts = [1; SegmentBatch::ROOM];
        let mut any = 1;
        if batch.is_ordinary() {
            any = 0;
            let far = batch.far();
            let end = places.end.min(batch.less(SegmentBatch::BESIDE));
            let (lengths, sines) = (batch.lengths(), batch.sines());
            // ‖v‖₁ is at most √3 times the length.
            const ROOT: f64 = 1.7321;
            for j in places.start - SegmentBatch::BESIDE..end - SegmentBatch::BESIDE {
                // Written out: `map` on arrays keeps the loop from working on several at once.
                let [a, c] = [first.get(j + 3), last.get(j + 3)];
                let around = [
                    binormals.get(j + 1),
                    binormals.get(j + 2),
                    binormals.get(j + 3),
                    binormals.get(j + 4),
                ];
                let size = sum(a) + sum(c) + ROOT * lengths[j + 3];
                let slack = leg_error(far, size);
                let s = SegmentGeometry::of_scaled([a, c], chords.get(j + 3), around, slack);
                let turns = [
                    ROOT * sines[j + 1],
                    ROOT * sines[j + 2],
                    ROOT * sines[j + 3],
                    ROOT * sines[j + 4],
                ];
                let bounds = Coarse::new(size, slack, turns);
                doubts[j + 3] = unproved(&s, bounds, required[j + 3].bits());
                any |= doubts[j + 3];
            }
        }
        if any == 0 {
            return;
        }
        let stops = |j: usize| !leads_along([first.get(j), last.get(j)], chords.get(j));
        let regular = Requirements::of(Criterion::Regular).bits();
        let doubted = |&j: &usize| match doubts[j] {
            0 => false,
            // Beside straight runs, and at natural ends, nothing else is left open.
            open => open & !regular != 0 || stops(j),
        };
        for j in places.filter(doubted) {
            let legs = [first.get(j), last.get(j)];
            let violations = self.violations_at(batch, required[j], legs, j, Lean::Against);
            if !violations.is_empty() {
                found.push((batch.segment(self.polygon, j), violations));
            }
        }
    }

    /// What fails on the segment at one of a batch's own places, doubts being counted as `lean` says.
    pub(crate) fn violations_at(
        &self,
        batch: &SegmentBatch,
        required: Requirements,
        legs: [DVec3; 2],
        j: usize,
        lean: Lean,
    ) -> Violations {
        if required.is_empty() {
            return Violations::default();
        }
        let segment = batch.segment(self.polygon, j);
        let binormals = batch.binormals();
        let around =
            [binormals.get(j - 2), binormals.get(j - 1), binormals.get(j), binormals.get(j + 1)];
        let (chord, far) = (batch.chords().get(j), far(self.polygon, segment));
        let s = SegmentGeometry::new(legs, chord, around, far);
        violations(&s, required, lean, || {
            let around = [j - 1, j, j + 1].map(|j| batch.directions().get(j));
            Cones::new(self.polygon, segment, around, required, &self.tolerances)
        })
    }
}

/// The largest coordinate of the ends of a segment.
pub(crate) fn far(polygon: &DataPolygon, segment: usize) -> f64 {
    let [p, q] = [segment, segment + 1].map(|i| polygon.points()[i].abs());
    p.max(q).max_element()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::{Checker, Criterion};

    /// Verdicts are those of the checker that sees one segment at a time, also on handles that fail.
    #[test]
    fn a_stretch_is_judged_as_its_segments_are() {
        let n = SegmentBatch::OWN;
        let mut failed = Violations::default();
        for (twist, size) in [0.0, 0.3, 1.3]
            .into_iter()
            .flat_map(|twist| [1e-200, 1.0, 1e39].map(|size| (twist, size)))
        {
            let at = |k: usize| {
                let t = k as f64;
                let bend = if k / 9 % 4 == 1 { 0.0 } else { (0.7 * t).sin() };
                DVec3::new(t, bend, (twist * t).sin()) * size
            };
            let points = (0..=n).map(at).collect();
            let boundary = Boundary::ZeroCurvature;
            let polygon = DataPolygon::new(points, &Parametrization::Uniform, boundary).unwrap();
            let (criteria, tolerances) = (Criteria::ALL, Tolerances::default());
            let checker = Checker::new(&polygon, criteria, tolerances);
            let local = BatchChecker::new(&polygon, criteria, tolerances);
            let (mut batch, mut required) =
                (SegmentBatch::default(), [Requirements::default(); SegmentBatch::ROOM]);
            batch.load(&polygon, 0..n);
            local.requirements(&batch, &mut required);
            assert_eq!(&required[batch.own()], checker.requirements());
            // One criterion alone is asked for where it is among all of them.
            for criterion in Criterion::ALL {
                let one = Criteria::NONE.with(criterion);
                let alone = Checker::new(&polygon, one, tolerances);
                let of = |checker: &Checker<'_>| -> Vec<Requirements> {
                    checker.requirements().iter().map(|required| required.only(one)).collect()
                };
                if criterion != Criterion::Regular {
                    assert_eq!(of(&alone), of(&checker));
                }
            }
            for scale in [0.1, 0.4, 1.0, 3.0] {
                // Tilted, or torsion would never fail.
                let slope = |node: usize| {
                    let [before, after] = polygon.directions_at(node);
                    (before + after + DVec3::Z * (0.3 * twist)) * (0.4 * scale * size)
                };
                let legs = |i: usize| [slope(i), slope(i + 1)];
                let (mut first, mut last) = (VectorLanes::default(), VectorLanes::default());
                for (i, j) in batch.own().enumerate() {
                    let [a, c] = legs(i);
                    first.set(j, a);
                    last.set(j, c);
                }
                let mut violations = Vec::new();
                local.unproved(&batch, &required, [&first, &last], &mut violations);
                let alone = (0..n).map(|i| (i, checker.unproved(i, legs(i))));
                assert!(
                    alone
                        .filter(|violation| !violation.1.is_empty())
                        .eq(violations.iter().copied())
                );
                assert_eq!(violations, checker.all_unproved(legs));
                assert_eq!(
                    (violations.clone(), checker.applicable(0..n)),
                    local.cached().scan(legs)
                );
                failed =
                    violations.iter().fold(failed, |all, &(_, violations)| all.union(violations));
            }
        }
        for criterion in Criterion::ALL {
            assert!(failed.intersects(Violations::of(criterion)), "{criterion}");
        }
    }

    /// A binormal at a right angle, to the last bit, to the one that it has to oppose is a
    /// violation here as well: no doubt may be lost because a product is zero and not positive.
    #[test]
    fn a_product_of_zero_is_a_violation() {
        // Binormal vectors along (0, 0, 1) and (0, 1, −1): the second segment inflects.
        let points = [[0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [1.0, -1.0, -1.0]];
        let points = points.map(DVec3::from).to_vec();
        let boundary = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(points, &Parametrization::Uniform, boundary).unwrap();
        let (criteria, tolerances) = (Criteria::ALL, Tolerances::default());
        let local = BatchChecker::new(&polygon, criteria, tolerances);
        let (mut batch, mut required) =
            (SegmentBatch::default(), [Requirements::default(); SegmentBatch::ROOM]);
        batch.load(&polygon, 0..3);
        local.requirements(&batch, &mut required);
        let place = batch.own().start + 1;
        assert_eq!(
            required[place].criteria(),
            [Criterion::Inflection, Criterion::Turning, Criterion::Torsion].into_iter().collect()
        );

        // ω(1) is (−1, 3, 0)/16 for these legs.
        let (mut first, mut last) = (VectorLanes::default(), VectorLanes::default());
        first.set(place, DVec3::new(0.25, -0.25, 0.0));
        last.set(place, DVec3::new(0.375, 0.125, -0.25));
        let mut violations = Vec::new();
        local.unproved(&batch, &required, [&first, &last], &mut violations);
        let found = violations.iter().find(|(i, _)| *i == 1).map(|f| f.1).unwrap();
        assert!(
            found.intersects(Violations::INFLECTION_AT_END)
                && !found.intersects(Violations::INFLECTION_AT_START)
        );
    }
}
