// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the sphere of directions is cut by: a curve as the sequence of vectors whose signs count, and of
//! the arcs between them.

use glam::DVec3;
use shapespline_polynomial::Polynomial;

use crate::arbitrary_degree::{Segment, corners};

/// Sine of the angle below which directions count as the same, and three points as collinear.
pub(super) const STRAIGHT: f64 = 1e-9;

/// What is hardly larger than the bound on its rounding error: its sign is not relied on.
pub(super) const NOISE: f64 = 1e3;

/// Whether a curve of this `ω` lies in the plane of a normal to within rounding: what leaves the plane
/// is a sign from no direction.
pub(super) fn lies_in(omega: &Polynomial<DVec3>, normal: DVec3) -> bool {
    omega.coefficients().iter().all(|c| c.cross(normal).length() <= omega.error())
}

/// `ω` along a direction.
pub(super) fn along(omega: &Polynomial<DVec3>, direction: DVec3) -> Polynomial<f64> {
    omega.map(1.0, |w| w.dot(direction))
}

/// The `ω` of a piece in a plane along its normal, with the signs that directions beside it see as well.
pub(super) fn from_beside(omega: &Polynomial<DVec3>, normal: DVec3) -> Polynomial<f64> {
    let along = along(omega, normal);
    let off = omega.coefficients().iter().map(|w| w.cross(normal).length()).fold(0.0, f64::max);
    Polynomial::new(along.coefficients().to_vec(), hidden_from_beside(along.error(), off))
}

/// What is hidden along the normal from every direction, where `hidden` is along the direction itself:
/// what leaves the plane, by `off`, adds to what is seen from beside the normal.
pub(super) fn hidden_from_beside(hidden: f64, off: f64) -> f64 {
    (hidden * hidden - off * off).max(0.0).sqrt()
}

/// A vector `V` of the sequence. Seen from `w` it has the sign of `w·V`, so that its great circle
/// `w·V = 0` is where it changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Unit vector.
    pub(super) v: DVec3,
    /// How far rounding can have turned it.
    pub(super) error: f64,
    /// The first and the last of the joints (numbered along the curve) whose tangent is on the circle.
    pub(super) joints: [usize; 2],
    /// Whether the count is the same on both sides of the circle, everywhere.
    pub(super) silent: bool,
}

/// The inside of a cubic that is not planar.
///
/// `w·ω` has a double root at `t` when `w` is normal to `ω(t)` and to `ω'(t)`, which is when it is
/// `±γ'(t)`: two inflections appear or vanish where the direction crosses the curve of tangents.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    /// Index of the line at its start; the next line is at its end.
    pub(super) from: usize,
    /// `γ'` in Bernstein form, brought to a size of one: the legs `a, b, c`.
    pub(super) tangent: [DVec3; 3],
    /// `γ' × γ''` in Bernstein form: `a×b, a×c/2, b×c`.
    pub(super) omega: [DVec3; 3],
    /// Rounding error of the coefficients.
    pub(super) error: f64,
    /// Its first joint; the next is its last.
    pub(super) joint: usize,
    /// Whether it goes on, with tangent and osculating plane, where the arc before ends.
    pub(super) continues: bool,
    /// A cone around all tangents: unit axis, cosine and sine of its half angle (a right one at most).
    pub(super) cone: (DVec3, f64, f64),
}

impl Arc {
    fn new(from: usize, tangent: [DVec3; 3], omega: [DVec3; 3], error: f64, joint: usize) -> Self {
        let units = tangent.map(DVec3::normalize_or_zero);
        let axis = (units[0] + units[1] + units[2]).normalize_or_zero();
        // A little wider, so that rounding leaves nothing out.
        let cosine = units.iter().fold(1.0f64, |m, u| m.min(axis.dot(*u))) - 1e-12;
        let cosine = cosine.max(0.0);
        let cone = (axis, cosine, (1.0 - cosine * cosine).sqrt());
        Self { from, tangent, omega, error, joint, continues: false, cone }
    }

    /// `γ'(t)`.
    pub(super) fn tangent_at(&self, t: f64) -> DVec3 {
        quadratic(self.tangent, t)
    }

    /// `ω(t)`.
    pub(super) fn omega_at(&self, t: f64) -> DVec3 {
        quadratic(self.omega, t)
    }

    /// Whether `w·ω`, of the same sign at both ends, takes the other between them.
    fn dips(&self, w: DVec3, positive: bool) -> bool {
        let [a, m, b] = self.omega.map(|x| x.dot(w));
        (m > 0.0) != positive && m * m > a * b
    }
}

fn quadratic([a, b, c]: [DVec3; 3], t: f64) -> DVec3 {
    let s = 1.0 - t;
    a * (s * s) + b * (2.0 * s * t) + c * (t * t)
}

/// The sequence of a polygon, or of a curve.
#[derive(Debug, Clone, Default)]
pub(super) struct Sequence {
    pub(super) lines: Vec<Line>,
    pub(super) arcs: Vec<Arc>,
    /// The arc between a line and the next, if there is one.
    pub(super) links: Vec<Option<usize>>,
    /// Whether the signs of some planar piece could not be told from zero.
    pub(super) open: bool,
    /// The last joint, where the tangent there is that of the first: the two are one.
    pub(super) closing: Option<usize>,
}

impl Sequence {
    /// Of vectors that only turn from one to the next, with what rounding can have turned them by.
    pub(super) fn of_vectors(vectors: impl IntoIterator<Item = (DVec3, f64)>) -> Self {
        let mut sequence = Self::default();
        for (i, (v, error)) in vectors.into_iter().enumerate() {
            // Consecutive `V_i` of a polygon share a chord.
            sequence.lines.push(Line { v, error, joints: [i, i + 1], silent: false });
        }
        sequence.links = vec![None; sequence.lines.len().saturating_sub(1)];
        sequence
    }

    /// Of polynomial pieces up to degree three; nothing for others.
    pub(super) fn of_cubics(segment: &Segment) -> Option<Self> {
        let mut sequence = Self::default();
        let mut joints = corners(segment);
        for (k, piece) in segment.pieces.iter().enumerate() {
            let velocity = piece.polynomial_velocity()?;
            let legs = match *velocity.coefficients() {
                [a] => [a; 3],
                [a, b] => [a, (a + b) * 0.5, b],
                [a, b, c] => [a, b, c],
                _ => return None,
            };
            sequence.push_piece(k, legs, velocity.error(), &piece.omega());
            if let Some((_, turn, error)) = joints.next() {
                let size = turn.length();
                sequence.open |= error > STRAIGHT && size <= NOISE * error;
                if size > error.max(STRAIGHT) {
                    sequence.push_line(turn / size, error / size, [k + 1; 2]);
                }
            }
        }
        if let (Some(first), Some(last)) = (segment.pieces.first(), segment.pieces.last()) {
            let [u, v] =
                [first.tangent().ends()[0], last.tangent().ends()[1]].map(DVec3::normalize_or_zero);
            let closes = u.cross(v).length() <= STRAIGHT;
            sequence.closing = closes.then_some(segment.pieces.len());
        }
        Some(sequence)
    }

    fn push_piece(&mut self, k: usize, legs: [DVec3; 3], error: f64, seen: &Polynomial<DVec3>) {
        if seen.bound() <= seen.error() {
            // Straight: no direction shows a curvature that could change.
            return;
        }
        let size = legs.iter().fold(0.0f64, |m, v| m.max(v.length()));
        let tangent @ [a, b, c] = legs.map(|v| v / size);
        let error = error / size + f64::EPSILON;
        let omega = [a.cross(b), a.cross(c) * 0.5, b.cross(c)];
        let omega_error = 4.0 * error;
        let longest =
            omega.into_iter().fold(omega[0], |m, v| if v.length() > m.length() { v } else { m });
        let length = longest.length();
        // Hardly more than straight: rounding decides which way it turns.
        self.open |= length <= NOISE * omega_error;
        let planar = STRAIGHT * length + 4.0 * omega_error;
        if omega.iter().all(|v| v.cross(longest).length() <= length * planar) {
            let normal = longest / length;
            let lies = lies_in(seen, normal);
            let along = if lies { from_beside(seen, normal) } else { along(seen, normal) };
            let (signs, open) = along.signs();
            // Off its plane by more than rounding, it shows two inflections to someone in the plane.
            self.open |= open || !lies;
            for sign in signs {
                let v = if sign { normal } else { -normal };
                self.push_line(v, omega_error / length, [k, k + 1]);
            }
            return;
        }
        let [first, _, last] = omega;
        let sizes = [first.length(), last.length()];
        // Next to legs that all but agree: which way it turns there is rounding.
        self.open |= sizes.iter().any(|&size| size <= NOISE * omega_error);
        let joined = self.push_line(first / sizes[0], omega_error / sizes[0], [k; 2]);
        let mut arc = Arc::new(self.lines.len() - 1, tangent, omega, error, k);
        if let Some(before) =
            self.arcs.last().filter(|before| joined && before.from + 2 == self.lines.len())
        {
            let [u, v] = [before.tangent[2], a].map(DVec3::normalize_or_zero);
            arc.continues = u.dot(v) > 0.0 && u.cross(v).length() <= STRAIGHT;
            // The tangents' curve turns on in the same sense, so the great circle tangent to it does
            // not bound a cell: a root of `w·ω` that leaves one piece enters the other.
            let sense = |t: &[DVec3; 3]| t[0].cross(t[1]).dot(t[2]) > 0.0;
            let silent = arc.continues && sense(&before.tangent) == sense(&tangent);
            self.lines[arc.from].silent = silent;
        }
        self.arcs.push(arc);
        self.links.push(Some(self.arcs.len() - 1));
        let v = last / sizes[1];
        let (error, joints) = (omega_error / sizes[1], [k + 1; 2]);
        self.lines.push(Line { v, error, joints, silent: false });
    }

    /// Adds a vector, or finds the last one to be the same: says so.
    fn push_line(&mut self, v: DVec3, error: f64, joints: [usize; 2]) -> bool {
        if let Some(last) = self.lines.last_mut() {
            let apart = last.v.cross(v).length();
            if last.v.dot(v) > 0.0 && apart <= STRAIGHT.max(last.error + error) {
                last.error = last.error.max(error).max(apart);
                // Known to no better than that, they need not be the same.
                self.open |= apart > STRAIGHT;
                last.joints = [last.joints[0].min(joints[0]), last.joints[1].max(joints[1])];
                return true;
            }
            self.links.push(None);
        }
        self.lines.push(Line { v, error, joints, silent: false });
        false
    }
}

/// A curve or a line of the arrangement, where a sweep meets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Item {
    /// A line, by its index.
    Line(usize),
    /// An arc, by its index.
    Arc(usize),
}

/// The signs and the count as seen from a direction that moves.
#[derive(Debug, Default)]
pub(super) struct View {
    pub(super) positive: Vec<bool>,
    /// Sign changes between each line and the next: 0, 1, or 2.
    links: Vec<u8>,
    /// Their sum.
    pub(super) count: usize,
}

impl View {
    /// Looks along `w`; the signs of lines come from `sign`.
    pub(super) fn turn_to(&mut self, sequence: &Sequence, w: DVec3, sign: impl Fn(usize) -> bool) {
        self.positive.clear();
        self.positive.extend((0..sequence.lines.len()).map(sign));
        self.links.clear();
        self.links.resize(sequence.links.len(), 0);
        self.count = 0;
        for link in 0..sequence.links.len() {
            self.relink(sequence, link, w);
        }
    }

    /// Sets the changes along an arc, whatever `w·ω` says.
    pub(super) fn set_link(&mut self, link: usize, changes: u8) {
        self.count = self.count - usize::from(self.links[link]) + usize::from(changes);
        self.links[link] = changes;
    }

    /// Takes in that the direction, now `w`, has crossed something.
    pub(super) fn cross(&mut self, sequence: &Sequence, item: Item, w: DVec3) {
        match item {
            Item::Arc(arc) => self.relink(sequence, sequence.arcs[arc].from, w),
            Item::Line(line) => {
                self.positive[line] = sequence.lines[line].v.dot(w) > 0.0;
                if line > 0 {
                    self.relink(sequence, line - 1, w);
                }
                if line < self.links.len() {
                    self.relink(sequence, line, w);
                }
            }
        }
    }

    fn relink(&mut self, sequence: &Sequence, link: usize, w: DVec3) {
        let [p, q] = [self.positive[link], self.positive[link + 1]];
        // Signs are as good as random: nothing branches on whether they differ, but where there are arcs.
        let changes = match sequence.links[link] {
            Some(arc) if p == q && sequence.arcs[arc].dips(w, p) => 2,
            _ => u8::from(p != q),
        };
        self.set_link(link, changes);
    }
}
