//! Counts, limits and cancellation of a search.

use std::ops::ControlFlow;

use crate::{Phase, Step};

/// What all phases of a search share.
pub(crate) struct Control<'m> {
    monitor: &'m mut dyn FnMut(&Step) -> ControlFlow<()>,
    /// Newton steps that are left.
    left: usize,
    interrupted: bool,
    pub(crate) iterations: usize,
    pub(crate) solves: usize,
    pub(crate) history: Vec<Step>,
}

impl<'m> Control<'m> {
    pub(crate) fn new(
        limit: Option<usize>,
        monitor: &'m mut dyn FnMut(&Step) -> ControlFlow<()>,
    ) -> Self {
        let left = limit.unwrap_or(usize::MAX);
        Self { monitor, left, interrupted: false, iterations: 0, solves: 0, history: Vec::new() }
    }

    /// Begins a phase.
    pub(crate) fn begin(&mut self, phase: Phase, failing: usize) {
        self.history.push(Step { phase, failing, iterations: 0 });
    }

    /// Whether one more Newton step may be taken. Reports the phase as it stands.
    pub(crate) fn next_step(&mut self) -> bool {
        if self.is_over() {
            return false;
        }
        if let Some(step) = self.history.last_mut() {
            step.iterations += 1;
            self.interrupted = (self.monitor)(step).is_break();
        }
        if self.interrupted {
            return false;
        }
        self.left -= 1;
        self.iterations += 1;
        true
    }

    /// Whether no further step may be taken.
    pub(crate) fn is_over(&self) -> bool {
        self.interrupted || self.left == 0
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupted
    }
}
