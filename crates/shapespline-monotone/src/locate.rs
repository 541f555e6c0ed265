//! Finding the segment of a query: a table of equal buckets over the knots, built at the first large request.

use std::sync::OnceLock;

/// Knots from which a table pays; below it a binary search stays in the first cache lines.
const SMALL: usize = 24;

/// Finds segments among increasing knots. O(1) expected on knots that are not too uneven, O(log N) at worst.
#[derive(Debug, Default)]
pub(crate) struct Locator {
    table: OnceLock<Option<Table>>,
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
    scale: f64,
}

impl Table {
    fn new(x: &[f64]) -> Option<Self> {
        let n = x.len() - 1;
        if n < SMALL || n > u32::MAX as usize - 2 {
            return None;
        }
        let scale = n as f64 / (x[n] - x[0]);
        if !scale.is_finite() || scale == 0.0 {
            return None;
        }
        let mut start = vec![0u32; n + 2];
        let bucket = |v: f64| (((v - x[0]) * scale) as usize).min(n);
        let mut b = 0;
        for (i, &knot) in x[..n].iter().enumerate() {
            let own = bucket(knot);
            // Buckets up to the knot's own see only earlier segments.
            while b <= own {
                start[b] = i.saturating_sub(1) as u32;
                b += 1;
            }
        }
        start[b..].fill(n as u32 - 1);
        Some(Self { start, scale })
    }
}

impl Locator {
    /// A searcher; with `many` the table is built if it is not there yet.
    pub(crate) fn searcher<'a>(&'a self, x: &'a [f64], many: bool) -> Searcher<'a> {
        let table = if many {
            self.table.get_or_init(|| Table::new(x)).as_ref()
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
        let x = self.x;
        let (mut lo, mut hi) = match self.table {
            Some(table) => {
                // A negative or NaN product casts to 0, one beyond the range saturates.
                let b = (((v - x[0]) * table.scale) as usize).min(table.start.len() - 2);
                (table.start[b] as usize, table.start[b + 1] as usize + 1)
            }
            None => (0, x.len() - 2),
        };
        // Invariant: the segment is in lo..=hi.
        hi = hi.min(x.len() - 2);
        if hi - lo <= 8 {
            while lo < hi && v >= x[lo + 1] {
                lo += 1;
            }
            return lo;
        }
        while lo < hi {
            let mid = (lo + hi).div_ceil(2);
            if v >= x[mid] {
                lo = mid;
            } else {
                hi = mid - 1;
            }
        }
        lo
    }

    /// As [`Self::find`], looking at and after `hint` first: sorted queries cost a comparison or two.
    #[inline]
    pub(crate) fn find_near(&self, v: f64, hint: usize) -> usize {
        let x = self.x;
        if v >= x[hint] {
            if v < x[hint + 1] {
                return hint;
            }
            if hint + 2 < x.len() && v < x[hint + 2] {
                return hint + 1;
            }
        }
        self.find(v)
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
                        hint = search.find_near(v, hint);
                        assert_eq!(hint, expected);
                    }
                    assert_eq!(search.find(f64::NAN), 0);
                    assert_eq!(search.find(f64::INFINITY), n - 1);
                    assert_eq!(search.find(f64::NEG_INFINITY), 0);
                }
            }
        }
    }
}
