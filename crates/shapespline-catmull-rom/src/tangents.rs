// SPDX-License-Identifier: MIT OR Apache-2.0

//! Tangents of Catmull–Rom curves.

use shapespline_geometry::{DVec3, DataPolygon};

/// The tangent at a node; `None` at an end of zero curvature, whose leg depends on the other one of
/// its segment.
#[inline]
pub(crate) fn tangent(polygon: &DataPolygon, node: usize) -> Option<DVec3> {
    let n = polygon.segments();
    let (before, after) = if node > 0 && node < n {
        (node - 1, node)
    } else if polygon.is_closed() {
        (n - 1, 0)
    } else {
        return polygon.tangents()[usize::from(node > 0)];
    };
    let chords = [polygon.chord(before), polygon.chord(after)];
    Some(tangent_between(chords, [polygon.spacing(before), polygon.spacing(after)]))
}

/// The tangent between two chords, given the spacings of the parameters.
#[inline(always)]
pub(crate) fn tangent_between([before, after]: [DVec3; 2], [h0, h1]: [f64; 2]) -> DVec3 {
    // Halves first: the sum of two spacings can overflow where neither does.
    let reciprocal = 0.5 / (0.5 * h0 + 0.5 * h1);
    let ratio = h1 / h0;
    before * (ratio * reciprocal) + after * (reciprocal / ratio)
}
