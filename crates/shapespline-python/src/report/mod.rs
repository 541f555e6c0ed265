// SPDX-License-Identifier: MIT OR Apache-2.0

//! The shape report for Python: what was found, and what is made of it when asked for.
//!
//! [`record`] is one line of it, [`subject`] what it is about, [`comparison`] how fair the curve is, [`export`] its
//! other forms.

use std::sync::OnceLock;

use pyo3::{
    exceptions::PyTypeError,
    prelude::*,
    types::{PyDict, PyTuple},
};
use shapespline::{
    criteria::{self, Record},
    geometry::Fairness,
    polynomial::parallel,
};

use crate::{
    asked::Asked,
    curve::boundary_object,
    error::subject_error,
    pickle::{self, PickledKind, Reduced},
    work::{GoOn, PARALLEL, interrupted, interruptible},
};

mod comparison;
mod export;
mod record;
mod subject;

use comparison::{Comparison, Cost};

pub(crate) use record::{NodeRecord, OscillationRecord, ShapeRecord, UndecidedRecord};
pub(crate) use subject::Subject;

/// Most segments of which a printed report measures the fairness: 130 µs each, twice, on a busy machine.
const MEASURED: usize = 1000;

/// What a check of a curve's shape found; made by `check_shape` and by the method ``check`` of a curve.
///
/// Holds the violations, what stays open, and counts; the records of all segments and the notes on
/// nodes are made when asked for. Prints as a table, with the energy ∫κ²ds and the largest curvature of
/// the curve, if it has at most 1000 segments, beside those of the C² cubic spline with the same parameters
/// and ends; the criterion that costs most energy, where the C² cubic violates it; and the points that are
/// practically corners, where curvature times chord exceeds 100. Immutable and picklable.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> report = ss.NuSpline(points, "uniform").check()
/// >>> report.ok, report.counts()["convexity"]
/// (False, (2, 2))
/// >>> [(v.criterion, v.segment) for v in report.violations]
/// [('convexity', 1), ('turning', 1), ('torsion', 1), ('convexity', 2), ('turning', 2), ('torsion', 2)]
/// >>> ss.NuSpline.shape_preserving(points, "uniform").check().ok
/// True
#[pyclass(module = "shapespline", frozen, weakref)]
pub(crate) struct ShapeReport {
    pub(crate) report: criteria::ShapeReport,
    pub(crate) subject: Subject,
    pub(crate) asked: Asked,
    margin: OnceLock<f64>,
}

impl ShapeReport {
    pub(crate) fn of(report: criteria::ShapeReport, subject: Subject, asked: Asked) -> Self {
        // What is asked without being named is listed where it fails.
        let report = criteria::ShapeReport { criteria: asked.criteria, ..report };
        Self { report, subject, asked, margin: OnceLock::new() }
    }

    /// Checks a subject.
    pub(crate) fn make(py: Python<'_>, subject: Subject, asked: Asked) -> PyResult<Self> {
        let check = |go_on: GoOn<'_>| subject.judge(asked, |judge| judge.report(go_on));
        let report = interruptible(py, subject.segments(), check)?.map_err(subject_error)?;
        Ok(Self::of(report.ok_or_else(interrupted)?, subject, asked))
    }

    /// Makes something of the records of every segment, criterion by criterion, in order.
    fn records<T: Send>(
        &self,
        py: Python<'_>,
        make: impl Fn(Record) -> T + Send + Sync,
    ) -> PyResult<Vec<T>> {
        let segments = self.subject.segments();
        let records = interruptible(py, segments, |go_on| {
            self.subject.judge(self.asked, |judge| {
                let of = |i: usize| {
                    let record = |criterion| make(judge.record(i, criterion));
                    // What is missing after Ctrl-C nobody sees.
                    let listed = go_on().is_continue().then(|| self.report.listed());
                    listed.iter().flat_map(|listed| listed.iter()).map(record).collect::<Vec<T>>()
                };
                let all: Vec<Vec<T>> =
                    parallel::blocks(segments, PARALLEL / 2, |block| block.flat_map(of).collect());
                all.into_iter().flatten().collect()
            })
        });
        records?.map_err(subject_error)
    }

    /// The verdict in a word.
    fn verdict(&self) -> &'static str {
        self.report.verdict()
    }

    /// What the paper says of nodes and of oscillation.
    fn node_conditions(&self, py: Python<'_>) -> PyResult<criteria::NodeConditions> {
        let make =
            |go_on: GoOn<'_>| self.subject.judge(self.asked, |judge| judge.node_conditions(go_on));
        let notes = interruptible(py, self.subject.segments(), make)?.map_err(subject_error)?;
        notes.ok_or_else(interrupted)
    }
}

#[pymethods]
impl ShapeReport {
    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err(
            "a ShapeReport is made by check_shape(), or by the method check() of a curve",
        ))
    }

    /// Whether no criterion that applies is violated; what rounding hides is ``undecided``.
    #[getter]
    fn ok(&self) -> bool {
        self.report.ok()
    }

    /// The smallest margin of all records that apply: positive when the shape is preserved.
    ///
    /// A number without unit; infinite when nothing applies. Cost O(N) at the first access.
    #[getter]
    fn margin(&self, py: Python<'_>) -> PyResult<f64> {
        if let Some(margin) = self.margin.get() {
            return Ok(*margin);
        }
        let margins = self.records(py, |r| if r.applicable { r.margin } else { f64::INFINITY })?;
        let margin = margins.into_iter().fold(f64::INFINITY, f64::min);
        Ok(*self.margin.get_or_init(|| margin))
    }

    /// The violations, ascending by segment: a list of `ShapeRecord`.
    #[getter]
    fn violations(&self) -> Vec<ShapeRecord> {
        self.report.violations.iter().map(ShapeRecord::from).collect()
    }

    /// One `ShapeRecord` a segment and criterion asked for, by segment: a list.
    ///
    /// The list is made anew at each access, cost O(N): keep it in a variable.
    #[getter]
    fn segments(&self, py: Python<'_>) -> PyResult<Vec<ShapeRecord>> {
        self.records(py, |r| ShapeRecord::from(&r))
    }

    /// The segments on which the curve is straight by construction (``FairSpline(straight=True)``), a tuple
    /// of indices: at their ends turning and torsion may be zero.
    #[getter]
    fn straight<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.report.straight)
    }

    /// What could be neither proved nor refuted, ascending by segment: a list of `UndecidedRecord`.
    ///
    /// A sign that is zero to rounding of the arithmetic, or of control points written with 15 significant
    /// digits, can stay open; such a record is not counted as violated, and in ``segments`` it is not
    /// satisfied and has margin 0.
    #[getter]
    fn undecided(&self) -> Vec<UndecidedRecord> {
        self.report.undecided.iter().map(UndecidedRecord::from).collect()
    }

    /// What the paper says of the nodes beyond the criteria, as information: a list of `NodeRecord`.
    ///
    /// ``"compatibility"``: the tangent lies between the chords, seen along the binormal vector
    /// ((12.1) of Gautam). ``"same-torsion"``: torsion of the polygon's sign on both sides
    /// (Definition 9.2, item 2). ``"torsion-change"``: torsion that vanishes or jumps where the
    /// polygon's changes sign (Theorem 12.1). ``"convex-neighbourhood"`` and
    /// ``"inflection-neighbourhood"``: the conditions of Definition 8.2 around three points on a line;
    /// a curve through the middle one can meet the first with equality only, by being straight.
    /// ``"neighbourhood-torsion"`` and ``"neighbourhood-coplanarity"``: what that definition asks of
    /// the two segments around the middle point together, by the four points that are left; near the
    /// plane of a convex neighbourhood the binormal may flip, for there the curve has to inflect.
    ///
    /// None of them enters ``ok`` or ``counts``. Made anew at each access; cost O(N), much slower than
    /// the check.
    #[getter]
    fn nodes(&self, py: Python<'_>) -> PyResult<Vec<NodeRecord>> {
        Ok(self.node_conditions(py)?.nodes.iter().map(NodeRecord::from).collect())
    }

    /// How the segments that require coplanarity move about their plane, as information: a list of
    /// `OscillationRecord` (Gautam, section 10).
    ///
    /// Made anew at each access, as ``nodes``.
    #[getter]
    fn oscillations(&self, py: Python<'_>) -> PyResult<Vec<OscillationRecord>> {
        Ok(self.node_conditions(py)?.oscillations.iter().map(OscillationRecord::from).collect())
    }

    /// The end conditions that the points were judged with: ``"zero-curvature"``, ``"periodic"``,
    /// ``"circular"`` or a `Tangents`.
    ///
    /// They say what stands in for the missing chord at each end, and so what the first and the last
    /// segment are asked.
    #[getter]
    fn boundary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.subject {
            Subject::Own(curve) => boundary_object(py, curve.boundary(), curve.cubic().dimension()),
            Subject::Other { polygon, .. } => {
                boundary_object(py, polygon.boundary(), polygon.dimension())
            }
        }
    }

    /// How often each criterion asked for is violated, and how often it applies.
    ///
    /// Returns
    /// -------
    /// dict[str, tuple[int, int]]
    ///     Criterion to (violated, applicable), counted in segments.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check(["inflection"])
    /// >>> report.counts()
    /// {'inflection': (0, 1)}
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counts = PyDict::new(py);
        for criterion in self.report.listed().iter() {
            let count = self.report.count(criterion);
            counts.set_item(criterion.name(), (count.violated, count.applicable))?;
        }
        Ok(counts)
    }

    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        let mut text = self.report.to_string().trim_end().to_owned();
        let segments = self.subject.segments();
        if segments > MEASURED {
            return Ok(text);
        }
        let compare = |go_on: GoOn<'_>| Comparison::of(&self.subject, go_on);
        if let Some(found) = interruptible(py, segments, compare)? {
            let [own, cubic] = [&found.own_fairness, &found.cubic_fairness];
            let line = |name: &str, measure: fn(&Fairness) -> f64| {
                format!("\n{name:<17}{:>10.3e}{:>12.3e}", measure(own), measure(cubic))
            };
            text += &format!("\n{:<17}{:>10}{:>12}", "fairness", "curve", "C² cubic");
            text += &line("energy ∫κ²ds", |found| found.bending / found.length);
            text += &line("max. curvature", |found| found.max_curvature);
            if let Some(Cost { criterion, segments, own, cubic }) = found.costliest(self.asked) {
                let place = if segments == 1 {
                    "the segment where the C² cubic violates it".to_owned()
                } else {
                    format!("the {segments} segments where the C² cubic violates it")
                };
                let name = criterion.name();
                text += &format!(
                    "\ncosts most: {name} (energy {own:.3e} instead of {cubic:.3e} around {place})"
                );
            }
            let sharp = found.sharp_points();
            if !sharp.is_empty() {
                let few: Vec<String> = sharp.iter().take(8).map(usize::to_string).collect();
                let more = if sharp.len() > few.len() { ", …" } else { "" };
                let points = if sharp.len() == 1 { "point" } else { "points" };
                text += &format!("\npractically corners: {points} {}{more}", few.join(", "));
            }
        }
        Ok(text)
    }

    fn __repr__(&self) -> String {
        let mut text =
            format!("<ShapeReport: shape {} on {}", self.verdict(), self.report.segments);
        text += if self.report.segments == 1 { " segment" } else { " segments" };
        let found = [
            (self.report.violations.len(), "violation", "violations"),
            (self.report.undecided.len(), "undecided", "undecided"),
        ];
        for (count, one, many) in found {
            match count {
                0 => {}
                1 => text += &format!(", 1 {one}"),
                _ => text += &format!(", {count} {many}"),
            }
        }
        text + ">"
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickle::reduce(py, PickledKind::Report, |bytes| pickle::write_report(self, bytes))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
