//! Inflection counts: the examples and theorems of paper 002, sections 4, 5 and 7.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{
    curve_inflections, curve_inflections_from, curve_inflections_with, polygon_inflections,
    polygon_inflections_from, polygon_inflections_with,
};
use shapespline::geometry::PiecewiseBezier;
use shapespline::prelude::*;
use shapespline_tests::generate::{Kind, Random};

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

/// The normals of both examples' points call for convexity; what Example 7.7's curve violates the
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
        let checker = Checker::new(&polygon, Criteria::EVERY, Tolerances::default());
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
    for kind in Kind::ALL {
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
            let seen = polygon_inflections_from(&back, backwards.direction).unwrap();
            assert_eq!(seen.count, expected, "{kind:?}");
        }
    }
}

#[test]
fn large_polygons_and_piecewise_curves() {
    let mut random = Random::new(9);
    let walk = Kind::Walk.points(1500, &mut random);
    let start = std::time::Instant::now();
    let count = polygon_inflections(&walk, Dimension::Three).unwrap();
    println!("{} inflections of 1,500 points in {:?}", count.count, start.elapsed());
    assert_eq!(polygon_inflections_from(&walk, count.direction).unwrap().count, count.count);

    // A corner counts as a turn: a polyline as a curve has the inflections of the polygon.
    let points = Kind::Walk.points(12, &mut random);
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
    let error = polygon_inflections_from(&p[..1], DVec3::ZERO).unwrap_err().to_string();
    assert!(error.contains("direction"), "{error}");
    assert_eq!(polygon_inflections(&p[..1], Dimension::Three).unwrap().count, 0);
    let line: Vec<DVec3> = (0..9).map(|i| DVec3::new(0.1, 0.7, -0.3) * f64::from(i)).collect();
    assert_eq!(polygon_inflections(&line, Dimension::Three).unwrap().count, 0);
}

/// A piecewise cubic in space through random points: with continuous curvature (a B-spline), with
/// continuous tangents, or with corners.
fn spatial(smoothness: usize, n: usize, random: &mut Random) -> PiecewiseBezier {
    let breaks: Vec<f64> = (0..=n).map(|i| i as f64).collect();
    let points: Vec<DVec3> = (0..n + 3)
        .scan(DVec3::ZERO, |at, _| {
            *at += random.vector();
            Some(*at)
        })
        .collect();
    if smoothness == 2 {
        let knots: Vec<f64> = (0..n + 7).map(|i| i as f64).collect();
        return PiecewiseBezier::from_bspline(&knots, &points, 3, Dimension::Three).unwrap();
    }
    let tangents: Vec<DVec3> = (0..=n).map(|_| random.vector() * 0.4).collect();
    let inner = |i: usize, random: &mut Random| match smoothness {
        1 => [points[i] + tangents[i], points[i + 1] - tangents[i + 1]],
        _ => [points[i] + random.vector(), points[i + 1] + random.vector()],
    };
    let piece = |i: usize| {
        let [p, q] = inner(i, random);
        [points[i], p, q, points[i + 1]]
    };
    let control: Vec<DVec3> = (0..n).flat_map(piece).collect();
    PiecewiseBezier::new(breaks, &control, 3, Dimension::Three).unwrap()
}

/// The count seen from a direction by plain evaluation of `w·(γ'×γ'')`, and of the turns at corners.
fn sampled(curve: &PiecewiseBezier, w: DVec3) -> usize {
    let mut signs = Vec::new();
    let leg = |i: usize, k: usize| {
        let p = curve.piece(i);
        (p[k + 1] - p[k]).truncate()
    };
    for i in 0..curve.pieces() {
        let [a, b, c] = [0, 1, 2].map(|k| leg(i, k));
        for k in 0..=200 {
            let t = f64::from(k) / 200.0;
            let s = 1.0 - t;
            let d1 = a * (s * s) + b * (2.0 * s * t) + c * (t * t);
            let d2 = (b - a) * s + (c - b) * t;
            signs.push(w.dot(d1.cross(d2)) > 0.0);
        }
        if i + 1 < curve.pieces() {
            let turn = c.normalize().cross(leg(i + 1, 0).normalize());
            if turn.length() > 1e-9 {
                signs.push(w.dot(turn) > 0.0);
            }
        }
    }
    signs.windows(2).filter(|s| s[0] != s[1]).count()
}

/// No direction shows more than the maximum, which its own direction shows; and mostly some random one
/// shows as many (it need not: cells can be small).
#[test]
fn the_maximum_over_all_directions_of_piecewise_cubics() {
    let mut random = Random::new(77);
    let (mut cases, mut reached, mut exact) = (0, 0, 0);
    for smoothness in 0..3 {
        for case in 0..60 {
            let n = 1 + case % 6;
            let curve = spatial(smoothness, n, &mut random);
            let most = curve_inflections(&curve);
            let seen = curve_inflections_from(&curve, most.direction).unwrap();
            assert_eq!((seen.count, seen.exact), (most.count, true), "{smoothness} {case}");
            let samples = 1500;
            let shown = (0..samples).map(|_| sampled(&curve, random.vector())).max().unwrap();
            assert!(shown <= most.count, "{smoothness} {case}: {shown} > {}", most.count);
            cases += 1;
            reached += usize::from(shown == most.count);
            exact += usize::from(most.exact);
        }
    }
    println!(
        "{cases} curves: sampling reaches the maximum of {reached}, {exact} maxima are certain"
    );
    assert!(reached * 2 > cases, "{reached} of {cases}");
    assert!(exact * 100 >= cases * 99, "{exact} of {cases}");
}

/// Where a smooth piece of one cubic is cut, and which way it is run through, makes no difference.
#[test]
fn the_maximum_does_not_depend_on_the_pieces() {
    let mut random = Random::new(78);
    for case in 0..100 {
        let curve = spatial(case % 3, 1 + case % 7, &mut random);
        let expected = curve_inflections(&curve).count;
        let breaks = curve.breaks();
        let mut cut_breaks = vec![breaks[0]];
        let (mut cut, mut backwards) = (Vec::new(), Vec::new());
        for i in 0..curve.pieces() {
            let p: Vec<DVec3> = curve.piece(i).iter().map(|p| p.truncate()).collect();
            let part = random.within(0.2, 0.8);
            let (left, right) = shapespline::geometry::polynomial::split(&p, part);
            cut.extend(left);
            cut.extend(right);
            cut_breaks.push(breaks[i] + part * (breaks[i + 1] - breaks[i]));
            cut_breaks.push(breaks[i + 1]);
        }
        for i in (0..curve.pieces()).rev() {
            backwards.extend(curve.piece(i).iter().rev().map(|p| p.truncate()));
        }
        let cut = PiecewiseBezier::new(cut_breaks, &cut, 3, Dimension::Three).unwrap();
        assert_eq!(curve_inflections(&cut).count, expected, "case {case}, cut");
        let back = PiecewiseBezier::new(breaks.to_vec(), &backwards, 3, Dimension::Three).unwrap();
        assert_eq!(curve_inflections(&back).count, expected, "case {case}, backwards");
    }
}

/// Planar pieces in different planes, straight ones among them: each looks from everywhere as it does
/// in its plane, so the most is that of the polygon of their osculating planes.
#[test]
fn planar_pieces_count_like_a_polygon() {
    let mut random = Random::new(79);
    for case in 0..50 {
        let points = Kind::Walk.points(3 + case % 8, &mut random);
        let n = points.len() - 1;
        // Rounded corners: a quadratic around each inner point, straight pieces between.
        let middle = |i: usize| (points[i] + points[i + 1]) * 0.5;
        let third = |p: DVec3, q: DVec3| [p, p.lerp(q, 0.3), p.lerp(q, 0.7), q];
        let mut control = third(points[0], middle(0)).to_vec();
        for i in 1..n {
            let (p, q) = (middle(i - 1), middle(i));
            control.extend([p, p.lerp(points[i], 2.0 / 3.0), q.lerp(points[i], 2.0 / 3.0), q]);
        }
        control.extend(third(middle(n - 1), points[n]));
        let breaks = (0..=n + 1).map(|i| i as f64).collect();
        let curve = PiecewiseBezier::new(breaks, &control, 3, Dimension::Three).unwrap();
        let polygon = polygon_inflections(&points, Dimension::Three).unwrap();
        let count = curve_inflections(&curve);
        assert_eq!((count.count, count.exact), (polygon.count, true), "case {case}");
    }
}

#[test]
fn a_count_can_be_broken_off() {
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicUsize, Ordering};

    let mut random = Random::new(80);
    let curve = spatial(2, 400, &mut random);
    let points = Kind::Walk.points(400, &mut random);
    let asked = AtomicUsize::new(0);
    let go_on = || {
        let asked = asked.fetch_add(1, Ordering::Relaxed);
        if asked < 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    assert_eq!(curve_inflections_with(&curve, &go_on), None);
    assert_eq!(polygon_inflections_with(&points, Dimension::Three, &go_on).unwrap(), None);
    assert!(asked.load(Ordering::Relaxed) < 200);
}
