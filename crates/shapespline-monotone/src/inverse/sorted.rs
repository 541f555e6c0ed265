// SPDX-License-Identifier: MIT OR Apache-2.0

//! Sorted queries on one segment: what depends on the segment alone is done once, and neighbours tell where to start.

use super::batch::{Unit, many, step};
use super::{STEPS, local};
use crate::chunked::TILE;
use crate::segment_polynomial::SegmentPolynomial;

/// Parts of Δy that one start polynomial reaches over, and the queries it pays for.
const BLOCKS: f64 = 12.0;
const LEAST: usize = 6;

/// Where the numbers of a run are while it is worked on; made once a tile.
pub(super) struct Room {
    /// `(y − y₀)/Δy` and `(y − y₁)/Δy`.
    from: [[f64; TILE]; 2],
    t: [f64; TILE],
    doubt: [f64; TILE],
}

impl Default for Room {
    fn default() -> Self {
        Self { from: [[0.0; TILE]; 2], t: [0.0; TILE], doubt: [0.0; TILE] }
    }
}

/// The places of at most [`TILE`] values `y` between those at the segment's ends; `end` is its last abscissa.
#[inline]
pub(super) fn invert(
    polynomial: &SegmentPolynomial,
    end: f64,
    y: &[f64],
    out: &mut [f64],
    room: &mut Room,
) {
    let n = y.len();
    let SegmentPolynomial { x0, h, y: [y0, y1], q } = *polynomial;
    let inverse = 1.0 / (y1 - y0);
    let unit = Unit::of(q, inverse);
    let [from0, from1] = &mut room.from;
    let (from0, from1) = (&mut from0[..n], &mut from1[..n]);
    let (t, doubt) = (&mut room.t[..n], &mut room.doubt[..n]);
    for ((from0, from1), y) in from0.iter_mut().zip(&mut *from1).zip(y) {
        *from0 = (y - y0) * inverse;
        *from1 = (y - y1) * inverse;
    }
    let blocks = ((from0[n - 1] - from0[0]).abs() * BLOCKS) as usize + 1;
    if unit.is_cube() {
        for (t, (from0, from1)) in t.iter_mut().zip(from0.iter().zip(&*from1)) {
            *t = unit.root([*from0, *from1]);
        }
    } else if n >= blocks * LEAST {
        between_nodes(unit, blocks, from0, from1, t);
    } else {
        for (t, from0) in t.iter_mut().zip(&*from0) {
            *t = unit.start(*from0);
        }
    }
    for _ in 0..STEPS {
        let from = from0.iter().zip(&*from1);
        for ((t, doubt), (from0, from1)) in t.iter_mut().zip(&mut *doubt).zip(from) {
            (*t, *doubt) = step(unit.q, [*from0, *from1], *t);
        }
        if !many(doubt) {
            break;
        }
    }
    for j in 0..n {
        if !(doubt[j] <= 0.0) {
            t[j] = local(polynomial, y[j], t[j]);
        }
    }
    for ((x, t), y) in out.iter_mut().zip(&*t).zip(y) {
        let (left, right) = (x0 + t * h, end - (1.0 - t) * h);
        let place = if *t < 0.5 { left } else { right };
        let place = if *y == y0 { x0 } else { place };
        let place = if *y == y1 { end } else { place };
        let place = if place > x0 { place } else { x0 };
        *x = if place < end { place } else { end };
    }
}

/// Starts from a few of the queries: the inverse function's quintics that agree with it there up to the second
/// derivative. Over a twelfth of Δy they are right to 1e-6 or so, and one step does the rest.
#[inline]
fn between_nodes(unit: Unit, blocks: usize, from0: &[f64], from1: &[f64], t: &mut [f64]) {
    let node = |j: usize| {
        let (place, _) = step(unit.q, [from0[j], from1[j]], unit.start(from0[j]));
        let (first, second) = unit.derivatives(place);
        let slope = 1.0 / first;
        [place, slope, -second * slope * slope * slope]
    };
    let last = from0.len() - 1;
    let (mut from, mut a) = (0, node(0));
    for k in 1..=blocks {
        let to = last * k / blocks;
        let b = node(to);
        let width = from0[to] - from0[from];
        // Equal queries have no width, and all start from the node.
        let inverse = if width == 0.0 { 0.0 } else { 1.0 / width };
        // Of u from 0 to 1: what the parabola about the first node leaves to be made up at the second.
        let (a1, a2) = (a[1] * width, 0.5 * a[2] * width * width);
        let rest =
            [b[0] - a[0] - a1 - a2, b[1] * width - a1 - 2.0 * a2, b[2] * width * width - 2.0 * a2];
        let c3 = 10.0 * rest[0] - 4.0 * rest[1] + 0.5 * rest[2];
        let c4 = -15.0 * rest[0] + 7.0 * rest[1] - rest[2];
        let c5 = 6.0 * rest[0] - 3.0 * rest[1] + 0.5 * rest[2];
        let start = from0[from];
        for (t, r) in t[from..=to].iter_mut().zip(&from0[from..=to]) {
            let u = (r - start) * inverse;
            *t = a[0] + u * (a1 + u * (a2 + u * (c3 + u * (c4 + u * c5))));
        }
        (from, a) = (to, b);
    }
}
