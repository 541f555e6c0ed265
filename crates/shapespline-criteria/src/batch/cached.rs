// SPDX-License-Identifier: MIT OR Apache-2.0

//! The checker that caches windows of the polygon, for searches that check the same segments again.

use std::{cell::Cell, ops::Range};

use shapespline_geometry::{
    DVec3, DataPolygon,
    batch::{SegmentBatch, VectorLanes},
};
use shapespline_polynomial::parallel;

use super::{BatchChecker, BatchRequirements};
use crate::{Criterion, Requirements, Violations, rounding::Lean};

/// Windows that are kept: a change of tension is felt over some 60 segments, in two windows or three.
const KEPT: usize = 4;

/// Segments are checked in parallel in blocks of this many.
pub(crate) const BLOCK: usize = 4096;

/// The shape criteria of a polygon, for callers that check the same segments again and again: the parts
/// of the polygon that were read last are cached. Verdicts are to the bit those of
/// [`Checker::unproved`](crate::Checker::unproved).
#[derive(Debug, Clone)]
pub struct CachedChecker<'a> {
    local: BatchChecker<'a>,
    /// What each segment requires, if the caller knows already.
    required: Option<&'a [Requirements]>,
    kept: [Option<Box<Window>>; KEPT],
    /// Scratch.
    found: Vec<(usize, Violations)>,
}

thread_local! {
    /// Windows for the next curve of this thread: to make one costs what checking a short curve does.
    static SPARE: Cell<Vec<Box<Window>>> = const { Cell::new(Vec::new()) };
}

impl Drop for CachedChecker<'_> {
    fn drop(&mut self) {
        let kept = self.kept.iter_mut().filter_map(Option::take);
        // A thread that ends keeps nothing.
        let _ = SPARE.try_with(|spare| {
            let mut windows = spare.take();
            windows.extend(kept);
            windows.truncate(KEPT);
            spare.set(windows);
        });
    }
}

/// A window on nothing yet.
fn new_window() -> Box<Window> {
    let used = SPARE.try_with(|spare| {
        let mut windows = spare.take();
        let window = windows.pop();
        spare.set(windows);
        window
    });
    let mut window = used.ok().flatten().unwrap_or_default();
    window.number = usize::MAX;
    window
}

impl<'a> CachedChecker<'a> {
    pub(crate) fn new(local: BatchChecker<'a>, required: Option<&'a [Requirements]>) -> Self {
        Self { local, required, kept: Default::default(), found: Vec::new() }
    }

    /// The same criteria, nothing kept yet: for another thread.
    #[must_use]
    pub fn another(&self) -> Self {
        Self::new(self.local, self.required)
    }

    /// The polygon.
    #[must_use]
    pub fn polygon(&self) -> &'a DataPolygon {
        self.local.polygon()
    }

    /// The segments that are not proved to keep the shape, ascending. Cost O(N), on all threads for long
    /// curves.
    pub fn all_unproved<L>(&mut self, legs: L) -> Vec<(usize, Violations)>
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        let unproved = |windows: &mut Self, segments: Range<usize>, found: &mut Vec<_>| {
            windows.unproved(segments, &legs, found);
        };
        self.in_blocks(unproved, |all, found| all.extend(found))
    }

    /// The same, and how many segments each criterion applies to: all that a report on a curve without
    /// violations says. Cost O(N), on all threads for long curves.
    pub fn scan<L>(&mut self, legs: L) -> (Vec<(usize, Violations)>, [usize; Criterion::COUNT])
    where
        L: Fn(usize) -> [DVec3; 2] + Sync,
    {
        type Scanned = (Vec<(usize, Violations)>, [usize; Criterion::COUNT]);
        let scan =
            |windows: &mut Self, segments: Range<usize>, (found, applicable): &mut Scanned| {
                for part in parts(segments) {
                    let window = windows.window(part.start / SegmentBatch::OWN);
                    add(applicable, BatchChecker::applicable(&window.batch, &window.required));
                    windows.unproved_in_part(part, &legs, found);
                }
            };
        self.in_blocks(scan, |(all, sums), (found, applicable)| {
            all.extend(found);
            add(sums, applicable);
        })
    }

    /// What is found in the segments of the polygon, of a long one by blocks on all threads.
    fn in_blocks<T: Default + Send>(
        &mut self,
        find: impl Fn(&mut Self, Range<usize>, &mut T) + Sync,
        join: impl Fn(&mut T, T) + Sync,
    ) -> T {
        let n = self.local.polygon().segments();
        let mut all = T::default();
        if n < 2 * BLOCK {
            find(self, 0..n, &mut all);
            return all;
        }
        let block = |windows: &mut Self, k: usize| {
            let mut found = T::default();
            find(windows, k * BLOCK..n.min((k + 1) * BLOCK), &mut found);
            found
        };
        let blocks: Vec<T> = parallel::map_with(n.div_ceil(BLOCK), 0, || self.another(), block);
        blocks.into_iter().for_each(|found| join(&mut all, found));
        all
    }

    /// Adds those of some segments that are not proved to keep the shape with the end legs that `legs` says,
    /// ascending.
    pub fn unproved(
        &mut self,
        segments: Range<usize>,
        legs: impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Violations)>,
    ) {
        for part in parts(segments) {
            self.unproved_in_part(part, &legs, found);
        }
    }

    /// The first of some segments that is not proved to keep the shape; windows after it are not looked at.
    pub fn first_unproved(
        &mut self,
        segments: Range<usize>,
        legs: impl Fn(usize) -> [DVec3; 2],
    ) -> Option<usize> {
        let mut found = std::mem::take(&mut self.found);
        found.clear();
        let first = parts(segments).find_map(|part| {
            self.unproved_in_part(part, &legs, &mut found);
            found.first().map(|violation| violation.0)
        });
        self.found = found;
        first
    }

    /// What is not proved of one segment with some end legs.
    pub fn unproved_at(&mut self, segment: usize, legs: [DVec3; 2]) -> Violations {
        self.judge(segment, legs, Lean::Against)
    }

    /// What fails on one segment with some end legs as computed: of what is not proved, that which is not
    /// merely lost in rounding.
    pub fn failures_at(&mut self, segment: usize, legs: [DVec3; 2]) -> Violations {
        self.judge(segment, legs, Lean::Even)
    }

    /// What fails on one segment with some end legs, however control points and arithmetic round.
    pub fn violations_at(&mut self, segment: usize, legs: [DVec3; 2]) -> Violations {
        self.judge(segment, legs, Lean::For)
    }

    fn judge(&mut self, segment: usize, legs: [DVec3; 2], lean: Lean) -> Violations {
        let local = self.local;
        let window = self.window(segment / SegmentBatch::OWN);
        let j = segment % SegmentBatch::OWN + SegmentBatch::BESIDE;
        local.violations_at(&window.batch, window.required[j], legs, j, lean)
    }

    fn unproved_in_part(
        &mut self,
        part: Range<usize>,
        legs: &impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Violations)>,
    ) {
        let local = self.local;
        self.window(part.start / SegmentBatch::OWN).unproved(&local, part, legs, found);
    }

    /// The window of a number.
    fn window(&mut self, number: usize) -> &mut Window {
        let window = self.kept[number % KEPT].get_or_insert_with(new_window);
        if window.number != number {
            window.load(&self.local, self.required, number);
        }
        window
    }
}

/// Adds counts to others.
fn add(sums: &mut [usize; Criterion::COUNT], counts: [usize; Criterion::COUNT]) {
    sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
}

/// As many segments of a polygon as a batch has, from a multiple of that number on, with what they
/// require and the end legs of a curve.
#[derive(Debug, Clone)]
struct Window {
    number: usize,
    batch: SegmentBatch,
    required: BatchRequirements,
    first: VectorLanes,
    last: VectorLanes,
}

impl Default for Window {
    /// A window on nothing yet.
    fn default() -> Self {
        Self {
            number: usize::MAX,
            batch: SegmentBatch::default(),
            required: [Requirements::default(); SegmentBatch::ROOM],
            first: VectorLanes::default(),
            last: VectorLanes::default(),
        }
    }
}

impl Window {
    /// Reads the window of a number.
    fn load(&mut self, local: &BatchChecker<'_>, required: Option<&[Requirements]>, number: usize) {
        let start = number * SegmentBatch::OWN;
        let own = start..local.polygon().segments().min(start + SegmentBatch::OWN);
        self.number = number;
        self.batch.load(local.polygon(), own.clone());
        match required {
            Some(required) => self.required[self.batch.own()].copy_from_slice(&required[own]),
            None => local.requirements(&self.batch, &mut self.required),
        }
    }

    /// Adds those of some segments in the window that are not proved to keep the shape with the end legs that
    /// `legs` says.
    fn unproved(
        &mut self,
        local: &BatchChecker<'_>,
        segments: Range<usize>,
        legs: &impl Fn(usize) -> [DVec3; 2],
        found: &mut Vec<(usize, Violations)>,
    ) {
        let Self { number, batch, required, first, last } = self;
        let place = |segment: usize| segment + SegmentBatch::BESIDE - *number * SegmentBatch::OWN;
        let places = place(segments.start)..place(segments.end);
        for (i, j) in segments.zip(places.clone()) {
            let [a, c] = legs(i);
            first.set(j, a);
            last.set(j, c);
        }
        local.unproved_among(places, batch, required, [first, last], found);
    }
}

/// The parts of some segments that lie in one window each.
fn parts(segments: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let Range { start, end } = segments;
    let windows = start / SegmentBatch::OWN..end.div_ceil(SegmentBatch::OWN);
    windows.map(move |k| {
        let own = k * SegmentBatch::OWN..(k + 1) * SegmentBatch::OWN;
        own.start.max(start)..own.end.min(end)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::{Checker, Criteria, Tolerances};

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
        let (criteria, tolerances) = (Criteria::ALL, Tolerances::default());
        let checker = Checker::new(&polygon, criteria, tolerances);
        let mut windows = checker.cached();
        for scale in [0.1, 0.4, 1.0] {
            let slope = |node: usize| {
                let [before, after] = polygon.directions_at(node);
                (before + after + DVec3::Z * 0.3) * (0.4 * scale)
            };
            let legs = |i: usize| [slope(i), slope(i + 1)];
            let alone = |segments: Range<usize>| -> Vec<(usize, Violations)> {
                let violations = segments.map(|i| (i, checker.unproved(i, legs(i))));
                violations.filter(|violation| !violation.1.is_empty()).collect()
            };
            let all = alone(0..n);
            assert!(all.len() > n / 50 && all.len() < n);
            assert_eq!(windows.all_unproved(legs), all);
            assert_eq!(checker.all_unproved(legs), all);
            let local = BatchChecker::new(&polygon, criteria, tolerances);
            let (found, applicable) = local.cached().scan(legs);
            assert_eq!((found, applicable), (all, checker.applicable(0..n)));
            for (start, length) in
                [(0, 1), (63, 1), (60, 10), (700, 200), (3, 61), (n - 1, 1), (5, 0)]
            {
                let segments = start..start + length;
                let (expected, mut found) = (alone(segments.clone()), Vec::new());
                windows.unproved(segments.clone(), legs, &mut found);
                assert_eq!(found, expected);
                let any = windows.first_unproved(segments.clone(), legs);
                assert_eq!(any, expected.first().map(|violation| violation.0));
                for i in segments.clone() {
                    assert_eq!(windows.unproved_at(i, legs(i)), checker.unproved(i, legs(i)));
                }
            }
        }
    }
}
