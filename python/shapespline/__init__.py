# SPDX-License-Identifier: MIT OR Apache-2.0

"""Splines that interpolate data and keep its shape.

>>> import shapespline as ss
>>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
>>> curve = ss.fit(points)
>>> curve.check().ok
True
>>> curve([0.0, 4.0]).shape
(2, 3)
"""

from shapespline import _attached as _attached
from shapespline import interchange, plot
from shapespline._core import (
    CatmullRom,
    ConvergenceError,
    Diagnostics,
    FairDiagnostics,
    Fairness,
    FairSpline,
    FairStep,
    InputError,
    MonotoneCubic,
    MonotoneDiagnostics,
    MonotoneQuartic,
    MonotoneQuintic,
    MonotoneRecord,
    MonotoneReport,
    MonotoneRows,
    MonotoneSmoothing,
    MonotoneSpline,
    NodeRecord,
    NuSpline,
    OscillationRecord,
    PiecewiseBezier,
    PiecewisePolynomial,
    PiecewiseRows,
    SearchStep,
    ShapeRecord,
    ShapeReport,
    SpaceCurve,
    Tangents,
    TensionSpline,
    UndecidedRecord,
    __version__,
    bezier_like,
    fit_many_monotone,
    minimal_bending,
    smooth_monotone,
)
from shapespline._functions import check_monotone, fit_monotone, histospline
from shapespline._many import Fits, fit_many
from shapespline._polygon import PolygonShape, polygon_shape
from shapespline._shape import InflectionCount, check_shape, fairness, inflection_count
from shapespline._verbs import fit

__all__ = [
    "CatmullRom",
    "ConvergenceError",
    "Diagnostics",
    "FairDiagnostics",
    "FairSpline",
    "FairStep",
    "Fairness",
    "Fits",
    "InflectionCount",
    "InputError",
    "MonotoneCubic",
    "MonotoneDiagnostics",
    "MonotoneQuartic",
    "MonotoneQuintic",
    "MonotoneRecord",
    "MonotoneReport",
    "MonotoneRows",
    "MonotoneSmoothing",
    "MonotoneSpline",
    "NodeRecord",
    "NuSpline",
    "OscillationRecord",
    "PiecewiseBezier",
    "PiecewisePolynomial",
    "PiecewiseRows",
    "PolygonShape",
    "SearchStep",
    "ShapeRecord",
    "ShapeReport",
    "SpaceCurve",
    "Tangents",
    "TensionSpline",
    "UndecidedRecord",
    "__version__",
    "bezier_like",
    "check_monotone",
    "check_shape",
    "fairness",
    "fit",
    "fit_many",
    "fit_many_monotone",
    "fit_monotone",
    "histospline",
    "inflection_count",
    "interchange",
    "minimal_bending",
    "plot",
    "polygon_shape",
    "smooth_monotone",
]
