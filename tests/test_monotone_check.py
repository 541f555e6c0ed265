# SPDX-License-Identifier: MIT OR Apache-2.0

"""`check_monotone`: monotonicity and convexity of any library's functions, exactly."""

import json
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BPoly, CubicSpline, PchipInterpolator, PPoly, make_interp_spline

import polygons
import shapespline as ss
from shapespline import _cli, _convert


def bernstein(polynomial):
    """Return a polynomial on [0, 1] as a curve."""
    power = PPoly(polynomial.coef[::-1, None], [0.0, 1.0])
    return _convert.piecewise(BPoly.from_power_basis(power))


def by_segment(report, criterion):
    return {r.segment: r for r in report.segments if r.criterion == criterion}


@pytest.mark.parametrize("name", ["akima", "rpn14"])
@pytest.mark.parametrize("maker", [CubicSpline, PchipInterpolator, make_interp_spline])
def test_monotonicity_of_others_functions_agrees_with_sampling(name, maker):
    columns = polygons.load(name)
    x, y = columns["x"], columns["y"]
    f = maker(x, y)
    report = ss.check_monotone(x, y, f)
    records = by_segment(report, "monotonicity")
    assert len(records) == len(x) - 1
    slope = f.derivative()
    for i, secant in enumerate(np.diff(y) / np.diff(x)):
        t = np.linspace(x[i], x[i + 1], 5001)
        if secant == 0:
            assert (records[i].satisfied is not False) == (np.ptp(f(t)) < 1e-9)
        else:
            least = (slope(t[1:-1]) / secant).min()
            assert records[i].margin == pytest.approx(least, rel=1e-3, abs=1e-3)
            assert abs(least) < 1e-9 or records[i].satisfied == (least > 0)
    assert report.ok == (maker is PchipInterpolator)


def test_a_narrow_dip_is_found():
    """A quintic that falls on a few thousandths of its interval, where few samples would be."""
    s = np.polynomial.Polynomial([-0.3, 1])
    slope = s**2 * (s - 0.4) ** 2 - 1e-9
    f = slope.integ()
    x, y = [0.0, 1.0], [f(0), f(1)]
    report = ss.check_monotone(x, y, bernstein(f), tolerance=1e-12)
    assert not report.ok
    location = report.violations[0].location
    assert min(abs(location - 0.3), abs(location - 0.7)) < 1e-3
    assert str(report).splitlines()[-1].split()[:2] == ["monotonicity", "0"]
    raised = f + 2e-9 * np.polynomial.Polynomial([0, 1])
    assert ss.check_monotone(x, [f(0), raised(1)], bernstein(raised), tolerance=1e-12).ok


@pytest.mark.parametrize("maker", [CubicSpline, PchipInterpolator, make_interp_spline])
@pytest.mark.parametrize("rough", [0.0, 0.3])
def test_convexity_agrees_with_sampling(rng, maker, rough):
    for _ in range(20):
        x = np.cumsum(rng.uniform(0.5, 1.5, 9))
        y = x**2 / 5 + rough * rng.normal(size=9)
        f = maker(x, y)
        report = ss.check_monotone(x, y, f, convex="data")
        records = by_segment(report, "convexity")
        node = np.sign(np.diff(np.diff(y) / np.diff(x)))
        node = np.r_[node[0], node, node[-1]]
        np.testing.assert_array_equal(list(records), np.flatnonzero(node[:-1] == node[1:]))
        for i, record in records.items():
            t = np.linspace(x[i], x[i + 1], 2001)[1:-1]
            least = (f(t, 2) if hasattr(f, "roots") else f.derivative(2)(t)) * node[i]
            assert (record.satisfied is False) == (least.min() < -1e-6)
        given = ss.check_monotone(x, y, f, convex=-np.ones(8))
        assert given.counts()["convexity"][1] == 8


def test_signs_near_zero_are_those_of_exact_fractions(rng):
    """Slopes ``(t - a)² - b`` of b near zero, whose least value fractions know."""
    verdicts = {True: 0, False: 0, None: 0}
    for exponent in rng.uniform(-18, -12, 400):
        a, b = rng.uniform(0.2, 0.8), rng.choice([-1, 1]) * 10**exponent
        slope = np.array([a * a, a * a - a, (1 - a) ** 2]) - b
        c = np.cumsum([0.0, *(slope / 3)])
        control = np.column_stack([np.linspace(0, 1, 4), c])[None]
        f = ss.PiecewiseBezier(control, [0.0, 1.0])
        (record,) = ss.check_monotone([0, 1], [c[0], c[3]], f, tolerance=0.0).segments
        first, middle, last = (Fraction(after) - Fraction(before) for before, after in pairwise(c))
        least = (first * last - middle**2) / (first - 2 * middle + last) * 3 / Fraction(c[3])
        assert abs(record.margin - least) < 1e-12
        verdicts[record.satisfied] += 1
        if record.satisfied is None:
            assert abs(least) < 1e-13
        else:
            assert record.satisfied == (least >= 0)
    assert min(verdicts.values()) > 20, verdicts


def test_a_function_that_jumps_is_refused():
    """It runs through the data from the right, and rises wherever it has a slope."""
    for size, refused in ((-0.5, True), (0.5, True), (1e-12, False)):
        f = PPoly([[1.0, 1.0], [0.0, 1.0 + size]], [0.0, 1.0, 2.0])
        x, y = [0.0, 1.0, 2.0], [0.0, 1.0 + size, 2.0 + size]
        if refused:
            with pytest.raises(ss.InputError, match="continuous, got one that jumps at x = 1"):
                ss.check_monotone(x, y, f)
        else:
            assert ss.check_monotone(x, y, f).ok


@pytest.mark.parametrize("dip", [0.0, 0.2])
def test_rounding_in_a_narrow_piece_hides_nothing_but_itself(dip):
    """A piece of the width of a few ulps, on which one coefficient is one ulp too low."""
    low, high = 0.5, 0.5 + 1e-13
    y = 1000.5
    control = [
        [1000.0, 1000.2 - dip, 1000.1 - dip, y],
        [y, np.nextafter(y, 0), y, y],
        [y, 1000.7, 1000.8, 1001.0],
    ]
    breaks = [0.0, low, high, 1.0]
    t = np.linspace(0, 1, 4)
    across = [a * (1 - t) + b * t for a, b in pairwise(breaks)]
    f = ss.PiecewiseBezier(np.stack([across, control], axis=2), breaks)
    (record,) = ss.check_monotone([0, 1], [1000, 1001], f).segments
    assert record.margin < -1
    assert record.satisfied is (False if dip else None)


def test_verdicts_do_not_depend_on_units(rng):
    x = np.cumsum(rng.uniform(0.1, 2.0, 12))
    for y in (rng.normal(size=12), np.r_[np.zeros(5), rng.normal(size=7)], np.full(12, 3.0)):
        graph = _convert.piecewise(CubicSpline(x, y))
        control = graph.control.copy()
        control[:, 1:-1, 1] += 1e-4 * rng.normal(size=control[:, 1:-1, 1].shape)
        seen = []
        for a, b in ((0, 0), (300, -300), (-300, 300), (-60, 900)):
            unit = np.array([2.0**a, 2.0**b])
            f = ss.PiecewiseBezier(control * unit, graph.breaks * unit[0])
            report = ss.check_monotone(x * unit[0], y * unit[1], f, convex="data")
            seen.append([(r.segment, r.satisfied, r.margin) for r in report.segments])
        assert all(found == seen[0] for found in seen)
        assert any(satisfied is False for _, satisfied, _ in seen[0])


@pytest.mark.parametrize(
    ("arguments", "options", "argument", "index"),
    [
        (([0, 1, 1], [0, 1, 2]), {}, "x", 2),
        (([0, 1], [0, np.nan]), {}, "y", 1),
        (([0, 1, 2], [0, 1]), {}, "y", None),
        (([0, 1, 2], [0, 1, 2]), {"convex": [1, 2]}, "convex", 1),
        (([0, 1, 2], [0, 1, 2]), {"convex": [1]}, "convex", None),
        (([0, 1, 2], [0, 1, 2]), {"convex": "yes"}, "convex", None),
        (([0, 1, 2], [0, 1, 2]), {"tolerance": -1.0}, "tolerance", None),
    ],
)
def test_bad_arguments(arguments, options, argument, index):
    with pytest.raises(ss.InputError) as error:
        ss.check_monotone(*arguments, ss.MonotoneCubic([0, 1, 2], [0, 1, 2]), **options)
    assert (error.value.argument, error.value.index) == (argument, index)


def test_reports_refuse_to_be_true_or_false():
    report = ss.check_monotone([0, 1], [0, 1], ss.MonotoneCubic([0, 1], [0, 1]))
    assert report.ok
    with pytest.raises(TypeError, match="ambiguous"):
        bool(report)


@pytest.mark.parametrize(
    ("entries", "what"),
    [
        ({"breaks": [0, 1, 3], "control": [[[0, 0], [2, 1]], [[2, 1], [3, 0]]]}, "piece 0 is not"),
        ({"breaks": [0, 2], "control": [[[0, 0], [2, 1]]]}, "runs from 0 to 2"),
        ({"breaks": [0, 3], "control": [[[0, 0], [3, 0]]]}, "must pass through y[1]"),
        ({"breaks": [0, 3], "control": [[[0, 0, 0], [3, 0, 0]]]}, "graph of a function"),
    ],
)  # fmt: skip
def test_check_refuses_what_is_no_function_through_the_points(entries, what, capsys, tmp_path):
    curve, points = tmp_path / "c.json", tmp_path / "p.csv"
    curve.write_text(json.dumps(entries), encoding="utf-8")
    points.write_text("0,0\n2,1\n3,0\n", encoding="utf-8")
    status = _cli.main(["check", str(points), str(curve), "--monotone"])
    errors = capsys.readouterr().err
    assert status == 2
    assert what in errors
    assert len(errors.splitlines()) == 1
