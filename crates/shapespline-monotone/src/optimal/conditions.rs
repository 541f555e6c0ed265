//! The conditions of all segments: one list in their order, made anew where cuts change.

use super::Problem;
use super::parts::{Cuts, gradient, rows};
use crate::energy::HESSIAN;

/// A segment without cuts and with all inner coefficients above this is left alone.
const CLEAR: f64 = 1.0;
/// Products λz of conditions that come anew stay within this factor of the barrier parameter.
const CENTRED: f64 = 100.0;
/// Cuts follow shifts from this on: the loss is quadratic in the distance.
const MOVED: f64 = 0.003;

/// A segment's constants: the factors 1/Δ and h/(4Δ) from (d, s) to the dimensionless (1 + a, b), and its energy
/// weight over 35; all 0 for a flat one. Where it is cut, and its first condition.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) e: f64,
    pub(super) first: usize,
    pub(super) cuts: Cuts,
}

impl Segment {
    /// The dimensionless unknowns (d₀/Δ, h s₀/4Δ, d₁/Δ, h s₁/4Δ).
    #[inline]
    pub(super) fn local(&self, v0: [f64; 2], v1: [f64; 2]) -> [f64; 4] {
        [self.a * v0[0], self.b * v0[1], self.a * v1[0], self.b * v1[1]]
    }

    /// The energy's Hessian: diagonal block of the left node, coupling, diagonal block of the right.
    #[inline]
    pub(super) fn stiffness(&self) -> ([f64; 3], [f64; 4], [f64; 3]) {
        let Self { a, b, e, .. } = *self;
        let k = |p: usize, q: usize| e * HESSIAN[p][q];
        (
            [a * (a * k(0, 0)), a * (b * k(0, 1)), b * (b * k(1, 1))],
            [a * (a * k(0, 2)), a * (b * k(0, 3)), b * (a * k(1, 2)), b * (b * k(1, 3))],
            [a * (a * k(2, 2)), a * (b * k(2, 3)), b * (b * k(3, 3))],
        )
    }
}

/// Bernstein coefficients of the derivative over Δ from a segment's unknowns; small ones without cancellation.
#[inline]
pub(super) fn bernstein(u: &[f64; 4]) -> [f64; 5] {
    let (c1, c3) = (u[0] + u[1], u[2] - u[3]);
    [u[0], c1, 5.0 - ((u[0] + c1) + (c3 + u[2])), c3, u[2]]
}

/// A condition `k + g·u ≥ 0` on a segment's unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Condition {
    pub(super) g: [f64; 4],
    pub(super) k: f64,
    /// Its place: the Greville abscissa of the coefficient.
    pub(super) t: f64,
    pub(super) lambda: f64,
    /// Reciprocal of the slack at the last assembly, the slack's relative affine change, the multiplier's change.
    pub(super) iz: f64,
    pub(super) affine: f64,
    pub(super) dl: f64,
}

impl Condition {
    #[inline]
    fn new(t: f64, w: &[f64; 5]) -> Self {
        Self { g: gradient(w), k: 5.0 * w[2], t, lambda: 0.0, iz: 1.0, affine: 0.0, dl: 0.0 }
    }

    #[inline]
    pub(super) fn value(&self, u: &[f64; 4]) -> f64 {
        self.k + self.along(u)
    }

    #[inline]
    pub(super) fn along(&self, u: &[f64; 4]) -> f64 {
        (self.g[0] * u[0] + self.g[1] * u[1]) + (self.g[2] * u[2] + self.g[3] * u[3])
    }
}

impl Problem<'_> {
    /// Conditions of segment i as a range.
    #[inline]
    pub(super) fn range(&self, i: usize) -> std::ops::Range<usize> {
        let end = self.segments.get(i + 1).map_or(self.conditions.len(), |s| s.first);
        self.segments[i].first..end
    }

    /// Append the conditions of segment i on its cuts, at barrier parameter μ. The old ones' multipliers inside
    /// the segment are handed to the new ones on either side: that keeps their sum and their centre, and so the force
    /// on linear p.
    pub(super) fn condition(&mut self, i: usize, mu: f64, old: Option<std::ops::Range<usize>>) {
        let segment = self.segments[i];
        if segment.e == 0.0 {
            return;
        }
        let (l, r) = (self.free[i], self.free[i + 1]);
        let first = self.conditions.len();
        let first_time = old.is_none();
        let mut add = |c: Condition| self.conditions.push(c);
        // The node's own: d ≥ 0, at a turn the sign of s.
        if l.0 {
            add(Condition::new(0.0, &[1.0, 0.0, 0.0, 0.0, 0.0]));
        } else if l.1 {
            add(Condition::new(0.0, &[0.0, 1.0, 0.0, 0.0, 0.0]));
        }
        let parts = segment.cuts.parts();
        for k in 0..parts {
            let (from, to) = segment.cuts.part(k);
            for (j, w) in rows(from, to).iter().enumerate() {
                let outer = k == 0 && j == 0 && !l.0;
                let inner = k + 1 == parts && (j == 3 || j == 2 && !r.0);
                // Coefficients that are the neighbour's condition, or that a turn or a flat fixes at 0.
                if !(outer || inner) {
                    add(Condition::new(from + 0.25 * (to - from) * (j + 1) as f64, w));
                }
            }
        }
        if i + 1 == self.data.len() && r.0 {
            add(Condition::new(1.0, &[0.0, 0.0, 0.0, 0.0, 1.0]));
        }
        let new = &mut self.conditions[first..];
        let inner = |c: &Condition| 0.0 < c.t && c.t < 1.0;
        let nodes = new.iter().take_while(|c| !inner(c)).count();
        let end = new.iter().rposition(inner).map_or(nodes, |k| k + 1);
        let mut k = nodes;
        for o in old.map_or(&[][..], |range| &self.before[range]) {
            if !inner(o) {
                // A node's own condition is the same as before.
                let same = if o.t == 0.0 { new.first_mut() } else { new.last_mut() };
                if let Some(c) = same {
                    c.lambda = o.lambda;
                }
                continue;
            }
            while k + 2 < end && new[k + 1].t <= o.t {
                k += 1;
            }
            if k + 1 < end {
                let right = ((o.t - new[k].t) / (new[k + 1].t - new[k].t)).clamp(0.0, 1.0);
                new[k].lambda += (1.0 - right) * o.lambda;
                new[k + 1].lambda += right * o.lambda;
            } else if let Some(c) = new.get_mut(k) {
                c.lambda += o.lambda;
            }
        }
        let u = segment.local(self.v[i], self.v[i + 1]);
        for c in new {
            let central = mu / c.value(&u);
            c.lambda = match first_time {
                true => central,
                false => c.lambda.max(central / CENTRED).min(central * CENTRED),
            };
        }
    }

    /// Better cuts where minima have come near or moved, or conditions block. O(N).
    pub(super) fn improve(&mut self, mu: f64) {
        let n = self.data.len();
        let mut changed = false;
        for i in 0..n {
            let segment = self.segments[i];
            if segment.e == 0.0 {
                if changed {
                    self.segments[i].first = self.conditions.len();
                }
                continue;
            }
            let range = if changed {
                let end = self.segments.get(i + 1).map_or(self.before.len(), |s| s.first);
                segment.first..end
            } else {
                self.range(i)
            };
            let u = segment.local(self.v[i], self.v[i + 1]);
            let c = bernstein(&u);
            let clear = segment.cuts.parts() == 1 && c[1].min(c[2]).min(c[3]) > CLEAR;
            let cuts = if clear {
                None
            } else {
                let list = if changed { &self.before } else { &self.conditions };
                let inner = list[range.clone()].iter().filter(|c| 0.0 < c.t && c.t < 1.0);
                segment.cuts.improved(&c, MOVED, inner.map(|c| (c.t, c.value(&u), c.lambda)))
            };
            if cuts.is_some() && !changed {
                // From here on the list is made anew.
                changed = true;
                std::mem::swap(&mut self.before, &mut self.conditions);
                self.conditions.clear();
                self.conditions.extend_from_slice(&self.before[..range.start]);
            }
            if let Some(cuts) = cuts {
                self.segments[i].cuts = cuts;
                self.segments[i].first = self.conditions.len();
                self.condition(i, mu, Some(range));
            } else if changed {
                self.segments[i].first = self.conditions.len();
                self.conditions.extend_from_slice(&self.before[range]);
            }
        }
    }
}
