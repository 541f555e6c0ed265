"""Figures of curves and their shape, with Matplotlib.

Every function draws into the Axes ``ax``, or into a new figure, and returns the Axes: set titles,
limits and styles on it as on any other. Matplotlib is imported when a function is called
(``pip install "shapespline[plot]"``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from shapespline._core import ShapeReport, SpaceCurve

    Floats = NDArray[np.float64]

__all__ = ["criteria", "curvature", "curve", "torsion"]

# One colour for one thing, in all figures: what is drawn, what the data say, what is wrong.
CURVE = "#1f5fa8"
DATA = "#8a8f98"
WRONG = "#c8442f"
OPEN = "#d99a1e"


def _axes(ax: Axes | None, *, space: bool = False) -> Axes:
    """Return the Axes to draw into: those given, or new ones."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    options = {"projection": "3d"} if space else {}
    axes: Axes = plt.figure(layout="constrained").add_subplot(**options)
    return axes


def _inside(c: SpaceCurve, samples: int) -> Floats:
    """Return parameters in every segment, both ends a hair inside: (segments, samples)."""
    u = c.parameters
    # Inside, for at a knot torsion has two values, and at an end with no curvature none.
    t = np.linspace(1e-6, 1 - 1e-6, samples)
    inside: Floats = u[:-1, None] + np.diff(u)[:, None] * t
    return inside


def _limits(values: Floats, data: Floats) -> tuple[float, float]:
    """Return limits that show the data and the bulk of the values; spikes leave the picture."""
    finite = values[np.isfinite(values)]
    shown = np.concatenate([np.quantile(finite, [0.04, 0.96]) if finite.size else [], data, [0.0]])
    low, high = float(shown.min()), float(shown.max())
    margin = 0.12 * (high - low) or 1.0
    return low - margin, high + margin


def curve(
    c: SpaceCurve,
    *,
    ax: Axes | None = None,
    samples: int = 40,
    points: bool = True,
    color: str = CURVE,
    linestyle: str = "-",
    label: str | None = None,
) -> Axes:
    """Draw a curve with the polygon of its points.

    Parameters
    ----------
    c : SpaceCurve
        The curve; one in space is drawn in perspective.
    ax : matplotlib.axes.Axes, optional
        Where to draw: for a curve in space, Axes with ``projection="3d"``.
    samples : int
        Points drawn on each segment.
    points : bool
        Whether to draw the points and their polygon as well.
    color, linestyle, label : str
        How to draw the curve.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.curve(ss.NuSpline([[0, 0], [1, 1], [2, 0]]))
    """
    ax = _axes(ax, space=c.points.shape[1] == 3)
    if points:
        polygon = c.points.T
        ax.plot(*polygon, color=DATA, linewidth=0.7, marker="o", markersize=2.5, zorder=1)
    u = c.parameters
    t = u[:-1, None] + np.diff(u)[:, None] * np.linspace(0, 1, samples, endpoint=False)
    position = c(np.append(t.ravel(), u[-1])).T
    ax.plot(*position, color=color, linestyle=linestyle, linewidth=1.4, label=label, zorder=2)
    if len(position) == 2:
        ax.set_aspect("equal", adjustable="datalim")
    return ax


def curvature(
    c: SpaceCurve,
    *,
    ax: Axes | None = None,
    samples: int = 40,
    color: str = CURVE,
    linestyle: str = "-",
    label: str | None = None,
) -> Axes:
    """Draw curvature over the parameter.

    Parameters
    ----------
    c : SpaceCurve
        The curve.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    samples : int
        Values drawn on each segment.
    color, linestyle, label : str
        How to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.curvature(ss.NuSpline([[0, 0], [1, 1], [2, 0]]))
    """
    ax = _axes(ax)
    u = _inside(c, samples)
    kappa = c.curvature(u)
    ax.plot(u.ravel(), kappa.ravel(), color=color, linestyle=linestyle, linewidth=1.2, label=label)
    ax.set(xlabel="parameter u", ylabel="curvature κ", xlim=c.parameters[[0, -1]])
    ax.set_ylim(bottom=0, auto=True)  # the next curve may need more room
    return ax


def torsion(
    c: SpaceCurve,
    *,
    ax: Axes | None = None,
    samples: int = 40,
    data: bool = True,
    color: str = CURVE,
    linestyle: str = "-",
    label: str | None = None,
) -> Axes:
    """Draw torsion over the parameter, with the discrete torsion of the data.

    Torsion jumps at the points and can be very large where the curvature is small: the limits show
    the data and the bulk of the values.

    Parameters
    ----------
    c : SpaceCurve
        The curve, in space.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    samples : int
        Values drawn on each segment.
    data : bool
        Whether to draw the discrete torsion det[L, L', L''] / (‖P‖ ‖P'‖) of each segment as a bar.
    color, linestyle, label : str
        How to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        If the curve lies in the plane by its dimension: it has no torsion.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.torsion(ss.NuSpline([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]]))
    """
    if c.points.shape[1] == 2:
        raise ValueError("torsion is for curves in space, but the points of c have shape (n, 2)")
    ax = _axes(ax)
    u = _inside(c, samples)
    tau = c.torsion(u)
    discrete = c._discrete_torsion()
    if data:
        knots = c.parameters
        ax.bar(
            knots[:-1],
            np.nan_to_num(discrete),
            width=np.diff(knots),
            align="edge",
            color=DATA,
            alpha=0.35,
            linewidth=0,
            label="discrete torsion of the data",
        )
    # A gap at each point, where torsion jumps.
    gaps = np.full((len(u), 1), np.nan)
    x, y = np.hstack([u, gaps]).ravel(), np.hstack([tau, gaps]).ravel()
    ax.plot(x, y, color=color, linestyle=linestyle, linewidth=1.2, label=label)
    ax.axhline(0, color="black", linewidth=0.6)
    ax.set(xlabel="parameter u", ylabel="torsion τ", xlim=c.parameters[[0, -1]])
    ax.set_ylim(*_limits(tau, discrete[np.isfinite(discrete)]))
    return ax


def criteria(report: ShapeReport, *, ax: Axes | None = None) -> Axes:
    """Draw which criterion each segment calls for, where it is violated, and what stays undecided.

    Parameters
    ----------
    report : ShapeReport
        The report.
    ax : matplotlib.axes.Axes, optional
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.criteria(ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]).check())
    """
    ax = _axes(ax)
    names = list(report.counts())
    records = [r for r in report.segments if r.applicable]
    undecided = {(u.segment, u.criterion) for u in report.undecided}
    decided = [r for r in records if (r.segment, r.criterion) not in undecided]
    unsettled = [r for r in records if (r.segment, r.criterion) in undecided]
    groups = [
        ("satisfied", [r for r in decided if r.satisfied], CURVE, "s", 14),
        ("violated", [r for r in decided if not r.satisfied], WRONG, "X", 42),
    ]
    if unsettled:
        groups.append(("undecided", unsettled, OPEN, "D", 30))
    for label, chosen, color, marker, size in groups:
        ax.scatter(
            [r.segment for r in chosen],
            [names.index(r.criterion) for r in chosen],
            marker=marker,
            s=size,
            color=color,
            linewidth=0,
            label=f"{label} ({len(chosen)})",
        )
    ax.set(xlabel="segment", ylim=(len(names) - 0.5, -0.5))
    ax.set_yticks(range(len(names)), names)
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=len(groups), frameon=False)
    return ax
