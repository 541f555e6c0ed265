// SPDX-License-Identifier: MIT OR Apache-2.0

//! Moving the data moves the curve, and nothing else.
#![allow(clippy::unwrap_used, reason = "test code")]

use shapespline::prelude::*;
use shapespline_tests::{
    families::Family,
    feature_line,
    generate::{PolygonKind, Random, polygon},
    helix, points, scaled,
};

fn sets() -> Vec<DataPolygon> {
    let chordal =
        |points, boundary| DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
    let mut random = Random::new(21);
    let mut sets = vec![
        feature_line(),
        helix(6.0),
        chordal(points("protein_1a8o_ca.csv"), Boundary::Circular),
        chordal(points("coil_m16n08_first.csv"), Boundary::Periodic),
    ];
    for kind in [
        PolygonKind::Walk,
        PolygonKind::Planar,
        PolygonKind::Track,
        PolygonKind::Walk,
        PolygonKind::Track,
    ] {
        sets.push(chordal(kind.points(30, &mut random), Boundary::ZeroCurvature));
    }
    sets
}

/// The polygon of moved points and tangents at moved parameters.
fn moved(
    polygon: &DataPolygon,
    point: impl Fn(DVec3) -> DVec3,
    tangent: impl Fn(DVec3) -> DVec3,
    parameter: impl Fn(f64) -> f64,
    reverse: bool,
) -> DataPolygon {
    let mut points: Vec<DVec3> = polygon.points().iter().map(|&p| point(p)).collect();
    let mut parameters: Vec<f64> = polygon.parameters().iter().map(|&u| parameter(u)).collect();
    let mut boundary = match polygon.boundary() {
        Boundary::Tangents { start, end } => {
            Boundary::Tangents { start: start.map(&tangent), end: end.map(&tangent) }
        }
        other => other,
    };
    if reverse {
        points.reverse();
        parameters.reverse();
        if let Boundary::Tangents { start, end } = boundary {
            boundary = Boundary::Tangents { start: end, end: start };
        }
    }
    DataPolygon::new(points, &Parametrization::Given(parameters), boundary).unwrap()
}

/// Compares the curve of moved data with the moved curve, at many parameters, and the tensions.
fn agree(
    name: &str,
    polygon: &DataPolygon,
    other: &DataPolygon,
    point: impl Fn(DVec3) -> DVec3,
    parameter: impl Fn(f64) -> f64,
    reverse: bool,
) {
    for family in Family::ALL {
        let fit = |p: &DataPolygon| family.fit(p.clone()).spline;
        let (first, second) = (fit(polygon), fit(other));
        let mut tension = second.tension().to_vec();
        if reverse {
            tension.reverse();
        }
        for (i, (a, b)) in first.tension().iter().zip(&tension).enumerate() {
            assert!(
                (a - b).abs() <= 1e-9 * a.abs().max(1e-3),
                "{name} {family:?} node {i}: {a} {b}"
            );
        }
        let knots = polygon.parameters();
        let (u0, width) = (knots[0], knots[knots.len() - 1] - knots[0]);
        let size = (1..polygon.points().len())
            .map(|i| (point(polygon.points()[i]) - point(polygon.points()[i - 1])).length())
            .fold(0.0, f64::max);
        for k in 0..=400 {
            let u = u0 + width * f64::from(k) / 400.0;
            let a = point(first.curve().evaluate(u, 0, Side::Right));
            let b = second.curve().evaluate(parameter(u), 0, Side::Right);
            assert!((a - b).length() <= 1e-9 * size, "{name} {family:?} at {u}: {a} {b}");
        }
    }
}

#[test]
fn rotation_translation_scale_and_reversal() {
    let rotation = glam_rotation();
    for (k, polygon) in sets().iter().enumerate() {
        let turn = |p: DVec3| rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z;
        let other = moved(polygon, turn, turn, |u| u, false);
        agree(&format!("rotation {k}"), polygon, &other, turn, |u| u, false);

        let shift = |p: DVec3| p + DVec3::new(30.0, -20.0, 10.0);
        let other = moved(polygon, shift, |d| d, |u| u, false);
        agree(&format!("translation {k}"), polygon, &other, shift, |u| u, false);

        for (scale, unit) in
            [(1e100, 1.0), (1e-100, 1.0), (1.0, 1e100), (1.0, 1e-100), (1e100, 1e-100)]
        {
            let grow = |p: DVec3| p * scale;
            let other = moved(polygon, grow, |d| d * scale / unit, |u| u * unit, false);
            agree(&format!("scale {k} {scale} {unit}"), polygon, &other, grow, |u| u * unit, false);
        }

        // Run through backwards a tangent at the end points the other way.
        let other = moved(polygon, |p| p, |d| -d, |u| -u, true);
        agree(&format!("reversal {k}"), polygon, &other, |p| p, |u| -u, true);
    }
}

/// Mirrors and powers of two round nothing: not a bit of the legs and tensions may differ.
#[test]
fn mirrors_and_powers_of_two_change_no_bit() {
    let signs = [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, -1.0), DVec3::NEG_ONE];
    let two = |k: i32| 2f64.powi(k);
    let units = [(two(40), 1.0), (1.0, two(-33)), (two(-80), two(70))];
    let mut random = Random::new(22);
    let mut curves = 0;
    for kind in PolygonKind::ALL {
        for case in 0..scaled(240) {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            let (sign, (scale, unit)) = (signs[case % 3], units[case / 3 % 3]);
            let point = |p: DVec3| p * sign * scale;
            let other = moved(&polygon, point, |d| point(d) / unit, |u| u * unit, false);
            // Parameters that are given are those that the other polygon has.
            let polygon = moved(&polygon, |p| p, |d| d, |u| u, false);
            let family = Family::ALL[random.below(8)];
            if family == Family::Nu(Strategy::Nussp) {
                continue; // slow by its rule
            }
            let [first, second] = [&polygon, &other].map(|p| family.fit(p.clone()));
            let name = format!("{kind:?} {case} {family:?}");
            assert_eq!(first.spline.tension(), second.spline.tension(), "{name}");
            assert_eq!(first.outcome, second.outcome, "{name}");
            for (a, b) in first.cubic().legs().iter().zip(second.cubic().legs()) {
                assert_eq!(a.map(point), *b, "{name}");
            }
            curves += 1;
        }
    }
    assert!(curves > scaled(1000), "{curves}");
}

/// Columns of a rotation about (1, 2, 3) by one radian.
fn glam_rotation() -> [DVec3; 3] {
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    let (sin, cos) = 1f64.sin_cos();
    [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|e| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos)))
}
