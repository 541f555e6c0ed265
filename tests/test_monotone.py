# SPDX-License-Identifier: MIT OR Apache-2.0

"""Monotone interpolation of one variable: shape, energies, options, inverse."""

from pathlib import Path

import numpy as np
import pytest

import shapespline as ss

DATA = Path(__file__).parent / "data"
FAMILIES = [
    (ss.MonotoneCubic, {}),
    (ss.MonotoneCubic, {"ends": "natural", "layer": 0.0}),
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuintic, {}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
]


def published(name):
    return np.loadtxt(DATA / name, delimiter=",", comments="#", skiprows=2, unpack=True)


def steps(rng, n):
    """Increasing data with steps over many decades, and repeats."""
    x = np.cumsum(10.0 ** rng.uniform(-3, 3, n))
    rises = 10.0 ** rng.uniform(-6, 6, n) * (rng.random(n) > 0.2)
    return x, np.cumsum(rises)


@pytest.mark.parametrize(
    ("name", "paper", "least"), [("rpn14.csv", 16.986, 9.818), ("akima.csv", 15986, 4569.4)]
)
def test_published_energies(name, paper, least):
    x, y = published(name)
    fixed = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    assert fixed.bending_energy == pytest.approx(paper, rel=5e-5)
    assert fixed.diagnostics.solver == "active-set"
    assert fixed.diagnostics.kkt_residual < 1e-10
    best = ss.MonotoneQuintic(x, y)
    assert least * (1 - 1e-4) <= best.bending_energy <= least * 1.005
    assert best.diagnostics.converged
    assert best.diagnostics.certified
    assert best.diagnostics.energy == best.bending_energy


@pytest.mark.parametrize("size", [1, -1, 1e-80])
def test_straight_data_beside_a_jump_stay_straight(size):
    x = np.arange(41.0)
    f = ss.MonotoneQuintic(x, size * (x + 1000 * (x > 20)))
    for q, shift in ((np.linspace(0, 10, 501), 0), (np.linspace(31, 40, 501), 1000)):
        assert abs(f(q) / size - q - shift).max() < 2.6e-5
        assert abs(f(q, 1) / size - 1).max() < 5e-4


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("n", [2, 3, 7, 50, 300])
def test_monotone_to_the_last_bits_and_within_the_data(rng, family, options, n):
    x, y = steps(rng, n)
    f = family(x, y, **options)
    q = np.sort(np.concatenate([x, rng.uniform(x[0], x[-1], 20_000)]))
    values = f(q)
    assert np.diff(values).min() >= -4 * np.spacing(y[-1] - y[0])
    i = np.clip(np.searchsorted(x, q, "right") - 1, 0, n - 2)
    assert (values >= y[i]).all()
    assert (values <= y[i + 1]).all()
    np.testing.assert_array_equal(f(x), y)
    np.testing.assert_array_equal(family(x, -y, **options)(q), -values)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_flats_stay_flat_and_turns_are_kept(family, options):
    f = family([0, 1, 2, 3, 4], [0.0, 2, 2, 1, 3], **options)
    np.testing.assert_array_equal(f(np.linspace(1, 2, 101)), 2.0)
    assert (np.diff(f(np.linspace(2, 3, 101))) <= 0).all()
    assert f(3.0, 1) == 0.0


def test_smoothness_at_knots(rng):
    x, y = np.cumsum(rng.uniform(0.5, 2, 30)), np.cumsum(rng.uniform(0, 2, 30))
    for family, orders in [(ss.MonotoneQuintic, 3), (ss.MonotoneQuartic, 2)]:
        f = family(x, y)
        piece = f.to_bpoly()
        for nu in range(orders):
            d = piece.derivative(nu) if nu else piece
            jumps = d.c[-1, :-1] - d.c[0, 1:]
            assert abs(jumps).max() <= 1e-12 * abs(d.c).max()
        np.testing.assert_array_equal(f(x, 1), f.slopes)
    f = ss.MonotoneQuintic(x, y)
    np.testing.assert_array_equal(f(x, 2), f.second_derivatives)


@pytest.mark.parametrize("family", [ss.MonotoneQuartic, ss.MonotoneQuintic])
def test_extrapolation(family):
    x, y = [0.0, 1, 2, 4], [0.0, 1, 1.5, 4]
    f = family(x, y)
    outside = np.array([-1.0, 6.0])
    np.testing.assert_array_equal(f(outside), f(outside, extrapolate="linear"))
    assert np.isnan(f(outside, extrapolate=False)).all()
    np.testing.assert_array_equal(f(outside, extrapolate="clip"), [0, 4])
    np.testing.assert_array_equal(f(outside, 1, extrapolate="clip"), [0, 0])
    line = [-f.slopes[0], 4 + 2 * f.slopes[-1]]
    np.testing.assert_allclose(f(outside, extrapolate="linear"), line, rtol=1e-15)
    np.testing.assert_allclose(f(outside, extrapolate="periodic"), f([3.0, 2.0]), rtol=1e-15)
    for mode in (True, False, "linear", "clip", "periodic"):
        made = family(x, y, extrapolate=mode)
        np.testing.assert_array_equal(made(outside), f(outside, extrapolate=mode))
        np.testing.assert_array_equal(made.derivative()(outside), made(outside, 1))
        slope = made.antiderivative().derivative()
        np.testing.assert_allclose(slope(outside), made(outside), rtol=1e-13)


def test_nan_queries_give_nan():
    f = ss.MonotoneQuintic([0, 1, 2], [0, 1, 4])
    for mode in (True, False, "linear", "clip"):
        np.testing.assert_array_equal(
            np.isnan(f([0.5, np.nan, 1.5], extrapolate=mode)), [False, True, False]
        )
        assert np.isnan(f(np.nan, 1, mode))
    assert np.isnan(f.inverse(np.nan))


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("axis", [0, 1, 2, -1])
def test_columns_along_any_axis(rng, family, options, axis):
    y = rng.normal(size=(5, 6, 7))
    n = y.shape[axis]
    x = np.arange(float(n)) ** 1.5
    f = family(x, y, axis, **options)
    assert f.axis == axis % 3
    q = rng.uniform(-1, x[-1] + 1, (4, 2))
    values, moved = f(q), np.moveaxis(y, axis, 0).reshape(n, -1)
    rest = [s for k, s in enumerate(y.shape) if k != axis % 3]
    expected = np.stack([family(x, c, **options)(q) for c in moved.T], -1)
    expected = np.moveaxis(expected.reshape(4, 2, *rest), (0, 1), (axis % 3, axis % 3 + 1))
    np.testing.assert_array_equal(values, expected)
    np.testing.assert_array_equal(f.y, y)
    assert f.slopes.shape == f.second_derivatives.shape == y.shape
    if not isinstance(f, ss.MonotoneCubic):
        assert f.alpha.shape[axis] == n - 1
    assert f.bending_energy.shape == tuple(rest)
    assert len(f.diagnostics) == moved.shape[1]
    assert f(0.5).shape == f.integrate(0, 1).shape == f.roots().shape == tuple(rest)
    again = family(x, y, axis, **(options | {"slopes": f.slopes}))
    np.testing.assert_allclose(again.slopes, f.slopes, rtol=1e-14)
    if family is ss.MonotoneQuartic:
        np.testing.assert_allclose(again(q), values, rtol=1e-9, atol=1e-9)
    else:
        # Given slopes have all second derivatives to choose from, the paper a box of them.
        assert (again.bending_energy <= f.bending_energy * 1.005).all()


def test_many_columns_in_parallel(rng):
    y = np.cumsum(rng.random((20, 3000)), 0)
    f = ss.MonotoneQuintic(np.arange(20.0), y)
    q = np.linspace(0, 19, 50)
    for k in (0, 1234, 2999):
        np.testing.assert_array_equal(f(q)[:, k], ss.MonotoneQuintic(np.arange(20.0), y[:, k])(q))


def test_inverse_is_the_quantile_function(rng):
    x = np.sort(rng.normal(size=200))
    p = (np.arange(200) + 0.5) / 200
    f = ss.MonotoneQuintic(x, p, extrapolate=False)
    q = rng.uniform(p[0], p[-1], (100, 100))
    found = f.inverse(q)
    # No x does better than its own rounding lets it.
    limit = 1e-15 + 2 * f(found, 1) * np.spacing(abs(found))
    assert (abs(f(found) - q) <= limit).all()
    np.testing.assert_array_equal(f.inverse(p), x)
    assert isinstance(f.inverse(0.5), float)
    assert np.isnan(f.inverse([0.0, 1.0])).all()
    down = ss.MonotoneQuartic(x, -p)
    np.testing.assert_allclose(down(down.inverse(-q)), -q, rtol=0, atol=1e-13)


def test_shape_of_the_quartic():
    x, y = [0.0, 1, 2, 4], [0.0, 1, 1.5, 4]
    f = ss.MonotoneQuartic(x, y)
    assert (f.alpha <= 1).all()
    assert (ss.MonotoneQuartic(x, y, shape=3).alpha > 1).any()
    pair = ss.MonotoneQuartic(x, y, shape=(np.ones(3), np.ones(3)))
    np.testing.assert_array_equal(pair([0.3, 1.7]), f([0.3, 1.7]))
    zero = ss.MonotoneQuartic(x, y, shape=0)
    np.testing.assert_array_equal(zero.alpha, 0)
