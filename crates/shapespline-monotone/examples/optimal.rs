// SPDX-License-Identifier: MIT OR Apache-2.0

//! Optimal slopes on data of many kinds: steps, certified gaps and build times.
//! `cargo run --release -p shapespline-monotone --example optimal [points] [sets]`.

use shapespline_monotone::*;
use std::hint::black_box;
use std::time::Instant;

struct Rng(u64);

impl Rng {
    /// In [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let x = self.0 ^ (self.0 >> 29);
        (x.wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 11) as f64 / (1u64 << 53) as f64
    }
    fn exponential(&mut self) -> f64 {
        -(1.0 - self.next()).ln()
    }
    /// exp of a normal number of this standard deviation.
    fn lognormal(&mut self, sigma: f64) -> f64 {
        let radius = (2.0 * self.exponential()).sqrt();
        (sigma * radius * (std::f64::consts::TAU * self.next()).cos()).exp()
    }
}

type Step = fn(&mut Rng) -> (f64, f64);

/// Names and steps (Δx, Δy).
const KINDS: [(&str, Step); 12] = [
    ("uniform y on a grid", |r| (1.0, r.next())),
    ("uniform, x from 0.1", |r| (0.1 + r.next(), r.next())),
    ("uniform in both", |r| (r.next(), r.next())),
    ("exponential in both", |r| (r.exponential(), r.exponential())),
    ("exponential on a grid", |r| (1.0, r.exponential())),
    ("lognormal 1 in both", |r| (r.lognormal(1.0), r.lognormal(1.0))),
    ("lognormal 1 and 2", |r| (r.lognormal(1.0), r.lognormal(2.0))),
    ("lognormal 3 on a grid", |r| (1.0, r.lognormal(3.0))),
    ("lognormal 5 on a grid", |r| (1.0, r.lognormal(5.0))),
    ("twelve decades", |r| (10f64.powf(2.0 * r.next() - 1.0), 10f64.powf(12.0 * r.next() - 6.0))),
    ("not monotone", |r| (0.1 + r.next(), r.next() - 0.5)),
    ("with flats", |r| (0.1 + r.next(), if r.next() < 0.2 { 0.0 } else { r.next() })),
];

fn main() {
    let argument = |k: usize, default: usize| {
        std::env::args().nth(k).and_then(|a| a.parse().ok()).unwrap_or(default)
    };
    let (n, sets) = (argument(1, 20).max(2), argument(2, 200).max(1));
    println!("{sets} sets of {n} points");
    println!(
        "{:>22} {:>12} {:>6} {:>5} {:>9} {:>9}",
        "steps (x, y)", "ns a point", "steps", "most", "gap", "certified"
    );
    for (name, step) in KINDS {
        let mut rng = Rng(7);
        let (mut steps, mut most, mut gap, mut within, mut spent) = (0, 0, 0.0f64, 0, 0.0);
        for _ in 0..sets {
            let (mut x, mut y) = (vec![0.0], vec![0.0]);
            for k in 1..n {
                let (dx, dy) = step(&mut rng);
                x.push(x[k - 1] + dx.max(1e-9));
                y.push(y[k - 1] + dy);
            }
            let start = Instant::now();
            let made = black_box(MonotoneQuintic::new(&x, &y, &QuinticOptions::default()));
            spent += start.elapsed().as_secs_f64();
            let Ok(made) = made else { continue };
            let found = made.diagnostics();
            steps += found.iterations;
            most = most.max(found.iterations);
            gap = gap.max(found.kkt_residual);
            within += usize::from(found.converged && found.solver == SolverKind::InteriorPoint);
        }
        println!(
            "{name:>22} {:>12.0} {:>6.1} {most:>5} {gap:>9.1e} {:>8.1}%",
            1e9 * spent / (n * sets) as f64,
            steps as f64 / sets as f64,
            100.0 * within as f64 / sets as f64
        );
    }
}
