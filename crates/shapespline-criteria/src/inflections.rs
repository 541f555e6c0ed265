//! Inflection counts of polygons and curves (paper 002, sections 4, 5 and 7).
//!
//! Seen from a direction `w` a polygon shows `S(w·V_1, …, w·V_{n−1})` inflections with
//! `V_i = L_i × L_{i+1}` (Definition 5.4, whose last index is printed n), a curve the strict sign changes
//! of `w·K`, where `K` is `γ'×γ''` up to positive factors, and `u⁻×u⁺` at a corner (5.2). The inflection
//! count `I` is the most over all directions.
//!
//! For polygons that maximum is found exactly (Definition 5.4). For a curve in a plane it is the count
//! seen from the normal (Corollary 5.3); for one cubic that is not planar it is 2 (Theorem 7.2). For other
//! curves in space the count is *attained*, by a direction that is handed back, but another direction
//! might show more: it is found as the exact maximum over ever more values of `K`, and says so.

use glam::DVec3;
use shapespline_geometry::{Dimension, InputError, PiecewiseBezier, normalize};

use crate::{
    general::{Segment, corners},
    sign_changes::{Direction, most, strict},
};

/// Number of inflections, and a direction that shows them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct InflectionCount {
    /// The number.
    pub count: usize,
    /// Unit vector along which so many are seen.
    pub direction: DVec3,
    /// Whether the number is certain: from a given direction, unless a value of zero curvature
    /// cannot be told from a change of sign; over all directions, unless another might show more.
    pub exact: bool,
}

/// Sine of the turning angle below which three points count as collinear.
const STRAIGHT: f64 = 1e-9;

/// The inflection count of a polygon: in space the most seen from any direction, in the plane the
/// one there is. Exact; cost O(n² log n) in space, O(n) in the plane.
///
/// # Errors
/// Points that are not finite, repeated neighbours.
pub fn polygon_inflections(
    points: &[DVec3],
    dimension: Dimension,
) -> Result<InflectionCount, InputError> {
    if dimension == Dimension::Two {
        return polygon_inflections_from(points, DVec3::Z);
    }
    let (count, direction) = most(&turns(points)?);
    Ok(InflectionCount { count, direction, exact: true })
}

/// The inflections of a polygon seen from a direction. Cost O(n).
///
/// # Errors
/// Points that are not finite, repeated neighbours, a direction of zero.
pub fn polygon_inflections_from(
    points: &[DVec3],
    direction: DVec3,
) -> Result<InflectionCount, InputError> {
    let direction = unit(direction)?;
    let turns = turns(points)?;
    let count = strict(turns.iter().map(|t| t.v.dot(direction)), 8.0 * f64::EPSILON);
    Ok(InflectionCount { count, direction, exact: true })
}

/// The unit vectors along `V_i`, where the polygon turns.
fn turns(points: &[DVec3]) -> Result<Vec<Direction>, InputError> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        let coordinates = points[index].to_array();
        let value = coordinates.into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
        return Err(InputError::NotFinite { argument: "points", index, value });
    }
    if let Some(i) = points.windows(2).position(|w| w[0] == w[1]) {
        return Err(InputError::RepeatedPoint { index: i + 1, value: points[i] });
    }
    let chords: Vec<DVec3> = points.windows(2).map(|w| normalize(w[1] - w[0])).collect();
    let turn = |w: &[DVec3]| w[0].cross(w[1]);
    let bends = chords.windows(2).map(turn).filter(|v| v.length() > STRAIGHT);
    Ok(bends.map(|v| towards(v, 4.0 * f64::EPSILON)).collect())
}

/// The direction of a vector that carries an error of some size.
fn towards(v: DVec3, error: f64) -> Direction {
    Direction { v: v.normalize(), error: error / v.length() + f64::EPSILON }
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
#[must_use]
pub fn curve_inflections(curve: &PiecewiseBezier) -> InflectionCount {
    let segment = pieces(curve);
    if curve.dimension() == Dimension::Two {
        return seen_from(&segment, DVec3::Z);
    }
    let mut best = InflectionCount { count: 0, direction: DVec3::Z, exact: true };
    // No more values than take a second or so.
    let budget = (4096 / segment.pieces.len()).max(2);
    let mut steps = 4;
    loop {
        let bends = bends(&segment, steps);
        let planar = is_planar(&bends);
        let (_, direction) = most(&bends);
        let seen = seen_from(&segment, direction);
        let grown = seen.count > best.count;
        if grown || steps == 4 {
            // `ω` of a polynomial piece of degree d has degree 2d − 4.
            let d = curve.degree();
            let single = segment.pieces.len() == 1 && !curve.is_rational();
            let full = single && seen.count >= (2 * d).saturating_sub(4);
            best = InflectionCount { exact: seen.exact && (planar || full), ..seen };
        }
        steps *= 2;
        if best.exact || (!grown && steps > 16) || steps > budget.max(8) {
            return best;
        }
    }
}

/// All pieces as one segment; between them only directions matter.
fn pieces(curve: &PiecewiseBezier) -> Segment {
    let breaks = curve.breaks();
    let one = |i: usize| {
        let first = curve.piece(i)[0];
        let origin = first.truncate() / first.w;
        let parts = curve.between([breaks[i], breaks[i + 1]], origin);
        Segment::new(&parts, curve.is_rational(), 0.0)
    };
    let pieces = (0..curve.pieces()).flat_map(|i| one(i).pieces).collect();
    Segment { pieces }
}

fn seen_from(segment: &Segment, direction: DVec3) -> InflectionCount {
    let (mut count, mut exact, mut last) = (0, true, None);
    let mut take = |sign: bool| {
        count += usize::from(last.is_some_and(|l| l != sign));
        last = Some(sign);
    };
    let mut joints = corners(segment);
    for piece in &segment.pieces {
        let (signs, open) = piece.omega().map(1.0, |w| w.dot(direction)).signs();
        exact &= !open;
        signs.into_iter().for_each(&mut take);
        if let Some((_, turn, error)) = joints.next() {
            let turn = turn.dot(direction);
            if turn.abs() > error.max(STRAIGHT) {
                take(turn > 0.0);
            }
        }
    }
    InflectionCount { count, direction, exact }
}

/// Unit vectors along `K` at `steps + 1` parameters a piece, where it does not vanish.
fn bends(segment: &Segment, steps: usize) -> Vec<Direction> {
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

fn is_planar(bends: &[Direction]) -> bool {
    bends.iter().all(|w| w.v.cross(bends[0].v).length() <= 1e-8)
}
