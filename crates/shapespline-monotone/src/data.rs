// SPDX-License-Identifier: MIT OR Apache-2.0

//! Checked data in scaled units, so that nothing over- or underflows on the way to the coefficients.

use crate::MonotoneError;
use shapespline_polynomial::parallel;
use std::ops::Range;

/// Numbers from which passes over the data are shared out over threads, in parts of this size.
pub(crate) const PART: usize = 1 << 14;
/// Numbers that are worth several threads.
pub(crate) const LONG: usize = 2 * PART;
/// Quantities beyond this in scaled units leave no room for the products of the programs.
const ROOM: f64 = 1e140;

/// A power of two as two factors: exact, and together they reach beyond the range of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PowerOfTwo(f64, f64);

impl PowerOfTwo {
    pub(crate) fn new(exponent: i32) -> Self {
        let exponent = exponent.clamp(-2044, 2046);
        let half = exponent / 2;
        let bits = |e: i32| f64::from_bits(((1023 + i64::from(e)) as u64) << 52);
        Self(bits(half), bits(exponent - half))
    }
    #[inline]
    pub(crate) fn scale(self, value: f64) -> f64 {
        value * self.0 * self.1
    }
}

/// The binary exponent of a finite number that is not negative: subnormals included, and for zero (a mean of
/// subnormals can round to it) that of the least.
pub(crate) fn exponent(value: f64) -> i32 {
    let bits = ((value.to_bits() >> 52) & 0x7ff) as i32;
    if value == 0.0 {
        -1074
    } else if bits == 0 {
        exponent(value * f64::from_bits(0x4350_0000_0000_0000)) - 54
    } else {
        bits - 1023
    }
}

/// The units of scaled quantities: `2^ex` of x and `2^ey` of y, in which the mean spacing and the largest step are
/// about one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub(crate) ex: i32,
    pub(crate) ey: i32,
}

impl Units {
    /// Check the data and choose units. O(N).
    pub(crate) fn of(x: &[f64], y: &[f64]) -> Result<Self, MonotoneError> {
        let step = check(x, y)?;
        let n = x.len() - 1;
        let ex = exponent((x[n] / n as f64) - (x[0] / n as f64));
        let ey = if step > 0.0 { exponent(step) } else { 0 };
        Ok(Self { ex, ey })
    }

    /// A spacing of x in scaled units.
    pub(crate) fn spacing(self) -> PowerOfTwo {
        PowerOfTwo::new(-self.ex)
    }

    /// Spacings and secants of the segments between the points given, scaled.
    #[inline(always)]
    pub(crate) fn differences(self, x: &[f64], y: &[f64], h: &mut [f64], delta: &mut [f64]) {
        let (to_x, to_y) = (self.spacing(), self.rise());
        let n = h.len();
        let (x, y, delta) = (&x[..n + 1], &y[..n + 1], &mut delta[..n]);
        for i in 0..n {
            h[i] = to_x.scale(x[i + 1] - x[i]);
            delta[i] = to_y.scale(y[i + 1] - y[i]) / h[i];
        }
    }

    /// A scaled difference of y in the data's units.
    pub(crate) fn y(self) -> PowerOfTwo {
        PowerOfTwo::new(self.ey)
    }

    /// A scaled slope in the data's units.
    pub(crate) fn slope(self) -> PowerOfTwo {
        PowerOfTwo::new(self.ey - self.ex)
    }

    /// A difference of y of the data's units in scaled ones.
    pub(crate) fn rise(self) -> PowerOfTwo {
        PowerOfTwo::new(-self.ey)
    }

    /// A scaled difference of x in the data's units.
    pub(crate) fn x(self) -> PowerOfTwo {
        PowerOfTwo::new(self.ex)
    }

    /// A scaled derivative of order `nu` ≥ 1 in the data's units.
    pub(crate) fn derivative_out(self, value: f64, nu: usize) -> f64 {
        (1..nu).fold(self.slope().scale(value), |v, _| self.spacing().scale(v))
    }

    /// [`Self::derivative_out`] of many.
    pub(crate) fn derivatives_out(self, scaled: &[f64], nu: usize) -> Vec<f64> {
        let (slope, x) = (self.slope(), self.spacing());
        scaled.iter().map(|v| (1..nu).fold(slope.scale(*v), |v, _| x.scale(v))).collect()
    }
}

/// The first entry with a property (of its index and value).
pub(crate) fn first(values: &[f64], property: impl Fn(usize, f64) -> bool + Sync) -> Option<usize> {
    // Every one is looked at: a loop that may end early is not done several numbers at once.
    let any = |part: Range<usize>| {
        let start = part.start;
        let values = values[part].iter().enumerate();
        values.fold(false, |any, (i, v)| any | property(start + i, *v))
    };
    let found = parallel::fold(values.len(), PART, any, |a, b| a | b);
    if found { (0..values.len()).find(|&i| property(i, values[i])) } else { None }
}

/// `of` every part of `0..n`, in order; on all threads where there are many.
pub(crate) fn parts<T: Send>(n: usize, of: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    parallel::blocks(n, PART, of)
}

/// Parts one after another, and room for some entries more, which are zero. Copied on all threads where they are many:
/// most of the time goes into fresh memory.
pub(crate) fn joined<T: Copy + Default + Send + Sync>(parts: &[&[T]], more: usize) -> Vec<T> {
    let total: usize = parts.iter().map(|part| part.len()).sum();
    let mut all = vec![T::default(); total + more];
    let mut rest = &mut all[..];
    let mut pairs: Vec<(&mut [T], &[T])> = Vec::with_capacity(parts.len());
    for part in parts {
        let (own, behind) = rest.split_at_mut(part.len());
        pairs.push((own, *part));
        rest = behind;
    }
    let many = if total < LONG { usize::MAX } else { 0 };
    parallel::fill(&mut pairs, many, |_, (own, part)| own.copy_from_slice(part));
    all
}

/// `by` every part of the numbers (with its start), on all threads where there are many.
pub(crate) fn parts_mut(values: &mut [f64], by: impl Fn(usize, &mut [f64]) + Sync) {
    let part = |(): &mut (), start: usize, values: &mut [f64]| by(start, values);
    parallel::parts::<_, _, _, ()>(values, PART, LONG, || (), part);
}

/// Spacings and secants of checked data in scaled units.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    /// hᵢ = xᵢ₊₁ − xᵢ, scaled.
    pub(crate) h: Vec<f64>,
    /// Δᵢ = (yᵢ₊₁ − yᵢ)/hᵢ, scaled; signed.
    pub(crate) delta: Vec<f64>,
    pub(crate) ex: i32,
    pub(crate) ey: i32,
}

impl Data {
    /// Check the data and take their differences. O(N).
    pub(crate) fn new(x: &[f64], y: &[f64]) -> Result<Self, MonotoneError> {
        let units = Units::of(x, y)?;
        let n = x.len() - 1;
        let (mut h, mut delta) = (vec![0.0; n], vec![0.0; n]);
        let part = |(): &mut (), start: usize, (h, delta): (&mut [f64], &mut [f64])| {
            let own = start..=start + h.len();
            units.differences(&x[own.clone()], &y[own], h, delta);
        };
        let both = (&mut *h, &mut *delta);
        parallel::parts::<_, _, _, ()>(both, PART, LONG, || (), part);
        if let Some(i) = first(&delta, |_, d| !(d.abs() < f64::MAX)) {
            return Err(out_of_range("secant slope", "y", i, y[i]));
        }
        // A spacing far below the mean one may vanish in scaled units.
        if let Some(i) = first(&h, |_, h| !(h > 0.0)) {
            return Err(out_of_range("spacing relative to the mean spacing", "x", i, x[i]));
        }
        Ok(Self { h, delta, ex: units.ex, ey: units.ey })
    }

    pub(crate) fn units(&self) -> Units {
        Units { ex: self.ex, ey: self.ey }
    }

    /// Number of segments.
    pub(crate) fn len(&self) -> usize {
        self.h.len()
    }

    /// Refuse data whose second derivatives would not fit: the programs work with Δ/h and its square.
    pub(crate) fn check_curvature(&self, y: &[f64]) -> Result<(), MonotoneError> {
        let beyond = |i: usize, h: f64| {
            let size = self.delta[i].abs();
            !((size < ROOM) & (size < ROOM * h) & (1.0 < ROOM * h) & (h < ROOM))
        };
        match first(&self.h, beyond) {
            Some(i) => Err(out_of_range("second derivative", "y", i, y[i])),
            None => Ok(()),
        }
    }

    /// Slopes in the data's units to scaled ones.
    pub(crate) fn slopes_in(&self, d: &[f64]) -> Vec<f64> {
        let unit = PowerOfTwo::new(self.ex - self.ey);
        d.iter().map(|d| unit.scale(*d)).collect()
    }
}

pub(crate) fn out_of_range(
    quantity: &'static str,
    argument: &'static str,
    index: usize,
    value: f64,
) -> MonotoneError {
    MonotoneError::OutOfRange { quantity, argument, index, value }
}

/// Finite, x strictly increasing, at least two points, equal lengths, spreads that fit; the largest step of y.
pub(crate) fn check(x: &[f64], y: &[f64]) -> Result<f64, MonotoneError> {
    if x.len() < 2 {
        return Err(MonotoneError::TooFew { argument: "x", found: x.len(), needed: 2 });
    }
    if y.len() != x.len() {
        return Err(MonotoneError::Length { argument: "y", found: y.len(), expected: x.len() });
    }
    let n = x.len() - 1;
    let part = |part: Range<usize>| {
        let own = part.start..=part.end;
        Survey::of(&x[own.clone()], &y[own])
    };
    let survey = parallel::fold(n, PART, part, Survey::and);
    // Room for second derivatives: h²f'' of a monotone quintic is up to sixty times the step of y.
    let fits = |low: f64, high: f64| high / 4.0 - low / 4.0 < f64::MAX / 256.0;
    let spread = (x[n] - x[0]).is_finite() && fits(survey.low, survey.high);
    if survey.finite && survey.increasing && spread {
        return Ok(survey.step);
    }
    // Something is wrong: what and where.
    check_finite("x", x)?;
    check_finite("y", y)?;
    if let Some(i) = x.windows(2).position(|w| !(w[0] < w[1])) {
        return Err(MonotoneError::NotIncreasing { index: i + 1, value: x[i + 1], previous: x[i] });
    }
    if !(x[n] - x[0]).is_finite() {
        return Err(out_of_range("spread", "x", n, x[n]));
    }
    let (mut low, mut high) = (y[0], y[0]);
    let beyond = y.iter().position(|&value| {
        (low, high) = (low.min(value), high.max(value));
        !fits(low, high)
    });
    match beyond {
        Some(i) => Err(out_of_range("spread", "y", i, y[i])),
        None => Ok(survey.step),
    }
}

/// What one pass over (a part of) the data tells.
#[derive(Debug, Clone, Copy)]
struct Survey {
    finite: bool,
    increasing: bool,
    low: f64,
    high: f64,
    step: f64,
}

impl Default for Survey {
    fn default() -> Self {
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { finite: true, increasing: true, low, high, step: 0.0 }
    }
}

impl Survey {
    fn of(x: &[f64], y: &[f64]) -> Self {
        let mut s = Self::default();
        // The sum of v·0 is NaN exactly when an entry is not finite. Plain selections throughout: they are done
        // several numbers at once, where `f64::min` and searches are not.
        let zero: f64 = x.iter().zip(y).fold(0.0, |sum, (x, y)| sum + (x * 0.0 + y * 0.0));
        s.finite = zero == 0.0;
        s.increasing = x.windows(2).fold(true, |all, w| all & (w[0] < w[1]));
        for &v in y {
            s.low = if v < s.low { v } else { s.low };
            s.high = if v > s.high { v } else { s.high };
        }
        for w in y.windows(2) {
            let step = (w[1] - w[0]).abs();
            s.step = if step > s.step { step } else { s.step };
        }
        s
    }

    fn and(self, other: Self) -> Self {
        Self {
            finite: self.finite && other.finite,
            increasing: self.increasing && other.increasing,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            step: self.step.max(other.step),
        }
    }
}

/// Every entry finite, or the first that is not.
pub(crate) fn check_finite(argument: &'static str, values: &[f64]) -> Result<(), MonotoneError> {
    // The sum of x·0 is NaN exactly when an entry is not finite; it vectorises where a search does not.
    let clean: f64 = values.iter().map(|v| v * 0.0).sum();
    if clean == 0.0 {
        return Ok(());
    }
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(MonotoneError::NotFinite { argument, index, value: values[index] }),
        None => Ok(()),
    }
}
