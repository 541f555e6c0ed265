# SPDX-License-Identifier: MIT OR Apache-2.0

"""`histospline`: rates that are not negative and have the totals of their bins."""

import numpy as np
import pytest

import shapespline as ss
from scale import scaled


def test_totals_are_kept_and_no_rate_is_negative(rng):
    for _ in range(scaled(1000)):
        n = int(rng.integers(1, 20))
        edges = np.cumsum(rng.uniform(0.1, 2, n + 1))
        totals = rng.lognormal(0, 2, n) * (rng.random(n) > 0.3)
        rate = ss.histospline(edges, totals)
        q = np.unique(np.append(np.linspace(edges[0], edges[-1], 999)[1:-1], rate.knots))
        assert (rate(q) >= 0).all()
        assert rate.degree == 2
        for k in range(n):
            within = rate.integrate(edges[k], edges[k + 1])
            assert within == pytest.approx(totals[k], abs=1e-12 * totals.sum(), rel=1e-12)
            if totals[k] == 0:
                inside = (q > edges[k]) & (q < edges[k + 1])
                assert (rate(q[inside]) == 0).all()
        # Continuous at the edges.
        before, after = np.nextafter(edges[1:-1], -np.inf), edges[1:-1]
        np.testing.assert_allclose(rate(before), rate(after), rtol=1e-9, atol=1e-9 * totals.max())


def test_equal_totals_are_a_constant_rate():
    rate = ss.histospline([0, 1, 3, 4], [2.0, 4.0, 2.0])
    np.testing.assert_allclose(rate(np.linspace(-1, 5, 50)), 2.0, rtol=1e-14)
    nothing = ss.histospline([0, 1, 3], [0.0, 0.0])
    np.testing.assert_array_equal(nothing([0.5, 2.0]), 0.0)


def test_columns_and_axis(rng):
    edges, totals = np.arange(6.0), rng.exponential(size=(3, 5))
    rate = ss.histospline(edges, totals, axis=1)
    for k in range(3):
        one = ss.histospline(edges, totals[k])
        np.testing.assert_allclose(rate([0.3, 2.2])[k], one([0.3, 2.2]), rtol=1e-13)


def test_outside_the_bins():
    edges, totals = [0, 1, 2, 3], [1.0, 3.0, 2.0]
    rate = ss.histospline(edges, totals)
    assert rate(5.0) == pytest.approx(rate(3.0))
    assert ss.histospline(edges, totals, extrapolate="clip")(5.0) == 0
    day = ss.histospline(edges, totals, ends="periodic", extrapolate="periodic")
    np.testing.assert_allclose(day([0.5, 1.5]), day([3.5, -1.5]), rtol=1e-12)


@pytest.mark.parametrize(
    ("edges", "totals", "argument", "index"),
    [
        ([0, 1, 2], [1.0, -2.0], "totals", 1),
        ([0, 1, 2], [np.nan, 1.0], "totals", 0),
        ([0, 1, 2], [1.0], "totals", None),
        ([0, 1, 2], [[1.0], [-1.0]], "totals", (1, 0)),
        ([0, 1, 1], [1.0, 2.0], "edges", 2),
        ([0], [], "edges", None),
        ([[0, 1]], [1.0], "edges", None),
    ],
)
def test_bad_input(edges, totals, argument, index):
    with pytest.raises(ss.InputError) as error:
        ss.histospline(edges, totals)
    assert (error.value.argument, error.value.index) == (argument, index)
