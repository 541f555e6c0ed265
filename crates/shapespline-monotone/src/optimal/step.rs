//! One interior-point step: the Newton system, its predictor and corrector, and the step they allow.

use super::{FRACTION, Problem};
use crate::energy::{self, HESSIAN};

/// What a step does.
pub(super) struct Step {
    /// The share of the direction that is taken.
    pub(super) length: f64,
    /// Σ λz after it.
    pub(super) gap: f64,
}

impl Problem<'_> {
    /// Find the direction and its length; None when a slack or a multiplier is not positive any more.
    pub(super) fn step(&mut self) -> Option<Step> {
        self.assemble();
        if !self.healthy {
            return None;
        }
        // Predictor: the affine direction, towards complementarity 0.
        let mut system = std::mem::take(&mut self.system);
        let (now, ahead) = self.predict(system.solve());
        let sigma = (ahead / now).max(0.0);
        let mu = (sigma * sigma * sigma).max(1e-6) * now / self.conditions.len() as f64;
        // Corrector: towards σμ, with the predictor's second-order term, on the same factors.
        self.corrector(mu);
        self.direction.copy_from_slice(system.solve_again(|i| self.rhs[i]));
        self.system = system;
        Some(self.correct(mu))
    }

    /// Assemble and eliminate `(∇²E + Σ (λ/z) g gᵀ) δ = −∇E`; without conditions the energy alone, for the unknowns
    /// themselves.
    pub(super) fn assemble(&mut self) {
        let n = self.data.len();
        self.system.clear();
        (self.energy, self.healthy) = (0.0, true);
        let mut diagonal = [0.0f64; 3];
        let mut rhs = [0.0f64; 2];
        for i in 0..=n {
            let mut next = ([0.0; 3], [0.0; 4], [0.0; 2]);
            if i < n && self.segments[i].e > 0.0 {
                let (m, r) = self.local_system(i);
                let super::conditions::Segment { a, b, .. } = self.segments[i];
                diagonal[0] += a * (a * m[0]);
                diagonal[1] += a * (b * m[1]);
                diagonal[2] += b * (b * m[4]);
                rhs[0] += a * r[0];
                rhs[1] += b * r[1];
                next = (
                    [a * (a * m[7]), a * (b * m[8]), b * (b * m[9])],
                    [a * (a * m[2]), a * (b * m[3]), b * (a * m[5]), b * (b * m[6])],
                    [a * r[2], b * r[3]],
                );
            }
            let (d, c, r) = self.pinned(i, diagonal, next.1, rhs);
            if let Some(kept) = self.rhs.get_mut(i) {
                *kept = r;
            }
            self.system.push(d, c, r);
            (diagonal, rhs) = (next.0, next.2);
        }
    }

    /// A row of the system with the fixed unknowns' rows made the identity, their right-hand sides 0.
    #[inline]
    pub(super) fn pinned(
        &self,
        i: usize,
        mut d: [f64; 3],
        mut c: [f64; 4],
        mut r: [f64; 2],
    ) -> ([f64; 3], [f64; 4], [f64; 2]) {
        let (own, next) = (self.free[i], self.free.get(i + 1).copied().unwrap_or_default());
        if !(own.0 && own.1) {
            if !own.0 {
                (d[0], d[1], r[0]) = (1.0, 0.0, 0.0);
                (c[0], c[1]) = (0.0, 0.0);
            }
            if !own.1 {
                (d[2], d[1], r[1]) = (1.0, 0.0, 0.0);
                (c[2], c[3]) = (0.0, 0.0);
            }
        }
        if !(next.0 && next.1) {
            if !next.0 {
                (c[0], c[2]) = (0.0, 0.0);
            }
            if !next.1 {
                (c[1], c[3]) = (0.0, 0.0);
            }
        }
        (d, c, r)
    }

    /// A segment's matrix (upper triangle, row by row) and −∇E in its dimensionless unknowns.
    #[inline]
    fn local_system(&mut self, i: usize) -> ([f64; 10], [f64; 4]) {
        let segment = &self.segments[i];
        let e = segment.e;
        let u = segment.local(self.v[i], self.v[i + 1]);
        let x = [u[0] - 1.0, u[1], u[2] - 1.0, u[3]];
        let mut m = [0.0; 10];
        let mut r = [0.0; 4];
        let mut at = 0;
        for j in 0..4 {
            for k in 0..4 {
                r[j] -= HESSIAN[j][k] * x[k];
                if k >= j {
                    m[at] = e * HESSIAN[j][k];
                    at += 1;
                }
            }
            r[j] *= e;
        }
        self.energy += e * energy::local(x[0], x[1], x[2], x[3]);
        let range = self.range(i);
        let mut healthy = true;
        for c in &mut self.conditions[range] {
            let z = c.value(&u);
            healthy &= z > 0.0 && c.lambda > 0.0;
            c.iz = 1.0 / z;
            let g = &c.g;
            let s = c.lambda * c.iz;
            let h = [s * g[0], s * g[1], s * g[2], s * g[3]];
            m[0] += h[0] * g[0];
            m[1] += h[0] * g[1];
            m[2] += h[0] * g[2];
            m[3] += h[0] * g[3];
            m[4] += h[1] * g[1];
            m[5] += h[1] * g[2];
            m[6] += h[1] * g[3];
            m[7] += h[2] * g[2];
            m[8] += h[2] * g[3];
            m[9] += h[3] * g[3];
        }
        self.healthy &= healthy;
        (m, r)
    }

    /// Relative changes of the slacks along the affine direction; Σ λz now and as far as it may go.
    fn predict(&mut self, step: &[[f64; 2]]) -> (f64, f64) {
        let mut shortest = 1.0f64;
        let (mut p0, mut p2) = (0.0, 0.0);
        for i in 0..self.data.len() {
            let du = self.segments[i].local(step[i], step[i + 1]);
            let range = self.range(i);
            for c in &mut self.conditions[range] {
                let ratio = c.along(&du) * c.iz;
                c.affine = ratio;
                // dλ = −λ(1 + dz/z).
                shortest = larger(larger(shortest, -ratio), 1.0 + ratio);
                let product = c.lambda / c.iz;
                p0 += product;
                p2 -= product * ratio * (1.0 + ratio);
            }
        }
        let length = 1.0 / shortest;
        (p0, p0 + length * (length * p2 - p0))
    }

    /// Add `Σ (μ/z − az aλ/z) g` to the right-hand side −∇E.
    fn corrector(&mut self, mu: f64) {
        for i in 0..self.data.len() {
            let segment = &self.segments[i];
            let mut r = [0.0; 4];
            for c in &self.conditions[self.range(i)] {
                let force = mu * c.iz + c.affine * (c.lambda * (1.0 + c.affine));
                for k in 0..4 {
                    r[k] += force * c.g[k];
                }
            }
            let (l, n) = (self.free[i], self.free[i + 1]);
            let keep = |free: bool, value: f64| if free { value } else { 0.0 };
            self.rhs[i][0] += keep(l.0, segment.a * r[0]);
            self.rhs[i][1] += keep(l.1, segment.b * r[1]);
            self.rhs[i + 1][0] += keep(n.0, segment.a * r[2]);
            self.rhs[i + 1][1] += keep(n.1, segment.b * r[3]);
        }
    }

    /// Changes of the multipliers along the corrected direction, the step they and the slacks allow, Σ λz after it.
    fn correct(&mut self, mu: f64) -> Step {
        let mut shortest = 0.0f64;
        let (mut p0, mut p1, mut p2) = (0.0, 0.0, 0.0);
        for i in 0..self.data.len() {
            let du = self.segments[i].local(self.direction[i], self.direction[i + 1]);
            let range = self.range(i);
            for c in &mut self.conditions[range] {
                let ratio = c.along(&du) * c.iz;
                let second = c.affine * (c.lambda * (1.0 + c.affine));
                c.dl = (mu * c.iz + second) - c.lambda * (1.0 + ratio);
                shortest = larger(larger(shortest, -ratio), -c.dl / c.lambda);
                let z = 1.0 / c.iz;
                p0 += z * c.lambda;
                p1 += z * (c.dl + c.lambda * ratio);
                p2 += z * (ratio * c.dl);
            }
        }
        let length = (FRACTION / shortest).min(1.0);
        Step { length, gap: p0 + length * (p1 + length * p2) }
    }

    /// Go that far.
    pub(super) fn advance(&mut self, length: f64) {
        for c in &mut self.conditions {
            c.lambda += length * c.dl;
        }
        for (v, d) in self.v.iter_mut().zip(&self.direction) {
            *v = [v[0] + length * d[0], v[1] + length * d[1]];
        }
    }
}

/// The larger; the first when the second is NaN. One instruction, where `f64::max` has to look for NaN.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
