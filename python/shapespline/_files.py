"""Points and curves in files: what the command line reads and writes.

Points are tables of text (`read_points`), curves JSON (`read_curve`, `write_curve`); both formats
are described in python/docs/files.md. Everything that is wrong with a file is a `FileError`: one
line with the file, the line, and what is wrong.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from shapespline._convert import piecewise
from shapespline._core import NuSpline, PiecewiseBezier, SpaceCurve, Tangents

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["CurveFile", "FileError", "Points", "read_curve", "read_points", "write_curve"]

FORMAT = "shapespline-curve"
#: Names of the column of parameters, in any case.
PARAMETER = ("u", "t")
AXES = ("x", "y", "z")


class FileError(Exception):
    """A file cannot be used; the message is one line."""

    def __init__(self, path: Path, what: str, line: int | None = None) -> None:
        where = f"{path}, line {line}" if line else str(path)
        super().__init__(f"{where}: {what}")


def _text(path: Path) -> str:
    """Return the text of a file, without a byte order mark."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise FileError(path, "is not text in UTF-8", line) from None


# Tables of points


@dataclass(frozen=True)
class Points:
    """Points of a file, and where they stand in it."""

    path: Path
    points: Floats
    parameters: Floats | None
    lines: list[int]

    def locate(self, message: str) -> int | None:
        """Return the line of the point, or parameter, that a message names by its index."""
        names = "points" if self.parameters is None else "points|parameters"
        found = re.search(rf"\b(?:{names})\[(\d+)", message)
        if found is None or int(found.group(1)) >= len(self.lines):
            return None
        return self.lines[int(found.group(1))]


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _separator(line: str) -> str | None:
    """Return what separates the cells of a line; ``None`` for blanks."""
    return next((s for s in ("\t", ";", ",") if s in line), None)


def _cells(line: str, separator: str | None) -> list[str]:
    cells = [cell.strip().strip("\"'").strip() for cell in line.split(separator)]
    if separator in (";", "\t"):
        # A decimal comma, as spreadsheets write it in many languages.
        cells = [re.sub(r"^([-+]?\d*),(\d+(?:[eE][-+]?\d+)?)$", r"\1.\2", cell) for cell in cells]
    return cells


def _columns(path: Path, names: list[str], line: int) -> list[int]:
    """Return which columns to take by their header: the parameter, or -1, then x, y and z."""
    lower = [name.lower() for name in names]
    for name in (*PARAMETER, *AXES):
        if lower.count(name) > 1:
            raise FileError(path, f"two columns are called '{name}'", line)
    axes = [lower.index(axis) for axis in AXES if axis in lower]
    if {"x", "y"} <= set(lower):
        parameter = next((lower.index(name) for name in PARAMETER if name in lower), -1)
        return [parameter, *axes]
    if not axes and len(names) in (2, 3):
        return [-1, *range(len(names))]
    named = ", ".join(f"'{name}'" for name in names)
    what = f"the header must name columns x, y and perhaps z and u; got {named}"
    raise FileError(path, what, line)


def read_points(path: Path) -> Points:
    """Read points, one a line, with or without a header.

    Cells are separated by tabs, semicolons, commas or blanks; empty lines and lines that begin with
    ``#`` or ``%`` are left out. With a header, the columns x, y and perhaps z are the points, u (or
    t) their parameters, and others are ignored; without, there are two or three columns.
    """
    rows: list[list[float]] = []
    lines: list[int] = []
    columns: list[int] = []
    names: list[str] = []
    separator: str | None = None
    for number, raw in enumerate(_text(path).splitlines(), start=1):
        line = raw.strip()
        if not line or line[0] in "#%":
            continue
        if not columns:
            separator = _separator(line)
            cells = _cells(line, separator)
            header = any(_number(cell) is None for cell in cells)
            if header and not any(_number(cell) is not None for cell in cells):
                names, columns = cells, _columns(path, cells, number)
                continue
            if len(cells) not in (2, 3):
                what = f"points have 2 or 3 coordinates, got {len(cells)} columns without a header"
                raise FileError(path, what, number)
            names = [f"{i + 1}" for i in range(len(cells))]
            columns = [-1, *range(len(cells))]
        cells = _cells(line, separator)
        if len(cells) != len(names):
            raise FileError(path, f"{len(names)} columns expected, got {len(cells)}", number)
        row = []
        for column in columns:
            if column < 0:
                row.append(0.0)
                continue
            value = _number(cells[column])
            if value is None or not math.isfinite(value):
                what = "is not a number" if value is None else "is not finite"
                raise FileError(path, f"'{cells[column]}' in column {names[column]} {what}", number)
            row.append(value)
        rows.append(row)
        lines.append(number)
    if not rows:
        raise FileError(path, "holds no points")
    table = np.array(rows)
    parameters = table[:, 0] if columns[0] >= 0 else None
    return Points(path, table[:, 1:], parameters, lines)


# Curves


@dataclass(frozen=True)
class CurveFile:
    """A curve of a file, and what the file says of the points it belongs to."""

    path: Path
    curve: PiecewiseBezier
    parameters: Floats | None
    boundary: Any


class _Document:
    """The object of a curve file: its entries, and the lines they stand on."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = _text(path)
        try:
            entries = json.loads(self.text)
        except json.JSONDecodeError as error:
            raise FileError(path, f"is not JSON: {error.msg}", error.lineno) from None
        except RecursionError:
            raise FileError(path, "is not a curve: nested too deeply") from None
        if not isinstance(entries, dict):
            raise FileError(path, "must hold one JSON object, the curve")
        self.entries: dict[str, Any] = entries

    def line(self, key: str) -> int | None:
        found = re.search(rf'"{re.escape(key)}"\s*:', self.text)
        return self.text.count("\n", 0, found.start()) + 1 if found else None

    def fail(self, what: str, key: str | None = None) -> NoReturn:
        raise FileError(self.path, what, self.line(key) if key else None)

    def array(self, key: str) -> Floats:
        """Return an entry that has to be there as an array of floats."""
        if key not in self.entries:
            self.fail(f"has no entry '{key}', which a curve of this type needs")
        try:
            array = np.asarray(self.entries[key])
        except ValueError:
            self.fail(f"'{key}' must be an array: its rows have different lengths", key)
        if array.dtype.kind not in "iuf":
            self.fail(f"'{key}' must hold numbers only", key)
        return array.astype(float)

    def optional(self, key: str) -> Floats | None:
        return None if self.entries.get(key) is None else self.array(key)


def _type(document: _Document) -> str:
    given = document.entries.get("type")
    if given is None:
        if "knots" in document.entries:
            return "bspline"
        return "power" if "coefficients" in document.entries else "bezier"
    if given not in ("bezier", "bspline", "power"):
        document.fail(f"'type' must be 'bezier', 'bspline' or 'power', got {given!r}", "type")
    return str(given)


def _boundary(document: _Document) -> Any:
    """Return the end conditions as a name or as `Tangents`."""
    given = document.entries.get("boundary")
    if not isinstance(given, dict):
        if given is not None and not isinstance(given, str):
            document.fail("'boundary' must be a name or hold 'start' and 'end'", "boundary")
        return given
    if set(given) != {"start", "end"}:
        document.fail("'boundary' must be a name or hold 'start' and 'end'", "boundary")
    try:
        return Tangents(given["start"], given["end"])
    except (ValueError, TypeError) as error:
        document.fail(f"'boundary': {error}", "boundary")


def read_curve(path: Path) -> CurveFile:
    """Read a curve from JSON: Bézier pieces, a B-spline or a piecewise polynomial in powers."""
    document = _Document(path)
    kind = _type(document)
    parameters = document.optional("parameters")
    weights = document.optional("weights")
    try:
        if kind == "bspline":
            degree = document.entries.get("degree")
            if not isinstance(degree, int) or isinstance(degree, bool):
                document.fail("'degree' must be an integer", "degree")
            knots, control = document.array("knots"), document.array("control")
            curve = PiecewiseBezier.from_bspline(knots, control, degree, weights=weights)
        elif kind == "power":
            coefficients, breaks = document.array("coefficients"), document.array("breaks")
            if weights is not None:
                document.fail("a curve of type 'power' takes no 'weights'", "weights")
            curve = PiecewiseBezier.from_power(coefficients, breaks)
        else:
            key = "breaks" if "breaks" in document.entries else "parameters"
            control, breaks = document.array("control"), document.array(key)
            curve = PiecewiseBezier(control, breaks, weights=weights)
    except ValueError as error:
        # The message begins with the name of the argument, which is the name of the entry.
        named = re.match(r"\w+", str(error))
        document.fail(str(error), named.group() if named else None)
    return CurveFile(path, curve, parameters, _boundary(document))


def write_curve(path: Path, curve: Any) -> None:
    """Write a curve as Bézier pieces; one of this module with its parameters and end conditions."""
    pieces = piecewise(curve)
    entries: dict[str, Any] = {"format": FORMAT, "version": 1, "type": "bezier"}
    if isinstance(curve, SpaceCurve):
        entries["method"] = "nu" if isinstance(curve, NuSpline) else type(curve).__name__
        entries["parameters"] = curve.parameters.tolist()
        ends = curve.boundary
        entries["boundary"] = (
            {"start": ends.start.tolist(), "end": ends.end.tolist()}
            if isinstance(ends, Tangents)
            else ends
        )
        entries["tension"] = curve.tension.tolist()
    entries["breaks"] = pieces.breaks.tolist()
    entries["control"] = pieces.control.tolist()
    if pieces.weights is not None:
        entries["weights"] = pieces.weights.tolist()
    # One entry a line: readable, and errors can name the line.
    body = ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in entries.items())
    try:
        path.write_text("{\n" + body + "\n}\n", encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from None
