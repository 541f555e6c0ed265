// SPDX-License-Identifier: MIT OR Apache-2.0

//! Fewer criteria never make a curve that bends more.
//!
//! Tension that only a further criterion would have required can leave the curve fairer than less
//! tension elsewhere. So where a search for fewer criteria than usual had to raise any, the curve
//! that keeps all of them is found as well, and of the two the one that bends less is kept.

use shapespline_criteria::Criteria;
use shapespline_geometry::{Curve, DataPolygon, PiecewiseBezier, fairness};

use crate::{Fit, FitError, Interpolant, SearchOptions, Status, Strategy};

/// The fit, or that of `search` with all criteria where it keeps what is asked and bends less.
///
/// # Errors
/// Those of `search`.
pub(crate) fn or_of_all_criteria<C: Interpolant>(
    fit: Fit<C>,
    options: &SearchOptions,
    search: impl FnOnce(DataPolygon, &SearchOptions) -> Result<Fit<C>, FitError>,
) -> Result<Fit<C>, FitError> {
    let criteria = options.criteria.iter().fold(Criteria::OF_FITS, Criteria::with);
    let is_solved = |fit: &Fit<C>| fit.outcome.diagnostics.status == Status::Solved;
    let raised = fit.outcome.diagnostics.nodes_changed > 0;
    if options.strategy != Strategy::Fairest
        || criteria == options.criteria
        || !is_solved(&fit)
        || !raised
    {
        return Ok(fit);
    }
    let polygon = fit.curve.polygon();
    let other = search(polygon.clone(), &SearchOptions { criteria, ..*options })?;
    if !is_solved(&other) || bending(&other) >= bending(&fit) {
        return Ok(fit);
    }
    let legs = other.curve.curve().cubic().legs();
    let report = options.checker(polygon)?.report(|i| legs[i]);
    let is_proved = report.ok() && report.undecided.is_empty();
    Ok(if is_proved { Fit { report, ..other } } else { fit })
}

/// `∫κ²ds`, cut at the extrema of curvature: it may be all in one spike.
fn bending<C: Interpolant>(fit: &Fit<C>) -> f64 {
    let found = fairness(&PiecewiseBezier::from(fit.curve.curve().cubic()));
    found.bending / found.length
}
