//! ν-splines as a family of the tension search.

use std::ops::Range;

use shapespline_banded::{Resolvable, SolveError};
use shapespline_geometry::{DVec3, DataPolygon};
use shapespline_search::TensionFamily;

use crate::system::NuSystem;

/// The ν-splines of one polygon, with the tangents of the present tension.
#[derive(Debug)]
pub(crate) struct NuFamily<'a> {
    system: NuSystem<'a>,
    solver: Resolvable,
    /// Scratch: the rows an update changes, and the unknowns it touches.
    rows: Vec<usize>,
    unknowns: Vec<Range<usize>>,
}

impl<'a> NuFamily<'a> {
    pub(crate) fn new(polygon: &'a DataPolygon, tension: Vec<f64>) -> Result<Self, SolveError> {
        let system = NuSystem { polygon, tension };
        let solver = Resolvable::new(&system)?;
        Ok(Self { system, solver, rows: Vec::new(), unknowns: Vec::new() })
    }

    /// End legs of every segment, and the tension.
    pub(crate) fn finish(self) -> (Vec<[DVec3; 2]>, Vec<f64>) {
        let legs = (0..self.system.polygon.segments()).map(|i| self.end_legs(i)).collect();
        (legs, self.system.tension)
    }
}

impl TensionFamily for NuFamily<'_> {
    type Error = SolveError;

    fn tension(&self) -> &[f64] {
        &self.system.tension
    }

    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        self.rows.clear();
        for &(node, tension) in changes {
            self.system.tension[node] = tension;
            self.rows.push(node);
        }
        self.unknowns.clear();
        self.solver.update(&self.system, &self.rows, &mut self.unknowns)?;
        let segments = self.system.polygon.segments();
        for nodes in &self.unknowns {
            // Tangent i is an end of the segments i−1 and i.
            if nodes.start == 0 && self.system.polygon.is_closed() {
                touched.push(segments - 1..segments);
            }
            touched.push(nodes.start.saturating_sub(1)..nodes.end.min(segments));
        }
        Ok(())
    }

    fn solve_again(&mut self) -> Result<(), SolveError> {
        self.solver.solve_again(&self.system)
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        let tangents = self.solver.solution();
        let next = if segment + 1 == tangents.len() && self.system.polygon.is_closed() {
            0
        } else {
            segment + 1
        };
        let third = self.system.polygon.spacing(segment) / 3.0;
        [tangents[segment] * third, tangents[next] * third]
    }
}
