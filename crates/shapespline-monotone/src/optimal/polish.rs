//! The end of the iteration: Newton's method on the contacts.
//!
//! Near the optimum it is known where the derivative is held at 0, and there the optimum solves smooth equations: the
//! energy's gradient is a combination of "p at the contact", the contacts stay minima of p. Newton's method on them
//! squares the error in a round, for a tenth or so of an interior-point step: one elimination, in which a contact is a
//! stiff spring with a multiplier (the augmented Lagrangian; Bertsekas, *Constrained Optimization and Lagrange
//! Multiplier Methods*, 1982), and the motion of its place a second, soft one (Hettich and Kortanek, *SIAM Rev.* 35
//! (1993) 380–429, for such methods of semi-infinite programs). Which conditions are equations is decided anew within a
//! round (a negative multiplier lets go, a negative value holds) before the point moves. What comes out is not believed
//! but certified; where it fails, the iteration goes on.

use super::cone::{self, W};
use super::step::Problem;

/// Rounds after which the attempt counts as failed unless one in [`PATIENCE`] still gains by this factor: nearly all
/// that come to an end do so before, and more in vain cost as much as the step of the iteration that is needed then.
const ROUNDS: usize = 12;
const PATIENCE: usize = 3;
const GAINING: f64 = 0.8;
const MAX_ROUNDS: usize = 40;
/// Rounds in which it may be decided anew what is held.
const DECISIONS: usize = 5;
/// Change of p, the secant being 1, that shows that the contacts are not the right ones.
const WILD: f64 = 10.0;
/// Change of p from which on the error, which is about its square, is no more than rounding.
const STILL: f64 = 3e-5;
/// The same where that was not enough.
const FURTHER: f64 = 1e-8;
/// The same after all rounds: contacts that are about to merge are approached slowly, and have little energy.
const NEARLY: f64 = 1e-3;

/// A condition that is missed by more than this share of the round's change holds up the others: its contact is made
/// stiffer by this factor.
const SLOW: f64 = 0.02;
const STIFFER: f64 = 100.0;

impl Problem {
    /// Move the primal point onto the optimum that its contacts belong to; `further` from where the last call has left
    /// it. Whether that succeeded.
    pub(super) fn polish(&mut self, further: bool) -> bool {
        let still = if further { FURTHER } else { STILL };
        if further {
            self.renew_contacts();
        } else {
            self.find_contacts();
        }
        let (mut decisions, mut idle, mut best) = (0, 0, f64::INFINITY);
        for round in 0..MAX_ROUNDS {
            let change = self.solve_contacts();
            // NaN ends here too.
            if !(change < WILD) {
                return false;
            }
            decisions += 1;
            if self.decide(change) && decisions < DECISIONS {
                continue;
            }
            self.contacts.iter_mut().for_each(|c| c.multiplier = c.next);
            std::mem::swap(&mut self.w, &mut self.ahead);
            if change < still {
                return true;
            }
            idle = if change < GAINING * best { 0 } else { idle + 1 };
            best = best.min(change);
            if round >= ROUNDS && idle >= PATIENCE {
                break;
            }
            decisions = 0;
            self.renew_contacts();
        }
        best < NEARLY
    }

    /// Solve for the point ahead with what is held. The largest change of an unknown.
    fn solve_contacts(&mut self) -> f64 {
        for (j, given) in self.given.iter().enumerate() {
            let (factors, aim) = (&mut self.factors[j], &mut self.aims[0][j]);
            cone::energy_part(given, &mut factors.block, &mut aim.rhs);
        }
        for k in 0..self.contacts.len() {
            if self.contacts[k].held {
                self.add(k);
            }
        }
        self.eliminate();
        // The step node by node, then what it is to the segments.
        for (step, (to, from)) in self.v.iter_mut().zip(self.ahead.iter().zip(&self.w)) {
            *step = [to[0] - from[0], to[1] - from[1]];
        }
        let mut largest = [0.0f64; W];
        for (j, given) in self.given.iter().enumerate() {
            let step = &self.v[j * W..=j * W + W];
            for l in 0..W {
                let (a, b) = (given.a[l], given.b[l]);
                let sum = (a * step[l][0]).abs()
                    + (b * step[l][1]).abs()
                    + (a * step[l + 1][0]).abs()
                    + (b * step[l + 1][1]).abs();
                // NaN must not hide.
                largest[l] = if sum <= largest[l] { largest[l] } else { sum };
            }
        }
        largest.iter().fold(0.0, |most, &l| if l <= most { most } else { l })
    }

    /// Add contact k's springs to the system.
    fn add(&mut self, k: usize) {
        let c = &self.contacts[k];
        let u = self.unknowns(c.segment, &self.w);
        let (j, l) = (c.segment / W, c.segment % W);
        let given = &self.given[j];
        let (a, b, unit) = (given.a[l], given.b[l], given.unit[l]);
        let along = |g: &[f64; 4]| (g[0] * u[0] + g[1] * u[1]) + (g[2] * u[2] + g[3] * u[3]);
        let soft = c.multiplier * c.flexibility;
        let pull = c.multiplier + c.stiffness * (along(&c.row) - c.value);
        let turn = soft * along(&c.drift);
        let scaled = |g: &[f64; 4]| [a * g[0], b * g[1], a * g[2], b * g[3]];
        let (row, drift) = (scaled(&c.row), scaled(&c.drift));
        let (stiff, soft) = (unit * c.stiffness, unit * soft);
        let (block, rhs) = (&mut self.factors[j].block, &mut self.aims[0][j].rhs);
        let mut at = 0;
        for p in 0..4 {
            let (stiff, soft) = (stiff * row[p], soft * drift[p]);
            for q in p..4 {
                block[at][l] += stiff * row[q] + soft * drift[q];
                at += 1;
            }
            rhs[p][l] += unit * (pull * row[p] + turn * drift[p]);
        }
    }

    /// The multipliers at the point ahead, and what is held from now on. Whether that changed.
    fn decide(&mut self, change: f64) -> bool {
        let mut contacts = std::mem::take(&mut self.contacts);
        let mut changed = false;
        for c in &mut contacts {
            let step = self.unknowns(c.segment, &self.v);
            let moved: f64 = (0..4).map(|k| c.row[k] * step[k]).sum();
            let value = c.value + moved;
            c.next = if c.held { c.multiplier - c.stiffness * value } else { 0.0 };
            if c.held && !(c.next > 0.0) {
                (c.held, c.multiplier, c.next, changed) = (false, 0.0, 0.0, true);
            } else if !c.held && value < 0.0 {
                (c.held, changed) = (true, true);
            } else if c.held && value.abs() > (SLOW * change).max(STILL * STILL) {
                c.stiffness *= STIFFER;
            }
        }
        self.contacts = contacts;
        changed
    }

    /// The moments of the contacts, for the certificate.
    pub(super) fn measure(&mut self) {
        for state in &mut self.changes {
            state.y = [[0.0; W]; 5];
        }
        for c in self.contacts.iter().filter(|c| c.held) {
            let y = &mut self.changes[c.segment / W].y;
            for (y, moment) in y.iter_mut().zip(c.moments()) {
                y[c.segment % W] += c.multiplier * moment;
            }
        }
    }

    /// Segments that a contact holds.
    pub(super) fn held(&self) -> usize {
        let mut last = usize::MAX;
        let new = |c: &&super::contacts::Contact| {
            c.held && std::mem::replace(&mut last, c.segment) != c.segment
        };
        self.contacts.iter().filter(new).count()
    }
}
