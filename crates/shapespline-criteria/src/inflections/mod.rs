// SPDX-License-Identifier: MIT OR Apache-2.0

//! Inflection counts of polygons and curves (paper 002, sections 4, 5 and 7).
//!
//! Seen from a direction `w` a polygon shows `S(w·V_1, …, w·V_{n−1})` inflections with
//! `V_i = L_i × L_{i+1}` (Definition 5.4, whose last index is printed n), a curve the strict sign changes
//! of `w·K`, where `K` is `γ'×γ''` up to positive factors, and `u⁻×u⁺` at a corner (5.2). The inflection
//! count `I` is the most over all directions.
//!
//! For polygons and for curves of polynomial pieces up to degree three that maximum is found exactly, by
//! walks along what divides the directions that see different numbers (`sweep`): the great circles
//! normal to the `V_i`, or to `K` where pieces meet, and the curve of tangents itself, along which two
//! inflections fall together. For a curve in a plane it is the count seen from the normal (Corollary
//! 5.3); one cubic that is not planar has 2 (Theorem 7.2). For other curves in space the count is
//! *attained*, by a direction that is handed back, but another direction might show more: it is the
//! exact maximum over ever more values of `K`, and says so.

mod arrangement;
mod roots;
mod sign_sequence;
mod traversal;

use std::ops::ControlFlow;

use glam::DVec3;
use shapespline_geometry::{Coordinates, Dimension, InputError, PiecewiseBezier, normalize};

use self::{
    arrangement::most,
    sign_sequence::{NOISE, STRAIGHT, Sequence, along, from_beside, hidden_from_beside, lies_in},
    traversal::Maximum,
};
use crate::arbitrary_degree::{Piece, Segment, corners};

/// Number of inflections, and a direction that shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InflectionCount {
    /// The number.
    pub count: usize,
    /// Unit vector along which so many are seen.
    pub direction: DVec3,
    /// Whether the number is certain: from a given direction, unless a value of zero curvature
    /// cannot be told from a change of sign; over all directions, unless another might show more.
    pub exact: bool,
}

/// The inflection count of a polygon: in space the most seen from any direction, in the plane the
/// one there is. Exact, where directions that rounding cannot tell apart count as one; cost
/// O(n² log n) in space, O(n) in the plane, memory O(n).
///
/// # Errors
/// Points that are not finite, repeated neighbours.
pub fn polygon_inflections(
    points: &[DVec3],
    dimension: Dimension,
) -> Result<InflectionCount, InputError> {
    let count = polygon_inflections_with(points, dimension, &|| ControlFlow::Continue(()))?;
    Ok(count.unwrap_or(NONE))
}

/// As [`polygon_inflections`], with a question whether to go on, which is asked every few hundred
/// microseconds (from any thread); no count if it breaks off.
///
/// # Errors
/// Points that are not finite, repeated neighbours.
pub fn polygon_inflections_with(
    points: &[DVec3],
    dimension: Dimension,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Option<InflectionCount>, InputError> {
    if dimension == Dimension::Two {
        return polygon_inflections_from(points, dimension, DVec3::Z).map(Some);
    }
    let turns = turns(points, dimension)?;
    let sequence = Sequence::of_vectors(turns.iter().copied());
    let seen = |direction: DVec3| InflectionCount {
        count: changes(&turns, direction),
        direction,
        exact: true,
    };
    Ok(most(&sequence, go_on).map(|most| witness(&most, &sequence, seen)))
}

/// Of curves and points that do not turn.
const NONE: InflectionCount = InflectionCount { count: 0, direction: DVec3::Z, exact: true };

/// The inflections of a polygon seen from a direction. Cost O(n).
///
/// # Errors
/// Points that are not finite, repeated neighbours, a direction of zero.
pub fn polygon_inflections_from(
    points: &[DVec3],
    dimension: Dimension,
    direction: DVec3,
) -> Result<InflectionCount, InputError> {
    let direction = unit(direction)?;
    let turns = turns(points, dimension)?;
    // Where the polygon hardly turns rounding may have turned the vector further than it leans; and from
    // between vectors that count as one (see `sweep`) one of them leans no further than this. A right
    // angle is one where the vector is known to be at it.
    let told = |(v, error): &(DVec3, f64)| {
        let x = v.dot(direction).abs();
        (x <= ZERO && *error <= STRAIGHT) || x > 8.0 * (error + 4.0 * f64::EPSILON)
    };
    let (count, exact) = (changes(&turns, direction), turns.iter().all(told));
    Ok(InflectionCount { count, direction, exact })
}

/// Cosines that count as a right angle.
const ZERO: f64 = 8.0 * f64::EPSILON;

/// Strict sign changes of the unit vectors seen along a direction.
fn changes(turns: &[(DVec3, f64)], direction: DVec3) -> usize {
    let (mut changes, mut last) = (0, 0.0);
    for x in turns.iter().map(|t| t.0.dot(direction)).filter(|x| x.abs() > ZERO) {
        changes += usize::from(last * x < 0.0);
        last = x.signum();
    }
    changes
}

/// The unit vectors along `V_i`, where the polygon turns, with what rounding can have turned them by.
fn turns(points: &[DVec3], dimension: Dimension) -> Result<Vec<(DVec3, f64)>, InputError> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        let coordinates = points[index].to_array();
        let value = coordinates.into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
        return Err(InputError::NotFinite { argument: "points", index, value });
    }
    if let Some(i) = points.windows(2).position(|w| w[0] == w[1]) {
        let value = Coordinates { vector: points[i], dimension };
        return Err(InputError::RepeatedPoint { index: i + 1, value });
    }
    let chords: Vec<DVec3> = points.windows(2).map(|w| normalize(w[1] - w[0])).collect();
    let turn = |w: &[DVec3]| w[0].cross(w[1]);
    let bends = chords.windows(2).map(turn).filter(|v| v.length() > STRAIGHT);
    Ok(bends.map(|v| towards(v, 4.0 * f64::EPSILON)).collect())
}

/// The direction of a vector that carries an error of some size, and how far that can have turned it.
fn towards(v: DVec3, error: f64) -> (DVec3, f64) {
    (v.normalize(), error / v.length() + f64::EPSILON)
}

fn unit(direction: DVec3) -> Result<DVec3, InputError> {
    let unit = normalize(direction);
    if unit == DVec3::ZERO {
        let (argument, value) = ("direction", direction.length());
        let allowed = "a finite vector that is not zero";
        return Err(InputError::Scalar { argument, value, allowed });
    }
    Ok(unit)
}

/// The inflections of a curve seen from a direction, by certified isolation of the roots of `w·K`.
///
/// # Errors
/// A direction of zero.
pub fn curve_inflections_from(
    curve: &PiecewiseBezier,
    direction: DVec3,
) -> Result<InflectionCount, InputError> {
    Ok(seen_from(&pieces(curve), unit(direction)?))
}

/// The most inflections of a curve over all directions; in the plane the ones there are.
///
/// Of polynomial pieces up to degree three the maximum is exact (see [`InflectionCount::exact`]), cost
/// O(n² log n), memory O(n) for n pieces. Pieces whose osculating planes agree to `1e−9` where they meet
/// count as smooth.
#[must_use]
pub fn curve_inflections(curve: &PiecewiseBezier) -> InflectionCount {
    curve_inflections_with(curve, &|| ControlFlow::Continue(())).unwrap_or(NONE)
}

/// As [`curve_inflections`], with a question whether to go on, which is asked every few hundred
/// microseconds (from any thread); no count if it breaks off.
#[must_use]
pub fn curve_inflections_with(
    curve: &PiecewiseBezier,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Option<InflectionCount> {
    let segment = pieces(curve);
    if curve.dimension() == Dimension::Two {
        return Some(seen_from(&segment, DVec3::Z));
    }
    let seen = |direction: DVec3| seen_from(&segment, direction);
    if let Some(sequence) = Sequence::of_cubics(&segment) {
        let most = most(&sequence, go_on)?;
        let found = witness(&most, &sequence, seen);
        let exact = found.exact && !sequence.open && most.upper <= found.count;
        return Some(InflectionCount { exact, ..found });
    }
    if let Some(normal) = plane(&segment) {
        let (found, beside) = (seen(normal), counted(&segment, normal, true));
        let exact = found.exact && beside.exact && beside.count <= found.count;
        return Some(InflectionCount { exact, ..found });
    }
    let mut best = InflectionCount { exact: false, ..NONE };
    // No more values than take a second or so.
    let budget = 4096 / segment.pieces.len();
    let mut steps = 4;
    loop {
        let sequence = Sequence::of_vectors(bends(&segment, steps));
        let found = witness(&most(&sequence, go_on)?, &sequence, seen);
        let grown = found.count > best.count;
        if grown || steps == 4 {
            // `ω` of a polynomial piece of degree d has degree 2d − 4.
            let d = curve.degree();
            let single = segment.pieces.len() == 1 && !curve.is_rational();
            let full = single && found.count >= (2 * d).saturating_sub(4);
            best = InflectionCount { exact: found.exact && full, ..found };
        }
        steps *= 2;
        if best.exact || (!grown && steps > 16) || steps > budget.max(8) {
            return Some(best);
        }
    }
}

/// Halvings of the distance from the boundary of a cell.
const HALVINGS: usize = 50;

/// The count in the cell that a walk has found, seen from within it.
fn witness(
    most: &Maximum,
    sequence: &Sequence,
    seen: impl Fn(DVec3) -> InflectionCount,
) -> InflectionCount {
    // Half way to the nearest great circle; the nearest arc may be nearer.
    let distances = sequence.lines.iter().map(|line| line.v.dot(most.boundary).abs());
    let own = |d: &f64| *d > 1e-12;
    let mut step = 0.5 * distances.filter(own).fold(1.0, f64::min);
    let mut best = seen((most.boundary + most.inwards * step).normalize());
    for _ in 0..HALVINGS {
        if best.count >= most.count && best.exact {
            break;
        }
        step *= 0.5;
        let next = seen((most.boundary + most.inwards * step).normalize());
        if (next.count, next.exact) > (best.count, best.exact) {
            best = next;
        }
    }
    if best.count < most.count {
        // The cell is thinner than rounding: vectors all but opposite bound it. Another may show as many.
        for line in &sequence.lines {
            let next = seen(line.v);
            if next.count > best.count {
                best = next;
            }
        }
        best.exact &= best.count >= most.count;
    }
    best
}

/// All pieces as one segment; between them only directions matter.
fn pieces(curve: &PiecewiseBezier) -> Segment {
    let breaks = curve.breaks();
    let one = |i: usize| {
        let first = curve.piece(i)[0];
        let origin = first.truncate() / first.w;
        let parts = curve.between([breaks[i], breaks[i + 1]], origin);
        Segment::exact(&parts, curve.is_rational())
    };
    let pieces = (0..curve.pieces()).flat_map(|i| one(i).pieces).collect();
    Segment { pieces }
}

fn seen_from(segment: &Segment, direction: DVec3) -> InflectionCount {
    counted(segment, direction, false)
}

/// With `beside`, along the normal of a plane: no direction shows more.
fn counted(segment: &Segment, direction: DVec3, beside: bool) -> InflectionCount {
    let (mut count, mut exact, mut last) = (0, true, None);
    let mut take = |sign: bool| {
        count += usize::from(last.is_some_and(|l| l != sign));
        last = Some(sign);
    };
    let mut joints = corners(segment);
    for piece in &segment.pieces {
        let omega = piece.omega();
        let along = if beside { from_beside(&omega, direction) } else { along(&omega, direction) };
        let (signs, open) = along.signs();
        // What is straight but for rounding, or seen from within its plane, turns one way and the other;
        // and planes within `STRAIGHT` of each other count as one.
        let unclear = (NOISE * along.error()).max(STRAIGHT * omega.bound());
        let noise = !signs.is_empty() && along.bound() <= unclear;
        exact &= !open && !noise;
        signs.into_iter().for_each(&mut take);
        if let Some((_, turn, error)) = joints.next() {
            let off = if beside { turn.cross(direction).length() } else { 0.0 };
            let along = turn.dot(direction);
            // Next to a tangent that is short beside its piece, rounding makes a corner, or hides one.
            exact &= error <= STRAIGHT || along.abs() > NOISE * error;
            if along.abs() > hidden_from_beside(error.max(STRAIGHT), off) {
                take(along > 0.0);
            }
        }
    }
    InflectionCount { count, direction, exact }
}

/// Unit vectors along `K` at `steps + 1` parameters a piece, where it does not vanish.
fn bends(segment: &Segment, steps: usize) -> Vec<(DVec3, f64)> {
    let mut bends = Vec::new();
    let mut joints = corners(segment);
    for piece in &segment.pieces {
        let omega = piece.omega();
        let clear = (STRAIGHT * omega.bound()).max(1e3 * omega.error());
        let values = (0..=steps).map(|k| omega.value(k as f64 / steps as f64));
        bends.extend(values.filter(|v| v.length() > clear).map(|v| towards(v, omega.error())));
        if let Some((_, turn, error)) = joints.next().filter(|j| j.1.length() > STRAIGHT) {
            bends.push(towards(turn, error));
        }
    }
    bends
}

/// The normal of the plane that the whole curve lies in, if it does to within rounding.
fn plane(segment: &Segment) -> Option<DVec3> {
    let omegas: Vec<_> = segment.pieces.iter().map(Piece::omega).collect();
    let turns = || corners(segment).filter(|(_, turn, error)| turn.length() > error.max(STRAIGHT));
    // The direction that is known best: the largest in terms of its error.
    let bends = omegas.iter().flat_map(|o| o.coefficients().iter().map(|c| (*c, o.error())));
    let known = bends.chain(turns().map(|(_, turn, error)| (turn, error)));
    let known = known.filter(|(v, error)| v.length() > *error);
    let best = known.max_by(|a, b| (a.0.length() / a.1).total_cmp(&(b.0.length() / b.1)));
    let normal = best.map_or(DVec3::Z, |(v, _)| v.normalize());
    let off =
        |(_, turn, error): (f64, DVec3, f64)| turn.cross(normal).length() > error.max(STRAIGHT);
    (omegas.iter().all(|omega| lies_in(omega, normal)) && !turns().any(off)).then_some(normal)
}
