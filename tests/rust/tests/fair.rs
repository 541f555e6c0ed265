// SPDX-License-Identifier: MIT OR Apache-2.0

//! Fair curves: the numbers to reach on shared data, and the properties on generated polygons. The
//! verdicts are checked by dense sampling of exported control points, with code of its own.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use std::{f64::consts::FRAC_PI_3, ops::ControlFlow};

use shapespline::{
    fair::{Fit, Method, Status},
    geometry::{PiecewiseBezier, fairness},
    prelude::*,
};
use shapespline_tests::{
    generate::{PolygonKind, Random},
    points, scaled,
};

fn natural(points: Vec<DVec3>, dimension: Dimension) -> DataPolygon {
    let (chordal, ends) = (Parametrization::Chordal, Boundary::ZeroCurvature);
    DataPolygon::with_dimension(points, dimension, &chordal, ends).unwrap()
}

fn fit(polygon: DataPolygon, energy: Energy) -> Fit {
    FairSpline::fit(polygon, &FairOptions { energy, ..FairOptions::default() }).unwrap()
}

fn plain(polygon: DataPolygon) -> FairSpline {
    let options = FairOptions { criteria: Criteria::NONE, ..FairOptions::default() };
    FairSpline::fit(polygon, &options).unwrap().curve
}

/// `∫κ²ds` and the largest curvature, in units of the mean chord.
fn measures(curve: &FairSpline) -> [f64; 2] {
    let points = curve.points();
    let chords = points.windows(2).map(|p| p[1].distance(p[0]));
    let mean = chords.sum::<f64>() / (points.len() - 1) as f64;
    let fairness = fairness(&PiecewiseBezier::from(curve.curve()));
    [fairness.bending / fairness.length * mean, fairness.max_curvature * mean]
}

fn readme() -> DataPolygon {
    let rows = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.1], [4.0, 0.1, 0.1], [4.5, 0.4, 0.2]];
    let rest = [[4.6, 3.0, 0.2], [4.6, 6.0, 0.3]];
    natural(rows.into_iter().chain(rest).map(DVec3::from).collect(), Dimension::Three)
}

/// Nearly straight in the middle.
fn planar(e: f64) -> DataPolygon {
    let rows = [[0.0, 1.0], [1.0, 0.0], [2.0, 0.0], [3.0, e], [4.0, 3.0 * e], [5.0, 1.0]];
    natural(rows.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(), Dimension::Two)
}

fn feature_line() -> DataPolygon {
    let rows = shapespline_tests::feature_line();
    natural(rows.points().to_vec(), Dimension::Three)
}

fn hiking_track() -> DataPolygon {
    let mut rows = points("gps_mojstrovka.csv");
    rows.dedup();
    natural(rows, Dimension::Three)
}

fn helix() -> DataPolygon {
    let at = |k: i32| FRAC_PI_3 * f64::from(k);
    let rows = (0..25).map(at).map(|t| DVec3::new(t.cos(), t.sin(), t));
    natural(rows.collect(), Dimension::Three)
}

fn coil() -> DataPolygon {
    let rows = points("coil_m16n08_first.csv");
    DataPolygon::new(rows, &Parametrization::Chordal, Boundary::Periodic).unwrap()
}

/// One row of the table of numbers to reach: energy over the plain cubic's and largest curvature, for
/// the parametric and the bending energy (measured with the prototype).
struct Row {
    name: &'static str,
    polygon: DataPolygon,
    parametric: [f64; 2],
    bending: [f64; 2],
}

fn table() -> Vec<Row> {
    let row = |name, polygon, parametric, bending| Row { name, polygon, parametric, bending };
    let protein = natural(points("protein_1a8o_ca.csv"), Dimension::Three);
    vec![
        row("README", readme(), [1.03, 2.19], [1.01, 2.0]),
        row("planar 1e-2", planar(1e-2), [1.30, 1.65], [1.31, 1.63]),
        row("planar 1e-3", planar(1e-3), [1.89, 2.83], [1.71, 2.18]),
        row("planar 1e-6", planar(1e-6), [2.01, 3.00], [1.77, 2.24]),
        row("feature line", feature_line(), [1.0007, 0.161], [1.001, 0.161]),
        row("protein", protein, [1.005, 7.84], [0.914, 3.32]),
        row("hiking track", hiking_track(), [1.077, 173.0], [0.462, 13.7]),
        row("coil", coil(), [1.0, 0.058], [1.0, 0.059]),
        row("helix", helix(), [1.0, 0.991], [1.0, 0.991]),
    ]
}

/// The table was measured before turning was a criterion, and is held against the same criteria here.
#[test]
fn the_numbers_to_reach_are_reached() {
    let criteria = Criteria::OF_FITS.without(Criterion::Turning);
    for Row { name, polygon, parametric, bending } in table() {
        for (energy, numbers) in [(Energy::Parametric, parametric), (Energy::Bending, bending)] {
            reach(
                name,
                &polygon,
                FairOptions { criteria, energy, ..FairOptions::default() },
                numbers,
            );
        }
    }
}

/// With turning asked as well the same numbers hold, but for README's points: two of their turns are so
/// flat that a tangent between the chords (Gautam's (12.1)) takes a third more energy.
#[test]
fn turning_costs_little_but_where_points_are_nearly_straight() {
    for Row { name, polygon, parametric, bending } in table() {
        let (parametric, bending) = match name {
            "README" => ([1.36, 3.8], [1.31, 3.35]),
            _ => (parametric, bending),
        };
        for (energy, numbers) in [(Energy::Parametric, parametric), (Energy::Bending, bending)] {
            reach(name, &polygon, FairOptions { energy, ..FairOptions::default() }, numbers);
        }
    }
}

/// At most 3 % more energy over the plain cubic's, and 10 % more curvature.
fn reach(name: &str, polygon: &DataPolygon, options: FairOptions, numbers: [f64; 2]) {
    let [ratio, curvature] = numbers;
    let fit = FairSpline::fit(polygon.clone(), &options).unwrap();
    let ([e, k], [e0, _]) = (measures(&fit.curve), measures(&plain(polygon.clone())));
    let found = format!("{name}, {:?}: E/E0 {}, κ {k}", options.energy, e / e0);
    assert_eq!(fit.diagnostics.status, Status::Solved, "{found}");
    assert!(e / e0 <= 1.03 * ratio && k <= 1.1 * curvature, "{found}");
    verify(polygon, &fit.curve, &found);
}

/// Where the plain cubic keeps the shape, the fair curve is the plain cubic; elsewhere it is outside of the windows.
#[test]
fn what_keeps_the_shape_stays_the_plain_cubic() {
    let helix_fit = fit(helix(), Energy::Parametric);
    assert_eq!(helix_fit.diagnostics.method, Method::Cubic);
    assert_eq!(helix_fit.diagnostics.extra_knots, 0);
    let nu = NuSpline::new(helix(), Tension::Uniform(0.0)).unwrap();
    for (own, other) in helix_fit.curve.curve().legs().iter().zip(nu.curve().legs()) {
        assert!((0..2).all(|k| (own[k] - other[k]).length() < 1e-12));
    }
    // The coil fails in one segment: all but a window around it is bit for bit the plain cubic.
    let (fair, plain) = (fit(coil(), Energy::Parametric).curve, plain(coil()));
    let legs = |curve: &FairSpline, i: usize| {
        let [from, to] = [curve.nodes()[i], curve.nodes()[i + 1]];
        (to == from + 1).then(|| curve.curve().legs()[from])
    };
    let same = (0..128).filter(|&i| legs(&fair, i) == legs(&plain, i)).count();
    assert!(same >= 128 - 20, "{same}");
}

/// Second derivatives agree at every knot, and the curve passes through the points.
#[test]
fn curves_are_twice_continuously_differentiable() {
    for polygon in [readme(), planar(1e-3), hiking_track(), coil()] {
        for energy in [Energy::Parametric, Energy::Bending] {
            let curve = fit(polygon.clone(), energy).curve;
            let cubic = curve.curve();
            let second = |side| move |&u: &f64| cubic.evaluate(u, 2, side);
            let inner = &cubic.knots()[1..cubic.knots().len() - 1];
            let largest =
                inner.iter().map(second(Side::Left)).map(DVec3::length).fold(0.0, f64::max);
            for u in inner {
                let jump = second(Side::Left)(u) - second(Side::Right)(u);
                assert!(jump.length() < 1e-10 * largest, "{u}: {jump}");
            }
            assert_eq!(curve.points(), polygon.points());
            if polygon.dimension() == Dimension::Two {
                let flat = |legs: &[DVec3; 2]| legs[0].z == 0.0 && legs[1].z == 0.0;
                assert!(cubic.legs().iter().all(flat));
            }
            assert_eq!(curve.parameters(), polygon.parameters());
        }
    }
}

/// What a search has proved on its way is what a check of its curve finds, and on all threads as on one.
#[test]
fn the_report_of_a_fit_is_that_of_its_curve() {
    let at = |t: f64| DVec3::new(t.cos(), t.sin(), t);
    let long: Vec<DVec3> = (0..9000).map(|k| at(FRAC_PI_3 * f64::from(k))).collect();
    let circular = DataPolygon::new(long.clone(), &Parametrization::Chordal, Boundary::Circular);
    let options = FairOptions::default();
    for polygon in [
        readme(),
        planar(1e-3),
        helix(),
        coil(),
        natural(long, Dimension::Three),
        circular.unwrap(),
    ] {
        let found = fit(polygon, Energy::Parametric);
        let report = found.curve.check(options.criteria, options.tolerances).unwrap();
        assert_eq!(found.report, report);
        assert!(found.report.ok());
    }
}

/// Windows are solved on all threads: the same curve, history and counts, for any number of them, and where steps
/// are limited, one window after the other. The monitor is asked from any thread.
#[test]
fn long_curves_do_not_depend_on_the_number_of_threads() {
    let at = |k: u32| {
        let t = 0.15 * f64::from(k);
        let kink = if k % 700 == 350 { 0.05 } else { 0.0 };
        DVec3::new(t.cos() + kink, t.sin() - 0.5 * kink, 0.35 * t)
    };
    let polygon = natural((0..9000).map(at).collect(), Dimension::Three);
    let on = |threads: usize, options: &FairOptions| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| FairSpline::fit(polygon.clone(), options).unwrap())
    };
    let free = FairOptions::default();
    let limited = FairOptions { max_iterations: Some(usize::MAX), ..free.clone() };
    let one = on(1, &free);
    assert_eq!(one.diagnostics.status, Status::Solved, "{}", one.report);
    assert!(one.history.len() >= 2 * 12, "{}", one.history.len());
    for other in [on(2, &free), on(5, &free), on(3, &limited)] {
        assert_eq!(other.curve, one.curve);
        assert_eq!(other.diagnostics, one.diagnostics);
        assert_eq!(other.history, one.history);
    }
    let mut seen = 0;
    let fit = FairSpline::fit_with(polygon.clone(), &free, &mut |_| {
        seen += 1;
        if seen < 50 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert_eq!(fit.unwrap().diagnostics.status, Status::Interrupted);
    assert!((50..200).contains(&seen), "{seen}");
}

/// A walk whose steps have lengths over so many decades.
fn walk(seed: usize, decades: f64, dimension: Dimension) -> DataPolygon {
    let mut random = Random::new(seed as u64);
    let mut at = DVec3::ZERO;
    let mut points = vec![at];
    for _ in 0..4 + random.below(56) {
        let (length, angle) =
            (10f64.powf(decades * random.unit()), 2.0 * std::f64::consts::PI * random.unit());
        let z = if dimension == Dimension::Two { 0.0 } else { random.within(-1.0, 1.0) };
        let across = (1.0 - z * z).sqrt();
        at += DVec3::new(angle.cos() * across, angle.sin() * across, z) * length;
        points.push(at);
    }
    natural(points, dimension)
}

#[test]
fn walks_keep_their_shape_with_little_energy() {
    for (dimension, count, median_at_most) in
        [(Dimension::Three, 1000, 0.5), (Dimension::Two, 500, 0.2)]
    {
        let (mut ratios, mut bent, mut above, mut open) = (Vec::new(), 0, Vec::new(), 0);
        for seed in 0..scaled(count) {
            let polygon = walk(seed, 1.0, dimension);
            let fit = fit(polygon.clone(), Energy::Parametric);
            let name = format!("walk {seed} in {dimension:?}");
            assert_eq!(fit.diagnostics.status, Status::Solved, "{name}: {}", fit.report);
            assert!(fit.report.violations.is_empty(), "{name}: {}", fit.report);
            assert!(fit.diagnostics.energy >= fit.diagnostics.energy_cubic * (1.0 - 1e-12));
            if !fit.report.undecided.is_empty() {
                open += 1;
                continue;
            }
            verify(&polygon, &fit.curve, &name);
            if fit.diagnostics.method != Method::Cubic {
                let [[e, _], [e0, _]] = [&fit.curve, &plain(polygon.clone())].map(measures);
                ratios.push(e / e0);
                bent += usize::from(e > 1.1 * e0);
                if e > 1.1 * with_tension(polygon) {
                    above.push(seed);
                }
            }
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        eprintln!(
            "{dimension:?}: median {median}, {bent} above the cubic, {above:?} above tension, {open} open"
        );
        assert!(median <= median_at_most, "{dimension:?}: {median}");
        assert!(bent * 50 <= ratios.len(), "{dimension:?}: {bent} of {}", ratios.len());
        // Walk 775 in space has 1.19 times the energy: no restart next to binormals that are all but perpendicular
        // comes to hold, and the better minimum is not found.
        assert!(above.len() * 1000 <= scaled(count), "{dimension:?}: above tension: {above:?}");
        // Where the binormals next to a turn by nearly 180° are nearly perpendicular, rounding may hide a sign.
        assert!(open * 400 <= count, "{dimension:?}: {open} undecided");
    }
}

/// `∫κ²ds` of the tension cubic with tension per side, in units of the mean chord.
fn with_tension(polygon: DataPolygon) -> f64 {
    let options = SearchOptions { strategy: Strategy::Fairest, ..SearchOptions::default() };
    let mean = polygon.points().windows(2).map(|p| p[1].distance(p[0])).sum::<f64>()
        / polygon.segments() as f64;
    let curve = TensionSpline::shape_preserving(polygon, &options).unwrap().curve;
    let fairness = fairness(&PiecewiseBezier::from(curve.curve().cubic()));
    fairness.bending / fairness.length * mean
}

#[test]
fn bending_walks_bend_less_than_the_plain_cubic() {
    for seed in 0..scaled(100) {
        let polygon = walk(seed, 1.0, Dimension::Three);
        let fit = fit(polygon.clone(), Energy::Bending);
        assert_eq!(fit.diagnostics.status, Status::Solved, "{seed}: {}", fit.report);
        verify(&polygon, &fit.curve, &format!("walk {seed}"));
        let [[e, _], [e0, _]] = [&fit.curve, &plain(polygon)].map(measures);
        assert!(e < 1.5 * e0, "{seed}: {}", e / e0);
    }
}

#[test]
fn hard_polygons_violate_nothing() {
    let mut random = Random::new(16);
    for seed in 0..scaled(800) {
        let kind = PolygonKind::ALL[seed % PolygonKind::ALL.len()];
        let n = 4 + random.below(16);
        let points = kind.points(n, &mut random);
        let fit = fit(natural(points, Dimension::Three), Energy::Parametric);
        assert!(fit.report.violations.is_empty(), "{kind:?} {seed}: {}", fit.report);
    }
}

/// Scale, place, orientation and direction do not matter.
#[test]
fn results_do_not_depend_on_units_place_or_direction() {
    let base = readme();
    let moved = |map: &dyn Fn(DVec3) -> DVec3, reversed: bool| {
        let mut points: Vec<DVec3> = base.points().iter().map(|&p| map(p)).collect();
        if reversed {
            points.reverse();
        }
        fit(natural(points, Dimension::Three), Energy::Parametric)
    };
    let reference = fit(base.clone(), Energy::Parametric);
    let tangents = reference.curve.tangents();
    let turn = |p: DVec3| {
        let (s, c) = 0.7f64.sin_cos();
        let p = DVec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
        DVec3::new(p.x, c * p.y - s * p.z, s * p.y + c * p.z)
    };
    for scale in [1e-100, 1e-3, 1e100] {
        let fit = moved(&|p| p * scale, false);
        for (own, other) in fit.curve.tangents().iter().zip(&tangents) {
            assert!((*own - *other).length() < 1e-9, "{scale}");
        }
        assert_eq!(fit.diagnostics.extra_knots, reference.diagnostics.extra_knots);
    }
    for (own, other) in moved(&turn, false).curve.tangents().iter().zip(&tangents) {
        assert!((*own - turn(*other)).length() < 1e-8);
    }
    let away = moved(&|p| p + DVec3::new(30.0, -50.0, 20.0), false);
    for (own, other) in away.curve.tangents().iter().zip(&tangents) {
        assert!((*own - *other).length() < 1e-8);
    }
    let back = moved(&|p| p, true);
    for (own, other) in back.curve.tangents().iter().rev().zip(&tangents) {
        assert!((*own + *other).length() < 1e-8);
    }
}

#[test]
fn every_boundary_is_solved() {
    let start = DVec3::new(1.0, 0.2, -0.1);
    let end = DVec3::new(0.1, 1.0, 0.2);
    for boundary in [
        Boundary::ZeroCurvature,
        Boundary::Circular,
        Boundary::tangents(start, end),
        Boundary::tangents(start, None),
        Boundary::tangents(None, end),
    ] {
        let points = readme().points().to_vec();
        let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
        for energy in [Energy::Parametric, Energy::Bending] {
            let fit = fit(polygon.clone(), energy);
            assert_eq!(fit.diagnostics.status, Status::Solved, "{boundary:?}: {}", fit.report);
            let found = fit.curve.tangents();
            for (found, given) in [found[0], found[5]].into_iter().zip(polygon.tangents()) {
                if let Some(given) = given {
                    assert!((found - given).length() < 1e-12, "{boundary:?} {energy:?} {found}");
                }
            }
        }
    }
}

#[test]
fn other_parametrisations_are_solved() {
    for parametrization in [Parametrization::Uniform, Parametrization::Centripetal] {
        for polygon in [readme(), hiking_track()] {
            let points = polygon.points().to_vec();
            let polygon =
                DataPolygon::new(points, &parametrization, Boundary::ZeroCurvature).unwrap();
            let fit = fit(polygon.clone(), Energy::Parametric);
            let name = format!("{parametrization:?}");
            assert_eq!(fit.diagnostics.status, Status::Solved, "{name}: {}", fit.report);
            verify(&polygon, &fit.curve, &name);
        }
    }
}

#[test]
fn a_monitor_sees_the_steps_and_can_stop_them() {
    let mut seen = 0;
    let options = FairOptions::default();
    let fit = FairSpline::fit_with(hiking_track(), &options, &mut |_| {
        seen += 1;
        if seen == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let fit = fit.unwrap();
    assert_eq!((seen, fit.diagnostics.status), (5, Status::Interrupted));
    let few = FairOptions { max_iterations: Some(3), ..options.clone() };
    let fit = FairSpline::fit(hiking_track(), &few).unwrap();
    assert_eq!((fit.diagnostics.iterations, fit.diagnostics.status), (3, Status::IterationLimit));
    let none = FairOptions { max_iterations: Some(0), ..options.clone() };
    let error = FairSpline::fit(readme(), &none).unwrap_err().to_string();
    assert!(error.contains("max_iterations"), "{error}");
}

#[test]
fn curves_survive_storage() {
    let curve = fit(readme(), Energy::Parametric).curve;
    let bytes = postcard::to_stdvec(&curve).unwrap();
    let back: FairSpline = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(back, curve);
    assert!(back.check(Criteria::default(), Tolerances::default()).unwrap().ok());
}

/// Samples of a curve between two data points, away from the knots: local parameter and two or three derivatives.
fn samples(curve: &FairSpline, segment: usize) -> Vec<[DVec3; 3]> {
    let cubic = curve.curve();
    let pieces = curve.nodes()[segment]..curve.nodes()[segment + 1];
    let per_piece = 150;
    pieces
        .flat_map(|k| {
            let piece = cubic.segment(k);
            let h = cubic.knots()[k + 1] - cubic.knots()[k];
            (0..=per_piece).map(move |j| {
                let [d1, d2, d3] = piece.derivatives(f64::from(j) / f64::from(per_piece));
                [d1 / h, d2 / (h * h), d3 / (h * h * h)]
            })
        })
        .collect()
}

/// The criteria that have a sign, from definitions and dense samples.
fn verify(polygon: &DataPolygon, curve: &FairSpline, name: &str) {
    let n = polygon.segments();
    let unit = |i: usize| polygon.chord(i).normalize();
    let closed = polygon.is_closed();
    let node = |i: usize| match (closed, i) {
        (true, _) => Some(unit((i + n - 1) % n).cross(unit(i % n))),
        (false, 0) => polygon.tangents()[0].map(|d| d.normalize().cross(unit(0))),
        (false, i) if i == n => polygon.tangents()[1].map(|d| unit(n - 1).cross(d.normalize())),
        (false, _) => Some(unit(i - 1).cross(unit(i))),
    };
    for i in 0..n {
        let (Some(p), Some(q)) = (node(i), node(i + 1)) else { continue };
        let (sines, cosine) = ([p.length(), q.length()], p.dot(q));
        if sines.into_iter().any(|s| s < 1e-8) {
            continue;
        }
        let samples = samples(curve, i);
        let omegas: Vec<DVec3> = samples.iter().map(|d| d[0].cross(d[1])).collect();
        let largest = omegas.iter().map(|w| w.length()).fold(0.0, f64::max);
        let clear = |x: f64| x.abs() > 1e-9 * largest;
        if cosine.abs() > 1e-6 * sines[0] * sines[1] {
            for (normal, start) in [(p, 1.0), (q, cosine.signum())] {
                let along = omegas.iter().map(|w| w.dot(normal.normalize())).filter(|&x| clear(x));
                let mut signs: Vec<f64> = along.map(f64::signum).collect();
                signs.dedup();
                let expected = if cosine > 0.0 { vec![1.0] } else { vec![start, -start] };
                assert_eq!(signs, expected, "{name}: segment {i} along {normal}");
            }
        }
        let after = if i + 1 < n || closed {
            unit((i + 1) % n)
        } else {
            match polygon.tangents()[1] {
                Some(tangent) => tangent.normalize(),
                None => continue,
            }
        };
        let gamma = p.dot(after);
        if gamma.abs() > 1e-8 && sines.into_iter().all(|s| s > 1e-4) {
            for [d1, d2, d3] in &samples {
                let volume = d1.cross(*d2).dot(*d3);
                let size = d1.length() * d2.length() * d3.length();
                assert!(volume * gamma > -1e-12 * size, "{name}: torsion on segment {i}");
            }
        }
    }
}
