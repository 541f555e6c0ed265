// SPDX-License-Identifier: MIT OR Apache-2.0

//! Raising tension until no criterion fails: paper 001, (5.58)–(5.65).

use crate::{
    Phase, SearchOptions, Status, TensionFamily,
    fronts::{Front, Fronts},
    pattern::TensionPattern,
    state::{AROUND, State, on_all_sides},
};

impl<F: TensionFamily> State<'_, F> {
    /// Raises tension until nothing fails.
    pub(crate) fn raise(&mut self, options: &SearchOptions) -> Result<Status, F::Error> {
        let mut fronts = Fronts::default();
        let status = loop {
            if self.violations.is_empty() {
                break Status::Solved;
            }
            if self.stopped {
                break Status::Interrupted;
            }
            if options.max_iterations.is_some_and(|most| self.iterations >= most) {
                break Status::IterationLimit;
            }
            let ahead = if options.strategy.looks_first() {
                fronts.find(&self.violations, self.windows.polygon())
            } else {
                Vec::new()
            };
            let (violated, raised) = (self.violations.len(), self.raise_pending(options, &ahead));
            let Some(changed) = raised else { break Status::Stalled };
            self.iterations += 1;
            if !(options.strategy.looks_first() && self.violations_stay()) {
                self.set_pending()?;
            }
            self.log(Phase::Raise, violated, changed);
        };
        if !self.pending.is_empty() {
            self.set_pending()?;
        }
        Ok(status)
    }

    /// Raises the tension that the violations require: (5.58)–(5.65), with the index m + k (E4),
    /// and that ahead of fronts. Returns the number of nodes; `None` if a segment fails at whose
    /// nodes tension can rise no further.
    fn raise_pending(&mut self, options: &SearchOptions, fronts: &[Front]) -> Option<usize> {
        let ahead = self.ahead(fronts);
        let equal = self.find_nodes();
        let levels = self.levels(&equal, options);
        let Self { family, pending, nodes, before, .. } = self;
        // Mostly the nodes are among those that were raised before: both ascend.
        let mut at = 0;
        before.clear();
        for &i in &*nodes {
            at += pending[at..].iter().take_while(|change| change.0 < i).count();
            match pending.get_mut(at) {
                Some((node, tension)) if *node == i => before.push(*tension),
                _ => {
                    before.push(node_tension(*family, i));
                    pending.insert(at, (i, node_tension(*family, i)));
                }
            }
            pending[at].1 = options.raised(pending[at].1);
        }
        for (i, level) in levels {
            if let Ok(at) = place(pending, i) {
                pending[at].1 = level;
            }
        }
        if !self.all_can_rise() {
            return None;
        }
        let changed = self.nodes.len() + ahead.len();
        if !ahead.is_empty() {
            // The higher one of two tensions at a node.
            self.pending.extend(ahead);
            self.pending.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            self.pending.dedup_by_key(|change| change.0);
        }
        Some(changed)
    }

    /// What fronts say that the tension at some nodes is to be, where that is more than it is.
    fn ahead(&self, fronts: &[Front]) -> Vec<(usize, f64)> {
        let nodes = fronts.iter().flat_map(|front| front.nodes(self.windows.polygon()));
        let levels = nodes.map(|[last, node]| (node, self.tension(last)));
        levels.filter(|&(node, level)| level > self.tension(node)).collect()
    }

    /// Whether each segment that fails has a node at which tension has risen.
    fn all_can_rise(&mut self) -> bool {
        let Self { pending, nodes, before, .. } = self;
        let has_risen =
            |at: usize, i: usize| place(pending, i).is_ok_and(|k| pending[k].1 > before[at]);
        if nodes.iter().enumerate().all(|(at, &i)| has_risen(at, i)) {
            return true;
        }
        let polygon = self.windows.polygon();
        self.violations.iter().all(|&(segment, violations)| {
            let mut nodes = TensionPattern::of(violations).nodes(segment, polygon);
            nodes.any(|i| self.nodes.binary_search(&i).is_ok_and(|at| has_risen(at, i)))
        })
    }

    /// Finds the nodes that the violations require to be raised, and the segments at whose nodes
    /// tension is to be equal.
    fn find_nodes(&mut self) -> Vec<usize> {
        let mut equal = Vec::new();
        self.nodes.clear();
        for &(segment, violations) in &self.violations {
            let pattern = TensionPattern::of(violations);
            self.nodes.extend(pattern.nodes(segment, self.windows.polygon()));
            if pattern.equal {
                equal.push(segment);
            }
        }
        self.nodes.sort_unstable();
        self.nodes.dedup();
        equal
    }

    /// (5.65): over a run of non-convex coplanar segments the pull is one and the same. The tensions that
    /// says of nodes that are to be raised.
    fn levels(&self, equal: &[usize], options: &SearchOptions) -> Vec<(usize, f64)> {
        let (n, closed) = (self.windows.polygon().nodes(), self.closed());
        let mut levels = Vec::new();
        for run in consecutive(equal, closed.then_some(n)) {
            let run = || run.iter().flat_map(|&m| [m % n, (m + 1) % n]);
            let pull = |i: usize| self.tension(i) / self.family.tension_unit(i);
            let level = options.raised(run().map(pull).fold(0.0, f64::max));
            let raised = run().filter(|i| self.nodes.binary_search(i).is_ok());
            levels.extend(raised.map(|i| (i, level * self.family.tension_unit(i))));
        }
        levels
    }

    /// Tension at a node as it is, or as it is going to be.
    fn tension(&self, node: usize) -> f64 {
        place(&self.pending, node)
            .map_or_else(|_| node_tension(self.family, node), |at| self.pending[at].1)
    }

    /// Whether segments around the pending tensions fail under them, where that can be seen without setting
    /// them and takes in all that are known to fail.
    fn violations_stay(&mut self) -> bool {
        let pending = std::mem::take(&mut self.pending);
        let around = self.trial(&on_all_sides::<F>(&pending), AROUND);
        self.pending = pending;
        let Some(around) = around else { return false };
        if self.violations.iter().any(|(i, _)| !around.contains(i)) {
            return false;
        }
        let (legs, start) = (&self.legs, around.start);
        self.violations.clear();
        self.windows.unproved(around, |i| legs[i - start], &mut self.violations);
        self.doubts.sift(&mut self.windows, &mut self.violations, |i| legs[i - start]);
        if let Some(&(segment, _)) = self.violations.first() {
            self.suspect = segment;
        }
        !self.violations.is_empty()
    }
}

/// The larger tension beside a node.
fn node_tension<F: TensionFamily>(family: &F, node: usize) -> f64 {
    let sides = node * F::SIDES..(node + 1) * F::SIDES;
    family.tension()[sides].iter().copied().fold(0.0, f64::max)
}

/// Maximal runs of consecutive numbers in an ascending list; in a cycle of length `n` the last run
/// joins the first where they meet (paper 001, (5.63)–(5.64), modulo N by E5).
fn consecutive(list: &[usize], cycle: Option<usize>) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    for &m in list {
        match runs.last_mut() {
            Some(run) if run.last() == Some(&(m.wrapping_sub(1))) => run.push(m),
            _ => runs.push(vec![m]),
        }
    }
    if let Some(n) = cycle
        && runs.len() > 1
        && runs[0][0] == 0
        && list.last() == Some(&(n - 1))
    {
        let head = runs.remove(0);
        if let Some(tail) = runs.last_mut() {
            tail.extend(head);
        }
    }
    runs
}

/// Where the change of a node stands among others, or where it belongs.
fn place(changes: &[(usize, f64)], node: usize) -> Result<usize, usize> {
    changes.binary_search_by_key(&node, |change| change.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::{convert::Infallible, ops::ControlFlow, ops::Range};

    use shapespline_criteria::{Checker, Criteria, Tolerances};
    use shapespline_geometry::{Boundary, DVec3, DataPolygon, Parametrization};

    use super::*;
    use crate::{Diagnostics, Strategy, search::search};

    #[test]
    fn runs_join_over_the_seam_of_closed_data_only() {
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], None), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(10)), [vec![4, 5], vec![9, 0, 1]]);
        // Another segment comes after the last one here.
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(11)), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 2], Some(3)), [vec![0, 1, 2]]);
    }

    /// Dominoes: a segment fails from when the one before it stands until it has tension enough at its end.
    struct Dominoes {
        polygon: DataPolygon,
        tension: Vec<f64>,
        enough: f64,
    }

    impl Dominoes {
        fn new(segments: usize, enough: f64) -> Self {
            let at = |k: usize| DVec3::new((0.3 * k as f64).cos(), (0.3 * k as f64).sin(), 0.0);
            let points = (0..=segments).map(at).collect();
            let names = Parametrization::Uniform;
            let polygon = DataPolygon::new(points, &names, Boundary::Circular).unwrap();
            Self { polygon, tension: vec![0.0; segments + 1], enough }
        }

        fn search(
            mut self,
            strategy: Strategy,
            step: f64,
            max_iterations: Option<usize>,
        ) -> Diagnostics {
            let criteria = Criteria::from_iter([shapespline_criteria::Criterion::Convexity]);
            let options = SearchOptions {
                criteria,
                strategy,
                step,
                max_iterations,
                ..SearchOptions::default()
            };
            let polygon = self.polygon.clone();
            let checker = Checker::new(&polygon, criteria, Tolerances::default());
            let go_on = &mut |_: &crate::Step| ControlFlow::Continue(());
            let Ok(outcome) = search(&mut self, &checker, &options, go_on);
            outcome.diagnostics
        }
    }

    impl TensionFamily for Dominoes {
        type Error = Infallible;

        fn tension(&self) -> &[f64] {
            &self.tension
        }
        fn set_tension(
            &mut self,
            changes: &[(usize, f64)],
            touched: &mut Vec<Range<usize>>,
        ) -> Result<(), Infallible> {
            for &(node, tension) in changes {
                self.tension[node] = tension;
                touched.push(node.saturating_sub(1)..(node + 1).min(self.polygon.segments()));
            }
            Ok(())
        }
        fn solve(&mut self) -> Result<(), Infallible> {
            Ok(())
        }
        fn end_legs(&self, i: usize) -> [DVec3; 2] {
            let leg = |node: usize| {
                let [before, after] = self.polygon.directions_at(node);
                (before + after) * 0.05
            };
            let stands = |node: usize| self.tension[node] >= self.enough;
            let fails = (i == 0 || stands(i)) && !stands(i + 1);
            [if fails { -leg(i) } else { leg(i) }, leg(i + 1)]
        }
    }

    #[test]
    fn a_front_is_followed_to_its_end() {
        let n = 12_000;
        // The papers' rules go a segment a round or slower, and no number of rounds is too many.
        let slow = Dominoes::new(n, 0.5).search(Strategy::Nussp, 0.5, None);
        assert_eq!((slow.status, slow.iterations), (Status::Solved, n + 1));
        let slow = Dominoes::new(n, 2.0).search(Strategy::Reduction, 0.5, None);
        assert_eq!((slow.status, slow.iterations), (Status::Solved, 2 * n + 1));
        for enough in [0.5, 4.0] {
            let fast = Dominoes::new(n, enough).search(Strategy::Growth, 0.5, None);
            assert_eq!(fast.status, Status::Solved);
            assert!(fast.iterations < 80 && fast.nodes_changed >= n, "{fast:?}");
        }
        // A limit that is given is kept.
        for strategy in [Strategy::Nussp, Strategy::Growth] {
            let cut = Dominoes::new(n, 0.5).search(strategy, 0.5, Some(11));
            assert_eq!((cut.status, cut.iterations), (Status::IterationLimit, 11));
        }
    }

    #[test]
    fn a_search_whose_tension_can_rise_no_further_ends() {
        let search = |strategy, step, limit| {
            let end = Dominoes::new(50, f64::INFINITY).search(strategy, step, limit);
            (end.status, end.iterations)
        };
        // 0.5 · 2^201 is beyond 1e60, and so is 0.5^−200.
        assert_eq!(search(Strategy::Growth, 0.5, None), (Status::Stalled, 203));
        assert_eq!(search(Strategy::Fairest, 1e-9, None), (Status::Stalled, 232));
        assert_eq!(search(Strategy::Reduction, 0.5, None), (Status::Stalled, 201));
        assert_eq!(search(Strategy::Nussp, 0.5, None), (Status::Stalled, 10_001));
        assert_eq!(search(Strategy::Nussp, 1e-9, Some(20_000)), (Status::IterationLimit, 20_000));
    }
}
