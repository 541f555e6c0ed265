// SPDX-License-Identifier: MIT OR Apache-2.0

#![allow(clippy::unwrap_used)]
use super::*;

/// A small deterministic generator: the crate has no use for a random-number dependency.
struct Lcg(u64);
impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

struct Planted {
    diagonal: Vec<f64>,
    off: Vec<f64>,
    linear: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    x: Vec<f64>,
}

/// A program with known solution and multipliers: choose x and the multipliers, then q = λ − A x.
fn planted(n: usize, dominance: f64, rng: &mut Lcg) -> Planted {
    let off: Vec<f64> =
        (1..n).map(|_| (rng.next() - 0.5) * 10f64.powf(6.0 * rng.next() - 3.0)).collect();
    let diagonal: Vec<f64> = (0..n)
        .map(|i| {
            let l = if i > 0 { off[i - 1].abs() } else { 0.0 };
            let r = if i + 1 < n { off[i].abs() } else { 0.0 };
            dominance * (l + r) + 1e-3
        })
        .collect();
    let x: Vec<f64> = (0..n).map(|_| (rng.next() - 0.5) * 10f64.powf(4.0 * rng.next())).collect();
    let (mut lower, mut upper, mut linear) = (vec![], vec![], vec![]);
    for i in 0..n {
        let (l, u, lambda) = match (rng.next() * 4.0) as usize {
            0 => (x[i], x[i] + 1.0, diagonal[i] * rng.next()),
            1 => (x[i] - 1.0, x[i], -diagonal[i] * rng.next()),
            2 => (x[i], x[i], diagonal[i] * (rng.next() - 0.5)),
            _ => (x[i] - 1.0, f64::INFINITY, 0.0),
        };
        let mut ax = diagonal[i] * x[i];
        if i > 0 {
            ax += off[i - 1] * x[i - 1];
        }
        if i + 1 < n {
            ax += off[i] * x[i + 1];
        }
        lower.push(l);
        upper.push(u);
        linear.push(lambda - ax);
    }
    Planted { diagonal, off, linear, lower, upper, x }
}

#[test]
fn planted_solutions_are_found() {
    let mut rng = Lcg(7);
    for case in 0..400 {
        let n = 1 + (rng.next() * 60.0) as usize;
        let dominance = [6.0, 2.0, 1.0][case % 3];
        let planted = planted(n, dominance, &mut rng);
        let program = TridiagonalBoxQp {
            diagonal: &planted.diagonal,
            off_diagonal: &planted.off,
            linear: &planted.linear,
            lower: &planted.lower,
            upper: &planted.upper,
        };
        for patience in [PATIENCE, 0] {
            let solution = solve_with_patience(&program, patience).unwrap();
            assert!(solution.solved, "case {case}");
            assert_eq!(solution.safeguards > 0, patience == 0, "case {case}");
            assert!(solution.kkt_residual < 1e-12, "case {case}: {:e}", solution.kkt_residual);
            let size = planted.x.iter().fold(1.0f64, |a, b| a.max(b.abs()));
            for (a, b) in solution.x.iter().zip(&planted.x) {
                assert!((a - b).abs() <= 1e-8 * size, "case {case} n {n}: {a} {b}");
            }
        }
    }
}

#[test]
fn large_programs_need_few_rounds() {
    let mut rng = Lcg(11);
    let planted = planted(100_000, 6.0, &mut rng);
    let program = TridiagonalBoxQp {
        diagonal: &planted.diagonal,
        off_diagonal: &planted.off,
        linear: &planted.linear,
        lower: &planted.lower,
        upper: &planted.upper,
    };
    let solution = solve(&program).unwrap();
    assert!(solution.solved && solution.iterations <= 15, "{} rounds", solution.iterations);
}

#[test]
fn nothing_to_find_is_found() {
    let [diagonal, off_diagonal, linear, lower, upper] = [&[]; 5];
    let empty = TridiagonalBoxQp { diagonal, off_diagonal, linear, lower, upper };
    let solution = solve(&empty).unwrap();
    assert!(solution.x.is_empty() && solution.solved);
}

#[test]
fn bad_input_is_named() {
    let mut program = TridiagonalBoxQp {
        diagonal: &[1.0, 1.0],
        off_diagonal: &[0.0],
        linear: &[0.0, 0.0],
        lower: &[0.0, 2.0],
        upper: &[1.0, 1.0],
    };
    let expected = "no number lies between lower[1] = 2 and upper[1] = 1";
    assert_eq!(solve(&program).unwrap_err().to_string(), expected);
    for infinite in [f64::INFINITY, f64::NEG_INFINITY] {
        let program = TridiagonalBoxQp { lower: &[infinite; 2], upper: &[infinite; 2], ..program };
        assert!(matches!(solve(&program), Err(BoxQpError::EmptyBox { index: 0, .. })));
    }
    program.lower = &[0.0, f64::NAN];
    assert!(matches!(solve(&program), Err(BoxQpError::EmptyBox { index: 1, .. })));
    program.lower = &[0.0];
    assert!(matches!(solve(&program), Err(BoxQpError::Length { argument: "lower", .. })));
    program.lower = &[0.0, 0.0];
    program.diagonal = &[1.0, -1.0];
    assert!(matches!(solve(&program), Err(BoxQpError::NotPositiveDefinite { index: 1, .. })));
    program.diagonal = &[1.0, 1.0];
    program.lower = &[f64::NEG_INFINITY; 2];
    program.upper = &[f64::INFINITY; 2];
    program.off_diagonal = &[2.0];
    assert!(matches!(solve(&program), Err(BoxQpError::NotPositiveDefinite { index: 1, .. })));
}

/// Found by mutation: a residual is relative to the sum of the sizes of a row's terms.
#[test]
fn a_residual_by_hand() {
    let program = TridiagonalBoxQp {
        diagonal: &[4.0, 2.0],
        off_diagonal: &[1.0],
        linear: &[3.0, -1.0],
        lower: &[f64::NEG_INFINITY; 2],
        upper: &[f64::INFINITY; 2],
    };
    // Rows: 4·0.5 + 1·0.25 + 3 = 5.25 of terms 2, 0.25, 3; 0.5 + 0.5 − 1 = 0.
    assert_eq!(kkt_residual(&program, &[0.5, 0.25]), 5.25 / 5.25);
    // 4·(−0.5) + 0.25 + 3 = 1.25 of 5.25; −0.5 + 0.5 − 1 = −1 of 2.
    assert_eq!(kkt_residual(&program, &[-0.5, 0.25]), 0.5);
    // 4·(−0.5) + 1·1 + 3 = 2 of 6; −0.5 + 2 − 1 = 0.5 of 3.5.
    assert_eq!(kkt_residual(&program, &[-0.5, 1.0]), 2.0 / 6.0);
}
