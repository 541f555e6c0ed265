// SPDX-License-Identifier: MIT OR Apache-2.0

//! What can be wrong with a user's input: always with the argument, the place and the value.

use std::fmt;

use glam::DVec3;

use crate::Dimension;

/// A point or a vector in the dimension of the input it came from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    /// Its coordinates; of planar ones the third is zero.
    pub vector: DVec3,
    /// How many of them were given.
    pub dimension: Dimension,
}

impl Coordinates {
    /// The coordinates that were given.
    #[must_use]
    pub fn to_vec(self) -> Vec<f64> {
        self.vector.to_array()[..self.dimension.count()].to_vec()
    }
}

impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.vector;
        match self.dimension {
            Dimension::Two => write!(f, "({x}, {y})"),
            Dimension::Three => write!(f, "({x}, {y}, {z})"),
        }
    }
}

/// Unusable input. Every variant names the argument, the index and the offending value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// A NaN or an infinity.
    #[error("{argument}[{index}] must be finite, got {value}")]
    NotFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the value along the first axis.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Fewer points than a curve needs.
    #[error("{argument} must hold at least {needed} points{why}, got {found}")]
    TooFewPoints {
        /// Name of the argument.
        argument: &'static str,
        /// The least number.
        needed: usize,
        /// The number given.
        found: usize,
        /// Who needs them, with a leading space, or empty.
        why: &'static str,
    },
    /// Two arguments whose lengths do not belong together.
    #[error("{argument} must have length {expected} ({per}), got {found}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// The length it should have.
        expected: usize,
        /// The length it has.
        found: usize,
        /// What there is one of for each entry.
        per: &'static str,
    },
    /// A point equal to the point before it.
    #[error("points[{index}] repeats points[{previous}]: {value}; neighbouring points must differ",
            previous = index - 1)]
    RepeatedPoint {
        /// Index of the second of the two.
        index: usize,
        /// The point.
        value: Coordinates,
    },
    /// Parameters that do not increase strictly.
    #[error("{argument} must be strictly increasing, but {argument}[{index}] = {value} does not exceed \
             {argument}[{before}] = {previous}", before = index - 1)]
    NotIncreasing {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the value that is too small.
        index: usize,
        /// The value before it.
        previous: f64,
        /// The value.
        value: f64,
    },
    /// Parameters that increase by so little that nothing can be divided by it.
    #[error("{argument}[{index}] exceeds {argument}[{before}] by {spacing:e}, too little for f64",
            before = index - 1)]
    TooClose {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the second of the two.
        index: usize,
        /// Their difference.
        spacing: f64,
    },
    /// Periodic data whose last point is not the first.
    #[error("boundary \"periodic\" needs points[{last}] = points[0], got {end} and {start}")]
    NotClosed {
        /// Index of the last point.
        last: usize,
        /// The first point.
        start: Coordinates,
        /// The last point.
        end: Coordinates,
    },
    /// Numbers at the nodes of closed data whose last is not the first.
    #[error(
        "{argument}[{last}] must equal {argument}[0] for boundary \"periodic\", got {end} and \
             {start}"
    )]
    Unequal {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the last number.
        last: usize,
        /// The first number.
        start: f64,
        /// The last number.
        end: f64,
    },
    /// A number outside the range it must lie in.
    #[error("{argument}[{index}] must be {allowed}, got {value}")]
    OutOfRange {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the value.
        index: usize,
        /// The value.
        value: f64,
        /// The range in words.
        allowed: &'static str,
    },
    /// One number that is not what it must be.
    #[error("{argument} must be {allowed}, got {value}")]
    Scalar {
        /// Name of the argument.
        argument: &'static str,
        /// The value.
        value: f64,
        /// The range in words.
        allowed: &'static str,
    },
    /// An end tangent that has no direction.
    #[error("boundary {end} tangent must be a non-zero vector, got {value}")]
    ZeroTangent {
        /// `"start"` or `"end"`.
        end: &'static str,
        /// The vector.
        value: Coordinates,
    },
    /// Finite data whose differences leave the range of f64.
    #[error("points[{index}] and points[{next}] are too far apart for f64: {what} is {value}",
            next = index + 1)]
    Overflow {
        /// Index of the segment.
        index: usize,
        /// The quantity that overflows.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Points and legs are summed with weights up to one: so much room has to be left.
const ROOM: f64 = 16.0;

/// One where a number is not finite or leaves no room for sums of it.
#[inline(always)]
pub(crate) fn outside(x: f64) -> u64 {
    u64::from(!(x.abs() <= f64::MAX / ROOM))
}

/// Checks that coordinates are numbers that leave room for sums of them. O(n), without a branch an entry.
pub(crate) fn check_room(argument: &'static str, points: &[DVec3]) -> Result<(), InputError> {
    if points.iter().map(|p| outside(p.x) + outside(p.y) + outside(p.z)).sum::<u64>() == 0 {
        return Ok(());
    }
    let entries = points.iter().enumerate().flat_map(|(i, p)| p.to_array().map(|x| (i, x)));
    match entries.into_iter().find(|(_, x)| !(x * ROOM).is_finite()) {
        Some((index, value)) if value.is_finite() => {
            let allowed = "below 1.1e307 in magnitude";
            Err(InputError::OutOfRange { argument, index, value, allowed })
        }
        Some((index, value)) => Err(InputError::NotFinite { argument, index, value }),
        None => Ok(()),
    }
}
