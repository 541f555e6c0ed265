// SPDX-License-Identifier: MIT OR Apache-2.0

//! The largest handles that keep the shape of a segment, in closed form.
//!
//! Bounds are on the factors of the full legs `a, c` of a segment: handles strictly below both keep
//! convexity or inflection, turning, and collinearity (for the derivation see the crate's page). Infinite
//! where nothing bounds.

use shapespline_criteria::{Criterion, Requirements};
use shapespline_geometry::{DVec3, length};

/// What is asked of `ω` along the binormal vectors at both nodes of a segment, at both: convexity, of which
/// global convexity follows, and inflection.
const BETWEEN: Requirements = Requirements::CONVEXITY
    .union(Requirements::GLOBAL_CONVEXITY)
    .union(Requirements::INFLECTION)
    .union(Requirements::TURNING_PAIR);

/// The least of some bounds, as a fraction: one division in the end instead of one each.
struct Least {
    numerator: f64,
    denominator: f64,
}

impl Least {
    const NONE: Self = Self { numerator: 1.0, denominator: 0.0 };

    /// With `value − factor·rate` to keep the sign it has at zero, if that is asked. Where `rate` has the
    /// other sign, or none, it does.
    #[inline(always)]
    fn and(self, asked: bool, value: f64, rate: f64) -> Self {
        let (numerator, denominator) = (value.abs(), rate.abs());
        let less = numerator * self.denominator < self.numerator * denominator;
        if asked & (value * rate > 0.0) & less { Self { numerator, denominator } } else { self }
    }
}

/// What convexity, inflection and turning ask for; legs and chord near one in size, binormal vectors of unit
/// chords at the node before, at the two nodes, and at the node after. Without branches.
#[inline(always)]
pub(crate) fn of_signs(
    calls: Requirements,
    [a, c]: [DVec3; 2],
    chord: DVec3,
    [before, p, q, after]: [DVec3; 4],
) -> [f64; 2] {
    let (x, first, last) = (a.cross(c), a.cross(chord), chord.cross(c));
    let (xp, xq) = (x.dot(p), x.dot(q));
    let between = calls.intersects(BETWEEN);
    // (αP − qX)·n and (βP' − pX)·n must keep the signs they have at q = p = 0.
    let on_q = Least::NONE
        .and(between | calls.intersects(Requirements::TURNING_AT_START), first.dot(p), xp)
        .and(between, first.dot(q), xq)
        .and(calls.intersects(Requirements::TURNING_BEFORE), first.dot(before), x.dot(before));
    let on_p = Least::NONE
        .and(between | calls.intersects(Requirements::TURNING_AT_END), last.dot(q), xq)
        .and(between, last.dot(p), xp)
        .and(calls.intersects(Requirements::TURNING_AFTER), last.dot(after), x.dot(after));
    [on_p.numerator / on_p.denominator, on_q.numerator / on_q.denominator]
}

/// What collinearity asks for, given the unit chord; `cotangent` is that of the half angle of its cone.
pub(crate) fn of_lines(
    calls: Requirements,
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
    if calls.intersects(Requirements::LINE_AT_START) {
        (p, q) = (p.min(own(a)), q.min(other(c)));
    }
    if calls.intersects(Requirements::LINE_AT_END) {
        (p, q) = (p.min(other(a)), q.min(own(c)));
    }
    [p, q]
}

/// Whether a segment has a bound by [`of_lines`].
#[inline]
pub(crate) fn has_lines(calls: Requirements) -> bool {
    calls.intersects(Requirements::of(Criterion::Collinearity))
}
