// SPDX-License-Identifier: MIT OR Apache-2.0

//! A continuous second derivative beside turns and flats.
//!
//! At a node of slope 0 the second derivative is prescribed: 0 beside a flat, at a turn the smaller of the two that the
//! least energy has there. It moves from there to that of the interval within a layer, a share θ of the interval, and is
//! linear on both sides of the knot between. The energy is at most `(1−θ)⁻²` times the least.

use super::piece::Piece;

/// The layer beside one end of an interval.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layer {
    /// θ, its share of the interval.
    pub(crate) share: f64,
    /// The size of the second derivative at the node.
    pub(crate) second: f64,
}

/// `h²` times the second derivative at the knot and at the far end, away from the node of slope 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seconds {
    pub(crate) knot: f64,
    pub(crate) far: f64,
}

impl Layer {
    /// With the slope `m` at the far end.
    pub(crate) fn seconds(self, m: f64, d: f64, h: f64) -> Seconds {
        let (theta, m, s) = (self.share, m * h, self.second * h * h);
        let knot = 6.0 * d - 2.0 * m * (1.0 - theta) - 2.0 * s * theta;
        let far = (4.0 * m - 2.0 * m * theta - 6.0 * d + s * theta) / (1.0 - theta);
        Seconds { knot, far }
    }

    /// Whether the interval needs no layer: its least energy has a level part beside the node.
    pub(crate) fn is_level(self, m: f64, d: f64, h: f64) -> bool {
        self.second == 0.0 && self.seconds(m, d, h).knot < 0.0
    }

    /// Whether the slope falls below 0 between the layer and the far end, which only a smaller second derivative at the
    /// node helps.
    pub(crate) fn dips(self, m: f64, d: f64, h: f64) -> bool {
        let Seconds { knot, far } = self.seconds(m, d, h);
        if !(self.second > 0.0 && knot < 0.0 && far > knot) {
            return false;
        }
        let s = self.second * h * h;
        0.5 * self.share * (s + knot) < (1.0 - self.share) * knot * (knot / (2.0 * (far - knot)))
    }

    /// The potential whose derivative is twice the second derivative at the far end, so that a least sum has a
    /// continuous one; `right` where the node of slope 0 is the interval's right end. Convex, as the energy that it
    /// takes the place of, and joined to it where the level part begins.
    pub(crate) fn piece(self, right: bool, m: [f64; 2], d: f64, h: f64) -> Piece {
        let far = m[usize::from(!right)];
        if self.is_level(far, d, h) {
            return Piece::new(m, d, h);
        }
        let rest = 1.0 - self.share;
        let gradient = |m: f64| 2.0 * self.seconds(m, d, h).far / (h * h);
        let joined = (12.0 - 18.0 * self.share) * (d / h) * (d / h) / (rest * rest * rest * h);
        let energy = joined + 0.5 * far * (gradient(0.0) + gradient(far));
        let second = 2.0 * (4.0 - 2.0 * self.share) / (rest * h);
        let (gradient, hessian) = if right {
            ([gradient(far), 0.0], [second, 0.0, 0.0])
        } else {
            ([0.0, gradient(far)], [0.0, 0.0, second])
        };
        Piece { energy, gradient, hessian, ..Piece::default() }
    }
}

/// `h²` times the second derivatives at the knots θ and 1 − θ of an interval whose ends both have slope 0, and there
/// second derivatives of these sizes (the right one with the other sign).
pub(crate) fn between(share: f64, second: [f64; 2], d: f64, h: f64) -> [f64; 2] {
    let [s0, s1] = second.map(|s| s * h * h);
    let product = share * (1.0 - share);
    let at = |own: f64, other: f64| {
        (6.0 * d - 2.0 * own * share + own * share * share - other * product) / (1.0 - share)
    };
    [at(s0, s1), -at(s1, s0)]
}
