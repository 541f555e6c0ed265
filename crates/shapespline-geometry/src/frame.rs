//! Curvature, torsion and the Frenet frame from derivatives, for any scale of curve and parameter.

use glam::DVec3;

use crate::vector::{length, normalize};

/// The Frenet frame at a point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Unit tangent `T`.
    pub tangent: DVec3,
    /// Principal normal `N`; NaN where the curvature vanishes.
    pub normal: DVec3,
    /// Binormal `B = T × N`; NaN where the curvature vanishes.
    pub binormal: DVec3,
}

/// Curvature `‖γ' × γ''‖ / ‖γ'‖³`, reciprocal units of length; NaN where `γ' = 0`.
#[must_use]
pub fn curvature(first: DVec3, second: DVec3) -> f64 {
    let speed = length(first);
    length((first / speed).cross(second / speed)) / speed
}

/// Curvature vector `dT/ds`: the curvature times the principal normal, zero on a line.
#[must_use]
pub fn curvature_vector(first: DVec3, second: DVec3) -> DVec3 {
    let speed = length(first);
    let (tangent, change) = (first / speed, second / speed);
    (change - tangent * tangent.dot(change)) / speed
}

/// Torsion `det[γ', γ'', γ'''] / ‖γ' × γ''‖²`, reciprocal units of length; NaN where the curvature
/// vanishes.
#[must_use]
pub fn torsion(first: DVec3, second: DVec3, third: DVec3) -> f64 {
    // Unit vectors first, so that no product leaves the range of f64.
    let binormal = normalize(first).cross(normalize(second));
    let third_length = length(third);
    let determinant = if third_length == 0.0 { 0.0 } else { binormal.dot(third / third_length) };
    determinant / binormal.length_squared() * (third_length / length(second)) / length(first)
}

/// Frenet frame from the first two derivatives.
#[must_use]
pub fn frame(first: DVec3, second: DVec3) -> Frame {
    let tangent = first / length(first);
    let across = tangent.cross(normalize(second));
    let sine = across.length();
    // Below rounding the direction of the cross product is noise.
    let binormal = if sine > 1e-14 { across / sine } else { DVec3::NAN };
    Frame { tangent, normal: binormal.cross(tangent), binormal }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn helix_at_every_scale() {
        // (r cos θ, r sin θ, pθ): curvature r/(r²+p²), torsion p/(r²+p²).
        let (r, p, theta) = (2.0f64, 0.5f64, 0.7f64);
        for (points, parameter) in [(1.0, 1.0), (1e100, 1e-100), (1e-100, 1e100), (1e100, 1e100)] {
            let (sin, cos) = theta.sin_cos();
            let per = points / parameter;
            let first = DVec3::new(-r * sin, r * cos, p) * per;
            let second = DVec3::new(-r * cos, -r * sin, 0.0) * per / parameter;
            let third = DVec3::new(r * sin, -r * cos, 0.0) * per / parameter / parameter;
            let size = r * r + p * p;
            if !third.is_finite() || length(third) == 0.0 {
                continue;
            }
            assert!((curvature(first, second) * points / (r / size) - 1.0).abs() < 1e-13);
            assert!((torsion(first, second, third) * points / (p / size) - 1.0).abs() < 1e-13);
            let frame = frame(first, second);
            assert!((frame.normal - DVec3::new(-cos, -sin, 0.0)).length() < 1e-13);
            let along = curvature_vector(first, second) * points - frame.normal * (r / size);
            assert!(along.length() < 1e-13);
        }
    }

    #[test]
    fn a_line_has_no_normal() {
        let frame = frame(DVec3::X, DVec3::X * 3.0);
        assert_eq!(frame.tangent, DVec3::X);
        assert!(frame.normal.is_nan() && frame.binormal.is_nan());
        assert_eq!(curvature(DVec3::X, DVec3::X), 0.0);
        assert!(torsion(DVec3::X, DVec3::X, DVec3::Y).is_nan());
    }
}
