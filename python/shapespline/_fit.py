"""The command ``shapespline fit``: points of a file in; samples, the curve, a report, a figure out.

One family of options for every method: an option that the method does not have is bad input, with
the list of those it has.
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline import (
    CatmullRom,
    ConvergenceError,
    MonotoneQuartic,
    MonotoneQuintic,
    NuSpline,
    Tangents,
    TensionSpline,
    interchange,
)
from shapespline._convert import piecewise
from shapespline._files import write_curve
from shapespline._monotone_check import check_monotone
from shapespline._progress import progress
from shapespline._tables import FileError, read_function, read_points, write_table

if TYPE_CHECKING:
    import argparse

    from numpy.typing import NDArray

    from shapespline._tables import Points

    Floats = NDArray[np.float64]

__all__ = ["METHODS", "InputError", "add_options", "run"]

_CHECK = ("criteria", "coplanarity", "collinearity", "tolerance")
_CURVE = ("parameters", "boundary", "start_tangent", "end_tangent", *_CHECK)
_SEARCH = ("strategy", "step", "max_iterations")
#: name → class, and the options that the method has.
METHODS: dict[str, tuple[Any, tuple[str, ...]]] = {
    "nu": (NuSpline, (*_CURVE, *_SEARCH, "tension")),
    "tension": (TensionSpline, (*_CURVE, *_SEARCH, "tangent_scale")),
    "catmull-rom": (CatmullRom, (*_CURVE, "safety", "continuity", "tension")),
    "quartic": (MonotoneQuartic, ("shape", "tolerance")),
    "quintic": (MonotoneQuintic, ("slopes", "fairness", "tolerance")),
}
#: Names of given tension: with one of them there is no search.
_GIVEN = ("tension", "tangent_scale")
#: Most samples that are written unasked, but for one a point.
MOST_SAMPLES = 100_001
_FIGURES = (".png", ".svg", ".pdf")


class InputError(Exception):
    """What the user gave cannot be used; the message is one line."""


# Options


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _vector(text: str) -> list[float]:
    return [float(part) for part in text.split(",")]


def _parameters(text: str) -> str | float:
    try:
        return float(text)
    except ValueError:
        return text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Give the parser the arguments of the command."""
    parser.add_argument(
        "points",
        type=Path,
        metavar="POINTS.csv",
        help="one point a line; with a header, columns x, y, perhaps z, and perhaps u (parameters)",
    )
    parser.add_argument(
        "--method",
        choices=list(METHODS),
        default="nu",
        help="curves: nu, tension, catmull-rom; monotone functions y(x): quartic, quintic "
        "(default: %(default)s)",
    )
    parser.add_argument(
        "--columns",
        type=_names,
        metavar="NAME,…",
        help="which columns to take, by name or by number from 1",
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
        "--samples", type=int, metavar="N", help="default: 20 a segment, 100,001 at most"
    )
    out.add_argument(
        "--by",
        choices=["parameter", "arc-length"],
        default="parameter",
        help="how samples are spaced (default: %(default)s)",
    )
    out.add_argument("--report", type=Path, metavar="OUT.json", help="the whole report on shape")
    out.add_argument(
        "--plot", type=Path, metavar="OUT.png", help="a figure: .png, .svg or .pdf, by its ending"
    )

    curve = parser.add_argument_group("curves (nu, tension, catmull-rom)")
    curve.add_argument(
        "--parameters",
        type=_parameters,
        metavar="HOW",
        help="chordal, centripetal, uniform or an exponent of the chords' lengths (default: the "
        "column u of the file, else that of the method)",
    )
    curve.add_argument(
        "--boundary",
        choices=["zero-curvature", "natural", "periodic", "circular"],
        help="end conditions (default: zero-curvature)",
    )
    for end in ("start", "end"):
        curve.add_argument(
            f"--{end}-tangent",
            type=_vector,
            metavar="X,Y,Z",
            help=f"tangent at the {end}; write --{end}-tangent=-1,0,0 for a negative number",
        )
    curve.add_argument(
        "--criteria", type=_names, metavar="NAME,…", help="which criteria to keep and to check"
    )
    for flag, kind, help_text in (
        ("--step", float, "step of the tension in strategies nussp, growth and reduction"),
        ("--max-iterations", int, "rounds after which the search gives up (exit status 1)"),
        ("--safety", float, "catmull-rom: share of the bounds on its handles that is used"),
        ("--tension", float, "nu, catmull-rom: given tension, no search"),
        ("--tangent-scale", float, "tension: given λ in (0, 1], no search"),
        ("--coplanarity", float, "sine of the largest angle between binormal and plane normal"),
        ("--collinearity", float, "sine of the largest angle between tangent and line"),
        ("--tolerance", float, "what counts as zero"),
    ):
        curve.add_argument(flag, type=kind, metavar="N" if kind is int else "X", help=help_text)
    curve.add_argument(
        "--strategy",
        choices=["fairest", "growth", "reduction", "nussp"],
        help="how tension is searched for (default: fairest)",
    )
    curve.add_argument(
        "--continuity", choices=["C1", "G1"], help="catmull-rom: one handle a point, or two"
    )

    function = parser.add_argument_group("functions (quartic, quintic)")
    function.add_argument(
        "--slopes", choices=["optimal", "fritsch-butland"], help="quintic (default: optimal)"
    )
    function.add_argument(
        "--fairness",
        choices=["bending", "parametric"],
        help="quintic: the energy that is least (default: bending)",
    )
    function.add_argument(
        "--shape", type=float, metavar="X", help="quartic: first value of α and β (default: 3)"
    )


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """Return the method's options that the user gave."""
    _, known = METHODS[options.method]
    names = dict.fromkeys(name for _, has in METHODS.values() for name in has)
    given = {name: getattr(options, name) for name in names if getattr(options, name) is not None}
    for name in given:
        if name not in known:
            flags = ", ".join(f"--{option.replace('_', '-')}" for option in known)
            raise InputError(
                f"--{name.replace('_', '-')} is no option of method {options.method}; "
                f"its options are {flags}"
            )
    return given


def _ends(given: dict[str, Any]) -> dict[str, Any]:
    """Return the options with the end tangents, where given, as the boundary."""
    start, end = given.pop("start_tangent", None), given.pop("end_tangent", None)
    if start is None and end is None:
        return given
    if start is None or end is None or "boundary" in given:
        raise InputError("--start-tangent and --end-tangent go together, and without --boundary")
    return {**given, "boundary": Tangents(start, end)}


# Fitting


@dataclass(frozen=True)
class _Fit:
    """A curve or a function, and the report on its shape."""

    curve: Any
    report: Any
    #: Why the search ended before the shape was kept.
    failure: str | None = None


def _fit_curve(method: str, data: Points, given: dict[str, Any]) -> _Fit:
    family, _ = METHODS[method]
    given = _ends(dict(given))
    if data.parameters is not None:
        given.setdefault("parameters", data.parameters)
    check = {name: given[name] for name in _CHECK if name in given}
    if any(name in given for name in _GIVEN):
        plain = {name: value for name, value in given.items() if name not in _CHECK}
        for name in (*_SEARCH, "safety"):
            if name in plain:
                raise InputError(f"--{name.replace('_', '-')} is for a search, not given tension")
        curve = family(data.points, **plain)
        return _Fit(curve, curve.check(**check))
    try:
        curve = family.shape_preserving(data.points, **given)
    except ConvergenceError as error:
        return _Fit(error.curve, error.report, str(error))
    return _Fit(curve, curve.check(**check))


def _fit_function(method: str, data: Points, given: dict[str, Any]) -> _Fit:
    family, _ = METHODS[method]
    tolerance = given.pop("tolerance", 1e-9)
    function = family(*data.points.T, **given)
    report = check_monotone(data.points, piecewise(function), tolerance=tolerance)
    return _Fit(function, report)


def _is_function(method: str) -> bool:
    return method in ("quartic", "quintic")


def _located(data: Points, options: argparse.Namespace, error: Exception) -> Exception:
    """Return the error as one about a line of the file, or else about the arguments."""
    text = str(error)
    names = ("x", "y") if _is_function(options.method) else ("points", "parameters")
    if line := data.locate(text, names):
        return FileError(data.path, text, line)
    # What is left is about the whole of the points, or about an option.
    about_points = text.startswith(("points", "x ", "y ", "there are"))
    return FileError(data.path, text) if about_points else InputError(text)


# Writing


def _samples(fit: _Fit, data: Points, options: argparse.Namespace) -> tuple[list[str], Floats]:
    """Return the names and the columns of the table of samples."""
    n = len(data.points)
    count = options.samples or max(n, min(20 * (n - 1) + 1, MOST_SAMPLES))
    if _is_function(options.method):
        if options.by != "parameter":
            raise InputError("--by arc-length is for curves; a function is sampled by its x")
        x = np.linspace(data.points[0, 0], data.points[-1, 0], count)
        return data.names, np.column_stack([x, fit.curve(x)])
    names = list(data.names)
    if all(name.isdigit() for name in names):
        names = list("xyz"[: len(names)])
    if options.by == "arc-length":
        return names, fit.curve.sample(count, by="arc-length")
    first, last = fit.curve.parameters[[0, -1]]
    u = np.linspace(first, last, count)
    return ["u", *names], np.column_stack([u, fit.curve(u)])


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from None


def _kind(path: Path) -> str:
    """Return what is to be written to a path, by its ending."""
    if str(path) == "-":
        return "stdout"
    if path.suffix.lower() in (".csv", ".tsv", ".txt"):
        return "samples"
    if path.suffix.lower() in (".json", ".svg", ".step", ".stp"):
        return "curve"
    raise InputError(
        f"{path}: the ending must be .csv, .tsv or .txt (samples), or .json, .svg or .step (the "
        "curve)"
    )


def _write_curve(path: Path, curve: Any, data: Points) -> None:
    """Write the curve itself, in the form that the ending says."""
    ending = path.suffix.lower()
    if ending == ".json":
        write_curve(path, curve)
        return
    try:
        if ending == ".svg":
            text = interchange.svg(curve)
        else:
            # The unit of the first column, where STEP knows it.
            unit = re.search(r"[\[(/ ](m|mm|cm|km|µm)[\])]?$", data.names[0])
            text = interchange.step(
                curve,
                name=data.path.stem.encode("ascii", "replace").decode(),
                unit=unit.group(1) if unit else "mm",
            )
    except ValueError as error:
        raise FileError(path, str(error)) from None
    _write(path, text)


def _plot(fit: _Fit, data: Points, path: Path) -> None:
    try:
        from shapespline._summary import draw
    except ModuleNotFoundError as error:
        raise InputError(
            f"figures are drawn with Matplotlib, but {error.name} is not installed; "
            'get it with: pip install "shapespline[plot]"'
        ) from None
    try:
        draw(fit.curve, fit.report, path, title=data.path.name, names=data.names)
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from None


def run(options: argparse.Namespace) -> int:
    """Fit, write what was asked for, print the report; return the exit status."""
    given = _given(options)
    kinds = [_kind(path) for path in options.out]
    if options.plot and options.plot.suffix.lower() not in _FIGURES:
        raise InputError(f"{options.plot}: the ending must be one of {', '.join(_FIGURES)}")
    if options.samples is not None and options.samples < 2:
        raise InputError(f"--samples must be at least 2, got {options.samples}")
    function = _is_function(options.method)
    with progress(f"reading {options.points.name}"):
        data = (read_function if function else read_points)(options.points, options.columns)
    fitted = _fit_function if function else _fit_curve
    if function and data.points.shape[1] != 2:
        raise InputError(f"a function has two columns, got {data.points.shape[1]}")
    try:
        with progress(f"fitting {len(data.points):,} points"):
            fit = fitted(options.method, data, given)
    except (ValueError, TypeError) as error:
        raise _located(data, options, error) from None

    to_stdout = "stdout" in kinds
    for path, kind in zip(options.out, kinds, strict=True):
        if kind == "curve":
            with progress(f"writing {path.name}"):
                _write_curve(path, fit.curve, data)
            continue
        with progress(f"writing {path.name}"):
            names, columns = _samples(fit, data, options)
            text = write_table(names, columns, "\t" if path.suffix.lower() == ".tsv" else ",")
        if kind == "stdout":
            sys.stdout.write(text)
        else:
            _write(path, text)
    if options.report:
        plain = json.dumps(fit.report.to_dict(), indent=1, allow_nan=False)
        _write(options.report, plain + "\n")
    if options.plot:
        with progress(f"drawing {options.plot.name}"):
            _plot(fit, data, options.plot)
    # The table belongs to whoever reads standard output; the report then goes beside it.
    print(fit.report, file=sys.stderr if to_stdout else sys.stdout)
    if fit.failure:
        print(f"shapespline: {fit.failure}", file=sys.stderr)
    return 0 if fit.report.ok else 1
