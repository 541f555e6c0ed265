# SPDX-License-Identifier: MIT OR Apache-2.0

"""A sign of life on the terminal while something takes long."""

from __future__ import annotations

import sys
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["progress"]


@contextmanager
def progress(text: str, *, after: float = 0.5, every: float = 0.5) -> Iterator[None]:
    """Say what is going on, and since when, where somebody is looking; it goes when it is done.

    Nothing is written when standard error is no terminal, or the work ends within ``after``
    seconds. The line is written by a thread of its own: long work releases the interpreter lock.
    """
    if not sys.stderr.isatty():
        yield
        return
    done = threading.Event()
    start = time.monotonic()
    shown = 0

    def tell() -> None:
        nonlocal shown
        pause = after
        while not done.wait(pause):
            line = f"{text} … {time.monotonic() - start:.0f} s"
            shown = len(line)
            print(f"\r{line}", end="", file=sys.stderr, flush=True)
            pause = every

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join()
        if shown:
            print(f"\r{' ' * shown}\r", end="", file=sys.stderr, flush=True)
