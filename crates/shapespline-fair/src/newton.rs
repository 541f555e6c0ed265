// SPDX-License-Identifier: MIT OR Apache-2.0

//! Damped Newton steps on a chain: objective and barrier at once.
//!
//! The function is a sum over segments, and so is everything here. Where the Hessian of the whole is
//! indefinite, each indefinite element is mended by itself ([`make_definite`]). And where a step leads
//! out of the barrier, or does not lead downwards, the segments that are why are damped, not the step of
//! the whole curve: their Hessians are multiplied by a factor. So one hard spot does not hold up the
//! others, and where all are damped alike it is backtracking. (After the structured trust regions of A. R.
//! Conn, N. Gould, A. Sartenaer, P. L. Toint, SIAM J. Optim. 6 (1996) 674–703.)
//!
//! The elastic phase leaves the curvature of the conditions out (Gauss and Newton's matrix): as many steps, none
//! of which is indefinite.

use glam::DVec3;

use crate::{
    barrier::Barrier,
    chain::{Chain, Freedom},
    control::Control,
    definite::make_definite,
    element::Node,
    energy,
    legs::{ElementGradient, ElementHessian, LegTerms},
    shape::{Gradient, Shape},
    workspace::{Term, Workspace},
};

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Decrement, over the sum of the segments' weights, below which the minimum counts as reached.
    pub(crate) decrement: f64,
    /// Largest number of steps.
    pub(crate) steps: usize,
    /// Whether to stop as soon as all conditions hold clearly.
    pub(crate) until_all_hold: bool,
}

/// Least share of the decrement that the function has to fall by.
const ARMIJO: f64 = 1e-4;
/// What rounding may add to the function, over the sizes of its terms.
const ROUNDING: f64 = 1e-14;
/// Share of `½ΔᵀH_kΔ` by which a segment may miss its quadratic model before its steps are damped.
const MISS: f64 = 0.7;
/// First damping, the factor by which it grows, and that by which it falls where it was not needed.
const FIRST: f64 = 1.0;
const GROWTH: f64 = 3.0;
const RELIEF: f64 = 9.0;
/// Damped solves in a step.
const SOLVES: usize = 24;

impl Chain {
    /// Minimises objective and barrier. Whether the minimum was reached.
    pub(crate) fn minimise(
        &mut self,
        barrier: &Barrier,
        limits: Limits,
        control: &mut Control<'_>,
    ) -> bool {
        let mut w = std::mem::take(&mut self.workspace);
        self.choose_quadrature();
        self.kept.clear();
        self.keep_what_holds(barrier);
        self.evaluate(barrier, &mut w.values, &mut w.margins);
        self.multipliers.resize(self.rows.len(), f64::NAN);
        self.complete_multipliers(barrier, &w.margins);
        w.damping.clear();
        w.damping.resize(self.segments.len(), 0.0);
        let unit: f64 = self.segments.iter().map(|segment| segment.weight).sum();
        let renews = self.bends() || barrier.protects;
        let mut converged = false;
        for _ in 0..limits.steps {
            if limits.until_all_hold && self.all_hold_clearly() {
                converged = true;
                break;
            }
            if w.values.iter().any(|v| !v.is_finite()) || !control.next_step() {
                break;
            }
            self.linearise(barrier, &mut w);
            let Some(decrement) = self.step(barrier, &mut w, control) else { break };
            self.update_multipliers(barrier, &w);
            if renews {
                self.choose_quadrature();
                self.keep_what_holds(barrier);
                self.evaluate(barrier, &mut w.values, &mut w.margins);
            }
            // What damping holds back is not reached yet.
            let damping = w.damping.iter().fold(0.0f64, |most, &d| most.max(d));
            if (1.0 + damping) * decrement <= limits.decrement * unit {
                converged = true;
                break;
            }
        }
        self.workspace = w;
        converged
    }

    /// Newton's plain steps from near a minimum, as long as each promises less than the one before: they end at
    /// rounding, where the values of the function can no longer tell better from worse.
    pub(crate) fn polish(&mut self, barrier: &Barrier, steps: usize, control: &mut Control<'_>) {
        let mut w = std::mem::take(&mut self.workspace);
        w.damping.clear();
        w.damping.resize(self.segments.len(), 0.0);
        self.choose_quadrature();
        self.evaluate(barrier, &mut w.values, &mut w.margins);
        let mut least = f64::INFINITY;
        for _ in 0..steps {
            self.linearise(barrier, &mut w);
            self.assemble(&mut w);
            let solved = w.factors.factor(&w.diagonal, &w.coupling).is_ok();
            if !solved || !control.next_step() {
                break;
            }
            self.solve_direction(&mut w);
            let decrement = self.decrement(&w);
            // Written so that a NaN ends it.
            if !(decrement < 0.25 * least) {
                break;
            }
            least = decrement;
            w.before.clone_from(&self.nodes);
            self.advance(&w);
            self.evaluate(barrier, &mut w.trial, &mut w.trial_margins);
            if w.trial.iter().any(|v| !v.is_finite()) {
                self.nodes.clone_from(&w.before);
                break;
            }
            std::mem::swap(&mut w.margins, &mut w.trial_margins);
            self.update_multipliers(barrier, &w);
        }
        self.workspace = w;
    }

    /// Solves the assembled system for the direction of the step.
    fn solve_direction(&self, w: &mut Workspace) {
        w.factors.solve(&mut w.right);
        w.direction.clear();
        w.direction.extend(w.right.iter().map(node));
        for (step, freedom) in w.direction.iter_mut().zip(&self.freedom) {
            for (v, line) in [&mut step.q, &mut step.r].into_iter().zip(freedom.lines()) {
                if let Some(t) = line {
                    *v = t * v.dot(t);
                }
            }
        }
    }

    /// Takes the step from where the nodes were before.
    fn advance(&mut self, w: &Workspace) {
        for (node, (old, step)) in self.nodes.iter_mut().zip(w.before.iter().zip(&w.direction)) {
            *node = old.plus(*step);
        }
    }

    fn evaluate(&self, barrier: &Barrier, values: &mut Vec<f64>, margins: &mut Vec<f64>) {
        values.clear();
        margins.clear();
        values.extend((0..self.segments.len()).map(|k| self.value(k, barrier, margins)));
    }

    /// Gives rows without a multiplier their primal one.
    fn complete_multipliers(&mut self, barrier: &Barrier, margins: &[f64]) {
        let rows = self.multipliers.iter_mut().zip(margins).zip(&self.kept);
        for ((multiplier, &z), &kept) in rows {
            let barrier = barrier.of(kept);
            *multiplier = if multiplier.is_nan() {
                barrier.multiplier(z)
            } else {
                barrier.safeguarded(z, *multiplier)
            };
        }
    }

    /// Takes one step. The decrement `−gᵀΔ`, or nothing where no step is to be had.
    fn step(
        &mut self,
        barrier: &Barrier,
        w: &mut Workspace,
        control: &mut Control<'_>,
    ) -> Option<f64> {
        self.assemble(w);
        if w.factors.factor(&w.diagonal, &w.coupling).is_err() {
            for (segment, hessian) in self.segments.iter().zip(&mut w.hessians) {
                make_definite(&segment.span, hessian);
            }
            self.assemble(w);
            w.factors.factor(&w.diagonal, &w.coupling).ok()?;
        }
        w.before.clone_from(&self.nodes);
        w.flagged.clear();
        w.flagged.resize(self.segments.len(), false);
        for _ in 0..SOLVES {
            control.solves += 1;
            self.solve_direction(w);
            let decrement = self.decrement(w);
            if !decrement.is_finite() {
                return None;
            }
            self.advance(w);
            self.evaluate(barrier, &mut w.trial, &mut w.trial_margins);
            if is_good(decrement, w) {
                relieve(w);
                std::mem::swap(&mut w.values, &mut w.trial);
                std::mem::swap(&mut w.margins, &mut w.trial_margins);
                return Some(decrement);
            }
            self.blame(w);
            self.nodes.clone_from(&w.before);
            self.assemble(w);
            w.factors.factor(&w.diagonal, &w.coupling).ok()?;
        }
        None
    }

    /// Damps the segments that are why a step is bad.
    fn blame(&self, w: &mut Workspace) {
        let outside = w.trial.iter().any(|v| v.is_infinite());
        let mut misses = Vec::with_capacity(self.segments.len());
        for k in 0..self.segments.len() {
            let [linear, square] = self.model(k, w);
            let miss = w.trial[k] - w.values[k] - linear - square;
            let blamed =
                if outside { w.trial[k].is_infinite() } else { miss > MISS * square.max(0.0) };
            misses.push((miss, blamed));
        }
        if !misses.iter().any(|miss| miss.1) {
            // No segment exceeds its share: damp the one that misses most.
            let worst = (0..misses.len()).max_by(|&a, &b| misses[a].0.total_cmp(&misses[b].0));
            worst.into_iter().for_each(|k| misses[k].1 = true);
        }
        for (k, _) in misses.iter().enumerate().filter(|(_, miss)| miss.1) {
            w.flagged[k] = true;
            w.damping[k] = (GROWTH * w.damping[k]).max(FIRST);
            make_definite(&self.segments[k].span, &mut w.hessians[k]);
        }
    }

    /// Linear and quadratic part of a segment's change along the direction.
    fn model(&self, k: usize, w: &Workspace) -> [f64; 2] {
        let [start, end] = self.ends(k).map(|i| w.direction[i]);
        let step = [start.q, start.r, end.q, end.r];
        let linear: f64 = step.iter().zip(&w.gradients[k]).map(|(s, g)| s.dot(*g)).sum();
        let flat: [f64; 12] = std::array::from_fn(|i| step[i / 3][i % 3]);
        let mut square = 0.0;
        for (x, row) in flat.iter().zip(&w.hessians[k]) {
            square += x * row.iter().zip(&flat).map(|(h, y)| h * y).sum::<f64>();
        }
        [linear, 0.5 * square]
    }

    /// Gradients and Hessians of all segments.
    fn linearise(&self, barrier: &Barrier, w: &mut Workspace) {
        w.gradients.clear();
        w.hessians.clear();
        w.terms.clear();
        for k in 0..self.segments.len() {
            let (g, h) = self.element(k, barrier, &w.margins, &mut w.terms);
            w.gradients.push(g);
            w.hessians.push(h);
        }
    }

    /// Gradient and Hessian of a segment.
    fn element(
        &self,
        k: usize,
        barrier: &Barrier,
        margins: &[f64],
        known: &mut Vec<Term>,
    ) -> (ElementGradient, ElementHessian) {
        let segment = &self.segments[k];
        let legs = self.legs(k);
        let shape = Shape::new(segment, &self.rules, &legs);
        let mut terms = LegTerms::zero();
        let mut normals = [DVec3::ZERO; 7];
        let exact = barrier.penalty.is_none() || barrier.protects;
        energy::add(segment.energy, &segment.span, &legs, self.rule(k), &mut terms);
        for i in self.ranges[k].clone() {
            let (row, own) = (&self.rows[i], self.multipliers[i]);
            let barrier = barrier.of(self.kept[i]);
            let z = margins[i];
            let (primal, stiffness) = (barrier.multiplier(z), barrier.stiffness(z, own));
            if primal == 0.0 && own == 0.0 && stiffness == 0.0 {
                known.push(Term { gradient: Gradient::ZERO, primal, stiffness });
                continue;
            }
            let gradient = shape.gradient(row);
            known.push(Term { gradient, primal, stiffness });
            let first = gradient.first;
            for (j, g) in gradient.legs.iter().enumerate() {
                terms.gradient[first + j] -= *g * (segment.weight * primal);
            }
            terms.add_square(first, &gradient.legs, segment.weight * stiffness);
            if exact {
                shape.add_curvature(row, segment.weight * own, &mut normals, &mut terms);
            }
        }
        terms.add_products(&normals);
        let mut hessian = terms.pull_back(&segment.span);
        let mut gradient = segment.span.pull_back(&terms.gradient);
        self.restrict(k, &mut gradient, &mut hessian);
        (gradient, hessian)
    }

    /// Whether a coordinate of a node may not move.
    fn is_fixed(&self, node: usize, i: usize) -> bool {
        let held = match self.freedom[node] {
            Freedom::Free | Freedom::Along(_) | Freedom::Straight(_) => false,
            Freedom::Held => true,
            Freedom::TangentHeld | Freedom::StraightHeld(_) => i < 3,
        };
        held || (self.segments[0].planar && i % 3 == 2)
    }

    /// Takes out what may not move.
    fn restrict(&self, k: usize, gradient: &mut ElementGradient, hessian: &mut ElementHessian) {
        for (side, node) in self.ends(k).into_iter().enumerate() {
            for c in (0..6).filter(|&c| self.is_fixed(node, c)) {
                let i = 6 * side + c;
                gradient[i / 3][i % 3] = 0.0;
                hessian[i] = [0.0; 12];
                hessian.iter_mut().for_each(|row| row[i] = 0.0);
            }
            for (k, line) in self.freedom[node].lines().into_iter().enumerate() {
                let Some(t) = line else { continue };
                let (t, from, own) = (t.to_array(), 6 * side + 3 * k, 2 * side + k);
                gradient[own] = DVec3::from(t) * gradient[own].dot(DVec3::from(t));
                let along = |v: [f64; 3]| t.map(|x| x * (v[0] * t[0] + v[1] * t[1] + v[2] * t[2]));
                for row in hessian.iter_mut() {
                    let v = along([row[from], row[from + 1], row[from + 2]]);
                    row[from..from + 3].copy_from_slice(&v);
                }
                for j in 0..12 {
                    let v = along([0, 1, 2].map(|i| hessian[from + i][j]));
                    (0..3).for_each(|i| hessian[from + i][j] = v[i]);
                }
                // Across the direction nothing moves, whatever the stiffness.
                let stiffness = (0..3).map(|i| hessian[from + i][from + i].abs()).sum::<f64>();
                let stiffness = stiffness.max(f64::MIN_POSITIVE);
                for i in 0..3 {
                    for j in 0..3 {
                        let across = f64::from(u8::from(i == j)) - t[i] * t[j];
                        hessian[from + i][from + j] += stiffness * across;
                    }
                }
            }
        }
    }

    /// The system of Newton's step, with the damping.
    fn assemble(&self, w: &mut Workspace) {
        let n = self.nodes.len();
        w.diagonal.clear();
        w.diagonal.resize(n, [[0.0; 6]; 6]);
        w.right.clear();
        w.right.resize(n, [0.0; 6]);
        w.coupling.clear();
        for (k, (g, h)) in w.gradients.iter().zip(&w.hessians).enumerate() {
            let [start, end] = self.ends(k);
            let f = 1.0 + w.damping[k];
            for i in 0..6 {
                for j in 0..6 {
                    w.diagonal[start][i][j] += f * h[i][j];
                    w.diagonal[end][i][j] += f * h[6 + i][6 + j];
                }
                w.right[start][i] -= g[i / 3][i % 3];
                w.right[end][i] -= g[2 + i / 3][i % 3];
            }
            w.coupling.push(std::array::from_fn(|i| std::array::from_fn(|j| f * h[i][6 + j])));
        }
        // What is fixed has no row of its own.
        for node in 0..n {
            for i in (0..6).filter(|&i| self.is_fixed(node, i)) {
                w.diagonal[node][i][i] = 1.0;
            }
        }
    }

    /// `−gᵀΔ`: twice the decrease that the undamped model promises.
    fn decrement(&self, w: &Workspace) -> f64 {
        let mut sum = 0.0;
        for (k, g) in w.gradients.iter().enumerate() {
            let [start, end] = self.ends(k).map(|i| w.direction[i]);
            sum -= g[0].dot(start.q) + g[1].dot(start.r) + g[2].dot(end.q) + g[3].dot(end.r);
        }
        sum
    }

    /// Moves the multipliers with the step that was taken.
    fn update_multipliers(&mut self, barrier: &Barrier, w: &Workspace) {
        for k in 0..self.segments.len() {
            let [start, end] = self.ends(k).map(|i| w.direction[i]);
            let step = self.segments[k].span.step(start, end);
            for i in self.ranges[k].clone() {
                let Term { gradient, primal, stiffness } = w.terms[i];
                let moved = primal - stiffness * gradient.along(&step);
                self.multipliers[i] = barrier.of(self.kept[i]).safeguarded(w.margins[i], moved);
            }
        }
    }
}

/// Whether the function has fallen enough, as far as rounding lets it be seen.
fn is_good(decrement: f64, w: &Workspace) -> bool {
    let change: f64 = w.trial.iter().zip(&w.values).map(|(t, v)| t - v).sum();
    let size: f64 = w.values.iter().map(|v| v.abs()).sum();
    change <= -ARMIJO * decrement + ROUNDING * size
}

/// Less damping where a good step needed none.
fn relieve(w: &mut Workspace) {
    for (damping, _) in w.damping.iter_mut().zip(&w.flagged).filter(|(_, flagged)| !**flagged) {
        *damping /= RELIEF;
        if *damping < FIRST {
            *damping = 0.0;
        }
    }
}

fn node(x: &[f64; 6]) -> Node {
    Node { q: DVec3::new(x[0], x[1], x[2]), r: DVec3::new(x[3], x[4], x[5]) }
}
