# SPDX-License-Identifier: MIT OR Apache-2.0

"""Small records that reports are made of: named tuples, so they compare, hash and pickle."""

from __future__ import annotations

from typing import Any, NamedTuple

from shapespline._pickling import sealed

__all__ = ["NodeRecord", "OscillationRecord", "UndecidedRecord"]


class UndecidedRecord(NamedTuple):
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

    segment: int
    criterion: str
    interval: tuple[float, float]

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the fields."""
        return sealed(type(self), *self)


class NodeRecord(NamedTuple):
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

    node: int
    condition: str
    satisfied: bool
    margin: float
    location: float

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the fields."""
        return sealed(type(self), *self)


class OscillationRecord(NamedTuple):
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

    segment: int
    crossings: int
    least: int
    satisfied: bool
    amplitude: float
    location: float

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the fields."""
        return sealed(type(self), *self)


# help() and editors show these; a named tuple would say "Alias for field number 0".
for _class, _fields in (
    (
        UndecidedRecord,
        {
            "segment": "Index of the segment, from 0.",
            "criterion": "Name of the criterion.",
            "interval": "The parameters between which the question stays open.",
        },
    ),
    (
        NodeRecord,
        {
            "node": "Index of the point, from 0.",
            "condition": "Name of the condition; see ShapeReport.nodes.",
            "satisfied": "Whether the curve meets it.",
            "margin": "Signed distance from failure, without unit.",
            "location": "Parameter at which the margin is smallest.",
        },
    ),
    (
        OscillationRecord,
        {
            "segment": "Index of the segment, which requires coplanarity.",
            "crossings": "How often it crosses the plane between its points.",
            "least": "The least crossings that its end tangents allow.",
            "satisfied": "Whether there are no more than the least.",
            "amplitude": "Greatest distance from the plane over the length of the chord.",
            "location": "Parameter of that distance.",
        },
    ),
):
    for _name, _text in _fields.items():
        getattr(_class, _name).__doc__ = _text
