// SPDX-License-Identifier: MIT OR Apache-2.0

//! A strictly feasible start in closed form.
//!
//! At a node between chord directions `u, u'` with turn `θ`, binormal `P̂`, bisector `T` and
//! `N = P̂ × T`, the tangent is `t = αu + βu'`, and the osculating plane has the normal `B = P̂ + x`,
//! tilted so that it leaves both chords on the sides that the torsions ask for: `B·u = σe`,
//! `B·u' = σ'e`. With handles `q = m t` and curvature `∝ k` every condition holds for small enough `m`
//! and `k`: the middle leg tends to the chord, the determinants to `σB·L`, `σ det(t, L, t')` and `σB'·L`,
//! the control polygon is convex along both normals, and the cones hold since the tilt is small beside
//! them. (Derived here; of 280 polygons of seven kinds none took more than 27 reductions.)

use glam::DVec3;
use shapespline_geometry::{DataPolygon, normalize};

use crate::{element::Node, segment::Demands};

/// How a start is scaled: the tilt of the osculating plane, the handles, and the curvature.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    pub(crate) tilt: f64,
    pub(crate) handle: f64,
    pub(crate) curvature: f64,
}

/// The start at a node.
pub(crate) fn start(demands: &Demands<'_>, node: usize, scales: Scales) -> Node {
    let polygon = demands.checker.polygon();
    let sides = sides(polygon, node);
    let [u, v] = polygon.directions_at(node);
    let spans = sides.map(|side| side.map(|i| demands.span(i)));
    let [before, after] = match spans {
        [Some(a), Some(b)] => [a, b],
        [Some(a), None] | [None, Some(a)] => [a, a],
        [None, None] => return Node::default(),
    };
    let speed = before.speed().min(after.speed());
    let (h0, h1) = (before.length, after.length);
    let cosine = u.dot(v);
    let low = 0.1 + 0.4 * ((1.0 - cosine) / 1.7).clamp(0.0, 1.0);
    // Where a segment inflects near a plane, its two handles say where, and have to agree.
    let is_even = sides.into_iter().flatten().any(|i| demands.is_split(i));
    let alpha = if is_even { 0.5 } else { (h1 / (h0 + h1)).clamp(low, 1.0 - low) };
    let beta = 1.0 - alpha;
    let mut t = u * alpha + v * beta;
    if let Some(line) = demands.runs.line(node) {
        return Node { q: line * (scales.handle * speed), r: DVec3::ZERO };
    }
    let p = u.cross(v);
    let sine = p.length();
    if sine <= demands.checker.tolerances().zero || t.length() < 1e-12 {
        let t = demands.constraints.direction(node).unwrap_or(t / t.length().max(1e-12));
        return Node { q: t * (scales.handle * speed), r: DVec3::ZERO };
    }
    let normal = p / sine;
    let limits = sides.into_iter().flatten().map(|i| tilt_limit(demands, i));
    let limit = limits.fold(1.0, f64::min);
    let size = scales.tilt * 0.1 * alpha.min(beta) * sine * limit;
    let [s0, s1] = sides.map(|side| side.map_or(0.0, |i| demands.torsion(i)));
    let x = match demands.constraints.direction(node) {
        None => {
            let x = tilt(demands, node, t, [u, v]);
            // Out of the plane of the chords by `size`, also where the lean is nearly along it: across chords that
            // turn back, `size` of lean would not be seen in the control points.
            let out = x.dot(u).abs().max(x.dot(v).abs()) / x.length().max(f64::MIN_POSITIVE);
            let x = x * (size / out.max(size));
            let size = if is_even { t.length() } else { 1.0 };
            t = (t - normal * x.dot(t)).normalize() * size;
            x
        }
        Some(direction) => {
            let narrow = sides.into_iter().flatten().map(|i| cosine_limit(demands, i));
            let e = size * narrow.fold(1.0, f64::min);
            t = direction;
            let (sum, difference) = (u + v, v - u);
            let bisector = sum.normalize_or_zero();
            let [a, b] = tilts(t, [u, v], normal, [s0, s1], e);
            bisector * ((a + b) / sum.length().max(1e-6))
                + normal.cross(bisector) * ((b - a) / difference.length().max(1e-300))
        }
    };
    let r = (normal + x).cross(t).normalize() * t.length();
    let natural = 2.0 * sine / (h0 + h1);
    Node {
        q: t * (scales.handle * speed),
        r: r * (scales.handle * scales.curvature * natural * speed * speed),
    }
}

/// Where the cosine of the angle between two binormals is smaller than this, it is the tilt that decides on which
/// side of the one the osculating plane at the other lies.
const STEEP: f64 = 0.3;

/// Where the normal of the osculating plane at a node leans, off the binormal and in the plane of the two chords:
/// towards the sides that torsion asks for and, where the binormals at the other ends are nearly perpendicular,
/// those that they ask for. Of length one, or shorter where less lean is allowed.
fn tilt(demands: &Demands<'_>, node: usize, t: DVec3, [u, v]: [DVec3; 2]) -> DVec3 {
    let polygon = demands.checker.polygon();
    let normal = normalize(u.cross(v));
    let sides = sides(polygon, node);
    let torsions =
        [0, 1].map(|at| sides[at].map_or(DVec3::ZERO, |i| [u, v][at] * demands.torsion(i)));
    let own: Vec<DVec3> = torsions.into_iter().filter(|t| *t != DVec3::ZERO).collect();
    // The cosine, and where a lean keeps `B` and `t × L` on the side of the other binormal.
    let mut pairs = Vec::new();
    for (at, i) in sides.into_iter().enumerate() {
        let Some(i) = i.filter(|&i| demands.asks_pair(i)) else { continue };
        let [p, q] = polygon.binormals(i);
        let other = normalize(if at == 0 { p } else { q });
        let cosine = normal.dot(other);
        let other = other * cosine.signum();
        let beside = if at == 0 { u.cross(normal) } else { normal.cross(v) };
        pairs.push((cosine.abs(), other - normal * cosine.abs()));
        pairs.push((cosine.abs(), t * -beside.dot(other)));
    }
    let steep = pairs.iter().filter(|pair| pair.0 < STEEP).map(|pair| pair.1);
    let all: Vec<DVec3> = own.iter().copied().chain(steep).collect();
    let direction = [all, own].iter().find_map(|asked| towards(asked)).unwrap_or(DVec3::ZERO);
    let room = |&(cosine, side): &(f64, DVec3)| cosine / (-side.dot(direction)).max(cosine);
    direction * pairs.iter().map(room).fold(1.0, f64::min)
}

/// Products of unit vectors above which rounding leaves them their sign. Chords that turn back all but exactly leave a
/// lean towards both sides no more than half the sine of their turn.
const SEEN: f64 = 1e-8;

/// The unit vector whose least product with some coplanar vectors is largest, if that is positive: it is equally
/// far from two of them, or one of them.
fn towards(vectors: &[DVec3]) -> Option<DVec3> {
    let units: Vec<DVec3> = vectors.iter().map(|v| v.normalize_or_zero()).collect();
    let candidates = (0..units.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let least = |d: DVec3| units.iter().map(|u| u.dot(d)).fold(f64::INFINITY, f64::min);
    let candidates = candidates.map(|(i, j)| (units[i] + units[j]).normalize_or_zero());
    let best = candidates.max_by(|a, b| least(*a).total_cmp(&least(*b)))?;
    (least(best) > SEEN).then_some(best)
}

/// `[B·u, B·v]` of an osculating plane that holds a given tangent, with the signs asked for as far as can be:
/// with `t = αu + βv + γP̂` it has to be `α B·u + β B·v = −γ`. Near `e` in size.
fn tilts(t: DVec3, [u, v]: [DVec3; 2], normal: DVec3, signs: [f64; 2], e: f64) -> [f64; 2] {
    let out = t.dot(normal);
    let flat = t - normal * out;
    let det = u.cross(v).dot(normal);
    let [a, b] = [flat.cross(v).dot(normal) / det, u.cross(flat).dot(normal) / det];
    let [mut x, mut y] = signs.map(|sign| sign * e);
    // What is missing goes to the side whose sign it has, or to that of which nothing is asked.
    let missing = -out - a * x - b * y;
    if a > 0.0 && (signs[0] * missing > 0.0 || signs[0] == 0.0) {
        x += missing / a;
    } else {
        y += missing / b.max(1e-6);
    }
    [x, y]
}

/// The segments before and after a node.
pub(crate) fn sides(polygon: &DataPolygon, node: usize) -> [Option<usize>; 2] {
    let n = polygon.segments();
    if polygon.is_closed() {
        [Some((node + n - 1) % n), Some(node % n)]
    } else {
        [node.checked_sub(1), (node < n).then_some(node)]
    }
}

/// How far a segment lets the osculating planes at its nodes tilt.
fn tilt_limit(demands: &Demands<'_>, i: usize) -> f64 {
    let polygon = demands.checker.polygon();
    let [p, q] = polygon.binormals(i);
    let sines = p.length() * q.length();
    let mut limit = 1.0f64;
    if demands.torsion(i) != 0.0 {
        limit = limit.min(demands.gamma(i).abs() / sines.max(1e-300));
    }
    if demands.is_coplanar(i) {
        limit = limit.min(demands.checker.tolerances().coplanarity);
    }
    limit
}

/// The cosine of the angle between the binormals of a segment, where that matters.
fn cosine_limit(demands: &Demands<'_>, i: usize) -> f64 {
    let [p, q] = demands.checker.polygon().binormals(i);
    if demands.asks_pair(i) { p.dot(q).abs() / (p.length() * q.length()).max(1e-300) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_criteria::{Checker, Criteria, Tolerances};
    use shapespline_geometry::{Boundary, Parametrization};

    use super::*;
    use crate::{
        Constraints, chain::Chain, cubic::Plain, rows::Rules, runs::Runs, starts::restart_all,
        units::Units, window::Window,
    };

    /// Points of a walk in space or in the plane, lengths over one decade.
    fn walk(seed: u64, planar: bool) -> DataPolygon {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut at = DVec3::ZERO;
        let mut points = vec![at];
        for _ in 0..12 {
            let (length, angle) = (10f64.powf(next()), std::f64::consts::TAU * next());
            let z = if planar { 0.0 } else { 2.0 * next() - 1.0 };
            let across = (1.0 - z * z).sqrt();
            at += DVec3::new(angle.cos() * across, angle.sin() * across, z) * length;
            points.push(at);
        }
        natural(points)
    }

    fn natural(points: Vec<DVec3>) -> DataPolygon {
        DataPolygon::new(points, &Parametrization::Chordal, Boundary::ZeroCurvature).unwrap()
    }

    /// The whole curve with all nodes at the start.
    fn started(polygon: &DataPolygon) -> Chain {
        let checker = Checker::new(polygon, Criteria::DEFAULT, Tolerances::default());
        let (units, constraints) = (Units::of(polygon), &Constraints::default());
        let runs = &Runs::default();
        let demands = Demands { checker: &checker, units, constraints, runs };
        let plain = Plain::of(polygon).unwrap();
        let rules = Rules { cones: [0.19, 0.19], exact_middles: false };
        let whole = Window { start: 0, count: polygon.nodes() };
        let mut chain = whole.chain(&demands, &|i| plain.node(i, units), rules);
        restart_all(&demands, &mut chain);
        chain
    }

    #[test]
    fn every_polygon_has_a_start() {
        for seed in 0..60 {
            let chain = started(&walk(seed, seed % 2 == 0));
            assert!(chain.all_hold(), "walk {seed}: {:?}", chain.failing());
        }
    }

    /// Points that turn back one after the other: found by a generator, where the start had handles of 1e−9 chords that
    /// rounding hides.
    #[test]
    fn starts_between_reversals_are_seen() {
        let points = [
            [-0.43478286738309246, -0.1781438103924261, -0.6456400755458886],
            [0.3175042695176351, -0.5997965148940891, -0.6800114947443152],
            [-0.5460994299109536, 0.13742956217793312, -1.509353035824971],
            [0.31747934042074655, -0.5997640576933203, -0.6799833983196678],
            [1.3061030584500304, -0.865555449463584, -0.5888696537857449],
        ];
        let polygon = natural(points.map(DVec3::from).to_vec());
        let chain = started(&polygon);
        assert!(chain.all_hold(), "{:?}", chain.failing());
        assert!(chain.nodes.iter().all(|node| node.q.length() > 1e-7));
    }
}
