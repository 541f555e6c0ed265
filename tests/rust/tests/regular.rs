// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long regular polygons: solved by default, in rounds that hardly grow with their length, and the same
//! everywhere in the middle.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::{criteria::Record, prelude::*};
use shapespline_tests::{
    families::{Family, Interpolation},
    regular::Regular,
    scaled,
};

const NAMED: [Parametrization; 3] =
    [Parametrization::Uniform, Parametrization::Chordal, Parametrization::Centripetal];

/// A dozen rounds, a few more until fronts are known, and one for each doubling of a front.
const ROUNDS: usize = 60;

fn assert_solved(family: Family, polygon: DataPolygon, name: &str) {
    let fit = family.fit(polygon);
    let name = format!("{name} {family:?}: {:?}", fit.diagnostics());
    assert_eq!(fit.diagnostics().status, Status::Solved, "{name}");
    assert!(fit.report.ok() && fit.report == fit.spline.report(), "{name}");
    assert!(fit.diagnostics().iterations <= ROUNDS, "{name}");
}

/// The two that ended unsolved after 200 rounds, at their lengths and at others.
#[test]
fn a_violation_that_travels_inwards_is_met_in_a_few_rounds() {
    for n in [300, 1562, 2000, 5000] {
        for (kind, names) in [(Regular::Zigzag, &NAMED[1]), (Regular::Lattice, &NAMED[0])] {
            for strategy in [Strategy::Growth, Strategy::Fairest] {
                let polygon = kind.polygon(n, names, Boundary::ZeroCurvature);
                assert_solved(Family::Nu(strategy), polygon, &format!("{kind:?} of {n}"));
            }
        }
    }
}

#[test]
fn long_regular_data_are_solved_by_default() {
    let n = scaled(100_000);
    for (k, kind) in Regular::ALL.into_iter().enumerate() {
        for (j, family) in Family::DEFAULTS.into_iter().enumerate() {
            let names = if kind == Regular::Zigzag { &NAMED[1] } else { &NAMED[(k + j) % 3] };
            let polygon = kind.polygon(n, names, Boundary::ZeroCurvature);
            assert_solved(family, polygon, &format!("{n} points of {kind:?}, {names:?}"));
        }
    }
}

#[test]
fn regular_data_of_every_boundary_and_parametrisation() {
    let mut case = 0;
    for kind in Regular::ALL {
        for n in [20, 60, 200, scaled(4000)] {
            let circular = Boundary::Circular;
            let [start, end] = [DVec3::new(0.3, -1.0, 0.0), DVec3::new(2.0, 0.5, 0.0)];
            for boundary in [circular, Boundary::Periodic, Boundary::tangents(start, end)] {
                case += 1;
                let family = Family::DEFAULTS[case % 4];
                let names = &NAMED[case % 3];
                let polygon = kind.polygon(n, names, boundary);
                assert_solved(family, polygon, &format!("{kind:?} {n} {names:?} {boundary:?}"));
            }
        }
    }
}

/// Where work is cut into blocks, what comes before and after a cut is the same as elsewhere: under even
/// tension the curve of regular data repeats itself. Sizes around every block that the crates have.
#[test]
fn blocks_leave_no_seams() {
    let blocks = [64, 96, 128, 512, 2048, 4096, 8192, 16_384, 32_768, 65_536];
    for (k, block) in blocks.into_iter().enumerate() {
        let kind = Regular::ALL[k];
        let period = kind.period().unwrap();
        for n in [block - 1, block, block + 1, block + 2, 2 * block + 1] {
            let polygon = kind.polygon(n, &Parametrization::Chordal, Boundary::ZeroCurvature);
            let tension = Tension::Uniform(1.5);
            let curves: [Box<dyn Interpolation>; 3] = [
                Box::new(NuSpline::new(polygon.clone(), tension).unwrap()),
                Box::new(TensionSpline::new(polygon.clone(), TangentScale::Uniform(0.4)).unwrap()),
                Box::new(CatmullRom::new(polygon, Tension::Uniform(0.3), Continuity::C1).unwrap()),
            ];
            for curve in &curves {
                repeats(curve.as_ref(), &period, &format!("{n} points of {kind:?}"));
            }
        }
    }
}

fn repeats(curve: &dyn Interpolation, period: &[DVec3], name: &str) {
    // The ends are felt over half as many segments as have digits.
    const FELT: usize = 30;
    let legs = curve.curve().cubic().legs();
    for i in FELT..legs.len().saturating_sub(FELT + period.len()) {
        let apart = [0, 1].map(|end| (legs[i][end] - legs[i + period.len()][end]).length());
        assert!(apart.iter().all(|&x| x < 1e-9), "{name}, segment {i}: {apart:?}");
    }
    let report = curve.report();
    let segments = legs.len();
    assert_eq!(report.segments, segments);
    let inside = FELT..segments - FELT.min(segments);
    // A margin of zero has the sign that rounding gives it.
    for v in report.violations.iter().filter(|v| v.margin < -1e-9 && inside.contains(&v.segment)) {
        let next = v.segment + period.len();
        let after = &report.violations[report.violations.partition_point(|w| w.segment < next)..];
        let mut there = after.iter().take_while(|w| w.segment == next);
        let repeats = |w: &Record| w.criterion == v.criterion;
        assert!(!inside.contains(&next) || there.any(repeats), "{name}: {v:?}");
    }
}
