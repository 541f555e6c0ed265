// SPDX-License-Identifier: MIT OR Apache-2.0

//! Corners, directions and a distance from the polygon: what else a fair curve can be asked for. Held by
//! formulas of the tests' own.
#![allow(clippy::unwrap_used, reason = "test code")]

use shapespline::{
    fair::{Constraints, Fit, FitError, Method, Status},
    geometry::PiecewiseBezier,
    prelude::*,
};
use shapespline_tests::{generate::Random, points, scaled};

fn polygon(points: Vec<DVec3>, dimension: Dimension, boundary: Boundary) -> DataPolygon {
    DataPolygon::with_dimension(points, dimension, &Parametrization::Chordal, boundary).unwrap()
}

fn walk(seed: usize, dimension: Dimension) -> Vec<DVec3> {
    let mut random = Random::new(seed as u64);
    let mut at = DVec3::ZERO;
    let mut step = || {
        let v = random.vector() + DVec3::X * 0.5;
        at += if dimension == Dimension::Two { v.truncate().extend(0.0) } else { v };
        at
    };
    (0..14).map(|_| step()).collect()
}

fn fit(polygon: &DataPolygon, constraints: Constraints) -> Result<Fit, FitError> {
    let options = FairOptions { constraints, ..FairOptions::default() };
    FairSpline::fit(polygon.clone(), &options)
}

fn solved(polygon: &DataPolygon, constraints: Constraints, name: &str) -> FairSpline {
    let fit = fit(polygon, constraints).unwrap();
    assert_eq!(fit.diagnostics.status, Status::Solved, "{name}: {}", fit.report);
    fit.curve
}

/// Distance from a point to a segment.
fn distance(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (p - a - (b - a) * t).length()
}

/// The largest distance of control points from the chord of their segment.
fn deviation(curve: &FairSpline) -> f64 {
    let bezier = PiecewiseBezier::from(curve.curve());
    let points = curve.points();
    let mut largest = 0.0f64;
    for (i, ends) in curve.nodes().windows(2).enumerate() {
        for piece in ends[0]..ends[1] {
            for p in bezier.piece(piece) {
                largest = largest.max(distance(p.truncate(), points[i], points[i + 1]));
            }
        }
    }
    largest
}

#[test]
fn between_corners_the_curve_is_that_of_the_part() {
    for seed in 0..scaled(100) {
        let dimension = if seed % 2 == 0 { Dimension::Three } else { Dimension::Two };
        let points = walk(seed, dimension);
        let whole = polygon(points.clone(), dimension, Boundary::ZeroCurvature);
        let corners = vec![4, 5, 9];
        let constraints = Constraints { corners: corners.clone(), ..Constraints::default() };
        let curve = solved(&whole, constraints, &format!("walk {seed}"));
        assert_eq!(curve.corners(), corners);
        for ends in [0, 4, 5, 9, 13].windows(2) {
            let own = points[ends[0]..=ends[1]].to_vec();
            let u = Parametrization::Given(whole.parameters()[ends[0]..=ends[1]].to_vec());
            let natural = Boundary::ZeroCurvature;
            let own = DataPolygon::with_dimension(own, dimension, &u, natural).unwrap();
            let part = solved(&own, Constraints::default(), "part");
            let [from, to] = [ends[0], ends[1]].map(|k| curve.nodes()[k]);
            let legs = &curve.curve().legs()[from..to];
            assert_eq!(legs.len(), part.curve().legs().len());
            for (one, other) in legs.iter().zip(part.curve().legs()) {
                assert_eq!(one, other, "walk {seed}");
            }
        }
    }
}

/// Closed data with corners are open parts; with a corner at every point, the polygon itself.
#[test]
fn closed_data_have_corners_too() {
    let mut square = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.0, 3.0], [0.0, 2.0]]
        .map(|[x, y]| DVec3::new(x, y, 0.0))
        .to_vec();
    square.push(square[0]);
    let closed = polygon(square, Dimension::Two, Boundary::Periodic);
    for corners in [vec![0], vec![3], vec![1, 4], vec![0, 1, 2, 3, 4]] {
        let constraints = Constraints { corners: corners.clone(), ..Constraints::default() };
        let curve = solved(&closed, constraints, &format!("{corners:?}"));
        let cubic = curve.curve();
        let knots = cubic.knots();
        for k in 0..5 {
            let u = knots[curve.nodes()[k]];
            let before = if k == 0 { knots[knots.len() - 1] } else { u };
            let [left, right] = [1, 2].map(|order| {
                [cubic.evaluate(before, order, Side::Left), cubic.evaluate(u, order, Side::Right)]
            });
            let jumps = [left, right].map(|[a, b]| (a - b).length());
            assert_eq!(jumps[0] > 1e-6, corners.contains(&k), "{corners:?} {k}: {jumps:?}");
            // Natural ends on both sides of a corner, and no jump elsewhere.
            assert!(jumps[1] < 1e-9, "{corners:?} {k}: {jumps:?}");
        }
        if corners.len() == 5 {
            assert!(deviation(&curve) < 1e-15);
        }
    }
}

#[test]
fn control_points_stay_within_the_distance() {
    let mut data = vec![
        polygon(points("protein_1a8o_ca.csv"), Dimension::Three, Boundary::ZeroCurvature),
        polygon(points("coil_m16n08_first.csv"), Dimension::Three, Boundary::Periodic),
    ];
    for seed in 0..scaled(40) {
        let dimension = if seed % 2 == 0 { Dimension::Three } else { Dimension::Two };
        data.push(polygon(walk(seed, dimension), dimension, Boundary::ZeroCurvature));
    }
    for (k, polygon) in data.iter().enumerate() {
        let free = solved(polygon, Constraints::default(), "free");
        let own = deviation(&free);
        for share in [2.0, 0.6, 0.2, 0.05] {
            // The closed coil, of 128 nearly equal turns, is not solved closer to its polygon.
            if k == 1 && share < 0.5 {
                continue;
            }
            let most = own * share;
            let constraints = Constraints { max_deviation: Some(most), ..Constraints::default() };
            for energy in [Energy::Parametric, Energy::Bending] {
                if k < 2 && energy == Energy::Bending {
                    continue;
                }
                let constraints = constraints.clone();
                let options = FairOptions { constraints, energy, ..FairOptions::default() };
                let fit = FairSpline::fit(polygon.clone(), &options).unwrap();
                let name = format!("data {k}, {share}, {energy:?}");
                let found = deviation(&fit.curve);
                assert_eq!(fit.diagnostics.status, Status::Solved, "{name}: {}", fit.report);
                assert!(found <= most, "{name}: {found} {most}");
                if share > 1.0 && energy == Energy::Parametric {
                    let same = fit.curve.curve().legs().iter().zip(free.curve().legs());
                    let off = same.map(|(a, b)| (a[0] - b[0]).length()).fold(0.0, f64::max);
                    assert!(off == 0.0, "{name}: {off}");
                }
            }
        }
    }
}

#[test]
fn directions_are_those_asked_for() {
    for seed in 0..scaled(200) {
        let dimension = if seed % 2 == 0 { Dimension::Three } else { Dimension::Two };
        let data = polygon(walk(seed, dimension), dimension, Boundary::ZeroCurvature);
        // Criteria that leave a tangent free to be chosen.
        let criteria = Criteria::NONE.with(Criterion::Convexity).with(Criterion::Turning);
        let tangents = [3, 4, 8].map(|k| {
            let [u, v] = data.directions_at(k);
            (k, (u * 0.4 + v * 0.6) * 7.0)
        });
        let constraints = Constraints { tangents: tangents.to_vec(), ..Constraints::default() };
        for energy in [Energy::Parametric, Energy::Bending] {
            let constraints = constraints.clone();
            let options = FairOptions { constraints, criteria, energy, ..FairOptions::default() };
            let fit = FairSpline::fit(data.clone(), &options).unwrap();
            let name = format!("walk {seed} {energy:?}");
            assert_eq!(fit.diagnostics.status, Status::Solved, "{name}: {}", fit.report);
            for (k, d) in tangents {
                let found = fit.curve.tangents()[k];
                let sine = found.normalize().cross(d.normalize()).length();
                assert!(sine < 1e-12 && found.dot(d) > 0.0, "{name}, {k}: {sine}");
            }
        }
    }
}

/// The directions that the curve has by itself change nothing, where the plain cubic leads to it.
#[test]
fn own_directions_change_little() {
    let (mut count, mut unsolved) = (0, Vec::new());
    for seed in 0..scaled(200) {
        let data = polygon(walk(seed, Dimension::Three), Dimension::Three, Boundary::ZeroCurvature);
        let free = fit(&data, Constraints::default()).unwrap();
        if free.diagnostics.method > Method::Elastic {
            continue;
        }
        count += 1;
        let own = free.curve.tangents();
        let tangents = [3, 6, 9].map(|k| (k, own[k])).to_vec();
        let constraints = Constraints { tangents, ..Constraints::default() };
        let held = fit(&data, constraints).unwrap().diagnostics;
        if held.status != Status::Solved {
            unsolved.push(seed);
            continue;
        }
        let free = free.diagnostics.energy;
        assert!(held.energy < 1.25 * free, "walk {seed}: {} {free}", held.energy);
    }
    assert!(count > scaled(200) / 3, "{count}");
    assert!(unsolved.len() * 10 <= count, "{unsolved:?} of {count}");
}

#[test]
fn contradictions_are_refused_by_name() {
    let data = polygon(walk(1, Dimension::Three), Dimension::Three, Boundary::ZeroCurvature);
    let text = |constraints: Constraints| fit(&data, constraints).unwrap_err().to_string();
    let corners = |corners: Vec<usize>| Constraints { corners, ..Constraints::default() };
    let tangents =
        |tangents: Vec<(usize, DVec3)>| Constraints { tangents, ..Constraints::default() };
    let near = |d: f64| Constraints { max_deviation: Some(d), ..Constraints::default() };
    let [before, after] = data.directions_at(5);
    for (constraints, expected) in [
        (
            corners(vec![0]),
            "corners[0] must be the index of an inner point, more than the one before, got 0",
        ),
        (corners(vec![13]), "corners[0] must be"),
        (corners(vec![4, 4]), "corners[1] must be"),
        (corners(vec![5, 3]), "corners[1] must be"),
        (tangents(vec![(14, DVec3::X)]), "tangents[0] must be the index of a point"),
        (tangents(vec![(3, DVec3::ZERO)]), "tangents[3] must be a finite vector"),
        (tangents(vec![(3, DVec3::NAN)]), "tangents[3] must be a finite vector"),
        (tangents(vec![(5, before - after)]), "tangents[5] must be between the chords"),
        (tangents(vec![(5, -before - after)]), "tangents[5] must be between the chords"),
        (near(0.0), "max_deviation must be a length above 0, got 0"),
        (near(f64::NAN), "max_deviation must be a length above 0, got NaN"),
        (near(-1.0), "max_deviation must be a length above 0, got -1"),
    ] {
        let found = text(constraints);
        assert!(found.contains(expected), "{found}\n{expected}");
    }
    let ends = Boundary::tangents(DVec3::Z * 3.0, DVec3::X);
    let held = polygon(walk(1, Dimension::Three), Dimension::Three, ends);
    let error = fit(&held, near(0.01)).unwrap_err().to_string();
    assert!(error.contains("max_deviation must be more than the given end tangents"), "{error}");
    let error = fit(&held, tangents(vec![(0, DVec3::X)])).unwrap_err().to_string();
    assert!(error.contains("tangents[0] must be the index of a point without"), "{error}");
}
