//! Families whose tangents solve a tridiagonal system.

use std::ops::Range;

use rayon::prelude::*;
use shapespline_banded::{Resolvable, Row, Rows, SolveError, solve_once};
use shapespline_geometry::{DVec3, DataPolygon};

use crate::TensionFamily;

/// How tension makes tangents: a strictly diagonally dominant system whose coefficients depend on it.
///
/// This is all that a family with a global system has to say; [`SolvedFamily`] makes a
/// [`TensionFamily`] of it.
pub trait TensionSystem: Rows + Sync {
    /// Whether tension changes the legs beside a node even where the tangents stay as they are.
    const SCALES_LEGS: bool;

    /// The polygon.
    fn polygon(&self) -> &DataPolygon;

    /// The tension at each distinct node.
    fn tension(&self) -> &[f64];

    /// Sets the tension at a node and appends the rows that change with it to `rows`, in any order.
    fn set_tension(&mut self, node: usize, tension: f64, rows: &mut Vec<usize>);

    /// First and last leg of a segment, from the unknowns at its two ends.
    fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2];

    /// As [`TensionFamily::weight`].
    fn weight(&self, _node: usize) -> f64 {
        1.0
    }
}

/// The end legs of every segment, of a system whose tension stays as it is. O(N).
///
/// # Errors
/// A system that f64 cannot hold.
pub fn solve_legs<S: TensionSystem>(system: &S) -> Result<Vec<[DVec3; 2]>, SolveError> {
    let tangents = solve_once(system)?;
    Ok(collect(system.polygon().segments(), |i| legs_of(system, &tangents, i)))
}

/// `make(0), …, make(count − 1)`, on all threads where there are many.
fn collect<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    const MANY: usize = 16_384;
    if count < 2 * MANY {
        (0..count).map(make).collect()
    } else {
        (0..count).into_par_iter().with_min_len(MANY).map(make).collect()
    }
}

#[inline]
fn legs_of<S: TensionSystem>(system: &S, tangents: &[DVec3], segment: usize) -> [DVec3; 2] {
    // Of closed data the last point is the first.
    let wraps = segment + 1 == tangents.len() && system.polygon().is_closed();
    let next = if wraps { 0 } else { segment + 1 };
    system.legs(segment, [tangents[segment], tangents[next]])
}

/// Rows that are kept: those of short curves, whose search comes back to them again and again.
const KEPT: usize = 2048;

/// A system whose first rows are kept as they were made.
struct Kept<'s, S> {
    system: &'s S,
    rows: &'s [Row],
}

impl<S: Rows> Rows for Kept<'_, S> {
    fn count(&self) -> usize {
        self.system.count()
    }

    fn is_cyclic(&self) -> bool {
        self.system.is_cyclic()
    }

    #[inline]
    fn row(&self, i: usize) -> Row {
        match self.rows.get(i) {
            Some(row) => *row,
            None => self.system.row(i),
        }
    }
}

/// A system with its solution, brought up to date where tension changes.
#[derive(Debug)]
pub struct SolvedFamily<S> {
    system: S,
    /// Made when tension first changes: most curves need none.
    kept: Vec<Row>,
    solver: Resolvable,
    /// Scratch: the rows an update changes, and the unknowns it touches.
    rows: Vec<usize>,
    unknowns: Vec<Range<usize>>,
}

impl<S: TensionSystem> SolvedFamily<S> {
    /// Solves the system as it is. O(N).
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub fn new(system: S) -> Result<Self, SolveError> {
        let solver = Resolvable::new(&system)?;
        Ok(Self { system, kept: Vec::new(), solver, rows: Vec::new(), unknowns: Vec::new() })
    }

    /// End legs of every segment, and the system.
    pub fn finish(self) -> (Vec<[DVec3; 2]>, S) {
        let segments = self.system.polygon().segments();
        (collect(segments, |i| self.end_legs(i)), self.system)
    }

    /// Segments that end or begin at some of the nodes.
    fn touch(&self, nodes: Range<usize>, touched: &mut Vec<Range<usize>>) {
        let segments = self.system.polygon().segments();
        // Tangent i is an end of the segments i−1 and i.
        if nodes.start == 0 && self.system.polygon().is_closed() {
            touched.push(segments - 1..segments);
        }
        touched.push(nodes.start.saturating_sub(1)..nodes.end.min(segments));
    }
}

impl<S: TensionSystem> TensionFamily for SolvedFamily<S> {
    type Error = SolveError;

    fn tension(&self) -> &[f64] {
        self.system.tension()
    }

    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        self.rows.clear();
        for &(node, tension) in changes {
            self.system.set_tension(node, tension, &mut self.rows);
            if S::SCALES_LEGS {
                self.touch(node..node + 1, touched);
            }
        }
        self.rows.sort_unstable();
        self.rows.dedup();
        if self.kept.is_empty() {
            let kept = 0..self.system.count().min(KEPT);
            self.kept.extend(kept.map(|i| self.system.row(i)));
        }
        for &i in &self.rows {
            if let Some(row) = self.kept.get_mut(i) {
                *row = self.system.row(i);
            }
        }
        self.unknowns.clear();
        let system = Kept { system: &self.system, rows: &self.kept };
        self.solver.update(&system, &self.rows, &mut self.unknowns)?;
        for nodes in &self.unknowns {
            self.touch(nodes.clone(), touched);
        }
        Ok(())
    }

    fn solve_again(&mut self) -> Result<(), SolveError> {
        self.solver.solve_again(&self.system)
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        legs_of(&self.system, self.solver.solution(), segment)
    }

    fn weight(&self, node: usize) -> f64 {
        self.system.weight(node)
    }
}
