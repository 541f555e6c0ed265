// SPDX-License-Identifier: MIT OR Apache-2.0

//! Polynomials of any small degree in Bernstein form on [0, 1]: value, derivative, Taylor coefficients about the ends.

/// The value at t (de Casteljau; also outside [0, 1]).
pub(crate) fn value(b: &[f64], t: f64) -> f64 {
    // Degrees beyond the array's come from antiderivatives of high order only.
    let mut array = [0.0f64; 12];
    let mut vector;
    let n = b.len();
    let w: &mut [f64] = if n <= array.len() {
        array[..n].copy_from_slice(b);
        &mut array
    } else {
        vector = b.to_vec();
        &mut vector
    };
    let u = 1.0 - t;
    for k in (1..n).rev() {
        for j in 0..k {
            w[j] = u * w[j] + t * w[j + 1];
        }
    }
    w[0]
}

/// The value of a quadratic such that rounding cannot change its sign where it is of one sign on [0, 1]: with the roots r
/// of the sizes of its end coefficients `(r₀(1−t) − r₁t)² + 2(b + r₀r₁)t(1−t)`, whose terms are not negative then.
pub(crate) fn quadratic(c: [f64; 3], t: f64) -> f64 {
    /// Error of b, a sum of terms of its size, relative to r₀r₁.
    const NOISE: f64 = 16.0 * f64::EPSILON;
    let falls = c[0] + c[2] < 0.0;
    let [a0, b, a1] = if falls { [0.0 - c[0], 0.0 - c[1], 0.0 - c[2]] } else { c };
    let s = 1.0 - t;
    let inside = 0.0 < t && t < 1.0 && a0 >= 0.0 && a1 >= 0.0 && b < 0.0;
    let product = if inside { a0.sqrt() * a1.sqrt() } else { 0.0 };
    let value = if inside && b >= -(1.0 + NOISE) * product {
        let difference = a0.sqrt() * s - a1.sqrt() * t;
        difference * difference + 2.0 * (b + product).max(0.0) * (t * s)
    } else {
        (a0 * s + b * t) * s + (b * s + a1 * t) * t
    };
    if falls { 0.0 - value } else { value }
}

/// Coefficients on a part of [0, 1], whose ends are those of the part to the last bit (de Casteljau, twice).
pub(crate) fn part(b: &[f64], [from, to]: [f64; 2]) -> Vec<f64> {
    let n = b.len();
    let mut left = b.to_vec();
    if to < 1.0 {
        let mut w = b.to_vec();
        for k in 1..n {
            for j in 0..n - k {
                w[j] = (1.0 - to) * w[j] + to * w[j + 1];
            }
            left[k] = w[0];
        }
    }
    if from > 0.0 && to > 0.0 {
        let s = from / to;
        let mut w = left.clone();
        for k in 1..n {
            for j in 0..n - k {
                w[j] = (1.0 - s) * w[j] + s * w[j + 1];
            }
            left[n - 1 - k] = w[n - 1 - k];
        }
    }
    left
}

/// Coefficients of the derivative by t.
pub(crate) fn derivative(b: &[f64]) -> Vec<f64> {
    let n = b.len().saturating_sub(1);
    if n == 0 {
        return vec![0.0];
    }
    b.windows(2).map(|w| n as f64 * (w[1] - w[0])).collect()
}

/// Taylor coefficients about t = 1 (`right`) or, in −t direction, about t = 0, that is of p(1 + τ) or p(−τ).
pub(crate) fn taylor(b: &[f64], right: bool) -> Vec<f64> {
    let n = b.len() - 1;
    let mut ordered: Vec<f64> = b.to_vec();
    if right {
        ordered.reverse();
    }
    // Forward differences at the end: aₖ = C(n, k) (−1)ᵏ Δᵏ for the outward direction.
    let mut out = Vec::with_capacity(n + 1);
    let mut binomial = 1.0;
    let mut outward = 1.0;
    for k in 0..=n {
        out.push(outward * binomial * ordered[0]);
        for j in 0..n - k {
            ordered[j] = ordered[j + 1] - ordered[j];
        }
        binomial *= (n - k) as f64 / (k + 1) as f64;
        outward = -outward;
    }
    out
}
