# SPDX-License-Identifier: MIT OR Apache-2.0

"""Inflection counts: the examples of the paper, theorems, and counts found by sampling."""

import os
import pickle
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BPoly, CubicSpline, make_interp_spline

import cases
import polygons
import shapespline as ss
import threads


def changes(values):
    """Strict sign changes of the values that are clearly not zero."""
    signs = np.sign(values[np.abs(values) > 1e-12 * np.abs(values).max(initial=0)])
    return int(np.count_nonzero(np.diff(signs)))


def seen(curve, direction, start, end, samples=4001):
    """Count by sampling ω·w on a SciPy curve."""
    u = np.linspace(start, end, samples)
    omega = np.cross(curve(u, 1), curve(u, 2))
    return changes(omega @ np.asarray(direction))


def test_is_an_int_that_knows_more():
    count = ss.inflection_count([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]])
    assert isinstance(count, int)
    assert count == 2
    assert count.exact
    assert np.linalg.norm(count.direction) == pytest.approx(1)
    assert (
        ss.inflection_count(
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]], count.direction
        )
        == count
    )
    again = pickle.loads(pickle.dumps(count))
    assert again == count
    assert again.exact == count.exact
    np.testing.assert_array_equal(again.direction, count.direction)


# Gautam, Examples 7.7 and 7.8: points, and the legs of the cubic between the middle two.

OUTER = ([-3, -3, -0.5], [2, -4, 0.5])


def example(height, first, last):
    """Return the four points, and the Bézier points of the cubic."""
    start, end = np.zeros(3), np.array([0.0, 0, height])
    points = np.array([OUTER[0], start, end, end + OUTER[1]])
    return points, np.array([start, start + first, end - last, end])


EXAMPLES = {
    "7.7": example(5, np.array([3, 1, 0.5]), np.array([2, -1, 0.5])),
    "7.8": example(10, np.array([1, 1, 0.5]), np.array([2, -3, 0.5])),
}


@pytest.mark.parametrize(
    ("name", "viewpoint", "expected"),
    [
        ("7.7", "before", 1),
        ("7.7", "after", 1),
        ("7.7", [-10, 0, 1], 0),
        ("7.8", "before", 0),
        ("7.8", "after", 0),
        ("7.8", [7.458, -1.863, -3.506], 0),
        ("7.8", [-17.458, 1.863, 23.506], 0),
        ("7.8", [-7.458, 6.863, 33.506], 2),
        ("7.8", [-7.458, 30.863, 33.506], 1),
    ],
)
def test_the_papers_viewpoints(name, viewpoint, expected):
    points, control = EXAMPLES[name]
    if isinstance(viewpoint, str):
        chords = np.diff(points, axis=0)
        viewpoint = np.cross(*(chords[:2] if viewpoint == "before" else chords[1:]))
    assert ss.inflection_count([control], viewpoint) == expected
    assert ss.inflection_count([control]) == 2
    assert ss.inflection_count(points) == 1  # Theorem 7.4


@pytest.mark.parametrize(("name", "holds"), [("7.7", False), ("7.8", True)])
def test_the_papers_examples_as_checks(name, holds):
    points, control = EXAMPLES[name]
    straight = [np.linspace(p, q, 4) for p, q in (points[:2], points[2:])]
    pieces = [straight[0], control, straight[1]]
    report = ss.check_shape(points, pieces, parameters=range(4), criteria="convexity")
    assert report.counts() == {"convexity": (int(not holds), 1)}


# Polygons


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([[0, 0], [1, 1], [2, 0], [3, 1]], 1),
        ([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], 0),
        ([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0], [5, 1]], 3),
        ([[0, 0], [1, 1], [2, 2], [3, 3]], 0),
        ([[0, 0], [1, 0]], 0),
        ([[0, 0], [1, 0], [2, 1], [3, 1], [4, 2]], 2),
    ],
)
def test_planar_polygons(points, expected):
    assert ss.inflection_count(points) == expected
    spatial = np.column_stack([points, np.zeros(len(points))])
    assert ss.inflection_count(spatial) == expected
    assert ss.inflection_count(points, [0, 0, -2]) == expected


@given(st.integers(0, 10_000), st.integers(3, 9))
def test_no_direction_shows_more_than_the_count(seed, size):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(size, 3))
    count = ss.inflection_count(points)
    assert count.exact
    assert ss.inflection_count(points, count.direction) == count
    turns = np.cross(np.diff(points, axis=0)[:-1], np.diff(points, axis=0)[1:])
    directions = rng.normal(size=(2000, 3))
    signs = np.sign(directions @ turns.T)
    assert np.count_nonzero(np.diff(signs, axis=1), axis=1).max() <= count
    assert count <= size - 3


@given(st.integers(0, 10_000))
def test_the_count_does_not_depend_on_the_coordinates(seed):
    rng = np.random.default_rng(seed)
    points = polygons.random_walk(rng, 8)
    count = ss.inflection_count(points)
    assert ss.inflection_count(points[::-1]) == count
    assert ss.inflection_count(points @ polygons.rotation(rng).T) == count
    assert ss.inflection_count(points * 1e100) == count
    assert ss.inflection_count(points * 1e-100) == count


# Curves


@given(st.integers(0, 10_000), st.integers(3, 7))
def test_a_planar_curve_never_has_more_than_its_regular_polygon(seed, degree):
    """Corollary 4.5: regular, for the chords lie in one half-plane."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-1.5, 1.5, degree) + rng.uniform(0, 7)
    chords = rng.exponential(size=(degree, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
    control = np.vstack([[0, 0], np.cumsum(chords, axis=0)])
    assert ss.inflection_count([control]) <= ss.inflection_count(control)


@given(st.integers(0, 10_000), st.integers(3, 7))
def test_along_a_direction_a_curve_never_has_more_than_its_regular_polygon(seed, degree):
    """The same of a spatial curve, whose polygon is regular as seen."""
    rng = np.random.default_rng(seed)
    chords = rng.normal(size=(degree, 3))
    chords[:, 0] = np.abs(chords[:, 0])
    control = np.vstack([np.zeros(3), np.cumsum(chords, axis=0)])
    direction = [0, *rng.normal(size=2)]
    assert ss.inflection_count([control], direction) <= ss.inflection_count(control, direction)


@given(st.integers(0, 10_000))
def test_one_spatial_cubic_has_two(seed):
    """Theorem 7.2."""
    control = np.random.default_rng(seed).normal(size=(4, 3))
    count = ss.inflection_count([control])
    assert count == 2
    assert count.exact


@given(st.integers(0, 10_000), st.integers(2, 6))
def test_agrees_with_sampling_along_a_direction(seed, degree):
    rng = np.random.default_rng(seed)
    control = rng.normal(size=(1, degree + 1, 3))
    curve = BPoly(control.swapaxes(0, 1), [0, 1])
    w = rng.normal(size=3)
    count = ss.inflection_count(control, w)
    assert count.exact
    found = seen(curve, w, 0, 1)
    # Two roots between two samples are not seen by sampling.
    assert found <= count
    assert (count - found) % 2 == 0
    assert count <= max(2 * degree - 4, 0)


def test_every_kind_of_curve():
    points = polygons.load_points("protein_1a8o_ca")[:12]
    u = np.arange(12.0)
    cubic = CubicSpline(u, points, bc_type="natural")
    own = ss.NuSpline(points, "uniform")
    w = [1.0, 2.0, -0.5]
    expected = seen(cubic, w, 0, 11)
    for curve in (cubic, own, own.bezier, own.to_bspline(), ss.PiecewiseBezier(own.bezier, u)):
        assert ss.inflection_count(curve, w) == expected
    quintic = make_interp_spline(u, points, k=5)
    assert ss.inflection_count(quintic, w) == seen(quintic, w, 0, 11)
    most = ss.inflection_count(quintic)
    assert most >= expected
    assert ss.inflection_count(quintic, most.direction) == most


@given(st.integers(0, 10_000), st.integers(4, 12))
def test_no_direction_shows_more_of_a_spline_than_the_count(seed, size):
    rng = np.random.default_rng(seed)
    u = np.arange(float(size))
    curve = CubicSpline(u, rng.normal(size=(size, 3)))
    count = ss.inflection_count(curve)
    assert count.exact
    assert ss.inflection_count(curve, count.direction) == count
    t = np.linspace(0, size - 1, 40 * size)
    omega = np.cross(curve(t, 1), curve(t, 2))
    signs = np.sign(omega @ rng.normal(size=(3, 1000)))
    assert np.count_nonzero(np.diff(signs, axis=0), axis=0).max() <= count


def long_spline(pieces):
    walk = np.cumsum(np.random.default_rng(5).normal(size=(pieces + 1, 3)), axis=0)
    return CubicSpline(np.arange(pieces + 1.0), walk)


def test_the_count_of_a_long_spline_takes_no_minutes():
    start = time.process_time()
    count = ss.inflection_count(long_spline(1000))
    assert time.process_time() - start < 30
    assert count > 300


def test_other_threads_run_meanwhile():
    curve = long_spline(500)
    threads.assert_others_run(lambda: ss.inflection_count(curve), 0.6)


@pytest.mark.skipif(os.name != "posix", reason="signals to the own process")
@pytest.mark.parametrize("kind", ["spline", "points"])
def test_ctrl_c_ends_it(kind):
    spline = long_spline(20_000)
    curve = spline if kind == "spline" else spline(spline.x)
    threads.assert_ctrl_c_ends(lambda: ss.inflection_count(curve))


def test_the_planar_cubic_by_the_ratio_four():
    """Theorem 4.6: a polygon that turns by more than π gives 0 or 2 inflections, decided at 4."""
    for size, expected in ((2.0, 2), (1.5, 0)):
        # Legs with a×b, b×c > 0 > a×c: ω has the Bernstein coefficients A, C/2, B up to a factor.
        a, b, c = size * np.array([1.0, 0]), np.array([-1.0, 0.5]), size * np.array([-1.0, -1.0])
        control = np.cumsum([[0, 0], a, b, c], axis=0)
        A, B, C = (np.linalg.det([p, q]) for p, q in ((a, b), (b, c), (a, c)))
        assert min(A, B) > 0 > C
        assert (C * C > 4 * A * B) == (expected == 2)
        assert ss.inflection_count([control]) == expected
        assert ss.inflection_count(control) == 0


def test_the_graph_of_a_function():
    x = np.linspace(0, 4 * np.pi, 40)
    assert ss.inflection_count(CubicSpline(x, np.sin(x + 0.3))) == 4


# Bad input


@pytest.mark.parametrize(
    ("curve", "options", "message"),
    [
        ([[0, 0], [0, 0], [1, 1]], {}, r"points\[1\] repeats points\[0\]"),
        ([[0, 0], [np.nan, 0], [1, 1]], {}, r"points\[1\] must be finite"),
        ([[0, 0, 0, 0]], {}, r"points must have shape"),
        ([0, 1, 2], {}, "curve must be points of shape"),
        ([[0, 0], [1, 0]], {"direction": [0, 0, 0]}, "direction must not be the zero vector"),
        ([[0, 0], [1, 0]], {"direction": [0, 1]}, "direction must have 3 components"),
        ([[0, 0], [1, 0]], {"direction": [0, 1, np.inf]}, r"direction\[2\] must be finite"),
        (np.zeros((1, 4, 5)), {}, "points of 2 or 3 coordinates"),
    ],
)
def test_bad_input(curve, options, message):
    with pytest.raises(ValueError, match=message):
        ss.inflection_count(curve, **options)


@pytest.mark.parametrize("curve", [None, "points", 3, lambda u: u])
def test_what_is_neither_points_nor_curve(curve):
    with pytest.raises(TypeError, match="curve must be"):
        ss.inflection_count(curve)


# The shape of polygons


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_polygon_shape_calls_for_what_is_checked(case):
    shape = ss.polygon_shape(case.points, case.parameters, boundary=case.boundary)
    curve = case.fit()
    asked = [set() for _ in shape.calls]
    for record in curve.check().segments:
        if record.applicable:
            asked[record.segment].add(record.criterion)
    assert [set(names) for names in shape.calls] == asked
    np.testing.assert_array_equal(shape.parameters, curve.parameters)
    np.testing.assert_array_equal(shape.chords, np.diff(case.points, axis=0))
    np.testing.assert_allclose(
        np.nan_to_num(shape.torsion),
        np.nan_to_num(curve._discrete_torsion()),
        rtol=1e-12,
        atol=1e-9,
    )
    assert sum(shape.counts().values()) == sum(map(len, shape.calls))


def test_polygon_shape_as_an_object():
    import json

    shape = ss.polygon_shape(polygons.helix())
    assert shape.extent == "space"
    assert shape.binormals.shape == (25, 3)
    assert not np.any(shape.binormals[[0, -1]])
    assert np.degrees(shape.turning_angles[1:-1]) == pytest.approx(
        np.full(23, np.degrees(shape.turning_angles[1]))
    )
    with pytest.raises(ValueError, match="read-only"):
        shape.chords[0] = 0
    with pytest.raises(AttributeError):
        shape.extent = "line"
    again = pickle.loads(pickle.dumps(shape))
    assert json.dumps(again.to_dict(), allow_nan=False) == json.dumps(shape.to_dict())
    assert not again.chords.flags.writeable
    assert len(str(shape).splitlines()) == 2 + 24
    assert str(ss.polygon_shape(polygons.random_walk(np.random.default_rng(1), 500))).endswith(
        "more"
    )


def test_polygon_shape_of_degenerate_points():
    assert ss.polygon_shape([[0, 0, 0], [1, 1, 1], [3, 3, 3]]).extent == "line"
    assert ss.polygon_shape([[0, 0, 1], [1, 1, 1], [3, 0, 1]]).extent == "plane"
    with pytest.raises(ValueError, match=r"points\[2\] repeats points\[1\]"):
        ss.polygon_shape([[0, 0], [1, 1], [1, 1]])
    with pytest.raises(ValueError, match="boundary must be one of"):
        ss.polygon_shape([[0, 0], [1, 1]], boundary="free")
