# SPDX-License-Identifier: MIT OR Apache-2.0

"""Pickles with a checksum for the classes that are written in Python; the others have their own."""

from __future__ import annotations

import pickle
import zlib
from typing import Any

from shapespline._core import InputError

__all__ = ["sealed"]


def sealed(cls: type, *arguments: Any) -> tuple[Any, tuple[str, bytes, int]]:
    """Return what ``__reduce__`` returns for an object that ``cls(*arguments)`` makes again."""
    data = pickle.dumps((cls, arguments), protocol=4)
    return _opened, (cls.__name__, data, zlib.crc32(data))


def _opened(name: str, data: bytes, checksum: int) -> Any:
    """Make the object of a pickle that is whole."""
    if zlib.crc32(data) != checksum:
        raise InputError(
            f"the pickle of {name} is damaged: its checksum does not match its {len(data)} bytes",
            "data",
        )
    cls, arguments = pickle.loads(data)
    return cls(*arguments)
