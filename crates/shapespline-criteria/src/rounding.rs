// SPDX-License-Identifier: MIT OR Apache-2.0

//! How far rounding may have moved a number whose sign is asked for.
//!
//! The conditions on a cubic are signs of products of its legs `a, c`, its chord `L` and vectors of the
//! polygon. Three things round: the control points, whose differences the legs are ([`LEG_ERROR`]); the
//! polygon's unit chords; and the arithmetic. The points of the polygon are taken as they are. With `u = 2⁻⁵³`, sums of
//! absolute coordinates `A, C, Λ` of `a, c, L`, and `e` what each of their coordinates may be off by,
//!
//! - a coordinate of `ω(0) = a×L − a×c` is off by `4uA(Λ + C) + e(Λ + C + 2A)` at most, one of `ω(1)`
//!   likewise, one of `a×c` by `3uAC + e(A + C)`;
//! - a coordinate of a binormal vector of unit chords is off by `6u`: differences and quotients round by
//!   `u` each, twice, then the product and the difference (lengths are common factors, and turn nothing);
//! - so `ω·n` is off by what `ω` is times `‖n‖₁`, and `10u‖ω‖₁`;
//! - `det[a, L, c]` is off by `6uAΛC + e(‖a×L‖₁ + ‖a×c‖₁ + ‖L×c‖₁)`.
//!
//! `A, C, Λ` are enlarged by `3e`, which covers the products of several errors. Most signs are clear of
//! [`Coarse`] bounds, which take every leg for as long as all are together.

use glam::DVec3;

use crate::violations::SegmentGeometry;

/// Half the distance from one to the next number.
pub(crate) const UNIT: f64 = 0.5 * f64::EPSILON;

/// The most that a coordinate of a leg or chord is off by, over the largest coordinate of its control points:
/// those are taken to be known to 15 significant digits, so that no verdict changes into its opposite when a
/// curve is written. Half a unit of the 15th digit is at most 5e−15 of a number, at both ends; f64 itself
/// adds `4u`.
pub(crate) const LEG_ERROR: f64 = 1.0e-14 + 4.0 * UNIT;

/// Which way a doubt is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lean {
    /// A condition holds only if rounding cannot have made it hold.
    Against,
    /// A condition holds if it does as computed.
    Even,
    /// A condition fails only if rounding cannot have made it fail.
    For,
}

impl Lean {
    #[inline(always)]
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Against => -1.0,
            Self::Even => 0.0,
            Self::For => 1.0,
        }
    }
}

/// A number, and how far from it the true one may lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Rounded {
    /// Whether it is positive.
    #[inline(always)]
    pub(crate) fn is_positive(self, lean: Lean) -> bool {
        self.toward(lean) > 0.0
    }

    /// The least or the greatest it may be.
    #[inline(always)]
    pub(crate) fn toward(self, lean: Lean) -> f64 {
        self.value + lean.sign() * self.error
    }
}

impl std::ops::Add for Rounded {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }
}

impl std::ops::Neg for Rounded {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

/// The sum of the absolute coordinates.
#[inline(always)]
pub(crate) fn sum(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Whether every product in `u×v` is zero.
fn has_no_products(u: DVec3, v: DVec3) -> bool {
    let [u, v] = [u, v].map(|v| v.to_array().map(|x| x != 0.0));
    !(0..3).any(|i| u[i] && (v[(i + 1) % 3] || v[(i + 2) % 3]))
}

/// Bounds on all signs of a segment at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coarse {
    /// Of `ω·n` for the binormal vectors at the node before, at both nodes, and at the node after.
    pub(crate) turns: [f64; 4],
    /// Of `det[a, L, c]`.
    pub(crate) twist: f64,
}

impl Coarse {
    /// `size`: at least `A + Λ + C`; `slack`: `e`; `binormals`: at least their `‖n‖₁`.
    #[inline(always)]
    pub(crate) fn new(size: f64, slack: f64, binormals: [f64; 4]) -> Self {
        // S² and S³ are at least three and 27 times the products of two and of three; with 9e, the squares
        // of e are covered.
        let size = size + 9.0 * slack;
        let off = size * (4.0 * UNIT * size + 2.0 * slack);
        let square = size * size;
        let own = 16.0 * UNIT * square;
        let [o, p, q, r] = binormals;
        let turns = [off * o + own, off * p + own, off * q + own, off * r + own];
        Self { turns, twist: square * (UNIT * size + slack) }
    }
}

/// The most that a coordinate of a leg or chord is off by, given the largest coordinate of the end points and
/// `A + Λ + C`, which stands twice for further digits that powers of the parameter take.
#[inline(always)]
pub(crate) fn leg_error(far: f64, size: f64) -> f64 {
    LEG_ERROR * (far + 2.0 * size)
}

/// The numbers whose signs convexity, inflection, turning and torsion are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Signs {
    /// `ω·n` as `[α, γ, β]` of Lemma 5.1, for the binormal vectors at both nodes.
    pub(crate) omega: [[Rounded; 3]; 2],
    /// `ω(0)·n` and `ω(1)·n` for those at the nodes before and after.
    pub(crate) beside: [Rounded; 2],
    /// `det[a, b, c]`.
    pub(crate) twist: Rounded,
}

impl Signs {
    /// As far as they are clear of coarse bounds.
    #[inline(always)]
    pub(crate) fn coarse(s: &SegmentGeometry) -> Self {
        let size = sum(s.a) + sum(s.chord) + sum(s.c);
        let binormals = [sum(s.before), sum(s.p), sum(s.q), sum(s.after)];
        let Coarse { turns: [o, p, q, r], twist } = Coarse::new(size, s.slack, binormals);
        let along = |n: DVec3, error: f64| {
            let [alpha, gamma, beta] = s.omega_along(n);
            let of = |value: f64| Rounded { value, error };
            [of(alpha), of(gamma), of(beta)]
        };
        let twist = Rounded { value: s.determinant(), error: twist };
        let beside = [
            Rounded { value: s.omega[0].dot(s.before), error: o },
            Rounded { value: s.omega[2].dot(s.after), error: r },
        ];
        Self { omega: [along(s.p, p), along(s.q, q)], beside, twist }
    }

    /// As exactly as is known.
    pub(crate) fn fine(s: &SegmentGeometry) -> Self {
        let [start, end] = [s.omega_signs(s.before)[0], s.omega_signs(s.after)[2]];
        let omega = [s.omega_signs(s.p), s.omega_signs(s.q)];
        Self { omega, beside: [start, end], twist: s.rounded_determinant() }
    }
}

impl SegmentGeometry {
    /// `A, Λ, C`, enlarged.
    #[inline(always)]
    fn sums(&self) -> [f64; 3] {
        let off = 3.0 * self.slack;
        [sum(self.a) + off, sum(self.chord) + off, sum(self.c) + off]
    }

    /// How far each coordinate of `a×b`, `a×c`, `b×c` may be off: nothing where every product in it is
    /// zero, as of legs along one axis, for coordinates that are equal are rounded alike.
    #[inline(always)]
    pub(crate) fn omega_errors(&self) -> [f64; 3] {
        let ([a, chord, c], e) = (self.sums(), self.slack);
        let first = 4.0 * UNIT * a * (chord + c) + e * (chord + c + 2.0 * a);
        let middle = 3.0 * UNIT * a * c + e * (a + c);
        let last = 4.0 * UNIT * c * (chord + a) + e * (chord + a + 2.0 * c);
        let vanishes = |omega: DVec3, own: DVec3, other: DVec3| {
            omega == DVec3::ZERO && has_no_products(own, self.chord) && has_no_products(own, other)
        };
        [
            if vanishes(self.omega[0], self.a, self.c) { 0.0 } else { first },
            middle,
            if vanishes(self.omega[2], self.c, self.a) { 0.0 } else { last },
        ]
    }

    /// `ω·n` as `[α, γ, β]`.
    fn omega_signs(&self, n: DVec3) -> [Rounded; 3] {
        let (off, size) = (self.omega_errors(), sum(n) + 20.0 * UNIT);
        [0, 1, 2].map(|k| {
            let (omega, own) = (self.omega[k], 10.0 * UNIT * sum(self.omega[k]));
            Rounded { value: omega.dot(n), error: off[k] * size + own }
        })
    }

    /// `det[a, b, c] = det[a, L, c]`.
    fn rounded_determinant(&self) -> Rounded {
        let [a, chord, c] = self.sums();
        // a×L = ω(0) + a×c.
        let products = sum(self.omega[0]) + 3.0 * sum(self.omega[1]) + sum(self.omega[2]);
        let products = products + 3.0 * self.slack * (a + chord + c);
        let value = self.determinant();
        let error = 6.0 * UNIT * a * chord * c + self.slack * products;
        Rounded { value, error: if value == 0.0 && self.is_flat() { 0.0 } else { error } }
    }

    /// Whether every product in `det[a, L, c]` is zero.
    fn is_flat(&self) -> bool {
        let flat = |axis: fn(DVec3) -> f64| [self.a, self.chord, self.c].map(axis) == [0.0; 3];
        let pairs = [(self.a, self.chord), (self.chord, self.c), (self.a, self.c)];
        flat(|v| v.x)
            || flat(|v| v.y)
            || flat(|v| v.z)
            || pairs.into_iter().any(|(u, v)| has_no_products(u, v))
    }
}
