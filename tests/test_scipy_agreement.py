# SPDX-License-Identifier: MIT OR Apache-2.0

"""Without tension, ν-splines and tension cubics are the C² cubic that SciPy builds."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import cases
import polygons
import shapespline as ss


def scipy_ends(case: cases.Case):
    """Return SciPy's name for the case's ends."""
    if isinstance(case.boundary, ss.Tangents):
        ends = (case.boundary.start, case.boundary.end)
        nothing = np.zeros(np.shape(case.points)[1])
        return tuple((2, nothing) if v is None else (1, v) for v in ends)
    return {"zero-curvature": "natural", "periodic": "periodic"}[case.boundary]


def agrees(case: cases.Case) -> None:
    """Compare all derivatives, segment by segment, relative to the terms that make them.

    The second and third derivatives of a segment are differences of slopes over h and h², and the
    slopes carry rounding in both libraries: where the derivative itself is small, as on a line or
    on densely sampled smooth data, they can agree no better than that.
    """
    ours = case.fit()
    theirs = CubicSpline(ours.parameters, ours.points, bc_type=scipy_ends(case))
    u, h = ours.parameters, np.diff(ours.parameters)
    inside = u[:-1, None] + h[:, None] * np.linspace(0, 1, 9)[:-1]
    extent = np.ptp(ours.points, axis=0).max()
    slope = np.abs(theirs(inside, 1)).max()
    for order in range(4):
        size = np.full(len(h), extent) if order == 0 else slope / h ** (order - 1)
        error = np.abs(ours(inside, order) - theirs(inside, order)).max(axis=(1, 2))
        assert np.all(error <= 1e-12 * size), (order, (error / size).max())


COMPARABLE = [
    c
    for c in cases.of_every_family([*cases.shared(), *cases.small()])
    if c.boundary != "circular" and c.family in (ss.NuSpline, ss.TensionSpline)
]


@pytest.mark.parametrize("case", COMPARABLE, ids=str)
def test_data_sets(case):
    agrees(case)


@pytest.mark.parametrize("end", ["zero-curvature", "periodic", "tangents"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("count", [2, 3, 4, 5, 50, 2000])
@pytest.mark.parametrize("family", [ss.NuSpline, ss.TensionSpline], ids=lambda c: c.__name__)
def test_random_walks(family, end, dim, count, rng):
    points = polygons.random_walk(rng, count, dim)
    if end == "periodic":
        if count == 2:
            points = np.vstack([points, points + 1.0])
        points = polygons.close(points)
    boundary = ss.Tangents(rng.normal(size=dim), rng.normal(size=dim)) if end == "tangents" else end
    agrees(cases.Case("walk", points, "chordal", boundary, family))


def test_natural_is_another_name_for_zero_curvature(rng):
    points = polygons.random_walk(rng, 12)
    a = ss.NuSpline(points, boundary="natural")
    b = ss.NuSpline(points, boundary="zero-curvature")
    np.testing.assert_array_equal(a.tangents, b.tangents)


@pytest.mark.parametrize(
    ("name", "exponent"), [("uniform", 0.0), ("centripetal", 0.5), ("chordal", 1.0)]
)
def test_parametrisations(name, exponent, rng):
    points = polygons.random_walk(rng, 20)
    u = ss.NuSpline(points, name).parameters
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    np.testing.assert_allclose(np.diff(u), lengths**exponent, rtol=1e-13)
    assert u[0] == 0.0
    np.testing.assert_array_equal(ss.NuSpline(points, exponent).parameters, u)


def test_a_parabola_with_its_own_tangents_comes_back():
    """Planted: the clamped cubic reproduces a polynomial of degree up to 3."""
    u = np.array([0.0, 0.5, 2.0, 3.0, 7.0])
    points = np.stack([u, u**2 - u, 1 - u**3], axis=-1)
    ends = ss.Tangents([1.0, -1.0, 0.0], [1.0, 13.0, -147.0])
    curve = ss.NuSpline(points, u, boundary=ends)
    t = np.linspace(0, 7, 101)
    np.testing.assert_allclose(
        curve(t), np.stack([t, t**2 - t, 1 - t**3], axis=-1), atol=1e-12 * 343
    )
    np.testing.assert_allclose(curve(t, 3), np.broadcast_to([0.0, 0.0, -6.0], (101, 3)), atol=1e-9)


def test_circular_ends_follow_the_circles_through_three_points(rng):
    points = polygons.random_walk(rng, 9)
    tangents = ss.NuSpline(points, boundary="circular").tangents
    start = polygons.circle_tangent(*points[:3])
    end = -polygons.circle_tangent(*points[:-4:-1])
    for tangent, expected in ((tangents[0], start), (tangents[-1], end)):
        np.testing.assert_allclose(tangent / np.linalg.norm(tangent), expected, atol=1e-13)
