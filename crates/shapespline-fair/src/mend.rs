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
    start::{Scales, start},
};

/// Scales of the restarts that are tried.
const SCALES: [Scales; 3] = [
    Scales { tilt: 1.0, handle: 0.3, curvature: 0.5 },
    Scales { tilt: 1.0, handle: 1.0, curvature: 1.0 },
    Scales { tilt: 0.5, handle: 0.1, curvature: 0.3 },
];

/// Failing segments are restarted with none, one … nodes more on each side.
const PADS: usize = 4;

/// Nodes beside a restart that may move until it settles.
const MARGIN: usize = 6;

/// Segments in runs: the nodes at them, with some more on both sides.
fn clusters(chain: &Chain, segments: &[usize], pad: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let last = chain.nodes.len();
    for &k in segments {
        let nodes = k.saturating_sub(pad)..(k + 2 + pad).min(last);
        match runs.last_mut() {
            Some(run) if nodes.start <= run.end => run.end = nodes.end,
            _ => runs.push(nodes),
        }
    }
    runs
}

/// Mends all that fails, as far as that goes.
pub(crate) fn mend(demands: &Demands<'_>, chain: &mut Chain, control: &mut Control<'_>) {
    for pad in 0..PADS {
        for nodes in clusters(chain, &chain.failing(), pad) {
            if let Some((_, part)) = best_restart(demands, chain, &nodes, control) {
                put(chain, &part);
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
            let (value, part) = settle(chain, &part(chain, nodes.clone()), control);
            let best = best_restart(demands, chain, &nodes, control);
            let best = best.filter(|best| best.1.all_hold() && best.0 < value);
            put(chain, best.as_ref().map_or(&part, |best| &best.1));
        }
    }
}

/// The best of the restarts of some nodes that come to hold.
fn best_restart(
    demands: &Demands<'_>,
    chain: &Chain,
    nodes: &Range<usize>,
    control: &mut Control<'_>,
) -> Option<(f64, Chain)> {
    let mut best: Option<(f64, Chain)> = None;
    for scales in SCALES {
        let mut part = restart(demands, chain, nodes.clone(), scales);
        let barrier = Barrier { weight: 10.0, penalty: Some(1e4), protects: true };
        let limits = Limits { decrement: 1e-3, steps: 40, until_all_hold: true };
        part.minimise(&barrier, limits, control);
        if !part.all_hold() {
            continue;
        }
        let (value, settled) = settle(chain, &part, control);
        if best.as_ref().is_none_or(|best| value < best.0) {
            best = Some((value, settled));
        }
    }
    best
}

/// Puts a part back into the chain that it was taken from.
fn put(chain: &mut Chain, part: &Chain) {
    let at = part.first - chain.first;
    let inside = at..at + part.nodes.len();
    chain.nodes[inside].copy_from_slice(&part.nodes);
    for (own, other) in chain.segments[at..].iter_mut().zip(&part.segments) {
        own.speed = other.speed;
    }
    chain.choose_changes();
}

/// The part of a chain around some nodes, which may move.
fn part(chain: &Chain, nodes: Range<usize>) -> Chain {
    let from = nodes.start.saturating_sub(1);
    let to = (nodes.end + 1).min(chain.nodes.len());
    let freedom = (from..to)
        .map(|i| if nodes.contains(&i) { chain.freedom[i] } else { Freedom::Held })
        .collect();
    let segments = chain.segments[from..to - 1].to_vec();
    let nodes = chain.nodes[from..to].to_vec();
    Chain::new(segments, nodes, freedom, chain.first + from, chain.rules)
}

fn restart(demands: &Demands<'_>, chain: &Chain, nodes: Range<usize>, scales: Scales) -> Chain {
    let mut part = part(chain, nodes);
    for j in 0..part.nodes.len() {
        set_start(demands, &mut part, j, scales);
    }
    part.ask_no_speed();
    part
}

/// Puts a node where the closed-form start has it, as far as it may move.
pub(crate) fn set_start(demands: &Demands<'_>, chain: &mut Chain, j: usize, scales: Scales) {
    let total = demands.checker.polygon().nodes();
    let start = start(demands, (chain.first + j) % total, scales);
    match chain.freedom[j] {
        Freedom::Free => chain.nodes[j] = start,
        Freedom::TangentHeld => chain.nodes[j].r = start.r,
        Freedom::Held => {}
    }
}

/// Lets a mended part and its surroundings settle: what is minimised there, and the nodes.
fn settle(chain: &Chain, mended: &Chain, control: &mut Control<'_>) -> (f64, Chain) {
    let at = mended.first - chain.first;
    let from = at.saturating_sub(MARGIN);
    let to = (at + mended.nodes.len() + MARGIN).min(chain.nodes.len());
    let mut part = part(chain, from..to);
    put(&mut part, mended);
    for (weight, decrement) in [(0.1, 1e-2), (0.01, 1e-3)] {
        // Other clusters nearby may still fail.
        let penalty = if part.all_hold() { None } else { Some(10.0) };
        let barrier = Barrier { weight, penalty, protects: true };
        let limits = Limits { decrement, steps: 60, until_all_hold: false };
        part.minimise(&barrier, limits, control);
    }
    (part.objective(), part)
}
