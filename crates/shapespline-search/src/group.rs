//! Tensions lowered by a common factor, found by bisection, and what that does to the bending.

use std::collections::HashMap;

use shapespline_geometry::{CubicSegment, DVec3, DataPolygon};

use crate::{TensionFamily, state::State};

/// How exactly the least factor of a tension is found, and the part of itself that is then added, so that
/// changes far away, which are felt little, do not bring criteria to the brink.
pub(crate) const RESOLUTION: f64 = 0.01;

/// Segments on each side of a node that tell how far its tension can be lowered. A segment beyond that it
/// would break feels it so little that rounding would decide how far it goes: it goes half as far then.
const REACH: usize = 6;

/// Segments on each side of a node whose bending is compared before and after its tension is lowered.
const BENDING_REACH: usize = 4;

/// To what halves of a segment agree with the whole in that comparison; their sum is far more accurate.
const BENDING_ACCURACY: f64 = 1e-2;

/// Tensions that are lowered together, by one factor: mostly a single one.
pub(crate) struct Group {
    /// The tensions, ascending by index, as they began.
    full: Vec<(usize, f64)>,
    /// Scratch: the same times a factor.
    scaled: Vec<(usize, f64)>,
}

impl Group {
    /// Some tensions, as they are.
    pub(crate) fn of(indices: &[usize], tension: &[f64]) -> Self {
        let mut full: Vec<_> = indices.iter().map(|&k| (k, tension[k])).collect();
        full.sort_unstable_by_key(|(k, _)| *k);
        Self { scaled: Vec::with_capacity(full.len()), full }
    }

    /// The changes that bring the tensions to a factor of what they were.
    pub(crate) fn at(&mut self, factor: f64) -> &[(usize, f64)] {
        self.scaled.clear();
        self.scaled.extend(self.full.iter().map(|&(k, tension)| (k, tension * factor)));
        &self.scaled
    }

    /// Lowers the tensions as far as that keeps the shape, by bisection of the factor, and a little less.
    /// Returns the factor.
    ///
    /// Trials of the segments around them tell of nearly every factor whether it breaks a criterion, at
    /// a fraction of what it costs to set the tensions. What they find is set and checked as a whole.
    pub(crate) fn lower<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
    ) -> Result<f64, F::Error> {
        state.relaxations += 1;
        let near = {
            let nodes = self.full.iter().map(|(k, _)| k / F::SIDES);
            segments_around(state.windows.polygon(), nodes, REACH)
        };
        let [mut breaks, mut trial] = self.by_trials(state);
        // How often only segments far away broke: half way back is tried once.
        let mut far = 0;
        let (mut keeps, mut set) = (1.0, 1.0);
        while trial < keeps && !state.stopped {
            set = trial;
            if state.try_tension(self.at(trial))? {
                keeps = trial;
            } else {
                breaks = trial;
                far += usize::from(!state.has_faults_among(&near));
            }
            let ends = far == 1 && keeps == trial || far == 2;
            if ends || keeps - breaks <= RESOLUTION * keeps {
                break;
            }
            trial = 0.5 * (breaks + keeps);
            // Neighbouring numbers have none between them.
            if trial <= breaks {
                break;
            }
        }
        let spared = keeps * (1.0 + RESOLUTION);
        if 0.0 < keeps && spared < 1.0 {
            set = spared;
            if state.try_tension(self.at(spared))? {
                keeps = spared;
            }
        }
        if set != keeps {
            state.return_to(self.at(keeps))?;
        }
        Ok(keeps)
    }

    /// The largest factor that is known to break a criterion, and the least that seems to keep all of
    /// them, as far as segments around tell.
    fn by_trials<F: TensionFamily>(&mut self, state: &mut State<'_, F>) -> [f64; 2] {
        if state.seems_to_break(self.at(0.0)) != Some(true) {
            return [0.0, 0.0];
        }
        let (mut breaks, mut seems) = (0.0, 1.0);
        while seems - breaks > RESOLUTION * seems {
            let trial = 0.5 * (breaks + seems);
            if trial <= breaks || trial >= seems {
                break;
            }
            match state.seems_to_break(self.at(trial)) {
                Some(true) => breaks = trial,
                Some(false) => seems = trial,
                None => break,
            }
        }
        [breaks, seems]
    }
}

/// The segments within reach of some nodes, ascending.
fn segments_around(
    polygon: &DataPolygon,
    nodes: impl Iterator<Item = usize>,
    reach: usize,
) -> Vec<usize> {
    let n = polygon.segments();
    let around = |node: usize| {
        let (first, last) = (n + node - reach.min(n), n + node + reach.min(n));
        if polygon.is_closed() { first..last } else { first.max(n)..last.min(2 * n) }
    };
    let mut segments: Vec<usize> = nodes.flat_map(around).map(|i| i % n).collect();
    segments.sort_unstable();
    segments.dedup();
    segments
}

/// The segments that feel the tensions at some nodes most, ascending.
pub(crate) fn bent_by(polygon: &DataPolygon, nodes: impl Iterator<Item = usize>) -> Vec<usize> {
    segments_around(polygon, nodes, BENDING_REACH)
}

/// `∫κ² ds` of segments, with the legs of which it was last found.
#[derive(Debug)]
pub(crate) struct Bending {
    /// The unit of length.
    unit: f64,
    known: HashMap<usize, ([DVec3; 2], f64)>,
}

impl Bending {
    pub(crate) fn new(unit: f64) -> Self {
        Self { unit, known: HashMap::new() }
    }

    /// The sum over some segments.
    pub(crate) fn of<F: TensionFamily>(&mut self, state: &State<'_, F>, segments: &[usize]) -> f64 {
        segments.iter().map(|&i| self.of_segment(state, i)).sum()
    }

    fn of_segment<F: TensionFamily>(&mut self, state: &State<'_, F>, i: usize) -> f64 {
        let legs = state.family.end_legs(i);
        if let Some((known, bending)) = self.known.get(&i)
            && *known == legs
        {
            return *bending;
        }
        let [a, c] = legs.map(|leg| leg / self.unit);
        let b = state.windows.polygon().chord(i) / self.unit - a - c;
        let bending = CubicSegment { start: DVec3::ZERO, a, b, c }.bending(BENDING_ACCURACY);
        self.known.insert(i, (legs, bending));
        bending
    }
}
