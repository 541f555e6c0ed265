// SPDX-License-Identifier: MIT OR Apache-2.0

//! The Catmull–Rom interpolant.

use std::ops::ControlFlow;

use shapespline_criteria::{Criteria, ShapeReport, Tolerances};
use shapespline_geometry::{DVec3, DataPolygon, InputError, PiecewiseCubic};
use shapespline_polynomial::parallel;
use shapespline_search::{
    Fit, FitError, Interpolant, Outcome, SearchOptions, Step, Tension,
    family::{repeat_first_if_closed, search_and_report},
};

use crate::{
    handles::Handles,
    parts::{Checked, limited},
};

/// What is continuous at the points besides the direction of the tangent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Continuity {
    /// The derivative: one handle scale a node.
    #[default]
    C1,
    /// The direction only: each segment has handles of its own.
    G1,
}

/// Which tangent directions, strictly between the chords, a shape-preserving curve has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Directions {
    /// Those that make the two angles of each segment with its chord alike, so that neither handle
    /// has to be short. One tridiagonal system per step of Gauss and Newton's method.
    #[default]
    Balanced,
    /// Those of the parametrisation, as without tension: local.
    Parametrization,
}

/// What to keep, and how closely to go to the bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandleOptions {
    /// The criteria to keep.
    pub criteria: Criteria,
    /// Their tolerances.
    pub tolerances: Tolerances,
    /// The part of each bound that a handle may have, in `(0, 1)`.
    pub safety: f64,
    /// Whether the two handles at a node have one scale.
    pub continuity: Continuity,
    /// The directions of the tangents.
    pub directions: Directions,
}

impl Default for HandleOptions {
    fn default() -> Self {
        Self {
            criteria: Criteria::OF_FITS,
            tolerances: Tolerances::default(),
            safety: 0.9,
            continuity: Continuity::C1,
            directions: Directions::default(),
        }
    }
}

impl HandleOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// A tolerance or `safety` outside its range, NaN included.
    pub fn validate(&self) -> Result<(), InputError> {
        self.tolerances.validate()?;
        if !(self.safety > 0.0 && self.safety < 1.0) {
            let (argument, value) = ("safety", self.safety);
            return Err(InputError::Scalar { argument, value, allowed: "in (0, 1)" });
        }
        Ok(())
    }
}

/// A Catmull–Rom curve through points in the plane or in space. Immutable.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct CatmullRom {
    curve: PiecewiseCubic,
    tension: Vec<f64>,
    /// Points and parameters are stored with the curve.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "boundary", serialize_with = "DataPolygon::serialize_boundary")
    )]
    polygon: DataPolygon,
    continuity: Continuity,
}

/// The stored form, which may come from anywhere: checked as far as anything could go wrong later.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "CatmullRom")]
struct Stored {
    curve: PiecewiseCubic,
    tension: Vec<f64>,
    boundary: shapespline_geometry::Boundary,
    continuity: Continuity,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for CatmullRom {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        let Stored { curve, tension, boundary, continuity } = stored;
        let polygon = shapespline_search::family::polygon_of_stored(&curve, &tension, boundary)?;
        Ok(Self { curve, tension, polygon, continuity })
    }
}

impl CatmullRom {
    /// The Catmull–Rom curve of given (cardinal) tension: handles shortened by this part. Cost O(N).
    ///
    /// # Errors
    /// Tension outside `[0, 1)` or not one a point; legs that overflow.
    pub fn new(
        polygon: DataPolygon,
        tension: Tension<'_>,
        continuity: Continuity,
    ) -> Result<Self, FitError> {
        let valid = |x: f64| (0.0..1.0).contains(&x);
        let tension = tension.nodal(&polygon, "tension", "in [0, 1)", valid)?;
        let factors = tension.iter().map(|t| 1.0 - t).collect();
        let legs = Handles::new(&polygon, factors).into_legs();
        Self::assemble(polygon, legs, false, tension, continuity)
    }

    /// The Catmull–Rom curve with the largest handles that keep the shape of the data.
    ///
    /// Closed forms bound the handles; a complete check follows, and the tension search where it
    /// finds what closed forms do not decide. The fit says how it ended: the curve keeps the criteria
    /// if its status is `Solved`. Cost O(N).
    ///
    /// # Errors
    /// Options outside their range; legs that overflow.
    pub fn shape_preserving(
        polygon: DataPolygon,
        options: &HandleOptions,
    ) -> Result<Fit<Self>, FitError> {
        Self::shape_preserving_with(polygon, options, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`CatmullRom::shape_preserving`], with a monitor that sees every step of the tension search
    /// (which most data do not need) and can end it.
    ///
    /// # Errors
    /// As [`CatmullRom::shape_preserving`].
    pub fn shape_preserving_with(
        polygon: DataPolygon,
        options: &HandleOptions,
        monitor: &mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Result<Fit<Self>, FitError> {
        options.validate()?;
        let HandleOptions { criteria, tolerances, continuity, .. } = *options;
        let mut checked = limited(&polygon, options)?;
        if !checked.found.violations.is_empty() && options.directions == Directions::Balanced {
            // Planes known only to the tolerance: shorter handles mend them along the
            // parametrisation's directions, along others perhaps not.
            let local = HandleOptions { directions: Directions::Parametrization, ..*options };
            checked = limited(&polygon, &local)?;
        }
        let Checked { mut legs, mut factors, found } = checked;
        let mut checked = !found.cramped;
        let (mut outcome, report) = if found.violations.is_empty() {
            (Outcome::solved(), ShapeReport::clean(legs.len(), criteria, found.applicable))
        } else {
            // What the closed forms leave: coplanarity, and what rounding violates.
            let mut handles = Handles::under_tension(&polygon, legs, factors);
            let rest =
                SearchOptions { criteria, tolerances, step: 0.25, ..SearchOptions::default() };
            let found = search_and_report(&mut handles, &polygon, &rest, monitor)?;
            (legs, factors) = (found.legs, handles.into_factors());
            checked = false;
            (found.outcome, found.report)
        };
        let (tension, shortened) = tensions(factors);
        outcome.diagnostics.nodes_changed = shortened;
        let curve = Self::assemble(polygon, legs, checked, tension, continuity)?;
        Ok(Fit { curve, outcome, report })
    }

    /// What is continuous at the points.
    #[must_use]
    pub fn continuity(&self) -> Continuity {
        self.continuity
    }

    /// `checked`: whether the legs are known to be finite and of a size that curves can have.
    fn assemble(
        polygon: DataPolygon,
        legs: Vec<[DVec3; 2]>,
        checked: bool,
        tension: Vec<f64>,
        continuity: Continuity,
    ) -> Result<Self, FitError> {
        let tension = repeat_first_if_closed(tension, polygon.is_closed());
        let curve = if checked {
            PiecewiseCubic::through_checked(&polygon, legs)
        } else {
            PiecewiseCubic::through(&polygon, legs)?
        };
        Ok(Self { curve, tension, polygon, continuity })
    }
}

/// Nodes from which on factors are turned into tensions on all threads.
const MANY: usize = 65_536;

/// The tension at each node, of the factor that is left of its handles; and how many were shortened.
fn tensions(mut factors: Vec<f64>) -> (Vec<f64>, usize) {
    let turn = |(): &mut (), _, factors: &mut [f64]| {
        let mut shortened = 0;
        for factor in factors {
            *factor = 1.0 - *factor;
            shortened += usize::from(*factor > 0.0);
        }
        shortened
    };
    let shortened: Vec<usize> = parallel::parts(&mut *factors, MANY / 8, MANY, || (), turn);
    (factors, shortened.into_iter().sum())
}

impl Interpolant for CatmullRom {
    type Curve = PiecewiseCubic;

    fn curve(&self) -> &PiecewiseCubic {
        &self.curve
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn polygon(&self) -> &DataPolygon {
        &self.polygon
    }
}
