# SPDX-License-Identifier: MIT OR Apache-2.0

"""Moving, turning, scaling or reversing the data moves the curve with it, by rounding only.

This holds for the tension that a strategy finds as well: a sweep from one end, or a tolerance
with a unit, would show here.
"""

from dataclasses import replace

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

CASES = cases.of_every_family(cases.small())


def given(case: cases.Case):
    """Return an uneven tension that suits closed data too."""
    tension = 1.0 + np.cos(np.arange(len(case.points))) ** 2
    tension[-1] = tension[0]
    return tension


def fits(case: cases.Case, strategy: str):
    """Return the case's curve: by a strategy, or with tension given."""
    if strategy == "given" and case.family in cases.TENSE:
        return case.tense(given(case))
    if case.family in (ss.FairSpline, ss.CatmullRom) and strategy != cases.STRATEGIES[0]:
        pytest.skip("knows no strategy: once is enough")
    return case.preserve(strategy=strategy)


def assert_moved(before, after, back, *, scale=1.0, parameter_scale=1.0):
    """Compare both curves at the same places, after taking the second back to the first."""
    t = np.linspace(0, 1, 7)[:-1]
    u, v = before.parameters, after.parameters
    np.testing.assert_allclose(v / parameter_scale, u, rtol=0, atol=1e-12 * u[-1])
    tension = [cases.tension_of(curve) for curve in (after, before)]
    np.testing.assert_allclose(*tension, rtol=1e-9, atol=1e-12)
    here = before(u[:-1, None] + np.diff(u)[:, None] * t)
    there = back(after(v[:-1, None] + np.diff(v)[:, None] * t) / scale)
    np.testing.assert_allclose(there, here, rtol=0, atol=accuracy(before))


def accuracy(curve):
    """Return what the moved curve may differ by: fair curves are found by iterations."""
    share = 1e-6 if isinstance(curve, ss.FairSpline) else 1e-11
    return share * np.ptp(curve.points, axis=0).max()


every_fit = pytest.mark.parametrize("strategy", ["given", *cases.STRATEGIES])
every_case = pytest.mark.parametrize("case", CASES, ids=str)


@every_fit
@every_case
def test_rotation(case, strategy, rng):
    turn = polygons.rotation(rng, case.points.shape[1])
    moved = case.moved(case.points @ turn, lambda v: v @ turn)
    assert_moved(fits(case, strategy), fits(moved, strategy), lambda x: x @ turn.T)


@every_fit
@every_case
def test_translation(case, strategy, rng):
    shift = 3 * np.ptp(case.points) * rng.normal(size=case.points.shape[1])
    moved = case.moved(case.points + shift)
    assert_moved(fits(case, strategy), fits(moved, strategy), lambda x: x - shift)


@every_fit
@every_case
@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_scaling_points(case, strategy, scale):
    """With parameters kept, tangents grow with the points."""
    case = case.explicit()
    moved = case.moved(case.points * scale, lambda v: v * scale)
    assert_moved(fits(case, strategy), fits(moved, strategy), lambda x: x, scale=scale)


@every_fit
@every_case
@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_scaling_parameters(case, strategy, scale):
    """With points kept, tangents shrink as the parameters grow."""
    case = case.explicit()
    moved = case.moved(case.points, lambda v: v / scale)
    moved = replace(moved, parameters=case.parameters * scale)
    assert_moved(fits(case, strategy), fits(moved, strategy), lambda x: x, parameter_scale=scale)


@pytest.mark.parametrize("parameters", ["chordal", "centripetal", "uniform"])
@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_scaling_points_with_their_parametrisation(parameters, scale, rng):
    points = polygons.random_walk(rng, 12)
    before = cases.Case("walk", points, parameters).preserve()
    after = cases.Case("walk", points * scale, parameters).preserve()
    ratio = after.parameters[-1] / before.parameters[-1]
    power = {"chordal": 1.0, "centripetal": 0.5, "uniform": 0.0}[parameters]
    assert ratio == pytest.approx(scale**power, rel=1e-12)
    assert_moved(before, after, lambda x: x, scale=scale, parameter_scale=ratio)


@every_fit
@every_case
def test_reversal(case, strategy):
    forward, backward = fits(case.explicit(), strategy), case.reversed()
    if strategy == "given" and case.family in cases.TENSE:
        backward = backward.tense(given(case)[::-1])
    else:
        backward = fits(backward, strategy)
    u, v = forward.parameters, backward.parameters
    tension = [cases.tension_of(backward)[::-1], cases.tension_of(forward)]
    np.testing.assert_allclose(*tension, rtol=1e-9, atol=1e-12)
    inside = np.linspace(u[0], u[-1], 400)
    np.testing.assert_allclose(
        backward((v[0] + v[-1]) - inside), forward(inside), rtol=0, atol=accuracy(forward)
    )


@pytest.mark.parametrize("strategy", cases.STRATEGIES)
def test_where_a_closed_polygon_starts_does_not_matter(strategy):
    points = polygons.random_walk(np.random.default_rng(8), 40)
    before = cases.Case("closed", polygons.close(points), "chordal", "periodic")
    after = cases.Case("closed", polygons.close(np.roll(points, -5, axis=0)), "chordal", "periodic")
    before, after = before.preserve(strategy=strategy), after.preserve(strategy=strategy)
    assert before.tension.max() > 0
    np.testing.assert_allclose(
        after.tension[:-1], np.roll(before.tension[:-1], -5), rtol=1e-9, atol=1e-12
    )
    shift = before.parameters[5]
    u = np.linspace(*after.parameters[[0, -1]], 300)
    np.testing.assert_allclose(after(u), before(u + shift), rtol=0, atol=1e-11 * np.ptp(points))
