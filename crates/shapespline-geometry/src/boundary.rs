// SPDX-License-Identifier: MIT OR Apache-2.0

//! Conditions at the ends of a curve.

use glam::DVec3;

use crate::{
    Coordinates, Dimension, InputError,
    vector::{length, normalize},
};

/// Condition at the two ends of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Boundary {
    /// Zero curvature at both ends (`"zero-curvature"`, `"natural"`).
    ZeroCurvature,
    /// Closed data (`I_N = I_0`), all continuity conditions at every node.
    Periodic,
    /// End tangents of the circles through the first three and the last three points.
    Circular,
    /// Given end tangents: derivatives with respect to the parameter, any non-zero vectors. An end without
    /// one has zero curvature.
    Tangents {
        /// `D_0`, the tangent at the first point.
        start: Option<DVec3>,
        /// `D_N`, the tangent at the last point.
        end: Option<DVec3>,
    },
}

impl Boundary {
    /// Given tangents at both ends or at one.
    #[must_use]
    pub fn tangents(start: impl Into<Option<DVec3>>, end: impl Into<Option<DVec3>>) -> Self {
        Self::Tangents { start: start.into(), end: end.into() }
    }
}

/// The tangent at `p` of the circle through `p, q, r` (passed in this order), with the speed at
/// which the arc from `p` to `q` is run through in the parameter spacing `h`.
///
/// Where the three lie on a line the tangent is the chord `(q − p) / h`; where they double back the
/// circle is infinite and the chord is taken too.
pub(crate) fn circle_tangent(p: DVec3, q: DVec3, r: DVec3, h: f64) -> DVec3 {
    let chord = q - p;
    let along = normalize(chord);
    // The angle between chord and tangent is the inscribed angle at `r` (paper 001, Example 1).
    let (to_p, to_q) = (normalize(p - r), normalize(q - r));
    let sine = to_p.cross(to_q).length();
    let angle = sine.atan2(to_p.dot(to_q));
    let beyond = r - q;
    let across = normalize(beyond - along * beyond.dot(along));
    if sine < 1e-9 || across == DVec3::ZERO {
        return chord / h;
    }
    let speed = length(chord) / h * (angle / sine);
    (along * angle.cos() - across * sine) * speed
}

pub(crate) fn check_tangent(
    end: &'static str,
    value: DVec3,
    dimension: Dimension,
) -> Result<(), InputError> {
    if let Some(index) = value.to_array().iter().position(|v| !v.is_finite()) {
        let value = value[index];
        let argument = if end == "start" { "boundary.start" } else { "boundary.end" };
        return Err(InputError::NotFinite { argument, index, value });
    }
    if value == DVec3::ZERO {
        let value = Coordinates { vector: value, dimension };
        return Err(InputError::ZeroTangent { end, value });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circle_gives_its_own_tangent_and_speed() {
        for (t1, t2) in [(0.3, 0.9), (1.5, 4.0), (2.5, 5.9), (4.0, 5.0)] {
            let at = |t: f64| DVec3::new(2.0 * t.cos(), 1.0, 2.0 * t.sin());
            let tangent = circle_tangent(at(0.0), at(t1), at(t2), t1);
            assert!((tangent - DVec3::new(0.0, 0.0, 2.0)).length() < 1e-12, "{t1} {t2}: {tangent}");
        }
    }

    #[test]
    fn points_on_a_line_give_the_chord() {
        let (p, q) = (DVec3::ZERO, DVec3::X);
        assert_eq!(circle_tangent(p, q, DVec3::X * 3.0, 2.0), DVec3::X * 0.5);
        assert_eq!(circle_tangent(p, q, DVec3::X * 0.5, 2.0), DVec3::X * 0.5);
    }
}
