// SPDX-License-Identifier: MIT OR Apache-2.0

//! Batches of the segments of a polygon, coordinate by coordinate, for arithmetic on several at once.
//!
//! A formula in a loop over [`VectorLanes`] is compiled for as many segments at a time as the machine's
//! registers hold, if it has no branches; each operation is the one that a lone segment would get, so
//! the results are the same to the bit. What needs branches is left to a second loop over the few
//! places where it matters.

use std::ops::Range;

use glam::DVec3;

use crate::{
    DataPolygon,
    error::outside,
    vector::{is_ordinary, normalize},
};

/// The vectors of one batch, coordinate by coordinate.
#[derive(Debug, Clone)]
pub struct VectorLanes {
    x: [f64; SegmentBatch::ROOM],
    y: [f64; SegmentBatch::ROOM],
    z: [f64; SegmentBatch::ROOM],
}

impl Default for VectorLanes {
    fn default() -> Self {
        let zero = [0.0; SegmentBatch::ROOM];
        Self { x: zero, y: zero, z: zero }
    }
}

impl VectorLanes {
    /// Vector `j`.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, j: usize) -> DVec3 {
        DVec3::new(self.x[j], self.y[j], self.z[j])
    }

    /// Puts a vector at place `j`.
    #[inline(always)]
    pub fn set(&mut self, j: usize, v: DVec3) {
        (self.x[j], self.y[j], self.z[j]) = (v.x, v.y, v.z);
    }

    /// Whether the vectors of some places are finite and leave room for sums of them (1.1e307).
    #[must_use]
    pub fn have_room(&self, places: Range<usize>) -> bool {
        let count = |row: &[f64]| row[places.clone()].iter().map(|&x| outside(x)).sum::<u64>();
        count(&self.x) + count(&self.y) + count(&self.z) == 0
    }
}

/// Consecutive segments of a polygon and three on each side: all that local methods read.
///
/// Place `j` stands for segment `start − 3 + j` of the polygon, and for the node at its end. On closed
/// polygons indices wrap. The places beyond the ends of an open one hold copies of the end segment, but
/// the direction next to it is the stand-in that [`DataPolygon::directions_around`] has there, and nodes
/// beyond the ends have no binormal vector.
#[derive(Debug, Clone)]
pub struct SegmentBatch {
    start: usize,
    places: usize,
    ordinary: bool,
    far: f64,
    chords: VectorLanes,
    spacings: [f64; Self::ROOM],
    lengths: [f64; Self::ROOM],
    directions: VectorLanes,
    binormals: VectorLanes,
    sines: [f64; Self::ROOM],
}

impl Default for SegmentBatch {
    fn default() -> Self {
        Self {
            start: 0,
            places: 0,
            ordinary: true,
            far: 0.0,
            chords: VectorLanes::default(),
            spacings: [0.0; Self::ROOM],
            lengths: [0.0; Self::ROOM],
            directions: VectorLanes::default(),
            binormals: VectorLanes::default(),
            sines: [0.0; Self::ROOM],
        }
    }
}

impl SegmentBatch {
    /// Segments that a batch has on either side of its own.
    ///
    /// A criterion asks about the binormal vectors at the two nodes of a segment and at those beside them,
    /// which takes two; what the segment before and after its own ask for takes one more.
    pub const BESIDE: usize = 3;

    /// The most segments of its own that a batch has: all that is worked on stays in the first cache.
    pub const OWN: usize = 64;

    /// Room for them all.
    pub const ROOM: usize = Self::OWN + 2 * Self::BESIDE;

    /// Fills the batch from some segments of a polygon, at least one and at most [`SegmentBatch::OWN`].
    pub fn load(&mut self, polygon: &DataPolygon, own: Range<usize>) {
        self.start = own.start;
        self.places = own.len() + 2 * Self::BESIDE;
        self.load_chords(polygon);
        self.find_directions(polygon);
        for j in 0..self.less(1) {
            let binormal = self.directions.get(j).cross(self.directions.get(j + 1));
            self.binormals.set(j, binormal);
            self.sines[j] = binormal.length();
        }
        // Open polygons: no chords meet beyond the first and the last node.
        let inner = self.segments(polygon);
        for j in (0..inner.start.saturating_sub(1)).chain(inner.end..self.places) {
            self.binormals.set(j, DVec3::ZERO);
        }
    }

    fn load_chords(&mut self, polygon: &DataPolygon) {
        let (places, n) = (self.places(), polygon.segments());
        let own = self.start..self.start + places - 2 * Self::BESIDE;
        let inside = own.start.saturating_sub(Self::BESIDE)..(own.end + Self::BESIDE).min(n);
        let skip = inside.start + Self::BESIDE - own.start;
        let nodes = inside.start..=inside.end;
        let points = &polygon.points()[nodes.clone()];
        let parameters = polygon.parameters()[nodes].windows(2);
        for (j, (p, u)) in (skip..self.less(0)).zip(points.windows(2).zip(parameters)) {
            self.chords.set(j, p[1] - p[0]);
            self.spacings[j] = u[1] - u[0];
        }
        self.far = largest(bytemuck::cast_slice(points));
        for j in (0..skip).chain(skip + inside.len()..places) {
            // Around a closed polygon; beyond an open end the last segment once more.
            let i = if polygon.is_closed() {
                (own.start + j + Self::BESIDE * (n - 1)) % n
            } else {
                (own.start + j).saturating_sub(Self::BESIDE).min(n - 1)
            };
            self.chords.set(j, polygon.chord(i));
            self.spacings[j] = polygon.spacing(i);
        }
    }

    fn find_directions(&mut self, polygon: &DataPolygon) {
        let mut far = 0;
        for j in 0..self.less(0) {
            let chord = self.chords.get(j);
            self.lengths[j] = chord.length();
            self.directions.set(j, chord / self.lengths[j]);
            far += u64::from(!is_ordinary(chord));
        }
        self.ordinary = far == 0;
        if !self.ordinary {
            for j in 0..self.places() {
                self.directions.set(j, normalize(self.chords.get(j)));
            }
        }
        let inner = self.segments(polygon);
        let places = [inner.start.checked_sub(1), Some(inner.end)];
        for (place, tangent) in places.into_iter().zip(polygon.tangents()) {
            // Past the last place: not an end of the polygon.
            if let (Some(j), Some(tangent)) = (place.filter(|&j| j < self.places()), tangent) {
                self.directions.set(j, normalize(tangent));
            }
        }
    }

    /// The number of places.
    #[must_use]
    pub fn places(&self) -> usize {
        self.places
    }

    /// The number of places less a constant. Places `j, …, j + fewer` for `j` below it are in bounds,
    /// and the compiler sees it: a check of bounds in a loop would keep it from working on several at
    /// once.
    #[inline(always)]
    #[must_use]
    pub fn less(&self, fewer: usize) -> usize {
        self.places.saturating_sub(fewer).min(Self::ROOM - fewer)
    }

    /// The places of its own segments.
    #[inline(always)]
    #[must_use]
    pub fn own(&self) -> Range<usize> {
        Self::BESIDE..self.places() - Self::BESIDE
    }

    /// The places that stand for segments of the polygon: not those beyond its ends.
    #[must_use]
    pub fn segments(&self, polygon: &DataPolygon) -> Range<usize> {
        if polygon.is_closed() {
            return 0..self.places();
        }
        let last = polygon.segments() - self.start + Self::BESIDE;
        Self::BESIDE.saturating_sub(self.start)..last.min(self.places())
    }

    /// The segment that a place stands for.
    #[inline]
    #[must_use]
    pub fn segment(&self, polygon: &DataPolygon, place: usize) -> usize {
        let n = polygon.segments();
        (self.start + place + Self::BESIDE * (n - 1)) % n
    }

    /// Whether all chords are of a size at which [`normalized_scale`](crate::normalized_scale)
    /// leaves them as they are.
    #[must_use]
    pub fn is_ordinary(&self) -> bool {
        self.ordinary
    }

    /// The largest coordinate of the points at the ends of its own segments, or a larger number.
    #[inline(always)]
    #[must_use]
    pub fn far(&self) -> f64 {
        self.far
    }

    /// The chords.
    #[inline(always)]
    #[must_use]
    pub fn chords(&self) -> &VectorLanes {
        &self.chords
    }

    /// The spacings of the parameters.
    #[inline(always)]
    #[must_use]
    pub fn spacings(&self) -> &[f64; Self::ROOM] {
        &self.spacings
    }

    /// The lengths of the chords, if all are of [ordinary](Self::is_ordinary) size.
    #[inline(always)]
    #[must_use]
    pub fn lengths(&self) -> &[f64; Self::ROOM] {
        &self.lengths
    }

    /// The unit chords, stand-ins included.
    #[inline(always)]
    #[must_use]
    pub fn directions(&self) -> &VectorLanes {
        &self.directions
    }

    /// The binormal vectors of the unit chords, at the node at the end of each place but the last.
    #[inline(always)]
    #[must_use]
    pub fn binormals(&self) -> &VectorLanes {
        &self.binormals
    }

    /// The lengths of the binormal vectors: sines of turning angles.
    #[inline(always)]
    #[must_use]
    pub fn sines(&self) -> &[f64; Self::ROOM] {
        &self.sines
    }
}

/// The largest absolute value, of several numbers at once.
fn largest(numbers: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (rows, rest) = numbers.as_chunks::<8>();
    let mut most = [0.0; 8];
    for row in rows {
        for (most, x) in most.iter_mut().zip(row) {
            *most = larger(*most, x.abs());
        }
    }
    rest.iter().map(|x| x.abs()).chain(most).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Boundary, Parametrization};

    /// Every coordinate of every place asked for counts, and no other.
    #[test]
    fn vectors_without_room_are_seen() {
        let places = 3..6;
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.2e307, -1.2e307, 1.1e307] {
            for place in 0..9 {
                for axis in DVec3::AXES {
                    let mut lanes = VectorLanes::default();
                    lanes.set(
                        place,
                        DVec3::select(axis.cmpgt(DVec3::ZERO), DVec3::splat(number), axis),
                    );
                    let room = number == 1.1e307 || !places.contains(&place);
                    assert_eq!(lanes.have_room(places.clone()), room, "{number} at {place}");
                }
            }
        }
    }

    /// To the bit what the polygon says, at every size, around closed ones and at open ends.
    #[test]
    fn a_stretch_is_what_the_polygon_says() {
        let mut batch = SegmentBatch::default();
        for n in [2, 3, 63, 64, 65, 130] {
            for exponent in [-250, -38, 0, 38, 250] {
                let size = 10f64.powi(exponent);
                let at = |k: usize| {
                    let t = k as f64;
                    DVec3::new((0.4 * t).cos(), (1.1 * t).sin(), 0.3 * t) * size
                };
                let open: Vec<DVec3> = (0..=n).map(at).collect();
                let mut closed = open.clone();
                closed[n] = closed[0];
                let tangents = Boundary::tangents(DVec3::X, DVec3::Y * 1e-200);
                let boundaries = [Boundary::ZeroCurvature, Boundary::Circular, tangents];
                let polygons = boundaries.map(|boundary| (&open, boundary));
                for (points, boundary) in
                    [(&closed, Boundary::Periodic)].into_iter().chain(polygons)
                {
                    let points = points.clone();
                    let polygon =
                        DataPolygon::new(points, &Parametrization::Centripetal, boundary).unwrap();
                    for start in (0..n).step_by(SegmentBatch::OWN) {
                        let own = start..n.min(start + SegmentBatch::OWN);
                        batch.load(&polygon, own.clone());
                        assert_eq!(batch.own().len(), own.len());
                        for (j, i) in batch.own().zip(own) {
                            assert_eq!(batch.segment(&polygon, j), i);
                            assert!(batch.segments(&polygon).contains(&j));
                            assert_eq!(batch.chords().get(j), polygon.chord(i));
                            assert_eq!(batch.spacings()[j], polygon.spacing(i));
                            let around = [j - 1, j, j + 1].map(|j| batch.directions().get(j));
                            assert_eq!(around, polygon.directions_around(i));
                            let binormals = [j - 1, j].map(|j| batch.binormals().get(j));
                            assert_eq!(binormals, polygon.binormals(i));
                            let beside = [j - 2, j + 1].map(|j| batch.binormals().get(j));
                            assert_eq!(beside, polygon.binormals_beside(i));
                        }
                        for j in batch.segments(&polygon) {
                            let i = batch.segment(&polygon, j);
                            assert_eq!(batch.chords().get(j), polygon.chord(i));
                            assert_eq!(batch.directions().get(j), polygon.direction(i));
                            assert_eq!(batch.spacings()[j], polygon.spacing(i));
                        }
                    }
                }
            }
        }
    }
}
