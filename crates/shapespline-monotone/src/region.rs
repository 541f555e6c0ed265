// SPDX-License-Identifier: MIT OR Apache-2.0

//! End derivatives of the non-negative quartics of mean 1 with given end values: what a segment of a monotone quintic
//! with given slopes leaves to its second derivatives, exactly.
//!
//! **Region.** Let p ≥ 0 on [0, 1], of degree four, with p(0) = a, p(1) = b, ∫p = 1 (the derivative over the secant).
//! The points (p'(0), p'(1)) form a convex region. It is empty unless `3a + 3b − 2√(ab) ≤ 24`: the least ∫p is that of
//! a square q², q(0) = √a, q(1) = √b, and the reproducing kernel of quadratics is 9 at an end and 3 between the two.
//! So one end slope may be nine times the secant (the other one then is the secant), both six times.
//!
//! **Boundary.** It belongs to the p that touch 0 inside, `p = (t−τ)²q` with a quadratic q ≥ 0, which τ determines: one
//! or two arcs. They meet in corners, where p is a square with two contacts. Where an end value is 0, a straight edge
//! (p'(0) = 0 or p'(1) = 0) joins an arc to a corner or two corners. On an arc p'(1) is extreme for τ = 2/5 and p'(0)
//! for τ = 3/5: there a combination of the functionals p(0), p(1), p(τ), ∫p and the derivative vanishes on all quartics.

use shapespline_polynomial::bracketed_root;

/// A convex region in the plane of (p'(0), p'(1)).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Region {
    a: f64,
    b: f64,
    /// Bounds of the arcs' contacts, as τ/(1−τ); the second arc is empty where there is one.
    arcs: [[f64; 2]; 2],
    /// The corners (the second only if there are two arcs), then the ends of straight edges; NaN where there is none.
    corners: [[f64; 2]; 2],
    edges: [[[f64; 2]; 2]; 2],
}

const NONE: [f64; 2] = [f64::NAN; 2];
/// τ/(1−τ) where p'(1) and where p'(0) is extreme.
const EXTREME: [f64; 2] = [2.0 / 3.0, 1.5];
/// Relative rounding error of the slopes' limit that is let pass.
const ROUNDING: f64 = 1e-14;

impl Region {
    /// None where there is no such p.
    pub(crate) fn new(a: f64, b: f64) -> Option<Self> {
        // Zero without a sign.
        let (a, b) = (a + 0.0, b + 0.0);
        let (p, q) = (a.sqrt(), b.sqrt());
        let room = 24.0 - (3.0 * (a + b) - 2.0 * p * q);
        // NaN and negative values end here too.
        if !(room >= -24.0 * ROUNDING) {
            return None;
        }
        // Squares of the quadratics with Bernstein coefficients p, m, q and ∫ = 1: two values of m.
        let outer = -0.25 * (3.0 * (p + q) + (5.0 * room.max(0.0)).sqrt());
        let inner = (3.0 * (a + b) + p * q - 15.0) / (2.0 * outer);
        let corner = |m: f64| [4.0 * p * (m - p), 4.0 * q * (q - m)];
        let contacts = |m: f64| {
            let r = (m * m - p * q).max(0.0).sqrt() - m;
            [p / r, r / q]
        };
        let [first, last] = contacts(outer);
        let two = inner < 0.0 && inner * inner > p * q;
        let mut region = Self {
            a,
            b,
            arcs: [[first, last], NONE],
            corners: [corner(outer), NONE],
            edges: [[NONE; 2]; 2],
        };
        if two {
            let [left, right] = contacts(inner);
            region.arcs = [[first, left], [right, last]];
            region.corners[1] = corner(inner);
        }
        let start = region;
        let other = |end: f64| if two { start.corners[1] } else { start.point(end) };
        if a == 0.0 {
            region.edges[0] = [region.corners[0], other(0.0)];
        }
        if b == 0.0 {
            region.edges[1] = [region.corners[0], other(f64::INFINITY)];
        }
        Some(region)
    }

    /// The boundary point with contact at τ = z/(1+z).
    fn point(&self, z: f64) -> [f64; 2] {
        let (tau, v) = if z > 1.0 {
            let w = 1.0 / z;
            (1.0 / (1.0 + w), w / (1.0 + w))
        } else {
            (z / (1.0 + z), 1.0 / (1.0 + z))
        };
        // What an end value gives is 0 with it, also where the contact is at that end.
        let part = |value: f64, inner: f64, outer: f64| {
            if value == 0.0 { 0.0 } else { value * inner / outer }
        };
        let square = |l: f64, r: f64| l * l / 5.0 - l * r / 10.0 + r * r / 30.0;
        let left = part(self.a, square(tau, v), tau * tau);
        let right = part(self.b, square(v, tau), v * v);
        let middle = tau * tau / 10.0 - 2.0 * tau * v / 15.0 + v * v / 10.0;
        let m = (1.0 - left - right) / middle;
        [
            2.0 * tau * tau * m - 2.0 * self.a - 2.0 * part(self.a, 1.0, tau),
            2.0 * self.b - 2.0 * v * v * m + 2.0 * part(self.b, 1.0, v),
        ]
    }

    /// The arcs, cut where p'(0) is extreme: on each piece it is monotone.
    fn pieces(&self) -> impl Iterator<Item = [f64; 2]> {
        self.arcs.into_iter().filter(|[from, to]| from < to).flat_map(|[from, to]| {
            let cut = EXTREME[1].clamp(from, to);
            [[from, cut], [cut, to]].into_iter().filter(|[from, to]| from < to)
        })
    }

    /// Corners, ends and extreme points of the boundary.
    fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let on_arc = |[from, to]: [f64; 2]| {
            EXTREME
                .into_iter()
                .filter(move |z| from < *z && *z < to)
                .chain([from, to].into_iter().filter(move |_| from < to))
        };
        let on_arcs = self.arcs.into_iter().flat_map(on_arc).map(|z| self.point(z));
        let others = self.corners.into_iter().chain(self.edges.into_iter().flatten());
        on_arcs.chain(others).filter(|p| !p[0].is_nan())
    }

    /// The interval of p'(1) where p'(0) is in [low, high]; None where it is empty.
    pub(crate) fn range(&self, low: f64, high: f64) -> Option<[f64; 2]> {
        let bounds = self
            .points()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p[0]), h.max(p[0])]);
        let rounding = 1e-13 * (bounds[0].abs() + bounds[1].abs());
        if !(low <= high && low <= bounds[1] + rounding && high >= bounds[0] - rounding) {
            return None;
        }
        let (low, high) = (low.min(bounds[1]), high.max(bounds[0]));
        let mut found = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |y: f64| found = [found[0].min(y), found[1].max(y)];
        self.points().filter(|p| low <= p[0] && p[0] <= high).for_each(|p| add(p[1]));
        for x in [low, high] {
            if !(bounds[0] < x && x < bounds[1]) {
                continue;
            }
            for [from, to] in self.pieces() {
                if (self.point(from)[0] < x) != (self.point(to)[0] < x) {
                    add(self.at(x, from, to)[1]);
                }
            }
            for [p, q] in self.edges.into_iter().filter(|[p, q]| (p[0] < x) != (q[0] < x)) {
                add(p[1] + (x - p[0]) / (q[0] - p[0]) * (q[1] - p[1]));
            }
        }
        (found[0] <= found[1]).then_some(found)
    }

    /// The point of a piece at which p'(0) = x: the root in the logarithm of z.
    fn at(&self, x: f64, from: f64, to: f64) -> [f64; 2] {
        let miss = |u: f64| self.point(u.exp())[0] - x;
        let ends = [from.max(1e-300).ln(), to.min(1e300).ln()];
        let resolution = 1e-15 * (self.a + self.b + x.abs() + 1.0);
        let values = ends.map(miss);
        let u = bracketed_root(|u| (miss(u), f64::NAN), ends, values, f64::NAN, [resolution, 0.0]);
        self.point(u.exp())
    }
}

/// Bernstein coefficients of the derivative of a quintic segment over Δ:
/// `1+a₀, 1+a₀+b₀, …, 1+a₁−b₁, 1+a₁`, the middle one from the mean 1.
#[inline]
pub(crate) fn derivative(a0: f64, b0: f64, a1: f64, b1: f64) -> [f64; 5] {
    [1.0 + a0, 1.0 + (a0 + b0), 1.0 - (2.0 * (a0 + a1) + (b0 - b1)), 1.0 + (a1 - b1), 1.0 + a1]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::reference;
    use shapespline_polynomial::quartic::least;

    struct Lcg(u64);
    impl Lcg {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// The least of p with end values a, b and end derivatives x, y.
    fn depth(a: f64, b: f64, [x, y]: [f64; 2]) -> f64 {
        least(&derivative(a - 1.0, 0.25 * x, b - 1.0, 0.25 * y))
    }

    /// End values of every kind: zero, tiny, equal, up to the limit.
    fn values(rng: &mut Lcg) -> [f64; 2] {
        loop {
            let mut value = || match (5.0 * rng.next()) as u32 {
                0 => 0.0,
                1 => 10f64.powf(-12.0 * rng.next()),
                _ => 9.0 * rng.next(),
            };
            let (a, b) = (value(), value());
            if 3.0 * (a + b) - 2.0 * (a * b).sqrt() < 24.0 {
                return [a, b];
            }
        }
    }

    /// Interval ends are on the boundary: just inside p ≥ 0, just outside it is negative.
    #[test]
    fn intervals_end_where_the_quartic_touches_zero() {
        let mut rng = Lcg(1);
        let mut seen = 0;
        for case in 0..4000 {
            let [a, b] = values(&mut rng);
            let region = Region::new(a, b).unwrap();
            let (low, high) = region
                .points()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[0]), h.max(p[0])));
            let x = low + (high - low) * rng.next();
            let [from, to] = region.range(x, x).unwrap();
            let width = to - from;
            if !(width > 1e-6 && x > low + 1e-9 && x < high - 1e-9) {
                continue;
            }
            seen += 1;
            for (y, out) in [(from, -1.0), (to, 1.0)] {
                assert!(
                    depth(a, b, [x, y]).abs() < 1e-9,
                    "case {case}: {a} {b} {x} {y} {}",
                    depth(a, b, [x, y])
                );
                assert!(
                    depth(a, b, [x, y - out * 1e-3 * width]) > -1e-12,
                    "case {case}: {a} {b} {x} {y}"
                );
                let beyond = depth(a, b, [x, y + out * 1e-2 * (1.0 + width)]);
                assert!(beyond < 0.0, "case {case}: {a} {b} {x} {y} {beyond}");
            }
        }
        assert!(seen > 3000, "{seen}");
    }

    /// Against a linear program on a fine grid: the extreme p'(1) over an interval of p'(0).
    #[test]
    fn ranges_are_those_of_a_linear_program() {
        let mut rng = Lcg(2);
        for case in 0..60 {
            let [a, b] = values(&mut rng);
            let region = Region::new(a, b).unwrap();
            let (low, high) = region
                .points()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[0]), h.max(p[0])));
            let mut ends = [low + (high - low) * rng.next(), low + (high - low) * rng.next()];
            ends.sort_by(f64::total_cmp);
            let ours = region.range(ends[0], ends[1]).unwrap();
            for (k, sign) in [(0, 1.0), (1, -1.0)] {
                let mut positive = vec![(vec![(0, 1.0)], -ends[0]), (vec![(0, -1.0)], ends[1])];
                for j in 1..400 {
                    let w = shapespline_polynomial::quartic::basis(f64::from(j) / 400.0);
                    let at = |x: f64, y: f64| {
                        shapespline_polynomial::quartic::dot(
                            &derivative(a - 1.0, 0.25 * x, b - 1.0, 0.25 * y),
                            &w,
                        )
                    };
                    let constant = at(0.0, 0.0);
                    positive.push((
                        vec![(0, at(1.0, 0.0) - constant), (1, at(0.0, 1.0) - constant)],
                        constant,
                    ));
                }
                let (v, _) = reference::quadratic(2, vec![], &[0.0, sign], &[], &positive);
                let size = 1.0 + ours[0].abs().max(ours[1].abs());
                assert!(
                    (v[1] - ours[k]).abs() < 0.02 * size,
                    "case {case}: {a} {b} {ends:?}: {} {}",
                    v[1],
                    ours[k]
                );
            }
        }
    }

    #[test]
    fn the_limits_of_end_slopes() {
        for (a, b) in [(9.0, 1.0), (1.0, 9.0), (6.0, 6.0), (8.0, 0.0), (0.0, 8.0)] {
            assert!(Region::new(a, b).is_some(), "{a} {b}");
            assert!(Region::new(a * 1.000_001, b * 1.000_001).is_none(), "{a} {b}");
        }
        for (a, b) in [(f64::NAN, 1.0), (-1.0, 1.0), (9.1, 1.0), (1e300, 1e300)] {
            assert!(Region::new(a, b).is_none(), "{a} {b}");
        }
    }
}
