// SPDX-License-Identifier: MIT OR Apache-2.0

//! One segment as it is evaluated: a cache line of numbers that keeps the ends exact.

use shapespline_polynomial::parallel;

/// `f(t) = y₀ + Δy t + t(t−1) q(2t−1)` with a cubic q: every polynomial of degree five through the two data points.
///
/// The form interpolates structurally, its coefficients are of the size of Δy (power forms about an end have them
/// thirty times larger and lose as many ulps), and evaluation is summed from the nearer end.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C, align(64))]
pub(crate) struct SegmentPolynomial {
    pub(crate) x0: f64,
    pub(crate) h: f64,
    /// At the two ends.
    pub(crate) y: [f64; 2],
    pub(crate) q: [f64; 4],
}

impl SegmentPolynomial {
    /// q from Δy, end slopes `m = h y'` and second derivatives `k = h² y''` in units of y.
    #[inline(always)]
    pub(crate) fn hermite_form(dy: f64, m: [f64; 2], k: [f64; 2]) -> [f64; 4] {
        // Q(0) = Δy − m₀, Q(1) = m₁ − Δy, Q'(0) = Q(0) − k₀/2, Q'(1) = k₁/2 − Q(1); derivatives by z = 2t−1.
        let (p, r) = (dy - m[0], m[1] - dy);
        let (dp, dr) = (0.5 * (p - 0.5 * k[0]), 0.5 * (0.5 * k[1] - r));
        let (even, odd) = (0.25 * (dr - dp), 0.25 * (dr + dp));
        [0.5 * (p + r) - even, 0.75 * (r - p) - odd, even, odd - 0.25 * (r - p)]
    }

    /// The first two of q for a cubic from its second derivatives `k = h² y''` at the ends; the others are 0. They alone
    /// decide it: between close knots the difference of y has few digits.
    #[inline(always)]
    pub(crate) fn cubic_form(k: [f64; 2]) -> [f64; 2] {
        [0.25 * (k[0] + k[1]), (k[1] - k[0]) / 12.0]
    }

    /// The first three of q for the quartic (3) from Δy, end slopes `m = h y'` and `e = ⅔(αm₀ − βm₁)`; the last is 0.
    #[inline(always)]
    pub(crate) fn quartic_form(dy: f64, m: [f64; 2], e: f64) -> [f64; 3] {
        let (p, r) = (dy - m[0], m[1] - dy);
        let middle = -0.25 * (m[0] - m[1] + 1.5 * e);
        [middle, 0.5 * (r - p), 0.5 * (p + r) - middle]
    }

    /// The polynomials of a tile between points, from their q number by number; those after the
    /// last are of no meaning.
    #[inline(always)]
    pub(crate) fn assembled(x: &[f64], y: &[f64], q: &[[f64; TILE]; 4]) -> [Self; TILE] {
        let mut polynomials = [Self::default(); TILE];
        Self::assemble(x, y, q, &mut polynomials);
        polynomials
    }

    /// [`Self::assembled`] where there is room for them already; those after the last stay as they are.
    #[inline(always)]
    pub(crate) fn assemble(
        x: &[f64],
        y: &[f64],
        q: &[[f64; TILE]; 4],
        polynomials: &mut [Self; TILE],
    ) {
        let points = x.windows(2).zip(y.windows(2));
        // Number by number: a polynomial that is made first and moved then is read before it is
        // written out.
        for (j, (polynomial, (x, y))) in polynomials.iter_mut().zip(points).enumerate() {
            polynomial.x0 = x[0];
            polynomial.h = x[1] - x[0];
            polynomial.y[0] = y[0];
            polynomial.y[1] = y[1];
            for k in 0..4 {
                polynomial.q[k] = q[k][j];
            }
        }
    }

    #[inline]
    pub(crate) fn local(&self, x: f64) -> f64 {
        (x - self.x0) / self.h
    }

    /// The polynomial at local t, inside or outside [0, 1].
    #[inline(always)]
    pub(crate) fn raw(&self, t: f64) -> f64 {
        let (z, dy) = (2.0 * t - 1.0, self.y[1] - self.y[0]);
        let [q0, q1, q2, q3] = self.q;
        let q = ((q3 * z + q2) * z + q1) * z + q0;
        let (end, tau) = if t > 0.5 { (self.y[1], t - 1.0) } else { (self.y[0], t) };
        end + (dy * tau + (t * (t - 1.0)) * q)
    }

    /// [`Self::raw`] for t in [0, 1], the same to the last bit.
    #[inline(always)]
    fn inner(&self, t: f64) -> f64 {
        /// Adding it rounds to integers, and leaves them in the lowest bits.
        const MAGIC: f64 = 4_503_599_627_370_496.0;
        let (z, dy) = (2.0 * t - 1.0, self.y[1] - self.y[0]);
        let [q0, q1, q2, q3] = self.q;
        let q = ((q3 * z + q2) * z + q1) * z + q0;
        // The nearer end by rounding, not by a comparison that becomes a branch: it could not be predicted.
        let rounded = t + MAGIC;
        let end = self.y[(rounded.to_bits() & 1) as usize];
        end + (dy * (t - (rounded - MAGIC)) + (t * (t - 1.0)) * q)
    }

    /// The value at local t in [0, 1], kept between the two data values.
    #[inline(always)]
    pub(crate) fn value(&self, t: f64) -> f64 {
        self.between(self.inner(t))
    }

    #[inline(always)]
    fn between(&self, v: f64) -> f64 {
        let [a, b] = self.y;
        let (lo, hi) = (if a < b { a } else { b }, if a < b { b } else { a });
        // Not `clamp`: it panics on NaN bounds, and a comparison passes NaN queries through.
        let v = if v < lo { lo } else { v };
        if v > hi { hi } else { v }
    }

    /// The values at many places of the segment.
    #[inline(always)]
    pub(crate) fn values(&self, x: &[f64], out: &mut [f64]) {
        // Here the ends are loaded once and selected from, for several places at once.
        for (x, out) in x.iter().zip(out) {
            *out = self.between(self.raw(self.local(*x)));
        }
    }

    /// `f(t) − y₀` when t ≤ ½, `f(t) − y₁` otherwise, and df/dt.
    #[inline]
    pub(crate) fn residual_and_slope(&self, t: f64) -> (f64, f64) {
        let z = 2.0 * t - 1.0;
        let [q0, q1, q2, q3] = self.q;
        let q = ((q3 * z + q2) * z + q1) * z + q0;
        let dq = (3.0 * q3 * z + 2.0 * q2) * z + q1;
        let dy = self.y[1] - self.y[0];
        let tau = if t < 0.5 { t } else { t - 1.0 };
        let bubble = t * (t - 1.0);
        (dy * tau + bubble * q, dy + z * q + 2.0 * bubble * dq)
    }
}

/// Segments whose polynomials one item of a parallel loop makes, and items that one thread makes at
/// least.
pub(crate) const TILE: usize = 64;
const TILES: usize = 128;

/// The polynomials of `n` segments, tile by tile: `tile(start, count)` makes those of a tile, and
/// what it will after the first `count`. On all threads where there are many, without the detour
/// over zeros.
#[inline]
pub(crate) fn segment_polynomials(
    n: usize,
    tile: impl Fn(usize, usize) -> [SegmentPolynomial; TILE] + Sync,
) -> Vec<SegmentPolynomial> {
    if n <= TILE {
        // Small fits are many: no more memory than they need.
        return tile(0, n)[..n].to_vec();
    }
    let one = |k: usize| tile(k * TILE, TILE.min(n - k * TILE));
    let count = n.div_ceil(TILE);
    let tiles: Vec<[SegmentPolynomial; TILE]> = parallel::map(count, 2 * TILES + 1, one);
    let mut polynomials = tiles.into_flattened();
    polynomials.truncate(n);
    polynomials
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hermite_data_come_back() {
        let q = SegmentPolynomial::hermite_form(3.0, [0.7, 1.9], [-0.4, 2.2]);
        let r = SegmentPolynomial { x0: 1.0, h: 2.0, y: [2.0, 5.0], q };
        // The residual is measured from the nearer end and jumps by Δy in the middle: differences stay on one side.
        let f = |t: f64| r.raw(t);
        assert_eq!((f(0.0), f(1.0)), (2.0, 5.0));
        assert!((r.residual_and_slope(0.0).1 - 0.7).abs() < 1e-15);
        assert!((r.residual_and_slope(1.0).1 - 1.9).abs() < 1e-15);
        let e = 1e-5;
        let second =
            |t: f64| (r.residual_and_slope(t + e).1 - r.residual_and_slope(t - e).1) / (2.0 * e);
        assert!((second(0.0) + 0.4).abs() < 1e-7 && (second(1.0) - 2.2).abs() < 1e-7);
    }

    #[test]
    fn quartic_matches_its_bernstein_form() {
        let (m, e) = ([0.7, 1.9], 0.35);
        let [q0, q1, q2] = SegmentPolynomial::quartic_form(3.0, m, e);
        let r = SegmentPolynomial { x0: 0.0, h: 1.0, y: [2.0, 5.0], q: [q0, q1, q2, 0.0] };
        let b = [2.0, 2.0 + m[0] / 4.0, 3.5 + e / 4.0, 5.0 - m[1] / 4.0, 5.0];
        for k in 0..=20 {
            let t = f64::from(k) / 20.0;
            let w = shapespline_polynomial::quartic::basis(t);
            let direct: f64 = b.iter().zip(w).map(|(b, w)| b * w).sum();
            assert!((r.raw(t) - direct).abs() < 1e-14);
        }
    }
}
