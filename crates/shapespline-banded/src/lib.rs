// SPDX-License-Identifier: MIT OR Apache-2.0

//! Tridiagonal systems with scalar or vector right-hand sides, block tridiagonal ones, and strictly
//! convex tridiagonal programs.
//!
//! All solvers are O(n) and without pivoting (the systems of interpolating splines are strictly
//! diagonally dominant or positive definite): [`solve_tridiagonal`] and [`solve_cyclic`] work in place
//! on arrays, [`Resolvable`] keeps what it needs to solve again only where rows changed, a [`Place`] of
//! it solves a few rows with other coefficients, [`block_tridiagonal`] takes 2×2 blocks,
//! [`BlockCholesky`] blocks of any size, open or cyclic, and [`box_qp`] minimises a quadratic form between
//! bounds.

mod block_cholesky;
pub mod block_tridiagonal;
pub mod box_qp;
mod cyclic;
mod error;
mod place;
mod resolvable;
mod rows;
mod sweep;
mod tridiagonal;

pub use block_cholesky::{Block, BlockCholesky, NotPositiveDefinite};
pub use cyclic::solve_cyclic;
pub use error::SolveError;
pub use place::Place;
pub use resolvable::{Resolvable, solve_once};
pub use rows::{Row, Rows};
pub use tridiagonal::{RightHandSide, solve_tridiagonal};

/// The examples of the README are run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
