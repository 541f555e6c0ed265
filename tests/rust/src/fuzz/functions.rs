// SPDX-License-Identifier: MIT OR Apache-2.0

//! Functions of one variable.

use shapespline::monotone::{
    BezierLike, Continuation, Extrapolation, Fairness, MonotoneError, MonotoneMany,
    MonotoneQuartic, MonotoneQuintic, QuarticOptions, QuinticOptions, ShapeParameters, Slopes,
    bezier_like::cubic_basis,
};

use super::{Bytes, readable};

/// Monotone quartics and quintics with all kinds of slopes and extrapolation, and Bézier-like curves. A
/// function passes through its data to the bit, stays between neighbouring values, does not turn
/// between them, survives being written and read, and answers every question of its calculus.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let kind = bytes.below(8);
    if kind == 0 {
        return curve(&mut bytes);
    }
    let n = bytes.below(20) + 1;
    let x = bytes.increasing(n);
    let y = ordinates(&mut bytes, n);
    let extrapolate = extrapolation(&mut bytes);
    let slopes = slopes(&mut bytes, n);
    if kind < 4 {
        let shape = if bytes.below(3) == 0 {
            let mut entries = || (1..n).map(|_| bytes.unscaled().abs()).collect();
            ShapeParameters::Segments { alpha: entries(), beta: entries() }
        } else {
            ShapeParameters::Uniform(if bytes.flag() { 3.0 } else { bytes.unscaled() })
        };
        let options = QuarticOptions { slopes, shape, extrapolate };
        judge(&mut bytes, &x, &y, MonotoneQuartic::new(&x, &y, &options));
    } else {
        let fairness = if bytes.flag() { Fairness::Bending } else { Fairness::Parametric };
        let options = QuinticOptions { slopes, fairness, clip: bytes.flag(), extrapolate };
        let made = MonotoneQuintic::new(&x, &y, &options);
        if let Ok(quintic) = &made {
            let diagnostics = quintic.diagnostics();
            assert!(diagnostics.certified, "{diagnostics:?}");
            assert!(!diagnostics.energy.is_nan() && diagnostics.energy >= 0.0, "{diagnostics:?}");
        }
        judge(&mut bytes, &x, &y, made);
    }
}

fn ordinates(bytes: &mut Bytes<'_>, n: usize) -> Vec<f64> {
    match bytes.below(4) {
        0 => bytes.numbers(n),
        1 => bytes.increasing(n).into_iter().map(|y| -y).collect(),
        _ => bytes.increasing(n),
    }
}

fn slopes(bytes: &mut Bytes<'_>, n: usize) -> Slopes {
    match bytes.below(4) {
        0 => Slopes::FritschButland,
        1 => {
            let n = if bytes.below(16) == 0 { bytes.below(n + 2) } else { n };
            Slopes::Given((0..n).map(|_| bytes.unscaled()).collect())
        }
        _ => Slopes::Optimal,
    }
}

fn extrapolation(bytes: &mut Bytes<'_>) -> Extrapolation {
    let below = continuation(bytes);
    let above = if bytes.flag() { below } else { continuation(bytes) };
    Extrapolation { below, above }
}

fn continuation(bytes: &mut Bytes<'_>) -> Continuation {
    match bytes.below(7) {
        0 => Continuation::Nan,
        1 => Continuation::Taylor(1),
        2 => Continuation::Taylor(0),
        3 => Continuation::Taylor(bytes.byte().into()),
        4 => Continuation::Zero,
        5 => Continuation::Periodic(0),
        _ => Continuation::Polynomial,
    }
}

fn judge<F>(bytes: &mut Bytes<'_>, x: &[f64], y: &[f64], made: Result<F, MonotoneError>)
where
    F: MonotoneMany + serde::Serialize + serde::de::DeserializeOwned,
{
    let fit = match made {
        Ok(fit) => fit,
        Err(error) => return readable(&error),
    };
    let f = fit.function();
    let n = x.len();
    for i in 0..n {
        assert_eq!(f.value(x[i]), y[i], "at x[{i}] = {}", x[i]);
        assert!(!f.slopes()[i].is_nan(), "slope {i}");
    }
    for i in 0..n - 1 {
        let (low, high) = (y[i].min(y[i + 1]), y[i].max(y[i + 1]));
        let mut last = y[i];
        for k in 1..8 {
            let q = x[i] + (x[i + 1] - x[i]) * (f64::from(k) / 8.0);
            let value = f.value(q);
            assert!(low <= value && value <= high, "{value} at {q} leaves [{low}, {high}]");
            // As far as rounding lets a value tell.
            let slack = 8.0 * f64::EPSILON * (low.abs().max(high.abs()) + (high - low));
            let back = if y[i] <= y[i + 1] { last - value } else { value - last };
            assert!(back <= slack, "it turns by {back} at {q}");
            last = value;
        }
    }
    let stored: F = postcard::from_bytes(&postcard::to_stdvec(&fit).unwrap()).unwrap();
    let mut queries = vec![x[0], x[n - 1], f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    queries.extend((0..4).map(|_| x[0] + bytes.fraction() * (x[n - 1] - x[0])));
    queries.extend((0..4).map(|_| bytes.number()));
    for &q in &queries {
        for nu in 0..7 {
            let other = if bytes.flag() { None } else { Some(extrapolation(bytes)) };
            let [a, b] = [f, stored.function()].map(|f| f.evaluate(q, nu, other).to_bits());
            assert_eq!(a, b, "order {nu} at {q} after being stored");
        }
    }
    calculus(bytes, f, &queries);
}

fn calculus(bytes: &mut Bytes<'_>, f: &shapespline::monotone::MonotoneSpline, queries: &[f64]) {
    let (x, y) = (f.x(), f.y());
    let mode = Some(extrapolation(bytes));
    let [derivative, antiderivative] = [f.derivative(1), f.antiderivative(1)];
    let _ = (f.derivative(bytes.below(9)), f.antiderivative(bytes.below(4)));
    for &q in queries {
        let _ = derivative.evaluate(q, bytes.below(3), mode);
        let _ = antiderivative.evaluate(q, bytes.below(3), mode);
        let _ = f.integrate(q, queries[bytes.below(queries.len())], mode);
    }
    let size = y.iter().fold(0.0f64, |m, y| m.max(y.abs()));
    let steepest = derivative.coefficients().iter().fold(0.0f64, |m, d| m.max(d.abs()));
    let level = y[bytes.below(y.len())] * bytes.fraction();
    let grown = |s: f64| {
        let n = x.len() - 1;
        let out = ((x[0] - s) / (x[1] - x[0])).max((s - x[n]) / (x[n] - x[n - 1])).max(0.0);
        (1.0 + out).powi(5)
    };
    for mode in [None, mode, Some(Extrapolation::NAN)] {
        let value = |s| f.evaluate(s, 0, mode);
        let slope = |s| derivative.evaluate(s, 0, mode);
        solutions(value, level, &f.solve(level, mode), |s| size * grown(s));
        solutions(value, 0.0, &f.roots(mode), |s| size * grown(s));
        solutions(slope, 0.0, &derivative.roots(mode), |s| steepest * grown(s));
    }
    let inside = f.solve(level, Some(Extrapolation::NAN)).into_iter().filter(|s| !s.is_nan());
    inside.for_each(|s| assert!(s >= x[0] && s <= x[x.len() - 1], "{s} outside"));
    let [first, last] = [y[0], y[y.len() - 1]];
    // Rounding may lead beyond the last value, where there is no answer.
    let level =
        (first + (last - first) * bytes.fraction()).max(first.min(last)).min(first.max(last));
    match f.inverse(level) {
        // Halfway between values that overflow there is nothing to look for.
        Ok(s) => assert!(level.is_infinite() || (x[0] <= s && s <= x[x.len() - 1]), "{level}: {s}"),
        Err(error) => readable(&error),
    }
}

/// Every solution is one, as well as a neighbouring x can say; `size` is that of the terms of f.
fn solutions(f: impl Fn(f64) -> f64, level: f64, found: &[f64], size: impl Fn(f64) -> f64) {
    for s in found.iter().filter(|s| !s.is_nan()) {
        let around = [s.next_down(), *s, s.next_up()].map(&f);
        let slack = (1e-9 * size(*s)).max(1e-320);
        let near = around.iter().any(|v| (v - level).abs() <= slack);
        // On a cliff neighbouring numbers have values on both sides.
        let jump = around.windows(2).any(|v| v[0].min(v[1]) <= level && level <= v[0].max(v[1]));
        assert!(near || jump, "f({s:e}) = {around:?}, not {level}");
    }
}

fn curve(bytes: &mut Bytes<'_>) {
    let p = [bytes.unscaled(), bytes.unscaled(), bytes.unscaled(), bytes.unscaled()];
    let like = match bytes.below(3) {
        0 => BezierLike::Cubic { a: p[0], b: p[1] },
        1 => BezierLike::Quartic { a: p[0], q: p[1], alpha: p[2], beta: p[3] },
        _ => BezierLike::Quintic { a: p[0], g: p[1], alpha: p[2], beta: p[3] },
    };
    let n = bytes.below(16);
    let control = bytes.numbers(n);
    let parameters = [0.0, 1.0, bytes.fraction(), bytes.unscaled(), f64::NAN];
    for nu in 0..8 {
        match like.evaluate(&control, &parameters, nu) {
            Ok(values) => assert_eq!(values.len(), control.len() / 4 * parameters.len()),
            Err(error) => readable(&error),
        }
    }
    let t = bytes.fraction();
    let sum: f64 = like.basis(t).iter().sum();
    let size = p.iter().fold(1.0f64, |m, p| m.max(p.abs()));
    // The weights of points sum to one, whatever the parameters.
    assert!((sum - 1.0).abs() <= 1e-12 * size * size || !(size * size).is_finite() || sum.is_nan());
    if like.is_positive() {
        assert!(like.basis(t).iter().all(|w| *w >= -1e-12), "{like:?} at {t}");
    }
    let _ = cubic_basis(t, p[0], p[1]);
}
