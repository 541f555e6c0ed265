// SPDX-License-Identifier: MIT OR Apache-2.0

//! Splines that interpolate data **and keep its shape**: curves through points in the plane and in
//! space, and functions of one variable.
//!
//! This crate re-exports the crates of the workspace under one name; each can be used alone.
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! | module | what it holds |
//! |---|---|
//! | [`fair`] | fair curves: C² cubics with extra knots, the least energy that keeps the shape |
//! | [`nu`] | ν-splines: G², one linear system |
//! | [`tension`] | C² tension cubics: C² in a parameter of their own, one linear system |
//! | [`catmull_rom`] | Catmull–Rom: C¹ or G¹, local, shape-preserving in closed form |
//! | [`monotone`] | functions of one variable: C² monotone cubics of least bending energy, C² quintics, C¹ quartics, smoothing |
//! | [`criteria`] | the shape criteria, decided exactly, and their report |
//! | [`geometry`] | data polygon, parametrisations, Bézier segments, exact signs, piecewise curves |
//! | [`search`] | automatic tension: raise where a criterion fails, then lower |
//! | [`banded`] | tridiagonal, cyclic and block solvers |
//! | [`polynomial`] | Bernstein polynomials whose signs are proved, bracketed roots, knot search, shared work |
//!
//! ```
//! use shapespline::prelude::*;
//!
//! // Two nearly straight runs and a sharp bend between them.
//! let points = vec![
//!     DVec3::new(0.0, 0.0, 0.0),
//!     DVec3::new(2.0, 0.0, 0.1),
//!     DVec3::new(4.0, 0.1, 0.1),
//!     DVec3::new(4.5, 0.4, 0.2),
//!     DVec3::new(4.6, 3.0, 0.2),
//!     DVec3::new(4.6, 6.0, 0.3),
//! ];
//! let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;
//!
//! // The C² cubic bulges the wrong way before and after the bend …
//! let cubic = NuSpline::new(polygon.clone(), Tension::Uniform(0.0))?;
//! let report = cubic.check(Criteria::DEFAULT, Tolerances::default())?;
//! assert_eq!(report.count(Criterion::Convexity).violated, 2);
//!
//! // … the shape-preserving ν-spline does not.
//! let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default())?;
//! assert!(fit.report.ok());
//! println!("{}", fit.curve.curve().evaluate(1.0, 0, Side::Right));
//!
//! // The same promise for functions: rising data, a rising function.
//! let (x, y) = ([0.0, 1.0, 2.0, 5.0], [0.0, 0.1, 3.0, 3.2]);
//! let f = MonotoneCubic::new(&x, &y, &CubicOptions::default())?;
//! assert!(f.derivative(1).evaluate(4.0, 0, None) >= 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[doc(inline)]
pub use shapespline_banded as banded;
#[doc(inline)]
pub use shapespline_catmull_rom as catmull_rom;
#[doc(inline)]
pub use shapespline_criteria as criteria;
#[doc(inline)]
pub use shapespline_fair as fair;
#[doc(inline)]
pub use shapespline_geometry as geometry;
#[doc(inline)]
pub use shapespline_monotone as monotone;
#[doc(inline)]
pub use shapespline_nu as nu;
#[doc(inline)]
pub use shapespline_polynomial as polynomial;
#[doc(inline)]
pub use shapespline_search as search;
#[doc(inline)]
pub use shapespline_tension as tension;

/// What most users need.
pub mod prelude {
    pub use shapespline_catmull_rom::{CatmullRom, Continuity, Directions, HandleOptions};
    pub use shapespline_criteria::{Checker, Criteria, Criterion, ShapeReport, Tolerances};
    pub use shapespline_fair::{Energy, FairOptions, FairSpline};
    pub use shapespline_geometry::{
        ArcLength, Boundary, Curve, DVec3, DataPolygon, Dimension, Parametrization, PiecewiseCubic,
        Ragged, Repeated, Side,
    };
    pub use shapespline_monotone::{
        CubicOptions, MonotoneCubic, MonotoneQuartic, MonotoneQuintic, QuarticOptions,
        QuinticOptions,
    };
    pub use shapespline_nu::NuSpline;
    pub use shapespline_search::{
        Collection, Fit, FitError, Interpolant, SearchOptions, Status, Strategy, Tension, fit_many,
    };
    pub use shapespline_tension::{TangentScale, TensionSpline};
}

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
