// SPDX-License-Identifier: MIT OR Apache-2.0

//! Data for the tests: the paper's neighbours' sets and random ones.
#![allow(dead_code, clippy::unwrap_used)]

use shapespline_monotone::*;

/// A two-column file of tests/data.
pub(crate) fn csv(name: &str) -> (Vec<f64>, Vec<f64>) {
    let path = format!("{}/../../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .filter(|l| !l.starts_with('#') && !l.starts_with('x'))
        .map(|l| {
            let (x, y) = l.split_once(',').unwrap();
            (x.trim().parse::<f64>().unwrap(), y.trim().parse::<f64>().unwrap())
        })
        .unzip()
}

/// One interpolant of each family.
pub(crate) fn fits(x: &[f64], y: &[f64], extrapolate: Extrapolation) -> Vec<MonotoneSpline> {
    let q = QuarticOptions { extrapolate, ..QuarticOptions::default() };
    let make = |slopes| {
        let o = QuinticOptions { extrapolate, slopes, ..QuinticOptions::default() };
        MonotoneQuintic::new(x, y, &o).unwrap().spline().clone()
    };
    vec![
        MonotoneQuartic::new(x, y, &q).unwrap().spline().clone(),
        make(Slopes::FritschButland),
        make(Slopes::Optimal),
    ]
}

/// A small generator, the same numbers on every machine.
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        let mut rng = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x1234_5678_9ABC_DEF0);
        for _ in 0..4 {
            rng.next();
        }
        rng
    }
    /// In [0, 1).
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let x = self.0 ^ (self.0 >> 29);
        (x.wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 11) as f64 / (1u64 << 53) as f64
    }
    pub(crate) fn index(&mut self, n: usize) -> usize {
        ((self.next() * n as f64) as usize).min(n - 1)
    }
}

/// Monotone data of n points: steps of x over `x_decades`, of y over `y_decades`, repeats with probability
/// `repeats`.
pub(crate) fn monotone(
    rng: &mut Rng,
    n: usize,
    x_decades: f64,
    y_decades: f64,
    repeats: f64,
) -> (Vec<f64>, Vec<f64>) {
    let (mut x, mut y) = (vec![rng.next() - 0.5], vec![rng.next() - 0.5]);
    while x.len() < n {
        let (a, b) = (x[x.len() - 1], y[y.len() - 1]);
        let step = (0.1 + rng.next()) * 10f64.powf(x_decades * (rng.next() - 0.5));
        let next = a + step;
        x.push(if next > a { next } else { a.next_up() });
        let rise = rng.next() * 10f64.powf(y_decades * (rng.next() - 0.5));
        y.push(if rng.next() < repeats { b } else { b + rise });
    }
    (x, y)
}
