// SPDX-License-Identifier: MIT OR Apache-2.0

//! Lengths and directions that neither overflow nor underflow.

use glam::DVec3;

/// Largest components between which squares, and sums of three of them, are safe.
const SAFE: std::ops::Range<f64> = 1e-140..1e140;

/// Euclidean length `‖v‖`, for components of any magnitude.
#[inline]
#[must_use]
pub fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if SAFE.contains(&largest) {
        v.length()
    } else if largest == 0.0 || !largest.is_finite() {
        largest
    } else {
        let scale = power_of_two(largest);
        // Two steps, for the reciprocal of a subnormal is not finite.
        (v / scale).length() * scale
    }
}

/// Unit vector along `v`, or zero when `v` is zero.
#[inline]
#[must_use]
pub fn normalize(v: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    if SAFE.contains(&largest) {
        v / v.length()
    } else if largest == 0.0 || !largest.is_finite() {
        DVec3::ZERO
    } else {
        let scaled = v / power_of_two(largest);
        scaled / scaled.length()
    }
}

/// Legs and chord of a segment, scaled so that products of them neither overflow nor underflow.
#[inline]
#[must_use]
pub fn normalized_scale([a, c]: [DVec3; 2], chord: DVec3) -> ([DVec3; 2], DVec3) {
    let size = chord.abs().max_element();
    if (1e-40..1e40).contains(&size) {
        ([a, c], chord)
    } else {
        ([a / size, c / size], chord / size)
    }
}

/// The length below which vectors are ordinary.
pub(crate) const ORDINARY: f64 = 1e39;

/// Whether a vector is finite, not zero, and of a size for which [`length`], [`normalize`] and
/// [`normalized_scale`] need no care. No branch: for loops that look for others among many.
#[inline(always)]
pub(crate) fn is_ordinary(v: DVec3) -> bool {
    let square = v.length_squared();
    (square > 1.0 / (ORDINARY * ORDINARY)) & (square < ORDINARY * ORDINARY)
}

/// The power of two just below a positive finite number (the least normal one for subnormals):
/// dividing by it brings the number near one without rounding.
#[inline]
#[must_use]
pub(crate) fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(x.to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn length_and_direction_at_every_magnitude() {
        for exponent in [-320, -300, -200, -100, 0, 100, 200, 300] {
            let s: f64 = format!("1e{exponent}").parse().unwrap();
            let v = DVec3::new(3.0 * s, -4.0 * s, 12.0 * s);
            let tolerance = if exponent < -308 { 1e-2 } else { 1e-14 };
            assert!((length(v) / (13.0 * s) - 1.0).abs() < tolerance, "1e{exponent}");
            let expected = DVec3::new(3.0, -4.0, 12.0) / 13.0;
            assert!((normalize(v) - expected).length() < tolerance, "1e{exponent}");
        }
        assert_eq!(length(DVec3::ZERO), 0.0);
        assert_eq!(normalize(DVec3::ZERO), DVec3::ZERO);
    }
}
