// SPDX-License-Identifier: MIT OR Apache-2.0

//! From derivatives at the nodes to cubic pieces.

use std::collections::BTreeMap;

use shapespline_geometry::{
    BezierPart, CubicSegment, DVec3, DataPolygon, Domain, InputError, PiecewiseCubic,
};

use crate::{
    element::{Legs, Span, T, TAU, pieces},
    units::Units,
};

/// The cubic pieces of a segment, in the user's units.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Pieces {
    /// Where the extra knots lie, in `(0, 1)`.
    pub(crate) breaks: Vec<f64>,
    /// The points there.
    pub(crate) points: Vec<DVec3>,
    /// End legs of each piece.
    pub(crate) legs: Vec<[DVec3; 2]>,
}

/// A jump of the third derivative counts as rounding where it changes the second by less than this share of its
/// largest value on the segment.
const SMOOTH: f64 = 1e-12;

impl Pieces {
    /// One piece between two points, with its end legs.
    pub(crate) fn plain(legs: [DVec3; 2]) -> Self {
        Self { breaks: Vec::new(), points: Vec::new(), legs: vec![legs] }
    }

    /// The pieces of a segment from `start` to `end`; an extra knot where the third derivative does not
    /// jump is left out.
    pub(crate) fn of(span: &Span, legs: &Legs, units: Units, [start, end]: [DVec3; 2]) -> Self {
        let jumps = third_derivative_jumps(legs);
        if jumps == [false; 2] {
            let third = span.length / 3.0 * units.length;
            return Self::plain([legs[0] * third, legs[4] * third]);
        }
        let delta = span.control_legs(legs).map(|leg| leg * units.length);
        let ([first, middle, last], [to_first, to_last]) = pieces(&delta);
        let points = [start + to_first, end + to_last];
        let inner = (1.0 - 2.0 * TAU) / T;
        match jumps {
            [true, true] => Self {
                breaks: vec![TAU, T],
                points: points.to_vec(),
                legs: vec![first, middle, last],
            },
            // Two pieces of one cubic: a leg of the whole is that of the part, over its share.
            [true, false] => Self {
                breaks: vec![TAU],
                points: vec![points[0]],
                legs: vec![first, [middle[0] / inner, last[1] * (T / TAU)]],
            },
            _ => Self {
                breaks: vec![T],
                points: vec![points[1]],
                legs: vec![[first[0] * (T / TAU), middle[1] / inner], last],
            },
        }
    }

    /// The control points as the exported curve has them, seen from `start`.
    pub(crate) fn parts(&self, [start, end]: [DVec3; 2]) -> Vec<BezierPart> {
        let point = |k: usize| match k {
            0 => start,
            _ => self.points.get(k - 1).copied().unwrap_or(end),
        };
        let local = |k: usize| match k {
            0 => 0.0,
            _ => self.breaks.get(k - 1).copied().unwrap_or(1.0),
        };
        let part = |(k, &[a, c]): (usize, &[DVec3; 2])| {
            let piece = CubicSegment::from_end_legs(point(k), point(k + 1), a, c);
            let control = piece.bezier_points().map(|p| (p - start).extend(1.0)).to_vec();
            BezierPart { control, local: [local(k), local(k + 1)] }
        };
        self.legs.iter().enumerate().map(part).collect()
    }
}

/// Whether the third derivative jumps at each extra knot.
fn third_derivative_jumps(d: &Legs) -> [bool; 2] {
    // h Q'' at the breaks.
    let s = [
        (d[1] - d[0]) * (2.0 / TAU),
        (d[2] - d[1]) * (2.0 / T),
        (d[3] - d[2]) * (2.0 / T),
        (d[4] - d[3]) * (2.0 / TAU),
    ];
    let shares = [TAU, 1.0 - 2.0 * TAU, TAU];
    let third: [DVec3; 3] = std::array::from_fn(|k| (s[k + 1] - s[k]) / shares[k]);
    let largest = s.iter().fold(0.0f64, |m, s| m.max(s.length()));
    // Legs are near one in size, and so is what they are rounded by.
    let allowed = SMOOTH * largest + 64.0 * f64::EPSILON;
    [0, 1].map(|k| (third[k + 1] - third[k]).length() * TAU > allowed)
}

/// The curve through the points of a polygon with the end legs of segments of one piece, and the others in
/// several pieces; and the knots that are data points.
pub(crate) fn assemble(
    polygon: &DataPolygon,
    plain: Vec<[DVec3; 2]>,
    mut others: BTreeMap<usize, Pieces>,
) -> Result<(PiecewiseCubic, Vec<usize>), InputError> {
    if others.is_empty() {
        let nodes = (0..=polygon.segments()).collect();
        return Ok((PiecewiseCubic::through(polygon, plain)?, nodes));
    }
    let (u, data) = (polygon.parameters(), polygon.points());
    let (mut knots, mut points, mut legs) = (vec![u[0]], vec![data[0]], Vec::new());
    let mut nodes = vec![0];
    for (i, own) in plain.into_iter().enumerate() {
        match others.remove(&i) {
            None => legs.push(own),
            Some(segment) => {
                let h = u[i + 1] - u[i];
                knots.extend(segment.breaks.iter().map(|t| u[i] + t * h));
                points.extend(segment.points);
                legs.extend(segment.legs);
            }
        }
        knots.push(u[i + 1]);
        points.push(data[i + 1]);
        nodes.push(knots.len() - 1);
    }
    let domain = if polygon.is_closed() { Domain::Closed } else { Domain::Open };
    Ok((PiecewiseCubic::new(knots, points, legs, polygon.dimension(), domain)?, nodes))
}
