# SPDX-License-Identifier: MIT OR Apache-2.0

"""One object of every class, for what all of them must be able to do."""

import numpy as np

import shapespline as ss

POINTS = np.array([[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]])


def everything() -> list[object]:
    """Return one object of every class that is made of curves, checks and functions."""
    x, y = np.arange(9.0), np.arange(9.0) ** 2
    fair = ss.FairSpline([[0, 1], [1, 0], [2, 0], [3, 0.01], [4, 0.03], [5, 1]])
    nu = ss.NuSpline.shape_preserving(POINTS, "uniform")
    plane = ss.NuSpline.shape_preserving([[0, 0], [1, 1], [2, 0], [3, 1]])
    f = ss.MonotoneQuintic(x, y)
    rows = ss.fit_many_monotone([x, x], [y, -y])
    report = nu.check()
    foreign = ss.check_shape(POINTS, nu.to_bspline(), parameters=nu.parameters)
    return [
        fair,
        fair.diagnostics,
        fair.history[0],
        nu,
        ss.TensionSpline(POINTS),
        ss.CatmullRom(POINTS),
        ss.Tangents([1, 0], [0, 1]),
        ss.PiecewiseBezier(nu.bezier, nu.parameters),
        report,
        foreign,
        report.segments[0],
        plane.check().nodes[0],
        ss.OscillationRecord(0, 1, 1, True, 0.01, 0.5),
        ss.UndecidedRecord(3, "torsion", (0.25, 0.5)),
        nu.diagnostics,
        nu.fairness(),
        nu.history[0],
        ss.fit_many(POINTS, [0, 2, 5]),
        ss.polygon_shape(POINTS),
        ss.inflection_count([[0, 0], [1, 1], [2, 0], [3, 1]]),
        ss.MonotoneCubic(x, y),
        ss.smooth_monotone(x, y).smoothing,
        ss.check_monotone(x, y, f),
        ss.check_monotone(x, y, f).segments[0],
        ss.MonotoneQuartic(x, y),
        f,
        f.derivative(),
        f.diagnostics,
        rows,
        rows.derivative(),
    ]
