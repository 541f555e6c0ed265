// SPDX-License-Identifier: MIT OR Apache-2.0

//! Prints how far each handle of a uniform Catmull–Rom curve had to be shortened, and what the full
//! ones would have violated.
//!
//! ```sh
//! cargo run --release -p shapespline-catmull-rom --example handles
//! ```

use shapespline_catmull_rom::{
    CatmullRom, Continuity, FitError, HandleOptions, Interpolant, Tension,
};
use shapespline_geometry::{Boundary, DVec3, DataPolygon, Parametrization};

fn main() -> Result<(), FitError> {
    let at = |k: i32| {
        let t = f64::from(k);
        DVec3::new(t, (t * t * 0.3).sin(), 0.2 * t * (0.5 * t).cos())
    };
    let points = (0..12).map(at).collect();
    let polygon = DataPolygon::new(points, &Parametrization::Uniform, Boundary::ZeroCurvature)?;
    let options = HandleOptions::default();
    let full = CatmullRom::new(polygon.clone(), Tension::Uniform(0.0), Continuity::C1)?;
    println!("full handles: {}", full.check(options.criteria, options.tolerances)?);
    let fit = CatmullRom::shape_preserving(polygon, &options)?;
    println!("shape-preserving: {}shortening {:.2?}", fit.report, fit.curve.tension());
    Ok(())
}
