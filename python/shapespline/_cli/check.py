# SPDX-License-Identifier: MIT OR Apache-2.0

"""The command ``shapespline check``: whether a curve keeps the shape of points, both from files."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import shapespline
from shapespline import _core
from shapespline._cli.files import read_curve
from shapespline._cli.options import (
    Parser,
    add_closing,
    add_corners,
    add_points,
    names,
    real,
)
from shapespline._cli.progress import progress
from shapespline._cli.tables import read_function, read_points
from shapespline._cli.text_io import (
    STREAM,
    FileError,
    UsageError,
    name_of,
    refuse_overwriting,
    write,
)
from shapespline._methods import CHECKED, METHODS

if TYPE_CHECKING:
    import argparse

    from shapespline._cli.files import CurveFile
    from shapespline._cli.tables import Points

__all__ = ["add_check"]


def _located(
    data: Points, curve: CurveFile, options: argparse.Namespace, error: shapespline.InputError
) -> Exception:
    """Return the error as one about the points, about the curve, or about an option."""
    if (
        error.argument in (*CHECKED, "boundary", "closed", "repeated", "corners")
        and getattr(options, error.argument) is not None
    ):
        return UsageError(str(error))
    # What the curve's own file says comes first.
    own = ["points", "x", "y"]
    if curve.parameters is None and data.parameters is not None:
        own.append("parameters")
    if error.argument in own:
        return FileError(data.path, str(error), data.line(error.index))
    return FileError(curve.path, str(error))


def _closing(options: argparse.Namespace, curve: CurveFile, points: int) -> tuple[bool, str]:
    """Return whether the points are closed, and what becomes of those that are repeated.

    Unless the user says so, as the fit had it whose parameters the file holds.
    """
    closed, repeated = options.closed, options.repeated
    u = curve.parameters
    if closed is None:
        closed = u is not None and curve.boundary == "periodic" and len(u) == points + 1
    if repeated is None:
        repeated = "error" if u is None or (np.diff(u) != 0).all() else "drop"
    return closed, repeated


def _run(options: argparse.Namespace) -> int:
    if options.points == options.curve == STREAM:
        raise UsageError("points and curve cannot both be standard input")
    refuse_overwriting([options.points, options.curve], filter(None, [options.report]))
    curve = read_curve(options.curve)
    monotone = options.monotone or curve.shape == "monotone"
    data = (read_function if monotone else read_points)(options.points, options.columns)
    parameters = data.parameters if curve.parameters is None else curve.parameters
    own = curve.fit_options or {}
    given = {name: getattr(options, name) for name in CHECKED}
    asked = {name: own.get(name) if option is None else option for name, option in given.items()}
    report: Any
    try:
        with progress(f"checking {len(data.points):,} points"):
            if monotone:
                tolerance = 1e-9 if asked["tolerance"] is None else asked["tolerance"]
                x, y = data.points.T
                report = shapespline.check_monotone(x, y, curve.curve, tolerance=tolerance)
            else:
                closed, repeated = _closing(options, curve, len(data.points))
                report = _core._check_shape(
                    data.points,
                    curve.curve,
                    parameters,
                    options.boundary or curve.boundary,
                    closed,
                    repeated,
                    asked["criteria"],
                    asked["resolution"],
                    asked["coplanarity"],
                    asked["collinearity"],
                    asked["tolerance"],
                    curve.fit_options is not None,
                    curve.corners if options.corners is None else options.corners,
                    curve.straight,
                )
    except shapespline.InputError as error:
        raise _located(data, curve, options, error) from None
    for note in data.notes:
        print(f"shapespline: {name_of(data.path)}, {note}", file=sys.stderr)
    if options.report:
        text = json.dumps(report.to_dict(), indent=1, allow_nan=False)
        write(options.report, text + "\n")
    print(report)
    return 0 if report.ok else 1


def add_check(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add the command to those of the parser."""
    text = "check whether a curve, whoever made it, keeps the shape of the points it passes through"
    parser = commands.add_parser(
        "check",
        help=text,
        description=text.capitalize() + ".",
        epilog="Exit status: 0 when nothing violates the shape, 1 when something does, "
        "2 for bad input.",
    )
    add_points(parser)
    parser.add_argument(
        "curve",
        type=Path,
        metavar="CURVE.json",
        help="Bézier pieces, a B-spline or a piecewise polynomial; - is standard input",
    )
    parser.add_argument(
        "--monotone",
        action="store_true",
        help="check that a function y(x) rises and falls as its data do (default where CURVE.json "
        "says so)",
    )
    known = ", ".join(_core._NAMES["criteria"])
    parser.add_argument(
        "--criteria",
        type=names,
        metavar="NAME,…",
        help=f"any of {known} (default: those of the fit that made CURVE.json, else all but the "
        "last two)",
    )
    parser.add_argument(
        "--boundary",
        choices=_core._NAMES["boundary"],
        help="what stands in for the missing chords at the ends (default: what CURVE.json says)",
    )
    add_closing(parser, "as CURVE.json has it")
    add_corners(parser, "points at which there are corners", "those of CURVE.json")
    for name, what in (
        ("resolution", "accuracy of the points, in their units"),
        ("coplanarity", "sine of the largest angle between binormal and plane normal"),
        ("collinearity", "sine of the largest angle between tangent and line"),
        ("tolerance", "what counts as zero, and as passing through a point"),
    ):
        default = METHODS["fair"].options[name]
        parser.add_argument(
            f"--{name}", type=real, help=f"{what} (default: that of the fit, else {default:g})"
        )
    parser.add_argument(
        "--report", type=Path, metavar="OUT.json", help="write the whole report to this file"
    )
    parser.set_defaults(run=_run)
