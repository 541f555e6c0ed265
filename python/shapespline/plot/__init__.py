# SPDX-License-Identifier: MIT OR Apache-2.0

"""Figures of curves, functions and shape reports, with Matplotlib.

Every function draws into the Axes ``ax``, or into a new figure, and returns the Axes: set titles,
limits and styles on it as on any other, or call the next function with it. Matplotlib is imported
when a function is called (``pip install "shapespline[plot]"``).

>>> import matplotlib
>>> matplotlib.use("Agg")
>>> import shapespline as ss
>>> ax = ss.plot.curve(ss.NuSpline([[0, 0], [1, 1], [2, 0]]))
>>> ax.get_title()
''
"""

from shapespline.plot._curves import curvature, curvature_comb, curve, torsion
from shapespline.plot._functions import interpolant
from shapespline.plot._report import criteria
from shapespline.plot._style import CURVE, DATA, OPEN, WRONG

__all__ = [
    "CURVE",
    "DATA",
    "OPEN",
    "WRONG",
    "criteria",
    "curvature",
    "curvature_comb",
    "curve",
    "interpolant",
    "torsion",
]
