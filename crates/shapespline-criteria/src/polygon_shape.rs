// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the points themselves say: chords, binormal vectors, discrete torsion, and what each segment
//! requires.

use glam::DVec3;
use shapespline_geometry::{DataPolygon, length};

use crate::{Criteria, Requirements, Tolerances, resolution::is_straight};

/// Whether a polygon lies on a line or in a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum AffineDimension {
    /// All points lie on one line: no criterion but collinearity applies.
    Line,
    /// All points lie in one plane: torsion and coplanarity do not apply.
    Plane,
    /// The points span space.
    Space,
}

impl AffineDimension {
    /// The name users write.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Plane => "plane",
            Self::Space => "space",
        }
    }
}

/// The discrete shape of a data polygon, as plain data.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PolygonShape {
    /// Whether the points lie on a line or in a plane.
    pub affine_dimension: AffineDimension,
    /// Chords `L_i`, one a segment.
    pub chords: Vec<DVec3>,
    /// Unit vectors along the binormal vectors `P_i = L_{i−1} × L_i`, one a node; zero where the
    /// polygon does not turn, or not clearly (and at ends with zero curvature).
    pub binormals: Vec<DVec3>,
    /// Turning angle at each node, in radians.
    pub turning_angles: Vec<f64>,
    /// Discrete torsion `Γ_i / (‖P_i‖ ‖P_{i+1}‖)`, one a segment, in reciprocal units of length; NaN
    /// where a binormal vector vanishes.
    pub torsion: Vec<f64>,
    /// The default criteria that each segment requires.
    pub required: Vec<Criteria>,
}

/// The discrete shape of a polygon. Cost O(N).
#[must_use]
pub fn polygon_shape(polygon: &DataPolygon, tolerances: &Tolerances) -> PolygonShape {
    let n = polygon.segments();
    let zero = tolerances.zero;
    let binormal = |i: usize| {
        let p = polygon.binormal(i);
        let inner = polygon.is_closed() || (i > 0 && i < n);
        let straight = || {
            let chords = [(i + n - 1) % n, i % n].map(|i| polygon.chord(i));
            inner && is_straight(chords[0], chords[1], tolerances.resolution)
        };
        if p.length() > zero && !straight() { p.normalize() } else { DVec3::ZERO }
    };
    let binormals: Vec<DVec3> = (0..=n).map(binormal).collect();
    let torsion = |i: usize| {
        let known = binormals[i] != DVec3::ZERO && binormals[i + 1] != DVec3::ZERO;
        if known { polygon.discrete_torsion(i) } else { f64::NAN }
    };
    PolygonShape {
        affine_dimension: affine_dimension(polygon, zero),
        chords: (0..n).map(|i| polygon.chord(i)).collect(),
        turning_angles: (0..=n)
            .map(|i| (polygon.binormal(i).length(), polygon.directions_at(i)))
            .map(|(sine, [before, after])| sine.atan2(before.dot(after)))
            .collect(),
        torsion: (0..n).map(torsion).collect(),
        required: Requirements::of_polygon(polygon, tolerances)
            .into_iter()
            .map(|required| required.only(Criteria::OF_FITS).criteria())
            .collect(),
        binormals,
    }
}

fn affine_dimension(polygon: &DataPolygon, zero: f64) -> AffineDimension {
    let points = polygon.points();
    let from = |i: usize| points[i] - points[0];
    let size = |v: DVec3| length(v);
    // The farthest point spans the line, the one farthest from the line the plane.
    let far =
        (0..points.len()).map(from).fold(DVec3::ZERO, |m, v| if size(v) > size(m) { v } else { m });
    let (scale, axis) = (size(far), shapespline_geometry::normalize(far));
    if scale == 0.0 {
        return AffineDimension::Line;
    }
    let across = |i: usize| (from(i) / scale).cross(axis);
    let side = (0..points.len())
        .map(across)
        .fold(DVec3::ZERO, |m, v| if v.length() > m.length() { v } else { m });
    if side.length() <= zero {
        return AffineDimension::Line;
    }
    let normal = side.normalize();
    let off = (0..points.len()).map(|i| (from(i) / scale).dot(normal).abs()).fold(0.0, f64::max);
    if off <= zero { AffineDimension::Plane } else { AffineDimension::Space }
}
