# SPDX-License-Identifier: MIT OR Apache-2.0

"""Directions given to a `FairSpline`: its own, some near them, some that contradict the shape."""

import numpy as np
import pytest

import polygons
import shapespline as ss
from scale import scaled

every_energy = pytest.mark.parametrize("energy", ["parametric", "bending"])
every_dimension = pytest.mark.parametrize("dim", [2, 3])
ENDS = ["natural", "circular", "periodic"]


def unit(v):
    return v / np.linalg.norm(v)


def angle(v, w):
    """Return the angle between two vectors, accurate where it is small."""
    v, w = unit(v), unit(w)
    return 2 * np.arctan2(np.linalg.norm(v - w), np.linalg.norm(v + w))


def free_curves(rng, dim, energy, count):
    """Return fair curves through random walks, the options they were made with, and some points."""
    for k in range(count):
        points = polygons.random_walk(rng, 12, dim)
        ends = ENDS[k % 3]
        options = {"closed": True} if ends == "periodic" else {"boundary": ends}
        curve = ss.FairSpline(points, energy=energy, **options)
        inner = np.arange(0 if ends == "periodic" else 1, len(points) - (ends != "periodic"))
        chosen = inner if k % 2 else inner[rng.uniform(size=len(inner)) < 0.4]
        yield curve, points, {"energy": energy, **options}, chosen.tolist()


def keeps(curve, wanted):
    """Whether the curve has the directions, or says by how much others differ."""
    turned = curve.diagnostics.turned
    for k, v in wanted.items():
        off = angle(curve.tangents[k], v)
        assert off < 1e-9 or abs(off - turned[k]) < 1e-9, (k, off, turned)
    return set(turned) <= set(wanted)


@every_dimension
@every_energy
def test_its_own_directions_give_the_curve_back(dim, energy, rng):
    for curve, points, options, chosen in free_curves(rng, dim, energy, scaled(200, 25)):
        wanted = {k: curve.tangents[k] * 10 ** rng.uniform(-3, 3) for k in chosen}
        again = ss.FairSpline(points, tangents=wanted, **options)
        assert again.check().ok
        assert again.diagnostics.turned == {}
        assert keeps(again, wanted)
        assert again.diagnostics.energy <= curve.diagnostics.energy * (1 + 1e-3)
        size = np.ptp(points, axis=0).max()
        np.testing.assert_allclose(again.tangents, curve.tangents, rtol=0, atol=1e-3 * size)


@every_dimension
@every_energy
def test_directions_near_its_own_are_nearly_always_had(dim, energy, rng):
    found = turned = 0
    for curve, points, options, chosen in free_curves(rng, dim, energy, scaled(200, 25)):
        wanted = {k: unit(curve.tangents[k]) + 1e-3 * rng.normal(size=dim) for k in chosen}
        try:
            near = ss.FairSpline(points, tangents=wanted, **options)
        except ss.InputError as error:
            assert "must be between the chords" in str(error)  # noqa: PT017
            continue
        assert near.check().ok
        assert keeps(near, wanted)
        assert max(near.diagnostics.turned.values(), default=0.0) < 0.02
        found, turned = found + 1, turned + bool(near.diagnostics.turned)
    assert found > scaled(200, 25) / 2
    assert turned <= found / 3


@every_energy
@pytest.mark.parametrize("criteria", [None, ["convexity", "turning"]])
def test_the_nearest_directions_where_torsion_contradicts(energy, criteria, rng):
    """Bisectors lie in the plane of their chords: torsion often asks to leave it."""
    contradictions = 0
    for _ in range(scaled(100)):
        points = polygons.random_walk(rng, 9)
        chords = np.diff(points, axis=0)
        wanted = {k: unit(chords[k - 1]) + unit(chords[k]) for k in range(1, 8)}
        curve = ss.FairSpline(points, tangents=wanted, criteria=criteria, energy=energy)
        assert curve.check().ok
        assert keeps(curve, wanted)
        contradictions += bool(curve.diagnostics.turned)
    if criteria is None:
        assert contradictions > 0


def test_indices_are_those_of_the_input(rng):
    points = polygons.random_walk(rng, 9)
    chords = np.diff(points, axis=0)
    wanted = {k: unit(chords[k - 1]) + unit(chords[k]) for k in range(1, 8)}
    curve = ss.FairSpline(points, tangents=wanted)
    doubled = points.repeat(2, axis=0)
    again = ss.FairSpline(doubled, repeated="drop", tangents={2 * k: v for k, v in wanted.items()})
    expected = {2 * k: a for k, a in curve.diagnostics.turned.items()}
    assert again.diagnostics.turned == pytest.approx(expected)


@every_dimension
def test_with_corners_and_a_largest_deviation(dim, rng):
    count, unsolved = scaled(50), 0
    for _ in range(count):
        points = polygons.random_walk(rng, 12, dim)
        free = ss.FairSpline(points, corners=[5])
        wanted = {k: free.tangents[k] for k in (2, 3, 8)}
        try:
            curve = ss.FairSpline(points, corners=[5], tangents=wanted, max_deviation=0.5)
        except ss.ConvergenceError:
            # Known (limits.md): so much asked at once is not always found.
            unsolved += 1
            continue
        assert curve.check().ok
        assert keeps(curve, wanted)
    assert unsolved <= count // 10


@pytest.mark.parametrize("turn", [1e-4, 1e-6, 1e-8, 1e-9])
def test_end_tangents_across_nearly_straight_data(turn):
    """The first handle has to be as short as the turn beside it is small; no other handle has."""
    x = np.arange(6.0)
    points = np.column_stack([x, turn * x**2])
    curve = ss.FairSpline(points, boundary=ss.Tangents((1, -2), (1, 1)))
    report = curve.check()
    assert report.ok
    assert not report.undecided
    start, end = curve.tangents[[0, -1]]
    np.testing.assert_allclose(start / np.linalg.norm(start), np.array([1, -2]) / np.sqrt(5))
    np.testing.assert_allclose(end / np.linalg.norm(end), np.array([1, 1]) / np.sqrt(2))
    assert 0.5 * turn < np.linalg.norm(start) < 10 * turn
    assert np.linalg.norm(curve.tangents[1:-1], axis=1).min() > 0.1
