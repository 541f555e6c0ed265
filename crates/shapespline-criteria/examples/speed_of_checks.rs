// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a check costs a segment, best of several, on one core:
//! `RAYON_NUM_THREADS=1 cargo run --release -p shapespline-criteria --example speed_of_checks`.

use std::time::Instant;

use shapespline_criteria::{
    Criteria, Tolerances, check, check_curve, curve_inflections, polygon_inflections,
};
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Dimension, Parametrization, PiecewiseBezier,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n = 1_000_000;
    // A smooth track that bends, twists and inflects.
    let point = |k: usize| {
        let t = 0.1 * k as f64;
        DVec3::new(t.cos() * (2.0 + (0.21 * t).sin()), t.sin(), 0.3 * t + 0.4 * (0.5 * t).cos())
    };
    let points: Vec<DVec3> = (0..=n).map(point).collect();
    let natural = Boundary::ZeroCurvature;
    let polygon = DataPolygon::new(points.clone(), &Parametrization::Uniform, natural)?;
    let tangent = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(n));
        (points[after] - points[before]) / (3 * (after - before)) as f64
    };
    let legs: Vec<[DVec3; 2]> = (0..n).map(|i| [tangent(i), tangent(i + 1)]).collect();
    let bezier = |i: usize| {
        let ([a, c], p, q) = (legs[i], points[i], points[i + 1]);
        [p, p + a, q - c, q]
    };
    let time = |name: &str, segments: usize, run: &dyn Fn() -> String| {
        let mut best = f64::INFINITY;
        let mut said = String::new();
        for _ in 0..7 {
            let start = Instant::now();
            said = run();
            best = best.min(start.elapsed().as_secs_f64());
        }
        println!("{name:<44}{:>9.1} ns a segment  {said}", best * 1e9 / segments as f64);
    };
    let tolerances = Tolerances::default();
    for (name, criteria) in [("default", Criteria::DEFAULT), ("all", Criteria::ALL)] {
        time(&format!("cubic legs, {name} criteria"), n, &|| {
            let report = check(&polygon, |i| legs[i], criteria, tolerances);
            format!("{} violations", report.violations.len())
        });
    }
    let control: Vec<DVec3> = (0..n).flat_map(bezier).collect();
    let three = Dimension::Three;
    let curve = PiecewiseBezier::new(polygon.parameters().to_vec(), &control, 3, three)?;
    time("cubic as Bézier points, default criteria", n, &|| {
        let report = check_curve(&polygon, &curve, Criteria::DEFAULT, tolerances);
        report.map_or_else(|e| e.to_string(), |r| format!("{} violations", r.violations.len()))
    });

    // The same track in quintics: a tenth of a percent of it.
    let m = 1000;
    let few = DataPolygon::new(points[..=m].to_vec(), &Parametrization::Uniform, natural)?;
    let raise = |p: Vec<DVec3>| -> Vec<DVec3> {
        let k = p.len();
        let part = |i: usize, s: f64| if s > 0.0 { p[i] * s } else { DVec3::ZERO };
        (0..=k)
            .map(|i| (i, i as f64 / k as f64))
            .map(|(i, s)| part(i.saturating_sub(1), s) + part(i.min(k - 1), 1.0 - s))
            .collect()
    };
    let quintic: Vec<DVec3> = (0..m).flat_map(|i| raise(raise(bezier(i).to_vec()))).collect();
    let quintic = PiecewiseBezier::new(few.parameters().to_vec(), &quintic, 5, three)?;
    time("quintics, default criteria", m, &|| {
        let report = check_curve(&few, &quintic, Criteria::DEFAULT, tolerances);
        report.map_or_else(
            |e| e.to_string(),
            |r| format!("{} violations, {} undecided", r.violations.len(), r.undecided.len()),
        )
    });
    let part = few.parameters().to_vec();
    let cubic = PiecewiseBezier::new(part, &control[..4 * m], 3, three)?;
    time("inflections of a cubic of 1,000 pieces", m, &|| {
        let count = curve_inflections(&cubic);
        format!("{} inflections, exact: {}", count.count, count.exact)
    });
    time("inflections of a polygon of 1,000 points", m, &|| {
        polygon_inflections(&points[..=m], three)
            .map_or_else(|e| e.to_string(), |c| format!("{} inflections", c.count))
    });
    Ok(())
}
