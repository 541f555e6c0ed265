//! The interpolant both schemes make: data, slopes, and one evaluation record a segment.

use crate::bernstein;
use crate::data::Data;
use crate::extrapolation::Extrapolation;
use crate::locate::{Locator, Searcher};
use crate::piecewise::PiecewisePolynomial;
use crate::record::Record;
use rayon::prelude::*;

/// Queries handled by one task of the thread pool, and the number from which the pool is used.
const CHUNK: usize = 1 << 15;
/// Queries located ahead of evaluation, so that cache misses overlap.
const BLOCK: usize = 32;

/// What the pieces are beyond their end values and slopes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Kind {
    /// `e = ⅔(αm₀ − βm₁)` of every segment, in units of y.
    Quartic { e: Vec<f64> },
    /// Second derivatives at the knots.
    Quintic { s: Vec<f64> },
}

/// A piecewise quartic (C¹) or quintic (C²) through data, monotone on every segment.
///
/// Values at knots are the data to the last bit, values between them stay between the two data values. Immutable,
/// `Send + Sync`, serialisable with the feature `serde`. [`crate::MonotoneQuartic`] and [`crate::MonotoneQuintic`] dereference to it.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct MonotoneSpline {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) d: Vec<f64>,
    pub(crate) kind: Kind,
    records: Vec<Record>,
    extrapolate: Extrapolation,
    locator: Locator,
}

/// The stored form.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
struct Stored {
    x: Vec<f64>,
    y: Vec<f64>,
    d: Vec<f64>,
    kind: Kind,
    records: Vec<Record>,
    extrapolate: Extrapolation,
}

#[cfg(feature = "serde")]
impl From<MonotoneSpline> for Stored {
    fn from(s: MonotoneSpline) -> Self {
        let MonotoneSpline { x, y, d, kind, records, extrapolate, .. } = s;
        Self { x, y, d, kind, records, extrapolate }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for MonotoneSpline {
    type Error = String;
    fn try_from(s: Stored) -> Result<Self, String> {
        let n = s.x.len();
        let extra = match &s.kind {
            Kind::Quartic { e } => e.len() + 1,
            Kind::Quintic { s } => s.len(),
        };
        if n < 2 || s.y.len() != n || s.d.len() != n || extra != n || s.records.len() + 1 != n {
            return Err("stored interpolant is inconsistent".to_owned());
        }
        crate::data::check(&s.x, &s.y).map_err(|error| format!("stored interpolant: {error}"))?;
        let Stored { x, y, d, kind, records, extrapolate } = s;
        Ok(Self { x, y, d, kind, records, extrapolate, locator: Locator::default() })
    }
}

impl MonotoneSpline {
    pub(crate) fn quintic(
        data: &Data,
        x: Vec<f64>,
        y: Vec<f64>,
        d: &[f64],
        s: &[f64],
        extrapolate: Extrapolation,
    ) -> Self {
        let unit = data.y_unit();
        let mut records = Vec::with_capacity(data.len());
        for i in 0..data.len() {
            let h = data.h[i];
            let m = [unit.scale(h * d[i]), unit.scale(h * d[i + 1])];
            let k = [unit.scale(h * (h * s[i])), unit.scale(h * (h * s[i + 1]))];
            records.push(Record::hermite(x[i], x[i + 1], y[i], y[i + 1], m, k));
        }
        let kind = Kind::Quintic { s: data.seconds_out(s) };
        let d = data.slopes_out(d);
        Self { x, y, d, kind, records, extrapolate, locator: Locator::default() }
    }

    /// `e` in scaled units of y.
    pub(crate) fn quartic(
        data: &Data,
        x: Vec<f64>,
        y: Vec<f64>,
        d: &[f64],
        mut e: Vec<f64>,
        extrapolate: Extrapolation,
    ) -> Self {
        let unit = data.y_unit();
        let mut records = Vec::with_capacity(data.len());
        for i in 0..data.len() {
            let h = data.h[i];
            let m = [unit.scale(h * d[i]), unit.scale(h * d[i + 1])];
            e[i] = unit.scale(e[i]);
            records.push(Record::quartic(x[i], x[i + 1], y[i], y[i + 1], m, e[i]));
        }
        let d = data.slopes_out(d);
        let kind = Kind::Quartic { e };
        Self { x, y, d, kind, records, extrapolate, locator: Locator::default() }
    }

    /// The abscissae.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// The ordinates.
    #[must_use]
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// Slopes at the knots.
    #[must_use]
    pub fn slopes(&self) -> &[f64] {
        &self.d
    }

    /// Second derivatives at the knots: stored for the quintic, from the right (at the last knot from the left) for
    /// the quartic, which is only C¹.
    #[must_use]
    pub fn second_derivatives(&self) -> Vec<f64> {
        match &self.kind {
            Kind::Quintic { s } => s.clone(),
            Kind::Quartic { .. } => {
                let n = self.records.len();
                (0..=n).map(|i| self.derivative_at(i.min(n - 1), self.x[i], 2)).collect()
            }
        }
    }

    /// The degree of the pieces: 4 or 5.
    #[must_use]
    pub fn degree(&self) -> usize {
        match self.kind {
            Kind::Quartic { .. } => 4,
            Kind::Quintic { .. } => 5,
        }
    }

    /// What it is outside the data.
    #[must_use]
    pub fn extrapolation(&self) -> Extrapolation {
        self.extrapolate
    }

    /// Bernstein coefficients of the pieces, `degree + 1` a segment (equations (15) and (16)), for `BPoly`.
    #[must_use]
    pub fn bernstein_coefficients(&self) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.records.len() * (self.degree() + 1));
        for i in 0..self.records.len() {
            let (y0, y1) = (self.y[i], self.y[i + 1]);
            let h = self.x[i + 1] - self.x[i];
            let (m0, m1) = (h * self.d[i], h * self.d[i + 1]);
            match &self.kind {
                Kind::Quartic { e } => out.extend([
                    y0,
                    y0 + 0.25 * m0,
                    0.5 * y0 + 0.5 * y1 + 0.25 * e[i],
                    y1 - 0.25 * m1,
                    y1,
                ]),
                Kind::Quintic { s } => {
                    let (k0, k1) = (h * (h * s[i]), h * (h * s[i + 1]));
                    out.extend([
                        y0,
                        y0 + 0.2 * m0,
                        y0 + (0.4 * m0 + 0.05 * k0),
                        y1 - (0.4 * m1 - 0.05 * k1),
                        y1 - 0.2 * m1,
                        y1,
                    ]);
                }
            }
        }
        out
    }

    /// The same function as a general piecewise polynomial. O(N).
    #[must_use]
    pub fn to_piecewise(&self) -> PiecewisePolynomial {
        let c = self.bernstein_coefficients();
        PiecewisePolynomial::new(self.x.clone(), self.degree(), c, self.extrapolate)
    }

    fn searcher(&self, many: bool) -> Searcher<'_> {
        self.locator.searcher(&self.x, many)
    }

    /// The value at one point. NaN gives NaN. O(log N), O(1) expected after a large request.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.evaluate(x, 0, None)
    }

    /// The derivative of order `nu` (0: the value) at one point, with another extrapolation if given.
    #[must_use]
    pub fn evaluate(&self, x: f64, nu: usize, extrapolate: Option<Extrapolation>) -> f64 {
        let i = self.searcher(false).find(x);
        self.at(i, x, nu, extrapolate.unwrap_or(self.extrapolate))
    }

    /// The derivative of order `nu` at every query, in the queries' order; sorted queries cost the least. `out` must
    /// have the queries' length; extra entries of the longer are left alone. Large requests use all threads.
    pub fn evaluate_into(
        &self,
        queries: &[f64],
        nu: usize,
        extrapolate: Option<Extrapolation>,
        out: &mut [f64],
    ) {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let search = self.searcher(queries.len() > 64);
        let n = queries.len().min(out.len());
        if n > 2 * CHUNK {
            queries[..n]
                .par_chunks(CHUNK)
                .zip(out[..n].par_chunks_mut(CHUNK))
                .for_each(|(q, o)| self.evaluate_chunk(search, q, nu, mode, o));
        } else {
            self.evaluate_chunk(search, &queries[..n], nu, mode, &mut out[..n]);
        }
    }

    fn evaluate_chunk(
        &self,
        search: Searcher<'_>,
        queries: &[f64],
        nu: usize,
        mode: Extrapolation,
        out: &mut [f64],
    ) {
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        let mut hint = 0;
        let mut index = [0usize; BLOCK];
        for (q, o) in queries.chunks(BLOCK).zip(out.chunks_mut(BLOCK)) {
            for (i, &x) in index.iter_mut().zip(q) {
                hint = search.find_near(x, hint);
                *i = hint;
            }
            if nu == 0 {
                for ((&x, &i), value) in q.iter().zip(&index).zip(o) {
                    *value = if x >= first && x <= last {
                        let record = &self.records[i];
                        record.value(record.local(x))
                    } else {
                        self.outside(i, x, 0, mode)
                    };
                }
            } else {
                for ((&x, &i), value) in q.iter().zip(&index).zip(o) {
                    *value = self.at(i, x, nu, mode);
                }
            }
        }
    }

    #[inline]
    fn at(&self, i: usize, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        let last = self.x.len() - 1;
        if x >= self.x[0] && x <= self.x[last] {
            if nu == 0 {
                let record = &self.records[i];
                record.value(record.local(x))
            } else {
                self.derivative_at(i, x, nu)
            }
        } else {
            self.outside(i, x, nu, mode)
        }
    }

    #[cold]
    fn outside(&self, i: usize, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        if x.is_nan() {
            return f64::NAN;
        }
        let last = self.x.len() - 1;
        let end = if x > self.x[last] { last } else { 0 };
        match (mode, nu) {
            (Extrapolation::Nan, _) => f64::NAN,
            (Extrapolation::Zero, _) => 0.0,
            (Extrapolation::Polynomial, 0) => {
                let record = &self.records[i];
                record.raw(record.local(x))
            }
            (Extrapolation::Polynomial, _) => self.derivative_at(i, x, nu),
            (Extrapolation::CLIP, 0) => self.y[end],
            (Extrapolation::LINEAR, 0) => self.y[end] + self.d[end] * (x - self.x[end]),
            (Extrapolation::LINEAR, 1) => self.d[end],
            (Extrapolation::Taylor(k), _) if nu > usize::from(k) => 0.0,
            (Extrapolation::Taylor(_), _) => self.end_piece(i).evaluate(x, nu, Some(mode)),
        }
    }

    /// One segment as a piecewise polynomial.
    fn end_piece(&self, i: usize) -> PiecewisePolynomial {
        let one = Self {
            x: self.x[i..=i + 1].to_vec(),
            y: self.y[i..=i + 1].to_vec(),
            d: self.d[i..=i + 1].to_vec(),
            kind: match &self.kind {
                Kind::Quartic { e } => Kind::Quartic { e: vec![e[i]] },
                Kind::Quintic { s } => Kind::Quintic { s: s[i..=i + 1].to_vec() },
            },
            records: vec![self.records[i]],
            extrapolate: self.extrapolate,
            locator: Locator::default(),
        };
        one.to_piecewise()
    }

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
    fn derivative_at(&self, i: usize, x: f64, nu: usize) -> f64 {
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
        let (c, degree) = self.second_coefficients(i);
        let mut c = c[..=degree].to_vec();
        for _ in 2..nu {
            c = bernstein::derivative(&c);
        }
        (0..nu).fold(bernstein::value(&c, t), |v, _| v / h)
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

    /// `∫ₐᵇ f dx`, also for a > b and outside the data as the extrapolation says. O(N).
    #[must_use]
    pub fn integrate(&self, a: f64, b: f64, extrapolate: Option<Extrapolation>) -> f64 {
        self.to_piecewise().integrate(a, b, extrapolate)
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

    pub(crate) fn record(&self, i: usize) -> &Record {
        &self.records[i]
    }
}
