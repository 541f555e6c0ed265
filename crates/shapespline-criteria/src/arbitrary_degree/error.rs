// SPDX-License-Identifier: MIT OR Apache-2.0

//! Why a curve of other origin is not judged.

use shapespline_geometry::InputError;

/// Why a curve cannot be judged by some points.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// Tolerances outside their range.
    #[error(transparent)]
    Input(#[from] InputError),
    /// Planar points and a spatial curve, or the reverse.
    #[error("points have {points} coordinates, the curve has {curve}")]
    Dimension {
        /// Coordinates of the points.
        points: usize,
        /// Coordinates of the curve.
        curve: usize,
    },
    /// Parameters of points where the curve is not defined.
    #[error("parameters[{index}] = {value} lies outside the curve's domain [{start}, {end}]")]
    Domain {
        /// Index of the parameter.
        index: usize,
        /// Its value.
        value: f64,
        /// Where the curve begins.
        start: f64,
        /// Where it ends.
        end: f64,
    },
    /// A point that the curve does not pass through.
    #[error(
        "the curve does not pass through points[{point}]: at parameter {parameter} it is \
         {distance:e} away, more than {allowed:e}"
    )]
    Mismatch {
        /// Index of the point.
        point: usize,
        /// Its parameter.
        parameter: f64,
        /// How far from it the curve passes.
        distance: f64,
        /// The distance allowed.
        allowed: f64,
    },
    /// Pieces that do not meet.
    #[error("the curve jumps by {distance:e} at parameter {parameter}, more than {allowed:e}")]
    Jump {
        /// The parameter.
        parameter: f64,
        /// The distance between the pieces' ends.
        distance: f64,
        /// The distance allowed.
        allowed: f64,
    },
}
