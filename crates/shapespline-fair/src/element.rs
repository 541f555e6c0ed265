// SPDX-License-Identifier: MIT OR Apache-2.0

//! The element: one segment as a C² cubic B-spline with two extra knots.
//!
//! Between nodes with first derivatives `q0, q1` and second derivatives `r0, r1` the segment is a cubic
//! B-spline on the knots `0, 0, 0, 0, τ, t, 1, 1, 1, 1` (times the spacing `h`), `τ = 1/4`, `t = 1 − τ`. Its
//! hodograph is a quadratic B-spline whose control vectors, the *scaled legs*
//!
//! ```text
//! d0 = q0   d1 = q0 + τ h r0/2   d2 = 3L/h − τ (d0 + d4) − t (d1 + d3)   d3 = q1 − τ h r1/2   d4 = q1
//! ```
//!
//! are `3 Δ_j` over `τ h, t h, h, t h, τ h`, where `Δ_j` are the legs of the six control points; `d2`
//! makes the legs add up to the chord `L`. Energy and criteria are polynomials in them: with
//! `a = τ/t`, the hodograph has the control vectors `d0, d1, (1−a) d1 + a d2 | d2 | a d2 + (1−a) d3, d3,
//! d4` on the three pieces, and `ω = Q'×Q''` the Bernstein coefficients of [`OMEGA`]. All of this is
//! derived here, by blossoming.
//!
//! Inside the element legs are divided by the speed `‖L‖/h`, so that they are near one in size.

use glam::DVec3;

/// Where the extra knots divide a segment: at `τ` and `1 − τ`.
pub(crate) const TAU: f64 = 0.25;
/// `1 − τ`.
pub(crate) const T: f64 = 1.0 - TAU;
/// `τ/t`: the share of `d2` in the hodograph at the extra knots.
pub(crate) const A: f64 = TAU / T;

/// First and second derivative at a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Node {
    pub(crate) q: DVec3,
    pub(crate) r: DVec3,
}

impl Node {
    pub(crate) fn plus(self, step: Self) -> Self {
        Self { q: self.q + step.q, r: self.r + step.r }
    }
}

/// The scaled legs of a segment, over its speed.
pub(crate) type Legs = [DVec3; 5];

/// Spacing and chord of a segment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    /// `L / ‖L‖`.
    pub(crate) direction: DVec3,
    /// `‖L‖`.
    pub(crate) length: f64,
    /// `h`.
    pub(crate) spacing: f64,
}

impl Span {
    /// `‖L‖/h`.
    pub(crate) fn speed(&self) -> f64 {
        self.length / self.spacing
    }

    /// The legs between two nodes.
    pub(crate) fn legs(&self, start: Node, end: Node) -> Legs {
        let mut legs = self.step(start, end);
        legs[2] += self.direction * 3.0;
        legs
    }

    /// The change of the legs with a change of the nodes.
    pub(crate) fn step(&self, start: Node, end: Node) -> Legs {
        let unit = self.spacing / self.length;
        let arm = 0.5 * TAU * self.spacing;
        let d0 = start.q * unit;
        let d1 = (start.q + start.r * arm) * unit;
        let d3 = (end.q - end.r * arm) * unit;
        let d4 = end.q * unit;
        [d0, d1, (d0 + d4) * -TAU - (d1 + d3) * T, d3, d4]
    }

    /// The five legs of the control polygon, `Δ_j`, in the units of the chord.
    pub(crate) fn control_legs(&self, legs: &Legs) -> Legs {
        let third = self.length / 3.0;
        let [d0, d1, d2, d3, d4] = *legs;
        [d0 * (TAU * third), d1 * (T * third), d2 * third, d3 * (T * third), d4 * (TAU * third)]
    }

    /// The gradient with respect to `q0, r0, q1, r1` that belongs to one with respect to the legs.
    pub(crate) fn pull_back(&self, g: &Legs) -> [DVec3; 4] {
        let unit = self.spacing / self.length;
        let arm = 0.5 * TAU * self.spacing * unit;
        [
            (g[0] + g[1] - g[2]) * unit,
            (g[1] - g[2] * T) * arm,
            (g[3] + g[4] - g[2]) * unit,
            (g[2] * T - g[3]) * arm,
        ]
    }
}

/// Pairs of legs `(i, j)` whose products `d_i × d_j` occur in `ω` and in torsion.
pub(crate) const PAIRS: [(usize, usize); 7] =
    [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3), (2, 4), (3, 4)];

/// Bernstein coefficients of `h ω` on a piece `p`: factors of the products `2p, 2p+1, 2p+2` of
/// [`PAIRS`], which are those of the legs `p, p+1, p+2`.
pub(crate) const OMEGA: [[[f64; 3]; 3]; 3] = [
    [[2.0 / TAU, 0.0, 0.0], [(1.0 - A) / TAU, A / TAU, 0.0], [0.0, 0.0, 2.0 / T]],
    [[2.0 / T, 0.0, 0.0], [A / T, (1.0 - A) / T, A / T], [0.0, 0.0, 2.0 / T]],
    [[2.0 / T, 0.0, 0.0], [0.0, A / TAU, (1.0 - A) / TAU], [0.0, 0.0, 2.0 / TAU]],
];

/// Bernstein coefficients of the hodograph on a piece `p`: factors of the legs `p, p+1, p+2`.
pub(crate) const HODOGRAPH: [[[f64; 3]; 3]; 3] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0 - A, A]],
    [[1.0 - A, A, 0.0], [0.0, 1.0, 0.0], [0.0, A, 1.0 - A]],
    [[A, 1.0 - A, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
];

/// The products of [`PAIRS`].
pub(crate) fn products(d: &Legs) -> [DVec3; 7] {
    PAIRS.map(|(i, j)| d[i].cross(d[j]))
}

/// The cubic pieces that belong to the legs of a control polygon: end legs of each piece, the first
/// extra knot's point seen from the start, and the second one's seen from the end.
pub(crate) fn pieces(delta: &Legs) -> ([[DVec3; 2]; 3], [DVec3; 2]) {
    let [l0, l1, l2, l3, l4] = *delta;
    // Hodograph at the extra knots, times a third of the outer pieces' duration.
    let first = l1 * (TAU * (1.0 - A) / T) + l2 * (TAU * A);
    let last = l3 * (TAU * (1.0 - A) / T) + l2 * (TAU * A);
    let inner = (1.0 - 2.0 * TAU) / TAU;
    let end_legs = [[l0, first], [first * inner, last * inner], [last, l4]];
    // The middle leg of an outer piece is a share of the control polygon's.
    (end_legs, [l0 + l1 * A + first, -(last + l3 * A + l4)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight segment run through at its own speed: control points 0, τ/3, 1/3, 2/3, 1 − τ/3, 1.
    #[test]
    fn a_straight_segment_has_even_legs_and_no_curvature() {
        let span = Span { direction: DVec3::X, length: 1.0, spacing: 1.0 };
        let node = Node { q: DVec3::X, r: DVec3::ZERO };
        let legs = span.legs(node, node);
        assert!(legs.iter().all(|d| (*d - DVec3::X).length() < 1e-15), "{legs:?}");
        let mut at = 0.0;
        let control = span.control_legs(&legs).map(|leg| {
            at += leg.x;
            at
        });
        let expected = [TAU / 3.0, 1.0 / 3.0, 2.0 / 3.0, 1.0 - TAU / 3.0, 1.0];
        for (c, e) in control.iter().zip(expected) {
            assert!((c - e).abs() < 1e-15);
        }
    }

    /// Pieces meet with two derivatives, and have those of the nodes at their outer ends.
    #[test]
    fn the_pieces_are_twice_differentiable_and_meet_the_nodes() {
        let span = Span { direction: DVec3::new(0.6, 0.0, 0.8), length: 1.7, spacing: 2.3 };
        let vector = |k: f64| DVec3::new((1.3 * k).sin(), (2.1 * k).cos(), (0.7 * k).sin());
        let [start, end] = [1.0, 2.0].map(|k| Node { q: vector(k), r: vector(k + 5.0) });
        let legs = span.legs(start, end);
        let (end_legs, [first, last]) = pieces(&span.control_legs(&legs));
        let chord = span.direction * span.length;
        let points = [DVec3::ZERO, first, chord + last, chord];
        let durations = [TAU, 1.0 - 2.0 * TAU, TAU].map(|share| share * span.spacing);
        let jets: Vec<[[DVec3; 2]; 2]> = (0..3)
            .map(|k| {
                let ([a, c], h) = (end_legs[k], durations[k]);
                let b = points[k + 1] - points[k] - a - c;
                [[a * 3.0 / h, (b - a) * 6.0 / (h * h)], [c * 3.0 / h, (c - b) * 6.0 / (h * h)]]
            })
            .collect();
        let near = |x: [DVec3; 2], y: [DVec3; 2]| {
            (x[0] - y[0]).length() < 1e-13 && (x[1] - y[1]).length() < 1e-12
        };
        assert!(near(jets[0][0], [start.q, start.r]));
        assert!(near(jets[2][1], [end.q, end.r]));
        assert!(near(jets[0][1], jets[1][0]) && near(jets[1][1], jets[2][0]));
        // ω at the nodes, by the table.
        let products = products(&legs);
        let unit = span.speed() * span.speed() / span.spacing;
        let at_start = products[0] * (OMEGA[0][0][0] * unit);
        assert!((at_start - start.q.cross(start.r)).length() < 1e-12);
    }
}
