// SPDX-License-Identifier: MIT OR Apache-2.0

//! Tension as users give it: checked once, for every family.

use shapespline_geometry::{DataPolygon, InputError};

/// Tension at the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tension<'a> {
    /// The same at every node.
    Uniform(f64),
    /// One number a point; for closed data the last is the first again.
    Nodes(&'a [f64]),
}

impl Tension<'_> {
    /// One value a distinct node of a polygon, each checked; `argument` and `allowed` are what
    /// errors call it.
    ///
    /// # Errors
    /// A value that is not valid, not one a point, or of closed data a last value unlike the first.
    pub fn nodal(
        self,
        polygon: &DataPolygon,
        argument: &'static str,
        allowed: &'static str,
        valid: impl Fn(f64) -> bool,
    ) -> Result<Vec<f64>, InputError> {
        match self {
            Self::Uniform(value) if valid(value) => Ok(vec![value; polygon.nodes()]),
            Self::Uniform(value) => Err(InputError::Scalar { argument, value, allowed }),
            Self::Nodes(values) => {
                let (expected, found) = (polygon.points().len(), values.len());
                if found != expected {
                    let per = "one for each point";
                    return Err(InputError::Length { argument, expected, found, per });
                }
                let wrong = |index: usize, allowed| {
                    let value = values[index];
                    Err(InputError::OutOfRange { argument, index, value, allowed })
                };
                if let Some(index) = values.iter().position(|&x| !valid(x)) {
                    return wrong(index, allowed);
                }
                if polygon.is_closed() && values[expected - 1] != values[0] {
                    let (last, start, end) = (expected - 1, values[0], values[expected - 1]);
                    return Err(InputError::Unequal { argument, last, start, end });
                }
                Ok(values[..polygon.nodes()].to_vec())
            }
        }
    }

    /// As [`Tension::nodal`], for tensions that may be any number from 0.
    ///
    /// # Errors
    /// As [`Tension::nodal`].
    pub fn non_negative(self, polygon: &DataPolygon) -> Result<Vec<f64>, InputError> {
        let valid = |x: f64| x >= 0.0 && x.is_finite();
        self.nodal(polygon, "tension", "non-negative and finite", valid)
    }
}

/// One value a point from one a distinct node: of closed data the first stands for the last again.
#[must_use]
pub fn repeat_first_if_closed(mut values: Vec<f64>, closed: bool) -> Vec<f64> {
    if closed {
        values.extend(values.first().copied());
    }
    values
}
