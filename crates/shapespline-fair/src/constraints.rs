// SPDX-License-Identifier: MIT OR Apache-2.0

//! What else a curve has to do: corners at points, directions at points, a distance from the polygon.

use std::borrow::Cow;

use shapespline_criteria::{Checker, Requirements};
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, InputError, Parametrization, length, normalize,
};

use crate::{element::TAU, runs::Runs, shape::off_chord, window::is_given};

/// What else the curve has to do.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Constraints {
    /// Points at which the curve has a corner, ascending. The data are split there, and each part is open
    /// data with natural ends at the corners.
    pub corners: Vec<usize>,
    /// Directions that the curve has at points, each with the index of its point, ascending. Where no curve
    /// keeps the shape with them, the nearest with which one does are taken, and the diagnostics say so.
    pub tangents: Vec<(usize, DVec3)>,
    /// How far, at most, the curve's control points lie from the chord of their segment, and with them the
    /// curve.
    pub max_deviation: Option<f64>,
    /// Whether the curve is exactly straight along collinear runs. At their ends its curvature is zero and
    /// its tangent lies along the run; a turn in which two runs meet has to be a corner.
    pub straight: bool,
}

/// Least deviation, over the longest chord: handles are as short, and below this rounding hides their
/// directions.
const LEAST_DEVIATION: f64 = 1e-6;

/// Corners are where the tangent may jump: two open ends that meet.
const ALLOWED_CORNER: &str = "the index of an inner point, more than the one before";
const ALLOWED_TANGENT: &str =
    "the index of a point without an end tangent or a corner, more than the one before";

impl Constraints {
    /// Checks indices and vectors against the data.
    ///
    /// # Errors
    /// Corners or tangents at points that are not there, at ends that cannot have them, or out of order;
    /// vectors without a direction; a distance that is not positive.
    pub fn validate(&self, polygon: &DataPolygon) -> Result<(), InputError> {
        let nodes = polygon.nodes();
        let inner = |k: usize| if polygon.is_closed() { k < nodes } else { k > 0 && k + 1 < nodes };
        let ascends = |k: usize, before: Option<usize>| before.is_none_or(|before| before < k);
        let mut before = None;
        for (index, &corner) in self.corners.iter().enumerate() {
            if !inner(corner) || !ascends(corner, before) {
                let (argument, value, allowed) = ("corners", corner as f64, ALLOWED_CORNER);
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
            before = Some(corner);
        }
        let mut before = None;
        for (index, &(node, vector)) in self.tangents.iter().enumerate() {
            let clear = node < nodes && !is_given(polygon, node) && !self.corners.contains(&node);
            if !clear || !ascends(node, before) {
                let (argument, value, allowed) = ("tangents", node as f64, ALLOWED_TANGENT);
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
            let size = length(vector);
            if !(size > 0.0 && size.is_finite()) {
                let (argument, allowed) = ("tangents", "a finite vector with a direction");
                return Err(InputError::OutOfRange { argument, index: node, value: size, allowed });
            }
            before = Some(node);
        }
        match self.max_deviation {
            Some(value) if !(value > 0.0 && value.is_finite()) => Err(InputError::Scalar {
                argument: "max_deviation",
                value,
                allowed: "a length above 0",
            }),
            _ => Ok(()),
        }
    }

    /// Refuses what no curve can do that keeps the shape.
    ///
    /// # Errors
    /// A direction at a point that does not lie between the chords there, where turning is asked for; a distance
    /// from the chords that is less than a given end tangent needs.
    pub(crate) fn refuse_conflicts(
        &self,
        checker: &Checker<'_>,
        runs: &Runs,
    ) -> Result<(), InputError> {
        let (polygon, required) = (checker.polygon(), checker.requirements());
        let n = polygon.segments();
        for &(node, vector) in &self.tangents {
            if let Some(line) = runs.line(node) {
                refuse_off_line(node, normalize(vector), line)?;
                continue;
            }
            let [before, after] = [(node + n - 1) % n, node % n].map(|i| required[i]);
            if !before.intersects(Requirements::TURNING_AT_END)
                && !after.intersects(Requirements::TURNING_AT_START)
            {
                continue;
            }
            let ([u, v], d) = (polygon.directions_at(node), normalize(vector));
            let normal = u.cross(v);
            let between = u.cross(d).dot(normal).min(d.cross(v).dot(normal));
            if !(between > 0.0) {
                let (argument, index, value) = ("tangents", node, between / normal.length());
                let allowed = "between the chords at its point, as the criterion \"turning\" asks (the least \
                               sine above 0)";
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
        }
        let Some(most) = self.max_deviation else { return Ok(()) };
        let longest = (0..n).map(|i| length(polygon.chord(i))).fold(0.0, f64::max);
        if !(most > LEAST_DEVIATION * longest) {
            let (argument, value) = ("max_deviation", most);
            let allowed =
                "more than a millionth of the longest chord: nearer to it there is the polygon";
            return Err(InputError::Scalar { argument, value, allowed });
        }
        let [start, last] = polygon.tangents();
        for (segment, tangent, end) in [(0, start, 0.0), (n - 1, last.map(|v| -v), 1.0)] {
            let Some(tangent) = tangent else { continue };
            let chord = length(polygon.chord(segment));
            let leg = tangent * (TAU / 3.0 * polygon.spacing(segment) / chord);
            let needed = off_chord(leg, end, polygon.direction(segment)).length() * chord;
            if !(needed < most) {
                let (argument, value) = ("max_deviation", most);
                let allowed = "more than the given end tangents lead away from the end chords, a twelfth of \
                               the way that they would go in one spacing";
                return Err(InputError::Scalar { argument, value, allowed });
            }
        }
        Ok(())
    }

    /// The collinear runs that the curve goes through straight: none unless that is asked.
    ///
    /// # Errors
    /// Two runs that meet in a turn, or a given end tangent off a run.
    pub(crate) fn runs(&self, checker: &Checker<'_>) -> Result<Runs, InputError> {
        if self.straight { Runs::of(checker, &self.corners) } else { Ok(Runs::default()) }
    }

    /// Whether nothing is asked.
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The parts between corners, in order along the data: the whole where there are none.
    pub(crate) fn parts<'a>(&self, polygon: &'a DataPolygon) -> Result<Vec<Part<'a>>, InputError> {
        let n = polygon.segments();
        let ends: Vec<usize> = match (self.corners.as_slice(), polygon.is_closed()) {
            ([], _) => {
                return Ok(vec![Part { first: 0, polygon: Cow::Borrowed(polygon) }]);
            }
            ([first, ..], true) => self.corners.iter().copied().chain([first + n]).collect(),
            (corners, false) => [0].into_iter().chain(corners.iter().copied()).chain([n]).collect(),
        };
        ends.windows(2).map(|ends| Part::between(polygon, [ends[0], ends[1]])).collect()
    }

    /// The direction asked for at a node, a unit vector.
    pub(crate) fn direction(&self, node: usize) -> Option<DVec3> {
        let at = self.tangents.binary_search_by_key(&node, |tangent| tangent.0).ok()?;
        Some(normalize(self.tangents[at].1))
    }
}

/// Refuses a direction that leads off the line which the curve keeps to at its point.
fn refuse_off_line(node: usize, direction: DVec3, line: DVec3) -> Result<(), InputError> {
    let sine = direction.cross(line).length();
    if sine <= 1e-9 && direction.dot(line) > 0.0 {
        return Ok(());
    }
    let allowed = "along the straight run at its point (the sine between them 0)";
    Err(InputError::OutOfRange { argument: "tangents", index: node, value: sine, allowed })
}

/// The data between two corners.
pub(crate) struct Part<'a> {
    /// The node of the whole that it begins at.
    pub(crate) first: usize,
    /// The whole itself where there are no corners.
    pub(crate) polygon: Cow<'a, DataPolygon>,
}

impl Part<'_> {
    /// From one node to another, past the end of closed data.
    fn between(polygon: &DataPolygon, [from, to]: [usize; 2]) -> Result<Self, InputError> {
        let (n, u) = (polygon.segments(), polygon.parameters());
        let period = u[n] - u[0];
        let nodes = from..=to;
        let points = nodes.clone().map(|k| polygon.points()[if k > n { k - n } else { k }]);
        let parameters = nodes.map(|k| if k > n { u[k - n] + period } else { u[k] });
        // The tangents of the whole hold at its own ends.
        let [start, end] = polygon.tangents();
        let boundary = Boundary::tangents(start.filter(|_| from == 0), end.filter(|_| to == n));
        let polygon = DataPolygon::with_dimension(
            points.collect(),
            polygon.dimension(),
            &Parametrization::Given(parameters.collect()),
            boundary,
        )?;
        Ok(Self { first: from, polygon: Cow::Owned(polygon) })
    }

    /// What is asked of a part of data with so many segments: with indices of its own.
    pub(crate) fn own(&self, constraints: &Constraints, segments: usize) -> Constraints {
        let count = self.polygon.segments();
        let place = |&(node, vector): &(usize, DVec3)| {
            // Past the end of closed data.
            let node = if node < self.first { node + segments } else { node };
            let own = node - self.first;
            (own <= count).then_some((own, vector))
        };
        let mut tangents: Vec<(usize, DVec3)> =
            constraints.tangents.iter().filter_map(place).collect();
        tangents.sort_unstable_by_key(|tangent| tangent.0);
        Constraints { corners: Vec::new(), tangents, ..constraints.clone() }
    }
}
