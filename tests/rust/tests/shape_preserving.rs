// SPDX-License-Identifier: MIT OR Apache-2.0

//! Shape-preserving ν-splines on data that have been hard for somebody.
//!
//! The verdicts here are the library's own; `tests/test_shape_preserving.py` checks the same kinds of
//! data by dense sampling.
#![allow(clippy::unwrap_used, reason = "test code")]

use std::ops::ControlFlow;

use shapespline::{geometry::CubicSegment, prelude::*};
use shapespline_tests::{
    feature_line,
    generate::{PolygonKind, Random, polygon},
    helix, points,
};

fn options(strategy: Strategy) -> SearchOptions {
    SearchOptions { strategy, ..SearchOptions::default() }
}

#[test]
fn every_kind_of_polygon_is_solved_and_fairest_needs_no_more_tension_than_growth() {
    let mut random = Random::new(11);
    for kind in PolygonKind::ALL {
        for case in 0..250 {
            let Some(polygon) = polygon(kind, case, &mut random) else { continue };
            let growth =
                NuSpline::shape_preserving(polygon.clone(), &options(Strategy::Growth)).unwrap();
            let fairest = NuSpline::shape_preserving(polygon, &options(Strategy::Fairest)).unwrap();
            for fit in [&growth, &fairest] {
                let name = format!("{kind:?} {case}: {:?}", fit.outcome.diagnostics);
                assert_eq!(fit.outcome.diagnostics.status, Status::Solved, "{name}");
                let report = fit.curve.check(Criteria::OF_FITS, Tolerances::default()).unwrap();
                assert!(report.ok(), "{name}\n{report}");
                assert_eq!(report, fit.report);
            }
            let total = |fit: &Fit<NuSpline>| fit.curve.tension().iter().sum::<f64>();
            assert!(
                total(&fairest) <= total(&growth),
                "{kind:?} {case}: {:?} {:?}",
                fairest.outcome,
                growth.outcome
            );
        }
    }
}

/// The limit that the documentation states: where neighbouring spacings differ by 1e5, tangents lean from
/// the chord between the close parameters by 1e−10, and every family still finds its shape.
#[test]
fn spacings_that_differ_by_1e5_are_solved() {
    let mut random = Random::new(19);
    for case in 0..300 {
        let kind = if case % 2 == 0 { PolygonKind::Walk } else { PolygonKind::Planar };
        let points = kind.points(4 + case % 5, &mut random);
        let close = random.below(points.len() - 1);
        let spacing = |i: usize| if i == close { 1e-5 } else { 0.5 + random.unit() };
        let steps = (0..points.len() - 1).map(spacing);
        let mut u = vec![0.0];
        u.extend(steps.scan(0.0, |u, h| {
            *u += h;
            Some(*u)
        }));
        let given = Parametrization::Given(u);
        let polygon = DataPolygon::new(points, &given, Boundary::ZeroCurvature).unwrap();
        let options = SearchOptions::default();
        let fits = [
            NuSpline::shape_preserving(polygon.clone(), &options).unwrap().outcome,
            TensionSpline::shape_preserving(polygon.clone(), &options).unwrap().outcome,
            CatmullRom::shape_preserving(polygon, &HandleOptions::default()).unwrap().outcome,
        ];
        assert!(fits.iter().all(|o| o.diagnostics.status == Status::Solved), "{case}: {fits:?}");
    }
}

/// Four per cent less tension at any one node breaks a criterion, or as little as keeps them all makes the
/// curve bend no less around it.
#[test]
fn no_tension_of_a_fairest_curve_can_be_lowered() {
    let chordal = |name| {
        DataPolygon::new(points(name), &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap()
    };
    let mut sets = vec![
        feature_line(),
        helix(6.0),
        chordal("protein_1a8o_ca.csv"),
        chordal("coil_m16n08_first.csv"),
    ];
    let mut random = Random::new(5);
    sets.extend((0..60).filter_map(|case| polygon(PolygonKind::ALL[case % 8], 3, &mut random)));
    let (mut tested, mut bends_more, mut spare) = (0, 0, Vec::new());
    for polygon in sets {
        let fit = NuSpline::shape_preserving(polygon.clone(), &options(Strategy::Fairest)).unwrap();
        let own = fit.curve.tension();
        let checker = Checker::new(&polygon, Criteria::OF_FITS, Tolerances::default());
        let mut windows = checker.cached();
        // The legs if they keep the shape: of what was left undecided, nothing may be known to fail.
        let mut lowered = |node: usize, factor: f64| -> Option<Vec<[DVec3; 3]>> {
            let mut tension = own.to_vec();
            tension[node] *= factor;
            let curve = NuSpline::new(polygon.clone(), Tension::Nodes(&tension)).unwrap();
            let legs = curve.curve().legs();
            let keeps = |i: usize| {
                let accepted = fit.outcome.undecided.contains(&i);
                let failures = windows.failures_at(i, legs[i]);
                if accepted { failures } else { windows.unproved_at(i, legs[i]) }.is_empty()
            };
            let whole = |i: usize| {
                let [a, c] = legs[i];
                [a, polygon.chord(i) - a - c, c]
            };
            (0..legs.len()).all(keeps).then(|| (0..legs.len()).map(whole).collect())
        };
        let bending = |legs: &[[DVec3; 3]]| -> f64 {
            let segment = |&[a, b, c]: &[DVec3; 3]| CubicSegment { start: DVec3::ZERO, a, b, c };
            legs.iter().map(|legs| segment(legs).bending(1e-6)).sum()
        };
        for node in (0..own.len()).filter(|&i| own[i] > 0.0) {
            tested += 1;
            let Some(mut least) = lowered(node, 0.96) else { continue };
            let (mut breaks, mut keeps) = (0.0, 0.96);
            if let Some(legs) = lowered(node, 0.0) {
                (least, keeps) = (legs, 0.0);
            }
            while keeps - breaks > 0.01 * keeps {
                let middle = 0.5 * (breaks + keeps);
                match lowered(node, middle) {
                    Some(legs) => (least, keeps) = (legs, middle),
                    None => breaks = middle,
                }
            }
            let full = lowered(node, 1.0).unwrap();
            // The effect of a change decays quickly with distance.
            let near = node.saturating_sub(4)..(node + 4).min(least.len());
            let [less, full] = [bending(&least[near.clone()]), bending(&full[near])];
            if less > full * (1.0 - 1e-3) {
                bends_more += 1;
            } else {
                spare.push((own.to_vec(), node, keeps));
            }
        }
    }
    assert!(tested > 100 && bends_more > 0, "{tested} {bends_more}");
    // Passes come to an end, and what would break segments far away goes half as far.
    assert!(50 * spare.len() <= tested, "{} of {tested}: {spare:?}", spare.len());
}

#[test]
fn a_limit_of_iterations_is_reported_with_the_last_curve() {
    let options = SearchOptions { max_iterations: Some(2), ..options(Strategy::Nussp) };
    let fit = NuSpline::shape_preserving(helix(6.0), &options).unwrap();
    assert_eq!(fit.outcome.diagnostics.status, Status::IterationLimit);
    assert_eq!(fit.outcome.diagnostics.iterations, 2);
    assert!(!fit.report.ok());
    assert_eq!(fit.report, fit.curve.check(Criteria::OF_FITS, Tolerances::default()).unwrap());
}

/// End tangents of another unit altogether, and a chord that doubles back: the last raise changes the first
/// legs by a rounding, which turns a verdict.
#[test]
fn the_report_of_an_unsolved_search_is_that_of_its_curve() {
    let points = [
        [-6.841687647821775e107, -1.1940184634164952e90, 4.808575570305945e109],
        [-6.832743266956588e107, -4.7438773174639503e107, 4.808575570305945e109],
        [-6.823798886091309e107, -9.487754635906965e107, 4.8085755771717414e109],
        [-6.832743266956588e107, -4.74387731746395e107, 4.808575570305945e109],
        [-6.823798886091309e107, -9.487754635906965e107, 4.8085755771717414e109],
        [-6.895273670557624e107, -9.487754635906965e107, 4.80857561724651e109],
        [-6.895273670557625e107, -8.320256351665772e108, 4.8097946605058375e109],
        [-6.895273670557627e107, -1.5691737239740849e109, 4.811013703765165e109],
        [-6.895273602143801e107, -1.5691737239740849e109, 1.589986771591517e109],
        [-6.895273602143801e107, -1.5691743578185954e109, -3.512782740882733e109],
    ];
    let start = DVec3::new(2.2685587853818578e89, -5.084458686198215e98, -1.8501564049744413e106);
    let end = DVec3::new(-7.579003585870146e98, -8.323949034866866e99, 3.95925841153582e93);
    let polygon = DataPolygon::new(
        points.map(DVec3::from).to_vec(),
        &Parametrization::Chordal,
        Boundary::tangents(start, end),
    );
    let polygon = polygon.unwrap();
    for limit in 1..60 {
        let options = SearchOptions { max_iterations: Some(limit), ..options(Strategy::Reduction) };
        let fit = TensionSpline::shape_preserving(polygon.clone(), &options).unwrap();
        let (criteria, tolerances) = (options.criteria, options.tolerances);
        assert_eq!(fit.report, fit.curve.check(criteria, tolerances).unwrap(), "{limit}");
    }
}

#[test]
fn a_monitor_sees_every_step_and_can_stop() {
    let mut seen = 0;
    let fit = NuSpline::shape_preserving_with(helix(6.0), &options(Strategy::Nussp), &mut |_| {
        seen += 1;
        if seen == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .unwrap();
    assert_eq!(fit.outcome.diagnostics.status, Status::Interrupted);
    assert_eq!((seen, fit.outcome.history.len()), (3, 3));
}

/// Points whose coplanar part closed forms do not settle: the search that follows can be stopped, too.
#[test]
fn a_monitor_sees_the_search_after_closed_forms() {
    let points = vec![
        DVec3::new(0.611, 1.012, 0.0),
        DVec3::new(-1.084, -0.035, 0.0),
        DVec3::new(1.128, 0.653, 0.0),
        DVec3::new(0.231, -0.298, 0.0),
        DVec3::new(0.814, -1.045, 0.0),
        DVec3::new(-0.343, 0.432, -0.4),
    ];
    let fit = |most: usize| {
        let polygon =
            DataPolygon::new(points.clone(), &Parametrization::Uniform, Boundary::ZeroCurvature);
        let mut seen = 0;
        CatmullRom::shape_preserving_with(polygon.unwrap(), &HandleOptions::default(), &mut |_| {
            seen += 1;
            if seen == most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap()
    };
    let solved = fit(usize::MAX);
    assert_eq!(solved.outcome.diagnostics.status, Status::Solved);
    assert!(solved.outcome.history.len() > 2);
    let stopped = fit(2);
    assert_eq!(stopped.outcome.diagnostics.status, Status::Interrupted);
    assert_eq!(stopped.outcome.history.len(), 2);
    assert!(!stopped.report.ok());
}

#[test]
fn a_million_points_with_kinks() {
    let mut random = Random::new(3);
    let mut p = DVec3::ZERO;
    let points: Vec<DVec3> = (0..1_000_000)
        .map(|i| {
            let t = 0.1 * f64::from(i);
            let kink = if random.below(1000) == 0 { random.vector() } else { DVec3::ZERO };
            p += DVec3::new(t.cos(), t.sin(), 0.3) + kink;
            p
        })
        .collect();
    let polygon =
        DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap();
    let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default()).unwrap();
    assert!(fit.report.ok());
    let diagnostics = fit.outcome.diagnostics;
    assert!(diagnostics.nodes_changed > 1000 && diagnostics.nodes_changed < 50_000);
}
