# SPDX-License-Identifier: MIT OR Apache-2.0

"""Every array that a public call takes: the call with this argument, and a good value of it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import shapespline as ss

POINTS = np.array([[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5.0]])
U = np.array([0.0, 1, 2, 3, 5])
X, Y = np.arange(5.0), np.arange(5.0) ** 2
CONTROL = np.array([[[0.0, 0], [1, 1], [2, 1], [3, 0]]])
KNOTS = np.array([0.0, 0, 0, 1, 2, 2, 2])
SQUARE = np.array([[0.0, 0], [0, 1], [1, 1], [1, 0]])
CURVES = {family.__name__: family(POINTS, U) for family in
          (ss.FairSpline, ss.NuSpline, ss.TensionSpline, ss.CatmullRom)}  # fmt: skip
NU = CURVES["NuSpline"]
PIECES = ss.PiecewiseBezier(NU.bezier, U)
F = ss.MonotoneQuintic(X, Y)
ROWS = ss.fit_many_monotone([X, X], [Y, Y])


@dataclass(frozen=True)
class Argument:
    """An argument of a call, by its name in messages."""

    call: str
    name: str
    work: Callable[[object], object]
    good: npt.NDArray[np.float64]

    def __str__(self) -> str:
        return f"{self.call}, {self.name}"


def _families() -> list[Argument]:
    found = []
    for name, curve in CURVES.items():
        family = type(curve)
        calls = [(family, name)]
        if family is not ss.FairSpline:
            calls.append((family.shape_preserving, f"{name}.shape_preserving"))
        for make, call in calls:
            found += [
                Argument(call, "points", make, POINTS),
                Argument(call, "parameters", lambda u, make=make: make(POINTS, u), U),
            ]
        for method in ("__call__", "curvature", "curvature_vector", "torsion", "frame"):
            found.append(Argument(f"{name}.{method}", "u", getattr(curve, method), U))
    return found


ARGUMENTS = [
    *_families(),
    Argument("NuSpline", "tension", lambda t: ss.NuSpline(POINTS, tension=t), U),
    Argument("CatmullRom", "tension", lambda t: ss.CatmullRom(POINTS, tension=t), U / 9),
    Argument("TensionSpline", "tangent_scale", lambda t: ss.TensionSpline(POINTS, tangent_scale=t),
             1 / (1 + U)),
    Argument("TensionSpline pair", "tangent_scale[0]",
             lambda t: ss.TensionSpline(POINTS, tangent_scale=(t, 1.0)), 1 / (1 + U[1:])),
    Argument("TensionSpline pair", "tangent_scale[1]",
             lambda t: ss.TensionSpline(POINTS, tangent_scale=(1.0, t)), 1 / (1 + U[1:])),
    Argument("image_parameter", "u", CURVES["TensionSpline"].image_parameter, U),
    Argument("Tangents", "start", lambda v: ss.Tangents(v, [1, 0, 0]), U[:3]),
    Argument("Tangents", "end", lambda v: ss.Tangents([1, 0, 0], v), U[:3]),
    Argument("fit_many", "points", lambda p: ss.fit_many(p, [0, 2, 5]), POINTS),
    Argument("fit_many", "offsets", lambda o: ss.fit_many(POINTS, o), U[[0, 2, 4]]),
    Argument("fit_many", "parameters", lambda u: ss.fit_many(POINTS, [0, 2, 5], parameters=u), U),
    Argument("check_shape", "points", lambda p: ss.check_shape(p, PIECES), POINTS),
    Argument("check_shape of its own", "points", lambda p: ss.check_shape(p, NU), POINTS),
    Argument("check_shape", "parameters",
             lambda u: ss.check_shape(POINTS, PIECES, parameters=u), U),
    Argument("check_shape of its own", "parameters",
             lambda u: ss.check_shape(POINTS, NU, parameters=u), U),
    Argument("check_shape of control points", "curve",
             lambda c: ss.check_shape(POINTS, c, parameters=U), NU.bezier),
    Argument("polygon_shape", "points", ss.polygon_shape, POINTS),
    Argument("polygon_shape", "parameters", lambda u: ss.polygon_shape(POINTS, u), U),
    Argument("inflection_count", "curve", ss.inflection_count, POINTS),
    Argument("inflection_count of control points", "curve", ss.inflection_count, CONTROL),
    Argument("inflection_count", "direction", lambda v: ss.inflection_count(POINTS, v), U[:3]),
    Argument("PiecewiseBezier", "control", lambda c: ss.PiecewiseBezier(c, [0, 1]), CONTROL),
    Argument("PiecewiseBezier", "breaks", lambda u: ss.PiecewiseBezier(NU.bezier, u), U),
    Argument("PiecewiseBezier", "weights",
             lambda w: ss.PiecewiseBezier(CONTROL, [0, 1], weights=w), np.full((1, 4), 2.0)),
    Argument("from_bspline", "knots", lambda t: ss.PiecewiseBezier.from_bspline(t, SQUARE, 2),
             KNOTS),
    Argument("from_bspline", "control", lambda c: ss.PiecewiseBezier.from_bspline(KNOTS, c, 2),
             SQUARE),
    Argument("from_bspline", "weights",
             lambda w: ss.PiecewiseBezier.from_bspline(KNOTS, SQUARE, 2, weights=w), U[1:]),
    Argument("from_power", "coefficients", lambda c: ss.PiecewiseBezier.from_power(c, [0, 1]),
             CONTROL.swapaxes(0, 1)),
    Argument("from_power", "breaks",
             lambda u: ss.PiecewiseBezier.from_power(CONTROL.swapaxes(0, 1), u), U[:2]),
    Argument("PiecewiseBezier.__call__", "u", PIECES, U),
    Argument("MonotoneQuartic", "x", lambda x: ss.MonotoneQuartic(x, Y), X),
    Argument("MonotoneQuartic", "y", lambda y: ss.MonotoneQuartic(X, y), Y),
    Argument("MonotoneQuartic", "slopes", lambda s: ss.MonotoneQuartic(X, Y, slopes=s), X),
    Argument("MonotoneQuartic", "shape[0]",
             lambda a: ss.MonotoneQuartic(X, Y, shape=(a, X[1:])), X[1:]),
    Argument("MonotoneQuintic", "x", lambda x: ss.MonotoneQuintic(x, Y), X),
    Argument("MonotoneQuintic", "y", lambda y: ss.MonotoneQuintic(X, y), Y),
    Argument("MonotoneQuintic of columns", "y", lambda y: ss.MonotoneQuintic(X, y),
             np.column_stack([Y, -1 - Y])),
    Argument("MonotoneQuintic", "slopes", lambda s: ss.MonotoneQuintic(X, Y, slopes=s), 2 * X),
    Argument("MonotoneQuintic.__call__", "x", F, X),
    Argument("MonotoneQuintic.inverse", "y", F.inverse, Y),
    Argument("fit_many_monotone", "x", lambda x: ss.fit_many_monotone(x, [Y, Y]), np.array([X, X])),
    Argument("fit_many_monotone", "y", lambda y: ss.fit_many_monotone([X, X], y), np.array([Y, Y])),
    Argument("fit_many_monotone", "offsets",
             lambda o: ss.fit_many_monotone(X, Y, offsets=o), X[[0, 2]] * 2.5),
    Argument("fit_many_monotone", "slopes",
             lambda s: ss.fit_many_monotone([X, X], [Y, Y], slopes=s), np.array([2 * X, 2 * X])),
    Argument("MonotoneRows.__call__", "x", ROWS, X),
    Argument("MonotoneRows.inverse", "y", ROWS.inverse, Y),
    Argument("MonotoneRows.integrate", "a", lambda a: ROWS.integrate(a, 3), X[:2]),
    Argument("bezier_like", "control", lambda c: ss.bezier_like(3, c, 0.5), SQUARE),
    Argument("bezier_like", "t", lambda t: ss.bezier_like(3, SQUARE, t), U),
]  # fmt: skip
