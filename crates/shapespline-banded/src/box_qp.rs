// SPDX-License-Identifier: MIT OR Apache-2.0

//! Strictly convex quadratic programs with a tridiagonal Hessian and box constraints.
//!
//! `minimise ½ xᵀ A x + qᵀ x` subject to `lower ≤ x ≤ upper`, `A` symmetric positive definite and tridiagonal.
//!
//! **Method.** Primal–dual active set (block principal pivoting): guess which bounds are active, solve the
//! tridiagonal systems between them, move every variable that contradicts the guess. Active variables cut the
//! chain, so after the first round only the stretches around changed variables are solved again and the cost
//! follows the number of changes. Block moves may cycle on a general matrix; as soon as the number of
//! contradictions has failed to fall [`PATIENCE`] times the iterate is handed to projected Gauss–Seidel sweeps,
//! which lower the objective at every step and identify the active set after finitely many, and the active-set
//! iteration restarts from there. Júdice and Pires, *Computers & Operations Research* 21 (1994) 587–596;
//! Hintermüller, Ito and Kunisch, *SIAM J. Optim.* 13 (2003) 865–888.
// Negated comparisons are meant: they catch NaN as well.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod active_set;
mod guess;
#[cfg(test)]
mod tests;

use active_set::ActiveSet;
use thiserror::Error;

/// Rows that are looked at together, without a branch: which bounds are active cannot be predicted.
const BLOCK: usize = 64;
/// Rounds without progress after which block moves give way to projected Gauss–Seidel sweeps.
pub const PATIENCE: usize = 10;
/// Safeguard phases before the best iterate is returned with its residual.
const PHASES: usize = 25;

/// What cannot be solved.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BoxQpError {
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, expected {expected}")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A bound pair is empty or not a number.
    #[error("no number lies between lower[{index}] = {lower} and upper[{index}] = {upper}")]
    EmptyBox {
        /// The variable.
        index: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A diagonal entry, or a pivot, is not positive: the matrix is not positive definite.
    #[error("pivot {index} is {value}: the matrix is not positive definite")]
    NotPositiveDefinite {
        /// The row.
        index: usize,
        /// The pivot.
        value: f64,
    },
}

/// `minimise ½ xᵀ A x + qᵀ x` subject to `lower ≤ x ≤ upper`.
#[derive(Debug, Clone, Copy)]
pub struct TridiagonalBoxQp<'a> {
    /// The diagonal of `A`, n entries.
    pub diagonal: &'a [f64],
    /// The off-diagonal of `A`, n − 1 entries.
    pub off_diagonal: &'a [f64],
    /// `q`, n entries.
    pub linear: &'a [f64],
    /// Lower bounds; −∞ allowed.
    pub lower: &'a [f64],
    /// Upper bounds; +∞ allowed. Equal bounds fix a variable.
    pub upper: &'a [f64],
}

/// The minimiser with what is needed to trust it.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxQpSolution {
    /// The minimiser. Active variables equal their bound to the last bit.
    pub x: Vec<f64>,
    /// Rounds of the active-set iteration (tridiagonal solves, each only where the set changed).
    pub iterations: usize,
    /// How many variables are at a bound.
    pub active: usize,
    /// How often the safeguard was needed; 0 in every case met in practice.
    pub safeguards: usize,
    /// Largest violation of the optimality conditions, each row relative to the size of its terms.
    pub kkt_residual: f64,
    /// Whether the active set is consistent (no variable contradicts it beyond rounding).
    pub solved: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum VariableState {
    Lower,
    Free,
    Upper,
}

/// Solve the program. O(n) a round; a handful of rounds for diagonally dominant matrices.
///
/// # Errors
/// [`BoxQpError`] for lengths that do not match, an empty box, or a matrix that is not positive definite.
///
/// ```
/// use shapespline_banded::box_qp::{TridiagonalBoxQp, solve};
/// let program = TridiagonalBoxQp {
///     diagonal: &[2.0, 2.0, 2.0], off_diagonal: &[-1.0, -1.0], linear: &[-1.0, 0.0, -1.0],
///     lower: &[0.0; 3], upper: &[f64::INFINITY, 0.5, f64::INFINITY],
/// };
/// let solution = solve(&program)?;
/// assert_eq!(solution.x, [0.75, 0.5, 0.75]);
/// assert!(solution.solved && solution.active == 1);
/// # Ok::<(), shapespline_banded::box_qp::BoxQpError>(())
/// ```
pub fn solve(program: &TridiagonalBoxQp<'_>) -> Result<BoxQpSolution, BoxQpError> {
    solve_with_patience(program, PATIENCE)
}

/// [`solve`] with another patience: 0 goes through the safeguard first, for tests and hard matrices.
///
/// # Errors
/// As [`solve`].
pub fn solve_with_patience(
    program: &TridiagonalBoxQp<'_>,
    patience: usize,
) -> Result<BoxQpSolution, BoxQpError> {
    validate(program)?;
    let n = program.diagonal.len();
    let mut state = ActiveSet {
        program,
        x: vec![0.0; n],
        place: vec![VariableState::Free; n],
        work: vec![0.0; n],
    };
    state.guess();
    let (mut iterations, mut safeguards) = (0, 0);
    let mut solved = false;
    let mut patience_now = patience;
    for phase in 0..=PHASES {
        if phase > 0 || patience == 0 {
            safeguards += 1;
            state.gauss_seidel();
            patience_now = patience.max(PATIENCE);
        }
        let (rounds, done) = state.pivot(patience_now)?;
        iterations += rounds;
        if done {
            solved = true;
            break;
        }
    }
    if !solved {
        // The last word of the safeguard: feasible, and the residual tells how good.
        state.gauss_seidel();
    }
    let kkt_residual = kkt_residual(program, &state.x);
    let active = state.place.iter().filter(|p| **p != VariableState::Free).count();
    Ok(BoxQpSolution { x: state.x, iterations, active, safeguards, kkt_residual, solved })
}

fn validate(program: &TridiagonalBoxQp<'_>) -> Result<(), BoxQpError> {
    let n = program.diagonal.len();
    for (argument, found, expected) in [
        ("off_diagonal", program.off_diagonal.len(), n.saturating_sub(1)),
        ("linear", program.linear.len(), n),
        ("lower", program.lower.len(), n),
        ("upper", program.upper.len(), n),
    ] {
        if found != expected {
            return Err(BoxQpError::Length { argument, found, expected });
        }
    }
    // Every entry is looked at: a loop that may end early is not done several numbers at once.
    let bounds = || program.lower.iter().zip(program.upper);
    // An infinite bound on the wrong side leaves no number either.
    let has_room = |l: f64, u: f64| (l <= u) & (l < f64::INFINITY) & (u > f64::NEG_INFINITY);
    let sound = bounds().fold(true, |all, (l, u)| all & has_room(*l, *u))
        & program.diagonal.iter().fold(true, |all, d| all & (*d > 0.0));
    if sound {
        return Ok(());
    }
    for (index, (&lower, &upper)) in bounds().enumerate() {
        if !has_room(lower, upper) {
            return Err(BoxQpError::EmptyBox { index, lower, upper });
        }
    }
    match program.diagonal.iter().position(|d| !(*d > 0.0)) {
        Some(index) => {
            Err(BoxQpError::NotPositiveDefinite { index, value: program.diagonal[index] })
        }
        None => Ok(()),
    }
}

/// `(A x + q)ᵢ` and the sum of the sizes of its terms.
#[inline(always)]
fn gradient(program: &TridiagonalBoxQp<'_>, x: &[f64], i: usize) -> (f64, f64) {
    let own = program.diagonal[i] * x[i];
    let left = if i > 0 { program.off_diagonal[i - 1] * x[i - 1] } else { 0.0 };
    let right = if i + 1 < x.len() { program.off_diagonal[i] * x[i + 1] } else { 0.0 };
    let q = program.linear[i];
    (own + left + right + q, own.abs() + left.abs() + right.abs() + q.abs())
}

/// Largest scaled violation of the optimality conditions at a feasible `x`: a row's gradient over the sum of the
/// sizes of its terms, counted only in the direction its bounds leave open.
#[must_use]
pub fn kkt_residual(program: &TridiagonalBoxQp<'_>, x: &[f64]) -> f64 {
    let mut worst = 0.0f64;
    for from in (0..x.len()).step_by(BLOCK) {
        let rows = from..x.len().min(from + BLOCK);
        // Nearly all blocks are below what was found before, and need no division.
        if let Some(block) = Block::of(program, x, from) {
            let below = (0..BLOCK).fold(true, |all, k| {
                let (g, size) = block.gradient(k);
                all & (open(g, block.x[k], block.lower[k], block.upper[k]) <= worst * size)
            });
            if below {
                continue;
            }
        }
        for i in rows {
            let (g, size) = gradient(program, x, i);
            let violation = open(g, x[i], program.lower[i], program.upper[i]);
            if violation > worst * size {
                worst = violation / size;
            }
        }
    }
    worst
}

/// The part of a gradient in the direction that the bounds leave open.
#[inline(always)]
fn open(g: f64, x: f64, lower: f64, upper: f64) -> f64 {
    let down = if x <= lower { 0.0 } else { g };
    let up = if x >= upper { 0.0 } else { -g };
    if down > up { down } else { up }
}

/// The numbers of [`BLOCK`] rows that have neighbours on both sides.
struct Block<'a> {
    diagonal: &'a [f64; BLOCK],
    linear: &'a [f64; BLOCK],
    lower: &'a [f64; BLOCK],
    upper: &'a [f64; BLOCK],
    /// The off-diagonal entries and variables on the left, the variables, and those on the right.
    off_left: &'a [f64; BLOCK],
    off_right: &'a [f64; BLOCK],
    x_left: &'a [f64; BLOCK],
    x: &'a [f64; BLOCK],
    x_right: &'a [f64; BLOCK],
}

impl<'a> Block<'a> {
    /// None for the first rows, the last, and a rest of less than a block.
    #[inline(always)]
    fn of(program: &TridiagonalBoxQp<'a>, x: &'a [f64], from: usize) -> Option<Self> {
        let before = from.checked_sub(1)?;
        Some(Self {
            diagonal: program.diagonal.get(from..)?.first_chunk()?,
            linear: program.linear.get(from..)?.first_chunk()?,
            lower: program.lower.get(from..)?.first_chunk()?,
            upper: program.upper.get(from..)?.first_chunk()?,
            off_left: program.off_diagonal.get(before..)?.first_chunk()?,
            off_right: program.off_diagonal.get(from..)?.first_chunk()?,
            x_left: x.get(before..)?.first_chunk()?,
            x: x.get(from..)?.first_chunk()?,
            x_right: x.get(from + 1..)?.first_chunk()?,
        })
    }

    /// [`gradient`] of row k of the block.
    #[inline(always)]
    fn gradient(&self, k: usize) -> (f64, f64) {
        let own = self.diagonal[k] * self.x[k];
        let left = self.off_left[k] * self.x_left[k];
        let right = self.off_right[k] * self.x_right[k];
        let q = self.linear[k];
        (own + left + right + q, own.abs() + left.abs() + right.abs() + q.abs())
    }
}
