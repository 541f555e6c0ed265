// SPDX-License-Identifier: MIT OR Apache-2.0

//! One cubic segment in Bézier form: the one segment type of all families.

use glam::DVec3;

use crate::quadrature::integrate;

/// Cubic Bézier segment, held as its first point and its legs `a, b, c` (differences of neighbouring
/// Bézier points): all shape questions depend on the legs alone.
///
/// The local parameter is `t ∈ [0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CubicSegment {
    /// First Bézier point `B_0`.
    pub start: DVec3,
    /// `B_1 − B_0`.
    pub a: DVec3,
    /// `B_2 − B_1`.
    pub b: DVec3,
    /// `B_3 − B_2`.
    pub c: DVec3,
}

impl CubicSegment {
    /// Segment from `start` to `end` whose first and last legs are given.
    #[inline]
    #[must_use]
    pub fn from_end_legs(start: DVec3, end: DVec3, a: DVec3, c: DVec3) -> Self {
        Self { start, a, b: (end - start) - a - c, c }
    }

    /// The four Bézier points.
    #[must_use]
    pub fn bezier_points(&self) -> [DVec3; 4] {
        let b1 = self.start + self.a;
        let b2 = b1 + self.b;
        [self.start, b1, b2, b2 + self.c]
    }

    /// The chord `a + b + c`.
    #[must_use]
    pub fn chord(&self) -> DVec3 {
        self.a + self.b + self.c
    }

    /// Position at `t`.
    #[must_use]
    pub fn position(&self, t: f64) -> DVec3 {
        let s = 1.0 - t;
        self.start
            + self.a * (t * (3.0 * s * s + 3.0 * s * t + t * t))
            + self.b * (t * t * (3.0 * s + t))
            + self.c * (t * t * t)
    }

    /// First, second and third derivatives with respect to `t`.
    #[inline]
    #[must_use]
    pub fn derivatives(&self, t: f64) -> [DVec3; 3] {
        let s = 1.0 - t;
        let (ab, bc) = (self.b - self.a, self.c - self.b);
        [
            (self.a * (s * s) + self.b * (2.0 * s * t) + self.c * (t * t)) * 3.0,
            (ab * s + bc * t) * 6.0,
            (bc - ab) * 6.0,
        ]
    }

    /// The quadratic `ω(t) = γ'(t) × γ''(t) = 18 [ω_0 (1−t)² + ω_m t(1−t) + ω_1 t²]`, as
    /// `[ω_0, ω_m, ω_1] = [a×b, a×c, b×c]`.
    #[inline]
    #[must_use]
    pub fn omega(&self) -> [DVec3; 3] {
        [self.a.cross(self.b), self.a.cross(self.c), self.b.cross(self.c)]
    }

    /// `det[a, b, c]`; `det[γ', γ'', γ''']` is 108 times this, constant on the segment, so torsion
    /// has one sign on it (paper 001, (4.16)).
    #[inline]
    #[must_use]
    pub fn determinant(&self) -> f64 {
        self.a.cross(self.b).dot(self.c)
    }

    /// `∫κ² ds`, by adaptive quadrature to about `accuracy` of itself; infinite at a cusp.
    ///
    /// Peaks of curvature at the ends are seen however narrow they are, those inside as far as halving
    /// meets them: for a guarantee see [`fairness`](crate::fairness()).
    #[must_use]
    pub fn bending(&self, accuracy: f64) -> f64 {
        let density = |t: f64| {
            let [d1, d2, _] = self.derivatives(t);
            let speed = d1.length();
            d1.cross(d2).length_squared() / (speed * speed * speed * speed * speed)
        };
        let negligible = 1e-3 * accuracy / (self.a + self.b + self.c).length();
        integrate(&density, [0.0, 1.0], accuracy, negligible)
    }

    /// The segment run through backwards.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start: self.bezier_points()[3], a: -self.c, b: -self.b, c: -self.a }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-2.0..2.0f64).prop_map(DVec3::from)
    }

    proptest! {
        #[test]
        fn omega_and_determinant_are_those_of_the_derivatives(
            (start, a, b, c) in (vector(), vector(), vector(), vector()), t in 0.0..1.0f64
        ) {
            let segment = CubicSegment { start, a, b, c };
            let [d1, d2, d3] = segment.derivatives(t);
            let [w0, wm, w1] = segment.omega();
            let omega = (w0 * (1.0 - t).powi(2) + wm * t * (1.0 - t) + w1 * t * t) * 18.0;
            prop_assert!((omega - d1.cross(d2)).length() < 1e-11);
            prop_assert!((108.0 * segment.determinant() - d1.cross(d2).dot(d3)).abs() < 1e-10);
        }

        #[test]
        fn position_is_de_casteljau(
            (start, a, b, c) in (vector(), vector(), vector(), vector()), t in 0.0..1.0f64
        ) {
            let segment = CubicSegment { start, a, b, c };
            let mut p = segment.bezier_points().to_vec();
            while p.len() > 1 {
                p = p.windows(2).map(|w| w[0] * (1.0 - t) + w[1] * t).collect();
            }
            prop_assert!((segment.position(t) - p[0]).length() < 1e-13);
            let back = segment.reversed().position(1.0 - t);
            prop_assert!((segment.position(t) - back).length() < 1e-13);
        }
    }
}
