// SPDX-License-Identifier: MIT OR Apache-2.0

//! Slopes that are held: at the ends, at given points, and the wrapping of periodic data.

use super::CubicOptions;
use super::problem::{OVERLAP, Problem};
use crate::MonotoneError;
use crate::data::Data;

/// What holds at the two ends of the data.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ends {
    /// The slope of the cubic through the four points at the end, between 0 and three secants: of order 4 on smooth data.
    #[default]
    Estimated,
    /// Free: second derivative 0, the least energy.
    Natural,
    /// `f(x + T) = f(x) + D` with the width T and the rise D of the data: slopes and second derivatives at the two ends
    /// agree.
    Periodic,
    /// Given slopes; `None` is free.
    Slopes([Option<f64>; 2]),
}

/// Hold the slopes at the ends of data that are not periodic.
pub(super) fn hold_ends(
    problem: &mut Problem,
    data: &Data,
    options: &CubicOptions,
) -> Result<(), MonotoneError> {
    let n = data.len();
    for (k, node) in [0, n].into_iter().enumerate() {
        if problem.held[node] {
            // The end of a flat, or a given slope; a slope given twice must be one.
            if let Ends::Slopes(slopes) = &options.ends
                && let Some(slope) = slopes[k]
            {
                check_sign("ends", k, slope, problem, node)?;
                let own = problem.slope[node];
                if data.slopes_in(&[slope])[0].abs() != own {
                    let rule = "must agree with the slope given for the end";
                    return Err(MonotoneError::HeldSlope {
                        argument: "ends",
                        index: k,
                        value: slope,
                        rule,
                    });
                }
            }
            continue;
        }
        match &options.ends {
            Ends::Natural | Ends::Periodic => {}
            Ends::Estimated => hold(problem, node, estimated(data, k == 1)),
            Ends::Slopes(slopes) => {
                if let Some(slope) = slopes[k] {
                    check_sign("ends", k, slope, problem, node)?;
                    hold(problem, node, data.slopes_in(&[slope])[0].abs());
                }
            }
        }
    }
    Ok(())
}

fn hold(problem: &mut Problem, node: usize, slope: f64) {
    (problem.held[node], problem.slope[node]) = (true, slope);
}

/// Hold the given slopes that are not NaN, one per point; `first` is the node of the first point.
pub(super) fn hold_given(
    problem: &mut Problem,
    data: &Data,
    slopes: &[f64],
    first: usize,
) -> Result<(), MonotoneError> {
    let n = data.len();
    if slopes.len() != n + 1 {
        return Err(MonotoneError::Length {
            argument: "slopes",
            found: slopes.len(),
            expected: n + 1,
        });
    }
    if let Some(index) = slopes.iter().position(|s| s.is_infinite()) {
        return Err(MonotoneError::NotFinite { argument: "slopes", index, value: slopes[index] });
    }
    let scaled = data.slopes_in(slopes);
    for (i, &slope) in slopes.iter().enumerate().filter(|(_, s)| !s.is_nan()) {
        check_sign("slopes", i, slope, problem, first + i)?;
        if first == 0 {
            if !problem.is_level(i) {
                hold(problem, i, scaled[i].abs());
            }
            continue;
        }
        // Periodic: the same at every copy of the point.
        if i % n == 0 && !slopes[n - i].is_nan() && slopes[n - i] != slope {
            let rule = "must be the same at both ends of periodic data";
            return Err(MonotoneError::HeldSlope {
                argument: "slopes",
                index: i,
                value: slope,
                rule,
            });
        }
        let start = (first + i) % n;
        for node in (start..problem.held.len()).step_by(n) {
            if !problem.is_level(node) {
                hold(problem, node, scaled[i].abs());
            }
        }
    }
    Ok(())
}

/// Whether a monotone function can have this slope.
fn check_sign(
    argument: &'static str,
    index: usize,
    value: f64,
    problem: &Problem,
    node: usize,
) -> Result<(), MonotoneError> {
    let refuse = |rule| Err(MonotoneError::HeldSlope { argument, index, value, rule });
    if !value.is_finite() {
        return Err(MonotoneError::NotFinite { argument, index, value });
    }
    if value == 0.0 {
        return Ok(());
    }
    let n = problem.sign.len();
    let (before, after) = (problem.sign[node.max(1) - 1], problem.sign[node.min(n - 1)]);
    if before == 0.0 || after == 0.0 {
        refuse("must be 0 beside a flat of the data")
    } else if before != after {
        refuse("must be 0 at a turn of the data")
    } else if value.signum() != before {
        refuse("must have the sign of the data's secants")
    } else {
        Ok(())
    }
}

/// Raise estimated ends to the least slope beside them; given slopes below theirs are refused.
pub(super) fn check_floor(
    problem: &mut Problem,
    data: &Data,
    options: &CubicOptions,
    first: usize,
) -> Result<(), MonotoneError> {
    let (n, intervals) = (data.len(), problem.h.len());
    for i in 0..=n {
        let node = first + i;
        let before = if node > 0 { problem.floor[node - 1] } else { 0.0 };
        let after = if node < intervals { problem.floor[node] } else { 0.0 };
        let least = before.max(after);
        if !problem.held[node] || problem.slope[node] >= least {
            continue;
        }
        let rule = "must not be below min_slope times the smallest secant beside it";
        let given = options.slopes.as_ref().map(|s| s[i]).filter(|s| !s.is_nan());
        if let Some(value) = given {
            return Err(MonotoneError::HeldSlope { argument: "slopes", index: i, value, rule });
        }
        let k = usize::from(i == n);
        if let Ends::Slopes(slopes) = &options.ends
            && let Some(value) = slopes[k]
        {
            return Err(MonotoneError::HeldSlope { argument: "ends", index: k, value, rule });
        }
        problem.slope[node] = least;
    }
    Ok(())
}

/// The size of the slope at an end of the cubic through its four points (of the parabola through three, the secant of
/// two), between 0 and three secants: Newton's divided differences. Where the cubic's slope is against the data because
/// they turn within the four points, only those before the turn count.
fn estimated(data: &Data, right: bool) -> f64 {
    let n = data.len();
    let at = |k: usize| if right { n - 1 - k } else { k };
    let (h, delta) = (|k: usize| data.h[at(k)], |k: usize| data.delta[at(k)]);
    // Mirrored at the right end: a derivative of odd order in the distance from the end keeps the secants' sign.
    let through = |intervals: usize| {
        let mut slope = delta(0);
        if intervals >= 2 {
            let second = (delta(1) - delta(0)) / (h(0) + h(1));
            slope -= h(0) * second;
            if intervals >= 3 {
                let next = (delta(2) - delta(1)) / (h(1) + h(2));
                let third = (next - second) / (h(0) + h(1) + h(2));
                slope += h(0) * ((h(0) + h(1)) * third);
            }
        }
        slope * delta(0).signum()
    };
    let before_turn = (1..n.min(3)).take_while(|&k| delta(k) * delta(0) > 0.0).count() + 1;
    let mut size = through(n.min(3));
    if size <= 0.0 && before_turn < n.min(3) {
        size = through(before_turn);
    }
    // NaN (differences out of range) becomes the secant.
    if size.is_nan() { delta(0).abs() } else { size.clamp(0.0, 3.0 * delta(0).abs()) }
}

/// Periodic data with copies of the last intervals before and of the first after them, and where they themselves begin.
/// What the ends of the copies do is not felt at the data.
pub(super) fn repeated(data: &Data) -> (Problem, usize) {
    let n = data.len();
    let index = |k: usize| (k + n * OVERLAP - OVERLAP) % n;
    let (mut h, mut delta) = (Vec::new(), Vec::new());
    for k in 0..n + 2 * OVERLAP {
        h.push(data.h[index(k)]);
        delta.push(data.delta[index(k)]);
    }
    let copies = Data { h, delta, ex: data.ex, ey: data.ey };
    (Problem::new(&copies), OVERLAP)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn ends_of_cubics_are_exact() {
        let x = [0.0f64, 0.7, 1.5, 3.0];
        let f = |x: f64| x * x * x + 2.0 * x;
        let y = x.map(f);
        let data = Data::new(&x, &y).unwrap();
        let slope = |right: bool| data.units().derivative_out(estimated(&data, right), 1);
        assert!((slope(false) - 2.0).abs() < 1e-13);
        assert!((slope(true) - 29.0).abs() < 1e-12);
        let fall = Data::new(&x, &y.map(|y| -y)).unwrap();
        assert_eq!(estimated(&fall, true), estimated(&data, true));
    }
}
