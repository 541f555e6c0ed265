// SPDX-License-Identifier: MIT OR Apache-2.0

//! Windows around failing segments, each solved by itself; on all threads, where there are many segments.

use shapespline_polynomial::parallel;

use crate::{
    control::Control,
    ladder::{Answer, LadderResult, certify, fall_back},
    rows::Rules,
    segment::Demands,
    solve::{LAST, Means, finish, quicken, solve},
    window::{BESIDE, Window, windows},
};

/// Segments from on which windows are solved on all threads, if there are several.
const MANY: usize = 8192;

/// Free nodes beside a failing segment in wider windows: in these, too, all is put to the closed-form start if
/// nothing else helps.
const WIDE: usize = 4 * BESIDE;

impl LadderResult<'_> {
    /// Solves windows around the failing segments; those in which that fails, wider ones.
    pub(crate) fn open_windows(
        &mut self,
        demands: &Demands<'_>,
        rules: Rules,
        control: &mut Control<'_>,
    ) {
        let polygon = demands.checker.polygon();
        let mut failing = self.failing(demands);
        self.open.extend(&failing);
        let (count, closed) = (polygon.nodes(), polygon.is_closed());
        let mut done = Vec::new();
        for beside in [BESIDE, WIDE, 4 * WIDE, count] {
            let around = |failing: &[usize]| windows(failing, count, closed, beside);
            let meet = |a: Window, b: Window| a.meets(b, count, closed);
            let all = absorb(&mut done, &mut failing, meet, around);
            let means = if beside == BESIDE { Means::Near } else { Means::Far };
            let found = self.solve_each(demands, rules, &all, means, control);
            let mut owners = owners(&failing, &all, count);
            failing.clear();
            for ((window, found), own) in all.into_iter().zip(found).zip(owners.drain(..)) {
                match found {
                    None => failing.extend(own),
                    Some(answer) => {
                        own.iter().for_each(|k| _ = self.open.remove(k));
                        self.put(answer);
                        done.push((window, own));
                    }
                }
            }
            failing.sort_unstable();
            if failing.is_empty() || control.is_over() {
                break;
            }
        }
    }

    /// What is found in each window, in their order: on all threads for a long curve, but where steps are limited.
    fn solve_each(
        &self,
        demands: &Demands<'_>,
        rules: Rules,
        all: &[Window],
        means: Means,
        control: &mut Control<'_>,
    ) -> Vec<Option<Answer>> {
        let of = |window: &Window, control: &mut Control<'_>| {
            self.solve_window(demands, rules, *window, means, control)
        };
        if all.len() < 2 || demands.checker.polygon().segments() < MANY || control.is_limited() {
            return all.iter().map(|window| of(window, control)).collect();
        }
        let shared = &*control;
        let beside = |k: usize| {
            let mut own = shared.beside();
            (of(&all[k], &mut own), own)
        };
        let found: Vec<_> = parallel::map(all.len(), 0, beside);
        let join = |(answer, own)| {
            control.add(own);
            answer
        };
        found.into_iter().map(join).collect()
    }

    /// What is found in a window; none where it takes a wider one, or other means.
    fn solve_window(
        &self,
        demands: &Demands<'_>,
        rules: Rules,
        window: Window,
        means: Means,
        control: &mut Control<'_>,
    ) -> Option<Answer> {
        let whole = window.count == demands.checker.polygon().nodes();
        let means = if whole { Means::All } else { means };
        let mut chain = window.chain(demands, &|i| self.plain.node(i, demands.units), rules);
        let mut method = solve(demands, &mut chain, means, control)?;
        quicken(demands, &mut chain, control);
        finish(&mut chain, LAST, control);
        let mut open = certify(demands, &mut chain, control);
        if !open.is_empty() && means != Means::Near {
            method = fall_back(demands, &mut chain, &mut open, control).unwrap_or(method);
        }
        (open.is_empty() || whole).then(|| Answer::of(demands, &chain, method, open))
    }
}

/// The windows around failing segments. Those solved before that they meet become parts of them, with the
/// segments that failed there: their nodes are not the plain cubic's any more.
fn absorb(
    done: &mut Vec<(Window, Vec<usize>)>,
    failing: &mut Vec<usize>,
    meet: impl Fn(Window, Window) -> bool,
    around: impl Fn(&[usize]) -> Vec<Window>,
) -> Vec<Window> {
    loop {
        let all = around(failing);
        let meets = |solved: &mut (Window, Vec<usize>)| all.iter().any(|w| meet(*w, solved.0));
        let met: Vec<usize> = done.extract_if(.., meets).flat_map(|solved| solved.1).collect();
        if met.is_empty() {
            return all;
        }
        failing.extend(met);
        failing.sort_unstable();
    }
}

/// The failing segments in each window.
fn owners(failing: &[usize], all: &[Window], count: usize) -> Vec<Vec<usize>> {
    // Both ascend, but for a first window that may begin before the first node.
    let mut owners = vec![Vec::new(); all.len()];
    let mut at = 0;
    for &k in failing {
        let order = (at..all.len()).chain(0..at);
        if let Some(own) = order.into_iter().find(|&w| all[w].touches(k, count)) {
            owners[own].push(k);
            at = own;
        }
    }
    owners
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wider window takes in what was solved beside it, and all that meets that in turn.
    #[test]
    fn wider_windows_take_in_those_that_they_meet() {
        for closed in [false, true] {
            let around = |beside: usize| move |f: &[usize]| windows(f, 1000, closed, beside);
            let of = |k: usize| (around(BESIDE)(&[k])[0], vec![k]);
            let meet = |a: Window, b: Window| a.meets(b, 1000, closed);
            let mut done = vec![of(5), of(60), of(100), of(500), of(990)];
            let mut failing = vec![140];
            let all = absorb(&mut done, &mut failing, meet, around(4 * BESIDE));
            assert_eq!(failing, [60, 100, 140]);
            assert_eq!(all.len(), 1);
            assert!((60..=140).all(|k| all[0].touches(k, 1000)));
            let left: Vec<&Vec<usize>> = done.iter().map(|solved| &solved.1).collect();
            assert_eq!(left, [&[5], &[500], &[990]]);
            failing = vec![985];
            let all = absorb(&mut done, &mut failing, meet, around(4 * BESIDE));
            let owners = owners(&failing, &all, 1000);
            assert_eq!(owners.concat().len(), failing.len());
            assert_eq!(failing.contains(&5), closed, "{failing:?}");
        }
    }
}
