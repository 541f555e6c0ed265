// SPDX-License-Identifier: MIT OR Apache-2.0

//! Which segments are single pieces of a curve.

use super::error::CurveError;

/// Which segments are single pieces of the curve.
#[derive(Debug, Clone)]
pub(super) enum Single {
    /// All, each the piece of its own number.
    All,
    /// Those with a piece.
    Some(Vec<Option<usize>>),
}

/// The pieces that run from one parameter to the next; an error where the curve does not reach them.
pub(super) fn single_pieces(u: &[f64], breaks: &[f64]) -> Result<Single, CurveError> {
    let [start, end] = [breaks[0], breaks[breaks.len() - 1]];
    let n = u.len() - 1;
    let close = |a: f64, b: f64, h: f64| (a - b).abs() <= 1e-12 * h;
    let (h0, hn) = (u[1] - u[0], u[n] - u[n - 1]);
    for (index, reaches) in
        [(0, u[0] >= start || close(u[0], start, h0)), (n, u[n] <= end || close(u[n], end, hn))]
    {
        if !reaches {
            return Err(CurveError::Domain { index, value: u[index], start, end });
        }
    }
    let spacing = |i: usize| u[(i + 1).min(n)] - u[i.min(n - 1)];
    if breaks.len() == u.len() && (0..=n).all(|i| close(u[i], breaks[i], spacing(i))) {
        return Ok(Single::All);
    }
    let mut next = 0;
    let piece = |i: usize| {
        let h = spacing(i);
        while next + 2 < breaks.len() && breaks[next] < u[i] && !close(breaks[next], u[i], h) {
            next += 1;
        }
        let single = close(breaks[next], u[i], h) && close(breaks[next + 1], u[i + 1], h);
        single.then_some(next)
    };
    Ok(Single::Some((0..n).map(piece).collect()))
}
