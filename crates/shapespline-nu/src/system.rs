//! The linear system of the tangents.

use shapespline_banded::{Row, Rows};
use shapespline_geometry::{DVec3, DataPolygon};
use shapespline_search::TensionSystem;

/// The system (3.3)–(3.11) of paper 001 for the tangents `q_i`, each interior row divided by
/// `h_{i−1} + h_i` so that its matrix has no unit: with `w = h_i/(h_{i−1} + h_i)`
///
/// `w q_{i−1} + (2 + ½√(w(1−w)) ν_i) q_i + (1−w) q_{i+1} = 3 (w L_{i−1}/h_{i−1} + (1−w) L_i/h_i)`.
///
/// Off-diagonal entries sum to at most half the diagonal.
#[derive(Debug)]
pub(crate) struct NuSystem<'a> {
    pub(crate) polygon: &'a DataPolygon,
    /// One a distinct node.
    pub(crate) tension: Vec<f64>,
}

impl NuSystem<'_> {
    fn interior(&self, before: usize, after: usize, tension: f64) -> Row {
        let (h0, h1) = (self.polygon.spacing(before), self.polygon.spacing(after));
        // Halves first: the sum of two spacings can overflow where neither does.
        let reciprocal = 1.0 / (0.5 * h0 + 0.5 * h1);
        let (lower, upper) = (0.5 * h1 * reciprocal, 0.5 * h0 * reciprocal);
        let velocities =
            self.polygon.chord(before) * (lower / h0) + self.polygon.chord(after) * (upper / h1);
        let pull = if tension > 0.0 { 0.5 * (lower * upper).sqrt() * tension } else { 0.0 };
        Row { lower, diagonal: 2.0 + pull, upper, right: velocities * 3.0 }
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
            let tangent = self.polygon.tangents().map(|d| d[0]);
            let (diagonal, upper, right) = self.end(tangent, 0, tension);
            Row { lower: 0.0, diagonal, upper, right }
        } else {
            let tangent = self.polygon.tangents().map(|d| d[1]);
            let (diagonal, lower, right) = self.end(tangent, segments - 1, tension);
            Row { lower, diagonal, upper: 0.0, right }
        }
    }
}

impl TensionSystem for NuSystem<'_> {
    const SCALES_LEGS: bool = false;

    fn polygon(&self) -> &DataPolygon {
        self.polygon
    }

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn set_tension(&mut self, node: usize, tension: f64, rows: &mut Vec<usize>) {
        self.tension[node] = tension;
        rows.push(node);
    }

    #[inline]
    fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        tangents.map(|q| q * third)
    }
}
