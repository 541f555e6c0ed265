# SPDX-License-Identifier: MIT OR Apache-2.0

"""Methods of compiled classes that are written in Python: `_core` does not know this package."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shapespline._bspline import of_fair_spline
from shapespline._core import FairSpline, ShapeReport
from shapespline.plot import criteria

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from scipy.interpolate import BSpline

__all__: list[str] = []


def _plot(self: ShapeReport, ax: Axes | None = None) -> Axes:
    """Draw which criterion each segment requires, where it is violated, and what stays open.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Where to draw; default a new figure.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ModuleNotFoundError
        If Matplotlib is not installed (``pip install "shapespline[plot]"``).

    See Also
    --------
    shapespline.plot.criteria : the same as a function.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check().plot()
    """
    return criteria(self, ax=ax)


def _to_bspline(self: FairSpline) -> BSpline:
    """Return the curve as a B-spline of SciPy.

    Returns
    -------
    scipy.interpolate.BSpline
        Cubic, with simple knots at the points and at the extra knots, and triple ones at corners.
        Knots and coefficients of a closed curve go around, and it extrapolates periodically.

    Raises
    ------
    ModuleNotFoundError
        If SciPy is not installed (``pip install "shapespline[scipy]"``).

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.FairSpline([[0, 0], [3, 4], [6, 8]]).to_bspline().t
    array([ 0.,  0.,  0.,  0.,  5., 10., 10., 10., 10.])
    """
    from scipy.interpolate import BSpline

    extrapolate = "periodic" if self.boundary == "periodic" else True
    return BSpline(*of_fair_spline(self), 3, extrapolate=extrapolate)


for _class, _method in ((ShapeReport, _plot), (FairSpline, _to_bspline)):
    _method.__name__ = _method.__name__[1:]
    _method.__qualname__ = f"{_class.__name__}.{_method.__name__}"
    setattr(_class, _method.__name__, _method)
