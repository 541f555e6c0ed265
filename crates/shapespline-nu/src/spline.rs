// SPDX-License-Identifier: MIT OR Apache-2.0

//! The ν-spline interpolant.

use std::ops::ControlFlow;

#[cfg(feature = "serde")]
use shapespline_geometry::InputError;
use shapespline_geometry::{Boundary, DVec3, DataPolygon, PiecewiseCubic};
use shapespline_search::{
    Fit, FitError, FittedLegs, Interpolant, SearchOptions, SolvedFamily, Step, Tension,
    or_of_all_criteria, repeat_first_if_closed, search_and_report, solve_legs,
};

use crate::system::NuSystem;

/// A ν-spline through points in the plane or in space. Immutable.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct NuSpline {
    curve: PiecewiseCubic,
    tension: Vec<f64>,
    boundary: Boundary,
}

/// What was stored, by whomever: checked as far as anything could go wrong later.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "NuSpline")]
struct Stored {
    curve: PiecewiseCubic,
    tension: Vec<f64>,
    boundary: Boundary,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for NuSpline {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        let Stored { curve, tension, boundary } = stored;
        shapespline_search::check_stored(&tension, &curve)?;
        Ok(Self { curve, tension, boundary })
    }
}

impl NuSpline {
    /// The ν-spline of given tension. Cost O(N).
    ///
    /// # Errors
    /// Tension that is negative, not finite, or not one a point; tangents that overflow.
    pub fn new(polygon: DataPolygon, tension: Tension<'_>) -> Result<Self, FitError> {
        let tension = tension.non_negative(&polygon)?;
        let system = NuSystem { polygon: &polygon, tension };
        let (legs, tension) = (solve_legs(&system)?, system.tension);
        Self::assemble(polygon, legs, tension)
    }

    /// The ν-spline whose tension keeps the shape of the data (algorithm NUSSP and its successors).
    ///
    /// The fit says how it ended: the curve keeps the criteria if its status is `Solved`.
    ///
    /// # Errors
    /// Options outside their range; tangents that overflow.
    pub fn shape_preserving(
        polygon: DataPolygon,
        options: &SearchOptions,
    ) -> Result<Fit<Self>, FitError> {
        Self::shape_preserving_with(polygon, options, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`NuSpline::shape_preserving`], with a monitor that sees every step of the search and can
    /// end it.
    ///
    /// # Errors
    /// As [`NuSpline::shape_preserving`].
    pub fn shape_preserving_with(
        polygon: DataPolygon,
        options: &SearchOptions,
        monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Result<Fit<Self>, FitError> {
        let fit = Self::searched(polygon, options, monitor)?;
        or_of_all_criteria(fit, options, |polygon, all| Self::searched(polygon, all, monitor))
    }

    fn searched(
        polygon: DataPolygon,
        options: &SearchOptions,
        monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Result<Fit<Self>, FitError> {
        let tension = vec![0.0; polygon.nodes()];
        let mut family = SolvedFamily::new(NuSystem { polygon: &polygon, tension })?;
        let found = search_and_report(&mut family, &polygon, options, monitor)?;
        let (FittedLegs { legs, outcome, report }, tension) = (found, family.into_system().tension);
        let curve = Self::assemble(polygon, legs, tension)?;
        Ok(Fit { curve, outcome, report })
    }

    fn assemble(
        polygon: DataPolygon,
        legs: Vec<[DVec3; 2]>,
        tension: Vec<f64>,
    ) -> Result<Self, FitError> {
        let boundary = polygon.boundary();
        let tension = repeat_first_if_closed(tension, polygon.is_closed());
        Ok(Self { curve: PiecewiseCubic::through(polygon, legs)?, tension, boundary })
    }
}

impl Interpolant for NuSpline {
    type Curve = PiecewiseCubic;

    fn curve(&self) -> &PiecewiseCubic {
        &self.curve
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn boundary(&self) -> Boundary {
        self.boundary
    }
}
