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

use std::{collections::HashSet, ops::Range};

use shapespline_geometry::DVec3;

use crate::{
    Phase, TensionFamily,
    bending::{bending, bent_by, legs_of_segments},
    group::{Group, LEAST, RESOLUTION},
    order::{Chords, mean_chord, sorted_groups},
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

/// Passes after which of two orders one is kept.
const TRIED: usize = 2;

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
        Self { unit, around, stay: HashSet::new(), tried: 0, moved: 0 }
    }

    /// Lowers tensions that may feel each other.
    ///
    /// Where several tensions hold each other up, what is left depends on which is tried first. Where chords
    /// decide that, both orders are tried for some passes, and the one after which the curve bends less is
    /// kept.
    fn lower_cluster<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        cluster: &[usize],
    ) -> Result<(), F::Error> {
        let values = |state: &State<'_, F>| -> Vec<(usize, f64)> {
            cluster.iter().map(|&k| (k, state.family.tension()[k])).collect()
        };
        let (polygon, unit, full) = (state.windows.polygon(), self.unit, values(state));
        let mut chords = Chords::ShortFirst;
        let groups = self.groups(state, cluster, chords);
        let others = self.groups(state, cluster, Chords::LongFirst);
        let differs = groups != others;
        let mut open = self.descend(state, cluster, groups, chords, 0..TRIED)?;
        if differs && !state.stopped {
            let segments = bent_by(polygon, cluster.iter().map(|k| k / F::SIDES));
            let bends = |state: &State<'_, F>| {
                bending(polygon, &segments, &legs_of_segments(state.family, &segments), unit)
            };
            let (first, before) = (values(state), bends(state));
            let (first_open, stay) = (open, std::mem::take(&mut self.stay));
            state.return_to(&full)?;
            open = self.descend(state, cluster, others, Chords::LongFirst, 0..TRIED)?;
            if bends(state) > before * (1.0 - BENDING_SLACK) {
                state.return_to(&first)?;
                (open, self.stay) = (first_open, stay);
            } else {
                chords = Chords::LongFirst;
            }
        }
        if !open.is_empty() && !state.stopped {
            let groups = self.groups(state, &open, chords);
            self.descend(state, cluster, groups, chords, TRIED..PASSES)?;
        }
        self.stay.clear();
        Ok(())
    }

    /// Tensions in the order in which they are tried, what ties together.
    fn groups<F: TensionFamily>(
        &mut self,
        state: &State<'_, F>,
        open: &[usize],
        chords: Chords,
    ) -> Vec<Vec<usize>> {
        let (polygon, order) = (state.windows.polygon(), (chords, self.unit));
        sorted_groups(open, polygon, &*state.family, order, &mut self.around)
    }

    /// Passes over the tensions that may still be lowered, the first one in a known order. Returns those that
    /// may be lowered still.
    fn descend<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        cluster: &[usize],
        mut groups: Vec<Vec<usize>>,
        chords: Chords,
        passes: Range<usize>,
    ) -> Result<Vec<usize>, F::Error> {
        let (nodes, closed) = (state.windows.polygon().nodes(), state.closed());
        let still = |state: &State<'_, F>, k: usize| state.family.tension()[k] > 0.0;
        let (mut open, mut are_stayed) = (Vec::new(), false);
        for pass in passes {
            let mut moved = Vec::new();
            for tied in &groups {
                self.lower_tied(state, tied, pass > 0, &mut moved)?;
                self.tried += 1;
                if self.tried.is_multiple_of(BETWEEN_CALLS) {
                    state.wants_to_stop(Phase::Lower, moved.len());
                }
                if state.stopped {
                    return Ok(open);
                }
            }
            self.moved += moved.len();
            if moved.is_empty() && are_stayed {
                return Ok(Vec::new());
            }
            are_stayed = moved.is_empty();
            open = if are_stayed {
                // Those that stayed may go after all, now that the others are where they are.
                let mut stayed: Vec<usize> = self.stay.drain().collect();
                stayed.retain(|&k| still(state, k));
                stayed.sort_unstable();
                stayed
            } else {
                moved.sort_unstable();
                if pass > 1 {
                    self.lower_runs(state, &moved)?;
                }
                moved.iter_mut().for_each(|k| *k /= F::SIDES);
                let cycle = closed.then_some(nodes);
                let is_open = |k: &usize| {
                    still(state, *k)
                        && !self.stay.contains(k)
                        && near(&moved, k / F::SIDES, REACH, cycle)
                };
                cluster.iter().copied().filter(is_open).collect()
            };
            if open.is_empty() {
                break;
            }
            groups = self.groups(state, &open, chords);
        }
        Ok(open)
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
        let mut group = Group::of(indices, state.family.tension());
        if again && state.seems_to_break(group.at(1.0 - LEAST), AROUND) == Some(true) {
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
        Ok(factor < 1.0 - RESOLUTION)
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
