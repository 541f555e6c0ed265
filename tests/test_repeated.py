# SPDX-License-Identifier: MIT OR Apache-2.0

"""Points that repeat the one before them, and repeated times, as a GPS gives them at a halt."""

import pickle

import matplotlib as mpl
import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

mpl.use("Agg")

FITS = {method: cases.preserving(family) for family, method in cases.METHODS.items()}
every_family = pytest.mark.parametrize("family", cases.FAMILIES)
every_dimension = pytest.mark.parametrize("dim", [2, 3])
# How often each point of a walk is there: at the start, the end, alone, in runs.
RUNS = {
    "none": [1, 1, 1, 1, 1, 1, 1, 1],
    "start": [4, 1, 1, 1, 1, 1, 1, 1],
    "end": [1, 1, 1, 1, 1, 1, 1, 3],
    "middle": [1, 1, 2, 1, 1, 3, 1, 1],
    "everywhere": [2, 3, 2, 4, 2, 2, 3, 2],
}
every_run = pytest.mark.parametrize("runs", RUNS.values(), ids=RUNS)


def walk(dim=3):
    return polygons.random_walk(np.random.default_rng(12), 8, dim)


def expand(values, runs):
    return np.repeat(values, runs, axis=0)


def nodes_of(runs):
    """Return which point of the input each node is, and which segment each segment."""
    first = np.r_[0, np.cumsum(runs)[:-1]]
    return first, first[1:] - 1


def given(runs, halt=0.25):
    """Return parameters that go on while the points stand still, and those of the nodes."""
    u = np.cumsum(np.full(sum(runs), halt)) + 3 * np.repeat(np.arange(len(runs)), runs)
    return u, u[nodes_of(runs)[0]]


def in_input(record, segments):
    return dict(record, segment=int(segments[record["segment"]]))


@every_family
@every_dimension
@every_run
@pytest.mark.parametrize("parameters", ["chordal", "uniform", 0.3, "given"])
@pytest.mark.parametrize("preserving", [True, False])
def test_the_curve_is_that_of_the_points_that_stay(family, dim, runs, parameters, preserving):
    points, first, segments = walk(dim), *nodes_of(runs)
    all_, kept = given(runs) if parameters == "given" else (parameters, parameters)
    make = cases.preserving(family) if preserving else family
    expected = make(points, kept)
    curve = make(expand(points, runs), all_, repeated="drop")
    np.testing.assert_array_equal(curve.bezier, expected.bezier)
    np.testing.assert_array_equal(curve.knots, expected.knots)
    # All else refers to the input.
    dropped = tuple(np.setdiff1d(np.arange(sum(runs)), first))
    assert curve.diagnostics.dropped == dropped
    for name in ("points", "parameters", "tangents", *["tension"] * (family in cases.TENSE)):
        np.testing.assert_array_equal(getattr(curve, name), expand(getattr(expected, name), runs))
    np.testing.assert_array_equal(curve(curve.parameters), curve.points)
    own, without = curve.check().to_dict(), expected.check().to_dict()
    for part in ("segments", "violations"):
        assert own[part] == [in_input(record, segments) for record in without[part]]
    assert own["counts"] == without["counts"]
    assert [n.node for n in curve.check().nodes] == [first[n.node] for n in expected.check().nodes]
    again = pickle.loads(pickle.dumps(curve))
    assert again.diagnostics == curve.diagnostics
    np.testing.assert_array_equal(again.points, curve.points)
    assert again.check().to_dict() == own
    report = pickle.loads(pickle.dumps(curve.check()))
    assert report.to_dict() == own


@pytest.mark.parametrize("family", cases.TENSE)
@every_dimension
def test_values_of_points_refer_to_the_input(family, dim):
    runs = RUNS["everywhere"]
    points, (first, segments) = walk(dim), nodes_of(runs)
    rng = np.random.default_rng(1)
    name = "tangent_scale" if family is ss.TensionSpline else "tension"
    values = rng.uniform(0.1, 0.9, sum(runs))
    curve = family(expand(points, runs), repeated="drop", **{name: values})
    np.testing.assert_array_equal(curve.bezier, family(points, **{name: values[first]}).bezier)
    with pytest.raises(ss.InputError, match=f"{name} must have length {sum(runs)}"):
        family(expand(points, runs), repeated="drop", **{name: values[:-1]})
    # The index of a bad value is that of the input; that of a point left out is not looked at.
    bad = values.copy()
    bad[1] = -1.0
    family(expand(points, runs), repeated="drop", **{name: bad})
    bad[first[3]] = -1.0
    with pytest.raises(ss.InputError, match=rf"{name}\[{first[3]}\]") as caught:
        family(expand(points, runs), repeated="drop", **{name: bad})
    assert caught.value.index == first[3]
    if family is ss.TensionSpline:
        pair = [rng.uniform(0.1, 1, sum(runs) - 1) for _ in "ab"]
        curve = family(expand(points, runs), repeated="drop", tangent_scale=tuple(pair))
        expected = family(points, tangent_scale=tuple(side[segments] for side in pair))
        np.testing.assert_array_equal(curve.bezier, expected.bezier)
        for found, side in zip(curve.tangent_scale, pair, strict=True):
            np.testing.assert_array_equal(found[segments], side[segments])
            assert np.isnan(np.delete(found, segments)).all()
        again = family(expand(points, runs), repeated="drop", tangent_scale=curve.tangent_scale)
        np.testing.assert_array_equal(again.bezier, expected.bezier)


@every_family
def test_repeated_times_leave_the_later_point_out(family):
    """Of two places at one time the first counts; the other is still the input's."""
    points, u = walk(), np.array([0.0, 1, 1, 2, 3, 3, 3, 4])
    curve = family(points, u, repeated="drop")
    kept = [0, 1, 3, 4, 7]
    np.testing.assert_array_equal(curve.bezier, family(points[kept], u[kept]).bezier)
    assert curve.diagnostics.dropped == (2, 5, 6)
    np.testing.assert_array_equal(curve.points, points)
    np.testing.assert_array_equal(curve.parameters, u)
    with pytest.raises(ss.InputError, match=r"parameters\[3\] = 0.5 does not exceed"):
        family(points, np.r_[0, 1, 1, 0.5, 2, 3, 4, 5], repeated="drop")


@pytest.mark.parametrize("method", FITS)
@pytest.mark.parametrize("threads", [None, 2])
@pytest.mark.parametrize("parameters", [None, "given"])
def test_collections(method, threads, parameters):
    rows = [expand(walk(), runs) for runs in RUNS.values()]
    us = [given(runs)[0] for runs in RUNS.values()]
    offsets = np.r_[0, np.cumsum([len(row) for row in rows])]
    u = np.concatenate(us) if parameters else None
    options = {"method": method, "parameters": u, "threads": threads}
    fits = ss.fit_many(np.vstack(rows), offsets, repeated="drop", **options)
    assert fits.ok, fits.errors
    for k, (row, own) in enumerate(zip(rows, us, strict=True)):
        alone = FITS[method](row, *([own] if parameters else []), repeated="drop")
        np.testing.assert_array_equal(fits[k].bezier, alone.bezier)
        np.testing.assert_array_equal(fits[k].parameters, alone.parameters)
        assert fits[k].diagnostics == alone.diagnostics
    refused = ss.fit_many(np.vstack(rows), offsets, **options)
    assert sorted(refused.errors) == [1, 2, 3, 4]
    assert str(refused.errors[3]).endswith("; pass repeated='drop' to leave it out")
    assert refused.errors[3].index == (3, 3)


@every_dimension
@every_run
def test_foreign_curves_and_polygons(dim, runs):
    points, (first, segments) = walk(dim), nodes_of(runs)
    curve = ss.CatmullRom(points)
    expected = ss.check_shape(points, curve.to_bspline(), parameters=curve.parameters)
    given_points = expand(points, runs)
    for u in (None, expand(curve.parameters, runs)):
        report = ss.check_shape(given_points, curve.to_ppoly(), parameters=u, repeated="drop")
        own, without = report.to_dict(), expected.to_dict()
        assert own["counts"] == without["counts"]
        assert [r["segment"] for r in own["segments"]] == [
            segments[r["segment"]] for r in without["segments"]
        ]
        assert [n.node for n in report.nodes] == [first[n.node] for n in expected.nodes]
        assert pickle.loads(pickle.dumps(report)).to_dict() == own
    moved = curve.to_ppoly()
    moved.c[-1, 3] += 0.5
    with pytest.raises(ss.InputError, match=rf"does not pass through points\[{first[3]}\]"):
        ss.check_shape(given_points, moved, repeated="drop")
    shape, alone = ss.polygon_shape(given_points, repeated="drop"), ss.polygon_shape(points)
    np.testing.assert_array_equal(shape.points, given_points)
    np.testing.assert_array_equal(shape.chords, np.diff(given_points, axis=0))
    np.testing.assert_array_equal(shape.binormals, expand(alone.binormals, runs))
    np.testing.assert_array_equal(shape.torsion[segments], alone.torsion)
    assert [shape.calls[i] for i in segments] == list(alone.calls)
    assert shape.counts() == alone.counts()


@every_family
def test_a_check_of_the_points_given_is_the_check_of_the_curve(family):
    points = expand(walk(), RUNS["middle"])
    curve = cases.preserving(family)(points, repeated="drop")
    assert ss.check_shape(points, curve).to_dict() == curve.check().to_dict()
    ss.fairness(curve), ss.inflection_count(curve)
    # Knots of a fair curve are simple.
    pieces = len(curve.knots) - 1
    assert len(curve.to_bspline().c) == (pieces + 3 if family is ss.FairSpline else 3 * pieces + 1)


def test_the_exception_of_a_search_that_ends_early_refers_to_the_input():
    runs = RUNS["everywhere"]
    with pytest.raises(ss.ConvergenceError) as caught:
        ss.NuSpline.shape_preserving(
            expand(walk(), runs), "uniform", repeated="drop", strategy="nussp", max_iterations=1
        )
    error = caught.value
    assert len(error.curve.points) == sum(runs)
    allowed = set(nodes_of(runs)[1])
    assert {v.segment for v in error.report.violations} <= allowed
    assert error.report.to_dict() == error.curve.check().to_dict()


@every_family
def test_closed_data_may_repeat_points_as_well(family):
    runs = RUNS["everywhere"]
    points = walk()
    expected = family(points, closed=True)
    for given_points in (expand(points, runs), np.vstack([expand(points, runs), points[:1]])):
        curve = family(given_points, closed=True, repeated="drop")
        np.testing.assert_array_equal(curve.bezier, expected.bezier)
        assert len(curve.points) == sum(runs) + 1
        assert curve.check().counts() == expected.check().counts()


@every_family
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_errors_have_indices_of_the_input(family, bad):
    runs = RUNS["everywhere"]
    points = expand(walk(), runs)
    at = nodes_of(runs)[0][5]
    points[at] = bad
    for make in (family, cases.preserving(family)):
        with pytest.raises(ss.InputError, match=rf"points\[{at}\] must be finite") as caught:
            make(points, repeated="drop")
        assert caught.value.index == at


@every_family
@pytest.mark.parametrize("name", ["Drop", "first", 1, None])
def test_other_ways_are_refused(family, name):
    with pytest.raises((TypeError, ss.InputError), match="repeated must be"):
        family(walk(), repeated=name)


@every_family
def test_nothing_but_one_point_is_too_few(family):
    with pytest.raises(ss.InputError, match="at least 2 points, got 1"):
        family([[1, 1]] * 5, repeated="drop")


def test_repeats_are_refused_with_the_remedy():
    points = expand(walk(), RUNS["middle"])
    calls = [
        *cases.FAMILIES,
        *(family.shape_preserving for family in cases.TENSE),
        ss.polygon_shape,
        lambda p: ss.check_shape(p, ss.NuSpline(walk()).to_bspline(), parameters="chordal"),
        lambda p: ss.fit_many(p, [0, len(p)], errors="raise"),
    ]
    for call in calls:
        with pytest.raises(ss.InputError, match="pass repeated='drop' to leave it out"):
            call(points)
    for call in calls[:6]:
        with pytest.raises(ss.InputError, match="pass repeated='drop' to leave that point out"):
            call(walk(), [0, 1, 2, 2, 3, 4, 5, 6])
    # There is no such option here, and no such advice.
    with pytest.raises(ss.InputError, match=r"neighbouring points must differ$"):
        ss.inflection_count(points)


@every_family
def test_figures_show_the_curve(family):
    curve = family(expand(walk(), RUNS["everywhere"]), repeated="drop")
    ss.plot.curve(curve), ss.plot.curvature(curve), ss.plot.torsion(curve)
    ss.plot.curvature_comb(curve), ss.plot.criteria(curve.check())
