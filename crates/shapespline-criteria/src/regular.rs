// SPDX-License-Identifier: MIT OR Apache-2.0

//! Whether a curve is regular: `γ' ≠ 0`.
//!
//! A curve that stops has no tangent there, no curvature and no frame, so no shape to keep. For a hodograph
//! `γ' = Σ B_k v_k` in Bernstein form the question is whether
//!
//! `ρ(t) = ‖Σ B_k(t) v_k‖ / Σ B_k(t) ‖v_k‖ ∈ [0, 1]`
//!
//! stays clear of zero. Rounding moves the numerator by a few units in the last place of the denominator: a
//! curve whose `ρ` falls below that stops as far as anyone can tell, and is not regular. The short legs of
//! high tension do no harm, for at an end `ρ` is one; but an end leg that is rounding beside its chord cannot
//! be told from none, and is lost where the curve is written as points.
//!
//! Legs that lie in an open half space cannot cancel: that proves most segments at once, and by subdivision
//! all the others, since on short intervals the legs of a hodograph that does not vanish are alike.

use glam::DVec3;
use shapespline_polynomial::{
    Polynomial,
    bernstein::{split, value},
};

use crate::{Requirements, margin::Margin, segment_geometry::SegmentGeometry};

/// Legs that cancel to this part of their sizes are zero to rounding. Arithmetic alone adds some 64 units in
/// the last place; the points bring those of their positions, often a thousand chords away from zero:
/// through points that double back on a line which no coordinate axis follows, `ρ` falls to some 1e−14.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// An end leg of this part of its chord is none: tangents that are to vanish by symmetry come out of the
/// solvers at some 1e−17 of the velocities.
const NO_LEG: f64 = 4.0 * f64::EPSILON;

/// Legs are in a half space if they lean to its side by at least this part of their sizes.
const CLEAR: f64 = 2.0 * ROUNDING;

/// Deepest subdivision: an interval of `2^{−52}` is one rounding of its ends.
const DEPTH: u32 = 52;

/// Whether all legs of a cubic clearly lead along its chord: the few operations that prove nearly every
/// segment regular.
#[inline]
pub(crate) fn leads_along([a, c]: [DVec3; 2], chord: DVec3) -> bool {
    let (first, last) = (a.dot(chord), c.dot(chord));
    let (a, chord, c) = (a.length_squared(), chord.length_squared(), c.length_squared());
    let clear =
        |along: f64, size: f64| (along > 0.0) & (along * along > CLEAR * CLEAR * size * chord);
    // (‖a‖ + ‖L‖ + ‖c‖)² ≤ 3 (‖a‖² + ‖L‖² + ‖c‖²).
    let least = 2.0 * NO_LEG * chord;
    (first.min(last) > least)
        & clear(first, a)
        & clear(last, c)
        & clear(chord - first - last, 3.0 * (a + chord + c))
}

/// Whether a cubic segment is regular.
pub(crate) fn is_regular(s: &SegmentGeometry, required: Requirements) -> bool {
    leads_along([s.a, s.c], s.chord) || Hodograph::cubic(s, required).stops_at().is_none()
}

/// The least `ρ` of a cubic segment; zero where the verdict is that it stops.
pub(crate) fn margin(s: &SegmentGeometry, required: Requirements) -> Margin {
    let hodograph = Hodograph::cubic(s, required);
    match hodograph.stops_at() {
        Some(at) => Margin { value: 0.0, at },
        None => hodograph.least(),
    }
}

/// The legs of a hodograph on an interval, and the sizes of what they are made of.
pub(crate) struct Hodograph {
    legs: Vec<DVec3>,
    sizes: Vec<f64>,
}

impl Hodograph {
    fn cubic(s: &SegmentGeometry, required: Requirements) -> Self {
        let (a, chord, c) = (s.a.length(), s.chord.length(), s.c.length());
        let [first, middle, last] = s.tangent_quadratic();
        let least =
            if required.intersects(Requirements::LEGS) { chord * (NO_LEG / ROUNDING) } else { 0.0 };
        let end = |leg: f64| leg.max(least);
        Self { legs: vec![first, middle, last], sizes: vec![end(a), a + chord + c, end(c)] }
    }

    /// From positive multiples of the tangent, with the bound on their error.
    pub(crate) fn of(tangent: &Polynomial<DVec3>) -> Self {
        let legs = tangent.coefficients().to_vec();
        let size = |leg: &DVec3| leg.length().max(tangent.error() / ROUNDING);
        Self { sizes: legs.iter().map(size).collect(), legs }
    }

    /// Where the curve stops, to rounding.
    pub(crate) fn stops_at(&self) -> Option<f64> {
        self.stop([0.0, 1.0], DEPTH)
    }

    fn stop(&self, [from, to]: [f64; 2], depth: u32) -> Option<f64> {
        let last = self.legs.len() - 1;
        for (k, at) in [(0, from), (last, to)] {
            // Written so that a NaN stops.
            if !(self.legs[k].length() > ROUNDING * self.sizes[k]) {
                return Some(at);
            }
        }
        let toward: DVec3 = self.legs.iter().map(|leg| leg.normalize_or_zero()).sum();
        let toward = toward.normalize_or_zero();
        let lean = |(leg, size): (&DVec3, &f64)| leg.dot(toward) > CLEAR * size;
        if self.legs.iter().zip(&self.sizes).all(lean) {
            return None;
        }
        let middle = 0.5 * (from + to);
        if depth == 0 {
            return Some(middle);
        }
        let [left, right] = self.halves();
        left.stop([from, middle], depth - 1).or_else(|| right.stop([middle, to], depth - 1))
    }

    fn halves(&self) -> [Self; 2] {
        let (legs, sizes) = (split(self.legs.clone(), 0.5), split(self.sizes.clone(), 0.5));
        [Self { legs: legs.0, sizes: sizes.0 }, Self { legs: legs.1, sizes: sizes.1 }]
    }

    /// The least `ρ`: by search in 64 parts, then around the least of them.
    fn least(&self) -> Margin {
        let at = |t: f64| {
            let (leg, size) = (value(&self.legs, t), value(&self.sizes, t));
            Margin { value: (leg.length() / size).min(1.0), at: t }
        };
        let around = |from: f64, to: f64| {
            let of = |k: i32| at(from + (to - from) * (f64::from(k) / 64.0));
            (0..=64).map(of).fold(at(from), Margin::least)
        };
        let (mut least, mut width) = (around(0.0, 1.0), 1.0);
        while width > 1e-9 {
            width /= 16.0;
            let near = around((least.at - width).max(0.0), (least.at + width).min(1.0));
            least = least.least(near);
        }
        least
    }
}
