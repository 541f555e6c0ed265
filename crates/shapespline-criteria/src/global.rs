// SPDX-License-Identifier: MIT OR Apache-2.0

//! Global convexity of a cubic segment (paper 002, Definition 3.16), in closed form.
//!
//! Seen along `n`, with `A, B, C = (a×b)·n, (b×c)·n, (a×c)·n`, the conditions beyond `ω·n > 0` are
//! `((γ(t) − γ(0))×γ'(t))·n = 3t²·[3A, A+C, B+C]` and `(γ'(0)×(γ(t) − γ(0)))·n = 3t²·[3A, A+C]` in
//! Bernstein coefficients. With `A, B > 0` from `ω·n > 0`, the second asks `A + C > 0` (its value at
//! the end), the first `B + C > 0` (likewise), and with these all coefficients of both are positive.
//! So both come down to two signs at the ends: `A + C = (a×L)·n > 0` and `B + C = (L×c)·n > 0`.
//! Gautam's Theorem 13.4 has the same conditions as its cases 1(b) and 2(a); 1(b) is right also where
//! the control polygon turns by more than π, as `C > −min(A, B)` implies `C > −2√(AB)`. Its cases
//! 1(a) and 2(b) are misprints: they accept the mirror image, which turns the wrong way.

use crate::{
    rounding::{Lean, Rounded, is_positive},
    segment_geometry::SegmentGeometry,
};

/// `(a×L)·n` and `(L×c)·n` for both binormal vectors `n`.
pub(crate) fn chord_turns(s: &SegmentGeometry) -> [[f64; 2]; 2] {
    let [start, end] = [s.a.cross(s.chord), s.chord.cross(s.c)];
    [s.p, s.q].map(|n| [start.dot(n), end.dot(n)])
}

/// Whether a segment is globally convex, given `ω·n` for both binormal vectors: `[A, C, B]` each.
pub(crate) fn is_globally_convex(omega: &[[Rounded; 3]; 2], lean: Lean) -> bool {
    omega.iter().all(|&[start, middle, end]| {
        (start + middle).is_positive(lean)
            && (end + middle).is_positive(lean)
            && is_positive([start, middle, end], lean)
    })
}
