// SPDX-License-Identifier: MIT OR Apache-2.0

//! Piecewise Bézier curves of any degree, polynomial or rational: the form in which curves that were
//! not made here are taken in.

use glam::{DVec3, DVec4};
use shapespline_polynomial::bernstein::{binomials, split, value};

use crate::{
    Dimension, InputError, PiecewiseCubic, bspline::bezier_of_bspline,
    parametrization::check_increasing, vector::power_of_two,
};

/// Bézier pieces of one degree between increasing breaks, held in homogeneous coordinates
/// `(w x, w y, w z, w)`; a polynomial curve has `w = 1` throughout.
///
/// Each piece is run through linearly in its parameter interval. Nothing is asked of how pieces meet.
#[derive(Debug, Clone, PartialEq)]
pub struct PiecewiseBezier {
    breaks: Vec<f64>,
    /// `degree + 1` points a piece.
    control: Vec<DVec4>,
    degree: usize,
    rational: bool,
    dimension: Dimension,
}

/// A part of a piece that lies in an interval.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPart {
    /// Homogeneous control points, relative to the origin asked for.
    pub control: Vec<DVec4>,
    /// Where the part begins and ends, as local parameters of the interval.
    pub local: [f64; 2],
}

/// Least weight over the largest: less has no effect, and products of such weights underflow.
const LEAST_WEIGHT: f64 = 1e-100;

/// Largest degree that is taken: binomial coefficients of products stay exact in f64.
const MAX_DEGREE: usize = 18;

impl PiecewiseBezier {
    /// A polynomial curve from `degree + 1` control points for each interval of the breaks (SciPy's
    /// `BPoly` in two or three dimensions).
    ///
    /// # Errors
    /// Breaks that do not increase, control points of another number, NaN or infinity, a degree of
    /// zero or above 18.
    pub fn new(
        breaks: Vec<f64>,
        control: &[DVec3],
        degree: usize,
        dimension: Dimension,
    ) -> Result<Self, InputError> {
        let control = control.iter().map(|p| p.extend(1.0)).collect();
        Self::homogeneous(breaks, control, degree, dimension, false)
    }

    /// A rational curve: each control point with its weight, which has to be positive. Equal weights divide
    /// out: the curve is polynomial then. Only ratios count, so that extreme weights are scaled.
    ///
    /// # Errors
    /// As [`PiecewiseBezier::new`]; weights of another number, not positive, or below 1e−100 of the largest.
    pub fn rational(
        breaks: Vec<f64>,
        control: &[DVec3],
        weights: &[f64],
        degree: usize,
        dimension: Dimension,
    ) -> Result<Self, InputError> {
        let (control, rational) = weighted(control, weights)?;
        Self::homogeneous(breaks, control, degree, dimension, rational)
    }

    /// From the power basis (SciPy's `PPoly`): piece `i` is `Σ_k c_k (u − breaks[i])^{d−k}`, and its
    /// `degree + 1` vectors stand in that order, highest power first, piece after piece.
    ///
    /// # Errors
    /// As [`PiecewiseBezier::new`].
    pub fn from_power(
        breaks: Vec<f64>,
        coefficients: &[DVec3],
        degree: usize,
        dimension: Dimension,
    ) -> Result<Self, InputError> {
        check_shape(&breaks, coefficients.len(), degree, "coefficients")?;
        let of = |i: usize, k: usize| coefficients[i * (degree + 1) + k];
        Self::from_power_with(breaks, degree, dimension, of)
    }

    /// The same from wherever the coefficients are: `coefficient(i, k)` is `c_k` of piece `i`. Cost
    /// O(N), without another copy of them.
    ///
    /// # Errors
    /// As [`PiecewiseBezier::new`].
    pub fn from_power_with(
        breaks: Vec<f64>,
        degree: usize,
        dimension: Dimension,
        coefficient: impl Fn(usize, usize) -> DVec3,
    ) -> Result<Self, InputError> {
        let pieces = breaks.len().saturating_sub(1);
        let expected = pieces.saturating_mul(degree.saturating_add(1));
        check_shape(&breaks, expected, degree, "coefficients")?;
        let mut control = Vec::with_capacity(pieces * (degree + 1));
        let spacings = breaks.windows(2).map(|w| w[1] - w[0]).enumerate();
        if degree == 3 {
            for (i, h) in spacings {
                let c = [3, 2, 1, 0].map(|k| coefficient(i, k));
                control.extend(cubic_of_powers(c, h).map(|p| p.extend(1.0)));
            }
            return Self::homogeneous(breaks, control, degree, dimension, false);
        }
        let rows: Vec<Vec<f64>> = (0..=degree).map(binomials).collect();
        let (mut scaled, mut points) = (Vec::new(), Vec::new());
        for (i, h) in spacings {
            // In t = (u − u_i)/h the coefficient of t^k is c h^k; B_j = Σ_{k≤j} C(j,k)/C(d,k) c_k.
            scaled.clear();
            let mut power = 1.0;
            for k in (0..=degree).rev() {
                scaled.push(coefficient(i, k) * power);
                power *= h;
            }
            points.clear();
            points.extend((0..=degree).map(|j| {
                // The constant last: it may be far larger than the rest.
                let part = |k: usize| scaled[k] * (rows[j][k] / rows[degree][k]);
                scaled[0] + (1..=j).fold(DVec3::ZERO, |sum, k| sum + part(k))
            }));
            still_ends(&mut points, scaled.iter().fold(DVec3::ZERO, |sum, c| sum + c.abs()));
            control.extend(points.iter().map(|p| p.extend(1.0)));
        }
        Self::homogeneous(breaks, control, degree, dimension, false)
    }

    /// A B-spline of knots `t_0 ≤ … ≤ t_{n+d}` and `n` control points on its base interval
    /// `[t_d, t_n]` (SciPy's `BSpline`), by Boehm's knot insertion.
    ///
    /// # Errors
    /// Knots that decrease or are not `n + d + 1`, an empty base interval, and as
    /// [`PiecewiseBezier::new`].
    pub fn from_bspline(
        knots: &[f64],
        control: &[DVec3],
        degree: usize,
        dimension: Dimension,
    ) -> Result<Self, InputError> {
        let control: Vec<DVec4> = control.iter().map(|p| p.extend(1.0)).collect();
        check_degree(degree)?;
        let (breaks, pieces) = bezier_of_bspline(knots, &control, degree)?;
        Self::homogeneous(breaks, pieces, degree, dimension, false)
    }

    /// A NURBS curve: a B-spline whose control points carry positive weights.
    ///
    /// # Errors
    /// As [`PiecewiseBezier::from_bspline`] and [`PiecewiseBezier::rational`].
    pub fn from_nurbs(
        knots: &[f64],
        control: &[DVec3],
        weights: &[f64],
        degree: usize,
        dimension: Dimension,
    ) -> Result<Self, InputError> {
        let (control, rational) = weighted(control, weights)?;
        check_degree(degree)?;
        let (breaks, pieces) = bezier_of_bspline(knots, &control, degree)?;
        Self::homogeneous(breaks, pieces, degree, dimension, rational)
    }

    /// From control points in homogeneous coordinates `(w x, w y, w z, w)`, as [`Self::piece`] gives
    /// them; the weights of a curve that is not rational are not looked at.
    ///
    /// # Errors
    /// As [`PiecewiseBezier::new`]; a rational curve with weights that are not positive.
    pub fn homogeneous(
        breaks: Vec<f64>,
        control: Vec<DVec4>,
        degree: usize,
        dimension: Dimension,
        rational: bool,
    ) -> Result<Self, InputError> {
        check_shape(&breaks, control.len(), degree, "control")?;
        let not_positive = || control.iter().position(|p| p.w <= 0.0);
        if let Some(index) = rational.then(not_positive).flatten() {
            let (argument, value) = ("weights", control[index].w);
            return Err(InputError::OutOfRange { argument, index, value, allowed: "positive" });
        }
        if let Some(index) = control.iter().position(|p| !p.is_finite()) {
            let entries = control[index].to_array();
            let value = entries.into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
            return Err(InputError::NotFinite { argument: "control", index, value });
        }
        Ok(Self { breaks, control, degree, rational, dimension })
    }

    /// The parameters at the ends of the pieces.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// The degree of the pieces.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Planar or spatial.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Whether the control points carry weights.
    #[must_use]
    pub fn is_rational(&self) -> bool {
        self.rational
    }

    /// Number of pieces.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.breaks.len() - 1
    }

    /// Homogeneous control points of a piece.
    #[must_use]
    pub fn piece(&self, i: usize) -> &[DVec4] {
        let stride = self.degree + 1;
        &self.control[i * stride..(i + 1) * stride]
    }

    /// Position at a parameter (outside the breaks: of the end pieces). Cost O(log N).
    #[must_use]
    pub fn position(&self, u: f64) -> DVec3 {
        let last = self.pieces() - 1;
        let i = self.breaks.partition_point(|&b| b <= u).saturating_sub(1).min(last);
        let t = (u - self.breaks[i]) / (self.breaks[i + 1] - self.breaks[i]);
        let p = value(self.piece(i), t);
        p.truncate() / p.w
    }

    /// The parts of pieces that lie in `[from, to]`, moved so that `origin` is zero. A break closer
    /// to an end of the interval than `1e−12` of its length counts as that end.
    #[must_use]
    pub fn between(&self, [from, to]: [f64; 2], origin: DVec3) -> Vec<BezierPart> {
        let snap = 1e-12 * (to - from);
        let first = self.breaks.partition_point(|&b| b <= from + snap).saturating_sub(1);
        let mut parts = Vec::new();
        for i in first..self.pieces() {
            let [start, end] = [self.breaks[i], self.breaks[i + 1]];
            if start >= to - snap {
                break;
            }
            let mut control: Vec<DVec4> =
                self.piece(i).iter().map(|p| (p.truncate() - origin * p.w).extend(p.w)).collect();
            let (begins, ends) = (start < from - snap, end > to + snap);
            // The later cut first: its parameter is that of the whole piece.
            if ends {
                control = split(control, (to - start) / (end - start)).0;
            }
            if begins {
                let end = if ends { to } else { end };
                control = split(control, (from - start) / (end - start)).1;
            }
            let local = |u: f64| (u - from) / (to - from);
            parts.push(BezierPart {
                control,
                local: [
                    if parts.is_empty() { 0.0 } else { local(start) },
                    if end > to - snap { 1.0 } else { local(end) },
                ],
            });
        }
        parts
    }
}

impl From<&PiecewiseCubic> for PiecewiseBezier {
    fn from(curve: &PiecewiseCubic) -> Self {
        let points = |i| curve.segment(i).bezier_points();
        Self {
            breaks: curve.knots().to_vec(),
            control: (0..curve.segments()).flat_map(points).map(|p| p.extend(1.0)).collect(),
            degree: 3,
            rational: false,
            dimension: curve.dimension(),
        }
    }
}

/// The Bézier points of `c_0 + c_1 u + c_2 u² + c_3 u³` on `[0, h]`.
#[inline]
fn cubic_of_powers([c0, c1, c2, c3]: [DVec3; 4], h: f64) -> [DVec3; 4] {
    let (c1, c2, c3) = (c1 * h, c2 * (h * h), c3 * (h * h * h));
    let third = c1 * (1.0 / 3.0);
    let mut points = [c0, c0 + third, c0 + (third + third + c2 * (1.0 / 3.0)), c0 + (c1 + c2 + c3)];
    still_ends(&mut points, c0.abs() + c1.abs() + c2.abs() + c3.abs());
    points
}

/// Components of the end legs that are rounding beside `size` become zero: a derivative that is zero
/// at an end (common in monotone interpolants) is not to be given a sign by the change of basis.
#[inline]
fn still_ends(points: &mut [DVec3], size: DVec3) {
    let last = points.len() - 1;
    for (end, next) in [(0, 1), (last, last - 1)] {
        let still = (points[next] - points[end]).abs().cmple(size * (4.0 * f64::EPSILON));
        points[next] = DVec3::select(still, points[end], points[next]);
    }
}

/// Control points in homogeneous coordinates, and whether the weights matter.
fn weighted(control: &[DVec3], weights: &[f64]) -> Result<(Vec<DVec4>, bool), InputError> {
    if weights.len() != control.len() {
        let (expected, found) = (control.len(), weights.len());
        let per = "one for each control point";
        return Err(InputError::Length { argument: "weights", expected, found, per });
    }
    if let Some(index) = weights.iter().position(|&w| !(w > 0.0 && w.is_finite())) {
        let (argument, value) = ("weights", weights[index]);
        let allowed = "positive and finite";
        return Err(InputError::OutOfRange { argument, index, value, allowed });
    }
    let largest = weights.iter().copied().fold(0.0, f64::max);
    if let Some(index) = weights.iter().position(|&w| w < LEAST_WEIGHT * largest) {
        let (argument, value) = ("weights", weights[index]);
        let allowed = "at least 1e-100 times the largest";
        return Err(InputError::OutOfRange { argument, index, value, allowed });
    }
    if weights.iter().all(|&w| w == largest) {
        return Ok((control.iter().map(|p| p.extend(1.0)).collect(), false));
    }
    // Far from one, products with the points would overflow or lose digits.
    let far = !(1e-50..=1e50).contains(&largest);
    let scale = if far { power_of_two(largest) } else { 1.0 };
    let weigh = |(&p, &w): (&DVec3, &f64)| (p * (w / scale)).extend(w / scale);
    Ok((control.iter().zip(weights).map(weigh).collect(), true))
}

fn check_degree(degree: usize) -> Result<(), InputError> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    let (argument, value) = ("degree", degree as f64);
    Err(InputError::Scalar { argument, value, allowed: "between 1 and 18" })
}

fn check_shape(
    breaks: &[f64],
    found: usize,
    degree: usize,
    argument: &'static str,
) -> Result<(), InputError> {
    check_degree(degree)?;
    if breaks.len() < 2 {
        let found = breaks.len();
        let (argument, why) = ("breaks", "");
        return Err(InputError::TooFewPoints { argument, needed: 2, found, why });
    }
    check_increasing("breaks", breaks)?;
    let expected = (breaks.len() - 1) * (degree + 1);
    if found != expected {
        let per = "degree + 1 for each interval of the breaks";
        return Err(InputError::Length { argument, expected, found, per });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hermite pieces between random values whose derivative at the end is zero in one component.
    #[test]
    fn a_derivative_of_zero_at_the_end_stays_zero() {
        for i in 0..200 {
            let x = f64::from(i);
            let breaks = vec![10.0, 10.3 + (1.1 * x).sin().abs()];
            let (h, start, slope) = (breaks[1] - breaks[0], 5.0 * (1.7 * x).sin(), x.cos());
            let secant = (2.0 * (0.6 * x).cos() - start) / h;
            let (c3, c2) = ((slope - 2.0 * secant) / (h * h), (3.0 * secant - 2.0 * slope) / h);
            let coefficients = [(c3, 0.0), (c2, 1.0), (slope, 0.0), (start, 0.0)]
                .map(|(y, z)| DVec3::new(0.0, y, z));
            let curve = PiecewiseBezier::from_power(breaks, &coefficients, 3, Dimension::Three);
            let curve = curve.unwrap();
            let p = curve.piece(0);
            assert_eq!(p[3].y, p[2].y, "{i}");
            assert!(p[3].z > p[2].z && p[1].z == p[0].z);
        }
    }
    /// Cubics take a way of their own: the same curve with a leading coefficient of zero does not.
    #[test]
    fn cubics_agree_with_their_powers_at_any_scale() {
        for i in 0..200 {
            let x = f64::from(i);
            let h = 10f64.powi(i % 7 * 20 - 60) * (1.5 + x.sin());
            let vector = |k: f64| {
                let v = DVec3::new((1.3 * x + k).sin(), (0.7 * x - k).cos(), (x * k).sin());
                v / h.powf(k)
            };
            let powers = [3.0, 2.0, 1.0, 0.0].map(vector);
            let breaks = vec![0.0, h];
            let three = Dimension::Three;
            let cubic = PiecewiseBezier::from_power(breaks.clone(), &powers, 3, three).unwrap();
            let raised: Vec<DVec3> = [DVec3::ZERO].into_iter().chain(powers).collect();
            let quartic = PiecewiseBezier::from_power(breaks, &raised, 4, three).unwrap();
            for k in 0..=10 {
                let t = 0.1 * f64::from(k);
                let exact =
                    ((powers[0] * h * t + powers[1]) * h * t + powers[2]) * h * t + powers[3];
                for curve in [&cubic, &quartic] {
                    assert!((curve.position(h * t) - exact).length() < 1e-14, "{i} {t}");
                }
            }
        }
    }
}
