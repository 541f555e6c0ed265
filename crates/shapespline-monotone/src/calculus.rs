// SPDX-License-Identifier: MIT OR Apache-2.0

//! Derivatives, integrals and solutions of the interpolants.

use crate::beyond::Beyond;
use crate::data::{PowerOfTwo, exponent};
use crate::extrapolation::{Continuation, Extrapolation};
use crate::integrals::{Pieces, whole};
use crate::piecewise::PiecewisePolynomial;
use crate::spline::{MonotoneKind, MonotoneSpline};
use shapespline_polynomial::{bernstein, quadratic};

impl MonotoneSpline {
    /// Bernstein coefficients of the first derivative, scaled; its ends are the slopes to the last bit.
    fn slope_coefficients(&self, i: usize) -> ([f64; 5], usize) {
        let h = self.scaled_length(i);
        let (d0, d1) = (self.d[i], self.d[i + 1]);
        let secant = self.units.rise().scale(self.y[i + 1] - self.y[i]) / h;
        match &self.kind {
            MonotoneKind::Quartic { e } => {
                let e = self.units.rise().scale(e[i]) / h;
                ([d0, 2.0 * secant - d0 + e, 2.0 * secant - d1 - e, d1, 0.0], 3)
            }
            MonotoneKind::Cubic { z } => {
                // From both ends: they differ by rounding.
                let [z0, z1] = z[i];
                ([d0, 0.5 * ((d0 + 0.5 * (h * z0)) + (d1 - 0.5 * (h * z1))), d1, 0.0, 0.0], 2)
            }
            MonotoneKind::Quintic { s } => {
                let (b, c) = (d0 + 0.25 * (h * s[i]), d1 - 0.25 * (h * s[i + 1]));
                ([d0, b, 5.0 * secant - ((d0 + b) + (c + d1)), c, d1], 4)
            }
        }
    }

    /// Bernstein coefficients of `h²` times the second derivative, in scaled units of y.
    fn second_coefficients(&self, i: usize) -> ([f64; 4], usize) {
        let h = self.scaled_length(i);
        let dy = self.units.rise().scale(self.y[i + 1] - self.y[i]);
        let (m0, m1) = (h * self.d[i], h * self.d[i + 1]);
        match &self.kind {
            MonotoneKind::Quartic { e } => {
                let e = self.units.rise().scale(e[i]);
                let (b, c) = (2.0 * dy - m0 + e, 2.0 * dy - m1 - e);
                ([3.0 * (b - m0), 3.0 * (c - b), 3.0 * (m1 - c), 0.0], 2)
            }
            MonotoneKind::Cubic { z } => {
                let [k0, k1] = z[i].map(|z| h * (h * z));
                ([k0, k1, 0.0, 0.0], 1)
            }
            MonotoneKind::Quintic { s } => {
                let (k0, k1) = (h * (h * s[i]), h * (h * s[i + 1]));
                let (b, d) = (m0 + 0.25 * k0, m1 - 0.25 * k1);
                let c = 5.0 * dy - ((m0 + b) + (d + m1));
                ([k0, 4.0 * (c - b), 4.0 * (d - c), k1], 3)
            }
        }
    }

    /// Bernstein coefficients of the derivative of an order from 1 to the degree, in units that [`Self::derivative_out`]
    /// turns into those of the data, and their degree.
    fn unscaled_coefficients(&self, i: usize, nu: usize) -> ([f64; 5], usize) {
        if nu == 1 {
            return self.slope_coefficients(i);
        }
        let ([c0, c1, c2, c3], mut degree) = self.second_coefficients(i);
        let mut c = [c0, c1, c2, c3, 0.0];
        for _ in 2..nu {
            for k in 0..degree {
                c[k] = degree as f64 * (c[k + 1] - c[k]);
            }
            degree -= 1;
        }
        (c, degree)
    }

    /// A derivative of order `nu` ≥ 1 on segment i in the data's units: a scaled slope, or else `h^nu` times the derivative
    /// in scaled units of y. Only a result out of range leaves the range.
    fn derivative_out(&self, i: usize, value: f64, nu: usize) -> f64 {
        if nu == 1 {
            return self.units.derivative_out(value, 1);
        }
        let h = self.x[i + 1] - self.x[i];
        let e = exponent(h);
        let h = PowerOfTwo::new(-e).scale(h);
        let unit = PowerOfTwo::new(self.units.ey - nu as i32 * e);
        unit.scale((0..nu).fold(value, |v, _| v / h))
    }

    /// The second derivatives at the ends of segment i where they are stored: to the last bit, so that neighbours agree.
    fn stored_seconds(&self, i: usize) -> Option<[f64; 2]> {
        match &self.kind {
            MonotoneKind::Quintic { s } => {
                Some([i, i + 1].map(|j| self.units.derivative_out(s[j], 2)))
            }
            MonotoneKind::Cubic { z } => Some(z[i].map(|z| self.units.derivative_out(z, 2))),
            MonotoneKind::Quartic { .. } => None,
        }
    }

    /// Bernstein coefficients of the derivative of an order from 1 to the degree, in the data's units, and their degree.
    fn derivative_coefficients(&self, i: usize, nu: usize) -> ([f64; 5], usize) {
        let (mut c, degree) = self.unscaled_coefficients(i, nu);
        for c in &mut c[..=degree] {
            *c = self.derivative_out(i, *c, nu);
        }
        if let (2, Some([s0, s1])) = (nu, self.stored_seconds(i)) {
            (c[0], c[degree]) = (s0, s1);
        }
        (c, degree)
    }

    /// Derivative of order ≥ 1 of piece i in its segment.
    pub(crate) fn derivative_at(&self, i: usize, x: f64, nu: usize) -> f64 {
        if nu > self.degree() {
            return 0.0;
        }
        let t = self.polynomials[i].local(x);
        if let (true, 2, Some(s)) = (t == 0.0 || t == 1.0, nu, self.stored_seconds(i)) {
            return s[usize::from(t == 1.0)];
        }
        let (c, degree) = self.unscaled_coefficients(i, nu);
        let value = if nu == 1 && matches!(self.kind, MonotoneKind::Cubic { .. }) {
            // What rounding leaves of a slope of the wrong sign is none.
            let rises = self.y[i + 1] >= self.y[i];
            let value = quadratic::value([c[0], c[1], c[2]], t);
            if rises { value.max(0.0) } else { value.min(0.0) }
        } else {
            bernstein::value(&c[..=degree], t)
        };
        self.derivative_out(i, value, nu)
    }

    /// What the derivative of order `nu` is beyond an end of the knots, where that is a polynomial.
    pub(crate) fn beyond(&self, right: bool, nu: usize, mode: Continuation) -> Option<Beyond> {
        let n = self.polynomials.len();
        let i = if right { n - 1 } else { 0 };
        let end = [self.x[i], self.x[i + 1]];
        if nu > self.degree() {
            return Beyond::new(&[0.0], [0.0; 2], end, right, mode);
        }
        if nu > 0 {
            let (c, degree) = self.derivative_coefficients(i, nu);
            return Beyond::new(&c[..=degree], [0.0; 2], end, right, mode);
        }
        let (base, dy) = (self.y[if right { n } else { 0 }], self.y[i + 1] - self.y[i]);
        let (y0, y1) = if right { (-dy, 0.0) } else { (0.0, dy) };
        // The slope at the inner end has the rounding of the neighbour's secant.
        let near = if right { n.saturating_sub(2) } else { 1.min(n - 1) };
        let lever = 1.0 + (end[1] - end[0]) / (self.x[near + 1] - self.x[near]);
        let size =
            [i, i + 1, near, near + 1].map(|k| self.y[k].abs()).into_iter().fold(0.0, f64::max);
        let base = [base, f64::EPSILON * size * lever];
        Beyond::new(&self.piece_between(i, y0, y1)[..=self.degree()], base, end, right, mode)
    }

    /// The derivative of order `nu` as a function. O(N).
    #[must_use]
    pub fn derivative(&self, nu: usize) -> PiecewisePolynomial {
        if nu == 0 {
            return self.to_piecewise();
        }
        let mode =
            (0..nu.min(self.degree() + 1)).fold(self.extrapolate, |mode, _| mode.derivative());
        let n = self.polynomials.len();
        if nu > self.degree() {
            return PiecewisePolynomial::new(self.x.clone(), 0, vec![0.0; n], mode);
        }
        let degree = self.degree() - nu;
        let mut c = Vec::with_capacity(n * (degree + 1));
        for i in 0..n {
            c.extend_from_slice(&self.derivative_coefficients(i, nu).0[..=degree]);
        }
        PiecewisePolynomial::new(self.x.clone(), degree, c, mode)
    }

    /// An antiderivative of order `nu`, zero at the first knot. O(N).
    #[must_use]
    pub fn antiderivative(&self, nu: usize) -> PiecewisePolynomial {
        self.to_piecewise().antiderivative(nu)
    }

    /// `∫ₐᵇ f dx`, also for a > b and outside the data as the extrapolation says; NaN for NaN, and for an infinite end the
    /// limit (NaN where there is none). O(log N), after a first call of O(N).
    #[must_use]
    pub fn integrate(&self, a: f64, b: f64, extrapolate: Option<Extrapolation>) -> f64 {
        let n = self.polynomials.len();
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
            beyond: |right, mode| self.beyond(right, 0, mode),
        };
        pieces.integrate(a, b, extrapolate.unwrap_or(self.extrapolate))
    }

    /// All roots: [`Self::solve`] with y = 0.
    #[must_use]
    pub fn roots(&self, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        self.solve(0.0, extrapolate)
    }

    /// All x with f(x) = y, increasing, each once; where f equals y on a whole segment its start followed by NaN, as
    /// SciPy's `PPoly.solve` does. Solutions outside the data follow the extrapolation; of a function that repeats those
    /// on the knots are meant, and of a half line on which f equals y the knot alone. O(N): a segment is monotone, so it
    /// is searched only when y lies between its ends.
    ///
    /// At every solution f is y up to some units in the last place of the data's range, or passes y between the
    /// neighbouring floating-point numbers.
    #[must_use]
    pub fn solve(&self, y: f64, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let n = self.polynomials.len();
        if y.is_nan() {
            return Vec::new();
        }
        let value = |x: f64| self.evaluate(x, 0, Some(mode));
        let beyond = |right: bool| {
            let part = self.beyond(right, 0, mode.side(right));
            part.map_or_else(Vec::new, |part| part.solve(y, value))
        };
        let mut out: Vec<f64> = beyond(false).into_iter().rev().collect();
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
                if i == 0 && out.last().is_none_or(|last| *last != self.x[0]) {
                    out.push(self.x[0]);
                }
            } else if b == y {
                out.push(self.x[i + 1]);
            } else if (a < y) == (y < b) {
                out.push(self.invert_in(i, y));
            }
        }
        let last = out.iter().rev().copied().find(|x| !x.is_nan());
        out.extend(beyond(true).into_iter().filter(|x| last.is_none_or(|last| *x > last)));
        out
    }
}
