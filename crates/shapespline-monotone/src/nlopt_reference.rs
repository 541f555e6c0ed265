// SPDX-License-Identifier: MIT OR Apache-2.0

//! The quintic's two programs through NLopt (feature `nlopt`): a reference to compare with, not a faster way.
//!
//! The crate's own solvers exploit the banded structure; NLopt's SLSQP treats the same programs as dense smooth
//! problems, O(N³) an iteration. Meant for N up to a hundred or so, in tests and comparisons.

use crate::MonotoneError;
use crate::data::Data;
use crate::energy::{self, Fairness};
use crate::optimal::parts::Quadratic;
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
/// use shapespline_monotone::{Fairness, MonotoneQuintic, QuinticOptions, Slopes, nlopt_reference};
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0, 5.0], [0.0, 0.1, 2.0, 2.1, 4.0]);
/// let (_, energy) = nlopt_reference::paper_program(&x, &y, Fairness::Bending)?;
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
    Ok((data.units().derivatives_out(&s, 2), energy))
}

/// The optimum over slopes and second derivatives by NLopt's SLSQP: both in the data's units, and the minimised energy.
///
/// Monotone by the Bernstein coefficients of the derivative on 2^`level` equal parts of every segment: sufficient
/// conditions, which close in on the exact ones that [`crate::MonotoneQuintic`] works with (within 0.5 % of the least
/// energy) as the level grows.
///
/// # Errors
/// As [`crate::MonotoneQuintic::new`].
///
/// ```
/// use shapespline_monotone::{Fairness, MonotoneQuintic, QuinticOptions, nlopt_reference};
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0, 5.0], [0.0, 0.1, 2.0, 2.1, 4.0]);
/// let (_, _, energy) = nlopt_reference::optimal_program(&x, &y, Fairness::Bending, 3)?;
/// let ours = MonotoneQuintic::new(&x, &y, &QuinticOptions::default())?.bending_energy();
/// assert!((energy / ours - 1.0).abs() < 5e-3);
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn optimal_program(
    x: &[f64],
    y: &[f64],
    fairness: Fairness,
    level: u8,
) -> Result<(Vec<f64>, Vec<f64>, f64), MonotoneError> {
    let data = Data::new(x, y)?;
    data.check_curvature(y)?;
    let mut d = slopes::fritsch_butland(&data);
    admissible_slopes(&data, &mut d);
    // The paper's optimum is monotone: a start that is feasible, or nearly so on parts.
    let mut s = Program::new(&data, &d, fairness)?.solve()?.x;
    let program = Quadratic::of(&data, fairness, level);
    let free: Vec<usize> = (0..2 * d.len()).filter(|j| !program.fixed.contains(j)).collect();
    let start: Vec<f64> =
        free.iter().map(|j| if j % 2 == 0 { d[j / 2] } else { s[j / 2] }).collect();
    let v = least(&program, &free, &start);
    d.fill(0.0);
    s.fill(0.0);
    for (&j, v) in free.iter().zip(v) {
        if j % 2 == 0 { d[j / 2] = v } else { s[j / 2] = v }
    }
    let energy = data.units().energy_out(fairness, energy::total(&data, fairness, &d, &s));
    let units = data.units();
    Ok((units.derivatives_out(&d, 1), units.derivatives_out(&s, 2), energy))
}

/// The free unknowns that minimise. In the unknowns `w = Lᵀv + L⁻¹q`, P = LLᵀ, the energy is ½|w|²: SLSQP begins with
/// the identity in place of the Hessian, which then is the Hessian, and its first quadratic program is the whole one. In
/// v itself it creeps along the valleys of P and stops a twentieth of a per cent too high; here it agrees with Clarabel to
/// 1e-11.
fn least(program: &Quadratic, free: &[usize], start: &[f64]) -> Vec<f64> {
    let n = free.len();
    if n == 0 {
        return Vec::new();
    }
    let mut place = vec![None; program.linear.len()];
    for (k, &j) in free.iter().enumerate() {
        place[j] = Some(k);
    }
    let mut p = vec![vec![0.0; n]; n];
    for &(i, j, value) in &program.hessian {
        if let (Some(i), Some(j)) = (place[i], place[j]) {
            p[i][j] += value;
        }
    }
    let q: Vec<f64> = free.iter().map(|&j| program.linear[j]).collect();
    let l = cholesky(p);
    let shift = forward(&l, &q);
    // Conditions r·v + c ≥ 0 as a·w + b ≥ 0 with |a| = 1.
    let rows: Vec<(Vec<f64>, f64)> = program
        .positive
        .iter()
        .map(|(row, constant)| {
            let mut r = vec![0.0; n];
            row.iter().for_each(|&(j, value)| place[j].map_or((), |k| r[k] += value));
            let a = forward(&l, &r);
            let b = constant - dot(&a, &shift);
            let norm = dot(&a, &a).sqrt();
            (a, b, norm)
        })
        // A condition on nothing but what is fixed holds already.
        .filter(|(_, _, norm)| *norm > 0.0)
        .map(|(a, b, norm)| (a.iter().map(|a| a / norm).collect(), b / norm))
        .collect();
    let mut w: Vec<f64> =
        (0..n).map(|k| shift[k] + (k..n).map(|i| l[i][k] * start[i]).sum::<f64>()).collect();
    // In units of the start's length.
    let size = dot(&w, &w).sqrt().max(f64::MIN_POSITIVE);
    w.iter_mut().for_each(|w| *w /= size);
    let objective = |w: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
        if let Some(gradient) = gradient {
            gradient.copy_from_slice(w);
        }
        0.5 * dot(w, w)
    };
    let mut solver = Nlopt::new(Algorithm::Slsqp, n, objective, Target::Minimize, ());
    for (a, b) in &rows {
        // Moved: the solver keeps it beyond this turn of the loop, which the crate's signature does not say.
        let condition = move |w: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
            if let Some(gradient) = gradient {
                gradient.iter_mut().zip(a).for_each(|(g, a)| *g = -a);
            }
            -(dot(a, w) + b / size)
        };
        // The only failures of these calls are lengths that do not match, which cannot be.
        let _ = solver.add_inequality_constraint(condition, (), 1e-12);
    }
    let _ = solver.set_xtol_rel(1e-13);
    let _ = solver.set_ftol_rel(1e-15);
    let _ = solver.set_maxeval(1000);
    // Running out of steps or of rounding is an answer too: the energy tells how good it is.
    let _ = solver.optimize(&mut w);
    drop(solver);
    // Lᵀv = w − shift.
    let mut v: Vec<f64> = w.iter().zip(&shift).map(|(w, shift)| w * size - shift).collect();
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|i| l[i][k] * v[i]).sum();
        v[k] = (v[k] - rest) / l[k][k];
    }
    v
}

/// L with LLᵀ = P; L replaces P's lower half.
fn cholesky(mut p: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for i in 0..p.len() {
        for j in 0..=i {
            let rest = p[i][j] - dot(&p[i][..j], &p[j][..j]);
            p[i][j] = if i == j { rest.sqrt() } else { rest / p[j][j] };
        }
    }
    p
}

/// The solution of Lz = b.
fn forward(l: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let mut z: Vec<f64> = Vec::with_capacity(b.len());
    for (row, b) in l.iter().zip(b) {
        z.push((b - dot(&row[..z.len()], &z)) / row[z.len()]);
    }
    z
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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

    /// Against Clarabel on the same program.
    #[test]
    fn the_optimal_program_agrees_with_clarabel() {
        let mut next = generator();
        for case in 0..40 {
            let (x, y) = random(&mut next, case);
            let data = Data::new(&x, &y).unwrap();
            for fairness in [Fairness::Bending, Fairness::Parametric] {
                for level in [0, 3] {
                    let (d, s, _) = crate::reference::optimal(&data, fairness, level);
                    let theirs = energy::total(&data, fairness, &d, &s);
                    let theirs = data.units().energy_out(fairness, theirs);
                    let (_, _, found) = optimal_program(&x, &y, fairness, level).unwrap();
                    let off = (found - theirs).abs() / theirs;
                    assert!(off <= 1e-8, "case {case} level {level}: {found} {theirs} {off:e}");
                }
            }
        }
    }

    /// On Fritsch and Carlson's RPN 14: the values of the specification.
    #[test]
    fn the_optimal_program_on_rpn14() {
        let x = [7.99, 8.09, 8.19, 8.7, 9.2, 10.0, 12.0, 15.0, 20.0];
        let y = [
            0.0, 2.76429e-5, 4.37498e-2, 0.169183, 0.469428, 0.943740, 0.998636, 0.999919, 0.999994,
        ];
        for (level, expected) in [(0, 10.214), (1, 9.890), (3, 9.830)] {
            let (_, _, found) = optimal_program(&x, &y, Fairness::Bending, level).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-4, "level {level}: {found}");
        }
    }
}
