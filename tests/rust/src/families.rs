// SPDX-License-Identifier: MIT OR Apache-2.0

//! Every family behind one face, so that every property is tested for all of them.

use shapespline::{
    geometry::PiecewiseCubic,
    prelude::*,
    search::{Diagnostics, Outcome},
};

/// A way to a shape-preserving curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Family {
    /// ν-splines.
    Nu(Strategy),
    /// C² tension cubics.
    Tension(Strategy),
    /// Catmull–Rom.
    CatmullRom(Continuity),
}

impl Family {
    /// One way a family, each with its default search.
    pub const DEFAULTS: [Self; 4] = [
        Self::Nu(Strategy::Fairest),
        Self::Tension(Strategy::Fairest),
        Self::CatmullRom(Continuity::C1),
        Self::CatmullRom(Continuity::G1),
    ];

    /// Every way.
    pub const ALL: [Self; 8] = [
        Self::Nu(Strategy::Nussp),
        Self::Nu(Strategy::Growth),
        Self::Nu(Strategy::Fairest),
        Self::Tension(Strategy::Reduction),
        Self::Tension(Strategy::Growth),
        Self::Tension(Strategy::Fairest),
        Self::CatmullRom(Continuity::C1),
        Self::CatmullRom(Continuity::G1),
    ];

    /// The shape-preserving curve of a polygon.
    #[must_use]
    pub fn fit(self, polygon: DataPolygon) -> Fitted {
        self.try_fit(polygon).unwrap()
    }

    /// As [`Family::fit`], with the error.
    ///
    /// # Errors
    /// Those of the family.
    pub fn try_fit(self, polygon: DataPolygon) -> Result<Fitted, FitError> {
        match self {
            Self::Nu(strategy) => {
                let options = SearchOptions { strategy, ..SearchOptions::default() };
                NuSpline::shape_preserving(polygon, &options).map(Fitted::of)
            }
            Self::Tension(strategy) => {
                let step = if strategy == Strategy::Reduction { 0.5 } else { 0.25 };
                let options = SearchOptions { strategy, step, ..SearchOptions::default() };
                TensionSpline::shape_preserving(polygon, &options).map(Fitted::of)
            }
            Self::CatmullRom(continuity) => {
                let options = HandleOptions { continuity, ..HandleOptions::default() };
                CatmullRom::shape_preserving(polygon, &options).map(Fitted::of)
            }
        }
    }

    /// The curve without any tension.
    #[must_use]
    pub fn plain(self, polygon: DataPolygon) -> Box<dyn Interpolation> {
        match self {
            Self::Nu(_) => Box::new(NuSpline::new(polygon, Tension::Uniform(0.0)).unwrap()),
            Self::Tension(_) => {
                Box::new(TensionSpline::new(polygon, TangentScale::Uniform(1.0)).unwrap())
            }
            Self::CatmullRom(continuity) => {
                Box::new(CatmullRom::new(polygon, Tension::Uniform(0.0), continuity).unwrap())
            }
        }
    }
}

/// [`Interpolant`] without the type of its curve.
pub trait Interpolation: Send + Sync {
    /// The curve.
    fn curve(&self) -> &dyn Curve;
    /// The tension at each point.
    fn tension(&self) -> &[f64];
    /// The report on its own data.
    fn report(&self) -> ShapeReport;
}

impl<C: Interpolant<Curve: Sized> + Send + Sync> Interpolation for C {
    fn curve(&self) -> &dyn Curve {
        Interpolant::curve(self)
    }
    fn tension(&self) -> &[f64] {
        Interpolant::tension(self)
    }
    fn report(&self) -> ShapeReport {
        self.check(Criteria::OF_FITS, Tolerances::default()).unwrap()
    }
}

/// A fit of any family.
pub struct Fitted {
    /// The curve with its tension.
    pub spline: Box<dyn Interpolation>,
    /// How it was found.
    pub outcome: Outcome,
    /// The report that came with it.
    pub report: ShapeReport,
}

impl Fitted {
    fn of<C: Interpolant<Curve: Sized> + Send + Sync + 'static>(fit: Fit<C>) -> Self {
        Self { spline: Box::new(fit.curve), outcome: fit.outcome, report: fit.report }
    }

    /// The image.
    #[must_use]
    pub fn cubic(&self) -> &PiecewiseCubic {
        self.spline.curve().cubic()
    }

    /// Counts of the search.
    #[must_use]
    pub fn diagnostics(&self) -> Diagnostics {
        self.outcome.diagnostics
    }
}
