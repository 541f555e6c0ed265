//! What a family of splines has to say to be searched.

use std::ops::Range;

use shapespline_geometry::DVec3;

/// A family of cubic interpolants of one data polygon with a tension `≥ 0` at each node.
///
/// The search needs of it that growing tension draws the curve to the polygon in such a way that the
/// shape criteria hold in the limit, and that tension at a node acts locally. To add a family,
/// implement these four methods; the search, the criteria, the report and the curve follow.
pub trait TensionFamily: Sync {
    /// Why a system could not be solved.
    type Error;

    /// The tension at each distinct node (for closed data the last point is the first).
    fn tension(&self) -> &[f64];

    /// Changes the tension at some nodes (ascending, each at most once), brings the tangents up to
    /// date, and appends to `touched` ranges that cover every segment whose end legs changed.
    ///
    /// # Errors
    /// A system that cannot be solved.
    fn set_tension(
        &mut self,
        changes: &[(usize, f64)],
        touched: &mut Vec<Range<usize>>,
    ) -> Result<(), Self::Error>;

    /// Solves everything anew from the present tensions, trusting nothing stored.
    ///
    /// # Errors
    /// A system that cannot be solved.
    fn solve_again(&mut self) -> Result<(), Self::Error>;

    /// First and last Bézier leg, `a` and `c`, of a segment.
    fn end_legs(&self, segment: usize) -> [DVec3; 2];
}
