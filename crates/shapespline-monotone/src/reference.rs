//! The programs of this crate through Clarabel, an independent conic solver: the reference of the tests.
#![allow(clippy::unwrap_used)]

use crate::data::Data;
use crate::energy::{Fairness, HESSIAN, is_flat, weight};
use crate::optimal::parts::{gradient, rows};
use crate::quartic_form::basis;
use crate::slopes::sign;
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
    let n = data.len();
    let size = 2 * (n + 1);
    let (mut p, mut q) = (Vec::new(), vec![0.0; size]);
    let (mut equal, mut positive) = (Vec::new(), Vec::new());
    for i in 0..n {
        let (h, delta) = (data.h[i], data.delta[i]);
        let index = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3];
        if is_flat(delta) {
            equal.extend(index.iter().map(|&j| (vec![(j, 1.0)], 0.0)));
            continue;
        }
        if i > 0 && sign(delta) * sign(data.delta[i - 1]) < 0.0 {
            equal.push((vec![(2 * i, 1.0)], 0.0));
        }
        let scale = [1.0 / delta, 0.25 * h / delta, 1.0 / delta, 0.25 * h / delta];
        let w = weight(fairness, h, delta) / 35.0;
        for j in 0..4 {
            for k in 0..4 {
                p.push((index[j], index[k], w * HESSIAN[j][k] * scale[j] * scale[k]));
                if k % 2 == 0 {
                    q[index[j]] -= w * HESSIAN[j][k] * scale[j];
                }
            }
        }
        let parts = f64::from(1u32 << level);
        for part in 0..1u32 << level {
            let (from, to) = (f64::from(part) / parts, f64::from(part + 1) / parts);
            for row in std::iter::once(basis(from)).chain(rows(from, to)) {
                let gradient = gradient(&row);
                // value = row·(1,…,1) + gradient·(a, b, …) with a = d/Δ − 1.
                let constant = 1.0 - gradient[0] - gradient[2];
                debug_assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                positive
                    .push(((0..4).map(|j| (index[j], gradient[j] * scale[j])).collect(), constant));
            }
        }
    }
    let (x, iterations) = quadratic(size, p, &q, &equal, &positive);
    (
        x.iter().step_by(2).copied().collect(),
        x.iter().skip(1).step_by(2).copied().collect(),
        iterations,
    )
}
