// SPDX-License-Identifier: MIT OR Apache-2.0

//! The small matrices of one segment: pairs of a symmetric 3×3 and a symmetric 2×2 matrix, as upper triangles row by
//! row (00 01 02 11 12 22, then 00 01 11), in closed form and without branches.

/// Sums along the antidiagonals of both matrices, the second shifted by one: a quartic's pₖ.
#[inline(always)]
pub(super) fn sums(x: &[f64; 9]) -> [f64; 5] {
    [x[0], (x[1] + x[1]) + x[6], x[3] + 2.0 * (x[2] + x[7]), (x[4] + x[4]) + x[8], x[5]]
}

/// The inverses of the two Hankel matrices.
#[inline(always)]
pub(super) fn inverse(y: &[f64; 5]) -> [f64; 9] {
    let a00 = y[2] * y[4] - y[3] * y[3];
    let a01 = y[2] * y[3] - y[1] * y[4];
    let a02 = y[1] * y[3] - y[2] * y[2];
    let a11 = y[0] * y[4] - y[2] * y[2];
    let a12 = y[1] * y[2] - y[0] * y[3];
    let a22 = y[0] * y[2] - y[1] * y[1];
    let d = 1.0 / (y[0] * a00 + (y[1] * a01 + y[2] * a02));
    let q = 1.0 / a02;
    [d * a00, d * a01, d * a02, d * a11, d * a12, d * a22, q * y[3], -(q * y[2]), q * y[1]]
}

/// The inverse of a symmetric 4×4 matrix (upper triangle row by row) by 2×2 blocks.
#[inline(always)]
pub(super) fn inverse4(r: &[f64; 10]) -> [f64; 10] {
    let d = 1.0 / (r[0] * r[4] - r[1] * r[1]);
    let (i00, i01, i11) = (d * r[4], -(d * r[1]), d * r[0]);
    // P = A⁻¹C, S = D − CᵀP.
    let p00 = i00 * r[2] + i01 * r[5];
    let p01 = i00 * r[3] + i01 * r[6];
    let p10 = i01 * r[2] + i11 * r[5];
    let p11 = i01 * r[3] + i11 * r[6];
    let s00 = r[7] - (r[2] * p00 + r[5] * p10);
    let s01 = r[8] - (r[2] * p01 + r[5] * p11);
    let s11 = r[9] - (r[3] * p01 + r[6] * p11);
    let d = 1.0 / (s00 * s11 - s01 * s01);
    let (t00, t01, t11) = (d * s11, -(d * s01), d * s00);
    let q00 = p00 * t00 + p01 * t01;
    let q01 = p00 * t01 + p01 * t11;
    let q10 = p10 * t00 + p11 * t01;
    let q11 = p10 * t01 + p11 * t11;
    [
        i00 + (q00 * p00 + q01 * p01),
        i01 + (q00 * p10 + q01 * p11),
        -q00,
        -q01,
        i11 + (q10 * p10 + q11 * p11),
        -q10,
        -q11,
        t00,
        t01,
        t11,
    ]
}

#[inline(always)]
pub(super) fn times4(r: &[f64; 10], t: [f64; 4]) -> [f64; 4] {
    [
        (r[0] * t[0] + r[1] * t[1]) + (r[2] * t[2] + r[3] * t[3]),
        (r[1] * t[0] + r[4] * t[1]) + (r[5] * t[2] + r[6] * t[3]),
        (r[2] * t[0] + r[5] * t[1]) + (r[7] * t[2] + r[8] * t[3]),
        (r[3] * t[0] + r[6] * t[1]) + (r[8] * t[2] + r[9] * t[3]),
    ]
}

/// `dZ Z⁻¹` of both, row by row.
#[inline(always)]
pub(super) fn ratio(y: &[f64; 5], z: &[f64; 9]) -> [f64; 13] {
    let row = |a: f64, b: f64, c: f64| {
        [
            a * z[0] + (b * z[1] + c * z[2]),
            a * z[1] + (b * z[3] + c * z[4]),
            a * z[2] + (b * z[4] + c * z[5]),
        ]
    };
    let (p, q, r) = (row(y[0], y[1], y[2]), row(y[1], y[2], y[3]), row(y[2], y[3], y[4]));
    [
        p[0],
        p[1],
        p[2],
        q[0],
        q[1],
        q[2],
        r[0],
        r[1],
        r[2],
        y[1] * z[6] + y[2] * z[7],
        y[1] * z[7] + y[2] * z[8],
        y[2] * z[6] + y[3] * z[7],
        y[2] * z[7] + y[3] * z[8],
    ]
}

/// The symmetric part of `X G` of both.
#[inline(always)]
pub(super) fn symmetric(x: &[f64; 9], g: &[f64; 13]) -> [f64; 9] {
    let entry = |a: [f64; 3], j: usize| a[0] * g[j] + (a[1] * g[3 + j] + a[2] * g[6 + j]);
    let (r0, r1, r2) = ([x[0], x[1], x[2]], [x[1], x[3], x[4]], [x[2], x[4], x[5]]);
    [
        entry(r0, 0),
        0.5 * (entry(r0, 1) + entry(r1, 0)),
        0.5 * (entry(r0, 2) + entry(r2, 0)),
        entry(r1, 1),
        0.5 * (entry(r1, 2) + entry(r2, 1)),
        entry(r2, 2),
        x[6] * g[9] + x[7] * g[11],
        0.5 * ((x[6] * g[10] + x[7] * g[12]) + (x[7] * g[9] + x[8] * g[11])),
        x[7] * g[10] + x[8] * g[12],
    ]
}

/// M's upper triangle: 00 01 02 03 04 11 12 13 14 22 23 24 33 34 44.
#[inline(always)]
pub(super) fn product(z: &[f64; 9], x: &[f64; 9]) -> [f64; 15] {
    [
        z[0] * x[0],
        z[0] * x[1] + z[1] * x[0],
        z[0] * x[2] + (z[1] * x[1] + z[2] * x[0]),
        z[1] * x[2] + z[2] * x[1],
        z[2] * x[2],
        (z[0] * x[3] + z[3] * x[0]) + (2.0 * (z[1] * x[1]) + z[6] * x[6]),
        ((z[0] * x[4] + z[4] * x[0]) + (z[1] * x[3] + z[3] * x[1]))
            + ((z[2] * x[1] + z[1] * x[2]) + (z[6] * x[7] + z[7] * x[6])),
        ((z[1] * x[4] + z[4] * x[1]) + (z[2] * x[3] + z[3] * x[2])) + z[7] * x[7],
        z[2] * x[4] + z[4] * x[2],
        ((z[0] * x[5] + z[5] * x[0]) + (z[3] * x[3] + (z[6] * x[8] + z[8] * x[6])))
            + 2.0 * ((z[1] * x[4] + z[4] * x[1]) + (z[2] * x[2] + z[7] * x[7])),
        ((z[1] * x[5] + z[5] * x[1]) + (z[3] * x[4] + z[4] * x[3]))
            + ((z[2] * x[4] + z[4] * x[2]) + (z[7] * x[8] + z[8] * x[7])),
        z[2] * x[5] + (z[4] * x[4] + z[5] * x[2]),
        (z[3] * x[5] + z[5] * x[3]) + (2.0 * (z[4] * x[4]) + z[8] * x[8]),
        z[4] * x[5] + z[5] * x[4],
        z[5] * x[5],
    ]
}

/// Positive exactly when both matrices of upper triangles `x` are positive definite.
#[inline(always)]
pub(super) fn definite(x: &[f64; 9]) -> f64 {
    let minor = x[0] * x[3] - x[1] * x[1];
    let first = x[2] * (x[1] * x[4] - x[2] * x[3]) - x[4] * (x[0] * x[4] - x[1] * x[2]);
    let whole = x[5] * minor + first;
    let other = x[6] * x[8] - x[7] * x[7];
    let least = |a: f64, b: f64| if a < b { a } else { b };
    // NaN must not hide: it is passed on by the comparison's second branch only, so add it.
    least(least(least(x[0], minor), least(whole, x[6])), other) + 0.0 * (whole + other)
}

/// The two Hankel matrices' upper triangles.
#[inline(always)]
pub(super) fn hankel(y: &[f64; 5]) -> [f64; 9] {
    [y[0], y[1], y[2], y[2], y[3], y[4], y[1], y[2], y[3]]
}

/// The largest step that leaves both definite, or `most`. Exact: the step must not depend on the order of segments.
#[inline(never)]
pub(super) fn longest(from: &[f64; 9], by: &[f64; 9], most: f64) -> f64 {
    // det(X + sD) as a polynomial in 1/s, by mixed determinants.
    let adjoint = |x: &[f64; 9]| {
        [
            x[3] * x[5] - x[4] * x[4],
            x[2] * x[4] - x[1] * x[5],
            x[1] * x[4] - x[2] * x[3],
            x[0] * x[5] - x[2] * x[2],
            x[1] * x[2] - x[0] * x[4],
            x[0] * x[3] - x[1] * x[1],
        ]
    };
    let trace = |a: &[f64; 6], x: &[f64; 9]| {
        (a[0] * x[0] + a[3] * x[3] + a[5] * x[5]) + 2.0 * (a[1] * x[1] + a[2] * x[2] + a[4] * x[4])
    };
    let (p, q) = (adjoint(from), adjoint(by));
    let three =
        largest_root(trace(&p, from) / 3.0, trace(&p, by), trace(&q, from), trace(&q, by) / 3.0);
    let two = largest_root(
        from[6] * from[8] - from[7] * from[7],
        (from[6] * by[8] + from[8] * by[6]) - 2.0 * (from[7] * by[7]),
        by[6] * by[8] - by[7] * by[7],
        0.0,
    );
    let root = if two > three { two } else { three };
    let step = if root * most > 1.0 { 1.0 / root } else { most };
    let at = |s: f64| definite(&std::array::from_fn(|k| from[k] + s * by[k])) > 0.0;
    if at(0.99 * step) {
        return step;
    }
    // Rounding has spoilt the polynomial: bisection, from below.
    let (mut lo, mut hi) = (0.0, step);
    for _ in 0..30 {
        let middle = 0.5 * (lo + hi);
        if at(middle) {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    lo
}

/// The largest root of `aβ³ + bβ² + cβ + d`, a > 0, all of whose roots are real: Newton's method from Samuelson's
/// bound, from where it falls monotonically.
fn largest_root(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (b, c, d) = (b / a, c / a, d / a);
    let mut root = (2.0 * (b * b - 3.0 * c).max(0.0).sqrt() - b) / 3.0;
    for _ in 0..50 {
        let value = ((root + b) * root + c) * root + d;
        let next = root - value / ((3.0 * root + 2.0 * b) * root + c);
        if !(next < root - 1e-14 * root.abs()) {
            break;
        }
        root = next;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    type Full = [[f64; 3]; 3];

    fn full(x: &[f64; 9]) -> [Full; 2] {
        [
            [[x[0], x[1], x[2]], [x[1], x[3], x[4]], [x[2], x[4], x[5]]],
            [[x[6], x[7], 0.0], [x[7], x[8], 0.0], [0.0; 3]],
        ]
    }

    fn times(a: &Full, b: &Full) -> Full {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>())
        })
    }

    /// Moments of three masses inside, and a positive definite pair.
    fn sample(seed: u64) -> ([f64; 5], [f64; 9]) {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut y = [0.0; 5];
        for j in 0..3 {
            let (t, m) = (0.1 + 0.3 * (f64::from(j) + 0.8 * next()), 0.1 + next());
            for (k, y) in y.iter_mut().enumerate() {
                *y += m * t.powi(k as i32) * (1.0 - t).powi(4 - k as i32);
            }
        }
        let x = std::array::from_fn(|k| if [0, 3, 5, 6, 8].contains(&k) { 2.0 } else { next() });
        (y, x)
    }

    /// Inverses, and M as the traces it is made of.
    #[test]
    fn closed_forms() {
        for seed in 1..50 {
            let (y, x) = sample(seed);
            let zi = inverse(&y);
            let (z, i) = (full(&hankel(&y)), full(&zi));
            for q in 0..2 {
                let one = times(&z[q], &i[q]);
                for r in 0..3 - q {
                    for c in 0..3 - q {
                        assert!((one[r][c] - f64::from(u8::from(r == c))).abs() < 1e-8);
                    }
                }
            }
            let unit =
                |k: usize| full(&hankel(&std::array::from_fn(|j| f64::from(u8::from(j == k)))));
            let (m, x2) = (product(&zi, &x), full(&x));
            let mut at = 0;
            for k in 0..5 {
                for l in k..5 {
                    let mut sum = 0.0;
                    for q in 0..2 {
                        let a = times(&unit(k)[q], &i[q]);
                        let b = times(&unit(l)[q], &x2[q]);
                        let t = times(&a, &b);
                        sum += t[0][0] + t[1][1] + t[2][2];
                    }
                    assert!(
                        (m[at] - sum).abs() < 1e-9 * (1.0 + sum.abs()),
                        "{k} {l}: {} {sum}",
                        m[at]
                    );
                    at += 1;
                }
            }
        }
    }

    #[test]
    fn four_by_four() {
        let r = [4.0, 1.0, 0.5, -0.3, 3.0, 0.2, 0.7, 5.0, -1.0, 2.0];
        let i = inverse4(&r);
        for k in 0..4 {
            let unit: [f64; 4] = std::array::from_fn(|j| f64::from(u8::from(j == k)));
            let back = times4(&i, times4(&r, unit));
            assert!((0..4).all(|j| (back[j] - unit[j]).abs() < 1e-14), "{back:?}");
        }
    }

    /// The step ends on the boundary.
    #[test]
    fn longest_steps() {
        let mut limited = 0;
        for seed in 1..200 {
            let (_, x) = sample(seed);
            let (y, other) = sample(seed + 1000);
            let by: [f64; 9] = std::array::from_fn(|k| 3.0 * hankel(&y)[k] - 2.0 * other[k]);
            let step = longest(&x, &by, 10.0);
            let at = |s: f64| definite(&std::array::from_fn(|k| x[k] + s * by[k]));
            assert!(at(0.999_999 * step) > 0.0, "{seed}");
            if step < 10.0 {
                limited += 1;
                assert!(!(at(1.000_001 * step) > 0.0), "{seed}");
            }
        }
        assert!(limited > 50, "{limited}");
    }
}
