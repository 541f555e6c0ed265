// SPDX-License-Identifier: MIT OR Apache-2.0

//! The functions as B-splines, with as few knots as their smoothness allows.
//!
//! A coefficient is the blossom of a piece at the knots inside its support. At arguments τ … τ, a, b about one knot τ it
//! is `f + f'(α + β)/n + f''αβ/(n(n−1))` with α = a − τ, β = b − τ; at arguments from the two ends of one piece alone it
//! is one of the piece's own Bernstein coefficients.

use crate::piecewise::PiecewisePolynomial;
use crate::spline::{MonotoneKind, MonotoneSpline};

/// What second derivatives at a knot may differ by and count as one, relative to the largest of the two pieces.
const ALIKE: f64 = 1e-9;

/// Knots and coefficients of a B-spline.
#[derive(Debug, Clone, PartialEq)]
pub struct BSpline {
    /// Every knot as often as it counts.
    pub knots: Vec<f64>,
    /// `knots.len() − degree − 1` coefficients.
    pub coefficients: Vec<f64>,
    /// The degree of the pieces.
    pub degree: usize,
}

impl MonotoneSpline {
    /// The same function as a B-spline: of the cubic with simple knots (double ones where its second derivative jumps), of
    /// the quartic and the quintic with triple knots. O(N).
    #[must_use]
    pub fn to_bspline(&self) -> BSpline {
        let degree = self.degree();
        let last = self.x.len() - 1;
        let multiplicity = |i: usize| match &self.kind {
            _ if i == 0 || i == last => degree + 1,
            MonotoneKind::Cubic { z } => {
                let (before, after) = (z[i - 1], z[i]);
                let size = before.iter().chain(&after).fold(0.0f64, |size, z| size.max(z.abs()));
                1 + usize::from((before[1] - after[0]).abs() > ALIKE * size)
            }
            MonotoneKind::Quartic { .. } | MonotoneKind::Quintic { .. } => 3,
        };
        // The knots by their numbers.
        let numbers: Vec<usize> =
            (0..=last).flat_map(|i| std::iter::repeat_n(i, multiplicity(i))).collect();
        let coefficient = |w: &[usize]| {
            let inside = &w[1..w.len() - 1];
            let (first, end) = (inside[0], inside[inside.len() - 1]);
            let middle = inside[inside.len() / 2];
            if end - first <= 1 && degree > 3 {
                let piece = self.piece(first.min(last - 1));
                let on_right = inside.iter().filter(|i| **i > first.min(last - 1)).count();
                return piece[on_right];
            }
            self.blossom(middle, [first, end])
        };
        let coefficients = numbers.windows(degree + 2).map(coefficient).collect();
        let knots = numbers.iter().map(|i| self.x[*i]).collect();
        BSpline { knots, coefficients, degree }
    }

    /// The blossom about a knot with two other knots, which are its neighbours or itself.
    fn blossom(&self, knot: usize, others: [usize; 2]) -> f64 {
        let n = self.degree() as f64;
        let to_x = self.units.spacing();
        let [a, b] = others.map(|i| to_x.scale(self.x[i] - self.x[knot]));
        let second = match &self.kind {
            MonotoneKind::Cubic { z } => z.get(knot).map_or(0.0, |z| z[0]),
            MonotoneKind::Quintic { s } => s[knot],
            MonotoneKind::Quartic { .. } => 0.0,
        };
        let change = self.d[knot] * ((a + b) / n) + second * (a * b / (n * (n - 1.0)));
        self.y[knot] + self.units.y().scale(change)
    }
}

impl PiecewisePolynomial {
    /// The same function as a B-spline whose inner knots count as often as its degree, once more where it jumps. O(N).
    #[must_use]
    pub fn to_bspline(&self) -> BSpline {
        let (degree, x) = (self.degree(), self.x());
        let pieces: Vec<&[f64]> = self.coefficients().chunks_exact(degree + 1).collect();
        let mut knots = vec![x[0]; degree + 1];
        let mut coefficients = pieces[0].to_vec();
        for (i, pair) in pieces.windows(2).enumerate() {
            let (before, after) = (pair[0][degree], pair[1][0]);
            let size = pair[0].iter().chain(pair[1]).fold(0.0f64, |size, c| size.max(c.abs()));
            let jumps = degree == 0 || (before - after).abs() > ALIKE * size;
            knots.extend(std::iter::repeat_n(x[i + 1], degree + usize::from(jumps)));
            coefficients.extend_from_slice(&pair[1][usize::from(!jumps)..]);
        }
        knots.extend(std::iter::repeat_n(x[x.len() - 1], degree + 1));
        BSpline { knots, coefficients, degree }
    }
}
