# SPDX-License-Identifier: MIT OR Apache-2.0

"""Arguments of the command line: how they are read, and the options of ``shapespline fit``."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from shapespline._cli.cells import number
from shapespline._cli.text_io import LONGEST, shortened
from shapespline._core import _NAMES
from shapespline._methods import KINDS, METHODS

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "Parser",
    "add_closing",
    "add_corners",
    "add_fit_options",
    "add_points",
    "names",
    "real",
]


class Parser(argparse.ArgumentParser):
    """A parser that says what is wrong in one line, as all of the command does."""

    def error(self, message: str) -> NoReturn:
        """End the program with exit status 2."""
        print(
            f"{self.prog}: {shortened(message, LONGEST)}; see {self.prog} --help", file=sys.stderr
        )
        sys.exit(2)


# Values. Python's int and float also take 1_0 and the digits of other scripts.


def _wrong(what: str, text: str) -> argparse.ArgumentTypeError:
    return argparse.ArgumentTypeError(f"must be {what}, got '{shortened(text)}'")


def real(text: str) -> float:
    """Return a number."""
    value = number(text)
    if value is None:
        raise _wrong("a number", text)
    return value


def _integer(text: str) -> int:
    if not re.fullmatch("[-+]?[0-9]{1,18}", text):
        raise _wrong("an integer that 64 bits hold", text)
    return int(text)


def names(text: str) -> list[str]:
    """Return names separated by commas."""
    return [name.strip() for name in text.split(",")]


def _vector(text: str) -> list[float]:
    values = [number(part.strip()) for part in text.split(",")]
    found = [value for value in values if value is not None]
    if len(found) < len(values):
        raise _wrong("numbers separated by commas", text)
    return found


def _corners(text: str) -> list[int] | float:
    parts = [part.strip() for part in text.split(",")]
    if all(re.fullmatch("[0-9]{1,15}", part) for part in parts):
        return [int(part) for part in parts]
    return real(text)


def _parameters(text: str) -> str | float:
    value = number(text)
    return text if value is None else value


# Options


def add_points(parser: argparse.ArgumentParser) -> None:
    """Give the parser the file of points, and which of its columns to take."""
    parser.add_argument(
        "points",
        type=Path,
        metavar="POINTS.csv",
        help="one point a line; with a header, columns x, y, perhaps z, and perhaps u, t or time "
        "(parameters); - is standard input",
    )
    parser.add_argument(
        "--columns",
        type=names,
        metavar="NAME,…",
        help="which columns to take, by name or by number from 1",
    )


def add_closing(group: argparse._ActionsContainer, otherwise: str) -> None:
    """Give the group the options of closed data and of repeated points."""
    group.add_argument(
        "--closed",
        action="store_true",
        default=None,
        help=f"the first point is also the last, repeated or not (default: {otherwise})",
    )
    group.add_argument(
        "--repeated",
        choices=_NAMES["repeated"],
        help="what becomes of points that equal the one before them, or are given its parameter: "
        f"refused, or left out (default: {otherwise})",
    )


def add_corners(group: argparse._ActionsContainer, what: str, otherwise: str) -> None:
    """Give the group the option of corners."""
    group.add_argument(
        "--corners",
        type=_corners,
        metavar="I,…",
        help=f"{what}, by index from 0, or as a number with a decimal point the turning angle "
        f"(radians) from which on points are corners (default: {otherwise})",
    )


def _default(option: str, *names: str) -> str:
    """Return the default of an option, of several methods each."""
    values = [{**METHODS, **KINDS}[name].options[option] for name in names]
    shown = [f"{value:g}" if isinstance(value, float) else str(value) for value in values]
    if len(names) > 1:
        shown = [f"{name}: {text}" for name, text in zip(names, shown, strict=True)]
    return f"(default: {'; '.join(shown)})"


def add_fit_options(parser: argparse.ArgumentParser, methods: Iterable[str]) -> None:
    """Give the parser the arguments of ``shapespline fit``."""
    add_points(parser)
    parser.add_argument(
        "--method",
        choices=list(methods),
        default="fair",
        help="curves: fair, nu, tension, catmull-rom; monotone functions y(x): cubic, quintic, "
        "quartic (default: %(default)s)",
    )
    out = parser.add_argument_group("what to write")
    out.add_argument(
        "-o",
        "--out",
        type=Path,
        action="append",
        default=[],
        metavar="OUT",
        help="OUT.csv or .tsv: a table of samples; OUT.json: the curve itself, which "
        "`shapespline check` reads; OUT.svg (in the plane), OUT.step: the same for other programs; "
        "-: samples to standard output. May be given several times",
    )
    out.add_argument(
        "--samples", type=_integer, metavar="N", help="default: 20 a segment, 100,001 at most"
    )
    out.add_argument(
        "--by",
        choices=_NAMES["by"],
        default="parameter",
        help="how samples are spaced (default: %(default)s)",
    )
    out.add_argument("--report", type=Path, metavar="OUT.json", help="the whole report on shape")
    out.add_argument(
        "--plot", type=Path, metavar="OUT.png", help="a figure: .png, .svg or .pdf, by its ending"
    )

    curve = parser.add_argument_group("curves (fair, nu, tension, catmull-rom)")
    curve.add_argument(
        "--parameters",
        type=_parameters,
        metavar="HOW",
        help="chordal, centripetal, uniform or an exponent of the chords' lengths (default: the "
        "column u of the file, else that of the method)",
    )
    curve.add_argument(
        "--boundary",
        choices=_NAMES["boundary"],
        help="end conditions (default: zero-curvature; with --closed, periodic)",
    )
    add_closing(curve, "open, and refused")
    for end in ("start", "end"):
        curve.add_argument(
            f"--{end}-tangent",
            type=_vector,
            metavar="X,Y,Z",
            help=f"tangent at the {end}, which is natural otherwise; write "
            f"--{end}-tangent=-1,0,0 for a negative number",
        )
    curve.add_argument(
        "--criteria", type=names, metavar="NAME,…", help="which criteria to keep and to check"
    )
    for flag, kind, help_text in (
        ("--step", real, "nu, tension: step of the search in strategies nussp, growth, reduction"),
        (
            "--max-iterations",
            _integer,
            "fair, nu, tension: iterations after which the search gives up (exit status 1)",
        ),
        ("--safety", real, "catmull-rom: share of the bounds on its handles that is used"),
        ("--tension", real, "nu, catmull-rom: given tension, no search"),
        ("--tangent-scale", real, "tension: given λ in (0, 1], no search"),
        ("--resolution", real, "accuracy of the points: no more is asked than they can know"),
        ("--coplanarity", real, "sine of the largest angle between binormal and plane normal"),
        ("--collinearity", real, "sine of the largest angle between tangent and line"),
        ("--tolerance", real, "what counts as zero"),
    ):
        curve.add_argument(
            flag, type=kind, metavar="N" if kind is _integer else "X", help=help_text
        )
    curve.add_argument(
        "--strategy",
        choices=_NAMES["strategy"],
        help="nu, tension: how tension is searched for " + _default("strategy", "nu"),
    )
    curve.add_argument(
        "--energy",
        choices=_NAMES["energy"],
        help="what is minimised " + _default("energy", "fair", "quintic"),
    )
    add_corners(curve, "fair: points at which there are corners", "none")
    curve.add_argument(
        "--max-deviation",
        type=real,
        metavar="X",
        help="fair: how far at most the curve lies from the chords, in the units of the points",
    )
    curve.add_argument(
        "--straight",
        action="store_true",
        default=None,
        help="fair: exactly straight along collinear runs of points",
    )
    curve.add_argument(
        "--continuity",
        choices=_NAMES["continuity"],
        help="catmull-rom: one handle scale per point, or two",
    )
    curve.add_argument(
        "--directions",
        choices=_NAMES["directions"],
        help="catmull-rom: tangents of a shape-preserving curve "
        + _default("directions", "catmull-rom"),
    )

    function = parser.add_argument_group("functions (cubic, quintic, quartic)")
    function.add_argument(
        "--convex", choices=["data"], help="cubic: convex and concave where the data are"
    )
    function.add_argument(
        "--ends",
        choices=["estimated", "natural", "periodic"],
        help="cubic: slopes at the ends " + _default("ends", "cubic"),
    )
    function.add_argument(
        "--layer",
        type=real,
        metavar="X",
        help="cubic: share of an interval in which y'' goes to its value at turns and flats "
        + _default("layer", "cubic"),
    )
    function.add_argument(
        "--min-slope",
        type=real,
        metavar="X",
        help="cubic: least slope as a share of the smallest secant nearby "
        + _default("min_slope", "cubic"),
    )
    function.add_argument(
        "--slopes",
        choices=["optimal", "fritsch-butland"],
        help="quintic " + _default("slopes", "quintic"),
    )
    function.add_argument(
        "--shape",
        type=real,
        metavar="X",
        help="quartic: first value of α and β " + _default("shape", "quartic"),
    )
