//! Raising tension until no criterion fails: paper 001, (5.58)–(5.65).

use crate::{Pattern, Phase, SearchOptions, Status, TensionFamily, state::State};

impl<F: TensionFamily> State<'_, F> {
    /// Raises tension until nothing fails.
    pub(crate) fn raise(&mut self, options: &SearchOptions) -> Result<Status, F::Error> {
        let status = loop {
            if self.faults.is_empty() {
                break Status::Solved;
            }
            if self.stopped {
                break Status::Interrupted;
            }
            if self.iterations >= options.limit() {
                break Status::IterationLimit;
            }
            let (violated, changed) = (self.faults.len(), self.raise_pending(options));
            self.iterations += 1;
            if !(options.strategy.looks_first() && self.faults_stay()) {
                self.set_pending()?;
            }
            self.log(Phase::Raise, violated, changed);
        };
        if !self.pending.is_empty() {
            self.set_pending()?;
        }
        Ok(status)
    }

    /// Raises the tension that the faults call for: (5.58)–(5.65), with the index m + k (E4). Returns the
    /// number of nodes.
    fn raise_pending(&mut self, options: &SearchOptions) -> usize {
        let Self { family, faults, pending, nodes, .. } = self;
        let (n, closed) = (family.tension().len(), self.windows.polygon().is_closed());
        let node = |at: usize, offset: usize| -> Option<usize> {
            // Offsets count from −1.
            if closed {
                Some((at + n + offset - 1) % n)
            } else {
                (at + offset).checked_sub(1).filter(|&i| i < n)
            }
        };
        nodes.clear();
        let mut equal = Vec::new();
        for &(segment, faults) in &*faults {
            let pattern = Pattern::of(faults);
            let raise = pattern.raise.iter().enumerate().filter(|(_, raise)| **raise);
            nodes.extend(raise.filter_map(|(offset, _)| node(segment, offset)));
            if pattern.equal {
                equal.push(segment);
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        // (5.65): over a run of non-convex coplanar segments the pull is one and the same.
        let mut levels = Vec::new();
        for run in consecutive(&equal, closed.then_some(n)) {
            let run = || run.iter().flat_map(|&m| [m % n, (m + 1) % n]);
            let tension =
                |i: usize| place(pending, i).map_or(family.tension()[i], |at| pending[at].1);
            let pull = |i: usize| tension(i) / family.weight(i);
            let level = options.raised(run().map(pull).fold(0.0, f64::max));
            let raised = run().filter(|i| nodes.binary_search(i).is_ok());
            levels.extend(raised.map(|i| (i, level * family.weight(i))));
        }
        // Mostly the nodes are among those that were raised before: both ascend.
        let mut at = 0;
        for &i in &*nodes {
            at += pending[at..].iter().take_while(|change| change.0 < i).count();
            match pending.get_mut(at) {
                Some((node, tension)) if *node == i => *tension = options.raised(*tension),
                _ => pending.insert(at, (i, options.raised(family.tension()[i]))),
            }
        }
        for (i, level) in levels {
            if let Ok(at) = place(pending, i) {
                pending[at].1 = level;
            }
        }
        nodes.len()
    }

    /// Whether segments around the pending tensions fail under them, where that can be seen without setting
    /// them and takes in all that are known to fail.
    fn faults_stay(&mut self) -> bool {
        let pending = std::mem::take(&mut self.pending);
        let around = self.look(&pending);
        self.pending = pending;
        let Some(around) = around else { return false };
        if self.faults.iter().any(|(i, _)| !around.contains(i)) {
            return false;
        }
        let (legs, start) = (&self.legs, around.start);
        self.faults.clear();
        self.windows.faults(around, |i| legs[i - start], &mut self.faults);
        if let Some(&(segment, _)) = self.faults.first() {
            self.suspect = segment;
        }
        !self.faults.is_empty()
    }
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
    use super::*;

    #[test]
    fn runs_join_over_the_seam_of_closed_data_only() {
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], None), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(10)), [vec![4, 5], vec![9, 0, 1]]);
        // Another segment comes after the last one here.
        assert_eq!(consecutive(&[0, 1, 4, 5, 9], Some(11)), [vec![0, 1], vec![4, 5], vec![9]]);
        assert_eq!(consecutive(&[0, 1, 2], Some(3)), [vec![0, 1, 2]]);
    }
}
