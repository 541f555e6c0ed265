// SPDX-License-Identifier: MIT OR Apache-2.0

//! Turning at the two nodes of a segment of any degree, on this segment's side of them.

use glam::DVec3;
use shapespline_polynomial::{Polynomial, Sign};

use super::{Question, Segment, question::clear};
use crate::{Requirements, margin::Margin};

/// What is asked at a node: vectors along which `ω`, and one along which the tangent, has to lead.
struct Asked {
    bends: Vec<DVec3>,
    tangent: Option<DVec3>,
}

/// What is asked at the start (0) or at the end (1) of a segment, by unit vectors.
fn asked(question: &Question, end: usize) -> Asked {
    let Question { required, normals, beside, chord, .. } = question;
    let (own, other) = (normals[end], normals[1 - end]);
    let (at_node, alike, apart) = if end == 0 {
        (Requirements::TURNING_AT_START, Requirements::BEFORE_ALIKE, Requirements::BEFORE_APART)
    } else {
        (Requirements::TURNING_AT_END, Requirements::AFTER_ALIKE, Requirements::AFTER_APART)
    };
    if !required.intersects(at_node) {
        return Asked { bends: Vec::new(), tangent: None };
    }
    let mut bends = vec![own];
    for (n, alike, apart) in
        [(other, Requirements::TURNS_ALIKE, Requirements::TURNS_APART), (beside[end], alike, apart)]
    {
        bends.extend(required.intersects(alike).then_some(n));
        bends.extend(required.intersects(apart).then_some(-n));
    }
    // (T × l)·P = T·(l × P) at the start, (l × T)·P = T·(P × l) at the end.
    let tangent = if end == 0 { chord.cross(own) } else { own.cross(*chord) };
    Asked { bends, tangent: Some(tangent) }
}

/// The verdict: what is asked are signs of end coefficients in Bernstein form, which are exact values.
pub(crate) fn turns_at_nodes(segment: &Segment, question: &Question) -> Sign {
    [(segment.pieces.first(), 0), (segment.pieces.last(), 1)]
        .into_iter()
        .filter_map(|(piece, end)| piece.map(|piece| (piece, end)))
        .fold(Sign::Positive, |known, (piece, end)| {
            let Asked { bends, tangent } = asked(question, end);
            let of = |vector: Polynomial<DVec3>, n: DVec3| {
                let along = vector.map(1.0, |v| v.dot(n));
                clear(along.ends()[end], along.error(), end as f64)
            };
            let known = bends.into_iter().fold(known, |known, n| known.and(of(piece.omega(), n)));
            tangent.into_iter().fold(known, |known, n| known.and(of(piece.tangent(), n)))
        })
}

/// The least of the same products over their sizes: `‖γ'‖` times the largest second derivative, and `‖γ'‖`.
pub(crate) fn margin(segment: &Segment, question: &Question, s2: f64) -> Margin {
    let ratio = |x: f64, size: f64| if size > 0.0 { (x / size).clamp(-1.0, 1.0) } else { 0.0 };
    [(segment.pieces.first(), 0), (segment.pieces.last(), 1)]
        .into_iter()
        .flat_map(|(piece, end)| {
            let Asked { bends, tangent } = asked(question, end);
            let [_, d1, d2, _] = piece.map_or([DVec3::NAN; 4], |piece| piece.jet(end as f64));
            let (omega, speed) = (d1.cross(d2), d1.length());
            let bends = bends.into_iter().map(move |n| ratio(omega.dot(n), speed * s2));
            let tangent = tangent.map(|n| ratio(d1.dot(n), speed));
            bends.chain(tangent).map(move |value| Margin { value, at: end as f64 })
        })
        .fold(Margin { value: f64::INFINITY, at: 0.0 }, Margin::least)
}
