// SPDX-License-Identifier: MIT OR Apache-2.0

//! C² tension cubics: interpolation of points in space by a curve with continuous second derivative,
//! with tension found automatically.
//!
//! **Definition.** On segment `i` the curve is the cubic `C` with end legs `h λ⁰_i T_i/3` and
//! `h λ¹_i T_{i+1}/3`, `0 < λ⁰_i, λ¹_i ≤ 1`, and the parameter `s` is a cubic too, with end slopes
//! `λ⁰_i, λ¹_i` (increasing, because they are positive and at most one). `Q(s) = C(t(s))` has the
//! derivatives `T_i` at the points, and it is C² when the `T_i` solve (3.7)–(3.8), with
//! `w = h_i(λ⁰_i)² / (h_i(λ⁰_i)² + h_{i−1}(λ¹_{i−1})²)` in a form without unit
//!
//! `w λ⁰_{i−1} T_{i−1} + [w(3−λ⁰_{i−1}) + (1−w)(3−λ¹_i)] T_i + (1−w) λ¹_i T_{i+1}
//!  = 3 [w L_{i−1}/h_{i−1} + (1−w) L_i/h_i]`.
//!
//! `λ = 1` is the classical C² cubic spline, `λ → 0` the polygon. The tension of a node is `1/λ − 1`,
//! of the smaller of its two `λ`.
//!
//! **Guarantee.** For all `λ` in `(0, 1]` the curve exists and is unique (Theorem 3.1): the system is
//! strictly diagonally dominant. [`TensionSpline::shape_preserving`](Spline::shape_preserving) returns with status `Solved`
//! only a curve that was solved and checked completely, every criterion decided exactly. The search raises the
//! two tensions at a node together, and lowers each of the two by itself.
//!
//! **Identity with ν-splines (3.10).** With one `λ_i` a node the image is that of the ν-spline with
//! `ν_i = √(h_{i−1}h_i) [(6−4λ_i−2λ_{i+1})/h_i + (6−2λ_{i−1}−4λ_i)/h_{i−1}]/λ_i`.
//!
//! **Cost.** O(N) to build; the search costs one build and check, and then what its violations need.
//! Evaluation at `s` solves one monotone cubic.
//!
//! Source: C. Manni, *Parametric shape-preserving spatial interpolation and ν-splines*, Algorithms
//! for Approximation IV (2001) ("paper 000"); natural ends are ours.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_tension::geometry::{
//!     Boundary, Curve, DVec3, DataPolygon, Parametrization, Side,
//! };
//! use shapespline_tension::{Interpolant, TensionSpline};
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
//! let fit = TensionSpline::shape_preserving(polygon, &TensionSpline::options())?;
//! assert!(fit.report.ok());
//! let knot = fit.curve.curve().cubic().knots()[3];
//! let [before, after] =
//!     [Side::Left, Side::Right].map(|side| fit.curve.curve().evaluate(knot, 2, side));
//! assert!((before - after).length() < 1e-12 * before.length());
//! # Ok::<(), shapespline_tension::FitError>(())
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
pub use spline::{Manni, TangentScale, TensionSpline};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
