# SPDX-License-Identifier: MIT OR Apache-2.0

"""`smooth_monotone`: against SciPy, isotonic regression, brute force, and its promises."""

import pickle
import re

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

import shapespline as ss
from scale import scaled

RNG = np.random.default_rng


def logistic(n, noise=0.1, seed=0):
    rng = RNG(seed)
    x = np.sort(rng.random(n)) * 10
    truth = 1 / (1 + np.exp(-2 * (x - 5)))
    return x, truth + noise * rng.normal(size=n), truth


@pytest.mark.parametrize("penalty", [0.01, 1.0, 30.0])
@pytest.mark.parametrize("weighted", [False, True])
def test_equals_scipys_smoothing_spline_where_that_is_monotone(penalty, weighted):
    rng = RNG(1)
    x = np.arange(200.0) + 0.5 * rng.random(200)
    y = x + 10 * np.sin(x / 40) + 0.2 * rng.random(200)
    w = 0.5 + rng.random(200) if weighted else None
    theirs = make_smoothing_spline(x, y, w=w, lam=penalty)
    at = np.linspace(x[0], x[-1], 5001)
    assert theirs(at, 1).min() > 0
    ours = ss.smooth_monotone(x, y, weights=w, penalty=penalty)
    np.testing.assert_allclose(ours(at), theirs(at), rtol=0, atol=1e-8)
    assert ours.smoothing.steps == 1


def isotonic(y, w):
    """The isotonic regression by its min–max formula."""
    n = len(y)
    weight, total = np.r_[0, np.cumsum(w)], np.r_[0, np.cumsum(w * y)]
    mean = np.full((n, n), np.inf)
    for a in range(n):
        mean[a, a:] = (total[a + 1 :] - total[a]) / (weight[a + 1 :] - weight[a])
    least = np.minimum.accumulate(mean[:, ::-1], axis=1)[:, ::-1]
    return np.array([least[: i + 1, i].max() for i in range(n)])


def test_least_known_error_of_the_logistic_curve():
    errors = []
    for seed in range(5):
        x, y, truth = logistic(1000, seed=seed)
        f = ss.smooth_monotone(x, y, penalty=0.1)
        assert isinstance(f, ss.MonotoneCubic)
        assert f.smoothing.converged
        errors.append(np.sqrt(np.mean((f(x) - truth) ** 2)))
    assert np.mean(errors) < 0.015


def test_never_falls_and_has_continuous_second_derivatives():
    for n, penalty in [(30, 1e-6), (300, 1e-3), (300, 0.1), (300, 10.0)]:
        x, y, _ = logistic(n, seed=n)
        f = ss.smooth_monotone(x, y, penalty=penalty)
        t = np.linspace(-1, 11, 20001)
        assert f(t, 1).min() >= 0
        assert (np.diff(f(t)) >= 0).all()
        pieces = f.to_ppoly()
        before, after = pieces.c[:, :-1], pieces.c[:, 1:]
        z = 6 * before[0] * np.diff(pieces.x)[:-1] + 2 * before[1]
        size = np.abs(2 * pieces.c[1]).max()
        # Where pieces are short their power coefficients have few digits.
        long = np.minimum(np.diff(pieces.x)[:-1], np.diff(pieces.x)[1:]) > 1e-4
        np.testing.assert_allclose(z[long], 2 * after[1][long], rtol=0, atol=1e-6 * size)


def test_without_a_penalty_it_is_the_isotonic_regression():
    rng = RNG(2)
    for n in (2, 7, 100):
        x, w = np.cumsum(rng.random(n)), 0.2 + rng.random(n)
        y = x + rng.normal(size=n)
        f = ss.smooth_monotone(x, y, weights=w, penalty=0)
        oracle = isotonic(y, w)
        np.testing.assert_allclose(f.y, oracle, rtol=0, atol=1e-12)
        assert f.smoothing.degrees_of_freedom == 1 + (np.diff(oracle) > 1e-12).sum()
        near = ss.smooth_monotone(x, y, weights=w, penalty=1e-10)
        np.testing.assert_allclose(near.y, oracle, rtol=0, atol=1e-4)
    y = np.cumsum(rng.random(20))
    x = np.arange(20.0)
    f = ss.smooth_monotone(x, y, penalty=0)
    np.testing.assert_allclose(f.y, y, rtol=4e-16)
    assert f.bending_energy == pytest.approx(ss.minimal_bending(x, y), rel=1e-10)
    # Small penalties lead there.
    near = ss.smooth_monotone(x, y, penalty=1e-9)
    np.testing.assert_allclose(near.y, y, rtol=0, atol=1e-6)


def test_residual_is_met_with_equality():
    x, y, _ = logistic(150, seed=3)
    least = ss.smooth_monotone(x, y, penalty=0).smoothing.residual
    w = np.full(150, 4.0)
    for factor in (1.02, 1.5):
        f = ss.smooth_monotone(x, y, weights=w, residual=4 * factor * least)
        assert (w * (y - f(x)) ** 2).sum() == pytest.approx(4 * factor * least, rel=1e-8)
    assert ss.smooth_monotone(x, y, residual=1e9).smoothing.penalty == np.inf
    text = r"residual must be at least .*, that of the isotonic regression, got 0.1"
    with pytest.raises(ss.InputError, match=text) as caught:
        ss.smooth_monotone(x, y, residual=0.1)
    assert (caught.value.argument, caught.value.value) == ("residual", 0.1)


def test_cross_validation_is_near_the_brute_force_minimum():
    x, y, truth = logistic(120, seed=4)

    def score(f):
        left = 1 - f.smoothing.degrees_of_freedom / len(x)
        return f.smoothing.residual / left**2

    found = ss.smooth_monotone(x, y)
    brute = min(score(ss.smooth_monotone(x, y, penalty=10.0**k)) for k in np.arange(-5, 3, 0.1))
    assert score(found) <= brute * 1.01
    assert np.sqrt(np.mean((found(x) - truth) ** 2)) < 0.05


def test_direction():
    x, y, _ = logistic(90, seed=5)
    up = ss.smooth_monotone(x, y, penalty=0.1)
    for increasing in (False, None):
        down = ss.smooth_monotone(x, -y, penalty=0.1, increasing=increasing)
        assert not down.smoothing.increasing
        np.testing.assert_array_equal(down.y, -up.y)
    flat = ss.smooth_monotone(x, -y, penalty=0.1)
    np.testing.assert_allclose(flat.y, -y.mean(), rtol=1e-13)


def test_bounds_hold_for_the_function_not_for_the_data():
    x, y, _ = logistic(90, seed=6, noise=0.2)
    assert y.min() < 0
    assert y.max() > 1
    for penalty in ("gcv", 0.0, 1e-3, 10.0):
        f = ss.smooth_monotone(x, y, penalty=penalty, bounds=(0, 1))
        assert f(x).min() >= 0
        assert f(x).max() <= 1
    f = ss.smooth_monotone(x, y, penalty=0.01, bounds=(None, 0.5))
    assert f.y.max() == 0.5
    assert f.y.min() < 0.5


def test_repeated_abscissae_are_merged():
    x, y = [0, 1, 1, 2, 3, 3], [0.0, 0.2, 0.6, 0.5, 1.0, 1.4]
    f = ss.smooth_monotone(x, y, penalty=0.1)
    g = ss.smooth_monotone([0, 1, 2, 3], [0, 0.4, 0.5, 1.2], weights=[1, 2, 1, 2], penalty=0.1)
    np.testing.assert_array_equal(f.x, [0, 1, 2, 3])
    np.testing.assert_allclose(f.y, g.y, rtol=1e-12)


def test_near_ties_do_no_harm():
    x, y, _ = logistic(200, seed=7)
    moved = np.sort(np.r_[x, x[::5] + 1e-8, x[::7] + 1e-10])
    values = np.interp(moved, x, y)
    f = ss.smooth_monotone(moved, values, penalty=0.01)
    g = ss.smooth_monotone(moved, values, penalty=0.01 * (1 + 1e-9))
    assert f.smoothing.converged
    np.testing.assert_allclose(f(x), g(x), rtol=0, atol=1e-7)


@pytest.mark.parametrize(("sx", "sy"), [(1e100, 1e-100), (1e-100, 1e100), (2.0**300, 2.0**-200)])
def test_scales(sx, sy):
    x, y, _ = logistic(70, seed=8)
    f = ss.smooth_monotone(x, y, penalty=0.01)
    g = ss.smooth_monotone(sx * x, sy * y, penalty=0.01 * sx**3)
    np.testing.assert_allclose(g.y / sy, f.y, rtol=0, atol=0 if sx == 2.0**300 else 1e-9)
    assert g.smoothing.residual == pytest.approx(f.smoothing.residual * sy * sy, rel=1e-9)


def test_the_result_pickles_with_its_record():
    x, y, _ = logistic(40)
    f = ss.smooth_monotone(x, y, penalty=0.1)
    g = pickle.loads(pickle.dumps(f))
    assert g.smoothing == f.smoothing == pickle.loads(pickle.dumps(f.smoothing))
    np.testing.assert_array_equal(g(x), f(x))
    np.testing.assert_array_equal(g(x, 2), f(x, 2))
    np.testing.assert_array_equal(g.slopes, f.slopes)
    assert repr(f.smoothing).startswith("MonotoneSmoothing(penalty=1e-1, ")
    assert ss.MonotoneCubic(x, y).smoothing is None


def convex_cases(count):
    """Noisy data, signs of their intervals of several kinds, and penalties."""
    rng = np.random.default_rng(11)
    for k in range(count):
        n = int(rng.integers(3, 150))
        x = np.sort(rng.uniform(0, 1, n)) if k % 3 else np.linspace(0, 1, n)
        truth = [np.exp(2 * x), np.sqrt(x), x**3 + x, 1 / (1 + np.exp(-12 * (x - 0.5)))][k % 4]
        y = truth + rng.choice([1e-3, 0.03, 0.3]) * rng.normal(size=n)
        middle = x[1:] < 0.5
        signs = [
            np.ones(n - 1),
            -np.ones(n - 1),
            np.where(middle, 1, -1),
            np.where(middle, -1, 1),
            rng.integers(-1, 2, n - 1),
        ][k % 5]
        yield x, y, signs, 10.0 ** rng.uniform(-6, 1)


def test_convex_functions_pass_their_check_and_move_the_values_least():
    for x, y, signs, penalty in convex_cases(scaled(2000)):
        f = ss.smooth_monotone(x, y, penalty=penalty, convex=signs)
        assert f.smoothing.converged
        report = ss.check_monotone(f.x, f.y, f, convex=signs)
        assert report.ok, report
        # Constraints cost, and nothing between the two costs less.
        plain = ss.smooth_monotone(x, y, penalty=penalty)
        cost = [np.sum((y - g.y) ** 2) + penalty * g.bending_energy for g in (plain, f)]
        assert cost[0] <= cost[1] * (1 + 1e-9)


def test_one_sign_is_for_the_whole_curve():
    x, y, _, penalty = next(convex_cases(1))
    for sign in (1, -1, 0):
        f = ss.smooth_monotone(x, y, penalty=penalty, convex=sign)
        g = ss.smooth_monotone(x, y, penalty=penalty, convex=np.full(len(x) - 1, sign))
        np.testing.assert_array_equal(f.y, g.y)
    assert (np.diff(f.y) >= 0).all()
    plain = ss.smooth_monotone(x, y, penalty=penalty)
    np.testing.assert_array_equal(plain.y, f.y)


def test_convex_smoothing_recovers_a_convex_function():
    rng = np.random.default_rng(4)
    x = np.sort(rng.uniform(0, 1, 300))
    truth = np.exp(3 * x)
    errors = []
    for _ in range(20):
        y = truth + rng.normal(size=300)
        fits = [ss.smooth_monotone(x, y, penalty=1e-4, convex=convex) for convex in (None, 1)]
        errors.append([np.sqrt(np.mean((f.y - truth) ** 2)) for f in fits])
    plain, convex = np.mean(errors, axis=0)
    assert convex < 0.8 * plain


X, Y = [0.0, 1.0, 2.0], [0.0, 1.0, 1.5]


@pytest.mark.parametrize(
    ("x", "y", "options", "text", "argument", "index", "value"),
    [
        (X, Y, {"residual": 1.0, "penalty": 1.0}, "penalty must be left out", "penalty", (), 1.0),
        (X, Y, {"weights": [1, 0, 1]}, "weights[1] must be positive", "weights", (1,), 0.0),
        (X, Y, {"weights": [1, 1]}, "weights has 2 entries; expected 3", "weights", (), 2),
        (X, Y, {"penalty": -1.0}, "penalty must be finite and not negative", "penalty", (), -1.0),
        (X, Y, {"residual": -1.0}, "residual must be finite and not", "residual", (), -1.0),
        (X, Y, {"penalty": "aic"}, "penalty must be one of 'gcv', a number", "penalty", (), "aic"),
        (X, Y, {"bounds": (1, 1)}, "bounds[1] must exceed the lower", "bounds", (1,), 1.0),
        (X, Y, {"bounds": (1, 0)}, "bounds[1] must exceed the lower", "bounds", (1,), 0.0),
        (X, Y, {"convex": [1, 2]}, "convex[1] must be -1, 0 or 1", "convex", (1,), 2.0),
        (X, Y, {"convex": [1]}, "convex must be one sign or one per interval", "convex", (), (1,)),
        (X, Y, {"convex": "data"}, "convex must be one of None, 1, -1", "convex", (), "data"),
        (
            X,
            Y,
            {"convex": 1, "penalty": 0},
            "penalty must be positive with convex",
            "penalty",
            (),
            0,
        ),
        ([0, 2, 1], Y, {}, "x[2] must not be below its predecessor", "x", (2,), 1.0),
        ([2, 2, 2], Y, {}, "x must have at least two distinct values", "x", (), 1),
        (X, [0, np.nan, 1], {}, "y[1] is NaN", "y", (1,), None),
        (X, np.zeros((3, 2)), {}, "y must have one axis", "y", (), (3, 2)),
    ],
)
def test_bad_input_is_refused_by_name(x, y, options, text, argument, index, value):
    with pytest.raises(ss.InputError, match=re.escape(text)) as caught:
        ss.smooth_monotone(x, y, **options)
    assert (caught.value.argument, tuple(np.atleast_1d(caught.value.index or ()))) == (
        argument,
        index,
    )
    assert value is None or caught.value.value == value


def test_wrong_kinds_are_type_errors():
    for options in ({"penalty": None}, {"increasing": "up"}, {"bounds": 3}, {"residual": "x"}):
        with pytest.raises(TypeError):
            ss.smooth_monotone(X, Y, **options)
