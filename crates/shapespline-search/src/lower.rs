//! Lowering tension again: growth overshoots, and what is not needed is given back.
//!
//! Every tension is lowered **by itself**, those at the sharpest ends of segments first, to the least value that keeps the shape while
//! the others stay as they are; passes follow until nothing moves by more than some per cent. A change dies away
//! as `2^{−k}` over `k` nodes, so each trial solves and checks a neighbourhood only, and a tension is
//! tried again only if one within reach has moved.
//!
//! What ties ([`crate::order`]) is lowered together, so that symmetric data keep a symmetric curve whatever
//! the direction in which points are numbered; only where that moves nothing, one after the other.

use std::collections::HashSet;

use crate::{
    Phase, TensionFamily,
    group::{Bending, Group, RESOLUTION, bent_by},
    order::{Chords, mean_chord, sorted_groups},
    state::State,
    surroundings::Surroundings,
};

/// Nodes over which a change by [`RESOLUTION`] falls below what any criterion feels.
const REACH: usize = 8;

/// The same for tensions that were left where they are for the curve's sake.
const BESIDE: usize = 2;

/// A tension that was lowered before is tried again if less by this part of itself seems to do: more than
/// what was added so as not to be on the brink.
const LEAST: f64 = 2.5 * RESOLUTION;

/// Limit of passes: the last ones move a few tensions by some per cent each.
const PASSES: usize = 24;

/// Bending may grow by this part of itself: less is rounding, or the accuracy of the quadrature.
const BENDING_SLACK: f64 = 1e-3;

/// Groups tried between two calls of the monitor.
const BETWEEN_CALLS: usize = 64;

/// Lowers the tensions of a curve without faults as far as that leaves it without faults.
///
/// Where several tensions hold each other up, what is left depends on which is tried first. Two orders are
/// tried, and the one after which the curve bends less is kept.
pub(crate) fn lower<F: TensionFamily>(state: &mut State<'_, F>) -> Result<(), F::Error> {
    let raised: Vec<usize> = positive(state.family.tension()).collect();
    let (polygon, values) =
        (state.windows.polygon(), |state: &State<'_, F>| -> Vec<(usize, f64)> {
            raised.iter().map(|&k| (k, state.family.tension()[k])).collect()
        });
    let segments = bent_by(polygon, raised.iter().map(|k| k / F::SIDES));
    let unit = mean_chord(polygon);
    let mut descent = Descent::new(unit);
    let full = values(state);
    descent.lower(state, &raised, Chords::ShortFirst)?;
    if state.stopped {
        return Ok(());
    }
    let (first, bends) = (values(state), descent.bending.of(state, &segments));
    state.return_to(&full)?;
    descent.lower(state, &raised, Chords::LongFirst)?;
    if descent.bending.of(state, &segments) > bends * (1.0 - BENDING_SLACK) {
        state.return_to(&first)?;
    }
    Ok(())
}

/// What descents need to know.
struct Descent {
    /// The mean chord.
    unit: f64,
    around: Surroundings,
    bending: Bending,
    /// Tensions that stay where they are because less makes the curve bend more.
    stay: HashSet<usize>,
}

impl Descent {
    fn new(unit: f64) -> Self {
        let (around, bending) = (Surroundings::default(), Bending::new(unit));
        Self { unit, around, bending, stay: HashSet::new() }
    }

    /// Passes over the tensions that may still be lowered.
    fn lower<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        raised: &[usize],
        chords: Chords,
    ) -> Result<(), F::Error> {
        let mut open = raised.to_vec();
        self.stay.clear();
        for pass in 0..PASSES {
            let mut moved = Vec::new();
            let (polygon, order) = (state.windows.polygon(), (chords, self.unit));
            let groups = sorted_groups(&open, polygon, &*state.family, order, &mut self.around);
            for (count, tied) in groups.iter().enumerate() {
                self.lower_tied(state, tied, pass > 0, &mut moved)?;
                if count % BETWEEN_CALLS == BETWEEN_CALLS - 1
                    && state.wants_to_stop(Phase::Lower, moved.len())
                {
                    break;
                }
            }
            state.log(Phase::Lower, 0, moved.len());
            if state.stopped {
                break;
            }
            if moved.is_empty() {
                // Those that stayed may go after all, now that the others are where they are.
                let stayed = self.stay.drain().filter(|&k| state.family.tension()[k] > 0.0);
                let mut stayed: Vec<usize> = stayed.collect();
                stayed.sort_unstable();
                if stayed.is_empty() || open == stayed {
                    break;
                }
                open = stayed;
                continue;
            }
            moved.sort_unstable();
            let (nodes, closed) = (state.windows.polygon().nodes(), state.closed());
            let is_near = |k: &usize| {
                let reach = if self.stay.contains(k) { BESIDE } else { REACH };
                near(&moved, k / F::SIDES, reach, closed.then_some(nodes))
            };
            open = positive(state.family.tension()).filter(is_near).collect();
        }
        Ok(())
    }

    /// Lowers tensions that tie, together or else one after the other, and adds the nodes that moved.
    fn lower_tied<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        tied: &[usize],
        again: bool,
        moved: &mut Vec<usize>,
    ) -> Result<(), F::Error> {
        if self.lower_group(state, tied, again)? {
            moved.extend(tied.iter().map(|k| k / F::SIDES));
        } else if tied.len() > 1 {
            for k in tied {
                if !state.stopped && self.lower_group(state, &[*k], again)? {
                    moved.push(k / F::SIDES);
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
        if again && state.seems_to_break(group.at(1.0 - LEAST)) == Some(true) {
            return Ok(false);
        }
        let nodes = indices.iter().map(|k| k / F::SIDES);
        let segments = bent_by(state.windows.polygon(), nodes);
        let before = self.bending.of(state, &segments);
        let factor = group.lower(state)?;
        if factor < 1.0 && self.bending.of(state, &segments) > before * (1.0 + BENDING_SLACK) {
            state.return_to(group.at(1.0))?;
            self.stay.extend(indices);
            return Ok(false);
        }
        indices.iter().for_each(|k| {
            self.stay.remove(k);
        });
        Ok(factor < 1.0 - RESOLUTION)
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
