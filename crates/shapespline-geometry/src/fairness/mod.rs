// SPDX-License-Identifier: MIT OR Apache-2.0

//! How fair a curve is: length, bending energy, variation and extrema of its curvature.
//!
//! Extrema of curvature are the sign changes of a polynomial (for a cubic of degree five in the plane
//! and seven in space), isolated by Bernstein subdivision with an error bound; nothing is sampled.
//! The integrals are taken between them, by adaptive quadrature, so that no peak is missed.
//!
//! Sources: G. Farin, N. Sapidis, *Curvature and the fairness of curves and surfaces*, IEEE Computer
//! Graphics and Applications 9 (1989) 52–57, doi:10.1109/38.19051 (few and small extrema of curvature);
//! H. P. Moreton, C. H. Séquin, *Functional optimization for fair surface design*, Computer Graphics 26
//! (1992) 167–176, doi:10.1145/133994.134035 (the variation of curvature).

mod extrema;
mod largest;
mod piece;

use std::ops::ControlFlow;

use glam::DVec3;
use shapespline_polynomial::parallel;

use crate::{Dimension, PiecewiseBezier, vector::power_of_two};
use extrema::Extrema;
use piece::{End, Piece};

/// Directions that differ by less than this angle, in radians, meet smoothly.
const SMOOTH: f64 = 1e-6;

/// Curvatures that differ by less than this part of themselves are continuous.
const CONTINUOUS: f64 = 1e-9;

/// Curves of this many pieces are measured on all threads.
const MANY: usize = 8192;

/// A place on a piecewise curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the piece.
    pub piece: usize,
    /// Local parameter in `[0, 1]`.
    pub t: f64,
}

/// A place where curvature stops rising or falling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvatureExtremum {
    /// Where it is; at a jump of curvature the end of the piece before it.
    pub place: Place,
    /// The curvature there, of a planar curve with its sign (positive to the left).
    pub curvature: f64,
    /// Whether it is a maximum.
    pub is_maximum: bool,
}

/// The measures of fairness of one curve. All but `length` and `max_curvature` are free of scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Fairness {
    /// Arc length `L`.
    pub length: f64,
    /// `L ∫κ² ds`: infinite at corners and cusps.
    pub bending: f64,
    /// What each piece adds to it.
    pub bending_of_pieces: Vec<f64>,
    /// `L³ ∫(κ'² + κ²τ²) ds`, derivatives by arc length (in the plane `κ'²`): zero for lines and circles,
    /// infinite where the curvature vector jumps.
    pub variation: f64,
    /// The largest curvature, per unit of length: infinite at corners and cusps.
    pub max_curvature: f64,
    /// Where it is attained.
    pub max_curvature_at: Place,
    /// The extrema of curvature inside the curve, in order: of planar curves those of signed curvature.
    pub extrema: Vec<CurvatureExtremum>,
    /// `L` times the largest jump of the curvature vector at a break.
    pub max_curvature_jump: f64,
    /// Places where the speed vanishes, to rounding.
    pub cusps: Vec<Place>,
    /// Breaks (`k` between the pieces `k − 1` and `k`) where position or direction jumps.
    pub corners: Vec<usize>,
}

/// The measures of fairness of a curve of any degree, rational or not. Cost O(N).
///
/// Curvature, jumps and directions that rounding cannot tell apart count as equal: a break is a corner
/// where directions differ by more than 1e−6 rad, and curvature jumps by more than 1e−9 of itself.
#[must_use]
pub fn fairness(curve: &PiecewiseBezier) -> Fairness {
    let unit = unit_of(curve);
    let measured = pieces_of(curve, unit, &|| ControlFlow::Continue(()));
    Summary::of(&measured.unwrap_or_default()).in_units_of(unit)
}

/// As [`fairness`], but calls `go_on` before each piece (from any thread), and returns `None` once that
/// breaks.
#[must_use]
pub fn fairness_with(
    curve: &PiecewiseBezier,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Option<Fairness> {
    let unit = unit_of(curve);
    Some(Summary::of(&pieces_of(curve, unit, go_on)?).in_units_of(unit))
}

fn pieces_of(
    curve: &PiecewiseBezier,
    unit: f64,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Option<Vec<Measured>> {
    let measure = |i: usize| go_on().is_continue().then(|| measure(curve, i, unit));
    parallel::map(curve.pieces(), MANY, measure)
}

/// A power of two near the largest extent of a piece, so that nothing overflows.
fn unit_of(curve: &PiecewiseBezier) -> f64 {
    let extent = |i: usize| {
        let place = |k: usize| curve.piece(i)[k].truncate() / curve.piece(i)[k].w;
        (1..=curve.degree()).map(|k| (place(k) - place(0)).abs().max_element()).fold(0.0, f64::max)
    };
    let largest = (0..curve.pieces()).map(extent).fold(0.0, f64::max);
    if largest > 0.0 { power_of_two(largest) } else { 1.0 }
}

/// What is known of one piece, in units.
struct Measured {
    /// Where it begins and ends.
    places: [DVec3; 2],
    ends: [End; 2],
    extrema: Extrema,
    /// Curvature at the extrema.
    curvatures: Vec<f64>,
    cusp: Option<f64>,
    /// Length, bending, variation.
    integrals: [f64; 3],
    planar: bool,
}

fn measure(curve: &PiecewiseBezier, i: usize, unit: f64) -> Measured {
    let points = curve.piece(i);
    let place = |k: usize| points[k].truncate() / points[k].w / unit;
    let origin = points[0].truncate() / points[0].w;
    let scaled = |p: &glam::DVec4| ((p.truncate() - origin * p.w) / unit).extend(p.w);
    let planar = curve.dimension() == Dimension::Two;
    let piece = Piece::new(points.iter().map(scaled).collect(), curve.is_rational(), planar)
        .moved(origin.length() / unit);
    let (extrema, cusp) = (piece.extrema(), piece.cusp());
    let mut cuts: Vec<f64> =
        [0.0, 1.0].into_iter().chain(extrema.at.iter().copied()).chain(cusp).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut integrals = piece.integrals(&cuts);
    if cusp.is_some() {
        integrals[1..].fill(f64::INFINITY);
    }
    Measured {
        places: [place(0), place(points.len() - 1)],
        ends: [piece.end(0.0), piece.end(1.0)],
        curvatures: extrema.at.iter().map(|&t| piece.curvature(t)).collect(),
        extrema,
        cusp,
        integrals,
        planar,
    }
}

/// The sums over the pieces so far.
struct Summary {
    fairness: Fairness,
    /// Whether curvature rises at the end of what was seen, and at its beginning.
    rising: Option<bool>,
    rises_first: Option<bool>,
}

impl Summary {
    fn of(pieces: &[Measured]) -> Fairness {
        let fairness = Fairness {
            length: 0.0,
            bending: 0.0,
            bending_of_pieces: pieces.iter().map(|piece| piece.integrals[1]).collect(),
            variation: 0.0,
            max_curvature: 0.0,
            max_curvature_at: Place { piece: 0, t: 0.0 },
            extrema: Vec::new(),
            max_curvature_jump: 0.0,
            cusps: Vec::new(),
            corners: Vec::new(),
        };
        let mut summary = Self { fairness, rising: None, rises_first: None };
        for (i, piece) in pieces.iter().enumerate() {
            if i > 0 {
                summary.add_break(i, &pieces[i - 1], piece);
            }
            summary.add_piece(i, piece);
        }
        if let [first, .., last] = pieces
            && last.meets(first)
        {
            // A closed curve goes on: its seam is a break like others.
            summary.add_break(pieces.len(), last, first);
            if let Some(rising) = summary.rises_first {
                summary.turn(Place { piece: pieces.len() - 1, t: 1.0 }, first.start(), rising);
            }
        }
        summary.fairness
    }

    fn add_piece(&mut self, i: usize, piece: &Measured) {
        let f = &mut self.fairness;
        f.length += piece.integrals[0];
        f.bending += piece.integrals[1];
        f.variation += piece.integrals[2];
        if let Some(t) = piece.cusp {
            f.cusps.push(Place { piece: i, t });
            self.at_most(Place { piece: i, t }, f64::INFINITY);
        }
        for (t, end) in [0.0, 1.0].into_iter().zip(&piece.ends) {
            self.at_most(Place { piece: i, t }, end.curvature.length());
        }
        for (k, &rising) in piece.extrema.rising.iter().enumerate() {
            // Before the first change is the beginning of the piece.
            let (t, curvature) = match k {
                0 => (0.0, piece.start()),
                k => (piece.extrema.at[k - 1], piece.curvatures[k - 1]),
            };
            let place = Place { piece: i, t };
            self.at_most(place, curvature.abs());
            self.turn(place, curvature, rising);
        }
    }

    /// Curvature and direction on both sides of a break.
    fn add_break(&mut self, i: usize, before: &Measured, after: &Measured) {
        let [a, b] = [before.ends[1], after.ends[0]];
        let place = Place { piece: i - 1, t: 1.0 };
        if !before.meets(after) {
            self.fairness.corners.push(i);
            self.at_most(place, f64::INFINITY);
            self.fairness.max_curvature_jump = f64::INFINITY;
            (self.fairness.bending, self.fairness.variation) = (f64::INFINITY, f64::INFINITY);
            return;
        }
        let jump = (b.curvature - a.curvature).length();
        let size = a.curvature.length().max(b.curvature.length());
        if jump > CONTINUOUS * size + a.error + b.error {
            let f = &mut self.fairness;
            f.max_curvature_jump = f.max_curvature_jump.max(jump);
            f.variation = f64::INFINITY;
            let [from, to] = [before.signed(&a), after.signed(&b)];
            if from != to {
                self.turn(place, from, to > from);
            }
        }
    }

    fn at_most(&mut self, place: Place, curvature: f64) {
        if curvature > self.fairness.max_curvature {
            (self.fairness.max_curvature, self.fairness.max_curvature_at) = (curvature, place);
        }
    }

    /// From a place on curvature rises, or falls.
    fn turn(&mut self, place: Place, curvature: f64, rising: bool) {
        if self.rising.is_some_and(|before| before != rising) {
            self.fairness.extrema.push(CurvatureExtremum { place, curvature, is_maximum: !rising });
        }
        self.rising = Some(rising);
        self.rises_first = self.rises_first.or(self.rising);
    }
}

impl Measured {
    /// Whether another piece goes on where this one ends, in the same direction.
    fn meets(&self, next: &Self) -> bool {
        let gap = (next.places[0] - self.places[1]).length();
        let [a, b] = [self.ends[1].direction, next.ends[0].direction];
        gap <= CONTINUOUS * (self.integrals[0] + next.integrals[0])
            && a.cross(b).length() <= SMOOTH
            && a.dot(b) > 0.0
    }

    /// Curvature at the beginning.
    fn start(&self) -> f64 {
        self.signed(&self.ends[0])
    }

    /// Curvature at an end, of a planar curve with its sign.
    fn signed(&self, end: &End) -> f64 {
        if self.planar { end.direction.cross(end.curvature).z } else { end.curvature.length() }
    }
}

impl Fairness {
    /// The measures in units of the curve, from those in units of `unit`.
    fn in_units_of(mut self, unit: f64) -> Self {
        let length = self.length;
        let of_pieces = self.bending_of_pieces.iter_mut().map(|bending| (bending, length));
        // Infinite stays infinite, also where all points are one.
        for (measure, power) in of_pieces.chain([
            (&mut self.bending, length),
            (&mut self.variation, length.powi(3)),
            (&mut self.max_curvature_jump, length),
        ]) {
            if measure.is_finite() {
                *measure *= power;
            }
        }
        self.length = length * unit;
        self.max_curvature /= unit;
        self.extrema.iter_mut().for_each(|extremum| extremum.curvature /= unit);
        self
    }
}

#[cfg(test)]
mod tests;

pub use largest::largest_curvature;
