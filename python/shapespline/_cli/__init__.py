# SPDX-License-Identifier: MIT OR Apache-2.0

"""The command ``shapespline``.

One module per command, each with a parser of its own: a new command is one more `add_…`. Nothing
outside this package knows it.

Exit status: 0 when done, 1 when the shape does not hold, 2 for bad input (one line on stderr), and
70 for a fault of the program itself.
"""

from __future__ import annotations

import os
import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

import shapespline
from shapespline._cli.check import add_check
from shapespline._cli.fit import add_fit
from shapespline._cli.options import Parser
from shapespline._cli.text_io import FileError, UsageError, shortened

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

__all__ = ["main"]


def _demo(options: argparse.Namespace) -> int:
    try:
        from shapespline._cli import demo
    except ModuleNotFoundError as error:
        raise UsageError(
            f"the demo draws with Matplotlib, but {error.name} is not installed; "
            'get it with: pip install "shapespline[plot]"'
        ) from None
    out: Path = options.out
    try:
        out.mkdir(parents=True, exist_ok=True)
        return demo.run(out)
    except OSError as error:
        raise UsageError(f"cannot write to {error.filename or out}: {error.strerror}") from None


def _add_demo(commands: argparse._SubParsersAction[Parser]) -> None:
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


def _parser() -> Parser:
    parser = Parser(
        prog="shapespline", description="Splines that interpolate data and keep its shape."
    )
    parser.add_argument(
        "--version", action="version", version=f"%(prog)s {shapespline.__version__}"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_demo(commands)
    add_fit(commands)
    add_check(commands)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    options = _parser().parse_args(arguments)
    try:
        status: int = options.run(options)
        sys.stdout.flush()
    except (UsageError, FileError) as error:
        print(f"shapespline: {error}", file=sys.stderr)
        return 2
    except MemoryError as error:
        why = f": {shortened(str(error), 200)}" if str(error) else ""
        print(f"shapespline: the memory does not suffice{why}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("shapespline: interrupted", file=sys.stderr)
        return 130
    except OSError as error:
        # Files have errors of their own: this is standard output. Python would complain once more
        # when it closes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            return 141  # whoever read the output has seen enough (`| head`)
        print(f"shapespline: standard output: cannot be written: {error.strerror}", file=sys.stderr)
        return 2
    except Exception:
        # A fault of the program: not exit status 1, which says that the shape does not hold.
        traceback.print_exc()
        return 70
    return status
