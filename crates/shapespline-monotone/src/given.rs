// SPDX-License-Identifier: MIT OR Apache-2.0

//! Given slopes: whether a C² monotone quintic has them, and second derivatives with which it is strictly monotone.
//!
//! A segment couples the second derivatives at its ends ([`Region`]), and nothing else does. So what the nodes up to i
//! leave to sᵢ is an interval Jᵢ, which follows from Jᵢ₋₁ and segment i−1; slopes are possible exactly when none of the
//! intervals is empty. On the way back sᵢ is chosen in the middle of what Jᵢ and the choice at i + 1 leave. O(N).

use crate::MonotoneError;
use crate::data::Data;
use crate::energy::is_flat;
use crate::interrupt::{GoOn, check_interrupt};
use crate::optimal::{Fixed, Prescribed};
use crate::program::admissible_slopes;
use crate::region::Region;
use crate::slopes::{limited, sign};

/// Intervals below this width, relative to their ends, are points: what they hold is not free.
const NARROW: f64 = 1e-9;
/// Intervals that miss each other by less than this share of their ends meet.
const ROUNDING: f64 = 1e-12;
/// Segments between two questions whether to go on.
const ASK: usize = 1024;

type Interval = [f64; 2];
const ALL: Interval = [f64::NEG_INFINITY, f64::INFINITY];

/// Slopes that a C² monotone quintic has, and a quintic that has them; scaled units.
pub(crate) struct Possible {
    /// Nodes whose slopes had to be limited.
    pub(crate) limited: Vec<usize>,
    fixed: Vec<Fixed>,
    inside: Vec<[f64; 2]>,
}

impl Possible {
    pub(crate) fn prescribed(&self) -> Prescribed<'_> {
        Prescribed { fixed: &self.fixed, inside: &self.inside }
    }
}

/// What is known of the nodes up to one.
struct Pass<'a> {
    data: &'a Data,
    d: Vec<f64>,
    /// The intervals Jᵢ.
    left: Vec<Interval>,
    /// Slopes that are possible whatever those beside them; empty where none may be limited.
    safe: Vec<f64>,
    limited: Vec<usize>,
}

/// What is fixed where all slopes are given, if none is impossible at its node alone.
pub(crate) fn fixed(data: &Data, d: &[f64]) -> Option<Vec<Fixed>> {
    let of = |(i, &d): (usize, &f64)| {
        let flat = is_flat(data.delta[i.max(1) - 1]) || is_flat(data.delta[i.min(data.len() - 1)]);
        fits(data, i, d).ok().map(|()| [d, if flat { 0.0 } else { f64::NAN }])
    };
    d.iter().enumerate().map(of).collect()
}

/// Given slopes, or with `clip` those nearby that are possible.
pub(crate) fn possible(
    data: &Data,
    given: &[f64],
    clip: bool,
    go_on: GoOn<'_>,
) -> Result<Possible, MonotoneError> {
    let n = data.len();
    let mut pass = Pass::new(data, given, clip);
    for i in 0..=n {
        if let Err(rule) = fits(data, i, pass.d[i])
            && !pass.limit(i)
        {
            return Err(MonotoneError::Slope { index: i, value: given[i], rule });
        }
    }
    let mut i = 0;
    while i < n {
        if i % ASK == 0 {
            check_interrupt(go_on)?;
        }
        if let Some(next) = pass.forward(i) {
            pass.left[i + 1] = next;
            i += 1;
            continue;
        }
        // The slope on the right, that on the left, then those before, the nearest first.
        match (0..=i + 1).rev().find(|&k| pass.limit(k)) {
            Some(k) => i = i.min(k.max(1) - 1),
            None => {
                let share = |k: usize| (given[k] / pass.data.delta[i]).abs();
                let index = if share(i) >= share(i + 1) { i } else { i + 1 };
                let rule = "with the slopes beside it must leave room for a C² monotone quintic";
                return Err(MonotoneError::Slope { index, value: given[index], rule });
            }
        }
    }
    check_interrupt(go_on)?;
    Ok(pass.choose())
}

/// What is wrong with a slope whatever the others.
fn fits(data: &Data, i: usize, d: f64) -> Result<(), &'static str> {
    let (l, r) = (data.delta[i.max(1) - 1], data.delta[i.min(data.len() - 1)]);
    if d == 0.0 {
        Ok(())
    } else if is_flat(l) || is_flat(r) {
        Err("must be 0 beside a flat of the data")
    } else if sign(l) != sign(r) {
        Err("must be 0 at a turn of the data")
    } else if sign(d) != sign(l) {
        Err("must have the sign of the data's secants")
    } else {
        Ok(())
    }
}

impl<'a> Pass<'a> {
    fn new(data: &'a Data, given: &[f64], clip: bool) -> Self {
        let n = data.len();
        let d = data.slopes_in(given);
        let mut safe = Vec::new();
        if clip {
            safe = limited(data, given);
            admissible_slopes(data, &mut safe);
        }
        let mut pass = Self { data, d, left: vec![ALL; n + 1], safe, limited: Vec::new() };
        pass.left[0] = pass.allowed(0);
        pass
    }

    /// Limit the slope at a node, if that may be and changes it.
    fn limit(&mut self, i: usize) -> bool {
        match self.safe.get(i) {
            Some(&safe) if safe != self.d[i] => {
                self.d[i] = safe;
                self.limited.push(i);
                true
            }
            _ => false,
        }
    }

    /// The second derivatives at a node that flats leave, and slopes of 0 where the data rise or fall on both sides.
    fn allowed(&self, i: usize) -> Interval {
        let n = self.data.len();
        let [l, r] = [i.max(1) - 1, i.min(n - 1)].map(|k| self.data.delta[k]);
        let flat = is_flat(l) || is_flat(r);
        let level = self.d[i] == 0.0 && sign(l) == sign(r) && 0 < i && i < n;
        if flat || level { [0.0; 2] } else { ALL }
    }

    /// The region of a segment, seen from its left or its right end, and the factor to its derivatives there.
    fn region(&self, i: usize, from_right: bool) -> Option<(Region, f64)> {
        let (h, delta) = (self.data.h[i], self.data.delta[i]);
        let (a, b) = (self.d[i] / delta, self.d[i + 1] / delta);
        // p(1 − t) has the derivatives of p with the other sign.
        if from_right {
            Some((Region::new(b, a)?, -h / delta))
        } else {
            Some((Region::new(a, b)?, h / delta))
        }
    }

    /// What `here` at one end of a segment leaves at its other end.
    fn through(&self, i: usize, from_right: bool, here: Interval) -> Option<Interval> {
        if is_flat(self.data.delta[i]) {
            return Some([0.0; 2]);
        }
        let (region, factor) = self.region(i, from_right)?;
        let ordered = |p: f64, q: f64| if p <= q { [p, q] } else { [q, p] };
        let [low, high] = ordered(factor * here[0], factor * here[1]);
        let [low, high] = region.range(low, high)?;
        let factor = factor.recip();
        Some(ordered(factor * low, factor * high))
    }

    fn forward(&self, i: usize) -> Option<Interval> {
        meet(self.through(i, false, self.left[i])?, self.allowed(i + 1))
    }

    /// Second derivatives well inside of what is possible, and which of them are not free.
    fn choose(self) -> Possible {
        let n = self.data.len();
        let mut inside = vec![[0.0; 2]; n + 1];
        let mut fixed = inside.clone();
        let mut right = ALL;
        for i in (0..=n).rev() {
            // Rounding may separate what the way here has found to meet.
            let [low, high] = meet(self.left[i], right).unwrap_or(self.left[i]);
            let s = 0.5 * (low + high);
            let narrow = high - low <= NARROW * (low.abs() + high.abs());
            inside[i] = [self.d[i], s];
            fixed[i] = [self.d[i], if narrow { s } else { f64::NAN }];
            if i > 0 {
                right = self.through(i - 1, true, [s; 2]).unwrap_or(ALL);
            }
        }
        let mut limited = self.limited;
        limited.sort_unstable();
        Possible { limited, fixed, inside }
    }
}

/// The common part of two intervals; a point where rounding may have separated them.
fn meet(a: Interval, b: Interval) -> Option<Interval> {
    let (low, high) = (a[0].max(b[0]), a[1].min(b[1]));
    if low <= high {
        Some([low, high])
    } else if low - high <= ROUNDING * (low.abs() + high.abs()) {
        Some([0.5 * (low + high); 2])
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::energy::{self, Fairness};
    use crate::optimal::{coefficients, fixed_by_data, optimise};
    use crate::reference;
    use shapespline_polynomial::certified_nonnegative;
    use shapespline_polynomial::quartic::{basis, dot};
    use std::ops::ControlFlow;

    struct Lcg(u64);
    impl Lcg {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// Rising, falling, turning data with flats; and slopes between 0 and what is too much.
    fn sample(rng: &mut Lcg, case: usize) -> (Data, Vec<f64>) {
        let n = 1 + case % 9;
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for k in 0..n {
            let turn = case % 3 == 1 && rng.next() < 0.3;
            let flat = case % 3 == 2 && rng.next() < 0.2;
            let rise = if flat { 0.0 } else { 0.1 + rng.next() };
            x.push(x[k] + 0.3 + rng.next());
            y.push(y[k] + if turn { -rise } else { rise });
        }
        let data = Data::new(&x, &y).unwrap();
        let delta = |k: usize| (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
        let most = 2.0 + 8.0 * rng.next();
        let slope = |i: usize| {
            let (l, r) = (delta(i.max(1) - 1), delta(i.min(n - 1)));
            let share = if rng.next() < 0.1 { 0.0 } else { rng.next() };
            if l * r > 0.0 { share * most * l.signum() * l.abs().min(r.abs()) } else { 0.0 }
        };
        let d = (0..=n).map(slope).collect();
        (data, d)
    }

    /// By how much p can be above 0 everywhere with these slopes, from a linear program on a grid.
    fn room(data: &Data, d: &[f64]) -> f64 {
        let n = data.len();
        let mut positive = vec![(vec![(n + 1, -1.0)], 1.0)];
        let mut equal = Vec::new();
        for i in 0..n {
            let (h, delta) = (data.h[i], data.delta[i]);
            if is_flat(delta) {
                equal.extend([(vec![(i, 1.0)], 0.0), (vec![(i + 1, 1.0)], 0.0)]);
                continue;
            }
            for k in 0..=200 {
                let w = basis(f64::from(k) / 200.0);
                let at =
                    |s: [f64; 2]| dot(&coefficients(h, delta, [d[i], s[0]], [d[i + 1], s[1]]), &w);
                let constant = at([0.0; 2]);
                let weight = if k % 200 == 0 { 0.0 } else { -1.0 };
                let row = vec![
                    (i, at([1.0, 0.0]) - constant),
                    (i + 1, at([0.0, 1.0]) - constant),
                    (n + 1, weight),
                ];
                positive.push((row, constant));
            }
        }
        let mut q = vec![0.0; n + 2];
        q[n + 1] = -1.0;
        reference::quadratic(n + 2, vec![], &q, &equal, &positive).0[n + 1]
    }

    fn go_on() -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Possible slopes are taken, others refused, as a linear program has it; and the energy is the least.
    #[test]
    fn possible_exactly_where_a_linear_program_says_so() {
        let mut rng = Lcg(1);
        let (mut taken, mut refused) = (0, 0);
        for case in 0..200 {
            let (data, d) = sample(&mut rng, case);
            let given = d;
            let scaled = data.slopes_in(&given);
            let room = room(&data, &scaled);
            let found = possible(&data, &given, false, &go_on);
            if room < -1e-3 {
                refused += 1;
                assert!(found.is_err(), "case {case}: {room}");
            } else if room > 1e-3 {
                taken += 1;
                let found = found.unwrap();
                for i in (0..data.len()).filter(|&i| !is_flat(data.delta[i])) {
                    let c = coefficients(
                        data.h[i],
                        data.delta[i],
                        found.inside[i],
                        found.inside[i + 1],
                    );
                    assert!(certified_nonnegative(&c, 0.0), "case {case} segment {i}: {c:?}");
                }
                let best = optimise(&data, Fairness::Bending, Some(found.prescribed()));
                assert_eq!(best.d, scaled, "case {case}");
                // What the data fix the reference knows already.
                let open = |i: usize| fixed_by_data(&data.delta, i)[0].is_nan();
                let asked = |(i, d): (usize, &f64)| if open(i) { *d } else { f64::NAN };
                let asked: Vec<f64> = scaled.iter().enumerate().map(asked).collect();
                let (d, s) = reference::exact(&data, Fairness::Bending, &asked);
                let of = |d: &[f64], s: &[f64]| energy::total(&data, Fairness::Bending, d, s);
                let ratio = of(&best.d, &best.s) / of(&d, &s);
                assert!(best.converged, "case {case}: {best:?} room {room}");
                assert!((1.0 - 1e-6..1.005).contains(&ratio), "case {case}: {ratio} room {room}");
            }
        }
        println!("{taken} taken, {refused} refused");
        assert!(taken > 50 && refused > 50, "{taken} {refused}");
    }

    /// Limited slopes are possible, those that could stay have stayed, and limiting is idle where all is possible.
    #[test]
    fn limited_slopes_are_possible() {
        let mut rng = Lcg(2);
        for case in 0..600 {
            let (data, d) = sample(&mut rng, case);
            let given: Vec<f64> = d.iter().map(|d| 3.0 * d * (rng.next() - 0.2)).collect();
            let found = possible(&data, &given, true, &go_on).unwrap();
            let plain = possible(&data, &given, false, &go_on);
            assert_eq!(plain.is_ok(), found.limited.is_empty(), "case {case}");
            let scaled = data.slopes_in(&given);
            for (i, [d, _]) in found.inside.iter().enumerate() {
                assert_eq!(scaled[i] != *d, found.limited.contains(&i), "case {case} node {i}");
                assert!(d.abs() <= scaled[i].abs(), "case {case} node {i}");
            }
            let best = optimise(&data, Fairness::Bending, Some(found.prescribed()));
            assert!(best.converged, "case {case}: {best:?}");
        }
    }
}
