//! Splines that interpolate data **and keep its shape**.
//!
//! This crate re-exports the crates of the workspace under one name; each can be used alone.
//!
//! | module | what it holds |
//! |---|---|
//! | [`geometry`] | data polygon, parametrisations, Bézier segments, exact signs, piecewise curves |
//! | [`banded`] | tridiagonal and cyclic solvers |
//! | [`criteria`] | the shape criteria, decided exactly, and their report |
//! | [`search`] | automatic tension: raise where a criterion fails, then relax |
//! | [`nu`] | G² cubic ν-splines |
//!
//! ```
//! use shapespline::prelude::*;
//!
//! // A flat stretch, a sharp bend out of the plane, another flat stretch.
//! let points = vec![
//!     DVec3::new(0.0, 0.0, 0.0),
//!     DVec3::new(4.0, 0.0, 0.0),
//!     DVec3::new(4.5, 0.5, 0.0),
//!     DVec3::new(4.5, 1.0, 0.5),
//!     DVec3::new(4.5, 1.0, 5.0),
//! ];
//! let polygon = DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature)?;
//!
//! let cubic = NuSpline::new(polygon.clone(), Tension::Uniform(0.0))?;
//! assert!(!cubic.check(Criteria::ALL, Tolerances::default())?.ok());
//!
//! let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default())?;
//! assert!(fit.report.ok());
//! let middle = fit.curve.curve().evaluate(2.0, 0, Side::Right);
//! assert!(middle.y.abs() < 0.2);
//! # Ok::<(), FitError>(())
//! ```

pub use shapespline_banded as banded;
pub use shapespline_criteria as criteria;
pub use shapespline_geometry as geometry;
pub use shapespline_nu as nu;
pub use shapespline_search as search;

/// What most users need.
pub mod prelude {
    pub use shapespline_criteria::{Checker, Criteria, Criterion, ShapeReport, Tolerances};
    pub use shapespline_geometry::{
        ArcLength, Boundary, DVec3, DataPolygon, Dimension, Parametrization, PiecewiseCubic, Side,
    };
    pub use shapespline_nu::{Fit, FitError, NuSpline, SearchOptions, Status, Strategy, Tension};
}
