// SPDX-License-Identifier: MIT OR Apache-2.0

//! What every curve can be asked, whatever its parameter means.

use glam::DVec3;

use crate::{Frame, InputError, PiecewiseCubic, Side};

/// A curve whose image is a piecewise cubic, run through in a parameter `u` of its own.
///
/// What belongs to the image alone — curvature, torsion, the Frenet frame, arc length
/// ([`crate::ArcLength`]), Bézier form — is answered from the cubic segments, so it is the same for
/// every parametrisation and does not suffer from a steep one.
pub trait Curve: Send + Sync {
    /// The image: points, legs, knots.
    fn cubic(&self) -> &PiecewiseCubic;

    /// Segment and Bézier parameter `t` of a parameter; at a knot the segment on `side`.
    fn locate(&self, u: f64, side: Side) -> (usize, f64);

    /// The parameter at Bézier parameter `t ∈ [0, 1]` of a segment.
    fn parameter(&self, segment: usize, t: f64) -> f64;

    /// Derivative of order `order` (0: position) with respect to `u`.
    fn evaluate(&self, u: f64, order: usize, side: Side) -> DVec3;

    /// Derivatives of order `order` at many parameters, row by row, with as many columns as the curve
    /// has coordinates, into room that the caller has.
    ///
    /// # Errors
    /// An order the curve does not have; room for more or fewer rows.
    fn evaluate_into(
        &self,
        u: &[f64],
        order: usize,
        side: Side,
        out: &mut [f64],
    ) -> Result<(), InputError>;

    /// [`Self::evaluate_into`] new room.
    ///
    /// # Errors
    /// An order the curve does not have.
    fn evaluate_many(&self, u: &[f64], order: usize, side: Side) -> Result<Vec<f64>, InputError> {
        let mut out = vec![0.0; u.len() * self.cubic().dimension().count()];
        self.evaluate_into(u, order, side, &mut out)?;
        Ok(out)
    }

    /// First, second and third derivatives with respect to `u`.
    fn derivatives(&self, u: f64, side: Side) -> [DVec3; 3] {
        [1, 2, 3].map(|order| self.evaluate(u, order, side))
    }

    /// Curvature, in reciprocal units of length.
    fn curvature(&self, u: f64, side: Side) -> f64 {
        let (segment, t) = self.locate(u, side);
        self.cubic().segment(segment).curvature(t)
    }

    /// Curvature times the principal normal.
    fn curvature_vector(&self, u: f64, side: Side) -> DVec3 {
        let (segment, t) = self.locate(u, side);
        self.cubic().segment(segment).curvature_vector(t)
    }

    /// Torsion, in reciprocal units of length; NaN where the curvature vanishes.
    fn torsion(&self, u: f64, side: Side) -> f64 {
        let (segment, t) = self.locate(u, side);
        self.cubic().segment(segment).torsion(t)
    }

    /// The Frenet frame.
    fn frame(&self, u: f64, side: Side) -> Frame {
        let (segment, t) = self.locate(u, side);
        self.cubic().segment(segment).frame(t)
    }
}
