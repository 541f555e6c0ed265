// SPDX-License-Identifier: MIT OR Apache-2.0

//! The least energy of one interval, as a function of the slopes at its ends: closed forms.
//!
//! In the direction of the data: width `h`, rise `d > 0`, secant `δ = d/h`, slopes `m₀, m₁ ≥ 0` with roots `r₀, r₁`,
//! second derivative `z`. The monotone function of least `∫ y''² dx` is one cubic while its slope stays positive
//! (`m₀ + m₁ − r₀r₁ < 3δ`), and a parabola of slope falling to 0, a level part and a parabola of slope rising from 0
//! beyond. The two forms meet with equal values and gradients; the energy is convex in `(m₀, m₁, d)` jointly.

/// A root below which slopes count as 0 in quotients: nothing of the size of its square is seen.
const TINY_ROOT: f64 = 1e-160;

/// One interval's energy in the slopes at its ends.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Piece {
    pub(crate) energy: f64,
    /// `∂E/∂m₀, ∂E/∂m₁`: `−2z₀` and `2z₁`.
    pub(crate) gradient: [f64; 2],
    /// `∂²E`: 00, 01, 11.
    pub(crate) hessian: [f64; 3],
    /// Of the diagonal of the Hessian the part that grows as a slope goes to 0: `(2/3)·S_other/(d r)`, where there is
    /// a level part.
    pub(crate) singular: [f64; 2],
    /// And the part that grows with the slope: `(8/3) m/d`.
    pub(crate) growing: [f64; 2],
    /// Whether there is a level part.
    pub(crate) level: bool,
}

impl Piece {
    /// Of an interval with end slopes `m`.
    #[inline(always)]
    pub(crate) fn new(m: [f64; 2], d: f64, h: f64) -> Self {
        let (delta, sum) = (d / h, m[0] + m[1]);
        // Most intervals are told without roots.
        if sum < 3.0 * delta || sum - m[0].sqrt() * m[1].sqrt() < 3.0 * delta {
            Self::cubic([m[0] - delta, m[1] - delta], h)
        } else {
            let root = [m[0].sqrt(), m[1].sqrt()];
            let cubes = [root[0] * m[0], root[1] * m[1]];
            let s = cubes[0] + cubes[1];
            // The quotient first: a square of s could overflow.
            let c = s / d;
            let singular = [
                2.0 / 3.0 * cubes[1] / d / root[0].max(TINY_ROOT),
                2.0 / 3.0 * cubes[0] / d / root[1].max(TINY_ROOT),
            ];
            // 2m/d + (2/3)S/(d r) with S split into its own part, which is (2/3)m/d, and the other's.
            let growing = [8.0 / 3.0 * (m[0] / d), 8.0 / 3.0 * (m[1] / d)];
            Self {
                energy: 4.0 / 9.0 * s * c,
                gradient: [4.0 / 3.0 * c * root[0], 4.0 / 3.0 * c * root[1]],
                hessian: [
                    growing[0] + singular[0],
                    2.0 * root[0] * root[1] / d,
                    growing[1] + singular[1],
                ],
                singular,
                growing,
                level: true,
            }
        }
    }

    /// One cubic, in the deviations of its end slopes from the secant: no cancellation on straight data.
    #[inline(always)]
    pub(crate) fn cubic([u, v]: [f64; 2], h: f64) -> Self {
        let by = 4.0 / h;
        Self {
            energy: by * (u * u + u * v + v * v),
            gradient: [by * (2.0 * u + v), by * (u + 2.0 * v)],
            hessian: [2.0 * by, by, 2.0 * by],
            singular: [0.0; 2],
            growing: [0.0; 2],
            level: false,
        }
    }

    /// The second derivatives at the ends.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [-0.5 * self.gradient[0], 0.5 * self.gradient[1]]
    }
}

/// The parabolas beside a level part: their widths and the share of the rise before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    pub(crate) widths: [f64; 2],
    pub(crate) share: f64,
}

impl Level {
    pub(crate) fn new(root: [f64; 2], d: f64) -> Self {
        let cubes = root.map(|r| r * r * r);
        let s = cubes[0] + cubes[1];
        // u = r/√a with √a = S/(3d).
        let widths = root.map(|r| 3.0 * d * (r / s));
        Self { widths, share: cubes[0] / s }
    }
}

/// `min over m ≥ 0 of E(m) + 2p₀m₀ − 2p₁m₁`: minus the conjugate of the interval's energy, a bound from below.
pub(crate) fn least(p: [f64; 2], d: f64, h: f64) -> f64 {
    let delta = d / h;
    let parabola = [delta - h * (2.0 * p[0] + p[1]) / 6.0, delta + h * (p[0] + 2.0 * p[1]) / 6.0];
    // The least slope of the unconstrained minimiser, a parabola with these ends.
    let lowest = if p[1] > p[0] {
        let t = (-p[0] / (p[1] - p[0])).clamp(0.0, 1.0) * h;
        parabola[0] + p[0] * t + (p[1] - p[0]) * t * t / (2.0 * h)
    } else {
        parabola[0].min(parabola[1])
    };
    if lowest >= 0.0 {
        return 2.0 * delta * (p[0] - p[1]) - h * (p[0] * p[0] + p[0] * p[1] + p[1] * p[1]) / 3.0;
    }
    let end = |e: f64| 4.0 / h * (e * e - 3.0 * delta * e + 3.0 * delta * delta);
    let e1 = ((p[1] * h + 6.0 * delta) / 4.0).clamp(0.0, 3.0 * delta);
    let e0 = ((6.0 * delta - p[0] * h) / 4.0).clamp(0.0, 3.0 * delta);
    let mut value = (end(e1) - 2.0 * p[1] * e1).min(end(e0) + 2.0 * p[0] * e0);
    let q = [(-p[0]).max(0.0), p[1].max(0.0)];
    let a = ((q[0] * q[0] * q[0] + q[1] * q[1] * q[1]) / (24.0 * d)).sqrt().max(1e-300);
    let b = q.map(|q| q * q / (4.0 * a));
    if b[0] + b[1] - (b[0] * b[1]).sqrt() >= 3.0 * delta * (1.0 - 1e-9) {
        value = value.min(-8.0 * a * d);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(m0: f64, m1: f64, d: f64, h: f64) -> Piece {
        Piece::new([m0, m1], d, h)
    }

    /// Gradients and Hessians are the derivatives of the energies and of the gradients, in both forms.
    #[test]
    fn derivatives_are_those_of_the_energy() {
        for (m0, m1, d, h) in [(0.3, 0.8, 1.2, 0.7), (9.0, 4.0, 1.2, 0.7), (5.0, 0.2, 0.4, 2.0)] {
            let (at, e) = (piece(m0, m1, d, h), 1e-5);
            let moved = [piece(m0 + e, m1, d, h), piece(m0, m1 + e, d, h)];
            let back = [piece(m0 - e, m1, d, h), piece(m0, m1 - e, d, h)];
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{a} {b}");
            for k in 0..2 {
                close((moved[k].energy - back[k].energy) / (2.0 * e), at.gradient[k]);
                close((moved[k].gradient[k] - back[k].gradient[k]) / (2.0 * e), at.hessian[2 * k]);
                let other = (moved[k].gradient[1 - k] - back[k].gradient[1 - k]) / (2.0 * e);
                close(other, at.hessian[1]);
            }
        }
    }

    /// The two forms agree where they meet.
    #[test]
    fn forms_meet_in_value_and_gradient() {
        let (m0, m1, h) = (2.0f64, 0.5f64, 0.8);
        let d = h * (m0 + m1 - (m0 * m1).sqrt()) / 3.0;
        let (a, b) = (piece(m0, m1, d * (1.0 + 1e-12), h), piece(m0, m1, d * (1.0 - 1e-12), h));
        assert!(!a.level && b.level);
        assert!((a.energy - b.energy).abs() < 1e-9 && (a.gradient[0] - b.gradient[0]).abs() < 1e-9);
        assert!((a.gradient[1] - b.gradient[1]).abs() < 1e-9);
    }

    /// No slopes have less than the bound, and at its own second derivatives a piece attains it.
    #[test]
    fn the_bound_is_below_and_attained() {
        for (m0, m1, d, h) in [(0.3, 0.8, 1.2, 0.7), (9.0, 4.0, 1.2, 0.7), (0.0, 4.0, 0.4, 2.0)] {
            let own = piece(m0, m1, d, h);
            let p = own.ends();
            let bound = least(p, d, h);
            let value =
                |m0: f64, m1: f64| piece(m0, m1, d, h).energy + 2.0 * p[0] * m0 - 2.0 * p[1] * m1;
            assert!((value(m0, m1) - bound).abs() < 1e-12 * (1.0 + bound.abs()));
            for i in 0..40 {
                for j in 0..40 {
                    let v = value(0.3 * f64::from(i), 0.3 * f64::from(j));
                    assert!(v >= bound - 1e-12 * (1.0 + bound.abs()));
                }
            }
        }
    }
}
