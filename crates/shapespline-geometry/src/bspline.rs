// SPDX-License-Identifier: MIT OR Apache-2.0

//! B-splines taken apart into Bézier pieces, by Boehm's knot insertion.

use glam::DVec4;

use crate::{InputError, parametrization::check_increasing};

/// Breaks and Bézier points (`degree + 1` a piece) of a B-spline on its base interval.
pub(crate) fn bezier_of_bspline(
    knots: &[f64],
    control: &[DVec4],
    degree: usize,
) -> Result<(Vec<f64>, Vec<DVec4>), InputError> {
    let (n, d) = (control.len(), degree);
    if n <= d {
        let (argument, needed, why) = ("control", d + 1, " for this degree");
        return Err(InputError::TooFewPoints { argument, needed, found: n, why });
    }
    if knots.len() != n + d + 1 {
        let (argument, expected, found) = ("knots", n + d + 1, knots.len());
        let per = "control points and degree and one";
        return Err(InputError::Length { argument, expected, found, per });
    }
    if let Some(index) = knots.iter().position(|t| !t.is_finite()) {
        return Err(InputError::NotFinite { argument: "knots", index, value: knots[index] });
    }
    if let Some(i) = knots.windows(2).position(|w| w[1] < w[0]) {
        let (argument, index) = ("knots", i + 1);
        let (previous, value) = (knots[i], knots[i + 1]);
        return Err(InputError::NotIncreasing { argument, index, previous, value });
    }
    let mut breaks = knots[d..=n].to_vec();
    breaks.dedup();
    if breaks.len() < 2 {
        let (argument, index, value) = ("knots", n, knots[n]);
        let allowed = "greater than the first knot of the base interval";
        return Err(InputError::OutOfRange { argument, index, value, allowed });
    }
    check_increasing("knots", &breaks)?;

    // Piece by piece: the d + 1 points that act on [t_k, t_{k+1}], blossomed at its ends. The Bézier
    // point j is the blossom at (d − j) times the start and j times the end.
    let mut pieces = Vec::with_capacity((breaks.len() - 1) * (d + 1));
    for w in breaks.windows(2) {
        let k = knots.partition_point(|&t| t <= w[0]) - 1;
        for j in 0..=d {
            let mut b = control[k - d..=k].to_vec();
            for r in 1..=d {
                let u = if r <= d - j { w[0] } else { w[1] };
                for i in 0..=d - r {
                    let (low, high) = (knots[k - d + r + i], knots[k + 1 + i]);
                    let t = (u - low) / (high - low);
                    b[i] = b[i] * (1.0 - t) + b[i + 1] * t;
                }
            }
            pieces.push(b[0]);
        }
    }
    Ok((breaks, pieces))
}

#[cfg(test)]
mod tests {
    use crate::{DVec3, Dimension, PiecewiseBezier};

    /// Value by the recursion of Cox and de Boor, written out.
    fn value(knots: &[f64], control: &[DVec3], d: usize, u: f64) -> DVec3 {
        fn basis(knots: &[f64], i: usize, d: usize, u: f64) -> f64 {
            if d == 0 {
                return f64::from(u8::from(knots[i] <= u && u < knots[i + 1]));
            }
            let part = |a: f64, b: f64, n: f64| if b > 0.0 { a / b * n } else { 0.0 };
            part(u - knots[i], knots[i + d] - knots[i], basis(knots, i, d - 1, u))
                + part(
                    knots[i + d + 1] - u,
                    knots[i + d + 1] - knots[i + 1],
                    basis(knots, i + 1, d - 1, u),
                )
        }
        (0..control.len()).fold(DVec3::ZERO, |s, i| s + control[i] * basis(knots, i, d, u))
    }

    #[test]
    fn pieces_have_the_values_of_the_spline() {
        let points: Vec<DVec3> = (0..9)
            .map(f64::from)
            .map(|x| DVec3::new((2.3 * x).sin(), (1.7 * x).cos(), 0.3 * x))
            .collect();
        for d in 1..=5 {
            // Double knots, unclamped ends.
            let mut knots: Vec<f64> = (0..9 + d + 1).map(|i| (i as f64).powf(1.2)).collect();
            knots[d + 2] = knots[d + 1];
            let curve = PiecewiseBezier::from_bspline(&knots, &points, d, Dimension::Three);
            let curve = curve.unwrap();
            assert_eq!(curve.pieces(), 9 - d - usize::from(d + 2 <= 9));
            let (first, last) = (knots[d], knots[9]);
            for k in 0..200 {
                let u = first + (last - first) * f64::from(k) / 200.0;
                let expected = value(&knots, &points, d, u);
                assert!((curve.position(u) - expected).length() < 1e-13, "{d} {u}");
            }
        }
    }

    #[test]
    fn a_circle_of_weights_is_a_circle() {
        let r = 0.5f64.sqrt();
        let control = [[1., 0.], [1., 1.], [0., 1.], [-1., 1.], [-1., 0.]];
        let control = control.map(|[x, y]| DVec3::new(x, y, 0.0));
        let knots = [0., 0., 0., 1., 1., 2., 2., 2.];
        let weights = [1.0, r, 1.0, r, 1.0];
        let circle = PiecewiseBezier::from_nurbs(&knots, &control, &weights, 2, Dimension::Two);
        let circle = circle.unwrap();
        for k in 0..=100 {
            assert!((circle.position(0.02 * f64::from(k)).length() - 1.0).abs() < 1e-15);
        }
        let bad = |weights: &[f64]| {
            let curve = PiecewiseBezier::from_nurbs(&knots, &control, weights, 2, Dimension::Two);
            curve.unwrap_err().to_string()
        };
        assert!(bad(&[1.0, r, -1.0, r, 1.0]).contains("weights[2]"));
        assert!(bad(&[1.0, r]).contains("weights must have length 5"));
    }

    #[test]
    fn power_basis_and_parts() {
        // x = u², y = u³ − u, on two pieces.
        let piece = |s: f64| {
            [
                DVec3::new(0.0, 1.0, 0.0),
                DVec3::new(1.0, 3.0 * s, 0.0),
                DVec3::new(2.0 * s, 3.0 * s * s - 1.0, 1.0),
                DVec3::new(s * s, s * s * s - s, s),
            ]
        };
        let coefficients: Vec<DVec3> = [piece(-1.0), piece(0.5)].concat();
        let breaks = vec![-1.0, 0.5, 3.0];
        let curve = PiecewiseBezier::from_power(breaks, &coefficients, 3, Dimension::Three);
        let curve = curve.unwrap();
        let expected = |u: f64| DVec3::new(u * u, u * u * u - u, u);
        for k in 0..=80 {
            let u = -1.0 + 0.05 * f64::from(k);
            assert!((curve.position(u) - expected(u)).length() < 1e-12);
        }
        let origin = DVec3::new(3.0, 2.0, 1.0);
        let parts = curve.between([-0.5, 1.0], origin);
        assert_eq!(parts.len(), 2);
        assert_eq!([parts[0].local, parts[1].local], [[0.0, 2.0 / 3.0], [2.0 / 3.0, 1.0]]);
        let end = |part: &crate::BezierPart, i: usize| part.control[i].truncate() + origin;
        assert!((end(&parts[0], 0) - expected(-0.5)).length() < 1e-14);
        assert!((end(&parts[1], 3) - expected(1.0)).length() < 1e-14);
        // Breaks at the ends, one of them off by rounding, cut nothing.
        assert_eq!(curve.between([0.5, 3.0 - 1e-13], origin).len(), 1);
        assert_eq!(curve.between([-1.0, 0.5 + 1e-13], origin).len(), 1);
    }
}
