// SPDX-License-Identifier: MIT OR Apache-2.0

//! Real roots of polynomials on an interval, in Bernstein form on [0, 1] or in powers of τ on [0, ∞).
//!
//! A polynomial is monotone between neighbouring stationary points, so the signs there decide whether there is a root
//! between them; stationary points are the roots of the derivative, found in the same way. A value below the rounding error
//! counts as zero, and consecutive zeros (a double root, or roots that rounding cannot separate) count as one root.

use shapespline_polynomial::{bernstein, bracketed_root};

/// Values up to this many ulp of the sum of the absolute terms, per coefficient, count as zero: the errors of de Casteljau's
/// and of Horner's scheme are about one.
const ULPS: f64 = 1.0;

/// A polynomial in a form that shows its sign changes.
pub(crate) trait Form: Sized {
    fn degree(&self) -> usize;
    fn value(&self, t: f64) -> f64;
    /// A bound of the rounding error of the value at t.
    fn noise(&self, t: f64) -> f64;
    /// The derivative, with no noise: its roots only cut the interval.
    fn derivative(&self) -> Self;
    /// Sign changes in the coefficients. The number of roots is this, or less by an even number.
    fn changes(&self) -> usize;
}

fn sign_changes(c: &[f64]) -> usize {
    let signs = c.iter().filter(|v| **v != 0.0).map(|v| *v > 0.0);
    signs.clone().zip(signs.skip(1)).filter(|(a, b)| a != b).count()
}

/// Bernstein coefficients on [0, 1], and a bound of the rounding error of every value.
pub(crate) struct Bernstein {
    pub(crate) c: Vec<f64>,
    pub(crate) noise: f64,
}

impl Bernstein {
    /// The polynomial with these coefficients, less v.
    pub(crate) fn less(c: &[f64], v: f64) -> Self {
        let size = c.iter().fold(v.abs(), |size, c| size.max(c.abs()));
        let noise = bernstein::rounding(c.len(), size);
        Self { c: c.iter().map(|c| c - v).collect(), noise }
    }

    /// Whether all values are zero to rounding.
    pub(crate) fn is_zero(&self) -> bool {
        self.c.iter().all(|c| c.abs() <= self.noise)
    }

    /// Whether all coefficients have one sign in spite of rounding, so that there is no root.
    pub(crate) fn is_definite(&self) -> bool {
        self.c.iter().all(|c| *c > self.noise) || self.c.iter().all(|c| *c < -self.noise)
    }
}

impl Form for Bernstein {
    fn degree(&self) -> usize {
        self.c.len() - 1
    }
    fn value(&self, t: f64) -> f64 {
        bernstein::value(&self.c, t)
    }
    fn noise(&self, _: f64) -> f64 {
        self.noise
    }
    fn derivative(&self) -> Self {
        Self { c: bernstein::derivative(&self.c), noise: 0.0 }
    }
    fn changes(&self) -> usize {
        sign_changes(&self.c)
    }
}

/// `Σ aₖ τᵏ` for τ ≥ 0, and its rounding error relative to the sum of the absolute terms.
pub(crate) struct Power {
    pub(crate) a: Vec<f64>,
    pub(crate) share: f64,
}

impl Power {
    pub(crate) fn new(a: Vec<f64>) -> Self {
        let share = ULPS * f64::EPSILON * a.len() as f64;
        Self { a, share }
    }

    /// Beyond this there is no root (Fujiwara 1916): twice the largest of `|aₖ/aₙ|` to the power 1/(n − k).
    fn bound(&self) -> f64 {
        let n = self.degree();
        let root = |k: usize| (self.a[k] / self.a[n]).abs().powf(1.0 / (n - k) as f64);
        (2.0 * (0..n).map(root).fold(0.0, f64::max)).min(f64::MAX)
    }
}

/// `Σ aₖ τᵏ`. At an infinite τ this is the limit: a partial sum of zero is not multiplied by τ.
pub(crate) fn horner(a: &[f64], tau: f64) -> f64 {
    a.iter().rev().fold(0.0, |sum, v| if sum == 0.0 { *v } else { sum * tau + v })
}

impl Form for Power {
    fn degree(&self) -> usize {
        self.a.len() - 1
    }
    fn value(&self, t: f64) -> f64 {
        horner(&self.a, t)
    }
    fn noise(&self, t: f64) -> f64 {
        if self.share == 0.0 {
            return 0.0;
        }
        // The value at 0 is a coefficient, without error; only the other terms are rounded.
        self.share * t * self.a[1..].iter().rev().fold(0.0, |sum, v| sum * t + v.abs())
    }
    fn derivative(&self) -> Self {
        let a = self.a.iter().enumerate().skip(1).map(|(k, v)| k as f64 * v).collect();
        Self { a, share: 0.0 }
    }
    fn changes(&self) -> usize {
        sign_changes(&self.a)
    }
}

/// The roots of `Σ aₖ τᵏ` with τ ≥ 0, increasing.
pub(crate) fn outward_roots(mut a: Vec<f64>) -> Vec<f64> {
    a.truncate(a.iter().rposition(|v| *v != 0.0).map_or(0, |k| k + 1));
    match a[..] {
        [] | [_] => Vec::new(),
        [a0, a1] => {
            let tau = -a0 / a1;
            if tau >= 0.0 { vec![tau] } else { Vec::new() }
        }
        _ => {
            let form = Power::new(a);
            let bound = form.bound();
            roots(&form, bound)
        }
    }
}

/// Verify a root by evaluation: return whichever of `x` and its two neighbouring floating-point numbers has the smallest
/// |f|, if that is at most `noise` or f changes sign among the three. `f` is NaN where it is not defined.
pub(crate) fn verified(x: f64, noise: f64, f: impl Fn(f64) -> f64) -> Option<f64> {
    if !x.is_finite() {
        return None;
    }
    let around = [x.next_down(), x, x.next_up()].map(|x| (x, f(x)));
    let (low, high) = around.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |range, (_, f)| {
        (range.0.min(*f), range.1.max(*f))
    });
    let best = around.iter().min_by(|a, b| {
        let size = |f: f64| if f.is_nan() { f64::INFINITY } else { f.abs() };
        size(a.1).total_cmp(&size(b.1))
    })?;
    (best.1.abs() <= noise || low < 0.0 && high > 0.0).then_some(best.0)
}

/// The roots in [0, end], increasing.
pub(crate) fn roots(form: &impl Form, end: f64) -> Vec<f64> {
    let mut merged = Merged::default();
    merged.add(form, end, Some);
    merged.finish()
}

/// The cuts between which a polynomial is monotone, 0 and `end` among them.
fn cuts<F: Form>(form: &F, end: f64) -> Vec<f64> {
    let mut cuts = vec![0.0];
    let sure = |t: f64| form.value(t).abs() > form.noise(t);
    let changes = form.changes();
    let one_answer = changes <= 1 && sure(0.0) && sure(end);
    if form.degree() > 1 && !one_answer {
        let derivative = form.derivative();
        if derivative.changes() > 0 {
            cuts.extend(roots(&derivative, end).into_iter().filter(|t| *t > 0.0 && *t < end));
        }
    }
    cuts.push(end);
    cuts
}

/// Collects the roots of the pieces of a function from left to right. Zeros on both sides of a knot are one root.
#[derive(Debug, Default)]
pub(crate) struct Merged {
    out: Vec<f64>,
    /// Place and size of the smallest value in the current run of zeros.
    zero: Option<(f64, f64)>,
    /// Whether the run continues a piece that is zero throughout, whose start has been reported.
    reported: bool,
}

impl Merged {
    /// Add the roots of a piece in [0, end], each at the place `at(t)` unless that is `None`.
    pub(crate) fn add<F: Form>(&mut self, form: &F, end: f64, at: impl Fn(f64) -> Option<f64>) {
        let mut before: Option<(f64, f64)> = None;
        for t in cuts(form, end) {
            let value = form.value(t);
            if value.is_finite() && value.abs() <= form.noise(t) {
                if self.zero.is_none_or(|(_, best)| value.abs() < best) {
                    self.zero = at(t).map(|place| (place, value.abs())).or(self.zero);
                }
                before = None;
                continue;
            }
            self.close();
            if let Some((t0, value0)) = before
                && (value0 < 0.0) != (value < 0.0)
            {
                let of = |t: f64| (form.value(t), f64::NAN);
                let root = bracketed_root(of, [t0, t], [value0, value], f64::NAN, [0.0; 2]);
                self.out.extend(at(root));
            }
            before = Some((t, value));
        }
    }

    /// Add a piece that is zero throughout: its start, then NaN.
    pub(crate) fn add_zero(&mut self, place: f64) {
        self.zero = None;
        self.reported = true;
        self.out.extend([place, f64::NAN]);
    }

    /// End the current run of zeros, which is one root.
    pub(crate) fn close(&mut self) {
        if let Some((place, _)) = self.zero.take()
            && !self.reported
        {
            self.out.push(place);
        }
        self.reported = false;
    }

    pub(crate) fn finish(mut self) -> Vec<f64> {
        self.close();
        self.out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of a polynomial given by its roots.
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

    fn inside(b: &[f64]) -> Vec<f64> {
        roots(&Bernstein::less(b, 0.0), 1.0)
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
            vec![0.3, 0.3, 0.8, 0.8],
            vec![0.1, 0.1],
            vec![1e-9, 0.7],
            vec![0.6, 0.6, 0.6],
        ] {
            let found = inside(&with_roots(&planted));
            let mut expected: Vec<f64> =
                planted.iter().copied().filter(|r| (0.0..=1.0).contains(r)).collect();
            expected.dedup();
            assert_eq!(found.len(), expected.len(), "{planted:?}: {found:?}");
            let multiple = planted.len() - expected.len();
            let room = if multiple > 1 { 1e-4 } else { 1e-7 };
            for (a, e) in found.iter().zip(&expected) {
                assert!((a - e).abs() < room, "{planted:?}: {found:?}");
            }
        }
    }

    #[test]
    fn outside_roots_come_back() {
        let b = with_roots(&[-2.0, 0.5, 1.5, 40.0]);
        let right = outward_roots(bernstein::taylor(&b, true));
        assert_eq!(right.len(), 2);
        assert!((right[0] - 0.5).abs() < 1e-13 && (right[1] - 39.0).abs() < 1e-11, "{right:?}");
        let left = outward_roots(bernstein::taylor(&b, false));
        assert_eq!(left.len(), 1);
        assert!((left[0] - 2.0).abs() < 1e-12, "{left:?}");
    }

    #[test]
    fn roots_of_any_size_come_back() {
        for tau in [1e-200, 1e-9, 3.0, 1e20, 1e150] {
            let found = outward_roots(vec![-tau, 1.0]);
            assert!((found[0] / tau - 1.0).abs() < 1e-15);
            // (τ − r)(τ² + r²)
            let found = outward_roots(vec![-tau * tau * tau, tau * tau, -tau, 1.0]);
            if (tau * tau * tau).is_normal() {
                assert!(found.len() == 1 && (found[0] / tau - 1.0).abs() < 1e-14, "{found:?}");
            }
        }
        assert!(outward_roots(vec![1.0, 0.0, 1.0]).is_empty());
        // One that is touched, far away.
        let found = outward_roots(vec![2500.0, -100.0, 1.0]);
        assert!(found.len() == 1 && (found[0] - 50.0).abs() < 1e-6, "{found:?}");
    }
}
