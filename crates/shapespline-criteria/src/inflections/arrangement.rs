// SPDX-License-Identifier: MIT OR Apache-2.0

//! The most inflections over all directions, by walks along every curve that bounds a cell.
//!
//! The count is constant on each open cell into which the sphere of directions is cut by the great
//! circles of the [`Line`]s and the curves of tangents of the [`Arc`]s, and every cell has a piece of
//! one of them on its boundary. So it is enough to walk along each, looking anew at what is crossed, and
//! to both sides: no direction is sampled. Directions `w` and `−w` see the same, so half a circle is
//! enough. With m lines and arcs: O(m) events a walk, O(m² log m) in all, memory O(m).
//!
//! Crossings that rounding cannot tell apart are crossed together. A cell between them might not be
//! there, so it is not counted; how many inflections it could show at most is kept as an upper bound.

use std::ops::ControlFlow;

use glam::DVec3;
use shapespline_polynomial::{parallel, quadratic::multiply};

use super::{
    roots::roots,
    sign_sequence::{Arc, Item, Line, STRAIGHT, Sequence, View},
    traversal::{Event, Maximum, Place, Sweep},
};

/// The most inflections that any direction shows; nothing if `go_on`, which is asked before each walk,
/// breaks off.
pub(super) fn most(
    sequence: &Sequence,
    go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Option<Maximum> {
    let lines = sequence.lines.len();
    let walk = |scratch: &mut Walk, i: usize| {
        if go_on().is_break() {
            return None;
        }
        let mut most = if i >= lines {
            scratch.along_arc(sequence, i - lines)
        } else if sequence.lines[i].silent {
            Maximum::NONE
        } else {
            scratch.along_line(sequence, i)
        };
        most.walk = i;
        Some(most)
    };
    // Callers know how long a walk may be: they enter a pool for any number.
    let all: Option<Vec<Maximum>> =
        parallel::map_with(lines + sequence.arcs.len(), 0, Walk::default, walk);
    Some(all?.into_iter().fold(Maximum::NONE, Maximum::or))
}

/// The buffers of a walk.
#[derive(Debug, Default)]
struct Walk {
    events: Vec<Event>,
    /// Signs of the lines that are parallel to the one walked along.
    parallel: Vec<Option<bool>>,
    view: View,
}

/// So close to where an arc ends on its own line nothing is looked at: `w·ω` at the end and its slope
/// there are both zero to rounding.
const TOUCH: f64 = 1e-6;

/// Half circles have this length in terms of [`place`].
const HALF: f64 = 2.0;

/// A monotone function of the angle of the unit vector `(c, s)`, `s ≥ 0`, with a slope of 1/2 to 1.
fn place(c: f64, s: f64) -> f64 {
    1.0 - c / (c.abs() + s)
}

impl Walk {
    /// Along the great circle of a line, on both sides of it.
    fn along_line(&mut self, sequence: &Sequence, i: usize) -> Maximum {
        let Line { v, error, joints, .. } = sequence.lines[i];
        let e1 = v.any_orthonormal_vector();
        let e2 = v.cross(e1);
        let events = &mut self.events;
        events.clear();
        let mut meet = |x: f64, y: f64, width: f64, item: Item| {
            let size = (x * x + y * y).sqrt();
            // Of the two opposite directions the one on the upper half.
            let size = if y < 0.0 || (y == 0.0 && x < 0.0) { -size } else { size };
            let (c, s) = (x / size, y / size);
            let w = e1 * c + e2 * s;
            events.push(Event { at: place(c, s), width: width / size.abs(), begins: 0.0, item, w });
        };
        let mut best = Maximum::NONE;
        self.parallel.clear();
        for (j, line) in sequence.lines.iter().enumerate() {
            let (x, y) = (line.v.dot(e1), line.v.dot(e2));
            let slack = error + line.error + 8.0 * f64::EPSILON;
            let crossed = x * x + y * y > 64.0 * (slack * slack);
            self.parallel.push((!crossed).then(|| line.v.dot(v) > 0.0));
            if crossed {
                meet(y, -x, slack, Item::Line(j));
            } else if x * x + y * y > STRAIGHT * STRAIGHT {
                // Parallel as far as is known, and what is between may be no small cell.
                best.upper = usize::MAX;
            }
        }
        for (k, arc) in sequence.arcs.iter().enumerate() {
            // Its own arcs touch the circle at their ends, and do not cross it.
            if arc.from == i || arc.from + 1 == i {
                let end = arc.tangent[if arc.from == i { 0 } else { 2 }];
                meet(end.dot(e1), end.dot(e2), TOUCH * end.length(), Item::Arc(k));
                continue;
            }
            let (axis, _, sine) = arc.cone;
            if v.dot(axis).abs() > sine + error {
                continue;
            }
            let slack = error + arc.error + 8.0 * f64::EPSILON;
            roots(arc.tangent.map(|x| x.dot(v)), slack, &mut |t, width| {
                let w = arc.tangent_at(t);
                // The tangent moves no faster than its control points differ by.
                meet(w.dot(e1), w.dot(e2), 4.0 * width + slack, Item::Arc(k));
            });
        }
        let begin = self.begin_in_the_widest_gap(v, e1);
        for side in [true, false] {
            let (view, parallel) = (&mut self.view, &self.parallel);
            view.turn_to(sequence, begin, |j| match parallel[j] {
                Some(same) => same == side,
                None => sequence.lines[j].v.dot(begin) > 0.0,
            });
            let inwards = if side { v } else { -v };
            let between = |a: &Event, b: &Event| Place { w: middle(a.w, b.w, v), inwards };
            let start = Place { w: begin, inwards };
            let sweep = Sweep { sequence, joints, closed: true };
            sweep.run(view, &self.events, start, between, &mut best);
        }
        best
    }

    /// Orders the events along a half circle so that the walk begins, and ends, where nothing is near.
    fn begin_in_the_widest_gap(&mut self, v: DVec3, e1: DVec3) -> DVec3 {
        let events = &mut self.events;
        Event::sort(events);
        let n = events.len();
        let gap = |k: usize| match k.checked_sub(1) {
            Some(before) => events[k].at - events[before].at,
            None => events[0].at + HALF - events[n - 1].at,
        };
        let Some(first) = (0..n).max_by(|&a, &b| gap(a).total_cmp(&gap(b))) else { return e1 };
        for event in &mut events[..first] {
            // On the other half of the circle.
            event.at += HALF;
            event.w = -event.w;
        }
        events.rotate_left(first);
        Event::set_beginnings(events);
        middle(-events[n - 1].w, events[0].w, v)
    }

    /// Along the tangents of an arc, on the side where its two inflections are seen.
    fn along_arc(&mut self, sequence: &Sequence, k: usize) -> Maximum {
        let arc = &sequence.arcs[k];
        let own = [arc.from, arc.from + 1];
        let joints = [arc.joint, arc.joint + 1];
        let sweep = Sweep { sequence, joints, closed: false };
        // What comes at the very ends is crossed by no part of the walk.
        let mut beyond = 0;
        let events = &mut self.events;
        events.clear();
        let mut meet = |at: f64, width: f64, item: Item| {
            if at - width > TOUCH && at + width < 1.0 - TOUCH {
                events.push(Event { at, width, begins: 0.0, item, w: DVec3::ZERO });
            } else if !sweep.is_joint([item]) {
                beyond += 1;
            }
        };
        let (axis, cosine, sine) = arc.cone;
        for (j, line) in sequence.lines.iter().enumerate() {
            if own.contains(&j) || line.v.dot(axis).abs() > sine + line.error {
                continue;
            }
            let slack = arc.error + line.error + 8.0 * f64::EPSILON;
            let found = &mut |t, width| meet(t, width, Item::Line(j));
            roots(arc.tangent.map(|x| x.dot(line.v)), slack, found);
        }
        for (j, other) in sequence.arcs.iter().enumerate() {
            let (other_axis, other_cosine, other_sine) = other.cone;
            let apart = cosine * other_cosine - sine * other_sine;
            if j != k && axis.dot(other_axis).abs() >= apart {
                cross_arcs(arc, other, &mut |t, width| meet(t, width, Item::Arc(j)));
            }
        }
        Event::sort(events);
        Event::set_beginnings(events);

        // On the curve of tangents `w·ω` has one sign but for a double zero: it dips to the other.
        let positive = arc.omega[0].dot(arc.tangent_at(0.5)) > 0.0;
        let place = |t: f64| {
            let omega = arc.omega_at(t);
            let inwards = if positive { -omega } else { omega };
            Place { w: arc.tangent_at(t), inwards }
        };
        let start = place(events.first().map_or(0.5, |e| 0.5 * e.begins));
        self.view.turn_to(sequence, start.w, |j| {
            if own.contains(&j) { positive } else { sequence.lines[j].v.dot(start.w) > 0.0 }
        });
        self.view.set_link(arc.from, 2);
        let mut best = Maximum::NONE;
        best.upper = self.view.count + 2 * beyond;
        let between = |a: &Event, b: &Event| place(0.5 * (a.at + b.at));
        sweep.run(&mut self.view, &self.events, start, between, &mut best);
        best
    }
}

/// The events where an arc meets another: the roots of the other's discriminant along it.
fn cross_arcs(arc: &Arc, other: &Arc, meet: &mut impl FnMut(f64, f64)) {
    let [a, m, b] = other.omega.map(|w| arc.tangent.map(|t| t.dot(w)));
    let slack = arc.error + 6.0 * other.error + 8.0 * f64::EPSILON;
    let sign = |p: [f64; 3]| {
        let all = |sign: f64| p.iter().all(|x| sign * x > slack);
        if all(1.0) { 1 } else { -i8::from(all(-1.0)) }
    };
    // Seen from a tangent of the other, its ends have one sign and its middle the opposite one.
    let [first, middle, last] = [a, m, b].map(sign);
    if first * last < 0 || first * middle > 0 || middle * last > 0 {
        return;
    }
    let (mm, ab) = (multiply(m, m), multiply(a, b));
    let p: [f64; 5] = std::array::from_fn(|i| mm[i] - ab[i]);
    let size = |p: [f64; 3]| p.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let [a, m, b] = [a, m, b].map(size);
    let error = slack * (2.0 * m + a + b) + 8.0 * f64::EPSILON * (m * m + a * b);
    // Two pieces of one cubic, cut at a knot that is none: both arcs lie on one conic, and are apart
    // unless the tangent runs through the same directions twice.
    if p.iter().all(|x| x.abs() <= STRAIGHT * (m * m + a * b)) {
        let [a, m, b] = other.omega.map(|w| arc.tangent_at(0.5).dot(w));
        if a * b > 0.0 && a * m < 0.0 {
            (0..2).for_each(|_| meet(0.5, 0.5));
        }
        return;
    }
    // The discriminant vanishes on the whole conic that the other is an arc of; off the arc the middle
    // has the sign of the ends.
    let meet = &mut |t: f64, width: f64| {
        let [a, m, b] = other.omega.map(|w| arc.tangent_at(t).dot(w));
        if m * (a + b) <= STRAIGHT.max(64.0 * width) * (a + b) * (a + b) {
            meet(t, width);
        }
    };
    // Where one goes on as the other they touch: a double root, which is divided out.
    if other.continues && other.from == arc.from + 1 {
        roots([p[0], 2.0 * p[1], 6.0 * p[2]], 6.0 * error, meet);
    } else if arc.continues && arc.from == other.from + 1 {
        roots([6.0 * p[2], 2.0 * p[3], p[4]], 6.0 * error, meet);
    } else {
        roots(p, error, meet);
    }
}

/// The direction half way from `a` to `b`, at most half a circle counter-clockwise around `v`.
fn middle(a: DVec3, b: DVec3, v: DVec3) -> DVec3 {
    if a.dot(b) > 0.0 { a + b } else { (b - a).cross(v) }
}
