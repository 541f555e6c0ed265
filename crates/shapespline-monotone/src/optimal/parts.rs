//! Conditions on parts of a segment, for the references of the tests.

/// Bernstein coefficients 1…4 on [l, r] as weights of those on [0, 1]: coefficient j is the polar value at l (4 − j
/// times) and r (j times).
#[inline]
pub(crate) fn rows(l: f64, r: f64) -> [[f64; 5]; 4] {
    let (m, q) = (1.0 - l, 1.0 - r);
    let cubes = |u: f64, t: f64| [u * u * u, 3.0 * (u * u * t), 3.0 * (u * t * t), t * t * t];
    // A cubic and a linear factor.
    let mixed = |a: [f64; 4], u: f64, t: f64| {
        [a[0] * u, a[1] * u + a[0] * t, a[2] * u + a[1] * t, a[3] * u + a[2] * t, a[3] * t]
    };
    let (a, b) = ([m * m, 2.0 * (m * l), l * l], [q * q, 2.0 * (q * r), r * r]);
    let right = cubes(q, r);
    [
        mixed(cubes(m, l), q, r),
        [
            a[0] * b[0],
            a[0] * b[1] + a[1] * b[0],
            (a[0] * b[2] + a[2] * b[0]) + a[1] * b[1],
            a[1] * b[2] + a[2] * b[1],
            a[2] * b[2],
        ],
        mixed(right, m, l),
        mixed(right, q, r),
    ]
}

/// The gradient of a row in the segment's unknowns (d₀/Δ, h s₀/4Δ, d₁/Δ, h s₁/4Δ); its constant is 5w₂.
#[inline]
pub(crate) fn gradient(w: &[f64; 5]) -> [f64; 4] {
    [w[0] + w[1] - 2.0 * w[2], w[1] - w[2], w[3] + w[4] - 2.0 * w[2], w[2] - w[3]]
}
