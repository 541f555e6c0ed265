// SPDX-License-Identifier: MIT OR Apache-2.0

//! Smoothing by monotone functions that are convex and concave where that is asked.
use super::*;
use crate::reference::quadratic;

/// Noisy data and signs of their intervals.
struct Case {
    x: Vec<f64>,
    y: Vec<f64>,
    convex: Vec<i8>,
    lambda: f64,
}

/// Data of several shapes; signs +1, −1, S-shaped, reversed S, or (`kind` 4) any.
fn case(kind: usize, most: usize, seed: u64) -> Case {
    let mut rng = StdRng::seed_from_u64(seed);
    let n = rng.random_range(3..most);
    let mut x: Vec<f64> = (0..n).map(|_| rng.random::<f64>()).collect();
    x.sort_by(f64::total_cmp);
    let truth = |x: f64| match seed % 3 {
        0 => (2.0 * x).exp(),
        1 => x.sqrt(),
        _ => 1.0 / (1.0 + (-12.0 * (x - 0.5)).exp()),
    };
    let noise = [1e-3, 0.03, 0.3][rng.random_range(0..3)];
    let y = x.iter().map(|x| truth(*x) + noise * (rng.random::<f64>() - 0.5)).collect();
    let convex = x[1..].iter().map(|x| match kind {
        0 => 1,
        1 => -1,
        2 => {
            if *x < 0.5 {
                1
            } else {
                -1
            }
        }
        3 => {
            if *x < 0.5 {
                -1
            } else {
                1
            }
        }
        _ => rng.random_range(-1..2),
    });
    let convex = convex.collect();
    Case { x, y, convex, lambda: 10f64.powf(8.0 * rng.random::<f64>() - 7.0) }
}

impl Case {
    fn fit(&self) -> MonotoneCubic {
        let options = SmoothOptions { convex: Some(self.convex.clone()), ..penalty(self.lambda) };
        smooth_monotone(&self.x, &self.y, &options).unwrap()
    }
}

/// A bound from below of the objective of every function with these signs on all intervals. With p linear between the
/// points, 0 at the ends, and J the jumps of p′ there: `λ∫f''² − 2∫pf'' ≥ −∫(σp)₊²/λ` and
/// `Σ(y − f)² + 2Σ Jf ≥ Σ(2Jy − J²)`. The best p is λf'' of the best function where that is not 0.
fn bound(case: &Case, f: &[f64]) -> f64 {
    let (x, n) = (&case.x, case.x.len());
    let mut jumps: Vec<f64> = case.y.iter().zip(f).map(|(y, f)| y - f).collect();
    // Sum and first moment are 0, but for rounding.
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n as f64;
    let (middle, off) = (mean(x), mean(&jumps));
    let moment: f64 = x.iter().zip(&jumps).map(|(x, j)| (x - middle) * (j - off)).sum();
    let slope = moment / x.iter().map(|x| (x - middle) * (x - middle)).sum::<f64>();
    x.iter().zip(&mut jumps).for_each(|(x, j)| *j -= off + slope * (x - middle));
    let (mut p, mut sum, mut value) = (0.0, 0.0, 0.0);
    for i in 0..n {
        value += (2.0 * case.y[i] - jumps[i]) * jumps[i];
        if i + 1 < n {
            sum += jumps[i];
            let (h, sense) = (x[i + 1] - x[i], f64::from(case.convex[i]));
            let (a, b) = (sense * p, sense * (p + sum * h));
            let square = match (a > 0.0, b > 0.0) {
                (true, true) => h / 3.0 * (a * a + a * b + b * b),
                (true, false) => h / 3.0 * a * a * (a / (a - b)),
                (false, true) => h / 3.0 * b * b * (b / (b - a)),
                (false, false) => 0.0,
            };
            value -= square / case.lambda;
            p += sum * h;
        }
    }
    value
}

#[test]
fn the_bound_of_duality_is_reached() {
    let mut tight = 0;
    for seed in 0..300u64 {
        let case = case(seed as usize % 4, 80, seed);
        let f = case.fit();
        assert!(f.smoothing().unwrap().converged);
        let value = objective(&case.y, f.y(), f.bending_energy(), case.lambda);
        let bound = bound(&case, f.y());
        assert!(value >= bound - 1e-10 * value, "{seed}: {value} {bound}");
        // Where slopes are held at 0, monotonicity costs more.
        if f.slopes().iter().all(|m| *m > 0.0) {
            tight += 1;
            assert!(value <= bound + 1e-9 * value, "{seed}: {value} {bound} {:?}", f.smoothing());
        }
    }
    assert!(tight > 150, "{tight}");
}

/// The same by Clarabel over functions with y'' linear between knots, 12 in every interval and nearer to its ends, values free.
fn program(case: &Case) -> f64 {
    const K: usize = 12;
    let (x, n) = (&case.x, case.x.len() - 1);
    let place = |j: usize| 0.5 * (1.0 - (std::f64::consts::PI * j as f64 / (K + 1) as f64).cos());
    // Values, slopes, then second derivatives at the knots of every interval.
    let z = |i: usize, j: usize| 2 * (n + 1) + i * (K + 2) + j;
    let (mut hessian, mut equal, mut positive) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..n {
        let h = x[i + 1] - x[i];
        let (mut slope, mut rise) = (vec![(n + 1 + i, 1.0)], vec![(n + 1 + i, h)]);
        positive.push((slope.clone(), 0.0));
        for j in 0..=K {
            let (a, b, from, to) = (z(i, j), z(i, j + 1), h * place(j), h * place(j + 1));
            let (w, by) = (to - from, 2.0 * case.lambda);
            hessian.extend([(a, a, by * w / 3.0), (b, b, by * w / 3.0), (a, b, by * w / 6.0)]);
            rise.extend([
                (a, (h - from) * w / 2.0 - w * w / 6.0),
                (b, (h - from) * w / 2.0 - w * w / 3.0),
            ]);
            // Bernstein coefficients of the slope.
            for at in [a, b] {
                slope.push((at, w / 2.0));
                positive.push((slope.clone(), 0.0));
            }
            if case.convex[i] != 0 {
                positive.extend([a, b].map(|k| (vec![(k, f64::from(case.convex[i]))], 0.0)));
            }
        }
        slope.push((n + 2 + i, -1.0));
        rise.extend([(i, 1.0), (i + 1, -1.0)]);
        equal.extend([(slope, 0.0), (rise, 0.0)]);
    }
    let size = z(n, 0);
    let mut linear = vec![0.0; size];
    for i in 0..=n {
        hessian.push((i, i, 2.0));
        linear[i] = -2.0 * case.y[i];
    }
    let (v, _) = quadratic(size, hessian.clone(), &linear, &equal, &positive);
    let square: f64 = case.y.iter().map(|y| y * y).sum();
    let term =
        |&(r, c, value): &(usize, usize, f64)| value * v[r] * v[c] * if r == c { 0.5 } else { 1.0 };
    let quadratic: f64 = hessian.iter().map(term).sum();
    square + quadratic + v.iter().zip(&linear).map(|(v, q)| v * q).sum::<f64>()
}

#[test]
fn a_dense_program_is_not_better() {
    for seed in 0..40u64 {
        let mut case = case(seed as usize % 5, 14, 1000 + seed);
        // Clarabel loses digits where functions are nearly straight, and its knots are too coarse for kinks.
        case.lambda = case.lambda.clamp(1e-3, 0.1);
        let f = case.fit();
        let value = objective(&case.y, f.y(), f.bending_energy(), case.lambda);
        let other = program(&case);
        // Knots where they are nearest cost a little.
        let room = 1e-7 * value.max(1e-4);
        assert!(value <= other + room && other <= value * 1.02 + room, "{seed}: {value} {other}");
    }
}

/// Signs hold exactly: slopes, and second derivatives at all knots. Flat and straight parts are flat and straight.
#[test]
fn signs_hold_exactly() {
    let mut straight = 0;
    for seed in 0..400u64 {
        let case = case(seed as usize % 5, 120, 2000 + seed);
        let f = case.fit();
        assert!(f.smoothing().unwrap().steps <= 70, "{:?}", f.smoothing());
        assert!(f.slopes().iter().all(|m| *m >= 0.0) && f.y().windows(2).all(|y| y[0] <= y[1]));
        let (knots, seconds) = (f.knots(), f.seconds());
        for (k, z) in seconds.iter().enumerate() {
            let i = case.x.partition_point(|x| *x <= knots[k]) - 1;
            let sense = f64::from(case.convex[i]);
            assert!(z.iter().all(|z| sense * z >= 0.0), "{seed}: {z:?} in {i}");
            straight += usize::from(*z == [0.0; 2]);
        }
    }
    assert!(straight > 1000, "{straight}");
}

#[test]
fn where_it_is_no_constraint_nothing_changes() {
    let mut idle = 0;
    for seed in 0..200u64 {
        let mut rng = StdRng::seed_from_u64(seed);
        let x: Vec<f64> = (0..30).map(|i| f64::from(i) + 0.8 * rng.random::<f64>()).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x + 0.2 * rng.random::<f64>()).collect();
        for (sense, y) in [(1, y.clone()), (-1, y.iter().rev().map(|y| -y).collect())] {
            let x = if sense > 0 { x.clone() } else { x.iter().rev().map(|x| 30.0 - x).collect() };
            let plain = smooth_monotone(&x, &y, &penalty(30.0)).unwrap();
            let curved = |z: &[f64; 2]| z.iter().all(|z| f64::from(sense) * z >= -1e-9);
            if plain.seconds().iter().all(curved) {
                idle += 1;
                let convex = Some(vec![sense; 29]);
                let bent = smooth_monotone(&x, &y, &SmoothOptions { convex, ..penalty(30.0) });
                for (a, b) in bent.unwrap().y().iter().zip(plain.y()) {
                    close(*a, *b, 1e-11 * 900.0);
                }
            }
        }
    }
    assert!(idle > 100, "{idle}");
    // Nothing asked is nothing asked.
    let (x, y) = logistic(50, 0.1, 1);
    let plain = smooth_monotone(&x, &y, &penalty(1e-3)).unwrap();
    let options = SmoothOptions { convex: Some(vec![0; 49]), ..penalty(1e-3) };
    assert_eq!(smooth_monotone(&x, &y, &options).unwrap().y(), plain.y());
}

#[test]
fn reflections_scales_and_order_do_not_matter() {
    for seed in 0..40u64 {
        let case = case(seed as usize % 5, 60, 3000 + seed);
        let f = case.fit();
        let fall: Vec<f64> = case.y.iter().map(|y| -y).collect();
        let signs = |by: i8| Some(case.convex.iter().map(|s| by * s).collect::<Vec<_>>());
        let options =
            SmoothOptions { convex: signs(-1), increasing: Some(false), ..penalty(case.lambda) };
        let down = smooth_monotone(&case.x, &fall, &options).unwrap();
        assert!(f.y().iter().zip(down.y()).all(|(a, b)| *a == -b));
        let by = 2f64.powi(200);
        let x: Vec<f64> = case.x.iter().map(|x| x * by).collect();
        let options = SmoothOptions { convex: signs(1), ..penalty(case.lambda * by * by * by) };
        assert_eq!(smooth_monotone(&x, &case.y, &options).unwrap().y(), f.y());
        let x: Vec<f64> = case.x.iter().rev().map(|x| 1.0 - x).collect();
        let y: Vec<f64> = fall.iter().rev().copied().collect();
        let convex = Some(case.convex.iter().rev().map(|s| -s).collect());
        let options = SmoothOptions { convex, ..penalty(case.lambda) };
        let back = smooth_monotone(&x, &y, &options).unwrap();
        for (a, b) in f.y().iter().zip(back.y().iter().rev()) {
            close(*a, -b, 1e-6);
        }
    }
}

#[test]
fn penalties_follow_from_residuals_and_cross_validation() {
    let (x, y) = logistic(120, 0.1, 12);
    let convex = Some(x[1..].iter().map(|x| if *x < 5.0 { 1 } else { -1 }).collect::<Vec<i8>>());
    let fit = |choice| {
        let options = SmoothOptions { convex: convex.clone(), ..with(choice) };
        smooth_monotone(&x, &y, &options)
    };
    let least = fit(PenaltyChoice::Fixed(1e-20)).unwrap().smoothing().unwrap().residual;
    for times in [1.01, 1.3] {
        let found = fit(PenaltyChoice::FromResidual(times * least)).unwrap();
        close(found.smoothing().unwrap().residual, times * least, 1e-8 * least);
    }
    let refused = fit(PenaltyChoice::FromResidual(0.99 * least)).unwrap_err();
    assert!(refused.to_string().contains("that of the nearest such function"));
    let score = |f: &MonotoneCubic| {
        let how = f.smoothing().unwrap();
        how.residual / (1.0 - how.degrees_of_freedom / 120.0).powi(2)
    };
    let found = score(&fit(PenaltyChoice::CrossValidated).unwrap());
    for k in -50..30 {
        let f = fit(PenaltyChoice::Fixed(10f64.powf(0.1 * f64::from(k)))).unwrap();
        assert!(found <= score(&f) * (1.0 + 1e-2), "{found} {} at {k}", score(&f));
    }
}

#[test]
fn degrees_of_freedom_are_traces() {
    for seed in 0..12u64 {
        let case = case(seed as usize % 5, 25, 4000 + seed);
        let f = case.fit();
        let e = 1e-8;
        let moved = |i: usize, by: f64| {
            let mut y = case.y.clone();
            y[i] += by;
            Case { y, x: case.x.clone(), convex: case.convex.clone(), ..case }.fit().y()[i]
        };
        let trace = |i: usize| (moved(i, e) - moved(i, -e)) / (2.0 * e);
        let trace: f64 = (0..case.x.len()).map(trace).sum();
        close(f.smoothing().unwrap().degrees_of_freedom, trace, 1e-3 * trace);
    }
}

#[test]
fn bounds_merged_data_and_few_points() {
    let (x, y) = logistic(60, 0.2, 8);
    let convex = Some(x[1..].iter().map(|x| if *x < 5.0 { 1 } else { -1 }).collect::<Vec<i8>>());
    for bounds in [[0.0, 1.0], [0.1, 0.8], [0.0, f64::INFINITY], [2.0, 3.0], [0.4, 0.4 + 1e-14]] {
        for lambda in [1e-6, 1e-3, 1.0, 1e9] {
            let convex = convex.clone();
            let options = SmoothOptions { bounds: Some(bounds), convex, ..penalty(lambda) };
            let f = smooth_monotone(&x, &y, &options).unwrap();
            assert!(f.smoothing().unwrap().converged, "{bounds:?} {lambda}");
            assert!(f.y().iter().all(|v| bounds[0] <= *v && *v <= bounds[1]));
            let z = f.seconds();
            let end = f.knots().iter().position(|k| *k >= 5.0).unwrap();
            assert!(z[..end - 2].iter().flatten().all(|z| *z >= 0.0), "{bounds:?} {lambda}");
        }
    }
    // The sign of an interval between data at one place is no one's.
    let convex = Some(vec![1, -1, 1]);
    let options = SmoothOptions { convex, ..penalty(0.1) };
    let f = smooth_monotone(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.4, 0.6, 2.0], &options).unwrap();
    assert_eq!(f.x(), [0.0, 1.0, 2.0]);
    assert!(f.seconds().iter().flatten().all(|z| *z >= 0.0));
    for signs in [vec![1], vec![-1]] {
        let options = SmoothOptions { convex: Some(signs), ..SmoothOptions::default() };
        let f = smooth_monotone(&[0.0, 1.0], &[0.0, 1.0], &options).unwrap();
        assert!((f.y()[0] - 0.0).abs() < 1e-12 && (f.y()[1] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn contradictions_are_refused_by_name() {
    let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0]);
    let message = |convex: &[i8], choice| {
        let options = SmoothOptions { convex: Some(convex.to_vec()), ..with(choice) };
        smooth_monotone(&x, &y, &options).unwrap_err().to_string()
    };
    let fixed = PenaltyChoice::Fixed(1.0);
    assert_eq!(message(&[1], fixed), "convex has 1 entries; expected 2");
    assert_eq!(message(&[1, 2], fixed), "convex[1] is 2, but every sign must be -1, 0 or 1");
    assert!(message(&[1, 0], PenaltyChoice::Fixed(0.0)).starts_with("penalty must be positive"));
}
