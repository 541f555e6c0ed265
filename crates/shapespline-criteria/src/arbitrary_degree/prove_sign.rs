// SPDX-License-Identifier: MIT OR Apache-2.0

//! The verdicts on a segment of any degree.

use glam::DVec3;
use shapespline_polynomial::{Polynomial, Sign};

use super::{
    Piece, Question, Segment, corners, single_sign_change::has_single_sign_change,
    turning::turns_at_nodes,
};
use crate::{Criterion, regular::Hodograph};

/// The verdict, with parameters local to the segment.
pub(crate) fn prove_sign(segment: &Segment, question: &Question) -> Sign {
    let [p, q] = question.normals;
    match question.criterion {
        Criterion::Convexity => turns(segment, p).and(turns(segment, q)),
        Criterion::GlobalConvexity => [p, q].into_iter().fold(Sign::Positive, |known, n| {
            known.and(turns(segment, n)).and(sees_its_start(segment, n))
        }),
        Criterion::Inflection => has_single_sign_change(segment, [p, q]),
        Criterion::Turning => turns_at_nodes(segment, question),
        Criterion::Torsion => {
            let sign = question.torsion_sign();
            each(segment, |piece| {
                let torsion = piece.determinant().map(1.0, |d| sign * d);
                // Written so that a NaN does not count as zero.
                let is_zero = || torsion.coefficients().iter().all(|d| d.abs() <= torsion.error());
                if piece.is_beside_straight() && is_zero() {
                    return Sign::Positive;
                }
                torsion.sign()
            })
        }
        Criterion::Coplanarity => cones(segment, question, Piece::omega),
        Criterion::Collinearity => cones(segment, question, Piece::tangent),
        Criterion::Regular => {
            each(segment, |piece| match Hodograph::of(&piece.tangent()).stops_at() {
                Some(at) => Sign::Fails { at },
                None => Sign::Positive,
            })
        }
    }
}

fn each(segment: &Segment, sign: impl Fn(&Piece) -> Sign) -> Sign {
    segment.pieces.iter().fold(Sign::Positive, |known, piece| match known {
        Sign::Fails { .. } => known,
        _ => known.and(sign(piece).on(piece.local[0], piece.local[1])),
    })
}

/// `ω·n > 0`, and no corner between pieces that turns the other way.
pub(crate) fn turns(segment: &Segment, n: DVec3) -> Sign {
    let smooth = each(segment, |piece| piece.omega().map(1.0, |w| w.dot(n)).sign());
    corners(segment).fold(smooth, |known, (at, turn, error)| {
        if turn.dot(n) < -error { known.and(Sign::Fails { at }) } else { known }
    })
}

/// `((γ(t) − γ(0))×γ'(t))·n > 0` and `(γ'(0)×(γ(t) − γ(0)))·n > 0` for `t > 0`. On the first piece
/// both have a double root at `t = 0`, which is divided out.
fn sees_its_start(segment: &Segment, n: DVec3) -> Sign {
    let Some(first) = segment.pieces.first() else { return Sign::Positive };
    let start = first.velocity().ends()[0];
    each(segment, |piece| {
        let (a, velocity) = (piece.position(), piece.velocity());
        let inner = a.product(velocity, |a, v| a.cross(v).dot(n));
        let outer = a.map(start.length(), |a| start.cross(a).dot(n));
        if piece.local[0] > 0.0 {
            inner.sign().and(outer.sign())
        } else {
            let reduced = |p: &Polynomial<f64>| p.divided_by_t().divided_by_t().sign();
            reduced(&inner).and(reduced(&outer))
        }
    })
}

fn cones(
    segment: &Segment,
    question: &Question,
    vector: impl Fn(&Piece) -> Polynomial<DVec3>,
) -> Sign {
    let within = |([from, to], axis, epsilon): ([f64; 2], DVec3, f64)| {
        let part = segment.part(from, to);
        match side(&part, &vector, axis) {
            Err(at) => Sign::Fails { at },
            Ok(side) => each(&part, |piece| {
                let v = vector(piece);
                inside(&v, &v.map(1.0, |v| side * v.dot(axis)), axis, epsilon)
            }),
        }
    };
    question.cone_parts().into_iter().map(within).fold(Sign::Positive, Sign::and)
}

/// On which side of the plane of right angles to the axis the ends of the pieces are, or where they
/// change sides.
fn side(
    part: &Segment,
    vector: &impl Fn(&Piece) -> Polynomial<DVec3>,
    axis: DVec3,
) -> Result<f64, f64> {
    let mut side = 0.0;
    for piece in &part.pieces {
        let along = vector(piece).map(1.0, |v| v.dot(axis));
        for (x, at) in along.ends().into_iter().zip(piece.local) {
            if x.abs() > along.error() {
                if side * x < 0.0 {
                    return Err(at);
                }
                side = x.signum();
            }
        }
    }
    Ok(if side == 0.0 { 1.0 } else { side })
}

/// Whether `v` stays inside the cone: on its side of the axis, and `ε²(v·n)² > (1−ε²)‖v×n‖²`.
fn inside(v: &Polynomial<DVec3>, along: &Polynomial<f64>, axis: DVec3, epsilon: f64) -> Sign {
    match along.sign() {
        Sign::Positive => {}
        other => return other,
    }
    depth(v, along, axis, epsilon).sign()
}

/// `ε²(v·n)² − (1−ε²)‖v×n‖²`.
fn depth(
    v: &Polynomial<DVec3>,
    along: &Polynomial<f64>,
    axis: DVec3,
    epsilon: f64,
) -> Polynomial<f64> {
    let across = v.map(1.0, |v| v.cross(axis));
    let square = along.product(along, |a, b| a * b);
    let outside = across.product(&across, DVec3::dot);
    let factor = (1.0 - epsilon) * (1.0 + epsilon);
    square.map(epsilon * epsilon, |x| epsilon * epsilon * x).plus(&outside, -factor)
}

/// Whether `ω` is nowhere outside the double cone: it may lie in the boundary, vanish, and pass from
/// one half to the other.
pub(crate) fn is_never_outside(segment: &Segment, axis: DVec3, epsilon: f64) -> bool {
    segment.pieces.iter().all(|piece| {
        let omega = piece.omega();
        let depth = depth(&omega, &omega.map(1.0, |w| w.dot(axis)), axis, epsilon);
        !depth.signs().0.contains(&false)
    })
}
