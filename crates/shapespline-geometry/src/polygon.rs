// SPDX-License-Identifier: MIT OR Apache-2.0

//! The data polygon: what the points themselves say about the shape of a curve through them.

use std::{ops::Range, sync::Arc};

use glam::DVec3;
use once_cell::race::OnceBox;
use shapespline_polynomial::parallel;

use crate::{
    Boundary, Coordinates, InputError, Parametrization,
    boundary::{check_tangent, circle_tangent},
    error::check_room,
    vector::{ORDINARY, is_ordinary, normalize},
};

/// Number of coordinates of the data a polygon was made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dimension {
    /// Planar data; the third coordinate is zero throughout.
    Two,
    /// Data in space.
    Three,
}

impl Dimension {
    /// The number of coordinates.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// Never: there is no dimension without coordinates.
    #[must_use]
    pub fn is_empty(self) -> bool {
        false
    }
}

/// A segment of a polygon: its chord `L_i` and the spacing `h_i` of its parameters.
pub type Span = (DVec3, f64);

/// Chords from two blocks of this many on are worked on by all threads.
const BLOCK: usize = 8192;

/// Points `I_0 … I_N` with parameters and end conditions, checked once, and the discrete shape they
/// have: unit chords, binormal vectors, the sign of the discrete torsion (paper 001, section 2).
///
/// At the ends a stand-in takes the place of the missing chord: the end tangent where there is one,
/// the first (last) chord itself for zero curvature; indices of closed data run modulo `N`.
///
/// All shape quantities are made of *unit* chords `l_i = L_i/‖L_i‖`, so they do not depend on the
/// scale of the data: `‖binormal(i)‖` is the sine of the turning angle at node `i`.
///
/// Points and parameters are shared: a curve through them keeps its polygon and no copies.
#[derive(Debug, Clone)]
pub struct DataPolygon {
    points: Arc<Vec<DVec3>>,
    parameters: Arc<Vec<f64>>,
    /// `l_{−1}, l_0, …, l_{N−1}, l_N`, made when shape is first asked for.
    directions: OnceBox<Vec<DVec3>>,
    boundary: Boundary,
    /// `D_0` and `D_N`, where the boundary has them.
    tangents: [Option<DVec3>; 2],
    dimension: Dimension,
}

impl DataPolygon {
    /// Polygon through points in space. Cost O(N).
    ///
    /// # Errors
    /// Fewer than two points (three for periodic and circular ends), NaN or infinite coordinates,
    /// repeated neighbours, a zero end tangent, periodic data that do not close, unusable
    /// parameters, and data so far apart that differences overflow.
    pub fn new(
        points: Vec<DVec3>,
        parametrization: &Parametrization,
        boundary: Boundary,
    ) -> Result<Self, InputError> {
        Self::with_dimension(points, Dimension::Three, parametrization, boundary)
    }

    /// Polygon through points of the plane.
    ///
    /// # Errors
    /// As [`DataPolygon::new`].
    pub fn planar(
        points: &[[f64; 2]],
        parametrization: &Parametrization,
        boundary: Boundary,
    ) -> Result<Self, InputError> {
        let points = points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect();
        Self::with_dimension(points, Dimension::Two, parametrization, boundary)
    }

    /// Polygon through points whose third coordinate is zero when `dimension` is two. The last point of
    /// periodic data is made equal to the first where they [agree](ends_agree) to rounding.
    ///
    /// # Errors
    /// As [`DataPolygon::new`].
    pub fn with_dimension(
        mut points: Vec<DVec3>,
        dimension: Dimension,
        parametrization: &Parametrization,
        boundary: Boundary,
    ) -> Result<Self, InputError> {
        if boundary == Boundary::Periodic && points.len() > 1 && ends_agree(&points) {
            let last = points.len() - 1;
            points[last] = points[0];
        }
        check_ends(&points, dimension, boundary)?;
        let longest = check_chords(&points, dimension)?;
        let parameters = parametrization.parameters(&points)?;
        check_velocities(&points, &parameters, longest)?;
        // No number of ordinary chords leads from a point with twice the room to one without.
        if longest > ORDINARY || check_room("points", &[2.0 * points[0]]).is_err() {
            check_room("points", &points)?;
        }
        let tangents = end_tangents(&points, &parameters, boundary, dimension)?;
        let directions = OnceBox::new();
        let (points, parameters) = (Arc::new(points), Arc::new(parameters));
        Ok(Self { points, parameters, directions, boundary, tangents, dimension })
    }

    /// The points `I_0 … I_N`.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The parameters `u_0 < … < u_N`.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// The end conditions as given.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The end tangents `D_0, D_N`, each where the boundary has it (given or circular).
    #[must_use]
    pub fn tangents(&self) -> [Option<DVec3>; 2] {
        self.tangents
    }

    /// Whether a node is an end without a tangent, as of zero curvature.
    #[must_use]
    pub fn is_natural_end(&self, node: usize) -> bool {
        let [start, end] = self.tangents.map(|tangent| tangent.is_none());
        !self.is_closed() && ((node == 0 && start) || (node == self.segments() && end))
    }

    /// Whether the data are planar or spatial by type.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Whether the data are closed (periodic boundary).
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.boundary == Boundary::Periodic
    }

    /// Number of segments, `N`.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.points.len() - 1
    }

    /// Number of distinct nodes: `N` for closed data (erratum E5), else `N + 1`.
    #[must_use]
    pub fn nodes(&self) -> usize {
        if self.is_closed() { self.segments() } else { self.points.len() }
    }

    /// Spacing `h_i = u_{i+1} − u_i`.
    #[inline]
    #[must_use]
    pub fn spacing(&self, segment: usize) -> f64 {
        self.parameters[segment + 1] - self.parameters[segment]
    }

    /// Spacings `h_{i−1}` and `h_{i+1}` beside a segment; at an open end the segment's own
    /// (paper 001, section 4).
    #[must_use]
    pub fn neighbour_spacings(&self, segment: usize) -> [f64; 2] {
        let n = self.segments();
        let (before, after) = if self.is_closed() {
            ((segment + n - 1) % n, (segment + 1) % n)
        } else {
            (segment.saturating_sub(1), (segment + 1).min(n - 1))
        };
        [self.spacing(before), self.spacing(after)]
    }

    /// Chord `L_i = I_{i+1} − I_i`.
    #[inline]
    #[must_use]
    pub fn chord(&self, segment: usize) -> DVec3 {
        self.points[segment + 1] - self.points[segment]
    }

    /// Chord and spacing of a segment.
    #[inline]
    #[must_use]
    pub fn span(&self, segment: usize) -> Span {
        (self.chord(segment), self.spacing(segment))
    }

    /// [`DataPolygon::span`] of one segment after the other.
    #[inline]
    pub fn spans(&self, segments: Range<usize>) -> impl Iterator<Item = Span> {
        let nodes = segments.start..segments.end + 1;
        let points = self.points[nodes.clone()].windows(2);
        let parameters = self.parameters[nodes].windows(2);
        points.zip(parameters).map(|(p, u)| (p[1] - p[0], u[1] - u[0]))
    }

    #[inline]
    fn directions(&self) -> &[DVec3] {
        self.directions.get_or_init(|| {
            let n = self.segments();
            // The first and the last place are filled in below.
            let direction = |i: usize| normalize(self.chord(i.clamp(1, n) - 1));
            let mut all: Vec<DVec3> = parallel::map(n + 2, 2 * BLOCK + 2, direction);
            (all[0], all[n + 1]) = if self.is_closed() {
                (all[n], all[1])
            } else {
                let [start, end] = self.tangents;
                (start.map_or(all[1], normalize), end.map_or(all[n], normalize))
            };
            Box::new(all)
        })
    }

    /// Unit chord `l_i`.
    #[inline]
    #[must_use]
    pub fn direction(&self, segment: usize) -> DVec3 {
        self.directions()[segment + 1]
    }

    /// The unit chords `l_{i−1}, l_i` that meet at a node (with the stand-ins at the ends).
    #[inline]
    #[must_use]
    pub fn directions_at(&self, node: usize) -> [DVec3; 2] {
        let directions = self.directions();
        [directions[node], directions[node + 1]]
    }

    /// Binormal vector of the unit chords at a node, `l_{i−1} × l_i`: `P_i` scaled so that its
    /// length is the sine of the turning angle.
    #[inline]
    #[must_use]
    pub fn binormal(&self, node: usize) -> DVec3 {
        let directions = self.directions();
        directions[node].cross(directions[node + 1])
    }

    /// The binormal vectors at the two nodes of a segment.
    #[inline]
    #[must_use]
    pub fn binormals(&self, segment: usize) -> [DVec3; 2] {
        let [before, own, after] = self.directions_around(segment);
        [before.cross(own), own.cross(after)]
    }

    /// The binormal vectors at the node before the first and at the node after the last node of a segment;
    /// zero beyond the ends of an open polygon.
    #[inline]
    #[must_use]
    pub fn binormals_beside(&self, segment: usize) -> [DVec3; 2] {
        let n = self.segments();
        let at = |node: Option<usize>| node.map_or(DVec3::ZERO, |node| self.binormal(node));
        if self.is_closed() {
            return [(segment + n - 1) % n, (segment + 2) % n].map(|node| self.binormal(node));
        }
        [at(segment.checked_sub(1)), at(Some(segment + 2).filter(|&node| node <= n))]
    }

    /// The unit chords of a segment and its neighbours, `l_{i−1}, l_i, l_{i+1}` (with the stand-ins at
    /// the ends).
    #[inline]
    #[must_use]
    pub fn directions_around(&self, segment: usize) -> [DVec3; 3] {
        let around = &self.directions()[segment..segment + 3];
        [around[0], around[1], around[2]]
    }

    /// `det[l_{i−1}, l_i, l_{i+1}]` of a segment: `Γ_i` of the unit chords.
    #[inline]
    #[must_use]
    pub fn gamma(&self, segment: usize) -> f64 {
        self.binormal(segment).dot(self.directions()[segment + 2])
    }

    /// Discrete torsion `Γ_i / (‖P_i‖ ‖P_{i+1}‖)` of a segment (paper 001, (2.1)), in reciprocal
    /// units of length; NaN where a binormal vector vanishes.
    #[must_use]
    pub fn discrete_torsion(&self, segment: usize) -> f64 {
        let sines = self.binormal(segment).length() * self.binormal(segment + 1).length();
        // With lengths put back, one factor ‖L_i‖ remains in the denominator.
        if sines == 0.0 {
            f64::NAN
        } else {
            self.gamma(segment) / sines / crate::length(self.chord(segment))
        }
    }

    /// Stores the end conditions only, for curves that store points and parameters themselves.
    ///
    /// # Errors
    /// Those of the serializer.
    #[cfg(feature = "serde")]
    pub fn serialize_boundary<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serde::Serialize::serialize(&self.boundary, serializer)
    }

    /// Points and parameters, shared with a curve through them.
    pub(crate) fn shared(&self) -> (Arc<Vec<DVec3>>, Arc<Vec<f64>>) {
        (Arc::clone(&self.points), Arc::clone(&self.parameters))
    }
}

/// Equal in points, parameters and end conditions.
impl PartialEq for DataPolygon {
    fn eq(&self, other: &Self) -> bool {
        (self.boundary, self.dimension) == (other.boundary, other.dimension)
            && self.points == other.points
            && self.parameters == other.parameters
    }
}

/// Whether the last point is the first, but for a few roundings of coordinates of this size: the points
/// of a circle, for example, do not close exactly.
#[must_use]
pub fn ends_agree(points: &[DVec3]) -> bool {
    /// Roundings that a coordinate may have seen, in units of the last place of the largest.
    const ROUNDINGS: f64 = 8.0;
    let [first, .., last] = points else { return true };
    let gap = (*last - *first).abs().max_element();
    if gap == 0.0 || !(first.is_finite() && last.is_finite()) {
        return gap == 0.0;
    }
    let extent = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    gap <= ROUNDINGS * f64::EPSILON * extent && extent.is_finite()
}

fn check_ends(
    points: &[DVec3],
    dimension: Dimension,
    boundary: Boundary,
) -> Result<(), InputError> {
    let (needed, why) = match boundary {
        Boundary::Periodic => (3, " for boundary \"periodic\""),
        Boundary::Circular => (3, " for boundary \"circular\""),
        _ => (2, ""),
    };
    if points.len() < needed {
        let found = points.len();
        return Err(InputError::TooFewPoints { argument: "points", needed, found, why });
    }
    let (start, end) = (points[0], points[points.len() - 1]);
    // Points that are not numbers are told of by `check_chords`.
    if boundary == Boundary::Periodic && start != end && start.is_finite() && end.is_finite() {
        let [start, end] = [start, end].map(|vector| Coordinates { vector, dimension });
        return Err(InputError::NotClosed { last: points.len() - 1, start, end });
    }
    Ok(())
}

/// Points must be finite, and neighbours differ, by no more than f64 holds. Returns a bound on the
/// components of chords, the largest of them where it is not ordinary.
fn check_chords(points: &[DVec3], dimension: Dimension) -> Result<f64, InputError> {
    let largest = |chords: Range<usize>| {
        let ends = points[chords.start..=chords.end].windows(2);
        if ends.map(|p| u64::from(!is_ordinary(p[1] - p[0]))).sum::<u64>() == 0 {
            return Ok(ORDINARY);
        }
        let mut longest = 0.0f64;
        for i in chords {
            let chord = points[i + 1] - points[i];
            let size = chord.abs().max_element();
            // A chord of numbers has two ends of numbers.
            if !chord.is_finite() || size == 0.0 {
                return Err(i);
            }
            longest = longest.max(size);
        }
        Ok(longest)
    };
    // Of two that are wrong the first is told of.
    let both = |a: Result<f64, usize>, b: Result<f64, usize>| match (a, b) {
        (Ok(a), Ok(b)) => Ok(a.max(b)),
        (Err(a), Err(b)) => Err(a.min(b)),
        (Err(i), _) | (_, Err(i)) => Err(i),
    };
    parallel::fold(points.len() - 1, BLOCK, largest, both)
        .map_err(|i| bad_chord(points, dimension, i))
}

/// What is wrong with chord `i`, the first that is not a positive number.
fn bad_chord(points: &[DVec3], dimension: Dimension, i: usize) -> InputError {
    for index in [i, i + 1] {
        let value = points[index].to_array().into_iter().find(|x| !x.is_finite());
        if let Some(value) = value {
            return InputError::NotFinite { argument: "points", index, value };
        }
    }
    let chord = points[i + 1] - points[i];
    if chord == DVec3::ZERO {
        let value = Coordinates { vector: points[i + 1], dimension };
        return InputError::RepeatedPoint { index: i + 1, value };
    }
    InputError::Overflow { index: i, what: "the chord", value: crate::length(chord) }
}

/// A chord over its spacing is the size of a tangent: if that overflows, so would every answer.
fn check_velocities(points: &[DVec3], parameters: &[f64], longest: f64) -> Result<(), InputError> {
    // Far from overflow all is well; a speed is taken only where that is in question.
    let short = |u: &[f64]| u64::from(!(u[1] - u[0] > longest * 1e-300));
    let count = |i: Range<usize>| parameters[i.start..=i.end].windows(2).map(short).sum::<u64>();
    if parallel::fold(points.len() - 1, BLOCK, count, |a, b| a + b) == 0 {
        return Ok(());
    }
    for (i, (p, u)) in points.windows(2).zip(parameters.windows(2)).enumerate() {
        let speed = (p[1] - p[0]).abs().max_element() * 6.0 / (u[1] - u[0]);
        if !speed.is_finite() {
            let what = "chord over parameter spacing";
            return Err(InputError::Overflow { index: i, what, value: speed });
        }
    }
    Ok(())
}

fn end_tangents(
    points: &[DVec3],
    parameters: &[f64],
    boundary: Boundary,
    dimension: Dimension,
) -> Result<[Option<DVec3>; 2], InputError> {
    match boundary {
        Boundary::ZeroCurvature | Boundary::Periodic => Ok([None; 2]),
        Boundary::Tangents { start, end } => {
            for (end, tangent) in [("start", start), ("end", end)] {
                tangent.map_or(Ok(()), |tangent| check_tangent(end, tangent, dimension))?;
            }
            Ok([start, end])
        }
        Boundary::Circular => {
            let n = points.len() - 1;
            let (first, last) = (parameters[1] - parameters[0], parameters[n] - parameters[n - 1]);
            Ok([
                Some(circle_tangent(points[0], points[1], points[2], first)),
                Some(-circle_tangent(points[n], points[n - 1], points[n - 2], last)),
            ])
        }
    }
}
