# SPDX-License-Identifier: MIT OR Apache-2.0

"""Copy the docstrings of the built extension into its stub: python .ci/stub.py."""

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path
from textwrap import indent
from typing import Any

from shapespline import _core

STUB = Path(__file__).parent.parent / "python" / "shapespline" / "_core.pyi"
Definition = ast.ClassDef | ast.FunctionDef


def documented(stub: str) -> str:
    """Return the stub with the docstrings of the extension, and no others."""
    lines = stub.splitlines()
    # From the end, so that the numbers of the lines above stay true.
    for node, docstring in reversed(list(_definitions(ast.parse(stub), _core))):
        first, head = node.body[0], node.lineno
        if ast.get_docstring(node) is not None:
            del lines[first.lineno - 1 : first.end_lineno]
        if isinstance(node, ast.FunctionDef):
            # The docstring is all of the body; a comment may follow the signature.
            head, end = node.returns.end_lineno, node.returns.end_col_offset
            line = lines[head - 1]
            comment = line[end:].removeprefix(":").removeprefix(" ...")
            lines[head - 1] = f"{line[:end]}:{'' if docstring else ' ...'}{comment}"
        lines[head:head] = indent(docstring, " " * (node.col_offset + 4)).splitlines()
    return "\n".join(lines) + "\n"


def _definitions(node: ast.Module | ast.ClassDef, owner: Any) -> Iterator[tuple[Definition, str]]:
    """Yield what the extension has, from above, each with its docstring as source text.

    Of overloads the first has it. Special methods but calls are Python's own, and have none.
    """
    seen = set()
    for child in node.body:
        if not isinstance(child, Definition) or child.name not in vars(owner):
            continue
        value = vars(owner)[child.name]
        special = child.name.startswith("__") and child.name != "__call__"
        known = special or child.name in seen or not value.__doc__
        yield child, "" if known else _quoted(inspect.cleandoc(value.__doc__))
        seen.add(child.name)
        if isinstance(child, ast.ClassDef):
            yield from _definitions(child, value)


def _quoted(text: str) -> str:
    raw = "r" if "\\" in text else ""
    end = "\n" if "\n" in text else ""
    return f'{raw}"""{text}{end}"""'


if __name__ == "__main__":
    STUB.write_text(documented(STUB.read_text(encoding="utf-8")), encoding="utf-8")
