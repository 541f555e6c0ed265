# SPDX-License-Identifier: MIT OR Apache-2.0

"""Time SciPy's PCHIP in the units of shapespline-monotone's example `speed_of_monotone`."""

import time
from collections.abc import Callable

import numpy as np
from scipy.interpolate import PchipInterpolator


def best(run: Callable[[], object], least: float = 0.4) -> float:
    """Return the seconds of the fastest run among those that fit in some time."""
    start, fastest = time.perf_counter(), float("inf")
    while time.perf_counter() - start < least:
        before = time.perf_counter()
        run()
        fastest = min(fastest, time.perf_counter() - before)
    return fastest


def line(count: int, rng: np.random.Generator) -> str:
    """Measure building and evaluating a function of some points."""
    x, y = np.cumsum(0.1 + rng.random(count)), np.cumsum(rng.random(count))
    text = (
        f"{count:>8} build {best(lambda: PchipInterpolator(x, y)) / count * 1e9:10.1f} ns a point"
    )
    if count >= 1000:
        f, queries = PchipInterpolator(x, y), rng.uniform(x[0], x[-1], 1_000_000)
        ordered = np.sort(queries)
        text += f", unsorted {best(lambda: f(queries)) * 1e3:6.1f}"
        text += f", sorted {best(lambda: f(ordered)) * 1e3:6.1f} ns a query"
    return text


if __name__ == "__main__":
    generator = np.random.default_rng(1)
    for size in (5, 20, 1000, 10_000, 1_000_000):
        print(line(size, generator))
