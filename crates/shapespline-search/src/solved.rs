//! A family whose tangents solve a system, kept solved while its tension changes.

use std::{cell::Cell, convert::Infallible, ops::Range};

use shapespline_banded::{Place, Resolvable, Row, Rows, SolveError};
use shapespline_geometry::DVec3;

use crate::{TensionFamily, TensionSystem, system::legs_of};

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

    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        mut take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let kept = rows.start.min(self.rows.len())..rows.end.min(self.rows.len());
        kept.clone().zip(&self.rows[kept.clone()]).try_for_each(|(i, row)| take(i, *row))?;
        (kept.end.max(rows.start)..rows.end).try_for_each(|i| take(i, self.row(i)))
    }
}

/// Rows from which on looking at other tension costs what setting it does. Where a system has no more, a
/// change is felt by nearly all: all are solved.
const FEW: usize = 96;

/// A system with its solution, brought up to date where tension changes.
#[derive(Debug)]
pub struct SolvedFamily<S> {
    system: S,
    work: Box<Work>,
}

/// What solving and looking take; all but the solution is scratch.
#[derive(Debug, Default)]
struct Work {
    solver: Resolvable,
    /// Made when tension first changes: most curves need none.
    kept: Vec<Row>,
    /// The nodes at which tension was changed last, the rows that this changes, and the unknowns.
    nodes: Vec<usize>,
    rows: Vec<usize>,
    unknowns: Vec<Range<usize>>,
    /// Where looks are taken, and whether the system is still the one that the place was made of.
    place: Place,
    place_is_valid: bool,
    /// Rows of the place that are those of the last look.
    looked: Vec<usize>,
    /// The tensions as they are.
    present: Vec<(usize, f64)>,
    /// Whether the solution is that of a solve of all rows, and not brought up to date.
    all_is_solved: bool,
}

thread_local! {
    /// For the next curve of this thread: short curves come in thousands, and memory for one costs a tenth
    /// of its search.
    static SPARE: Cell<Option<Box<Work>>> = const { Cell::new(None) };
}

impl<S: TensionSystem> SolvedFamily<S> {
    /// Solves the system as it is. O(N).
    ///
    /// # Errors
    /// A system that f64 cannot hold.
    pub fn new(system: S) -> Result<Self, SolveError> {
        let mut work = Work::spare();
        work.solver.solve(&system)?;
        Ok(Self { system, work })
    }

    /// The system, with the tensions as they are.
    pub fn into_system(self) -> S {
        let Self { system, work } = self;
        work.give_back();
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

    fn tension(&self) -> &[f64] {
        self.system.tension()
    }

    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), SolveError> {
        let Self { system, work } = self;
        work.keep_rows(system);
        work.place_is_valid = false;
        work.change(system, changes);
        for &i in &work.rows {
            if let Some(row) = work.kept.get_mut(i) {
                system.renew(i, row);
            }
        }
        let kept = Kept { system: &*system, rows: &work.kept };
        work.all_is_solved = kept.count() <= FEW;
        if work.all_is_solved {
            work.solver.solve_again(&kept)?;
            touched.push(0..system.polygon().segments());
            return Ok(());
        }
        work.unknowns.clear();
        work.solver.update(&kept, &work.rows, &mut work.unknowns)?;
        for nodes in &work.unknowns {
            Self::touch(system, nodes.clone(), touched);
        }
        if S::SCALES_LEGS {
            for &(node, _) in changes {
                Self::touch(system, node..node + 1, touched);
            }
        }
        Ok(())
    }

    fn legs_under(
        &mut self,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> bool {
        legs.clear();
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else { return false };
        if last.0 - first.0 >= FEW {
            return false;
        }
        let Self { system, work } = self;
        work.keep_rows(system);
        let present = changes.iter().map(|&(node, _)| (node, system.tension()[node]));
        work.present.clear();
        work.present.extend(present);
        work.change(system, changes);
        // What cannot be solved is no answer: to set the tension will say why.
        let looked = work.look(system, changes, segments, legs).unwrap_or(false);
        work.restore(system);
        looked
    }

    fn solve_again(&mut self) -> Result<(), SolveError> {
        self.work.place_is_valid = false;
        self.work.all_is_solved = true;
        self.work.solver.solve_again(&self.system)
    }

    fn all_is_solved(&self) -> bool {
        self.work.all_is_solved
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        legs_of(&self.system, self.work.solver.solution(), segment)
    }

    fn weight(&self, node: usize) -> f64 {
        self.system.weight(node)
    }
}

impl Work {
    fn spare() -> Box<Self> {
        let mut work = SPARE.try_with(Cell::take).ok().flatten().unwrap_or_default();
        work.kept.clear();
        work.nodes.clear();
        work.rows.clear();
        work.place_is_valid = false;
        work
    }

    fn give_back(self: Box<Self>) {
        if self.solver.solution().len() <= KEPT {
            // A thread that ends keeps nothing.
            let _ = SPARE.try_with(|spare| spare.set(Some(self)));
        }
    }

    fn keep_rows<S: TensionSystem>(&mut self, system: &S) {
        if self.kept.is_empty() {
            let few = 0..system.count().min(KEPT);
            let Ok(()) = system.try_each(few, |_, row| {
                self.kept.push(row);
                Ok::<(), Infallible>(())
            });
        }
    }

    /// Sets tensions in the system, and finds the rows that change: mostly those of the last time.
    fn change<S: TensionSystem>(&mut self, system: &mut S, changes: &[(usize, f64)]) {
        changes.iter().for_each(|&(node, tension)| system.set_tension(node, tension));
        let nodes = || changes.iter().map(|change| change.0);
        if self.nodes.iter().copied().eq(nodes()) {
            return;
        }
        self.nodes.clear();
        self.nodes.extend(nodes());
        self.rows.clear();
        nodes().for_each(|node| system.rows_of(node, &mut self.rows));
        if !self.rows.is_sorted_by(|a, b| a < b) {
            self.rows.sort_unstable();
            self.rows.dedup();
        }
    }

    /// Sets the tensions again that were there before.
    fn restore<S: TensionSystem>(&self, system: &mut S) {
        for &(node, tension) in &self.present {
            system.set_tension(node, tension);
        }
    }

    /// The legs of some segments under the changes, which have been made in the system alone. False where
    /// that takes more than a few rows.
    fn look<S: TensionSystem>(
        &mut self,
        system: &mut S,
        changes: &[(usize, f64)],
        segments: Range<usize>,
        legs: &mut Vec<[DVec3; 2]>,
    ) -> Result<bool, SolveError> {
        let (Some(&first), Some(&last)) = (self.rows.first(), self.rows.last()) else {
            return Ok(false);
        };
        // The last segment of closed data ends where the first begins, in no few rows.
        let rows = first.min(segments.start)..(last + 1).max(segments.end + 1);
        if rows.len() > FEW || rows.end > system.count() {
            return Ok(false);
        }
        let place = self.place.rows();
        if !(self.place_is_valid && place.start <= rows.start && rows.end <= place.end) {
            self.restore(system);
            let kept = Kept { system: &*system, rows: &self.kept };
            self.place_is_valid = self.place.go(&self.solver, &kept, rows)?;
            self.looked.clear();
            self.change(system, changes);
        }
        if !self.place_is_valid {
            return Ok(false);
        }
        if self.looked != self.rows {
            let kept = Kept { system: &*system, rows: &self.kept };
            self.looked.iter().for_each(|&i| *self.place.row_mut(i) = kept.row(i));
            self.looked.clone_from(&self.rows);
        }
        self.rows.iter().for_each(|&i| system.renew(i, self.place.row_mut(i)));
        let skipped = segments.start - self.place.rows().start;
        let tangents = self.place.solve()?[skipped..].windows(2);
        legs.extend(segments.zip(tangents).map(|(i, ends)| system.legs(i, [ends[0], ends[1]])));
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, DataPolygon, Parametrization};

    use super::*;

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
        const SCALES_LEGS: bool = true;
        fn polygon(&self) -> &DataPolygon {
            &self.polygon
        }
        fn tension(&self) -> &[f64] {
            &self.tension
        }
        fn set_tension(&mut self, node: usize, tension: f64) {
            self.tension[node] = tension;
        }
        fn rows_of(&self, node: usize, rows: &mut Vec<usize>) {
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
            (KEPT + 900, Boundary::ZeroCurvature),
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
                assert!(family.legs_under(&changes, around.clone(), &mut legs));
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
            let (mut family, n) = (family(FEW - 1, boundary), FEW - 1);
            assert!(!family.all_is_solved());
            for (changes, again) in
                [(vec![(3, 2.0), (9, 0.5)], false), (vec![(3, 7.0)], true), (vec![(9, 0.0)], false)]
            {
                let mut touched = Vec::new();
                family.set_tension(&changes, &mut touched).unwrap();
                assert!(family.all_is_solved());
                assert_eq!(touched.as_slice(), std::slice::from_ref(&(0..n)));
                let set: Vec<_> = (0..n).map(|i| family.end_legs(i)).collect();
                if again {
                    family.solve_again().unwrap();
                    assert!(family.all_is_solved());
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
        assert!(!family.all_is_solved());
        assert!(touched.iter().all(|range| 150 < range.start && range.end < 350));
    }

    #[test]
    fn looks_at_much_at_once_are_refused() {
        let (mut family, mut legs) = (family(500, Boundary::Periodic), vec![[DVec3::ONE; 2]]);
        for nodes in [vec![3, 3 + FEW], vec![0], vec![499], vec![]] {
            let changes: Vec<_> = nodes.into_iter().map(|i| (i, 1.0)).collect();
            assert!(!family.legs_under(&changes, 10..12, &mut legs));
            assert!(legs.is_empty() && family.tension().iter().all(|&t| t == 0.0));
        }
    }
}
