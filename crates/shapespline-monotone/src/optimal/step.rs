// SPDX-License-Identifier: MIT OR Apache-2.0

//! The iteration's working memory and one step of it.

use super::cone::{self, Aim, Factors, Given, State, W};
use super::nodes::{self, Fixed, NodeSystem, fixed_by_data, gather, largest, local, pair};
use super::{Prescribed, coefficients};
use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use shapespline_polynomial::certified_nonnegative;
use shapespline_polynomial::quartic::{basis, dot, lowest, without_zeros};

/// Share of the way to the boundary that a step may go.
const FRACTION: f64 = 0.98;
/// What a step aims at, in units of the current barrier parameter.
const AIM: f64 = 0.04;
/// After a step shorter than the first (the iterate has lost the centre) the next one aims at [`CENTRE`] instead:
/// without, one fit in a thousand over twelve decades does not end. Up to the second it aims at something between.
const SHORT: [f64; 2] = [0.25, 0.4];
const CENTRE: f64 = 0.8;
/// The largest share of the way to the strictly feasible point that the primal point may be moved.
pub(super) const FAR: f64 = 2e-2;
/// Mass of a segment's multipliers, in units of the mean of tr XZ, from which on it counts as held at 0 somewhere.
const HELD: f64 = 10.0;
/// A segment's multipliers are measured in the largest energy weight near it, which counts by this factor less with
/// every segment between: what happens at a node is felt at the next by about so much. In one unit for all, segments
/// of little energy would stay at the centre of their cones until those of the most energy have ended.
const DECAY: f64 = 0.25;

/// Segments of less energy weight, in their unit, are judged as if they had this much: their share in the range is far
/// below what is left of the residual's rounding errors, on which a result must not depend.
const LIGHT: f64 = 1e-11;

/// Working memory: kept from fit to fit, so that a fit allocates nothing but its result.
#[derive(Default)]
pub(super) struct Problem {
    /// Segments and nodes.
    pub(super) n: usize,
    pub(super) given: Vec<Given>,
    pub(super) states: Vec<State>,
    pub(super) factors: Vec<Factors>,
    /// The predictor's aims and the corrector's.
    pub(super) aims: [Vec<Aim>; 2],
    pub(super) changes: Vec<State>,
    /// What is fixed at the nodes, and whether nothing is.
    pub(super) fixed: Vec<Fixed>,
    pub(super) all_free: bool,
    /// The dual point: the unknowns that the multipliers imply.
    pub(super) v: Vec<[f64; 2]>,
    /// A strictly feasible point, the primal point, and one between the two.
    pub(super) inside: Vec<[f64; 2]>,
    pub(super) w: Vec<[f64; 2]>,
    pub(super) best: Vec<[f64; 2]>,
    /// The shorter length of the last step.
    length: f64,
    /// tr XZ of all segments, each in its own unit.
    sum: f64,
    /// The point that Newton's step ends at.
    pub(super) ahead: Vec<[f64; 2]>,
    rhs: Vec<[f64; 2]>,
    /// The energy's own Hessian, eliminated.
    natural: NodeSystem,
    pub(super) system: NodeSystem,
    /// The largest energy weight.
    scale: f64,
}

impl Problem {
    /// Set up.
    pub(super) fn pose(
        &mut self,
        data: &Data,
        fairness: Fairness,
        prescribed: Option<Prescribed<'_>>,
    ) {
        let n = data.len();
        let chunks = n.div_ceil(W);
        self.n = n;
        self.fixed.clear();
        self.inside.clear();
        match prescribed {
            Some(Prescribed { fixed, inside }) => {
                self.fixed.extend_from_slice(fixed);
                self.inside.extend_from_slice(inside);
            }
            None => {
                self.fixed.extend((0..=n).map(|i| fixed_by_data(&data.delta, i)));
                self.inside.extend((0..=n).map(|i| super::interior(data, i)));
            }
        }
        self.all_free = self.fixed.iter().flatten().all(|f| f.is_nan());
        self.scale = largest(data, fairness);
        self.given.clear();
        self.given.extend((0..chunks).map(|j| {
            let mut given = Given::IDLE;
            for l in 0..W.min(n - j * W) {
                let i = j * W + l;
                let (p, q) = (self.fixed[i], self.fixed[i + 1]);
                if is_flat(data.delta[i]) || !p.iter().chain(&q).any(|f| f.is_nan()) {
                    continue;
                }
                (given.a[l], given.b[l], given.e[l]) = nodes::units(data, fairness, self.scale, i);
                given.idle[l] = 0.0;
                let vanish = [p[0] == 0.0, p == [0.0; 2], q == [0.0; 2], q[0] == 0.0];
                for (k, vanishes) in vanish.into_iter().enumerate() {
                    given.fixed[k][l] = f64::from(u8::from(vanishes));
                }
            }
            given
        }));
        self.choose_units();
        let size = chunks * W + 1;
        self.inside.resize(size, [0.0; 2]);
        for list in [&mut self.v, &mut self.w, &mut self.best, &mut self.ahead, &mut self.rhs] {
            list.clear();
            list.resize(size, [0.0; 2]);
        }
    }

    /// The unit of every segment's multipliers from the energy weights, and the weights in it.
    fn choose_units(&mut self) {
        let mut sweep = |backwards: bool| {
            let mut carry = 0.0f64;
            for k in 0..self.n {
                let i = if backwards { self.n - 1 - k } else { k };
                let (given, l) = (&mut self.given[i / W], i % W);
                // What has nothing free keeps the two sides apart.
                carry = if given.idle[l] == 0.0 {
                    given.unit[l].max(given.e[l]).max(DECAY * carry)
                } else {
                    0.0
                };
                given.unit[l] = carry;
            }
        };
        sweep(false);
        sweep(true);
        for given in &mut self.given {
            for l in (0..W).filter(|&l| given.idle[l] == 0.0) {
                given.e[l] /= given.unit[l];
            }
        }
    }

    /// Put the energy's own minimiser to `v`; its elimination is kept.
    pub(super) fn minimise_unconstrained(&mut self, data: &Data, fairness: Fairness) {
        let fixed = |i: usize| self.fixed[i];
        let v = nodes::natural(&mut self.natural, data, fairness, self.scale, fixed);
        self.v[..=self.n].copy_from_slice(v);
        // As a point to be judged: no moments hold it.
        self.w.copy_from_slice(&self.v);
        self.states.clear();
        self.states.resize(self.given.len(), cone::State::NONE);
        self.sum = 0.0;
    }

    /// Start in the centre of the cones, the primal point at `inside`.
    pub(super) fn start(&mut self, mass: f64) {
        self.states.clear();
        self.states.extend(self.given.iter().map(|given| cone::start(given, mass)));
        self.factors.resize(self.given.len(), Factors::EMPTY);
        for aims in &mut self.aims {
            aims.resize(self.given.len(), Aim::EMPTY);
        }
        self.changes.resize(self.given.len(), self.states[0]);
        self.w.copy_from_slice(&self.inside);
        self.length = 1.0;
        self.sum = self.given.len() as f64 * W as f64 * mass;
    }

    /// One step of predictor and corrector. The dual and the primal step's lengths.
    pub(super) fn step(&mut self) -> [f64; 2] {
        let n = self.n;
        let predictor = &mut self.aims[0];
        for (j, given) in self.given.iter().enumerate() {
            cone::factorise(given, &self.states[j], &mut self.factors[j], &mut predictor[j]);
        }
        let lost = ((SHORT[1] - self.length) / (SHORT[1] - SHORT[0])).clamp(0.0, 1.0);
        let mu = (AIM + lost * (CENTRE - AIM)) * self.mean();
        self.eliminate();
        self.rhs.fill([0.0; 2]);
        let [predictor, corrector] = &mut self.aims;
        for (j, given) in self.given.iter().enumerate() {
            let ahead = (&predictor[j], &local(given, &self.ahead, j));
            let aim = &mut corrector[j];
            cone::correct(given, &self.states[j], &self.factors[j], ahead, mu, aim);
            gather(&mut self.rhs, j, &aim.rhs);
        }
        let fixed = (!self.all_free).then_some(&self.fixed[..]);
        self.ahead[..=n].copy_from_slice(self.system.solve_again(fixed, &self.rhs));
        // No longer than Newton's step, and a little short of the boundary.
        let mut most = [1.0 / FRACTION; 2];
        for (j, given) in self.given.iter().enumerate() {
            let ahead = (&self.aims[1][j], &local(given, &self.ahead, j));
            cone::change(&self.states[j], &self.factors[j], ahead, mu, &mut self.changes[j]);
            most = cone::room(&self.states[j], &self.changes[j], most);
        }
        // A step that would end on the boundary, or just inside it, stops short of it: the inverses need the room.
        let step = most.map(|m| (FRACTION * m).min(1.0));
        self.sum = 0.0;
        for (state, change) in self.states.iter_mut().zip(&self.changes) {
            cone::advance(state, change, step);
            let mut gap = [0.0; W];
            cone::gap(state, &mut gap);
            self.sum += gap.iter().sum::<f64>();
        }
        self.length = step[0].min(step[1]);
        for (w, ahead) in self.w.iter_mut().zip(&self.ahead) {
            *w = [w[0] + step[1] * (ahead[0] - w[0]), w[1] + step[1] * (ahead[1] - w[1])];
        }
        step
    }

    /// Assemble the factors' blocks and the predictor's right-hand sides, eliminate, and solve for the point ahead.
    pub(super) fn eliminate(&mut self) {
        let (n, predictor) = (self.n, &self.aims[0]);
        let fixed = (!self.all_free).then_some(&self.fixed[..]);
        self.system.clear();
        let mut diagonal = [0.0; 3];
        let mut rhs = [0.0; 2];
        for (j, (f, aim)) in self.factors.iter().zip(predictor).enumerate() {
            let (k, r) = (&f.block, &aim.rhs);
            for l in 0..W.min(n - j * W) {
                let d = [diagonal[0] + k[0][l], diagonal[1] + k[1][l], diagonal[2] + k[4][l]];
                let c = [k[2][l], k[3][l], k[5][l], k[6][l]];
                let right = [rhs[0] + r[0][l], rhs[1] + r[1][l]];
                self.system.push(pair(fixed, j * W + l), d, c, right);
                diagonal = [k[7][l], k[8][l], k[9][l]];
                rhs = [r[2][l], r[3][l]];
            }
        }
        self.system.push(pair(fixed, n), diagonal, [0.0; 4], rhs);
        self.ahead[..=n].copy_from_slice(self.system.solve());
    }

    /// The barrier parameter: the mean of tr XZ over the cones' orders, every segment in its own unit.
    pub(super) fn mean(&self) -> f64 {
        self.sum / (5 * W * self.given.len()) as f64
    }

    /// Segments whose multipliers have far more mass than the barrier alone would give them.
    pub(super) fn active(&self) -> usize {
        let least = HELD * 5.0 * self.mean();
        let mut count = 0;
        for (state, given) in self.states.iter().zip(&self.given) {
            let held = |l: usize| cone::MEAN * state.y[2][l] > least;
            count += (0..W).filter(|&l| given.idle[l] == 0.0 && held(l)).count();
        }
        count
    }

    /// Put to `best` the primal point, moved towards the strictly feasible one just as far as makes it feasible without
    /// doubt. The share of the way; more than [`FAR`] where that would be too far. It is a continuous function of the
    /// point, up to rounding.
    pub(super) fn feasible(&mut self, data: &Data) -> f64 {
        let mut share = 0.0;
        for i in 0..self.n {
            // Where nothing is free nothing can be moved.
            if self.given[i / W].idle[i % W] != 0.0 {
                continue;
            }
            let (h, delta) = (data.h[i], data.delta[i]);
            let at =
                |share: f64| coefficients(h, delta, self.mix(i, share), self.mix(i + 1, share));
            let mut margin = 1e-15;
            while !certified_nonnegative(&at(share), 0.0) {
                // What is feasible at a share is feasible at every larger one: the least share of all grows from
                // segment to segment, by Newton's method on the least value, which is concave in the share.
                let order = self.order(i);
                let (t, value) = lowest(&without_zeros(&at(share), order));
                let inner = dot(&without_zeros(&at(1.0), order), &basis(t));
                let step = (1.0 - share) * (-value).max(0.0) / (inner - value);
                share += step * (1.0 + 1e-6) + margin;
                margin *= 4.0;
                if !(share <= FAR) {
                    return 1.0;
                }
            }
        }
        for i in 0..=self.n {
            self.best[i] = self.mix(i, share);
        }
        share
    }

    /// Node i of the point at this share of the way from the primal point to the strictly feasible one.
    #[inline]
    fn mix(&self, i: usize, share: f64) -> [f64; 2] {
        let (w, inside) = (self.w[i], self.inside[i]);
        [w[0] + share * (inside[0] - w[0]), w[1] + share * (inside[1] - w[1])]
    }

    /// How many of p's coefficients are fixed at 0 at either end of a segment.
    fn order(&self, i: usize) -> [usize; 2] {
        let (given, l) = (&self.given[i / W], i % W);
        let vanishes = |k: usize| usize::from(given.fixed[k][l] != 0.0);
        [vanishes(0) + vanishes(1), vanishes(2) + vanishes(3)]
    }

    /// The energy of `best`, its distance from the bound that moments y give, exactly, and the largest share that a
    /// segment has in it, relative to the geometric mean of its own energy weight and its unit:
    /// `E(b) − D(y) = Σ yᵢ·pᵢ(b) + ½‖b − v‖²` with v the unknowns that y implies.
    /// O(n).
    pub(super) fn certificate(&mut self) -> (f64, f64, f64) {
        self.rhs.fill([0.0; 2]);
        for (j, given) in self.given.iter().enumerate() {
            let mut r = [[0.0; W]; 4];
            cone::dual(given, &self.states[j], &mut r);
            gather(&mut self.rhs, j, &r);
        }
        let fixed = (!self.all_free).then_some(&self.fixed[..]);
        self.v[..=self.n].copy_from_slice(self.natural.solve_again(fixed, &self.rhs));
        let (mut energy, mut gap, mut worst) = (0.0, 0.0, 0.0f64);
        for (j, given) in self.given.iter().enumerate() {
            let (v, w) = (local(given, &self.v, j), local(given, &self.best, j));
            let (e, g) = cone::distance(given, &self.states[j], &v, &w);
            for l in 0..W {
                energy += given.unit[l] * e[l];
                gap += given.unit[l] * g[l];
                worst = worst.max(g[l] / given.e[l].max(LIGHT).sqrt());
            }
        }
        (energy, gap, worst)
    }
}
