// SPDX-License-Identifier: MIT OR Apache-2.0

//! The paper's program on long data: stretches that fit into the cache, solved independently and joined.
//!
//! At the optimum every sᵢ is what its neighbours make of it, clamped to its bounds: `clamp(−(qᵢ + oᵢ₋₁sᵢ₋₁ +
//! oᵢsᵢ₊₁)/aᵢ)`. The diagonal is six times the sum of the two off-diagonal entries whatever the spacings, and clamping
//! moves nothing apart, so a change at one node is at most a sixth as large at the next. Stretches that overlap by
//! [`OVERLAP`] nodes therefore agree in their middles to the last bits. Where they join that is checked row by row, and
//! if it should not be so (numbers over forty decades) the program is solved in one.

use crate::MonotoneError;
use crate::data::Data;
use crate::energy::Fairness;
use crate::interrupt::{GoOn, check_interrupt};
use crate::program::Program;
use shapespline_banded::box_qp::BoxQpSolution;
use shapespline_polynomial::parallel;
use std::ops::Range;

/// Nodes that a stretch answers for: with its arrays it fits into a core's cache.
const CORE: usize = 2048;
/// Nodes that a stretch looks beyond on either side: 6⁻⁴⁸ is 4e-38.
const OVERLAP: usize = 48;
/// Stretches from which threads share them.
const SHARED: usize = 16;
/// What neighbours may differ by where they join, relative to the terms of the row: less than the optimality that is
/// promised by far.
const AGREE: f64 = 1e-13;

/// Solve the program for given slopes, asking once a stretch whether to go on. O(N), in parallel.
pub(crate) fn solve(
    data: &Data,
    d: &[f64],
    fairness: Fairness,
    go_on: GoOn<'_>,
) -> Result<BoxQpSolution, MonotoneError> {
    solve_by(data, d, fairness, go_on, [CORE, OVERLAP])
}

/// A stretch's answer.
struct Stretch {
    nodes: Range<usize>,
    solution: BoxQpSolution,
    /// The nodes before and after those it answers for, as it sees them.
    beyond: [f64; 2],
    /// What the first and the last of its rows may be off by.
    room: [f64; 2],
}

fn solve_by(
    data: &Data,
    d: &[f64],
    fairness: Fairness,
    go_on: GoOn<'_>,
    [core, overlap]: [usize; 2],
) -> Result<BoxQpSolution, MonotoneError> {
    let nodes = d.len();
    let count = nodes / core;
    if count < 2 {
        return Program::new(data, d, fairness)?.solve();
    }
    let cut = |k: usize| nodes * k / count;
    let stretch = |program: &mut Program, k: usize| -> Result<Stretch, MonotoneError> {
        check_interrupt(go_on)?;
        let nodes = cut(k)..cut(k + 1);
        let from = nodes.start.saturating_sub(overlap);
        let to = (nodes.end + overlap).min(d.len());
        program.fill(data, d, fairness, from..to - 1)?;
        let mut solution = program.solve()?;
        let (first, last) = (nodes.start - from, nodes.end - 1 - from);
        let x = &solution.x;
        let beyond = [x[first.max(1) - 1], x[(last + 1).min(x.len() - 1)]];
        let room = [(first, first.max(1) - 1), (last, last.min(x.len() - 2))].map(|(row, off)| {
            let own = (program.diagonal[row] * x[row]).abs() + program.linear[row].abs();
            AGREE * own / program.off_diagonal[off]
        });
        solution.active = (first..=last)
            .filter(|&i| x[i] == program.lower[i] || x[i] == program.upper[i])
            .count();
        solution.x.truncate(last + 1);
        solution.x.drain(..first);
        Ok(Stretch { nodes, solution, beyond, room })
    };
    let stretches: Vec<Result<Stretch, MonotoneError>> =
        parallel::map_with(count, SHARED, Program::default, stretch);
    let stretches = stretches.into_iter().collect::<Result<Vec<_>, _>>()?;
    let joined = stretches.windows(2).all(|w| {
        let (a, b) = (&w[0], &w[1]);
        let (before, after) = (a.solution.x[a.nodes.len() - 1], b.solution.x[0]);
        (a.beyond[1] - after).abs() <= a.room[1] && (b.beyond[0] - before).abs() <= b.room[0]
    });
    if !joined {
        return Program::new(data, d, fairness)?.solve();
    }
    let mut all = BoxQpSolution {
        x: Vec::with_capacity(nodes),
        iterations: 0,
        active: 0,
        safeguards: 0,
        kkt_residual: AGREE,
        solved: true,
    };
    for Stretch { solution, .. } in stretches {
        all.x.extend_from_slice(&solution.x);
        all.iterations = all.iterations.max(solution.iterations);
        all.active += solution.active;
        all.safeguards += solution.safeguards;
        all.kkt_residual = all.kkt_residual.max(solution.kkt_residual);
        all.solved &= solution.solved;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::program::admissible_slopes;
    use crate::slopes;
    use shapespline_banded::box_qp::kkt_residual;
    use std::ops::ControlFlow;

    const GO_ON: GoOn<'static> = &|| ControlFlow::Continue(());

    /// Stretches against one program over all data, with turns, flats and steps over decades.
    #[test]
    fn stretches_agree_with_one_program() {
        let mut state = 3u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for case in 0..12 {
            let decades = f64::from(case % 4) * 4.0;
            let (mut x, mut y) = (vec![0.0], vec![0.0]);
            for k in 0..1500 {
                x.push(x[k] + 0.1 + next());
                let turn = if case % 3 == 2 && next() < 0.3 { -1.0 } else { 1.0 };
                let rise = next() * 10f64.powf(decades * (next() - 0.5));
                y.push(if case % 3 == 1 && next() < 0.02 { y[k] } else { y[k] + turn * rise });
            }
            let data = Data::new(&x, &y).unwrap();
            let mut d = slopes::fritsch_butland(&data);
            admissible_slopes(&data, &mut d);
            for fairness in [Fairness::Bending, Fairness::Parametric] {
                let program = Program::new(&data, &d, fairness).unwrap();
                let whole = program.solve().unwrap();
                let parts = solve_by(&data, &d, fairness, GO_ON, [100, OVERLAP]).unwrap();
                assert!(parts.solved && parts.x.len() == d.len());
                assert!(kkt_residual(&program.view(), &parts.x) <= parts.kkt_residual.max(2e-13));
                let mut active = 0;
                for i in 0..d.len() {
                    let near = (i.max(3) - 3..d.len().min(i + 4)).map(|k| whole.x[k].abs());
                    let size = near.fold(0.0, f64::max);
                    assert!(
                        (parts.x[i] - whole.x[i]).abs() <= 1e-13 * size,
                        "case {case} node {i}"
                    );
                    active += usize::from(
                        parts.x[i] == program.lower[i] || parts.x[i] == program.upper[i],
                    );
                }
                assert_eq!(parts.active, active);
            }
        }
    }

    /// An overlap too short to agree is noticed, and the whole program solved.
    #[test]
    fn stretches_that_do_not_agree_are_not_joined() {
        let x: Vec<f64> = (0..300).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| (0.05 * x).exp()).collect();
        let data = Data::new(&x, &y).unwrap();
        let d = slopes::fritsch_butland(&data);
        let whole = Program::new(&data, &d, Fairness::Bending).unwrap().solve().unwrap();
        let parts = solve_by(&data, &d, Fairness::Bending, GO_ON, [50, 1]).unwrap();
        assert_eq!(parts, whole);
    }
}
