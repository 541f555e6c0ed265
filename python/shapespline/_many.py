# SPDX-License-Identifier: MIT OR Apache-2.0

"""Many curves at once: ``fit_many`` and the collection that it returns."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, overload

from shapespline._core import InputError, _fit_many
from shapespline._methods import METHODS, entry_of, given_options
from shapespline._pickling import sealed

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike

    from shapespline._core import (
        SpaceCurve,
        Tangents,
        _Boundary,
        _Continuity,
        _Criterion,
        _Directions,
        _Energy,
        _Parametrization,
        _Strategy,
    )

# Every option that some method has: the compiled part takes them all.
_ALL = {
    name: default
    for method in METHODS.values()
    for name, default in {**method.options, **method.given}.items()
}


class Fits(Sequence["SpaceCurve | None"]):
    """The curves of a collection, in order, and what went wrong: made by `fit_many`.

    A sequence: ``fits[k]`` is the curve through the points ``offsets[k]`` to ``offsets[k + 1]``, or
    ``None`` where there is none. Immutable and picklable.

    Attributes
    ----------
    errors : Mapping[int, Exception]
        The exception of each curve that failed, by its index: an `InputError` for unusable points,
        whose ``index`` begins with that of the curve; a `ConvergenceError`, which carries the last
        curve and its report, where the limit of iterations was reached.
    ok : bool
        Whether no curve failed.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0], [1, 1], [2, 0], [5, 5], [5, 5], [0, 1], [1, 0], [2, 2]]
    >>> fits = ss.fit_many(points, [0, 3, 5, 8])
    >>> fits
    <Fits: 3 curves, 1 of them failed>
    >>> fits[2].check().ok, fits[1]
    (True, None)
    >>> print(fits.errors[1])
    curve 1: points[1] repeats points[0]: (5, 5); ...
    """

    __slots__ = ("__weakref__", "_curves", "_errors")

    def __init__(
        self, curves: Iterable[SpaceCurve | None], errors: Mapping[int, Exception]
    ) -> None:
        self._curves = tuple(curves)
        self._errors = MappingProxyType(dict(errors))

    @property
    def errors(self) -> Mapping[int, Exception]:
        """The exception of each curve that failed, by its index; a read-only mapping."""
        return self._errors

    @property
    def ok(self) -> bool:
        """Whether no curve failed."""
        return not self._errors

    @overload
    def __getitem__(self, index: int) -> SpaceCurve | None: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[SpaceCurve | None]: ...
    def __getitem__(self, index: int | slice) -> SpaceCurve | Sequence[SpaceCurve | None] | None:
        """Return the curve of an index, or a tuple of those of a slice."""
        return self._curves[index]

    def __len__(self) -> int:
        """Return the number of curves, failed ones included."""
        return len(self._curves)

    def __repr__(self) -> str:
        """Return the number of curves and of those that failed."""
        failed = f", {len(self._errors)} of them failed" if self._errors else ""
        return f"<Fits: {len(self._curves)} curves{failed}>"

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle as the curves and the exceptions."""
        return sealed(Fits, self._curves, dict(self._errors))


def fit_many(
    points: ArrayLike,
    offsets: ArrayLike,
    *,
    method: Literal["fair", "nu", "tension", "catmull-rom"] = "fair",
    parameters: _Parametrization | float | ArrayLike | None = None,
    shape_preserving: bool = True,
    boundary: _Boundary | Tangents | None = None,
    closed: bool = False,
    repeated: Literal["error", "drop"] = "error",
    errors: Literal["return", "raise"] = "return",
    threads: int | None = None,
    criteria: _Criterion | Iterable[_Criterion] | None = None,
    strategy: _Strategy | None = None,
    step: float | None = None,
    resolution: float | None = None,
    coplanarity: float | None = None,
    collinearity: float | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    energy: _Energy | None = None,
    straight: bool | None = None,
    safety: float | None = None,
    continuity: _Continuity | None = None,
    directions: _Directions | None = None,
    tension: float | None = None,
    tangent_scale: float | None = None,
) -> Fits:
    """Fit the curves of a collection, such as streamlines or tool paths, in parallel.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        The points of all curves, one curve after the other.
    offsets : array_like of int, shape (curves + 1,)
        Curve k goes through ``points[offsets[k]:offsets[k + 1]]``: from 0, never falling, to n.
    method : {"fair", "nu", "tension", "catmull-rom"}
        `FairSpline`, `NuSpline`, `TensionSpline` or `CatmullRom`.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,), optional
        As for the curves; an array holds those of all curves. Default: that of the class.
    shape_preserving : bool
        Whether to keep the shape of each curve's points; else tension is given, which
        `FairSpline` does not have.
    boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents, optional
        The ends of every curve. Default: periodic if ``closed``, else natural.
    closed : bool
        Whether the first point of every curve is also its last, repeated or not: periodic ends, and
        no other. An array of parameters then has one entry more for each curve, that of the return
        to its first point, unless its points repeat it.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: their
        curve fails, or they are left out of it. Indices and arrays of a curve refer to its points
        as given; its ``diagnostics.dropped`` lists those left out.
    errors : {"return", "raise"}
        What becomes of curves that fail: they are ``None``, and their exceptions are in the
        attribute ``errors`` of what is returned; or the first exception is raised. All other
        curves are fitted in either case.
    threads : int, optional
        Number of threads, at least 1; default one for each processor. Results do not depend on it.
    criteria, resolution, coplanarity, collinearity, tolerance
        As for `FairSpline`, and for ``shape_preserving`` of the other classes.
    max_iterations : int, optional
        As for `FairSpline`, ``NuSpline.shape_preserving`` and ``TensionSpline.shape_preserving``.
    energy : {"parametric", "bending"}, optional
        As for `FairSpline`.
    straight : bool, optional
        As for `FairSpline`.
    strategy, step
        As for ``NuSpline.shape_preserving`` and ``TensionSpline.shape_preserving``.
    safety : float, optional
        As for ``CatmullRom.shape_preserving``.
    continuity : {"C1", "G1"}, optional
        As for `CatmullRom`.
    directions : {"balanced", "parametrization"}, optional
        As for ``CatmullRom.shape_preserving``.
    tension : float, optional
        With ``shape_preserving=False``: that of every point of a `NuSpline` or `CatmullRom`.
    tangent_scale : float, optional
        With ``shape_preserving=False``: that of every point of a `TensionSpline`.

    Returns
    -------
    Fits
        A sequence of the curves, ``None`` where one failed, with the attribute ``errors``.

    Raises
    ------
    ValueError
        If ``offsets`` do not fit the points, or an option is outside its range.
    TypeError
        If an argument is of a wrong kind, or an option is not one of the method.
    KeyboardInterrupt
        If Ctrl-C is pressed meanwhile.

    Notes
    -----
    Other Python threads run meanwhile. Each curve is fitted as by its class: algorithm, guarantee
    and sources are there. Cost O(n), and what the violations need.

    Examples
    --------
    >>> import numpy as np
    >>> import shapespline as ss
    >>> rng = np.random.default_rng(0)
    >>> lengths = rng.integers(20, 90, size=10)
    >>> points = rng.normal(size=(lengths.sum(), 3)).cumsum(axis=0)
    >>> fits = ss.fit_many(points, np.r_[0, lengths.cumsum()])
    >>> fits.ok, len(fits), all(curve.check().ok for curve in fits)
    (True, 10, True)
    """
    if errors not in ("return", "raise"):
        text = f"errors must be one of 'return', 'raise'; got {errors!r}"
        raise InputError(text, "errors", value=errors)
    entry = entry_of("method", method)
    if not (shape_preserving or entry.given):
        text = f"shape_preserving must be True with method '{method}', which has no tension to give"
        raise InputError(text, "shape_preserving", value=False)
    options = {
        "criteria": criteria,
        "strategy": strategy,
        "step": step,
        "resolution": resolution,
        "coplanarity": coplanarity,
        "collinearity": collinearity,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "energy": energy,
        "straight": straight,
        "safety": safety,
        "continuity": continuity,
        "directions": directions,
        "tension": tension,
        "tangent_scale": tangent_scale,
    }
    known, where = entry.options, " with shape_preserving=True"
    if not shape_preserving:
        known, where = entry.given, " with shape_preserving=False"
    given = given_options("method", method, options, known, where)
    if parameters is None:
        parameters = entry.parameters
    curves, failed = _fit_many(
        points,
        offsets,
        method,
        parameters,
        boundary,
        closed,
        repeated,
        bool(shape_preserving),
        threads,
        **{**_ALL, **known, **given},
    )
    if failed and errors == "raise":
        raise failed[min(failed)]
    return Fits(curves, failed)
