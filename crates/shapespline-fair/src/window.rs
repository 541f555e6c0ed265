// SPDX-License-Identifier: MIT OR Apache-2.0

//! Windows: the stretches of a curve that are solved by themselves, the rest held.

use shapespline_geometry::DataPolygon;

use crate::{
    chain::{Chain, Freedom},
    element::Node,
    rows::Rules,
    segment::Demands,
};

/// Free nodes beside a segment that fails. A change of one node is felt some 3.7 times less at each
/// further one: beyond these the plain cubic would change by less than 1e−4.
pub(crate) const BESIDE: usize = 8;

/// The least speed along a direction that is asked for, over that of the plain cubic.
const SLOWEST: f64 = 0.3;

/// Neighbouring nodes that are free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    /// The first of them.
    pub(crate) start: usize,
    /// How many.
    pub(crate) count: usize,
}

/// The windows around segments that fail (ascending), merged where they meet.
pub(crate) fn windows(failing: &[usize], nodes: usize, closed: bool, beside: usize) -> Vec<Window> {
    let mut all: Vec<Window> = Vec::new();
    // Runs of the line of nodes; beyond the ends of a closed curve for the moment.
    for &k in failing {
        let (mut from, mut to) = (k as isize - beside as isize, (k + 2 + beside) as isize);
        if !closed {
            (from, to) = (from.max(0), to.min(nodes as isize));
        }
        match all.last_mut() {
            // Held nodes between two windows are at least one.
            Some(last) if from <= last.start as isize + last.count as isize - BIAS => {
                last.count = (to - last.start as isize + BIAS) as usize;
            }
            _ => all.push(Window { start: (from + BIAS) as usize, count: (to - from) as usize }),
        }
    }
    if closed && let [first, .., last] = all.as_mut_slice() {
        let end = last.start + last.count;
        if end >= first.start + nodes {
            last.count = first.start + nodes + first.count - last.start;
            all.remove(0);
        }
    }
    for window in &mut all {
        if window.count >= nodes || (closed && window.count + 1 >= nodes) {
            return vec![Window { start: 0, count: nodes }];
        }
        window.start = (window.start + nodes * (BIAS as usize) - BIAS as usize) % nodes;
    }
    all
}

/// Whether a node is an end with a given tangent.
pub(crate) fn is_given(polygon: &DataPolygon, node: usize) -> bool {
    let [start, end] = polygon.tangents().map(|tangent| tangent.is_some());
    (node == 0 && start) || (node == polygon.segments() && end)
}

/// Keeps indices before the first node positive.
const BIAS: isize = 1 << 20;

impl Window {
    /// Whether a segment lies in the window, in a curve with so many nodes.
    pub(crate) fn touches(self, segment: usize, nodes: usize) -> bool {
        (segment + nodes - self.start) % nodes < self.count
    }

    /// Whether no held node lies between two windows of a curve with so many nodes.
    pub(crate) fn meets(self, other: Self, nodes: usize, closed: bool) -> bool {
        let from = |a: Self, b: Self| {
            (closed || a.start <= b.start) && (b.start + nodes - a.start) % nodes <= a.count
        };
        from(self, other) || from(other, self)
    }

    /// The chain of a window, as some curve has it at its nodes.
    pub(crate) fn chain(
        self,
        demands: &Demands<'_>,
        curve: &dyn Fn(usize) -> Node,
        rules: Rules,
    ) -> Chain {
        let polygon = demands.checker.polygon();
        let (total, n) = (polygon.nodes(), polygon.segments());
        let whole = self.count == total;
        // With a held node on each side, where there is one.
        let (first, count) = if whole {
            (0, total)
        } else {
            let before = usize::from(polygon.is_closed() || self.start > 0);
            let after = usize::from(polygon.is_closed() || self.start + self.count < total);
            ((self.start + total - before) % total, self.count + before + after)
        };
        let held = |i: usize| {
            let inside = (i + total - self.start) % total < self.count;
            match (inside, is_given(polygon, i), demands.runs.line(i)) {
                (false, ..) => Freedom::Held,
                (true, true, None) => Freedom::TangentHeld,
                (true, true, Some(line)) => Freedom::StraightHeld(line),
                (true, false, Some(line)) => Freedom::Straight(line),
                (true, false, None) => {
                    demands.constraints.direction(i).map_or(Freedom::Free, Freedom::Along)
                }
            }
        };
        // Where a direction is asked for the curve begins with it.
        let node = |i: usize| {
            let Node { q, r } = curve(i);
            let [first, second] = held(i).lines();
            let q = first.map_or(q, |t| t * q.dot(t).max(SLOWEST * q.length()));
            Node { q, r: second.map_or(r, |t| t * r.dot(t)) }
        };
        let index = |j: usize| (first + j) % total;
        // Of a closed curve the last segment ends at the first node.
        let ring = whole && polygon.is_closed();
        let segments = if ring { count } else { count - 1 };
        Chain::new(
            (0..segments).map(|j| demands.segment((first + j) % n)).collect(),
            (0..count).map(|j| node(index(j))).collect(),
            (0..count).map(|j| held(index(j))).collect(),
            first,
            rules,
        )
    }
}
