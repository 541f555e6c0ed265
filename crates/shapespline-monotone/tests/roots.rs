// SPDX-License-Identifier: MIT OR Apache-2.0

//! Roots and solutions: none is wrong, none is missing, inside the data and beyond.
#![allow(clippy::unwrap_used)]
mod common;

use common::{Rng, fits, monotone};
use shapespline_monotone::*;

const MODES: [Extrapolation; 5] = [
    Extrapolation::POLYNOMIAL,
    Extrapolation::LINEAR,
    Extrapolation::CLIP,
    Extrapolation::NAN,
    Extrapolation::PERIODIC,
];

/// Whether f is the level at x to some ulp of its size, or passes it between the neighbours of x.
fn is_solution(f: impl Fn(f64) -> f64, level: f64, x: f64, size: f64) -> bool {
    let around = [x.next_down(), x, x.next_up()].map(&f);
    let (low, high) = around
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    around.iter().any(|v| (v - level).abs() <= 16.0 * f64::EPSILON * size)
        || low <= level && level <= high
}

/// SciPy's `test_roots` (gh-6357) as a property: a line has one root and no other, in every family and mode; what would be
/// leading coefficients is rounding.
#[test]
fn lines_have_one_root() {
    let mut rng = Rng::new(6357);
    for case in 0..400 {
        let n = 2 + rng.index(6);
        let (mut x, _) = monotone(&mut rng, n, 2.0, 0.0, 0.0);
        let scale = 10f64.powf(8.0 * (rng.next() - 0.5));
        let offset = if case % 3 == 0 { 1e3 * rng.next() } else { 0.0 };
        x.iter_mut().for_each(|x| *x = *x * scale + offset);
        let (slope, root) = (
            10f64.powf(6.0 * (rng.next() - 0.5)),
            x[0] + (x[n - 1] - x[0]) * (3.0 * rng.next() - 1.0),
        );
        let slope = if case % 2 == 0 { slope } else { -slope };
        let y: Vec<f64> = x.iter().map(|x| slope * (x - root)).collect();
        // What the data themselves are off by.
        let length = x[n - 1] - x[0];
        let room = 1e-12 * (length + offset + (root - x[0]).abs());
        let inside = root >= x[0] && root <= x[n - 1];
        for f in fits(&x, &y, Extrapolation::default()) {
            for mode in MODES {
                let beyond = mode == Extrapolation::POLYNOMIAL || mode == Extrapolation::LINEAR;
                let near_end = (root - x[0]).abs() <= room || (root - x[n - 1]).abs() <= room;
                for found in [f.roots(Some(mode)), f.to_piecewise().roots(Some(mode))] {
                    if near_end && !beyond {
                        continue;
                    }
                    let expected = usize::from(inside || beyond);
                    assert_eq!(found.len(), expected, "case {case} {mode:?}: {found:?}, {root}");
                    for x in found {
                        assert!((x - root).abs() <= room, "case {case} {mode:?}: {x} {root}");
                    }
                }
            }
        }
    }
    let f = &fits(&[0.0, 1.0], &[-1.0, 1.0], Extrapolation::POLYNOMIAL);
    assert!(f.iter().all(|f| f.roots(None) == [0.5]));
}

/// Quadratics and cubics given by their exact slopes and curvatures: roots beyond the data are planted ones.
#[test]
fn planted_roots_beyond_the_data() {
    let mut rng = Rng::new(9);
    for case in 0..300 {
        // A quartic with shape 1 reproduces quadratics: (x − r)(x + s), rising on x ≥ 0.
        let (r, s) = (3.0 * rng.next() - 1.0, 1.0 + 20.0 * rng.next());
        let (r, s) = (r.max(-s), s);
        let x = [0.0, 0.5, 1.5, 2.0].map(|x| x + (r - s).max(0.0));
        let y = x.map(|x| (x - r) * (x + s));
        let slopes = x.map(|x| 2.0 * x + s - r);
        let options =
            QuarticOptions { slopes: Slopes::Given(slopes.to_vec()), ..QuarticOptions::default() };
        let f = MonotoneQuartic::new(&x, &y, &options).unwrap();
        if f.slopes().iter().zip(&slopes).any(|(a, b)| (a - b).abs() > 1e-12 * b) {
            continue;
        }
        let mut expected = vec![-s, r];
        expected.sort_by(f64::total_cmp);
        let found = f.roots(Some(Extrapolation::POLYNOMIAL));
        if s + r < 1e-3 {
            continue;
        }
        assert_eq!(found.len(), 2, "case {case}: {found:?} {expected:?}");
        for (a, b) in found.iter().zip(&expected) {
            assert!(
                (a - b).abs() <= 1e-10 * (1.0 + b.abs()),
                "case {case}: {found:?} {expected:?}"
            );
        }
    }
}

/// Random functions of every family, their derivatives and antiderivatives, at levels among which are values at knots and
/// extrema: every solution is one, in order and each once, and between dense samples no change of sign is without one.
#[test]
fn solutions_are_right_and_complete() {
    let mut rng = Rng::new(20);
    for case in 0..60 {
        let n = 2 + rng.index(8);
        let (mut x, mut y) = monotone(&mut rng, n, 1.5, (case % 5) as f64, 0.15);
        if case % 2 == 1 {
            y.iter_mut().for_each(|y| *y = (7.0 * *y).sin());
        }
        let (sx, sy, shift) =
            [(1.0, 1.0, 0.0), (1e-90, 1e120, 0.0), (1e80, 1e-100, 0.0), (1.0, 1.0, 1e6)][case % 4];
        x.iter_mut().for_each(|x| *x *= sx);
        y.iter_mut().for_each(|y| *y = *y * sy + shift);
        for f in fits(&x, &y, Extrapolation::POLYNOMIAL) {
            let [slope, bend, area] = [f.derivative(1), f.derivative(2), f.antiderivative(1)];
            for mode in MODES {
                let first = |x: f64| f.evaluate(x, 0, Some(mode));
                for level in levels(&mut rng, &x, first) {
                    check(&x, first, level, &f.solve(level, Some(mode)), mode, "f");
                    let general = f.to_piecewise();
                    let value = |x: f64| general.evaluate(x, 0, Some(mode));
                    check(&x, value, level, &general.solve(level, Some(mode)), mode, "piecewise f");
                }
                for (g, name) in [(&slope, "f'"), (&bend, "f''"), (&area, "F")] {
                    let value = |x: f64| g.evaluate(x, 0, Some(mode));
                    for level in levels(&mut rng, &x, value) {
                        check(&x, value, level, &g.solve(level, Some(mode)), mode, name);
                    }
                }
            }
        }
    }
}

fn levels(rng: &mut Rng, x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    let (a, b) = (x[0], x[x.len() - 1]);
    let mut levels = vec![0.0, f(x[0]), f(x[rng.index(x.len())])];
    levels.extend((0..3).map(|_| f(a + (b - a) * rng.next())));
    levels.extend((0..2).map(|_| f(a + (b - a) * (3.0 * rng.next() - 1.0))));
    levels.retain(|v| v.is_finite());
    levels
}

fn check(
    x: &[f64],
    f: impl Fn(f64) -> f64,
    level: f64,
    found: &[f64],
    mode: Extrapolation,
    name: &str,
) {
    let (a, b) = (x[0], x[x.len() - 1]);
    let length = b - a;
    // The size of f: what it is on the data, and at the place itself.
    let on_data =
        (0..=64).map(|k| f(a + length * f64::from(k) / 64.0).abs()).fold(level.abs(), f64::max);
    let roots: Vec<f64> = found.iter().copied().filter(|x| !x.is_nan()).collect();
    assert!(roots.windows(2).all(|w| w[0] < w[1]), "{name} {mode:?} {level}: {found:?}");
    for &root in &roots {
        let far = ((root - a) / length).abs().max(1.0).powi(6);
        assert!(
            is_solution(&f, level, root, on_data * far),
            "{name} {mode:?} {level} at {root}: {}",
            f(root)
        );
    }
    // No change of sign between samples without a solution, but for jumps at knots (f'' of the quartic) and where it repeats.
    let grid: Vec<f64> = (0..=500)
        .map(|k| a + length * (3.0 * (f64::from(k) + 0.123) / 501.0 - 1.0))
        .filter(|q| mode != Extrapolation::PERIODIC || (a <= *q && *q <= b))
        .collect();
    for w in grid.windows(2) {
        let (low, high) = (f(w[0]) - level, f(w[1]) - level);
        let clear = 64.0 * f64::EPSILON * on_data;
        if low * high < 0.0 && low.abs().min(high.abs()) > clear {
            let jump = name == "f''" && x.iter().any(|knot| w[0] <= *knot && *knot <= w[1]);
            let here = roots.iter().any(|r| w[0] <= *r && *r <= w[1]);
            assert!(here || jump, "{name} {mode:?} {level}: none in {w:?} of {found:?}");
        }
    }
}

/// Flats are reported by their start and NaN, on whatever side a solution touches them.
#[test]
fn flats_as_documented() {
    let (x, y) = ([0.0, 1.0, 2.0, 3.0, 4.0, 6.0], [0.0, 1.0, 1.0, 0.5, 0.5, 3.0]);
    for f in fits(&x, &y, Extrapolation::NAN) {
        for all in [f.solve(1.0, None), f.to_piecewise().solve(1.0, None)] {
            assert_eq!(all[0], 1.0);
            assert!(all[1].is_nan() && all.len() == 3 && all[2] > 4.0 && all[2] < 6.0, "{all:?}");
        }
        for all in [f.solve(0.5, None), f.to_piecewise().solve(0.5, None)] {
            assert!(
                all[0] > 0.0 && all[0] < 1.0 && all[1] == 3.0 && all[2].is_nan() && all.len() == 3,
                "{all:?}"
            );
        }
        // f' is zero on the flats, and at no other place but where they end.
        let all = f.derivative(1).solve(0.0, None);
        assert!(
            all.len() == 4 && all[0] == 1.0 && all[1].is_nan() && all[2] == 3.0 && all[3].is_nan(),
            "{all:?}"
        );
    }
}

/// A derivative of any order, asked for at once or step by step, ends.
#[test]
fn orders_beyond_the_degree() {
    let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 3.0]);
    for f in fits(&x, &y, Extrapolation::LINEAR) {
        let most = usize::MAX;
        assert_eq!(f.derivative(1).evaluate(0.5, 1 << 40, None), 0.0);
        assert_eq!(f.derivative(1).evaluate(7.0, most, None), 0.0);
        assert_eq!(f.derivative(most).evaluate(0.5, 0, None), 0.0);
        assert_eq!(f.derivative(1).derivative(most).evaluate(0.5, most, None), 0.0);
        assert_eq!(f.evaluate(0.5, most, None), 0.0);
        assert!(f.derivative(1).evaluate(7.0, most, Some(Extrapolation::NAN)).is_nan());
    }
}
