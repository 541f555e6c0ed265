// SPDX-License-Identifier: MIT OR Apache-2.0

//! Curvature, torsion and the Frenet frame of a segment.
//!
//! All come from the Bézier legs, not from derivatives: near a node under high tension `γ'` is all but
//! zero, and a determinant of derivatives has no correct digit left there (at a tension of 1e7 the
//! torsion was wrong in its fifth), while `a × b`, `a × c`, `b × c` keep theirs.

use glam::DVec3;

use crate::{CubicSegment, vector::power_of_two};

/// The Frenet frame at a point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Unit tangent `T`; NaN where `γ' = 0`.
    pub tangent: DVec3,
    /// Principal normal `N`; NaN where the curvature vanishes.
    pub normal: DVec3,
    /// Binormal `B = T × N`; NaN where the curvature vanishes.
    pub binormal: DVec3,
}

/// `γ'` and `ω = γ' × γ''` at a parameter, in a unit of length that brings the largest leg near one,
/// so that no product leaves the range of f64.
struct Motion {
    unit: f64,
    velocity: DVec3,
    omega: DVec3,
    determinant: f64,
}

impl CubicSegment {
    fn motion(&self, t: f64) -> Motion {
        let largest = self.a.abs().max(self.b.abs()).max(self.c.abs()).max_element();
        let unit = power_of_two(largest);
        let (start, a, b, c) = (DVec3::ZERO, self.a / unit, self.b / unit, self.c / unit);
        let scaled = Self { start, a, b, c };
        let s = 1.0 - t;
        let [first, middle, last] = scaled.omega();
        Motion {
            unit,
            velocity: (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * 3.0,
            omega: (first * (s * s) + middle * (s * t) + last * (t * t)) * 18.0,
            determinant: 108.0 * scaled.determinant(),
        }
    }

    /// Curvature `‖γ' × γ''‖ / ‖γ'‖³` at `t`, in reciprocal units of length; NaN where `γ' = 0`.
    #[must_use]
    pub fn curvature(&self, t: f64) -> f64 {
        let m = self.motion(t);
        let speed = m.velocity.length();
        m.omega.length() / speed / speed / speed / m.unit
    }

    /// Curvature vector `dT/ds` at `t`: the curvature times the principal normal, zero on a line.
    #[must_use]
    pub fn curvature_vector(&self, t: f64) -> DVec3 {
        let m = self.motion(t);
        let speed = m.velocity.length();
        // (γ' × γ'') × γ' / ‖γ'‖⁴
        (m.omega / speed / speed).cross(m.velocity / speed) / speed / m.unit
    }

    /// Torsion `det[γ', γ'', γ'''] / ‖γ' × γ''‖²` at `t`, in reciprocal units of length; NaN where the
    /// curvature vanishes.
    #[must_use]
    pub fn torsion(&self, t: f64) -> f64 {
        let m = self.motion(t);
        let size = m.omega.length();
        m.determinant / size / size / m.unit
    }

    /// Frenet frame at `t`.
    #[must_use]
    pub fn frame(&self, t: f64) -> Frame {
        let m = self.motion(t);
        let (speed, size) = (m.velocity.length(), m.omega.length());
        let tangent = m.velocity / speed;
        // Below the rounding of the legs, which are of size one, the direction of ω is noise.
        let known = size > 16.0 * f64::EPSILON * speed;
        let binormal = if known { m.omega / size } else { DVec3::NAN };
        Frame { tangent, normal: binormal.cross(tangent), binormal }
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
        fn formulas_at_every_scale((a, b, c) in (vector(), vector(), vector()), t in 0.0..1.0f64, exponent in -100i32..=100) {
            let scale = 10f64.powi(exponent);
            let segment = |scale: f64| CubicSegment { start: DVec3::ZERO, a: a * scale, b: b * scale, c: c * scale };
            let scaled = segment(scale);
            let [first, second, third] = segment(1.0).derivatives(t);
            let omega = first.cross(second);
            prop_assume!(omega.length() > 1e-3 && first.length() > 1e-2);
            let curvature = omega.length() / first.length().powi(3);
            let torsion = omega.dot(third) / omega.length_squared();
            prop_assert!((scaled.curvature(t) * scale - curvature).abs() <= 1e-10 * curvature);
            prop_assert!((scaled.torsion(t) * scale - torsion).abs() <= 1e-8 * (1.0 + torsion.abs()));
            let frame = scaled.frame(t);
            prop_assert!((frame.tangent - first.normalize()).length() < 1e-12);
            prop_assert!((frame.binormal - omega.normalize()).length() < 1e-9);
            prop_assert!((frame.tangent.cross(frame.normal) - frame.binormal).length() < 1e-12);
            let vector = scaled.curvature_vector(t) * scale;
            prop_assert!((vector - frame.normal * curvature).length() <= 1e-9 * curvature);
        }
    }

    #[test]
    fn a_parabola_has_its_curvature_and_no_torsion() {
        // (t, t²): Bézier points (0, 0), (1/3, 0), (2/3, 1/3), (1, 1).
        let leg = |x: f64, y: f64| DVec3::new(x, y, 0.0) / 3.0;
        let (a, b, c) = (leg(1.0, 0.0), leg(1.0, 1.0), leg(1.0, 2.0));
        let parabola = CubicSegment { start: DVec3::ZERO, a, b, c };
        for t in [0.0, 0.3, 1.0f64] {
            let expected = 2.0 / (1.0 + 4.0 * t * t).powf(1.5);
            assert!((parabola.curvature(t) - expected).abs() < 1e-15);
            assert_eq!(parabola.torsion(t), 0.0);
        }
    }

    #[test]
    fn torsion_keeps_its_digits_where_the_curve_all_but_stands_still() {
        // A twisted segment whose end legs are 1e-12 of its chord; at its start the torsion is
        // det/(18‖a×b‖²)·108 with a×b = a×L and det = det[a, L, c] to twelve digits.
        let (chord, tiny) = (DVec3::X, 1e-12);
        let (a, c) = (DVec3::new(1.0, 1.0, 0.0) * tiny, DVec3::new(1.0, 0.0, 1.0) * tiny);
        let segment = CubicSegment::from_end_legs(DVec3::ZERO, chord, a, c);
        let omega = 18.0 * a.cross(chord).length();
        let expected = 108.0 * a.cross(chord).dot(c) / omega / omega;
        assert!((segment.torsion(0.0) / expected - 1.0).abs() < 1e-10);
    }

    #[test]
    fn a_line_has_no_normal() {
        let third = DVec3::new(1.0, 2.0, 3.0) / 3.0;
        let line = CubicSegment { start: DVec3::ZERO, a: third, b: third, c: third };
        let frame = line.frame(0.4);
        assert!((frame.tangent - third.normalize()).length() < 1e-15);
        assert!(frame.normal.is_nan() && frame.binormal.is_nan());
        assert_eq!(line.curvature(0.4), 0.0);
        assert!(line.torsion(0.4).is_nan());
    }
}
