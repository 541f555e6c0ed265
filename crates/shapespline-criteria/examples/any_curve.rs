// SPDX-License-Identifier: MIT OR Apache-2.0

//! Does somebody else's curve keep the shape of these points? A cubic B-spline through a small
//! helix, its inflections, and what the points themselves say:
//! `cargo run -p shapespline-criteria --example any_curve`.

use shapespline_criteria::{
    Criteria, CurveChecker, INTERPOLATION, Tolerances, curve_inflections, polygon_inflections,
    polygon_shape,
};
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Dimension, Parametrization, PiecewiseBezier,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let turn = |k: i32| {
        let t = 0.8 * f64::from(k);
        DVec3::new(t.cos(), t.sin(), 0.25 * t)
    };
    let control: Vec<DVec3> = (0..10).map(turn).collect();
    let knots: Vec<f64> = (0..14).map(f64::from).collect();
    let curve = PiecewiseBezier::from_bspline(&knots, &control, 3, Dimension::Three)?;

    // Its own values at places that are no knots are the points.
    let u: Vec<f64> = (0..7).map(|i| 3.2 + 1.1 * f64::from(i)).collect();
    let points: Vec<DVec3> = u.iter().map(|&u| curve.position(u)).collect();
    let given = Parametrization::Given(u);
    let polygon = DataPolygon::new(points.clone(), &given, Boundary::ZeroCurvature)?;

    let shape = polygon_shape(&polygon, &Tolerances::default());
    for (i, required) in shape.required.iter().enumerate() {
        let names: Vec<&str> = required.iter().map(|c| c.name()).collect();
        println!("segment {i}: torsion {:>6.3}, requires {}", shape.torsion[i], names.join(", "));
    }
    let checker =
        CurveChecker::new(&polygon, &curve, Criteria::ALL, Tolerances::default(), INTERPOLATION)?;
    println!("\n{}", checker.report());
    println!("polygon: {:?}", polygon_inflections(&points, Dimension::Three)?);
    println!("curve:   {:?}", curve_inflections(&curve));
    Ok(())
}
