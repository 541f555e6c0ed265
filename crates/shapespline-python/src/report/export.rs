// SPDX-License-Identifier: MIT OR Apache-2.0

//! The report in other forms: plain data, a data frame, a table for notebooks.

use pyo3::{
    intern,
    prelude::*,
    types::{PyDict, PyList},
};
use shapespline::criteria::Record;

use super::ShapeReport;

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
    /// Return the report as plain data that ``json.dumps`` takes.
    ///
    /// Returns
    /// -------
    /// dict
    ///     ``ok``, ``margin``, ``counts`` (criterion to ``violated`` and ``applicable``),
    ///     ``resolution``, ``coplanarity``, ``collinearity``, ``tolerance``, and the lists ``segments``, ``violations``
    ///     (records), ``undecided`` (``segment``, ``criterion``, ``interval``) and ``straight``. A margin
    ///     or location that does not exist is ``None``.
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
        for criterion in self.report.listed().iter() {
            let count = self.report.count(criterion);
            let entry = PyDict::new(py);
            entry.set_item("violated", count.violated)?;
            entry.set_item("applicable", count.applicable)?;
            counts.set_item(criterion.name(), entry)?;
        }
        let (segments, violations) = (PyList::empty(py), PyList::empty(py));
        let undecided = PyList::empty(py);
        for record in self.records(py, |r| r)? {
            segments.append(plain(py, &record)?)?;
        }
        for record in &self.report.violations {
            violations.append(plain(py, record)?)?;
        }
        for open in &self.report.undecided {
            let dict = PyDict::new(py);
            dict.set_item(intern!(py, "segment"), open.segment)?;
            dict.set_item(intern!(py, "criterion"), open.criterion.name())?;
            dict.set_item(intern!(py, "interval"), open.interval.to_vec())?;
            undecided.append(dict)?;
        }
        let margin = self.margin(py)?;
        let dict = PyDict::new(py);
        dict.set_item("ok", self.report.ok())?;
        dict.set_item("margin", margin.is_finite().then_some(margin))?;
        dict.set_item("counts", counts)?;
        dict.set_item("resolution", self.asked.tolerances.resolution)?;
        dict.set_item("coplanarity", self.asked.tolerances.coplanarity)?;
        dict.set_item("collinearity", self.asked.tolerances.collinearity)?;
        dict.set_item("tolerance", self.asked.tolerances.zero)?;
        dict.set_item("segments", segments)?;
        dict.set_item("violations", violations)?;
        dict.set_item("undecided", undecided)?;
        dict.set_item("straight", self.report.straight.clone())?;
        Ok(dict)
    }

    /// Return the records of all segments as a pandas DataFrame.
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

    fn _repr_html_(&self) -> String {
        let mut rows = String::new();
        for criterion in self.report.listed().iter() {
            let count = self.report.count(criterion);
            rows += &format!(
                "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
                criterion.name(),
                count.violated,
                count.applicable
            );
        }
        format!(
            "<table><caption>shape {} on {} segments</caption><thead><tr><th>criterion</th>\
             <th>violated</th><th>applicable</th></tr></thead><tbody>{rows}</tbody></table>",
            self.verdict(),
            self.report.segments
        )
    }
}
