// SPDX-License-Identifier: MIT OR Apache-2.0

//! Where the curvature of a piece rises and where it falls.
//!
//! Curvature grows where a polynomial is positive: its sign changes are isolated by Bernstein subdivision. The bound
//! on its rounding error belongs to the largest speed on the part that it was formed on. Where a curve nearly stops,
//! and turns within a small part of its parameter, that would hide everything: there the polynomial is formed anew
//! from the velocity on a smaller part, which subdivision keeps accurate.

use glam::DVec3;

use shapespline_polynomial::{Polynomial, bernstein::horner, bracketed_root};

/// Deepest subdivision.
const DEPTH: u32 = 40;

/// The polynomial is formed anew on parts on which the largest speed is smaller by this factor.
const SLOWER: f64 = 0.75;

/// The turning points of curvature inside a piece.
#[derive(Debug, Default)]
pub(crate) struct Extrema {
    /// Where curvature (in the plane: signed curvature) stops to rise or to fall.
    pub(crate) at: Vec<f64>,
    /// Whether it rises, before the first, between, and after the last of them. Empty where rounding
    /// hides whether it changes at all.
    pub(crate) rising: Vec<bool>,
}

impl Extrema {
    /// The turning points of a piece with `V = w p' − w' p`: of `‖V×V'‖ w²/‖V‖³`.
    pub(crate) fn of(
        velocity: Polynomial<DVec3>,
        weight: Option<Polynomial<f64>>,
        planar: bool,
    ) -> Self {
        let mut found = Self::default();
        Part::new(velocity, weight, planar).search([0.0, 1.0], DEPTH, &mut found);
        found
    }

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

/// A part of a piece.
struct Part {
    velocity: Polynomial<DVec3>,
    weight: Option<Polynomial<f64>>,
    planar: bool,
    /// Positive where curvature rises.
    growth: Polynomial<f64>,
    /// The largest speed where `growth` was formed.
    speed: f64,
}

impl Part {
    fn new(velocity: Polynomial<DVec3>, weight: Option<Polynomial<f64>>, planar: bool) -> Self {
        let growth = growth(&velocity, weight.as_ref(), planar);
        let speed = velocity.bound();
        Self { velocity, weight, planar, growth, speed }
    }

    fn halves(&self) -> [Self; 2] {
        let [a, b] = self.velocity.halves();
        let [v, w] = self.weight.as_ref().map_or([None, None], |w| w.halves().map(Some));
        let [g, h] = self.growth.halves();
        [self.half(a, v, g), self.half(b, w, h)]
    }

    fn half(
        &self,
        velocity: Polynomial<DVec3>,
        weight: Option<Polynomial<f64>>,
        growth: Polynomial<f64>,
    ) -> Self {
        let Self { planar, speed, .. } = *self;
        if velocity.bound() < SLOWER * speed {
            Self::new(velocity, weight, planar)
        } else {
            Self { velocity, weight, planar, growth, speed }
        }
    }

    /// Appends the sign changes of the growth, each located to rounding.
    fn search(&self, [from, to]: [f64; 2], depth: u32, found: &mut Extrema) {
        let (error, coefficients) = (self.growth.error(), self.growth.coefficients());
        let clear: Vec<bool> =
            coefficients.iter().filter(|c| c.abs() > error).map(|&c| c > 0.0).collect();
        let changes = clear.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let [first, last] = self.growth.ends();
        let is_one = changes == 1 && first.abs() > error && last.abs() > error;
        let middle = 0.5 * (from + to);
        let is_open = changes > 0 && !is_one;
        if depth > 0 && (is_open || clear.len() < coefficients.len()) {
            let halves = self.halves();
            // What rounding hides may be seen where the curve is slower.
            if is_open || halves.iter().any(|half| half.speed < self.speed) {
                for (half, part) in halves.into_iter().zip([[from, middle], [middle, to]]) {
                    half.search(part, depth - 1, found);
                }
                return;
            }
        }
        match (changes, clear.first()) {
            (0, None) => {}
            (0, Some(&rising)) => found.push(from, rising),
            _ if is_one => {
                found.push(from, first > 0.0);
                found.push(from + (to - from) * root(&self.growth), last > 0.0);
            }
            _ => {
                for value in [first, last].into_iter().filter(|value| value.abs() > error) {
                    found.push(middle, value > 0.0);
                }
            }
        }
    }
}

/// What has the sign of the growth of curvature: in space that of `d(κ²)/dt`, in the plane that of the signed
/// curvature.
fn growth(
    velocity: &Polynomial<DVec3>,
    weight: Option<&Polynomial<f64>>,
    planar: bool,
) -> Polynomial<f64> {
    let turn = velocity.product(&velocity.derivative(), DVec3::cross);
    // κ = f w²/S^{3/2} with f = (V×V')_z, or κ² = f w⁴/S³ with f = ‖V×V'‖²; c is 1 or 2.
    let (f, c) =
        if planar { (turn.map(1.0, |v| v.z), 1.0) } else { (turn.product(&turn, DVec3::dot), 2.0) };
    let multiply = |p: f64, q: f64| p * q;
    let speed = velocity.product(velocity, DVec3::dot);
    let (rise, slope) = (f.derivative(), speed.derivative());
    match weight {
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
    }
}

/// The root of a polynomial with opposite signs at the ends and one sign change of its coefficients.
fn root(p: &Polynomial<f64>) -> f64 {
    let at = |t: f64| (horner(p.coefficients(), t), f64::NAN);
    bracketed_root(at, [0.0, 1.0], p.ends(), f64::NAN, [0.0, 1e-15])
}
