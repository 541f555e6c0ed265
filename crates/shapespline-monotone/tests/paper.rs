// SPDX-License-Identifier: MIT OR Apache-2.0

//! Published and reference energies, continuity, and the paper's scheme.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]
mod common;

use common::{Rng, csv, monotone};
use shapespline_monotone::*;

fn quintic(x: &[f64], y: &[f64], slopes: Slopes) -> MonotoneQuintic {
    let options = QuinticOptions { slopes, ..QuinticOptions::default() };
    MonotoneQuintic::new(x, y, &options).unwrap()
}

/// Specification, section 5: the paper's program with Fritsch–Butland slopes.
#[test]
fn energies_of_the_paper_s_program() {
    for (name, expected, digits) in [("rpn14.csv", 16.986, 5e-4), ("akima.csv", 15986.0, 0.5)] {
        let (x, y) = csv(name);
        let f = quintic(&x, &y, Slopes::FritschButland);
        assert!((f.bending_energy() - expected).abs() <= digits, "{name}: {}", f.bending_energy());
        let diagnostics = f.diagnostics();
        assert!(diagnostics.converged && diagnostics.certified);
        assert!(diagnostics.kkt_residual <= 1e-10);
        assert_eq!(diagnostics.solver, SolverKind::ActiveSet);
    }
}

/// Specification, section 5: the exact optimum over C² monotone quintics.
#[test]
fn energies_of_optimal_slopes() {
    for (name, optimum) in [("rpn14.csv", 9.818), ("akima.csv", 4569.4)] {
        let (x, y) = csv(name);
        let f = quintic(&x, &y, Slopes::Optimal);
        let ratio = f.bending_energy() / optimum;
        assert!((0.9999..=1.005).contains(&ratio), "{name}: {} of the optimum", ratio);
        assert!(f.diagnostics().certified && f.diagnostics().converged);
        assert!(f.bending_energy() <= quintic(&x, &y, Slopes::FritschButland).bending_energy());
    }
}

/// Newton's step may end exactly on the boundary of a cone: the next inverse was NaN, and the paper's program
/// answered in silence. The reported data, their neighbours by an ulp, and random sets.
#[test]
fn optimal_slopes_come_from_the_interior_point() {
    let x: Vec<f64> = (0..6).map(f64::from).collect();
    let reported = 6.401_530_630_279_101_f64;
    for middle in [reported.next_down(), reported, reported.next_up()] {
        let f = quintic(&x, &[5.3, 5.6, 6.1, middle, 6.9, 15.2], Slopes::Optimal);
        let d = f.diagnostics();
        assert_eq!((d.solver, d.converged), (SolverKind::InteriorPoint, true), "{middle}");
        assert!((108.4..108.9).contains(&f.bending_energy()), "{middle}: {}", f.bending_energy());
    }
    let mut rng = Rng::new(23);
    for case in 0..4000 {
        let n = 3 + rng.index(12);
        let (x, y) = monotone(&mut rng, n, (case % 2) as f64, (case % 3) as f64, 0.05);
        let f = quintic(&x, &y, Slopes::Optimal);
        let d = f.diagnostics();
        assert_eq!(
            (d.solver, d.converged),
            (SolverKind::InteriorPoint, true),
            "case {case}: {x:?} {y:?}"
        );
    }
}

/// The energy the object reports is the integral of its squared second derivative.
#[test]
fn bending_energy_is_the_integral() {
    let (x, y) = csv("akima.csv");
    for slopes in [Slopes::FritschButland, Slopes::Optimal] {
        let f = quintic(&x, &y, slopes);
        let mut sum = 0.0;
        for w in x.windows(2) {
            // Composite Simpson in each segment: the integrand has degree six.
            let n = 400;
            for k in 0..=n {
                let t = f64::from(k) / f64::from(n);
                let weight = if k == 0 || k == n {
                    1.0
                } else if k % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                let at = (w[0] + t * (w[1] - w[0])).clamp(w[0].next_up(), w[1].next_down());
                sum +=
                    weight * f.evaluate(at, 2, None).powi(2) * (w[1] - w[0]) / (3.0 * f64::from(n));
            }
        }
        assert!((sum / f.bending_energy() - 1.0).abs() < 1e-6, "{sum} {}", f.bending_energy());
    }
    let q = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
    let second = q.derivative(2);
    let mut sum = 0.0;
    for w in x.windows(2) {
        for k in 0..2000 {
            let at = w[0] + (f64::from(k) + 0.5) / 2000.0 * (w[1] - w[0]);
            sum += second.evaluate(at, 0, None).powi(2) * (w[1] - w[0]) / 2000.0;
        }
    }
    assert!((sum / q.bending_energy() - 1.0).abs() < 1e-5);
}

/// Smooth monotone data have a monotone natural spline: the optimum is that spline, after one solve.
#[test]
fn natural_spline_when_it_is_monotone() {
    let x: Vec<f64> = (0..50).map(|k| f64::from(k) * 0.1).collect();
    let y: Vec<f64> = x.iter().map(|x| x.exp()).collect();
    let f = quintic(&x, &y, Slopes::Optimal);
    assert_eq!(f.diagnostics().iterations, 1);
    let s = f.second_derivatives();
    assert!(s[0].abs() < 1e-9 && s[49].abs() < 1e-9, "natural ends {} {}", s[0], s[49]);
    // Third derivatives of a cubic spline are constant on segments: no fourth derivative.
    for k in 0..49 {
        let (a, b) = (x[k] + 0.02, x[k] + 0.08);
        assert!((f.evaluate(a, 3, None) - f.evaluate(b, 3, None)).abs() < 1e-5);
    }
}

/// Lines are reproduced, two points give the line.
#[test]
fn lines_are_lines() {
    let x = [0.0, 0.3, 1.7, 2.0, 9.0];
    let y: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x).collect();
    for slopes in [Slopes::FritschButland, Slopes::Optimal] {
        let f = quintic(&x, &y, slopes.clone());
        assert!(f.bending_energy() < 1e-25);
        assert!((f.value(1.0) - 1.0).abs() < 1e-15);
        let two = quintic(&x[..2], &y[..2], slopes);
        assert!(two.slopes().iter().all(|d| (d + 2.0).abs() < 1e-15));
    }
    let q = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
    assert!((q.value(5.0) + 7.0).abs() < 1e-14);
}

/// Jumps of y, y', y'' at the knots from the polynomials on either side.
#[test]
fn continuity() {
    let mut rng = Rng::new(3);
    for case in 0..60 {
        let n = 3 + rng.index(60);
        let (x, y) = monotone(&mut rng, n, 2.0, (case % 4) as f64, 0.1);
        let q = MonotoneQuartic::new(&x, &y, &QuarticOptions::default()).unwrap();
        let fits = [
            quintic(&x, &y, Slopes::FritschButland).spline().clone(),
            quintic(&x, &y, Slopes::Optimal).spline().clone(),
            q.spline().clone(),
        ];
        for f in fits {
            let orders = if f.degree() == 5 { 2 } else { 1 };
            for nu in 0..=orders {
                let p = f.derivative(nu);
                let m = p.degree() + 1;
                let c = p.coefficients();
                for i in 1..n - 1 {
                    let (left, right) = (c[i * m - 1], c[i * m]);
                    let scale =
                        c[(i - 1) * m..(i + 1) * m].iter().fold(0.0f64, |a, v| a.max(v.abs()));
                    let jump = (left - right).abs();
                    assert!(jump <= 1e-12 * scale, "case {case} nu {nu}: {jump:e} of {scale:e}");
                }
            }
        }
    }
}

/// α, β are given back: the curve (16) made of them is the interpolant.
#[test]
fn shape_parameters_reproduce_the_curve() {
    let (x, y) = csv("rpn14.csv");
    let f = quintic(&x, &y, Slopes::FritschButland);
    let (alpha, beta, d) = (f.alpha(), f.beta(), f.slopes());
    for i in 0..x.len() - 1 {
        if d[i] == 0.0 || d[i + 1] == 0.0 {
            continue;
        }
        assert!(alpha[i] >= -1e-9 && beta[i] >= -1e-9, "{} {}", alpha[i], beta[i]);
        let h = x[i + 1] - x[i];
        let (m0, m1) = (h * d[i], h * d[i + 1]);
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let u = 1.0 - t;
            let (v0, v3) = (y[i], y[i + 1]);
            let r = v0 * u.powi(5)
                + (m0 + 5.0 * v0) * u.powi(4) * t
                + (m0 - beta[i] * m1 + 7.0 * v0 + 3.0 * v3) * u.powi(3) * t * t
                + (alpha[i] * m0 - m1 + 3.0 * v0 + 7.0 * v3) * u * u * t.powi(3)
                + (-m1 + 5.0 * v3) * u * t.powi(4)
                + v3 * t.powi(5);
            assert!((r - f.value(x[i] + t * h)).abs() < 1e-13);
        }
    }
}

/// Optimal is never above Fritsch–Butland, for both energies, monotone or not.
#[test]
fn optimal_is_never_worse() {
    let mut rng = Rng::new(17);
    for case in 0..60 {
        let n = 3 + rng.index(30);
        let (x, mut y) = monotone(&mut rng, n, 1.0, (case % 5) as f64, 0.1);
        if case % 2 == 1 {
            y.iter_mut().for_each(|v| *v = (3.0 * *v).sin());
        }
        for fairness in [Fairness::Bending, Fairness::Parametric] {
            let make = |slopes| {
                let options = QuinticOptions { slopes, fairness, ..QuinticOptions::default() };
                MonotoneQuintic::new(&x, &y, &options).unwrap()
            };
            let (best, paper) = (make(Slopes::Optimal), make(Slopes::FritschButland));
            let (a, b) = (best.diagnostics().energy, paper.diagnostics().energy);
            assert!(a <= b * (1.0 + 1e-12), "case {case} {fairness:?}: {a} {b}");
            assert!(best.diagnostics().certified && paper.diagnostics().certified);
        }
    }
}

/// Powers of two scale exactly, reflections exactly; reversal to rounding.
#[test]
fn scales_and_reflections() {
    let (x, y) = csv("rpn14.csv");
    let n = x.len();
    let queries: Vec<f64> =
        (0..500).map(|k| x[0] + (x[n - 1] - x[0]) * f64::from(k) / 499.0).collect();
    let run = |x: &[f64], y: &[f64], q: &[f64]| -> Vec<Vec<f64>> {
        let make = |slopes| quintic(x, y, slopes).spline().clone();
        let quartic = MonotoneQuartic::new(x, y, &QuarticOptions::default()).unwrap();
        [make(Slopes::FritschButland), make(Slopes::Optimal), quartic.spline().clone()]
            .iter()
            .map(|f| {
                let mut out = vec![0.0; q.len()];
                f.evaluate_into(q, 0, None, &mut out);
                out
            })
            .collect()
    };
    let base = run(&x, &y, &queries);
    let close = |a: &[Vec<f64>], b: &[Vec<f64>], unit: f64, label: &str| {
        for ((a, b), room) in a.iter().zip(b).zip([1e-9; 3]) {
            for (a, b) in a.iter().zip(b) {
                assert!((a * unit - b).abs() <= room * unit, "{label}: {a} {}", b / unit);
            }
        }
    };
    let scaled = |v: &[f64], s: f64| v.iter().map(|v| v * s).collect::<Vec<_>>();
    for (sx, sy) in
        [(2f64.powi(300), 2f64.powi(-300)), (2f64.powi(-300), 2f64.powi(300)), (1.0, -1.0)]
    {
        let other = run(&scaled(&x, sx), &scaled(&y, sy), &scaled(&queries, sx));
        for (a, b) in base.iter().zip(&other) {
            assert_eq!(&scaled(a, sy), b, "scales {sx:e} {sy:e}");
        }
    }
    for (sx, sy) in [(1e100, 1e100), (1e-100, 1e-100), (1e100, 1e-100), (1e-90, 1e100)] {
        let other = run(&scaled(&x, sx), &scaled(&y, sy), &scaled(&queries, sx));
        close(&base, &other, sy, &format!("scales {sx:e} {sy:e}"));
    }
    let back = |v: &[f64], s: f64| v.iter().rev().map(|v| s * v).collect::<Vec<_>>();
    let other = run(&back(&x, -1.0), &back(&y, 1.0), &back(&queries, -1.0));
    let turned: Vec<Vec<f64>> = other.iter().map(|b| back(b, 1.0)).collect();
    close(&base, &turned, 1.0, "reversal");
}
