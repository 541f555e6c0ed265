// SPDX-License-Identifier: MIT OR Apache-2.0

//! Values of a piecewise cubic: the one formula of all families.

use std::array;

use glam::DVec3;

use crate::{
    Curve, InputError, PiecewiseCubic, Side,
    evaluate_many::{Evaluate, Locals, check_rows},
};

impl PiecewiseCubic {
    /// First, second and third derivatives with respect to `u`.
    #[must_use]
    pub fn derivatives(&self, u: f64, side: Side) -> [DVec3; 3] {
        let (i, t) = self.locate(u, side);
        let h = self.knots[i + 1] - self.knots[i];
        let [d1, d2, d3] = self.segment(i).derivatives(t);
        [d1 / h, d2 / h / h, d3 / h / h / h]
    }

    /// Derivative of order `order` (0: position) at one parameter. Cost O(log N).
    #[must_use]
    pub fn evaluate(&self, u: f64, order: usize, side: Side) -> DVec3 {
        let (i, t) = self.locate(u, side);
        let t = [1.0 - t, t];
        match order {
            0 => self.derivative_at::<0>(i, t),
            1 => self.derivative_at::<1>(i, t),
            2 => self.derivative_at::<2>(i, t),
            3 => self.derivative_at::<3>(i, t),
            _ => self.derivative_at::<4>(i, t),
        }
    }

    /// Derivatives of order `order` at many parameters, row by row, with as many columns as the curve
    /// has coordinates.
    ///
    /// Sorted parameters cost O(1) each, unsorted ones O(1) through a bucket table (made once, when
    /// there are many); large batches run on all threads.
    #[must_use]
    pub fn evaluate_many(&self, u: &[f64], order: usize, side: Side) -> Vec<f64> {
        let mut out = vec![0.0; u.len() * self.dimension.count()];
        self.fill(u, order, side, &mut out);
        out
    }

    /// The same into room for a row a parameter.
    fn fill(&self, u: &[f64], order: usize, side: Side, out: &mut [f64]) {
        match order {
            0 => self.values::<0>(u, side, out),
            1 => self.values::<1>(u, side, out),
            2 => self.values::<2>(u, side, out),
            3 => self.values::<3>(u, side, out),
            _ => self.values::<4>(u, side, out),
        }
    }

    /// Derivative with respect to `u` of a segment at `[1 − t, t]`.
    #[inline(always)]
    pub(crate) fn derivative_at<const ORDER: usize>(&self, i: usize, local: [f64; 2]) -> DVec3 {
        let (p, q, [a, c]) = (self.points[i], self.points[i + 1], self.legs[i]);
        let h = self.knots[i + 1] - self.knots[i];
        let coordinate = |p, q, a, c| coordinate::<ORDER>([p, q, a, c], h, local);
        DVec3::new(
            coordinate(p.x, q.x, a.x, c.x),
            coordinate(p.y, q.y, a.y, c.y),
            coordinate(p.z, q.z, a.z, c.z),
        )
    }
}

/// One coordinate of a derivative at `[1 − t, t]`, of the end points `p`, `q` and the end legs `a`, `c`, as weights of
/// them.
#[inline(always)]
fn coordinate<const ORDER: usize>([p, q, a, c]: [f64; 4], h: f64, [s, t]: [f64; 2]) -> f64 {
    if ORDER == 0 {
        // Exact at both ends, and the same run through backwards.
        let (ss, tt) = (s * s, t * t);
        return (p * (ss * (s + 3.0 * t)) + q * (tt * (t + 3.0 * s)))
            + (a * (3.0 * ss * t) - c * (3.0 * s * tt));
    }
    let reciprocal = 1.0 / h;
    let b = (q - p) - a - c;
    match ORDER {
        1 => (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * (3.0 * reciprocal),
        2 => ((b - a) * s + (c - b) * t) * (6.0 * reciprocal) * reciprocal,
        // `t` enters only to hand a NaN on.
        3 => {
            let third = (c - b) - (b - a) + 0.0 * t.clamp(-1.0, 1.0);
            third * (6.0 * reciprocal) * reciprocal * reciprocal
        }
        _ => 0.0 * t.clamp(-1.0, 1.0),
    }
}

impl Evaluate for PiecewiseCubic {
    fn image(&self) -> &PiecewiseCubic {
        self
    }

    #[inline(always)]
    fn locals(&self, segment: impl Fn(usize) -> usize, u: &[f64], out: &mut Locals) {
        for (j, (&u, out)) in u.iter().zip(out).enumerate() {
            let t = self.local(segment(j), u);
            *out = [1.0 - t, t];
        }
    }

    #[inline(always)]
    fn derivative<const ORDER: usize>(&self, segment: usize, local: [f64; 2]) -> DVec3 {
        self.derivative_at::<ORDER>(segment, local)
    }

    #[inline(always)]
    fn run<const ORDER: usize, const COLUMNS: usize>(
        &self,
        i: usize,
        locals: &[[f64; 2]],
        out: &mut [[f64; COLUMNS]],
    ) {
        let [p, q] = [self.points[i].to_array(), self.points[i + 1].to_array()];
        let [a, c] = self.legs[i].map(|leg| leg.to_array());
        let h = self.knots[i + 1] - self.knots[i];
        for (out, &local) in out.iter_mut().zip(locals) {
            *out = array::from_fn(|k| coordinate::<ORDER>([p[k], q[k], a[k], c[k]], h, local));
        }
    }
}

impl Curve for PiecewiseCubic {
    fn cubic(&self) -> &PiecewiseCubic {
        self
    }

    fn locate(&self, u: f64, side: Side) -> (usize, f64) {
        self.locate(u, side)
    }

    fn parameter(&self, segment: usize, t: f64) -> f64 {
        self.knots[segment] + t * (self.knots[segment + 1] - self.knots[segment])
    }

    fn evaluate(&self, u: f64, order: usize, side: Side) -> DVec3 {
        self.evaluate(u, order, side)
    }

    fn evaluate_into(
        &self,
        u: &[f64],
        order: usize,
        side: Side,
        out: &mut [f64],
    ) -> Result<(), InputError> {
        check_rows(self, u, out)?;
        self.fill(u, order, side, out);
        Ok(())
    }
}
