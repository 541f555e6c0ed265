// SPDX-License-Identifier: MIT OR Apache-2.0

//! Checks of any function, and the report on them.

use pyo3::{
    exceptions::PyTypeError,
    prelude::*,
    types::{PyDict, PyList},
};
use shapespline::{
    geometry::{self, Dimension},
    monotone,
};

use super::options::{self, ConvexOption};
use crate::{
    error::{Value, invalid, monotone_error, must},
    input::array,
    options::tolerance,
    pickle::{self, PickledKind, Reduced},
    piecewise::PiecewiseBezier,
    record::record,
    work::without_gil,
};

/// Violations that a printed report lists before it only counts them.
const LISTED: usize = 20;

/// How far the parameter of a graph may be from x, relative to the extent of x.
const GRAPH: f64 = 1e-9;

record! {
    /// A criterion on a segment.
    ///
    /// ``margin`` is the least value there of f'/(Δy/Δx) (monotonicity), or of f'' in the direction
    /// asked relative to the changes of the secants beside it (convexity), at ``location``; below 0
    /// the criterion is violated. ``satisfied`` is None where rounding hides it.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> report = ss.check_monotone([0, 1], [0, 2], ss.MonotoneCubic([0, 1], [0, 2]))
    /// >>> report.segments[0].criterion, round(report.segments[0].margin, 12)
    /// ('monotonicity', 1.0)
    MonotoneRecord {
        /// Index of the segment, from 0.
        segment: usize,
        /// ``"monotonicity"`` or ``"convexity"``.
        criterion: String,
        /// Whether the function meets it; None where rounding hides it.
        satisfied: Option<bool>,
        /// Signed distance from failure, without unit.
        margin: f64,
        /// The x at which the margin is smallest.
        location: f64,
    }
}

/// Whether a function rises, falls and bends as its data do: what `check_monotone` gives.
///
/// ``print(report)`` lists the violations. Truth is refused: ask ``ok``.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> print(ss.check_monotone([0, 1], [0, 2], ss.MonotoneCubic([0, 1], [0, 2])))
/// shape preserved on 1 segments
/// criterion         violated  applicable
/// monotonicity             0           1
#[pyclass(module = "shapespline", frozen, weakref)]
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct MonotoneReport(monotone::MonotoneReport);

impl MonotoneReport {
    /// The records with a property.
    fn records(&self, of: impl Fn(Option<bool>) -> bool) -> Vec<MonotoneRecord> {
        let each =
            self.0.criteria().flat_map(|(name, records)| records.iter().map(move |r| (name, r)));
        let chosen = each.filter(|(_, r)| of(r.satisfied));
        let make = |(name, r): (&str, &monotone::MonotoneRecord)| MonotoneRecord {
            segment: r.segment,
            criterion: name.to_owned(),
            satisfied: r.satisfied,
            margin: r.margin,
            location: r.location,
        };
        chosen.map(make).collect()
    }

    /// By criterion, on how many segments it is violated, and on how many it is asked.
    fn counted(&self) -> impl Iterator<Item = (&'static str, [usize; 2])> {
        let violated = |r: &&monotone::MonotoneRecord| r.satisfied == Some(false);
        let count = move |records: &[monotone::MonotoneRecord]| {
            [records.iter().filter(violated).count(), records.len()]
        };
        self.0.criteria().map(move |(name, records)| (name, count(records)))
    }
}

/// A record as a plain dictionary; what is not a number becomes `None`, for JSON has no NaN.
fn plain<'py>(py: Python<'py>, r: &MonotoneRecord) -> PyResult<Bound<'py, PyDict>> {
    let number = |x: f64| x.is_finite().then_some(x);
    let dict = PyDict::new(py);
    dict.set_item("segment", r.segment)?;
    dict.set_item("criterion", &r.criterion)?;
    dict.set_item("applicable", true)?;
    dict.set_item("satisfied", r.satisfied)?;
    dict.set_item("margin", number(r.margin))?;
    dict.set_item("location", number(r.location))?;
    Ok(dict)
}

#[pymethods]
impl MonotoneReport {
    /// Whether nothing is violated for certain.
    #[getter]
    fn ok(&self) -> bool {
        self.counted().all(|(_, [violated, _])| violated == 0)
    }

    /// A record of every segment and criterion that is asked of it.
    #[getter]
    fn segments(&self) -> Vec<MonotoneRecord> {
        self.records(|_| true)
    }

    /// The records of what is violated for certain.
    #[getter]
    fn violations(&self) -> Vec<MonotoneRecord> {
        self.records(|satisfied| satisfied == Some(false))
    }

    /// The records of what rounding hides.
    #[getter]
    fn undecided(&self) -> Vec<MonotoneRecord> {
        self.records(|satisfied| satisfied.is_none())
    }

    /// Return on how many segments each criterion is violated, and on how many it is asked.
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counts = PyDict::new(py);
        for (name, [violated, asked]) in self.counted() {
            counts.set_item(name, (violated, asked))?;
        }
        Ok(counts)
    }

    /// Return plain data in the form of ``ShapeReport.to_dict``.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counts = PyDict::new(py);
        for (name, [violated, asked]) in self.counted() {
            let entry = PyDict::new(py);
            entry.set_item("violated", violated)?;
            entry.set_item("applicable", asked)?;
            counts.set_item(name, entry)?;
        }
        let list = |records: Vec<MonotoneRecord>| {
            let plain: PyResult<Vec<_>> = records.iter().map(|r| plain(py, r)).collect();
            PyList::new(py, plain?)
        };
        let segments = self.segments();
        let margin = segments.iter().map(|r| r.margin).fold(f64::INFINITY, f64::min);
        let dict = PyDict::new(py);
        dict.set_item("ok", self.ok())?;
        dict.set_item("margin", margin.is_finite().then_some(margin))?;
        dict.set_item("counts", counts)?;
        dict.set_item("tolerance", self.0.tolerance)?;
        dict.set_item("segments", list(segments)?)?;
        dict.set_item("violations", list(self.violations())?)?;
        dict.set_item("undecided", list(self.undecided())?)?;
        Ok(dict)
    }

    fn __bool__(&self) -> PyResult<bool> {
        let text = "the truth of a MonotoneReport is ambiguous: use report.ok";
        Err(PyTypeError::new_err(text))
    }

    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        let number = |x: f64, form: &str| -> PyResult<String> {
            x.into_pyobject(py)?.call_method1("__format__", (form,))?.extract()
        };
        let verdict = if self.ok() { "preserved" } else { "violated" };
        let mut text = format!("shape {verdict} on {} segments", self.0.monotonicity.len());
        text += &format!("\n{:<16}{:>10}{:>12}", "criterion", "violated", "applicable");
        for (name, [violated, asked]) in self.counted() {
            text += &format!("\n{name:<16}{violated:>10}{asked:>12}");
        }
        let violations = self.violations();
        if !violations.is_empty() {
            text +=
                &format!("\n\n{:<16}{:>10}{:>12}{:>16}", "violated", "segment", "margin", "at x");
        }
        for r in violations.iter().take(LISTED) {
            let [margin, x] = [number(r.margin, "12.3e")?, number(r.location, "16.12g")?];
            text += &format!("\n{:<16}{:>10}{margin}{x}", r.criterion, r.segment);
        }
        if violations.len() > LISTED {
            text += &format!("\n… and {} more", violations.len() - LISTED);
        }
        match self.undecided().len() {
            0 => {}
            hidden => text += &format!("\nundecided within rounding: {hidden}"),
        }
        Ok(text)
    }

    fn __repr__(&self) -> String {
        let verdict = if self.ok() { "preserved" } else { "violated" };
        format!("<MonotoneReport: shape {verdict} on {} segments>", self.0.monotonicity.len())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::MonotoneReport)
    }
}

/// The Bernstein coefficients of a function, piece after piece, of its graph.
fn coefficients(curve: &geometry::PiecewiseBezier, extent: f64) -> PyResult<Vec<f64>> {
    let refused =
        |rule: &str| invalid("function", &[], Value::Nothing, format!("function must {rule}"));
    if curve.is_rational() || curve.dimension() != Dimension::Two {
        return Err(refused("be a polynomial graph of a function, in the plane"));
    }
    let (degree, breaks) = (curve.degree(), curve.breaks());
    let mut values = Vec::with_capacity(curve.pieces() * (degree + 1));
    for (i, ends) in breaks.windows(2).enumerate() {
        for (k, point) in curve.piece(i).iter().enumerate() {
            let t = k as f64 / degree as f64;
            let x = ends[0] * (1.0 - t) + ends[1] * t;
            if !((point.x - x).abs() <= GRAPH * extent) {
                let rule = "be a graph of a function, whose parameter is x; the parameter of piece";
                return Err(refused(&format!("{rule} {i} is not")));
            }
            values.push(point.y);
        }
    }
    Ok(values)
}

/// Return the report on data and the graph of a function.
#[pyfunction]
pub(crate) fn _check_monotone(
    py: Python<'_>,
    x: &Bound<'_, PyAny>,
    y: &Bound<'_, PyAny>,
    function: &Bound<'_, PiecewiseBezier>,
    #[pyo3(from_py_with = options::convex)] convex: ConvexOption,
    #[pyo3(from_py_with = tolerance)] tolerance: f64,
) -> PyResult<MonotoneReport> {
    let (x, y) = (array("x", x)?, array("y", y)?);
    if x.shape().len() != 1 {
        return Err(must("x", &[], "have one axis", x.shape()));
    }
    if y.shape() != x.shape() {
        return Err(must("y", &[], "have the shape of x", y.shape()));
    }
    let convex = convex.columns(&y, 0, [1, x.values().len()])?;
    let (x, y, curve) = (x.values(), y.values(), &function.get().curve);
    let extent = x.first().zip(x.last()).map_or(0.0, |(first, last)| last - first);
    let values = coefficients(curve, extent)?;
    let report = without_gil(py, x.len(), || {
        monotone::check_monotone(x, y, curve.breaks(), &values, convex[0].as_ref(), tolerance)
    });
    report.map(MonotoneReport).map_err(|error| monotone_error(&error))
}
