# SPDX-License-Identifier: MIT OR Apache-2.0

"""Calculus of the monotone interpolants beside SciPy's piecewise polynomials of the same."""

import numpy as np
import pytest

import shapespline as ss


def make(family, rng, **options):
    x = np.cumsum(rng.uniform(0.5, 2, 12))
    return family(x, np.cumsum(rng.normal(0, 1, 12)), **options)


@pytest.fixture(params=[ss.MonotoneCubic, ss.MonotoneQuartic, ss.MonotoneQuintic])
def f(request, rng):
    return make(request.param, rng, extrapolate=True)


def close(a, b):
    np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12 * max(1.0, np.abs(b).max(initial=0)))


def test_values_and_derivatives(f, rng):
    b, p = f.to_bpoly(), f.to_ppoly()
    inside, both = rng.uniform(f.x[0], f.x[-1], 500), rng.uniform(f.x[0] - 0.5, f.x[-1] + 0.5, 500)
    close(f(both), b(both))
    close(f(inside), p(inside))
    for nu in range(1, 7):
        # SciPy's own Bernstein form has no derivatives of higher order than its degree.
        expected = p(both, nu)
        scale = max(1.0, np.abs(expected).max())
        np.testing.assert_allclose(f(both, nu) / scale, expected / scale, rtol=0, atol=1e-12)
        np.testing.assert_allclose(
            f.derivative(nu)(both) / scale, expected / scale, rtol=0, atol=1e-12
        )


def test_integrals(f, rng):
    p = f.to_ppoly()
    q = rng.uniform(f.x[0], f.x[-1], 100)
    for nu in (1, 2, 3):
        close(f.antiderivative(nu)(q), p.antiderivative(nu)(q))
    ends = rng.uniform(f.x[0] - 0.5, f.x[-1] + 0.5, (20, 2))
    for a, b in ends:
        close(f.integrate(a, b), p.integrate(a, b))
    assert np.isnan(f.integrate(f.x[0] - 1, f.x[-1], extrapolate=False))


def test_solutions(f):
    p = f.to_ppoly()
    for y in (0.0, *((f.y[1:] + f.y[:-1]) / 2)):
        close(f.solve(y, extrapolate=False), p.solve(y, extrapolate=False))
    close(f.roots(extrapolate=False), p.roots(extrapolate=False))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_axes(rng, axis):
    y = rng.normal(size=(4, 5, 6))
    x = np.arange(float(y.shape[axis]))
    f = ss.MonotoneQuintic(x, y, axis)
    q = rng.uniform(0, x[-1], (2, 3))
    for other in (f.to_bpoly(), f.to_ppoly()):
        close(f(q), other(q))
        close(f.integrate(0.2, 1.7), other.integrate(0.2, 1.7))
    close(f.derivative()(q), f.to_bpoly().derivative()(q))


def test_extrapolation_goes_along(rng):
    out = [-100.0, 100.0]
    for mode in (False, "linear", "clip", (True, "linear")):
        f = make(ss.MonotoneQuintic, rng, extrapolate=mode)
        assert np.isnan(f.to_bpoly()(out)).all()
        assert np.isnan(f.to_ppoly()(out)).all()
    f = make(ss.MonotoneQuintic, rng, extrapolate="periodic")
    close(f.to_bpoly()(out), f(out))
    close(f.to_ppoly()(out), f(out))
    close(f.to_ppoly().integrate(*out), f.integrate(*out))


MAKERS = {
    "cubic": ss.MonotoneCubic,
    "cubic without layers": lambda x, y: ss.MonotoneCubic(x, y, layer=0, ends="natural"),
    "quartic": ss.MonotoneQuartic,
    "quintic": ss.MonotoneQuintic,
    "derivative": lambda x, y: ss.MonotoneQuintic(x, y).derivative(3),
}


@pytest.mark.parametrize("maker", MAKERS)
def test_bsplines_are_the_same_functions(rng, maker):
    for case in range(50):
        n = int(rng.integers(2, 10))
        x = np.cumsum(rng.uniform(0.1, 1, n))
        y = rng.integers(-3, 4, n) * 1.0 if case % 2 else np.cumsum(rng.lognormal(0, 2, n))
        f = MAKERS[maker](x, y)
        b, q = f.to_bspline(), np.linspace(x[0], x[-1], 200)[:-1]
        np.testing.assert_allclose(b(q), f(q), rtol=0, atol=1e-10 * np.abs(f(q)).max())
        if maker == "cubic":
            assert len(b.t) == len(f.knots) + 6  # simple knots


def test_bsplines_of_columns(rng):
    x, y = np.arange(8.0), np.cumsum(rng.lognormal(0, 2, (3, 8)), 1)
    f = ss.MonotoneCubic(x, y, 1)
    q = np.linspace(0, 6.9, 100)
    np.testing.assert_allclose(f.to_bspline()(q), f(q), rtol=1e-12)
