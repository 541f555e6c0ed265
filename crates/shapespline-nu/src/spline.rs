// SPDX-License-Identifier: MIT OR Apache-2.0

//! The ν-spline interpolant.

use shapespline_geometry::{DataPolygon, InputError, PiecewiseCubic};
use shapespline_search::{Spline, Tension, family::SplineFamily};

use crate::system::NuSystem;

/// A ν-spline through points in the plane or in space. Immutable.
///
/// Tension is any number from 0. [`NuSpline::shape_preserving`](Spline::shape_preserving) finds it: algorithm
/// NUSSP and its successors.
pub type NuSpline = Spline<Nu>;

/// The family of the ν-splines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Nu;

impl SplineFamily for Nu {
    type Curve = PiecewiseCubic;
    type Tension<'a> = Tension<'a>;
    type System<'p> = NuSystem<'p>;

    fn system<'p>(
        polygon: &'p DataPolygon,
        tension: Tension<'_>,
    ) -> Result<NuSystem<'p>, InputError> {
        Ok(NuSystem { polygon, tension: tension.non_negative(polygon)? })
    }

    fn without_tension(polygon: &DataPolygon) -> NuSystem<'_> {
        NuSystem { polygon, tension: vec![0.0; polygon.nodes()] }
    }

    fn curve(
        cubic: PiecewiseCubic,
        system: NuSystem<'_>,
    ) -> Result<(PiecewiseCubic, Vec<f64>), InputError> {
        Ok((cubic, system.tension))
    }
}
