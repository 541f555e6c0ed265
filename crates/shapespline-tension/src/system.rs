//! The linear system of the tangents.

use std::ops::Range;

use shapespline_banded::{Row, Rows};
use shapespline_geometry::{DVec3, DataPolygon, Span};
use shapespline_search::{TensionSystem, try_each_row, velocity_weight};

/// The system (3.7)–(3.8) of paper 000 for the tangents `T_i`, each row divided by
/// `h_{i−1}(h_iλ⁰_i)² + h_i(h_{i−1}λ¹_{i−1})²` so that its matrix has no unit (see the crate's page).
///
/// Off-diagonal entries are at most 1 together, the diagonal is 3 less them.
#[derive(Debug)]
pub(crate) struct MannisSystem<'a> {
    polygon: &'a DataPolygon,
    /// `[λ⁰, λ¹]` of each segment.
    slopes: Vec<[f64; 2]>,
    /// `1/λ − 1` at each distinct node, of the smaller `λ` beside it.
    tension: Vec<f64>,
    /// Whether there is one `λ` on both sides of every node.
    even: bool,
}

impl<'a> MannisSystem<'a> {
    /// The system of given `λ`, each in `(0, 1]`, one pair a segment.
    pub(crate) fn new(polygon: &'a DataPolygon, slopes: Vec<[f64; 2]>) -> Self {
        let n = polygon.segments();
        let at = |i: usize| {
            let before = match i {
                0 if polygon.is_closed() => slopes[n - 1][1],
                0 => 1.0,
                _ => slopes[i - 1][1],
            };
            let after = if i < n { slopes[i][0] } else { 1.0 };
            1.0 / f64::min(before, after) - 1.0
        };
        let tension = (0..polygon.nodes()).map(at).collect();
        let meet = |pair: &[[f64; 2]]| pair[0][1] == pair[1][0];
        let even = slopes.windows(2).all(meet) && (slopes[n - 1][1] == slopes[0][0]);
        Self { polygon, slopes, tension, even }
    }

    /// The system without tension: every `λ` is one.
    pub(crate) fn without_tension(polygon: &'a DataPolygon) -> Self {
        let (slopes, tension) = (vec![[1.0; 2]; polygon.segments()], vec![0.0; polygon.nodes()]);
        Self { polygon, slopes, tension, even: true }
    }

    /// `[λ⁰, λ¹]` of each segment, and the tension of each distinct node.
    pub(crate) fn into_parts(self) -> (Vec<[f64; 2]>, Vec<f64>) {
        (self.slopes, self.tension)
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
    #[inline]
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

impl Rows for MannisSystem<'_> {
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
            let tangent = self.polygon.tangents().map(|d| d[0]);
            let (diagonal, upper, right) = self.end(tangent, 0, self.slopes[0][1]);
            Row { lower: 0.0, diagonal, upper, right }
        } else {
            let tangent = self.polygon.tangents().map(|d| d[1]);
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

impl TensionSystem for MannisSystem<'_> {
    const SCALES_LEGS: bool = true;

    fn polygon(&self) -> &DataPolygon {
        self.polygon
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    /// One `λ` for both sides of the node: Lemmas 4.2–4.3 need their ratio bounded.
    fn set_tension(&mut self, node: usize, tension: f64) {
        self.tension[node] = tension;
        let lambda = 1.0 / (1.0 + tension);
        let n = self.polygon.segments();
        if node > 0 || self.polygon.is_closed() {
            self.slopes[if node > 0 { node - 1 } else { n - 1 }][1] = lambda;
        }
        if node < n {
            self.slopes[node][0] = lambda;
        }
    }

    /// The own row depends on it through the ratio of the two, and next to a natural end.
    fn rows_of(&self, node: usize, rows: &mut Vec<usize>) {
        let n = self.polygon.segments();
        if self.polygon.is_closed() {
            rows.extend([(node + n - 1) % n, node, (node + 1) % n]);
        } else {
            rows.extend(node.saturating_sub(1)..=(node + 1).min(n));
        }
    }

    /// With one `λ` on both sides of a node, the weights and the right-hand side of its row do not depend
    /// on it.
    #[inline]
    fn renew(&self, i: usize, row: &mut Row) {
        if !self.even || i == 0 || i == self.polygon.segments() {
            *row = self.row(i);
            return;
        }
        let spacings = [self.polygon.spacing(i - 1), self.polygon.spacing(i)];
        let weights = weights(spacings, [1.0; 2]);
        let [lower, diagonal, upper] = self.coefficients([i - 1, i], weights);
        *row = Row { lower, diagonal, upper, ..*row };
    }

    #[inline]
    fn legs(&self, segment: usize, [first, last]: [DVec3; 2]) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        let [start, end] = self.slopes[segment];
        [first * (third * start), last * (third * end)]
    }

    fn weight(&self, node: usize) -> f64 {
        velocity_weight(self.polygon, node)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    #[test]
    fn a_row_is_renewed_as_it_would_be_made() {
        let ends = Boundary::Tangents { start: DVec3::new(1.0, 2.0, -1.0), end: DVec3::Y };
        for boundary in [Boundary::ZeroCurvature, Boundary::Periodic, ends] {
            let at = |k: usize| {
                DVec3::new((0.3 * (k * k) as f64).sin(), (1.7 * k as f64).cos(), k as f64)
            };
            let mut points: Vec<DVec3> = (0..9).map(at).collect();
            points[8] = if boundary == Boundary::Periodic { points[0] } else { points[8] };
            let polygon = DataPolygon::new(points, &Parametrization::Chordal, boundary).unwrap();
            let uneven = (0..8).map(|i| [1.0, if i == 5 { 0.5 } else { 1.0 }]).collect();
            for mut system in
                [MannisSystem::without_tension(&polygon), MannisSystem::new(&polygon, uneven)]
            {
                let mut kept: Vec<Row> = (0..system.count()).map(|i| system.row(i)).collect();
                for (node, tension) in
                    [(3, 2.0), (0, 0.7), (system.count() - 1, 9.0), (3, 0.0), (4, 1e9)]
                {
                    let mut rows = Vec::new();
                    system.set_tension(node, tension);
                    system.rows_of(node, &mut rows);
                    for i in rows {
                        system.renew(i, &mut kept[i]);
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
