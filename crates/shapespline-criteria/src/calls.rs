//! What the polygon calls for: the index sets (5.34)–(5.39) of paper 001, with its zero tests made
//! relative.

use glam::DVec3;
use rayon::prelude::*;
use shapespline_geometry::{Boundary, DataPolygon, Dimension, length};

use crate::{Criteria, Criterion, Tolerances};

/// From two blocks of this many segments on all threads find the calls.
const BLOCK: usize = 4096;

/// The conditions that a segment is asked to meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Calls(u16);

impl Calls {
    /// `P_m·P_{m+1} > 0`.
    pub const CONVEXITY: Self = Self(1);
    /// `P_m·P_{m+1} < 0`.
    pub const INFLECTION: Self = Self(2);
    /// `Γ_m > 0`.
    pub const RIGHT_TORSION: Self = Self(4);
    /// `Γ_m < 0`.
    pub const LEFT_TORSION: Self = Self(8);
    /// `Γ_m = 0` on a convex quadruple: near the plane on the whole segment.
    pub const COPLANARITY: Self = Self(16);
    /// `Γ_m = 0` on an inflecting quadruple: near the plane on two parts of the segment.
    pub const SPLIT_COPLANARITY: Self = Self(32);
    /// Three points on a line around the segment's first node.
    pub const LINE_AT_START: Self = Self(64);
    /// Three points on a line around the segment's last node.
    pub const LINE_AT_END: Self = Self(128);
    /// `P_m·P_{m+1} > 0` again: the conditions of Definition 3.16 beyond local convexity.
    pub const GLOBAL_CONVEXITY: Self = Self(256);

    /// Whether any call of `other` is among these.
    #[inline]
    #[must_use]
    pub fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether there is no call at all.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The calls together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those of the calls that belong to a set of criteria.
    #[must_use]
    pub fn only(self, criteria: Criteria) -> Self {
        Self(self.0 & Self::of_all(criteria).0)
    }

    /// The calls that belong to a criterion.
    #[must_use]
    pub fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::Convexity => Self::CONVEXITY,
            Criterion::Inflection => Self::INFLECTION,
            Criterion::Torsion => Self::RIGHT_TORSION.and(Self::LEFT_TORSION),
            Criterion::Coplanarity => Self::COPLANARITY.and(Self::SPLIT_COPLANARITY),
            Criterion::Collinearity => Self::LINE_AT_START.and(Self::LINE_AT_END),
            Criterion::GlobalConvexity => Self::GLOBAL_CONVEXITY,
        }
    }

    /// The criteria that the calls belong to.
    #[must_use]
    pub fn criteria(self) -> Criteria {
        Criterion::ALL.into_iter().filter(|&c| self.any(Self::of(c))).collect()
    }

    /// What each segment of a polygon calls for. Cost O(N).
    #[must_use]
    pub fn of_polygon(polygon: &DataPolygon, tolerances: &Tolerances) -> Vec<Self> {
        let planar = Self::is_planar(polygon, tolerances);
        Self::of_part(polygon, tolerances, planar, Criteria::EVERY)
    }

    /// Whether no segment has a torsion: in a planar polygon coplanarity is no question (paper 001,
    /// step 0.0). Cost O(N), and nearly none where the first segments answer.
    #[must_use]
    pub fn is_planar(polygon: &DataPolygon, tolerances: &Tolerances) -> bool {
        let torsion = |i: usize| polygon.gamma(i).abs() > tolerances.zero;
        polygon.dimension() == Dimension::Two || !(0..polygon.segments()).any(torsion)
    }

    /// What each segment of a part of a polygon calls for among some criteria, where it is known
    /// whether the whole polygon [is planar](Self::is_planar).
    pub(crate) fn of_part(
        part: &DataPolygon,
        tolerances: &Tolerances,
        planar: bool,
        criteria: Criteria,
    ) -> Vec<Self> {
        let mut wanted = Self::of_all(criteria);
        if planar {
            wanted.0 &= !Self::of(Criterion::Coplanarity).0;
        }
        let of = |i| Self(of_segment(part, i, tolerances).0 & wanted.0);
        let n = part.segments();
        if n < 2 * BLOCK {
            (0..n).map(of).collect()
        } else {
            (0..n).into_par_iter().with_min_len(BLOCK).map(of).collect()
        }
    }

    fn of_all(criteria: Criteria) -> Self {
        criteria.iter().fold(Self(0), |calls, criterion| calls.and(Self::of(criterion)))
    }
}

#[inline]
fn of_segment(polygon: &DataPolygon, i: usize, tolerances: &Tolerances) -> Calls {
    let zero = tolerances.zero;
    let chords @ [before, own, after] = polygon.directions_around(i);
    let [p, q] = [before.cross(own), own.cross(after)];
    let sines = [p.length(), q.length()];
    let mut calls = Calls::default();

    let gamma = p.dot(after);
    if gamma > zero {
        calls = calls.and(Calls::RIGHT_TORSION);
    } else if gamma < -zero {
        calls = calls.and(Calls::LEFT_TORSION);
    }

    if sines[0] > zero && sines[1] > zero {
        let (cosine, small) = (p.dot(q), zero * (sines[0] * sines[1]));
        let flat = gamma.abs() <= zero && plane_is_known(p, q, sines, tolerances);
        if cosine > small {
            calls = calls.and(Calls::CONVEXITY).and(Calls::GLOBAL_CONVEXITY);
            if flat {
                calls = calls.and(Calls::COPLANARITY);
            }
        } else if cosine < -small {
            calls = calls.and(Calls::INFLECTION);
            if flat {
                calls = calls.and(Calls::SPLIT_COPLANARITY);
            }
        }
    }

    for (side, call) in [Calls::LINE_AT_START, Calls::LINE_AT_END].into_iter().enumerate() {
        if sines[side] <= zero && chords[side].dot(chords[side + 1]) > 0.0 {
            // (5.39): with zero curvature the ends have no line of their own.
            let node = i + side;
            let free = polygon.boundary() == Boundary::ZeroCurvature
                && (node == 0 || node == polygon.segments());
            if !free {
                calls = calls.and(call);
            }
        }
    }
    calls
}

/// Whether `Γ = 0` speaks of a plane, given the binormal vectors and their lengths.
///
/// Of four points the `Γ` of unit chords is the product of two sines of turning and the sine between
/// the binormal vectors. Where a turn is nearly straight that is zero whatever the rest, so both
/// sines have to exceed the square root of the tolerance. (A hiking track rounded to 1e−6 m has a
/// turn of 1e−7: holding the curve's binormal to that took a tension of 3e7.) And the polygon's own
/// binormal vectors have to agree better than the curve is asked to: between `P_m` and `P_{m+1}` any
/// curve has to turn its binormal as far as they differ.
pub(crate) fn plane_is_known(p: DVec3, q: DVec3, sines: [f64; 2], tolerances: &Tolerances) -> bool {
    let turns = tolerances.zero.sqrt();
    let across = p.cross(q).length();
    sines[0] > turns
        && sines[1] > turns
        && across <= 0.5 * tolerances.coplanarity * (sines[0] * sines[1])
}

/// Local parameter `t*` that separates the two parts of an inflecting coplanar segment: where the
/// binormal of a ν-spline flips in the limit of equal and growing tension (paper 001, (5.9)).
///
/// At an end with a given tangent the limit is that of `(1 + ν_0) q_0 = D_0`; the paper's convention
/// `L_{−1} = D_0` there depends on the unit of the parameter, so `L_{−1} = h_0 D_0/6` is taken, which
/// gives the true limit.
#[must_use]
pub fn separation(polygon: &DataPolygon, segment: usize) -> f64 {
    separation_between(polygon, [segment; 2])
}

/// The same for the part of the curve from the start of one segment to the end of another, as if there
/// were no points between.
pub(crate) fn separation_between(polygon: &DataPolygon, [first, last]: [usize; 2]) -> f64 {
    let n = polygon.segments();
    let neighbour = |segment: usize, before: bool| -> f64 {
        let end = if before { segment == 0 } else { segment + 1 == n };
        match (end && !polygon.is_closed(), polygon.tangents()) {
            (true, Some([start, end])) => {
                length(if before { start } else { end }) * polygon.spacing(segment) / 6.0
            }
            (true, None) => length(polygon.chord(segment)),
            (false, _) => {
                let beside = if before { (segment + n - 1) % n } else { (segment + 1) % n };
                length(polygon.chord(beside))
            }
        }
    };
    let h_before = polygon.neighbour_spacings(first)[0];
    let h_after = polygon.neighbour_spacings(last)[1];
    let p = polygon.binormal(first).length() * neighbour(first, true);
    let q = polygon.binormal(last + 1).length() * neighbour(last, false);
    1.0 / (1.0 + (q / p).sqrt() * (h_before / h_after).powf(0.75))
}

/// Direction of the plane normal of a coplanar quadruple: the mean of its two binormal directions,
/// so that it does not depend on the direction the points are run through.
pub(crate) fn plane_normal(p: DVec3, q: DVec3) -> DVec3 {
    let (p, q) = (p.normalize_or_zero(), q.normalize_or_zero());
    (if p.dot(q) < 0.0 { p - q } else { p + q }).normalize_or_zero()
}
