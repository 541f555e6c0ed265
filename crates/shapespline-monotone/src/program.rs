// SPDX-License-Identifier: MIT OR Apache-2.0

//! The paper's C² program (17), (20), (22), (23) as a tridiagonal box program in the nodal second derivatives.
//!
//! With `sᵢ` as unknowns the continuity equations (17) hold by construction:
//! `βᵢdᵢ₊₁ = 3(Δᵢ−dᵢ) − sᵢhᵢ/2`, `αᵢ₋₁dᵢ₋₁ = 3(Δᵢ₋₁−dᵢ) + sᵢhᵢ₋₁/2`. Between neighbours of one sign (22), (23)
//! read `−4dᵢ/hᵢ ≤ sᵢ ≤ 4dᵢ/hᵢ₋₁` and α, β ≥ 0 reads `6(dᵢ−Δᵢ₋₁)/hᵢ₋₁ ≤ sᵢ ≤ 6(Δᵢ−dᵢ)/hᵢ`. Decreasing data are
//! the reflection. At a turn of the data dᵢ = 0 and sᵢ has the turn's sign; at a flat segment dᵢ = sᵢ = 0.

use crate::MonotoneError;
use crate::data::{Data, out_of_range, parts_mut};
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

/// The intervals that a segment leaves to the second derivatives at its ends: of an increasing one seen from its left
/// end `[−4d/h, 6(Δ−d)/h]`. The right end is the left end of the segment traversed backwards with y reflected as well,
/// a decreasing segment the reflection. As (low, high) of the left end, then of the right.
#[inline(always)]
fn intervals(h: f64, delta: f64, d0: f64, d1: f64) -> [f64; 4] {
    let inverse = 1.0 / h;
    let size = delta.abs();
    let interval = |d: f64| {
        let d = d.abs();
        (-4.0 * (d * inverse) * INSIDE, 6.0 * ((size - d) * inverse))
    };
    let (left, right) = (interval(d0), interval(d1));
    let falls = delta < 0.0;
    let flat = is_flat(delta);
    let pick = |rising: f64, falling: f64| {
        let value = if falls { falling } else { rising };
        if flat { 0.0 } else { value }
    };
    [pick(left.0, -left.1), pick(left.1, -left.0), pick(-right.1, right.0), pick(-right.0, right.1)]
}

/// Case 2 of the paper: a slope for which (17) has no non-negative solution is lowered to
/// `(Δᵢ₋₁hᵢ + Δᵢhᵢ₋₁)/(hᵢ₋₁ + hᵢ)` (equation (19)). Also clears slopes at flats. In place, O(N).
pub(crate) fn admissible_slopes(data: &Data, d: &mut [f64]) {
    let n = data.len();
    parts_mut(d, |start, d| {
        // The segments on the left and on the right of every node; at the ends the same.
        let inner = start.max(1)..(start + d.len()).min(n);
        for node in [start, start + d.len() - 1] {
            if !inner.contains(&node) {
                let only = if node == 0 { 0 } else { n - 1 };
                let flat = is_flat(data.delta[only]);
                d[node - start] = if flat { 0.0 } else { d[node - start] };
            }
        }
        if inner.is_empty() {
            return;
        }
        let d = &mut d[inner.start - start..inner.end - start];
        let left = inner.start - 1..inner.end - 1;
        let (h, delta) = (&data.h[left.clone()], &data.delta[left]);
        let (h1, delta1) = (&data.h[inner.clone()], &data.delta[inner]);
        let left = h.iter().zip(delta);
        for (d, ((h0, a), (h1, b))) in d.iter_mut().zip(left.zip(h1.iter().zip(delta1))) {
            let sum = h0 + h1;
            let cap = a * (h1 / sum) + b * (h0 / sum);
            let slope = if d.abs() > cap.abs() { cap } else { *d };
            // A slope of zero stays: at a turn the cap may have either sign.
            let slope = if *d == 0.0 { *d } else { slope };
            *d = if is_flat(*a) | is_flat(*b) { 0.0 } else { slope };
        }
    });
}

/// A node's bounds (zeros without a sign). Case 2 and the turns make the two meet exactly, and a flat beside fixes both at
/// zero; rounding must not make the box empty.
#[inline(always)]
fn bounds(low: f64, high: f64) -> (f64, f64) {
    let met = if low.abs() < high.abs() { low } else { high };
    let empty = low > high;
    (if empty { met } else { low } + 0.0, if empty { met } else { high } + 0.0)
}

/// Whether an entry of the matrix leaves room for its products.
#[inline(always)]
fn in_range(entry: f64) -> bool {
    (entry > 1e-300) & (entry < 1e300)
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
        for (array, size) in [
            (&mut self.diagonal, n + 1),
            (&mut self.off_diagonal, n),
            (&mut self.linear, n + 1),
            (&mut self.lower, n + 1),
            (&mut self.upper, n + 1),
        ] {
            array.resize(size, 0.0);
        }
        // Energy (20) in s, times 35 and the fairness weight: h³ between the two energies.
        let sound = match fairness {
            Fairness::Bending => self.fill_with(h, delta, d, |_| 1.0),
            Fairness::Parametric => self.fill_with(h, delta, d, |h| h * h * h),
        };
        if sound {
            return Ok(());
        }
        let i = h.iter().position(|h| !in_range(h * h * h * h)).unwrap_or(0);
        Err(out_of_range("parametric energy", "x", segments.start + i, h[i]))
    }

    /// A node gets its entries from the segments on both sides: what those before leave is carried from tile to tile.
    /// Whether all energies are in range.
    #[inline(always)]
    fn fill_with(
        &mut self,
        h: &[f64],
        delta: &[f64],
        d: &[f64],
        weight: impl Fn(f64) -> f64,
    ) -> bool {
        /// Segments done together: nothing but arithmetic and selections, from one small array to another.
        const TILE: usize = 64;
        let n = h.len();
        let mut sound = true;
        // Diagonal, linear term and bounds that the segment before node k of the tile leaves to it.
        let mut before = [[0.0; TILE + 1]; 4];
        (before[2][0], before[3][0]) = (f64::NEG_INFINITY, f64::INFINITY);
        for from in (0..n).step_by(TILE) {
            let m = TILE.min(n - from);
            let (h, delta, d) = (&h[from..from + m], &delta[from..from + m], &d[from..=from + m]);
            let off_diagonal = &mut self.off_diagonal[from..from + m];
            let (diagonal, linear) =
                (&mut self.diagonal[from..from + m], &mut self.linear[from..from + m]);
            let (lower, upper) = (&mut self.lower[from..from + m], &mut self.upper[from..from + m]);
            for k in 0..m {
                let (h, delta, d0, d1) = (h[k], delta[k], d[k], d[k + 1]);
                let weight = weight(h);
                let own = 6.0 * weight * h;
                let (e0, e1) = (d0 - delta, d1 - delta);
                sound &= in_range(weight * h);
                off_diagonal[k] = weight * h;
                // Of the segment alone; what the one before leaves is added below.
                diagonal[k] = own;
                linear[k] = weight * (22.0 * e0 + 8.0 * e1);
                let [low0, high0, low1, high1] = intervals(h, delta, d0, d1);
                (lower[k], upper[k]) = (low0, high0);
                before[0][k + 1] = own;
                before[1][k + 1] = -(weight * (8.0 * e0 + 22.0 * e1));
                (before[2][k + 1], before[3][k + 1]) = (low1, high1);
            }
            for k in 0..m {
                diagonal[k] += before[0][k];
                linear[k] += before[1][k];
                (lower[k], upper[k]) =
                    bounds(larger(before[2][k], lower[k]), smaller(before[3][k], upper[k]));
            }
            for array in &mut before {
                array[0] = array[m];
            }
        }
        let [own, slope, low, high] = before.map(|array| array[0]);
        (self.diagonal[n], self.linear[n]) = (own, slope);
        (self.lower[n], self.upper[n]) = bounds(low, high);
        sound
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
