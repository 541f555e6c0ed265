// SPDX-License-Identifier: MIT OR Apache-2.0

//! Slopes and second derivatives together: the least energy over all C² monotone quintics on the data's knots, or over
//! those with some slopes prescribed.
//!
//! **Problem.** Unknowns are the nodal pairs (dᵢ, sᵢ). The energy is a strictly convex quadratic; monotonicity asks
//! that the derivative's quartic pᵢ ≥ 0 on every segment. That is a convex cone with an exact description by two small
//! positive semidefinite matrices ([`cone`]): no sufficient conditions, no subdivision, no cuts.
//!
//! **Method.** A primal–dual interior-point iteration on these matrices and their multipliers, the moments, with
//! Mehrotra's predictor and corrector (*SIAM J. Optim.* 2 (1992) 575–601; Wright, *Primal–Dual Interior-Point Methods*,
//! 1997). A segment's matrices and moments are eliminated within the segment; what is left is one block-tridiagonal
//! system with 2×2 blocks, whose factors are used twice ([`step`]). O(N) a step.
//!
//! It starts in the centre of every cone, with the same mass on each, in a unit of the segment's own: the largest
//! energy weight near it. So segments of little energy advance as fast as those of much. That point is not feasible,
//! but its residual shrinks with every step: the matrices belong to the primal point up to that share. Starting
//! feasible costs about a step more, as the points known to be feasible beforehand lie next to the boundary.
//!
//! **Bound.** Any moments y of non-negative functionals bound the energy of every C² monotone quintic from below (weak
//! duality, the quadratic minimised exactly): `E(b) − E* ≤ Σ yᵢ·pᵢ(b) + ½‖b − v(y)‖²`, the norm the energy's. All of
//! it is computed from y and a point b whose monotonicity is tested exactly, so neither rounding nor an early end of
//! the iteration can spoil it. It is a sum over the segments of terms that are not negative, and every one is held
//! against the segment's own energy: where the total is met, a segment of little energy may still be far from its
//! optimum.
//!
//! **Continuity.** An iterate is a continuous function of the data, its number is not. So the result is a convex
//! combination: an iterate's weight grows from 0 to 1 as its bounds get good enough, and the iteration ends when the
//! weights' sum is 1. The unconstrained optimum (the natural cubic spline), made feasible, is the first candidate: if
//! it is monotone, it is the answer.
//!
//! **Guarantee.** The result is monotone whatever the number of steps: every iterate that is used is tested, and where
//! rounding (or a residual that is left) has made it infeasible it is moved towards a strictly feasible point, just as
//! far as it has to be.
//!
//! Measured (example `optimal`, 300 sets a kind, the unconstrained solution counted as a step): on 20 points 4.5 steps
//! for uniform data on a grid, 8 for exponential steps in both directions, 18 over twelve decades; on 76 points 5.6, 11
//! and 21. Rounding can keep some segment's bound from being met (`converged` is false there): in two of a hundred sets of
//! 76 points over twelve decades, and of 400 points in two of a hundred with exponential steps and one of ten over
//! twelve decades. The total was met all the same, in every set.
//! Against the exact program, on data with tails up to four decades: the energy up to 5e-4 above it, segments off by
//! 7e-5 of their |Δy| in the median and 0.17 at worst.

mod cone;
mod matrices;
mod nodes;
#[cfg(any(test, feature = "nlopt"))]
pub(crate) mod parts;
mod step;

use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use crate::region::derivative;
use crate::slopes::sign;
pub(crate) use nodes::{Fixed, fixed_by_data};
use nodes::{NodeSystem, largest, natural};
use shapespline_polynomial::quartic::least;
use std::cell::RefCell;
use std::ops::Range;
use step::Problem;

/// Steps after which the best (monotone) iterate is returned as it is.
const MAX_STEPS: usize = 80;
/// Bounds from which on an iterate is part of the result: of E − E* relative to E; of a segment's share of it relative
/// to the geometric mean of its own energy weight and its unit; of the barrier parameter, in the segments' units. At
/// the share [`ALL`] of them it is all of the result.
const ALL: f64 = 0.75;
/// The sum of weights that is as good as 1.
const DONE: f64 = 1.0 - 1e-12;
const ENOUGH: f64 = 4.5e-3;
const ENOUGH_ANYWHERE: f64 = 1.0;
const ENOUGH_BARRIER: f64 = 3e-3;
/// Step lengths (dual and primal together) from which on the iteration does not move any more.
const STUCK: f64 = 1e-6;
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
    /// Bound of the energy's distance from the exact optimum, relative to the energy.
    pub(crate) gap: f64,
    pub(crate) converged: bool,
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
    fixed: &dyn Fn(usize) -> Fixed,
    count: usize,
) -> Option<Optimum> {
    let mut system = NodeSystem::with_capacity(data.len() + 1);
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
    if problem.fixed.iter().flatten().all(|f| !f.is_nan()) {
        // Nothing is free: rounding alone can have hidden that this is monotone.
        return result(&problem.inside, data);
    }
    let mut found = Blend { gap: f64::INFINITY, ..Blend::default() };
    found.add(problem, data);
    problem.start(MASS);
    let mut steps = 1;
    while found.weight < DONE {
        steps += 1;
        let length = problem.step();
        let last = steps == MAX_STEPS || !(length[0] + length[1] > STUCK);
        if last || problem.mean() < ENOUGH_BARRIER {
            found.add(problem, data);
        }
        if last {
            break;
        }
    }
    let nodes = if found.nodes.is_empty() { &problem.inside } else { &found.nodes };
    let (gap, active, converged) = (found.gap, found.active, found.weight > 0.0);
    Optimum { steps, gap, active, converged, ..result(nodes, data) }
}

/// The result in the making: a convex combination of iterates.
#[derive(Default)]
struct Blend {
    nodes: Vec<[f64; 2]>,
    /// The sum of the iterates' weights: 1 when it is done. Until one has a weight, the best one.
    weight: f64,
    gap: f64,
    active: usize,
}

impl Blend {
    /// Add the current point, made feasible, with a weight that grows from 0 to 1 as it gets good enough: so the result
    /// does not jump where another number of steps becomes enough.
    fn add(&mut self, problem: &mut Problem, data: &Data) {
        let share = problem.feasible(data);
        if !(share <= step::FAR) {
            return;
        }
        let (energy, distance, worst) = problem.certificate();
        let gap = distance / energy;
        let measures = [
            share / step::FAR,
            gap / ENOUGH,
            worst / ENOUGH_ANYWHERE,
            problem.mean() / ENOUGH_BARRIER,
        ];
        // NaN has no weight either.
        let ramp = |m: f64| if m < 1.0 { (1.0 - m) / (1.0 - ALL) } else { 0.0 };
        let weight = measures.into_iter().map(ramp).fold(1.0 - self.weight, f64::min);
        let part = if weight > 0.0 {
            let part = weight / (self.weight + weight);
            self.weight += weight;
            part
        } else if self.weight == 0.0 && gap < self.gap {
            1.0
        } else {
            return;
        };
        self.nodes.resize(problem.best.len(), [0.0; 2]);
        for (node, best) in self.nodes.iter_mut().zip(&problem.best) {
            for k in 0..2 {
                node[k] = if part < 1.0 { node[k] + part * (best[k] - node[k]) } else { best[k] };
            }
        }
        let before = if part < 1.0 { (1.0 - part) * self.gap } else { 0.0 };
        (self.gap, self.active) = (before + part * gap, problem.active());
    }
}

#[cfg(test)]
mod tests;
