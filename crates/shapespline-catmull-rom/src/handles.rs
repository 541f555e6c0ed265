// SPDX-License-Identifier: MIT OR Apache-2.0

//! Catmull–Rom curves as a family of the tension search: handles, and what shortens them.

use std::{convert::Infallible, ops::Range};

use shapespline_geometry::{DVec3, DataPolygon};
use shapespline_polynomial::parallel;
use shapespline_search::family::{TensionFamily, tension_unit};

use crate::tangents::tangent;

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

/// From this number of nodes on they are worked on by all threads.
const MANY: usize = 8192;

/// The full legs of every segment: a third of the spacing along the tangents at its nodes. A leg at an
/// end of zero curvature is zero here.
fn full_legs(polygon: &DataPolygon) -> Vec<[DVec3; 2]> {
    let of = |node: usize| tangent(polygon, node).unwrap_or_default();
    let tangents: Vec<DVec3> = parallel::map(polygon.points().len(), MANY, of);
    parallel::map(polygon.segments(), MANY, |i| {
        let third = polygon.spacing(i) / 3.0;
        [tangents[i] * third, tangents[i + 1] * third]
    })
}

/// Legs times the two factors of their segment.
fn scaled(
    mut legs: Vec<[DVec3; 2]>,
    factors: impl Fn(usize) -> [f64; 2] + Sync + Send,
) -> Vec<[DVec3; 2]> {
    parallel::fill(&mut legs, MANY, |i, [a, c]| {
        let [p, q] = factors(i);
        (*a, *c) = (*a * p, *c * q);
    });
    legs
}

impl<'a> Handles<'a> {
    /// Handles of given factors, one a distinct node.
    pub(crate) fn new(polygon: &'a DataPolygon, factors: Vec<f64>) -> Self {
        let at = |node: usize| factors[if node < factors.len() { node } else { 0 }];
        let legs = scaled(full_legs(polygon), |i| [at(i), at(i + 1)]);
        Self { polygon, legs, factors, tension: Vec::new() }.with_free_ends()
    }

    /// Handles that are known, ready for the search.
    pub(crate) fn under_tension(
        polygon: &'a DataPolygon,
        legs: Vec<[DVec3; 2]>,
        factors: Vec<f64>,
    ) -> Self {
        let tension = vec![0.0; factors.len()];
        Self { polygon, legs, factors, tension }
    }

    /// The legs, before any tension.
    pub(crate) fn into_legs(self) -> Vec<[DVec3; 2]> {
        self.legs
    }

    /// The factors, with the tension in them.
    pub(crate) fn into_factors(self) -> Vec<f64> {
        (0..self.factors.len()).map(|node| self.scale(node)).collect()
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
        if self.polygon.is_closed() || !(segment == 0 || segment == last) {
            return [a, c];
        }
        let natural = self.polygon.tangents().map(|tangent| tangent.is_none());
        let scale = |is_end: bool, node: usize| is_end.then(|| self.scale(node));
        let free =
            [scale(segment == 0 && natural[0], 0), scale(segment == last && natural[1], last + 1)];
        freed(self.polygon.chord(segment), [a, c], free)
    }
}

/// Legs of a segment, of which those at an end of zero curvature, of these scales, follow the other one.
#[inline]
pub(crate) fn freed(chord: DVec3, [a, c]: [DVec3; 2], free: [Option<f64>; 2]) -> [DVec3; 2] {
    match free {
        [Some(p), Some(q)] => [chord * (p / 3.0), chord * (q / 3.0)],
        [Some(p), None] => [(chord - c) * (0.5 * p), c],
        [None, Some(q)] => [a, (chord - a) * (0.5 * q)],
        [None, None] => [a, c],
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

    fn solve(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    #[inline]
    fn end_legs(&self, segment: usize) -> [DVec3; 2] {
        let [a, c] = self.legs[segment];
        let scale = |node: usize| 1.0 / (1.0 + self.tension[node % self.tension.len()]);
        self.freed(segment, [a * scale(segment), c * scale(segment + 1)])
    }

    /// What the closed forms took away counts as tension.
    fn tension_unit(&self, node: usize) -> f64 {
        self.factors[node] * tension_unit(self.polygon, node)
    }
}
