"""Closed data: ends that agree to rounding."""

import numpy as np
import pytest

import cases
import shapespline as ss

every_family = pytest.mark.parametrize("family", cases.FAMILIES)


def circle(turns=1, n=9, dim=2, centre=0.0, radius=1.0):
    """Return points of a circle that closes but for rounding."""
    t = np.linspace(0, 2 * np.pi * turns, n * turns)
    z = [0.1 * np.sin(t)] if dim == 3 else []
    return centre + radius * np.column_stack([np.cos(t), np.sin(t), *z])


CIRCLES = {
    "plane": circle(),
    "space": circle(dim=3),
    "five turns": circle(turns=2),
    "off the centre": circle(centre=0.3),
    "small": circle(radius=1e-100),
    "large": circle(radius=1e100),
    "long": circle(n=20_000),
}


@every_family
@pytest.mark.parametrize("name", CIRCLES)
def test_ends_that_agree_to_rounding_close(family, name):
    points = CIRCLES[name]
    assert (points[-1] != points[0]).any()
    exact = points.copy()
    exact[-1] = exact[0]
    for make in (family, family.shape_preserving):
        curve = make(points, boundary="periodic")
        np.testing.assert_array_equal(curve.points, exact)
        np.testing.assert_array_equal(curve.bezier, make(exact, boundary="periodic").bezier)
    assert curve.check().ok
    fits = ss.fit_many(np.vstack([points, points]), [0, len(points), 2 * len(points)],
                       {v: k for k, v in METHODS.items()}[family], boundary="periodic")  # fmt: skip
    assert fits.ok
    np.testing.assert_array_equal(fits[1].points, exact)


METHODS = {"nu": ss.NuSpline, "tension": ss.TensionSpline, "catmull-rom": ss.CatmullRom}


def test_polygons_and_foreign_curves_close_as_well():
    points = CIRCLES["plane"]
    shape = ss.polygon_shape(points, boundary="periodic")
    np.testing.assert_array_equal(shape.points[-1], shape.points[0])
    curve = ss.NuSpline(points, boundary="periodic")
    report = ss.check_shape(points, curve.to_bspline(), parameters=curve.parameters)
    assert report.boundary == "periodic"
    assert report.ok


@every_family
@pytest.mark.parametrize("gap", [1e-12, 1e-9, 0.5, -1.0])
def test_ends_that_are_apart_do_not_close(family, gap):
    points = circle()
    points[-1] = points[0] + [gap, 0]
    with pytest.raises(ss.InputError, match=r"needs points\[8\] = points\[0\], got \(") as caught:
        family(points, boundary="periodic")
    assert caught.value.index == 8
    assert len(caught.value.value) == 2


@pytest.mark.parametrize("dim", [2, 3])
def test_errors_show_points_in_their_own_dimension(dim):
    repeated = np.ones((3, dim)).cumsum(axis=0)
    repeated[2] = repeated[1]
    shown = "(2, 2)" if dim == 2 else "(2, 2, 2)"
    calls = [
        *(family for family in cases.FAMILIES),
        *(family.shape_preserving for family in cases.FAMILIES),
        ss.polygon_shape,
        ss.inflection_count,
        lambda p: ss.fit_many(p, [0, 3], errors="raise"),
        lambda p: ss.check_shape(p, ss.NuSpline(np.arange(3.0)[:, None] * np.ones(dim))),
    ]
    for call in calls:
        with pytest.raises(ss.InputError) as caught:
            call(repeated)
        assert f"points[2] repeats points[1]: {shown};" in str(caught.value)
        assert caught.value.value == (2.0,) * dim
