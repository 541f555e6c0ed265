// SPDX-License-Identifier: MIT OR Apache-2.0

//! Polygons that have been hard for somebody: deterministic, by seed.

use shapespline::prelude::{Boundary, DVec3, DataPolygon, Parametrization};

/// A small deterministic generator (SplitMix64), so that every machine sees the same data.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Generator of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in a range.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// Uniform in the cube `[−1, 1]³`.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0))
    }
}

/// Kinds of random polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolygonKind {
    /// Steps uniform in a cube.
    Walk,
    /// Along a line, off it by 10⁻² to 10⁻¹².
    NearLine,
    /// In a plane, off it by 10⁻² to 10⁻¹².
    NearPlane,
    /// Turns of 180°, exact and nearly so.
    DoublingBack,
    /// Chords from 1 to 10⁶.
    ChordRatios,
    /// Steps to neighbours on a lattice: collinear, coplanar, right angles.
    Lattice,
    /// Planar steps.
    Planar,
    /// A smooth track with kinks.
    Track,
}

impl PolygonKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Walk,
        Self::NearLine,
        Self::NearPlane,
        Self::DoublingBack,
        Self::ChordRatios,
        Self::Lattice,
        Self::Planar,
        Self::Track,
    ];

    /// `n` points; neighbours differ.
    #[must_use]
    pub fn points(self, n: usize, random: &mut Random) -> Vec<DVec3> {
        let off = 10f64.powf(random.within(-12.0, -2.0));
        let mut points = vec![random.vector()];
        let mut step = random.vector();
        for i in 1..n {
            let fresh = random.vector();
            step = match self {
                Self::Walk => fresh,
                Self::NearLine => DVec3::X * random.within(0.1, 1.0) + fresh * off,
                Self::NearPlane => DVec3::new(fresh.x, fresh.y, fresh.z * off),
                Self::DoublingBack if random.below(2) == 0 => -step * random.within(0.2, 1.5),
                Self::DoublingBack if random.below(2) == 0 => -step + fresh * off,
                Self::DoublingBack => fresh,
                Self::ChordRatios => fresh * 10f64.powf(random.within(0.0, 6.0)),
                Self::Lattice => {
                    let axis = [DVec3::X, DVec3::Y, DVec3::Z][random.below(3)];
                    if random.below(2) == 0 { axis } else { -axis }
                }
                Self::Planar => DVec3::new(fresh.x, fresh.y, 0.0),
                Self::Track => {
                    let t = 0.3 * i as f64;
                    let kink = if random.below(8) == 0 { fresh } else { DVec3::ZERO };
                    DVec3::new(t.cos(), t.sin(), 0.4) + kink
                }
            };
            if step == DVec3::ZERO {
                step = DVec3::X;
            }
            points.push(points[i - 1] + step);
        }
        points
    }
}

/// A polygon of a kind; the case chooses boundary and parametrisation. `None` where a walk happens to
/// step back onto its neighbour.
#[must_use]
pub fn polygon(kind: PolygonKind, case: usize, random: &mut Random) -> Option<DataPolygon> {
    let n = 2 + random.below(50);
    let mut points = kind.points(n, random);
    let boundary = match case % 4 {
        0 if n > 2 => Boundary::Circular,
        1 if n > 2 => {
            if points[n - 1] != points[0] {
                points.push(points[0]);
            }
            Boundary::Periodic
        }
        2 => Boundary::tangents(random.vector(), random.vector()),
        _ => Boundary::ZeroCurvature,
    };
    let parametrization = match case % 3 {
        0 => Parametrization::Uniform,
        1 => Parametrization::Chordal,
        _ => Parametrization::Centripetal,
    };
    DataPolygon::new(points, &parametrization, boundary).ok()
}
