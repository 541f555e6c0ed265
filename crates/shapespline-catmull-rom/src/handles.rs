//! Catmull–Rom curves as a family of the tension search: handles, and what shortens them.

use std::{convert::Infallible, ops::Range};

use shapespline_criteria::{Calls, Tolerances};
use shapespline_geometry::{DVec3, DataPolygon};
use shapespline_search::{TensionFamily, velocity_weight};

use crate::{
    Continuity,
    bounds::{bounded, bounds},
    tangents::tangent,
};

/// The legs of every segment. Closed forms have shortened them by `factors`; tension shortens them
/// further, to `1/(1 + tension)`.
#[derive(Debug)]
pub(crate) struct Handles<'a> {
    polygon: &'a DataPolygon,
    legs: Vec<[DVec3; 2]>,
    /// The smaller factor at each distinct node.
    factors: Vec<f64>,
    /// One a distinct node.
    tension: Vec<f64>,
}

impl<'a> Handles<'a> {
    /// Handles of given factors, one a distinct node.
    pub(crate) fn new(polygon: &'a DataPolygon, factors: Vec<f64>) -> Self {
        let tension = vec![0.0; factors.len()];
        let mut legs = Vec::with_capacity(polygon.segments());
        full_legs(polygon, |_, full| legs.push(full));
        for (i, [a, c]) in legs.iter_mut().enumerate() {
            *a *= factors[i];
            *c *= factors[(i + 1) % factors.len()];
        }
        let mut new = Self { polygon, legs, factors, tension };
        new.free_ends();
        new
    }

    /// The largest handles, up to the full ones, that stay below `safety` times the bounds which the
    /// calls of the polygon put on them.
    pub(crate) fn limited(
        polygon: &'a DataPolygon,
        calls: &[Calls],
        tolerances: &Tolerances,
        safety: f64,
        continuity: Continuity,
    ) -> Self {
        let sine = tolerances.collinearity;
        let cotangent = ((1.0 - sine) * (1.0 + sine)).sqrt() / sine;
        let (n, nodes) = (polygon.segments(), polygon.nodes());
        let mut legs: Vec<[DVec3; 2]> = Vec::with_capacity(n);
        let mut factors = vec![1.0; nodes];
        // Joins the factor `q` of the last leg before a node to the factor `p` of the leg after it.
        let join = |node: usize, q: f64, p: f64| {
            let before = if node == 0 { n - 1 } else { node - 1 };
            // In an inflecting coplanar segment the legs decide where it inflects: one factor a node.
            let split = || calls[before].and(calls[node]).any(Calls::SPLIT_COPLANARITY);
            let one = continuity == Continuity::C1 || split();
            if one { [q.min(p); 2] } else { [q, p] }
        };
        let (mut first, mut before) = (1.0, 1.0);
        full_legs(polygon, |i, [a, c]| {
            let (mut p, mut q) = (1.0f64, 1.0f64);
            if calls[i].any(bounded()) {
                let [on_p, on_q] = bounds(polygon, i, calls[i], [a, c], cotangent);
                (p, q) = (p.min(safety * on_p), q.min(safety * on_q));
            }
            if i == 0 {
                first = p;
                factors[0] = p;
                legs.push([a * p, c]);
            } else {
                let [left, right] = join(i, before, p);
                factors[i] = left.min(right);
                if let Some(last) = legs.last_mut() {
                    last[1] *= left;
                }
                legs.push([a * right, c]);
            }
            before = q;
        });
        let [left, right] = if polygon.is_closed() {
            join(0, before, first)
        } else {
            factors[n] = before;
            [before, first]
        };
        legs[n - 1][1] *= left;
        if polygon.is_closed() {
            legs[0][0] *= right / first;
            factors[0] = left.min(right);
        }
        let tension = vec![0.0; nodes];
        let mut new = Self { polygon, legs, factors, tension };
        new.free_ends();
        new
    }

    /// The legs, and what every distinct node's handles were shortened by, as a part of the full.
    pub(crate) fn finish(self) -> (Vec<[DVec3; 2]>, Vec<f64>) {
        let shortening =
            self.factors.iter().zip(&self.tension).map(|(f, t)| 1.0 - f / (1.0 + t)).collect();
        let legs = if self.tension.iter().any(|&t| t > 0.0) {
            (0..self.legs.len()).map(|i| self.end_legs(i)).collect()
        } else {
            self.legs
        };
        (legs, shortening)
    }

    /// Legs at ends of zero curvature: with `a = (L − c)/2`, or any part of it, `a × b` vanishes.
    fn free_ends(&mut self) {
        let last = self.legs.len() - 1;
        for i in [0, last] {
            self.legs[i] = self.freed(i, self.legs[i]);
        }
    }

    #[inline]
    fn freed(&self, segment: usize, [a, c]: [DVec3; 2]) -> [DVec3; 2] {
        let last = self.legs.len() - 1;
        if self.polygon.is_closed()
            || self.polygon.tangents().is_some()
            || !(segment == 0 || segment == last)
        {
            return [a, c];
        }
        let chord = self.polygon.chord(segment);
        let scale = |node: usize| self.factors[node] / (1.0 + self.tension[node]);
        match (segment == 0, segment == last) {
            (true, true) => [chord * (scale(0) / 3.0), chord * (scale(last + 1) / 3.0)],
            (true, false) => [(chord - c) * (0.5 * scale(0)), c],
            _ => [a, (chord - a) * (0.5 * scale(last + 1))],
        }
    }
}

/// Calls `take` with the full legs of every segment in order, each tangent made once. A leg at an end
/// of zero curvature is zero here.
#[inline]
fn full_legs(polygon: &DataPolygon, mut take: impl FnMut(usize, [DVec3; 2])) {
    let mut start = tangent(polygon, 0).unwrap_or_default();
    for i in 0..polygon.segments() {
        let end = tangent(polygon, i + 1).unwrap_or_default();
        let third = polygon.spacing(i) / 3.0;
        take(i, [start * third, end * third]);
        start = end;
    }
}

impl TensionFamily for Handles<'_> {
    type Error = Infallible;

    fn tension(&self) -> &[f64] {
        &self.tension
    }

    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), Infallible> {
        let n = self.legs.len();
        for &(node, tension) in changes {
            self.tension[node] = tension;
            if node == 0 && self.polygon.is_closed() {
                touched.push(n - 1..n);
            }
            touched.push(node.saturating_sub(1)..(node + 1).min(n));
        }
        Ok(())
    }

    fn solve_again(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        let [a, c] = self.legs[segment];
        let scale = |node: usize| 1.0 / (1.0 + self.tension[node % self.tension.len()]);
        self.freed(segment, [a * scale(segment), c * scale(segment + 1)])
    }

    /// What the closed forms took away counts as tension.
    fn weight(&self, node: usize) -> f64 {
        self.factors[node] * velocity_weight(self.polygon, node)
    }
}
