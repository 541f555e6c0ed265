//! The inverse function of strictly monotone data: quantiles of a distribution function, and the like.

use crate::MonotoneError;
use crate::extrapolation::Extrapolation;
use crate::locate::Locator;
use crate::record::Record;
use crate::spline::MonotoneSpline;
use rayon::prelude::*;

const CHUNK: usize = 1 << 14;

impl MonotoneSpline {
    /// Whether the data are strictly monotone, so that [`Self::inverse_into`] exists; the first offender otherwise.
    ///
    /// # Errors
    /// [`MonotoneError::NotInvertible`] with the entry of y that breaks strict monotonicity.
    pub fn check_invertible(&self) -> Result<(), MonotoneError> {
        let y = self.y();
        let rising = y[0] < y[1];
        match y.windows(2).position(|w| if rising { !(w[0] < w[1]) } else { !(w[0] > w[1]) }) {
            Some(i) => Err(MonotoneError::NotInvertible { index: i + 1, value: y[i + 1] }),
            None => Ok(()),
        }
    }

    /// x with f(x) = y for every query. Outside the range of the data: NaN, with linear extrapolation the tangent's
    /// inverse, with [`Extrapolation::CLIP`] the end. NaN gives NaN.
    ///
    /// The residual f(x) − y is of the size of an ulp of y, or of the change of f over an ulp of x where that is
    /// larger. A Newton iteration that never leaves its bracket: no query can fail or hang. O(log N) a query.
    ///
    /// # Errors
    /// [`MonotoneError::NotInvertible`] when the data are not strictly monotone.
    pub fn inverse_into(&self, queries: &[f64], out: &mut [f64]) -> Result<(), MonotoneError> {
        self.check_invertible()?;
        let n = queries.len().min(out.len());
        // Searching needs increasing knots: decreasing data are searched with both signs turned.
        let falling = self.y()[0] > self.y()[1];
        let turned: Vec<f64>;
        let knots: &[f64] = if falling {
            turned = self.y().iter().map(|v| -v).collect();
            &turned
        } else {
            self.y()
        };
        let locator = Locator::default();
        let search = locator.searcher(knots, n > self.y().len() / 4);
        let work = |q: &[f64], o: &mut [f64]| {
            let mut hint = 0;
            for (out, &y) in o.iter_mut().zip(q) {
                hint = search.find_near(if falling { -y } else { y }, hint);
                *out = self.inverse_at(hint, y);
            }
        };
        if n > 2 * CHUNK {
            queries[..n]
                .par_chunks(CHUNK)
                .zip(out[..n].par_chunks_mut(CHUNK))
                .for_each(|(q, o)| work(q, o));
        } else {
            work(&queries[..n], &mut out[..n]);
        }
        Ok(())
    }

    /// [`Self::inverse_into`] for one value.
    ///
    /// # Errors
    /// As [`Self::inverse_into`].
    pub fn inverse(&self, y: f64) -> Result<f64, MonotoneError> {
        let mut out = [0.0];
        self.inverse_into(&[y], &mut out)?;
        Ok(out[0])
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
        if y == record.y0 {
            return record.x0;
        }
        if y == record.y1 {
            return self.x()[i + 1];
        }
        let t = local(record, y);
        let x =
            if t < 0.5 { record.x0 + t * record.h } else { self.x()[i + 1] - (1.0 - t) * record.h };
        x.max(record.x0).min(self.x()[i + 1])
    }
}

/// t in [0, 1] with f(t) = y: Newton in a bracket.
#[inline]
fn local(record: &Record, y: f64) -> f64 {
    let dy = record.y1 - record.y0;
    let rising = dy > 0.0;
    let (from0, from1) = (y - record.y0, y - record.y1);
    let (mut lo, mut hi) = (0.0f64, 1.0f64);
    let mut t = from0 / dy;
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
