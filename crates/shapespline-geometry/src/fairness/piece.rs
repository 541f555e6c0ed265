// SPDX-License-Identifier: MIT OR Apache-2.0

//! What one Bézier piece contributes: exact extrema of its curvature, and its integrals.

use glam::{DVec3, DVec4};

use crate::{
    polynomial::{Coefficient, Polynomial, Sign},
    quadrature::integrate,
};

/// Accuracy of the integrals, relative to the contribution of a part between extrema.
const ACCURACY: f64 = 1e-11;

/// Deepest subdivision in the search for extrema of curvature.
const DEPTH: u32 = 40;

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

/// The turning points of curvature inside a piece.
#[derive(Debug, Default)]
pub(crate) struct Extrema {
    /// Where curvature (in the plane: signed curvature) stops to rise or to fall.
    pub(crate) at: Vec<f64>,
    /// Whether it rises, before the first, between, and after the last of them. Empty where rounding
    /// hides whether it changes at all.
    pub(crate) rising: Vec<bool>,
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
        match self.speed_squared().sign() {
            Sign::Positive => None,
            Sign::Fails { at } => Some(at),
            Sign::Undecided { from, to } => Some(0.5 * (from + to)),
        }
    }

    /// Where curvature turns from rising to falling or back: sign changes of a polynomial, isolated by
    /// Bernstein subdivision. In space that of `d(κ²)/dt`, in the plane that of the signed curvature.
    pub(crate) fn extrema(&self) -> Extrema {
        if self.is_straight() {
            return Extrema::default();
        }
        // κ = f w²/S^{3/2} with f = (V×V')_z, or κ² = f w⁴/S³ with f = ‖V×V'‖²; c is 1 or 2.
        let (f, c) = if self.planar {
            (self.turn.map(1.0, |v| v.z), 1.0)
        } else {
            (self.turn.product(&self.turn, DVec3::dot), 2.0)
        };
        let multiply = |p: f64, q: f64| p * q;
        let speed = self.speed_squared();
        let (rise, slope) = (f.derivative(), speed.derivative());
        let growth = match &self.weight {
            // f' S − (3c/2) f S'
            None => rise.product(&speed, multiply).plus(&f.product(&slope, multiply), -1.5 * c),
            // (f' w + 2c f w') S − (3c/2) f w S'
            Some(weight) => {
                let fw = f.product(weight, multiply);
                let change = rise
                    .product(weight, multiply)
                    .plus(&f.product(&weight.derivative(), multiply), 2.0 * c);
                change.product(&speed, multiply).plus(&fw.product(&slope, multiply), -1.5 * c)
            }
        };
        let mut found = Extrema::default();
        sign_changes(&growth, [0.0, 1.0], DEPTH, &mut found);
        found
    }

    /// Derivatives of order 1 to 3 with respect to `t`.
    fn at(&self, t: f64) -> [DVec3; 3] {
        let [p, p1, p2, p3] = [0, 1, 2, 3].map(|k| value(self.derivatives[k].coefficients(), t));
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

/// Appends the sign changes of a polynomial on a part of its interval, each located to rounding.
fn sign_changes(p: &Polynomial<f64>, [from, to]: [f64; 2], depth: u32, found: &mut Extrema) {
    let error = p.error();
    let clear = || p.coefficients().iter().filter(|c| c.abs() > error).map(|&c| c > 0.0);
    let changes = clear().zip(clear().skip(1)).filter(|(a, b)| a != b).count();
    let [first, last] = p.ends();
    let certain = first.abs() > error && last.abs() > error;
    let middle = 0.5 * (from + to);
    match changes {
        0 => {
            if let Some(sign) = clear().next() {
                found.push(from, sign);
            }
        }
        1 if certain => {
            found.push(from, first > 0.0);
            found.push(from + (to - from) * root(p), last > 0.0);
        }
        _ if depth == 0 => {
            for value in [first, last].into_iter().filter(|value| value.abs() > error) {
                found.push(middle, value > 0.0);
            }
        }
        _ => {
            let [left, right] = p.halves();
            sign_changes(&left, [from, middle], depth - 1, found);
            sign_changes(&right, [middle, to], depth - 1, found);
        }
    }
}

impl Extrema {
    /// From `at` on curvature rises, or falls.
    fn push(&mut self, at: f64, rising: bool) {
        if self.rising.last() == Some(&rising) {
            return;
        }
        if !self.rising.is_empty() {
            self.at.push(at);
        }
        self.rising.push(rising);
    }
}

/// The root of a polynomial with opposite signs at the ends and one sign change of its coefficients,
/// by bisection.
fn root(p: &Polynomial<f64>) -> f64 {
    let rising = p.ends()[1] > 0.0;
    let [mut from, mut to] = [0.0, 1.0];
    loop {
        let middle = 0.5 * (from + to);
        if !(from < middle && middle < to) || to - from < 1e-15 {
            return middle;
        }
        if (value(p.coefficients(), middle) > 0.0) == rising { to = middle } else { from = middle }
    }
}

/// The value of a polynomial in Bernstein form at `t ∈ [0, 1]`, by Horner's rule in `t` with the powers
/// of `1 − t` taken along: no memory and O(degree), where de Casteljau's algorithm takes its square.
fn value<T: Coefficient>(coefficients: &[T], t: f64) -> T {
    let n = coefficients.len() - 1;
    let (s, mut weight) = (1.0 - t, 1.0);
    let mut sum = coefficients[0];
    for (k, &c) in coefficients.iter().enumerate().skip(1) {
        weight *= t * (n + 1 - k) as f64 / k as f64;
        sum = sum * s + c * weight;
    }
    sum
}
