// SPDX-License-Identifier: MIT OR Apache-2.0

//! Violations that travel: in long regular data every raise can break the next segment, and that one
//! the next. What the front has done so far is then done at once as far ahead as it has come.

use shapespline_criteria::Violations;
use shapespline_geometry::DataPolygon;

use crate::pattern::{Ring, TensionPattern};

/// Rounds of raising before fronts are watched: most searches end sooner.
const FIRST_ROUND: usize = 12;

/// Longest way in one round, in segments: a change of tension falls below rounding over 64 nodes.
const LONGEST: isize = 64;

/// Equal ways in a row that make a front.
const WAYS: usize = 3;

/// Relative difference of chords, angles and spacings up to which two places count as alike.
const ALIKE: f64 = 1e-3;

/// The last time that a segment began to fail.
#[derive(Debug, Clone, Copy, Default)]
struct Event {
    /// 0 is never.
    round: usize,
    violations: Violations,
    /// Whether tension was raised there because a front was expected.
    ahead: bool,
}

impl Event {
    /// Whether a front can have come from another event to this one.
    fn follows(&self, other: &Self) -> bool {
        let earlier = other.round < self.round || (self.ahead && other.round == self.round);
        other.round > 0 && other.violations == self.violations && earlier
    }
}

/// Watches where segments begin to fail.
#[derive(Debug, Default)]
pub(crate) struct Fronts {
    round: usize,
    /// One per segment, from [`FIRST_ROUND`] on.
    events: Vec<Event>,
    /// The segments that failed in the last round, and how.
    before: Vec<(usize, Violations)>,
}

/// A front that has come to a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Front {
    segment: usize,
    violations: Violations,
    /// The way of one round; negative towards the first segment.
    way: isize,
    /// How often the tension of the last place is repeated, from this one on.
    repeats: usize,
}

impl Front {
    /// Pairs of nodes: one that was raised at the last place, and the one in its stead here or ahead.
    pub(crate) fn nodes(self, polygon: &DataPolygon) -> impl Iterator<Item = [usize; 2]> {
        let ring = Ring::of(polygon, polygon.nodes());
        let pattern = TensionPattern::of(self.violations);
        (0..self.repeats).flat_map(move |k| {
            pattern.offsets().filter_map(move |offset| {
                let last = ring.moved(self.segment, offset - self.way)?;
                Some([last, ring.moved(self.segment, offset + self.way * k as isize)?])
            })
        })
    }
}

impl Fronts {
    /// The fronts in a round of raising, given the segments that fail in it (ascending).
    pub(crate) fn find(
        &mut self,
        violations: &[(usize, Violations)],
        polygon: &DataPolygon,
    ) -> Vec<Front> {
        self.round += 1;
        if self.round < FIRST_ROUND {
            return Vec::new();
        }
        self.events.resize(polygon.segments(), Event::default());
        let before = std::mem::replace(&mut self.before, violations.to_vec());
        let begins = |violation: &&(usize, Violations)| {
            self.round > FIRST_ROUND && before.binary_search_by_key(&violation.0, |b| b.0).is_err()
        };
        let fresh: Vec<_> = violations.iter().filter(begins).collect();
        let mut fronts = Vec::new();
        for &&(segment, violations) in &fresh {
            let event = Event { round: self.round, violations, ahead: false };
            fronts.extend(self.front(segment, event, polygon));
            self.events[segment] = event;
        }
        for front in &fronts {
            let ring = Ring::of(polygon, polygon.segments());
            for k in 1..front.repeats as isize {
                if let Some(ahead) = ring.moved(front.segment, front.way * k) {
                    let event =
                        Event { round: self.round, violations: front.violations, ahead: true };
                    self.events[ahead] = event;
                }
            }
        }
        fronts
    }

    /// The front that has come to a segment with an event, if one has.
    fn front(&self, segment: usize, event: Event, polygon: &DataPolygon) -> Option<Front> {
        let ring = Ring::of(polygon, polygon.segments());
        let come = |way: isize| {
            let mut here = event;
            let places = (1..self.events.len()).map_while(|k| {
                let last = self.events[ring.moved(segment, -way * k as isize)?];
                std::mem::replace(&mut here, last).follows(&last).then_some(())
            });
            places.count()
        };
        let ways = (1..=LONGEST).flat_map(|way| [way, -way]);
        let (way, come) = ways.map(|way| (way, come(way))).find(|(_, come)| *come >= WAYS)?;
        let ahead = repeats_ahead(polygon, segment, way, come);
        (ahead > 0).then_some(Front {
            segment,
            violations: event.violations,
            way,
            repeats: 1 + ahead,
        })
    }
}

/// How often, at most `most` times, the polygon goes on ahead of a segment as it does one way before.
fn repeats_ahead(polygon: &DataPolygon, segment: usize, way: isize, most: usize) -> usize {
    let ring = Ring::of(polygon, polygon.segments());
    let (length, direction) = (way.unsigned_abs(), way.signum());
    let is_alike = |k: usize| {
        let here = ring.moved(segment, direction * k as isize)?;
        is_alike(polygon, ring, [here, ring.moved(here, -way)?]).then_some(())
    };
    // Tension is felt by the chords two segments further on.
    let alike = (0..most * length + 2).map_while(is_alike).count();
    alike.saturating_sub(2) / length
}

/// Whether chords, angles and spacings around two segments are alike.
fn is_alike(polygon: &DataPolygon, ring: Ring, [i, j]: [usize; 2]) -> bool {
    let around = |i: usize| Some([i, ring.moved(i, 1)?, ring.moved(i, 2)?]);
    let (Some(i), Some(j)) = (around(i), around(j)) else { return false };
    let near = |x: f64, y: f64, size: f64| (x - y).abs() <= ALIKE * size;
    let sizes = |i: [usize; 3]| {
        let [before, after] = [i[0], i[1]].map(|i| polygon.chord(i).length() / polygon.spacing(i));
        (polygon.chord(i[0]).length() / polygon.chord(i[1]).length(), before / after)
    };
    let turns = |i: [usize; 3]| {
        let [a, b, c] = i.map(|i| polygon.direction(i));
        [a.dot(b), b.dot(c), a.dot(c), a.cross(b).dot(c)]
    };
    let ((chords, speeds), (other_chords, other_speeds)) = (sizes(i), sizes(j));
    near(chords, other_chords, chords)
        && near(speeds, other_speeds, speeds)
        && turns(i).into_iter().zip(turns(j)).all(|(x, y)| near(x, y, 1.0))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use shapespline_geometry::{Boundary, DVec3, Parametrization};

    use super::*;

    /// Stairs of three segments, as many as asked for, then something else.
    fn stairs(boundary: Boundary) -> DataPolygon {
        let mut points = vec![DVec3::ZERO];
        for i in 0..90 {
            let step = [DVec3::X, DVec3::X, DVec3::Y][i % 3];
            points.push(points[i] + if i < 60 { step } else { DVec3::Z * (i as f64) });
        }
        DataPolygon::new(points, &Parametrization::Uniform, boundary).unwrap()
    }

    const VIOLATIONS: Violations = Violations::TORSION;

    /// Runs rounds in which one segment each fails, after as many quiet ones as are waited for.
    fn run(polygon: &DataPolygon, failing: &[usize]) -> Vec<Vec<Front>> {
        let mut fronts = Fronts::default();
        (0..FIRST_ROUND).for_each(|_| assert!(fronts.find(&[], polygon).is_empty()));
        failing.iter().map(|&m| fronts.find(&[(m, VIOLATIONS)], polygon)).collect()
    }

    fn front(segment: usize, way: isize, repeats: usize) -> Vec<Front> {
        vec![Front { segment, violations: VIOLATIONS, way, repeats }]
    }

    #[test]
    fn what_a_front_did_is_repeated_as_far_as_it_has_come() {
        let polygon = stairs(Boundary::ZeroCurvature);
        // A segment that fails twice delays the front, and is counted once.
        let found = run(&polygon, &[4, 7, 7, 10, 13, 25]);
        assert!(found[..4].iter().all(Vec::is_empty));
        assert_eq!(found[4], front(13, 3, 4));
        // After 13, 16, 19 and 22 the front has come seven ways, and the stairs end at 60.
        assert_eq!(found[5], front(25, 3, 8));
        let back = run(&polygon, &[55, 52, 49, 46, 34]);
        assert_eq!(back[3..], [front(46, -3, 4), front(34, -3, 8)]);
    }

    #[test]
    fn nothing_is_repeated_where_the_polygon_differs() {
        let polygon = stairs(Boundary::ZeroCurvature);
        // Stairs have a period of three; the end of the stairs is near.
        assert!(run(&polygon, &[4, 8, 12, 16]).concat().is_empty());
        assert_eq!(run(&polygon, &[42, 45, 48, 51])[3], front(51, 3, 2));
        // No front at all: uneven ways, and ways there and back.
        assert!(run(&polygon, &[4, 7, 11, 14, 15]).concat().is_empty());
        assert!(run(&polygon, &[4, 7, 4, 7, 4]).concat().is_empty());
    }

    #[test]
    fn nodes_answer_to_those_of_the_last_place() {
        let polygon = stairs(Boundary::ZeroCurvature);
        let front =
            Front { segment: 13, violations: Violations::CONVEXITY_AT_START, way: 3, repeats: 2 };
        let nodes: Vec<_> = front.nodes(&polygon).collect();
        assert_eq!(nodes, [[9, 12], [11, 14], [9, 15], [11, 17]]);
    }
}
