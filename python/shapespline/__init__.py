"""Splines that interpolate data and keep its shape.

>>> import shapespline as ss
>>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
>>> curve = ss.NuSpline.shape_preserving(points, "uniform")
>>> curve.check().ok
True
>>> curve([0.0, 4.0]).shape
(2, 3)
"""

from shapespline import plot
from shapespline._core import (
    Diagnostics,
    MonotoneDiagnostics,
    MonotoneQuartic,
    MonotoneQuintic,
    MonotoneRows,
    MonotoneSpline,
    NuSpline,
    PiecewisePolynomial,
    SearchStep,
    ShapeRecord,
    ShapeReport,
    SpaceCurve,
    Tangents,
    __version__,
    bezier_like,
    fit_many_monotone,
)
from shapespline._errors import ConvergenceError

__all__ = [
    "ConvergenceError",
    "Diagnostics",
    "MonotoneDiagnostics",
    "MonotoneQuartic",
    "MonotoneQuintic",
    "MonotoneRows",
    "MonotoneSpline",
    "NuSpline",
    "PiecewisePolynomial",
    "SearchStep",
    "ShapeRecord",
    "ShapeReport",
    "SpaceCurve",
    "Tangents",
    "__version__",
    "bezier_like",
    "fit_many_monotone",
    "plot",
]
