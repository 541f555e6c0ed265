// SPDX-License-Identifier: MIT OR Apache-2.0

//! Restarts from the closed-form start, in small windows.
//!
//! The elastic barrier can come to rest where conditions fail by little and no small move helps: `ω`
//! vanishes at a node whose osculating plane lies on the wrong side. There the nodes of the failing
//! segments are put where the closed-form start has them; conditions that hold from then on are kept by
//! the barrier proper, and only those that fail, between these nodes and the others, stay elastic.

use std::ops::Range;

use crate::{
    barrier::Barrier,
    chain::{Chain, Freedom},
    control::Control,
    newton::Limits,
    segment::Demands,
    start::Scales,
    starts::set_start,
};

/// Scales of the restarts that are tried.
const SCALES: [Scales; 3] = [
    Scales { tilt: 1.0, handle: 0.3, curvature: 0.5 },
    Scales { tilt: 1.0, handle: 1.0, curvature: 1.0 },
    Scales { tilt: 0.5, handle: 0.1, curvature: 0.3 },
];

/// Failing segments are restarted with one, two … nodes more on each side.
const PADS: Range<usize> = 1..4;

/// Nodes beside a restart that may move until it settles.
const MARGIN: usize = 3;

/// A restart is taken for better where its objective is less by this share: what rounding decides would depend on
/// the directions of the axes.
const BETTER: f64 = 3e-4;

/// How much restarts are worth.
struct Effort {
    /// Steps after which one that does not hold is given up.
    steps: usize,
    /// Weights of the barrier while it settles, each with the decrement that ends it.
    settling: &'static [(f64, f64)],
    /// Whether all are tried, or only those up to the first that goes on at a good speed.
    all: bool,
}

/// Where nothing but a feasible part is looked for: restarts that come to hold mostly take four to twelve steps.
const QUICK: Effort = Effort { steps: 16, settling: &[(0.1, 0.1)], all: false };
/// Where parts are compared: what is better must not depend on how far they have settled.
const THOROUGH: Effort = Effort { steps: 40, settling: &[(0.1, 1e-2), (0.01, 1e-3)], all: true };

/// Segments in runs: the nodes at them, with some more on both sides. In a ring a run may go on beyond
/// the last node, and begins below it.
pub(crate) fn clusters(chain: &Chain, segments: &[usize], pad: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let count = chain.nodes.len();
    let ring = chain.is_ring();
    for &k in segments {
        let nodes = if ring {
            k + count - pad.min(count)..k + count + 2 + pad
        } else {
            k.saturating_sub(pad)..(k + 2 + pad).min(count)
        };
        match runs.last_mut() {
            Some(run) if nodes.start <= run.end => run.end = nodes.end,
            _ => runs.push(nodes),
        }
    }
    if !ring {
        return runs;
    }
    if let [first, .., last] = runs.as_mut_slice()
        && last.end >= first.start + count
    {
        last.end = last.end.max(first.end + count);
        runs.remove(0);
    }
    for run in &mut runs {
        *run = if run.len() >= count {
            0..count
        } else {
            run.start % count..run.start % count + run.len()
        };
    }
    runs
}

/// Mends all that fails, as far as that goes.
pub(crate) fn mend(demands: &Demands<'_>, chain: &mut Chain, control: &mut Control<'_>) {
    for pad in PADS {
        for nodes in clusters(chain, &chain.failing(), pad) {
            if let Some((_, part)) = best_restart(demands, chain, &nodes, &QUICK, control) {
                put(demands, chain, &part);
            }
        }
        if chain.all_hold() || control.is_over() {
            break;
        }
    }
}

/// Restarts around some segments of a feasible chain, and keeps what is better than before.
pub(crate) fn refresh(
    demands: &Demands<'_>,
    chain: &mut Chain,
    segments: &[usize],
    control: &mut Control<'_>,
) {
    for pad in 0..2 {
        for nodes in clusters(chain, segments, pad) {
            let (value, part) =
                settle(demands, chain, &part(chain, nodes.clone()), &THOROUGH, control);
            let best = best_restart(demands, chain, &nodes, &THOROUGH, control);
            let best = best.filter(|best| best.1.all_hold() && is_better(best.0, value));
            put(demands, chain, best.as_ref().map_or(&part, |best| &best.1));
        }
    }
}

/// The best of the restarts of some nodes that come to hold.
fn best_restart(
    demands: &Demands<'_>,
    chain: &Chain,
    nodes: &Range<usize>,
    effort: &Effort,
    control: &mut Control<'_>,
) -> Option<(f64, Chain)> {
    let mut best: Option<(f64, Chain)> = None;
    for scales in SCALES {
        let mut part = part(chain, nodes.clone());
        restart(demands, &mut part, scales);
        come_to_hold(&mut part, effort.steps, control);
        if !part.all_hold() {
            continue;
        }
        let (value, settled) = settle(demands, chain, &part, effort, control);
        if best.as_ref().is_none_or(|best| is_better(value, best.0)) {
            best = Some((value, settled));
        }
        let stops = |part: &Chain| (0..part.segments.len()).any(|k| part.nearly_stops(k));
        if !effort.all && best.as_ref().is_some_and(|(_, part)| !stops(part)) {
            break;
        }
    }
    best
}

fn is_better(value: f64, than: f64) -> bool {
    value < (1.0 - BETTER) * than
}

/// Puts a part back into the chain that it was taken from.
pub(crate) fn put(demands: &Demands<'_>, chain: &mut Chain, part: &Chain) {
    let at = begin(demands, chain, part);
    let (nodes, segments) = (chain.nodes.len(), chain.segments.len());
    for (j, node) in part.nodes.iter().enumerate() {
        chain.nodes[(at + j) % nodes] = *node;
    }
    for (k, other) in part.segments.iter().enumerate() {
        chain.segments[(at + k) % segments].speed = other.speed;
    }
    chain.choose_changes();
}

/// Where in a chain a part of it begins.
fn begin(demands: &Demands<'_>, chain: &Chain, part: &Chain) -> usize {
    let total = demands.checker.polygon().nodes();
    (part.first % total + total - chain.first % total) % total
}

/// The part of a chain around some nodes, which may move. In a ring they may go on beyond the last.
pub(crate) fn part(chain: &Chain, nodes: Range<usize>) -> Chain {
    let count = chain.nodes.len();
    let (from, to) = if !chain.is_ring() {
        (nodes.start.saturating_sub(1), (nodes.end + 1).min(count))
    } else if nodes.len() + 2 <= count {
        (nodes.start + count - 1, nodes.end + count + 1)
    } else {
        (0, count)
    };
    // Without a held node on each side the part of a ring is the ring.
    let ring = chain.is_ring() && to - from == count && nodes.len() + 2 > count;
    let is_inside = |i: usize| {
        if chain.is_ring() {
            (i + count - nodes.start % count) % count < nodes.len()
        } else {
            nodes.contains(&i)
        }
    };
    let freedom = (from..to)
        .map(|i| if is_inside(i % count) { chain.freedom[i % count] } else { Freedom::Held })
        .collect();
    let last = if ring { to } else { to - 1 };
    let segments = (from..last).map(|k| chain.segments[k % count].clone()).collect();
    let parts = (from..to).map(|i| chain.nodes[i % count]).collect();
    Chain::new(segments, parts, freedom, chain.first + from, chain.rules)
}

/// Puts all nodes of a part that may move where the closed-form start has them.
fn restart(demands: &Demands<'_>, part: &mut Chain, scales: Scales) {
    for j in 0..part.nodes.len() {
        set_start(demands, part, j, scales);
    }
    part.ask_no_speed();
}

/// Brings what fails of a chain to hold, while the barrier proper keeps what holds.
pub(crate) fn come_to_hold(chain: &mut Chain, steps: usize, control: &mut Control<'_>) {
    let barrier = Barrier { weight: 10.0, penalty: Some(1e4), protects: true };
    let limits = Limits { decrement: 1e-3, steps, until_all_hold: true };
    chain.minimise(&barrier, limits, control);
}

/// Lets a mended part and its surroundings settle: what is minimised there, and the nodes.
fn settle(
    demands: &Demands<'_>,
    chain: &Chain,
    mended: &Chain,
    effort: &Effort,
    control: &mut Control<'_>,
) -> (f64, Chain) {
    let (at, count) = (begin(demands, chain, mended), chain.nodes.len());
    let nodes = if chain.is_ring() {
        let length = mended.nodes.len() + 2 * MARGIN;
        let start = (at + count - MARGIN % count) % count;
        if length >= count { 0..count } else { start..start + length }
    } else {
        at.saturating_sub(MARGIN)..(at + mended.nodes.len() + MARGIN).min(count)
    };
    let mut part = part(chain, nodes);
    put(demands, &mut part, mended);
    for &(weight, decrement) in effort.settling {
        // Other clusters nearby may still fail.
        let penalty = if part.all_hold() { None } else { Some(10.0) };
        let barrier = Barrier { weight, penalty, protects: true };
        let limits = Limits { decrement, steps: 60, until_all_hold: false };
        part.minimise(&barrier, limits, control);
    }
    (part.objective(), part)
}
