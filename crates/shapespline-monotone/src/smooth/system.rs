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
//! O(N), no square of a condition number. The chains that do this start from both ends. The stiff rows come first: by construction, or, of arms, by exchange.

use super::interval::{Form, Model};
use super::rows::{add, bent_rows, eliminate, eliminate_sorted, interval_rows, met};
use shapespline_polynomial::parallel;

/// The stiffness of what is held: its square root is far above all others, and its square is still a number.
pub(super) const HELD: f64 = 1e120;

/// Intervals of a chain that are worth a thread of its own: some 50 ns each.
const LONG: usize = 8192;

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
///
/// Elimination starts from both ends, whose chains meet in the middle: every step waits for the one before it, and a
/// processor does those of the two chains at the same time. From the right the function is seen as its reflection
/// `−f(−x)`, which increases and has the same rises and slopes.
pub(super) struct System {
    layout: Layout,
    /// The node where the chains meet.
    middle: usize,
    /// Of every interval: `1/r₀₀, r₀₁, 1/r₁₁`, then `r₀, r₁` in m' and in f'.
    rows: Vec<[f64; 7]>,
    /// Rows of the node in the middle: a, b, c.
    end: [f64; 3],
    found: Vec<IntervalSteps>,
}

/// What is found of an interval's own two unknowns: first its gradient, then their steps, with those of its rise and of the
/// slope before it.
#[derive(Debug, Clone, Copy, Default)]
struct IntervalSteps {
    own: [f64; 2],
    rise: f64,
    slope: f64,
}

/// What a chain has come to: rows of the state at its node, and what the interval before adds on the slope there.
#[derive(Default)]
struct Carry {
    rows: [f64; 3],
    extra: f64,
}

impl System {
    pub(super) fn new(layout: Layout) -> Self {
        let n = layout.n;
        let (rows, found) = (vec![[0.0; 7]; n], vec![IntervalSteps::default(); n]);
        Self { layout, middle: 0, rows, end: [0.0; 3], found }
    }

    /// Factor the Hessian with twice the weights on values and a stiffness on every size.
    pub(super) fn factor(&mut self, h: &[f64], models: &[Model], twice: &[f64], stiff: &[f64]) {
        let (layout, n) = (self.layout, self.layout.n);
        // What holds the last value has a right-hand side, which would swallow all digits behind it.
        self.middle = if stiff[layout.high()] >= HELD { n } else { n / 2 };
        let on = |i: usize| {
            let mut on_value = twice[i];
            if i == 0 {
                on_value += stiff[layout.low()];
            }
            if i == n {
                on_value += stiff[layout.high()];
            }
            [stiff[layout.m(i)], on_value]
        };
        let on_arms = |i: usize, from: usize| match models[i].form {
            Form::Bent(_) => [stiff[layout.arm(i, from)], stiff[layout.arm(i, 1 - from)]],
            _ => [0.0; 2],
        };
        let (mut left, mut right) = (Carry::default(), Carry::default());
        let counts = [self.middle, n - self.middle];
        let (rows, behind) = self.rows.split_at_mut(self.middle);
        both(
            counts,
            |k| rows[k] = left.over(&models[k], h[k], on(k), stiff[k], on_arms(k, 0)),
            |k| {
                let (i, model) = (n - 1 - k, models[n - 1 - k].reflected());
                behind[counts[1] - 1 - k] =
                    right.over(&model, h[i], on(i + 1), stiff[i], on_arms(i, 1));
            },
        );
        let [on_slope, on_value] = on(self.middle);
        add(&mut left.rows, on_slope + left.extra + right.extra, on_value);
        self.end = met(left.rows, right.rows);
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
        let (layout, n, middle) = (self.layout, self.layout.n, self.middle);
        let on = |i: usize| {
            let mut on_value = values[i];
            if i == 0 {
                on_value += sizes[layout.low()];
            }
            if i == n {
                on_value -= sizes[layout.high()];
            }
            [sizes[layout.m(i)], on_value]
        };
        let on_arms = |i: usize, from: usize| match models[i].form {
            Form::Bent(_) => [sizes[layout.arm(i, from)], sizes[layout.arm(i, 1 - from)]],
            _ => [0.0; 2],
        };
        let (mut left, mut right) = ([0.0; 2], [0.0; 2]);
        let (counts, rows) = ([middle, n - middle], &self.rows);
        let (found, behind) = self.found.split_at_mut(middle);
        both(
            counts,
            |k| {
                let by = (on(k), sizes[k], on_arms(k, 0));
                found[k].own = forward(&mut left, &models[k], h[k], by, &rows[k]);
            },
            |k| {
                let i = n - 1 - k;
                let [on_slope, on_value] = on(i + 1);
                let by = ([on_slope, -on_value], sizes[i], on_arms(i, 1));
                let model = models[i].reflected();
                behind[i - middle].own = forward(&mut right, &model, h[i], by, &rows[i]);
            },
        );
        let [on_slope, on_value] = on(middle);
        let (pm, pf) = (left[0] + right[0] + on_slope, left[1] - right[1] + on_value);
        let [a, b, c] = self.end;
        let z = -pm / a;
        let f = (-pf - b * z) / c / c;
        let m = (z - b * f) / a;
        step[layout.m(middle)] = m;
        let (mut left, mut right) = ([m, f], [m, -f]);
        let (found, behind) = self.found.split_at_mut(middle);
        both(
            counts,
            |k| {
                let i = middle - 1 - k;
                backward(&mut left, models[i].form, h[i], &rows[i], &mut found[i]);
            },
            |k| {
                let i = middle + k;
                let form = models[i].form.reflected();
                backward(&mut right, form, h[i], &rows[i], &mut behind[k]);
            },
        );
        for (i, found) in self.found.iter().enumerate() {
            let reflected = i >= middle;
            step[i] = found.rise;
            step[layout.m(i + usize::from(reflected))] = found.slope;
            if models[i].form.is_bent() {
                for (end, arm) in found.own.into_iter().enumerate() {
                    step[layout.arm(i, if reflected { 1 - end } else { end })] = arm;
                }
            }
        }
        step[layout.low()] = left[1];
        step[layout.high()] = right[1];
    }

    /// The diagonal of the inverse Hessian at the values, from the middle to the ends.
    pub(super) fn variances(&self, h: &[f64], models: &[Model]) -> Vec<f64> {
        let (n, middle) = (self.layout.n, self.middle);
        let [a, b, c] = self.end;
        // Columns of a root of the covariance of (m, f); products of rows with themselves keep it positive.
        let (ia, ic) = (1.0 / a, 1.0 / c);
        let mixed = -b * ia * ic;
        let cov = [ia * ia + mixed * mixed, mixed * ic, ic * ic];
        let mut variances = vec![0.0; n + 1];
        variances[middle] = cov[2];
        let mut left = cov;
        for i in (0..middle).rev() {
            left = covariance(left, models[i].form, h[i], &self.rows[i]);
            variances[i] = left[2];
        }
        let mut right = [cov[0], -cov[1], cov[2]];
        for i in middle..n {
            right = covariance(right, models[i].form.reflected(), h[i], &self.rows[i]);
            variances[i + 1] = right[2];
        }
        variances
    }
}

/// The steps of two chains: of long ones by two threads, of others in turn, so that a processor does both at the same time.
#[inline(always)]
fn both(
    counts: [usize; 2],
    mut left: impl FnMut(usize) + Send,
    mut right: impl FnMut(usize) + Send,
) {
    if counts.into_iter().min() >= Some(LONG) {
        parallel::both(
            true,
            || (0..counts[0]).for_each(&mut left),
            || (0..counts[1]).for_each(&mut right),
        );
        return;
    }
    for k in 0..counts[0].max(counts[1]) {
        if k < counts[0] {
            left(k);
        }
        if k < counts[1] {
            right(k);
        }
    }
}

impl Carry {
    /// Over an interval to the next node, with stiffness of slope and value at the node before it, of its rise and of its
    /// arms: its rows of the factor.
    #[inline(always)]
    fn over(
        &mut self,
        model: &Model,
        h: f64,
        [on_slope, on_value]: [f64; 2],
        on_rise: f64,
        on_arms: [f64; 2],
    ) -> [f64; 7] {
        add(&mut self.rows, on_slope + self.extra, on_value);
        let found;
        (self.extra, found) = match model.form {
            Form::Bent(sense) => {
                let mut rows = bent_rows(&self.rows, model, h, sense, on_arms);
                (0.0, eliminate_sorted(&mut rows))
            }
            Form::Level => {
                let mut rows = interval_rows(&self.rows, model, h, on_rise.sqrt());
                (model.rows[4] * model.rows[4], eliminate(&mut rows))
            }
            Form::Cubic => {
                let mut rows = interval_rows(&self.rows, model, h, on_rise.sqrt());
                (0.0, eliminate(&mut rows))
            }
        };
        self.rows = found.1;
        found.0
    }
}

/// Carry gradients of slope and value over an interval, with those at the node before it, of its rise and of its arms.
#[inline(always)]
fn forward(
    [pm, pf]: &mut [f64; 2],
    model: &Model,
    h: f64,
    ([on_slope, on_value], by, arms): ([f64; 2], f64, [f64; 2]),
    &[i00, r01, i11, r0m, r0f, r1m, r1f]: &[f64; 7],
) -> [f64; 2] {
    *pm += on_slope;
    *pf += on_value;
    let [a, b, c] = model.gradient;
    let (g0, g1);
    match model.form {
        Form::Level => {
            (g0, g1) = (a + by - *pf, b + *pm);
            *pm = c;
        }
        Form::Cubic => {
            (g0, g1) = (a + by - *pf, b - *pm + 0.5 * h * (*pf - by));
            *pm += h * (by - *pf);
        }
        Form::Bent(sense) => {
            (g0, g1) = (a + arms[0] - sense * *pm, b + arms[1] + sense * (h * *pf - *pm));
            *pm -= h * *pf;
        }
    }
    let q0 = g0 * i00;
    let q1 = (g1 - r01 * q0) * i11;
    *pm -= r0m * q0 + r1m * q1;
    *pf -= r0f * q0 + r1f * q1;
    [q0, q1]
}

/// From the state behind an interval to that before it, and its steps.
#[inline(always)]
fn backward(
    [m, f]: &mut [f64; 2],
    form: Form,
    h: f64,
    &[i00, r01, i11, r0m, r0f, r1m, r1f]: &[f64; 7],
    found: &mut IntervalSteps,
) {
    let [q0, q1] = found.own;
    let u1 = (-q1 - r1m * *m - r1f * *f) * i11;
    let u0 = (-q0 - r01 * u1 - r0m * *m - r0f * *f) * i00;
    let rise;
    (rise, *m) = match form {
        Form::Level => (u0, u1),
        Form::Cubic => (u0 + h * (*m - 0.5 * u1), *m - u1),
        Form::Bent(sense) => (h * (*m - sense * u1), *m - sense * (u0 + u1)),
    };
    *f -= rise;
    *found = IntervalSteps { own: [u0, u1], rise, slope: *m };
}

/// The covariance of the state before an interval from that behind it: variance of m, covariance, variance of f.
fn covariance(
    cov: [f64; 3],
    form: Form,
    h: f64,
    &[i00, r01, i11, r0m, r0f, r1m, r1f]: &[f64; 7],
) -> [f64; 3] {
    // u = −G x' + K ξ with unit ξ.
    let g1 = [r1m * i11, r1f * i11];
    let g0 = [(r0m - r01 * g1[0]) * i00, (r0f - r01 * g1[1]) * i00];
    let (k1, k0) = ([0.0, i11], [i00, -r01 * i00 * i11]);
    // The state before in the one behind and ξ.
    let (mx, fx, mk, fk);
    match form {
        Form::Level => {
            mx = [-g1[0], -g1[1]];
            mk = k1;
            fx = [g0[0], 1.0 + g0[1]];
            fk = [-k0[0], -k0[1]];
        }
        Form::Cubic => {
            let half = 0.5 * h;
            mx = [1.0 + g1[0], g1[1]];
            mk = [-k1[0], -k1[1]];
            fx = [-h + g0[0] - half * g1[0], 1.0 + g0[1] - half * g1[1]];
            fk = [-k0[0] + half * k1[0], -k0[1] + half * k1[1]];
        }
        Form::Bent(sense) => {
            let by = sense * h;
            mx = [1.0 + sense * (g0[0] + g1[0]), sense * (g0[1] + g1[1])];
            mk = [-sense * (k0[0] + k1[0]), -sense * (k0[1] + k1[1])];
            fx = [-h - by * g1[0], 1.0 - by * g1[1]];
            fk = [by * k1[0], by * k1[1]];
        }
    }
    let form = |u: [f64; 2], v: [f64; 2]| {
        cov[0] * u[0] * v[0] + cov[1] * (u[0] * v[1] + u[1] * v[0]) + cov[2] * u[1] * v[1]
    };
    let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
    [form(mx, mx) + dot(mk, mk), form(mx, fx) + dot(mk, fk), form(fx, fx) + dot(fk, fk)]
}
