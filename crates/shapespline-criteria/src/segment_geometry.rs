// SPDX-License-Identifier: MIT OR Apache-2.0

//! A segment and the polygon around it, as the conditions see them: products of legs, and how far each may be
//! off.

use glam::DVec3;
use shapespline_geometry::normalized_scale;

use crate::{
    cone::{Axis, Field, Quadratic},
    rounding::{Rounded, UNIT, leg_error, sum},
};

/// A segment and the polygon around it, as the conditions see them: all products of legs at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SegmentGeometry {
    /// End legs and chord, brought to a common scale near one.
    pub(crate) a: DVec3,
    pub(crate) c: DVec3,
    pub(crate) chord: DVec3,
    /// `a×b`, `a×c`, `b×c`.
    pub(crate) omega: [DVec3; 3],
    /// Binormal vectors of unit chords at the two nodes.
    pub(crate) p: DVec3,
    pub(crate) q: DVec3,
    /// Those at the nodes beside them.
    pub(crate) before: DVec3,
    pub(crate) after: DVec3,
    /// How far each coordinate of `a, c` and `chord` may be off.
    pub(crate) slack: f64,
}

impl SegmentGeometry {
    /// With the binormal vectors at the node before, at the two nodes of the segment, and at the node
    /// after; `far`: the largest coordinate of the two end points.
    #[inline]
    pub(crate) fn new(legs: [DVec3; 2], chord: DVec3, binormals: [DVec3; 4], far: f64) -> Self {
        let size = chord.abs().max_element();
        let (legs, chord) = normalized_scale(legs, chord);
        // In the unit that the legs have now, which is mostly the one they had.
        let far = far / size * chord.abs().max_element();
        let slack = leg_error(far, sum(legs[0]) + sum(chord) + sum(legs[1]));
        Self::of_scaled(legs, chord, binormals, slack)
    }

    /// The same of legs and chord [near one](normalized_scale) in size.
    #[inline(always)]
    pub(crate) fn of_scaled(
        [a, c]: [DVec3; 2],
        chord: DVec3,
        [before, p, q, after]: [DVec3; 4],
        slack: f64,
    ) -> Self {
        // With b = L − a − c: a×b = a×L − a×c, b×c = L×c − a×c.
        let middle = a.cross(c);
        let omega = [a.cross(chord) - middle, middle, chord.cross(c) - middle];
        Self { a, c, chord, omega, p, q, before, after, slack }
    }

    /// `ω·n` as `[α, γ, β]` of Lemma 5.1.
    #[inline(always)]
    pub(crate) fn omega_along(&self, n: DVec3) -> [f64; 3] {
        let [first, middle, last] = self.omega;
        [first.dot(n), middle.dot(n), last.dot(n)]
    }

    /// `det[a, b, c]`: with b = L − a − c it is `det[a, L, c]`.
    #[inline(always)]
    pub(crate) fn determinant(&self) -> f64 {
        self.a.cross(self.chord).dot(self.c)
    }

    /// `ω` in Bernstein form.
    pub(crate) fn omega_quadratic(&self) -> Quadratic {
        let [first, middle, last] = self.omega;
        [first, middle * 0.5, last]
    }

    /// `γ'` in Bernstein form, less a factor 3.
    pub(crate) fn tangent_quadratic(&self) -> Quadratic {
        [self.a, self.chord - self.a - self.c, self.c]
    }

    /// `ω` and how far it may be off.
    pub(crate) fn omega_field(&self) -> Field {
        let [first, middle, last] = self.omega_errors();
        Field::new(self.omega_quadratic(), [first, 0.5 * middle, last])
    }

    /// `γ'` likewise. A leg that is zero stays zero, however its control points are rounded.
    pub(crate) fn tangent_field(&self) -> Field {
        let own = |leg: DVec3| if leg == DVec3::ZERO { 0.0 } else { self.slack };
        let sums = sum(self.a) + sum(self.chord) + sum(self.c);
        let middle = 3.0 * self.slack + 3.0 * UNIT * sums;
        Field::new(self.tangent_quadratic(), [own(self.a), middle, own(self.c)])
    }

    /// Direction of a binormal vector, and how far it may be off.
    pub(crate) fn plane_axis(direction: DVec3, binormal: DVec3) -> Axis {
        Axis { direction, off: 12.0 * UNIT / binormal.length() + 4.0 * UNIT }
    }
}

impl SegmentGeometry {
    /// `A, Λ, C`, enlarged.
    #[inline(always)]
    fn sums(&self) -> [f64; 3] {
        let off = 3.0 * self.slack;
        [sum(self.a) + off, sum(self.chord) + off, sum(self.c) + off]
    }

    /// How far each coordinate of `a×b`, `a×c`, `b×c` may be off: nothing where every product in it is
    /// zero, as of legs along one axis, for coordinates that are equal are rounded alike.
    #[inline(always)]
    pub(crate) fn omega_errors(&self) -> [f64; 3] {
        let ([a, chord, c], e) = (self.sums(), self.slack);
        let first = 4.0 * UNIT * a * (chord + c) + e * (chord + c + 2.0 * a);
        let middle = 3.0 * UNIT * a * c + e * (a + c);
        let last = 4.0 * UNIT * c * (chord + a) + e * (chord + a + 2.0 * c);
        let vanishes = |omega: DVec3, own: DVec3, other: DVec3| {
            omega == DVec3::ZERO && has_no_products(own, self.chord) && has_no_products(own, other)
        };
        [
            if vanishes(self.omega[0], self.a, self.c) { 0.0 } else { first },
            middle,
            if vanishes(self.omega[2], self.c, self.a) { 0.0 } else { last },
        ]
    }

    /// `ω·n` as `[α, γ, β]`.
    pub(crate) fn omega_signs(&self, n: DVec3) -> [Rounded; 3] {
        let (off, size) = (self.omega_errors(), sum(n) + 20.0 * UNIT);
        [0, 1, 2].map(|k| {
            let (omega, own) = (self.omega[k], 10.0 * UNIT * sum(self.omega[k]));
            Rounded { value: omega.dot(n), error: off[k] * size + own }
        })
    }

    /// `det[a, b, c] = det[a, L, c]`.
    pub(crate) fn rounded_determinant(&self) -> Rounded {
        let [a, chord, c] = self.sums();
        // a×L = ω(0) + a×c.
        let products = sum(self.omega[0]) + 3.0 * sum(self.omega[1]) + sum(self.omega[2]);
        let products = products + 3.0 * self.slack * (a + chord + c);
        let value = self.determinant();
        let error = 6.0 * UNIT * a * chord * c + self.slack * products;
        Rounded { value, error: if value == 0.0 && self.is_flat() { 0.0 } else { error } }
    }

    /// Whether every product in `det[a, L, c]` is zero.
    fn is_flat(&self) -> bool {
        let flat = |axis: fn(DVec3) -> f64| [self.a, self.chord, self.c].map(axis) == [0.0; 3];
        let pairs = [(self.a, self.chord), (self.chord, self.c), (self.a, self.c)];
        flat(|v| v.x)
            || flat(|v| v.y)
            || flat(|v| v.z)
            || pairs.into_iter().any(|(u, v)| has_no_products(u, v))
    }
}

/// Whether every product in `u×v` is zero.
fn has_no_products(u: DVec3, v: DVec3) -> bool {
    let [u, v] = [u, v].map(|v| v.to_array().map(|x| x != 0.0));
    !(0..3).any(|i| u[i] && (v[(i + 1) % 3] || v[(i + 2) % 3]))
}
