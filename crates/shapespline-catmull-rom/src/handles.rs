//! Catmull–Rom curves as a family of the tension search: handles, and what shortens them.

use std::{convert::Infallible, ops::Range};

use rayon::prelude::*;
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

/// From this number of nodes on they are worked on by all threads, in blocks of this many.
const BLOCK: usize = 4096;

/// `make(0), …, make(count − 1)`.
fn each<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    if count < 2 * BLOCK {
        (0..count).map(make).collect()
    } else {
        (0..count).into_par_iter().with_min_len(BLOCK).map(make).collect()
    }
}

/// The same of pairs, as two.
fn each_pair<S: Send, T: Send>(
    count: usize,
    make: impl Fn(usize) -> (S, T) + Sync + Send,
) -> (Vec<S>, Vec<T>) {
    if count < 2 * BLOCK {
        return (0..count).map(make).unzip();
    }
    let mut pair = (Vec::new(), Vec::new());
    let all = (0..count).into_par_iter().with_min_len(BLOCK).map(make);
    all.unzip_into_vecs(&mut pair.0, &mut pair.1);
    pair
}

impl<'a> Handles<'a> {
    /// Handles of given factors, one a distinct node.
    pub(crate) fn new(polygon: &'a DataPolygon, factors: Vec<f64>) -> Self {
        let full = FullLegs::new(polygon);
        let legs = each(polygon.segments(), |i| {
            let [a, c] = full.of(i);
            [a * factors[i], c * factors[(i + 1) % factors.len()]]
        });
        Self { polygon, legs, factors, tension: Vec::new() }.with_free_ends()
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
        let n = polygon.segments();
        let full = FullLegs::new(polygon);
        // Factors that each segment allows at its two ends.
        let limits = each(n, |i| {
            if !calls[i].any(bounded()) {
                return [1.0; 2];
            }
            let on = bounds(polygon, i, calls[i], full.of(i), cotangent);
            on.map(|bound| f64::min(1.0, safety * bound))
        });
        // Factors of the legs before and after a node.
        let joined = |node: usize| {
            let (before, after) = match node {
                0 if polygon.is_closed() => (n - 1, 0),
                0 => return [limits[0][0]; 2],
                _ if node < n => (node - 1, node),
                _ if polygon.is_closed() => (n - 1, 0),
                _ => return [limits[n - 1][1]; 2],
            };
            let (q, p) = (limits[before][1], limits[after][0]);
            // In an inflecting coplanar segment the legs decide where it inflects: one factor a node.
            let split = || calls[before].and(calls[after]).any(Calls::SPLIT_COPLANARITY);
            let one = continuity == Continuity::C1 || split();
            if one { [q.min(p); 2] } else { [q, p] }
        };
        let (legs, mut factors) = each_pair(n, |i| {
            let ([a, c], [before, after]) = (full.of(i), joined(i));
            ([a * after, c * joined(i + 1)[0]], before.min(after))
        });
        if !polygon.is_closed() {
            factors.push(limits[n - 1][1]);
        }
        Self { polygon, legs, factors, tension: Vec::new() }.with_free_ends()
    }

    /// The same, ready for the search.
    pub(crate) fn under_tension(mut self) -> Self {
        self.tension = vec![0.0; self.factors.len()];
        self
    }

    /// First and last leg of each segment, before any tension.
    pub(crate) fn legs(&self) -> &[[DVec3; 2]] {
        &self.legs
    }

    /// The legs, and what every distinct node's handles were shortened by, as a part of the full.
    pub(crate) fn finish(mut self) -> (Vec<[DVec3; 2]>, Vec<f64>) {
        if !self.tension.is_empty() {
            self.legs = (0..self.legs.len()).map(|i| self.end_legs(i)).collect();
        }
        for i in 0..self.factors.len() {
            self.factors[i] = 1.0 - self.scale(i);
        }
        (self.legs, self.factors)
    }

    /// What the handles at a node are of the full ones.
    fn scale(&self, node: usize) -> f64 {
        self.factors[node] / (1.0 + self.tension.get(node).unwrap_or(&0.0))
    }

    /// With the legs at ends of zero curvature: for `a = (L − c)/2`, or any part of it, `a × b`
    /// vanishes.
    fn with_free_ends(mut self) -> Self {
        let last = self.legs.len() - 1;
        for i in [0, last] {
            self.legs[i] = self.freed(i, self.legs[i]);
        }
        self
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
        match (segment == 0, segment == last) {
            (true, true) => [chord * (self.scale(0) / 3.0), chord * (self.scale(last + 1) / 3.0)],
            (true, false) => [(chord - c) * (0.5 * self.scale(0)), c],
            _ => [a, (chord - a) * (0.5 * self.scale(last + 1))],
        }
    }
}

/// The full legs of every segment: a third of the spacing along the tangents at its nodes.
struct FullLegs<'a> {
    polygon: &'a DataPolygon,
    tangents: Vec<DVec3>,
}

impl<'a> FullLegs<'a> {
    fn new(polygon: &'a DataPolygon) -> Self {
        let at = |node| tangent(polygon, node).unwrap_or_default();
        Self { polygon, tangents: each(polygon.points().len(), at) }
    }

    /// First and last leg. A leg at an end of zero curvature is zero here.
    #[inline]
    fn of(&self, segment: usize) -> [DVec3; 2] {
        let third = self.polygon.spacing(segment) / 3.0;
        [segment, segment + 1].map(|node| self.tangents[node] * third)
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
