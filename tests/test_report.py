# SPDX-License-Identifier: MIT OR Apache-2.0

"""The shape report: what it says, in all its forms, against what sampling finds."""

import json
import re

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from shape_by_sampling import CRITERIA, of_curve

SHARED = cases.shared()


@pytest.fixture
def broken():
    """Return the report of the GM line's C² cubic: four violations."""
    return cases.gm_line().fit().check()


@pytest.mark.parametrize("case", [*SHARED, *cases.small()], ids=str)
def test_sampling_finds_nothing_that_the_report_misses(case):
    curve = case.fit()
    report, sampled = curve.check(), of_curve(curve)
    reported = {(v.criterion, v.segment) for v in report.violations}
    assert set(sampled.violations) <= reported
    assert report.ok == (not reported)
    # Sampling can overlook a violation, but only a small one.
    overlooked = reported - set(sampled.violations)
    margins = {(v.criterion, v.segment): v.margin for v in report.violations}
    assert all(margins[key] > -1e-3 for key in overlooked)


@pytest.mark.parametrize("case", [*SHARED, *cases.small()], ids=str)
def test_each_segment_is_asked_what_its_polygon_calls_for(case):
    curve = case.fit()
    sampled = of_curve(curve)
    asked = {(r.criterion, r.segment) for r in curve.check().segments if r.applicable}
    expected = {
        (name, int(i)) for name in CRITERIA for i in np.flatnonzero(sampled.applicable[name])
    }
    assert asked == expected


def test_records(broken):
    assert isinstance(broken, ss.ShapeReport)
    for record in broken.segments:
        assert isinstance(record.segment, int)
        assert 0 <= record.segment < 19
        assert record.criterion in CRITERIA
        if record.applicable:
            assert record.satisfied == (record.margin > 0)
    violations = [r for r in broken.segments if r.applicable and not r.satisfied]
    assert [(v.criterion, v.segment) for v in broken.violations] == [
        (v.criterion, v.segment) for v in violations
    ]


def test_margin_is_the_worst_of_all(broken):
    assert broken.margin == min(r.margin for r in broken.segments if r.applicable)
    assert broken.margin < 0 < cases.gm_line().preserve().check().margin


def test_margin_does_not_depend_on_scale(broken):
    case = cases.gm_line()
    scaled = case.moved(case.points * 1e60, lambda v: v * 1e60).fit().check()
    margins = [r.margin for r in broken.segments if r.applicable]
    found = [r.margin for r in scaled.segments if r.applicable]
    np.testing.assert_allclose(found, margins, rtol=1e-6, atol=1e-12)


def test_counts_add_up(broken):
    for name, (violated, asked) in broken.counts().items():
        records = [r for r in broken.segments if r.criterion == name and r.applicable]
        assert asked == len(records)
        assert violated == sum(not r.satisfied for r in records)
    assert sum(violated for violated, _ in broken.counts().values()) == 6


def test_print_shows_a_table_and_names_what_is_wrong(broken):
    text = str(broken)
    assert len(text.splitlines()) >= 3
    for name in ("convexity", "torsion"):
        row = next(line for line in text.splitlines() if name in line)
        violated, asked = broken.counts()[name]
        assert str(violated) in row
        assert str(asked) in row


def test_to_dict_is_plain_data(broken):
    # allow_nan=False: a margin that does not exist must be None, which other languages can read.
    plain = json.loads(json.dumps(broken.to_dict(), allow_nan=False))
    assert plain["ok"] is False
    assert len(plain["segments"]) == len(broken.segments)
    keys = {"segment", "criterion", "applicable", "satisfied", "margin", "location"}
    assert all(keys <= set(record) for record in plain["segments"])


def test_the_report_is_true_of_tension_given_by_hand():
    """Enough tension mends everything but what the end tangents spoil."""
    case = cases.gm_line()
    assert not case.fit().check().ok
    assert case.fit(tension=100.0).check().ok


def test_straight_data_have_nothing_to_violate():
    report = ss.NuSpline([[0, 0], [1, 1], [3, 3], [4, 4]]).check()
    assert report.ok
    assert {r.criterion for r in report.segments if r.applicable} == {"collinearity"}
    assert report.undecided == []


@pytest.mark.parametrize("family", cases.FAMILIES)
@pytest.mark.parametrize("dim", [2, 3])
def test_a_printed_report_measures_the_curve_beside_the_cubic(family, dim, rng):
    points = polygons.random_walk(rng, 12, dim)
    curve, cubic = cases.preserving(family)(points, "chordal"), ss.NuSpline(points)
    own = str(curve.check())
    lines = {line[:17].strip(): line[17:].split() for line in own.splitlines()}
    for k, found in enumerate([curve.fairness(), cubic.fairness()]):
        energy, largest = lines["energy ∫κ²ds"][k], lines["max. curvature"][k]
        assert float(energy) == pytest.approx(found.bending / found.length, rel=1e-3)
        assert float(largest) == pytest.approx(found.max_curvature, rel=1e-3)
    # A check of the curve's pieces prints the same numbers.
    pieces = ss.PiecewiseBezier(curve.bezier, curve.knots)
    other = str(ss.check_shape(points, pieces, parameters=curve.parameters))
    assert other.splitlines()[-3:] == own.splitlines()[-3:]


@pytest.mark.parametrize("family", [ss.NuSpline, ss.TensionSpline])
def test_a_printed_report_names_practical_corners(family, rng):
    points = polygons.random_walk(rng, 9, 3)
    option = {"tension": 1e5} if family is ss.NuSpline else {"tangent_scale": 1e-4}
    values = np.full(9, 0.0 if family is ss.NuSpline else 1.0)
    values[[2, 6]] = next(iter(option.values()))
    curve = family(points, **{next(iter(option)): values})
    assert str(curve.check()).endswith("practically corners: points 2, 6")
    other = ss.check_shape(points, ss.PiecewiseBezier(curve.bezier, curve.knots))
    assert str(other).endswith("practically corners: points 2, 6")
    assert "corners" not in str(ss.FairSpline(points).check())


@pytest.mark.parametrize("family", [ss.NuSpline, ss.TensionSpline, ss.CatmullRom])
def test_a_printed_report_names_the_criterion_that_costs_most(family, rng):
    """Energy at the segments of which the C² cubic violates it, and beside them: by sampling."""
    named = 0
    for _ in range(10):
        points = polygons.random_walk(rng, 12, 3)
        curve, cubic = family.shape_preserving(points, "chordal"), ss.NuSpline(points)
        energies = [bending_of_segments(each) for each in (curve, cubic)]
        fairness = [each.fairness() for each in (curve, cubic)]
        exact = [found.bending / found.length for found in fairness]
        if [sum(energy) for energy in energies] != pytest.approx(exact, rel=1e-2):
            continue  # a spike between two samples
        costs = {}
        for criterion in cubic.check().counts():
            violated = [v.segment for v in cubic.check([criterion]).violations]
            beside = sorted({j for i in violated for j in (i - 1, i, i + 1) if 0 <= j < 11})
            costs[criterion] = [sum(energy[beside]) for energy in energies]
        dearest = max(costs, key=lambda name: costs[name][0] - costs[name][1])
        own, plain = costs[dearest]
        lines = [line for line in str(curve.check()).splitlines() if "costs most" in line]
        assert bool(lines) == (own - plain > 0.01 * sum(energies[1]))
        if lines:
            named += 1
            numbers = [float(text) for text in re.findall(r"\d\.\d+e\d+", lines[0])]
            assert lines[0].startswith(f"costs most: {dearest} ")
            assert numbers == pytest.approx([own, plain], rel=0.02)
    assert named >= 3


def bending_of_segments(curve):
    """Return ∫κ²ds of each segment, by sampling."""
    first, last = curve.parameters[:-1], curve.parameters[1:]
    u = first + np.linspace(0, 1, 20001)[:, None] * (last - first)
    u = 0.5 * (u[1:] + u[:-1])
    speed = np.linalg.norm(curve(u, 1), axis=-1)
    return (curve.curvature(u) ** 2 * speed).mean(axis=0) * (last - first)


def test_a_long_report_is_printed_without_measures():
    text = str(ss.NuSpline(polygons.gentle_track(1100)).check())
    assert "fairness" not in text
