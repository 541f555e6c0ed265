// SPDX-License-Identifier: MIT OR Apache-2.0

//! A curve beside the input that it was fitted to.

use std::ops::Deref;

use shapespline::{
    criteria::{NodeConditions, Record, ShapeReport},
    geometry::{InputMap, Repeated},
};

use super::Curve;

/// A curve, and where its points stand in the input: points that repeat others may have been left out of
/// it, and its first point may have been added at the end. What users see refers to the input.
#[derive(Debug)]
pub(crate) struct Fitted {
    curve: Box<dyn Curve>,
    pub(crate) map: InputMap,
    pub(crate) repeated: Repeated,
}

impl Deref for Fitted {
    type Target = dyn Curve;

    fn deref(&self) -> &Self::Target {
        self.curve.as_ref()
    }
}

impl Fitted {
    pub(crate) fn new(curve: impl Curve + 'static, map: InputMap, repeated: Repeated) -> Self {
        Self { curve: Box::new(curve), map, repeated }
    }

    /// One value for each point of the input, from those of the nodes.
    pub(crate) fn of_points<T: Copy>(&self, nodes: &[T]) -> Vec<T> {
        if self.map.dropped().is_empty() { nodes.to_vec() } else { self.map.spread(nodes) }
    }

    /// A record of the checker, which sees the image alone, run through linearly on each segment: with its
    /// location in the curve's own parameter, and the segment of the input.
    pub(crate) fn located(&self, record: Record) -> Record {
        let location = self.own_parameter(record.location);
        Record { location, segment: self.map.segment(record.segment), ..record }
    }

    /// The same for a whole report.
    pub(crate) fn with_locations(&self, mut report: ShapeReport) -> ShapeReport {
        for record in &mut report.violations {
            *record = self.located(*record);
        }
        for open in &mut report.undecided {
            open.interval = open.interval.map(|u| self.own_parameter(u));
            open.segment = self.map.segment(open.segment);
        }
        report.straight.iter_mut().for_each(|i| *i = self.map.segment(*i));
        report
    }

    /// The same for notes.
    pub(crate) fn with_places(&self, notes: NodeConditions) -> NodeConditions {
        let mut notes = in_input(&self.map, notes);
        let nodes = notes.nodes.iter_mut().map(|record| &mut record.location);
        let segments = notes.oscillations.iter_mut().map(|record| &mut record.location);
        nodes.chain(segments).for_each(|u| *u = self.own_parameter(*u));
        notes
    }
}

/// Notes with the nodes and segments of the input.
pub(crate) fn in_input(map: &InputMap, mut notes: NodeConditions) -> NodeConditions {
    for record in &mut notes.nodes {
        record.node = map.node(record.node);
    }
    for record in &mut notes.oscillations {
        record.segment = map.segment(record.segment);
    }
    notes
}
