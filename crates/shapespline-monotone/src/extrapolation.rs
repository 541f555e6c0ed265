// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a function is outside its knots: one continuation below them, one above.

use crate::MonotoneError;

/// How a function continues beyond one end of its knots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Continuation {
    /// The polynomial of the end segment (SciPy's `True`), without leading coefficients of rounding size, which would decide
    /// its values far away.
    Polynomial,
    /// NaN (SciPy's `False`).
    Nan,
    /// Zero: what the derivative of a constant continuation is.
    Zero,
    /// The Taylor polynomial of this degree about the end knot: 0 is the end value, 1 the tangent line.
    Taylor(usize),
    /// The function repeats with the period of its knots (order 0), or is the antiderivative of this order of a function that
    /// repeats.
    Periodic(usize),
}

impl Continuation {
    /// The continuation of the derivative.
    #[must_use]
    pub fn derivative(self) -> Self {
        match self {
            Self::Taylor(0) | Self::Zero => Self::Zero,
            Self::Taylor(k) => Self::Taylor(k - 1),
            Self::Periodic(order) => Self::Periodic(order.saturating_sub(1)),
            Self::Polynomial | Self::Nan => self,
        }
    }

    /// The continuation of an antiderivative.
    #[must_use]
    pub fn antiderivative(self) -> Self {
        match self {
            Self::Zero => Self::Taylor(0),
            Self::Taylor(k) => Self::Taylor(k.saturating_add(1)),
            Self::Periodic(order) => Self::Periodic(order.saturating_add(1)),
            Self::Polynomial | Self::Nan => self,
        }
    }
}

/// What a function is outside its knots. By default it follows the tangent lines, with which monotone functions are C¹ and
/// monotone everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Extrapolation {
    /// Before the first knot.
    pub below: Continuation,
    /// After the last knot.
    pub above: Continuation,
}

impl Default for Extrapolation {
    fn default() -> Self {
        Self::LINEAR
    }
}

impl From<Continuation> for Extrapolation {
    fn from(both: Continuation) -> Self {
        Self { below: both, above: both }
    }
}

impl Extrapolation {
    /// The end polynomials.
    pub const POLYNOMIAL: Self =
        Self { below: Continuation::Polynomial, above: Continuation::Polynomial };
    /// NaN.
    pub const NAN: Self = Self { below: Continuation::Nan, above: Continuation::Nan };
    /// The end values.
    pub const CLIP: Self = Self { below: Continuation::Taylor(0), above: Continuation::Taylor(0) };
    /// The tangent lines at the ends.
    pub const LINEAR: Self =
        Self { below: Continuation::Taylor(1), above: Continuation::Taylor(1) };
    /// The function on its knots repeats.
    pub const PERIODIC: Self =
        Self { below: Continuation::Periodic(0), above: Continuation::Periodic(0) };

    /// The continuation above (`right`) or below the knots.
    #[inline]
    #[must_use]
    pub fn side(self, right: bool) -> Continuation {
        if right { self.above } else { self.below }
    }

    /// The extrapolation of the derivative of a function of this extrapolation.
    #[must_use]
    pub fn derivative(self) -> Self {
        Self { below: self.below.derivative(), above: self.above.derivative() }
    }

    /// The extrapolation of an antiderivative of a function of this extrapolation.
    #[must_use]
    pub fn antiderivative(self) -> Self {
        Self { below: self.below.antiderivative(), above: self.above.antiderivative() }
    }
}

impl std::str::FromStr for Extrapolation {
    type Err = MonotoneError;
    fn from_str(value: &str) -> Result<Self, Self::Err> {
        match value {
            "linear" => Ok(Self::LINEAR),
            "clip" => Ok(Self::CLIP),
            "periodic" => Ok(Self::PERIODIC),
            _ => Err(MonotoneError::UnknownOption {
                argument: "extrapolate",
                value: value.to_owned(),
                expected: "linear, clip, periodic",
            }),
        }
    }
}
