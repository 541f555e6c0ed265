# SPDX-License-Identifier: MIT OR Apache-2.0

"""One figure that says what a fit is like: `shapespline fit --plot`."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from shapespline import SpaceCurve, plot
from shapespline._cli.text_io import shortened
from shapespline.plot._style import STYLE

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = ["draw"]

#: Most points that are drawn along a curve: more are not to be seen, and make large files.
DRAWN = 60_000


def _samples(segments: int) -> int:
    return int(np.clip(DRAWN // segments, 2, 40))


def _curve(figure: Figure, c: SpaceCurve, report: Any, names: Sequence[str]) -> None:
    """Draw the curve on the left; curvature, torsion and the map of criteria on the right."""
    space = c.points.shape[1] == 3
    samples = _samples(len(c.points) - 1)
    grid = figure.add_gridspec(3 if space else 2, 2, width_ratios=[1, 1.3])
    shown = figure.add_subplot(grid[:, 0], projection="3d" if space else None)
    plot.curve(c, ax=shown, samples=samples)
    for axis, name in zip("xyz", names, strict=False):
        getattr(shown, f"set_{axis}label")(axis if name.isdigit() else name)
    above = figure.add_subplot(grid[0, 1])
    plot.curvature(c, ax=above, samples=samples)
    u = np.linspace(c.parameters[0], c.parameters[-1], 4001)
    kappa = np.asarray(c.curvature(u))
    finite = kappa[np.isfinite(kappa)]
    above.set_ylim(0, 1.5 * float(np.quantile(finite, 0.98)) or 1.0)
    if space:
        above.set_xlabel("")
        plot.torsion(c, ax=figure.add_subplot(grid[1, 1], sharex=above), samples=samples)
    plot.criteria(report, ax=figure.add_subplot(grid[-1, 1]))


def _label(text: str) -> str:
    """Return a text of the user's for a figure: short, and no mathematics for Matplotlib."""
    return shortened(text).replace("$", r"\$")


def draw(fitted: Any, report: Any, path: Path, *, title: str, names: Sequence[str]) -> None:
    """Draw a curve or a function with the report on its shape, and write it to a file."""
    title, names = _label(title), [_label(name) for name in names]
    # The same input gives the same file: no date, and no random names inside an SVG.
    with mpl.rc_context({**STYLE, "svg.hashsalt": "shapespline"}), warnings.catch_warnings():
        # Letters that the font lacks are drawn as boxes.
        warnings.filterwarnings("ignore", message="Glyph")
        figure = Figure(figsize=(11, 6.2), layout="constrained")
        figure.suptitle(f"{title}: {type(fitted).__name__}", x=0.008, ha="left", fontsize=12)
        if isinstance(fitted, SpaceCurve):
            _curve(figure, fitted, report, names)
        else:
            axes = figure.add_subplot()
            plot.interpolant(fitted, ax=axes, samples=_samples(len(fitted.x) - 1))
            named = [name for name in names if not name.isdigit()]
            if named:
                axes.set_ylabel(named[1])
                figure.axes[-1].set_xlabel(named[0])
            for i in [record.segment for record in report.violations]:
                axes.axvspan(*fitted.x[i : i + 2], color=plot.WRONG, alpha=0.12, linewidth=0)
        dateless = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
        figure.savefig(path, dpi=150, metadata=dateless.get(path.suffix.lower()))
