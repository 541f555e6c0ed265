// SPDX-License-Identifier: MIT OR Apache-2.0

//! What one Bézier piece contributes: exact extrema of its curvature, and its integrals.

use glam::{DVec3, DVec4};
use shapespline_polynomial::{Polynomial, bernstein::horner};

use crate::{fairness::extrema::Extrema, quadrature::integrate};

/// Accuracy of the integrals, relative to the contribution of a part between extrema.
const ACCURACY: f64 = 1e-11;

/// Position and derivatives of one Bézier piece in its local parameter `t ∈ [0, 1]`.
///
/// With `γ = p/w` and `V = w p' − w' p` (for polynomial curves `V = γ'`):
/// `γ' = V/w²`, `γ'×γ'' = V×V'/w⁴`, so that curvature is `‖V×V'‖ w²/‖V‖³`.
#[derive(Debug)]
pub(crate) struct Piece {
    /// Homogeneous control points and their three derivatives.
    derivatives: [Polynomial<DVec4>; 4],
    velocity: Polynomial<DVec3>,
    turn: Polynomial<DVec3>,
    weight: Option<Polynomial<f64>>,
    planar: bool,
    /// What the control points were rounded by before they were moved to the origin.
    rounding: f64,
}

/// Curvature at an end of a piece.
#[derive(Debug, Clone, Copy)]
pub(crate) struct End {
    /// Unit tangent.
    pub(crate) direction: DVec3,
    /// Curvature times the principal normal.
    pub(crate) curvature: DVec3,
    /// Bound of what rounding did to the curvature.
    pub(crate) error: f64,
}

impl Piece {
    /// A piece in homogeneous coordinates near one.
    pub(crate) fn new(control: Vec<DVec4>, rational: bool, planar: bool) -> Self {
        // Each control point carries the rounding of its coordinates.
        let size = control.iter().fold(0.0, |m: f64, p| m.max(p.truncate().length()));
        let points = Polynomial::new(control, f64::EPSILON * size);
        let first = points.derivative();
        let second = first.derivative();
        let third = second.derivative();
        let weight = rational.then(|| points.map(1.0, |p| p.w));
        let velocity = match &weight {
            None => first.map(1.0, DVec4::truncate),
            Some(weight) => {
                let place = points.map(1.0, DVec4::truncate);
                let one = place.derivative().product(weight, |p, w| p * w);
                one.plus(&place.product(&weight.derivative(), |p, w| p * w), -1.0)
            }
        };
        let turn = velocity.product(&velocity.derivative(), DVec3::cross);
        let derivatives = [points, first, second, third];
        Self { derivatives, velocity, turn, weight, planar, rounding: 0.0 }
    }

    /// The same of control points that lay at a distance from the origin.
    pub(crate) fn moved(self, distance: f64) -> Self {
        Self { rounding: f64::EPSILON * distance, ..self }
    }

    /// `‖V‖²`.
    fn speed_squared(&self) -> Polynomial<f64> {
        self.velocity.product(&self.velocity, DVec3::dot)
    }

    /// Whether `V×V'` is zero, to the rounding of its own and of the control points as they were given.
    fn is_straight(&self) -> bool {
        let (first, n) = (self.velocity.derivative(), self.derivatives[0].degree() as f64);
        let off = 2.0 * n * self.rounding * (first.bound() + 2.0 * n * self.velocity.bound());
        self.turn.bound() <= self.turn.error() + off
    }

    /// A parameter at which the speed is zero to rounding, if there is one.
    pub(crate) fn cusp(&self) -> Option<f64> {
        self.speed_squared().sign().place()
    }

    /// Where curvature turns from rising to falling or back.
    pub(crate) fn extrema(&self) -> Extrema {
        if self.is_straight() {
            return Extrema::default();
        }
        Extrema::of(self.velocity.clone(), self.weight.clone(), self.planar)
    }

    /// Derivatives of order 1 to 3 with respect to `t`.
    fn at(&self, t: f64) -> [DVec3; 3] {
        let [p, p1, p2, p3] = [0, 1, 2, 3].map(|k| horner(self.derivatives[k].coefficients(), t));
        if self.weight.is_none() {
            return [p1, p2, p3].map(DVec4::truncate);
        }
        let place = p.truncate() / p.w;
        let d1 = (p1.truncate() - place * p1.w) / p.w;
        let d2 = (p2.truncate() - d1 * (2.0 * p1.w) - place * p2.w) / p.w;
        let d3 = (p3.truncate() - d2 * (3.0 * p1.w) - d1 * (3.0 * p2.w) - place * p3.w) / p.w;
        [d1, d2, d3]
    }

    /// Curvature at `t`, of a planar curve with its sign.
    pub(crate) fn curvature(&self, t: f64) -> f64 {
        let [d1, d2, _] = self.at(t);
        let turn = d1.cross(d2);
        (if self.planar { turn.z } else { turn.length() }) / d1.length().powi(3)
    }

    /// Direction and curvature at an end.
    pub(crate) fn end(&self, t: f64) -> End {
        let [d1, d2, _] = self.at(t);
        let speed = d1.length_squared();
        let curvature = d1.cross(d2).cross(d1) / (speed * speed);
        let n = self.derivatives[0].degree() as f64;
        let moved = 2.0 * n * self.rounding;
        let [first, second] =
            [self.derivatives[1].error() + moved, self.derivatives[2].error() + 2.0 * n * moved];
        let error = second + first * d2.length() / speed.sqrt();
        End { direction: d1.normalize_or_zero(), curvature, error: 4.0 * error / speed }
    }

    /// Length, `∫κ²ds` and `∫(κ'² + κ²τ²)ds` between neighbouring parameters of `cuts`.
    pub(crate) fn integrals(&self, cuts: &[f64]) -> [f64; 3] {
        let over = |negligible: f64, f: &dyn Fn(f64) -> f64| -> f64 {
            let parts = cuts.windows(2).map(|cut| [cut[0], cut[1]]);
            parts.map(|part| integrate(&f, part, ACCURACY, negligible)).sum()
        };
        let length = over(0.0, &|t| self.at(t)[0].length());
        // Of a piece that is straight to rounding nothing else is known, and rounding integrates slowly.
        if self.is_straight() {
            return [length, 0.0, 0.0];
        }
        // ∫κ² ds of a piece that turns by 3e-7 rad is not worth eleven digits.
        let straight = 1e-2 * ACCURACY / length;
        let bending = over(straight, &|t| {
            let [d1, d2, _] = self.at(t);
            d1.cross(d2).length_squared() / d1.length().powi(5)
        });
        // The same of curvature that is constant: (∫κ² ds)²/L is of the unit of the variation.
        let negligible = ACCURACY * (bending + straight).powi(2) / length;
        let variation = over(negligible, &|t| {
            // Across the tangent, dK/ds = (γ''' − 3 (γ'·γ'')/‖γ'‖² γ'')/‖γ'‖³.
            let [d1, d2, d3] = self.at(t);
            let speed = d1.length_squared();
            let change = d3 - d2 * (3.0 * d1.dot(d2) / speed);
            d1.cross(change).length_squared() / speed.powi(3) / speed.sqrt()
        });
        [length, bending, variation]
    }
}
