//! Checked data in scaled units, so that nothing over- or underflows on the way to the coefficients.

use crate::MonotoneError;

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

/// Spacings and secants of checked data in units `2^ex` of x and `2^ey` of y, where the mean spacing and the
/// largest step are about one.
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
        check(x, y)?;
        let n = x.len() - 1;
        let ex = exponent((x[n] / n as f64) - (x[0] / n as f64));
        let step = y.windows(2).fold(0.0f64, |a, w| a.max((w[1] - w[0]).abs()));
        let ey = if step > 0.0 { exponent(step) } else { 0 };
        let (to_x, to_y) = (PowerOfTwo::new(-ex), PowerOfTwo::new(-ey));
        let mut h = Vec::with_capacity(n);
        let mut delta = Vec::with_capacity(n);
        for (a, b) in x.windows(2).zip(y.windows(2)) {
            let spacing = to_x.scale(a[1] - a[0]);
            h.push(spacing);
            delta.push(to_y.scale(b[1] - b[0]) / spacing);
        }
        if let Some(index) = delta.iter().position(|d| !(d.abs() < f64::MAX)) {
            return Err(out_of_range("secant slope", "y", index, y[index]));
        }
        // A spacing far below the mean one may vanish in scaled units.
        if let Some(index) = h.iter().position(|h| !(*h > 0.0)) {
            return Err(out_of_range("spacing relative to the mean spacing", "x", index, x[index]));
        }
        Ok(Self { h, delta, ex, ey })
    }

    /// Number of segments.
    pub(crate) fn len(&self) -> usize {
        self.h.len()
    }

    /// Refuse data whose second derivatives would not fit: the programs work with Δ/h and its square.
    pub(crate) fn check_curvature(&self, y: &[f64]) -> Result<(), MonotoneError> {
        for (i, (h, delta)) in self.h.iter().zip(&self.delta).enumerate() {
            let fits = delta.abs() < ROOM && delta.abs() < ROOM * h && 1.0 < ROOM * h && *h < ROOM;
            if !fits {
                return Err(out_of_range("second derivative", "y", i, y[i]));
            }
        }
        Ok(())
    }

    /// Slopes in scaled units to those of the data.
    pub(crate) fn slopes_out(&self, d: &[f64]) -> Vec<f64> {
        let unit = PowerOfTwo::new(self.ey - self.ex);
        d.iter().map(|d| unit.scale(*d)).collect()
    }

    /// Second derivatives in scaled units to those of the data.
    pub(crate) fn seconds_out(&self, s: &[f64]) -> Vec<f64> {
        let (a, b) = (PowerOfTwo::new(self.ey - self.ex), PowerOfTwo::new(-self.ex));
        s.iter().map(|s| b.scale(a.scale(*s))).collect()
    }

    /// Slopes in the data's units to scaled ones.
    pub(crate) fn slopes_in(&self, d: &[f64]) -> Vec<f64> {
        let unit = PowerOfTwo::new(self.ex - self.ey);
        d.iter().map(|d| unit.scale(*d)).collect()
    }

    /// A scaled energy in the data's units: y²/x³ for the bending energy, y² for the parametric one.
    pub(crate) fn energy_out(&self, fairness: crate::energy::Fairness, energy: f64) -> f64 {
        let y = PowerOfTwo::new(self.ey);
        let mut value = y.scale(energy);
        if fairness == crate::energy::Fairness::Bending {
            // Alternate the factors so that only a result out of range leaves the range.
            let x = PowerOfTwo::new(-self.ex);
            value = x.scale(value);
            value = y.scale(value);
            return x.scale(x.scale(value));
        }
        y.scale(value)
    }

    /// A scaled difference of y in the data's units.
    pub(crate) fn y_unit(&self) -> PowerOfTwo {
        PowerOfTwo::new(self.ey)
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

/// Finite, x strictly increasing, at least two points, equal lengths, spreads that fit.
pub(crate) fn check(x: &[f64], y: &[f64]) -> Result<(), MonotoneError> {
    if x.len() < 2 {
        return Err(MonotoneError::TooFew { argument: "x", found: x.len(), needed: 2 });
    }
    if y.len() != x.len() {
        return Err(MonotoneError::Length { argument: "y", found: y.len(), expected: x.len() });
    }
    check_finite("x", x)?;
    check_finite("y", y)?;
    if let Some(i) = x.windows(2).position(|w| !(w[0] < w[1])) {
        return Err(MonotoneError::NotIncreasing { index: i + 1, value: x[i + 1], previous: x[i] });
    }
    let last = x.len() - 1;
    if !(x[last] - x[0]).is_finite() {
        return Err(out_of_range("spread", "x", last, x[last]));
    }
    let (mut low, mut high) = (y[0], y[0]);
    for (i, &value) in y.iter().enumerate() {
        low = low.min(value);
        high = high.max(value);
        // Four times the spread: room for the coefficients around the values.
        if !((high / 4.0 - low / 4.0) < f64::MAX / 16.0) {
            return Err(out_of_range("spread", "y", i, value));
        }
    }
    Ok(())
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
