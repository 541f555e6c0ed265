// SPDX-License-Identifier: MIT OR Apache-2.0

//! Adaptive quadrature of positive functions that may peak at the ends of the interval.

/// Nodes and weights of the seven-point Gauss–Lobatto rule on `[−1, 1]`: the ends belong to it, so
/// that a peak at an end cannot hide beyond the last node.
const LOBATTO: [(f64, f64); 4] = [
    (0.0, 0.487_619_047_619_047_6),
    (0.468_848_793_470_714_2, 0.431_745_381_209_862_6),
    (0.830_223_896_278_567, 0.276_826_047_361_565_9),
    (1.0, 0.047_619_047_619_047_616),
];

/// Deepest subdivision: a peak narrower than `2^{−60}` of the interval is not resolved.
const DEPTH: u32 = 60;

/// Relative errors below this that halving does not make smaller are rounding.
const ROUNDING: f64 = 1e-6;

/// The most parts of one integral: of a function that is mostly rounding no number of parts would do.
const PARTS: u32 = 1 << 14;

/// The integral over `[from, to]` of a function that is nowhere negative, to about `accuracy` of
/// itself. A part is halved until its halves agree with it to `accuracy` of their sum, or to
/// `negligible`, which has to exceed what rounding does to the integral: of a function that is zero to
/// rounding no accuracy is to be had. Infinite where the function is infinite at an end.
pub(crate) fn integrate(
    f: &impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
    accuracy: f64,
    negligible: f64,
) -> f64 {
    let whole = rule(f, from, to);
    let absolute = negligible.max(1e-3 * accuracy * whole);
    let mut parts = PARTS;
    refine(f, [from, to], [whole, f64::INFINITY], [accuracy, absolute], (DEPTH, &mut parts))
}

fn rule(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let [(_, centre), pairs @ ..] = LOBATTO;
    let pair = |(x, w): (f64, f64)| {
        // The ends themselves, not what rounding makes of them.
        let ends = if x == 1.0 { [from, to] } else { [middle - half * x, middle + half * x] };
        w * (f(ends[0]) + f(ends[1]))
    };
    half * (centre * f(middle) + pairs.into_iter().map(pair).sum::<f64>())
}

fn refine(
    f: &impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
    [whole, before]: [f64; 2],
    accuracy: [f64; 2],
    (depth, parts): (u32, &mut u32),
) -> f64 {
    let middle = 0.5 * (from + to);
    let (left, right) = (rule(f, from, middle), rule(f, middle, to));
    let sum = left + right;
    let (error, [relative, absolute]) = ((sum - whole).abs(), accuracy);
    let is_rounding = error < ROUNDING * sum && error > 0.25 * before;
    // Written so that a NaN or an infinity ends it.
    if depth == 0 || *parts == 0 || is_rounding || !(error > f64::max(relative * sum, absolute)) {
        return sum;
    }
    *parts -= 1;
    refine(f, [from, middle], [left, error], accuracy, (depth - 1, &mut *parts))
        + refine(f, [middle, to], [right, error], accuracy, (depth - 1, parts))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_narrow_peaks_are_integrated() {
        let polynomial = integrate(&|x: f64| 1.0 + 5.0 * x.powi(4), [0.0, 2.0], 1e-13, 0.0);
        assert!((polynomial - 34.0).abs() < 1e-11);
        // ∫₀¹ w/(x² + w²) dx = atan(1/w), with the peak at an end.
        for width in [1.0, 1e-2, 1e-5, 1e-9] {
            for (from, to) in [(0.0, 1.0), (-1.0, 0.0)] {
                let f = |x: f64| width / (x * x + width * width);
                let found = integrate(&f, [from, to], 1e-12, 0.0);
                let exact = (1.0 / width).atan();
                assert!((found - exact).abs() < 1e-10 * exact, "{width}: {found} {exact}");
            }
        }
        assert_eq!(integrate(&|x: f64| 1.0 / x, [0.0, 1.0], 1e-12, 0.0), f64::INFINITY);
    }

    /// Without a limit these take 2⁶⁰ parts.
    #[test]
    fn what_is_mostly_rounding_ends() {
        for noise in [1e-9, 1e-3, 1.0] {
            let calls = std::cell::Cell::new(0);
            let f = |x: f64| {
                calls.set(calls.get() + 1);
                1.0 + noise * ((x * 1e15).to_bits() % 1024) as f64 / 1024.0
            };
            let found = integrate(&f, [0.0, 1.0], 1e-12, 0.0);
            assert!(found >= 1.0 && found <= 1.0 + noise, "{noise}: {found}");
            assert!(calls.get() < 1_000_000, "{noise}: {}", calls.get());
        }
    }
}
