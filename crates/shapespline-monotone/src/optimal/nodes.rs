// SPDX-License-Identifier: MIT OR Apache-2.0

//! What is fixed at the nodes, and the block-tridiagonal system of what is free.

use super::cone::{Given, Lane, W};
use crate::data::Data;
use crate::energy::{self, Fairness, HESSIAN, is_flat};
use crate::slopes::sign;
use shapespline_banded::block_tridiagonal::BlockElimination;

/// Energy weights below this share of the largest count as this: no unknown may lose its energy altogether.
const LEAST: f64 = 1e-290;

/// Slope and second derivative of a node where they are fixed, NaN where they are free.
pub(crate) type Fixed = [f64; 2];

/// What the data fix at a node: everything at a flat, the slope at a turn.
#[inline]
pub(crate) fn fixed_by_data(delta: &[f64], i: usize) -> Fixed {
    let (l, r) = (delta[i.max(1) - 1], delta[i.min(delta.len() - 1)]);
    if is_flat(l) || is_flat(r) {
        [0.0, 0.0]
    } else if sign(l) == sign(r) {
        [f64::NAN, f64::NAN]
    } else {
        [0.0, f64::NAN]
    }
}

/// A block-tridiagonal system in which some unknowns are fixed: their rows become the identity, and what they
/// contribute to the other rows moves to the right-hand side.
#[derive(Default)]
pub(super) struct NodeSystem {
    elimination: BlockElimination,
    /// What the fixed unknowns contribute to the rows, up to the last one that they contribute to.
    shift: Vec<[f64; 2]>,
    carry: [f64; 2],
    rows: usize,
}

impl NodeSystem {
    pub(super) fn with_capacity(nodes: usize) -> Self {
        Self { elimination: BlockElimination::with_capacity(nodes), ..Self::default() }
    }

    pub(super) fn clear(&mut self) {
        self.elimination.clear();
        self.shift.clear();
        self.carry = [0.0; 2];
        self.rows = 0;
    }

    /// Append a node, as [`BlockElimination::push`]; `fixed` at it and the next, or None where all is free.
    #[inline]
    pub(super) fn push(
        &mut self,
        fixed: Option<[Fixed; 2]>,
        mut d: [f64; 3],
        mut c: [f64; 4],
        mut r: [f64; 2],
    ) {
        let Some([own, next]) = fixed else {
            self.elimination.push(d, c, r);
            return;
        };
        let value = |f: f64| if f.is_nan() { 0.0 } else { f };
        let (v, n) = (own.map(value), next.map(value));
        let shift = [
            self.carry[0] + d[1] * v[1] + (c[0] * n[0] + c[1] * n[1]),
            self.carry[1] + d[1] * v[0] + (c[2] * n[0] + c[3] * n[1]),
        ];
        self.carry = [c[0] * v[0] + c[2] * v[1], c[1] * v[0] + c[3] * v[1]];
        if shift != [0.0; 2] {
            self.shift.resize(self.rows, [0.0; 2]);
            self.shift.push(shift);
        }
        self.rows += 1;
        r = [r[0] - shift[0], r[1] - shift[1]];
        if !own[0].is_nan() {
            (d[0], d[1], r[0]) = (1.0, 0.0, own[0]);
            (c[0], c[1]) = (0.0, 0.0);
        }
        if !own[1].is_nan() {
            (d[2], d[1], r[1]) = (1.0, 0.0, own[1]);
            (c[2], c[3]) = (0.0, 0.0);
        }
        if !next[0].is_nan() {
            (c[0], c[2]) = (0.0, 0.0);
        }
        if !next[1].is_nan() {
            (c[1], c[3]) = (0.0, 0.0);
        }
        self.elimination.push(d, c, r);
    }

    /// The solution of the system pushed so far.
    pub(super) fn solve(&mut self) -> &[[f64; 2]] {
        self.elimination.solve()
    }

    /// The solution for another right-hand side; `fixed` as when the system was pushed.
    pub(super) fn solve_again(&mut self, fixed: Option<&[Fixed]>, rhs: &[[f64; 2]]) -> &[[f64; 2]] {
        let Some(fixed) = fixed else {
            return self.elimination.solve_again(|i| rhs[i]);
        };
        let shift = &self.shift;
        self.elimination.solve_again(|i| {
            let shift = shift.get(i).copied().unwrap_or_default();
            let of = |k: usize| {
                if fixed[i][k].is_nan() { rhs[i][k] - shift[k] } else { fixed[i][k] }
            };
            [of(0), of(1)]
        })
    }
}

/// What is fixed at a node and the next; None when nothing is.
#[inline]
pub(super) fn pair(fixed: Option<&[Fixed]>, i: usize) -> Option<[Fixed; 2]> {
    fixed.map(|fixed| [fixed[i], fixed.get(i + 1).copied().unwrap_or([f64::NAN; 2])])
}

/// The largest energy weight.
pub(super) fn largest(data: &Data, fairness: Fairness) -> f64 {
    let segments = data.h.iter().zip(&data.delta).filter(|(_, delta)| !is_flat(**delta));
    segments.fold(0.0, |most, (h, delta)| most.max(energy::weight(fairness, *h, *delta)))
}

/// 1/Δ and h/(4Δ), which make d and s dimensionless, and the energy's weight in units of the largest.
#[inline]
pub(super) fn units(data: &Data, fairness: Fairness, scale: f64, i: usize) -> (f64, f64, f64) {
    let (h, delta) = (data.h[i], data.delta[i]);
    if is_flat(delta) {
        return (0.0, 0.0, 0.0);
    }
    let a = 1.0 / delta;
    (a, 0.25 * h * a, (energy::weight(fairness, h, delta) / scale).max(LEAST))
}

/// The energy's own minimiser with `fixed(i)` at node i. O(n).
pub(super) fn natural<'a>(
    system: &'a mut NodeSystem,
    data: &Data,
    fairness: Fairness,
    scale: f64,
    fixed: impl Fn(usize) -> Fixed,
) -> &'a [[f64; 2]] {
    let n = data.len();
    system.clear();
    let mut diagonal = [0.0; 3];
    let mut rhs = [0.0; 2];
    let mut own = fixed(0);
    for i in 0..=n {
        let mut right = ([0.0; 3], [0.0; 4], [0.0; 2], [f64::NAN; 2]);
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
                fixed(i + 1),
            );
        }
        system.push(Some([own, right.3]), diagonal, right.1, rhs);
        (diagonal, rhs, own) = (right.0, right.2, right.3);
    }
    system.solve()
}

/// The unknowns of a chunk's segments without dimension.
#[inline]
pub(super) fn local(given: &Given, v: &[[f64; 2]], j: usize) -> [Lane; 4] {
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

/// Add a chunk's right-hand side, chunk after chunk.
#[inline]
pub(super) fn gather(rhs: &mut [[f64; 2]], j: usize, r: &[Lane; 4]) {
    for l in 0..W {
        let i = j * W + l;
        rhs[i] = [rhs[i][0] + r[0][l], rhs[i][1] + r[1][l]];
        rhs[i + 1] = [r[2][l], r[3][l]];
    }
}
