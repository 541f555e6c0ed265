// SPDX-License-Identifier: MIT OR Apache-2.0

//! Piecewise polynomials in Bernstein form: what derivatives and antiderivatives of the interpolants are.

use crate::beyond::Beyond;
use crate::chunked::{self, TILE};
use crate::extrapolation::{Continuation, Extrapolation};
use crate::integrals::{Lazy, Pieces, whole};
use crate::periodic;
use crate::roots::{Bernstein, Merged, verified};
use shapespline_polynomial::knots::Locator;
use shapespline_polynomial::{bernstein, quadratic};

/// Tiles that one thread works through at least.
const TILES: usize = 128;

/// A piecewise polynomial `Σₖ cₖ Bₖⁿ((x − xᵢ)/hᵢ)` on increasing knots.
///
/// The counterpart of SciPy's `BPoly`. Made by [`crate::MonotoneSpline::derivative`] and
/// [`crate::MonotoneSpline::antiderivative`]; immutable, `Send + Sync`.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Parts", into = "Parts"))]
pub struct PiecewisePolynomial {
    x: Vec<f64>,
    degree: usize,
    /// `degree + 1` a segment.
    c: Vec<f64>,
    extrapolate: Extrapolation,
    locator: Locator,
    sums: Lazy,
}

/// The stored form.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
struct Parts {
    x: Vec<f64>,
    degree: usize,
    c: Vec<f64>,
    extrapolate: Extrapolation,
}

#[cfg(feature = "serde")]
impl From<PiecewisePolynomial> for Parts {
    fn from(p: PiecewisePolynomial) -> Self {
        Self { x: p.x, degree: p.degree, c: p.c, extrapolate: p.extrapolate }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Parts> for PiecewisePolynomial {
    type Error = String;
    fn try_from(p: Parts) -> Result<Self, String> {
        if p.x.len() < 2 || p.c.len() != (p.x.len() - 1).saturating_mul(p.degree.saturating_add(1))
        {
            return Err("stored piecewise polynomial is inconsistent".to_owned());
        }
        let zeros = vec![0.0; p.x.len()];
        crate::data::check(&p.x, &zeros).map_err(|error| format!("stored polynomial: {error}"))?;
        Ok(Self::new(p.x, p.degree, p.c, p.extrapolate))
    }
}

impl PiecewisePolynomial {
    pub(crate) fn new(x: Vec<f64>, degree: usize, c: Vec<f64>, extrapolate: Extrapolation) -> Self {
        Self { x, degree, c, extrapolate, locator: Locator::default(), sums: Lazy::default() }
    }

    /// The knots.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// The degree of the pieces.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Bernstein coefficients, `degree + 1` a segment.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.c
    }

    /// What it is outside the knots.
    #[must_use]
    pub fn extrapolation(&self) -> Extrapolation {
        self.extrapolate
    }

    fn piece(&self, i: usize) -> &[f64] {
        &self.c[i * (self.degree + 1)..(i + 1) * (self.degree + 1)]
    }

    fn h(&self, i: usize) -> f64 {
        self.x[i + 1] - self.x[i]
    }

    /// The derivative of order `nu` at `x`. NaN gives NaN. O(log N).
    #[must_use]
    pub fn evaluate(&self, x: f64, nu: usize, extrapolate: Option<Extrapolation>) -> f64 {
        let mut out = [0.0];
        self.evaluate_into(&[x], nu, extrapolate, &mut out);
        out[0]
    }

    /// The derivative of order `nu` at every query. `out` must have the queries' length; extra entries of the longer
    /// are left alone.
    pub fn evaluate_into(
        &self,
        queries: &[f64],
        nu: usize,
        extrapolate: Option<Extrapolation>,
        out: &mut [f64],
    ) {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let search = self.locator.searcher(&self.x, queries.len().min(out.len()) > TILE);
        chunked::fill(queries, out, TILES, |q, out| {
            let mut segments = [0; TILE];
            search.tile(q, q.is_sorted(), &mut segments);
            for ((value, &x), &i) in out.iter_mut().zip(q).zip(&segments) {
                *value = self.at(i, x, nu, mode);
            }
        });
    }

    fn at(&self, i: usize, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        if x.is_nan() {
            return f64::NAN;
        }
        let last = self.x.len() - 1;
        if x < self.x[0] || x > self.x[last] {
            return self.outside(x, nu, mode);
        }
        if nu > self.degree {
            return 0.0;
        }
        let t = (x - self.x[i]) / self.h(i);
        if let (0, &[a, b, c]) = (nu, self.piece(i)) {
            return quadratic::value([a, b, c], t);
        }
        if nu == 0 {
            return bernstein::value(self.piece(i), t);
        }
        let mut c = self.piece(i).to_vec();
        for _ in 0..nu {
            c = bernstein::derivative(&c);
        }
        let v = bernstein::value(&c, t);
        (0..nu).fold(v, |v, _| v / self.h(i))
    }

    #[cold]
    fn outside(&self, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        let last = self.x.len() - 1;
        let right = x > self.x[last];
        let mode = mode.side(right);
        if let Continuation::Periodic(order) = mode {
            let (count, place) = periodic::wrapped(x, self.x[0], self.x[last]);
            let value = self.evaluate(place, nu, Some(Extrapolation::NAN));
            if nu >= order {
                return value;
            }
            let rise = |j: usize| {
                self.at(last - 1, self.x[last], j, Extrapolation::NAN)
                    - self.at(0, self.x[0], j, Extrapolation::NAN)
            };
            let rises: Vec<f64> = (0..order).map(rise).collect();
            let c = periodic::accumulated(&rises, count, self.x[last] - self.x[0]);
            return value + periodic::polynomial(&c, place - self.x[0], nu);
        }
        self.beyond(right, mode).map_or(f64::NAN, |part| part.evaluate(x, nu))
    }

    /// What it is beyond an end of the knots, where that is a polynomial.
    fn beyond(&self, right: bool, mode: Continuation) -> Option<Beyond> {
        let i = if right { self.x.len() - 2 } else { 0 };
        Beyond::new(self.piece(i), [0.0; 2], [self.x[i], self.x[i + 1]], right, mode)
    }

    /// The derivative of order `nu` as a piecewise polynomial. O(N).
    #[must_use]
    pub fn derivative(&self, nu: usize) -> Self {
        let mut out = self.clone();
        // Beyond the degree all are zero, outside the knots only if they are zero there too.
        for _ in 0..nu.min(self.degree + 1) {
            let mut c = Vec::with_capacity(out.c.len());
            for i in 0..out.x.len() - 1 {
                let h = out.h(i);
                c.extend(bernstein::derivative(out.piece(i)).iter().map(|v| v / h));
            }
            let degree = out.degree.saturating_sub(1);
            out = Self::new(out.x, degree, c, out.extrapolate.derivative());
        }
        out
    }

    /// The same function as pieces between these knots, its own among them. O(knots).
    #[must_use]
    pub fn refined(&self, knots: &[f64]) -> Self {
        let mut c = Vec::with_capacity(knots.len().saturating_sub(1) * (self.degree + 1));
        let mut i = 0;
        for w in knots.windows(2) {
            while i + 2 < self.x.len() && self.x[i + 1] <= w[0] {
                i += 1;
            }
            let local = |x: f64| ((x - self.x[i]) / self.h(i)).clamp(0.0, 1.0);
            let ends = [local(w[0]), if w[1] >= self.x[i + 1] { 1.0 } else { local(w[1]) }];
            c.extend(bernstein::part(self.piece(i).to_vec(), ends));
        }
        Self::new(knots.to_vec(), self.degree, c, self.extrapolate)
    }

    /// An antiderivative of order `nu`, zero (with its first nu − 1 derivatives) at the first knot. O(N).
    #[must_use]
    pub fn antiderivative(&self, nu: usize) -> Self {
        let mut out = self.clone();
        for _ in 0..nu {
            let degree = out.degree + 1;
            let mut c = Vec::with_capacity((out.x.len() - 1) * (degree + 1));
            let mut sum = 0.0;
            for i in 0..out.x.len() - 1 {
                let step = out.h(i) / degree as f64;
                c.push(sum);
                for v in out.piece(i) {
                    sum += v * step;
                    c.push(sum);
                }
            }
            out = Self::new(out.x, degree, c, out.extrapolate.antiderivative());
        }
        out
    }

    /// `∫ₐᵇ f dx`, also for a > b and outside the knots as the extrapolation says; NaN for NaN, and for an infinite end the
    /// limit (NaN where there is none). O(log N), after a first call of O(N).
    #[must_use]
    pub fn integrate(&self, a: f64, b: f64, extrapolate: Option<Extrapolation>) -> f64 {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let n = self.x.len() - 1;
        let drifts = |side: Continuation| matches!(side, Continuation::Periodic(1..));
        if a.min(b) < self.x[0] && drifts(mode.below) || a.max(b) > self.x[n] && drifts(mode.above)
        {
            let whole = Self { extrapolate: mode, ..self.clone() }.antiderivative(1);
            return whole.evaluate(b, 0, None) - whole.evaluate(a, 0, None);
        }
        let pieces = Pieces {
            x: &self.x,
            search: self.locator.searcher(&self.x, false),
            degree: self.degree,
            piece: |i: usize| self.piece(i),
            sums: || self.sums.get(n, |i| whole(self.piece(i), self.h(i))),
            beyond: |right, mode| self.beyond(right, mode),
        };
        pieces.integrate(a, b, mode)
    }

    /// All x with f(x) = y, increasing, each once; where f is y on a whole segment its start followed by NaN, as SciPy's
    /// `PPoly.solve` does. Solutions outside the knots follow the extrapolation; of a function that repeats those on the
    /// knots are meant. O(N).
    ///
    /// Where rounding cannot tell f from y around a place, that is one solution. At every solution f is y up to some units
    /// in the last place of the segment's values, or passes y between the neighbouring floating-point numbers.
    #[must_use]
    pub fn solve(&self, y: f64, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        if !y.is_finite() {
            return Vec::new();
        }
        let value = |x: f64| self.evaluate(x, 0, Some(mode));
        let beyond = |right: bool| {
            let part = self.beyond(right, mode.side(right));
            part.map_or_else(Vec::new, |part| part.solve(y, value))
        };
        let mut out: Vec<f64> = beyond(false).into_iter().rev().collect();
        for x in self.solve_inside(y) {
            push(&mut out, x, self.h(0));
        }
        for x in beyond(true) {
            push(&mut out, x, self.h(self.x.len() - 2));
        }
        out
    }

    /// Solutions on the knots.
    fn solve_inside(&self, y: f64) -> Vec<f64> {
        let mut merged = Merged::default();
        for i in 0..self.x.len() - 1 {
            let form = Bernstein::less(self.piece(i), y);
            if form.is_zero() {
                merged.add_zero(self.x[i]);
            } else if form.is_definite() {
                merged.close();
            } else {
                let (start, end) = (self.x[i], self.x[i + 1]);
                let f = |x: f64| {
                    let inside = start <= x && x <= end;
                    if inside { self.at(i, x, 0, Extrapolation::NAN) - y } else { f64::NAN }
                };
                merged.add(&form, 1.0, |t| {
                    let x = if t == 1.0 { end } else { start + t * (end - start) };
                    verified(x, 2.0 * form.noise, f)
                });
            }
        }
        merged.finish()
    }

    /// All roots: [`Self::solve`] with y = 0.
    #[must_use]
    pub fn roots(&self, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        self.solve(0.0, extrapolate)
    }
}

/// Append a solution unless it is the last one again (one at an end belongs to both sides).
fn push(out: &mut Vec<f64>, x: f64, h: f64) {
    let last = out.iter().rev().find(|v| !v.is_nan());
    if !last.is_some_and(|last| (x - last).abs() <= 1e-14 * h.abs() || x == *last) {
        out.push(x);
    }
}
