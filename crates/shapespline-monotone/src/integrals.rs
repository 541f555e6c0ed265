// SPDX-License-Identifier: MIT OR Apache-2.0

//! Definite integrals over many pieces in O(log N).

use crate::beyond::Beyond;
use crate::extrapolation::{Continuation, Extrapolation};
use crate::periodic;
use once_cell::race::OnceBox;
use shapespline_polynomial::bernstein;
use shapespline_polynomial::knots::Searcher;

/// Items of a level that one item of the next sums up: levels take a fifteenth of a number a piece.
const WIDTH: usize = 16;
/// Pieces that are summed one by one: sums are made when there are more.
const FEW: usize = 64;

/// Sums of a number a piece over aligned runs of 16, 256, 4096, … pieces. Unlike differences of running sums, what
/// is put together from them is as accurate as adding the pieces.
#[derive(Debug)]
pub(crate) struct Sums {
    levels: Vec<Vec<f64>>,
}

impl Sums {
    /// Of `n` pieces. O(n).
    pub(crate) fn new(n: usize, piece: impl Fn(usize) -> f64) -> Self {
        let mut levels: Vec<Vec<f64>> = Vec::new();
        let mut count = n / WIDTH;
        while count > 0 {
            let run = |i: usize| i * WIDTH..(i + 1) * WIDTH;
            let level = match levels.last() {
                None => (0..count).map(|i| run(i).map(&piece).sum()).collect(),
                Some(below) => (0..count).map(|i| below[run(i)].iter().sum()).collect(),
            };
            levels.push(level);
            count /= WIDTH;
        }
        Self { levels }
    }

    /// The sum over the pieces `from..to`. O(log n).
    fn between(&self, mut from: usize, mut to: usize, piece: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for level in 0..=self.levels.len() {
            let value = |i: usize| if level == 0 { piece(i) } else { self.levels[level - 1][i] };
            let top = level == self.levels.len();
            while from < to && (top || !from.is_multiple_of(WIDTH)) {
                sum += value(from);
                from += 1;
            }
            while from < to && !to.is_multiple_of(WIDTH) {
                to -= 1;
                sum += value(to);
            }
            (from, to) = (from / WIDTH, to / WIDTH);
        }
        sum
    }
}

/// Sums that are made at the first request. A clone starts without.
#[derive(Debug, Default)]
pub(crate) struct Lazy(OnceBox<Sums>);

impl Clone for Lazy {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Lazy {
    pub(crate) fn get(&self, n: usize, piece: impl Fn(usize) -> f64) -> &Sums {
        self.0.get_or_init(|| Box::new(Sums::new(n, piece)))
    }
}

/// A function of polynomial pieces, as integration sees it.
pub(crate) struct Pieces<'a, P, S, B> {
    pub(crate) x: &'a [f64],
    pub(crate) search: Searcher<'a>,
    pub(crate) degree: usize,
    /// Bernstein coefficients of a piece, `degree + 1` of them (or more, to be left out).
    pub(crate) piece: P,
    /// Sums of the pieces' integrals, made when they are needed first.
    pub(crate) sums: S,
    /// The polynomial beyond an end.
    pub(crate) beyond: B,
}

impl<'a, C, P, S, B> Pieces<'a, P, S, B>
where
    C: AsRef<[f64]>,
    P: Fn(usize) -> C,
    S: Fn() -> &'a Sums,
    B: Fn(bool, Continuation) -> Option<Beyond>,
{
    /// `∫ₐᵇ f dx`, also for a > b and outside the knots as the extrapolation says.
    pub(crate) fn integrate(&self, a: f64, b: f64, mode: Extrapolation) -> f64 {
        if a.is_nan() || b.is_nan() {
            return f64::NAN;
        }
        if a > b {
            return -self.integrate(b, a, mode);
        }
        let (first, end) = (self.x[0], self.x[self.x.len() - 1]);
        let mut sum = 0.0;
        for (from, to, right) in [(a, b.min(first), false), (a.max(end), b, true)] {
            if from < to {
                sum += self.outside(from, to, right, mode.side(right));
            }
        }
        let (from, to) = (a.max(first), b.min(end));
        if from < to { sum + self.inside(from, to) } else { sum }
    }

    /// The integral over a part beyond one end.
    fn outside(&self, a: f64, b: f64, right: bool, mode: Continuation) -> f64 {
        if matches!(mode, Continuation::Periodic(_)) {
            let (first, end) = (self.x[0], self.x[self.x.len() - 1]);
            let [(k, from), (l, to)] = [a, b].map(|x| periodic::wrapped(x, first, end));
            let part = |from: f64, to: f64| if from < to { self.inside(from, to) } else { 0.0 };
            if k == l {
                return part(from, to);
            }
            return (part(first, to) + part(from, end)) + (l - k - 1.0) * part(first, end);
        }
        (self.beyond)(right, mode).map_or(f64::NAN, |part| part.integrate(a, b))
    }

    /// The integral over a part of the knots.
    fn inside(&self, from: f64, to: f64) -> f64 {
        let (i, j) = (self.search.find(from), self.search.find(to));
        if i == j {
            return self.part(i, from, to);
        }
        let whole = |k: usize| self.part(k, self.x[k], self.x[k + 1]);
        let between = if j - i <= FEW {
            (i + 1..j).map(whole).sum()
        } else {
            (self.sums)().between(i + 1, j, whole)
        };
        self.part(i, from, self.x[i + 1]) + between + self.part(j, self.x[j], to)
    }

    /// The integral over a part of one piece.
    fn part(&self, i: usize, from: f64, to: f64) -> f64 {
        let c = (self.piece)(i);
        let (start, h) = (self.x[i], self.x[i + 1] - self.x[i]);
        let step = h / (self.degree + 1) as f64;
        let mut sums = vec![0.0];
        let mut run = 0.0;
        for v in &c.as_ref()[..=self.degree] {
            run += v * step;
            sums.push(run);
        }
        let at = |x: f64| {
            if x <= start {
                0.0
            } else if x >= self.x[i + 1] {
                run
            } else {
                bernstein::value(&sums, (x - start) / h)
            }
        };
        at(to) - at(from)
    }
}

/// The integral of a piece of length h.
pub(crate) fn whole(c: &[f64], h: f64) -> f64 {
    let step = h / c.len() as f64;
    c.iter().map(|v| v * step).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of integers are exact, in any order.
    #[test]
    fn every_run_is_summed() {
        for n in [1usize, 15, 16, 17, 255, 300, 5000] {
            let sums = Sums::new(n, |i| (i * i % 101) as f64);
            for k in 0..300 {
                let (from, to) = ((k * 7919) % n, (k * 104_729) % (n + 1));
                let (from, to) = (from.min(to), from.max(to));
                let direct: f64 = (from..to).map(|i| (i * i % 101) as f64).sum();
                assert_eq!(sums.between(from, to, |i| (i * i % 101) as f64), direct);
            }
        }
    }
}
