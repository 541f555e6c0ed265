// SPDX-License-Identifier: MIT OR Apache-2.0

//! All of the quartic's numbers in one pass over the data: tiles that stay in a core's first cache.

use super::ShapeParameters;
use super::scale::{Failing, keeps};
use crate::data::{PowerOfTwo, Units};
use crate::segment_polynomial::{SegmentPolynomial, TILE};
use crate::slopes::{end, harmonic, limit};
use shapespline_polynomial::parallel;
use std::sync::atomic::{AtomicBool, Ordering};

/// Tiles that one thread works through at least; fewer than twice that are no work to share.
const TILES: usize = 128;

/// What the pass reads.
pub(super) struct Assembly<'a> {
    pub(super) x: &'a [f64],
    pub(super) y: &'a [f64],
    pub(super) units: Units,
    /// Slopes of the caller's, in the data's units; otherwise Fritsch and Butland's.
    pub(super) given: Option<&'a [f64]>,
    pub(super) shape: &'a ShapeParameters,
}

/// What it makes, in the data's units but for the slopes, which are scaled.
pub(super) struct Assembled {
    pub(super) d: Vec<f64>,
    pub(super) e: Vec<f64>,
    pub(super) scale: Vec<f64>,
    pub(super) polynomials: Vec<SegmentPolynomial>,
    /// Whether all spacings, secants and slopes are in range.
    pub(super) sound: bool,
}

/// One number a segment of a tile.
type Numbers = [f64; TILE];
/// A tile's polynomials and its d, e and λ; and those of all tiles, collected without zeros to
/// overwrite.
type Tile = (([SegmentPolynomial; TILE], Numbers), (Numbers, Numbers));
type Tiles = ((Vec<[SegmentPolynomial; TILE]>, Vec<Numbers>), (Vec<Numbers>, Vec<Numbers>));

/// The numbers of a tile on the way, and what it makes of them: kept from tile to tile, for what is overwritten need
/// not be zeroed anew.
struct Scratch {
    h: [f64; TILE + 2],
    /// `delta[j + 1]` belongs to segment j of the tile.
    delta: [f64; TILE + 2],
    d: [f64; TILE + 1],
    /// End slopes and the full e, in units of the secant.
    m: [Numbers; 2],
    full: Numbers,
    /// Which conditions fail, and those.
    which: [usize; TILE],
    failing: Failing,
    step: Numbers,
    q: [Numbers; 4],
    e: Numbers,
    lambda: Numbers,
    polynomials: [SegmentPolynomial; TILE],
}

impl Default for Scratch {
    fn default() -> Self {
        let zeros = [0.0; TILE];
        Self {
            h: [1.0; TILE + 2],
            delta: [0.0; TILE + 2],
            d: [0.0; TILE + 1],
            m: [zeros; 2],
            full: zeros,
            which: [0; TILE],
            failing: Failing::default(),
            step: zeros,
            q: [zeros; 4],
            e: zeros,
            lambda: zeros,
            polynomials: [SegmentPolynomial::default(); TILE],
        }
    }
}

impl Assembly<'_> {
    pub(super) fn make(&self) -> Assembled {
        let n = self.x.len() - 1;
        let sound = AtomicBool::new(true);
        let work = |scratch: &mut Scratch, tile: usize| -> Tile {
            let start = tile * TILE;
            // A length that is known beforehand: nearly all tiles are full.
            let fine = if n - start >= TILE {
                self.tile(start, TILE, scratch)
            } else {
                self.tile(start, n - start, scratch)
            };
            if !fine {
                sound.store(false, Ordering::Relaxed);
            }
            let mut d = [0.0; TILE];
            d.copy_from_slice(&scratch.d[..TILE]);
            ((scratch.polynomials, d), (scratch.e, scratch.lambda))
        };
        let count = n.div_ceil(TILE);
        let ((polynomials, d), (e, scale)): Tiles =
            parallel::map_with(count, 2 * TILES + 1, Scratch::default, work);
        let numbers = |tiles: Vec<Numbers>| {
            let mut numbers = tiles.into_flattened();
            numbers.truncate(n);
            numbers
        };
        let (mut d, e, scale) = (numbers(d), numbers(e), numbers(scale));
        let mut polynomials = polynomials.into_flattened();
        polynomials.truncate(n);
        let end = self.end_slope(n);
        // There is room unless all tiles are full; then for this one only, not for as many again.
        d.reserve_exact(1);
        d.push(end);
        let sound = sound.into_inner() && self.units.slope().scale(end).is_finite();
        Assembled { d, e, scale, polynomials, sound }
    }

    /// The slope at the first or the last node, scaled.
    fn end_slope(&self, node: usize) -> f64 {
        let n = self.x.len() - 1;
        let segment = |i: usize| {
            let (mut h, mut delta) = ([0.0], [0.0]);
            self.units.differences(&self.x[i..=i + 1], &self.y[i..=i + 1], &mut h, &mut delta);
            (h[0], delta[0])
        };
        let own = if node == 0 { 0 } else { n - 1 };
        let (h, delta) = segment(own);
        if let Some(given) = self.given {
            return limit(self.scaled(given[node]), delta, delta);
        }
        if n == 1 {
            // Two points: the line.
            return delta;
        }
        let (next_h, next_delta) = segment(if node == 0 { 1 } else { n - 2 });
        end(h, next_h, delta, next_delta)
    }

    /// A slope in scaled units.
    fn scaled(&self, slope: f64) -> f64 {
        PowerOfTwo::new(self.units.ex - self.units.ey).scale(slope)
    }

    /// The numbers of `n` segments from `start` on; polynomials after the last are of no meaning.
    /// Nothing but arithmetic and selections, from one small array to another: done for several
    /// segments at once.
    #[inline(always)]
    fn tile(&self, start: usize, n: usize, scratch: &mut Scratch) -> bool {
        let Scratch { h, delta, d, .. } = scratch;
        let all = self.x.len() - 1;
        let (x, y) = (&self.x[start..=start + n], &self.y[start..=start + n]);
        // One segment more on either side where there is one; at the ends the last one again.
        self.units.differences(x, y, &mut h[1..=n], &mut delta[1..=n]);
        let own = 1..=n;
        let mut sound = h[own.clone()]
            .iter()
            .zip(&delta[own])
            .fold(true, |all, (h, delta)| all & (*h > 0.0) & (delta.abs() < f64::MAX));
        for (node, at, from) in [(start, 0, start.wrapping_sub(1)), (start + n, n + 1, start + n)] {
            if node > 0 && node < all {
                let near = from..=from + 1;
                let (h, delta) = (&mut h[at..=at], &mut delta[at..=at]);
                self.units.differences(&self.x[near.clone()], &self.y[near], h, delta);
            }
        }
        if start == 0 {
            delta[0] = delta[1];
        }
        if start + n == all {
            delta[n + 1] = delta[n];
        }
        if let Some(given) = self.given {
            for j in 0..=n {
                d[j] = limit(self.scaled(given[start + j]), delta[j], delta[j + 1]);
            }
        } else {
            for j in 0..n + 1 {
                d[j] = harmonic(delta[j], delta[j + 1]);
            }
            if start == 0 {
                d[0] = self.end_slope(0);
            }
            if start + n == all {
                d[n] = self.end_slope(all);
            }
        }
        self.scales(start, n, scratch);
        let Scratch { h, delta, d, full, step, q, e, lambda, polynomials, .. } = scratch;
        // In the data's units.
        let (unit, slope) = (self.units.y(), self.units.slope());
        let [q0, q1, q2, _] = q;
        for j in 0..n {
            step[j] = y[j + 1] - y[j];
        }
        for j in 0..n {
            let (secant, h) = (delta[j + 1], h[j + 1]);
            // Flat segments have slopes and e of zero, and a λ of one, as they are.
            e[j] = unit.scale(lambda[j] * full[j] * (secant * h));
            let m = [unit.scale(h * d[j]), unit.scale(h * d[j + 1])];
            [q0[j], q1[j], q2[j]] = SegmentPolynomial::quartic_form(step[j], m, e[j]);
        }
        sound &= d[..n].iter().fold(true, |all, d| all & slope.scale(*d).is_finite());
        SegmentPolynomial::assemble(x, y, q, polynomials);
        sound
    }

    /// λ, and the full e in units of the secant.
    #[inline(always)]
    fn scales(&self, start: usize, n: usize, scratch: &mut Scratch) {
        let Scratch { delta, d, m: [m0, m1], full, which, failing, lambda, .. } = scratch;
        for j in 0..n {
            // In units of the secant everything is of order one.
            let secant = if delta[j + 1] == 0.0 { 1.0 } else { delta[j + 1] };
            (m0[j], m1[j]) = (d[j] / secant, d[j + 1] / secant);
        }
        match self.shape {
            ShapeParameters::Uniform(a) => {
                for j in 0..n {
                    full[j] = 2.0 / 3.0 * (a * m0[j] - a * m1[j]);
                }
            }
            ShapeParameters::Segments { alpha, beta } => {
                let (alpha, beta) = (&alpha[start..start + n], &beta[start..start + n]);
                for j in 0..n {
                    full[j] = 2.0 / 3.0 * (alpha[j] * m0[j] - beta[j] * m1[j]);
                }
            }
        }
        // Those whose conditions (12), (13) fail, listed without a branch: which they are cannot be predicted.
        let mut count = 0;
        for j in 0..n {
            which[count] = j;
            count += usize::from(!keeps(m0[j], m1[j], full[j]));
        }
        let which = &which[..count];
        for (k, &j) in which.iter().enumerate() {
            failing.set(k, m0[j], m1[j], full[j]);
        }
        failing.solve(count);
        lambda.fill(1.0);
        for (k, &j) in which.iter().enumerate() {
            lambda[j] = failing.lambda[k];
        }
    }
}
