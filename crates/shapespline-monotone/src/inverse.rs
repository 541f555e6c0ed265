//! The inverse function of strictly monotone data: quantiles of a distribution function, and the like.

use crate::MonotoneError;
use crate::extrapolation::Extrapolation;
use crate::locate::{Locator, Searcher, TILE};
use crate::record::Record;
use crate::spline::MonotoneSpline;
use rayon::prelude::*;

/// Tiles that one thread works through at least.
const TILES: usize = 64;
/// Steps that all queries of a tile take together at most; what has not converged by then goes on alone.
const STEPS: usize = 5;
/// Adding it rounds to integers.
const MAGIC: f64 = 4_503_599_627_370_496.0;
/// Queries of a tile that may go on alone.
const FEW: usize = 12;

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
            let y = self.y();
            let falling = y[0] > y[1];
            let breaks = |w: &[f64]| if falling { !(w[0] > w[1]) } else { !(w[0] < w[1]) };
            let broken = y.windows(2).position(breaks).map(|i| i + 1);
            let turned = match broken {
                None if falling => y.iter().map(|v| -v).collect(),
                _ => Vec::new(),
            };
            Inverse { broken, falling, turned, locator: Locator::default() }
        });
        match inverse.broken {
            Some(index) => Err(MonotoneError::NotInvertible { index, value: self.y()[index] }),
            None => Ok(inverse),
        }
    }

    fn inverse_searcher<'a>(&'a self, inverse: &'a Inverse, many: bool) -> Searcher<'a> {
        let knots = if inverse.falling { &inverse.turned } else { self.y() };
        inverse.locator.searcher(knots, many)
    }

    /// x with f(x) = y for every query. Outside the range of the data: NaN, with linear extrapolation the tangent's
    /// inverse, with [`Extrapolation::CLIP`] the end. NaN gives NaN.
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
        let tile = |q: &[f64]| self.inverse_tile(search, inverse.falling, q);
        let tiles: Vec<[f64; TILE]> = if queries.len() <= 2 * TILE * TILES {
            queries.chunks(TILE).map(tile).collect()
        } else {
            queries.par_chunks(TILE).with_min_len(TILES).map(tile).collect()
        };
        let mut places = tiles.into_flattened();
        places.truncate(queries.len());
        Ok(places)
    }

    /// [`Self::inverse_many`] into a slice. `out` must have the queries' length; extra entries of the longer are left
    /// alone.
    ///
    /// # Errors
    /// As [`Self::inverse_many`].
    pub fn inverse_into(&self, queries: &[f64], out: &mut [f64]) -> Result<(), MonotoneError> {
        let n = queries.len().min(out.len());
        out[..n].copy_from_slice(&self.inverse_many(&queries[..n])?);
        Ok(())
    }

    /// [`Self::inverse_many`] for one value.
    ///
    /// # Errors
    /// As [`Self::inverse_many`].
    pub fn inverse(&self, y: f64) -> Result<f64, MonotoneError> {
        let inverse = self.inverted()?;
        let search = self.inverse_searcher(inverse, false);
        Ok(self.inverse_at(search.find(if inverse.falling { -y } else { y }), y))
    }

    /// The places of up to [`TILE`] values.
    fn inverse_tile(&self, search: Searcher<'_>, falling: bool, queries: &[f64]) -> [f64; TILE] {
        let mut y = [self.y()[0]; TILE];
        y[..queries.len()].copy_from_slice(queries);
        let mut keys = y;
        if falling {
            keys = keys.map(|v| -v);
        }
        let sorted = keys.windows(2).fold(true, |all, w| all & (w[0] <= w[1]));
        let mut segments = [0; TILE];
        search.tile(&keys[..queries.len()], sorted, &mut segments);
        let mut lanes = Lanes::new(|j| self.record(segments[j]), &y);
        lanes.solve();
        std::array::from_fn(|j| {
            // Queries outside the data fail the second test.
            if (0.0..=1.0).contains(&lanes.from[0][j]) {
                let record = self.record(segments[j]);
                let sure = lanes.doubt[j] <= 0.0;
                let t = if sure { lanes.t[j] } else { local(record, y[j], lanes.t[j]) };
                let end = self.x()[segments[j] + 1];
                let x = if t < 0.5 { record.x0 + t * record.h } else { end - (1.0 - t) * record.h };
                let x = if y[j] == record.y[0] { record.x0 } else { x };
                let x = if y[j] == record.y[1] { end } else { x };
                x.max(record.x0).min(end)
            } else {
                self.inverse_at(segments[j], y[j])
            }
        })
    }

    fn inverse_at(&self, i: usize, y: f64) -> f64 {
        let n = self.y().len() - 1;
        let (a, b) = (self.y()[0], self.y()[n]);
        if (a <= y && y <= b) || (b <= y && y <= a) {
            return self.invert_in(i, y);
        }
        if y.is_nan() {
            return f64::NAN;
        }
        let end = if (a < b) == (y < a) { 0 } else { n };
        match self.extrapolation() {
            Extrapolation::CLIP => self.x()[end],
            Extrapolation::LINEAR if self.slopes()[end] != 0.0 => {
                self.x()[end] + (y - self.y()[end]) / self.slopes()[end]
            }
            _ => f64::NAN,
        }
    }

    /// x in segment i with f(x) = y, for y between the segment's values.
    pub(crate) fn invert_in(&self, i: usize, y: f64) -> f64 {
        let record = self.record(i);
        if y == record.y[0] {
            return record.x0;
        }
        if y == record.y[1] {
            return self.x()[i + 1];
        }
        let t = local(record, y, f64::NAN);
        let x =
            if t < 0.5 { record.x0 + t * record.h } else { self.x()[i + 1] - (1.0 - t) * record.h };
        x.max(record.x0).min(self.x()[i + 1])
    }
}

/// t in [0, 1] with f(t) = y: Newton in a bracket, from a start that is in it or from the chord.
#[inline]
fn local(record: &Record, y: f64, start: f64) -> f64 {
    let dy = record.y[1] - record.y[0];
    let rising = dy > 0.0;
    let (from0, from1) = (y - record.y[0], y - record.y[1]);
    let (mut lo, mut hi) = (0.0f64, 1.0f64);
    let mut t = if start > 0.0 && start < 1.0 { start } else { from0 / dy };
    // A residual below half an ulp of y is as good as zero.
    let tolerance = 0.25 * f64::EPSILON * y.abs().max(f64::MIN_POSITIVE);
    for k in 0..80 {
        let (value, slope) = record.residual_and_slope(t);
        let r = value - if t < 0.5 { from0 } else { from1 };
        if r.abs() <= tolerance {
            break;
        }
        if (r < 0.0) == rising {
            lo = t;
        } else {
            hi = t;
        }
        let newton = t - r / slope;
        // Newton converges in a few steps; where the derivative touches zero it crawls and bisection takes over.
        let near = (newton - t).abs() < 1e-8;
        let next = if newton > lo && newton < hi && (k % 4 != 3 || near) {
            newton
        } else {
            0.5 * (lo + hi)
        };
        let step = (next - t).abs();
        t = next;
        if step <= 1e-16 * t.min(1.0 - t) + 1e-300 || hi - lo <= 1.2e-16 * lo {
            break;
        }
    }
    t
}

/// A tile of queries in their segments, in units of Δy, number by number: the compiler takes several queries at once.
struct Lanes {
    q: [[f64; TILE]; 4],
    /// `(y − y₀)/Δy` and `(y − y₁)/Δy`.
    from: [[f64; TILE]; 2],
    t: [f64; TILE],
    /// Positive (or NaN) where t is not known to be exact up to rounding.
    doubt: [f64; TILE],
}

impl Lanes {
    #[inline(always)]
    fn new<'a>(record: impl Fn(usize) -> &'a Record, y: &[f64; TILE]) -> Self {
        let mut l = Self {
            q: [[0.0; TILE]; 4],
            from: [[0.0; TILE]; 2],
            t: [0.0; TILE],
            doubt: [1.0; TILE],
        };
        let mut inverse = [0.0; TILE];
        for j in 0..TILE {
            let r = record(j);
            inverse[j] = r.y[1] - r.y[0];
            (l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]) = (r.q[0], r.q[1], r.q[2], r.q[3]);
            (l.from[0][j], l.from[1][j]) = (y[j] - r.y[0], y[j] - r.y[1]);
        }
        // The start: the inverse of the rational function (t² + m₀t(1−t))/(1 + (m₀+m₁−2)t(1−t)) through both ends with
        // their slopes (Gregory and Delbourgo's monotone one), a quadratic equation.
        for j in 0..TILE {
            let unit = 1.0 / inverse[j];
            let q = [l.q[0][j] * unit, l.q[1][j] * unit, l.q[2][j] * unit, l.q[3][j] * unit];
            let (even, odd) = (q[0] + q[2], q[1] + q[3]);
            let (m0, m1) = (1.0 - (even - odd), 1.0 + (even + odd));
            let r = l.from[0][j] * unit;
            let b = m0 - r * (m0 + m1 - 2.0);
            l.t[j] = 2.0 * r / (b + (b * b + 4.0 * r * (1.0 - b)).sqrt());
            (l.q[0][j], l.q[1][j], l.q[2][j], l.q[3][j]) = (q[0], q[1], q[2], q[3]);
            (l.from[0][j], l.from[1][j]) = (r, l.from[1][j] * unit);
        }
        l
    }

    /// Householder's steps of fourth order until nearly all are done.
    #[inline(always)]
    fn solve(&mut self) {
        self.step();
        for _ in 1..STEPS {
            self.step();
            let doubtful: usize = self.doubt.iter().map(|d| usize::from(!(*d <= 0.0))).sum();
            if doubtful <= FEW {
                break;
            }
        }
    }

    #[inline(always)]
    fn step(&mut self) {
        for j in 0..TILE {
            let t = self.t[j];
            let [q0, q1, q2, q3] = [self.q[0][j], self.q[1][j], self.q[2][j], self.q[3][j]];
            let (z, bubble) = (2.0 * t - 1.0, t * (t - 1.0));
            let q = ((q3 * z + q2) * z + q1) * z + q0;
            let dq = (3.0 * q3 * z + 2.0 * q2) * z + q1;
            let ddq = 6.0 * q3 * z + 2.0 * q2;
            // From the nearer end, 0 or 1, by arithmetic alone: a choice of what to load keeps the compiler from taking
            // several queries at once.
            let end = (t + MAGIC) - MAGIC;
            let goal = (1.0 - end) * self.from[0][j] + end * self.from[1][j];
            // f and its first three derivatives.
            let f = ((t - end) + bubble * q) - goal;
            let d1 = 1.0 + z * q + 2.0 * bubble * dq;
            let d2 = 2.0 * q + 4.0 * (z * dq + bubble * ddq);
            let d3 = 12.0 * (dq + z * ddq) + 48.0 * bubble * q3;
            let square = d1 * d1;
            let bend = f * d2;
            let step =
                f * (square - 0.5 * bend) / (d1 * (square - bend) + f * f * d3 * (1.0 / 6.0));
            let next = t - step;
            // What is left is of fourth order: below rounding once the step is below 1e-4 of the way to the nearer
            // end, and what it corrects of Newton's step below 1e-4.
            let room = if next < 0.5 { next } else { 1.0 - next };
            let size = step.abs() - 1e-4 * room;
            let bent = bend.abs() - 2e-4 * square;
            self.t[j] = next;
            self.doubt[j] = if size > bent { size } else { bent };
        }
    }
}
