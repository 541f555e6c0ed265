// SPDX-License-Identifier: MIT OR Apache-2.0

//! Every refusal names the argument, the index and the value.
#![allow(clippy::unwrap_used)]

use shapespline_monotone::*;

fn quartic(x: &[f64], y: &[f64]) -> String {
    MonotoneQuartic::new(x, y, &QuarticOptions::default()).unwrap_err().to_string()
}

fn quintic(x: &[f64], y: &[f64]) -> String {
    MonotoneQuintic::new(x, y, &QuinticOptions::default()).unwrap_err().to_string()
}

#[test]
fn data() {
    for (x, y, parts) in [
        (vec![0.0], vec![1.0], vec!["x has 1", "2 are needed"]),
        (vec![], vec![], vec!["x has 0"]),
        (vec![0.0, 1.0], vec![1.0], vec!["y has 1", "expected 2"]),
        (vec![0.0, f64::NAN, 2.0], vec![0.0; 3], vec!["x[1]", "NaN"]),
        (vec![0.0, 1.0, f64::INFINITY], vec![0.0; 3], vec!["x[2]", "inf"]),
        (vec![0.0, 1.0, 2.0], vec![0.0, 1.0, f64::NEG_INFINITY], vec!["y[2]", "-inf"]),
        (vec![0.0, 1.0, 1.0], vec![0.0; 3], vec!["x[2] = 1", "strictly increasing"]),
        (vec![0.0, 3.0, 2.0], vec![0.0; 3], vec!["x[2] = 2", "3"]),
        (vec![-1.5e308, 1.5e308], vec![0.0; 2], vec!["spread", "x[1]"]),
        (vec![0.0, 1.0], vec![-1.5e308, 1.5e308], vec!["spread", "y[1]"]),
    ] {
        for message in [quartic(&x, &y), quintic(&x, &y)] {
            for part in &parts {
                assert!(message.contains(part), "{message:?} lacks {part:?}");
            }
        }
    }
}

#[test]
fn options() {
    let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 3.0]);
    let with = |shape, slopes| {
        let options = QuarticOptions { shape, slopes, ..QuarticOptions::default() };
        MonotoneQuartic::new(&x, &y, &options).unwrap_err().to_string()
    };
    assert!(with(ShapeParameters::Uniform(-1.0), Slopes::FritschButland).contains("shape[0] = -1"));
    assert!(with(ShapeParameters::Uniform(f64::NAN), Slopes::FritschButland).contains("NaN"));
    let pair = ShapeParameters::Segments { alpha: vec![1.0, 2.0], beta: vec![1.0, -2.0] };
    assert!(with(pair, Slopes::FritschButland).contains("beta[1] = -2"));
    let pair = ShapeParameters::Segments { alpha: vec![1.0], beta: vec![1.0, 2.0] };
    assert!(with(pair, Slopes::FritschButland).contains("alpha has 1"));
    let optimal = with(ShapeParameters::default(), Slopes::Optimal);
    assert!(optimal.contains("optimal") && optimal.contains("fritsch-butland"), "{optimal}");
    let given = |slopes| {
        let options = QuinticOptions { slopes: Slopes::Given(slopes), ..QuinticOptions::default() };
        MonotoneQuintic::new(&x, &y, &options).unwrap_err().to_string()
    };
    assert!(given(vec![1.0]).contains("slopes has 1"));
    assert!(given(vec![1.0, f64::NAN, 1.0]).contains("slopes[1] is NaN"));
    assert!("x".parse::<Fairness>().unwrap_err().to_string().contains("bending, parametric"));
    assert!("x".parse::<Extrapolation>().unwrap_err().to_string().contains("linear"));
    assert_eq!("clip".parse::<Extrapolation>().unwrap(), Extrapolation::CLIP);
    assert_eq!("parametric".parse::<Fairness>().unwrap(), Fairness::Parametric);
}

/// Slopes that no C² monotone quintic has are refused by name, or limited and reported.
#[test]
fn impossible_slopes_are_refused_or_limited() {
    let (x, y) = ([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 3.0, 3.0]);
    let fit = |slopes: &[f64], clip| {
        let options =
            QuinticOptions { slopes: Slopes::Given(slopes.to_vec()), clip, ..Default::default() };
        MonotoneQuintic::new(&x, &y, &options)
    };
    for (slopes, index, rule) in [
        ([-1.0, 1.0, 0.0, 0.0], 0, "sign"),
        ([1.0, 50.0, 0.0, 0.0], 1, "leave room"),
        ([1.0, 1.0, 0.5, 0.0], 2, "flat"),
        ([1.0, 1.0, 0.0, 1.0], 3, "flat"),
    ] {
        let error = fit(&slopes, false).unwrap_err();
        assert!(
            matches!(error, MonotoneError::Slope { index: i, value, .. } if i == index && value == slopes[index])
        );
        assert!(
            error.to_string().contains(rule) && error.to_string().contains("clip=True"),
            "{error}"
        );
        let f = fit(&slopes, true).unwrap();
        let d = f.diagnostics();
        assert!(d.certified && d.converged && d.limited.contains(&index), "{d:?}");
        for (i, (ours, given)) in f.slopes().iter().zip(slopes).enumerate() {
            assert_eq!(*ours != given, d.limited.contains(&i), "{i}");
        }
    }
}
