// SPDX-License-Identifier: MIT OR Apache-2.0

//! The report: what was asked, what holds, where not, and by how much.

use crate::{Criteria, Criterion};

/// One criterion on one segment.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Record {
    /// Index of the segment, from 0.
    pub segment: usize,
    /// The criterion.
    pub criterion: Criterion,
    /// Whether the polygon requires it there.
    pub applicable: bool,
    /// Whether the curve meets it (true where it does not apply).
    pub satisfied: bool,
    /// Signed, scale-free distance from failure, positive when satisfied; NaN where it does not
    /// apply.
    pub margin: f64,
    /// Parameter `u` where the margin is smallest; NaN where it does not apply.
    pub location: f64,
}

/// How often a criterion applies, and how often it is violated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Count {
    /// Segments that violate it.
    pub violated: usize,
    /// Segments that it applies to.
    pub applicable: usize,
}

/// A criterion that could be neither proved nor refuted on a segment: something in it is zero to
/// rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Undecided {
    /// Index of the segment, from 0.
    pub segment: usize,
    /// The criterion.
    pub criterion: Criterion,
    /// The parameters `u` between which the question stays open.
    pub interval: [f64; 2],
}

/// What a check found. It holds the violations only; its size does not grow with a clean curve.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ShapeReport {
    /// Number of segments that were checked.
    pub segments: usize,
    /// The criteria that were asked.
    pub criteria: Criteria,
    /// One count a criterion, in the order of [`Criterion::ALL`].
    pub counts: [Count; Criterion::COUNT],
    /// The violations, ascending by segment.
    pub violations: Vec<Record>,
    /// What stays open, ascending by segment.
    pub undecided: Vec<Undecided>,
    /// Segments that are straight by construction: at their ends turning and torsion may be zero.
    pub straight: Vec<usize>,
}

impl ShapeReport {
    /// The report on a curve that violates nothing, given how many segments each criterion applies
    /// to (in the order of [`Criterion::ALL`]).
    #[must_use]
    pub fn clean(
        segments: usize,
        criteria: Criteria,
        applicable: [usize; Criterion::COUNT],
    ) -> Self {
        let counts = applicable.map(|applicable| Count { violated: 0, applicable });
        let (violations, undecided, straight) = (Vec::new(), Vec::new(), Vec::new());
        Self { segments, criteria, counts, violations, undecided, straight }
    }

    /// Whether no criterion that applies is violated. What rounding hides may still be
    /// [undecided](Self::undecided).
    #[must_use]
    pub fn ok(&self) -> bool {
        self.violations.is_empty()
    }

    /// What the report says of the shape, in a word.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        match (self.ok(), self.undecided.is_empty()) {
            (true, true) => "preserved",
            (true, false) => "undecided",
            (false, _) => "violated",
        }
    }

    /// The criteria that there is something to say about: those that were asked, and regularity, which
    /// always is, where it fails or stays open.
    #[must_use]
    pub fn listed(&self) -> Criteria {
        let regular = Criterion::Regular;
        let open = self.undecided.iter().any(|open| open.criterion == regular);
        let stops = self.count(regular).violated > 0 || open;
        if stops { self.criteria.with(regular) } else { self.criteria }
    }

    /// How often a criterion applies and is violated.
    #[must_use]
    pub fn count(&self, criterion: Criterion) -> Count {
        self.counts[criterion as usize]
    }
}

/// Violations (and open questions) that a printed report lists before it only counts them.
const LISTED: usize = 20;

impl std::fmt::Display for ShapeReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "shape {} on {} segments", self.verdict(), self.segments)?;
        writeln!(f, "{:<17}{:>10}{:>12}", "criterion", "violated", "applicable")?;
        for criterion in self.listed().iter() {
            let count = self.count(criterion);
            writeln!(f, "{criterion:<17}{:>10}{:>12}", count.violated, count.applicable)?;
        }
        if !self.straight.is_empty() {
            writeln!(f, "straight on {} segments, by construction", self.straight.len())?;
        }
        let more = |f: &mut std::fmt::Formatter<'_>, n: usize| match n.checked_sub(LISTED) {
            Some(rest) if rest > 0 => writeln!(f, "… and {rest} more"),
            _ => Ok(()),
        };
        if !self.violations.is_empty() {
            writeln!(f, "{:<17}{:>10}{:>12}{:>16}", "violation", "segment", "margin", "at u")?;
            for v in self.violations.iter().take(LISTED) {
                let Record { segment, criterion, margin, location, .. } = v;
                writeln!(f, "{criterion:<17}{segment:>10}{margin:>12.3e}{location:>16.9}")?;
            }
            more(f, self.violations.len())?;
        }
        if !self.undecided.is_empty() {
            writeln!(f, "{:<17}{:>10}{:>16}{:>16}", "undecided", "segment", "from u", "to u")?;
            for Undecided { segment, criterion, interval: [from, to] } in
                self.undecided.iter().take(LISTED)
            {
                writeln!(f, "{criterion:<17}{segment:>10}{from:>16.9}{to:>16.9}")?;
            }
            more(f, self.undecided.len())?;
        }
        Ok(())
    }
}
