"""Tables of points in text files: what the command line reads, and writes back.

The format is described in python/docs/files.md. Everything that is wrong with a file is a
`FileError`: one line with the file, the line, and what is wrong.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["FileError", "Points", "read_function", "read_points", "text_of", "write_table"]

#: Names of the column of parameters, in any case.
PARAMETER = ("u", "t")
AXES = ("x", "y", "z")
#: What may stand in a line of units below the header, in any case, besides what is in brackets.
UNITS = {
    "", "-", "1", "%", "°", "deg", "rad", "m", "mm", "cm", "km", "µm", "um", "nm", "å", "in", "ft",
    "mi", "px", "pt", "s", "ms", "min", "h", "d", "a", "y", "yr", "hz", "v", "k", "°c", "pa",
    "bar", "n", "kg", "g", "w", "years", "seconds", "metres", "meters",
}  # fmt: skip


class FileError(Exception):
    """A file cannot be used; the message is one line."""

    def __init__(self, path: Path, what: str, line: int | None = None) -> None:
        where = f"{path}, line {line}" if line else str(path)
        super().__init__(f"{where}: {what}")


def text_of(path: Path) -> str:
    """Return the text of a file, without a byte order mark."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise FileError(path, "is not text in UTF-8", line) from None


@dataclass(frozen=True)
class Points:
    """Points of a file, and where they stand in it."""

    path: Path
    points: Floats
    parameters: Floats | None
    lines: list[int]
    #: Names of the columns of ``points``, with their units as the file has them.
    names: list[str]

    def locate(self, message: str, names: Sequence[str] = ("points", "parameters")) -> int | None:
        """Return the line of the row that a message names by the index of one of the arguments."""
        if self.parameters is None:
            names = [name for name in names if name != "parameters"]
        found = re.search(rf"\b(?:{'|'.join(names)})\[(\d+)", message)
        if found is None or int(found.group(1)) >= len(self.lines):
            return None
        return self.lines[int(found.group(1))]


# Lines and cells


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _separator(line: str) -> str | None:
    """Return what separates the cells of a line; ``None`` for blanks."""
    return next((s for s in ("\t", ";", ",") if s in line), None)


def _cells(line: str, separator: str | None) -> list[str]:
    if separator is None:
        # "x [mm] y [mm]": the unit belongs to the name before it.
        line = re.sub(r"(?<=[^\s\])])\s+(?=[\[(])", "", line)
    cells = [cell.strip().strip("\"'").strip() for cell in line.split(separator)]
    if separator in (";", "\t"):
        # A decimal comma, as spreadsheets write it in many languages.
        cells = [re.sub(r"^([-+]?\d*),(\d+(?:[eE][-+]?\d+)?)$", r"\1.\2", cell) for cell in cells]
    return cells


def _bare(name: str) -> str:
    """Return a column's name in small letters, without its unit: 'X [mm]', 'x (mm)', 'x/mm'."""
    return re.sub(r"\s*(\[.*\]|\(.*\)|/.*)$", "", name).strip().lower()


def _are_units(cells: list[str]) -> bool:
    """Whether a line below the header holds units, and no numbers."""
    return any(_number(cell) is None for cell in cells) and all(
        cell.lower() in UNITS or re.fullmatch(r"\[.*\]|\(.*\)", cell) for cell in cells
    )


@dataclass(frozen=True)
class _Table:
    """The columns that were asked for."""

    names: list[str]
    values: Floats
    lines: list[int]


def _read(path: Path, choose: Callable[[list[str] | None, int, int], list[int]]) -> _Table:
    """Read some columns of a table; ``choose`` gets the names, their number and the line."""
    rows: list[list[float]] = []
    lines: list[int] = []
    columns: list[int] | None = None
    names: list[str] = []
    separator: str | None = None
    units_may_follow = False
    for number, raw in enumerate(text_of(path).splitlines(), start=1):
        line = raw.strip()
        if not line or line[0] in "#%":
            continue
        if columns is None:
            separator = _separator(line)
            cells = _cells(line, separator)
            if all(_number(cell) is None for cell in cells):
                names, columns = cells, choose(cells, len(cells), number)
                units_may_follow = True
                continue
            names = [f"{i + 1}" for i in range(len(cells))]
            columns = choose(None, len(cells), number)
        cells = _cells(line, separator)
        if len(cells) != len(names):
            raise FileError(path, f"{len(names)} columns expected, got {len(cells)}", number)
        if units_may_follow and _are_units(cells):
            names = [
                f"{name} [{unit.strip('[]()')}]" if unit.strip("[]()") else name
                for name, unit in zip(names, cells, strict=True)
            ]
            units_may_follow = False
            continue
        units_may_follow = False
        row = []
        for column in columns:
            value = _number(cells[column])
            if value is None or not math.isfinite(value):
                what = "is not a number" if value is None else "is not finite"
                raise FileError(path, f"'{cells[column]}' in column {names[column]} {what}", number)
            row.append(value)
        rows.append(row)
        lines.append(number)
    if not rows or columns is None:
        raise FileError(path, "holds no points")
    return _Table([names[c] for c in columns], np.array(rows), lines)


# Which columns


def _asked(
    path: Path, names: list[str] | None, count: int, line: int, asked: Sequence[str]
) -> list[int]:
    """Return the columns that the user asked for, by name or by number from 1."""
    bare = [_bare(name) for name in names or []]
    found = []
    for name in asked:
        if _bare(name) in bare:
            found.append(bare.index(_bare(name)))
        elif name.isdigit() and 1 <= int(name) <= count:
            found.append(int(name) - 1)
        else:
            there = f"named {', '.join(names)}" if names else f"numbered 1 to {count}"
            raise FileError(path, f"there is no column '{name}'; columns are {there}", line)
    return found


def _axes(path: Path, names: list[str], line: int) -> list[int]:
    """Return which columns to take by their header: x, y and z, then the parameter, if any."""
    bare = [_bare(name) for name in names]
    for name in (*PARAMETER, *AXES):
        if bare.count(name) > 1:
            raise FileError(path, f"two columns are called '{name}'", line)
    axes = [bare.index(axis) for axis in AXES if axis in bare]
    if {"x", "y"} <= set(bare):
        return axes + [bare.index(name) for name in PARAMETER if name in bare][:1]
    if not axes and len(names) in (2, 3):
        return list(range(len(names)))
    named = ", ".join(f"'{name}'" for name in names)
    raise FileError(
        path, f"the header must name columns x, y and perhaps z and u; got {named}", line
    )


def read_points(path: Path, columns: Sequence[str] | None = None) -> Points:
    """Read points, one a line, with or without a header.

    Cells are separated by tabs, semicolons, commas or blanks; empty lines and lines that begin with
    ``#`` or ``%`` are left out, and a line of units below the header is understood. With a header,
    the columns x, y and perhaps z are the points, u (or t) their parameters, and others are
    ignored; without, there are two or three columns. ``columns`` names two or three others.
    """
    with_parameters = False

    def choose(names: list[str] | None, count: int, line: int) -> list[int]:
        nonlocal with_parameters
        if columns is not None:
            return _asked(path, names, count, line, columns)
        if names is None:
            if count not in (2, 3):
                what = f"points have 2 or 3 coordinates, got {count} columns without a header"
                raise FileError(path, what, line)
            return list(range(count))
        found = _axes(path, names, line)
        with_parameters = _bare(names[found[-1]]) in PARAMETER and len(found) > 2
        return found

    table = _read(path, choose)
    points, parameters, names = table.values, None, table.names
    if with_parameters:
        points, parameters, names = points[:, :-1], points[:, -1], names[:-1]
    return Points(path, points, parameters, table.lines, names)


def read_function(path: Path, columns: Sequence[str] | None = None) -> Points:
    """Read the points (x, y) of a function, one a line: the first two columns, or the ones named.

    With a header that has columns x and y, those are taken wherever they stand.
    """

    def choose(names: list[str] | None, count: int, line: int) -> list[int]:
        if columns is not None:
            return _asked(path, names, count, line, columns)
        bare = [_bare(name) for name in names or []]
        if {"x", "y"} <= set(bare):
            return [bare.index("x"), bare.index("y")]
        if count != 2:
            what = f"a function has two columns, got {count}; choose two with --columns"
            raise FileError(path, what, line)
        return [0, 1]

    table = _read(path, choose)
    return Points(path, table.values, None, table.lines, table.names)


def write_table(names: Sequence[str], values: Floats, separator: str = ",") -> str:
    """Return a table as text: a header, then numbers that read back to the last bit."""
    lines = [separator.join(names)]
    lines += [separator.join(map(repr, row)) for row in values.tolist()]
    return "\n".join(lines) + "\n"
