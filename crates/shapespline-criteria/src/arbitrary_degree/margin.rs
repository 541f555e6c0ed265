// SPDX-License-Identifier: MIT OR Apache-2.0

//! Margins on segments of any degree: how far from failing.
//!
//! With `γ` over the segment's local parameter, `σ₂ = max ‖γ''‖`, `σ₃ = max ‖γ'''‖`:
//!
//! | criterion | margin: the least over the segment of |
//! |---|---|
//! | convexity | `ω·n / (‖γ'‖ σ₂)` |
//! | global convexity | the same, and `2((γ−γ(0))×γ')·n / (t²‖γ'‖σ₂)`, `2(γ'(0)×(γ−γ(0)))·n / (t²‖γ'(0)‖σ₂)` |
//! | inflection | the two signs at the ends, over the same sizes, and how clearly one of the three conditions of the proof holds |
//! | turning | the signs at the ends over the same sizes, and the sines between tangent and chords |
//! | torsion | `±det[γ',γ'',γ'''] / (‖γ'‖ σ₂ σ₃)` |
//! | coplanarity, collinearity | `ε` less the sine of the angle |
//! | regular | `‖γ'‖ / max ‖γ'‖` |
//!
//! All lie in `[−1, 1]`. The verdict is proved by other means and decides the sign; the size is found
//! by search and refinement, to about nine digits.

use glam::DVec3;

use super::{Question, Segment, turning};
use crate::{Criterion, margin::Margin};

/// `γ − γ(0), γ', γ'', γ'''` at a local parameter.
pub(crate) struct Jet {
    pub(crate) t: f64,
    pub(crate) d: [DVec3; 4],
}

impl Jet {
    pub(crate) fn omega(&self) -> DVec3 {
        self.d[1].cross(self.d[2])
    }
}

/// Intervals that a piece is searched in.
const STEPS: usize = 48;

/// The least value of a function on a part of the segment, and where it is.
pub(crate) fn minimum(
    segment: &Segment,
    [from, to]: [f64; 2],
    value: impl Fn(&Jet) -> f64,
) -> Margin {
    let mut best = Margin { value: f64::INFINITY, at: from };
    for piece in &segment.pieces {
        let [start, end] = piece.local;
        let (low, high) = (from.max(start), to.min(end));
        if low >= high {
            continue;
        }
        let at = |t: f64| {
            let local = (t - start) / (end - start);
            Margin { value: value(&Jet { t, d: piece.jet(local) }), at: t }
        };
        let step = (high - low) / STEPS as f64;
        let mut least = at(low);
        for k in 1..=STEPS {
            least = least.least(at(if k == STEPS { high } else { low + step * k as f64 }));
        }
        // Golden section around the least sample.
        let (mut a, mut b) = ((least.at - step).max(low), (least.at + step).min(high));
        let ratio = 0.5 * (5f64.sqrt() - 1.0);
        for _ in 0..44 {
            let (c, d) = (at(b - ratio * (b - a)), at(a + ratio * (b - a)));
            least = least.least(c).least(d);
            if c.value <= d.value {
                b = d.at;
            } else {
                a = c.at;
            }
        }
        best = best.least(least);
    }
    best
}

/// `x / size`, where a vanishing size leaves nothing to be positive.
fn ratio(x: f64, size: f64) -> f64 {
    if size > 0.0 { (x / size).clamp(-1.0, 1.0) } else { 0.0 }
}

/// The largest second and third derivative.
fn sizes(segment: &Segment) -> [f64; 2] {
    [2, 3].map(|k| -minimum(segment, [0.0, 1.0], |jet| -jet.d[k].length()).value)
}

/// The margin of a criterion that applies.
pub(crate) fn margin(segment: &Segment, question: &Question) -> Margin {
    let all = [0.0, 1.0];
    let [p, q] = question.normals;
    let [s2, s3] = sizes(segment);
    match question.criterion {
        Criterion::Convexity => minimum(segment, all, |jet| bend(jet, [p, q], s2)),
        Criterion::GlobalConvexity => {
            let start = segment.pieces.first().map_or(DVec3::ZERO, |p| p.jet(0.0)[1]);
            minimum(segment, all, |jet| {
                // At t = 0 both further conditions are the first.
                let local = bend(jet, [p, q], s2);
                if jet.t < 1e-6 {
                    return local;
                }
                let size = 0.5 * s2 * jet.t * jet.t;
                [p, q].into_iter().fold(local, |least, n| {
                    let inner = ratio(jet.d[0].cross(jet.d[1]).dot(n), size * jet.d[1].length());
                    let outer = ratio(start.cross(jet.d[0]).dot(n), size * start.length());
                    least.min(inner).min(outer)
                })
            })
        }
        Criterion::Inflection => {
            let end = |t: f64, sign: f64| {
                let piece = if t == 0.0 { segment.pieces.first() } else { segment.pieces.last() };
                let value = piece.map_or(f64::NAN, |piece| {
                    let [x, y, size] = sign_change(&Jet { t, d: piece.jet(t) }, [p, q], s2);
                    ratio(sign * x, size).min(ratio(sign * y, size))
                });
                Margin { value, at: t }
            };
            end(0.0, 1.0)
                .least(end(1.0, -1.0))
                .least(minimum(segment, all, |jet| clearness(jet, [p, q], [s2, s3])))
        }
        Criterion::Turning => turning::margin(segment, question, s2),
        Criterion::Regular => {
            let largest = -minimum(segment, all, |jet| -jet.d[1].length()).value;
            minimum(segment, all, |jet| ratio(jet.d[1].length(), largest))
        }
        Criterion::Torsion => {
            let sign = question.torsion_sign();
            minimum(segment, all, |jet| {
                let det = jet.omega().dot(jet.d[3]);
                ratio(sign * det, jet.d[1].length() * s2 * s3)
            })
        }
        Criterion::Coplanarity | Criterion::Collinearity => question
            .cone_parts()
            .into_iter()
            .map(|([from, to], axis, epsilon)| {
                let vector = |jet: &Jet| match question.criterion {
                    Criterion::Coplanarity => jet.omega(),
                    _ => jet.d[1],
                };
                let signs = minimum(segment, [from, to], |jet| vector(jet).dot(axis));
                let other = minimum(segment, [from, to], |jet| -vector(jet).dot(axis));
                if signs.value < 0.0 && other.value < 0.0 {
                    // It crosses the plane of right angles on its way.
                    return Margin { value: epsilon - 1.0, at: signs.at };
                }
                minimum(segment, [from, to], |jet| {
                    let v = vector(jet).normalize_or_zero();
                    if v == DVec3::ZERO { epsilon - 1.0 } else { epsilon - v.cross(axis).length() }
                })
            })
            .reduce(Margin::least)
            .unwrap_or(Margin { value: f64::NAN, at: 0.0 }),
    }
}

/// The least of `ω·n` over its size.
pub(crate) fn bend(jet: &Jet, normals: [DVec3; 2], s2: f64) -> f64 {
    let omega = jet.omega();
    let size = jet.d[1].length() * s2;
    normals.into_iter().fold(f64::INFINITY, |least, n| least.min(ratio(omega.dot(n), size)))
}

/// `ω·P, −ω·P'` and their size.
fn sign_change(jet: &Jet, [p, q]: [DVec3; 2], s2: f64) -> [f64; 3] {
    let omega = jet.omega();
    [omega.dot(p), -omega.dot(q), jet.d[1].length() * s2]
}

/// How clearly one of the three conditions of [`super::single_sign_change`] holds.
fn clearness(jet: &Jet, normals: [DVec3; 2], [s2, s3]: [f64; 2]) -> f64 {
    let [x, y, size] = sign_change(jet, normals, s2);
    let (x, y) = (ratio(x, size), ratio(y, size));
    // ω' = γ' × γ'''.
    let rate = jet.d[1].cross(jet.d[3]);
    let size = jet.d[1].length() * s3;
    let (dx, dy) = (ratio(rate.dot(normals[0]), size), ratio(-rate.dot(normals[1]), size));
    let turn = x * dy - dx * y;
    x.min(y)
        .max(-x.max(y))
        .max(-dx.max(dy))
        .max(turn.min(0.5 * (y - x)))
        .max((-turn).min(0.5 * (x - y)))
}
