// SPDX-License-Identifier: MIT OR Apache-2.0

//! What to keep, how exactly, and what to minimise.

use shapespline_criteria::{Criteria, Tolerances};
use shapespline_geometry::InputError;

use crate::{Constraints, Energy};

/// What to keep, how exactly, and what to minimise.
#[derive(Debug, Clone, PartialEq)]
pub struct FairOptions {
    /// The criteria to keep.
    pub criteria: Criteria,
    /// Their tolerances.
    pub tolerances: Tolerances,
    /// What is minimised.
    pub energy: Energy,
    /// What else the curve has to do.
    pub constraints: Constraints,
    /// Largest number of Newton steps in all windows together; at least one. `None` leaves it to the
    /// limits of each phase, which end every search.
    pub max_iterations: Option<usize>,
}

impl Default for FairOptions {
    fn default() -> Self {
        Self {
            criteria: Criteria::OF_FITS,
            tolerances: Tolerances::default(),
            energy: Energy::default(),
            constraints: Constraints::default(),
            max_iterations: None,
        }
    }
}

impl FairOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// A tolerance outside its range, NaN included, or no iteration allowed.
    pub fn validate(&self) -> Result<(), InputError> {
        self.tolerances.validate()?;
        if self.max_iterations == Some(0) {
            let argument = "max_iterations";
            return Err(InputError::Scalar { argument, value: 0.0, allowed: "at least 1" });
        }
        Ok(())
    }
}
