# SPDX-License-Identifier: MIT OR Apache-2.0

"""A tangent given at one end, the other end natural: every family, both ends."""

import json

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from shapespline import _cli

every_family = pytest.mark.parametrize("family", cases.FAMILIES, ids=lambda f: f.__name__)
every_dimension = pytest.mark.parametrize("dim", [2, 3])
every_end = pytest.mark.parametrize("end", ["start", "end"])


def one_sided(rng, dim, end, count=12):
    """Return points, and the boundary with a tangent near the chord at one end."""
    points = polygons.random_walk(rng, count, dim)
    chord = points[1] - points[0] if end == "start" else points[-1] - points[-2]
    tangent = chord / np.linalg.norm(chord) + 0.3 * rng.normal(size=dim)
    return points, ss.Tangents(**{end: tangent})


@every_family
@every_dimension
@every_end
def test_the_other_end_is_natural(family, dim, end, rng):
    for _ in range(5):
        points, boundary = one_sided(rng, dim, end)
        given, free = (0, -1) if end == "start" else (-1, 0)
        for curve in (
            family(points, boundary=boundary),
            cases.preserving(family)(points, boundary=boundary),
        ):
            assert curve.boundary == boundary
            # A fair curve makes it zero but for the barrier.
            least = 3e-2 if family is ss.FairSpline else 1e-9
            bend = curve.curvature(curve.parameters[free], side="left" if free else "right")
            assert bend <= least * curve.fairness().max_curvature
            along = getattr(boundary, end)
            tangent = curve.tangents[given]
            lengths = np.linalg.norm(along) * np.linalg.norm(tangent)
            assert tangent @ along >= (1 - 1e-12) * lengths
        assert not curve.check().violations
        # The same as the natural curve where that curve's own tangent is given.
        plain = family(points)
        if family is ss.TensionSpline or family is ss.NuSpline:
            own = family(points, boundary=ss.Tangents(**{end: plain.tangents[given]}))
            np.testing.assert_allclose(own.tangents, plain.tangents, rtol=1e-10, atol=1e-10)


@every_family
@every_end
def test_checks_and_polygons_know_it(family, end, rng):
    points, boundary = one_sided(rng, 3, end)
    curve = cases.preserving(family)(points, boundary=boundary)
    report = ss.check_shape(
        points, curve.to_ppoly(), parameters=curve.parameters, boundary=boundary
    )
    if family is not ss.TensionSpline:  # run through otherwise
        assert report.counts() == curve.check().counts()
    shape, natural = ss.polygon_shape(points, boundary=boundary), ss.polygon_shape(points)
    given = 0 if end == "start" else -1
    assert np.linalg.norm(shape.binormals[given]) > 0
    assert np.linalg.norm(natural.binormals[given]) == 0
    np.testing.assert_array_equal(shape.binormals[-1 - given], natural.binormals[-1 - given])


@pytest.mark.parametrize("method", ["fair", "nu", "tension", "catmull-rom"])
@every_end
def test_files_and_the_command_line(method, end, rng, tmp_path, capsys):
    points, boundary = one_sided(rng, 2, end)
    csv, file = tmp_path / "p.csv", tmp_path / "c.json"
    np.savetxt(csv, points, delimiter=",", header="x,y", comments="", fmt="%.17g")
    text = ",".join(repr(float(x)) for x in getattr(boundary, end))
    command = ["fit", str(csv), "--method", method, f"--{end}-tangent={text}", "-o", str(file)]
    assert _cli.main(command) == 0, capsys.readouterr()
    other = {"start": "end", "end": "start"}[end]
    entries = json.loads(file.read_text())["boundary"]
    assert entries[other] is None
    assert entries[end] == getattr(boundary, end).tolist()
    assert _cli.main(["check", str(csv), str(file)]) == 0, capsys.readouterr()
