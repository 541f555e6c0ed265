// SPDX-License-Identifier: MIT OR Apache-2.0

//! The memory of Newton's steps.

use shapespline_banded::{Block, BlockCholesky};

use crate::{
    element::Node,
    legs::{ElementGradient, ElementHessian},
    shape::Gradient,
};

/// Memory of Newton's steps.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) gradients: Vec<ElementGradient>,
    pub(crate) hessians: Vec<ElementHessian>,
    pub(crate) diagonal: Vec<Block<6>>,
    pub(crate) coupling: Vec<Block<6>>,
    pub(crate) right: Vec<[f64; 6]>,
    pub(crate) factors: BlockCholesky<6>,
    pub(crate) direction: Vec<Node>,
    /// What each segment's Hessian is multiplied by, less one.
    pub(crate) damping: Vec<f64>,
    /// Whether a segment was damped in this step.
    pub(crate) flagged: Vec<bool>,
    pub(crate) values: Vec<f64>,
    pub(crate) trial: Vec<f64>,
    /// Values of all conditions, and after a step.
    pub(crate) margins: Vec<f64>,
    pub(crate) trial_margins: Vec<f64>,
    /// What the step knew of each condition.
    pub(crate) terms: Vec<Term>,
    pub(crate) before: Vec<Node>,
}

/// What a step knows of a condition: its gradient, the primal multiplier and the weight of the gradient's square.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    pub(crate) gradient: Gradient,
    pub(crate) primal: f64,
    pub(crate) stiffness: f64,
}
