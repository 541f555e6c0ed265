//! Values at many parameters: segments first, then values, on all threads.

use std::array;

use glam::DVec3;
use rayon::prelude::*;

use crate::{Dimension, Domain, PiecewiseCubic, Side, locate::search};

/// Parameters whose segments are found before any of them is evaluated.
const TILE: usize = 64;

/// Tiles that one thread works through at least.
const TILES: usize = 256;

/// `[1 − t, t]` of the parameters of a tile.
pub(crate) type Locals = [[f64; 2]; TILE];

/// A piecewise cubic and what its parameter means: all that many values need.
pub(crate) trait Evaluate: Sync {
    /// The image.
    fn image(&self) -> &PiecewiseCubic;

    /// `[1 − t, t]` of (wrapped) parameters, the `j`-th of them on `segment(j)`.
    fn locals(&self, segment: impl Fn(usize) -> usize, u: &[f64], out: &mut Locals);

    /// Derivative of an order on a segment at `[1 − t, t]`.
    fn derivative<const ORDER: usize>(&self, segment: usize, local: [f64; 2]) -> DVec3;

    /// Derivatives of an order at parameters, row by row: the one way to many values.
    fn values<const ORDER: usize>(&self, u: &[f64], side: Side) -> Vec<f64> {
        match self.image().dimension() {
            Dimension::Two => rows::<_, ORDER, 2>(self, u, side),
            Dimension::Three => rows::<_, ORDER, 3>(self, u, side),
        }
    }
}

fn rows<E: Evaluate + ?Sized, const ORDER: usize, const COLUMNS: usize>(
    curve: &E,
    u: &[f64],
    side: Side,
) -> Vec<f64> {
    let image = curve.image();
    // A table costs about as much to make as it saves on one query a segment.
    let table = if u.len() >= image.segments().max(64) { image.table() } else { None };
    let row = |i: usize, local: [f64; 2]| -> [f64; COLUMNS] {
        let value = curve.derivative::<ORDER>(i, local).to_array();
        array::from_fn(|column| value[column])
    };
    let tile = |hint: &mut usize, u: &[f64]| -> [[f64; COLUMNS]; TILE] {
        let mut locals = [[0.0; 2]; TILE];
        // Every pair is compared, for a loop that may end early is not done several pairs at once.
        let sorted = u.windows(2).fold(true, |sorted, w| sorted & (w[0] <= w[1]));
        if sorted {
            *hint = image.near(*hint, image.wrap(u[0]));
            if image.knots()[*hint] < u[0] && u[u.len() - 1] < image.knots()[*hint + 1] {
                // Inside one segment, as fine samples are: what depends on it alone is computed once.
                let segment = *hint;
                curve.locals(|_| segment, u, &mut locals);
                return array::from_fn(|j| row(segment, locals[j]));
            }
        }
        // First all segments, then all values: what the loops load from memory depends on no branch
        // of the iteration before, so that cache misses overlap.
        let (mut segments, mut wrapped) = ([0; TILE], [0.0; TILE]);
        for ((&u, segment), wrapped) in u.iter().zip(&mut segments).zip(&mut wrapped) {
            *wrapped = image.wrap(u);
            *hint = match table {
                _ if sorted => image.near(*hint, *wrapped),
                Some(table) => table.segment(image.knots(), *wrapped),
                None => search(image.knots(), *wrapped, Side::Right),
            };
            *segment = *hint;
            if side == Side::Left && *wrapped == image.knots()[*segment] {
                (*segment, *wrapped) = image.before(*segment);
            }
        }
        curve.locals(|j| segments[j], &wrapped[..u.len()], &mut locals);
        // The places after the last parameter are on the first segment, and cut off below.
        array::from_fn(|j| row(segments[j], locals[j]))
    };
    // Collected, not written to what was zeroed before: clearing fresh memory is a good part of the
    // time of a simple evaluation.
    let tiles: Vec<[[f64; COLUMNS]; TILE]> = if u.len() <= 2 * TILE * TILES {
        let mut hint = 0;
        u.chunks(TILE).map(|u| tile(&mut hint, u)).collect()
    } else {
        u.par_chunks(TILE).with_min_len(TILES).map_init(|| 0, tile).collect()
    };
    let mut values = tiles.into_flattened().into_flattened();
    values.truncate(u.len() * COLUMNS);
    values
}

impl PiecewiseCubic {
    /// The segment that ends where one begins, and the parameter there.
    fn before(&self, segment: usize) -> (usize, f64) {
        let last = self.segments();
        match (segment, self.domain()) {
            (0, Domain::Closed) => (last - 1, self.knots()[last]),
            _ => (segment.saturating_sub(1), self.knots()[segment]),
        }
    }

    /// Segment of `u`: looked for from the one before on, in steps that double, as sorted parameters
    /// have it; by search where it lies behind.
    #[inline(always)]
    fn near(&self, hint: usize, u: f64) -> usize {
        let (knots, last) = (self.knots(), self.segments());
        if !(knots[hint] <= u) {
            return search(knots, u, Side::Right);
        }
        if u < knots[hint + 1] {
            return hint;
        }
        let (mut low, mut step) = (hint, 1);
        loop {
            let high = (low + step).min(last);
            if high == last || u < knots[high] {
                return low + knots[low + 1..high].partition_point(|&k| k <= u);
            }
            (low, step) = (high, 2 * step);
        }
    }
}
