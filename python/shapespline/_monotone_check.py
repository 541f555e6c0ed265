# SPDX-License-Identifier: MIT OR Apache-2.0

"""Does a function keep the monotonicity and the convexity of its data? Of any library's functions.

Decided on the Bernstein form of the derivatives: its least coefficient bounds them from below, its
ends are values of them, and halving a piece brings the two together quadratically. Nothing is
sampled, so a dip between two points is found however narrow it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from shapespline._core import InputError
from shapespline._pickling import sealed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from shapespline._core import PiecewiseBezier

    Floats = NDArray[np.float64]
    Truths = NDArray[np.bool_]

__all__ = ["MonotoneRecord", "MonotoneReport", "check", "increasing", "signs_of_data"]

#: Violations that a printed report lists before it only counts them.
LISTED = 20


class MonotoneRecord(NamedTuple):
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

    segment: int
    criterion: str
    satisfied: bool | None
    margin: float
    location: float

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the fields."""
        return sealed(type(self), *self)


@dataclass(frozen=True, eq=False)
class Verdicts:
    """A criterion on all segments: margins, where, what rounding may hide, where it is asked."""

    margins: Floats
    locations: Floats
    rounding: Floats
    asked: Truths
    tolerance: float

    @property
    def violated(self) -> Truths:
        """Where the criterion is violated for certain."""
        wrong: Truths = self.asked & (self.margins < -self.tolerance - self.rounding)
        return wrong

    @property
    def undecided(self) -> Truths:
        """Where rounding hides whether it is."""
        open_: Truths = self.asked & ~self.violated & (self.margins < -self.tolerance)
        return open_

    @property
    def satisfied(self) -> Truths:
        """Where it is satisfied, or could be but for rounding."""
        kept: Truths = ~self.violated
        return kept

    def records(self, criterion: str) -> Iterator[MonotoneRecord]:
        """Yield a record of every segment on which the criterion is asked."""
        for i in np.flatnonzero(self.asked).tolist():
            verdict = None if self.undecided[i] else not self.violated[i]
            margin, place = float(self.margins[i]), float(self.locations[i])
            yield MonotoneRecord(i, criterion, verdict, margin, place)


@dataclass(frozen=True, eq=False)
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

    monotonicity: Verdicts
    #: None where it was not asked.
    convexity: Verdicts | None

    @property
    def ok(self) -> bool:
        """Whether nothing is violated for certain."""
        return not self.violations

    @property
    def segments(self) -> list[MonotoneRecord]:
        """A record of every segment and criterion that is asked of it."""
        return [record for name, verdicts in self._criteria() for record in verdicts.records(name)]

    @property
    def violations(self) -> list[MonotoneRecord]:
        """The records of what is violated for certain."""
        return [record for record in self.segments if record.satisfied is False]

    @property
    def undecided(self) -> list[MonotoneRecord]:
        """The records of what rounding hides."""
        return [record for record in self.segments if record.satisfied is None]

    def _criteria(self) -> list[tuple[str, Verdicts]]:
        found = [("monotonicity", self.monotonicity)]
        return found if self.convexity is None else [*found, ("convexity", self.convexity)]

    def counts(self) -> dict[str, tuple[int, int]]:
        """Return on how many segments each criterion is violated, and on how many it is asked."""
        return {
            name: (int(verdicts.violated.sum()), int(verdicts.asked.sum()))
            for name, verdicts in self._criteria()
        }

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in the form of ``ShapeReport.to_dict``."""
        records = [
            {
                "segment": record.segment,
                "criterion": record.criterion,
                "applicable": True,
                "satisfied": record.satisfied,
                "margin": record.margin,
                "location": record.location,
            }
            for record in self.segments
        ]
        counts = {
            name: {"violated": violated, "applicable": asked}
            for name, (violated, asked) in self.counts().items()
        }
        return {
            "ok": self.ok,
            "margin": min(record.margin for record in self.segments),
            "counts": counts,
            "tolerance": self.monotonicity.tolerance,
            "segments": records,
            "violations": [record for record in records if record["satisfied"] is False],
            "undecided": [record for record in records if record["satisfied"] is None],
        }

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle by the fields."""
        return sealed(type(self), self.monotonicity, self.convexity)

    def __bool__(self) -> bool:
        """Refuse: whether a report is true could mean several things."""
        raise TypeError("the truth of a MonotoneReport is ambiguous: use report.ok")

    def __str__(self) -> str:
        """Return a verdict, a table of the criteria, and the violations."""
        wrong = self.violations
        n = len(self.monotonicity.margins)
        verdict = "preserved" if self.ok else "violated"
        lines = [f"shape {verdict} on {n} segments"]
        lines += [f"{'criterion':<16}{'violated':>10}{'applicable':>12}"]
        lines += [
            f"{name:<16}{violated:>10}{asked:>12}"
            for name, (violated, asked) in self.counts().items()
        ]
        if wrong:
            lines += ["", f"{'violated':<16}{'segment':>10}{'margin':>12}{'at x':>16}"]
        lines += [
            f"{r.criterion:<16}{r.segment:>10}{r.margin:>12.3e}{r.location:>16.12g}"
            for r in wrong[:LISTED]
        ]
        if len(wrong) > LISTED:
            lines.append(f"… and {len(wrong) - LISTED} more")
        if hidden := len(self.undecided):
            lines.append(f"undecided within rounding: {hidden}")
        return "\n".join(lines)


def _cut(c: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Return the Bernstein coefficients on [0, t] and [t, 1], one row a polynomial: de Casteljau.

    ``t`` has one value a row.
    """
    left, right, work = np.empty_like(c), np.empty_like(c), c
    t = t[:, None]
    for k in range(c.shape[1]):
        left[:, k], right[:, c.shape[1] - 1 - k] = work[:, 0], work[:, -1]
        work = (1 - t) * work[:, :-1] + t * work[:, 1:]
    return left, right


def _values(x: Floats, y: Floats, curve: PiecewiseBezier) -> tuple[Floats, Floats]:
    """Return breaks, those of the data among them, and the values' coefficients between them."""
    control, breaks = curve.control, curve.breaks
    if control.shape[2] != 2 or curve.weights is not None:
        text = "monotonicity is for the graph of a function: polynomials in the plane"
        raise InputError(text, "curve")
    extent = np.ptp(x)
    t = np.linspace(0, 1, control.shape[1])
    graph = breaks[:-1, None] * (1 - t) + breaks[1:, None] * t
    apart = np.abs(control[:, :, 0] - graph)
    if apart.max() > 1e-9 * extent:
        i = int(apart.max(axis=1).argmax())
        raise InputError(
            "monotonicity is for the graph of a function, whose parameter is x; the parameter of "
            f"piece {i} is not",
            "curve",
            i,
        )
    if abs(breaks[0] - x[0]) > 1e-9 * extent or abs(breaks[-1] - x[-1]) > 1e-9 * extent:
        raise InputError(
            f"the function runs from {breaks[0]:g} to {breaks[-1]:g}, the points from {x[0]:g} to "
            f"{x[-1]:g}",
            "curve",
        )
    distance = np.abs(curve(np.clip(x, breaks[0], breaks[-1]))[:, 1] - y)
    if distance.max() > 1e-9 * (np.ptp(y) or 1.0):
        i = int(distance.argmax())
        raise InputError(
            f"the curve does not pass through points[{i}]: at x = {x[i]:g} it is {distance[i]:.3g} "
            "away",
            "points",
            i,
            float(distance[i]),
        )
    cuts = np.unique(np.concatenate([x, breaks[1:-1]]))
    cuts = cuts[(cuts >= x[0]) & (cuts <= x[-1])]
    piece = np.clip(np.searchsorted(breaks, (cuts[:-1] + cuts[1:]) / 2) - 1, 0, len(control) - 1)
    width = np.diff(breaks)[piece]
    end = np.clip((cuts[1:] - breaks[piece]) / width, 0, 1)
    start = np.clip((cuts[:-1] - breaks[piece]) / width, 0, 1)
    part, _ = _cut(control[piece, :, 1], end)
    _, part = _cut(part, np.divide(start, end, out=np.zeros_like(end), where=end > 0))
    return cuts, part


def increasing(points: Floats) -> Floats:
    """Return x and y of points of a function; refuse those whose x does not increase."""
    x = points[:, 0]
    for i in np.flatnonzero(np.diff(x) <= 0)[:1].tolist():
        raise InputError(
            f"points[{i + 1}] has x = {x[i + 1]:g}, which does not exceed its predecessor's "
            f"{x[i]:g}; x must be strictly increasing",
            "points",
            i + 1,
            float(x[i + 1]),
        )
    return points.T


def signs_of_data(x: Floats, y: Floats) -> NDArray[np.int64]:
    """Return per segment 1 or -1 where the data are convex or concave at both ends, else 0."""
    secants = np.diff(y) / np.diff(x)
    change = np.diff(secants)
    size = np.abs(secants[1:]) + np.abs(secants[:-1])
    node = np.where(np.abs(change) > 1e-9 * size, np.sign(change), 0).astype(np.int64)
    if len(node) == 0:
        return np.zeros(len(secants), dtype=np.int64)
    node = np.concatenate([node[:1], node, node[-1:]])
    return np.where(node[:-1] == node[1:], node[:-1], 0)


def check(
    x: Floats,
    y: Floats,
    curve: PiecewiseBezier,
    *,
    convex: NDArray[np.int64] | None = None,
    tolerance: float = 1e-9,
) -> MonotoneReport:
    """Decide where the graph of a function rises, falls and bends as its data do.

    ``convex``: per segment the sign that f'' must have, 0 where none.
    """
    cuts, values = _values(x, y, curve)
    segment = np.clip(np.searchsorted(x, (cuts[:-1] + cuts[1:]) / 2) - 1, 0, len(x) - 2)
    width = np.diff(cuts)
    secant = np.diff(y) / np.diff(x)
    level = secant == 0
    error = 4 * values.shape[1] * np.finfo(float).eps * np.abs(values).max()

    margins, places = np.full(len(secant), np.inf), x[:-1].copy()
    flat = np.flatnonzero(level[segment])
    off = np.abs(values[flat] - y[segment[flat], None]).max(axis=1) / (np.ptp(y) or 1.0)
    np.minimum.at(margins, segment[flat], -off)
    steep = np.flatnonzero(~level[segment])
    slopes = _derivative(values[steep]) / (width[steep] * secant[segment[steep]])[:, None]
    _least(slopes, segment[steep], cuts[steep], cuts[steep + 1], margins, places, tolerance)
    # Differences of neighbouring coefficients, each rounded as a value.
    rounding = error / np.where(level, np.ptp(y) or 1.0, np.abs(np.diff(y)))
    everywhere = np.ones(len(secant), dtype=bool)
    monotonicity = Verdicts(margins, places, rounding, everywhere, tolerance)
    if convex is None:
        return MonotoneReport(monotonicity, None)

    change = np.abs(np.diff(secant, prepend=secant[:1], append=secant[-1:]))
    unit = (change[:-1] + change[1:]) / np.diff(x)
    unit = np.where(unit > 0, unit, np.maximum(np.abs(secant), 1e-300) / np.diff(x))
    margins, places = np.full(len(secant), np.inf), x[:-1].copy()
    bent = np.flatnonzero(convex[segment] != 0)
    seconds = _derivative(_derivative(values[bent])) / width[bent, None] ** 2
    seconds *= (convex / unit)[segment[bent], None]
    _least(seconds, segment[bent], cuts[bent], cuts[bent + 1], margins, places, tolerance)
    narrow = np.full(len(secant), np.inf)
    np.minimum.at(narrow, segment, width)
    rounding = 4 * (values.shape[1] - 1) ** 2 * error / narrow**2 / unit
    return MonotoneReport(monotonicity, Verdicts(margins, places, rounding, convex != 0, tolerance))


def _derivative(c: Floats) -> Floats:
    """Return the Bernstein coefficients of the derivative, those of a constant being 0."""
    degree = c.shape[1] - 1
    return degree * np.diff(c, axis=1) if degree else np.zeros_like(c)


def _least(
    c: Floats,
    segment: NDArray[np.intp],
    start: Floats,
    end: Floats,
    margins: Floats,
    places: Floats,
    tolerance: float,
) -> None:
    """Lower the margins of the segments to the least values of polynomials on pieces of them."""
    # Halve the pieces on which the least value could be smaller than the least found so far.
    for _ in range(60):
        for value, at in ((c[:, 0], start), (c[:, -1], end)):
            np.minimum.at(margins, segment, value)
            hit = value == margins[segment]
            places[segment[hit]] = at[hit]
        open_ = c.min(axis=1) < margins[segment] - 0.1 * max(tolerance, 1e-12)
        if not open_.any():
            break
        c, segment, start, end = c[open_], segment[open_], start[open_], end[open_]
        halves = _cut(c, np.full(len(c), 0.5))
        middle = (start + end) / 2
        c, segment = np.concatenate(halves), np.concatenate([segment, segment])
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
