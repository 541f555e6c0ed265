# SPDX-License-Identifier: MIT OR Apache-2.0

# The types of the compiled module. Signatures are written here and held by stubtest; docstrings are
# written in Rust (crates/shapespline-python), copied by `python .ci/stub.py` once the extension is
# built, and held by tests/test_docstrings.py. They are here because editors read only this file.

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, NoReturn, TypedDict, final, overload

import numpy as np
import pandas as pd  # type: ignore[import-untyped, unused-ignore]
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import (  # type: ignore[import-untyped, unused-ignore]
    BPoly,
    BSpline,
    PPoly,
)
from typing_extensions import Self, disjoint_base

__version__: str
_NAMES: dict[str, list[str]]

__all__ = [
    "_NAMES",
    "CatmullRom",
    "ConvergenceError",
    "Diagnostics",
    "FairDiagnostics",
    "FairSpline",
    "FairStep",
    "Fairness",
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
    "SearchStep",
    "ShapeRecord",
    "ShapeReport",
    "SpaceCurve",
    "Tangents",
    "TensionSpline",
    "UndecidedRecord",
    "__version__",
    "_check_monotone",
    "_check_shape",
    "_curve_inflections",
    "_fit_many",
    "_floats",
    "_from_bytes",
    "_polygon_inflections",
    "_polygon_shape",
    "bezier_like",
    "fit_many_monotone",
    "minimal_bending",
    "smooth_monotone",
]

_Floats = NDArray[np.float64]
_Side = Literal["left", "right"]
_Criterion = Literal[
    "convexity",
    "inflection",
    "turning",
    "torsion",
    "coplanarity",
    "collinearity",
    "global-convexity",
    "regular",
]
_Boundary = Literal["zero-curvature", "natural", "periodic", "circular"]
_Strategy = Literal["nussp", "growth", "fairest", "reduction"]
_Continuity = Literal["C1", "G1"]
_Energy = Literal["parametric", "bending"]
_Directions = Literal["balanced", "parametrization"]
_Parametrization = Literal["uniform", "chordal", "centripetal"]
# An array or nested lists: what gives an array back where one number gives a number.
_Many = NDArray[np.generic] | Sequence[float] | Sequence[Sequence[float]]

class _Count(TypedDict):
    violated: int
    applicable: int

class _Record(TypedDict):
    segment: int
    criterion: _Criterion
    applicable: bool
    satisfied: bool
    margin: float | None
    location: float | None

class _Undecided(TypedDict):
    segment: int
    criterion: _Criterion
    interval: list[float]

class _Report(TypedDict):
    ok: bool
    margin: float | None
    counts: dict[_Criterion, _Count]
    resolution: float
    coplanarity: float
    collinearity: float
    tolerance: float
    segments: list[_Record]
    violations: list[_Record]
    undecided: list[_Undecided]
    straight: list[int]

class InputError(ValueError):
    """An argument that cannot be used; the text says which, where, what it must be and what it is.

    Attributes
    ----------
    argument : str
        Name of the argument.
    index : int, tuple of int, or None
        Where in the argument; of a collection, the index of the curve or row comes first.
    value : object
        The value there: a number, a name, a shape, or what was measured of it.

    Examples
    --------
    >>> import shapespline as ss
    >>> try:
    ...     ss.NuSpline([[0, 0], [1, 1], [2, float("nan")]])
    ... except ss.InputError as error:
    ...     print(error.argument, error.index, error.value)
    points 2 nan
    """

    argument: str
    index: int | tuple[int, ...] | None
    value: Any
    def __init__(
        self,
        message: str,
        argument: str = "",
        index: int | tuple[int, ...] | None = None,
        value: Any = None,
    ) -> None: ...

class ConvergenceError(RuntimeError):
    """No curve was found that keeps the shape of its points.

    The limit of iterations was reached first, or tension can rise no further where a criterion is
    violated: ``curve.diagnostics.status`` says which.

    Attributes
    ----------
    curve : SpaceCurve
        The last curve: it interpolates the points, but violates what ``report`` lists.
    report : ShapeReport
        The complete check of that curve.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> try:
    ...     ss.NuSpline.shape_preserving(points, "uniform", max_iterations=1)
    ... except ss.ConvergenceError as error:
    ...     print(len(error.report.violations), error.curve.tension)
    6 [0. 0. 0. 0. 0.]
    """

    curve: SpaceCurve
    report: ShapeReport
    def __init__(self, message: str, curve: SpaceCurve, report: ShapeReport) -> None: ...

@disjoint_base
class SpaceCurve:
    """A curve through points in space or in the plane: the base of all families.

    Not made directly: use `FairSpline`, `NuSpline`, `TensionSpline` or `CatmullRom`. A curve is immutable, compares and hashes by identity, can be
    pickled and copied, and may be used from several threads at once.

    Examples
    --------
    >>> import shapespline as ss
    >>> curve = ss.NuSpline([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]])
    >>> isinstance(curve, ss.SpaceCurve)
    True
    >>> curve([0.0, 0.5]).shape
    (2, 3)
    """
    def __new__(cls) -> Self: ...
    @property
    def points(self) -> _Floats:
        """The points that the curve interpolates, shape (n, dim); a fresh array.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [1, 2]]).points
        array([[0., 0.],
               [1., 2.]])
        """
    @property
    def parameters(self) -> _Floats:
        """The parameters of the points, increasing, shape (n,); a fresh array.

        A point that was left out (``repeated="drop"``) has the parameter of the point it repeats.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4], [3, 5]]).parameters
        array([0., 5., 6.])
        """
    @property
    def knots(self) -> _Floats:
        """The parameters at which the pieces of the curve meet, strictly increasing; a fresh array.

        Those of the points, but for points that were left out, and the extra knots of a `FairSpline`: one
        more than ``bezier`` has pieces.

        Examples
        --------
        >>> import shapespline as ss
        >>> curve = ss.NuSpline([[0, 0], [3, 4], [3, 4], [3, 5]], repeated="drop")
        >>> curve.knots, curve.parameters
        (array([0., 5., 6.]), array([0., 5., 5., 6.]))
        """
    @property
    def tangents(self) -> _Floats:
        """The first derivatives at the points, shape (n, dim), in units of the points over units of the
        parameter; a fresh array.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4]]).tangents
        array([[0.6, 0.8],
               [0.6, 0.8]])
        """
    @property
    def tension(self) -> _Floats:
        """The tension at each point, shape (n,), without unit: 0 is none, and more of it pulls the curve
        towards the polygon; a fresh array.

        For a ν-spline this is ν, for a `TensionSpline` 1/λ − 1 (of the smaller λ beside the point), and
        for a `CatmullRom` the part by which its handles were shortened. Of closed data the first and the last point are one node and have
        one tension.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4], [3, 5]], tension=2).tension
        array([2., 2., 2.])
        """
    @property
    def boundary(self) -> Literal["zero-curvature", "periodic", "circular"] | Tangents:
        """The end conditions: ``"zero-curvature"``, ``"periodic"``, ``"circular"`` or a `Tangents`.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4]], boundary="natural").boundary
        'zero-curvature'
        """
    @property
    def bezier(self) -> _Floats:
        """Bézier points of the segments, shape (segments, 4, dim); a fresh array.

        Each segment is run through linearly in its interval of the parameter, except by a
        `TensionSpline`, which has a parameter of its own: see its ``image_parameter``.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 6]]).bezier
        array([[[0., 0.],
                [1., 2.],
                [2., 4.],
                [3., 6.]]])
        """
    @property
    def diagnostics(self) -> Diagnostics | None:
        """What the search took and which points were left out, a `Diagnostics`, or a `FairDiagnostics` of a
        `FairSpline`; ``None`` for a curve of given tension, unless it was made with
        ``repeated="drop"``.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline.shape_preserving([[0, 0], [3, 4], [3, 5]]).diagnostics.status
        'solved'
        """
    @property
    def history(self) -> list[SearchStep] | None:
        """The steps of the search, a list of `SearchStep`, or of `FairStep` of a `FairSpline`; ``None`` for
        a curve of given tension.

        Examples
        --------
        >>> import shapespline as ss
        >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
        >>> steps = ss.NuSpline.shape_preserving(points, "uniform").history
        >>> steps[0].violations, steps[-1].violations
        (2, 0)
        """
    def __call__(self, u: ArrayLike, nu: int = 0, *, side: _Side = "right") -> _Floats:
        """Evaluate the curve or a derivative.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape. Outside the parameters of the points the end polynomials go on;
            on a closed curve the parameter wraps around. NaN gives NaN.
        nu : int
            Order of the derivative with respect to u; 0 gives positions. (The ν of ν-splines is
            called ``tension``.)
        side : {"right", "left"}
            Which segment counts at the parameter of a point, where derivatives may jump.

        Returns
        -------
        numpy.ndarray, shape (*u.shape, dim)
            In units of the points over units of the parameter to the power ``nu``.

        Raises
        ------
        ValueError
            If ``nu`` is negative (of a `TensionSpline`, or above 3) or ``side`` unknown.
        TypeError
            If ``u`` does not hold real numbers.

        Notes
        -----
        Cost O(log n) for one parameter, O(1) each for many; many run on all threads.

        Examples
        --------
        >>> import shapespline as ss
        >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
        >>> curve(2.5)
        array([1.5, 2. ])
        >>> curve([[0, 5], [10, 15]], 1).shape
        (2, 2, 2)
        """
    @overload
    def curvature(self, u: float, *, side: _Side = "right") -> float:
        """Curvature κ = ‖γ′ × γ″‖ / ‖γ′‖³, in reciprocal units of the points.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape.
        side : {"right", "left"}
            Which segment counts at the parameter of a point. (κ of a ν-spline or a
            C² tension cubic does not jump.)

        Returns
        -------
        float or numpy.ndarray, shape u.shape
            Never negative, in the plane as well; NaN where γ′ = 0.

        Examples
        --------
        >>> import numpy as np
        >>> import shapespline as ss
        >>> angle = np.linspace(0, 2 * np.pi, 101)
        >>> circle = 2 * np.column_stack([np.cos(angle), np.sin(angle)])
        >>> circle[-1] = circle[0]
        >>> round(ss.NuSpline(circle, boundary="periodic").curvature(1.0), 3)
        0.5
        """
    @overload
    def curvature(self, u: _Many, *, side: _Side = "right") -> _Floats: ...
    @overload
    def curvature(self, u: ArrayLike, *, side: _Side = "right") -> float | _Floats: ...
    def curvature_vector(self, u: ArrayLike, *, side: _Side = "right") -> _Floats:
        """Curvature vector dT/ds: curvature times principal normal, in reciprocal units of the points.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape.
        side : {"right", "left"}
            Which segment counts at the parameter of a point.

        Returns
        -------
        numpy.ndarray, shape (*u.shape, dim)
            Zero on a line; NaN where γ′ = 0.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4], [6, 8]]).curvature_vector(1.0).shape
        (2,)
        """
    @overload
    def torsion(self, u: float, *, side: _Side = "right") -> float:
        """Torsion τ = det[γ′, γ″, γ‴] / ‖γ′ × γ″‖², in reciprocal units of the points.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape.
        side : {"right", "left"}
            Which segment counts at the parameter of a point, where torsion jumps.

        Returns
        -------
        float or numpy.ndarray, shape u.shape
            Positive where the curve twists like a right-handed screw; zero in the plane; NaN where the
            curvature vanishes.

        Examples
        --------
        >>> import numpy as np
        >>> import shapespline as ss
        >>> t = np.linspace(0, 6, 601)
        >>> helix = np.column_stack([np.cos(t), np.sin(t), t])
        >>> round(ss.NuSpline(helix, boundary="circular").torsion(4.001), 2)
        0.5
        """
    @overload
    def torsion(self, u: _Many, *, side: _Side = "right") -> _Floats: ...
    @overload
    def torsion(self, u: ArrayLike, *, side: _Side = "right") -> float | _Floats: ...
    def frame(self, u: ArrayLike, side: _Side = "right") -> tuple[_Floats, _Floats, _Floats]:
        """Return the Frenet frame: unit tangent T, principal normal N and binormal B = T × N.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape.
        side : {"right", "left"}
            Which segment counts at the parameter of a point.

        Returns
        -------
        T, N, B : numpy.ndarray, shape (*u.shape, 3)
            Three components also for curves in the plane, whose B is (0, 0, ±1). N and B are NaN where
            the curvature vanishes.

        Examples
        --------
        >>> import shapespline as ss
        >>> T, N, B = ss.NuSpline([[0, 0], [1, 1], [2, 0]]).frame(0.5)
        >>> B
        array([ 0.,  0., -1.])
        """
    def arc_length(self, a: float | None = None, b: float | None = None) -> float:
        """Length of the curve between two parameters, in units of the points.

        Parameters
        ----------
        a, b : float, optional
            Parameters; default the first and the last. With ``a > b`` the length is negative. Outside
            an open curve the end polynomials are measured; a closed curve is gone around.

        Returns
        -------
        float

        Raises
        ------
        ValueError
            If ``a`` or ``b`` is not finite.

        Notes
        -----
        Adaptive Gauss–Legendre quadrature with ten points, each segment to 1e-13 of the length of its
        Bézier polygon. Cost O(n).

        Examples
        --------
        >>> import shapespline as ss
        >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
        >>> round(curve.arc_length(), 12), round(curve.arc_length(5, 0), 12)
        (10.0, -5.0)
        """
    def sample(self, n: int, by: Literal["parameter", "arc-length"] = "parameter") -> _Floats:
        """Points on the curve from its first to its last point, evenly spaced.

        Parameters
        ----------
        n : int
            Number of points, at least 1.
        by : {"parameter", "arc-length"}
            What is even.

        Returns
        -------
        numpy.ndarray, shape (n, dim)

        Raises
        ------
        ValueError
            If ``n`` is less than 1 or ``by`` unknown.

        Notes
        -----
        By arc length, each sample takes a few steps of Newton's method kept in a bracket.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4], [6, 8]]).sample(3, by="arc-length").round(12)
        array([[0., 0.],
               [3., 4.],
               [6., 8.]])
        """
    def to_bspline(self) -> BSpline:
        """Return the curve as a B-spline of SciPy.

        Returns
        -------
        scipy.interpolate.BSpline
            Cubic, with triple interior knots, whose coefficients are the Bézier points: the same curve
            to the last rounding. Closed curves extrapolate periodically. Of a `TensionSpline` it is
            the same image, but the parameter is that of its ``image_parameter``. A `FairSpline` gives
            simple knots.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is not installed (``pip install "shapespline[scipy]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
        >>> curve.to_bspline()(2.5)
        array([1.5, 2. ])
        """
    def to_ppoly(self) -> PPoly:
        """Return the curve as a piecewise polynomial of SciPy.

        Returns
        -------
        scipy.interpolate.PPoly
            Cubic, converted by SciPy from the Bézier points. Closed curves extrapolate periodically.
            Of a `TensionSpline` it is the same image, but the parameter is that of its
            ``image_parameter``.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is not installed (``pip install "shapespline[scipy]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
        >>> curve.to_ppoly()(5.0, 1)
        array([0.6, 0.8])
        """
    def fairness(self) -> Fairness:
        """Measure how fair the curve is: bending, variation and extrema of its curvature.

        Returns
        -------
        Fairness
            Six measures, and the parameters of cusps and corners.

        See Also
        --------
        fairness : the same of any curve, with the definitions.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.NuSpline([[0, 0], [3, 4]]).fairness().length
        5.0
        """
    def check(
        self,
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        *,
        resolution: float | None = None,
        coplanarity: float | None = None,
        collinearity: float | None = None,
        tolerance: float | None = None,
    ) -> ShapeReport:
        """Check whether the curve keeps the shape of its points.

        Parameters
        ----------
        criteria : str or iterable of str, optional
            Any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``, ``"coplanarity"``,
            ``"collinearity"``, ``"global-convexity"`` and ``"regular"``. Default of a shape-preserving
            curve: those it was fitted with; else all but the last two. Whether the curve is regular,
            γ' ≠ 0, is asked in any case, and listed where it is not.
        resolution : float, optional
            Accuracy of the points, in their units: what a move of the points by that much could undo is not
            asked for. Default: that of the fit, else 0.
        coplanarity, collinearity : float, optional
            ε₁ and ε₀ in (0, 1]: sine of the largest angle between binormal and plane normal where four
            points lie in a plane, and between tangent and line where three lie on a line. Default:
            those of the fit, else 0.2.
        tolerance : float, optional
            In [0, 1): points whose turning angle has a smaller sine count as collinear, and four whose
            unit chords span a smaller volume as coplanar. Default: that of the fit, else 1e-9.

        Returns
        -------
        ShapeReport
            The violations, counts, and margins of all segments.

        Raises
        ------
        ValueError
            If a criterion is unknown or a tolerance outside its range.

        Notes
        -----
        Every criterion is decided exactly, from the Bézier legs of each cubic segment; nothing is
        sampled. Karavelas & Kaklis, Numer. Algorithms 23 (2000), Problem (P) and (5.34)–(5.57), with
        inflection added; turning at the points is (i.3) of Manni, *Parametric shape-preserving spatial
        interpolation and ν-splines* (2001), with (12.1) of Gautam. Where the points double back on
        themselves a shape-preserving curve may have to stop, and its own check lets it, unless
        ``"regular"`` is named. Cost O(n), on all threads for long curves.

        Examples
        --------
        >>> import shapespline as ss
        >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
        >>> ss.NuSpline(points, "uniform").check().counts()["convexity"]
        (2, 2)
        >>> ss.NuSpline.shape_preserving(points, "uniform").check().ok
        True
        """
    def _fit_options(self) -> dict[str, Any] | None:
        """Return the options of the fit by the names of `check`, `None` for given tension. For files."""
    def _discrete_torsion(self) -> _Floats:
        """Discrete torsion of the data on each segment, in reciprocal units of the points, shape
        (segments,); NaN where there is none. For figures.
        """
    def __copy__(self) -> SpaceCurve: ...
    def __deepcopy__(self, _memo: object) -> SpaceCurve: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class FairSpline(SpaceCurve):
    """Fair curve: a C² cubic through points that keeps their shape with no more energy than that needs.

    Each segment has at most two extra knots. Where the plain C² cubic keeps the shape, the curve of
    least parametric energy is the plain cubic.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
        Parameters of the points: by name, as the exponent e of ``u[i+1] - u[i] = ‖points[i+1] -
        points[i]‖**e``, or strictly increasing numbers.
    boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
        No second derivative at both ends (two names); closed data, whose last point is the first; end
        tangents of the circles through the first and the last three points; or given tangents at both
        ends or at one.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
        parameters then have one entry more, for the return to the first point, unless the points repeat
        it; so have ``points`` and all other attributes.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case;
        ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
        nothing of them.
    energy : {"parametric", "bending"}
        What is minimised: ``∫|Q''|² du``, or ``∫κ² ds``, which is fairer where chords are uneven. A mended
        stretch that nearly stops minimises ``∫κ² ds`` in either case.
    criteria : str or iterable of str, optional
        What to keep, as for ``NuSpline.shape_preserving``.
    resolution : float
        The accuracy of the points, a length: what a move of the points by that much could undo is not
        asked for.
    coplanarity, collinearity, tolerance : float
        As for the method ``check``.
    max_iterations : int, optional
        Largest number of Newton steps; by default each phase has a limit of its own.
    corners : sequence of int or float, optional
        Points at which the curve has a corner: their indices, or as a float the turning angle in radians
        from which on points are corners. The data are split there; each part has natural ends at its
        corners, and the criteria ask for nothing there. Given end tangents hold at the ends of the whole.
    tangents : dict of int to array_like, optional
        Directions of the curve at points, by index; lengths do not matter. Those on the wrong side of a
        chord are refused. Where no curve keeps the shape with them, the nearest directions are taken with
        which it does, and ``diagnostics.turned`` says by how much they differ.
    straight : bool
        Whether the curve is exactly straight along collinear runs of three and more points. Where a run
        ends in a turn the curve has no curvature and its tangent lies along the run; turning and torsion are
        asked as ≥ 0 there, and reports say ``straight``. A turn in which two runs meet has to be a corner.
    max_deviation : float, optional
        How far at most the curve lies from the chord between its points, a length above a millionth of the
        longest chord: control points are held within it, and with them the curve.

    Raises
    ------
    ConvergenceError
        If some criterion is violated in the end; it carries the last curve and its report.
    ValueError, TypeError
        As for `NuSpline`, and for options outside their ranges.
    KeyboardInterrupt
        If Ctrl-C is pressed meanwhile.

    Notes
    -----
    The unknowns are first and second derivatives at the points; every criterion is a polynomial
    inequality in them, and an interior-point method finds a local minimum. The exact check of the
    control points has the last word. Cost: one solve and check of the plain cubic, O(n), and then what
    the failing segments need; with the bending energy some tens of Newton steps of O(n) each.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 1], [1, 0], [2, 0], [3, 0.01], [4, 0.03], [5, 1]]
    >>> curve = ss.FairSpline(points)
    >>> curve.check().ok
    True
    >>> curve.diagnostics.method
    'elastic'
    """
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "natural",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        energy: _Energy = "parametric",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        resolution: float = 0.0,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
        max_iterations: int | None = None,
        corners: Sequence[int] | float | None = None,
        tangents: Mapping[int, ArrayLike] | None = None,
        max_deviation: float | None = None,
        straight: bool = False,
    ) -> FairSpline: ...
    @property
    def corners(self) -> tuple[int, ...]:
        """The points at which the curve has corners, a tuple of indices.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.FairSpline([[0, 0], [2, 0], [2, 2], [3, 3]], corners=1.5).corners
        (1,)
        """
    @property
    def straight(self) -> tuple[int, ...]:
        """The segments on which the curve is straight by construction, a tuple of indices.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.FairSpline([[0, 0], [1, 0], [3, 0], [4, 1]], straight=True).straight
        (0, 1)
        """
    @property
    def energy(self) -> _Energy:
        """What was minimised: ``"parametric"`` or ``"bending"``.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.FairSpline([[0, 0], [3, 4], [3, 5]]).energy
        'parametric'
        """
    @property
    def diagnostics(self) -> FairDiagnostics | None: ...  # type: ignore[override]
    @property
    def history(self) -> list[FairStep] | None: ...  # type: ignore[override]
    def to_bspline(self) -> BSpline:
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
    def __copy__(self) -> FairSpline: ...
    def __deepcopy__(self, _memo: object) -> FairSpline: ...

@final
class FairDiagnostics:
    """How a `FairSpline` was found, and what it came to.

    Attributes
    ----------
    status : str
        ``"solved"``: no criterion is violated, and ``check().undecided`` is empty but for signs that
        rounding hides in nearly degenerate data. Curves that a `ConvergenceError` carries say
        ``"iteration-limit"``.
    method : str
        The rung of the ladder that the hardest part needed: ``"cubic"`` (the plain C² cubic keeps the
        shape), ``"elastic"``, ``"windows"``, ``"sweeps"`` or ``"start"``.
    iterations : int
        Newton steps.
    solves : int
        Linear systems solved.
    energy : float
        The energy that was asked for, in the user's units.
    energy_cubic : float
        That energy of the plain C² cubic with the same parameters and ends.
    gap : float or None
        ``energy / energy_cubic - 1``: no curve through the points has less parametric energy than the
        plain cubic. ``None`` with ``energy="bending"``, where given tangents were shortened, and where
        the cubic is a line.
    active : dict
        The criteria that hold the curve back, each with the segments where it does.
    dropped : tuple of int
        Indices of the points that were left out (``repeated="drop"``).
    tangent_scale : tuple of float
        By how much given end tangents were shortened, where no curve of their length keeps the shape, at
        the start and at the end: 1 where they were not.
    turned : dict
        Where no curve was found that keeps the shape in the directions ``tangents=``: the points at which it
        has the nearest that were, each with the angle between the two in radians.
    extra_knots : int
        Knots beside those at the points.
    max_curvature : float
        The largest curvature, per unit of length.

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.FairSpline([[0, 0], [3, 4], [3, 5]]).diagnostics
    FairDiagnostics(status='solved', method='cubic', iterations=0, extra_knots=0)
    """
    @property
    def status(self) -> Literal["solved", "iteration-limit", "interrupted"]:
        """``"solved"`` or ``"iteration-limit"``."""
    @property
    def method(self) -> Literal["cubic", "elastic", "windows", "sweeps", "start"]:
        """The rung of the ladder that the hardest part needed."""
    @property
    def iterations(self) -> int:
        """Number of Newton steps, in all windows together."""
    @property
    def solves(self) -> int:
        """Number of linear systems solved."""
    @property
    def energy(self) -> float:
        """The energy that was asked for, in the user's units."""
    @property
    def energy_cubic(self) -> float:
        """That of the plain C² cubic with the same parameters and ends."""
    @property
    def gap(self) -> float | None:
        """How far the parametric energy lies above its lower bound; ``None`` with the bending energy."""
    @property
    def active(self) -> dict[_Criterion, list[int]]:
        """The criteria that hold the curve back, each with the segments where it does; a fresh dict."""
    @property
    def dropped(self) -> tuple[int, ...]:
        """Indices of the points that were left out, ascending (``repeated="drop"``)."""
    @property
    def tangent_scale(self) -> tuple[float, float]:
        """By how much given end tangents were shortened, at the start and at the end: 1 where they were not."""
    @property
    def turned(self) -> dict[int, float]:
        """The points at which the curve has another direction than was asked for, each with the angle between
        the two; a fresh dict.
        """
    @property
    def extra_knots(self) -> int:
        """Knots beside those at the points."""
    @property
    def max_curvature(self) -> float:
        """The largest curvature, per unit of length."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class FairStep:
    """One phase of the search for a `FairSpline`, on one window.

    Attributes
    ----------
    phase : str
        ``"elastic"``: pulling a failing curve into shape; ``"restart"``: from the closed-form start where
        that stopped short; ``"improve"``: bringing the energy down.
    violations : int
        Segments of the window that failed when the phase began.
    iterations : int
        Newton steps that it took.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 1], [1, 0], [2, 0], [3, 0.01], [4, 0.03], [5, 1]]
    >>> ss.FairSpline(points).history[0]
    FairStep(phase='elastic', violations=..., iterations=...)
    """
    @property
    def phase(self) -> Literal["elastic", "restart", "improve"]:
        """``"elastic"``, ``"restart"`` or ``"improve"``."""
    @property
    def violations(self) -> int:
        """Segments of the window that failed when the phase began."""
    @property
    def iterations(self) -> int:
        """Newton steps that it took."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class NuSpline(SpaceCurve):
    """ν-spline: a curve with continuous tangent and curvature (G²) through points, with tension.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
        Parameters of the points: by name, as the exponent e in [0, 1] of ``u[i+1] - u[i] = ‖points[i+1] -
        points[i]‖**e``, or strictly increasing numbers.
    boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents
        Zero curvature at both ends (two names); closed data, whose last point is the first; end
        tangents of the circles through the first and the last three points; or given end tangents.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
        parameters then have one entry more, for the return to the first point, unless the points repeat
        it; so have ``points`` and all other attributes.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case;
        ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
        nothing of them.
    tension : float or array_like, shape (n,)
        ν ≥ 0, without unit: 0 gives the C² cubic spline, and growing tension pulls the curve to the
        polygon. Of closed data, the first and the last entry must agree.

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
        parameters that do not increase, negative tension, unknown names. The message says where.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    NuSpline.shape_preserving : finds the tension that the shape of the points needs.

    Notes
    -----
    The tangents q solve the tridiagonal system (3.3)–(3.11) of Karavelas & Kaklis, *Spatial
    shape-preserving interpolation using ν-splines*, Numer. Algorithms 23 (2000) 217–250, for
    ``Q''(u+) - Q''(u-) = ν q / sqrt(h h')``. It is strictly diagonally dominant: the curve exists and
    is unique for every ν ≥ 0. Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> curve = ss.NuSpline(points, tension=[0, 3, 1, 3, 0])
    >>> curve
    <NuSpline: 5 points in space, tension up to 3 at 3 of them; ...>
    >>> curve(4.0)
    array([4., 0., 0.])
    """
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "zero-curvature",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        tension: float | ArrayLike = 0.0,
    ) -> NuSpline: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "zero-curvature",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        strategy: _Strategy = "fairest",
        step: float = 0.5,
        resolution: float = 0.0,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
        max_iterations: int | None = None,
    ) -> NuSpline:
        """Fit the ν-spline whose tension keeps the shape of the points.

        Tension is raised at the nodes around each violation until no criterion fails; then, by
        default, it is lowered again as far as the criteria allow.

        Parameters
        ----------
        points : array_like, shape (n, 3) or (n, 2)
            Points to interpolate, as for `NuSpline`.
        parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
            Parameters of the points, as for `NuSpline`.
        boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents
            End conditions, as for `NuSpline`.
        closed, repeated
            As for `NuSpline`.
        criteria : str or iterable of str, optional
            What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
            ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"`` and ``"regular"``; default all
            but the last two.
        strategy : {"fairest", "growth", "nussp", "reduction"}
            ``"nussp"`` adds ``step`` (the published algorithm); ``"growth"`` doubles the tension;
            ``"fairest"`` doubles and then lowers every tension by itself until none can be lowered by
            more than some per cent without breaking a criterion or making the curve bend more;
            ``"reduction"`` multiplies 1/(1 + ν) by ``step``.
        step : float
            What ``"nussp"`` adds, and what doubling starts from; positive.
        resolution : float
            Accuracy of the points, in their units: what a move of the points by that much could undo is not
            asked for. Default 0.
        coplanarity, collinearity, tolerance : float
            As for the method ``check``.
        max_iterations : int, optional
            Largest number of checks while tension is raised; by default there is no limit as long as
            tension can rise at every segment that violates a criterion. It rises to 1e60 and, by
            default, to what 10000 raises of a node add up to with ``"nussp"`` and ``"reduction"``.

        Returns
        -------
        NuSpline
            A curve that was checked completely and keeps every criterion; its ``diagnostics`` and
            ``history`` tell how it was found.

        Raises
        ------
        ConvergenceError
            If ``max_iterations`` is reached first, or if tension can rise no further where a criterion
            is violated; it carries the last curve and its report.
        ValueError, TypeError
            As for `NuSpline`, and for options outside their ranges.
        KeyboardInterrupt
            If Ctrl-C is pressed meanwhile.

        Notes
        -----
        Algorithm NUSSP, section 5.2 of Karavelas & Kaklis, Numer. Algorithms 23 (2000) 217–250, with
        the index in (5.61)–(5.62) corrected; the growth and the lowering are this library's. Cost: one
        complete solve and check, O(n), and then what the violations need.

        Examples
        --------
        >>> import shapespline as ss
        >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
        >>> curve = ss.NuSpline.shape_preserving(points, "uniform", strategy="nussp")
        >>> curve.check().ok
        True
        >>> curve.tension
        array([9.5, 9.5, 9.5, 9.5, 8. ])
        """
    def __copy__(self) -> NuSpline: ...
    def __deepcopy__(self, _memo: object) -> NuSpline: ...

@final
class TensionSpline(SpaceCurve):
    """C² tension cubic: a curve with a continuous second derivative through points, with tension.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
        Parameters of the points: by name, as the exponent e in [0, 1] of ``u[i+1] - u[i] = ‖points[i+1] -
        points[i]‖**e``, or strictly increasing numbers.
    boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
        No second derivative at both ends (two names); closed data, whose last point is the first; end
        tangents of the circles through the first and the last three points; or given end tangents.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
        parameters then have one entry more, for the return to the first point, unless the points repeat
        it; so have ``points`` and all other attributes.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case;
        ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
        nothing of them.
    tangent_scale : float, array_like of shape (n,), or pair of array_like of shape (n - 1,)
        λ from 1e-65 to 1, without unit: 1 gives the C² cubic spline, and smaller λ pull the curve to the
        polygon. One number, one per point, or (λ⁰, λ¹): one at the start and one at the end of each
        segment.

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
        parameters that do not increase, λ out of range, unknown names. The message says where.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    TensionSpline.shape_preserving : finds the λ that the shape of the points needs.

    Notes
    -----
    Each segment is a cubic with end legs h λ⁰ T/3 and h λ¹ T'/3, run through in a parameter s that is
    a monotone cubic of the local one: ``curve(s)`` is twice continuously differentiable in s. The
    tangents T solve the tridiagonal system (3.7)–(3.8) of Manni, *Parametric shape-preserving spatial
    interpolation and ν-splines*, Algorithms for Approximation IV (2001), which is strictly diagonally
    dominant for all λ in (0, 1] (Theorem 3.1); natural ends are this library's. Cost O(n); evaluation
    solves one monotone cubic a parameter.

    Examples
    --------
    >>> import numpy as np
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> curve = ss.TensionSpline(points, tangent_scale=[1, 0.25, 0.5, 0.25, 1])
    >>> curve
    <TensionSpline: 5 points in space, tension up to 3 at 3 of them; ...>
    >>> u = curve.parameters[1:-1]
    >>> np.allclose(curve(u, 2, side="left"), curve(u, 2, side="right"))
    True
    """
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "natural",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        tangent_scale: float | ArrayLike | tuple[ArrayLike, ArrayLike] = 1.0,
    ) -> TensionSpline: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "natural",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        strategy: _Strategy = "fairest",
        step: float | None = None,
        resolution: float = 0.0,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
        max_iterations: int | None = None,
    ) -> TensionSpline:
        """Fit the C² tension cubic whose λ keep the shape of the points.

        λ is lowered at the nodes around each violation until no criterion fails, both λ of a node
        together; then, by default, it is raised again as far as the criteria allow.

        Parameters
        ----------
        points : array_like, shape (n, 3) or (n, 2)
            Points to interpolate, as for `TensionSpline`.
        parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
            Parameters of the points, as for `TensionSpline`.
        boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
            End conditions, as for `TensionSpline`.
        closed, repeated
            As for `TensionSpline`.
        criteria : str or iterable of str, optional
            What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
            ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"`` and ``"regular"``; default all
            but the last two.
        strategy : {"fairest", "growth", "reduction", "nussp"}
            ``"reduction"`` multiplies λ by ``step`` (the published algorithm); ``"growth"`` doubles
            1/λ − 1; ``"fairest"`` doubles and then lowers every tension, on both sides of a point, by
            itself until none can be lowered by more than some per cent without breaking a criterion or
            making the curve bend more; ``"nussp"`` adds ``step`` to 1/λ − 1.
        step : float, optional
            ρ in (0, 1) of ``"reduction"``, default 0.5; else what doubling starts from or what is added
            to 1/λ − 1, default 0.25.
        resolution : float
            Accuracy of the points, in their units: what a move of the points by that much could undo is not
            asked for. Default 0.
        coplanarity, collinearity, tolerance : float
            As for the method ``check``.
        max_iterations : int, optional
            Largest number of checks while tension is raised; by default there is no limit as long as
            tension can rise at every segment that violates a criterion. It rises to 1e60 and, by
            default, to what 10000 raises of a node add up to with ``"nussp"`` and ``"reduction"``.

        Returns
        -------
        TensionSpline
            A curve that was checked completely and keeps every criterion; its ``diagnostics`` and
            ``history`` tell how it was found.

        Raises
        ------
        ConvergenceError
            If ``max_iterations`` is reached first, or if tension can rise no further where a criterion
            is violated; it carries the last curve and its report.
        ValueError, TypeError
            As for `TensionSpline`, and for options outside their ranges.
        KeyboardInterrupt
            If Ctrl-C is pressed meanwhile.

        Notes
        -----
        Section 4 of Manni 2001: near λ = 0 every criterion holds (Lemmas 4.1–4.3). The growth and the
        lowering are this library's. Cost: one complete solve and check, O(n), and then what the
        violations need.

        Examples
        --------
        >>> import shapespline as ss
        >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
        >>> ss.TensionSpline(points, "uniform").check().ok
        False
        >>> curve = ss.TensionSpline.shape_preserving(points, "uniform", strategy="reduction")
        >>> curve.check().ok
        True
        """
    @property
    def tangent_scale(self) -> tuple[_Floats, _Floats]:
        """(λ⁰, λ¹): the scale of the tangents at the start and at the end of each segment, two fresh
        arrays of shape (segments,).

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.TensionSpline([[0, 0], [3, 4], [3, 5]], tangent_scale=[1, 0.5, 1]).tangent_scale
        (array([1. , 0.5]), array([0.5, 1. ]))
        """
    @overload
    def image_parameter(self, u: float) -> float:
        """Return the parameter of ``bezier``, ``to_bspline()`` and ``to_ppoly()`` at that of the curve.

        The parameter s in which the curve is C² is no polynomial's: the local parameter t of a segment
        is found from the monotone cubic s(t). The image is a piecewise cubic in t, which those three
        run through linearly: they agree with the curve at the points, and elsewhere
        ``curve(u) = curve.to_ppoly()(curve.image_parameter(u))``. With λ = 1 both parameters are the
        same.

        Parameters
        ----------
        u : array_like
            Parameters of the curve, of any shape.

        Returns
        -------
        float or numpy.ndarray, shape u.shape

        Notes
        -----
        Manni 2001, (3.3). A guarded Newton iteration that never leaves the segment; exact at the
        points.

        Examples
        --------
        >>> import numpy as np
        >>> import shapespline as ss
        >>> curve = ss.TensionSpline([[0, 0], [3, 4], [3, 5]], tangent_scale=[1, 0.25, 1])
        >>> u = np.linspace(0, 6, 100)
        >>> np.allclose(curve(u), curve.to_ppoly()(curve.image_parameter(u)))
        True
        """
    @overload
    def image_parameter(self, u: _Many) -> _Floats: ...
    @overload
    def image_parameter(self, u: ArrayLike) -> float | _Floats: ...
    def __copy__(self) -> TensionSpline: ...
    def __deepcopy__(self, _memo: object) -> TensionSpline: ...

@final
class CatmullRom(SpaceCurve):
    """Catmull–Rom curve: local cubic interpolation whose tangents lie between the chords.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
    parameters : {"centripetal", "chordal", "uniform"}, float or array_like, shape (n,)
        Parameters of the points: by name, as the exponent e in [0, 1] of ``u[i+1] - u[i] = ‖points[i+1] -
        points[i]‖**e``, or strictly increasing numbers.
    boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
        No second derivative at both ends (two names); closed data, whose last point is the first; end
        tangents of the circles through the first and the last three points; or given end tangents.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
        parameters then have one entry more, for the return to the first point, unless the points repeat
        it; so have ``points`` and all other attributes.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case;
        ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
        nothing of them.
    tension : float or array_like, shape (n,)
        Cardinal tension in [0, 1), without unit: the part by which the handles at a point are
        shortened. 0 gives the Catmull–Rom curve, 1 would give the polygon. Of closed data, the first
        and the last entry must agree.
    continuity : {"C1", "G1"}
        Whether both handles at a point have one scale (the derivative is continuous), or only one
        direction. Without ``shape_preserving`` both give the same curve.

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
        parameters that do not increase, tension outside [0, 1), unknown names. The message says where.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    CatmullRom.shape_preserving : finds the handles that the shape of the points needs.

    Notes
    -----
    The tangent at a point is that of the parabola through it and its neighbours, at their parameters.
    A point moves the curve over two segments to either side. Of the shape criteria, torsion and
    coplanarity without inflection hold for every such curve: Gautam, *Shape preservation behavior of
    spline curves*, section 14. Cost O(n), on all threads for long curves.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> curve = ss.CatmullRom(points, tension=0.25)
    >>> curve
    <CatmullRom: 5 points in space, tension up to 0.25 at 5 of them; ...>
    >>> ss.CatmullRom([[0, 0], [1, 2], [4, 4]], "uniform").tangents[1]
    array([2., 2.])
    """
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "centripetal",
        *,
        boundary: _Boundary | Tangents = "natural",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        tension: float | ArrayLike = 0.0,
        continuity: _Continuity = "C1",
    ) -> CatmullRom: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "centripetal",
        *,
        boundary: _Boundary | Tangents = "natural",
        closed: bool = False,
        repeated: Literal["error", "drop"] = "error",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        safety: float = 0.9,
        continuity: _Continuity = "C1",
        directions: _Directions = "balanced",
        resolution: float = 0.0,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
    ) -> CatmullRom:
        """Fit the Catmull–Rom curve with the largest handles that keep the shape of the points.

        Parameters
        ----------
        points : array_like, shape (n, 3) or (n, 2)
            Points to interpolate, as for `CatmullRom`.
        parameters : {"centripetal", "chordal", "uniform"}, float or array_like, shape (n,)
            Parameters of the points, as for `CatmullRom`.
        boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
            End conditions, as for `CatmullRom`.
        closed, repeated
            As for `CatmullRom`.
        criteria : str or iterable of str, optional
            What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
            ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"``, which follows from the first,
            and ``"regular"``; default all but the last two.
        safety : float
            The part, in (0, 1), of each bound that a handle may reach.
        continuity : {"C1", "G1"}
            ``"C1"`` takes the smaller of the two scales at a point for both handles, ``"G1"`` lets each
            segment have its own.
        directions : {"balanced", "parametrization"}
            ``"balanced"`` splits the turning angle at each point so that the two angles of a segment with
            its chord become alike, which keeps handles long; ``"parametrization"`` takes the tangents of
            the curve without tension, and is local.
        resolution : float
            Accuracy of the points, in their units: what a move of the points by that much could undo is not
            asked for. Default 0.
        coplanarity, collinearity, tolerance : float
            As for the method ``check``.

        Returns
        -------
        CatmullRom
            A curve that was checked completely and keeps every criterion. Its ``diagnostics`` count one
            iteration where the closed forms were enough.

        Raises
        ------
        ConvergenceError
            If what closed forms leave open (planes known only to the tolerance) is not met within 200
            checks; it carries the last curve and its report.
        ValueError, TypeError
            As for `CatmullRom`, and for options outside their ranges.

        Notes
        -----
        Gautam, *Shape preservation behavior of spline curves*, section 14, shows that every direction
        strictly between the chords will do; the balanced ones and the largest magnitudes, in closed form,
        are this library's. Torsion holds for handles of any length. Cost O(n), on all threads for long
        curves; balanced directions take some ten tridiagonal systems.

        Examples
        --------
        >>> import shapespline as ss
        >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
        >>> ss.CatmullRom(points, "uniform").check().counts()["convexity"]
        (2, 2)
        >>> curve = ss.CatmullRom.shape_preserving(points, "uniform")
        >>> curve.check().ok
        True
        """
    @property
    def continuity(self) -> _Continuity:
        """What is continuous at the points besides the direction: ``"C1"`` or ``"G1"``.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.CatmullRom([[0, 0], [1, 2], [4, 4]]).continuity
        'C1'
        """
    def __copy__(self) -> CatmullRom: ...
    def __deepcopy__(self, _memo: object) -> CatmullRom: ...

@final
class Tangents:
    """Given tangents at the ends of a curve, or at one of them, for the argument ``boundary``.

    Parameters
    ----------
    start, end : array_like, shape (3,) or (2,), optional
        Derivatives of the curve with respect to its parameter at the first and the last point, in
        units of the points over units of the parameter: any finite, non-zero vectors, with as many
        components as the points. An end whose tangent is ``None`` is natural: it has no curvature.

    Raises
    ------
    ValueError
        If a vector is zero, not finite, of a wrong shape, the two have different lengths, or both are
        ``None``.
    TypeError
        If a vector is not made of real numbers.

    Notes
    -----
    Condition (3.8) of Karavelas & Kaklis, Numer. Algorithms 23 (2000): under tension ν the tangent of
    a ν-spline at the end is the given one divided by 1 + ν. Objects are immutable, and equal when their
    vectors are.

    Examples
    --------
    >>> import shapespline as ss
    >>> ends = ss.Tangents([1, 0, 0], [0, 2, 0])
    >>> ends
    Tangents([1.0, 0.0, 0.0], [0.0, 2.0, 0.0])
    >>> curve = ss.NuSpline([[0, 0, 0], [1, 1, 0], [1, 2, 1]], boundary=ends)
    >>> curve.tangents[-1]
    array([0., 2., 0.])
    """
    def __new__(cls, start: ArrayLike | None = None, end: ArrayLike | None = None) -> Tangents: ...
    @property
    def start(self) -> _Floats | None:
        """The tangent at the first point, shape (dim,), or ``None``; a fresh array."""
    @property
    def end(self) -> _Floats | None:
        """The tangent at the last point, shape (dim,), or ``None``; a fresh array."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Tangents: ...
    def __deepcopy__(self, _memo: object) -> Tangents: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class PiecewiseBezier:
    """A curve of any degree, polynomial or rational, given by the Bézier points of its pieces.

    The form in which `check_shape` and `inflection_count` take curves that were not made here: SciPy's
    are converted to it, and NURBS enter by it, with their weights.

    Parameters
    ----------
    control : array_like, shape (pieces, degree + 1, dim)
        Bézier points of each piece, in the plane or in space; degree from 1 to 18.
    breaks : array_like, shape (pieces + 1,)
        Strictly increasing parameters: piece i is run through linearly from ``breaks[i]`` to
        ``breaks[i + 1]``.
    weights : array_like, shape (pieces, degree + 1), optional
        Positive weights of the Bézier points: the curve is rational.

    Raises
    ------
    ValueError
        If shapes do not belong together, breaks do not increase, a number is not finite or a weight
        not positive.
    TypeError
        If an argument does not hold real numbers.

    See Also
    --------
    check_shape : does the curve keep the shape of points?

    Notes
    -----
    Nothing is asked of how pieces meet. Objects are immutable and picklable.

    Examples
    --------
    A quarter of a circle, as a rational parabola:

    >>> import numpy as np
    >>> import shapespline as ss
    >>> arc = ss.PiecewiseBezier([[[1, 0], [1, 1], [0, 1]]], [0, 1], weights=[[1, 0.5**0.5, 1]])
    >>> arc
    <PiecewiseBezier: 1 rational piece of degree 2 in the plane, u from 0 to 1>
    >>> bool(np.allclose(np.hypot(*arc(np.linspace(0, 1, 9)).T), 1))
    True
    """
    def __new__(
        cls, control: ArrayLike, breaks: ArrayLike, *, weights: ArrayLike | None = None
    ) -> PiecewiseBezier: ...
    @classmethod
    def from_bspline(
        cls,
        knots: ArrayLike,
        control: ArrayLike,
        degree: int,
        *,
        weights: ArrayLike | None = None,
    ) -> PiecewiseBezier:
        """Make the curve of a B-spline, or of a NURBS curve, on its base interval.

        Parameters
        ----------
        knots : array_like, shape (n + degree + 1,)
            Knots that do not decrease.
        control : array_like, shape (n, dim)
            Control points.
        degree : int
            From 1 to 18.
        weights : array_like, shape (n,), optional
            Positive weights of the control points (NURBS).

        Returns
        -------
        PiecewiseBezier
            From ``knots[degree]`` to ``knots[n]``, taken apart by Boehm's knot insertion.

        Raises
        ------
        ValueError
            If lengths do not belong together, knots decrease, a number is not finite or a weight not
            positive.

        Examples
        --------
        >>> import shapespline as ss
        >>> knots, control = [0, 0, 0, 1, 2, 2, 2], [[0, 0], [1, 2], [3, 2], [4, 0]]
        >>> ss.PiecewiseBezier.from_bspline(knots, control, 2, weights=[1, 2, 2, 1])
        <PiecewiseBezier: 2 rational pieces of degree 2 in the plane, u from 0 to 2>
        """
    @classmethod
    def from_power(cls, coefficients: ArrayLike, breaks: ArrayLike) -> PiecewiseBezier:
        """Make the curve of a piecewise polynomial in powers, as SciPy's ``PPoly`` holds it.

        Parameters
        ----------
        coefficients : array_like, shape (degree + 1, pieces, dim)
            Highest power first: piece i is the sum of ``coefficients[k, i] * (u - breaks[i])**(degree
            - k)``.
        breaks : array_like, shape (pieces + 1,)
            Strictly increasing parameters.

        Returns
        -------
        PiecewiseBezier

        Raises
        ------
        ValueError
            If shapes do not belong together, breaks do not increase or a number is not finite.

        Examples
        --------
        >>> import shapespline as ss
        >>> line = ss.PiecewiseBezier.from_power([[[1, 2]], [[3, 4]]], [0, 2])
        >>> line.control
        array([[[3., 4.],
                [5., 8.]]])
        """
    @property
    def control(self) -> _Floats:
        """Bézier points of the pieces, shape (pieces, degree + 1, dim); a fresh array."""
    @property
    def weights(self) -> _Floats | None:
        """Weights of the Bézier points, shape (pieces, degree + 1), a fresh array; ``None`` for a curve
        that is not rational.
        """
    @property
    def breaks(self) -> _Floats:
        """The parameters at the ends of the pieces, strictly increasing; a fresh array."""
    @property
    def degree(self) -> int:
        """The degree of the pieces."""
    def fairness(self) -> Fairness:
        """Measure how fair the curve is: bending, variation and extrema of its curvature.

        Returns
        -------
        Fairness
            Six measures, and the parameters of cusps and corners.

        See Also
        --------
        fairness : the same of any curve, with the definitions.

        Examples
        --------
        A quarter of a circle:

        >>> import shapespline as ss
        >>> arc = ss.PiecewiseBezier([[[1, 0], [1, 1], [0, 1]]], [0, 1], weights=[[1, 0.5**0.5, 1]])
        >>> round(arc.fairness().max_curvature, 12), arc.fairness().curvature_extrema
        (1.0, 0)
        """
    def __call__(self, u: ArrayLike) -> _Floats:
        """Evaluate the curve.

        Parameters
        ----------
        u : array_like
            Parameters, of any shape. Outside the breaks the end pieces go on. NaN gives NaN.

        Returns
        -------
        numpy.ndarray, shape (*u.shape, dim)

        Raises
        ------
        TypeError
            If ``u`` does not hold real numbers.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.PiecewiseBezier([[[0, 0], [2, 4]]], [0, 1])(0.5)
        array([1., 2.])
        """
    def __copy__(self) -> PiecewiseBezier: ...
    def __deepcopy__(self, _memo: object) -> PiecewiseBezier: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class Fairness:
    """How fair a curve is: six measures, and where it has cusps and corners.

    ``bending``, ``variation`` and ``max_curvature_jump`` are free of scale: they are multiplied by the
    power of the length that makes them so. Immutable and picklable.

    Attributes
    ----------
    length : float
        Arc length L, in units of the points.
    bending : float
        L∫κ²ds, without unit: 4π² for a circle, infinite at corners and cusps.
    variation : float
        L³∫(κ'² + κ²τ²)ds, without unit, derivatives by arc length (in the plane L³∫κ'²ds): 0 for lines and
        circles, infinite where the curvature vector jumps.
    max_curvature : float
        The largest curvature, per unit of length; infinite at corners and cusps.
    max_curvature_at : float
        The parameter of it.
    curvature_extrema : int
        Number of extrema of curvature inside the curve, in the plane of signed curvature.
    max_curvature_jump : float
        L times the largest jump of the curvature vector, without unit.
    cusps : tuple of float
        Parameters at which the speed vanishes, to rounding.
    corners : tuple of float
        Parameters at which position or direction jumps.

    Notes
    -----
    Extrema are sign changes of a polynomial, isolated by Bernstein subdivision with an error bound; nothing
    is sampled. The integrals are taken between them, by adaptive quadrature. Directions that differ by less
    than 1e-6 rad count as equal, and curvatures that differ by less than 1e-9 of themselves. Farin & Sapidis,
    IEEE Comput. Graph. Appl. 9 (1989) 52–57, doi:10.1109/38.19051; Moreton & Séquin, Comput. Graph. 26 (1992)
    167–176, doi:10.1145/133994.134035.

    Examples
    --------
    >>> import shapespline as ss
    >>> fairness = ss.fairness(ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]))
    >>> fairness.curvature_extrema, fairness.max_curvature_jump, fairness.cusps
    (2, 0.0, ())
    """
    @property
    def length(self) -> float:
        """Arc length L, in units of the points."""
    @property
    def bending(self) -> float:
        """L∫κ²ds, without unit."""
    @property
    def variation(self) -> float:
        """L³∫(κ'² + κ²τ²)ds, without unit."""
    @property
    def max_curvature(self) -> float:
        """The largest curvature, per unit of length."""
    @property
    def max_curvature_at(self) -> float:
        """The parameter of the largest curvature."""
    @property
    def curvature_extrema(self) -> int:
        """Number of extrema of curvature inside the curve."""
    @property
    def max_curvature_jump(self) -> float:
        """L times the largest jump of the curvature vector."""
    @property
    def cusps(self) -> tuple[float, ...]:
        """Parameters at which the speed vanishes, to rounding."""
    @property
    def corners(self) -> tuple[float, ...]:
        """Parameters at which position or direction jumps."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class ShapeRecord:
    """One criterion on one segment: whether it applies, whether it holds, and by how much.

    Attributes
    ----------
    segment : int
        Index of the segment, from 0; it runs from node ``segment`` to node ``segment + 1``.
    criterion : str
        Name of the criterion.
    applicable : bool
        Whether the data polygon requires the criterion on this segment.
    satisfied : bool
        Whether the curve is proved to meet it; true where it does not apply.
    margin : float
        Signed distance from failure, without unit, in [−1, 1]: positive exactly when satisfied; NaN
        where the criterion does not apply.
    location : float
        Parameter at which the margin is smallest; NaN where the criterion does not apply.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> report = ss.NuSpline(points, "uniform").check()
    >>> worst = min(report.violations, key=lambda record: record.margin)
    >>> worst.criterion, worst.segment, worst.satisfied
    ('torsion', 1, False)
    """
    def __new__(
        cls,
        segment: int,
        criterion: str,
        applicable: bool,
        satisfied: bool,
        margin: float,
        location: float,
    ) -> Self: ...
    @property
    def segment(self) -> int:
        """Index of the segment, from 0."""
    @property
    def criterion(self) -> _Criterion:
        """Name of the criterion."""
    @property
    def applicable(self) -> bool:
        """Whether the data polygon requires the criterion on this segment."""
    @property
    def satisfied(self) -> bool:
        """Whether the curve meets it; true where it does not apply."""
    @property
    def margin(self) -> float:
        """Signed, scale-free distance from failure, positive when satisfied; NaN where not applicable."""
    @property
    def location(self) -> float:
        """Parameter at which the margin is smallest; NaN where not applicable."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class UndecidedRecord:
    """A criterion that could be neither proved nor refuted on a segment.

    Something in it is zero to rounding: the sign lies within the bound of its error.

    Attributes
    ----------
    segment : int
        Index of the segment, from 0.
    criterion : str
        Name of the criterion.
    interval : tuple[float, float]
        The parameters between which the question stays open.

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.UndecidedRecord(3, "torsion", (0.25, 0.5)).interval
    (0.25, 0.5)
    """
    def __new__(cls, segment: int, criterion: str, interval: tuple[float, float]) -> Self: ...
    @property
    def segment(self) -> int:
        """Index of the segment, from 0."""
    @property
    def criterion(self) -> str:
        """Name of the criterion."""
    @property
    def interval(self) -> tuple[float, float]:
        """The parameters between which the question stays open."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class NodeRecord:
    """A condition at a node to which it applies: information, which enters no verdict.

    Attributes
    ----------
    node : int
        Index of the point.
    condition : str
        ``"compatibility"``, ``"same-torsion"``, ``"torsion-change"``, ``"convex-neighbourhood"``,
        ``"inflection-neighbourhood"``, ``"neighbourhood-torsion"`` or
        ``"neighbourhood-coplanarity"``; see ``ShapeReport.nodes``.
    satisfied : bool
        Whether the curve meets it.
    margin : float
        Signed distance from failure, without unit.
    location : float
        Parameter at which the margin is smallest.

    Examples
    --------
    >>> import shapespline as ss
    >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check()
    >>> [(record.node, record.condition, record.satisfied) for record in report.nodes]
    [(1, 'compatibility', True), (2, 'compatibility', True)]
    """
    def __new__(
        cls, node: int, condition: str, satisfied: bool, margin: float, location: float
    ) -> Self: ...
    @property
    def node(self) -> int:
        """Index of the point, from 0."""
    @property
    def condition(self) -> str:
        """Name of the condition; see ``ShapeReport.nodes``."""
    @property
    def satisfied(self) -> bool:
        """Whether the curve meets it."""
    @property
    def margin(self) -> float:
        """Signed distance from failure, without unit."""
    @property
    def location(self) -> float:
        """Parameter at which the margin is smallest."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class OscillationRecord:
    """How a segment moves about the plane of its four points: information, in no verdict.

    Attributes
    ----------
    segment : int
        Index of the segment, which requires coplanarity.
    crossings : int
        How often it crosses the plane between its points.
    least : int
        The least crossings that its end tangents allow: 0 or 1.
    satisfied : bool
        Whether there are no more than the least.
    amplitude : float
        Greatest distance from the plane over the length of the chord.
    location : float
        Parameter of that distance.

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.OscillationRecord(0, 1, 1, True, 0.01, 0.5).crossings
    1
    """
    def __new__(
        cls,
        segment: int,
        crossings: int,
        least: int,
        satisfied: bool,
        amplitude: float,
        location: float,
    ) -> Self: ...
    @property
    def segment(self) -> int:
        """Index of the segment, which requires coplanarity."""
    @property
    def crossings(self) -> int:
        """How often it crosses the plane between its points."""
    @property
    def least(self) -> int:
        """The least crossings that its end tangents allow."""
    @property
    def satisfied(self) -> bool:
        """Whether there are no more than the least."""
    @property
    def amplitude(self) -> float:
        """Greatest distance from the plane over the length of the chord."""
    @property
    def location(self) -> float:
        """Parameter of that distance."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class ShapeReport:
    """What a check of a curve's shape found; made by `check_shape` and by the method ``check`` of a curve.

    Holds the violations, what stays open, and counts; the records of all segments and the notes on
    nodes are made when asked for. Prints as a table, with the energy ∫κ²ds and the largest curvature of
    the curve, if it has at most 1000 segments, beside those of the C² cubic spline with the same parameters
    and ends; the criterion that costs most energy, where the C² cubic violates it; and the points that are
    practically corners, where curvature times chord exceeds 100. Immutable and picklable.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> report = ss.NuSpline(points, "uniform").check()
    >>> report.ok, report.counts()["convexity"]
    (False, (2, 2))
    >>> [(v.criterion, v.segment) for v in report.violations]
    [('convexity', 1), ('turning', 1), ('torsion', 1), ('convexity', 2), ('turning', 2), ('torsion', 2)]
    >>> ss.NuSpline.shape_preserving(points, "uniform").check().ok
    True
    """
    def __new__(cls) -> NoReturn: ...
    @property
    def ok(self) -> bool:
        """Whether no criterion that applies is violated; what rounding hides is ``undecided``."""
    @property
    def margin(self) -> float:
        """The smallest margin of all records that apply: positive when the shape is preserved.

        A number without unit; infinite when nothing applies. Cost O(N) at the first access.
        """
    @property
    def violations(self) -> list[ShapeRecord]:
        """The violations, ascending by segment: a list of `ShapeRecord`."""
    @property
    def segments(self) -> list[ShapeRecord]:
        """One `ShapeRecord` a segment and criterion asked for, by segment: a list.

        The list is made anew at each access, cost O(N): keep it in a variable.
        """
    @property
    def undecided(self) -> list[UndecidedRecord]:
        """What could be neither proved nor refuted, ascending by segment: a list of `UndecidedRecord`.

        A sign that is zero to rounding of the arithmetic, or of control points written with 15 significant
        digits, can stay open; such a record is not counted as violated, and in ``segments`` it is not
        satisfied and has margin 0.
        """
    @property
    def straight(self) -> tuple[int, ...]:
        """The segments on which the curve is straight by construction (``FairSpline(straight=True)``), a tuple
        of indices: at their ends turning and torsion may be zero.
        """
    @property
    def nodes(self) -> list[NodeRecord]:
        """What the paper says of the nodes beyond the criteria, as information: a list of `NodeRecord`.

        ``"compatibility"``: the tangent lies between the chords, seen along the binormal vector
        ((12.1) of Gautam). ``"same-torsion"``: torsion of the polygon's sign on both sides
        (Definition 9.2, item 2). ``"torsion-change"``: torsion that vanishes or jumps where the
        polygon's changes sign (Theorem 12.1). ``"convex-neighbourhood"`` and
        ``"inflection-neighbourhood"``: the conditions of Definition 8.2 around three points on a line;
        a curve through the middle one can meet the first with equality only, by being straight.
        ``"neighbourhood-torsion"`` and ``"neighbourhood-coplanarity"``: what that definition asks of
        the two segments around the middle point together, by the four points that are left; near the
        plane of a convex neighbourhood the binormal may flip, for there the curve has to inflect.

        None of them enters ``ok`` or ``counts``. Made anew at each access; cost O(N), much slower than
        the check.
        """
    @property
    def oscillations(self) -> list[OscillationRecord]:
        """How the segments that require coplanarity move about their plane, as information: a list of
        `OscillationRecord` (Gautam, section 10).

        Made anew at each access, as ``nodes``.
        """
    @property
    def boundary(self) -> Literal["zero-curvature", "periodic", "circular"] | Tangents:
        """The end conditions that the points were judged with: ``"zero-curvature"``, ``"periodic"``,
        ``"circular"`` or a `Tangents`.

        They say what stands in for the missing chord at each end, and so what the first and the last
        segment are asked.
        """
    def counts(self) -> dict[_Criterion, tuple[int, int]]:
        """How often each criterion asked for is violated, and how often it applies.

        Returns
        -------
        dict[str, tuple[int, int]]
            Criterion to (violated, applicable), counted in segments.

        Examples
        --------
        >>> import shapespline as ss
        >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check(["inflection"])
        >>> report.counts()
        {'inflection': (0, 1)}
        """
    def to_dict(self) -> _Report:
        """Return the report as plain data that ``json.dumps`` takes.

        Returns
        -------
        dict
            ``ok``, ``margin``, ``counts`` (criterion to ``violated`` and ``applicable``),
            ``resolution``, ``coplanarity``, ``collinearity``, ``tolerance``, and the lists ``segments``, ``violations``
            (records), ``undecided`` (``segment``, ``criterion``, ``interval``) and ``straight``. A margin
            or location that does not exist is ``None``.

        Examples
        --------
        >>> import json
        >>> import shapespline as ss
        >>> report = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check()
        >>> json.loads(json.dumps(report.to_dict(), allow_nan=False))["ok"]
        True
        """
    def to_dataframe(self) -> pd.DataFrame:
        """Return the records of all segments as a pandas DataFrame.

        Returns
        -------
        pandas.DataFrame
            One row a segment and criterion, with the attributes of `ShapeRecord` as columns.

        Raises
        ------
        ModuleNotFoundError
            If pandas is not installed (``pip install "shapespline[pandas]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> frame = ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check().to_dataframe()
        >>> list(frame.columns)
        ['segment', 'criterion', 'applicable', 'satisfied', 'margin', 'location']
        """
    def plot(self, ax: Axes | None = None) -> Axes:
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
    def _repr_html_(self) -> str: ...
    def __copy__(self) -> ShapeReport: ...
    def __deepcopy__(self, _memo: object) -> ShapeReport: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class Diagnostics:
    """Counts of the work that a shape-preserving fit took.

    Attributes
    ----------
    status : str
        ``"solved"``: every criterion holds, by a complete solve and check at the end. Curves that a
        `ConvergenceError` carries say ``"iteration-limit"`` (``max_iterations`` was reached) or
        ``"stalled"`` (a criterion fails where tension can rise no further). ``"given"``: there was no
        search.
    iterations : int
        Checks of the curve while tension was raised, the last one, which found no violation, included.
    solves : int
        Solves of the system of tangents, complete or in part.
    relaxations : int
        How often tensions were tried to be lowered again (``strategy="fairest"``).
    nodes_changed : int
        Nodes whose tension is not zero in the end.
    dropped : tuple of int
        Indices of the points that were left out (``repeated="drop"``).

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> ss.NuSpline.shape_preserving(points, "uniform").diagnostics
    Diagnostics(status='solved', iterations=..., solves=..., relaxations=..., nodes_changed=2)
    """
    @property
    def status(self) -> Literal["given", "solved", "iteration-limit", "stalled"]:
        """How the search ended: ``"solved"``, ``"iteration-limit"`` or ``"stalled"``; ``"given"`` without
        one.
        """
    @property
    def iterations(self) -> int:
        """Checks of the curve while tension was raised, the last one included."""
    @property
    def solves(self) -> int:
        """Solves of the system of tangents, complete or in part."""
    @property
    def relaxations(self) -> int:
        """How often tensions were tried to be lowered again."""
    @property
    def nodes_changed(self) -> int:
        """Nodes whose tension is not zero in the end."""
    @property
    def dropped(self) -> tuple[int, ...]:
        """Indices of the points that were left out, ascending (``repeated="drop"``)."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class SearchStep:
    """One step of the search for tension.

    Attributes
    ----------
    phase : str
        ``"raise"``: tension was raised where criteria failed; ``"lower"``: tensions were
        lowered; ``"verify"``: everything was solved and checked anew.
    violations : int
        Segments that violated a criterion when the step began.
    changed : int
        Nodes whose tension the step changed.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> ss.NuSpline.shape_preserving(points, "uniform").history[0]
    SearchStep(phase='raise', violations=2, changed=5)
    """
    @property
    def phase(self) -> Literal["raise", "lower", "verify"]:
        """``"raise"``, ``"lower"`` or ``"verify"``."""
    @property
    def violations(self) -> int:
        """Segments that violated a criterion when the step began."""
    @property
    def changed(self) -> int:
        """Nodes whose tension the step changed."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

def _from_bytes(data: bytes) -> Any:
    """Make the object of a pickle."""

def _floats(argument: str, values: object) -> _Floats:
    """Return an array of f64 for the Python side of the package, with the same refusals."""

def _fit_many(
    points: ArrayLike,
    offsets: ArrayLike,
    method: str,
    parameters: _Parametrization | float | ArrayLike,
    boundary: _Boundary | Tangents | None,
    closed: bool,
    repeated: str,
    shape_preserving: bool,
    threads: int | None,
    criteria: _Criterion | Iterable[_Criterion] | None,
    resolution: float,
    coplanarity: float,
    collinearity: float,
    tolerance: float,
    strategy: _Strategy,
    step: float | None,
    max_iterations: int | None,
    safety: float,
    continuity: _Continuity,
    directions: _Directions,
    tension: float,
    tangent_scale: float,
    energy: str,
    straight: bool,
) -> tuple[list[SpaceCurve | None], dict[int, Exception]]:
    """Fit every curve of a collection."""

def _check_shape(
    points: ArrayLike,
    curve: PiecewiseBezier,
    parameters: _Parametrization | float | ArrayLike | None,
    boundary: _Boundary | Tangents | None,
    closed: bool,
    repeated: str,
    criteria: _Criterion | Iterable[_Criterion] | None,
    resolution: float | None,
    coplanarity: float | None,
    collinearity: float | None,
    tolerance: float | None,
    of_fit: bool,
    corners: Sequence[int] | float | None,
    straight: Sequence[int],
) -> ShapeReport:
    """Return the report on points and a curve through them."""

def _check_monotone(
    x: ArrayLike,
    y: ArrayLike,
    function: PiecewiseBezier,
    convex: _Convex,
    tolerance: float,
) -> MonotoneReport:
    """Return the report on data and the graph of a function."""

def _curve_inflections(
    curve: PiecewiseBezier, direction: ArrayLike | None
) -> tuple[int, _Floats, bool]: ...
def _polygon_inflections(
    points: ArrayLike, direction: ArrayLike | None
) -> tuple[int, _Floats, bool]: ...
def _polygon_shape(
    points: ArrayLike,
    parameters: _Parametrization | float | ArrayLike,
    boundary: _Boundary | Tangents | None,
    closed: bool,
    repeated: str,
    resolution: float,
    tolerance: float,
) -> dict[str, Any]:
    """Return the discrete shape of points, by the names of its parts."""

_Continuation = Literal["linear", "clip", "periodic"] | bool
_Extrapolate = _Continuation | tuple[_Continuation, _Continuation] | None

@disjoint_base
class PiecewisePolynomial:
    """A piecewise polynomial in one variable, on increasing knots: the base of the monotone interpolants.

    Not made directly: derivatives and antiderivatives of `MonotoneCubic`, `MonotoneQuintic` and
    `MonotoneQuartic` are of this class. Immutable; compares and hashes by identity; can be pickled, copied and shared
    between threads.

    Examples
    --------
    >>> import shapespline as ss
    >>> slope = ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).derivative()
    >>> type(slope).__name__, slope(0.5)
    ('PiecewisePolynomial', 1.0)
    """
    def __new__(cls) -> Self: ...
    @property
    def x(self) -> _Floats:
        """Of an interpolant the abscissae of its data, shape (n,); of a derivative or an antiderivative its
        knots. A fresh array.
        """
    @property
    def knots(self) -> _Floats | list[_Floats]:
        """Knots between which it is a polynomial, shape (m,); a fresh array. Cubics have knots between their
        data: where those of several columns differ, a list of one array per column.
        """
    @property
    def axis(self) -> int:
        """The axis of y along which it interpolates, from 0 on."""
    @property
    def degree(self) -> int:
        """Degree of the pieces."""
    @property
    def extrapolate(self) -> str | bool | tuple[str | bool, str | bool]:
        """What it is outside the knots, as the constructors take it. Derivatives and antiderivatives continue
        what they are made of: ``"zero"`` is the derivative of a constant, ``"taylor-2"`` the antiderivative
        of a line, ``"periodic-1"`` that of a repeating function.
        """
    def __call__(
        self, x: ArrayLike, nu: int = 0, extrapolate: _Extrapolate = None
    ) -> float | _Floats:
        """Evaluate the function or a derivative.

        Parameters
        ----------
        x : array_like
            Where, of any shape. NaN gives NaN; ±∞ gives the limit, NaN where there is none.
        nu : int
            Order of the derivative; 0 gives values.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            What it is outside the knots: the tangent line, the end value, the function repeated, the end
            polynomial, NaN; of a pair the first below, the second above. None is what the function was
            made with.

        Returns
        -------
        float or numpy.ndarray
            Of the shape of y with the axis of interpolation replaced by the shape of ``x``; a float
            where that is no axis at all.

        Raises
        ------
        ValueError, TypeError
            If ``nu`` is negative, ``extrapolate`` unknown, or ``x`` does not hold real numbers.

        Notes
        -----
        Cost O(log n) for one place, O(1) expected each for many; many run on all threads.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.MonotoneQuintic([0, 1, 2], [[0, 0], [1, 2], [2, 4]])
        >>> f([0.5, 1.5])
        array([[0.5, 1. ],
               [1.5, 3. ]])
        >>> f(3.0, extrapolate="clip")
        array([2., 4.])
        """
    def derivative(self, nu: int = 1) -> PiecewisePolynomial:
        """Return the derivative as a function.

        Parameters
        ----------
        nu : int
            Its order.

        Returns
        -------
        PiecewisePolynomial
            Outside the knots the derivative of what the function is there. Cost O(n).

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.MonotoneQuintic([0, 1, 2], [0, 2, 4]).derivative()(1.5)
        2.0
        """
    def antiderivative(self, nu: int = 1) -> PiecewisePolynomial:
        """Return an antiderivative as a function: zero at the first knot.

        Parameters
        ----------
        nu : int
            How often to integrate; at most 100.

        Returns
        -------
        PiecewisePolynomial
            Of a degree that is ``nu`` higher. Cost O(n).

        Examples
        --------
        >>> import shapespline as ss
        >>> area = ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).antiderivative()
        >>> round(area(2.0), 12)
        2.0
        """
    def integrate(self, a: float, b: float, extrapolate: _Extrapolate = None) -> float | _Floats:
        """Return the definite integral from a to b.

        Parameters
        ----------
        a, b : float
            The ends, in any order, also outside the knots. NaN gives NaN; ±∞ gives the limit, NaN where
            there is none.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for a call.

        Returns
        -------
        float or numpy.ndarray
            One number a column. Cost O(log n) after a first call of O(n).

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).integrate(0, 2)
        2.0
        """
    def roots(self, extrapolate: _Extrapolate = None) -> NDArray[np.float64 | np.object_]:
        """All x with f(x) = 0: `solve` for zero.

        Parameters
        ----------
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for a call: roots beyond the knots count where the function is defined there; of one
            that repeats, those on the knots.

        Returns
        -------
        numpy.ndarray
            As of `solve`.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.MonotoneQuintic([0, 1, 2], [-1, 0, 1]).roots(extrapolate=False)
        array([1.])
        """
    def solve(self, y: float, extrapolate: _Extrapolate = None) -> NDArray[np.float64 | np.object_]:
        """All x with f(x) = y.

        Parameters
        ----------
        y : float
            A finite value.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for a call: solutions beyond the knots count where the function is defined there; of one
            that repeats, those on the knots.

        Returns
        -------
        numpy.ndarray
            Increasing, each once. Where f equals y on a whole segment: its start, then NaN, as SciPy
            does; where it does so on a half line beyond the knots, the end knot alone. For many columns an
            array of such arrays (dtype object).

        Notes
        -----
        Every solution is verified: there f is y to some units in the last place of its values, or passes
        y between the neighbouring floating-point numbers. Cost O(n); a segment is searched only where
        its ends do not exclude y.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.MonotoneQuintic([0, 1, 2, 3], [0, 1, 1, 2]).solve(1.0, extrapolate=False)
        array([ 1., nan])
        """
    def _bernstein(self) -> _Floats:
        """Bernstein coefficients with SciPy's two axes (degree + 1, segments) in place of ours."""
    def to_bpoly(self) -> BPoly:
        """Return the function as a piecewise polynomial of SciPy in Bernstein form.

        Returns
        -------
        scipy.interpolate.BPoly
            With the same ``axis``. Outside the knots it is the end polynomial, or repeats, where the
            function does so on both sides, else NaN: SciPy knows no tangent line and no end value.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is not installed (``pip install "shapespline[scipy]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> float(ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).to_bpoly()(1.5))
        1.5
        """
    def to_ppoly(self) -> PPoly:
        """Return the function as a piecewise polynomial of SciPy in the power basis.

        Returns
        -------
        scipy.interpolate.PPoly
            Converted by SciPy from `to_bpoly`.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is not installed (``pip install "shapespline[scipy]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> float(ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).to_ppoly()(1.5))
        1.5
        """
    def to_bspline(self) -> BSpline:
        """Return the function as a B-spline of SciPy.

        Returns
        -------
        scipy.interpolate.BSpline
            With the same ``axis``; of one cubic with simple knots (double ones where its second derivative
            jumps: without layers, and at given slopes), of quartics and quintics with triple ones. Outside
            the knots as `to_bpoly`.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is not installed (``pip install "shapespline[scipy]"``).

        Examples
        --------
        >>> import shapespline as ss
        >>> float(ss.MonotoneCubic([0, 1, 2], [0, 1, 2]).to_bspline()(1.5))
        1.5
        """
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: object) -> Self: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

class MonotoneSpline(PiecewisePolynomial):
    """A monotone interpolant: the base of `MonotoneCubic`, `MonotoneQuintic` and `MonotoneQuartic`.

    Not made directly. Every segment is monotone: increasing where its data increase, decreasing where
    they decrease, constant where they are.

    Examples
    --------
    >>> import shapespline as ss
    >>> isinstance(ss.MonotoneQuartic([0, 1, 2], [0, 1, 4]), ss.MonotoneSpline)
    True
    """
    def __new__(cls) -> Self: ...
    @property
    def y(self) -> _Floats:
        """The data, in their shape; a fresh array."""
    @property
    def slopes(self) -> _Floats:
        """Slopes at the points, in the shape of y; a fresh array."""
    @property
    def second_derivatives(self) -> _Floats:
        """Second derivatives at the points, in the shape of y (where they jump, as those of the quartic do, from
        the right, at the last point from the left); a fresh array.
        """
    @property
    def bending_energy(self) -> float | _Floats:
        """Bending energy ``∫ f''² dx`` over the knots: a float, or one a column."""
    @property
    def diagnostics(self) -> MonotoneDiagnostics | list[MonotoneDiagnostics]:
        """How the fit went: `MonotoneDiagnostics`, or a list of them in the order of the columns."""
    def inverse(self, y: ArrayLike) -> float | _Floats:
        """Evaluate the inverse function: the x with f(x) = y.

        Parameters
        ----------
        y : array_like
            Values, of any shape. NaN gives NaN. Outside the data's range what ``extrapolate`` of the
            function says for that end: of the tangent line its inverse (NaN where it is level), with
            ``"clip"`` the end knot, of a phase (``ends="periodic"`` with a rise) the place in the period
            that has the value, else NaN.

        Returns
        -------
        float or numpy.ndarray
            Of the shape of ``y``. Of a cumulative distribution function: its quantiles.

        Raises
        ------
        ValueError
            If the data have several columns, or are not strictly monotone.

        Notes
        -----
        Exact to a residual of some units in the last place. Cost O(log n) a value; many run on all
        threads.

        Examples
        --------
        >>> import shapespline as ss
        >>> cdf = ss.MonotoneQuintic([0, 1, 3], [0, 0.5, 1], extrapolate=False)
        >>> cdf.inverse([0.0, 0.5, 1.0, 1.5])
        array([ 0.,  1.,  3., nan])
        """

_Convex = Literal["data"] | ArrayLike | None
_Ends = Literal["estimated", "natural", "periodic"] | tuple[float | None, float | None]

@final
class MonotoneCubic(MonotoneSpline):
    """C² monotone cubic interpolation: of all monotone functions the one with the least bending energy.

    Parameters
    ----------
    x : array_like, shape (n,)
        Strictly increasing, n ≥ 2.
    y : array_like
        Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
    axis : int
        The axis of y that goes with x.
    convex : {"data"} or array_like of int, optional
        Where the function is to be convex or concave as well: ``"data"``, wherever the data are; or per
        interval 1 (convex), -1 (concave) or 0 (not asked), of shape (n - 1,) or as y with n - 1 entries
        along its axis. 1 beside -1 makes the point between them one of inflection. Where the data are
        neither convex nor concave throughout, intervals get up to eight knots.
    slopes : array_like, optional
        Slopes at the points, NaN where they are free (in the shape of ``y``, or (n,) for every column).
        A slope against the data is refused; the second derivative jumps at given slopes.
    ends : {"estimated", "natural", "periodic"} or pair of float or None
        ``"estimated"``: the slope of the cubic through the four points at the end, so that smooth data
        are followed to order four. ``"natural"``: free, the least energy. ``"periodic"``: f(x + T) =
        f(x) + D with the width T and the rise D of the data. A pair of slopes, None where free.
    layer : float
        Share of an interval beside a turn or a flat in which the second derivative falls to its value
        there, from 0 to 0.25. With 0 the energy is the least, and the function C¹ at turns and flats;
        with more it is C² everywhere, for at most ``(1 - layer)**-2`` times the energy.
    min_slope : float
        Share of the smallest secant slope of an interval and its neighbours below which the derivative
        never falls there where the data are strictly monotone, from 0 to less than 1.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        Outside the data: the tangent line at the end, which is the monotone continuation of least
        energy; the end value, the function repeated (with ``ends="periodic"`` up to the rise over a
        period), the end polynomial, NaN; of a pair the first below the data, the second above. None is
        "linear".

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
        differ, a slope that no monotone function through the data has, unknown names. The message says
        where.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    minimal_bending : the least energy that any monotone function through the data has.

    Notes
    -----
    Between two points the function is one cubic, or a parabola of slope that falls to zero, a level
    part and one that rises: at most two knots more per interval. The slopes at the points are the only
    unknowns of a convex problem, which Newton's method on a tridiagonal system solves to rounding in
    three to eight steps; ``lower_bound`` and ``interval_gaps`` prove it (Fenchel duality). Data that
    are not monotone are fitted piecewise; flats stay flat. Andersson and Elfving, *Interpolation and
    approximation by monotone cubic splines*, J. Approx. Theory 66 (1991) 302–333,
    doi:10.1016/0021-9045(91)90033-7, have the theory of this functional. Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.MonotoneCubic([0, 1, 2, 4], [0, 0, 1, 5])
    >>> f([0.5, 2.0, 4.0])
    array([0., 1., 5.])
    >>> f.bending_energy <= ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5]).bending_energy
    True
    """
    def __new__(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        axis: int = 0,
        *,
        convex: _Convex = None,
        slopes: ArrayLike | None = None,
        ends: _Ends = "estimated",
        layer: float = 0.0625,
        min_slope: float = 0.0,
        extrapolate: _Extrapolate = "linear",
    ) -> MonotoneCubic: ...
    @property
    def level_pieces(self) -> NDArray[np.int64] | list[NDArray[np.int64]]:
        """Intervals in which the function is level between two parabolas of slope: their indices, increasing;
        of many columns a list of such arrays.
        """
    @property
    def lower_bound(self) -> float | _Floats:
        """A bound from below of the bending energy of every monotone function through the data with the same
        ends and given slopes, without layers; with ``ends="natural"`` of every monotone function.
        """
    @property
    def smoothing(self) -> MonotoneSmoothing | None:
        """How noisy data were smoothed: `MonotoneSmoothing` for the result of `smooth_monotone`, None otherwise."""
    @property
    def interval_gaps(self) -> _Floats:
        """By how much the energy of every interval exceeds its part of ``lower_bound`` at most, without layers:
        in the shape of y with n - 1 entries along its axis.
        """

@final
class MonotoneQuartic(MonotoneSpline):
    """C¹ monotone quartic interpolation: local, one pass.

    Parameters
    ----------
    x : array_like, shape (n,)
        Strictly increasing, n ≥ 2.
    y : array_like
        Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
    axis : int
        The axis of y that goes with x.
    slopes : {"fritsch-butland"} or array_like
        Slopes at the knots: Fritsch and Butland's harmonic means, or given ones (in the shape of ``y``, or
        (n,) for every column), which are limited to 0 ≤ d ≤ 2Δ with Δ the smaller neighbouring secant slope.
    shape : float or pair of array_like, shape (n - 1,)
        Starting value of α = β, or (α, β) of every segment; from 0 to 1e300. They are scaled by the
        largest λ in [0, 1] that keeps the segment monotone. With 1 cubics with exact slopes are
        reproduced, and the error is of order 3; the paper's 3 bends more and is of order 2.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        Outside the knots: the tangent line at the end (then the function is C¹ and monotone everywhere),
        the end value, the function repeated, the end polynomial, NaN; of a pair the first below the
        knots, the second above. None is "linear".

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
        differ, unknown names. The message says where.
    TypeError
        If an argument is of a wrong kind.

    Notes
    -----
    Equations (3) and (15), conditions (12)–(13) and the four cases of Ng, Kong and Ong, *A class of
    Bézier-like splines in smooth monotone interpolation* (paper 003); slopes after Fritsch and
    Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300–304; at an end beside a turn or a flat that of the
    parabola through three points, as PCHIP has it. Data that are not monotone are fitted piecewise;
    flats stay flat. Cost O(n), and a point moves at most four segments.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.MonotoneQuartic([0, 1, 2, 4], [0, 0, 1, 5])
    >>> f([0.5, 2.0, 4.0])
    array([0., 1., 5.])
    >>> f.alpha.shape
    (3,)
    """
    def __new__(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        axis: int = 0,
        *,
        slopes: Literal["fritsch-butland"] | ArrayLike = "fritsch-butland",
        shape: float | tuple[ArrayLike, ArrayLike] = 1.0,
        extrapolate: _Extrapolate = "linear",
    ) -> MonotoneQuartic: ...
    @property
    def alpha(self) -> _Floats:
        """The paper's shape parameter α of every segment."""
    @property
    def beta(self) -> _Floats:
        """The paper's shape parameter β of every segment."""

@final
class MonotoneQuintic(MonotoneSpline):
    """C² monotone quintic interpolation with the least bending energy.

    Parameters
    ----------
    x : array_like, shape (n,)
        Strictly increasing, n ≥ 2.
    y : array_like
        Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
    axis : int
        The axis of y that goes with x.
    slopes : {"optimal", "fritsch-butland"} or array_like
        Slopes at the knots: chosen together with the second derivatives; Fritsch and Butland's
        harmonic means, with the paper's program; or given ones (in the shape of ``y``, or (n,) for every
        column). Those that a C² monotone quintic can have are taken as they are, up to nine times the
        secant at one end of a segment or six times at both; others are refused.
    energy : {"bending", "parametric"}
        What is least: ``∫ f''² dx``, or the paper's sum (20) over the segments' own parameters.
    clip : bool
        Limit given slopes that no C² monotone quintic has, instead of refusing them;
        ``diagnostics.limited`` says where.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        Outside the knots: the tangent line at the end (then the function is C¹ and monotone everywhere),
        the end value, the function repeated, the end polynomial, NaN; of a pair the first below the
        knots, the second above. None is "linear".

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
        differ, unknown names. The message says where.
    TypeError
        If an argument is of a wrong kind.

    Notes
    -----
    Equation (16), and the program (17), (20), (22), (23) of Ng, Kong and Ong, *A class of Bézier-like
    splines in smooth monotone interpolation* (paper 003), as a strictly convex box program in the
    second derivatives: that is ``slopes="fritsch-butland"`` alone. Its conditions α, β ≥ 0 are more than
    monotonicity asks, and make second derivatives about three times too large on smooth data (order
    two). Optimal and given slopes have all second derivatives that are monotone to choose from (order
    four, if given slopes are the function's): an interior-point method on the exact cone, within 0.5 %
    of the least energy, small segments beside large ones included; the result does not jump
    as the data move. Data that are not monotone are fitted piecewise; flats stay flat. Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5])
    >>> f([0.5, 2.0, 4.0])
    array([0., 1., 5.])
    >>> paper = ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5], slopes="fritsch-butland")
    >>> f.bending_energy <= paper.bending_energy
    True
    """
    def __new__(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        axis: int = 0,
        *,
        slopes: Literal["optimal", "fritsch-butland"] | ArrayLike = "optimal",
        energy: Literal["bending", "parametric"] = "bending",
        clip: bool = False,
        extrapolate: _Extrapolate = "linear",
    ) -> MonotoneQuintic: ...
    @property
    def alpha(self) -> _Floats:
        """The paper's shape parameter α of every segment. With slope 0 at the segment's
        start: ±∞, or 0 where any would do.
        """
    @property
    def beta(self) -> _Floats:
        """The paper's shape parameter β of every segment. With slope 0 at the segment's
        end: ±∞, or 0 where any would do.
        """
    @property
    def energy(self) -> Literal["bending", "parametric"]:
        """What was least: ``"bending"`` or ``"parametric"``."""

@final
class MonotoneSmoothing:
    """How noisy data were smoothed.

    Attributes
    ----------
    penalty : float
        The penalty λ; infinite for a straight line.
    residual : float
        The weighted sum of squares Σw(y − f)².
    degrees_of_freedom : float
        Trace of the derivative of the values with respect to the data, where active constraints stay
        active.
    increasing : bool
        Whether the function increases.
    steps : int
        Linear systems solved for the final penalty.
    converged : bool
        Whether the optimum was reached.

    Examples
    --------
    >>> import shapespline as ss
    >>> how = ss.smooth_monotone([0, 1, 2, 3], [0, 1, 2, 3], penalty=1.0).smoothing
    >>> how.converged, how.increasing, how.steps
    (True, True, 1)
    """
    @property
    def penalty(self) -> float:
        """The penalty λ; infinite for a straight line."""
    @property
    def residual(self) -> float:
        """The weighted sum of squares Σw(y − f)²."""
    @property
    def degrees_of_freedom(self) -> float:
        """Trace of the derivative of the values with respect to the data."""
    @property
    def increasing(self) -> bool:
        """Whether the function increases, or decreases."""
    @property
    def steps(self) -> int:
        """Linear systems solved for the final penalty."""
    @property
    def converged(self) -> bool:
        """Whether the optimum was reached."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class MonotoneRecord:
    """A criterion on a segment.

    ``margin`` is the least value there of f'/(Δy/Δx) (monotonicity), or of f'' in the direction
    asked relative to the changes of the secants beside it (convexity), at ``location``; below 0
    the criterion is violated. ``satisfied`` is None where rounding hides it.

    Examples
    --------
    >>> import shapespline as ss
    >>> report = ss.check_monotone([0, 1], [0, 2], ss.MonotoneCubic([0, 1], [0, 2]))
    >>> report.segments[0].criterion, round(report.segments[0].margin, 12)
    ('monotonicity', 1.0)
    """
    def __new__(
        cls, segment: int, criterion: str, satisfied: bool | None, margin: float, location: float
    ) -> Self: ...
    @property
    def segment(self) -> int:
        """Index of the segment, from 0."""
    @property
    def criterion(self) -> Literal["monotonicity", "convexity"]:
        """``"monotonicity"`` or ``"convexity"``."""
    @property
    def satisfied(self) -> bool | None:
        """Whether the function meets it; None where rounding hides it."""
    @property
    def margin(self) -> float:
        """Signed distance from failure, without unit."""
    @property
    def location(self) -> float:
        """The x at which the margin is smallest."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class MonotoneReport:
    """Whether a function rises, falls and bends as its data do: what `check_monotone` gives.

    ``print(report)`` lists the violations. Truth is refused: ask ``ok``.

    Examples
    --------
    >>> import shapespline as ss
    >>> print(ss.check_monotone([0, 1], [0, 2], ss.MonotoneCubic([0, 1], [0, 2])))
    shape preserved on 1 segments
    criterion         violated  applicable
    monotonicity             0           1
    """
    @property
    def ok(self) -> bool:
        """Whether nothing is violated for certain."""
    @property
    def segments(self) -> list[MonotoneRecord]:
        """A record of every segment and criterion that is asked of it."""
    @property
    def violations(self) -> list[MonotoneRecord]:
        """The records of what is violated for certain."""
    @property
    def undecided(self) -> list[MonotoneRecord]:
        """The records of what rounding hides."""
    def counts(self) -> dict[str, tuple[int, int]]:
        """Return on how many segments each criterion is violated, and on how many it is asked."""
    def to_dict(self) -> dict[str, Any]:
        """Return plain data in the form of ``ShapeReport.to_dict``."""
    def __bool__(self) -> NoReturn: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class MonotoneDiagnostics:
    """How the optimisation of one column went. The function is monotone whatever these numbers say.

    Attributes
    ----------
    solver : str
        ``"newton"`` (cubic), ``"active-set"`` (quintic, slopes of Fritsch and Butland), ``"interior-point"`` (quintic, optimal
        or given slopes) or ``"local"`` (quartic).
    iterations : int
        Linear solves.
    active : int
        Conditions that hold with equality; of the cubic: intervals with a level part; of the quartic:
        segments whose α, β were scaled down.
    kkt_residual : float
        Largest violation of the optimality conditions, scaled. Of the interior point, and of the cubic
        without layers: a bound of how far the energy is above the exact optimum, as a part of it
        (infinite where none was reached).
    converged : bool
        Whether the method ended by its own criterion.
    certified : bool
        Whether Bernstein coefficients certify every segment to be monotone.
    energy : float
        The minimised energy, in the data's units.
    limited : list of int
        Points whose given slopes were limited (``clip=True``).

    Examples
    --------
    >>> import shapespline as ss
    >>> how = ss.MonotoneQuintic([0, 1, 2, 5], [0, 0.1, 3, 3.2]).diagnostics
    >>> how.solver, how.converged, how.certified
    ('interior-point', True, True)
    """
    def __new__(
        cls,
        solver: str,
        iterations: int,
        active: int,
        kkt_residual: float,
        converged: bool,
        certified: bool,
        energy: float,
        limited: list[int],
    ) -> Self: ...
    @property
    def solver(self) -> str:
        """The method: ``"newton"``, ``"active-set"``, ``"interior-point"`` or ``"local"``."""
    @property
    def iterations(self) -> int:
        """Linear solves of the optimisation."""
    @property
    def active(self) -> int:
        """Conditions that hold with equality."""
    @property
    def kkt_residual(self) -> float:
        """Scaled violation of the optimality conditions, or bound of the distance from the optimum."""
    @property
    def converged(self) -> bool:
        """Whether the method ended by its own criterion."""
    @property
    def certified(self) -> bool:
        """Whether every segment was certified to be monotone."""
    @property
    def energy(self) -> float:
        """The minimised energy, in the data's units."""
    @property
    def limited(self) -> list[int]:
        """Points whose given slopes were limited."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@disjoint_base
class PiecewiseRows:
    """Functions of many rows, each with its own knots: the base of `MonotoneRows`.

    Not made directly: derivatives and antiderivatives of what `fit_many_monotone` gives are of this
    class. A sequence: ``len(f)`` rows, ``f[k]`` the function of one. Immutable; can be pickled, copied
    and shared between threads.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    >>> f.derivative()(1.0)
    array([1. , 0.5])
    """
    def __new__(cls) -> Self: ...
    @property
    def x(self) -> _Floats | list[_Floats]:
        """Abscissae of the data of all rows, in their arrangement: of shape (rows, n), or with offsets one row
        after another; of derivatives and antiderivatives knots, as a list of arrays where the rows have
        knots between their data. Fresh arrays.
        """
    @property
    def knots(self) -> list[_Floats]:
        """Knots between which the rows are polynomials: a list of one fresh array per row."""
    @property
    def extrapolate(self) -> str | bool | tuple[str | bool, str | bool]:
        """What all rows are outside their knots, as `PiecewisePolynomial.extrapolate`."""
    def __call__(
        self,
        x: ArrayLike,
        nu: int = 0,
        extrapolate: _Extrapolate = None,
        *,
        offsets: ArrayLike | None = None,
    ) -> _Floats:
        """Evaluate every row, or a derivative.

        Parameters
        ----------
        x : array_like
            A number or one axis: the same places for every row. Two axes: row k of ``x`` for row k.
            With ``offsets`` one axis: the places of all rows one after another.
        nu : int
            Order of the derivative.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for a call of `MonotoneQuintic`.
        offsets : array_like of int, shape (rows + 1,), optional
            Row k is evaluated at ``x[offsets[k]:offsets[k + 1]]``.

        Returns
        -------
        numpy.ndarray, shape (rows,), (rows, places) or, with offsets, that of x
            One row a row.

        Raises
        ------
        ValueError, TypeError
            If ``x`` or ``offsets`` do not fit the rows, or an argument is of a wrong kind.

        Notes
        -----
        Cost O(log n) a place; many run on all threads.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
        >>> f([[0.5, 1.5], [1, 3]])
        array([[0.5, 1.5],
               [0.5, 1.5]])
        >>> f([0.5, 1, 2, 3], offsets=[0, 1, 4])
        array([0.5, 0.5, 1. , 1.5])
        """
    def __len__(self) -> int: ...
    def __getitem__(self, row: int, /) -> PiecewisePolynomial: ...
    def derivative(self, nu: int = 1) -> PiecewiseRows:
        """Return the derivatives of all rows as functions.

        Parameters
        ----------
        nu : int
            Their order.

        Returns
        -------
        PiecewiseRows
            Row by row what `PiecewisePolynomial.derivative` gives. Cost O(total).

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
        >>> f.derivative()([0.5, 1.5])
        array([[1. , 1. ],
               [0.5, 0.5]])
        """
    def antiderivative(self, nu: int = 1) -> PiecewiseRows:
        """Antiderivatives of all rows as functions: zero at their first knots.

        Parameters
        ----------
        nu : int
            How often to integrate; at most 100.

        Returns
        -------
        PiecewiseRows
            Row by row what `PiecewisePolynomial.antiderivative` gives. Cost O(total).

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
        >>> f.antiderivative()(2.0).round(12)
        array([2., 1.])
        """
    def integrate(self, a: ArrayLike, b: ArrayLike, extrapolate: _Extrapolate = None) -> _Floats:
        """Return the definite integral of every row.

        Parameters
        ----------
        a, b : float or array_like, shape (rows,)
            The ends, in any order, also outside the knots: for all rows, or one per row. NaN gives NaN;
            ±∞ gives the limit, NaN where there is none.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for a call.

        Returns
        -------
        numpy.ndarray, shape (rows,)
            One number per row. Cost O(log n) a row after a first call of O(n).

        Raises
        ------
        ValueError, TypeError
            If there are neither one nor as many ends as rows.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
        >>> f.integrate(0, [2, 4]).round(12)
        array([2., 4.])
        """
    def roots(self, extrapolate: _Extrapolate = None) -> NDArray[np.object_]:
        """All x with f(x) = 0 of every row: `solve` for zero.

        Parameters
        ----------
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for `PiecewisePolynomial.roots`.

        Returns
        -------
        numpy.ndarray, shape (rows,)
            As of `solve`.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[-1, 0, 1], [-1, 1, 3]])
        >>> f.roots()
        array([array([1.]), array([1.])], dtype=object)
        """
    def solve(self, y: ArrayLike, extrapolate: _Extrapolate = None) -> NDArray[np.object_]:
        """All x with f(x) = y of every row.

        Parameters
        ----------
        y : float or array_like, shape (rows,)
            Finite values: one for all rows, or one per row.
        extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
            As for `PiecewisePolynomial.solve`.

        Returns
        -------
        numpy.ndarray, shape (rows,)
            Of dtype object: row by row the array that `PiecewisePolynomial.solve` gives. Cost O(total).

        Raises
        ------
        ValueError, TypeError
            If a value is not finite, or there are neither one nor as many values as rows.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[-1, 0, 1], [-1, 1, 3]])
        >>> f.solve([0.5, 2])
        array([array([1.5]), array([3.])], dtype=object)
        """
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: object) -> Self: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class MonotoneRows(PiecewiseRows):
    """Monotone interpolants of many rows, each with its own x: what `fit_many_monotone` gives.

    A sequence: ``len(f)`` rows, ``f[k]`` the interpolant of one. A call evaluates row by row.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    >>> len(f), f(1.0), f[1](1.0)
    (2, array([1. , 0.5]), 0.5)
    """
    def __new__(cls) -> Self: ...
    def __getitem__(self, row: int, /) -> MonotoneCubic | MonotoneQuintic | MonotoneQuartic: ...
    def inverse(self, y: ArrayLike, *, offsets: ArrayLike | None = None) -> _Floats:
        """Evaluate the inverse functions: in every row the x with f(x) = y.

        Parameters
        ----------
        y : array_like
            Values, arranged as the places of a call. NaN gives NaN; outside a row's range as
            `MonotoneSpline.inverse`.
        offsets : array_like of int, shape (rows + 1,), optional
            As for a call.

        Returns
        -------
        numpy.ndarray
            In the shape that a call would give. Of distribution functions: their quantiles.

        Raises
        ------
        ValueError
            If the data of a row are not strictly monotone; the message names it.

        Notes
        -----
        Exact to a residual of some units in the last place. Cost O(log n) a value; many run on all
        threads.

        Examples
        --------
        >>> import shapespline as ss
        >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
        >>> f.inverse([0.5, 1.0])
        array([[0.5, 1. ],
               [1. , 2. ]])
        """
    @property
    def y(self) -> _Floats:
        """The data, in their arrangement; a fresh array."""
    @property
    def slopes(self) -> _Floats:
        """Slopes at the knots, in the arrangement of the data; a fresh array."""
    @property
    def second_derivatives(self) -> _Floats:
        """Second derivatives at the knots, as `MonotoneSpline.second_derivatives`, in the arrangement of the
        data; a fresh array.
        """
    @property
    def energy(self) -> Literal["bending", "parametric"] | None:
        """What the quintics minimise: ``"bending"`` or ``"parametric"``; None of quartics."""
    @property
    def bending_energy(self) -> _Floats:
        """Bending energy ``∫ f''² dx`` of every row; a fresh array."""
    @property
    def diagnostics(self) -> list[MonotoneDiagnostics]:
        """How the fit of every row went: a list of `MonotoneDiagnostics`."""

def fit_many_monotone(
    x: ArrayLike,
    y: ArrayLike,
    *,
    kind: Literal["cubic", "quintic", "quartic"] = "cubic",
    offsets: ArrayLike | None = None,
    convex: _Convex = None,
    slopes: Literal["optimal", "fritsch-butland"] | ArrayLike | None = None,
    ends: _Ends | None = None,
    layer: float | None = None,
    min_slope: float | None = None,
    energy: Literal["bending", "parametric"] | None = None,
    clip: bool = False,
    shape: float | tuple[ArrayLike, ArrayLike] | None = None,
    extrapolate: _Extrapolate = "linear",
) -> MonotoneRows:
    """Fit monotone interpolants to many rows, each with its own x, in parallel.

    Parameters
    ----------
    x, y : array_like, shape (rows, n) or (total,)
        Row by row; or all rows one after another, with ``offsets``.
    kind : {"cubic", "quintic", "quartic"}
        `MonotoneCubic`, `MonotoneQuintic` or `MonotoneQuartic`.
    offsets : array_like of int, shape (rows + 1,), optional
        Row k is ``x[offsets[k]:offsets[k + 1]]``, and so for y.
    slopes : {"optimal", "fritsch-butland"} or array_like, optional
        As for the kind, with one slope per entry of ``y``; None is its own default. Where x and y have
        two axes, slopes of shape (n,) are for every row. The cubic takes numbers alone, NaN where free.
    convex, ends, layer, min_slope
        For the cubic alone, as for `MonotoneCubic`; None is its own default. Signs of ``convex`` are of
        shape (n - 1,) or (rows, n - 1); with offsets there are none.
    energy : {"bending", "parametric"}, optional
        For the quintic alone; None is "bending".
    clip : bool
        For the quintic alone: limit given slopes that no monotone function has, instead of refusing them.
    shape : float or pair of array_like, optional
        For the quartic alone; None is 1.
    extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
        As for `MonotoneCubic`.

    Returns
    -------
    MonotoneRows
        Evaluates row by row; indexing gives the interpolant of a row.

    Raises
    ------
    ValueError, TypeError
        As for the kind, where the message names the row; and for an option that the kind lacks.

    Notes
    -----
    See `MonotoneCubic`, `MonotoneQuintic` and `MonotoneQuartic`. Cost O(total), on all threads.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.fit_many_monotone([0, 1, 2, 0, 3], [0, 1, 2, 0, 6], offsets=[0, 3, 5])
    >>> f(1.0)
    array([1., 2.])
    """

def smooth_monotone(
    x: ArrayLike,
    y: ArrayLike,
    *,
    weights: ArrayLike | None = None,
    residual: float | None = None,
    penalty: Literal["gcv"] | float = "gcv",
    increasing: bool | None = True,
    convex: ArrayLike | None = None,
    bounds: tuple[float | None, float | None] | None = None,
) -> MonotoneCubic:
    """Smooth noisy data with a monotone cubic.

    Parameters
    ----------
    x : array_like, shape (n,)
        Not decreasing, with at least two distinct values. Equal and nearly equal abscissae (within 1e-9
        of their range) are merged: weights add up, values are averaged.
    y : array_like, shape (n,)
        Noisy data.
    weights : array_like, shape (n,), optional
        Positive weights; 1 by default. Where the noise is known, the inverse of its variance.
    residual : float, optional
        The largest sum of squares Σw(y − f)² to leave; the penalty follows from it.
    penalty : {"gcv"} or float
        The penalty λ of the bending energy. ``"gcv"`` minimises the generalized cross-validation score,
        counting only degrees of freedom that no constraint holds. 0 is the isotonic regression, which
        interpolates monotone data. Give a number or ``residual``, not both.
    increasing : bool or None
        Whether the function increases. None takes the sign of the weighted regression line;
        ``smoothing.increasing`` says which.
    convex : {-1, 0, 1} or array_like of int, shape (n - 1,), optional
        Where the function is to be convex (1) or concave (-1) as well: everywhere, or per interval
        between the x, 0 where it may bend either way.
    bounds : pair of float or None, optional
        Lower and upper bound of the function, None where there is none. The data may lie outside.

    Returns
    -------
    MonotoneCubic
        The function of least ``Σ w (y − f(x))² + λ ∫ f''² dx`` among all monotone functions, with
        ``convex`` among those that are convex and concave as well where that is asked. Its attribute
        ``smoothing`` is a `MonotoneSmoothing`; its ``x`` and ``y`` are the (merged) abscissae and its own
        values there.

    Raises
    ------
    ValueError
        If an argument holds unusable values: NaN, infinities, x that decreases or is constant, weights
        that are not positive, both a residual and a penalty, a residual below the least possible one
        (that of the isotonic regression), a lower bound that is not below the upper one, signs other than
        -1, 0 and 1, no penalty with ``convex`` (the function would have kinks). The message says where.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    MonotoneCubic : interpolation, for data without noise.

    Notes
    -----
    The objective is jointly convex in the first value, the rises and the slopes; an interior-point
    method and Newton's method solve it to rounding, in O(n) per step of some 20. Where monotonicity is
    no constraint, the function equals SciPy's ``make_smoothing_spline(x, y, w, lam)``. The second
    derivative is continuous but where intervals of which convexity is asked differently meet, at points
    of slope 0 beside such intervals, and at the ends of constant parts.

    Examples
    --------
    >>> import shapespline as ss
    >>> f = ss.smooth_monotone([0, 1, 2, 3, 4], [0.1, 0.0, 0.6, 1.1, 0.9], penalty=0.1)
    >>> bool((f.slopes >= 0).all()), f.smoothing.converged
    (True, True)
    """

def minimal_bending(x: ArrayLike, y: ArrayLike) -> float | _Floats:
    """Return the least bending energy ``∫ f''² dx`` of any monotone function through the data.

    Parameters
    ----------
    x : array_like, shape (n,)
        Strictly increasing, n ≥ 2.
    y : array_like
        Data with n entries along the first axis; the functions are monotone wherever the data are.

    Returns
    -------
    float or numpy.ndarray
        Infinite where it overflows; one number per column. No interpolant that is monotone has less,
        whatever its kind: what a fit has more is what it could do better.

    Raises
    ------
    ValueError, TypeError
        As for `MonotoneCubic`.

    Notes
    -----
    The energy of ``MonotoneCubic(x, y, ends="natural", layer=0)``, see there. Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.minimal_bending([0, 1, 2], [0, 1, 2])
    0.0
    """

def bezier_like(
    degree: Literal[3, 4, 5],
    control: ArrayLike,
    t: ArrayLike,
    *,
    a: float = 3.0,
    b: float = 3.0,
    alpha: float | None = None,
    beta: float | None = None,
    nu: int = 0,
) -> _Floats:
    """Evaluate a cubic, quartic or quintic Bézier-like curve, or a derivative of it.

    Parameters
    ----------
    degree : {3, 4, 5}
        The degree of the curve.
    control : array_like, shape (4, dim) or (4,)
        Control points V₀ … V₃ in any dimension; the curve runs from V₀ to V₃.
    t : array_like
        Parameters, of any shape; the curve proper is 0 ≤ t ≤ 1.
    a, b : float
        The end derivatives are a(V₁ - V₀) and b(V₃ - V₂): the paper's a, and its b of the cubic, q of
        the quartic, g of the quintic.
    alpha, beta : float
        Shape parameters of the quartic and the quintic: growing ones pull the curve towards V₁ (α) and
        V₂ (β) in a nested family.
    nu : int
        Order of the derivative.

    Returns
    -------
    numpy.ndarray, shape (*t.shape, dim)
        Points, or derivatives with respect to t; for ``control`` of shape (4,) without the last axis.

    Raises
    ------
    ValueError, TypeError
        If an argument is of a wrong kind or shape, not finite, or of no meaning for the degree.

    Notes
    -----
    Equations (1), (3) and (7) of Ng, Kong and Ong (paper 003), with the corrected p = a/2, q = g/2 in
    (7). The curve lies in the convex hull of its control points while the parameters a, b (and αa, βb)
    of the cubics it mixes are in [0, 3]; a = b = 3 of the cubic is the Bézier curve. Cost O(1) a point.

    Examples
    --------
    >>> import shapespline as ss
    >>> square = [[0, 0], [0, 1], [1, 1], [1, 0]]
    >>> ss.bezier_like(3, square, 0.5)
    array([0.5 , 0.75])
    >>> ss.bezier_like(5, square, [0.0, 1.0], a=2, alpha=0.5)
    array([[0., 0.],
           [1., 0.]])
    """
