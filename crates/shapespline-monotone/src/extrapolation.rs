//! What a function is outside its knots.

use crate::MonotoneError;

/// What a function is outside its knots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Extrapolation {
    /// The polynomial of the end segment goes on (SciPy's `True`, the default).
    #[default]
    Polynomial,
    /// NaN (SciPy's `False`).
    Nan,
    /// Zero: what the derivative of [`Extrapolation::CLIP`] is.
    Zero,
    /// The Taylor polynomial of this degree about the end knot.
    Taylor(u8),
}

impl Extrapolation {
    /// The end value goes on.
    pub const CLIP: Self = Self::Taylor(0);
    /// The tangent line goes on.
    pub const LINEAR: Self = Self::Taylor(1);

    /// The mode of the derivative of a function of this mode.
    #[must_use]
    pub fn derivative(self) -> Self {
        match self {
            Self::Taylor(0) | Self::Zero => Self::Zero,
            Self::Taylor(k) => Self::Taylor(k - 1),
            other => other,
        }
    }

    /// The mode of an antiderivative of a function of this mode.
    #[must_use]
    pub fn antiderivative(self) -> Self {
        match self {
            Self::Zero => Self::CLIP,
            Self::Taylor(k) => Self::Taylor(k.saturating_add(1)),
            other => other,
        }
    }
}

impl std::str::FromStr for Extrapolation {
    type Err = MonotoneError;
    fn from_str(value: &str) -> Result<Self, Self::Err> {
        match value {
            "linear" => Ok(Self::LINEAR),
            "clip" => Ok(Self::CLIP),
            _ => Err(MonotoneError::UnknownOption {
                argument: "extrapolate",
                value: value.to_owned(),
                expected: "None, True, False, \"linear\", \"clip\"",
            }),
        }
    }
}
