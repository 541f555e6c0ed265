//! Lowering tension again: growth overshoots, and what is not needed is given back.
//!
//! Every connected run of tension is scaled by a factor of its own, found by bisection with a solve
//! and an exact check at each step; a factor that breaks a criterion anywhere is not taken. Runs that
//! cannot feel each other (a change dies away as `2^{−k}` over `k` nodes) are bisected together in
//! one solve. Of runs that can, the one with the most tension goes first, and ties go together with
//! one factor: the order comes from the data, not from the direction in which they are numbered, so
//! reversed data give the reversed curve.

use crate::{
    Phase, TensionFamily,
    runs::{Run, runs},
    search::State,
};

/// Nodes over which a change of tension falls below rounding.
const REACH: usize = 64;

/// No run can be lowered by more than this part of it when relaxation ends.
const RESOLUTION: f64 = 0.01;

/// Limit of sweeps over the runs that can still be lowered. Two or three are usual; two runs that free
/// each other bit by bit have taken 32.
const SWEEPS: usize = 256;

/// Lowers the tension of a curve without faults as far as that leaves it without faults.
pub(crate) fn relax<F: TensionFamily>(state: &mut State<'_, '_, F>) -> Result<(), F::Error> {
    for sweep in 0..SWEEPS {
        let all = runs(state.family.tension(), state.closed());
        let open = match sweep {
            0 => (0..all.len()).collect(),
            _ => lowerable(state, &all)?,
        };
        let mut changed = 0;
        for batch in batches(state, &all, open) {
            changed += lower(state, &all, &batch)?;
            state.relaxations += 1;
            if state.wants_to_stop(Phase::Relax, changed) {
                break;
            }
        }
        state.log(Phase::Relax, 0, changed);
        if changed == 0 || state.stopped {
            break;
        }
    }
    Ok(())
}

/// Nodes between two runs, the shorter way round in closed data.
fn gap<F: TensionFamily>(state: &State<'_, '_, F>, a: &Run, b: &Run) -> usize {
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

/// The open runs in the order in which they are lowered: a run comes in the first batch in which every
/// run within reach that outweighs it has had its turn.
///
/// The cost follows the number of runs, however long a chain of ever smaller runs may be.
fn batches<F: TensionFamily>(
    state: &State<'_, '_, F>,
    all: &[Run],
    open: Vec<usize>,
) -> Vec<Vec<Vec<usize>>> {
    const CLOSED: usize = usize::MAX;
    const WAITING: usize = usize::MAX - 1;
    let mut turn = vec![CLOSED; all.len()];
    open.iter().for_each(|&r| turn[r] = WAITING);
    let mut heaviest_first = open;
    heaviest_first.sort_by(|&a, &b| all[b].total.total_cmp(&all[a].total));
    let mut batches: Vec<Vec<usize>> = Vec::new();
    for &r in &heaviest_first {
        let after = neighbours(state, all, r)
            .filter(|&o| turn[o] < WAITING && all[o].outweighs(&all[r]))
            .map(|o| turn[o] + 1);
        turn[r] = after.max().unwrap_or(0);
        if turn[r] == batches.len() {
            batches.push(Vec::new());
        }
        batches[turn[r]].push(r);
    }
    let ordered = |mut batch: Vec<usize>| {
        batch.sort_unstable();
        groups(state, all, batch)
    };
    batches.into_iter().map(ordered).collect()
}

/// The runs of a batch (ascending) in groups: within reach of each other are only ties, and ties are
/// one group.
fn groups<F: TensionFamily>(
    state: &State<'_, '_, F>,
    all: &[Run],
    batch: Vec<usize>,
) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for r in batch {
        match groups.last_mut() {
            Some(group) if gap(state, &all[group[group.len() - 1]], &all[r]) <= REACH => {
                group.push(r);
            }
            _ => groups.push(vec![r]),
        }
    }
    // In closed data the last group may reach the first.
    if groups.len() > 1 && state.closed() {
        let (last, first) = (&groups[groups.len() - 1], groups[0][0]);
        if gap(state, &all[last[last.len() - 1]], &all[first]) <= REACH {
            let head = groups.remove(0);
            if let Some(tail) = groups.last_mut() {
                tail.extend(head);
            }
        }
    }
    groups
}

/// The other runs within reach of run `r`.
fn neighbours<'a, F: TensionFamily>(
    state: &'a State<'_, '_, F>,
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

/// A group of runs under bisection for a common factor.
struct Bisection {
    /// Nodes of the group with the tension they had.
    nodes: Vec<(usize, f64)>,
    /// Factor known to break a criterion (or none yet), and factor known to keep them all.
    breaks: f64,
    keeps: f64,
    trial: f64,
}

impl Bisection {
    fn done(&self) -> bool {
        self.keeps == 0.0 || self.keeps - self.breaks <= RESOLUTION * self.keeps
    }
}

/// Lowers each group of a batch by bisection, all groups in one solve a step. Returns the number of
/// nodes that changed.
fn lower<F: TensionFamily>(
    state: &mut State<'_, '_, F>,
    all: &[Run],
    batch: &[Vec<usize>],
) -> Result<usize, F::Error> {
    let mut groups = bisections(state, all, batch);
    // No tension at all comes first: growth often raises more nodes than it had to.
    groups.iter_mut().for_each(|g| g.trial = 0.0);
    for _ in 0..64 {
        try_all(state, &groups, |g| if g.done() { g.keeps } else { g.trial })?;
        let failed = failures(state, &groups);
        for (group, failed) in groups.iter_mut().zip(failed) {
            if group.done() {
                continue;
            }
            if failed {
                group.breaks = group.trial
            } else {
                group.keeps = group.trial
            }
            group.trial = 0.5 * (group.breaks + group.keeps);
        }
        if groups.iter().all(Bisection::done) || state.stopped {
            break;
        }
    }
    try_all(state, &groups, |g| g.keeps)?;
    Ok(groups.iter().filter(|g| g.keeps < 1.0).map(|g| g.nodes.len()).sum())
}

/// The runs that could be lowered by the resolution, each for itself and all others left as they are.
fn lowerable<F: TensionFamily>(
    state: &mut State<'_, '_, F>,
    all: &[Run],
) -> Result<Vec<usize>, F::Error> {
    let mut found = Vec::new();
    let mut waiting: Vec<usize> = (0..all.len()).collect();
    while !waiting.is_empty() {
        // Runs out of each other's reach share a solve; the tests are independent, so the order in
        // which they are picked does not matter.
        let mut batch: Vec<Vec<usize>> = Vec::new();
        waiting.retain(|&r| {
            let clear = |o: &Vec<usize>| gap(state, &all[o[0]], &all[r]) > REACH;
            let fits = batch.last().is_none_or(clear) && batch.first().is_none_or(clear);
            if fits {
                batch.push(vec![r]);
            }
            !fits
        });
        let groups = bisections(state, all, &batch);
        try_all(state, &groups, |_| 1.0 - RESOLUTION)?;
        let failed = failures(state, &groups);
        found.extend(batch.iter().zip(failed).filter(|(_, failed)| !failed).map(|(g, _)| g[0]));
        try_all(state, &groups, |_| 1.0)?;
    }
    Ok(found)
}

fn bisections<F: TensionFamily>(
    state: &State<'_, '_, F>,
    all: &[Run],
    batch: &[Vec<usize>],
) -> Vec<Bisection> {
    let tension = state.family.tension();
    let n = tension.len();
    let nodes = |group: &Vec<usize>| {
        group.iter().flat_map(|&r| all[r].nodes(n)).map(|i| (i, tension[i])).collect()
    };
    let new = |group| Bisection { nodes: nodes(group), breaks: -1.0, keeps: 1.0, trial: 1.0 };
    batch.iter().map(new).collect()
}

fn try_all<F: TensionFamily>(
    state: &mut State<'_, '_, F>,
    groups: &[Bisection],
    factor: impl Fn(&Bisection) -> f64,
) -> Result<(), F::Error> {
    let present = state.family.tension();
    let mut changes: Vec<(usize, f64)> = groups
        .iter()
        .flat_map(|g| {
            let factor = factor(g);
            g.nodes.iter().map(move |&(i, tension)| (i, tension * factor))
        })
        .filter(|&(i, tension)| present[i] != tension)
        .collect();
    changes.sort_unstable_by_key(|c| c.0);
    state.set_tension(&changes)
}

/// Which groups broke something: a fault belongs to the group nearest to it.
fn failures<F: TensionFamily>(state: &State<'_, '_, F>, groups: &[Bisection]) -> Vec<bool> {
    let mut failed = vec![false; groups.len()];
    let mut nodes: Vec<(usize, usize)> = groups
        .iter()
        .enumerate()
        .flat_map(|(k, g)| g.nodes.iter().map(move |&(i, _)| (i, k)))
        .collect();
    nodes.sort_unstable();
    let n = state.family.tension().len();
    for &(segment, _) in state.faults() {
        let after = nodes.partition_point(|&(i, _)| i <= segment);
        let distance = |i: usize| {
            let d = i.abs_diff(segment);
            if state.closed() { d.min(n - d) } else { d }
        };
        let beside = [after.checked_sub(1), Some(after), Some(0), nodes.len().checked_sub(1)];
        let nearest = beside
            .into_iter()
            .flatten()
            .filter_map(|k| nodes.get(k))
            .min_by_key(|&&(i, _)| distance(i));
        if let Some(&(_, group)) = nearest {
            failed[group] = true;
        }
    }
    failed
}
