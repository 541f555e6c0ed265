// SPDX-License-Identifier: MIT OR Apache-2.0

//! The programs of this crate through Clarabel, an independent conic solver: the reference of the tests.
#![allow(clippy::unwrap_used)]

use crate::data::Data;
use crate::energy::{Fairness, is_flat};
use crate::optimal::parts::Quadratic;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT,
};
use shapespline_polynomial::quartic::{basis, dot, minima};

/// A matrix as triplets.
pub(crate) fn csc(m: usize, n: usize, mut t: Vec<(usize, usize, f64)>) -> CscMatrix<f64> {
    t.sort_by_key(|&(r, c, _)| (c, r));
    let (mut colptr, mut rows, mut values) = (vec![0usize; n + 1], Vec::new(), Vec::<f64>::new());
    let mut last = (usize::MAX, usize::MAX);
    for (r, c, v) in t {
        if last == (r, c) {
            *values.last_mut().unwrap() += v;
        } else {
            rows.push(r);
            values.push(v);
            colptr[c + 1] += 1;
            last = (r, c);
        }
    }
    for c in 0..n {
        colptr[c + 1] += colptr[c];
    }
    CscMatrix::new(m, n, colptr, rows, values)
}

/// Minimise ½xᵀPx + qᵀx subject to `eq` rows = 0 and the others ≥ 0 (rows are (coefficients, constant)).
pub(crate) fn quadratic(
    n: usize,
    p: Vec<(usize, usize, f64)>,
    q: &[f64],
    equal: &[(Vec<(usize, f64)>, f64)],
    positive: &[(Vec<(usize, f64)>, f64)],
) -> (Vec<f64>, u32) {
    let mut a = Vec::new();
    let mut b = Vec::new();
    for (i, (row, constant)) in equal.iter().chain(positive).enumerate() {
        a.extend(row.iter().map(|&(j, v)| (i, j, -v)));
        b.push(*constant);
    }
    let p = csc(n, n, p.into_iter().filter(|&(r, c, _)| r <= c).collect());
    let a = csc(b.len(), n, a);
    let cones = [ZeroConeT(equal.len()), NonnegativeConeT(positive.len())];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-13)
        .tol_gap_rel(1e-12)
        .tol_feas(1e-12)
        .max_iter(200)
        .build()
        .unwrap();
    let mut solver = DefaultSolver::new(&p, q, &a, &b, &cones, settings).unwrap();
    solver.solve();
    (solver.solution.x.clone(), solver.solution.iterations)
}

/// Optimal slopes and second derivatives with the conditions on 2^`level` parts of every segment; scaled units.
#[cfg(feature = "nlopt")]
pub(crate) fn optimal(data: &Data, fairness: Fairness, level: u8) -> (Vec<f64>, Vec<f64>, u32) {
    let Quadratic { hessian, linear, fixed, positive } = Quadratic::of(data, fairness, level);
    let equal: Vec<_> = fixed.iter().map(|&j| (vec![(j, 1.0)], 0.0)).collect();
    let (x, iterations) = quadratic(linear.len(), hessian, &linear, &equal, &positive);
    (
        x.iter().step_by(2).copied().collect(),
        x.iter().skip(1).step_by(2).copied().collect(),
        iterations,
    )
}

/// The exact optimum with the slopes that are not NaN given; scaled units.
///
/// By exchange: the derivative is asked to be non-negative at some places of every segment, then at the places of its
/// negative minima as well, until there are none. An outer approximation, which comes down on the optimum from below
/// in energy and knows nothing of the cones' matrices.
pub(crate) fn exact(data: &Data, fairness: Fairness, given: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = data.len();
    let Quadratic { hessian, linear, fixed, .. } = Quadratic::of(data, fairness, 0);
    // Unknowns of the size of their neighbourhood.
    let mut unit = vec![0.0; 2 * (n + 1)];
    for i in 0..=n {
        let sides = [i.max(1) - 1, i.min(n - 1)];
        let least = |f: &dyn Fn(usize) -> f64| f(sides[0]).min(f(sides[1]));
        unit[2 * i] = least(&|j| data.delta[j].abs());
        unit[2 * i + 1] = least(&|j| data.delta[j].abs() / data.h[j]);
    }
    let mut equal: Vec<_> = fixed.iter().map(|&j| (vec![(j, 1.0)], 0.0)).collect();
    for (i, d) in given.iter().enumerate().filter(|(_, d)| !d.is_nan()) {
        equal.push((vec![(2 * i, 1.0)], -d / unit[2 * i]));
    }
    let unit: Vec<f64> = unit.iter().map(|u| if *u > 0.0 { *u } else { 1.0 }).collect();
    let p: Vec<_> = hessian.iter().map(|&(i, j, v)| (i, j, v * unit[i] * unit[j])).collect();
    let q: Vec<f64> = linear.iter().zip(&unit).map(|(q, u)| q * u).collect();
    let of = |i: usize, v: &[f64]| {
        let at = |j: usize| [v[2 * j] * unit[2 * j], v[2 * j + 1] * unit[2 * j + 1]];
        crate::optimal::coefficients(data.h[i], data.delta[i], at(i), at(i + 1))
    };
    let row = |i: usize, t: f64| {
        let value = |v: &[f64]| dot(&of(i, v), &basis(t));
        let mut v = vec![0.0; 2 * (n + 1)];
        let constant = value(&v);
        let mut row = Vec::new();
        for j in 2 * i..2 * i + 4 {
            v[j] = 1.0;
            row.push((j, value(&v) - constant));
            v[j] = 0.0;
        }
        (row, constant)
    };
    let steep: Vec<usize> = (0..n).filter(|&i| !is_flat(data.delta[i])).collect();
    let start = |i: &usize| (0..=8).map(|k| row(*i, f64::from(k) / 8.0)).collect::<Vec<_>>();
    let mut positive: Vec<_> = steep.iter().flat_map(start).collect();
    // Where the slope is fixed at 0 it has to leave in the right direction.
    for &i in &steep {
        for (end, k) in [(i, 1), (i + 1, 3)] {
            if fixed.contains(&(2 * end)) && !fixed.contains(&(2 * end + 1)) {
                let mut v = vec![0.0; 2 * (n + 1)];
                v[2 * end + 1] = 1.0;
                let slope = of(i, &v)[k] - of(i, &vec![0.0; 2 * (n + 1)])[k];
                positive.push((vec![(2 * end + 1, slope)], 0.0));
            }
        }
    }
    for round in 0..40 {
        let (v, _) = quadratic(q.len(), p.clone(), &q, &equal, &positive);
        let mut added = false;
        for &i in &steep {
            for minimum in minima(&of(i, &v)).iter().flatten().filter(|m| m.value < -1e-8) {
                positive.push(row(i, minimum.t));
                added = true;
            }
        }
        if !added || round == 39 {
            let at = |k: usize| (k..v.len()).step_by(2).map(|j| v[j] * unit[j]).collect();
            return (at(0), at(1));
        }
    }
    panic!("the exchange does not end");
}
