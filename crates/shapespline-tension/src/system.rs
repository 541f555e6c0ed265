// SPDX-License-Identifier: MIT OR Apache-2.0

//! The linear system of the tangents.

use std::ops::Range;

use shapespline_banded::{Row, Rows};
use shapespline_geometry::{DVec3, DataPolygon, Span};
use shapespline_search::family::{TensionSystem, tension_unit, try_each_row};

/// The system (3.7)–(3.8) of paper 000 for the tangents `T_i`, each row divided by
/// `h_{i−1}(h_iλ⁰_i)² + h_i(h_{i−1}λ¹_{i−1})²` so that its matrix has no unit (see the crate's page).
///
/// Off-diagonal entries are at most 1 together, the diagonal is 3 less them.
#[derive(Debug)]
pub struct ManniSystem<'a> {
    polygon: &'a DataPolygon,
    /// `[λ⁰, λ¹]` of each segment.
    slopes: Vec<[f64; 2]>,
    /// `1/λ − 1` on both sides of each distinct node: that of the segment before, `λ¹_{i−1}`, and that of
    /// the segment after, `λ⁰_i`. Zero beyond an open end.
    tension: Vec<f64>,
}

impl<'a> ManniSystem<'a> {
    /// The system of given `λ`, each in `(0, 1]`, one pair a segment.
    pub(crate) fn new(polygon: &'a DataPolygon, slopes: Vec<[f64; 2]>) -> Self {
        let side = |index: usize| {
            let place = place_of(polygon, index);
            place.map_or(0.0, |(segment, end)| 1.0 / slopes[segment][end] - 1.0)
        };
        let tension = (0..2 * polygon.nodes()).map(side).collect();
        Self { polygon, slopes, tension }
    }

    /// The system without tension: every `λ` is one.
    pub(crate) fn without_tension(polygon: &'a DataPolygon) -> Self {
        let slopes = vec![[1.0; 2]; polygon.segments()];
        Self { polygon, slopes, tension: vec![0.0; 2 * polygon.nodes()] }
    }

    /// `[λ⁰, λ¹]` of each segment, and the larger tension beside each distinct node.
    pub(crate) fn into_parts(self) -> (Vec<[f64; 2]>, Vec<f64>) {
        let nodes = self.tension.chunks_exact(2).map(|sides| sides[0].max(sides[1]));
        (self.slopes, nodes.collect())
    }

    #[inline(always)]
    fn interior(&self, before: usize, after: usize) -> Row {
        self.between([before, after], [before, after].map(|segment| self.polygon.span(segment)))
    }

    /// The row of a node between two segments.
    #[inline(always)]
    fn between(&self, [before, after]: [usize; 2], [(chord0, h0), (chord1, h1)]: [Span; 2]) -> Row {
        let [w, v] = weights([h0, h1], [self.slopes[before][1], self.slopes[after][0]]);
        let velocities = chord0 * (w / h0) + chord1 * (v / h1);
        let [lower, diagonal, upper] = self.coefficients([before, after], [w, v]);
        Row { lower, diagonal, upper, right: velocities * 3.0 }
    }

    /// The left-hand side of an interior row.
    #[inline(always)]
    fn coefficients(&self, [before, after]: [usize; 2], [w, v]: [f64; 2]) -> [f64; 3] {
        let (far0, far1) = (self.slopes[before][0], self.slopes[after][1]);
        [w * far0, w * (3.0 - far0) + v * (3.0 - far1), v * far1]
    }

    /// End row: `T = D`, or no second derivative, `(3 − λ) T + λ T' = 3L/h`, with the `λ` of the
    /// segment's other end.
    fn end(&self, tangent: Option<DVec3>, segment: usize, far: f64) -> (f64, f64, DVec3) {
        match tangent {
            Some(d) => (1.0, 0.0, d),
            None => {
                let velocity = self.polygon.chord(segment) / self.polygon.spacing(segment);
                (3.0 - far, far, velocity * 3.0)
            }
        }
    }
}

/// `w = 1/(1+r)` and `1−w`, `r = h_{i−1}/h_i (λ¹_{i−1}/λ⁰_i)²`: neither is lost where `r` overflows or
/// vanishes.
#[inline]
fn weights([h0, h1]: [f64; 2], [near0, near1]: [f64; 2]) -> [f64; 2] {
    if near0 == near1 {
        // Halves first: the sum of two spacings can overflow where neither does.
        let reciprocal = 1.0 / (0.5 * h0 + 0.5 * h1);
        return [0.5 * h1 * reciprocal, 0.5 * h0 * reciprocal];
    }
    let ratio = near0 / near1;
    let r = (h0 / h1) * ratio * ratio;
    let w = 1.0 / (1.0 + r);
    [w, if w > 0.0 { r * w } else { 1.0 }]
}

/// The segment, and which of its ends, that a tension belongs to; `None` beyond an open end.
fn place_of(polygon: &DataPolygon, index: usize) -> Option<(usize, usize)> {
    let (node, n) = (index / 2, polygon.segments());
    match index % 2 {
        0 if node > 0 => Some((node - 1, 1)),
        0 if polygon.is_closed() => Some((n - 1, 1)),
        1 if node < n => Some((node, 0)),
        _ => None,
    }
}

impl Rows for ManniSystem<'_> {
    fn count(&self) -> usize {
        self.polygon.nodes()
    }

    fn is_cyclic(&self) -> bool {
        self.polygon.is_closed()
    }

    #[inline]
    fn row(&self, i: usize) -> Row {
        let last = self.polygon.segments() - 1;
        if i > 0 && i <= last {
            self.interior(i - 1, i)
        } else if self.is_cyclic() {
            self.interior(last, 0)
        } else if i == 0 {
            let tangent = self.polygon.tangents()[0];
            let (diagonal, upper, right) = self.end(tangent, 0, self.slopes[0][1]);
            Row { lower: 0.0, diagonal, upper, right }
        } else {
            let tangent = self.polygon.tangents()[1];
            let (diagonal, lower, right) = self.end(tangent, last, self.slopes[last][0]);
            Row { lower, diagonal, upper: 0.0, right }
        }
    }

    #[inline]
    fn try_each<E>(
        &self,
        rows: Range<usize>,
        take: impl FnMut(usize, Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let inside = |i: usize, spans| self.between([i - 1, i], spans);
        try_each_row(self.polygon, rows, inside, |i| self.row(i), take)
    }
}

impl TensionSystem for ManniSystem<'_> {
    /// Manni's own generality: the two `λ` beside a node are independent (Lemmas 4.2 and 4.3 need their
    /// ratio bounded, so raising takes them together).
    const SIDES: usize = 2;
    const TENSION_SCALES_LEGS: bool = true;

    fn polygon(&self) -> &DataPolygon {
        self.polygon
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn set_tension(&mut self, index: usize, tension: f64) {
        if let Some((segment, end)) = place_of(self.polygon, index) {
            self.tension[index] = tension;
            self.slopes[segment][end] = 1.0 / (1.0 + tension);
        }
    }

    /// The rows at both ends of the segment: its `λ` stands in that of its own node through the ratio of
    /// the two there, and in that of the other node (or natural end) as it is.
    fn dependent_rows(&self, index: usize, rows: &mut Vec<usize>) {
        if let Some((segment, _)) = place_of(self.polygon, index) {
            rows.extend([segment, (segment + 1) % self.count()]);
        }
    }

    #[inline]
    fn legs(&self, segment: usize, [first, last]: [DVec3; 2]) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        let [start, end] = self.slopes[segment];
        [first * (third * start), last * (third * end)]
    }

    fn tension_unit(&self, node: usize) -> f64 {
        tension_unit(self.polygon, node)
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
            let uneven = (0..8).map(|i| [1.0, if i == 5 { 0.5 } else { 1.0 }]).collect();
            for mut system in
                [ManniSystem::without_tension(&polygon), ManniSystem::new(&polygon, uneven)]
            {
                let mut kept: Vec<Row> = (0..system.count()).map(|i| system.row(i)).collect();
                for (index, tension) in [
                    (6, 2.0),
                    (1, 0.7),
                    (7, 3.0),
                    (2 * system.count() - 2, 9.0),
                    (6, 0.0),
                    (9, 1e9),
                ] {
                    let mut rows = Vec::new();
                    system.set_tension(index, tension);
                    system.dependent_rows(index, &mut rows);
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
}
