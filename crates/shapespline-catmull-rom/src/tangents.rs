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
        return polygon.tangents().map(|[start, end]| if node == 0 { start } else { end });
    };
    let (h0, h1) = (polygon.spacing(before), polygon.spacing(after));
    // Halves first: the sum of two spacings can overflow where neither does.
    let reciprocal = 0.5 / (0.5 * h0 + 0.5 * h1);
    let ratio = h1 / h0;
    Some(polygon.chord(before) * (ratio * reciprocal) + polygon.chord(after) * (reciprocal / ratio))
}
