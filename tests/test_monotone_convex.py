# SPDX-License-Identifier: MIT OR Apache-2.0

"""`convex=` of `MonotoneCubic`: convex and concave where the data are, and monotone."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import polygons
import shapespline as ss
from scale import scaled


def rough(rng, case):
    """Return integers, heavy tails, walks or smooth data, by turns."""
    n = int(rng.integers(3, 14))
    x = np.cumsum(rng.uniform(0.1, 1, n))
    match case % 4:
        case 0:
            y = np.cumsum(rng.integers(0, 4, n))
        case 1:
            y = np.cumsum(rng.lognormal(0, 2, n))
        case 2:
            y = rng.integers(-3, 4, n)
        case _:
            y = np.cumsum(rng.exponential(size=n))
    return x, y.astype(float)


def test_no_convex_segment_of_the_data_is_broken(rng):
    for case in range(scaled(500)):
        x, y = rough(rng, case)
        f = ss.MonotoneCubic(x, y, convex="data", ends=["natural", "estimated"][case % 2])
        report = ss.check_monotone(x, y, f, convex="data")
        assert report.ok, (case, report)
        # The same by sampling.
        secants = np.diff(y) / np.diff(x)
        change, size = np.diff(secants), np.abs(secants[1:]) + np.abs(secants[:-1])
        node = np.where(np.abs(change) > 1e-9 * size, np.sign(change), 0)
        node = np.r_[node[0], node, node[-1]]
        for i in np.flatnonzero(node[:-1] * node[1:] > 0):
            t = np.linspace(x[i], x[i + 1], 301)
            second = f(t, 2)
            second[0], second[-1] = f.derivative(2)(np.nextafter(x[i : i + 2], x[[i + 1, i]]))
            assert (second * node[i] >= -1e-9 * np.abs(second).max()).all(), (case, i)
            rounding = 4 * np.finfo(float).eps * np.abs(y).max()
            assert (np.diff(f(t)) * np.sign(secants[i]) >= -rounding).all()
            assert (f(t, 1) * np.sign(secants[i]) >= 0).all()


@pytest.mark.parametrize(("name", "energy"), [("rpn14", 7.67799664), ("akima", 4689.23862)])
def test_energies_of_the_specification(name, energy):
    x, y = polygons.load(name).values()
    f = ss.MonotoneCubic(x, y, convex="data", ends="natural")
    # The specification's program has eight knots per interval at fixed places: an upper bound.
    assert f.bending_energy <= energy * (1 + 1e-8)
    assert f.bending_energy >= ss.minimal_bending(x, y) * (1 - 1e-12)
    assert ss.check_monotone(x, y, f, convex="data").ok
    assert not ss.check_monotone(x, y, PchipInterpolator(x, y), convex="data").ok


def test_wholly_convex_data(rng):
    for _ in range(scaled(200)):
        x = np.cumsum(rng.uniform(0.1, 1, 12))
        y = np.exp(x)
        f = ss.MonotoneCubic(x, y, convex="data")
        q = np.linspace(x[0], x[-1], 1000)
        assert (f(q, 2) >= 0).all()
        down = ss.MonotoneCubic(x, -y, convex="data")
        np.testing.assert_array_equal(down(q), -f(q))


def test_signs_per_interval_and_columns(rng):
    x, y = np.arange(6.0), np.array([0.0, 1, 3, 4, 4.5, 4.75])
    signs = np.array([1, 0, -1, -1, -1])
    f = ss.MonotoneCubic(x, y, convex=signs)
    assert ss.check_monotone(x, y, f, convex=signs).ok
    columns = ss.MonotoneCubic(x, np.stack([y, y], 1), convex=np.stack([signs, 0 * signs], 1))
    q = np.linspace(0, 5, 99)
    np.testing.assert_array_equal(columns(q)[:, 0], f(q))
    np.testing.assert_array_equal(columns(q)[:, 1], ss.MonotoneCubic(x, y)(q))
    rows = ss.fit_many_monotone([x, x], [y, y], convex=[signs, 0 * signs])
    np.testing.assert_array_equal(rows(q)[0], f(q))
    ragged = ss.fit_many_monotone(x, y, convex="data", offsets=[0, 6])
    np.testing.assert_array_equal(ragged(q), [ss.MonotoneCubic(x, y, convex="data")(q)])
    assert type(ss.fit_monotone(x, y, convex="data")) is ss.MonotoneCubic


@pytest.mark.parametrize(
    ("convex", "index"),
    [([1, 1, 2], 2), ([1, 1], None), ("yes", None), ([-1, -1, 0], None), ([0, -1, -1], None)],
)
def test_contradictions_are_refused(convex, index):
    """Two concave intervals beside each other contradict data that are convex there."""
    with pytest.raises(ss.InputError, match="convex") as error:
        ss.MonotoneCubic([0, 1, 2, 3], [0, 1, 4, 9], convex=convex)
    assert error.value.argument == "convex"
    if index is not None:
        assert error.value.index == index


def test_only_the_cubic_has_it():
    with pytest.raises(TypeError, match="kinds that have it: 'cubic'"):
        ss.fit_monotone([0, 1], [0, 1], kind="quintic", convex="data")
    with pytest.raises(ss.InputError, match="convex is for kind 'cubic'"):
        ss.fit_many_monotone([[0, 1]], [[0, 1]], kind="quintic", convex="data")
    with pytest.raises(ss.InputError, match="offsets"):
        ss.fit_many_monotone([0, 1], [0, 1], convex=[1], offsets=[0, 2])
