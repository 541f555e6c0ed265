// SPDX-License-Identifier: MIT OR Apache-2.0

//! The piecewise cubic curve: the one storage of all families.

mod evaluate;

use std::sync::Arc;

use glam::DVec3;
use shapespline_polynomial::{
    knots::{Locator, Searcher},
    parallel,
};

use crate::{
    Boundary, CubicSegment, DataPolygon, Dimension, InputError, Parametrization, Side,
    error::check_room, parametrization::check_increasing,
};

/// What a parameter outside the knots means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Domain {
    /// An open curve: the end cubics go on.
    Open,
    /// A closed curve: parameters wrap around.
    Closed,
}

/// A curve of cubic Bézier segments between points, each run through linearly in its parameter
/// interval: `t = (u − u_i)/h_i`.
///
/// Only the points and each segment's end legs are held (80 bytes a segment in all); positions at
/// knots are the points exactly.
#[derive(Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct PiecewiseCubic {
    knots: Arc<Vec<f64>>,
    points: Arc<Vec<DVec3>>,
    /// First and last leg of each segment, `a_i` and `c_i`.
    legs: Vec<[DVec3; 2]>,
    dimension: Dimension,
    domain: Domain,
    /// Made by the first large unsorted evaluation.
    #[cfg_attr(feature = "serde", serde(skip))]
    locator: Locator,
}

/// The stored form, which may come from anywhere: it becomes a curve only if the constructor takes it.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "PiecewiseCubic")]
struct Stored {
    knots: Vec<f64>,
    points: Vec<DVec3>,
    legs: Vec<[DVec3; 2]>,
    dimension: Dimension,
    domain: Domain,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for PiecewiseCubic {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        let Stored { knots, points, legs, dimension, domain } = stored;
        Self::new(knots, points, legs, dimension, domain)
    }
}

impl Clone for PiecewiseCubic {
    fn clone(&self) -> Self {
        Self {
            knots: Arc::clone(&self.knots),
            points: Arc::clone(&self.points),
            legs: self.legs.clone(),
            dimension: self.dimension,
            domain: self.domain,
            locator: Locator::default(),
        }
    }
}

impl PartialEq for PiecewiseCubic {
    fn eq(&self, other: &Self) -> bool {
        self.knots == other.knots
            && self.points == other.points
            && self.legs == other.legs
            && (self.dimension, self.domain) == (other.dimension, other.domain)
    }
}

impl PiecewiseCubic {
    /// Curve from knots, points and the end legs of each segment.
    ///
    /// # Errors
    /// Knots that do not increase, lengths that do not belong together, points or legs that are not
    /// finite or leave no room for sums of them (1.1e307).
    pub fn new(
        knots: Vec<f64>,
        points: Vec<DVec3>,
        legs: Vec<[DVec3; 2]>,
        dimension: Dimension,
        domain: Domain,
    ) -> Result<Self, InputError> {
        if points.len() < 2 {
            let (argument, found) = ("points", points.len());
            return Err(InputError::TooFewPoints { argument, needed: 2, found, why: "" });
        }
        if knots.len() != points.len() {
            let (argument, expected, found) = ("knots", points.len(), knots.len());
            return Err(InputError::Length {
                argument,
                expected,
                found,
                per: "one for each point",
            });
        }
        if legs.len() + 1 != points.len() {
            let (argument, expected, found) = ("legs", points.len() - 1, legs.len());
            let per = "one pair for each segment";
            return Err(InputError::Length { argument, expected, found, per });
        }
        check_increasing("knots", &knots)?;
        check_room("points", &points)?;
        check_legs(&legs)?;
        let (knots, points) = (Arc::new(knots), Arc::new(points));
        Ok(Self { knots, points, legs, dimension, domain, locator: Locator::default() })
    }

    /// Curve through the points of a polygon, which it shares, with the end legs of each segment.
    ///
    /// # Errors
    /// Not one pair of legs a segment; legs that are not finite.
    pub fn through(polygon: &DataPolygon, legs: Vec<[DVec3; 2]>) -> Result<Self, InputError> {
        check_legs(&legs)?;
        Ok(Self::through_checked(polygon, legs))
    }

    /// [`Self::through`] for legs that [have room](crate::batch::VectorLanes::have_room), as was found
    /// while they were made: long ones are not read from memory once more.
    #[must_use]
    pub fn through_checked(polygon: &DataPolygon, legs: Vec<[DVec3; 2]>) -> Self {
        debug_assert!(check_legs(&legs).is_ok());
        let domain = if polygon.is_closed() { Domain::Closed } else { Domain::Open };
        let dimension = polygon.dimension();
        let (points, knots) = polygon.shared();
        Self { knots, points, legs, dimension, domain, locator: Locator::default() }
    }

    /// The knots `u_0 < … < u_N`.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The points at the knots.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// First and last leg of each segment, `a_i` and `c_i`.
    #[must_use]
    pub fn legs(&self) -> &[[DVec3; 2]] {
        &self.legs
    }

    /// The polygon of its knots and points, with some end conditions, checked. Cost O(N).
    ///
    /// # Errors
    /// Those of [`DataPolygon::new`]: neighbours that are equal, ends that the conditions do not suit.
    pub fn polygon(&self, boundary: Boundary) -> Result<DataPolygon, InputError> {
        let parametrization = Parametrization::Given(self.knots.to_vec());
        let points = self.points.to_vec();
        DataPolygon::with_dimension(points, self.dimension, &parametrization, boundary)
    }

    /// Number of segments.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.legs.len()
    }

    /// Planar or spatial.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Open or closed.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// One segment.
    #[must_use]
    pub fn segment(&self, i: usize) -> CubicSegment {
        let [a, c] = self.legs[i];
        CubicSegment::from_end_legs(self.points[i], self.points[i + 1], a, c)
    }

    /// Segment and local parameter `t` of a parameter; at a knot the segment on `side`. Outside an
    /// open curve `t` leaves `[0, 1]`; on a closed one the parameter wraps. Cost O(log N).
    #[must_use]
    pub fn locate(&self, u: f64, side: Side) -> (usize, f64) {
        let (i, u) = self.find(u, side);
        (i, self.local(i, u))
    }

    /// Segment of a parameter, and the parameter wrapped into it. Cost O(log N).
    pub(crate) fn find(&self, u: f64, side: Side) -> (usize, f64) {
        let u = self.wrap(u);
        // On a closed curve the segment that ends at the first knot is the last one.
        if self.domain == Domain::Closed && side == Side::Left && u == self.knots[0] {
            let last = self.segments();
            return (last - 1, self.knots[last]);
        }
        (side.segment(&self.knots, u), u)
    }

    /// What finds the segments of parameters, of `many` faster.
    pub(crate) fn searcher(&self, many: bool) -> Searcher<'_> {
        self.locator.searcher(&self.knots, many)
    }

    #[inline]
    pub(crate) fn wrap(&self, u: f64) -> f64 {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        if self.domain == Domain::Closed && (u < first || u > last) {
            first + (u - first).rem_euclid(last - first)
        } else {
            u
        }
    }

    #[inline]
    fn local(&self, i: usize, u: f64) -> f64 {
        (u - self.knots[i]) / (self.knots[i + 1] - self.knots[i])
    }
}

/// Legs from which on they are checked on all threads.
const MANY: usize = 32_768;

fn check_legs(legs: &[[DVec3; 2]]) -> Result<(), InputError> {
    let check = |legs: &[[DVec3; 2]]| check_room("legs", legs.as_flattened());
    let part = |(): &mut (), _, legs: &[[DVec3; 2]]| check(legs);
    parallel::parts::<_, _, _, Result<(), _>>(legs, MANY / 4, MANY, || (), part)
        // Check all in order to report the first leg that is wrong.
        .or_else(|_| check(legs))
        // Two legs a segment: the index is the segment's.
        .map_err(|error| match error {
            InputError::NotFinite { argument, index, value } => {
                InputError::NotFinite { argument, index: index / 2, value }
            }
            InputError::OutOfRange { argument, index, value, allowed } => {
                InputError::OutOfRange { argument, index: index / 2, value, allowed }
            }
            other => other,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Curve;

    fn cubic(u: f64) -> DVec3 {
        DVec3::new(u * u * u - u, 2.0 * u * u + 1.0, 0.5 * u - 3.0)
    }
    fn slope(u: f64) -> DVec3 {
        DVec3::new(3.0 * u * u - 1.0, 4.0 * u, 0.5)
    }

    fn planted(knots: &[f64], domain: Domain) -> PiecewiseCubic {
        let legs = knots
            .windows(2)
            .map(|w| [slope(w[0]) * (w[1] - w[0]) / 3.0, slope(w[1]) * (w[1] - w[0]) / 3.0])
            .collect();
        let points = knots.iter().map(|&u| cubic(u)).collect();
        PiecewiseCubic::new(knots.to_vec(), points, legs, Dimension::Three, domain).unwrap()
    }

    #[test]
    fn a_planted_cubic_comes_back_from_every_evaluator() {
        let knots = [-1.0, -0.4, 0.0, 0.3, 1.5];
        let curve = planted(&knots, Domain::Open);
        let many: Vec<f64> =
            (0..40_000).map(|k| -1.4 + (k * 7919 % 40_000) as f64 * 8e-5).collect();
        let mut sorted = many.clone();
        sorted.sort_by(f64::total_cmp);
        for queries in [&many, &sorted, &vec![0.3, -0.4, 2.0]] {
            for order in 0..5 {
                let expected = |u: f64| match order {
                    0 => cubic(u),
                    1 => slope(u),
                    2 => DVec3::new(6.0 * u, 4.0, 0.0),
                    3 => DVec3::new(6.0, 0.0, 0.0),
                    _ => DVec3::ZERO,
                };
                for side in [Side::Left, Side::Right] {
                    let out = curve.evaluate_many(queries, order, side);
                    assert_eq!(out.len(), 3 * queries.len());
                    for (&u, row) in queries.iter().zip(out.chunks(3)) {
                        let value = DVec3::from_slice(row);
                        assert!((value - expected(u)).length() < 2e-11, "{order} {u} {value}");
                        assert_eq!(value, curve.evaluate(u, order, side));
                    }
                }
            }
        }
        for (i, &u) in knots.iter().enumerate() {
            assert_eq!(curve.evaluate(u, 0, Side::Left), curve.points()[i]);
            assert_eq!(curve.evaluate(u, 0, Side::Right), curve.points()[i]);
        }
    }

    #[test]
    fn nan_stays_nan_and_closed_curves_wrap() {
        let curve = planted(&[0.0, 1.0, 3.0], Domain::Closed);
        for order in 0..6 {
            assert!(curve.evaluate(f64::NAN, order, Side::Right).is_nan());
            let there = curve.evaluate(0.25, order, Side::Right);
            assert_eq!(curve.evaluate(3.25, order, Side::Right), there);
            assert_eq!(curve.evaluate(-2.75, order, Side::Right), there);
        }
        assert_eq!(curve.locate(0.0, Side::Left), (1, 1.0));
    }

    #[test]
    fn room_for_other_than_a_row_a_parameter_is_refused() {
        let curve = planted(&[0.0, 1.0, 3.0], Domain::Open);
        let into = |room: usize| {
            Curve::evaluate_into(&curve, &[0.5, 2.0], 0, Side::Right, &mut vec![0.0; room])
        };
        assert!(into(6).is_ok());
        for room in [0, 5, 7] {
            let error = into(room).unwrap_err().to_string();
            assert!(error.contains("out") && error.contains('6'), "{error}");
        }
    }

    #[test]
    fn parts_that_do_not_belong_together_are_refused() {
        let legs = vec![[DVec3::X, DVec3::X]];
        let make = |knots: &[f64], points: &[DVec3], legs: Vec<[DVec3; 2]>| {
            let (knots, points) = (knots.to_vec(), points.to_vec());
            PiecewiseCubic::new(knots, points, legs, Dimension::Three, Domain::Open)
                .unwrap_err()
                .to_string()
        };
        let points = [DVec3::ZERO, DVec3::X];
        assert!(make(&[0.0], &points[..1], vec![]).contains("at least 2"));
        assert!(make(&[0.0], &points, legs.clone()).contains("length 2"));
        assert!(make(&[0.0, 0.0], &points, legs.clone()).contains("knots[1] = 0"));
        assert!(make(&[0.0, 1.0], &points, vec![]).contains("length 1"));
        assert!(make(&[0.0, 1.0], &points, vec![[DVec3::NAN, DVec3::X]]).contains("legs[0]"));
    }
}
