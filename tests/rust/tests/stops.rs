// SPDX-License-Identifier: MIT OR Apache-2.0

//! A curve that stops has no shape to keep: the criterion "regular", against planted stops and sampled speeds.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{CurveChecker, INTERPOLATION};
use shapespline::geometry::PiecewiseBezier;
use shapespline::prelude::*;
use shapespline_tests::{families::Family, generate::Random, scaled, segments};

/// The legs of a cubic that stops at `t` if `off` is zero: in any plane, or on a line.
fn planted(t: f64, on_line: bool, off: f64, random: &mut Random) -> [DVec3; 3] {
    let (a, other) = (random.vector(), random.vector());
    let c = if on_line { a * random.within(-2.0, 2.0) } else { other };
    let s = 1.0 - t;
    let b = -(a * (s * s) + c * (t * t)) / (2.0 * s * t);
    // Off to the side: along the line a curve that stops only turns round elsewhere.
    let side = if on_line { a.cross(other) } else { a.cross(c) }.normalize();
    [a, b + side * (off * b.length()), c]
}

/// The least speed of a cubic over what it would be if no legs cancelled, by dense sampling.
fn sampled([a, b, c]: [DVec3; 3]) -> f64 {
    let at = |t: f64| {
        let weights = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
        let [x, y, z] = weights;
        let size = x * a.length() + y * (a + b + c).length().max(b.length()) + z * c.length();
        (a * x + b * y + c * z).length() / size
    };
    (0..=800).map(|k| at(f64::from(k) / 800.0)).fold(f64::INFINITY, f64::min)
}

/// A polygon of one straight chord, which asks for nothing else.
fn chord(legs: [DVec3; 3], start: DVec3) -> DataPolygon {
    let points = vec![start, start + legs[0] + legs[1] + legs[2]];
    DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap()
}

fn elevated(p: &[DVec3]) -> Vec<DVec3> {
    let n = p.len();
    let at = |i: usize| {
        let s = i as f64 / n as f64;
        let before = if i > 0 { p[i - 1] * s } else { DVec3::ZERO };
        let after = if i < n { p[i] * (1.0 - s) } else { DVec3::ZERO };
        before + after
    };
    (0..=n).map(at).collect()
}

/// The verdicts on a curve between two points as a cubic, elevated, rational, and cut in two.
fn verdicts(polygon: &DataPolygon, [a, b, c]: [DVec3; 3]) -> [bool; 4] {
    let criteria = Criteria::NONE.with(Criterion::Regular);
    let cubic = Checker::new(polygon, criteria, Tolerances::default());
    let own = cubic.record(0, [a, c], Criterion::Regular);
    assert_eq!(own.margin > 0.0, own.satisfied, "{own:?}");
    assert!((0.0..=1.0).contains(&own.margin), "{own:?}");
    let p = polygon.points();
    let control = [p[0], p[0] + a, p[0] + a + b, p[1]];
    let (u, three) = (polygon.parameters().to_vec(), Dimension::Three);
    let raised = elevated(&elevated(&control));
    let half = |from: usize, to: usize| control[from].lerp(control[to], 0.5);
    let (ab, bc, cd) = (half(0, 1), half(1, 2), half(2, 3));
    let (abc, bcd) = (ab.lerp(bc, 0.5), bc.lerp(cd, 0.5));
    let middle = abc.lerp(bcd, 0.5);
    let cut = [control[0], ab, abc, middle, middle, bcd, cd, control[3]];
    let curves = [
        PiecewiseBezier::new(u.clone(), &raised, 5, three).unwrap(),
        PiecewiseBezier::rational(u.clone(), &control, &[1.0; 4], 3, three).unwrap(),
        PiecewiseBezier::new(vec![u[0], 0.5 * (u[0] + u[1]), u[1]], &cut, 3, three).unwrap(),
    ];
    let of = |curve: &PiecewiseBezier| {
        let tolerances = Tolerances::default();
        let any = CurveChecker::new(polygon, curve, criteria, tolerances, INTERPOLATION).unwrap();
        assert_eq!(any.report().ok(), any.record(0, Criterion::Regular).satisfied);
        any.record(0, Criterion::Regular).satisfied
    };
    let [raised, rational, cut] = [0, 1, 2].map(|k| of(&curves[k]));
    [own.satisfied, raised, rational, cut]
}

#[test]
fn planted_stops_are_found_in_every_form_and_nothing_else_is() {
    let (mut stops, mut goes) = (0, 0);
    for case in 0..scaled(20_000) {
        let random = &mut Random::new(case as u64);
        // Also at halves and quarters, where subdivision looks, and at the ends.
        let t = if case % 3 == 0 {
            0.25 * (1 + case / 3 % 3) as f64
        } else {
            random.within(0.01, 0.99)
        };
        let on_line = case % 4 == 0;
        let off = if case % 2 == 0 { 0.0 } else { 10f64.powf(random.within(-6.0, 0.0)) };
        let legs = planted(t, on_line, off, random);
        let polygon = chord(legs, DVec3::ZERO);
        let holds = verdicts(&polygon, legs);
        if off == 0.0 {
            assert_eq!(holds, [false; 4], "{case} {t} {legs:?}");
            stops += 1;
        } else if on_line || sampled(legs) > 1e-9 {
            assert_eq!(holds, [true; 4], "{case} {t} {off:e} {legs:?}");
            goes += 1;
        }
    }
    assert!(stops > 800 && goes > 800, "{stops} {goes}");
}

/// What the criterion leaves out: where convexity, inflection or torsion holds no cubic stops.
#[test]
fn convexity_inflection_and_torsion_imply_a_regular_cubic() {
    let mut least = [f64::INFINITY; 3];
    let mut counts = [0; 3];
    for case in 0..scaled(60_000) {
        let (polygon, [a, c]) = segments::case(case, &mut Random::new(case as u64));
        let m = segments::SEGMENT;
        let checker = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
        let all = [Criterion::Convexity, Criterion::Inflection, Criterion::Torsion];
        for (k, criterion) in all.into_iter().enumerate() {
            let record = checker.record(m, [a, c], criterion);
            if record.applicable && record.satisfied {
                assert!(!checker.record(m, [a, c], Criterion::Regular).applicable);
                least[k] = least[k].min(sampled([a, polygon.chord(m) - a - c, c]));
                counts[k] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&n| n > 300), "{counts:?}");
    assert!(least.iter().all(|&speed| speed > 1e-6), "{least:?}");
}

/// Points that go to and fro on a line of any direction: the curve has to turn round on it.
#[test]
fn plain_curves_through_points_that_double_back_on_a_line_are_not_regular() {
    for case in 0..scaled(3000) {
        let random = &mut Random::new(case as u64);
        let planar = case % 2 == 0;
        let v = random.vector();
        let direction = if planar { DVec3::new(v.x, v.y, 0.0) } else { v }.normalize();
        // The same place is the same point to the bit.
        let places = [0.0, 1.0, 0.0, 2.0, 1.5, 3.0, 0.0];
        let n = 2 + random.below(5);
        let start = if planar { DVec3::ZERO } else { random.vector() };
        let at = |place: &f64| start + direction * *place;
        let mut points: Vec<DVec3> = places[..=n].iter().map(at).collect();
        let along = Boundary::tangents(direction, direction * 0.5);
        let boundary = [Boundary::ZeroCurvature, along, Boundary::Periodic][case % 3];
        if boundary == Boundary::Periodic && points[n] != points[0] {
            points.push(points[0]);
        }
        let dimension = if planar { Dimension::Two } else { Dimension::Three };
        let parametrization = Parametrization::Chordal;
        let Ok(polygon) =
            DataPolygon::with_dimension(points, dimension, &parametrization, boundary)
        else {
            continue;
        };
        for family in Family::DEFAULTS {
            let name = format!("{case} {family:?} {:?}", polygon.points());
            let plain = family.plain(polygon.clone());
            let strict = Checker::new(&polygon, Criteria::DEFAULT, Tolerances::default());
            let report = strict.report(|i| plain.curve().cubic().legs()[i]);
            assert!(!report.ok() && report.count(Criterion::Regular).violated > 0, "{name}");
            // A fit may stop there, unless it was asked not to.
            let fit = family.fit(polygon.clone());
            assert_eq!(fit.diagnostics().status, Status::Solved, "{name}\n{}", fit.report);
            assert!(fit.report.count(Criterion::Regular).violated == 0, "{name}");
        }
    }
}

/// Faults C10, and the usual way to write a straight line as a cubic.
#[test]
fn what_stops_at_its_ends_is_not_regular() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
    let polygon =
        DataPolygon::planar(&points, &Parametrization::Chordal, Boundary::Periodic).unwrap();
    let spline = NuSpline::new(polygon, Tension::Uniform(0.0)).unwrap();
    assert!(spline.tangents().iter().all(|t| *t == DVec3::ZERO));
    let report = spline.check(Criteria::DEFAULT, Tolerances::default()).unwrap();
    assert!(!report.ok());
    let found: Vec<_> = report.violations.iter().map(|v| (v.segment, v.criterion)).collect();
    assert_eq!(found, [(0, Criterion::Regular), (1, Criterion::Regular)]);

    let line = [DVec3::ZERO, DVec3::ZERO, DVec3::X, DVec3::X];
    let curve = PiecewiseBezier::new(vec![0.0, 1.0], &line, 3, Dimension::Three).unwrap();
    let polygon = chord([DVec3::X / 3.0; 3], DVec3::ZERO);
    let (criteria, tolerances) = (Criteria::DEFAULT, Tolerances::default());
    let report = CurveChecker::new(&polygon, &curve, criteria, tolerances, INTERPOLATION);
    assert_eq!(report.unwrap().report().count(Criterion::Regular).violated, 1);
    // High tension makes legs short, and no curve stop, as long as there is anything left of them.
    for size in [1e-3, 1e-9, 1e-14, 1e-17, 1e-60] {
        let legs = [DVec3::X * size, DVec3::new(0.6, 0.8, 0.0) * size];
        let checker = Checker::new(&polygon, criteria, tolerances);
        assert_eq!(checker.report(|_| legs).ok(), size > 1e-16, "{size:e}");
        // What tension leaves of a leg is the fit's affair.
        let fit = Checker::new(&polygon, Criteria::OF_FITS, tolerances);
        assert!(fit.report(|_| legs).ok(), "{size:e}");
    }
}
