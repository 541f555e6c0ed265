//! The ν-spline interpolant.

use std::ops::ControlFlow;

use shapespline_criteria::{Checker, Criteria, ShapeReport, Tolerances};
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Domain, InputError, Parametrization, PiecewiseCubic,
};
use shapespline_search::{Fit, SearchOptions, Step, search};

use crate::{FitError, family::NuFamily};

/// Tension at the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tension<'a> {
    /// The same at every node.
    Uniform(f64),
    /// One number a point; for closed data the last is the first again.
    Nodes(&'a [f64]),
}

/// A ν-spline through points in the plane or in space. Immutable.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NuSpline {
    curve: PiecewiseCubic,
    tension: Vec<f64>,
    boundary: Boundary,
}

impl NuSpline {
    /// The ν-spline of given tension. Cost O(N).
    ///
    /// # Errors
    /// Tension that is negative, not finite, or not one a point; tangents that overflow.
    pub fn new(polygon: DataPolygon, tension: Tension<'_>) -> Result<Self, FitError> {
        let tension = nodal_tension(&polygon, tension)?;
        let (legs, tension) = NuFamily::new(&polygon, tension)?.finish();
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
        options.validate()?;
        let none = nodal_tension(&polygon, Tension::Uniform(0.0))?;
        let checker = Checker::new(&polygon, options.criteria, options.tolerances);
        let mut family = NuFamily::new(&polygon, none)?;
        let outcome = search(&mut family, &checker, options, monitor)?;
        let (legs, tension) = family.finish();
        let report = checker.report_of(&outcome.faults, |i| legs[i]);
        drop(checker);
        let curve = Self::assemble(polygon, legs, tension)?;
        Ok(Fit { curve, outcome, report })
    }

    /// The curve itself: evaluation, segments, arc length.
    #[must_use]
    pub fn curve(&self) -> &PiecewiseCubic {
        &self.curve
    }

    /// The tension `ν` at each point.
    #[must_use]
    pub fn tension(&self) -> &[f64] {
        &self.tension
    }

    /// The end conditions.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The tangents `q_i = Q'(u_i)` at the points.
    #[must_use]
    pub fn tangents(&self) -> Vec<DVec3> {
        let (knots, legs) = (self.curve.knots(), self.curve.legs());
        let n = legs.len();
        let at = |segment: usize, leg: usize| {
            legs[segment][leg] * 3.0 / (knots[segment + 1] - knots[segment])
        };
        (0..n).map(|i| at(i, 0)).chain([at(n - 1, 1)]).collect()
    }

    /// The data polygon of the curve.
    ///
    /// # Errors
    /// None for a curve made by this crate.
    pub fn polygon(&self) -> Result<DataPolygon, InputError> {
        DataPolygon::with_dimension(
            self.curve.points().to_vec(),
            self.curve.dimension(),
            &Parametrization::Given(self.curve.knots().to_vec()),
            self.boundary,
        )
    }

    /// Checks the curve against its own data. Cost O(N).
    ///
    /// # Errors
    /// Tolerances outside their range.
    pub fn check(
        &self,
        criteria: Criteria,
        tolerances: Tolerances,
    ) -> Result<ShapeReport, InputError> {
        let polygon = self.polygon()?;
        let checker = Checker::new(&polygon, criteria, tolerances.validate()?);
        Ok(checker.report(|i| self.curve.legs()[i]))
    }

    fn assemble(
        polygon: DataPolygon,
        legs: Vec<[DVec3; 2]>,
        mut tension: Vec<f64>,
    ) -> Result<Self, FitError> {
        let (boundary, dimension) = (polygon.boundary(), polygon.dimension());
        let domain = if polygon.is_closed() {
            tension.push(tension[0]);
            Domain::Closed
        } else {
            Domain::Open
        };
        let (points, knots) = polygon.into_points_and_parameters();
        let curve = PiecewiseCubic::new(knots, points, legs, dimension, domain)?;
        Ok(Self { curve, tension, boundary })
    }
}

/// Tension at each distinct node, checked.
fn nodal_tension(polygon: &DataPolygon, tension: Tension<'_>) -> Result<Vec<f64>, InputError> {
    const ALLOWED: &str = "non-negative and finite";
    let valid = |x: f64| x >= 0.0 && x.is_finite();
    match tension {
        Tension::Uniform(value) if valid(value) => Ok(vec![value; polygon.nodes()]),
        Tension::Uniform(value) => {
            Err(InputError::Scalar { argument: "tension", value, allowed: ALLOWED })
        }
        Tension::Nodes(values) => {
            let expected = polygon.points().len();
            if values.len() != expected {
                let (argument, found) = ("tension", values.len());
                let per = "one for each point";
                return Err(InputError::Length { argument, expected, found, per });
            }
            let wrong = |index: usize, allowed| InputError::OutOfRange {
                argument: "tension",
                index,
                value: values[index],
                allowed,
            };
            if let Some(index) = values.iter().position(|&x| !valid(x)) {
                return Err(wrong(index, ALLOWED));
            }
            if polygon.is_closed() && values[expected - 1] != values[0] {
                return Err(wrong(expected - 1, "equal to tension[0] for boundary \"periodic\""));
            }
            Ok(values[..polygon.nodes()].to_vec())
        }
    }
}
