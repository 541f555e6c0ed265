//! One interior-point step: the Newton system, its predictor and corrector, and the steps they allow.

use super::{Problem, Segment};
use crate::energy::{self, HESSIAN};
use crate::subdivision::Conditions;

/// What a direction allows.
pub(super) struct Look {
    pub(super) length: f64,
    pub(super) products: [f64; 3],
}

impl Problem<'_> {
    /// Assemble and eliminate `(∇²E + Σ w(λ/z) a aᵀ) δ = −∇E`; without conditions the energy alone, for the unknowns
    /// themselves.
    pub(super) fn assemble(&mut self) {
        let n = self.data.len();
        let constrained = self.mu > 0.0;
        self.system.clear();
        (self.energy, self.healthy) = (0.0, true);
        let mut diagonal = [0.0f64; 3];
        let mut rhs = [0.0f64; 2];
        for i in 0..=n {
            let mut coupling = [0.0; 4];
            let mut next_diagonal = [0.0; 3];
            let mut next_rhs = [0.0; 2];
            let node = &mut self.nodes[i];
            if constrained && node.k < 2 {
                node.z = node.unit * self.v[i][node.k];
                self.healthy &= node.z > 0.0 && node.lambda > 0.0;
                diagonal[2 * node.k] += node.unit * (node.unit * (node.w * (node.lambda / node.z)));
            }
            let free0 = node.free;
            let mut free1 = (false, false);
            if i < n {
                free1 = self.nodes[i + 1].free;
                let Segment { a, b, e, .. } = self.segments[i];
                if e > 0.0 {
                    let (m, r) = self.local_system(i, constrained);
                    diagonal[0] += a * (a * m[0]);
                    diagonal[1] += a * (b * m[1]);
                    diagonal[2] += b * (b * m[4]);
                    coupling = [a * (a * m[2]), a * (b * m[3]), b * (a * m[5]), b * (b * m[6])];
                    next_diagonal = [a * (a * m[7]), a * (b * m[8]), b * (b * m[9])];
                    rhs[0] += a * r[0];
                    rhs[1] += b * r[1];
                    next_rhs = [a * r[2], b * r[3]];
                }
            }
            // A fixed unknown: its row is the identity with right-hand side 0.
            if !free0.0 {
                (diagonal[0], diagonal[1], rhs[0]) = (1.0, 0.0, 0.0);
                (coupling[0], coupling[1]) = (0.0, 0.0);
            }
            if !free0.1 {
                (diagonal[2], diagonal[1], rhs[1]) = (1.0, 0.0, 0.0);
                (coupling[2], coupling[3]) = (0.0, 0.0);
            }
            if !free1.0 {
                (coupling[0], coupling[2]) = (0.0, 0.0);
            }
            if !free1.1 {
                (coupling[1], coupling[3]) = (0.0, 0.0);
            }
            self.descent[i] = rhs;
            self.system.push(diagonal, coupling, rhs);
            (diagonal, rhs) = (next_diagonal, next_rhs);
        }
    }

    /// A segment's matrix (upper triangle, row by row) and −∇E in its dimensionless unknowns.
    #[inline]
    fn local_system(&mut self, i: usize, constrained: bool) -> ([f64; 10], [f64; 4]) {
        let segment = self.segments[i];
        let Segment { a, b, e, w } = segment;
        let (v0, v1) = (self.v[i], self.v[i + 1]);
        let u = [a * v0[0] - 1.0, b * v0[1], a * v1[0] - 1.0, b * v1[1]];
        let mut m = [0.0; 10];
        let mut r = [0.0; 4];
        let mut at = 0;
        for j in 0..4 {
            for k in 0..4 {
                r[j] -= HESSIAN[j][k] * u[k];
                if k >= j {
                    m[at] = e * HESSIAN[j][k];
                    at += 1;
                }
            }
            r[j] *= e;
        }
        self.energy += e * energy::local(u[0], u[1], u[2], u[3]);
        if !constrained {
            return (m, r);
        }
        let c = segment.bernstein(v0, v1);
        let mut healthy = true;
        for block in &mut self.blocks[self.first[i] as usize..self.first[i + 1] as usize] {
            let conditions = &self.table[usize::from(block.part)];
            let z = values(conditions, &c);
            let mut stiffness = [0.0; 4];
            for j in 0..4 {
                block.z[j] = if block.on[j] > 0.0 { z[j] } else { 1.0 };
                healthy &= block.z[j] > 0.0 && block.lambda[j] >= 0.0;
                block.iz[j] = 1.0 / block.z[j];
                stiffness[j] = w * block.lambda[j] * block.iz[j];
            }
            let g = &conditions.by_unknown;
            let mut at = 0;
            for p in 0..4 {
                let scaled = times(&stiffness, &g[p]);
                for row in &g[p..] {
                    m[at] += sum(&times(&scaled, row));
                    at += 1;
                }
            }
        }
        self.healthy &= healthy;
        (m, r)
    }

    /// Changes of the slacks along the affine direction, how far it may go, and Σ w(z + αdz)(λ + αdλ).
    pub(super) fn predict(&mut self, step: &[[f64; 2]]) -> Look {
        let mut shortest = 0.0f64;
        let mut products = [0.0; 3];
        for (node, d) in self.nodes.iter_mut().zip(step) {
            if node.k < 2 {
                node.az = node.unit * d[node.k];
                let ratio = node.az / node.z;
                // dλ = −λ(1 + dz/z).
                shortest = shortest.max(-ratio).max(1.0 + ratio);
                let product = node.w * node.z * node.lambda;
                products[0] += product;
                products[1] -= product;
                products[2] -= product * ratio * (1.0 + ratio);
            }
        }
        let mut worst = [0.0f64; 4];
        for i in 0..self.data.len() {
            let segment = &self.segments[i];
            let dc = segment.change(step[i], step[i + 1]);
            let (mut p0, mut p2) = ([0.0; 4], [0.0; 4]);
            for block in &mut self.blocks[self.first[i] as usize..self.first[i + 1] as usize] {
                let az = values(&self.table[usize::from(block.part)], &dc);
                for j in 0..4 {
                    block.az[j] = az[j] * block.on[j];
                    let ratio = block.az[j] * block.iz[j];
                    worst[j] = worst[j].max(-ratio).max((1.0 + ratio) * block.on[j]);
                    let product = block.z[j] * block.lambda[j];
                    p0[j] += product;
                    p2[j] -= product * ratio * (1.0 + ratio);
                }
            }
            products[0] += segment.w * sum(&p0);
            products[1] -= segment.w * sum(&p0);
            products[2] += segment.w * sum(&p2);
        }
        let shortest = worst.iter().fold(shortest, |a, b| a.max(*b));
        Look { length: 1.0 / shortest, products }
    }

    /// The corrector's right-hand side `−∇E + Σ w (μ − az aλ)/z a`, aλ = −λ(1 + az/z).
    pub(super) fn corrector(&mut self, mu: f64) {
        let n = self.data.len();
        self.rhs.copy_from_slice(&self.descent);
        for (node, r) in self.nodes.iter().zip(&mut self.rhs) {
            if node.k < 2 {
                let second = node.az * node.lambda * (1.0 + node.az / node.z);
                r[node.k] += node.unit * (node.w * ((mu + second) / node.z));
            }
        }
        for i in 0..n {
            let Segment { a, b, w, .. } = self.segments[i];
            let mut r = [0.0; 4];
            for block in &self.blocks[self.first[i] as usize..self.first[i + 1] as usize] {
                let mut force = [0.0; 4];
                for j in 0..4 {
                    let second = block.az[j] * block.lambda[j] * (1.0 + block.az[j] * block.iz[j]);
                    force[j] = w * block.on[j] * ((mu + second) * block.iz[j]);
                }
                let g = &self.table[usize::from(block.part)].by_unknown;
                for k in 0..4 {
                    r[k] += sum(&times(&force, &g[k]));
                }
            }
            self.rhs[i][0] += a * r[0];
            self.rhs[i][1] += b * r[1];
            self.rhs[i + 1][0] += a * r[2];
            self.rhs[i + 1][1] += b * r[3];
        }
        for (node, r) in self.nodes.iter().zip(&mut self.rhs) {
            if !node.free.0 {
                r[0] = 0.0;
            }
            if !node.free.1 {
                r[1] = 0.0;
            }
        }
    }

    /// Changes of the multipliers along the corrected direction, how far it may go, and Σ w(z + αdz)(λ + αdλ).
    pub(super) fn correct(&mut self, step: &[[f64; 2]], mu: f64) -> Look {
        let mut shortest = 0.0f64;
        let mut products = [0.0; 3];
        for (node, d) in self.nodes.iter_mut().zip(step) {
            if node.k < 2 {
                let dz = node.unit * d[node.k];
                let second = node.az * node.lambda * (1.0 + node.az / node.z);
                node.dl = (mu + second) / node.z - node.lambda * (1.0 + dz / node.z);
                shortest = shortest.max(-dz / node.z).max(-node.dl / node.lambda);
                products[0] += node.w * node.z * node.lambda;
                products[1] += node.w * (node.z * node.dl + node.lambda * dz);
                products[2] += node.w * dz * node.dl;
            }
        }
        let mut worst = [0.0f64; 4];
        for i in 0..self.data.len() {
            let segment = &self.segments[i];
            let dc = segment.change(step[i], step[i + 1]);
            let (mut p0, mut p1, mut p2) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            for block in &mut self.blocks[self.first[i] as usize..self.first[i + 1] as usize] {
                let dz = values(&self.table[usize::from(block.part)], &dc);
                for j in 0..4 {
                    let on = block.on[j];
                    let (z, iz, lambda, az) =
                        (block.z[j], block.iz[j], block.lambda[j], block.az[j]);
                    let dz = dz[j] * on;
                    let second = az * lambda * (1.0 + az * iz);
                    let dl = on * ((mu + second) * iz) - lambda * (1.0 + dz * iz);
                    block.dl[j] = dl;
                    // A coefficient that is no condition has λ = dλ = 0: keep the quotient defined.
                    worst[j] = worst[j].max(-dz * iz).max(-dl / (lambda + (1.0 - on)));
                    p0[j] += z * lambda;
                    p1[j] += z * dl + lambda * dz;
                    p2[j] += dz * dl;
                }
            }
            products[0] += segment.w * sum(&p0);
            products[1] += segment.w * sum(&p1);
            products[2] += segment.w * sum(&p2);
        }
        let shortest = worst.iter().fold(shortest, |a, b| a.max(*b));
        Look { length: 1.0 / shortest, products }
    }

    pub(super) fn advance(&mut self, step: &[[f64; 2]], alpha: f64) {
        for node in &mut self.nodes {
            node.lambda += alpha * node.dl;
        }
        for block in &mut self.blocks {
            for j in 0..4 {
                block.lambda[j] += alpha * block.dl[j];
            }
        }
        for (v, d) in self.v.iter_mut().zip(step) {
            *v = [v[0] + alpha * d[0], v[1] + alpha * d[1]];
        }
    }
}

/// Coefficients 1…4 of a part.
#[inline]
pub(super) fn values(conditions: &Conditions, c: &[f64; 5]) -> [f64; 4] {
    let mut z = [0.0; 4];
    for (k, row) in conditions.by_coefficient.iter().enumerate() {
        for j in 0..4 {
            z[j] += c[k] * row[j];
        }
    }
    z
}

#[inline]
fn times(a: &[f64; 4], b: &[f64; 4]) -> [f64; 4] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

#[inline]
fn sum(a: &[f64; 4]) -> f64 {
    (a[0] + a[2]) + (a[1] + a[3])
}
