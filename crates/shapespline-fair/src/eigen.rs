// SPDX-License-Identifier: MIT OR Apache-2.0

//! Eigenvalues and eigenvectors of a small symmetric matrix: reflections to a tridiagonal matrix, then
//! implicitly shifted QL steps (G. H. Golub, C. F. Van Loan, Matrix Computations, 8.3). Search directions are
//! mended by them element by element, some thousand times in a second; vectors are rows, so that rotations
//! run over neighbouring numbers.

use crate::legs::UNKNOWNS;

type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

/// Eigenvalues in no order, each with its vector of length one.
pub(crate) struct Eigen {
    pub(crate) values: [f64; UNKNOWNS],
    pub(crate) vectors: Matrix,
}

/// Steps for one eigenvalue: two or three are usual.
const STEPS: usize = 60;

/// Those of the leading `n` rows and columns; the others are zero. None where entries are not finite.
pub(crate) fn eigen(n: usize, matrix: &Matrix) -> Option<Eigen> {
    let (mut values, mut beside, mut vectors) = tridiagonal(n, *matrix);
    for first in 0..n {
        for step in 0.. {
            let last = (first..n - 1)
                .find(|&i| {
                    let size = values[i].abs() + values[i + 1].abs();
                    // Written so that a NaN goes on.
                    beside[i].abs() <= f64::EPSILON * size
                })
                .unwrap_or(n - 1);
            if last == first {
                break;
            }
            if step == STEPS {
                return None;
            }
            turn(first..last, &mut values, &mut beside, &mut vectors);
        }
    }
    Some(Eigen { values, vectors })
}

/// Diagonal, subdiagonal and transformation (by rows) of a similar tridiagonal matrix.
fn tridiagonal(n: usize, mut a: Matrix) -> ([f64; UNKNOWNS], [f64; UNKNOWNS], Matrix) {
    let mut vectors = [[0.0; UNKNOWNS]; UNKNOWNS];
    (0..UNKNOWNS).for_each(|i| vectors[i][i] = 1.0);
    let mut beside = [0.0; UNKNOWNS];
    for k in 0..n.saturating_sub(1) {
        // Below the diagonal, by symmetry.
        let mut v = a[k];
        v[..=k].fill(0.0);
        let size = dot(&v, &v).sqrt();
        let rest: f64 = v[k + 2..n].iter().map(|x| x * x).sum();
        if rest == 0.0 {
            beside[k] = v[k + 1];
            continue;
        }
        beside[k] = -size.copysign(v[k + 1]);
        v[k + 1] -= beside[k];
        let factor = 2.0 / dot(&v, &v);
        let mut w: [f64; UNKNOWNS] = [0.0; UNKNOWNS];
        for i in k + 1..n {
            w[i] = factor * dot(&a[i], &v);
        }
        let half = 0.5 * factor * dot(&w, &v);
        (0..UNKNOWNS).for_each(|i| w[i] -= half * v[i]);
        for i in k + 1..n {
            for j in 0..UNKNOWNS {
                a[i][j] -= v[i] * w[j] + w[i] * v[j];
            }
        }
        let mut along = [0.0; UNKNOWNS];
        for i in k + 1..n {
            (0..UNKNOWNS).for_each(|j| along[j] += v[i] * vectors[i][j]);
        }
        for i in k + 1..n {
            (0..UNKNOWNS).for_each(|j| vectors[i][j] -= factor * v[i] * along[j]);
        }
    }
    (std::array::from_fn(|i| a[i][i]), beside, vectors)
}

/// One step on the block of some rows and the one after them.
fn turn(
    rows: std::ops::Range<usize>,
    d: &mut [f64; UNKNOWNS],
    e: &mut [f64; UNKNOWNS],
    vectors: &mut Matrix,
) {
    let (first, last) = (rows.start, rows.end);
    // The shift: the eigenvalue of the leading two rows that is nearer to the first.
    let g = (d[first + 1] - d[first]) / (2.0 * e[first]);
    let mut g = d[last] - d[first] + e[first] / (g + g.hypot(1.0).copysign(g));
    let (mut sine, mut cosine, mut shift) = (1.0, 1.0, 0.0);
    e[last] = 0.0;
    for i in rows.rev() {
        let (f, b) = (sine * e[i], cosine * e[i]);
        let r = (f * f + g * g).sqrt();
        e[i + 1] = r;
        if r == 0.0 {
            // The block falls apart.
            d[i + 1] -= shift;
            e[last] = 0.0;
            return;
        }
        (sine, cosine) = (f / r, g / r);
        g = d[i + 1] - shift;
        let r = (d[i] - g) * sine + 2.0 * cosine * b;
        shift = sine * r;
        d[i + 1] = g + shift;
        g = cosine * r - b;
        for j in 0..UNKNOWNS {
            let (x, y) = (vectors[i][j], vectors[i + 1][j]);
            vectors[i + 1][j] = sine * x + cosine * y;
            vectors[i][j] = cosine * x - sine * y;
        }
    }
    d[first] -= shift;
    e[first] = g;
    e[last] = 0.0;
}

fn dot(x: &[f64; UNKNOWNS], y: &[f64; UNKNOWNS]) -> f64 {
    let mut sum = 0.0;
    for i in 0..UNKNOWNS {
        sum += x[i] * y[i];
    }
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::SMatrix;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Against a library, for matrices of every size, with clusters of eigenvalues and without.
        #[test]
        fn eigenvalues_and_vectors_are_those_of_a_library(
            entries in proptest::collection::vec(-1.0..1.0f64, UNKNOWNS * UNKNOWNS),
            n in 1..=UNKNOWNS, rank in 1..=UNKNOWNS, decades in 0.0..12.0f64,
        ) {
            let factor = |i: usize, k: usize| {
                entries[UNKNOWNS * i + k] * 10f64.powf(-decades * (i * k % 5) as f64 / 5.0)
            };
            let mut a = [[0.0; UNKNOWNS]; UNKNOWNS];
            for i in 0..n {
                for j in 0..n {
                    a[i][j] = (0..rank).map(|k| (k as f64 - 2.5) * factor(i, k) * factor(j, k)).sum();
                }
            }
            let found = eigen(n, &a).ok_or(TestCaseError::fail("no eigenvalues"))?;
            let full = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_fn(|i, j| a[i][j]);
            let size = full.norm();
            let mut own = found.values.to_vec();
            let mut other: Vec<f64> = full.symmetric_eigenvalues().iter().copied().collect();
            own.sort_by(f64::total_cmp);
            other.sort_by(f64::total_cmp);
            for (x, y) in own.iter().zip(&other) {
                prop_assert!((x - y).abs() < 1e-13 * size, "{x} {y}");
            }
            for (k, (x, v)) in found.values.iter().zip(&found.vectors).enumerate() {
                for i in 0..n {
                    prop_assert!((dot(&a[i], v) - x * v[i]).abs() < 1e-13 * size);
                }
                for (l, other) in found.vectors.iter().enumerate() {
                    let expected = if k == l { 1.0 } else { 0.0 };
                    prop_assert!((dot(v, other) - expected).abs() < 1e-13);
                }
            }
        }
    }
}
