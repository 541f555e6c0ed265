// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long fits can be ended from outside.
#![allow(clippy::unwrap_used)]
use shapespline_monotone::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A long fit asks all along, with every choice of slopes, and ends when it is told to.
#[test]
fn long_fits_can_be_ended() {
    let n = 40_000;
    let x: Vec<f64> = (0..n).map(f64::from).collect();
    // Steps of all sizes: a least energy that has to be searched for everywhere.
    let step = |k: i32| f64::from(k * 7 % 31).powi(4) + 1e-3;
    let y: Vec<f64> =
        (0..n).scan(0.0, |y, k| Some(std::mem::replace(y, *y + step(k % 1000)))).collect();
    for slopes in [Slopes::FritschButland, Slopes::Given(vec![1.0; x.len()]), Slopes::Optimal] {
        let options = QuinticOptions { slopes, clip: true, ..QuinticOptions::default() };
        let asked = AtomicUsize::new(0);
        let fit = MonotoneQuintic::new_with(&x, &y, &options, &|| {
            asked.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        assert!(fit.is_ok());
        let asked = asked.into_inner();
        assert!(asked > 20, "{asked}");
        for end in [0, 1, 2, asked / 2, asked - 1] {
            let left = AtomicUsize::new(end);
            let fit = MonotoneQuintic::new_with(&x, &y, &options, &|| {
                let ended =
                    left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1));
                if ended.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            assert!(matches!(fit, Err(MonotoneError::Interrupted)), "{end} of {asked}");
        }
    }
}
