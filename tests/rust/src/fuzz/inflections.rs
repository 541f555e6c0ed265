// SPDX-License-Identifier: MIT OR Apache-2.0

//! Inflection counts of polygons and curves.

use shapespline::criteria::{
    InflectionCount, curve_inflections, curve_inflections_from, polygon_inflections,
    polygon_inflections_from,
};
use shapespline::prelude::*;

use super::{Bytes, any_curve::piecewise, readable};

/// Inflection counts. The direction that comes with a count shows that many, no other direction that is
/// tried shows more where the count says it is exact, and unusable input is an error.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let planar = bytes.below(4) == 0;
    if bytes.flag() {
        let dimension = if planar { Dimension::Two } else { Dimension::Three };
        let n = bytes.below(16) + 1;
        let points = bytes.points(n, planar);
        let most = match polygon_inflections(&points, dimension) {
            Ok(most) => most,
            Err(error) => return readable(&error),
        };
        assert!(most.count <= n.saturating_sub(3), "{most:?} of {n} points");
        compare(&mut bytes, planar, most, &points, |w| {
            polygon_inflections_from(&points, dimension, w)
        });
    } else if let Some(curve) = piecewise(&mut bytes, planar) {
        let most = curve_inflections(&curve);
        compare(&mut bytes, planar, most, &curve, |w| curve_inflections_from(&curve, w));
    }
}

fn compare<E: std::fmt::Display>(
    bytes: &mut Bytes<'_>,
    planar: bool,
    most: InflectionCount,
    subject: &impl std::fmt::Debug,
    from: impl Fn(DVec3) -> Result<InflectionCount, E>,
) {
    assert!((most.direction.length() - 1.0).abs() < 1e-12, "{most:?}");
    let witness = from(most.direction).map_err(|e| e.to_string()).unwrap();
    assert_eq!(witness.count, most.count, "{most:?} {witness:?} of {subject:?}");
    for _ in 0..6 {
        let direction = if planar { DVec3::Z * bytes.unscaled() } else { bytes.vector(false) };
        match from(direction) {
            // Certain on both sides, and no wrong answer of rounding either.
            Ok(seen) if seen.exact && most.exact => {
                assert!(seen.count <= most.count, "{most:?} {seen:?} of {subject:?}");
            }
            Ok(_) => {}
            Err(error) => readable(&error),
        }
    }
}
