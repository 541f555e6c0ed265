//! Polynomials of any small degree in Bernstein form on [0, 1]: value, derivative, roots.

/// Deepest subdivision of the root search: parts of 2⁻⁵⁰.
const DEPTH: u32 = 50;

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

/// Real roots in [0, 1], increasing, each once. Simple roots to the last bits by bisection and Newton in a bracket;
/// a root the polynomial only touches where its Bernstein coefficients cannot be told from zero. A polynomial that
/// is zero throughout has no isolated roots and gives none.
pub(crate) fn roots(b: &[f64]) -> Vec<f64> {
    let mut out = Vec::new();
    let size = b.iter().fold(0.0f64, |a, v| a.max(v.abs()));
    if size == 0.0 || !size.is_finite() {
        return out;
    }
    let scaled: Vec<f64> = b.iter().map(|v| v / size).collect();
    let mut found = |t: f64| {
        // Neighbouring parts may both report a root at their common end.
        if out.last().is_none_or(|last: &f64| t - last > 4.0 * f64::EPSILON) {
            out.push(t);
        }
    };
    isolate(&scaled, &scaled, 0.0, 1.0, DEPTH, &mut found);
    out
}

fn isolate(whole: &[f64], b: &[f64], lo: f64, hi: f64, depth: u32, found: &mut impl FnMut(f64)) {
    let n = b.len() - 1;
    let mut variations = 0;
    let mut last = 0.0f64;
    let mut largest = 0.0f64;
    for &v in b {
        largest = largest.max(v.abs());
        if v != 0.0 {
            if last * v < 0.0 {
                variations += 1;
            }
            last = v;
        }
    }
    if largest <= 4.0 * f64::EPSILON * (n + 1) as f64 {
        // Not to be told from zero on the whole part: a touching point (or the end of one).
        found(0.5 * (lo + hi));
        return;
    }
    if b[0] == 0.0 {
        found(lo);
    }
    if variations == 0 {
        if b[n] == 0.0 && n > 0 {
            found(hi);
        }
        return;
    }
    if variations == 1 && b[0] != 0.0 && b[n] != 0.0 {
        found(bracketed(whole, lo, hi, b[0] < 0.0));
        return;
    }
    if depth == 0 {
        found(0.5 * (lo + hi));
        return;
    }
    let mut rest = b.to_vec();
    let mut left = vec![0.0; n + 1];
    for k in 0..=n {
        left[k] = rest[0];
        for j in 0..n - k {
            rest[j] = 0.5 * (rest[j] + rest[j + 1]);
        }
    }
    let mid = 0.5 * (lo + hi);
    isolate(whole, &left, lo, mid, depth - 1, found);
    isolate(whole, &rest, mid, hi, depth - 1, found);
}

/// The root in a bracket with one sign change: secant steps kept inside, halved when they stall.
fn bracketed(b: &[f64], lo: f64, hi: f64, rising: bool) -> f64 {
    let sign = if rising { 1.0 } else { -1.0 };
    let (mut lo, mut hi) = (lo, hi);
    let (mut f_lo, mut f_hi) = (sign * value(b, lo), sign * value(b, hi));
    for k in 0..200 {
        if !(hi - lo > f64::EPSILON * hi) {
            break;
        }
        let secant = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        let inside = secant > lo && secant < hi && k % 3 != 2;
        let t = if inside { secant } else { 0.5 * (lo + hi) };
        if t <= lo || t >= hi {
            break;
        }
        let f = sign * value(b, t);
        if f == 0.0 {
            return t;
        }
        if f < 0.0 {
            (lo, f_lo) = (t, f);
        } else {
            (hi, f_hi) = (t, f);
        }
    }
    if f_lo.abs() < f_hi.abs() { lo } else { hi }
}

/// Positive roots of `Σ aₖ τᵏ`, increasing. With τ = (1−s)/s the polynomial times sⁿ has the Bernstein
/// coefficients `aₖ/C(n,k)` at index n−k, so all of (0, ∞) is searched at once.
pub(crate) fn positive_roots(a: &[f64]) -> Vec<f64> {
    let n = a.len() - 1;
    let mut b = vec![0.0; n + 1];
    let mut binomial = 1.0;
    for k in 0..=n {
        b[n - k] = a[k] / binomial;
        binomial *= (n - k) as f64 / (k + 1) as f64;
    }
    let mut out: Vec<f64> =
        roots(&b).into_iter().filter(|s| *s > 0.0 && *s < 1.0).map(|s| (1.0 - s) / s).collect();
    out.reverse();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of a polynomial given by its roots and a factor.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut b = vec![1.0];
        for r in roots {
            // Times (t − r) = −r(1−t) + (1−r)t: degree elevation with weights.
            let n = b.len();
            let mut next = vec![0.0; n + 1];
            for (k, v) in b.iter().enumerate() {
                next[k] += v * -r * (n - k) as f64 / n as f64;
                next[k + 1] += v * (1.0 - r) * (k + 1) as f64 / n as f64;
            }
            b = next;
        }
        b
    }

    #[test]
    fn planted_roots_come_back() {
        for planted in [
            vec![0.3],
            vec![0.1, 0.5, 0.9],
            vec![0.0, 0.25, 1.0],
            vec![0.2, 0.2000001, 0.7],
            vec![-1.0, 0.4, 3.0],
            vec![0.5, 0.5],
        ] {
            let b = with_roots(&planted);
            let found = roots(&b);
            let mut expected: Vec<f64> =
                planted.iter().copied().filter(|r| (0.0..=1.0).contains(r)).collect();
            expected.dedup();
            assert_eq!(found.len(), expected.len(), "{planted:?}: {found:?}");
            for (a, e) in found.iter().zip(&expected) {
                assert!((a - e).abs() < 1e-7, "{planted:?}: {found:?}");
            }
        }
    }

    #[test]
    fn outside_roots_come_back() {
        let b = with_roots(&[-2.0, 0.5, 1.5, 40.0]);
        let right = positive_roots(&taylor(&b, true));
        assert_eq!(right.len(), 2);
        assert!((right[0] - 0.5).abs() < 1e-9 && (right[1] - 39.0).abs() < 1e-6);
        let left = positive_roots(&taylor(&b, false));
        assert_eq!(left.len(), 1);
        assert!((left[0] - 2.0).abs() < 1e-9);
    }
}
