// SPDX-License-Identifier: MIT OR Apache-2.0

//! Places at which many rows are asked: one for all, the same for each, or its own for each.

use pyo3::prelude::*;
use shapespline::monotone::MonotoneError;

use crate::{
    error::{invalid, monotone_error, must},
    input::{Numbers, Offsets, Query, numbers},
};

/// Places for every row, as they come in.
pub(super) struct Places<'py> {
    query: Query<'py>,
    one: [f64; 1],
    pub(super) arrangement: Arrangement,
}

pub(super) enum Arrangement {
    /// One number for all rows.
    One,
    /// The same numbers for all rows.
    Same,
    /// So many numbers for each row.
    Each(usize),
    /// Its own numbers for each row: where they begin.
    Ragged(Vec<usize>),
}

impl<'py> Places<'py> {
    pub(super) fn of(
        argument: &str,
        object: &Bound<'py, PyAny>,
        offsets: Option<Offsets>,
        rows: usize,
    ) -> PyResult<Self> {
        let query = Query::named(argument, object)?;
        let (shape, text, length) = match &query {
            Query::One(_) => (Vec::new(), "()".to_owned(), 1),
            Query::Many(x) => (x.shape().to_vec(), x.shape_text(), x.values().len()),
        };
        let arrangement = match (&shape[..], offsets) {
            ([_], Some(Offsets(bounds))) => {
                check_offsets(&bounds, length)?;
                if bounds.len() != rows + 1 {
                    let rule = format!("have {} entries for {rows} rows", rows + 1);
                    return Err(must("offsets", &[], rule, bounds.len()));
                }
                Arrangement::Ragged(bounds)
            }
            (_, Some(_)) => {
                let text = format!("with offsets, {argument} must have one axis; got shape {text}");
                return Err(invalid(argument, &[], &shape[..], text));
            }
            ([], None) => Arrangement::One,
            ([_], None) => Arrangement::Same,
            ([m, n], None) if *m == rows => Arrangement::Each(*n),
            _ => {
                let text = format!(
                    "{argument} must be a number, have one axis, or be of shape ({rows}, n): a row \
                     for each; got shape {text}"
                );
                return Err(invalid(argument, &[], &shape[..], text));
            }
        };
        let one = [if let Query::One(x) = query { x } else { f64::NAN }];
        Ok(Self { query, one, arrangement })
    }

    pub(super) fn values(&self) -> &[f64] {
        match &self.query {
            Query::One(_) => &self.one,
            Query::Many(x) => x.values(),
        }
    }
}

impl Arrangement {
    /// Those of all the places that are row k's.
    pub(super) fn row<'a>(&self, values: &'a [f64], k: usize) -> &'a [f64] {
        match self {
            Self::One | Self::Same => values,
            Self::Each(n) => &values[k * n..(k + 1) * n],
            Self::Ragged(bounds) => &values[bounds[k]..bounds[k + 1]],
        }
    }
}

/// A number for all rows, or one per row.
pub(super) fn per_row(
    argument: &str,
    object: &Bound<'_, PyAny>,
    rows: usize,
) -> PyResult<Vec<f64>> {
    match numbers(argument, object)? {
        Numbers::One(value) => Ok(vec![value; rows]),
        Numbers::Many(values) if values.len() == rows => Ok(values),
        Numbers::Many(values) => {
            let rule = format!("be a number or one for each of {rows} rows");
            Err(must(argument, &[], rule, values.len()))
        }
    }
}

/// Offsets begin at 0, do not fall, and end at the length of what they cut.
pub(super) fn check_offsets(bounds: &[usize], length: usize) -> PyResult<()> {
    let wrong = (0..bounds.len()).find(|&i| {
        let (first, last) = (i == 0, i + 1 == bounds.len());
        first && bounds[i] != 0
            || !first && bounds[i] < bounds[i - 1]
            || last && bounds[i] != length
    });
    match wrong {
        None => Ok(()),
        Some(index) => {
            let error = MonotoneError::Offset { index, value: bounds[index], length };
            Err(monotone_error(&error))
        }
    }
}
