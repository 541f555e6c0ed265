// SPDX-License-Identifier: MIT OR Apache-2.0

//! From the bytes of an input to numbers, points and options.

use shapespline::prelude::*;

/// Which numbers an input is made of: an input of one kind throughout reaches deeper than one in which
/// every point is a NaN away from being refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Menu {
    /// A coarse lattice: collinear, coplanar, repeated, symmetric.
    Lattice,
    /// Numbers of order one.
    Tame,
    /// Magnitudes from 1e−12 to 1e12 in one input.
    Wide,
    /// Whatever 64 bits can be.
    Raw,
}

/// Reads an input from its front; beyond the end everything is zero.
#[derive(Debug, Clone)]
pub struct Bytes<'a> {
    rest: &'a [u8],
    menu: Menu,
    scale: f64,
}

impl<'a> Bytes<'a> {
    /// The reader of an input; its first two bytes choose the kind and the scale of its numbers.
    #[must_use]
    pub fn new(data: &'a [u8]) -> Self {
        let mut bytes = Self { rest: data, menu: Menu::Tame, scale: 1.0 };
        bytes.menu = [Menu::Lattice, Menu::Tame, Menu::Tame, Menu::Wide, Menu::Raw][bytes.below(5)];
        let scales = [1.0, 1.0, 1.0, 1e100, 1e-100, 1e300, 1e-300, 5e-324, 1e12, 1e-12];
        bytes.scale = scales[bytes.below(scales.len())];
        bytes
    }

    /// Whether the numbers are of order one, or one common scale times it that leaves room for squares.
    #[must_use]
    pub fn is_tame(&self) -> bool {
        matches!(self.menu, Menu::Lattice | Menu::Tame) && (1e-101..1e101).contains(&self.scale)
    }

    /// What is left, as it is.
    #[must_use]
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Whether nothing is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// One byte.
    pub fn byte(&mut self) -> u8 {
        match self.rest.split_first() {
            Some((&byte, rest)) => {
                self.rest = rest;
                byte
            }
            None => 0,
        }
    }

    fn word(&mut self) -> u64 {
        let mut word = [0; 8];
        word.fill_with(|| self.byte());
        u64::from_le_bytes(word)
    }

    /// A whole number below `n` (at most 256).
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// A choice.
    pub fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// In `[0, 1]`, both ends included.
    pub fn fraction(&mut self) -> f64 {
        f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / f64::from(u16::MAX)
    }

    /// A number of the input's kind.
    pub fn number(&mut self) -> f64 {
        self.scale * self.unscaled()
    }

    /// A number of the input's kind without its scale: weights, tensions, slopes.
    pub fn unscaled(&mut self) -> f64 {
        match self.menu {
            Menu::Lattice => f64::from(self.byte() as i8 % 4),
            Menu::Tame => match self.below(4) {
                0 => f64::from(self.byte() as i8 % 4),
                1 => f64::from(self.byte() as i8) * f64::EPSILON,
                _ => 4.0 * self.fraction() - 2.0,
            },
            Menu::Wide => {
                let exponent = i32::from(self.byte() as i8 % 13);
                (2.0 * self.fraction() - 1.0) * 10f64.powi(exponent)
            }
            Menu::Raw => match self.below(4) {
                0 => f64::from(self.byte() as i8),
                1 => {
                    let special = [
                        0.0,
                        -0.0,
                        f64::NAN,
                        f64::INFINITY,
                        f64::NEG_INFINITY,
                        f64::MAX,
                        -f64::MAX,
                        f64::MIN_POSITIVE,
                        5e-324,
                        f64::EPSILON,
                        1.0 + f64::EPSILON,
                        1e16,
                    ];
                    special[self.below(special.len())]
                }
                _ => f64::from_bits(self.word()),
            },
        }
    }

    /// Numbers, as many as asked.
    pub fn numbers(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.number()).collect()
    }

    /// A vector; of the plane where `planar`.
    pub fn vector(&mut self, planar: bool) -> DVec3 {
        let [x, y] = [self.number(), self.number()];
        DVec3::new(x, y, if planar { 0.0 } else { self.number() })
    }

    /// Points, mostly each a step from the one before it: a new step, the last one again (a line), back
    /// again, or a hair beside it.
    pub fn points(&mut self, n: usize, planar: bool) -> Vec<DVec3> {
        let mut points = vec![self.vector(planar)];
        let mut step = DVec3::X * self.scale;
        while points.len() < n {
            let last = points[points.len() - 1];
            match self.below(8) {
                0 => {}
                1 => step *= self.fraction() + 0.25,
                2 => step = -step,
                3 => {
                    let hair = 10f64.powi(-(self.below(17) as i32));
                    step += self.vector(planar) * hair;
                }
                4 => {
                    points.push(self.vector(planar));
                    continue;
                }
                _ => step = self.vector(planar),
            }
            points.push(last + step);
        }
        points
    }

    /// Numbers that mostly increase.
    pub fn increasing(&mut self, n: usize) -> Vec<f64> {
        let mut x = vec![self.number()];
        let honest = self.below(8) != 0;
        while x.len() < n {
            let step = self.number();
            x.push(x[x.len() - 1] + if honest { step.abs() } else { step });
        }
        x
    }

    /// Some choice of parameters for so many points.
    pub fn parametrization(&mut self, n: usize) -> Parametrization {
        match self.below(6) {
            0 => Parametrization::Uniform,
            1 | 2 => Parametrization::Chordal,
            3 => Parametrization::Centripetal,
            // Mostly one that is allowed.
            4 if self.below(8) > 0 => Parametrization::Exponent(self.unscaled().abs() % 1.0),
            4 => Parametrization::Exponent(self.unscaled()),
            _ => {
                let n = if self.below(16) == 0 { self.below(n + 2) } else { n };
                Parametrization::Given(if n == 0 { Vec::new() } else { self.increasing(n) })
            }
        }
    }

    /// Some end conditions.
    pub fn boundary(&mut self, planar: bool) -> Boundary {
        match self.below(6) {
            0 => Boundary::ZeroCurvature,
            1 => Boundary::Periodic,
            2 => Boundary::Circular,
            3 => Boundary::tangents(self.vector(planar), None),
            4 => Boundary::tangents(None, self.vector(planar)),
            _ => Boundary::tangents(self.vector(planar), self.vector(planar)),
        }
    }

    /// A data polygon of up to `most` points, if what the bytes say is one; an error is looked at.
    pub fn polygon(&mut self, most: usize) -> Option<DataPolygon> {
        let planar = self.below(4) == 0;
        let n = self.below(most) + 1;
        let boundary = self.boundary(planar);
        let mut points = self.points(n, planar);
        if boundary == Boundary::Periodic && self.below(8) != 0 {
            points.push(points[0]);
        }
        let parametrization = self.parametrization(points.len());
        let dimension = if planar { Dimension::Two } else { Dimension::Three };
        let polygon = DataPolygon::with_dimension(points, dimension, &parametrization, boundary);
        polygon.inspect_err(super::readable).ok()
    }

    /// Criteria, mostly the default.
    pub fn criteria(&mut self) -> Criteria {
        match self.below(4) {
            0 => Criteria::ALL,
            1 => {
                let chosen = self.byte();
                let bit = |c: &Criterion| chosen >> (*c as usize) & 1 == 1;
                Criterion::ALL.into_iter().filter(bit).collect()
            }
            _ => Criteria::OF_FITS,
        }
    }

    /// Tolerances, mostly the default, sometimes not allowed.
    pub fn tolerances(&mut self) -> Tolerances {
        match self.below(8) {
            0 => Tolerances {
                coplanarity: self.fraction(),
                collinearity: self.fraction(),
                zero: 10f64.powi(-(self.below(20) as i32)),
                resolution: 10f64.powi(self.below(40) as i32 - 30),
            },
            1 => Tolerances {
                coplanarity: self.unscaled(),
                collinearity: self.unscaled(),
                zero: self.unscaled(),
                resolution: self.unscaled(),
            },
            _ => Tolerances::default(),
        }
    }
}
