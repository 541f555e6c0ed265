// SPDX-License-Identifier: MIT OR Apache-2.0

//! How far a segment is from failing a criterion: signed, scale-free margins.
//!
//! | criterion | margin |
//! |---|---|
//! | convexity | least of `ω·P_n` at the ends and of Lemma 5.1's middle condition, each over the sizes in it |
//! | inflection | least of the four `ω·P_n` at the ends over their sizes, with the signs asked for |
//! | turning | least of `ω·P_j` at the nodes and of the sines between tangent and chord, each over its size |
//! | torsion | `±det[a, L, c] / (‖a‖‖L‖‖c‖)` |
//! | coplanarity, collinearity | `ε` less the sine of the largest angle |
//! | global convexity | least of the margin of convexity and of `(a×L)·P_n`, `(L×c)·P_n` over their sizes |
//! | regular | least of the speed over what it would be if no legs cancelled |
//!
//! The size of `ω(0) = a×L − a×c` is `‖a‖(‖L‖ + ‖c‖)`, that of `ω(1)` likewise: what the products
//! could be at most, not what they are. So a margin passes through zero where a plane curve is about
//! to inflect, and does not jump from 1 to −1 there as the cosine of the angle would. All margins lie
//! in `[−1, 1]`, are positive exactly when the condition holds, and are continuous in the data
//! wherever the legs `a, c` do not vanish.

use glam::DVec3;
use shapespline_polynomial::quadratic::minimum;

use crate::{
    Requirements,
    cone::{Cones, LINE_PART, Quadratic, inside, part},
    global::chord_turns,
    segment_geometry::SegmentGeometry,
    turning::conditions,
};

/// A margin and the local parameter where it is smallest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Margin {
    pub(crate) value: f64,
    pub(crate) at: f64,
}

impl Margin {
    pub(crate) fn least(self, other: Self) -> Self {
        if other.value < self.value { other } else { self }
    }
}

/// `x / size`, where a vanishing size leaves nothing to be positive.
fn ratio(x: f64, size: f64) -> f64 {
    if size > 0.0 { x / size } else { 0.0 }
}

/// The sizes of `ω(0)`, of its middle coefficient `a×c`, and of `ω(1)`.
fn sizes(s: &SegmentGeometry) -> [f64; 3] {
    let (a, chord, c) = (s.a.length(), s.chord.length(), s.c.length());
    [a * (chord + c), a * c, c * (chord + a)]
}

pub(crate) fn convexity(s: &SegmentGeometry) -> Margin {
    let [first, middle, last] = sizes(s);
    let of = |n: DVec3| {
        let [alpha, gamma, beta] = s.omega_along(n.normalize_or_zero());
        let start = Margin { value: ratio(alpha, first), at: 0.0 };
        let end = Margin { value: ratio(beta, last), at: 1.0 };
        // With an end below zero there is no middle condition.
        let geometric = alpha.max(0.0).sqrt() * beta.max(0.0).sqrt();
        let size = 2.0 * first.sqrt() * last.sqrt() + middle;
        let between =
            Margin { value: ratio(2.0 * geometric + gamma, size), at: minimum(alpha, gamma, beta) };
        start.least(end).least(between)
    };
    of(s.p).least(of(s.q))
}

pub(crate) fn global_convexity(s: &SegmentGeometry) -> Margin {
    let chord = s.chord.length();
    let sizes = [s.a.length() * chord, s.c.length() * chord];
    let lengths = [s.p.length(), s.q.length()];
    let mut margin = convexity(s);
    for (turns, length) in chord_turns(s).into_iter().zip(lengths) {
        // Where the end tangents see the other end: both at the end of the segment.
        for (turn, size) in turns.into_iter().zip(sizes) {
            margin = margin.least(Margin { value: ratio(turn, size * length), at: 1.0 });
        }
    }
    margin
}

pub(crate) fn inflection(s: &SegmentGeometry) -> Margin {
    let [first, _, last] = s.omega;
    let [start, _, end] = sizes(s);
    let along = |w: DVec3, n: DVec3, size: f64| ratio(w.dot(n.normalize_or_zero()), size);
    Margin { value: along(first, s.p, start).min(-along(first, s.q, start)), at: 0.0 }
        .least(Margin { value: (-along(last, s.p, end)).min(along(last, s.q, end)), at: 1.0 })
}

pub(crate) fn turning(s: &SegmentGeometry, required: Requirements) -> Margin {
    [0, 1]
        .into_iter()
        .flat_map(|end| {
            let of = move |(value, size)| Margin { value: ratio(value, size), at: end as f64 };
            conditions(s, required, end).map(of)
        })
        .fold(Margin { value: f64::INFINITY, at: 0.0 }, Margin::least)
}

pub(crate) fn torsion(s: &SegmentGeometry, required: Requirements) -> Margin {
    let size = s.a.length() * s.chord.length() * s.c.length();
    let sign = if required.intersects(Requirements::RIGHT_TORSION) { 1.0 } else { -1.0 };
    // Its sign is the same all over the segment.
    Margin { value: sign * ratio(s.determinant(), size), at: 0.5 }
}

pub(crate) fn coplanarity(s: &SegmentGeometry, required: Requirements, cones: &Cones) -> Margin {
    let (epsilon, [p, q]) = cones.plane;
    let over = |from: f64, to: f64| {
        let omega = part(s.omega_quadratic(), from, to);
        let margin = |normal| cone_margin(epsilon, normal, (from, to), omega);
        margin(p).least(margin(q))
    };
    if required.intersects(Requirements::COPLANARITY) {
        over(0.0, 1.0)
    } else {
        let [left, right] = cones.parts;
        over(0.0, left).least(over(right, 1.0))
    }
}

pub(crate) fn collinearity(s: &SegmentGeometry, required: Requirements, cones: &Cones) -> Margin {
    let (epsilon, lines) = cones.line;
    let over = |line: DVec3, from: f64, to: f64| {
        cone_margin(epsilon, line, (from, to), part(s.tangent_quadratic(), from, to))
    };
    let start =
        required.intersects(Requirements::LINE_AT_START).then(|| over(lines[0], 0.0, LINE_PART));
    let end = required
        .intersects(Requirements::LINE_AT_END)
        .then(|| over(lines[1], 1.0 - LINE_PART, 1.0));
    [start, end]
        .into_iter()
        .flatten()
        .reduce(Margin::least)
        .unwrap_or(Margin { value: f64::NAN, at: 0.0 })
}

/// `ε` less the sine of the half angle of the narrowest cone that holds the vector on a part of the
/// segment. The verdict at `ε` comes first, and decides the sign; bisection then finds the sine.
fn cone_margin(epsilon: f64, axis: DVec3, (from, to): (f64, f64), v: Quadratic) -> Margin {
    let verdict = |sine: f64| inside(v, axis, sine);
    let holds = verdict(epsilon).holds();
    let (mut inside, mut outside) = if holds { (0.0, epsilon) } else { (epsilon, 1.0) };
    let mut at = from;
    for _ in 0..52 {
        let middle = 0.5 * (inside + outside);
        match verdict(middle).place() {
            None => outside = middle,
            Some(t) => {
                inside = middle;
                at = from + t * (to - from);
            }
        }
    }
    // On its own side of zero, whatever the rounding of the bisection.
    let value = if holds { (epsilon - outside).max(f64::MIN_POSITIVE) } else { epsilon - inside };
    Margin { value, at }
}
