//! The plain C² cubic spline: where the search begins, and a lower bound of the parametric energy.

use glam::DVec3;
use shapespline_banded::{SolveError, solve_cyclic, solve_tridiagonal};

use crate::{
    element::{Node, Span},
    segment::{Demands, Units},
};

/// First and second derivatives of the C² cubic spline at the distinct nodes, in units of the polygon.
///
/// Row `i` is `w q_{i−1} + 2 q_i + (1−w) q_{i+1} = 3 (w V_{i−1} + (1−w) V_i)` with
/// `w = h_i/(h_{i−1} + h_i)` and `V = L/h`; natural ends read `2 q_0 + q_1 = 3 V_0`.
pub(crate) fn plain_cubic(demands: &Demands<'_>) -> Result<Vec<Node>, SolveError> {
    let polygon = demands.checker.polygon();
    let n = polygon.segments();
    let spans: Vec<Span> = (0..n).map(|i| demands.span(i)).collect();
    let velocity = |i: usize| spans[i].direction * spans[i].speed();
    let count = polygon.nodes();
    let (mut lower, mut upper) = (vec![0.0; count], vec![0.0; count]);
    let (mut diagonal, mut right) = (vec![2.0; count], vec![DVec3::ZERO; count]);
    for i in 0..count {
        let before = if i > 0 { i - 1 } else { n - 1 };
        if !polygon.is_closed() && (i == 0 || i == n) {
            let inner = if i == 0 { 0 } else { n - 1 };
            match polygon.tangents()[usize::from(i > 0)] {
                Some(tangent) => {
                    diagonal[i] = 1.0;
                    right[i] = to_units(tangent, demands.units);
                }
                None => {
                    let off = if i == 0 { &mut upper } else { &mut lower };
                    off[i] = 1.0;
                    right[i] = velocity(inner) * 3.0;
                }
            }
            continue;
        }
        let w = spans[i].spacing / (spans[before].spacing + spans[i].spacing);
        (lower[i], upper[i]) = (w, 1.0 - w);
        right[i] = (velocity(before) * w + velocity(i) * (1.0 - w)) * 3.0;
    }
    if polygon.is_closed() {
        solve_cyclic(&lower, &mut diagonal, &upper, &mut right)?;
    } else {
        solve_tridiagonal(&lower, &mut diagonal, &upper, &mut right)?;
    }
    let second = |i: usize| {
        if i < n {
            let next = right[(i + 1) % count];
            (velocity(i) * 6.0 - right[i] * 4.0 - next * 2.0) / spans[i].spacing
        } else {
            (right[n - 1] * 2.0 + right[n] * 4.0 - velocity(n - 1) * 6.0) / spans[n - 1].spacing
        }
    };
    Ok((0..count).map(|i| Node { q: right[i], r: second(i) }).collect())
}

/// A derivative with respect to the user's parameter, in the units inside.
pub(crate) fn to_units(v: DVec3, units: Units) -> DVec3 {
    v / units.length * units.time
}
