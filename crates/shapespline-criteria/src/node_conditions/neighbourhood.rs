// SPDX-License-Identifier: MIT OR Apache-2.0

//! Three points on a line (paper 002, Definition 8.2): the conditions on the two segments between them,
//! with the middle point left out.

use glam::DVec3;
use shapespline_polynomial::Sign;

use super::{Around, NodeCondition, NodeRecord};
use crate::{
    Criterion, Requirements,
    arbitrary_degree::{Question, Segment, is_never_outside, margin, minimum, prove_sign},
    cone::Cones,
    margin::Margin,
    requirements::{inflection_parameter_between, plane_is_known},
};

/// The two segments that meet in the middle point, as one between the outer two.
pub(super) struct Pair<'a, 'c, 'p> {
    around: &'a Around<'c, 'p>,
    /// The nodes at its ends.
    ends: [usize; 2],
    joined: Segment,
    /// Binormal vectors of unit chords at its ends.
    binormals: [DVec3; 2],
}

impl<'a, 'c, 'p> Pair<'a, 'c, 'p> {
    /// Around a node where the polygon goes straight on, between two where it turns.
    pub(super) fn of(around: &'a Around<'c, 'p>) -> Option<Self> {
        let polygon = around.checker.polygon();
        let (n, node, zero) = (polygon.segments(), around.node, around.checker.tolerances().zero);
        let [l0, l1] = polygon.directions_at(node);
        if polygon.binormal(node).length() > zero || l0.dot(l1) <= 0.0 {
            return None;
        }
        let (before, after) = ((node + n - 1) % n, (node + 1) % n);
        let end = if after == 0 && !polygon.is_closed() { n } else { after };
        if polygon.is_natural_end(before) || polygon.is_natural_end(end) {
            return None;
        }
        let binormals @ [p, q] = [before, end].map(|i| polygon.binormal(i));
        if p.length() <= zero || q.length() <= zero {
            return None;
        }
        let joined = Segment::joined(&around.sides[0], &around.sides[1]);
        Some(Self { around, ends: [before, end], joined, binormals })
    }

    fn question(&self, criterion: Criterion, required: Requirements, cones: Cones) -> Question {
        // Turning is not asked here.
        let (beside, chord) = ([DVec3::ZERO; 2], DVec3::ZERO);
        Question { criterion, required, normals: self.normals(), beside, chord, cones }
    }

    fn normals(&self) -> [DVec3; 2] {
        self.binormals.map(DVec3::normalize_or_zero)
    }

    fn inflects(&self) -> bool {
        let [p, q] = self.normals();
        p.dot(q) < -self.around.checker.tolerances().zero
    }

    /// The two segments.
    fn segments(&self) -> [usize; 2] {
        let polygon = self.around.checker.polygon();
        [self.ends[0], self.around.node % polygon.segments()]
    }

    /// Parameter of a local parameter of the two segments together, 0.5 being the node between.
    fn parameter(&self, local: f64) -> f64 {
        let polygon = self.around.checker.polygon();
        let [first, last] = self.segments();
        let (from, part) = if local < 0.5 { (first, local) } else { (last, local - 0.5) };
        self.around.u(from) + 2.0 * part * polygon.spacing(from)
    }

    fn record(&self, condition: NodeCondition, satisfied: bool, margin: Margin) -> NodeRecord {
        self.around.record(condition, satisfied, margin)
    }

    /// Items 2 and 3: convexity or inflection, and the nodes beside.
    pub(super) fn bend(&self, segment: &impl Fn(usize) -> Segment) -> NodeRecord {
        let polygon = self.around.checker.polygon();
        let (n, zero) = (polygon.segments(), self.around.checker.tolerances().zero);
        let inflects = self.inflects();
        let (criterion, condition) = if inflects {
            (Criterion::Inflection, NodeCondition::InflectionNeighbourhood)
        } else {
            (Criterion::Convexity, NodeCondition::ConvexNeighbourhood)
        };
        let question = self.question(criterion, Requirements::of(criterion), Cones::none());
        let mut margin = margin(&self.joined, &question);
        let keeps = if inflects {
            prove_sign(&self.joined, &question) == Sign::Positive
        } else {
            // Equality is all that a curve through the node can reach.
            margin.value >= -zero
        };
        margin.at = self.parameter(margin.at);

        // The nodes beside; beyond an open end there is no segment, and one side is all there is.
        let beside = |at: usize| {
            let closed = polygon.is_closed();
            let left = if at > 0 { Some(at - 1) } else { closed.then_some(n - 1) };
            let right = if at < n { Some(at) } else { closed.then_some(0) };
            let present = usize::from(left.is_none())..1 + usize::from(right.is_some());
            let sides = [left, right].map(|i| segment(i.unwrap_or(self.ends[0])));
            Around { checker: self.around.checker, node: at, sides }.compatibility(at, present)
        };
        let mut satisfied = keeps;
        for compatible in self.ends.into_iter().filter_map(beside) {
            satisfied &= compatible.satisfied;
            margin = margin.least(Margin { value: compatible.margin, at: compatible.location });
        }
        self.record(condition, satisfied, margin)
    }

    /// The last sentence: torsion, or in a polygon that is not planar coplanarity, by the discrete
    /// torsion of the four points that are left.
    pub(super) fn twist(&self, spatial: bool) -> Option<NodeRecord> {
        let tolerances = self.around.checker.tolerances();
        let [p, q] = self.binormals;
        let after = self.around.checker.polygon().directions_at(self.ends[1])[1];
        let gamma = p.dot(after);
        if gamma.abs() > tolerances.zero {
            let right = gamma > 0.0;
            let required =
                if right { Requirements::RIGHT_TORSION } else { Requirements::LEFT_TORSION };
            let question = self.question(Criterion::Torsion, required, Cones::none());
            let holds = prove_sign(&self.joined, &question) == Sign::Positive;
            let margin = self.sided(margin(&self.joined, &question), holds);
            return Some(self.record(NodeCondition::NeighbourhoodTorsion, holds, margin));
        }
        if !spatial || !plane_is_known(p, q, [p.length(), q.length()], &tolerances) {
            return None;
        }
        let (holds, margin) = if self.inflects() { self.split_plane() } else { self.plane() };
        let margin = self.sided(margin, holds);
        Some(self.record(NodeCondition::NeighbourhoodCoplanarity, holds, margin))
    }

    /// The margin on the side of zero that the verdict proves, at the parameter of the curve.
    fn sided(&self, margin: Margin, holds: bool) -> Margin {
        let value = if holds { margin.value.max(f64::MIN_POSITIVE) } else { margin.value.min(0.0) };
        Margin { value, at: self.parameter(margin.at) }
    }

    /// Of an inflection neighbourhood: (10.1) on the two parts beside the place where a spline through
    /// the four points would inflect.
    fn split_plane(&self) -> (bool, Margin) {
        let polygon = self.around.checker.polygon();
        let segments = self.segments();
        let [h0, h1] = segments.map(|i| polygon.spacing(i));
        let binormals = [segments[0], segments[1] + 1].map(|node| polygon.binormal(node));
        let flip = inflection_parameter_between(polygon, segments, binormals);
        // From the parameter to the local one, which runs at another rate on each segment.
        let local = |s: f64| {
            let u = s * (h0 + h1);
            if u < h0 { 0.5 * u / h0 } else { 0.5 + 0.5 * (u - h0) / h1 }
        };
        let cones = Cones {
            plane: (self.around.checker.tolerances().coplanarity, self.normals()),
            parts: [local(0.5 * flip), local(0.5 * (1.0 + flip))],
            ..Cones::none()
        };
        let question =
            self.question(Criterion::Coplanarity, Requirements::SPLIT_COPLANARITY, cones);
        let holds = prove_sign(&self.joined, &question) == Sign::Positive;
        (holds, margin(&self.joined, &question))
    }

    /// Of a convex neighbourhood: a curve through the middle point has to be straight or to inflect
    /// somewhere, so (10.1) is asked of the line of the binormal, wherever there is one.
    fn plane(&self) -> (bool, Margin) {
        let epsilon = self.around.checker.tolerances().coplanarity;
        let normals = self.normals();
        let largest = -minimum(&self.joined, [0.0, 1.0], |jet| -jet.omega().length()).value;
        let margin = minimum(&self.joined, [0.0, 1.0], |jet| {
            let omega = jet.omega();
            let size = omega.length();
            // Below this rounding, not the curve, decides where it points.
            if size <= 1e-9 * largest {
                return epsilon;
            }
            normals
                .into_iter()
                .fold(epsilon, |m, n| m.min(epsilon - omega.cross(n).length() / size))
        });
        let holds = normals.into_iter().all(|n| is_never_outside(&self.joined, n, epsilon));
        (holds, margin)
    }
}
