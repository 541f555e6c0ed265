# SPDX-License-Identifier: MIT OR Apache-2.0

"""Lines, cells and numbers of text tables, as people and their programs write them."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shapespline._cli.text_io import FileError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["Lines", "name_and_unit", "number", "plain", "read_lines", "records", "split", "value"]

COMMENTS = ("#", "%", "//")
#: What may separate cells, the first that is in a line; `None` is any number of blanks.
SEPARATORS = ("\t", ";", ",", None)

_FORTRAN = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)[dD][-+]?[0-9]+")
_DECIMAL_COMMA = re.compile(r"[-+]?[0-9]+,[0-9]+(?:[eE][-+]?[0-9]+)?")
#: 1,234: with commas between cells nobody can tell a decimal comma from one of thousands.
_EITHER = re.compile(r"[-+]?[1-9][0-9]{0,2},[0-9]{3}")
_BLANKS = " '’\u00a0\u2009\u202f"
#: 1 234,5 and 1'234.5: groups of three between blanks of any width, or apostrophes.
_GROUPED = re.compile(rf"[-+]?[0-9]{{1,3}}(?:[{_BLANKS}][0-9]{{3}})+(?:[.,][0-9]*)?")


# Numbers


def plain(cell: str) -> float | None:
    """Return the number that a cell holds as C and Python print it; else None."""
    try:
        number = float(cell)
    except ValueError:
        return None
    # Python also takes 1_0, and the digits of other scripts.
    return number if cell.isascii() and "_" not in cell else None


def number(cell: str) -> float | None:
    """Return the number that a cell holds as C, Python or Fortran print it; else None."""
    found = plain(cell)
    if found is None:
        cell = cell.replace("\u2212", "-")
        found = plain(re.sub("[dD]", "e", cell) if _FORTRAN.fullmatch(cell) else cell)
    return found


def value(cell: str, separator: str | None) -> float | None:
    """Return the number of a cell, which may have a decimal comma and groups of thousands."""
    found = number(cell)
    if found is not None:
        return found
    # "0,500 1,250": between commas a blank stands for anything but thousands.
    if _GROUPED.fullmatch(cell) and (separator != "," or " " not in cell):
        cell = re.sub(f"[{_BLANKS}]", "", cell)
    if _DECIMAL_COMMA.fullmatch(cell) and not (separator == "," and _EITHER.fullmatch(cell)):
        cell = cell.replace(",", ".")
    return number(cell)


# Cells


def name_and_unit(name: str) -> tuple[str, str]:
    """Return a column's name in small letters, and its unit: 'X [mm]', 'x (mm)', 'x/mm'."""
    at = min((name.index(mark) for mark in "[(/" if mark in name), default=len(name))
    return name[:at].strip().lower(), name[at:].strip("[]()/ ").lower()


def _words(line: str) -> list[str]:
    """Return what blanks separate; a unit in brackets belongs to the name before it."""
    if '"' in line:
        words = [word.strip('"') for word in re.findall(r'"[^"]*"|\S+', line)]
    else:
        # Wider blanks are within numbers.
        words = line.split() if line.isascii() else re.split(r"[ \t\f\v]+", line.strip())
    if "[" not in line and "(" not in line:
        return [word.strip("'") for word in words]
    joined: list[str] = []
    for word in words:
        if word[:1] in ("[", "(") and joined and joined[-1][-1:] not in ("]", ")"):
            joined[-1] += word
        else:
            joined.append(word)
    return joined


def split(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, without blanks and quotes around them."""
    if separator is None:
        return _words(line)
    if '"' in line:
        try:
            return _stripped(next(csv.reader([line], delimiter=separator, skipinitialspace=True)))
        except csv.Error:
            pass
    return _stripped(line.split(separator))


def _stripped(cells: list[str]) -> list[str]:
    return [cell.strip().strip("'") for cell in cells]


def _separator(line: str) -> str | None:
    """Return what separates the cells of a line."""
    line = line.strip()
    first = next(s for s in SEPARATORS if s is None or s in line)
    if first == ",":
        # "0,5 1,5": decimal commas, blanks between.
        words = line.split()
        if len(words) > 1 and all(value(word, None) is not None for word in words):
            return None
    return first


def is_data(cells: list[str], separator: str | None) -> bool:
    """Whether cells are a row of numbers, perhaps with a name or a date among them."""
    numbers = sum(value(cell, separator) is not None for cell in cells)
    return numbers >= 2 or 0 < numbers == len(cells)


# Lines


@dataclass
class Lines:
    """The lines of a file that are neither empty nor comments."""

    #: Number and text of each, and whether an empty line stands before it.
    content: list[tuple[int, str, bool]] = field(default_factory=list)
    comments: list[tuple[int, str]] = field(default_factory=list)
    separator: str | None = None


def read_lines(text: str) -> Lines:
    """Tell lines of numbers from comments, and find what separates their cells."""
    lines = Lines()
    after_blank, declared = False, None
    for at, raw in enumerate(io.StringIO(text, newline=None), start=1):
        bare = raw.strip()
        if not bare:
            after_blank = True
        elif bare.startswith(COMMENTS):
            lines.comments.append((at, bare.lstrip("#%/ \t")))
        elif not lines.content and (found := re.fullmatch('"?sep=([;,|:])"?', bare)):
            # Excel's word on what separates cells.
            declared = found[1]
        else:
            # Tabs at the ends are of empty cells.
            lines.content.append((at, raw.strip(" \n"), after_blank))
            after_blank = False
    if declared is not None:
        lines.separator = declared
    elif lines.content:
        candidates = ((line, _separator(line)) for _, line, _ in lines.content)
        found_data = (s for line, s in candidates if is_data(split(line, s), s))
        first = lines.content[0][1]
        lines.separator = next(found_data, _separator(first))
    return lines


def records(path: Path, lines: Lines) -> Iterator[tuple[int, bool, list[str]]]:
    """Yield the number, whether an empty line is before it, and the cells of each row."""
    content, separator = lines.content, lines.separator
    if separator is None:
        for at, line, after_blank in content:
            yield at, after_blank, _words(line)
        return
    consumed = 0

    def feed() -> Iterator[str]:
        nonlocal consumed
        for _, line, _ in content:
            consumed += 1
            yield re.sub(r'" +(?=[;,\t]|$)', '"', line) if '"' in line else line

    reader = csv.reader(feed(), delimiter=separator, skipinitialspace=True, strict=True)
    while consumed < len(content):
        at, _, after_blank = content[consumed]
        try:
            cells = next(reader)
        except csv.Error as error:
            raise FileError(path, f"quotes that do not end: {error}", at) from None
        yield at, after_blank, _stripped(cells)
