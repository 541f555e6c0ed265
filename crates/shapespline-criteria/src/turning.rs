// SPDX-License-Identifier: MIT OR Apache-2.0

//! Turning: how a segment bends at its two nodes.
//!
//! Manni's (i.3): at a node with `P_i ≠ 0`, `(K(u_i)·P_j)(P_i·P_j) > 0` for those of `j = i−1, i, i+1`
//! with `P_i·P_j ≠ 0`; and Gautam's (12.1), *node compatibility*: seen along `P_i` the tangent lies
//! strictly between the chords. Without it the polygon asks for nothing at a corner between two straight
//! runs, where neither convexity nor inflection has a pair of binormal vectors to go by.
//!
//! Each segment answers for its own side of the node, so a curve whose curvature jumps there has to turn
//! the right way on both. `K` has the direction of `ω = a×b` at the start and of `b×c` at the end. Of the
//! two chords the tangent is held against the segment's own, `(a×L)·P_m > 0` and `(L×c)·P_{m+1} > 0`: the
//! other one is that of the segment beside, which has the same tangent. Where a curve has a corner
//! instead, [`CurveChecker`](crate::CurveChecker) asks for both chords on both sides. A given end tangent
//! stands for the missing chord and is the curve's own: there nothing lies between.

use glam::DVec3;

use crate::{Requirements, segment_geometry::SegmentGeometry};

/// A product that has to be positive, and the largest value that it could have.
pub(crate) type Condition = (f64, f64);

/// What is asked at the start (0) or at the end (1) of a segment.
pub(crate) fn conditions(
    s: &SegmentGeometry,
    required: Requirements,
    end: usize,
) -> impl Iterator<Item = Condition> {
    let SegmentGeometry { a, c, chord, omega, p, q, .. } = *s;
    let at_start = end == 0;
    let (own, other, beside) = if at_start { (p, q, s.before) } else { (q, p, s.after) };
    let (asked, alike, apart) = if at_start {
        (Requirements::TURNING_AT_START, Requirements::BEFORE_ALIKE, Requirements::BEFORE_APART)
    } else {
        (Requirements::TURNING_AT_END, Requirements::AFTER_ALIKE, Requirements::AFTER_APART)
    };
    let (leg, far) = if at_start { (a.length(), c.length()) } else { (c.length(), a.length()) };
    let (bend, side) =
        if at_start { (omega[0], a.cross(chord)) } else { (omega[2], chord.cross(c)) };
    let size = leg * (chord.length() + far);
    let along = move |n: DVec3, sign: f64| (sign * bend.dot(n), size * n.length());
    let sign = move |alike: Requirements, apart: Requirements| {
        f64::from(i8::from(required.intersects(alike)) - i8::from(required.intersects(apart)))
    };
    let turns = [
        (own, f64::from(u8::from(required.intersects(asked)))),
        (
            other,
            if required.intersects(asked) {
                sign(Requirements::TURNS_ALIKE, Requirements::TURNS_APART)
            } else {
                0.0
            },
        ),
        (beside, sign(alike, apart)),
    ];
    let between = (side.dot(own), leg * chord.length() * own.length());
    let turns = turns.into_iter().filter(|(_, sign)| *sign != 0.0).map(move |(n, s)| along(n, s));
    turns.chain(required.intersects(asked).then_some(between))
}
