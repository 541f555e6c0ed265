// SPDX-License-Identifier: MIT OR Apache-2.0

//! A piecewise cubic run through in another parameter.

use glam::DVec3;

use crate::{
    Curve, InputError, MonotoneCubic, PiecewiseCubic, Side,
    evaluate_many::{Evaluate, Locals, check_rows},
    reparametrization::Batch,
};

/// The image of a piecewise cubic `C`, run through as `Q(s) = C(t(s))`, where on each segment
/// `s(t)` is the cubic from `s_i` to `s_{i+1}` with the slopes `λ⁰_i, λ¹_i ∈ (0, 1]` relative to the
/// linear one ([`MonotoneCubic`]; paper 000, (3.3)).
///
/// Knots, storage, the search for segments and the evaluation are those of the cubic; only the local
/// parameter is another. Outside an open curve the end cubics go on, `t` as its end tangent.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct ReparametrizedCubic {
    cubic: PiecewiseCubic,
    slopes: Vec<[f64; 2]>,
}

/// The stored form, which may come from anywhere: it becomes a curve only if the constructor takes it.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "ReparametrizedCubic")]
struct Stored {
    cubic: PiecewiseCubic,
    slopes: Vec<[f64; 2]>,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for ReparametrizedCubic {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        Self::new(stored.cubic, stored.slopes)
    }
}

/// The highest order of derivative that is offered.
const ORDERS: usize = 3;

impl ReparametrizedCubic {
    /// The curve of a cubic and `[λ⁰, λ¹]` of each segment.
    ///
    /// # Errors
    /// Not one pair a segment; a slope outside `(0, 1]`.
    pub fn new(cubic: PiecewiseCubic, slopes: Vec<[f64; 2]>) -> Result<Self, InputError> {
        let (expected, found) = (cubic.segments(), slopes.len());
        if expected != found {
            let per = "one pair for each segment";
            return Err(InputError::Length { argument: "slopes", expected, found, per });
        }
        let valid = |x: &f64| (*x > 0.0) & (*x <= 1.0);
        // Counted first, several at once: mostly there are none to be found.
        let wrong: u64 = slopes.as_flattened().iter().map(|x| u64::from(!valid(x))).sum();
        if wrong > 0
            && let Some(at) = slopes.as_flattened().iter().position(|x| !valid(x))
        {
            let (argument, allowed) = ("slopes", "in (0, 1]");
            let (index, value) = (at / 2, slopes.as_flattened()[at]);
            return Err(InputError::OutOfRange { argument, index, value, allowed });
        }
        Ok(Self { cubic, slopes })
    }

    /// `[λ⁰, λ¹]` of each segment.
    #[must_use]
    pub fn slopes(&self) -> &[[f64; 2]] {
        &self.slopes
    }

    #[inline]
    fn map(&self, i: usize) -> MonotoneCubic {
        let [start, end] = self.slopes[i];
        MonotoneCubic { start, end }
    }

    /// `[1 − t, t]` of a parameter inside segment `i`.
    #[inline]
    fn local(&self, i: usize, s: f64) -> [f64; 2] {
        let knots = self.cubic.knots();
        let reciprocal = 1.0 / (knots[i + 1] - knots[i]);
        // Both from their own end, so that the curve run through backwards is the same.
        self.map(i).solve([(s - knots[i]) * reciprocal, (knots[i + 1] - s) * reciprocal])
    }

    /// Derivative with respect to `s` on segment `i` at `[1 − t, t]`, by the chain rule.
    #[inline(always)]
    fn derivative_at<const ORDER: usize>(&self, i: usize, [s, t]: [f64; 2]) -> DVec3 {
        if ORDER == 0 {
            return self.cubic.derivative_at::<0>(i, [s, t]);
        }
        let knots = self.cubic.knots();
        let per_h = 1.0 / (knots[i + 1] - knots[i]);
        // C' = Q' x', C'' = Q'' x'² + Q' x'', C''' = Q''' x'³ + 3 Q'' x' x'' + Q' x''', where C is
        // differentiated by the linear parameter. Beyond the ends x is linear.
        let [speed, second, third] = if s < 0.0 {
            [self.slopes[i][1], 0.0, 0.0]
        } else if t < 0.0 {
            [self.slopes[i][0], 0.0, 0.0]
        } else {
            self.map(i).derivatives([s, t])
        };
        let per = 1.0 / speed;
        let q1 = self.cubic.derivative_at::<1>(i, [s, t]) * per;
        if ORDER == 1 {
            return q1;
        }
        let bend = second * per_h * per;
        let q2 = (self.cubic.derivative_at::<2>(i, [s, t]) * per - q1 * bend) * per;
        if ORDER == 2 {
            return q2;
        }
        let third = third * per_h * per * per_h;
        let c3 = self.cubic.derivative_at::<3>(i, [s, t]) * per;
        ((c3 - q1 * third) * per - q2 * (3.0 * bend)) * per
    }
}

impl Evaluate for ReparametrizedCubic {
    fn image(&self) -> &PiecewiseCubic {
        &self.cubic
    }

    #[inline(always)]
    fn locals(&self, segment: impl Fn(usize) -> usize, u: &[f64], out: &mut Locals) {
        let mut batch = Batch::default();
        let knots = self.cubic.knots();
        for (j, &s) in u.iter().enumerate() {
            let i = segment(j);
            let reciprocal = 1.0 / (knots[i + 1] - knots[i]);
            let value = [(s - knots[i]) * reciprocal, (knots[i + 1] - s) * reciprocal];
            batch.put(j, self.map(i), value);
        }
        batch.solve(out);
    }

    #[inline(always)]
    fn derivative<const ORDER: usize>(&self, segment: usize, local: [f64; 2]) -> DVec3 {
        self.derivative_at::<ORDER>(segment, local)
    }
}

impl Curve for ReparametrizedCubic {
    fn cubic(&self) -> &PiecewiseCubic {
        &self.cubic
    }

    fn locate(&self, u: f64, side: Side) -> (usize, f64) {
        let (i, u) = self.cubic.find(u, side);
        (i, self.local(i, u)[1])
    }

    fn parameter(&self, segment: usize, t: f64) -> f64 {
        self.cubic.parameter(segment, self.map(segment).value(t))
    }

    /// Orders above three are not offered: they give NaN.
    fn evaluate(&self, u: f64, order: usize, side: Side) -> DVec3 {
        let (i, u) = self.cubic.find(u, side);
        let u = self.local(i, u);
        match order {
            0 => self.derivative_at::<0>(i, u),
            1 => self.derivative_at::<1>(i, u),
            2 => self.derivative_at::<2>(i, u),
            3 => self.derivative_at::<3>(i, u),
            _ => DVec3::NAN,
        }
    }

    fn evaluate_into(
        &self,
        u: &[f64],
        order: usize,
        side: Side,
        out: &mut [f64],
    ) -> Result<(), InputError> {
        check_rows(&self.cubic, u, out)?;
        match order {
            0 => self.values::<0>(u, side, out),
            1 => self.values::<1>(u, side, out),
            2 => self.values::<2>(u, side, out),
            ORDERS => self.values::<3>(u, side, out),
            _ => {
                return Err(InputError::Scalar {
                    argument: "nu",
                    value: order as f64,
                    allowed: "at most 3 in the C² parameter",
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ArcLength, Dimension, Domain};

    fn wavy(slopes: Vec<[f64; 2]>) -> ReparametrizedCubic {
        let knots = vec![0.0, 1.0, 1.5, 4.0];
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 2.0, 0.5), DVec3::ONE];
        let legs = vec![
            [DVec3::new(0.1, 0.3, 0.0), DVec3::new(0.2, 0.1, 0.2)],
            [DVec3::new(0.3, 0.1, 0.1), DVec3::new(-0.1, 0.2, 0.1)],
            [DVec3::new(-0.1, 0.1, 0.1), DVec3::new(0.4, -0.2, 0.3)],
        ];
        let cubic =
            PiecewiseCubic::new(knots, points, legs, Dimension::Three, Domain::Open).unwrap();
        ReparametrizedCubic::new(cubic, slopes).unwrap()
    }

    #[test]
    fn slopes_of_one_change_nothing() {
        let curve = wavy(vec![[1.0; 2]; 3]);
        for k in -4..=44 {
            let u = 0.1 * f64::from(k);
            for order in 0..4 {
                let (a, b) = (curve.evaluate(u, order, Side::Right), curve.cubic());
                let b = b.evaluate(u, order, Side::Right);
                assert!((a - b).length() <= 1e-12 * (1.0 + b.length()), "{u} {order}: {a} {b}");
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_differences_and_many_are_as_one() {
        let curve = wavy(vec![[0.5, 0.2], [1.0, 0.03], [0.4, 0.9]]);
        let step = 1e-5;
        let queries: Vec<f64> = (1..400).map(|k| 0.01 * f64::from(k) + 0.003).collect();
        for order in 0..=3 {
            let out = curve.evaluate_many(&queries, order, Side::Right).unwrap();
            for (&u, row) in queries.iter().zip(out.chunks(3)) {
                let value = curve.evaluate(u, order, Side::Right);
                assert_eq!(value, DVec3::from_slice(row));
                if order == 0 {
                    continue;
                }
                let at = |u| curve.evaluate(u, order - 1, Side::Right);
                let difference = (at(u + step) - at(u - step)) / (2.0 * step);
                let size = curve.evaluate(u, order, Side::Right).length() + 1.0;
                assert!((value - difference).length() < 2e-4 * size * size, "{u} {order}");
            }
        }
        assert!(curve.evaluate_many(&[0.0], 4, Side::Right).is_err());
    }

    #[test]
    fn the_image_and_its_length_are_those_of_the_cubic() {
        let curve = wavy(vec![[0.5, 0.2], [1.0, 0.03], [0.4, 0.9]]);
        let (length, own) = (ArcLength::new(curve.cubic()), ArcLength::new(&curve));
        assert_eq!(length.total(), own.total());
        for k in 0..=40 {
            let part = own.total() * f64::from(k) / 40.0;
            let (a, b) = (length.parameter(part), own.parameter(part));
            let a = curve.cubic().evaluate(a, 0, Side::Right);
            assert!((a - curve.evaluate(b, 0, Side::Right)).length() < 1e-13);
            assert!((own.upto(b) - part).abs() < 1e-12);
        }
        for (i, &u) in curve.cubic().knots().iter().enumerate() {
            for side in [Side::Left, Side::Right] {
                assert_eq!(curve.evaluate(u, 0, side), curve.cubic().points()[i]);
            }
        }
    }

    #[test]
    fn slopes_out_of_range_are_refused() {
        let cubic = || wavy(vec![[1.0; 2]; 3]).cubic().clone();
        let refused = |slopes| ReparametrizedCubic::new(cubic(), slopes).unwrap_err().to_string();
        assert!(refused(vec![[1.0; 2]; 2]).contains("length 3"));
        assert!(refused(vec![[1.0; 2], [1.0, 0.0], [1.0; 2]]).contains("slopes[1]"));
        assert!(refused(vec![[1.0; 2], [1.0; 2], [f64::NAN, 1.0]]).contains("NaN"));
    }
}
