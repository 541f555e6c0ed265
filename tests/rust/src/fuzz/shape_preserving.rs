// SPDX-License-Identifier: MIT OR Apache-2.0

//! Automatic tension, of every family and strategy.

use shapespline::{geometry::length, prelude::*};

use super::{
    Bytes,
    curves::{interpolates, questions},
    readable,
};

/// Every shape-preserving constructor. A fit that says it is solved has a clean report, and a check
/// from scratch agrees with it; one that is not solved says what fails. With default options a search
/// that doubles tension ends solved.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let Some(polygon) = bytes.polygon(20) else { return };
    let family = bytes.below(3);
    let strategies = Strategy::NAMED.map(|s| s.1);
    let strategy = strategies[bytes.below(strategies.len())];
    let doubling = matches!(strategy, Strategy::Growth | Strategy::Fairest);
    let (criteria, tolerances) = (bytes.criteria(), bytes.tolerances());
    let step = match bytes.below(4) {
        0 => bytes.unscaled(),
        1 => bytes.fraction(),
        _ => 0.5,
    };
    // Adding a step at a time may need thousands of rounds: cut short, it has to say so.
    let max_iterations = if doubling { None } else { Some(bytes.below(64)) };
    let options = SearchOptions { criteria, tolerances, strategy, step, max_iterations };
    let default =
        tolerances == Tolerances::default() && criteria == Criteria::OF_FITS && step == 0.5;
    let solvable = bytes.is_tame() && is_well_posed(&polygon);
    let must_solve = default && doubling && solvable;
    let continuity = if bytes.flag() { Continuity::C1 } else { Continuity::G1 };
    let safety = if bytes.below(4) == 0 { bytes.unscaled() } else { 0.9 };
    let mut judged = Judged { bytes: &mut bytes, polygon: &polygon, options: &options, must_solve };
    match family {
        0 => judged.judge(NuSpline::shape_preserving(polygon.clone(), &options), questions),
        1 => judged.judge(TensionSpline::shape_preserving(polygon.clone(), &options), questions),
        _ => {
            let kinds = [Directions::Balanced, Directions::Parametrization];
            let directions = kinds[usize::from(safety != 0.9)];
            let handles = HandleOptions { criteria, tolerances, safety, continuity, directions };
            judged.must_solve = default && safety == 0.9 && solvable;
            judged.judge(CatmullRom::shape_preserving(polygon.clone(), &handles), questions);
        }
    }
}

/// Whether a search with default options has to end solved.
pub(super) fn is_well_posed(polygon: &DataPolygon) -> bool {
    fits(polygon) && is_clear(polygon) && leans(polygon)
}

/// Whether velocities are numbers that leave room for squares, and given end tangents of a size that
/// tension (at most 1e60) can make up for: not those of another unit altogether, nor so short that with 15
/// digits the curve stops.
fn fits(polygon: &DataPolygon) -> bool {
    let velocity = |i: usize| length(polygon.chord(i)) / polygon.spacing(i);
    if !(0..polygon.segments()).all(|i| (1e-120..1e120).contains(&velocity(i))) {
        return false;
    }
    let last = polygon.segments() - 1;
    [0, last].iter().zip(polygon.tangents()).all(|(&i, tangent)| {
        let Some(tangent) = tangent else { return true };
        let longer = length(tangent) * polygon.spacing(i) / length(polygon.chord(i));
        (1e-12..1e20).contains(&longer)
    })
}

/// Whether all that turns and twists does so clearly: where a turn is a few times what counts as zero
/// (1e−9), margins drown in rounding, and a search may end, honestly, unsolved.
fn is_clear(polygon: &DataPolygon) -> bool {
    let d: Vec<DVec3> = (0..polygon.segments()).map(|i| polygon.direction(i)).collect();
    let clear = |sine: f64| !(1e-12..1e-5).contains(&sine.abs());
    let n = d.len();
    (0..n).all(|i| {
        let [a, b, c] = [d[i], d[(i + 1) % n], d[(i + 2) % n]];
        clear(a.cross(b).length()) && clear(a.cross(b).dot(c)) && clear(a.cross(b).dot(b.cross(c)))
    })
}

/// Whether tangents lean away from both chords by more than rounding. At a node a tangent is close to
/// `h_i v_{i−1} + h_{i−1} v_i` (of chord velocities `v`): where neighbouring spacings differ by a factor ρ,
/// and chords do not, it leans from one chord by `1/ρ²`. Under any tension: convexity and torsion then
/// hang on digits that legs do not have, and a search may end, honestly, unsolved.
fn leans(polygon: &DataPolygon) -> bool {
    let n = polygon.segments();
    let velocity = |i: usize| length(polygon.chord(i)) / polygon.spacing(i);
    let at = |i: usize| {
        let j = (i + 1) % n;
        let sine = polygon.direction(i).cross(polygon.direction(j)).length();
        let before = polygon.spacing(j) * velocity(i);
        let after = polygon.spacing(i) * velocity(j);
        // What counts as straight is not asked to lean.
        sine < 1e-12 || sine * before.min(after) > 1e-11 * (before + after)
    };
    let nodes = if polygon.is_closed() { n } else { n - 1 };
    (0..nodes).all(at)
}

pub(super) struct Judged<'a, 'b> {
    pub(super) bytes: &'a mut Bytes<'b>,
    pub(super) polygon: &'a DataPolygon,
    pub(super) options: &'a SearchOptions,
    pub(super) must_solve: bool,
}

impl Judged<'_, '_> {
    /// Judges a fit, and asks its curve some questions.
    pub(super) fn judge<C: Interpolant<Curve: Sized>>(
        &mut self,
        made: Result<Fit<C>, FitError>,
        ask: impl FnOnce(&dyn Curve, &mut Bytes<'_>),
    ) {
        let fit = match made {
            Ok(fit) => fit,
            Err(error) => return readable(&error),
        };
        let status = fit.outcome.diagnostics.status;
        // A search that is cut short does not accept what rounding hides, a report calls it ok.
        let proved = fit.report.ok() && fit.report.undecided.is_empty();
        if status == Status::Solved {
            assert!(fit.report.ok(), "{}", fit.report);
        } else {
            assert!(!proved, "{status:?}\n{}", fit.report);
        }
        assert_eq!(status == Status::Solved, fit.outcome.violations.is_empty());
        if self.must_solve {
            assert_eq!(status, Status::Solved, "{:?}\n{}", self.polygon, fit.report);
        }
        interpolates(&fit.curve, self.polygon);
        ask(fit.curve.curve(), self.bytes);
        let again = fit.curve.check(self.options.criteria, self.options.tolerances).unwrap();
        assert_eq!(again.counts, fit.report.counts, "{:?}", self.polygon);
        assert!(fit.curve.tension().iter().all(|&t| t >= 0.0 && t.is_finite()));
    }
}
