// SPDX-License-Identifier: MIT OR Apache-2.0

//! The criteria beyond single verdicts: misprints, margins, invariance, information, polygons.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{AffineDimension, NodeCondition, polygon_shape};
use shapespline::prelude::*;
use shapespline_tests::{
    generate::{PolygonKind, Random},
    points,
    segments::{SEGMENT, case},
};

fn every(polygon: &DataPolygon) -> Checker<'_> {
    Checker::new(polygon, Criteria::ALL, Tolerances::default())
}

/// Theorem 13.4 as printed, for tangents `m, m'` and one normal.
fn printed_13_4(a: DVec3, chord: DVec3, c: DVec3, n: DVec3) -> [bool; 4] {
    // m = 3a/h, so h/3·m×m' = 3a×c/h: all three products share a factor 3/h.
    let (x, s, e) = (a.cross(c).dot(n), a.cross(chord).dot(n), chord.cross(c).dot(n));
    [
        x < 0.0 && s < x && e < x,
        x < 0.0 && s > 0.0 && e > 0.0,
        x > 0.0 && s > x && e > x,
        x > 0.0 && s < 0.0 && e < 0.0,
    ]
}

#[test]
fn theorem_13_4_as_printed_is_not_global_convexity() {
    let mut random = Random::new(6);
    let (mut wrongly_accepted, mut case_1b) = (0, 0);
    for k in 0..30_000 {
        let (polygon, [a, c]) = case(k, &mut random);
        let record = every(&polygon).record(SEGMENT, [a, c], Criterion::GlobalConvexity);
        if !record.applicable {
            continue;
        }
        let chord = polygon.chord(SEGMENT);
        let normals = [polygon.binormal(SEGMENT), polygon.binormal(SEGMENT + 1)];
        let cases = normals.map(|n| printed_13_4(a, chord, c, n));
        let accepted = cases.iter().all(|c| c.contains(&true));
        wrongly_accepted += usize::from(accepted && !record.satisfied);
        // Cases 1(b) and 2(a) are what holds, unless the end tangents are parallel (none here).
        let right = cases.iter().all(|c| c[1] || c[2]);
        assert_eq!(right, record.satisfied, "{k}");
        case_1b += usize::from(cases.iter().any(|c| c[1]) && right);
    }
    assert!(wrongly_accepted > 20 && case_1b > 500, "{wrongly_accepted} {case_1b}");

    // One of each. A square's corner, run through the wrong way round: accepted, and fails.
    let corner = [[-1.0, 1.0], [0.0, 0.0], [1.0, 0.0], [2.0, 1.0]];
    let polygon =
        DataPolygon::planar(&corner, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap();
    let mirrored = [DVec3::new(0.3, 0.4, 0.0), DVec3::new(0.3, -0.4, 0.0)];
    let n = polygon.binormal(1);
    let accepts = |[a, c]: [DVec3; 2]| printed_13_4(a, DVec3::X, c, n).contains(&true);
    let holds = |legs| every(&polygon).record(1, legs, Criterion::GlobalConvexity).satisfied;
    assert!(accepts(mirrored) && !holds(mirrored));
    // A half turn with parallel end tangents: refused, and holds.
    let arch = [DVec3::new(0.0, -0.5, 0.0), DVec3::new(0.0, 0.5, 0.0)];
    assert!(!accepts(arch) && holds(arch));
}

#[test]
fn theorem_13_13_as_printed_has_the_opposite_sign() {
    let mut random = Random::new(7);
    for k in 0..3000 {
        let (polygon, [a, c]) = case(k, &mut random);
        let record = every(&polygon).record(SEGMENT, [a, c], Criterion::Torsion);
        if record.applicable {
            // (m_{i−1} × m_i · L_i) Δ_i > 0 accepts what fails and refuses what holds.
            let printed = a.cross(c).dot(polygon.chord(SEGMENT)) * polygon.gamma(SEGMENT) > 0.0;
            assert_eq!(printed, !record.satisfied);
        }
    }
}

#[test]
fn margins_are_continuous_and_change_sign_with_the_verdict() {
    let mut random = Random::new(8);
    // All but regularity, which holds everywhere but on curves that stop: its margin is never negative.
    let crossed = Criterion::ALL.into_iter().filter(|&c| c != Criterion::Regular);
    let mut crossings = [0; Criterion::COUNT];
    for k in 0..3000 {
        let (polygon, from) = case(k, &mut random);
        let (_, to) = case(k, &mut random);
        let scale = polygon.chord(SEGMENT).length();
        let flat = polygon.points().iter().all(|p| p.z == polygon.points()[0].z);
        let to = to.map(|v| {
            let v = v.normalize() * (0.4 * scale);
            if flat { DVec3::new(v.x, v.y, 0.0) } else { v }
        });
        let checker = every(&polygon);
        let at = |s: f64| [from[0].lerp(to[0], s), from[1].lerp(to[1], s)];
        for criterion in crossed.clone() {
            let record = |s: f64| checker.record(SEGMENT, at(s), criterion);
            if !record(0.0).applicable || record(0.0).satisfied == record(1.0).satisfied {
                continue;
            }
            // Where the verdict changes the margin passes through zero.
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let same = record(middle).satisfied == record(0.0).satisfied;
                if same { low = middle } else { high = middle }
            }
            let (a, b) = (record(low), record(high));
            assert!((-1.0..=1.0).contains(&a.margin), "{a:?}");
            // A binormal that turns over where ω vanishes jumps; nothing else does.
            let jumps = criterion == Criterion::Coplanarity && (a.margin - b.margin).abs() > 1e-9;
            if !jumps {
                // What is not proved begins a little above zero.
                assert!(a.margin.abs() < 1e-8 && b.margin.abs() < 1e-8, "{k}: {a:?} {b:?}");
            }
            crossings[criterion as usize] += usize::from(!jumps);
        }
    }
    assert!(crossed.into_iter().all(|c| crossings[c as usize] > 30), "{crossings:?}");
}

#[test]
fn verdicts_and_margins_do_not_depend_on_the_frame() {
    let mut random = Random::new(12);
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    let (sin, cos) = 1f64.sin_cos();
    let turn = |p: DVec3| p * cos + axis.cross(p) * sin + axis * (axis.dot(p) * (1.0 - cos));
    for k in 0..600 {
        let (polygon, [a, c]) = case(k, &mut random);
        let checker = every(&polygon);
        let make = |p: &dyn Fn(DVec3) -> DVec3, reverse: bool| {
            let mut points: Vec<DVec3> = polygon.points().iter().map(|&x| p(x)).collect();
            if reverse {
                points.reverse();
            }
            DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap()
        };
        let shift = DVec3::new(30.0, -20.0, 10.0);
        let cases: [(DataPolygon, [DVec3; 2], bool); 5] = [
            (make(&turn, false), [turn(a), turn(c)], false),
            (make(&|p| p + shift, false), [a, c], false),
            (make(&|p| p * 1e100, false), [a * 1e100, c * 1e100], false),
            (make(&|p| p * 1e-100, false), [a * 1e-100, c * 1e-100], false),
            (make(&|p| p, true), [-c, -a], true),
        ];
        for (case, (other, legs, reverse)) in cases.iter().enumerate() {
            let segment = if *reverse { 4 - SEGMENT } else { SEGMENT };
            for criterion in Criterion::ALL {
                let x = checker.record(SEGMENT, [a, c], criterion);
                let y = every(other).record(segment, *legs, criterion);
                assert_eq!(x.applicable, y.applicable, "{k} {case} {criterion}");
                if x.applicable && x.margin.abs() > 1e-9 {
                    assert_eq!(x.satisfied, y.satisfied, "{k} {case}: {x:?} {y:?}");
                    assert!((x.margin - y.margin).abs() < 1e-7, "{k} {case}: {x:?} {y:?}");
                }
            }
        }
    }
}

#[test]
fn a_search_keeps_global_convexity_when_asked() {
    let mut random = Random::new(13);
    // Some of the polygons double back on a line.
    let criteria = Criteria::ALL.without(Criterion::Regular);
    let options = SearchOptions { criteria, ..SearchOptions::default() };
    let mut mended = 0;
    for kind in PolygonKind::ALL {
        for _ in 0..30 {
            let data = kind.points(12, &mut random);
            let natural = Boundary::ZeroCurvature;
            let Ok(polygon) = DataPolygon::new(data, &Parametrization::Chordal, natural) else {
                continue;
            };
            let plain = NuSpline::new(polygon.clone(), Tension::Uniform(0.0)).unwrap();
            let before = plain.check(Criteria::ALL, Tolerances::default()).unwrap();
            let fit = NuSpline::shape_preserving(polygon, &options).unwrap();
            assert_eq!(fit.outcome.diagnostics.status, Status::Solved, "{kind:?}");
            let report = fit.curve.check(criteria, Tolerances::default()).unwrap();
            assert!(report.ok(), "{kind:?}\n{report}");
            mended += before.count(Criterion::GlobalConvexity).violated;
        }
    }
    assert!(mended > 20, "{mended}");
}

#[test]
fn notes_on_nodes_and_oscillation() {
    let chordal = |data: Vec<DVec3>| {
        DataPolygon::new(data, &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap()
    };
    // Tangents between the chords, as a Catmull–Rom spline's, are compatible; others are not.
    let polygon = chordal(points("protein_1a8o_ca.csv"));
    let n = polygon.segments();
    let tangent = |i: usize| {
        let [before, after] = polygon.directions_at(i);
        (before + after).normalize()
    };
    let legs = |i: usize| {
        let size = polygon.chord(i).length() / 3.0;
        [tangent(i) * size, tangent(i + 1) * size]
    };
    let checker = every(&polygon);
    let notes = checker.node_conditions(legs);
    let of = |condition| notes.nodes.iter().filter(move |r| r.condition == condition);
    assert_eq!(of(NodeCondition::Compatibility).count(), n - 1);
    assert!(notes.nodes.iter().all(|r| r.satisfied && r.margin >= 0.0), "{notes:?}");
    assert!(of(NodeCondition::SameTorsion).count() > 10);
    assert!(of(NodeCondition::TorsionChange).count() > 10);
    let backwards = checker.node_conditions(|i| legs(i).map(|v| -v));
    let compatible = |r: &&shapespline::criteria::NodeRecord| {
        r.condition == NodeCondition::Compatibility && r.satisfied
    };
    assert_eq!(backwards.nodes.iter().filter(compatible).count(), 0);

    // Three points on a line between bends: the cubic keeps the inflection, no curve the convexity.
    let bends = |last: f64| {
        let planar = [[0.0, 1.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, last]];
        let polygon =
            DataPolygon::planar(&planar, &Parametrization::Uniform, Boundary::ZeroCurvature);
        let spline = NuSpline::new(polygon.unwrap(), Tension::Uniform(0.0)).unwrap();
        let polygon = spline.polygon();
        let notes = every(polygon).node_conditions(|i| spline.curve().legs()[i]);
        notes.nodes.into_iter().find(|r| r.node == 2).unwrap()
    };
    let inflection = bends(-1.0);
    assert_eq!(inflection.condition, NodeCondition::InflectionNeighbourhood);
    assert!(inflection.satisfied && inflection.margin >= 0.0, "{inflection:?}");
    let convex = bends(1.0);
    assert_eq!(convex.condition, NodeCondition::ConvexNeighbourhood);
    assert!(!convex.satisfied && convex.margin < 0.0, "{convex:?}");

    // A cubic crosses its points' plane as seldom as its tangents allow.
    let mut random = Random::new(3);
    let mut seen = [0; 2];
    for k in 0..300 {
        let (polygon, legs) = case(6 * k + 1 + k % 2, &mut random);
        let straight = |i: usize| [polygon.chord(i) / 3.0; 2];
        let all = |i: usize| if i == SEGMENT { legs } else { straight(i) };
        for o in every(&polygon).node_conditions(all).oscillations {
            assert!(o.satisfied && o.crossings == o.least, "{o:?}");
            seen[o.crossings] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 30), "{seen:?}");
}

/// What counts as straight is what the caller says: at a turn below it there is nothing to note.
#[test]
fn notes_go_by_the_tolerances_that_were_given() {
    let planar = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.05], [3.0, 1.0]];
    let polygon =
        DataPolygon::planar(&planar, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap();
    let noted = |zero: f64| -> Vec<usize> {
        let tolerances = Tolerances { zero, ..Tolerances::default() };
        let checker = Checker::new(&polygon, Criteria::ALL, tolerances);
        assert_eq!(checker.tolerances(), tolerances);
        let notes = checker.node_conditions(|i| [polygon.chord(i) / 3.0; 2]);
        notes.nodes.iter().map(|r| r.node).collect()
    };
    // The polygon turns by 0.05 at node 1, by 0.7 at node 2.
    assert_eq!(noted(1e-9), [1, 2]);
    assert_eq!(noted(0.1), [2]);
}

#[test]
fn what_polygons_call_for() {
    let shape = |data: &[[f64; 3]]| {
        let data = data.iter().map(|&p| DVec3::from(p)).collect();
        let natural = Boundary::ZeroCurvature;
        let polygon = DataPolygon::new(data, &Parametrization::Chordal, natural).unwrap();
        polygon_shape(&polygon, &Tolerances::default())
    };
    let line = shape(&[[0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [5.0, 10.0, 15.0]]);
    assert_eq!(line.affine_dimension, AffineDimension::Line);
    assert!(line.torsion.iter().all(|t| t.is_nan()));
    assert!(line.binormals.iter().all(|b| *b == DVec3::ZERO));
    let collinearity: Criteria = [Criterion::Collinearity].into_iter().collect();
    assert!(line.required.iter().all(|&c| c == collinearity), "{:?}", line.required);

    let plane = shape(&[[0.0; 3], [1.0, 0.0, 1.0], [2.0, 1.0, 3.0], [2.0, 2.0, 4.0]]);
    assert_eq!(plane.affine_dimension, AffineDimension::Plane);
    assert!(!plane.required[1].contains(Criterion::Torsion));
    assert!(!plane.required[1].contains(Criterion::Coplanarity));

    let cube = shape(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
    assert_eq!(cube.affine_dimension, AffineDimension::Space);
    assert_eq!(cube.binormals[1], DVec3::Z);
    assert_eq!(cube.turning_angles[1], std::f64::consts::FRAC_PI_2);
    assert_eq!(cube.torsion[1], 1.0);
    assert!(cube.required[1].contains(Criterion::Torsion));
    // Perpendicular binormal vectors: neither convexity nor inflection.
    assert!(!cube.required[1].contains(Criterion::Convexity));
}
