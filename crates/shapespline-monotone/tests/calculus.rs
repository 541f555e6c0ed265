// SPDX-License-Identifier: MIT OR Apache-2.0

//! Derivatives, integrals, roots, inverse, extrapolation, batches and storage, against independent computations.
#![allow(clippy::unwrap_used)]
mod common;

use common::{Rng, csv, fits, monotone};
use shapespline_monotone::*;

/// Power coefficients of a Bernstein polynomial, by the binomial theorem: an independent evaluation.
fn power(b: &[f64]) -> Vec<f64> {
    let n = b.len() - 1;
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    (0..=n)
        .map(|k| {
            (0..=k)
                .map(|j| {
                    let sign = if (k - j) % 2 == 0 { 1.0 } else { -1.0 };
                    sign * choose(n, k) * choose(k, j) * b[j]
                })
                .sum()
        })
        .collect()
}

fn wavy() -> (Vec<f64>, Vec<f64>) {
    let x: Vec<f64> = (0..15).map(|k| f64::from(k) + 0.3 * f64::from(k * k % 3)).collect();
    let y = x.iter().map(|x| (0.9 * x).sin() * 2.0 - 0.3).collect();
    (x, y)
}

#[test]
fn values_and_derivatives_agree_with_power_form() {
    let (x, y) = wavy();
    for f in fits(&x, &y, Extrapolation::POLYNOMIAL) {
        let m = f.degree() + 1;
        let b = f.bernstein_coefficients();
        for nu in 0..=6 {
            let d = f.derivative(nu);
            for k in 0..300 {
                let at = x[0] - 0.5 + (x[14] - x[0] + 1.0) * f64::from(k) / 299.0;
                let i = x[1..14].iter().take_while(|v| at >= **v).count();
                let (h, t) = (x[i + 1] - x[i], (at - x[i]) / (x[i + 1] - x[i]));
                let p = power(&b[i * m..(i + 1) * m]);
                let mut direct = 0.0;
                for (j, c) in p.iter().enumerate().skip(nu) {
                    let falling: f64 = (j + 1 - nu..=j).map(|v| v as f64).product();
                    direct += c * falling * t.powi((j - nu) as i32);
                }
                direct /= h.powi(nu as i32);
                let size = 1e-12 * 10f64.powi(nu as i32) * (1.0 + direct.abs());
                assert!((f.evaluate(at, nu, None) - direct).abs() < size, "nu {nu} at {at}");
                assert!((d.evaluate(at, 0, None) - direct).abs() < size, "nu {nu} at {at}");
                assert!((f.to_piecewise().evaluate(at, nu, None) - direct).abs() < size);
            }
        }
    }
}

#[test]
fn integrals_agree_with_gauss_quadrature() {
    let (x, y) = wavy();
    let nodes = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    for f in fits(&x, &y, Extrapolation::POLYNOMIAL) {
        let gauss = |a: f64, b: f64| {
            let mut cuts: Vec<f64> = x.iter().copied().filter(|v| *v > a && *v < b).collect();
            cuts.insert(0, a);
            cuts.push(b);
            cuts.windows(2)
                .map(|w| {
                    let (mid, half) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] - w[0]));
                    nodes
                        .iter()
                        .map(|(p, weight)| {
                            let v = if *p == 0.0 {
                                f.value(mid)
                            } else {
                                f.value(mid - half * p) + f.value(mid + half * p)
                            };
                            half * weight * v
                        })
                        .sum::<f64>()
                })
                .sum::<f64>()
        };
        let anti = f.antiderivative(1);
        assert_eq!(anti.evaluate(x[0], 0, None), 0.0);
        for (a, b) in [(0.2, 0.7), (0.0, 3.3), (2.5, 14.0), (-1.0, 1.0), (13.0, 16.0), (-2.0, 17.0)]
        {
            let expected = gauss(a, b);
            let close = |v: f64| {
                assert!((v - expected).abs() < 1e-11 * (1.0 + expected.abs()), "{v} {expected}")
            };
            close(f.integrate(a, b, None));
            close(-f.integrate(b, a, None));
            close(anti.evaluate(b, 0, None) - anti.evaluate(a, 0, None));
        }
        let deep = f.antiderivative(30);
        assert!(deep.evaluate(x[3], 0, None).is_finite() && deep.degree() == f.degree() + 30);
        let back = f.antiderivative(2).derivative(2);
        for k in 0..100 {
            let at = x[0] + (x[14] - x[0]) * f64::from(k) / 99.0;
            assert!((back.evaluate(at, 0, None) - f.value(at)).abs() < 1e-10);
        }
        assert!(f.integrate(-1.0, 1.0, Some(Extrapolation::NAN)).is_nan());
        let clip = f.integrate(-1.0, 0.0, Some(Extrapolation::CLIP));
        assert!((clip - y[0]).abs() < 1e-13);
        let line = f.integrate(-1.0, 0.0, Some(Extrapolation::LINEAR));
        assert!((line - (y[0] - 0.5 * f.slopes()[0])).abs() < 1e-12);
    }
}

#[test]
fn roots_and_solutions() {
    let (x, y) = wavy();
    for f in fits(&x, &y, Extrapolation::POLYNOMIAL) {
        for level in [-0.3, 0.0, 1.1, y[4], -2.29] {
            let inside = f.solve(level, Some(Extrapolation::NAN));
            // Count sign changes on a fine grid: the independent answer.
            let grid: Vec<f64> = (0..=40_000)
                .map(|k| x[0] + (x[14] - x[0]) * (f64::from(k) + 1e-3) / 40_001.0)
                .collect();
            let changes = grid
                .windows(2)
                .filter(|w| (f.value(w[0]) - level) * (f.value(w[1]) - level) < 0.0)
                .count();
            let touching = inside.iter().filter(|s| x.contains(s)).count();
            assert!(
                inside.len() >= changes && inside.len() <= changes + touching,
                "{level}: {inside:?} {changes}"
            );
            for s in f.solve(level, None) {
                assert!((f.value(s) - level).abs() < 1e-11 * (1.0 + s.abs()), "{level}: {s}");
            }
            let general = f.to_piecewise().solve(level, Some(Extrapolation::NAN));
            assert_eq!(general.len(), inside.len(), "{level}: {general:?} {inside:?}");
            for (a, b) in general.iter().zip(&inside) {
                assert!((a - b).abs() < 1e-6);
            }
            let all = f.solve(level, None);
            assert!(all.windows(2).all(|w| w[0] < w[1]), "{all:?}");
            assert_eq!(all.iter().filter(|s| **s >= x[0] && **s <= x[14]).count(), inside.len());
        }
        assert_eq!(f.roots(None), f.solve(0.0, None));
        assert_eq!(f.solve(100.0, Some(Extrapolation::CLIP)), Vec::<f64>::new());
        let far = f.solve(100.0, Some(Extrapolation::LINEAR));
        for s in &far {
            assert!((f.evaluate(*s, 0, Some(Extrapolation::LINEAR)) - 100.0).abs() < 1e-9);
        }
        assert_eq!(
            far.len(),
            2 - f.slopes().iter().step_by(14).filter(|d| **d == 0.0).count().min(2)
                - f.slopes()
                    .iter()
                    .step_by(14)
                    .zip([-1.0, 1.0])
                    .filter(|(d, s)| *d * s < 0.0)
                    .count()
        );
    }
    // A flat piece at the level: its start, then NaN.
    let f = &fits(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0, 1.0, 2.0], Extrapolation::NAN)[1];
    let s = f.solve(1.0, None);
    assert_eq!(s[0], 1.0);
    assert!(s[1].is_nan() && s.len() <= 3, "{s:?}");
}

#[test]
fn inverse_is_exact_to_an_ulp_or_so() {
    let mut rng = Rng::new(5);
    for case in 0..60 {
        let n = 2 + rng.index(50);
        let (x, mut y) = monotone(&mut rng, n, 2.0, (case % 7) as f64, 0.0);
        // Strictly increasing also after rounding.
        for k in 1..n {
            if y[k] <= y[k - 1] {
                y[k] = y[k - 1].next_up();
            }
        }
        if case % 2 == 1 {
            y.iter_mut().for_each(|v| *v = -*v);
        }
        for f in fits(&x, &y, Extrapolation::NAN) {
            let mut queries: Vec<f64> =
                (0..4000).map(|_| y[0] + (y[n - 1] - y[0]) * rng.next()).collect();
            // The second half in order, and equal ones among them: few segments at a time, where neighbours help.
            queries[2000..]
                .sort_by(|a, b| (a * (y[n - 1] - y[0])).total_cmp(&(b * (y[n - 1] - y[0]))));
            queries.copy_within(2500..2516, 2516);
            let mut out = vec![0.0; 4000];
            f.inverse_into(&queries, &mut out).unwrap();
            // In groups that are packed otherwise: what neighbours tell must not show but in the last digits.
            let mut others = vec![0.0; 4000];
            for (q, out) in queries.chunks(37).zip(others.chunks_mut(37)) {
                f.inverse_into(q, out).unwrap();
            }
            let size = y.iter().fold(0.0f64, |a, v| a.max(v.abs()));
            for ((q, s), other) in queries.iter().zip(&out).zip(&others) {
                let r = (f.value(*s) - q).abs();
                // The change of f over the rounding of x, and an ulp or two of y.
                let step =
                    (f.value(s.next_up().min(x[n - 1])) - f.value(s.next_down().max(x[0]))).abs();
                let allowed = 2.0 * step + 4.0 * f64::EPSILON * size;
                assert!(
                    r <= allowed,
                    "case {case} degree {}: residual {r:e}, step {step:e}",
                    f.degree()
                );
                assert!((f.value(*other) - q).abs() <= allowed && *s >= x[0] && *s <= x[n - 1]);
            }
            for (a, b) in x.iter().zip(&y) {
                assert_eq!(f.inverse(*b).unwrap(), *a);
            }
            assert!(f.inverse(f64::NAN).unwrap().is_nan());
            assert!(f.inverse(y[n - 1] + (y[n - 1] - y[0])).unwrap().is_nan());
        }
        let clipped = &fits(&x, &y, Extrapolation::CLIP)[0];
        assert_eq!(clipped.inverse(y[0] - (y[n - 1] - y[0])).unwrap(), x[0]);
    }
    let flat = &fits(&[0.0, 1.0, 2.0], &[0.0, 1.0, 1.0], Extrapolation::NAN)[0];
    assert!(flat.inverse(0.5).unwrap_err().to_string().contains("y[2] = 1"));
}

#[test]
fn extrapolation_modes() {
    let (x, y) = csv("akima.csv");
    for f in fits(&x, &y, Extrapolation::POLYNOMIAL) {
        let end = x.len() - 1;
        for (at, k) in [(-1.0, 0), (17.0, end)] {
            assert!(f.evaluate(at, 0, Some(Extrapolation::NAN)).is_nan());
            assert!(f.evaluate(at, 1, Some(Extrapolation::NAN)).is_nan());
            assert_eq!(f.evaluate(at, 0, Some(Extrapolation::CLIP)), y[k]);
            assert_eq!(f.evaluate(at, 1, Some(Extrapolation::CLIP)), 0.0);
            let line = y[k] + f.slopes()[k] * (at - x[k]);
            assert_eq!(f.evaluate(at, 0, Some(Extrapolation::LINEAR)), line);
            assert_eq!(f.evaluate(at, 1, Some(Extrapolation::LINEAR)), f.slopes()[k]);
            assert_eq!(f.evaluate(at, 2, Some(Extrapolation::LINEAR)), 0.0);
            // The derivative object follows the same modes.
            for mode in [Extrapolation::CLIP, Extrapolation::LINEAR, Extrapolation::NAN] {
                let g = &fits(&x, &y, mode)[1];
                for nu in 0..4 {
                    let (a, b) = (g.derivative(nu).evaluate(at, 0, None), g.evaluate(at, nu, None));
                    assert!(
                        (a - b).abs() < 1e-9 || (a.is_nan() && b.is_nan()),
                        "{mode:?} {nu}: {a} {b}"
                    );
                }
            }
        }
        assert!(f.value(f64::NAN).is_nan());
        assert!(f.evaluate(f64::NAN, 0, Some(Extrapolation::CLIP)).is_nan());
        assert_eq!(f.evaluate(f64::INFINITY, 0, Some(Extrapolation::CLIP)), y[end]);
    }
}

#[test]
fn sorted_unsorted_and_parallel_requests_agree() {
    let mut rng = Rng::new(21);
    let (x, y) = monotone(&mut rng, 3000, 3.0, 3.0, 0.1);
    for f in fits(&x, &y, Extrapolation::LINEAR) {
        let mut q: Vec<f64> =
            (0..100_000).map(|_| x[0] + (x[2999] - x[0]) * (1.1 * rng.next() - 0.05)).collect();
        q[17] = f64::NAN;
        for nu in [0, 1] {
            let one: Vec<f64> = q.iter().map(|q| f.evaluate(*q, nu, None)).collect();
            let mut all = vec![0.0; q.len()];
            f.evaluate_into(&q, nu, None, &mut all);
            assert!(one.iter().zip(&all).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }
}

#[test]
fn batches_are_the_single_fits() {
    let mut rng = Rng::new(8);
    let (x, _) = monotone(&mut rng, 20, 1.0, 0.0, 0.0);
    let columns: Vec<f64> = (0..50).flat_map(|_| monotone(&mut rng, 20, 0.0, 3.0, 0.1).1).collect();
    let options = QuinticOptions::default();
    let many: Vec<MonotoneQuintic> = fit_columns(&x, &columns, &options).unwrap();
    let q = [x[0], x[3] + 0.1, x[19]];
    let values = MonotoneQuintic::evaluate_columns(&many, &q, 0, None);
    for (k, f) in many.iter().enumerate() {
        let single = MonotoneQuintic::new(&x, &columns[20 * k..20 * (k + 1)], &options).unwrap();
        assert_eq!(single.slopes(), f.slopes());
        for (j, at) in q.iter().enumerate() {
            assert_eq!(values[3 * k + j], single.value(*at));
        }
    }
    // Ragged rows with their own x.
    let (a, b) = (monotone(&mut rng, 5, 1.0, 1.0, 0.0), monotone(&mut rng, 9, 1.0, 1.0, 0.0));
    let (xs, ys) = ([a.0.clone(), b.0.clone()].concat(), [a.1.clone(), b.1.clone()].concat());
    let rows: Vec<MonotoneQuartic> =
        fit_rows(&xs, &ys, &[0, 5, 14], &QuarticOptions::default()).unwrap();
    let out = MonotoneQuartic::evaluate_rows(&rows, &xs, &[0, 5, 14], 0, None).unwrap();
    assert_eq!(out, ys);
    let mut bad = columns.clone();
    bad[43] = f64::NAN;
    let error = fit_columns::<MonotoneQuintic>(&x, &bad, &options).unwrap_err();
    assert_eq!(error.to_string(), "row 2: y[3] is NaN; every entry must be finite");
    assert!(
        fit_rows::<MonotoneQuartic>(&xs, &ys, &[0, 9, 5, 14], &QuarticOptions::default()).is_err()
    );
    assert!(fit_rows::<MonotoneQuartic>(&xs, &ys, &[0, 5], &QuarticOptions::default()).is_err());
}

#[cfg(feature = "serde")]
#[test]
fn stored_and_shared() {
    fn shared<T: Send + Sync + 'static>(_: &T) {}
    let (x, y) = csv("rpn14.csv");
    let f = MonotoneQuintic::new(&x, &y, &QuinticOptions::default()).unwrap();
    shared(&f);
    let bytes = postcard::to_stdvec(&f).unwrap();
    let g: MonotoneQuintic = postcard::from_bytes(&bytes).unwrap();
    let q = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
    let r: MonotoneQuartic = postcard::from_bytes(&postcard::to_stdvec(&q).unwrap()).unwrap();
    let p = f.derivative(1);
    let s: PiecewisePolynomial = postcard::from_bytes(&postcard::to_stdvec(&p).unwrap()).unwrap();
    for k in 0..200 {
        let at = 7.0 + 0.07 * f64::from(k);
        assert_eq!(f.value(at).to_bits(), g.value(at).to_bits());
        assert_eq!(q.value(at).to_bits(), r.value(at).to_bits());
        assert_eq!(p.evaluate(at, 0, None).to_bits(), s.evaluate(at, 0, None).to_bits());
    }
    assert_eq!(f.diagnostics(), g.diagnostics());
    // Damaged bytes are refused, not believed: the length of y no longer fits.
    let mut damaged = bytes;
    damaged[0] = 5;
    assert!(postcard::from_bytes::<MonotoneQuintic>(&damaged).is_err());
}
