// SPDX-License-Identifier: MIT OR Apache-2.0

//! The plain C² cubic spline: where the search begins, and a lower bound of the parametric energy.

use std::ops::Range;

use glam::DVec3;
use shapespline_banded::{Row, Rows, SolveError, solve_once};
use shapespline_geometry::DataPolygon;
use shapespline_polynomial::parallel;

use crate::{
    element::Node,
    units::{BLOCK, Units},
};

/// The system of the tangents `q_i`: with `w = h_i/(h_{i−1} + h_i)` and `V = L/h`
///
/// `w q_{i−1} + 2 q_i + (1−w) q_{i+1} = 3 (w V_{i−1} + (1−w) V_i)`;
///
/// natural ends read `2 q_0 + q_1 = 3 V_0`, given ones `q_0 = D_0`.
struct System<'a>(&'a DataPolygon);

impl Rows for System<'_> {
    fn count(&self) -> usize {
        self.0.nodes()
    }

    fn is_cyclic(&self) -> bool {
        self.0.is_closed()
    }

    #[inline]
    fn row(&self, i: usize) -> Row {
        let (polygon, n) = (self.0, self.0.segments());
        if polygon.is_closed() || (i > 0 && i < n) {
            let before = if i == 0 { n - 1 } else { i - 1 };
            return between(polygon.span(before), polygon.span(i));
        }
        match polygon.tangents()[usize::from(i == n)] {
            Some(right) => Row { lower: 0.0, diagonal: 1.0, upper: 0.0, right },
            None => {
                let (lower, upper) = if i == 0 { (0.0, 1.0) } else { (1.0, 0.0) };
                let (chord, h) = polygon.span(if i == 0 { 0 } else { n - 1 });
                Row { lower, diagonal: 2.0, upper, right: chord / h * 3.0 }
            }
        }
    }

    /// With each chord read once.
    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        mut take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let inner = rows.start.max(1)..rows.end.min(self.0.segments());
        if inner.is_empty() {
            return rows.into_iter().try_for_each(|i| take(i, self.row(i)));
        }
        (rows.start..inner.start).try_for_each(|i| take(i, self.row(i)))?;
        let mut before = self.0.span(inner.start - 1);
        for (i, after) in inner.clone().zip(self.0.spans(inner.clone())) {
            take(i, between(std::mem::replace(&mut before, after), after))?;
        }
        (inner.end..rows.end).try_for_each(|i| take(i, self.row(i)))
    }
}

/// The row of a node between two segments.
#[inline(always)]
fn between((chord0, h0): (DVec3, f64), (chord1, h1): (DVec3, f64)) -> Row {
    // Halves first: the sum of two spacings can overflow where neither does.
    let reciprocal = 1.0 / (0.5 * h0 + 0.5 * h1);
    let (lower, upper) = (0.5 * h1 * reciprocal, 0.5 * h0 * reciprocal);
    let velocities = chord0 * (lower / h0) + chord1 * (upper / h1);
    Row { lower, diagonal: 2.0, upper, right: velocities * 3.0 }
}

/// The plain cubic of a polygon, in the user's units.
pub(crate) struct Plain<'a> {
    polygon: &'a DataPolygon,
    /// One per distinct node.
    tangents: Vec<DVec3>,
}

impl<'a> Plain<'a> {
    pub(crate) fn of(polygon: &'a DataPolygon) -> Result<Self, SolveError> {
        Ok(Self { polygon, tangents: solve_once(&System(polygon))? })
    }

    /// The tangents at the ends of a segment.
    #[inline]
    fn ends(&self, segment: usize) -> [DVec3; 2] {
        // Of closed data the last point is the first.
        let next = self.tangents.get(segment + 1).unwrap_or(&self.tangents[0]);
        [self.tangents[segment], *next]
    }

    /// The end legs of a segment.
    #[inline]
    pub(crate) fn legs(&self, segment: usize) -> [DVec3; 2] {
        let ([q0, q1], third) = (self.ends(segment), self.polygon.spacing(segment) / 3.0);
        [q0 * third, q1 * third]
    }

    /// Those of all segments.
    pub(crate) fn all_legs(&self) -> Vec<[DVec3; 2]> {
        parallel::map(self.polygon.segments(), 2 * BLOCK, |i| self.legs(i))
    }

    /// First and second derivative at a node, in units of the polygon.
    pub(crate) fn node(&self, i: usize, units: Units) -> Node {
        let n = self.polygon.segments();
        let (segment, end) = if i < n { (i, 0) } else { (n - 1, 1) };
        let ([q0, q1], (chord, h)) = (self.ends(segment), self.polygon.span(segment));
        let v = chord / h;
        let (q, r) = if end == 0 {
            (q0, v * 6.0 - q0 * 4.0 - q1 * 2.0)
        } else {
            (q1, q0 * 2.0 + q1 * 4.0 - v * 6.0)
        };
        let inside = |v: DVec3| v / units.length * units.time;
        Node { q: inside(q), r: inside(r) / (h / units.time) }
    }

    /// `∫|Q''|²du` of a segment: with `s, t` the differences of its legs `a, b, c` over `h`,
    /// `12 (s·s + s·t + t·t)/h`.
    #[inline]
    pub(crate) fn energy(&self, segment: usize) -> f64 {
        let ([q0, q1], (chord, h)) = (self.ends(segment), self.polygon.span(segment));
        let middle = chord / h - (q0 + q1) / 3.0;
        let (s, t) = (middle - q0 / 3.0, q1 / 3.0 - middle);
        12.0 / h * (s.length_squared() + s.dot(t) + t.length_squared())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_criteria::{Checker, Criteria, Tolerances};
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::{
        Constraints, energy::parametric, export::Pieces, runs::Runs, segment::Demands, units::sum,
    };

    /// Long enough for all threads.
    #[test]
    fn the_plain_cubic_is_what_the_element_makes_of_its_nodes() {
        let at =
            |k: usize| DVec3::new((0.9 * k as f64).cos(), (0.7 * k as f64).sin(), 0.2 * k as f64);
        let given = Boundary::Tangents { start: Some(DVec3::X), end: None };
        for boundary in [Boundary::ZeroCurvature, Boundary::Circular, Boundary::Periodic, given] {
            for count in [7, 3 * BLOCK] {
                let mut points: Vec<DVec3> = (0..count).map(at).collect();
                points[count - 1] =
                    if boundary == Boundary::Periodic { at(0) } else { points[count - 1] };
                let polygon =
                    DataPolygon::new(points, &Parametrization::Centripetal, boundary).unwrap();
                let plain = Plain::of(&polygon).unwrap();
                let checker = Checker::new(&polygon, Criteria::NONE, Tolerances::default());
                let (units, constraints) = (Units::of(&polygon), &Constraints::default());
                let runs = &Runs::default();
                let demands = Demands { checker: &checker, units, constraints, runs };
                let legs = |i: usize| {
                    let ends = [i, (i + 1) % polygon.nodes()].map(|j| plain.node(j, units));
                    demands.span(i).legs(ends[0], ends[1])
                };
                let speed = units.length / units.time;
                let mut total = 0.0;
                for (i, own) in plain.all_legs().into_iter().enumerate() {
                    let d = legs(i);
                    let third = demands.span(i).length * units.length / 3.0;
                    assert!((own[0] - d[0] * third).length() < 1e-13);
                    assert!((own[1] - d[4] * third).length() < 1e-13);
                    // One cubic: no extra knot is left.
                    let pieces = Pieces::of(&demands.span(i), &d, units, [DVec3::ZERO; 2]);
                    assert_eq!(pieces.legs.len(), 1);
                    let energy = parametric(&demands.span(i), &d) * speed * speed / units.time;
                    assert!((plain.energy(i) - energy).abs() < 1e-10 * (1.0 + energy));
                    total += energy;
                }
                let summed = sum(polygon.segments(), |i| plain.energy(i));
                assert!((summed - total).abs() < 1e-9 * total);
            }
        }
    }
}
