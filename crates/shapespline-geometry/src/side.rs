// SPDX-License-Identifier: MIT OR Apache-2.0

use shapespline_polynomial::knots::{from_left, from_right};

/// Which of the two segments that meet at a knot stands for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// The segment that ends at the knot.
    Left,
    /// The segment that begins at the knot.
    #[default]
    Right,
}

impl Side {
    /// The segment of `u` by binary search; the end segments stand for everything outside. Cost O(log N).
    #[inline]
    pub(crate) fn segment(self, knots: &[f64], u: f64) -> usize {
        match self {
            Self::Right => from_right(knots, u),
            Self::Left => from_left(knots, u),
        }
    }
}
