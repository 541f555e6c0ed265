// SPDX-License-Identifier: MIT OR Apache-2.0

//! Monotone interpolation of one variable: the C² cubic of least bending energy, and Bézier-like splines.
//!
//! # Definition
//! Data `(xᵢ, yᵢ)`, i = 0 … N, x increasing; spacing `hᵢ = xᵢ₊₁ − xᵢ`, secant `Δᵢ = (yᵢ₊₁ − yᵢ)/hᵢ`.
//! - [`MonotoneCubic`]: C², of all monotone functions the one with the least `∫ f''² dx`.
//! - [`MonotoneQuartic`]: C¹, local. On every segment the quartic Bézier-like curve (3) of the paper.
//! - [`MonotoneQuintic`]: C², global. On every segment a quintic; slopes and second derivatives at the knots are
//!   chosen so that a bending energy is least.
//! - [`smooth_monotone`]: noisy data, smoothed by monotone cubics.
//! - [`check_monotone`]: whether any piecewise polynomial rises, falls and bends as its data do.
//! - [`bezier_like`]: the curves themselves, in any dimension.
//!
//! # Guarantee
//! Every segment is monotone: increasing where its data increase, decreasing where they decrease, constant where
//! they are. So the interpolant is monotone on every interval where the data are, has no extremum that the data do
//! not have and never leaves the interval between neighbouring values. Signs are decided by Bernstein coefficients
//! and their subdivision, never by sampling. Results scale with the data (powers of two exactly) and reflect with
//! them.
//!
//! # Sources
//! Paper 003: Ng, Kong and Ong, *A class of Bézier-like splines in smooth monotone interpolation*; equation numbers
//! in this crate are its. Corrections E11 (`p = a/2, q = g/2`), E12 (a missing factor in (8)) and E13 (the chain that
//! bounds λ) and the box form of the program are those of the project's specification. Slopes: Fritsch and Butland,
//! *SIAM J. Sci. Stat. Comput.* 5 (1984) 300–304.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_monotone::{CubicOptions, MonotoneCubic};
//! let f = MonotoneCubic::new(&[0.0, 1.0, 2.0, 5.0], &[0.0, 0.1, 3.0, 3.2], &CubicOptions::default())?;
//! assert_eq!(f.value(2.0), 3.0);
//! let x = f.inverse(1.5)?;
//! assert!((f.value(x) - 1.5).abs() < 1e-15);
//! # Ok::<(), shapespline_monotone::MonotoneError>(())
//! ```

// Negated comparisons are meant: they catch NaN as well. Index loops follow the formulas, over several arrays at once.
#![allow(clippy::neg_cmp_op_on_partial_ord, clippy::needless_range_loop)]

mod beyond;
pub mod bezier_like;
mod box_qp_blocks;
mod bspline;
mod calculus;
mod check;
mod chunked;
mod cubic;
mod data;
mod energy;
mod error;
mod evaluate;
mod extrapolation;
mod given;
mod integrals;
mod interrupt;
mod inverse;
mod many;
#[cfg(feature = "nlopt")]
pub mod nlopt_reference;
mod optimal;
mod overlapping_blocks;
mod periodic;
mod piecewise;
mod program;
mod quartic;
mod quintic;
#[cfg(test)]
mod reference;
mod region;
mod roots;
mod segment_polynomial;
mod slopes;
mod smooth;
mod spline;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;

pub use bezier_like::BezierLike;
pub use bspline::BSpline;
pub use check::{MonotoneRecord, MonotoneReport, check_monotone};
pub use cubic::{Convexity, CubicOptions, Ends, MonotoneCubic, minimal_bending};
pub use energy::Fairness;
pub use error::MonotoneError;
pub use extrapolation::{Continuation, Extrapolation};
pub use many::{MonotoneMany, fit_columns, fit_rows};
pub use piecewise::PiecewisePolynomial;
pub use quartic::{MonotoneQuartic, QuarticOptions, ShapeParameters};
pub use quintic::{Diagnostics, MonotoneQuintic, QuinticOptions, Slopes, SolverKind};
pub use smooth::{PenaltyChoice, SmoothOptions, Smoothing, smooth_monotone, smooth_monotone_with};
pub use spline::MonotoneSpline;
