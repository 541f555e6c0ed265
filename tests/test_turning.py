# SPDX-License-Identifier: MIT OR Apache-2.0

"""At every point a shape-preserving curve turns as the polygon does; what stops is not regular."""

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from scale import scaled
from shape_by_sampling import of_curve

every_family = pytest.mark.parametrize("family", cases.FAMILIES, ids=lambda c: c.__name__)

#: Corners between straight runs, which shot past the point and turned the wrong way there.
CORNERS = {
    "two runs": ([[0, 0], [2, 0], [2.25, 0], [2.25, 0.25], [2.25, 0.75]], "uniform"),
    "a step": ([[0, 0], [1.8, -0.2], [2.05, -0.2], [4.05, -0.2]], "uniform"),
    "a turn": ([[0, 0], [0.2, 0.5], [-0.6, 0.7], [-1, 0.8], [-2.3, 1.2]], "chordal"),
}


@pytest.mark.parametrize("corner", CORNERS)
@every_family
def test_corners_between_straight_runs(family, corner):
    points, parameters = CORNERS[corner]
    curve = cases.preserving(family)(points, parameters)
    assert of_curve(curve).violations == []
    assert curve.check().ok
    assert ss.polygon_shape(points).counts()["turning"] >= 2


@pytest.mark.parametrize("corner", CORNERS)
def test_the_papers_criteria_do_not_see_them(corner):
    points, parameters = CORNERS[corner]
    if corner == "a step":
        # The search finds one that turns well whatever it is asked for.
        curve = ss.NuSpline(points, parameters, tension=[0, 4, 2, 0])
        assert curve.check(cases.PAPERS).ok
    else:
        curve = ss.NuSpline.shape_preserving(points, parameters, criteria=cases.PAPERS)
    assert {name for name, _ in of_curve(curve).violations} == {"turning"}
    report = curve.check("turning")
    assert not report.ok
    assert all(-1 <= v.margin <= 0 and v.location in curve.parameters for v in report.violations)
    for form in (curve.to_bspline(), curve.to_ppoly()):
        assert not ss.check_shape(points, form, parameters=curve.parameters).ok


def runs(rng, dim):
    """Return straight runs that meet at any angle, steps on a lattice, or of few directions."""
    kind = rng.integers(3)
    if kind == 0:
        directions = np.repeat(rng.normal(size=(6, dim)), rng.integers(1, 4, 6), axis=0)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return np.cumsum(
            directions * rng.choice([0.25, 1.0, 4.0], len(directions))[:, None], axis=0
        )
    if kind == 1:
        return polygons.lattice_walk(rng, int(rng.integers(4, 14)), dim)
    few = rng.normal(size=(3, dim))
    return np.cumsum(few[rng.integers(3, size=10)] * rng.choice([0.5, 1.0, 2.0], (10, 1)), axis=0)


@pytest.mark.parametrize("parameters", ["uniform", "chordal", "centripetal"])
@every_family
def test_no_curve_turns_the_wrong_way(family, parameters, rng):
    given = unsolved = 0
    for number in range(scaled(600, 10 if family in cases.TENSE else 30)):
        points = runs(rng, 2 + number % 2)
        boundary = ["natural", "circular", "periodic", None][number // 2 % 4]
        if boundary == "periodic":
            points = polygons.close(points) if np.any(points[0] != points[-1]) else points
        elif boundary is None:
            boundary = ss.Tangents(*rng.normal(size=(2, points.shape[1])))
        given += isinstance(boundary, ss.Tangents)
        try:
            curve = cases.preserving(family)(points, parameters, boundary=boundary)
        except ss.ConvergenceError:
            # Known (limits.md): end tangents at random, across straight runs.
            assert family is ss.FairSpline, number
            assert isinstance(boundary, ss.Tangents), number
            unsolved += 1
            continue
        assert of_curve(curve).violations == [], number
    assert unsolved <= given // 50


@every_family
def test_points_that_double_back_have_no_regular_curve(family):
    """Speed 0 at every point, no curvature: not ok; the right place in every form of the curve."""
    points = [[0, 0], [1, 0], [0, 0]]
    curve = family(points, boundary="periodic")
    assert np.all(curve.tangents == 0)
    # A fair curve is always one of a fit, of which this is asked by name only.
    everything = ["regular", *cases.PAPERS, "turning"]
    report = curve.check() if family in cases.TENSE else curve.check(everything)
    assert not report.ok
    assert [(v.criterion, v.segment) for v in report.violations] == [("regular", 0), ("regular", 1)]
    assert report.counts()["regular"] == (2, 2)
    assert "regular" in str(report)
    assert {r.criterion for r in report.segments} == set(report.counts())
    for form in (curve.to_ppoly(), curve.to_bspline()):
        assert not ss.check_shape(points, form, parameters=curve.parameters).ok
    # Asked for by name, no fit returns such a curve; else it may stop where the points double back.
    assert cases.preserving(family)(points, boundary="periodic").check().ok
    with pytest.raises(ss.ConvergenceError, match="regular on 2"):
        cases.preserving(family)(points, boundary="periodic", criteria=["regular", "turning"])


def test_a_regular_curve_lists_the_criterion_where_it_is_asked_for_by_name(rng):
    curve = ss.NuSpline(polygons.random_walk(rng, 12))
    assert "regular" not in curve.check().counts()
    report = curve.check(["regular"])
    assert report.ok
    assert list(report.counts()) == ["regular"]
    assert all(0 < r.margin <= 1 for r in report.segments if r.applicable)
