"""Does a function keep the monotonicity of its data? For the command line, of any library's curve.

Decided on the Bernstein form of the derivative: its least coefficient bounds it from below, its
ends are values of it, and halving a piece brings the two together quadratically. Nothing is
sampled, so a dip between two points is found however narrow it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline._errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from shapespline._core import PiecewiseBezier

    Floats = NDArray[np.float64]

__all__ = ["MonotoneReport", "check_monotone"]

#: Violations that a printed report lists before it only counts them.
LISTED = 20


@dataclass(frozen=True)
class MonotoneReport:
    """On which segments a function rises or falls as its data do.

    ``margins``: the least value of f'/(Δy/Δx) on each segment, at ``locations``; on a segment whose
    data are level, minus the greatest distance of a coefficient from them, over the data's range.
    ``rounding``: what the margin of each segment may lose to the rounding of the values.
    """

    margins: Floats
    locations: Floats
    rounding: Floats
    tolerance: float

    @property
    def satisfied(self) -> NDArray[np.bool_]:
        """Whether each segment is monotone, but for the tolerance."""
        kept: NDArray[np.bool_] = self.margins >= -self.tolerance - self.rounding
        return kept

    @property
    def ok(self) -> bool:
        """Whether all segments are."""
        return bool(self.satisfied.all())

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in the form of ``ShapeReport.to_dict``."""
        columns = self.satisfied.tolist(), self.margins.tolist(), self.locations.tolist()
        records = [
            {
                "segment": i,
                "criterion": "monotonicity",
                "applicable": True,
                "satisfied": satisfied,
                "margin": margin,
                "location": location,
            }
            for i, (satisfied, margin, location) in enumerate(zip(*columns, strict=True))
        ]
        wrong = [record for record in records if not record["satisfied"]]
        return {
            "ok": self.ok,
            "margin": float(self.margins.min()),
            "counts": {"monotonicity": {"violated": len(wrong), "applicable": len(records)}},
            "tolerance": self.tolerance,
            "segments": records,
            "violations": wrong,
            "undecided": [],
        }

    def __str__(self) -> str:
        """Return a verdict, a table of one line, and the violations."""
        wrong = np.flatnonzero(~self.satisfied)
        n = len(self.margins)
        verdict = "preserved" if self.ok else "violated"
        lines = [f"shape {verdict} on {n} segments"]
        lines += [f"{'criterion':<16}{'violated':>10}{'applicable':>12}"]
        lines += [f"{'monotonicity':<16}{len(wrong):>10}{n:>12}"]
        if len(wrong):
            lines += ["", f"{'violated':<16}{'segment':>10}{'margin':>12}{'at x':>16}"]
        lines += [
            f"{'monotonicity':<16}{i:>10}{self.margins[i]:>12.3e}{self.locations[i]:>16.12g}"
            for i in wrong[:LISTED]
        ]
        if len(wrong) > LISTED:
            lines.append(f"… and {len(wrong) - LISTED} more")
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


def check_monotone(
    points: Floats, curve: PiecewiseBezier, *, tolerance: float = 1e-9
) -> MonotoneReport:
    """Decide on which segments the graph of a function rises or falls as its points do.

    Parameters
    ----------
    points : numpy.ndarray, shape (n, 2)
        The points, x strictly increasing.
    curve : PiecewiseBezier
        The graph, whose parameter is x; of any degree, with breaks anywhere.
    tolerance : float
        What margin counts as zero.

    Raises
    ------
    ValueError
        If the curve is not the graph of a function through the points.
    """
    x, y = points.T
    for i in np.flatnonzero(np.diff(x) <= 0)[:1]:
        raise InputError(
            f"points[{i + 1}] has x = {x[i + 1]:g}, which does not exceed its predecessor's "
            f"{x[i]:g}; x must be strictly increasing",
            "points",
            int(i) + 1,
            float(x[i + 1]),
        )
    cuts, values = _values(x, y, curve)
    segment = np.clip(np.searchsorted(x, (cuts[:-1] + cuts[1:]) / 2) - 1, 0, len(x) - 2)
    secant = np.diff(y) / np.diff(x)
    level = secant == 0

    # Differences of neighbouring coefficients, each rounded as a value.
    least = np.where(level, np.ptp(y) or 1.0, np.abs(np.diff(y)))
    rounding = 4 * values.shape[1] * np.finfo(float).eps * np.abs(values).max() / least

    margins, places = np.full(len(secant), np.inf), x[:-1].copy()
    flat = np.flatnonzero(level[segment])
    off = np.abs(values[flat] - y[segment[flat], None]).max(axis=1) / (np.ptp(y) or 1.0)
    np.minimum.at(margins, segment[flat], -off)

    steep = np.flatnonzero(~level[segment])
    seg, start, end = segment[steep], cuts[steep], cuts[steep + 1]
    degree = values.shape[1] - 1
    slopes = degree * np.diff(values[steep], axis=1) / ((end - start) * secant[seg])[:, None]
    # Halve the pieces on which the least value could be smaller than the least found so far.
    for _ in range(60):
        for value, at in ((slopes[:, 0], start), (slopes[:, -1], end)):
            np.minimum.at(margins, seg, value)
            hit = value == margins[seg]
            places[seg[hit]] = at[hit]
        open_ = slopes.min(axis=1) < margins[seg] - 0.1 * max(tolerance, 1e-12)
        if not open_.any():
            break
        slopes, seg, start, end = slopes[open_], seg[open_], start[open_], end[open_]
        halves = _cut(slopes, np.full(len(slopes), 0.5))
        middle = (start + end) / 2
        slopes, seg = np.concatenate(halves), np.concatenate([seg, seg])
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
    return MonotoneReport(margins, places, rounding, tolerance)
