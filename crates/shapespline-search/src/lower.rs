// SPDX-License-Identifier: MIT OR Apache-2.0

//! Lowering tension again: growth overshoots, and what is not needed is given back.
//!
//! Every tension is lowered **by itself**, those at the sharpest ends of segments first, to the least value that keeps the shape while
//! the others stay as they are; passes follow until nothing moves by more than some per cent. A change dies away
//! as `2^{−k}` over `k` nodes, so each trial solves and checks a neighbourhood only, a tension is
//! tried again only if one within reach has moved, and tensions that are far apart are cleared up cluster by
//! cluster.
//!
//! What ties ([`crate::order`]) is lowered together, so that symmetric data keep a symmetric curve whatever
//! the direction in which points are numbered; only where that moves nothing, one after the other.

use std::collections::HashSet;

use shapespline_geometry::DVec3;

use crate::{
    Phase, TensionFamily,
    bending::{bending, bent_by, legs_of_segments},
    group::{Group, RESOLUTION},
    order::{mean_chord, sorted_groups},
    state::{AROUND, State},
    surroundings::Surroundings,
};

/// Nodes between two tensions of which neither feels the other: `2^{−48}` is close to rounding, and tension
/// makes changes die away faster.
const APART: usize = 48;

/// Nodes over which a change by [`RESOLUTION`] falls below what any criterion feels.
const REACH: usize = 8;

/// Nodes between tensions that moved again in one pass and are then lowered together.
const BESIDE: usize = 3;

/// How exactly the first passes find how far each tension can be lowered: as long as its neighbours are not yet
/// where they will be, more would be wasted. Later passes take [`RESOLUTION`].
const RESOLUTIONS: [f64; 2] = [0.15, 0.045];

/// Limit of passes: the last ones move a few tensions by some per cent each.
const PASSES: usize = 24;

/// Bending may grow by this part of itself: less is rounding, or the accuracy of its integral.
const BENDING_SLACK: f64 = 1e-3;

/// Groups tried between two calls of the monitor.
const BETWEEN_CALLS: usize = 64;

/// Lowers the tensions of a curve without violations as far as no violation appears.
pub(crate) fn lower<F: TensionFamily>(state: &mut State<'_, F>) -> Result<(), F::Error> {
    let raised: Vec<usize> = positive(state.family.tension()).collect();
    let polygon = state.windows.polygon();
    let mut descent = Descent::new(mean_chord(polygon));
    let cycle = polygon.is_closed().then_some(polygon.nodes());
    for cluster in clusters(raised, F::SIDES, cycle) {
        descent.around.go(polygon, cluster[0] / F::SIDES);
        descent.lower_cluster(state, &cluster)?;
        if state.stopped {
            break;
        }
    }
    state.log(Phase::Lower, 0, descent.moved);
    Ok(())
}

/// Tensions (ascending) that may feel each other.
fn clusters(raised: Vec<usize>, sides: usize, cycle: Option<usize>) -> Vec<Vec<usize>> {
    let meet = |a: &usize, b: &usize| b / sides - a / sides <= APART;
    let mut all: Vec<Vec<usize>> = raised.chunk_by(meet).map(<[usize]>::to_vec).collect();
    if let Some(nodes) = cycle
        && let [first, .., last] = &*all
        && meet(&last[last.len() - 1], &(first[0] + nodes * sides))
        && let Some(tail) = all.pop()
    {
        // Over the seam.
        all[0].extend(tail);
        all[0].sort_unstable();
    }
    all
}

/// What descents need to know.
struct Descent {
    /// The mean chord.
    unit: f64,
    /// That of the pass.
    resolution: f64,
    around: Surroundings,
    /// Tensions that stay where they are because less makes the curve bend more.
    stay: HashSet<usize>,
    /// Groups that were tried, and how often nodes moved.
    tried: usize,
    moved: usize,
}

impl Descent {
    fn new(unit: f64) -> Self {
        let around = Surroundings::default();
        Self { unit, resolution: RESOLUTION, around, stay: HashSet::new(), tried: 0, moved: 0 }
    }

    /// Lowers tensions that may feel each other: passes over those that may still be lowered, each finer than
    /// the one before.
    fn lower_cluster<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        cluster: &[usize],
    ) -> Result<(), F::Error> {
        let (mut open, mut is_retry) = (cluster.to_vec(), false);
        for pass in 0..PASSES {
            if open.is_empty() {
                break;
            }
            self.resolution = RESOLUTIONS.get(pass).copied().unwrap_or(RESOLUTION);
            let moved = self.lower_each(state, &open, pass > 0)?;
            if state.stopped {
                break;
            }
            if self.resolution <= RESOLUTION {
                self.lower_runs(state, &moved)?;
                let nodes: Vec<usize> = moved.iter().map(|k| k / F::SIDES).collect();
                let cycle = state.closed().then(|| state.windows.polygon().nodes());
                open = cluster.to_vec();
                open.retain(|k| near(&nodes, k / F::SIDES, REACH, cycle));
            }
            let still = |k: &usize| state.family.tension()[*k] > 0.0;
            open.retain(|k| still(k) && !self.stay.contains(k));
            // Those that stayed may go after all, now that the others are where they are.
            let retries = open.is_empty() && !(is_retry && moved.is_empty());
            if retries {
                open.extend(self.stay.drain().filter(still));
                open.sort_unstable();
            }
            is_retry = retries;
        }
        self.stay.clear();
        Ok(())
    }

    /// One pass over some tensions. Returns those that moved, ascending.
    fn lower_each<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        open: &[usize],
        again: bool,
    ) -> Result<Vec<usize>, F::Error> {
        let (polygon, around) = (state.windows.polygon(), &mut self.around);
        let groups = sorted_groups(open, polygon, &*state.family, self.unit, around);
        let mut moved = Vec::new();
        for tied in &groups {
            self.lower_tied(state, tied, again, &mut moved)?;
            self.tried += 1;
            if self.tried.is_multiple_of(BETWEEN_CALLS) {
                state.wants_to_stop(Phase::Lower, moved.len());
            }
            if state.stopped {
                break;
            }
        }
        self.moved += moved.len();
        moved.sort_unstable();
        Ok(moved)
    }

    /// Lowers tensions that moved again, neighbours together: where each lets the others go a little further,
    /// they would take one pass after the other.
    fn lower_runs<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        moved: &[usize],
    ) -> Result<(), F::Error> {
        let still: Vec<usize> =
            moved.iter().copied().filter(|&k| state.family.tension()[k] > 0.0).collect();
        for run in still.chunk_by(|a, b| b / F::SIDES - a / F::SIDES <= BESIDE) {
            if run.len() > 1 && !state.stopped {
                self.lower_group(state, run, true)?;
            }
        }
        Ok(())
    }

    /// Lowers tensions that tie, together or else one after the other, and adds those that moved.
    fn lower_tied<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        tied: &[usize],
        again: bool,
        moved: &mut Vec<usize>,
    ) -> Result<(), F::Error> {
        if self.lower_group(state, tied, again)? {
            moved.extend(tied);
        } else if tied.len() > 1 {
            for k in tied {
                if !state.stopped && self.lower_group(state, &[*k], again)? {
                    moved.push(*k);
                }
            }
        }
        Ok(())
    }

    /// Lowers some tensions by one factor, unless the curve bends more without them: where directions are
    /// wrong, less tension at one node can mean a sharper corner at the next. Returns whether they moved.
    ///
    /// `again`: whether they were tried before, so that most likely they cannot be lowered.
    fn lower_group<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        indices: &[usize],
        again: bool,
    ) -> Result<bool, F::Error> {
        let mut group = Group::of(indices, state.family.tension(), self.resolution);
        if again && state.seems_to_break(group.at(1.0 - group.least()), AROUND) == Some(true) {
            return Ok(false);
        }
        let nodes = indices.iter().map(|k| k / F::SIDES);
        let segments = bent_by(state.windows.polygon(), nodes);
        let before = legs_of_segments(state.family, &segments);
        let factor = group.lower(state, again)?;
        if factor < 1.0 && self.bends_more(state, &segments, &before) {
            state.return_to(group.at(1.0))?;
            self.stay.extend(indices);
            return Ok(false);
        }
        indices.iter().for_each(|k| {
            self.stay.remove(k);
        });
        Ok(factor < 1.0 - self.resolution)
    }

    /// Whether segments bend more than they did with other legs.
    fn bends_more<F: TensionFamily>(
        &self,
        state: &State<'_, F>,
        segments: &[usize],
        before: &[[DVec3; 2]],
    ) -> bool {
        let polygon = state.windows.polygon();
        let now = legs_of_segments(state.family, segments);
        let bends = |legs: &[[DVec3; 2]]| bending(polygon, segments, legs, self.unit);
        bends(&now) > bends(before) * (1.0 + BENDING_SLACK)
    }
}

/// The places of the tensions that are not zero.
fn positive(tension: &[f64]) -> impl Iterator<Item = usize> + '_ {
    tension.iter().enumerate().filter(|(_, t)| **t > 0.0).map(|(k, _)| k)
}

/// Whether some of the nodes, which ascend, are within reach of another.
fn near(nodes: &[usize], node: usize, reach: usize, cycle: Option<usize>) -> bool {
    let within = |node: usize, nodes: &[usize]| {
        let at = nodes.partition_point(|&m| m + reach < node);
        nodes.get(at).is_some_and(|&m| m <= node + reach)
    };
    within(node, nodes)
        || cycle.is_some_and(|n| {
            // Over the seam.
            nodes.first().is_some_and(|&m| m + n <= node + reach)
                || nodes.last().is_some_and(|&m| node + n <= m + reach)
        })
}
