// SPDX-License-Identifier: MIT OR Apache-2.0

//! Thomas's algorithm.

use std::ops::{Div, Mul, Sub};

use crate::{
    SolveError,
    error::{check_length, checked_pivot},
};

/// One row of the right-hand side: a number, or several right-hand sides together as a vector.
pub trait RightHandSide:
    Copy + Sub<Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
}
impl<T> RightHandSide for T where
    T: Copy + Sub<Output = T> + Mul<f64, Output = T> + Div<f64, Output = T>
{
}

/// Solves a tridiagonal system in place: `lower[i] x[i−1] + diagonal[i] x[i] + upper[i] x[i+1] =
/// right[i]`. On return `right` holds the solution and `diagonal` the multipliers that were used.
/// `lower[0]` and the last `upper` are not read. O(n), no pivoting: meant for diagonally dominant
/// systems. The share that one unknown has in another (a multiplier, or a product of them) is rounded to
/// multiples of 5e−324: where entries of the matrix differ so much that a share is below 2e−308, what it
/// adds has fewer digits.
///
/// # Errors
/// Lengths that differ, and a pivot that is zero or not finite.
pub fn solve_tridiagonal<T: RightHandSide>(
    lower: &[f64],
    diagonal: &mut [f64],
    upper: &[f64],
    right: &mut [T],
) -> Result<(), SolveError> {
    let n = diagonal.len();
    check_length("lower", n, lower.len())?;
    check_length("upper", n, upper.len())?;
    check_length("right", n, right.len())?;
    for i in 0..n {
        let mut pivot = diagonal[i];
        if i > 0 {
            pivot -= lower[i] * diagonal[i - 1];
            right[i] = right[i] - right[i - 1] * lower[i];
        }
        let pivot = checked_pivot(i, pivot)?;
        right[i] = right[i] / pivot;
        diagonal[i] = upper[i] / pivot;
    }
    for i in (0..n.saturating_sub(1)).rev() {
        right[i] = right[i] - right[i + 1] * diagonal[i];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_planted_solution_comes_back(rows in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 0.1..3.0f64, -9.0..9.0f64), 1..80)) {
            let n = rows.len();
            let x: Vec<f64> = rows.iter().map(|r| r.3).collect();
            let (lower, upper): (Vec<f64>, Vec<f64>) = rows.iter().map(|r| (r.0, r.1)).unzip();
            let mut diagonal: Vec<f64> = rows.iter().map(|r| r.0.abs() + r.1.abs() + r.2).collect();
            let mut right: Vec<f64> = (0..n).map(|i| {
                let before = if i > 0 { lower[i] * x[i - 1] } else { 0.0 };
                let after = if i + 1 < n { upper[i] * x[i + 1] } else { 0.0 };
                before + diagonal[i] * x[i] + after
            }).collect();
            solve_tridiagonal(&lower, &mut diagonal, &upper, &mut right).unwrap();
            for (found, planted) in right.iter().zip(&x) {
                prop_assert!((found - planted).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn a_bad_pivot_names_its_row() {
        let (lower, upper) = ([0.0, 1.0, 1.0], [1.0, 1.0, 0.0]);
        let solve = |mut diagonal: [f64; 3]| {
            solve_tridiagonal(&lower, &mut diagonal, &upper, &mut [1.0; 3]).unwrap_err()
        };
        assert_eq!(solve([1.0, 1.0, 4.0]), SolveError::Pivot { row: 1, pivot: 0.0 });
        let found = solve([4.0, 4.0, f64::INFINITY]);
        assert_eq!(found, SolveError::Pivot { row: 2, pivot: f64::INFINITY });
        let short = solve_tridiagonal(&lower[..2], &mut [1.0; 3], &upper, &mut [1.0; 3]);
        assert_eq!(short.unwrap_err().to_string(), "lower has length 2, the diagonal has 3");
        assert!(solve_tridiagonal::<f64>(&[], &mut [], &[], &mut []).is_ok());
    }
}
