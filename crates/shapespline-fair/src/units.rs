// SPDX-License-Identifier: MIT OR Apache-2.0

//! The units in which a curve is solved for.

use shapespline_geometry::{DataPolygon, length};
use shapespline_polynomial::parallel;

/// Terms are added in blocks of this many, so that a sum does not depend on the number of threads; two blocks
/// and more on all threads.
pub(crate) const BLOCK: usize = 4096;

/// Units of a polygon: points are divided by the mean chord, parameters by the mean spacing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub(crate) length: f64,
    pub(crate) time: f64,
}

impl Units {
    pub(crate) fn of(polygon: &DataPolygon) -> Self {
        let n = polygon.segments();
        let share = 1.0 / n as f64;
        Self {
            length: sum(n, |i| length(polygon.chord(i)) * share),
            time: sum(n, |i| polygon.spacing(i) * share),
        }
    }
}

/// `term(0) + … + term(count − 1)`.
pub(crate) fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let sums: Vec<f64> = parallel::blocks(count, BLOCK, |block| block.map(&term).sum::<f64>());
    sums.into_iter().sum()
}
