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
    CatmullRom,
    Diagnostics,
    NuSpline,
    SearchStep,
    ShapeRecord,
    ShapeReport,
    SpaceCurve,
    Tangents,
    TensionSpline,
    __version__,
)
from shapespline._errors import ConvergenceError
from shapespline._many import Fits, fit_many

__all__ = [
    "CatmullRom",
    "ConvergenceError",
    "Diagnostics",
    "Fits",
    "NuSpline",
    "SearchStep",
    "ShapeRecord",
    "ShapeReport",
    "SpaceCurve",
    "Tangents",
    "TensionSpline",
    "__version__",
    "fit_many",
    "plot",
]
