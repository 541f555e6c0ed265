# SPDX-License-Identifier: MIT OR Apache-2.0

"""Given slopes of the quintic: taken as they are, refused by name, or limited."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize

import shapespline as ss
from scale import scaled


def logistic(x):
    return 1 / (1 + np.exp(-x))


SMOOTH = {
    "exp": (np.exp, np.exp, 0, 1),
    "logistic": (logistic, lambda x: logistic(x) * logistic(-x), -6, 6),
}


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("sign", [1, -1])
def test_of_order_four_and_as_good_as_cubic_hermite(name, sign):
    function, slope, start, end = SMOOTH[name]
    q, errors = np.linspace(start, end, 20_001), []
    for n in (11, 21, 41, 81):
        x = np.linspace(start, end, n)
        y, d = sign * function(x), sign * slope(x)
        f = ss.MonotoneQuintic(x, y, slopes=d)
        np.testing.assert_allclose(f.slopes, d, rtol=1e-14)
        assert f.diagnostics.limited == []
        errors.append(abs(f(q) - sign * function(q)).max())
        assert errors[-1] <= 1.1 * abs(CubicHermiteSpline(x, y, d)(q) - sign * function(q)).max()
    assert errors[-2] > 14 * errors[-1]


def rising(rng, n, flats=0.0):
    x = np.cumsum(rng.uniform(0.3, 1.3, n))
    y = np.cumsum(rng.uniform(0.1, 1.1, n) * (rng.random(n) >= flats))
    return x, y


def slopes(rng, x, y, most):
    """Slopes between 0 and `most` times the smaller secant, 0 beside flats."""
    secant = np.diff(y) / np.diff(x)
    least = np.minimum(np.r_[secant[0], secant], np.r_[secant, secant[-1]])
    return rng.uniform(0, most, len(x)) * least


def derivative_is_not_negative(f, sign=1):
    q = np.linspace(f.x[0], f.x[-1], 20_001)
    size = abs(f.slopes).max() + np.ptp(f.y) / np.diff(f.x).min()
    assert (sign * f(q, 1)).min() >= -1e-12 * size


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("flats", [0.0, 0.3])
def test_monotone_with_the_very_slopes(rng, sign, flats):
    for _ in range(scaled(400)):
        x, y = rising(rng, rng.integers(2, 12), flats)
        d = slopes(rng, x, y, 2.5)
        f = ss.MonotoneQuintic(x, sign * y, slopes=sign * d)
        np.testing.assert_array_equal(f.slopes, sign * d)
        derivative_is_not_negative(f, sign)
        assert f.diagnostics.certified
        assert f.diagnostics.converged


@pytest.mark.parametrize("share", [0.5, 0.9, 0.999, 1 - 1e-6, 1])
@pytest.mark.parametrize("other", [0, 0.01, 0.3, 1, 4, 6, 8])
def test_up_to_the_limit_and_no_further(share, other):
    """One segment admits slopes aΔ, bΔ exactly where 3a + 3b − 2√(ab) ≤ 24; a is the larger one."""
    root = np.roots([3, -2 * np.sqrt(other), 3 * other - 24]).max()
    d = [share * root**2, other] if share < 1 else [root**2 * (1 - 1e-12), other]
    f = ss.MonotoneQuintic([0, 1], [0, 1], slopes=d)
    np.testing.assert_array_equal(f.slopes, d)
    derivative_is_not_negative(f)
    with pytest.raises(ss.InputError, match="leave room for a C² monotone quintic"):
        ss.MonotoneQuintic([0, 1], [0, 1], slopes=[1.0001 * root**2, other])


def least_energy(x, y, d):
    """The least energy over the second derivatives, y' ≥ 0 asked on a grid."""
    h, secant = np.diff(x), np.diff(y) / np.diff(x)
    t = np.linspace(0, 1, 101)
    u = 1 - t
    bernstein = np.array([u**4, 4 * t * u**3, 6 * (t * u) ** 2, 4 * t**3 * u, t**4])
    cubic = np.array([u**3, 3 * t * u * u, 3 * t * t * u, t**3])
    weights = np.r_[0.5, np.ones(99), 0.5] / 100

    def coefficients(s):
        c0, c4 = d[:-1], d[1:]
        c1, c3 = c0 + h * s[:-1] / 4, c4 - h * s[1:] / 4
        return np.array([c0, c1, 5 * secant - c0 - c1 - c3 - c4, c3, c4])

    def energy(s):
        # Simpson's error is that of the sum, which both energies below have.
        second = 4 * np.diff(coefficients(s), axis=0).T @ cubic / h[:, None]
        return float((second**2 @ weights) @ h)

    found = minimize(
        energy,
        ss.MonotoneQuintic(x, y, slopes=d).second_derivatives,
        constraints={"type": "ineq", "fun": lambda s: (coefficients(s).T @ bernstein).ravel()},
        method="SLSQP",
        options={"maxiter": 300, "ftol": 1e-12},
    )
    return found.fun, energy


def test_the_least_energy_of_all_second_derivatives(rng):
    for _ in range(scaled(60)):
        x, y = rising(rng, 6)
        d = slopes(rng, x, y, 3)
        try:
            f = ss.MonotoneQuintic(x, y, slopes=d)
        except ss.InputError:
            continue
        theirs, energy = least_energy(x, y, d)
        assert energy(f.second_derivatives) <= 1.005 * theirs


def test_refused_by_name():
    x = [0, 1, 2, 3]
    for y, d, index, text in (
        ([0, 1, 2, 3], [1, -1, 1, 1], 1, "the sign of the data's secants, got -1"),
        ([0, 1, 2, 1], [1, 1, 0.5, -1], 2, "must be 0 at a turn of the data, got 0.5"),
        ([0, 1, 1, 2], [1, 0.5, 0, 1], 1, "must be 0 beside a flat of the data, got 0.5"),
        ([0, 1, 2, 3], [1, 1, 7, 7], 2, "leave room for a C² monotone quintic, got 7"),
    ):
        with pytest.raises(ss.InputError, match=text) as caught:
            ss.MonotoneQuintic(x, y, slopes=d)
        assert (caught.value.argument, caught.value.index) == ("slopes", index)
        assert caught.value.value == d[index]
        assert "clip=True" in str(caught.value)
        f = ss.MonotoneQuintic(x, y, slopes=d, clip=True)
        assert index in f.diagnostics.limited
        kept = [i for i in range(4) if i not in f.diagnostics.limited]
        np.testing.assert_array_equal(f.slopes[kept], np.asarray(d, float)[kept])
        assert f.diagnostics.certified


def test_limited_slopes_are_never_larger(rng):
    for _ in range(scaled(300)):
        x, y = rising(rng, rng.integers(2, 30), 0.1)
        d = rng.normal(0, 3, len(x))
        f = ss.MonotoneQuintic(x, y, slopes=d, clip=True)
        assert (abs(f.slopes) <= abs(d)).all()
        assert f.diagnostics.limited == np.flatnonzero(f.slopes != d).tolist()
        derivative_is_not_negative(f)
        again = ss.MonotoneQuintic(x, y, slopes=f.slopes)
        np.testing.assert_array_equal(again.slopes, f.slopes)


def test_columns_and_rows(rng):
    x = np.arange(7.0)
    y = np.cumsum(rng.uniform(0.5, 1, (7, 3)), 0)
    d = np.full((7, 3), 0.7)
    f = ss.MonotoneQuintic(x, y, slopes=d)
    for k in range(3):
        one = ss.MonotoneQuintic(x, y[:, k], slopes=d[:, k])
        np.testing.assert_array_equal(f([0.3, 4.4])[:, k], one([0.3, 4.4]))
    rows = ss.fit_many_monotone([x] * 3, y.T, slopes=d.T, kind="quintic")
    np.testing.assert_array_equal(rows(2.2), f(2.2))
    d[3, 1] = 20
    with pytest.raises(ss.InputError, match=r"slopes\[3, 1\] .* got 20"):
        ss.MonotoneQuintic(x, y, slopes=d)
    with pytest.raises(ss.InputError, match=r"row 1: slopes\[3\] .* got 20"):
        ss.fit_many_monotone([x] * 3, y.T, slopes=d.T, kind="quintic")
    limited = ss.MonotoneQuintic(x, y, slopes=d, clip=True)
    assert [c.limited for c in limited.diagnostics] == [[], [3], []]
    rows = ss.fit_many_monotone([x] * 3, y.T, slopes=d.T, clip=True, kind="quintic")
    np.testing.assert_array_equal(rows(2.2), limited(2.2))
    with pytest.raises(ss.InputError, match="clip=True is for kind 'quintic'"):
        ss.fit_many_monotone(x[None], y.T[:1], kind="quartic", clip=True)


def test_the_paper_s_program_is_fritsch_butland_alone():
    x = np.linspace(0, 1, 11)
    paper = ss.MonotoneQuintic(x, np.exp(x), slopes="fritsch-butland")
    given = ss.MonotoneQuintic(x, np.exp(x), slopes=paper.slopes)
    assert paper.diagnostics.solver == "active-set"
    assert given.diagnostics.solver == "interior-point"
    assert given.bending_energy < 0.6 * paper.bending_energy
