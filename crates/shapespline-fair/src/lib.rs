// SPDX-License-Identifier: MIT OR Apache-2.0

//! Fair curves that keep the shape of their data: C² cubics with at most two extra knots per segment and
//! no more energy than the shape needs.
//!
//! **Definition.** Between two data points the curve is a cubic B-spline with two extra knots, at a
//! quarter and at three quarters of the parameter interval; the unknowns are the first and second
//! derivatives at the data points. Among all such curves that meet the shape criteria of
//! [`shapespline_criteria`] it has, to within the accuracy of an interior-point method and as far as a
//! local search can tell, the least [`Energy`]. Where the plain C² cubic keeps the shape, the curve of
//! least parametric energy *is* the plain cubic.
//!
//! **Guarantee.** A fit that ends with [`Status::Solved`] has passed the exact check of its exported
//! control points: every criterion is proved on every piece, but for signs that rounding hides in
//! nearly degenerate data, which the report lists as undecided.
//!
//! **How it is found.** Every criterion is a polynomial inequality in the derivatives at the two ends of
//! a segment, so gradients and Hessians are written out, and Newton's system is block tridiagonal: a step
//! costs O(N). The search begins with the plain cubic; around the segments that fail it opens windows,
//! outside of which nothing changes; in each an elastic barrier pulls the curve into shape, restarts
//! from a start in closed form mend what that leaves, and a barrier proper brings the energy down
//! (see [`Method`] for the rungs of this ladder). Cost follows the number of failing segments.
//!
//! Notation as in [`shapespline_geometry`]: points `I_i`, parameters `u_i`, spacings `h_i`, chords `L_i`,
//! binormal vectors `P_i`, `ω = Q' × Q''`. Inside, points are divided by the mean chord and parameters by
//! the mean spacing, so results do not depend on units.
//!
//! Sources: M. I. Karavelas, P. D. Kaklis, Numerical Algorithms 23 (2000) 217–250 (the criteria on one
//! cubic); A. Forsgren, P. E. Gill, SIAM J. Optim. 8 (1998) 1132–1152 (the primal–dual barrier); A. R.
//! Conn, N. Gould, A. Sartenaer, P. L. Toint, SIAM J. Optim. 6 (1996) 674–703 (step lengths that are local);
//! the element, its criteria and the start in closed form are derived in the modules that hold them.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_fair::{FairOptions, FairSpline, Status};
//! use shapespline_fair::geometry::{Boundary, DVec3, DataPolygon, Parametrization};
//!
//! let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.1], [4.0, 0.1, 0.1], [4.5, 0.4, 0.2], [4.6, 3.0, 0.2]];
//! let points = points.map(DVec3::from).to_vec();
//! let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;
//! let fit = FairSpline::fit(polygon, &FairOptions::default())?;
//! assert_eq!(fit.diagnostics.status, Status::Solved);
//! assert!(fit.report.ok());
//! # Ok::<(), shapespline_fair::FitError>(())
//! ```

mod barrier;
mod chain;
mod constraints;
mod control;
mod cubic;
mod definite;
mod eigen;
mod element;
mod energy;
mod export;
mod ladder;
mod legs;
mod mend;
mod newton;
mod options;
mod outcome;
mod rows;
mod runs;
mod search;
mod segment;
mod shape;
mod solve;
mod spline;
mod start;
mod starts;
mod units;
mod window;
mod workspace;

pub use constraints::Constraints;
pub use energy::Energy;
pub use options::FairOptions;
pub use outcome::{Diagnostics, Fit, FitError, Method, Phase, Status, Step};
/// Criteria, tolerances and the report.
pub use shapespline_criteria as criteria;
/// Points, their parameters and ends, and the evaluation of curves.
pub use shapespline_geometry as geometry;
pub use spline::FairSpline;

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
