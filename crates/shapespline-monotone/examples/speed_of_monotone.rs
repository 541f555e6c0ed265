// SPDX-License-Identifier: MIT OR Apache-2.0

//! Build and evaluation times: `cargo run --release -p shapespline-monotone --example speed_of_monotone`.
//!
//! The peer, SciPy's `PchipInterpolator`, is timed by `tests/bench/pchip.py` in the same units.

use shapespline_monotone::*;
use std::hint::black_box;
use std::time::Instant;

fn time(mut run: impl FnMut(), least: f64) -> f64 {
    let mut best = f64::INFINITY;
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < least {
        let t = Instant::now();
        run();
        best = best.min(t.elapsed().as_secs_f64());
    }
    best
}

fn main() {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    println!(
        "{:>8} {:>14} {:>14} {:>14}   build, ns a point",
        "N", "quartic", "fritsch-b.", "optimal"
    );
    for n in [5usize, 20, 1000, 10_000, 1_000_000] {
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for k in 1..n {
            x.push(x[k - 1] + 0.1 + next());
            y.push(y[k - 1] + next());
        }
        let per = 1e9 / n as f64;
        let quartic =
            time(|| drop(black_box(MonotoneQuartic::new(&x, &y, &QuarticOptions::default()))), 0.4)
                * per;
        let with = |slopes| QuinticOptions { slopes, ..QuinticOptions::default() };
        let fb = with(Slopes::FritschButland);
        let paper = time(|| drop(black_box(MonotoneQuintic::new(&x, &y, &fb))), 0.4) * per;
        let best = with(Slopes::Optimal);
        let optimal = time(|| drop(black_box(MonotoneQuintic::new(&x, &y, &best))), 0.2) * per;
        let made = MonotoneQuintic::new(&x, &y, &best);
        let steps = made.as_ref().map_or(0, |f| f.diagnostics().iterations);
        println!("{n:>8} {quartic:>14.1} {paper:>14.1} {optimal:>14.1}   {steps} steps");
        if n < 1000 {
            continue;
        }
        let Ok(f) = MonotoneQuintic::new(&x, &y, &fb) else { continue };
        let m = 1_000_000;
        let mut q: Vec<f64> = (0..m).map(|_| x[0] + (x[n - 1] - x[0]) * next()).collect();
        let mut out = vec![0.0; m];
        let per = 1e9 / m as f64;
        let unsorted = time(|| f.evaluate_into(&q, 0, None, black_box(&mut out)), 0.3) * per;
        let mut values = out.clone();
        let inverse_u = time(|| drop(f.inverse_into(&values, black_box(&mut out))), 0.3) * per;
        q.sort_by(f64::total_cmp);
        values.sort_by(f64::total_cmp);
        let sorted = time(|| f.evaluate_into(&q, 0, None, black_box(&mut out)), 0.3) * per;
        let inverse_s = time(|| drop(f.inverse_into(&values, black_box(&mut out))), 0.3) * per;
        let pool =
            rayon_one(|| time(|| f.evaluate_into(&q, 0, None, black_box(&mut out)), 0.3) * per);
        println!(
            "         ns a query: unsorted {unsorted:.1}, sorted {sorted:.1} ({pool:.1} on one thread); inverse {inverse_u:.1}, {inverse_s:.1}"
        );
    }
    let (columns, n) = (10_000, 20);
    let x: Vec<f64> = (0..n).map(|k| k as f64).collect();
    let mut y = vec![0.0; columns * n];
    for c in y.chunks_mut(n) {
        let mut sum = 0.0;
        c.iter_mut().for_each(|v| {
            sum += next();
            *v = sum;
        });
    }
    for slopes in [Slopes::FritschButland, Slopes::Optimal] {
        let name = format!("{slopes:?}");
        let options = QuinticOptions { slopes, ..QuinticOptions::default() };
        let t = time(|| drop(black_box(fit_columns::<MonotoneQuintic>(&x, &y, &options))), 0.5);
        println!("10,000 columns of 20 points, {name}: {:.2} ms", 1e3 * t);
    }
}

fn rayon_one<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(run),
        Err(_) => run(),
    }
}
