//! Places where a segment's derivative may be held at 0, as linear conditions at the current point.

use super::cone::{self, ENERGY, W};
use super::nodes::local;
use super::step::Problem;
use crate::quartic_form::{basis, cut, dot, minima};
use std::ops::Range;

/// Stiffness of a contact in units of what resists it: large, so that a round or two of multipliers meet the
/// condition; but it costs as many digits of what is soft beside it.
const STIFFNESS: f64 = 1e6;
/// What p is held at instead of 0: enough to be found non-negative after rounding.
const MARGIN: f64 = 1e-10;
/// Distance in t within which a minimum continues a contact of the round before.
const NEAR: f64 = 0.1;
/// A multiplier this many times the value, both in their natural units, makes a contact at the start.
const HELD: f64 = 10.0;

/// How many of p's coefficients vanish at either end: p is tᵃ(1−t)ᵇ times the quartic, cubic, … q that is asked to be
/// non-negative.
pub(super) type Order = [usize; 2];

/// "q at t" as a functional on p's coefficients of tᵏ(1−t)⁴⁻ᵏ, and its derivative along t. The former are the moments
/// of a unit multiplier.
#[inline]
fn functional(t: f64, [a, b]: Order) -> ([f64; 5], [f64; 5]) {
    let powers = |t: f64| [0.0, 1.0, t, t * t, t * t * t, (t * t) * (t * t)];
    let (l, r) = (powers(t), powers(1.0 - t));
    let (mut value, mut drift) = ([0.0; 5], [0.0; 5]);
    for k in a..=4 - b {
        // Powers are kept one place further right.
        let (i, j) = (k - a, 4 - b - k);
        value[k] = l[i + 1] * r[j + 1];
        drift[k] = i as f64 * (l[i] * r[j + 1]) - j as f64 * (l[i + 1] * r[j]);
    }
    (value, drift)
}

/// A condition q ≥ 0 at a place of a segment, q the derivative over the secant without its zeros at the ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    pub(super) segment: usize,
    pub(super) t: f64,
    order: Order,
    /// q there at the current point less [`MARGIN`], and its gradient in the segment's unknowns.
    pub(super) value: f64,
    pub(super) row: [f64; 4],
    /// The gradient of q's slope there and 1/q'' (0 where the place stays): how the place moves.
    pub(super) drift: [f64; 4],
    pub(super) flexibility: f64,
    pub(super) stiffness: f64,
    /// In the segment's unit; and what the round makes of it.
    pub(super) multiplier: f64,
    pub(super) next: f64,
    /// Whether the condition is an equation for the time being.
    pub(super) held: bool,
}

impl Contact {
    fn new(segment: usize, t: f64, order: Order, value: f64, curvature: f64) -> Self {
        let (moments, drift) = functional(t, order);
        let gradient = |m: [f64; 5]| cone::force(cone::reduced(&m));
        Self {
            segment,
            t,
            order,
            value: value - MARGIN,
            row: gradient(moments),
            drift: gradient(drift),
            flexibility: 1.0 / curvature,
            stiffness: 0.0,
            multiplier: 0.0,
            next: 0.0,
            held: false,
        }
    }

    /// The moments of a unit multiplier.
    pub(super) fn moments(&self) -> [f64; 5] {
        functional(self.t, self.order).0
    }

    fn is_inside(&self) -> bool {
        self.t > 0.0 && self.t < 1.0
    }

    /// Follow the minimum of q to where it has moved. Whether it is still there, nearby.
    #[inline]
    fn follow(&mut self, q: &[f64; 5]) -> bool {
        /// Newton steps: from a distance of a tenth to rounding, and a distance that is as good as none.
        const STEPS: usize = 5;
        const RESOLUTION: f64 = 1e-8;
        let (mut t, mut curvature) = (self.t, f64::INFINITY);
        if self.is_inside() {
            for _ in 0..STEPS {
                let slope;
                [slope, curvature] = derivatives(q, t);
                let moved = slope / curvature;
                if moved.abs() < RESOLUTION {
                    break;
                }
                t -= moved;
                // NaN ends here too.
                if !(curvature > 0.0 && (t - self.t).abs() < NEAR && t > 0.0 && t < 1.0) {
                    return false;
                }
            }
        }
        let value = dot(q, &basis(t));
        if t == self.t {
            (self.flexibility, self.value) = (1.0 / curvature, value - MARGIN);
        } else {
            let Self { stiffness, multiplier, .. } = *self;
            let new = Self::new(self.segment, t, self.order, value, curvature);
            *self = Self { stiffness, multiplier, ..new };
        }
        self.held = self.multiplier > 0.0 || self.value < 0.0;
        true
    }
}

/// q' and q'' at t.
#[inline]
fn derivatives(c: &[f64; 5], t: f64) -> [f64; 2] {
    let u = 1.0 - t;
    let d = [c[1] - c[0], c[2] - c[1], c[3] - c[2], c[4] - c[3]];
    let (uu, ut, tt) = (u * u, u * t, t * t);
    let square = |a: f64, b: f64, c: f64| uu * a + (2.0 * (ut * b) + tt * c);
    let (left, right) = (square(d[0], d[1], d[2]), square(d[1], d[2], d[3]));
    [4.0 * (u * left + t * right), 12.0 * (right - left)]
}

/// The Bernstein coefficients, of degree four, of q from those of p.
fn without_zeros(p: &[f64; 5], [a, b]: Order) -> [f64; 5] {
    const BINOMIAL: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
    let mut q: [f64; 5] =
        std::array::from_fn(|k| if k + a + b > 4 { 0.0 } else { BINOMIAL[k + a] * p[k + a] });
    // Times t + (1−t) for every zero.
    for _ in 0..a + b {
        for k in (1..5).rev() {
            q[k] += q[k - 1];
        }
    }
    std::array::from_fn(|k| q[k] / BINOMIAL[k])
}

impl Problem {
    /// A segment's unknowns without dimension.
    #[inline]
    pub(super) fn unknowns(&self, i: usize, w: &[[f64; 2]]) -> [f64; 4] {
        let (given, l) = (&self.given[i / W], i % W);
        let (a, b) = (given.a[l], given.b[l]);
        [a * w[i][0], b * w[i][1], a * w[i + 1][0], b * w[i + 1][1]]
    }

    /// The contacts at the current point, told from the iteration's moments.
    pub(super) fn find_contacts(&mut self) {
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.clear();
        self.each_quartic(|i, q| {
            let start = contacts.len();
            let inside = self.candidates(i, q, &mut contacts);
            let (state, l) = (&self.states[i / W], i % W);
            let y: [f64; 5] = std::array::from_fn(|k| state.y[k][l]);
            distribute(&y, &mut contacts[start..], inside);
            // A multiplier is between the segment's own energy and the geometric mean with its neighbours'.
            let natural = HELD * self.given[i / W].e[l].sqrt();
            for contact in &mut contacts[start..] {
                contact.held = contact.multiplier > natural * contact.value;
                contact.multiplier = if contact.held { contact.multiplier } else { 0.0 };
            }
        });
        self.contacts = contacts;
    }

    /// The contacts at the current point, which those of the round before have led to.
    pub(super) fn renew_contacts(&mut self) {
        let old = std::mem::take(&mut self.contacts);
        let mut contacts = std::mem::take(&mut self.previous);
        contacts.clear();
        let mut from = 0;
        self.each_quartic(|i, q| {
            while from < old.len() && old[from].segment < i {
                from += 1;
            }
            let start = contacts.len();
            let mut lost = false;
            let past = old[from..].iter().take_while(|c| c.segment == i);
            for contact in past.clone() {
                let mut contact = *contact;
                lost |= !contact.follow(q);
                contacts.push(contact);
            }
            let here = &contacts[start..];
            // Where nothing is held the last word is the certificate's.
            let known = here.iter().all(|c| !c.held) || covers(here, q);
            if !here.is_empty() && !lost && known {
                return;
            }
            contacts.truncate(start);
            self.candidates(i, q, &mut contacts);
            let found = contacts.len();
            for past in past.filter(|c| c.held) {
                inherit(past, q, &mut contacts, start..found);
            }
            for contact in &mut contacts[start..] {
                contact.held |= contact.value < 0.0;
            }
        });
        (self.contacts, self.previous) = (contacts, old);
    }

    /// `visit` the segments at which something is free, in order, with the Bernstein coefficients of q at the current
    /// point.
    #[inline]
    fn each_quartic(&self, mut visit: impl FnMut(usize, &[f64; 5])) {
        for (j, given) in self.given.iter().enumerate() {
            let u = local(given, &self.w, j);
            let mut p = [[0.0; W]; 5];
            for l in 0..W {
                let (c0, c1, c3, c4) = (u[0][l], u[0][l] + u[1][l], u[2][l] - u[3][l], u[2][l]);
                let c2 = 5.0 - ((c0 + c4) + (c1 + c3));
                (p[0][l], p[1][l], p[2][l], p[3][l], p[4][l]) = (c0, c1, c2, c3, c4);
            }
            for l in (0..W).filter(|&l| given.idle[l] == 0.0) {
                let (i, p) = (j * W + l, std::array::from_fn(|k| p[k][l]));
                match self.order(i) {
                    [0, 0] => visit(i, &p),
                    order => visit(i, &without_zeros(&p, order)),
                }
            }
        }
    }

    /// How many coefficients are fixed at 0 at the ends of a segment.
    #[inline]
    fn order(&self, i: usize) -> Order {
        if self.all_free {
            return [0, 0];
        }
        let (given, l) = (&self.given[i / W], i % W);
        let vanishes = |k: usize| usize::from(given.fixed[k][l] != 0.0);
        [vanishes(0) + vanishes(1), vanishes(2) + vanishes(3)]
    }

    /// Append what could be a contact of segment i: the minima of q, and its ends where no neighbour goes on with it.
    /// The number of the former.
    fn candidates(&self, i: usize, q: &[f64; 5], contacts: &mut Vec<Contact>) -> usize {
        let (start, order) = (contacts.len(), self.order(i));
        if q[1].min(q[2]).min(q[3]) < 0.0 {
            for m in minima(q).iter().flatten() {
                self.append(Contact::new(i, m.t, order, m.value, m.curvature), contacts);
            }
        }
        let inside = contacts.len() - start;
        // Inside the data a contact at a node is one in the segment on either side of it, and at a turn the same
        // condition on both sides.
        let turns = order[0] == 1 && i > 0 && self.given[(i - 1) / W].idle[(i - 1) % W] == 0.0;
        if i == 0 || (order[0] > 0 && !turns) {
            self.append(Contact::new(i, 0.0, order, q[0], f64::INFINITY), contacts);
        }
        if i + 1 == self.n || order[1] > 0 {
            self.append(Contact::new(i, 1.0, order, q[4], f64::INFINITY), contacts);
        }
        inside
    }

    /// Append a contact with a stiffness many times what resists, the energy of the softest unknown; or nothing where
    /// nothing that it acts on is free.
    fn append(&self, mut contact: Contact, contacts: &mut Vec<Contact>) {
        let i = contact.segment;
        let least = (0..4).fold(f64::INFINITY, |least, k| {
            let room = self.resistance(i, k) / (contact.row[k] * contact.row[k]);
            if room < least { room } else { least }
        });
        if least < f64::INFINITY {
            contact.stiffness = STIFFNESS * least;
            contacts.push(contact);
        }
    }

    /// The energy's second derivative along unknown k of segment i, in the segment's unit; infinite where it is fixed.
    fn resistance(&self, i: usize, k: usize) -> f64 {
        const DIAGONAL: [usize; 4] = [0, 4, 7, 9];
        let (right, second) = (k / 2, k % 2);
        if !self.is_free(i + right, second) {
            return f64::INFINITY;
        }
        let scaled = |j: usize| {
            let (given, l) = (&self.given[j / W], j % W);
            let scale = if second == 0 { given.a[l] } else { given.b[l] };
            (given.unit[l] * scale * scale, given.e[l])
        };
        let (own, e) = scaled(i);
        let mut sum = e * ENERGY[DIAGONAL[k]];
        let neighbour = if right == 1 { i + 1 } else { i.wrapping_sub(1) };
        if neighbour < self.n {
            let (other, e) = scaled(neighbour);
            sum += other / own * e * ENERGY[DIAGONAL[(k + 2) % 4]];
        }
        sum
    }
}

/// Give the moments y of a segment to the places found in it, of which the first `inside` are not at the ends.
fn distribute(y: &[f64; 5], found: &mut [Contact], inside: usize) {
    let (inner, ends) = found.split_at_mut(inside);
    match inner {
        [one] => {
            // The inner moments are those of the inner places alone.
            let m = one.moments();
            let own = one.order[0] + 1..4 - one.order[1];
            one.multiplier = y[own.clone()].iter().sum::<f64>() / m[own].iter().sum::<f64>();
        }
        [first, second] => {
            let (p, q) = (first.moments(), second.moments());
            let d = 1.0 / (p[1] * q[3] - p[3] * q[1]);
            first.multiplier = d * (y[1] * q[3] - y[3] * q[1]);
            second.multiplier = d * (p[1] * y[3] - p[3] * y[1]);
        }
        _ => {}
    }
    for end in ends {
        let k = if end.t == 0.0 { end.order[0] } else { 4 - end.order[1] };
        let share = |c: &Contact| c.multiplier * c.moments()[k];
        end.multiplier = y[k] - inner.iter().map(share).sum::<f64>();
    }
}

/// The places inside of a segment's contacts, in order.
pub(super) fn places(contacts: &[Contact]) -> impl Iterator<Item = f64> {
    let mut last = 0.0;
    contacts.iter().filter(|c| c.is_inside()).filter_map(move |c| {
        let next = c.t > last;
        last = c.t.max(last);
        next.then_some(c.t)
    })
}

/// Whether q is nowhere less than at the contacts of its segment: by its coefficients between them.
fn covers(contacts: &[Contact], q: &[f64; 5]) -> bool {
    let least = contacts.iter().fold(0.0f64, |least, c| least.min(c.value));
    let least = least - 1e-9 * (least.abs() + 1e-3);
    let (mut rest, mut from) = (*q, 0.0);
    let above = |c: &[f64; 5]| c.iter().fold(true, |all, c| all & (*c >= least));
    for t in places(contacts) {
        let (left, right) = cut(rest, (t - from) / (1.0 - from));
        if !above(&left) {
            return false;
        }
        (rest, from) = (right, t);
    }
    above(&rest)
}

/// Let a contact of the round before go on: in the candidate nearest to it, or as it is.
fn inherit(past: &Contact, q: &[f64; 5], contacts: &mut Vec<Contact>, candidates: Range<usize>) {
    let distance = |c: &Contact| {
        if c.is_inside() == past.is_inside() { (c.t - past.t).abs() } else { f64::INFINITY }
    };
    let nearest = contacts[candidates].iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest {
        Some(next) if distance(next) < NEAR => {
            next.stiffness = next.stiffness.max(past.stiffness);
            next.multiplier += past.multiplier;
            next.held = true;
        }
        // A place that has no minimum any more still is one where q must not be negative.
        _ => {
            let value = dot(q, &basis(past.t)) - MARGIN;
            contacts.push(Contact { value, flexibility: 0.0, ..*past });
        }
    }
}
