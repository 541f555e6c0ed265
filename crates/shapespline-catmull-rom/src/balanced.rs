// SPDX-License-Identifier: MIT OR Apache-2.0

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
//! Gauss–Newton ones where those do not lead downhill, with halving, one tridiagonal system each.
//!
//! A split is felt by its neighbours at a factor of at most 0.82 or so per node: where `φ_i = ψ_{i−1}`, that is
//! the root of `x² + (2 + 4·0.01)x + 1`. So long polygons are balanced block by block, each with so many nodes
//! beside it that what is further away is below rounding. Cost O(N), on all threads for long curves; the
//! construction is this project's.

use std::ops::Range;

use shapespline_banded::SolveError;
use shapespline_geometry::{DVec3, DataPolygon, normalize};
use shapespline_polynomial::parallel;

mod node;
mod normal;

use node::{At, Node};
use normal::{ANCHOR, Normal, STRIDE};

/// Limit of steps; 3 to 8 are usual.
const STEPS: usize = 50;

/// The steps end when no split changes by more than this (in `s`, so relatively).
const ACCURACY: f64 = 1e-12;

/// Newton's last step: the next would be some square of it.
const LAST_STEP: f64 = 1e-7;

/// Nodes whose splits change by less than this rest, unless one of so many nodes on each side does not.
const ASLEEP: f64 = 1e-9;
const AROUND: usize = 8;

/// Nodes per block.
const BLOCK: usize = 2048;

/// Nodes on each side of a block that are balanced with it: `0.82^192` is below rounding.
const BESIDE: usize = 192;

/// Nodes from which on blocks are balanced on all threads.
const MANY: usize = 8192;

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
    let count = polygon.nodes();
    let mut tangents: Vec<DVec3> = bytemuck::zeroed_vec(polygon.points().len());
    let balance = |splits: &mut Splits, start: usize, out: &mut [DVec3]| {
        splits.load(polygon, start..start + out.len(), zero, planar);
        splits.minimize()?;
        splits.write(out);
        Ok(())
    };
    let all = &mut tangents[..count];
    parallel::parts::<_, _, _, Result<(), _>>(all, BLOCK, MANY, Splits::default, balance)?;
    // Of closed data the last point is the first.
    if count < tangents.len() {
        tangents[count] = tangents[0];
    }
    Ok(tangents)
}

/// The sum of squares over a block of nodes, and its minimiser.
#[derive(Debug, Default)]
struct Splits {
    nodes: Vec<Node>,
    /// Whether the last node is followed by the first.
    cyclic: bool,
    /// Nodes before those that the block is made for.
    skipped: usize,
    /// The splits, what is tried next, and what that makes of the angles.
    s: Vec<f64>,
    next: Vec<f64>,
    at: Vec<At>,
    /// The nodes whose splits still move: ascending, with others between them.
    awake: Vec<Range<usize>>,
    system: Normal,
}

impl Splits {
    /// Reads some nodes of a polygon and those beside them.
    fn load(&mut self, polygon: &DataPolygon, own: Range<usize>, zero: f64, planar: bool) {
        let (n, count) = (polygon.segments(), polygon.nodes());
        self.cyclic = polygon.is_closed() && own.len() == count;
        let beside = if own.len() == count { 0 } else { BESIDE };
        // Of closed data the second round, so that there is room before the first node.
        let (round, end) = if polygon.is_closed() { (count, 3 * count) } else { (0, count) };
        let start = (round + own.start).saturating_sub(beside);
        let nodes = start..(round + own.end + beside).min(end);
        self.skipped = round + own.start - nodes.start;
        // The direction of the chord that is so many after the one before a node, and whether the four
        // points around that lie in no plane.
        let segment = |node: usize, by: usize| match polygon.is_closed() {
            true => Some((node + n + by - 1) % n),
            false => (node + by).checked_sub(1).filter(|&i| i < n),
        };
        let direction = |node: usize, by: usize| {
            segment(node, by).map_or(DVec3::ZERO, |i| normalize(polygon.chord(i)))
        };
        let twists = |[a, b, c]: [DVec3; 3]| {
            let inside = a != DVec3::ZERO && c != DVec3::ZERO;
            planar || !inside || a.cross(b).dot(c).abs() > zero
        };
        let first = nodes.start;
        let mut chords: [DVec3; 4] = [
            if first > 0 { direction(first - 1, 0) } else { DVec3::ZERO },
            direction(first, 0),
            direction(first, 1),
            direction(first, 2),
        ];
        let mut twist_before = twists([chords[0], chords[1], chords[2]]);
        self.nodes.clear();
        for node in nodes {
            let twist = twists([chords[1], chords[2], chords[3]]);
            let (i, around) = (node % count, [chords[1], chords[2]]);
            self.nodes.push(Node::new(polygon, i, around, zero, twist_before && twist));
            chords = [chords[1], chords[2], chords[3], direction(node, 3)];
            twist_before = twist;
        }
    }

    /// Writes the tangents of the nodes that the block is made for.
    fn write(&self, tangents: &mut [DVec3]) {
        let nodes = self.nodes.iter().zip(&self.s).skip(self.skipped);
        for (out, (node, s)) in tangents.iter_mut().zip(nodes) {
            *out = node.with_split(*s);
        }
    }

    fn minimize(&mut self) -> Result<(), SolveError> {
        self.start();
        for _ in 0..STEPS {
            let is_newton = self.step()?;
            let awake = || self.awake.iter().flat_map(Range::clone);
            let largest = awake().fold(0.0, |most: f64, i| most.max(self.system.step[i].abs()));
            let is_last = is_newton && largest <= LAST_STEP;
            let value = self.sum();
            let mut scale = 1.0;
            while scale * largest > ACCURACY {
                self.go(scale);
                // Near the end the sum is flat to rounding, and the step is better than it can tell.
                if is_last || self.sum() <= value * (1.0 + 1e-13) {
                    break;
                }
                scale *= 0.5;
            }
            if scale * largest <= ACCURACY {
                break;
            }
            let Self { s, next, awake, .. } = &mut *self;
            awake.iter().for_each(|r| s[r.clone()].copy_from_slice(&next[r.clone()]));
            if is_last {
                break;
            }
            self.let_sleep();
        }
        Ok(())
    }

    /// A start that needs fewer steps than `s⁰`: that for which each angle is the geometric mean of the two at
    /// its segment, but for what they do to the turning angles.
    fn start(&mut self) {
        let n = self.nodes.len();
        self.awake.clear();
        self.awake.push(0..n);
        self.system.begin(n);
        self.s.clear();
        self.s.extend(self.nodes.iter().map(|node| node.anchor));
        self.go(0.0);
        let Self { nodes, cyclic, s, at, .. } = &mut *self;
        for [i, j] in pairs(nodes, 0..n, *cyclic) {
            let half = 0.5 * (at[i].phi - at[j].psi);
            s[i] -= if nodes[i].is_free { half } else { 0.0 };
            s[j] -= if nodes[j].is_free { half } else { 0.0 };
        }
        self.go(0.0);
    }

    /// Tries the splits that are so much of a step away.
    fn go(&mut self, scale: f64) {
        let Self { nodes, s, next, at, awake, system, .. } = self;
        next.resize(nodes.len(), 0.0);
        at.resize(nodes.len(), At::default());
        for i in awake.iter().flat_map(Range::clone) {
            next[i] = s[i] + scale * system.step[i].clamp(-STRIDE, STRIDE);
            at[i] = nodes[i].at(next[i]);
        }
    }

    /// The sum for the splits tried last, as far as awake nodes have a share in it.
    fn sum(&self) -> f64 {
        let Self { nodes, cyclic, next, at, awake, .. } = self;
        let of = |range: &Range<usize>| {
            let anchors = range.clone().map(|i| (next[i] - nodes[i].anchor).powi(2));
            let residuals = pairs(nodes, range.clone(), *cyclic);
            let residuals = residuals.map(|[i, j]| (at[i].phi - at[j].psi).powi(2));
            ANCHOR * anchors.sum::<f64>() + residuals.sum::<f64>()
        };
        awake.iter().map(of).sum()
    }

    /// A step of the nodes awake, others held: Newton's, but that where nodes still move much residuals with
    /// negative curvature lend it none, and where that does not lead downhill none do. Whether it is Newton's
    /// throughout.
    fn step(&mut self) -> Result<bool, SolveError> {
        let Self { nodes, cyclic, s, at, awake, system, .. } = self;
        let mut is_newton = true;
        for range in awake {
            for i in range.clone() {
                system.clear(i, ANCHOR * (nodes[i].anchor - s[i]));
            }
            for [i, j] in pairs(nodes, range.clone(), *cyclic) {
                system.add([i, j], [at[i], at[j]]);
            }
            is_newton &= system.solve(range.clone(), *cyclic)?;
        }
        Ok(is_newton)
    }

    /// Leaves those awake that moved, and the nodes beside them. Of a cyclic block all stay awake.
    fn let_sleep(&mut self) {
        let Self { cyclic, awake, system, nodes, .. } = self;
        if *cyclic {
            return;
        }
        let mut still: Vec<Range<usize>> = Vec::new();
        for i in awake.iter().flat_map(Range::clone).filter(|&i| system.step[i].abs() > ASLEEP) {
            let (start, end) = (i.saturating_sub(AROUND), (i + AROUND + 1).min(nodes.len()));
            match still.last_mut() {
                Some(last) if start <= last.end => last.end = end,
                _ => still.push(start..end),
            }
        }
        *awake = still;
    }
}

/// Pairs of neighbours, with one of some nodes among them, whose angles with the segment between them are to
/// be alike.
fn pairs(
    nodes: &[Node],
    among: Range<usize>,
    cyclic: bool,
) -> impl Iterator<Item = [usize; 2]> + '_ {
    let pairs = among.start.max(1)..(among.end + 1).min(nodes.len());
    let seam = cyclic.then_some([nodes.len() - 1, 0]);
    let pairs = pairs.map(|j| [j - 1, j]).chain(seam);
    pairs.filter(|&[i, j]| nodes[i].counts[1] && nodes[j].counts[0])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, Parametrization, length};

    use super::{node::angle, *};
    use crate::tangents::tangent;

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
        let mut splits = Splits::default();
        splits.load(&polygon, 0..20, 1e-9, true);
        splits.minimize().unwrap();
        let s = splits.s.clone();
        let anchors = splits.nodes.iter().map(|node| node.anchor).collect();
        splits.awake = std::iter::once(0..20).collect();
        let mut value = |s: Vec<f64>| {
            splits.s = s;
            splits.go(0.0);
            splits.sum()
        };
        let least = value(s.clone());
        for i in 0..20 {
            for change in [-1e-4, 1e-4] {
                let mut moved = s.clone();
                moved[i] += change;
                assert!(value(moved) >= least, "{i}");
            }
        }
        assert!(least < 0.7 * value(anchors));
    }

    /// Whatever block a node lies in, and from wherever nodes are counted.
    #[test]
    fn blocks_make_what_one_system_makes() {
        let at = |k: usize| {
            let t = k as f64;
            let lift = if k / 50 % 7 == 3 { 0.0 } else { (1.3 * t).cos() };
            DVec3::new((0.01 * t).cos() * 300.0, (0.01 * t).sin() * 300.0 + (0.9 * t).sin(), lift)
        };
        let n = MANY + 100;
        for boundary in [Boundary::ZeroCurvature, Boundary::Circular, Boundary::Periodic] {
            let mut points: Vec<DVec3> = (0..=n).map(at).collect();
            if boundary == Boundary::Periodic {
                points[n] = points[0];
            }
            let polygon = polygon(points, boundary);
            let (count, zero) = (polygon.nodes(), 1e-9);
            let blocks = tangents(&polygon, zero, false).unwrap();
            let mut whole = vec![DVec3::ZERO; count];
            let mut splits = Splits::default();
            splits.load(&polygon, 0..count, zero, false);
            splits.minimize().unwrap();
            splits.write(&mut whole);
            assert!(splits.nodes.iter().any(|node| node.is_free));
            assert!(splits.nodes[1..n].iter().any(|node| !node.is_free));
            for (i, (a, b)) in blocks.iter().zip(&whole).enumerate() {
                assert!((*a - *b).length() <= 1e-11 * length(*b), "{i}: {a} {b}");
            }
        }
    }
}
