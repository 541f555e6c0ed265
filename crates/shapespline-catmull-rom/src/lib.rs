// SPDX-License-Identifier: MIT OR Apache-2.0

//! Catmull–Rom curves through points in space, and the largest handles that keep their shape.
//!
//! **Definition.** The tangent at a node is that of the parabola through its three points,
//! `t_i = w L_{i−1}/h_{i−1} + (1−w) L_i/h_i` with `w = h_i/(h_{i−1}+h_i)`: uniform, chordal,
//! centripetal or any other Catmull–Rom curve by the choice of parameters. The segment has the end
//! legs `a = p h t_i/3`, `c = q h t_{i+1}/3`; `p = q = 1` is the curve without tension. Given and
//! circular end tangents stand for `t_0, t_N`; with zero curvature the first (last) leg is
//! `(L − c)/2`, so that `γ''` vanishes there.
//!
//! **Guarantee** (specification, section 4; R. S. Gautam, section 14). With `X = t_i × t_{i+1}`,
//! `t_i × L_i = αP_i`, `L_i × t_{i+1} = βP_{i+1}`, in units of the full legs
//!
//! `a×b = p(αP_i − qX)`, `b×c = q(βP_{i+1} − pX)`, `a×c = pqX`, `det[a,b,c] = pq αβ Γ_i`.
//!
//! * Torsion holds for all handles, and so does node compatibility (12.1): the tangent lies strictly
//!   between the chords.
//! * Convexity and inflection hold exactly when `q < αP_i·n/(X·n)` and `p < βP_{i+1}·n/(X·n)` for
//!   those `n ∈ {P_i, P_{i+1}}` for which the bound is positive. Where `X·n ≤ 0` in a convex segment
//!   the middle condition is automatic: `4(αP_i − qX)·n (βP_{i+1} − pX)·n ≥ 4pq(X·n)²`. *Global*
//!   convexity follows: its Bernstein coefficients `3A + 3C = 3p αP_i·n` and
//!   `3B + 3C = 3q βP_{i+1}·n` do not even depend on the other handle.
//! * Turning asks at node `i` for `ω(0)·n` of the sign of `P_i·n`, `n ∈ {P_{i−1}, P_i, P_{i+1}}`, and at node
//!   `i+1` for `ω(1)·n` of that of `P_{i+1}·n`, `n ∈ {P_i, P_{i+1}, P_{i+2}}`. As `ω(0) = p(αP_i − qX)` has it
//!   for `q = 0`, it holds exactly for `q < αP_i·n/(X·n)` wherever that is positive, and likewise for `p`: a
//!   bound of the same form. The tangent lies between the chords as said above.
//! * Collinearity at node `i` on the half segment after it (`a` along the line) holds when
//!   `‖a‖ ≤ ‖L‖` and `c_∥ + ‖c_⊥‖ cot asin ε₀ < ‖L‖`. In the transverse and the parallel part of
//!   `γ'` it asks `‖a‖(1−t)(1−3t) + 2‖L‖t(1−t) > K t(2−3t)` on `(0, ½]`, `K` the left side of the
//!   bound; the left side is linear in `‖a‖` and for `‖a‖ = 0` and `‖a‖ = ‖L‖` it is at least
//!   `‖L‖ t(2−3t)`. As `‖a‖ → 0` the bound on `c` is necessary too.
//! * Coplanarity: where four points lie in a plane `ω` is normal to it for all handles. What is left
//!   to the handles is that a split one inflects away from the nodes, and planes known only to the
//!   tolerance; there the tension search shortens them further ([`shapespline_search`]).
//!
//! **Directions.** The bounds ask of `t_i` only that it lies strictly between the chords.
//! [`Directions::Balanced`], the default of shape-preserving curves, splits the turning angle at each node
//! so that the two angles of a segment with its chord become alike, and neither handle has to be short;
//! [`Directions::Parametrization`] keeps the tangents of the definition.
//!
//! **Cost.** O(N). With the tangents of the definition the curve is local: a point moves the curve over two segments to either side, or four where handles
//! are shortened, and shape is kept by a choice at the two nodes of each segment. Balanced directions take some
//! ten tridiagonal systems.
//!
//! Source: R. S. Gautam, *Shape preservation behavior of spline curves* ("paper 002"), section 14; the
//! magnitudes are ours.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_catmull_rom::{CatmullRom, HandleOptions, Interpolant};
//! use shapespline_catmull_rom::geometry::{Boundary, DVec3, DataPolygon, Parametrization};
//!
//! let points = vec![
//!     DVec3::new(0.0, 0.0, 0.0),
//!     DVec3::new(2.0, 0.0, 0.1),
//!     DVec3::new(4.0, 0.1, 0.1),
//!     DVec3::new(4.5, 0.4, 0.2),
//!     DVec3::new(4.6, 3.0, 0.2),
//!     DVec3::new(4.6, 6.0, 0.3),
//! ];
//! let polygon = DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature)?;
//! let fit = CatmullRom::shape_preserving(polygon, &HandleOptions::default())?;
//! assert!(fit.report.ok());
//! assert!(fit.curve.tension().iter().any(|&t| t > 0.0));
//! # Ok::<(), shapespline_catmull_rom::FitError>(())
//! ```

mod balanced;
mod batch;
mod bounds;
mod curve;
mod handles;
mod parts;
mod tangents;

pub use curve::{CatmullRom, Continuity, Directions, HandleOptions};
/// Criteria, tolerances and the report.
pub use shapespline_search::criteria;
/// Points, their parameters and ends, and the evaluation of curves.
pub use shapespline_search::geometry;
pub use shapespline_search::{Fit, FitError, Interpolant, Status, Tension};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
