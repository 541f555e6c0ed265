# SPDX-License-Identifier: MIT OR Apache-2.0

"""Figures show what they say: the numbers in the Axes are compared, not the pixels."""

import subprocess
import sys
from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

mpl.use("Agg")
from matplotlib import pyplot as plt

ARC = np.linspace(0, np.pi, 9)
#: on a circle of radius 2: curvature 1/2 everywhere, of the curve (nearly) and of the data
CIRCLE = 2 * np.column_stack([np.cos(ARC), np.sin(ARC)])


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def circle():
    return ss.NuSpline(CIRCLE, boundary="circular")


def line(axes, gid_or_label):
    """Return the data of the line of a label or gid."""
    (found,) = [a for a in axes.lines if gid_or_label in (a.get_label(), a.get_gid())]
    return found.get_data()


DRAWN = {
    "curve": circle,
    "curvature_comb": circle,
    "curvature": circle,
    "torsion": lambda: cases.helix().fit(),
    "criteria": lambda: cases.helix().fit().check(),
    "interpolant": lambda: ss.MonotoneQuintic([0, 1, 2, 4], [0, 1, 1, 3]),
}


@pytest.mark.parametrize("name", DRAWN)
def test_each_draws_into_the_axes_it_is_given_and_returns_them(name):
    figure, (left, right) = plt.subplots(1, 2, layout="constrained")
    assert getattr(ss.plot, name)(DRAWN[name](), ax=right) is right
    assert right.has_data()
    assert not left.has_data()
    figure.draw_without_rendering()
    assert getattr(ss.plot, name)(DRAWN[name]()).figure is not figure


def test_matplotlib_is_imported_only_when_something_is_drawn():
    code = (
        "import sys, shapespline as ss\n"
        "ss.plot.curve\n"
        "assert not [m for m in sys.modules if m.split('.')[0] in ('matplotlib', 'mpl_toolkits')]"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


# Curves


@pytest.mark.parametrize("case", [cases.gm_line(), cases.small()[7]], ids=str)
def test_the_curve_passes_through_its_drawn_points(case):
    c = case.fit()
    axes = ss.plot.curve(c, label="curve")
    drawn = (
        np.array(axes.lines[1].get_data_3d() if c.points.shape[1] == 3 else line(axes, "curve"))
    ).T
    for point in c.points:
        assert np.linalg.norm(drawn - point, axis=1).min() < 1e-9 * np.abs(c.points).max()
    assert axes.get_aspect() == ("equal" if axes.name == "3d" else 1.0)


def test_a_curve_in_space_needs_axes_in_space():
    with pytest.raises(ValueError, match="projection='3d'"):
        ss.plot.curve(cases.helix().fit(), ax=plt.figure().add_subplot())


def test_teeth_of_the_comb_point_away_from_the_centre_and_are_as_long_as_the_curvature():
    axes = ss.plot.curvature_comb(circle(), scale=3.0, samples=5)
    (comb,) = axes.collections
    foot, tip = np.swapaxes(comb.get_segments(), 0, 1)
    assert len(foot) == 8 * 5
    np.testing.assert_allclose(np.linalg.norm(foot, axis=1), 2.0, atol=2e-3)
    np.testing.assert_allclose(tip, foot * (2 + 3 * 0.5) / 2, atol=0.06)


def test_the_comb_in_space_and_of_a_straight_curve():
    c = cases.helix().fit()
    axes = ss.plot.curvature_comb(c)
    foot, tip = np.swapaxes(np.array(axes.collections[0]._segments3d), 0, 1)
    u = c.parameters[3] + (c.parameters[4] - c.parameters[3]) * np.linspace(1e-6, 1 - 1e-6, 24)
    np.testing.assert_allclose(foot[3 * 24 : 4 * 24], c(u), atol=1e-12)
    # Along −κN.
    along = tip[3 * 24 : 4 * 24] - c(u)
    angle = np.sum(along * c.curvature_vector(u), axis=1)
    assert np.all(angle < 0)
    straight = ss.plot.curvature_comb(ss.NuSpline([[0, 0], [1, 1], [2, 2]]))
    foot, tip = np.swapaxes(straight.collections[0].get_segments(), 0, 1)
    np.testing.assert_allclose(foot, tip, atol=1e-12)


def test_curvature_with_the_discrete_curvature_of_the_data():
    axes = ss.plot.curvature(circle(), label="curvature")
    _, dots = line(axes, "discrete curvature of the data")
    assert np.isnan(dots[[0, -1]]).all()
    np.testing.assert_allclose(dots[1:-1], 0.5, rtol=1e-12)
    _, kappa = line(axes, "curvature")
    np.testing.assert_allclose(kappa[np.isfinite(kappa)], 0.5, rtol=0.02)


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_discrete_curvature_of_closed_data_and_of_any_size(scale):
    t = np.linspace(0, 2 * np.pi, 13)
    points = scale * np.column_stack([np.cos(t), np.sin(t), 0 * t])
    points[-1] = points[0]
    axes = ss.plot.curvature(ss.NuSpline(points, "uniform", boundary="periodic"))
    _, dots = line(axes, "discrete curvature of the data")
    np.testing.assert_allclose(dots * scale, 1.0, rtol=1e-9)


def test_discrete_curvature_where_the_polygon_turns_back():
    axes = ss.plot.curvature(ss.NuSpline([[0, 0], [1, 0], [0, 0], [0, 2]]))
    _, dots = line(axes, "discrete curvature of the data")
    np.testing.assert_array_equal(np.isnan(dots), [True, True, False, True])


def test_torsion_shows_the_signs_of_the_data():
    c = cases.gm_line().preserve()
    axes = ss.plot.torsion(c, label="torsion")
    (steps,) = axes.patches
    bars = steps.get_data().values
    u, tau = line(axes, "torsion")
    segment = np.searchsorted(c.parameters, u[np.isfinite(tau)]) - 1
    assert np.all(tau[np.isfinite(tau)] * bars[segment] > 0)


# Reports


def test_the_map_shows_each_verdict_in_its_cell():
    report = cases.gm_line().fit().check()
    axes = report.plot()
    shades = axes.images[0].get_array()
    names = list(report.counts())
    for record in report.segments:
        shade = shades[names.index(record.criterion), record.segment]
        if not record.applicable:
            assert shade is np.ma.masked or np.isnan(shade)
        else:
            assert (shade > 0) == record.satisfied
    (marks,) = axes.collections
    crosses = marks.get_offsets()
    assert sorted(crosses[:, 0]) == sorted(v.segment for v in report.violations)
    texts = [text.get_text() for text in axes.texts]
    assert [t for t in texts if "/" in t] == [
        "1 / 19, worst -0.0014",
        "2 / 19, worst -0.0014",
        "3 / 19, worst -0.00011",
    ]
    assert sum(not t.count("/") and t != "–" for t in texts) == len(report.violations)


def test_a_long_curve_takes_few_artists():
    """Bars and meshes of 200,000 segments took ten minutes to draw."""
    c = ss.NuSpline(polygons.gentle_track(5_000))
    for axes in (ss.plot.torsion(c), c.check().plot()):
        assert len(axes.get_children()) < 40
        assert not any("Mesh" in type(child).__name__ for child in axes.get_children())


def test_the_map_of_a_long_curve_leaves_numbers_out_unless_asked():
    report = cases.space_set("gps_mojstrovka", "zero-curvature").fit().check()
    few, many = (len(ss.plot.criteria(report, numbers=n).texts) for n in (None, True))
    assert few == len(report.counts())
    assert many == few + len(report.violations)


def test_undecided_cells_have_a_colour_of_their_own(rng):
    # Quintic pieces that are straight to rounding where the points turn.
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]]) @ polygons.rotation(rng)
    control = [np.linspace(p, q, 6) for p, q in pairwise(corners)]
    report = ss.check_shape(corners, control, parameters=range(4))
    assert report.undecided
    axes = report.plot()
    amber = axes.images[1].get_array().filled(np.nan)
    names = list(report.counts())
    cells = {(names[i], k) for i, k in np.argwhere(np.isfinite(amber))}
    assert cells == {(u.criterion, u.segment) for u in report.undecided}
    legend = [t.get_text() for t in axes.get_legend().texts]
    assert f"undecided ({len(cells)})" in legend


# Functions


def rpn():
    columns = polygons.load("rpn14")
    return columns["x"], columns["y"]


def test_a_function_is_drawn_with_its_data_and_derivatives():
    f = ss.MonotoneQuintic(*rpn())
    axes = ss.plot.interpolant(f, label="f")
    panels = axes.figure.axes
    assert [a.get_ylabel() for a in panels] == ["f", "f′", "f″"]
    np.testing.assert_array_equal(line(axes, "data")[1], f.y)
    for order, panel in enumerate(panels):
        x, y = panel.lines[1 if order < 2 else 0].get_data()
        inside = np.isfinite(y)
        np.testing.assert_array_equal(y[inside], f(x[inside], order))
        assert np.diff(x[inside]).min() >= 0
    steps = line(panels[1], "data")[1]
    np.testing.assert_allclose(steps[::2], np.diff(f.y) / np.diff(f.x))


def test_a_second_function_shares_the_axes_and_the_data():
    f, g = ss.MonotoneQuintic(*rpn()), ss.MonotoneQuartic(*rpn())
    axes = ss.plot.interpolant(f)
    before = [len(a.lines) for a in axes.figure.axes]
    assert ss.plot.interpolant(g, ax=axes) is axes
    # One line more in each; the line through zero again.
    assert [len(a.lines) - n for a, n in zip(axes.figure.axes, before, strict=True)] == [1, 2, 2]


def test_many_columns_along_any_axis():
    y = np.array([[0.0, 1, 3, 4], [2, 1, 1, 0]])
    f = ss.MonotoneQuintic([0, 1, 2, 3], y, axis=1)
    axes = ss.plot.interpolant(f, derivatives=0, label="both")
    drawn = [a.get_ydata() for a in axes.lines if a.get_gid() != "data"]
    assert len(drawn) == 2
    for values, column in zip(drawn, y, strict=True):
        np.testing.assert_allclose(values[:: 60 + 1], column[:-1])


def test_derivatives_as_functions_of_their_own():
    f = ss.MonotoneQuintic(*rpn())
    slope = ss.plot.interpolant(f, nu=1, derivatives=0)
    other = ss.plot.interpolant(f.derivative(), derivatives=0)
    assert slope.get_ylabel() == "f′"
    y = [a.lines[-1].get_ydata() for a in (slope, other)]
    np.testing.assert_allclose(*y, atol=1e-12)


def test_no_room_for_derivatives_is_an_error_that_says_what_to_do():
    axes = plt.figure().add_axes((0.1, 0.1, 0.8, 0.8))
    f = ss.MonotoneQuintic(*rpn())
    with pytest.raises(ValueError, match="derivatives=0"):
        ss.plot.interpolant(f, ax=axes)
    assert ss.plot.interpolant(f, ax=axes, derivatives=0) is axes
    with pytest.raises(ValueError, match="nu must not be negative"):
        ss.plot.interpolant(f, nu=-1)
