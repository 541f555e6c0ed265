# SPDX-License-Identifier: MIT OR Apache-2.0

"""The discrete shape of points."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from shapespline import _core
from shapespline._pickling import sealed

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from shapespline._core import Tangents, _Boundary, _Criterion, _Parametrization

    Floats = NDArray[np.float64]

__all__ = ["PolygonShape", "polygon_shape"]

#: Segments that a printed table shows before it only counts them.
LISTED = 40


@dataclass(frozen=True, eq=False, repr=False)
class PolygonShape:
    """What points say about the shape of a curve through them; made by `polygon_shape`.

    Prints as a table, one line a segment. Immutable and picklable; the arrays are read-only.

    Attributes
    ----------
    points : numpy.ndarray, shape (n, dim)
        The points.
    parameters : numpy.ndarray, shape (n,)
        Their parameters.
    extent : {"line", "plane", "space"}
        What the points lie in.
    chords : numpy.ndarray, shape (n - 1, dim)
        L[i] = points[i + 1] - points[i].
    binormals : numpy.ndarray, shape (n, 3)
        Unit vectors along P[i] = L[i - 1] × L[i]; zero where the polygon does not turn, and at ends
        with zero curvature.
    turning_angles : numpy.ndarray, shape (n,)
        Angles between the chords at each point, in radians.
    torsion : numpy.ndarray, shape (n - 1,)
        Discrete torsion det[L[i - 1], L[i], L[i + 1]] / (‖P[i]‖ ‖P[i + 1]‖) in reciprocal units of
        the points; NaN where a binormal vanishes.
    calls : tuple[tuple[str, ...], ...]
        The default criteria that each segment requires.

    Examples
    --------
    >>> import shapespline as ss
    >>> shape = ss.polygon_shape([[0, 0], [1, 1], [2, 0], [3, 1]])
    >>> shape.extent, shape.calls
    ('plane', (('turning',), ('inflection', 'turning'), ('turning',)))
    """

    points: Floats
    parameters: Floats
    extent: str
    chords: Floats
    binormals: Floats
    turning_angles: Floats
    torsion: Floats
    calls: tuple[tuple[_Criterion, ...], ...]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.flags.writeable = False

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the attributes, so that arrays are read-only again."""
        return sealed(type(self), *(getattr(self, field.name) for field in fields(self)))

    def counts(self) -> dict[str, int]:
        """Return how many segments require each criterion, those that none requires left out.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.polygon_shape([[0, 0], [1, 1], [2, 0], [3, 1]]).counts()
        {'turning': 3, 'inflection': 1}
        """
        counts: dict[str, int] = {}
        for names in self.calls:
            for name in names:
                counts[name] = counts.get(name, 0) + 1
        return counts

    def to_dict(self) -> dict[str, Any]:
        """Return plain data that ``json.dumps`` takes; torsion that does not exist is ``None``.

        Examples
        --------
        >>> import shapespline as ss
        >>> ss.polygon_shape([[0, 0], [3, 4]]).to_dict()["torsion"]
        [None]
        """
        plain: dict[str, Any] = {}
        for field in fields(self):
            value = getattr(self, field.name)
            plain[field.name] = value.tolist() if isinstance(value, np.ndarray) else value
        plain["torsion"] = [x if np.isfinite(x) else None for x in plain["torsion"]]
        plain["calls"] = [list(names) for names in self.calls]
        return plain

    def __repr__(self) -> str:
        """Return the sizes in a line."""
        where = {"line": "on a line", "plane": "in a plane", "space": "in space"}[self.extent]
        return f"<PolygonShape: {len(self.points)} points {where}>"

    def __str__(self) -> str:
        """Return a table, one line a segment."""
        lines = [repr(self)[1:-1], f"{'segment':>7}{'turn °':>9}{'torsion':>13}  requires"]
        degrees = np.degrees(self.turning_angles)
        for i, names in enumerate(self.calls[:LISTED]):
            torsion = f"{self.torsion[i]:13.4g}" if np.isfinite(self.torsion[i]) else f"{'–':>13}"
            lines.append(f"{i:7}{degrees[i]:9.2f}{torsion}  {', '.join(names) or '–'}")
        if len(self.calls) > LISTED:
            lines.append(f"… and {len(self.calls) - LISTED} more")
        return "\n".join(lines)


def polygon_shape(
    points: ArrayLike,
    parameters: _Parametrization | float | ArrayLike = "chordal",
    *,
    boundary: _Boundary | Tangents | None = None,
    closed: bool = False,
    repeated: Literal["error", "drop"] = "error",
    resolution: float = 0.0,
    tolerance: float = 1e-9,
) -> PolygonShape:
    """Return what points say about the shape of a curve through them.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        The points, n ≥ 2; neighbours must differ.
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
        As for `NuSpline`.
    boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents, optional
        End conditions, as for `NuSpline`: what stands in for the missing chord at each end.
        Default: periodic if ``closed``, else natural.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other.
        Arrays of parameters then have one entry more, for the return to the first point, unless the
        points repeat it.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case.
    resolution : float
        Accuracy of the points, in their units: what a move of the points by that much could
        undo is not called for. Default 0.
    tolerance : float
        In [0, 1): points whose turning angle has a smaller sine count as collinear, and four whose
        unit chords span a smaller volume as coplanar.

    Returns
    -------
    PolygonShape
        Chords, binormals, turning angles, discrete torsion, and the criteria that each segment
        requires.

    Raises
    ------
    ValueError, TypeError
        As for `NuSpline`.

    See Also
    --------
    check_shape : does a curve keep that shape?

    Notes
    -----
    Karavelas & Kaklis, Numer. Algorithms 23 (2000), (2.1) and the index sets (5.34)–(5.39). Cost
    O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> shape = ss.polygon_shape([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 1]])
    >>> shape.calls[1]
    ('turning', 'torsion')
    >>> shape.torsion[1:3]
    array([1., 1.])
    """
    parts = _core._polygon_shape(
        points, parameters, boundary, closed, repeated, resolution, tolerance
    )
    parts["calls"] = tuple(tuple(names) for names in parts["calls"])
    return PolygonShape(**parts)
