// SPDX-License-Identifier: MIT OR Apache-2.0

//! How fair a curve is beside the C² cubic spline: what a printed report says of it.

use std::borrow::Cow;

use shapespline::{
    criteria::{Checker, Criterion},
    geometry::{DataPolygon, Fairness, InputMap, PiecewiseBezier, Place, fairness_with, length},
    nu::NuSpline,
    search::{Interpolant, Tension},
};

use super::subject::Subject;
use crate::{asked::Asked, work::GoOn};

/// Curvature times chord from which on a bend is practically a corner: it turns within a hundredth of the
/// chord.
const SHARP: f64 = 100.0;

/// Share of the plain cubic's energy below which no criterion is said to cost any.
const CHEAP: f64 = 0.01;

/// A curve beside the C² cubic spline with the same points, parameters and ends.
pub(crate) struct Comparison<'a> {
    polygon: &'a DataPolygon,
    /// The breaks of the curve, as parameters of the polygon.
    breaks: Vec<f64>,
    map: &'a InputMap,
    cubic: NuSpline,
    pub(crate) own_fairness: Fairness,
    pub(crate) cubic_fairness: Fairness,
}

/// What a criterion costs: `∫κ²ds` on the segments where the C² cubic violates it and on those beside them.
pub(crate) struct Cost {
    pub(crate) criterion: Criterion,
    /// How many segments the C² cubic violates it on.
    pub(crate) segments: usize,
    pub(crate) own: f64,
    pub(crate) cubic: f64,
}

impl<'a> Comparison<'a> {
    /// Measures both; none where f64 cannot hold the cubic, and after Ctrl-C.
    pub(crate) fn of(subject: &'a Subject, go_on: GoOn<'_>) -> Option<Self> {
        let (polygon, map, curve) = match subject {
            Subject::Own(curve) => {
                let pieces = PiecewiseBezier::from(curve.cubic());
                (curve.polygon(), &curve.map, Cow::Owned(pieces))
            }
            Subject::Other { polygon, curve, map, .. } => {
                (&**polygon, &**map, Cow::Borrowed(&**curve))
            }
        };
        let breaks = match subject {
            Subject::Own(own) => {
                let start = |piece| own.path().parameter(piece, 0.0);
                let last = own.path().parameter(curve.pieces() - 1, 1.0);
                (0..curve.pieces()).map(start).chain([last]).collect()
            }
            Subject::Other { .. } => curve.breaks().to_vec(),
        };
        let cubic = NuSpline::new(polygon.clone(), Tension::Uniform(0.0)).ok()?;
        let cubic_fairness = fairness_with(&PiecewiseBezier::from(cubic.curve()), go_on)?;
        let own_fairness = fairness_with(&curve, go_on)?;
        Some(Self { polygon, breaks, map, cubic, own_fairness, cubic_fairness })
    }

    /// The segment at a parameter.
    fn segment(&self, at: f64) -> usize {
        let u = self.polygon.parameters();
        u.partition_point(|&u| u <= at).clamp(1, u.len() - 1) - 1
    }

    /// The points, as indices of the input, next to which the curve turns in a small part of a chord:
    /// practically corners.
    pub(crate) fn sharp_points(&self) -> Vec<usize> {
        let (found, u) = (&self.own_fairness, self.polygon.parameters());
        let near = |Place { piece, t }: Place| {
            let at = self.breaks[piece] + t * (self.breaks[piece + 1] - self.breaks[piece]);
            let segment = self.segment(at);
            let node = segment + usize::from(at - u[segment] > u[segment + 1] - at);
            (node, length(self.polygon.chord(segment)))
        };
        let peaks = found.extrema.iter().map(|peak| (peak.place, peak.curvature.abs()));
        let peaks = peaks.chain([(found.max_curvature_at, found.max_curvature)]);
        let sharp = peaks.filter_map(|(place, curvature)| {
            let (node, chord) = near(place);
            (curvature * chord > SHARP).then(|| self.map.node(node))
        });
        let mut points: Vec<usize> = sharp.collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// The criterion for which the curve bends most beyond what the C² cubic does; none where none costs
    /// anything.
    pub(crate) fn costliest(&self, asked: Asked) -> Option<Cost> {
        let checker = Checker::new(self.polygon, asked.to_check(), asked.tolerances);
        let legs = self.cubic.curve().legs();
        let violations = checker.report(|i| legs[i]).violations;
        let n = self.polygon.segments();
        let mut own = vec![0.0; n];
        for (ends, bending) in self.breaks.windows(2).zip(&self.own_fairness.bending_of_pieces) {
            own[self.segment(0.5 * (ends[0] + ends[1]))] += bending / self.own_fairness.length;
        }
        let cubic: Vec<f64> = self
            .cubic_fairness
            .bending_of_pieces
            .iter()
            .map(|bending| bending / self.cubic_fairness.length)
            .collect();
        let cost = |criterion: Criterion| {
            let mut beside = vec![false; n];
            let violated = violations.iter().filter(|v| v.criterion == criterion);
            let segments =
                violated.map(|v| self.around(v.segment).for_each(|i| beside[i] = true)).count();
            let sum = |of: &[f64]| (0..n).filter(|&i| beside[i]).map(|i| of[i]).sum();
            Cost { criterion, segments, own: sum(&own), cubic: sum(&cubic) }
        };
        let least = CHEAP * cubic.iter().sum::<f64>();
        let costs = asked.criteria.iter().map(cost).filter(|cost| cost.own - cost.cubic > least);
        costs.max_by(|a, b| (a.own - a.cubic).total_cmp(&(b.own - b.cubic)))
    }

    /// A segment and its neighbours.
    fn around(&self, i: usize) -> impl Iterator<Item = usize> {
        let n = self.polygon.segments();
        let closed = self.polygon.is_closed();
        let before = if closed { (i + n - 1) % n } else { i.saturating_sub(1) };
        let after = if closed { (i + 1) % n } else { (i + 1).min(n - 1) };
        [before, i, after].into_iter()
    }
}
