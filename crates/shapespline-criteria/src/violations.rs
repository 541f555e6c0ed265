// SPDX-License-Identifier: MIT OR Apache-2.0

//! The verdict on one segment: which of the exact conditions fail.

use crate::{
    Criterion, Requirements,
    cone::{Axis, Cones, Field, LINE_PART},
    global::is_globally_convex,
    regular::is_regular,
    rounding::{Coarse, Lean, Rounded, UNIT, is_positive},
    segment_geometry::SegmentGeometry,
    signs::Signs,
};
use bitflags::bitflags;

bitflags! {
    /// Conditions that fail on a segment `m`, or are not proved to hold, as the failure sets (5.40)–(5.57) of
    /// paper 001 (corrected by E3) and Theorems 13.6–13.11 of paper 002 distinguish them: the place of a failure
    /// decides which tensions can mend it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
    pub struct Violations: u32 {
        /// Convexity, at node m: `ω(u_m)·P_n ≤ 0` (K₀₁).
        const CONVEXITY_AT_START = 1 << 0;
        /// Convexity, at node m+1 (K₀₂).
        const CONVEXITY_AT_END = 1 << 1;
        /// Convexity, between the nodes (K₀₃).
        const CONVEXITY_BETWEEN = 1 << 2;
        /// Inflection, at node m.
        const INFLECTION_AT_START = 1 << 3;
        /// Inflection, at node m+1.
        const INFLECTION_AT_END = 1 << 4;
        /// Torsion (I₁₁).
        const TORSION = 1 << 5;
        /// Coplanarity, at node m (M₀₁, M₁₁).
        const COPLANARITY_AT_START = 1 << 6;
        /// Coplanarity, at node m+1 (M₀₂, M₂₂).
        const COPLANARITY_AT_END = 1 << 7;
        /// Coplanarity of a convex quadruple, between the nodes (M₀₃).
        const COPLANARITY_BETWEEN = 1 << 8;
        /// Coplanarity of an inflecting quadruple, between the nodes (M₁₂, M₁₃, M₂₁, M₂₃).
        const COPLANARITY_SPLIT = 1 << 9;
        /// Collinearity at node m, at the node itself (J₀₁).
        const LINE_AT_START = 1 << 10;
        /// Collinearity at node m, at the far end of its interval (J₂₁).
        const LINE_AFTER_START = 1 << 11;
        /// Collinearity at node m, inside its interval (J₂₂).
        const LINE_INSIDE_START = 1 << 12;
        /// Collinearity at node m+1, at the node itself (J₀₁).
        const LINE_AT_END = 1 << 13;
        /// Collinearity at node m+1, at the far end of its interval (J₁₁).
        const LINE_BEFORE_END = 1 << 14;
        /// Collinearity at node m+1, inside its interval (J₁₂).
        const LINE_INSIDE_END = 1 << 15;
        /// Global convexity, anywhere on the segment.
        const GLOBAL_CONVEXITY = 1 << 16;
        /// Turning, at node m.
        const TURNING_AT_START = 1 << 17;
        /// Turning, at node m+1.
        const TURNING_AT_END = 1 << 18;
        /// The curve stops somewhere on the segment.
        const NOT_REGULAR = 1 << 19;
    }
}

impl Violations {
    /// Conditions at node m alone.
    pub(crate) const AT_START: Self = Self::CONVEXITY_AT_START
        .union(Self::INFLECTION_AT_START)
        .union(Self::TURNING_AT_START)
        .union(Self::COPLANARITY_AT_START)
        .union(Self::LINE_AT_START);
    /// Conditions at node m+1 alone.
    pub(crate) const AT_END: Self = Self::CONVEXITY_AT_END
        .union(Self::INFLECTION_AT_END)
        .union(Self::TURNING_AT_END)
        .union(Self::COPLANARITY_AT_END)
        .union(Self::LINE_AT_END);

    #[inline]
    fn add(&mut self, violation: Self, fails: bool) {
        self.set(violation, fails | self.contains(violation));
    }
}

/// The requirements that are not met beyond doubt: none, and there is no violation. A few signs
/// without branches, within coarse bounds; where those are not enough nothing is decided.
#[inline(always)]
pub(crate) fn unproved(s: &SegmentGeometry, bounds: Coarse, required: u32) -> u32 {
    let ([a0, g0, b0], [a1, g1, b1]) = (s.omega_along(s.p), s.omega_along(s.q));
    let (before, after) = (s.omega[0].dot(s.before), s.omega[2].dot(s.after));
    let (determinant, Coarse { turns: [o, p, q, r], twist }) = (s.determinant(), bounds);
    let met = |holds: bool, call: Requirements| if holds { call.bits() } else { 0 };
    // A middle coefficient that is not negative needs no root.
    let start = (a0 > p) & (b1 > q);
    let convex = start & (a1 > q) & (b0 > p) & (g0 >= p) & (g1 >= q);
    let inflecting = start & (a1 < -q) & (b0 < -p);
    // Nor does the chord turn another way than the ends then.
    let met = met(convex, Requirements::CONVEXITY.union(Requirements::GLOBAL_CONVEXITY))
        | met(inflecting, Requirements::INFLECTION)
        // (a×L)·P = (a×b)·P + (a×c)·P, and (L×c)·P likewise.
        | met((a0 > p) & (a0 + g0 > 2.0 * p), Requirements::TURNING_AT_START)
        | met((b1 > q) & (b1 + g1 > 2.0 * q), Requirements::TURNING_AT_END)
        | met((a1 > q) & (b0 > p), Requirements::TURNS_ALIKE)
        | met((a1 < -q) & (b0 < -p), Requirements::TURNS_APART)
        | met(before > o, Requirements::BEFORE_ALIKE)
        | met(before < -o, Requirements::BEFORE_APART)
        | met(after > r, Requirements::AFTER_ALIKE)
        | met(after < -r, Requirements::AFTER_APART)
        | met(determinant > twist, Requirements::RIGHT_TORSION)
        | met(determinant < -twist, Requirements::LEFT_TORSION);
    required & !met
}

/// What fails on a segment; doubts are counted as `lean` says. The cones are made where a
/// requirement needs them.
#[inline]
pub(crate) fn violations(
    s: &SegmentGeometry,
    required: Requirements,
    lean: Lean,
    cones: impl FnOnce() -> Cones,
) -> Violations {
    let violations = sign_violations(s, required, lean);
    if required.intersects(
        Requirements::of(Criterion::Coplanarity).union(Requirements::of(Criterion::Collinearity)),
    ) {
        return violations.union(cone_violations(s, required, &cones(), lean));
    }
    violations
}

/// The violations of convexity, inflection, turning and torsion, and of a curve that stops.
#[inline]
pub(crate) fn sign_violations(
    s: &SegmentGeometry,
    required: Requirements,
    lean: Lean,
) -> Violations {
    let mut stops = Violations::default();
    stops.add(
        Violations::NOT_REGULAR,
        required.intersects(Requirements::REGULAR) && !is_regular(s, required),
    );
    let coarse = Signs::coarse(s);
    let violations = violations_of_signs(&coarse, required, Lean::Against);
    if violations.is_empty() || violations == violations_of_signs(&coarse, required, Lean::For) {
        return violations.union(stops);
    }
    violations_of_signs(&Signs::fine(s), required, lean).union(stops)
}

#[inline(always)]
fn violations_of_signs(signs: &Signs, required: Requirements, lean: Lean) -> Violations {
    let mut violations = Violations::default();
    // Written so that a NaN fails.
    let positive = |x: Rounded| x.is_positive(lean);
    let Signs { omega: omega @ [[a0, g0, b0], [a1, g1, b1]], beside, twist } = *signs;
    if required.intersects(Requirements::CONVEXITY) {
        let (start, end) = (positive(a0) && positive(a1), positive(b0) && positive(b1));
        violations.add(Violations::CONVEXITY_AT_START, !start);
        violations.add(Violations::CONVEXITY_AT_END, !end);
        let between = is_positive([a0, g0, b0], lean) && is_positive([a1, g1, b1], lean);
        violations.add(Violations::CONVEXITY_BETWEEN, start && end && !between);
    } else if required.intersects(Requirements::INFLECTION) {
        violations.add(Violations::INFLECTION_AT_START, !(positive(a0) && positive(-a1)));
        violations.add(Violations::INFLECTION_AT_END, !(positive(-b0) && positive(b1)));
    }
    if required.intersects(Requirements::of(Criterion::Turning)) {
        // Where the signs of two binormal vectors agree, oppose each other, or are not asked for.
        let sided = |x: Rounded, alike: Requirements, apart: Requirements| {
            (!required.intersects(alike) || positive(x))
                && (!required.intersects(apart) || positive(-x))
        };
        let pair = |x: Rounded| sided(x, Requirements::TURNS_ALIKE, Requirements::TURNS_APART);
        // The chord turns as (a×L)·P = α + γ, and (L×c)·P' = β + γ.
        let at = |own: Rounded, middle: Rounded, other: Rounded| {
            positive(own) && positive(own + middle) && pair(other)
        };
        let start = !required.intersects(Requirements::TURNING_AT_START) || at(a0, g0, a1);
        let end = !required.intersects(Requirements::TURNING_AT_END) || at(b1, g1, b0);
        let before = sided(beside[0], Requirements::BEFORE_ALIKE, Requirements::BEFORE_APART);
        let after = sided(beside[1], Requirements::AFTER_ALIKE, Requirements::AFTER_APART);
        violations.add(Violations::TURNING_AT_START, !(start && before));
        violations.add(Violations::TURNING_AT_END, !(end && after));
    }
    if required.intersects(Requirements::GLOBAL_CONVEXITY) {
        violations.add(Violations::GLOBAL_CONVEXITY, !is_globally_convex(&omega, lean));
    }
    if required.intersects(Requirements::RIGHT_TORSION) {
        violations.add(Violations::TORSION, !positive(twist));
    } else if required.intersects(Requirements::LEFT_TORSION) {
        violations.add(Violations::TORSION, !positive(-twist));
    }
    violations
}

/// The violations of coplanarity and collinearity.
pub(crate) fn cone_violations(
    s: &SegmentGeometry,
    required: Requirements,
    cones: &Cones,
    lean: Lean,
) -> Violations {
    let mut violations = Violations::default();
    if required.intersects(Requirements::COPLANARITY.union(Requirements::SPLIT_COPLANARITY)) {
        let (epsilon, normals) = cones.plane;
        let axes =
            [(normals[0], s.p), (normals[1], s.q)].map(|(n, p)| SegmentGeometry::plane_axis(n, p));
        let end_is_near =
            |f: &Field, end: usize| axes.iter().all(|n| f.end_is_inside(end, n, epsilon, lean));
        let is_near = |f: &Field| axes.iter().all(|n| f.is_inside(n, epsilon, lean));
        let omega = s.omega_field();
        let (start, end) = (end_is_near(&omega, 0), end_is_near(&omega, 2));
        violations.add(Violations::COPLANARITY_AT_START, !start);
        violations.add(Violations::COPLANARITY_AT_END, !end);
        if required.intersects(Requirements::COPLANARITY) {
            violations.add(Violations::COPLANARITY_BETWEEN, start && end && !is_near(&omega));
        } else {
            // A failure at the node itself is the violation above; here it is the rest of each part.
            let [left, right] = cones.parts;
            let (first, last) = (omega.part(0.0, left), omega.part(right, 1.0));
            let fails =
                |f: &Field, node: bool, far: usize| !end_is_near(f, far) || (node && !is_near(f));
            let split = fails(&first, start, 2) || fails(&last, end, 0);
            violations.add(Violations::COPLANARITY_SPLIT, split);
        }
    }
    let (epsilon, lines) = cones.line;
    let lines = lines.map(|direction| Axis { direction, off: 8.0 * UNIT });
    // Whether the node, the far end of its part and what is between them lie inside.
    let holds = |part: Field, line: &Axis, [node, far]: [usize; 2]| {
        let ends = [node, far].map(|end| part.end_is_inside(end, line, epsilon, lean));
        [ends[0], ends[1], !(ends[0] && ends[1]) || part.is_inside(line, epsilon, lean)]
    };
    if required.intersects(Requirements::LINE_AT_START) {
        let part = s.tangent_field().part(0.0, LINE_PART);
        let [node, far, between] = holds(part, &lines[0], [0, 2]);
        violations.add(Violations::LINE_AT_START, !node);
        violations.add(Violations::LINE_AFTER_START, !far);
        violations.add(Violations::LINE_INSIDE_START, !between);
    }
    if required.intersects(Requirements::LINE_AT_END) {
        let part = s.tangent_field().part(1.0 - LINE_PART, 1.0);
        let [node, far, between] = holds(part, &lines[1], [2, 0]);
        violations.add(Violations::LINE_AT_END, !node);
        violations.add(Violations::LINE_BEFORE_END, !far);
        violations.add(Violations::LINE_INSIDE_END, !between);
    }
    violations
}
