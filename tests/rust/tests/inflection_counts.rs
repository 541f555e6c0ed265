// SPDX-License-Identifier: MIT OR Apache-2.0

//! Inflection counts: the examples and theorems of paper 002, sections 4, 5 and 7.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{
    curve_inflections, curve_inflections_from, polygon_inflections, polygon_inflections_from,
};
use shapespline::geometry::PiecewiseBezier;
use shapespline::prelude::*;
use shapespline_tests::generate::{PolygonKind, Random};

fn bezier(control: &[DVec3], dimension: Dimension) -> PiecewiseBezier {
    PiecewiseBezier::new(vec![0.0, 1.0], control, control.len() - 1, dimension).unwrap()
}

/// The curve of an example from `(0, 0, 0)` to `(0, 0, z)` with end tangent legs `a, c`.
fn example(z: f64, a: [f64; 3], c: [f64; 3]) -> PiecewiseBezier {
    let end = DVec3::new(0.0, 0.0, z);
    let control = [DVec3::ZERO, DVec3::from(a), end - DVec3::from(c), end];
    bezier(&control, Dimension::Three)
}

fn seen(curve: &PiecewiseBezier, directions: &[[f64; 3]]) -> Vec<usize> {
    let count = |w: &[f64; 3]| curve_inflections_from(curve, DVec3::from(*w)).unwrap();
    directions.iter().map(count).map(|c| if c.exact { c.count } else { usize::MAX }).collect()
}

#[test]
fn example_7_7() {
    let curve = example(5.0, [3.0, 1.0, 0.5], [2.0, -1.0, 0.5]);
    let views = [[1.5, -1.5, 0.0], [2.0, 1.0, 0.0], [-10.0, 0.0, 1.0]];
    assert_eq!(seen(&curve, &views), [1, 1, 0]);
}

#[test]
fn example_7_8() {
    let curve = example(10.0, [1.0, 1.0, 0.5], [2.0, -3.0, 0.5]);
    let views = [
        [30.0, -30.0, 0.0],
        [40.0, 20.0, 0.0],
        [7.458, -1.863, -3.506],
        [-17.458, 1.863, 23.506],
        [-7.458, 6.863, 33.506],
        [-7.458, 30.863, 33.506],
    ];
    assert_eq!(seen(&curve, &views), [0, 0, 0, 0, 2, 1]);
}

/// The normals of both examples' points require convexity; what Example 7.7's curve violates the
/// report says.
#[test]
fn the_examples_as_reports() {
    for (z, legs, ok) in [
        (5.0, [[3.0, 1.0, 0.5], [2.0, -1.0, 0.5]], false),
        (10.0, [[1.0, 1.0, 0.5], [2.0, -3.0, 0.5]], true),
    ] {
        let points = [[-3.0, -3.0, -0.5], [0.0; 3], [0.0, 0.0, z], [2.0, -4.0, z + 0.5]];
        let points = points.map(DVec3::from).to_vec();
        let polygon =
            DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap();
        let checker = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
        let legs = legs.map(DVec3::from);
        for criterion in [Criterion::Convexity, Criterion::GlobalConvexity] {
            let record = checker.record(1, legs, criterion);
            assert_eq!((record.applicable, record.satisfied), (true, ok), "{record:?}");
        }
        // Remark 7.9: both keep the torsion of their points.
        assert!(checker.record(1, legs, Criterion::Torsion).satisfied);
    }
}

/// A planar polygon whose legs turn by less than π in all and never double back: regular.
fn regular(n: usize, random: &mut Random) -> Vec<DVec3> {
    let mut points = vec![DVec3::ZERO];
    for _ in 0..n {
        let angle = random.within(0.05, 3.1);
        let leg = DVec3::new(angle.cos(), angle.sin(), 0.0) * random.within(0.1, 2.0);
        points.push(points[points.len() - 1] + leg);
    }
    points
}

#[test]
fn theorem_4_4_and_corollary_4_5() {
    let mut random = Random::new(44);
    let (mut fewer, mut equal) = (0, 0);
    for case in 0..3000 {
        let n = 2 + random.below(7);
        let points = regular(n, &mut random);
        let polygon = polygon_inflections(&points, Dimension::Two).unwrap().count;
        let degree = (2 + case % 4).min(n);
        // Knots of a B-spline with random spacings, some of them double.
        let mut knots = vec![0.0];
        while knots.len() < points.len() + degree + 1 {
            let last = knots[knots.len() - 1];
            let step = if random.below(6) == 0 { 0.0 } else { random.within(0.1, 1.0) };
            let full = knots.iter().filter(|&&t| t == last).count() >= degree;
            knots.push(last + if full { 0.5 } else { step });
        }
        let spline = PiecewiseBezier::from_bspline(&knots, &points, degree, Dimension::Two);
        let Ok(spline) = spline else { continue };
        for curve in [spline, bezier(&points, Dimension::Two)] {
            let count = curve_inflections(&curve).count;
            assert!(count <= polygon, "case {case}: {count} > {polygon}");
            if count < polygon { fewer += 1 } else { equal += 1 }
        }
    }
    assert!(fewer > 500 && equal > 500, "{fewer} {equal}");
}

#[test]
fn theorem_4_6() {
    let mut random = Random::new(46);
    let cross = |a: DVec3, b: DVec3| a.x * b.y - a.y * b.x;
    let mut counts = [0; 3];
    for _ in 0..20_000 {
        let legs = [0; 3].map(|_| DVec3::new(random.vector().x, random.vector().y, 0.0));
        let [a, b, c] = legs;
        let angle = |u: DVec3, v: DVec3| cross(u, v).atan2(u.dot(v));
        let turning = angle(a, b) + angle(b, c);
        if turning.abs() <= std::f64::consts::PI || angle(a, b) * angle(b, c) < 0.0 {
            continue;
        }
        // A + s a = D − r c with A = 0: the intersection of the outer legs' lines.
        let (p_a, p_d) = (a, a + b);
        let s = cross(p_d, c) / cross(a, c);
        let p = a * s;
        let ratio = a.length() * c.length() / ((p_a - p).length() * (p_d - p).length());
        if (ratio - 4.0).abs() < 1e-9 {
            continue;
        }
        let control = [DVec3::ZERO, a, a + b, a + b + c];
        let count = curve_inflections(&bezier(&control, Dimension::Two));
        assert!(count.exact);
        assert_eq!(count.count, if ratio <= 4.0 { 0 } else { 2 }, "{legs:?} {ratio}");
        counts[count.count] += 1;
    }
    assert!(counts[0] > 100 && counts[2] > 100, "{counts:?}");
}

#[test]
fn theorems_7_1_and_7_2() {
    let mut random = Random::new(71);
    for case in 0..300 {
        let degree = 3 + case % 3;
        let control: Vec<DVec3> = (0..=degree).map(|_| random.vector()).collect();
        let curve = bezier(&control, Dimension::Three);
        let count = curve_inflections(&curve);
        if degree == 3 {
            assert_eq!((count.count, count.exact), (2, true), "case {case}");
        }
        assert!(count.count >= 1);
        assert_eq!(curve_inflections_from(&curve, count.direction).unwrap().count, count.count);
        // In a plane the count is that of the plane, wherever the plane lies (Corollary 5.3).
        let turn = |p: DVec3| {
            DVec3::new(0.6 * p.x - 0.8 * p.y, 0.48 * p.x + 0.36 * p.y, 0.64 * p.x + 0.48 * p.y)
        };
        let flat: Vec<DVec3> = control.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
        let tilted: Vec<DVec3> = flat.iter().map(|&p| turn(p)).collect();
        let plane = curve_inflections(&bezier(&flat, Dimension::Two));
        let space = curve_inflections(&bezier(&tilted, Dimension::Three));
        assert_eq!((plane.count, plane.exact), (space.count, space.exact), "case {case}");
    }
}

#[test]
fn theorems_7_3_and_7_4() {
    let mut random = Random::new(73);
    let mut ones = 0;
    for case in 0..2000 {
        let n = 3 + case % 3;
        let mut points: Vec<DVec3> = (0..=n).map(|_| random.vector()).collect();
        if case % 2 == 0 {
            // All but the first in a plane: V_2 … V_{n−1} are parallel, V_1 is not.
            points[1..].iter_mut().for_each(|p| p.z = 0.0);
        }
        let count = polygon_inflections(&points, Dimension::Three).unwrap().count;
        if n == 3 {
            assert_eq!(count, 1, "case {case}");
        }
        // 7.3: one inflection exactly when the V_i lie in order in a plane sector of at most π.
        let l: Vec<DVec3> = points.windows(2).map(|w| w[1] - w[0]).collect();
        let v: Vec<DVec3> = l.windows(2).map(|w| w[0].cross(w[1]).normalize()).collect();
        let axis = v[0].cross(v[1]).normalize();
        let planar = v.iter().all(|x| x.dot(axis).abs() < 1e-9);
        let steps: Vec<f64> = v.windows(2).map(|w| w[0].cross(w[1]).dot(axis)).collect();
        let angle = |w: &[DVec3]| w[0].cross(w[1]).length().atan2(w[0].dot(w[1]));
        let total: f64 = v.windows(2).map(angle).sum();
        let in_order = steps.iter().all(|&s| s > -1e-12) && total <= std::f64::consts::PI + 1e-9;
        assert_eq!(count == 1, planar && in_order, "case {case}: {count}");
        ones += usize::from(count == 1);
    }
    assert!(ones > 700);
}

#[test]
fn counts_do_not_depend_on_scale_position_orientation_or_direction() {
    let mut random = Random::new(5);
    for kind in PolygonKind::ALL {
        for _ in 0..20 {
            let n = 3 + random.below(20);
            let points = kind.points(n, &mut random);
            let count = |p: &dyn Fn(DVec3) -> DVec3| {
                let moved: Vec<DVec3> = points.iter().map(|&x| p(x)).collect();
                polygon_inflections(&moved, Dimension::Three).unwrap().count
            };
            let expected = count(&|p| p);
            // About 1e±100, without rounding: near a plane a rounding may add an inflection.
            for scale in [2f64.powi(332), 2f64.powi(-332)] {
                assert_eq!(count(&|p| p * scale), expected, "{kind:?}");
            }
            // Turned by a rotation that has no rounding.
            assert_eq!(count(&|p| DVec3::new(-p.y, p.z, -p.x)), expected, "{kind:?}");
            let back: Vec<DVec3> = points.iter().rev().copied().collect();
            let backwards = polygon_inflections(&back, Dimension::Three).unwrap();
            assert_eq!(backwards.count, expected, "{kind:?}");
            let seen =
                polygon_inflections_from(&back, Dimension::Three, backwards.direction).unwrap();
            assert_eq!(seen.count, expected, "{kind:?}");
        }
    }
}

#[test]
fn large_polygons_and_piecewise_curves() {
    let mut random = Random::new(9);
    let walk = PolygonKind::Walk.points(1500, &mut random);
    let start = std::time::Instant::now();
    let count = polygon_inflections(&walk, Dimension::Three).unwrap();
    println!("{} inflections of 1,500 points in {:?}", count.count, start.elapsed());
    assert_eq!(
        polygon_inflections_from(&walk, Dimension::Three, count.direction).unwrap().count,
        count.count
    );

    // A corner counts as a turn: a polyline as a curve has the inflections of the polygon.
    let points = PolygonKind::Walk.points(12, &mut random);
    let u: Vec<f64> = (0..12).map(f64::from).collect();
    let line: Vec<DVec3> = points.windows(2).flat_map(|w| [w[0], w[1]]).collect();
    let polyline = PiecewiseBezier::new(u, &line, 1, Dimension::Three).unwrap();
    let polygon = polygon_inflections(&points, Dimension::Three).unwrap();
    assert_eq!(curve_inflections(&polyline).count, polygon.count);
}

#[test]
fn unusable_input() {
    let p = [DVec3::ZERO, DVec3::X, DVec3::X];
    assert!(
        polygon_inflections(&p, Dimension::Three).unwrap_err().to_string().contains("points[2]")
    );
    let p = [DVec3::ZERO, DVec3::NAN];
    assert!(polygon_inflections(&p, Dimension::Two).unwrap_err().to_string().contains("points[1]"));
    let error =
        polygon_inflections_from(&p[..1], Dimension::Three, DVec3::ZERO).unwrap_err().to_string();
    assert!(error.contains("direction"), "{error}");
    assert_eq!(polygon_inflections(&p[..1], Dimension::Three).unwrap().count, 0);
    let line: Vec<DVec3> = (0..9).map(|i| DVec3::new(0.1, 0.7, -0.3) * f64::from(i)).collect();
    assert_eq!(polygon_inflections(&line, Dimension::Three).unwrap().count, 0);
}
