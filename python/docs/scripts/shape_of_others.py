# SPDX-License-Identifier: MIT OR Apache-2.0

"""Print the table of python/docs/shape-of-others.md: how SciPy's curves keep the shape of data.

Run from the root of the repository, with SciPy installed; a test holds the page against it:

    python python/docs/scripts/shape_of_others.py
"""

import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import (
    Akima1DInterpolator,
    CubicSpline,
    PchipInterpolator,
    make_interp_spline,
)

import shapespline as ss
from shapespline._cli.tables import read_points

DATA = Path(__file__).resolve().parents[3] / "tests" / "data"
CRITERIA = ("convexity", "inflection", "torsion", "coplanarity", "collinearity")


def chordal(points: np.ndarray) -> np.ndarray:
    """Return parameters that grow by the lengths of the chords."""
    return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]


def natural_quintic(u: np.ndarray, points: np.ndarray) -> object:
    """Return the C⁴ quintic with vanishing third and fourth derivatives at the ends."""
    none = [(order, np.zeros(points.shape[1])) for order in (3, 4)]
    return make_interp_spline(u, points, k=5, bc_type=(none, none))


#: name → curve through the points at the parameters
CURVES = {
    "CubicSpline, natural": lambda u, p: CubicSpline(u, p, bc_type="natural"),
    "PchipInterpolator": PchipInterpolator,
    "Akima1DInterpolator, makima": lambda u, p: Akima1DInterpolator(u, p, method="makima"),
    "make_interp_spline, k=5": natural_quintic,
}


def files() -> list[Path]:
    """Return the data sets."""
    return sorted(DATA.glob("*.csv"))


def report(path: Path, curve: str) -> ss.ShapeReport:
    """Return the report on a curve through the points of a file."""
    points = read_points(path).points
    u = chordal(points)
    return ss.check_shape(points, CURVES[curve](u, points), parameters=u)


def table() -> str:
    """Return the table in Markdown: violated / applicable segments."""
    lines = [
        "| data | curve | " + " | ".join(CRITERIA) + " | undecided |",
        "|---|---|" + "--:|" * (len(CRITERIA) + 1),
    ]
    for path in files():
        for name in CURVES:
            found = report(path, name)
            counts = found.counts()
            cells = ["{} / {}".format(*counts[criterion]) for criterion in CRITERIA]
            cells = ["–" if cell == "0 / 0" else cell for cell in cells]
            cells.append(str(len(found.undecided)))
            lines.append(f"| {path.stem} | {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    print(table())
