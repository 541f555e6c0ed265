// SPDX-License-Identifier: MIT OR Apache-2.0

//! Verdicts on nearly degenerate cubics against whole numbers.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::{
    criteria::{CurveChecker, Requirements, Violations},
    geometry::PiecewiseBezier,
    prelude::*,
};
use shapespline_tests::{
    exact::Cubic,
    generate::Random,
    scaled,
    segments::{SEGMENT, case},
};

/// Kinds of degeneracy.
const KINDS: usize = 8;

/// Legs near a place where the verdict on some criterion changes, or of no area at all.
fn nearly_degenerate(
    kind: usize,
    polygon: &DataPolygon,
    legs: [DVec3; 2],
    r: &mut Random,
) -> [DVec3; 2] {
    let [a, c] = legs;
    let chord = polygon.chord(SEGMENT);
    let size = chord.length();
    let noise = size * 10f64.powf(r.within(-18.0, -8.0));
    match kind {
        // In one plane.
        0 => [a, a * r.within(-1.0, 1.0) + chord * r.within(0.1, 0.5) + r.vector() * noise],
        // No curvature at an end.
        1 => [chord * r.within(0.1, 0.6) + r.vector() * noise, c],
        2 => [a, chord * r.within(0.1, 0.6) + r.vector() * noise],
        // The polygon itself, as it rounds.
        3 => [chord / 3.0; 2],
        // Legs that hardly leave their points.
        4 => [a, c].map(|leg| leg * 10f64.powf(r.within(-17.0, -6.0))),
        5 => [a * 10f64.powf(r.within(-17.0, -6.0)), c],
        // Where some verdict changes, on the way to other legs.
        _ => {
            let (_, other) = case(r.below(6), r);
            let scale = size / other[0].length();
            let checker = Checker::new(polygon, Criteria::ALL, Tolerances::default());
            let flat = polygon.points().iter().all(|p| p.z == polygon.points()[0].z);
            let keep = if flat { DVec3::new(1.0, 1.0, 0.0) } else { DVec3::ONE };
            let at =
                |s: f64| [a.lerp(other[0] * scale * keep, s), c.lerp(other[1] * scale * keep, s)];
            let verdict = |s: f64| checker.unproved(SEGMENT, at(s));
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..55 {
                let middle = 0.5 * (low + high);
                if verdict(middle) == verdict(0.0) { low = middle } else { high = middle }
            }
            at(low + r.within(-1.0, 1.0) * 10f64.powf(r.within(-17.0, -9.0)))
        }
    }
}

/// The same somewhere else, so that coordinates round; and a lattice in which much is zero exactly.
fn moved(
    k: usize,
    polygon: &DataPolygon,
    legs: [DVec3; 2],
    r: &mut Random,
) -> (DataPolygon, [DVec3; 2]) {
    let (points, legs): (Vec<DVec3>, _) = match k % 4 {
        0 => {
            let shift = r.vector() * 10f64.powf(r.within(0.0, 9.0));
            (polygon.points().iter().map(|&p| p + shift).collect(), legs)
        }
        1 => {
            let grid = |v: DVec3| (v * 8.0).round() / 8.0;
            let step = |v: DVec3| grid(v) + DVec3::X * f64::from(u8::from(grid(v) == DVec3::ZERO));
            let mut points = vec![DVec3::ZERO];
            (0..5).for_each(|i| points.push(points[i] + step(polygon.chord(i))));
            (points, legs.map(|v| grid(v * 2.0) / 2.0))
        }
        _ => (polygon.points().to_vec(), legs),
    };
    (DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap(), legs)
}

/// No verdict contradicts the exact one of the same control points, neither on our own curves nor on
/// others; and what rounding does not hide is decided.
#[test]
fn no_verdict_contradicts_exact_arithmetic() {
    let mut random = Random::new(21);
    let tolerances = Tolerances::default();
    // Of each criterion: satisfied, violated, undecided.
    let mut seen = [[0; 3]; Criterion::ALL.len()];
    for k in 0..scaled(200_000) {
        let (polygon, legs) = case(k, &mut random);
        let legs = nearly_degenerate(k / 6 % KINDS, &polygon, legs, &mut random);
        let (polygon, legs) = moved(k / 48, &polygon, legs, &mut random);
        let points = polygon.points();
        let control = |i: usize| {
            let [a, c] = if i == SEGMENT { legs } else { [polygon.chord(i) / 3.0; 2] };
            [points[i], points[i] + a, points[i + 1] - c, points[i + 1]]
        };
        let all: Vec<DVec3> = (0..5).flat_map(control).collect();
        let breaks = (0..6).map(f64::from).collect();
        let other = PiecewiseBezier::new(breaks, &all, 3, Dimension::Three).unwrap();
        let other = CurveChecker::new(&polygon, &other, Criteria::ALL, tolerances, 1e-9).unwrap();
        let own = other.checker();
        let exact = Cubic::new(&polygon, SEGMENT, control(SEGMENT));
        let (unproved, violations) = (own.unproved(SEGMENT, legs), own.violations(SEGMENT, legs));
        let around = [SEGMENT - 1, SEGMENT, SEGMENT + 1].map(|i| own.requirements()[i]);
        let calls = around[1];
        for criterion in
            Criterion::ALL.into_iter().filter(|&c| calls.intersects(Requirements::of(c)))
        {
            let Some(holds) = exact.holds(&polygon, SEGMENT, criterion, around, &tolerances) else {
                continue;
            };
            let of = Violations::of(criterion);
            let verdict = |satisfied: bool, open: bool| match (satisfied, open) {
                (true, _) => Some(true),
                (false, false) => Some(false),
                (false, true) => None,
            };
            let mine = verdict(!unproved.intersects(of), !violations.intersects(of));
            let record = other.record(SEGMENT, criterion);
            let open = other.undecided(SEGMENT, criterion).is_some();
            let theirs = verdict(record.satisfied, open);
            // The other curve has corners, at which turning asks for more.
            let theirs = theirs.filter(|_| criterion != Criterion::Turning);
            for verdict in [mine, theirs] {
                assert!(
                    verdict.is_none_or(|v| v == holds),
                    "{k} {criterion}: {verdict:?}, exactly {holds}: {points:?} {legs:?}"
                );
            }
            assert!(record.satisfied == (record.margin > 0.0), "{k} {record:?}");
            let own_record = own.record(SEGMENT, legs, criterion);
            assert!(own_record.satisfied == (own_record.margin > 0.0), "{k} {own_record:?}");
            let column = match mine {
                Some(true) => 0,
                Some(false) => 1,
                None => 2,
            };
            seen[criterion as usize][column] += 1;
        }
    }
    println!("{seen:?}");
    for (criterion, seen) in Criterion::ALL.into_iter().zip(seen) {
        if criterion == Criterion::Regular {
            continue;
        }
        let all: usize = seen.iter().sum();
        assert!(seen.iter().all(|&n| n > all / 100), "{criterion}: {seen:?}");
    }
}
