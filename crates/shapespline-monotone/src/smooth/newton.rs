// SPDX-License-Identifier: MIT OR Apache-2.0

//! The state of Newton's method.

use super::interior::Task;
use super::interval::Model;
use super::system::Layout;

/// Newton's method at a point, with room for its arrays.
pub(super) struct Newton<'a> {
    pub(super) task: &'a Task,
    pub(super) lambda: f64,
    pub(super) layout: Layout,
    pub(super) held: Vec<bool>,
    /// Products that sizes keep with their multipliers; 0 where they are held or free.
    pub(super) centred: Vec<f64>,
    pub(super) models: Vec<Model>,
    pub(super) f: Vec<f64>,
    pub(super) pull: Vec<f64>,
    /// Models and values before a step.
    pub(super) before: (Vec<Model>, Vec<f64>),
    pub(super) trial: Vec<f64>,
}

impl<'a> Newton<'a> {
    pub(super) fn new(task: &'a Task, lambda: f64) -> Self {
        let layout = task.layout();
        let (held, centred) = (vec![false; layout.len()], vec![0.0; layout.len()]);
        let (models, f, pull, trial) = (vec![], vec![], vec![], vec![]);
        let before = (vec![], vec![]);
        Self { task, lambda, layout, held, centred, models, f, pull, before, trial }
    }
}
