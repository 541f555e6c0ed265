# SPDX-License-Identifier: MIT OR Apache-2.0

"""What counts as a curve: look-alikes, NURBS, pieces, and what is refused with a clear error."""

import pickle
import subprocess
import sys
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline, PPoly, make_interp_spline

import cases
import polygons
import shapespline as ss
from shapespline._cli import files

# Look-alikes


def test_an_object_that_only_looks_like_scipys():
    points = polygons.helix()
    curve = CubicSpline(np.arange(25.0), points)
    alike = SimpleNamespace(x=list(curve.x), c=curve.c.tolist())
    assert ss.check_shape(points, alike).to_dict() == ss.check_shape(points, curve).to_dict()


def test_scipy_is_not_imported():
    code = (
        "import sys, shapespline as ss; from types import SimpleNamespace as N;"
        "ss.check_shape([[0, 0], [1, 1]], N(x=[0, 1], c=[[[1, 1]], [[0, 0]]]));"
        "assert not {'scipy', 'matplotlib', 'pandas'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


# NURBS


def quarter_circles(order=(0, 1, 2, 3, 4)):
    """Return a circle of rational parabolas with its corner points."""
    angle = np.pi / 2 * np.array(order)
    points = np.column_stack([np.cos(angle), np.sin(angle)]).round(15)
    control = [
        [points[i], points[i] + points[i + 1], points[i + 1]] for i in range(len(points) - 1)
    ]
    weights = np.tile([1, 0.5**0.5, 1], (len(control), 1))
    return points, ss.PiecewiseBezier(control, range(len(points)), weights=weights)


def test_a_circle_keeps_the_shape_of_a_square():
    points, circle = quarter_circles()
    assert np.allclose(np.linalg.norm(circle(np.linspace(0, 4, 99)), axis=1), 1, atol=1e-15)
    points[-1] = points[0]
    report = ss.check_shape(points, circle)
    assert report.ok
    assert report.boundary == "periodic"
    assert report.counts()["convexity"] == (0, 4)
    assert ss.inflection_count(circle) == 0


def test_weights_are_not_ignored():
    """One weight moves the curve from convex to not: a heavy point inside."""
    points = np.array([[0.0, 0], [1, 1.0], [3, 1.0], [4, 0]])
    control = [
        [points[0], [0.5, 0.8], points[1]],
        [points[1], [1.4, 1.5], [2.0, 0.9], [2.6, 1.5], points[2]],
        [points[2], [3.5, 0.8], points[3]],
    ]
    middle = lambda w: ss.PiecewiseBezier(  # noqa: E731
        [
            [*np.linspace(points[0], points[1], 5)],
            control[1],
            [*np.linspace(points[2], points[3], 5)],
        ],
        range(4),
        weights=[[1] * 5, [1, 1, w, 1, 1], [1] * 5],
    )
    light, heavy = (ss.check_shape(points, middle(w), criteria="convexity") for w in (0.01, 50.0))
    assert light.ok
    assert [(v.criterion, v.segment) for v in heavy.violations] == [("convexity", 1)]


@pytest.mark.parametrize("weight", [1e-310, 1e-3, 0.1, 1.0, 3.0, 1e308])
@pytest.mark.parametrize("dim", [2, 3])
def test_equal_weights_divide_out(weight, dim, rng):
    """The curve is polynomial then, to the last bit: nothing that it decides stays undecided."""
    control = rng.normal(size=(30, 4, dim)).cumsum(axis=0)
    control[1:, 0] = control[:-1, -1]
    points = np.vstack([control[:, 0], control[-1:, -1]])
    plain = ss.PiecewiseBezier(control, range(31))
    equal = ss.PiecewiseBezier(control, range(31), weights=np.full((30, 4), weight))
    assert equal.weights is None
    np.testing.assert_array_equal(equal.control, plain.control)
    own, other = (ss.check_shape(points, curve).to_dict() for curve in (plain, equal))
    assert own == other
    knots, poles = [0, 0, 0, 0, 1, 2, 2, 2, 2], rng.normal(size=(5, dim))
    plain = ss.PiecewiseBezier.from_bspline(knots, poles, 3)
    equal = ss.PiecewiseBezier.from_bspline(knots, poles, 3, weights=[weight] * 5)
    assert equal.weights is None
    np.testing.assert_array_equal(equal.control, plain.control)


@pytest.mark.parametrize("scale", [1e-310, 1e-200, 1e-60, 1e60, 1e200, 1e306])
def test_only_ratios_of_weights_count(scale, rng):
    control, weights = rng.normal(size=(7, 5, 3)), rng.uniform(1, 9, (7, 5))
    plain = ss.PiecewiseBezier(control, range(8), weights=weights)
    scaled = ss.PiecewiseBezier(control, range(8), weights=weights * scale)
    u = np.linspace(0, 7, 99)
    # Subnormal weights come in with few digits.
    np.testing.assert_allclose(scaled(u), plain(u), rtol=0, atol=1e-2 if scale < 1e-300 else 1e-13)
    assert np.isfinite(scaled.control).all()


def test_weights_without_effect_are_refused():
    with pytest.raises(ss.InputError, match="at least 1e-100 times the largest") as caught:
        ss.PiecewiseBezier([[[0, 0], [1, 1], [2, 0]]], [0, 1], weights=[[1, 1e-320, 1]])
    assert (caught.value.argument, caught.value.index) == ("weights", 1)


def test_a_nurbs_curve_by_its_knots():
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    points, circle = quarter_circles()
    control = np.vstack([[p, p + q] for p, q in pairwise(points)])
    control = np.vstack([control, points[-1:]])
    weights = np.r_[np.tile([1, 0.5**0.5], 4), 1]
    nurbs = ss.PiecewiseBezier.from_bspline(knots, control, 2, weights=weights)
    u = np.linspace(0, 4, 57)
    np.testing.assert_allclose(nurbs(u), circle(u), atol=1e-14)
    np.testing.assert_array_equal(nurbs.breaks, circle.breaks)
    assert nurbs.degree == 2
    np.testing.assert_allclose(nurbs.weights, circle.weights)


def test_control_points_with_a_weight_column_are_refused():
    points = np.array([[0.0, 0], [1, 1]])
    control = np.array([[[0, 0, 1], [0.5, 0.2, 1], [1, 1, 1]]])
    with pytest.raises(ValueError, match="PiecewiseBezier"):
        ss.check_shape(points, control, parameters=[0, 1])


def test_a_piecewise_curve_as_an_object():
    _, circle = quarter_circles()
    again = pickle.loads(pickle.dumps(circle))
    u = np.linspace(-0.5, 4.5, 33)
    np.testing.assert_array_equal(again(u), circle(u))
    np.testing.assert_array_equal(again.weights, circle.weights)
    assert circle(0.5).shape == (2,)
    assert circle(np.zeros((3, 2))).shape == (3, 2, 2)
    with pytest.raises(AttributeError):
        circle.degree = 3


# Bad input

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 1]])
U = np.arange(5.0)
CUBIC = CubicSpline(U, POINTS)


def test_a_curve_that_misses_a_point_is_not_judged():
    moved = POINTS.copy()
    moved[2] += [0, 0, 1e-3]
    moved[3] += [0, 1, 0]
    with pytest.raises(ValueError, match=r"points\[2\].*parameter 2.* (1|9\.99\d*)e-"):
        ss.check_shape(moved, CUBIC)
    assert ss.check_shape(moved[:3], CUBIC, parameters=U[:3], tolerance=1e-2)


@pytest.mark.parametrize(
    ("points", "curve", "options", "message"),
    [
        (POINTS[:, :2], CUBIC, {}, "points have 2 coordinates, the curve has 3"),
        (POINTS, CUBIC, {"parameters": U[:4]}, "parameters must have length 5"),
        (POINTS, CUBIC, {"parameters": U + 1}, r"parameters\[4\] = 5 lies outside .* \[0, 4\]"),
        (POINTS, CUBIC, {"parameters": [0, 1, 1, 2, 3]}, r"parameters\[2\] = 1 does not exceed"),
        (POINTS, CUBIC, {"parameters": [0, 1, np.nan, 2, 3]}, r"parameters\[2\] must be finite"),
        (np.where(POINTS == 2, np.nan, POINTS), CUBIC, {}, r"points\[4\] must be finite, got NaN"),
        (POINTS[[0, 0, 1]], CUBIC, {"parameters": [0, 1, 2]}, r"points\[1\] repeats points\[0\]"),
        (POINTS[:1], CUBIC, {"parameters": [0]}, "at least 2 points"),
        (POINTS[:, 0], CUBIC, {}, r"points must have shape"),
        (POINTS, CUBIC, {"criteria": "smoothness"}, "criteria must be one of .*global-convexity"),
        (POINTS, CUBIC, {"tolerance": 1.0}, r"tolerance must be in \[0, 1\)"),
        (POINTS, CUBIC, {"coplanarity": 0.0}, r"coplanarity must be a sine in \(0, 1\]"),
        (POINTS, CUBIC, {"boundary": "periodic"}, r"needs points\[4\] = points\[0\]"),
        (POINTS, CUBIC, {"boundary": "free"}, "boundary must be one of"),
        (
            POINTS,
            np.zeros((3, 4, 3)),
            {"parameters": U},
            "one piece between two points: 4 for 5 points, got 3",
        ),
        (POINTS, np.zeros((4, 4)), {"parameters": U}, r"shape \(segments, degree \+ 1, dim\)"),
        (POINTS, np.zeros((4, 1, 3)), {"parameters": U}, "degree must be between 1 and 18"),
        (POINTS, np.zeros((4, 4, 3)), {"parameters": U}, r"does not pass through points\[1\]"),
        (
            POINTS,
            np.full((4, 4, 3), np.inf),
            {"parameters": U},
            r"control\[0, 0, 0\] must be finite",
        ),
        (POINTS, PPoly(np.ones((4, 4, 5)), U), {}, "curve.c must belong to a curve"),
        (POINTS, PPoly(np.ones((1, 4, 3)), U), {}, "degree must be between 1 and 18"),
        (POINTS, SimpleNamespace(x=U[::-1], c=CUBIC.c), {}, "breaks must be strictly increasing"),
        (POINTS, SimpleNamespace(x=U[:3], c=CUBIC.c), {}, "breaks must have length 5"),
        (POINTS, SimpleNamespace(t=U, c=POINTS, k=3), {}, "knots must have length"),
    ],
)
def test_what_does_not_belong_together(points, curve, options, message):
    with pytest.raises(ValueError, match=message):
        ss.check_shape(points, curve, **options)


@pytest.mark.parametrize(
    ("points", "curve"),
    [
        (POINTS, None),
        (POINTS, lambda u: POINTS[0]),
        (POINTS, "CubicSpline"),
        (POINTS, 3),
        (POINTS, PPoly(CUBIC.c * 1j, U)),
        (POINTS, BSpline(np.r_[[0] * 4, 1, [2] * 4].astype(float), np.ones((5, 3)) * 1j, 3)),
    ],
    ids=["None", "function", "text", "number", "complex PPoly", "complex BSpline"],
)
def test_what_is_no_curve(points, curve):
    with pytest.raises(TypeError, match=r"curve must be|real numbers"):
        ss.check_shape(points, curve)


def test_a_curve_that_jumps():
    control = np.zeros((2, 2, 2))
    control[0] = [[0, 0], [1, 0]]
    control[1] = [[1, 1], [2, 0]]
    curve = ss.PiecewiseBezier(control, [0, 1, 2])
    with pytest.raises(ValueError, match="jumps by 1e0 at parameter 1"):
        ss.check_shape([[0, 0], [2, 0]], curve, parameters=[0, 2])


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (([[[0, 0], [1, 1]]], [0, 1]), {"weights": [[1, 0]]}, r"weights\[1\] must be positive"),
        (([[[0, 0], [1, 1]]], [0, 1]), {"weights": [1, 1]}, r"weights must have shape \(1, 2\)"),
        (([[[0, 0], [1, 1]]], [0, 1, 2]), {}, "breaks must have length 2"),
        (([[[0, 0], [1, 1]]], [0, np.inf]), {}, r"breaks\[1\] must be finite, got inf"),
        (([[0, 0], [1, 1]], [0, 1]), {}, r"control must have shape \(pieces, degree \+ 1, dim\)"),
        ((np.zeros((1, 20, 2)), [0, 1]), {}, "degree must be between 1 and 18, got 19"),
        ((np.zeros((0, 2, 2)), [0]), {}, "breaks must hold at least 2"),
    ],
)
def test_pieces_that_make_no_curve(arguments, options, message):
    with pytest.raises(ValueError, match=message):
        ss.PiecewiseBezier(*arguments, **options)


@pytest.mark.parametrize(
    "points",
    [
        [[0, 0, 0], [1, 1, 1], [2, 2, 2], [4, 4, 4]],  # on a line
        [[0, 0, 0], [1, 0, 0], [2, 1, 0], [3, 1, 0], [4, 3, 0]],  # in a plane
        [[0, 0, 0], [1, 0, 0]],
        [[0, 0], [1, 0], [0, 0], [1, 0]],  # doubling back
    ],
)
def test_degenerate_points_make_a_report(points):
    points = np.array(points, dtype=float)
    u = np.arange(float(len(points)))
    report = ss.check_shape(points, make_interp_spline(u, points, k=1), parameters=u)
    assert report.counts()["torsion"][1] == 0
    assert isinstance(str(report), str)


# Our other families


@pytest.mark.parametrize("family", [ss.TensionSpline, ss.CatmullRom, ss.FairSpline])
def test_our_other_families(family, tmp_path):
    points = polygons.load_points("protein_1a8o_ca")
    curve = family(points)
    own = curve.check()
    assert ss.check_shape(points, curve).to_dict() == own.to_dict()
    # Every third point: another polygon, the same pieces.
    report = ss.check_shape(points[::3], curve, parameters=curve.parameters[::3])
    assert report.counts()["torsion"][1] == 21
    assert all(record.location in curve.parameters for record in own.nodes)
    files.write_curve(tmp_path / "c.json", curve)
    again = files.read_curve(tmp_path / "c.json")
    found = ss.check_shape(
        points, again.curve, parameters=again.parameters, boundary=again.boundary
    )
    assert found.counts() == own.counts()
    text = (tmp_path / "c.json").read_text(encoding="utf-8")
    assert f'"{cases.METHODS[family]}"' in text


def test_a_tension_spline_is_judged_at_its_points_only():
    """Between them its parameter is that of no polynomial."""
    curve = ss.TensionSpline(POINTS, tangent_scale=0.5)
    u = curve.parameters.copy()
    u[2] += 0.1
    with pytest.raises(ValueError, match=r"parameters\[2\] = .* TensionSpline"):
        ss.check_shape(curve(u), curve, parameters=u)
