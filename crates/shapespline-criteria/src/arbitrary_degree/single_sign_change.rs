// SPDX-License-Identifier: MIT OR Apache-2.0

//! Inflection along every mixture of the two binormal vectors, for `ω` of any degree.
//!
//! Let `v = (x, y) = (ω·P, −ω·P')`: it begins in the open first quadrant and ends in the open third.
//! The mixtures `λP − μP'`, `λ, μ ≥ 0`, see `λx + μy`, and each is to change sign exactly once: no
//! mixture may go from − to +. That is so if around every parameter one of these holds:
//!
//! - `v` lies in the open first, or in the open third quadrant (no mixture changes sign);
//! - `x' < 0` and `y' < 0` (every mixture falls);
//! - `x y' − x' y > 0` and `y > x` (`v` turns counter-clockwise through the second quadrant: every
//!   mixture that vanishes does so falling); or mirrored, through the fourth.
//!
//! The three are open conditions on Bernstein coefficients, so subdivision ends wherever they hold.
//! A place that refutes them is one where `v` turns back, or a pair of places `s < t` with a mixture
//! negative at `s` and positive at `t`. Cubics need none of this: there `λx + μy` is quadratic, and
//! the signs at the ends leave room for one change only (Theorems 13.6–13.9).

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use shapespline_polynomial::{Polynomial, Sign};

use super::{Segment, corners, question::clear};

/// Subdivision ends at intervals of this part of a piece.
const DEPTH: u32 = 44;

/// Intervals that are looked at in a segment. Where one of `x, y` is lost in rounding and the other is
/// not, no condition holds anywhere, and halving would go on everywhere; a clear case takes some
/// hundred.
const INTERVALS: usize = 1 << 12;

/// Whether every mixture changes sign exactly once on the segments' way.
pub(crate) fn has_single_sign_change(segment: &Segment, normals: [DVec3; 2]) -> Sign {
    let mut walk = Walk { past: Past::default(), known: Sign::Positive, left: INTERVALS };
    let [p, q] = normals;
    let bends: Vec<(f64, DVec3, f64)> = corners(segment).collect();
    let last = segment.pieces.len();
    for (k, piece) in segment.pieces.iter().enumerate() {
        let omega = piece.omega();
        let (x, y) = (omega.map(1.0, |w| w.dot(p)), omega.map(1.0, |w| -w.dot(q)));
        let [from, to] = piece.local;
        // The ends first: they are exact values, and most violations show there.
        let clear = |x: &Polynomial<f64>, end: usize, sign: f64| {
            clear(sign * x.ends()[end], x.error(), [from, to][end])
        };
        if k == 0 {
            walk.note(clear(&x, 0, 1.0).and(clear(&y, 0, 1.0)));
        }
        let turn = x
            .product(&y.derivative(), |x, y| x * y)
            .plus(&x.derivative().product(&y, |x, y| x * y), -1.0);
        walk.piece(&Arc { x: x.clone(), y: y.clone(), turn, from, to }, DEPTH);
        if let Some(&(at, bend, error)) = bends.get(k) {
            walk.point(bend.dot(p), -bend.dot(q), error, at);
        }
        if k + 1 == last {
            walk.note(clear(&x, 1, -1.0).and(clear(&y, 1, -1.0)));
        }
    }
    walk.known
}

/// `v` on an interval.
struct Arc {
    x: Polynomial<f64>,
    y: Polynomial<f64>,
    /// `x y' − x' y`.
    turn: Polynomial<f64>,
    from: f64,
    to: f64,
}

impl Arc {
    /// Whether one of the three conditions holds on the interval.
    fn is_clear(&self) -> bool {
        let (x, y, turn) = (&self.x, &self.y, &self.turn);
        let negative = |p: &Polynomial<f64>| p.coefficients().iter().all(|&c| c < -p.error());
        if x.is_clearly_positive() && y.is_clearly_positive() || negative(x) && negative(y) {
            return true;
        }
        let falls = |p: &Polynomial<f64>| {
            p.coefficients().windows(2).all(|w| w[0] - w[1] > 2.0 * p.error())
        };
        if falls(x) && falls(y) {
            return true;
        }
        let above = y.plus(x, -1.0);
        turn.is_clearly_positive() && above.is_clearly_positive()
            || negative(turn) && negative(&above)
    }

    fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        let ([x0, x1], [y0, y1], [t0, t1]) = (self.x.halves(), self.y.halves(), self.turn.halves());
        [
            Self { x: x0, y: y0, turn: t0, from: self.from, to: middle },
            Self { x: x1, y: y1, turn: t1, from: middle, to: self.to },
        ]
    }
}

/// Which mixtures, as angles in `[0, π/2]`, have been negative: those below `low` and above `high`.
struct Past {
    low: f64,
    high: f64,
}

impl Default for Past {
    fn default() -> Self {
        Self { low: 0.0, high: FRAC_PI_2 }
    }
}

impl Past {
    /// Takes in a value of `v`; false if a mixture that has been negative is positive there.
    fn take(&mut self, x: f64, y: f64, error: f64) -> bool {
        let slack = 4.0 * error / x.hypot(y);
        let any = self.low > slack || self.high < FRAC_PI_2 - slack;
        match (x > error, x < -error, y > error, y < -error) {
            (true, _, true, _) => !any,
            (_, true, _, true) => {
                (self.low, self.high) = (FRAC_PI_2, 0.0);
                true
            }
            (_, true, true, _) => {
                // Negative below the angle, positive above.
                let angle = (-x).atan2(y);
                let holds = self.low <= angle + slack && self.high >= FRAC_PI_2 - slack;
                self.low = self.low.max(angle - slack);
                holds
            }
            (true, _, _, true) => {
                let angle = x.atan2(-y);
                let holds = self.low <= slack && self.high >= angle - slack;
                self.high = self.high.min(angle + slack);
                holds
            }
            _ => true,
        }
    }
}

struct Walk {
    past: Past,
    known: Sign,
    /// Intervals that may still be looked at.
    left: usize,
}

impl Walk {
    fn note(&mut self, sign: Sign) {
        self.known = self.known.and(sign);
    }

    fn failed(&self) -> bool {
        matches!(self.known, Sign::Fails { .. })
    }

    fn point(&mut self, x: f64, y: f64, error: f64, at: f64) {
        if !self.past.take(x, y, error) {
            self.note(Sign::Fails { at });
        }
    }

    fn piece(&mut self, arc: &Arc, depth: u32) {
        self.end(arc, 0);
        self.inside(arc, depth);
        self.end(arc, 1);
    }

    fn inside(&mut self, arc: &Arc, depth: u32) {
        if self.failed() || arc.is_clear() {
            return;
        }
        let lost = arc.x.bound() <= arc.x.error() && arc.y.bound() <= arc.y.error();
        if depth == 0 || lost || self.left == 0 {
            self.note(Sign::Undecided { from: arc.from, to: arc.to });
            return;
        }
        self.left -= 1;
        let [left, right] = arc.halves();
        self.inside(&left, depth - 1);
        self.end(&left, 1);
        self.inside(&right, depth - 1);
    }

    /// An end of an interval: a value of `v`, and whether it turns back there.
    fn end(&mut self, arc: &Arc, end: usize) {
        let (x, y, turn) = (arc.x.ends()[end], arc.y.ends()[end], arc.turn.ends()[end]);
        let (error, at) = (arc.x.error().max(arc.y.error()), [arc.from, arc.to][end]);
        self.point(x, y, error, at);
        let second = x < -error && y > error && turn < -arc.turn.error();
        let fourth = x > error && y < -error && turn > arc.turn.error();
        if second || fourth {
            self.note(Sign::Fails { at });
        }
    }
}
