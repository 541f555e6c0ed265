// SPDX-License-Identifier: MIT OR Apache-2.0

//! The penalised energy of one interval as a quadratic model in its end slopes and its rise.
//!
//! The least energy of an interval (see `cubic/piece.rs`) is convex in `(m₀, m₁, d)` jointly. Its Hessian is a sum of
//! squares, and is kept as one, in coordinates in which no digits are lost:
//! - one cubic: `E = κ²/h + 12ε²/h³` with `κ = m₁ − m₀` and `ε = d − h(m₀ + m₁)/2`, in which it is diagonal;
//! - with a level part: `E = (4/9)S²/d` with `S = m₀^{3/2} + m₁^{3/2}`, and
//!   `∂²E = (8/9)(gᵀg + S·diag(3/(4r₀), 3/(4r₁), 0))/d`, `g = (3r₀/2, 3r₁/2, −S/d)`;
//! - convex (`cubic/ramp.rs`), in the arms `a = δ − m₀ ≥ 0`, `b = m₁ − δ ≥ 0` (of a concave interval `m₀ − δ`, `δ − m₁`):
//!   one cubic `E = (4/h)(a² − ab + b²)`, or with `q = (a + b)/a > 3` a ramp, `E = (4/9h)(a + b)³/a` and
//!   `∂²E = (4/9h)(gᵀg + (q³/2)·diag(1, 0))`, `g = (√(6q) − (q√q)√(3/2), √(6q))`; mirrored for `a > 2b`.

/// A root below which slopes count as 0 in quotients.
const TINY_ROOT: f64 = 1e-160;

/// `λE` of an interval, and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Model {
    pub(super) energy: f64,
    pub(super) form: Form,
    /// In `(ε, κ, 0)`; with a level part in `(d, m₀, m₁)`; in `(a, b, 0)` where convexity is asked.
    pub(super) gradient: [f64; 3],
    /// Roots of the Hessian: of its diagonal in ε and κ; with a level part the row g in `(d, m₀, m₁)` and the roots of
    /// what grows as a slope falls to 0, in m₀ and m₁; where convexity is asked the row g in `(a, b)` and the roots of
    /// what comes to its diagonal.
    pub(super) rows: [f64; 5],
}

/// The form of an interval's energy, and so the coordinates of its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    Cubic,
    /// With a level part.
    Level,
    /// Convex (1) or concave (−1).
    Bent(f64),
}

impl Form {
    pub(super) fn is_bent(self) -> bool {
        matches!(self, Self::Bent(_))
    }

    /// Of `−f(−x)`.
    #[inline(always)]
    pub(super) fn reflected(self) -> Self {
        if let Self::Bent(sense) = self { Self::Bent(-sense) } else { self }
    }
}

impl Model {
    /// Of `−f(−x)`: the ends are swapped.
    #[inline(always)]
    pub(super) fn reflected(&self) -> Self {
        let ([a, b, c], r) = (self.gradient, self.rows);
        let (gradient, rows) = match self.form {
            Form::Level => ([a, c, b], [r[0], r[2], r[1], r[4], r[3]]),
            Form::Cubic => ([a, -b, c], r),
            Form::Bent(_) => ([b, a, c], [r[1], r[0], r[3], r[2], r[4]]),
        };
        Self { energy: self.energy, form: self.form.reflected(), gradient, rows }
    }

    /// What a rise that is held at 0 between slopes held at 0 adds.
    pub(super) const HELD: Self =
        Self { energy: 0.0, form: Form::Level, gradient: [0.0; 3], rows: [0.0; 5] };

    pub(super) fn new(lambda: f64, m: [f64; 2], d: f64, h: f64) -> Self {
        if is_cubic(m, d, h) {
            Self::cubic(lambda, m, d, h)
        } else {
            Self::with_level(lambda, m, d)
        }
    }

    /// One cubic, whether or not it is monotone.
    pub(super) fn cubic(lambda: f64, m: [f64; 2], d: f64, h: f64) -> Self {
        let inverse = 1.0 / h;
        let delta = d * inverse;
        // ε from the deviations from the secant: no cancellation on straight data.
        let (kappa, epsilon) = (m[1] - m[0], -0.5 * h * ((m[0] - delta) + (m[1] - delta)));
        let bending = 2.0 * lambda * inverse;
        let stiff = [12.0 * (inverse * inverse) * bending, bending];
        let root = bending.sqrt();
        Self {
            energy: 0.5 * (stiff[0] * epsilon * epsilon + stiff[1] * kappa * kappa),
            form: Form::Cubic,
            gradient: [stiff[0] * epsilon, stiff[1] * kappa, 0.0],
            rows: [12f64.sqrt() * inverse * root, root, 0.0, 0.0, 0.0],
        }
    }

    fn with_level(lambda: f64, m: [f64; 2], d: f64) -> Self {
        let root = m.map(f64::sqrt);
        let c = (root[0] * m[0] + root[1] * m[1]) / d;
        let size = (8.0 / 9.0 * lambda / d).sqrt();
        let own = |r: f64| (2.0 / 3.0 * lambda * (c / r.max(TINY_ROOT))).sqrt();
        Self {
            energy: 4.0 / 9.0 * lambda * c * c * d,
            form: Form::Level,
            gradient: [
                -4.0 / 9.0 * lambda * c * c,
                4.0 / 3.0 * lambda * c * root[0],
                4.0 / 3.0 * lambda * c * root[1],
            ],
            rows: [
                -c * size,
                1.5 * root[0] * size,
                1.5 * root[1] * size,
                own(root[0]),
                own(root[1]),
            ],
        }
    }

    /// Convex (`sense` 1) or concave (−1), with these arms; straight where both are 0.
    pub(super) fn bent(lambda: f64, sense: f64, [a, b]: [f64; 2], h: f64) -> Self {
        let form = Form::Bent(sense);
        if a == 0.0 && b == 0.0 {
            return Self { form, ..Self::HELD };
        }
        let (energy, gradient, rows) = if b > 2.0 * a {
            let (energy, [by_a, by_b], [row_a, row_b, own]) = ramp(lambda, a, b, h);
            (energy, [by_a, by_b], [row_a, row_b, own, 0.0])
        } else if a > 2.0 * b {
            let (energy, [by_b, by_a], [row_b, row_a, own]) = ramp(lambda, b, a, h);
            (energy, [by_a, by_b], [row_a, row_b, 0.0, own])
        } else {
            let by = 4.0 * lambda / h;
            let root = (2.0 * by).sqrt();
            let gradient = [by * (2.0 * a - b), by * (2.0 * b - a)];
            let rows = [root, -0.5 * root, 0.0, 0.75f64.sqrt() * root];
            (by * (a * a - a * b + b * b), gradient, rows)
        };
        let [row_a, row_b, own_a, own_b] = rows;
        Self {
            energy,
            form,
            gradient: [gradient[0], gradient[1], 0.0],
            rows: [row_a, row_b, own_a, own_b, 0.0],
        }
    }

    /// The gradient in `(d, m₀, m₁)`.
    pub(super) fn plain_gradient(&self, h: f64) -> [f64; 3] {
        let [a, b, c] = self.gradient;
        match self.form {
            Form::Level => [a, b, c],
            Form::Cubic => [a, -0.5 * h * a - b, -0.5 * h * a + b],
            Form::Bent(sense) => [sense * (a - b) / h, -sense * a, sense * b],
        }
    }

    /// The part of the second derivative in `(m₀, m₁)` that grows as a slope falls to 0, and all of it.
    pub(super) fn curvatures(&self, h: f64) -> [[f64; 2]; 2] {
        let square = |v: f64| v * v;
        let r = self.rows;
        match self.form {
            Form::Level => {
                let own = [square(r[3]), square(r[4])];
                [own, [own[0] + square(r[1]), own[1] + square(r[2])]]
            }
            Form::Cubic => [[0.0; 2], [square(0.5 * h * r[0]) + square(r[1]); 2]],
            Form::Bent(_) => [[0.0; 2], [square(r[0]) + square(r[2]), square(r[1]) + square(r[3])]],
        }
    }
}

/// `(4λ/9h)(a + b)³/a`, its gradient, and its Hessian as a row g and the root of what comes to it at a.
fn ramp(lambda: f64, a: f64, b: f64, h: f64) -> (f64, [f64; 2], [f64; 3]) {
    let (sum, by) = (a + b, 4.0 * lambda / (9.0 * h));
    let q = sum / a;
    let (root, size) = (q.sqrt(), by.sqrt());
    let row_b = 6f64.sqrt() * root * size;
    let gradient = [by * q * q * (2.0 * a - b), 3.0 * by * q * sum];
    let rows = [row_b - 1.5f64.sqrt() * q * root * size, row_b, 0.5f64.sqrt() * q * root * size];
    (by * q * sum * sum, gradient, rows)
}

/// Whether the least energy is that of one cubic.
pub(super) fn is_cubic(m: [f64; 2], d: f64, h: f64) -> bool {
    let (sum, rise) = (m[0] + m[1], 3.0 * d / h);
    sum < rise || sum - (m[0] * m[1]).sqrt() < rise
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gradients and sums of squares are the derivatives of the energy, in both forms.
    #[test]
    fn derivatives_are_those_of_the_energy() {
        for (m0, m1, d, h) in [(0.3, 0.8, 1.2, 0.7), (9.0, 4.0, 1.2, 0.7), (5.0, 0.2, 0.4, 2.0)] {
            let at = |v: [f64; 3]| Model::new(1.7, [v[1], v[2]], v[0], h);
            let v = [d, m0, m1];
            let own = at(v);
            let e = 1e-5;
            // The rows in (d, m₀, m₁).
            let r = own.rows;
            let rows: Vec<[f64; 3]> = if own.form == Form::Level {
                vec![[r[0], r[1], r[2]], [0.0, r[3], 0.0], [0.0, 0.0, r[4]]]
            } else {
                vec![[r[0], -0.5 * h * r[0], -0.5 * h * r[0]], [0.0, -r[1], r[1]]]
            };
            for i in 0..3 {
                let moved = |by: f64| {
                    let mut v = v;
                    v[i] += by;
                    at(v)
                };
                let (up, down) = (moved(e), moved(-e));
                let close = |a: f64, b: f64| {
                    assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{a} {b}");
                };
                close((up.energy - down.energy) / (2.0 * e), own.plain_gradient(h)[i]);
                for j in 0..3 {
                    let second: f64 = rows.iter().map(|row| row[i] * row[j]).sum();
                    let (a, b) = (up.plain_gradient(h)[j], down.plain_gradient(h)[j]);
                    close((a - b) / (2.0 * e), second);
                }
                if i > 0 {
                    let second: f64 = rows.iter().map(|row| row[i] * row[i]).sum();
                    close(own.curvatures(h)[1][i - 1], second);
                }
            }
        }
    }

    /// The same where convexity is asked; and the energies are those of interpolation.
    #[test]
    fn bent_derivatives_are_those_of_the_energy() {
        let (h, e) = (0.7, 1e-5);
        for arms in [[0.3, 0.4], [0.9, 0.2], [0.1, 1.1], [1.0, 1e-3]] {
            let own = Model::bent(1.7, 1.0, arms, h);
            let [row_a, row_b, own_a, own_b, _] = own.rows;
            let rows = [[row_a, row_b], [own_a, 0.0], [0.0, own_b]];
            for i in 0..2 {
                let moved = |by: f64| {
                    let mut arms = arms;
                    arms[i] += by * arms[0].min(arms[1]);
                    Model::bent(1.7, 1.0, arms, h)
                };
                let (up, down, width) = (moved(e), moved(-e), 2.0 * e * arms[0].min(arms[1]));
                let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()));
                close((up.energy - down.energy) / width, own.gradient[i]);
                for j in 0..2 {
                    let second: f64 = rows.iter().map(|row| row[i] * row[j]).sum();
                    close((up.gradient[j] - down.gradient[j]) / width, second);
                }
            }
        }
    }
}
