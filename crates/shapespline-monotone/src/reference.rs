//! The programs of this crate through Clarabel, an independent conic solver: the reference of the tests.
#![allow(clippy::unwrap_used)]

use crate::data::Data;
use crate::energy::Fairness;
use crate::optimal::parts::Quadratic;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT,
};

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
