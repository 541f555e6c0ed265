// SPDX-License-Identifier: MIT OR Apache-2.0

//! Convex and concave where the data are.
use super::*;

pub(super) fn fit(x: &[f64], y: &[f64], options: &CubicOptions) -> MonotoneCubic {
    MonotoneCubic::new(x, y, options).unwrap_or_else(|e| panic!("{e}: {x:?} {y:?} {options:?}"))
}

pub(super) fn data_options(ends: Ends, layer: f64) -> CubicOptions {
    CubicOptions { ends, layer, convex: Some(Convexity::Data), ..CubicOptions::default() }
}

pub(super) fn generator(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Integers with flats, turns and collinear points; steps over decades; rough walks; smooth data.
pub(super) fn generated(next: &mut impl FnMut() -> f64, case: usize) -> (Vec<f64>, Vec<f64>) {
    let n = 2 + (next() * 14.0) as usize;
    let (mut x, mut y) = (vec![0.0], vec![0.0]);
    for k in 0..n {
        let (step, rise) = match case % 6 {
            0 => (1.0, (next() * 4.0).floor()),
            1 => (1.0 + (next() * 3.0).floor(), (next() * 7.0).floor() - 3.0),
            2 => (1.0, (3.0 * (next() + next() + next() - 1.5)).exp()),
            3 => (0.05 + next(), next() - 0.3),
            4 => (0.2 + next(), 0.01 + next() * next()),
            _ => (10f64.powf(2.0 * next() - 1.0), 10f64.powf(4.0 * next() - 2.0)),
        };
        x.push(x[k] + step);
        y.push(y[k] + rise);
    }
    if case % 12 == 4 {
        let middle = 0.5 * x[n];
        y = x.iter().map(|x| 1.0 / (1.0 + (middle - x).exp())).collect();
    }
    if case.is_multiple_of(3) {
        y.iter_mut().for_each(|y| *y = -*y);
    }
    (x, y)
}

pub(super) fn secants(x: &[f64], y: &[f64]) -> Vec<f64> {
    (1..x.len()).map(|i| (y[i] - y[i - 1]) / (x[i] - x[i - 1])).collect()
}

/// The signs of the second differences at the points; the ends take their neighbours'.
pub(super) fn turns(s: &[f64]) -> Vec<i8> {
    let n = s.len();
    let sign = |i: usize| {
        let by = s[i] - s[i - 1];
        if by.abs() <= 1e-9 * (s[i].abs() + s[i - 1].abs()) { 0 } else { by.signum() as i8 }
    };
    let inner: Vec<i8> = (1..n).map(sign).collect();
    let mut all = vec![*inner.first().unwrap_or(&0)];
    all.extend(&inner);
    all.push(*inner.last().unwrap_or(&0));
    all
}

/// Monotone, C¹ and C², through the data, and what is stored agrees with itself.
pub(super) fn check_smooth(f: &MonotoneCubic, x: &[f64], y: &[f64], c2: bool) {
    let s = secants(x, y);
    let range = s.iter().fold(0.0f64, |a, s| a.max(s.abs()));
    for (x, y) in x.iter().zip(y) {
        assert_eq!(f.value(*x), *y);
    }
    let whole = f.to_piecewise();
    let knots = f.knots();
    let seconds = f.seconds();
    let largest = seconds.as_flattened().iter().fold(0.0f64, |a, z| a.max(z.abs()));
    for (k, w) in knots.windows(2).enumerate() {
        let i = f.segment_of_knot(k);
        let size = (y[i + 1] - y[i]).abs();
        for t in [0.2, 0.5, 0.9] {
            let at = w[0] + t * (w[1] - w[0]);
            let (a, b) = (f.value(at), whole.evaluate(at, 0, None));
            assert!(
                (a - b).abs() <= 1e-9 * size + 1e-14 * y[i].abs().max(y[i + 1].abs()),
                "{a} {b} in {i}: {x:?} {y:?}"
            );
            let slope = f.evaluate(at, 1, None);
            assert!(slope * s[i] >= 0.0, "slope {slope} in {i}");
        }
        if k > 0 {
            let [before, after] = [seconds[k - 1], seconds[k]];
            let jump = (before[1] - after[0]).abs();
            let size = before[1].abs().max(after[0].abs());
            let noise = 1e-12 * range / (w[1] - x[i]).max(1e-3 * (x[i + 1] - x[i]));
            assert!(
                !c2 || jump <= 1e-7 * size + noise + 1e-13 * largest,
                "jump {jump} of {size} at knot {k}, x = {}: {x:?} {y:?}",
                w[0]
            );
        }
    }
}

/// Samples interval i at 200 places: whether the second derivative has the sign, and the slope changes accordingly.
fn check_sign(f: &MonotoneCubic, x: &[f64], i: usize, sign: i8, about: &str) {
    let secant = (f.y()[i + 1] - f.y()[i]).abs() / (x[i + 1] - x[i]);
    let mut before = f.evaluate(x[i], 1, None);
    for k in 0..=200 {
        let at = x[i] + f64::from(k) / 200.0 * (x[i + 1] - x[i]);
        // At the ends that of the neighbour is asked where they differ.
        let second = if k == 0 || k == 200 { 0.0 } else { f.evaluate(at, 2, None) };
        assert!(second * f64::from(sign) >= 0.0, "{about}: {second} in {i}");
        let slope = f.evaluate(at, 1, None);
        let rise = (slope - before) * f64::from(sign);
        assert!(rise >= -1e-12 * (secant + slope.abs()), "{about}: slope by {rise} in {i}");
        before = slope;
    }
}

#[test]
fn no_convex_interval_of_generated_data_is_broken() {
    let mut next = generator(1);
    let mut typed = 0;
    for case in 0..500 {
        let (x, y) = generated(&mut next, case);
        let s = secants(&x, &y);
        let signs = turns(&s);
        for ends in [Ends::Estimated, Ends::Natural, Ends::Periodic] {
            let about = format!("case {case} {ends:?} {x:?} {y:?}");
            let periodic = ends == Ends::Periodic;
            let layer = if case % 5 == 4 { 0.0 } else { 1.0 / 16.0 };
            let f = fit(&x, &y, &data_options(ends.clone(), layer));
            assert!(f.diagnostics().converged, "{about}");
            assert!(f.lower_bound() <= f.bending_energy() * (1.0 + 1e-12), "{about}");
            let least = fit(&x, &y, &data_options(ends, 0.0)).bending_energy();
            assert!(f.bending_energy() <= (1.0 + 0.375 / 16.0) * least, "{about}");
            check_smooth(&f, &x, &y, layer > 0.0);
            for i in 0..s.len() {
                let end = i == 0 || i + 1 == s.len();
                if signs[i] != signs[i + 1] || signs[i] == 0 || s[i] == 0.0 || (periodic && end) {
                    continue;
                }
                typed += 1;
                check_sign(&f, &x, i, signs[i], &about);
            }
        }
    }
    assert!(typed > 2000, "{typed}");
}

#[test]
fn asked_signs_hold_or_are_refused() {
    let mut next = generator(3);
    let (mut held, mut refused) = (0, 0);
    for case in 0..600 {
        let (x, y) = generated(&mut next, case);
        let s = secants(&x, &y);
        let turning = turns(&s);
        // Half of them mostly as the data turn, the others at random.
        let mut signs = Vec::new();
        for i in 0..s.len() {
            let own = if turning[i] == turning[i + 1] { turning[i] } else { 0 };
            let any = (next() * 3.0) as i8 - 1;
            signs.push(if case.is_multiple_of(2) && next() < 0.8 { own } else { any });
        }
        for ends in [Ends::Estimated, Ends::Natural, Ends::Periodic] {
            let about = format!("case {case} {ends:?} {x:?} {y:?} {signs:?}");
            let convex = Some(Convexity::Signs(signs.clone()));
            let options = CubicOptions { ends, convex, ..CubicOptions::default() };
            match MonotoneCubic::new(&x, &y, &options) {
                Ok(f) => {
                    held += 1;
                    assert!(f.diagnostics().converged, "{about}");
                    check_smooth(&f, &x, &y, true);
                    for i in 0..s.len() {
                        if signs[i] != 0 {
                            check_sign(&f, &x, i, signs[i], &about);
                        }
                    }
                }
                Err(MonotoneError::Convex { index, value, .. }) => {
                    refused += 1;
                    assert_eq!(value, signs[index], "{about}");
                }
                Err(error) => panic!("{error}: {about}"),
            }
        }
    }
    assert!(held > 300 && refused > 300, "{held} {refused}");
}

#[test]
fn scales_and_reflections() {
    let mut next = generator(5);
    for case in 0..1000 {
        let (x, y) = generated(&mut next, case);
        let options = data_options([Ends::Natural, Ends::Estimated][case % 2].clone(), 1.0 / 16.0);
        let f = fit(&x, &y, &options);
        let scaled = |a: f64, b: f64| {
            let times = |v: &[f64], c: f64| v.iter().map(|v| c * v).collect::<Vec<_>>();
            fit(&times(&x, a), &times(&y, b), &options)
        };
        let slopes =
            |f: &MonotoneCubic, by: f64| f.slopes().iter().map(|m| by * m).collect::<Vec<_>>();
        let falling = scaled(1.0, -1.0);
        assert_eq!(falling.knots(), f.knots());
        assert_eq!(slopes(&falling, -1.0), slopes(&f, 1.0));
        let large = scaled(2f64.powi(40), 2f64.powi(-300));
        assert_eq!(large.knots().iter().map(|x| x * 2f64.powi(-40)).collect::<Vec<_>>(), f.knots());
        assert_eq!(slopes(&large, 2f64.powi(340)), slopes(&f, 1.0));
        let mirrored: Vec<f64> = x.iter().rev().map(|x| -x).collect();
        let back = fit(&mirrored, &y.iter().rev().copied().collect::<Vec<_>>(), &options);
        let range = y.iter().fold(0.0f64, |a, v| a.max((v - y[0]).abs()));
        for k in 0..=100 {
            let at = f64::from(k) / 100.0 * x[x.len() - 1];
            let off = (f.value(at) - back.value(-at)).abs() / range;
            assert!(
                off <= 1e-12,
                "case {case}: {off} at {at}, {} {} {:?}",
                f.diagnostics().iterations,
                back.diagnostics().iterations,
                f.slopes()
                    .iter()
                    .zip(back.slopes().iter().rev())
                    .map(|(a, b)| (*a, a - b))
                    .collect::<Vec<_>>()
            );
        }
    }
}

#[test]
fn what_contradicts_is_refused_by_name() {
    let refused = |x: &[f64], y: &[f64], options: &CubicOptions| {
        MonotoneCubic::new(x, y, options).unwrap_err()
    };
    let signs = |signs: &[i8]| CubicOptions {
        ends: Ends::Natural,
        convex: Some(Convexity::Signs(signs.to_vec())),
        ..CubicOptions::default()
    };
    let x = [0.0, 1.0, 2.0, 3.0];
    let concave = [0.0, 3.0, 5.0, 6.0];
    let index = |error: MonotoneError| match error {
        MonotoneError::Convex { index, value, .. } => (index, value),
        other => panic!("{other}"),
    };
    assert_eq!(index(refused(&x, &concave, &signs(&[0, 1, 1]))), (1, 1));
    assert_eq!(index(refused(&x, &concave, &signs(&[1, 1, 0]))), (0, 1));
    assert_eq!(index(refused(&x, &concave, &signs(&[0, 2, 0]))), (1, 2));
    assert!(matches!(
        refused(&x, &concave, &signs(&[0, 0])),
        MonotoneError::Length { argument: "convex", found: 2, expected: 3 }
    ));
    // Towards a turn an increasing function is concave.
    let turn = [0.0, 1.0, 2.0, 0.0];
    assert_eq!(index(refused(&x, &turn, &signs(&[0, 1, 0]))), (1, 1));
    assert!(MonotoneCubic::new(&x, &turn, &signs(&[0, -1, -1])).is_ok());
    // Slopes given against the data's convexity.
    let given = |ends: Ends, slopes: Option<Vec<f64>>| CubicOptions {
        ends,
        slopes,
        convex: Some(Convexity::Data),
        ..CubicOptions::default()
    };
    let ends = refused(&x, &concave, &given(Ends::Slopes([Some(2.0), None]), None));
    assert!(matches!(ends, MonotoneError::HeldSlope { argument: "ends", index: 0, .. }), "{ends}");
    let free = vec![f64::NAN, 3.5, f64::NAN, f64::NAN];
    let slopes = refused(&x, &concave, &given(Ends::Natural, Some(free)));
    assert!(
        matches!(slopes, MonotoneError::HeldSlope { argument: "slopes", index: 1, .. }),
        "{slopes}"
    );
    let fine = vec![f64::NAN, 2.5, f64::NAN, f64::NAN];
    let f = fit(&x, &concave, &given(Ends::Slopes([Some(3.5), Some(0.0)]), Some(fine)));
    assert_eq!(f.slopes()[..2], [3.5, 2.5]);
    (0..3).for_each(|i| check_sign(&f, &x, i, -1, "given slopes"));
}

/// A convex interval within concave data is straight; between a convex and a concave one the second derivative is 0.
#[test]
fn signs_against_the_data() {
    let x = [0.0, 1.0, 2.0, 3.0];
    let options = |signs: &[i8]| CubicOptions {
        convex: Some(Convexity::Signs(signs.to_vec())),
        ..CubicOptions::default()
    };
    let f = fit(&x, &[0.0, 3.0, 5.0, 6.0], &options(&[0, 1, 0]));
    assert!((f.value(1.25) - 3.5).abs() < 1e-14 && (f.slopes()[1] - 2.0).abs() < 1e-14);
    check_smooth(&f, &x, &[0.0, 3.0, 5.0, 6.0], true);
    let f = fit(&x, &[0.0, 1.0, 3.0, 5.0], &options(&[1, -1, 0]));
    assert_eq!(f.second_derivatives()[1], 0.0);
    assert!(f.slopes()[1] >= 2.0);
}

/// In parts, each of which is solved on its own: nothing is seen where they join.
#[test]
fn long_data() {
    let mut next = generator(6);
    for kind in 0..3 {
        let (mut x, mut y, mut slope) = (vec![0.0], vec![0.0], 0.0);
        for k in 0..9_999 {
            let h = 0.1 + next();
            slope += next();
            x.push(x[k] + h);
            y.push(y[k] + [next(), slope * h, next() - 0.4][kind]);
        }
        let f = fit(&x, &y, &data_options(Ends::Estimated, 1.0 / 16.0));
        assert!(f.diagnostics().converged && f.diagnostics().iterations <= 60);
        check_smooth(&f, &x, &y, true);
        // Two parts meet in the middle of these.
        let own = 4000..6000;
        let part =
            fit(&x[own.clone()], &y[own.clone()], &data_options(Ends::Estimated, 1.0 / 16.0));
        let (slopes, whole) = (part.slopes(), f.slopes());
        for i in 4500..5500 {
            let size = (y[i + 1] - y[i]).abs().max((y[i] - y[i - 1]).abs());
            assert!((slopes[i - 4000] - whole[i]).abs() <= 1e-10 * size, "at {i}");
        }
    }
}

/// Steps over up to forty decades, and data that are straight up to rounding: nothing is refused, overflows or falls below
/// the bound, and nearly all come to their end.
#[test]
fn wild_data() {
    let mut next = generator(77);
    let (mut open, mut count) = (0, 0);
    for case in 0..1200 {
        let sigma = [0.5, 3.0, 8.0, 14.0][case % 4];
        let mut power = |by: f64| (by * 1.7 * (next() + next() + next() + next() - 2.0)).exp();
        let (mut x, mut y, mut slope) = (vec![0.0f64], vec![0.0f64], 0.0);
        for k in 0..3 + case % 37 {
            let h = if case.is_multiple_of(3) { 1.0 } else { power(0.5 * sigma) };
            let rise = power(sigma);
            slope += rise;
            let rise = match case % 5 {
                0 => rise,
                1 => rise * if power(1.0) < 0.5 { -1.0 } else { 1.0 },
                2 => slope * h,
                3 => 1.0 + 1e-10 * power(0.5),
                _ => h * (1.0 + 1e-7 * power(0.5)),
            };
            x.push(x[k] + h);
            y.push(y[k] + rise);
        }
        if x.windows(2).any(|w| w[0] >= w[1]) {
            continue;
        }
        for ends in [Ends::Natural, Ends::Estimated, Ends::Periodic] {
            let f = fit(&x, &y, &data_options(ends, 1.0 / 16.0));
            count += 1;
            open += usize::from(!f.diagnostics().converged);
            assert!(f.bending_energy().is_finite() && f.slopes().iter().all(|m| m.is_finite()));
            assert!(f.knots().windows(2).all(|w| w[0] < w[1]));
            let range = y.iter().fold(0.0f64, |a, y| a.max(y.abs()));
            let least = x.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
            let rounding = 1e-28 * range * range / least.powi(3);
            assert!(f.lower_bound() <= f.bending_energy() * (1.0 + 1e-8) + rounding, "case {case}");
        }
    }
    assert!(count > 2500 && open * 200 <= count, "{open} of {count}");
}

/// Slopes that stay above their least, in convex data and beside level parts.
#[test]
fn slopes_have_a_floor() {
    let mut next = generator(8);
    for case in 0..100 {
        let (x, y) = generated(&mut next, case);
        let s = secants(&x, &y);
        let signs = turns(&s);
        let options = CubicOptions { min_slope: 0.3, ..data_options(Ends::Natural, 1.0 / 16.0) };
        let f = fit(&x, &y, &options);
        check_smooth(&f, &x, &y, true);
        for i in 0..s.len() {
            let level = |k: usize| k > 0 && k < s.len() && s[k - 1] * s[k] <= 0.0;
            if signs[i] == signs[i + 1] && signs[i] != 0 && s[i] != 0.0 {
                check_sign(&f, &x, i, signs[i], &format!("case {case}"));
            }
            if level(i) || level(i + 1) || s[i] == 0.0 {
                continue;
            }
            let beside = &s[i.saturating_sub(1)..(i + 2).min(s.len())];
            let least = 0.3 * beside.iter().fold(f64::INFINITY, |a, s| a.min(s.abs()));
            for k in 0..=100 {
                let at = x[i] + f64::from(k) / 100.0 * (x[i + 1] - x[i]);
                let slope = f.evaluate(at, 1, None).abs();
                assert!(slope >= least * (1.0 - 1e-12), "case {case}: {slope} in {i}");
            }
        }
    }
}

/// Steps of data over a hundred decades: the energy of the largest intervals hides what the others want. The optimum is
/// reached all the same, and is that of the reversed data; one in two hundred does not tell that it is there.
#[test]
fn a_hundred_decades_are_no_obstacle() {
    let (mut next, mut failed) = (generator(8), 0);
    for case in 0..800usize {
        let n = 2 + (next() * 30.0) as usize;
        let mut steps: Vec<f64> = (0..n).map(|_| 10f64.powf(100.0 * (next() - 0.5))).collect();
        if case % 3 == 1 {
            steps.sort_by(f64::total_cmp);
        }
        let (mut x, mut y, mut slope) = (vec![0.0], vec![0.0], 0.0);
        for (k, step) in steps.iter().enumerate() {
            let h = if case.is_multiple_of(2) { 1.0 } else { 10f64.powf(4.0 * next() - 2.0) };
            slope = if case % 3 == 0 { slope + step } else { *step };
            x.push(x[k] + h);
            y.push(y[k] + slope * h);
        }
        let options = data_options([Ends::Natural, Ends::Estimated][case % 2].clone(), 0.0);
        let f = fit(&x, &y, &options);
        let mirrored: Vec<f64> = x.iter().rev().map(|x| -x).collect();
        let back = fit(&mirrored, &y.iter().rev().copied().collect::<Vec<_>>(), &options);
        let (a, b) = (f.bending_energy(), back.bending_energy());
        failed += usize::from(!(f.diagnostics().converged && back.diagnostics().converged));
        assert!((a - b).abs() <= 1e-6 * a, "case {case}: {a} {b}");
    }
    assert!(failed <= 4, "{failed}");
}
