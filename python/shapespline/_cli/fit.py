# SPDX-License-Identifier: MIT OR Apache-2.0

"""The command ``shapespline fit``: points of a file in; samples, the curve, a report, a figure out.

One family of options for every method: an option that the method does not have is bad input, with
the list of those it has.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from shapespline import (
    ConvergenceError,
    InputError,
    Tangents,
    check_monotone,
    interchange,
)
from shapespline._cli.files import write_curve
from shapespline._cli.options import add_fit_options
from shapespline._cli.progress import progress
from shapespline._cli.tables import read_function, read_points, unit_of, write_table
from shapespline._cli.text_io import (
    STREAM,
    FileError,
    UsageError,
    name_of,
    refuse_overwriting,
    write,
)
from shapespline._methods import CHECKED, KINDS, METHODS

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from numpy.typing import NDArray

    from shapespline._cli.options import Parser
    from shapespline._cli.tables import Points

    Floats = NDArray[np.float64]

__all__ = ["add_fit", "located", "run"]

_CURVE = ("parameters", "boundary", "closed", "repeated", "start_tangent", "end_tangent")
#: What a command line cannot say: arrays, and what is for arrays.
_UNSAID = {
    "fair": ("tangents",),
    "cubic": ("slopes",),
    "quintic": ("clip",),
    "quartic": ("slopes",),
}
#: Options of every method, the default method first.
OPTIONS: dict[str, tuple[str, ...]] = {
    name: (
        *(_CURVE if table is METHODS else ("tolerance",)),
        *(option for option in method.all_options if option not in _UNSAID.get(name, ())),
    )
    for table in (METHODS, KINDS)
    for name, method in table.items()
}
#: Most samples that are written unasked, but for one per point.
MOST_UNASKED = 100_001
#: Most samples that are written at all: a table of about a gigabyte.
MOST_SAMPLES = 10_000_000
_FIGURES = (".png", ".svg", ".pdf")


# Options


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """Return the method's options that the user gave."""
    known = OPTIONS[options.method]
    names = dict.fromkeys(name for has in OPTIONS.values() for name in has)
    given = {name: getattr(options, name) for name in names if getattr(options, name) is not None}
    for name in given:
        if name not in known:
            having = [method for method, has in OPTIONS.items() if name in has]
            raise UsageError(
                f"{_flag(name)} is no option of method {options.method}; "
                f"its options are {', '.join(map(_flag, known))}; "
                f"methods that have it: {', '.join(having)}"
            )
    return given


def _ends(given: dict[str, Any]) -> dict[str, Any]:
    """Return the options with the end tangents, where given, as the boundary."""
    start, end = given.pop("start_tangent", None), given.pop("end_tangent", None)
    if start is None and end is None:
        return given
    if "boundary" in given:
        raise UsageError("--start-tangent and --end-tangent go without --boundary")
    return {**given, "boundary": Tangents(start, end)}


# Fitting


@dataclass(frozen=True)
class _Fit:
    """A curve or a function, and the report on its shape."""

    curve: Any
    report: Any
    #: Why the search ended before the shape was kept.
    failure: str | None = None


def _fit_curve(name: str, data: Points, given: dict[str, Any]) -> _Fit:
    method = METHODS[name]
    given = _ends(dict(given))
    if data.parameters is not None:
        given.setdefault("parameters", data.parameters)
    check = {option: given[option] for option in CHECKED if option in given}
    if any(option in method.given and option not in method.options for option in given):
        # Tension is given: there is no search.
        plain = {option: value for option, value in given.items() if option not in CHECKED}
        for option in plain:
            if option in method.options and option not in method.given:
                raise UsageError(f"{_flag(option)} is for a search, not given tension")
        family: Any = method.family
        curve = family(data.points, **plain)
        return _Fit(curve, curve.check(**check))
    try:
        curve = method.fit(data.points, **given)
    except ConvergenceError as error:
        return _Fit(error.curve, error.report, str(error))
    return _Fit(curve, curve.check(**check))


def _fit_function(name: str, data: Points, given: dict[str, Any]) -> _Fit:
    tolerance = given.pop("tolerance", 1e-9)
    function = KINDS[name].fit(*data.points.T, **given)
    x, y = data.points.T
    report = check_monotone(x, y, function, tolerance=tolerance)
    return _Fit(function, report)


def _is_function(method: str) -> bool:
    return method in KINDS


def located(data: Points, error: InputError) -> Exception:
    """Return the error as one about the file of points, if it is, or else about the arguments."""
    own = ["points", "x", "y", *(["parameters"] if data.parameters is not None else [])]
    if error.argument not in own:
        return UsageError(str(error))
    text = str(error)
    if error.argument == "parameters":
        text += "; --parameters chordal leaves that column out"
    return FileError(data.path, text, data.line(error.index))


# Writing


def _count(points: int, options: argparse.Namespace) -> int:
    """Return how many samples to write, and say so where they are few."""
    fine = 20 * (points - 1) + 1
    count: int = options.samples or max(points, min(fine, MOST_UNASKED))
    if count < points:
        _say(f"{count:,} samples are fewer than the {points:,} points")
    elif count < fine and not options.samples:
        _say(f"{count:,} samples, not 20 per segment, for {points:,} points; see --samples")
    return count


def _say(note: str) -> None:
    print(f"shapespline: {note}", file=sys.stderr)


def _samples(
    fit: _Fit, data: Points, options: argparse.Namespace, count: int
) -> tuple[list[str], Floats]:
    """Return the names and the columns of the table of samples."""
    if _is_function(options.method):
        if options.by != "parameter":
            raise UsageError("--by arc-length is for curves; a function is sampled by its x")
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


def _kind(path: Path) -> str:
    """Return what is to be written to a path, by its ending."""
    if path == STREAM:
        return "stdout"
    if path.suffix.lower() in (".csv", ".tsv", ".txt"):
        return "samples"
    if path.suffix.lower() in (".json", ".svg", ".step", ".stp"):
        return "curve"
    raise UsageError(
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
        text = interchange.svg(curve) if ending == ".svg" else _step(curve, data)
    except InputError as error:
        raise FileError(path, str(error)) from None
    write(path, text)


def _step(curve: Any, data: Points) -> str:
    stem = "points" if data.path == STREAM else data.path.stem
    name = "".join(c if c.isascii() and c.isprintable() else "?" for c in stem)
    # Points without a unit are taken for millimetres, as CAD programs do.
    return interchange.step(curve, name=name, unit=unit_of(data.names[0]) or "mm")


def _title(data: Points) -> str:
    return name_of(data.path) if data.path == STREAM else data.path.name


def _plot(fit: _Fit, data: Points, path: Path) -> None:
    try:
        from shapespline._cli.summary import draw
    except ModuleNotFoundError as error:
        raise UsageError(
            f"figures are drawn with Matplotlib, but {error.name} is not installed; "
            'get it with: pip install "shapespline[plot]"'
        ) from None
    try:
        draw(
            fit.curve,
            fit.report,
            path,
            title=name_of(data.path) if data.path == STREAM else data.path.name,
            names=data.names,
        )
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from None


def _checked(options: argparse.Namespace) -> None:
    """Refuse what can be refused before the file is read."""
    if options.plot and options.plot.suffix.lower() not in _FIGURES:
        raise UsageError(f"{options.plot}: the ending must be one of {', '.join(_FIGURES)}")
    if options.samples is not None and not 2 <= options.samples <= MOST_SAMPLES:
        most = f"{MOST_SAMPLES:,}"
        raise UsageError(f"--samples must be at least 2 and at most {most}, got {options.samples}")
    outputs = [*options.out, *(path for path in (options.report, options.plot) if path)]
    refuse_overwriting([options.points], outputs)


def _write_outputs(fit: _Fit, data: Points, options: argparse.Namespace, kinds: list[str]) -> None:
    """Write samples and curves."""
    if set(kinds) - {"curve"}:
        with progress("sampling"):
            names, columns = _samples(fit, data, options, _count(len(data.points), options))
    for path, kind in zip(options.out, kinds, strict=True):
        with progress(f"writing {path.name}"):
            if kind == "curve":
                _write_curve(path, fit.curve, data)
                continue
            text = write_table(names, columns, "\t" if path.suffix.lower() == ".tsv" else ",")
            if kind == "stdout":
                sys.stdout.write(text)
            else:
                write(path, text)


def run(options: argparse.Namespace) -> int:
    """Fit, write what was asked for, print the report; return the exit status."""
    given = _given(options)
    kinds = [_kind(path) for path in options.out]
    _checked(options)
    function = _is_function(options.method)
    with progress(f"reading {name_of(options.points)}"):
        data = (read_function if function else read_points)(options.points, options.columns)
    fitted = _fit_function if function else _fit_curve
    if function and data.points.shape[1] != 2:
        raise UsageError(f"a function has two columns, got {data.points.shape[1]}")
    try:
        with progress(f"fitting {len(data.points):,} points"):
            fit = fitted(options.method, data, given)
    except InputError as error:
        raise located(data, error) from None

    for note in data.notes:
        _say(f"{name_of(data.path)}, {note}")
    _write_outputs(fit, data, options, kinds)
    if options.report:
        plain = json.dumps(fit.report.to_dict(), indent=1, allow_nan=False)
        write(options.report, plain + "\n")
    if options.plot:
        with progress(f"drawing {options.plot.name}"):
            _plot(fit, data, options.plot)
    # The table belongs to whoever reads standard output; the report then goes beside it.
    print(fit.report, file=sys.stderr if "stdout" in kinds else sys.stdout)
    if fit.failure:
        _say(fit.failure)
    return 0 if fit.report.ok else 1


def add_fit(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add the command to those of the parser."""
    text = "fit a curve or a monotone function that keeps the shape of points in a file"
    parser = commands.add_parser(
        "fit",
        help=text,
        description=text.capitalize() + ".",
        epilog="Exit status: 0 when the shape is kept, 1 when it is not, 2 for bad input. Formats "
        "of the files: the page Files of the documentation.",
    )
    add_fit_options(parser, OPTIONS)
    parser.set_defaults(run=run)
