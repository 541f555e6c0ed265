//! Families whose tangents solve a tridiagonal system.

use rayon::prelude::*;
use shapespline_banded::{Row, Rows, SolveError, solve_once};
use shapespline_geometry::{DVec3, DataPolygon};

/// How tension makes tangents: a strictly diagonally dominant system whose coefficients depend on it.
///
/// This is all that a family with a global system has to say; [`SolvedFamily`](crate::SolvedFamily)
/// makes a [`TensionFamily`](crate::TensionFamily) of it.
pub trait TensionSystem: Rows + Sync {
    /// Whether tension changes the legs beside a node even where the tangents stay as they are.
    const SCALES_LEGS: bool;

    /// The polygon.
    fn polygon(&self) -> &DataPolygon;

    /// The tension at each distinct node.
    fn tension(&self) -> &[f64];

    /// Sets the tension at a node and appends the rows that change with it to `rows`, in any order.
    fn set_tension(&mut self, node: usize, tension: f64, rows: &mut Vec<usize>);

    /// Makes row `i` of it, which so far was that row under some other tension.
    #[inline]
    fn renew(&self, i: usize, row: &mut Row) {
        *row = self.row(i);
    }

    /// First and last leg of a segment, from the unknowns at its two ends.
    fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2];

    /// As [`TensionFamily::weight`](crate::TensionFamily::weight).
    fn weight(&self, _node: usize) -> f64 {
        1.0
    }
}

/// The end legs of every segment, of a system whose tension stays as it is. O(N).
///
/// # Errors
/// A system that f64 cannot hold.
pub fn solve_legs<S: TensionSystem>(system: &S) -> Result<Vec<[DVec3; 2]>, SolveError> {
    let tangents = solve_once(system)?;
    Ok(collect(system.polygon().segments(), |i| legs_of(system, &tangents, i)))
}

/// `make(0), …, make(count − 1)`, on all threads where there are many.
pub(crate) fn collect<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    const MANY: usize = 16_384;
    if count < 2 * MANY {
        (0..count).map(make).collect()
    } else {
        (0..count).into_par_iter().with_min_len(MANY).map(make).collect()
    }
}

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
