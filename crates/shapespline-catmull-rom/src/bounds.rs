//! The largest handles that keep the shape of a segment, in closed form.

use shapespline_criteria::{Calls, Criterion};
use shapespline_geometry::{DVec3, DataPolygon, length};

/// What of the polygon's calls has bounds on handles in closed form.
#[inline]
pub(crate) fn bounded() -> Calls {
    signs().and(Calls::of(Criterion::Collinearity))
}

/// Convexity, of which global convexity follows, and inflection.
#[inline]
fn signs() -> Calls {
    Calls::CONVEXITY.and(Calls::GLOBAL_CONVEXITY).and(Calls::INFLECTION)
}

/// Bounds on the factors of the full legs `a, c` of a segment: handles strictly below both keep
/// convexity or inflection, and collinearity (for the derivation see the crate's page). Infinite
/// where nothing bounds.
///
/// `cotangent`: that of the half angle of the collinearity cone.
#[inline]
pub(crate) fn bounds(
    polygon: &DataPolygon,
    segment: usize,
    calls: Calls,
    [a, c]: [DVec3; 2],
    cotangent: f64,
) -> [f64; 2] {
    let [mut p, mut q] = [f64::INFINITY; 2];
    if calls.any(signs()) {
        let (a, c, chord) = near_one([a, c], polygon.chord(segment));
        let (x, first, last) = (a.cross(c), a.cross(chord), chord.cross(c));
        for n in polygon.binormals(segment) {
            // (αP − qX)·n and (βP' − pX)·n must keep the signs they have at q = p = 0. Where X·n has
            // the other sign, or none, they do.
            let across = 1.0 / x.dot(n);
            let (on_q, on_p) = (first.dot(n) * across, last.dot(n) * across);
            if on_q > 0.0 && on_q < q {
                q = on_q;
            }
            if on_p > 0.0 && on_p < p {
                p = on_p;
            }
        }
    }
    if calls.any(Calls::of(Criterion::Collinearity)) {
        let chord = length(polygon.chord(segment));
        let direction = polygon.direction(segment);
        // The handle along the line itself, and the one at the other end of the segment.
        let own = |leg: DVec3| chord / length(leg);
        let other = |leg: DVec3| {
            let along = leg.dot(direction);
            let bound = chord / (along + cotangent * length(leg - direction * along));
            if bound > 0.0 { bound } else { f64::INFINITY }
        };
        if calls.any(Calls::LINE_AT_START) {
            (p, q) = (p.min(own(a)), q.min(other(c)));
        }
        if calls.any(Calls::LINE_AT_END) {
            (p, q) = (p.min(other(a)), q.min(own(c)));
        }
    }
    [p, q]
}

/// Legs and chord scaled so that products neither overflow nor underflow.
#[inline]
fn near_one([a, c]: [DVec3; 2], chord: DVec3) -> (DVec3, DVec3, DVec3) {
    let size = chord.abs().max_element();
    if (1e-40..1e40).contains(&size) { (a, c, chord) } else { (a / size, c / size, chord / size) }
}
