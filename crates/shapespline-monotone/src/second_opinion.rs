//! The programs of this crate through NLopt (feature `nlopt`): a second opinion, not a faster way.
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

/// How often the optimal program is taken up again at most.
const RESTARTS: usize = 50;

/// One linear condition `constant + Σ factor·unknown ≥ 0`.
struct Row {
    factors: [(usize, f64); 4],
    constant: f64,
}

/// The derivative's Bernstein coefficients over Δ on `parts` equal parts of a segment, as linear functions of
/// (d₀/Δ, h s₀/4Δ, d₁/Δ, h s₁/4Δ) and 1 (the last column): blossoms, corner by corner.
fn conditions(parts: usize) -> Vec<[f64; 5]> {
    // c₀, c₁, c₂ = 5 − …, c₃, c₄ on the whole segment.
    let whole = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0],
        [-2.0, -1.0, -2.0, 1.0, 5.0],
        [0.0, 0.0, 1.0, -1.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0],
    ];
    let mut out = Vec::new();
    for part in 0..parts {
        let ends = [part as f64 / parts as f64, (part + 1) as f64 / parts as f64];
        for k in 0..=4 {
            // The blossom at k times the right end and 4 − k times the left one.
            let mut b = whole;
            for level in 0..4 {
                let t = ends[usize::from(level < k)];
                for j in 0..4 - level {
                    b[j] = std::array::from_fn(|c| (1.0 - t) * b[j][c] + t * b[j + 1][c]);
                }
            }
            out.push(b[0]);
        }
    }
    out
}

/// The optimum over slopes and second derivatives by NLopt's SLSQP, monotonicity asked of the derivative's Bernstein
/// coefficients on `parts` equal parts of every segment: slopes and second derivatives in the data's units and the
/// minimised energy. The more parts, the nearer to the exact optimum, from above.
///
/// # Errors
/// As [`crate::MonotoneQuintic::new`].
///
/// ```
/// use shapespline_monotone::{Fairness, MonotoneQuintic, QuinticOptions, second_opinion};
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0, 5.0], [0.0, 0.1, 2.0, 2.1, 4.0]);
/// let (_, _, energy) = second_opinion::optimal_program(&x, &y, Fairness::Bending, 8)?;
/// let ours = MonotoneQuintic::new(&x, &y, &QuinticOptions::default())?.bending_energy();
/// assert!((energy / ours - 1.0).abs() < 5e-3);
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn optimal_program(
    x: &[f64],
    y: &[f64],
    fairness: Fairness,
    parts: usize,
) -> Result<(Vec<f64>, Vec<f64>, f64), MonotoneError> {
    let data = Data::new(x, y)?;
    data.check_curvature(y)?;
    let (h, delta, n) = (&data.h, &data.delta, data.len());
    // The paper's solution is feasible: the start, and the size of the unknowns.
    let mut d = slopes::fritsch_butland(&data);
    admissible_slopes(&data, &mut d);
    let s = Program::new(&data, &d, fairness)?.solve()?.x;
    let start: Vec<f64> = d.iter().zip(&s).flat_map(|(d, s)| [*d, *s]).collect();
    let mut unit = vec![0.0; 2 * (n + 1)];
    let mut fixed = vec![false; 2 * (n + 1)];
    let (mut rows, mut energy) = (Vec::new(), Vec::new());
    for i in 0..n {
        let u = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3];
        if energy::is_flat(delta[i]) {
            u.iter().for_each(|&j| fixed[j] = true);
            continue;
        }
        if i > 0 && delta[i - 1] * delta[i] < 0.0 {
            fixed[2 * i] = true;
        }
        let scale = [1.0 / delta[i], 0.25 * h[i] / delta[i]];
        for k in 0..4 {
            unit[u[k]] = f64::max(unit[u[k]], 1.0 / scale[k % 2].abs());
        }
        energy.push((u, scale, energy::weight(fairness, h[i], delta[i]) / 35.0));
        for c in conditions(parts) {
            let factors = std::array::from_fn(|k| (u[k], c[k] * scale[k % 2]));
            rows.push(Row { factors, constant: c[4] });
        }
    }
    unit.iter_mut().filter(|u| **u == 0.0).for_each(|u| *u = 1.0);
    let size = energy.iter().fold(f64::MIN_POSITIVE, |a, (_, _, w)| a.max(*w));
    let objective = |v: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
        let (mut value, mut slope) = (0.0, vec![0.0; v.len()]);
        for (u, scale, weight) in &energy {
            let mut a: [f64; 4] = std::array::from_fn(|k| v[u[k]] * unit[u[k]] * scale[k % 2]);
            a[0] -= 1.0;
            a[2] -= 1.0;
            value += weight / size * energy::local(a[0], a[1], a[2], a[3]);
            for j in 0..4 {
                let row: f64 = (0..4).map(|k| energy::HESSIAN[j][k] * a[k]).sum();
                slope[u[j]] += weight / size * row * unit[u[j]] * scale[j % 2];
            }
        }
        if let Some(gradient) = gradient {
            gradient.copy_from_slice(&slope);
        }
        value
    };
    let negated = |out: &mut [f64], v: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
        let factor = |j: usize, f: f64| f * unit[j];
        for (out, row) in out.iter_mut().zip(&rows) {
            let sum: f64 = row.factors.iter().map(|(j, f)| factor(*j, *f) * v[*j]).sum();
            *out = -(row.constant + sum);
        }
        if let Some(gradient) = gradient {
            gradient.fill(0.0);
            for (k, row) in rows.iter().enumerate() {
                for (j, f) in row.factors {
                    gradient[k * v.len() + j] = -factor(j, f);
                }
            }
        }
    };
    let mut v: Vec<f64> = start.iter().zip(&unit).map(|(v, u)| v / u).collect();
    let bound = |side: f64| -> Vec<f64> {
        fixed.iter().map(|fixed| if *fixed { 0.0 } else { side }).collect()
    };
    let mut solver = Nlopt::new(Algorithm::Slsqp, v.len(), objective, Target::Minimize, ());
    // The only failures of these calls are lengths that do not match, which cannot be.
    let _ = solver.set_lower_bounds(&bound(f64::NEG_INFINITY));
    let _ = solver.set_upper_bounds(&bound(f64::INFINITY));
    let _ = solver.add_inequality_mconstraint(rows.len(), negated, (), &vec![1e-12; rows.len()]);
    let _ = solver.set_xtol_rel(1e-13);
    let _ = solver.set_ftol_rel(1e-15);
    let _ = solver.set_maxeval(2000);
    // SLSQP stops where its picture of the second derivatives has worn out; begun anew it goes on. Running out of steps
    // or of rounding is an answer too: the energy tells how good it is.
    let mut least = f64::INFINITY;
    for _ in 0..RESTARTS {
        let (Ok((_, value)) | Err((_, value))) = solver.optimize(&mut v);
        if !(value < least * (1.0 - 1e-10)) {
            break;
        }
        least = value;
    }
    let (mut d, mut s): (Vec<f64>, Vec<f64>) =
        (0..=n).map(|i| (v[2 * i] * unit[2 * i], v[2 * i + 1] * unit[2 * i + 1])).unzip();
    let units = data.units();
    let energy = units.energy_out(fairness, energy::total(&data, fairness, &d, &s));
    units.slopes_out(&mut d);
    units.seconds_out(&mut s);
    Ok((d, s, energy))
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

    #[test]
    fn the_optimal_program_on_random_data() {
        let mut next = generator();
        for case in 0..12 {
            let (x, y) = random(&mut next, case);
            let options = QuinticOptions::default();
            let ours = MonotoneQuintic::new(&x, &y, &options).unwrap().bending_energy();
            let (_, _, theirs) = optimal_program(&x, &y, Fairness::Bending, 6).unwrap();
            // Theirs has finitely many conditions too, ours is promised to within half a per cent.
            let ratio = ours / theirs;
            assert!((0.97..=1.005).contains(&ratio), "case {case}: {ours} {theirs}");
        }
    }

    /// The specification's table: the conditions on 1, 2 and 8 parts.
    #[test]
    fn published_data() {
        let read = |name: &str| -> (Vec<f64>, Vec<f64>) {
            let path = format!("{}/../../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).unwrap();
            text.lines()
                .filter_map(|l| l.split_once(','))
                .filter_map(|(x, y)| {
                    Some((x.trim().parse::<f64>().ok()?, y.trim().parse::<f64>().ok()?))
                })
                .unzip()
        };
        for (name, parts, expected) in [
            ("rpn14.csv", 1, 10.214),
            ("rpn14.csv", 2, 9.890),
            ("rpn14.csv", 8, 9.830),
            ("akima.csv", 1, 7503.6),
            ("akima.csv", 2, 4867.5),
            ("akima.csv", 8, 4594.0),
        ] {
            let (x, y) = read(name);
            let (_, _, energy) = optimal_program(&x, &y, Fairness::Bending, parts).unwrap();
            assert!((energy / expected - 1.0).abs() < 1e-4, "{name} {parts}: {energy}");
        }
    }
}
