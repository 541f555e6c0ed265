// SPDX-License-Identifier: MIT OR Apache-2.0

//! Finding the segments of queries: a table of equal buckets over the knots, built at the first large request.

use crate::chunked::TILE;
use once_cell::race::OnceBox;
use std::ops::Range;

/// Knots from which a table pays; below it a binary search stays in the first cache lines.
const SMALL: usize = 8;
/// Knots compared without a branch after the one that the table names: nearly always enough on knots that are not too
/// uneven.
const COMPARED: usize = 3;

/// Finds segments among increasing knots. O(1) expected on knots that are not too uneven, O(log N) at worst.
#[derive(Debug, Default)]
pub(crate) struct Locator {
    table: OnceBox<Option<Table>>,
}

impl Clone for Locator {
    /// The table is rebuilt on demand: cloning must not cost more than the knots.
    fn clone(&self) -> Self {
        Self::default()
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

impl Locator {
    /// A searcher; with `many` the table is built if it is not there yet.
    pub(crate) fn searcher<'a>(&'a self, x: &'a [f64], many: bool) -> Searcher<'a> {
        let table = if many {
            self.table.get_or_init(|| Box::new(Table::new(x))).as_ref()
        } else {
            self.table.get().and_then(Option::as_ref)
        };
        Searcher { x, table }
    }
}

/// A view that finds segments.
#[derive(Clone, Copy)]
pub(crate) struct Searcher<'a> {
    x: &'a [f64],
    table: Option<&'a Table>,
}

impl Searcher<'_> {
    /// The segment i with `x[i] ≤ v < x[i+1]`, the first for v before the knots (and NaN), the last for v after.
    #[inline]
    pub(crate) fn find(&self, v: f64) -> usize {
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

    /// The segments of at most [`TILE`] queries; the places of `out` after the last are left as they are. Where the
    /// table does not help and the queries are `sorted`, each is looked for from the one before on.
    #[inline]
    pub(crate) fn tile(&self, queries: &[f64], sorted: bool, out: &mut [usize; TILE]) {
        let last = self.x.len() - 1;
        let Some(table) = self.table else {
            let mut hint = 0;
            for (i, &v) in out.iter_mut().zip(queries) {
                hint = if sorted { self.near(hint, v) } else { self.find(v) };
                *i = hint;
            }
            return;
        };
        let mut buckets = [0u32; TILE];
        for (b, &v) in buckets.iter_mut().zip(queries) {
            *b = table.bucket(v);
        }
        let mut hint = 0;
        for ((i, &b), &v) in out.iter_mut().zip(&buckets).zip(queries) {
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

    /// Calls `work` with every segment that has some of the sorted queries, and which; false, and nothing called, if
    /// some are outside the knots or they reach over more than `most` segments.
    #[inline(always)]
    pub(crate) fn runs(
        &self,
        queries: &[f64],
        most: usize,
        mut work: impl FnMut(usize, Range<usize>),
    ) -> bool {
        let (x, n) = (self.x, queries.len());
        if n == 0 || !(queries[0] >= x[0] && queries[n - 1] <= x[x.len() - 1]) {
            return false;
        }
        let first = self.find(queries[0]);
        let last = self.near(first, queries[n - 1]);
        if last - first >= most {
            return false;
        }
        let mut from = 0;
        for i in first..=last {
            let run = queries[from..].iter().take_while(|v| i == last || **v < x[i + 1]);
            let to = from + run.count();
            if from < to {
                work(i, from..to);
            }
            from = to;
        }
        true
    }

    /// The segment of v, looked for from `hint` on in steps that double, as sorted queries have it; by search where
    /// it lies before.
    #[inline]
    pub(crate) fn near(&self, hint: usize, v: f64) -> usize {
        let (x, last) = (self.x, self.x.len() - 2);
        if !(v >= x[hint]) {
            return self.find(v);
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

    #[test]
    fn agrees_with_a_linear_search_on_even_and_wild_knots() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for n in [1usize, 2, 5, 30, 200] {
            for decades in [0.0, 3.0, 40.0] {
                let mut x = vec![-1.0f64];
                for _ in 0..n {
                    let last: f64 = x[x.len() - 1];
                    let step = 10f64.powf(decades * (next() - 0.5)).max(last.abs() * 1e-15);
                    x.push(last + step);
                }
                let locator = Locator::default();
                for many in [false, true] {
                    let search = locator.searcher(&x, many);
                    let mut hint = 0;
                    for k in 0..2000 {
                        let v = if k % 2 == 0 {
                            x[(next() * x.len() as f64) as usize]
                        } else {
                            x[0] + (x[n] - x[0]) * (1.2 * next() - 0.1)
                        };
                        let expected = x[1..n].iter().take_while(|knot| v >= **knot).count();
                        assert_eq!(search.find(v), expected, "n {n} v {v}");
                        hint = search.near(hint, v);
                        assert_eq!(hint, expected);
                    }
                    // Tiles, sorted and not, ends and NaN among them.
                    for sorted in [false, true] {
                        let mut q: Vec<f64> = (0..TILE - 3)
                            .map(|k| {
                                if k % 2 == 0 {
                                    x[(next() * x.len() as f64) as usize]
                                } else {
                                    x[0] + (x[n] - x[0]) * (1.2 * next() - 0.1)
                                }
                            })
                            .collect();
                        q.extend([f64::NEG_INFINITY, f64::INFINITY]);
                        if sorted {
                            q.sort_by(f64::total_cmp);
                        } else {
                            q.push(f64::NAN);
                        }
                        let mut out = [0; TILE];
                        search.tile(&q, sorted, &mut out);
                        for (&v, &i) in q.iter().zip(&out) {
                            assert_eq!(i, search.find(v), "n {n} v {v} sorted {sorted}");
                        }
                    }
                    assert_eq!(search.find(f64::NAN), 0);
                    assert_eq!(search.find(f64::INFINITY), n - 1);
                    assert_eq!(search.find(f64::NEG_INFINITY), 0);
                }
            }
        }
    }
}
