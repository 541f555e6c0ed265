# SPDX-License-Identifier: MIT OR Apache-2.0

"""Functions of one variable, with their data and derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline._core import InputError
from shapespline.plot._style import CURVE, DATA, axes_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from shapespline._core import PiecewisePolynomial

    Floats = NDArray[np.float64]

__all__ = ["interpolant"]


def _drawn(f: PiecewisePolynomial, order: int, samples: int) -> tuple[Floats, Floats]:
    """Return x and the derivative on every piece, with a gap between pieces where it may jump.

    The values have a column for each of the function's: (pieces · (samples + 1), columns).
    """
    t = np.linspace(0, 1, samples)
    knots = f.knots
    if isinstance(knots, list):
        knots = np.unique(np.concatenate(knots))
    x = knots[:-1, None] + np.diff(knots)[:, None] * t
    # A hair inside: at the ends of a piece a derivative that jumps belongs to its neighbour too.
    x[:, -1] = np.nextafter(knots[1:], knots[:-1])
    values = np.moveaxis(np.asarray(f(x, order)), (f.axis, f.axis + 1), (0, 1))
    values = values.reshape(*x.shape, -1)
    x = np.concatenate([x, np.full((len(x), 1), np.nan)], axis=1)
    values = np.concatenate([values, np.full((len(x), 1, values.shape[2]), np.nan)], axis=1)
    return x.ravel(), values.reshape(-1, values.shape[2])


def _panels(ax: Axes, orders: range) -> list[Axes]:
    """Return the Axes for the derivatives under ``ax``: those of an earlier call, or new ones."""
    names = [f"derivative {order}" for order in orders]
    family = [ax, *ax.get_shared_x_axes().get_siblings(ax)]
    found = {axes.get_label(): axes for axes in family}
    if all(name in found for name in names):
        return [found[name] for name in names]
    place = ax.get_subplotspec()
    if place is None:
        raise InputError(
            "ax must be part of a grid of subplots to make room for derivatives; "
            "pass derivatives=0, and draw each into its own Axes with nu",
            "ax",
        )
    grid = place.subgridspec(1 + len(orders), 1, height_ratios=[1.8, *(1 for _ in orders)])
    ax.set_subplotspec(grid[0])
    figure = ax.figure
    panels = [
        figure.add_subplot(grid[1 + i], sharex=ax, label=name) for i, name in enumerate(names)
    ]
    for axes in [ax, *panels[:-1]]:
        axes.tick_params(labelbottom=False)
    return panels


def interpolant(
    f: PiecewisePolynomial,
    *,
    ax: Axes | None = None,
    nu: int = 0,
    derivatives: int = 2,
    samples: int = 60,
    points: bool = True,
    color: str = CURVE,
    linestyle: str = "-",
    label: str | None = None,
) -> Axes:
    """Draw a function with its data, and its derivatives in Axes of their own below it.

    A second function drawn with the same ``ax`` goes into the same Axes, derivatives included.

    Parameters
    ----------
    f : PiecewisePolynomial
        A monotone function, or a derivative or antiderivative of one, such as `histospline`
        returns; of many columns, all are drawn.
    ax : matplotlib.axes.Axes, optional
        Where to draw; its place in the figure is shared with those of the derivatives.
    nu : int
        Order of the derivative to draw, 0 for the function.
    derivatives : int
        How many further derivatives to draw below.
    samples : int
        Values drawn on each piece.
    points : bool
        Whether to draw the data (x, y) as well, and the data's slopes Δy/Δx as steps behind the
        first derivative.
    color, linestyle, label : str
        How to draw.

    Returns
    -------
    matplotlib.axes.Axes
        Those of the function itself.

    Raises
    ------
    ValueError
        If ``nu`` or ``derivatives`` is negative, or there is no room for derivatives because ``ax``
        is not part of a grid of subplots.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import shapespline as ss
    >>> f = ss.fit_monotone([0, 1, 2, 5], [0, 0.2, 2, 2.1])
    >>> ax = ss.plot.interpolant(f)
    >>> [axes.get_ylabel() for axes in ax.figure.axes]
    ['f', 'f′', 'f″']
    """
    for name, value in (("nu", nu), ("derivatives", derivatives)):
        if value < 0:
            raise InputError(f"{name} must not be negative, got {value}", name, value=value)
    ax = axes_for(ax)
    orders = range(nu + 1, nu + 1 + derivatives)
    panels = _panels(ax, orders) if derivatives else []
    for order, axes in zip([nu, *orders], [ax, *panels], strict=True):
        x, values = _drawn(f, order, samples)
        if points:
            _data(f, order, axes)
        for column, line in enumerate(values.T):
            axes.plot(
                x,
                line,
                color=color,
                linestyle=linestyle,
                linewidth=1.4 if order == nu else 1.1,
                label=label if order == nu and column == 0 else None,
                zorder=2,
            )
        if order > nu:
            axes.axhline(0, color="black", linewidth=0.5, zorder=1)
        axes.set_ylabel(("f", "f′", "f″")[order] if order < 3 else f"$f^{{({order})}}$")
        axes.set_xlim(f.x[0], f.x[-1])
    [ax, *panels][-1].set_xlabel("x")
    ax.figure.align_ylabels([ax, *panels])
    return ax


def _data(f: PiecewisePolynomial, order: int, ax: Axes) -> None:
    """Draw what the data say of the function or of its slope, once into each Axes."""
    y = getattr(f, "y", None)
    if y is None or order > 1 or any(a.get_gid() == "data" for a in ax.lines):
        return
    columns = np.moveaxis(y, f.axis, 0).reshape(len(f.x), -1)
    if order == 0:
        dots: dict[str, Any] = {"color": "black", "linestyle": "", "marker": "o", "markersize": 3}
        ax.plot(f.x, columns, **dots, zorder=3, clip_on=False, gid="data")
        return
    slopes = np.diff(columns, axis=0) / np.diff(f.x)[:, None]
    steps = np.repeat(slopes, 2, axis=0)
    ax.plot(np.repeat(f.x, 2)[1:-1], steps, color=DATA, linewidth=0.9, zorder=1, gid="data")
