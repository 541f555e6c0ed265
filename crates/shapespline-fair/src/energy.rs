// SPDX-License-Identifier: MIT OR Apache-2.0

//! The energies of a segment, with gradient and Hessian with respect to its scaled legs.
//!
//! `parametric`: `∫|Q''|²du`, a quadratic form, exactly. `bending`:
//! `∫κ²ds + 0.3 ∫|Q''|²du + ∫(Q'·Q''/|Q'|²)²du` by Gauss quadrature; the last term is infinite at a cusp,
//! and the second keeps the curve from bulging at sharp turns. With `v = Q'`, `a = Q''`, `s = v·v`,
//! `p = v·a`, `q = a·a` the integrand is `(s q − p²) s^(−5/2) + p² s^(−2)`, whose derivatives are written
//! out below.

use glam::{DMat3, DVec3};

use crate::{
    element::{A, Legs, Span, T, TAU},
    legs::{LegTerms, outer},
};

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Energy {
    /// `∫|Q''|²du`: the plain C² cubic wherever that keeps the shape. Where a mended stretch nearly stops,
    /// [`Energy::Bending`] all the same: `∫|Q''|²du` does not see how the curve bends there.
    #[default]
    Parametric,
    /// `∫κ²ds`, with small terms that keep cusps and bulges out: the fairer curve where chords are
    /// uneven.
    Bending,
}

/// Share of `∫|Q''|²du` in the bending energy.
const PARAMETRIC_SHARE: f64 = 0.3;

/// `∫|Q''|²du = (speed²/h) dᵀFd` over the legs.
const FORM: [[f64; 5]; 5] = parametric_form();

const fn parametric_form() -> [[f64; 5]; 5] {
    // h Q'' at the four breaks as differences of legs.
    let rows = [
        [-2.0 / TAU, 2.0 / TAU, 0.0, 0.0, 0.0],
        [0.0, -2.0 / T, 2.0 / T, 0.0, 0.0],
        [0.0, 0.0, -2.0 / T, 2.0 / T, 0.0],
        [0.0, 0.0, 0.0, -2.0 / TAU, 2.0 / TAU],
    ];
    let shares = [TAU, 1.0 - 2.0 * TAU, TAU];
    let mut form = [[0.0; 5]; 5];
    let mut piece = 0;
    while piece < 3 {
        let (x, y, w) = (rows[piece], rows[piece + 1], shares[piece] / 3.0);
        let mut i = 0;
        while i < 5 {
            let mut j = 0;
            while j < 5 {
                let mixed = 0.5 * (x[i] * y[j] + y[i] * x[j]);
                form[i][j] += w * (x[i] * x[j] + mixed + y[i] * y[j]);
                j += 1;
            }
            i += 1;
        }
        piece += 1;
    }
    form
}

/// `∫|Q''|²du` of a segment.
pub(crate) fn parametric(span: &Span, d: &Legs) -> f64 {
    let unit = span.speed() * span.speed() / span.spacing;
    let mut sum = 0.0;
    for i in 0..5 {
        sum += FORM[i][i] * d[i].length_squared();
        for j in 0..i {
            sum += 2.0 * FORM[i][j] * d[i].dot(d[j]);
        }
    }
    unit * sum
}

/// Adds gradient and Hessian of `weight ∫|Q''|²du`.
fn add_parametric(span: &Span, d: &Legs, weight: f64, terms: &mut LegTerms) {
    let unit = 2.0 * weight * span.speed() * span.speed() / span.spacing;
    for i in 0..5 {
        let row = FORM[i].iter().zip(d).fold(DVec3::ZERO, |sum, (&c, &d)| sum + d * c);
        terms.gradient[i] += row * unit;
        for j in i..5 {
            terms.hessian[i][j] += DMat3::from_diagonal(DVec3::splat(unit * FORM[i][j]));
        }
    }
}

/// A quadrature point: the first of the three legs it depends on, their factors in `Q'` and `h Q''`, and
/// its weight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gauss {
    first: usize,
    velocity: [f64; 3],
    acceleration: [f64; 3],
    weight: f64,
}

/// Positive abscissae and weights of the Gauss–Legendre rule with 8 points on `[−1, 1]`.
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// The rule on a segment: eight points on each piece, and on halves of it where the speed falls so low
/// that the curve turns in a smaller part: a rule that misses a cusp sees a small energy.
pub(crate) fn rule(d: &Legs) -> Vec<Gauss> {
    let mut points = Vec::with_capacity(24);
    for piece in 0..3 {
        divide(d, piece, [0.0, 1.0], DEPTH, &mut points);
    }
    points
}

/// Halvings of a piece: a dip of the speed to 1e−5 is seen.
const DEPTH: usize = 16;
/// An interval is halved where the speed at its ends or in its middle is below this share of how much
/// `Q'` changes on it.
const DIP: f64 = 0.3;

fn divide(d: &Legs, piece: usize, [from, to]: [f64; 2], depth: usize, points: &mut Vec<Gauss>) {
    let shares = [TAU, 1.0 - 2.0 * TAU, TAU];
    let width = to - from;
    let jets = [from, 0.5 * (from + to), to].map(|y| point(piece, y, 0.0).jet(d));
    let slowest = jets.iter().fold(f64::INFINITY, |m, jet| m.min(jet[0].length_squared()));
    let change = jets.iter().fold(0.0f64, |m, jet| m.max(jet[1].length_squared()));
    let change = change * (width * shares[piece]).powi(2);
    if depth > 0 && slowest < DIP * DIP * change {
        let middle = 0.5 * (from + to);
        divide(d, piece, [from, middle], depth - 1, points);
        divide(d, piece, [middle, to], depth - 1, points);
        return;
    }
    for (x, w) in RULE.iter().flat_map(|&(x, w)| [(-x, w), (x, w)]) {
        let y = from + 0.5 * (1.0 + x) * width;
        points.push(point(piece, y, 0.5 * w * width * shares[piece]));
    }
}

fn point(piece: usize, y: f64, weight: f64) -> Gauss {
    let z = 1.0 - y;
    let [b0, b1, b2] = [z * z, 2.0 * y * z, y * y];
    let (velocity, acceleration) = match piece {
        0 => (
            [b0, b1 + (1.0 - A) * b2, A * b2],
            [-2.0 / TAU * z, 2.0 / TAU * z - 2.0 / T * y, 2.0 / T * y],
        ),
        1 => (
            [(1.0 - A) * b0, A * b0 + b1 + A * b2, (1.0 - A) * b2],
            [-2.0 / T * z, 2.0 / T * (z - y), 2.0 / T * y],
        ),
        _ => (
            [A * b0, (1.0 - A) * b0 + b1, b2],
            [-2.0 / T * z, 2.0 / T * z - 2.0 / TAU * y, 2.0 / TAU * y],
        ),
    };
    Gauss { first: piece, velocity, acceleration, weight }
}

impl Gauss {
    #[inline(always)]
    fn jet(&self, d: &Legs) -> [DVec3; 2] {
        let near = &d[self.first..self.first + 3];
        let sum = |c: &[f64; 3]| near[0] * c[0] + near[1] * c[1] + near[2] * c[2];
        [sum(&self.velocity), sum(&self.acceleration)]
    }
}

/// `∫κ²ds` and `∫(Q'·Q''/|Q'|²)²du` of a segment.
pub(crate) fn curvature_and_speed(span: &Span, d: &Legs, rule: &[Gauss]) -> [f64; 2] {
    let (mut curvature, mut speed) = (0.0, 0.0);
    for gauss in rule {
        let [v, a] = gauss.jet(d);
        let (s, p) = (v.length_squared(), v.dot(a));
        curvature += gauss.weight * v.cross(a).length_squared() / (s * s * s.sqrt());
        speed += gauss.weight * (p * p) / (s * s);
    }
    [curvature / span.length, speed / span.spacing]
}

/// The objective on a segment.
pub(crate) fn value(energy: Energy, span: &Span, d: &Legs, rule: &[Gauss]) -> f64 {
    match energy {
        Energy::Parametric => parametric(span, d),
        Energy::Bending => {
            let [curvature, speed] = curvature_and_speed(span, d, rule);
            curvature + PARAMETRIC_SHARE * parametric(span, d) + speed
        }
    }
}

/// Adds gradient and Hessian of the objective.
pub(crate) fn add(energy: Energy, span: &Span, d: &Legs, rule: &[Gauss], terms: &mut LegTerms) {
    match energy {
        Energy::Parametric => add_parametric(span, d, 1.0, terms),
        Energy::Bending => {
            add_parametric(span, d, PARAMETRIC_SHARE, terms);
            let units = [1.0 / span.length, 1.0 / span.spacing];
            for gauss in rule {
                add_point(gauss, d, units, terms);
            }
        }
    }
}

/// Adds gradient and Hessian of the integrand at one point.
#[inline(always)]
fn add_point(gauss: &Gauss, d: &Legs, [bend, stretch]: [f64; 2], terms: &mut LegTerms) {
    let [v, a] = gauss.jet(d);
    let (s, p, q) = (v.length_squared(), v.dot(a), a.length_squared());
    let (bend, stretch) = (gauss.weight * bend, gauss.weight * stretch);
    let i = 1.0 / s;
    let (i2, root) = (i * i, i.sqrt());
    let (i3, i4) = (i2 * i, i2 * i2);
    let (r3, r5) = (i * root, i2 * root);
    let (r7, r9) = (r5 * i, r5 * i2);
    let pp = p * p;
    // f(s, p, q) = bend (q s^(−3/2) − p² s^(−5/2)) + stretch p² s^(−2).
    let fs = bend * (-1.5 * q * r5 + 2.5 * pp * r7) - 2.0 * stretch * pp * i3;
    let fp = -2.0 * bend * p * r5 + 2.0 * stretch * p * i2;
    let fq = bend * r3;
    let fss = bend * (3.75 * q * r7 - 8.75 * pp * r9) + 6.0 * stretch * pp * i4;
    let fsp = 5.0 * bend * p * r7 - 4.0 * stretch * p * i3;
    let fsq = -1.5 * bend * r5;
    let fpp = -2.0 * bend * r5 + 2.0 * stretch * i2;
    // ∇s = (2v, 0), ∇p = (a, v), ∇q = (0, 2a).
    let gv = v * (2.0 * fs) + a * fp;
    let ga = v * fp + a * (2.0 * fq);
    let vv = outer(v, v);
    let va = outer(v, a);
    let aa = outer(a, a);
    let identity = DMat3::IDENTITY;
    let hvv =
        vv * (4.0 * fss) + (va + va.transpose()) * (2.0 * fsp) + aa * fpp + identity * (2.0 * fs);
    let hva = vv * (2.0 * fsp) + va * (4.0 * fsq) + va.transpose() * fpp + identity * fp;
    let haa = vv * fpp + identity * (2.0 * fq);
    for (k, (&b, &c)) in gauss.velocity.iter().zip(&gauss.acceleration).enumerate() {
        let row = gauss.first + k;
        terms.gradient[row] += gv * b + ga * c;
        // Rows of the Hessian against v and a; then against the legs.
        let [to_v, to_a] = [hvv * b + hva.transpose() * c, hva * b + haa * c];
        for l in k..3 {
            terms.hessian[row][gauss.first + l] +=
                to_v * gauss.velocity[l] + to_a * gauss.acceleration[l];
        }
    }
}

/// `∫κ²ds` of a segment, each piece divided where it needs it.
pub(crate) fn bending(span: &Span, d: &Legs) -> f64 {
    curvature_and_speed(span, d, &rule(d))[0]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from)
    }

    /// Legs that go forward: no cusp.
    fn legs() -> impl Strategy<Value = Legs> {
        proptest::array::uniform5(vector()).prop_map(|legs| legs.map(|d| d * 0.6 + DVec3::X))
    }

    const SPAN: Span = Span { direction: DVec3::X, length: 1.3, spacing: 0.7 };

    proptest! {
        #[test]
        fn the_parametric_energy_is_that_of_dense_sampling(d in legs()) {
            let speed = SPAN.speed();
            let mut sum = 0.0;
            for gauss in rule(&d) {
                let [_, a] = gauss.jet(&d);
                sum += gauss.weight * a.length_squared();
            }
            let sampled = sum * speed * speed / SPAN.spacing;
            prop_assert!((parametric(&SPAN, &d) - sampled).abs() < 1e-11 * sampled);
        }

        #[test]
        fn gradient_and_hessian_are_those_of_finite_differences(d in legs(), e in legs()) {
            for energy in [Energy::Parametric, Energy::Bending] {
                let rule = rule(&d);
                let at = |h: f64| {
                    let moved: Legs = std::array::from_fn(|k| d[k] + (e[k] - DVec3::X) * h);
                    let mut terms = LegTerms::zero();
                    add(energy, &SPAN, &moved, &rule, &mut terms);
                    let slope: f64 =
                        (0..5).map(|k| terms.gradient[k].dot(e[k] - DVec3::X)).sum();
                    (value(energy, &SPAN, &moved, &rule), slope, terms)
                };
                let h = 1e-5;
                let (low, high, here) = (at(-h), at(h), at(0.0));
                let slope = (high.0 - low.0) / (2.0 * h);
                prop_assert!((slope - here.1).abs() < 1e-6 * (1.0 + slope.abs()), "{energy:?}");
                let mut curvature = 0.0;
                for i in 0..5 {
                    for j in 0..5 {
                        let block = if i <= j {
                            here.2.hessian[i][j]
                        } else {
                            here.2.hessian[j][i].transpose()
                        };
                        curvature += (e[i] - DVec3::X).dot(block * (e[j] - DVec3::X));
                    }
                }
                let expected = (high.1 - low.1) / (2.0 * h);
                let size = 1.0 + expected.abs();
                prop_assert!((curvature - expected).abs() < 1e-5 * size, "{energy:?}");
            }
        }
    }

    /// A circle's bending energy is its length over the square of the radius.
    #[test]
    fn a_circular_arc_bends_as_it_should() {
        let angle = 0.4f64;
        // Hermite ends of an arc of the unit circle, run through at speed one, in the plane of x and y.
        let q = [DVec3::Y, DVec3::new(-angle.sin(), angle.cos(), 0.0)];
        let r = [-DVec3::X, -DVec3::new(angle.cos(), angle.sin(), 0.0)];
        let chord = -r[1] + r[0];
        let span = Span { direction: chord.normalize(), length: chord.length(), spacing: angle };
        let node = |k: usize| crate::element::Node { q: q[k], r: r[k] };
        let legs = span.legs(node(0), node(1));
        assert!((bending(&span, &legs) - angle).abs() < 1e-5);
        assert!((parametric(&span, &legs) - angle).abs() < 1e-4);
    }

    /// The rule closes in on a cusp: legs that turn back leave the energy large, wherever they do.
    #[test]
    fn a_cusp_is_not_missed() {
        for k in 0..50 {
            let shift = 0.3 * (f64::from(k) * 0.37).sin();
            let tiny = DVec3::Y * 1e-3;
            let d =
                [1.0, 0.4 + shift, 0.1 - shift, -0.6, -1.0].map(|x| DVec3::X * x + tiny * x * x);
            assert!(bending(&SPAN, &d) > 1e4, "{k}: {}", bending(&SPAN, &d));
        }
    }
}
