//! The largest handles that keep the shape of a segment, in closed form.
//!
//! Bounds are on the factors of the full legs `a, c` of a segment: handles strictly below both keep
//! convexity or inflection, and collinearity (for the derivation see the crate's page). Infinite where
//! nothing bounds.

use shapespline_criteria::{Calls, Criterion};
use shapespline_geometry::{DVec3, length};

/// The calls that [`of_signs`] has bounds for: convexity, of which global convexity follows, and
/// inflection.
pub(crate) const SIGNS: Calls =
    Calls::CONVEXITY.and(Calls::GLOBAL_CONVEXITY).and(Calls::INFLECTION);

/// What convexity and inflection ask for; legs and chord near one in size, binormal vectors of unit
/// chords. Without branches.
#[inline(always)]
pub(crate) fn of_signs([a, c]: [DVec3; 2], chord: DVec3, binormals: [DVec3; 2]) -> [f64; 2] {
    let [mut p, mut q] = [f64::INFINITY; 2];
    let (x, first, last) = (a.cross(c), a.cross(chord), chord.cross(c));
    for n in binormals {
        // (αP − qX)·n and (βP' − pX)·n must keep the signs they have at q = p = 0. Where X·n has
        // the other sign, or none, they do.
        let across = 1.0 / x.dot(n);
        let (on_q, on_p) = (first.dot(n) * across, last.dot(n) * across);
        q = if (on_q > 0.0) & (on_q < q) { on_q } else { q };
        p = if (on_p > 0.0) & (on_p < p) { on_p } else { p };
    }
    [p, q]
}

/// What collinearity asks for, given the unit chord; `cotangent` is that of the half angle of its cone.
pub(crate) fn of_lines(
    calls: Calls,
    [a, c]: [DVec3; 2],
    chord: DVec3,
    direction: DVec3,
    cotangent: f64,
) -> [f64; 2] {
    let [mut p, mut q] = [f64::INFINITY; 2];
    let chord = length(chord);
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
    [p, q]
}

/// Whether a segment has a bound by [`of_lines`].
#[inline]
pub(crate) fn has_lines(calls: Calls) -> bool {
    calls.any(Calls::of(Criterion::Collinearity))
}
