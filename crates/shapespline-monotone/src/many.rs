// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many fits in one call, in parallel: columns on one x, and rows with their own x.

use crate::MonotoneError;
use crate::cubic::{CubicOptions, MonotoneCubic};
use crate::extrapolation::Extrapolation;
use crate::quartic::{MonotoneQuartic, QuarticOptions};
use crate::quintic::{MonotoneQuintic, QuinticOptions};
use crate::spline::MonotoneSpline;
use shapespline_polynomial::parallel;

/// Fits that are many: small ones take microseconds, and a thread should have a good many to do.
const MANY: usize = 64;

/// An interpolant that can be made from data and options.
pub trait MonotoneMany: Sized + Send {
    /// Its options.
    type Options: Sync;
    /// Make one.
    ///
    /// # Errors
    /// As the type's own `new`.
    fn make(x: &[f64], y: &[f64], options: &Self::Options) -> Result<Self, MonotoneError>;
    /// Its function.
    fn function(&self) -> &MonotoneSpline;

    /// Evaluate fit k of `fits` at its own stretch of the queries: `queries` and `out` hold `offsets.len() − 1`
    /// stretches, stretch k from `offsets[k]` to `offsets[k+1]`. In parallel.
    fn evaluate_rows(
        fits: &[Self],
        queries: &[f64],
        offsets: &[usize],
        nu: usize,
        extrapolate: Option<Extrapolation>,
    ) -> Result<Vec<f64>, MonotoneError>
    where
        Self: Sync,
    {
        check_offsets(offsets, queries.len())?;
        if offsets.len() != fits.len() + 1 {
            return Err(MonotoneError::Length {
                argument: "offsets",
                found: offsets.len(),
                expected: fits.len() + 1,
            });
        }
        let rows: Vec<Vec<f64>> = parallel::map(fits.len(), MANY, |k| {
            let queries = &queries[offsets[k]..offsets[k + 1]];
            let mut out = vec![0.0; queries.len()];
            fits[k].function().evaluate_into(queries, nu, extrapolate, &mut out);
            out
        });
        Ok(rows.concat())
    }

    /// Evaluate every fit at the same queries: column after column. In parallel.
    fn evaluate_columns(
        fits: &[Self],
        queries: &[f64],
        nu: usize,
        extrapolate: Option<Extrapolation>,
    ) -> Vec<f64>
    where
        Self: Sync,
    {
        let mut out = vec![0.0; fits.len() * queries.len()];
        if queries.is_empty() {
            return out;
        }
        let (size, many) = (queries.len(), MANY * queries.len());
        let column = |(): &mut (), start: usize, out: &mut [f64]| {
            fits[start / size].function().evaluate_into(queries, nu, extrapolate, out);
        };
        parallel::parts::<_, _, _, ()>(&mut *out, size, many, || (), column);
        out
    }
}

impl MonotoneMany for MonotoneCubic {
    type Options = CubicOptions;
    fn make(x: &[f64], y: &[f64], options: &CubicOptions) -> Result<Self, MonotoneError> {
        Self::new(x, y, options)
    }
    fn function(&self) -> &MonotoneSpline {
        self.spline()
    }
}

impl MonotoneMany for MonotoneQuartic {
    type Options = QuarticOptions;
    fn make(x: &[f64], y: &[f64], options: &QuarticOptions) -> Result<Self, MonotoneError> {
        Self::new(x, y, options)
    }
    fn function(&self) -> &MonotoneSpline {
        self.spline()
    }
}

impl MonotoneMany for MonotoneQuintic {
    type Options = QuinticOptions;
    fn make(x: &[f64], y: &[f64], options: &QuinticOptions) -> Result<Self, MonotoneError> {
        Self::new(x, y, options)
    }
    fn function(&self) -> &MonotoneSpline {
        self.spline()
    }
}

/// Fit every column of `y` (column after column, each as long as `x`) on the same `x`, in parallel.
///
/// # Errors
/// [`MonotoneError::InRow`] with the column and what is wrong in it; [`MonotoneError::Length`] when `y` is not a
/// whole number of columns.
///
/// ```
/// use shapespline_monotone::{MonotoneQuartic, QuarticOptions, fit_columns};
/// let y = [0.0, 1.0, 3.0, 5.0, 5.0, 2.0];
/// let fits: Vec<MonotoneQuartic> = fit_columns(&[0.0, 1.0, 2.0], &y, &QuarticOptions::default())?;
/// assert_eq!(fits[1].value(1.0), 5.0);
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn fit_columns<F: MonotoneMany>(
    x: &[f64],
    y: &[f64],
    options: &F::Options,
) -> Result<Vec<F>, MonotoneError> {
    if x.is_empty() || !y.len().is_multiple_of(x.len()) {
        let expected = if x.is_empty() { 0 } else { (y.len() / x.len() + 1) * x.len() };
        return Err(MonotoneError::Length { argument: "y", found: y.len(), expected });
    }
    let n = x.len();
    let fit = |row: usize| F::make(x, &y[row * n..(row + 1) * n], options);
    parallel::map(y.len() / n, MANY, |row| fit(row).map_err(|e| in_row(row, e)))
}

/// Fit rows with their own x, in parallel: row k takes entries `offsets[k] .. offsets[k+1]` of `x` and `y`.
///
/// # Errors
/// [`MonotoneError::InRow`] with the row and what is wrong in it; [`MonotoneError::Offset`] or
/// [`MonotoneError::Length`] when the offsets do not fit.
pub fn fit_rows<F: MonotoneMany>(
    x: &[f64],
    y: &[f64],
    offsets: &[usize],
    options: &F::Options,
) -> Result<Vec<F>, MonotoneError> {
    if x.len() != y.len() {
        return Err(MonotoneError::Length { argument: "y", found: y.len(), expected: x.len() });
    }
    check_offsets(offsets, x.len())?;
    let fit = |row: usize| {
        let own = offsets[row]..offsets[row + 1];
        F::make(&x[own.clone()], &y[own], options)
    };
    parallel::map(offsets.len() - 1, MANY, |row| fit(row).map_err(|e| in_row(row, e)))
}

fn in_row(row: usize, source: MonotoneError) -> MonotoneError {
    MonotoneError::InRow { row, source: Box::new(source) }
}

/// Offsets start at 0, do not fall and end at the length of what they cut.
fn check_offsets(offsets: &[usize], length: usize) -> Result<(), MonotoneError> {
    if offsets.first() != Some(&0) {
        let value = offsets.first().copied().unwrap_or(0);
        return Err(MonotoneError::Offset { index: 0, value, length });
    }
    if let Some(i) = offsets.windows(2).position(|w| w[1] < w[0]) {
        return Err(MonotoneError::Offset { index: i + 1, value: offsets[i + 1], length });
    }
    let index = offsets.len() - 1;
    if offsets[index] != length {
        return Err(MonotoneError::Offset { index, value: offsets[index], length });
    }
    Ok(())
}
