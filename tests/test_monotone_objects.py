# SPDX-License-Identifier: MIT OR Apache-2.0

"""Monotone interpolants as Python objects, and what they refuse."""

import copy
import pickle
import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

import shapespline as ss

X, Y = np.array([0.0, 1, 2.5, 4]), np.array([0.0, 1, 1.5, 4])
FAMILIES = [ss.MonotoneCubic, ss.MonotoneQuartic, ss.MonotoneQuintic]
Q = np.linspace(-1, 5, 40)


def same(a, b):
    assert type(a) is type(b)
    for nu in range(4):
        np.testing.assert_array_equal(a(Q, nu), b(Q, nu))
    if isinstance(a, ss.MonotoneSpline):
        assert a.diagnostics == b.diagnostics
        own = (
            ("lower_bound", "interval_gaps")
            if isinstance(a, ss.MonotoneCubic)
            else ("alpha", "beta")
        )
        for name in ("y", "slopes", "second_derivatives", "bending_energy", *own):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickling(family, protocol):
    for f in (family(X, Y, extrapolate="clip"), family(X, np.stack([Y, -Y]), 1)):
        for g in (f, f.derivative(), f.antiderivative()):
            same(g, pickle.loads(pickle.dumps(g, protocol)))
    diagnostics = family(X, Y).diagnostics
    assert pickle.loads(pickle.dumps(diagnostics, protocol)) == diagnostics


@pytest.mark.parametrize("family", FAMILIES)
def test_copying_hashing_and_immutability(family):
    f = family(X, Y)
    same(f, copy.copy(f))
    same(f, copy.deepcopy(f))
    assert f != family(X, Y)
    assert len({f, f, family(X, Y)}) == 2
    before = f(Q)
    f.x[:] = f.y[:] = f.slopes[:] = 7
    np.testing.assert_array_equal(f(Q), before)
    with pytest.raises(AttributeError):
        f.x = X
    with pytest.raises(AttributeError):
        f.something = 1
    assert family.__name__ in repr(f)


@pytest.mark.parametrize("family", FAMILIES)
def test_any_array_like(family):
    expected = family(X, Y)(Q)
    strided = np.stack([Y, Y], 1)[:, 0]
    readonly = Y.copy()
    readonly.flags.writeable = False
    for y in (list(Y), strided, readonly, pd.Series(Y, index=[3, 1, 2, 0]), Y.astype(np.float32)):
        np.testing.assert_array_equal(family(X, y)(Q), expected)
    assert isinstance(family(X, Y)(1), float)
    assert isinstance(family(X, Y)(np.float64(1.5)), float)
    assert family(X, Y)([]).shape == (0,)


def test_shared_between_threads(rng):
    f = ss.MonotoneQuintic(np.arange(1000.0), np.cumsum(rng.random(1000)))
    q = rng.uniform(0, 999, 100_000)
    with ThreadPoolExecutor(4) as pool:
        for values in pool.map(lambda _: f(q), range(8)):
            np.testing.assert_array_equal(values, f(q))


@pytest.mark.parametrize("base", [ss.PiecewisePolynomial, ss.MonotoneSpline])
def test_bases_are_not_made(base):
    with pytest.raises(TypeError, match="MonotoneQuintic"):
        base()


def with_value(array, index, value):
    array = np.array(array, dtype=float)
    array[index] = value
    return array


BAD = {
    "NaN in y": (X, with_value(Y, 2, np.nan), {}, ["y[2]", "NaN"]),
    "infinity in y": (X, with_value(Y, 1, np.inf), {}, ["y[1]", "inf"]),
    "NaN in x": (with_value(X, 3, np.nan), Y, {}, ["x[3]", "NaN"]),
    "x stands still": (with_value(X, 2, 1.0), Y, {}, ["x[2]", "1", "increasing"]),
    "x goes back": (X[::-1], Y, {}, ["x[1]", "2.5", "increasing"]),
    "one point": (X[:1], Y[:1], {}, ["1", "2"]),
    "no points": (X[:0], Y[:0], {}, ["0", "2"]),
    "lengths": (X, Y[:3], {}, ["y has 3", "x has 4"]),
    "x of two axes": (X[:, None], Y, {}, ["x", "(4, 1)"]),
    "y without axis": (X, 3.0, {}, ["y", "axis"]),
    "axis": (X, Y, {"axis": 1}, ["axis", "-1", "0", "1"]),
    "column": (X, with_value(np.stack([Y, Y], 1), (2, 1), np.nan), {}, ["y[2, 1]", "NaN"]),
    "row": (X, with_value(np.stack([Y, Y]), (1, 2), np.inf), {"axis": 1}, ["y[1, 2]", "inf"]),
    "slopes": (X, Y, {"slopes": "akima"}, ["slopes", "'akima'", "an array"]),
    "slopes' shape": (X, Y, {"slopes": Y[:3]}, ["slopes", "shape"]),
    "infinite slope": (X, Y, {"slopes": with_value(Y, 1, np.inf)}, ["slopes[1]", "inf"]),
    "extrapolate": (X, Y, {"extrapolate": "cubic"}, ["extrapolate", "'cubic'", "'clip'"]),
    "extrapolate of three": (X, Y, {"extrapolate": ("clip",) * 3}, ["extrapolate", "pair", "3"]),
    "extrapolate's side": (X, Y, {"extrapolate": ("clip", "x")}, ["extrapolate", "'x'", "pair"]),
    "overflow": (X, [-1.7e308, 0, 1, 1.7e308], {}, ["y[", "range"]),
}


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("case", BAD)
def test_bad_values(family, case):
    x, y, options, pieces = BAD[case]
    with pytest.raises(ValueError) as error:
        family(x, y, **options)
    for piece in pieces:
        assert piece in str(error.value), f"{piece!r} is not in {error.value}"


@pytest.mark.parametrize(
    ("call", "exception", "message"),
    [
        (lambda: ss.MonotoneQuintic(X, Y, energy="fair"), ValueError, "'bending', 'parametric'"),
        (lambda: ss.MonotoneQuintic(X, Y, energy=1), TypeError, "energy must be a string"),
        (lambda: ss.MonotoneQuartic(X, Y, slopes="optimal"), ValueError, "'optimal'"),
        (lambda: ss.MonotoneQuartic(X, Y, shape=-1), ValueError, "-1"),
        (lambda: ss.MonotoneQuartic(X, Y, shape=np.ones(3)), ValueError, "pair"),
        (lambda: ss.MonotoneQuartic(X, Y, shape=([1], [1, 1, 1])), ValueError, "alpha has 1"),
        (lambda: ss.MonotoneQuintic(X, ["a"] * 4), TypeError, "y must hold real numbers"),
        (lambda: ss.MonotoneQuintic(X, Y * 1j), TypeError, "y must hold real numbers"),
        (lambda: ss.MonotoneQuintic(X, Y, axis="0"), TypeError, "axis must be an integer"),
        (lambda: ss.MonotoneQuintic(X, Y, extrapolate=2.5), TypeError, "extrapolate must be"),
        (lambda: ss.MonotoneQuintic(X, Y)(0.5, -1), ValueError, "nu must be at least 0"),
        (lambda: ss.MonotoneQuintic(X, Y)("a"), TypeError, "x must"),
        (lambda: ss.MonotoneQuintic(X, Y).antiderivative(101), ValueError, "at most 100"),
        (lambda: ss.MonotoneQuintic(X, Y).integrate("a", 1), TypeError, "a must be a number"),
        (lambda: ss.MonotoneQuintic(X, Y, extrapolate=("clip", None)), TypeError, "extrapolate"),
        (lambda: ss.MonotoneQuintic(X, Y).solve(np.inf), ValueError, "y must be finite"),
        (lambda: ss.MonotoneQuintic(X, Y * 0).inverse(0.0), ValueError, "strictly monotone"),
        (lambda: ss.MonotoneQuintic(X, np.stack([Y, Y], 1)).inverse(0.0), ValueError, "one axis"),
    ],
)
def test_bad_calls(call, exception, message):
    with pytest.raises(exception, match=re.escape(message)):
        call()
