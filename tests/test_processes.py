# SPDX-License-Identifier: MIT OR Apache-2.0

"""Processes, threads and signals: forks, systems without threads, Ctrl-C.

The monotone functions have more of it in test_monotone_processes.py.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from scale import scaled

posix = pytest.mark.skipif(os.name != "posix", reason="a matter of POSIX")


def script(text, *arguments, timeout=120, **variables):
    """Run Python text in a process of its own, where the tests' modules are at hand."""
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-c", text, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
        env=os.environ | {"PYTHONPATH": path} | variables,
    )


FORKS = """
import os, sys, threading, time, warnings
import numpy as np
import shapespline as ss
warnings.simplefilter("ignore")  # of Python 3.12: that a process with threads is forked

points = np.random.default_rng(0).normal(size=(8, 3)).cumsum(axis=0)
stop = threading.Event()

def fit():
    assert ss.fit_many(points, [0, 4, 8]).ok

def fit_on():
    while not stop.is_set():
        fit()

threads = [threading.Thread(target=fit_on) for _ in range(4)]
for thread in threads:
    thread.start()
hung = 0
for _ in range(int(sys.argv[1])):
    child = os.fork()
    if child == 0:
        try:
            fit()
        finally:
            os._exit(0)
    end = time.monotonic() + 20
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if time.monotonic() > end:
            hung += 1
            os.kill(child, 9)
            os.waitpid(child, 0)
            break
        time.sleep(0.0002)
    if hung == 3:
        break
stop.set()
for thread in threads:
    thread.join()
print(hung)
"""


@posix
def test_no_child_forked_while_threads_fit_hangs():
    """Under the lock that the pool had, one in two hundred did."""
    done = script(FORKS, scaled(5000), timeout=600)
    assert (done.returncode, done.stdout) == (0, "0\n"), done.stderr


EVERYTHING = """
import numpy as np
import shapespline as ss

for n in (60, 20_000):
    t = np.linspace(0, n / 5, n)
    points = np.column_stack([np.cos(t), np.sin(t), 0.1 * t])
    for fit in (ss.FairSpline, *(family.shape_preserving for family in
                                 (ss.NuSpline, ss.TensionSpline, ss.CatmullRom))):
        curve = fit(points)
        curve(t), curve.curvature(t), curve.arc_length(), curve.sample(n, by="arc-length")
        curve.check().segments, curve.check().nodes
    ss.check_shape(points, curve.to_bspline(), parameters=curve.parameters)
    ss.polygon_shape(points), ss.inflection_count(points[:500])
    for threads in (None, 1, 3):
        assert ss.fit_many(points, np.arange(0, n + 1, n // 10), threads=threads).ok
    for function in (ss.MonotoneQuartic, ss.MonotoneQuintic):
        f = function(t, np.cumsum(t), axis=0)
        f(t), f.inverse(f(t[:50])), f.roots(), f.integrate(0, 1), f.antiderivative()
        function(t[:100], np.tile(t[:100, None], (1, n // 60)))
        ss.fit_many_monotone(np.tile(t[:50], (n // 50, 1)), np.tile(t[:50], (n // 50, 1)))(t[:9])
"""


@posix
def test_everything_works_where_the_system_grants_no_thread():
    """No system has room for stacks of this size."""
    done = script(EVERYTHING, RUST_MIN_STACK=str(1 << 46))
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("threads", [5000, 2**31, 2**62])
def test_no_more_threads_are_made_than_there_are_curves(threads):
    text = "import sys, shapespline as ss; points = [[0, 0], [1, 1], [2, 0], [3, 1]]; "
    text += "ss.fit_many(points, [0, 2, 4], threads=int(sys.argv[1]))"
    assert script(text, threads, timeout=20).returncode == 0
