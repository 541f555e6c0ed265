// SPDX-License-Identifier: MIT OR Apache-2.0

//! Monotone to the last bit, on random sets over twelve decades with repeats.
#![allow(clippy::unwrap_used)]
mod common;

use common::{Rng, monotone};
use shapespline_monotone::*;

/// No drop above 4 ulp of the data's range, no value outside its segment's interval.
fn check(f: &MonotoneSpline, sign: f64, queries: usize, rng: &mut Rng, label: &str) {
    let (x, y) = (f.x(), f.y());
    let n = x.len();
    let mut q: Vec<f64> = (0..queries)
        .map(|k| {
            // Half evenly over the range, half evenly over the segments (most of which are tiny).
            if k % 2 == 0 {
                x[0] + (x[n - 1] - x[0]) * rng.next()
            } else {
                let i = rng.index(n - 1);
                x[i] + (x[i + 1] - x[i]) * rng.next()
            }
        })
        .collect();
    q.extend_from_slice(x);
    q.sort_by(f64::total_cmp);
    q.iter_mut().for_each(|v| *v = v.min(x[n - 1]));
    let mut v = vec![0.0; q.len()];
    f.evaluate_into(&q, 0, None, &mut v);
    let range = (y[n - 1] - y[0]).abs();
    // One ulp of the range, and of the largest value where an offset dominates.
    let size = y.iter().fold(range, |a, v| a.max(v.abs()));
    let allowed = 4.0 * f64::EPSILON * size;
    for k in 1..v.len() {
        let drop = sign * (v[k - 1] - v[k]);
        assert!(drop <= allowed, "{label}: drop {drop:e} of {range:e} at {}", q[k]);
    }
    let mut i = 0;
    for (q, v) in q.iter().zip(&v) {
        while i + 2 < n && *q >= x[i + 1] {
            i += 1;
        }
        let (lo, hi) = (y[i].min(y[i + 1]), y[i].max(y[i + 1]));
        assert!((lo..=hi).contains(v), "{label}: {v} outside [{lo}, {hi}]");
    }
    let mut at = vec![0.0; n];
    f.evaluate_into(x, 0, None, &mut at);
    assert_eq!(at, y, "{label}: knots");
}

fn sweep(sets: usize, queries: usize, seed: u64) {
    let mut rng = Rng::new(seed);
    for case in 0..sets {
        let n = match case % 5 {
            0 => 2 + rng.index(6),
            4 => 2 + rng.index(999),
            _ => 2 + rng.index(120),
        };
        let decades = 12.0 * rng.next();
        let (x, mut y) = monotone(&mut rng, n, [0.0, 3.0, 6.0][case % 3], decades, 0.15);
        let sign = if case % 4 == 3 { -1.0 } else { 1.0 };
        y.iter_mut().for_each(|v| *v *= sign);
        let quartic = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
        check(&quartic, sign, queries, &mut rng, &format!("case {case} n {n} quartic"));
        for slopes in [Slopes::FritschButland, Slopes::Optimal] {
            let label = format!("case {case} n {n} {slopes:?}");
            let options = QuinticOptions { slopes, ..QuinticOptions::default() };
            let f = MonotoneQuintic::new(&x, &y, &options).unwrap();
            assert!(f.diagnostics().certified, "{label}");
            check(&f, sign, queries, &mut rng, &label);
        }
    }
}

#[test]
fn to_the_last_bit() {
    sweep(120, 4000, 1);
}

/// The full acceptance run: a million queries over each of a thousand sets.
#[test]
#[ignore = "takes minutes; run with --release -- --ignored"]
fn to_the_last_bit_in_full() {
    sweep(1000, 1_000_000, 2);
}

/// Data that are not monotone: no extrema but the data's, flats stay flat.
#[test]
fn piecewise_monotone_data() {
    let mut rng = Rng::new(9);
    for case in 0..100 {
        let n = 3 + rng.index(40);
        let (x, _) = monotone(&mut rng, n, 2.0, 0.0, 0.0);
        let mut y: Vec<f64> =
            (0..n).map(|_| (rng.next() - 0.5) * 10f64.powf(3.0 * rng.next())).collect();
        for k in 1..n {
            if rng.next() < 0.2 {
                y[k] = y[k - 1];
            }
        }
        let q = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
        let make = |slopes| {
            let options = QuinticOptions { slopes, ..QuinticOptions::default() };
            let f = MonotoneQuintic::new(&x, &y, &options).unwrap();
            assert!(f.diagnostics().certified, "case {case}");
            f.spline().clone()
        };
        for f in [q.spline().clone(), make(Slopes::FritschButland), make(Slopes::Optimal)] {
            let size = y.iter().fold(0.0f64, |a, v| a.max(v.abs()));
            for i in 0..n - 1 {
                let rise = y[i + 1] - y[i];
                let mut last = y[i];
                for k in 1..=200 {
                    let v = f.value(x[i] + (x[i + 1] - x[i]) * f64::from(k) / 200.0);
                    if rise == 0.0 {
                        assert_eq!(v, y[i]);
                    } else {
                        assert!(rise.signum() * (last - v) <= 8.0 * f64::EPSILON * size);
                    }
                    last = v;
                }
            }
        }
    }
}

/// Extreme but valid data: a result without NaN, or a clear refusal.
#[test]
fn extremes_work_or_are_refused() {
    let tiny = f64::from_bits(1);
    let cases: Vec<(Vec<f64>, Vec<f64>)> = vec![
        (vec![0.0, 1e-300, 1.0, 1e5], vec![0.0, 1.0, 2.0, 3.0]),
        (vec![0.0, tiny, 2.0 * tiny, 5.0 * tiny], vec![0.0, 1.0, 2.0, 3.0]),
        (vec![0.0, 1e-150, 1.0, 1e150], vec![0.0, 1.0, 2.0, 3.0]),
        (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, tiny, 3.0 * tiny, 1.0]),
        (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, tiny, 2.0 * tiny, 5.0 * tiny]),
        (vec![0.0, 1.0, 2.0, 3.0], vec![-4e307, 0.0, 1.0, 1e307]),
        (vec![0.0, 1.0, 2.0, 3.0], vec![-1.7e308, 0.0, 1.0, 1.7e308]),
        (vec![-1e308, 0.0, 1e308], vec![0.0, 1.0, 2.0]),
        (vec![-8e307, 0.0, 8e307], vec![0.0, 1.0, 2.0]),
        (vec![1.0, 1f64.next_up(), 2.0], vec![0.0, 1.0, 2.0]),
        (vec![1e300, 2e300, 3e300], vec![1e300, 1.5e300, 9e300]),
        (vec![1e-300, 2e-300, 3e-300], vec![1e-300, 1.5e-300, 9e-300]),
        (vec![1e-300, 2e-300, 3e-300], vec![1e300, 1.5e300, 9e300]),
        (vec![1e300, 2e300, 3e300], vec![1e-300, 1.5e-300, 9e-300]),
        (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, 1e-200, 1.0, 1.0 + 1e-15, 1e200]),
    ];
    let mut worked = 0;
    for (x, y) in &cases {
        let n = x.len();
        let mut fits: Vec<MonotoneSpline> = Vec::new();
        match MonotoneQuartic::new(x, y, &QuarticOptions::default()) {
            Ok(f) => fits.push(f.spline().clone()),
            Err(e) => assert!(e.to_string().contains("out of the range"), "{e}"),
        }
        for slopes in [Slopes::FritschButland, Slopes::Optimal] {
            for fairness in [Fairness::Bending, Fairness::Parametric] {
                let options =
                    QuinticOptions { slopes: slopes.clone(), fairness, ..Default::default() };
                match MonotoneQuintic::new(x, y, &options) {
                    Ok(f) => {
                        assert!(!f.bending_energy().is_nan());
                        fits.push(f.spline().clone());
                    }
                    Err(e) => assert!(e.to_string().contains("out of the range"), "{e}"),
                }
            }
        }
        for f in fits {
            worked += 1;
            for i in 0..n - 1 {
                for k in 0..=50 {
                    let at = x[i] + (x[i + 1] - x[i]) * (f64::from(k) / 50.0);
                    let v = f.value(at.min(x[n - 1]));
                    assert!((y[0]..=y[n - 1]).contains(&v), "{x:?} {y:?}: {v} at {at}");
                    for nu in 1..6 {
                        assert!(
                            !f.evaluate(at.min(x[n - 1]), nu, None).is_nan(),
                            "{x:?} {y:?} nu {nu}"
                        );
                    }
                }
            }
            let mut out = [0.0; 3];
            let q = [y[0], 0.5 * y[0] + 0.5 * y[n - 1], y[n - 1]];
            if f.inverse_into(&q, &mut out).is_ok() {
                assert!(out.iter().all(|v| (x[0]..=x[n - 1]).contains(v)), "{x:?} {y:?}: {out:?}");
            }
        }
    }
    assert!(worked >= 40, "only {worked} fits were not refused");
}
