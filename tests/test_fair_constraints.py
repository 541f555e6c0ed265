# SPDX-License-Identifier: MIT OR Apache-2.0

"""FairSpline with corners, directions and a largest deviation."""

import pickle
from itertools import pairwise

import numpy as np
import pytest

import polygons
import shapespline as ss
from shapespline import _cli

SQUARE = np.array([[0.0, 0], [3, 0], [3.2, 2], [1, 3], [0, 2]])
every_dimension = pytest.mark.parametrize("dim", [2, 3])


def deviation(curve):
    """Return how far control points lie from the chord of their segment."""
    knots, largest = list(curve.knots), 0.0
    nodes = [knots.index(u) for u in curve.parameters]
    for (i, j), a, b in zip(pairwise(nodes), curve.points, curve.points[1:], strict=False):
        for p in curve.bezier[i:j].reshape(-1, len(a)):
            t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            largest = max(largest, np.linalg.norm(p - a - t * (b - a)))
    return largest


@every_dimension
def test_corners_by_index_and_by_angle(dim, rng):
    points = polygons.random_walk(rng, 12, dim)
    curve = ss.FairSpline(points, corners=[3, 7])
    assert curve.corners == (3, 7)
    assert curve.check().ok
    for k in range(1, 11):
        u = curve.parameters[k]
        jump = np.abs(curve(u, 1, side="left") - curve(u, 1)).max()
        assert (jump > 1e-6) == (k in (3, 7))
    turns = ss.polygon_shape(points).turning_angles
    angle = np.sort(turns[1:-1])[-3]
    sharp = ss.fit(points, corners=float(angle) - 1e-9)
    assert sharp.corners == tuple(np.flatnonzero(turns >= angle))
    again = pickle.loads(pickle.dumps(curve))
    assert again.corners == curve.corners
    assert again.check().to_dict() == curve.check().to_dict()
    assert ss.FairSpline(points, corners=(7, 3)).corners == (3, 7)
    assert ss.FairSpline(points, corners=()).corners == ()


@every_dimension
def test_exports_have_the_corners(dim, rng):
    points = polygons.random_walk(rng, 9, dim)
    curve = ss.FairSpline(points, corners=[4])
    u = np.linspace(*curve.parameters[[0, -1]], 301)
    for form in (curve.to_bspline(), curve.to_ppoly()):
        np.testing.assert_allclose(form(u), curve(u), atol=1e-12 * np.abs(points).max())


@every_dimension
@pytest.mark.parametrize("energy", ["parametric", "bending"])
@pytest.mark.parametrize("ends", ["circular", "both", "start", "end"])
@pytest.mark.parametrize("corners", [(1,), (3, 7), (1, 2, 10)])
def test_corners_beside_end_tangents(dim, energy, ends, corners, rng):
    """The ends of the whole have their tangents; each part is what it is by itself."""
    points = polygons.random_walk(rng, 12, dim)
    chords = np.diff(points, axis=0)
    out = [1.2 * chords[0] - 0.3 * chords[1], 1.2 * chords[-1] - 0.3 * chords[-2]]
    out = [v / np.linalg.norm(v) for v in out]
    if ends == "circular":
        boundary = ends
        out = [ss.NuSpline(points, boundary=ends).tangents[k] for k in (0, -1)]
    else:
        out = [
            v if ends in ("both", name) else None
            for v, name in zip(out, ("start", "end"), strict=True)
        ]
        boundary = ss.Tangents(*out)
    curve = ss.FairSpline(points, boundary=boundary, energy=energy, corners=corners)
    assert curve.check().ok
    assert curve.boundary == boundary
    scales = curve.diagnostics.tangent_scale
    for k, tangent, scale in zip((0, -1), out, scales, strict=True):
        if tangent is not None:
            np.testing.assert_allclose(curve.tangents[k], scale * tangent, atol=1e-12)
    nodes = [0, *corners, 11]
    for first, last in pairwise(nodes):
        own = (out[0] if first == 0 else None, out[1] if last == 11 else None)
        part = ss.FairSpline(
            points[first : last + 1],
            curve.parameters[first : last + 1],
            boundary="natural" if all(v is None for v in own) else ss.Tangents(*own),
            energy=energy,
        )
        u = np.linspace(*part.parameters[[0, -1]], 60)[:-1]
        np.testing.assert_allclose(curve(u), part(u), atol=1e-12 * np.abs(points).max())


def test_closed_data_and_repeated_points():
    corners = [1, 3]
    curve = ss.FairSpline(SQUARE, closed=True, corners=corners)
    assert curve.corners == (1, 3)
    assert curve.check().ok
    doubled = SQUARE.repeat([1, 2, 1, 1, 3], axis=0)
    same = ss.FairSpline(doubled, closed=True, repeated="drop", corners=[1, 4])
    np.testing.assert_array_equal(same.bezier, curve.bezier)
    assert same.corners == (1, 4)
    # A point that was left out stands where the one before it does.
    assert ss.FairSpline(doubled, closed=True, repeated="drop", corners=[2]).corners == (1,)


@every_dimension
@pytest.mark.parametrize("energy", ["parametric", "bending"])
def test_the_largest_deviation_is_kept(dim, energy, rng):
    points = polygons.random_walk(rng, 10, dim)
    free = ss.FairSpline(points, energy=energy)
    own = deviation(free)
    same = ss.FairSpline(points, energy=energy, max_deviation=own * 1.01)
    np.testing.assert_array_equal(same.bezier, free.bezier)
    for share in (0.5, 0.1):
        curve = ss.FairSpline(points, energy=energy, max_deviation=share * own)
        assert deviation(curve) <= share * own
        assert curve.check().ok
        # Where the free curve nearly stopped it was made to bend less at some energy.
        assert curve.diagnostics.energy >= free.diagnostics.energy * (1 - 5e-2)


@pytest.mark.parametrize("energy", ["parametric", "bending"])
@pytest.mark.parametrize("share", [0.2, 0.01])
def test_a_closed_coil_is_held_near_its_polygon(energy, share):
    points = polygons.load_points("coil_m16n08_first")
    own = deviation(ss.FairSpline(points, boundary="periodic", energy=energy))
    curve = ss.FairSpline(points, boundary="periodic", energy=energy, max_deviation=share * own)
    assert deviation(curve) <= share * own
    assert curve.check().ok


@every_dimension
@pytest.mark.parametrize("energy", ["parametric", "bending"])
@pytest.mark.parametrize("ends", ["natural", "periodic"])
@pytest.mark.parametrize("share", [1e-2, 1e-3, 1e-5])
def test_nearly_the_polygon_is_had_or_refused(dim, energy, ends, share, rng):
    points = polygons.random_walk(rng, 10, dim)
    options = {"closed": ends == "periodic", "energy": energy}
    longest = np.linalg.norm(np.diff(points, axis=0), axis=1).max()
    curve = ss.FairSpline(points, max_deviation=share * longest, **options)
    assert deviation(curve) <= share * longest * (1 + 1e-9)
    assert curve.check().ok
    with pytest.raises(ss.InputError, match="max_deviation must be more than a millionth"):
        ss.FairSpline(points, max_deviation=1e-7 * longest, **options)


@every_dimension
def test_directions_are_kept(dim, rng):
    points = polygons.random_walk(rng, 10, dim)
    chords = np.diff(points, axis=0)
    wanted = {k: chords[k - 1] + chords[k] for k in (2, 5)}
    curve = ss.fit(points, tangents=wanted, criteria=["convexity", "turning"])
    for k, d in wanted.items():
        t = curve.tangents[k]
        assert t @ d > 0
        assert np.linalg.norm(
            t * np.linalg.norm(d) - d * np.linalg.norm(t)
        ) < 1e-11 * np.linalg.norm(t) * np.linalg.norm(d)


@pytest.mark.parametrize(
    ("options", "error", "text"),
    [
        ({"corners": 3}, ss.InputError, "corners must be indices of points, or the least turning"),
        ({"corners": [0]}, ss.InputError, r"corners\[0\] must be the index of an inner point"),
        ({"corners": [2, 9]}, ss.InputError, r"corners\[1\] must be the index of a point, got 9"),
        ({"corners": [1.5]}, ss.InputError, r"corners\[0\] must be the index of a point"),
        ({"corners": [-1]}, ss.InputError, r"corners\[0\] must be the index of a point"),
        ({"corners": 4.0}, ss.InputError, "corners must be an angle above 0 and at most π"),
        ({"tangents": [1, 2]}, TypeError, "tangents must be a dict of index: vector, got list"),
        ({"tangents": {9: [1, 0]}}, ss.InputError, r"tangents\[9\] must be the index of a point"),
        ({"tangents": {2: [1, 0, 0]}}, ss.InputError, r"tangents\[2\] must be a vector of 2"),
        ({"tangents": {2: [0, 0]}}, ss.InputError, r"tangents\[2\] must be a finite vector"),
        ({"tangents": {2: [1, -1]}}, ss.InputError, r"tangents\[2\] must be between the chords"),
        ({"tangents": {"a": [1, 0]}}, TypeError, "tangents must be an integer"),
        ({"max_deviation": 0}, ss.InputError, "max_deviation must be a length above 0, got 0"),
        ({"max_deviation": np.nan}, ss.InputError, "max_deviation must be a length above 0"),
    ],
)
def test_contradictions_are_refused_by_name(options, error, text):
    with pytest.raises(error, match=text):
        ss.FairSpline(SQUARE, **options)


def test_other_methods_lack_them():
    for method in ("nu", "tension", "catmull-rom"):
        with pytest.raises(TypeError, match=r"corners is no option of method .*'fair'"):
            ss.fit(SQUARE, method=method, corners=[2])


def test_the_command_line(tmp_path, capsys):
    csv, file = tmp_path / "p.csv", tmp_path / "c.json"
    np.savetxt(csv, SQUARE, delimiter=",", header="x,y", comments="")
    status = _cli.main(
        ["fit", str(csv), "--corners", "1,3", "--max-deviation", "0.3", "-o", str(file)]
    )
    assert status == 0, capsys.readouterr()
    assert _cli.main(["fit", str(csv), "--corners", "1.2"]) == 0
    assert _cli.main(["fit", str(csv), "--method", "nu", "--corners", "1"]) == 2
    assert "--corners is no option of method nu" in capsys.readouterr().err
