// SPDX-License-Identifier: MIT OR Apache-2.0

#![allow(clippy::unwrap_used)]
use super::*;

mod convex;
mod convex_optimal;

const RPN14: [[f64; 9]; 2] = [
    [7.99, 8.09, 8.19, 8.7, 9.2, 10.0, 12.0, 15.0, 20.0],
    [0.0, 2.76429e-5, 4.37498e-2, 0.169183, 0.469428, 0.943740, 0.998636, 0.999919, 0.999994],
];
const AKIMA: [[f64; 11]; 2] = [
    [0.0, 2.0, 3.0, 5.0, 6.0, 8.0, 9.0, 11.0, 12.0, 14.0, 15.0],
    [10.0, 10.0, 10.0, 10.0, 10.0, 10.0, 10.5, 15.0, 50.0, 60.0, 85.0],
];

fn natural(layer: f64) -> CubicOptions {
    CubicOptions { ends: Ends::Natural, layer, ..CubicOptions::default() }
}

fn close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b}");
}

/// The numbers of the specification, from a program of another kind.
#[test]
fn reference_energies_and_slopes() {
    let of =
        |[x, y]: [&[f64]; 2], options: &CubicOptions| MonotoneCubic::new(x, y, options).unwrap();
    let rpn = of([&RPN14[0], &RPN14[1]], &natural(0.0));
    close(rpn.bending_energy(), 7.62754872424, 1e-11);
    assert_eq!(rpn.level_pieces(), [0, 5, 7]);
    let slopes = [
        0.0,
        0.02392490796172,
        0.5735819367422,
        0.3076157303819,
        0.7441100641727,
        0.2994644976907,
        1.210512607148e-7,
        2.441252436826e-4,
        0.0,
    ];
    for (a, b) in rpn.slopes().into_iter().zip(slopes) {
        close(a, b, 1e-9);
    }
    close(of([&RPN14[0], &RPN14[1]], &natural(1.0 / 16.0)).bending_energy(), 7.62754872424, 1e-11);
    close(
        of([&RPN14[0], &RPN14[1]], &CubicOptions::default()).bending_energy(),
        7.62754873812,
        1e-11,
    );
    let akima = of([&AKIMA[0], &AKIMA[1]], &natural(0.0));
    close(akima.bending_energy(), 4375.09433012, 1e-11);
    assert_eq!(akima.level_pieces(), [6, 8]);
    close(of([&AKIMA[0], &AKIMA[1]], &natural(1.0 / 16.0)).bending_energy(), 4375.28451406, 1e-11);
    let estimated = CubicOptions { layer: 0.0, ..CubicOptions::default() };
    close(of([&AKIMA[0], &AKIMA[1]], &estimated).bending_energy(), 4902.06761682, 1e-11);
    for f in [rpn, akima] {
        let gap: f64 = f.interval_gaps().iter().sum();
        assert!(gap <= 1e-12 * f.bending_energy(), "gap {gap}");
        close(f.lower_bound(), f.bending_energy(), 1e-12);
    }
}
