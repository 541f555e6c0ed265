// SPDX-License-Identifier: MIT OR Apache-2.0

//! ν-splines: G² cubic interpolation of points in space, with tension found automatically.
//!
//! **Definition.** The ν-spline through `I_0 … I_N` at `u_0 < … < u_N` is the C¹ piecewise cubic with
//! tangents `q_i` whose second derivative jumps along the tangent,
//! `Q''(u_i⁺) − Q''(u_i⁻) = ν_i q_i / √(h_{i−1} h_i)`, so that curvature is continuous (G²). The
//! tensions `ν_i ≥ 0` are dimensionless; `ν = 0` gives the C² cubic spline, `ν → ∞` the polygon.
//!
//! **Guarantee.** For every `ν ≥ 0` the spline exists and is unique: its system is strictly diagonally
//! dominant. [`NuSpline::shape_preserving`](Spline::shape_preserving) returns with status `Solved` only a curve that was solved
//! and checked completely, every criterion decided exactly.
//!
//! **Cost.** O(N) to build; the search costs one build and check, and then what its violations need.
//!
//! Source: M. I. Karavelas, P. D. Kaklis, *Spatial shape-preserving interpolation using ν-splines*,
//! Numerical Algorithms 23 (2000) 217–250 ("paper 001"), section 3 with erratum E2, section 5.2 with
//! E3–E5; G. M. Nielson, *Some piecewise polynomial alternatives to splines under tension*, 1974.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_nu::geometry::{Boundary, DVec3, DataPolygon, Parametrization};
//! use shapespline_nu::{Interpolant, NuSpline, SearchOptions};
//!
//! let points = vec![
//!     DVec3::new(0.0, 0.0, 0.0),
//!     DVec3::new(2.0, 0.0, 0.1),
//!     DVec3::new(4.0, 0.1, 0.1),
//!     DVec3::new(4.5, 0.4, 0.2),
//!     DVec3::new(4.6, 3.0, 0.2),
//!     DVec3::new(4.6, 6.0, 0.3),
//! ];
//! let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;
//! let fit = NuSpline::shape_preserving(polygon, &SearchOptions::default())?;
//! assert!(fit.report.ok());
//! println!("{}", fit.curve.curve().evaluate(2.0, 0, Default::default()));
//! # Ok::<(), shapespline_nu::FitError>(())
//! ```

mod spline;
mod system;

/// Criteria, tolerances and the report.
pub use shapespline_search::criteria;
/// Points, their parameters and ends, and the evaluation of curves.
pub use shapespline_search::geometry;
pub use shapespline_search::{
    Fit, FitError, Interpolant, SearchOptions, Spline, Status, Strategy, Tension,
};
pub use spline::{Nu, NuSpline};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
