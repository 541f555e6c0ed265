# SPDX-License-Identifier: MIT OR Apache-2.0

"""Checks of curves with corners and straight runs: objects, exports, files and the command line."""

import json
import pickle

import numpy as np
import pytest

import polygons
import shapespline as ss
from scale import scaled
from shapespline import _cli
from shapespline._cli import files
from test_exported_shape import rounded
from test_fair_straight import with_runs

every_dimension = pytest.mark.parametrize("dim", [2, 3])


def fitted(rng, dim, closed):
    """Return fair curves with corners, with straight runs, and with both."""
    walk = polygons.random_walk(rng, 11, dim)
    runs, _ = with_runs(rng, dim)
    yield ss.FairSpline(walk, corners=[2, 3, 8], closed=closed)
    yield ss.FairSpline(runs, straight=True, closed=closed)
    yield ss.FairSpline(runs, straight=True, corners=[1, 4], closed=closed)


@every_dimension
@pytest.mark.parametrize("closed", [False, True])
def test_every_form_is_judged_as_the_curve_is(dim, closed, rng, tmp_path):
    csv, file = tmp_path / "p.csv", tmp_path / "c.json"
    for _ in range(scaled(30)):
        for curve in fitted(rng, dim, closed):
            own, u = curve.check(), curve.parameters
            given = {"parameters": u, "boundary": curve.boundary, **curve._fit_options()}
            assert own.ok
            # The curve itself, and other forms of it: there a caller says where the corners are.
            again = ss.check_shape(curve.points, curve, **given)
            assert again.counts() == own.counts()
            assert again.straight == own.straight
            pieces = ss.PiecewiseBezier(curve.bezier, curve.knots)
            digits = ss.PiecewiseBezier(rounded(curve.bezier), curve.knots)
            forms = (curve.to_bspline(), curve.to_ppoly(), pieces, digits)
            for form in forms if not curve.straight else ():
                report = ss.check_shape(curve.points, form, corners=curve.corners, **given)
                assert report.ok, report
                assert report.counts() == own.counts()
                assert pickle.loads(pickle.dumps(report)).to_dict() == report.to_dict()
            # Files say both by themselves.
            header = ",".join("xyz"[:dim])
            np.savetxt(csv, curve.points, delimiter=",", header=header, comments="", fmt="%.17g")
            files.write_curve(file, curve)
            entries = json.loads(file.read_text(encoding="utf-8"))
            assert entries["corners"] == list(curve.corners)
            assert entries["straight"] == list(curve.straight)
            assert _cli.main(["check", str(csv), str(file)]) == 0
            entries["control"] = rounded(np.array(entries["control"])).tolist()
            file.write_text(json.dumps(entries), encoding="utf-8")
            assert _cli.main(["check", str(csv), str(file)]) == 0


def test_the_option_corners(rng, tmp_path, capsys):
    points = polygons.random_walk(rng, 11, 2)
    curve = ss.FairSpline(points, corners=[4])
    csv, file = tmp_path / "p.csv", tmp_path / "c.json"
    np.savetxt(csv, points, delimiter=",", header="x,y", comments="", fmt="%.17g")
    files.write_curve(file, curve)
    entries = json.loads(file.read_text(encoding="utf-8"))
    file.write_text(json.dumps({**entries, "corners": []}), encoding="utf-8")
    status = _cli.main(["check", str(csv), str(file)])
    assert _cli.main(["check", str(csv), str(file), "--corners", "4"]) == 0
    assert status == (0 if ss.check_shape(points, curve, corners=[]).ok else 1)
    capsys.readouterr()
    assert _cli.main(["check", str(csv), str(file), "--corners", "0"]) == 2
    assert "corners[0] must be the index of an inner point" in capsys.readouterr().err
    file.write_text(json.dumps({**entries, "corners": [40]}), encoding="utf-8")
    assert _cli.main(["check", str(csv), str(file)]) == 2
    assert "corners[0] must be the index of a point" in capsys.readouterr().err
    for bad in ("four", [-1], [1.5], [True]):
        file.write_text(json.dumps({**entries, "corners": bad}), encoding="utf-8")
        assert _cli.main(["check", str(csv), str(file)]) == 2
        assert "'corners' must be a list of indices" in capsys.readouterr().err


def test_corners_of_points_that_are_repeated(rng):
    points = polygons.random_walk(rng, 9)
    curve = ss.FairSpline(points, corners=[3])
    doubled, form = points.repeat(2, axis=0), curve.to_ppoly()
    report = ss.check_shape(
        doubled, form, parameters=curve.parameters.repeat(2), repeated="drop", corners=[6]
    )
    assert report.ok
    by_angle = ss.check_shape(points, form, parameters=curve.parameters, corners=1e-6)
    assert by_angle.ok
    assert by_angle.counts()["turning"] == (0, 0)
