// SPDX-License-Identifier: MIT OR Apache-2.0

//! The C¹ local monotone quartic of the paper: equation (15), conditions (12), (13), theorem 1 and the four cases.

use crate::MonotoneError;
use crate::Slopes;
use crate::data::{Data, PART, Units, check_finite, first};
use crate::extrapolation::Extrapolation;
use crate::spline::{Cached, MonotoneKind, MonotoneSpline};
use shapespline_polynomial::parallel;
use std::ops::Deref;

mod assemble;
mod scale;

use assemble::{Assembled, Assembly};

/// Starting values of the shape parameters, non-negative.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ShapeParameters {
    /// α = β everywhere. With 1 (the default) the curve is the cubic through the ends with their slopes where that is
    /// monotone, so that quadratics and cubics with exact slopes are reproduced, and the error is of order three with
    /// Fritsch and Butland's; the paper starts from 3, which is of order two and bends more.
    Uniform(f64),
    /// One pair a segment.
    Segments {
        /// α of every segment.
        alpha: Vec<f64>,
        /// β of every segment.
        beta: Vec<f64>,
    },
}

impl ShapeParameters {
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

impl Default for ShapeParameters {
    fn default() -> Self {
        Self::Uniform(1.0)
    }
}

/// How a [`MonotoneQuartic`] is made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuarticOptions {
    /// Nodal slopes. [`Slopes::Optimal`] does not exist for the quartic.
    pub slopes: Slopes,
    /// Starting values of α and β.
    pub shape: ShapeParameters,
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
    shape: ShapeParameters,
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
        let units = Units::of(x, y)?;
        let n = x.len() - 1;
        let given = match &options.slopes {
            Slopes::FritschButland => None,
            Slopes::Given(given) => {
                check_length("slopes", given, n + 1)?;
                check_finite("slopes", given)?;
                Some(&given[..])
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
            ShapeParameters::Uniform(a) => check_shape("shape", &[*a])?,
            ShapeParameters::Segments { alpha, beta } => {
                for (argument, values) in [("alpha", alpha), ("beta", beta)] {
                    check_length(argument, values, n)?;
                    check_shape(argument, values)?;
                }
            }
        }
        let assembly = Assembly { x, y, units, given, shape: &options.shape };
        let Assembled { d, e, scale, polynomials, sound } = assembly.make();
        if !sound {
            // A spacing or a secant out of range, or a slope in the data's units: what and where.
            Data::new(x, y)?;
            if let Some(i) = first(&d, |_, d| !units.derivative_out(d, 1).is_finite()) {
                return Err(crate::data::out_of_range("secant slope", "y", i, y[i]));
            }
        }
        let (own_x, own_y) = parallel::both(n >= PART, || x.to_vec(), || y.to_vec());
        let spline = MonotoneSpline {
            x: own_x,
            y: own_y,
            points: None,
            d,
            units,
            kind: MonotoneKind::Quartic { e },
            polynomials,
            extrapolate: options.extrapolate,
            cached: Cached::default(),
        };
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
        let MonotoneKind::Quartic { e } = &self.spline.kind else { return f64::NAN };
        let (x, y) = (self.x(), self.y());
        let mut sum = 0.0;
        for (i, e) in e.iter().enumerate() {
            let h = x[i + 1] - x[i];
            let ([m0, m1], dy) = (self.spline.tangent_rises(i), y[i + 1] - y[i]);
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
