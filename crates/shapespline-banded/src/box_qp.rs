//! Strictly convex quadratic programs with a tridiagonal Hessian and box constraints.
//!
//! `minimise ½ xᵀ A x + qᵀ x` subject to `lower ≤ x ≤ upper`, `A` symmetric positive definite and tridiagonal.
//!
//! **Method.** Primal–dual active set (block principal pivoting): guess which bounds are active, solve the
//! tridiagonal systems between them, move every variable that contradicts the guess. Active variables cut the
//! chain, so after the first round only the stretches around changed variables are solved again and the cost
//! follows the number of changes. Block moves may cycle on a general matrix; as soon as the number of
//! contradictions has failed to fall [`PATIENCE`] times the iterate is handed to projected Gauss–Seidel sweeps,
//! which lower the objective at every step and identify the active set after finitely many, and the active-set
//! iteration restarts from there. Júdice and Pires, *Computers & Operations Research* 21 (1994) 587–596;
//! Hintermüller, Ito and Kunisch, *SIAM J. Optim.* 13 (2003) 865–888.
// Negated comparisons are meant: they catch NaN as well.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

use thiserror::Error;

/// Rounds without progress after which block moves give way to projected Gauss–Seidel sweeps.
pub const PATIENCE: usize = 10;
/// Sweeps of the first guess.
const GUESSES: usize = 2;
/// Sweeps of a safeguard phase. Each sweep contracts the error by the matrix's diagonal dominance.
const SWEEPS: usize = 40;
/// Safeguard phases before the best iterate is returned with its residual.
const PHASES: usize = 25;

/// What cannot be solved.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BoxQpError {
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, expected {expected}")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A bound pair is empty or not a number.
    #[error("lower[{index}] = {lower} is above upper[{index}] = {upper}")]
    EmptyBox {
        /// The variable.
        index: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A diagonal entry, or a pivot, is not positive: the matrix is not positive definite.
    #[error("pivot {index} is {value}: the matrix is not positive definite")]
    NotPositiveDefinite {
        /// The row.
        index: usize,
        /// The pivot.
        value: f64,
    },
}

/// `minimise ½ xᵀ A x + qᵀ x` subject to `lower ≤ x ≤ upper`.
#[derive(Debug, Clone, Copy)]
pub struct TridiagonalBoxQp<'a> {
    /// The diagonal of `A`, n entries.
    pub diagonal: &'a [f64],
    /// The off-diagonal of `A`, n − 1 entries.
    pub off_diagonal: &'a [f64],
    /// `q`, n entries.
    pub linear: &'a [f64],
    /// Lower bounds; −∞ allowed.
    pub lower: &'a [f64],
    /// Upper bounds; +∞ allowed. Equal bounds fix a variable.
    pub upper: &'a [f64],
}

/// The minimiser with what is needed to trust it.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxQpSolution {
    /// The minimiser. Active variables equal their bound to the last bit.
    pub x: Vec<f64>,
    /// Rounds of the active-set iteration (tridiagonal solves, each only where the set changed).
    pub iterations: usize,
    /// How many variables are at a bound.
    pub active: usize,
    /// How often the safeguard was needed; 0 in every case met in practice.
    pub safeguards: usize,
    /// Largest violation of the optimality conditions, each row relative to the size of its terms.
    pub kkt_residual: f64,
    /// Whether the active set is consistent (no variable contradicts it beyond rounding).
    pub solved: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Lower,
    Free,
    Upper,
}

/// Solve the program. O(n) a round; a handful of rounds for diagonally dominant matrices.
///
/// # Errors
/// [`BoxQpError`] for lengths that do not match, an empty box, or a matrix that is not positive definite.
///
/// ```
/// use shapespline_banded::box_qp::{TridiagonalBoxQp, solve};
/// let program = TridiagonalBoxQp {
///     diagonal: &[2.0, 2.0, 2.0], off_diagonal: &[-1.0, -1.0], linear: &[-1.0, 0.0, -1.0],
///     lower: &[0.0; 3], upper: &[f64::INFINITY, 0.5, f64::INFINITY],
/// };
/// let solution = solve(&program)?;
/// assert_eq!(solution.x, [0.75, 0.5, 0.75]);
/// assert!(solution.solved && solution.active == 1);
/// # Ok::<(), shapespline_banded::box_qp::BoxQpError>(())
/// ```
pub fn solve(program: &TridiagonalBoxQp<'_>) -> Result<BoxQpSolution, BoxQpError> {
    solve_with_patience(program, PATIENCE)
}

/// [`solve`] with another patience: 0 goes through the safeguard first, for tests and hard matrices.
///
/// # Errors
/// As [`solve`].
pub fn solve_with_patience(
    program: &TridiagonalBoxQp<'_>,
    patience: usize,
) -> Result<BoxQpSolution, BoxQpError> {
    validate(program)?;
    let n = program.diagonal.len();
    let mut state =
        ActiveSet { program, x: vec![0.0; n], place: vec![Place::Free; n], work: vec![0.0; n] };
    state.guess();
    let (mut iterations, mut safeguards) = (0, 0);
    let mut solved = false;
    let mut patience_now = patience;
    for phase in 0..=PHASES {
        if phase > 0 || patience == 0 {
            safeguards += 1;
            state.gauss_seidel();
            patience_now = patience.max(PATIENCE);
        }
        let (rounds, done) = state.pivot(patience_now)?;
        iterations += rounds;
        if done {
            solved = true;
            break;
        }
    }
    if !solved {
        // The last word of the safeguard: feasible, and the residual tells how good.
        state.gauss_seidel();
    }
    let kkt_residual = kkt_residual(program, &state.x);
    let active = state.place.iter().filter(|p| **p != Place::Free).count();
    Ok(BoxQpSolution { x: state.x, iterations, active, safeguards, kkt_residual, solved })
}

fn validate(program: &TridiagonalBoxQp<'_>) -> Result<(), BoxQpError> {
    let n = program.diagonal.len();
    for (argument, found, expected) in [
        ("off_diagonal", program.off_diagonal.len(), n.saturating_sub(1)),
        ("linear", program.linear.len(), n),
        ("lower", program.lower.len(), n),
        ("upper", program.upper.len(), n),
    ] {
        if found != expected {
            return Err(BoxQpError::Length { argument, found, expected });
        }
    }
    // Every entry is looked at: a loop that may end early is not done several numbers at once.
    let bounds = || program.lower.iter().zip(program.upper);
    let sound = bounds().fold(true, |all, (l, u)| all & (l <= u))
        & program.diagonal.iter().fold(true, |all, d| all & (*d > 0.0));
    if sound {
        return Ok(());
    }
    for (index, (&lower, &upper)) in bounds().enumerate() {
        if !(lower <= upper) {
            return Err(BoxQpError::EmptyBox { index, lower, upper });
        }
    }
    match program.diagonal.iter().position(|d| !(*d > 0.0)) {
        Some(index) => {
            Err(BoxQpError::NotPositiveDefinite { index, value: program.diagonal[index] })
        }
        None => Ok(()),
    }
}

/// `(A x + q)ᵢ` and the sum of the sizes of its terms.
#[inline(always)]
fn gradient(program: &TridiagonalBoxQp<'_>, x: &[f64], i: usize) -> (f64, f64) {
    let own = program.diagonal[i] * x[i];
    let left = if i > 0 { program.off_diagonal[i - 1] * x[i - 1] } else { 0.0 };
    let right = if i + 1 < x.len() { program.off_diagonal[i] * x[i + 1] } else { 0.0 };
    let q = program.linear[i];
    (own + left + right + q, own.abs() + left.abs() + right.abs() + q.abs())
}

/// Largest scaled violation of the optimality conditions at a feasible `x`: a row's gradient over the sum of the
/// sizes of its terms, counted only in the direction its bounds leave open.
#[must_use]
pub fn kkt_residual(program: &TridiagonalBoxQp<'_>, x: &[f64]) -> f64 {
    let mut worst = 0.0f64;
    for i in 0..x.len() {
        let (g, size) = gradient(program, x, i);
        // Selections, not branches: which bounds are active cannot be predicted.
        let (low, high) = (x[i] <= program.lower[i], x[i] >= program.upper[i]);
        let down = if low { 0.0 } else { g };
        let up = if high { 0.0 } else { -g };
        let violation = if down > up { down } else { up };
        // Divided only where it counts.
        if violation > worst * size {
            worst = violation / size;
        }
    }
    worst
}

struct ActiveSet<'a, 'b> {
    program: &'a TridiagonalBoxQp<'b>,
    x: Vec<f64>,
    place: Vec<Place>,
    work: Vec<f64>,
}

impl ActiveSet<'_, '_> {
    /// Rounds of block moves until nothing contradicts the guess (true) or patience is used up (false).
    fn pivot(&mut self, patience: usize) -> Result<(usize, bool), BoxQpError> {
        let n = self.x.len();
        for i in 0..n {
            self.pin(i);
        }
        let mut changed = Vec::new();
        self.solve_between(0, n)?;
        self.contradictions(0, n, &mut changed);
        let (mut rounds, mut best, mut left) = (1, usize::MAX, patience);
        let mut next = Vec::new();
        while !changed.is_empty() {
            if changed.len() < best {
                best = changed.len();
                left = patience;
            } else if left == 0 {
                return Ok((rounds, false));
            } else {
                left -= 1;
            }
            // All moves first: a stretch may contain several.
            for &(i, place) in &changed {
                self.place[i] = place;
                self.pin(i);
            }
            next.clear();
            let mut done = 0;
            for &(i, _) in &changed {
                if i < done {
                    continue;
                }
                // The solution changes between the nearest active variables on either side and their multipliers.
                let mut from = i;
                while from > done && self.place[from - 1] == Place::Free {
                    from -= 1;
                }
                let from = from.saturating_sub(1).max(done);
                let mut to = i + 1;
                while to < n && self.place[to] == Place::Free {
                    to += 1;
                }
                let to = (to + 1).min(n);
                self.solve_between(from, to)?;
                self.contradictions(from, to, &mut next);
                // The stretch's last variable is active and its multiplier also depends on what follows: when
                // the next stretch starts there it must be looked at again.
                done = if to < n { to - 1 } else { to };
                while next.last().is_some_and(|&(last, _)| last >= done) {
                    // Re-derived below or by the closing check.
                    if to == n {
                        break;
                    }
                    next.pop();
                }
                if to < n {
                    self.contradictions(done, done + 1, &mut next);
                }
            }
            next.dedup_by_key(|c| c.0);
            std::mem::swap(&mut changed, &mut next);
            rounds += 1;
            if changed.is_empty() {
                // Boundary multipliers were judged before their other side was final: one closing look at all.
                self.contradictions(0, n, &mut changed);
            }
        }
        Ok((rounds, true))
    }

    fn pin(&mut self, i: usize) {
        match self.place[i] {
            Place::Lower => self.x[i] = self.program.lower[i],
            Place::Upper => self.x[i] = self.program.upper[i],
            Place::Free => {}
        }
    }

    /// Solve for the free variables of `from..to`, whose outer neighbours are active or absent.
    fn solve_between(&mut self, from: usize, to: usize) -> Result<(), BoxQpError> {
        let p = self.program;
        let n = self.x.len();
        let mut i = from;
        while i < to {
            if self.place[i] != Place::Free {
                i += 1;
                continue;
            }
            let start = i;
            let mut rhs_carry =
                if start > 0 { -p.off_diagonal[start - 1] * self.x[start - 1] } else { 0.0 };
            let mut factor = 0.0;
            while i < to && self.place[i] == Place::Free {
                let below = if i > start { p.off_diagonal[i - 1] } else { 0.0 };
                let pivot = p.diagonal[i] - below * factor;
                if !(pivot > 0.0) {
                    return Err(BoxQpError::NotPositiveDefinite { index: i, value: pivot });
                }
                let inverse = 1.0 / pivot;
                let rhs = -p.linear[i] + rhs_carry;
                self.x[i] = rhs * inverse;
                if i + 1 < n {
                    let o = p.off_diagonal[i];
                    factor = o * inverse;
                    self.work[i] = factor;
                    rhs_carry = -o * self.x[i];
                }
                i += 1;
            }
            if i < n {
                self.x[i - 1] -= self.work[i - 1] * self.x[i];
            }
            for k in (start..i - 1).rev() {
                self.x[k] -= self.work[k] * self.x[k + 1];
            }
        }
        Ok(())
    }

    /// Variables of `from..to` that contradict their place, with the place they should move to.
    fn contradictions(&self, from: usize, to: usize, out: &mut Vec<(usize, Place)>) {
        let p = self.program;
        for i in from..to {
            let (x, l, u, place) = (self.x[i], p.lower[i], p.upper[i], self.place[i]);
            let (g, size) = gradient(p, &self.x, i);
            // A multiplier of the wrong sign within rounding is a degenerate one, not a contradiction.
            let tolerance = 8.0 * f64::EPSILON * size;
            // Logic without branches: which variables are active cannot be predicted, that few contradict can.
            let beyond = (place == Place::Free) & ((x < l) | (x > u));
            let pulled = (place == Place::Lower) & (g < -tolerance);
            let pushed = (place == Place::Upper) & (g > tolerance);
            if beyond | ((pulled | pushed) & (l != u)) {
                let to = match place {
                    Place::Free if x < l => Place::Lower,
                    Place::Free => Place::Upper,
                    _ => Place::Free,
                };
                out.push((i, to));
            }
        }
    }

    /// A first guess of the active set: what a few sweeps of projected Jacobi steps leave at its bounds. Where the
    /// diagonal dominates (a sixth is gained a sweep on splines) few variables are guessed wrong; elsewhere the guess
    /// is as good as any.
    fn guess(&mut self) {
        let p = self.program;
        let n = self.x.len();
        if n == 0 {
            return;
        }
        let clamp = |x: f64, i: usize| {
            let x = if x < p.lower[i] { p.lower[i] } else { x };
            if x > p.upper[i] { p.upper[i] } else { x }
        };
        for i in 0..n {
            self.x[i] = clamp(-p.linear[i] / p.diagonal[i], i);
        }
        for _ in 0..GUESSES {
            std::mem::swap(&mut self.x, &mut self.work);
            let (from, to) = (&self.work[..n], &mut self.x[..n]);
            let row = |left: f64, right: f64, i: usize| {
                clamp(-(p.linear[i] + (left + right)) / p.diagonal[i], i)
            };
            if n == 1 {
                to[0] = row(0.0, 0.0, 0);
                continue;
            }
            to[0] = row(0.0, p.off_diagonal[0] * from[1], 0);
            for i in 1..n - 1 {
                let left = p.off_diagonal[i - 1] * from[i - 1];
                to[i] = row(left, p.off_diagonal[i] * from[i + 1], i);
            }
            to[n - 1] = row(p.off_diagonal[n - 2] * from[n - 2], 0.0, n - 1);
        }
        for i in 0..n {
            let (l, u) = (p.lower[i], p.upper[i]);
            // An infinite bound is none, whatever the sweeps made of x.
            let low = (self.x[i] <= l) & (l > f64::NEG_INFINITY);
            let high = (self.x[i] >= u) & (u < f64::INFINITY);
            let upper = if high { Place::Upper } else { Place::Free };
            self.place[i] = if low | (l == u) { Place::Lower } else { upper };
        }
    }

    /// Projected Gauss–Seidel from the clamped iterate; leaves `place` at the active set it finds.
    fn gauss_seidel(&mut self) {
        let p = self.program;
        let n = self.x.len();
        for i in 0..n {
            self.x[i] = self.x[i].max(p.lower[i]).min(p.upper[i]);
        }
        for sweep in 0..SWEEPS {
            for k in 0..n {
                let i = if sweep % 2 == 0 { k } else { n - 1 - k };
                let (g, _) = gradient(p, &self.x, i);
                let x = self.x[i] - g / p.diagonal[i];
                self.x[i] = x.max(p.lower[i]).min(p.upper[i]);
            }
        }
        for i in 0..n {
            let g = gradient(p, &self.x, i).0;
            self.place[i] = if p.lower[i] == p.upper[i] || (self.x[i] <= p.lower[i] && g > 0.0) {
                Place::Lower
            } else if self.x[i] >= p.upper[i] && g < 0.0 {
                Place::Upper
            } else {
                Place::Free
            };
        }
    }
}

#[cfg(test)]
mod tests {
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
        let x: Vec<f64> =
            (0..n).map(|_| (rng.next() - 0.5) * 10f64.powf(4.0 * rng.next())).collect();
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
        assert_eq!(solve(&program).unwrap_err().to_string(), "lower[1] = 2 is above upper[1] = 1");
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
}
