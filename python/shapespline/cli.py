"""The command ``shapespline``.

One function a command, each with a parser of its own: a new command is one more `_add_…`.
Exit status: 0 when done, 1 when the shape does not hold, 2 for bad input (one line on stderr).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import shapespline

if TYPE_CHECKING:
    from collections.abc import Sequence


class InputError(Exception):
    """What the user gave cannot be used; the message is one line."""


def _demo(options: argparse.Namespace) -> int:
    try:
        from shapespline import _demo
    except ModuleNotFoundError as error:
        raise InputError(
            f"the demo draws with Matplotlib, but {error.name} is not installed; "
            'get it with: pip install "shapespline[plot]"'
        ) from None
    out: Path = options.out
    try:
        out.mkdir(parents=True, exist_ok=True)
        return _demo.run(out)
    except OSError as error:
        raise InputError(f"cannot write to {error.filename or out}: {error.strerror}") from None


def _add_demo(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    text = "fit real data, print what was wrong and what was mended, draw figures"
    parser = commands.add_parser("demo", help=text, description=text.capitalize() + ".")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("shapespline-demo"),
        metavar="DIR",
        help="directory for the figures, made where missing (default: %(default)s)",
    )
    parser.set_defaults(run=_demo)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="shapespline", description="Splines that interpolate data and keep its shape."
    )
    parser.add_argument(
        "--version", action="version", version=f"%(prog)s {shapespline.__version__}"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_demo(commands)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    options = _parser().parse_args(arguments)
    try:
        status: int = options.run(options)
    except InputError as error:
        print(f"shapespline: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("shapespline: interrupted", file=sys.stderr)
        return 130
    return status


if __name__ == "__main__":
    sys.exit(main())
