//! Derivatives, integrals and solutions of the interpolants.

use crate::bernstein;
use crate::extrapolation::Extrapolation;
use crate::integrals::{Pieces, whole};
use crate::piecewise::PiecewisePolynomial;
use crate::spline::{Kind, MonotoneSpline};

impl MonotoneSpline {
    /// Bernstein coefficients of the first derivative; its ends are the slopes to the last bit.
    fn slope_coefficients(&self, i: usize) -> ([f64; 5], usize) {
        let h = self.x[i + 1] - self.x[i];
        let (d0, d1) = (self.d[i], self.d[i + 1]);
        let secant = (self.y[i + 1] - self.y[i]) / h;
        match &self.kind {
            Kind::Quartic { e } => {
                let e = e[i] / h;
                ([d0, 2.0 * secant - d0 + e, 2.0 * secant - d1 - e, d1, 0.0], 3)
            }
            Kind::Quintic { s } => {
                let (b, c) = (d0 + 0.25 * (h * s[i]), d1 - 0.25 * (h * s[i + 1]));
                ([d0, b, 5.0 * secant - ((d0 + b) + (c + d1)), c, d1], 4)
            }
        }
    }

    /// `h²` times the second derivative's Bernstein coefficients, in units of y: no overflow on the way.
    fn second_coefficients(&self, i: usize) -> ([f64; 4], usize) {
        let h = self.x[i + 1] - self.x[i];
        let dy = self.y[i + 1] - self.y[i];
        let (m0, m1) = (h * self.d[i], h * self.d[i + 1]);
        match &self.kind {
            Kind::Quartic { e } => {
                let (b, c) = (2.0 * dy - m0 + e[i], 2.0 * dy - m1 - e[i]);
                ([3.0 * (b - m0), 3.0 * (c - b), 3.0 * (m1 - c), 0.0], 2)
            }
            Kind::Quintic { s } => {
                let (k0, k1) = (h * (h * s[i]), h * (h * s[i + 1]));
                let (b, d) = (m0 + 0.25 * k0, m1 - 0.25 * k1);
                let c = 5.0 * dy - ((m0 + b) + (d + m1));
                ([k0, 4.0 * (c - b), 4.0 * (d - c), k1], 3)
            }
        }
    }

    /// Derivative of order ≥ 1 of piece i, inside or outside its segment.
    pub(crate) fn derivative_at(&self, i: usize, x: f64, nu: usize) -> f64 {
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        if nu == 1 {
            let (c, degree) = self.slope_coefficients(i);
            return bernstein::value(&c[..=degree], t);
        }
        if nu > self.degree() {
            return 0.0;
        }
        if let (Kind::Quintic { s }, 2) = (&self.kind, nu) {
            // To the last bit, so that neighbours agree.
            if t == 0.0 || t == 1.0 {
                return s[i + usize::from(t == 1.0)];
            }
        }
        let (mut c, mut degree) = self.second_coefficients(i);
        for _ in 2..nu {
            for k in 0..degree {
                c[k] = degree as f64 * (c[k + 1] - c[k]);
            }
            degree -= 1;
        }
        (0..nu).fold(bernstein::value(&c[..=degree], t), |v, _| v / h)
    }

    /// The derivative of order `nu` as a function. O(N).
    #[must_use]
    pub fn derivative(&self, nu: usize) -> PiecewisePolynomial {
        if nu == 0 {
            return self.to_piecewise();
        }
        let mut c = Vec::with_capacity(self.records.len() * self.degree());
        for i in 0..self.records.len() {
            let (piece, degree) = self.slope_coefficients(i);
            c.extend_from_slice(&piece[..=degree]);
        }
        let mode = self.extrapolate.derivative();
        if nu == 1 {
            return PiecewisePolynomial::new(self.x.clone(), self.degree() - 1, c, mode);
        }
        c.clear();
        for i in 0..self.records.len() {
            let h = self.x[i + 1] - self.x[i];
            let (piece, degree) = self.second_coefficients(i);
            c.extend(piece[..=degree].iter().map(|v| v / h / h));
            if let Kind::Quintic { s } = &self.kind {
                // To the last bit, so that neighbours agree.
                let end = c.len() - 1;
                (c[end - 3], c[end]) = (s[i], s[i + 1]);
            }
        }
        let mode = mode.derivative();
        PiecewisePolynomial::new(self.x.clone(), self.degree() - 2, c, mode).derivative(nu - 2)
    }

    /// An antiderivative of order `nu`, zero at the first knot. O(N).
    #[must_use]
    pub fn antiderivative(&self, nu: usize) -> PiecewisePolynomial {
        self.to_piecewise().antiderivative(nu)
    }

    /// `∫ₐᵇ f dx`, also for a > b and outside the data as the extrapolation says. O(log N), after a first call of O(N).
    #[must_use]
    pub fn integrate(&self, a: f64, b: f64, extrapolate: Option<Extrapolation>) -> f64 {
        let n = self.records.len();
        let pieces = Pieces {
            x: &self.x,
            search: self.searcher(false),
            degree: self.degree(),
            piece: |i: usize| self.piece(i),
            sums: || {
                let h = |i: usize| self.x[i + 1] - self.x[i];
                let integral = |i: usize| whole(&self.piece(i)[..=self.degree()], h(i));
                self.cached.integrals.get(n, integral)
            },
        };
        pieces.integrate(a, b, extrapolate.unwrap_or(self.extrapolate))
    }

    /// All roots: [`Self::solve`] with y = 0.
    #[must_use]
    pub fn roots(&self, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        self.solve(0.0, extrapolate)
    }

    /// All x with f(x) = y, increasing, each once; where f equals y on a whole segment its start followed by NaN, as
    /// SciPy's `PPoly.solve` does. Solutions outside the data follow the extrapolation. O(N): a segment is monotone,
    /// so it is looked into only when y lies between its ends.
    #[must_use]
    pub fn solve(&self, y: f64, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let n = self.records.len();
        if y.is_nan() {
            return Vec::new();
        }
        let (first, last) = (self.x[0], self.x[n]);
        let mut out: Vec<f64> =
            self.end_piece(0).solve(y, Some(mode)).into_iter().filter(|x| *x < first).collect();
        for i in 0..n {
            let (a, b) = (self.y[i], self.y[i + 1]);
            if a == y && b == y {
                if out.last().is_none_or(|last| *last != self.x[i]) {
                    out.push(self.x[i]);
                }
                if !out.last().is_some_and(|v| v.is_nan()) {
                    out.push(f64::NAN);
                }
                continue;
            }
            if a == y {
                // The end of the segment before has reported it unless this is the first.
                let reported = i > 0 && self.y[i] == y;
                if !reported {
                    out.push(self.x[i]);
                }
            } else if b == y {
                out.push(self.x[i + 1]);
            } else if (a < y) == (y < b) {
                out.push(self.invert_in(i, y));
            }
        }
        let beyond = self.end_piece(n - 1).solve(y, Some(mode));
        out.extend(beyond.into_iter().filter(|x| *x > last));
        out
    }
}
