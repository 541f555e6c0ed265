//! A segment cut into parts, and non-negativity of its derivative as linear conditions on them.
//!
//! On a part [l, r] of [0, 1] the Bernstein coefficients of the quartic are convex combinations of those on the whole
//! (polar values at l and r). "All coefficients ≥ 0" on every part is sufficient for p ≥ 0 and implied by the same on
//! a coarser division: cutting further only relaxes. Where a part ends at a double root of p the coefficients next to
//! that end vanish with p: with the cuts at the touching points the conditions lose nothing there.

use crate::quartic_form::{basis, dot, minima};

/// Cuts a segment may have: two touching points, and three to resolve what lies between them.
pub(super) const MOST: usize = 7;
/// A minimum of p (whose mean is 1) below this becomes a cut.
const NEAR: f64 = 2.0;
/// A condition whose slack is below this, and below a third of p at the same place, asks for a cut there.
const BLOCKING: (f64, f64) = (0.3, 3.0);
/// Distance of such cuts from a minimum.
const APART: f64 = 0.1;
/// Distance between cuts that resolve blocking conditions, and from the ends.
const NEXT: f64 = 0.04;
/// Conditions this near a minimum act on it.
const CLUSTER: f64 = 0.3;
/// Cuts keep this distance from the ends.
const END: f64 = 1e-3;

/// Where a segment is cut, increasing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Cuts {
    at: [f64; MOST],
    /// Whether the cut follows a minimum of p.
    follows: [bool; MOST],
    len: usize,
}

impl Cuts {
    /// Number of parts.
    #[inline]
    pub(super) fn parts(&self) -> usize {
        self.len + 1
    }

    /// Ends of part k.
    #[inline]
    pub(super) fn part(&self, k: usize) -> (f64, f64) {
        let l = if k == 0 { 0.0 } else { self.at[k - 1] };
        (l, if k == self.len { 1.0 } else { self.at[k] })
    }

    fn far(&self, t: f64, distance: f64) -> bool {
        self.at[..self.len].iter().all(|c| (c - t).abs() > distance)
    }

    /// Insert in order, unless full or already there.
    fn insert(&mut self, t: f64, follows: bool) {
        if self.len == MOST || !self.far(t, END) {
            return;
        }
        let mut k = self.len;
        while k > 0 && self.at[k - 1] > t {
            self.at[k] = self.at[k - 1];
            self.follows[k] = self.follows[k - 1];
            k -= 1;
        }
        self.at[k] = t;
        self.follows[k] = follows;
        self.len += 1;
    }

    /// Whether all inner coefficients on all parts are above `floor`; where the ends are roots of p by themselves, not
    /// negative.
    fn positive(&self, c: &[f64; 5], floor: f64) -> bool {
        (0..self.parts()).all(|k| {
            let (l, r) = self.part(k);
            rows(l, r).iter().take(3).all(|w| {
                let z = dot(c, w);
                z > floor || z == 0.0 && (c[0] == 0.0 || c[4] == 0.0)
            })
        })
    }

    /// Better cuts for the quartic `c` (current, strictly feasible on these cuts), given its conditions as (place,
    /// slack, multiplier): at its minima; where the multipliers next to a minimum have their centre, which is where
    /// the minimum wants to go and the conditions at the old cut hold it back; and where a condition holds p up
    /// although p is not near zero. Old cuts go where that leaves the quartic feasible, else they stay. None when
    /// nothing changes; shifts below `moved` are nothing.
    pub(super) fn improved(
        &self,
        c: &[f64; 5],
        moved: f64,
        conditions: impl Iterator<Item = (f64, f64, f64)>,
    ) -> Option<Self> {
        let mut new = Self::default();
        let mut lowest = f64::INFINITY;
        for m in minima(c).iter().flatten() {
            if m.value < NEAR {
                new.insert(m.t.clamp(END, 1.0 - END), true);
                lowest = lowest.min(m.value);
            }
        }
        let still = (0..new.len).all(|k| {
            (0..self.len).any(|j| self.follows[j] && (new.at[k] - self.at[j]).abs() <= moved)
        });
        let followed = new;
        let mut centres = [(0.0, 0.0); 2];
        let mut blocking = [(0.0, 0.0); 4 * (MOST + 1) + 2];
        let mut count = 0;
        for (t, z, lambda) in conditions {
            if z >= BLOCKING.0 {
                continue;
            }
            let nearest = (0..followed.len.min(2))
                .map(|k| ((followed.at[k] - t).abs(), k))
                .fold((CLUSTER, 2), |a, b| if b.0 < a.0 { b } else { a })
                .1;
            if nearest < 2 {
                centres[nearest].0 += lambda;
                centres[nearest].1 += lambda * (t - followed.at[nearest]);
            }
            let blocks = t > NEXT
                && t < 1.0 - NEXT
                && followed.far(t, APART)
                && self.far(t, NEXT)
                && dot(c, &basis(t)) > BLOCKING.1 * z;
            if blocks && count < blocking.len() {
                blocking[count] = (t, z);
                count += 1;
            }
        }
        for (k, (mass, moment)) in centres.iter().enumerate().take(followed.len) {
            let t = followed.at[k] + moment / mass;
            if t > END && t < 1.0 - END && new.far(t, moved) && self.far(t, moved) {
                new.insert(t, false);
            }
        }
        // The tightest first: the choice is the same for data traversed backwards.
        let blocking = &mut blocking[..count];
        blocking.sort_unstable_by(|a, b| a.1.total_cmp(&b.1));
        let mut resolved = Self::default();
        for (t, _) in blocking {
            if resolved.far(*t, NEXT) {
                resolved.insert(*t, false);
                new.insert(*t, false);
            }
        }
        if still && new.len == followed.len {
            return None;
        }
        let lowest = if lowest.is_finite() { lowest } else { 0.0 };
        let wanted = new;
        for k in 0..self.len {
            if !self.follows[k] && new.far(self.at[k], APART) {
                new.insert(self.at[k], false);
            }
        }
        if !new.positive(c, 0.1 * lowest) {
            new = *self;
            new.follows = [false; MOST];
            for k in 0..wanted.len {
                if new.far(wanted.at[k], moved) {
                    new.insert(wanted.at[k], wanted.follows[k]);
                }
            }
        }
        (new != *self).then_some(new)
    }
}

/// Bernstein coefficients 1…4 on [l, r] as weights of those on [0, 1]: coefficient j is the polar value at l (4 − j
/// times) and r (j times).
#[inline]
pub(crate) fn rows(l: f64, r: f64) -> [[f64; 5]; 4] {
    let (m, q) = (1.0 - l, 1.0 - r);
    let cubes = |u: f64, t: f64| [u * u * u, 3.0 * (u * u * t), 3.0 * (u * t * t), t * t * t];
    // A cubic and a linear factor.
    let mixed = |a: [f64; 4], u: f64, t: f64| {
        [a[0] * u, a[1] * u + a[0] * t, a[2] * u + a[1] * t, a[3] * u + a[2] * t, a[3] * t]
    };
    let (a, b) = ([m * m, 2.0 * (m * l), l * l], [q * q, 2.0 * (q * r), r * r]);
    let right = cubes(q, r);
    [
        mixed(cubes(m, l), q, r),
        [
            a[0] * b[0],
            a[0] * b[1] + a[1] * b[0],
            (a[0] * b[2] + a[2] * b[0]) + a[1] * b[1],
            a[1] * b[2] + a[2] * b[1],
            a[2] * b[2],
        ],
        mixed(right, m, l),
        mixed(right, q, r),
    ]
}

/// The gradient of a row in the segment's unknowns (d₀/Δ, h s₀/4Δ, d₁/Δ, h s₁/4Δ); its constant is 5w₂.
#[inline]
pub(crate) fn gradient(w: &[f64; 5]) -> [f64; 4] {
    [w[0] + w[1] - 2.0 * w[2], w[1] - w[2], w[3] + w[4] - 2.0 * w[2], w[2] - w[3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_reproduce_the_polynomial() {
        let c = [0.3, -1.0, 2.0, 0.7, 5.0];
        for (l, r) in [(0.0, 1.0), (0.0, 0.3), (0.2, 0.9), (0.75, 1.0)] {
            let w = rows(l, r).map(|w| dot(&c, &w));
            let own = [dot(&c, &basis(l)), w[0], w[1], w[2], w[3]];
            for k in 0..=8 {
                let local = f64::from(k) / 8.0;
                let t = l + (r - l) * local;
                assert!((dot(&own, &basis(local)) - dot(&c, &basis(t))).abs() < 1e-14);
            }
        }
    }

    /// A double root is found and cut at, where the conditions vanish with p; whatever the cuts become, the quartic
    /// satisfies them.
    #[test]
    fn improved_cuts_stay_feasible() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut cut = 0;
        for _ in 0..2000 {
            let c: [f64; 5] = std::array::from_fn(|_| 0.02 + 2.0 * next());
            let mut cuts = Cuts::default();
            // The quartic moves down towards zero while the cuts follow.
            let low = crate::quartic_form::least(&c);
            for share in [0.0, 0.5, 0.9, 0.99] {
                let q = c.map(|v| v - share * low);
                if !cuts.positive(&q, 0.0) {
                    break;
                }
                let conditions: Vec<(f64, f64, f64)> = (0..cuts.parts())
                    .flat_map(|k| {
                        let (l, r) = cuts.part(k);
                        let place = move |j: usize| l + 0.25 * (r - l) * (j + 1) as f64;
                        rows(l, r).into_iter().enumerate().map(move |(j, w)| (place(j), w))
                    })
                    .map(|(t, w)| (t, dot(&q, &w), 1.0 / dot(&q, &w)))
                    .collect();
                if let Some(new) = cuts.improved(&q, 0.01, conditions.into_iter()) {
                    cuts = new;
                    cut += 1;
                }
                assert!(cuts.positive(&q, 0.0), "{q:?} {cuts:?}");
                assert!(cuts.at[..cuts.len].windows(2).all(|w| w[0] < w[1]));
            }
        }
        assert!(cut > 500, "{cut}");
    }
}
