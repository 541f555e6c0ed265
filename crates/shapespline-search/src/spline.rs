// SPDX-License-Identifier: MIT OR Apache-2.0

//! The spline of a family whose tangents solve a system.

use std::{fmt::Debug, ops::ControlFlow};

use shapespline_geometry::{Curve, DVec3, DataPolygon, InputError, PiecewiseCubic};

use crate::{
    Fit, FitError, FittedLegs, Interpolant, SearchOptions, SolvedFamily, Step, TensionSystem,
    fewer::or_of_all_criteria, search_and_report, system::solve_legs,
    tension::repeat_first_if_closed,
};

/// What makes a family of splines: the system of its tangents, and the curve that goes with a solution.
pub trait SplineFamily: Debug + Clone + PartialEq + 'static {
    /// Where growth of tension begins.
    const STEP: f64 = 0.5;

    /// How a spline is evaluated.
    type Curve: Curve + Debug + Clone + PartialEq + Send + Sync;
    /// Tension as callers give it.
    type Tension<'a>;
    /// The system of the tangents.
    type System<'p>: TensionSystem;

    /// The system of given tension.
    ///
    /// # Errors
    /// Tension out of range or of a wrong length.
    fn system<'p>(
        polygon: &'p DataPolygon,
        tension: Self::Tension<'_>,
    ) -> Result<Self::System<'p>, InputError>;

    /// The system without tension.
    fn without_tension(polygon: &DataPolygon) -> Self::System<'_>;

    /// The curve with the cubic that solves a system, and the tension at each distinct node.
    ///
    /// # Errors
    /// Those of the curve's constructor.
    fn curve(
        cubic: PiecewiseCubic,
        system: Self::System<'_>,
    ) -> Result<(Self::Curve, Vec<f64>), InputError>;
}

/// A spline through points in the plane or in space, with its data and its tension. Immutable.
///
/// The families are type aliases of it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Stored<F::Curve>",
        bound(
            serialize = "F::Curve: serde::Serialize",
            deserialize = "F::Curve: serde::Deserialize<'de>"
        )
    )
)]
pub struct Spline<F: SplineFamily> {
    curve: F::Curve,
    /// One per point.
    tension: Vec<f64>,
    /// Points and parameters are stored with the curve.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "boundary", serialize_with = "DataPolygon::serialize_boundary")
    )]
    polygon: DataPolygon,
}

/// The stored form, which may come from anywhere: checked as far as anything could go wrong later.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Stored<C> {
    curve: C,
    tension: Vec<f64>,
    boundary: shapespline_geometry::Boundary,
}

#[cfg(feature = "serde")]
impl<F: SplineFamily> TryFrom<Stored<F::Curve>> for Spline<F> {
    type Error = InputError;

    fn try_from(stored: Stored<F::Curve>) -> Result<Self, InputError> {
        let Stored { curve, tension, boundary } = stored;
        let polygon = crate::family::polygon_of_stored(curve.cubic(), &tension, boundary)?;
        Ok(Self { curve, tension, polygon })
    }
}

impl<F: SplineFamily> Spline<F> {
    /// The spline of given tension. Cost O(N).
    ///
    /// # Errors
    /// Tension out of range or of a wrong length; tangents that overflow.
    pub fn new(polygon: DataPolygon, tension: F::Tension<'_>) -> Result<Self, FitError> {
        let system = F::system(&polygon, tension)?;
        let legs = solve_legs(&system)?;
        let (curve, tension) = assemble::<F>(system, legs)?;
        Ok(Self { curve, tension, polygon })
    }

    /// The defaults of the search for this family.
    #[must_use]
    pub fn options() -> SearchOptions {
        SearchOptions { step: F::STEP, ..SearchOptions::default() }
    }

    /// The spline whose tension keeps the shape of the data.
    ///
    /// The fit says how it ended: the spline keeps the criteria if its status is `Solved`.
    ///
    /// # Errors
    /// Options outside their range; tangents that overflow.
    pub fn shape_preserving(
        polygon: DataPolygon,
        options: &SearchOptions,
    ) -> Result<Fit<Self>, FitError> {
        Self::shape_preserving_with(polygon, options, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`Spline::shape_preserving`], with a monitor that sees every step of the search and can end it.
    ///
    /// # Errors
    /// As [`Spline::shape_preserving`].
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
        let mut family = SolvedFamily::new(F::without_tension(&polygon))?;
        let found = search_and_report(&mut family, &polygon, options, monitor)?;
        let FittedLegs { legs, outcome, report } = found;
        let (curve, tension) = assemble::<F>(family.into_system(), legs)?;
        Ok(Fit { curve: Self { curve, tension, polygon }, outcome, report })
    }
}

/// The curve of a solved system, and its tension at each point.
fn assemble<F: SplineFamily>(
    system: F::System<'_>,
    legs: Vec<[DVec3; 2]>,
) -> Result<(F::Curve, Vec<f64>), InputError> {
    let is_closed = system.polygon().is_closed();
    let cubic = PiecewiseCubic::through(system.polygon(), legs)?;
    let (curve, tension) = F::curve(cubic, system)?;
    Ok((curve, repeat_first_if_closed(tension, is_closed)))
}

impl<F: SplineFamily> Interpolant for Spline<F> {
    type Curve = F::Curve;

    fn curve(&self) -> &F::Curve {
        &self.curve
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn polygon(&self) -> &DataPolygon {
        &self.polygon
    }
}
