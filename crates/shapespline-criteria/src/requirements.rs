// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the polygon requires: the index sets (5.34)–(5.39) of paper 001, with its zero tests made
//! relative.

use std::ops::Range;

use glam::DVec3;
use shapespline_geometry::{DataPolygon, Dimension, batch::SegmentBatch, length, normalize};
use shapespline_polynomial::parallel;

use crate::{Criteria, Criterion, Tolerances, resolution::leave_known};

/// Above two blocks of this many segments all threads find the requirements.
const BLOCK: usize = 4096;

/// The first segments that are asked whether the polygon is planar: most that are not say so at once.
const FIRST: usize = 4;

/// The bits of [`Requirements`] that say how the binormal vectors of a pair of nodes lie to each
/// other; those of the pair before and after the segment's own stand two and four places further
/// on.
const ALIKE: u32 = 1 << 11;
const APART: u32 = 1 << 12;
const BEFORE: u32 = 2;
const AFTER: u32 = 4;

/// The conditions that a segment is asked to meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Requirements(u32);

impl Requirements {
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
    /// `P_m ≠ 0`: turning at the segment's first node.
    pub const TURNING_AT_START: Self = Self(512);
    /// `P_{m+1} ≠ 0`: turning at the segment's last node.
    pub const TURNING_AT_END: Self = Self(1024);
    /// `P_m·P_{m+1} > 0`: each node turns along the other's binormal vector as well.
    pub(crate) const TURNS_ALIKE: Self = Self(ALIKE);
    /// `P_m·P_{m+1} < 0`.
    pub(crate) const TURNS_APART: Self = Self(APART);
    /// The same of `P_{m−1}·P_m`, asked at the first node.
    pub(crate) const BEFORE_ALIKE: Self = Self(ALIKE << BEFORE);
    pub(crate) const BEFORE_APART: Self = Self(APART << BEFORE);
    /// The same of `P_{m+1}·P_{m+2}`, asked at the last node.
    pub(crate) const AFTER_ALIKE: Self = Self(ALIKE << AFTER);
    pub(crate) const AFTER_APART: Self = Self(APART << AFTER);
    /// Turning along the binormal vector of the segment's other node, at both.
    pub const TURNING_PAIR: Self = Self::TURNS_ALIKE.and(Self::TURNS_APART);
    /// Turning at the first node along the binormal vector of the node before it.
    pub const TURNING_BEFORE: Self = Self::BEFORE_ALIKE.and(Self::BEFORE_APART);
    /// Turning at the last node along the binormal vector of the node after it.
    pub const TURNING_AFTER: Self = Self::AFTER_ALIKE.and(Self::AFTER_APART);
    /// No criterion that is asked implies that the curve is regular.
    pub const REGULAR: Self = Self(1 << 17);
    /// With it: an end leg that is rounding beside its chord counts as none. Tension may leave so little.
    pub(crate) const LEGS: Self = Self(1 << 18);
    /// By construction the curve is straight before the segment's first node, or after its last one: `ω`
    /// vanishes there, and counts by its sign beside. Asks for nothing.
    pub(crate) const STRAIGHT_BEFORE: Self = Self(1 << 20);
    pub(crate) const STRAIGHT_AFTER: Self = Self(1 << 21);
    /// The polygon doubles back on itself at a node of the segment. Asks for nothing.
    const DOUBLING_BACK: Self = Self(1 << 19);

    /// What a node asks for that a segment begins at, and one that it ends at.
    pub(crate) const AT_START: Self = Self::LINE_AT_START.and(Self::TURNING_AT_START);
    pub(crate) const AT_END: Self = Self::LINE_AT_END.and(Self::TURNING_AT_END);
    /// What the two nodes of a segment ask for together.
    pub(crate) const PAIR: Self =
        Self::CONVEXITY.and(Self::INFLECTION).and(Self::GLOBAL_CONVEXITY).and(Self::TURNING_PAIR);

    /// What a segment asks for only where the polygon turns at both of its nodes.
    pub(crate) const OF_BOTH: Self = Self::PAIR
        .and(Self::RIGHT_TORSION)
        .and(Self::LEFT_TORSION)
        .and(Self::COPLANARITY)
        .and(Self::SPLIT_COPLANARITY);

    /// Whether any requirement of `other` is among these.
    #[inline]
    #[must_use]
    pub fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether there is no requirement at all.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The requirements together.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The requirements that are not among `other`.
    #[must_use]
    pub(crate) const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Those of the requirements that belong to a set of criteria.
    #[must_use]
    pub fn only(self, criteria: Criteria) -> Self {
        Self(self.0 & Self::of_all(criteria).0)
    }

    /// The requirements that belong to a criterion.
    #[must_use]
    pub fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::Convexity => Self::CONVEXITY,
            Criterion::Inflection => Self::INFLECTION,
            Criterion::Turning => Self::TURNING_AT_START
                .and(Self::TURNING_AT_END)
                .and(Self::TURNING_PAIR)
                .and(Self::TURNING_BEFORE)
                .and(Self::TURNING_AFTER),
            Criterion::Torsion => Self::RIGHT_TORSION.and(Self::LEFT_TORSION),
            Criterion::Coplanarity => Self::COPLANARITY.and(Self::SPLIT_COPLANARITY),
            Criterion::Collinearity => Self::LINE_AT_START.and(Self::LINE_AT_END),
            Criterion::GlobalConvexity => Self::GLOBAL_CONVEXITY,
            Criterion::Regular => Self::REGULAR.and(Self::LEGS),
        }
    }

    /// The requirements that imply a regular curve where they are met. A cubic that stops where its
    /// legs are independent has none of them; else `ω` has a double root there, so along no vector
    /// is it positive throughout, or does it change its sign once.
    pub(crate) const IMPLY_REGULAR: Self =
        Self::CONVEXITY.and(Self::INFLECTION).and(Self::RIGHT_TORSION).and(Self::LEFT_TORSION);

    /// The criteria that the requirements belong to.
    #[must_use]
    pub fn criteria(self) -> Criteria {
        Criterion::ALL.into_iter().filter(|&c| self.any(Self::of(c))).collect()
    }

    /// What each segment of a polygon requires. Cost O(N).
    #[must_use]
    pub fn of_polygon(polygon: &DataPolygon, tolerances: &Tolerances) -> Vec<Self> {
        let planar = Self::is_planar(polygon, tolerances);
        Self::among(polygon, tolerances, Self::wanted(Criteria::ALL, planar))
    }

    /// Whether no segment has a torsion: in a planar polygon coplanarity is no question (paper 001,
    /// step 0.0). Cost O(N), and nearly none where the first segments answer.
    #[must_use]
    pub fn is_planar(polygon: &DataPolygon, tolerances: &Tolerances) -> bool {
        let twists = |i: usize| {
            let [before, own, after] = [i - 1, i, i + 1].map(|k| normalize(polygon.chord(k)));
            before.cross(own).dot(after).abs() > tolerances.zero
        };
        let flat = |batch: &mut SegmentBatch, own: Range<usize>| {
            batch.load(polygon, own);
            let (directions, binormals) = (batch.directions(), batch.binormals());
            let mut turns = 0;
            // At place j + BESIDE, as in `of_batch`.
            for j in 0..batch.less(2 * SegmentBatch::BESIDE) {
                let gamma = binormals.get(j + 2).dot(directions.get(j + 4));
                turns += u64::from(gamma.abs() > tolerances.zero);
            }
            turns == 0
        };
        let n = polygon.segments();
        polygon.dimension() == Dimension::Two
            || (!(1..n.saturating_sub(1).min(FIRST)).any(twists) && all_batches(n, flat))
    }

    /// What each segment of a polygon requires among the [wanted](Self::wanted) requirements.
    pub(crate) fn among(polygon: &DataPolygon, tolerances: &Tolerances, wanted: Self) -> Vec<Self> {
        let of = |batch: &mut SegmentBatch, start: usize, required: &mut [Self]| {
            batch.load(polygon, start..start + required.len());
            let mut all = [Self::default(); SegmentBatch::ROOM];
            Self::of_batch(polygon, batch, wanted, tolerances, &mut all);
            required.copy_from_slice(&all[batch.own()]);
        };
        let n = polygon.segments();
        let mut required = vec![Self::default(); n];
        let (own, batch) = (SegmentBatch::OWN, SegmentBatch::default);
        parallel::parts::<_, _, _, ()>(&mut *required, own, 2 * BLOCK, batch, of);
        required
    }

    /// What the segments of a batch require, except at its first and its last two places; nothing
    /// beyond the ends of the polygon.
    pub(crate) fn of_batch(
        polygon: &DataPolygon,
        batch: &SegmentBatch,
        wanted: Self,
        tolerances: &Tolerances,
        required: &mut [Self; SegmentBatch::ROOM],
    ) {
        let (places, zero) = (batch.places(), tolerances.zero);
        let (directions, binormals) = (batch.directions(), batch.binormals());
        let sines = batch.sines();
        let planes = u64::from(wanted.any(Self::of(Criterion::Coplanarity)));
        let (mut signs, mut special) = ([0; SegmentBatch::ROOM], [0; SegmentBatch::ROOM]);
        let mut any = 0;
        for j in 0..batch.less(2) {
            let [p, q] = [binormals.get(j), binormals.get(j + 1)];
            let (gamma, ends) = (p.dot(directions.get(j + 2)), [sines[j], sines[j + 1]]);
            signs[j + 1] = of_signs(gamma, p.dot(q), ends, zero);
            special[j + 1] = (planes & u64::from(gamma.abs() <= zero))
                | u64::from(ends[0] <= zero)
                | u64::from(ends[1] <= zero);
            any |= special[j + 1];
        }
        for j in 0..batch.less(4) {
            let beside = |j: usize, places: u32| (signs[j] & (ALIKE | APART)) << places;
            required[j + 2] = Self(signs[j + 2] | beside(j + 1, BEFORE) | beside(j + 3, AFTER));
        }
        let segments = batch.segments(polygon);
        let inside = segments.start.max(2)..segments.end.min(places - 2);
        if any > 0 {
            for j in inside.clone().filter(|&j| special[j] != 0) {
                let (i, around) = (batch.segment(polygon, j), [j - 1, j, j + 1]);
                let around = around.map(|j| directions.get(j));
                required[j] =
                    required[j].and(of_zeros(polygon, i, around, required[j], tolerances));
            }
        }
        if tolerances.resolution > 0.0 {
            leave_known(polygon, batch, tolerances.resolution, required);
        }
        // Last: whether a plane is asked for depends on a turn, asked for or not.
        let (regular, excuse) = if wanted.any(Self::REGULAR) {
            (Self::of(Criterion::Regular), 0)
        } else {
            (Self::REGULAR, Self::DOUBLING_BACK.0)
        };
        for required in &mut required[inside.clone()] {
            let asked = required.0 & wanted.0;
            let spared = (asked & Self::IMPLY_REGULAR.0) | (required.0 & excuse);
            required.0 = asked | if spared != 0 { 0 } else { regular.0 };
        }
        required[..inside.start].fill(Self::default());
        required[inside.end..].fill(Self::default());
    }

    /// How many segments require each criterion, in the order of [`Criterion::ALL`].
    pub(crate) fn count(required: &[Self]) -> [usize; Criterion::COUNT] {
        let mut counts = [0; Criterion::COUNT];
        for required in required.chunks(SegmentBatch::OWN) {
            // Most criteria are asked of all segments of a batch or of none.
            let (all, some) =
                required.iter().fold((u32::MAX, 0), |(all, some), c| (all & c.0, some | c.0));
            for (count, criterion) in counts.iter_mut().zip(Criterion::ALL) {
                let of = Self::of(criterion);
                *count += match (some & of.0, all & of.0) {
                    (0, _) => 0,
                    (_, 0) => required.iter().filter(|required| required.any(of)).count(),
                    _ => required.len(),
                };
            }
        }
        counts
    }

    /// The requirements that belong to some criteria, in a polygon that is planar or not.
    pub(crate) fn wanted(criteria: Criteria, planar: bool) -> Self {
        let all = Self::of_all(criteria).0;
        Self(if planar { all & !Self::of(Criterion::Coplanarity).0 } else { all })
    }

    /// The requirements, for arithmetic on several segments at once.
    #[inline(always)]
    pub(crate) fn bits(self) -> u32 {
        self.0
    }

    fn of_all(criteria: Criteria) -> Self {
        criteria.iter().fold(Self(0), |required, criterion| required.and(Self::of(criterion)))
    }
}

/// Whether all batches of `count` segments pass a test, on all threads if there are many.
fn all_batches(
    count: usize,
    test: impl Fn(&mut SegmentBatch, Range<usize>) -> bool + Sync + Send,
) -> bool {
    let own = |k: usize| k * SegmentBatch::OWN..((k + 1) * SegmentBatch::OWN).min(count);
    let batches = count.div_ceil(SegmentBatch::OWN);
    // An option ends with the first batch that fails.
    let test = |batch: &mut SegmentBatch, k: usize| test(batch, own(k)).then_some(());
    let many = 2 * BLOCK / SegmentBatch::OWN;
    parallel::map_with::<_, _, Option<()>>(batches, many, SegmentBatch::default, test).is_some()
}

/// What `Γ`, `P_m·P_{m+1}` and the sines of the turns require. Without branches: most segments ask for
/// nothing else.
#[inline(always)]
fn of_signs(gamma: f64, cosine: f64, sines: [f64; 2], zero: f64) -> u32 {
    const ALONG: Requirements =
        Requirements::CONVEXITY.and(Requirements::GLOBAL_CONVEXITY).and(Requirements::TURNS_ALIKE);
    const AGAINST: Requirements = Requirements::INFLECTION.and(Requirements::TURNS_APART);
    let call = |holds: bool, call: Requirements| if holds { call.0 } else { 0 };
    let (start, end) = (sines[0] > zero, sines[1] > zero);
    let small = zero * (sines[0] * sines[1]);
    // As with planes: the torsion of a turn that is nearly straight is below the accuracy of the data.
    let clear = zero.sqrt();
    let twists = (sines[0] > clear) & (sines[1] > clear);
    call(twists & (gamma > zero), Requirements::RIGHT_TORSION)
        | call(twists & (gamma < -zero), Requirements::LEFT_TORSION)
        | call(start & end & (cosine > small), ALONG)
        | call(start & end & (cosine < -small), AGAINST)
        | call(start, Requirements::TURNING_AT_START)
        | call(end, Requirements::TURNING_AT_END)
}

/// What a segment requires where something is zero, beside what `of_signs` found.
fn of_zeros(
    polygon: &DataPolygon,
    i: usize,
    chords: [DVec3; 3],
    signs: Requirements,
    tolerances: &Tolerances,
) -> Requirements {
    let [before, own, after] = chords;
    let [p, q] = [before.cross(own), own.cross(after)];
    let sines = [p.length(), q.length()];
    let mut required = Requirements::default();
    if p.dot(after).abs() <= tolerances.zero && plane_is_known(p, q, sines, tolerances) {
        if signs.any(Requirements::CONVEXITY) {
            required = required.and(Requirements::COPLANARITY);
        } else if signs.any(Requirements::INFLECTION) {
            required = required.and(Requirements::SPLIT_COPLANARITY);
        }
    }
    for (side, call) in
        [Requirements::LINE_AT_START, Requirements::LINE_AT_END].into_iter().enumerate()
    {
        if sines[side] > tolerances.zero {
            continue;
        }
        if chords[side].dot(chords[side + 1]) < 0.0 {
            required = required.and(Requirements::DOUBLING_BACK);
        } else {
            // (5.39): with zero curvature the ends have no line of their own.
            if !polygon.is_natural_end(i + side) {
                required = required.and(call);
            }
        }
    }
    required
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    /// Whether the first segments answer or all are looked at.
    #[test]
    fn planar_is_what_twists_no_more_than_the_tolerance() {
        let planar = |n: usize, lift: fn(usize) -> f64| {
            let at = |k: usize| DVec3::new(k as f64, (0.7 * k as f64).sin(), lift(k));
            let points = (0..=n).map(at).collect();
            let ends = Boundary::ZeroCurvature;
            let polygon = DataPolygon::new(points, &Parametrization::Uniform, ends).unwrap();
            Requirements::is_planar(&polygon, &Tolerances::default())
        };
        for n in [1, 2, 3, 4, 5, 70, 2 * BLOCK + 3] {
            assert!(planar(n, |_| 0.0) && planar(n, |k| 1e-12 * (k as f64).cos()), "{n}");
            // Three chords are the least that twist.
            let twists = n >= 3;
            assert_eq!(planar(n, |k| 1e-6 * (k as f64).cos()), !twists, "{n}");
            assert_eq!(planar(n, |k| if k == 3 { 1e-6 } else { 0.0 }), !twists, "{n}");
        }
        assert!(!planar(70, |k| if k == 69 { 1e-6 } else { 0.0 }));
        assert!(!planar(3 * BLOCK, |k| if k == 3 * BLOCK { 1e-6 } else { 0.0 }));
    }

    /// Also in the first or the last segment, by its end tangent.
    #[test]
    fn what_twists_in_one_segment_only_is_not_planar() {
        let at = |k: usize| DVec3::new(k as f64, (0.7 * k as f64).sin(), 0.0);
        let planar = |points: Vec<DVec3>, ends: Boundary| {
            let polygon = DataPolygon::new(points, &Parametrization::Uniform, ends).unwrap();
            Requirements::is_planar(&polygon, &Tolerances::default())
        };
        let (flat, leaving) = (DVec3::new(1.0, 0.3, 0.0), DVec3::new(0.2, 1.0, 0.5));
        for n in [2, 3, 9, 63, 64, 65, 130, 2 * BLOCK, 2 * BLOCK + 3] {
            let points: Vec<DVec3> = (0..=n).map(at).collect();
            assert!(planar(points.clone(), Boundary::tangents(flat, flat)), "{n}");
            assert!(!planar(points.clone(), Boundary::tangents(leaving, flat)), "{n}");
            assert!(!planar(points.clone(), Boundary::tangents(flat, leaving)), "{n}");
            assert!(!planar(points, Boundary::tangents(None, leaving)), "{n}");
        }
    }

    /// As with planes: below the square root of the tolerance a turn has no osculating plane to speak of.
    #[test]
    fn torsion_is_asked_only_where_both_ends_turn_clearly() {
        let asked = |sine: f64| {
            let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, sine, 0.0], [3.0, 0.5, 1.0]];
            let points = points.map(DVec3::from).to_vec();
            let ends = Boundary::ZeroCurvature;
            let polygon = DataPolygon::new(points, &Parametrization::Chordal, ends).unwrap();
            Requirements::of_polygon(&polygon, &Tolerances::default())[1]
        };
        let torsion = Requirements::of(Criterion::Torsion);
        // The tolerance is 1e−9; these determinants are all above it.
        for (sine, expected) in [(1e-3, true), (1e-4, true), (1e-5, false), (1e-7, false)] {
            assert_eq!(asked(sine).any(torsion), expected, "{sine}");
            assert!(
                asked(sine).any(Requirements::CONVEXITY.and(Requirements::INFLECTION)),
                "{sine}"
            );
        }
    }
}
