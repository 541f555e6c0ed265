// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the data ask of each segment: chords, normals, signs, in units of mean chord and mean speed one.

use glam::DVec3;
use shapespline_criteria::{Checker, Requirements, inflection_parameter};
use shapespline_geometry::{Dimension, length, normalize};

use crate::{Constraints, element::Span, energy::Energy, runs::Runs, units::Units};

/// Turns above 163° (`‖l + l'‖` at most this) have no forward direction.
const SHARPEST: f64 = 0.3;

/// Least speed forward that is asked for first.
pub(crate) const FORWARD: f64 = 0.1;

/// What binormal vectors of a segment ask of `ω`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bend {
    /// Nothing.
    Free,
    /// No change of sign along either normal.
    Convex,
    /// One change along each, from + to − (the second normal is reversed).
    Inflecting,
}

/// A segment and what is asked of it.
#[derive(Debug, Clone)]
pub(crate) struct Segment {
    pub(crate) span: Span,
    pub(crate) bend: Bend,
    /// Unit normals along which `ω` is to be positive (at the start, where it inflects).
    pub(crate) normals: [DVec3; 2],
    /// Whether both normals are the same, as in the plane.
    pub(crate) planar: bool,
    /// Sines of the turning angles at the two nodes.
    pub(crate) sines: [f64; 2],
    /// Whether `ω` vanishes at each node by construction.
    pub(crate) straight: [bool; 2],
    /// Whether the turn at each node is asked for.
    pub(crate) turns: [bool; 2],
    /// Sign of the turn asked for at each node along the binormal of the other, where neither convexity
    /// nor inflection asks for it; or 0.
    pub(crate) pair: f64,
    /// Unit binormals at the two nodes, not reversed.
    pub(crate) binormals: [DVec3; 2],
    /// `det` of the unit chords around.
    pub(crate) gamma: f64,
    /// Sign of torsion asked for, or 0.
    pub(crate) torsion: f64,
    /// Forward at the two nodes: the unit bisectors of the chords, or the directions of given tangents and of
    /// straight runs; zero where the polygon turns back.
    pub(crate) bisectors: [DVec3; 2],
    /// Parts of the segment on which `ω` stays near the normals.
    pub(crate) plane: Option<[f64; 2]>,
    /// Whether the tangent stays near the chord in the first and in the second half.
    pub(crate) line: [bool; 2],
    /// How far control points may lie from the chord, over its length.
    pub(crate) deviation: Option<f64>,
    /// Least speed forward, over that of the chord.
    pub(crate) speed: f64,
    /// What is minimised.
    pub(crate) energy: Energy,
    /// Weight in the barrier: `sin²θ/length` of the largest turn nearby.
    pub(crate) weight: f64,
}

/// What the segments of a polygon are asked, one by one.
#[derive(Debug)]
pub(crate) struct Demands<'a> {
    pub(crate) checker: &'a Checker<'a>,
    pub(crate) units: Units,
    pub(crate) constraints: &'a Constraints,
    pub(crate) runs: &'a Runs,
}

impl Demands<'_> {
    pub(crate) fn span(&self, i: usize) -> Span {
        let polygon = self.checker.polygon();
        Span {
            direction: polygon.direction(i),
            length: length(polygon.chord(i)) / self.units.length,
            spacing: polygon.spacing(i) / self.units.time,
        }
    }

    /// Largest sine of a turn at the nodes of segment `i`.
    fn sine(&self, i: usize) -> f64 {
        let [p, q] = self.checker.polygon().binormals(i);
        p.length().max(q.length())
    }

    /// Whether a segment is convex, inflects, or neither.
    pub(crate) fn bend(&self, i: usize) -> Bend {
        let required = self.checker.requirements()[i];
        if required.intersects(Requirements::CONVEXITY) {
            Bend::Convex
        } else if required.intersects(Requirements::INFLECTION) {
            Bend::Inflecting
        } else {
            Bend::Free
        }
    }

    /// Whether the sign of `ω` at one end of a segment along the binormal of the other is asked for.
    pub(crate) fn asks_pair(&self, i: usize) -> bool {
        self.bend(i) != Bend::Free
            || self.checker.requirements()[i].intersects(Requirements::TURNING_PAIR)
    }

    /// Sign of the torsion asked for, or 0.
    pub(crate) fn torsion(&self, i: usize) -> f64 {
        let required = self.checker.requirements()[i];
        f64::from(u8::from(required.intersects(Requirements::RIGHT_TORSION)))
            - f64::from(u8::from(required.intersects(Requirements::LEFT_TORSION)))
    }

    /// `det` of the unit chords around a segment.
    pub(crate) fn gamma(&self, i: usize) -> f64 {
        self.checker.polygon().gamma(i)
    }

    /// Whether coplanarity is asked for.
    pub(crate) fn is_coplanar(&self, i: usize) -> bool {
        self.checker.requirements()[i]
            .intersects(Requirements::COPLANARITY.union(Requirements::SPLIT_COPLANARITY))
    }

    /// Whether coplanarity is asked for on both sides of an inflection.
    pub(crate) fn is_split(&self, i: usize) -> bool {
        self.checker.requirements()[i].intersects(Requirements::SPLIT_COPLANARITY)
    }

    /// How far control points of a segment may lie from its chord, over the chord's length.
    pub(crate) fn deviation(&self, i: usize) -> Option<f64> {
        let chord = length(self.checker.polygon().chord(i));
        self.constraints.max_deviation.map(|most| most / chord)
    }

    pub(crate) fn segment(&self, i: usize) -> Segment {
        let polygon = self.checker.polygon();
        let required = self.checker.requirements()[i];
        let n = polygon.segments();
        let [p, q] = polygon.binormals(i);
        let [before, own, after] = polygon.directions_around(i);
        // Forward at a node: between the chords, or where a tangent is given, along that.
        let forward = |node: usize, tangent: Option<DVec3>, [a, b]: [DVec3; 2]| {
            let direction = self.constraints.direction(node % polygon.nodes()).or(tangent);
            let sum = a + b;
            match direction {
                _ if sum.length() <= SHARPEST => DVec3::ZERO,
                Some(direction) => direction,
                None => sum.normalize(),
            }
        };
        let lines = [i, (i + 1) % polygon.nodes()].map(|node| self.runs.line(node));
        let [at_start, at_end] = polygon.tangents();
        let given = [
            at_start.filter(|_| i == 0).map(|_| before),
            at_end.filter(|_| i + 1 == n).map(|_| after),
        ];
        let bend = self.bend(i);
        let end = if bend == Bend::Inflecting { -normalize(q) } else { normalize(q) };
        let neighbours = if polygon.is_closed() {
            [(i + n - 1) % n, (i + 1) % n]
        } else {
            [i.saturating_sub(1), (i + 1).min(n - 1)]
        };
        let sine = neighbours.into_iter().fold(self.sine(i), |m, k| m.max(self.sine(k)));
        let span = self.span(i);
        Segment {
            span,
            bend,
            normals: [normalize(p), end],
            binormals: [normalize(p), normalize(q)],
            planar: polygon.dimension() == Dimension::Two,
            sines: [p.length(), q.length()],
            straight: lines.map(|line| line.is_some()),
            turns: [Requirements::TURNING_AT_START, Requirements::TURNING_AT_END]
                .map(|at| required.intersects(at)),
            pair: if bend == Bend::Free && required.intersects(Requirements::TURNING_PAIR) {
                p.dot(q).signum()
            } else {
                0.0
            },
            gamma: p.dot(after),
            torsion: self.torsion(i),
            bisectors: [
                lines[0].unwrap_or_else(|| forward(i, given[0], [before, own])),
                lines[1].unwrap_or_else(|| forward(i + 1, given[1], [own, after])),
            ],
            plane: if self.is_split(i) {
                let at = inflection_parameter(polygon, i);
                Some([0.5 * at, 0.5 * (1.0 + at)])
            } else {
                required.intersects(Requirements::COPLANARITY).then_some([1.0, 1.0])
            },
            line: [
                required.intersects(Requirements::LINE_AT_START),
                required.intersects(Requirements::LINE_AT_END),
            ],
            deviation: self.deviation(i),
            speed: FORWARD,
            energy: Energy::Parametric,
            weight: (sine * sine).max(1e-12) / span.length,
        }
    }
}
