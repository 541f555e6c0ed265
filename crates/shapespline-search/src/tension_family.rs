// SPDX-License-Identifier: MIT OR Apache-2.0

//! What a family of splines has to say to be searched.

use std::ops::Range;

use shapespline_geometry::{DVec3, DataPolygon};

/// A family of cubic interpolants of one data polygon with a tension `≥ 0` at each node, or on each side
/// of it.
///
/// The search needs of it that growing tension draws the curve to the polygon in such a way that the
/// shape criteria hold in the limit, and that tension at a node acts locally.
///
/// # A family in a day
///
/// 1. **Say what tension is**: a number a node, 0 for none, growing without bound, under which the
///    curve goes to the polygon *and its tangents tend to directions strictly between the chords*.
///    The criteria then hold in the limit (paper 001, Theorems 4.7–4.13; paper 000, Lemmas 4.1–4.3).
/// 2. **Say how tension makes tangents.** If the tangents solve a tridiagonal system, write its row
///    `i`, divided so that it has no unit and is strictly diagonally dominant, as
///    [`shapespline_banded::Rows`], and implement [`TensionSystem`](crate::family::TensionSystem) (`NuSystem` and `ManniSystem` are
///    some 100 lines each). If a tangent depends on its neighbours only, implement this trait itself
///    (`Handles` of Catmull–Rom).
/// 3. **Say where pulls are equal** ([`TensionFamily::tension_unit`]) if equal tension does not already
///    make the legs of neighbouring nodes alike.
/// 4. **The curve** of a family with a system: implement [`SplineFamily`](crate::family::SplineFamily), and [`crate::Spline`] is it, with
///    `shape_preserving`, report and serialisation. Else: a struct with a [`shapespline_geometry::Curve`], the
///    tension and the polygon that implements [`crate::Interpolant`], whose `shape_preserving` is
///    [`search_and_report`](crate::family::search_and_report) and the assembly. `fit_many`, evaluation and arc length follow.
/// 5. **Tests**: add the family to `tests/rust/src/families.rs`. Every property there — no violation
///    on thousands of polygons, invariance, limits, bad input — then runs for it too. Plant
///    an answer of your own besides: a curve the family reproduces.
///
/// The [first page of the crate](crate) has a family that runs.
pub trait TensionFamily: Sync {
    /// Why a system could not be solved.
    type Error;

    /// Tensions per node: one, or two where those before and after a node are independent. Raising
    /// takes the two together, lowering each by itself.
    const SIDES: usize = 1;

    /// The tensions, [`Self::SIDES`] per distinct node (for closed data the last point is the first);
    /// of two, the one before the node comes first. The one beyond an open end stays zero.
    fn tension(&self) -> &[f64];

    /// Changes some tensions (by index, ascending, each at most once), brings the tangents up to
    /// date, and appends to `touched` ranges that cover every segment whose end legs changed.
    ///
    /// # Errors
    /// A system that cannot be solved.
    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), Self::Error>;

    /// Fills `legs` with the end legs of some segments as they would be, up to rounding, with some other
    /// tensions (as for [`TensionFamily::set_tension`]); nothing else changes. False where
    /// that is not much cheaper than to set it.
    ///
    /// A search that does without is as good, and slower.
    fn trial_legs(
        &mut self,
        _changes: &[(usize, f64)],
        _segments: Range<usize>,
        _legs: &mut Vec<[DVec3; 2]>,
    ) -> bool {
        false
    }

    /// Solves everything anew from the present tensions, whatever was solved before.
    ///
    /// # Errors
    /// A system that cannot be solved.
    fn solve(&mut self) -> Result<(), Self::Error>;

    /// True if the current tangents come from a full solve, so that no final verification is needed.
    fn is_fully_solved(&self) -> bool {
        false
    }

    /// First and last Bézier leg, `a` and `c`, of a segment.
    fn end_legs(&self, segment: usize) -> [DVec3; 2];

    /// Tension in units in which equal pulls at the two nodes of an inflecting coplanar segment put
    /// its inflection where [`shapespline_criteria::inflection_parameter`] says, in the limit:
    /// there the rule (5.65) of paper 001 keeps `tension / unit` equal. One for ν-splines, for
    /// which (5.9) was derived.
    fn tension_unit(&self, _node: usize) -> f64 {
        1.0
    }
}

/// [`TensionFamily::tension_unit`] of a family whose tangents are, in the limit, `1/(1 + tension)`
/// times the velocity `w L_{i−1}/h_{i−1} + (1−w) L_i/h_i`, `w = h_i/(h_{i−1} + h_i)`.
///
/// Those of the ν-spline are `6/(ν_i √(w(1−w)))` times it, and at an end with a given tangent `1/ν`
/// times that: the legs agree where `1 + tension` is this unit times a common `ν/12`.
#[must_use]
pub fn tension_unit(polygon: &DataPolygon, node: usize) -> f64 {
    let n = polygon.segments();
    if (node == 0 || node == n) && !polygon.is_closed() {
        return if polygon.tangents()[usize::from(node > 0)].is_some() { 12.0 } else { 2.0 };
    }
    let before = if node == 0 { n - 1 } else { node - 1 };
    let root = (polygon.spacing(before) / polygon.spacing(node)).sqrt();
    2.0 / (root + 1.0 / root)
}
