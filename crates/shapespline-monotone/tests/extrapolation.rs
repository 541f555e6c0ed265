// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a function is outside its data: every mode, on either side, in values, derivatives, integrals and inverses.
#![allow(clippy::unwrap_used)]
mod common;

use common::{Rng, fits, monotone};
use shapespline_monotone::*;

const MODES: [Continuation; 7] = [
    Continuation::Polynomial,
    Continuation::Nan,
    Continuation::Zero,
    Continuation::Taylor(0),
    Continuation::Taylor(1),
    Continuation::Taylor(3),
    Continuation::Periodic(0),
];

/// Data in every direction, with flats and turns, with few points and many, at several scales.
fn data_sets() -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut rng = Rng::new(31);
    let mut sets = vec![
        (vec![0.0, 1.0], vec![-1.0, 1.0]),
        (vec![0.0, 1.0, 3.0], vec![2.0, 2.0, 5.0]),
        (vec![-2.0, 0.0, 1.0, 2.5], vec![1.0, 3.0, 0.0, 1.0]),
        (vec![-5.0, -1.0, 0.5, 4.0], vec![4.0, 2.0, 2.0, -7.0]),
    ];
    for case in 0..12 {
        let n = 2 + rng.index(9);
        let (mut x, mut y) = monotone(&mut rng, n, 1.0, f64::from(case % 3), 0.2);
        let (sx, sy) = [(1.0, 1.0), (1e-100, 1e60), (1e120, -1e-130)][case as usize % 3];
        x.iter_mut().for_each(|x| *x *= sx);
        y.iter_mut().for_each(|y| *y *= sy);
        sets.push((x, y));
    }
    sets
}

fn same(a: f64, b: f64, room: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= room
}

/// Each side is what it is alone, whatever the other is; a query says the same as the object.
#[test]
fn sides_are_independent() {
    for (x, y) in data_sets() {
        let (first, last) = (x[0], x[x.len() - 1]);
        let length = last - first;
        for below in MODES {
            for above in MODES {
                let pair = Extrapolation { below, above };
                for (f, plain) in fits(&x, &y, pair).iter().zip(fits(&x, &y, Extrapolation::NAN)) {
                    for step in [1e-9, 0.3, 1.0, 7.7] {
                        for nu in 0..7 {
                            let (low, high) = (first - step * length, last + step * length);
                            let ask =
                                |x, mode: Continuation| plain.evaluate(x, nu, Some(mode.into()));
                            let (a, b) = (f.evaluate(low, nu, None), ask(low, below));
                            assert!(same(a, b, 0.0), "{pair:?} {nu}: {a} {b}");
                            let (a, b) = (f.evaluate(high, nu, None), ask(high, above));
                            assert!(same(a, b, 0.0), "{pair:?} {nu}: {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

/// The default: monotone wherever the data are, C¹ at the ends, and a straight line beyond.
#[test]
fn by_default_monotone_everywhere() {
    let mut rng = Rng::new(4);
    for case in 0..40 {
        let n = 2 + rng.index(20);
        let (x, mut y) = monotone(&mut rng, n, 3.0, (case % 7) as f64, 0.2);
        let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
        y.iter_mut().for_each(|y| *y *= sign);
        let length = x[n - 1] - x[0];
        for f in fits(&x, &y, Extrapolation::default()) {
            let slopes = f.slopes();
            for (end, outward) in [(0, -1.0), (n - 1, 1.0)] {
                let mut last = y[end];
                for k in 1..100 {
                    let at = x[end] + outward * length * 1.1f64.powi(k - 50);
                    let value = f.value(at);
                    assert!(
                        sign * outward * (value - last) >= 0.0,
                        "case {case}: it turns at {at}"
                    );
                    let line = y[end] + slopes[end] * (at - x[end]);
                    assert!((value - line).abs() <= 1e-14 * (value.abs() + line.abs()));
                    assert_eq!(
                        (f.evaluate(at, 1, None), f.evaluate(at, 2, None)),
                        (slopes[end], 0.0)
                    );
                    last = value;
                }
                assert_eq!(f.evaluate(x[end], 1, None), slopes[end]);
            }
        }
    }
}

/// One rule for all families and functions made of them: NaN gives NaN, ±∞ the limit, and there is one unless the function
/// repeats or is not defined outside. What is finite and far away goes the same way.
#[test]
fn nan_and_infinity() {
    for (x, y) in data_sets() {
        let n = x.len() - 1;
        for mode in MODES {
            for f in fits(&x, &y, mode.into()) {
                let slopes = f.slopes();
                for (end, outward) in [(0, -1.0), (n, 1.0)] {
                    for nu in 0..8 {
                        assert!(f.evaluate(f64::NAN, nu, None).is_nan());
                        assert!(f.derivative(1).evaluate(f64::NAN, nu, None).is_nan());
                    }
                    let limit = f.value(outward * f64::INFINITY);
                    let none = matches!(mode, Continuation::Nan | Continuation::Periodic(_));
                    assert_eq!(limit.is_nan(), none, "{mode:?}: {limit}");
                    match mode {
                        Continuation::Zero => assert_eq!(limit, 0.0),
                        Continuation::Taylor(0) => assert_eq!(limit, y[end]),
                        Continuation::Taylor(1) if slopes[end] == 0.0 => assert_eq!(limit, y[end]),
                        Continuation::Taylor(1) => {
                            assert_eq!(limit, slopes[end].signum() * outward * f64::INFINITY);
                        }
                        _ => {}
                    }
                    for nu in 0..8 {
                        let at = |x| f.evaluate(x, nu, None);
                        let infinite = at(outward * f64::INFINITY);
                        assert_eq!(infinite.is_nan(), none, "{mode:?} {nu}: {infinite}");
                        let far = at(outward * f64::MAX);
                        assert_eq!(far.is_nan(), mode == Continuation::Nan, "{mode:?} {nu}: {far}");
                        if !none && infinite.is_infinite() {
                            assert!(far * infinite > 0.0, "{mode:?} {nu}: {far} {infinite}");
                        }
                    }
                    let other = if end == 0 { x[n] } else { x[0] };
                    for g in [f.antiderivative(1), f.derivative(1)] {
                        assert!(g.integrate(f64::NAN, 0.0, None).is_nan());
                        let over = g.integrate(other, outward * f64::INFINITY, None);
                        assert!(none || !over.is_nan(), "{mode:?}: {over}");
                    }
                }
                assert!(f.integrate(x[0], f64::NAN, None).is_nan());
                assert_eq!(f.integrate(f64::INFINITY, f64::INFINITY, None), 0.0);
            }
        }
    }
}

/// Derivatives and antiderivatives continue what they are made of; integrals are differences of antiderivatives.
#[test]
fn calculus_goes_along() {
    for (x, y) in data_sets() {
        let (first, last) = (x[0], x[x.len() - 1]);
        let length = last - first;
        let size = y.iter().fold(0.0f64, |size, y| size.max(y.abs()));
        let shortest = x.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let rough = 1.0 + length / shortest;
        let places: Vec<f64> =
            [-2.7, -1.0, -0.01, 0.2, 1.0, 1.3, 3.9].map(|t| first + t * length).into();
        for below in MODES {
            for above in [Continuation::Taylor(1), Continuation::Periodic(0), below] {
                for f in fits(&x, &y, Extrapolation { below, above }) {
                    let slope = f.derivative(1);
                    let area = f.antiderivative(1);
                    let back = f.antiderivative(3).derivative(3);
                    // What end polynomials make of rounding, outside.
                    let grown = |x: f64, power: i32| {
                        let out = (first - x).max(x - last).max(0.0) / shortest;
                        size * (1.0 + out).powi(power)
                    };
                    for &at in &places {
                        let (a, b) = (slope.evaluate(at, 0, None), f.evaluate(at, 1, None));
                        assert!(same(a, b, 1e-13 * b.abs()), "{below:?}: {a} {b}");
                        let (a, b) = (area.evaluate(at, 1, None), f.value(at));
                        assert!(same(a, b, 1e-13 * grown(at, 5) * rough), "{below:?}: {a} {b}");
                        // Three integrations and derivatives cost (length/h)³ of the digits.
                        let (a, room) = (back.evaluate(at, 0, None), 1e-11 * rough.powi(3));
                        assert!(same(a, b, room * grown(at, 5)), "{below:?} at {at}: {a} {b}");
                        for &from in places.iter().filter(|from| **from != at) {
                            let a = f.integrate(from, at, None);
                            let b = area.evaluate(at, 0, None) - area.evaluate(from, 0, None);
                            let room = 1e-13 * length * grown(at, 6).max(grown(from, 6));
                            assert!(same(a, b, room), "{below:?} {from} {at}: {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

/// A repeating function, its antiderivatives across many periods, and integrals over them.
#[test]
fn what_repeats() {
    let x = [0.25, 1.0, 1.5, 3.0, 4.25];
    let y = [1.0, 3.0, 2.0, -1.5, 1.0];
    let period = 4.0;
    for f in fits(&x, &y, Extrapolation::PERIODIC) {
        for k in [-1000.0, -3.0, -1.0, 1.0, 2.0, 1e6] {
            for t in [0.0625, 0.125, 1.5, 2.75, 3.875] {
                for nu in 0..4 {
                    let (a, b) = (
                        f.evaluate(0.25 + t + k * period, nu, None),
                        f.evaluate(0.25 + t, nu, None),
                    );
                    assert_eq!(a, b);
                }
            }
        }
        let whole = f.integrate(0.25, 4.25, None);
        let part = f.integrate(1.0, 3.5, None);
        for k in [-250.0, -1.0, 1.0, 4000.0] {
            let a = f.integrate(1.0, 3.5 + k * period, None);
            assert!((a - (part + k * whole)).abs() <= 1e-12 * k.abs() * whole.abs(), "{a}");
            let again = f.antiderivative(1).integrate(0.25, 0.25 + k * period, None);
            let twice = f.antiderivative(2);
            let b = twice.evaluate(0.25 + k * period, 0, None);
            assert!((again - b).abs() <= 1e-11 * b.abs(), "{again} {b}");
        }
        // Smooth across the seams: an antiderivative of order m has m − 1 derivatives there.
        for order in 1..5 {
            let g = f.antiderivative(order);
            for k in [-7.0, -1.0, 0.0, 1.0, 5.0] {
                let seam = 0.25 + k * period;
                for nu in 0..order {
                    let (a, b) =
                        (g.evaluate(seam - 1e-9, nu, None), g.evaluate(seam + 1e-9, nu, None));
                    let size = 1e3 + a.abs() + b.abs();
                    assert!((a - b).abs() <= 1e-8 * size, "{order} {nu} at {seam}: {a} {b}");
                }
            }
        }
        // Solutions are those on the knots.
        assert_eq!(f.solve(0.5, None), f.solve(0.5, Some(Extrapolation::NAN)));
    }
}

/// The inverse undoes the function wherever that has one, on either side.
#[test]
fn inverse_outside() {
    let mut rng = Rng::new(77);
    for case in 0..30 {
        let n = 2 + rng.index(12);
        let (x, mut y) = monotone(&mut rng, n, 1.0, 1.0, 0.0);
        if case % 2 == 1 {
            y.iter_mut().for_each(|y| *y = -*y);
        }
        let rise = y[n - 1] - y[0];
        for below in MODES {
            for above in MODES {
                for f in fits(&x, &y, Extrapolation { below, above }) {
                    let slopes = f.slopes();
                    for (level, mode, end) in
                        [(y[0] - 0.7 * rise, below, 0), (y[n - 1] + 0.7 * rise, above, n - 1)]
                    {
                        let found = f.inverse(level).unwrap();
                        let many = f.inverse_many(&[level; 3]).unwrap();
                        assert!(many.iter().all(|x| same(*x, found, 0.0)));
                        match mode {
                            Continuation::Taylor(0) => assert_eq!(found, x[end]),
                            Continuation::Taylor(1) if slopes[end] != 0.0 => {
                                assert!(
                                    (f.value(found) - level).abs() <= 1e-13 * level.abs().max(1.0)
                                );
                                assert!(
                                    f.solve(level, None).contains(&found) || {
                                        let all = f.solve(level, None);
                                        all.iter().any(|x| (x - found).abs() <= 1e-14 * found.abs())
                                    }
                                );
                            }
                            _ => assert!(found.is_nan(), "{mode:?}: {found}"),
                        }
                    }
                    assert!(f.inverse(f64::NAN).unwrap().is_nan());
                }
            }
        }
    }
}

/// Slopes and second derivatives that leave the range of double precision in the data's units do not spoil what stays in it.
#[test]
fn wide_scales() {
    let x = [0.0, 1.0, 2.5, 4.0, 7.0];
    let y = [0.0, 1.0, 1.5, 4.0, 4.25];
    let plain = fits(&x, &y, Extrapolation::LINEAR);
    for (sx, sy) in [
        (2f64.powi(990), 1.0),
        (2f64.powi(900), 2f64.powi(-200)),
        (2f64.powi(990), 2f64.powi(-990)),
    ] {
        let scaled = |v: &[f64], s: f64| v.iter().map(|v| v * s).collect::<Vec<_>>();
        let (wide_x, wide_y) = (scaled(&x, sx), scaled(&y, sy));
        for (f, g) in plain.iter().zip(fits(&wide_x, &wide_y, Extrapolation::LINEAR)) {
            assert_eq!(scaled(&f.bernstein_coefficients(), sy), g.bernstein_coefficients());
            for t in [-3.0, -0.1, 0.3, 1.0, 3.3, 6.9, 8.0] {
                for mode in
                    [Extrapolation::LINEAR, Extrapolation::POLYNOMIAL, Extrapolation::PERIODIC]
                {
                    let a = f.evaluate(t, 0, Some(mode)) * sy;
                    assert_eq!(a, g.evaluate(t * sx, 0, Some(mode)), "{t} {mode:?}");
                }
            }
            assert_eq!(f.inverse(3.0).unwrap() * sx, g.inverse(3.0 * sy).unwrap());
            assert_eq!(f.inverse(-3.0).unwrap() * sx, g.inverse(-3.0 * sy).unwrap());
            for level in [-2.0, 0.3, 1.2, 5.0] {
                let mode = Some(Extrapolation::POLYNOMIAL);
                let (a, b) = (f.solve(level, mode), g.solve(level * sy, mode));
                assert_eq!(a.len(), b.len());
                assert!(
                    a.iter().zip(&b).all(|(a, b)| (a * sx - b).abs() <= 1e-14 * b.abs()),
                    "{a:?} {b:?}"
                );
            }
            if sy * sx <= 1e300 {
                assert_eq!(
                    f.integrate(-1.0, 8.0, None) * sx * sy,
                    g.integrate(-sx, 8.0 * sx, None)
                );
            }
        }
    }
}
