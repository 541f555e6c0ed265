//! How parameters are chosen from points.

use glam::DVec3;

use crate::{InputError, vector::length};

/// Choice of the parameters `u_0 < … < u_N` of the points.
#[derive(Debug, Clone, PartialEq)]
pub enum Parametrization {
    /// `u_i = i`.
    Uniform,
    /// `u_{i+1} − u_i = ‖L_i‖`, the chord length.
    Chordal,
    /// `u_{i+1} − u_i = √‖L_i‖`.
    Centripetal,
    /// `u_{i+1} − u_i = ‖L_i‖^e` for a finite exponent `e` (0 uniform, ½ centripetal, 1 chordal).
    Exponent(f64),
    /// The parameters themselves, strictly increasing, one a point.
    Given(Vec<f64>),
}

impl Parametrization {
    /// Parameters of `points`.
    ///
    /// # Errors
    /// Repeated neighbouring points (where the choice depends on chords), a non-finite exponent,
    /// given parameters that are not finite, not strictly increasing or not one a point, and
    /// chords so long or short that the parameters leave the range of f64.
    pub fn parameters(&self, points: &[DVec3]) -> Result<Vec<f64>, InputError> {
        match self {
            Self::Uniform => Ok((0..points.len()).map(|i| i as f64).collect()),
            Self::Chordal => accumulate(points, |l| l),
            Self::Centripetal => accumulate(points, f64::sqrt),
            Self::Exponent(e) if e.is_finite() => accumulate(points, |l| l.powf(*e)),
            Self::Exponent(e) => Err(InputError::Scalar {
                argument: "parameters",
                value: *e,
                allowed: "a finite exponent",
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
        check_reciprocal(argument, i + 1, spacing)?;
    }
    Ok(())
}

/// Evaluation multiplies by the reciprocal of a spacing, which below 5.6e−309 is infinite.
fn check_reciprocal(argument: &'static str, index: usize, spacing: f64) -> Result<(), InputError> {
    if (1.0 / spacing).is_finite() {
        Ok(())
    } else {
        Err(InputError::TooClose { argument, index, spacing })
    }
}

fn accumulate(points: &[DVec3], spacing: impl Fn(f64) -> f64) -> Result<Vec<f64>, InputError> {
    let mut u = Vec::with_capacity(points.len());
    let mut sum = 0.0;
    u.push(sum);
    for (i, pair) in points.windows(2).enumerate() {
        let next = sum + spacing(length(pair[1] - pair[0]));
        if !next.is_finite() {
            return Err(InputError::Overflow { index: i, what: "its parameter", value: next });
        }
        if next <= sum {
            // Equal points, or a chord lost to rounding beside the length so far.
            if pair[0] == pair[1] {
                return Err(InputError::RepeatedPoint { index: i + 1, value: pair[1] });
            }
            let index = i + 1;
            let (previous, value) = (sum, next);
            return Err(InputError::NotIncreasing {
                argument: "parameters",
                index,
                previous,
                value,
            });
        }
        check_reciprocal("parameters", i + 1, next - sum)?;
        sum = next;
        u.push(sum);
    }
    Ok(u)
}
