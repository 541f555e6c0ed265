// SPDX-License-Identifier: MIT OR Apache-2.0

//! One node: the angles of its tangent with the two chords, and what a split of their sum makes of them.

use shapespline_geometry::{DVec3, DataPolygon, length, normalize};

use crate::tangents::tangent;

/// Turns beyond this angle keep the parametrisation's tangent: 170°, where the plane of the three points
/// is hardly defined.
const LARGEST_TURN: f64 = 170.0 / 180.0 * std::f64::consts::PI;

/// No angle between tangent and chord is made smaller than this, in radians: far above rounding and the
/// default zero tolerance, so that the plane of the three points stays known.
const SMALLEST_ANGLE: f64 = 1e-7;

/// What is known of one node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// The directions of the chords before and after; zero beyond an end.
    chords: [DVec3; 2],
    /// The parametrisation's tangent.
    tangent: DVec3,
    /// The angles `ψ_{i−1}, φ_i` of that tangent with the chords before and after; zero where there is
    /// no such chord.
    angles: [f64; 2],
    /// Whether the split is free: the node turns, by less than [`LARGEST_TURN`], and no four points around
    /// it lie in a plane that the rest of the points leave. Where the binormal flips on an inflecting
    /// coplanar segment depends on the directions, and coplanarity asks for it where the
    /// parametrisation's have it.
    pub(super) is_free: bool,
    /// Whether the segments before and after are to have like angles, as far as this end of them goes.
    pub(super) counts: [bool; 2],
    /// `log(ψ + φ)`, or that of the one angle there is.
    turn: f64,
    /// `s⁰`; zero unless the split is free.
    pub(super) anchor: f64,
}

impl Node {
    /// `twist`: whether it lies in no plane.
    pub(super) fn new(
        polygon: &DataPolygon,
        i: usize,
        chords: [DVec3; 2],
        zero: f64,
        twist: bool,
    ) -> Self {
        let n = polygon.segments();
        let tangent = tangent(polygon, i).unwrap_or_default();
        let has = [i > 0 || polygon.is_closed(), i < n || polygon.is_closed()];
        let direction = normalize(tangent);
        let angles: [f64; 2] =
            std::array::from_fn(|k| if has[k] { angle(chords[k], direction) } else { 0.0 });
        let turns = has == [true; 2] && chords[0].cross(chords[1]).length() > zero;
        let turn = angles[0] + angles[1];
        let is_free = turns && angles.iter().all(|&a| a > 0.0) && turn < LARGEST_TURN && twist;
        // The angle at an end with a given tangent is fixed, and counts.
        let is_end = |angle: f64| has != [true; 2] && angle > 0.0 && angle < LARGEST_TURN;
        let counts = angles.map(|angle| is_free || is_end(angle));
        let anchor = if is_free { (angles[1] / angles[0]).ln() } else { 0.0 };
        Self { chords, tangent, angles, is_free, counts, turn: turn.ln(), anchor }
    }

    /// `log φ` and `log ψ` for a split, and the derivatives of `log φ` and `−log ψ`: those of a node that
    /// is not free do not change.
    #[inline]
    pub(super) fn at(&self, s: f64) -> At {
        if !self.is_free {
            return At { phi: self.turn, psi: self.turn, by_phi: 0.0, by_psi: 0.0 };
        }
        // Nothing overflows: φ/(φ + ψ) = 1/(1 + e^−s).
        let small = (-s.abs()).exp();
        let share = 1.0 / (1.0 + small);
        let (large_log, shares) = (self.turn + share.ln(), [share, small * share]);
        let small_log = large_log - s.abs();
        if s < 0.0 {
            At { phi: small_log, psi: large_log, by_phi: shares[0], by_psi: shares[1] }
        } else {
            At { phi: large_log, psi: small_log, by_phi: shares[1], by_psi: shares[0] }
        }
    }

    /// The tangent that splits the turning angle with `log(φ/ψ) = s`.
    pub(super) fn with_split(&self, s: f64) -> DVec3 {
        if !self.is_free {
            return self.tangent;
        }
        let turn = self.angles[0] + self.angles[1];
        let floor = SMALLEST_ANGLE.min(self.angles[0]).min(self.angles[1]);
        let psi = (turn / (1.0 + s.exp())).clamp(floor, turn - floor);
        let phi = turn - psi;
        // Unit vectors in a plane: sin θ t = sin φ u + sin ψ u', with ψ from u to t and φ from t to u'.
        let [before, after] = self.chords;
        normalize(before * phi.sin() + after * psi.sin()) * length(self.tangent)
    }
}

/// What a split makes of the angles at its node.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct At {
    pub(super) phi: f64,
    pub(super) psi: f64,
    pub(super) by_phi: f64,
    pub(super) by_psi: f64,
}

/// The angle between unit vectors, exact to rounding however small it is.
pub(super) fn angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}
