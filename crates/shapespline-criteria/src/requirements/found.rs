// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the segments of a polygon require: the index sets (5.34)–(5.39) of paper 001, with its zero tests
//! made relative.

use std::ops::Range;

use glam::DVec3;
use shapespline_geometry::{DataPolygon, Dimension, batch::SegmentBatch, normalize};
use shapespline_polynomial::parallel;

use super::{AFTER, BEFORE, Requirements};
use crate::{Criteria, Criterion, Tolerances, resolution::leave_known};

/// Above two blocks of this many segments all threads find the requirements.
const BLOCK: usize = 4096;

/// The first segments that are asked whether the polygon is planar: most that are not say so at once.
const FIRST: usize = 4;

impl Requirements {
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
        let planes = u64::from(wanted.intersects(Self::of(Criterion::Coplanarity)));
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
            let beside = |j: usize, places: u32| (signs[j] & Self::TURNING_PAIR.bits()) << places;
            let bits = signs[j + 2] | beside(j + 1, BEFORE) | beside(j + 3, AFTER);
            required[j + 2] = Self::from_bits_retain(bits);
        }
        let segments = batch.segments(polygon);
        let inside = segments.start.max(2)..segments.end.min(places - 2);
        if any > 0 {
            for j in inside.clone().filter(|&j| special[j] != 0) {
                let (i, around) = (batch.segment(polygon, j), [j - 1, j, j + 1]);
                let around = around.map(|j| directions.get(j));
                required[j] =
                    required[j].union(of_zeros(polygon, i, around, required[j], tolerances));
            }
        }
        if tolerances.resolution > 0.0 {
            leave_known(polygon, batch, tolerances.resolution, required);
        }
        // Last: whether a plane is asked for depends on a turn, asked for or not.
        let (regular, excuse) = if wanted.intersects(Self::REGULAR) {
            (Self::of(Criterion::Regular), Self::empty())
        } else {
            (Self::REGULAR, Self::DOUBLING_BACK)
        };
        for required in &mut required[inside.clone()] {
            let asked = *required & wanted;
            let spared = (asked & Self::IMPLY_REGULAR) | (*required & excuse);
            *required = asked | if spared.is_empty() { regular } else { Self::empty() };
        }
        required[..inside.start].fill(Self::default());
        required[inside.end..].fill(Self::default());
    }

    /// How many segments require each criterion, in the order of [`Criterion::ALL`].
    pub(crate) fn count(required: &[Self]) -> [usize; Criterion::COUNT] {
        let mut counts = [0; Criterion::COUNT];
        for required in required.chunks(SegmentBatch::OWN) {
            // Most criteria are asked of all segments of a batch or of none.
            let (all, some) = required
                .iter()
                .fold((Self::all(), Self::empty()), |(all, some), &c| (all & c, some | c));
            for (count, criterion) in counts.iter_mut().zip(Criterion::ALL) {
                let of = Self::of(criterion);
                *count += match (some.intersects(of), all.intersects(of)) {
                    (false, _) => 0,
                    (_, false) => required.iter().filter(|own| own.intersects(of)).count(),
                    _ => required.len(),
                };
            }
        }
        counts
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
    const ALONG: Requirements = Requirements::CONVEXITY
        .union(Requirements::GLOBAL_CONVEXITY)
        .union(Requirements::TURNS_ALIKE);
    const AGAINST: Requirements = Requirements::INFLECTION.union(Requirements::TURNS_APART);
    let call = |holds: bool, call: Requirements| if holds { call.bits() } else { 0 };
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
        if signs.intersects(Requirements::CONVEXITY) {
            required = required.union(Requirements::COPLANARITY);
        } else if signs.intersects(Requirements::INFLECTION) {
            required = required.union(Requirements::SPLIT_COPLANARITY);
        }
    }
    for (side, call) in
        [Requirements::LINE_AT_START, Requirements::LINE_AT_END].into_iter().enumerate()
    {
        if sines[side] > tolerances.zero {
            continue;
        }
        if chords[side].dot(chords[side + 1]) < 0.0 {
            required = required.union(Requirements::DOUBLING_BACK);
        } else {
            // (5.39): with zero curvature the ends have no line of their own.
            if !polygon.is_natural_end(i + side) {
                required = required.union(call);
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
            assert_eq!(asked(sine).intersects(torsion), expected, "{sine}");
            assert!(
                asked(sine).intersects(Requirements::CONVEXITY.union(Requirements::INFLECTION)),
                "{sine}"
            );
        }
    }
}
