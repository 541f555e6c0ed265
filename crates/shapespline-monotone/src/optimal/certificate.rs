//! How far an iterate is from the exact optimum: a lower bound on the energy of every C² monotone quintic.
//!
//! **Bound.** For functionals ℓᵢ that are non-negative on all quartics ≥ 0 on [0, 1],
//! `E(v) − E* ≤ Σ ℓᵢ(pᵢ) + ½ rᵀ(∇²E)⁻¹r` with `r = Σ ∇ℓᵢ − ∇E(v)`: weak duality, the quadratic minimised exactly.
//! The iteration's multipliers of the conditions on parts give functionals that need not be non-negative — the
//! conditions are sufficient only — so the least multiple κᵢ of `∫p` is added that makes them so. As `∫p` is the same
//! for all p that interpolate, it has no gradient: it costs κᵢ in the bound and nothing in r. κᵢ is what the
//! conditions of segment i lose against the exact ones.
//!
//! **Non-negativity.** A quartic ≥ 0 on [0, 1] is `Σq² + t(1−t)Σr²`, deg q ≤ 2, deg r ≤ 1 (Markov–Lukács; Karlin and
//! Studden, *Tchebycheff Systems*, 1966, ch. II). With q, r in orthonormal bases `∫p` is the sum of the two traces, and
//! the least ℓ(p) over `∫p = 1` is the least eigenvalue of the matrices `ℓ(φᵢφⱼ)` and `ℓ(t(1−t)ψᵢψⱼ)`.

use super::Problem;
use crate::energy::{self, HESSIAN};
use crate::quartic_form::dot;

const S3: f64 = 1.732_050_807_568_877_2;
const S5: f64 = 2.236_067_977_499_79;
const S15: f64 = 3.872_983_346_207_417;
const S180: f64 = 13.416_407_864_998_739;

/// Bernstein coefficients of φᵢφⱼ, φ the orthonormal Legendre polynomials on [0, 1]: 00, 01, 02, 11, 12, 22.
const SQUARES: [[f64; 5]; 6] = [
    [1.0, 1.0, 1.0, 1.0, 1.0],
    [-S3, -0.5 * S3, 0.0, 0.5 * S3, S3],
    [S5, -0.5 * S5, -S5, -0.5 * S5, S5],
    [3.0, 0.0, -1.0, 0.0, 3.0],
    [-S15, S15, 0.0, -S15, S15],
    [5.0, -10.0, 15.0, -10.0, 5.0],
];
/// Of t(1−t)ψᵢψⱼ, ψ orthonormal for the weight t(1−t): 00, 01, 11.
const BUBBLES: [[f64; 5]; 3] = [
    [0.0, 1.5, 2.0, 1.5, 0.0],
    [0.0, -0.25 * S180, 0.0, 0.25 * S180, 0.0],
    [0.0, 7.5, -10.0, 7.5, 0.0],
];

/// Weight, in units of the functional's, of the value at a turn or a flat, which vanishes on every admissible quartic:
/// any weight is allowed, a large one helps.
const VANISHING: f64 = 1e4;

/// How large the end coefficients of a quartic ≥ 0 of mean 1 get, roughly: 9 is the most of the first.
const RANGE: f64 = 5.0;

/// Least ℓ(p) over quartics p ≥ 0 on [0, 1] with ∫p = 1; `l` are ℓ's weights of the Bernstein coefficients.
pub(super) fn least_value(l: &[f64; 5]) -> f64 {
    let at = |row: &[f64; 5]| (0..5).map(|k| l[k] * row[k]).sum::<f64>();
    let b = BUBBLES.map(|row| at(&row));
    let (mean, half) = (0.5 * (b[0] + b[2]), 0.5 * (b[0] - b[2]));
    let two = mean - (half * half + b[1] * b[1]).sqrt();
    let s = SQUARES.map(|row| at(&row));
    let three = least_eigenvalue([[s[0], s[1], s[2]], [s[1], s[3], s[4]], [s[2], s[4], s[5]]]);
    two.min(three)
}

/// Of a symmetric 3×3 matrix, by Jacobi's rotations (Golub and Van Loan, *Matrix Computations*, section 8.5).
fn least_eigenvalue(mut m: [[f64; 3]; 3]) -> f64 {
    for _ in 0..6 {
        for (p, q, r) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
            let apq = m[p][q];
            if apq.abs() <= 1e-18 * (m[p][p].abs() + m[q][q].abs()) {
                continue;
            }
            let theta = 0.5 * (m[q][q] - m[p][p]) / apq;
            let t = 1.0f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            m[p][p] -= t * apq;
            m[q][q] += t * apq;
            (m[p][q], m[q][p]) = (0.0, 0.0);
            let (rp, rq) = (m[r][p], m[r][q]);
            (m[r][p], m[p][r]) = (c * rp - s * rq, c * rp - s * rq);
            (m[r][q], m[q][r]) = (s * rp + c * rq, s * rp + c * rq);
        }
    }
    m[0][0].min(m[1][1]).min(m[2][2])
}

impl Problem<'_> {
    /// The energy and an upper bound of E(v) − E*. O(N): one elimination.
    pub(super) fn certificate(&mut self) -> (f64, f64) {
        let n = self.data.len();
        self.functionals();
        self.cancel();
        // What is left of stationarity at a node is charged where it costs less: as part of the functional of a
        // neighbouring segment, whose quartics are bounded by their mean, or to the energy's own curvature.
        for i in 0..=n {
            for k in 0..2 {
                let r = self.rhs[i][k];
                let unit = |j: usize| {
                    if k == 0 { 1.0 / self.segments[j].a } else { 1.0 / self.segments[j].b }
                };
                let stiffness = |j: usize| HESSIAN[k][k] * self.segments[j].e / (unit(j) * unit(j));
                let open = |j: usize| self.segments[j].e > 0.0;
                let left = i.checked_sub(1).filter(|j| open(*j));
                let right = Some(i).filter(|j| *j < n && open(*j));
                let best = match (left, right) {
                    (Some(l), Some(r)) => {
                        if unit(l).abs() < unit(r).abs() {
                            l
                        } else {
                            r
                        }
                    }
                    (Some(j), None) | (None, Some(j)) => j,
                    (None, None) => continue,
                };
                let curvature: f64 = left.iter().chain(&right).map(|j| stiffness(*j)).sum();
                if r.abs() > 2.0 * RANGE * unit(best).abs() * curvature {
                    let x = -r * unit(best);
                    let l = &mut self.functionals[best];
                    match (best == i, k) {
                        (true, 0) => l[0] += x,
                        (true, _) => (l[0], l[1]) = (l[0] - x, l[1] + x),
                        (false, 0) => l[4] += x,
                        (false, _) => (l[3], l[4]) = (l[3] - x, l[4] + x),
                    }
                    self.rhs[i][k] = 0.0;
                }
            }
        }
        self.system.clear();
        let mut bound = 0.0;
        let mut diagonal = [0.0f64; 3];
        for i in 0..=n {
            let mut next = ([0.0; 3], [0.0; 4]);
            if i < n && self.segments[i].e > 0.0 {
                let s = self.segments[i];
                let mut l = self.functionals[i];
                bound += dot(&l, &super::conditions::bernstein(&s.local(self.v[i], self.v[i + 1])));
                let size: f64 = l.iter().map(|m| m.abs()).sum();
                let (p, q) = (self.free[i], self.free[i + 1]);
                if !p.0 {
                    l[0] += VANISHING * size;
                }
                if !q.0 {
                    l[4] += VANISHING * size;
                }
                // The eigenvalue's own rounding error counts against us.
                bound += (1e-15 * size - least_value(&l)).max(0.0);
                let (d, c, nd) = s.stiffness();
                for k in 0..3 {
                    diagonal[k] += d[k];
                }
                next = (nd, c);
            }
            let (d, c, r) = self.pinned(i, diagonal, next.1, self.rhs[i]);
            self.system.push(d, c, r);
            diagonal = next.0;
        }
        (self.energy, bound + 0.5 * self.system.quadratic())
    }

    /// At a node where the slope is near zero the conditions next to it on both sides hold the second derivative from
    /// opposite directions, and the barrier keeps both: take away what cancels. Only the sum of both is a force, but
    /// each alone would be charged to its segment.
    fn cancel(&mut self) {
        for i in 1..self.data.len() {
            let (s, t) = (self.segments[i - 1], self.segments[i]);
            if !self.free[i].0 || s.e == 0.0 || t.e == 0.0 {
                continue;
            }
            // The conditions on the coefficients next to the node, at a quarter of the parts that end there.
            let (left, right) = (self.range(i - 1), self.range(i));
            let (Some(before), Some(after)) =
                (self.conditions[left].last(), self.conditions[right].get(1))
            else {
                continue;
            };
            let (a, b) = (4.0 * (1.0 - before.t) * before.lambda, 4.0 * after.t * after.lambda);
            let common = (a * s.b.abs()).min(b * t.b.abs());
            let (a, b) = (common / s.b.abs(), common / t.b.abs());
            let l = &mut self.functionals[i - 1];
            (l[3], l[4]) = (l[3] - a, l[4] + a);
            let l = &mut self.functionals[i];
            (l[0], l[1]) = (l[0] + b, l[1] - b);
        }
    }

    /// The functionals the multipliers make, as weights of Bernstein coefficients, and what they leave of stationarity
    /// (in `rhs`).
    fn functionals(&mut self) {
        let n = self.data.len();
        self.functionals.clear();
        self.functionals.resize(n, [0.0; 5]);
        self.rhs.fill([0.0; 2]);
        self.energy = 0.0;
        for i in 0..n {
            let s = self.segments[i];
            if s.e == 0.0 {
                continue;
            }
            let u = s.local(self.v[i], self.v[i + 1]);
            let x = [u[0] - 1.0, u[1], u[2] - 1.0, u[3]];
            self.energy += s.e * energy::local(x[0], x[1], x[2], x[3]);
            let mut force: [f64; 4] =
                std::array::from_fn(|k| -s.e * (0..4).map(|j| HESSIAN[k][j] * x[j]).sum::<f64>());
            let mut l = [0.0; 5];
            for c in &self.conditions[self.range(i)] {
                // The weights of the row from its gradient and its constant 5w₂.
                let w2 = 0.2 * c.k;
                let (w1, w3) = (c.g[1] + w2, w2 - c.g[3]);
                let w = [c.g[0] - w1 + 2.0 * w2, w1, w2, w3, c.g[2] - w3 + 2.0 * w2];
                for k in 0..5 {
                    l[k] += c.lambda * w[k];
                }
                for k in 0..4 {
                    force[k] += c.lambda * c.g[k];
                }
            }
            self.functionals[i] = l;
            let (p, q) = (self.free[i], self.free[i + 1]);
            let keep = |free: bool, value: f64| if free { value } else { 0.0 };
            self.rhs[i][0] += keep(p.0, s.a * force[0]);
            self.rhs[i][1] += keep(p.1, s.b * force[1]);
            self.rhs[i + 1][0] += keep(q.0, s.a * force[2]);
            self.rhs[i + 1][1] += keep(q.1, s.b * force[3]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quartic_form::{basis, dot};

    /// Point masses are non-negative, a coefficient is not; against the sampled minimum over quartics with two double
    /// roots, which are the extreme ones.
    #[test]
    fn least_values() {
        assert!(least_value(&basis(0.3)).abs() < 1e-14);
        assert!((least_value(&[0.2; 5]) - 1.0).abs() < 1e-14);
        assert!(least_value(&[0.0, 1.0, 0.0, 0.0, 0.0]) < -0.1);
        let mut state = 9u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.4
        };
        for _ in 0..60 {
            let l: [f64; 5] = std::array::from_fn(|_| next());
            let exact = least_value(&l);
            let mut sampled = f64::INFINITY;
            let mut take = |c: [f64; 5]| {
                let mean = c.iter().sum::<f64>() / 5.0;
                sampled = sampled.min(dot(&l, &c) / mean);
            };
            let m = 80;
            for i in 0..=m {
                for j in i..=m {
                    let (a, b) = (f64::from(i) / f64::from(m), f64::from(j) / f64::from(m));
                    // (t−a)²(t−b)² and t(1−t)(t−a)²: products of Bernstein forms.
                    let q = [a * b, -0.5 * (a + b - 2.0 * a * b), (1.0 - a) * (1.0 - b)];
                    take([
                        q[0] * q[0],
                        q[0] * q[1],
                        (2.0 * q[0] * q[2] + 4.0 * q[1] * q[1]) / 6.0,
                        q[1] * q[2],
                        q[2] * q[2],
                    ]);
                    let s = [a * a, -a * (1.0 - a), (1.0 - a) * (1.0 - a)];
                    take([0.0, 0.25 * s[0], s[1] / 3.0, 0.25 * s[2], 0.0]);
                }
            }
            let room = 0.01 * (1.0 + sampled.abs());
            assert!(exact <= sampled + 1e-12 && exact > sampled - room, "{exact} {sampled}");
        }
    }
}
