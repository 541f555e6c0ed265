# SPDX-License-Identifier: MIT OR Apache-2.0

"""C² tension cubics: what Manni 2001 proves of them, seen from Python."""

from dataclasses import replace

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

CASES = [replace(case, family=ss.TensionSpline) for case in cases.small()]
every_case = pytest.mark.parametrize("case", CASES, ids=str)


def random_scale(case, least, rng):
    """Return (λ⁰, λ¹) between ``least`` and 1, evenly spread over the magnitudes."""
    return tuple(10 ** rng.uniform(np.log10(least), 0, (2, len(case.points) - 1)))


@pytest.mark.parametrize("least", [0.5, 0.1, 1e-3])
@every_case
def test_twice_continuously_differentiable_at_the_knots(case, least, rng):
    """Theorem 3.1: for any λ, to 1e-10 of the derivative beside the knot.

    Where λ is small, Q″ is (C″ − Q′s″)/λ², a difference of terms of size T/(hλ²): no float holds it
    better than rounding of these.
    """
    scale0, scale1 = random_scale(case, least, rng)
    curve = case.fit(tangent_scale=(scale0, scale1))
    u = curve.parameters
    h = np.diff(u)
    before, after = np.arange(len(h) - 1), np.arange(1, len(h))
    if case.boundary == "periodic":
        before, after = np.r_[before, len(h) - 1], np.r_[after, 0]
    extent = np.ptp(curve.points, axis=0).max()
    slope = np.abs(curve(u, 1)).max()
    terms = slope / np.minimum(h[before] * scale1[before] ** 2, h[after] * scale0[after] ** 2)
    for order, rounding in enumerate((1e-15 * extent, 1e-14 * slope, 1e-14 * terms)):
        left = curve(u[before + 1], order, side="left")
        right = curve(u[after], order, side="right")
        allowed = 1e-10 * np.linalg.norm(right, axis=1) * (order > 0) + rounding
        assert np.all(np.abs(left - right).max(axis=1) <= allowed), order


@every_case
def test_the_tangents_are_the_derivatives_and_solve_the_system(case, rng):
    """(3.7)–(3.8), row by row."""
    scale0, scale1 = random_scale(case, 0.01, rng)
    curve = case.fit(tangent_scale=(scale0, scale1))
    np.testing.assert_array_equal(curve.tangent_scale, (scale0, scale1))
    u, T = curve.parameters, curve.tangents
    np.testing.assert_allclose(curve(u[:-1], 1), T[:-1], rtol=1e-12, atol=1e-12 * np.abs(T).max())
    h, L = np.diff(u)[:, None], np.diff(curve.points, axis=0)
    p, q = scale0[:, None], scale1[:, None]
    A, B = (h * q)[:-1] ** 2, (h * p)[1:] ** 2
    terms = [
        (h * p)[:-1] * B * T[:-2],
        (h[:-1] * (3 - p[:-1]) * B + h[1:] * (3 - q[1:]) * A) * T[1:-1],
        (h * q)[1:] * A * T[2:],
        -3 * A * L[1:],
        -3 * B * L[:-1],
    ]
    size = np.max([np.abs(term).max(axis=1) for term in terms], axis=0)
    assert np.all(np.abs(sum(terms)).max(axis=1) <= 1e-12 * size)


@every_case
def test_with_one_scale_a_node_the_image_is_a_nu_spline(case, rng):
    """(3.10), with natural ends of this library's own: two families, two linear systems."""
    n = len(case.points)
    scale = rng.uniform(0.05, 1.0, n)
    if case.boundary == "periodic":
        scale[-1] = scale[0]
    curve = case.fit(tangent_scale=scale)
    h = np.diff(curve.parameters)
    nu = np.zeros(n)

    def at(before, after, far0, near, far1):
        pull = (6 - 4 * near - 2 * far1) / after + (6 - 2 * far0 - 4 * near) / before
        return np.sqrt(before * after) * pull / near

    for i in range(1, n - 1):
        nu[i] = at(h[i - 1], h[i], scale[i - 1], scale[i], scale[i + 1])
    if case.boundary == "periodic":
        nu[0] = nu[-1] = at(h[-1], h[0], scale[-2], scale[0], scale[1])
    else:
        # (2 + ν/2) λ T + λ' T' = 3L/h against (3 − λ') T + λ' T' = 3L/h.
        natural = 2 * ((3 - scale[[1, -2]]) / scale[[0, -1]] - 2)
        is_natural = case.boundary == "zero-curvature"
        if isinstance(case.boundary, ss.Tangents):
            is_natural = [case.boundary.start is None, case.boundary.end is None]
        nu[[0, -1]] = np.where(is_natural, natural, 1 / scale[[0, -1]] - 1)
    other = replace(case, family=ss.NuSpline).fit(tension=nu)
    expected = scale[:, None] * curve.tangents
    size = np.abs(expected).max()
    np.testing.assert_allclose(other.tangents, expected, rtol=0, atol=1e-11 * size)
    np.testing.assert_allclose(
        other.bezier, curve.bezier, rtol=0, atol=1e-11 * np.abs(curve.bezier).max()
    )


@every_case
def test_derivatives_are_those_of_differences(case, rng):
    curve = case.fit(tangent_scale=random_scale(case, 0.2, rng))
    u = curve.parameters
    h = np.diff(u)[:, None]
    at = u[:-1, None] + h * np.linspace(0.1, 0.9, 9)
    step = 1e-5 * h
    for order in (1, 2, 3):
        difference = (curve(at + step, order - 1) - curve(at - step, order - 1)) / (2 * step)[
            ..., None
        ]
        value = curve(at, order)
        size = (
            np.abs(value).max(axis=(1, 2)) + np.abs(curve(at, order - 1)).max(axis=(1, 2)) / h[:, 0]
        )
        assert np.all(np.abs(value - difference).max(axis=(1, 2)) <= 1e-5 * size), order


@pytest.mark.parametrize("scale", [1.0, 0.1, 1e-6, 1e-12])
@every_case
def test_evaluation_for_any_scale(case, scale):
    """Newton's iteration ends, is exact at the knots and monotone in between."""
    curve = case.fit(tangent_scale=scale)
    u = curve.parameters
    for side in ("left", "right"):
        np.testing.assert_array_equal(curve(u[1:-1], side=side), curve.points[1:-1])
    t = np.r_[0.0, np.logspace(-15, 0, 200), 1 - np.logspace(-15, 0, 200)]
    at = (u[:-1, None] + np.diff(u)[:, None] * np.sort(t)[:-1]).ravel()
    image = curve.image_parameter(at)
    assert np.all(np.diff(image) >= 0)
    assert np.isfinite(curve(at)).all()
    # s(t) back again: the cubic of (3.3).
    i = np.clip(np.searchsorted(u, image, side="right") - 1, 0, len(u) - 2)
    h = np.diff(u)[i]
    t = (image - u[i]) / h
    back = u[i] + h * (scale * t * (1 - t) ** 2 + t**2 * (3 - 2 * t) - scale * t**2 * (1 - t))
    np.testing.assert_allclose(back, at, rtol=0, atol=4e-15 * max(abs(u[0]), abs(u[-1])))


@every_case
def test_other_forms_have_the_same_image(case, rng):
    curve = case.fit(tangent_scale=random_scale(case, 0.05, rng))
    u = np.sort(rng.uniform(*curve.parameters[[0, -1]], 500))
    at, expected = curve.image_parameter(u), curve(u)
    atol = 1e-12 * np.abs(curve.points).max()
    np.testing.assert_allclose(curve.to_ppoly()(at), expected, rtol=0, atol=atol)
    np.testing.assert_allclose(curve.to_bspline()(at), expected, rtol=0, atol=atol)
    np.testing.assert_allclose(
        curve.image_parameter(curve.parameters), curve.parameters, rtol=0, atol=1e-15 * at[-1]
    )
    # Without tension, the two parameters are one.
    plain = case.fit()
    np.testing.assert_allclose(plain.image_parameter(u), u, rtol=1e-14)
    np.testing.assert_allclose(plain.to_ppoly()(u), plain(u), rtol=0, atol=atol)
    assert np.ndim(curve.image_parameter(1.0)) == 0


def test_outside_the_curve_goes_on_smoothly_or_around():
    case = replace(cases.gm_line(), family=ss.TensionSpline)
    curve = case.fit(tangent_scale=0.3)
    first, last = curve.parameters[[0, -1]]
    step = 1e-7 * (last - first)
    for end, outside in ((first, first - step), (last, last + step)):
        expected = curve(end) + (outside - end) * curve(end, 1)
        np.testing.assert_allclose(curve(outside), expected, atol=1e-9 * np.abs(expected).max())
    closed = next(c for c in CASES if str(c).endswith("walk, closed")).fit(tangent_scale=0.3)
    u = np.linspace(*closed.parameters[[0, -1]], 50)[1:-1]
    period = closed.parameters[-1] - closed.parameters[0]
    np.testing.assert_allclose(closed(u + period), closed(u), atol=1e-12 * np.ptp(closed.points))


@pytest.mark.parametrize("step", [0.5, 0.9])
def test_published_reduction_on_the_gm_line(step):
    """Specification, section 2: one reduction for ρ = 0.5, six for ρ = 0.9."""
    case = replace(cases.gm_line(), family=ss.TensionSpline)
    assert len(case.fit().check(cases.PAPERS).violations) == 4
    curve = case.preserve(strategy="reduction", step=step)
    reductions = {0.5: 1, 0.9: 6}[step]
    assert curve.diagnostics.iterations == reductions + 1
    assert curve.check().ok
    if step == 0.5:
        expected = np.zeros(20)
        expected[0:7] = expected[14:18] = 1.0
        np.testing.assert_array_equal(curve.tension, expected)
    # Both λ of a node stay together.
    starts, ends = curve.tangent_scale
    np.testing.assert_array_equal(starts[1:], ends[:-1])
    np.testing.assert_allclose(starts, 1 / (1 + curve.tension[:-1]), rtol=1e-15)


def test_tension_is_that_of_the_smaller_scale():
    points = polygons.random_walk(np.random.default_rng(1), 4)
    curve = ss.TensionSpline(points, tangent_scale=([0.5, 0.25, 1.0], [1.0, 0.1, 0.2]))
    np.testing.assert_allclose(curve.tension, [1.0, 3.0, 9.0, 4.0], rtol=1e-14)


@every_case
def test_all_ways_to_give_the_scale_agree(case):
    n = len(case.points)
    curve = case.fit(tangent_scale=0.25)
    for scale in (np.full(n, 0.25), [0.25] * n, (0.25, np.full(n - 1, 0.25)),
                  np.full((2, n - 1), 0.25), (np.full(n - 1, 0.25), [0.25] * (n - 1))):  # fmt: skip
        np.testing.assert_array_equal(case.fit(tangent_scale=scale).tangents, curve.tangents)


def test_locations_of_a_report_are_parameters_of_the_curve():
    """At the location of a convexity violation, the curve itself turns the wrong way."""
    points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    scale = [1.0, 0.9, 0.3, 0.9, 1.0]
    curve = ss.TensionSpline(points, "uniform", tangent_scale=scale)
    report = curve.check()
    found = 0
    P = np.cross(np.diff(points, axis=0)[:-1], np.diff(points, axis=0)[1:])
    for record in report.violations:
        if record.criterion == "convexity":
            omega = np.cross(curve(record.location, 1), curve(record.location, 2))
            normals = P[record.segment - 1], P[record.segment]
            assert min(omega @ n for n in normals) < 0
            found += 1
    assert found
    assert report.violations == [r for r in report.segments if not r.satisfied]
