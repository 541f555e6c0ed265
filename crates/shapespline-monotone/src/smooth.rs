// SPDX-License-Identifier: MIT OR Apache-2.0

//! Smoothing by monotone cubics: the monotone function nearest to noisy data for its bending energy.
//!
//! [`smooth_monotone`] minimises `Σ w(y − f(x))² + λ ∫f''² dx` over **all** monotone functions f. Whatever the values at
//! the data are, the best function through them is the [`MonotoneCubic`] with natural ends, whose energy `E(m₀, m₁, d)`
//! per interval is convex in the slopes at its ends and its rise. So the program is convex in the first value, the rises
//! `d ≥ 0` and the slopes `m ≥ 0`, with `fᵢ = f₀ + Σd`. (Values as unknowns would lose the digits: rises of `h³`.)
//!
//! 1. Without constraints it is quadratic, the smoothing spline; where that is monotone it is the answer.
//! 2. Else a primal–dual interior point comes near to the answer (`interior.rs`), and
//! 3. Newton's method on what is free (`active.rs`) ends there (`finish.rs`). Both solve their systems by orthogonal elimination from
//!    node to node (`system.rs`). O(N) per step.
//!
//! Functions that are convex or concave as well where that is asked have a third form of energy there, with unknowns of its
//! own (`bent.rs`); all else is the same.
//!
//! As λ falls to 0 the values become those of the isotonic regression (`pool.rs`): the data, where they are monotone.

use crate::MonotoneError;
use crate::cubic::{Known, MonotoneCubic};
use crate::extrapolation::Extrapolation;
use crate::interrupt::check_interrupt;
use input::Input;
use penalty::{LINE, Optima};
use std::ops::ControlFlow;

mod active;
mod bent;
mod finish;
mod input;
mod interior;
mod interval;
mod newton;
mod penalty;
mod pool;
mod rows;
mod system;
#[cfg(test)]
mod tests;

/// How the penalty λ is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PenaltyChoice {
    /// The penalty of the least generalised cross-validation score, with the degrees of freedom of what no constraint
    /// holds.
    #[default]
    CrossValidated,
    /// This λ. With 0 the isotonic regression: the interpolant of monotone data.
    Fixed(f64),
    /// The largest λ with `Σ w(y − f)²` at most this.
    FromResidual(f64),
}

/// How [`smooth_monotone`] smooths.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothOptions {
    /// Weights of the data, positive; 1 by default.
    pub weights: Option<Vec<f64>>,
    /// How the penalty is chosen.
    pub penalty: PenaltyChoice,
    /// Whether the function increases; `None`: whether the weighted regression line does.
    pub increasing: Option<bool>,
    /// Where the function is to be convex (1) or concave (−1) as well, one sign per interval between the x; 0: not asked.
    pub convex: Option<Vec<i8>>,
    /// Bounds of the function, which the data may leave; infinite ones bound nothing.
    pub bounds: Option<[f64; 2]>,
    /// What the function is outside the data.
    pub extrapolate: Extrapolation,
}

impl Default for SmoothOptions {
    fn default() -> Self {
        Self {
            weights: None,
            penalty: PenaltyChoice::default(),
            increasing: Some(true),
            convex: None,
            bounds: None,
            extrapolate: Extrapolation::default(),
        }
    }
}

/// How the smoothing went ([`MonotoneCubic::smoothing`]).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Smoothing {
    /// The penalty λ; +∞ for a straight line.
    pub penalty: f64,
    /// `Σ w(y − f)²`.
    pub residual: f64,
    /// The trace of the derivative of the values in the data, where constraints that are active stay so.
    pub degrees_of_freedom: f64,
    /// Whether the function increases.
    pub increasing: bool,
    /// Linear systems factored for the final penalty.
    pub steps: usize,
    /// Whether the optimum was reached.
    pub converged: bool,
}

/// The monotone function of least `Σ w(y − f(x))² + λ ∫f''² dx`, through its values at the data: its
/// [`MonotoneCubic::smoothing`] says how it was found. O(N) per step of some 20.
///
/// With [`SmoothOptions::convex`] it is the best of the monotone functions that are convex and concave as asked.
///
/// `x` must not decrease. Data at equal abscissae, or at ones nearer than 2⁻³⁰ of their range, are merged: their weights
/// are added and their weighted means taken. Where monotonicity is no constraint the function is the smoothing spline.
///
/// # Errors
/// [`MonotoneError`] naming argument, index and value: lengths that differ, NaN or infinity, x decreasing or all the
/// same, weights that are not positive, a negative penalty or residual, a residual below that of the isotonic
/// regression (or of the nearest function of the convexity asked), bounds without room between them, signs other than −1,
/// 0 and 1, the penalty 0 with signs (the function would have kinks), quantities that overflow.
///
/// ```
/// use shapespline_monotone::{PenaltyChoice, SmoothOptions, smooth_monotone};
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0], [0.0, 1.2, 0.9, 2.0]);
/// let options = SmoothOptions { penalty: PenaltyChoice::Fixed(0.1), ..SmoothOptions::default() };
/// let f = smooth_monotone(&x, &y, &options)?;
/// assert!(f.slopes().iter().all(|m| *m >= 0.0));
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn smooth_monotone(
    x: &[f64],
    y: &[f64],
    options: &SmoothOptions,
) -> Result<MonotoneCubic, MonotoneError> {
    smooth_monotone_with(x, y, options, &|| ControlFlow::Continue(()))
}

/// As [`smooth_monotone`], with a function that is called regularly; return `Break` to cancel.
///
/// # Errors
/// As [`smooth_monotone`], and [`MonotoneError::Interrupted`] if cancelled.
pub fn smooth_monotone_with(
    x: &[f64],
    y: &[f64],
    options: &SmoothOptions,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<MonotoneCubic, MonotoneError> {
    let input = Input::new(x, y, options)?;
    check_interrupt(go_on)?;
    let mut optima = Optima::new(&input, go_on);
    let lambda = match options.penalty {
        PenaltyChoice::CrossValidated => optima.cross_validated()?,
        PenaltyChoice::Fixed(penalty) => input.penalty_in(penalty),
        PenaltyChoice::FromResidual(residual) => {
            optima.of_residual(input.residual_in(residual), residual)?
        }
    };
    let optimum = optima.at(lambda)?;
    let degrees_of_freedom = optima.freedom(lambda, &optimum);
    let (mut f, rises) = (Vec::new(), input.task.h.len());
    input.task.values(optimum.first, &optimum.sizes, &mut f);
    if optimum.held[input.task.layout().high()] {
        // The sum of the rises is on the bound but for rounding.
        let level = optimum.sizes[..rises].iter().rev().take_while(|d| **d == 0.0).count();
        f[rises - level..].fill(input.task.bounds[1]);
    }
    let values = input.values_out(&f);
    let known = Known {
        data: [&input.x, &values],
        sign: input.sign,
        rises: &optimum.sizes[..rises],
        ex: input.ex,
        ey: input.ey,
        bend: &input.task.bend,
        slopes: &optimum.sizes[input.task.layout().m(0)..input.task.layout().low()],
        over: &input.task.over_secants(&optimum.sizes),
    };
    let mut function = MonotoneCubic::through(&known, options.extrapolate, go_on)?;
    let penalty = match options.penalty {
        PenaltyChoice::Fixed(penalty) => penalty,
        _ if lambda >= LINE => f64::INFINITY,
        _ => input.penalty_out(lambda),
    };
    function.set_smoothing(Smoothing {
        penalty,
        residual: input.residual_out(optimum.residual + input.within),
        degrees_of_freedom,
        increasing: input.sign > 0.0,
        steps: optimum.steps,
        converged: optimum.converged && function.diagnostics().converged,
    });
    Ok(function)
}
