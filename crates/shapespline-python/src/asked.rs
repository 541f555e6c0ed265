// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a check is asked: criteria and tolerances, as users give them or as a fit kept them.

use pyo3::prelude::*;
use shapespline::criteria::{Criteria, Criterion, Tolerances};

use crate::options::{CriteriaNames, tolerances};

/// The question of a check.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Asked {
    /// The criteria by name: what a report lists.
    pub(crate) criteria: Criteria,
    /// Whether a curve that stops where the points double back is wrong. Of a fit it is what its family
    /// can do there.
    strict: bool,
    pub(crate) tolerances: Tolerances,
}

impl Default for Asked {
    fn default() -> Self {
        let (criteria, tolerances) = (Criteria::OF_FITS, Tolerances::default());
        Self { criteria, strict: true, tolerances }
    }
}

impl Asked {
    /// What a fit was asked for.
    pub(crate) fn of_fit(criteria: Criteria, tolerances: Tolerances) -> Self {
        Self { criteria, strict: false, tolerances }
    }

    /// The defaults of a check: of a fit, or of any other curve.
    pub(crate) fn default_of(fit: bool) -> Self {
        Self { strict: !fit, ..Self::default() }
    }

    /// The same but for what is given.
    pub(crate) fn with(self, given: Given) -> PyResult<Self> {
        let Given { criteria, resolution, coplanarity, collinearity, tolerance } = given;
        let own = self.tolerances;
        let tolerances = tolerances(
            resolution.unwrap_or(own.resolution),
            coplanarity.unwrap_or(own.coplanarity),
            collinearity.unwrap_or(own.collinearity),
            tolerance.unwrap_or(own.zero),
        )?;
        Ok(Self { criteria: criteria.or(self.criteria), tolerances, ..self })
    }

    /// The criteria for a checker.
    pub(crate) fn to_check(self) -> Criteria {
        if self.strict { self.criteria.with(Criterion::Regular) } else { self.criteria }
    }
}

/// The options of a check that a caller gave.
pub(crate) struct Given {
    pub(crate) criteria: CriteriaNames,
    pub(crate) resolution: Option<f64>,
    pub(crate) coplanarity: Option<f64>,
    pub(crate) collinearity: Option<f64>,
    pub(crate) tolerance: Option<f64>,
}
