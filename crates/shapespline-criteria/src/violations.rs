// SPDX-License-Identifier: MIT OR Apache-2.0

//! The verdict on one segment: which of the exact conditions fail.

use bitflags::bitflags;
use glam::DVec3;
use shapespline_geometry::{DataPolygon, normalized_scale};
use shapespline_polynomial::quadratic;

use crate::{
    Criterion, Requirements, Tolerances,
    cone::{Axis, Field, Quadratic},
    global::is_globally_convex,
    regular::is_regular,
    requirements::inflection_parameter_between,
    rounding::{Coarse, Lean, Rounded, Signs, UNIT, leg_error, sum},
};

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
    fn omega_field(&self) -> Field {
        let [first, middle, last] = self.omega_errors();
        Field::new(self.omega_quadratic(), [first, 0.5 * middle, last])
    }

    /// `γ'` likewise. A leg that is zero stays zero, however its control points are rounded.
    fn tangent_field(&self) -> Field {
        let own = |leg: DVec3| if leg == DVec3::ZERO { 0.0 } else { self.slack };
        let sums = sum(self.a) + sum(self.chord) + sum(self.c);
        let middle = 3.0 * self.slack + 3.0 * UNIT * sums;
        Field::new(self.tangent_quadratic(), [own(self.a), middle, own(self.c)])
    }

    /// Direction of a binormal vector, and how far it may be off.
    fn plane_axis(direction: DVec3, binormal: DVec3) -> Axis {
        Axis { direction, off: 12.0 * UNIT / binormal.length() + 4.0 * UNIT }
    }
}

/// What the coplanarity and collinearity conditions need beyond the legs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cones {
    /// `ε₁` and the unit binormal vectors at the two nodes: both are normals of the plane, up to the
    /// tolerance of `Γ = 0`, and (2.5) is asked of both.
    pub(crate) plane: (f64, [DVec3; 2]),
    /// `t^ℓ, t^r`: the parts `[0, t^ℓ]` and `[t^r, 1]` of a split coplanarity.
    pub(crate) parts: [f64; 2],
    /// `ε₀` and the line directions at the two nodes.
    pub(crate) line: (f64, [DVec3; 2]),
}

impl Cones {
    /// Those of a segment, given the unit chords of it and its neighbours.
    pub(crate) fn new(
        polygon: &DataPolygon,
        segment: usize,
        [before, own, after]: [DVec3; 3],
        required: Requirements,
        tolerances: &Tolerances,
    ) -> Self {
        let binormals = [before.cross(own), own.cross(after)];
        let parts = if required.intersects(Requirements::SPLIT_COPLANARITY) {
            let flip = inflection_parameter_between(polygon, [segment; 2], binormals);
            [0.5 * flip, 0.5 * (1.0 + flip)]
        } else {
            [0.0, 1.0]
        };
        // The line of three points is known from both of its chords.
        let lines = [before + own, own + after].map(DVec3::normalize_or_zero);
        Self {
            plane: (tolerances.coplanarity, binormals.map(DVec3::normalize_or_zero)),
            parts,
            line: (tolerances.collinearity, lines),
        }
    }

    /// For questions that ask of no cone.
    pub(crate) fn none() -> Self {
        Self { plane: (1.0, [DVec3::ZERO; 2]), parts: [0.0, 1.0], line: (1.0, [DVec3::ZERO; 2]) }
    }
}

/// Collinearity is asked on this part of a segment next to the node.
pub(crate) const LINE_PART: f64 = 0.5;

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

/// Whether `α(1−t)² + γt(1−t) + βt²` is positive: Lemma 5.1, with the rounding of its root.
#[inline(always)]
pub(crate) fn is_positive([alpha, gamma, beta]: [Rounded; 3], lean: Lean) -> bool {
    let root = Rounded { error: gamma.error + 8.0 * UNIT * gamma.value.abs(), ..gamma };
    quadratic::is_positive(alpha.toward(lean), root.toward(lean), beta.toward(lean))
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
