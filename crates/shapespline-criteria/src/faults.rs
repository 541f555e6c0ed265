//! The verdict on one segment: which of the exact conditions fail.

use glam::DVec3;
use shapespline_geometry::{DataPolygon, bernstein::quadratic_is_positive, near_one};

use crate::{
    Calls, Criterion, Tolerances,
    calls::separation_between,
    cone::{Quadratic, end_is_inside, inside, part},
    global::is_globally_convex,
    regular::is_regular,
    turning::turns,
};

/// The conditions that fail on a segment `m`, as the failure sets (5.40)–(5.57) of paper 001
/// (corrected by E3) and Theorems 13.6–13.11 of paper 002 distinguish them: the place of a failure
/// decides which tensions can mend it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Faults(u32);

impl Faults {
    /// Convexity, at node m: `ω(u_m)·P_n ≤ 0` (K₀₁).
    pub const CONVEXITY_AT_START: Self = Self(1);
    /// Convexity, at node m+1 (K₀₂).
    pub const CONVEXITY_AT_END: Self = Self(2);
    /// Convexity, between the nodes (K₀₃).
    pub const CONVEXITY_BETWEEN: Self = Self(4);
    /// Inflection, at node m.
    pub const INFLECTION_AT_START: Self = Self(8);
    /// Inflection, at node m+1.
    pub const INFLECTION_AT_END: Self = Self(16);
    /// Torsion (I₁₁).
    pub const TORSION: Self = Self(32);
    /// Coplanarity, at node m (M₀₁, M₁₁).
    pub const COPLANARITY_AT_START: Self = Self(64);
    /// Coplanarity, at node m+1 (M₀₂, M₂₂).
    pub const COPLANARITY_AT_END: Self = Self(128);
    /// Coplanarity of a convex quadruple, between the nodes (M₀₃).
    pub const COPLANARITY_BETWEEN: Self = Self(256);
    /// Coplanarity of an inflecting quadruple, between the nodes (M₁₂, M₁₃, M₂₁, M₂₃).
    pub const COPLANARITY_SPLIT: Self = Self(512);
    /// Collinearity at node m, at the node itself (J₀₁).
    pub const LINE_AT_START: Self = Self(1024);
    /// Collinearity at node m, at the far end of its interval (J₂₁).
    pub const LINE_AFTER_START: Self = Self(2048);
    /// Collinearity at node m, inside its interval (J₂₂).
    pub const LINE_INSIDE_START: Self = Self(4096);
    /// Collinearity at node m+1, at the node itself (J₀₁).
    pub const LINE_AT_END: Self = Self(8192);
    /// Collinearity at node m+1, at the far end of its interval (J₁₁).
    pub const LINE_BEFORE_END: Self = Self(16384);
    /// Collinearity at node m+1, inside its interval (J₁₂).
    pub const LINE_INSIDE_END: Self = Self(32768);
    /// Global convexity, anywhere on the segment.
    pub const GLOBAL_CONVEXITY: Self = Self(65536);
    /// Turning, at node m.
    pub const TURNING_AT_START: Self = Self(1 << 17);
    /// Turning, at node m+1.
    pub const TURNING_AT_END: Self = Self(1 << 18);
    /// The curve stops somewhere on the segment.
    pub const NOT_REGULAR: Self = Self(1 << 19);

    /// Whether nothing fails.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether any fault of `other` is among these.
    #[inline]
    #[must_use]
    pub fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The faults together.
    #[inline]
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    #[inline]
    fn add(&mut self, fault: Self, fails: bool) {
        if fails {
            self.0 |= fault.0;
        }
    }
}

/// A segment and the polygon around it, as the conditions see them: all products of legs at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Situation {
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
}

impl Situation {
    /// With the binormal vectors at the node before, at the two nodes of the segment, and at the node
    /// after.
    #[inline]
    pub(crate) fn new(legs: [DVec3; 2], chord: DVec3, binormals: [DVec3; 4]) -> Self {
        let (legs, chord) = near_one(legs, chord);
        Self::of_scaled(legs, chord, binormals)
    }

    /// The same of legs and chord [near one](near_one) in size.
    #[inline(always)]
    pub(crate) fn of_scaled(
        [a, c]: [DVec3; 2],
        chord: DVec3,
        [before, p, q, after]: [DVec3; 4],
    ) -> Self {
        // With b = L − a − c: a×b = a×L − a×c, b×c = L×c − a×c.
        let middle = a.cross(c);
        let omega = [a.cross(chord) - middle, middle, chord.cross(c) - middle];
        Self { a, c, chord, omega, p, q, before, after }
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
        calls: Calls,
        tolerances: &Tolerances,
    ) -> Self {
        let binormals = [before.cross(own), own.cross(after)];
        let parts = if calls.any(Calls::SPLIT_COPLANARITY) {
            let flip = separation_between(polygon, [segment; 2], binormals);
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

/// The calls that are not met beyond doubt: none, and the exact verdict is that there is no fault. A few
/// signs without branches; where one of them says otherwise nothing is decided.
#[inline(always)]
pub(crate) fn doubtful(s: &Situation, calls: u32) -> u32 {
    let ([a0, g0, b0], [a1, g1, b1]) = (s.omega_along(s.p), s.omega_along(s.q));
    let (before, after) = (s.omega[0].dot(s.before), s.omega[2].dot(s.after));
    let determinant = s.determinant();
    let met = |holds: bool, call: Calls| if holds { call.bits() } else { 0 };
    // A middle coefficient that is not negative needs no root.
    let start = (a0 > 0.0) & (b1 > 0.0);
    let convex = start & (a1 > 0.0) & (b0 > 0.0) & (g0 >= 0.0) & (g1 >= 0.0);
    let inflecting = start & (a1 < 0.0) & (b0 < 0.0);
    let met = met(convex, Calls::CONVEXITY)
        | met(inflecting, Calls::INFLECTION)
        // (a×L)·P = (a×b)·P + (a×c)·P, and (L×c)·P likewise.
        | met((a0 > 0.0) & (a0 + g0 > 0.0), Calls::TURNING_AT_START)
        | met((b1 > 0.0) & (b1 + g1 > 0.0), Calls::TURNING_AT_END)
        | met((a1 > 0.0) & (b0 > 0.0), Calls::TURNS_ALIKE)
        | met((a1 < 0.0) & (b0 < 0.0), Calls::TURNS_APART)
        | met(before > 0.0, Calls::BEFORE_ALIKE)
        | met(before < 0.0, Calls::BEFORE_APART)
        | met(after > 0.0, Calls::AFTER_ALIKE)
        | met(after < 0.0, Calls::AFTER_APART)
        | met(determinant > 0.0, Calls::RIGHT_TORSION)
        | met(determinant < 0.0, Calls::LEFT_TORSION);
    calls & !met
}

/// The exact verdict on a segment; the cones are made where a call needs them.
#[inline]
pub(crate) fn faults(s: &Situation, calls: Calls, cones: impl FnOnce() -> Cones) -> Faults {
    let faults = sign_faults(s, calls);
    if calls.any(Calls::of(Criterion::Coplanarity).and(Calls::of(Criterion::Collinearity))) {
        return faults.and(cone_faults(s, calls, &cones()));
    }
    faults
}

/// The faults of convexity, inflection, turning and torsion, and of a curve that stops.
#[inline]
pub(crate) fn sign_faults(s: &Situation, calls: Calls) -> Faults {
    let mut faults = Faults::default();
    if calls.any(Calls::of(Criterion::Turning)) {
        let [start, end] = turns(s, calls);
        faults.add(Faults::TURNING_AT_START, !start);
        faults.add(Faults::TURNING_AT_END, !end);
    }
    if calls.any(Calls::REGULAR) {
        faults.add(Faults::NOT_REGULAR, !is_regular(s, calls));
    }
    if calls.any(Calls::CONVEXITY.and(Calls::INFLECTION)) {
        let ([a0, g0, b0], [a1, g1, b1]) = (s.omega_along(s.p), s.omega_along(s.q));
        if calls.any(Calls::CONVEXITY) {
            // Written so that a NaN fails.
            let (start, end) = (a0 > 0.0 && a1 > 0.0, b0 > 0.0 && b1 > 0.0);
            faults.add(Faults::CONVEXITY_AT_START, !start);
            faults.add(Faults::CONVEXITY_AT_END, !end);
            let between = quadratic_is_positive(a0, g0, b0) && quadratic_is_positive(a1, g1, b1);
            faults.add(Faults::CONVEXITY_BETWEEN, start && end && !between);
        } else if calls.any(Calls::INFLECTION) {
            faults.add(Faults::INFLECTION_AT_START, !(a0 > 0.0 && a1 < 0.0));
            faults.add(Faults::INFLECTION_AT_END, !(b0 < 0.0 && b1 > 0.0));
        }
    }
    if calls.any(Calls::GLOBAL_CONVEXITY) {
        faults.add(Faults::GLOBAL_CONVEXITY, !is_globally_convex(s));
    }
    if calls.any(Calls::RIGHT_TORSION) {
        faults.add(Faults::TORSION, !(s.determinant() > 0.0));
    } else if calls.any(Calls::LEFT_TORSION) {
        faults.add(Faults::TORSION, !(s.determinant() < 0.0));
    }
    faults
}

/// The faults of coplanarity and collinearity.
pub(crate) fn cone_faults(s: &Situation, calls: Calls, cones: &Cones) -> Faults {
    let mut faults = Faults::default();
    if calls.any(Calls::COPLANARITY.and(Calls::SPLIT_COPLANARITY)) {
        let (epsilon, normals) = cones.plane;
        let end_is_near = |w: DVec3| normals.iter().all(|&n| end_is_inside(w, n, epsilon));
        let is_near = |w: Quadratic| normals.iter().all(|&n| inside(w, n, epsilon).holds());
        let omega = s.omega_quadratic();
        let (start, end) = (end_is_near(omega[0]), end_is_near(omega[2]));
        faults.add(Faults::COPLANARITY_AT_START, !start);
        faults.add(Faults::COPLANARITY_AT_END, !end);
        if calls.any(Calls::COPLANARITY) {
            faults.add(Faults::COPLANARITY_BETWEEN, start && end && !is_near(omega));
        } else {
            // A failure at the node itself is the fault above; here it is the rest of each part.
            let [left, right] = cones.parts;
            let (first, last) = (part(omega, 0.0, left), part(omega, right, 1.0));
            let fails =
                |v: Quadratic, node: bool, far: DVec3| !end_is_near(far) || (node && !is_near(v));
            let split = fails(first, start, first[2]) || fails(last, end, last[0]);
            faults.add(Faults::COPLANARITY_SPLIT, split);
        }
    }
    let (epsilon, lines) = cones.line;
    if calls.any(Calls::LINE_AT_START) {
        let tangent = part(s.tangent_quadratic(), 0.0, LINE_PART);
        let (node, far) = (
            end_is_inside(tangent[0], lines[0], epsilon),
            end_is_inside(tangent[2], lines[0], epsilon),
        );
        faults.add(Faults::LINE_AT_START, !node);
        faults.add(Faults::LINE_AFTER_START, !far);
        let within = node && far && !inside(tangent, lines[0], epsilon).holds();
        faults.add(Faults::LINE_INSIDE_START, within);
    }
    if calls.any(Calls::LINE_AT_END) {
        let tangent = part(s.tangent_quadratic(), 1.0 - LINE_PART, 1.0);
        let (far, node) = (
            end_is_inside(tangent[0], lines[1], epsilon),
            end_is_inside(tangent[2], lines[1], epsilon),
        );
        faults.add(Faults::LINE_AT_END, !node);
        faults.add(Faults::LINE_BEFORE_END, !far);
        let within = node && far && !inside(tangent, lines[1], epsilon).holds();
        faults.add(Faults::LINE_INSIDE_END, within);
    }
    faults
}
