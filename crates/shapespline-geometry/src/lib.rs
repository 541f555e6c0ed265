// SPDX-License-Identifier: MIT OR Apache-2.0

//! Geometry primitives of interpolating space curves.
//!
//! Data flows one way through this crate: points and a [`Parametrization`] make a [`DataPolygon`]
//! (chords, binormal vectors, the sign of the discrete torsion); a spline family turns the polygon
//! into end legs of cubic Bézier segments; [`PiecewiseCubic`] stores and evaluates them; and
//! [`CubicSegment`] answers every question about one segment in closed form. Curves that were not made
//! here come in as a [`PiecewiseBezier`] of any degree, rational or not.
//!
//! Notation (one for all papers): points `I_0 … I_N`, parameters `u_0 < … < u_N`, spacing
//! `h_i = u_{i+1} − u_i`, chords `L_i = I_{i+1} − I_i`, binormal vectors `P_i = L_{i−1} × L_i`,
//! `Γ_i = det[L_{i−1}, L_i, L_{i+1}]`. A cubic segment has Bézier legs `a, b, c`.
//!
//! Sources: M. I. Karavelas, P. D. Kaklis, *Spatial shape-preserving interpolation using
//! ν-splines*, Numerical Algorithms 23 (2000); R. S. Gautam, *Shape preservation behavior of
//! spline curves*.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_geometry::{Boundary, DVec3, DataPolygon, Parametrization, PiecewiseCubic, Side};
//!
//! let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)];
//! let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;
//! assert_eq!(polygon.binormal(1), DVec3::Z); // the polygon turns to the left at node 1 …
//! assert!(polygon.gamma(1) > 0.0); // … and twists to the right on segment 1
//!
//! // Handles of a third of each chord: the polygon itself, as a curve.
//! let legs = (0..polygon.segments()).map(|i| [polygon.chord(i) / 3.0; 2]).collect();
//! let curve = PiecewiseCubic::through(&polygon, legs)?;
//! assert_eq!(curve.evaluate(0.5, 0, Side::Right), DVec3::new(0.5, 0.0, 0.0));
//! # Ok::<(), shapespline_geometry::InputError>(())
//! ```

mod arc_length;
// Reached by the crates that check and shape segments in batches; users meet segments one at a time.
#[doc(hidden)]
pub mod batch;
mod boundary;
mod bspline;
mod curve;
mod error;
mod evaluate_many;
mod fairness;
mod frame;
mod input;
mod parametrization;
mod piecewise;
mod piecewise_bezier;
mod polygon;
mod quadrature;
mod ragged;
mod reparametrization;
mod reparametrized;
mod segment;
mod side;
mod vector;

pub use arc_length::ArcLength;
pub use boundary::Boundary;
pub use curve::Curve;
pub use error::{Coordinates, InputError};
pub use fairness::{
    CurvatureExtremum, Fairness, Place, fairness, fairness_with, largest_curvature,
};
pub use frame::Frame;
pub use glam::{DVec3, DVec4};
pub use input::{InputMap, InputPoints, Repeated};
pub use parametrization::Parametrization;
pub use piecewise::{Domain, PiecewiseCubic};
pub use piecewise_bezier::{BezierPart, PiecewiseBezier};
pub use polygon::{DataPolygon, Dimension, Span, ends_agree};
pub use ragged::Ragged;
pub use reparametrization::MonotoneCubic;
pub use reparametrized::ReparametrizedCubic;
pub use segment::CubicSegment;
/// Bernstein polynomials and what proves their signs.
pub use shapespline_polynomial as polynomial;
pub use side::Side;
pub use vector::{length, normalize, normalized_scale};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
