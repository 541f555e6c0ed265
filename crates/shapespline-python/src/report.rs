//! The shape report for Python.

use std::{
    hash::{Hash, Hasher},
    sync::{Arc, OnceLock},
};

use pyo3::{
    IntoPyObjectExt,
    exceptions::PyTypeError,
    intern,
    prelude::*,
    types::{PyBytes, PyDict, PyList},
};
use rayon::prelude::*;
use shapespline::criteria::{self, Checker, Criteria, Record, Tolerances};

use crate::{curve::Curve, error::input_error, pickle, work::detached};

/// Segments a task when records are made.
const BLOCK: usize = 2048;

/// One criterion on one segment: whether it applies, whether it holds, and by how much.
///
/// Attributes
/// ----------
/// segment : int
///     Index of the segment, from 0; it runs from node ``segment`` to node ``segment + 1``.
/// criterion : str
///     Name of the criterion.
/// applicable : bool
///     Whether the data polygon calls for the criterion on this segment.
/// satisfied : bool
///     Whether the curve meets it, decided exactly; true where it does not apply.
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
#[pyclass(module = "shapespline", frozen, get_all, eq, hash)]
#[derive(Debug, Clone)]
pub(crate) struct ShapeRecord {
    /// Index of the segment, from 0.
    segment: usize,
    /// Name of the criterion.
    criterion: String,
    /// Whether the data polygon calls for the criterion on this segment.
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
    #[new]
    fn new(
        segment: usize,
        criterion: String,
        applicable: bool,
        satisfied: bool,
        margin: f64,
        location: f64,
    ) -> Self {
        Self { segment, criterion, applicable, satisfied, margin, location }
    }

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

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let r = slf.get();
        let arguments = (r.segment, &r.criterion, r.applicable, r.satisfied, r.margin, r.location);
        Ok((slf.get_type().into_any(), arguments.into_bound_py_any(slf.py())?))
    }
}

/// What a check of a curve's shape found; made by the method ``check`` of a curve.
///
/// Holds the violations and counts; the records of all segments are made when asked for. Prints as a
/// table. Immutable and picklable.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> report = ss.NuSpline(points, "uniform").check()
/// >>> report.ok, report.counts()["convexity"]
/// (False, (2, 2))
/// >>> [(v.criterion, v.segment) for v in report.violations]
/// [('convexity', 1), ('torsion', 1), ('convexity', 2), ('torsion', 2)]
/// >>> ss.NuSpline.shape_preserving(points, "uniform").check().ok
/// True
#[pyclass(module = "shapespline", frozen)]
pub(crate) struct ShapeReport {
    pub(crate) report: criteria::ShapeReport,
    pub(crate) curve: Arc<dyn Curve>,
    pub(crate) criteria: Criteria,
    pub(crate) tolerances: Tolerances,
    margin: OnceLock<f64>,
}

impl ShapeReport {
    pub(crate) fn of(
        report: criteria::ShapeReport,
        curve: Arc<dyn Curve>,
        criteria: Criteria,
        tolerances: Tolerances,
    ) -> Self {
        Self { report, curve, criteria, tolerances, margin: OnceLock::new() }
    }

    /// Makes something of the records of every segment, criterion by criterion, in order.
    fn records<T: Send>(
        &self,
        py: Python<'_>,
        make: impl Fn(Record) -> T + Send + Sync,
    ) -> PyResult<Vec<T>> {
        let segments = self.curve.cubic().segments();
        let records = detached(py, segments, || {
            let polygon = self.curve.polygon()?;
            let checker = Checker::new(&polygon, self.criteria, self.tolerances);
            let legs = self.curve.cubic().legs();
            let of = |i: usize| {
                let located = |record| self.curve.located(record);
                let record = |criterion| make(located(checker.record(i, legs[i], criterion)));
                self.criteria.iter().map(record).collect::<Vec<T>>()
            };
            Ok(if segments <= 2 * BLOCK {
                (0..segments).flat_map(of).collect()
            } else {
                (0..segments).into_par_iter().with_min_len(BLOCK).flat_map_iter(of).collect()
            })
        });
        records.map_err(input_error)
    }
}

/// A record as a plain dictionary; what is not a number becomes `None`, for JSON has no NaN.
fn plain<'py>(py: Python<'py>, r: &Record) -> PyResult<Bound<'py, PyDict>> {
    let number = |x: f64| x.is_finite().then_some(x);
    let dict = PyDict::new(py);
    dict.set_item(intern!(py, "segment"), r.segment)?;
    dict.set_item(intern!(py, "criterion"), r.criterion.name())?;
    dict.set_item(intern!(py, "applicable"), r.applicable)?;
    dict.set_item(intern!(py, "satisfied"), r.satisfied)?;
    dict.set_item(intern!(py, "margin"), number(r.margin))?;
    dict.set_item(intern!(py, "location"), number(r.location))?;
    Ok(dict)
}

#[pymethods]
impl ShapeReport {
    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err("a ShapeReport is made by the method check() of a curve"))
    }

    /// Whether every criterion that applies is satisfied.
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

    /// Records that could not be decided: an empty list, for on cubics every criterion is decided
    /// exactly.
    #[getter]
    fn undecided(&self) -> Vec<ShapeRecord> {
        Vec::new()
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
        for criterion in self.criteria.iter() {
            let count = self.report.count(criterion);
            counts.set_item(criterion.name(), (count.violated, count.applicable))?;
        }
        Ok(counts)
    }

    /// The report as plain data that ``json.dumps`` takes.
    ///
    /// Returns
    /// -------
    /// dict
    ///     ``ok``, ``margin``, ``counts`` (criterion to ``violated`` and ``applicable``),
    ///     ``coplanarity``, ``collinearity``, ``tolerance``, and the lists of records ``segments``,
    ///     ``violations`` and ``undecided``. A margin or location that does not exist is ``None``.
    ///
    /// Examples
    /// --------
    /// >>> import json
    /// >>> import shapespline as ss
    /// >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check()
    /// >>> json.loads(json.dumps(report.to_dict(), allow_nan=False))["ok"]
    /// True
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counts = PyDict::new(py);
        for criterion in self.criteria.iter() {
            let count = self.report.count(criterion);
            let entry = PyDict::new(py);
            entry.set_item("violated", count.violated)?;
            entry.set_item("applicable", count.applicable)?;
            counts.set_item(criterion.name(), entry)?;
        }
        let (segments, violations) = (PyList::empty(py), PyList::empty(py));
        for record in self.records(py, |r| r)? {
            segments.append(plain(py, &record)?)?;
        }
        for record in &self.report.violations {
            violations.append(plain(py, record)?)?;
        }
        let margin = self.margin(py)?;
        let dict = PyDict::new(py);
        dict.set_item("ok", self.report.ok())?;
        dict.set_item("margin", margin.is_finite().then_some(margin))?;
        dict.set_item("counts", counts)?;
        dict.set_item("coplanarity", self.tolerances.coplanarity)?;
        dict.set_item("collinearity", self.tolerances.collinearity)?;
        dict.set_item("tolerance", self.tolerances.zero)?;
        dict.set_item("segments", segments)?;
        dict.set_item("violations", violations)?;
        dict.set_item("undecided", PyList::empty(py))?;
        Ok(dict)
    }

    /// The records of all segments as a pandas DataFrame.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///     One row a segment and criterion, with the attributes of `ShapeRecord` as columns.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If pandas is not installed (``pip install "shapespline[pandas]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> frame = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check().to_dataframe()
    /// >>> list(frame.columns)
    /// ['segment', 'criterion', 'applicable', 'satisfied', 'margin', 'location']
    fn to_dataframe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let pandas = py.import("pandas")?;
        let records = self.records(py, |r| r)?;
        let columns = PyDict::new(py);
        let usize_column = records.iter().map(|r| r.segment as i64).collect::<Vec<_>>();
        columns.set_item("segment", numpy::PyArray1::from_vec(py, usize_column))?;
        let names: Vec<&str> = records.iter().map(|r| r.criterion.name()).collect();
        columns.set_item("criterion", names)?;
        let flags = |of: fn(&Record) -> bool| {
            numpy::PyArray1::from_vec(py, records.iter().map(of).collect())
        };
        columns.set_item("applicable", flags(|r| r.applicable))?;
        columns.set_item("satisfied", flags(|r| r.satisfied))?;
        let floats = |of: fn(&Record) -> f64| {
            numpy::PyArray1::from_vec(py, records.iter().map(of).collect())
        };
        columns.set_item("margin", floats(|r| r.margin))?;
        columns.set_item("location", floats(|r| r.location))?;
        pandas.getattr("DataFrame")?.call1((columns,))
    }

    fn __str__(&self) -> String {
        self.report.to_string().trim_end().to_owned()
    }

    fn __repr__(&self) -> String {
        let (verdict, n) =
            (if self.report.ok() { "preserved" } else { "violated" }, self.report.segments);
        match self.report.violations.len() {
            0 => format!("<ShapeReport: shape {verdict} on {n} segments>"),
            count => format!("<ShapeReport: shape {verdict} on {n} segments, {count} violations>"),
        }
    }

    fn _repr_html_(&self) -> String {
        let mut rows = String::new();
        for criterion in self.criteria.iter() {
            let count = self.report.count(criterion);
            rows += &format!(
                "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
                criterion.name(),
                count.violated,
                count.applicable
            );
        }
        let verdict = if self.report.ok() { "preserved" } else { "violated" };
        format!(
            "<table><caption>shape {verdict} on {} segments</caption><thead><tr><th>criterion</th>\
             <th>violated</th><th>applicable</th></tr></thead><tbody>{rows}</tbody></table>",
            self.report.segments
        )
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let make = py.import("shapespline._core")?.getattr("_report_from_bytes")?;
        let bytes = detached(py, 0, || pickle::write_report(self))?;
        Ok((make, (PyBytes::new(py, &bytes),)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
