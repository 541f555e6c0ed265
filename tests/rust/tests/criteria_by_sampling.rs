// SPDX-License-Identifier: MIT OR Apache-2.0

//! Verdicts against dense sampling: code of its own, from positions and derivatives at 2,001 places a
//! segment, without Bézier legs.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use shapespline::criteria::{CurveChecker, INTERPOLATION, inflection_parameter};
use shapespline::geometry::PiecewiseBezier;
use shapespline::prelude::*;
use shapespline_tests::{
    generate::Random,
    segments::{SEGMENT, case},
};

const SAMPLES: usize = 2000;
const EPSILON: f64 = 0.2;

/// Local parameter, position and three derivatives at each sample.
type Samples = Vec<Sample>;
type Sample = (f64, [DVec3; 4]);

/// Sampled margin: positive where the samples say that the criterion holds; its size says how close
/// to deciding otherwise the samples are.
///
/// `corners`: whether the curve has corners at the ends of the segment, where turning asks more.
fn sampled(polygon: &DataPolygon, curve: &Samples, criterion: Criterion, corners: bool) -> f64 {
    let points = polygon.points();
    let l = |i: usize| points[i + 1] - points[i];
    let m = SEGMENT;
    let normals = [l(m - 1).cross(l(m)).normalize(), l(m).cross(l(m + 1)).normalize()];
    let last = curve.len() - 1;
    let omega = |d: &[DVec3; 4]| d[1].cross(d[2]);
    let least = |f: &dyn Fn(&[DVec3; 4]) -> f64| {
        curve.iter().map(|(_, d)| f(d)).fold(f64::INFINITY, f64::min)
    };
    let size = (-least(&|d| -omega(d).length_squared())).sqrt();
    let parts = |axis: DVec3, from: f64, to: f64, vector: &dyn Fn(&[DVec3; 4]) -> DVec3| {
        let mut side = 0.0;
        let mut margin = f64::INFINITY;
        for (t, d) in curve {
            if !(from..=to).contains(t) {
                continue;
            }
            let v = vector(d);
            margin = margin.min(EPSILON - v.cross(axis).length() / v.length());
            if side * v.dot(axis) < 0.0 {
                margin = margin.min(EPSILON - 1.0);
            }
            side = v.dot(axis).signum();
        }
        margin
    };
    match criterion {
        Criterion::Convexity => {
            least(&|d| normals.map(|n| omega(d).dot(n)).into_iter().fold(1e300, f64::min)) / size
        }
        Criterion::GlobalConvexity => {
            let start = curve[0].1;
            let margin = |k: usize| {
                let (t, d) = &curve[k];
                let chord = d[0] - start[0];
                let inner = chord.cross(d[1]) * (2.0 / t / t);
                let outer = start[1].cross(chord) * (2.0 / t / t);
                let all = [omega(d), inner, outer];
                let both = normals.map(|n| all.map(|v| v.dot(n)).into_iter().fold(1e300, f64::min));
                both[0].min(both[1])
            };
            let later = (1..=last).map(margin).fold(f64::INFINITY, f64::min);
            later.min(sampled(polygon, curve, Criterion::Convexity, corners) * size) / size
        }
        Criterion::Torsion => {
            let gamma = l(m - 1).cross(l(m)).dot(l(m + 1)).signum();
            let scale = curve[0].1[3].length() * size;
            least(&|d| gamma * omega(d).dot(d[3])) / scale
        }
        Criterion::Inflection => {
            // Definition 6.2, along seventeen mixtures.
            let along =
                |n: DVec3| -> Vec<f64> { curve.iter().map(|c| omega(&c.1).dot(n)).collect() };
            let [x, y] = normals.map(along);
            let ends = [x[0], -y[0], -x[last], y[last]];
            let margin = ends.into_iter().fold(f64::INFINITY, f64::min) / size;
            let once = (0..=16).all(|k| {
                let (sin, cos) = (f64::from(k) / 16.0 * std::f64::consts::FRAC_PI_2).sin_cos();
                let positive = |i: usize| x[i] * cos - y[i] * sin > 0.0;
                (0..last).filter(|&i| positive(i) != positive(i + 1)).count() == 1
            });
            let holds = once && ends[0] > 0.0 && ends[3] > 0.0;
            if holds { margin.abs() } else { -margin.abs() }
        }
        Criterion::Turning => {
            // Manni's (i.3) on this segment's side of both nodes, and the tangent beside the chord.
            let unit = |i: usize| {
                let sine = l(i - 1).normalize().cross(l(i).normalize());
                if sine.length() < 1e-9 { DVec3::ZERO } else { sine.normalize() }
            };
            let turns = |node: usize, d: &[DVec3; 4], chord_first: bool| {
                if unit(node) == DVec3::ZERO {
                    return 1.0;
                }
                let around = [node - 1, node, node + 1].map(|j| (unit(j), unit(node).dot(unit(j))));
                let asked = around.into_iter().filter(|(_, cosine)| cosine.abs() > 1e-9);
                let turned = asked.map(|(n, cosine)| omega(d).dot(n) * cosine.signum() / size);
                let before = l(node - 1).normalize().cross(d[1]).dot(unit(node)) / d[1].length();
                let after = d[1].cross(l(node).normalize()).dot(unit(node)) / d[1].length();
                let own = if chord_first { before } else { after };
                turned.fold(if corners { before.min(after) } else { own }, f64::min)
            };
            turns(m, &curve[0].1, false).min(turns(m + 1, &curve[last].1, true))
        }
        Criterion::Regular => least(&|d| d[1].length()) / (-least(&|d| -d[1].length())),
        Criterion::Coplanarity => {
            let [p, q] = normals;
            if p.dot(q) > 0.0 {
                parts((p + q).normalize(), 0.0, 1.0, &omega)
            } else {
                let flip = inflection_parameter(polygon, m);
                let axis = (p - q).normalize();
                parts(axis, 0.0, 0.5 * flip, &omega).min(parts(
                    axis,
                    0.5 * (1.0 + flip),
                    1.0,
                    &omega,
                ))
            }
        }
        Criterion::Collinearity => {
            let axis = l(m).normalize();
            let straight = |i: usize| l(i).normalize().cross(l(i + 1).normalize()).length() < 1e-9;
            let start = if straight(m - 1) { parts(axis, 0.0, 0.5, &|d| d[1]) } else { 1.0 };
            let end = if straight(m) { parts(axis, 0.5, 1.0, &|d| d[1]) } else { 1.0 };
            start.min(end)
        }
    }
}

/// Where to look: everywhere, and once more, closely, around a place.
fn parameters(around: Option<f64>) -> Vec<f64> {
    let all = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
    let near = around.into_iter().flat_map(|t| {
        (0..=SAMPLES).map(move |k| t + (2.0 * k as f64 / SAMPLES as f64 - 1.0) / SAMPLES as f64)
    });
    let mut t: Vec<f64> = all.chain(near).filter(|t| (0.0..=1.0).contains(t)).collect();
    if around.is_some() {
        t.sort_by(f64::total_cmp);
    }
    t
}

/// The curve of Bézier points, by de Casteljau, with derivatives by differences of the points.
fn samples(control: &[DVec3], around: Option<f64>) -> Samples {
    let difference = |p: &[DVec3]| -> Vec<DVec3> {
        let n = (p.len() - 1) as f64;
        p.windows(2).map(|w| (w[1] - w[0]) * n).collect()
    };
    let first = difference(control);
    let second = difference(&first);
    let third = difference(&second);
    let value = |p: &[DVec3], t: f64| {
        let mut p = p.to_vec();
        for n in (1..p.len()).rev() {
            for i in 0..n {
                p[i] = p[i] * (1.0 - t) + p[i + 1] * t;
            }
        }
        p[0]
    };
    let jet = |t: f64| (t, [control, &first, &second, &third].map(|p| value(p, t)));
    parameters(around).into_iter().map(jet).collect()
}

/// The same for cubics, faster.
fn cubic_samples([b0, b1, b2, b3]: [DVec3; 4], around: Option<f64>) -> Samples {
    let [c1, c2, c3] = [(b1 - b0) * 3.0, (b2 - b1 * 2.0 + b0) * 3.0, b3 - b2 * 3.0 + b1 * 3.0 - b0];
    let jet = |t: f64| {
        let derivatives = [
            b0 + (c1 + (c2 + c3 * t) * t) * t,
            c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t,
            c2 * 2.0 + c3 * (6.0 * t),
            c3 * 6.0,
        ];
        (t, derivatives)
    };
    parameters(around).into_iter().map(jet).collect()
}

#[derive(Default)]
struct Tally {
    holds: [AtomicUsize; Criterion::COUNT],
    fails: [AtomicUsize; Criterion::COUNT],
    closely: [AtomicUsize; Criterion::COUNT],
    exceptions: [AtomicUsize; Criterion::COUNT],
    undecided: AtomicUsize,
}

impl Tally {
    /// Compares a verdict with the samples. Where they differ the samples are looked at again, more
    /// closely, around the place that the record names (given a way to sample there); what differs
    /// still has to be within `band` of zero.
    fn compare(&self, record: Record, sampled: impl Fn(Option<f64>) -> f64, band: f64, name: &str) {
        let c = record.criterion as usize;
        assert_eq!(record.margin > 0.0, record.satisfied, "{name}: {record:?}");
        let mut margin = sampled(None);
        if record.satisfied != (margin > 0.0) {
            self.closely[c].fetch_add(1, Ordering::Relaxed);
            // Uniform parameters: the segment's own is what is left after its index.
            margin = sampled(Some(record.location - SEGMENT as f64));
        }
        let sampled = margin;
        if record.satisfied == (sampled > 0.0) {
            let column = if record.satisfied { &self.holds } else { &self.fails };
            column[c].fetch_add(1, Ordering::Relaxed);
        } else {
            self.exceptions[c].fetch_add(1, Ordering::Relaxed);
            assert!(sampled.abs() < band, "{name}: {record:?}, sampled {sampled:e}");
        }
    }

    fn print(&self, title: &str, least: usize) {
        println!("{title}: {} undecided", self.undecided.load(Ordering::Relaxed));
        for criterion in Criterion::ALL.into_iter().filter(|&c| c != Criterion::Regular) {
            let get = |column: &[AtomicUsize; Criterion::COUNT]| {
                column[criterion as usize].load(Ordering::Relaxed)
            };
            let counts = [&self.holds, &self.fails, &self.closely, &self.exceptions].map(get);
            let [holds, fails, closely, exceptions] = counts;
            println!(
                "{criterion:<17} holds {holds:>6}, fails {fails:>6}; seen only closely {closely}, \
                 exceptions {exceptions}"
            );
            assert!(holds > least && fails > least, "{criterion}: {counts:?}");
            assert!(exceptions * 1000 <= holds + fails, "{criterion}: {counts:?}");
        }
    }
}

use shapespline::criteria::Record;

#[test]
fn cubic_segments_agree_with_dense_sampling() {
    let tally = Tally::default();
    (0..100_000usize).into_par_iter().for_each(|k| {
        let (polygon, legs) = case(k, &mut Random::new(k as u64));
        let checker = Checker::new(&polygon, Criteria::ALL, Tolerances::default());
        let points = polygon.points();
        let (start, end) = (points[SEGMENT], points[SEGMENT + 1]);
        let control = [start, start + legs[0], end - legs[1], end];
        let curve = cubic_samples(control, None);
        let margin = |criterion, around: Option<f64>| match around {
            None => sampled(&polygon, &curve, criterion, false),
            Some(_) => sampled(&polygon, &cubic_samples(control, around), criterion, false),
        };
        for criterion in Criterion::ALL {
            let record = checker.record(SEGMENT, legs, criterion);
            if record.applicable {
                tally.compare(record, |t| margin(criterion, t), 1e-10, &format!("case {k}"));
            }
        }
    });
    tally.print("cubics", 500);
}

/// A quintic, or several pieces, near a cubic.
fn perturbed(control: [DVec3; 4], random: &mut Random) -> Vec<DVec3> {
    let mut p = control.to_vec();
    for _ in 0..2 {
        let n = p.len();
        let at = |i: usize| {
            let s = i as f64 / n as f64;
            let before = if i > 0 { p[i - 1] * s } else { DVec3::ZERO };
            let after = if i < n { p[i] * (1.0 - s) } else { DVec3::ZERO };
            before + after
        };
        p = (0..=n).map(at).collect();
    }
    let flat = p.iter().all(|x| x.z == p[0].z);
    let off = (p[5] - p[0]).length() * 10f64.powf(random.within(-3.0, -0.5));
    for x in &mut p[1..5] {
        let mut v = random.vector() * off;
        if flat {
            v.z = 0.0;
        }
        *x += v;
    }
    p
}

#[test]
fn quintics_agree_with_dense_sampling() {
    let tally = Tally::default();
    (0..3_000usize).into_par_iter().for_each(|k| {
        let mut random = Random::new(7_000_000 + k as u64);
        let (polygon, legs) = case(k, &mut random);
        let points = polygon.points();
        let (start, end) = (points[SEGMENT], points[SEGMENT + 1]);
        let control = perturbed([start, start + legs[0], end - legs[1], end], &mut random);
        // Straight quintics elsewhere: nothing is asked of them here.
        let mut all = Vec::new();
        for i in 0..polygon.segments() {
            let line = |j: i32| points[i].lerp(points[i + 1], f64::from(j) / 5.0);
            all.extend(if i == SEGMENT { control.clone() } else { (0..6).map(line).collect() });
        }
        let breaks = polygon.parameters().to_vec();
        let bezier = PiecewiseBezier::new(breaks, &all, 5, Dimension::Three).unwrap();
        let tolerances = Tolerances::default();
        let checker =
            CurveChecker::new(&polygon, &bezier, Criteria::ALL, tolerances, INTERPOLATION);
        let checker = checker.unwrap();
        let curve = samples(&control, None);
        let margin = |criterion, around: Option<f64>| match around {
            None => sampled(&polygon, &curve, criterion, true),
            Some(_) => sampled(&polygon, &samples(&control, around), criterion, true),
        };
        for criterion in Criterion::ALL {
            let record = checker.record(SEGMENT, criterion);
            if !record.applicable {
                continue;
            }
            if checker.undecided(SEGMENT, criterion).is_some() {
                tally.undecided.fetch_add(1, Ordering::Relaxed);
                let margin = margin(criterion, None);
                assert!(margin.abs() < 1e-4, "case {k} {criterion}: {margin}");
            } else {
                // Inflection has samples of mixtures only: a loop between two of them is not seen.
                let band = if criterion == Criterion::Inflection { 1.0 } else { 1e-10 };
                tally.compare(record, |t| margin(criterion, t), band, &format!("case {k}"));
            }
        }
    });
    tally.print("quintics", 25);
}
