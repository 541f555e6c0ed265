//! The ladder on one chain: from the plain cubic to the optimum.

use crate::{
    Energy, Method, Phase,
    barrier::Barrier,
    chain::Chain,
    control::Control,
    mend::{clusters, mend, part, put, refresh, set_start, shorten},
    newton::Limits,
    segment::Demands,
    start::Scales,
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

/// Newton's last steps; each doubles the digits.
const POLISH: usize = 10;

/// Searches for segments that nearly stop.
const ROUNDS: usize = 4;

/// Finds a feasible chain (by all means if it is to be `thorough`), and brings its parametric energy down. The
/// method that it took, or nothing where it takes a wider chain; the whole curve always has an answer.
pub(crate) fn solve(
    demands: &Demands<'_>,
    chain: &mut Chain,
    thorough: bool,
    control: &mut Control<'_>,
) -> Option<Method> {
    let mut method = Method::Elastic;
    let is_tight = is_tight(chain);
    if !is_tight {
        control.begin(Phase::Elastic, chain.failing().len());
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
    chain.relax_speeds();
    if !chain.all_hold() && !is_tight {
        method = Method::Windows;
        control.begin(Phase::Restart, chain.failing().len());
        mend(demands, chain, control);
        chain.relax_speeds();
    }
    control.begin(Phase::Improve, chain.failing().len());
    if !chain.all_hold() {
        if !thorough {
            return None;
        }
        method = Method::Sweeps;
        replace(demands, chain);
        improve(chain, 1.0, control);
        improve(chain, 0.1, control);
    }
    improve(chain, 0.01, control);
    Some(method)
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
    if is_tight(chain) {
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

/// As [`restart_all`], with given tangents shortened or not. Whether all conditions hold.
fn start_all(demands: &Demands<'_>, chain: &mut Chain, shortens: bool) -> bool {
    let natural = Scales { tilt: 1.0, handle: 1.0, curvature: 0.3 };
    let mut scales = vec![natural; chain.nodes.len()];
    // A handle of 1e−13 of its natural length is the last that is tried.
    for _ in 0..60 {
        for (j, &scales) in scales.iter().enumerate() {
            set_start(demands, chain, j, scales);
            if shortens && chain.freedom[j].holds_tangent() {
                shorten(demands, chain, j, scales);
            }
        }
        chain.choose_changes();
        let mut shrink: Vec<usize> = chain.failing().iter().flat_map(|&k| chain.ends(k)).collect();
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
