// SPDX-License-Identifier: MIT OR Apache-2.0

#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod bernstein;
pub mod knots;
pub mod parallel;
mod polynomial;
pub mod quadratic;
pub mod quartic;
mod root;
mod sign;

pub use bernstein::Coefficient;
pub use polynomial::Polynomial;
pub use root::bracketed_root;
pub use sign::{Sign, certified_nonnegative};
