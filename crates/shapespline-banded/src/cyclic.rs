// SPDX-License-Identifier: MIT OR Apache-2.0

//! Cyclic tridiagonal systems.

use crate::{
    RightHandSide, SolveError,
    error::{check_length, checked_pivot},
    solve_tridiagonal,
};

/// Solves a cyclic tridiagonal system in place: as [`solve_tridiagonal`], with `lower[0]` the
/// coefficient of the last unknown in the first row and the last `upper` that of the first unknown
/// in the last row. O(n) time, and O(n) memory for the column that fills in.
///
/// The last unknown is set aside: the rest is a tridiagonal system with two right-hand sides, the
/// given one and the last column. Each row holds to rounding in terms of its entries and of the largest
/// unknown; unknowns much smaller than that are the difference of larger numbers.
///
/// # Errors
/// As [`solve_tridiagonal`].
pub fn solve_cyclic<T: RightHandSide>(
    lower: &[f64],
    diagonal: &mut [f64],
    upper: &[f64],
    right: &mut [T],
) -> Result<(), SolveError> {
    let n = diagonal.len();
    check_length("lower", n, lower.len())?;
    check_length("upper", n, upper.len())?;
    check_length("right", n, right.len())?;
    match n {
        0 => return Ok(()),
        1 => {
            // Both neighbours of the only unknown are itself.
            right[0] = right[0] / checked_pivot(0, lower[0] + diagonal[0] + upper[0])?;
            return Ok(());
        }
        _ => {}
    }
    let m = n - 1;
    let mut column = vec![0.0; m];
    column[0] = lower[0];
    column[m - 1] += upper[m - 1];
    let mut copy = diagonal[..m].to_vec();
    solve_tridiagonal(&lower[..m], &mut copy, &upper[..m], &mut column)?;
    solve_tridiagonal(&lower[..m], &mut diagonal[..m], &upper[..m], &mut right[..m])?;
    let (from_first, from_last) = (upper[m], lower[m]);
    let pivot = diagonal[m] - from_first * column[0] - from_last * column[m - 1];
    let last =
        (right[m] - right[0] * from_first - right[m - 1] * from_last) / checked_pivot(m, pivot)?;
    right[m] = last;
    for (x, c) in right[..m].iter_mut().zip(&column) {
        *x = *x - last * *c;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_planted_solution_comes_back(rows in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 0.1..3.0f64, -9.0..9.0f64), 1..60)) {
            let n = rows.len();
            let x: Vec<f64> = rows.iter().map(|r| r.3).collect();
            let (lower, upper): (Vec<f64>, Vec<f64>) = rows.iter().map(|r| (r.0, r.1)).unzip();
            let mut diagonal: Vec<f64> = rows.iter().map(|r| r.0.abs() + r.1.abs() + r.2).collect();
            let mut right: Vec<f64> = (0..n)
                .map(|i| lower[i] * x[(i + n - 1) % n] + diagonal[i] * x[i] + upper[i] * x[(i + 1) % n])
                .collect();
            solve_cyclic(&lower, &mut diagonal, &upper, &mut right).unwrap();
            for (found, planted) in right.iter().zip(&x) {
                prop_assert!((found - planted).abs() < 1e-11);
            }
        }
    }

    /// What a row hands on is `−1e−30` of its own: all digits of it, down to 1e−300.
    #[test]
    fn shares_keep_their_digits_down_to_the_least_normal_number() {
        let n = 11;
        let (lower, upper) = (vec![1e-30; n], vec![0.0; n]);
        let mut right = vec![0.0; n];
        right[n - 1] = 1.0;
        solve_cyclic(&lower, &mut vec![1.0; n], &upper, &mut right).unwrap();
        for (i, x) in right[..n - 1].iter().enumerate() {
            let planted = (-1e-30f64).powi(i as i32 + 1);
            assert!((x - planted).abs() < 1e-14 * planted.abs(), "{i}: {x:e}");
        }
    }

    /// Found by fuzzing: the first two unknowns are zero, and come out as the rounding of the third.
    #[test]
    fn rows_of_small_unknowns_hold_in_terms_of_the_largest() {
        let (lower, upper) = ([0.0, -1.0, -1.0], [-2.0, -3.0, 0.0]);
        let (diagonal, right) = ([5.0, 9.0, 3.0], [0.0, 1.0, -1.0]);
        let mut x = right;
        solve_cyclic(&lower, &mut diagonal.clone(), &upper, &mut x).unwrap();
        for (found, exact) in x.into_iter().zip([0.0, 0.0, -1.0 / 3.0]) {
            assert!((found - exact).abs() <= 1e-16, "{x:?}");
        }
    }

    #[test]
    fn a_singular_cycle_names_the_last_row() {
        let ones = [-1.0; 3];
        let found = solve_cyclic(&ones, &mut [2.0; 3], &ones, &mut [1.0; 3]).unwrap_err();
        assert!(matches!(found, SolveError::Pivot { row: 2, .. }), "{found}");
    }
}
