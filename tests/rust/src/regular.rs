// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long regular polygons: what repeats itself fails everywhere at once, or one repeat after the other.

use shapespline::prelude::*;

use crate::generate::Random;

/// Kinds of regular polygon: the same few steps over and over, except for the last two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regular {
    /// Three steps in space whose mirror images are each other's: margins of zero in the middle.
    Zigzag,
    /// Up and down by turns along both axes across: split coplanarity on every other segment.
    Lattice,
    /// Up and down in the plane.
    PlanarZigzag,
    /// Once round a square, rising a little with each step.
    Helix,
    /// Once round a square on the lattice, up between two sides.
    LatticeHelix,
    /// Two steps forward, one up.
    Stairs,
    /// Along each axis by turns.
    SpaceStairs,
    /// A tool path: long rows, short steps between.
    Raster,
    /// Rows of two.
    Meander,
    /// Long teeth.
    Comb,
    /// Out to both sides of a line, by turns in two planes.
    Battlement,
    /// Steps from a generator, as often as asked for.
    Cycle(u64),
    /// A square spiral: rows that grow.
    Spiral,
    /// Hilbert's curve.
    Hilbert,
}

impl Regular {
    /// All kinds, with a few cycles.
    pub const ALL: [Self; 16] = [
        Self::Zigzag,
        Self::Lattice,
        Self::PlanarZigzag,
        Self::Helix,
        Self::LatticeHelix,
        Self::Stairs,
        Self::SpaceStairs,
        Self::Raster,
        Self::Meander,
        Self::Comb,
        Self::Battlement,
        Self::Cycle(5),
        Self::Cycle(7),
        Self::Cycle(8),
        Self::Spiral,
        Self::Hilbert,
    ];

    /// The steps of a period, if there is one.
    #[must_use]
    pub fn period(self) -> Option<Vec<DVec3>> {
        const ROW: usize = 40;
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        Some(match self {
            Self::Zigzag => vec![-x - z, -y - z, x + y],
            Self::Lattice => vec![x + y, x - y + z, x + y, x - y - z],
            Self::PlanarZigzag => vec![x + y, x - y],
            Self::Helix => [x, y, -x, -y].map(|step| step + z / 4.0).to_vec(),
            Self::LatticeHelix => vec![x, y, z, -x, -y, z],
            Self::Stairs => vec![x, x, y],
            Self::SpaceStairs => vec![x, y, z],
            Self::Raster => [vec![x; ROW], vec![y], vec![-x; ROW], vec![y]].concat(),
            Self::Meander => vec![x, x, y, -x, -x, y],
            Self::Comb => vec![x, 5.0 * y, x, -5.0 * y],
            Self::Battlement => vec![x, y, x, z, x, -y, x, -z],
            Self::Cycle(seed) => {
                let mut random = Random::new(seed);
                let count = 3 + seed as usize % 6;
                let step = |_| (random.vector() * 3.0).round() + 0.1;
                (0..count).map(step).collect()
            }
            Self::Spiral | Self::Hilbert => return None,
        })
    }

    /// `n` points.
    #[must_use]
    pub fn points(self, n: usize) -> Vec<DVec3> {
        let mut p = DVec3::ZERO;
        let mut walk = |step: DVec3| {
            p += step;
            p
        };
        match self.period() {
            Some(steps) => steps.into_iter().cycle().take(n).map(walk).collect(),
            None if self == Self::Hilbert => (0..n).map(hilbert).collect(),
            None => {
                let sides = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].into_iter().cycle();
                let rows = sides.enumerate();
                rows.flat_map(|(k, step)| vec![step; 1 + k / 2]).take(n).map(&mut walk).collect()
            }
        }
    }

    /// `n` points that go back by another way to where they began, and the first one again.
    #[must_use]
    pub fn closed(self, n: usize) -> Vec<DVec3> {
        let mut points = self.points(n);
        let (first, last) = (points[0], points[n - 1]);
        let side = DVec3::new(-3.0, -7.0, if self.is_planar() { 0.0 } else { -5.0 });
        points.extend([last + side, (first + last) / 2.0 + 2.0 * side, first + side, first]);
        points
    }

    /// Whether all points lie in the plane z = 0.
    #[must_use]
    pub fn is_planar(self) -> bool {
        self.points(100).iter().all(|p| p.z == 0.0)
    }

    /// The polygon of `n` points, or of a few more where it is to be closed.
    #[must_use]
    pub fn polygon(self, n: usize, names: &Parametrization, boundary: Boundary) -> DataPolygon {
        let closed = boundary == Boundary::Periodic;
        let points = if closed { self.closed(n) } else { self.points(n) };
        let dimension = if self.is_planar() { Dimension::Two } else { Dimension::Three };
        DataPolygon::with_dimension(points, dimension, names, boundary).unwrap()
    }
}

/// Point number `k` of Hilbert's curve on the lattice.
fn hilbert(k: usize) -> DVec3 {
    let (mut x, mut y) = (0, 0);
    // Enough for 4^16 points.
    for level in 0..16 {
        let (side, two) = (1_usize << level, k >> (2 * level) & 3);
        let [right, up] = [two >> 1, (two ^ two >> 1) & 1];
        if up == 0 {
            if right == 1 {
                (x, y) = (side - 1 - x, side - 1 - y);
            }
            (x, y) = (y, x);
        }
        (x, y) = (x + side * right, y + side * up);
    }
    DVec3::new(x as f64, y as f64, 0.0)
}
