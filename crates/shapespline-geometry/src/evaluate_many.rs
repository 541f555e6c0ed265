// SPDX-License-Identifier: MIT OR Apache-2.0

//! Values at many parameters: segments first, then values, on all threads.

use std::array;

use glam::DVec3;
use shapespline_polynomial::parallel;

use crate::{Dimension, Domain, InputError, PiecewiseCubic, Side};

/// Parameters whose segments are found before any of them is evaluated.
const TILE: usize = 64;

/// Parameters that one thread works through, at least.
const PART: usize = 256 * TILE;

/// Parameters a segment from which the runs of each segment are evaluated together.
const RUN: usize = 8;

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

    /// Derivatives of an order at `[1 − t, t]`s of one segment.
    fn run<const ORDER: usize, const COLUMNS: usize>(
        &self,
        segment: usize,
        locals: &[[f64; 2]],
        out: &mut [[f64; COLUMNS]],
    ) {
        for (out, &local) in out.iter_mut().zip(locals) {
            let value = self.derivative::<ORDER>(segment, local).to_array();
            *out = array::from_fn(|column| value[column]);
        }
    }

    /// Derivatives of an order at parameters, row by row: the one way to many values.
    fn values<const ORDER: usize>(&self, u: &[f64], side: Side, out: &mut [f64]) {
        match self.image().dimension() {
            Dimension::Two => rows::<_, ORDER, 2>(self, u, side, out.as_chunks_mut().0),
            Dimension::Three => rows::<_, ORDER, 3>(self, u, side, out.as_chunks_mut().0),
        }
    }
}

/// Refuses room that is not for a row a parameter.
pub(crate) fn check_rows(image: &PiecewiseCubic, u: &[f64], out: &[f64]) -> Result<(), InputError> {
    let (expected, found) = (u.len() * image.dimension().count(), out.len());
    if found == expected {
        return Ok(());
    }
    Err(InputError::Length { argument: "out", expected, found, per: "a row for each parameter" })
}

fn rows<E: Evaluate + ?Sized, const ORDER: usize, const COLUMNS: usize>(
    curve: &E,
    u: &[f64],
    side: Side,
    out: &mut [[f64; COLUMNS]],
) {
    let image = curve.image();
    // A table costs about as much to make as it saves on one query a segment.
    let search = image.searcher(u.len() >= image.segments().max(64));
    let row = |i: usize, local: [f64; 2]| -> [f64; COLUMNS] {
        let value = curve.derivative::<ORDER>(i, local).to_array();
        array::from_fn(|column| value[column])
    };
    let tile = |hint: &mut usize, (u, out): (&[f64], &mut [[f64; COLUMNS]])| {
        let mut locals = [[0.0; 2]; TILE];
        // Every pair is compared, for a loop that may end early is not done several pairs at once.
        let sorted = u.windows(2).fold(true, |sorted, w| sorted & (w[0] <= w[1]));
        let (first, last) = (u[0], u[u.len() - 1]);
        if sorted && side == Side::Right && image.wrap(first) == first && image.wrap(last) == last {
            *hint = search.near(*hint, first);
            let ahead = (*hint + u.len() / RUN).min(image.segments());
            if ahead == image.segments() || last < image.knots()[ahead] {
                // On few segments, as fine samples are: what depends on one alone is computed once.
                let mut from = 0;
                while from < u.len() {
                    let segment = search.near(*hint, u[from]);
                    let end = if segment + 1 < image.segments() {
                        image.knots()[segment + 1]
                    } else {
                        f64::INFINITY
                    };
                    let run = u[from..].iter().take_while(|&&u| u < end).count().max(1);
                    let (u, out) = (&u[from..from + run], &mut out[from..from + run]);
                    curve.locals(|_| segment, u, &mut locals);
                    curve.run::<ORDER, COLUMNS>(segment, &locals[..run], out);
                    (*hint, from) = (segment, from + run);
                }
                return;
            }
        }
        // First all segments, then all values: what the loops load from memory depends on no branch
        // of the iteration before, so that cache misses overlap.
        let (mut segments, mut wrapped) = ([0; TILE], [0.0; TILE]);
        let wrapped = &mut wrapped[..u.len()];
        wrapped.iter_mut().zip(u).for_each(|(wrapped, &u)| *wrapped = image.wrap(u));
        if sorted {
            for (segment, &u) in segments.iter_mut().zip(&*wrapped) {
                *hint = search.near(*hint, u);
                *segment = *hint;
            }
        } else {
            search.tile(wrapped, false, &mut segments);
        }
        if side == Side::Left {
            for (segment, u) in segments.iter_mut().zip(&mut *wrapped) {
                if *u == image.knots()[*segment] {
                    (*segment, *u) = image.before(*segment);
                }
            }
        }
        curve.locals(|j| segments[j], wrapped, &mut locals);
        for ((out, &segment), &local) in out.iter_mut().zip(&segments).zip(&locals) {
            *out = row(segment, local);
        }
    };
    let part = |hint: &mut usize, _, (u, out): (&[f64], &mut [[f64; COLUMNS]])| {
        u.chunks(TILE).zip(out.chunks_mut(TILE)).for_each(|both| tile(hint, both));
    };
    parallel::parts::<_, _, _, ()>((u, out), PART, 2 * PART + 1, || 0, part);
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
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// However the parameters lie — many or few to a segment, on knots, over several periods, backwards — they
    /// give what one at a time gives.
    #[test]
    fn tiles_give_what_single_parameters_give() {
        let n = 50;
        let knots: Vec<f64> = (0..=n).map(|i| f64::from(i) + 0.3 * f64::from(i % 3)).collect();
        let last = knots[n as usize];
        let at = |u: f64| DVec3::new(u.cos(), (1.7 * u).sin(), 0.1 * u);
        let points: Vec<DVec3> = knots.iter().map(|&u| at(u)).collect();
        let legs: Vec<[DVec3; 2]> = knots.windows(2).map(|k| [at(3.0 * k[0]), at(k[1])]).collect();
        for domain in [Domain::Open, Domain::Closed] {
            let mut points = points.clone();
            if domain == Domain::Closed {
                points[n as usize] = points[0];
            }
            let curve =
                PiecewiseCubic::new(knots.clone(), points, legs.clone(), Dimension::Three, domain)
                    .unwrap();
            for step in [0.01, 0.05, 0.125, 0.25, 1.0, 5.0, 60.0] {
                let count = ((3.2 * last / step) as usize).max(3 * TILE);
                let mut u: Vec<f64> = (0..count).map(|k| step * k as f64 - last).collect();
                u.extend(&knots);
                u.sort_by(f64::total_cmp);
                let backwards: Vec<f64> = u.iter().rev().copied().collect();
                for u in [&u, &backwards] {
                    for side in [Side::Left, Side::Right] {
                        for order in 0..4 {
                            let values = curve.evaluate_many(u, order, side);
                            for (&u, row) in u.iter().zip(values.chunks(3)) {
                                let one = curve.evaluate(u, order, side);
                                assert_eq!(one, DVec3::from_slice(row), "{u} {order} {step}");
                            }
                        }
                    }
                }
            }
        }
    }
}
