// SPDX-License-Identifier: MIT OR Apache-2.0

//! Nodes of a chain put where the closed-form start has them.

use crate::{
    chain::{Chain, Freedom},
    segment::Demands,
    start::{Scales, start},
};

/// The scales that are shrunk until all conditions hold.
const NATURAL: Scales = Scales { tilt: 1.0, handle: 1.0, curvature: 0.3 };

/// Puts a node where the closed-form start has it, as far as it may move.
pub(crate) fn set_start(demands: &Demands<'_>, chain: &mut Chain, j: usize, scales: Scales) {
    let total = demands.checker.polygon().nodes();
    let start = start(demands, (chain.first + j) % total, scales);
    match chain.freedom[j] {
        Freedom::Free | Freedom::Along(_) | Freedom::Straight(_) => chain.nodes[j] = start,
        Freedom::TangentHeld | Freedom::StraightHeld(_) => chain.nodes[j].r = start.r,
        Freedom::Held => {}
    }
}

/// Makes a given tangent no longer than the handle of the closed-form start.
pub(crate) fn shorten(demands: &Demands<'_>, chain: &mut Chain, j: usize, scales: Scales) {
    let total = demands.checker.polygon().nodes();
    let handle = start(demands, (chain.first + j) % total, scales).q.length();
    let tangent = &mut chain.nodes[j].q;
    *tangent *= (handle / tangent.length()).min(1.0);
}

/// Share of the triangle of the chord and both end tangents that a given tangent may fill.
const SHARE: f64 = 0.3;

/// Side of that triangle over the given tangent below which the triangle says how short the tangent has to be. Wider
/// triangles leave it to the shrinking of both handles, which ended with 10 % less curvature on a helix.
const THIN: f64 = 0.01;

/// Shortens the given tangents of segments that turn the same way at both ends: a convex segment stays inside the
/// triangle of its chord and its end tangents, which is as thin as the smaller of the two turns. Nodes without a
/// given tangent keep their handles.
fn fit_triangles(chain: &mut Chain) {
    for k in 0..chain.segments.len() {
        let span = chain.segments[k].span;
        let ends = chain.ends(k);
        let [start, end] = ends.map(|j| chain.nodes[j].q);
        let turns = [start.cross(span.direction), span.direction.cross(end)];
        if !(turns[0].dot(turns[1]) > 0.0) {
            continue;
        }
        for (own, other, j) in [
            (turns[0], turns[1] / end.length(), ends[0]),
            (turns[1], turns[0] / start.length(), ends[1]),
        ] {
            let arm = own.length() * span.spacing / span.length;
            let side = 3.0 * other.length() / arm;
            if side < THIN && chain.freedom[j].holds_tangent() {
                chain.nodes[j].q *= SHARE * side;
                chain.nodes[j].r *= SHARE * side;
            }
        }
    }
}

/// Puts as many nodes of a chain where the closed-form start has them as it takes for all conditions to
/// hold.
pub(crate) fn replace(demands: &Demands<'_>, chain: &mut Chain) {
    let before = chain.nodes.clone();
    restart_all(demands, chain);
    let closed = std::mem::replace(&mut chain.nodes, before);
    chain.choose_changes();
    // Each round replaces a node at least.
    for _ in 0..=chain.nodes.len() {
        let failing = chain.failing();
        let nodes: Vec<usize> = failing.iter().flat_map(|&k| chain.ends(k)).collect();
        let mut changed = false;
        for j in nodes {
            changed |= chain.nodes[j] != closed[j];
            chain.nodes[j] = closed[j];
        }
        if !changed {
            break;
        }
        chain.choose_changes();
    }
    chain.relax_speeds();
}

/// Puts all nodes of a chain where the closed-form start has them, with handles as long as hold. Given
/// tangents keep their length where that is possible, and else are as short as the handles.
pub(crate) fn restart_all(demands: &Demands<'_>, chain: &mut Chain) {
    chain.ask_no_speed();
    if !start_all(demands, chain, false)
        && chain.freedom.iter().any(|freedom| freedom.holds_tangent())
    {
        start_all(demands, chain, true);
    }
}

/// As [`restart_all`], with given tangents shortened or not. Whether all conditions hold, but those beside nodes
/// that are held, which no start can answer for.
fn start_all(demands: &Demands<'_>, chain: &mut Chain, shortens: bool) -> bool {
    let mut scales = vec![NATURAL; chain.nodes.len()];
    // A handle of 1e−13 of its natural length is the last that is tried.
    for _ in 0..60 {
        for (j, &scales) in scales.iter().enumerate() {
            set_start(demands, chain, j, scales);
            if shortens && chain.freedom[j].holds_tangent() {
                shorten(demands, chain, j, scales);
            }
        }
        if shortens {
            fit_triangles(chain);
        }
        chain.choose_changes();
        let failing = chain.failing().into_iter().map(|k| chain.ends(k));
        let own = failing.filter(|ends| ends.iter().all(|&j| chain.freedom[j] != Freedom::Held));
        let mut shrink: Vec<usize> = own.flatten().collect();
        if shrink.is_empty() {
            return true;
        }
        shrink.sort_unstable();
        shrink.dedup();
        for j in shrink {
            scales[j].handle *= 0.6;
            scales[j].curvature *= 0.8;
        }
        even_out(demands, chain, &mut scales);
    }
    false
}

/// Gives both ends of every segment that inflects near a plane the shorter handle: their ratio says where it
/// inflects.
fn even_out(demands: &Demands<'_>, chain: &Chain, scales: &mut [Scales]) {
    let total = demands.checker.polygon().segments();
    let count = chain.segments.len();
    for k in (0..count).chain((0..count).rev()) {
        if demands.is_split((chain.first + k) % total) {
            let [a, b] = chain.ends(k);
            let least = scales[a].handle.min(scales[b].handle);
            (scales[a].handle, scales[b].handle) = (least, least);
        }
    }
}
