# SPDX-License-Identifier: MIT OR Apache-2.0

"""Print the table of python/docs/families.md: what the families make of the data sets.

Run from the root of the repository; a test holds the page against it:

    python python/docs/scripts/families_table.py
"""

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

import shapespline as ss

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests"))
import cases

Array = np.ndarray

COLUMNS = (
    "data, ends",
    "family",
    "violations before",
    "after",
    "iterations",
    "solves",
    "from the polygon",
    "from the C² cubic",
    "energy over the cubic's",
    "largest curvature",
    "the cubic's",
)
#: Points looked at on each segment.
SAMPLES = 129


def pieces(curve: ss.SpaceCurve) -> Array:
    """Return points on each segment: (segments, SAMPLES, dim)."""
    t = np.linspace(0, 1, SAMPLES)
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    return weights @ curve.bezier


def from_broken_line(points: Array, corners: Array) -> float:
    """Return the largest distance of the points from a broken line."""
    start, along = corners[:-1], np.diff(corners, axis=0)
    part = np.sum((points[:, None] - start) * along, axis=-1) / np.sum(along**2, axis=-1)
    nearest = start + np.clip(part, 0, 1)[..., None] * along
    return float(np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1).max())


def measures(curve: ss.SpaceCurve) -> tuple[float, float]:
    """Return ∫κ² ds and the largest curvature."""
    found = curve.fairness()
    return found.bending / found.length, found.max_curvature


def row(case: cases.Case, plain: ss.NuSpline, family: type[ss.SpaceCurve]) -> list[str]:
    """Return the cells of a data set and a family; lengths in mean chords of the data."""
    case = replace(case, family=family)
    # The search for a fair curve begins with the plain cubic.
    before = (plain if family is ss.FairSpline else case.fit()).check()
    after = case.preserve()
    chord = np.linalg.norm(np.diff(case.points, axis=0), axis=1).mean()
    own, u = pieces(after), after.knots
    segment = np.searchsorted(after.parameters[1:-1], u[:-1], side="right")
    polygon = max(
        from_broken_line(p, case.points[i : i + 2]) for p, i in zip(own, segment, strict=True)
    )
    # The pieces of the cubic between the same knots.
    t = u[:-1, None] + np.diff(u)[:, None] * np.linspace(0, 1, SAMPLES)
    apart = max(from_broken_line(p, q) for p, q in zip(own, plain(t), strict=True))
    search = after.diagnostics
    (energy, largest), (energy_cubic, largest_cubic) = measures(after), measures(plain)
    return [
        case.name,
        family.__name__,
        str(len(before.violations)),
        str(len(after.check().violations)),
        str(search.iterations),
        str(search.solves),
        f"{polygon / chord:.3g}",
        f"{apart / chord:.3g}",
        f"{energy / energy_cubic:.3g}",
        f"{largest * chord:.3g}",
        f"{largest_cubic * chord:.3g}",
    ]


def rows() -> Iterator[list[str]]:
    """Yield the cells of every data set and family."""
    for case in cases.shared():
        plain = case.fit()
        for family in cases.FAMILIES:
            yield row(case, plain, family)


def table() -> str:
    """Return the table in Markdown."""
    lines = [list(COLUMNS), ["---"] * 2 + ["--:"] * (len(COLUMNS) - 2), *rows()]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    print(table())
