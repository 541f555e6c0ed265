// SPDX-License-Identifier: MIT OR Apache-2.0

//! Element Hessians made positive definite.
//!
//! Where the Hessian of the whole is indefinite, each indefinite element is mended by itself: its
//! eigenvalues `λ < 0` become `0.3 |λ|` (one shift for all took ten times as many steps). Unknowns are
//! scaled before, with one scale per vector, so that the result does not depend on the directions of
//! the axes.

use crate::{
    eigen::eigen,
    element::{Span, TAU},
    legs::{ElementHessian, UNKNOWNS},
};

/// What becomes of a negative eigenvalue, as a share of its size.
const REFLECTED: f64 = 0.3;
/// Least eigenvalue of a scaled Hessian.
const LEAST: f64 = 1e-8;

/// Changes a Hessian that is not positive definite.
pub(crate) fn make_definite(span: &Span, hessian: &mut ElementHessian) {
    if is_definite(hessian) {
        return;
    }
    let sizes = sizes(span, hessian);
    let scale: [f64; UNKNOWNS] = std::array::from_fn(|i| 1.0 / sizes[i / 3].sqrt());
    // What may not move has a row of zeros, and keeps it: rounding must not move it either.
    let (mut at, mut free) = ([0; UNKNOWNS], 0);
    for (i, row) in hessian.iter().enumerate() {
        if row.iter().any(|&x| x != 0.0) {
            (at[free], free) = (i, free + 1);
        }
    }
    let mut scaled = [[0.0; UNKNOWNS]; UNKNOWNS];
    for i in 0..free {
        for j in 0..free {
            scaled[i][j] = hessian[at[i]][at[j]] * scale[at[i]] * scale[at[j]];
        }
    }
    let Some(eigen) = eigen(free, &scaled) else { return };
    for (&x, v) in eigen.values[..free].iter().zip(&eigen.vectors) {
        if x >= LEAST {
            continue;
        }
        let lift = LEAST.max(-REFLECTED * x) - x;
        let mut unscaled = [0.0; UNKNOWNS];
        (0..free).for_each(|i| unscaled[at[i]] = v[i] / scale[at[i]]);
        for (row, a) in hessian.iter_mut().zip(unscaled) {
            for (entry, b) in row.iter_mut().zip(unscaled) {
                *entry += lift * a * b;
            }
        }
    }
}

/// A natural size of the diagonal for each of the four vectors of unknowns: never zero.
pub(crate) fn sizes(span: &Span, hessian: &ElementHessian) -> [f64; 4] {
    let h = 1.0 / span.spacing;
    let arm = 0.5 * TAU * span.spacing;
    let natural = [h, h * arm * arm, h, h * arm * arm];
    std::array::from_fn(|v| {
        let own: f64 = (3 * v..3 * v + 3).map(|i| hessian[i][i].abs()).sum();
        own / 3.0 + natural[v]
    })
}

/// Whether Cholesky's factorisation succeeds, rows of zeros left out.
fn is_definite(hessian: &ElementHessian) -> bool {
    let mut a = *hessian;
    for j in 0..UNKNOWNS {
        let mut d = a[j][j];
        for k in 0..j {
            d -= a[j][k] * a[j][k];
        }
        // What may not move has a row of zeros.
        if hessian[j].iter().all(|&x| x == 0.0) {
            continue;
        }
        // Written so that a NaN fails.
        if !(d > 1e-14 * hessian[j][j]) {
            return false;
        }
        let reciprocal = 1.0 / d.sqrt();
        for i in j + 1..UNKNOWNS {
            let mut sum = a[i][j];
            for k in 0..j {
                sum -= a[i][k] * a[j][k];
            }
            a[i][j] = sum * reciprocal;
        }
        a[j][j] = d * reciprocal;
    }
    true
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use nalgebra::SMatrix;

    use super::*;

    /// A planted spectrum in scaled unknowns: positive eigenvalues stay, negative ones are reflected.
    #[test]
    fn negative_curvature_is_reflected() {
        let span = Span { direction: DVec3::X, length: 1.0, spacing: 1.0 };
        // A reflection is orthogonal and symmetric: eigenvectors are its columns.
        let axis = SMatrix::<f64, UNKNOWNS, 1>::from_fn(|i, _| ((i * i + 1) as f64).sin());
        let axis = axis / axis.norm();
        let v = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::identity() - axis * axis.transpose() * 2.0;
        let values = SMatrix::<f64, UNKNOWNS, 1>::from_fn(|i, _| (i as f64) - 3.5);
        let matrix = v * SMatrix::from_diagonal(&values) * v.transpose();
        let mut hessian: ElementHessian =
            std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]));
        let before = hessian;
        make_definite(&span, &mut hessian);
        assert!(is_definite(&hessian) && !is_definite(&before));
        // In scaled unknowns the change is positive semidefinite and leaves positive curvature alone.
        let sizes = sizes(&span, &before);
        let scaled = |h: &ElementHessian| {
            SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_fn(|i, j| {
                h[i][j] / (sizes[i / 3] * sizes[j / 3]).sqrt()
            })
        };
        let (old, new) = (scaled(&before), scaled(&hessian));
        let eigen = old.symmetric_eigen();
        for (k, &x) in eigen.eigenvalues.iter().enumerate() {
            let vector = eigen.eigenvectors.column(k);
            let expected = if x < LEAST { -REFLECTED * x } else { x };
            let found = (new * vector - vector * expected).norm();
            assert!(found < 1e-10, "{x}: {found}");
        }
        let mut kept = hessian;
        make_definite(&span, &mut kept);
        assert_eq!(kept, hessian);
        // Found by a given end tangent that drifted by 2e−12.
        let mut held = before;
        held[4] = [0.0; UNKNOWNS];
        held.iter_mut().for_each(|row| row[4] = 0.0);
        make_definite(&span, &mut held);
        assert!((0..UNKNOWNS).all(|i| held[4][i] == 0.0 && held[i][4] == 0.0));
    }
}
