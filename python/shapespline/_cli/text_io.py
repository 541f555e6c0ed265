# SPDX-License-Identifier: MIT OR Apache-2.0

"""Files in and out of the command line; everything that is wrong with one is one line of text."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "FileError",
    "UsageError",
    "name_of",
    "refuse_overwriting",
    "shortened",
    "text_of",
    "write",
]

#: Standard input as a path to read, standard output as one to write.
STREAM = Path("-")
#: Longest message: a line that is itself megabytes long is not repeated.
LONGEST = 400


def shortened(text: str, longest: int = 40) -> str:
    """Return a text for a message: one line of printable characters, not too long."""
    if len(text) > longest:
        text = text[: longest - 1] + "…"
    return "".join(c if c.isprintable() else "�" for c in text)


def name_of(path: Path) -> str:
    """Return what a message calls a file that is read."""
    return "standard input" if path == STREAM else str(path)


class UsageError(Exception):
    """The arguments of a command cannot be used; the message is one line."""

    def __init__(self, what: str) -> None:
        super().__init__(shortened(what, LONGEST))


class FileError(Exception):
    """A file cannot be used; the message is one line with the file and, where known, the line."""

    def __init__(self, path: Path, what: str, line: int | None = None) -> None:
        where = f"{name_of(path)}, line {line}" if line else name_of(path)
        super().__init__(f"{shortened(where, 5000)}: {shortened(what, LONGEST)}")


def _bytes_of(path: Path) -> bytes:
    try:
        return sys.stdin.buffer.read() if path == STREAM else path.read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        # A path with a null character.
        raise FileError(path, f"cannot be read: {error}") from None


def text_of(path: Path) -> str:
    """Return the text of a file or of standard input, without a byte order mark.

    Text is UTF-8; UTF-16 with a byte order mark and the 8-bit Windows-1252, as spreadsheets on
    Windows write them, are read too.
    """
    data = _bytes_of(path)
    wide = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    try:
        return data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as error:
        if not wide and not any(c < 32 and c not in b"\t\n\f\r" for c in data):
            try:
                return data.decode("cp1252")
            except UnicodeDecodeError:
                pass
        line = None if wide else data.count(b"\n", 0, error.start) + 1
        raise FileError(path, f"is not text in UTF-{16 if wide else 8}", line) from None


def write(path: Path, text: str) -> None:
    """Write a text to a file, in UTF-8."""
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from None
    except ValueError as error:
        raise FileError(path, f"cannot be written: {error}") from None


def _is_same(a: Path, b: Path) -> bool:
    try:
        return a.samefile(b)
    except (OSError, ValueError):
        # One of them is not there yet, or cannot be.
        return _resolved(a) == _resolved(b)


def _resolved(path: Path) -> str:
    try:
        return os.path.realpath(path)
    except (OSError, ValueError):
        return str(path)


def _is_special(path: Path) -> bool:
    """Whether a path is no regular file, such as /dev/null: it may be written often."""
    try:
        return path.exists() and not path.is_file()
    except (OSError, ValueError):
        return False


def refuse_overwriting(inputs: Iterable[Path], outputs: Iterable[Path]) -> None:
    """Raise `UsageError` where an output would replace an input or another output."""
    read = [path for path in inputs if path != STREAM]
    written: list[Path] = []
    for path in outputs:
        if path != STREAM and any(_is_same(path, other) for other in read):
            raise UsageError(f"{path}: is read by this command and must not be overwritten")
        if path != STREAM and _is_special(path):
            continue
        if any(_is_same(path, other) for other in written):
            raise UsageError(f"{path}: must not be written twice")
        written.append(path)
