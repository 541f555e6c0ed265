// SPDX-License-Identifier: MIT OR Apache-2.0

//! Quartics on `[0, 1]` in Bernstein form: values and least values.

use crate::bracketed_root;

/// The value at t by the scheme of de Casteljau's weights.
#[inline]
#[must_use]
pub fn basis(t: f64) -> [f64; 5] {
    let u = 1.0 - t;
    let (uu, ut, tt) = (u * u, u * t, t * t);
    [uu * uu, 4.0 * uu * ut, 6.0 * ut * ut, 4.0 * ut * tt, tt * tt]
}

/// `Σ cₖ wₖ`.
#[inline]
#[must_use]
pub fn dot(c: &[f64; 5], w: &[f64; 5]) -> f64 {
    (c[0] * w[0] + c[4] * w[4]) + (c[1] * w[1] + c[3] * w[3]) + c[2] * w[2]
}

/// An interior local minimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// Where.
    pub t: f64,
    /// The value there.
    pub value: f64,
    /// The second derivative there.
    pub curvature: f64,
}

/// The interior local minima that can lie below both end values: at most two.
///
/// The derivative (a cubic) is split at its own critical points; on each part it is monotone, and a minimum is
/// where it rises through zero. Each root is bracketed, so none is missed or taken twice.
#[inline]
#[must_use]
pub fn minima(c: &[f64; 5]) -> [Option<Minimum>; 2] {
    // The curve lies above its least coefficient: with no inner coefficient below both ends' there is no minimum
    // that the ends do not already bound.
    let ends = c[0].min(c[4]);
    if c[1].min(c[2]).min(c[3]) >= ends {
        return [None, None];
    }
    // Power form of p'/4 about 0: Bernstein coefficients q of the cubic.
    let q = [c[1] - c[0], c[2] - c[1], c[3] - c[2], c[4] - c[3]];
    let k0 = q[0];
    let k1 = 3.0 * (q[1] - q[0]);
    let k2 = 3.0 * ((q[2] - q[1]) - (q[1] - q[0]));
    let k3 = (q[3] - q[0]) - 3.0 * (q[2] - q[1]);
    let cubic = |t: f64| ((k3 * t + k2) * t + k1) * t + k0;
    let slope = |t: f64| (3.0 * k3 * t + 2.0 * k2) * t + k1;
    let mut found = [None, None];
    let mut count = 0;
    let mut add = |ends: [f64; 2], values: [f64; 2]| {
        // The cubic rises through zero, monotone between. The value at the minimum has the square of the error.
        let (at, start) = (|t: f64| (cubic(t), slope(t)), 0.5 * (ends[0] + ends[1]));
        let t = bracketed_root(at, ends, values, start, [0.0, 1e-9]);
        if count < 2 {
            let value = dot(c, &basis(t));
            found[count] = Some(Minimum { t, value, curvature: 4.0 * slope(t) });
            count += 1;
        }
    };
    // Critical points of the cubic inside (0, 1).
    let (a, b) = (3.0 * k3, k2);
    let discriminant = b * b - a * k1;
    if !(discriminant > 0.0) {
        if q[0] < 0.0 && q[3] > 0.0 {
            add([0.0, 1.0], [q[0], q[3]]);
        }
        return found;
    }
    let r = -(b + discriminant.sqrt().copysign(b));
    let (mut t1, mut t2) = (if a == 0.0 { f64::INFINITY } else { r / a }, k1 / r);
    if t1 > t2 {
        (t1, t2) = (t2, t1);
    }
    let cut = |t: f64| {
        if t > 0.0 && t < 1.0 {
            t
        } else if t >= 1.0 {
            1.0
        } else {
            0.0
        }
    };
    let at = |t: f64| {
        if t == 0.0 {
            q[0]
        } else if t == 1.0 {
            q[3]
        } else {
            cubic(t)
        }
    };
    let knots = [0.0, cut(t1), cut(t2), 1.0];
    let values = [q[0], at(knots[1]), at(knots[2]), q[3]];
    for k in 0..3 {
        if knots[k] < knots[k + 1] && values[k] < 0.0 && values[k + 1] > 0.0 {
            add([knots[k], knots[k + 1]], [values[k], values[k + 1]]);
        }
    }
    found
}

/// The least value over [0, 1], and where it is.
#[inline]
#[must_use]
pub fn lowest(c: &[f64; 5]) -> (f64, f64) {
    let ends = if c[0] <= c[4] { (0.0, c[0]) } else { (1.0, c[4]) };
    let lower = |a: (f64, f64), m: &Minimum| if m.value < a.1 { (m.t, m.value) } else { a };
    minima(c).iter().flatten().fold(ends, lower)
}

/// The least value over [0, 1].
#[inline]
#[must_use]
pub fn least(c: &[f64; 5]) -> f64 {
    lowest(c).1
}

/// The coefficients, of degree four again, of p/(tᵃ(1−t)ᵇ) from those of p, the first a and the last b of which are 0.
#[inline]
#[must_use]
pub fn without_zeros(p: &[f64; 5], [a, b]: [usize; 2]) -> [f64; 5] {
    const BINOMIAL: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
    if a + b == 0 {
        return *p;
    }
    let mut q: [f64; 5] =
        std::array::from_fn(|k| if k + a + b > 4 { 0.0 } else { BINOMIAL[k + a] * p[k + a] });
    // Times t + (1−t) for every zero.
    for _ in 0..a + b {
        for k in (1..5).rev() {
            q[k] += q[k - 1];
        }
    }
    std::array::from_fn(|k| q[k] / BINOMIAL[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified_nonnegative;

    /// Quartics with planted minima: c·((t−r)² + m)·((t−s)² + k).
    fn from_power(p: [f64; 5]) -> [f64; 5] {
        // Bernstein coefficient j = Σₖ C(j,k)/C(4,k) pₖ.
        let binomial = [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 2.0, 1.0, 0.0, 0.0],
            [1.0, 3.0, 3.0, 1.0, 0.0],
            [1.0, 4.0, 6.0, 4.0, 1.0],
        ];
        let mut c = [0.0; 5];
        for (j, value) in c.iter_mut().enumerate() {
            *value = (0..5).map(|k| binomial[j][k] / binomial[4][k] * p[k]).sum();
        }
        c
    }

    fn product(r: f64, m: f64, s: f64, k: f64) -> [f64; 5] {
        let (a, b) = ([r * r + m, -2.0 * r, 1.0], [s * s + k, -2.0 * s, 1.0]);
        let mut p = [0.0; 5];
        for i in 0..3 {
            for j in 0..3 {
                p[i + j] += a[i] * b[j];
            }
        }
        from_power(p)
    }

    #[test]
    fn planted_double_roots_are_found() {
        for i in 1..40 {
            let r = f64::from(i) / 40.0;
            let c = product(r, 0.0, 2.0, 0.3);
            assert!(least(&c).abs() < 1e-13, "root {r}: {}", least(&c));
            for j in (i + 3)..40 {
                let s = f64::from(j) / 40.0;
                let c = product(r, 0.0, s, 0.0);
                let found: Vec<f64> = minima(&c).iter().flatten().map(|m| m.t).collect();
                assert_eq!(found.len(), 2, "{r} {s}");
                assert!((found[0] - r).abs() < 1e-6 && (found[1] - s).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn least_value_agrees_with_dense_sampling() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.3
        };
        for _ in 0..3000 {
            let c = [next(), next(), next(), next(), next()];
            let sampled = (0..=2000)
                .map(|k| dot(&c, &basis(f64::from(k) / 2000.0)))
                .fold(f64::INFINITY, f64::min);
            let exact = least(&c);
            assert!(exact <= sampled + 1e-15 && exact >= sampled - 1e-5, "{c:?}");
            assert_eq!(certified_nonnegative(&c, 0.0), exact >= 0.0, "{c:?} {exact}");
        }
    }
}
