// SPDX-License-Identifier: MIT OR Apache-2.0

//! Collinear runs that the curve goes through exactly straight.
//!
//! At every node of a run both derivatives lie along it, so its control points lie on the line. Where the
//! run ends in a turn the curvature is zero and the tangent still lies along the run: `ω` vanishes there,
//! and with it the torsion of the first piece beyond, by construction.

use glam::DVec3;
use shapespline_criteria::Checker;
use shapespline_geometry::{DataPolygon, InputError, normalize};

/// Where a curve is exactly straight.
#[derive(Debug, Clone, Default)]
pub(crate) struct Runs {
    /// The direction of the line through each node that lies on one; empty where nothing is straight.
    lines: Vec<Option<DVec3>>,
    /// The segments, ascending.
    pub(crate) segments: Vec<usize>,
}

impl Runs {
    /// The runs of a polygon: segments beside nodes at which it goes straight on, but for corners.
    ///
    /// # Errors
    /// A turn in which two runs meet, or which a given end tangent makes at the end of one.
    pub(crate) fn of(checker: &Checker<'_>, corners: &[usize]) -> Result<Self, InputError> {
        let polygon = checker.polygon();
        let (n, nodes) = (polygon.segments(), polygon.nodes());
        let is_open = |node: usize| corners.contains(&node) || polygon.is_natural_end(node);
        let straight: Vec<bool> =
            (0..nodes).map(|k| !is_open(k) && checker.goes_straight_on(k)).collect();
        let is_run = |i: usize| straight[i] || straight[(i + 1) % nodes];
        let mut lines = vec![None; nodes];
        for node in 0..nodes {
            let [u, v] = polygon.directions_at(node);
            let beside = beside(polygon, node).map(|side| side.filter(|&i| is_run(i)));
            lines[node] = match beside {
                _ if straight[node] => Some(normalize(u + v)),
                [None, None] => None,
                _ if corners.contains(&node) => None,
                [Some(_), Some(_)] => return Err(turn_between_runs(node, u.cross(v).length())),
                [Some(i), None] | [None, Some(i)] => {
                    if !is_open(node) && (node == 0 || node == n) && !polygon.is_closed() {
                        return Err(tangent_off_run(node, u.cross(v).length()));
                    }
                    Some(polygon.direction(i))
                }
            };
        }
        Ok(Self { lines, segments: (0..n).filter(|&i| is_run(i)).collect() })
    }

    /// The direction of the line through a node, if it lies on one.
    pub(crate) fn line(&self, node: usize) -> Option<DVec3> {
        self.lines.get(node).copied().flatten()
    }
}

/// The segments before and after a node.
fn beside(polygon: &DataPolygon, node: usize) -> [Option<usize>; 2] {
    let n = polygon.segments();
    if polygon.is_closed() {
        [Some((node + n - 1) % n), Some(node)]
    } else {
        [node.checked_sub(1), (node < n).then_some(node)]
    }
}

fn turn_between_runs(index: usize, value: f64) -> InputError {
    let allowed = "among the corners with straight=True, since two straight runs meet there (the sine of \
                   the turn 0)";
    InputError::OutOfRange { argument: "points", index, value, allowed }
}

fn tangent_off_run(node: usize, value: f64) -> InputError {
    let argument = if node == 0 { "boundary.start" } else { "boundary.end" };
    let allowed = "along the run that begins there with straight=True (the sine between them 0)";
    InputError::Scalar { argument, value, allowed }
}
