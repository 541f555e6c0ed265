// SPDX-License-Identifier: MIT OR Apache-2.0

//! Solvers and polynomials: what the families stand on.

use shapespline::{
    banded::{
        box_qp::{self, TridiagonalBoxQp},
        solve_cyclic, solve_tridiagonal,
    },
    polynomial::{Polynomial, Sign},
};

use super::{Bytes, readable};

/// Tridiagonal systems, box programs, signs of Bernstein polynomials, on arbitrary numbers. A solution
/// of a dominant system solves it, the minimiser of a program lies in its box, and no sign that is
/// claimed is contradicted by a value.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    match bytes.below(3) {
        0 => systems(&mut bytes),
        1 => programs(&mut bytes),
        _ => signs(&mut bytes),
    }
}

fn systems(bytes: &mut Bytes<'_>) {
    let n = bytes.below(16);
    let mut numbers = |n: usize| -> Vec<f64> { (0..n).map(|_| bytes.unscaled()).collect() };
    let (lower, upper, diagonal, right) = (numbers(n), numbers(n), numbers(n), numbers(n));
    let cyclic = bytes.flag();
    let dominant = bytes.flag();
    let diagonal: Vec<f64> = (0..n)
        .map(|i| if dominant { 2.0 * (lower[i].abs() + upper[i].abs()) + 1.0 } else { diagonal[i] })
        .collect();
    let (mut d, mut x) = (diagonal.clone(), right.clone());
    let solved = if cyclic {
        solve_cyclic(&lower, &mut d, &upper, &mut x)
    } else {
        solve_tridiagonal(&lower, &mut d, &upper, &mut x)
    };
    if let Err(error) = solved {
        return readable(&error);
    }
    let all = || lower.iter().chain(&upper).chain(&right);
    if !dominant || all().any(|v| !(v.abs() < 1e100)) {
        return;
    }
    let most = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for i in 0..n {
        let (before, after) = ((i + n - 1) % n, (i + 1) % n);
        let l = if i > 0 || cyclic { lower[i] * x[before] } else { 0.0 };
        let u = if i + 1 < n || cyclic { upper[i] * x[after] } else { 0.0 };
        let own = diagonal[i] * x[i];
        // Around a cycle, unknowns may be the difference of numbers as large as the largest of them.
        let size = match cyclic {
            true => (lower[i].abs() + diagonal[i] + upper[i].abs()) * most,
            false => l.abs() + u.abs() + own.abs(),
        } + right[i].abs();
        let residual = (l + own + u - right[i]).abs();
        // Entries of x are multiples of the least number there is, and so are the shares that a row has in
        // the unknowns of others.
        let grain = 1e-322 * (1.0 + lower[i].abs() + diagonal[i].abs() + upper[i].abs());
        let grain = grain * (1.0 + most);
        assert!(residual <= (1e-12 * size).max(grain), "row {i} of {n}: {residual:e} of {size:e}");
    }
}

fn programs(bytes: &mut Bytes<'_>) {
    let n = bytes.below(12);
    let mut numbers = |n: usize| -> Vec<f64> { (0..n).map(|_| bytes.unscaled()).collect() };
    let off_diagonal = numbers(n.saturating_sub(1));
    let (extra, linear, mut lower, mut upper) = (numbers(n), numbers(n), numbers(n), numbers(n));
    let (dominant, sorted) = (bytes.below(4) != 0, bytes.below(4) != 0);
    let beside = |i: usize| off_diagonal.get(i).map_or(0.0, |o: &f64| o.abs());
    let diagonal: Vec<f64> = (0..n)
        .map(|i| {
            let before = if i > 0 { beside(i - 1) } else { 0.0 };
            let room = extra[i].abs() + 1e-3;
            if dominant { before + beside(i) + room } else { extra[i] }
        })
        .collect();
    for i in 0..n {
        if sorted && lower[i] > upper[i] {
            (lower[i], upper[i]) = (upper[i], lower[i]);
        }
        match bytes.below(8) {
            0 => lower[i] = f64::NEG_INFINITY,
            1 => upper[i] = f64::INFINITY,
            2 => upper[i] = lower[i],
            _ => {}
        }
    }
    let program = TridiagonalBoxQp {
        diagonal: &diagonal,
        off_diagonal: &off_diagonal,
        linear: &linear,
        lower: &lower,
        upper: &upper,
    };
    let patience = [0, 1, box_qp::PATIENCE][bytes.below(3)];
    let solution = match box_qp::solve_with_patience(&program, patience) {
        Ok(solution) => solution,
        Err(error) => return readable(&error),
    };
    let entries = diagonal.iter().chain(&off_diagonal).chain(&linear);
    let finite = entries.chain(&lower).chain(&upper).all(|v| v.is_infinite() || v.abs() < 1e30);
    // Nor so small that a relative residual means nothing.
    let size = |v: &f64| *v == 0.0 || (1e-30..1e30).contains(&v.abs());
    let tame = diagonal.iter().chain(&off_diagonal).chain(&linear).all(size);
    if !(dominant && finite && tame) {
        return;
    }
    for i in 0..n {
        let x = solution.x[i];
        assert!(lower[i] <= x && x <= upper[i], "x[{i}] = {x}: {program:?}");
    }
    assert!(solution.solved && solution.kkt_residual < 1e-9, "{solution:?}\n{program:?}");
}

fn signs(bytes: &mut Bytes<'_>) {
    let n = bytes.below(12) + 1;
    let coefficients: Vec<f64> = (0..n).map(|_| bytes.unscaled()).collect();
    let size = coefficients.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    // Subnormals have fewer digits, and halving loses them.
    let error = (4.0 * f64::EPSILON * n as f64 * size).max(1e-320);
    let p = Polynomial::new(coefficients.clone(), error);
    let at = |t: f64| p.value(t);
    let t = bytes.fraction();
    match p.sign() {
        Sign::Positive => assert!(!(at(t) < -error), "positive, but {} at {t}", at(t)),
        Sign::Fails { at: t } => assert!(!(at(t) > error), "not positive at {t}: {}", at(t)),
        Sign::Undecided { from, to } => assert!(0.0 <= from && from <= to && to <= 1.0),
    }
    let (changes, _) = p.signs();
    assert!(changes.len() <= n, "{changes:?} of {n} coefficients");
    assert!(changes.windows(2).all(|w| w[0] != w[1]));
    if let Ok(four) = <[f64; 4]>::try_from(&coefficients[..4.min(n)]) {
        let p = Polynomial::new(four.to_vec(), 0.0);
        match Sign::of(&four) {
            Sign::Positive => assert!(!(p.value(t) < -error), "{four:?} at {t}"),
            Sign::Fails { at } => assert!(!(p.value(at) > error), "{four:?} at {at}"),
            Sign::Undecided { from, to } => assert!(0.0 <= from && from <= to && to <= 1.0),
        }
    }
}
