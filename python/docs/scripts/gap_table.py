# SPDX-License-Identifier: MIT OR Apache-2.0

"""Print the table of gaps in python/docs/fair-splines.md: energies over the C² cubic's, less 1.

Run from the root of the repository; a test holds the page against it:

    python python/docs/scripts/gap_table.py
"""

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

import shapespline as ss

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests"))
import cases
import polygons

COLUMNS = ("data", "curves", "with violations", "median", "worst")
#: README's points: two nearly straight runs and a sharp bend.
BEND = ((0, 0, 0), (2, 0, 0.1), (4, 0.1, 0.1), (4.5, 0.4, 0.2), (4.6, 3, 0.2), (4.6, 6, 0.3))
#: Functions among the data, taken as curves in the plane.
PLANAR = ("akima", "rpn14")
#: Walks generated in each dimension.
WALKS = 100


def shared() -> list[cases.Case]:
    """Return the sets of tests/data, README's points and the planar ones."""
    plane = {name: np.column_stack(list(polygons.load(name).values())) for name in PLANAR}
    plane["hiking track from above"] = polygons.load_points("gps_mojstrovka")[:, :2]
    small = {"README's points": np.array(BEND, float), **plane}
    return [*cases.shared(), *(cases.Case(name, points) for name, points in small.items())]


def gap(case: cases.Case) -> float | None:
    """Return by how much the energy is above its lower bound; none where its ends gave way."""
    return replace(case, family=ss.FairSpline).preserve().diagnostics.gap


def walks(dim: int) -> Iterator[cases.Case]:
    """Yield random walks of 5 to 60 points."""
    rng = np.random.default_rng(20 + dim)
    for k in range(WALKS):
        yield cases.Case(f"walk {k}", polygons.random_walk(rng, int(rng.integers(5, 61)), dim))


def row(name: str, gaps: list[float]) -> list[str]:
    """Return the cells of some curves."""
    counts = [str(len(gaps)), str(sum(g > 0 for g in gaps))]
    return [name, *counts, f"{np.median(gaps):.3g}", f"{max(gaps):.3g}"]


def shared_rows() -> list[list[str]]:
    """Return a row for each shared set that has a bound, and one for all."""
    found = {case.name: gap(case) for case in shared()}
    gaps = {name: g for name, g in found.items() if g is not None}
    return [*(row(name, [g]) for name, g in gaps.items()), row("all of these", [*gaps.values()])]


def walk_rows() -> list[list[str]]:
    """Return the rows of the generated walks."""
    names = {3: "walks in space", 2: "walks in the plane"}
    found = {name: [gap(case) for case in walks(dim)] for dim, name in names.items()}
    return [row(name, [g for g in gaps if g is not None]) for name, gaps in found.items()]


def table() -> str:
    """Return the table in Markdown."""
    heading = [list(COLUMNS), ["---"] + ["--:"] * (len(COLUMNS) - 1)]
    lines = [*heading, *shared_rows(), *walk_rows()]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    print(table())
