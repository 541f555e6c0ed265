// SPDX-License-Identifier: MIT OR Apache-2.0

//! The conditions of a segment: each says that a polynomial in the legs is positive.
//!
//! | condition | polynomial | source |
//! |---|---|---|
//! | [`Kind::Omega`] | a Bernstein coefficient of `ω·n` on a piece | Karavelas–Kaklis 2000, Lemma 5.1 on each piece |
//! | [`Kind::Middle`] | `b + √(x y)`: Lemma 5.1's middle condition itself | |
//! | [`Kind::Turn`] | `ω·P` at a node | Manni, (i.3) |
//! | [`Kind::Between`] | `(Q'×L)·P`: the tangent lies between the chords | Gautam, (12.1) |
//! | [`Kind::Twist`] | `±det(d_j, d_{j+1}, d_{j+2})`: the torsion of piece `j` | Karavelas–Kaklis, (4.16) |
//! | [`Kind::Forward`] | `d·u − v`: no loop, no cusp | ours |
//! | [`Kind::Near`] | `1 − ‖v‖²/δ²`, `v` from the nearest place on the chord to a control point | ours |
//! | [`Kind::Plane`], [`Kind::Line`] | `k²(w·n)² − ‖w×n‖²` of a Bernstein coefficient of `ω` or `Q'` | (5.10), (5.22) there |
//! | [`Kind::Side`] | a coefficient of `ω·n` on a part of a piece | |
//!
//! A change of sign (inflection) is asked for in one piece, the same along both normals: a quadratic
//! that goes from + to − has one root there, whatever the mixture of normals (Gautam, Theorems
//! 13.6–13.11). In the other pieces each normal keeps its sign: sufficient, not necessary.
//!
//! Factors bring each condition to a natural size near one: the sine of the turn for `ω`, a tenth of the
//! chords' determinant for torsion (with lengths of chords and speeds one).

use glam::DVec3;
use shapespline_criteria::Criterion;

use crate::{
    element::{Legs, T, TAU, products},
    segment::{Bend, Segment},
};

/// What a condition asks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// Coefficient `0, 1, 2` of `ω·n` on a piece.
    Omega { piece: u8, coefficient: u8, normal: u8 },
    /// The middle coefficient and the root of the outer two, with the same sign.
    Middle { piece: u8, normal: u8 },
    /// The determinant of the legs of a piece.
    Twist { piece: u8 },
    /// `ω·P` at a node, along its own binormal or that of the other node.
    Turn { end: u8, normal: u8 },
    /// The end tangent on its own side of the chord.
    Between { end: u8 },
    /// A leg along its forward direction.
    Forward { leg: u8 },
    /// A control point, `1` to `4`, near the chord.
    Near { point: u8 },
    /// A Bernstein coefficient of `ω·n` on a part of a piece, as a mixture of those of the piece.
    Side { piece: u8, normal: u8, mixture: [f64; 3] },
    /// A Bernstein coefficient of `ω` on a part of a piece.
    Plane { piece: u8, normal: u8, mixture: [f64; 3] },
    /// A Bernstein coefficient of `Q'` on a part of a piece.
    Line { piece: u8, end: u8, mixture: [f64; 3] },
}

impl Kind {
    /// The criterion that a condition belongs to; going forward belongs to none.
    pub(crate) fn criterion(self, bend: Bend) -> Option<Criterion> {
        match self {
            Self::Omega { .. } | Self::Middle { .. } => Some(match bend {
                Bend::Inflecting => Criterion::Inflection,
                Bend::Free | Bend::Convex => Criterion::Convexity,
            }),
            Self::Twist { .. } => Some(Criterion::Torsion),
            Self::Plane { .. } | Self::Side { .. } => Some(Criterion::Coplanarity),
            Self::Line { .. } => Some(Criterion::Collinearity),
            Self::Turn { .. } | Self::Between { .. } => Some(Criterion::Turning),
            Self::Forward { .. } | Self::Near { .. } => None,
        }
    }
}

/// A condition, with the factor that gives it a natural size near one and the sign asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) kind: Kind,
    pub(crate) factor: f64,
}

/// What all segments have in common.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Tangents of the half angles of the cones around planes and lines.
    pub(crate) cones: [f64; 2],
    /// Whether middle coefficients may be negative as far as the outer two allow.
    pub(crate) exact_middles: bool,
}

/// The signs of `ω` at the four breaks: all +, or those of an inflection in piece 0, 1, 2.
fn signs(bend: Bend, change: usize) -> [f64; 4] {
    match (bend, change) {
        (Bend::Free | Bend::Convex, _) => [1.0; 4],
        (Bend::Inflecting, 0) => [1.0, -1.0, -1.0, -1.0],
        (Bend::Inflecting, 1) => [1.0, 1.0, -1.0, -1.0],
        (Bend::Inflecting, _) => [1.0, 1.0, 1.0, -1.0],
    }
}

/// The piece in which an inflecting segment had best change sign: the one whose signs fit `ω` at the
/// breaks best.
pub(crate) fn best_change(segment: &Segment, d: &Legs) -> usize {
    if segment.bend != Bend::Inflecting {
        return 0;
    }
    let p = products(d);
    // ω at the breaks, up to the sizes that the scores divide out.
    let breaks = [p[0] / TAU, p[2] / T, p[4] / T, p[6] / TAU];
    let mut scores = [0.0; 3];
    for n in segment.normals {
        let x = breaks.map(|w| w.dot(n));
        let largest = x.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        for (change, score) in scores.iter_mut().enumerate() {
            let signs = signs(Bend::Inflecting, change);
            *score += x.iter().zip(signs).map(|(x, s)| s * x).sum::<f64>() / largest;
        }
    }
    // The middle piece where it is a tie.
    let mut best = 1;
    for change in [0, 2] {
        // Where ω begins with zero it has to leave it on its own side.
        if scores[change] > scores[best] && !segment.straight[change / 2] {
            best = change;
        }
    }
    best
}

/// The conditions of a segment, whose inflection, if it has one, lies in piece `change`.
pub(crate) fn rows(segment: &Segment, change: usize, rules: &Rules, out: &mut Vec<Row>) {
    let normals = if segment.planar { 1 } else { 2 };
    if segment.bend != Bend::Free {
        let signs = signs(segment.bend, change);
        let least = segment.sines[0].min(segment.sines[1]);
        let sizes = [segment.sines[0], least, least, segment.sines[1]];
        for normal in 0..normals {
            let ends = [segment.straight[0], false, false, segment.straight[1]];
            let breaks = signs.into_iter().zip(sizes).enumerate();
            for (at, (sign, size)) in breaks.filter(|&(at, _)| !ends[at]) {
                let (piece, coefficient) = if at < 3 { (at as u8, 0) } else { (2, 2) };
                let kind = Kind::Omega { piece, coefficient, normal };
                out.push(Row { kind, factor: sign / size });
            }
            for piece in 0..3 {
                if signs[piece] == signs[piece + 1] {
                    let exact = rules.exact_middles && !ends[piece] && !ends[piece + 1];
                    let kind = if exact {
                        Kind::Middle { piece: piece as u8, normal }
                    } else {
                        Kind::Omega { piece: piece as u8, coefficient: 1, normal }
                    };
                    out.push(Row { kind, factor: signs[piece] / least });
                }
            }
        }
    }
    for end in 0..2u8 {
        let at = end as usize;
        if segment.turns[at] {
            if segment.bend == Bend::Free && !segment.straight[at] {
                // Neither convexity nor inflection says how the curve turns here.
                let kind = Kind::Turn { end, normal: end };
                out.push(Row { kind, factor: 1.0 / segment.sines[at] });
                if segment.pair != 0.0 {
                    let kind = Kind::Turn { end, normal: 1 - end };
                    out.push(Row { kind, factor: segment.pair / segment.sines[at] });
                }
            }
            out.push(Row { kind: Kind::Between { end }, factor: 2.0 / segment.sines[at] });
        }
    }
    if segment.torsion != 0.0 {
        let unit = segment.torsion / (0.1 * segment.gamma.abs());
        let flat = [segment.straight[0], false, segment.straight[1]];
        let sizes = [1.5 * TAU, 3.0 / (T * T), 1.5 * TAU];
        for (piece, size) in sizes.into_iter().enumerate().filter(|&(piece, _)| !flat[piece]) {
            let kind = Kind::Twist { piece: piece as u8 };
            out.push(Row { kind, factor: unit / size });
        }
    }
    let forward = [0, 0, 2, 1, 1];
    for leg in 0..5u8 {
        let end = forward[leg as usize];
        if leg == 2 || segment.bisectors[end] != DVec3::ZERO {
            out.push(Row { kind: Kind::Forward { leg }, factor: 1.0 });
        }
    }
    if let Some(deviation) = segment.deviation {
        for point in 1..=4u8 {
            out.push(Row { kind: Kind::Near { point }, factor: deviation.min(1.0) });
        }
    }
    cones(segment, rules, out);
}

/// The conditions of coplanarity and collinearity.
fn cones(segment: &Segment, rules: &Rules, out: &mut Vec<Row>) {
    if let Some([left, right]) = segment.plane {
        let size = rules.cones[0] * segment.sines[0].max(segment.sines[1]);
        let factor = 1.0 / (size * size);
        let ranges: &[[f64; 2]] =
            if left >= right { &[[0.0, 1.0]] } else { &[[0.0, left], [right, 1.0]] };
        for (part, &range) in ranges.iter().enumerate() {
            let vanishes = |&(piece, mixture): &(u8, [f64; 3])| {
                (segment.straight[0] && piece == 0 && mixture == [1.0, 0.0, 0.0])
                    || (segment.straight[1] && piece == 2 && mixture == [0.0, 0.0, 1.0])
            };
            for (piece, mixture) in mixtures(range).into_iter().filter(|c| !vanishes(c)) {
                for normal in 0..2 {
                    out.push(Row { kind: Kind::Plane { piece, normal, mixture }, factor });
                    if ranges.len() == 2 {
                        // Each part lies on its own side: convexity does not say so here.
                        let least = segment.sines[0].min(segment.sines[1]);
                        let factor = if part == 0 { 1.0 / least } else { -1.0 / least };
                        out.push(Row { kind: Kind::Side { piece, normal, mixture }, factor });
                    }
                }
            }
        }
    }
    for end in 0..2u8 {
        if segment.line[end as usize] {
            let factor = 1.0 / (rules.cones[1] * rules.cones[1]);
            let range = if end == 0 { [0.0, 0.5] } else { [0.5, 1.0] };
            for (piece, mixture) in mixtures(range) {
                out.push(Row { kind: Kind::Line { piece, end, mixture }, factor });
            }
        }
    }
}

/// The Bernstein coefficients of a quadratic on a part of the segment, as mixtures of those of its
/// pieces; a coefficient that two pieces share is named once.
fn mixtures([from, to]: [f64; 2]) -> Vec<(u8, [f64; 3])> {
    let breaks = [0.0, TAU, T, 1.0];
    let mut all = Vec::new();
    for piece in 0..3 {
        let (start, end) = (breaks[piece], breaks[piece + 1]);
        let (low, high) = (from.max(start), to.min(end));
        if high - low < 1e-6 {
            continue;
        }
        let [s, t] = [low, high].map(|x| (x - start) / (end - start));
        let blossom =
            |x: f64, y: f64| [(1.0 - x) * (1.0 - y), (1.0 - x) * y + x * (1.0 - y), x * y];
        let shared = !all.is_empty();
        for (k, (x, y)) in [(s, s), (s, t), (t, t)].into_iter().enumerate() {
            if k > 0 || !shared {
                all.push((piece as u8, blossom(x, y)));
            }
        }
    }
    all
}
