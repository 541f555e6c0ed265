// SPDX-License-Identifier: MIT OR Apache-2.0

//! The criteria by name, sets of them, and their tolerances.

use shapespline_geometry::InputError;

/// A shape criterion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Criterion {
    /// The curve turns as the polygon does, seen along both binormal vectors.
    Convexity,
    /// The curve has exactly the inflection of the polygon.
    Inflection,
    /// At every node the curve turns as the polygon does there and, as far as they have a common side,
    /// beside it; and its tangent lies between the chords.
    Turning,
    /// The curve twists as the polygon does.
    Torsion,
    /// Near a plane where four points lie in one.
    Coplanarity,
    /// Near a line where three points lie on one.
    Collinearity,
    /// Convexity, and the curve seen along both binormal vectors neither turns past its own start nor
    /// crosses itself.
    GlobalConvexity,
    /// The curve nowhere stops: its speed exceeds what rounding of it could be. Whether it is named or
    /// not, this is asked wherever no other criterion implies it; but only if it is named also beside points
    /// where the polygon doubles back on itself, at which it may be that no curve of a family can go on.
    Regular,
}

impl Criterion {
    /// All criteria, in the order of reports: the default ones, then what has to be asked for.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Convexity,
        Self::Inflection,
        Self::Turning,
        Self::Torsion,
        Self::Coplanarity,
        Self::Collinearity,
        Self::GlobalConvexity,
        Self::Regular,
    ];

    /// How many there are.
    pub const COUNT: usize = 8;

    /// The name users write.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Convexity => "convexity",
            Self::Inflection => "inflection",
            Self::Turning => "turning",
            Self::Torsion => "torsion",
            Self::Coplanarity => "coplanarity",
            Self::Collinearity => "collinearity",
            Self::GlobalConvexity => "global-convexity",
            Self::Regular => "regular",
        }
    }

    /// The criterion of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }
}

impl std::fmt::Display for Criterion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// A set of criteria.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Criteria(u8);

impl Criteria {
    /// No criterion.
    pub const NONE: Self = Self(0);
    /// The default of a check: all but global convexity, which asks more of a curve than the papers'
    /// algorithms promise.
    pub const DEFAULT: Self = Self::ALL.without(Criterion::GlobalConvexity);
    /// The default of a fit: as [`Criteria::DEFAULT`], but where the points double back the curve
    /// may stop.
    pub const OF_FITS: Self = Self::DEFAULT.without(Criterion::Regular);
    /// Every criterion there is.
    pub const ALL: Self = Self(0b1111_1111);

    /// Whether the set holds a criterion.
    #[must_use]
    pub fn contains(self, criterion: Criterion) -> bool {
        self.0 & (1 << criterion as u8) != 0
    }

    /// The set with one more criterion.
    #[must_use]
    pub fn with(self, criterion: Criterion) -> Self {
        Self(self.0 | 1 << criterion as u8)
    }

    /// The set with one criterion less.
    #[must_use]
    pub const fn without(self, criterion: Criterion) -> Self {
        Self(self.0 & !(1 << criterion as u8))
    }

    /// The criteria of the set.
    pub fn iter(self) -> impl Iterator<Item = Criterion> {
        Criterion::ALL.into_iter().filter(move |&c| self.contains(c))
    }
}

impl Default for Criteria {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FromIterator<Criterion> for Criteria {
    fn from_iter<I: IntoIterator<Item = Criterion>>(criteria: I) -> Self {
        criteria.into_iter().fold(Self::NONE, Self::with)
    }
}

/// What counts as near a plane, near a line, and zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tolerances {
    /// `ε₁ ∈ (0, 1]`: sine of the largest angle between binormal and plane normal.
    pub coplanarity: f64,
    /// `ε₀ ∈ (0, 1]`: sine of the largest angle between tangent and line.
    pub collinearity: f64,
    /// Sine below which points count as collinear (turning angle), coplanar (`Γ` of unit chords)
    /// and binormal vectors as perpendicular; in `[0, 1)`.
    pub zero: f64,
    /// The accuracy of the points, a length: what a move of the points by that much could undo is not asked for.
    pub resolution: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self { coplanarity: 0.2, collinearity: 0.2, zero: 1e-9, resolution: 0.0 }
    }
}

impl Tolerances {
    /// Checks the ranges.
    ///
    /// # Errors
    /// A value outside its range, NaN included.
    pub fn validate(self) -> Result<Self, InputError> {
        let angle = |argument, value: f64| {
            let allowed = "a sine in (0, 1]";
            let valid = value > 0.0 && value <= 1.0;
            if valid { Ok(()) } else { Err(InputError::Scalar { argument, value, allowed }) }
        };
        angle("coplanarity", self.coplanarity)?;
        angle("collinearity", self.collinearity)?;
        if !(0.0..1.0).contains(&self.zero) {
            let (argument, value) = ("tolerance", self.zero);
            return Err(InputError::Scalar { argument, value, allowed: "in [0, 1)" });
        }
        if !(0.0..f64::INFINITY).contains(&self.resolution) {
            let (argument, value) = ("resolution", self.resolution);
            let allowed = "a length, at least 0";
            return Err(InputError::Scalar { argument, value, allowed });
        }
        Ok(self)
    }
}
