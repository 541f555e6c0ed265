// SPDX-License-Identifier: MIT OR Apache-2.0

//! At every point the curve turns as the polygon does: Manni's (i.3) and Gautam's (12.1), computed here from
//! derivatives at the points, on both sides, without the criteria of the library.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code")]

use shapespline::prelude::*;
use shapespline_tests::{families::Family, generate::Random, scaled};

/// Sines and cosines up to this size are noise of unit chords.
const ZERO: f64 = 1e-9;

/// Products are wrong if they are negative beyond this part of their size.
const ROUNDING: f64 = 1e-11;

/// Polygons made of what leaves corners without a criterion of their own.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// Straight runs of one to four chords, which meet at any angle.
    Runs,
    /// Steps along the axes and diagonals of a lattice, of one to four cells.
    Lattice,
    /// Two to five directions and their opposites, chords of lengths that repeat.
    FewDirections,
}

impl Shape {
    fn steps(self, count: usize, planar: bool, random: &mut Random) -> Vec<DVec3> {
        let any = |random: &mut Random| {
            let v = random.vector();
            (if planar { DVec3::new(v.x, v.y, 0.0) } else { v }).normalize()
        };
        let lengths = [0.25, 0.5, 1.0, 2.0, 8.0];
        let directions: Vec<DVec3> = (0..2 + random.below(4)).map(|_| any(random)).collect();
        let mut steps = Vec::new();
        while steps.len() < count {
            match self {
                Self::Runs => {
                    let direction = any(random);
                    for _ in 0..1 + random.below(4) {
                        steps.push(direction * 10f64.powf(random.within(-1.0, 1.0)));
                    }
                }
                Self::Lattice => {
                    let mut cell = || random.below(3) as f64 - 1.0;
                    let step = DVec3::new(cell(), cell(), if planar { 0.0 } else { cell() });
                    let cells = 1.0 + random.below(4) as f64;
                    steps.extend((step != DVec3::ZERO).then_some(step * cells));
                }
                Self::FewDirections => {
                    let direction = directions[random.below(directions.len())];
                    let sign = if random.below(3) == 0 { -1.0 } else { 1.0 };
                    steps.push(direction * (sign * lengths[random.below(5)]));
                }
            }
        }
        steps.truncate(count);
        steps
    }
}

/// A polygon of every shape, dimension, boundary and parametrisation in turn.
fn polygon(case: usize, random: &mut Random) -> Option<DataPolygon> {
    let shape = [Shape::Runs, Shape::Lattice, Shape::FewDirections][case % 3];
    let planar = (case / 3).is_multiple_of(2);
    let mut points = vec![DVec3::ZERO];
    for step in shape.steps(3 + random.below(10), planar, random) {
        points.push(points[points.len() - 1] + step);
    }
    let mut tangent = || {
        let v = random.vector();
        if planar { DVec3::new(v.x, v.y, 0.0) } else { v }
    };
    let boundary = match case / 6 % 4 {
        0 => Boundary::ZeroCurvature,
        1 => Boundary::tangents(tangent(), tangent()),
        2 => Boundary::Circular,
        _ => {
            points.extend((points[points.len() - 1] != points[0]).then_some(points[0]));
            Boundary::Periodic
        }
    };
    let parametrizations =
        [Parametrization::Uniform, Parametrization::Chordal, Parametrization::Centripetal];
    let dimension = if planar { Dimension::Two } else { Dimension::Three };
    DataPolygon::with_dimension(points, dimension, &parametrizations[case / 24 % 3], boundary).ok()
}

/// What is asked at the points, and where the curve fails it: point, side, and which of the products.
fn wrong_turns(
    polygon: &DataPolygon,
    curve: &dyn Curve,
    asked: &mut usize,
) -> Vec<(usize, Side, &'static str, f64)> {
    let (n, u) = (polygon.segments(), polygon.parameters());
    let closed = polygon.is_closed();
    // Unit chords around, given end tangents in the place of missing ones; where there is nothing, none.
    let chord = |i: isize| -> Option<DVec3> {
        let last = n as isize - 1;
        let at = |i: isize| polygon.points()[i as usize + 1] - polygon.points()[i as usize];
        match (i, closed) {
            _ if (0..=last).contains(&i) => Some(at(i).normalize()),
            (_, true) => Some(at(i.rem_euclid(n as isize)).normalize()),
            (-1, _) => polygon.tangents()[0].map(DVec3::normalize),
            (i, _) if i == last + 1 => polygon.tangents()[1].map(DVec3::normalize),
            _ => None,
        }
    };
    let binormal = |i: isize| -> Option<DVec3> {
        let p = chord(i - 1)?.cross(chord(i)?);
        (p.length() > ZERO).then(|| p.normalize())
    };
    let mut wrong = Vec::new();
    for i in 0..=n {
        let node = i as isize;
        let Some(own) = binormal(node) else { continue };
        for side in [Side::Left, Side::Right] {
            let [d1, d2] = [1, 2].map(|order| curve.evaluate(u[i], order, side));
            let (bend, size) = (d1.cross(d2), d1.length() * d2.length());
            for j in [node - 1, node, node + 1] {
                let Some(n) = binormal(j) else { continue };
                let cosine = own.dot(n);
                if cosine.abs() > ZERO {
                    *asked += 1;
                    let product = bend.dot(n) * cosine.signum() / size;
                    if !(product > -ROUNDING) {
                        wrong.push((
                            i,
                            side,
                            ["before", "own", "after"][(j + 1 - node) as usize],
                            product,
                        ));
                    }
                }
            }
            if closed || (i > 0 && i < n) {
                let [before, after] = [chord(node - 1), chord(node)].map(Option::unwrap);
                for (turn, what) in [(before.cross(d1), "from"), (d1.cross(after), "to")] {
                    *asked += 1;
                    let product = turn.dot(own) / d1.length();
                    if !(product > -ROUNDING) {
                        wrong.push((i, side, what, product));
                    }
                }
            }
        }
    }
    wrong
}

#[test]
fn no_shape_preserving_curve_turns_the_wrong_way_at_a_point() {
    let (mut asked, mut fits, mut without) = (0, 0, 0);
    for case in 0..scaled(30_000) {
        let Some(polygon) = polygon(case, &mut Random::new(case as u64)) else { continue };
        for family in Family::DEFAULTS {
            let fit = family.fit(polygon.clone());
            let name = format!("{case} {family:?}: {:?}\n{}", fit.diagnostics(), fit.report);
            assert_eq!(fit.diagnostics().status, Status::Solved, "{name}");
            let wrong = wrong_turns(&polygon, fit.spline.curve(), &mut asked);
            assert!(wrong.is_empty(), "{name}: {wrong:?}\n{:?}", polygon.points());
            fits += 1;
        }
        // The other criteria alone do not see to it.
        let criteria = Criteria::OF_FITS.without(Criterion::Turning);
        let options = SearchOptions { criteria, ..SearchOptions::default() };
        let fit = NuSpline::shape_preserving(polygon.clone(), &options).unwrap();
        let wrong = wrong_turns(&polygon, fit.curve.curve(), &mut 0);
        without += usize::from(!wrong.is_empty());
    }
    println!("{fits} fits, {asked} products, {without} wrong without the criterion");
    assert!(asked > 20 * fits && without * 100 > fits / 4, "{fits} {asked} {without}");
}
