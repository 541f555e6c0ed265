# SPDX-License-Identifier: MIT OR Apache-2.0

"""What functions are outside their data: defaults, both sides, derivatives, integrals, infinity."""

import math

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import shapespline as ss

FAMILIES = [
    (ss.MonotoneCubic, {}),
    (ss.MonotoneCubic, {"ends": "natural", "layer": 0.0}),
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuintic, {}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
]
SIDES = ["linear", "clip", "periodic", True, False]
PAIRS = [(below, above) for below in SIDES for above in SIDES]


def data(rng, n=9):
    x, rises = np.cumsum(rng.uniform(0.5, 2, n)), rng.uniform(0, 2, n) * (rng.random(n) > 0.2)
    return x, np.cumsum(rises)


def functions(rng, mode="linear", n=9):
    """Yield one of everything: families, columns, rows, derivatives, antiderivatives."""
    x, y = data(rng, n)
    for family, options in FAMILIES:
        f = family(x, y, extrapolate=mode, **options)
        yield f
        yield f.derivative()
        yield f.derivative(2)
        yield f.derivative(9)
        yield f.antiderivative()
        yield f.antiderivative(2)
    columns = ss.MonotoneQuintic(x, np.stack([y, -y], 1), extrapolate=mode)
    yield from (columns, columns.derivative(), columns.antiderivative())
    for kind in ("quartic", "quintic"):
        rows = ss.fit_many_monotone(
            np.stack([x, 2 * x]), np.stack([y, -y]), kind=kind, extrapolate=mode
        )
        yield from (rows, rows.derivative(), rows.antiderivative())


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_by_default_tangent_lines(rng, family, options):
    """`x**2` on [-5, 5] gave 5,677 (quintic) and -4,207 (quartic) at 10."""
    x = np.linspace(-5, 5, 11)
    assert 30 <= family(x, x**2, **options)(10.0) <= 25 + 5 * 20
    for sign in (1, -1):
        x, y = data(rng, 12)
        f = family(x, sign * y, **options)
        assert f.extrapolate == "linear"
        q = np.r_[x[0] - np.geomspace(1e6, 1e-9, 200), np.linspace(*x[[0, -1]], 500)]
        q = np.r_[q, x[-1] + np.geomspace(1e-9, 1e6, 200)]
        assert (np.diff(f(q)) * sign >= -1e-15 * abs(f(q[1:]))).all()
        for end, away in ((0, -1), (-1, 1)):
            out = x[end] + away * np.array([1e-12, 1, 1e5])
            np.testing.assert_allclose(
                f(out), sign * y[end] + f.slopes[end] * (out - x[end]), rtol=1e-14
            )
            np.testing.assert_array_equal(f(out, 1), f.slopes[end])
            np.testing.assert_array_equal(f(out, 2), 0)


@pytest.mark.parametrize("mode", PAIRS)
def test_sides(rng, mode):
    """Each side is what it would be alone, in a call as in the object; it can be read back."""
    low, high = np.array([-50.0, -1.0, 0.0]), np.array([20.0, 21.5, 60.0])
    for f, g in zip(functions(np.random.default_rng(3), mode), functions(rng), strict=True):
        if isinstance(f, (ss.MonotoneSpline, ss.MonotoneRows)):
            assert f.extrapolate == (mode[0] if mode[0] == mode[1] else mode)
            for k, places in enumerate((low, high)):
                np.testing.assert_array_equal(f(places), f(places, extrapolate=mode[k]))
                np.testing.assert_array_equal(f(places), f(places, extrapolate=list(mode)))
        assert isinstance(g.extrapolate, str)
    for family, options in FAMILIES:
        x, y = data(rng)
        f, plain = (family(x, y, extrapolate=m, **options) for m in (mode, False))
        for nu in range(4):
            np.testing.assert_array_equal(f(low, nu), plain(low, nu, mode[0]))
            np.testing.assert_array_equal(f(high, nu), plain(high, nu, mode[1]))
            np.testing.assert_allclose(
                f.derivative(nu)(np.r_[low, high]), f(np.r_[low, high], nu), rtol=1e-9, atol=1e-9
            )


@pytest.mark.parametrize("mode", PAIRS)
def test_integrals_are_differences_of_antiderivatives(rng, mode):
    ends = np.array([-7.5, -1.0, 0.0, 3.0, 6.0, 11.0, 18.0])
    for f in functions(rng, mode):
        if isinstance(f, (ss.PiecewiseRows, ss.MonotoneRows)) or f(0.0).__class__ is not float:
            continue
        area = f.antiderivative()
        for a in ends:
            for b in ends[ends != a]:
                expected = area(b) - area(a)
                # Far away the end polynomial of the antiderivative amplifies its rounding.
                room = (1e-8 if True in mode else 1e-11) * (1 + abs(area(a)) + abs(area(b)))
                found = f.integrate(a, b)
                both_nan = math.isnan(expected) and math.isnan(found)
                assert both_nan or abs(found - expected) <= room, (a, b)
                assert f.integrate(b, a) == -found or both_nan


def test_nan_and_infinity_everywhere(rng):
    """One rule: NaN gives NaN; ±∞ gives the limit, and NaN where there is none."""
    for mode in SIDES:
        for f in functions(rng, mode):
            for nu in (0, 1, 2, 2**40):
                assert np.isnan(f(np.nan, nu)).all()
                assert np.isnan(f([np.nan, np.nan], nu)).all()
                at = np.asarray(f([-np.inf, np.inf], nu))
                far = np.asarray(f([-1e200, 1e200], nu))
                assert np.isnan(at).all() == (mode in ("periodic", False))
                assert np.isnan(far).any() == (mode is False)
                if mode not in ("periodic", False):
                    assert not np.isnan(at).any()
                    grows = np.isinf(at)
                    assert (far[grows] * at[grows] > 0).all()
                    np.testing.assert_allclose(far[~grows], at[~grows])
            for a, b in ((np.nan, 1), (1, np.nan), (np.nan, np.nan)):
                assert np.isnan(f.integrate(a, b)).all()
            whole = np.asarray(f.integrate(-np.inf, np.inf))
            if mode in ("periodic", False):
                assert np.isnan(whole).all()
    f = ss.MonotoneQuintic([0, 1, 3], [0, 0.5, 1], extrapolate="clip")
    assert f.integrate(0, np.inf) == np.inf
    assert f.integrate(-np.inf, 0) == 0
    assert f.derivative().integrate(-np.inf, np.inf) == pytest.approx(1, rel=1e-15)
    assert f.inverse(np.inf) == 3
    line = ss.MonotoneQuintic([0, 1], [-1, 1])
    assert math.isnan(line.integrate(-np.inf, np.inf))
    assert line(np.inf, extrapolate=True) == line(np.inf) == np.inf


def test_high_orders_end(rng):
    """`derivative()(x, 2**40)` never returned."""
    for f in functions(rng):
        for order in (2**40, 2**62):
            np.testing.assert_array_equal(f(1.5, order), 0 * np.asarray(f(1.5)))
            np.testing.assert_array_equal(f([-9.0, 3.0], order), 0 * np.asarray(f([-9.0, 3.0])))
            np.testing.assert_array_equal(f.derivative(order)(1.5, order), 0 * np.asarray(f(1.5)))


def test_periodic_functions(rng):
    t = np.linspace(0, 2 * np.pi, 17)
    for family, options in FAMILIES:
        f = family(t, np.sin(t) - np.sin(t[-1]) * (t > 6), extrapolate="periodic", **options)
        q = rng.uniform(0, 2 * np.pi, 200)
        for k in (-1000, -1, 1, 7):
            np.testing.assert_allclose(f(q + k * t[-1]), f(q), atol=1e-12)
        period = f.integrate(0, t[-1])
        assert f.integrate(1, 2 + 5 * t[-1]) == pytest.approx(f.integrate(1, 2) + 5 * period)
        area = f.antiderivative(2)
        places = rng.uniform(-30, 30, 50)
        np.testing.assert_allclose(area(places, 2), f(places), atol=1e-12)
        step = 1e-5
        slope = (area(places + step) - area(places - step)) / (2 * step)
        np.testing.assert_allclose(slope, f.antiderivative()(places), atol=1e-5)
        assert f.roots().size == f.roots(False).size


def test_attributes_of_derived_functions():
    f = ss.MonotoneQuintic([0, 1, 2], [0, 1, 4], energy="parametric")
    assert f.energy == "parametric"
    assert ss.MonotoneQuintic([0, 1, 2], [0, 1, 4]).energy == "bending"
    assert f.derivative().extrapolate == "clip"
    assert f.derivative(2).extrapolate == "zero"
    assert f.antiderivative().extrapolate == "taylor-2"
    assert f.antiderivative().derivative().extrapolate == "linear"
    f = ss.MonotoneQuintic([0, 1, 2], [0, 1, 4], extrapolate=["periodic", np.bool_(True)])
    assert f.extrapolate == ("periodic", True)
    assert f.antiderivative().extrapolate == ("periodic-1", True)
    for rows in (
        ss.fit_many_monotone(
            [[0, 1, 2]], [[0, 1, 4]], kind="quintic", energy="parametric", extrapolate=False
        ),
        ss.fit_many_monotone(
            [0, 1, 2], [0, 1, 4], kind="quartic", offsets=[0, 3], extrapolate=False
        ),
    ):
        assert rows.extrapolate is rows[0].extrapolate is False
        assert rows.energy == getattr(rows[0], "energy", None)


def test_attributes_of_rows(rng):
    x, y = np.cumsum(rng.uniform(0.5, 2, (6, 8)), 1), rng.normal(size=(6, 8))
    bounds = [0, 3, 8, 20, 31, 48]
    for kind in ("quartic", "quintic"):
        two = ss.fit_many_monotone(x, y, kind=kind)
        ragged = ss.fit_many_monotone(np.arange(48.0), y.ravel(), kind=kind, offsets=bounds)
        for name in ("x", "y", "slopes", "second_derivatives"):
            np.testing.assert_array_equal(getattr(two, name), [getattr(f, name) for f in two])
            each = np.concatenate([getattr(f, name) for f in ragged])
            np.testing.assert_array_equal(getattr(ragged, name), each)
        np.testing.assert_array_equal(two.derivative().x, x)
        again = ss.fit_many_monotone(x, y, kind="quartic", slopes=two.slopes)
        assert again.slopes.shape == (6, 8)


@pytest.mark.parametrize("scale", [(1e299, 1.0), (1e290, 1e-200), (1e-100, 1e60), (1e150, 1e-300)])
def test_derivatives_out_of_range_spoil_nothing(scale):
    """Second derivatives of y ~ 1 at x ~ 1e299 are 1e-598: zero; all else is as it should be."""
    sx, sy = scale
    x, y = np.array([0.0, 1, 2.5, 4, 7]), np.array([0.0, 1, 1.5, 4, 4.25])
    q = np.linspace(-2, 9, 50)
    for family, options in FAMILIES:
        f, g = family(x, y, **options), family(x * sx, y * sy, **options)
        for mode in ("linear", "periodic", True):
            np.testing.assert_allclose(
                g(q * sx, extrapolate=mode), f(q, extrapolate=mode) * sy, rtol=1e-11
            )
        np.testing.assert_allclose(g.to_bpoly().c, f.to_bpoly().c * sy, rtol=1e-11)
        np.testing.assert_allclose(g.inverse(y * sy / 2), f.inverse(y / 2) * sx, rtol=1e-9)
        np.testing.assert_allclose(g.solve(sy / 3), f.solve(1 / 3) * sx, rtol=1e-12)
        np.testing.assert_allclose(g.integrate(0, 8 * sx) / sx / sy, f.integrate(0, 8), rtol=1e-11)
        if not isinstance(f, ss.MonotoneCubic):
            np.testing.assert_allclose(g.alpha, f.alpha, rtol=1e-6)
        if np.isfinite(f(q, 2) * sy / sx / sx).all():
            np.testing.assert_allclose(g(q * sx, 2), f(q, 2) * sy / sx / sx, rtol=1e-9, atol=0)


def test_the_quartic_is_of_order_three():
    """With the paper's shape = 3 of order two, and four times PCHIP's error."""
    q = np.linspace(0, 1, 4001)
    for g in (np.exp, lambda x: x**3 + x, lambda x: 1 / (1 + np.exp(-12 * (x - 0.5)))):
        errors = {}
        for n in (41, 81, 161):
            x = np.linspace(0, 1, n)
            errors[n] = [
                abs(f(q) - g(q)).max()
                for f in (
                    ss.MonotoneQuartic(x, g(x)),
                    ss.MonotoneQuartic(x, g(x), shape=3.0),
                    PchipInterpolator(x, g(x)),
                )
            ]
        order = np.log2(np.divide(errors[81], errors[161]))
        assert order[0] > 2.8, order
        assert order[1] < 2.3, order
        assert errors[161][0] < 1.5 * errors[161][2]
    x = np.linspace(0, 4, 9)
    f = ss.MonotoneQuartic(x, x**2)
    assert f(4 * q, 2).min() >= 0
    assert f(4 * q, 2).max() < 4.6
    peer = PchipInterpolator(x, x**2)
    assert abs(f(4 * q) - 16 * q**2).max() < 2 * abs(peer(4 * q) - 16 * q**2).max()


def test_the_quartic_reproduces_cubics_with_exact_slopes(rng):
    for _ in range(100):
        # Where these are not above twice a secant: with larger steps they would be limited.
        x = np.cumsum(rng.uniform(0.5, 1, 8))
        a, b, c = rng.uniform(0.1, 3, 3) * rng.choice([-1, 1])
        y, d = ((a * x + b) * x + c) * x, (3 * a * x + 2 * b) * x + c
        f = ss.MonotoneQuartic(x, y, slopes=d)
        for i in np.flatnonzero(
            np.isclose(f.slopes[:-1], d[:-1]) & np.isclose(f.slopes[1:], d[1:])
        ):
            q = rng.uniform(x[i], x[i + 1], 100)
            np.testing.assert_allclose(f(q), ((a * q + b) * q + c) * q, rtol=1e-13)
            np.testing.assert_allclose(f(q, 2), 6 * a * q + 2 * b, rtol=1e-10)
        assert i > 3
