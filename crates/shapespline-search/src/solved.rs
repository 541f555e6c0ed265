// SPDX-License-Identifier: MIT OR Apache-2.0

//! A family whose tangents solve a system, kept solved while its tension changes.

use std::ops::Range;

use shapespline_banded::SolveError;
use shapespline_geometry::DVec3;

use crate::{TensionFamily, TensionSystem, solver_cache::SolverCache, system::legs_of};

/// A system with its solution, brought up to date where tension changes.
#[derive(Debug)]
pub struct SolvedFamily<S> {
    system: S,
    cache: Box<SolverCache>,
}

impl<S: TensionSystem> SolvedFamily<S> {
    /// Solves the system as it is. O(N).
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub fn new(system: S) -> Result<Self, SolveError> {
        let cache = SolverCache::begin(&system)?;
        Ok(Self { system, cache })
    }

    /// The system, with the tensions as they are.
    pub fn into_system(self) -> S {
        let Self { system, cache } = self;
        cache.end();
        system
    }

    /// Segments that end or begin at some of the nodes.
    fn touch(system: &S, nodes: Range<usize>, touched: &mut Vec<Range<usize>>) {
        let segments = system.polygon().segments();
        // Tangent i is an end of the segments i−1 and i.
        if nodes.start == 0 && system.polygon().is_closed() {
            touched.push(segments - 1..segments);
        }
        touched.push(nodes.start.saturating_sub(1)..nodes.end.min(segments));
    }
}

impl<S: TensionSystem> TensionFamily for SolvedFamily<S> {
    type Error = SolveError;

    const SIDES: usize = S::SIDES;

    fn tension(&self) -> &[f64] {
        self.system.tension()
    }

    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        let Self { system, cache } = self;
        let Some(unknowns) = cache.set(system, changes)? else {
            touched.push(0..system.polygon().segments());
            return Ok(());
        };
        for nodes in unknowns {
            Self::touch(system, nodes.clone(), touched);
        }
        if S::TENSION_SCALES_LEGS {
            for &(index, _) in changes {
                let node = index / S::SIDES;
                Self::touch(system, node..node + 1, touched);
            }
        }
        Ok(())
    }

    fn trial_legs(
        &mut self,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> bool {
        self.cache.trial_legs(&mut self.system, changes, segments, legs)
    }

    fn solve(&mut self) -> Result<(), SolveError> {
        self.cache.solve(&self.system)
    }

    fn is_fully_solved(&self) -> bool {
        self.cache.is_fully_solved()
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        legs_of(&self.system, self.cache.solution(), segment)
    }

    fn tension_unit(&self, node: usize) -> f64 {
        self.system.tension_unit(node)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_banded::{Row, Rows};
    use shapespline_geometry::{Boundary, DataPolygon, Parametrization};

    use super::*;
    use crate::solver_cache::{MAX_CACHED_ROWS, MAX_TRIAL_ROWS};

    /// Tension that changes the rows beside a node as well, and the legs.
    struct Planted {
        polygon: DataPolygon,
        tension: Vec<f64>,
    }

    impl Rows for Planted {
        fn count(&self) -> usize {
            self.polygon.nodes()
        }
        fn is_cyclic(&self) -> bool {
            self.polygon.is_closed()
        }
        fn row(&self, i: usize) -> Row {
            let n = self.count();
            let pull = |k: usize| self.tension[k % n] / (1.0 + self.tension[k % n]);
            let [first, last] = [i == 0, i + 1 == n].map(|end| end && !self.is_cyclic());
            let lower = if first { 0.0 } else { 0.5 - 0.2 * pull(i + n - 1) };
            let upper = if last { 0.0 } else { 0.5 - 0.2 * pull(i + 1) };
            let right = self.polygon.points()[i];
            Row { lower, diagonal: 2.0 + self.tension[i], upper, right }
        }
    }

    impl TensionSystem for Planted {
        const TENSION_SCALES_LEGS: bool = true;
        fn polygon(&self) -> &DataPolygon {
            &self.polygon
        }
        fn tension(&self) -> &[f64] {
            &self.tension
        }
        fn set_tension(&mut self, node: usize, tension: f64) {
            self.tension[node] = tension;
        }
        fn dependent_rows(&self, node: usize, rows: &mut Vec<usize>) {
            let n = self.count();
            let inside = |&row: &usize| self.is_cyclic() || row > 0 && row <= n;
            // Counted from one.
            rows.extend(
                [node, node + 1, node + 2]
                    .iter()
                    .filter(|row| inside(row))
                    .map(|i| (i + n - 1) % n),
            );
        }
        fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2] {
            tangents.map(|q| q / (1.0 + self.tension[segment]))
        }
    }

    fn family(n: usize, boundary: Boundary) -> SolvedFamily<Planted> {
        let at = |k: usize| {
            let t = k as f64 / n as f64 * std::f64::consts::TAU;
            DVec3::new(t.cos(), t.sin(), (3.0 * t).sin())
        };
        let mut points: Vec<DVec3> = (0..=n).map(at).collect();
        points[n] = if boundary == Boundary::Periodic { points[0] } else { DVec3::ONE };
        let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
        let tension = vec![0.0; polygon.nodes()];
        SolvedFamily::new(Planted { polygon, tension }).unwrap()
    }

    /// Whatever was looked at before, and wherever.
    #[test]
    fn looks_see_what_setting_does_and_change_nothing() {
        for (n, boundary) in [
            (60, Boundary::ZeroCurvature),
            (500, Boundary::Periodic),
            (MAX_CACHED_ROWS + 900, Boundary::ZeroCurvature),
        ] {
            let (mut family, mut legs) = (family(n, boundary), Vec::new());
            // Neighbours of the seam are no few rows.
            let (first, last) = if boundary == Boundary::Periodic { (1, n - 2) } else { (0, n) };
            let looks = [
                (first..first + 3, 1.0),
                (20..24, 3.0),
                (21..23, 0.5),
                (20..24, 0.0),
                (22..30, 9.0),
                (last - 3..last, 2.0),
                (40..41, 1e9),
                (n / 2..n / 2 + 5, 0.25),
            ];
            for (k, (nodes, tension)) in looks.into_iter().enumerate() {
                let changes: Vec<_> = nodes.clone().map(|i| (i, tension)).collect();
                let around = nodes.start.saturating_sub(2).max(first)..(nodes.end + 2).min(last);
                let before: Vec<_> = (0..n).map(|i| family.end_legs(i)).collect();
                let tensions = family.tension().to_vec();
                assert!(family.trial_legs(&changes, around.clone(), &mut legs));
                assert!((0..n).all(|i| family.end_legs(i) == before[i]));
                assert_eq!(family.tension(), tensions);
                let seen = legs.clone();
                let back: Vec<_> = nodes.clone().map(|i| (i, tensions[i])).collect();
                family.set_tension(&changes, &mut Vec::new()).unwrap();
                for (i, seen) in around.zip(seen) {
                    let set = family.end_legs(i);
                    let error = (0..2).map(|k| (seen[k] - set[k]).length()).fold(0.0, f64::max);
                    assert!(error < 1e-14, "{n}, {nodes:?}, segment {i}: {error:e}");
                }
                // Every second time it stays.
                if k % 2 == 0 {
                    family.set_tension(&back, &mut Vec::new()).unwrap();
                }
            }
        }
    }

    /// To the bit, and every segment is to be checked.
    #[test]
    fn of_few_rows_all_are_solved() {
        for boundary in [Boundary::ZeroCurvature, Boundary::Periodic] {
            let (mut family, n) = (family(MAX_TRIAL_ROWS - 1, boundary), MAX_TRIAL_ROWS - 1);
            assert!(family.is_fully_solved());
            for (changes, again) in
                [(vec![(3, 2.0), (9, 0.5)], false), (vec![(3, 7.0)], true), (vec![(9, 0.0)], false)]
            {
                let mut touched = Vec::new();
                family.set_tension(&changes, &mut touched).unwrap();
                assert!(family.is_fully_solved());
                assert_eq!(touched.as_slice(), std::slice::from_ref(&(0..n)));
                let set: Vec<_> = (0..n).map(|i| family.end_legs(i)).collect();
                if again {
                    family.solve().unwrap();
                    assert!(family.is_fully_solved());
                }
                let Planted { polygon, tension } = &family.system;
                let fresh = Planted { polygon: polygon.clone(), tension: tension.clone() };
                let fresh = SolvedFamily::new(fresh).unwrap();
                assert!(
                    (0..n).all(|i| set[i] == fresh.end_legs(i) && set[i] == family.end_legs(i))
                );
            }
        }
        // Of many, those that a change is felt by.
        let (mut family, mut touched) = (family(500, Boundary::ZeroCurvature), Vec::new());
        family.set_tension(&[(250, 2.0)], &mut touched).unwrap();
        assert!(!family.is_fully_solved());
        assert!(touched.iter().all(|range| 150 < range.start && range.end < 350));
    }

    #[test]
    fn looks_at_much_at_once_are_refused() {
        let (mut family, mut legs) = (family(500, Boundary::Periodic), vec![[DVec3::ONE; 2]]);
        for nodes in [vec![3, 3 + MAX_TRIAL_ROWS], vec![0], vec![499], vec![]] {
            let changes: Vec<_> = nodes.into_iter().map(|i| (i, 1.0)).collect();
            assert!(!family.trial_legs(&changes, 10..12, &mut legs));
            assert!(legs.is_empty() && family.tension().iter().all(|&t| t == 0.0));
        }
    }
}
