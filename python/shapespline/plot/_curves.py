# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves: the curve itself, its curvature comb, curvature and torsion over the parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline._core import InputError
from shapespline.plot._style import CURVE, DATA, OPEN, axes_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from shapespline._core import SpaceCurve

    Floats = NDArray[np.float64]

__all__ = ["curvature", "curvature_comb", "curve", "torsion"]


def _nodes(c: SpaceCurve) -> Floats:
    """Return the parameters of the points, but for points that were left out."""
    nodes: Floats = np.unique(c.parameters)
    return nodes


def _inside(c: SpaceCurve, samples: int) -> Floats:
    """Return parameters in every segment, both ends a hair inside: (segments, samples)."""
    u = c.knots
    # Inside, for at a knot torsion has two values, and at an end with no curvature none.
    t = np.linspace(1e-6, 1 - 1e-6, samples)
    inside: Floats = u[:-1, None] + np.diff(u)[:, None] * t
    return inside


def _broken(values: Floats) -> Floats:
    """Return the values of all segments in a row, with a gap after each: curves may jump there."""
    gaps = np.full((len(values), 1, *values.shape[2:]), np.nan)
    row: Floats = np.concatenate([values, gaps], axis=1).reshape(-1, *values.shape[2:])
    return row


def _limits(values: Floats, data: Floats) -> tuple[float, float]:
    """Return limits that show the data and the bulk of the values; spikes leave the picture."""
    finite = values[np.isfinite(values)]
    shown = np.concatenate([np.quantile(finite, [0.04, 0.96]) if finite.size else [], data, [0.0]])
    low, high = float(shown.min()), float(shown.max())
    margin = 0.12 * (high - low) or 1.0
    return low - margin, high + margin


def _discrete_curvature(c: SpaceCurve) -> Floats:
    """Return the curvature of the circle through each point and its neighbours; NaN at open ends.

    It is 2 ‖P‖ / (‖L‖ ‖L'‖ ‖L + L'‖), and NaN too where the polygon turns back on itself.
    """
    points = c(_nodes(c))
    if c.boundary == "periodic":
        points = np.vstack([points[-2:-1], points, points[1:2]])
    # Over the extent of the points, so that products of their lengths neither over- nor underflow.
    size = float(np.abs(points - points[0]).max()) or 1.0
    chords = np.zeros((len(points) - 1, 3))
    chords[:, : points.shape[1]] = np.diff(points / size, axis=0)
    before, after = chords[:-1], chords[1:]
    area = np.linalg.norm(np.cross(before, after), axis=1)
    lengths = np.linalg.norm([before, after, before + after], axis=2).prod(axis=0)
    inner = np.divide(2 * area, lengths, out=np.full(len(area), np.nan), where=lengths > 0) / size
    values: Floats = inner if c.boundary == "periodic" else np.r_[np.nan, inner, np.nan]
    return values


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
    """Draw a curve with the polygon of its points, to one scale in all directions.

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

    Raises
    ------
    ValueError
        If the curve is in space and ``ax`` is not.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.curve(ss.NuSpline([[0, 0], [1, 1], [2, 0]]))
    """
    ax = axes_for(ax, space=c.points.shape[1] == 3)
    if points:
        polygon = c.points.T
        ax.plot(*polygon, color=DATA, linewidth=0.7, marker="o", markersize=2.5, zorder=1)
    u = c.knots
    t = u[:-1, None] + np.diff(u)[:, None] * np.linspace(0, 1, samples, endpoint=False)
    position = c(np.append(t.ravel(), u[-1])).T
    ax.plot(*position, color=color, linestyle=linestyle, linewidth=1.4, label=label, zorder=2)
    _equal(ax)
    return ax


def _equal(ax: Axes) -> None:
    """Give all axes one scale: angles and curvature are not to be seen otherwise."""
    ax.set_aspect("equal", adjustable="box" if ax.name == "3d" else "datalim")


def curvature_comb(
    c: SpaceCurve,
    *,
    ax: Axes | None = None,
    samples: int = 24,
    scale: float | None = None,
    color: str = CURVE,
    comb_color: str = OPEN,
    label: str | None = None,
) -> Axes:
    """Draw a curve with its curvature as a comb of lines normal to it.

    A tooth is −κN times a scale: it points away from the centre of curvature, so the comb changes
    sides where a plane curve inflects, and is as long as the curvature is large. The teeth of one
    segment are joined by a line; where that line jumps, the curvature jumps.

    Parameters
    ----------
    c : SpaceCurve
        The curve; one in space is drawn in perspective.
    ax : matplotlib.axes.Axes, optional
        Where to draw: for a curve in space, Axes with ``projection="3d"``.
    samples : int
        Teeth on each segment.
    scale : float, optional
        Length of a tooth over the curvature, in square units of the points. Default: such that the
        comb reaches as far as an eighth of the points' extent, but for the largest 2 % of the
        teeth, which may be longer.
    color, comb_color, label : str
        How to draw the curve and the comb.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        If the curve is in space and ``ax`` is not.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> ax = ss.plot.curvature_comb(ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]))
    """
    space = c.points.shape[1] == 3
    ax = curve(c, ax=ax, color=color, label=label)
    u = _inside(c, max(samples, 2))
    feet, normals = c(u), c.curvature_vector(u)
    if scale is None:
        lengths = np.linalg.norm(normals, axis=-1)
        finite = lengths[np.isfinite(lengths)]
        reach = float(np.quantile(finite, 0.98)) if finite.size else 0.0
        extent = float(np.linalg.norm(np.ptp(c.points, axis=0)))
        scale = extent / 8 / reach if reach > 0 else 0.0
    tips = feet - scale * normals
    teeth = np.stack([feet, tips], axis=2).reshape(-1, 2, feet.shape[-1])
    style: dict[str, Any] = {"colors": comb_color, "linewidths": 0.5, "alpha": 0.7, "zorder": 1.5}
    target: Any = ax  # Axes in space have a method more, and no types
    if space:
        from mpl_toolkits.mplot3d.art3d import Line3DCollection

        target.add_collection3d(Line3DCollection(teeth, **style), autolim=False)
    else:
        from matplotlib.collections import LineCollection

        ax.add_collection(LineCollection(list(teeth), **style))
    ax.plot(*_broken(tips).T, color=comb_color, linewidth=0.9, zorder=1.6)
    _equal(ax)
    return ax


def _over_parameter(
    ax: Axes, c: SpaceCurve, u: Floats, values: Floats, ylabel: str, **style: Any
) -> None:
    """Draw a quantity of the segments over the parameter, with a gap at each point."""
    ax.plot(_broken(u), _broken(values), linewidth=1.2, **style)
    ax.set(xlabel="parameter u", ylabel=ylabel, xlim=c.parameters[[0, -1]])


def curvature(
    c: SpaceCurve,
    *,
    ax: Axes | None = None,
    samples: int = 40,
    data: bool = True,
    color: str = CURVE,
    linestyle: str = "-",
    label: str | None = None,
) -> Axes:
    """Draw curvature over the parameter, with the discrete curvature of the data.

    Parameters
    ----------
    c : SpaceCurve
        The curve.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    samples : int
        Values drawn on each segment.
    data : bool
        Whether to draw the discrete curvature 2 ‖P‖ / (‖L‖ ‖L'‖ ‖L + L'‖) at each point as a dot:
        that of the circle through the point and its neighbours.
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
    ax = axes_for(ax)
    u = _inside(c, samples)
    if data:
        ax.plot(
            _nodes(c),
            _discrete_curvature(c),
            color=DATA,
            linestyle="",
            marker="o",
            markersize=3,
            zorder=1,
            label="discrete curvature of the data",
        )
    style = {"color": color, "linestyle": linestyle, "label": label}
    _over_parameter(ax, c, u, c.curvature(u), "curvature κ", **style)
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
        text = "torsion is for curves in space, but the points of c have shape (n, 2)"
        raise InputError(text, "c")
    ax = axes_for(ax)
    u = _inside(c, samples)
    tau = c.torsion(u)
    discrete = c._discrete_torsion()
    if data:
        # One artist, however many segments: a bar each would take minutes on a long curve.
        ax.stairs(
            np.nan_to_num(discrete),
            _nodes(c),
            fill=True,
            color=DATA,
            alpha=0.35,
            linewidth=0,
            label="discrete torsion of the data",
        )
    style = {"color": color, "linestyle": linestyle, "label": label}
    _over_parameter(ax, c, u, tau, "torsion τ", **style)
    ax.axhline(0, color="black", linewidth=0.6)
    ax.set_ylim(*_limits(tau, discrete[np.isfinite(discrete)]))
    return ax
