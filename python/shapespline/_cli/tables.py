# SPDX-License-Identifier: MIT OR Apache-2.0

"""Tables of points in text files: what the command line reads, and writes back.

The format is described in python/docs/files.md. Everything that is wrong with a file is a
`FileError`: one line with the file, the line, and what is wrong.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline._cli.cells import (
    SEPARATORS,
    Lines,
    is_data,
    name_and_unit,
    number,
    plain,
    read_lines,
    records,
    split,
    value,
)
from shapespline._cli.text_io import FileError, shortened, text_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    #: Which columns to take, by the names of all, if any, the first row, and the line of these.
    Choose = Callable[[list[str] | None, list[str], int], list[int]]

__all__ = ["Points", "read_function", "read_points", "write_table"]

#: Names of the column of parameters, in any case.
PARAMETER = ("u", "t", "time")
AXES = ("x", "y", "z")
#: Names of angles on the globe: lengths do not go with them.
ANGLES = {"lon", "lat", "long", "lng", "longitude", "latitude"}
ANGULAR = {"deg", "rad"}
#: What may stand in a line of units below the header, in any case, besides what is in brackets.
UNITS = {
    "", "-", "1", "%", "°", "deg", "rad", "m", "mm", "cm", "km", "µm", "um", "nm", "å", "in", "ft",
    "mi", "px", "pt", "s", "ms", "min", "h", "d", "a", "y", "yr", "hz", "v", "k", "°c", "pa",
    "bar", "n", "kg", "g", "w", "years", "seconds", "metres", "meters",
}  # fmt: skip
#: Other spellings; the third μ is Greek.
SPELLINGS = {
    "metres": "m", "meters": "m", "um": "µm", "μm": "µm", "°": "deg", "degrees": "deg",
    "-": "", "1": "",
}  # fmt: skip


@dataclass(frozen=True)
class Points:
    """Points of a file, and where they stand in it."""

    path: Path
    points: Floats
    parameters: Floats | None
    lines: list[int]
    #: Names of the columns of ``points``, with their units as the file has them.
    names: list[str]
    #: What the user should know of how the file was read: one line each.
    notes: list[str] = field(default_factory=list)

    def line(self, index: Any) -> int | None:
        """Return the line of the point with this index, if there is one."""
        inside = isinstance(index, int) and index < len(self.lines)
        return self.lines[index] if inside else None


def unit_of(name: str) -> str:
    """Return the unit in a column's name, in the spelling that STEP has; empty if none is known."""
    unit = name_and_unit(name)[1]
    return SPELLINGS.get(unit, unit) if unit in UNITS or unit in SPELLINGS else ""


# Headers


def _are_units(cells: list[str]) -> bool:
    """Whether a line below the header holds units, and no numbers."""
    return any(number(cell) is None for cell in cells) and all(
        cell.lower() in UNITS or (cell[:1], cell[-1:]) in {("[", "]"), ("(", ")")} for cell in cells
    )


def _with_units(names: list[str], units: list[str]) -> list[str]:
    bare = [unit.strip("[]()") for unit in units]
    return [f"{name} [{unit}]" if unit else name for name, unit in zip(names, bare, strict=True)]


def _bare(names: list[str]) -> list[str]:
    return [name_and_unit(name)[0] for name in names]


@dataclass
class _Table:
    """A table while it is read: its rows, and what stands before the first of them."""

    path: Path
    lines: Lines
    #: Rows before the first of numbers: titles, the header, units.
    preamble: list[tuple[int, list[str]]]
    #: The first row of numbers, and its line.
    first: list[str]
    at: int

    def number(self, cell: str, name: str, line: int) -> float:
        """Return the number in a cell, or raise."""
        found = value(cell, self.lines.separator)
        if found is None or not math.isfinite(found):
            what = "is not a number" if found is None else "is not finite"
            where = f"'{shortened(cell)}' in column {shortened(name)}"
            raise FileError(self.path, f"{where} {what}", line)
        return found

    def header(self, asked: Sequence[str] | None) -> tuple[list[str] | None, int]:
        """Return the names of the columns, if there are any, and their line.

        Below a header the first row is what follows it, numbers or not.
        """
        n = len(self.first)
        rows = self._preamble(n)
        exact = [k for k, (_, cells) in enumerate(rows) if len(cells) == n]
        named = [k for k in exact if {"x", "y"} <= set(_bare(rows[k][1]))]
        start = (named or exact or [len(rows)])[0]
        for at, cells in rows[:start]:
            # A title: one cell, or words.
            separated = self.lines.separator is not None and len(cells) > 1
            numbers = any(number(cell) is not None for cell in cells)
            last = at == self.preamble[-1][0]
            if (separated and (numbers or last)) or {"x", "y"} <= set(_bare(cells)):
                raise FileError(self.path, f"{len(cells)} columns expected, got {n}", self.at)
        if not exact:
            return self._commented(asked)
        at, names = rows[start]
        below = rows[start + 1 :]
        if below and len(below[0][1]) == n and _are_units(below[0][1]):
            names = _with_units(names, below.pop(0)[1])
        if below:
            self.at, self.first = below[0]
        return names, at

    def _preamble(self, n: int) -> list[tuple[int, list[str]]]:
        """Return what is above the numbers, where its lines may separate cells in another way."""
        if all(len(cells) == n for _, cells in self.preamble):
            return self.preamble
        texts = {at: text for at, text, _ in self.lines.content if at < self.at}
        rows = []
        for at, cells in self.preamble:
            others = (split(texts[at], separator) for separator in SEPARATORS)
            fitting = next((other for other in others if len(other) == n), cells)
            rows.append((at, cells if len(cells) == n else fitting))
        return rows

    def _commented(self, asked: Sequence[str] | None) -> tuple[list[str] | None, int]:
        """Return the names in a comment above the numbers, if it names what is needed."""
        needed = {"x", "y"} if asked is None else set(_bare(list(asked)))
        for at, text in reversed([c for c in self.lines.comments if c[0] < self.at]):
            for separator in SEPARATORS:
                names = split(text, separator)
                if len(names) == len(self.first) and needed <= set(_bare(names)):
                    return names, at
        return None, self.at


def _open(path: Path) -> _Table:
    """Find the first row of numbers."""
    lines = read_lines(text_of(path))
    preamble: list[tuple[int, list[str]]] = []
    for at, _, cells in records(path, lines):
        if is_data(cells, lines.separator):
            return _Table(path, lines, preamble, cells, at)
        preamble.append((at, cells))
    # No such row: what comes closest has to say what is wrong with it.
    for k, (at, cells) in enumerate(preamble):
        below_header = k and len(cells) == len(preamble[0][1]) and not _are_units(cells)
        if below_header or any(number(cell) is not None for cell in cells):
            return _Table(path, lines, preamble[:k], cells, at)
    raise FileError(path, "holds no points")


def _read(path: Path, asked: Sequence[str] | None, choose: Choose) -> Points:
    """Read the columns that ``choose`` names by their numbers, given their names, if any."""
    table = _open(path)
    header, at = table.header(asked)
    columns = choose(header, table.first, at)
    names = header or [f"{i + 1}" for i in range(len(table.first))]
    rows: list[list[float | None]] = []
    lines: list[int] = []
    gaps: list[int] = []
    below = (row for row in records(path, table.lines) if row[0] >= table.at)
    for line, after_blank, cells in below:
        if len(cells) != len(names):
            raise FileError(path, f"{len(names)} columns expected, got {len(cells)}", line)
        if after_blank and rows:
            gaps.append(line - 1)
        row = [plain(cells[c]) for c in columns]
        if None in row or not math.isfinite(sum(row)):  # type: ignore[arg-type]
            row = [table.number(cells[c], names[c], line) for c in columns]
        rows.append(row)
        lines.append(line)
    notes = []
    if gaps:
        blocks = f"{len(gaps) + 1} blocks of points are taken as one"
        notes.append(f"line {gaps[0]}: empty lines between points are ignored: {blocks}")
    return Points(path, np.array(rows), None, lines, [names[c] for c in columns], notes)


# Which columns


def _asked(
    path: Path, header: list[str] | None, count: int, line: int, asked: Sequence[str]
) -> list[int]:
    """Return the columns that the user asked for, by name or by number from 1."""
    bare = _bare(header or [])
    found = []
    for name in asked:
        (wanted,) = _bare([name])
        if wanted in bare:
            found.append(bare.index(wanted))
        elif name.isascii() and name.isdigit() and len(name) < 9 and 1 <= int(name) <= count:
            found.append(int(name) - 1)
        else:
            there = f"named {', '.join(header)}" if header else f"numbered 1 to {count}"
            what = f"there is no column '{shortened(name)}'; columns are {there}"
            raise FileError(path, what, line)
    return found


def _axes(path: Path, header: list[str], line: int) -> tuple[list[int], int | None]:
    """Return which columns are coordinates by their header, and which holds parameters."""
    bare = _bare(header)
    for name in (*PARAMETER, *AXES):
        if bare.count(name) > 1:
            raise FileError(path, f"two columns are called '{name}'; choose with --columns", line)
    parameter = next((bare.index(name) for name in PARAMETER if name in bare), None)
    axes = [bare.index(axis) for axis in AXES if axis in bare]
    if {"x", "y"} <= set(bare):
        return axes, parameter
    if not axes and len(header) in (2, 3):
        others = [i for i in range(len(header)) if i != parameter]
        # u, v, w are coordinates; times are not.
        if len(others) == 2 and bare[parameter or 0] in ("t", "time"):
            return others, parameter
        return list(range(len(header))), None
    named = ", ".join(f"'{shortened(name)}'" for name in header)
    raise FileError(
        path,
        "the header must name columns x, y and perhaps z and u, or choose others with --columns; "
        f"got {named}",
        line,
    )


def _refuse_mixed_units(path: Path, names: list[str], line: int) -> None:
    """Raise where coordinates have different units: the shape of such points means nothing."""
    units = [unit_of(name) for name in names]
    given = sorted({unit for unit in units if unit})
    angular = [
        u in ANGULAR or (not u and b in ANGLES) for u, b in zip(units, _bare(names), strict=True)
    ]
    if len(given) > 1 or (any(angular) and not all(angular)):
        listed = ", ".join(shortened(name) for name in names)
        what = "degrees and lengths" if any(angular) else " and ".join(given)
        raise FileError(path, f"columns {listed} mix {what}; convert them to one unit first", line)


def read_points(path: Path, columns: Sequence[str] | None = None) -> Points:
    """Read points, one a line, with or without a header.

    Cells are separated by tabs, semicolons, commas or blanks; empty lines, titles and comments are
    left out, and a line of units below the header is understood. With a header, the columns x, y
    and perhaps z are the points, u (or t, or time) their parameters, and others are ignored;
    without, there are two or three columns. ``columns`` names two or three others.
    """
    notes: list[str] = []
    with_parameters = False

    def choose(header: list[str] | None, first: list[str], line: int) -> list[int]:
        nonlocal with_parameters
        parameter = None
        if columns is not None:
            found = _asked(path, header, len(first), line, columns)
        elif header is None:
            count = max((i + 1 for i, cell in enumerate(first) if cell), default=0)
            if count not in (2, 3):
                what = f"points have 2 or 3 coordinates, got {count} columns without a header"
                raise FileError(path, f"{what}; choose with --columns, as in --columns 1,2", line)
            found = list(range(count))
        else:
            found, parameter = _axes(path, header, line)
        if header is not None:
            _refuse_mixed_units(path, [header[i] for i in found], line)
        if parameter is None or header is None:
            return found
        if _bare(header)[parameter] == "time" and number(first[parameter]) is None:
            cell = shortened(first[parameter])
            notes.append(f"column time holds '{cell}', no number: it is not used as parameters")
            return found
        with_parameters = True
        return [*found, parameter]

    read = _read(path, columns, choose)
    points, parameters, names = read.points, None, read.names
    if with_parameters:
        points, parameters, names = points[:, :-1], points[:, -1], names[:-1]
    return Points(path, points, parameters, read.lines, names, notes + read.notes)


def read_function(path: Path, columns: Sequence[str] | None = None) -> Points:
    """Read the points (x, y) of a function, one a line: the first two columns, or the ones named.

    With a header that has columns x and y, those are taken wherever they stand.
    """

    def choose(header: list[str] | None, first: list[str], line: int) -> list[int]:
        if columns is not None:
            return _asked(path, header, len(first), line, columns)
        bare = _bare(header or [])
        if {"x", "y"} <= set(bare):
            return [bare.index("x"), bare.index("y")]
        if len(first) != 2:
            what = f"a function has two columns, got {len(first)}; choose two with --columns"
            raise FileError(path, what, line)
        return [0, 1]

    return _read(path, columns, choose)


def write_table(names: Sequence[str], values: Floats, separator: str = ",") -> str:
    """Return a table as text: a header, then numbers that read back to the last bit."""
    header = io.StringIO()
    csv.writer(header, delimiter=separator, lineterminator="").writerow(names)
    rows = (separator.join(map(repr, row)) for row in values.tolist())
    return "\n".join(chain([header.getvalue()], rows)) + "\n"
