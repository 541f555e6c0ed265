// SPDX-License-Identifier: MIT OR Apache-2.0

//! A smooth distribution function through empirical quantiles, its density, and its quantile function.
//!
//! `cargo run -p shapespline-monotone --example quantiles`

use shapespline_monotone::{Extrapolation, MonotoneError, MonotoneQuintic, QuinticOptions};

fn main() -> Result<(), MonotoneError> {
    // Waiting times in minutes and the share of people who had waited no longer.
    let x = [0.0, 1.0, 2.0, 3.5, 5.0, 8.0, 12.0, 20.0];
    let p = [0.0, 0.02, 0.11, 0.43, 0.71, 0.92, 0.985, 1.0];
    let options = QuinticOptions { extrapolate: Extrapolation::CLIP, ..QuinticOptions::default() };
    let cdf = MonotoneQuintic::new(&x, &p, &options)?;
    let density = cdf.derivative(1);
    println!(
        "bending energy {:.6}, certified {}",
        cdf.bending_energy(),
        cdf.diagnostics().certified
    );
    for share in [0.05, 0.25, 0.5, 0.75, 0.95] {
        let t = cdf.inverse(share)?;
        println!(
            "{:>4.0} % waited at most {t:.3} min; density there {:.4}",
            100.0 * share,
            density.evaluate(t, 0, None)
        );
    }
    let mean = 20.0 - cdf.integrate(0.0, 20.0, None);
    println!("mean waiting time {mean:.3} min");
    Ok(())
}
