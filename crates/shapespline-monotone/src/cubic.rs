// SPDX-License-Identifier: MIT OR Apache-2.0

//! The monotone C² cubic: of all monotone functions through the data the one with the least bending energy.

use crate::MonotoneError;
use crate::data::{Data, PowerOfTwo, Units, out_of_range, parts_mut};
use crate::energy::Fairness;
use crate::extrapolation::{Continuation, Extrapolation};
use crate::interrupt::{GoOn, check_interrupt};
use crate::quintic::{Diagnostics, SolverKind};
use crate::smooth::Smoothing;
use crate::spline::MonotoneSpline;
use std::ops::{ControlFlow, Deref};

mod bent;
mod convex;
mod ends;
mod layer;
mod piece;
mod pieces;
mod problem;
mod profile;
mod ramp;
mod stretch;
mod sweep;
#[cfg(test)]
mod tests;

use convex::Asked;
pub use convex::Convexity;
pub use ends::Ends;
pub(crate) use pieces::Pieces;
use problem::{Bend, Layers, Problem, Slopes};
use profile::Profiles;

/// How a [`MonotoneCubic`] is made.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicOptions {
    /// What holds at the two ends.
    pub ends: Ends,
    /// Slopes at the points, one per point; NaN where they are free.
    pub slopes: Option<Vec<f64>>,
    /// The share of an interval beside a turn or a flat in which the second derivative falls to its value there, from 0
    /// to 1/4. With 0 the least energy itself, which is C¹ at turns and flats; with more it is C² everywhere. With
    /// `convex` it is three eighths of this share, also beside points where convexity makes the least energy C¹; the
    /// energy is at most `1 + 3/8 layer` times the least.
    pub layer: f64,
    /// The share of the smallest secant of an interval and its neighbours below which the slope never falls there where
    /// the data are strictly monotone, from 0 to less than 1.
    pub min_slope: f64,
    /// Where the function is to be convex or concave as well as monotone; None: nowhere in particular.
    pub convex: Option<Convexity>,
    /// What it is outside the data. [`Extrapolation::PERIODIC`] with [`Ends::Periodic`] repeats the function up to the
    /// rise over a period.
    pub extrapolate: Extrapolation,
}

impl Default for CubicOptions {
    fn default() -> Self {
        Self {
            ends: Ends::Estimated,
            slopes: None,
            layer: 1.0 / 16.0,
            min_slope: 0.0,
            convex: None,
            extrapolate: Extrapolation::default(),
        }
    }
}

/// The largest share of a layer.
const LARGEST_LAYER: f64 = 0.25;
/// Rounds of making second derivatives at turns smaller; the second has never been needed twice.
const ROUNDS: usize = 8;

/// The monotone interpolant of least bending energy `∫ f''² dx`: a C² cubic spline with at most two knots between points.
///
/// With [`Ends::Natural`] and layer 0 it is the least of **all** monotone functions through the data, not only of
/// splines. Between two points it is one cubic, or a parabola of slope that falls to 0, a level part and one that rises
/// (closed forms); the slopes at the points are the only unknowns, of a convex problem that Newton's method on a
/// tridiagonal system solves to rounding. [`Self::lower_bound`] and [`Self::interval_gaps`] prove it. Data that are not
/// monotone are fitted piecewise: slope 0 at turns and flats, monotone on every interval where the data are.
///
/// With [`CubicOptions::convex`] it is also convex and concave where the data are: with layer 0 of all such functions the
/// one with the least energy, in closed forms as well, with at most eight knots between points.
///
/// Andersson and Elfving (1991), *Interpolation and approximation by monotone cubic splines*, J. Approx. Theory 66,
/// 302–333, have the theory of this functional. O(N).
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MonotoneCubic {
    spline: MonotoneSpline,
    diagnostics: Diagnostics,
    level: Vec<usize>,
    lower_bound: f64,
    gaps: Vec<f64>,
    smoothing: Option<Smoothing>,
}

impl Deref for MonotoneCubic {
    type Target = MonotoneSpline;
    fn deref(&self) -> &MonotoneSpline {
        &self.spline
    }
}

impl MonotoneCubic {
    /// Interpolate `y` at the increasing `x`.
    ///
    /// # Errors
    /// [`MonotoneError`] naming argument, index and value: fewer than two points, lengths that differ, NaN or
    /// infinity, x not increasing, spreads, secants or curvatures that overflow, given slopes that no monotone function
    /// through the data has, shares out of range.
    pub fn new(x: &[f64], y: &[f64], options: &CubicOptions) -> Result<Self, MonotoneError> {
        Self::new_with(x, y, options, &|| ControlFlow::Continue(()))
    }

    /// As [`MonotoneCubic::new`], with a function that is called every few milliseconds, from any thread; return
    /// `Break` to cancel.
    ///
    /// # Errors
    /// As [`MonotoneCubic::new`], and [`MonotoneError::Interrupted`] where the answer was no.
    pub fn new_with(
        x: &[f64],
        y: &[f64],
        options: &CubicOptions,
        go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Self, MonotoneError> {
        check_share("layer", options.layer, |s| (0.0..=LARGEST_LAYER).contains(&s), "[0, 0.25]")?;
        check_share("min_slope", options.min_slope, |s| (0.0..1.0).contains(&s), "[0, 1)")?;
        let data = Data::new(x, y)?;
        check_interrupt(go_on)?;
        data.check_curvature(y)?;
        let (mut problem, first) = problem(&data, options)?;
        let form = match &options.convex {
            Some(convex) => {
                Form::Asked(Asked::new(convex, &mut problem, data.len(), options, first)?)
            }
            None => Form::Monotone,
        };
        let extrapolate = extrapolation(options, x, y);
        let task = Task { problem, first, form, units: data.units(), layer: options.layer };
        task.solved([x, y], extrapolate, go_on)
    }

    /// The least-energy function through values whose rises are known to more digits than their differences have.
    /// Natural ends, no layers.
    pub(crate) fn through(
        known: &Known<'_>,
        extrapolate: Extrapolation,
        go_on: GoOn<'_>,
    ) -> Result<Self, MonotoneError> {
        let [x, y] = known.data;
        let data = Data::new(x, y)?;
        data.check_curvature(y)?;
        let mut problem = Problem::new(&data);
        let scale = PowerOfTwo::new(known.ey - data.ey);
        for (i, rise) in known.rises.iter().enumerate() {
            problem.d[i] = scale.scale(*rise);
            problem.sign[i] = if *rise > 0.0 { known.sign } else { 0.0 };
        }
        for i in 0..x.len() {
            problem.held[i] = problem.is_level(i);
        }
        let scale = PowerOfTwo::new((known.ey - known.ex) - (data.ey - data.ex));
        let form = if known.bend.is_empty() { Form::Monotone } else { known.bent(&problem, scale) };
        let task = Task { problem, first: 0, form, units: data.units(), layer: 0.0 };
        task.solved([x, y], extrapolate, go_on)
    }

    /// How the fit went.
    #[must_use]
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// `∫ f''² dx`, +∞ if it overflows.
    #[must_use]
    pub fn bending_energy(&self) -> f64 {
        self.diagnostics.energy
    }

    /// The intervals in which the function is level for a while between two parabolas of slope, increasing.
    #[must_use]
    pub fn level_pieces(&self) -> &[usize] {
        &self.level
    }

    /// A bound from below of the bending energy of every monotone function through the data with the same slopes at
    /// held ends and given points (by Fenchel's duality, from the second derivatives): what is least without layers.
    #[must_use]
    pub fn lower_bound(&self) -> f64 {
        self.lower_bound
    }

    /// By how much every interval exceeds its part of [`Self::lower_bound`] at most, without layers.
    #[must_use]
    pub fn interval_gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// How noisy data were smoothed, of a function that [`crate::smooth_monotone`] made.
    #[must_use]
    pub fn smoothing(&self) -> Option<&Smoothing> {
        self.smoothing.as_ref()
    }

    pub(crate) fn set_smoothing(&mut self, smoothing: Smoothing) {
        self.smoothing = Some(smoothing);
    }

    /// The interpolant without its diagnostics.
    #[must_use]
    pub fn spline(&self) -> &MonotoneSpline {
        &self.spline
    }
}

/// The least bending energy `∫ f''² dx` of any monotone function through the data (monotone wherever they are), +∞ if it
/// overflows. O(N).
///
/// # Errors
/// As [`MonotoneCubic::new`].
///
/// ```
/// let least = shapespline_monotone::minimal_bending(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0])?;
/// assert_eq!(least, 0.0);
/// # Ok::<(), shapespline_monotone::MonotoneError>(())
/// ```
pub fn minimal_bending(x: &[f64], y: &[f64]) -> Result<f64, MonotoneError> {
    let options = CubicOptions { ends: Ends::Natural, layer: 0.0, ..CubicOptions::default() };
    MonotoneCubic::new(x, y, &options).map(|f| f.bending_energy())
}

/// The intervals, held slopes and floors; the index of the first interval, which follows copies of the last ones where
/// the data are periodic.
fn problem(data: &Data, options: &CubicOptions) -> Result<(Problem, usize), MonotoneError> {
    let periodic = options.ends == Ends::Periodic;
    let (mut problem, first) =
        if periodic { ends::repeated(data) } else { (Problem::new(data), 0) };
    if let Some(slopes) = &options.slopes {
        ends::hold_given(&mut problem, data, slopes, first)?;
    }
    if !periodic {
        ends::hold_ends(&mut problem, data, options)?;
    }
    if options.min_slope > 0.0 {
        problem.set_floor(options.min_slope);
        ends::check_floor(&mut problem, data, options, first)?;
    }
    Ok((problem, first))
}

/// What a fit solves.
struct Task {
    problem: Problem,
    /// The problem's interval of the data's first.
    first: usize,
    form: Form,
    units: Units,
    layer: f64,
}

/// What is asked of a fit.
enum Form {
    /// The least energy of monotone functions.
    Monotone,
    /// Convexity.
    Asked(Asked),
    /// Signs of intervals, in the direction of the data, and slopes that have them.
    Bent(Vec<Bend>, Slopes),
}

/// A function of which more is known than its values.
pub(crate) struct Known<'a> {
    /// x, and increasing or decreasing y.
    pub(crate) data: [&'a [f64]; 2],
    /// 1 if y increases, −1 if it decreases.
    pub(crate) sign: f64,
    /// Sizes of the rises, in units of 2^ey.
    pub(crate) rises: &'a [f64],
    /// Exponents of the units of x and y.
    pub(crate) ex: i32,
    pub(crate) ey: i32,
    /// 1 for intervals on which it is convex in the direction of the data, −1 for concave, 0 for others; empty: 0.
    pub(crate) bend: &'a [Bend],
    /// With signs, sizes of the slopes, and what those at the ends of the intervals that have one are above the secants.
    pub(crate) slopes: &'a [f64],
    pub(crate) over: &'a [[f64; 2]],
}

impl Known<'_> {
    fn bent(&self, problem: &Problem, scale: PowerOfTwo) -> Form {
        let m: Vec<f64> = self.slopes.iter().map(|m| scale.scale(*m)).collect();
        let over = |i: usize| match self.bend[i] {
            0 => [m[i], m[i + 1]].map(|m| m - problem.secant(i)),
            _ => self.over[i].map(|over| scale.scale(over)),
        };
        let over = (0..self.bend.len()).map(over).collect();
        Form::Bent(self.bend.to_vec(), Slopes { m, fine: vec![], over, solves: 0, converged: true })
    }
}

impl Task {
    fn solved(
        mut self,
        [x, y]: [&[f64]; 2],
        extrapolate: Extrapolation,
        go_on: GoOn<'_>,
    ) -> Result<MonotoneCubic, MonotoneError> {
        let Self { problem, first, units, .. } = &self;
        let (first, units) = (*first, *units);
        let found = problem.solve(None, go_on)?;
        let (least, mut gaps) = problem.certificate(&found.m, first..first + x.len() - 1);
        let gap: f64 = gaps.iter().sum();
        let CubicFit { pieces, energy, solves, converged } =
            match std::mem::replace(&mut self.form, Form::Monotone) {
                Form::Monotone => self.monotone([x, y], found.m, go_on)?,
                Form::Asked(asked) => {
                    let straight = asked.impose(&mut self.problem);
                    let found = self.problem.solve(None, go_on)?;
                    self.bent([x, y], &found, &asked.signs, straight)
                }
                Form::Bent(bend, slopes) => {
                    self.problem.bend = bend;
                    let straight = slopes.over.iter().map(|over| *over == [0.0; 2]).collect();
                    self.bent([x, y], &slopes, &vec![0; x.len()], straight)
                }
            };
        check_interrupt(go_on)?;
        let out = |energy: f64| units.energy_out(Fairness::Bending, energy);
        let diagnostics = Diagnostics {
            solver: SolverKind::Newton,
            iterations: found.solves + solves,
            active: pieces.level.len(),
            kkt_residual: if gap > 0.0 { gap / least } else { 0.0 },
            converged: found.converged && converged,
            certified: true,
            energy: out(energy),
            limited: Vec::new(),
        };
        parts_mut(&mut gaps, |_, gaps| gaps.iter_mut().for_each(|gap| *gap = out(*gap)));
        let (level, lower_bound) = (pieces.level.clone(), out((least - gap).max(0.0)));
        let spline = MonotoneSpline::cubic(units, [x, y], pieces, extrapolate);
        // A second derivative beyond double precision: refuse rather than hand out infinities.
        if let Some(i) = spline.overflow() {
            let i = spline.segment_of_knot(i);
            return Err(out_of_range("second derivative", "y", i, y[i]));
        }
        Ok(MonotoneCubic { spline, diagnostics, level, lower_bound, gaps, smoothing: None })
    }

    /// Pieces of least energy with slopes m, and layers.
    fn monotone(
        &self,
        data: [&[f64]; 2],
        m: Vec<f64>,
        go_on: GoOn<'_>,
    ) -> Result<CubicFit, MonotoneError> {
        let Self { problem, first, units, layer, .. } = self;
        let Layered { m, layers, solves, converged } = layered(problem, m, *layer, go_on)?;
        let (pieces, energy) = Pieces::new(problem, *units, data, &m, layers.as_ref(), *first);
        Ok(CubicFit { pieces, energy, solves, converged })
    }

    /// Pieces that are convex and concave where that is asked.
    fn bent(
        &self,
        data: [&[f64]; 2],
        found: &Slopes,
        signs: &[i8],
        straight: Vec<bool>,
    ) -> CubicFit {
        let Self { problem, first, units, layer, .. } = self;
        let profiles = Profiles::new(problem, found, signs, straight, *layer);
        let (pieces, energy) = Pieces::bent(problem, *units, data, found, &profiles, *first);
        CubicFit { pieces, energy, solves: found.solves, converged: found.converged }
    }
}

struct Layered {
    m: Vec<f64>,
    layers: Option<Layers>,
    solves: usize,
    converged: bool,
}

struct CubicFit {
    pieces: Pieces,
    energy: f64,
    solves: usize,
    converged: bool,
}

/// Layers beside turns and flats, and the slopes that go with them.
fn layered(
    problem: &Problem,
    mut m: Vec<f64>,
    share: f64,
    go_on: GoOn<'_>,
) -> Result<Layered, MonotoneError> {
    if share == 0.0 || !(0..problem.held.len()).any(|i| problem.is_level(i)) {
        return Ok(Layered { m, layers: None, solves: 0, converged: true });
    }
    let mut layers = problem.layers(share, &m);
    let mut solves = 0;
    for _ in 0..ROUNDS {
        let found = problem.solve(Some((&layers, &m)), go_on)?;
        (m, solves) = (found.m, solves + found.solves);
        if !problem.flatten(&mut layers, &m) {
            return Ok(Layered { m, layers: Some(layers), solves, converged: found.converged });
        }
    }
    // With 0 at every turn no slope can fall below 0.
    layers.second.fill(0.0);
    let found = problem.solve(Some((&layers, &m)), go_on)?;
    Ok(Layered { m: found.m, layers: Some(layers), solves, converged: found.converged })
}

/// What a function outside its data is asked to be: one with periodic ends repeats up to its rise over a period.
fn extrapolation(options: &CubicOptions, x: &[f64], y: &[f64]) -> Extrapolation {
    let rises = options.ends == Ends::Periodic && y[0] != y[x.len() - 1];
    let side = |side| match side {
        Continuation::Periodic(0) if rises => Continuation::Periodic(1),
        other => other,
    };
    let Extrapolation { below, above } = options.extrapolate;
    Extrapolation { below: side(below), above: side(above) }
}

fn check_share(
    argument: &'static str,
    value: f64,
    allowed: impl Fn(f64) -> bool,
    range: &'static str,
) -> Result<(), MonotoneError> {
    if allowed(value) { Ok(()) } else { Err(MonotoneError::Share { argument, value, range }) }
}
