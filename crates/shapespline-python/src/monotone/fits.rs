// SPDX-License-Identifier: MIT OR Apache-2.0

//! One function per column, of any of the kinds.

use std::{convert::Infallible, ops::ControlFlow};

use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use serde::{Deserialize, Serialize};
use shapespline::{
    monotone::{
        BSpline, Extrapolation, Fairness, MonotoneCubic, MonotoneError, MonotoneQuartic,
        MonotoneQuintic, MonotoneSpline, PiecewisePolynomial,
    },
    polynomial::parallel,
};

use crate::{
    output::{room, zeros},
    work::{GoOn, PARALLEL, in_parts, interruptible, parts, without_gil},
};

/// Columns of one kind; at least one.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Fits {
    Cubic(Vec<MonotoneCubic>),
    Quartic(Vec<MonotoneQuartic>),
    Quintic(Vec<MonotoneQuintic>),
    Pieces(Vec<PiecewisePolynomial>),
}

/// One column.
#[derive(Clone, Copy)]
pub(crate) enum Column<'a> {
    Spline(&'a MonotoneSpline),
    Pieces(&'a PiecewisePolynomial),
}

/// Calls a method that both kinds have.
macro_rules! both {
    ($column:expr, $f:ident => $body:expr) => {
        match $column {
            Column::Spline($f) => $body,
            Column::Pieces($f) => $body,
        }
    };
}

impl Column<'_> {
    /// The abscissae of the data, or of a function without data its knots.
    pub(crate) fn x(&self) -> &[f64] {
        both!(self, f => f.x())
    }
    pub(crate) fn knots(&self) -> &[f64] {
        match self {
            Self::Spline(f) => f.knots(),
            Self::Pieces(f) => f.x(),
        }
    }
    pub(crate) fn degree(&self) -> usize {
        both!(self, f => f.degree())
    }
    pub(crate) fn extrapolation(&self) -> Extrapolation {
        both!(self, f => f.extrapolation())
    }
    pub(crate) fn coefficients(&self) -> Vec<f64> {
        match self {
            Self::Spline(f) => f.bernstein_coefficients(),
            Self::Pieces(f) => f.coefficients().to_vec(),
        }
    }
    /// The same as pieces between these knots, its own among them.
    fn refined(&self, knots: &[f64]) -> PiecewisePolynomial {
        match self {
            Self::Spline(f) => f.to_piecewise().refined(knots),
            Self::Pieces(f) => f.refined(knots),
        }
    }
    pub(crate) fn to_bspline(self) -> BSpline {
        both!(self, f => f.to_bspline())
    }
    #[inline]
    pub(crate) fn evaluate(&self, x: f64, nu: usize, mode: Option<Extrapolation>) -> f64 {
        both!(self, f => f.evaluate(x, nu, mode))
    }
    /// Many values as a fresh vector.
    fn evaluate_many(&self, x: &[f64], nu: usize, mode: Option<Extrapolation>) -> Vec<f64> {
        match self {
            Self::Spline(f) => f.evaluate_many(x, nu, mode),
            Self::Pieces(f) => {
                let mut out = vec![0.0; x.len()];
                f.evaluate_into(x, nu, mode, &mut out);
                out
            }
        }
    }
    pub(crate) fn evaluate_into(
        &self,
        x: &[f64],
        nu: usize,
        mode: Option<Extrapolation>,
        out: &mut [f64],
    ) {
        both!(self, f => f.evaluate_into(x, nu, mode, out));
    }
    fn derivative(&self, nu: usize) -> PiecewisePolynomial {
        both!(self, f => f.derivative(nu))
    }
    fn antiderivative(&self, nu: usize) -> PiecewisePolynomial {
        both!(self, f => f.antiderivative(nu))
    }
    pub(crate) fn integrate(&self, a: f64, b: f64, mode: Option<Extrapolation>) -> f64 {
        both!(self, f => f.integrate(a, b, mode))
    }
    pub(crate) fn solve(&self, y: f64, mode: Option<Extrapolation>) -> Vec<f64> {
        both!(self, f => f.solve(y, mode))
    }
}

/// `count` fits on `size` numbers, in parallel where there is much to do, with a look for Ctrl-C before each and inside;
/// or the error of one of them and which.
pub(crate) fn fit_all<F: Send>(
    py: Python<'_>,
    size: usize,
    count: usize,
    one: impl Fn(usize, GoOn<'_>) -> Result<F, MonotoneError> + Send + Sync,
) -> PyResult<Result<Vec<F>, (usize, MonotoneError)>> {
    let fit = |k: usize, go_on: GoOn<'_>| {
        one(k, go_on).map_err(|error| match error {
            MonotoneError::Interrupted => None,
            error => Some((k, error)),
        })
    };
    let fits: Result<Vec<F>, _> = if size < PARALLEL {
        py.detach(|| (0..count).map(|k| fit(k, &|| ControlFlow::Continue(()))).collect())
    } else {
        interruptible(py, size, |go_on| {
            let fit = |k| if go_on() == ControlFlow::Break(()) { Err(None) } else { fit(k, go_on) };
            if count == 1 {
                // On this thread: what a long fit does itself in parallel finds the pool free.
                fit(0).map(|f| vec![f])
            } else {
                parallel::map(count, 0, fit)
            }
        })?
    };
    match fits {
        Ok(fits) => Ok(Ok(fits)),
        Err(Some(error)) => Ok(Err(error)),
        // Whoever asked to stop has been heard above.
        Err(None) => Err(PyKeyboardInterrupt::new_err(())),
    }
}

impl Fits {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Cubic(fits) => fits.len(),
            Self::Quartic(fits) => fits.len(),
            Self::Quintic(fits) => fits.len(),
            Self::Pieces(fits) => fits.len(),
        }
    }

    #[inline]
    pub(crate) fn column(&self, k: usize) -> Column<'_> {
        match self {
            Self::Cubic(fits) => Column::Spline(fits[k].spline()),
            Self::Quartic(fits) => Column::Spline(fits[k].spline()),
            Self::Quintic(fits) => Column::Spline(fits[k].spline()),
            Self::Pieces(fits) => Column::Pieces(&fits[k]),
        }
    }

    pub(crate) fn columns(&self) -> impl Iterator<Item = Column<'_>> {
        (0..self.len()).map(|k| self.column(k))
    }

    /// Column k alone.
    pub(crate) fn only(&self, k: usize) -> Self {
        match self {
            Self::Cubic(fits) => Self::Cubic(vec![fits[k].clone()]),
            Self::Quartic(fits) => Self::Quartic(vec![fits[k].clone()]),
            Self::Quintic(fits) => Self::Quintic(vec![fits[k].clone()]),
            Self::Pieces(fits) => Self::Pieces(vec![fits[k].clone()]),
        }
    }

    /// Numbers that describe all columns: the size of work on all of them.
    pub(crate) fn size(&self) -> usize {
        self.columns().map(|c| c.knots().len()).sum()
    }

    /// `work` on every column (and its index), in parallel where there is much of it.
    pub(crate) fn map<T: Send>(
        &self,
        py: Python<'_>,
        work: impl Fn(usize, Column<'_>) -> T + Send + Sync,
    ) -> Vec<T> {
        let size = self.size();
        without_gil(py, size, || {
            let one = |k| work(k, self.column(k));
            let few = size < PARALLEL || self.len() == 1;
            parallel::map(self.len(), if few { usize::MAX } else { 0 }, one)
        })
    }

    /// `work` of every column at its places `of(k)`, column after column; or the first column it fails on.
    pub(crate) fn each_at<'q, E: Send>(
        &self,
        py: Python<'_>,
        of: impl Fn(usize) -> &'q [f64] + Send + Sync,
        work: impl Fn(Column<'_>, &[f64], &mut [f64]) -> Result<(), E> + Send + Sync,
    ) -> PyResult<Result<Vec<f64>, (usize, E)>> {
        let size = (0..self.len()).map(|k| of(k).len()).sum();
        let mut out = zeros(size, 1)?;
        let mut rest = &mut out[..];
        let mut rows = Vec::with_capacity(self.len());
        for k in 0..self.len() {
            let row;
            (row, rest) = rest.split_at_mut(of(k).len());
            rows.push(((k, row), Ok(())));
        }
        let done = interruptible(py, size, |go_on| {
            let one = |(k, row): &mut (usize, &mut [f64])| {
                parts(row.len()).take_while(|_| go_on().is_continue()).try_for_each(|part| {
                    let (places, values) = (&of(*k)[part.clone()], &mut row[part]);
                    work(self.column(*k), places, values).map_err(|e| (*k, e))
                })
            };
            let few = size < PARALLEL || self.len() == 1;
            let put = |_, (row, done): &mut (_, Result<(), _>)| *done = one(row);
            parallel::fill(&mut rows, if few { usize::MAX } else { 0 }, put);
            // The first of the failures, whatever the order in which they come.
            rows.into_iter().try_for_each(|(_, done)| done)
        })?;
        Ok(done.map(|()| out))
    }

    pub(crate) fn derivative(&self, py: Python<'_>, nu: usize) -> Self {
        Self::Pieces(self.map(py, |_, c| c.derivative(nu)))
    }

    pub(crate) fn antiderivative(&self, py: Python<'_>, nu: usize) -> Self {
        Self::Pieces(self.map(py, |_, c| c.antiderivative(nu)))
    }

    /// Every column at the queries `of(k)`, column after column, each with `each` of them.
    pub(crate) fn evaluate<'q>(
        &self,
        py: Python<'_>,
        each: usize,
        of: impl Fn(usize) -> &'q [f64] + Send + Sync,
        nu: usize,
        mode: Option<Extrapolation>,
    ) -> PyResult<Vec<f64>> {
        let size = room(self.len(), each)?;
        if self.len() == 1 {
            let (column, x) = (self.column(0), of(0));
            let values = |part| Ok::<_, Infallible>(column.evaluate_many(&x[part], nu, mode));
            return Ok(in_parts(py, size, values)?.unwrap_or_else(|never| match never {}));
        }
        let mut out = vec![0.0; size];
        if out.is_empty() {
            return Ok(out);
        }
        interruptible(py, size, |go_on| {
            let work = |(): &mut (), start: usize, row: &mut [f64]| {
                let k = start / each;
                for part in parts(each).take_while(|_| go_on().is_continue()) {
                    self.column(k).evaluate_into(&of(k)[part.clone()], nu, mode, &mut row[part]);
                }
            };
            parallel::parts::<_, _, _, ()>(&mut *out, each, PARALLEL, || (), work);
        })?;
        Ok(out)
    }

    /// Whether all columns have as many points, and pieces of one degree.
    pub(crate) fn agree(&self) -> bool {
        let first = self.column(0);
        self.columns().all(|c| c.x().len() == first.x().len() && c.degree() == first.degree())
    }

    /// Whether all columns have the same knots.
    pub(crate) fn share_knots(&self) -> bool {
        let first = self.column(0);
        self.columns().all(|c| c.knots() == first.knots())
    }

    /// The columns as pieces between the knots of all of them.
    pub(crate) fn refined(&self) -> Self {
        let mut knots: Vec<f64> = self.columns().flat_map(|c| c.knots().to_vec()).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        Self::Pieces(self.columns().map(|c| c.refined(&knots)).collect())
    }

    /// What quintics minimise.
    pub(crate) fn fairness(&self) -> Option<Fairness> {
        match self {
            Self::Quintic(fits) => fits.first().map(|f| f.fairness()),
            _ => None,
        }
    }

    /// Whether what was read back can be asked anything without a panic.
    pub(crate) fn is_sound(&self) -> bool {
        let scales = match self {
            Self::Quartic(fits) => fits.iter().all(|f| f.scale().len() + 1 == f.x().len()),
            _ => true,
        };
        self.len() > 0 && scales
    }
}
