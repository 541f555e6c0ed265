//! Does a curve keep the shape of the points it interpolates?
//!
//! The criteria compare each cubic segment with the data polygon around it:
//!
//! | criterion | the polygon calls for it when | the segment satisfies it when |
//! |---|---|---|
//! | convexity | `P_m·P_{m+1} > 0` | `ω(u)·P_n > 0` on the segment, `n = m, m+1` |
//! | inflection | `P_m·P_{m+1} < 0` | `ω·P_m` goes from + to −, `ω·P_{m+1}` from − to +, once |
//! | torsion | `Γ_m ≠ 0` | `τ(u) Γ_m > 0` on the segment |
//! | coplanarity | `Γ_m = 0`, `P_m, P_{m+1} ≠ 0` in a polygon that is not planar | the binormal stays within `asin ε₁` of `±P` |
//! | collinearity | `P_m = 0`, `L_{m−1}·L_m > 0` | the tangent stays within `asin ε₀` of the line around the node |
//!
//! with `ω = Q' × Q''`. All are decided exactly for cubics, from the Bézier legs, by closed forms and
//! by Bernstein subdivision; nothing is sampled. Sources: M. I. Karavelas, P. D. Kaklis, Numerical
//! Algorithms 23 (2000), Problem (P) and (5.34)–(5.57); R. S. Gautam, *Shape preservation behavior
//! of spline curves*, Definitions 3.1, 6.1, 8.2, 9.2, 10.1 and section 13.
//!
//! [`Checker`] prepares what the polygon calls for; [`Checker::faults`] is the fast verdict on one
//! segment; [`Checker::record`] measures its margin; [`check`] makes the [`ShapeReport`].

mod calls;
mod checker;
mod cone;
mod criterion;
mod faults;
mod general;
mod global;
mod inflections;
mod margin;
mod notes;
mod polygon_shape;
mod report;
mod sign_changes;

pub use calls::{Calls, separation};
pub use checker::{Checker, check};
pub use criterion::{Criteria, Criterion, Tolerances};
pub use faults::Faults;
pub use general::{CurveChecker, CurveError, INTERPOLATION, check_curve};
pub use inflections::{
    InflectionCount, curve_inflections, curve_inflections_from, polygon_inflections,
    polygon_inflections_from,
};
pub use notes::{NodeCondition, NodeRecord, Notes, Oscillation};
pub use polygon_shape::{Extent, PolygonShape, polygon_shape};
pub use report::{Count, Record, ShapeReport, Undecided};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
