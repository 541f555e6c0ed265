// SPDX-License-Identifier: MIT OR Apache-2.0

//! One walk: its events are crossed in order, and what is seen between them is kept.

use glam::DVec3;

use super::sign_sequence::{Item, Line, Sequence, View};

/// The most that a walk has seen, or all walks have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Maximum {
    pub(super) count: usize,
    /// No direction shows more than this.
    pub(super) upper: usize,
    /// A direction on the boundary of a cell that shows the count, and the way into the cell.
    pub(super) boundary: DVec3,
    pub(super) inwards: DVec3,
    /// Which walk it was.
    pub(super) walk: usize,
}

impl Maximum {
    pub(super) const NONE: Self =
        Self { count: 0, upper: 0, boundary: DVec3::Z, inwards: DVec3::ZERO, walk: usize::MAX };

    /// Of equal counts that of the first walk, so that threads do not matter.
    pub(super) fn or(self, other: Self) -> Self {
        let later = (other.count, std::cmp::Reverse(other.walk))
            > (self.count, std::cmp::Reverse(self.walk));
        let upper = self.upper.max(other.upper);
        Self { upper, ..if later { other } else { self } }
    }
}

/// A place on a walk, and the way to the side that is looked at; of any length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) w: DVec3,
    pub(super) inwards: DVec3,
}

/// Where a walk meets something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    /// The place: `t` along an arc, a monotone function of the angle along a circle.
    pub(super) at: f64,
    /// How far rounding leaves it open.
    pub(super) width: f64,
    /// Where this event or a later one begins.
    pub(super) begins: f64,
    pub(super) item: Item,
    /// The direction there (of unit length along a circle).
    pub(super) w: DVec3,
}

impl Event {
    /// Sorts by place: places alone, for events are long, and each is moved once then.
    pub(super) fn sort(events: &mut [Self]) {
        events.sort_by_cached_key(|event| {
            // The order of `f64::total_cmp`, as a number.
            let bits = event.at.to_bits().cast_signed();
            bits ^ ((bits >> 63).cast_unsigned() >> 1).cast_signed()
        });
    }

    /// Sets where each event or a later one begins; the events are in order.
    pub(super) fn set_beginnings(events: &mut [Self]) {
        let mut begins = f64::INFINITY;
        for event in events.iter_mut().rev() {
            begins = begins.min(event.at - event.width);
            event.begins = begins;
        }
    }
}

/// What a walk along one line or arc knows beside its events.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sweep<'a> {
    pub(super) sequence: &'a Sequence,
    /// The joints whose tangent is on its way.
    pub(super) joints: [usize; 2],
    /// Whether it ends where it began.
    pub(super) closed: bool,
}

impl Sweep<'_> {
    /// Crosses all events, in order, and keeps the most that is seen between them.
    pub(super) fn run(
        self,
        view: &mut View,
        events: &[Event],
        start: Place,
        between: impl Fn(&Event, &Event) -> Place,
        best: &mut Maximum,
    ) {
        let keep = |best: &mut Maximum, count: usize, place: Place| {
            if count > best.count || best.inwards == DVec3::ZERO {
                best.count = count;
                (best.boundary, best.inwards) = (place.w.normalize(), place.inwards.normalize());
            }
            best.upper = best.upper.max(count);
        };
        let closed = self.closed.then_some(view.count);
        let mut before = view.count;
        keep(best, before, start);
        let (mut first, mut reach) = (0, f64::NEG_INFINITY);
        for (k, event) in events.iter().enumerate() {
            reach = reach.max(event.at + event.width);
            let group = &events[first..=k];
            let after = match events.get(k + 1) {
                Some(next) if next.begins > reach => {
                    let place = between(event, next);
                    group.iter().for_each(|e| view.cross(self.sequence, e.item, place.w));
                    keep(best, view.count, place);
                    Some(view.count)
                }
                Some(_) => continue,
                None => closed,
            };
            if group.len() > 1 && self.may_hide_cells(group) {
                best.upper = best.upper.max(hidden(before, after, group));
            }
            (before, first) = (view.count, k + 1);
        }
    }

    /// Whether there may be cells between events that rounding cannot tell apart.
    fn may_hide_cells(self, group: &[Event]) -> bool {
        let lines = &self.sequence.lines;
        let line = |e: &Event| match e.item {
            Item::Line(j) => Some(lines[j]),
            Item::Arc(_) => None,
        };
        // One great circle many times over.
        let first = line(&group[0]);
        let same =
            |a: Line, b: Line| a.v.cross(b.v).length() <= a.error + b.error + 8.0 * f64::EPSILON;
        if group.iter().all(|e| first.zip(line(e)).is_some_and(|(a, b)| same(a, b))) {
            return false;
        }
        !self.is_joint(group.iter().map(|e| e.item))
    }

    /// Whether all meet in one joint of the curve, as they have to. The cells there are those that the
    /// walks away from it see as well.
    pub(super) fn is_joint(self, items: impl IntoIterator<Item = Item>) -> bool {
        let mut common = self.joints;
        let ends = |[first, last]: [usize; 2]| first == 0 || Some(last) == self.sequence.closing;
        let mut all_at_the_ends = self.sequence.closing.is_some() && ends(self.joints);
        for item in items {
            let joints = match item {
                Item::Line(j) => self.sequence.lines[j].joints,
                Item::Arc(k) => [self.sequence.arcs[k].joint, self.sequence.arcs[k].joint + 1],
            };
            common = [common[0].max(joints[0]), common[1].min(joints[1])];
            all_at_the_ends &= ends(joints);
        }
        common[0] <= common[1] || all_at_the_ends
    }
}

/// The most that can be seen among crossings, in any order, given the counts before and after them. What
/// is crossed changes the count by two at most, or leaves it as it was when it is crossed back.
fn hidden(before: usize, after: Option<usize>, group: &[Event]) -> usize {
    let mut items: Vec<Item> = group.iter().map(|e| e.item).collect();
    items.sort_unstable();
    let crossings = items.chunk_by(|a, b| a == b).map(<[Item]>::len);
    let (mut once, mut twice) = (0, 0);
    crossings.for_each(|n| if n % 2 == 1 { once += 1 } else { twice += 1 });
    let part = |x: usize| {
        let from_before = before + 2 * x;
        after.map_or(from_before, |after| from_before.min(after + 2 * (once - x)))
    };
    (0..=once).map(part).max().unwrap_or(before) + 2 * twice
}
