# SPDX-License-Identifier: MIT OR Apache-2.0

"""No violation on any data: checked by sampling, which shares no code with the solver."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cases
import polygons
import shapespline as ss
from scale import LONG, scaled
from shape_by_sampling import of_curve, shape_by_sampling

# Polygons a family and kind of end: with 13 families and 4 ends some thousands in all.
POLYGONS = 60


#: Turns of 1e-9, chords that differ by 1e6: rounding may hide a sign of a fair curve there, which
#: its check says; and where end tangents lead across such data none may be found (limits.md).
HARD = ("near collinear", "planar near collinear", "uneven chords")


def count_of(curve_class, count):
    """Return of how many polygons a family fits: a fair curve takes some 100 times as long."""
    return count if curve_class in cases.TENSE else scaled(count // 6)


def assert_shape(curve, **options):
    """Check by sampling, and that the library's own exact verdict is the same."""
    assert np.isfinite(curve.tangents).all()
    assert np.all(cases.tension_of(curve) >= 0)
    assert np.isfinite(cases.tension_of(curve)).all()
    assert of_curve(curve, **options).violations == []
    assert curve.check().ok


SHARED = cases.of_every_family([*cases.shared(), *cases.small()])
every_family = pytest.mark.parametrize("curve_class", cases.FAMILIES, ids=lambda c: c.__name__)


@pytest.mark.parametrize("strategy", ["growth", "fairest"])
@pytest.mark.parametrize("case", SHARED, ids=str)
def test_shared_data(case, strategy):
    assert_shape(case.preserve(strategy=strategy))


@pytest.mark.parametrize("case", cases.shared(), ids=str)
def test_the_plain_cubic_does_break_the_shape_of_the_shared_data(case):
    """Otherwise the test above would show nothing."""
    assert of_curve(case.fit()).violations


def ended(points, end, rng):
    """Return points and boundary for a kind of end; ``None`` where it needs more points."""
    if end == "periodic":
        if np.array_equal(points[0], points[-1]):
            points = points[:-1]
        points = polygons.close(points)
    if end == "tangents":
        dim = points.shape[1]
        return points, ss.Tangents(rng.normal(size=dim), rng.normal(size=dim))
    if len(points) < 3 and end in ("periodic", "circular"):
        return None
    return points, end


@pytest.mark.parametrize("end", ["zero-curvature", "periodic", "circular", "tangents"])
@pytest.mark.parametrize("family", polygons.FAMILIES)
@every_family
def test_generated_polygons(curve_class, family, end):
    rng = np.random.default_rng([len(family), len(end)])
    for number in range(count_of(curve_class, POLYGONS)):
        points = polygons.FAMILIES[family](rng, int(rng.integers(4, 40)))
        if (case := ended(points, end, rng)) is None:
            continue
        points, boundary = case
        hard = curve_class is ss.FairSpline and family in HARD
        try:
            curve = cases.preserving(curve_class)(points, boundary=boundary)
        except ss.ConvergenceError:
            if not (hard and end == "tangents"):
                raise
            continue
        found = of_curve(curve)
        hidden = {(u.criterion, u.segment) for u in curve.check().undecided} if hard else set()
        assert set(found.violations) <= hidden, f"polygon {number}"
        assert curve.check().ok, f"polygon {number}"
        np.testing.assert_array_equal(curve.points, points)


@pytest.mark.parametrize("parameters", ["uniform", "centripetal", 0.75])
@pytest.mark.parametrize("family", ["random walk", "uneven chords", "lattice walk"])
@every_family
def test_other_parametrisations(curve_class, family, parameters):
    rng = np.random.default_rng(11)
    for _ in range(count_of(curve_class, POLYGONS // 4)):
        points = polygons.FAMILIES[family](rng, 20)
        assert_shape(cases.preserving(curve_class)(points, parameters))


@given(st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=2, max_size=9))
def test_any_lattice_polygon_is_fitted_or_refused_for_the_one_reason(points):
    """Small integers: exactly straight, flat, perpendicular and reversed pieces all the time."""
    repeated = any(a == b for a, b in pairwise(points))
    if repeated:
        with pytest.raises(ValueError, match="points"):
            ss.NuSpline.shape_preserving(points)
    else:
        for curve_class in cases.FAMILIES:
            assert_shape(cases.preserving(curve_class)(points))


@every_family
@pytest.mark.parametrize("end", ["start", "end"])
def test_a_plane_that_only_an_end_tangent_leaves(curve_class, end):
    """Then coplanarity is a question everywhere; the last segment was not looked at."""
    points = [[1, 0], [0, 0], [0, 2], [-1, 2], [-1, 1], [-2, 1], [-2, 3], [-1, 3], [-1, 4]]
    points = np.c_[points, np.zeros(len(points))]
    boundary = ss.Tangents(**{end: [-0.5, 1.0, -0.4]})
    curve = cases.preserving(curve_class)(points, boundary=boundary)
    assert_shape(curve)
    asked = {r.segment for r in curve.check("coplanarity").segments if r.applicable}
    assert asked == set(np.flatnonzero(of_curve(curve).applicable["coplanarity"]))
    assert len(asked) > 2


@every_family
def test_exact_reversal_on_a_line(curve_class):
    """A turn by 180° requires nothing: the plain cubic must be returned, with zero tension."""
    points = np.array([[0.0, 0, 0], [2, 0, 0], [1, 0, 0], [4, 0, 0]])
    curve = cases.preserving(curve_class)(points)
    np.testing.assert_array_equal(cases.tension_of(curve), 0.0)
    np.testing.assert_array_equal(curve(np.linspace(*curve.parameters[[0, -1]], 50))[:, 1:], 0.0)


def test_data_that_need_no_tension_get_none(rng):
    theta = np.linspace(0, 5, 40)
    arc = np.column_stack([np.cos(theta), np.sin(theta)])
    for strategy in cases.STRATEGIES:
        curve = ss.NuSpline.shape_preserving(arc, boundary="circular", strategy=strategy)
        np.testing.assert_array_equal(curve.tension, 0.0)
        assert curve.diagnostics.iterations == 1


@pytest.mark.parametrize("criterion", ["convexity", "inflection", "torsion", "coplanarity"])
def test_only_the_criteria_asked_for_are_met_and_reported(criterion):
    case = cases.space_set("gps_mojstrovka", "zero-curvature")
    curve = case.preserve(criteria=[criterion], strategy="growth")
    found = of_curve(curve)
    assert not found.violated[criterion].any()
    assert {r.criterion for r in curve.check(criteria=[criterion]).segments} == {criterion}


def test_tighter_tolerances_are_kept():
    case = cases.helix()
    curve = case.preserve(coplanarity=0.02, collinearity=0.02)
    assert_shape(curve, coplanarity_sine=0.02, collinearity_sine=0.02)
    assert curve.check(coplanarity=0.02, collinearity=0.02).ok
    # The loose fit does not satisfy the tight tolerance, or the test would show nothing.
    assert not case.preserve().check(coplanarity=0.02).ok


def test_violations_that_travel_inwards_need_no_limit_and_few_rounds():
    """Both ended after 200 rounds, n/8 of which are needed one by one."""
    zigzag = np.array([[-1.0, 0, -1], [0, -1, -1], [1, 1, 0]])[np.arange(2000) % 3].cumsum(axis=0)
    i = np.arange(1562)
    lattice = np.column_stack([i, i % 2, i // 2 % 2])
    for points, parameters in [(zigzag, "chordal"), (lattice, "uniform")]:
        curve = ss.NuSpline.shape_preserving(points, parameters)
        assert_shape(curve)
        assert curve.diagnostics.iterations < 60
        with pytest.raises(ss.ConvergenceError, match="raise max_iterations") as caught:
            ss.NuSpline.shape_preserving(points, parameters, max_iterations=1)
        diagnostics = caught.value.curve.diagnostics
        assert (diagnostics.status, diagnostics.iterations) == ("iteration-limit", 1)


def test_where_tension_can_rise_no_further_the_search_ends():
    """Parameters so uneven that no digits are left (limits.md): what rounding hides is reported."""
    points = np.random.default_rng(0).normal(size=(8, 3)).cumsum(axis=0)
    parameters = np.cumsum([0, 1, 1e9, 1, 1, 1, 1, 1])
    curve = ss.NuSpline.shape_preserving(points, parameters)
    assert curve.diagnostics.status == "solved"
    assert curve.diagnostics.iterations <= 250
    report = curve.check()
    assert report.ok
    assert report.undecided
    with pytest.raises(ss.ConvergenceError, match='use strategy="fairest"') as caught:
        ss.NuSpline.shape_preserving(points, parameters, strategy="nussp")
    diagnostics = caught.value.curve.diagnostics
    assert diagnostics.status == "stalled"
    assert diagnostics.iterations <= 10_100
    assert not caught.value.report.ok


def test_a_million_points():
    """Sampled in overlapping pieces, which a criterion of four points cannot notice.

    Every piece in long runs, else some: the check of the curve itself sees them all.
    """
    count, piece = 1_000_000, 50_000
    points = polygons.gentle_track(count)
    plain = ss.NuSpline(points).check()
    assert 0 < len(plain.violations) < 0.03 * count
    curve = ss.NuSpline.shape_preserving(points)
    u = curve.parameters
    assert curve.check().ok
    for start in range(0, count - 1, piece if LONG else 7 * piece):
        part = slice(max(start - 1, 0), min(start + piece + 2, count))
        found = shape_by_sampling(
            points[part],
            u[part],
            None,
            lambda v, order, side: curve(v, order, side=side),
            count=9,
        )
        assert found.violations == [], start
    assert curve.check().ok
