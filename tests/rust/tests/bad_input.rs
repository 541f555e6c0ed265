// SPDX-License-Identifier: MIT OR Apache-2.0

//! Unusable input is refused with the argument, the place and the value.
#![allow(clippy::unwrap_used, reason = "test code")]

use shapespline::prelude::*;

fn points() -> Vec<DVec3> {
    vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)]
}

fn refused(points: Vec<DVec3>, parametrization: &Parametrization, boundary: Boundary) -> String {
    DataPolygon::new(points, parametrization, boundary).unwrap_err().to_string()
}

#[test]
fn data() {
    let with = |i: usize, p: DVec3| {
        let mut points = points();
        points[i] = p;
        points
    };
    let (chordal, natural) = (&Parametrization::Chordal, Boundary::ZeroCurvature);
    let given = |u: &[f64]| Parametrization::Given(u.to_vec());
    let tangents = |start, end| Boundary::tangents(start, end);
    let cases = [
        (refused(with(2, DVec3::new(0.0, f64::NAN, 0.0)), chordal, natural), "points[2]", "NaN"),
        (refused(with(1, DVec3::INFINITY), chordal, natural), "points[1]", "inf"),
        (refused(with(2, DVec3::X), chordal, natural), "points[2] repeats points[1]", "(1, 0, 0)"),
        (refused(with(2, DVec3::X), &given(&[0.0, 1.0, 2.0, 3.0]), natural), "points[2]", "differ"),
        (refused(points()[..1].to_vec(), chordal, natural), "points", "at least 2 points"),
        (refused(vec![], chordal, natural), "points", "got 0"),
        (refused(points()[..2].to_vec(), chordal, Boundary::Circular), "at least 3", "circular"),
        (refused(points()[..2].to_vec(), chordal, Boundary::Periodic), "at least 3", "periodic"),
        (refused(points(), chordal, Boundary::Periodic), "points[3] = points[0]", "(1, 1, 1)"),
        (refused(points(), &given(&[0.0, 1.0, 1.0, 2.0]), natural), "parameters[2] = 1", "[1] = 1"),
        (refused(points(), &given(&[0.0, 1.0, f64::NAN, 2.0]), natural), "parameters[2]", "NaN"),
        (refused(points(), &given(&[0.0, 1.0]), natural), "parameters", "length 4"),
        (refused(points(), &Parametrization::Exponent(f64::NAN), natural), "parameters", "NaN"),
        (refused(points(), chordal, tangents(DVec3::ZERO, DVec3::X)), "start tangent", "(0, 0, 0)"),
        (refused(points(), chordal, tangents(DVec3::X, DVec3::NAN)), "boundary.end", "NaN"),
        (refused(with(1, DVec3::X * 1e308 * 1.7), chordal, natural), "points[1]", "far apart"),
    ];
    for (message, place, value) in cases {
        assert!(message.contains(place) && message.contains(value), "{message}");
    }
    // Far away from the origin, and yet close to each other.
    let far = |x: f64| vec![DVec3::X * x, DVec3::new(x, 1.0, 0.0), DVec3::new(x, 1.0, 1.0)];
    assert!(DataPolygon::new(far(1e307), chordal, natural).is_ok());
    let message = refused(far(-1.5e307), chordal, natural);
    assert!(message.contains("points[0]") && message.contains("1.1e307"), "{message}");
    let message = refused(with(3, DVec3::Y * 1.2e307), chordal, natural);
    assert!(message.contains("points[3]") && message.contains("1.1e307"), "{message}");

    let planar = DataPolygon::planar(&[[0.0, 0.0], [1.0, f64::NAN]], chordal, natural);
    assert!(planar.unwrap_err().to_string().contains("points[1]"));
}

#[test]
fn tension_and_options() {
    let polygon =
        DataPolygon::new(points(), &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap();
    let tension = |t: Tension<'_>| NuSpline::new(polygon.clone(), t).unwrap_err().to_string();
    assert!(tension(Tension::Uniform(-1.0)).contains("tension must be non-negative"));
    assert!(tension(Tension::Uniform(f64::NAN)).contains("NaN"));
    assert!(tension(Tension::Nodes(&[0.0; 3])).contains("length 4"));
    assert!(tension(Tension::Nodes(&[0.0, 0.0, -2.0, 0.0])).contains("tension[2]"));
    let mut closed = points();
    closed.push(closed[0]);
    let closed = DataPolygon::new(closed, &Parametrization::Chordal, Boundary::Periodic).unwrap();
    let uneven = NuSpline::new(closed, Tension::Nodes(&[0.0, 0.0, 0.0, 0.0, 1.0])).unwrap_err();
    assert!(uneven.to_string().contains("tension[4]"), "{uneven}");

    let options = |change: fn(&mut SearchOptions)| {
        let mut options = SearchOptions::default();
        change(&mut options);
        NuSpline::shape_preserving(polygon.clone(), &options).unwrap_err().to_string()
    };
    assert!(options(|o| o.step = 0.0).contains("step"));
    assert!(options(|o| o.step = f64::NAN).contains("NaN"));
    assert!(options(|o| o.tolerances.coplanarity = 0.0).contains("coplanarity"));
    assert!(options(|o| o.tolerances.collinearity = 1.5).contains("1.5"));
    assert!(options(|o| o.tolerances.zero = -1e-9).contains("tolerance"));
    assert!(options(|o| o.max_iterations = Some(0)).contains("max_iterations"));
}
