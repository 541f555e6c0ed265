//! Slopes and second derivatives together: the least energy over all C² monotone quintics on the data's knots, or over
//! those with some slopes prescribed.
//!
//! **Problem.** Unknowns are the nodal pairs (dᵢ, sᵢ). The energy is a strictly convex quadratic; monotonicity asks
//! that the derivative's quartic pᵢ ≥ 0 on every segment. That is a convex cone with an exact description by two small
//! positive semidefinite matrices ([`cone`]): no sufficient conditions, no subdivision, no cuts.
//!
//! **Method.** A primal–dual interior-point iteration on these matrices and their multipliers, the moments, with
//! Mehrotra's predictor and corrector (*SIAM J. Optim.* 2 (1992) 575–601; Wright, *Primal–Dual Interior-Point Methods*,
//! 1997), until it is known where the derivatives touch 0; then Newton's method on these contacts ([`polish`]), which
//! ends at the optimum up to rounding. A segment's matrices and moments are eliminated within the segment; what is left
//! is one block-tridiagonal system with 2×2 blocks, whose factors are used twice ([`step`]). O(N) a step.
//!
//! It starts in the centre of every cone, with the same mass on each, in a unit of the segment's own: the largest
//! energy weight near it. So segments of little energy advance as fast as those of much. That point is not feasible,
//! but its residual shrinks with every step: the matrices belong to the primal point up to that share. Starting
//! feasible costs about a step more, as the points known to be feasible beforehand lie next to the boundary.
//!
//! **Bound.** Any moments y of non-negative functionals bound the energy of every C² monotone quintic from below (weak
//! duality, the quadratic minimised exactly): `E(b) − E* ≤ Σ yᵢ·pᵢ(b) + ½‖b − v(y)‖²`, the norm the energy's. All of
//! it is computed from y and a point b whose monotonicity is tested exactly, so neither rounding nor an early end of
//! the iteration can spoil it. It is a sum over the segments, and every share is held against the segment's own unit:
//! where the total is met, a segment of little energy may still be far from its optimum.
//!
//! **Guarantee.** The result is monotone whatever the number of steps: it is tested, and where rounding (or a residual
//! that is left) has made it infeasible it is moved towards a strictly feasible point until it is not. If the
//! unconstrained optimum (the natural cubic spline) is monotone, it is the answer, in one step.
//!
//! MEASURED

mod cone;
mod contacts;
mod matrices;
mod nodes;
#[cfg(any(test, feature = "nlopt"))]
pub(crate) mod parts;
mod polish;
mod step;

use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use crate::quartic_form::{certified_between, certified_nonnegative, derivative, least};
use crate::slopes::sign;
use contacts::{Contact, places};
pub(crate) use nodes::{Fixed, fixed_by_data};
use nodes::{NodeSystem, largest, natural};
use std::cell::RefCell;
use std::ops::Range;
use step::Problem;

/// Steps after which the current (monotone) iterate is returned as it is.
const MAX_STEPS: usize = 40;
/// Barrier parameter (in the segments' units) from which on the contacts are tried: by then they are known in nine
/// fits of ten.
const READY: f64 = 3e-2;
/// Gap (the total relative to E, and a segment's in its unit) at which the search ends.
const EXACT: f64 = 1e-7;
/// The same at which it ends where Newton's method on the contacts has: what is left is the way back to feasible
/// points where contacts meet.
const SOLVED: f64 = 1e-4;
/// The same from which the result counts as found.
const PROMISE: f64 = 5e-3;
/// Step lengths (dual and primal together) from which on the iteration does not move any more.
const STUCK: f64 = 1e-3;
/// The multipliers' mass on every segment at the start, in the segment's unit.
const MASS: f64 = 2.5;

/// Slopes, second derivatives and how they were found; scaled units.
#[derive(Debug, Clone, Default)]
pub(crate) struct Optimum {
    pub(crate) d: Vec<f64>,
    pub(crate) s: Vec<f64>,
    /// Newton steps (block-tridiagonal eliminations).
    pub(crate) steps: usize,
    /// Segments whose derivative is held at 0 somewhere.
    pub(crate) active: usize,
    /// Bound of the energy's distance from the exact optimum: of the whole relative to the energy, or of a segment in
    /// the largest energy weight near it, whichever is larger.
    pub(crate) gap: f64,
    pub(crate) converged: bool,
    /// Whether every segment is monotone by the derivative's Bernstein coefficients.
    pub(crate) certified: bool,
}

thread_local! {
    static PROBLEM: RefCell<Problem> = RefCell::default();
}

/// Nodal values that are prescribed, NaN where free, and a monotone point that has them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prescribed<'a> {
    pub(crate) fixed: &'a [Fixed],
    pub(crate) inside: &'a [[f64; 2]],
}

impl Prescribed<'_> {
    /// Those of some segments.
    pub(crate) fn part(self, segments: &Range<usize>) -> Self {
        let nodes = segments.start..=segments.end;
        Self { fixed: &self.fixed[nodes.clone()], inside: &self.inside[nodes] }
    }
}

/// Minimise; without prescribed values, over all that the data leave free.
pub(crate) fn optimise(
    data: &Data,
    fairness: Fairness,
    prescribed: Option<Prescribed<'_>>,
) -> Optimum {
    if data.len() == 1 && prescribed.is_none() {
        // Two points: the line, to the last bit.
        let d = vec![data.delta[0]; 2];
        return Optimum { d, s: vec![0.0; 2], steps: 1, converged: true, ..Optimum::default() };
    }
    PROBLEM.with_borrow_mut(|problem| run(problem, data, fairness, prescribed))
}

/// A strictly monotone point: d = min(Δᵢ₋₁, Δᵢ), s = 0, where the middle coefficient is at least Δ; at a turn a
/// bend the way the data turn.
fn interior(data: &Data, i: usize) -> [f64; 2] {
    let (h, delta) = (&data.h, &data.delta);
    let (l, r) = (i.max(1) - 1, i.min(delta.len() - 1));
    match fixed_by_data(delta, i).map(f64::is_nan) {
        [true, _] => [sign(delta[l]) * delta[l].abs().min(delta[r].abs()), 0.0],
        [false, true] => {
            let bend = (delta[l].abs() / h[l]).min(delta[r].abs() / h[r]);
            [0.0, -0.5 * sign(delta[l]) * bend]
        }
        [false, false] => [0.0, 0.0],
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

/// The unconstrained optimum, if it is monotone on the first `count` segments. In memory of its own: that of long
/// data is not kept.
pub(crate) fn unconstrained(
    data: &Data,
    fairness: Fairness,
    prescribed: Option<Prescribed<'_>>,
    count: usize,
) -> Option<Optimum> {
    let mut system = NodeSystem::with_capacity(data.len() + 1);
    let fixed = |i| prescribed.map_or_else(|| fixed_by_data(&data.delta, i), |p| p.fixed[i]);
    let v = natural(&mut system, data, fairness, largest(data, fairness), fixed);
    is_monotone(v, data, fixed, count).then(|| result(v, data))
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

/// Whether the first `count` segments are monotone.
fn is_monotone(v: &[[f64; 2]], data: &Data, fixed: impl Fn(usize) -> Fixed, count: usize) -> bool {
    (0..count).all(|i| {
        let (h, delta) = (data.h[i], data.delta[i]);
        if is_flat(delta) {
            return true;
        }
        let c = coefficients(h, delta, v[i], v[i + 1]);
        // Where the slope is fixed at 0 the derivative must leave it in the right direction.
        let leaves = |node: usize, inner: f64| fixed(node)[0] != 0.0 || inner >= 0.0;
        leaves(i, c[1]) && leaves(i + 1, c[3]) && least(&c) >= 0.0
    })
}

fn run(
    problem: &mut Problem,
    data: &Data,
    fairness: Fairness,
    prescribed: Option<Prescribed<'_>>,
) -> Optimum {
    problem.pose(data, fairness, prescribed);
    problem.minimise_unconstrained(data, fairness);
    if is_monotone(&problem.v, data, |i| problem.fixed[i], data.len()) {
        return result(&problem.v, data);
    }
    problem.start(MASS);
    let mut found = Optimum { gap: f64::INFINITY, ..result(&problem.inside, data) };
    let (mut steps, mut polished) = (1, false);
    loop {
        steps += 1;
        let length = problem.step();
        let last = steps == MAX_STEPS || !(length[0] + length[1] > STUCK);
        if last || problem.mean() <= READY {
            problem.kept.clone_from(&problem.w);
            for further in [false, true] {
                if !(found.gap <= EXACT) && problem.polish(further) {
                    problem.measure();
                    polished = keep_better(&mut found, problem, data, true);
                } else {
                    break;
                }
            }
            if !(found.gap <= SOLVED) {
                problem.w.clone_from(&problem.kept);
                polished &= !keep_better(&mut found, problem, data, false);
            }
        }
        if last || found.gap <= if polished { SOLVED } else { EXACT } {
            break;
        }
    }
    (found.steps, found.converged) = (steps, found.gap <= PROMISE);
    found
}

/// Take the current point, made feasible, if it is proved to be closer to the optimum than `found`. With the moments
/// of the contacts if `polished`, else of the iteration. Whether it was taken.
fn keep_better(found: &mut Optimum, problem: &mut Problem, data: &Data, polished: bool) -> bool {
    if !problem.feasible(data, polished) {
        return false;
    }
    let (energy, distance, worst) = problem.certificate(polished);
    let gap = worst.max(distance / energy);
    if !(gap < found.gap) {
        return false;
    }
    let active = if polished { problem.held() } else { problem.active() };
    *found = Optimum { gap, active, certified: true, ..result(&problem.best, data) };
    true
}

/// `report` the segments on which the derivative is not shown to be non-negative by its coefficients, which are cut
/// first where the contacts are.
fn uncertified(data: &Data, v: &[[f64; 2]], contacts: &[Contact], mut report: impl FnMut(usize)) {
    let mut rest = contacts;
    for i in 0..data.len() {
        let (h, delta) = (data.h[i], data.delta[i]);
        let (own, others) = rest.split_at(rest.iter().take_while(|c| c.segment <= i).count());
        rest = others;
        if is_flat(delta) {
            continue;
        }
        let c = coefficients(h, delta, v[i], v[i + 1]);
        let certified = c.iter().all(|c| *c >= 0.0)
            || (!own.is_empty() && certified_between(c, places(own)))
            || certified_nonnegative(&c, 0.0);
        if !certified {
            report(i);
        }
    }
}

#[cfg(test)]
mod tests;
