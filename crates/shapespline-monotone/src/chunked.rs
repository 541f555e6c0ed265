// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many queries: cut into tiles, which all threads work through.

use shapespline_polynomial::parallel;

/// Queries whose segments are found before any of them is answered: what the loops load depends on no branch of the
/// iteration before, so that cache misses overlap.
pub(crate) const TILE: usize = 64;

/// The answers to all queries. `least` is how many tiles one thread works through at least; fewer than twice that are
/// no work to share.
pub(crate) fn answers(
    queries: &[f64],
    least: usize,
    tile: impl Fn(&[f64]) -> [f64; TILE] + Sync,
) -> Vec<f64> {
    // Collected, not written to what was zeroed before: clearing fresh memory is a good part of the time.
    let one = |k: usize| tile(&queries[k * TILE..queries.len().min((k + 1) * TILE)]);
    let count = queries.len().div_ceil(TILE);
    let tiles: Vec<[f64; TILE]> = parallel::map(count, 2 * least + 1, one);
    let mut answers = tiles.into_flattened();
    answers.truncate(queries.len());
    answers
}

/// The same with room for the answers: `work` on every tile and its part of `out`. Extra entries of the longer are left
/// alone.
pub(crate) fn fill(
    queries: &[f64],
    out: &mut [f64],
    least: usize,
    work: impl Fn(&[f64], &mut [f64]) + Sync,
) {
    let n = queries.len().min(out.len());
    let part = |(): &mut (), _, (queries, out): (&[f64], &mut [f64])| {
        queries.chunks(TILE).zip(out.chunks_mut(TILE)).for_each(|(q, out)| work(q, out));
    };
    let size = TILE * least;
    parallel::parts::<_, _, _, ()>((&queries[..n], &mut out[..n]), size, 2 * size + 1, || (), part);
}
