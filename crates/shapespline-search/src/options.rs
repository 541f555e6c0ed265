// SPDX-License-Identifier: MIT OR Apache-2.0

//! How to search.

use shapespline_criteria::{Checker, Criteria, Tolerances};
use shapespline_geometry::{DataPolygon, InputError};

/// The rule by which tension is raised, and whether it is lowered afterwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Strategy {
    /// The paper's rule: `ν ← ν + step` (5.61). Slow where much tension is needed.
    Nussp,
    /// `ν ← max(step, 2ν)`: as many rounds as the tension needed has binary digits.
    Growth,
    /// Growth, then every tension lowered by itself until none can be lowered by more than some per cent
    /// without breaking a criterion or making the curve bend more.
    #[default]
    Fairest,
    /// The rule of paper 000, section 4: `λ ← ρλ` with `ρ = step`, where `λ = 1/(1 + tension)`.
    Reduction,
}

impl Strategy {
    /// All strategies with the names users write.
    pub const NAMED: [(&'static str, Self); 4] = [
        ("nussp", Self::Nussp),
        ("growth", Self::Growth),
        ("fairest", Self::Fairest),
        ("reduction", Self::Reduction),
    ];

    /// Whether a round of raising looks first at the segments around what it raises, and at all others
    /// once those keep their shape. The papers' rules look at all of them in every round.
    pub(crate) fn looks_first(self) -> bool {
        matches!(self, Self::Growth | Self::Fairest)
    }

    /// The name users write.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nussp => "nussp",
            Self::Growth => "growth",
            Self::Fairest => "fairest",
            Self::Reduction => "reduction",
        }
    }
}

/// What to keep, how exactly, and how to get there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchOptions {
    /// The criteria to keep.
    pub criteria: Criteria,
    /// Their tolerances.
    pub tolerances: Tolerances,
    /// How tension is raised.
    pub strategy: Strategy,
    /// `Δν`: what is added (nussp), or the first tension (growth); positive. For the reduction the
    /// factor `ρ`, below one.
    pub step: f64,
    /// Largest number of checks of the curve while raising; at least one. `None`: no limit for as long as
    /// every segment that fails has a node at which tension can rise. It rises to 1e60; without a limit
    /// the papers' rules end where 10 000 raises of a node do, for steps can be as small as you like.
    pub max_iterations: Option<usize>,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            criteria: Criteria::OF_FITS,
            tolerances: Tolerances::default(),
            strategy: Strategy::default(),
            step: 0.5,
            max_iterations: None,
        }
    }
}

impl SearchOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// A tolerance or step outside its range, NaN included, or no iteration allowed.
    pub fn validate(&self) -> Result<(), InputError> {
        self.tolerances.validate()?;
        if !(self.step > 0.0 && self.step.is_finite()) {
            let (argument, value) = ("step", self.step);
            return Err(InputError::Scalar { argument, value, allowed: "positive and finite" });
        }
        if self.strategy == Strategy::Reduction && self.step >= 1.0 {
            let (argument, value) = ("step", self.step);
            let allowed = "in (0, 1) for strategy \"reduction\"";
            return Err(InputError::Scalar { argument, value, allowed });
        }
        if self.max_iterations == Some(0) {
            let argument = "max_iterations";
            return Err(InputError::Scalar { argument, value: 0.0, allowed: "at least 1" });
        }
        Ok(())
    }

    /// The checker of a polygon for these options.
    ///
    /// # Errors
    /// As [`SearchOptions::validate`].
    pub fn checker<'p>(&self, polygon: &'p DataPolygon) -> Result<Checker<'p>, InputError> {
        self.validate()?;
        Ok(Checker::new(polygon, self.criteria, self.tolerances))
    }

    /// The next tension of a node that has to be raised; the same if it can rise no further.
    pub(crate) fn raised(&self, tension: f64) -> f64 {
        let next = match self.strategy {
            Strategy::Nussp => tension + self.step,
            Strategy::Growth | Strategy::Fairest => (2.0 * tension).max(self.step),
            Strategy::Reduction => (1.0 + tension) / self.step - 1.0,
        };
        next.min(self.highest()).max(tension)
    }

    /// The highest tension that raising leads to.
    fn highest(&self) -> f64 {
        /// No further than where squares of legs would underflow.
        const HIGHEST: f64 = 1e60;
        /// Raises of a node by the papers' rules after which nothing more is expected of them.
        const RAISES: f64 = 1e4;

        let added_up = match self.strategy {
            Strategy::Growth | Strategy::Fairest => HIGHEST,
            _ if self.max_iterations.is_some() => HIGHEST,
            Strategy::Nussp => RAISES * self.step,
            Strategy::Reduction => self.step.powf(-RAISES) - 1.0,
        };
        added_up.min(HIGHEST)
    }
}
