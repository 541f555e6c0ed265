//! The report: what was asked, what holds, where not, and by how much.

use crate::Criterion;

/// One criterion on one segment.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Record {
    /// Index of the segment, from 0.
    pub segment: usize,
    /// The criterion.
    pub criterion: Criterion,
    /// Whether the polygon calls for it there.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Count {
    /// Segments that violate it.
    pub violated: usize,
    /// Segments that it applies to.
    pub applicable: usize,
}

/// What a check found. It holds the violations only; its size does not grow with a clean curve.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ShapeReport {
    /// Number of segments that were checked.
    pub segments: usize,
    /// One count a criterion, in the order of [`Criterion::ALL`].
    pub counts: [Count; 5],
    /// The violations, ascending by segment.
    pub violations: Vec<Record>,
}

impl ShapeReport {
    pub(crate) fn new(segments: usize) -> Self {
        Self { segments, counts: Default::default(), violations: Vec::new() }
    }

    /// Whether every criterion that applies is satisfied.
    #[must_use]
    pub fn ok(&self) -> bool {
        self.violations.is_empty()
    }

    /// How often a criterion applies and is violated.
    #[must_use]
    pub fn count(&self, criterion: Criterion) -> Count {
        self.counts[criterion as usize]
    }
}

/// Violations that a printed report lists before it only counts them.
const LISTED: usize = 20;

impl std::fmt::Display for ShapeReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verdict = if self.ok() { "shape preserved" } else { "shape violated" };
        writeln!(f, "{verdict} on {} segments", self.segments)?;
        writeln!(f, "{:<14}{:>10}{:>12}", "criterion", "violated", "applicable")?;
        for criterion in Criterion::ALL {
            let count = self.count(criterion);
            writeln!(f, "{criterion:<14}{:>10}{:>12}", count.violated, count.applicable)?;
        }
        if self.ok() {
            return Ok(());
        }
        writeln!(f, "{:<14}{:>10}{:>12}{:>16}", "violation", "segment", "margin", "at u")?;
        for v in self.violations.iter().take(LISTED) {
            let criterion = v.criterion;
            writeln!(f, "{criterion:<14}{:>10}{:>12.3e}{:>16.9}", v.segment, v.margin, v.location)?;
        }
        if self.violations.len() > LISTED {
            writeln!(f, "… and {} more", self.violations.len() - LISTED)?;
        }
        Ok(())
    }
}
