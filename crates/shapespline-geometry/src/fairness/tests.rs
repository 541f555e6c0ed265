// SPDX-License-Identifier: MIT OR Apache-2.0

#![allow(clippy::unwrap_used)]
use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::*;

fn curve(pieces: &[&[[f64; 3]]], dimension: Dimension) -> PiecewiseBezier {
    let degree = pieces[0].len() - 1;
    let breaks = (0..=pieces.len()).map(|k| k as f64).collect();
    let control: Vec<DVec3> = pieces.iter().flat_map(|p| p.iter().map(|&p| p.into())).collect();
    PiecewiseBezier::new(breaks, &control, degree, dimension).unwrap()
}

/// A closed ellipse of four rational quadratics; the seam is at the end of the first axis.
fn ellipse(a: f64, b: f64, dimension: Dimension) -> PiecewiseBezier {
    let corners = [[a, b], [-a, b], [-a, -b], [a, -b]];
    let mut control = Vec::new();
    let mut from = [a, 0.0];
    for (k, corner) in corners.into_iter().enumerate() {
        let to = [[0.0, b], [-a, 0.0], [0.0, -b], [a, 0.0]][k];
        control.extend([from, corner, to].map(|[x, y]| DVec3::new(x, y, 0.0)));
        from = to;
    }
    let weights = [1.0, FRAC_1_SQRT_2, 1.0].repeat(4);
    let breaks = vec![0.0, 1.0, 2.0, 3.0, 4.0];
    PiecewiseBezier::rational(breaks, &control, &weights, 2, dimension).unwrap()
}

#[test]
fn a_circle_is_as_fair_as_can_be() {
    for dimension in [Dimension::Two, Dimension::Three] {
        for radius in [1.0, 3e-80, 7e90] {
            let f = fairness(&ellipse(radius, radius, dimension));
            assert!((f.length / (2.0 * PI * radius) - 1.0).abs() < 1e-12);
            assert!((f.bending / (4.0 * PI * PI) - 1.0).abs() < 1e-12);
            assert!(f.variation < 1e-18 && f.max_curvature_jump == 0.0, "{f:?}");
            assert!((f.max_curvature * radius - 1.0).abs() < 1e-12);
            assert!(f.extrema.is_empty() && f.cusps.is_empty() && f.corners.is_empty());
        }
    }
}

#[test]
fn an_ellipse_has_four_vertices() {
    let (a, b) = (3.0, 1.0);
    for dimension in [Dimension::Two, Dimension::Three] {
        let f = fairness(&ellipse(a, b, dimension));
        assert!((f.max_curvature - a / (b * b)).abs() < 1e-12);
        assert_eq!(f.extrema.len(), 4, "{:?}", f.extrema);
        assert_eq!(f.extrema.iter().filter(|e| e.is_maximum).count(), 2);
        for e in &f.extrema {
            let exact = if e.is_maximum { a / (b * b) } else { b / (a * a) };
            assert!((e.curvature - exact).abs() < 1e-12, "{e:?}");
        }
        // ∫κ² ds and ∫(dκ/ds)² ds by the trapezoidal rule, which is exact for periodic functions.
        let n = 4000;
        let [mut length, mut bending, mut variation] = [0.0; 3];
        for k in 0..n {
            let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(n)).sin_cos();
            let square = a * a * sin * sin + b * b * cos * cos;
            let speed = square.sqrt();
            let slope =
                -3.0 * a * b * (a * a - b * b) * sin * cos / (square * square * speed) / speed;
            length += speed;
            bending += (a * b / (square * speed)).powi(2) * speed;
            variation += slope * slope * speed;
        }
        let h = 2.0 * PI / f64::from(n);
        let [length, bending, variation] = [length, bending, variation].map(|sum| sum * h);
        assert!((f.length / length - 1.0).abs() < 1e-11);
        assert!(
            (f.bending / (length * bending) - 1.0).abs() < 1e-10,
            "{}",
            f.bending / (length * bending)
        );
        assert!((f.variation / (length.powi(3) * variation) - 1.0).abs() < 1e-9);
    }
}

/// Against dense sampling of random cubics: the largest curvature, and how often it turns.
#[test]
fn extrema_are_those_that_samples_show() {
    use rand::{Rng, SeedableRng, rngs::StdRng};
    let mut random = StdRng::seed_from_u64(7);
    for case in 0..200 {
        let dimension = if case % 2 == 0 { Dimension::Two } else { Dimension::Three };
        let points: Vec<[f64; 3]> = (0..4)
            .map(|_| {
                let z =
                    if dimension == Dimension::Two { 0.0 } else { random.random_range(-1.0..1.0) };
                [random.random_range(-1.0..1.0), random.random_range(-1.0..1.0), z]
            })
            .collect();
        let f = fairness(&curve(&[&points], dimension));
        let piece = Piece::new(
            points.iter().map(|&p| DVec3::from(p).extend(1.0)).collect(),
            false,
            dimension == Dimension::Two,
        );
        let n = 20_000;
        let samples: Vec<f64> =
            (0..=n).map(|k| piece.curvature(f64::from(k) / f64::from(n))).collect();
        let largest = samples.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
        assert!(f.max_curvature >= largest * (1.0 - 1e-12), "{case}");
        assert!(f.max_curvature <= largest * (1.0 + 1e-2), "{case}: {} {largest}", f.max_curvature);
        let turns = samples.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
        assert_eq!(f.extrema.len(), turns, "{case}");
    }
}

/// Where a curve nearly stops it turns within a small part of its parameter, and rounding of the whole hides how: found
/// on a fair curve between two reversals, whose largest curvature was said to be 47, not 2·10⁸.
#[test]
fn extrema_are_seen_where_a_curve_nearly_stops() {
    use rand::{Rng, SeedableRng, rngs::StdRng};
    let mut random = StdRng::seed_from_u64(11);
    for case in 0..120 {
        let dimension = if case % 2 == 0 { Dimension::Two } else { Dimension::Three };
        let mut vector = |size: f64| {
            let mut next = || random.random_range(-size..size);
            DVec3::new(next(), next(), if dimension == Dimension::Two { 0.0 } else { next() })
        };
        let slow = 10f64.powi(-(case % 6) - 1);
        let (a, b, c) = (vector(slow), vector(slow), vector(1.0));
        // At the start, at the end, or inside, where γ' = 3 (a (1 − 2t)² + c t (1 − t) 4).
        let legs = match case % 3 {
            0 => [a, b, c],
            1 => [c, b, a],
            _ => [c, (a * 3.0 - c) * 0.5, c],
        };
        let slowest = [0.0, 1.0, 0.5][case as usize % 3];
        let points = [DVec3::ZERO, legs[0], legs[0] + legs[1], legs[0] + legs[1] + legs[2]];
        let f = fairness(&curve(&[&points.map(|p| p.to_array())], dimension));
        let speed = |t: f64| {
            let s = 1.0 - t;
            (legs[0] * (s * s) + legs[1] * (2.0 * s * t) + legs[2] * (t * t)) * 3.0
        };
        let change = |t: f64| ((legs[1] - legs[0]) * (1.0 - t) + (legs[2] - legs[1]) * t) * 6.0;
        let curvature = |t: f64| speed(t).cross(change(t)).length() / speed(t).length().powi(3);
        let away = (0..40_000).map(|k| 10f64.powf(-f64::from(k) * 3e-4));
        let samples = away.flat_map(|d| [slowest - d, slowest + d]).chain([slowest]);
        let within = samples.filter(|t| (0.0..=1.0).contains(t));
        let largest = within.map(curvature).fold(0.0, f64::max);
        assert!(
            f.cusps.is_empty() && f.max_curvature >= largest * (1.0 - 1e-6),
            "{case} {largest} {legs:?}: {f:?}"
        );
        assert!(f.max_curvature <= largest * (1.0 + 1e-2), "{case}: {} {largest}", f.max_curvature);
    }
}

/// Found on straight runs: the rounding of a skew line was integrated for a second per segment.
#[test]
fn a_line_has_no_energy_wherever_it_lies() {
    for away in [0.0, 1.0, 100.0, 1e6] {
        let (from, along) = (DVec3::new(0.3, -0.7, 0.2) * away, DVec3::new(0.31, 0.17, -0.23));
        let at = |x: f64| (from + along * x).to_array();
        let piece = |x: f64| [at(x), at(x + 0.2), at(x + 0.37), at(x + 0.7)];
        let pieces: Vec<[[f64; 3]; 4]> = (0..20).map(|k| piece(0.7 * f64::from(k))).collect();
        let all: Vec<&[[f64; 3]]> = pieces.iter().map(|piece| piece.as_slice()).collect();
        let f = fairness(&curve(&all, Dimension::Three));
        assert_eq!((f.bending, f.variation, f.extrema.len()), (0.0, 0.0, 0), "{away}");
        assert!((f.length / (14.0 * along.length()) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn cusps_corners_and_jumps_are_said() {
    // (t², t³) has its cusp at the start; moved inside by a longer interval.
    let cusp = [[1.0, -1.0, 0.0], [-1.0 / 3.0, 1.0, 0.0], [-1.0 / 3.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
    let f = fairness(&curve(&[&cusp], Dimension::Two));
    assert_eq!(f.cusps.len(), 1);
    assert!((f.cusps[0].t - 0.5).abs() < 1e-6);
    assert!(f.max_curvature.is_infinite() && f.bending.is_infinite() && f.variation.is_infinite());
    assert!(f.length.is_finite());

    let corner: [&[[f64; 3]]; 2] =
        [&[[0.0; 3], [1.0, 0.0, 0.0]], &[[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]];
    let f = fairness(&curve(&corner, Dimension::Three));
    assert_eq!(f.corners, [1]);
    assert!((f.length - 2.0).abs() < 1e-14);
    assert!(f.max_curvature.is_infinite() && f.bending.is_infinite());

    // A line and a parabola: curvature jumps from 0 to 2 at the break.
    let jump: [&[[f64; 3]]; 2] = [
        &[[-1.0, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0; 3]],
        &[[0.0; 3], [0.5, 0.0, 0.0], [1.0, 1.0, 0.0]],
    ];
    let f = fairness(&curve(&jump, Dimension::Two));
    assert!((f.max_curvature_jump - 2.0 * f.length).abs() < 1e-14);
    assert!(f.variation.is_infinite() && f.bending.is_finite());
    assert_eq!((f.max_curvature, f.extrema.len()), (2.0, 1));
    assert!(f.extrema[0].is_maximum);
    assert_eq!(f.max_curvature_at, Place { piece: 1, t: 0.0 });
}
