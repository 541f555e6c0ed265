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

/// Whether `α(1−t)² + γt(1−t) + βt²` is positive: Lemma 5.1, with the rounding of its root.
#[inline(always)]
pub(crate) fn is_positive([alpha, gamma, beta]: [Rounded; 3], lean: Lean) -> bool {
    let root = Rounded { error: gamma.error + 8.0 * UNIT * gamma.value.abs(), ..gamma };
    shapespline_polynomial::quadratic::is_positive(
        alpha.toward(lean),
        root.toward(lean),
        beta.toward(lean),
    )
}
