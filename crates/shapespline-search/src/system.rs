// SPDX-License-Identifier: MIT OR Apache-2.0

//! Families whose tangents solve a tridiagonal system.

use std::ops::Range;

use shapespline_banded::{Row, Rows, SolveError, solve_once};
use shapespline_geometry::{DVec3, DataPolygon, Span};
use shapespline_polynomial::parallel;

/// How tension makes tangents: a strictly diagonally dominant system whose coefficients depend on it.
///
/// This is all that a family with a global system has to say; [`SolvedFamily`](crate::SolvedFamily)
/// makes a [`TensionFamily`](crate::TensionFamily) of it.
pub trait TensionSystem: Rows + Sync {
    /// Tensions per node, as [`TensionFamily::SIDES`](crate::TensionFamily::SIDES).
    const SIDES: usize = 1;

    /// Whether tension changes the legs beside a node even where the tangents stay as they are.
    const TENSION_SCALES_LEGS: bool;

    /// The polygon.
    fn polygon(&self) -> &DataPolygon;

    /// The tensions, as [`TensionFamily::tension`](crate::TensionFamily::tension).
    fn tension(&self) -> &[f64];

    /// Sets a tension, by its index.
    fn set_tension(&mut self, index: usize, tension: f64);

    /// Appends the rows that change with a tension to `rows`, in any order.
    fn dependent_rows(&self, index: usize, rows: &mut Vec<usize>);

    /// Makes row `i` of it, which so far was that row under some other tension.
    #[inline]
    fn refresh_row(&self, i: usize, row: &mut Row) {
        *row = self.row(i);
    }

    /// First and last leg of a segment, from the unknowns at its two ends.
    fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2];

    /// As [`TensionFamily::tension_unit`](crate::TensionFamily::tension_unit).
    fn tension_unit(&self, _node: usize) -> f64 {
        1.0
    }
}

/// [`Rows::try_each`] of a system whose row of a node is made of the segments beside it: each of them is
/// looked up once. `inside` makes rows of inner nodes, `row` those of the ends.
///
/// # Errors
/// That of the row that was refused.
#[inline]
pub fn try_each_row<E>(
    polygon: &DataPolygon,
    rows: Range<usize>,
    inside: impl Fn(usize, [Span; 2]) -> Row,
    row: impl Fn(usize) -> Row,
    mut take: impl FnMut(usize, Row) -> Result<(), E>,
) -> Result<(), E> {
    let inner = rows.start.max(1)..rows.end.min(polygon.segments());
    if inner.is_empty() {
        return rows.into_iter().try_for_each(|i| take(i, row(i)));
    }
    (rows.start..inner.start).try_for_each(|i| take(i, row(i)))?;
    let mut before = polygon.span(inner.start - 1);
    inner.clone().zip(polygon.spans(inner.clone())).try_for_each(|(i, after)| {
        let spans = [std::mem::replace(&mut before, after), after];
        take(i, inside(i, spans))
    })?;
    (inner.end..rows.end).try_for_each(|i| take(i, row(i)))
}

/// The end legs of every segment, of a system whose tension stays as it is. O(N).
///
/// # Errors
/// A system that f64 cannot hold.
pub(crate) fn solve_legs<S: TensionSystem>(system: &S) -> Result<Vec<[DVec3; 2]>, SolveError> {
    let tangents = solve_once(system)?;
    Ok(parallel::map(system.polygon().segments(), MANY, |i| legs_of(system, &tangents, i)))
}

/// Segments from which on their legs are made on all threads.
pub(crate) const MANY: usize = 32_768;

#[inline(always)]
pub(crate) fn legs_of<S: TensionSystem>(
    system: &S,
    tangents: &[DVec3],
    segment: usize,
) -> [DVec3; 2] {
    // Of closed data the last point is the first.
    let next = tangents.get(segment + 1).unwrap_or(&tangents[0]);
    system.legs(segment, [tangents[segment], *next])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    #[test]
    fn rows_come_in_order_each_from_the_segments_beside_it() {
        let at = |k: usize| DVec3::new(k as f64, (k * k) as f64, 0.0);
        for boundary in [Boundary::ZeroCurvature, Boundary::Circular] {
            let points = (0..8).map(at).collect();
            let polygon = DataPolygon::new(points, &Parametrization::Uniform, boundary).unwrap();
            let n = polygon.segments();
            let plain = |i: usize| {
                let inner = i > 0 && i < n;
                let [lower, upper] =
                    if inner { [polygon.chord(i - 1).y, polygon.chord(i).y] } else { [0.0; 2] };
                Row { lower, diagonal: i as f64, upper, right: DVec3::ZERO }
            };
            let inside = |i: usize, [before, after]: [Span; 2]| {
                assert_eq!([before.1, after.1], [polygon.spacing(i - 1), polygon.spacing(i)]);
                let right = DVec3::ZERO;
                Row { lower: before.0.y, diagonal: i as f64, upper: after.0.y, right }
            };
            for rows in [0..n + 1, 1..n, 0..1, n..n + 1, 3..4, 5..5, 0..n, 2..n + 1] {
                let mut seen = Vec::new();
                let take = |i: usize, row: Row| {
                    seen.push((i, row));
                    // All are taken but a fifth.
                    if seen.len() < 5 { Ok(()) } else { Err(i) }
                };
                let done = try_each_row(&polygon, rows.clone(), inside, plain, take);
                assert_eq!(done, if rows.len() < 5 { Ok(()) } else { Err(rows.start + 4) });
                assert!(seen.into_iter().eq(rows.take(5).map(|i| (i, plain(i)))));
            }
        }
    }
}
