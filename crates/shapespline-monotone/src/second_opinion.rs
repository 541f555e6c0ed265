//! The paper's program through NLopt (feature `nlopt`): a second opinion, not a faster way. On the program with optimal
//! slopes NLopt's opinion is asked in Python: `tests/test_monotone_nlopt.py`.
//!
//! The crate's own solvers exploit the tridiagonal structure; NLopt's SLSQP treats the same programs as dense smooth
//! problems, O(N³) an iteration. Meant for N up to a hundred or so, in tests and comparisons.

use crate::MonotoneError;
use crate::data::Data;
use crate::energy::{self, Fairness};
use crate::program::{Program, admissible_slopes};
use crate::slopes;
use nlopt::{Algorithm, Nlopt, Target};

/// The optimum of the paper's program with Fritsch–Butland slopes by NLopt's SLSQP: second derivatives in the data's
/// units and the minimised energy.
///
/// # Errors
/// As [`crate::MonotoneQuintic::new`].
///
/// ```
/// use shapespline_monotone::{Fairness, MonotoneQuintic, QuinticOptions, Slopes, second_opinion};
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0, 5.0], [0.0, 0.1, 2.0, 2.1, 4.0]);
/// let (_, energy) = second_opinion::paper_program(&x, &y, Fairness::Bending)?;
/// let options = QuinticOptions { slopes: Slopes::FritschButland, ..QuinticOptions::default() };
/// let ours = MonotoneQuintic::new(&x, &y, &options)?.bending_energy();
/// assert!((energy / ours - 1.0).abs() < 1e-8);
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn paper_program(
    x: &[f64],
    y: &[f64],
    fairness: Fairness,
) -> Result<(Vec<f64>, f64), MonotoneError> {
    let data = Data::new(x, y)?;
    data.check_curvature(y)?;
    let mut d = slopes::fritsch_butland(&data);
    admissible_slopes(&data, &mut d);
    let program = Program::new(&data, &d, fairness)?;
    let n = d.len();
    // Unknowns of order one: distance from the middle of the box over its half width; fixed ones stay at 0.
    let middle: Vec<f64> = (0..n).map(|i| 0.5 * (program.lower[i] + program.upper[i])).collect();
    let half: Vec<f64> = (0..n).map(|i| 0.5 * (program.upper[i] - program.lower[i])).collect();
    let place = |u: &[f64]| -> Vec<f64> { (0..n).map(|i| middle[i] + half[i] * u[i]).collect() };
    let size: f64 = (0..n)
        .map(|i| half[i] * half[i] * program.diagonal[i] + half[i] * program.linear[i].abs())
        .fold(f64::MIN_POSITIVE, f64::max);
    let objective = |u: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
        let s = place(u);
        let mut value = 0.0;
        let mut slope = vec![0.0; n];
        for i in 0..n {
            let left = if i > 0 { program.off_diagonal[i - 1] * s[i - 1] } else { 0.0 };
            let right = if i + 1 < n { program.off_diagonal[i] * s[i + 1] } else { 0.0 };
            let own = program.diagonal[i] * s[i];
            value += s[i] * (0.5 * own + right + program.linear[i]);
            slope[i] = half[i] * (own + left + right + program.linear[i]) / size;
        }
        if let Some(gradient) = gradient {
            gradient.copy_from_slice(&slope);
        }
        value / size
    };
    let mut solver = Nlopt::new(Algorithm::Slsqp, n, objective, Target::Minimize, ());
    // The only failures of these calls are lengths that do not match, which cannot be.
    let _ = solver.set_lower_bounds(&vec![-1.0; n]);
    let _ = solver.set_upper_bounds(&vec![1.0; n]);
    let _ = solver.set_xtol_rel(1e-13);
    let _ = solver.set_ftol_rel(1e-15);
    let _ = solver.set_maxeval(5000);
    let mut u = vec![0.0; n];
    // Running out of steps or of rounding is an answer too: the energy tells how good it is.
    let _ = solver.optimize(&mut u);
    let s = place(&u);
    let energy = data.units().energy_out(fairness, energy::total(&data, fairness, &d, &s));
    let mut s = s;
    data.units().seconds_out(&mut s);
    Ok((s, energy))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{MonotoneQuintic, QuinticOptions, Slopes};

    fn random(next: &mut impl FnMut() -> f64, case: usize) -> (Vec<f64>, Vec<f64>) {
        let n = 3 + (next() * 12.0) as usize;
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for k in 0..n {
            x.push(x[k] + (0.05 + next()) * 10f64.powf(next()));
            let turn = if case % 3 == 2 && next() < 0.3 { -1.0 } else { 1.0 };
            let flat = case % 3 == 1 && next() < 0.2;
            y.push(if flat { y[k] } else { y[k] + turn * (0.01 + next()) * 10f64.powf(next()) });
        }
        (x, y)
    }

    fn generator() -> impl FnMut() -> f64 {
        let mut state = 5u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn the_box_program_on_random_data() {
        let mut next = generator();
        for case in 0..60 {
            let (x, y) = random(&mut next, case);
            for fairness in [Fairness::Bending, Fairness::Parametric] {
                let options = QuinticOptions {
                    slopes: Slopes::FritschButland,
                    fairness,
                    ..QuinticOptions::default()
                };
                let ours = MonotoneQuintic::new(&x, &y, &options).unwrap().diagnostics().energy;
                let (_, theirs) = paper_program(&x, &y, fairness).unwrap();
                assert!((ours - theirs).abs() <= 1e-8 * theirs, "case {case}: {ours} {theirs}");
            }
        }
    }
}
