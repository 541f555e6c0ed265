// SPDX-License-Identifier: MIT OR Apache-2.0

//! The records that a report is made of.

use pyo3::prelude::*;
use shapespline::criteria::{self, Oscillation, Record, Undecided};

use crate::record::record;

record! {
    /// One criterion on one segment: whether it applies, whether it holds, and by how much.
    ///
    /// Attributes
    /// ----------
    /// segment : int
    ///     Index of the segment, from 0; it runs from node ``segment`` to node ``segment + 1``.
    /// criterion : str
    ///     Name of the criterion.
    /// applicable : bool
    ///     Whether the data polygon requires the criterion on this segment.
    /// satisfied : bool
    ///     Whether the curve is proved to meet it; true where it does not apply.
    /// margin : float
    ///     Signed distance from failure, without unit, in [−1, 1]: positive exactly when satisfied; NaN
    ///     where the criterion does not apply.
    /// location : float
    ///     Parameter at which the margin is smallest; NaN where the criterion does not apply.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> report = ss.NuSpline(points, "uniform").check()
    /// >>> worst = min(report.violations, key=lambda record: record.margin)
    /// >>> worst.criterion, worst.segment, worst.satisfied
    /// ('torsion', 1, False)
    ShapeRecord {
        /// Index of the segment, from 0.
        segment: usize,
        /// Name of the criterion.
        criterion: String,
        /// Whether the data polygon requires the criterion on this segment.
        applicable: bool,
        /// Whether the curve meets it; true where it does not apply.
        satisfied: bool,
        /// Signed, scale-free distance from failure, positive when satisfied; NaN where not applicable.
        margin: f64,
        /// Parameter at which the margin is smallest; NaN where not applicable.
        location: f64,
    }

    /// A criterion that could be neither proved nor refuted on a segment.
    ///
    /// Something in it is zero to rounding: the sign lies within the bound of its error.
    ///
    /// Attributes
    /// ----------
    /// segment : int
    ///     Index of the segment, from 0.
    /// criterion : str
    ///     Name of the criterion.
    /// interval : tuple[float, float]
    ///     The parameters between which the question stays open.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.UndecidedRecord(3, "torsion", (0.25, 0.5)).interval
    /// (0.25, 0.5)
    UndecidedRecord {
        /// Index of the segment, from 0.
        segment: usize,
        /// Name of the criterion.
        criterion: String,
        /// The parameters between which the question stays open.
        interval: (f64, f64),
    }

    /// A condition at a node to which it applies: information, which enters no verdict.
    ///
    /// Attributes
    /// ----------
    /// node : int
    ///     Index of the point.
    /// condition : str
    ///     ``"compatibility"``, ``"same-torsion"``, ``"torsion-change"``, ``"convex-neighbourhood"``,
    ///     ``"inflection-neighbourhood"``, ``"neighbourhood-torsion"`` or
    ///     ``"neighbourhood-coplanarity"``; see ``ShapeReport.nodes``.
    /// satisfied : bool
    ///     Whether the curve meets it.
    /// margin : float
    ///     Signed distance from failure, without unit.
    /// location : float
    ///     Parameter at which the margin is smallest.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check()
    /// >>> [(record.node, record.condition, record.satisfied) for record in report.nodes]
    /// [(1, 'compatibility', True), (2, 'compatibility', True)]
    NodeRecord {
        /// Index of the point, from 0.
        node: usize,
        /// Name of the condition; see ``ShapeReport.nodes``.
        condition: String,
        /// Whether the curve meets it.
        satisfied: bool,
        /// Signed distance from failure, without unit.
        margin: f64,
        /// Parameter at which the margin is smallest.
        location: f64,
    }

    /// How a segment moves about the plane of its four points: information, in no verdict.
    ///
    /// Attributes
    /// ----------
    /// segment : int
    ///     Index of the segment, which requires coplanarity.
    /// crossings : int
    ///     How often it crosses the plane between its points.
    /// least : int
    ///     The least crossings that its end tangents allow: 0 or 1.
    /// satisfied : bool
    ///     Whether there are no more than the least.
    /// amplitude : float
    ///     Greatest distance from the plane over the length of the chord.
    /// location : float
    ///     Parameter of that distance.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.OscillationRecord(0, 1, 1, True, 0.01, 0.5).crossings
    /// 1
    OscillationRecord {
        /// Index of the segment, which requires coplanarity.
        segment: usize,
        /// How often it crosses the plane between its points.
        crossings: usize,
        /// The least crossings that its end tangents allow.
        least: usize,
        /// Whether there are no more than the least.
        satisfied: bool,
        /// Greatest distance from the plane over the length of the chord.
        amplitude: f64,
        /// Parameter of that distance.
        location: f64,
    }
}

impl From<&Record> for ShapeRecord {
    fn from(
        &Record { segment, criterion, applicable, satisfied, margin, location }: &Record,
    ) -> Self {
        Self {
            segment,
            criterion: criterion.name().to_owned(),
            applicable,
            satisfied,
            margin,
            location,
        }
    }
}

impl From<&Undecided> for UndecidedRecord {
    fn from(&Undecided { segment, criterion, interval }: &Undecided) -> Self {
        Self { segment, criterion: criterion.name().to_owned(), interval: interval.into() }
    }
}

impl From<&criteria::NodeRecord> for NodeRecord {
    fn from(r: &criteria::NodeRecord) -> Self {
        let condition = r.condition.name().to_owned();
        Self {
            node: r.node,
            condition,
            satisfied: r.satisfied,
            margin: r.margin,
            location: r.location,
        }
    }
}

impl From<&Oscillation> for OscillationRecord {
    fn from(
        &Oscillation { segment, crossings, least, satisfied, amplitude, location }: &Oscillation,
    ) -> Self {
        Self { segment, crossings, least, satisfied, amplitude, location }
    }
}
