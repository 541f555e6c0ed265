// SPDX-License-Identifier: MIT OR Apache-2.0

#![allow(clippy::unwrap_used)]
use super::*;
use crate::minimal_bending;
use rand::{Rng, SeedableRng, rngs::StdRng};

mod convex;

fn with(penalty: PenaltyChoice) -> SmoothOptions {
    SmoothOptions { penalty, ..SmoothOptions::default() }
}

fn penalty(value: f64) -> SmoothOptions {
    with(PenaltyChoice::Fixed(value))
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

/// Increasing x on [0, 10], a logistic curve and noise.
fn logistic(n: usize, noise: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut x: Vec<f64> = (0..n).map(|_| 10.0 * rng.random::<f64>()).collect();
    x.sort_by(f64::total_cmp);
    let y = x.iter().map(|x| truth(*x) + noise * 1.7 * (rng.random::<f64>() - 0.5) * 2.0);
    let y = y.collect();
    (x, y)
}

fn truth(x: f64) -> f64 {
    1.0 / (1.0 + (-2.0 * (x - 5.0)).exp())
}

/// The smoothing spline of Reinsch (1967), densely: `f = y − λW⁻¹Qγ` with `(R + λQᵀW⁻¹Q)γ = Qᵀy`.
fn reinsch(x: &[f64], y: &[f64], w: &[f64], lambda: f64) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
    let q = |i: usize, j: usize| match i as isize - j as isize {
        0 => 1.0 / h[j],
        1 => -1.0 / h[j] - 1.0 / h[j + 1],
        2 => 1.0 / h[j + 1],
        _ => 0.0,
    };
    let m = n - 2;
    let mut a = vec![vec![0.0; m + 1]; m];
    for i in 0..m {
        for j in 0..m {
            let r = match i.abs_diff(j) {
                0 => (h[i] + h[i + 1]) / 3.0,
                1 => h[i.max(j)] / 6.0,
                _ => 0.0,
            };
            let product: f64 = (0..n).map(|k| q(k, i) * q(k, j) / w[k]).sum();
            a[i][j] = r + lambda * product;
        }
        a[i][m] = (0..n).map(|k| q(k, i) * y[k]).sum();
    }
    for k in 0..m {
        for i in k + 1..m {
            let factor = a[i][k] / a[k][k];
            for j in k..=m {
                let by = factor * a[k][j];
                a[i][j] -= by;
            }
        }
    }
    let mut gamma = vec![0.0; m];
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|j| a[i][j] * gamma[j]).sum();
        gamma[i] = (a[i][m] - known) / a[i][i];
    }
    let bent = |k: usize| (0..m).map(|j| q(k, j) * gamma[j]).sum::<f64>();
    (0..n).map(|k| y[k] - lambda / w[k] * bent(k)).collect()
}

fn objective(y: &[f64], f: &[f64], energy: f64, lambda: f64) -> f64 {
    y.iter().zip(f).map(|(y, f)| (y - f) * (y - f)).sum::<f64>() + lambda * energy
}

#[test]
fn where_it_is_monotone_the_smoothing_spline_is_the_answer() {
    let mut rng = StdRng::seed_from_u64(1);
    for n in [3, 5, 12, 30] {
        let x: Vec<f64> = (0..n).map(|i| f64::from(i) + 0.8 * rng.random::<f64>()).collect();
        let y: Vec<f64> = x.iter().map(|x| x + 0.3 * rng.random::<f64>()).collect();
        let w: Vec<f64> = (0..n).map(|_| 0.2 + rng.random::<f64>()).collect();
        let options = SmoothOptions { weights: Some(w.clone()), ..penalty(3.0) };
        let f = smooth_monotone(&x, &y, &options).unwrap();
        assert_eq!((f.smoothing().unwrap().steps, f.smoothing().unwrap().converged), (1, true));
        for (a, b) in f.y().iter().zip(reinsch(&x, &y, &w, 3.0)) {
            close(*a, b, 1e-11);
        }
    }
}

/// No monotone function is better: neither nearby ones nor the best at random.
#[test]
fn nothing_monotone_has_a_smaller_objective() {
    let mut rng = StdRng::seed_from_u64(2);
    for (n, lambda) in [(5, 1e-3), (12, 1e-6), (12, 1e-2), (40, 1e-4), (40, 1.0)] {
        let (x, y) = logistic(n, 0.2, n as u64);
        let f = smooth_monotone(&x, &y, &penalty(lambda)).unwrap();
        assert!(f.smoothing().unwrap().converged);
        let least = objective(&y, f.y(), f.bending_energy(), lambda);
        for k in 0..200 {
            let size = 10f64.powf(-f64::from(k % 8) - 1.0);
            let mut other: Vec<f64> =
                f.y().iter().map(|f| f + size * (rng.random::<f64>() - 0.5)).collect();
            for i in 1..n {
                other[i] = other[i].max(other[i - 1]);
            }
            let there = objective(&y, &other, minimal_bending(&x, &other).unwrap(), lambda);
            assert!(there >= least * (1.0 - 1e-11), "{there} {least}");
        }
    }
}

#[test]
fn slopes_are_not_negative_and_second_derivatives_continuous() {
    for (n, lambda) in [(10, 1e-4), (100, 1e-8), (100, 1e-4), (100, 0.1), (1000, 0.1), (1000, 10.0)]
    {
        let (x, y) = logistic(n, 0.1, 7 + n as u64);
        let f = smooth_monotone(&x, &y, &penalty(lambda)).unwrap();
        assert!(
            f.smoothing().unwrap().converged && f.smoothing().unwrap().steps <= 60,
            "{:?}",
            f.smoothing()
        );
        assert!(f.slopes().iter().all(|m| *m >= 0.0));
        let pieces = f.to_piecewise();
        let knots = f.knots();
        let size = f.second_derivatives().iter().fold(0.0f64, |a, z| a.max(z.abs()));
        for k in 1..knots.len() - 1 {
            let z = |i: usize, right: bool| {
                let h = knots[i + 1] - knots[i];
                let c = &pieces.coefficients()[4 * i..4 * i + 4];
                let at = if right { 1 } else { 0 };
                6.0 * (c[at] - 2.0 * c[at + 1] + c[at + 2]) / (h * h)
            };
            // Bernstein coefficients have an ulp of the values.
            let h = (knots[k + 1] - knots[k]).min(knots[k] - knots[k - 1]);
            close(z(k - 1, true), z(k, false), 1e-6 * size + 1e-14 / (h * h));
        }
    }
}

#[test]
fn without_a_penalty_it_is_the_isotonic_regression() {
    let (x, y) = ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 3.0, 2.0, 2.0, 5.0, 4.5]);
    let f = smooth_monotone(&x, &y, &penalty(0.0)).unwrap();
    let third = 7.0 / 3.0;
    for (a, b) in f.y().iter().zip([1.0, third, third, third, 4.75, 4.75]) {
        close(*a, b, 1e-15 * 5.0);
    }
    assert_eq!(f.smoothing().unwrap().degrees_of_freedom, 3.0);
    let near = smooth_monotone(&x, &y, &penalty(1e-9)).unwrap();
    for (a, b) in near.y().iter().zip(f.y()) {
        close(*a, *b, 1e-6);
    }
    let y = [1.0, 1.5, 4.0, 4.25, 4.5, 9.0];
    let f = smooth_monotone(&x, &y, &penalty(0.0)).unwrap();
    assert_eq!(f.y(), y);
    close(f.bending_energy(), minimal_bending(&x, &y).unwrap(), 1e-12);
}

#[test]
fn noise_is_smoothed_away() {
    let (x, y) = logistic(1000, 0.1, 3);
    let rms = |f: &MonotoneCubic| {
        let error = |(x, f): (&f64, &f64)| (f - truth(*x)).powi(2);
        (f.x().iter().zip(f.y()).map(error).sum::<f64>() / f.x().len() as f64).sqrt()
    };
    assert!(rms(&smooth_monotone(&x, &y, &penalty(0.1)).unwrap()) < 0.018);
    assert!(rms(&smooth_monotone(&x, &y, &SmoothOptions::default()).unwrap()) < 0.025);
}

#[test]
fn the_residual_given_is_left() {
    let (x, y) = logistic(200, 0.1, 4);
    let least = smooth_monotone(&x, &y, &penalty(0.0)).unwrap().smoothing().unwrap().residual;
    for times in [1.01, 1.2, 2.0] {
        let wanted = least * times;
        let f = smooth_monotone(&x, &y, &with(PenaltyChoice::FromResidual(wanted))).unwrap();
        let found: f64 = y.iter().zip(f.y()).map(|(y, f)| (y - f) * (y - f)).sum();
        close(found, wanted, 1e-8 * wanted);
        close(f.smoothing().unwrap().residual, wanted, 1e-8 * wanted);
        let again = smooth_monotone(&x, &y, &penalty(f.smoothing().unwrap().penalty)).unwrap();
        close(again.smoothing().unwrap().residual, wanted, 1e-8 * wanted);
    }
    let line = smooth_monotone(&x, &y, &with(PenaltyChoice::FromResidual(1e3))).unwrap();
    assert_eq!(line.smoothing().unwrap().penalty, f64::INFINITY);
    close(line.bending_energy(), 0.0, 1e-20);
    let refused = smooth_monotone(&x, &y, &with(PenaltyChoice::FromResidual(0.9 * least)));
    assert!(matches!(refused, Err(MonotoneError::Residual { .. })));
}

#[test]
fn cross_validation_finds_the_least_score() {
    for n in [30, 150] {
        let (x, y) = logistic(n, 0.15, 5 + n as u64);
        let score = |f: &MonotoneCubic| {
            let n = n as f64;
            f.smoothing().unwrap().residual
                / n
                / (1.0 - f.smoothing().unwrap().degrees_of_freedom / n).powi(2)
        };
        let found = score(&smooth_monotone(&x, &y, &SmoothOptions::default()).unwrap());
        for k in -60..30 {
            let f = smooth_monotone(&x, &y, &penalty(10f64.powf(0.1 * f64::from(k)))).unwrap();
            assert!(found <= score(&f) * (1.0 + 1e-2), "{found} {} at {k}", score(&f));
        }
    }
}

/// The trace of the influence matrix, by differences.
#[test]
fn degrees_of_freedom_are_those_of_the_values() {
    let (x, y) = logistic(25, 0.1, 6);
    for lambda in [1e-3, 0.1, 30.0] {
        let f = smooth_monotone(&x, &y, &penalty(lambda)).unwrap();
        let e = 1e-7;
        let moved = |i: usize, by: f64| {
            let mut y = y.clone();
            y[i] += by;
            smooth_monotone(&x, &y, &penalty(lambda)).unwrap().y()[i]
        };
        let trace: f64 = (0..25).map(|i| (moved(i, e) - moved(i, -e)) / (2.0 * e)).sum();
        close(f.smoothing().unwrap().degrees_of_freedom, trace, 1e-4 * trace);
    }
}

#[test]
fn bounds_hold_and_are_reached() {
    let (x, y) = logistic(60, 0.2, 8);
    for bounds in [[0.0, 1.0], [0.1, 0.8], [0.0, f64::INFINITY], [2.0, 3.0], [0.4, 0.4 + 1e-14]] {
        for lambda in [0.0, 1e-3, 1.0, 1e9] {
            let options = SmoothOptions { bounds: Some(bounds), ..penalty(lambda) };
            let f = smooth_monotone(&x, &y, &options).unwrap();
            let how = f.smoothing().unwrap();
            assert!(how.converged && how.degrees_of_freedom >= 0.0, "{how:?}");
            assert!(
                f.y().iter().all(|v| bounds[0] <= *v && *v <= bounds[1]),
                "{bounds:?} {lambda}"
            );
            if lambda > 0.0 && bounds == [0.1, 0.8] {
                assert_eq!((f.y()[0], f.y()[59]), (0.1, 0.8));
            }
        }
    }
}

/// Held by both bounds, two values have no freedom.
#[test]
fn bounds_take_degrees_of_freedom() {
    let options = SmoothOptions { bounds: Some([0.3, 0.6]), ..penalty(1e-4) };
    let f = smooth_monotone(&[0.0, 1.0], &[0.0, 1.0], &options).unwrap();
    assert_eq!(f.y(), [0.3, 0.6]);
    close(f.smoothing().unwrap().degrees_of_freedom, 0.0, 1e-8);
}

#[test]
fn repeated_abscissae_are_merged_and_weights_count() {
    let x = [0.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0];
    let y = [0.0, 0.7, 1.1, 0.6, 0.5, 2.0, 2.2];
    let f = smooth_monotone(&x, &y, &penalty(0.05)).unwrap();
    let weights = Some(vec![1.0, 3.0, 1.0, 2.0]);
    let options = SmoothOptions { weights, ..penalty(0.05) };
    let g = smooth_monotone(&[0.0, 1.0, 2.0, 3.0], &[0.0, 0.8, 0.5, 2.1], &options).unwrap();
    assert_eq!(f.x(), g.x());
    for (a, b) in f.y().iter().zip(g.y()) {
        close(*a, *b, 1e-13);
    }
    let residual: f64 = x.iter().zip(y).map(|(x, y)| (y - f.value(*x)).powi(2)).sum();
    close(f.smoothing().unwrap().residual, residual, 1e-13);
}

#[test]
fn falling_data_are_reflected_and_the_direction_is_found() {
    let (x, y) = logistic(80, 0.1, 9);
    let fall: Vec<f64> = y.iter().map(|y| -y).collect();
    let up = smooth_monotone(&x, &y, &penalty(0.01)).unwrap();
    for increasing in [Some(false), None] {
        let options = SmoothOptions { increasing, ..penalty(0.01) };
        let down = smooth_monotone(&x, &fall, &options).unwrap();
        assert!(!down.smoothing().unwrap().increasing);
        for (a, b) in up.y().iter().zip(down.y()) {
            assert_eq!(*a, -b);
        }
    }
    // Increasing functions nearest to falling data are constant.
    let flat = smooth_monotone(&x, &fall, &penalty(0.01)).unwrap();
    let mean = fall.iter().sum::<f64>() / 80.0;
    assert!(flat.y().iter().all(|v| (v - mean).abs() < 1e-14));
}

#[test]
fn scales_do_not_matter() {
    let (x, y) = logistic(60, 0.1, 10);
    for amount in [
        PenaltyChoice::Fixed(0.01),
        PenaltyChoice::FromResidual(0.6),
        PenaltyChoice::CrossValidated,
    ] {
        let own = smooth_monotone(&x, &y, &with(amount)).unwrap();
        for (ex, ey) in [(2f64.powi(300), 2f64.powi(-250)), (1e-100, 1e100), (1e100, 1e-100)] {
            let scaled = |v: &[f64], by: f64| v.iter().map(|v| v * by).collect::<Vec<_>>();
            let amount = match amount {
                PenaltyChoice::Fixed(p) => PenaltyChoice::Fixed(p * ex * ex * ex),
                PenaltyChoice::FromResidual(r) => PenaltyChoice::FromResidual(r * ey * ey),
                other => other,
            };
            let f = smooth_monotone(&scaled(&x, ex), &scaled(&y, ey), &with(amount)).unwrap();
            let exact = ex.to_bits() << 12 == 0;
            for (a, b) in own.y().iter().zip(f.y()) {
                let tolerance = if exact { 0.0 } else { 1e-7 };
                close(*a, b / ey, tolerance);
            }
        }
    }
}

#[test]
fn few_and_constant_data() {
    let f = smooth_monotone(&[1.0, 2.0], &[5.0, 7.0], &SmoothOptions::default()).unwrap();
    assert_eq!(f.y(), [5.0, 7.0]);
    let f = smooth_monotone(&[1.0, 2.0], &[7.0, 5.0], &penalty(1.0)).unwrap();
    assert!(f.y().iter().all(|v| (v - 6.0).abs() < 1e-14));
    for amount in
        [PenaltyChoice::Fixed(1.0), PenaltyChoice::FromResidual(0.0), PenaltyChoice::CrossValidated]
    {
        let f = smooth_monotone(&[1.0, 2.0, 4.0], &[3.0; 3], &with(amount)).unwrap();
        assert_eq!(f.y(), [3.0; 3]);
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0]);
    let message = |x: &[f64], y: &[f64], options: &SmoothOptions| {
        smooth_monotone(x, y, options).unwrap_err().to_string()
    };
    let own = |options: &SmoothOptions| message(&x, &y, options);
    let weights = |w: &[f64]| SmoothOptions { weights: Some(w.to_vec()), ..penalty(1.0) };
    let bounds = |bounds| SmoothOptions { bounds: Some(bounds), ..penalty(1.0) };
    assert_eq!(own(&weights(&[1.0, -2.0, 1.0])), "weights[1] must be positive and finite, got -2");
    assert_eq!(own(&weights(&[1.0, 1.0])), "weights has 2 entries; expected 3");
    assert_eq!(own(&penalty(-1.0)), "penalty must be finite and not negative, got -1");
    assert!(
        own(&with(PenaltyChoice::FromResidual(f64::NAN))).starts_with("residual must be finite")
    );
    assert_eq!(own(&bounds([1.0, 1.0])), "bounds[1] must exceed the lower bound, got 1");
    assert!(own(&bounds([f64::NAN, 1.0])).starts_with("bounds[0]"));
    let plain = penalty(1.0);
    assert_eq!(
        message(&[0.0, 2.0, 1.0], &y, &plain),
        "x[2] must not be below its predecessor, got 1"
    );
    assert!(message(&[3.0; 3], &y, &plain).starts_with("x must have at least two distinct"));
    assert!(message(&x, &[0.0, f64::NAN, 1.0], &plain).starts_with("y[1] is NaN"));
    assert!(message(&x, &[0.0, 1.0], &plain).starts_with("y has 2 entries"));
}

#[test]
fn it_can_be_interrupted() {
    let (x, y) = logistic(100, 0.1, 11);
    let stop = || ControlFlow::Break(());
    let refused = smooth_monotone_with(&x, &y, &SmoothOptions::default(), &stop);
    assert_eq!(refused.unwrap_err(), MonotoneError::Interrupted);
}
