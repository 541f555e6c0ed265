// SPDX-License-Identifier: MIT OR Apache-2.0

//! Orthogonal elimination of one interval's rows.

use super::interval::{Form, Model};

/// Squares that no scaled quantity has, of slopes that are all but 0: their quotients would overflow.
const NEGLIGIBLE: f64 = 1e-280;

/// The rows of an interval that is being eliminated: two unknowns of its own, then m' and f'.
type Rows = [[f64; 4]; 5];

/// Rows `(√on_slope, 0)` and `(0, √on_value)` more.
#[inline(always)]
pub(super) fn add(carry: &mut [f64; 3], on_slope: f64, on_value: f64) {
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
pub(super) fn interval_rows(&[a, b, c]: &[f64; 3], model: &Model, h: f64, on_rise: f64) -> Rows {
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
pub(super) fn bent_rows(
    &[a, b, c]: &[f64; 3],
    model: &Model,
    h: f64,
    sense: f64,
    stiff: [f64; 2],
) -> Rows {
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
pub(super) fn eliminate_sorted(rows: &mut Rows) -> ([f64; 7], [f64; 3]) {
    for k in 0..3 {
        let largest = (k..5).max_by(|i, j| rows[*i][k].abs().total_cmp(&rows[*j][k].abs()));
        rows.swap(k, largest.unwrap_or(k));
        reflect(rows, k);
    }
    triangle(rows)
}

/// Householder reflections of the first three columns; the norm of what is left of the last.
#[inline(always)]
pub(super) fn eliminate(rows: &mut Rows) -> ([f64; 7], [f64; 3]) {
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

/// The rows of the state that two chains meet at, of which the second has f reflected.
pub(super) fn met([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let size = hypot(a, x);
    if size == 0.0 {
        return [0.0, 0.0, (b * b + y * y + c * c + z * z).sqrt()];
    }
    let (cos, sin) = (a / size, x / size);
    let left = cos * y + sin * b;
    [size, cos * b - sin * y, (c * c + z * z + left * left).sqrt()]
}
