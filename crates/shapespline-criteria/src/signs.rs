// SPDX-License-Identifier: MIT OR Apache-2.0

//! The signs that a segment is judged by, with their error bounds.

use glam::DVec3;

use crate::{
    rounding::{Coarse, Rounded, sum},
    segment_geometry::SegmentGeometry,
};

/// The numbers whose signs convexity, inflection, turning and torsion are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Signs {
    /// `ω·n` as `[α, γ, β]` of Lemma 5.1, for the binormal vectors at both nodes.
    pub(crate) omega: [[Rounded; 3]; 2],
    /// `ω(0)·n` and `ω(1)·n` for those at the nodes before and after.
    pub(crate) beside: [Rounded; 2],
    /// `det[a, b, c]`.
    pub(crate) twist: Rounded,
}

impl Signs {
    /// As far as they are clear of coarse bounds.
    #[inline(always)]
    pub(crate) fn coarse(s: &SegmentGeometry) -> Self {
        let size = sum(s.a) + sum(s.chord) + sum(s.c);
        let binormals = [sum(s.before), sum(s.p), sum(s.q), sum(s.after)];
        let Coarse { turns: [o, p, q, r], twist } = Coarse::new(size, s.slack, binormals);
        let along = |n: DVec3, error: f64| {
            let [alpha, gamma, beta] = s.omega_along(n);
            let of = |value: f64| Rounded { value, error };
            [of(alpha), of(gamma), of(beta)]
        };
        let twist = Rounded { value: s.determinant(), error: twist };
        let beside = [
            Rounded { value: s.omega[0].dot(s.before), error: o },
            Rounded { value: s.omega[2].dot(s.after), error: r },
        ];
        Self { omega: [along(s.p, p), along(s.q, q)], beside, twist }
    }

    /// As exactly as is known.
    pub(crate) fn fine(s: &SegmentGeometry) -> Self {
        let [start, end] = [s.omega_signs(s.before)[0], s.omega_signs(s.after)[2]];
        let omega = [s.omega_signs(s.p), s.omega_signs(s.q)];
        Self { omega, beside: [start, end], twist: s.rounded_determinant() }
    }
}
