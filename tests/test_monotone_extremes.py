# SPDX-License-Identifier: MIT OR Apache-2.0

"""Extreme but valid data, and properties that hold for all: never NaN from finite data."""

import re
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import shapespline as ss

FAMILIES = [
    (ss.MonotoneCubic, {}),
    (ss.MonotoneCubic, {"ends": "natural", "layer": 0.0}),
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
    (ss.MonotoneQuintic, {}),
]
TINY, LARGE = 5e-324, sys.float_info.max

EXTREMES = {
    "x over 300 decades": (np.r_[0, 10.0 ** np.arange(-150, 151, 20)], np.arange(17.0)),
    "y over 300 decades": (np.arange(17.0), np.r_[0, 10.0 ** np.arange(-150, 151, 20)]),
    "x over 600 decades": ([0, 1e-300, 1, 1e300], [0.0, 1, 2, 3]),
    "y over 600 decades": ([0.0, 1, 2, 3], [0, 1e-300, 1, 1e300]),
    "denormal x": (np.array([0, 1, 2, 5, 9]) * TINY, [0.0, 1, 2, 3, 5]),
    "denormal y": ([0.0, 1, 2, 3, 4], np.array([0, 1, 2, 5, 9]) * TINY),
    "denormal both": (np.array([0, 1, 2, 5]) * TINY, np.array([0, 3, 5, 6]) * TINY),
    "denormal step": ([0.0, 1, 2, 3], [0, TINY, 1, 2]),
    "near overflow x": (np.array([-0.4, -0.1, 0.2, 0.4]) * LARGE, [0.0, 1, 2, 3]),
    "near overflow y": ([0.0, 1, 2, 3], np.array([-0.007, 0, 0.003, 0.007]) * LARGE),
    "neighbouring floats": ([1, np.nextafter(1, 2), 2], [0.0, 1, 2]),
    "small and large": ([1e-300, 2e-300, 3e-300], [1e200, 2e200, 9e200]),
    "large and small": ([1e200, 2e200, 3e200], [1e-300, 2e-300, 9e-300]),
}


def check(f, x, y):
    """Check that values are between their neighbours' and rise, and that nothing is NaN."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    share = np.linspace(0, 1, 33)
    q = np.minimum(x[:-1, None] + np.diff(x)[:, None] * share, x[1:, None])
    v = f(q)
    low, high = np.minimum(y[:-1], y[1:])[:, None], np.maximum(y[:-1], y[1:])[:, None]
    assert ((low <= v) & (v <= high)).all()
    direction = np.sign(np.diff(y))[:, None]
    room = 8 * np.spacing(np.maximum(abs(low), abs(high)))
    assert (np.diff(v, axis=1) * direction >= -room).all()
    np.testing.assert_array_equal(f(x), y)
    for nu in (1, 2, 3):
        assert not np.isnan(f(q, nu)).any()
    assert not np.isnan(f.slopes).any()
    assert not np.isnan(f.second_derivatives).any()
    assert not np.isnan(f.bending_energy)
    if (np.diff(y) > 0).all():
        levels = np.r_[y, y[:-1] / 2 + y[1:] / 2]
        found = f.inverse(levels)
        assert ((x[0] <= found) & (found <= x[-1])).all()


def fitted(family, options, case):
    """Return the fit, or the text of the refusal."""
    try:
        return family(*EXTREMES[case], **options), ""
    except ValueError as error:
        return None, str(error)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("case", EXTREMES)
def test_extremes_work_or_are_refused(family, options, case):
    f, refusal = fitted(family, options, case)
    if f is None:
        # A refusal says what is out of range, and where.
        assert "out of the range of double precision" in refusal
        assert re.search(r"[xy]\[\d+\]", refusal)
    else:
        check(f, *EXTREMES[case])


def test_most_extremes_work():
    fits = [fitted(*f, case)[0] for f in FAMILIES for case in EXTREMES]
    assert sum(f is not None for f in fits) >= 2 * len(EXTREMES)


moderate = st.floats(-1e6, 1e6, allow_subnormal=False)
steps = st.floats(1e-6, 1e6)


@st.composite
def data(draw):
    """Any data: steps of x over twelve decades, y monotone or not, repeats."""
    n = draw(st.integers(2, 25))
    x = np.cumsum(draw(st.lists(steps, min_size=n, max_size=n)))
    y = np.array(draw(st.lists(moderate, min_size=n, max_size=n)))
    if draw(st.booleans()):
        y = np.sort(y)
    return x, np.maximum(y, draw(st.sampled_from([-1e6, 0.0])))


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@settings(max_examples=60, deadline=None)
@given(xy=data())
def test_every_segment_is_monotone(family, options, xy):
    x, y = xy
    check(family(x, y, **options), x, y)


@settings(max_examples=60, deadline=None)
@given(xy=data(), ends=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_integrals_add_up(xy, ends):
    x, y = xy
    f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    a, b = x[0] + (x[-1] - x[0]) * np.asarray(ends)
    size = (x[-1] - x[0]) * max(abs(y).max(), 1e-300)
    total = f.integrate(x[0], a) + f.integrate(a, b) + f.integrate(b, x[-1])
    assert abs(total - f.integrate(x[0], x[-1])) <= 1e-13 * size
    area = f.antiderivative()
    assert abs(area(b) - area(a) - f.integrate(a, b)) <= 1e-13 * size


@settings(max_examples=60, deadline=None)
@given(rises=st.lists(steps, min_size=1, max_size=20), share=st.floats(0, 1))
def test_the_inverse_is_one(rises, share):
    y = np.r_[0, np.cumsum(rises)]
    f = ss.MonotoneQuintic(np.arange(float(len(y))), y)
    level = share * y[-1]
    x = f.inverse(level)
    assert abs(f(x) - level) <= 1e-14 * y[-1] + 2 * f(x, 1) * np.spacing(x)


def test_integrals_over_many_segments_are_accurate(rng):
    """Over large data as over small parts: no running sums whose rounding errors pile up."""
    n = 200_000
    x = np.cumsum(rng.uniform(0.5, 1.5, n))
    f = ss.MonotoneQuintic(x, np.cumsum(rng.random(n)), slopes="fritsch-butland")
    for _ in range(20):
        a, b = np.sort(rng.uniform(x[0], x[-1], 2))
        i, j = np.searchsorted(x, [a, b])
        inner = f.to_bpoly().c[:, i : j - 1].mean(0) * np.diff(x[i:j])
        expected = np.sum(inner) + f.integrate(a, x[i]) + f.integrate(x[j - 1], b)
        assert f.integrate(a, b) == pytest.approx(expected, rel=1e-14)
