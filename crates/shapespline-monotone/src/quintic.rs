// SPDX-License-Identifier: MIT OR Apache-2.0

//! The C² monotone quintic: the paper's program, and the fairest over slopes as well.

use crate::MonotoneError;
use crate::box_qp_blocks;
use crate::data::{Data, check_finite, parts};
use crate::energy::{self, Fairness, is_flat};
use crate::extrapolation::Extrapolation;
use crate::given;
use crate::interrupt::{GoOn, check_interrupt};
use crate::optimal::{self, Optimum, coefficients};
use crate::overlapping_blocks;
use crate::program::admissible_slopes;
use crate::slopes;
use crate::spline::{MonotoneKind, MonotoneSpline};
use shapespline_polynomial::certified_nonnegative;
use std::ops::{ControlFlow, Deref};

/// Nodal slopes.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slopes {
    /// Fritsch and Butland's harmonic means and the paper's end formula.
    #[default]
    FritschButland,
    /// These. The quartic limits them to the region `0 ≤ d ≤ 2Δ` in which its construction is monotone. The quintic takes
    /// all that a C² monotone quintic can have, and refuses others or limits them ([`QuinticOptions::clip`]).
    Given(Vec<f64>),
    /// Chosen together with the second derivatives: the least energy over all C² monotone quintics.
    Optimal,
}

/// How a [`MonotoneQuintic`] is made.
#[derive(Debug, Clone, PartialEq)]
pub struct QuinticOptions {
    /// Nodal slopes; optimal by default.
    pub slopes: Slopes,
    /// What is minimised.
    pub fairness: Fairness,
    /// Limit given slopes that no C² monotone quintic has, instead of refusing them.
    pub clip: bool,
    /// What it is outside the data.
    pub extrapolate: Extrapolation,
}

impl Default for QuinticOptions {
    fn default() -> Self {
        Self {
            slopes: Slopes::Optimal,
            fairness: Fairness::Bending,
            clip: false,
            extrapolate: Extrapolation::default(),
        }
    }
}

/// Which iteration made a [`MonotoneQuintic`] or a [`crate::MonotoneCubic`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SolverKind {
    /// The primal–dual active set on the paper's tridiagonal box program (slopes of Fritsch and Butland).
    ActiveSet,
    /// The interior-point iteration on the exact cone of monotone quintics (optimal and given slopes).
    InteriorPoint,
    /// Newton's method on the slopes (the cubic).
    Newton,
}

/// How the optimisation went. The curve is monotone whatever these numbers say.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Diagnostics {
    /// The method.
    pub solver: SolverKind,
    /// Linear solves.
    pub iterations: usize,
    /// Conditions that hold with equality.
    pub active: usize,
    /// Active set: largest violation of the optimality conditions relative to the size of their terms. Interior
    /// point: a bound of the energy's distance from the exact optimum, relative to the energy; of long data that are
    /// solved in overlapping windows the largest of the windows'.
    pub kkt_residual: f64,
    /// Whether the method ended by its own criterion.
    pub converged: bool,
    /// Whether every segment's derivative was certified non-negative by its Bernstein coefficients.
    pub certified: bool,
    /// The minimised energy, in the data's units (+∞ if it overflows).
    pub energy: f64,
    /// Nodes whose given slopes were limited.
    pub limited: Vec<usize>,
}

/// The C² monotone quintic Bézier-like spline (paper 003, equation (16)).
///
/// With slopes of Fritsch and Butland: the optimum of the paper's program — continuity (17), monotonicity (22), (23),
/// α, β ≥ 0, energy (20) — as a strictly convex box program in the nodal second derivatives, O(N). α, β ≥ 0 is more
/// than monotonicity asks; it makes second derivatives about three times too large on smooth data. With given slopes:
/// the least energy over all second derivatives that are monotone, O(N). With optimal slopes (the default): the least
/// energy over C² monotone quintics on the data's knots. Both to half a per cent; what a segment adds to the distance
/// is held against its own energy, so that small segments are at their optimum too, and the result does not jump as
/// the data move. Data that are not monotone are fitted piecewise: flat at turns and flats, C² and monotone on every
/// interval where the data are.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MonotoneQuintic {
    spline: MonotoneSpline,
    diagnostics: Diagnostics,
    fairness: Fairness,
    bending_energy: f64,
}

impl Deref for MonotoneQuintic {
    type Target = MonotoneSpline;
    fn deref(&self) -> &MonotoneSpline {
        &self.spline
    }
}

impl MonotoneQuintic {
    /// Interpolate `y` at the increasing `x`.
    ///
    /// # Errors
    /// [`MonotoneError`] naming argument, index and value: fewer than two points, lengths that differ, NaN or
    /// infinity, x not increasing, spreads, secants or curvatures that overflow.
    pub fn new(x: &[f64], y: &[f64], options: &QuinticOptions) -> Result<Self, MonotoneError> {
        Self::new_with(x, y, options, &|| ControlFlow::Continue(()))
    }

    /// As [`MonotoneQuintic::new`], with a function that is called every few milliseconds, from any thread; return
    /// `Break` to cancel.
    ///
    /// # Errors
    /// As [`MonotoneQuintic::new`], and [`MonotoneError::Interrupted`] where the answer was no.
    pub fn new_with(
        x: &[f64],
        y: &[f64],
        options: &QuinticOptions,
        go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Self, MonotoneError> {
        let data = Data::new(x, y)?;
        check_interrupt(go_on)?;
        data.check_curvature(y)?;
        let fairness = options.fairness;
        let (d, s, mut diagnostics) = match &options.slopes {
            Slopes::FritschButland => {
                with_fixed_slopes(&data, slopes::fritsch_butland(&data), fairness, go_on)?
            }
            Slopes::Given(given) => {
                if given.len() != x.len() {
                    return Err(MonotoneError::Length {
                        argument: "slopes",
                        found: given.len(),
                        expected: x.len(),
                    });
                }
                check_finite("slopes", given)?;
                with_given_slopes(&data, given, options, go_on)?
            }
            Slopes::Optimal => with_optimal_slopes(&data, fairness, go_on)?,
        };
        check_interrupt(go_on)?;
        let units = data.units();
        let bending = energy::total(&data, Fairness::Bending, &d, &s);
        let bending_energy = units.energy_out(Fairness::Bending, bending);
        diagnostics.energy = match fairness {
            Fairness::Bending => bending_energy,
            Fairness::Parametric => {
                units.energy_out(fairness, energy::total(&data, fairness, &d, &s))
            }
        };
        drop(data);
        check_interrupt(go_on)?;
        let spline =
            MonotoneSpline::quintic(units, x.to_vec(), y.to_vec(), d, s, options.extrapolate);
        // A second derivative beyond double precision: refuse rather than hand out infinities.
        if let Some(i) = spline.overflow() {
            return Err(crate::data::out_of_range("second derivative", "y", i, y[i]));
        }
        Ok(Self { spline, diagnostics, fairness, bending_energy })
    }

    /// How the optimisation went.
    #[must_use]
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// `∫ f''² dx`, +∞ if it overflows.
    #[must_use]
    pub fn bending_energy(&self) -> f64 {
        self.bending_energy
    }

    /// What was minimised.
    #[must_use]
    pub fn fairness(&self) -> Fairness {
        self.fairness
    }

    /// The interpolant without its diagnostics.
    #[must_use]
    pub fn spline(&self) -> &MonotoneSpline {
        &self.spline
    }

    /// α of every segment: `αᵢdᵢ = 3(Δᵢ−dᵢ₊₁) + sᵢ₊₁hᵢ/2`. Where dᵢ = 0 the family (16) has no α: ±∞, or 0 when any
    /// would do.
    #[must_use]
    pub fn alpha(&self) -> Vec<f64> {
        self.parameters(false)
    }

    /// β of every segment: `βᵢdᵢ₊₁ = 3(Δᵢ−dᵢ) − sᵢhᵢ/2`. Where dᵢ₊₁ = 0: as [`Self::alpha`].
    #[must_use]
    pub fn beta(&self) -> Vec<f64> {
        self.parameters(true)
    }

    fn parameters(&self, beta: bool) -> Vec<f64> {
        let (x, y, d, units) = (self.x(), self.y(), &self.spline.d, self.spline.units);
        let MonotoneKind::Quintic { s } = &self.spline.kind else { return Vec::new() };
        (0..x.len() - 1)
            .map(|i| {
                let h = self.spline.scaled_length(i);
                let delta = units.rise().scale(y[i + 1] - y[i]) / h;
                let (product, slope) = if beta {
                    (3.0 * (delta - d[i]) - 0.5 * (h * s[i]), d[i + 1])
                } else {
                    (3.0 * (delta - d[i + 1]) + 0.5 * (h * s[i + 1]), d[i])
                };
                if product == 0.0 { 0.0 } else { product / slope }
            })
            .collect()
    }
}

type Fit = (Vec<f64>, Vec<f64>, Diagnostics);

/// The paper's program for given slopes.
fn with_fixed_slopes(
    data: &Data,
    mut d: Vec<f64>,
    fairness: Fairness,
    go_on: GoOn<'_>,
) -> Result<Fit, MonotoneError> {
    check_interrupt(go_on)?;
    admissible_slopes(data, &mut d);
    let solution = box_qp_blocks::solve(data, &d, fairness, go_on)?;
    let diagnostics = Diagnostics {
        solver: SolverKind::ActiveSet,
        iterations: solution.iterations,
        active: solution.active,
        kkt_residual: solution.kkt_residual,
        converged: solution.solved,
        certified: certified(data, &d, &solution.x),
        energy: 0.0,
        limited: Vec::new(),
    };
    Ok((d, solution.x, diagnostics))
}

/// Slopes and second derivatives together; the paper's program, and said so, where only that is certified or it is
/// better than what the iteration reached.
fn with_optimal_slopes(
    data: &Data,
    fairness: Fairness,
    go_on: GoOn<'_>,
) -> Result<Fit, MonotoneError> {
    let Some(best) = overlapping_blocks::optimise(data, fairness, None, go_on) else {
        return Err(MonotoneError::Interrupted);
    };
    let certified = certified(data, &best.d, &best.s);
    if !(best.converged && certified) {
        let energy = energy::total(data, fairness, &best.d, &best.s);
        let (d, s, diagnostics) =
            with_fixed_slopes(data, slopes::fritsch_butland(data), fairness, go_on)?;
        let other = energy::total(data, fairness, &d, &s);
        if !(certified && energy <= other) {
            // How far that is from the optimum: the bound is the iteration's.
            let gap = best.gap - (1.0 - other / energy);
            let kkt_residual = if gap >= 0.0 { gap } else { f64::INFINITY };
            return Ok((d, s, Diagnostics { kkt_residual, converged: false, ..diagnostics }));
        }
    }
    Ok(fit(best, certified))
}

/// Given slopes; second derivatives of least energy over all with which the quintic is monotone.
fn with_given_slopes(
    data: &Data,
    given: &[f64],
    options: &QuinticOptions,
    go_on: GoOn<'_>,
) -> Result<Fit, MonotoneError> {
    let fairness = options.fairness;
    let fixed = given::fixed(data, &data.slopes_in(given));
    let smooth = |fixed: &Vec<_>| optimal::unconstrained(data, fairness, &|i| fixed[i], data.len());
    if let Some(best) = fixed.as_ref().and_then(smooth) {
        let certified = certified(data, &best.d, &best.s);
        return Ok(fit(best, certified));
    }
    let possible = given::possible(data, given, options.clip, go_on)?;
    let Some(best) =
        overlapping_blocks::optimise(data, fairness, Some(possible.prescribed()), go_on)
    else {
        return Err(MonotoneError::Interrupted);
    };
    let certified = certified(data, &best.d, &best.s);
    let (d, s, diagnostics) = fit(best, certified);
    Ok((d, s, Diagnostics { limited: possible.limited, ..diagnostics }))
}

fn fit(best: Optimum, certified: bool) -> Fit {
    let diagnostics = Diagnostics {
        solver: SolverKind::InteriorPoint,
        iterations: best.steps,
        active: best.active,
        kkt_residual: best.gap,
        converged: best.converged,
        certified,
        energy: 0.0,
        limited: Vec::new(),
    };
    (best.d, best.s, diagnostics)
}

/// Whether every segment's derivative is non-negative in its direction, by its Bernstein coefficients; a rounding
/// error of the coefficients themselves (they are sums of numbers of the size of the secant) is allowed for.
fn certified(data: &Data, d: &[f64], s: &[f64]) -> bool {
    /// Segments looked at together; only where one of them is in doubt, one by one.
    const TILE: usize = 64;
    const TOLERANCE: f64 = 16.0 * f64::EPSILON;
    let of = |h: f64, delta: f64, v0: [f64; 2], v1: [f64; 2]| {
        let c = coefficients(h, delta, v0, v1);
        (c, is_flat(delta))
    };
    let all = parts(data.len(), |part| {
        part.clone().step_by(TILE).all(|from| {
            let n = TILE.min(part.end - from);
            let (h, delta) = (&data.h[from..from + n], &data.delta[from..from + n]);
            let (d, s) = (&d[from..=from + n], &s[from..=from + n]);
            let at = |i: usize| of(h[i], delta[i], [d[i], s[i]], [d[i + 1], s[i + 1]]);
            let sure = (0..n).fold(true, |all, i| {
                let (c, flat) = at(i);
                let positive = c.iter().fold(true, |all, c| all & (c + TOLERANCE >= 0.0));
                all & (positive | flat)
            });
            sure || (0..n).all(|i| {
                let (c, flat) = at(i);
                flat || certified_nonnegative(&c, TOLERANCE)
            })
        })
    });
    all.iter().all(|certified| *certified)
}
