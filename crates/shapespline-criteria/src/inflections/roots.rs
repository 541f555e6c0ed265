// SPDX-License-Identifier: MIT OR Apache-2.0

//! The real roots of low-degree polynomials in Bernstein form, none left out.

use shapespline_polynomial::{
    bernstein::{split, value_and_slope},
    bracketed_root,
};

/// Subdivision ends at intervals of `2^{−44}`: what is still open there is a root to rounding.
const DEPTH: u32 = 44;

/// Calls `found(t, width)` for every root of the polynomial on `[0, 1]`, where coefficients
/// carry an error of at most `error`: the root lies within `width` of `t`. An interval where
/// rounding leaves open whether there are roots, and how many, is reported twice. A root that the
/// polynomial does not have may be reported; one that it has is never missed.
pub(super) fn roots<const N: usize>(p: [f64; N], error: f64, found: &mut impl FnMut(f64, f64)) {
    let mut search = Search { error, open: None, found };
    search.isolate(p, [0.0, 1.0], DEPTH);
    search.close();
}

struct Search<'a, F> {
    error: f64,
    /// The open interval that may go on.
    open: Option<[f64; 2]>,
    found: &'a mut F,
}

impl<F: FnMut(f64, f64)> Search<'_, F> {
    fn isolate<const N: usize>(&mut self, p: [f64; N], [from, to]: [f64; 2], depth: u32) {
        let error = self.error;
        let clear = |c: &f64| c.abs() > error;
        let changes = p.windows(2).filter(|c| (c[0] > 0.0) != (c[1] > 0.0)).count();
        if changes == 0 && p.iter().all(clear) {
            return;
        }
        if changes == 1 && clear(&p[0]) && clear(&p[N - 1]) && has_one_change(&p, error) {
            let (t, width) = bracketed(p, error);
            let length = to - from;
            (self.found)(from + t * length, (width * length).max(f64::EPSILON));
        } else if depth == 0 || !p.iter().any(clear) {
            match &mut self.open {
                Some([_, end]) if *end == from => *end = to,
                _ => {
                    self.close();
                    self.open = Some([from, to]);
                }
            }
        } else {
            let middle = 0.5 * (from + to);
            let (left, right) = split(p, 0.5);
            self.isolate(left, [from, middle], depth - 1);
            self.isolate(right, [middle, to], depth - 1);
        }
    }

    fn close(&mut self) {
        if let Some([from, to]) = self.open.take() {
            for _ in 0..2 {
                (self.found)(0.5 * (from + to), 0.5 * (to - from));
            }
        }
    }
}

/// Whether the coefficients, clear and different at the ends, change sign once whatever the signs of
/// those that rounding hides.
fn has_one_change<const N: usize>(p: &[f64; N], error: f64) -> bool {
    let agrees = |c: &f64, end: f64| c.abs() > error && (*c > 0.0) == (end > 0.0);
    let first = p.iter().position(|c| !agrees(c, p[0]));
    let last = p.iter().rposition(|c| !agrees(c, p[N - 1]));
    // Between the clear runs from both ends there is room for one hidden coefficient: + + ? −.
    first.zip(last).is_none_or(|(first, last)| last <= first)
}

/// The root between ends of different sign, and how far rounding leaves it open.
fn bracketed<const N: usize>(p: [f64; N], error: f64) -> (f64, f64) {
    let at = |t: f64| value_and_slope(p, t);
    let limits = [0.25 * error, f64::EPSILON];
    let t = bracketed_root(at, [0.0, 1.0], [p[0], p[N - 1]], f64::NAN, limits);
    let slope = at(t).1;
    // Where the slope exceeds all that the curvature can make of it nearby, it says how far.
    let bend = ((N - 1) * (N - 2) * 4) as f64 * p.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if slope * slope > 16.0 * error * bend {
        return (t, 4.0 * error / slope.abs());
    }
    // Else walk out until the value exceeds the error on either side.
    let mut width = f64::EPSILON;
    while width < 1.0 {
        let outside =
            |t: f64| !(0.0..=1.0).contains(&t) || value_and_slope(p, t).0.abs() > 2.0 * error;
        if outside(t - width) && outside(t + width) {
            break;
        }
        width *= 4.0;
    }
    (t, width)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bernstein coefficients of `∏ (t − r)`, of degree 4.
    fn planted(roots: [f64; 4]) -> [f64; 5] {
        // Polar form: the mean over all ways to put `i` ones and `4 − i` zeros into the factors.
        std::array::from_fn(|i| {
            let ways = (0u32..16).filter(|s| s.count_ones() as usize == i);
            let product =
                |s: u32| (0..4).map(|k| f64::from((s >> k) & 1) - roots[k]).product::<f64>();
            let (n, sum) = ways.fold((0.0, 0.0), |(n, sum), s| (n + 1.0, sum + product(s)));
            sum / n
        })
    }

    proptest! {
        #[test]
        fn planted_roots_are_found(r in proptest::array::uniform4(-1.0..2.0f64)) {
            let mut sorted = [r[0], r[1], r[2], r[3], 0.0, 1.0];
            sorted.sort_by(f64::total_cmp);
            prop_assume!(sorted.windows(2).all(|w| w[1] - w[0] > 1e-4));
            let mut found = Vec::new();
            roots(planted(r), 1e-15, &mut |t, width| found.push((t, width)));
            let inside: Vec<f64> = sorted.into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect();
            prop_assert_eq!(found.len(), inside.len());
            for ((t, width), root) in found.into_iter().zip(inside) {
                prop_assert!((t - root).abs() <= width + 1e-15, "{} {} {}", t, root, width);
                prop_assert!(width < 1e-6);
            }
        }

        #[test]
        fn no_root_of_a_close_pair_is_missed(r in 0.01..0.99f64, gap in 0.0..1e-7f64) {
            let mut found = Vec::new();
            roots(planted([r, r + gap, -1.0, 2.0]), 1e-15, &mut |t, width| found.push((t, width)));
            prop_assert!(found.len() >= 2, "{:?}", found);
            for root in [r, r + gap] {
                prop_assert!(found.iter().any(|(t, width)| (t - root).abs() <= 2.0 * width + 1e-7));
            }
        }
    }

    #[test]
    fn what_vanishes_altogether_is_open_everywhere() {
        let mut found = Vec::new();
        roots([0.0; 3], 1e-15, &mut |t, width| found.push((t, width)));
        assert_eq!(found, [(0.5, 0.5), (0.5, 0.5)]);
        roots([1.0; 3], 1e-15, &mut |_, _| unreachable!());
    }
}
