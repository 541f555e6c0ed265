//! Many curves at once: streamlines, tool paths, tracks.

use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Dimension, InputError, Parametrization, Ragged,
};

use crate::FitError;

/// A ragged collection of points, one row a curve, and how their polygons are made.
#[derive(Debug, Clone)]
pub struct Collection<'a> {
    /// The points of all curves.
    pub points: Ragged<'a, DVec3>,
    /// Planar (third coordinates zero) or spatial.
    pub dimension: Dimension,
    /// How parameters are chosen; given ones hold one a point of the whole collection.
    pub parametrization: Parametrization,
    /// The end conditions of every curve.
    pub boundary: Boundary,
}

impl Collection<'_> {
    /// Sees to it that given parameters are one a point.
    ///
    /// # Errors
    /// Given parameters that are not.
    pub fn check(&self) -> Result<(), InputError> {
        let Parametrization::Given(all) = &self.parametrization else { return Ok(()) };
        let rows = &self.points;
        let expected = if rows.is_empty() { 0 } else { rows.range(rows.len() - 1).end };
        if all.len() == expected {
            return Ok(());
        }
        let (argument, found, per) = ("parameters", all.len(), "one for each point");
        Err(InputError::Length { argument, expected, found, per })
    }

    /// Fits curve `k` of a collection that was [checked](Self::check).
    ///
    /// # Errors
    /// Points that make no polygon; those of `fit`.
    pub fn fit<C>(
        &self,
        k: usize,
        fit: impl FnOnce(DataPolygon) -> Result<C, FitError>,
    ) -> Result<C, FitError> {
        let given;
        let parametrization = match &self.parametrization {
            // Each curve has its part; a whole of another length is refused before.
            Parametrization::Given(all) => {
                given = Parametrization::Given(all[self.points.range(k)].to_vec());
                &given
            }
            chosen => chosen,
        };
        let points = self.points.row(k).to_vec();
        fit(DataPolygon::with_dimension(points, self.dimension, parametrization, self.boundary)?)
    }
}

/// Fits every curve of a collection, in parallel. What `fit` makes of a polygon may be a curve of any
/// family, with or without a search; the fault of one curve leaves the others as they are.
///
/// `threads`: `None` takes rayon's pool as it is. Results are in the order of the rows, and do not
/// depend on the number of threads.
///
/// # Errors
/// Zero threads; given parameters that are not one a point.
pub fn fit_many<C: Send>(
    collection: &Collection<'_>,
    threads: Option<usize>,
    fit: impl Fn(DataPolygon) -> Result<C, FitError> + Sync,
) -> Result<Vec<Result<C, FitError>>, InputError> {
    collection.check()?;
    collection.points.map(threads, |k, _| collection.fit(k, &fit))
}
