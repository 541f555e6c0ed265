// SPDX-License-Identifier: MIT OR Apache-2.0

//! Random segments in random polygons, in which every criterion applies often and holds about as often
//! as not.

use shapespline::prelude::*;

use crate::generate::Random;

/// The segment of [`polygon`] that is looked at.
pub const SEGMENT: usize = 2;

/// Six points; the third segment, from point 2 to point 3, is the one to look at. By `kind` (0 to 5)
/// the four points around it are in general position, coplanar and convex, coplanar and inflecting,
/// or three of them collinear at its start, at its end, or the whole is planar.
#[must_use]
pub fn polygon(kind: usize, random: &mut Random) -> DataPolygon {
    let mut steps: Vec<DVec3> = (0..5).map(|_| random.vector()).collect();
    match kind {
        1 | 2 => {
            // L_3 in the plane of L_1 and L_2, on the same or on the other side of L_2.
            let side = if kind == 1 { -1.0 } else { 1.0 };
            let along = random.within(-1.0, 1.0);
            steps[3] = steps[1] * (side * random.within(0.2, 1.5)) + steps[2] * along;
        }
        3 => steps[1] = steps[2] * random.within(0.2, 2.0),
        4 => steps[3] = steps[2] * random.within(0.2, 2.0),
        5 => steps.iter_mut().for_each(|s| s.z = 0.0),
        _ => {}
    }
    let mut points = vec![random.vector()];
    for step in steps {
        points.push(points[points.len() - 1] + step);
    }
    DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature).unwrap()
}

/// End legs: near what a shape-preserving curve would have, further and further from it.
#[must_use]
pub fn legs(polygon: &DataPolygon, random: &mut Random) -> [DVec3; 2] {
    let chord = |i: usize| polygon.chord(i);
    let size = chord(SEGMENT).length();
    let off = size * 10f64.powf(random.within(-3.0, 0.0));
    let mut leg = |i: usize| {
        let t = chord(i) * random.within(0.1, 1.0) + chord(i + 1) * random.within(0.1, 1.0);
        t.normalize() * (size * random.within(0.05, 0.9)) + random.vector() * off
    };
    let [mut a, mut c] = [leg(SEGMENT - 1), leg(SEGMENT)];
    if polygon.points().iter().all(|p| p.z == polygon.points()[0].z) {
        (a.z, c.z) = (0.0, 0.0);
    }
    [a, c]
}

/// A polygon and end legs by a running number.
#[must_use]
pub fn case(k: usize, random: &mut Random) -> (DataPolygon, [DVec3; 2]) {
    let polygon = polygon(k % 6, random);
    let legs = legs(&polygon, random);
    (polygon, legs)
}
