// SPDX-License-Identifier: MIT OR Apache-2.0

#![doc = include_str!("../README.md")]
//!
//! # How the search works
//!
//! One search serves every family of splines with a tension at each node. A family says how tension
//! makes end legs ([`TensionFamily`]); the search asks the criteria where the curve fails, raises the
//! tensions that can mend it ([`Strategy`]), has the family solve again where they changed, checks
//! what that touched, and repeats. `Fairest` then lowers every tension by itself as far as the
//! criteria allow, for growth overshoots.
//!
//! **Guarantee.** A search that ends with [`Status::Solved`] ends with a complete solve and a complete
//! check that found no violation. Convergence rests on the asymptotic theorems of the family (paper
//! 001, Lemmas 5.4–5.9; paper 000, Lemmas 4.1–4.3). A search ends without a solution where a
//! segment fails though no tension around it can rise any further ([`Status::Stalled`]), and at the
//! caller's limit.
//!
//! **Cost.** One full solve and check first and last; between them the cost follows the number of
//! violations, not the length of the curve. Where a violation travels through regular data, a segment a
//! round, the tension it has required so far is set at once as far ahead as it has come, so that a
//! regular run takes as many rounds as its length has binary digits.
//!
//! Source: M. I. Karavelas, P. D. Kaklis, Numerical Algorithms 23 (2000), section 5.2 (algorithm
//! NUSSP), with errata E4 and E5.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).

mod bending;
mod doubts;
mod error;
mod fewer;
mod fronts;
mod group;
mod interpolant;
mod lower;
mod many;
mod options;
mod order;
mod outcome;
mod pattern;
mod raise;
mod search;
mod solved;
mod solver_cache;
mod spline;
mod state;
mod surroundings;
mod system;
mod tension;
mod tension_family;

pub use error::FitError;
pub use interpolant::Interpolant;
pub use many::{Collection, fit_many};
pub use options::{SearchOptions, Strategy};
pub use outcome::{Diagnostics, Fit, Outcome, Phase, Status, Step};
/// Criteria, tolerances and the report.
pub use shapespline_criteria as criteria;
/// Points, their parameters and ends, and the evaluation of curves.
pub use shapespline_geometry as geometry;
pub use spline::Spline;
pub use tension::Tension;

use family::{FittedLegs, SolvedFamily, TensionFamily, TensionSystem, search_and_report};

/// What the author of a family of curves needs: traits to implement, and the search itself.
pub mod family {
    #[cfg(feature = "serde")]
    pub use crate::interpolant::polygon_of_stored;
    pub use crate::{
        outcome::FittedLegs,
        search::{search, search_and_report},
        solved::SolvedFamily,
        spline::SplineFamily,
        system::{TensionSystem, try_each_row},
        tension::repeat_first_if_closed,
        tension_family::{TensionFamily, tension_unit},
    };
    /// The systems that families solve.
    pub use shapespline_banded as banded;
}
