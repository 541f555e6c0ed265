// SPDX-License-Identifier: MIT OR Apache-2.0

//! Symmetric positive definite chains of dense blocks, open or closed into a ring.
//!
//! A Newton step over a chain of nodes with a few unknowns each, where only neighbours meet, needs one
//! such system. Cholesky's factorisation goes node by node in O(n N³) time and O(n N²) memory; a ring is
//! cut at its last node, whose couplings fill one more block per node.

/// A dense block.
pub type Block<const N: usize> = [[f64; N]; N];

/// The factors `A = L Lᵀ` of a block-tridiagonal, or cyclic block-tridiagonal, matrix.
///
/// ```
/// use shapespline_banded::BlockCholesky;
/// // Two nodes with one unknown each: [[4, 1], [1, 3]] x = (6, 7) has the solution (1, 2).
/// let mut factors = BlockCholesky::default();
/// factors.factor(&[[[4.0]], [[3.0]]], &[[[1.0]]]).unwrap();
/// let mut x = vec![[6.0], [7.0]];
/// factors.solve(&mut x);
/// assert!((x[0][0] - 1.0).abs() < 1e-15 && (x[1][0] - 2.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Default)]
pub struct BlockCholesky<const N: usize> {
    /// Lower factor of each node's pivot, with reciprocal diagonal.
    pivots: Vec<Block<N>>,
    /// `L⁻¹ A(i, i+1)` of each node but the last.
    next: Vec<Block<N>>,
    /// `L⁻¹ A(i, last)` of the fill, for rings.
    last: Vec<Block<N>>,
}

/// A node whose pivot is not positive definite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the pivot of node {node} is not positive definite")]
pub struct NotPositiveDefinite {
    /// Index of the node.
    pub node: usize,
}

impl<const N: usize> BlockCholesky<N> {
    /// Factor the matrix with these diagonal blocks, of which only the lower triangles are read, and
    /// these couplings: `coupling[i]` is the block in the rows of node `i` and the columns of node
    /// `i + 1`. With as many couplings as nodes the chain is a ring, and the last coupling has the columns
    /// of node 0; with one fewer it is open.
    ///
    /// # Errors
    /// The first node whose pivot is not positive definite to working accuracy.
    pub fn factor(
        &mut self,
        diagonal: &[Block<N>],
        coupling: &[Block<N>],
    ) -> Result<(), NotPositiveDefinite> {
        self.pivots.clear();
        self.next.clear();
        self.last.clear();
        let n = diagonal.len();
        if n == 0 {
            return Ok(());
        }
        debug_assert!(coupling.len() == n || coupling.len() + 1 == n);
        let ring = n > 1 && coupling.len() == n;
        let mut pivot = diagonal[0];
        let mut end = diagonal[n - 1];
        let mut fill = if ring { transposed(&coupling[n - 1]) } else { [[0.0; N]; N] };
        for node in 0..n - 1 {
            cholesky(&mut pivot, &diagonal[node]).ok_or(NotPositiveDefinite { node })?;
            let mut to_next = coupling[node];
            if ring && node + 2 == n {
                add(&mut to_next, &fill);
            }
            forward(&pivot, &mut to_next);
            let mut following = diagonal[node + 1];
            if node + 2 == n {
                following = end;
            }
            subtract_square(&mut following, &to_next);
            if ring && node + 2 < n {
                forward(&pivot, &mut fill);
                subtract_square(&mut end, &fill);
                self.last.push(fill);
                let mut carried = [[0.0; N]; N];
                subtract_product(&mut carried, &to_next, &fill);
                fill = carried;
            }
            self.pivots.push(pivot);
            self.next.push(to_next);
            pivot = following;
        }
        let node = n - 1;
        cholesky(&mut pivot, &diagonal[node]).ok_or(NotPositiveDefinite { node })?;
        self.pivots.push(pivot);
        Ok(())
    }

    /// Solve for a right-hand side in place. O(n N²).
    pub fn solve(&self, right: &mut [[f64; N]]) {
        let n = self.pivots.len();
        debug_assert_eq!(right.len(), n);
        for i in 0..n {
            let y = forward_vector(&self.pivots[i], right[i]);
            right[i] = y;
            if let Some(next) = self.next.get(i) {
                subtract_transposed(&mut right[i + 1], next, y);
            }
            if let Some(last) = self.last.get(i) {
                subtract_transposed(&mut right[n - 1], last, y);
            }
        }
        for i in (0..n).rev() {
            let mut y = right[i];
            if let Some(next) = self.next.get(i) {
                subtract_applied(&mut y, next, right[i + 1]);
            }
            if let Some(last) = self.last.get(i) {
                subtract_applied(&mut y, last, right[n - 1]);
            }
            right[i] = backward_vector(&self.pivots[i], y);
        }
    }
}

/// The lower Cholesky factor in place, its diagonal as reciprocals. `original` is the block before
/// elimination: a pivot below its rounding is none.
fn cholesky<const N: usize>(a: &mut Block<N>, original: &Block<N>) -> Option<()> {
    for j in 0..N {
        let mut d = a[j][j];
        for k in 0..j {
            d -= a[j][k] * a[j][k];
        }
        // Written so that a NaN fails.
        if !(d > 4.0 * f64::EPSILON * original[j][j].abs()) {
            return None;
        }
        let reciprocal = 1.0 / d.sqrt();
        a[j][j] = reciprocal;
        for i in j + 1..N {
            let mut sum = a[i][j];
            for k in 0..j {
                sum -= a[i][k] * a[j][k];
            }
            a[i][j] = sum * reciprocal;
        }
    }
    Some(())
}

/// `B ← L⁻¹ B`.
fn forward<const N: usize>(l: &Block<N>, b: &mut Block<N>) {
    for i in 0..N {
        for k in 0..i {
            let (factor, row) = (l[i][k], b[k]);
            for j in 0..N {
                b[i][j] -= factor * row[j];
            }
        }
        for j in 0..N {
            b[i][j] *= l[i][i];
        }
    }
}

/// `A ← A − BᵀB`.
fn subtract_square<const N: usize>(a: &mut Block<N>, b: &Block<N>) {
    subtract_product(a, b, b);
}

/// `A ← A − BᵀC`.
fn subtract_product<const N: usize>(a: &mut Block<N>, b: &Block<N>, c: &Block<N>) {
    for k in 0..N {
        for i in 0..N {
            let factor = b[k][i];
            for j in 0..N {
                a[i][j] -= factor * c[k][j];
            }
        }
    }
}

fn transposed<const N: usize>(a: &Block<N>) -> Block<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn add<const N: usize>(a: &mut Block<N>, b: &Block<N>) {
    for (row, other) in a.iter_mut().zip(b) {
        for (x, y) in row.iter_mut().zip(other) {
            *x += y;
        }
    }
}

fn forward_vector<const N: usize>(l: &Block<N>, mut y: [f64; N]) -> [f64; N] {
    for i in 0..N {
        for k in 0..i {
            y[i] -= l[i][k] * y[k];
        }
        y[i] *= l[i][i];
    }
    y
}

fn backward_vector<const N: usize>(l: &Block<N>, mut y: [f64; N]) -> [f64; N] {
    for i in (0..N).rev() {
        for k in i + 1..N {
            y[i] -= l[k][i] * y[k];
        }
        y[i] *= l[i][i];
    }
    y
}

/// `y ← y − Bᵀx`.
fn subtract_transposed<const N: usize>(y: &mut [f64; N], b: &Block<N>, x: [f64; N]) {
    for k in 0..N {
        for i in 0..N {
            y[i] -= b[k][i] * x[k];
        }
    }
}

/// `y ← y − Bx`.
fn subtract_applied<const N: usize>(y: &mut [f64; N], b: &Block<N>, x: [f64; N]) {
    for i in 0..N {
        for k in 0..N {
            y[i] -= b[i][k] * x[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 3;

    /// A positive definite chain whose unknowns differ by decades in size, open or a ring.
    fn planted(n: usize, ring: bool) -> (Vec<Block<N>>, Vec<Block<N>>, Vec<[f64; N]>) {
        let wave = |k: usize| ((k * 37 + 11) % 23) as f64 / 11.5 - 1.0;
        let size = |i: usize, k: usize| 10f64.powi(((i * 5 + k * 3) % 9) as i32 - 4);
        let couplings = n - usize::from(!ring);
        let coupling = (0..couplings)
            .map(|i| {
                std::array::from_fn(|r| {
                    std::array::from_fn(|c| {
                        0.4 * wave(i * 9 + r * 3 + c) * size(i, r) * size((i + 1) % n, c)
                    })
                })
            })
            .collect();
        let diagonal = (0..n)
            .map(|i| {
                std::array::from_fn(|r| {
                    std::array::from_fn(|c| {
                        let own = if r == c { 4.0 } else { 0.3 * wave(i + 2 * (r + c)) };
                        own * size(i, r) * size(i, c)
                    })
                })
            })
            .collect();
        let solution =
            (0..n).map(|i| std::array::from_fn(|k| wave(7 * i + k) / size(i, k))).collect();
        (diagonal, coupling, solution)
    }

    fn product(d: &[Block<N>], o: &[Block<N>], x: &[[f64; N]]) -> Vec<[f64; N]> {
        let n = d.len();
        let mut y = vec![[0.0; N]; n];
        for i in 0..n {
            for r in 0..N {
                for c in 0..N {
                    y[i][r] += d[i][r][c] * x[i][c];
                }
            }
        }
        for (i, block) in o.iter().enumerate() {
            let j = (i + 1) % n;
            for r in 0..N {
                for c in 0..N {
                    y[i][r] += block[r][c] * x[j][c];
                    y[j][c] += block[r][c] * x[i][r];
                }
            }
        }
        y
    }

    #[test]
    fn planted_solutions_come_back() {
        for ring in [false, true] {
            for n in [1, 2, 3, 4, 60] {
                if ring && n < 2 {
                    continue;
                }
                let (diagonal, coupling, solution) = planted(n, ring);
                let mut x = product(&diagonal, &coupling, &solution);
                let mut factors = BlockCholesky::default();
                factors.factor(&diagonal, &coupling).unwrap();
                factors.solve(&mut x);
                for (found, expected) in x.iter().zip(&solution) {
                    for (a, b) in found.iter().zip(expected) {
                        assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-4), "{n} {ring}: {a} {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_indefinite_node_is_named() {
        let (mut diagonal, coupling, _) = planted(9, false);
        diagonal[4][1][1] = -1.0;
        let mut factors = BlockCholesky::default();
        assert_eq!(factors.factor(&diagonal, &coupling), Err(NotPositiveDefinite { node: 4 }));
        diagonal[4][1][1] = f64::NAN;
        assert_eq!(factors.factor(&diagonal, &coupling), Err(NotPositiveDefinite { node: 4 }));
    }
}
