"""SciPy's PchipInterpolator in the units of `examples/speed.rs` (best of several runs)."""

import time

import numpy as np
from scipy.interpolate import PchipInterpolator


def best(run, least=0.4):
    start, out = time.perf_counter(), float("inf")
    while time.perf_counter() - start < least:
        t = time.perf_counter()
        run()
        out = min(out, time.perf_counter() - t)
    return out


rng = np.random.default_rng(1)
for n in (5, 20, 1000, 10_000, 1_000_000):
    x, y = np.cumsum(0.1 + rng.random(n)), np.cumsum(rng.random(n))
    line = f"{n:>8} build {best(lambda: PchipInterpolator(x, y)) / n * 1e9:10.1f} ns a point"
    if n >= 1000:
        f, q = PchipInterpolator(x, y), rng.uniform(x[0], x[-1], 1_000_000)
        line += f", unsorted {best(lambda: f(q)) * 1e3:6.1f}"
        q.sort()
        line += f", sorted {best(lambda: f(q)) * 1e3:6.1f} ns a query"
    print(line)
