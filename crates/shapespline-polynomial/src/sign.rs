// SPDX-License-Identifier: MIT OR Apache-2.0

//! The sign of a polynomial on an interval, decided and not sampled.

use crate::bernstein::{rounding, split};

/// Deepest subdivision: an interval of `2^{−52}` is one rounding of its ends.
pub(crate) const DEPTH: u32 = 52;

/// What is known of the sign of a polynomial on an interval.
///
/// Coefficients that are all positive prove it; an end value that is not refutes it; else the interval is halved, which
/// brings coefficients and values together quadratically. What is left then is open: an interval so small that the
/// polynomial is below rounding there (a double root). A NaN fails.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    /// Greater than zero everywhere.
    Positive,
    /// Not greater than zero at a parameter.
    Fails {
        /// The parameter.
        at: f64,
    },
    /// Zero to rounding somewhere in an interval; positive outside of it, as far as that was looked at.
    Undecided {
        /// Where the interval begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
}

impl Sign {
    /// That of the polynomial with these coefficients, an array or a vector, which are taken as exact. The first interval
    /// that stays open ends the search.
    ///
    /// Cost: one pass over the coefficients when they are all positive, else one subdivision a level around each place
    /// where the polynomial is near zero; at most 52 levels.
    #[inline]
    #[must_use]
    pub fn of<C: AsRef<[f64]> + AsMut<[f64]> + Clone>(c: &C) -> Self {
        let size = c.as_ref().iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let noise = rounding(c.as_ref().len(), size);
        let positive = |x: f64| x > 0.0;
        Search { refutes: |x| !positive(x), proves: positive, noise, to_the_end: false }.run(c)
    }

    /// That of coefficients that carry an error of at most `error` each: a value that is exactly zero fails, one that is
    /// zero to rounding leaves the question open, and the search goes on.
    #[inline]
    #[must_use]
    pub fn with_error<C: AsRef<[f64]> + AsMut<[f64]> + Clone>(c: &C, error: f64) -> Self {
        let refutes = |x: f64| !(x > -error) || x == 0.0;
        Search { refutes, proves: |x| x > error, noise: error, to_the_end: true }.run(c)
    }

    /// Whether the polynomial is proved to be positive.
    #[inline]
    #[must_use]
    pub fn holds(self) -> bool {
        self == Self::Positive
    }

    /// Where it is not: the middle of the interval where that is open.
    #[must_use]
    pub fn place(self) -> Option<f64> {
        match self {
            Self::Positive => None,
            Self::Fails { at } => Some(at),
            Self::Undecided { from, to } => Some(0.5 * (from + to)),
        }
    }

    /// What is known when both have to be positive.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Fails { .. }, _) | (_, Self::Positive) => self,
            (_, Self::Fails { .. }) | (Self::Positive, _) => other,
            (Self::Undecided { from: a, to: b }, Self::Undecided { from: c, to: d }) => {
                Self::Undecided { from: a.min(c), to: b.max(d) }
            }
        }
    }

    /// The same on an interval that was mapped to `[0, 1]`.
    #[must_use]
    pub fn on(self, from: f64, to: f64) -> Self {
        let outer = |t: f64| from + t * (to - from);
        match self {
            Self::Positive => self,
            Self::Fails { at } => Self::Fails { at: outer(at) },
            Self::Undecided { from, to } => Self::Undecided { from: outer(from), to: outer(to) },
        }
    }
}

/// Whether `p + tolerance ≥ 0` on all of `[0, 1]` is proved. What is neither proved nor refuted at the resolution of f64
/// counts as not proved.
#[must_use]
pub fn certified_nonnegative<const N: usize>(c: &[f64; N], tolerance: f64) -> bool {
    let proves = |x: f64| x >= 0.0;
    let search = Search { refutes: |x| !proves(x), proves, noise: -1.0, to_the_end: false };
    search.run(&c.map(|x| x + tolerance)).holds()
}

/// What decides: an end value refutes, coefficients prove all together, and below the noise nothing can be known.
struct Search<R, P> {
    refutes: R,
    proves: P,
    noise: f64,
    /// Whether an interval that stays open does not end the search.
    to_the_end: bool,
}

impl<R: Fn(f64) -> bool, P: Fn(f64) -> bool> Search<R, P> {
    #[inline]
    fn run<C: AsRef<[f64]> + AsMut<[f64]> + Clone>(&self, c: &C) -> Sign {
        self.part(c, [0.0, 1.0], DEPTH)
    }

    fn part<C: AsRef<[f64]> + AsMut<[f64]> + Clone>(
        &self,
        c: &C,
        [from, to]: [f64; 2],
        depth: u32,
    ) -> Sign {
        let all = c.as_ref();
        for (value, at) in [(all[0], from), (all[all.len() - 1], to)] {
            if (self.refutes)(value) {
                return Sign::Fails { at };
            }
        }
        if all.iter().all(|&x| (self.proves)(x)) {
            return Sign::Positive;
        }
        if depth == 0 || all.iter().all(|x| x.abs() <= self.noise) {
            return Sign::Undecided { from, to };
        }
        let middle = 0.5 * (from + to);
        let (left, right) = split(c.clone(), 0.5);
        match self.part(&left, [from, middle], depth - 1) {
            open @ Sign::Undecided { .. } if !self.to_the_end => open,
            fails @ Sign::Fails { .. } => fails,
            known => known.and(self.part(&right, [middle, to], depth - 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        bernstein::value,
        quadratic::{multiply, planted},
    };
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn planted_roots_decide(r in -1.0..2.0f64, s in -1.0..2.0f64, p in -1.0..2.0f64, q in 0.01..1.0f64) {
            let inside = |x: f64| (0.0..=1.0).contains(&x);
            prop_assume!((r - s).abs() > 1e-6);
            let c = multiply(planted(r, s), [p * p + q, p * p - p + q, (1.0 - p).powi(2) + q]);
            let positive = !inside(r) && !inside(s) && (r < 0.0) == (s < 0.0);
            for sign in [Sign::of(&c), Sign::of(&c.to_vec()), Sign::with_error(&c, 1e-18)] {
                prop_assert_eq!(sign.holds(), positive);
                if let Sign::Fails { at } = sign {
                    prop_assert!(value(&c, at) <= 1e-14);
                }
            }
            prop_assert_eq!(certified_nonnegative(&c, 0.0), positive);
        }
    }

    #[test]
    fn a_double_root_is_not_called_positive() {
        let root = 1.0 / 3.0;
        let square = [root * root, -root * (1.0 - root), (1.0 - root) * (1.0 - root)];
        let open = Sign::of(&square);
        assert!(matches!(open, Sign::Undecided { .. }));
        assert!(open.place().is_some_and(|t| (t - root).abs() < 1e-6));
        assert!(!Sign::of(&multiply(square, [1.0, 2.0, 1.0])).holds());
        assert!(Sign::of(&square.map(|c| c + 1e-12)).holds());
    }

    #[test]
    fn the_certificate_sees_hair_thin_violations() {
        for (depth, holds) in [(1e-10, true), (-1e-10, false)] {
            let thin = planted(0.37, 0.37).map(|c| c + depth);
            assert_eq!(certified_nonnegative(&multiply(thin, [4.3, 2.3, 1.3]), 0.0), holds);
        }
        assert!(!certified_nonnegative(&[1.0, f64::NAN, 1.0, 1.0, 1.0], 0.0));
    }
}
