// SPDX-License-Identifier: MIT OR Apache-2.0

//! Fits points from a CSV file (`x,y,z` a line) and prints what the C² cubic spline does to their
//! shape, and what the shape-preserving ν-spline needs to keep it.
//!
//! ```sh
//! cargo run --release --example keep_shape -- tests/data/gps_mojstrovka.csv
//! ```

use std::error::Error;

use shapespline::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: keep_shape POINTS.csv")?;
    let points = read(&path)?;
    let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;

    let cubic = NuSpline::new(polygon.clone(), Tension::Uniform(0.0))?;
    println!("C² cubic spline: {}", cubic.check(Criteria::DEFAULT, Tolerances::default())?);

    let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default())?;
    println!("ν-spline: {}", fit.report);
    println!("{:?}", fit.outcome.diagnostics);
    Ok(())
}

/// Points of a file whose lines are three numbers; other lines (comments, a header) are passed over.
fn read(path: &str) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
    let point = |line: &str| {
        let numbers: Option<Vec<f64>> = line.split(',').map(|x| x.trim().parse().ok()).collect();
        numbers.filter(|n| n.len() == 3).map(|n| DVec3::from_slice(&n))
    };
    Ok(text.lines().filter_map(point).collect())
}
