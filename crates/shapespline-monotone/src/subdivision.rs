//! Non-negativity of the derivative as linear conditions on dyadic parts of a segment.
//!
//! On a part of [0, 1] the Bernstein coefficients of the quartic are fixed non-negative combinations of those on the
//! whole, so "all coefficients ≥ 0" on the halves of a part is implied by the same on the part: subdivision only
//! relaxes, and a point that satisfies the conditions strictly satisfies the refined ones strictly.

use std::sync::OnceLock;

/// Deepest level: parts of length 2⁻⁵.
pub(crate) const DEEPEST: u8 = 5;

/// A part: level ℓ and index k stand for [k/2^ℓ, (k+1)/2^ℓ]; stored as 2^ℓ + k.
pub(crate) type Part = u8;

/// The conditions of one part.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Conditions {
    /// Rows from the segment's Bernstein coefficients to the part's.
    pub(crate) value: [[f64; 5]; 5],
    /// The same rows in the unknowns (a₀, b₀, a₁, b₁); for the tests' reference.
    #[cfg_attr(not(test), allow(dead_code))]
    pub(crate) gradient: [[f64; 4]; 5],
    /// Coefficients 1…4 of `value`, by columns.
    pub(crate) by_coefficient: [[f64; 4]; 5],
    /// Coefficients 1…4 of `gradient`, by columns.
    pub(crate) by_unknown: [[f64; 4]; 4],
}

/// Level of a part.
#[inline]
pub(crate) fn level(part: Part) -> u8 {
    (7 - part.leading_zeros()) as u8
}

/// The conditions of all parts, indexed by [`Part`] (entry 0 unused).
pub(crate) fn table() -> &'static [Conditions] {
    static TABLE: OnceLock<Vec<Conditions>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut table = vec![Conditions {
            value: [[0.0; 5]; 5],
            gradient: [[0.0; 4]; 5],
            by_coefficient: [[0.0; 4]; 5],
            by_unknown: [[0.0; 4]; 4],
        }];
        for part in 1u16..(2 << DEEPEST) {
            let mut value = [[0.0; 5]; 5];
            if part == 1 {
                for (k, row) in value.iter_mut().enumerate() {
                    row[k] = 1.0;
                }
            } else {
                let parent = table[usize::from(part / 2)].value;
                value = half(&parent, part % 2 == 1);
            }
            let gradient = value.map(|w| {
                [w[0] + w[1] - 2.0 * w[2], w[1] - w[2], w[3] + w[4] - 2.0 * w[2], w[2] - w[3]]
            });
            let by_coefficient = std::array::from_fn(|k| std::array::from_fn(|j| value[j + 1][k]));
            let by_unknown = std::array::from_fn(|k| std::array::from_fn(|j| gradient[j + 1][k]));
            table.push(Conditions { value, gradient, by_coefficient, by_unknown });
        }
        table
    })
}

/// Rows of one half of a part (de Casteljau at its middle): the left half has the first, the right half the last
/// entries of the successive averages.
fn half(rows: &[[f64; 5]; 5], right: bool) -> [[f64; 5]; 5] {
    let mut rest = *rows;
    let mut out = [[0.0; 5]; 5];
    for k in 0..5 {
        let keep = 4 - k;
        if right {
            out[keep] = rest[keep];
        } else {
            out[k] = rest[0];
        }
        for j in 0..keep {
            for c in 0..5 {
                rest[j][c] = 0.5 * (rest[j][c] + rest[j + 1][c]);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quartic_form::{basis, dot};

    #[test]
    fn parts_reproduce_the_polynomial() {
        let c = [0.3, -1.0, 2.0, 0.7, 5.0];
        let table = table();
        for part in 1..=u8::MAX >> 2 {
            let l = level(part);
            let (count, index) = (1 << l, part - (1 << l));
            let own = table[usize::from(part)].value.map(|row| dot(&c, &row));
            for k in 0..=4 {
                let local = f64::from(k) / 4.0;
                let t = (f64::from(index) + local) / f64::from(count);
                assert!((dot(&own, &basis(local)) - dot(&c, &basis(t))).abs() < 1e-14);
            }
        }
    }
}
