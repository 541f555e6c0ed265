// SPDX-License-Identifier: MIT OR Apache-2.0

//! The C² tension cubic interpolant.

use std::ops::ControlFlow;

#[cfg(feature = "serde")]
use shapespline_geometry::Curve;
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, InputError, PiecewiseCubic, ReparametrizedCubic,
};
use shapespline_search::{
    Fit, FitError, FittedLegs, Interpolant, SearchOptions, SolvedFamily, Step, Tension,
    or_of_all_criteria, repeat_first_if_closed, search_and_report, solve_legs,
};

use crate::system::ManniSystem;

/// The scale `λ` of tangents in legs, each between `1e−65` and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TangentScale<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One number a point; for closed data the last is the first again.
    Nodes(&'a [f64]),
    /// `λ⁰` and `λ¹`, each one number a segment.
    Segments(&'a [f64], &'a [f64]),
}

const ALLOWED: &str = "between 1e-65 and 1";
/// The least `λ`: third derivatives grow as its fourth power falls, and have to stay finite.
const LEAST: f64 = 1e-65;

impl TangentScale<'_> {
    /// `[λ⁰, λ¹]` of each segment, checked.
    fn slopes(self, polygon: &DataPolygon) -> Result<Vec<[f64; 2]>, InputError> {
        const ARGUMENT: &str = "tangent_scale";
        let valid = |x: f64| (LEAST..=1.0).contains(&x);
        let nodal = |tension: Tension<'_>| {
            let nodes = tension.nodal(polygon, ARGUMENT, ALLOWED, valid)?;
            let end = |i: usize| nodes[(i + 1) % nodes.len()];
            Ok((0..polygon.segments()).map(|i| [nodes[i], end(i)]).collect())
        };
        let (starts, ends) = match self {
            Self::Uniform(value) => return nodal(Tension::Uniform(value)),
            Self::Nodes(values) => return nodal(Tension::Nodes(values)),
            Self::Segments(starts, ends) => (starts, ends),
        };
        for (argument, values) in [("tangent_scale[0]", starts), ("tangent_scale[1]", ends)] {
            let (expected, found) = (polygon.segments(), values.len());
            if found != expected {
                let per = "one for each segment";
                return Err(InputError::Length { argument, expected, found, per });
            }
            if let Some(index) = values.iter().position(|&x| !valid(x)) {
                let (value, allowed) = (values[index], ALLOWED);
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
        }
        Ok(starts.iter().zip(ends).map(|(&start, &end)| [start, end]).collect())
    }
}

/// A C² tension cubic through points in the plane or in space. Immutable.
///
/// Its parameter is Manni's `s`: equal to the data's parameters at the points, and such that the
/// curve is C² in it. The image alone, run through linearly on each segment, is
/// `curve().cubic()`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct TensionSpline {
    curve: ReparametrizedCubic,
    tension: Vec<f64>,
    boundary: Boundary,
}

/// What was stored, by whomever: checked as far as anything could go wrong later.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "TensionSpline")]
struct Stored {
    curve: ReparametrizedCubic,
    tension: Vec<f64>,
    boundary: Boundary,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for TensionSpline {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        let Stored { curve, tension, boundary } = stored;
        shapespline_search::check_stored(&tension, curve.cubic())?;
        Ok(Self { curve, tension, boundary })
    }
}

impl TensionSpline {
    /// The tension cubic of given `λ`. Cost O(N).
    ///
    /// # Errors
    /// `λ` out of range or of a wrong length; tangents that overflow.
    pub fn new(polygon: DataPolygon, scale: TangentScale<'_>) -> Result<Self, FitError> {
        let slopes = scale.slopes(&polygon)?;
        let system = ManniSystem::new(&polygon, slopes);
        let legs = solve_legs(&system)?;
        let (slopes, tension) = system.into_parts();
        Self::assemble(polygon, legs, slopes, tension)
    }

    /// The defaults of the search for this family: growth of `1/λ − 1` begins at 0.25.
    #[must_use]
    pub fn options() -> SearchOptions {
        SearchOptions { step: 0.25, ..SearchOptions::default() }
    }

    /// The tension cubic whose `λ` keep the shape of the data.
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

    /// As [`TensionSpline::shape_preserving`], with a monitor that sees every step of the search and
    /// can end it.
    ///
    /// # Errors
    /// As [`TensionSpline::shape_preserving`].
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
        let mut family = SolvedFamily::new(ManniSystem::without_tension(&polygon))?;
        let found = search_and_report(&mut family, &polygon, options, monitor)?;
        let (FittedLegs { legs, outcome, report }, system) = (found, family.into_system());
        let (slopes, tension) = system.into_parts();
        let curve = Self::assemble(polygon, legs, slopes, tension)?;
        Ok(Fit { curve, outcome, report })
    }

    /// `[λ⁰, λ¹]` of each segment.
    #[must_use]
    pub fn tangent_scale(&self) -> &[[f64; 2]] {
        self.curve.slopes()
    }

    fn assemble(
        polygon: DataPolygon,
        legs: Vec<[DVec3; 2]>,
        slopes: Vec<[f64; 2]>,
        tension: Vec<f64>,
    ) -> Result<Self, FitError> {
        let boundary = polygon.boundary();
        let tension = repeat_first_if_closed(tension, polygon.is_closed());
        let cubic = PiecewiseCubic::through(polygon, legs)?;
        Ok(Self { curve: ReparametrizedCubic::new(cubic, slopes)?, tension, boundary })
    }
}

impl Interpolant for TensionSpline {
    type Curve = ReparametrizedCubic;

    fn curve(&self) -> &ReparametrizedCubic {
        &self.curve
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn boundary(&self) -> Boundary {
        self.boundary
    }
}
