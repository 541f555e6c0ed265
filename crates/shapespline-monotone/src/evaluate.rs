// SPDX-License-Identifier: MIT OR Apache-2.0

//! Values and derivatives of the interpolants, one or many: segments first, then values, on all threads.

use crate::chunked::{self, TILE};
use crate::extrapolation::{Continuation, Extrapolation};
use crate::periodic;
use crate::segment_polynomial::SegmentPolynomial;
use crate::spline::MonotoneSpline;
use shapespline_polynomial::knots::Searcher;
use std::array;

/// Tiles that one thread works through at least.
const TILES: usize = 128;
/// Segments of a sorted tile that are gone through one after another.
const RUNS: usize = 11;

impl MonotoneSpline {
    pub(crate) fn searcher(&self, many: bool) -> Searcher<'_> {
        self.cached.locator.searcher(&self.x, many)
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

    /// The derivative of order `nu` at every query, in the queries' order; sorted queries cost the least. Many run on
    /// all threads.
    #[must_use]
    pub fn evaluate_many(
        &self,
        queries: &[f64],
        nu: usize,
        extrapolate: Option<Extrapolation>,
    ) -> Vec<f64> {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let search = self.searcher(queries.len() > TILE);
        chunked::answers(queries, TILES, |q| self.tile(search, q, nu, mode))
    }

    /// [`Self::evaluate_many`] into a slice. `out` must have the queries' length; extra entries of the longer are left
    /// alone.
    pub fn evaluate_into(
        &self,
        queries: &[f64],
        nu: usize,
        extrapolate: Option<Extrapolation>,
        out: &mut [f64],
    ) {
        let mode = extrapolate.unwrap_or(self.extrapolate);
        let search = self.searcher(queries.len().min(out.len()) > TILE);
        chunked::fill(queries, out, TILES, |q, out| {
            out.copy_from_slice(&self.tile(search, q, nu, mode)[..q.len()]);
        });
    }

    /// The values at up to [`TILE`] queries.
    #[inline]
    fn tile(
        &self,
        search: Searcher<'_>,
        queries: &[f64],
        nu: usize,
        mode: Extrapolation,
    ) -> [f64; TILE] {
        let mut q = [self.x[0]; TILE];
        q[..queries.len()].copy_from_slice(queries);
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        // Every query is looked at: a loop that may end early is not done several numbers at once.
        let inside = queries.iter().fold(true, |all, &x| all & (x >= first) & (x <= last));
        let sorted = queries.windows(2).fold(true, |all, w| all & (w[0] <= w[1]));
        if sorted && inside && nu == 0 {
            // On few segments, as fine samples are: what depends on a segment alone is loaded once.
            let mut out = [0.0; TILE];
            let done = search.runs(queries, RUNS, |i, run| {
                self.polynomials[i].values(&queries[run.clone()], &mut out[run]);
            });
            if done {
                return out;
            }
        }
        let mut segments = [0; TILE];
        search.tile(queries, sorted, &mut segments);
        let value = |i: usize, x: f64| {
            let polynomial: &SegmentPolynomial = &self.polynomials[i];
            polynomial.value(polynomial.local(x))
        };
        if inside && nu == 0 {
            // The places after the last query are on the first segment, and cut off by the callers.
            return array::from_fn(|j| value(segments[j], q[j]));
        }
        array::from_fn(
            |j| if j < queries.len() { self.at(segments[j], q[j], nu, mode) } else { 0.0 },
        )
    }

    #[inline]
    fn at(&self, i: usize, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        let last = self.x.len() - 1;
        if x >= self.x[0] && x <= self.x[last] {
            if nu == 0 {
                let polynomial = &self.polynomials[i];
                polynomial.value(polynomial.local(x))
            } else {
                self.derivative_at(i, x, nu)
            }
        } else {
            self.outside(x, nu, mode)
        }
    }

    #[cold]
    fn outside(&self, x: f64, nu: usize, mode: Extrapolation) -> f64 {
        if x.is_nan() {
            return f64::NAN;
        }
        let last = self.x.len() - 1;
        let right = x > self.x[last];
        let end = if right { last } else { 0 };
        let mut mode = mode.side(right);
        match (mode, nu) {
            (Continuation::Nan, _) => return f64::NAN,
            (Continuation::Periodic(order), _) => {
                let (count, x) = periodic::wrapped(x, self.x[0], self.x[last]);
                let value = self.evaluate(x, nu, Some(Extrapolation::NAN));
                let rises = order > 0 && nu == 0;
                return if rises { value + count * (self.y[last] - self.y[0]) } else { value };
            }
            (Continuation::Taylor(0), 0) => return self.y[end],
            (Continuation::Taylor(1), 0) => {
                // A level line has the end value even at ±∞.
                let rise = self.d[end] * self.units.spacing().scale(x - self.x[end]);
                return self.y[end]
                    + if self.d[end] == 0.0 { 0.0 } else { self.units.y().scale(rise) };
            }
            _ => {}
        }
        for _ in 0..nu.min(self.degree() + 1) {
            mode = mode.derivative();
        }
        self.beyond(right, nu, mode).map_or(f64::NAN, |part| part.evaluate(x, 0))
    }
}
