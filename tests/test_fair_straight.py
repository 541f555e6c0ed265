# SPDX-License-Identifier: MIT OR Apache-2.0

"""`FairSpline` that is exactly straight along collinear runs."""

import pickle

import numpy as np
import pytest

import shapespline as ss
from scale import scaled
from shapespline import _cli

every_dimension = pytest.mark.parametrize("dim", [2, 3])
every_energy = pytest.mark.parametrize("energy", ["parametric", "bending"])
#: Two runs that meet at point 2.
BENT = [[0, 0], [1, 0], [3, 0], [3, 1], [3, 2], [4, 3]]


def unit(v):
    return v / np.linalg.norm(v)


def with_runs(rng, dim, noise=0.0):
    """Return points of which two or three lie on lines now and then, and the segments that do."""
    d, points, straight = unit(rng.normal(size=dim)), [np.zeros(dim)], []
    for _ in range(int(rng.integers(2, 4))):
        for count, bend in ((rng.integers(2, 4), 0.0), (rng.integers(2, 4), 0.8)):
            for _ in range(int(count)):
                d = unit(d + bend * rng.normal(size=dim))
                straight += [len(points) - 1] if not bend else []
                points.append(points[-1] + rng.uniform(0.5, 2) * d)
        d = unit(d + 0.8 * rng.normal(size=dim))
    points = np.array(points)
    return points + noise * rng.uniform(-1, 1, points.shape), tuple(straight)


def off_line(curve, segment):
    """Return how far the control points of a segment lie from its chord."""
    first, last = np.searchsorted(curve.knots, curve.parameters[segment : segment + 2])
    a, b = curve.points[segment : segment + 2]
    seen = curve.bezier[first:last].reshape(-1, len(a)) - a
    return np.linalg.norm(seen - np.outer(seen @ unit(b - a), unit(b - a)), axis=1).max()


def ends_of(rng, points, ends):
    """Return a boundary of some kind; tangents along the run that the points begin with."""
    if ends == "tangents":
        return ss.Tangents(points[1] - points[0], points[-1] - 0.6 * points[-2] - 0.4 * points[-3])
    return ends


def turning(v, w):
    v, w = (np.c_[v, np.zeros((len(v), 3 - v.shape[1]))] for v in (v, w))
    return np.cross(v, w)


@every_dimension
@every_energy
@pytest.mark.parametrize("ends", ["natural", "circular", "periodic", "tangents"])
def test_runs_are_straight_and_the_rest_keeps_its_shape(dim, energy, ends, rng):
    for _ in range(scaled(60)):
        points, straight = with_runs(rng, dim)
        options = (
            {"closed": True} if ends == "periodic" else {"boundary": ends_of(rng, points, ends)}
        )
        curve = ss.FairSpline(points, energy=energy, straight=True, **options)
        report = curve.check()
        assert report.ok
        assert not report.undecided
        assert curve.straight == report.straight == straight
        assert f"straight on {len(straight)} segments" in str(report)
        size = np.ptp(points, axis=0).max()
        assert max(off_line(curve, i) for i in straight) < 1e-14 * size
        inner = curve.knots[1:-1]
        left, right = (curve(inner, 2, side=side) for side in ("left", "right"))
        np.testing.assert_allclose(left, right, rtol=0, atol=1e-10 * np.abs(right).max())
        # By samples: where a run ends in a turn the curve turns to the side that the points do.
        u = curve.parameters
        for k in range(1, len(u) - 1):
            ahead, behind = k in straight, k - 1 in straight
            if ahead == behind:
                continue
            i = k if behind else k - 1
            own = u[i] + (u[i + 1] - u[i]) * (
                np.array([0.01, 0.1]) if behind else np.array([0.99, 0.9])
            )
            side = turning(points[k : k + 1] - points[k - 1], points[k + 1 : k + 2] - points[k])
            assert np.all(turning(curve(own, 1), curve(own, 2)) @ side[0] > 0)
            # None at the point, but for what rounding leaves of second differences of positions.
            rounding = 1e-12 / size
            assert curve.curvature(u[k]) <= 1e-9 * curve.curvature(own).max() + rounding


@every_dimension
def test_pickles_collections_and_the_verb(dim, rng):
    rows = [with_runs(rng, dim) for _ in range(4)]
    fits = ss.fit_many(
        np.vstack([points for points, _ in rows]),
        np.cumsum([0, *(len(points) for points, _ in rows)]),
        straight=True,
    )
    for curve, (points, straight) in zip(fits, rows, strict=True):
        assert curve.straight == straight
        alone = ss.fit(points, straight=True)
        np.testing.assert_array_equal(alone.bezier, curve.bezier)
        again = pickle.loads(pickle.dumps(curve))
        assert again.straight == straight
        assert again.check().to_dict() == curve.check().to_dict()
        assert pickle.loads(pickle.dumps(curve.check())).straight == straight
        assert curve.check().to_dict()["straight"] == list(straight)
        assert ss.fit(points).straight == ss.fit(points).check().straight == ()


@every_dimension
def test_dropped_points_keep_their_indices(dim, rng):
    points, straight = with_runs(rng, dim)
    doubled = np.insert(points, 2, points[1], axis=0)
    curve = ss.FairSpline(doubled, repeated="drop", straight=True)
    assert curve.straight == curve.check().straight
    assert len(curve.straight) == len(straight)
    np.testing.assert_array_equal(curve.bezier, ss.FairSpline(points, straight=True).bezier)


@every_dimension
def test_points_straight_to_the_resolution_are_a_run(dim, rng):
    for _ in range(scaled(30)):
        points, straight = with_runs(rng, dim, noise=1e-4)
        curve = ss.FairSpline(points, straight=True, resolution=2e-4 * np.sqrt(dim))
        assert set(straight) <= set(curve.straight)
        assert curve.check().ok
        assert max(off_line(curve, i) for i in straight) < 1e-3
        assert ss.FairSpline(points, straight=True, criteria="turning").straight == ()


def test_two_runs_meet_in_a_corner():
    with pytest.raises(
        ss.InputError, match=r"points\[2\] must be among the corners with"
    ) as caught:
        ss.FairSpline(BENT, straight=True)
    assert (caught.value.argument, caught.value.index) == ("points", 2)
    curve = ss.FairSpline(BENT, straight=True, corners=[2])
    assert curve.straight == (0, 1, 2, 3)
    assert curve.check().ok
    doubled = np.insert(BENT, 1, BENT[0], axis=0)
    with pytest.raises(ss.InputError, match=r"points\[3\] must be among"):
        ss.FairSpline(doubled, straight=True, repeated="drop")
    square = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]]
    with pytest.raises(ss.InputError, match=r"points\[0\] must be among"):
        ss.FairSpline(square, closed=True, straight=True)
    square = ss.FairSpline(square, closed=True, straight=True, corners=[0, 2, 4, 6])
    assert square.straight == tuple(range(8))
    assert square.check().ok
    assert square.arc_length() == pytest.approx(8)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"boundary": ss.Tangents([1, 1])}, "boundary.start must be along the run"),
        ({"tangents": {1: [1, 1]}}, r"tangents\[1\] must be along the straight run"),
        ({"tangents": {1: [-1, 0]}}, r"tangents\[1\] must be along the straight run"),
        ({"tangents": {2: [2, 1]}}, r"tangents\[2\] must be along the straight run"),
    ],
)
def test_what_leads_off_a_run_is_refused(options, text):
    points = [[0, 0], [1, 0], [2, 0], [3, 1], [3, 2]]
    with pytest.raises(ss.InputError, match=text):
        ss.FairSpline(points, straight=True, **options)
    along = ss.FairSpline(points, straight=True, tangents={1: [3, 0], 2: [1, 0]})
    assert along.check().ok
    assert ss.FairSpline(points, straight=True, boundary=ss.Tangents([1, 0])).check().ok


def test_the_option_elsewhere(tmp_path, capsys):
    csv = tmp_path / "p.csv"
    np.savetxt(csv, BENT, delimiter=",", header="x,y", comments="")
    assert _cli.main(["fit", str(csv), "--straight", "--corners", "2"]) == 0
    assert "straight on 4 segments" in capsys.readouterr().out
    assert _cli.main(["fit", str(csv), "--straight"]) == 2
    assert "points[2] must be among the corners" in capsys.readouterr().err
    assert _cli.main(["fit", str(csv), "--method", "nu", "--straight"]) == 2
    assert "--straight is no option of method nu" in capsys.readouterr().err
    with pytest.raises(TypeError, match="straight must be True or False"):
        ss.FairSpline(BENT, straight=1)
    with pytest.raises(TypeError, match=r"straight is no option of method 'nu'.*'fair'"):
        ss.fit(BENT, method="nu", straight=True)
