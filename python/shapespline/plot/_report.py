# SPDX-License-Identifier: MIT OR Apache-2.0

"""The report of a shape check as a map of the segments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline.plot._style import CURVE, DATA, OPEN, WRONG, axes_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from shapespline._core import ShapeReport

__all__ = ["criteria"]

#: Most segments of a map whose cells are wide enough for a number.
NUMBERED = 24


def criteria(report: ShapeReport, *, ax: Axes | None = None, numbers: bool | None = None) -> Axes:
    """Draw a map of the segments: which criteria each requires, and by what margin it meets them.

    A row for each criterion, a column for each segment. Empty: the points do not require the
    criterion there. Blue: satisfied, the darker the larger the margin. Red with a cross: violated,
    the darker the more negative the margin. Amber: undecided. What stands beside a row is how many
    of the segments that require its criterion violate it, and the worst of their margins.

    Parameters
    ----------
    report : ShapeReport
        The report.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    numbers : bool, optional
        Whether to print the margins of the violations into their cells; default where there is
        room, up to 24 segments.

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
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.ticker import MaxNLocator

    ax = axes_for(ax)
    names = list(report.counts())
    row = {name: i for i, name in enumerate(names)}
    count = 1 + max((r.segment for r in report.segments), default=0)
    undecided = {(r.segment, r.criterion) for r in report.undecided}

    margins = np.full((len(names), count), np.nan)
    open_cells = np.full((len(names), count), np.nan)
    for r in report.segments:
        if not r.applicable:
            continue
        if (r.segment, r.criterion) in undecided:
            open_cells[row[r.criterion], r.segment] = 1.0
        else:
            margins[row[r.criterion], r.segment] = r.margin
    # Most margins are small, and of a violation one wants to see that it is one: no pale shades.
    shade = np.sign(margins) * (0.2 + 0.8 * np.minimum(np.abs(margins), 1) ** 0.4)
    hues = LinearSegmentedColormap.from_list(
        "shape", [(0.0, WRONG), (0.4999, "#f6d3cb"), (0.5001, "#dbe7f4"), (1.0, CURVE)]
    )
    lanes = np.arange(len(names) + 1) - 0.5
    # Images, for a mesh of as many cells takes minutes to draw where there are many segments.
    place: dict[str, Any] = {
        "extent": (-0.5, count - 0.5, len(names) - 0.5, -0.5),
        "aspect": "auto",
        "interpolation": "nearest",
    }
    ax.imshow(shade, cmap=hues, vmin=-1, vmax=1, **place)
    amber = LinearSegmentedColormap.from_list("open", [OPEN, OPEN])
    ax.imshow(open_cells, cmap=amber, vmin=0, vmax=1, **place)

    violated = [r for r in report.violations if (r.segment, r.criterion) not in undecided]
    numbers = count <= NUMBERED if numbers is None else numbers
    ax.scatter(
        [r.segment for r in violated],
        [row[r.criterion] - (0.15 if numbers else 0) for r in violated],
        marker="x",
        s=22,
        color="black",
        linewidth=1.2,
    )
    if numbers:
        for r in violated:
            ax.text(
                r.segment, row[r.criterion] + 0.28, f"{r.margin:.2g}", ha="center", va="center",
                fontsize="xx-small",
            )  # fmt: skip
    for name, (failed, asked) in report.counts().items():
        text = f"{failed} / {asked}" if asked else "–"
        worst = [r.margin for r in violated if r.criterion == name]
        if worst:
            text += f", worst {min(worst):.2g}"
        ax.annotate(
            text,
            (1, row[name]),
            xytext=(4, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            va="center",
            fontsize="small",
            color=WRONG if failed else DATA,
        )
    for lane in lanes[1:-1]:
        ax.axhline(lane, color=DATA, linewidth=0.4, alpha=0.5)

    calls = int(np.isfinite(margins).sum())
    handles = [
        Patch(color=CURVE, label=f"satisfied ({calls - len(violated)})"),
        Line2D(
            [], [], linestyle="", marker="x", color="black", markersize=5,
            markeredgewidth=1.2, label=f"violated ({len(violated)})",
        ),
    ]  # fmt: skip
    if undecided:
        handles.append(Patch(color=OPEN, label=f"undecided ({len(undecided)})"))
    ax.set(xlabel="segment", xlim=(-0.5, count - 0.5), ylim=(len(names) - 0.5, -0.5))
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_yticks(range(len(names)), names)
    ax.tick_params(axis="y", length=0)
    ax.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(0, 1),
        ncols=len(handles),
        frameon=False,
        borderaxespad=0.1,
    )
    return ax
