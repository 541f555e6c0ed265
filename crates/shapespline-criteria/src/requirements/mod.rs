// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the polygon requires of a segment.

mod found;

use bitflags::bitflags;
use glam::DVec3;
use shapespline_geometry::{DataPolygon, length};

use crate::{Criteria, Criterion};

pub(crate) use found::plane_is_known;

/// How the binormal vectors of a pair of nodes lie to each other is said at [`Requirements::TURNS_ALIKE`] and beside
/// it; of the pair before and after the segment's own it stands so many places further on.
const BEFORE: u32 = 2;
const AFTER: u32 = 4;

bitflags! {
    /// The conditions that a segment is asked to meet.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct Requirements: u32 {
        /// `P_m·P_{m+1} > 0`.
        const CONVEXITY = 1 << 0;
        /// `P_m·P_{m+1} < 0`.
        const INFLECTION = 1 << 1;
        /// `Γ_m > 0`.
        const RIGHT_TORSION = 1 << 2;
        /// `Γ_m < 0`.
        const LEFT_TORSION = 1 << 3;
        /// `Γ_m = 0` on a convex quadruple: near the plane on the whole segment.
        const COPLANARITY = 1 << 4;
        /// `Γ_m = 0` on an inflecting quadruple: near the plane on two parts of the segment.
        const SPLIT_COPLANARITY = 1 << 5;
        /// Three points on a line around the segment's first node.
        const LINE_AT_START = 1 << 6;
        /// Three points on a line around the segment's last node.
        const LINE_AT_END = 1 << 7;
        /// `P_m·P_{m+1} > 0` again: the conditions of Definition 3.16 beyond local convexity.
        const GLOBAL_CONVEXITY = 1 << 8;
        /// `P_m ≠ 0`: turning at the segment's first node.
        const TURNING_AT_START = 1 << 9;
        /// `P_{m+1} ≠ 0`: turning at the segment's last node.
        const TURNING_AT_END = 1 << 10;
        /// `P_m·P_{m+1} > 0`: each node turns along the other's binormal vector as well.
        const TURNS_ALIKE = 1 << 11;
        /// `P_m·P_{m+1} < 0`.
        const TURNS_APART = 1 << 12;
        /// `P_{m−1}·P_m > 0`, asked at the first node.
        const BEFORE_ALIKE = Self::TURNS_ALIKE.bits() << BEFORE;
        /// `P_{m−1}·P_m < 0`.
        const BEFORE_APART = Self::TURNS_APART.bits() << BEFORE;
        /// `P_{m+1}·P_{m+2} > 0`, asked at the last node.
        const AFTER_ALIKE = Self::TURNS_ALIKE.bits() << AFTER;
        /// `P_{m+1}·P_{m+2} < 0`.
        const AFTER_APART = Self::TURNS_APART.bits() << AFTER;
        /// No criterion that is asked implies that the curve is regular.
        const REGULAR = 1 << 17;
        /// With it: an end leg that is rounding beside its chord counts as none. Tension may leave so little.
        const LEGS = 1 << 18;
        /// The polygon doubles back on itself at a node of the segment. Asks for nothing.
        const DOUBLING_BACK = 1 << 19;
        /// By construction the curve is straight before the segment's first node: `ω` vanishes there, and counts by
        /// its sign beside. Asks for nothing.
        const STRAIGHT_BEFORE = 1 << 20;
        /// The same after the last node.
        const STRAIGHT_AFTER = 1 << 21;
    }
}

impl Requirements {
    /// Turning along the binormal vector of the segment's other node, at both.
    pub const TURNING_PAIR: Self = Self::TURNS_ALIKE.union(Self::TURNS_APART);
    /// Turning at the first node along the binormal vector of the node before it.
    pub const TURNING_BEFORE: Self = Self::BEFORE_ALIKE.union(Self::BEFORE_APART);
    /// Turning at the last node along the binormal vector of the node after it.
    pub const TURNING_AFTER: Self = Self::AFTER_ALIKE.union(Self::AFTER_APART);

    /// What a node asks for that a segment begins at, and one that it ends at.
    pub(crate) const AT_START: Self = Self::LINE_AT_START.union(Self::TURNING_AT_START);
    pub(crate) const AT_END: Self = Self::LINE_AT_END.union(Self::TURNING_AT_END);
    /// What the two nodes of a segment ask for together.
    pub(crate) const PAIR: Self = Self::CONVEXITY
        .union(Self::INFLECTION)
        .union(Self::GLOBAL_CONVEXITY)
        .union(Self::TURNING_PAIR);

    /// What a segment asks for only where the polygon turns at both of its nodes.
    pub(crate) const OF_BOTH: Self = Self::PAIR
        .union(Self::RIGHT_TORSION)
        .union(Self::LEFT_TORSION)
        .union(Self::COPLANARITY)
        .union(Self::SPLIT_COPLANARITY);

    /// Those of the requirements that belong to a set of criteria.
    #[must_use]
    pub fn only(self, criteria: Criteria) -> Self {
        self & Self::of_all(criteria)
    }

    /// The requirements that belong to a criterion.
    #[must_use]
    pub fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::Convexity => Self::CONVEXITY,
            Criterion::Inflection => Self::INFLECTION,
            Criterion::Turning => Self::TURNING_AT_START
                .union(Self::TURNING_AT_END)
                .union(Self::TURNING_PAIR)
                .union(Self::TURNING_BEFORE)
                .union(Self::TURNING_AFTER),
            Criterion::Torsion => Self::RIGHT_TORSION.union(Self::LEFT_TORSION),
            Criterion::Coplanarity => Self::COPLANARITY.union(Self::SPLIT_COPLANARITY),
            Criterion::Collinearity => Self::LINE_AT_START.union(Self::LINE_AT_END),
            Criterion::GlobalConvexity => Self::GLOBAL_CONVEXITY,
            Criterion::Regular => Self::REGULAR.union(Self::LEGS),
        }
    }

    /// The requirements that imply a regular curve where they are met. A cubic that stops where its
    /// legs are independent has none of them; else `ω` has a double root there, so along no vector
    /// is it positive throughout, or does it change its sign once.
    pub(crate) const IMPLY_REGULAR: Self = Self::CONVEXITY
        .union(Self::INFLECTION)
        .union(Self::RIGHT_TORSION)
        .union(Self::LEFT_TORSION);

    /// The criteria that the requirements belong to.
    #[must_use]
    pub fn criteria(self) -> Criteria {
        Criterion::ALL.into_iter().filter(|&c| self.intersects(Self::of(c))).collect()
    }

    /// The requirements that belong to some criteria, in a polygon that is planar or not.
    pub(crate) fn wanted(criteria: Criteria, planar: bool) -> Self {
        let all = Self::of_all(criteria);
        if planar { all - Self::of(Criterion::Coplanarity) } else { all }
    }

    fn of_all(criteria: Criteria) -> Self {
        criteria.iter().map(Self::of).fold(Self::empty(), Self::union)
    }
}

/// Local parameter `t*` that separates the two parts of an inflecting coplanar segment: where the
/// binormal of a ν-spline flips in the limit of equal and growing tension (paper 001, (5.9)).
///
/// At an end with a given tangent the limit is that of `(1 + ν_0) q_0 = D_0`; the paper's convention
/// `L_{−1} = D_0` there depends on the unit of the parameter, so `L_{−1} = h_0 D_0/6` is taken, which
/// gives the true limit.
#[must_use]
pub fn inflection_parameter(polygon: &DataPolygon, segment: usize) -> f64 {
    inflection_parameter_between(polygon, [segment; 2], polygon.binormals(segment))
}

/// The same for the part of the curve from the start of one segment to the end of another, as if there
/// were no points between; with the binormal vectors at the two nodes.
pub(crate) fn inflection_parameter_between(
    polygon: &DataPolygon,
    [first, last]: [usize; 2],
    [p, q]: [DVec3; 2],
) -> f64 {
    let n = polygon.segments();
    let neighbour = |segment: usize, before: bool| -> f64 {
        let end = if before { segment == 0 } else { segment + 1 == n };
        match (end && !polygon.is_closed(), polygon.tangents()[usize::from(!before)]) {
            (true, Some(tangent)) => length(tangent) * polygon.spacing(segment) / 6.0,
            (true, None) => length(polygon.chord(segment)),
            (false, _) => {
                let beside = if before { (segment + n - 1) % n } else { (segment + 1) % n };
                length(polygon.chord(beside))
            }
        }
    };
    let h_before = polygon.neighbour_spacings(first)[0];
    let h_after = polygon.neighbour_spacings(last)[1];
    let p = p.length() * neighbour(first, true);
    let q = q.length() * neighbour(last, false);
    1.0 / (1.0 + (q / p).sqrt() * (h_before / h_after).powf(0.75))
}

/// Direction of the plane normal of a coplanar quadruple: the mean of its two binormal directions,
/// so that it does not depend on the direction the points are run through.
pub(crate) fn plane_normal(p: DVec3, q: DVec3) -> DVec3 {
    let (p, q) = (p.normalize_or_zero(), q.normalize_or_zero());
    (if p.dot(q) < 0.0 { p - q } else { p + q }).normalize_or_zero()
}
