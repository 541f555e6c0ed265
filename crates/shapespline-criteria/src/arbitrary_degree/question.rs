// SPDX-License-Identifier: MIT OR Apache-2.0

//! What is asked of a segment.

use glam::DVec3;
use shapespline_polynomial::Sign;

use crate::{
    Criterion, Requirements,
    cone::{Cones, LINE_PART},
};

/// What a segment is asked, and by which vectors of the polygon.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Question {
    pub(crate) criterion: Criterion,
    pub(crate) required: Requirements,
    /// Unit binormal vectors at the two nodes.
    pub(crate) normals: [DVec3; 2],
    /// Those at the nodes beside them, and the unit chord, by which turning goes.
    pub(crate) beside: [DVec3; 2],
    pub(crate) chord: DVec3,
    pub(crate) cones: Cones,
}

impl Question {
    /// The sign that the torsion has to have.
    pub(crate) fn torsion_sign(&self) -> f64 {
        if self.required.intersects(Requirements::RIGHT_TORSION) { 1.0 } else { -1.0 }
    }

    /// The parts of the segment on which a cone condition is asked, each with its cone: axis and
    /// sine.
    pub(crate) fn cone_parts(&self) -> Vec<([f64; 2], DVec3, f64)> {
        let mut parts = Vec::new();
        if self.criterion == Criterion::Coplanarity {
            let (epsilon, normals) = self.cones.plane;
            for normal in normals {
                if self.required.intersects(Requirements::COPLANARITY) {
                    parts.push(([0.0, 1.0], normal, epsilon));
                } else {
                    let [left, right] = self.cones.parts;
                    parts.push(([0.0, left], normal, epsilon));
                    parts.push(([right, 1.0], normal, epsilon));
                }
            }
        } else {
            let (epsilon, [start, end]) = self.cones.line;
            if self.required.intersects(Requirements::LINE_AT_START) {
                parts.push(([0.0, LINE_PART], start, epsilon));
            }
            if self.required.intersects(Requirements::LINE_AT_END) {
                parts.push(([1.0 - LINE_PART, 1.0], end, epsilon));
            }
        }
        parts
    }
}

/// The sign of a value at a parameter that is known to an error.
pub(crate) fn clear(value: f64, error: f64, at: f64) -> Sign {
    if value > error {
        Sign::Positive
    } else if value < -error || value == 0.0 || value.is_nan() {
        Sign::Fails { at }
    } else {
        Sign::Undecided { from: at, to: at }
    }
}
