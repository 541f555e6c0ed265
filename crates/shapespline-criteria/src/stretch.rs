// SPDX-License-Identifier: MIT OR Apache-2.0

//! The checker of one stretch of a polygon after another: for methods that are local, and for a look
//! at a curve of which nothing has to be kept.

use std::ops::Range;

use shapespline_geometry::{DVec3, DataPolygon, Lanes, Stretch};

use crate::{
    Calls, Criteria, Criterion, Faults, Tolerances, WindowChecker,
    faults::{Cones, Situation, doubtful, faults},
    regular::leads_along,
    rounding::{Coarse, Lean, leg_error, sum},
};

/// The shape criteria of a polygon, asked stretch by stretch: to the bit what a
/// [`Checker`](crate::Checker) finds, with nothing kept in memory that grows with the polygon.
#[derive(Debug, Clone, Copy)]
pub struct StretchChecker<'a> {
    polygon: &'a DataPolygon,
    tolerances: Tolerances,
    wanted: Calls,
}

/// What the segments of a stretch call for, by place.
pub type StretchCalls = [Calls; Stretch::ROOM];

impl<'a> StretchChecker<'a> {
    /// Some criteria, asked of a polygon. Cost O(N) at most, to find out whether it is planar.
    #[must_use]
    pub fn new(polygon: &'a DataPolygon, criteria: Criteria, tolerances: Tolerances) -> Self {
        let planar = Calls::is_planar(polygon, &tolerances);
        Self { polygon, tolerances, wanted: Calls::wanted(criteria, planar) }
    }

    /// What the segments of a stretch call for, except at its first and its last two places.
    pub fn calls(&self, stretch: &Stretch, calls: &mut StretchCalls) {
        Calls::of_stretch(self.polygon, stretch, self.wanted, &self.tolerances, calls);
    }

    /// What each segment of the polygon calls for. Cost O(N), on all threads for long polygons.
    pub(crate) fn all_calls(&self) -> Vec<Calls> {
        Calls::among(self.polygon, &self.tolerances, self.wanted)
    }

    /// How many of a stretch's own segments each criterion applies to.
    #[must_use]
    pub fn applicable(stretch: &Stretch, calls: &StretchCalls) -> [usize; Criterion::COUNT] {
        Calls::count(&calls[stretch.own()])
    }

    /// Adds those of a stretch's own segments that are not proved to keep the shape with the end legs
    /// `first, last`.
    pub fn faults(
        &self,
        stretch: &Stretch,
        calls: &StretchCalls,
        legs: [&Lanes; 2],
        found: &mut Vec<(usize, Faults)>,
    ) {
        self.faults_among(stretch.own(), stretch, calls, legs, found);
    }

    /// These criteria, for those who ask of many segments and come back to the same ones.
    #[must_use]
    pub fn in_windows(&self) -> WindowChecker<'a> {
        WindowChecker::new(*self, None)
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

    /// Adds the segments at some of a stretch's own places that are not proved to keep the shape with the
    /// end legs `first, last`.
    pub(crate) fn faults_among(
        &self,
        places: Range<usize>,
        stretch: &Stretch,
        calls: &StretchCalls,
        [first, last]: [&Lanes; 2],
        found: &mut Vec<(usize, Faults)>,
    ) {
        let (chords, binormals) = (stretch.chords(), stretch.binormals());
        // Where sizes are not ordinary every segment is decided by itself.
        let mut doubts = [1; Stretch::ROOM];
        let mut any = 1;
        if stretch.is_ordinary() {
            any = 0;
            let far = stretch.far();
            let end = places.end.min(stretch.less(Stretch::BESIDE));
            let (lengths, sines) = (stretch.lengths(), stretch.sines());
            // ‖v‖₁ is at most √3 times the length.
            const ROOT: f64 = 1.7321;
            for j in places.start - Stretch::BESIDE..end - Stretch::BESIDE {
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
                let s = Situation::of_scaled([a, c], chords.get(j + 3), around, slack);
                let turns = [
                    ROOT * sines[j + 1],
                    ROOT * sines[j + 2],
                    ROOT * sines[j + 3],
                    ROOT * sines[j + 4],
                ];
                let bounds = Coarse::new(size, slack, turns);
                doubts[j + 3] = doubtful(&s, bounds, calls[j + 3].bits());
                any |= doubts[j + 3];
            }
        }
        if any == 0 {
            return;
        }
        let stops = |j: usize| !leads_along([first.get(j), last.get(j)], chords.get(j));
        let regular = Calls::of(Criterion::Regular).bits();
        let doubted = |&j: &usize| match doubts[j] {
            0 => false,
            // Beside straight runs, and at natural ends, nothing else is left open.
            open => open & !regular != 0 || stops(j),
        };
        for j in places.filter(doubted) {
            let legs = [first.get(j), last.get(j)];
            let faults = self.faults_at(stretch, calls[j], legs, j, Lean::Against);
            if !faults.is_empty() {
                found.push((stretch.segment(self.polygon, j), faults));
            }
        }
    }

    /// What fails on the segment at one of a stretch's own places, doubts being counted as `lean` says.
    pub(crate) fn faults_at(
        &self,
        stretch: &Stretch,
        calls: Calls,
        legs: [DVec3; 2],
        j: usize,
        lean: Lean,
    ) -> Faults {
        if calls.is_empty() {
            return Faults::default();
        }
        let segment = stretch.segment(self.polygon, j);
        let binormals = stretch.binormals();
        let around =
            [binormals.get(j - 2), binormals.get(j - 1), binormals.get(j), binormals.get(j + 1)];
        let (chord, far) = (stretch.chords().get(j), far(self.polygon, segment));
        let s = Situation::new(legs, chord, around, far);
        faults(&s, calls, lean, || {
            let around = [j - 1, j, j + 1].map(|j| stretch.directions().get(j));
            Cones::new(self.polygon, segment, around, calls, &self.tolerances)
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
        let n = Stretch::OWN;
        let mut failed = Faults::default();
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
            let (criteria, tolerances) = (Criteria::EVERY, Tolerances::default());
            let checker = Checker::new(&polygon, criteria, tolerances);
            let local = StretchChecker::new(&polygon, criteria, tolerances);
            let (mut stretch, mut calls) = (Stretch::default(), [Calls::default(); Stretch::ROOM]);
            stretch.load(&polygon, 0..n);
            local.calls(&stretch, &mut calls);
            assert_eq!(&calls[stretch.own()], checker.calls());
            // One criterion alone is asked for where it is among all of them.
            for criterion in Criterion::ALL {
                let one = Criteria::NONE.with(criterion);
                let alone = Checker::new(&polygon, one, tolerances);
                let of = |checker: &Checker<'_>| -> Vec<Calls> {
                    checker.calls().iter().map(|calls| calls.only(one)).collect()
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
                let (mut first, mut last) = (Lanes::default(), Lanes::default());
                for (i, j) in stretch.own().enumerate() {
                    let [a, c] = legs(i);
                    first.set(j, a);
                    last.set(j, c);
                }
                let mut faults = Vec::new();
                local.faults(&stretch, &calls, [&first, &last], &mut faults);
                let alone = (0..n).map(|i| (i, checker.faults(i, legs(i))));
                assert!(alone.filter(|fault| !fault.1.is_empty()).eq(faults.iter().copied()));
                assert_eq!(faults, checker.all_faults(legs));
                assert_eq!(
                    (faults.clone(), checker.applicable(0..n)),
                    local.in_windows().look(legs)
                );
                failed = faults.iter().fold(failed, |all, &(_, faults)| all.and(faults));
            }
        }
        for criterion in Criterion::ALL {
            assert!(failed.any(Faults::of(criterion)), "{criterion}");
        }
    }

    /// A binormal at a right angle, to the last bit, to the one that it has to oppose is a fault here as
    /// well: no doubt may be lost because a product is zero and not positive.
    #[test]
    fn a_product_of_zero_is_a_fault() {
        // Binormal vectors along (0, 0, 1) and (0, 1, −1): the second segment inflects.
        let points = [[0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [1.0, -1.0, -1.0]];
        let points = points.map(DVec3::from).to_vec();
        let boundary = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(points, &Parametrization::Uniform, boundary).unwrap();
        let (criteria, tolerances) = (Criteria::EVERY, Tolerances::default());
        let local = StretchChecker::new(&polygon, criteria, tolerances);
        let (mut stretch, mut calls) = (Stretch::default(), [Calls::default(); Stretch::ROOM]);
        stretch.load(&polygon, 0..3);
        local.calls(&stretch, &mut calls);
        let place = stretch.own().start + 1;
        assert_eq!(
            calls[place].criteria(),
            [Criterion::Inflection, Criterion::Turning, Criterion::Torsion].into_iter().collect()
        );

        // ω(1) is (−1, 3, 0)/16 for these legs.
        let (mut first, mut last) = (Lanes::default(), Lanes::default());
        first.set(place, DVec3::new(0.25, -0.25, 0.0));
        last.set(place, DVec3::new(0.375, 0.125, -0.25));
        let mut faults = Vec::new();
        local.faults(&stretch, &calls, [&first, &last], &mut faults);
        let found = faults.iter().find(|(i, _)| *i == 1).map(|f| f.1).unwrap();
        assert!(found.any(Faults::INFLECTION_AT_END) && !found.any(Faults::INFLECTION_AT_START));
    }
}
