// SPDX-License-Identifier: MIT OR Apache-2.0

//! Does a function keep the monotonicity and the convexity of its data? Any piecewise polynomial's.
//!
//! The signs of f′ and f″ are decided on their Bernstein form: the least coefficient bounds a polynomial from below,
//! the end coefficients are values of it, and halving brings the two together quadratically. Nothing is sampled, so a
//! dip between two points is found however narrow it is.

use std::ops::Range;

use shapespline_polynomial::bernstein::{derivative, part, split, value};

use crate::{
    Convexity, MonotoneError,
    data::{Data, check_finite, parts},
};

/// How far the function may be from the data, jump, or begin and end beside them, relative to their extents.
const INTERPOLATION: f64 = 1e-9;
/// Relative differences of secants up to which points are collinear.
const COLLINEAR: f64 = 1e-9;
/// Halvings after which the parts of a polynomial are as short as doubles are apart.
const HALVINGS: usize = 60;

/// A criterion on a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MonotoneRecord {
    /// The segment.
    pub segment: usize,
    /// Whether the criterion holds; `None` where rounding hides it.
    pub satisfied: Option<bool>,
    /// The least value of f′ relative to the secant, or of f″ in the direction asked relative to the changes of the
    /// secants beside the segment; on a level segment minus the distance from the level relative to the extent of y.
    pub margin: f64,
    /// The x of the least value.
    pub location: f64,
}

/// Whether a function rises, falls and bends as its data do.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MonotoneReport {
    /// The margin that counts as zero.
    pub tolerance: f64,
    /// A record per segment.
    pub monotonicity: Vec<MonotoneRecord>,
    /// A record per segment of which a sign of f″ is asked; `None` where convexity was not asked.
    pub convexity: Option<Vec<MonotoneRecord>>,
}

impl MonotoneReport {
    /// The criteria that were asked, with their records by segment.
    pub fn criteria(&self) -> impl Iterator<Item = (&'static str, &[MonotoneRecord])> {
        let convexity = self.convexity.as_deref().map(|records| ("convexity", records));
        std::iter::once(("monotonicity", &self.monotonicity[..])).chain(convexity)
    }
}

/// Decide where a function rises, falls and bends as its data do. O(N).
///
/// The function is a polynomial between `breaks`; `coefficients` are those of its Bernstein form, as many per piece.
/// Of `convexity`, [`Convexity::Data`] asks for the sign of the data's second differences wherever it is the same at
/// both ends of a segment.
///
/// # Errors
/// Unusable data, breaks, coefficients or signs; a function that jumps or does not run through the data.
pub fn check_monotone(
    x: &[f64],
    y: &[f64],
    breaks: &[f64],
    coefficients: &[f64],
    convexity: Option<&Convexity>,
    tolerance: f64,
) -> Result<MonotoneReport, MonotoneError> {
    if !(tolerance >= 0.0) {
        let rule = "must not be negative";
        return Err(MonotoneError::Number { argument: "tolerance", value: tolerance, rule });
    }
    let data = Data::new(x, y)?;
    let function = Function::new(x, y, breaks, coefficients, &data)?;
    function.runs_through_the_data()?;
    let signs = convexity.map(|convexity| signs(convexity, &data)).transpose()?;
    let every = |of: &(dyn Fn(usize) -> MonotoneRecord + Sync)| {
        parts(data.len(), |part: Range<usize>| part.map(of).collect::<Vec<_>>()).concat()
    };
    let monotonicity = every(&|i| function.monotonicity(i, tolerance));
    let convexity = signs.map(|signs| {
        let asked: Vec<usize> = (0..data.len()).filter(|&i| signs[i] != 0).collect();
        let record = |i: &usize| function.convexity(*i, f64::from(signs[*i]), tolerance);
        asked.iter().map(record).collect()
    });
    Ok(MonotoneReport { tolerance, monotonicity, convexity })
}

/// The signs asked of f″ on the segments.
fn signs(convexity: &Convexity, data: &Data) -> Result<Vec<i8>, MonotoneError> {
    let n = data.len();
    match convexity {
        Convexity::Signs(signs) if signs.len() != n => {
            Err(MonotoneError::Length { argument: "convex", found: signs.len(), expected: n })
        }
        Convexity::Signs(signs) => match signs.iter().position(|sign| !(-1..=1).contains(sign)) {
            Some(index) => {
                let (value, rule) = (signs[index], "must be -1, 0 or 1");
                Err(MonotoneError::Convex { index, value, rule })
            }
            None => Ok(signs.clone()),
        },
        Convexity::Data => {
            let turn = |i: usize| {
                let [a, b] = [data.delta[i - 1], data.delta[i]];
                let straight = (b - a).abs() <= COLLINEAR * (a.abs() + b.abs());
                if straight { 0 } else { (b - a).signum() as i8 }
            };
            // At the first and the last point nothing turns: they take their neighbours' sign.
            let at = |node: usize| if n > 1 { turn(node.clamp(1, n - 1)) } else { 0 };
            Ok((0..n).map(|i| if at(i) == at(i + 1) { at(i) } else { 0 }).collect())
        }
    }
}

/// The function, its data, and the units in which nothing over- or underflows.
struct Function<'a> {
    x: &'a [f64],
    y: &'a [f64],
    breaks: &'a [f64],
    /// Of each piece, in scaled units.
    coefficients: Vec<f64>,
    order: usize,
    data: &'a Data,
    /// Of y, in scaled units: what distances from the data are relative to.
    extent: f64,
    /// Bound of the rounding of a value, in scaled units.
    rounding: f64,
}

impl<'a> Function<'a> {
    fn new(
        x: &'a [f64],
        y: &'a [f64],
        breaks: &'a [f64],
        coefficients: &[f64],
        data: &'a Data,
    ) -> Result<Self, MonotoneError> {
        check_finite("breaks", breaks)?;
        check_finite("coefficients", coefficients)?;
        let pieces = breaks.len().saturating_sub(1).max(1);
        if breaks.len() < 2 {
            let found = breaks.len();
            return Err(MonotoneError::TooFew { argument: "breaks", found, needed: 2 });
        }
        if let Some(i) = breaks.windows(2).position(|w| !(w[0] < w[1])) {
            let (value, rule) = (breaks[i + 1], "must exceed its predecessor");
            return Err(MonotoneError::Entry { argument: "breaks", index: i + 1, value, rule });
        }
        let (order, found) = (coefficients.len() / pieces, coefficients.len());
        if order == 0 || found != order * pieces {
            let expected = order.max(1) * pieces;
            return Err(MonotoneError::Length { argument: "coefficients", found, expected });
        }
        let rise = data.units().rise();
        let coefficients: Vec<f64> = coefficients.iter().map(|c| rise.scale(*c)).collect();
        let most =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, v| m.max(v.abs()));
        let largest = most(&mut coefficients.iter().copied());
        // Of constant data their own size, of zeros the function's: never one that depends on units.
        let [low, high] =
            [f64::min, f64::max].map(|of| y.iter().copied().reduce(of).unwrap_or(0.0));
        let sizes = [rise.scale(high - low), rise.scale(low.abs()), largest, 1.0];
        let extent = sizes.into_iter().find(|size| *size > 0.0).unwrap_or(1.0);
        let rounding = 4.0 * order as f64 * f64::EPSILON * largest;
        Ok(Self { x, y, breaks, coefficients, order, data, extent, rounding })
    }

    fn piece(&self, k: usize) -> &[f64] {
        &self.coefficients[k * self.order..][..self.order]
    }

    /// The piece at an x, the right one of two.
    fn piece_at(&self, x: f64) -> usize {
        self.breaks[1..self.breaks.len() - 1].partition_point(|b| *b <= x)
    }

    /// The place of an x in a piece.
    fn local(&self, k: usize, x: f64) -> f64 {
        ((x - self.breaks[k]) / (self.breaks[k + 1] - self.breaks[k])).clamp(0.0, 1.0)
    }

    fn runs_through_the_data(&self) -> Result<(), MonotoneError> {
        let (x, breaks) = (self.x, self.breaks);
        let [from, to, first, last] = [breaks[0], breaks[breaks.len() - 1], x[0], x[x.len() - 1]];
        let beside = INTERPOLATION * (last - first);
        if (from - first).abs() > beside || (to - last).abs() > beside {
            return Err(MonotoneError::Domain { from, to, first, last });
        }
        let (apart, rise) = (INTERPOLATION * self.extent, self.data.units().rise());
        for k in 1..breaks.len() - 1 {
            if !((self.piece(k)[0] - self.piece(k - 1)[self.order - 1]).abs() <= apart) {
                return Err(MonotoneError::Jump { x: breaks[k] });
            }
        }
        for (index, (&at, &y)) in x.iter().zip(self.y).enumerate() {
            let k = self.piece_at(at);
            let value = value(self.piece(k), self.local(k, at));
            let distance = (value - rise.scale(y)).abs();
            if !(distance <= apart) {
                let distance = self.data.units().y().scale(distance);
                return Err(MonotoneError::NotThrough { index, x: at, distance });
            }
        }
        Ok(())
    }

    /// The pieces on a segment, each with its ends there.
    fn pieces(&self, i: usize) -> impl Iterator<Item = (usize, [f64; 2])> {
        let [from, to] = [self.x[i], self.x[i + 1]];
        let last = self.breaks.len() - 2;
        (self.piece_at(from)..=last)
            .map(move |k| {
                let start = if k == 0 { from } else { from.max(self.breaks[k]) };
                (k, [start, if k == last { to } else { to.min(self.breaks[k + 1]) }])
            })
            .take_while(move |(k, ends)| *k == 0 || ends[0] < to)
            .filter(|(_, ends)| ends[0] < ends[1])
    }

    /// A part of a polynomial on a piece.
    fn cell(&self, k: usize, ends: [f64; 2], polynomial: &[f64], rounding: f64) -> Cell {
        let own = ends.map(|x| self.local(k, x));
        let cut = if own == [0.0, 1.0] { 0.0 } else { cutting(polynomial) };
        Cell { c: part(polynomial.to_vec(), own), ends, rounding, cut }
    }

    /// The width of a piece in scaled units.
    fn width(&self, k: usize) -> f64 {
        self.data.units().spacing().scale(self.breaks[k + 1] - self.breaks[k])
    }

    fn monotonicity(&self, segment: usize, tolerance: f64) -> MonotoneRecord {
        let (secant, degree) = (self.data.delta[segment], (self.order - 1) as f64);
        if secant == 0.0 {
            return self.level(segment, tolerance);
        }
        let cells = self.pieces(segment).map(|(k, ends)| {
            let unit = self.width(k) * secant;
            let slope: Vec<f64> = derivative(self.piece(k)).iter().map(|c| c / unit).collect();
            self.cell(k, ends, &slope, degree * self.rounding / unit.abs())
        });
        Least::of(cells.collect(), self.x[segment], tolerance).record(segment, tolerance)
    }

    fn level(&self, segment: usize, tolerance: f64) -> MonotoneRecord {
        let level = self.data.units().rise().scale(self.y[segment]);
        let cells = self.pieces(segment).flat_map(|(k, ends)| {
            let distance = |of: &dyn Fn(f64) -> f64| {
                let c: Vec<f64> = self.piece(k).iter().map(|c| of(*c) / self.extent).collect();
                self.cell(k, ends, &c, self.rounding / self.extent)
            };
            [distance(&|c| level - c), distance(&|c| c - level)]
        });
        Least::of(cells.collect(), self.x[segment], tolerance).record(segment, tolerance)
    }

    fn convexity(&self, segment: usize, sign: f64, tolerance: f64) -> MonotoneRecord {
        let (h, secant) = (&self.data.h, &self.data.delta);
        let change = |i: usize| (secant[i] - secant[i - 1]).abs();
        let before = if segment > 0 { change(segment) } else { 0.0 };
        let behind = if segment + 1 < secant.len() { change(segment + 1) } else { 0.0 };
        // Of straight data the slope, of level ones that of their extent.
        let sizes = [before + behind, secant[segment].abs(), self.extent / h[segment]];
        let size = sizes.into_iter().find(|size| *size > 0.0).unwrap_or(1.0);
        let degree = (self.order - 1) as f64;
        let cells = self.pieces(segment).map(|(k, ends)| {
            let width = self.width(k);
            let unit = sign * size * width * (width / h[segment]);
            let second = derivative(&derivative(self.piece(k)));
            let second: Vec<f64> = second.iter().map(|c| c / unit).collect();
            self.cell(k, ends, &second, 4.0 * degree * degree * self.rounding / unit.abs())
        });
        Least::of(cells.collect(), self.x[segment], tolerance).record(segment, tolerance)
    }
}

/// A polynomial on a part of a segment, in Bernstein form.
struct Cell {
    c: Vec<f64>,
    ends: [f64; 2],
    /// Bound of the rounding of its values.
    rounding: f64,
    /// Bound of the rounding of the cuts it comes from; without one the signs of its coefficients are exact.
    cut: f64,
}

/// Bound of the rounding of cutting a polynomial.
fn cutting(c: &[f64]) -> f64 {
    4.0 * c.len() as f64 * f64::EPSILON * c.iter().fold(0.0, |size: f64, c| size.max(c.abs()))
}

impl Cell {
    /// A bound of the values from below, but for the rounding of cuts.
    fn low(&self) -> f64 {
        self.c.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn halves(&self) -> [Self; 2] {
        let [start, end] = self.ends;
        let middle = f64::midpoint(start, end);
        let cut = self.cut + cutting(&self.c);
        let half = |c, ends| Self { c, ends, rounding: self.rounding, cut };
        let (left, right) = split(self.c.clone(), 0.5);
        [half(left, [start, middle]), half(right, [middle, end])]
    }
}

/// The least value of polynomials.
#[derive(Debug, Clone, Copy)]
struct Least {
    margin: f64,
    location: f64,
    /// No value is less.
    low: f64,
    /// The least value and bound of its rounding: what is certain to be reached.
    certain: f64,
}

impl Least {
    /// Halves the parts on which the least value could be smaller than the least so far, by more than it counts.
    fn of(mut cells: Vec<Cell>, start: f64, tolerance: f64) -> Self {
        let (margin, location) = (f64::INFINITY, start);
        let mut least = Self { margin, location, low: f64::INFINITY, certain: f64::INFINITY };
        if cells.iter().flat_map(|cell| &cell.c).any(|c| !c.is_finite()) {
            return Self { margin: f64::NAN, ..least };
        }
        for halving in 0..=HALVINGS {
            for side in [0, 1] {
                cells.iter().for_each(|cell| least.lower(cell, side));
            }
            cells.retain(|cell| least.could_fall(cell, tolerance));
            if halving == HALVINGS {
                cells.iter().for_each(|cell| least.low = least.low.min(cell.low() - cell.cut));
                break;
            }
            if cells.is_empty() {
                break;
            }
            let (left, right): (Vec<_>, Vec<_>) =
                cells.iter().map(|cell| cell.halves().into()).unzip();
            cells = left;
            cells.extend(right);
        }
        least
    }

    /// Notes a value at an end of a part.
    fn lower(&mut self, cell: &Cell, side: usize) {
        let value = cell.c[side * (cell.c.len() - 1)];
        if value <= self.margin {
            (self.margin, self.location) = (value, cell.ends[side]);
        }
        self.certain = self.certain.min(value + cell.rounding);
    }

    /// Whether a part could have a value that counts; if not, its bound from below is noted.
    fn could_fall(&mut self, cell: &Cell, tolerance: f64) -> bool {
        let (low, cut) = (cell.low(), cell.cut);
        // The rounding of cutting alone must not keep parts alive.
        let counts = (0.1 * tolerance).max(cut);
        let open = low < -tolerance && -tolerance <= self.margin && low < self.margin - cut;
        let falls = low < self.margin - counts || low + cell.rounding < self.certain - counts;
        if !(falls || open) {
            self.low = self.low.min(low - cut);
        }
        falls || open
    }

    fn record(self, segment: usize, tolerance: f64) -> MonotoneRecord {
        let Self { margin, location, low, certain } = self;
        let satisfied =
            if certain < -tolerance { Some(false) } else { (low >= -tolerance).then_some(true) };
        MonotoneRecord { segment, satisfied, margin, location }
    }
}
