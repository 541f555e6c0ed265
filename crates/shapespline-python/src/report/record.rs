// SPDX-License-Identifier: MIT OR Apache-2.0

//! The record of one criterion on one segment.

use std::hash::{Hash, Hasher};

use pyo3::prelude::*;
use shapespline::criteria::Record;

use crate::pickle::{self, PickledKind, Reduced};

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
#[pyclass(module = "shapespline", frozen, get_all, eq, hash, weakref)]
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct ShapeRecord {
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

impl ShapeRecord {
    /// Everything that tells one record from another; NaN equals itself here.
    fn key(&self) -> (usize, &str, bool, bool, u64, u64) {
        let (margin, location) = (self.margin.to_bits(), self.location.to_bits());
        (self.segment, &self.criterion, self.applicable, self.satisfied, margin, location)
    }
}

impl PartialEq for ShapeRecord {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Hash for ShapeRecord {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl From<&Record> for ShapeRecord {
    fn from(r: &Record) -> Self {
        Self {
            segment: r.segment,
            criterion: r.criterion.name().to_owned(),
            applicable: r.applicable,
            satisfied: r.satisfied,
            margin: r.margin,
            location: r.location,
        }
    }
}

#[pymethods]
impl ShapeRecord {
    fn __repr__(&self) -> String {
        let python = |b| if b { "True" } else { "False" };
        format!(
            "ShapeRecord(segment={}, criterion='{}', applicable={}, satisfied={}, margin={:.6}, \
             location={:.6})",
            self.segment,
            self.criterion,
            python(self.applicable),
            python(self.satisfied),
            self.margin,
            self.location
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::ShapeRecord)
    }
}
