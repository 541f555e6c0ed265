// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the curves of all families have in common.

use shapespline_criteria::{Checker, Criteria, ShapeReport, Tolerances};
use shapespline_geometry::{
    Boundary, Curve, DVec3, DataPolygon, InputError, Parametrization, Side,
};

/// A curve through points, with a tension at each of them.
pub trait Interpolant {
    /// How it is evaluated.
    type Curve: Curve;

    /// The curve itself: evaluation, segments, arc length.
    fn curve(&self) -> &Self::Curve;

    /// The tension at each point: 0 is none, and it grows.
    fn tension(&self) -> &[f64];

    /// The end conditions.
    fn boundary(&self) -> Boundary;

    /// The tangents at the points, derivatives with respect to the parameter (where the speed jumps,
    /// that of the segment after; at the end of the last segment its own).
    fn tangents(&self) -> Vec<DVec3> {
        let knots = self.curve().cubic().knots();
        let at = |i: usize| {
            let side = if i + 1 == knots.len() { Side::Left } else { Side::Right };
            self.curve().evaluate(knots[i], 1, side)
        };
        (0..knots.len()).map(at).collect()
    }

    /// The data polygon of the curve.
    ///
    /// # Errors
    /// None for a curve made by this project.
    fn polygon(&self) -> Result<DataPolygon, InputError> {
        let cubic = self.curve().cubic();
        DataPolygon::with_dimension(
            cubic.points().to_vec(),
            cubic.dimension(),
            &Parametrization::Given(cubic.knots().to_vec()),
            self.boundary(),
        )
    }

    /// Checks the curve against its own data. Cost O(N).
    ///
    /// # Errors
    /// Tolerances outside their range.
    fn check(&self, criteria: Criteria, tolerances: Tolerances) -> Result<ShapeReport, InputError> {
        let polygon = self.polygon()?;
        let checker = Checker::new(&polygon, criteria, tolerances.validate()?);
        let legs = self.curve().cubic().legs();
        Ok(checker.report(|i| legs[i]))
    }
}
