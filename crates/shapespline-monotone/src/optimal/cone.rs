// SPDX-License-Identifier: MIT OR Apache-2.0

//! The cone of one segment and the linear algebra on it, four segments at a time.
//!
//! **Cone.** The derivative over the secant is `p = Σ pₖ tᵏ(1−t)⁴⁻ᵏ`. It is ≥ 0 on [0, 1] exactly when
//! `p = qᵀX₁q + t(1−t) rᵀX₂r` with `q = ((1−t)², t(1−t), t²)`, `r = (1−t, t)` and X₁, X₂ positive semidefinite
//! (Markov–Lukács; Karlin and Studden, *Tchebycheff Systems*, 1966, ch. II): every pₖ is a sum along an
//! antidiagonal. The multipliers yₖ = ℓ(tᵏ(1−t)⁴⁻ᵏ) are the moments of a functional ℓ that is non-negative on all
//! such p exactly when the Hankel matrices Z₁ = (yᵢ₊ⱼ) and Z₂ = (yᵢ₊ⱼ₊₁) are positive semidefinite.
//!
//! **Newton's system** (HKM direction; Helmberg, Rendl, Vanderbei, Wolkowicz, *SIAM J. Optim.* 6 (1996) 342–361;
//! Kojima, Shindoh, Hara, *ibid.* 7 (1997) 86–125; Monteiro, *ibid.* 663–678):
//! `dX = μZ⁻¹ − X − sym(X dZ Z⁻¹) − C`, where `C = sym(dX' dZ' Z⁻¹)` is Mehrotra's second-order term of the
//! predictor. Its moments are `p + dp = μg − M dy − c`, where M has the generating function
//! `Z₁⁻¹(s,t)X₁(s,t) + st·Z₂⁻¹(s,t)X₂(s,t)`: a product of polynomials instead of 25 traces.
//!
//! **Mean.** Σ wₖpₖ = 30 for all p that interpolate, w = (6, 3/2, 1, 3/2, 6). With `yₖ = nₖ + wₖ y₂` the middle
//! moment is eliminated in the segment; what is left is the 4×4 matrix R, and the segment adds `AᵀR⁻¹A` to the
//! system of the nodes.
//!
//! **Faces.** Where the slope is fixed at 0 (p₀ = 0), and at a flat the second derivative too (p₁ = 0), the first
//! rows of X₁ and X₂ vanish and the moments y₀, y₁ mean nothing. In this basis it is enough to give them values so
//! large ([`FIRST`], [`SECOND`]) that the inverses are those of the rest to the last bit.

use super::matrices::{
    definite, hankel, inverse, inverse4, longest, product, ratio, sums, symmetric, times4,
};

/// Segments of a chunk. Every loop over them is free of branches, so that it runs on vectors.
pub(super) const W: usize = 4;
pub(super) type Lane = [f64; W];

/// Multiplier of a value, and of a derivative, that is fixed at 0.
pub(super) const FIRST: f64 = 1e100;
pub(super) const SECOND: f64 = 1e30;

/// `Σ wₖpₖ` of a quartic of mean 1, and the weights but the middle one, which is 1.
pub(super) const MEAN: f64 = 30.0;
const OUTER: f64 = 6.0;
const INNER: f64 = 1.5;

/// [`energy::HESSIAN`](crate::energy::HESSIAN) over 35, its upper triangle row by row.
const ENERGY: [f64; 10] = [
    384.0 / 35.0,
    88.0 / 35.0,
    216.0 / 35.0,
    -32.0 / 35.0,
    96.0 / 35.0,
    32.0 / 35.0,
    16.0 / 35.0,
    384.0 / 35.0,
    -88.0 / 35.0,
    96.0 / 35.0,
];

/// What the data say of a chunk's segments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given {
    /// 1/Δ and h/(4Δ): from (d, s) to the dimensionless unknowns. 0 where nothing is free or no segment is.
    pub(super) a: Lane,
    pub(super) b: Lane,
    /// The unit of the segment's multipliers, in units of the largest energy weight; 0 where `a` is.
    pub(super) unit: Lane,
    /// The energy's weight in that unit: at most 1.
    pub(super) e: Lane,
    /// 1 where nothing is free or no segment is, to stand for the constant quartic; else 0.
    pub(super) idle: Lane,
    /// 1 where p₀, p₁, p₃, p₄ are fixed at 0.
    pub(super) fixed: [Lane; 4],
}

impl Given {
    pub(super) const IDLE: Self =
        Self { a: ZERO, b: ZERO, unit: ZERO, e: ZERO, idle: [1.0; W], fixed: [ZERO; 4] };
}

/// The iterate: moments in the segment's unit, and the two matrices' upper triangles (X₁: 00 01 02 11 12 22,
/// X₂: 00 01 11).
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    pub(super) y: [Lane; 5],
    pub(super) x: [Lane; 9],
}

/// What a step needs again and again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    /// Z₁⁻¹ and Z₂⁻¹.
    zi: [Lane; 9],
    /// The middle moment's column of M over its pivot, and the pivot's reciprocal.
    column: [Lane; 4],
    pivot: Lane,
    /// R⁻¹, upper triangle row by row.
    ri: [Lane; 10],
    /// The segment's part of the nodes' matrix, likewise.
    pub(super) block: [Lane; 10],
}

/// What a direction aims at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Aim {
    /// The moments' right-hand side less the unknowns' part; that of the middle moment.
    t: [Lane; 4],
    middle: Lane,
    /// Mehrotra's term.
    second: [Lane; 9],
    /// The segment's part of the nodes' right-hand side.
    pub(super) rhs: [Lane; 4],
}

const ZERO: Lane = [0.0; W];

impl State {
    pub(super) const NONE: Self = Self { y: [ZERO; 5], x: [ZERO; 9] };
}

impl Factors {
    pub(super) const EMPTY: Self =
        Self { zi: [ZERO; 9], column: [ZERO; 4], pivot: ZERO, ri: [ZERO; 10], block: [ZERO; 10] };
}

impl Aim {
    pub(super) const EMPTY: Self =
        Self { t: [ZERO; 4], middle: ZERO, second: [ZERO; 9], rhs: [ZERO; 4] };
}

/// [`ENERGY`]·(1, 0, 1, 0), its first two entries.
const LOAD: [f64; 2] = [600.0 / 35.0, 120.0 / 35.0];

#[inline(always)]
fn get<const N: usize>(from: &[Lane; N], l: usize) -> [f64; N] {
    std::array::from_fn(|k| from[k][l])
}

#[inline(always)]
fn put<const N: usize>(to: &mut [Lane; N], l: usize, value: [f64; N]) {
    for k in 0..N {
        to[k][l] = value[k];
    }
}

/// p₀, p₁, p₃, p₄ (or their changes) from the dimensionless unknowns.
#[inline(always)]
pub(super) fn outer(u: [f64; 4]) -> [f64; 4] {
    [u[0], 4.0 * (u[0] + u[1]), 4.0 * (u[2] - u[3]), u[2]]
}

/// The same map's transpose.
#[inline(always)]
fn force(f: [f64; 4]) -> [f64; 4] {
    let (l, r) = (4.0 * f[1], 4.0 * f[2]);
    [f[0] + l, l, r + f[3], -r]
}

/// The factors of a chunk, its part of the nodes' system, and the predictor's right-hand side (towards μ = 0).
#[inline(never)]
pub(super) fn factorise(given: &Given, state: &State, out: &mut Factors, aim: &mut Aim) {
    for l in 0..W {
        let (y, x) = (get(&state.y, l), get(&state.x, l));
        let zi = inverse(&y);
        let m = product(&zi, &x);
        let fixed = get(&given.fixed, l);
        let a0 = OUTER * (m[0] + m[4]) + (INNER * (m[1] + m[3]) + m[2]);
        let a1 = OUTER * (m[1] + m[8]) + (INNER * (m[5] + m[7]) + m[6]);
        let a2 = OUTER * (m[2] + m[11]) + (INNER * (m[6] + m[10]) + m[9]);
        let a3 = OUTER * (m[3] + m[13]) + (INNER * (m[7] + m[12]) + m[10]);
        let a4 = OUTER * (m[4] + m[14]) + (INNER * (m[8] + m[13]) + m[11]);
        let pivot = 1.0 / (OUTER * (a0 + a4) + (INNER * (a1 + a3) + a2));
        let c = [pivot * a0, pivot * a1, pivot * a3, pivot * a4];
        let r = inverse4(&[
            (m[0] - a0 * c[0]) + fixed[0],
            m[1] - a0 * c[1],
            m[3] - a0 * c[2],
            m[4] - a0 * c[3],
            (m[5] - a1 * c[1]) + fixed[1],
            m[7] - a1 * c[2],
            m[8] - a1 * c[3],
            (m[12] - a3 * c[2]) + fixed[2],
            m[13] - a3 * c[3],
            (m[14] - a4 * c[3]) + fixed[3],
        ]);
        let t = c.map(|c| MEAN * c);
        let (a, b, e, unit) = (given.a[l], given.b[l], given.e[l], given.unit[l]);
        // AᵀR⁻¹A in the dimensionless unknowns, and the energy.
        let (r01, r11, r03, r13) = (4.0 * r[1], 16.0 * r[4], 4.0 * r[2], 16.0 * r[5]);
        let (r14, r33, r34) = (4.0 * r[6], 16.0 * r[7], 4.0 * r[8]);
        let k = [
            (r[0] + r11) + 2.0 * r01,
            r01 + r11,
            (r03 + r[3]) + (r13 + r14),
            -(r03 + r13),
            r11,
            r13 + r14,
            -r13,
            (r33 + r[9]) + 2.0 * r34,
            -(r33 + r34),
            r33,
        ];
        let scale =
            [(a, a), (a, b), (a, a), (a, b), (b, b), (b, a), (b, b), (a, a), (a, b), (b, b)];
        let block =
            std::array::from_fn(|j| scale[j].0 * (scale[j].1 * (unit * (k[j] + e * ENERGY[j]))));
        put(&mut out.zi, l, zi);
        put(&mut out.column, l, c);
        out.pivot[l] = pivot;
        put(&mut out.ri, l, r);
        put(&mut out.block, l, block);
        put(&mut aim.t, l, t);
        aim.middle[l] = -MEAN * pivot;
        put(&mut aim.rhs, l, load(given, l, &y, times4(&r, t)));
    }
}

/// A segment's right-hand side: the moments with their change at u = 0, and the energy's constant part.
#[inline(always)]
fn load(given: &Given, l: usize, y: &[f64; 5], dn: [f64; 4]) -> [f64; 4] {
    let n = [y[0] - OUTER * y[2], y[1] - INNER * y[2], y[3] - INNER * y[2], y[4] - OUTER * y[2]];
    let f = force(std::array::from_fn(|k| n[k] + dn[k]));
    let (a, b, e) = (given.unit[l] * given.a[l], given.unit[l] * given.b[l], given.e[l]);
    [
        a * (f[0] + e * LOAD[0]),
        b * (f[1] + e * LOAD[1]),
        a * (f[2] + e * LOAD[0]),
        b * (f[3] - e * LOAD[1]),
    ]
}

/// The moments' change from the new unknowns.
#[inline(always)]
fn moments(f: &Factors, aim: &Aim, l: usize, u: [f64; 4]) -> [f64; 5] {
    let (t, p) = (get(&aim.t, l), outer(u));
    let n = times4(&get(&f.ri, l), std::array::from_fn(|k| t[k] - p[k]));
    let c = get(&f.column, l);
    let m = aim.middle[l] - ((c[0] * n[0] + c[3] * n[3]) + (c[1] * n[1] + c[2] * n[2]));
    [n[0] + OUTER * m, n[1] + INNER * m, m, n[2] + INNER * m, n[3] + OUTER * m]
}

/// Mehrotra's term of the predictor that ends at `u`, and the corrector's aim towards μ.
#[inline(never)]
pub(super) fn correct(
    given: &Given,
    state: &State,
    f: &Factors,
    (predictor, u): (&Aim, &[Lane; 4]),
    mu: f64,
    out: &mut Aim,
) {
    for l in 0..W {
        let dy = moments(f, predictor, l, get(u, l));
        let (x, zi) = (get(&state.x, l), get(&f.zi, l));
        let g = ratio(&dy, &zi);
        let s = symmetric(&x, &g);
        let second = symmetric(&std::array::from_fn(|k| -(x[k] + s[k])), &g);
        let p = sums(&std::array::from_fn(|k| mu * zi[k] - second[k]));
        let c = get(&f.column, l);
        let rest = (OUTER * (p[0] + p[4]) + (INNER * (p[1] + p[3]) + p[2])) - MEAN;
        let t = [p[0] - c[0] * rest, p[1] - c[1] * rest, p[3] - c[2] * rest, p[4] - c[3] * rest];
        let dn = times4(&get(&f.ri, l), t);
        put(&mut out.second, l, second);
        put(&mut out.t, l, t);
        out.middle[l] = rest * f.pivot[l];
        put(&mut out.rhs, l, load(given, l, &get(&state.y, l), dn));
    }
}

/// The change of moments and matrices for the corrected direction that ends at `u`.
#[inline(never)]
pub(super) fn change(
    state: &State,
    f: &Factors,
    (aim, u): (&Aim, &[Lane; 4]),
    mu: f64,
    out: &mut State,
) {
    for l in 0..W {
        let dy = moments(f, aim, l, get(u, l));
        let (x, zi) = (get(&state.x, l), get(&f.zi, l));
        let s = symmetric(&x, &ratio(&dy, &zi));
        let second = get(&aim.second, l);
        put(&mut out.y, l, dy);
        put(&mut out.x, l, std::array::from_fn(|k| (mu * zi[k] - x[k]) - (s[k] + second[k])));
    }
}

/// The largest steps, at most the given ones, that leave moments and matrices of the chunk positive definite.
#[inline]
pub(super) fn room(state: &State, change: &State, mut most: [f64; 2]) -> [f64; 2] {
    let mut worst = [ZERO; 2];
    within(state, change, most, &mut worst);
    for l in 0..W {
        if !(worst[0][l] > 0.0) {
            let (from, by) = (hankel(&get(&state.y, l)), hankel(&get(&change.y, l)));
            most[0] = longest(&from, &by, most[0]);
        }
        if !(worst[1][l] > 0.0) {
            most[1] = longest(&get(&state.x, l), &get(&change.x, l), most[1]);
        }
    }
    most
}

#[inline(never)]
fn within(state: &State, change: &State, most: [f64; 2], out: &mut [Lane; 2]) {
    for l in 0..W {
        let (y, dy) = (get(&state.y, l), get(&change.y, l));
        let (x, dx) = (get(&state.x, l), get(&change.x, l));
        out[0][l] = definite(&hankel(&std::array::from_fn(|k| y[k] + most[0] * dy[k])));
        out[1][l] = definite(&std::array::from_fn(|k| x[k] + most[1] * dx[k]));
    }
}

/// Go the two steps.
#[inline(never)]
pub(super) fn advance(state: &mut State, change: &State, step: [f64; 2]) {
    for (y, dy) in state.y.as_flattened_mut().iter_mut().zip(change.y.as_flattened()) {
        *y += step[0] * dy;
    }
    for (x, dx) in state.x.as_flattened_mut().iter_mut().zip(change.x.as_flattened()) {
        *x += step[1] * dx;
    }
}

/// tr XZ of every segment.
#[inline(never)]
pub(super) fn gap(state: &State, out: &mut Lane) {
    for l in 0..W {
        let (y, p) = (get(&state.y, l), sums(&get(&state.x, l)));
        out[l] = (y[0] * p[0] + y[4] * p[4]) + ((y[1] * p[1] + y[3] * p[3]) + y[2] * p[2]);
    }
}

/// Multipliers of uniform density and the given mass, and the matrices in the centre opposite them.
pub(super) fn start(given: &Given, mass: f64) -> State {
    let mut state = State::NONE;
    for l in 0..W {
        let fixed = get(&given.fixed, l);
        let mut y = [0.2 * mass, 0.05 * mass, mass / MEAN, 0.05 * mass, 0.2 * mass];
        for (k, j, value) in [(0, 0, FIRST), (1, 1, SECOND), (2, 3, SECOND), (3, 4, FIRST)] {
            if fixed[k] != 0.0 {
                y[j] = value;
            }
        }
        let zi = inverse(&y);
        let p = sums(&zi);
        let mu = MEAN / (OUTER * (p[0] + p[4]) + (INNER * (p[1] + p[3]) + p[2]));
        let x = zi.map(|z| mu * z);
        put(&mut state.y, l, y);
        put(&mut state.x, l, x);
    }
    state
}

/// `½uᵀKu`, K as [`ENERGY`].
#[inline(always)]
fn quadratic(u: [f64; 4]) -> f64 {
    const K: [f64; 10] = ENERGY;
    u[0] * (0.5 * K[0] * u[0] + (K[1] * u[1] + (K[2] * u[2] + K[3] * u[3])))
        + u[1] * (0.5 * K[4] * u[1] + (K[5] * u[2] + K[6] * u[3]))
        + u[2] * (0.5 * K[7] * u[2] + K[8] * u[3])
        + 0.5 * K[9] * (u[3] * u[3])
}

/// The right-hand side of the dual point: `Σ Aᵀn` and the energy's constant part.
#[inline(never)]
pub(super) fn dual(given: &Given, state: &State, out: &mut [Lane; 4]) {
    for l in 0..W {
        put(out, l, load(given, l, &get(&state.y, l), [0.0; 4]));
    }
}

/// The energy at `w`, and the segment's part of its distance from the bound at `u`, in the segment's unit.
pub(super) fn distance(given: &Given, state: &State, u: &[Lane; 4], w: &[Lane; 4]) -> (Lane, Lane) {
    let (mut energy, mut gap) = (ZERO, ZERO);
    for l in 0..W {
        let (y, u, w) = (get(&state.y, l), get(u, l), get(w, l));
        let p = outer(w);
        let middle = MEAN - (OUTER * (p[0] + p[3]) + INNER * (p[1] + p[2]));
        let product = ((y[0] * p[0] + y[4] * p[3]) + (y[1] * p[1] + y[3] * p[2])) + y[2] * middle;
        let e = given.e[l];
        energy[l] = e * quadratic([w[0] - 1.0, w[1], w[2] - 1.0, w[3]]);
        let away: [f64; 4] = std::array::from_fn(|k| w[k] - u[k]);
        gap[l] = (1.0 - given.idle[l]) * product + e * quadratic(away);
    }
    (energy, gap)
}
