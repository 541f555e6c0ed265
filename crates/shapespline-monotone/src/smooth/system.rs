// SPDX-License-Identifier: MIT OR Apache-2.0

//! Newton's system of the smoothing program, by orthogonal elimination from node to node.
//!
//! The Hessian is a sum of squares: `2w` on the values, the rows of [`Model`] on the intervals, and the stiffness of
//! constraints. Forming it would lose what intervals of width h say (`h⁻³` beside the weights), so its rows are
//! triangularised as they stand, as a square-root information filter does: what all before a node say of its slope
//! and value `(m, f)` are two rows `(a, b), (0, c)`; they are carried over an interval by writing the state before it in
//! the state behind it and two unknowns of the interval, which Householder reflections eliminate:
//! - one cubic: ε and κ, with `m = m' − κ`, `f = f' − ε − hm' + hκ/2`;
//! - with a level part: d and m itself, with `f = f' − d`;
//! - convex (σ = 1) or concave (−1): the arms a and b, with `m = m' − σ(a + b)`, `f = f' − hm' + σhb`.
//!
//! O(N), no square of a condition number. The stiff rows come first: by construction, or, of arms, by exchange.

use super::interval::{Form, Model};

/// The stiffness of what is held: its square root is far above all others, and its square is still a number.
pub(super) const HELD: f64 = 1e120;

/// Squares that no scaled quantity has, of slopes that are all but 0: their quotients would overflow.
const NEGLIGIBLE: f64 = 1e-280;

/// The sizes of things that must not be negative, in one vector: rises of the n intervals, slopes at the n + 1 nodes,
/// the distance of the first value from the lower bound and of the last from the upper; where convexity is asked
/// somewhere, two arms of every interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) n: usize,
    /// Whether there are arms.
    pub(super) bent: bool,
}

impl Layout {
    pub(super) fn len(self) -> usize {
        2 * self.n + 3 + if self.bent { 2 * self.n } else { 0 }
    }
    /// The slope at node i.
    pub(super) fn m(self, i: usize) -> usize {
        self.n + i
    }
    pub(super) fn low(self) -> usize {
        2 * self.n + 1
    }
    pub(super) fn high(self) -> usize {
        2 * self.n + 2
    }
    /// The arm at an end of interval i.
    pub(super) fn arm(self, i: usize, end: usize) -> usize {
        2 * self.n + 3 + 2 * i + end
    }
}

/// The triangular factor, and room for right-hand sides.
pub(super) struct System {
    layout: Layout,
    /// Of every interval: `1/r₀₀, r₀₁, 1/r₁₁`, then `r₀, r₁` in m' and in f'.
    rows: Vec<[f64; 7]>,
    /// Rows of the last node: a, b, c.
    end: [f64; 3],
    eliminated: Vec<[f64; 2]>,
}

/// The rows of an interval that is being eliminated: two unknowns of its own, then m' and f'.
type Rows = [[f64; 4]; 5];

impl System {
    pub(super) fn new(layout: Layout) -> Self {
        let n = layout.n;
        Self { layout, rows: vec![[0.0; 7]; n], end: [0.0; 3], eliminated: vec![[0.0; 2]; n] }
    }

    /// Factor the Hessian with twice the weights on values and a stiffness on every size.
    pub(super) fn factor(&mut self, h: &[f64], models: &[Model], twice: &[f64], stiff: &[f64]) {
        let layout = self.layout;
        let mut carry = [0.0; 3];
        let mut extra = 0.0;
        for i in 0..=layout.n {
            let mut on_value = twice[i];
            if i == 0 {
                on_value += stiff[layout.low()];
            }
            if i == layout.n {
                on_value += stiff[layout.high()];
            }
            add(&mut carry, stiff[layout.m(i)] + extra, on_value);
            if i < layout.n {
                let model = &models[i];
                if let Form::Bent(sense) = model.form {
                    let stiff = [0, 1].map(|end| stiff[layout.arm(i, end)]);
                    let mut rows = bent_rows(&carry, model, h[i], sense, stiff);
                    (self.rows[i], carry) = eliminate_sorted(&mut rows);
                    extra = 0.0;
                    continue;
                }
                let mut rows = interval_rows(&carry, model, h[i], stiff[i].sqrt());
                (self.rows[i], carry) = eliminate(&mut rows);
                let level = model.form == Form::Level;
                extra = if level { model.rows[4] * model.rows[4] } else { 0.0 };
            }
        }
        self.end = carry;
    }

    /// The step of all sizes for gradients: of the values, of the models, and of the sizes beside those.
    pub(super) fn solve(
        &mut self,
        h: &[f64],
        models: &[Model],
        values: &[f64],
        sizes: &[f64],
        step: &mut [f64],
    ) {
        let layout = self.layout;
        let (mut pm, mut pf) = (0.0, sizes[layout.low()]);
        for i in 0..layout.n {
            pm += sizes[layout.m(i)];
            pf += values[i];
            let [i00, r01, i11, r0m, r0f, r1m, r1f] = self.rows[i];
            let ([a, b, c], by, h) = (models[i].gradient, sizes[i], h[i]);
            let (g0, g1);
            match models[i].form {
                Form::Level => {
                    (g0, g1) = (a + by - pf, b + pm);
                    pm = c;
                }
                Form::Cubic => {
                    (g0, g1) = (a + by - pf, b - pm + 0.5 * h * (pf - by));
                    pm += h * (by - pf);
                }
                Form::Bent(sense) => {
                    let by = [0, 1].map(|end| sizes[layout.arm(i, end)]);
                    (g0, g1) = (a + by[0] - sense * pm, b + by[1] + sense * (h * pf - pm));
                    pm -= h * pf;
                }
            }
            let q0 = g0 * i00;
            let q1 = (g1 - r01 * q0) * i11;
            self.eliminated[i] = [q0, q1];
            pm -= r0m * q0 + r1m * q1;
            pf -= r0f * q0 + r1f * q1;
        }
        pm += sizes[layout.m(layout.n)];
        pf += values[layout.n] - sizes[layout.high()];
        let [a, b, c] = self.end;
        let z = -pm / a;
        let mut f = (-pf - b * z) / c / c;
        let mut m = (z - b * f) / a;
        step[layout.high()] = -f;
        step[layout.m(layout.n)] = m;
        for i in (0..layout.n).rev() {
            let [i00, r01, i11, r0m, r0f, r1m, r1f] = self.rows[i];
            let [q0, q1] = self.eliminated[i];
            let u1 = (-q1 - r1m * m - r1f * f) * i11;
            let u0 = (-q0 - r01 * u1 - r0m * m - r0f * f) * i00;
            let d;
            (d, m) = match models[i].form {
                Form::Level => (u0, u1),
                Form::Cubic => (u0 + h[i] * (m - 0.5 * u1), m - u1),
                Form::Bent(sense) => {
                    (step[layout.arm(i, 0)], step[layout.arm(i, 1)]) = (u0, u1);
                    (h[i] * (m - sense * u1), m - sense * (u0 + u1))
                }
            };
            f -= d;
            step[i] = d;
            step[layout.m(i)] = m;
        }
        step[layout.low()] = f;
    }

    /// The diagonal of the inverse Hessian at the values, from the last node to the first.
    pub(super) fn variances(&self, h: &[f64], models: &[Model]) -> Vec<f64> {
        let n = self.layout.n;
        let [a, b, c] = self.end;
        // Columns of a root of the covariance of (m, f); products of rows with themselves keep it positive.
        let (ia, ic) = (1.0 / a, 1.0 / c);
        let mixed = -b * ia * ic;
        let mut cov = [ia * ia + mixed * mixed, mixed * ic, ic * ic];
        let mut variances = vec![0.0; n + 1];
        variances[n] = cov[2];
        for i in (0..n).rev() {
            let [i00, r01, i11, r0m, r0f, r1m, r1f] = self.rows[i];
            // u = −G x' + K ξ with unit ξ.
            let g1 = [r1m * i11, r1f * i11];
            let g0 = [(r0m - r01 * g1[0]) * i00, (r0f - r01 * g1[1]) * i00];
            let (k1, k0) = ([0.0, i11], [i00, -r01 * i00 * i11]);
            // The state before in the one behind and ξ.
            let (mx, fx, mk, fk);
            match models[i].form {
                Form::Level => {
                    mx = [-g1[0], -g1[1]];
                    mk = k1;
                    fx = [g0[0], 1.0 + g0[1]];
                    fk = [-k0[0], -k0[1]];
                }
                Form::Cubic => {
                    let half = 0.5 * h[i];
                    mx = [1.0 + g1[0], g1[1]];
                    mk = [-k1[0], -k1[1]];
                    fx = [-h[i] + g0[0] - half * g1[0], 1.0 + g0[1] - half * g1[1]];
                    fk = [-k0[0] + half * k1[0], -k0[1] + half * k1[1]];
                }
                Form::Bent(sense) => {
                    let by = sense * h[i];
                    mx = [1.0 + sense * (g0[0] + g1[0]), sense * (g0[1] + g1[1])];
                    mk = [-sense * (k0[0] + k1[0]), -sense * (k0[1] + k1[1])];
                    fx = [-h[i] - by * g1[0], 1.0 - by * g1[1]];
                    fk = [by * k1[0], by * k1[1]];
                }
            }
            let form = |u: [f64; 2], v: [f64; 2]| {
                cov[0] * u[0] * v[0] + cov[1] * (u[0] * v[1] + u[1] * v[0]) + cov[2] * u[1] * v[1]
            };
            let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
            cov = [
                form(mx, mx) + dot(mk, mk),
                form(mx, fx) + dot(mk, fk),
                form(fx, fx) + dot(fk, fk),
            ];
            variances[i] = cov[2];
        }
        variances
    }
}

/// Rows `(√on_slope, 0)` and `(0, √on_value)` more.
#[inline(always)]
fn add(carry: &mut [f64; 3], on_slope: f64, on_value: f64) {
    let [a, b, c] = *carry;
    let mut left = 0.0;
    if on_slope > 0.0 {
        let size = (a * a + on_slope).sqrt();
        let cos = a / size;
        // Of b the share that the new row takes over: sin² = on_slope/size².
        (carry[0], carry[1], left) = (size, cos * b, b * b * (on_slope / size / size));
    }
    carry[2] = (c * c + left + on_value).sqrt();
}

#[inline(always)]
fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// What is known before an interval and what it adds itself, in its own unknowns and the state behind it.
#[inline(always)]
fn interval_rows(&[a, b, c]: &[f64; 3], model: &Model, h: f64, on_rise: f64) -> Rows {
    let r = model.rows;
    if model.form == Form::Level {
        return [
            [r[0], r[1], r[2], 0.0],
            [on_rise, 0.0, 0.0, 0.0],
            [-b, a, 0.0, b],
            [-c, 0.0, 0.0, c],
            [0.0, r[3], 0.0, 0.0],
        ];
    }
    let half = 0.5 * h;
    [
        [r[0], 0.0, 0.0, 0.0],
        [on_rise, -half * on_rise, h * on_rise, 0.0],
        [-b, half * b - a, a - h * b, b],
        [-c, half * c, -h * c, c],
        [0.0, r[1], 0.0, 0.0],
    ]
}

/// The same of an interval that is to be convex or concave, with stiffness of its arms.
fn bent_rows(&[a, b, c]: &[f64; 3], model: &Model, h: f64, sense: f64, stiff: [f64; 2]) -> Rows {
    let r = model.rows;
    let by = sense * h;
    [
        [r[0], r[1], 0.0, 0.0],
        [(r[2] * r[2] + stiff[0]).sqrt(), 0.0, 0.0, 0.0],
        [0.0, (r[3] * r[3] + stiff[1]).sqrt(), 0.0, 0.0],
        [-sense * a, b * by - sense * a, a - b * h, b],
        [0.0, c * by, -c * h, c],
    ]
}

/// As [`eliminate`], with the row of the largest entry first in every column.
fn eliminate_sorted(rows: &mut Rows) -> ([f64; 7], [f64; 3]) {
    for k in 0..3 {
        let largest = (k..5).max_by(|i, j| rows[*i][k].abs().total_cmp(&rows[*j][k].abs()));
        rows.swap(k, largest.unwrap_or(k));
        reflect(rows, k);
    }
    triangle(rows)
}

/// Householder reflections of the first three columns; the norm of what is left of the last.
#[inline(always)]
fn eliminate(rows: &mut Rows) -> ([f64; 7], [f64; 3]) {
    reflect(rows, 0);
    reflect(rows, 1);
    reflect(rows, 2);
    triangle(rows)
}

#[inline(always)]
fn triangle(rows: &Rows) -> ([f64; 7], [f64; 3]) {
    let c = hypot(rows[3][3], rows[4][3]);
    let [[r00, r01, r0m, r0f], [_, r11, r1m, r1f], [_, _, a, b], _, _] = *rows;
    ([1.0 / r00, r01, 1.0 / r11, r0m, r0f, r1m, r1f], [a, b, c])
}

/// Reflect the rows from k on so that in column k only row k is not 0.
#[inline(always)]
fn reflect(rows: &mut Rows, k: usize) {
    let below: f64 = (k + 1..5).map(|i| rows[i][k] * rows[i][k]).sum();
    if below < NEGLIGIBLE {
        for i in k + 1..5 {
            rows[i][k] = 0.0;
        }
        return;
    }
    let pivot = rows[k][k];
    let size = (pivot * pivot + below).sqrt();
    let to = if pivot > 0.0 { -size } else { size };
    let first = pivot - to;
    let scale = -1.0 / (to * first);
    for j in k + 1..4 {
        let dot: f64 =
            (k + 1..5).map(|i| rows[i][k] * rows[i][j]).sum::<f64>() + first * rows[k][j];
        let by = dot * scale;
        rows[k][j] -= by * first;
        for i in k + 1..5 {
            rows[i][j] -= by * rows[i][k];
        }
    }
    rows[k][k] = to;
    for i in k + 1..5 {
        rows[i][k] = 0.0;
    }
}
