//! Lowering tension again: growth overshoots, and what is not needed is given back.
//!
//! Every connected run of tension is scaled by a factor of its own, found by bisection
//! ([`crate::lower`]). One run after the other: a change dies away as `2^{−k}` over `k` nodes, so each
//! step solves and checks a neighbourhood only. The run with the most tension goes first, and ties
//! within reach of each other go together with one factor: the order comes from the data, not from the
//! direction in which they are numbered, so reversed data give the reversed curve.

use crate::{
    Phase, TensionFamily,
    lower::Nodes,
    runs::{Run, runs},
    state::State,
};

/// Nodes over which a change of tension falls below rounding.
const REACH: usize = 64;

/// Limit of sweeps over the runs that can still be lowered. Two or three are usual; two runs that free
/// each other bit by bit have taken 32.
const SWEEPS: usize = 256;

/// Lowers the tension of a curve without faults as far as that leaves it without faults.
pub(crate) fn relax<F: TensionFamily>(state: &mut State<'_, F>) -> Result<(), F::Error> {
    let mut all = runs(state.family.tension(), state.closed());
    // Those that may be lowered: a run that was, is open again once another within reach has changed.
    let mut open = vec![true; all.len()];
    for sweep in 0..SWEEPS {
        if sweep > 0 {
            for (open, run) in open.iter_mut().zip(&all) {
                *open = *open && !state.stopped && Nodes::of(state, [run]).can_be_lowered(state)?;
            }
        }
        let changed = sweep_over(state, &all, &mut open)?;
        state.log(Phase::Relax, 0, changed);
        if changed == 0 || state.stopped {
            break;
        }
        let tension = state.family.tension();
        for run in &mut all {
            run.total = run.nodes(tension.len()).map(|i| tension[i]).sum();
        }
        open = all.iter().zip(open).filter(|(run, _)| run.total > 0.0).map(|(_, o)| o).collect();
        all.retain(|run| run.total > 0.0);
    }
    Ok(())
}

/// Lowers the open runs, the heaviest first, and says which are open then. Returns the number of nodes
/// that changed.
fn sweep_over<F: TensionFamily>(
    state: &mut State<'_, F>,
    all: &[Run],
    open: &mut [bool],
) -> Result<usize, F::Error> {
    let mut heaviest_first: Vec<usize> = (0..all.len()).filter(|&r| open[r]).collect();
    heaviest_first.sort_by(|&a, &b| all[b].total.total_cmp(&all[a].total));
    let mut again = vec![false; all.len()];
    let mut changed = 0;
    for r in heaviest_first {
        if !open[r] {
            continue;
        }
        let group = tied(state, all, open, r);
        let mut nodes = Nodes::of(state, group.iter().map(|&g| &all[g]));
        let mut lowered = nodes.lower(state, group.len() == all.len())?;
        if lowered == 0 && group.len() > 1 {
            // One of them may be all that holds back the others; or each the others by a little.
            let mut free = Vec::new();
            for &g in &group {
                if Nodes::of(state, [&all[g]]).can_be_lowered(state)? {
                    free.push(&all[g]);
                }
            }
            if !free.is_empty() {
                lowered = Nodes::of(state, free).finely().lower(state, false)?;
            }
        }
        // Of several with one factor, one may have held back the others.
        group.iter().for_each(|&g| again[g] = group.len() > 1);
        if lowered > 0 {
            let beside = group.iter().flat_map(|&g| neighbours(state, all, g));
            beside.filter(|o| !group.contains(o)).for_each(|o| again[o] = true);
        }
        changed += lowered;
        if state.wants_to_stop(Phase::Relax, changed) {
            break;
        }
    }
    open.copy_from_slice(&again);
    Ok(changed)
}

/// Run `r` and the open runs that tie with it within reach, or within reach of those; they are open no
/// longer.
fn tied<F: TensionFamily>(
    state: &State<'_, F>,
    all: &[Run],
    open: &mut [bool],
    r: usize,
) -> Vec<usize> {
    open[r] = false;
    let mut group = vec![r];
    let mut next = 0;
    while next < group.len() {
        let joining: Vec<usize> = neighbours(state, all, group[next])
            .filter(|&o| open[o] && all[r].ties(&all[o]))
            .collect();
        for o in joining {
            if open[o] {
                open[o] = false;
                group.push(o);
            }
        }
        next += 1;
    }
    group
}

/// Nodes between two runs, the shorter way round in closed data.
fn gap<F: TensionFamily>(state: &State<'_, F>, a: &Run, b: &Run) -> usize {
    let n = state.family.tension().len();
    let forward = |from: &Run, to: &Run| (to.first + 2 * n - from.first - from.length + 1) % n;
    if state.closed() {
        forward(a, b).min(forward(b, a))
    } else if a.first < b.first {
        b.first - (a.first + a.length - 1)
    } else {
        a.first - (b.first + b.length - 1)
    }
}

/// The other runs within reach of run `r`.
fn neighbours<'a, F: TensionFamily>(
    state: &'a State<'_, F>,
    all: &'a [Run],
    r: usize,
) -> impl Iterator<Item = usize> + 'a {
    let count = all.len();
    let closed = state.closed();
    let step = move |k: usize, forward: bool| -> Option<usize> {
        match (forward, closed) {
            (true, false) => Some(r + k).filter(|&o| o < count),
            (false, false) => r.checked_sub(k),
            (true, true) => Some((r + k) % count),
            (false, true) => Some((r + count - k) % count),
        }
    };
    [true, false].into_iter().flat_map(move |forward| {
        (1..count)
            .map_while(move |k| step(k, forward))
            .take_while(move |&o| gap(state, &all[r], &all[o]) <= REACH)
    })
}
