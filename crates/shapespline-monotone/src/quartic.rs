//! The C¹ local monotone quartic of the paper: equation (15), conditions (12), (13), theorem 1 and the four cases.

use crate::MonotoneError;
use crate::Slopes;
use crate::data::{Data, PART, check_finite, copy, first};
use crate::extrapolation::Extrapolation;
use crate::slopes;
use crate::spline::{Kind, MonotoneSpline};
use rayon::prelude::*;
use std::ops::Deref;

/// Segments whose λ are computed together.
const LANES: usize = 32;
/// λ is lowered by this much below the largest admissible one, so that the derivative stays strictly non-negative
/// after rounding.
const INSIDE: f64 = 1.0 - 1e-12;

/// Starting values of the shape parameters, non-negative.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// α = β everywhere; the paper takes 3.
    Uniform(f64),
    /// One pair a segment.
    Segments {
        /// α of every segment.
        alpha: Vec<f64>,
        /// β of every segment.
        beta: Vec<f64>,
    },
}

impl Shape {
    /// (α, β) of segment i.
    #[inline]
    fn at(&self, i: usize) -> (f64, f64) {
        match self {
            Self::Uniform(a) => (*a, *a),
            // Lengths are checked when fitting; damaged stored data must not panic.
            Self::Segments { alpha, beta } => {
                let entry = |v: &[f64]| v.get(i).copied().unwrap_or(f64::NAN);
                (entry(alpha), entry(beta))
            }
        }
    }
}

impl Default for Shape {
    fn default() -> Self {
        Self::Uniform(3.0)
    }
}

/// How a [`MonotoneQuartic`] is made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuarticOptions {
    /// Nodal slopes. [`Slopes::Optimal`] does not exist for the quartic.
    pub slopes: Slopes,
    /// Starting values of α and β.
    pub shape: Shape,
    /// What it is outside the data.
    pub extrapolate: Extrapolation,
}

/// The C¹ monotone quartic Bézier-like spline (paper 003, equation (15)).
///
/// On every segment the curve (3) with `mᵢ = hᵢdᵢ`; α, β start from [`QuarticOptions::shape`] and are scaled by the
/// largest λ ∈ [0, 1] that leaves the derivative non-negative. Local: a point moves at most four segments. Monotone
/// on every interval where the data are, flat where they are flat; decreasing data give the reflected curve. O(N).
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MonotoneQuartic {
    spline: MonotoneSpline,
    shape: Shape,
    scale: Vec<f64>,
}

impl Deref for MonotoneQuartic {
    type Target = MonotoneSpline;
    fn deref(&self) -> &MonotoneSpline {
        &self.spline
    }
}

impl MonotoneQuartic {
    /// Interpolate `y` at the increasing `x`.
    ///
    /// # Errors
    /// [`MonotoneError`] naming argument, index and value: fewer than two points, lengths that differ, NaN or
    /// infinity, x not increasing, spreads or secants that overflow, a negative shape parameter.
    pub fn new(x: &[f64], y: &[f64], options: &QuarticOptions) -> Result<Self, MonotoneError> {
        let data = Data::new(x, y)?;
        let n = data.len();
        let d = match &options.slopes {
            Slopes::FritschButland => slopes::fritsch_butland(&data),
            Slopes::Given(given) => {
                check_length("slopes", given, n + 1)?;
                check_finite("slopes", given)?;
                slopes::limited(&data, given)
            }
            Slopes::Optimal => {
                return Err(MonotoneError::UnknownOption {
                    argument: "slopes",
                    value: "optimal".to_owned(),
                    expected: "fritsch-butland, an array of slopes",
                });
            }
        };
        match &options.shape {
            Shape::Uniform(a) => check_shape("shape", &[*a])?,
            Shape::Segments { alpha, beta } => {
                for (argument, values) in [("alpha", alpha), ("beta", beta)] {
                    check_length(argument, values, n)?;
                    check_shape(argument, values)?;
                }
            }
        }
        let (mut scale, mut e) = (vec![0.0; n], vec![0.0; n]);
        let part = |(k, (scale, e)): (usize, (&mut [f64], &mut [f64]))| {
            let start = k * PART;
            match &options.shape {
                Shape::Uniform(a) => segments(&data, &d, start, |_| (*a, *a), scale, e),
                Shape::Segments { .. } => {
                    segments(&data, &d, start, |i| options.shape.at(i), scale, e);
                }
            }
        };
        if n < 2 * PART {
            part((0, (&mut scale, &mut e)));
        } else {
            let parts = scale.par_chunks_mut(PART).zip(e.par_chunks_mut(PART));
            parts.enumerate().for_each(part);
        }
        let units = data.units();
        drop(data);
        let spline = MonotoneSpline::quartic(units, copy(x), copy(y), d, e, options.extrapolate);
        if let Some(i) = first(&spline.d, |_, d| !d.is_finite()) {
            return Err(crate::data::out_of_range("secant slope", "y", i, y[i]));
        }
        Ok(Self { spline, shape: options.shape.clone(), scale })
    }

    /// α of every segment, after scaling.
    #[must_use]
    pub fn alpha(&self) -> Vec<f64> {
        self.scale.iter().enumerate().map(|(i, l)| l * self.shape.at(i).0).collect()
    }

    /// β of every segment, after scaling.
    #[must_use]
    pub fn beta(&self) -> Vec<f64> {
        self.scale.iter().enumerate().map(|(i, l)| l * self.shape.at(i).1).collect()
    }

    /// λ of every segment: 1 where the starting values were kept.
    #[must_use]
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }

    /// The interpolant without its shape parameters.
    #[must_use]
    pub fn spline(&self) -> &MonotoneSpline {
        &self.spline
    }

    /// `∫ f''² dx`; +∞ if it overflows. O(N).
    #[must_use]
    pub fn bending_energy(&self) -> f64 {
        let Kind::Quartic { e } = &self.spline.kind else { return f64::NAN };
        let (x, y, d) = (self.x(), self.y(), self.slopes());
        let mut sum = 0.0;
        for (i, e) in e.iter().enumerate() {
            let h = x[i + 1] - x[i];
            let (m0, m1, dy) = (h * d[i], h * d[i + 1], y[i + 1] - y[i]);
            // Second derivative's Bernstein coefficients 3(B−A), 3(C−B), 3(D−C), over h².
            let a = 3.0 * (2.0 * (dy - m0) + e);
            let b = 3.0 * (m0 - m1 - 2.0 * e);
            let c = 3.0 * (2.0 * (m1 - dy) + e);
            let size = a.abs().max(b.abs()).max(c.abs());
            if size == 0.0 {
                continue;
            }
            // In units of the largest: squares that overflow have opposite signs.
            let (a, b, c) = (a / size, b / size, c / size);
            let mean =
                (6.0 * (a * a + c * c) + 6.0 * b * (a + c) + 2.0 * a * c + 4.0 * b * b) / 30.0;
            sum += mean * (size / h) * (size / h) / h;
        }
        sum
    }
}

fn check_length(
    argument: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), MonotoneError> {
    if values.len() == expected {
        Ok(())
    } else {
        Err(MonotoneError::Length { argument, found: values.len(), expected })
    }
}

/// The largest shape parameter: its product with a slope of up to twice the secant must not overflow.
const LARGEST_SHAPE: f64 = 1e300;

fn check_shape(argument: &'static str, values: &[f64]) -> Result<(), MonotoneError> {
    match values.iter().position(|v| !(0.0..=LARGEST_SHAPE).contains(v)) {
        Some(index) => Err(MonotoneError::Shape { argument, index, value: values[index] }),
        None => Ok(()),
    }
}

/// λ and e (scaled) of the segments from `start` on.
#[inline(always)]
fn segments(
    data: &Data,
    d: &[f64],
    start: usize,
    shape: impl Fn(usize) -> (f64, f64),
    scale: &mut [f64],
    e: &mut [f64],
) {
    let n = scale.len().min(e.len());
    let (h, delta) = (&data.h[start..start + n], &data.delta[start..start + n]);
    let (left, right) = (&d[start..start + n], &d[start + 1..=start + n]);
    // Nothing but arithmetic and selections, from one small array to another: done for several segments at once.
    for from in (0..n).step_by(LANES) {
        let lanes = LANES.min(n - from);
        let (mut m0, mut m1, mut full) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for j in 0..lanes {
            let secant = delta[from + j];
            let (alpha, beta) = shape(start + from + j);
            // In units of the secant everything is of order one.
            let secant = if secant == 0.0 { 1.0 } else { secant };
            (m0[j], m1[j]) = (left[from + j] / secant, right[from + j] / secant);
            full[j] = 2.0 / 3.0 * (alpha * m0[j] - beta * m1[j]);
        }
        // Those whose conditions (12), (13) fail, listed without a branch: which they are cannot be predicted.
        let (mut failing, mut count) = ([0; LANES], 0);
        for j in 0..lanes {
            failing[count] = j;
            count += usize::from(!keeps(m0[j], m1[j], full[j]));
        }
        let mut lambda = [1.0; LANES];
        for &j in &failing[..count] {
            lambda[j] = largest_scale(m0[j], m1[j], full[j]);
        }
        // Flat segments have slopes and e of zero, and a λ of one, as they are.
        for j in 0..lanes {
            scale[from + j] = lambda[j];
            e[from + j] = lambda[j] * full[j] * (delta[from + j] * h[from + j]);
        }
    }
}

/// Conditions (12), (13): whether the full e leaves both inner coefficients of the derivative non-negative. Both
/// cannot fail: their sum is 4 − a − d ≥ 0.
#[inline(always)]
fn keeps(a: f64, d: f64, full: f64) -> bool {
    (2.0 - a + full >= 0.0) & (2.0 - d - full >= 0.0)
}

/// The largest λ ∈ [0, 1] for which the derivative (4) with `e = λ full` is non-negative on [0, 1]; `a`, `d` are
/// the end slopes over the secant, in [0, 2].
///
/// The admissible e form an interval around 0 (non-negativity is an intersection of half-planes), so the boundary in
/// one direction is a single point: there the derivative has a double root at some σ = t/(1−t), and with the
/// coefficients a, 3B, 3C, d in powers of s it is `d(s − σ)²(s + a/(dσ²))`. Hence `3C = a/σ² − 2dσ`, and B + C =
/// 4 − a − d = K leaves `dσ⁴ − 2dσ³ − 3Kσ² − 2aσ + a = 0`. Its signs + − − − + allow two positive roots, and at 1 it is
/// negative: one root below 1 (where the other coefficient fails, by symmetry the same case) and one above, which is
/// wanted. There the quartic rises and is convex, so that Newton's iteration finds it and no other. Φ of theorem 1 is
/// the discriminant of the same cubic, with roots that mean nothing besides.
#[inline(always)]
fn largest_scale(a: f64, d: f64, full: f64) -> f64 {
    let kept = keeps(a, d, full);
    // By symmetry (t ↔ 1 − t) let it be C that fails, at e > 0.
    let turn = 2.0 - a + full < 0.0;
    let (near, far) = (if turn { d } else { a }, if turn { a } else { d });
    let full = if turn { -full } else { full };
    let room = 2.0 - far;
    let k = 4.0 - a - d;
    let k = if k > 0.0 { 3.0 * k } else { 0.0 };
    let (a, d) = (near, far);
    // σ(σ − 2) = (3K + 2a/σ − a/σ²)/d ≤ (3K + a)/d, for the root is at least 2; and once more with the bound inserted:
    // now within 0.5 %, whatever a and d, and three of Newton's steps make that less than rounding.
    let inverse = 1.0 / d;
    let bound = 1.0 / (1.0 + (1.0 + (k + a) * inverse).sqrt());
    let mut sigma = 1.0 + (1.0 + (k + a * bound * (2.0 - bound)) * inverse).sqrt();
    for _ in 0..3 {
        let value = ((d * sigma - 2.0 * d) * sigma - k) * (sigma * sigma) - a * (2.0 * sigma - 1.0);
        let slope = ((4.0 * d * sigma - 6.0 * d) * sigma - 2.0 * k) * sigma - 2.0 * a;
        sigma -= value / slope;
    }
    let least = room + (2.0 * d * sigma - a / (sigma * sigma)) / 3.0;
    // Case 3 (D = 0): C ≥ 0 itself is necessary. So it is for a D that is nothing beside the other numbers.
    let least = if d < 1e-300 { room } else { least };
    let lambda = least * INSIDE / full;
    let lambda = if lambda < 1.0 { lambda } else { 1.0 };
    if kept { 1.0 } else { lambda }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quartic_form::least;

    /// The derivative (4) elevated to a quartic, so that the exact minimum of quartics can judge it.
    fn elevated(a: f64, d: f64, e: f64) -> [f64; 5] {
        let (b, c) = (2.0 - a + e, 2.0 - d - e);
        [a, (a + 3.0 * b) / 4.0, (b + c) / 2.0, (3.0 * c + d) / 4.0, d]
    }

    #[test]
    fn lambda_is_admissible_and_the_largest() {
        let grid = [0.0, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1.0, 1.3, 1.7, 1.999, 2.0];
        let mut scaled = 0;
        for a in grid {
            for d in grid {
                for alpha in [0.0, 0.5, 1.0, 3.0, 8.0, 20.0, 1e3] {
                    for beta in [0.0, 0.5, 1.0, 3.0, 8.0, 20.0, 1e3] {
                        let full = 2.0 / 3.0 * (alpha * a - beta * d);
                        let lambda = largest_scale(a, d, full);
                        assert!((0.0..=1.0).contains(&lambda));
                        let size = 1.0 + (lambda * full).abs();
                        let here = least(&elevated(a, d, lambda * full));
                        assert!(here >= -1e-13 * size, "{a} {d} {alpha} {beta}: {here:e}");
                        if lambda < 1.0 {
                            scaled += 1;
                            let beyond = (lambda * (1.0 + 1e-5)).min(1.0) * full;
                            let there = least(&elevated(a, d, beyond));
                            assert!(there < 0.0, "{a} {d} {alpha} {beta} λ {lambda}: {there:e}");
                        }
                    }
                }
            }
        }
        assert!(scaled > 1000);
    }
}
