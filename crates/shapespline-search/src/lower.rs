//! Lowering tension again: growth overshoots, and what is not needed is given back.
//!
//! Every tension is lowered **by itself**, those at the sharpest ends of segments first, to the least value that keeps the shape while
//! the others stay as they are; passes follow until nothing moves by more than 1 %. A change dies away
//! as `2^{−k}` over `k` nodes, so each trial solves and checks a neighbourhood only, and a tension is
//! tried again only if one within reach has moved.
//!
//! What ties ([`crate::order`]) is lowered together, so that symmetric data keep a symmetric curve whatever
//! the direction in which points are numbered; only where that moves nothing, one after the other.

use crate::{
    Phase, TensionFamily,
    group::{Group, RESOLUTION, bending_around},
    order::{Chords, sorted_groups},
    state::State,
};

/// Nodes over which a change by [`RESOLUTION`] falls below what any criterion feels.
const REACH: usize = 16;

/// Limit of passes. Three to ten are usual.
const PASSES: usize = 64;

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
    let values = |state: &State<'_, F>| -> Vec<(usize, f64)> {
        raised.iter().map(|&k| (k, state.family.tension()[k])).collect()
    };
    let bending = |state: &State<'_, F>| -> f64 {
        raised.iter().map(|k| bending_around(state, k / F::SIDES)).sum()
    };
    let full = values(state);
    lower_in_order(state, &raised, Chords::ShortFirst)?;
    let (first, bends) = (values(state), bending(state));
    state.return_to(&full)?;
    lower_in_order(state, &raised, Chords::LongFirst)?;
    if bending(state) > bends * (1.0 - BENDING_SLACK) {
        state.return_to(&first)?;
    }
    Ok(())
}

/// One descent: passes over the tensions that may still be lowered.
fn lower_in_order<F: TensionFamily>(
    state: &mut State<'_, F>,
    raised: &[usize],
    chords: Chords,
) -> Result<(), F::Error> {
    let mut open = raised.to_vec();
    for pass in 0..PASSES {
        let mut moved = Vec::new();
        let groups = sorted_groups(&open, state.windows.polygon(), &*state.family, chords);
        for (count, tied) in groups.iter().enumerate() {
            lower_tied(state, tied, pass > 0, &mut moved)?;
            if count % BETWEEN_CALLS == BETWEEN_CALLS - 1
                && state.wants_to_stop(Phase::Lower, moved.len())
            {
                break;
            }
        }
        state.log(Phase::Lower, 0, moved.len());
        if moved.is_empty() || state.stopped {
            break;
        }
        moved.sort_unstable();
        let (nodes, closed) = (state.windows.polygon().nodes(), state.closed());
        let is_near = |k: &usize| near(&moved, k / F::SIDES, closed.then_some(nodes));
        open = positive(state.family.tension()).filter(is_near).collect();
    }
    Ok(())
}

/// Lowers tensions that tie, together or else one after the other, and adds the nodes that moved.
fn lower_tied<F: TensionFamily>(
    state: &mut State<'_, F>,
    tied: &[usize],
    again: bool,
    moved: &mut Vec<usize>,
) -> Result<(), F::Error> {
    if lower_group(state, tied, again)? {
        moved.extend(tied.iter().map(|k| k / F::SIDES));
    } else if tied.len() > 1 {
        for k in tied {
            if !state.stopped && lower_group(state, &[*k], again)? {
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
    state: &mut State<'_, F>,
    indices: &[usize],
    again: bool,
) -> Result<bool, F::Error> {
    let mut group = Group::of(indices, state.family.tension());
    if again && state.seems_to_break(group.at(1.0 - RESOLUTION)) == Some(true) {
        return Ok(false);
    }
    let bending = |state: &State<'_, F>| -> f64 {
        indices.iter().map(|k| bending_around(state, k / F::SIDES)).sum()
    };
    let before = bending(state);
    let factor = group.lower(state)?;
    if factor < 1.0 && bending(state) > before * (1.0 + BENDING_SLACK) {
        state.return_to(group.at(1.0))?;
        return Ok(false);
    }
    Ok(factor < 1.0 - RESOLUTION)
}

/// The places of the tensions that are not zero.
fn positive(tension: &[f64]) -> impl Iterator<Item = usize> + '_ {
    tension.iter().enumerate().filter(|(_, t)| **t > 0.0).map(|(k, _)| k)
}

/// Whether some of the nodes, which ascend, are within reach of another.
fn near(nodes: &[usize], node: usize, cycle: Option<usize>) -> bool {
    let within = |node: usize, nodes: &[usize]| {
        let at = nodes.partition_point(|&m| m + REACH < node);
        nodes.get(at).is_some_and(|&m| m <= node + REACH)
    };
    within(node, nodes)
        || cycle.is_some_and(|n| {
            // Over the seam.
            nodes.first().is_some_and(|&m| m + n <= node + REACH)
                || nodes.last().is_some_and(|&m| node + n <= m + REACH)
        })
}
