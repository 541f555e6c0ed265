// SPDX-License-Identifier: MIT OR Apache-2.0

//! From points as users have them to a polygon: points that repeat the one before them are left out, and
//! closed data get their first point again at the end. Indices keep referring to the input.

use glam::DVec3;

use crate::{Boundary, DataPolygon, Dimension, InputError, Parametrization, polygon::ends_agree};

/// What is done about a point (or a given parameter) that repeats the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Repeated {
    /// It is refused.
    #[default]
    Error,
    /// It is left out: the first of the points in a row that are equal, or have equal parameters, stays.
    Drop,
}

/// Points as users have them, and what their polygon is made of besides.
#[derive(Debug, Clone, PartialEq)]
pub struct InputPoints {
    /// The points; the third coordinate of planar ones is zero.
    pub points: Vec<DVec3>,
    /// Number of coordinates.
    pub dimension: Dimension,
    /// How parameters are chosen; given ones are one for each point, and for closed data that do not
    /// repeat their first point one more, that of its return.
    pub parametrization: Parametrization,
    /// Conditions at the ends.
    pub boundary: Boundary,
    /// Whether the first point is also the last, repeated or not; for [`Boundary::Periodic`].
    pub closed: bool,
    /// What is done about repeated points.
    pub repeated: Repeated,
}

impl InputPoints {
    /// The polygon, and where its points stand in the input. Cost O(N).
    ///
    /// # Errors
    /// Those of [`DataPolygon::with_dimension`], with indices of the input.
    pub fn polygon(self) -> Result<(DataPolygon, InputMap), InputError> {
        let (kept, map) = self.kept()?;
        let Self { points, dimension, parametrization, boundary, .. } = kept;
        let polygon = DataPolygon::with_dimension(points, dimension, &parametrization, boundary);
        match polygon {
            Ok(polygon) => Ok((polygon, map)),
            Err(error) => Err(map.in_input(error)),
        }
    }

    /// The points that a polygon is made of, closed and without those that are left out.
    ///
    /// # Errors
    /// Given parameters that are not one for each point, or fall while repeated points are left out.
    pub fn kept(mut self) -> Result<(Self, InputMap), InputError> {
        let points = &mut self.points;
        let mut map = InputMap { count: points.len(), ..InputMap::default() };
        if self.closed && points.len() > 1 && !ends_agree(points) {
            points.push(points[0]);
            map.count += 1;
            map.closing = true;
        }
        if let Parametrization::Given(u) = &self.parametrization
            && u.len() != map.count
        {
            let per = if map.closing {
                "one for each point, and one for the return to the first"
            } else {
                "one for each point"
            };
            let (expected, found) = (map.count, u.len());
            return Err(InputError::Length { argument: "parameters", expected, found, per });
        }
        if self.repeated == Repeated::Drop {
            map.leave_out(points, &self.parametrization)?;
            if !map.dropped.is_empty() {
                *points = map.nodes(points);
                if let Parametrization::Given(u) = &mut self.parametrization {
                    *u = map.nodes(u);
                }
            }
        }
        Ok((self, map))
    }
}

/// Where the points of a polygon stand in the input it was made from, of which points may have been left
/// out, and whose first point may have been added at the end.
///
/// Without either it maps everything to itself.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InputMap {
    /// Points of the input, with the one that closes it.
    count: usize,
    /// Indices of the points that were left out, ascending.
    dropped: Vec<usize>,
    /// The points at those indices. (Points may differ where parameters are equal.)
    left_out: Vec<DVec3>,
    /// Whether the first point was added at the end.
    closing: bool,
}

impl InputMap {
    /// Finds the points to leave out. Parameters may stand still, but not fall.
    fn leave_out(
        &mut self,
        points: &[DVec3],
        parametrization: &Parametrization,
    ) -> Result<(), InputError> {
        let given = match parametrization {
            Parametrization::Given(u) => Some(u),
            _ => None,
        };
        if let Some(u) = given
            && let Some(before) = u.windows(2).position(|w| w[1] < w[0])
        {
            let (argument, index) = ("parameters", before + 1);
            let (previous, value) = (u[before], u[index]);
            return Err(InputError::NotIncreasing { argument, index, previous, value });
        }
        let mut kept = 0;
        for i in 1..points.len() {
            if points[i] == points[kept] || given.is_some_and(|u| u[i] == u[kept]) {
                self.dropped.push(i);
                self.left_out.push(points[i]);
            } else {
                kept = i;
            }
        }
        Ok(())
    }

    /// Number of points of the input; the one that was added to close it counts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Indices of the points that were left out, ascending.
    #[must_use]
    pub fn dropped(&self) -> &[usize] {
        &self.dropped
    }

    /// Whether the first point was added at the end.
    #[must_use]
    pub fn closing(&self) -> bool {
        self.closing
    }

    /// Whether the polygon is the input: nothing was left out or added.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.dropped.is_empty() && !self.closing
    }

    /// Whether a polygon of so many points can have been made from this input: of one that any
    /// constructor made it can.
    #[must_use]
    pub fn fits(&self, points: usize) -> bool {
        let ascend = self.dropped.windows(2).all(|w| w[0] < w[1]);
        let inside = self.dropped.first().is_none_or(|&first| first > 0)
            && self.dropped.last().is_none_or(|&last| last < self.count);
        let counts = self.dropped.len().checked_add(points) == Some(self.count);
        ascend && inside && counts && self.left_out.len() == self.dropped.len()
    }

    /// Values at the nodes, from one for each point of the input. The end of the segment that closes it
    /// may have a value of its own, which must be that of the first point, or none.
    ///
    /// # Errors
    /// Another number of values.
    pub fn node_values(
        &self,
        argument: &'static str,
        values: &[f64],
    ) -> Result<Vec<f64>, InputError> {
        let given = values.len() + usize::from(self.closing);
        let (expected, found) = (self.count - usize::from(self.closing), values.len());
        match values.first() {
            Some(&first) if self.closing && given == self.count => {
                let mut nodes = self.nodes(values);
                nodes.push(first);
                Ok(nodes)
            }
            _ if values.len() == self.count => Ok(self.nodes(values)),
            _ => Err(InputError::Length { argument, expected, found, per: "one for each point" }),
        }
    }

    /// Values on the segments, from one for each segment of the input, that which closes it included.
    ///
    /// # Errors
    /// Another number of values.
    pub fn segment_values(
        &self,
        argument: &'static str,
        values: &[f64],
    ) -> Result<Vec<f64>, InputError> {
        let (expected, found) = (self.count - 1, values.len());
        if found != expected {
            let per = "one for each segment";
            return Err(InputError::Length { argument, expected, found, per });
        }
        Ok(self.segments(values))
    }

    /// Index in the input of a node of the polygon. Cost O(log of the points left out).
    #[must_use]
    pub fn node(&self, node: usize) -> usize {
        // As many are left out before it as stand at most `node` nodes from the start.
        let (mut low, mut high) = (0, self.dropped.len());
        while low < high {
            let middle = low.midpoint(high);
            if self.dropped[middle] - middle <= node {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        node + low
    }

    /// Index in the input of a segment of the polygon: the segments between points that repeat one
    /// another are none.
    #[must_use]
    pub fn segment(&self, segment: usize) -> usize {
        self.node(segment + 1) - 1
    }

    /// Which points of the input are nodes of the polygon.
    fn is_node(&self) -> impl FnMut(usize) -> bool {
        let mut dropped = self.dropped.iter().copied().peekable();
        move |i| dropped.next_if_eq(&i).is_none()
    }

    /// Of one value for each point of the input those of the nodes.
    #[must_use]
    pub fn nodes<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let mut is_node = self.is_node();
        let kept = values.iter().enumerate().filter(|(i, _)| is_node(*i));
        kept.map(|(_, value)| *value).collect()
    }

    /// Of one value for each segment of the input those of the polygon's.
    #[must_use]
    pub fn segments<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let mut is_node = self.is_node();
        let kept = values.iter().enumerate().filter(|(i, _)| is_node(i + 1));
        kept.map(|(_, value)| *value).collect()
    }

    /// One value for each point of the input, from those of the nodes: a point that was left out has
    /// that of the point it repeats.
    #[must_use]
    pub fn spread<T: Copy>(&self, nodes: &[T]) -> Vec<T> {
        let (mut is_node, mut k) = (self.is_node(), 0);
        let value = |i: usize| {
            k += usize::from(is_node(i));
            nodes[k - 1]
        };
        (0..self.count).map(value).collect()
    }

    /// One value for each segment of the input, from those of the polygon's; `none` between points that
    /// repeat one another.
    #[must_use]
    pub fn spread_segments<T: Clone>(&self, segments: &[T], none: &T) -> Vec<T> {
        let (mut is_node, mut segments) = (self.is_node(), segments.iter());
        let value = |i: usize| if is_node(i) { segments.next() } else { None }.unwrap_or(none);
        (1..self.count).map(value).cloned().collect()
    }

    /// The points of the input, from the nodes.
    #[must_use]
    pub fn points(&self, nodes: &[DVec3]) -> Vec<DVec3> {
        let mut points = self.spread(nodes);
        for (&i, &point) in self.dropped.iter().zip(&self.left_out) {
            points[i] = point;
        }
        points
    }

    /// An error about the polygon, or about what belongs to its nodes and segments, with the index of the
    /// input.
    #[must_use]
    pub fn in_input(&self, mut error: InputError) -> InputError {
        if self.dropped.is_empty() {
            return error;
        }
        match &mut error {
            InputError::NotFinite { argument, index, .. }
            | InputError::OutOfRange { argument, index, .. } => {
                let of_segments = argument.starts_with("tangent_scale[") || *argument == "legs";
                *index = if of_segments { self.segment(*index) } else { self.node(*index) };
            }
            InputError::NotIncreasing { index, .. }
            | InputError::TooClose { index, .. }
            | InputError::RepeatedPoint { index, .. }
            | InputError::NotClosed { last: index, .. }
            | InputError::Unequal { last: index, .. } => *index = self.node(*index),
            InputError::Overflow { index, .. } => *index = self.segment(*index),
            _ => {}
        }
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a line at these places.
    fn input(places: &[f64]) -> InputPoints {
        InputPoints {
            points: places.iter().map(|&x| DVec3::new(x, x * x, 0.0)).collect(),
            dimension: Dimension::Two,
            parametrization: Parametrization::Uniform,
            boundary: Boundary::ZeroCurvature,
            closed: false,
            repeated: Repeated::Drop,
        }
    }

    #[test]
    fn nodes_and_segments_know_their_places_in_the_input() {
        let (polygon, map) = input(&[1.0, 1.0, 1.0, 2.0, 3.0, 3.0, 4.0, 4.0]).polygon().unwrap();
        assert_eq!(map.dropped(), [1, 2, 5, 7]);
        assert_eq!(polygon.points().len(), 4);
        assert_eq!([0, 1, 2, 3].map(|k| map.node(k)), [0, 3, 4, 6]);
        assert_eq!([0, 1, 2].map(|k| map.segment(k)), [2, 3, 5]);
        let all = [10, 11, 12, 13, 14, 15, 16, 17];
        assert_eq!(map.nodes(&all), [10, 13, 14, 16]);
        assert_eq!(map.segments(&all[..7]), [12, 13, 15]);
        assert_eq!(map.spread(&[0, 1, 2, 3]), [0, 0, 0, 1, 2, 2, 3, 3]);
        assert_eq!(map.spread_segments(&[0, 1, 2], &9), [9, 9, 0, 1, 9, 2, 9]);
    }

    #[test]
    fn without_repeats_everything_is_mapped_to_itself() {
        let (polygon, map) = input(&[1.0, 2.0, 4.0]).polygon().unwrap();
        assert_eq!(map.dropped(), []);
        assert_eq!((map.node(2), map.segment(1)), (2, 1));
        assert_eq!(map.points(polygon.points()), polygon.points());
        assert_eq!(map.nodes(&[7, 8, 9]), [7, 8, 9]);
        assert_eq!(map.spread_segments(&[7, 8], &0), [7, 8]);
    }

    #[test]
    fn equal_parameters_drop_a_point_that_stays_in_the_input() {
        let parametrization = Parametrization::Given(vec![0.0, 1.0, 1.0, 2.0]);
        let (polygon, map) =
            InputPoints { parametrization, ..input(&[1.0, 2.0, 3.0, 4.0]) }.polygon().unwrap();
        assert_eq!(map.dropped(), [2]);
        assert_eq!(map.points(polygon.points())[2], DVec3::new(3.0, 9.0, 0.0));
        assert_eq!(map.spread(polygon.parameters()), [0.0, 1.0, 1.0, 2.0]);
    }

    #[test]
    fn closed_data_may_repeat_their_first_point_or_not() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let points: Vec<DVec3> = square.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect();
        let boundary = Boundary::Periodic;
        let open = InputPoints { points, boundary, closed: true, ..input(&[]) };
        let mut repeated = open.clone();
        repeated.points.push(DVec3::new(1e-16, -2e-16, 0.0));
        for (given, closing) in [(open.clone(), true), (repeated, false)] {
            let (polygon, map) = given.polygon().unwrap();
            assert_eq!((polygon.segments(), map.count(), map.closing()), (4, 5, closing));
            assert_eq!(polygon.points()[4], DVec3::ZERO);
        }
        let parametrization = Parametrization::Given(vec![0.0, 1.0, 2.0, 3.0]);
        let error = InputPoints { parametrization, ..open }.polygon().unwrap_err().to_string();
        assert!(error.contains("parameters must have length 5"), "{error}");
    }

    #[test]
    fn errors_have_indices_of_the_input() {
        let error = input(&[1.0, 1.0, 2.0, f64::NAN]).polygon().unwrap_err().to_string();
        assert!(error.contains("points[3]"), "{error}");
        let error = input(&[1.0, 1.0]).polygon().unwrap_err().to_string();
        assert!(error.contains("at least 2 points, got 1"), "{error}");
        let parametrization = Parametrization::Given(vec![0.0, 1.0, 1.0, 0.5]);
        let given = InputPoints { parametrization, ..input(&[1.0, 2.0, 2.0, 3.0]) };
        let error = given.polygon().unwrap_err().to_string();
        assert!(error.contains("parameters[3] = 0.5"), "{error}");
    }
}
