//! The paper's C² program (17), (20), (22), (23) as a tridiagonal box program in the nodal second derivatives.
//!
//! With `sᵢ` as unknowns the continuity equations (17) hold by construction:
//! `βᵢdᵢ₊₁ = 3(Δᵢ−dᵢ) − sᵢhᵢ/2`, `αᵢ₋₁dᵢ₋₁ = 3(Δᵢ₋₁−dᵢ) + sᵢhᵢ₋₁/2`. Between neighbours of one sign (22), (23)
//! read `−4dᵢ/hᵢ ≤ sᵢ ≤ 4dᵢ/hᵢ₋₁` and α, β ≥ 0 reads `6(dᵢ−Δᵢ₋₁)/hᵢ₋₁ ≤ sᵢ ≤ 6(Δᵢ−dᵢ)/hᵢ`. Decreasing data are
//! the reflection. At a turn of the data dᵢ = 0 and sᵢ has the turn's sign; at a flat segment dᵢ = sᵢ = 0.

use crate::MonotoneError;
use crate::data::{Data, out_of_range};
use crate::energy::{Fairness, is_flat};
use crate::slopes::sign;
use shapespline_banded::box_qp::{BoxQpSolution, TridiagonalBoxQp, solve};

/// Bounds are pulled in by this factor so that the derivative's coefficients stay non-negative after rounding.
const INSIDE: f64 = 1.0 - 4.0 * f64::EPSILON;

/// The program's arrays, in scaled units.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    pub(crate) diagonal: Vec<f64>,
    pub(crate) off_diagonal: Vec<f64>,
    pub(crate) linear: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
}

/// The interval one segment leaves to the second derivative at one of its ends, for an increasing segment seen
/// from its left end: `[−4d/h, 6(Δ−d)/h]`. `d`, `delta` ≥ 0.
#[inline]
fn interval(h: f64, delta: f64, d: f64) -> (f64, f64) {
    (-4.0 * (d / h) * INSIDE, 6.0 * ((delta - d) / h))
}

/// Case 2 of the paper: a slope for which (17) has no non-negative solution is lowered to
/// `(Δᵢ₋₁hᵢ + Δᵢhᵢ₋₁)/(hᵢ₋₁ + hᵢ)` (equation (19)). Also clears slopes at flats. In place, O(N).
pub(crate) fn admissible_slopes(data: &Data, d: &mut [f64]) {
    let (h, delta) = (&data.h, &data.delta);
    let n = data.len();
    for i in 0..=n {
        let (l, r) = (i.max(1) - 1, i.min(n - 1));
        if is_flat(delta[l]) || is_flat(delta[r]) {
            d[i] = 0.0;
        } else if l != r && d[i] != 0.0 {
            let sum = h[l] + h[r];
            let cap = delta[l] * (h[r] / sum) + delta[r] * (h[l] / sum);
            if d[i].abs() > cap.abs() {
                d[i] = cap;
            }
        }
    }
}

impl Program {
    /// Assemble. O(N).
    pub(crate) fn new(data: &Data, d: &[f64], fairness: Fairness) -> Result<Self, MonotoneError> {
        let (h, delta) = (&data.h, &data.delta);
        let n = data.len();
        let mut p = Self {
            diagonal: vec![0.0; n + 1],
            off_diagonal: Vec::with_capacity(n),
            linear: vec![0.0; n + 1],
            lower: vec![f64::NEG_INFINITY; n + 1],
            upper: vec![f64::INFINITY; n + 1],
        };
        for i in 0..n {
            let (h, delta, d0, d1) = (h[i], delta[i], d[i], d[i + 1]);
            // Energy (20) in s, times 35 and the fairness weight: h³ between the two energies.
            let weight = match fairness {
                Fairness::Bending => 1.0,
                Fairness::Parametric => h * h * h,
            };
            if !(weight * h > 1e-300 && weight * h < 1e300) {
                return Err(out_of_range("parametric energy", "x", i, h));
            }
            p.off_diagonal.push(weight * h);
            p.diagonal[i] += 6.0 * weight * h;
            p.diagonal[i + 1] += 6.0 * weight * h;
            p.linear[i] += weight * (22.0 * (d0 - delta) + 8.0 * (d1 - delta));
            p.linear[i + 1] -= weight * (8.0 * (d0 - delta) + 22.0 * (d1 - delta));
            if is_flat(delta) {
                for k in [i, i + 1] {
                    (p.lower[k], p.upper[k]) = (0.0, 0.0);
                }
                continue;
            }
            let up = sign(delta);
            let mut meet = |k: usize, (low, high): (f64, f64), reflect: bool| {
                let (low, high) = if reflect { (-high, -low) } else { (low, high) };
                p.lower[k] = p.lower[k].max(low);
                p.upper[k] = p.upper[k].min(high);
            };
            // The right end is the left end of the segment traversed backwards with y reflected as well.
            meet(i, interval(h, delta.abs(), d0.abs()), up < 0.0);
            meet(i + 1, interval(h, delta.abs(), d1.abs()), up > 0.0);
        }
        for (low, high) in p.lower.iter_mut().zip(&mut p.upper) {
            // Case 2 and the turns make the two bounds meet exactly; rounding must not make the box empty.
            if *low > *high {
                let meet = if low.abs() < high.abs() { *low } else { *high };
                (*low, *high) = (meet, meet);
            }
        }
        Ok(p)
    }

    pub(crate) fn view(&self) -> TridiagonalBoxQp<'_> {
        TridiagonalBoxQp {
            diagonal: &self.diagonal,
            off_diagonal: &self.off_diagonal,
            linear: &self.linear,
            lower: &self.lower,
            upper: &self.upper,
        }
    }

    /// The in-house active-set solution. O(N) a round.
    pub(crate) fn solve(&self) -> Result<BoxQpSolution, MonotoneError> {
        Ok(solve(&self.view())?)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::reference;
    use crate::slopes;

    /// The box program on random data (increasing, decreasing, with turns and flats) against Clarabel: objective to
    /// 1e-8 relative, KKT residual to 1e-10.
    #[test]
    fn agrees_with_clarabel() {
        let mut state = 11u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for case in 0..100 {
            let n = 2 + (next() * 60.0) as usize;
            let (mut x, mut y) = (vec![0.0], vec![0.0]);
            for k in 0..n {
                x.push(x[k] + (0.05 + next()) * 10f64.powf(2.0 * next()));
                let sign = match case % 4 {
                    0 => 1.0,
                    1 => -1.0,
                    _ => (next() - 0.3).signum(),
                };
                let flat = case % 4 == 3 && next() < 0.1;
                y.push(if flat { y[k] } else { y[k] + sign * next() * 10f64.powf(2.0 * next()) });
            }
            let data = Data::new(&x, &y).unwrap();
            let mut d = slopes::fritsch_butland(&data);
            admissible_slopes(&data, &mut d);
            let fairness = if case % 2 == 0 { Fairness::Bending } else { Fairness::Parametric };
            let program = Program::new(&data, &d, fairness).unwrap();
            let ours = program.solve().unwrap();
            assert!(
                ours.solved && ours.safeguards == 0 && ours.kkt_residual <= 1e-10,
                "case {case}"
            );
            // Clarabel gets unknowns of one size: xᵢ = uᵢ/√diagonalᵢ.
            let size = n + 1;
            let unit: Vec<f64> = program.diagonal.iter().map(|d| 1.0 / d.sqrt()).collect();
            let linear: Vec<f64> = (0..size).map(|i| unit[i] * program.linear[i]).collect();
            let largest = linear.iter().fold(f64::MIN_POSITIVE, |a, v| a.max(v.abs()));
            let mut p = Vec::new();
            for i in 0..size {
                p.push((i, i, 1.0));
                if i < n {
                    p.push((i, i + 1, program.off_diagonal[i] * unit[i] * unit[i + 1]));
                }
            }
            let mut equal = Vec::new();
            let mut positive = Vec::new();
            for i in 0..size {
                let k = unit[i] * largest;
                let (lo, hi) = (program.lower[i] / k, program.upper[i] / k);
                if lo == hi {
                    equal.push((vec![(i, 1.0)], -lo));
                } else {
                    positive.push((vec![(i, 1.0)], -lo));
                    positive.push((vec![(i, -1.0)], hi));
                }
            }
            let q: Vec<f64> = linear.iter().map(|v| v / largest).collect();
            let (u, _) = reference::quadratic(size, p, &q, &equal, &positive);
            let x: Vec<f64> = (0..size).map(|i| u[i] * unit[i] * largest).collect();
            let objective = |x: &[f64]| -> f64 {
                (0..size)
                    .map(|i| {
                        let next = if i < n { program.off_diagonal[i] * x[i + 1] } else { 0.0 };
                        x[i] * (0.5 * program.diagonal[i] * x[i] + next + program.linear[i])
                    })
                    .sum()
            };
            let (a, b) = (objective(&ours.x), objective(&x));
            assert!((a - b).abs() <= 1e-8 * b.abs().max(1e-9), "case {case}: {a} {b}");
        }
    }

    #[test]
    fn boxes_meet_the_paper_s_case_two() {
        // A steep-gentle pair with uneven spacing: the harmonic mean is too large for (17).
        let data = Data::new(&[0.0, 4.0, 4.5, 9.0], &[0.0, 4.0, 4.6, 6.0]).unwrap();
        let mut d = slopes::fritsch_butland(&data);
        d[1] *= 1.9;
        let before = d.clone();
        admissible_slopes(&data, &mut d);
        assert!(d[1] < before[1]);
        let p = Program::new(&data, &d, Fairness::Bending).unwrap();
        assert!((p.upper[1] - p.lower[1]).abs() <= 1e-14 * p.upper[1].abs().max(1.0));
        assert!(p.solve().unwrap().solved);
    }
}
