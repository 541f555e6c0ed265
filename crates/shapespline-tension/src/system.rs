//! The linear system of the tangents.

use shapespline_banded::{Row, Rows};
use shapespline_geometry::{DVec3, DataPolygon};
use shapespline_search::{TensionSystem, velocity_weight};

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
        Self { polygon, slopes, tension }
    }

    /// `[λ⁰, λ¹]` of each segment, and the tension of each distinct node.
    pub(crate) fn into_parts(self) -> (Vec<[f64; 2]>, Vec<f64>) {
        (self.slopes, self.tension)
    }

    fn interior(&self, before: usize, after: usize) -> Row {
        let (h0, h1) = (self.polygon.spacing(before), self.polygon.spacing(after));
        let ([far0, near0], [near1, far1]) = (self.slopes[before], self.slopes[after]);
        // w = 1/(1+r) and 1−w = 1/(1+1/r): neither is lost where r overflows or vanishes.
        let ratio = near0 / near1;
        let r = (h0 / h1) * ratio * ratio;
        let (w, v) = (1.0 / (1.0 + r), 1.0 / (1.0 + 1.0 / r));
        let (lower, upper) = (w * far0, v * far1);
        let velocities =
            self.polygon.chord(before) * (w / h0) + self.polygon.chord(after) * (v / h1);
        let diagonal = w * (3.0 - far0) + v * (3.0 - far1);
        Row { lower, diagonal, upper, right: velocities * 3.0 }
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
    fn set_tension(&mut self, node: usize, tension: f64, rows: &mut Vec<usize>) {
        self.tension[node] = tension;
        let lambda = 1.0 / (1.0 + tension);
        let (n, closed) = (self.polygon.segments(), self.polygon.is_closed());
        // The own row depends on it through the ratio of the two, and next to a natural end.
        rows.push(node);
        if node > 0 || closed {
            let before = if node > 0 { node - 1 } else { n - 1 };
            self.slopes[before][1] = lambda;
            rows.push(before);
        }
        if node < n {
            self.slopes[node][0] = lambda;
            rows.push(if closed { (node + 1) % n } else { node + 1 });
        }
    }

    #[inline]
    fn legs(&self, segment: usize, tangents: [DVec3; 2]) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        let [start, end] = self.slopes[segment];
        [tangents[0] * (third * start), tangents[1] * (third * end)]
    }

    fn weight(&self, node: usize) -> f64 {
        velocity_weight(self.polygon, node)
    }
}
