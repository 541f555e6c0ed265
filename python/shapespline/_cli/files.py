# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves in files: what the command line reads and writes as JSON.

The format is described in python/docs/files.md. Everything that is wrong with a file is a
`FileError`: one line with the file, the line, and what is wrong.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from shapespline._cli.text_io import FileError, shortened, text_of, write
from shapespline._convert import piecewise
from shapespline._core import (
    FairSpline,
    InputError,
    MonotoneSpline,
    PiecewiseBezier,
    SpaceCurve,
    Tangents,
)
from shapespline._methods import CHECKED, KINDS, METHODS

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["CurveFile", "read_curve", "write_curve"]

FORMAT = "shapespline-curve"
VERSION = 1
#: Names of the families, as the command line has them.
NAMES: dict[type, str] = {
    method.family: name for table in (METHODS, KINDS) for name, method in table.items()
}


# Curves


@dataclass(frozen=True)
class CurveFile:
    """A curve of a file, and what the file says of the points it belongs to."""

    path: Path
    curve: PiecewiseBezier
    parameters: Floats | None
    boundary: Any
    #: What the curve is to keep: the shape of points in space or in the plane, or monotonicity.
    shape: str
    #: What its fit was asked for, by the names of the options of a check; none of any other curve.
    fit_options: dict[str, Any] | None
    #: Points at which the curve has corners, and segments on which it is straight by construction.
    corners: list[int]
    straight: list[int]


def _integer(digits: str) -> int | float:
    # Python refuses to read integers of more than 4,300 digits; to every entry here they are large.
    return int(digits) if len(digits) < 20 else float(digits)


class _Document:
    """The object of a curve file: its entries, and the lines they stand on."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = text_of(path)
        try:
            entries = json.loads(self.text, parse_int=_integer, object_pairs_hook=self._unique)
        except json.JSONDecodeError as error:
            raise FileError(path, f"is not JSON: {error.msg}", error.lineno) from None
        except RecursionError:
            raise FileError(path, "is not a curve: nested too deeply") from None
        if not isinstance(entries, dict):
            raise FileError(path, "must hold one JSON object, the curve")
        self.entries: dict[str, Any] = entries

    def _unique(self, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        entries: dict[str, Any] = {}
        for name, entry in pairs:
            if name in entries:
                self.fail(f"holds two entries '{shortened(name)}'")
            entries[name] = entry
        return entries

    def line(self, key: str) -> int | None:
        found = re.search(rf'"{re.escape(key)}"\s*:', self.text)
        return self.text.count("\n", 0, found.start()) + 1 if found else None

    def fail(self, what: str, key: str | None = None) -> NoReturn:
        raise FileError(self.path, what, self.line(key) if key else None)

    def array(self, key: str) -> Floats:
        """Return an entry that has to be there as an array of floats."""
        if key not in self.entries:
            self.fail(f"has no entry '{key}', which a curve of this type needs")
        return self.numbers(self.entries[key], key)

    def numbers(self, given: Any, key: str) -> Floats:
        """Return something of an entry as an array of floats."""
        try:
            array = np.asarray(given)
        except ValueError:
            self.fail(f"'{key}' must be an array: its rows have different lengths", key)
        # Among numbers NumPy takes true and false for 1 and 0.
        if array.dtype.kind not in "iuf" or _holds_truth(given, array.ndim):
            self.fail(f"'{key}' must hold numbers only", key)
        return array.astype(float)

    def optional(self, key: str) -> Floats | None:
        return None if self.entries.get(key) is None else self.array(key)

    def check_format(self) -> None:
        """Refuse files that say they are of another format or version."""
        given = self.entries.get("format", FORMAT)
        if given != FORMAT:
            self.fail(f"'format' must be '{FORMAT}', got {_shown(given)}", "format")
        version = self.entries.get("version", VERSION)
        if type(version) is not int or version != VERSION:
            self.fail(f"'version' must be {VERSION}, got {_shown(version)}", "version")


def _shown(given: Any) -> str:
    return shortened(repr(given))


def _holds_truth(given: Any, depth: int) -> bool:
    """Whether true or false is among the numbers of nested lists."""
    flat = [given]
    for _ in range(depth):
        flat = list(chain.from_iterable(flat))
    return any(type(item) is bool for item in flat)


def _type(document: _Document) -> str:
    given = document.entries.get("type")
    if given is None:
        if "knots" in document.entries:
            return "bspline"
        return "power" if "coefficients" in document.entries else "bezier"
    if given not in ("bezier", "bspline", "power"):
        document.fail(f"'type' must be 'bezier', 'bspline' or 'power', got {_shown(given)}", "type")
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
        return Tangents(
            **{
                end: None if tangent is None else document.numbers(tangent, "boundary")
                for end, tangent in given.items()
            }
        )
    except InputError as error:
        document.fail(f"'boundary': {error}", "boundary")


def _fit_options(document: _Document) -> dict[str, Any] | None:
    """Return what the fit of the curve was asked for, if it was a fit."""
    key = "fit_options"
    given = document.entries.get(key)
    if given is None:
        return None
    if not isinstance(given, dict) or not set(given) <= set(CHECKED):
        document.fail(f"'{key}' must be an object with entries {', '.join(CHECKED)}", key)
    for name, option in given.items():
        if name == "criteria":
            if not isinstance(option, list) or not all(isinstance(c, str) for c in option):
                document.fail(f"'criteria' of '{key}' must be a list of names", key)
        elif document.numbers(option, key).ndim:
            document.fail(f"'{name}' of '{key}' must be a number", key)
    return given


def _indices(document: _Document, key: str) -> list[int]:
    """Return an entry that lists indices, if it is there."""
    given = document.entries.get(key, [])
    if not isinstance(given, list) or not all(type(i) is int and i >= 0 for i in given):
        document.fail(f"'{key}' must be a list of indices, counted from 0", key)
    return sorted(given)


def read_curve(path: Path) -> CurveFile:
    """Read a curve from JSON: Bézier pieces, a B-spline or a piecewise polynomial in powers."""
    document = _Document(path)
    document.check_format()
    kind = _type(document)
    parameters = document.optional("parameters")
    if parameters is not None and not parameters.ndim:
        document.fail("'parameters' must be an array of numbers", "parameters")
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
    except InputError as error:
        # The name of the argument is the name of the entry.
        document.fail(str(error), error.argument)
    shape = document.entries.get("shape", "polygon")
    if shape not in ("polygon", "monotone"):
        document.fail(f"'shape' must be 'polygon' or 'monotone', got {_shown(shape)}", "shape")
    return CurveFile(
        path,
        curve,
        parameters,
        _boundary(document),
        shape,
        _fit_options(document),
        _indices(document, "corners"),
        _indices(document, "straight"),
    )


def write_curve(path: Path, curve: Any) -> None:
    """Write a curve as Bézier pieces; one of this module with its parameters and end conditions.

    A function is written as its graph, and that it is to be monotone where its data are.
    """
    pieces = piecewise(curve)
    entries: dict[str, Any] = {"format": FORMAT, "version": VERSION, "type": "bezier"}
    if isinstance(curve, SpaceCurve):
        entries["method"] = NAMES.get(type(curve), type(curve).__name__)
        entries["parameters"] = curve.parameters.tolist()
        ends = curve.boundary
        entries["boundary"] = (
            {
                end: None if tangent is None else tangent.tolist()
                for end, tangent in (("start", ends.start), ("end", ends.end))
            }
            if isinstance(ends, Tangents)
            else ends
        )
        if isinstance(curve, FairSpline):
            entries["corners"], entries["straight"] = list(curve.corners), list(curve.straight)
        else:
            entries["tension"] = curve.tension.tolist()
        if (options := curve._fit_options()) is not None:
            entries["fit_options"] = options
    elif isinstance(curve, MonotoneSpline):
        entries["method"] = NAMES[type(curve)]
        entries["shape"] = "monotone"
    entries["breaks"] = pieces.breaks.tolist()
    entries["control"] = pieces.control.tolist()
    if pieces.weights is not None:
        entries["weights"] = pieces.weights.tolist()
    # One entry a line: readable, and errors can name the line.
    body = ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in entries.items())
    write(path, "{\n" + body + "\n}\n")
