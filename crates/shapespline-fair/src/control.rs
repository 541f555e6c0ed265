// SPDX-License-Identifier: MIT OR Apache-2.0

//! Counts, limits and cancellation of a search.

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

use crate::{Phase, Step};

/// The caller, who sees each step from any thread and may end the search.
pub(crate) struct Watch<'m> {
    monitor: &'m (dyn Fn(&Step) -> ControlFlow<()> + Sync),
    interrupted: AtomicBool,
}

impl<'m> Watch<'m> {
    pub(crate) fn new(monitor: &'m (dyn Fn(&Step) -> ControlFlow<()> + Sync)) -> Self {
        Self { monitor, interrupted: AtomicBool::new(false) }
    }

    fn goes_on(&self, step: &Step) -> bool {
        if (self.monitor)(step).is_break() {
            self.interrupted.store(true, Ordering::Relaxed);
        }
        !self.is_interrupted()
    }

    fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}

/// What all phases of a search share.
pub(crate) struct Control<'m> {
    watch: &'m Watch<'m>,
    /// Newton steps that are left, where they are limited.
    left: Option<usize>,
    pub(crate) iterations: usize,
    pub(crate) solves: usize,
    pub(crate) history: Vec<Step>,
}

impl<'m> Control<'m> {
    pub(crate) fn new(limit: Option<usize>, watch: &'m Watch<'m>) -> Self {
        Self { watch, left: limit, iterations: 0, solves: 0, history: Vec::new() }
    }

    /// Whether the number of steps is limited: then it matters in which order they are taken.
    pub(crate) fn is_limited(&self) -> bool {
        self.left.is_some()
    }

    /// For a part of the search that runs beside others: nothing but the caller can end it, and what it did is
    /// [added](Self::add) afterwards.
    pub(crate) fn beside(&self) -> Self {
        Self::new(None, self.watch)
    }

    /// Adds what a part of the search did.
    pub(crate) fn add(&mut self, part: Self) {
        self.iterations += part.iterations;
        self.solves += part.solves;
        self.history.extend(part.history);
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
            if !self.watch.goes_on(step) {
                return false;
            }
        }
        self.left = self.left.map(|left| left - 1);
        self.iterations += 1;
        true
    }

    /// Whether no further step may be taken.
    pub(crate) fn is_over(&self) -> bool {
        self.is_interrupted() || self.left == Some(0)
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.watch.is_interrupted()
    }
}
