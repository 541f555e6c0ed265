# SPDX-License-Identifier: MIT OR Apache-2.0

"""Ctrl-C is heard within a second by whatever can run longer; see also test_processes.py."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

import shapespline as ss
import threads


def helix(n):
    t = np.linspace(0, n / 10, n)
    return np.column_stack([np.cos(t), np.sin(t), t / 7 + 0.1 * np.sin(t / 3)])


def often(values, times):
    """Return values many times over, without memory for them."""
    return np.broadcast_to(values, (times, values.size))


def quintic(n):
    points = helix(n)
    u = np.arange(n, dtype=float)
    return points, make_interp_spline(u, points, k=5), u


def evaluation():
    curve, u = ss.NuSpline(helix(100)[:, :2]), np.linspace(0, 9, 1 << 16)
    return lambda: curve(often(u, 300))


def torsion():
    curve, u = ss.NuSpline(helix(100)), np.linspace(0, 9, 1 << 16)
    return lambda: curve.torsion(often(u, 500))


def samples():
    curve = ss.NuSpline(helix(100))
    return lambda: curve.sample(30_000_000, by="arc-length")


def lengths():
    curve = ss.NuSpline(helix(1_000_000))
    return curve.arc_length


def inverse():
    f = ss.MonotoneQuintic(range(9), np.exp(range(9)))
    y = np.linspace(1, 2980, 1 << 16)
    return lambda: f.inverse(often(y, 500))


def check():
    points, curve, u = quintic(300_000)
    return lambda: ss.check_shape(points, curve, parameters=u)


def margin():
    points, curve, u = quintic(20_000)
    report = ss.check_shape(points, curve, parameters=u)
    return lambda: report.margin


def notes():
    points, curve, u = quintic(300_000)
    report = ss.check_shape(points, curve, parameters=u)
    return lambda: report.nodes


def fairness():
    curve = ss.NuSpline(helix(200_000))
    return curve.fairness


CALLS = [evaluation, torsion, samples, lengths, inverse, check, margin, notes, fairness]


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.__name__)
def test_ctrl_c_is_heard(call):
    threads.assert_ctrl_c_ends(call())
