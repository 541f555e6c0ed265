//! Slopes and second derivatives together: the least energy over all C² monotone quintics on the data's knots.
//!
//! **Problem.** Unknowns are the nodal pairs (dᵢ, sᵢ). The energy is a strictly convex quadratic; monotonicity asks
//! that the derivative's quartic pᵢ ≥ 0 on every segment. The paper's five sufficient conditions (21) ask it of the
//! Bernstein coefficients on the whole segment; asked on ever smaller parts they close in on the exact condition.
//!
//! **Method.** A primal–dual interior-point iteration (Wright, *Primal–Dual Interior-Point Methods*, 1997) that
//! starts strictly inside and stays there. A part whose conditions come close to their limits is halved on the way:
//! the refined conditions are weaker, so the current point stays strictly inside and the iteration just goes on —
//! refinement needs no restart and happens only where conditions are active. One step assembles and eliminates one
//! block-tridiagonal system with 2×2 blocks: O(N).
//!
//! **Guarantee.** Every iterate satisfies the conditions strictly, so the result is monotone whatever the number of
//! steps. If the unconstrained optimum (the natural cubic spline) is monotone, it is the answer, in one step.

use crate::data::Data;
use crate::energy::{self, Fairness, HESSIAN, is_flat};
use crate::quartic_form::{derivative, dot, least};
use crate::slopes::sign;
use crate::subdivision::{Conditions, DEEPEST, Part, level, table};
use shapespline_banded::block_tridiagonal::BlockElimination;

/// Steps after which the current (monotone) iterate is returned as it is.
const MAX_STEPS: usize = 250;
/// Share of the way to the boundary that a step may go.
const FRACTION: f64 = 0.98;
/// Relative duality gap at which the iteration ends.
const GAP: f64 = 1e-8;
/// Barrier parameter at the start, in units of the segments' energy scales.
const START: f64 = 10.0;
/// The same after a refinement, from a point this far on the way back to the interior one.
const RESTART: (f64, f64) = (3.0, 0.3);
/// Refinements, and the relative gap at which one is made.
const PHASES: usize = 2;
const COARSE: f64 = 0.05;
/// Halvings a refinement may make.
const LEVELS: usize = 4;
/// A part of length 2⁻ˡ is halved when one of its coefficients is below this times 2⁻ˡ: the coefficients of a part
/// without a touching point move away from zero as parts shrink.
const NEAR: f64 = 1.5;

/// Slopes, second derivatives and how they were found; scaled units.
#[derive(Debug, Clone, Default)]
pub(crate) struct Optimum {
    pub(crate) d: Vec<f64>,
    pub(crate) s: Vec<f64>,
    /// Newton steps (block-tridiagonal solves).
    pub(crate) steps: usize,
    /// Conditions that hold with equality up to the barrier parameter.
    pub(crate) active: usize,
    /// Duality gap relative to the energy, on the refined conditions.
    pub(crate) gap: f64,
    pub(crate) converged: bool,
}

/// Minimise.
pub(crate) fn optimise(data: &Data, fairness: Fairness) -> Optimum {
    if data.len() == 1 {
        // Two points: the line, to the last bit.
        let d = vec![data.delta[0]; 2];
        return Optimum { d, s: vec![0.0; 2], steps: 1, converged: true, ..Optimum::default() };
    }
    let mut problem = Problem::new(data, fairness);
    let mut optimum = problem.run();
    optimum.d = problem.v.iter().map(|v| v[0]).collect();
    optimum.s = problem.v.iter().map(|v| v[1]).collect();
    optimum
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

struct Problem<'a> {
    data: &'a Data,
    fairness: Fairness,
    table: &'static [Conditions],
    /// Unknowns (d, s).
    v: Vec<[f64; 2]>,
    /// Multipliers of the node conditions over the barrier weight.
    node: Vec<f64>,
    /// Parts of all segments in order; segment i owns `parts[first[i]..first[i+1]]`.
    parts: Vec<Part>,
    first: Vec<u32>,
    /// Multipliers of coefficients 1…4 of every part over the barrier weight.
    lambda: Vec<[f64; 4]>,
    system: BlockElimination,
    rhs: Vec<[f64; 2]>,
    mu: f64,
    /// By-products of the last assembly.
    energy: f64,
    weights: f64,
    complementarity: f64,
}

impl<'a> Problem<'a> {
    fn new(data: &'a Data, fairness: Fairness) -> Self {
        let n = data.len();
        Self {
            data,
            fairness,
            table: table(),
            v: vec![[0.0; 2]; n + 1],
            node: Vec::new(),
            parts: Vec::new(),
            first: Vec::new(),
            lambda: Vec::new(),
            system: BlockElimination::with_capacity(n + 1),
            rhs: Vec::new(),
            mu: 0.0,
            energy: 0.0,
            weights: 0.0,
            complementarity: 0.0,
        }
    }

    fn run(&mut self) -> Optimum {
        let n = self.data.len();
        let mut outcome = Optimum { steps: 1, ..Optimum::default() };
        self.assemble();
        self.v.copy_from_slice(self.system.solve());
        if (0..n).all(|i| self.is_monotone(i)) {
            outcome.converged = true;
            return outcome;
        }
        for i in 0..=n {
            self.v[i] = interior(self.data, i);
        }
        self.mu = START;
        self.node = vec![f64::NAN; n + 1];
        self.parts = vec![1; n];
        self.first = (0..=n as u32).collect();
        self.lambda = vec![[f64::NAN; 4]; n];
        let mut direction: Vec<[f64; 2]> = vec![[0.0; 2]; n + 1];
        let mut residual = 1.0;
        let mut phase = 0;
        while outcome.steps < MAX_STEPS {
            outcome.steps += 1;
            // Predictor: the affine direction, towards complementarity 0.
            self.assemble();
            let mut system = std::mem::take(&mut self.system);
            direction.copy_from_slice(system.solve());
            let affine = self.look(&direction, None);
            let alpha = affine.length.min(1.0);
            let ahead = affine.products[0] + alpha * (affine.products[1] + alpha * affine.products[2]);
            let sigma = (ahead / affine.products[0]).max(0.0);
            let sigma = (sigma * sigma * sigma).max(1e-6);
            let mu = sigma * affine.products[0] / self.weights;
            // Corrector: towards σμ, with the predictor's second-order term, on the same factors.
            self.corrector_rhs(&mut direction, mu);
            let correction = system.solve_again(|i| self.rhs[i]);
            let actual = self.look(correction, Some((&direction, mu)));
            let alpha = (FRACTION * actual.length).min(1.0);
            self.advance(correction, &direction, mu, alpha);
            self.system = system;
            residual *= 1.0 - alpha;
            let [a, b, c] = actual.products;
            let after = a + alpha * (b + alpha * c);
            outcome.gap = after / self.energy;
            self.mu = after / self.weights;
            if outcome.gap <= GAP && residual < 1e-3 {
                outcome.converged = true;
                break;
            }
            if phase < PHASES && residual < 0.1 && outcome.gap < COARSE {
                phase += 1;
                residual = 1.0;
                self.restart();
            }
        }
        outcome.active = self.active();
        outcome
    }

    /// Halve where conditions are near and go on from a point between the current and the interior one: as fresh
    /// conditions have no multipliers, a start at the boundary would crawl.
    fn restart(&mut self) {
        for _ in 0..LEVELS {
            self.refine();
        }
        for (i, v) in self.v.iter_mut().enumerate() {
            let b = interior(self.data, i);
            *v = [v[0] + RESTART.1 * (b[0] - v[0]), v[1] + RESTART.1 * (b[1] - v[1])];
        }
        self.lambda.iter_mut().for_each(|l| *l = [f64::NAN; 4]);
        self.node.iter_mut().for_each(|l| *l = f64::NAN);
        self.mu = RESTART.0;
    }

    /// Whether a segment of the unconstrained optimum is monotone.
    fn is_monotone(&self, i: usize) -> bool {
        let (h, delta) = (self.data.h[i], self.data.delta[i]);
        if is_flat(delta) {
            return true;
        }
        let c = coefficients(h, delta, self.v[i], self.v[i + 1]);
        // Where the slope is fixed at 0 the derivative must leave it in the right direction.
        let leaves = |node: usize, inner: f64| free(&self.data.delta, node) == (true, true) || inner >= 0.0;
        least(&c) >= 0.0 && leaves(i, c[1]) && leaves(i + 1, c[3])
    }

    /// Energy scale of a segment; flats do not count.
    #[inline]
    fn scale(&self, i: usize) -> f64 {
        let delta = self.data.delta[i];
        if is_flat(delta) { f64::INFINITY } else { energy::weight(self.fairness, self.data.h[i], delta) }
    }

    /// The barrier weight of a segment's conditions: the least energy scale around, so that the barrier of a steep
    /// segment does not drown a gentle neighbour's energy.
    #[inline]
    fn barrier(&self, i: usize) -> f64 {
        let mut barrier = self.scale(i);
        if i > 0 {
            barrier = barrier.min(self.scale(i - 1));
        }
        if i + 1 < self.data.len() {
            barrier = barrier.min(self.scale(i + 1));
        }
        barrier
    }

    /// The condition a node contributes: d ≥ 0 where the slope is free, the turn's sign of s where only the second
    /// derivative is. (index of the unknown, sign/unit, weight).
    #[inline]
    fn node_condition(&self, i: usize) -> Option<(usize, f64, f64)> {
        let delta = &self.data.delta;
        let (slope, second) = free(delta, i);
        if !second {
            return None;
        }
        let (l, r) = (i.max(1) - 1, i.min(delta.len() - 1));
        let s = sign(delta[l]);
        let weight = self.scale(l).min(self.scale(r));
        Some(if slope {
            (0, s / delta[l].abs().min(delta[r].abs()), weight)
        } else {
            let h = &self.data.h;
            (1, -s / (delta[l].abs() / h[l]).min(delta[r].abs() / h[r]), weight)
        })
    }

    /// Bernstein coefficients of a segment's derivative over Δ; small ones without cancellation.
    #[inline]
    fn bernstein(a: f64, b: f64, v0: [f64; 2], v1: [f64; 2]) -> [f64; 5] {
        let (c0, c4) = (a * v0[0], a * v1[0]);
        let (c1, c3) = (c0 + b * v0[1], c4 - b * v1[1]);
        [c0, c1, 5.0 - ((c0 + c1) + (c3 + c4)), c3, c4]
    }

    /// Which of coefficients 1…4 of a part are conditions: not the segment's last one (the node's), and none that a
    /// flat neighbour fixes at 0.
    #[inline]
    fn mask(&self, i: usize, part: Part) -> [bool; 4] {
        let l = level(part);
        let index = part - (1 << l);
        let delta = &self.data.delta;
        let mut mask = [true; 4];
        if index == 0 && !free(delta, i).1 {
            mask[0] = false;
        }
        if index + 1 == 1 << l {
            mask[3] = false;
            if !free(delta, i + 1).1 {
                mask[2] = false;
            }
        }
        mask
    }

    /// Assemble and eliminate `(∇²E + Σ (λ/z) a aᵀ) δ = −∇E + Σ (μw/z) a`; with μ = 0 the energy alone, solved for
    /// the unknowns themselves.
    fn assemble(&mut self) {
        let n = self.data.len();
        let mu = self.mu;
        self.system.clear();
        (self.energy, self.weights, self.complementarity) = (0.0, 0.0, 0.0);
        let mut diagonal = [0.0f64; 3];
        let mut rhs = [0.0f64; 2];
        let mut free0 = free(&self.data.delta, 0);
        for i in 0..=n {
            let mut coupling = [0.0; 4];
            let mut next_diagonal = [0.0; 3];
            let mut next_rhs = [0.0; 2];
            let free1 = if i < n { free(&self.data.delta, i + 1) } else { (false, false) };
            if mu > 0.0 {
                if let Some((k, unit, weight)) = self.node_condition(i) {
                    let z = unit * self.v[i][k];
                    let lambda = settle(self.node[i], mu, z);
                    self.node[i] = lambda;
                    diagonal[2 * k] += unit * unit * (weight * (lambda / z));
                                        self.weights += weight;
                    self.complementarity += weight * lambda * z;
                }
            }
            if i < n {
                let (a, b, weight) = factors(self.data, self.fairness, i);
                if weight > 0.0 {
                    let (m, r) = self.local_system(i, a, b, weight);
                    diagonal[0] += a * (a * m[0]);
                    diagonal[1] += a * (b * m[1]);
                    diagonal[2] += b * (b * m[4]);
                    coupling =
                        [a * (a * m[2]), a * (b * m[3]), b * (a * m[5]), b * (b * m[6])];
                    next_diagonal = [a * (a * m[7]), a * (b * m[8]), b * (b * m[9])];
                    rhs[0] += a * r[0];
                    rhs[1] += b * r[1];
                    next_rhs = [a * r[2], b * r[3]];
                }
            }
            // A fixed unknown: its row is the identity with right-hand side 0.
            if !free0.0 {
                (diagonal[0], diagonal[1], rhs[0]) = (1.0, 0.0, 0.0);
                (coupling[0], coupling[1]) = (0.0, 0.0);
            }
            if !free0.1 {
                (diagonal[2], diagonal[1], rhs[1]) = (1.0, 0.0, 0.0);
                (coupling[2], coupling[3]) = (0.0, 0.0);
            }
            if !free1.0 {
                (coupling[0], coupling[2]) = (0.0, 0.0);
            }
            if !free1.1 {
                (coupling[1], coupling[3]) = (0.0, 0.0);
            }
            self.system.push(diagonal, coupling, rhs);
            (diagonal, rhs, free0) = (next_diagonal, next_rhs, free1);
        }
    }

    /// A segment's matrix (upper triangle, row by row) and right-hand side in its dimensionless unknowns.
    #[inline]
    fn local_system(&mut self, i: usize, a: f64, b: f64, weight: f64) -> ([f64; 10], [f64; 4]) {
        let e = weight / 35.0;
        let (v0, v1) = (self.v[i], self.v[i + 1]);
        let u = [a * v0[0] - 1.0, b * v0[1], a * v1[0] - 1.0, b * v1[1]];
        let mut m = [0.0; 10];
        let mut r = [0.0; 4];
        let mut at = 0;
        for j in 0..4 {
            for k in 0..4 {
                r[j] -= HESSIAN[j][k] * u[k];
                if k >= j {
                    m[at] = e * HESSIAN[j][k];
                    at += 1;
                }
            }
            r[j] *= e;
        }
        self.energy += e * energy::local(u[0], u[1], u[2], u[3]);
        let mu = self.mu;
        if mu == 0.0 {
            return (m, r);
        }
        let c = Self::bernstein(a, b, v0, v1);
        let w = self.barrier(i);
        for p in self.first[i] as usize..self.first[i + 1] as usize {
            let mask = self.mask(i, self.parts[p]);
            let rows = &self.table[usize::from(self.parts[p])];
            for j in 0..4 {
                if !mask[j] {
                    continue;
                }
                let z = dot(&c, &rows.value[j + 1]);
                let g = &rows.gradient[j + 1];
                let inverse = 1.0 / z;
                let lambda = settle(self.lambda[p][j], mu, z);
                self.lambda[p][j] = lambda;
                self.weights += w;
                self.complementarity += w * lambda * z;
                let stiffness = w * lambda * inverse;
                let mut at = 0;
                for k in 0..4 {
                    let s = stiffness * g[k];
                    for l in k..4 {
                        m[at] += s * g[l];
                        at += 1;
                    }
                }
            }
        }
        (m, r)
    }

    /// Visit every condition: z, its multiplier over the weight, its weight, and its changes along two directions.
    #[inline]
    fn conditions(
        &mut self,
        one: &[[f64; 2]],
        two: &[[f64; 2]],
        mut visit: impl FnMut(f64, &mut f64, f64, f64, f64),
    ) {
        let n = self.data.len();
        for i in 0..=n {
            if let Some((k, unit, weight)) = self.node_condition(i) {
                let z = unit * self.v[i][k];
                visit(z, &mut self.node[i], weight, unit * one[i][k], unit * two[i][k]);
            }
            if i == n {
                break;
            }
            let (a, b, weight) = factors(self.data, self.fairness, i);
            if weight == 0.0 {
                continue;
            }
            let w = self.barrier(i);
            let c = Self::bernstein(a, b, self.v[i], self.v[i + 1]);
            let change = |d: &[[f64; 2]]| {
                let mut dc = Self::bernstein(a, b, d[i], d[i + 1]);
                dc[2] -= 5.0;
                dc
            };
            let (dc, ec) = (change(one), change(two));
            for p in self.first[i] as usize..self.first[i + 1] as usize {
                let mask = self.mask(i, self.parts[p]);
                let rows = &self.table[usize::from(self.parts[p])];
                for j in 0..4 {
                    if mask[j] {
                        let row = &rows.value[j + 1];
                        visit(dot(&c, row), &mut self.lambda[p][j], w, dot(&dc, row), dot(&ec, row));
                    }
                }
            }
        }
    }

    /// How far a direction may go, and Σ w(z + αdz)(λ + αdλ) as a polynomial in α. Without a predictor: the affine
    /// direction; with one: the corrected direction towards μ.
    fn look(&mut self, step: &[[f64; 2]], corrected: Option<(&[[f64; 2]], f64)>) -> Look {
        let mut shortest = 0.0f64;
        let mut products = [0.0; 3];
        let (affine, mu) = corrected.unwrap_or((step, 0.0));
        let corrects = corrected.is_some();
        self.conditions(step, affine, |z, lambda, w, dz, az| {
            let lambda = *lambda;
            let dl = change(z, lambda, dz, az, mu, corrects);
            shortest = shortest.max(-dz / z).max(-dl / lambda);
            products[0] += w * z * lambda;
            products[1] += w * (z * dl + lambda * dz);
            products[2] += w * dz * dl;
        });
        Look { length: 1.0 / shortest, products }
    }

    /// `−∇E + Σ w (μ − dz dλ)/z a` along the affine direction.
    fn corrector_rhs(&mut self, affine: &mut [[f64; 2]], mu: f64) {
        let n = self.data.len();
        let mut rhs = std::mem::take(&mut self.rhs);
        rhs.clear();
        rhs.resize(n + 1, [0.0; 2]);
        for i in 0..=n {
            if let Some((k, unit, weight)) = self.node_condition(i) {
                let z = unit * self.v[i][k];
                let lambda = self.node[i];
                let az = unit * affine[i][k];
                let al = -lambda * (1.0 + az / z);
                rhs[i][k] += unit * (weight * ((mu - az * al) / z));
            }
            if i == n {
                break;
            }
            let (a, b, weight) = factors(self.data, self.fairness, i);
            if weight == 0.0 {
                continue;
            }
            let e = weight / 35.0;
            let w = self.barrier(i);
            let (v0, v1) = (self.v[i], self.v[i + 1]);
            let u = [a * v0[0] - 1.0, b * v0[1], a * v1[0] - 1.0, b * v1[1]];
            let c = Self::bernstein(a, b, v0, v1);
            let mut ac = Self::bernstein(a, b, affine[i], affine[i + 1]);
            ac[2] -= 5.0;
            let mut r = [0.0; 4];
            for j in 0..4 {
                for k in 0..4 {
                    r[j] -= HESSIAN[j][k] * u[k];
                }
                r[j] *= e;
            }
            for p in self.first[i] as usize..self.first[i + 1] as usize {
                let mask = self.mask(i, self.parts[p]);
                let rows = &self.table[usize::from(self.parts[p])];
                for j in 0..4 {
                    if mask[j] {
                        let z = dot(&c, &rows.value[j + 1]);
                        let az = dot(&ac, &rows.value[j + 1]);
                        let lambda = self.lambda[p][j];
                        let al = -lambda * (1.0 + az / z);
                        let force = w * ((mu - az * al) / z);
                        for k in 0..4 {
                            r[k] += force * rows.gradient[j + 1][k];
                        }
                    }
                }
            }
            rhs[i][0] += a * r[0];
            rhs[i][1] += b * r[1];
            rhs[i + 1][0] += a * r[2];
            rhs[i + 1][1] += b * r[3];
        }
        for (i, r) in rhs.iter_mut().enumerate() {
            let (slope, second) = free(&self.data.delta, i);
            *r = [if slope { r[0] } else { 0.0 }, if second { r[1] } else { 0.0 }];
        }
        self.rhs = rhs;
    }

    fn advance(&mut self, step: &[[f64; 2]], affine: &[[f64; 2]], mu: f64, alpha: f64) {
        self.conditions(step, affine, |z, lambda, _, dz, az| {
            *lambda += alpha * change(z, *lambda, dz, az, mu, true);
        });
        for (v, d) in self.v.iter_mut().zip(step) {
            *v = [v[0] + alpha * d[0], v[1] + alpha * d[1]];
        }
    }

    /// Halve the parts with a condition near its limit.
    fn refine(&mut self) {
        let n = self.data.len();
        
        let mut parts = Vec::with_capacity(self.parts.len() + n / 2);
        let mut lambda = Vec::with_capacity(self.lambda.len() + n / 2);
        for i in 0..n {
            let (a, b, weight) = factors(self.data, self.fairness, i);
            let c = Self::bernstein(a, b, self.v[i], self.v[i + 1]);
            let range = self.first[i] as usize..self.first[i + 1] as usize;
            self.first[i] = parts.len() as u32;
            for p in range {
                let part = self.parts[p];
                let rows = &self.table[usize::from(part)];
                let mask = self.mask(i, part);
                let near = NEAR / f64::from(1u32 << level(part));
                let close = weight > 0.0
                    && level(part) < DEEPEST
                    && (0..4).any(|j| mask[j] && dot(&c, &rows.value[j + 1]) < near);
                if close {
                    parts.extend([2 * part, 2 * part + 1]);
                    lambda.extend([[f64::NAN; 4]; 2]);
                } else {
                    parts.push(part);
                    lambda.push(self.lambda[p]);
                }
            }
        }
        self.first[n] = parts.len() as u32;
        self.parts = parts;
        self.lambda = lambda;
    }

    fn active(&mut self) -> usize {
        let zero = vec![[0.0; 2]; self.v.len()];
        let mu = self.mu;
        let mut count = 0;
        // λz = μ on the path: an active condition has its multiplier, an inactive one its distance of order one.
        self.conditions(&zero, &zero, |z, lambda, _, _, _| count += usize::from(*lambda * mu.sqrt() > z));
        count
    }
}

/// What a direction allows.
struct Look {
    length: f64,
    products: [f64; 3],
}

/// The change of a multiplier along a direction: `(μ − az·aλ)/z − λ(1 + dz/z)`, without the middle terms for the
/// affine one.
#[inline]
fn change(z: f64, lambda: f64, dz: f64, az: f64, mu: f64, corrected: bool) -> f64 {
    let target = if corrected { (mu + az * (lambda * (1.0 + az / z))) / z } else { 0.0 };
    target - lambda * (1.0 + dz / z)
}

/// A multiplier kept within two decades of the central path; a fresh one (NaN) starts on it.
#[inline]
fn settle(lambda: f64, mu: f64, z: f64) -> f64 {
    let central = mu / z;
    if lambda > 0.0 { lambda } else { central }
}

/// The factors from (d, s) to the dimensionless (1 + a, b) of a segment, `1/Δ` and `h/(4Δ)`, and its energy weight;
/// all 0 for a flat segment.
#[inline]
fn factors(data: &Data, fairness: Fairness, i: usize) -> (f64, f64, f64) {
    let (h, delta) = (data.h[i], data.delta[i]);
    if is_flat(delta) {
        return (0.0, 0.0, 0.0);
    }
    let a = 1.0 / delta;
    (a, 0.25 * h * a, energy::weight(fairness, h, delta))
}

