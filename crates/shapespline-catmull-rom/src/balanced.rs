//! Tangent directions that divide the turning angles evenly between neighbouring segments.
//!
//! A tangent strictly between its chords keeps the shape with handles that are short enough (crate
//! page). How short depends on the angles `φ` at the start and `ψ` at the end of a segment, between the
//! tangents and the chord: in the plane the start handle must be shorter than
//! `‖L‖ sin ψ/sin(φ + ψ)` and the end handle than `‖L‖ sin φ/sin(φ + ψ)`. Where the two angles differ
//! much, one handle is short and the curve has a corner.
//!
//! At each node the turning angle `θ_i = ψ_{i−1} + φ_i` is split so that `φ_i` and `ψ_i` become alike:
//! with `s_i = log(φ_i/ψ_{i−1})`, the least
//!
//! `Σ_segments log²(φ_i/ψ_i) + 0.01 Σ_nodes (s_i − s⁰_i)²`,
//!
//! `s⁰` being the split of the parametrisation's tangents, which makes the answer unique. Newton steps, or
//! Gauss–Newton ones where those do not lead downhill, with halving, one tridiagonal system each; O(N) per
//! step. The construction is this project's.

use rayon::prelude::*;
use shapespline_banded::{SolveError, solve_cyclic, solve_tridiagonal};
use shapespline_geometry::{DVec3, DataPolygon, length, normalize};

use crate::tangents::tangent;

/// Weight of the parametrisation's own split. Measured on the shared data sets: 0.1 leaves the largest
/// curvature of the hiking track half as large again, 0.0001 bends the protein backbone by a tenth more.
const ANCHOR: f64 = 0.01;

/// Turns beyond this angle keep the parametrisation's tangent: 170°, where the plane of the three points
/// is hardly defined.
const LARGEST_TURN: f64 = 170.0 / 180.0 * std::f64::consts::PI;

/// No angle between tangent and chord is made smaller than this, in radians: far above rounding and the
/// default zero tolerance, so that the plane of the three points stays known.
const SMALLEST_ANGLE: f64 = 1e-7;

/// Limit of steps; 4 to 12 are usual.
const STEPS: usize = 50;

/// Newton steps beyond this change of a logarithm are not trusted.
const LARGEST_STEP: f64 = 4.0;

/// The steps end when no split changes by more than this (in `s`, so relatively).
const ACCURACY: f64 = 1e-12;

/// Nodes per parallel task.
const BLOCK: usize = 4096;

/// What is known of one node.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// The parametrisation's tangent.
    tangent: DVec3,
    /// The angles `ψ_{i−1}, φ_i` of that tangent with the chords before and after; zero where there is
    /// no such chord.
    angles: [f64; 2],
    /// Whether the split is free: the node turns, by less than [`LARGEST_TURN`], and no four points around
    /// it lie in a plane that the rest of the points leave. Where the binormal flips on an inflecting
    /// coplanar segment depends on the directions, and coplanarity asks for it where the
    /// parametrisation's have it.
    is_free: bool,
}

/// The tangent at each point: of the length of the parametrisation's, in the balanced direction. Zero at
/// ends of zero curvature, whose legs follow the other end of their segment. O(N).
///
/// # Errors
/// None for finite angles: the systems are positive definite.
pub(crate) fn tangents(
    polygon: &DataPolygon,
    zero: f64,
    planar: bool,
) -> Result<Vec<DVec3>, SolveError> {
    let count = polygon.points().len();
    let nodes: Vec<Node> = if count < 2 * BLOCK {
        (0..count).map(|i| Node::new(polygon, i, zero, planar)).collect()
    } else {
        (0..count)
            .into_par_iter()
            .with_min_len(BLOCK)
            .map(|i| Node::new(polygon, i, zero, planar))
            .collect()
    };
    let splits = Splits::new(polygon, &nodes).minimize()?;
    let direct = |(i, node): (usize, &Node)| {
        let s = splits[if i < splits.len() { i } else { 0 }];
        if node.is_free { node.with_split(polygon, i, s) } else { node.tangent }
    };
    Ok(nodes.iter().enumerate().map(direct).collect())
}

impl Node {
    fn new(polygon: &DataPolygon, i: usize, zero: f64, planar: bool) -> Self {
        let n = polygon.segments();
        let tangent = tangent(polygon, i).unwrap_or_default();
        let has = [i > 0 || polygon.is_closed(), i < n || polygon.is_closed()];
        let [before, after] = polygon.directions_at(i);
        let direction = normalize(tangent);
        let to = |chord: DVec3, has: bool| if has { angle(chord, direction) } else { 0.0 };
        let angles = [to(before, has[0]), to(after, has[1])];
        let turns = has == [true; 2] && before.cross(after).length() > zero;
        let twist = planar || [i + n - 1, i].iter().all(|&k| twists(polygon, k % n, zero));
        let is_free = turns
            && angles.iter().all(|&a| a > 0.0)
            && angles[0] + angles[1] < LARGEST_TURN
            && twist;
        Self { tangent, angles, is_free }
    }

    /// The tangent that splits the turning angle with `log(φ/ψ) = s`.
    fn with_split(&self, polygon: &DataPolygon, i: usize, s: f64) -> DVec3 {
        let [before, after] = polygon.directions_at(i);
        let turn = self.angles[0] + self.angles[1];
        let floor = SMALLEST_ANGLE.min(self.angles[0]).min(self.angles[1]);
        let psi = (turn * sigmoid(-s)).clamp(floor, turn - floor);
        let phi = turn - psi;
        // Unit vectors in a plane: sin θ t = sin φ u + sin ψ u', with ψ from u to t and φ from t to u'.
        normalize(before * phi.sin() + after * psi.sin()) * length(self.tangent)
    }
}

/// Whether the four points around a segment do not lie in a plane; at an open end there are three.
fn twists(polygon: &DataPolygon, segment: usize, zero: f64) -> bool {
    let n = polygon.segments();
    if !polygon.is_closed() && (segment == 0 || segment + 1 >= n) {
        return true;
    }
    polygon.gamma(segment).abs() > zero
}

/// The angle between unit vectors, exact to rounding however small it is.
fn angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}

fn sigmoid(s: f64) -> f64 {
    1.0 / (1.0 + (-s).exp())
}

/// The sum of squares and its minimiser.
struct Splits<'a> {
    nodes: &'a [Node],
    closed: bool,
    /// `s⁰` at each distinct node.
    anchor: Vec<f64>,
}

impl<'a> Splits<'a> {
    fn new(polygon: &DataPolygon, nodes: &'a [Node]) -> Self {
        let split =
            |node: &Node| if node.is_free { (node.angles[1] / node.angles[0]).ln() } else { 0.0 };
        let anchor = nodes[..polygon.nodes()].iter().map(split).collect();
        Self { nodes, closed: polygon.is_closed(), anchor }
    }

    /// `log φ` and `log ψ` at a node for a split, and their derivatives: those of a node that is not
    /// free do not change.
    fn logs(&self, i: usize, s: f64) -> ([f64; 2], [f64; 2]) {
        let Node { angles: [psi, phi], is_free, .. } = self.nodes[i];
        if !is_free {
            return ([psi.ln(), phi.ln()], [0.0; 2]);
        }
        let turn = (psi + phi).ln();
        let [small, large] = [sigmoid(-s), sigmoid(s)];
        ([turn + small.ln(), turn + large.ln()], [-large, small])
    }

    /// Segments between two turning nodes: the node at the start, the one at the end.
    fn segments(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let count = self.anchor.len();
        let pairs = if self.closed { count } else { count - 1 };
        let turns = |i: usize, side: usize| {
            let node = &self.nodes[i];
            node.is_free
                || (node.angles[side] > 0.0 && node.angles[side] < LARGEST_TURN && self.is_end(i))
        };
        (0..pairs)
            .map(move |i| [i, (i + 1) % count])
            .filter(move |&[i, j]| turns(i, 1) && turns(j, 0))
    }

    /// Whether a node is an end with a given tangent: its angle is fixed, and counts.
    fn is_end(&self, i: usize) -> bool {
        !self.closed && (i == 0 || i + 1 == self.anchor.len())
    }

    fn value(&self, s: &[f64]) -> f64 {
        let anchors =
            s.iter().zip(&self.anchor).map(|(s, a)| ANCHOR * (s - a).powi(2)).sum::<f64>();
        let residual = |[i, j]: [usize; 2]| self.logs(i, s[i]).0[1] - self.logs(j, s[j]).0[0];
        anchors + self.segments().map(|pair| residual(pair).powi(2)).sum::<f64>()
    }

    fn minimize(&self) -> Result<Vec<f64>, SolveError> {
        let mut s = self.anchor.clone();
        let mut value = self.value(&s);
        for _ in 0..STEPS {
            let step = self.step(&s)?;
            let largest = step.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let mut scale = 1.0;
            while scale * largest > ACCURACY {
                let next: Vec<f64> = s.iter().zip(&step).map(|(s, d)| s + scale * d).collect();
                let lower = self.value(&next);
                // Near the end the sum is flat to rounding, and the step is better than it can tell.
                if lower <= value * (1.0 + 1e-14) {
                    (s, value) = (next, lower);
                    break;
                }
                scale *= 0.5;
            }
            if scale * largest <= ACCURACY {
                break;
            }
        }
        Ok(s)
    }

    /// A step of Newton's method where that leads downhill, else of Gauss and Newton's, which always
    /// does.
    fn step(&self, s: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut system = Normal::new(s, &self.anchor);
        for [i, j] in self.segments() {
            system.add([i, j], self.logs(i, s[i]), self.logs(j, s[j]));
        }
        let downhill = system.right.clone();
        if let Ok(step) = system.solve(self.closed, true) {
            let slope: f64 = step.iter().zip(&downhill).map(|(d, r)| d * r).sum();
            if slope > 0.0 && step.iter().all(|d| d.abs() <= LARGEST_STEP) {
                return Ok(step);
            }
        }
        system.solve(self.closed, false)
    }
}

/// The normal equations of one step, tridiagonal.
struct Normal {
    lower: Vec<f64>,
    diagonal: Vec<f64>,
    upper: Vec<f64>,
    /// What the residuals' own second derivatives add to the diagonal.
    curvature: Vec<f64>,
    right: Vec<f64>,
}

impl Normal {
    fn new(s: &[f64], anchor: &[f64]) -> Self {
        let n = s.len();
        let right = s.iter().zip(anchor).map(|(s, a)| ANCHOR * (a - s)).collect();
        let zero = vec![0.0; n];
        let (lower, upper, curvature) = (zero.clone(), zero.clone(), zero);
        Self { lower, diagonal: vec![ANCHOR; n], upper, curvature, right }
    }

    /// Adds the residual `log φ_i − log ψ_i` of a segment from node `i` to node `j`.
    fn add(
        &mut self,
        [i, j]: [usize; 2],
        at_start: ([f64; 2], [f64; 2]),
        at_end: ([f64; 2], [f64; 2]),
    ) {
        let residual = at_start.0[1] - at_end.0[0];
        let [di, dj] = [at_start.1[1], -at_end.1[0]];
        self.diagonal[i] += di * di;
        self.diagonal[j] += dj * dj;
        self.upper[i] += di * dj;
        self.lower[j] += di * dj;
        self.right[i] -= di * residual;
        self.right[j] -= dj * residual;
        // (log σ)'' = −σ(s)σ(−s), and the two first derivatives of a node are σ(−s) and −σ(s).
        self.curvature[i] += residual * at_start.1[0] * at_start.1[1];
        self.curvature[j] -= residual * at_end.1[0] * at_end.1[1];
    }

    fn solve(&self, closed: bool, newton: bool) -> Result<Vec<f64>, SolveError> {
        let Self { lower, diagonal, upper, curvature, right } = self;
        let with = |(d, c): (&f64, &f64)| if newton { d + c } else { *d };
        let mut diagonal: Vec<f64> = diagonal.iter().zip(curvature).map(with).collect();
        let mut step = right.clone();
        if closed {
            solve_cyclic(lower, &mut diagonal, upper, &mut step)?;
        } else {
            solve_tridiagonal(lower, &mut diagonal, upper, &mut step)?;
        }
        Ok(step)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;

    fn polygon(points: Vec<DVec3>, boundary: Boundary) -> DataPolygon {
        DataPolygon::new(points, &Parametrization::Centripetal, boundary).unwrap()
    }

    /// On a circle the balanced tangents are the circle's, whatever the spacing.
    #[test]
    fn tangents_of_a_circle_are_found_where_chords_are_uneven() {
        let angles: [f64; 9] = [0.0, 0.5, 0.6, 1.3, 2.0, 2.9, 4.0, 4.2, 5.3];
        let mut points: Vec<DVec3> =
            angles.iter().map(|a| DVec3::new(a.cos(), a.sin(), 0.0)).collect();
        points.push(points[0]);
        let polygon = polygon(points, Boundary::Periodic);
        let (before, after) = (
            (0..9).map(|i| tangent(&polygon, i).unwrap()).collect::<Vec<_>>(),
            tangents(&polygon, 1e-9, true).unwrap(),
        );
        let error = |tangents: &[DVec3]| {
            let off =
                |(a, t): (&f64, &DVec3)| angle(DVec3::new(-a.sin(), a.cos(), 0.0), normalize(*t));
            angles.iter().zip(tangents).map(off).fold(0.0, f64::max)
        };
        assert!(error(&after) < 0.3 * error(&before), "{} {}", error(&after), error(&before));
        assert_eq!(after[9], after[0]);
    }

    #[test]
    fn directions_lie_between_the_chords_and_do_not_depend_on_scale_or_direction() {
        let at = |k: usize| {
            let t = 0.9 * k as f64;
            DVec3::new(t.sin() * (1.0 + 0.1 * t), (1.7 * t).cos(), 0.3 * t * t)
        };
        for boundary in [Boundary::ZeroCurvature, Boundary::Circular] {
            let points: Vec<DVec3> = (0..30).map(at).collect();
            let forward = polygon(points.clone(), boundary);
            let found = tangents(&forward, 1e-9, false).unwrap();
            for i in 1..29 {
                let [u, v] = forward.directions_at(i);
                let (p, t) = (u.cross(v), normalize(found[i]));
                assert!(
                    u.cross(t).dot(p) > 0.0 && t.cross(v).dot(p) > 0.0 && t.dot(p).abs() < 1e-14
                );
            }
            let reversed = points.iter().rev().map(|&p| p * 1e80).collect();
            let back = tangents(&polygon(reversed, boundary), 1e-9, false).unwrap();
            for i in 1..29 {
                let [a, b] = [normalize(found[i]), normalize(back[29 - i])];
                assert!((a + b).length() < 1e-9, "{i}: {}", (a + b).length());
            }
        }
    }

    /// The sum that is minimised has no descent direction left.
    #[test]
    fn the_minimum_is_a_minimum() {
        let at =
            |k: usize| DVec3::new(k as f64, (k as f64 * 1.3).sin() * (1.0 + (k % 3) as f64), 0.0);
        let polygon = polygon((0..20).map(at).collect(), Boundary::ZeroCurvature);
        let nodes: Vec<Node> = (0..20).map(|i| Node::new(&polygon, i, 1e-9, true)).collect();
        let splits = Splits::new(&polygon, &nodes);
        let s = splits.minimize().unwrap();
        let least = splits.value(&s);
        for i in 0..20 {
            for change in [-1e-4, 1e-4] {
                let mut moved = s.clone();
                moved[i] += change;
                assert!(splits.value(&moved) >= least, "{i}");
            }
        }
        assert!(least < 0.7 * splits.value(&splits.anchor));
    }
}
