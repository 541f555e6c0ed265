// SPDX-License-Identifier: MIT OR Apache-2.0

//! The one way to a root that is known to lie in an interval.

/// Evaluations after which the best place so far is the answer: any bracket of f64 is used up before.
const STEPS: u32 = 2048;

/// The root of a continuous function in an interval at whose ends it has different signs.
///
/// `f` gives the value and the slope at a place, or [`f64::NAN`] as the slope where that is not known. `ends` is the
/// interval, `values` are those of `f` there (which is not asked for them again), and `start` is the first place that is
/// looked at: a guess, or anything outside of the interval for the secant's.
///
/// # Method
/// The interval shrinks with every step and keeps its change of sign, so the root is never lost.
/// - With slopes: Newton's step from the last place, if it stays inside and is at most half the step before last; else the
///   middle of the interval (*rtsafe*; Press et al., *Numerical Recipes*, 3rd ed. 2007, § 9.4). So Newton's method converges
///   as fast as it can, and where it crawls, at a root of the slope, halving takes over.
/// - Without: the secant through the ends by the Illinois rule, which halves the value at an end that stays (Dowell and
///   Jarratt 1971, [doi:10.1007/BF01934364](https://doi.org/10.1007/BF01934364)): of order 1.44. Every fourth step halves
///   the interval.
///
/// Where the interval is not negative, halving means: halving how many floating-point numbers are in it (with slopes every
/// fourth time), so that a root of 1e−300 is found in [0, 1] in some 100 steps, and never is 2048 the end.
///
/// # Result
/// The first place with `|f| ≤ tolerance`; or the end of a Newton step of at most `resolution` times the distance to the
/// nearer end of the whole interval, at which `f` was not evaluated any more; or the best place that was looked at, once the
/// interval is that part of its larger end, or holds no other number. With tolerance and resolution zero: as near as f64
/// comes. With different signs at the ends there is such a place; with equal ones the result is some place of the interval,
/// and a value that is NaN ends the search there.
///
/// # Example
/// ```
/// use shapespline_polynomial::bracketed_root;
///
/// let cube = |t: f64| (t * t * t - 0.1, 3.0 * t * t);
/// let root = bracketed_root(cube, [0.0, 1.0], [-0.1, 0.9], 0.5, [0.0, f64::EPSILON]);
/// assert!((root - 0.1f64.cbrt()).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn bracketed_root(
    mut f: impl FnMut(f64) -> (f64, f64),
    ends: [f64; 2],
    values: [f64; 2],
    start: f64,
    [tolerance, resolution]: [f64; 2],
) -> f64 {
    let ([mut lo, mut hi], [mut f_lo, mut f_hi]) = (ends, values);
    let mut best = if f_lo.abs() < f_hi.abs() { (lo, f_lo.abs()) } else { (hi, f_hi.abs()) };
    let secant = |lo: f64, hi: f64, [f_lo, f_hi]: [f64; 2]| lo + (hi - lo) * (f_lo / (f_lo - f_hi));
    let mut t = if start > lo && start < hi { start } else { secant(lo, hi, values) };
    if !(t > lo && t < hi) {
        t = 0.5 * lo + 0.5 * hi;
    }
    // The last two steps; which end moved last; how often the interval was halved.
    let (mut steps, mut moved, mut halvings) = ([hi - lo; 2], 0, 0);
    for k in 0..STEPS {
        let (value, slope) = f(t);
        if value.abs() < best.1 {
            best = (t, value.abs());
        }
        // Written so that a NaN ends it.
        if !(value.abs() > tolerance) {
            return t;
        }
        if (value < 0.0) == (f_lo < 0.0) {
            (lo, f_lo) = (t, value);
            f_hi *= if moved < 0 { 0.5 } else { 1.0 };
            moved = -1;
        } else {
            (hi, f_hi) = (t, value);
            f_lo *= if moved > 0 { 0.5 } else { 1.0 };
            moved = 1;
        }
        let has_slope = !slope.is_nan();
        let next = if has_slope { t - value / slope } else { secant(lo, hi, [f_lo, f_hi]) };
        // Steps of a few units in the last place are the end, however they compare.
        let last = 4.0 * f64::EPSILON * t.abs();
        let slow = if has_slope { (next - t).abs() > last.max(0.5 * steps[0]) } else { k % 4 == 3 };
        let next = if next > lo && next < hi && !slow {
            next
        } else {
            halvings += 1;
            if lo >= 0.0 && (!has_slope || halvings % 4 == 0) {
                f64::from_bits(lo.to_bits() + (hi.to_bits() - lo.to_bits()) / 2)
            } else {
                0.5 * lo + 0.5 * hi
            }
        };
        if !(next > lo && next < hi) || hi - lo <= resolution * hi.abs().max(lo.abs()) {
            break;
        }
        let step = (next - t).abs();
        if has_slope && step <= resolution * (next - ends[0]).min(ends[1] - next) {
            return next;
        }
        (steps, t) = ([steps[1], step], next);
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The root in `[0, end]`, and how many evaluations it took.
    fn found(f: impl Fn(f64) -> (f64, f64), end: f64, slopes: bool, start: f64) -> (f64, u32) {
        let mut count = 0;
        let counted = |t: f64| {
            count += 1;
            let (value, slope) = f(t);
            (value, if slopes { slope } else { f64::NAN })
        };
        let values = [f(0.0).0, f(end).0];
        let root = bracketed_root(counted, [0.0, end], values, start, [0.0, 1e-16]);
        (root, count)
    }

    proptest! {
        #[test]
        fn planted_roots_come_back(root in 0.001..0.999f64, power in 0..4i32, start in -1.0..2.0f64, falls: bool) {
            // t^(2p+1) about the root: flat, and flatter.
            let n = 2 * power + 1;
            let sign = if falls { -1.0 } else { 1.0 };
            let f = |t: f64| (sign * (t - root).powi(n), sign * f64::from(n) * (t - root).powi(n - 1));
            for slopes in [true, false] {
                let (t, count) = found(f, 1.0, slopes, start);
                prop_assert!((t - root).abs() < 1e-15, "{} {} {} {}", t, root, n, slopes);
                prop_assert!(count < 260, "{} evaluations", count);
            }
        }

        #[test]
        fn roots_of_any_size_come_back_whatever_the_interval(exponent in -300..300i32, wide in 0..300i32) {
            let root = 10f64.powi(exponent);
            let end = 10f64.powi((exponent + wide).min(307)) * 2.0;
            let f = |t: f64| ((t / root).ln_1p() - 2f64.ln(), 1.0 / (root + t));
            for slopes in [true, false] {
                let (t, count) = found(f, end, slopes, 0.5 * end);
                prop_assert!((t / root - 1.0).abs() < 1e-14, "{} {} {}", t, root, slopes);
                prop_assert!(count < 400, "{} evaluations of {} in {}", count, root, end);
            }
        }
    }

    /// Newton's speed where Newton's method works.
    #[test]
    fn smooth_functions_take_few_steps() {
        let f = |t: f64| (t.exp() - 1.5, t.exp());
        assert!(found(f, 1.0, true, f64::NAN).1 <= 5);
        assert!(found(f, 1.0, false, f64::NAN).1 <= 11);
        let mean = |slopes| {
            let cubic = |c: f64| move |t: f64| (t * t * t + t - c, 3.0 * t * t + 1.0);
            (1..200)
                .map(|k| found(cubic(f64::from(k) / 100.0), 1.0, slopes, f64::NAN).1)
                .sum::<u32>()
                / 199
        };
        assert!(mean(true) <= 7 && mean(false) <= 11, "{} {}", mean(true), mean(false));
    }

    #[test]
    fn what_is_no_bracket_ends() {
        let nan = bracketed_root(|_| (f64::NAN, 1.0), [0.0, 1.0], [-1.0, 1.0], 0.3, [0.0; 2]);
        assert_eq!(nan, 0.3);
        let none = bracketed_root(|_| (1.0, 0.0), [0.0, 1.0], [1.0, 1.0], 0.3, [0.0; 2]);
        assert!((0.0..=1.0).contains(&none));
        let flat = bracketed_root(|_| (1.0, f64::NAN), [-1.0, 1.0], [-1.0, 1.0], 0.3, [0.0; 2]);
        assert!((-1.0..=1.0).contains(&flat));
    }
}
