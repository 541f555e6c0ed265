// SPDX-License-Identifier: MIT OR Apache-2.0

//! Finding the segment of a parameter.
//!
//! Finding it costs more than evaluating the cubic there, so three ways serve three uses: a binary
//! search for one parameter, the segment before (or the next) for sorted ones, a bucket table for
//! many unsorted ones.

/// Which of the two segments that meet at a knot stands for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// The segment that ends at the knot.
    Left,
    /// The segment that begins at the knot.
    #[default]
    Right,
}

/// Segment of `u` by binary search; the end segments stand for everything outside. Cost O(log N).
#[inline]
#[must_use]
pub(crate) fn search(knots: &[f64], u: f64, side: Side) -> usize {
    let inner = &knots[1..knots.len() - 1];
    match side {
        Side::Right => inner.partition_point(|&k| k <= u),
        Side::Left => inner.partition_point(|&k| k < u),
    }
}

/// Bucket table over the knots: the segment of a parameter in O(1) for knots that are spread evenly,
/// never worse than O(log N).
#[derive(Debug, Clone)]
pub(crate) struct Locator {
    start: f64,
    buckets_per_unit: f64,
    /// `first[b]` is the segment that holds the left end of bucket `b`; one more entry closes it.
    first: Vec<u32>,
}

impl Locator {
    /// Table for strictly increasing knots (at least two). Cost and memory O(N), four bytes a bucket.
    /// `None` when a table cannot serve: more than `u32::MAX` segments, or a width that overflows.
    #[must_use]
    pub(crate) fn new(knots: &[f64]) -> Option<Self> {
        let segments = knots.len() - 1;
        let (start, width) = (knots[0], knots[segments] - knots[0]);
        let buckets = segments;
        let buckets_per_unit = buckets as f64 / width;
        if u32::try_from(segments).is_err() || !buckets_per_unit.is_normal() {
            return None;
        }
        let mut first = Vec::with_capacity(buckets + 2);
        // Filled by the very rounding that a query uses, so that no query can land before its bucket.
        for (i, &knot) in knots[1..segments].iter().enumerate() {
            let bucket = ((knot - start) * buckets_per_unit) as usize;
            while first.len() <= bucket {
                first.push(i as u32);
            }
        }
        while first.len() < buckets + 2 {
            first.push(segments as u32 - 1);
        }
        Some(Self { start, buckets_per_unit, first })
    }

    /// Segment of `u`, where `knots` are those the table was made for.
    #[inline]
    #[must_use]
    pub(crate) fn segment(&self, knots: &[f64], u: f64) -> usize {
        // A negative or NaN product becomes bucket 0.
        let bucket = ((u - self.start) * self.buckets_per_unit) as usize;
        let bucket = bucket.min(self.first.len() - 2);
        let (low, high) = (self.first[bucket] as usize, self.first[bucket + 1] as usize);
        if high - low <= 4 {
            let mut segment = low;
            while segment < high && knots[segment + 1] <= u {
                segment += 1;
            }
            segment
        } else {
            low + knots[low + 1..=high].partition_point(|&k| k <= u)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_way_finds_the_same_segment(
            spacings in prop::collection::vec(prop_oneof![0.1..1.0f64, 1e-9..1e-6f64, 1e3..1e6f64], 1..60),
            offset in -1e3..1e3f64,
            fractions in prop::collection::vec(-0.1..1.1f64, 1..30),
        ) {
            let mut knots = vec![offset];
            for h in spacings {
                let last = *knots.last().unwrap();
                if last + h > last { knots.push(last + h); }
            }
            prop_assume!(knots.len() > 1);
            let table = Locator::new(&knots).unwrap();
            let width = knots[knots.len() - 1] - knots[0];
            let queries = fractions.iter().map(|f| knots[0] + f * width).chain(knots.iter().copied());
            for u in queries {
                let expected = knots[1..knots.len() - 1].iter().filter(|&&k| k <= u).count();
                prop_assert_eq!(search(&knots, u, Side::Right), expected);
                prop_assert_eq!(table.segment(&knots, u), expected);
            }
        }
    }
}
