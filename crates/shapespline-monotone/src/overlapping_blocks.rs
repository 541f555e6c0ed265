// SPDX-License-Identifier: MIT OR Apache-2.0

//! Optimal slopes of long data: overlapping windows solved independently and joined.
//!
//! A change at one node dies out by a factor of about four a node, so the optimum over a window agrees with the
//! optimum over all data a few nodes away from the window's ends. Windows keep the number of interior-point steps
//! independent of N (the worst segment of a million would dictate every step of one large problem), cost O(N) in
//! all, and run in parallel. Nodal values of neighbouring windows are joined at the node of the overlap where they
//! agree best; only the segment behind the seam mixes the two, and it is certified like every other. A seam that
//! cannot be certified makes its two windows one.

use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use crate::interrupt::GoOn;
use crate::optimal::{self, Optimum, Prescribed, coefficients, fixed_by_data};
use shapespline_polynomial::certified_nonnegative;
use shapespline_polynomial::parallel;
use std::ops::Range;

/// Nodes a window answers for, and nodes it looks beyond on either side.
const CORE: usize = 64;
const OVERLAP: usize = 6;

/// Segments on which the unconstrained optimum is tried first.
const PROBE: usize = 256;

/// Segments `range` of the data as data of their own.
fn part(data: &Data, range: Range<usize>) -> Data {
    Data {
        h: data.h[range.clone()].to_vec(),
        delta: data.delta[range].to_vec(),
        ex: data.ex,
        ey: data.ey,
    }
}

/// A window: the segments it solves on.
struct Window {
    segments: Range<usize>,
    optimum: Optimum,
}

/// Slopes and second derivatives of least energy; none where the question whether to go on, asked once a window,
/// was answered with no. O(N), in parallel.
pub(crate) fn optimise(
    data: &Data,
    fairness: Fairness,
    prescribed: Option<Prescribed<'_>>,
    go_on: GoOn<'_>,
) -> Option<Optimum> {
    let n = data.len();
    if n <= CORE + 2 * OVERLAP {
        return Some(optimal::optimise(data, fairness, prescribed));
    }
    // A segment where the energy's own minimiser falls settles it for all, and what is beyond sixteen nodes hardly
    // matters there: most long data need no elimination of their whole length.
    let of = |segments: &Range<usize>| prescribed.map(|p| p.part(segments));
    let fixed = |i: usize| prescribed.map_or_else(|| fixed_by_data(&data.delta, i), |p| p.fixed[i]);
    let smooth = |segments: Range<usize>, count: usize| {
        // At the end of the part the node is as the part alone would have it.
        let data = part(data, segments);
        let fixed = |i| prescribed.map_or_else(|| fixed_by_data(&data.delta, i), |p| p.fixed[i]);
        optimal::unconstrained(&data, fairness, &fixed, count)
    };
    if (n <= PROBE || smooth(0..PROBE, PROBE - 16).is_some())
        && let Some(done) = optimal::unconstrained(data, fairness, &fixed, n)
    {
        return Some(done);
    }
    let mut ranges = Vec::new();
    let mut start = 0;
    while start < n {
        if is_flat(data.delta[start]) {
            start += 1;
            continue;
        }
        // Flats separate the problem exactly; a window that reaches one includes it, which fixes its node.
        let end = (start..n).find(|&i| is_flat(data.delta[i])).unwrap_or(n);
        let pieces = (end - start).div_ceil(CORE).max(1);
        for k in 0..pieces {
            let cut = |k: usize| start + (end - start) * k / pieces;
            let lo = cut(k).saturating_sub(OVERLAP).max(start.saturating_sub(1));
            let hi = (cut(k + 1) + OVERLAP).min((end + 1).min(n));
            let lo = if k == 0 { start.saturating_sub(1) } else { lo };
            let hi = if k + 1 == pieces { (end + 1).min(n) } else { hi };
            ranges.push(lo..hi);
        }
        start = end;
    }
    let solve = |segments: Range<usize>| {
        let optimum = optimal::optimise(&part(data, segments.clone()), fairness, of(&segments));
        Window { segments, optimum }
    };
    let solve_or_stop = |segments| go_on().is_continue().then(|| solve(segments));
    // Few segments cost less than waking threads.
    let many = if n < 8192 { usize::MAX } else { 0 };
    let windows: Option<Vec<Window>> =
        parallel::map(ranges.len(), many, |k| solve_or_stop(ranges[k].clone()));
    let windows = windows?;
    let mut joined: Vec<Window> = Vec::with_capacity(windows.len());
    // seams[k]: the last node that window k decides.
    let mut seams: Vec<usize> = Vec::with_capacity(windows.len());
    for window in windows {
        let mut window = window;
        while let Some(last) = joined.last() {
            if last.segments.end <= window.segments.start + 1 {
                // A flat between them: nothing to join.
                seams.push(last.segments.end - 1);
                break;
            }
            let from = seams.last().map_or(0, |s| s + 1);
            if let Some(seam) = seam(data, last, &window, from) {
                seams.push(seam);
                break;
            }
            // Together; the seam before them is chosen anew.
            let first = last.segments.start;
            joined.pop();
            seams.pop();
            window = solve(first..window.segments.end);
        }
        joined.push(window);
    }
    let mut out = Optimum { converged: true, ..Optimum::default() };
    (out.d, out.s) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut from = 0;
    for (k, window) in joined.iter().enumerate() {
        let offset = window.segments.start;
        let to = seams.get(k).copied().unwrap_or(window.segments.end);
        let from_here = from.max(offset);
        for i in from_here..=to.min(window.segments.end) {
            out.d[i] = window.optimum.d[i - offset];
            out.s[i] = window.optimum.s[i - offset];
        }
        from = to + 1;
        out.steps = out.steps.max(window.optimum.steps);
        out.gap = out.gap.max(window.optimum.gap);
        out.active += window.optimum.active * (to + 1 - from_here.min(to)) / window.optimum.d.len();
        out.converged &= window.optimum.converged;
    }
    Some(out)
}

/// The best node of two windows' overlap to go from one to the other, if any is certified.
fn seam(data: &Data, a: &Window, b: &Window, from: usize) -> Option<usize> {
    let (lo, hi) = (b.segments.start, a.segments.end);
    let at = |w: &Window, i: usize| {
        let k = i - w.segments.start;
        [w.optimum.d[k], w.optimum.s[k]]
    };
    let margin = (hi - lo) / 4;
    let mut candidates: Vec<(f64, usize)> = ((lo + margin).max(from)..hi - margin)
        .map(|i| {
            let scale = data.h[i.min(data.len() - 1)];
            let (p, q) = (at(a, i), at(b, i));
            let (r, t) = (at(a, i + 1), at(b, i + 1));
            let off = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs() + scale * (p[1] - q[1]).abs();
            let size = data.delta[i].abs();
            ((off(p, q) + off(r, t)) / size, i)
        })
        .filter(|(_, i)| *i < data.len())
        .collect();
    candidates.sort_by(|p, q| p.0.total_cmp(&q.0));
    candidates.into_iter().map(|(_, i)| i).find(|&i| {
        certified_nonnegative(&coefficients(data.h[i], data.delta[i], at(a, i), at(b, i + 1)), 0.0)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::energy;

    /// Windows against one problem over all data, with flats and turns in between.
    #[test]
    fn windows_agree_with_one_problem() {
        let mut state = 3u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for case in 0..6 {
            let (mut x, mut y) = (vec![0.0], vec![0.0]);
            for k in 0..250 {
                // Even steps, and heavy-tailed ones.
                let heavy = |u: f64| 1e-3 - (1.0 - u).ln();
                let step = next();
                x.push(x[k] + if case < 3 { 0.2 + step } else { heavy(step) });
                let flat = case % 3 == 1 && next() < 0.02;
                let turn = if case % 3 == 2 && (k / 40) % 2 == 1 { -1.0 } else { 1.0 };
                let rise = next();
                let rise = if case < 3 { 0.05 + rise } else { heavy(rise) };
                y.push(if flat { y[k] } else { y[k] + turn * rise });
            }
            let data = Data::new(&x, &y).unwrap();
            let total = |o: &Optimum| energy::total(&data, Fairness::Bending, &o.d, &o.s);
            let go_on: GoOn<'_> = &|| std::ops::ControlFlow::Continue(());
            let whole = optimal::optimise(&data, Fairness::Bending, None);
            let parts = optimise(&data, Fairness::Bending, None, go_on).unwrap();
            let ratio = total(&parts) / total(&whole);
            assert!((0.996..1.004).contains(&ratio), "case {case}: {ratio}");
            assert!(parts.converged && whole.converged, "case {case}: {} {}", parts.gap, whole.gap);
            for i in 0..data.len() {
                let c = |o: &Optimum| {
                    coefficients(
                        data.h[i],
                        data.delta[i],
                        [o.d[i], o.s[i]],
                        [o.d[i + 1], o.s[i + 1]],
                    )
                };
                assert!(is_flat(data.delta[i]) || certified_nonnegative(&c(&parts), 1e-14));
            }
        }
    }
}
