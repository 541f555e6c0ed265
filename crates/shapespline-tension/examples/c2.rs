// SPDX-License-Identifier: MIT OR Apache-2.0

//! Shows that a tension cubic is C² where the ν-spline of the same image is not.
//!
//! ```sh
//! cargo run --release -p shapespline-tension --example c2
//! ```

use shapespline_geometry::{Boundary, Curve, DVec3, DataPolygon, Parametrization, Side};
use shapespline_tension::{FitError, Interpolant, TangentScale, TensionSpline};

fn main() -> Result<(), FitError> {
    let points = (0..8).map(|k| f64::from(k * k)).map(|x| DVec3::new(x, (x).sin(), x.sqrt()));
    let polygon =
        DataPolygon::new(points.collect(), &Parametrization::Chordal, Boundary::ZeroCurvature)?;
    let spline = TensionSpline::new(polygon, TangentScale::Uniform(0.3))?;
    let (curve, cubic) = (spline.curve(), spline.curve().cubic());
    println!("{:>8} {:>12} {:>12}", "knot", "jump of Q''", "jump of C''");
    for &u in &cubic.knots()[1..7] {
        let [q0, q1] = [Side::Left, Side::Right].map(|side| curve.evaluate(u, 2, side));
        let [c0, c1] = [Side::Left, Side::Right].map(|side| cubic.evaluate(u, 2, side));
        println!("{u:>8.3} {:>12.2e} {:>12.2e}", (q1 - q0).length(), (c1 - c0).length());
    }
    Ok(())
}
