// SPDX-License-Identifier: MIT OR Apache-2.0

//! Tensions lowered by a common factor, found by bisection.

use shapespline_geometry::DataPolygon;

use crate::{
    TensionFamily,
    state::{AROUND, State},
};

/// How exactly the least factor of a tension is found in the end, and the part of itself that is then added, so
/// that changes far away, which are felt little, do not bring criteria to the brink.
pub(crate) const RESOLUTION: f64 = 0.01;

/// Segments on each side of a node that tell how far its tension can be lowered. A segment beyond that it
/// would break feels it so little that rounding would decide how far it goes: it goes half as far then.
const REACH: usize = 6;

/// Tensions that are lowered together, by one factor: mostly a single one.
pub(crate) struct Group {
    /// The tensions, ascending by index, as they began.
    full: Vec<(usize, f64)>,
    /// Scratch: the same times a factor.
    scaled: Vec<(usize, f64)>,
    /// How exactly the least factor is found by trials.
    resolution: f64,
}

impl Group {
    /// Some tensions, as they are.
    pub(crate) fn of(indices: &[usize], tension: &[f64], resolution: f64) -> Self {
        let mut full: Vec<_> = indices.iter().map(|&k| (k, tension[k])).collect();
        full.sort_unstable_by_key(|(k, _)| *k);
        Self { scaled: Vec::with_capacity(full.len()), full, resolution }
    }

    /// A tension that was lowered before is tried again if less by this part of itself seems to do: more than
    /// what was added so as not to be on the brink.
    pub(crate) fn least(&self) -> f64 {
        2.5 * self.resolution
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
    ///
    /// `again`: whether [`Self::least`] less is known to do as far as trials tell, and most likely not much less.
    pub(crate) fn lower<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        again: bool,
    ) -> Result<f64, F::Error> {
        state.relaxations += 1;
        let none = state.seems_to_break(self.at(0.0), AROUND);
        let mut least = match none {
            Some(true) => spared(self.by_trials(state, AROUND, 0.0, again)),
            _ => 0.0,
        };
        if least < 1.0 && !state.try_tension(self.at(least))? {
            if none.is_none() || !self.breaks_near(state) {
                return self.by_setting(state, least);
            }
            // Segments a little further away feel it too.
            let further = spared(self.by_trials(state, REACH, least, false));
            if further < 1.0 && !state.try_tension(self.at(further))? {
                return self.by_setting(state, further);
            }
            least = further;
            if least >= 1.0 {
                state.return_to(self.at(1.0))?;
            }
        }
        Ok(least.min(1.0))
    }

    /// The same where setting the tensions to a factor has turned out to break a criterion.
    fn by_setting<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        mut breaks: f64,
    ) -> Result<f64, F::Error> {
        // How often only segments far away broke: half way back is tried once.
        let mut far = usize::from(!self.breaks_near(state));
        let (mut keeps, mut set) = (1.0, breaks);
        while far < 2 && keeps - breaks > RESOLUTION * keeps && !state.stopped {
            let trial = 0.5 * (breaks + keeps);
            // Neighbouring numbers have none between them.
            if trial <= breaks {
                break;
            }
            set = trial;
            if state.try_tension(self.at(trial))? {
                keeps = trial;
                if far == 1 {
                    break;
                }
            } else {
                breaks = trial;
                far += usize::from(!self.breaks_near(state));
            }
        }
        if 0.0 < keeps && spared(keeps) < 1.0 {
            set = spared(keeps);
            if state.try_tension(self.at(set))? {
                keeps = set;
            }
        }
        if set != keeps {
            state.return_to(self.at(keeps))?;
        }
        Ok(keeps)
    }

    /// Whether a segment near the tensions fails as they are set.
    fn breaks_near<F: TensionFamily>(&self, state: &mut State<'_, F>) -> bool {
        let nodes = self.full.iter().map(|(k, _)| k / F::SIDES);
        let near = segments_around(state.windows.polygon(), nodes, REACH);
        state.has_violations_among(&near)
    }

    /// The least factor, beyond one that breaks a criterion, that seems to keep them all as far as segments
    /// within reach tell.
    fn by_trials<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        reach: usize,
        mut breaks: f64,
        gallops: bool,
    ) -> f64 {
        let (mut seems, mut stride) = (1.0, self.least());
        if gallops {
            seems -= stride;
        }
        let mut gallops = gallops;
        while seems - breaks > self.resolution * seems {
            stride *= 2.0;
            gallops &= 1.0 - stride > 0.5 * (breaks + seems);
            let trial = if gallops { 1.0 - stride } else { 0.5 * (breaks + seems) };
            if trial <= breaks || trial >= seems {
                break;
            }
            match state.seems_to_break(self.at(trial), reach) {
                Some(true) => (breaks, gallops) = (trial, false),
                Some(false) => seems = trial,
                None => break,
            }
        }
        seems
    }
}

/// A factor, and what is added to it so as not to be on the brink.
fn spared(factor: f64) -> f64 {
    factor * (1.0 + RESOLUTION)
}

/// The segments within reach of some nodes, ascending.
pub(crate) fn segments_around(
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
