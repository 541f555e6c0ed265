// SPDX-License-Identifier: MIT OR Apache-2.0

//! Stored forms: bytes that claim to be a curve, a function or a report.

use serde::{Serialize, de::DeserializeOwned};
use shapespline::{
    criteria::{InflectionCount, NodeConditions},
    geometry::ReparametrizedCubic,
    monotone::{MonotoneMany, PiecewisePolynomial},
    prelude::*,
};

use super::{Bytes, curves::questions};

/// Reading what was stored, damaged or made up. It is refused, or what it makes answers every question
/// without a panic and is written again as the same bytes.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let kind = bytes.below(10);
    let honest = bytes.flag();
    match kind {
        0 => read(&mut bytes, honest, nu, |s, b| questions(s.curve(), b)),
        1 => read(&mut bytes, honest, tension, |s, b| questions(s.curve(), b)),
        2 => read(&mut bytes, honest, catmull_rom, |s, b| questions(s.curve(), b)),
        3 => read(&mut bytes, honest, |b| Some(nu(b)?.curve().clone()), |c, b| questions(c, b)),
        4 => {
            let make = |b: &mut Bytes<'_>| -> Option<ReparametrizedCubic> {
                Some(tension(b)?.curve().clone())
            };
            read(&mut bytes, honest, make, |c, b| questions(c, b));
        }
        5 => read::<MonotoneQuartic>(&mut bytes, honest, function, ask),
        6 => read::<MonotoneQuintic>(&mut bytes, honest, function, ask),
        7 => {
            let make = |b: &mut Bytes<'_>| -> Option<PiecewisePolynomial> {
                Some(function::<MonotoneQuintic>(b)?.function().to_piecewise())
            };
            read(&mut bytes, honest, make, |p, b| {
                let _ = (p.evaluate(b.number(), b.below(9), None), p.roots(None));
                let _ = (p.derivative(b.below(9)), p.antiderivative(b.below(3)));
                let _ = (p.integrate(b.number(), b.number(), None), p.solve(b.number(), None));
            });
        }
        8 => {
            let make = |b: &mut Bytes<'_>| -> Option<ShapeReport> {
                nu(b)?.check(Criteria::ALL, Tolerances::default()).ok()
            };
            read(&mut bytes, honest, make, |r, _| assert!(!r.to_string().is_empty()));
        }
        _ => {
            let make = |_: &mut Bytes<'_>| -> Option<(NodeConditions, InflectionCount)> { None };
            read(&mut bytes, honest, make, |_, _| {});
        }
    }
}

fn nu(bytes: &mut Bytes<'_>) -> Option<NuSpline> {
    NuSpline::new(bytes.polygon(6)?, Tension::Uniform(0.5)).ok()
}

fn tension(bytes: &mut Bytes<'_>) -> Option<TensionSpline> {
    TensionSpline::new(bytes.polygon(6)?, TangentScale::Uniform(0.5)).ok()
}

fn catmull_rom(bytes: &mut Bytes<'_>) -> Option<CatmullRom> {
    CatmullRom::new(bytes.polygon(6)?, Tension::Uniform(0.5), Continuity::G1).ok()
}

fn function<F: MonotoneMany>(bytes: &mut Bytes<'_>) -> Option<F>
where
    F::Options: Default,
{
    let n = bytes.below(6) + 2;
    F::make(&bytes.increasing(n), &bytes.numbers(n), &F::Options::default()).ok()
}

fn ask<F: MonotoneMany>(fit: &F, bytes: &mut Bytes<'_>) {
    let f = fit.function();
    for nu in 0..7 {
        let _ = f.evaluate(bytes.number(), nu, None);
        let _ = f.evaluate(f.x()[0], nu, None);
    }
    let _ = (f.roots(None), f.solve(bytes.number(), None), f.inverse(bytes.number()));
    let _ = (f.integrate(bytes.number(), bytes.number(), None), f.to_piecewise());
}

/// An honest object with a few bytes changed, or bytes as they come.
fn read<T: Serialize + DeserializeOwned>(
    bytes: &mut Bytes<'_>,
    honest: bool,
    make: impl Fn(&mut Bytes<'_>) -> Option<T>,
    ask: impl Fn(&T, &mut Bytes<'_>),
) {
    let mut stored = if honest {
        let Some(object) = make(bytes) else { return };
        let mut stored = postcard::to_stdvec(&object).unwrap();
        for _ in 0..bytes.below(4) {
            let at = (256 * bytes.below(4) + bytes.below(256)) % stored.len().max(1);
            if bytes.below(4) == 0 {
                stored.truncate(at);
            } else if let Some(byte) = stored.get_mut(at) {
                *byte = bytes.byte();
            }
        }
        stored
    } else {
        bytes.rest().to_vec()
    };
    let Ok((object, rest)) = postcard::take_from_bytes::<T>(&stored) else { return };
    let read = stored.len() - rest.len();
    stored.truncate(read);
    ask(&object, bytes);
    let again = postcard::to_stdvec(&object).unwrap();
    // Numbers may have been stored in more bytes than they need.
    assert!(again.len() <= stored.len(), "{} bytes became {}", stored.len(), again.len());
}
