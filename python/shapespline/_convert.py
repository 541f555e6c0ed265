# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves of other libraries as Bézier pieces.

Known by what they have, so that SciPy is not imported: ``t, c, k`` is a B-spline, ``x, c`` a
piecewise polynomial, in the Bernstein basis where the class or one above it is called ``BPoly``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline._core import InputError, MonotoneSpline, PiecewiseBezier, SpaceCurve, _floats

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ACCEPTED = (
    "a shapespline curve, a SciPy BSpline, PPoly or BPoly, a PiecewiseBezier, or an array of "
    "Bézier control points of shape (segments, degree + 1, dim)"
)


def _coefficients(name: str, values: Any, *, leading: int) -> Floats:
    """Return coefficients as floats, with axes (…, dim); one component becomes a last axis of 1."""
    array = _floats(name, values)
    if array.ndim == leading:
        array = array[..., None]
    if array.ndim != leading + 1 or array.shape[-1] not in (1, 2, 3):
        raise InputError(
            f"{name} must belong to a curve in the plane or in space, or to a function; got shape "
            f"{np.shape(values)}",
            name,
            value=np.shape(values),
        )
    return array


def _of_bspline(curve: Any) -> PiecewiseBezier:
    knots = _floats("curve.t", curve.t)
    degree = int(curve.k)
    count = len(knots) - degree - 1
    # SciPy looks at no more than these.
    control = _coefficients("curve.c", curve.c, leading=1)
    control = control[:count] if count > degree else control
    if control.shape[1] == 1:
        # The graph of a function: x is a B-spline with Greville's abscissae.
        if degree < 1:
            raise InputError("degree must be at least 1, got 0", "degree", value=0)
        windows = np.lib.stride_tricks.sliding_window_view(knots[1:-1], degree)
        control = np.column_stack([windows.mean(axis=1)[: len(control)], control])
    return PiecewiseBezier.from_bspline(knots, control, degree)


def _of_powers(curve: Any) -> PiecewiseBezier:
    breaks = _floats("curve.x", curve.x)
    coefficients = _coefficients("curve.c", curve.c, leading=2)
    if coefficients.shape[2] == 1:
        if len(coefficients) < 2:
            coefficients = np.concatenate([np.zeros_like(coefficients), coefficients])
        x = np.zeros_like(coefficients)
        x[-2] = 1.0
        x[-1, :, 0] = breaks[: x.shape[1]]
        coefficients = np.concatenate([x, coefficients], axis=2)
    return PiecewiseBezier.from_power(coefficients, breaks)


def _of_monotone(f: MonotoneSpline) -> PiecewiseBezier:
    """Return the graph of a function of one column."""
    if f.y.ndim != 1:
        text = f"the function must have one column to be a curve, got y of {f.y.shape}"
        raise InputError(text, "curve", value=f.y.shape)
    x, values = np.asarray(f.knots), f._bernstein().T
    t = np.linspace(0.0, 1.0, values.shape[1])
    across = x[:-1, None] * (1 - t) + x[1:, None] * t
    return PiecewiseBezier(np.stack([across, values], axis=2), x)


def _of_bernstein(curve: Any) -> PiecewiseBezier:
    breaks = _floats("curve.x", curve.x)
    control = _coefficients("curve.c", curve.c, leading=2).swapaxes(0, 1)
    if control.shape[2] == 1:
        if control.shape[1] < 2:
            control = np.repeat(control, 2, axis=1)
        t = np.linspace(0.0, 1.0, control.shape[1])
        start, end = breaks[:-1, None], breaks[1:, None]
        x = start * (1 - t) + end * t
        control = np.concatenate([x[: len(control), :, None], control], axis=2)
    return PiecewiseBezier(control, breaks)


def _is_array(curve: Any) -> bool:
    return isinstance(curve, (list, tuple)) or hasattr(curve, "__array__")


def piecewise(curve: Any) -> PiecewiseBezier:
    """Return any accepted curve that knows its parameters as Bézier pieces."""
    if isinstance(curve, PiecewiseBezier):
        return curve
    if isinstance(curve, SpaceCurve):
        return PiecewiseBezier(curve.bezier, curve.knots)
    if isinstance(curve, MonotoneSpline):
        return _of_monotone(curve)
    if all(hasattr(curve, name) for name in ("t", "c", "k")):
        return _of_bspline(curve)
    if hasattr(curve, "x") and hasattr(curve, "c"):
        names = {base.__name__ for base in type(curve).__mro__}
        return _of_bernstein(curve) if "BPoly" in names else _of_powers(curve)
    raise TypeError(f"curve must be {ACCEPTED}; got {type(curve).__name__}")
