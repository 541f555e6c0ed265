"""Many rows with their own x, and Bézier-like curves."""

import pickle

import numpy as np
import pytest

import shapespline as ss

CLASSES = {"quintic": ss.MonotoneQuintic, "quartic": ss.MonotoneQuartic}


@pytest.mark.parametrize("kind", CLASSES)
@pytest.mark.parametrize("rows", [3, 700])
def test_rows_are_the_single_fits(rng, kind, rows):
    x, y = np.cumsum(rng.uniform(0.5, 2, (rows, 20)), 1), np.cumsum(rng.random((rows, 20)), 1)
    f = ss.fit_many_monotone(x, y, kind, extrapolate="clip")
    ragged = ss.fit_many_monotone(
        x.ravel(), y.ravel(), kind, offsets=np.arange(rows + 1) * 20, extrapolate="clip"
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


@pytest.mark.parametrize(
    ("x", "y", "options", "message"),
    [
        ([[0, 1], [1, 1]], [[0, 1], [0, 1]], {}, r"row 1: x\[1\]"),
        ([[0, 1]], [[0, 1, 2]], {}, "same shape"),
        ([0, 1], [0, 1], {}, "two axes, or one and offsets"),
        ([0, 1, 2], [0, 1, 2], {"offsets": [0, 2]}, r"offsets\[1\] = 2"),
        ([0, 1, 2], [0, 1, 2], {"offsets": [0, 3, 1]}, r"offsets\[2\] = 1"),
        ([[0, 1]], [[0, 1]], {"kind": "cubic"}, "'quintic', 'quartic'"),
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
