// SPDX-License-Identifier: MIT OR Apache-2.0

//! The interpolant that all schemes make: data, slopes, and one evaluation polynomial per piece.

use crate::cubic::Pieces;
use crate::data::{LONG, Units, first};
use crate::extrapolation::Extrapolation;
use crate::integrals::Lazy;
use crate::inverse::Inverse;
use crate::piecewise::PiecewisePolynomial;
use crate::segment_polynomial::{self, SegmentPolynomial, TILE};
use once_cell::race::OnceBox;
use shapespline_polynomial::knots::Locator;
use shapespline_polynomial::parallel::both;

/// What the pieces are beyond their end values and slopes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum MonotoneKind {
    /// `e = ⅔(αm₀ − βm₁)` of every segment, in units of y.
    Quartic { e: Vec<f64> },
    /// Second derivatives at the knots, scaled.
    Quintic { s: Vec<f64> },
    /// Second derivatives at both ends of every piece, scaled.
    Cubic { z: Vec<[f64; 2]> },
}

/// The data of an interpolant that has knots between them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Points {
    x: Vec<f64>,
    y: Vec<f64>,
    /// The knot of every point.
    nodes: Vec<usize>,
}

/// A piecewise cubic (C²), quartic (C¹) or quintic (C²) through data, monotone on every segment.
///
/// Values at the points are the data to the last bit, values between them stay between the two data values. Immutable,
/// `Send + Sync`, serialisable with the feature `serde`. [`crate::MonotoneCubic`], [`crate::MonotoneQuartic`] and
/// [`crate::MonotoneQuintic`] dereference to it.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct MonotoneSpline {
    /// The knots and the values there.
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// The data, unless they are at the knots.
    pub(crate) points: Option<Box<Points>>,
    /// Slopes at the knots. These and second derivatives are kept in scaled units: in those of the data they may leave
    /// the range of double precision where values and integrals do not.
    pub(crate) d: Vec<f64>,
    pub(crate) units: Units,
    pub(crate) kind: MonotoneKind,
    pub(crate) polynomials: Vec<SegmentPolynomial>,
    pub(crate) extrapolate: Extrapolation,
    pub(crate) cached: Cached,
}

/// What is made at the first request for it. A clone starts without.
#[derive(Debug, Default)]
pub(crate) struct Cached {
    pub(crate) locator: Locator,
    pub(crate) inverse: OnceBox<Inverse>,
    pub(crate) integrals: Lazy,
}

impl Clone for Cached {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// The stored form.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
struct Stored {
    x: Vec<f64>,
    y: Vec<f64>,
    points: Option<Box<Points>>,
    d: Vec<f64>,
    kind: MonotoneKind,
    polynomials: Vec<SegmentPolynomial>,
    extrapolate: Extrapolation,
}

#[cfg(feature = "serde")]
impl From<MonotoneSpline> for Stored {
    fn from(s: MonotoneSpline) -> Self {
        let MonotoneSpline { x, y, points, d, kind, polynomials, extrapolate, .. } = s;
        Self { x, y, points, d, kind, polynomials, extrapolate }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for MonotoneSpline {
    type Error = String;
    fn try_from(s: Stored) -> Result<Self, String> {
        let n = s.x.len();
        let extra = match &s.kind {
            MonotoneKind::Quartic { e } => e.len() + 1,
            MonotoneKind::Quintic { s } => s.len(),
            MonotoneKind::Cubic { z } => z.len() + 1,
        };
        if !s.points.as_ref().is_none_or(|points| points.are_sound(n)) {
            return Err("stored data are inconsistent".to_owned());
        }
        if n < 2 || s.y.len() != n || s.d.len() != n || extra != n || s.polynomials.len() + 1 != n {
            return Err("stored interpolant is inconsistent".to_owned());
        }
        // Those of the data: knots between them would change the mean spacing.
        let (x, y) = s.points.as_ref().map_or((&s.x, &s.y), |points| (&points.x, &points.y));
        let units = Units::of(x, y).map_err(|error| format!("stored interpolant: {error}"))?;
        if x.len() < s.x.len() {
            crate::data::check(&s.x, &s.y).map_err(|error| format!("stored knots: {error}"))?;
        }
        let Stored { x, y, points, d, kind, polynomials, extrapolate } = s;
        Ok(Self {
            x,
            y,
            points,
            d,
            units,
            kind,
            polynomials,
            extrapolate,
            cached: Cached::default(),
        })
    }
}

impl MonotoneSpline {
    /// Of slopes and second derivatives in scaled units.
    pub(crate) fn quintic(
        units: Units,
        x: Vec<f64>,
        y: Vec<f64>,
        d: Vec<f64>,
        s: Vec<f64>,
        extrapolate: Extrapolation,
    ) -> Self {
        let tile = |start: usize, count: usize| {
            // A length that is known beforehand: nearly all tiles are full.
            if count == TILE {
                quintic_records(units, &x[start..], &y[start..], &d[start..], &s[start..], TILE)
            } else {
                quintic_records(units, &x[start..], &y[start..], &d[start..], &s[start..], count)
            }
        };
        let polynomials = segment_polynomial::segment_polynomials(x.len() - 1, tile);
        let kind = MonotoneKind::Quintic { s };
        let (points, cached) = (None, Cached::default());
        Self { x, y, points, d, units, kind, polynomials, extrapolate, cached }
    }

    /// Of cubic pieces with knots between the data.
    pub(crate) fn cubic(
        units: Units,
        data: [&[f64]; 2],
        pieces: Pieces,
        extrapolate: Extrapolation,
    ) -> Self {
        let Pieces { x, y, slope: d, second: z, nodes, .. } = pieces;
        let tile = |start: usize, count: usize| {
            cubic_polynomials(units, &x[start..], &y[start..], &z[start..], count)
        };
        let polynomials = segment_polynomial::segment_polynomials(x.len() - 1, tile);
        let own = nodes.len() < x.len();
        let points = own.then(|| {
            let (x, y) = both(nodes.len() >= LONG, || data[0].to_vec(), || data[1].to_vec());
            Box::new(Points { x, y, nodes })
        });
        let (kind, cached) = (MonotoneKind::Cubic { z }, Cached::default());
        Self { x, y, points, d, units, kind, polynomials, extrapolate, cached }
    }

    /// The segment of the data in which a knot lies.
    pub(crate) fn segment_of_knot(&self, knot: usize) -> usize {
        let Some(points) = &self.points else { return knot };
        points.nodes.partition_point(|node| *node <= knot).saturating_sub(1)
    }

    /// The first knot whose slope or second derivative is beyond double precision in the data's units.
    pub(crate) fn overflow(&self) -> Option<usize> {
        let beyond =
            |nu: usize| move |_: usize, v: f64| !self.units.derivative_out(v, nu).is_finite();
        let seconds = match &self.kind {
            MonotoneKind::Quintic { s } => first(s, beyond(2)),
            MonotoneKind::Cubic { z } => first(z.as_flattened(), beyond(2)).map(|i| i / 2),
            MonotoneKind::Quartic { .. } => None,
        };
        seconds.or_else(|| first(&self.d, beyond(1)))
    }

    /// The abscissae of the data.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        self.points.as_ref().map_or(&self.x, |points| &points.x)
    }

    /// The ordinates of the data.
    #[must_use]
    pub fn y(&self) -> &[f64] {
        self.points.as_ref().map_or(&self.y, |points| &points.y)
    }

    /// The knots: the abscissae of the data, and of cubics those between them.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.x
    }

    /// The knot of every point, if not all knots are points.
    fn nodes(&self) -> Option<&[usize]> {
        self.points.as_ref().map(|points| &points.nodes[..])
    }

    /// Slopes at the points. O(N).
    #[must_use]
    pub fn slopes(&self) -> Vec<f64> {
        match self.nodes() {
            None => self.units.derivatives_out(&self.d, 1),
            Some(nodes) => nodes.iter().map(|k| self.units.derivative_out(self.d[*k], 1)).collect(),
        }
    }

    /// Second derivatives at the points: where they jump (the quartic, which is only C¹; the cubic without layers, at
    /// turns and flats) from the right, at the last point from the left. O(N).
    #[must_use]
    pub fn second_derivatives(&self) -> Vec<f64> {
        match &self.kind {
            MonotoneKind::Quintic { s } => self.units.derivatives_out(s, 2),
            MonotoneKind::Cubic { z } => {
                let at = |k: usize| match z.get(k) {
                    Some([after, _]) => *after,
                    None => z[k - 1][1],
                };
                let seconds: Vec<f64> = match self.nodes() {
                    None => (0..=z.len()).map(at).collect(),
                    Some(nodes) => nodes.iter().map(|k| at(*k)).collect(),
                };
                self.units.derivatives_out(&seconds, 2)
            }
            MonotoneKind::Quartic { .. } => {
                let n = self.polynomials.len();
                (0..=n).map(|i| self.derivative_at(i.min(n - 1), self.x[i], 2)).collect()
            }
        }
    }

    /// The degree of the pieces: 3, 4 or 5.
    #[must_use]
    pub fn degree(&self) -> usize {
        match self.kind {
            MonotoneKind::Quartic { .. } => 4,
            MonotoneKind::Quintic { .. } => 5,
            MonotoneKind::Cubic { .. } => 3,
        }
    }

    /// What it is outside the data.
    #[must_use]
    pub fn extrapolation(&self) -> Extrapolation {
        self.extrapolate
    }

    /// Bernstein coefficients of the pieces, `degree + 1` per piece (equations (15) and (16)), for `BPoly`.
    #[must_use]
    pub fn bernstein_coefficients(&self) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.polynomials.len() * (self.degree() + 1));
        for i in 0..self.polynomials.len() {
            out.extend_from_slice(&self.piece(i)[..=self.degree()]);
        }
        out
    }

    /// The length of segment i, scaled.
    pub(crate) fn scaled_length(&self, i: usize) -> f64 {
        self.units.spacing().scale(self.x[i + 1] - self.x[i])
    }

    /// The slopes at the ends of segment i times its length: rises of the end tangents, in units of y.
    pub(crate) fn tangent_rises(&self, i: usize) -> [f64; 2] {
        let (h, unit) = (self.scaled_length(i), self.units.y());
        [unit.scale(h * self.d[i]), unit.scale(h * self.d[i + 1])]
    }

    /// Bernstein coefficients of one piece, `degree + 1` of them.
    pub(crate) fn piece(&self, i: usize) -> [f64; 6] {
        self.piece_between(i, self.y[i], self.y[i + 1])
    }

    /// The same with other values at the ends, whose difference is that of the data.
    pub(crate) fn piece_between(&self, i: usize, y0: f64, y1: f64) -> [f64; 6] {
        let [m0, m1] = self.tangent_rises(i);
        match &self.kind {
            MonotoneKind::Quartic { e } => {
                let middle = 0.5 * y0 + 0.5 * y1 + 0.25 * e[i];
                [y0, y0 + 0.25 * m0, middle, y1 - 0.25 * m1, y1, 0.0]
            }
            MonotoneKind::Cubic { .. } => [y0, y0 + m0 / 3.0, y1 - m1 / 3.0, y1, 0.0, 0.0],
            MonotoneKind::Quintic { s } => {
                let (h, unit) = (self.scaled_length(i), self.units.y());
                let (k0, k1) = (unit.scale(h * (h * s[i])), unit.scale(h * (h * s[i + 1])));
                let (b, c) = (y0 + (0.4 * m0 + 0.05 * k0), y1 - (0.4 * m1 - 0.05 * k1));
                [y0, y0 + 0.2 * m0, b, c, y1 - 0.2 * m1, y1]
            }
        }
    }

    /// The same function as a general piecewise polynomial. O(N).
    #[must_use]
    pub fn to_piecewise(&self) -> PiecewisePolynomial {
        let c = self.bernstein_coefficients();
        PiecewisePolynomial::new(self.x.clone(), self.degree(), c, self.extrapolate)
    }

    pub(crate) fn polynomial(&self, i: usize) -> &SegmentPolynomial {
        &self.polynomials[i]
    }
}

/// The polynomials of the first `n` segments, those of a tile; several are made at once.
#[inline(always)]
fn quintic_records(
    units: Units,
    x: &[f64],
    y: &[f64],
    d: &[f64],
    s: &[f64],
    n: usize,
) -> [SegmentPolynomial; TILE] {
    let (x, y, d, s) = (&x[..=n], &y[..=n], &d[..=n], &s[..=n]);
    let (unit, to_x) = (units.y(), units.spacing());
    let mut q = [[0.0; TILE]; 4];
    for j in 0..n {
        let h = to_x.scale(x[j + 1] - x[j]);
        let m = [unit.scale(h * d[j]), unit.scale(h * d[j + 1])];
        let k = [unit.scale(h * (h * s[j])), unit.scale(h * (h * s[j + 1]))];
        [q[0][j], q[1][j], q[2][j], q[3][j]] =
            SegmentPolynomial::hermite_form(y[j + 1] - y[j], m, k);
    }
    SegmentPolynomial::assembled(x, y, &q)
}

/// The polynomials of the first `n` cubic pieces, those of a tile.
fn cubic_polynomials(
    units: Units,
    x: &[f64],
    y: &[f64],
    z: &[[f64; 2]],
    n: usize,
) -> [SegmentPolynomial; TILE] {
    let (unit, to_x) = (units.y(), units.spacing());
    let mut q = [[0.0; TILE]; 4];
    for j in 0..n {
        let h = to_x.scale(x[j + 1] - x[j]);
        let k = z[j].map(|z| unit.scale(h * (h * z)));
        [q[0][j], q[1][j]] = SegmentPolynomial::cubic_form(k);
    }
    SegmentPolynomial::assembled(&x[..=n], &y[..=n], &q)
}

#[cfg(feature = "serde")]
impl Points {
    /// Whether data that were read are points among `knots` knots.
    fn are_sound(&self, knots: usize) -> bool {
        let n = self.nodes.len();
        let ends = n >= 2 && self.nodes[0] == 0 && self.nodes[n - 1] + 1 == knots;
        let increase = self.nodes.windows(2).all(|w| w[0] < w[1]);
        ends && increase && self.x.len() == n && self.y.len() == n
    }
}
