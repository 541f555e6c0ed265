# SPDX-License-Identifier: MIT OR Apache-2.0

"""`FairSpline` as a B-spline: simple knots but at corners, and still the same curve."""

import numpy as np
import pytest

import polygons
import shapespline as ss
from shapespline import interchange

every_dimension = pytest.mark.parametrize("dim", [2, 3])
every_energy = pytest.mark.parametrize("energy", ["parametric", "bending"])
ENDS = ["natural", "circular", "periodic", "tangents"]


def fitted(rng, dim, ends, energy="parametric", count=11, **options):
    """Return a fair curve through a random walk, with some kind of ends."""
    points = polygons.random_walk(rng, count, dim)
    if ends == "periodic":
        options["closed"] = True
    elif ends == "tangents":
        chords = np.diff(points, axis=0)
        speeds = np.linalg.norm(chords, axis=1)[:, None]
        options["boundary"] = ss.Tangents(*(chords / speeds)[[0, -1]])
    else:
        options["boundary"] = ends
    return ss.FairSpline(points, energy=energy, **options)


def multiplicities(curve, knots):
    """Return how often each inner knot of a curve is among the knots of a B-spline."""
    return np.array([np.count_nonzero(knots == u) for u in curve.knots[1:-1]])


@every_dimension
@every_energy
@pytest.mark.parametrize("ends", ENDS)
def test_knots_are_simple_and_values_the_same(dim, energy, ends, rng):
    for _ in range(3):
        curve = fitted(rng, dim, ends, energy)
        spline, data = curve.to_bspline(), interchange.bspline(curve)
        u = np.linspace(*curve.parameters[[0, -1]], 400)
        for knots in (spline.t, data.knots):
            assert np.all(multiplicities(curve, knots) == 1)
        size = np.abs(curve.bezier).max()
        np.testing.assert_allclose(spline(u), curve(u), rtol=0, atol=1e-14 * size)
        back = ss.PiecewiseBezier.from_bspline(data.knots, data.control, 3)
        np.testing.assert_allclose(back.control, curve.bezier, rtol=0, atol=1e-14 * size)
        given = {"parameters": curve.parameters, "boundary": curve.boundary}
        assert ss.check_shape(curve.points, spline, **given, **curve._fit_options()).ok


@every_dimension
@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("corners", [(4,), (1, 3), (1, 2, 9)])
def test_knots_are_triple_at_corners(dim, ends, corners, rng):
    curve = fitted(rng, dim, ends, corners=corners)
    spline = curve.to_bspline()
    sharp = np.isin(curve.knots[1:-1], curve.parameters[list(corners)])
    np.testing.assert_array_equal(multiplicities(curve, spline.t), np.where(sharp, 3, 1))
    u = np.linspace(*curve.parameters[[0, -1]], 400)
    size = np.abs(curve.bezier).max()
    np.testing.assert_allclose(spline(u), curve(u), rtol=0, atol=1e-14 * size)


@every_dimension
@every_energy
@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("corners", [(), (2, 7)])
def test_the_second_derivative_is_continuous_but_at_corners(dim, energy, ends, corners, rng):
    curve = fitted(rng, dim, ends, energy, corners=corners)
    inner = curve.knots[1:-1]
    smooth = ~np.isin(inner, curve.parameters[list(corners)])
    left, right = (curve(inner[smooth], 2, side=side) for side in ("left", "right"))
    if ends == "periodic":
        left = np.vstack([left, curve(curve.knots[-1], 2, side="left")])
        right = np.vstack([right, curve(curve.knots[0], 2)])
    np.testing.assert_allclose(left, right, rtol=0, atol=1e-10 * np.abs(right).max())


@every_dimension
def test_a_closed_curve_goes_around(dim, rng):
    """Three knots more on both sides, and the last control points the first: C² at the seam too."""
    for count in (3, 4, 9):
        curve = fitted(rng, dim, "periodic", count=count)
        spline = curve.to_bspline()
        period = curve.knots[-1] - curve.knots[0]
        np.testing.assert_array_equal(spline.c[:3], spline.c[-3:])
        np.testing.assert_allclose(spline.t[-7:] - spline.t[:7], period, rtol=1e-15)
        u = curve.knots[0] + period * np.linspace(-1, 2, 50)
        np.testing.assert_allclose(
            spline(u), spline(u + period), atol=1e-12 * np.abs(spline.c).max()
        )
        # With a corner at the seam there is nothing to continue.
        clamped = ss.FairSpline(curve.points, closed=True, corners=[0]).to_bspline()
        assert np.all(clamped.t[:4] == curve.knots[0])
