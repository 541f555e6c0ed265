//! Slopes and second derivatives together: the least energy over all C² monotone quintics on the data's knots.
//!
//! **Problem.** Unknowns are the nodal pairs (dᵢ, sᵢ). The energy is a strictly convex quadratic; monotonicity asks
//! that the derivative's quartic pᵢ ≥ 0 on every segment. The paper's five sufficient conditions (21) ask it of the
//! Bernstein coefficients on the whole segment; asked on the parts between its touching points they are exact.
//!
//! **Method.** A primal–dual interior-point iteration with Mehrotra's predictor and corrector (*SIAM J. Optim.* 2
//! (1992) 575–601; Wright, *Primal–Dual Interior-Point Methods*, 1997) that starts strictly inside and stays there.
//! It begins with the conditions on whole segments; as minima of p appear, segments are cut there and the cuts follow
//! ([`parts`]). One step eliminates one block-tridiagonal system with 2×2 blocks and uses its factors twice: O(N).
//! One barrier parameter serves all conditions: with one a segment, in proportion to its energy, steep segments beside
//! gentle ones need many times the steps (on steps over twelve decades more than 200, mostly without an end).
//!
//! **Guarantee.** Every iterate satisfies the conditions strictly, so the result is monotone whatever the number of
//! steps. If the unconstrained optimum (the natural cubic spline) is monotone, it is the answer, in one step. The
//! iteration ends when a lower bound for the exact problem ([`certificate`]) is within [`ENOUGH`] of the energy.
//!
//! Measured (example `optimal`, 300 sets a kind): on 20 points 8 steps for uniform data on a grid, 14 for exponential
//! or lognormal steps in both directions, 12 over twelve decades; on 64 points 11–17. All within [`ENOUGH`] but some
//! of those over ten and more decades (a few in a hundred, bounds up to 2 %). Against the conditions on sixty-four parts of
//! every segment (Clarabel): at most 0.2 % above.

mod cone;
#[cfg(test)]
pub(crate) mod parts;
mod step;

use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use crate::quartic_form::{certified_nonnegative, derivative, least};
use crate::slopes::sign;
use std::cell::RefCell;
use step::Problem;

/// Steps after which the current (monotone) iterate is returned as it is.
const MAX_STEPS: usize = 40;
/// Bound of E − E* relative to E at which the iteration ends.
const ENOUGH: f64 = 3.5e-3;
/// The same from which the result counts as found.
const PROMISE: f64 = 5e-3;
/// Step lengths (dual and primal together) from which on the iteration does not move any more.
const STUCK: f64 = 1e-3;
/// The multipliers' mass on every segment at the start, in units of the largest energy weight.
const MASS: f64 = 0.7;

/// Slopes, second derivatives and how they were found; scaled units.
#[derive(Debug, Clone, Default)]
pub(crate) struct Optimum {
    pub(crate) d: Vec<f64>,
    pub(crate) s: Vec<f64>,
    /// Newton steps (block-tridiagonal eliminations).
    pub(crate) steps: usize,
    /// Segments whose derivative is held at 0 somewhere.
    pub(crate) active: usize,
    /// Bound of the energy's distance from the exact optimum, relative to the energy.
    pub(crate) gap: f64,
    pub(crate) converged: bool,
}

thread_local! {
    static PROBLEM: RefCell<Problem> = RefCell::default();
}

/// Minimise.
pub(crate) fn optimise(data: &Data, fairness: Fairness) -> Optimum {
    if data.len() == 1 {
        // Two points: the line, to the last bit.
        let d = vec![data.delta[0]; 2];
        return Optimum { d, s: vec![0.0; 2], steps: 1, converged: true, ..Optimum::default() };
    }
    PROBLEM.with_borrow_mut(|problem| run(problem, data, fairness))
}

/// What is free at a node: (slope, second derivative). At a flat neither, at a turn only the second.
#[inline]
fn free(delta: &[f64], i: usize) -> (bool, bool) {
    let (l, r) = (delta[i.max(1) - 1], delta[i.min(delta.len() - 1)]);
    if is_flat(l) || is_flat(r) { (false, false) } else { (sign(l) == sign(r), true) }
}

/// A strictly monotone point: d = min(Δᵢ₋₁, Δᵢ), s = 0, where the middle coefficient is at least Δ; at a turn a
/// bend the way the data turn.
fn interior(data: &Data, i: usize) -> [f64; 2] {
    let (h, delta) = (&data.h, &data.delta);
    let (l, r) = (i.max(1) - 1, i.min(delta.len() - 1));
    match free(delta, i) {
        (true, _) => [sign(delta[l]) * delta[l].abs().min(delta[r].abs()), 0.0],
        (false, true) => {
            let bend = (delta[l].abs() / h[l]).min(delta[r].abs() / h[r]);
            [0.0, -0.5 * sign(delta[l]) * bend]
        }
        (false, false) => [0.0, 0.0],
    }
}

/// The derivative's Bernstein coefficients over Δ at nodal values.
#[inline]
pub(crate) fn coefficients(h: f64, delta: f64, v0: [f64; 2], v1: [f64; 2]) -> [f64; 5] {
    let curvature = h / (4.0 * delta);
    derivative(
        (v0[0] - delta) / delta,
        v0[1] * curvature,
        (v1[0] - delta) / delta,
        v1[1] * curvature,
    )
}

/// The unconstrained optimum, if it is monotone.
pub(crate) fn unconstrained(data: &Data, fairness: Fairness) -> Option<Optimum> {
    // Of its own: the memory of long data is not kept.
    let mut problem = Problem::default();
    problem.pose(data, fairness);
    problem.unconstrained();
    is_monotone(&problem.v, data).then(|| result(&problem.v, data))
}

fn result(v: &[[f64; 2]], data: &Data) -> Optimum {
    let nodes = &v[..=data.len()];
    Optimum {
        d: nodes.iter().map(|v| v[0]).collect(),
        s: nodes.iter().map(|v| v[1]).collect(),
        steps: 1,
        converged: true,
        ..Optimum::default()
    }
}

fn is_monotone(v: &[[f64; 2]], data: &Data) -> bool {
    (0..data.len()).all(|i| {
        let (h, delta) = (data.h[i], data.delta[i]);
        if is_flat(delta) {
            return true;
        }
        let c = coefficients(h, delta, v[i], v[i + 1]);
        // Where the slope is fixed at 0 the derivative must leave it in the right direction.
        let leaves = |node: usize, inner: f64| free(&data.delta, node).0 || inner >= 0.0;
        leaves(i, c[1]) && leaves(i + 1, c[3]) && least(&c) >= 0.0
    })
}

fn run(problem: &mut Problem, data: &Data, fairness: Fairness) -> Optimum {
    problem.pose(data, fairness);
    problem.unconstrained();
    if is_monotone(&problem.v, data) {
        return result(&problem.v, data);
    }
    for i in 0..=data.len() {
        problem.inside[i] = interior(data, i);
    }
    problem.start(MASS);
    let mut found = Optimum { gap: f64::INFINITY, ..Optimum::default() };
    let (mut steps, mut energy) = (1, f64::INFINITY);
    while steps < MAX_STEPS {
        steps += 1;
        let length = problem.step();
        let stuck = !(length[0] + length[1] > STUCK);
        // Once feasible the primal energy hardly grows: the last one known tells whether this one is worth finding.
        let mut close = problem.gap <= ENOUGH * energy;
        if close {
            energy = problem.energy();
            close = problem.gap <= ENOUGH * energy;
        }
        if (close || stuck) && problem.feasible(data) {
            let (upper, distance) = problem.certificate();
            if distance < found.gap * upper {
                found = Optimum { gap: distance / upper, ..result(&problem.best, data) };
            }
        }
        if stuck || found.gap <= ENOUGH {
            break;
        }
    }
    if found.d.is_empty() {
        found = Optimum { gap: f64::INFINITY, ..result(&problem.inside, data) };
    }
    (found.steps, found.converged) = (steps, found.gap <= PROMISE);
    found
}

/// Whether the derivative is non-negative on every segment, by its coefficients.
fn certified(data: &Data, v: &[[f64; 2]]) -> bool {
    (0..data.len()).all(|i| {
        let (h, delta) = (data.h[i], data.delta[i]);
        is_flat(delta) || certified_nonnegative(&coefficients(h, delta, v[i], v[i + 1]), 0.0)
    })
}

#[cfg(test)]
mod tests;
