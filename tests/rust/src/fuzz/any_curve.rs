// SPDX-License-Identifier: MIT OR Apache-2.0

//! Curves that were not made here, and the criteria on them.

use shapespline::{
    criteria::{CurveChecker, check, check_curve, polygon_shape},
    geometry::{DVec4, PiecewiseBezier},
    prelude::*,
};

use super::{Bytes, readable};

/// Every constructor of piecewise Bézier curves, and every criterion on what they make. Positions are
/// finite; a report counts no more violations than segments it applies to, lists those it counts, and
/// leaves open only intervals within their segment; single questions agree with it. Arbitrary end legs
/// on arbitrary polygons are judged too.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    if bytes.below(4) == 0 {
        return legs(&mut bytes);
    }
    let planar = bytes.below(4) == 0;
    let Some(curve) = piecewise(&mut bytes, planar) else { return };
    let (first, last) = (curve.breaks()[0], curve.breaks()[curve.pieces()]);
    let mut u: Vec<f64> = if bytes.flag() {
        curve.breaks().to_vec()
    } else {
        (0..bytes.below(6) + 2).map(|_| first + bytes.fraction() * (last - first)).collect()
    };
    u.sort_by(f64::total_cmp);
    u.dedup();
    let mut points: Vec<DVec3> = u.iter().map(|&u| curve.position(u)).collect();
    if bytes.below(16) == 0 {
        points.iter_mut().for_each(|p| *p += bytes.vector(planar));
    }
    let boundary = if bytes.below(4) == 0 { Boundary::Periodic } else { Boundary::ZeroCurvature };
    let given = Parametrization::Given(u);
    let polygon = DataPolygon::with_dimension(points, curve.dimension(), &given, boundary);
    let polygon = match polygon {
        Ok(polygon) => polygon,
        Err(error) => return readable(&error),
    };
    let (criteria, tolerances) = (bytes.criteria(), bytes.tolerances());
    let report = match check_curve(&polygon, &curve, criteria, tolerances) {
        Ok(report) => report,
        Err(error) => return readable(&error),
    };
    consistent(&report, &polygon);
    let checker = CurveChecker::new(&polygon, &curve, criteria, tolerances, 1e-9).unwrap();
    for segment in 0..polygon.segments() {
        for criterion in criteria.iter() {
            let record = checker.record(segment, criterion);
            let place = |s: usize, c: Criterion| s == segment && c == criterion;
            let violated = report.violations.iter().any(|v| place(v.segment, v.criterion));
            let open = report.undecided.iter().any(|v| place(v.segment, v.criterion));
            assert_eq!(violated, record.applicable && !record.satisfied && !open, "{record:?}");
            assert_eq!(open, checker.undecided(segment, criterion).is_some(), "{record:?}");
        }
    }
    let notes = checker.node_conditions();
    assert!(notes.oscillations.iter().all(|o| o.crossings >= o.least || !o.satisfied));
}

fn consistent(report: &ShapeReport, polygon: &DataPolygon) {
    assert_eq!(report.segments, polygon.segments());
    assert!(!report.to_string().is_empty());
    for criterion in Criterion::ALL {
        let count = report.count(criterion);
        assert!(count.violated <= count.applicable, "{criterion}: {count:?}");
        let listed = report.violations.iter().filter(|v| v.criterion == criterion).count();
        assert_eq!(listed, count.violated, "{criterion}");
    }
    for v in &report.violations {
        assert!(v.applicable && !v.satisfied && !(v.margin > 0.0), "{v:?}");
    }
    let u = polygon.parameters();
    for open in &report.undecided {
        let [from, to] = open.interval;
        let slack = 1e-12 * (u[u.len() - 1] - u[0]);
        let within = from >= u[open.segment] - slack && to <= u[open.segment + 1] + slack;
        assert!(within && from <= to, "{open:?}");
    }
}

/// Arbitrary end legs, in range or not.
fn legs(bytes: &mut Bytes<'_>) {
    let Some(polygon) = bytes.polygon(12) else { return };
    let planar = polygon.dimension() == Dimension::Two;
    let legs: Vec<[DVec3; 2]> = (0..polygon.segments())
        .map(|i| match bytes.below(4) {
            0 => [polygon.chord(i) / 3.0; 2],
            1 => [polygon.chord(i) * bytes.fraction(), bytes.vector(planar)],
            _ => [bytes.vector(planar), bytes.vector(planar)],
        })
        .collect();
    let (criteria, tolerances) = (bytes.criteria(), bytes.tolerances());
    if let Err(error) = tolerances.validate() {
        return readable(&error);
    }
    let shape = polygon_shape(&polygon, &tolerances);
    assert_eq!(shape.required.len(), polygon.segments());
    // Legs that are not finite make no curve, but a checker that is asked says no.
    let report = check(&polygon, |i| legs[i], criteria, tolerances);
    consistent(&report, &polygon);
    let _ = Checker::new(&polygon, criteria, tolerances).node_conditions(|i| legs[i]);
}

/// Some piecewise Bézier curve, by any constructor; lengths that do not fit now and then.
pub(super) fn piecewise(bytes: &mut Bytes<'_>, planar: bool) -> Option<PiecewiseBezier> {
    let dimension = if planar { Dimension::Two } else { Dimension::Three };
    let degree = match bytes.below(8) {
        0 => bytes.below(20),
        1..=4 => 3,
        d => d - 3,
    };
    let pieces = bytes.below(5) + 1;
    let kind = bytes.below(6);
    let spline = matches!(kind, 3 | 4);
    let mut expected = if spline { pieces + degree } else { pieces * (degree + 1) };
    if bytes.below(32) == 0 {
        expected = bytes.below(64);
    }
    let mut control = if expected > 0 { bytes.points(expected, planar) } else { Vec::new() };
    // Pieces of a curve meet, mostly.
    if !spline && kind != 2 && bytes.below(8) != 0 {
        for i in (degree + 1..control.len()).step_by(degree + 1) {
            control[i] = control[i - 1];
        }
    }
    let weights: Vec<f64> = (0..expected)
        .map(|_| if bytes.below(8) == 0 { bytes.unscaled() } else { 0.1 + bytes.fraction() })
        .collect();
    let breaks = bytes.increasing(pieces + 1);
    let mut knots: Vec<f64> = vec![breaks[0]; degree];
    knots.extend(&breaks);
    knots.extend(vec![breaks[pieces]; degree]);
    if bytes.flag() && spline {
        knots = bytes.increasing(pieces + 2 * degree + 1);
    }
    let made = match kind {
        0 => PiecewiseBezier::new(breaks, &control, degree, dimension),
        1 => PiecewiseBezier::rational(breaks, &control, &weights, degree, dimension),
        2 => PiecewiseBezier::from_power(breaks, &control, degree, dimension),
        3 => PiecewiseBezier::from_bspline(&knots, &control, degree, dimension),
        4 => PiecewiseBezier::from_nurbs(&knots, &control, &weights, degree, dimension),
        _ => {
            let weighted = |(p, w): (&DVec3, &f64)| p.extend(*w);
            let control: Vec<DVec4> = control.iter().zip(&weights).map(weighted).collect();
            PiecewiseBezier::homogeneous(breaks, control, degree, dimension, bytes.flag())
        }
    };
    made.inspect_err(readable).ok()
}
