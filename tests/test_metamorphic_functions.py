# SPDX-License-Identifier: MIT OR Apache-2.0

"""Relations between functions of one variable that need no known answer."""

from functools import partial
from itertools import product

import numpy as np
import pytest

import shapespline as ss
from batches import BATCHES, BLOCKS, assert_long_batches_agree, assert_same_batches

#: every function of one variable, of data with a rise, a flat and a fall
FUNCTIONS = {
    "cubic": ss.MonotoneCubic,
    "quintic": ss.MonotoneQuintic,
    "quintic, fritsch-butland": lambda x, y: ss.MonotoneQuintic(x, y, slopes="fritsch-butland"),
    "quartic": ss.MonotoneQuartic,
    "derivative": lambda x, y: ss.MonotoneQuintic(x, y).derivative(),
    "antiderivative": lambda x, y: ss.MonotoneQuartic(x, y).antiderivative(2),
}


@pytest.mark.parametrize("count", [2, 3, 9, 64, 65, 130, 300])
@pytest.mark.parametrize("kind", FUNCTIONS)
def test_functions_have_one_value_however_they_are_asked(kind, count, rng):
    x = rng.uniform(0.2, 2, count).cumsum()
    steps = rng.exponential(size=count)
    steps[count // 2 :] *= -1
    steps[count // 3 : count // 3 + 2] = 0
    f = FUNCTIONS[kind](x, steps.cumsum())
    for nu, extrapolate in product(range(3), [True, False, "clip", "linear"]):
        assert_same_batches(partial(f, nu=nu, extrapolate=extrapolate), x, rng)


@pytest.mark.parametrize("kind", FUNCTIONS)
def test_long_batches_have_the_values_of_short_ones(kind, rng):
    x = rng.uniform(0.2, 2, 300).cumsum()
    f = FUNCTIONS[kind](x, rng.exponential(size=300).cumsum())
    assert_long_batches_agree(f, x[[0, -1]], rng)


@pytest.mark.parametrize("kind", ["quintic, fritsch-butland", "quartic"])
def test_functions_of_regular_data_repeat_themselves(kind):
    """Long data are worked on in blocks, which leave no seams."""
    period = np.array([1.0, 0.25, 0.0, 3.0, -1.0, -1.0, 2.0])
    for m in BLOCKS:
        y = np.resize(period, m).cumsum()
        f = FUNCTIONS[kind](np.arange(float(m)), y)
        p = len(period)
        for nu in range(3):
            middle = f(np.arange(30, m - 30) + 0.3, nu)
            rise = period.sum() if nu == 0 else 0.0
            np.testing.assert_allclose(middle[p:], middle[:-p] + rise, rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["quintic", "quartic"])
@pytest.mark.parametrize("columns", [1, 3, 31, 64, 65])
def test_columns_are_the_functions_one_by_one(kind, columns, rng):
    x = rng.uniform(0.2, 2, 40).cumsum()
    y = rng.exponential(size=(40, columns)).cumsum(axis=0)
    together = FUNCTIONS[kind](x, y)
    apart = [FUNCTIONS[kind](x, column) for column in y.T]
    for m in (1, 8, 33, 257):
        q = rng.uniform(x[0] - 1, x[-1] + 1, m)
        for nu in range(3):
            expected = np.column_stack([f(q, nu) for f in apart])
            np.testing.assert_array_equal(together(q, nu), expected)


@pytest.mark.parametrize("kind", ["quintic", "quartic"])
def test_inverses_are_found_however_they_are_asked_for(kind, rng):
    """One alone and many at once are found on different ways, with the same residual."""
    x, y = rng.uniform(0.2, 2, 300).cumsum(), rng.exponential(size=300).cumsum()
    f = FUNCTIONS[kind](x, y)
    levels = rng.uniform(y[0], y[-1], max(BATCHES))
    alone = np.array([f.inverse(level) for level in levels.tolist()])
    for m in BATCHES:
        for some in (slice(m), np.argsort(levels[:m]), slice(None, 3 * m, 3)):
            found = f.inverse(levels[some])
            np.testing.assert_allclose(f(found), levels[some], rtol=0, atol=1e-14 * y[-1])
            np.testing.assert_allclose(found, alone[some], rtol=0, atol=1e-9 * x[-1])


#: x ↦ its factor, y ↦ its factor: powers of two, and the mirrored values
EXACT = {
    "mirrored": (1.0, -1.0),
    "higher": (1.0, 2.0**30),
    "wider": (2.0**-20, 1.0),
    "both": (2.0**40, -(2.0**-25)),
}


@pytest.mark.parametrize("move", EXACT)
@pytest.mark.parametrize("shape", ["rising", "with flats and falls"])
@pytest.mark.parametrize("kind", ["quintic", "quintic, fritsch-butland", "quartic"])
def test_mirrors_and_powers_of_two_change_no_bit(kind, shape, move, rng):
    x_unit, y_unit = EXACT[move]
    for count in (2, 3, 10, 70, 300):
        x, steps = rng.uniform(0.2, 2, count).cumsum(), rng.exponential(size=count)
        if shape != "rising":
            steps *= rng.choice([-1.0, 0.0, 1.0, 1.0, 1.0], size=count)
        y = steps.cumsum()
        f, g = FUNCTIONS[kind](x, y), FUNCTIONS[kind](x * x_unit, y * y_unit)
        q = rng.uniform(x[0] - 1, x[-1] + 1, 100)
        for nu in range(3):
            np.testing.assert_array_equal(g(q * x_unit, nu), f(q, nu) * y_unit / x_unit**nu)
        assert g.integrate(*x[[0, -1]] * x_unit) == f.integrate(*x[[0, -1]]) * x_unit * y_unit


@pytest.mark.parametrize("kind", ["quintic", "quintic, fritsch-butland", "quartic"])
def test_functions_run_through_backwards(kind, rng):
    for count in (2, 3, 10, 70):
        x, y = rng.uniform(0.2, 2, count).cumsum(), rng.exponential(size=count).cumsum()
        f, g = FUNCTIONS[kind](x, y), FUNCTIONS[kind](-x[::-1], y[::-1])
        q = rng.uniform(x[0], x[-1], 100)
        for nu in range(3):
            size = np.abs(f(q, nu)).max()
            np.testing.assert_allclose(g(-q, nu) * (-1) ** nu, f(q, nu), rtol=0, atol=1e-11 * size)
