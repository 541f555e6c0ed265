// SPDX-License-Identifier: MIT OR Apache-2.0

//! Tridiagonal systems with scalar or vector right-hand sides, block tridiagonal ones, and strictly
//! convex tridiagonal programs.
//!
//! All solvers are O(n) and without pivoting (the systems of interpolating splines are strictly
//! diagonally dominant or positive definite): [`solve_tridiagonal`] and [`solve_cyclic`] work in place
//! on arrays, [`UpdatableSolver`] keeps what it needs to solve again only where rows changed, a
//! [`LocalSystem`] of it solves a few rows with other coefficients, [`block_tridiagonal`] takes 2×2
//! blocks, [`BlockCholesky`] blocks of any size, open or cyclic, and [`box_qp`] minimises a
//! quadratic form between bounds.
//!
//! Symbols and terms:
//! [notation](https://github.com/shapespline/shapespline/blob/main/python/docs/notation.md).
//!
//! ```
//! use shapespline_banded::{DVec3, solve_tridiagonal};
//!
//! // x − y/2 = 0, −x/2 + y − z/2 = 1, −y/2 + z = 0, for three coordinates at once.
//! let (lower, upper) = ([0.0, -0.5, -0.5], [-0.5, -0.5, 0.0]);
//! let (mut diagonal, mut right) = ([1.0; 3], [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO]);
//! solve_tridiagonal(&lower, &mut diagonal, &upper, &mut right)?;
//! assert!((right[1] - DVec3::new(2.0, 4.0, 6.0)).length() < 1e-14);
//! # Ok::<(), shapespline_banded::SolveError>(())
//! ```

mod block_cholesky;
pub mod block_tridiagonal;
pub mod box_qp;
mod cyclic;
mod elimination;
mod error;
mod local_system;
mod rows;
mod tridiagonal;
mod updatable;

pub use block_cholesky::{Block, BlockCholesky, NotPositiveDefinite};
pub use cyclic::solve_cyclic;
pub use error::SolveError;
pub use glam::DVec3;
pub use local_system::LocalSystem;
pub use rows::{Row, Rows};
pub use tridiagonal::{RightHandSide, solve_tridiagonal};
pub use updatable::{UpdatableSolver, solve_once};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
