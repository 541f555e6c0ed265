// SPDX-License-Identifier: MIT OR Apache-2.0

//! Values, gradients and Hessians of the conditions of a segment.

use glam::{DMat3, DVec3};

use crate::{
    element::{HODOGRAPH, Legs, OMEGA, T, TAU, products},
    legs::{LegTerms, outer},
    rows::{Kind, Row, Rules},
    segment::Segment,
};

/// What conditions need of the legs.
#[derive(Debug, Clone)]
pub(crate) struct Shape<'a> {
    segment: &'a Segment,
    rules: &'a Rules,
    legs: &'a Legs,
    products: [DVec3; 7],
}

/// Gradient of a condition with respect to the legs `first, first + 1, first + 2`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gradient {
    pub(crate) first: usize,
    pub(crate) legs: [DVec3; 3],
}

impl Gradient {
    pub(crate) const ZERO: Self = Self { first: 0, legs: [DVec3::ZERO; 3] };

    /// Its product with a change of the legs.
    pub(crate) fn along(&self, step: &Legs) -> f64 {
        let [a, b, c] = self.legs;
        let first = self.first;
        a.dot(step[first]) + b.dot(step[first + 1]) + c.dot(step[first + 2])
    }
}

impl<'a> Shape<'a> {
    pub(crate) fn new(segment: &'a Segment, rules: &'a Rules, legs: &'a Legs) -> Self {
        Self { segment, rules, legs, products: products(legs) }
    }

    /// `Σ w_k (products of the piece)_k`.
    fn mix(&self, piece: usize, w: [f64; 3]) -> DVec3 {
        let p = &self.products[2 * piece..2 * piece + 3];
        p[0] * w[0] + p[1] * w[1] + p[2] * w[2]
    }

    /// The gradient of `n · Σ w_k (products of the piece)_k`.
    fn gradient_along(&self, piece: usize, w: [f64; 3], n: DVec3) -> [DVec3; 3] {
        let [x, y, z] = [self.legs[piece], self.legs[piece + 1], self.legs[piece + 2]];
        [
            (y * w[0] + z * w[1]).cross(n),
            n.cross(x * w[0]) + (z * w[2]).cross(n),
            n.cross(x * w[1] + y * w[2]),
        ]
    }

    /// Direction and least value of a leg.
    fn forward(&self, leg: u8) -> (DVec3, f64) {
        let s = self.segment;
        let own = s.span.direction;
        let between = |b: DVec3| (b + own).normalize_or_zero();
        let v = s.speed;
        match leg {
            0 => (s.bisectors[0], v),
            // Where the curve is straight both legs lead along the line, however sharp the turn.
            1 if s.straight[0] => (s.bisectors[0], 0.5 * v),
            3 if s.straight[1] => (s.bisectors[1], 0.5 * v),
            1 => (between(s.bisectors[0]), 0.5 * v),
            2 => (own, 0.5 * v),
            3 => (between(s.bisectors[1]), 0.5 * v),
            _ => (s.bisectors[1], v),
        }
    }

    /// The normal in which the tangent lies on its own side of the chord: `(d0×L)·P`, `(L×d4)·P'`.
    fn between(&self, end: u8) -> DVec3 {
        let (own, n) = (self.segment.span.direction, self.segment.binormals[end as usize]);
        if end == 0 { own.cross(n) } else { n.cross(own) }
    }

    fn deviation_squared(&self) -> f64 {
        self.segment.deviation.map_or(f64::INFINITY, |d| d * d)
    }

    /// A control point, from the nearest place on the chord, over the chord's length; and it is, from
    /// its end of the chord, a mixture of the three legs that begin with `first`.
    fn off_chord(&self, point: u8) -> (usize, [f64; 3], DVec3) {
        let (first, w) = match point {
            1 => (0, [TAU / 3.0, 0.0, 0.0]),
            2 => (0, [TAU / 3.0, T / 3.0, 0.0]),
            3 => (2, [0.0, -T / 3.0, -TAU / 3.0]),
            _ => (2, [0.0, 0.0, -TAU / 3.0]),
        };
        let d = &self.legs[first..first + 3];
        let from_end = d[0] * w[0] + d[1] * w[1] + d[2] * w[2];
        let end = if point > 2 { 1.0 } else { 0.0 };
        (first, w, off_chord(from_end, end, self.segment.span.direction))
    }

    /// `Q'` as a mixture of Bernstein coefficients on a piece.
    fn tangent(&self, piece: usize, mixture: [f64; 3]) -> ([f64; 3], DVec3) {
        let w = combine(&HODOGRAPH[piece], mixture);
        let d = &self.legs[piece..piece + 3];
        (w, d[0] * w[0] + d[1] * w[1] + d[2] * w[2])
    }

    /// The value that has to be positive.
    pub(crate) fn value(&self, row: &Row) -> f64 {
        let value = match row.kind {
            Kind::Omega { piece, coefficient, normal } => {
                let w = OMEGA[piece as usize][coefficient as usize];
                self.mix(piece as usize, w).dot(self.segment.normals[normal as usize])
            }
            Kind::Middle { piece, normal } => {
                let [x, b, y] = self.quadratic(piece, normal, row.factor);
                return b + (x.max(0.0) * y.max(0.0)).sqrt();
            }
            Kind::Side { piece, normal, mixture } => {
                let w = combine(&OMEGA[piece as usize], mixture);
                self.mix(piece as usize, w).dot(self.segment.normals[normal as usize])
            }
            Kind::Turn { end, normal } => {
                let (piece, w) = turn(end);
                self.mix(piece, w).dot(self.segment.binormals[normal as usize])
            }
            Kind::Between { end } => self.legs[if end == 0 { 0 } else { 4 }].dot(self.between(end)),
            Kind::Twist { piece } => {
                let p = piece as usize;
                self.products[2 * p].dot(self.legs[p + 2])
            }
            Kind::Forward { leg } => {
                let (direction, least) = self.forward(leg);
                self.legs[leg as usize].dot(direction) - least
            }
            Kind::Near { point } => {
                let (_, _, off) = self.off_chord(point);
                1.0 - off.length_squared() / self.deviation_squared()
            }
            Kind::Plane { piece, normal, mixture } => {
                let w = combine(&OMEGA[piece as usize], mixture);
                let omega = self.mix(piece as usize, w);
                depth(omega, self.segment.normals[normal as usize], self.rules.cones[0])
            }
            Kind::Line { piece, end, mixture } => {
                let (_, tangent) = self.tangent(piece as usize, mixture);
                depth(tangent, self.segment.bisectors[end as usize], self.rules.cones[1])
            }
        };
        value * row.factor
    }

    /// The Bernstein coefficients of `±ω·n` on a piece, over its size.
    fn quadratic(&self, piece: u8, normal: u8, factor: f64) -> [f64; 3] {
        let n = self.segment.normals[normal as usize] * factor;
        OMEGA[piece as usize].map(|w| self.mix(piece as usize, w).dot(n))
    }

    /// The gradient of the value.
    pub(crate) fn gradient(&self, row: &Row) -> Gradient {
        let factor = row.factor;
        match row.kind {
            Kind::Omega { piece, coefficient, normal } => {
                let (first, n) = (piece as usize, self.segment.normals[normal as usize] * factor);
                let w = OMEGA[first][coefficient as usize];
                Gradient { first, legs: self.gradient_along(first, w, n) }
            }
            Kind::Side { piece, normal, mixture } => {
                let (first, n) = (piece as usize, self.segment.normals[normal as usize] * factor);
                let w = combine(&OMEGA[first], mixture);
                Gradient { first, legs: self.gradient_along(first, w, n) }
            }
            Kind::Middle { piece, normal } => {
                let (first, n) = (piece as usize, self.segment.normals[normal as usize] * factor);
                let [x, _, y] = self.quadratic(piece, normal, factor);
                let ratio = (y / x).sqrt();
                let w = OMEGA[first];
                // ½√(y/x) of the first and ½√(x/y) of the last coefficient, and the middle one.
                let w = std::array::from_fn(|k| {
                    0.5 * ratio * w[0][k] + w[1][k] + 0.5 / ratio * w[2][k]
                });
                Gradient { first, legs: self.gradient_along(first, w, n) }
            }
            Kind::Twist { piece } => {
                let p = piece as usize;
                let [x, y] = [self.legs[p], self.legs[p + 1]];
                let z = self.legs[p + 2];
                let legs = [y.cross(z), z.cross(x), x.cross(y)];
                Gradient { first: p, legs: legs.map(|g| g * factor) }
            }
            Kind::Turn { end, normal } => {
                let (first, w) = turn(end);
                let n = self.segment.binormals[normal as usize] * factor;
                Gradient { first, legs: self.gradient_along(first, w, n) }
            }
            Kind::Between { end } => {
                let mut legs = [DVec3::ZERO; 3];
                legs[if end == 0 { 0 } else { 2 }] = self.between(end) * factor;
                Gradient { first: if end == 0 { 0 } else { 2 }, legs }
            }
            Kind::Forward { leg } => {
                let first = (leg as usize).min(2);
                let mut legs = [DVec3::ZERO; 3];
                legs[leg as usize - first] = self.forward(leg).0 * factor;
                Gradient { first, legs }
            }
            Kind::Near { point } => {
                let (first, w, off) = self.off_chord(point);
                // The nearest place on the chord moves along it, which changes no distance.
                let slope = off * (-2.0 * factor / self.deviation_squared());
                Gradient { first, legs: w.map(|w| slope * w) }
            }
            Kind::Plane { piece, normal, mixture } => {
                let first = piece as usize;
                let w = combine(&OMEGA[first], mixture);
                let n = self.segment.normals[normal as usize];
                let slope = depth_slope(self.mix(first, w), n, self.rules.cones[0]) * factor;
                Gradient { first, legs: self.gradient_along(first, w, slope) }
            }
            Kind::Line { piece, end, mixture } => {
                let (w, tangent) = self.tangent(piece as usize, mixture);
                let line = self.segment.bisectors[end as usize];
                let slope = depth_slope(tangent, line, self.rules.cones[1]) * factor;
                Gradient { first: piece as usize, legs: w.map(|w| slope * w) }
            }
        }
    }

    /// Adds `−multiplier` times the Hessian of the value: what is bilinear in two legs goes into
    /// `normals`, one for each pair of legs, the rest into `terms`.
    pub(crate) fn add_curvature(
        &self,
        row: &Row,
        multiplier: f64,
        normals: &mut [DVec3; 7],
        terms: &mut LegTerms,
    ) {
        let m = -multiplier * row.factor;
        let mut add = |piece: usize, w: [f64; 3], n: DVec3| {
            for k in 0..3 {
                normals[2 * piece + k] += n * w[k];
            }
        };
        match row.kind {
            Kind::Omega { piece, coefficient, normal } => {
                let w = OMEGA[piece as usize][coefficient as usize];
                add(piece as usize, w, self.segment.normals[normal as usize] * m);
            }
            Kind::Side { piece, normal, mixture } => {
                let w = combine(&OMEGA[piece as usize], mixture);
                add(piece as usize, w, self.segment.normals[normal as usize] * m);
            }
            Kind::Middle { piece, normal } => {
                let first = piece as usize;
                let n = self.segment.normals[normal as usize] * row.factor;
                let [x, _, y] = self.quadratic(piece, normal, row.factor);
                let ratio = (y / x).sqrt();
                let c = OMEGA[first];
                let w = std::array::from_fn(|k| {
                    0.5 * ratio * c[0][k] + c[1][k] + 0.5 / ratio * c[2][k]
                });
                add(first, w, n * -multiplier);
                // The Hessian of √(xy) is −¼√(xy) g gᵀ, g = ∇x/x − ∇y/y.
                let w = std::array::from_fn(|k| c[0][k] / x - c[2][k] / y);
                let g = self.gradient_along(first, w, n);
                terms.add_square(first, &g, 0.25 * multiplier * (x * y).sqrt());
            }
            Kind::Near { point } => {
                let (first, w, off) = self.off_chord(point);
                let along = off.dot(self.segment.span.direction);
                // Beside the chord only what is across it counts; beyond its ends, everything.
                let beside = along.abs() <= 1e-12 * off.length();
                let own = self.segment.span.direction;
                let across =
                    if beside { DMat3::IDENTITY - outer(own, own) } else { DMat3::IDENTITY };
                let size = -2.0 * m / self.deviation_squared();
                for i in 0..3 {
                    for j in i..3 {
                        terms.hessian[first + i][first + j] += across * (size * w[i] * w[j]);
                    }
                }
            }
            Kind::Twist { piece } => {
                let p = piece as usize;
                let [x, y, z] = [self.legs[p], self.legs[p + 1], self.legs[p + 2]].map(|d| d * m);
                normals[2 * p] += z;
                normals[2 * p + 1] -= y;
                normals[2 * p + 2] += x;
            }
            Kind::Turn { end, normal } => {
                let (piece, w) = turn(end);
                add(piece, w, self.segment.binormals[normal as usize] * m);
            }
            Kind::Between { .. } | Kind::Forward { .. } => {}
            Kind::Plane { piece, normal, mixture } => {
                let first = piece as usize;
                let w = combine(&OMEGA[first], mixture);
                let (n, k) = (self.segment.normals[normal as usize], self.rules.cones[0]);
                add(first, w, depth_slope(self.mix(first, w), n, k) * m);
                // The Hessian of the depth is 2(k²+1) n nᵀ − 2.
                let along = self.gradient_along(first, w, n);
                terms.add_square(first, &along, 2.0 * (k * k + 1.0) * m);
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let g = self.gradient_along(first, w, axis);
                    terms.add_square(first, &g, -2.0 * m);
                }
            }
            Kind::Line { piece, end, mixture } => {
                let w = combine(&HODOGRAPH[piece as usize], mixture);
                let (n, k) = (self.segment.bisectors[end as usize], self.rules.cones[1]);
                let along = w.map(|w| n * w);
                terms.add_square(piece as usize, &along, 2.0 * (k * k + 1.0) * m);
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    terms.add_square(piece as usize, &w.map(|w| axis * w), -2.0 * m);
                }
            }
        }
    }
}

/// Piece and factors of `ω` at an end of the segment.
fn turn(end: u8) -> (usize, [f64; 3]) {
    if end == 0 { (0, OMEGA[0][0]) } else { (2, OMEGA[2][2]) }
}

/// `k²(w·n)² − ‖w − (w·n)n‖²`.
fn depth(w: DVec3, n: DVec3, k: f64) -> f64 {
    let along = w.dot(n);
    k * k * along * along - (w - n * along).length_squared()
}

fn depth_slope(w: DVec3, n: DVec3, k: f64) -> DVec3 {
    let along = w.dot(n);
    (n * (k * k * along) - (w - n * along)) * 2.0
}

fn combine(coefficients: &[[f64; 3]; 3], mixture: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| (0..3).map(|c| mixture[c] * coefficients[c][k]).sum())
}

/// From the nearest place on a unit chord to a point that is given from one of its ends, which lies at `end`
/// along it.
pub(crate) fn off_chord(from_end: DVec3, end: f64, direction: DVec3) -> DVec3 {
    let along = from_end.dot(direction);
    from_end - direction * (along.clamp(-end, 1.0 - end))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        element::Span,
        energy::Energy,
        rows::rows,
        segment::{Bend, FORWARD},
    };

    fn vector() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from)
    }

    /// A segment of which everything is asked.
    fn segment(normals: [DVec3; 2], bend: Bend) -> Segment {
        let direction = DVec3::new(0.6, 0.0, 0.8);
        Segment {
            span: Span { direction, length: 1.3, spacing: 0.9 },
            bend,
            normals,
            planar: false,
            straight: [false; 2],
            sines: [0.4, 0.7],
            turns: [true; 2],
            pair: -1.0,
            binormals: normals,
            gamma: 0.3,
            torsion: -1.0,
            bisectors: [DVec3::new(0.8, 0.0, 0.6), DVec3::new(0.0, 0.6, 0.8)],
            plane: Some([0.2, 0.6]),
            line: [true; 2],
            deviation: Some(0.3),
            speed: FORWARD,
            energy: Energy::Parametric,
            weight: 1.0,
        }
    }

    proptest! {
        /// Gradient and Hessian of every condition against finite differences.
        #[test]
        fn derivatives_are_those_of_finite_differences(
            legs in proptest::array::uniform5(vector()), step in proptest::array::uniform5(vector()),
            normals in proptest::array::uniform2(vector()), exact in proptest::bool::ANY,
        ) {
            prop_assume!(normals.iter().all(|n| n.length() > 0.2));
            let normals = normals.map(DVec3::normalize);
            let rules = Rules { cones: [0.2, 0.2], exact_middles: exact };
            for bend in [Bend::Free, Bend::Convex, Bend::Inflecting] {
                let segment = segment(normals, bend);
                let mut all = Vec::new();
                (0..3).for_each(|change| rows(&segment, change, &rules, &mut all));
                for row in &all {
                    check(&segment, &rules, row, &legs, &step)?;
                }
            }
        }
    }

    fn check(
        segment: &Segment,
        rules: &Rules,
        row: &Row,
        legs: &Legs,
        step: &Legs,
    ) -> Result<(), TestCaseError> {
        let moved = |h: f64| -> Legs { std::array::from_fn(|k| legs[k] + step[k] * h) };
        let value = |h: f64| Shape::new(segment, rules, &moved(h)).value(row);
        let slope = |h: f64| {
            let legs = moved(h);
            let gradient = Shape::new(segment, rules, &legs).gradient(row);
            let along = &step[gradient.first..gradient.first + 3];
            gradient.legs.iter().zip(along).map(|(g, s)| g.dot(*s)).sum::<f64>()
        };
        let here = Shape::new(segment, rules, legs);
        if let Kind::Middle { piece, normal } = row.kind {
            // Only where both ends hold is there a root.
            let [x, _, y] = here.quadratic(piece, normal, row.factor);
            if x.min(y) < 0.3 {
                return Ok(());
            }
        }
        let h = 1e-5;
        let expected = (value(h) - value(-h)) / (2.0 * h);
        let size = 10.0 + expected.abs();
        prop_assert!((slope(0.0) - expected).abs() < 1e-6 * size, "{:?}", row.kind);
        let (mut products, mut terms) = ([DVec3::ZERO; 7], LegTerms::zero());
        here.add_curvature(row, -1.0, &mut products, &mut terms);
        terms.add_products(&products);
        let mut curvature = 0.0;
        for i in 0..5 {
            for j in 0..5 {
                let block =
                    if i <= j { terms.hessian[i][j] } else { terms.hessian[j][i].transpose() };
                curvature += step[i].dot(block * step[j]);
            }
        }
        let expected = (slope(h) - slope(-h)) / (2.0 * h);
        let size = 100.0 + expected.abs();
        prop_assert!((curvature - expected).abs() < 1e-6 * size, "{:?}", row.kind);
        Ok(())
    }
}
