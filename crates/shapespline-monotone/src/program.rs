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
