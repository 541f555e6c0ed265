# SPDX-License-Identifier: MIT OR Apache-2.0

"""Measures of fairness against closed forms, sampling and themselves after a change of units."""

import itertools
import pickle

import numpy as np
import pytest
from scipy.interpolate import BPoly, CubicSpline

import shapespline as ss

RNG = np.random.default_rng(3)
CURVES = {
    "nu": lambda points: ss.NuSpline(points, tension=1.0),
    "tension": lambda points: ss.TensionSpline(points, tangent_scale=0.6),
    "catmull-rom": ss.CatmullRom,
    "fair": ss.FairSpline,
    "fair, bending": lambda points: ss.FairSpline(points, energy="bending"),
    "scipy": lambda points: CubicSpline(np.arange(len(points)), points),
}


def image(curve):
    """Return the image of a curve, piece by piece, as SciPy evaluates it."""
    if isinstance(curve, ss.SpaceCurve):
        return BPoly(curve.bezier.swapaxes(0, 1), curve.knots)
    return curve


def sampled(path, count=4001):
    """Return length, bending and largest curvature by the trapezoidal rule."""
    length = bending = largest = 0.0
    for a, b in itertools.pairwise(path.x):
        # At a break each piece has derivatives of its own.
        u = np.linspace(a, b, count)
        u[[0, -1]] += np.array([1, -1]) * 1e-9 * (b - a)
        d1, d2 = path(u, 1), path(u, 2)
        if d1.shape[1] == 2:
            turn = np.abs(d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
        else:
            turn = np.linalg.norm(np.cross(d1, d2), axis=1)
        speed = np.linalg.norm(d1, axis=1)
        curvature = turn / speed**3
        largest = max(largest, curvature.max())
        length += np.trapezoid(speed, u)
        bending += np.trapezoid(curvature**2 * speed, u)
    return length, length * bending, largest


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("family", CURVES)
def test_measures_are_those_that_dense_samples_show(family, dimension):
    points = np.cumsum(RNG.normal(size=(12, dimension)), axis=0)
    curve = CURVES[family](points)
    found = ss.fairness(curve)
    length, bending, largest = sampled(image(curve))
    assert found.length == pytest.approx(length, rel=1e-6)
    assert found.bending == pytest.approx(bending, rel=1e-2)
    assert largest * (1 - 1e-6) <= found.max_curvature <= largest * (1 + 1e-2)
    assert found.cusps == ()
    assert found.corners == ()


@pytest.mark.parametrize("scale", [1e-100, 1e-6, 1e6, 1e100])
@pytest.mark.parametrize("dimension", [2, 3])
def test_all_but_length_and_curvature_are_free_of_scale(scale, dimension):
    points = np.cumsum(RNG.normal(size=(10, dimension)), axis=0)
    one, other = (ss.NuSpline(points * s, "uniform").fairness() for s in (1.0, scale))
    assert other.length == pytest.approx(one.length * scale, rel=1e-12)
    assert other.max_curvature == pytest.approx(one.max_curvature / scale, rel=1e-12)
    assert other.max_curvature_at == pytest.approx(one.max_curvature_at, rel=1e-9)
    for name in ("bending", "variation", "max_curvature_jump"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-9), name
    assert other.curvature_extrema == one.curvature_extrema


def test_curvature_jumps_where_it_should():
    points = np.cumsum(RNG.normal(size=(10, 3)), axis=0)
    smooth = [
        ss.NuSpline(points, tension=2.0),
        ss.TensionSpline(points, tangent_scale=0.5),
        ss.FairSpline(points),
    ]
    for curve in smooth:
        assert curve.fairness().max_curvature_jump == 0.0
        assert np.isfinite(curve.fairness().variation)
    rough = ss.CatmullRom(points).fairness()
    assert rough.max_curvature_jump > 0.1
    assert rough.variation == np.inf


def test_a_record_compares_pickles_and_prints():
    found = ss.fairness(ss.PiecewiseBezier([[[0, 0], [1, 0]], [[1, 0], [1, 1]]], [0, 1, 2]))
    assert found.corners == (1.0,)
    assert found.bending == np.inf
    assert pickle.loads(pickle.dumps(found)) == found
    assert "corners=(1,)" in repr(found)


@pytest.mark.parametrize("curve", [3, "line", None, object()])
def test_what_is_no_curve_is_refused(curve):
    with pytest.raises(TypeError, match="curve must be"):
        ss.fairness(curve)
