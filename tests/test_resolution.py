# SPDX-License-Identifier: MIT OR Apache-2.0

"""What a move of the points by the resolution could undo is not asked for."""

import json
import pickle

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from scale import scaled
from shapespline import _cli
from shapespline._cli import files

SIGNS = ("convexity", "inflection", "torsion")
every_family = pytest.mark.parametrize("family", cases.FAMILIES)
every_dimension = pytest.mark.parametrize("dim", [2, 3])


def signs(points, resolution=0.0):
    """Return what is called for on each segment, with the sign of its torsion."""
    shape = ss.polygon_shape(points, resolution=resolution)
    signs = zip(shape.calls, np.sign(shape.torsion), strict=True)
    return [{(c, s if c == "torsion" else 0) for c in calls} for calls, s in signs]


@every_dimension
def test_what_is_asked_survives_every_move(dim, rng):
    """Independent of the formulas: points moved about at random within the resolution."""
    asked = 0
    for _ in range(scaled(2000)):
        points = polygons.random_walk(rng, 12, dim)
        delta = 10 ** rng.uniform(-3, -0.7)
        known = signs(points, delta)
        for _ in range(8):
            moves = rng.normal(size=points.shape)
            moves *= delta / np.linalg.norm(moves, axis=1)[:, None]
            moved = signs(points + moves)
            for own, other in zip(known, moved, strict=True):
                wanted = {(c, s) for c, s in own if c in SIGNS}
                assert wanted <= other
                asked += len(wanted)
    assert asked > scaled(2000) * 20


@every_dimension
def test_more_resolution_asks_for_less(dim, rng):
    for _ in range(scaled(300)):
        points = polygons.random_walk(rng, 20, dim)
        before = [calls - {("collinearity", 0), ("coplanarity", 0)} for calls in signs(points)]
        for delta in (1e-9, 1e-4, 1e-2, 0.1, 0.3, 1.0, 1e3):
            now = signs(points, delta)
            assert all(n <= b for n, b in zip(now, before, strict=True))
            before = now
        assert not any(now)


@pytest.mark.parametrize("scale", [1e-100, 1e-9, 1.0, 1e9, 1e100])
def test_the_resolution_has_the_unit_of_the_points(scale, rng):
    points = polygons.random_walk(rng, 200, 3)
    assert signs(points * scale, 0.05 * scale) == signs(points, 0.05)
    assert signs(points, 0.05) != signs(points)


def test_a_nearly_straight_point_asks_for_nothing():
    points = np.array([[0, 1], [1, 0], [2, 0], [3, 1e-3], [4, 3e-3], [5, 1.0]])
    names = [set(calls) for calls in ss.polygon_shape(points, resolution=1e-3).calls]
    # The two points in the middle have widths of 5e-4 and 1e-3.
    assert names[2] == set()
    assert ss.polygon_shape(points).calls[2] != ()
    shape = ss.polygon_shape(points, resolution=1e-3)
    assert (shape.binormals[2:4] == 0).all()
    exact = np.array([[0, 0], [1, 0], [2, 0], [3, 1.0]])
    assert "collinearity" in ss.polygon_shape(exact).calls[1]
    assert not any("collinearity" in c for c in ss.polygon_shape(exact, resolution=1e-9).calls)


@every_family
@every_dimension
def test_fits_keep_what_is_known(family, dim, rng, tmp_path):
    """And their own checks, those of files and of pickles ask for the same."""
    for end in ("natural", "circular", "periodic"):
        smooth = polygons.random_walk(rng, 30, dim)
        options = {"closed": True} if end == "periodic" else {"boundary": end}
        curve = cases.preserving(family)(smooth, resolution=0.1, **options)
        report = curve.check()
        assert report.ok
        assert report.to_dict()["resolution"] == 0.1
        assert pickle.loads(pickle.dumps(curve)).check().to_dict() == report.to_dict()
        other = ss.check_shape(smooth, curve, resolution=0.1, closed=end == "periodic")
        assert other.counts() == report.counts()
        assert sum(n for _, n in curve.check(resolution=0).counts().values()) > sum(
            n for _, n in report.counts().values()
        )
        files.write_curve(tmp_path / "c.json", curve)
        assert json.loads((tmp_path / "c.json").read_text())["fit_options"]["resolution"] == 0.1


@every_family
def test_noise_below_the_resolution_costs_no_tension(family, rng):
    """A straight line, an arc and a helix whose points are off by up to the resolution."""
    t = np.linspace(0, 6, 40)
    helix = np.column_stack([np.cos(t), np.sin(t), 0.2 * t])
    line = np.outer(t, [1.0, 2, 3])
    for smooth in (line, helix):
        noisy = smooth + rng.uniform(-1, 1, smooth.shape) * 1e-3
        plain, known = (cases.preserving(family)(noisy, resolution=r) for r in (0.0, 2e-3))
        assert known.check().ok
        assert known.fairness().max_curvature <= plain.fairness().max_curvature * (1 + 1e-9)
    # Nothing is asked of the line: no tension.
    assert not any(signs(line + 1e-4 * rng.uniform(-1, 1, line.shape), 1e-3))


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf, -1e-300])
def test_resolutions_out_of_range(value):
    points = [[0.0, 0], [1, 1], [2, 0]]
    curve = ss.NuSpline(points)
    calls = [
        *(lambda f=f: cases.preserving(f)(points, resolution=value) for f in cases.FAMILIES),
        lambda: curve.check(resolution=value),
        lambda: ss.check_shape(points, curve, resolution=value),
        lambda: ss.polygon_shape(points, resolution=value),
        lambda: ss.fit_many(points, [0, 3], resolution=value),
    ]
    for call in calls:
        with pytest.raises(ss.InputError, match="resolution must be a length, at least 0") as e:
            call()
        assert e.value.argument == "resolution"


def test_the_command_line(tmp_path, capsys, rng):
    points = polygons.random_walk(rng, 20, 3)
    csv, file, out = tmp_path / "p.csv", tmp_path / "c.json", tmp_path / "r.json"
    np.savetxt(csv, points, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    assert (
        _cli.main(["fit", str(csv), "--method", "nu", "--resolution", "0.2", "-o", str(file)]) == 0
    )
    assert _cli.main(["check", str(csv), str(file), "--report", str(out)]) == 0
    assert json.loads(out.read_text())["resolution"] == 0.2
    _cli.main(["check", str(csv), str(file), "--resolution", "0", "--report", str(out)])
    assert json.loads(out.read_text())["resolution"] == 0
    capsys.readouterr()
