// SPDX-License-Identifier: MIT OR Apache-2.0

//! The ladder on one chain: from the plain cubic to the optimum.

use crate::{
    Energy, Method, Phase,
    barrier::Barrier,
    chain::{Chain, Freedom},
    control::Control,
    mend::{clusters, come_to_hold, mend, part, put, refresh},
    newton::Limits,
    segment::Demands,
    starts::{replace, restart_all},
    window::BESIDE,
};

/// The elastic phase: weights of the barrier, and the penalty.
const ELASTIC: [f64; 3] = [0.1, 0.01, 1e-3];
const PENALTY: f64 = 10.0;

/// Nodes beside failing segments that move in the elastic phase: what it leaves is brought down later, in the
/// whole window.
const NEAR: usize = 3;

/// The last weight of the barrier: the energy is then within some 1 % of its infimum, and margins are
/// ten times larger than at 1e−4.
pub(crate) const LAST: f64 = 1e-3;

/// Deviation over chord below which the plain cubic is no start (on a coil of 128 segments the elastic phase
/// and its restarts took 10 s and ended at the closed-form start).
const TIGHT: f64 = 1e-3;

/// Steps in which the nodes of a window come to meet those beside it.
const MEETING: usize = 40;

/// Newton's last steps; each doubles the digits.
const POLISH: usize = 10;

/// Searches for segments that nearly stop.
const ROUNDS: usize = 4;

/// How much is tried to find a feasible chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Means {
    /// What changes little.
    Near,
    /// All nodes put elsewhere: what changes little was tried in a narrower window.
    Far,
    /// The one, and else the other.
    All,
}

/// Finds a feasible chain, and brings its parametric energy down. The method that it took, or nothing where it takes
/// other means; the whole curve always has an answer.
pub(crate) fn solve(
    demands: &Demands<'_>,
    chain: &mut Chain,
    means: Means,
    control: &mut Control<'_>,
) -> Option<Method> {
    let mut method = Method::Elastic;
    if means != Means::Far && !is_tight(chain) {
        control.begin(Phase::Elastic, chain.failing().len());
        pull(demands, chain, control);
        chain.relax_speeds();
        if !chain.all_hold() {
            method = Method::Windows;
            control.begin(Phase::Restart, chain.failing().len());
            mend(demands, chain, control);
        }
    }
    chain.relax_speeds();
    control.begin(Phase::Improve, chain.failing().len());
    if !chain.all_hold() {
        if means == Means::Near {
            return None;
        }
        method = Method::Sweeps;
        let before = chain.nodes.clone();
        replace(demands, chain);
        if chain.all_hold() {
            improve(chain, 1.0, control);
            improve(chain, 0.1, control);
        } else {
            chain.nodes = before;
            approach(demands, chain, control);
        }
    }
    improve(chain, 0.01, control);
    Some(method)
}

/// The elastic phase: pulls what fails into shape, each run of failing segments by itself.
fn pull(demands: &Demands<'_>, chain: &mut Chain, control: &mut Control<'_>) {
    for nodes in clusters(chain, &chain.failing(), NEAR) {
        let mut part = part(chain, nodes);
        for weight in ELASTIC {
            part.choose_changes();
            let barrier = Barrier { weight, penalty: Some(PENALTY), protects: false };
            let limits = Limits { decrement: 0.1 * weight, steps: 60, until_all_hold: false };
            part.minimise(&barrier, limits, control);
        }
        put(demands, chain, &part);
    }
}

/// From the closed-form start, where its nodes and the held ones beside a window do not meet: the window is solved with
/// ends that are free, and then its outer nodes are put back, where the curve is the plain cubic again.
fn approach(demands: &Demands<'_>, chain: &mut Chain, control: &mut Control<'_>) {
    let (nodes, freedom) = (chain.nodes.clone(), chain.freedom.clone());
    for own in &mut chain.freedom {
        if *own == Freedom::Held {
            *own = Freedom::Free;
        }
    }
    restart_all(demands, chain);
    for weight in [1.0, 0.1, 0.01] {
        improve(chain, weight, control);
    }
    chain.freedom = freedom;
    let last = nodes.len() - 1;
    for (j, node) in nodes.into_iter().enumerate() {
        let near = |end: usize| chain.freedom[end] == Freedom::Held && j.abs_diff(end) < BESIDE;
        if near(0) || near(last) {
            chain.nodes[j] = node;
        }
    }
    chain.relax_speeds();
    if !chain.all_hold() {
        come_to_hold(chain, MEETING, control);
        chain.relax_speeds();
    }
}

/// Brings a chain that nearly holds to hold, and then to its minimum. Whether it came to hold.
pub(crate) fn settle_nearby(chain: &mut Chain, energy: Energy, control: &mut Control<'_>) -> bool {
    if energy == Energy::Bending {
        chain.bend();
    }
    // As the curve was found: with middle coefficients as exact as they are asked for.
    chain.set_exact_middles(true);
    chain.relax_speeds();
    if !chain.all_hold() {
        control.begin(Phase::Elastic, chain.failing().len());
        chain.set_exact_middles(false);
        for penalty in [1e2, 1e4] {
            let barrier = Barrier { weight: 0.01, penalty: Some(penalty), protects: true };
            let limits = Limits { decrement: 1e-3, steps: 60, until_all_hold: true };
            chain.minimise(&barrier, limits, control);
        }
        chain.set_exact_middles(true);
        chain.relax_speeds();
    }
    if !chain.all_hold() {
        return false;
    }
    // Where the curve nearly stops it goes on to bend less.
    if (0..chain.segments.len()).any(|k| chain.nearly_stops(k)) {
        chain.bend();
    }
    control.begin(Phase::Improve, 0);
    finish(chain, 0.01, control);
    finish(chain, LAST, control);
    true
}

/// Whether control points have to lie so near their chords that the curve is all but the polygon: then only
/// handles as short as those of the closed-form start will do, and it nearly stops at every node.
fn is_tight(chain: &Chain) -> bool {
    chain.segments.iter().any(|segment| segment.deviation.is_some_and(|d| d < TIGHT))
}

/// Where a feasible chain nearly stops, `∫|Q''|²du` does not see how it bends: minimises the bending energy of
/// such a chain, with restarts at its slow segments.
pub(crate) fn quicken(demands: &Demands<'_>, chain: &mut Chain, control: &mut Control<'_>) {
    if is_tight(chain) || !chain.all_hold() {
        return;
    }
    let count = chain.segments.len();
    let mut tried = vec![false; count];
    for _ in 0..ROUNDS {
        let slow: Vec<usize> = (0..count).filter(|&k| !tried[k] && chain.nearly_stops(k)).collect();
        if slow.is_empty() || control.is_over() {
            break;
        }
        slow.iter().for_each(|&k| tried[k] = true);
        control.begin(Phase::Restart, slow.len());
        let before = (chain.nodes.clone(), chain.segments.clone());
        chain.bend();
        refresh(demands, chain, &slow, control);
        control.begin(Phase::Improve, 0);
        improve(chain, 0.1, control);
        improve(chain, 0.01, control);
        if !chain.all_hold() {
            (chain.nodes, chain.segments) = before;
            chain.choose_changes();
            break;
        }
    }
}

/// Brings the bending energy of a feasible chain down to the end.
pub(crate) fn finish_bending(chain: &mut Chain, control: &mut Control<'_>) {
    chain.bend();
    control.begin(Phase::Improve, 0);
    for weight in [1.0, 0.1, 0.01] {
        improve(chain, weight, control);
    }
    finish(chain, LAST, control);
}

/// The minimum at the last weight, as accurately as rounding allows.
pub(crate) fn finish(chain: &mut Chain, weight: f64, control: &mut Control<'_>) {
    chain.set_exact_middles(true);
    let barrier = Barrier { weight, penalty: None, protects: false };
    let limits = Limits { decrement: 1e-3 * weight, steps: 100, until_all_hold: false };
    chain.minimise(&barrier, limits, control);
    chain.polish(&barrier, POLISH, control);
}

/// Newton's steps with the barrier proper.
pub(crate) fn improve(chain: &mut Chain, weight: f64, control: &mut Control<'_>) {
    chain.set_exact_middles(false);
    let barrier = Barrier { weight, penalty: None, protects: false };
    let limits = Limits { decrement: 0.03 * weight, steps: 100, until_all_hold: false };
    chain.minimise(&barrier, limits, control);
}
