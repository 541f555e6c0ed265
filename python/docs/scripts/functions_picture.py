# SPDX-License-Identifier: MIT OR Apache-2.0

"""Draw the README's picture of functions: python python/docs/scripts/functions_picture.py [FILE].

The data are Fritsch and Carlson's RPN 14 (SIAM J. Numer. Anal. 17 (1980) 238–246).
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

import shapespline as ss
from shapespline.plot._style import STYLE

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests"))
import polygons

OUT = ROOT / "python" / "docs" / "images" / "functions.png"


def drawn() -> Figure:
    """Return the figure: the data with both functions, and below them the derivatives."""
    x, y = polygons.load("rpn14").values()
    cubic, kept = CubicSpline(x, y, bc_type="natural"), ss.fit_monotone(x, y)
    u = np.linspace(x[0], x[-1], 4001)
    figure = Figure(figsize=(11, 4.4), layout="constrained")
    for order, ax in enumerate(figure.subplots(1, 2)):
        wrong, right = cubic(u, order), kept(u, order)
        ax.fill_between(
            u, 0, 1, where=cubic(u, 1) < 0, transform=ax.get_xaxis_transform(),
            color=ss.plot.WRONG, alpha=0.12, linewidth=0, label="the natural cubic falls",
        )  # fmt: skip
        ax.plot(u, wrong, color=ss.plot.WRONG, linestyle="--", label="natural cubic spline")
        ax.plot(u, right, color=ss.plot.CURVE, label="MonotoneCubic")
        ax.set(title="The function" if order == 0 else "Its derivative", xlabel="x")
    ax.axhline(0, color="black", linewidth=0.8)
    figure.axes[0].plot(x, y, "o", color=ss.plot.DATA, markersize=5, label="data")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def draw(path: Path) -> None:
    """Draw the figure into a file."""
    with mpl.rc_context(STYLE):
        drawn().savefig(path, dpi=150)


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else OUT)
