// SPDX-License-Identifier: MIT OR Apache-2.0

//! The curve.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    ops::ControlFlow,
    sync::{Mutex, PoisonError},
};

use shapespline_criteria::{
    Checker, Criteria, Criterion, CurveChecker, INTERPOLATION, ShapeReport, Tolerances,
};
use shapespline_geometry::{
    Boundary, DVec3, DataPolygon, Dimension, InputError, PiecewiseBezier, PiecewiseCubic, Side,
};

use crate::{
    Constraints, Diagnostics, Energy, FairOptions, Fit, FitError, Method, Status, Step,
    constraints::Part,
    control::{Control, Watch},
    cubic::Plain,
    element::Node,
    energy,
    export::{Pieces, assemble},
    ladder::{LadderResult, climb, turn, turn_nearly},
    segment::Demands,
    units::{Units, sum},
    window::is_given,
};

/// A C² cubic through points in the plane or in space, with at most two extra knots per segment.
/// Immutable.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct FairSpline {
    /// The curve over all knots.
    curve: PiecewiseCubic,
    /// The knots that are data points, ascending.
    nodes: Vec<usize>,
    /// Points and parameters are stored with the curve.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "boundary", serialize_with = "DataPolygon::serialize_boundary")
    )]
    polygon: DataPolygon,
    energy: Energy,
    /// The points at which it has corners.
    corners: Vec<usize>,
    /// The segments on which it is straight by construction, ascending.
    straight: Vec<usize>,
}

/// The stored form, checked on reading as far as anything could go wrong later.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "FairSpline")]
struct Stored {
    curve: PiecewiseCubic,
    nodes: Vec<usize>,
    boundary: Boundary,
    energy: Energy,
    corners: Vec<usize>,
    straight: Vec<usize>,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for FairSpline {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        let Stored { curve, nodes, boundary, energy, corners, straight } = stored;
        let bad = |index: usize, value: usize| InputError::OutOfRange {
            argument: "nodes",
            index,
            value: value as f64,
            allowed: "indices of knots, from the first to the last, each one to three after the one before",
        };
        let last = curve.knots().len() - 1;
        match (nodes.first(), nodes.last()) {
            (Some(0), Some(&end)) if end == last && nodes.len() > 1 => {}
            _ => return Err(bad(0, nodes.first().copied().unwrap_or(0))),
        }
        let step = |pair: &[usize]| pair[1] <= pair[0] || pair[1] - pair[0] > 3;
        if let Some(i) = nodes.windows(2).position(step) {
            return Err(bad(i + 1, nodes[i + 1]));
        }
        for (argument, all, count, allowed) in [
            ("corners", &corners, nodes.len(), "indices of points"),
            ("straight", &straight, nodes.len() - 1, "indices of segments"),
        ] {
            if let Some(index) = all.iter().position(|&k| k >= count) {
                let value = all[index] as f64;
                return Err(InputError::OutOfRange { argument, index, value, allowed });
            }
        }
        let points = nodes.iter().map(|&k| curve.points()[k]).collect();
        let parameters = nodes.iter().map(|&k| curve.knots()[k]).collect();
        let given = shapespline_geometry::Parametrization::Given(parameters);
        let polygon = DataPolygon::with_dimension(points, curve.dimension(), &given, boundary)?;
        Ok(Self { curve, nodes, polygon, energy, corners, straight })
    }
}

impl FairSpline {
    /// The fair curve through the points of a polygon.
    ///
    /// The fit says how it ended: the curve keeps the criteria if its status is `Solved`. Cost: one
    /// solve and check of the plain cubic, O(N), and then what the failing segments need; with the
    /// bending energy some tens of Newton steps, O(N) each.
    ///
    /// # Errors
    /// Options outside their range; tangents that overflow.
    pub fn fit(polygon: DataPolygon, options: &FairOptions) -> Result<Fit, FitError> {
        Self::fit_with(polygon, options, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`FairSpline::fit`], with a monitor that sees every Newton step and can end the search. On long curves
    /// the steps come from all threads, one at a time, those of one window in order.
    ///
    /// # Errors
    /// As [`FairSpline::fit`].
    pub fn fit_with(
        polygon: DataPolygon,
        options: &FairOptions,
        monitor: &mut (dyn FnMut(&Step) -> ControlFlow<()> + Send),
    ) -> Result<Fit, FitError> {
        options.validate()?;
        let constraints = &options.constraints;
        let mut straight = Vec::new();
        if !constraints.is_empty() {
            constraints.validate(&polygon)?;
            let checker = Checker::new(&polygon, options.criteria, options.tolerances)
                .with_free_nodes(&constraints.corners);
            let runs = constraints.runs(&checker)?;
            constraints.refuse_conflicts(&checker, &runs)?;
            straight = runs.segments;
        }
        let monitor = Mutex::new(monitor);
        let ask = |step: &Step| monitor.lock().unwrap_or_else(PoisonError::into_inner)(step);
        let watch = Watch::new(&ask);
        let mut control = Control::new(options.max_iterations, &watch);
        let mut whole = Whole::of(&polygon);
        for part in constraints.parts(&polygon)? {
            whole.add(&part, options, &mut control)?;
        }
        let (curve, nodes) = assemble(&polygon, whole.legs, whole.others)?;
        let (energy, corners) = (options.energy, constraints.corners.clone());
        let curve = Self { curve, nodes, polygon, energy, corners, straight };
        let report = match whole.report {
            Some(report) => report,
            None => curve.check(options.criteria, options.tolerances)?,
        };
        // What rounding hides in the end could not be widened: the report lists it.
        let proved = report.undecided.is_empty() || !control.is_over();
        let status = match (control.is_interrupted(), report.ok() && proved) {
            (true, _) => Status::Interrupted,
            (_, true) => Status::Solved,
            (_, false) => Status::IterationLimit,
        };
        let diagnostics = Diagnostics {
            status,
            method: whole.method,
            iterations: control.iterations,
            solves: control.solves,
            energy: whole.energy,
            energy_cubic: whole.energy_cubic,
            extra_knots: curve.curve.knots().len() - curve.nodes.len(),
            active: active(&whole.active),
            tangent_scale: whole.tangent_scale,
            turned: whole.turned,
        };
        Ok(Fit { curve, diagnostics, history: control.history, report })
    }

    /// The curve over all its knots: evaluation, arc length, frames, Bézier form.
    #[must_use]
    pub fn curve(&self) -> &PiecewiseCubic {
        &self.curve
    }

    /// The indices of those knots that are data points.
    #[must_use]
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// The end conditions.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.polygon.boundary()
    }

    /// What was minimised.
    #[must_use]
    pub fn energy(&self) -> Energy {
        self.energy
    }

    /// The points at which the curve has corners.
    #[must_use]
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// The segments on which the curve is straight by construction.
    #[must_use]
    pub fn straight(&self) -> &[usize] {
        &self.straight
    }

    /// Planar or spatial.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        self.curve.dimension()
    }

    /// The data points.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        self.polygon.points()
    }

    /// Their parameters.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        self.polygon.parameters()
    }

    /// The first derivatives at the data points.
    #[must_use]
    pub fn tangents(&self) -> Vec<DVec3> {
        let last = self.curve.knots().len() - 1;
        let side = |k: usize| if k == last { Side::Left } else { Side::Right };
        self.nodes.iter().map(|&k| self.curve.evaluate(self.curve.knots()[k], 1, side(k))).collect()
    }

    /// The data: points, parameters and end conditions.
    #[must_use]
    pub fn polygon(&self) -> &DataPolygon {
        &self.polygon
    }

    /// Checks the curve against its own data: every criterion on every piece, exactly. Cost O(N).
    ///
    /// # Errors
    /// Tolerances outside their range.
    pub fn check(
        &self,
        criteria: Criteria,
        tolerances: Tolerances,
    ) -> Result<ShapeReport, InputError> {
        let (polygon, tolerances) = (&self.polygon, tolerances.validate()?);
        let plain = self.corners.is_empty() && self.straight.is_empty();
        if plain && self.nodes.len() == self.curve.knots().len() {
            let legs = self.curve.legs();
            return Ok(Checker::new(polygon, criteria, tolerances).report(|i| legs[i]));
        }
        let curve = PiecewiseBezier::from(&self.curve);
        match CurveChecker::new(polygon, &curve, criteria, tolerances, INTERPOLATION) {
            Ok(checker) => Ok(checker
                .with_free_nodes(&self.corners)
                .with_straight_segments(&self.straight, &self.corners)
                .report()),
            // The curve is made of the points that it is checked against.
            Err(_) => Ok(Checker::new(polygon, criteria, tolerances).report(|_| [DVec3::NAN; 2])),
        }
    }
}

/// The parts of a curve, put together.
struct Whole {
    segments: usize,
    /// End legs of every segment, as the plain cubics have them.
    legs: Vec<[DVec3; 2]>,
    /// The segments that were solved for.
    others: BTreeMap<usize, Pieces>,
    method: Method,
    energy: f64,
    energy_cubic: f64,
    active: Vec<(Criterion, usize)>,
    tangent_scale: [f64; 2],
    /// Nodes at which the curve has another direction than was asked for, and the angle.
    turned: Vec<(usize, f64)>,
    /// The report on the whole, where all of it was proved on the way.
    report: Option<ShapeReport>,
}

impl Whole {
    /// Nothing yet.
    fn of(polygon: &DataPolygon) -> Self {
        Self {
            segments: polygon.segments(),
            legs: Vec::new(),
            others: BTreeMap::new(),
            method: Method::Cubic,
            energy: 0.0,
            energy_cubic: 0.0,
            active: Vec::new(),
            tangent_scale: [1.0; 2],
            turned: Vec::new(),
            report: None,
        }
    }

    /// Notes where the directions of a part are not those that were asked for.
    fn note_turned(
        &mut self,
        first: usize,
        polygon: &DataPolygon,
        [asked, own]: [&[(usize, DVec3)]; 2],
    ) {
        let closed = first + polygon.segments() > self.segments;
        for (&(node, asked), &(_, own)) in asked.iter().zip(own) {
            let angle = asked.cross(own).length().atan2(asked.dot(own));
            if angle > 1e-12 {
                let node = first + node;
                let node =
                    if closed && node >= self.segments { node - self.segments } else { node };
                self.turned.push((node, angle));
            }
        }
        self.turned.sort_unstable_by_key(|turned| turned.0);
    }

    /// Finds the curve of a part, and adds it.
    fn add(
        &mut self,
        part: &Part<'_>,
        options: &FairOptions,
        control: &mut Control<'_>,
    ) -> Result<(), FitError> {
        let total = self.segments;
        let polygon = part.polygon.as_ref();
        let constraints = part.own(&options.constraints, total);
        // What lies near enough by itself is the curve without the limit.
        let unlimited = Constraints { max_deviation: None, ..constraints.clone() };
        let free = Constraints { tangents: Vec::new(), ..unlimited.clone() };
        let plain = Plain::of(polygon)?;
        let checker = Checker::new(polygon, options.criteria, options.tolerances);
        let runs = constraints.runs(&checker)?;
        let checker = checker.with_straight_segments(&runs.segments, &[]);
        let units = Units::of(polygon);
        let (mut constrained, runs) = (&constraints, &runs);
        let mut demands = Demands { checker: &checker, units, constraints: &free, runs };
        let mut found = climb(&demands, &plain, options, control);
        let near;
        if !unlimited.tangents.is_empty() {
            demands.constraints = &unlimited;
            let free = found;
            found = turn(&free, &demands, options, control);
            let contradict = !found.open.is_empty() && free.open.is_empty();
            let nearly = |control| turn_nearly(&free, &found.open, &demands, options, control);
            if let Some((turned, tangents)) = contradict.then(|| nearly(control)).flatten() {
                self.note_turned(part.first, polygon, [&unlimited.tangents, &tangents]);
                found = turned;
                near = Constraints { tangents, ..constraints.clone() };
                constrained = &near;
            }
        }
        demands.constraints = constrained;
        if found.any_deviates(&demands) {
            found = climb(&demands, &plain, options, control);
        }
        let place = |i: usize| (part.first + i) % total;
        self.others.extend(found.solved.keys().map(|&i| (place(i), found.pieces(&demands, i))));
        self.method = self.method.max(found.method);
        let scales = tangent_scale(&demands, &found);
        for (whole, own) in self.tangent_scale.iter_mut().zip(scales) {
            *whole *= own;
        }
        let [energy, energy_cubic] = energies(&demands, &found, options.energy);
        self.energy += energy;
        self.energy_cubic += energy_cubic;
        self.active.extend(found.active().map(|(criterion, i)| (criterion, place(i))));
        if let Cow::Borrowed(_) = part.polygon {
            let proved = found.open.is_empty();
            self.report = proved.then(|| checker.report_of(&[], |i| plain.legs(i)));
            self.legs = plain.all_legs();
        } else {
            self.legs.resize(total, [DVec3::ZERO; 2]);
            (0..polygon.segments()).for_each(|i| self.legs[place(i)] = plain.legs(i));
        }
        Ok(())
    }
}

/// The energies of a curve and of the plain cubic, in the user's units.
fn energies(demands: &Demands<'_>, found: &LadderResult<'_>, energy: Energy) -> [f64; 2] {
    let Units { length, time } = demands.units;
    let of = |i: usize, [start, end]: [Node; 2]| {
        let span = demands.span(i);
        let legs = span.legs(start, end);
        match energy {
            Energy::Parametric => {
                energy::parametric(&span, &legs) * (length / time) * (length / time) / time
            }
            Energy::Bending => energy::bending(&span, &legs) / length,
        }
    };
    let plain = |i: usize| match energy {
        Energy::Parametric => found.plain.energy(i),
        Energy::Bending => of(i, found.plain_nodes(demands, i)),
    };
    let cubic = sum(demands.checker.polygon().segments(), plain);
    let more = found.solved.iter().map(|(&i, own)| of(i, own.nodes) - plain(i)).sum::<f64>();
    [cubic + more, cubic]
}

/// By how much given end tangents were shortened.
fn tangent_scale(demands: &Demands<'_>, found: &LadderResult<'_>) -> [f64; 2] {
    let polygon = demands.checker.polygon();
    [0, 1].map(|end| {
        let i = end * (polygon.segments() - 1);
        if !is_given(polygon, end * polygon.segments()) {
            return 1.0;
        }
        let [own, plain] = [found.nodes(demands, i), found.plain_nodes(demands, i)];
        own[end].q.length() / plain[end].q.length()
    })
}

/// The criteria that hold the curve back, each with its segments.
fn active(all: &[(Criterion, usize)]) -> Vec<(Criterion, Vec<usize>)> {
    let of = |criterion: Criterion| {
        let own = all.iter().filter(|active| active.0 == criterion);
        let mut segments: Vec<usize> = own.map(|active| active.1).collect();
        segments.sort_unstable();
        (criterion, segments)
    };
    Criterion::ALL.into_iter().map(of).filter(|(_, segments)| !segments.is_empty()).collect()
}
