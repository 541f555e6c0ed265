# SPDX-License-Identifier: MIT OR Apache-2.0

"""What all figures share: one colour for one thing, and Axes to draw into."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from shapespline._core import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CURVE", "DATA", "OPEN", "STYLE", "WRONG", "axes_for"]

# One colour for one thing, in all figures: what is drawn, what the data say, what is wrong, and
# what stays undecided.
CURVE = "#1f5fa8"
DATA = "#8a8f98"
WRONG = "#c8442f"
OPEN = "#d99a1e"

#: Matplotlib's settings for the figures that this project draws itself.
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#606770",
    "axes.labelcolor": "#404650",
    "xtick.color": "#606770",
    "ytick.color": "#606770",
    "legend.frameon": False,
}


def axes_for(ax: Axes | None, *, space: bool = False) -> Axes:
    """Return the Axes to draw into: those given, or new ones, in perspective for ``space``."""
    if ax is not None:
        if space and ax.name != "3d":
            text = f"ax must have projection='3d' for a curve in space, got projection={ax.name!r}"
            raise InputError(text, "ax", value=ax.name)
        return ax
    import matplotlib.pyplot as plt

    options = {"projection": "3d"} if space else {}
    axes: Axes = plt.figure(layout="constrained").add_subplot(**options)
    return axes
