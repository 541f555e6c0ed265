# SPDX-License-Identifier: MIT OR Apache-2.0

"""What a line of the table is, and how its times are taken."""

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Line:
    """One line of the table."""

    what: str
    ours: str
    theirs: str
    ratio: float | None
    target: str
    met: bool

    def __str__(self) -> str:
        ratio = "" if self.ratio is None else f"{self.ratio:.2f}"
        met = "yes" if self.met else "NO"
        return f"{self.what:<56}{self.ours:>11}{self.theirs:>11}{ratio:>8}  {self.target:<11}{met}"

    def markdown(self) -> str:
        """Return the line as a row of a table in Markdown."""
        ratio = "" if self.ratio is None else f"{self.ratio:.2f}"
        # A number and its unit stay on one line.
        numbers = (cell.replace(" ", "\N{NO-BREAK SPACE}") for cell in (self.ours, self.theirs))
        cells = (self.what, *numbers, ratio, self.target, "yes" if self.met else "no")
        return "| " + " | ".join(cells) + " |"


def seconds(value: float) -> str:
    """Return a time with a unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def best(*calls: Callable[[], object], budget: float = 2.0) -> list[float]:
    """Return the shortest time of each call, measured in turns until the budget is spent.

    The shortest, because everything else that runs on the machine only adds; in turns, because a
    slow spell must not fall on one side alone. Short calls are repeated within a measurement.
    """
    repeats = []
    for call in calls:
        start = time.perf_counter()
        call()
        once = time.perf_counter() - start
        repeats.append(max(1, min(10_000, int(0.005 / max(once, 1e-7)))))
    shortest = [np.inf] * len(calls)
    end = time.perf_counter() + budget * len(calls)
    rounds = 0
    gc.disable()
    try:
        while rounds < 3 or time.perf_counter() < end:
            for i, call in enumerate(calls):
                start = time.perf_counter()
                for _ in range(repeats[i]):
                    call()
                shortest[i] = min(shortest[i], (time.perf_counter() - start) / repeats[i])
            rounds += 1
    finally:
        gc.enable()
    return shortest


def faster(what: str, ours: float, theirs: float, least: float) -> Line:
    """Return the line for a speed-up that must reach ``least``."""
    ratio = theirs / ours
    return Line(what, seconds(ours), seconds(theirs), ratio, f"≥ {least:g}×", ratio >= least)


def within(what: str, ours: float, limit: float) -> Line:
    """Return the line for a time that must stay within a limit."""
    return Line(what, seconds(ours), "", None, f"≤ {seconds(limit)}", ours <= limit)


def at_most(what: str, ours: float, theirs: float, most: float, unit: str = "ν") -> Line:
    """Return the line for a cost, relative to another one, that must not exceed ``most``."""
    ratio = ours / theirs
    return Line(what, seconds(ours), seconds(theirs), ratio, f"≤ {most:g}× {unit}", ratio <= most)
