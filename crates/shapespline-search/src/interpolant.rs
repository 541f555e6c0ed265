// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the curves of all families have in common.

use shapespline_criteria::{Checker, Criteria, ShapeReport, Tolerances};
use shapespline_geometry::{Boundary, Curve, DVec3, DataPolygon, InputError, Side};

/// A curve through points, with a tension at each of them.
pub trait Interpolant {
    /// How it is evaluated.
    type Curve: Curve;

    /// The curve itself: evaluation, segments, arc length.
    fn curve(&self) -> &Self::Curve;

    /// The tension at each point: 0 is none, and it grows.
    fn tension(&self) -> &[f64];

    /// The data: points, parameters and end conditions.
    fn polygon(&self) -> &DataPolygon;

    /// The end conditions.
    fn boundary(&self) -> Boundary {
        self.polygon().boundary()
    }

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

    /// Checks the curve against its own data. Cost O(N).
    ///
    /// # Errors
    /// Tolerances outside their range.
    fn check(&self, criteria: Criteria, tolerances: Tolerances) -> Result<ShapeReport, InputError> {
        let checker = Checker::new(self.polygon(), criteria, tolerances.validate()?);
        let legs = self.curve().cubic().legs();
        Ok(checker.report(|i| legs[i]))
    }
}

/// The polygon of a curve that was stored with its tension and its end conditions, all of it checked.
///
/// # Errors
/// Points and parameters that make no polygon; tension that is not one per point, negative or NaN.
#[cfg(feature = "serde")]
pub fn polygon_of_stored(
    cubic: &shapespline_geometry::PiecewiseCubic,
    tension: &[f64],
    boundary: Boundary,
) -> Result<DataPolygon, InputError> {
    let (argument, expected, found) = ("tension", cubic.points().len(), tension.len());
    if found != expected {
        return Err(InputError::Length { argument, expected, found, per: "one for each point" });
    }
    // 1/λ − 1 of a subnormal λ is infinite.
    if let Some(index) = tension.iter().position(|&x| !(x >= 0.0)) {
        let (value, allowed) = (tension[index], "non-negative");
        return Err(InputError::OutOfRange { argument, index, value, allowed });
    }
    cubic.polygon(boundary)
}
