# SPDX-License-Identifier: MIT OR Apache-2.0

"""Arc length, curvature, torsion and frame, against formulas and curves with known values."""

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

ALL = cases.of_every_family(cases.small())
SPACE = [case for case in ALL if case.points.shape[1] == 3]


def inside(curve, count=50):
    """Return parameters inside every segment, away from the knots."""
    u = curve.parameters
    return (u[:-1, None] + np.diff(u)[:, None] * np.linspace(0.05, 0.95, count)).ravel()


def quadrature(curve, a, b):
    """Return ∫‖γ'‖ by Gauss–Legendre with 40 parts a segment: dense, not clever."""
    u = curve.parameters
    breaks = np.unique(np.clip(np.concatenate([u, [a, b]]), a, b))
    x, w = np.polynomial.legendre.leggauss(20)
    parts = np.linspace(0, 1, 41)
    start = breaks[:-1, None] + np.diff(breaks)[:, None] * parts[:-1]
    width = np.diff(breaks)[:, None] / 40
    at = start[..., None] + width[..., None] * (x + 1) / 2
    speed = np.linalg.norm(curve(at, 1), axis=-1)
    return float(np.sum(speed * w * width[..., None] / 2))


@pytest.mark.parametrize("case", ALL, ids=str)
def test_arc_length_is_the_integral_of_the_speed(case):
    curve = case.preserve()
    first, last = curve.parameters[[0, -1]]
    for a, b in ((0.0, 1.0), (0.21, 0.83), (0.4, 0.41)):
        a, b = first + a * (last - first), first + b * (last - first)
        assert curve.arc_length(a, b) == pytest.approx(quadrature(curve, a, b), rel=1e-8)
    assert curve.arc_length() == curve.arc_length(first, last)


def test_arc_length_adds_up_and_changes_sign():
    curve = cases.gm_line().preserve()
    whole, part = curve.arc_length(0.1, 0.9), curve.arc_length(0.1, 0.47)
    assert part + curve.arc_length(0.47, 0.9) == pytest.approx(whole, rel=1e-9)
    assert curve.arc_length(0.9, 0.1) == -whole
    assert curve.arc_length(0.3, 0.3) == 0.0
    assert isinstance(whole, float)


def test_arc_length_of_a_straight_line_is_the_distance():
    """Tension makes the speed uneven, not the path longer."""
    points = np.outer([0.0, 1.0, 4.0, 6.0, 6.5], [2.0, 3.0, 6.0])
    curve = ss.NuSpline(points, tension=[0.0, 5.0, 0.0, 2.0, 1.0])
    assert curve.arc_length() == pytest.approx(6.5 * 7.0, rel=1e-9)


def test_arc_length_inside_one_segment_of_a_closed_curve():
    curve = cases.space_set("coil_m16n08_first", "periodic").fit()
    first, last = curve.parameters[[0, -1]]
    chords = np.linalg.norm(np.diff(curve.points, axis=0), axis=1).sum()
    assert chords < curve.arc_length(first, last) < 1.01 * chords


@pytest.mark.parametrize("case", ALL, ids=str)
def test_curvature_follows_its_formula(case):
    curve = case.preserve()
    u = inside(curve)
    first, second = curve(u, 1), curve(u, 2)
    speed = np.linalg.norm(first, axis=-1)
    # In any dimension: what of γ'' is across γ'.
    across = second - np.sum(first * second, -1, keepdims=True) / speed[:, None] ** 2 * first
    vector = across / speed[:, None] ** 2
    size = np.linalg.norm(vector, axis=-1)
    atol = 1e-9 * size.max()
    np.testing.assert_allclose(curve.curvature_vector(u), vector, rtol=1e-8, atol=atol)
    # In the plane, the curvature may carry the sign of the turn.
    np.testing.assert_allclose(np.abs(curve.curvature(u)), size, rtol=1e-8, atol=atol)


@pytest.mark.parametrize("case", SPACE, ids=str)
def test_torsion_follows_its_formula(case):
    curve = case.preserve()
    u = inside(curve)
    omega = np.cross(curve(u, 1), curve(u, 2))
    expected = np.sum(omega * curve(u, 3), -1) / np.sum(omega**2, -1)
    # det[γ', γ'', γ'''] of a tense segment is a difference of much larger products.
    size = np.linalg.norm(omega, axis=-1) * np.linalg.norm(curve(u, 3), axis=-1)
    noise = 1e-11 * size / np.sum(omega**2, -1)
    assert np.all(np.abs(curve.torsion(u) - expected) <= 1e-7 * np.abs(expected) + noise)


@pytest.mark.parametrize("case", SPACE, ids=str)
def test_the_frame_is_orthonormal_and_right_handed(case):
    curve = case.preserve()
    u = inside(curve)
    tangent, normal, binormal = curve.frame(u)
    for a in (tangent, normal, binormal):
        assert a.shape == (len(u), 3)
        np.testing.assert_allclose(np.linalg.norm(a, axis=-1), 1.0, rtol=1e-13)
    np.testing.assert_allclose(np.cross(tangent, normal), binormal, atol=1e-12)
    first, second = curve(u, 1), curve(u, 2)
    np.testing.assert_allclose(
        tangent, first / np.linalg.norm(first, axis=-1, keepdims=True), atol=1e-12
    )
    # γ'' lies in the plane of T and N, on N's side.
    size = np.linalg.norm(second, axis=-1)
    assert np.all(np.abs(np.sum(second * binormal, -1)) <= 1e-9 * size)
    assert np.all(np.sum(second * normal, -1) >= -1e-9 * size)


@pytest.mark.parametrize("case", [c for c in SPACE if c.family is not ss.CatmullRom], ids=str)
def test_curvature_is_continuous_and_torsion_is_one_sided_at_the_knots(case):
    """G²: T, B and κ have one value at a knot; torsion jumps, and side chooses."""
    curve = case.preserve()
    u = curve.parameters[1:-1]
    left, right = (curve.curvature(u, side=side) for side in ("left", "right"))
    np.testing.assert_allclose(left, right, rtol=1e-7, atol=1e-9 * right.max())
    bent = right > 1e-6 * right.max()
    for a, b in zip(curve.frame(u, side="left"), curve.frame(u, side="right"), strict=True):
        np.testing.assert_allclose(a[bent], b[bent], atol=1e-6)
    h = np.diff(curve.parameters)
    before, after = u - 1e-7 * h[:-1], u + 1e-7 * h[1:]
    for side, near in (("left", before), ("right", after)):
        at, beside = curve.torsion(u, side=side), curve.torsion(near)
        np.testing.assert_allclose(at[bent], beside[bent], rtol=1e-3, atol=1e-4 * np.ptp(at))


def test_a_dense_circle_has_the_curvature_of_its_radius():
    theta = np.linspace(0, 2 * np.pi, 401)
    points = 2.5 * np.column_stack([np.cos(theta), np.sin(theta), 0 * theta])
    points[-1] = points[0]
    curve = ss.NuSpline(points, boundary="periodic")
    u = inside(curve)
    np.testing.assert_allclose(curve.curvature(u), 1 / 2.5, rtol=1e-4)
    np.testing.assert_allclose(curve.torsion(u), 0.0, atol=1e-12)
    assert curve.arc_length() == pytest.approx(2 * np.pi * 2.5, rel=1e-8)
    np.testing.assert_allclose(curve.frame(u)[2], np.tile([0.0, 0.0, 1.0], (len(u), 1)))


def test_a_dense_helix_has_its_curvature_and_torsion():
    """(cos θ, sin θ, θ): κ = τ = 1/2."""
    theta = np.linspace(0, 12, 1201)
    points = np.column_stack([np.cos(theta), np.sin(theta), theta])
    curve = ss.NuSpline(points, boundary="circular")
    u = inside(curve)
    middle = u[(u > 0.1 * u[-1]) & (u < 0.9 * u[-1])]
    np.testing.assert_allclose(curve.curvature(middle), 0.5, rtol=1e-4)
    # The third derivative of a C² cubic is constant on a segment: first order in the spacing.
    np.testing.assert_allclose(curve.torsion(middle), 0.5, rtol=2e-2)


def test_scalars_give_scalars_and_arrays_keep_their_shape():
    curve = cases.helix().fit()
    u = np.linspace(1, 5, 6).reshape(2, 3)
    assert curve.curvature(u).shape == curve.torsion(u).shape == (2, 3)
    assert np.ndim(curve.curvature(1.5)) == np.ndim(curve.torsion(1.5)) == 0
    assert curve.curvature_vector(u).shape == (2, 3, 3)
    assert all(v.shape == (2, 3, 3) for v in curve.frame(u))
    assert all(v.shape == (3,) for v in curve.frame(1.5))


@pytest.mark.parametrize("case", ALL, ids=str)
def test_sample_by_parameter(case):
    curve = case.fit()
    first, last = curve.parameters[[0, -1]]
    expected = curve(np.linspace(first, last, 57))
    atol = 1e-12 * np.abs(curve.points).max()
    np.testing.assert_allclose(curve.sample(57), expected, atol=atol)
    np.testing.assert_array_equal(curve.sample(57), curve.sample(57, by="parameter"))


@pytest.mark.parametrize("case", ALL, ids=str)
def test_sample_by_arc_length_is_even(case):
    curve = case.fit()
    size = curve.arc_length()
    samples = curve.sample(4001, by="arc-length")
    assert samples.shape == (4001, case.points.shape[1])
    atol = 1e-12 * np.abs(curve.points).max()
    np.testing.assert_allclose(samples[[0, -1]], curve.points[[0, -1]], atol=atol)
    # A chord is never longer than its arc, and all arcs are equal: to the accuracy of the search
    # for each sample. 4000 chords miss little of a smooth curve.
    chords = np.linalg.norm(np.diff(samples, axis=0), axis=-1)
    assert chords.max() <= size / 4000 * (1 + 1e-4)
    assert chords.sum() >= size * (1 - 1e-3)


def test_planar_curves_stay_planar(rng):
    curve = ss.NuSpline(polygons.random_walk(rng, 9, 2), boundary="circular")
    u = inside(curve)
    assert curve(u).shape == curve.curvature_vector(u).shape == (len(u), 2)
    assert curve.tangents.shape == curve.points.shape == (9, 2)
    assert curve.sample(5).shape == (5, 2)
    np.testing.assert_array_equal(curve.torsion(u), 0.0)


SPREAD = [[0, 0], [1e9, 0], [1e9, 1e-8]]


@pytest.mark.parametrize("family", cases.TENSE)
@pytest.mark.parametrize("by", ["parameter", "arc-length"])
@pytest.mark.parametrize("points", [SPREAD, SPREAD[::-1], [[0, 0], [1, 2], [3, 1]]], ids=str)
def test_samples_begin_and_end_at_the_ends(family, by, points):
    """Whatever shares of the length round to."""
    curve = family(points, "centripetal")
    for n in (2, 3, 7, 1024, 5000):
        samples = curve.sample(n, by=by)
        np.testing.assert_array_equal(samples[[0, -1]], curve(curve.parameters[[0, -1]]))
    np.testing.assert_array_equal(curve.sample(1, by=by), curve(curve.parameters[:1]))
