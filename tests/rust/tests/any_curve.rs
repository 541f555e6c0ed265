// SPDX-License-Identifier: MIT OR Apache-2.0

//! Curves that were not made here: degree, pieces, weights and where they come from do not matter.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{
    CurveChecker, CurveError, INTERPOLATION, check_curve, curve_inflections, polygon_inflections,
    polygon_shape,
};
use shapespline::geometry::{DVec4, PiecewiseBezier};
use shapespline::prelude::*;
use shapespline_tests::{
    feature_line,
    generate::{PolygonKind, Random},
    helix, segments,
};

/// Degree elevation of homogeneous control points.
fn elevated(p: &[DVec4]) -> Vec<DVec4> {
    let n = p.len();
    let at = |i: usize| {
        let s = i as f64 / n as f64;
        let before = if i > 0 { p[i - 1] * s } else { DVec4::ZERO };
        let after = if i < n { p[i] * (1.0 - s) } else { DVec4::ZERO };
        before + after
    };
    (0..=n).map(at).collect()
}

fn cubic_pieces(polygon: &DataPolygon, legs: impl Fn(usize) -> [DVec3; 2]) -> Vec<[DVec3; 4]> {
    let points = polygon.points();
    (0..polygon.segments())
        .map(|i| (legs(i), points[i], points[i + 1]))
        .map(|([a, c], p, q)| [p, p + a, q - c, q])
        .collect()
}

/// The ways to write a piecewise cubic down.
fn forms(polygon: &DataPolygon, pieces: &[[DVec3; 4]]) -> Vec<(&'static str, PiecewiseBezier)> {
    let u = polygon.parameters().to_vec();
    let plain: Vec<DVec3> = pieces.iter().flatten().copied().collect();
    let curve =
        |breaks: Vec<f64>, p: &[DVec3], d| PiecewiseBezier::new(breaks, p, d, Dimension::Three);
    let raised = |times: usize| -> Vec<DVec3> {
        let raise = |p: &[DVec3; 4]| {
            let mut p: Vec<DVec4> = p.iter().map(|x| x.extend(1.0)).collect();
            (0..times).for_each(|_| p = elevated(&p));
            p
        };
        pieces.iter().flat_map(raise).map(|x| x.truncate()).collect()
    };
    // Every piece cut in three.
    let mut breaks = vec![u[0]];
    let mut parts = Vec::new();
    let whole = curve(u.clone(), &plain, 3).unwrap();
    for w in u.windows(2) {
        let h = w[1] - w[0];
        let cuts = [w[0], w[0] + 0.3 * h, w[0] + 0.8 * h, w[1]];
        for c in cuts.windows(2) {
            let found = whole.between([c[0], c[1]], DVec3::ZERO);
            parts.extend(found[0].control.iter().map(|p| p.truncate()));
            breaks.push(c[1]);
        }
    }
    let coefficients: Vec<DVec3> = pieces
        .iter()
        .zip(u.windows(2))
        .flat_map(|([a, b, c, d], w)| {
            let h = w[1] - w[0];
            let cubic = (*d - *c * 3.0 + *b * 3.0 - *a) / (h * h * h);
            [cubic, (*c - *b * 2.0 + *a) * (3.0 / (h * h)), (*b - *a) * (3.0 / h), *a]
        })
        .collect();
    let ones = vec![1.0; plain.len()];
    let three = Dimension::Three;
    vec![
        ("plain", whole),
        ("quartic", curve(u.clone(), &raised(1), 4).unwrap()),
        ("septic", curve(u.clone(), &raised(4), 7).unwrap()),
        ("cut", curve(breaks, &parts, 3).unwrap()),
        ("power", PiecewiseBezier::from_power(u.clone(), &coefficients, 3, three).unwrap()),
        ("weights 1", PiecewiseBezier::rational(u, &plain, &ones, 3, three).unwrap()),
    ]
}

#[test]
fn every_form_of_a_cubic_has_the_verdicts_of_the_cubic() {
    let mut random = Random::new(31);
    let (mut compared, mut open) = (0, 0);
    for k in 0..900 {
        let (polygon, end) = segments::case(k, &mut random);
        let m = segments::SEGMENT;
        // The neighbours go on in the same directions: what a corner asks beyond, no single segment says.
        let straight = |i: usize| polygon.chord(i) / 3.0;
        let legs = |i: usize| match i {
            _ if i == m => end,
            _ if i + 1 == m => [straight(i), end[0]],
            _ if i == m + 1 => [end[1], straight(i)],
            _ => [straight(i); 2],
        };
        let cubic = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
        for (name, curve) in forms(&polygon, &cubic_pieces(&polygon, legs)) {
            let tolerances = Tolerances::default();
            let any = CurveChecker::new(&polygon, &curve, Criteria::ALL, tolerances, 1e-9);
            let any = any.unwrap();
            for criterion in Criterion::ALL {
                let (a, b) = (cubic.record(m, end, criterion), any.record(m, criterion));
                assert_eq!(a.applicable, b.applicable);
                if !a.applicable {
                    continue;
                }
                if let Some(undecided) = any.undecided(m, criterion) {
                    open += 1;
                    assert!(a.margin.abs() < 1e-9, "{k} {name}: {undecided:?} {a:?}");
                    continue;
                }
                compared += 1;
                assert_eq!(a.satisfied, b.satisfied, "{k} {name}: {a:?} {b:?}");
                assert_eq!(b.margin > 0.0, b.satisfied);
                if name == "plain" {
                    // The legs are differences of rounded points.
                    assert!((a.margin - b.margin).abs() < 1e-9, "{k}: {a:?} {b:?}");
                }
            }
        }
    }
    println!("{compared} verdicts compared, {open} open");
    assert!(compared > 9_000 && open * 1000 < compared);
}

#[test]
fn real_curves_in_every_form_have_one_report() {
    for polygon in [feature_line(), helix(1.0)] {
        let spline = NuSpline::new(polygon.clone(), Tension::Uniform(0.0)).unwrap();
        let expected = spline.check(Criteria::ALL, Tolerances::default()).unwrap();
        let pieces = cubic_pieces(&polygon, |i| spline.curve().legs()[i]);
        for (name, curve) in forms(&polygon, &pieces) {
            let tolerances = Tolerances::default();
            let report = check_curve(&polygon, &curve, Criteria::ALL, tolerances).unwrap();
            assert_eq!(report.counts, expected.counts, "{name}");
            assert!(report.undecided.is_empty(), "{name}\n{report}");
            let places = |r: &ShapeReport| -> Vec<_> {
                r.violations.iter().map(|v| (v.segment, v.criterion)).collect()
            };
            assert_eq!(places(&report), places(&expected), "{name}");
        }
        let direct = PiecewiseBezier::from(spline.curve());
        let report = check_curve(&polygon, &direct, Criteria::ALL, Tolerances::default()).unwrap();
        assert_eq!(report.counts, expected.counts);
    }
}

/// Weights in geometric progression run through the same cubic at another speed: signs along the
/// whole segment stay what they are.
#[test]
fn weights_are_not_ignored() {
    let mut random = Random::new(77);
    let signs = [
        Criterion::Convexity,
        Criterion::Inflection,
        Criterion::Torsion,
        Criterion::GlobalConvexity,
    ];
    let (mut same, mut differ) = (0, 0);
    for k in 0..600 {
        let (polygon, end) = segments::case(k, &mut random);
        let m = segments::SEGMENT;
        let legs = |i: usize| if i == m { end } else { [polygon.chord(i) / 3.0; 2] };
        let pieces = cubic_pieces(&polygon, legs);
        let plain: Vec<DVec3> = pieces.iter().flatten().copied().collect();
        let u = polygon.parameters().to_vec();
        let three = Dimension::Three;
        let cubic = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
        let rational = |weights: &[f64]| {
            PiecewiseBezier::rational(u.clone(), &plain, weights, 3, three).unwrap()
        };
        let ratio = random.within(0.4, 2.5);
        let progression: Vec<f64> = (0..plain.len()).map(|i| ratio.powi(i as i32 % 4)).collect();
        let curve = rational(&progression);
        let tolerances = Tolerances::default();
        let any = CurveChecker::new(&polygon, &curve, Criteria::ALL, tolerances, 1e-9).unwrap();
        for criterion in signs {
            let (a, b) = (cubic.record(m, end, criterion), any.record(m, criterion));
            if a.applicable && any.undecided(m, criterion).is_none() {
                assert_eq!(a.satisfied, b.satisfied, "{k}: {a:?} {b:?}");
                same += 1;
            }
        }
    }
    assert!(same > 500, "{same}");

    // Other weights make another curve: its inflections are those of its positions.
    let turn = |a: DVec3, b: DVec3| a.x * b.y - a.y * b.x;
    for k in 0..400 {
        let p = [0; 4].map(|_| DVec3::new(random.vector().x, random.vector().y, 0.0));
        let weights = [0; 4].map(|_| 10f64.powf(random.within(-1.0, 1.0)));
        let (u, plane) = (vec![0.0, 1.0], Dimension::Two);
        let curve = PiecewiseBezier::rational(u.clone(), &p, &weights, 3, plane).unwrap();
        let plain = PiecewiseBezier::new(u, &p, 3, plane).unwrap();
        let q: Vec<DVec3> = (0..=4000).map(|i| curve.position(f64::from(i) / 4000.0)).collect();
        let turns: Vec<f64> = q.windows(3).map(|w| turn(w[1] - w[0], w[2] - w[1])).collect();
        let size = turns.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let clear = turns.iter().filter(|x| x.abs() > 1e-6 * size).map(|x| *x > 0.0);
        let signs: Vec<bool> = clear.collect();
        let seen = signs.windows(2).filter(|w| w[0] != w[1]).count();
        let count = curve_inflections(&curve).count;
        assert_eq!(count, seen, "{k}: {p:?} {weights:?}");
        differ += usize::from(count != curve_inflections(&plain).count);
    }
    assert!(differ > 5, "{differ}");
}

#[test]
fn splines_with_knots_between_the_points() {
    // A quintic B-spline; the data are points on it, at parameters that are no knots.
    let control: Vec<DVec3> = (0..12)
        .map(f64::from)
        .map(|x| DVec3::new((0.7 * x).cos(), (0.7 * x).sin(), 0.3 * x))
        .collect();
    let knots: Vec<f64> = (0..18).map(f64::from).collect();
    let curve = PiecewiseBezier::from_bspline(&knots, &control, 5, Dimension::Three).unwrap();
    let u: Vec<f64> = (0..6).map(|i| 5.3 + 1.2 * f64::from(i)).collect();
    let points = u.iter().map(|&u| curve.position(u)).collect();
    let given = Parametrization::Given(u);
    let polygon = DataPolygon::new(points, &given, Boundary::ZeroCurvature).unwrap();
    let report = check_curve(&polygon, &curve, Criteria::ALL, Tolerances::default()).unwrap();
    // It winds about a line, as its points do.
    assert!(report.ok(), "{report}");
    assert!(report.count(Criterion::Convexity).applicable >= 3);

    // A polyline turns nowhere between its points, and at a corner the wrong way.
    let p = polygon.points();
    let mut line: Vec<DVec3> = Vec::new();
    let mut breaks = vec![polygon.parameters()[0]];
    for i in 0..polygon.segments() {
        let inwards = p[i].lerp(p[i + 1], 0.5) * DVec3::new(0.5, 0.5, 1.0);
        line.extend([p[i], inwards, inwards, p[i + 1]]);
        let (from, to) = (polygon.parameters()[i], polygon.parameters()[i + 1]);
        breaks.extend([0.5 * (from + to), to]);
    }
    let corners = PiecewiseBezier::new(breaks, &line, 1, Dimension::Three).unwrap();
    let report = check_curve(&polygon, &corners, Criteria::DEFAULT, Tolerances::default()).unwrap();
    let count = report.count(Criterion::Convexity);
    assert_eq!(count.violated, count.applicable);
}

/// Margins of curves that are no cubics, worked out by hand.
#[test]
fn margins_of_a_parabola_and_of_a_cube_by_hand() {
    let record = |points: [[f64; 2]; 4], legs: [[f64; 2]; 2], criterion: Criterion| {
        let natural = Boundary::ZeroCurvature;
        let polygon = DataPolygon::planar(&points, &Parametrization::Uniform, natural).unwrap();
        let own = legs.map(|[x, y]| DVec3::new(x, y, 0.0));
        let legs = |i: usize| if i == 1 { own } else { [polygon.chord(i) / 3.0; 2] };
        let pieces = cubic_pieces(&polygon, legs);
        let raised = pieces.iter().flat_map(|p| elevated(&p.map(|p| p.extend(1.0))));
        let control: Vec<DVec3> = raised.map(|p| p.truncate()).collect();
        let breaks = polygon.parameters().to_vec();
        let curve = PiecewiseBezier::new(breaks, &control, 4, Dimension::Two).unwrap();
        let tolerances = Tolerances::default();
        let any = CurveChecker::new(&polygon, &curve, Criteria::ALL, tolerances, INTERPOLATION);
        any.unwrap().record(1, criterion)
    };
    // y = x² on [0, 1]: ω/(‖γ'‖ σ₂) and 2(γ×γ')/(t²‖γ'‖ σ₂) are 1/√(1+4t²), the third quotient is 1.
    let parabola = [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [2.0, 4.0]];
    let legs = [[1.0 / 3.0, 0.0], [1.0 / 3.0, 2.0 / 3.0]];
    for criterion in [Criterion::Convexity, Criterion::GlobalConvexity] {
        let found = record(parabola, legs, criterion);
        assert!((found.margin - 0.2f64.sqrt()).abs() < 1e-8, "{found:?}");
        assert!((found.location - 2.0).abs() < 1e-6, "{found:?}");
    }
    // y = (x − 1/2)³ on [0, 1]: at the ends ω = ∓3, ‖γ'‖ = 5/4, σ₂ = 3; between them it falls by more.
    let cube = [[-1.0, -2.125], [0.0, -0.125], [1.0, 0.125], [2.0, 2.125]];
    let found = record(cube, [[1.0 / 3.0, 0.25]; 2], Criterion::Inflection);
    assert!((found.margin - 0.8).abs() < 1e-8, "{found:?}");
}

/// A quintic whose `ω`, along the two binormal vectors, is a pair of cubics that are given: where the pair
/// turns back on its way, some view shows more than one inflection.
#[test]
fn what_turns_back_between_the_binormals_is_no_inflection() {
    let points = [[-1.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [2.0, -1.0, -1.0]];
    let points = points.map(DVec3::from).to_vec();
    let polygon =
        DataPolygon::new(points.clone(), &Parametrization::Uniform, Boundary::ZeroCurvature);
    let polygon = polygon.unwrap();
    let keeps = |x: [f64; 4], y: [f64; 4]| {
        // γ' = (1, f, g) has ω = (…, −g', f'); the binormal vectors are (0, 0, 1), (0, 1, −1)/√2.
        let integral = |slope: [f64; 4]| {
            let mut sums = [0.0; 5];
            (0..4).for_each(|i| sums[i + 1] = sums[i] + slope[i] / 4.0);
            let mean = sums.iter().sum::<f64>() / 5.0;
            sums.map(|s| s - mean)
        };
        let f = integral(x);
        let g = integral(std::array::from_fn(|i| 2f64.sqrt() * y[i] - x[i]));
        let mut control: Vec<DVec3> = Vec::new();
        for i in 0..3 {
            let mut p = points[i];
            control.push(p);
            for k in 0..5 {
                let own = DVec3::new(1.0, f[k], g[k]);
                p += if i == 1 { own } else { polygon.chord(i) } / 5.0;
                control.push(p);
            }
        }
        let breaks = polygon.parameters().to_vec();
        let curve = PiecewiseBezier::new(breaks, &control, 5, Dimension::Three).unwrap();
        let tolerances = Tolerances::default();
        let any = CurveChecker::new(&polygon, &curve, Criteria::ALL, tolerances, INTERPOLATION);
        let any = any.unwrap();
        assert_eq!(any.undecided(1, Criterion::Inflection), None);
        let record = any.record(1, Criterion::Inflection);
        assert!(record.applicable);
        record.satisfied
    };
    // Both fall. Both have the signs asked for at the ends, but go up on their way: through the second
    // quadrant of (x, y), and mirrored through the fourth.
    let (falls, later) = ([1.0, -1.0, -3.0, -6.0], [4.0, 3.0, 1.0, -2.0]);
    assert!(keeps(falls, later) && keeps(later, falls));
    let (back, above) = ([1.0, -12.0, 12.0, -6.0], [4.0, -7.0, 14.0, -2.0]);
    assert!(!keeps(back, above));
    assert!(!keeps(above, back));
}

/// Where the parameter begins makes no difference: breaks half a spacing from the points' parameters are
/// not those parameters, however large all of them are.
#[test]
fn a_shift_of_the_parameter_changes_nothing() {
    // The curve (u, u², u³), by blossoming.
    let at = |[a, b, c]: [f64; 3]| {
        DVec3::new((a + b + c) / 3.0, (a * b + b * c + c * a) / 3.0, a * b * c)
    };
    let breaks = [0.0, 1.5, 2.0, 3.0];
    let control: Vec<DVec3> = breaks
        .windows(2)
        .map(|w| [w[0], w[1]])
        .flat_map(|[p, q]| [[p; 3], [p, p, q], [p, q, q], [q; 3]].map(at))
        .collect();
    let margins = |shift: f64| {
        let u: Vec<f64> = (0..4).map(|i| f64::from(i) + shift).collect();
        let points = (0..4).map(f64::from).map(|u| at([u; 3])).collect();
        let given = Parametrization::Given(u);
        let polygon = DataPolygon::new(points, &given, Boundary::ZeroCurvature).unwrap();
        let breaks = breaks.map(|u| u + shift).to_vec();
        let curve = PiecewiseBezier::new(breaks, &control, 3, Dimension::Three).unwrap();
        let tolerances = Tolerances::default();
        let any = CurveChecker::new(&polygon, &curve, Criteria::ALL, tolerances, INTERPOLATION);
        let any = any.unwrap();
        [Criterion::Convexity, Criterion::Torsion].map(|c| any.record(1, c).margin)
    };
    let (near, far) = (margins(0.0), margins(2f64.powi(40)));
    assert!(near.iter().all(|&m| m > 0.0), "{near:?}");
    for (near, far) in near.into_iter().zip(far) {
        assert!((near - far).abs() < 1e-9, "{near} {far}");
    }
}

#[test]
fn what_rounding_hides_is_undecided() {
    // A quadratic in a plane off the axes, raised to a quintic: torsion is zero to rounding.
    let points = [[0.1, 0.2, 0.3], [1.3, 0.1, 0.7], [1.7, 1.9, 1.1], [0.4, 2.3, 3.1]];
    let points: Vec<DVec3> = points.map(DVec3::from).to_vec();
    let mut control = Vec::new();
    for w in points.windows(2) {
        let off = DVec3::new(0.3, -0.2, 0.1);
        let mut p: Vec<DVec4> =
            [w[0], w[0].lerp(w[1], 0.5) + off, w[1]].iter().map(|p| p.extend(1.0)).collect();
        (0..3).for_each(|_| p = elevated(&p));
        control.extend(p.iter().map(|p| p.truncate()));
    }
    let u = vec![0.0, 1.0, 2.0, 3.0];
    let curve = PiecewiseBezier::new(u, &control, 5, Dimension::Three).unwrap();
    let polygon =
        DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap();
    // Its pieces meet in corners.
    let criteria = Criteria::DEFAULT.without(Criterion::Turning);
    let report = check_curve(&polygon, &curve, criteria, Tolerances::default()).unwrap();
    let open: Vec<_> = report.undecided.iter().map(|x| (x.segment, x.criterion)).collect();
    assert_eq!(open, [(1, Criterion::Torsion)]);
    let [from, to] = report.undecided[0].interval;
    assert!(from >= 1.0 && to <= 2.0);
    assert!(report.ok() && report.verdict() == "undecided", "{report}");
}

#[test]
fn curves_that_do_not_belong_to_the_points_are_refused() {
    let points: Vec<DVec3> =
        (0..4).map(f64::from).map(|x| DVec3::new(x, x * x, x * x * x)).collect();
    let control = |points: &[DVec3]| -> Vec<DVec3> {
        points.windows(2).flat_map(|w| [w[0], w[0].lerp(w[1], 0.4), w[1]]).collect()
    };
    let breaks = |shift: f64| (0..4).map(|i| f64::from(i) + shift).collect::<Vec<f64>>();
    let polygon =
        DataPolygon::new(points.clone(), &Parametrization::Uniform, Boundary::ZeroCurvature);
    let polygon = polygon.unwrap();
    let check = |curve: &PiecewiseBezier| {
        check_curve(&polygon, curve, Criteria::DEFAULT, Tolerances::default())
    };
    let make = |shift: f64, p: &[DVec3]| {
        PiecewiseBezier::new(breaks(shift), p, 2, Dimension::Three).unwrap()
    };
    assert!(check(&make(0.0, &control(&points))).is_ok());

    let mut moved = points.clone();
    moved[2].y += 1e-3;
    match check(&make(0.0, &control(&moved))).unwrap_err() {
        CurveError::Mismatch { point: 2, parameter, distance, .. } => {
            assert_eq!(parameter, 2.0);
            assert!((distance - 1e-3).abs() < 1e-12);
        }
        other => panic!("{other}"),
    }
    let wide = make(0.0, &control(&moved));
    let tolerances = Tolerances::default();
    assert!(CurveChecker::new(&polygon, &wide, Criteria::DEFAULT, tolerances, 1e-3).is_ok());
    assert!(CurveChecker::new(&polygon, &wide, Criteria::DEFAULT, tolerances, f64::NAN).is_err());
    let strict = Tolerances { coplanarity: 0.0, ..tolerances };
    assert!(CurveChecker::new(&polygon, &wide, Criteria::DEFAULT, strict, INTERPOLATION).is_err());

    let message = check(&make(0.5, &control(&points))).unwrap_err().to_string();
    assert!(message.contains("parameters[0] = 0") && message.contains("[0.5, 3.5]"), "{message}");
    let message = check(&make(-0.5, &control(&points))).unwrap_err().to_string();
    assert!(message.contains("parameters[3] = 3"), "{message}");

    let mut jump = control(&points);
    let mut halves = breaks(0.0);
    halves.insert(1, 0.5);
    jump.splice(
        0..3,
        [points[0]; 3].into_iter().chain([points[0].lerp(points[1], 0.5), points[1], points[1]]),
    );
    let jumping = PiecewiseBezier::new(halves, &jump, 2, Dimension::Three).unwrap();
    let error = check(&jumping).unwrap_err();
    assert!(matches!(error, CurveError::Jump { parameter, .. } if parameter == 0.5), "{error}");

    let flat = PiecewiseBezier::new(breaks(0.0), &control(&points), 2, Dimension::Two).unwrap();
    let message = check(&flat).unwrap_err().to_string();
    assert!(message.contains("points have 3") && message.contains("curve has 2"), "{message}");

    let bad = |breaks: Vec<f64>, p: &[DVec3], d: usize| {
        PiecewiseBezier::new(breaks, p, d, Dimension::Three).unwrap_err().to_string()
    };
    let good = control(&points);
    assert!(bad(breaks(0.0), &good[1..], 2).contains("control must have length 9"));
    assert!(bad(vec![0.0, 1.0, 1.0, 2.0], &good, 2).contains("breaks[2] = 1"));
    assert!(bad(breaks(0.0), &good, 0).contains("degree must be between 1 and 18, got 0"));
    assert!(bad(vec![0.0], &[], 2).contains("breaks must hold at least 2"));
    let mut nan = good.clone();
    nan[4].y = f64::NAN;
    assert!(bad(breaks(0.0), &nan, 2).contains("control[4] must be finite, got NaN"));
    let spline = |knots: &[f64]| {
        PiecewiseBezier::from_bspline(knots, &points, 2, Dimension::Three).unwrap_err().to_string()
    };
    assert!(spline(&[0.0, 1.0, 2.0, 1.5, 4.0, 5.0, 6.0]).contains("knots[3] = 1.5"));
    assert!(spline(&[0.0; 5]).contains("knots must have length 7"));
    assert!(spline(&[0.0; 7]).contains("knots"));
}

/// What a check and its kin hand out is plain data: written and read again it is the same.
#[test]
fn reports_can_be_written_and_read() {
    fn again<T: serde::Serialize + serde::de::DeserializeOwned>(x: &T) -> T {
        postcard::from_bytes(&postcard::to_stdvec(x).unwrap()).unwrap()
    }
    let mut random = Random::new(17);
    let points = PolygonKind::Walk.points(12, &mut random);
    let natural = Boundary::ZeroCurvature;
    let polygon = DataPolygon::new(points.clone(), &Parametrization::Uniform, natural).unwrap();
    let checker = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
    let legs = |i: usize| [DVec3::new(0.3, 0.1, -0.2), polygon.chord(i) / 3.0];
    let report = checker.report(legs);
    assert!(report.violations.len() > 3, "{report}");
    assert_eq!(again(&report), report);
    let notes = checker.node_conditions(legs);
    assert!(!notes.nodes.is_empty());
    assert_eq!(again(&notes), notes);
    let record = checker.record(1, legs(1), Criterion::Torsion);
    assert_eq!(again(&record), record);
    let count = polygon_inflections(&points, Dimension::Three).unwrap();
    assert_eq!(again(&count), count);
    let shape = polygon_shape(&polygon, &Tolerances::default());
    // The torsion of the end segments is NaN: not equal to itself.
    assert_eq!(format!("{:?}", again(&shape)), format!("{shape:?}"));
}

#[test]
fn the_report_on_a_clean_curve_takes_no_memory() {
    for n in [100, 20_000] {
        let turn = |k: usize| (0.5 * k as f64).sin_cos();
        let points = (0..n).map(|k| DVec3::new(turn(k).0, turn(k).1, 0.2 * k as f64)).collect();
        let natural = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(points, &Parametrization::Uniform, natural).unwrap();
        let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default()).unwrap();
        let report = fit.curve.check(Criteria::DEFAULT, Tolerances::default()).unwrap();
        assert!(report.ok() && report.segments == n - 1, "{report}");
        assert!(report.count(Criterion::Torsion).applicable > n / 2);
        assert_eq!((report.violations.capacity(), report.undecided.capacity()), (0, 0));
    }
}
