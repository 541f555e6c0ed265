// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long regular polygons and batches of every size at which work is cut into blocks.

use shapespline::prelude::*;

use super::{
    Bytes, readable,
    shape_preserving::{Judged, is_well_posed},
};

/// Sizes at which something is cut into blocks, or done another way; the long ones are rare.
const SIZES: [usize; 16] =
    [8, 16, 32, 64, 64, 64, 96, 96, 128, 128, 257, 257, 512, 2048, 4096, 8192];

/// The same few steps over and over, perhaps with a point that is off. What is solved has a clean report;
/// with default options everything is solved that is posed well. Many parameters at once give what each
/// gives alone, to the bit.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let planar = bytes.below(4) == 0;
    let Some(polygon) = polygon(&mut bytes, planar) else { return };
    let family = bytes.below(4);
    let strategy = if bytes.flag() { Strategy::Fairest } else { Strategy::Growth };
    let options = SearchOptions { strategy, ..SearchOptions::default() };
    let must_solve = bytes.is_tame() && is_well_posed(&polygon);
    let mut judged = Judged { bytes: &mut bytes, polygon: &polygon, options: &options, must_solve };
    match family {
        0 => judged.judge(NuSpline::shape_preserving(polygon.clone(), &options), batches),
        1 => judged.judge(TensionSpline::shape_preserving(polygon.clone(), &options), batches),
        _ => {
            let continuity = if family == 2 { Continuity::C1 } else { Continuity::G1 };
            let handles = HandleOptions { continuity, ..HandleOptions::default() };
            judged.judge(CatmullRom::shape_preserving(polygon.clone(), &handles), batches);
        }
    }
}

/// A size around one of those that matter.
fn size(bytes: &mut Bytes<'_>) -> usize {
    // One in eight may be long.
    let long = bytes.below(8) == 0;
    SIZES[bytes.below(if long { SIZES.len() } else { 12 })] + bytes.below(5) - 2
}

fn polygon(bytes: &mut Bytes<'_>, planar: bool) -> Option<DataPolygon> {
    let n = size(bytes);
    let period = 1 + bytes.below(8);
    let steps: Vec<DVec3> = (0..period).map(|_| bytes.vector(planar)).collect();
    let mut points = vec![bytes.vector(planar)];
    points.extend(steps.iter().cycle().take(n - 1).scan(points[0], |p, &step| {
        *p += step;
        Some(*p)
    }));
    if bytes.below(4) == 0 {
        let hair = 10f64.powi(-(bytes.below(17) as i32));
        points[(bytes.fraction() * (n - 1) as f64) as usize] += bytes.vector(planar) * hair;
    }
    let boundary = bytes.boundary(planar);
    if boundary == Boundary::Periodic {
        points.push(points[0]);
    }
    let names = [Parametrization::Uniform, Parametrization::Chordal, Parametrization::Centripetal];
    let dimension = if planar { Dimension::Two } else { Dimension::Three };
    let polygon = DataPolygon::with_dimension(points, dimension, &names[bytes.below(3)], boundary);
    polygon.inspect_err(readable).ok()
}

/// Batches of parameters: sorted, backwards and in no order, inside and outside.
fn batches(curve: &dyn Curve, bytes: &mut Bytes<'_>) {
    let knots = curve.cubic().knots();
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let m = size(bytes);
    let (skip, beyond) = (1 + bytes.below(7), bytes.fraction() - 0.5);
    let at = |k: usize| {
        let part = (k * skip % m) as f64 / (m - 1) as f64;
        first + (last - first) * part * (1.0 + beyond)
    };
    let mut u: Vec<f64> = (0..m).map(at).collect();
    if bytes.flag() {
        u.reverse();
    }
    if bytes.flag() {
        let knots = knots.iter().copied().cycle();
        u.iter_mut().zip(knots).step_by(3).for_each(|(u, knot)| *u = knot);
    }
    let side = if bytes.flag() { Side::Left } else { Side::Right };
    for order in 0..3 {
        let many = curve.evaluate_many(&u, order, side).unwrap();
        let columns = curve.cubic().dimension().count();
        for (&u, row) in u.iter().zip(many.chunks(columns)) {
            let alone = curve.evaluate(u, order, side).to_array();
            let same = row.iter().zip(alone).all(|(x, y)| x.to_bits() == y.to_bits());
            assert!(same, "{u}: {row:?} among {m}, {alone:?} alone, order {order}");
        }
    }
}
