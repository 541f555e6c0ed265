# SPDX-License-Identifier: MIT OR Apache-2.0

"""Make the tables of python/docs/functions-compared.md: every class beside SciPy's interpolants.

Run from the root of the repository; a test holds the page against it, but for the times:

    python python/docs/scripts/functions_table.py
"""

import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
from scipy.interpolate import Akima1DInterpolator, CubicSpline, PchipInterpolator, PPoly

import shapespline as ss

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests"))
import polygons

Array = np.ndarray
Maker = Callable[[Array, Array], PPoly | ss.MonotoneSpline]

PAGE = ROOT / "python" / "docs" / "functions-compared.md"
SHAPE = ("data", "function", "energy", "overshoot", "convex segments broken", "more inflections")
RATES = (
    "function",
    "error on exp",
    "order",
    "error on logistic",
    "order",
    "build, 1,000 points",
    "100,000",
    "evaluate",
)
MAKERS: dict[str, Maker] = {
    "`MonotoneCubic`": ss.MonotoneCubic,
    '`MonotoneCubic`, `ends="natural"`, `layer=0`': partial(
        ss.MonotoneCubic, ends="natural", layer=0
    ),
    '`MonotoneCubic`, `convex="data"`': partial(ss.MonotoneCubic, convex="data"),
    "`MonotoneQuintic`": ss.MonotoneQuintic,
    "`MonotoneQuartic`": ss.MonotoneQuartic,
    "PCHIP": PchipInterpolator,
    "Akima": Akima1DInterpolator,
    "makima": partial(Akima1DInterpolator, method="makima"),
    "natural cubic spline": partial(CubicSpline, bc_type="natural"),
    "`CubicSpline`": CubicSpline,
}
#: Generated sets of a kind.
SETS = 50
#: Shares of the range, and of the largest second derivative, that count as rounding.
ROUNDING = 1e-12
NEGLIGIBLE = 1e-9
#: Intervals between which the order of accuracy is measured.
INTERVALS = (40, 80)
SMOOTH: dict[str, Callable[[Array], Array]] = {
    "exp": np.exp,
    "logistic": lambda x: 1 / (1 + np.exp(-12 * (x - 0.5))),
}
#: Points and queries, and repetitions of which the fastest counts, in the measurement of time.
POINTS, QUERIES, REPEATS = (1_000, 100_000), 1_000_000, 11


def rough(rng: np.random.Generator) -> tuple[Array, Array]:
    """Return rising data whose steps differ by orders of magnitude."""
    return np.cumsum(rng.uniform(0.1, 1, 30)), np.cumsum(rng.lognormal(0, 2, 30))


def smooth(rng: np.random.Generator) -> tuple[Array, Array]:
    """Return samples of a line plus three smooth steps, at random x."""
    x = np.sort(np.append(rng.uniform(0, 10, 28), [0.0, 10.0]))
    steps = [np.tanh((x - c) / w) for c, w in rng.uniform([1, 0.5], [9, 2], (3, 2))]
    return x, 0.2 * x + np.sum(steps, axis=0)


def data() -> dict[str, list[tuple[Array, Array]]]:
    """Return the data sets, generated ones under one name."""
    rng = np.random.default_rng(17)
    published = {name: [tuple(polygons.load(name).values())] for name in ("rpn14", "akima")}
    made = {f"{k.__name__}, {SETS} sets": [k(rng) for _ in range(SETS)] for k in (rough, smooth)}
    return published | made


def as_ppoly(f: PPoly | ss.MonotoneSpline) -> PPoly:
    """Return a function in SciPy's form."""
    return f if isinstance(f, PPoly) else f.to_ppoly()


def energy(f: PPoly | ss.MonotoneSpline) -> float:
    """Return ∫ f''² dx."""
    if not isinstance(f, PPoly):
        return float(f.bending_energy)
    second = f.derivative(2)
    square = PPoly(np.apply_along_axis(lambda c: np.convolve(c, c), 0, second.c), second.x)
    return float(square.integrate(second.x[0], second.x[-1]))


def overshoot(x: Array, y: Array, f: PPoly) -> float:
    """Return by how much f leaves the values beside it at most, over the range of y."""
    turns = f.derivative().roots(discontinuity=False, extrapolate=False)
    turns = turns[np.isfinite(turns)]
    i = np.clip(np.searchsorted(x, turns, side="right") - 1, 0, len(x) - 2)
    low, high = np.minimum(y[i], y[i + 1]), np.maximum(y[i], y[i + 1])
    outside = np.maximum(low - f(turns), f(turns) - high)
    share = float(outside.max(initial=0.0) / np.ptp(y))
    return share if share > ROUNDING else 0.0


def sign_changes(values: Array) -> int:
    """Return how often the sign changes; negligible values have none."""
    signs = np.sign(values[np.abs(values) > NEGLIGIBLE * np.abs(values).max()])
    return int(np.count_nonzero(np.diff(signs)))


def more_inflections(x: Array, y: Array, f: PPoly) -> int:
    """Return the inflections of f less those of its data, at least 0."""
    second = f.derivative(2)
    roots = second.roots(discontinuity=False, extrapolate=False)
    parts = np.union1d(second.x, roots[np.isfinite(roots)])
    # Between neighbouring roots the sign is the same: one place decides.
    own = sign_changes(second((parts[:-1] + parts[1:]) / 2))
    return max(0, own - sign_changes(np.diff(np.diff(y) / np.diff(x))))


def shape_row(name: str, maker: str, sets: list[tuple[Array, Array]]) -> list[str]:
    """Return the cells of a function on the sets of a kind."""
    energies, beyond, broken, asked, more = [], [], 0, 0, 0
    for x, y in sets:
        f = MAKERS[maker](x, y)
        energies.append(energy(f) / ss.minimal_bending(x, y))
        counts = ss.check_monotone(x, y, f, convex="data").counts()["convexity"]
        broken, asked = broken + counts[0], asked + counts[1]
        form = as_ppoly(f)
        beyond.append(overshoot(x, y, form))
        more += more_inflections(x, y, form)
    worst = max(beyond)
    return [
        name,
        maker,
        f"{np.median(energies):.3f}",
        f"{worst:.1%}" if worst else "0",
        f"{broken} of {asked}",
        str(more),
    ]


def shape_rows() -> Iterator[list[str]]:
    """Yield the cells of every data set and function."""
    for name, sets in data().items():
        for maker in MAKERS:
            yield shape_row(name, maker, sets)


def accuracy(maker: Maker, truth: Callable[[Array], Array]) -> list[str]:
    """Return the largest error on [0, 1], and the order at which it falls."""
    q = np.linspace(0, 1, 40_001)
    errors = []
    for n in INTERVALS:
        x = np.linspace(0, 1, n + 1)
        errors.append(np.abs(maker(x, truth(x))(q) - truth(q)).max())
    return [f"{errors[0]:.1e}", f"{np.log2(errors[0] / errors[1]):.1f}"]


def accuracies() -> Iterator[list[str]]:
    """Yield the cells of every function but for its times."""
    for name, maker in MAKERS.items():
        yield [name, *(cell for truth in SMOOTH.values() for cell in accuracy(maker, truth))]


def elapsed(call: Callable[[], object]) -> float:
    """Return the processor time of one call, of all threads: other programs hardly change it."""
    start = time.process_time()
    call()
    return time.process_time() - start


def times() -> dict[str, list[str]]:
    """Return times of building and of evaluation over PCHIP's, the fastest of interleaved runs."""
    rng = np.random.default_rng(17)
    sets = [(np.cumsum(rng.uniform(0.1, 1, n)), np.cumsum(rng.lognormal(0, 1, n))) for n in POINTS]
    q = np.linspace(*sets[-1][0][[0, -1]], QUERIES)
    made = {name: maker(*sets[-1]) for name, maker in MAKERS.items()}
    seconds = np.full((len(MAKERS), len(POINTS) + 1), np.inf)
    for _ in range(REPEATS):
        for i, (name, maker) in enumerate(MAKERS.items()):
            calls = [*(partial(maker, x, y) for x, y in sets), partial(made[name], q)]
            seconds[i] = np.minimum(seconds[i], [elapsed(call) for call in calls])
    ratios = seconds / seconds[list(MAKERS).index("PCHIP")]
    return {
        name: [f"{float(f'{r:.2g}'):g}" for r in row]
        for name, row in zip(MAKERS, ratios.tolist(), strict=True)
    }


def table(heading: tuple[str, ...], texts: int, rows: list[list[str]]) -> str:
    """Return a table in Markdown whose first columns hold text."""
    rule = ["---"] * texts + ["--:"] * (len(heading) - texts)
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (list(heading), rule, *rows))


def marked(name: str) -> tuple[str, str]:
    """Return the lines on the page between which a table stands."""
    return f"<!-- begin {name}: functions_table.py -->\n", f"\n<!-- end {name} -->"


def replaced(page: str, name: str, content: str) -> str:
    """Return the page with the table of a name exchanged."""
    begin, end = marked(name)
    before, rest = page.split(begin)
    return before + begin + content + end + rest.split(end)[1]


if __name__ == "__main__":
    page = PAGE.read_text(encoding="utf-8")
    page = replaced(page, "shape", table(SHAPE, 2, list(shape_rows())))
    cost = times()
    rates = [[*cells, *cost[cells[0]]] for cells in accuracies()]
    PAGE.write_text(replaced(page, "rates", table(RATES, 1, rates)), encoding="utf-8")
