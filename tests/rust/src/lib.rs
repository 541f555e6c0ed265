// SPDX-License-Identifier: MIT OR Apache-2.0

//! Data for the tests that need more than one crate.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

pub mod exact;
pub mod families;
pub mod fuzz;
pub mod generate;
pub mod regular;
pub mod segments;

use std::path::Path;

use shapespline::prelude::*;

/// How many of `n` generated cases to run: all of them where the environment variable
/// `SHAPESPLINE_TESTS` is `long` (`make test-long` sets it), else a tenth.
#[must_use]
pub fn scaled(n: usize) -> usize {
    let long = std::env::var_os("SHAPESPLINE_TESTS").is_some_and(|value| value == "long");
    if long { n } else { (n / 10).max(1) }
}

/// Rows of a CSV file of `tests/data`: numbers only, comments and the header line left out.
#[must_use]
pub fn rows(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let numbers = |line: &str| line.split(',').map(|x| x.trim().parse::<f64>().ok()).collect();
    text.lines().filter(|l| !l.starts_with('#')).filter_map(numbers).collect()
}

/// Points of a CSV file with columns x, y, z.
#[must_use]
pub fn points(name: &str) -> Vec<DVec3> {
    rows(name).iter().map(|r| DVec3::from_slice(r)).collect()
}

/// The feature line of paper 001, Tables 6.1 and 6.2.
#[must_use]
pub fn feature_line() -> DataPolygon {
    let rows = rows("gm_feature_line.csv");
    let parameters = rows.iter().map(|r| r[0]).collect();
    let points = rows.iter().map(|r| DVec3::from_slice(&r[1..])).collect();
    let boundary = Boundary::tangents(
        DVec3::new(-11.038033, 801.759583, -57.116488),
        DVec3::new(-758.641754, 249.218852, -132.963858),
    );
    DataPolygon::new(points, &Parametrization::Given(parameters), boundary).unwrap()
}

/// The helix of paper 001, Example 1, with end tangents of a given length along the circles through
/// the first and the last three points.
#[must_use]
pub fn helix(tangent_length: f64) -> DataPolygon {
    let at = |k: usize| {
        let theta = std::f64::consts::FRAC_PI_3 * k as f64;
        DVec3::new(theta.cos(), theta.sin(), theta)
    };
    let points: Vec<DVec3> = (0..25).map(at).collect();
    let circle = DataPolygon::new(points.clone(), &Parametrization::Chordal, Boundary::Circular);
    let [start, end] = circle.unwrap().tangents().map(|d| d.unwrap().normalize() * tangent_length);
    let boundary = Boundary::tangents(start, end);
    DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap()
}

/// The Rust example of the project's README is run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
