// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the fuzzers run: one function a target, from bytes to asserted properties.
//!
//! Two drivers call the same functions: `tests/fuzz/` (cargo-fuzz, guided by coverage, on nightly) and
//! `tests/rust/tests/fuzz.rs` (an ordinary test: it replays every input kept in `tests/fuzz/corpus` and runs some
//! thousands of generated ones). A target panics where a property fails; what it asserts is written at
//! its function.

mod any_curve;
mod bytes;
mod curves;
mod functions;
mod inflections;
mod kernels;
mod many;
mod regular;
mod shape_preserving;
mod stored;

pub use bytes::Bytes;

/// A target: its name, and what it does with the bytes of an input.
pub type Target = (&'static str, fn(&[u8]));

/// Every target, by the name of its folder in `tests/fuzz/corpus`.
pub const TARGETS: [Target; 9] = [
    ("any_curve", any_curve::run),
    ("curves", curves::run),
    ("functions", functions::run),
    ("inflections", inflections::run),
    ("kernels", kernels::run),
    ("many", many::run),
    ("regular", regular::run),
    ("shape_preserving", shape_preserving::run),
    ("stored", stored::run),
];

/// Runs a target by its name.
///
/// # Panics
/// Where a property fails, or no target has this name.
pub fn run(name: &str, data: &[u8]) {
    let target = TARGETS.iter().find(|t| t.0 == name);
    let (_, run) = target.unwrap_or_else(|| panic!("no target is called {name}"));
    run(data);
}

/// An error is for a person to read: never empty, never a bare debug print.
fn readable(error: &impl std::fmt::Display) {
    let text = error.to_string();
    assert!(text.contains(' '), "{text:?}");
}
