// SPDX-License-Identifier: MIT OR Apache-2.0

//! Results printed in paper 001 (specification, section 1), reproduced.
#![allow(clippy::unwrap_used, reason = "test code")]

use shapespline::prelude::*;
use shapespline_tests::{feature_line, helix};

fn nussp() -> SearchOptions {
    SearchOptions { strategy: Strategy::Nussp, ..SearchOptions::default() }
}

#[test]
fn the_c2_cubic_of_the_feature_line_has_four_violations() {
    let cubic = NuSpline::new(feature_line(), Tension::Uniform(0.0)).unwrap();
    // The paper's criteria leave out inflection, and turning at a node, of which node 2 is in want too.
    let criteria = Criteria::DEFAULT.without(Criterion::Turning);
    let report = cubic.check(criteria, Tolerances::default()).unwrap();
    let found: Vec<(usize, Criterion)> =
        report.violations.iter().map(|v| (v.segment + 1, v.criterion)).collect();
    let expected = [
        (1, Criterion::Convexity),
        (2, Criterion::Torsion),
        (5, Criterion::Torsion),
        (16, Criterion::Torsion),
    ];
    assert_eq!(found, expected);
    // "its binormal at node 2 failed": the place is the end of segment 1.
    assert_eq!(report.violations[0].location, cubic.curve().knots()[1]);
}

#[test]
fn nussp_on_the_feature_line() {
    let fit = NuSpline::shape_preserving(feature_line(), &nussp()).unwrap();
    assert_eq!(fit.outcome.diagnostics.status, Status::Solved);
    assert_eq!(fit.outcome.diagnostics.iterations, 5);
    let expected: Vec<f64> = (1..=20)
        .map(|node| match node {
            1..=7 => 0.5,
            15..=18 => 2.0,
            _ => 0.0,
        })
        .collect();
    assert_eq!(fit.curve.tension(), expected);
}

#[test]
fn nussp_on_the_helix() {
    let expected = |outer: f64, inner: f64| -> Vec<f64> {
        (1..=25)
            .map(|node| match node {
                1 | 3 | 23 | 25 => outer,
                2 | 4 | 22 | 24 => inner,
                _ => 0.0,
            })
            .collect()
    };
    for length in [5.7, 6.0, 6.4] {
        let fit = NuSpline::shape_preserving(helix(length), &nussp()).unwrap();
        assert_eq!(fit.curve.tension(), expected(3.5, 2.0), "length {length}");
        assert_eq!(fit.outcome.diagnostics.iterations, 8);
        assert!(fit.report.ok());
    }
    let fit = NuSpline::shape_preserving(helix(1.0), &nussp()).unwrap();
    assert_eq!(fit.curve.tension(), expected(0.5, 0.0));
}
