// SPDX-License-Identifier: MIT OR Apache-2.0

//! Which tensions mend which violation: the increase patterns of paper 001, (5.58)–(5.60).

use shapespline_criteria::Violations;
use shapespline_geometry::DataPolygon;

/// Nodes around segment `m` whose tension is to be raised, as offsets `−1, 0, 1, 2` from `m`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TensionPattern {
    /// Whether node `m + k − 1` is to be raised.
    pub(crate) raise: [bool; 4],
    /// Whether the tensions at nodes `m` and `m + 1` are to be kept equal (5.65).
    pub(crate) equal: bool,
}

impl TensionPattern {
    /// The pattern that mends the violations of a segment.
    ///
    /// A violation between the nodes, of global convexity, of torsion, or of a split coplanarity
    /// needs all four nodes; one at node m needs its neighbours m−1 and m+1 (Lemma 5.4), one at
    /// node m+1 needs m and m+2; the inflection conditions are conditions at the nodes, and so is
    /// turning (paper 000, Lemma 4.2). A violation of collinearity away from its node needs the two
    /// nodes of that segment, or all three nodes around (Lemma 5.9). A segment on which the curve
    /// stops needs shorter legs: its two nodes.
    #[must_use]
    pub(crate) fn of(violations: Violations) -> Self {
        const ALL: Violations = Violations::CONVEXITY_BETWEEN
            .union(Violations::GLOBAL_CONVEXITY)
            .union(Violations::TORSION)
            .union(Violations::COPLANARITY_BETWEEN)
            .union(Violations::COPLANARITY_SPLIT);
        const AT_START: Violations = Violations::CONVEXITY_AT_START
            .union(Violations::INFLECTION_AT_START)
            .union(Violations::TURNING_AT_START)
            .union(Violations::COPLANARITY_AT_START)
            .union(Violations::LINE_AT_START);
        const AT_END: Violations = Violations::CONVEXITY_AT_END
            .union(Violations::INFLECTION_AT_END)
            .union(Violations::TURNING_AT_END)
            .union(Violations::COPLANARITY_AT_END)
            .union(Violations::LINE_AT_END);
        // Both nodes of the segment, whichever of its ends the line belongs to.
        const FAR: Violations = Violations::LINE_AFTER_START
            .union(Violations::LINE_BEFORE_END)
            .union(Violations::NOT_REGULAR);

        let (all, start, end) = (
            violations.intersects(ALL),
            violations.intersects(AT_START),
            violations.intersects(AT_END),
        );
        let far = violations.intersects(FAR);
        let inside_start = violations.intersects(Violations::LINE_INSIDE_START);
        let inside_end = violations.intersects(Violations::LINE_INSIDE_END);
        Self {
            raise: [
                all || start || inside_start,
                all || end || far || inside_start || inside_end,
                all || start || far || inside_start || inside_end,
                all || end || inside_end,
            ],
            equal: violations.intersects(Violations::COPLANARITY_SPLIT),
        }
    }

    /// The offsets from `m` of the nodes to be raised.
    pub(crate) fn offsets(self) -> impl Iterator<Item = isize> {
        (-1..).zip(self.raise).filter_map(|(offset, raise)| raise.then_some(offset))
    }

    /// The nodes to be raised for segment `m`.
    pub(crate) fn nodes(self, m: usize, polygon: &DataPolygon) -> impl Iterator<Item = usize> {
        let ring = Ring::of(polygon, polygon.nodes());
        self.offsets().filter_map(move |offset| ring.moved(m, offset))
    }
}

/// The numbers of segments or nodes: of closed data they go round.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ring {
    count: usize,
    closed: bool,
}

impl Ring {
    /// That of some count of a polygon's.
    pub(crate) fn of(polygon: &DataPolygon, count: usize) -> Self {
        Self { count, closed: polygon.is_closed() }
    }

    /// The number that is so far from another, if there is one.
    pub(crate) fn moved(self, from: usize, by: isize) -> Option<usize> {
        if self.closed {
            let count = self.count as isize;
            return Some(((from as isize + by % count + count) % count) as usize);
        }
        from.checked_add_signed(by).filter(|&i| i < self.count)
    }
}
