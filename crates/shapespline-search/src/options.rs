//! How to search.

use shapespline_criteria::{Criteria, Tolerances};
use shapespline_geometry::InputError;

/// The rule by which tension is raised, and whether it is relaxed afterwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strategy {
    /// The paper's rule: `ν ← ν + step` (5.61). Slow where much tension is needed.
    Nussp,
    /// `ν ← max(step, 2ν)`: as many rounds as the tension needed has binary digits.
    Growth,
    /// Growth, then every run of tension lowered until no run can be lowered by more than 1 %
    /// without breaking a criterion.
    #[default]
    Fairest,
}

impl Strategy {
    /// All strategies with the names users write.
    pub const NAMED: [(&'static str, Self); 3] =
        [("nussp", Self::Nussp), ("growth", Self::Growth), ("fairest", Self::Fairest)];

    /// The name users write.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nussp => "nussp",
            Self::Growth => "growth",
            Self::Fairest => "fairest",
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
    /// `Δν`: what is added (nussp), or the first tension (growth); positive.
    pub step: f64,
    /// Largest number of checks of the curve while raising; at least one. `None` takes 10 000 for
    /// the additive rule and 200 for growth, which doubles and cannot need more than f64 has.
    pub max_iterations: Option<usize>,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            criteria: Criteria::ALL,
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
        if self.max_iterations == Some(0) {
            let argument = "max_iterations";
            return Err(InputError::Scalar { argument, value: 0.0, allowed: "at least 1" });
        }
        Ok(())
    }

    pub(crate) fn limit(&self) -> usize {
        self.max_iterations.unwrap_or(match self.strategy {
            Strategy::Nussp => 10_000,
            Strategy::Growth | Strategy::Fairest => 200,
        })
    }

    /// The next tension of a node that has to be raised.
    pub(crate) fn raised(&self, tension: f64) -> f64 {
        match self.strategy {
            Strategy::Nussp => tension + self.step,
            // No further than where squares of legs would underflow.
            Strategy::Growth | Strategy::Fairest => (2.0 * tension).max(self.step).min(1e60),
        }
    }
}
