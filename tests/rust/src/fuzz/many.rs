// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many curves and functions at once: offsets, rows, columns.

use shapespline::{
    monotone::{MonotoneMany, MonotoneQuartic, MonotoneQuintic, fit_columns, fit_rows},
    prelude::*,
};

use super::{Bytes, readable};

/// Collections under arbitrary offsets. A row's curve is the one it has alone, whatever stands beside it
/// and whatever is wrong there; offsets that do not cut the data are an error.
pub(super) fn run(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    if bytes.flag() { curves(&mut bytes) } else { functions(&mut bytes) }
}

fn offsets(bytes: &mut Bytes<'_>, length: usize) -> Vec<usize> {
    let rows = bytes.below(6);
    let mut offsets: Vec<usize> = (0..rows).map(|_| bytes.below(length + 1)).collect();
    if bytes.below(8) != 0 {
        offsets.push(0);
        offsets.push(length);
        offsets.sort_unstable();
    }
    offsets
}

fn curves(bytes: &mut Bytes<'_>) {
    let planar = bytes.below(4) == 0;
    let n = bytes.below(30) + 1;
    let points = bytes.points(n, planar);
    let offsets = offsets(bytes, n);
    let rows = match Ragged::new(&points, &offsets) {
        Ok(rows) => rows,
        Err(error) => return readable(&error),
    };
    let dimension = if planar { Dimension::Two } else { Dimension::Three };
    let (parametrization, boundary) = (bytes.parametrization(n), bytes.boundary(planar));
    let given = match &parametrization {
        Parametrization::Given(u) => Some(u.clone()),
        _ => None,
    };
    let chosen = parametrization.clone();
    let (closed, repeated) = (false, Repeated::Error);
    let collection =
        Collection { points: rows, dimension, parametrization, boundary, closed, repeated };
    let threads = [None, Some(1), Some(2), Some(0)][bytes.below(4)];
    let shape = bytes.flag();
    let fit = |polygon: DataPolygon| {
        if shape {
            NuSpline::shape_preserving(polygon, &SearchOptions::default()).map(|fit| fit.curve)
        } else {
            NuSpline::new(polygon, Tension::Uniform(1.0))
        }
    };
    let many = match fit_many(&collection, threads, fit) {
        Ok(many) => many,
        Err(error) => return readable(&error),
    };
    assert_eq!(many.len(), rows.len());
    for (k, found) in many.iter().enumerate() {
        let own = match &given {
            Some(u) => Parametrization::Given(u[rows.range(k)].to_vec()),
            None => chosen.clone(),
        };
        let points = rows.row(k).to_vec();
        let alone = DataPolygon::with_dimension(points, dimension, &own, boundary);
        let alone = alone.map_err(FitError::from).and_then(fit);
        match (found, &alone) {
            (Ok(found), Ok(alone)) => assert_eq!(found, alone, "row {k}"),
            // By text: a NaN that an error holds is not equal to itself.
            _ => assert_eq!(format!("{found:?}"), format!("{alone:?}"), "row {k}"),
        }
    }
}

fn functions(bytes: &mut Bytes<'_>) {
    let n = bytes.below(30) + 1;
    let y = bytes.numbers(n);
    if bytes.flag() {
        let length = bytes.below(n) + 1;
        let x = bytes.increasing(length);
        match fit_columns::<MonotoneQuartic>(&x, &y, &Default::default()) {
            Ok(fits) => same(bytes, &fits, |k| (x.clone(), y[k * length..][..length].to_vec())),
            Err(error) => readable(&error),
        }
        return;
    }
    let offsets = offsets(bytes, n);
    let length = if bytes.below(16) == 0 { bytes.below(n) + 1 } else { n };
    // Each row climbs for itself.
    let mut x = bytes.increasing(length);
    for w in offsets.windows(2).filter(|w| w[0] < w[1] && w[1] <= length) {
        let own = bytes.increasing(w[1] - w[0]);
        x[w[0]..w[1]].copy_from_slice(&own);
    }
    match fit_rows::<MonotoneQuintic>(&x, &y, &offsets, &Default::default()) {
        Ok(fits) => same(bytes, &fits, |k| {
            let range = offsets[k]..offsets[k + 1];
            (x[range.clone()].to_vec(), y[range].to_vec())
        }),
        Err(error) => readable(&error),
    }
}

fn same<F>(bytes: &mut Bytes<'_>, fits: &[F], data: impl Fn(usize) -> (Vec<f64>, Vec<f64>))
where
    F: MonotoneMany + Sync,
    F::Options: Default,
{
    let queries = bytes.numbers(8);
    let values = F::evaluate_columns(fits, &queries, 0, None);
    for (k, fit) in fits.iter().enumerate() {
        let (x, y) = data(k);
        let alone = F::make(&x, &y, &F::Options::default()).unwrap();
        for (q, value) in queries.iter().zip(&values[k * queries.len()..]) {
            assert_eq!(alone.function().value(*q).to_bits(), value.to_bits());
        }
        for (&x, &y) in x.iter().zip(&y) {
            assert_eq!(fit.function().value(x), y);
        }
    }
    let cuts = offsets(bytes, queries.len());
    if let Err(error) = F::evaluate_rows(fits, &queries, &cuts, bytes.below(4), None) {
        readable(&error);
    }
}
