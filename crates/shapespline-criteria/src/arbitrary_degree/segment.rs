// SPDX-License-Identifier: MIT OR Apache-2.0

//! The curve between two data points as polynomials.

use glam::{DVec3, DVec4};
use shapespline_geometry::BezierPart;
use shapespline_polynomial::Polynomial;

use crate::{Requirements, rounding::LEG_ERROR};

/// The most that a control point is off by, over its distance from the origin: those are known to 15 significant
/// digits, as those of single cubics are. (√3 times what a coordinate is off by.)
const DIGITS: f64 = 1.75 * 0.5 * LEG_ERROR;

/// Parts of a segment shorter than this are rounding: where a part ends at a break, `to` and the break
/// differ by it, and differences of control points of what lies between are zero.
const SLIVER: f64 = 1e-12;

/// A piece of the curve between two data points: `A/w` on `[0, 1]`, where `[0, 1]` is the part
/// `local` of the data segment.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    pub(crate) local: [f64; 2],
    /// `A, A', A'', A'''`.
    a: [Polynomial<DVec3>; 4],
    /// `w, w', w'', w'''`, of a rational curve.
    w: Option<[Polynomial<f64>; 4]>,
    /// Whether `ω` vanishes at the start and at the end by construction.
    straight: [bool; 2],
}

/// The curve between two data points, moved so that it begins at zero, and brought to a size near
/// one: signs do not change by it.
#[derive(Debug, Clone)]
pub(crate) struct Segment {
    pub(crate) pieces: Vec<Piece>,
}

impl Segment {
    /// From the parts of a piecewise Bézier curve; `offset` is the size of what was subtracted from
    /// its control points, whose digits they carry.
    pub(crate) fn new(parts: &[BezierPart], rational: bool, offset: f64) -> Self {
        Self::known_to(parts, rational, |size| DIGITS * (1.0 + offset / size))
    }

    /// From parts whose control points are what is meant, to the last digit.
    pub(crate) fn exact(parts: &[BezierPart], rational: bool) -> Self {
        Self::known_to(parts, rational, |_| 0.0)
    }

    /// From parts whose control points may be off by so much, over their size.
    fn known_to(parts: &[BezierPart], rational: bool, off: impl Fn(f64) -> f64) -> Self {
        let start = parts.first().and_then(|p| p.control.first()).copied();
        let start = start.map_or(DVec3::ZERO, |p| p.truncate() / p.w);
        let all = || parts.iter().flat_map(|p| p.control.iter());
        let weight = all().fold(0.0f64, |m, p| m.max(p.w));
        let moved = |p: &DVec4| (p.truncate() - start * p.w) / weight;
        let size = all().fold(0.0f64, |m, p| m.max(moved(p).abs().max_element()));
        let size = if size > 0.0 { size } else { 1.0 };
        let piece = |part: &BezierPart| {
            let points: Vec<DVec3> = part.control.iter().map(|p| moved(p) / size).collect();
            let error = off(size) + 4.0 * f64::EPSILON;
            let weights = || part.control.iter().map(|p| p.w / weight).collect();
            Piece {
                local: part.local,
                a: derivatives(Polynomial::new(points, error)),
                w: rational.then(|| derivatives(Polynomial::new(weights(), 4.0 * f64::EPSILON))),
                straight: [false; 2],
            }
        };
        Self { pieces: parts.iter().map(piece).collect() }
    }

    /// The same beside segments that are straight by construction, as its requirements say.
    pub(crate) fn beside(mut self, required: Requirements) -> Self {
        if let Some(first) = self.pieces.first_mut() {
            first.straight[0] = required.intersects(Requirements::STRAIGHT_BEFORE);
        }
        if let Some(last) = self.pieces.last_mut() {
            last.straight[1] = required.intersects(Requirements::STRAIGHT_AFTER);
        }
        self
    }

    /// A cubic of given end legs, with the derivatives that the legs give: differences of control points
    /// lose the digits of a leg that is short beside the chord.
    pub(crate) fn cubic([a, c]: [DVec3; 2], chord: DVec3) -> Self {
        let far = [a, chord - c, chord].map(|p| p.abs().max_element());
        let size = far.into_iter().fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        let [a, c, chord] = [a, c, chord].map(|v| v / size);
        let b = chord - a - c;
        let of = |points: &[DVec3], factor: f64| {
            let error = 4.0 * factor * f64::EPSILON;
            Polynomial::new(points.iter().map(|p| *p * factor).collect(), error)
        };
        let derivatives = [
            of(&[DVec3::ZERO, a, chord - c, chord], 1.0),
            of(&[a, b, c], 3.0),
            of(&[b - a, c - b], 6.0),
            of(&[a - 2.0 * b + c], 6.0),
        ];
        Self {
            pieces: vec![Piece {
                local: [0.0, 1.0],
                a: derivatives,
                w: None,
                straight: [false; 2],
            }],
        }
    }

    /// A vector along the tangent at the start (0) or the end (1), and what it may be off by.
    pub(crate) fn end_tangent(&self, end: usize) -> (DVec3, f64) {
        let piece = if end == 0 { self.pieces.first() } else { self.pieces.last() };
        piece.map_or((DVec3::NAN, 0.0), |piece| {
            let tangent = piece.tangent();
            (tangent.ends()[end], tangent.error())
        })
    }

    /// Two segments as one, the second begun where the first ends; the local parameter 0.5 is the
    /// node between them.
    pub(crate) fn joined(first: &Self, second: &Self) -> Self {
        let moved = |piece: &Piece, from: f64| Piece {
            local: piece.local.map(|t| from + 0.5 * t),
            ..piece.clone()
        };
        let pieces = first.pieces.iter().map(|p| moved(p, 0.0));
        Self { pieces: pieces.chain(second.pieces.iter().map(|p| moved(p, 0.5))).collect() }
    }

    /// The pieces in a part of the segment, cut to it.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        let cut = |piece: &Piece| {
            let [start, end] = piece.local;
            let (lo, hi) = (from.max(start), to.min(end));
            (hi - lo > SLIVER)
                .then(|| piece.part((lo - start) / (end - start), (hi - start) / (end - start)))
        };
        Self { pieces: self.pieces.iter().filter_map(cut).collect() }
    }
}

fn derivatives<T: shapespline_polynomial::Coefficient>(p: Polynomial<T>) -> [Polynomial<T>; 4] {
    let first = p.derivative();
    let second = first.derivative();
    let third = second.derivative();
    [p, first, second, third]
}

impl Piece {
    fn part(&self, from: f64, to: f64) -> Self {
        let [start, end] = self.local;
        let outer = |t: f64| start + t * (end - start);
        Self {
            local: [outer(from), outer(to)],
            a: derivatives(self.a[0].part(from, to)),
            w: self.w.as_ref().map(|w| derivatives(w[0].part(from, to))),
            straight: [self.straight[0] && from <= 0.0, self.straight[1] && to >= 1.0],
        }
    }

    /// `A`: positive multiples of the position seen from the segment's start.
    pub(crate) fn position(&self) -> &Polynomial<DVec3> {
        &self.a[0]
    }

    /// `A'`.
    pub(crate) fn velocity(&self) -> &Polynomial<DVec3> {
        &self.a[1]
    }

    /// `A'`, of a polynomial piece.
    pub(crate) fn polynomial_velocity(&self) -> Option<&Polynomial<DVec3>> {
        self.w.is_none().then_some(&self.a[1])
    }

    /// Positive multiples of the tangent.
    pub(crate) fn tangent(&self) -> Polynomial<DVec3> {
        match &self.w {
            None => self.a[1].clone(),
            Some(w) => {
                let kept = self.a[1].product(&w[0], |a, w| a * w);
                kept.plus(&self.a[0].product(&w[1], |a, w| a * w), -1.0)
            }
        }
    }

    /// Positive multiples of `ω = γ' × γ''`. Where it vanishes at an end by construction, and does so to
    /// rounding, that zero is divided out.
    pub(crate) fn omega(&self) -> Polynomial<DVec3> {
        let mut omega = self.whole_omega();
        let vanishes = |omega: &Polynomial<DVec3>, end: usize| {
            self.straight[end] && omega.ends()[end].length() <= omega.error()
        };
        if vanishes(&omega, 0) {
            omega = omega.divided_by_t();
        }
        if vanishes(&omega, 1) {
            omega = omega.divided_by_rest();
        }
        omega
    }

    fn whole_omega(&self) -> Polynomial<DVec3> {
        let cross = |i: usize, j: usize| self.a[i].product(&self.a[j], DVec3::cross);
        match &self.w {
            None => cross(1, 2),
            Some(w) => {
                let times = |v: Polynomial<DVec3>, k: usize| v.product(&w[k], |v, w| v * w);
                let first = times(cross(1, 2), 0).plus(&times(cross(0, 2), 1), -1.0);
                first.plus(&times(cross(0, 1), 2), 1.0)
            }
        }
    }

    /// Whether the piece begins or ends where `ω` vanishes by construction: then its torsion is zero.
    pub(crate) fn is_beside_straight(&self) -> bool {
        self.straight != [false; 2]
    }

    /// Positive multiples of `det[γ', γ'', γ''']`.
    pub(crate) fn determinant(&self) -> Polynomial<f64> {
        let det = |i: usize, j: usize, k: usize| {
            self.a[i].product(&self.a[j], DVec3::cross).product(&self.a[k], DVec3::dot)
        };
        match &self.w {
            None => det(1, 2, 3),
            Some(w) => {
                let times = |p: Polynomial<f64>, k: usize| p.product(&w[k], |p, w| p * w);
                let first = times(det(1, 2, 3), 0).plus(&times(det(0, 2, 3), 1), -1.0);
                let second = times(det(0, 1, 3), 2).plus(&times(det(0, 1, 2), 3), -1.0);
                first.plus(&second, 1.0)
            }
        }
    }

    /// `det[γ', γ'', γ''']` at `t`, derivatives with respect to the segment's local parameter.
    pub(crate) fn twist(&self, t: f64) -> f64 {
        let rate = 1.0 / (self.local[1] - self.local[0]);
        let [position, velocity] = [&self.a[0], &self.a[1]].map(Polynomial::coefficients);
        match (&self.w, velocity, position) {
            // Of a cubic with legs a, c it is 108 det[a, chord, c] everywhere. The product of the
            // derivatives loses the digits of legs that are short beside the chord.
            (None, [a, _, c], [start, _, _, end]) => {
                12.0 * a.cross(end - start).dot(*c) * rate.powi(6)
            }
            _ => {
                let [_, d1, d2, d3] = self.jet(t);
                d1.cross(d2).dot(d3)
            }
        }
    }

    /// `γ − γ(0), γ', γ'', γ'''` at `t`, derivatives with respect to the segment's local parameter.
    pub(crate) fn jet(&self, t: f64) -> [DVec3; 4] {
        let mut g = [0, 1, 2, 3].map(|k| self.a[k].value(t));
        if let Some(w) = &self.w {
            let w = [0, 1, 2, 3].map(|k| w[k].value(t));
            // (wγ)^(k) = A^(k), solved for γ^(k).
            g[0] /= w[0];
            g[1] = (g[1] - g[0] * w[1]) / w[0];
            g[2] = (g[2] - g[1] * (2.0 * w[1]) - g[0] * w[2]) / w[0];
            g[3] = (g[3] - g[2] * (3.0 * w[1]) - g[1] * (3.0 * w[2]) - g[0] * w[3]) / w[0];
        }
        let rate = 1.0 / (self.local[1] - self.local[0]);
        [g[0], g[1] * rate, g[2] * (rate * rate), g[3] * (rate * rate * rate)]
    }
}

/// The turns `u⁻ × u⁺` of unit tangents where pieces meet, with the place and the error.
pub(crate) fn corners(segment: &Segment) -> impl Iterator<Item = (f64, DVec3, f64)> {
    segment.pieces.windows(2).map(|pair| {
        let (before, after) = (pair[0].tangent(), pair[1].tangent());
        let (u, v) = (before.ends()[1], after.ends()[0]);
        let error = before.error() / u.length() + after.error() / v.length();
        let turn = u.normalize_or_zero().cross(v.normalize_or_zero());
        // Pieces that were meant to be smooth meet only to the rounding of their making.
        (pair[1].local[0], turn, error.max(1e-12))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rational quintic: the polynomials have the signs and ratios of the derivatives.
    #[test]
    fn the_numerators_are_multiples_of_the_derivatives() {
        let control: Vec<DVec4> = (0..6)
            .map(f64::from)
            .map(|x| {
                let w = 1.0 + 0.5 * (1.9 * x).sin();
                (DVec3::new((1.3 * x).cos(), (2.1 * x).sin(), 0.4 * x) * w).extend(w)
            })
            .collect();
        let part = BezierPart { control, local: [0.25, 1.0] };
        let segment = Segment::new(&[part], true, 0.0);
        let piece = &segment.pieces[0];
        for k in 0..=20 {
            let t = 0.05 * f64::from(k);
            let [position, d1, d2, d3] = piece.jet(t);
            let along = |v: DVec3, w: DVec3| (v.normalize() - w.normalize()).length();
            assert!(along(piece.tangent().value(t), d1) < 1e-11);
            assert!(along(piece.omega().value(t), d1.cross(d2)) < 1e-9);
            let det = d1.cross(d2).dot(d3);
            assert!(piece.determinant().value(t) * det > 0.0);
            if k > 0 {
                assert!(along(piece.position().value(t), position) < 1e-12);
            }
            // Derivatives by differences of the one before.
            let h = 1e-5;
            for i in 0..3 {
                let difference = (piece.jet(t + h)[i] - piece.jet(t - h)[i]) / (2.0 * h) / 0.75;
                let exact = piece.jet(t)[i + 1];
                assert!((difference - exact).length() < 1e-5 * (1.0 + exact.length()), "{i}");
            }
        }
    }

    /// Legs of 1e−3 to 1e−12 chords: the torsion at both ends keeps its digits.
    #[test]
    fn derivatives_at_the_ends_keep_the_digits_of_short_legs() {
        let chord = DVec3::new(1.0, 0.25, -0.5);
        for k in 3..=12 {
            let a = DVec3::new(0.3, 0.7, 0.2) * 10f64.powi(-k);
            let c = DVec3::new(0.1, -0.4, 0.9) * 10f64.powi(-k);
            let segment = Segment::cubic([a, c], chord);
            // The determinant of the three derivatives is 108 det[a, b, c] at both ends, b = chord − a − c.
            let expected = a.cross(chord).dot(c) * 108.0;
            for t in [0.0, 1.0] {
                let found = segment.pieces[0].twist(t);
                assert!((found / expected - 1.0).abs() < 1e-14, "{k} {t}: {found} {expected}");
            }
        }
    }

    /// Found on a hiking track: a part that ended 1e−15 after a break left a piece without extent, whose
    /// tangent is zero and fails every criterion.
    #[test]
    fn a_part_that_ends_at_a_break_has_no_sliver_beyond_it() {
        let part = |from: f64, local: [f64; 2]| {
            let at = |k: u32| DVec3::new(from + 0.25 * f64::from(k), 0.1, 0.0).extend(1.0);
            BezierPart { control: (0..4).map(at).collect(), local }
        };
        let segment = Segment::new(&[part(0.0, [0.0, 0.25]), part(0.75, [0.25, 1.0])], false, 0.0);
        for to in [0.25, 0.25 + 8e-16, 0.25 - 8e-16] {
            assert_eq!(segment.part(0.0, to).pieces.len(), 1, "{to}");
            assert_eq!(segment.part(to, 1.0).pieces.len(), 1, "{to}");
        }
        assert_eq!(segment.part(0.0, 0.26).pieces.len(), 2);
    }
}
