// SPDX-License-Identifier: MIT OR Apache-2.0

//! Arrays with an axis of interpolation, as columns and back.

use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    error::{Value, invalid, must},
    input::Array,
};

/// The shape of y but for its axis of interpolation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Layout {
    /// Axes before the one of interpolation.
    pub(crate) outer: Vec<usize>,
    /// Axes after it.
    pub(crate) inner: Vec<usize>,
}

impl Layout {
    /// One column.
    pub(crate) const ONE: Self = Self { outer: Vec::new(), inner: Vec::new() };

    /// Of an array with an axis.
    pub(crate) fn of(y: &Array<'_>, axis: isize) -> PyResult<Self> {
        let shape = y.shape();
        let axes = shape.len().cast_signed();
        if axes == 0 {
            let text = "y must have at least one axis, got one number";
            return Err(invalid("y", &[], Value::Nothing, text));
        }
        if !(-axes..axes).contains(&axis) {
            let rule =
                format!("be from {} to {} for y of shape {}", -axes, axes - 1, y.shape_text());
            return Err(must("axis", &[], rule, axis as i64));
        }
        let axis = axis.rem_euclid(axes).cast_unsigned();
        Ok(Self { outer: shape[..axis].to_vec(), inner: shape[axis + 1..].to_vec() })
    }

    pub(crate) fn axis(&self) -> usize {
        self.outer.len()
    }

    pub(crate) fn is_one(&self) -> bool {
        self.outer.is_empty() && self.inner.is_empty()
    }

    /// Whether there are no columns, as in y of shape (n, 0).
    pub(crate) fn is_empty(&self) -> bool {
        self.outer.contains(&0) || self.inner.contains(&0)
    }

    /// Number of columns (none if it does not fit, in damaged bytes).
    pub(crate) fn columns(&self) -> usize {
        let sizes = self.outer.iter().chain(&self.inner);
        sizes.copied().try_fold(1, usize::checked_mul).unwrap_or(0)
    }

    /// Whether this many fits belong to it: one per column, or one of zeros if there are no columns.
    pub(crate) fn is_of(&self, fits: usize) -> bool {
        fits == if self.is_empty() { 1 } else { self.columns() }
    }

    /// The shape with these axes in place of the one of interpolation.
    pub(crate) fn shape(&self, middle: &[usize]) -> Vec<usize> {
        [&self.outer, middle, &self.inner].concat()
    }

    /// The index of entry i of column k.
    pub(crate) fn index(&self, k: usize, i: usize) -> Vec<usize> {
        let mut rest = k;
        let mut parts: Vec<usize> = Vec::new();
        for &size in self.outer.iter().chain(&self.inner).collect::<Vec<_>>().into_iter().rev() {
            parts.push(rest % size.max(1));
            rest /= size.max(1);
        }
        parts.reverse();
        parts.insert(self.axis(), i);
        parts
    }

    /// Column k as Python takes it from an array.
    pub(crate) fn column(&self, k: usize) -> String {
        let mut parts: Vec<String> = self.index(k, 0).iter().map(usize::to_string).collect();
        ":".clone_into(&mut parts[self.axis()]);
        format!("[{}]", parts.join(", "))
    }

    /// C order to column after column, `each` numbers a column.
    pub(crate) fn split(&self, values: &[f64], each: usize) -> Vec<f64> {
        let inner: usize = self.inner.iter().product();
        transpose(values, each, inner)
    }

    /// Column after column to C order.
    pub(crate) fn join(&self, values: Vec<f64>, each: usize) -> Vec<f64> {
        let inner: usize = self.inner.iter().product();
        if self.is_empty() {
            Vec::new()
        } else if inner == 1 {
            values
        } else {
            transpose(&values, inner, each)
        }
    }
}

/// Every block of `rows × columns` numbers, transposed.
fn transpose(values: &[f64], rows: usize, columns: usize) -> Vec<f64> {
    /// Rows and columns of a tile, which the cache holds.
    const TILE: usize = 16;
    if rows * columns == 0 {
        return Vec::new();
    }
    let mut out = vec![0.0; values.len()];
    let blocks = values.chunks_exact(rows * columns).zip(out.chunks_exact_mut(rows * columns));
    for (from, to) in blocks {
        for top in (0..rows).step_by(TILE) {
            for left in (0..columns).step_by(TILE) {
                for i in top..rows.min(top + TILE) {
                    for j in left..columns.min(left + TILE) {
                        to[j * rows + i] = from[i * columns + j];
                    }
                }
            }
        }
    }
    out
}
