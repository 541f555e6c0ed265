# SPDX-License-Identifier: MIT OR Apache-2.0

"""The verbs of functions: fit one, make rates from totals, check one of any library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from shapespline import _core
from shapespline._convert import piecewise
from shapespline._core import InputError, MonotoneCubic
from shapespline._methods import entry_of, given_options

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from shapespline._core import (
        MonotoneQuartic,
        MonotoneQuintic,
        MonotoneReport,
        MonotoneSpline,
        PiecewisePolynomial,
        _Convex,
        _Ends,
        _Extrapolate,
    )

__all__ = ["check_monotone", "fit_monotone", "histospline"]


@overload
def fit_monotone(
    x: ArrayLike,
    y: ArrayLike,
    axis: int = ...,
    *,
    kind: Literal["cubic"] = ...,
    convex: _Convex = ...,
    slopes: ArrayLike | None = ...,
    ends: _Ends | None = ...,
    layer: float | None = ...,
    min_slope: float | None = ...,
    extrapolate: _Extrapolate = ...,
) -> MonotoneCubic: ...
@overload
def fit_monotone(
    x: ArrayLike,
    y: ArrayLike,
    axis: int = ...,
    *,
    kind: Literal["quintic"],
    slopes: Literal["optimal", "fritsch-butland"] | ArrayLike | None = ...,
    energy: Literal["bending", "parametric"] | None = ...,
    clip: bool | None = ...,
    extrapolate: _Extrapolate = ...,
) -> MonotoneQuintic: ...
@overload
def fit_monotone(
    x: ArrayLike,
    y: ArrayLike,
    axis: int = ...,
    *,
    kind: Literal["quartic"],
    slopes: Literal["fritsch-butland"] | ArrayLike | None = ...,
    shape: float | tuple[ArrayLike, ArrayLike] | None = ...,
    extrapolate: _Extrapolate = ...,
) -> MonotoneQuartic: ...
def fit_monotone(
    x: ArrayLike,
    y: ArrayLike,
    axis: int = 0,
    *,
    kind: Literal["cubic", "quintic", "quartic"] = "cubic",
    convex: _Convex = None,
    slopes: str | ArrayLike | None = None,
    ends: _Ends | None = None,
    layer: float | None = None,
    min_slope: float | None = None,
    energy: Literal["bending", "parametric"] | None = None,
    clip: bool | None = None,
    shape: float | tuple[ArrayLike, ArrayLike] | None = None,
    extrapolate: _Extrapolate = "linear",
) -> MonotoneSpline:
    """Interpolate data by a function that rises where they rise and falls where they fall.

    Parameters
    ----------
    x : array_like, shape (n,)
        Strictly increasing, n ≥ 2.
    y : array_like
        Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
    axis : int
        The axis of y that goes with x.
    kind : {"cubic", "quintic", "quartic"}
        `MonotoneCubic`, C² and of the least bending energy; `MonotoneQuintic`, C² with knots at the
        data alone; or `MonotoneQuartic`, C¹ and local.
    slopes : array_like or str, optional
        As for the class.
    convex, ends, layer, min_slope
        Kind ``"cubic"``: as for `MonotoneCubic`.
    energy, clip
        Kind ``"quintic"``: as for `MonotoneQuintic`.
    shape
        Kind ``"quartic"``: as for `MonotoneQuartic`.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        What the function is outside the data, as for `MonotoneCubic`.

    Returns
    -------
    MonotoneCubic, MonotoneQuintic or MonotoneQuartic
        The function.

    Raises
    ------
    ValueError
        If data or an option are unusable.
    TypeError
        If an argument is of a wrong kind, or an option is not one of the kind; the message names
        the kinds that have it.

    See Also
    --------
    fit_many_monotone : many data sets with abscissae of their own at once, in parallel.

    Notes
    -----
    Algorithm, guarantee, cost and sources are those of the class.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.fit_monotone([0, 1, 2, 4], [0, 0, 1, 5])
    >>> f([0.5, 2.0, 4.0])
    array([0., 1., 5.])
    >>> ss.fit_monotone([0, 1, 2, 4], [0, 0, 1, 5], kind="quartic")
    <MonotoneQuartic: 4 knots from 0 to 4, degree 4>
    """
    options = {
        "convex": convex,
        "slopes": slopes,
        "ends": ends,
        "layer": layer,
        "min_slope": min_slope,
        "energy": energy,
        "clip": clip,
        "shape": shape,
    }
    entry = entry_of("kind", kind)
    given = given_options("kind", kind, options, entry.options)
    function: MonotoneSpline = entry.fit(x, y, axis, extrapolate=extrapolate, **given)
    return function


def histospline(
    edges: ArrayLike,
    totals: ArrayLike,
    axis: int = 0,
    *,
    ends: _Ends = "estimated",
    layer: float = 1 / 16,
    min_slope: float = 0.0,
    extrapolate: _Extrapolate = "linear",
) -> PiecewisePolynomial:
    """Turn totals per bin into a continuous rate that is never negative and has these totals.

    Parameters
    ----------
    edges : array_like, shape (n + 1,)
        Ends of the bins, strictly increasing, n ≥ 1.
    totals : array_like
        What came together in every bin, of any shape with n entries along ``axis``; not negative.
        Of means take the means times the widths of their bins.
    axis : int
        The axis of totals that goes with the bins.
    ends, layer, min_slope
        As for `MonotoneCubic`, whose running totals' derivative the rate is.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        As for `MonotoneCubic`: with "linear" the rate outside the bins is that at the end, with
        "clip" it is zero.

    Returns
    -------
    PiecewisePolynomial
        The rate per unit of ``edges``: piecewise quadratic, zero on empty bins, continuous with its
        first derivative. Its integral over every bin is the bin's total.

    Raises
    ------
    ValueError
        If a total is negative or not finite, edges do not increase, or lengths do not agree.
    TypeError
        If an argument is of a wrong kind.

    Notes
    -----
    The derivative of the monotone function of least bending energy through the running totals: of
    all rates that are not negative and have these totals, the one of least ``∫ rate'² dx`` (but for
    ends and layers). Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> rain = ss.histospline([0, 6, 12, 18, 24], [0.0, 3.0, 12.0, 1.0])
    >>> rain(3.0), round(rain.integrate(6, 12), 12)
    (0.0, 3.0)
    """
    limits, amounts = _core._floats("edges", edges), _core._floats("totals", totals)
    if limits.ndim != 1 or limits.size < 2:
        text = f"edges must have one axis of at least 2 entries, got shape {limits.shape}"
        raise InputError(text, "edges", value=limits.shape)
    _finite("edges", limits)
    _increasing("edges", limits)
    if amounts.ndim == 0 or not -amounts.ndim <= axis < amounts.ndim:
        text = f"axis must be an axis of totals of shape {amounts.shape}, got {axis}"
        raise InputError(text, "axis", value=axis)
    if amounts.shape[axis] != limits.size - 1:
        text = (
            f"totals must have one entry per bin along axis {axis}: {limits.size - 1} for "
            f"{limits.size} edges, got {amounts.shape[axis]}"
        )
        raise InputError(text, "totals", value=amounts.shape)
    wrong = ~(np.isfinite(amounts) & (amounts >= 0))
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        place, value = ", ".join(map(str, index)), float(amounts[index])
        text = f"totals[{place}] must be finite and not negative, got {value:g}"
        raise InputError(text, "totals", index if len(index) > 1 else index[0], value)
    nothing = np.zeros_like(np.take(amounts, [0], axis))
    running = np.cumsum(np.concatenate([nothing, amounts], axis), axis)
    total = MonotoneCubic(
        limits, running, axis, ends=ends, layer=layer, min_slope=min_slope, extrapolate=extrapolate
    )
    return total.derivative()


def check_monotone(
    x: ArrayLike,
    y: ArrayLike,
    function: Any,
    *,
    convex: Literal["data"] | ArrayLike | None = None,
    tolerance: float = 1e-9,
) -> MonotoneReport:
    """Decide where a function rises, falls and bends as its data do: exactly, of any library's.

    Parameters
    ----------
    x, y : array_like, shape (n,)
        The data, x strictly increasing, n ≥ 2.
    function : MonotoneSpline, scipy.interpolate.PPoly, BPoly or BSpline, (t, c, k), PiecewiseBezier
        The function, polynomial between breaks anywhere; it runs through the data over their range.
    convex : {"data"} or array_like of int, shape (n - 1,), optional
        What is asked of f'': ``"data"``, the sign of the data's second differences wherever it is
        the same at both ends of a segment; or a sign per segment, 0 where none.
    tolerance : float
        What margin counts as zero.

    Returns
    -------
    MonotoneReport
        ``ok``, ``violations``, ``undecided``, ``segments``, ``counts()``, ``to_dict()``; printed, a
        table. ``ok`` is True with undecided records.

    Raises
    ------
    ValueError
        If the function jumps or does not run through the data, or an argument holds unusable
        values.
    TypeError
        If an argument is of a wrong kind.

    Notes
    -----
    The signs of f' and f'' are decided by certified subdivision of their Bernstein form, with a
    bound of rounding; nothing is sampled. Where that bound hides a sign it is ``undecided``.
    Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> from scipy.interpolate import CubicSpline
    >>> x, y = [0, 1, 2, 3, 4], [0, 0, 0, 1, 1]
    >>> ss.check_monotone(x, y, CubicSpline(x, y)).counts()
    {'monotonicity': (3, 4)}
    >>> ss.check_monotone(x, y, ss.MonotoneCubic(x, y)).ok
    True
    """
    return _core._check_monotone(x, y, piecewise(function), convex, tolerance)


def _finite(argument: str, values: Any) -> None:
    for i in np.flatnonzero(~np.isfinite(values))[:1].tolist():
        text = f"{argument}[{i}] must be finite, got {values[i]:g}"
        raise InputError(text, argument, i, float(values[i]))


def _increasing(argument: str, values: Any) -> None:
    for i in np.flatnonzero(np.diff(values) <= 0)[:1].tolist():
        text = (
            f"{argument}[{i + 1}] must exceed its predecessor {values[i]:g}, got {values[i + 1]:g}"
        )
        raise InputError(text, argument, i + 1, float(values[i + 1]))
