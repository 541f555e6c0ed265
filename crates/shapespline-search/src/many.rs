// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many curves at once: streamlines, tool paths, tracks.

use std::{borrow::Cow, ops::Range};

use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Dimension, InputError, InputMap, InputPoints, Parametrization,
    Ragged, Repeated, ends_agree,
};

use crate::FitError;

/// A ragged collection of points, one row a curve, and how their polygons are made.
#[derive(Debug, Clone)]
pub struct Collection<'a> {
    /// The points of all curves.
    pub points: Ragged<'a, DVec3>,
    /// Planar (third coordinates zero) or spatial.
    pub dimension: Dimension,
    /// How parameters are chosen; given ones hold those of all curves, one after the other.
    pub parametrization: Parametrization,
    /// The end conditions of every curve.
    pub boundary: Boundary,
    /// Whether the first point of every curve is also its last, as for [`InputPoints::closed`].
    pub closed: bool,
    /// What is done about repeated points.
    pub repeated: Repeated,
}

impl Collection<'_> {
    /// Checks that given parameters are as many as the curves need, and returns where those of each curve
    /// lie; the ranges are those of the points unless closed curves have one more.
    ///
    /// # Errors
    /// Another number of given parameters.
    pub fn check(&self) -> Result<Vec<Range<usize>>, InputError> {
        let Parametrization::Given(all) = &self.parametrization else { return Ok(Vec::new()) };
        let mut end = 0;
        let range = |k: usize| {
            let row = self.points.row(k);
            let start = end;
            end += row.len() + usize::from(self.closed && row.len() > 1 && !ends_agree(row));
            start..end
        };
        let ranges: Vec<Range<usize>> = (0..self.points.len()).map(range).collect();
        let (expected, found) = (end, all.len());
        if found == expected {
            return Ok(ranges);
        }
        let per = match self.closed {
            true => "one for each point, and one for each return to a first point",
            false => "one for each point",
        };
        Err(InputError::Length { argument: "parameters", expected, found, per })
    }

    /// Fits curve `k` of a collection; `ranges` are those of its [check](Self::check).
    ///
    /// # Errors
    /// Points that make no polygon; those of `fit`.
    pub fn fit<C>(
        &self,
        k: usize,
        ranges: &[Range<usize>],
        fit: impl FnOnce(DataPolygon, InputMap) -> Result<C, FitError>,
    ) -> Result<C, FitError> {
        let parametrization = match &self.parametrization {
            Parametrization::Given(all) => {
                Cow::Owned(Parametrization::Given(all[ranges[k].clone()].to_vec()))
            }
            chosen => Cow::Borrowed(chosen),
        };
        let points = self.points.row(k).to_vec();
        let Self { dimension, boundary, closed, repeated, .. } = *self;
        let parametrization = parametrization.into_owned();
        let input = InputPoints { points, dimension, parametrization, boundary, closed, repeated };
        let (polygon, map) = input.polygon()?;
        fit(polygon, map)
    }
}

/// Fits every curve of a collection, in parallel. What `fit` makes of a polygon may be a curve of any
/// family, with or without a search; the error of one curve leaves the others as they are.
///
/// `threads`: `None` takes rayon's pool as it is. Results are in the order of the rows, and do not
/// depend on the number of threads.
///
/// # Errors
/// Zero threads; given parameters that are not as many as the points.
pub fn fit_many<C: Send>(
    collection: &Collection<'_>,
    threads: Option<usize>,
    fit: impl Fn(DataPolygon) -> Result<C, FitError> + Sync,
) -> Result<Vec<Result<C, FitError>>, InputError> {
    let ranges = collection.check()?;
    collection.points.map(threads, |k, _| collection.fit(k, &ranges, |polygon, _| fit(polygon)))
}
