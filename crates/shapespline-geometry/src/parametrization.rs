// SPDX-License-Identifier: MIT OR Apache-2.0

//! How parameters are chosen from points.

use glam::DVec3;
use shapespline_polynomial::parallel;

use crate::{
    Coordinates, Dimension, InputError,
    vector::{is_ordinary, length},
};

/// Choice of the parameters `u_0 < … < u_N` of the points.
#[derive(Debug, Clone, PartialEq)]
pub enum Parametrization {
    /// `u_i = i`.
    Uniform,
    /// `u_{i+1} − u_i = ‖L_i‖`, the chord length.
    Chordal,
    /// `u_{i+1} − u_i = √‖L_i‖`.
    Centripetal,
    /// `u_{i+1} − u_i = ‖L_i‖^e` for an exponent `e` between 0 and 1 (0 uniform, ½ centripetal, 1
    /// chordal).
    Exponent(f64),
    /// The parameters themselves, strictly increasing, one a point.
    Given(Vec<f64>),
}

impl Parametrization {
    /// Parameters of `points`.
    ///
    /// # Errors
    /// Repeated neighbouring points (where the choice depends on chords), an exponent out of range,
    /// given parameters that are not finite, not strictly increasing or not one a point, and
    /// chords so long or short that the parameters leave the range of f64.
    pub fn parameters(&self, points: &[DVec3]) -> Result<Vec<f64>, InputError> {
        match self {
            Self::Uniform => Ok((0..points.len()).map(|i| i as f64).collect()),
            Self::Chordal => accumulate(points, |l| l),
            Self::Centripetal => accumulate(points, f64::sqrt),
            Self::Exponent(e) if (0.0..=1.0).contains(e) => accumulate(points, |l| l.powf(*e)),
            Self::Exponent(e) => Err(InputError::Scalar {
                argument: "parameters",
                value: *e,
                allowed: "an exponent between 0 and 1",
            }),
            Self::Given(u) => {
                if u.len() != points.len() {
                    return Err(InputError::Length {
                        argument: "parameters",
                        expected: points.len(),
                        found: u.len(),
                        per: "one for each point",
                    });
                }
                check_increasing("parameters", u)?;
                Ok(u.clone())
            }
        }
    }
}

/// Checks that every value is finite and exceeds the one before it by an amount that is finite and has a
/// finite reciprocal.
pub(crate) fn check_increasing(argument: &'static str, u: &[f64]) -> Result<(), InputError> {
    if let Some(index) = u.iter().position(|v| !v.is_finite()) {
        return Err(InputError::NotFinite { argument, index, value: u[index] });
    }
    for (i, w) in u.windows(2).enumerate() {
        if w[1] <= w[0] {
            let (previous, value) = (w[0], w[1]);
            return Err(InputError::NotIncreasing { argument, index: i + 1, previous, value });
        }
        let spacing = w[1] - w[0];
        if spacing.is_infinite() {
            return Err(InputError::Overflow { index: i, what: "the spacing", value: spacing });
        }
        if spacing < LEAST {
            return Err(InputError::TooClose { argument, index: i + 1, spacing });
        }
    }
    Ok(())
}

/// The least spacing: evaluation multiplies by its reciprocal, which must be finite.
const LEAST: f64 = 5.6e-309;

/// Chords from which on their lengths are taken on all threads.
const MANY: usize = 32_768;

fn accumulate(
    points: &[DVec3],
    spacing: impl Fn(f64) -> f64 + Sync,
) -> Result<Vec<f64>, InputError> {
    let steps = |points: &[DVec3], steps: &mut [f64]| {
        let mut far = 0;
        for (p, step) in points.windows(2).zip(&mut *steps) {
            let chord = p[1] - p[0];
            *step = spacing(chord.length());
            far += u64::from(!is_ordinary(chord));
        }
        if far > 0 {
            for (p, step) in points.windows(2).zip(steps) {
                *step = spacing(length(p[1] - p[0]));
            }
        }
    };
    let mut u = vec![0.0; points.len()];
    let Some((_, rest)) = u.split_first_mut() else { return Ok(u) };
    let part =
        |(): &mut (), start: usize, u: &mut [f64]| steps(&points[start..=start + u.len()], u);
    parallel::parts::<_, _, _, ()>(rest, MANY / 4, MANY, || (), part);
    let mut sum = 0.0;
    for i in 1..u.len() {
        let next = sum + u[i];
        // Written so that a NaN fails.
        if !(next - sum >= LEAST && next < f64::INFINITY) {
            return Err(bad_spacing(points, i, sum, next));
        }
        sum = next;
        u[i] = sum;
    }
    Ok(u)
}

/// What is wrong with the parameter of point `index`, which should be finite and exceed that before by
/// something.
fn bad_spacing(points: &[DVec3], index: usize, previous: f64, value: f64) -> InputError {
    if !value.is_finite() {
        InputError::Overflow { index: index - 1, what: "its parameter", value }
    } else if points[index - 1] == points[index] {
        let value = Coordinates { vector: points[index], dimension: Dimension::Three };
        InputError::RepeatedPoint { index, value }
    } else {
        // Of zero where a chord is lost to rounding beside the length so far.
        InputError::TooClose { argument: "parameters", index, spacing: value - previous }
    }
}
