// SPDX-License-Identifier: MIT OR Apache-2.0

//! Bernstein polynomials of any degree, with scalar or vector coefficients and a bound on what
//! rounding did to them.
//!
//! Products of Bernstein polynomials are exact in their coefficients up to rounding; the bound says
//! how far rounding can have moved a coefficient, so that a sign is called proved only where it
//! exceeds the bound, and refuted likewise. What remains is left open, with its interval.

use crate::{
    Sign,
    bernstein::{self, Coefficient, binomials, split},
    sign::DEPTH,
};

/// A polynomial on `[0, 1]` in Bernstein form.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial<T> {
    coefficients: Vec<T>,
    /// Bound of the rounding error of each coefficient.
    error: f64,
}

impl<T: Coefficient> Polynomial<T> {
    /// The polynomial of coefficients that carry an error of at most `error` each; there is at least
    /// one coefficient (none stands for zero).
    #[must_use]
    pub fn new(mut coefficients: Vec<T>, error: f64) -> Self {
        if coefficients.is_empty() {
            coefficients.push(T::default());
        }
        Self { coefficients, error }
    }

    /// The Bernstein coefficients.
    #[must_use]
    pub fn coefficients(&self) -> &[T] {
        &self.coefficients
    }

    /// The bound on rounding errors of the coefficients.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.error
    }

    /// The degree of the representation.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// The values at 0 and at 1.
    #[must_use]
    pub fn ends(&self) -> [T; 2] {
        [self.coefficients[0], self.coefficients[self.degree()]]
    }

    /// Size of the largest coefficient: no value on `[0, 1]` is larger.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |m, c| m.max(c.size()))
    }

    /// The derivative.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let n = self.degree() as f64;
        let mut derivative = Self::new(bernstein::derivative(&self.coefficients), 0.0);
        derivative.error = n * 2.0 * self.error + 2.0 * f64::EPSILON * derivative.bound();
        derivative
    }

    /// The product with another polynomial, for any product of coefficients.
    #[must_use]
    pub fn product<U: Coefficient, V: Coefficient>(
        &self,
        other: &Polynomial<U>,
        multiply: impl Fn(T, U) -> V,
    ) -> Polynomial<V> {
        let (m, n) = (self.degree(), other.degree());
        let (rows, columns, all) = (binomials(m), binomials(n), binomials(m + n));
        let mut c = vec![V::default(); m + n + 1];
        for (i, &p) in self.coefficients.iter().enumerate() {
            for (j, &q) in other.coefficients.iter().enumerate() {
                c[i + j] = c[i + j] + multiply(p, q) * (rows[i] * columns[j] / all[i + j]);
            }
        }
        let (a, b) = (self.bound(), other.bound());
        let rounding = (8 + m.min(n)) as f64 * f64::EPSILON;
        Polynomial { coefficients: c, error: self.error * b + other.error * a + rounding * a * b }
    }

    /// A linear map of the coefficients whose norm is at most `norm`.
    #[must_use]
    pub fn map<U: Coefficient>(&self, norm: f64, f: impl Fn(T) -> U) -> Polynomial<U> {
        let coefficients = self.coefficients.iter().map(|&c| f(c)).collect();
        let error = norm * (self.error + 4.0 * f64::EPSILON * self.bound());
        Polynomial { coefficients, error }
    }

    /// The sum with another polynomial of the same degree, times a factor.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        let pairs = self.coefficients.iter().zip(&other.coefficients);
        let c: Vec<T> = pairs.map(|(&a, &b)| a + b * factor).collect();
        let rounding = 2.0 * f64::EPSILON * (self.bound() + factor.abs() * other.bound());
        Self::new(c, self.error + factor.abs() * other.error + rounding)
    }

    /// The polynomial divided by `t`, where its first coefficient is zero.
    #[must_use]
    pub fn divided_by_t(&self) -> Self {
        let n = self.degree() as f64;
        let quotient = |(k, c): (usize, &T)| *c * (n / (k + 1) as f64);
        let c = self.coefficients.iter().skip(1).enumerate().map(quotient).collect();
        let mut quotient = Self::new(c, 0.0);
        quotient.error = n * self.error + 2.0 * f64::EPSILON * quotient.bound();
        quotient
    }

    /// The polynomial divided by `1 − t`, where its last coefficient is zero.
    #[must_use]
    pub fn divided_by_rest(&self) -> Self {
        let backwards =
            |p: &Self| Self::new(p.coefficients.iter().rev().copied().collect(), p.error);
        backwards(&backwards(self).divided_by_t())
    }

    /// The value at `t`, by de Casteljau's algorithm.
    #[must_use]
    pub fn value(&self, t: f64) -> T {
        bernstein::value(&self.coefficients, t)
    }

    /// The polynomial on the part `[from, to]` of its interval.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let c = bernstein::part(self.coefficients.clone(), [from, to]);
        let rounding = 2.0 * f64::EPSILON * self.degree() as f64 * self.bound();
        Self::new(c, self.error + rounding)
    }

    /// The two halves.
    #[must_use]
    pub fn halves(&self) -> [Self; 2] {
        let (left, right) = split(self.coefficients.clone(), 0.5);
        // Halving adds no more than the subdivision's own rounding, which stays below the bound.
        [Self::new(left, self.error), Self::new(right, self.error)]
    }
}

impl Polynomial<f64> {
    /// Whether every coefficient exceeds the bound on its error: then the polynomial is positive.
    #[must_use]
    pub fn is_clearly_positive(&self) -> bool {
        self.coefficients.iter().all(|&c| c > self.error)
    }

    /// Whether the polynomial is positive on all of `[0, 1]`.
    ///
    /// A value that is exactly zero fails, one that is zero to rounding leaves the question open.
    #[must_use]
    pub fn sign(&self) -> Sign {
        Sign::with_error(&self.coefficients, self.error)
    }

    /// The strict sign changes on `[0, 1]`, as the signs that the polynomial takes in turn, and
    /// whether a double root (or what looks like one) was passed over as no change.
    #[must_use]
    pub fn signs(&self) -> (Vec<bool>, bool) {
        let (mut signs, mut open) = (Vec::new(), false);
        collect(self, DEPTH, &mut signs, &mut open);
        (signs, open)
    }
}

fn collect(p: &Polynomial<f64>, depth: u32, signs: &mut Vec<bool>, open: &mut bool) {
    let clear = || p.coefficients.iter().filter(|c| c.abs() > p.error).map(|&c| c > 0.0);
    let push = |signs: &mut Vec<bool>, sign: bool| {
        if signs.last() != Some(&sign) {
            signs.push(sign);
        }
    };
    let changes = clear().zip(clear().skip(1)).filter(|(a, b)| a != b).count();
    let [first, last] = p.ends().map(|x| x.abs() > p.error);
    // No change of the coefficients: none of the polynomial; one between clear ends: one.
    if changes == 0 || (changes == 1 && first && last) {
        clear().for_each(|sign| push(signs, sign));
        return;
    }
    if depth == 0 {
        *open = true;
        for value in p.ends() {
            if value.abs() > p.error {
                push(signs, value > 0.0);
            }
        }
        return;
    }
    for half in p.halves() {
        collect(&half, depth - 1, signs, open);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polynomial(c: &[f64]) -> Polynomial<f64> {
        Polynomial::new(c.to_vec(), 0.0)
    }

    /// Bernstein coefficients of `∏ (t − r)`.
    fn planted(roots: &[f64]) -> Polynomial<f64> {
        roots
            .iter()
            .map(|&r| polynomial(&[-r, 1.0 - r]))
            .reduce(|p, q| p.product(&q, |a, b| a * b))
            .unwrap()
    }

    proptest! {
        #[test]
        fn operations_have_the_right_values(
            p in proptest::collection::vec(-1.0..1.0f64, 1..8),
            q in proptest::collection::vec(-1.0..1.0f64, 1..8),
            t in 0.0..1.0f64, f in 0.0..0.4f64, g in 0.5..1.0f64,
        ) {
            let (p, q) = (polynomial(&p), polynomial(&q));
            let product = p.product(&q, |a, b| a * b);
            prop_assert!((product.value(t) - p.value(t) * q.value(t)).abs() < 1e-13);
            prop_assert!((p.part(f, g).value(t) - p.value(f + t * (g - f))).abs() < 1e-13);
            let h = 1e-6;
            let slope = (p.value(t + h) - p.value(t - h)) / (2.0 * h);
            prop_assert!((p.derivative().value(t) - slope).abs() < 1e-4);
            let times_t = p.product(&polynomial(&[0.0, 1.0]), |a, b| a * b);
            prop_assert!((times_t.divided_by_t().value(t) - p.value(t)).abs() < 1e-12);
            let times_rest = p.product(&polynomial(&[1.0, 0.0]), |a, b| a * b);
            prop_assert!((times_rest.divided_by_rest().value(t) - p.value(t)).abs() < 1e-12);
        }

        #[test]
        fn planted_roots_decide(roots in proptest::collection::vec(-1.0..2.0f64, 1..7)) {
            let mut sorted = roots.clone();
            sorted.extend([0.0, 1.0]);
            sorted.sort_by(f64::total_cmp);
            prop_assume!(sorted.windows(2).all(|w| w[1] - w[0] > 1e-3));
            let p = planted(&roots);
            let inside = roots.iter().filter(|r| (0.0..1.0).contains(*r)).count();
            let (signs, open) = p.signs();
            prop_assert!(!open);
            prop_assert_eq!(signs.len(), inside + 1);
            prop_assert_eq!(*signs.last().unwrap(), p.ends()[1] > 0.0);
            let positive = inside == 0 && p.ends()[0] > 0.0;
            prop_assert_eq!(p.sign() == Sign::Positive, positive);
        }
    }

    #[test]
    fn a_double_root_stays_open_and_zero_fails() {
        let p = planted(&[1.0 / 3.0, 1.0 / 3.0]);
        match p.sign() {
            Sign::Undecided { from, to } => assert!(from <= 1.0 / 3.0 && to - from < 1e-6),
            // The rounded polynomial may dip below zero by more than its error bound: never.
            other => panic!("{other:?}"),
        }
        assert_eq!(p.signs().0, [true]);
        assert_eq!(polynomial(&[0.0, 0.0]).sign(), Sign::Fails { at: 0.0 });
        assert_eq!(polynomial(&[0.0, 1.0]).sign(), Sign::Fails { at: 0.0 });
        assert_eq!(polynomial(&[f64::NAN, 1.0]).sign(), Sign::Fails { at: 0.0 });
    }
}
