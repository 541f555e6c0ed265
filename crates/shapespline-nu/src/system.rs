// SPDX-License-Identifier: MIT OR Apache-2.0

//! The linear system of the tangents.

use std::ops::Range;

use shapespline_banded::{Row, Rows};
use shapespline_geometry::{DVec3, DataPolygon, Span};
use shapespline_search::family::{TensionSystem, try_each_row};

/// The system (3.3)–(3.11) of paper 001 for the tangents `q_i`, each interior row divided by
/// `h_{i−1} + h_i` so that its matrix has no unit: with `w = h_i/(h_{i−1} + h_i)`
///
/// `w q_{i−1} + (2 + ½√(w(1−w)) ν_i) q_i + (1−w) q_{i+1} = 3 (w L_{i−1}/h_{i−1} + (1−w) L_i/h_i)`.
///
/// Off-diagonal entries sum to at most half the diagonal.
#[derive(Debug)]
pub struct NuSystem<'a> {
    pub(crate) polygon: &'a DataPolygon,
    /// One a distinct node.
    pub(crate) tension: Vec<f64>,
}

impl NuSystem<'_> {
    #[inline(always)]
    fn interior(&self, before: usize, after: usize, tension: f64) -> Row {
        Self::between([before, after].map(|segment| self.polygon.span(segment)), tension)
    }

    /// The row of a node between two segments.
    #[inline(always)]
    fn between([(chord0, h0), (chord1, h1)]: [Span; 2], tension: f64) -> Row {
        // Halves first: the sum of two spacings can overflow where neither does.
        let reciprocal = 1.0 / (0.5 * h0 + 0.5 * h1);
        let (lower, upper) = (0.5 * h1 * reciprocal, 0.5 * h0 * reciprocal);
        let velocities = chord0 * (lower / h0) + chord1 * (upper / h1);
        let diagonal = Self::diagonal(lower, upper, tension);
        Row { lower, diagonal, upper, right: velocities * 3.0 }
    }

    fn diagonal(lower: f64, upper: f64, tension: f64) -> f64 {
        let pull = if tension > 0.0 { 0.5 * (lower * upper).sqrt() * tension } else { 0.0 };
        2.0 + pull
    }

    /// End row: `(1 + ν) q = D` (3.8), or zero curvature `(2 + ½ν) q + q' = 3L/h` (3.10, E2).
    fn end(&self, tangent: Option<DVec3>, segment: usize, tension: f64) -> (f64, f64, DVec3) {
        match tangent {
            Some(d) => (1.0 + tension, 0.0, d),
            None => {
                let velocity = self.polygon.chord(segment) / self.polygon.spacing(segment);
                (2.0 + 0.5 * tension, 1.0, velocity * 3.0)
            }
        }
    }
}

impl Rows for NuSystem<'_> {
    fn count(&self) -> usize {
        self.polygon.nodes()
    }

    fn is_cyclic(&self) -> bool {
        self.polygon.is_closed()
    }

    #[inline]
    fn row(&self, i: usize) -> Row {
        let segments = self.polygon.segments();
        let tension = self.tension[i];
        if i > 0 && i < segments {
            self.interior(i - 1, i, tension)
        } else if self.is_cyclic() {
            self.interior(segments - 1, 0, tension)
        } else if i == 0 {
            let tangent = self.polygon.tangents()[0];
            let (diagonal, upper, right) = self.end(tangent, 0, tension);
            Row { lower: 0.0, diagonal, upper, right }
        } else {
            let tangent = self.polygon.tangents()[1];
            let (diagonal, lower, right) = self.end(tangent, segments - 1, tension);
            Row { lower, diagonal, upper: 0.0, right }
        }
    }

    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let inside = |i: usize, spans| Self::between(spans, self.tension[i]);
        try_each_row(self.polygon, rows, inside, |i| self.row(i), take)
    }
}

impl TensionSystem for NuSystem<'_> {
    const TENSION_SCALES_LEGS: bool = false;

    fn polygon(&self) -> &DataPolygon {
        self.polygon
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn set_tension(&mut self, node: usize, tension: f64) {
        self.tension[node] = tension;
    }

    fn dependent_rows(&self, node: usize, rows: &mut Vec<usize>) {
        rows.push(node);
    }

    /// Tension changes nothing but the diagonal.
    #[inline]
    fn refresh_row(&self, i: usize, row: &mut Row) {
        if !self.is_cyclic() && (i == 0 || i == self.polygon.segments()) {
            *row = self.row(i);
        } else {
            row.diagonal = Self::diagonal(row.lower, row.upper, self.tension[i]);
        }
    }

    #[inline]
    fn legs(&self, segment: usize, [first, last]: [DVec3; 2]) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        [first * third, last * third]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    #[test]
    fn a_row_is_renewed_as_it_would_be_made() {
        let ends = Boundary::tangents(DVec3::new(1.0, 2.0, -1.0), DVec3::Y);
        for boundary in [Boundary::ZeroCurvature, Boundary::Periodic, ends] {
            let at = |k: usize| {
                DVec3::new((0.3 * (k * k) as f64).sin(), (1.7 * k as f64).cos(), k as f64)
            };
            let mut points: Vec<DVec3> = (0..9).map(at).collect();
            points[8] = if boundary == Boundary::Periodic { points[0] } else { points[8] };
            let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
            let mut system = NuSystem { polygon: &polygon, tension: vec![0.0; polygon.nodes()] };
            let mut kept: Vec<Row> = (0..system.count()).map(|i| system.row(i)).collect();
            for (node, tension) in
                [(3, 2.0), (0, 0.7), (system.count() - 1, 9.0), (3, 0.0), (4, 1e9)]
            {
                let mut rows = Vec::new();
                system.set_tension(node, tension);
                system.dependent_rows(node, &mut rows);
                for i in rows {
                    system.refresh_row(i, &mut kept[i]);
                }
                // Also the rows that were not named.
                for (i, kept) in kept.iter().enumerate() {
                    assert_eq!(*kept, system.row(i), "{boundary:?}, row {i}");
                }
            }
        }
    }
}
