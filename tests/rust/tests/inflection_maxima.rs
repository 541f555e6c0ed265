// SPDX-License-Identifier: MIT OR Apache-2.0

//! The most inflections of piecewise cubics over all directions, against samples, and against what must
//! not change it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{
    curve_inflections, curve_inflections_from, curve_inflections_with, polygon_inflections,
    polygon_inflections_from, polygon_inflections_with,
};
use shapespline::geometry::PiecewiseBezier;
use shapespline::prelude::*;
use shapespline_tests::generate::{PolygonKind, Random};

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
            let (left, right) = shapespline::polynomial::bernstein::split(p, part);
            cut.extend(left);
            cut.extend(right);
            cut_breaks.push(breaks[i] + part * (breaks[i + 1] - breaks[i]));
            cut_breaks.push(breaks[i + 1]);
        }
        for i in (0..curve.pieces()).rev() {
            backwards.extend(curve.piece(i).iter().rev().map(|p| p.truncate()));
        }
        let cut = PiecewiseBezier::new(cut_breaks, &cut, 3, Dimension::Three).unwrap();
        let count = curve_inflections(&cut);
        assert_eq!((count.count, count.exact), (expected, true), "case {case}, cut");
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
        let points = PolygonKind::Walk.points(3 + case % 8, &mut random);
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

/// Where a closed curve begins, its first and its last knot are in one place of the sphere.
#[test]
fn closed_curves_have_certain_maxima() {
    let mut random = Random::new(81);
    let mut exact = 0;
    for case in 0..60 {
        let mut points: Vec<DVec3> = (0..4 + case % 7).map(|_| random.vector()).collect();
        points.push(points[0]);
        let chordal = Parametrization::Chordal;
        let polygon = DataPolygon::new(points, &chordal, Boundary::Periodic).unwrap();
        let spline = NuSpline::new(polygon, Tension::Uniform(0.0)).unwrap();
        let curve = PiecewiseBezier::from(spline.curve());
        let most = curve_inflections(&curve);
        let shown = (0..1500).map(|_| sampled(&curve, random.vector())).max().unwrap();
        assert!(shown <= most.count, "{case}: {shown} > {}", most.count);
        exact += usize::from(most.exact);
    }
    assert!(exact >= 58, "{exact}");
}

/// Lines, points, cusps, pieces run through twice, and any scale: a count comes back, and what its
/// direction shows is no more.
#[test]
fn degenerate_curves_have_counts() {
    let mut random = Random::new(82);
    let make = |control: &[DVec3]| {
        let breaks = (0..=control.len() / 4).map(|i| i as f64).collect();
        PiecewiseBezier::new(breaks, control, 3, Dimension::Three).unwrap()
    };
    let check = |control: &[DVec3]| {
        let curve = make(control);
        let most = curve_inflections(&curve);
        let seen = curve_inflections_from(&curve, most.direction).unwrap();
        assert!(seen.count == most.count && most.direction.is_normalized(), "{control:?}");
        most.count
    };
    let p: Vec<DVec3> = (0..40).map(|_| random.vector()).collect();
    assert_eq!(check(&[p[0]; 8]), 0);
    assert_eq!(check(&[0.0, 1.0, 2.0, 3.0, 3.0, 2.0, 1.0, 5.0].map(|x| p[0] * x)), 0);
    // A cusp inside, legs of zero at the ends, a piece that goes back on itself.
    let cusp = [p[0], p[0] + p[1] + p[2], p[0] + p[1] - p[2], p[0] + p[1] * 2.0 - p[2] * 0.1];
    check(&cusp);
    check(&[p[0], p[0], p[1], p[2], p[2], p[3], p[4], p[4]]);
    let there: Vec<DVec3> = p[..4].to_vec();
    let back: Vec<DVec3> = there.iter().rev().copied().collect();
    let twice = [there.clone(), back].concat();
    assert!(check(&twice) >= 2);
    // Nearly planar, nearly straight, at any scale.
    for flat in [1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-15] {
        for scale in [1e-100, 1.0, 1e100] {
            for sides in [DVec3::new(1.0, 1.0, flat), DVec3::new(1.0, flat, flat)] {
                let control: Vec<DVec3> = p.iter().map(|p| *p * sides * scale).collect();
                check(&control[..24]);
            }
        }
    }
    for scale in [1e-100, 1e100] {
        let control: Vec<DVec3> = p.iter().map(|p| *p * scale).collect();
        assert_eq!(check(&control), check(&p));
    }
}

/// A plane is one only to rounding: off it by more, someone in the plane sees two inflections.
#[test]
fn the_plane_of_a_rational_cubic_is_certain_only_to_rounding() {
    let tilted = |x: f64, y: f64| DVec3::new(x + 0.3 * y, 0.7 * x - y, 0.2 * x + 0.9 * y);
    let made = |off: f64| {
        let mut points =
            [[0.0, 0.0], [1.0, 2.0], [3.0, 2.0], [4.0, 0.5]].map(|[x, y]| tilted(x, y));
        points[2] += points[1].cross(points[3]) * off;
        let weights = [1.0, 0.7, 1.3, 0.9];
        PiecewiseBezier::rational(vec![0.0, 1.0], &points, &weights, 3, Dimension::Three).unwrap()
    };
    let planar = curve_inflections(&made(0.0));
    assert_eq!((planar.count, planar.exact), (0, true));
    for k in 10..28 {
        let off = 10f64.powf(-0.5 * f64::from(k));
        let most = curve_inflections(&made(off));
        assert!(!most.exact || most.count == 2, "{off}: {most:?}");
    }
}

/// The same of a polynomial one: once it is not planar it has 2 (Theorem 7.2), however nearly it is, so no
/// other count is certain.
#[test]
fn the_plane_of_a_cubic_is_certain_only_to_rounding() {
    let made = |off: f64| {
        let mut points = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, 2.0, 0.0], [4.0, 0.5, 0.0]];
        points[2][2] = off;
        let points = points.map(DVec3::from);
        PiecewiseBezier::new(vec![0.0, 1.0], &points, 3, Dimension::Three).unwrap()
    };
    let planar = curve_inflections(&made(0.0));
    assert_eq!((planar.count, planar.exact), (0, true));
    for k in 2..26 {
        let off = 10f64.powf(-0.5 * f64::from(k));
        let most = curve_inflections(&made(off));
        assert!(!most.exact || most.count == 2, "{off}: {most:?}");
    }
}

/// Legs that differ by 1e12 within each piece: what turns by hardly more than rounding is counted, and the
/// count is no certain one.
#[test]
fn short_legs_beside_long_ones_count() {
    let control = [
        [-502113374532.69244, -211093308918.89822, 1185351338979.1711],
        [7.266738882453573e23, -3.659521228893673e23, 1.4336366770318865e24],
        [-8.218967535290162e35, -1.382236375723607e36, 5.414983656655936e36],
        [1760906385900.6436, 1788906690881.1018, 3214129854576.3604],
        [1.1293965056857265e24, 7.889066910828907e23, 2.19974059663099e24],
        [1.991546501871409e36, -8.44373235674015e35, 4.741405355921164e36],
    ];
    let breaks = vec![0.0, 1.0, 2.0];
    let curve = PiecewiseBezier::new(breaks, &control.map(DVec3::from), 2, Dimension::Three);
    let curve = curve.unwrap();
    let most = curve_inflections(&curve);
    assert_eq!((most.count, most.exact), (2, false));
    let direction = DVec3::new(0.8943439305295736, 0.0, -0.44738007770229693);
    assert_eq!(curve_inflections_from(&curve, direction).unwrap().count, 2);
}

/// A direction between two vectors that count as one, 1.4e−14 apart, shows one more, and says that it may not.
#[test]
fn a_direction_between_vectors_that_count_as_one_is_uncertain() {
    let points = [
        [0.0, -1.0568398565651949, 10.41916533150225],
        [6.783779659723813, -1.0568398565651949, 10.41916533150225],
        [-7.199893186846721, -1.0568398565652415, 1.7883573662928186],
        [-7.19989318684665, -1.056839856565548, 27.92950331883726],
        [-7.199893186846686, -1.0568398565653948, 14.85893034256504],
        [10.9128709849699, -16.58655680170921, 14.858930342565067],
    ];
    let points = points.map(DVec3::from);
    let most = polygon_inflections(&points, Dimension::Three).unwrap();
    let direction = DVec3::new(-5.188553199020691e-14, 0.0, -1.0);
    let seen = polygon_inflections_from(&points, Dimension::Three, direction).unwrap();
    assert!(!seen.exact || seen.count <= most.count, "{most:?} {seen:?}");
}

#[test]
fn a_count_can_be_broken_off() {
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicUsize, Ordering};

    let mut random = Random::new(80);
    let curve = spatial(2, 400, &mut random);
    let points = PolygonKind::Walk.points(400, &mut random);
    let asked = AtomicUsize::new(0);
    let go_on = || {
        let asked = asked.fetch_add(1, Ordering::Relaxed);
        if asked < 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    assert_eq!(curve_inflections_with(&curve, &go_on), None);
    assert_eq!(polygon_inflections_with(&points, Dimension::Three, &go_on).unwrap(), None);
    assert!(asked.load(Ordering::Relaxed) < 200);
}

/// A piece in a plane that begins by turning the other way, by about as much as rounding: no direction
/// shows more than a count that is called exact.
#[test]
fn what_hardly_turns_the_other_way_is_counted_or_uncertain() {
    let mut random = Random::new(81);
    let mut certain = [0; 2];
    for case in 0..4000 {
        let [x, y] = [random.vector(), random.vector()];
        // The turn at the start, in the plane and off it.
        let [back, off] = [16.0, 16.5].map(|k| 10f64.powf(-k + 3.0 * random.unit()));
        let at = |p: [f64; 2]| x * p[0] + y * p[1];
        let mut control = [[0.0, 0.0], [1.0, 0.0], [2.0, -back], [2.5, 1.0]].map(at);
        control[2] += x.cross(y) * off;
        let breaks = vec![0.0, 1.0];
        let weights = [1.0; 4];
        let curve = match case % 2 {
            0 => PiecewiseBezier::new(breaks, &control, 3, Dimension::Three),
            _ => PiecewiseBezier::rational(breaks, &control, &weights, 3, Dimension::Three),
        }
        .unwrap();
        let most = curve_inflections(&curve);
        let normal = x.cross(y).normalize();
        for step in 0..20 {
            let direction = normal + random.vector() * (0.1 * f64::from(step));
            let seen = curve_inflections_from(&curve, direction).unwrap();
            let holds = !seen.exact || !most.exact || seen.count <= most.count;
            assert!(holds, "{case}: {most:?} {seen:?} {back:e} {off:e}");
        }
        certain[most.count.min(1)] += usize::from(most.exact);
    }
    // Both are found, and mostly called certain.
    assert!(certain.iter().all(|&n| n > 500), "{certain:?}");
}

/// A piece that ends in a short leg, or begins with two that all but cancel: which way the curve turns there
/// is rounding, and no count is certain.
#[test]
fn turns_at_short_legs_are_uncertain() {
    let mut random = Random::new(82);
    for case in 0..400 {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|v| v + random.vector() * 0.3);
        let tiny = random.vector() * 10f64.powf(-13.0 - 2.0 * random.unit());
        let short = x * 1e-4;
        let legs = match case % 2 {
            0 => [[x, tiny, tiny], [y, x, z]],
            _ => [[y, z, y], [short, y * 1e-11 - short, z]],
        };
        let mut at = DVec3::ZERO;
        let control: Vec<DVec3> = legs
            .iter()
            .flat_map(|[a, b, c]| {
                let piece = [at, at + a, at + a + b, at + a + b + c];
                at = piece[3];
                piece
            })
            .collect();
        let curve = PiecewiseBezier::new(vec![0.0, 1.0, 2.0], &control, 3, Dimension::Three);
        let curve = curve.unwrap();
        let most = curve_inflections(&curve);
        assert!(!most.exact, "{case}: {most:?}");
    }
}

/// Directions within 1e−9 of the plane of a piece, and at a right angle to a turn that is known to 1e−7.
#[test]
fn directions_that_count_as_one_are_uncertain() {
    let seen = |tilt: f64| {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
        let control = points.map(DVec3::from);
        let curve = PiecewiseBezier::new(vec![0.0, 1.0], &control, 3, Dimension::Three).unwrap();
        curve_inflections_from(&curve, DVec3::new(1.0, 0.0, tilt)).unwrap().exact
    };
    assert_eq!([1e-8, 1e-10, 0.0].map(seen), [true, false, true]);
    let seen = |turn: f64| {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, turn, 0.0]].map(DVec3::from);
        polygon_inflections_from(&points, Dimension::Three, DVec3::X).unwrap().exact
    };
    assert_eq!([0.5, 1e-4, 1e-8].map(seen), [true, true, false]);
}

/// A piece that hardly curves has a plane known to 1e−5; beside a piece whose plane is as far from it, they may
/// be one plane or two.
#[test]
fn planes_that_may_be_one_are_uncertain() {
    let most = |tilt: f64| {
        let [bent, up] = [DVec3::new(1.0, 1e-9, 0.0), DVec3::new(0.0, 1.0, tilt)];
        let legs = [DVec3::X, DVec3::X, bent, bent, bent + up, up];
        let mut at = DVec3::ZERO;
        let mut control = vec![at];
        for (i, leg) in legs.into_iter().enumerate() {
            at += leg;
            control.push(at);
            if i == 2 {
                control.push(at);
            }
        }
        let curve = PiecewiseBezier::new(vec![0.0, 1.0, 2.0], &control, 3, Dimension::Three);
        let most = curve_inflections(&curve.unwrap());
        (most.count, most.exact)
    };
    assert_eq!([1.0, 1e-5, 0.0].map(most), [(1, true), (0, false), (0, true)]);
}
