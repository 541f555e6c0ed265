// SPDX-License-Identifier: MIT OR Apache-2.0

//! What every family promises, on every kind of polygon.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::{geometry::Domain, prelude::*};
use shapespline_tests::{
    families::Family,
    feature_line,
    generate::{PolygonKind, Random, polygon},
    helix, points,
};

#[test]
fn no_violation_on_thousands_of_polygons() {
    let mut random = Random::new(17);
    for kind in PolygonKind::ALL {
        for case in 0..300 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            for family in Family::DEFAULTS {
                let fit = family.fit(polygon.clone());
                let name = format!("{kind:?} {case} {family:?}: {:?}", fit.diagnostics());
                assert_eq!(fit.diagnostics().status, Status::Solved, "{name}\n{}", fit.report);
                assert!(fit.report.ok() && fit.report == fit.spline.report(), "{name}");
                for (i, &p) in polygon.points().iter().enumerate() {
                    let u = polygon.parameters()[i];
                    assert_eq!(fit.spline.curve().evaluate(u, 0, Side::Right), p, "{name} {i}");
                }
            }
        }
    }
}

#[test]
fn no_violation_on_the_data_sets() {
    for name in ["gps_mojstrovka.csv", "protein_1a8o_ca.csv", "coil_m16n08_first.csv"] {
        let points = points(name);
        let closed = points[0] == points[points.len() - 1];
        for parametrization in
            [Parametrization::Uniform, Parametrization::Chordal, Parametrization::Centripetal]
        {
            for boundary in [Boundary::ZeroCurvature, Boundary::Circular, Boundary::Periodic] {
                if boundary == Boundary::Periodic && !closed {
                    continue;
                }
                let polygon = DataPolygon::new(points.clone(), &parametrization, boundary).unwrap();
                for family in Family::ALL {
                    if family == Family::Nu(Strategy::Nussp) {
                        continue; // slow by its rule
                    }
                    let fit = family.fit(polygon.clone());
                    let name = format!("{name} {parametrization:?} {boundary:?} {family:?}");
                    assert_eq!(fit.diagnostics().status, Status::Solved, "{name}");
                    assert!(fit.spline.report().ok(), "{name}");
                }
            }
        }
    }
    for polygon in [feature_line(), helix(6.0)] {
        for family in Family::ALL {
            assert!(family.fit(polygon.clone()).spline.report().ok(), "{family:?}");
        }
    }
}

/// Of a curve with unit weights: whether `ω·n` and the two products of global convexity (002,
/// Definition 3.16) are positive, by dense sampling of the segment itself.
fn globally_convex(legs: [DVec3; 3], n: DVec3) -> bool {
    let [a, b, c] = legs;
    (1..200).all(|k| {
        let t = f64::from(k) / 200.0;
        let s = 1.0 - t;
        let position = a * (3.0 * t * s * s + 3.0 * t * t * s + t * t * t)
            + b * (3.0 * t * t * s + t * t * t)
            + c * (t * t * t);
        let velocity = (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * 3.0;
        let acceleration = ((b - a) * s + (c - b) * t) * 6.0;
        velocity.cross(acceleration).dot(n) > 0.0
            && position.cross(velocity).dot(n) >= 0.0
            && a.cross(position).dot(n) >= 0.0
    })
}

#[test]
fn catmull_rom_is_globally_convex_and_never_twists_the_wrong_way() {
    let mut random = Random::new(23);
    let (mut convex, mut twisted) = (0, 0);
    for kind in [
        PolygonKind::Walk,
        PolygonKind::Track,
        PolygonKind::Planar,
        PolygonKind::ChordRatios,
        PolygonKind::DoublingBack,
    ] {
        for case in 0..200 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            for continuity in [Continuity::C1, Continuity::G1] {
                let family = Family::CatmullRom(continuity);
                let torsion = family.plain(polygon.clone()).report().count(Criterion::Torsion);
                assert_eq!(torsion.violated, 0, "{kind:?} {case}");
                twisted += torsion.applicable;
                let fit = family.fit(polygon.clone());
                for i in 0..polygon.segments() {
                    let [p, q] = [i, i + 1].map(|i| polygon.binormal(i));
                    // Turns so slight that sampled products are rounding are left to the exact check.
                    if p.dot(q) > 1e-6 * p.length() * q.length()
                        && p.length().min(q.length()) > 1e-4
                    {
                        let s = fit.cubic().segment(i);
                        let size = polygon.chord(i).length();
                        let legs = [s.a / size, s.b / size, s.c / size];
                        assert!(
                            [p, q].iter().all(|n| globally_convex(legs, n.normalize())),
                            "{kind:?} {case} {i}"
                        );
                        convex += 1;
                    }
                }
            }
        }
    }
    assert!(convex > 5000 && twisted > 5000, "{convex} {twisted}");
}

#[test]
fn c2_in_its_parameter_down_to_small_lambda() {
    let mut random = Random::new(5);
    for kind in [PolygonKind::Walk, PolygonKind::Track, PolygonKind::Planar] {
        for case in 0..60 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            let mut lambda = || 10f64.powf(random.within(-3.0, 0.0));
            let n = polygon.segments();
            let (starts, ends): (Vec<f64>, Vec<f64>) = (0..n).map(|_| (lambda(), lambda())).unzip();
            let closed = polygon.is_closed();
            let scale = TangentScale::Segments(&starts, &ends);
            let spline = TensionSpline::new(polygon, scale).unwrap();
            let curve = spline.curve();
            let knots = curve.cubic().knots();
            let nodes = if closed { 0..n } else { 1..n };
            for i in nodes {
                for order in 0..3 {
                    let [left, right] =
                        [Side::Left, Side::Right].map(|side| curve.evaluate(knots[i], order, side));
                    // Relative to what the two sides are made of: a second derivative that happens
                    // to vanish is a difference of terms of the size of chords over h²λ².
                    let size = if order == 2 {
                        let near = |j: usize, l: f64| {
                            let h = knots[j + 1] - knots[j];
                            (curve.cubic().points()[j + 1] - curve.cubic().points()[j]).length()
                                / (h * h * l * l)
                        };
                        let before = if i == 0 { n - 1 } else { i - 1 };
                        near(before, ends[before]).max(near(i, starts[i]))
                    } else {
                        1.0f64.max(left.length())
                    };
                    let jump = (left - right).length();
                    assert!(jump <= 1e-10 * size, "{kind:?} {case} {i} {order}: {left} {right}");
                }
            }
        }
    }
}

#[test]
fn lambda_one_is_the_c2_cubic_and_one_lambda_a_node_a_nu_spline() {
    let mut random = Random::new(31);
    for kind in [PolygonKind::Walk, PolygonKind::Track, PolygonKind::Planar, PolygonKind::Walk] {
        for case in 0..100 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            let n = polygon.points().len();
            let closed = polygon.is_closed();
            let mut lambda: Vec<f64> = (0..n).map(|_| random.within(0.01, 1.0)).collect();
            if case % 2 == 0 {
                lambda.fill(1.0);
            }
            if closed {
                lambda[n - 1] = lambda[0];
            }
            // (3.10), with the factor that makes ν dimensionless.
            let interior = |before: usize, i: usize, after: usize| {
                let (h0, h1) = (polygon.spacing(before), polygon.spacing(i));
                let (l0, l, l1) = (lambda[before], lambda[i], lambda[after]);
                (h0 * h1).sqrt()
                    * ((6.0 - 4.0 * l - 2.0 * l1) / h1 + (6.0 - 2.0 * l0 - 4.0 * l) / h0)
                    / l
            };
            // Given tangents: (1+ν) q = D and q = λD. Zero curvature: (2 + ½ν) q + q' = 3L/h and
            // (3−λ')/λ q + q' = 3L/h.
            let end = |i: usize, beside: usize| match polygon.tangents()[usize::from(i > 0)] {
                Some(_) => 1.0 / lambda[i] - 1.0,
                None => 2.0 * ((3.0 - lambda[beside]) / lambda[i] - 2.0),
            };
            let segments = polygon.segments();
            let mut tension = vec![0.0; n];
            for i in 1..segments {
                tension[i] = interior(i - 1, i, i + 1);
            }
            (tension[0], tension[segments]) = if closed {
                let nu = interior(segments - 1, 0, 1);
                (nu, nu)
            } else {
                (end(0, 1), end(segments, segments - 1))
            };
            // λ = 1 gives zero up to rounding.
            tension.iter_mut().for_each(|nu| *nu = nu.max(0.0));
            let size = (0..segments)
                .map(|i| polygon.chord(i).length() / polygon.spacing(i))
                .fold(0.0, f64::max);
            let nu = NuSpline::new(polygon.clone(), Tension::Nodes(&tension)).unwrap();
            let manni = TensionSpline::new(polygon, TangentScale::Nodes(&lambda)).unwrap();
            let allowed = if case % 2 == 0 { 1e-12 } else { 1e-11 } * size;
            for (i, (q, t)) in nu.tangents().iter().zip(manni.tangents()).enumerate() {
                assert!((*q - t * lambda[i]).length() <= allowed, "{kind:?} {case} {i}: {q} {t}");
            }
        }
    }
}

#[test]
fn limits_of_lemma_4_1_to_4_3() {
    let mut random = Random::new(41);
    for case in 0..200 {
        let Some(polygon) = polygon(PolygonKind::Walk, case, &mut random) else { continue };
        let segments = polygon.segments();
        let ratio = random.within(0.2, 1.0);
        let spline = |lambda: f64| {
            let (starts, ends) = (vec![lambda; segments], vec![lambda * ratio; segments]);
            TensionSpline::new(polygon.clone(), TangentScale::Segments(&starts, &ends)).unwrap()
        };
        let tense = spline(1e-9);
        let tangents = tense.tangents();
        for i in 1..segments {
            let (h0, h1) = (polygon.spacing(i - 1), polygon.spacing(i));
            let weight = h0 * ratio * ratio / (h0 * ratio * ratio + h1);
            let limit = (polygon.chord(i - 1) / h0).lerp(polygon.chord(i) / h1, weight);
            assert!((tangents[i] - limit).length() < 1e-7 * (1.0 + limit.length()), "{case} {i}");
        }
        let report = tense.check(Criteria::DEFAULT, Tolerances::default()).unwrap();
        for criterion in [Criterion::Convexity, Criterion::Inflection, Criterion::Torsion] {
            assert_eq!(report.count(criterion).violated, 0, "{case} {criterion}");
        }
    }
}

#[test]
fn the_reduction_of_paper_000_on_the_feature_line() {
    let reduction = |step| {
        let options = SearchOptions { strategy: Strategy::Reduction, step, ..Default::default() };
        TensionSpline::shape_preserving(feature_line(), &options).unwrap()
    };
    let plain = TensionSpline::new(feature_line(), TangentScale::Uniform(1.0)).unwrap();
    let criteria = Criteria::DEFAULT.without(Criterion::Turning);
    let report = plain.check(criteria, Tolerances::default()).unwrap();
    let found: Vec<(usize, Criterion)> =
        report.violations.iter().map(|v| (v.segment + 1, v.criterion)).collect();
    assert_eq!(
        found,
        [
            (1, Criterion::Convexity),
            (2, Criterion::Torsion),
            (5, Criterion::Torsion),
            (16, Criterion::Torsion),
        ]
    );
    let half = reduction(0.5);
    let expected: Vec<f64> =
        (1..=20).map(|k| if k <= 7 || (15..=18).contains(&k) { 1.0 } else { 0.0 }).collect();
    assert_eq!(half.curve.tension(), expected);
    assert_eq!(half.outcome.diagnostics.iterations, 2);
    assert_eq!(reduction(0.9).outcome.diagnostics.iterations, 7);
}

#[test]
fn zero_curvature_and_closed_ends_are_what_they_say() {
    let mut random = Random::new(8);
    for case in 0..80 {
        let Some(polygon) = polygon(PolygonKind::Walk, case, &mut random) else { continue };
        let size = polygon.parameters()[polygon.segments()];
        for family in Family::DEFAULTS {
            let fit = family.fit(polygon.clone());
            let cubic = fit.cubic();
            let (first, last) = (cubic.segment(0), cubic.segment(cubic.segments() - 1));
            match (polygon.boundary(), cubic.domain()) {
                (Boundary::ZeroCurvature, Domain::Open) => {
                    assert!(first.a.cross(first.b).length() < 1e-12, "{family:?} {case}");
                    assert!(last.b.cross(last.c).length() < 1e-12, "{family:?} {case}");
                }
                (Boundary::Periodic, Domain::Closed) => {
                    let u = polygon.parameters()[0];
                    let [a, b] = [u, u + size]
                        .map(|u| fit.spline.curve().evaluate(u, 1, Side::Right).normalize());
                    assert!((a - b).length() < 1e-9, "{family:?} {case}");
                }
                _ => {}
            }
        }
    }
}

#[test]
fn many_curves_at_once_are_the_curves_one_by_one_and_faults_stay_alone() {
    let mut random = Random::new(3);
    let mut all = Vec::new();
    let mut offsets = vec![0];
    for k in 0..60 {
        let mut row = PolygonKind::ALL[k % 8].points(3 + random.below(40), &mut random);
        match k {
            7 => row[1] = row[0],
            11 => row[2] = DVec3::NAN,
            13 => row.clear(),
            _ => {}
        }
        all.extend(row);
        offsets.push(all.len());
    }
    let collection = Collection {
        points: Ragged::new(&all, &offsets).unwrap(),
        dimension: Dimension::Three,
        parametrization: Parametrization::Centripetal,
        boundary: Boundary::ZeroCurvature,
        closed: false,
        repeated: Repeated::Error,
    };
    for family in Family::DEFAULTS {
        let fits = |threads| fit_many(&collection, threads, |p| family.try_fit(p)).unwrap();
        let (one, two) = (fits(Some(1)), fits(Some(2)));
        assert_eq!(one.len(), 60);
        for (k, (a, b)) in one.iter().zip(&two).enumerate() {
            match (a, b) {
                (Ok(a), Ok(b)) => {
                    assert!(a.report.ok());
                    assert_eq!(a.cubic(), b.cubic());
                    let row = collection.points.row(k).to_vec();
                    let alone = DataPolygon::new(
                        row,
                        &Parametrization::Centripetal,
                        Boundary::ZeroCurvature,
                    );
                    assert_eq!(a.cubic(), family.fit(alone.unwrap()).cubic());
                }
                (Err(a), Err(b)) => {
                    let expected = match k {
                        7 => "points[1] repeats",
                        11 => "points[2] must be finite",
                        13 => "got 0",
                        _ => "repeats",
                    };
                    assert_eq!(a.to_string(), b.to_string());
                    assert!(a.to_string().contains(expected), "{k}: {a}");
                }
                _ => panic!("{k}: threads decide"),
            }
        }
        assert!(one.iter().filter(|r| r.is_ok()).count() >= 50);
    }
    let short = Collection { parametrization: Parametrization::Given(vec![0.0]), ..collection };
    let refused = fit_many(&short, None, |p| Family::DEFAULTS[0].try_fit(p)).err().unwrap();
    assert!(refused.to_string().contains("parameters"));
}

#[test]
fn bad_scales_tensions_and_safeties_are_refused() {
    let polygon = || {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE];
        DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap()
    };
    let scale = |s: TangentScale<'_>| TensionSpline::new(polygon(), s).unwrap_err().to_string();
    assert!(
        scale(TangentScale::Uniform(0.0))
            .contains("tangent_scale must be between 1e-65 and 1, got 0")
    );
    assert!(scale(TangentScale::Uniform(1.5)).contains("1.5"));
    assert!(scale(TangentScale::Uniform(f64::NAN)).contains("NaN"));
    assert!(scale(TangentScale::Nodes(&[1.0; 3])).contains("length 4"));
    assert!(scale(TangentScale::Nodes(&[1.0, 1.0, -1.0, 1.0])).contains("tangent_scale[2]"));
    assert!(scale(TangentScale::Segments(&[1.0; 3], &[1.0; 4])).contains("length 3"));
    let pair = scale(TangentScale::Segments(&[1.0; 3], &[1.0, 2.0, 1.0]));
    assert!(pair.contains("tangent_scale[1][1]") && pair.contains("got 2"), "{pair}");

    let tension = |t: f64| CatmullRom::new(polygon(), Tension::Uniform(t), Continuity::C1);
    assert!(tension(1.0).unwrap_err().to_string().contains("tension must be in [0, 1), got 1"));
    assert!(tension(-0.1).is_err() && tension(f64::NAN).is_err() && tension(0.99).is_ok());
    for safety in [0.0, 1.0, f64::NAN] {
        let options = HandleOptions { safety, ..HandleOptions::default() };
        let refused = CatmullRom::shape_preserving(polygon(), &options).unwrap_err();
        assert!(refused.to_string().contains("safety"), "{refused}");
    }
    let reduction =
        SearchOptions { strategy: Strategy::Reduction, step: 1.0, ..SearchOptions::default() };
    let refused = TensionSpline::shape_preserving(polygon(), &reduction).unwrap_err();
    assert!(refused.to_string().contains("step must be in (0, 1)"), "{refused}");
}

#[test]
fn curves_can_be_sent_shared_and_written() {
    fn thread_safe<T: Send + Sync + serde::Serialize + for<'a> serde::Deserialize<'a>>() {}
    thread_safe::<NuSpline>();
    thread_safe::<TensionSpline>();
    thread_safe::<CatmullRom>();
}

/// Planar zigzags with very uneven spacing inside a polygon that is not planar: the inflection has to
/// stay near (5.9), which equal `λ` alone would not bring about.
#[test]
fn split_coplanarity_with_uneven_spacing() {
    let mut random = Random::new(77);
    let mut called = 0;
    for case in 0..150 {
        let mut p = DVec3::ZERO;
        let (mut points, mut parameters, mut u) = (vec![p], vec![0.0], 0.0);
        for k in 0..14 {
            let up = if k % 2 == 0 { 1.0 } else { -1.0 };
            let out = if (3..10).contains(&k) { 0.0 } else { random.within(0.2, 1.0) };
            p += DVec3::new(1.0, up * random.within(0.5, 1.5), out);
            u += 10f64.powf(random.within(-3.0, 3.0));
            points.push(p);
            parameters.push(u);
        }
        let parametrization = Parametrization::Given(parameters);
        let boundary = if case % 2 == 0 {
            Boundary::ZeroCurvature
        } else {
            Boundary::tangents(DVec3::X + DVec3::Y, DVec3::X - DVec3::Y)
        };
        let polygon = DataPolygon::new(points, &parametrization, boundary).unwrap();
        for family in Family::DEFAULTS {
            let fit = family.fit(polygon.clone());
            let name = format!("{case} {family:?}: {:?}", fit.diagnostics());
            assert_eq!(fit.diagnostics().status, Status::Solved, "{name}");
            assert!(fit.diagnostics().iterations < 60, "{name}");
            called += fit.report.count(Criterion::Coplanarity).applicable;
        }
    }
    assert!(called > 1000, "{called}");
}

#[test]
fn global_convexity_on_request() {
    let mut random = Random::new(101);
    for kind in [PolygonKind::Walk, PolygonKind::Track, PolygonKind::Planar] {
        for case in 0..100 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            let criteria = Criteria::ALL.without(Criterion::Regular);
            let search = SearchOptions { criteria, ..SearchOptions::default() };
            let handles = HandleOptions { criteria, ..HandleOptions::default() };
            let fits = [
                NuSpline::shape_preserving(polygon.clone(), &search).map(|f| f.report),
                TensionSpline::shape_preserving(polygon.clone(), &search).map(|f| f.report),
                CatmullRom::shape_preserving(polygon, &handles).map(|f| f.report),
            ];
            assert!(fits.iter().all(|f| f.as_ref().unwrap().ok()), "{kind:?} {case}");
        }
    }
}
