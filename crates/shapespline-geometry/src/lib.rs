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

mod arc_length;
mod batch;
pub mod bernstein;
mod boundary;
mod bspline;
mod curve;
mod error;
mod fairness;
mod frame;
mod input;
mod locate;
mod monotone;
mod parametrization;
mod piecewise;
mod piecewise_bezier;
mod polygon;
pub mod polynomial;
mod quadrature;
mod ragged;
mod reparametrized;
mod segment;
mod stretch;
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
pub use locate::{Locator, Side};
pub use monotone::MonotoneCubic;
pub use parametrization::Parametrization;
pub use piecewise::{Domain, PiecewiseCubic};
pub use piecewise_bezier::{BezierPart, PiecewiseBezier};
pub use polygon::{DataPolygon, Dimension, Span, ends_agree};
pub use ragged::Ragged;
pub use reparametrized::ReparametrizedCubic;
pub use segment::CubicSegment;
pub use stretch::{Lanes, Stretch};
pub use vector::{length, near_one, normalize};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
