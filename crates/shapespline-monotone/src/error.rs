// SPDX-License-Identifier: MIT OR Apache-2.0

//! What cannot be fitted or asked: every variant names the argument, the place and the value.

use thiserror::Error;

/// Unusable input. Results that merely disappoint are reported in [`crate::Diagnostics`] instead.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MonotoneError {
    /// A NaN or an infinity in the data or options.
    #[error("{argument}[{index}] is {value}; every entry must be finite")]
    NotFinite {
        /// The argument.
        argument: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Abscissae that do not increase.
    #[error(
        "x[{index}] = {value} does not exceed its predecessor {previous}; x must be strictly increasing"
    )]
    NotIncreasing {
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
        /// The entry before it.
        previous: f64,
    },
    /// Too few points.
    #[error("{argument} has {found} entries; at least {needed} are needed")]
    TooFew {
        /// The argument.
        argument: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        needed: usize,
    },
    /// Lengths that do not agree.
    #[error("{argument} has {found} entries; expected {expected}")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Entries given.
        found: usize,
        /// Entries expected.
        expected: usize,
    },
    /// A difference, slope or curvature of the data that does not fit in double precision.
    #[error(
        "the {quantity} at {argument}[{index}] = {value} is out of the range of double precision; rescale the data"
    )]
    OutOfRange {
        /// What overflows: "spread", "secant slope" or "second derivative".
        quantity: &'static str,
        /// The argument.
        argument: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A given slope that no C² monotone quintic has.
    #[error("slopes[{index}] {rule}, got {value}; clip=True limits such slopes")]
    Slope {
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
        /// What it breaks: "must be 0 at a turn of the data" and so on.
        rule: &'static str,
    },
    /// A held slope that no monotone function through the data has.
    #[error("{argument}[{index}] {rule}, got {value}")]
    HeldSlope {
        /// The argument: "slopes" or "ends".
        argument: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
        /// What it breaks: "must be 0 at a turn of the data" and so on.
        rule: &'static str,
    },
    /// An entry that breaks a rule.
    #[error("{argument}[{index}] {rule}, got {value}")]
    Entry {
        /// The argument.
        argument: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
        /// What it breaks: "must be positive" and so on.
        rule: &'static str,
    },
    /// A number that breaks a rule.
    #[error("{argument} {rule}, got {value}")]
    Number {
        /// The argument.
        argument: &'static str,
        /// Its value.
        value: f64,
        /// What it breaks.
        rule: &'static str,
    },
    /// A residual that no monotone function between the bounds has.
    #[error("residual must be at least {least}, that of {of}, got {value}")]
    Residual {
        /// What has the least residual.
        of: &'static str,
        /// The residual given.
        value: f64,
        /// The least there is.
        least: f64,
    },
    /// Abscissae that are all the same.
    #[error("x must have at least two distinct values, got {found}")]
    Distinct {
        /// Distinct values.
        found: usize,
    },
    /// A sign of `convex` that is none, or that no function through the data has.
    #[error("convex[{index}] is {value}, {rule}")]
    Convex {
        /// The interval.
        index: usize,
        /// The sign.
        value: i8,
        /// What it breaks, and what helps.
        rule: &'static str,
    },
    /// A share of an interval or a secant that is out of its range.
    #[error("{argument} must lie in {range}, got {value}")]
    Share {
        /// The argument.
        argument: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// A shape parameter that is negative, not a number, or so large that its product with a slope overflows.
    #[error("{argument}[{index}] = {value}; shape parameters must lie in [0, 1e300]")]
    Shape {
        /// The argument.
        argument: &'static str,
        /// The entry (0 for a scalar).
        index: usize,
        /// Its value.
        value: f64,
    },
    /// An option that does not exist, or not for this interpolant.
    #[error("unknown {argument} {value:?}; expected one of {expected}")]
    UnknownOption {
        /// The argument.
        argument: &'static str,
        /// What was given.
        value: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// A function that is not of the range of the data.
    #[error(
        "function must run from {first} to {last} as the data, got one that runs from {from} to {to}"
    )]
    Domain {
        /// Where the function begins.
        from: f64,
        /// Where it ends.
        to: f64,
        /// Where the data begin.
        first: f64,
        /// Where they end.
        last: f64,
    },
    /// A function that jumps.
    #[error("function must be continuous, got one that jumps at x = {x}")]
    Jump {
        /// Where it jumps.
        x: f64,
    },
    /// A function that misses the data.
    #[error("function must pass through y[{index}], got one that is {distance:.3} away at x = {x}")]
    NotThrough {
        /// The entry.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// How far the function is away there.
        distance: f64,
    },
    /// `inverse` of a function that is not strictly monotone.
    #[error("inverse needs strictly monotone data: y[{index}] = {value} breaks it")]
    NotInvertible {
        /// The entry of y.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The caller asked to stop.
    #[error("the fit was interrupted")]
    Interrupted,
    /// Something wrong in one row or column of many.
    #[error("row {row}: {source}")]
    InRow {
        /// The row or column.
        row: usize,
        /// What is wrong in it.
        source: Box<MonotoneError>,
    },
    /// Offsets that do not cut the data.
    #[error("offsets[{index}] = {value}; offsets must start at 0, not fall, and end at {length}")]
    Offset {
        /// The entry.
        index: usize,
        /// Its value.
        value: usize,
        /// The length of what is cut.
        length: usize,
    },
    /// The interior solver failed; cannot happen for data this crate accepted.
    #[error("box program: {0}")]
    Program(#[from] shapespline_banded::box_qp::BoxQpError),
}
