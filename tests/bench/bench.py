# SPDX-License-Identifier: MIT OR Apache-2.0

"""Speed and memory beside SciPy's, measured in one run: ``make bench``.

Every line is a ratio of two measurements made on the same machine, alternately, within seconds of
each other, so the table can be compared between machines where times cannot. The targets are
those the project promises; the exit status is 0 whether they are met or not, for a busy machine
is no error.
"""

import argparse
import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import scipy
from measuring import Line, at_most, best, faster, within
from monotone import (
    monotone_building,
    monotone_convex_and_smooth,
    monotone_evaluating,
    monotone_small,
)
from scipy.interpolate import CubicSpline, make_interp_spline

import shapespline as ss

sys.path.insert(0, str(Path(__file__).parent.parent))
from fair import fair

import polygons


def building(sizes: list[int]) -> Iterator[Line]:
    """Compare building with given tension to SciPy's C² cubic through the same points.

    SciPy gets the parameters ready made; ours computes its chordal ones as users do.
    """
    for count in sizes:
        points = polygons.gentle_track(count)
        tension = np.random.default_rng(0).uniform(0, 3, count)
        u = ss.NuSpline(points).parameters
        ours, theirs = best(
            lambda p=points, t=tension: ss.NuSpline(p, tension=t),
            lambda p=points, u=u: make_interp_spline(u, p, k=3),
        )
        yield faster(f"build, N = {count:g}", ours, theirs, 4.0)


def preserving(count: int) -> Iterator[Line]:
    """Compare keeping the shape, violations at under 1 % of the nodes, to the same SciPy build."""
    points = polygons.gentle_track(count, kinks=0.0008)
    plain = ss.NuSpline(points)
    u = plain.parameters
    violations = plain.check().violations
    nodes = np.unique([v.segment + k for v in violations for k in (0, 1)])
    share = len(nodes) / count
    ours, theirs = best(
        lambda: ss.NuSpline.shape_preserving(points),
        lambda: make_interp_spline(u, points, k=3),
    )
    what = f"shape_preserving, N = {count:g}, {100 * share:.2f} % of nodes violating"
    line = faster(what, ours, theirs, 1.0)
    yield line if 0 < share < 0.01 else Line(what, "", "", None, "0 … 1 %", False)


def evaluating(sizes: list[int], queries: int) -> Iterator[Line]:
    """Compare position and two derivatives at many parameters to SciPy's CubicSpline."""
    for count in sizes:
        curve = ss.NuSpline(polygons.gentle_track(count))
        theirs = CubicSpline(curve.parameters, curve.points, bc_type="natural")
        u = np.random.default_rng(1).uniform(*curve.parameters[[0, -1]], queries)
        for order, query in (("sorted", np.sort(u)), ("unsorted", u)):

            def three(spline, query=query):
                for nu in range(3):
                    spline(query, nu)

            times = best(lambda c=curve: three(c), lambda c=theirs: three(c))
            what = f"evaluate f, f', f'' at {queries:g} {order}, N = {count:g}"
            yield faster(what, *times, 3.0)


def overhead() -> Iterator[Line]:
    """Measure the time of one small fit and of one scalar call from Python."""
    points = polygons.helix()
    curve = ss.NuSpline(points)
    fit, call = best(lambda: ss.NuSpline(points), lambda: curve(1.5), budget=1.0)
    yield within("one fit of 25 points", fit, 30e-6)
    yield within("one scalar call", call, 2e-6)


def importing() -> Iterator[Line]:
    """Measure what ``import shapespline`` takes after ``import numpy``, in fresh processes."""
    code = (
        "import numpy, time; start = time.perf_counter(); import shapespline; "
        "print(time.perf_counter() - start)"
    )
    command = [sys.executable, "-c", code]
    runs = [subprocess.run(command, capture_output=True, text=True, check=True) for _ in range(7)]
    yield within("import, after import numpy", min(float(run.stdout) for run in runs), 60e-3)


def families(sizes: list[int], queries: int) -> Iterator[Line]:
    """Compare tension cubics and Catmull–Rom curves to ν-splines and to SciPy."""
    for count in sizes:
        points = polygons.gentle_track(count)
        tension = np.random.default_rng(0).uniform(0, 3, count)
        scale = 1 / (1 + tension)
        u = ss.NuSpline(points).parameters
        directions = ("parametrization", "balanced")
        nu, tense, *preserve, scipy = best(
            lambda p=points, t=tension: ss.NuSpline(p, tension=t),
            lambda p=points, s=scale: ss.TensionSpline(p, tangent_scale=s),
            *(
                lambda p=points, d=d: ss.CatmullRom.shape_preserving(p, directions=d)
                for d in directions
            ),
            lambda p=points, u=u: make_interp_spline(u, p, k=3),
        )
        yield at_most(f"TensionSpline beside NuSpline, N = {count:g}", tense, nu, 2.0)
        for which, time_taken in zip(directions, preserve, strict=True):
            what = f"CatmullRom.shape_preserving, directions {which}, N = {count:g}"
            yield faster(what, time_taken, scipy, 5.0)
            yield within(f"{what}, per point", time_taken / count, 60e-9)

    curve = ss.TensionSpline(points, tangent_scale=scale)
    linear, pieces = ss.NuSpline(points, tension=tension), curve.to_ppoly()
    u = np.random.default_rng(1).uniform(*curve.parameters[[0, -1]], queries)
    for order, query in (("sorted", np.sort(u)), ("unsorted", u)):
        ours, plain, scipy = best(
            lambda q=query: curve(q), lambda q=query: linear(q), lambda q=query: pieces(q)
        )
        what = f"evaluate in s at {queries:g} {order}, N = {count:g}"
        yield at_most(f"{what}, beside ν", ours, plain, 3.0)
        yield faster(f"{what}, beside PPoly", ours, scipy, 1.0)


def collections() -> Iterator[Line]:
    """Compare ``fit_many``, shape-preserving, to a loop of SciPy fits that preserve nothing.

    Tool paths keep the shape nearly everywhere; a random walk breaks it at every second segment.
    """
    lengths = np.random.default_rng(0).integers(20, 91, 300)
    offsets = np.r_[0, np.cumsum(lengths)]
    sets = {
        "tool paths": polygons.gentle_track(int(offsets[-1])),
        "random walks": polygons.random_walk(np.random.default_rng(1), int(offsets[-1])),
    }
    for name, points in sets.items():
        rows = [points[a:b] for a, b in pairwise(offsets)]
        pairs = [(ss.NuSpline(row).parameters, row) for row in rows]

        def loop(pairs=pairs):
            for u, row in pairs:
                make_interp_spline(u, row, k=3)

        methods = ("nu", "tension", "catmull-rom")
        *ours, theirs = best(
            *(lambda m=m, p=points: ss.fit_many(p, offsets, method=m) for m in methods), loop
        )
        for method, time_taken in zip(methods, ours, strict=True):
            yield faster(f"fit_many, {method}, 300 {name}", time_taken, theirs, 20.0)


# The peak of a process is one number, so each fit runs in one of its own. What the interpreter,
# the modules and the points themselves took before the fit does not count.
MEMORY = """
import resource, sys
import numpy as np, shapespline as ss
import polygons
points = polygons.gentle_track(int(sys.argv[1]), kinks=0.0008)
ss.NuSpline.shape_preserving(points[:100])
x, y = np.cumsum(0.1 + np.random.default_rng(1).random((2, int(sys.argv[1]))), axis=1)
ss.MonotoneQuintic(x[:100], y[:100])
with open("/proc/self/clear_refs", "w") as peak:
    peak.write("5")  # forget the peak of making the points
def peak():
    with open("/proc/self/status") as status:
        values = dict(line.split(":", 1) for line in status)
    return [1024 * int(values[key].split()[0]) for key in ("VmHWM", "VmRSS")]
before = peak()[1]
fits = {
    "given": lambda: ss.NuSpline(points),
    "preserve": lambda: ss.NuSpline.shape_preserving(points),
    "quartic": lambda: ss.MonotoneQuartic(x, y),
    "quintic": lambda: ss.MonotoneQuintic(x, y, slopes="fritsch-butland"),
    "quintic, optimal": lambda: ss.MonotoneQuintic(x, y),
}
made = fits[sys.argv[2]]()
size = x.nbytes + y.nbytes if sys.argv[2].startswith("qu") else points.nbytes
print((peak()[0] - before) / size)
"""


def memory(count: int) -> Iterator[Line]:
    """Measure the peak memory of a fit relative to the size of its points."""
    limits = {"given": 10, "preserve": 10, "quartic": 12, "quintic": 12, "quintic, optimal": 12}
    for kind, most in limits.items():
        done = subprocess.run(
            [sys.executable, "-c", MEMORY, str(count), kind],
            capture_output=True,
            text=True,
            check=False,
            cwd=Path(__file__).parent.parent,
        )
        what = f"peak memory of a fit ({kind}), N = {count:g}, × input"
        if done.returncode:
            reason = done.stderr.strip().splitlines()[-1][:40]
            yield Line(f"{what}: {reason}", "", "", None, f"≤ {most}×", False)
            continue
        ratio = float(done.stdout)
        yield Line(what, f"{ratio:.2f}×", "", ratio, f"≤ {most}×", ratio <= most)


# On one core, so the pool of threads has to be told before it is made.
CHECKS = """
import sys, time
import numpy as np, shapespline as ss
from scipy.interpolate import CubicSpline
import polygons
def least(call):
    times = []
    for _ in range(7):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)
count = int(sys.argv[1])
points = polygons.gentle_track(count + 1)
curve = ss.NuSpline(points)
every = [*curve.check().counts(), "global-convexity"]
cubic = CubicSpline(curve.parameters, points)
print(least(lambda: curve.check(every)) / count)
print(least(lambda: ss.PiecewiseBezier.from_power(cubic.c, cubic.x)) / count)
print(least(lambda: ss.check_shape(points, cubic)) / count)
"""


def checking(count: int) -> Iterator[Line]:
    """Measure what a check costs a segment on one core, and a curve of SciPy's before it."""
    done = subprocess.run(
        [sys.executable, "-c", CHECKS, str(count)],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parent.parent,
        env=os.environ | {"RAYON_NUM_THREADS": "1"},
    )
    own, converted, foreign = map(float, done.stdout.split())
    yield within(f"check of all criteria, a segment of {count:g}", own, 250e-9)
    yield within(f"PPoly to Bézier points, a segment of {count:g}", converted, 300e-9)
    yield within(f"check_shape of a CubicSpline, a segment of {count:g}", foreign, 1e-6)


def counting(count: int) -> Iterator[Line]:
    """Measure the most inflections over all directions, of points and of a spline through them."""
    points = polygons.random_walk(np.random.default_rng(2), count)
    spline = CubicSpline(np.arange(float(count)), points)
    of_points, of_spline = best(
        lambda: ss.inflection_count(points), lambda: ss.inflection_count(spline)
    )
    yield within(f"inflection_count of {count} points", of_points, 0.5)
    yield within(f"inflection_count of a spline of {count} points", of_spline, 3.0)


#: Threads that others kept busy in the minute before: what the numbers must be read with.
LOAD = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")


def machine() -> str:
    """Return what the numbers depend on, in a sentence."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        models = [line for line in info.read_text("utf-8").splitlines() if "model name" in line]
        cpu = models[0].partition(":")[2].strip() if models else cpu
    return (
        f"Measured on {os.cpu_count()} threads of {cpu}, with Python {platform.python_version()}, "
        f"NumPy {np.__version__} and SciPy {scipy.__version__}, shapespline {ss.__version__}; "
        f"before the run, others kept {LOAD:.1f} threads busy."
    )


def page(lines: list[Line]) -> str:
    """Return the table that python/docs/performance.md includes."""
    header = (
        "| what | ours | SciPy, or as said | ratio | target | met |\n|---|--:|--:|--:|---|---|\n"
    )
    rows = "\n".join(line.markdown() for line in lines)
    met = f"{sum(line.met for line in lines)} of {len(lines)} targets met."
    return f"{header}{rows}\n\n{met} {machine()}\n"


def main() -> int:
    """Print the table line by line as it is measured."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="smaller sizes only: under a minute")
    parser.add_argument(
        "--markdown",
        type=Path,
        metavar="FILE",
        help="write the table as Markdown too: python/docs/performance-table.md",
    )
    options = parser.parse_args()
    quick = options.quick
    print(f"{'what':<56}{'ours':>11}{'SciPy':>11}{'ratio':>8}  {'target':<11}met")
    largest = 100_000 if quick else 1_000_000
    sizes = [n for n in (1_000, 10_000, 100_000, 1_000_000) if n <= largest]
    lines = []
    for part in (
        building(sizes),
        preserving(largest),
        evaluating([25, *sizes], largest),
        families([n for n in sizes if n >= 10_000], largest),
        collections(),
        fair(largest // 10),
        monotone_building(largest),
        monotone_evaluating(sizes, largest),
        monotone_small(),
        monotone_convex_and_smooth(100_000),
        overhead(),
        importing(),
        memory(largest),
        checking(largest),
        counting(2000),
    ):
        for line in part:
            print(line, flush=True)
            lines.append(line)
    print(f"{sum(line.met for line in lines)} of {len(lines)} targets met")
    if options.markdown:
        options.markdown.write_text(page(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
