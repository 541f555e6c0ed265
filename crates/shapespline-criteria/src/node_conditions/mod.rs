// SPDX-License-Identifier: MIT OR Apache-2.0

//! What paper 002 says beyond the criteria, as information: it does not enter a verdict.
//!
//! - *Compatibility* (12.1): the tangent at a node, seen along `P_i`, lies strictly between the two
//!   chords: `l_{i−1}×T` and `T×l_i` both turn as `P_i` does. (Printed as a product that is negative,
//!   which a tangent of the opposite direction passes too.) The criterion of turning asks it as well.
//! - *Torsion at nodes* (Definition 9.2, item 2): where `Γ_{i−1}Γ_i > 0`, torsion has that sign on both
//!   sides of the node. Where `Γ_{i−1}Γ_i < 0` it has to vanish or to jump there if both segments are
//!   to keep theirs (Theorem 12.1).
//! - *Neighbourhood of three points on a line* (Definition 8.2, with E8): with the middle point left
//!   out, the two segments together keep the convexity, or the inflection, of the points around, and
//!   the nodes beside are compatible. A curve through the middle point of a convex neighbourhood can
//!   meet this with equality only, by being straight; the margin says how far it bends the other way.
//!   The definition's last sentence asks for torsion, or coplanarity, of the two together as well.
//! - *Oscillation* (section 10): how often the curve crosses the plane of a coplanar quadruple between
//!   two points, beside the least that its end tangents allow: none where it leaves and arrives on
//!   the same side, one where on opposite sides. A cubic always has the least.

mod neighbourhood;

use std::ops::ControlFlow;

use glam::DVec3;

use self::neighbourhood::Pair;
use crate::{
    Checker, Criterion, Requirements,
    arbitrary_degree::{Segment, minimum},
    margin::Margin,
    requirements::plane_normal,
};

/// A condition at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum NodeCondition {
    /// The tangent lies between the chords (12.1).
    Compatibility,
    /// Torsion of the polygon's sign on both sides of the node (Definition 9.2, item 2).
    SameTorsion,
    /// Torsion that vanishes or jumps where the polygon's changes sign (Theorem 12.1).
    TorsionChange,
    /// Three points on a line between points that turn the same way (Definition 8.2).
    ConvexNeighbourhood,
    /// Three points on a line between points that turn opposite ways (Definition 8.2).
    InflectionNeighbourhood,
    /// Three points on a line: torsion of the sign of the points around, on both segments
    /// (Definition 8.2, last sentence).
    NeighbourhoodTorsion,
    /// Three points on a line between points in one plane: a binormal near that plane's normal, on
    /// both segments (Definition 8.2, last sentence).
    NeighbourhoodCoplanarity,
}

impl NodeCondition {
    /// The name users write.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Compatibility => "compatibility",
            Self::SameTorsion => "same-torsion",
            Self::TorsionChange => "torsion-change",
            Self::ConvexNeighbourhood => "convex-neighbourhood",
            Self::InflectionNeighbourhood => "inflection-neighbourhood",
            Self::NeighbourhoodTorsion => "neighbourhood-torsion",
            Self::NeighbourhoodCoplanarity => "neighbourhood-coplanarity",
        }
    }
}

/// One condition at one node to which it applies.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodeRecord {
    /// Index of the node.
    pub node: usize,
    /// The condition.
    pub condition: NodeCondition,
    /// Whether the curve meets it.
    pub satisfied: bool,
    /// Signed, scale-free distance from failure.
    pub margin: f64,
    /// Parameter where the margin is smallest.
    pub location: f64,
}

/// How a segment moves about the plane of its four points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Oscillation {
    /// Index of the segment, which requires coplanarity.
    pub segment: usize,
    /// How often it crosses the plane between its points.
    pub crossings: usize,
    /// The least crossings that its end tangents allow.
    pub least: usize,
    /// Whether it has no more than the least.
    pub satisfied: bool,
    /// Its greatest distance from the plane over the length of the chord.
    pub amplitude: f64,
    /// The parameter of that distance.
    pub location: f64,
}

/// What the paper says beyond the criteria.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodeConditions {
    /// Conditions at the nodes to which they apply, ascending.
    pub nodes: Vec<NodeRecord>,
    /// Oscillations of the segments that require coplanarity, ascending.
    pub oscillations: Vec<Oscillation>,
}

impl Checker<'_> {
    /// What the paper says of nodes and of oscillation, as information, given end legs. Cost and
    /// memory O(N), much slower than a check.
    pub fn node_conditions<L>(&self, legs: L) -> NodeConditions
    where
        L: Fn(usize) -> [DVec3; 2],
    {
        self.node_conditions_with(legs, &|| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// As [`Checker::node_conditions`], but calls `go_on` before each node and segment, and returns
    /// `None` once that breaks.
    pub fn node_conditions_with<L>(
        &self,
        legs: L,
        go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Option<NodeConditions>
    where
        L: Fn(usize) -> [DVec3; 2],
    {
        node_conditions(self, |i| Segment::cubic(legs(i), self.polygon().chord(i)), go_on)
    }
}

pub(crate) fn node_conditions(
    checker: &Checker<'_>,
    segment: impl Fn(usize) -> Segment,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Option<NodeConditions> {
    let polygon = checker.polygon();
    let n = polygon.segments();
    let mut conditions = NodeConditions::default();
    // Closed data: the last node is the first.
    let nodes = if polygon.is_closed() { 0..n } else { 1..n };
    let required = Requirements::of_polygon(polygon, &checker.tolerances());
    let spatial = required.iter().any(|c| c.intersects(Requirements::of(Criterion::Torsion)));
    for node in nodes {
        if go_on().is_break() {
            return None;
        }
        let sides = [segment((node + n - 1) % n), segment(node)];
        let around = Around { checker, node, sides };
        conditions.nodes.extend(around.compatibility(node, 0..2));
        conditions.nodes.extend(around.torsion());
        if let Some(pair) = Pair::of(&around) {
            conditions.nodes.push(pair.bend(&segment));
            conditions.nodes.extend(pair.twist(spatial));
        }
    }
    let coplanar = Requirements::of(Criterion::Coplanarity);
    for i in (0..n).filter(|&i| required[i].intersects(coplanar)) {
        if go_on().is_break() {
            return None;
        }
        conditions.oscillations.push(oscillation(checker, i, &segment(i)));
    }
    Some(conditions)
}

/// A node and the segments that meet there.
struct Around<'a, 'p> {
    checker: &'a Checker<'p>,
    node: usize,
    sides: [Segment; 2],
}

impl Around<'_, '_> {
    fn record(&self, condition: NodeCondition, satisfied: bool, margin: Margin) -> NodeRecord {
        NodeRecord {
            node: self.node,
            condition,
            satisfied,
            margin: margin.value,
            location: margin.at,
        }
    }

    fn u(&self, node: usize) -> f64 {
        self.checker.polygon().parameters()[node]
    }

    /// (12.1), with the tangents on both sides of the node.
    fn compatibility(&self, node: usize, sides: std::ops::Range<usize>) -> Option<NodeRecord> {
        let polygon = self.checker.polygon();
        let p = polygon.binormal(node);
        if p.length() <= self.checker.tolerances().zero {
            return None;
        }
        let (p, [before, after]) = (p.normalize_or_zero(), polygon.directions_at(node));
        let value = sides.fold(f64::INFINITY, |least, side| {
            let t = self.tangent(side);
            least.min(before.cross(t).dot(p)).min(t.cross(after).dot(p))
        });
        let margin = Margin { value, at: self.u(node) };
        Some(self.record(NodeCondition::Compatibility, value > 0.0, margin))
    }

    /// Unit tangent at the node, on a side.
    fn tangent(&self, side: usize) -> DVec3 {
        end_jet(&self.sides[side], side == 0)[1].normalize_or_zero()
    }

    fn torsion(&self) -> Option<NodeRecord> {
        let polygon = self.checker.polygon();
        let n = polygon.segments();
        let zero = self.checker.tolerances().zero;
        let sign = |segment: usize| {
            let gamma = polygon.gamma(segment);
            if gamma.abs() > zero { gamma.signum() } else { 0.0 }
        };
        let signs = [sign((self.node + n - 1) % n), sign(self.node)];
        if signs[0] * signs[1] == 0.0 {
            return None;
        }
        let value = [0, 1].into_iter().fold(f64::INFINITY, |least, side| {
            let [_, d1, d2, d3] = end_jet(&self.sides[side], side == 0);
            let size = d1.length() * d2.length() * d3.length();
            let value = if size > 0.0 { twist(&self.sides[side], side == 0) / size } else { 0.0 };
            least.min(signs[side] * value)
        });
        let margin = Margin { value, at: self.u(self.node) };
        Some(if signs[0] == signs[1] {
            self.record(NodeCondition::SameTorsion, value > 0.0, margin)
        } else {
            // Zero is one of the two ways out.
            self.record(NodeCondition::TorsionChange, value >= 0.0, margin)
        })
    }
}

/// The jet at the end of a segment, or at its start.
fn end_jet(segment: &Segment, end: bool) -> [DVec3; 4] {
    let piece = if end { segment.pieces.last() } else { segment.pieces.first() };
    piece.map_or([DVec3::NAN; 4], |piece| piece.jet(if end { 1.0 } else { 0.0 }))
}

/// `det[γ', γ'', γ''']` at the end of a segment, or at its start.
fn twist(segment: &Segment, end: bool) -> f64 {
    let piece = if end { segment.pieces.last() } else { segment.pieces.first() };
    piece.map_or(f64::NAN, |piece| piece.twist(if end { 1.0 } else { 0.0 }))
}

fn oscillation(checker: &Checker<'_>, i: usize, segment: &Segment) -> Oscillation {
    let polygon = checker.polygon();
    let normal = plane_normal(polygon.binormal(i), polygon.binormal(i + 1));
    let chord = end_jet(segment, true)[0].length();
    let far = minimum(segment, [0.0, 1.0], |jet| -jet.d[0].dot(normal).abs());
    let amplitude = -far.value / chord;
    // Within the tolerance of the plane nothing crosses it.
    let zero = checker.tolerances().zero;
    let (mut crossings, mut last) = (0, 0.0f64);
    for piece in &segment.pieces {
        let distance = piece.position().map(1.0, |a| a.dot(normal));
        let distance = shapespline_polynomial::Polynomial::new(
            distance.coefficients().to_vec(),
            distance.error().max(zero * chord),
        );
        for sign in distance.signs().0 {
            let sign = if sign { 1.0 } else { -1.0 };
            crossings += usize::from(last * sign < 0.0);
            last = sign;
        }
    }
    let side = |end: bool| {
        let along = end_jet(segment, end)[1].normalize_or_zero().dot(normal);
        if along.abs() <= zero { 0.0 } else { along }
    };
    // Left upwards and arrived at upwards: there is a crossing between, unless within the tolerance.
    let least = usize::from(side(false) * side(true) > 0.0).min(crossings);
    Oscillation {
        segment: i,
        crossings,
        least,
        satisfied: crossings <= least,
        amplitude,
        location: polygon.parameters()[i] + far.at * polygon.spacing(i),
    }
}
