# SPDX-License-Identifier: MIT OR Apache-2.0

"""What `MonotoneCubic` promises: least energy, C², monotone to the last bit, a certificate."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

import polygons
import shapespline as ss
from scale import scaled


def energy(f: PPoly) -> float:
    """Return ∫ f''² dx of a piecewise polynomial, in closed form."""
    second = f.derivative(2)
    square = PPoly(np.apply_along_axis(lambda c: np.convolve(c, c), 0, second.c), second.x)
    return float(square.integrate(second.x[0], second.x[-1]))


def generated(rng, case):
    """Return integers, heavy tails, flats, turns or smooth data, by turns."""
    n = int(rng.integers(2, 14))
    x = np.cumsum(rng.uniform(0.1, 1, n) * 10.0 ** (rng.uniform(-3, 3, n) * (case % 3 == 0)))
    match case % 5:
        case 0:
            y = np.cumsum(rng.integers(0, 4, n))
        case 1:
            y = np.cumsum(rng.lognormal(0, 4, n))
        case 2:
            y = rng.integers(-3, 4, n)
        case 3:
            y = np.cumsum(rng.exponential(size=n) * (rng.random(n) > 0.3))
        case _:
            y = np.exp(np.sin(x)) + 2 * x
    return x, y.astype(float)


def test_gaps_prove_the_least_energy_and_steps_are_few(rng):
    for case in range(scaled(3000)):
        x, y = generated(rng, case)
        f = ss.MonotoneCubic(x, y, ends="natural", layer=0)
        straight = (1e3 * np.finfo(float).eps * np.abs(y).max()) ** 2 / np.diff(x).min() ** 3
        assert f.interval_gaps.sum() <= 1e-12 * f.bending_energy + straight
        assert (f.interval_gaps >= 0).all()
        assert f.lower_bound <= f.bending_energy * (1 + 1e-14)
        assert f.bending_energy == ss.minimal_bending(x, y)
        assert f.diagnostics.iterations <= 13
        # Where pieces are short, knots and values are too coarse for SciPy's form to bend alike.
        if np.diff(f.knots).min() > 1e-5 * np.abs(x).max():
            of_export = energy(f.to_ppoly())
            assert f.bending_energy == pytest.approx(of_export, rel=1e-5, abs=straight)


def test_never_more_energy_than_other_monotone_functions(rng):
    for case in range(scaled(1000)):
        x, y = generated(rng, case)
        least = ss.minimal_bending(x, y)
        room = 1e-10 * least + 1e-18 * np.ptp(y) ** 2 / np.diff(x).min() ** 3
        others = [
            ss.MonotoneQuintic(x, y).bending_energy,
            ss.MonotoneQuartic(x, y).bending_energy,
            energy(PchipInterpolator(x, y)),
        ]
        assert least <= min(others) + room
        natural = ss.MonotoneCubic(x, y, ends="natural")
        assert natural.bending_energy <= least / (1 - 1 / 16) ** 2 + room


def test_the_natural_cubic_where_it_is_monotone(rng):
    for _ in range(100):
        x = np.cumsum(rng.uniform(0.5, 1.5, 12))
        y = 3 * x + np.sin(x)
        f, peer = ss.MonotoneCubic(x, y, ends="natural"), CubicSpline(x, y, bc_type="natural")
        q = np.linspace(x[0], x[-1], 300)
        np.testing.assert_allclose(f(q), peer(q), rtol=1e-13)
        np.testing.assert_allclose(f(q, 2), peer(q, 2), atol=1e-11)
        assert f.level_pieces.size == 0
        ends = [float(peer(x[0], 1)), float(peer(x[-1], 1))]
        clamped = ss.MonotoneCubic(x, y, ends=ends)
        np.testing.assert_allclose(clamped(q), f(q), rtol=1e-12)


def test_slopes_never_fall_below_zero_and_second_derivatives_are_continuous(rng):
    for case in range(scaled(1000)):
        x, y = generated(rng, case)
        f = ss.MonotoneCubic(x, y, ends=["natural", "estimated"][case % 2])
        knots = f.knots
        t = np.linspace(0, 1, 40)
        q = np.unique(np.append(knots[:-1, None] + np.diff(knots)[:, None] * t, knots))
        q = q[(q >= x[0]) & (q <= x[-1])]
        i = np.clip(np.searchsorted(x, q, side="right") - 1, 0, len(x) - 2)
        sign = np.sign(np.diff(y))[i]
        assert (f(q, 1) * sign >= 0).all()
        assert (f(q, 1)[sign == 0] == 0).all()
        for a, b in pairwise(x):
            inside = f(q[(q >= a) & (q <= b)])
            assert (np.diff(inside) * np.sign(f(b) - f(a)) >= 0).all()
        # One-sided second derivatives, by the end coefficients of the pieces of f''.
        ends = f.derivative(2)._bernstein()
        jump = np.abs(ends[-1, :-1] - ends[0, 1:])
        beside = np.maximum(np.abs(ends).max(0)[:-1], np.abs(ends).max(0)[1:])
        assert (jump <= 1e-9 * beside + 1e-12 * np.abs(ends).max()).all()


def test_flips_and_powers_of_two_are_exact_and_reversal_nearly(rng):
    for case in range(scaled(500)):
        x, y = generated(rng, case)
        f = ss.MonotoneCubic(x, y)
        q = np.linspace(x[0], x[-1], 200)
        np.testing.assert_array_equal(ss.MonotoneCubic(x, -y)(q), -f(q))
        for sx, sy in ((2.0**40, 2.0**-60), (2.0**-300, 2.0**200), (1.0, 2.0**900)):
            with np.errstate(over="ignore"):
                g = ss.MonotoneCubic(sx * x, sy * y)
                np.testing.assert_array_equal(g(sx * q), sy * f(q))
        back = ss.MonotoneCubic(-x[::-1], y[::-1])
        np.testing.assert_allclose(back(-q), f(q), rtol=0, atol=1e-12 * (np.ptp(y) or 1))


@pytest.mark.parametrize("scale", [1e-300, 1e300])
def test_extreme_scales(scale):
    x, y = polygons.load("rpn14").values()
    f, g = ss.MonotoneCubic(x, y), ss.MonotoneCubic(x, scale * y / 4)
    q = np.linspace(8, 20, 100)
    np.testing.assert_allclose(g(q) / scale * 4, f(q), rtol=1e-12)


@pytest.mark.parametrize("jump", [10.0, 1e3, 1e6, 1e9])
def test_straight_stretches_beside_a_jump_stay_straight(jump):
    x = np.arange(41.0)
    f = ss.MonotoneCubic(x, x + jump * (x > 20))
    q = np.linspace(0, 10, 2001)
    assert np.abs(f(q) - q).max() <= 2e-6


SMOOTH = {
    "exp": (np.exp, [(11, 9.7e-6), (21, 6.4e-7), (41, 4.1e-8)]),
    "logistic": (
        lambda x: 1 / (1 + np.exp(-12 * (x - 0.5))),
        [(11, 1.5e-3), (21, 5.4e-5), (41, 2.9e-6)],
    ),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_order_four_on_smooth_data(name):
    function, errors = SMOOTH[name]
    q = np.linspace(0, 1, 10_001)
    for n, error in errors:
        x = np.linspace(0, 1, n)
        f = ss.MonotoneCubic(x, function(x))
        found = np.abs(f(q) - function(q)).max()
        assert found <= 1.05 * error
        assert found < np.abs(PchipInterpolator(x, function(x))(q) - function(q)).max()


def test_given_slopes_are_taken_and_free_ones_best(rng):
    x, y = np.arange(8.0), np.cumsum([0.0, 1, 3, 1, 1, 2, 5, 1])
    free = ss.MonotoneCubic(x, y, ends="natural")
    slopes = np.full(8, np.nan)
    slopes[3] = 0.25
    f = ss.MonotoneCubic(x, y, ends="natural", slopes=slopes)
    assert f.slopes[3] == 0.25
    assert f.bending_energy > free.bending_energy
    again = ss.MonotoneCubic(x, y, slopes=free.slopes)
    np.testing.assert_allclose(again(x + 0.3), free(x + 0.3), rtol=1e-12)
    columns = ss.MonotoneCubic(x, np.stack([y, 2 * y], 1), slopes=np.stack([slopes, slopes], 1))
    np.testing.assert_array_equal(columns.slopes[3], [0.25, 0.25])


def test_periodic_data_close_smoothly(rng):
    x = np.append(np.cumsum(rng.uniform(0.5, 1, 9)) - 0.5, 7.5)
    for y in (
        np.append(rng.normal(size=9), 0.0),
        np.cumsum(rng.exponential(size=10)),
        [0, 1, 1, 1, 0, -1, -2, 1, 2, 0],
    ):
        y = np.array(y, dtype=float)
        if y[-1] == 0:
            y[-1] = y[0]
        f = ss.MonotoneCubic(x, y, ends="periodic", extrapolate="periodic")
        period, rise = x[-1] - x[0], y[-1] - y[0]
        q = np.linspace(x[0], x[-1], 50)[:-1]
        np.testing.assert_allclose(f(q + 3 * period), f(q) + 3 * rise, atol=1e-12)
        for nu in (1, 2):
            assert f(x[0], nu) == pytest.approx(f(x[-1], nu), rel=1e-9, abs=1e-9)
            np.testing.assert_allclose(f(q - period, nu), f(q, nu), rtol=1e-9, atol=1e-9)
        # Where the data begin does not matter.
        k = 4
        turned_x = np.append(x[k:-1], x[: k + 1] + period)
        turned_y = np.append(y[k:-1], y[: k + 1] + rise)
        g = ss.MonotoneCubic(turned_x, turned_y, ends="periodic", extrapolate="periodic")
        np.testing.assert_allclose(g(q), f(q), atol=1e-9)


def test_the_inverse_of_a_phase_goes_on_period_by_period(rng):
    for case in range(scaled(300)):
        n = int(rng.integers(2, 12))
        x = np.cumsum(rng.uniform(0.1, 1, n))
        sign = 1 if case % 2 else -1
        y = sign * np.cumsum(rng.exponential(size=n)) + rng.normal()
        f = ss.MonotoneCubic(x, y, ends="periodic", extrapolate="periodic")
        period, rise = x[-1] - x[0], y[-1] - y[0]
        v = rng.uniform(min(y[0], y[-1]), max(y[0], y[-1]), 300)
        within = f.inverse(v)
        for k in (-1000, -3, -1, 1, 2, 77):
            far = f.inverse(v + k * rise)
            # Values and places far away have fewer digits, places also where the slope is small.
            value = 16 * (
                np.spacing(abs(v) + abs(k * rise)) + np.spacing(abs(far)) * f(far, 1) * sign
            )
            np.testing.assert_array_less(abs(f(far) - (v + k * rise)), value)
            place = np.cbrt(value / abs(rise)) * period + 1e-12 * abs(k)
            np.testing.assert_array_less(abs(far - (within + k * period)), 4 * place)
            assert f.inverse(v[0] + k * rise) == pytest.approx(far[0], rel=1e-12, abs=4 * place[0])
            order = np.argsort(v)
            sorted_ones = f.inverse((v + k * rise)[order])
            np.testing.assert_allclose(sorted_ones, far[order], rtol=0, atol=4 * place.max())
    one_sided = ss.MonotoneCubic(
        [0, 1, 3], [0, 2, 4], ends="periodic", extrapolate=(False, "periodic")
    )
    assert np.isnan(one_sided.inverse(-1.0))
    assert np.isnan(one_sided.inverse([-1.0])[0])
    assert one_sided.inverse(4 + 4 + 2) == pytest.approx(3 + 3 + 1)


def test_min_slope_is_kept(rng):
    for case in range(scaled(300)):
        x = np.cumsum(rng.uniform(0.1, 1, 9))
        y = np.cumsum(rng.lognormal(0, 2, 9)) * [1, -1][case % 2]
        share = rng.uniform(0.05, 0.9)
        f = ss.MonotoneCubic(x, y, min_slope=share, ends=["natural", "estimated"][case % 2])
        secants = np.abs(np.diff(y) / np.diff(x))
        floor = share * np.array([secants[max(i - 1, 0) : i + 2].min() for i in range(8)])
        q = np.linspace(x[:-1], x[1:], 50)
        assert (np.abs(f(q, 1)) >= floor * (1 - 1e-12)).all()
        assert f.interval_gaps.sum() <= 1e-9 * f.bending_energy


REFUSED = [
    ({"ends": (-1.0, None)}, "ends", 0, -1.0),
    ({"ends": (None, np.nan)}, "ends", None, None),
    ({"ends": "clamped"}, "ends", None, "clamped"),
    ({"ends": (1.0,)}, "ends", None, 1),
    ({"slopes": [np.nan, -1, np.nan, np.nan]}, "slopes", 1, -1.0),
    ({"slopes": [np.nan, np.nan]}, "slopes", None, None),
    ({"layer": 0.5}, "layer", None, 0.5),
    ({"layer": -0.1}, "layer", None, -0.1),
    ({"min_slope": 1.0}, "min_slope", None, 1.0),
    ({"min_slope": 0.5, "ends": (0.0, None)}, "ends", 0, 0.0),
]


@pytest.mark.parametrize(("options", "argument", "index", "value"), REFUSED)
def test_bad_options(options, argument, index, value):
    with pytest.raises(ss.InputError, match=argument) as error:
        ss.MonotoneCubic([0, 1, 2, 4], [0, 1, 3, 4], **options)
    assert error.value.argument.startswith(argument)
    if index is not None:
        assert error.value.index == index
    if value is not None:
        assert error.value.value == value


def test_fit_monotone_knows_all_kinds():
    x, y = [0, 1, 2, 4], [0, 0, 1, 5]
    assert type(ss.fit_monotone(x, y)) is ss.MonotoneCubic
    assert type(ss.fit_monotone(x, y, kind="quintic")) is ss.MonotoneQuintic
    assert type(ss.fit_monotone(x, y, kind="quartic")) is ss.MonotoneQuartic
    with pytest.raises(TypeError, match="kinds that have it: 'cubic'"):
        ss.fit_monotone(x, y, kind="quartic", layer=0.1)
    with pytest.raises(ss.InputError, match="kind must be one of"):
        ss.fit_monotone(x, y, kind="linear")


def test_columns_with_knots_of_their_own_export_as_one(rng):
    x, y = np.arange(7.0), np.cumsum(rng.lognormal(0, 3, (7, 3)), 0)
    f = ss.MonotoneCubic(x, y, ends="natural")
    assert isinstance(f.knots, list)
    q = np.linspace(0, 6, 500)
    for peer in (f.to_ppoly(), f.to_bpoly(), f.derivative().antiderivative()):
        offset = y[0] - peer(0.0)
        np.testing.assert_allclose(peer(q) + offset, f(q), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("convex", [None, "data"])
def test_data_over_many_decades_keep_their_shape(rng, convex):
    for case in range(scaled(2000)):
        n = int(rng.integers(2, 30))
        decades = rng.choice([0, 2, 6, 12])
        x = np.cumsum(10.0 ** rng.uniform(-decades / 2, decades / 2, n)) * 10.0 ** rng.uniform(
            -9, 9
        )
        match case % 4:
            case 0:
                y = np.cumsum(10.0 ** rng.uniform(-decades, decades, n))
            case 1:
                y = rng.normal(size=n) * 10.0 ** rng.uniform(-100, 100)
            case 2:
                y = np.cumsum(rng.random(n) < 0.3) * 10.0 ** rng.uniform(-300, 300)
            case _:
                y = np.exp(x / x.max() * rng.uniform(-300, 300))
        if not (np.diff(x) > 0).all():
            continue
        ends = ["natural", "estimated", "periodic"][case % 3]
        try:
            f = ss.MonotoneCubic(x, y, ends=ends, convex=convex)
        except ss.InputError:
            # Second derivatives of values near the largest number may lie beyond it.
            if np.ptp(y) < 1e270:
                raise
            continue
        t = np.linspace(0, 1, 30)
        q = np.unique((x[:-1, None] + np.diff(x)[:, None] * t).clip(x[0], x[-1]))
        i = np.clip(np.searchsorted(x, q, side="right") - 1, 0, n - 2)
        low, high = np.minimum(y[:-1], y[1:])[i], np.maximum(y[:-1], y[1:])[i]
        assert ((low <= f(q)) & (f(q) <= high)).all()
        assert (f(q, 1) * np.sign(np.diff(y))[i] >= 0).all()
        np.testing.assert_array_equal(f(x), y)
        assert convex or f.diagnostics.converged
