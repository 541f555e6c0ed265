//! All of the quartic's numbers in one pass over the data: tiles that stay in a core's first cache.

use super::Shape;
use super::scale::{keeps, largest_scale};
use crate::data::{PowerOfTwo, Units};
use crate::record::{Record, TILE};
use crate::slopes::{end, harmonic, limit};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Tiles that one thread works through at least; fewer than twice that are no work to share.
const TILES: usize = 128;

/// What the pass reads.
pub(super) struct Pass<'a> {
    pub(super) x: &'a [f64],
    pub(super) y: &'a [f64],
    pub(super) units: Units,
    /// Slopes of the caller's, in the data's units; otherwise Fritsch and Butland's.
    pub(super) given: Option<&'a [f64]>,
    pub(super) shape: &'a Shape,
}

/// What it makes, in the data's units.
pub(super) struct Made {
    pub(super) d: Vec<f64>,
    pub(super) e: Vec<f64>,
    pub(super) scale: Vec<f64>,
    pub(super) records: Vec<Record>,
    /// Whether all spacings, secants and slopes are in range.
    pub(super) sound: bool,
}

/// A tile's own numbers of d, e and λ.
type Parts<'a> = ((&'a mut [f64], &'a mut [f64]), &'a mut [f64]);

impl Pass<'_> {
    pub(super) fn make(&self) -> Made {
        let n = self.x.len() - 1;
        let (mut d, mut e, mut scale) = (vec![0.0; n + 1], vec![0.0; n], vec![0.0; n]);
        let sound = AtomicBool::new(true);
        let work = |(tile, ((d, e), scale)): (usize, Parts<'_>)| {
            let start = tile * TILE;
            // A length that is known beforehand: nearly all tiles are full.
            let (records, fine) = if d.len() == TILE {
                self.tile(start, TILE, d, e, scale)
            } else {
                self.tile(start, d.len(), d, e, scale)
            };
            if !fine {
                sound.store(false, Ordering::Relaxed);
            }
            records
        };
        let tiles: Vec<[Record; TILE]> = if n <= 2 * TILE * TILES {
            let parts = d[..n].chunks_mut(TILE).zip(e.chunks_mut(TILE));
            parts.zip(scale.chunks_mut(TILE)).enumerate().map(work).collect()
        } else {
            let parts = d[..n].par_chunks_mut(TILE).zip(e.par_chunks_mut(TILE));
            let parts = parts.zip(scale.par_chunks_mut(TILE)).enumerate();
            parts.with_min_len(TILES).map(work).collect()
        };
        let mut records = tiles.into_flattened();
        records.truncate(n);
        d[n] = self.units.slope().scale(self.end_slope(n));
        let sound = sound.into_inner() && d[n].is_finite();
        Made { d, e, scale, records, sound }
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

    /// The numbers of `n` segments from `start` on; records after the last are of no meaning. Nothing but arithmetic
    /// and selections, from one small array to another: done for several segments at once.
    #[inline(always)]
    fn tile(
        &self,
        start: usize,
        n: usize,
        d_out: &mut [f64],
        e_out: &mut [f64],
        scale: &mut [f64],
    ) -> ([Record; TILE], bool) {
        let (d_out, e_out, scale) = (&mut d_out[..n], &mut e_out[..n], &mut scale[..n]);
        let all = self.x.len() - 1;
        let (x, y) = (&self.x[start..=start + n], &self.y[start..=start + n]);
        // One segment more on either side where there is one; at the ends the last one again.
        let (mut h, mut delta) = ([1.0; TILE + 2], [0.0; TILE + 2]);
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
        let mut d = [0.0; TILE + 1];
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
        let (mut lambda, mut full) = ([1.0; TILE], [0.0; TILE]);
        self.scales(start, n, &d, &delta, &mut lambda, &mut full);
        // In the data's units.
        let (unit, slope) = (self.units.y(), self.units.slope());
        let (mut q0, mut q1, mut q2) = ([0.0; TILE], [0.0; TILE], [0.0; TILE]);
        // What is the tile's own cannot overlap, which would have to be asked in every loop.
        let (mut step, mut e) = ([0.0; TILE], [0.0; TILE]);
        step[..n].iter_mut().zip(y.windows(2)).for_each(|(step, y)| *step = y[1] - y[0]);
        for j in 0..n {
            let (secant, h) = (delta[j + 1], h[j + 1]);
            // Flat segments have slopes and e of zero, and a λ of one, as they are.
            e[j] = unit.scale(lambda[j] * full[j] * (secant * h));
            let m = [unit.scale(h * d[j]), unit.scale(h * d[j + 1])];
            [q0[j], q1[j], q2[j]] = Record::quartic_form(step[j], m, e[j]);
        }
        d_out.iter_mut().zip(&d).for_each(|(out, d)| *out = slope.scale(*d));
        e_out.copy_from_slice(&e[..n]);
        scale.copy_from_slice(&lambda[..n]);
        sound &= d_out.iter().fold(true, |all, d| all & d.is_finite());
        let q = [q0, q1, q2, [0.0; TILE]];
        (Record::assembled(x, y, &q), sound)
    }

    /// λ, and the full e in units of the secant; `delta[j + 1]` belongs to segment j of the tile.
    #[inline(always)]
    fn scales(
        &self,
        start: usize,
        n: usize,
        d: &[f64; TILE + 1],
        delta: &[f64; TILE + 2],
        lambda: &mut [f64; TILE],
        full: &mut [f64; TILE],
    ) {
        let (mut m0, mut m1) = ([0.0; TILE], [0.0; TILE]);
        let (mut alpha, mut beta) = ([0.0; TILE], [0.0; TILE]);
        match self.shape {
            Shape::Uniform(a) => (alpha[..n].fill(*a), beta[..n].fill(*a)),
            Shape::Segments { alpha: a, beta: b } => (
                alpha[..n].copy_from_slice(&a[start..start + n]),
                beta[..n].copy_from_slice(&b[start..start + n]),
            ),
        };
        for j in 0..n {
            // In units of the secant everything is of order one.
            let secant = if delta[j + 1] == 0.0 { 1.0 } else { delta[j + 1] };
            (m0[j], m1[j]) = (d[j] / secant, d[j + 1] / secant);
            full[j] = 2.0 / 3.0 * (alpha[j] * m0[j] - beta[j] * m1[j]);
        }
        // Those whose conditions (12), (13) fail, listed without a branch: which they are cannot be predicted.
        let (mut failing, mut count) = ([0; TILE], 0);
        for j in 0..n {
            failing[count] = j;
            count += usize::from(!keeps(m0[j], m1[j], full[j]));
        }
        // Side by side first: several are solved at once.
        let (mut a, mut b, mut e) = ([0.0; TILE], [0.0; TILE], [0.0; TILE]);
        for (k, &j) in failing[..count].iter().enumerate() {
            (a[k], b[k], e[k]) = (m0[j], m1[j], full[j]);
        }
        for (e, (a, b)) in e[..count].iter_mut().zip(a[..count].iter().zip(&b[..count])) {
            *e = largest_scale(*a, *b, *e);
        }
        for (k, &j) in failing[..count].iter().enumerate() {
            lambda[j] = e[k];
        }
    }
}
