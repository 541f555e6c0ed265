// SPDX-License-Identifier: MIT OR Apache-2.0

//! Elimination and back substitution of a whole open system, on all threads where it is long.
//!
//! What a row inherits from the rows before it dies away geometrically, and in floating point
//! altogether (see [`crate::UpdatableSolver`]). So each part of a long system begins some rows
//! early with nothing inherited, and has met the true numbers, bit for bit, when it comes to its
//! own rows. That is verified: where a part began with other numbers than the one before it ended
//! with, it is done again until the two meet. The result is that of one run from end to end, for
//! any number of threads.

use glam::DVec3;
use shapespline_polynomial::parallel;

use crate::{Row, Rows, SolveError, error::checked_pivot};

/// Rows a part.
const PART: usize = 16_384;
/// Rows before its own from which a part begins: two or three times as many as measured on random
/// ν-splines.
pub(crate) const EARLY: usize = 128;

/// What a row hands to the next: `x[i] = reduced − ratio x[i+1]`.
pub(crate) type Eliminated = (f64, DVec3);

/// One step of Gaussian elimination.
#[inline]
pub(crate) fn eliminate(i: usize, row: Row, before: Eliminated) -> Result<Eliminated, SolveError> {
    let pivot = checked_pivot(i, row.diagonal - row.lower * before.0)?;
    // Two divisions at once: the next row waits for the first, and would for a product after it.
    let (ratio, reciprocal) = (row.upper / pivot, 1.0 / pivot);
    Ok((ratio, (row.right - before.1 * row.lower) * reciprocal))
}

/// Eliminates every row of an open system. O(n).
///
/// # Errors
/// A pivot that is zero or not finite.
pub(crate) fn eliminate_all<R: Rows + Sync>(
    rows: &R,
    ratio: &mut [f64],
    reduced: &mut [DVec3],
) -> Result<(), SolveError> {
    let n = ratio.len();
    let run = |start: usize, before: Eliminated, ratio: &mut [f64], reduced: &mut [DVec3]| {
        let mut before = before;
        let all = start..start + ratio.len();
        let mut eliminated = ratio.iter_mut().zip(reduced);
        rows.try_each(all, |i, row| {
            before = eliminate(i, row, before)?;
            if let Some((ratio, reduced)) = eliminated.next() {
                (*ratio, *reduced) = before;
            }
            Ok(())
        })
    };
    let nothing = (0.0, DVec3::ZERO);
    if n < 2 * PART {
        return run(0, nothing, ratio, reduced);
    }
    let part = |(): &mut (), start: usize, (ratio, reduced): (&mut [f64], &mut [DVec3])| {
        let early = (start.saturating_sub(EARLY)..start)
            .try_fold(nothing, |before, i| eliminate(i, rows.row(i), before))?;
        run(start, early, ratio, reduced).map(|()| early)
    };
    let begun: Result<Vec<Eliminated>, SolveError> =
        parallel::parts((&mut *ratio, &mut *reduced), PART, 2 * PART, || (), part);
    let Ok(begun) = begun else {
        // Which row is to blame, a run from end to end says.
        return run(0, nothing, ratio, reduced);
    };
    let mut done = 0;
    for (k, begun) in begun.into_iter().enumerate().skip(1) {
        let mut i = k * PART;
        let mut before = (ratio[i - 1], reduced[i - 1]);
        if i < done || before == begun {
            continue;
        }
        while i < n {
            before = eliminate(i, rows.row(i), before)?;
            if before == (ratio[i], reduced[i]) {
                break;
            }
            (ratio[i], reduced[i]) = before;
            i += 1;
        }
        done = i;
    }
    Ok(())
}

/// Turns what elimination left of an open system into the unknowns, in place. O(n).
///
/// False where a part turns out not to have begun with the unknown after it; then `x` is of no use, and
/// [`substitute`] has to start from what elimination left.
pub(crate) fn substitute_all(ratio: &[f64], x: &mut [DVec3]) -> bool {
    let n = x.len();
    if n < 2 * PART {
        substitute(ratio, x, DVec3::ZERO);
        return true;
    }
    // What each part begins with: from rows of the part after it, while they are not yet unknowns.
    let late = |k: usize| {
        let end = (k + 1) * PART;
        let rows = end.min(n)..(end + EARLY).min(n);
        rows.rev().fold(DVec3::ZERO, |after, i| x[i] - after * ratio[i])
    };
    let begun: Vec<DVec3> = (0..n.div_ceil(PART)).map(late).collect();
    let part = |(): &mut (), start: usize, (x, ratio): (&mut [DVec3], &[f64])| {
        substitute(ratio, x, begun[start / PART]);
    };
    parallel::parts::<_, _, _, ()>((&mut *x, ratio), PART, 2 * PART, || (), part);
    let ends = x.iter().skip(PART).step_by(PART);
    begun.iter().zip(ends).all(|(begun, end)| begun == end)
}

/// The same of a run of rows from the last to the first, `after` being the unknown after them.
pub(crate) fn substitute(ratio: &[f64], x: &mut [DVec3], mut after: DVec3) {
    for (x, ratio) in x.iter_mut().zip(ratio).rev() {
        *x -= after * *ratio;
        after = *x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{UpdatableSolver, solve_once};

    /// Rows with a diagonal of their own: with two, influence dies as in a spline; with one, hardly.
    struct Planted(f64);
    impl Rows for Planted {
        fn count(&self) -> usize {
            5 * PART + 77
        }
        fn is_cyclic(&self) -> bool {
            false
        }
        fn row(&self, i: usize) -> Row {
            let x = i as f64;
            Row {
                lower: if i == 0 { 0.0 } else { 0.5 },
                diagonal: self.0,
                upper: if i + 1 == self.count() { 0.0 } else { 0.5 },
                right: DVec3::new(x.sin(), 1.0, (0.7 * x).cos()),
            }
        }
    }

    #[test]
    fn parts_make_the_run_from_end_to_end() {
        for diagonal in [2.0, 1.0] {
            let rows = Planted(diagonal);
            let n = rows.count();
            let (mut ratio, mut reduced) = (vec![0.0; n], vec![DVec3::ZERO; n]);
            eliminate_all(&rows, &mut ratio, &mut reduced).unwrap();
            let mut before = (0.0, DVec3::ZERO);
            for i in 0..n {
                before = eliminate(i, rows.row(i), before).unwrap();
                assert_eq!((ratio[i], reduced[i]), before, "{diagonal} {i}");
            }
            let (mut whole, mut parts) = (reduced.clone(), reduced);
            substitute(&ratio, &mut whole, DVec3::ZERO);
            // Where influence hardly dies, the parts notice.
            assert_eq!(substitute_all(&ratio, &mut parts), diagonal == 2.0);
            assert_eq!(parts == whole, diagonal == 2.0);
            assert_eq!(solve_once(&rows).unwrap(), whole);
            assert_eq!(UpdatableSolver::new(&rows).unwrap().solution(), whole);
        }
    }
}
