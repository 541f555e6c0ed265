//! The paper's C² program (17), (20), (22), (23) as a tridiagonal box program in the nodal second derivatives.
//!
//! With `sᵢ` as unknowns the continuity equations (17) hold by construction:
//! `βᵢdᵢ₊₁ = 3(Δᵢ−dᵢ) − sᵢhᵢ/2`, `αᵢ₋₁dᵢ₋₁ = 3(Δᵢ₋₁−dᵢ) + sᵢhᵢ₋₁/2`. Between neighbours of one sign (22), (23)
//! read `−4dᵢ/hᵢ ≤ sᵢ ≤ 4dᵢ/hᵢ₋₁` and α, β ≥ 0 reads `6(dᵢ−Δᵢ₋₁)/hᵢ₋₁ ≤ sᵢ ≤ 6(Δᵢ−dᵢ)/hᵢ`. Decreasing data are
//! the reflection. At a turn of the data dᵢ = 0 and sᵢ has the turn's sign; at a flat segment dᵢ = sᵢ = 0.

use crate::MonotoneError;
use crate::data::{Data, each, out_of_range};
use crate::energy::{Fairness, is_flat};
use shapespline_banded::box_qp::{BoxQpSolution, TridiagonalBoxQp, solve};
use std::ops::Range;

/// Bounds are pulled in by this factor so that the derivative's coefficients stay non-negative after rounding.
const INSIDE: f64 = 1.0 - 4.0 * f64::EPSILON;

/// The program's arrays, in scaled units.
#[derive(Debug, Clone, Default)]
pub(crate) struct Program {
    pub(crate) diagonal: Vec<f64>,
    pub(crate) off_diagonal: Vec<f64>,
    pub(crate) linear: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
}

/// The larger of two numbers, as a plain selection.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller of two numbers, as a plain selection.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The interval one segment leaves to the second derivative at one of its ends, for an increasing segment seen
/// from its left end: `[−4d/h, 6(Δ−d)/h]`. `d`, `delta` ≥ 0.
#[inline]
fn interval(h: f64, delta: f64, d: f64) -> (f64, f64) {
    let inverse = 1.0 / h;
    (-4.0 * (d * inverse) * INSIDE, 6.0 * ((delta - d) * inverse))
}

/// Case 2 of the paper: a slope for which (17) has no non-negative solution is lowered to
/// `(Δᵢ₋₁hᵢ + Δᵢhᵢ₋₁)/(hᵢ₋₁ + hᵢ)` (equation (19)). Also clears slopes at flats. In place, O(N).
pub(crate) fn admissible_slopes(data: &Data, d: &mut [f64]) {
    let (h, delta) = (&data.h, &data.delta);
    let n = data.len();
    each(d, |i, d| {
        let (l, r) = (i.max(1) - 1, i.min(n - 1));
        if is_flat(delta[l]) || is_flat(delta[r]) {
            return 0.0;
        }
        if l == r || d == 0.0 {
            return d;
        }
        let sum = h[l] + h[r];
        let cap = delta[l] * (h[r] / sum) + delta[r] * (h[l] / sum);
        if d.abs() > cap.abs() { cap } else { d }
    });
}

impl Program {
    /// Assemble the whole program. O(N).
    pub(crate) fn new(data: &Data, d: &[f64], fairness: Fairness) -> Result<Self, MonotoneError> {
        let mut program = Self::default();
        program.fill(data, d, fairness, 0..data.len())?;
        Ok(program)
    }

    /// Assemble the program of some segments alone, in place. O(segments).
    pub(crate) fn fill(
        &mut self,
        data: &Data,
        d: &[f64],
        fairness: Fairness,
        segments: Range<usize>,
    ) -> Result<(), MonotoneError> {
        let (h, delta) = (&data.h[segments.clone()], &data.delta[segments.clone()]);
        let d = &d[segments.start..=segments.end];
        let n = h.len();
        for (array, room) in [
            (&mut self.diagonal, n + 1),
            (&mut self.off_diagonal, n),
            (&mut self.linear, n + 1),
            (&mut self.lower, n + 1),
            (&mut self.upper, n + 1),
        ] {
            array.clear();
            array.reserve_exact(room);
        }
        // A node gets its entries from the segments on both sides: what the one on the left leaves is carried along.
        let mut carry = (0.0, 0.0, f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..n {
            let (h, delta, d0, d1) = (h[i], delta[i], d[i], d[i + 1]);
            // Energy (20) in s, times 35 and the fairness weight: h³ between the two energies.
            let weight = match fairness {
                Fairness::Bending => 1.0,
                Fairness::Parametric => h * h * h,
            };
            if !(weight * h > 1e-300 && weight * h < 1e300) {
                return Err(out_of_range("parametric energy", "x", segments.start + i, h));
            }
            let (left, right) = if is_flat(delta) {
                ((0.0, 0.0), (0.0, 0.0))
            } else {
                let (slope0, slope1, size) = (d0.abs(), d1.abs(), delta.abs());
                let (left, right) = (interval(h, size, slope0), interval(h, size, slope1));
                // The right end is the left end of the segment traversed backwards with y reflected as well.
                let turned = |(low, high): (f64, f64)| (-high, -low);
                if delta < 0.0 { (turned(left), right) } else { (left, turned(right)) }
            };
            let meets = (larger(carry.2, left.0), smaller(carry.3, left.1));
            let (e0, e1) = (d0 - delta, d1 - delta);
            self.off_diagonal.push(weight * h);
            self.diagonal.push(carry.0 + 6.0 * weight * h);
            self.linear.push(carry.1 + weight * (22.0 * e0 + 8.0 * e1));
            self.bound(meets);
            carry = (6.0 * weight * h, -(weight * (8.0 * e0 + 22.0 * e1)), right.0, right.1);
        }
        self.diagonal.push(carry.0);
        self.linear.push(carry.1);
        self.bound((carry.2, carry.3));
        Ok(())
    }

    /// Append a node's bounds (zeros without a sign). Case 2 and the turns make the two meet exactly, and a flat beside fixes both at zero;
    /// rounding must not make the box empty.
    #[inline]
    fn bound(&mut self, (low, high): (f64, f64)) {
        let met = if low.abs() < high.abs() { low } else { high };
        let empty = low > high;
        self.lower.push(if empty { met } else { low } + 0.0);
        self.upper.push(if empty { met } else { high } + 0.0);
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
