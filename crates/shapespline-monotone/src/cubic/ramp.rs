// SPDX-License-Identifier: MIT OR Apache-2.0

//! The least energy of an interval on which the function is convex or concave, in the slopes at its ends: closed forms.
//!
//! In the direction of the data: width `h`, secant `δ`, slopes `m₀ < δ < m₁` of a convex interval, so that the tangents
//! at its ends pass below and above the chord by `a = δ − m₀ > 0` and `b = m₁ − δ > 0`. Without a condition the least
//! `∫ y''² dx` is one cubic with `y'' = (4a − 2b)/h` and `(4b − 2a)/h` at the ends; it is convex while `a ≤ 2b` and
//! `b ≤ 2a`. Where `b > 2a` the least under `y'' ≥ 0` is (Lagrange) the positive part of a line: 0, then a ramp of width
//! w at the right end. Its two moments, `∫ y'' = a + b` and `∫ (h − t) y'' = ah`, give `w = 3ah/(a + b)` and the height
//! `2(a + b)/w`, and the energy is `4(a + b)³/(9ha)`. The two forms meet with equal values, gradients and Hessians; the
//! energy is convex in `(a, b)` and grows beyond bounds as one of them falls to 0 alone, which keeps Newton's method
//! inside. Concave intervals are convex ones seen from the other end.

use super::piece::Piece;

/// What a ramp is narrower than its interval, relative to it, by rounding (at free ends it is as wide).
const ROUNDING: f64 = 1e-12;

/// The parts of an interval by which its end tangents and its chord differ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ramp {
    h: f64,
    /// At the end of the smaller slope, and of the larger one.
    pub(crate) arms: [f64; 2],
    /// Whether the smaller slope is at the right end.
    concave: bool,
}

/// The second derivative of an interval: the positive part of a line (negative where the interval is concave).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shape {
    pub(crate) ends: [f64; 2],
    /// Where it is 0 beside an end: which end is curved, and the width of the curved part.
    pub(crate) ramp: Option<(usize, f64)>,
    pub(crate) energy: f64,
}

/// Swap what belongs to the two ends.
fn turned<T: Copy>(concave: bool, [a, b]: [T; 2]) -> [T; 2] {
    if concave { [b, a] } else { [a, b] }
}

impl Ramp {
    /// Of an interval that is convex (`bend` = 1) or concave (−1) in the direction of its data, with end slopes that differ
    /// so much from its secant.
    #[inline]
    pub(crate) fn beside(bend: i8, from: [f64; 2], h: f64) -> Self {
        let concave = bend < 0;
        let [low, high] = turned(concave, from);
        Self { h, arms: [-low, high], concave }
    }

    /// Energy and derivatives in the slopes. `singular` is what the diagonal of the Hessian has beyond that of a cubic:
    /// the part that grows as an arm goes to 0.
    pub(crate) fn piece(&self) -> Piece {
        let ([a, b], h) = (self.arms, self.h);
        let plain = 8.0 / h;
        if a == 0.0 && b == 0.0 {
            return Piece { hessian: [plain, 0.5 * plain, plain], ..Piece::default() };
        }
        if !(a > 0.0 && b > 0.0) {
            return Piece {
                energy: f64::INFINITY,
                hessian: [plain, 0.0, plain],
                ..Piece::default()
            };
        }
        let (energy, gradient, [aa, ab, bb]) = if b > 2.0 * a {
            ramp(a, b, h)
        } else if a > 2.0 * b {
            let (energy, [gb, ga], [bb, ab, aa]) = ramp(b, a, h);
            (energy, [ga, gb], [aa, ab, bb])
        } else {
            let by = 4.0 / h;
            let energy = by * (a * a - a * b + b * b);
            (energy, [by * (2.0 * a - b), by * (2.0 * b - a)], [plain, -by, plain])
        };
        // The smaller slope falls as its arm grows.
        let gradient = turned(self.concave, [-gradient[0], gradient[1]]);
        let [first, last] = turned(self.concave, [aa, bb]);
        let singular = [first - plain, last - plain].map(|s| s.max(0.0));
        Piece { energy, gradient, hessian: [first, -ab, last], singular, ..Piece::default() }
    }

    /// The second derivative. Of arms that rounding has made negative (straight data), nothing is left.
    pub(crate) fn shape(&self) -> Shape {
        let ([a, b], h) = (self.arms, self.h);
        if !(a > 0.0 && b > 0.0) {
            return Shape::default();
        }
        let (sum, more) = (a + b, 2.0 * (1.0 + ROUNDING));
        let (ends, ramp) = if b > more * a {
            let width = 3.0 * h * (a / sum);
            ([0.0, 2.0 * sum / width], Some((1, width)))
        } else if a > more * b {
            let width = 3.0 * h * (b / sum);
            ([2.0 * sum / width, 0.0], Some((0, width)))
        } else {
            ([(4.0 * a - 2.0 * b) / h, (4.0 * b - 2.0 * a) / h].map(|z| z.max(0.0)), None)
        };
        let energy = self.piece().energy;
        if self.concave {
            let ramp = ramp.map(|(end, width)| (1 - end, width));
            return Shape { ends: [-ends[1], -ends[0]], ramp, energy };
        }
        Shape { ends, ramp, energy }
    }
}

/// `4(a + b)³/(9ha)` with its gradient and Hessian (aa, ab, bb).
fn ramp(a: f64, b: f64, h: f64) -> (f64, [f64; 2], [f64; 3]) {
    let (sum, by) = (a + b, 4.0 / (9.0 * h));
    // Quotients first: a power of the sum could leave the range.
    let q = sum / a;
    let energy = by * (q * sum) * sum;
    let gradient = [by * (q * q) * (2.0 * a - b), 3.0 * by * (q * sum)];
    let square = 1.0 - b / a + (b / a) * (b / a);
    (energy, gradient, [2.0 * by * q * square, 3.0 * by * q * (1.0 - b / a), 6.0 * by * q])
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASES: [(i8, [f64; 2]); 6] = [
        (1, [0.7, 1.4]),
        (1, [0.9, 5.0]),
        (1, [0.1, 1.2]),
        (-1, [1.4, 0.7]),
        (-1, [5.0, 0.9]),
        (-1, [1.2, 0.1]),
    ];

    #[test]
    fn derivatives_are_those_of_the_energy() {
        let e = 1e-5;
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} {b}");
        for (bend, m) in CASES {
            let piece = |m: [f64; 2]| Ramp::beside(bend, m.map(|m| m - 1.0), 0.8).piece();
            let at = piece(m);
            for k in 0..2 {
                let moved = |by: f64| {
                    let mut m = m;
                    m[k] += by;
                    piece(m)
                };
                let (up, down) = (moved(e), moved(-e));
                close((up.energy - down.energy) / (2.0 * e), at.gradient[k]);
                for j in 0..2 {
                    let second = (up.gradient[j] - down.gradient[j]) / (2.0 * e);
                    close(second, at.hessian[k + j]);
                }
            }
        }
    }

    /// The second derivative has the moments that slopes and rise ask for, and the energy.
    #[test]
    fn shapes_join_the_ends() {
        let (delta, h) = (1.0, 0.8);
        for (bend, m) in CASES {
            let shape = Ramp::beside(bend, m.map(|m| m - delta), h).shape();
            let z = |t: f64| match shape.ramp {
                None => shape.ends[0] + (shape.ends[1] - shape.ends[0]) * t / h,
                Some((0, w)) => shape.ends[0] * (1.0 - t / w).max(0.0),
                Some((_, w)) => shape.ends[1] * (1.0 - (h - t) / w).max(0.0),
            };
            let n = 20_000;
            let at = |k: i32| (f64::from(k) + 0.5) * h / f64::from(n);
            let sum =
                |f: &dyn Fn(f64) -> f64| (0..n).map(|k| f(at(k))).sum::<f64>() * h / f64::from(n);
            assert!((sum(&z) - (m[1] - m[0])).abs() < 1e-6);
            assert!((sum(&|t| (h - t) * z(t)) - (delta - m[0]) * h).abs() < 1e-6);
            assert!((sum(&|t| z(t) * z(t)) - shape.energy).abs() < 1e-4 * shape.energy);
            assert!(shape.ends.iter().all(|z| f64::from(bend) * z >= 0.0));
        }
    }
}
