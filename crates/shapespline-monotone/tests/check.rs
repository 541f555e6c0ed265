// SPDX-License-Identifier: MIT OR Apache-2.0

//! `check_monotone`: planted least values, and what it refuses.
#![allow(clippy::unwrap_used)]

use shapespline_monotone::{Convexity, check_monotone};

/// Bernstein coefficients of `∫ (s − a)² − b` on [0, 1].
fn planted(a: f64, b: f64) -> [f64; 4] {
    let slope = [a * a - b, a * a - a - b, (1.0 - a).powi(2) - b];
    let mut c = [0.0; 4];
    for k in 0..3 {
        c[k + 1] = c[k] + slope[k] / 3.0;
    }
    c
}

#[test]
fn planted_least_slopes_are_found_where_they_are() {
    for (a, b, satisfied) in [(0.3, 1e-6, false), (0.71, -1e-6, true), (0.5, 1e-12, true)] {
        let c = planted(a, b);
        for [from, width] in [[0.0, 1.0], [-7.0, 1e-90], [3.0, 1e60]] {
            let breaks = [from * width, from * width + width];
            let report = check_monotone(&breaks, &[0.0, c[3]], &breaks, &c, None, 1e-9).unwrap();
            let found = report.monotonicity[0];
            assert_eq!(found.satisfied, Some(satisfied));
            assert!((found.margin + b / c[3]).abs() < 1e-9);
            assert!(((found.location - breaks[0]) / width - a).abs() < 1e-4);
            // f″ = 2(s − a) is least at the start.
            let convex = Some(&Convexity::Signs(vec![1]));
            let report = check_monotone(&breaks, &[0.0, c[3]], &breaks, &c, convex, 1e-9).unwrap();
            let found = report.convexity.unwrap()[0];
            assert_eq!((found.satisfied, found.location), (Some(false), breaks[0]));
            assert!((found.margin + 2.0 * a / c[3]).abs() < 1e-9);
        }
    }
}

#[test]
fn refusals_name_the_argument_and_the_place() {
    let (x, y, line) = ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], [0.0, 2.0]);
    let error = |breaks: &[f64], c: &[f64], convex: Option<Convexity>, tolerance| {
        check_monotone(&x, &y, breaks, c, convex.as_ref(), tolerance).unwrap_err().to_string()
    };
    let signs = |signs: &[i8]| Some(Convexity::Signs(signs.to_vec()));
    for (message, part) in [
        (error(&line, &line, None, f64::NAN), "tolerance must not be negative"),
        (error(&[0.0], &line, None, 0.0), "breaks has 1"),
        (error(&[0.0, 2.0, 1.0], &[0.0; 4], None, 0.0), "breaks[2] must exceed"),
        (error(&[0.0, 1.0, 2.0], &[0.0; 3], None, 0.0), "coefficients has 3"),
        (error(&line, &[], None, 0.0), "coefficients has 0"),
        (error(&line, &[0.0, f64::NAN], None, 0.0), "coefficients[1]"),
        (error(&[0.0, 3.0], &line, None, 0.0), "runs from 0 to 3"),
        (error(&x, &[0.0, 1.0, 1.5, 2.0], None, 0.0), "jumps at x = 1"),
        (error(&line, &[0.0, 2.5], None, 0.0), "must pass through y[1], got one that is 0.250"),
        (error(&line, &line, signs(&[1]), 0.0), "convex has 1"),
        (error(&line, &line, signs(&[1, 3]), 0.0), "convex[1] is 3"),
    ] {
        assert!(message.contains(part), "{message:?} lacks {part:?}");
    }
}
