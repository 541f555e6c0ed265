# SPDX-License-Identifier: MIT OR Apache-2.0

"""Evaluation against SciPy's piecewise polynomials, for every kind of query."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import cases
import polygons
import shapespline as ss


def tense(case: cases.Case):
    """Return the case's curve with uneven tension, so that second derivatives jump at the knots."""
    count = len(case.points)
    tension = np.random.default_rng(5).uniform(0, 8, count) * (np.arange(count) % 3 > 0)
    tension[-1] = tension[0]  # of closed data, the first and the last node are one
    return case.tense(tension)


# The curves that are a cubic in their own parameter, with one tangent a point.
CUBIC = [c for c in cases.of_every_family(cases.small()) if c.family is not cases.ss.TensionSpline]
ALL = cases.of_every_family(cases.small())


def reference(curve) -> CubicHermiteSpline:
    """Return SciPy's curve through the same points with the same tangents.

    Of a fair curve, those at its extra knots are the ends of its Bézier pieces.
    """
    end = "periodic" if curve.boundary == "periodic" else True
    knots, points, tangents = curve.knots, curve.points, curve.tangents
    if len(knots) > len(points):
        control, h = curve.bezier, np.diff(knots)[:, None]
        points = np.vstack([control[:, 0], control[-1:, 3]])
        starts = 3 * (control[:, 1] - control[:, 0]) / h
        tangents = np.vstack([starts, 3 * (control[-1:, 3] - control[-1:, 2]) / h[-1]])
    return CubicHermiteSpline(knots, points, tangents, extrapolate=end)


def assert_same(curve, theirs, u, order):
    """Compare relative to the largest value of the derivative."""
    expected = theirs(u, order)
    found = curve(u, order)
    assert found.shape == expected.shape
    assert found.dtype == np.float64
    if expected.size:
        scale = np.abs(expected).max()
        if order > 0:
            # Higher derivatives are differences of slopes over h: they cancel on smooth curves.
            h = np.diff(curve.knots).min()
            scale = max(scale, np.abs(curve.tangents).max() / h ** (order - 1))
        # The slopes at extra knots are differences of rounded control points.
        share = 2e-13 if len(curve.knots) == len(curve.points) else 1e-10
        np.testing.assert_allclose(found, expected, rtol=0, atol=share * scale)


@pytest.mark.parametrize("order", range(5))
@pytest.mark.parametrize("case", CUBIC, ids=str)
def test_every_derivative_inside_outside_and_at_the_knots(case, order, rng):
    curve = tense(case)
    theirs = reference(curve)
    first, last = curve.parameters[[0, -1]]
    width = last - first
    inside = rng.uniform(first, last, 200)
    assert_same(curve, theirs, inside, order)
    assert_same(curve, theirs, np.sort(inside), order)
    assert_same(curve, theirs, np.sort(inside)[::-1], order)
    assert_same(curve, theirs, curve.parameters[:-1], order)
    # End polynomials go on outside as in SciPy; closed curves go round again.
    outside = rng.uniform(first - 0.3 * width, last + 0.3 * width, 200)
    assert_same(curve, theirs, outside, order)


@pytest.mark.parametrize("shape", [(), (0,), (1,), (7,), (2, 3), (4, 1, 5), (0, 3)])
@pytest.mark.parametrize("dim", [2, 3])
def test_the_result_has_the_shape_of_the_query_and_one_axis_more(shape, dim, rng):
    curve = cases.Case("walk", polygons.random_walk(rng, 8, dim)).fit(tension=1.0)
    u = rng.uniform(*curve.parameters[[0, -1]], size=shape)
    assert curve(u).shape == (*shape, dim)
    assert_same(curve, reference(curve), u, 1)


def test_scalars_of_every_kind(rng):
    curve = cases.Case("walk", polygons.random_walk(rng, 8)).fit(tension=1.0)
    expected = curve(np.array([1.0]))[0]
    for one in (1, 1.0, np.float32(1.0), np.int64(1), np.array(1.0)):
        assert curve(one).shape == (3,)
        np.testing.assert_array_equal(curve(one), expected)
    np.testing.assert_array_equal(curve([1, 1.0]), [expected, expected])


@pytest.mark.parametrize("count", [3, 25, 3000])
def test_many_queries_take_the_same_values_as_few(count, rng):
    """Long queries may go another way through the code: sorted, unsorted, in parallel."""
    curve = tense(cases.Case("walk", polygons.random_walk(rng, count)))
    theirs = reference(curve)
    u = rng.uniform(*curve.parameters[[0, -1]], 200_000)
    for order in range(4):
        assert_same(curve, theirs, u, order)
        assert_same(curve, theirs, np.sort(u), order)
    strided = np.repeat(u, 2)[::2]
    np.testing.assert_array_equal(curve(strided), curve(u))


@pytest.mark.parametrize("case", ALL, ids=str)
def test_nan_in_nan_out_and_only_there(case):
    curve = case.fit()
    u = np.array([curve.parameters[0], np.nan, curve.parameters[1]])
    for order in range(4):
        values = curve(u, order)
        assert np.isnan(values[1]).all()
        assert np.isfinite(values[[0, 2]]).all()
    assert np.isnan(curve(np.nan)).all()


@pytest.mark.parametrize("case", ALL, ids=str)
def test_the_curve_passes_through_its_points(case):
    curve = tense(case)
    size = np.ptp(curve.points, axis=0).max()
    for side in ("left", "right"):
        error = np.abs(curve(curve.parameters, side=side) - curve.points).max()
        assert error <= 4e-16 * max(size, np.abs(curve.points).max())


@pytest.mark.parametrize("case", cases.small(), ids=str)
def test_the_jump_of_the_second_derivative_is_the_tension(case):
    """(3.2): Q''(u⁺) − Q''(u⁻) = ν q / √(h h); the first derivative does not jump (C¹)."""
    curve = tense(case)
    u, nu, q = curve.parameters, curve.tension, curve.tangents
    h = np.diff(u)
    nodes = np.arange(1, len(u) - 1)
    before, after = h[nodes - 1], h[nodes]
    if case.boundary == "periodic":
        nodes = np.r_[nodes, 0]
        before, after = np.r_[before, h[-1]], np.r_[after, h[0]]
    jump = curve(u[nodes], 2, side="right") - curve(u[nodes], 2, side="left")
    expected = (nu[nodes] / np.sqrt(before * after))[:, None] * q[nodes]
    scale = np.abs(curve(u, 2)).max()
    np.testing.assert_allclose(jump, expected, rtol=0, atol=1e-12 * scale)
    left, right = curve(u[nodes], 1, side="left"), curve(u[nodes], 1, side="right")
    np.testing.assert_allclose(left, right, rtol=0, atol=1e-13 * np.abs(q).max())


def test_ends_with_tension(rng):
    """(1+ν₀) q₀ = D₀ for given tangents; Q''(u₀) = ν₀ q₀ / h₀ and its mirror for zero curvature."""
    points = polygons.random_walk(rng, 7)
    tension = np.full(7, 0.7)
    boundary = cases.ss.Tangents([1.0, 2.0, 3.0], [3.0, -1.0, 0.5])
    q = cases.Case("walk", points, "chordal", boundary).fit(tension=tension).tangents
    np.testing.assert_allclose(1.7 * q[0], boundary.start, rtol=1e-14)
    np.testing.assert_allclose(1.7 * q[-1], boundary.end, rtol=1e-14)
    curve = cases.Case("walk", points).fit(tension=tension)
    q, h = curve.tangents, np.diff(curve.parameters)
    start, end = curve(curve.parameters[0], 2), curve(curve.parameters[-1], 2)
    np.testing.assert_allclose(start, 0.7 * q[0] / h[0], rtol=1e-11)
    # The printed (3.9b) lacks this minus sign (spec, E2).
    np.testing.assert_allclose(end, -0.7 * q[-1] / h[-1], rtol=1e-11)


@pytest.mark.parametrize("case", CUBIC, ids=str)
def test_other_forms_are_the_same_curve(case, rng):
    curve = tense(case)
    u = rng.uniform(*curve.parameters[[0, -1]], 300)
    spline, pieces = curve.to_bspline(), curve.to_ppoly()
    for order in range(4):
        found = curve(u, order)
        share = 1e-8 if isinstance(curve, ss.FairSpline) else 1e-11
        atol = share * max(np.abs(found).max(), np.abs(curve.points).max() * (order == 0))
        np.testing.assert_allclose(spline(u, order), found, rtol=0, atol=atol)
        np.testing.assert_allclose(pieces(u, order), found, rtol=0, atol=atol)
    control, h = curve.bezier, np.diff(curve.knots)[:, None]
    assert control.shape == (len(h), 4, curve.points.shape[1])
    if isinstance(curve, ss.FairSpline):
        first = np.searchsorted(curve.knots, curve.parameters[:-1])
        last = np.append(first[1:], len(h)) - 1
        np.testing.assert_array_equal(control[first, 0], curve.points[:-1])
        np.testing.assert_array_equal(control[last, 3], curve.points[1:])
        return
    np.testing.assert_array_equal(control[:, 0], curve.points[:-1])
    np.testing.assert_array_equal(control[:, 3], curve.points[1:])
    atol = 1e-13 * np.abs(curve.points).max()
    start, end = control[:, 1] - control[:, 0], control[:, 3] - control[:, 2]
    np.testing.assert_allclose(start, h * curve.tangents[:-1] / 3, rtol=0, atol=atol)
    np.testing.assert_allclose(end, h * curve.tangents[1:] / 3, rtol=0, atol=atol)
