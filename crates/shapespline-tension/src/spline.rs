// SPDX-License-Identifier: MIT OR Apache-2.0

//! The C² tension cubic interpolant.

use shapespline_geometry::{DataPolygon, InputError, PiecewiseCubic, ReparametrizedCubic};
use shapespline_search::{Spline, Tension, family::SplineFamily};

use crate::system::ManniSystem;

/// The scale `λ` of tangents in legs, each between `1e−65` and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TangentScale<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One number a point; for closed data the last is the first again.
    Nodes(&'a [f64]),
    /// `λ⁰` and `λ¹`, each one number a segment.
    Segments(&'a [f64], &'a [f64]),
}

const ALLOWED: &str = "between 1e-65 and 1";
/// The least `λ`: third derivatives grow as its fourth power falls, and have to stay finite.
const LEAST: f64 = 1e-65;

impl TangentScale<'_> {
    /// `[λ⁰, λ¹]` of each segment, checked.
    fn slopes(self, polygon: &DataPolygon) -> Result<Vec<[f64; 2]>, InputError> {
        const ARGUMENT: &str = "tangent_scale";
        let valid = |x: f64| (LEAST..=1.0).contains(&x);
        let nodal = |tension: Tension<'_>| {
            let nodes = tension.nodal(polygon, ARGUMENT, ALLOWED, valid)?;
            let end = |i: usize| nodes[(i + 1) % nodes.len()];
            Ok((0..polygon.segments()).map(|i| [nodes[i], end(i)]).collect())
        };
        let (starts, ends) = match self {
            Self::Uniform(value) => return nodal(Tension::Uniform(value)),
            Self::Nodes(values) => return nodal(Tension::Nodes(values)),
            Self::Segments(starts, ends) => (starts, ends),
        };
        for (argument, values) in [("tangent_scale[0]", starts), ("tangent_scale[1]", ends)] {
            let (expected, found) = (polygon.segments(), values.len());
            if found != expected {
                let per = "one for each segment";
                return Err(InputError::Length { argument, expected, found, per });
            }
            if let Some(index) = values.iter().position(|&x| !valid(x)) {
                let (value, allowed) = (values[index], ALLOWED);
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
        }
        Ok(starts.iter().zip(ends).map(|(&start, &end)| [start, end]).collect())
    }
}

/// A C² tension cubic through points in the plane or in space. Immutable.
///
/// Its parameter is Manni's `s`: equal to the data's parameters at the points, and such that the
/// curve is C² in it. The image alone, run through linearly on each segment, is
/// `curve().cubic()`, and `[λ⁰, λ¹]` of each segment are `curve().slopes()`.
pub type TensionSpline = Spline<Manni>;

/// The family of the C² tension cubics, which are Manni's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Manni;

impl SplineFamily for Manni {
    /// Of `1/λ − 1`.
    const STEP: f64 = 0.25;

    type Curve = ReparametrizedCubic;
    type Tension<'a> = TangentScale<'a>;
    type System<'p> = ManniSystem<'p>;

    fn system<'p>(
        polygon: &'p DataPolygon,
        scale: TangentScale<'_>,
    ) -> Result<ManniSystem<'p>, InputError> {
        Ok(ManniSystem::new(polygon, scale.slopes(polygon)?))
    }

    fn without_tension(polygon: &DataPolygon) -> ManniSystem<'_> {
        ManniSystem::without_tension(polygon)
    }

    fn curve(
        cubic: PiecewiseCubic,
        system: ManniSystem<'_>,
    ) -> Result<(ReparametrizedCubic, Vec<f64>), InputError> {
        let (slopes, tension) = system.into_parts();
        Ok((ReparametrizedCubic::new(cubic, slopes)?, tension))
    }
}
