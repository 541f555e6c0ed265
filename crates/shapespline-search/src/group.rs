//! Tensions lowered by a common factor, found by bisection, and what that does to the bending.

use shapespline_geometry::{CubicSegment, DVec3, length};

use crate::{TensionFamily, state::State};

/// No tension can be lowered by more than this part of itself when lowering ends.
pub(crate) const RESOLUTION: f64 = 0.01;

/// Segments on each side of a node whose bending is compared before and after its tension is lowered.
const BENDING_REACH: usize = 4;

/// Relative accuracy of that comparison.
const BENDING_ACCURACY: f64 = 1e-4;

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

    /// Lowers the tensions as far as that keeps the shape, by bisection of the factor. Returns it.
    ///
    /// Trials of the segments around them tell of nearly every factor whether it breaks a criterion, at
    /// a fraction of what it costs to set the tensions. What they find is set and checked as a whole.
    pub(crate) fn lower<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
    ) -> Result<f64, F::Error> {
        state.relaxations += 1;
        let [mut breaks, mut trial] = self.by_trials(state);
        let (mut keeps, mut set) = (1.0, 1.0);
        while trial < keeps && !state.stopped {
            set = trial;
            if state.try_tension(self.at(trial))? {
                keeps = trial;
            } else {
                breaks = trial;
            }
            if keeps - breaks <= RESOLUTION * keeps {
                break;
            }
            trial = 0.5 * (breaks + keeps);
            // Neighbouring numbers have none between them.
            if trial <= breaks {
                break;
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

/// `∫κ² ds` over the segments that feel the tension at a node most, in units of a chord there.
pub(crate) fn bending_around<F: TensionFamily>(state: &State<'_, F>, node: usize) -> f64 {
    let polygon = state.windows.polygon();
    let n = polygon.segments();
    let unit = 1.0 / length(polygon.chord(node.min(n - 1)));
    let around = if polygon.is_closed() {
        (node + n - BENDING_REACH.min(n))..(node + BENDING_REACH.min(n))
    } else {
        node.saturating_sub(BENDING_REACH)..(node + BENDING_REACH).min(n)
    };
    let bending = |i: usize| {
        let [a, c] = state.family.end_legs(i % n).map(|leg| leg * unit);
        let b = polygon.chord(i % n) * unit - a - c;
        CubicSegment { start: DVec3::ZERO, a, b, c }.bending(BENDING_ACCURACY)
    };
    around.take(n).map(bending).sum()
}
