//! Piecewise polynomials in Bernstein form: what derivatives and antiderivatives of the interpolants are.

use crate::bernstein;
use crate::extrapolation::Extrapolation;
use crate::integrals::{Lazy, Pieces, whole};
use crate::locate::Locator;
use crate::tiles::{self, TILE};

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
        tiles::fill(queries, out, TILES, |q, out| {
            let mut segments = [0; TILE];
            search.tile(q, q.is_sorted(), &mut segments);
            for ((value, &x), &i) in out.iter_mut().zip(q).zip(&segments) {
                *value = self.at(i, x, nu, mode);
            }
        });
    }

    fn at(&self, i: usize, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        let last = self.x.len() - 1;
        let h = self.h(i);
        let outside = x < self.x[0] || x > self.x[last];
        if outside && mode != Extrapolation::Polynomial || x.is_nan() {
            return match mode {
                _ if x.is_nan() => f64::NAN,
                Extrapolation::Zero => 0.0,
                Extrapolation::Taylor(k) => {
                    let right = x > self.x[last];
                    let a = bernstein::taylor(self.piece(i), right);
                    let tau = if right { (x - self.x[last]) / h } else { (self.x[0] - x) / h };
                    let mut sum = 0.0;
                    for p in (nu..=usize::from(k).min(self.degree)).rev() {
                        let falling: f64 = (p + 1 - nu..=p).map(|f| f as f64).product();
                        sum = sum * tau + falling * a[p];
                    }
                    let orient = if right { 1.0 } else { -1.0 };
                    (0..nu).fold(sum, |v, _| orient * v / h)
                }
                _ => f64::NAN,
            };
        }
        if nu == 0 {
            return bernstein::value(self.piece(i), (x - self.x[i]) / h);
        }
        let mut c = self.piece(i).to_vec();
        for _ in 0..nu {
            c = bernstein::derivative(&c);
        }
        let v = bernstein::value(&c, (x - self.x[i]) / h);
        (0..nu).fold(v, |v, _| v / h)
    }

    /// The derivative of order `nu` as a piecewise polynomial. O(N).
    #[must_use]
    pub fn derivative(&self, nu: usize) -> Self {
        let mut out = self.clone();
        for _ in 0..nu {
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

    /// `∫ₐᵇ f dx`, also for a > b and outside the knots as the extrapolation says. O(log N), after a
    /// first call of O(N).
    #[must_use]
    pub fn integrate(&self, a: f64, b: f64, extrapolate: Option<Extrapolation>) -> f64 {
        let n = self.x.len() - 1;
        let pieces = Pieces {
            x: &self.x,
            search: self.locator.searcher(&self.x, false),
            degree: self.degree,
            piece: |i: usize| self.piece(i),
            sums: || self.sums.get(n, |i| whole(self.piece(i), self.h(i))),
        };
        pieces.integrate(a, b, extrapolate.unwrap_or(self.extrapolate))
    }

    /// All x with f(x) = y, increasing, each once; where f equals y on a whole segment its start followed by NaN, as
    /// SciPy's `PPoly.solve` does. Solutions outside the knots follow the extrapolation. O(N).
    #[must_use]
    pub fn solve(&self, y: f64, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let n = self.x.len() - 1;
        let mut out = self.outside(y, mode, false);
        for i in 0..n {
            let c: Vec<f64> = self.piece(i).iter().map(|v| v - y).collect();
            if c.iter().all(|v| *v == 0.0) {
                push(&mut out, self.x[i], self.h(i));
                out.push(f64::NAN);
                continue;
            }
            for t in bernstein::roots(&c) {
                let x = if t == 1.0 { self.x[i + 1] } else { self.x[i] + t * self.h(i) };
                push(&mut out, x, self.h(i));
            }
        }
        for x in self.outside(y, mode, true) {
            push(&mut out, x, self.h(n - 1));
        }
        out
    }

    /// All roots: [`Self::solve`] with y = 0.
    #[must_use]
    pub fn roots(&self, extrapolate: Option<Extrapolation>) -> Vec<f64> {
        self.solve(0.0, extrapolate)
    }

    /// Solutions beyond one end, increasing.
    fn outside(&self, y: f64, mode: Extrapolation, right: bool) -> Vec<f64> {
        let n = self.x.len() - 1;
        let i = if right { n - 1 } else { 0 };
        let degree = match mode {
            Extrapolation::Polynomial => self.degree,
            Extrapolation::Taylor(k) => self.degree.min(usize::from(k)),
            _ => return Vec::new(),
        };
        let mut a = bernstein::taylor(self.piece(i), right);
        a.truncate(degree + 1);
        a[0] -= y;
        let roots = bernstein::positive_roots(&a);
        let h = self.h(i);
        if right {
            roots.iter().map(|tau| self.x[n] + tau * h).collect()
        } else {
            roots.iter().rev().map(|tau| self.x[0] - tau * h).collect()
        }
    }
}

/// Append a solution unless it is the last one again (a root at a knot belongs to two segments).
fn push(out: &mut Vec<f64>, x: f64, h: f64) {
    let again = out
        .iter()
        .rev()
        .find(|v| !v.is_nan())
        .is_some_and(|last| (x - last).abs() <= 1e-14 * h.abs() || x == *last);
    if !again {
        out.push(x);
    }
}
