"""The command line's check of monotonicity: of any library's functions, exactly."""

import json

import numpy as np
import pytest
from scipy.interpolate import BPoly, CubicSpline, PchipInterpolator, PPoly, make_interp_spline

import polygons
from shapespline import _convert, cli
from shapespline._monotone_check import check_monotone


def bernstein(polynomial):
    """Return a polynomial on [0, 1] as a curve."""
    power = PPoly(polynomial.coef[::-1, None], [0.0, 1.0])
    return _convert.piecewise(BPoly.from_power_basis(power))


@pytest.mark.parametrize("name", ["akima", "rpn14"])
@pytest.mark.parametrize("maker", [CubicSpline, PchipInterpolator, make_interp_spline])
def test_monotonicity_of_others_functions_agrees_with_sampling(name, maker):
    columns = polygons.load(name)
    x, y = columns["x"], columns["y"]
    f = maker(x, y)
    report = check_monotone(np.column_stack([x, y]), _convert.piecewise(f))
    slope = f.derivative()
    for i, secant in enumerate(np.diff(y) / np.diff(x)):
        t = np.linspace(x[i], x[i + 1], 5001)
        if secant == 0:
            assert report.satisfied[i] == (np.ptp(f(t)) < 1e-9)
        else:
            least = (slope(t[1:-1]) / secant).min()
            assert report.margins[i] == pytest.approx(least, rel=1e-3, abs=1e-3)
            assert abs(least) < 1e-9 or report.satisfied[i] == (least > 0)
    assert report.ok == (maker is PchipInterpolator)


def test_a_narrow_dip_is_found():
    """A quintic that falls on a few thousandths of its interval, where few samples would be."""
    s = np.polynomial.Polynomial([-0.3, 1])
    slope = s**2 * (s - 0.4) ** 2 - 1e-9
    f = slope.integ()
    points = np.array([[0.0, f(0)], [1.0, f(1)]])
    report = check_monotone(points, bernstein(f), tolerance=1e-12)
    assert not report.ok
    assert min(abs(report.locations[0] - 0.3), abs(report.locations[0] - 0.7)) < 1e-3
    assert str(report).splitlines()[-1].split()[:2] == ["monotonicity", "0"]
    raised = f + 2e-9 * np.polynomial.Polynomial([0, 1])
    points[1, 1] = raised(1)
    assert check_monotone(points, bernstein(raised), tolerance=1e-12).ok


@pytest.mark.parametrize(
    ("entries", "what"),
    [
        ({"breaks": [0, 1, 3], "control": [[[0, 0], [2, 1]], [[2, 1], [3, 0]]]}, "piece 0 is not"),
        ({"breaks": [0, 2], "control": [[[0, 0], [2, 1]]]}, "runs from 0 to 2"),
        ({"breaks": [0, 3], "control": [[[0, 0], [3, 0]]]}, "does not pass through points[1]"),
        ({"breaks": [0, 3], "control": [[[0, 0, 0], [3, 0, 0]]]}, "graph of a function"),
    ],
)  # fmt: skip
def test_check_refuses_what_is_no_function_through_the_points(entries, what, capsys, tmp_path):
    curve, points = tmp_path / "c.json", tmp_path / "p.csv"
    curve.write_text(json.dumps(entries), encoding="utf-8")
    points.write_text("0,0\n2,1\n3,0\n", encoding="utf-8")
    status = cli.main(["check", str(points), str(curve), "--monotone"])
    errors = capsys.readouterr().err
    assert status == 2
    assert what in errors
    assert len(errors.splitlines()) == 1
