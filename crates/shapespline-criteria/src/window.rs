//! The checker of one window of a curve after another, for searches that come back to the same places.

use std::ops::Range;

use rayon::prelude::*;
use shapespline_geometry::{DVec3, DataPolygon, Lanes, Stretch};

use crate::{Calls, Checker, Faults, StretchCalls, Tolerances, stretch::faults_of_stretch};

/// Windows that are kept: a change of tension is felt over some 60 segments, in two windows or three.
const KEPT: usize = 4;

/// Segments are checked in parallel in blocks of this many.
pub(crate) const BLOCK: usize = 4096;

/// A [`Checker`] that asks of many segments at once, and keeps what it read of the polygon last.
/// Verdicts are to the bit those of [`Checker::faults`].
#[derive(Debug, Clone)]
pub struct WindowChecker<'c, 'p> {
    checker: &'c Checker<'p>,
    kept: [Option<Box<Window>>; KEPT],
}

impl<'c, 'p> WindowChecker<'c, 'p> {
    pub(crate) fn new(checker: &'c Checker<'p>) -> Self {
        Self { checker, kept: Default::default() }
    }

    /// As [`Checker::all_faults`].
    pub fn all_faults<L>(&mut self, legs: L) -> Vec<(usize, Faults)>
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        let n = self.checker.calls().len();
        let mut found = Vec::new();
        if n < 2 * BLOCK {
            self.faults(0..n, legs, &mut found);
            return found;
        }
        let block = |windows: &mut WindowChecker<'_, '_>, k: usize| {
            let mut found = Vec::new();
            windows.faults(k * BLOCK..n.min((k + 1) * BLOCK), &legs, &mut found);
            found
        };
        let blocks = (0..n.div_ceil(BLOCK)).into_par_iter();
        blocks.map_init(|| Self::new(self.checker), block).flatten_iter().collect()
    }

    /// Adds those of some segments that fail with the end legs that `legs` says, ascending.
    pub fn faults(
        &mut self,
        segments: Range<usize>,
        legs: impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Faults)>,
    ) {
        for part in parts(segments) {
            self.faults_of_part(part, &legs, found);
        }
    }

    /// The first of some segments that fails; windows after it are not looked at.
    pub fn any_fault(
        &mut self,
        segments: Range<usize>,
        legs: impl Fn(usize) -> [DVec3; 2],
    ) -> Option<usize> {
        let mut found = Vec::new();
        parts(segments).find_map(|part| {
            self.faults_of_part(part, &legs, &mut found);
            found.first().map(|fault| fault.0)
        })
    }

    fn faults_of_part(
        &mut self,
        part: Range<usize>,
        legs: &impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Faults)>,
    ) {
        let (checker, number) = (self.checker, part.start / Stretch::OWN);
        let window = self.kept[number % KEPT].get_or_insert_with(Box::default);
        if window.number != number {
            let own = window.load(checker.polygon(), number);
            window.calls[window.stretch.own()].copy_from_slice(&checker.calls()[own]);
        }
        window.faults(checker.polygon(), &checker.tolerances(), part, legs, found);
    }
}

/// As many segments of a polygon as a stretch has, from a multiple of that number on, with what they
/// call for and the end legs of a curve.
#[derive(Debug, Clone)]
pub(crate) struct Window {
    number: usize,
    pub(crate) stretch: Stretch,
    pub(crate) calls: StretchCalls,
    first: Lanes,
    last: Lanes,
}

impl Default for Window {
    /// A window on nothing yet.
    fn default() -> Self {
        Self {
            number: usize::MAX,
            stretch: Stretch::default(),
            calls: [Calls::default(); Stretch::ROOM],
            first: Lanes::default(),
            last: Lanes::default(),
        }
    }
}

impl Window {
    /// Reads the window of a number, all but what it calls for. Returns its segments.
    pub(crate) fn load(&mut self, polygon: &DataPolygon, number: usize) -> Range<usize> {
        let start = number * Stretch::OWN;
        let own = start..polygon.segments().min(start + Stretch::OWN);
        self.number = number;
        self.stretch.load(polygon, own.clone());
        own
    }

    /// Adds those of some segments in the window that fail with the end legs that `legs` says.
    pub(crate) fn faults(
        &mut self,
        polygon: &DataPolygon,
        tolerances: &Tolerances,
        segments: Range<usize>,
        legs: &impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Faults)>,
    ) {
        let Self { number, stretch, calls, first, last } = self;
        let place = |segment: usize| segment + Stretch::BESIDE - *number * Stretch::OWN;
        let places = place(segments.start)..place(segments.end);
        for (i, j) in segments.zip(places.clone()) {
            let [a, c] = legs(i);
            first.set(j, a);
            last.set(j, c);
        }
        faults_of_stretch(polygon, tolerances, stretch, calls, [first, last], places, found);
    }
}

/// The parts of some segments that lie in one window each.
pub(crate) fn parts(segments: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let Range { start, end } = segments;
    let windows = start / Stretch::OWN..end.div_ceil(Stretch::OWN);
    windows.map(move |k| {
        let own = k * Stretch::OWN..(k + 1) * Stretch::OWN;
        own.start.max(start)..own.end.min(end)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::{Criteria, StretchChecker};

    /// Whatever windows were kept before, and wherever ranges begin and end.
    #[test]
    fn windows_judge_as_the_checker_does() {
        // Long enough for all threads, and for windows that take each other's places.
        let n = 2 * BLOCK + 77;
        let at = |k: usize| {
            let t = k as f64;
            let bend = if k / 9 % 4 == 1 { 0.0 } else { (0.7 * t).sin() };
            DVec3::new(t, bend, (1.3 * t).sin())
        };
        let points = (0..=n).map(at).collect();
        let boundary = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
        let (criteria, tolerances) = (Criteria::EVERY, Tolerances::default());
        let checker = Checker::new(&polygon, criteria, tolerances);
        let mut windows = checker.in_windows();
        for scale in [0.1, 0.4, 1.0] {
            let slope = |node: usize| {
                let [before, after] = polygon.directions_at(node);
                (before + after + DVec3::Z * 0.3) * (0.4 * scale)
            };
            let legs = |i: usize| [slope(i), slope(i + 1)];
            let alone = |segments: Range<usize>| -> Vec<(usize, Faults)> {
                let faults = segments.map(|i| (i, checker.faults(i, legs(i))));
                faults.filter(|fault| !fault.1.is_empty()).collect()
            };
            let all = alone(0..n);
            assert!(all.len() > n / 50 && all.len() < n);
            assert_eq!(windows.all_faults(legs), all);
            assert_eq!(checker.all_faults(legs), all);
            let (found, applicable) =
                StretchChecker::new(&polygon, criteria, tolerances).look(legs);
            assert_eq!((found, applicable), (all, checker.applicable(0..n)));
            for (start, length) in
                [(0, 1), (63, 1), (60, 10), (700, 200), (3, 61), (n - 1, 1), (5, 0)]
            {
                let segments = start..start + length;
                let (expected, mut found) = (alone(segments.clone()), Vec::new());
                windows.faults(segments.clone(), legs, &mut found);
                assert_eq!(found, expected);
                let any = windows.any_fault(segments, legs);
                assert_eq!(any, expected.first().map(|fault| fault.0));
            }
        }
    }
}
