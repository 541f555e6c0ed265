// SPDX-License-Identifier: MIT OR Apache-2.0

//! The ladder on the whole curve: windows, widened where they must be, and the exact check.

use std::collections::{BTreeMap, BTreeSet};

use shapespline_criteria::Criterion;
use shapespline_geometry::{BezierPart, DVec3, DVec4, length, normalize};

use crate::{
    Constraints, Energy, FairOptions, Method, Phase,
    chain::Chain,
    control::Control,
    cubic::Plain,
    element::Node,
    export::Pieces,
    rows::Rules,
    segment::Demands,
    shape::off_chord,
    solve::{LAST, Means, finish, finish_bending, improve, quicken, settle_nearby, solve},
    starts::{replace, restart_all},
    window::{BESIDE, Window, windows},
};

/// What the ladder came to.
#[derive(Clone)]
pub(crate) struct LadderResult<'a> {
    pub(crate) plain: &'a Plain<'a>,
    /// The segments that were solved for; all others are the plain cubic's.
    pub(crate) solved: BTreeMap<usize, Solved>,
    pub(crate) method: Method,
    /// Segments of which the exact check does not prove everything.
    pub(crate) open: BTreeSet<usize>,
}

/// A segment that was solved for.
#[derive(Clone)]
pub(crate) struct Solved {
    /// What was found at its ends.
    pub(crate) nodes: [Node; 2],
    /// The criteria that hold it back.
    pub(crate) binding: Vec<Criterion>,
}

/// The share of a cone's angle that the search stays within.
const CONE: f64 = 0.95;

/// Climbs the ladder as far as the data need.
pub(crate) fn climb<'a>(
    demands: &Demands<'_>,
    plain: &'a Plain<'a>,
    options: &FairOptions,
    control: &mut Control<'_>,
) -> LadderResult<'a> {
    let mut found = LadderResult {
        plain,
        solved: BTreeMap::new(),
        method: Method::Cubic,
        open: BTreeSet::new(),
    };
    let rules = rules(options);
    match options.energy {
        Energy::Parametric => found.open_windows(demands, rules, control),
        Energy::Bending => found.bend(demands, rules, control),
    }
    found
}

/// Turns a curve that keeps the shape into directions that are asked for at some nodes: from where it is if
/// that goes, which it does for those that are near its own; or else by the ladder.
pub(crate) fn turn<'a>(
    free: &LadderResult<'a>,
    demands: &Demands<'_>,
    options: &FairOptions,
    control: &mut Control<'_>,
) -> LadderResult<'a> {
    if free.open.is_empty() {
        let mut found = free.clone();
        if found.turn(demands, options.energy, rules(options), control) {
            return found;
        }
    }
    climb(demands, free.plain, options, control)
}

/// Ways from the directions asked for to the curve's own, tried in turn.
const SHARES: [f64; 9] = [1.0 / 16.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];

/// Turns a curve that keeps the shape as far into the directions asked for as it goes on keeping it: by shares
/// at the nodes around the segments where it did not, and else at all. Returns the directions it has then.
pub(crate) fn turn_nearly<'a>(
    free: &LadderResult<'a>,
    open: &BTreeSet<usize>,
    demands: &Demands<'_>,
    options: &FairOptions,
    control: &mut Control<'_>,
) -> Option<(LadderResult<'a>, Vec<(usize, DVec3)>)> {
    let count = demands.checker.polygon().nodes();
    let is_near = |node: usize| open.iter().any(|&i| (node + count + 1 - i) % count <= 3);
    for everywhere in [false, true] {
        for share in SHARES {
            let between = |&(node, asked): &(usize, DVec3)| {
                if !everywhere && !is_near(node) {
                    return (node, asked);
                }
                let own = normalize(free.node(demands, node).q);
                (node, normalize(asked) * (1.0 - share) + own * share)
            };
            let tangents: Vec<_> = demands.constraints.tangents.iter().map(between).collect();
            let constraints = Constraints { tangents, ..demands.constraints.clone() };
            let demands = Demands { constraints: &constraints, ..*demands };
            let mut found = free.clone();
            if found.turn(&demands, options.energy, rules(options), control) {
                return Some((found, constraints.tangents));
            }
        }
    }
    None
}

fn rules(options: &FairOptions) -> Rules {
    let cone = |epsilon: f64| (CONE * epsilon).asin().tan();
    let tolerances = options.tolerances;
    let cones = [cone(tolerances.coplanarity), cone(tolerances.collinearity)];
    Rules { cones, exact_middles: false }
}

impl LadderResult<'_> {
    /// The segments in which the plain cubic fails.
    pub(crate) fn failing(&self, demands: &Demands<'_>) -> Vec<usize> {
        let checker = demands.checker;
        let unproved = checker.all_unproved(|i| self.plain.legs(i));
        let mut failing: Vec<usize> = unproved.into_iter().map(|(i, _)| i).collect();
        let constraints = demands.constraints;
        let straight = !demands.runs.segments.is_empty();
        if constraints.max_deviation.is_some() || !constraints.tangents.is_empty() || straight {
            let strays = |&i: &usize| {
                self.leaves_direction(demands, i)
                    || self.leaves_line(demands, i)
                    || deviates(demands, i, &self.pieces(demands, i).parts(ends_of(demands, i)))
            };
            failing.extend((0..checker.polygon().segments()).filter(strays));
            failing.sort_unstable();
            failing.dedup();
        }
        failing
    }

    /// Whether any control point lies farther from its chord than it may.
    pub(crate) fn any_deviates(&self, demands: &Demands<'_>) -> bool {
        demands.constraints.max_deviation.is_some()
            && (0..demands.checker.polygon().segments())
                .any(|i| deviates(demands, i, &self.pieces(demands, i).parts(ends_of(demands, i))))
    }

    /// Whether the curve has another direction at a node of a segment than is asked for there.
    fn leaves_direction(&self, demands: &Demands<'_>, i: usize) -> bool {
        let nodes = [i, (i + 1) % demands.checker.polygon().nodes()];
        nodes.into_iter().zip(self.nodes(demands, i)).any(|(node, Node { q, .. })| {
            demands
                .constraints
                .direction(node)
                .is_some_and(|t| q.cross(t).length() > 1e-12 * q.length() || !(q.dot(t) > 0.0))
        })
    }

    /// What is known at the ends of a segment.
    pub(crate) fn nodes(&self, demands: &Demands<'_>, i: usize) -> [Node; 2] {
        self.solved.get(&i).map_or_else(|| self.plain_nodes(demands, i), |own| own.nodes)
    }

    /// What is known at a node.
    fn node(&self, demands: &Demands<'_>, i: usize) -> Node {
        let n = demands.checker.polygon().segments();
        if i < n { self.nodes(demands, i)[0] } else { self.nodes(demands, n - 1)[1] }
    }

    /// What the plain cubic has there.
    pub(crate) fn plain_nodes(&self, demands: &Demands<'_>, i: usize) -> [Node; 2] {
        let count = demands.checker.polygon().nodes();
        [i, (i + 1) % count].map(|node| self.plain.node(node, demands.units))
    }

    /// Whether either derivative at a node of a segment leads off the line that the curve has to keep to.
    fn leaves_line(&self, demands: &Demands<'_>, i: usize) -> bool {
        let nodes = [i, (i + 1) % demands.checker.polygon().nodes()];
        nodes.into_iter().zip(self.nodes(demands, i)).any(|(node, Node { q, r })| {
            let off = |v: DVec3, t: DVec3| v.cross(t).length() > 1e-12 * v.length();
            demands.runs.line(node).is_some_and(|t| off(q, t) || off(r, t) || !(q.dot(t) > 0.0))
        })
    }

    /// The pieces of a segment.
    pub(crate) fn pieces(&self, demands: &Demands<'_>, i: usize) -> Pieces {
        match self.solved.get(&i) {
            None => Pieces::plain(self.plain.legs(i)),
            Some(&Solved { nodes: [start, end], .. }) => {
                let span = demands.span(i);
                Pieces::of(&span, &span.legs(start, end), demands.units, ends_of(demands, i))
            }
        }
    }

    /// The criteria that hold segments back, with the segments.
    pub(crate) fn active(&self) -> impl Iterator<Item = (Criterion, usize)> {
        self.solved.iter().flat_map(|(&i, own)| own.binding.iter().map(move |&c| (c, i)))
    }

    /// Turns the curve into the directions that are asked for, in windows around the nodes that have others. Whether
    /// everything is proved in the end.
    fn turn(
        &mut self,
        demands: &Demands<'_>,
        energy: Energy,
        rules: Rules,
        control: &mut Control<'_>,
    ) -> bool {
        let polygon = demands.checker.polygon();
        let (n, count) = (polygon.segments(), polygon.nodes());
        let turned: Vec<usize> = (0..n).filter(|&i| self.leaves_direction(demands, i)).collect();
        for window in windows(&turned, count, polygon.is_closed(), BESIDE) {
            let mut chain = window.chain(demands, &|i| self.node(demands, i), rules);
            if !settle_nearby(&mut chain, energy, control)
                || !certify(demands, &mut chain, control).is_empty()
            {
                return false;
            }
            self.put(Answer::of(demands, &chain, Method::Elastic, Vec::new()));
        }
        true
    }

    /// Minimises the bending energy of the whole curve.
    fn bend(&mut self, demands: &Demands<'_>, rules: Rules, control: &mut Control<'_>) {
        let whole = Window { start: 0, count: demands.checker.polygon().nodes() };
        let mut chain = whole.chain(demands, &|i| self.plain.node(i, demands.units), rules);
        let mut method = Method::Elastic;
        chain.relax_speeds();
        if !chain.all_hold() {
            method = solve(demands, &mut chain, Means::All, control).unwrap_or(method);
        }
        quicken(demands, &mut chain, control);
        finish_bending(&mut chain, control);
        let mut open = certify(demands, &mut chain, control);
        let last = fall_back(demands, &mut chain, &mut open, control);
        self.put(Answer::of(demands, &chain, last.unwrap_or(method), open));
    }

    /// Takes over what was found.
    pub(crate) fn put(&mut self, answer: Answer) {
        self.solved.extend(answer.segments);
        self.open.extend(answer.open);
        self.method = self.method.max(answer.method);
    }
}

/// Index along the curve of a segment of a chain.
pub(crate) fn index(chain: &Chain, k: usize, segments: usize) -> usize {
    (chain.first + k) % segments
}

/// The end points of a segment.
fn ends_of(demands: &Demands<'_>, i: usize) -> [DVec3; 2] {
    let points = demands.checker.polygon().points();
    [points[i], points[i + 1]]
}

/// Whether a control point of a segment lies farther from its chord than it may.
fn deviates(demands: &Demands<'_>, i: usize, parts: &[BezierPart]) -> bool {
    let Some(most) = demands.deviation(i) else { return false };
    let polygon = demands.checker.polygon();
    let (direction, chord) = (polygon.direction(i), length(polygon.chord(i)));
    let off = |p: &DVec4| off_chord(p.truncate() / chord, 0.0, direction).length();
    !parts.iter().flat_map(|part| &part.control).all(|p| off(p) <= most)
}

/// The exact check of what a chain will export. Where it does not prove everything, the barrier is
/// raised, which widens the margins. Returns what stays open.
pub(crate) fn certify(
    demands: &Demands<'_>,
    chain: &mut Chain,
    control: &mut Control<'_>,
) -> Vec<usize> {
    let mut open = unproved(demands, chain);
    for weight in [10.0, 100.0, 1000.0].map(|factor| factor * LAST) {
        if open.is_empty() || control.is_over() || !chain.all_hold() {
            break;
        }
        finish(chain, weight, control);
        open = unproved(demands, chain);
    }
    open
}

/// The last rungs, for the whole curve: nodes that fail are put where the closed-form start has them, and
/// improved from there; or all are; or all stay there. Keeps the first that leaves least open.
pub(crate) fn fall_back(
    demands: &Demands<'_>,
    chain: &mut Chain,
    open: &mut Vec<usize>,
    control: &mut Control<'_>,
) -> Option<Method> {
    let mut best = None;
    for (method, all) in [(Method::Sweeps, false), (Method::Sweeps, true), (Method::Start, true)] {
        if open.is_empty() || control.is_over() {
            break;
        }
        let before = (chain.nodes.clone(), chain.segments.clone());
        if all {
            restart_all(demands, chain);
        } else {
            replace(demands, chain);
        }
        if method == Method::Sweeps {
            control.begin(Phase::Improve, open.len());
            for weight in [1.0, 0.1, 0.01] {
                improve(chain, weight, control);
            }
            quicken(demands, chain, control);
        }
        let left = if method == Method::Sweeps {
            certify(demands, chain, control)
        } else {
            unproved(demands, chain)
        };
        if left.len() < open.len() {
            (*open, best) = (left, Some(method));
        } else {
            (chain.nodes, chain.segments) = before;
            chain.choose_changes();
        }
    }
    best
}

/// The segments of a chain of which the exact check does not prove everything.
fn unproved(demands: &Demands<'_>, chain: &Chain) -> Vec<usize> {
    let segments = demands.checker.polygon().segments();
    let open = |&k: &usize| {
        let (i, span) = (index(chain, k, segments), &chain.segments[k].span);
        let ends = ends_of(demands, i);
        let pieces = Pieces::of(span, &chain.legs(k), demands.units, ends);
        let parts = pieces.parts(ends);
        !demands.checker.unproved_pieces(i, &parts).is_empty() || deviates(demands, i, &parts)
    };
    let open = (0..chain.segments.len()).filter(open);
    open.map(|k| index(chain, k, segments)).collect()
}

/// What was found in a window.
pub(crate) struct Answer {
    pub(crate) segments: Vec<(usize, Solved)>,
    pub(crate) method: Method,
    /// Segments that the exact check does not prove.
    pub(crate) open: Vec<usize>,
}

impl Answer {
    pub(crate) fn of(
        demands: &Demands<'_>,
        chain: &Chain,
        method: Method,
        open: Vec<usize>,
    ) -> Self {
        let total = demands.checker.polygon().segments();
        let solved = |k: usize| {
            let nodes = chain.ends(k).map(|j| chain.nodes[j]);
            (index(chain, k, total), Solved { nodes, binding: chain.binding(k) })
        };
        Self { segments: (0..chain.segments.len()).map(solved).collect(), method, open }
    }
}
