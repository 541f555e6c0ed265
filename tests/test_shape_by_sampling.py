# SPDX-License-Identifier: MIT OR Apache-2.0

"""The sampling checker itself, on curves whose shape is known."""

import numpy as np
import pytest

import polygons
from shape_by_sampling import data_polygon, separating_point, shape_by_sampling


def helix_derivative(u, order, side, handed=1.0):
    """Return derivatives of (cos u, sin u, ±u)."""
    angle = u + order * np.pi / 2
    rise = handed * (1.0 if order == 1 else 0.0)
    return np.stack([np.cos(angle), np.sin(angle), np.full_like(u, rise)], axis=-1)


HELIX_U = np.arange(25) * np.pi / 3
HELIX_ENDS = (helix_derivative(0.0, 1, ""), helix_derivative(HELIX_U[-1], 1, ""))


def test_a_helix_keeps_the_shape_of_its_points():
    found = shape_by_sampling(polygons.helix(), HELIX_U, HELIX_ENDS, helix_derivative)
    assert found.violations == []
    assert found.applicable["convexity"].all()
    assert found.applicable["torsion"].all()


def test_a_helix_of_the_other_hand_has_the_wrong_torsion_everywhere():
    found = shape_by_sampling(
        polygons.helix(), HELIX_U, HELIX_ENDS, lambda u, n, side: helix_derivative(u, n, side, -1.0)
    )
    assert found.violated["torsion"].all()


def arc(u, order, side, turn=1.0):
    """Return derivatives of the circle (sin u, -cos u), its acceleration multiplied by turn."""
    angle = u + (order - 1) * np.pi / 2
    value = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return value * (turn if order == 2 else 1.0)


def test_an_arc_keeps_convexity_and_its_mirror_image_does_not():
    u = np.linspace(0.0, 4.0, 9)
    points = np.stack([np.sin(u), -np.cos(u)], axis=-1)
    assert shape_by_sampling(points, u, None, arc).violations == []
    mirrored = shape_by_sampling(points, u, None, lambda u, n, side: arc(u, n, side, -1.0))
    # Zero curvature: the end segments require nothing but at their inner ends.
    convexity = [("convexity", i) for i in range(1, 7)]
    assert mirrored.violations == convexity + [("turning", i) for i in range(8)]


def test_one_wrong_segment_is_named():
    u = np.linspace(0.0, 4.0, 9)
    points = np.stack([np.sin(u), -np.cos(u)], axis=-1)

    def dented(t, order, side):
        value = arc(t, order, side)
        inside = (t > u[3]) & (t < u[4]) & (order == 2)
        return np.where(inside[..., None], -value, value)

    assert shape_by_sampling(points, u, None, dented).violations == [("convexity", 3)]


@pytest.mark.parametrize(("angle", "bad"), [(0.0, False), (0.15, False), (0.25, True)])
def test_collinearity_is_measured_against_its_sine(angle, bad):
    points = np.outer(np.arange(6.0), [1.0, 2.0, 2.0])
    u = np.arange(6.0)
    side_way = np.array([0.0, 1.0, -1.0]) / np.sqrt(2)
    direction = np.cos(angle) * np.array([1.0, 2.0, 2.0]) / 3 + np.sin(angle) * side_way

    def straight(t, order, side):
        return np.ones((*t.shape, 1)) * direction * (order == 1)

    found = shape_by_sampling(points, u, None, straight)
    assert found.applicable["collinearity"].all()
    assert not found.applicable["convexity"].any()
    assert found.violated["collinearity"].all() == bad
    assert found.violated["collinearity"].any() == bad


def test_a_turn_by_180_degrees_calls_for_nothing():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0], [2, 0, 0], [2, 1, 1]])
    polygon = data_polygon(points, np.arange(5.0), None)
    assert polygon.straight.tolist() == [False, True, False, False, False]
    assert not np.any(polygon.turning)


# Four points of a plane z = 0 in the middle of a polygon that leaves the plane at both ends.
FLAT_CONVEX = np.array([[0.0, 0, 3], [-1, 1, 0], [0, 0, 0], [1, 0, 0], [2, 1, 0], [1, 2, 4]])
FLAT_INFLECTING = np.array([[0.0, 0, 3], [-1, 1, 0], [0, 0, 0], [1, 0, 0], [2, -1, 0], [1, 2, 4]])


def bent_in_plane(lean, cubic):
    """Return derivatives of a parabola or cubic in t = u - 2.5, its plane leaning by an angle."""
    plane = np.array([[1.0, 0, 0], [0, np.cos(lean), np.sin(lean)]])

    def derivative(u, order, side):
        t = u - 2.5
        if cubic:
            y = {1: -3 * t**2, 2: -6 * t, 3: -6 + 0 * t}[order]
        else:
            y = {1: 2 * t, 2: 2 + 0 * t, 3: 0 * t}[order]
        x = np.full_like(t, 1.0 if order == 1 else 0.0)
        return np.stack([x, y], axis=-1) @ plane

    return derivative


@pytest.mark.parametrize("lean", [0.0, 0.15, 0.25])
@pytest.mark.parametrize("points", [FLAT_CONVEX, FLAT_INFLECTING])
def test_coplanarity_is_measured_against_its_sine(points, lean):
    cubic = points is FLAT_INFLECTING
    found = shape_by_sampling(points, np.arange(6.0), None, bent_in_plane(lean, cubic))
    assert found.applicable["coplanarity"].tolist() == [False, False, True, False, False]
    assert found.violated["coplanarity"][2] == (lean > 0.2)
    kind = "inflection" if cubic else "convexity"
    assert found.applicable[kind][2]
    assert not found.violated[kind][2]


def test_inflection_wants_the_turns_in_the_polygons_order():
    wrong = bent_in_plane(0.0, True)
    found = shape_by_sampling(
        FLAT_INFLECTING * [1, -1, 1], np.arange(6.0), None, lambda u, n, side: wrong(u, n, side)
    )
    assert found.violated["inflection"][2]


def test_planar_data_are_not_asked_for_coplanarity():
    found = shape_by_sampling(
        FLAT_CONVEX[1:5, :2], np.arange(1.0, 5.0), None, bent_in_plane(0.5, False)
    )
    assert not found.applicable["coplanarity"].any()


def test_the_separating_point_of_a_symmetric_segment_is_its_middle():
    polygon = data_polygon(FLAT_INFLECTING[1:5], np.arange(4.0), None)
    assert separating_point(polygon)[1] == pytest.approx(0.5)


def test_rounding_is_not_a_violation():
    """A torsion of zero to rounding, of either sign, is not held against the curve."""
    points = polygons.helix()
    rng = np.random.default_rng(0)

    def planar_with_noise(u, order, side):
        value = helix_derivative(u, order, side)
        value[..., 2] = 1e-16 * rng.normal(size=u.shape)
        return value

    found = shape_by_sampling(points, HELIX_U, HELIX_ENDS, planar_with_noise)
    assert not found.violated["torsion"].any()


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_scale_does_not_matter(scale):
    found = shape_by_sampling(
        scale * polygons.helix(),
        HELIX_U,
        tuple(scale * np.array(v) for v in HELIX_ENDS),
        lambda u, n, side: scale * helix_derivative(u, n, side, -1.0),
    )
    assert found.violated["torsion"].all()
