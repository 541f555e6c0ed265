//! The most strict sign changes that a sequence of vectors can show: `sup_w S(w·V_1, …, w·V_m)` over
//! all directions `w`, exactly.
//!
//! The sign vector is constant on each open cell into which the great circles `w·V_i = 0` cut the
//! sphere of directions, and every cell has a piece of some circle on its boundary. So it is enough to
//! walk around each circle, flipping one sign at a time where another circle crosses it, and to look to
//! both sides: O(m² log m), and no direction is sampled. Crossings that rounding cannot tell apart are
//! crossed together: a cell between them might not be there.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

/// A unit vector, and how far rounding can have turned it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Direction {
    pub(crate) v: DVec3,
    pub(crate) error: f64,
}

/// Number of strict sign changes of a sequence; numbers of size `zero` and less are left out.
pub(crate) fn strict(values: impl IntoIterator<Item = f64>, zero: f64) -> usize {
    let (mut changes, mut last) = (0, 0.0);
    for x in values.into_iter().filter(|x| x.abs() > zero) {
        changes += usize::from(last * x.signum() < 0.0);
        last = x.signum();
    }
    changes
}

/// The most sign changes of unit vectors, and a direction that sees them.
pub(crate) fn most(vectors: &[Direction]) -> (usize, DVec3) {
    let walk = |i: usize| -> (usize, usize, DVec3) {
        let (count, w) = around(vectors, i);
        (count, i, w)
    };
    // Of equal counts the first circle, so that threads do not matter.
    let better = |a: (usize, usize, DVec3), b: (usize, usize, DVec3)| {
        if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a }
    };
    let start = || (0, usize::MAX, DVec3::Z);
    let (count, _, w) =
        (0..vectors.len()).into_par_iter().with_min_len(8).map(walk).reduce(start, better);
    (count, w)
}

/// The most sign changes on either side of the great circle of one vector.
fn around(vectors: &[Direction], i: usize) -> (usize, DVec3) {
    let Direction { v, error } = vectors[i];
    let e1 = v.any_orthonormal_vector();
    let e2 = v.cross(e1);
    // Size of each vector's part in the circle's plane; none for parallel ones, which never change
    // sign on it.
    let slack = |w: &Direction| error + w.error + 8.0 * f64::EPSILON;
    let part = |w: &Direction| (w.v.dot(e1), w.v.dot(e2));
    let plane: Vec<Option<f64>> = vectors
        .iter()
        .map(|w| (part(w).0.hypot(part(w).1), w))
        .map(|(size, w)| (size > 8.0 * slack(w)).then_some(size))
        .collect();
    // Angles in [0, π) at which each vector changes sign, and what rounding leaves open of them.
    let event = |(j, w): (usize, &Direction)| {
        let (x, y) = part(w);
        plane[j].map(|size| ((-x).atan2(y).rem_euclid(PI), j, slack(w) / size))
    };
    let mut events: Vec<(f64, usize, f64)> = vectors.iter().enumerate().filter_map(event).collect();
    events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let count = events.len();
    // Begin in the widest gap, where every sign is safe.
    let gap = |k: usize| match events.get(k + 1) {
        Some(next) => next.0 - events[k].0,
        None => events[0].0 + PI - events[k].0,
    };
    let widest = (0..count).max_by(|&a, &b| gap(a).total_cmp(&gap(b)));
    let begin = widest.map_or(0.0, |k| events[k].0 + 0.5 * gap(k));
    let direction = |angle: f64| e1 * angle.cos() + e2 * angle.sin();

    let mut best = (0, v);
    for side in [1.0, -1.0] {
        let w = direction(begin);
        let mut positive: Vec<bool> = (0..vectors.len())
            .map(|j| match plane[j] {
                Some(_) => vectors[j].v.dot(w) > 0.0,
                None => side * vectors[j].v.dot(v) > 0.0,
            })
            .collect();
        let mut changes = positive.windows(2).filter(|p| p[0] != p[1]).count();
        let mut keep = |changes: usize, angle: f64| {
            if changes > best.0 {
                best = (changes, off_circle(vectors, &plane, direction(angle), v * side));
            }
        };
        keep(changes, begin);
        let first = widest.map_or(0, |k| k + 1);
        for step in 0..count.saturating_sub(1) {
            let k = (first + step) % count;
            flip(&mut positive, events[k].1, &mut changes);
            if gap(k) > 2.0 * (events[k].2 + events[(k + 1) % count].2) {
                // Beyond π the walk is on the other half of the circle.
                let turned = if k < first { PI } else { 0.0 };
                keep(changes, events[k].0 + turned + 0.5 * gap(k));
            }
        }
    }
    best
}

/// Flips one sign and counts the changes beside it anew.
fn flip(positive: &mut [bool], j: usize, changes: &mut usize) {
    let beside = |s: &[bool]| {
        usize::from(j > 0 && s[j - 1] != s[j]) + usize::from(j + 1 < s.len() && s[j] != s[j + 1])
    };
    let before = beside(positive);
    positive[j] = !positive[j];
    *changes = *changes + beside(positive) - before;
}

/// A direction beside the circle, so close that no other sign changes.
fn off_circle(vectors: &[Direction], plane: &[Option<f64>], w: DVec3, v: DVec3) -> DVec3 {
    let crossing = vectors.iter().zip(plane).filter(|(_, p)| p.is_some());
    let least = crossing.fold(1.0f64, |m, (x, _)| m.min(x.v.dot(w).abs()));
    (w + v * (0.5 * least)).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vectors() -> impl Strategy<Value = Vec<DVec3>> {
        let unit = proptest::array::uniform3(-1.0..1.0f64)
            .prop_map(DVec3::from)
            .prop_filter("not zero", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize);
        proptest::collection::vec(unit, 1..14)
    }

    /// Vectors on a lattice: parallel ones and circles that meet in one point abound.
    fn lattice() -> impl Strategy<Value = Vec<DVec3>> {
        let unit = proptest::array::uniform3(-1..2i32)
            .prop_map(|v| DVec3::from(v.map(f64::from)))
            .prop_filter("not zero", |v| *v != DVec3::ZERO)
            .prop_map(DVec3::normalize);
        proptest::collection::vec(unit, 1..12)
    }

    proptest! {
        #[test]
        fn no_sampled_direction_sees_more_and_the_witness_sees_as_many(
            a in vectors(), b in lattice(), seeds in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 3000),
        ) {
            for v in [a, b] {
                let exact: Vec<Direction> =
                    v.iter().map(|&v| Direction { v, error: f64::EPSILON }).collect();
                let (count, w) = most(&exact);
                prop_assert_eq!(strict(v.iter().map(|x| x.dot(w)), 1e-14), count);
                for s in &seeds {
                    let d = DVec3::from(*s);
                    prop_assert!(strict(v.iter().map(|x| x.dot(d)), 1e-14) <= count);
                }
            }
        }
    }

    #[test]
    fn parallel_vectors_change_as_their_signs_do() {
        let v = [1.0, -1.0, -1.0, 1.0, -1.0].map(|s| Direction {
            v: DVec3::new(2.0, 1.0, -3.0).normalize() * s,
            error: f64::EPSILON,
        });
        assert_eq!(most(&v).0, 3);
        assert_eq!(most(&[]).0, 0);
        assert_eq!(most(&v[..1]).0, 0);
    }
}
