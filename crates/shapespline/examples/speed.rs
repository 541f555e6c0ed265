// SPDX-License-Identifier: MIT OR Apache-2.0

//! Times building and evaluating the families: nanoseconds a point, the best of several runs.
//!
//! ```sh
//! cargo run --release -p shapespline --example speed
//! ```

use std::{error::Error, hint::black_box, time::Instant};

use shapespline::prelude::*;

/// Nanoseconds for each of `count` things, the best of some runs.
fn best<T>(count: usize, mut work: impl FnMut() -> T) -> f64 {
    let run = |_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64() * 1e9 / count as f64
    };
    (0..9).map(run).fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), Box<dyn Error>> {
    let n = 1_000_000;
    let at = |k: usize| {
        let t = 0.1 * k as f64;
        DVec3::new(t.cos() + 0.3 * (2.7 * t).sin(), t.sin(), 0.03 * t + 0.2 * (1.3 * t).cos())
    };
    let points: Vec<DVec3> = (0..n).map(at).collect();
    let make =
        || DataPolygon::new(points.clone(), &Parametrization::Centripetal, Boundary::ZeroCurvature);
    let polygon = make()?;
    println!("{n} points; ns a point, best of 9");
    let time = best(n, || make().map(|_| ()));
    println!("{:<44}{time:>8.1}", "data polygon");

    let copy = best(n, || polygon.clone());
    println!("{:<44}{copy:>8.1}", "(copy of it, taken off below)");
    let nu = best(n, || NuSpline::new(polygon.clone(), Tension::Uniform(1.0))) - copy;
    println!("{:<44}{nu:>8.1}", "ν-spline");
    let manni = best(n, || TensionSpline::new(polygon.clone(), TangentScale::Uniform(0.7))) - copy;
    println!("{:<44}{manni:>8.1}  {:.2} × ν", "tension spline", manni / nu);
    let none = Tension::Uniform(0.0);
    let plain = best(n, || CatmullRom::new(polygon.clone(), none, Continuity::C1)) - copy;
    println!("{:<44}{plain:>8.1}", "Catmull–Rom");
    let options = HandleOptions::default();
    let kept = best(n, || CatmullRom::shape_preserving(polygon.clone(), &options)) - copy;
    println!("{:<44}{kept:>8.1}", "Catmull–Rom, shape-preserving");
    let search = SearchOptions::default();
    let calls = best(n, || search.checker(&polygon).map(|_| ()));
    println!("{:<44}{calls:>8.1}", "  of it: what the polygon requires");
    let checker = search.checker(&polygon)?;
    let curve = CatmullRom::shape_preserving(polygon.clone(), &options)?.curve;
    let legs = curve.curve().legs();
    let check = best(n, || checker.all_unproved(|i| legs[i]));
    println!("{:<44}{check:>8.1}", "  of it: the check");
    let report = best(n, || checker.report_of(&[], |i| legs[i]));
    println!("{:<44}{report:>8.1}", "  of it: the report's counts");
    let whole = best(n, || CatmullRom::shape_preserving(make().ok()?, &options).ok());
    println!("{:<44}{whole:>8.1}", "  from the points on");

    let lambda: Vec<f64> = (0..n).map(|k| if k % 3 == 0 { 0.2 } else { 0.9 }).collect();
    let spline = TensionSpline::new(polygon.clone(), TangentScale::Nodes(&lambda))?;
    let (curve, knots) = (spline.curve(), polygon.parameters());
    let last = knots[n - 1];
    for (name, stride) in [("sorted", 1), ("unsorted", 7_919_333)] {
        let queries: Vec<f64> =
            (0..n).map(|k| last * ((k * stride) % n) as f64 / n as f64).collect();
        let t = best(n, || curve.cubic().evaluate_many(&queries, 0, Side::Right));
        println!("{:<44}{t:>8.1}", format!("evaluation, local parameter, {name}"));
        let s = best(n, || curve.evaluate_many(&queries, 0, Side::Right));
        println!("{:<44}{s:>8.1}  {:.2} × local", format!("evaluation in s, {name}"), s / t);
    }

    let small = DataPolygon::new(
        points[..40].to_vec(),
        &Parametrization::Centripetal,
        Boundary::ZeroCurvature,
    )?;
    let spline = TensionSpline::new(small, TangentScale::Nodes(&lambda[..40]))?;
    let last = spline.curve().cubic().knots()[39];
    let queries: Vec<f64> = (0..n).map(|k| last * k as f64 / n as f64).collect();
    let cubic = spline.curve().cubic();
    let t = best(n, || cubic.evaluate_many(&queries, 0, Side::Right));
    println!("{:<44}{t:>8.1}", "evaluation, local parameter, 40 points");
    let s = best(n, || spline.curve().evaluate_many(&queries, 0, Side::Right));
    println!("{:<44}{s:>8.1}  {:.2} × local", "evaluation in s, 40 points", s / t);

    let offsets: Vec<usize> = (0..=300).map(|k| k * 55).collect();
    let rows = Collection {
        points: Ragged::new(&points[..300 * 55], &offsets)?,
        dimension: Dimension::Three,
        parametrization: Parametrization::Centripetal,
        boundary: Boundary::ZeroCurvature,
        closed: false,
        repeated: Repeated::Error,
    };
    let tension = TensionSpline::options();
    let many = [
        best(300, || fit_many(&rows, None, |p| NuSpline::shape_preserving(p, &search))),
        best(300, || fit_many(&rows, None, |p| TensionSpline::shape_preserving(p, &tension))),
        best(300, || fit_many(&rows, None, |p| CatmullRom::shape_preserving(p, &options))),
    ];
    for (name, time) in ["ν-spline", "tension spline", "Catmull–Rom"].iter().zip(many) {
        println!(
            "{:<44}{:>8.1} µs a curve",
            format!("fit_many, 300 × 55 points, {name}"),
            time / 1e3
        );
    }
    Ok(())
}
