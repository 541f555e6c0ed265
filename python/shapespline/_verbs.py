# SPDX-License-Identifier: MIT OR Apache-2.0

"""The verb `fit`: one curve through points that keeps their shape, by any method."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, overload

from shapespline._methods import entry_of, given_options

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from shapespline._core import (
        CatmullRom,
        FairSpline,
        NuSpline,
        SpaceCurve,
        Tangents,
        TensionSpline,
        _Boundary,
        _Continuity,
        _Criterion,
        _Directions,
        _Energy,
        _Parametrization,
        _Strategy,
    )

    _Parameters = _Parametrization | float | ArrayLike | None


@overload
def fit(
    points: ArrayLike,
    parameters: _Parameters = ...,
    *,
    method: Literal["fair"] = ...,
    boundary: _Boundary | Tangents | None = ...,
    closed: bool = ...,
    repeated: Literal["error", "drop"] = ...,
    criteria: _Criterion | Iterable[_Criterion] | None = ...,
    resolution: float | None = ...,
    coplanarity: float | None = ...,
    collinearity: float | None = ...,
    tolerance: float | None = ...,
    max_iterations: int | None = ...,
    energy: _Energy | None = ...,
    corners: Sequence[int] | float | None = ...,
    tangents: Mapping[int, ArrayLike] | None = ...,
    max_deviation: float | None = ...,
    straight: bool | None = ...,
) -> FairSpline: ...
@overload
def fit(
    points: ArrayLike,
    parameters: _Parameters = ...,
    *,
    method: Literal["nu"],
    boundary: _Boundary | Tangents | None = ...,
    closed: bool = ...,
    repeated: Literal["error", "drop"] = ...,
    criteria: _Criterion | Iterable[_Criterion] | None = ...,
    resolution: float | None = ...,
    coplanarity: float | None = ...,
    collinearity: float | None = ...,
    tolerance: float | None = ...,
    max_iterations: int | None = ...,
    strategy: _Strategy | None = ...,
    step: float | None = ...,
) -> NuSpline: ...
@overload
def fit(
    points: ArrayLike,
    parameters: _Parameters = ...,
    *,
    method: Literal["tension"],
    boundary: _Boundary | Tangents | None = ...,
    closed: bool = ...,
    repeated: Literal["error", "drop"] = ...,
    criteria: _Criterion | Iterable[_Criterion] | None = ...,
    resolution: float | None = ...,
    coplanarity: float | None = ...,
    collinearity: float | None = ...,
    tolerance: float | None = ...,
    max_iterations: int | None = ...,
    strategy: _Strategy | None = ...,
    step: float | None = ...,
) -> TensionSpline: ...
@overload
def fit(
    points: ArrayLike,
    parameters: _Parameters = ...,
    *,
    method: Literal["catmull-rom"],
    boundary: _Boundary | Tangents | None = ...,
    closed: bool = ...,
    repeated: Literal["error", "drop"] = ...,
    criteria: _Criterion | Iterable[_Criterion] | None = ...,
    resolution: float | None = ...,
    coplanarity: float | None = ...,
    collinearity: float | None = ...,
    tolerance: float | None = ...,
    safety: float | None = ...,
    continuity: _Continuity | None = ...,
    directions: _Directions | None = ...,
) -> CatmullRom: ...
def fit(
    points: ArrayLike,
    parameters: _Parameters = None,
    *,
    method: Literal["fair", "nu", "tension", "catmull-rom"] = "fair",
    boundary: _Boundary | Tangents | None = None,
    closed: bool = False,
    repeated: Literal["error", "drop"] = "error",
    criteria: _Criterion | Iterable[_Criterion] | None = None,
    resolution: float | None = None,
    coplanarity: float | None = None,
    collinearity: float | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    energy: _Energy | None = None,
    corners: Sequence[int] | float | None = None,
    tangents: Mapping[int, ArrayLike] | None = None,
    max_deviation: float | None = None,
    straight: bool | None = None,
    strategy: _Strategy | None = None,
    step: float | None = None,
    safety: float | None = None,
    continuity: _Continuity | None = None,
    directions: _Directions | None = None,
) -> SpaceCurve:
    """Fit a curve through points that keeps their shape.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,), optional
        Parameters of the points, as for the class of the method. Default: that of the class.
    method : {"fair", "nu", "tension", "catmull-rom"}
        What is fitted: a `FairSpline`, the fairest; `NuSpline` or `TensionSpline`, which have a
        tension at each point; or a `CatmullRom`, which is local.
    boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents, optional
        The ends, as for the class. Default: periodic if ``closed``, else natural.
    closed : bool
        Whether the first point is also the last, repeated or not.
    repeated : {"error", "drop"}
        What becomes of points that repeat the one before them, as for the class.
    criteria, resolution, coplanarity, collinearity, tolerance
        What to keep, and how exactly, as for `FairSpline`.
    max_iterations : int, optional
        Method ``"fair"``, ``"nu"`` or ``"tension"``: the largest number of iterations.
    energy : {"parametric", "bending"}, optional
        Method ``"fair"``: as for `FairSpline`.
    corners, tangents, max_deviation, straight
        Method ``"fair"``: as for `FairSpline`.
    strategy, step
        Method ``"nu"`` or ``"tension"``: as for ``NuSpline.shape_preserving`` and
        ``TensionSpline.shape_preserving``.
    safety : float, optional
        Method ``"catmull-rom"``: as for ``CatmullRom.shape_preserving``.
    continuity : {"C1", "G1"}, optional
        Method ``"catmull-rom"``: as for `CatmullRom`.
    directions : {"balanced", "parametrization"}, optional
        Method ``"catmull-rom"``: as for ``CatmullRom.shape_preserving``.

    Returns
    -------
    FairSpline, NuSpline, TensionSpline or CatmullRom
        The curve; its ``check()`` reports on every criterion.

    Raises
    ------
    ConvergenceError
        If no curve was found that keeps the shape; it carries the last curve and its report.
    ValueError
        If points, parameters or an option are unusable.
    TypeError
        If an argument is of a wrong kind, or an option is not one of the method; the message names
        the methods that have it.
    KeyboardInterrupt
        If Ctrl-C is pressed meanwhile.

    See Also
    --------
    fit_many : many curves at once, in parallel.

    Notes
    -----
    Algorithm, guarantee, cost and sources are those of the class.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> curve = ss.fit(points)
    >>> curve.check().ok
    True
    >>> ss.fit(points, method="tension")
    <TensionSpline: 5 points in space, no tension; u from 0 to 9.91421, boundary zero-curvature>
    """
    options = {
        "criteria": criteria,
        "resolution": resolution,
        "coplanarity": coplanarity,
        "collinearity": collinearity,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "energy": energy,
        "corners": corners,
        "tangents": tangents,
        "max_deviation": max_deviation,
        "straight": straight,
        "strategy": strategy,
        "step": step,
        "safety": safety,
        "continuity": continuity,
        "directions": directions,
    }
    entry = entry_of("method", method)
    given = given_options("method", method, options, {**entry.options, **entry.alone})
    chosen = entry.parameters if parameters is None else parameters
    if boundary is not None:
        given["boundary"] = boundary
    curve: SpaceCurve = entry.fit(points, chosen, closed=closed, repeated=repeated, **given)
    return curve
