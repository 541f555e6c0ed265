# SPDX-License-Identifier: MIT OR Apache-2.0

"""Many rows with their own x, and Bézier-like curves."""

import pickle
from itertools import pairwise

import numpy as np
import pytest

import shapespline as ss

CLASSES = {
    "cubic": ss.MonotoneCubic,
    "quintic": ss.MonotoneQuintic,
    "quartic": ss.MonotoneQuartic,
}


@pytest.mark.parametrize("kind", CLASSES)
@pytest.mark.parametrize("rows", [3, 700])
def test_rows_are_the_single_fits(rng, kind, rows):
    x, y = np.cumsum(rng.uniform(0.5, 2, (rows, 20)), 1), np.cumsum(rng.random((rows, 20)), 1)
    f = ss.fit_many_monotone(x, y, kind=kind, extrapolate="clip")
    ragged = ss.fit_many_monotone(
        x.ravel(), y.ravel(), kind=kind, offsets=np.arange(rows + 1) * 20, extrapolate="clip"
    )
    q = rng.uniform(0, 30, (rows, 15))
    values = f(q)
    np.testing.assert_array_equal(ragged(q), values)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(f))(q, 1), f(q, 1))
    for k in (0, rows // 2, -1):
        one = CLASSES[kind](x[k], y[k], extrapolate="clip")
        assert type(f[k]) is CLASSES[kind]
        np.testing.assert_array_equal(values[k], one(q[k]))
        np.testing.assert_array_equal(f([3.0, 4.0])[k], one([3.0, 4.0]))
        assert f(5.0)[k] == f[k](5.0) == one(5.0)
        assert f.bending_energy[k] == one.bending_energy
        assert f.diagnostics[k] == one.diagnostics
    assert len(f) == rows
    with pytest.raises(IndexError):
        f[rows]


@pytest.mark.parametrize("kind", CLASSES)
@pytest.mark.parametrize("rows", [4, 900])
def test_rows_have_the_calculus_of_single_functions(rng, kind, rows):
    lengths = rng.integers(2, 30, rows)
    bounds = np.r_[0, np.cumsum(lengths)]
    x, y = rng.uniform(0.5, 2, bounds[-1]), rng.uniform(0.01, 1, bounds[-1])
    for a, b in pairwise(bounds):
        x[a:b], y[a:b] = np.cumsum(x[a:b]), np.cumsum(y[a:b])
    f = ss.fit_many_monotone(x, y, kind=kind, offsets=bounds)
    places = np.r_[0, np.cumsum(rng.integers(0, 40, rows))]
    q = rng.uniform(0, 40, places[-1])
    levels = y[bounds[:-1]] + (y[bounds[1:] - 1] - y[bounds[:-1]]) * rng.random(rows)
    slope, area = f.derivative(), f.antiderivative(2)
    assert type(slope) is type(area) is ss.PiecewiseRows
    assert isinstance(f, ss.PiecewiseRows)
    ragged = {g: g(q, offsets=places) for g in (f, slope, area)}
    second = f(q, 1, "clip", offsets=places)
    a, b = rng.uniform(-1, 30, (2, rows))
    integrals, inverse = f.integrate(a, b), f.inverse(levels[:, None])
    ends = np.r_[0, np.cumsum(np.ones(rows, dtype=int))]
    np.testing.assert_array_equal(f.inverse(levels, offsets=ends), inverse[:, 0])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(slope))(1.5), slope(1.5))
    for k in range(0, rows, max(1, rows // 20)):
        own, one = slice(places[k], places[k + 1]), f[k]
        np.testing.assert_array_equal(ragged[f][own], one(q[own]))
        np.testing.assert_array_equal(ragged[slope][own], one.derivative()(q[own]))
        np.testing.assert_array_equal(ragged[area][own], one.antiderivative(2)(q[own]))
        np.testing.assert_array_equal(second[own], one(q[own], 1, "clip"))
        assert type(slope[k]) is ss.PiecewisePolynomial
        assert integrals[k] == one.integrate(a[k], b[k])
        assert f.integrate(0, 3)[k] == one.integrate(0, 3)
        # One alone and many at once are found on different ways.
        assert abs(one.inverse(levels[k]) - inverse[k, 0]) <= 1e-9 * x[bounds[k + 1] - 1]
        assert abs(one(inverse[k, 0]) - levels[k]) <= 1e-14 * y[bounds[k + 1] - 1]


@pytest.mark.parametrize(
    ("call", "exception", "message"),
    [
        (lambda f: f([1.0, 2.0, 3.0], offsets=[0, 3]), ValueError, "offsets must have 3 entries"),
        (lambda f: f([1.0, 2.0], offsets=[0, 1, 3]), ValueError, r"offsets\[2\] = 3"),
        (lambda f: f([1.0], offsets=[0, 0.5, 1]), ValueError, r"offsets\[1\]"),
        (lambda f: f([[1.0], [2.0]], offsets=[0, 1, 2]), ValueError, "one axis"),
        (lambda f: f(1.0, offsets=[0, 1, 1]), ValueError, "one axis"),
        (lambda f: f(np.ones((3, 1))), ValueError, r"\(2, n\)"),
        (
            lambda f: f.integrate(0, [1, 2, 3]),
            ValueError,
            "b must be a number or one for each",
        ),
        (lambda f: f.integrate("a", 1), TypeError, "a must"),
        (lambda f: f.inverse(0.5), ValueError, "row 1: .*strictly monotone"),
        (lambda f: f.antiderivative(101), ValueError, "at most 100"),
        (lambda f: f.derivative(-1), ValueError, "at least 0"),
        (lambda _: ss.PiecewiseRows(), TypeError, "fit_many_monotone"),
        (lambda _: ss.MonotoneRows(), TypeError, "fit_many_monotone"),
    ],
)
def test_bad_calls_of_rows(call, exception, message):
    f = ss.fit_many_monotone([[0, 1, 2], [0, 1, 2]], [[0, 1, 2], [0, 1, 1]])
    with pytest.raises(exception, match=message):
        call(f)


@pytest.mark.parametrize(
    ("x", "y", "options", "message"),
    [
        ([[0, 1], [1, 1]], [[0, 1], [0, 1]], {}, r"row 1: x\[1\]"),
        ([[0, 1]], [[0, 1, 2]], {}, "same shape"),
        ([0, 1], [0, 1], {}, "two axes, or one and offsets"),
        ([0, 1, 2], [0, 1, 2], {"offsets": [0, 2]}, r"offsets\[1\] = 2"),
        ([0, 1, 2], [0, 1, 2], {"offsets": [0, 3, 1]}, r"offsets\[2\] = 1"),
        ([[0, 1]], [[0, 1]], {"kind": "linear"}, "'cubic', 'quintic', 'quartic'"),
        (np.empty((0, 4)), np.empty((0, 4)), {}, "at least one row"),
    ],
)
def test_bad_rows(x, y, options, message):
    with pytest.raises(ValueError, match=message):
        ss.fit_many_monotone(x, y, **options)


def test_bezier_like_curves(rng):
    control, t = rng.normal(size=(4, 3)), np.linspace(0, 1, 21)
    for degree in (3, 4, 5):
        more = {} if degree == 3 else {"alpha": 0.8, "beta": 0.5}
        r = ss.bezier_like(degree, control, t, a=2, b=1.5, **more)
        np.testing.assert_allclose(r[[0, -1]], control[[0, -1]], rtol=1e-14)
        d = ss.bezier_like(degree, control, [0.0, 1.0], a=2, b=1.5, nu=1, **more)
        ends = [2 * (control[1] - control[0]), 1.5 * (control[3] - control[2])]
        np.testing.assert_allclose(d, ends, rtol=1e-12)
        one = ss.bezier_like(degree, np.ones(4), t, a=2, b=1.5, **more)
        np.testing.assert_allclose(one, 1, rtol=1e-14)
        assert ss.bezier_like(degree, control, 0.5).shape == (3,)


@pytest.mark.parametrize(
    ("degree", "control", "options", "message"),
    [
        (6, np.eye(4), {}, "degree must be 3, 4 or 5, got 6"),
        (3, np.eye(3), {}, r"\(4, dim\)"),
        (3, np.eye(4), {"alpha": 1.0}, "alpha"),
        (4, np.eye(4), {"beta": np.nan}, "beta must be finite"),
        (4, np.full(4, np.nan), {}, r"control\[0\]"),
    ],
)
def test_bad_curves(degree, control, options, message):
    with pytest.raises(ValueError, match=message):
        ss.bezier_like(degree, control, 0.5, **options)
