// SPDX-License-Identifier: MIT OR Apache-2.0

//! Finding the segment of a place among increasing knots.
//!
//! Finding it can cost more than what is done there, so three ways serve three uses: a binary search for one place, the
//! segment of the place before (or the next) for sorted ones, a table of equal buckets for many unsorted ones.

use std::ops::Range;

use once_cell::race::OnceBox;

/// Segments from which a table pays; below it a binary search stays in the first cache lines.
const SMALL: usize = 8;

/// Knots compared without a branch after the one that the table names: nearly always enough on knots that are not too
/// uneven.
const COMPARED: usize = 3;

/// Knots that the search from a segment on looks at together.
const AHEAD: usize = 4;

/// The segment that begins at or before `v` by binary search; the end segments stand for everything outside, the first for
/// NaN. There are at least two knots. O(log N).
#[inline]
#[must_use]
pub fn from_right(knots: &[f64], v: f64) -> usize {
    knots[1..knots.len() - 1].partition_point(|&k| k <= v)
}

/// The same, but of a knot the segment that ends there.
#[inline]
#[must_use]
pub fn from_left(knots: &[f64], v: f64) -> usize {
    knots[1..knots.len() - 1].partition_point(|&k| k < v)
}

/// What finds segments among knots that it is shown: the table of buckets, made at the first request that pays for it.
///
/// It is published atomically, without a lock that a forked process could inherit.
#[derive(Debug, Default)]
pub struct Locator {
    table: OnceBox<Option<Table>>,
}

impl Clone for Locator {
    /// The table is made again on demand: cloning must not cost more than the knots.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Locator {
    /// A view of the knots, always the same, at least two; with `many` the table is made if it is not there yet. O(N) the
    /// first time, four bytes a knot.
    #[inline]
    pub fn searcher<'a>(&'a self, knots: &'a [f64], many: bool) -> Searcher<'a> {
        let table = if many {
            self.table.get_or_init(|| Box::new(Table::new(knots))).as_ref()
        } else {
            self.table.get().and_then(Option::as_ref)
        };
        Searcher { x: knots, table }
    }
}

#[derive(Debug)]
struct Table {
    /// `start[b]`: the last segment that begins in a bucket before b (0 if none).
    start: Vec<u32>,
    origin: f64,
    scale: f64,
    last: f64,
}

impl Table {
    fn new(x: &[f64]) -> Option<Self> {
        let n = x.len() - 1;
        if n < SMALL || n > u32::MAX as usize / 2 {
            return None;
        }
        let scale = n as f64 / (x[n] - x[0]);
        if !scale.is_finite() || scale == 0.0 {
            return None;
        }
        let mut table = Self { start: vec![0u32; n + 2], origin: x[0], scale, last: n as f64 };
        let mut b = 0;
        for (i, &knot) in x[..n].iter().enumerate() {
            let own = table.bucket(knot) as usize;
            // Buckets up to the knot's own see only earlier segments.
            while b <= own {
                table.start[b] = i.saturating_sub(1) as u32;
                b += 1;
            }
        }
        table.start[b..].fill(n as u32 - 1);
        Some(table)
    }

    /// The bucket of a place, from 0 to n; of NaN 0. All that matters is that it does not fall as v grows.
    #[inline(always)]
    fn bucket(&self, v: f64) -> u32 {
        /// Adding it leaves the nearest integer in the lowest bits: conversions have no such fast form.
        const MAGIC: f64 = 4_503_599_627_370_496.0;
        let p = (v - self.origin) * self.scale;
        let p = if p > 0.0 { p } else { 0.0 };
        let p = if p < self.last { p } else { self.last };
        (p + MAGIC).to_bits() as u32
    }
}

/// A view of knots that finds segments.
#[derive(Debug, Clone, Copy)]
pub struct Searcher<'a> {
    x: &'a [f64],
    table: Option<&'a Table>,
}

impl Searcher<'_> {
    /// The segment i with `x[i] ≤ v < x[i+1]`, the first for v before the knots (and NaN), the last for v after. With the
    /// table O(1) on knots that are not too uneven, O(log N) at worst.
    #[inline]
    #[must_use]
    pub fn find(&self, v: f64) -> usize {
        match self.table {
            Some(table) => {
                let b = table.bucket(v) as usize;
                self.within(table.start[b] as usize, table.start[b + 1] as usize, v)
            }
            None => self.within(0, self.x.len() - 2, v),
        }
    }

    /// [`Self::find`] where the segment is known to be in `lo..=hi`.
    #[inline]
    fn within(&self, mut lo: usize, hi: usize, v: f64) -> usize {
        let mut count = hi - lo + 1;
        while count > 1 {
            let half = count / 2;
            // A selection, not a branch: which way it goes cannot be predicted.
            lo = if v >= self.x[lo + half] { lo + half } else { lo };
            count -= half;
        }
        lo
    }

    /// The segments of at most `TILE` places, for many are found faster together; the entries of `out` after the last are
    /// left as they are. Where the table does not help and the places are `sorted`, each is looked for from the one before
    /// on.
    #[inline]
    pub fn tile<const TILE: usize>(&self, places: &[f64], sorted: bool, out: &mut [usize; TILE]) {
        let last = self.x.len() - 1;
        let Some(table) = self.table else {
            let mut hint = 0;
            for (i, &v) in out.iter_mut().zip(places) {
                hint = if sorted { self.near(hint, v) } else { self.find(v) };
                *i = hint;
            }
            return;
        };
        let mut buckets = [0u32; TILE];
        for (b, &v) in buckets.iter_mut().zip(places) {
            *b = table.bucket(v);
        }
        let mut hint = 0;
        for ((i, &b), &v) in out.iter_mut().zip(&buckets).zip(places) {
            let lo = table.start[b as usize] as usize;
            let mut passed = 0;
            for k in 1..=COMPARED {
                passed += usize::from(v >= self.x[(lo + k).min(last)]);
            }
            *i = (lo + passed).min(last - 1);
            if passed == COMPARED {
                let hi = (table.start[b as usize + 1] as usize).max(*i);
                *i = if sorted && hi - *i > TILE && v >= self.x[hint] {
                    self.near((*i).max(hint), v)
                } else {
                    self.within(*i, hi, v)
                };
            }
            hint = *i;
        }
    }

    /// Calls `work` with every segment that has some of the sorted places, and which; false, and nothing called, if
    /// some are outside the knots or they reach over more than `most` segments.
    #[inline(always)]
    pub fn runs(
        &self,
        places: &[f64],
        most: usize,
        mut work: impl FnMut(usize, Range<usize>),
    ) -> bool {
        let (x, n) = (self.x, places.len());
        if n == 0 || !(places[0] >= x[0] && places[n - 1] <= x[x.len() - 1]) {
            return false;
        }
        let first = self.find(places[0]);
        let last = self.near(first, places[n - 1]);
        if last - first >= most {
            return false;
        }
        let mut from = 0;
        for i in first..=last {
            let run = places[from..].iter().take_while(|v| i == last || **v < x[i + 1]);
            let to = from + run.count();
            if from < to {
                work(i, from..to);
            }
            from = to;
        }
        true
    }

    /// The segment of v, looked for from the segment `hint` on, first in the next few knots and then in steps that double,
    /// as sorted places have it; by [`Self::find`] where it lies before.
    #[inline(always)]
    #[must_use]
    pub fn near(&self, hint: usize, v: f64) -> usize {
        let (x, last) = (self.x, self.x.len() - 2);
        if !(v >= x[hint]) {
            return self.find(v);
        }
        // How many of the next knots lie behind, counted: a branch at each would be a guess.
        if let Some(next) = x.get(hint + 1..=hint + AHEAD) {
            let passed = next.iter().filter(|&&knot| v >= knot).count();
            if passed < AHEAD {
                return hint + passed;
            }
        }
        let (mut lo, mut step) = (hint, 1);
        loop {
            let hi = (lo + step).min(last);
            if hi == lo || v < x[hi] {
                return self.within(lo, hi.max(lo + 1) - 1, v);
            }
            (lo, step) = (hi, 2 * step);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TILE: usize = 64;

    /// Every way finds the segment that counting the knots does, single places, sorted ones and such that are not.
    fn check(knots: &[f64], places: &[f64]) {
        let last = knots.len() - 2;
        let expected = |v: f64| knots[1..=last].iter().take_while(|knot| v >= **knot).count();
        let locator = Locator::default();
        for many in [false, true] {
            let search = locator.searcher(knots, many);
            let mut hint = 0;
            for &v in places {
                assert_eq!(from_right(knots, v), expected(v), "{v}");
                assert_eq!(from_left(knots, v), knots[1..=last].iter().filter(|k| **k < v).count());
                assert_eq!(search.find(v), expected(v), "{v}");
                hint = search.near(hint, v);
                assert_eq!(hint, expected(v), "{v}");
            }
            for sorted in [false, true] {
                let mut places = places.to_vec();
                if sorted {
                    places.retain(|v| !v.is_nan());
                    places.sort_by(f64::total_cmp);
                }
                for tile in places.chunks(TILE) {
                    let mut out = [0; TILE];
                    search.tile(tile, sorted, &mut out);
                    for (&v, &i) in tile.iter().zip(&out) {
                        assert_eq!(i, expected(v), "{v} sorted {sorted}");
                    }
                    let mut seen = 0;
                    let of_run = |i: usize, run: Range<usize>| {
                        assert!(
                            run.start == seen
                                && tile[run.clone()].iter().all(|&v| expected(v) == i)
                        );
                        seen = run.end;
                    };
                    if sorted && search.runs(tile, 1000, of_run) {
                        assert_eq!(seen, tile.len());
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn every_way_finds_the_same_segment(
            spacings in prop::collection::vec(prop_oneof![0.1..1.0f64, 1e-9..1e-6f64, 1e3..1e6f64], 1..60),
            offset in -1e3..1e3f64,
            fractions in prop::collection::vec(-0.1..1.1f64, 1..100),
        ) {
            let mut knots = vec![offset];
            for h in spacings {
                let last = knots[knots.len() - 1];
                if last + h > last { knots.push(last + h); }
            }
            prop_assume!(knots.len() > 1);
            let width = knots[knots.len() - 1] - knots[0];
            let mut places: Vec<f64> = fractions.iter().map(|f| knots[0] + f * width).collect();
            places.extend(&knots);
            places.extend([f64::NEG_INFINITY, f64::NAN, f64::INFINITY]);
            check(&knots, &places);
        }

        #[test]
        fn wild_knots_are_searched(
            steps in prop::collection::vec(-20.0..20.0f64, 1..300),
            fractions in prop::collection::vec(-0.1..1.1f64, 1..300),
        ) {
            let mut knots = vec![-1.0f64];
            for step in steps {
                let last = knots[knots.len() - 1];
                knots.push(last + 10f64.powf(step).max(last.abs() * 1e-15));
            }
            let width = knots[knots.len() - 1] - knots[0];
            let places = fractions.iter().map(|f| knots[0] + f * width);
            let on = fractions.iter().map(|f| knots[(f.clamp(0.0, 0.99) * knots.len() as f64) as usize]);
            check(&knots, &places.chain(on).collect::<Vec<_>>());
        }
    }
}
