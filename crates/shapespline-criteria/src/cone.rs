// SPDX-License-Identifier: MIT OR Apache-2.0

//! Whether a vector quadratic stays inside a double cone: the common form of coplanarity (`ω` around
//! the plane normal) and collinearity (`γ'` around the line).

use glam::DVec3;
use shapespline_geometry::DataPolygon;
use shapespline_polynomial::{
    Sign,
    quadratic::{is_positive, multiply},
};

use crate::{
    Requirements, Tolerances,
    requirements::inflection_parameter_between,
    rounding::{Lean, UNIT, sum},
};

/// A vector quadratic in Bernstein form.
pub(crate) type Quadratic = [DVec3; 3];

/// The quadratic on the part `[from, to]` of its interval, by blossoming.
pub(crate) fn part(v: Quadratic, from: f64, to: f64) -> Quadratic {
    let blossom = |s: f64, t: f64| v[0].lerp(v[1], s).lerp(v[1].lerp(v[2], s), t);
    [blossom(from, from), blossom(from, to), blossom(to, to)]
}

/// `ε²‖v‖² − ‖v × n‖²` as a quartic in Bernstein form, for a unit vector `n`: positive where `v` lies
/// inside the double cone around `n` whose half angle has the sine `ε` (paper 001, (5.10), (5.22)).
fn quartic(v: Quadratic, n: DVec3, epsilon: f64) -> [f64; 5] {
    let across = v.map(|x| x.cross(n));
    let square = |coordinate: fn(DVec3) -> f64, v: Quadratic| {
        let c = v.map(coordinate);
        multiply(c, c)
    };
    let along = v.map(|x| x.dot(n));
    let along = multiply(along, along);
    let (x, y, z) = (square(|v| v.x, across), square(|v| v.y, across), square(|v| v.z, across));
    // ε²‖v‖² − ‖v×n‖² = ε²(v·n)² − (1−ε²)‖v×n‖²: no difference of nearly equal squares.
    let (inside, outside) = (epsilon * epsilon, (1.0 - epsilon) * (1.0 + epsilon));
    std::array::from_fn(|i| inside * along[i] - outside * (x[i] + y[i] + z[i]))
}

/// The same of one vector, to the bit its value at an end.
fn depth(v: DVec3, n: DVec3, epsilon: f64) -> f64 {
    let (across, along) = (v.cross(n), v.dot(n));
    let (inside, outside) = (epsilon * epsilon, (1.0 - epsilon) * (1.0 + epsilon));
    let square = across.x * across.x + across.y * across.y + across.z * across.z;
    inside * (along * along) - outside * square
}

/// Axis of a double cone: a unit vector, and how far from it the true one may lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    pub(crate) direction: DVec3,
    pub(crate) off: f64,
}

/// A vector quadratic, and how far its coefficients may be off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field {
    v: Quadratic,
    off: [f64; 3],
}

impl Field {
    /// `off`: how far each coordinate of each coefficient may be off.
    pub(crate) fn new(v: Quadratic, off: [f64; 3]) -> Self {
        // Lengths from coordinates: at most √3 times as much.
        Self { v, off: off.map(|off| 1.75 * off) }
    }

    /// The part on `[from, to]` of its interval. Errors are blossomed as values are; the blossoming itself
    /// rounds by less than `8u` of what it takes the mean of.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        let bounds = [0, 1, 2].map(|k| self.off[k] + 8.0 * UNIT * sum(self.v[k]));
        let off = part(bounds.map(DVec3::splat), from, to).map(|x| x.x);
        Self { v: part(self.v, from, to), off }
    }

    /// How far the parts of coefficient `k` along and across an axis may be off.
    fn error(&self, k: usize, axis: &Axis) -> f64 {
        self.off[k] + sum(self.v[k]) * (axis.off + 6.0 * UNIT)
    }

    /// Whether the vector at an end, 0 or 2, lies inside a double cone.
    pub(crate) fn end_is_inside(&self, end: usize, axis: &Axis, epsilon: f64, lean: Lean) -> bool {
        let v = self.v[end];
        let off = self.error(end, axis);
        let (size, off) = (sum(v) + off, off + 8.0 * UNIT * sum(v));
        depth(v, axis.direction, epsilon) + lean.sign() * (2.0 * size * off) > 0.0
    }

    /// Whether the vector stays inside a double cone.
    pub(crate) fn is_inside(&self, axis: &Axis, epsilon: f64, lean: Lean) -> bool {
        let off = [0, 1, 2].map(|k| self.error(k, axis));
        let along = self.v.map(|x| x.dot(axis.direction));
        let has_side = |side: f64| {
            let [alpha, middle, beta] = [0, 1, 2]
                .map(|k| side * along[k] + lean.sign() * (off[k] + 8.0 * UNIT * along[k].abs()));
            is_positive(alpha, 2.0 * middle, beta)
        };
        if !(has_side(1.0) || has_side(-1.0)) {
            return false;
        }
        // A product of two parts is off by size times error twice. Up to 60 subdivisions round by 2u each
        // of what they take the mean of.
        let sizes = [0, 1, 2].map(|k| sum(self.v[k]) + off[k]);
        let errors = [0, 1, 2].map(|k| off[k] + 128.0 * UNIT * sizes[k]);
        let errors = multiply(sizes, errors);
        let depth = quartic(self.v, axis.direction, epsilon);
        let depth: [f64; 5] = std::array::from_fn(|i| depth[i] + lean.sign() * (2.0 * errors[i]));
        match Sign::of(&depth) {
            Sign::Positive => true,
            Sign::Fails { .. } => false,
            Sign::Undecided { .. } => lean == Lean::For,
        }
    }
}

/// Whether `v` stays inside the double cone on all of its interval.
///
/// Inside the cone `v·n` has one sign, and that is asked first: where a planar curve inflects, the
/// quartic has a double root, which rounding can hide, but `v·n` a simple one, which it cannot.
pub(crate) fn inside(v: Quadratic, n: DVec3, epsilon: f64) -> Sign {
    let [alpha, middle, beta] = v.map(|x| x.dot(n));
    let sign = alpha.signum();
    if !is_positive(sign * alpha, 2.0 * sign * middle, sign * beta) {
        return Sign::Fails { at: axis_crossing(alpha, middle, beta) };
    }
    Sign::of(&quartic(v, n, epsilon))
}

/// Where `v·n`, a quadratic with Bernstein coefficients `[α, m, β]`, first vanishes on `[0, 1]`.
fn axis_crossing(alpha: f64, m: f64, beta: f64) -> f64 {
    // α(1−t)² + 2m t(1−t) + βt² = 0: in r = t/(1−t), α + 2m r + β r² = 0.
    let root = (m * m - alpha * beta).max(0.0).sqrt();
    let q = -(m + root.copysign(m));
    let first = |r: f64| if r >= 0.0 { r / (1.0 + r) } else { f64::NAN };
    let (r1, r2) = (first(alpha / q), first(q / beta));
    let t = r1.min(r2);
    if t.is_nan() { if alpha == 0.0 { 0.0 } else { 1.0 } } else { t }
}

/// What the coplanarity and collinearity conditions need beyond the legs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cones {
    /// `ε₁` and the unit binormal vectors at the two nodes: both are normals of the plane, up to the
    /// tolerance of `Γ = 0`, and (2.5) is asked of both.
    pub(crate) plane: (f64, [DVec3; 2]),
    /// `t^ℓ, t^r`: the parts `[0, t^ℓ]` and `[t^r, 1]` of a split coplanarity.
    pub(crate) parts: [f64; 2],
    /// `ε₀` and the line directions at the two nodes.
    pub(crate) line: (f64, [DVec3; 2]),
}

impl Cones {
    /// Those of a segment, given the unit chords of it and its neighbours.
    pub(crate) fn new(
        polygon: &DataPolygon,
        segment: usize,
        [before, own, after]: [DVec3; 3],
        required: Requirements,
        tolerances: &Tolerances,
    ) -> Self {
        let binormals = [before.cross(own), own.cross(after)];
        let parts = if required.intersects(Requirements::SPLIT_COPLANARITY) {
            let flip = inflection_parameter_between(polygon, [segment; 2], binormals);
            [0.5 * flip, 0.5 * (1.0 + flip)]
        } else {
            [0.0, 1.0]
        };
        // The line of three points is known from both of its chords.
        let lines = [before + own, own + after].map(DVec3::normalize_or_zero);
        Self {
            plane: (tolerances.coplanarity, binormals.map(DVec3::normalize_or_zero)),
            parts,
            line: (tolerances.collinearity, lines),
        }
    }

    /// For questions that ask of no cone.
    pub(crate) fn none() -> Self {
        Self { plane: (1.0, [DVec3::ZERO; 2]), parts: [0.0, 1.0], line: (1.0, [DVec3::ZERO; 2]) }
    }
}

/// Collinearity is asked on this part of a segment next to the node.
pub(crate) const LINE_PART: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from)
    }

    fn value(v: Quadratic, t: f64) -> DVec3 {
        let s = 1.0 - t;
        v[0] * (s * s) + v[1] * (2.0 * s * t) + v[2] * (t * t)
    }

    proptest! {
        #[test]
        fn a_part_has_the_values_of_the_whole(v in proptest::array::uniform3(vector()), f in 0.0..0.5f64, g in 0.5..1.0f64, t in 0.0..1.0f64) {
            let expected = value(v, f + (g - f) * t);
            prop_assert!((value(part(v, f, g), t) - expected).length() < 1e-14);
        }

        #[test]
        fn the_verdict_is_that_of_dense_sampling(v in proptest::array::uniform3(vector()), n in vector(), epsilon in 0.05..0.99f64) {
            prop_assume!(n.length() > 0.1);
            let n = n.normalize();
            // Half of the cases close to the axis, where the verdict is open.
            let near = v.map(|x| n + x * epsilon);
            for v in [v, near] {
                let sine = |t: f64| {
                    let w = value(v, t);
                    w.cross(n).length() / w.length()
                };
                let largest = (0..=2000).map(|k| sine(f64::from(k) / 2000.0)).fold(0.0, f64::max);
                if (largest - epsilon).abs() > 1e-4 {
                    prop_assert_eq!(inside(v, n, epsilon).holds(), largest < epsilon);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn the_depth_at_an_end_is_the_quartics(v in proptest::array::uniform3(vector()), n in vector(), epsilon in 0.05..0.99f64) {
            let whole = quartic(v, n, epsilon);
            prop_assert_eq!([depth(v[0], n, epsilon), depth(v[2], n, epsilon)], [whole[0], whole[4]]);
        }
    }

    #[test]
    fn a_planar_inflection_is_outside_wherever_it_lies() {
        for k in 1..1000 {
            let root = f64::from(k) / 1000.0 * 0.98 + 0.01;
            // v·z changes sign at the root and v stays on the axis: the quartic has a double root.
            let v = [1.0, 1.0 - 0.5 / root, 1.0 - 1.0 / root].map(|z| DVec3::new(0.0, 0.0, z));
            match inside(v, DVec3::Z, 0.2) {
                Sign::Fails { at } => assert!((at - root).abs() < 1e-12, "{root} {at}"),
                other => panic!("{root}: {other:?}"),
            }
        }
    }
}
