// SPDX-License-Identifier: MIT OR Apache-2.0

//! Three points on a line: the torsion and the coplanarity that Definition 8.2 of paper 002 asks of the
//! two segments together, against dense sampling.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::criteria::{NodeCondition, NodeRecord};
use shapespline::prelude::*;
use shapespline_tests::generate::Random;

/// The middle one of three points on a line.
const NODE: usize = 2;
const SAMPLES: usize = 2000;

/// Points with three on a line, and two more so that the polygon is not planar.
fn polygon(next: [f64; 3], spacings: [f64; 5]) -> DataPolygon {
    let points = [[-1.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [2.5, 0.0, 0.0], next];
    let last = DVec3::from(next) + DVec3::new(0.3, 1.0, 1.0);
    let points = points.map(DVec3::from).into_iter().chain([last]).collect();
    let mut u = vec![0.0];
    for h in spacings {
        u.push(u[u.len() - 1] + h);
    }
    DataPolygon::new(points, &Parametrization::Given(u), Boundary::ZeroCurvature).unwrap()
}

fn record(
    polygon: &DataPolygon,
    legs: &dyn Fn(usize) -> [DVec3; 2],
    condition: NodeCondition,
) -> Option<NodeRecord> {
    let checker = Checker::new(polygon, Criteria::DEFAULT, Tolerances::default());
    let notes = checker.node_conditions(legs);
    notes.nodes.into_iter().find(|r| r.node == NODE && r.condition == condition)
}

/// `γ', γ'', γ'''` of a segment with end legs `a, c` at `t`, up to factors.
fn derivatives([a, c]: [DVec3; 2], chord: DVec3, t: f64) -> [DVec3; 3] {
    let (b, s) = (chord - a - c, 1.0 - t);
    [a * (s * s) + b * (2.0 * s * t) + c * (t * t), (b - a) * s + (c - b) * t, a + c - b * 2.0]
}

/// Calls `look` with the parameter and `ω` along the two segments together.
fn along(
    polygon: &DataPolygon,
    legs: &dyn Fn(usize) -> [DVec3; 2],
    mut look: impl FnMut(f64, DVec3),
) {
    for i in [NODE - 1, NODE] {
        for k in 0..=SAMPLES {
            let t = k as f64 / SAMPLES as f64;
            let [d1, d2, _] = derivatives(legs(i), polygon.chord(i), t);
            look(polygon.parameters()[i] + t * polygon.spacing(i), d1.cross(d2));
        }
    }
}

/// Legs near a third of the chords on both segments, off it by a random part of given sizes.
fn legs(polygon: &DataPolygon, random: &mut Random, off: [f64; 3]) -> [[DVec3; 2]; 5] {
    std::array::from_fn(|i| {
        [0; 2].map(|_| polygon.chord(i) / 3.0 + random.vector() * DVec3::from(off))
    })
}

#[test]
fn torsion_of_both_segments_together() {
    let mut random = Random::new(821);
    let mut seen = [0; 2];
    for case in 0..800 {
        let side = if case % 2 == 0 { 1.0 } else { -1.0 };
        let next = [3.0, random.within(-1.0, 1.0), side * random.within(0.2, 1.0)];
        let polygon = polygon(next, [1.0, 1.0, 1.5, 1.0, 1.0]);
        let all = legs(&polygon, &mut random, [0.2, 0.2, 0.2]);
        let legs = |i: usize| all[i];
        let found = record(&polygon, &legs, NodeCondition::NeighbourhoodTorsion).unwrap();
        // Γ of x_{i−2}, x_{i−1}, x_{i+1}, x_{i+2}, written out.
        let x = polygon.points();
        let (l0, l1, l2) = (x[1] - x[0], x[3] - x[1], x[4] - x[3]);
        let gamma = l0.cross(l1).dot(l2);
        let least = [1, 2].into_iter().fold(f64::INFINITY, |least, i| {
            (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64).fold(least, |least, t| {
                let [d1, d2, d3] = derivatives(legs(i), polygon.chord(i), t);
                least.min(d1.cross(d2).dot(d3) * gamma.signum())
            })
        });
        if least.abs() > 1e-9 {
            assert_eq!(found.satisfied, least > 0.0, "case {case}: {found:?} {least}");
            assert_eq!(found.margin > 0.0, found.satisfied);
            assert!((1.0..=3.5).contains(&found.location), "{found:?}");
            seen[usize::from(found.satisfied)] += 1;
        }
        let none = record(&polygon, &legs, NodeCondition::NeighbourhoodCoplanarity);
        assert_eq!(none, None);
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");

    // Planted: torsion of the polygon's sign on both segments, then of the opposite on one.
    let polygon = polygon([3.0, 0.5, 1.0], [1.0; 5]);
    let twisted = |sign: f64| {
        move |i: usize| {
            let third = [DVec3::X / 3.0, DVec3::X / 2.0][usize::from(i == NODE)];
            let turn = if i == NODE { sign } else { 1.0 };
            // det[a, L, c] = −a_y L_x c_z: the polygon's Γ is −1·2.5·1 in this frame.
            [third + DVec3::new(0.0, 0.1, 0.0), third + DVec3::new(0.0, 0.0, 0.1 * turn)]
        }
    };
    let satisfied = |sign: f64| {
        let found = record(&polygon, &twisted(sign), NodeCondition::NeighbourhoodTorsion);
        found.unwrap().satisfied
    };
    let x = polygon.points();
    let gamma = (x[1] - x[0]).cross(x[3] - x[1]).dot(x[4] - x[3]);
    let torsion = DVec3::Y.cross(DVec3::X).dot(DVec3::Z);
    assert_eq!((satisfied(1.0), satisfied(-1.0)), (gamma * torsion > 0.0, false));
    let flipped = |i: usize| twisted(1.0)(i).map(|v| DVec3::new(v.x, v.y, -v.z));
    let found = record(&polygon, &flipped, NodeCondition::NeighbourhoodTorsion).unwrap();
    assert_eq!(found.satisfied, gamma * torsion < 0.0);
}

#[test]
fn coplanarity_of_a_convex_neighbourhood() {
    let mut random = Random::new(822);
    let epsilon = Tolerances::default().coplanarity;
    let mut seen = [0; 2];
    for case in 0..600 {
        let polygon = polygon([3.0, 1.0, 0.0], [1.0, 1.0, 1.5, 1.0, 1.0]);
        // Planar every third time: the sense of turning may change, the plane does not.
        let off = if case % 3 == 0 { 0.0 } else { 10f64.powf(random.within(-3.5, -0.5)) };
        let all = legs(&polygon, &mut random, [0.1, 0.15, off]);
        let legs = |i: usize| all[i];
        let found = record(&polygon, &legs, NodeCondition::NeighbourhoodCoplanarity).unwrap();
        let (mut largest, mut up) = (0.0f64, [[false; 2]; 2]);
        along(&polygon, &legs, |u, omega| {
            if omega.length() > 1e-9 {
                largest = largest.max(omega.cross(DVec3::Z).length() / omega.length());
            }
            if u != 2.0 {
                up[usize::from(u > 2.0)][usize::from(omega.z > 0.0)] = true;
            }
        });
        // Between two samples of a segment it can pass a right angle to the normal, without vanishing.
        if off > 0.0 && up.iter().any(|up| up[0] && up[1]) {
            largest = 1.0;
        }
        if (largest - epsilon).abs() > 1e-2 {
            assert_eq!(found.satisfied, largest < epsilon, "case {case}: {found:?} {largest}");
            seen[usize::from(found.satisfied)] += 1;
        }
        assert_eq!(found.margin > 0.0, found.satisfied);
        assert!(off > 0.0 || found.satisfied, "case {case}: {found:?}");
        let none = record(&polygon, &legs, NodeCondition::NeighbourhoodTorsion);
        assert_eq!(none, None);
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}

#[test]
fn coplanarity_of_an_inflection_neighbourhood() {
    let mut random = Random::new(823);
    let epsilon = Tolerances::default().coplanarity;
    let mut seen = [0; 2];
    for case in 0..600 {
        let h = [(); 5].map(|()| random.within(0.5, 2.0));
        let next = [3.0, -random.within(0.3, 1.5), 0.0];
        let polygon = polygon(next, h);
        let off = 10f64.powf(random.within(-3.5, -0.5));
        // First to the one side of the line, then to the other, as the polygon turns.
        let bend = |i: usize, k: usize, random: &mut Random| {
            let y = [0.0, -1.0, 1.0, 0.0, 0.0][i] * if k == 0 { 1.0 } else { -1.0 };
            let v = DVec3::new(0.0, y * random.within(-0.02, 0.2), off * random.vector().z);
            polygon.chord(i) / 3.0 + v
        };
        let mut all = [[DVec3::ZERO; 2]; 5];
        for (i, pair) in all.iter_mut().enumerate() {
            *pair = [bend(i, 0, &mut random), bend(i, 1, &mut random)];
        }
        let legs = |i: usize| all[i];
        let found = record(&polygon, &legs, NodeCondition::NeighbourhoodCoplanarity).unwrap();
        // (5.9) of the four points that are left, written out.
        let x = polygon.points();
        let unit = |i: usize, j: usize| (x[j] - x[i]).normalize();
        let p = unit(0, 1).cross(unit(1, 3)).length() * (x[1] - x[0]).length();
        let q = unit(1, 3).cross(unit(3, 4)).length() * (x[4] - x[3]).length();
        let flip = 1.0 / (1.0 + (q / p).sqrt() * (h[0] / h[3]).powf(0.75));
        let (start, width) = (polygon.parameters()[1], h[1] + h[2]);
        let parts = [start + 0.5 * flip * width, start + 0.5 * (1.0 + flip) * width];
        let (mut largest, mut signs) = (0.0f64, [[false; 2]; 2]);
        let mut clear = f64::INFINITY;
        along(&polygon, &legs, |u, omega| {
            let part = usize::from(u >= parts[1]);
            if u <= parts[0] || part == 1 {
                largest = largest.max(omega.cross(DVec3::Z).length() / omega.length());
                signs[part][usize::from(omega.z > 0.0)] = true;
                clear = clear.min(omega.length());
            }
        });
        let one_sign = signs.iter().all(|s| !(s[0] && s[1]));
        if (largest - epsilon).abs() > 1e-2 && clear > 1e-6 {
            let holds = largest < epsilon && one_sign;
            assert_eq!(found.satisfied, holds, "case {case}: {found:?} {largest} {signs:?}");
            assert_eq!(found.margin > 0.0, found.satisfied);
            seen[usize::from(found.satisfied)] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 50), "{seen:?}");
}

#[test]
fn a_planar_polygon_asks_for_neither() {
    let points = [[-1.0, 1.0], [0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 1.0], [3.0, 2.0]];
    let natural = Boundary::ZeroCurvature;
    let polygon = DataPolygon::planar(&points, &Parametrization::Uniform, natural).unwrap();
    let legs = |i: usize| [polygon.chord(i) / 3.0; 2];
    for condition in [NodeCondition::NeighbourhoodTorsion, NodeCondition::NeighbourhoodCoplanarity]
    {
        assert_eq!(record(&polygon, &legs, condition), None);
    }
}
