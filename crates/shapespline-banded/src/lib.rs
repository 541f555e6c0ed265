//! Tridiagonal systems with scalar or vector right-hand sides.
//!
//! Three solvers, all O(n) and without pivoting (the systems of interpolating splines are strictly
//! diagonally dominant):
//! [`solve_tridiagonal`] and [`solve_cyclic`] work in place on arrays, [`Resolvable`] keeps what it
//! needs to solve again only where rows changed.

mod cyclic;
mod error;
mod resolvable;
mod tridiagonal;

pub use cyclic::solve_cyclic;
pub use error::SolveError;
pub use resolvable::{Resolvable, Row, Rows, solve_once};
pub use tridiagonal::{RightHandSide, solve_tridiagonal};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
