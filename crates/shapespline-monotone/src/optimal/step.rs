//! The iteration's working memory and one step of it.

use super::cone::{self, Aim, Factors, Given, Lane, State, W};
use crate::data::Data;
use crate::energy::{self, Fairness, HESSIAN, is_flat};
use shapespline_banded::block_tridiagonal::BlockElimination;

/// Share of the way to the boundary that a step may go.
const FRACTION: f64 = 0.98;
/// What a step aims at, in units of the current barrier parameter.
const AIM: f64 = 0.08;
/// After a step shorter than this (the iterate has lost the centre) the next one aims at [`CENTRE`] instead: without,
/// one fit in a thousand over twelve decades does not end.
const SHORT: f64 = 0.3;
const CENTRE: f64 = 0.8;
/// Shares of the way to the strictly feasible point that are tried when the primal point is not feasible.
const SHARES: [f64; 8] = [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 5e-3, 2e-2];
/// Mass of a segment's multipliers, in units of the mean of tr XZ, from which on it counts as held at 0 somewhere.
const HELD: f64 = 10.0;
/// Energy weights below this share of the largest count as this: no unknown may lose its energy altogether.
const LEAST: f64 = 1e-290;

/// Working memory: kept from fit to fit, so that a fit allocates nothing but its result.
#[derive(Default)]
pub(super) struct Problem {
    /// Segments and nodes.
    pub(super) n: usize,
    pub(super) given: Vec<Given>,
    pub(super) states: Vec<State>,
    factors: Vec<Factors>,
    /// The predictor's aims and the corrector's.
    aims: [Vec<Aim>; 2],
    changes: Vec<State>,
    /// What is free at the nodes, and whether everything is.
    free: Vec<(bool, bool)>,
    all_free: bool,
    /// The dual point: the unknowns that the multipliers imply.
    pub(super) v: Vec<[f64; 2]>,
    /// A strictly feasible point, the primal point, and one between the two.
    pub(super) inside: Vec<[f64; 2]>,
    w: Vec<[f64; 2]>,
    pub(super) best: Vec<[f64; 2]>,
    /// The shorter length of the last step.
    length: f64,
    /// tr XZ of all, and of the segments that count.
    sum: f64,
    pub(super) gap: f64,
    /// The point that Newton's step ends at.
    ahead: Vec<[f64; 2]>,
    rhs: Vec<[f64; 2]>,
    /// The energy's own Hessian, eliminated.
    natural: BlockElimination,
    system: BlockElimination,
    /// The largest energy weight.
    pub(super) scale: f64,
}

impl Problem {
    /// Set up.
    pub(super) fn pose(&mut self, data: &Data, fairness: Fairness) {
        let n = data.len();
        let chunks = n.div_ceil(W);
        self.n = n;
        self.free.clear();
        self.free.extend((0..=n).map(|i| super::free(&data.delta, i)));
        self.all_free = self.free.iter().all(|f| f.0 && f.1);
        self.scale = largest(data, fairness);
        self.given.clear();
        self.given.extend((0..chunks).map(|j| {
            let mut given = Given {
                a: [0.0; W],
                b: [0.0; W],
                e: [0.0; W],
                idle: [1.0; W],
                fixed: [[0.0; W]; 4],
            };
            for l in 0..W.min(n - j * W) {
                let i = j * W + l;
                let (p, q) = (self.free[i], self.free[i + 1]);
                if is_flat(data.delta[i]) || !(p.1 || q.1) {
                    continue;
                }
                (given.a[l], given.b[l], given.e[l]) = units(data, fairness, self.scale, i);
                given.idle[l] = 0.0;
                for (k, free) in [p.0, p.1, q.1, q.0].into_iter().enumerate() {
                    given.fixed[k][l] = f64::from(u8::from(!free));
                }
            }
            given
        }));
        for list in [
            &mut self.v,
            &mut self.inside,
            &mut self.w,
            &mut self.best,
            &mut self.ahead,
            &mut self.rhs,
        ] {
            list.clear();
            list.resize(chunks * W + 1, [0.0; 2]);
        }
    }

    /// The energy's own minimiser, its elimination kept.
    pub(super) fn unconstrained(&mut self, data: &Data, fairness: Fairness) -> &[[f64; 2]] {
        natural(&mut self.natural, data, fairness, self.scale)
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
        let [predictor, corrector] = &mut self.aims;
        let free = (!self.all_free).then_some(&self.free[..]);
        for (j, given) in self.given.iter().enumerate() {
            cone::factorise(given, &self.states[j], &mut self.factors[j], &mut predictor[j]);
        }
        let aim = if self.length < SHORT { CENTRE } else { AIM };
        let mu = aim * self.sum / (5 * W * self.given.len()) as f64;
        let mut system = std::mem::take(&mut self.system);
        system.clear();
        let mut diagonal = [0.0; 3];
        let mut rhs = [0.0; 2];
        for (j, (f, aim)) in self.factors.iter().zip(&*predictor).enumerate() {
            let (k, r) = (&f.block, &aim.rhs);
            for l in 0..W.min(n - j * W) {
                let d = [diagonal[0] + k[0][l], diagonal[1] + k[1][l], diagonal[2] + k[4][l]];
                let c = [k[2][l], k[3][l], k[5][l], k[6][l]];
                let right = [rhs[0] + r[0][l], rhs[1] + r[1][l]];
                let (d, c, right) = pinned(pins(free, j * W + l), d, c, right);
                system.push(d, c, right);
                diagonal = [k[7][l], k[8][l], k[9][l]];
                rhs = [r[2][l], r[3][l]];
            }
        }
        let (d, c, right) = pinned(pins(free, n), diagonal, [0.0; 4], rhs);
        system.push(d, c, right);
        self.ahead[..=n].copy_from_slice(system.solve());
        self.rhs.fill([0.0; 2]);
        for (j, given) in self.given.iter().enumerate() {
            let ahead = (&predictor[j], &local(given, &self.ahead, j));
            let aim = &mut corrector[j];
            cone::correct(given, &self.states[j], &self.factors[j], ahead, mu, aim);
            gather(&mut self.rhs, j, &aim.rhs);
        }
        self.mask();
        self.ahead[..=n].copy_from_slice(system.solve_again(|i| self.rhs[i]));
        self.system = system;
        // No longer than Newton's step, and a little short of the boundary.
        let mut most = [1.0 / FRACTION; 2];
        for (j, given) in self.given.iter().enumerate() {
            let ahead = (&self.aims[1][j], &local(given, &self.ahead, j));
            cone::change(&self.states[j], &self.factors[j], ahead, mu, &mut self.changes[j]);
            most = cone::room(&self.states[j], &self.changes[j], most);
        }
        // A step that would end on the boundary, or just inside it, stops short of it: the inverses need the room.
        let step = most.map(|m| (FRACTION * m).min(1.0));
        (self.sum, self.gap) = (0.0, 0.0);
        for ((state, change), given) in self.states.iter_mut().zip(&self.changes).zip(&self.given) {
            cone::advance(state, change, step);
            let mut gap = [0.0; W];
            cone::gap(state, &mut gap);
            for l in 0..W {
                self.sum += gap[l];
                self.gap += (1.0 - given.idle[l]) * gap[l];
            }
        }
        self.length = step[0].min(step[1]);
        for (w, ahead) in self.w.iter_mut().zip(&self.ahead) {
            *w = [w[0] + step[1] * (ahead[0] - w[0]), w[1] + step[1] * (ahead[1] - w[1])];
        }
        step
    }

    /// Nothing acts on what is fixed.
    fn mask(&mut self) {
        if !self.all_free {
            for (r, free) in self.rhs.iter_mut().zip(&self.free) {
                *r = [if free.0 { r[0] } else { 0.0 }, if free.1 { r[1] } else { 0.0 }];
            }
        }
    }

    /// The primal point's energy.
    pub(super) fn energy(&self) -> f64 {
        let mut sum = 0.0;
        for (j, given) in self.given.iter().enumerate() {
            let w = local(given, &self.w, j);
            sum += cone::distance(given, &self.states[j], &w, &w).0.iter().sum::<f64>();
        }
        sum
    }

    /// Segments whose multipliers have far more mass than the barrier alone would give them.
    pub(super) fn active(&self) -> usize {
        let least = HELD * self.sum / (W * self.given.len()) as f64;
        let mut count = 0;
        for (state, given) in self.states.iter().zip(&self.given) {
            let held = |l: usize| cone::MEAN * state.y[2][l] > least;
            count += (0..W).filter(|&l| given.idle[l] == 0.0 && held(l)).count();
        }
        count
    }

    /// Put to `best` the primal point, or one between it and the strictly feasible one, that is feasible without
    /// doubt. None when only points far from it are.
    pub(super) fn feasible(&mut self, data: &Data) -> bool {
        for share in SHARES {
            for ((b, w), i) in self.best.iter_mut().zip(&self.w).zip(&self.inside) {
                *b = [w[0] + share * (i[0] - w[0]), w[1] + share * (i[1] - w[1])];
            }
            if super::certified(data, &self.best) {
                return true;
            }
        }
        false
    }

    /// The energy of `best` and its distance from the bound that the multipliers give, exactly:
    /// `E(b) − D(y) = Σ yᵢ·pᵢ(b) + ½‖b − v‖²` with v the unknowns that y implies. O(n).
    pub(super) fn certificate(&mut self) -> (f64, f64) {
        self.rhs.fill([0.0; 2]);
        for (j, given) in self.given.iter().enumerate() {
            let mut r = [[0.0; W]; 4];
            cone::dual(given, &self.states[j], &mut r);
            gather(&mut self.rhs, j, &r);
        }
        self.mask();
        self.v[..=self.n].copy_from_slice(self.natural.solve_again(|i| self.rhs[i]));
        let (mut energy, mut gap) = (0.0, 0.0);
        for (j, given) in self.given.iter().enumerate() {
            let (v, w) = (local(given, &self.v, j), local(given, &self.best, j));
            let (e, g) = cone::distance(given, &self.states[j], &v, &w);
            energy += e.iter().sum::<f64>();
            gap += g.iter().sum::<f64>();
        }
        (energy, gap)
    }
}

/// Add a chunk's right-hand side, chunk after chunk.
#[inline]
fn gather(rhs: &mut [[f64; 2]], j: usize, r: &[Lane; 4]) {
    for l in 0..W {
        let i = j * W + l;
        rhs[i] = [rhs[i][0] + r[0][l], rhs[i][1] + r[1][l]];
        rhs[i + 1] = [r[2][l], r[3][l]];
    }
}

/// The largest energy weight.
pub(super) fn largest(data: &Data, fairness: Fairness) -> f64 {
    let segments = data.h.iter().zip(&data.delta).filter(|(_, delta)| !is_flat(**delta));
    segments.fold(0.0, |most, (h, delta)| most.max(energy::weight(fairness, *h, *delta)))
}

/// 1/Δ and h/(4Δ), which make d and s dimensionless, and the energy's weight in units of the largest.
#[inline]
fn units(data: &Data, fairness: Fairness, scale: f64, i: usize) -> (f64, f64, f64) {
    let (h, delta) = (data.h[i], data.delta[i]);
    if is_flat(delta) {
        return (0.0, 0.0, 0.0);
    }
    let a = 1.0 / delta;
    (a, 0.25 * h * a, (energy::weight(fairness, h, delta) / scale).max(LEAST))
}

/// The energy's own minimiser. O(n).
pub(super) fn natural<'a>(
    system: &'a mut BlockElimination,
    data: &Data,
    fairness: Fairness,
    scale: f64,
) -> &'a [[f64; 2]] {
    let n = data.len();
    system.clear();
    let mut diagonal = [0.0; 3];
    let mut rhs = [0.0; 2];
    let mut own = super::free(&data.delta, 0);
    for i in 0..=n {
        let mut right = ([0.0; 3], [0.0; 4], [0.0; 2], (false, false));
        if i < n {
            let (a, b, e) = units(data, fairness, scale, i);
            let e = e / 35.0;
            let k = |p: usize, q: usize| e * HESSIAN[p][q];
            let load = |p: usize| k(p, 0) + k(p, 2);
            diagonal[0] += a * (a * k(0, 0));
            diagonal[1] += a * (b * k(0, 1));
            diagonal[2] += b * (b * k(1, 1));
            rhs[0] += a * load(0);
            rhs[1] += b * load(1);
            right = (
                [a * (a * k(2, 2)), a * (b * k(2, 3)), b * (b * k(3, 3))],
                [a * (a * k(0, 2)), a * (b * k(0, 3)), b * (a * k(1, 2)), b * (b * k(1, 3))],
                [a * load(2), b * load(3)],
                super::free(&data.delta, i + 1),
            );
        }
        let (d, c, r) = pinned(Some([own, right.3]), diagonal, right.1, rhs);
        system.push(d, c, r);
        (diagonal, rhs, own) = (right.0, right.2, right.3);
    }
    system.solve()
}

/// The unknowns of a chunk's segments without dimension.
#[inline]
fn local(given: &Given, v: &[[f64; 2]], j: usize) -> [Lane; 4] {
    let mut u = [[0.0; W]; 4];
    let v: &[[f64; 2]] = &v[j * W..=j * W + W];
    for l in 0..W {
        let (a, b, idle) = (given.a[l], given.b[l], given.idle[l]);
        u[0][l] = a * v[l][0] + idle;
        u[1][l] = b * v[l][1];
        u[2][l] = a * v[l + 1][0] + idle;
        u[3][l] = b * v[l + 1][1];
    }
    u
}

/// What is free at a node and the next; None when everything is.
#[inline]
fn pins(free: Option<&[(bool, bool)]>, i: usize) -> Option<[(bool, bool); 2]> {
    free.map(|free| [free[i], free.get(i + 1).copied().unwrap_or_default()])
}

/// A row of the system with the fixed unknowns' rows made the identity, their right-hand sides 0.
#[inline]
fn pinned(
    free: Option<[(bool, bool); 2]>,
    mut d: [f64; 3],
    mut c: [f64; 4],
    mut r: [f64; 2],
) -> ([f64; 3], [f64; 4], [f64; 2]) {
    let Some([own, next]) = free else { return (d, c, r) };
    if !own.0 {
        (d[0], d[1], r[0]) = (1.0, 0.0, 0.0);
        (c[0], c[1]) = (0.0, 0.0);
    }
    if !own.1 {
        (d[2], d[1], r[1]) = (1.0, 0.0, 0.0);
        (c[2], c[3]) = (0.0, 0.0);
    }
    if !next.0 {
        (c[0], c[2]) = (0.0, 0.0);
    }
    if !next.1 {
        (c[1], c[3]) = (0.0, 0.0);
    }
    (d, c, r)
}
