# SPDX-License-Identifier: MIT OR Apache-2.0

"""How far a moved point reaches: the README's row on locality."""

import numpy as np
import pytest

import polygons
import shapespline as ss


@pytest.mark.parametrize("curve", [ss.NuSpline, ss.TensionSpline], ids=lambda c: c.__name__)
def test_a_change_fades_by_half_or_more_at_every_point(curve, rng):
    """Uniform parameters: the system's rows are 1, 4, 1, and 2 − √3 is the ratio in the limit."""
    points = polygons.random_walk(rng, 60)
    moved = points.copy()
    moved[30] += 1.0
    u = np.arange(60.0)
    for options in ({}, {"tension": 2.0} if curve is ss.NuSpline else {"tangent_scale": 0.5}):
        change = curve(moved, u, **options).tangents - curve(points, u, **options).tangents
        size = np.abs(change).max(axis=1)
        for away in range(2, 15):
            for side in (-1, 1):
                assert 0 < size[30 + side * away] <= size[30 + side * (away - 1)] / 2


@pytest.mark.parametrize("curve", [ss.NuSpline, ss.TensionSpline], ids=lambda c: c.__name__)
def test_a_change_far_away_is_below_rounding(curve, rng):
    points = polygons.random_walk(rng, 400)
    moved = points.copy()
    moved[:5] += 1.0
    before, after = curve(points, "uniform"), curve(moved, "uniform")
    np.testing.assert_allclose(after.tangents[100:], before.tangents[100:], atol=1e-13)


@pytest.mark.parametrize("preserve", [False, True])
def test_a_catmull_rom_curve_changes_on_two_segments_to_either_side(preserve, rng):
    points = polygons.random_walk(rng, 30)
    moved = points.copy()
    moved[15] += 0.3
    u = np.arange(30.0)
    fit, options = ss.CatmullRom, {}
    if preserve:
        fit, options = fit.shape_preserving, {"directions": "parametrization"}
    before, after = fit(points, u, **options).bezier, fit(moved, u, **options).bezier
    changed = np.flatnonzero(np.any(before != after, axis=(1, 2)))
    # Handles that are limited follow the criteria of the segments on both sides of their node.
    reach = 3 if preserve else 2
    assert set(changed) <= set(range(15 - reach, 15 + reach))
    assert {14, 15} <= set(changed)


def test_a_change_of_monotone_data_fades_by_half_or_more_at_every_point(rng):
    for _ in range(20):
        x = np.cumsum(rng.uniform(0.2, 1, 40))
        steps = rng.lognormal(0, 0.3, 40)
        y = np.cumsum(steps)
        moved = y.copy()
        moved[20] += 0.1 * steps[20:22].min()
        change = np.abs(ss.MonotoneCubic(x, moved).slopes - ss.MonotoneCubic(x, y).slopes)
        assert change.argmax() in (19, 20, 21)
        for away in range(2, 18):
            beyond = max(change[: 20 - away + 1].max(), change[20 + away :].max())
            assert beyond <= 2.0 ** (1 - away) * change.max()


def test_a_point_of_the_quartic_moves_four_intervals(rng):
    x, y = np.cumsum(rng.uniform(0.2, 1, 30)), np.cumsum(rng.lognormal(0, 1, 30))
    moved = y.copy()
    moved[15] += 0.1 * (y[16] - y[15])
    q = np.linspace(x[:-1], x[1:], 20, endpoint=False)[1:]
    before, after = ss.MonotoneQuartic(x, y)(q), ss.MonotoneQuartic(x, moved)(q)
    assert set(np.flatnonzero((before != after).any(axis=0))) == {13, 14, 15, 16}
