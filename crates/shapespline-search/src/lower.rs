//! Lowering the tension of some nodes by a common factor, found by bisection.
//!
//! A look at the segments around the nodes tells of nearly every factor whether it breaks a criterion,
//! at a fraction of what it costs to set the tensions. What looks find is set and checked as a whole: a
//! factor that breaks a criterion anywhere is not taken.

use crate::{TensionFamily, runs::Run, state::State};

/// No nodes can be lowered by more than this part of their tension when relaxation ends.
const RESOLUTION: f64 = 0.01;

/// Nodes that hold each other back are lowered to this part of it.
const FINE: f64 = RESOLUTION / 8.0;

/// Nodes that are lowered together.
pub(crate) struct Nodes {
    /// The nodes, ascending, and the tension they began with.
    full: Vec<(usize, f64)>,
    /// Scratch: the same with a part of it.
    scaled: Vec<(usize, f64)>,
    /// The factor that is set.
    set: f64,
    /// The part of their tension that they are lowered to.
    resolution: f64,
}

impl Nodes {
    /// The nodes of some runs, with the tension they have.
    pub(crate) fn of<'r, F: TensionFamily>(
        state: &State<'_, F>,
        runs: impl IntoIterator<Item = &'r Run>,
    ) -> Self {
        let tension = state.family.tension();
        let nodes = runs.into_iter().flat_map(|run| run.nodes(tension.len()));
        let mut full: Vec<_> = nodes.map(|i| (i, tension[i])).collect();
        full.sort_unstable_by_key(|node| node.0);
        Self { scaled: Vec::with_capacity(full.len()), full, set: 1.0, resolution: RESOLUTION }
    }

    /// The same, to be lowered to a smaller part of their tension.
    pub(crate) fn finely(self) -> Self {
        Self { resolution: FINE, ..self }
    }

    /// The changes that bring the nodes to a factor of their tension.
    fn at(&mut self, factor: f64) -> &[(usize, f64)] {
        self.scaled.clear();
        self.scaled.extend(self.full.iter().map(|&(i, tension)| (i, tension * factor)));
        &self.scaled
    }

    /// Lowers the nodes as far as that leaves the curve without faults. Returns how many changed.
    ///
    /// `all`: whether no other node has tension.
    pub(crate) fn lower<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        all: bool,
    ) -> Result<usize, F::Error> {
        state.relaxations += 1;
        // Looks go on for as long as they see what breaks.
        let mut looks = true;
        if !(all && state.plain_fails) {
            // No tension at all comes first: growth often raises more nodes than it had to.
            looks = state.seems_to_break(self.at(0.0)) == Some(true);
            if !looks && self.keeps_shape(state, 0.0)? {
                return Ok(self.full.len());
            }
        }
        let (mut breaks, mut keeps) = (0.0, 1.0);
        while keeps - breaks > self.resolution * keeps && !state.stopped {
            let middle = 0.5 * (breaks + keeps);
            let least = looks.then(|| self.bisect_by_looks(state, &mut breaks, keeps)).flatten();
            let trial = least.unwrap_or(middle);
            if trial <= breaks || trial >= keeps {
                break;
            }
            if self.keeps_shape(state, trial)? {
                keeps = trial;
            } else {
                (breaks, looks) = (trial, false);
            }
        }
        self.return_to(state, keeps)?;
        Ok(if keeps < 1.0 { self.full.len() } else { 0 })
    }

    /// Bisects between a factor that breaks a criterion and one that does not. The least factor that
    /// seems to keep the shape, if looks tell.
    fn bisect_by_looks<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        breaks: &mut f64,
        keeps: f64,
    ) -> Option<f64> {
        let mut seems = keeps;
        while seems - *breaks > self.resolution * seems {
            let trial = 0.5 * (*breaks + seems);
            if trial <= *breaks || trial >= seems {
                break;
            }
            if state.seems_to_break(self.at(trial))? {
                *breaks = trial;
            } else {
                seems = trial;
            }
            // Where nothing seems to break, looks may see nothing.
            if *breaks == 0.0 && 8.0 * seems <= keeps {
                break;
            }
        }
        Some(seems)
    }

    /// Whether the nodes could be lowered by the resolution, all others left as they are.
    pub(crate) fn can_be_lowered<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
    ) -> Result<bool, F::Error> {
        let factor = 1.0 - RESOLUTION;
        if state.seems_to_break(self.at(factor)) == Some(true) {
            return Ok(false);
        }
        let keeps = self.keeps_shape(state, factor)?;
        self.return_to(state, 1.0)?;
        Ok(keeps)
    }

    /// Sets a factor; whether that leaves the curve without faults.
    fn keeps_shape<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        factor: f64,
    ) -> Result<bool, F::Error> {
        self.set = factor;
        state.try_tension(self.at(factor))
    }

    /// Sets a factor that is known to leave no faults.
    fn return_to<F: TensionFamily>(
        &mut self,
        state: &mut State<'_, F>,
        factor: f64,
    ) -> Result<(), F::Error> {
        if self.set == factor {
            return Ok(());
        }
        self.set = factor;
        state.return_to(self.at(factor))
    }
}
