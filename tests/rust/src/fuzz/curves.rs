// SPDX-License-Identifier: MIT OR Apache-2.0

//! Curves of given tension, and everything a curve can be asked.

use shapespline::{geometry::InputError, prelude::*};

use super::{Bytes, readable};

/// Constructors of all families with given tension. A curve passes through its points to the bit, is
/// finite between them, has a length, survives being written and read, and answers every question at
/// every parameter.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let Some(polygon) = bytes.polygon(24) else { return };
    let n = polygon.points().len();
    let family = bytes.below(3);
    let nodal: Vec<f64> = match bytes.below(4) {
        0 => vec![0.0; n],
        1 => {
            let mut nodal: Vec<f64> = (0..n).map(|_| bytes.unscaled()).collect();
            if bytes.below(4) != 0 {
                nodal[n - 1] = nodal[0];
            }
            nodal
        }
        2 => (0..bytes.below(32)).map(|_| bytes.unscaled()).collect(),
        _ => vec![bytes.unscaled().abs(); n],
    };
    match family {
        0 => ask(&mut bytes, &polygon, NuSpline::new(polygon.clone(), Tension::Nodes(&nodal))),
        1 => {
            // From a tension to a scale in (0, 1], where it is allowed at all.
            let scale: Vec<f64> = nodal.iter().map(|t| 1.0 / (1.0 + t)).collect();
            let scale = if bytes.flag() {
                TangentScale::Nodes(&scale)
            } else {
                TangentScale::Segments(
                    &scale[..scale.len().min(n - 1)],
                    &scale[scale.len().min(1)..],
                )
            };
            ask(&mut bytes, &polygon, TensionSpline::new(polygon.clone(), scale));
        }
        _ => {
            let continuity = if bytes.flag() { Continuity::C1 } else { Continuity::G1 };
            let nodal: Vec<f64> = nodal.iter().map(|t| t / (1.0 + t.abs())).collect();
            let tension = Tension::Nodes(&nodal);
            ask(&mut bytes, &polygon, CatmullRom::new(polygon.clone(), tension, continuity));
        }
    }
}

fn ask<C>(bytes: &mut Bytes<'_>, polygon: &DataPolygon, made: Result<C, FitError>)
where
    C: Interpolant + PartialEq + std::fmt::Debug + serde::Serialize + serde::de::DeserializeOwned,
    C::Curve: Sized,
{
    let spline = match made {
        Ok(spline) => spline,
        Err(error) => return readable(&error),
    };
    interpolates(&spline, polygon);
    questions(spline.curve(), bytes);
    assert_eq!(spline.tension().len(), polygon.points().len());
    assert_eq!(spline.tangents().len(), polygon.points().len());
    let checked = spline.check(Criteria::ALL, Tolerances::default());
    let refused = |error: InputError| panic!("a curve refuses its own polygon: {error}");
    let report = checked.unwrap_or_else(refused);
    assert!(!report.to_string().is_empty());
    // What rounding hides is said, with its place.
    for open in &report.undecided {
        assert!(open.segment < polygon.segments(), "{open:?}");
        let [from, to] = open.interval;
        assert!(from <= to && from.is_finite() && to.is_finite(), "{open:?}");
    }
    let stored = postcard::to_stdvec(&spline).unwrap();
    assert_eq!(postcard::from_bytes::<C>(&stored).unwrap(), spline);
}

/// The curve passes through the points exactly, from both sides, and is finite in between.
pub(super) fn interpolates<C: Interpolant<Curve: Sized>>(spline: &C, polygon: &DataPolygon) {
    let curve = spline.curve();
    for (&u, &p) in polygon.parameters().iter().zip(polygon.points()) {
        assert_eq!(curve.evaluate(u, 0, Side::Left), p, "from the left at {u}");
        assert_eq!(curve.evaluate(u, 0, Side::Right), p, "from the right at {u}");
    }
    for segment in 0..polygon.segments() {
        for t in [0.25, 0.5, 0.75] {
            let u = curve.parameter(segment, t);
            let position = curve.evaluate(u, 0, Side::Right);
            assert!(position.is_finite(), "{position} at {u}");
        }
    }
}

/// Every question at some parameters inside, at and outside the ends.
pub(super) fn questions(curve: &dyn Curve, bytes: &mut Bytes<'_>) {
    let knots = curve.cubic().knots();
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let mut queries = vec![first, last, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    queries.extend((0..4).map(|_| first + bytes.fraction() * (last - first)));
    queries.extend((0..4).map(|_| bytes.number()));
    for &u in &queries {
        for side in [Side::Left, Side::Right] {
            let (segment, t) = curve.locate(u, side);
            assert!(segment < curve.cubic().segments(), "{u}: segment {segment}");
            if u >= first && u <= last {
                assert!((0.0..=1.0).contains(&t), "{u}: t = {t}");
                let position = curve.evaluate(u, 0, side);
                assert!(position.is_finite(), "{position} at {u} of {:?}", curve.cubic());
            }
            if u.is_nan() {
                assert!(curve.evaluate(u, 0, side).x.is_nan());
            }
            let _ = (curve.derivatives(u, side), curve.curvature(u, side));
            let _ = (curve.curvature_vector(u, side), curve.torsion(u, side));
            let _ = curve.frame(u, side);
        }
    }
    for order in 0..6 {
        if let Ok(many) = curve.evaluate_many(&queries, order, Side::Right) {
            assert_eq!(many.len(), queries.len() * curve.cubic().dimension().count());
        }
    }
    lengths(curve, first, last, bytes);
}

/// Lengths grow from zero to the whole, and a length leads back to its parameter.
fn lengths(curve: &dyn Curve, first: f64, last: f64, bytes: &mut Bytes<'_>) {
    let table = ArcLength::new(curve);
    let total = table.total();
    assert!(total >= 0.0, "{total}");
    let _ = (table.upto(bytes.number()), table.parameter(bytes.number()));
    for length in [f64::NAN, f64::INFINITY, -1.0, total] {
        let u = table.parameter(length);
        assert!(u >= first && u <= last, "{length}: {u}");
    }
    // Where the sum overflows there is nothing to compare.
    if !total.is_finite() {
        return;
    }
    let wanted = bytes.fraction() * total;
    let u = table.parameter(wanted);
    assert!(u >= first && u <= last, "{wanted} of {total}: {u}");
    // No better than the parameters between which it lies can say: a step may be many lengths long.
    let around = [u.next_down().max(first), u, u.next_up().min(last)].map(|u| table.upto(u));
    let slack = 1e-9 * total;
    assert!(
        around[0] - slack <= wanted && wanted <= around[2] + slack,
        "{wanted:e} of {total:e} at {u:e}: {around:?} on {:?}",
        curve.cubic()
    );
}
