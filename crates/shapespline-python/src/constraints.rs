// SPDX-License-Identifier: MIT OR Apache-2.0

//! Corners, directions and a largest deviation of fair curves, as users give them.

use pyo3::{
    exceptions::PyTypeError,
    prelude::*,
    types::{PyDict, PyFloat},
};
use shapespline::{
    fair::Constraints,
    geometry::{DVec3, DataPolygon, Dimension, InputError, InputMap},
};

use crate::{
    error::must,
    input::{Numbers, integer, kind, numbers},
};

/// `corners`: indices of points, or the least turning angle.
#[derive(Debug, Clone, Default)]
pub(crate) enum Corners {
    #[default]
    None,
    Indices(Vec<usize>),
    Angle(f64),
}

/// What is asked of a fair curve beside the criteria, with indices of the input.
#[derive(Debug, Clone, Default)]
pub(crate) struct Given {
    corners: Corners,
    tangents: Vec<(usize, DVec3)>,
    max_deviation: Option<f64>,
    straight: bool,
}

impl Given {
    /// What the arguments `corners`, `tangents`, `max_deviation` and `straight` say.
    pub(crate) fn new(
        corners: Option<&Bound<'_, PyAny>>,
        tangents: Option<&Bound<'_, PyAny>>,
        max_deviation: Option<f64>,
        straight: bool,
        dimension: Dimension,
    ) -> PyResult<Self> {
        Ok(Self {
            corners: corners.map_or(Ok(Corners::None), corners_of)?,
            tangents: tangents.map_or(Ok(Vec::new()), |given| tangents_of(given, dimension))?,
            max_deviation,
            straight,
        })
    }

    /// The same at the nodes of a polygon made of the input.
    pub(crate) fn at_nodes(
        &self,
        polygon: &DataPolygon,
        map: &InputMap,
    ) -> Result<Constraints, InputError> {
        // Where the nodes stand in the input, in order.
        let all: Vec<usize> = (0..polygon.points().len()).map(|k| map.node(k)).collect();
        let node = |argument: &'static str, index: usize, point: usize| {
            if point >= map.count() {
                let (value, allowed) = (point as f64, "the index of a point");
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
            // Points that were left out stand where the one before them does.
            Ok((all.partition_point(|&input| input <= point) - 1) % polygon.nodes())
        };
        let mut corners = match &self.corners {
            Corners::None => Vec::new(),
            Corners::Angle(least) => sharp_turns(polygon, *least),
            Corners::Indices(points) => {
                let node = |(index, &point): (usize, &usize)| node("corners", index, point);
                points.iter().enumerate().map(node).collect::<Result<_, _>>()?
            }
        };
        corners.sort_unstable();
        corners.dedup();
        let at = |&(point, vector): &(usize, DVec3)| Ok((node("tangents", point, point)?, vector));
        let mut tangents = self.tangents.iter().map(at).collect::<Result<Vec<_>, InputError>>()?;
        tangents.sort_by_key(|tangent| tangent.0);
        let Self { max_deviation, straight, .. } = *self;
        Ok(Constraints { corners, tangents, max_deviation, straight })
    }
}

/// The inner nodes at which a polygon turns by an angle or more.
fn sharp_turns(polygon: &DataPolygon, least: f64) -> Vec<usize> {
    let ends = if polygon.is_closed() { 0..polygon.nodes() } else { 1..polygon.nodes() - 1 };
    let turns = |&k: &usize| {
        let [before, after] = polygon.directions_at(k);
        before.cross(after).length().atan2(before.dot(after)) >= least
    };
    ends.filter(turns).collect()
}

fn corners_of(object: &Bound<'_, PyAny>) -> PyResult<Corners> {
    const RULE: &str = "be indices of points, or the least turning angle as a float";
    match numbers("corners", object)? {
        Numbers::One(angle) if object.is_instance_of::<PyFloat>() => {
            if angle > 0.0 && angle <= std::f64::consts::PI {
                return Ok(Corners::Angle(angle));
            }
            Err(must("corners", &[], "be an angle above 0 and at most π", angle))
        }
        Numbers::One(value) => Err(must("corners", &[], RULE, value)),
        Numbers::Many(values) => {
            let index = |(k, &value): (usize, &f64)| {
                let whole = value >= 0.0 && value.fract() == 0.0 && value < 1e15;
                whole.then_some(value as usize).ok_or_else(|| {
                    must("corners", &[k], "be the index of a point, counted from 0", value)
                })
            };
            values.iter().enumerate().map(index).collect::<PyResult<_>>().map(Corners::Indices)
        }
    }
}

fn tangents_of(object: &Bound<'_, PyAny>, dimension: Dimension) -> PyResult<Vec<(usize, DVec3)>> {
    let Ok(given) = object.cast::<PyDict>() else {
        let text = format!("tangents must be a dict of index: vector, got {}", kind(object));
        return Err(PyTypeError::new_err(text));
    };
    let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let index = integer("tangents", &key)?;
        let Ok(point) = usize::try_from(index) else {
            return Err(must("tangents", &[], "have indices counted from 0", index as f64));
        };
        match numbers("tangents", &value)? {
            Numbers::Many(v) if v.len() == dimension.count() => {
                let z = v.get(2).copied().unwrap_or(0.0);
                Ok((point, DVec3::new(v[0], v[1], z)))
            }
            _ => {
                let rule = format!("be a vector of {} components", dimension.count());
                Err(must("tangents", &[point], &rule, value.str()?.to_string().as_str()))
            }
        }
    };
    given.iter().map(entry).collect()
}
