// SPDX-License-Identifier: MIT OR Apache-2.0

//! The inverse function of strictly monotone data: quantiles of a distribution function, and the like.

use crate::MonotoneError;
use crate::chunked::{self, TILE};
use crate::extrapolation::{Continuation, Extrapolation};
use crate::periodic::wrapped;
use crate::segment_polynomial::SegmentPolynomial;
use crate::spline::MonotoneSpline;
use shapespline_polynomial::knots::{Locator, Searcher};

use shapespline_polynomial::bracketed_root;

mod batch;
mod sorted;

use batch::Batch;
use sorted::Room;

/// Tiles that one thread works through at least.
const TILES: usize = 64;
/// Segments of a sorted tile that are gone through one after another.
const RUNS: usize = 12;
/// Steps that queries take together at most; what has not converged by then goes on alone.
const STEPS: usize = 5;
/// The share of queries that may go on alone: one in so many.
const FEW: usize = 5;

/// What inverting needs, made once.
#[derive(Debug)]
pub(crate) struct Inverse {
    /// The entry of y that breaks strict monotonicity.
    broken: Option<usize>,
    falling: bool,
    /// −y where y falls: searching needs increasing knots.
    turned: Vec<f64>,
    locator: Locator,
}

impl MonotoneSpline {
    /// Whether the data are strictly monotone, so that [`Self::inverse_into`] exists; the first offender otherwise.
    ///
    /// # Errors
    /// [`MonotoneError::NotInvertible`] with the entry of y that breaks strict monotonicity.
    pub fn check_invertible(&self) -> Result<(), MonotoneError> {
        self.inverted().map(drop)
    }

    fn inverted(&self) -> Result<&Inverse, MonotoneError> {
        let inverse = self.cached.inverse.get_or_init(|| {
            let (data, y) = (self.y(), &self.y);
            let falling = data[0] > data[1];
            let breaks = |w: &[f64]| if falling { !(w[0] > w[1]) } else { !(w[0] < w[1]) };
            let broken = data.windows(2).position(breaks).map(|i| i + 1);
            let turned = match broken {
                None if falling => y.iter().map(|v| -v).collect(),
                _ => Vec::new(),
            };
            Box::new(Inverse { broken, falling, turned, locator: Locator::default() })
        });
        match inverse.broken {
            Some(index) => Err(MonotoneError::NotInvertible { index, value: self.y()[index] }),
            None => Ok(inverse),
        }
    }

    fn inverse_searcher<'a>(&'a self, inverse: &'a Inverse, many: bool) -> Searcher<'a> {
        let knots = if inverse.falling { &inverse.turned } else { &self.y };
        inverse.locator.searcher(knots, many)
    }

    /// x with f(x) = y for every query. Outside the range of the data what the extrapolation there says: of a tangent line
    /// its inverse (NaN where it is level), of a function that rises by the same every period the place in the period where
    /// it has this value, of the end value the end, else NaN. NaN gives NaN.
    ///
    /// The residual f(x) − y is of the size of an ulp of y, or of the change of f over an ulp of x where that is
    /// larger. An iteration of fourth order for many at once; what it does not finish goes to one that never leaves
    /// its bracket: no query can fail or hang. O(log N) a query; many run on all threads.
    ///
    /// # Errors
    /// [`MonotoneError::NotInvertible`] when the data are not strictly monotone.
    pub fn inverse_many(&self, queries: &[f64]) -> Result<Vec<f64>, MonotoneError> {
        let inverse = self.inverted()?;
        let search = self.inverse_searcher(inverse, queries.len() > TILE);
        Ok(chunked::answers(queries, TILES, |q| self.inverse_tile(search, inverse.falling, q)))
    }

    /// [`Self::inverse_many`] into a slice. `out` must have the queries' length; extra entries of the longer are left
    /// alone.
    ///
    /// # Errors
    /// As [`Self::inverse_many`].
    pub fn inverse_into(&self, queries: &[f64], out: &mut [f64]) -> Result<(), MonotoneError> {
        let inverse = self.inverted()?;
        let search = self.inverse_searcher(inverse, queries.len().min(out.len()) > TILE);
        chunked::fill(queries, out, TILES, |q, out| {
            let found = self.inverse_tile(search, inverse.falling, q);
            out.copy_from_slice(&found[..q.len()]);
        });
        Ok(())
    }

    /// [`Self::inverse_many`] for one value.
    ///
    /// # Errors
    /// As [`Self::inverse_many`].
    pub fn inverse(&self, y: f64) -> Result<f64, MonotoneError> {
        let inverse = self.inverted()?;
        let search = self.inverse_searcher(inverse, false);
        let (shift, y) = self.in_first_period(y);
        Ok(self.inverse_at(search.find(if inverse.falling { -y } else { y }), y) + shift)
    }

    /// A value beyond those of the data as that of a function that rises by the same every period: how far the period is
    /// from the first one, and the value there.
    fn in_first_period(&self, y: f64) -> (f64, f64) {
        let n = self.y.len() - 1;
        let (first, last) = (self.y[0], self.y[n]);
        let (below, above) =
            if first < last { (y < first, y > last) } else { (y > first, y < last) };
        if !(below || above) || self.extrapolation().side(above) != Continuation::Periodic(1) {
            return (0.0, y);
        }
        let sign = (last - first).signum();
        let (count, place) = wrapped(sign * y, sign * first, sign * last);
        (count * (self.x[self.x.len() - 1] - self.x[0]), sign * place)
    }

    /// The places of up to [`TILE`] values.
    fn inverse_tile(&self, search: Searcher<'_>, falling: bool, queries: &[f64]) -> [f64; TILE] {
        let Extrapolation { below, above } = self.extrapolation();
        if below != Continuation::Periodic(1) && above != Continuation::Periodic(1) {
            return self.inverse_tile_within(search, falling, queries);
        }
        let (mut y, mut shifts) = ([0.0; TILE], [0.0; TILE]);
        for (j, query) in queries.iter().enumerate() {
            (shifts[j], y[j]) = self.in_first_period(*query);
        }
        let out = self.inverse_tile_within(search, falling, &y[..queries.len()]);
        std::array::from_fn(|j| out[j] + shifts[j])
    }

    /// The same of values that are not periods away.
    fn inverse_tile_within(
        &self,
        search: Searcher<'_>,
        falling: bool,
        queries: &[f64],
    ) -> [f64; TILE] {
        let mut y = [self.y[0]; TILE];
        y[..queries.len()].copy_from_slice(queries);
        let mut keys = y;
        if falling {
            keys = keys.map(|v| -v);
        }
        let sorted = keys[..queries.len()].windows(2).fold(true, |all, w| all & (w[0] <= w[1]));
        if sorted {
            let (mut out, mut room) = ([0.0; TILE], Room::default());
            let done = search.runs(&keys[..queries.len()], RUNS, |i, run| {
                sorted::invert(
                    self.polynomial(i),
                    self.x[i + 1],
                    &y[run.clone()],
                    &mut out[run],
                    &mut room,
                );
            });
            if done {
                return out;
            }
        }
        let mut segments = [0; TILE];
        search.tile(&keys[..queries.len()], sorted, &mut segments);
        let mut batch = Batch::new(|j| self.polynomial(segments[j]), &y);
        batch.solve();
        std::array::from_fn(|j| {
            // Queries outside the data fail the second test.
            if (0.0..=1.0).contains(&batch.from[0][j]) {
                let polynomial = self.polynomial(segments[j]);
                let sure = batch.doubt[j] <= 0.0;
                let t = if sure { batch.t[j] } else { local(polynomial, y[j], batch.t[j]) };
                let end = self.x[segments[j] + 1];
                let x = if t < 0.5 {
                    polynomial.x0 + t * polynomial.h
                } else {
                    end - (1.0 - t) * polynomial.h
                };
                let x = if y[j] == polynomial.y[0] { polynomial.x0 } else { x };
                let x = if y[j] == polynomial.y[1] { end } else { x };
                x.max(polynomial.x0).min(end)
            } else {
                self.inverse_at(segments[j], y[j])
            }
        })
    }

    fn inverse_at(&self, i: usize, y: f64) -> f64 {
        let n = self.y.len() - 1;
        let (a, b) = (self.y[0], self.y[n]);
        if (a <= y && y <= b) || (b <= y && y <= a) {
            return self.invert_in(i, y);
        }
        if y.is_nan() {
            return f64::NAN;
        }
        let end = if (a < b) == (y < a) { 0 } else { n };
        let slope = self.d[end];
        match self.extrapolation().side(end > 0) {
            Continuation::Taylor(0) => self.x[end],
            Continuation::Taylor(1) if slope != 0.0 => {
                let rise = self.units.rise().scale(y - self.y[end]);
                self.x[end] + self.units.x().scale(rise / slope)
            }
            _ => f64::NAN,
        }
    }

    /// x in segment i with f(x) = y, for y between the segment's values.
    pub(crate) fn invert_in(&self, i: usize, y: f64) -> f64 {
        let polynomial = self.polynomial(i);
        if y == polynomial.y[0] {
            return polynomial.x0;
        }
        if y == polynomial.y[1] {
            return self.x[i + 1];
        }
        let t = local(polynomial, y, f64::NAN);
        let x = if t < 0.5 {
            polynomial.x0 + t * polynomial.h
        } else {
            self.x[i + 1] - (1.0 - t) * polynomial.h
        };
        x.max(polynomial.x0).min(self.x[i + 1])
    }
}

/// t in [0, 1] with f(t) = y: Newton in a bracket, from a start that is in it or from the chord.
#[inline]
fn local(polynomial: &SegmentPolynomial, y: f64, start: f64) -> f64 {
    let dy = polynomial.y[1] - polynomial.y[0];
    let (from0, from1) = (y - polynomial.y[0], y - polynomial.y[1]);
    let start = if start > 0.0 && start < 1.0 { start } else { from0 / dy };
    // A residual below half an ulp of y is as good as zero.
    let tolerance = 0.25 * f64::EPSILON * y.abs().max(f64::MIN_POSITIVE);
    let residual = |t: f64| {
        let (value, slope) = polynomial.residual_and_slope(t);
        (value - if t < 0.5 { from0 } else { from1 }, slope)
    };
    bracketed_root(residual, [0.0, 1.0], [-from0, -from1], start, [tolerance, 1e-16])
}
