// SPDX-License-Identifier: MIT OR Apache-2.0

//! Does a curve keep the shape of the points it interpolates?
//!
//! The criteria compare each cubic segment with the data polygon around it:
//!
//! | criterion | the polygon requires it when | the segment satisfies it when |
//! |---|---|---|
//! | convexity | `P_m·P_{m+1} > 0` | `ω(u)·P_n > 0` on the segment, `n = m, m+1` |
//! | inflection | `P_m·P_{m+1} < 0` | `ω·P_m` goes from + to −, `ω·P_{m+1}` from − to +, once |
//! | turning | `P_m ≠ 0` (at a node) | `(ω(u_m)·P_j)(P_m·P_j) > 0`, `j = m−1, m, m+1`, and `γ'` lies between the chords |
//! | torsion | `Γ_m ≠ 0`, both turns above the root of the tolerance | `τ(u) Γ_m > 0` on the segment |
//! | coplanarity | `Γ_m = 0`, `P_m, P_{m+1} ≠ 0` in a polygon that is not planar | the binormal stays within `asin ε₁` of `±P` |
//! | collinearity | `P_m = 0`, `L_{m−1}·L_m > 0` | the tangent stays within `asin ε₀` of the line around the node |
//! | global convexity (when asked) | `P_m·P_{m+1} > 0` | convexity, and `((γ−γ(0))×γ')·P_n > 0`, `(γ'(0)×(γ−γ(0)))·P_n > 0` |
//!
//! with `ω = γ' × γ''`. Besides, a curve has to be regular, `γ' ≠ 0`. All are decided exactly for cubics, from the Bézier legs, by closed forms and
//! by Bernstein subdivision; nothing is sampled. Curves of any degree, rational ones included, are
//! decided by certified subdivision; what rounding hides is reported as undecided, with its interval.
//!
//! | question | asked of |
//! |---|---|
//! | does a cubic of these end legs keep the shape? | [`check`], [`Checker`] |
//! | does any piecewise Bézier curve? | [`check_curve`], [`CurveChecker`] |
//! | what of the nodes, and of oscillation about planes (as information)? | [`Checker::node_conditions`], [`CurveChecker::node_conditions`] |
//! | what do the points themselves require? | [`polygon_shape`] |
//! | how many inflections are seen, from somewhere or at most? | [`polygon_inflections`], [`curve_inflections`] and their `_from` |
//!
//! Notation as in `shapespline_geometry`. Sources: M. I. Karavelas, P. D. Kaklis, Numerical Algorithms
//! 23 (2000), Problem (P) and (5.34)–(5.57); R. S. Gautam, *Shape preservation behavior of spline
//! curves*, Definitions 3.1, 3.16, 5.4, 6.2, 8.2, 9.2, 10.1 and sections 12 and 13; T. N. T. Goodman,
//! Computer Aided Geometric Design 8 (1991) 37–50, for inflection counts.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_criteria::geometry::{Boundary, DVec3, DataPolygon, Parametrization};
//! use shapespline_criteria::{Criteria, Criterion, Tolerances, check};
//!
//! let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)];
//! let polygon = DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature)?;
//! // Straight segments neither bend nor twist, so the twist of the data is missing.
//! let straight = |i| [polygon.chord(i) / 3.0; 2];
//! let report = check(&polygon, straight, Criteria::DEFAULT, Tolerances::default());
//! assert_eq!(report.count(Criterion::Torsion).violated, 1);
//! println!("{report}");
//! # Ok::<(), shapespline_criteria::geometry::InputError>(())
//! ```

mod arbitrary_degree;
// Reached by the crates that search; its verdicts are those of a [`Checker`], asked of many segments at once.
#[doc(hidden)]
pub mod batch;
mod checker;
mod cone;
mod criterion;
mod global;
mod inflections;
mod margin;
mod node_conditions;
mod polygon_shape;
mod regular;
mod report;
mod requirements;
mod resolution;
mod rounding;
mod segment_geometry;
mod signs;
mod turning;
mod violations;

use batch::{BatchChecker, CachedChecker};

pub use arbitrary_degree::{CurveChecker, CurveError, INTERPOLATION, check_curve};
pub use checker::{Checker, check};
pub use criterion::{Criteria, Criterion, Tolerances};
pub use inflections::{
    InflectionCount, curve_inflections, curve_inflections_from, curve_inflections_with,
    polygon_inflections, polygon_inflections_from, polygon_inflections_with,
};
pub use node_conditions::{NodeCondition, NodeConditions, NodeRecord, Oscillation};
pub use polygon_shape::{AffineDimension, PolygonShape, polygon_shape};
pub use report::{Count, Record, ShapeReport, Undecided};
pub use requirements::{Requirements, inflection_parameter};
/// The points that curves are compared with, and curves of other origin.
pub use shapespline_geometry as geometry;
pub use violations::Violations;

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
