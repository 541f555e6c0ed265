# SPDX-License-Identifier: MIT OR Apache-2.0

"""Monotone fits and the processes they run in: Ctrl-C, fork, other threads."""

import os
import pickle
import signal
import sys
import time

import numpy as np
import pytest

import shapespline as ss
import threads

posix = pytest.mark.skipif(os.name != "posix", reason="signals to the own process, fork")


def large(n):
    rng = np.random.default_rng(0)
    return np.cumsum(rng.uniform(0.1, 1, n)), np.cumsum(rng.exponential(size=n))


@posix
@pytest.mark.parametrize("work", ["columns", "rows"])
def test_ctrl_c_ends_a_long_optimal_fit(work):
    """Within a second: between two batches of columns or rows, not after all of them."""
    rng = np.random.default_rng(0)
    x = np.cumsum(rng.uniform(0.1, 1, 20))
    y = np.cumsum(rng.exponential(size=(400_000, 20)), axis=1)
    task = {
        "columns": lambda: ss.MonotoneQuintic(x, y, axis=1),
        "rows": lambda: ss.fit_many_monotone(np.broadcast_to(x, y.shape), y),
    }[work]
    threads.assert_ctrl_c_ends(task)


@pytest.mark.skipif(sys.platform != "linux", reason="fork without exec is safe to test on Linux")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_child_can_do_all_that_the_parent_could():
    """The child inherits a pool whose threads do not exist in it."""
    x, y = large(50_000)
    f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    q = np.linspace(x[0], x[-1], 100_000)
    expected = f(q)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            again = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
            ss.MonotoneQuintic(x[:20_000], y[:20_000])
            same = np.array_equal(again(q), expected) and np.array_equal(f(q), expected)
            same = same and np.array_equal(pickle.loads(pickle.dumps(f))(q), expected)
            same = same and not np.isnan(f.inverse(expected)).any()
            os.write(writer, b"y" if same else b"n")
        finally:
            os._exit(0)
    os.close(writer)
    end = time.monotonic() + 60
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if time.monotonic() > end:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            pytest.fail("the child waits for threads that it does not have")
        time.sleep(0.01)
    assert os.read(reader, 1) == b"y"
    os.close(reader)


@pytest.mark.parametrize("work", ["fit", "evaluate", "inverse"])
def test_long_work_lets_other_threads_run(work):
    x, y = large(600_000)
    f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    rng = np.random.default_rng(1)
    q, v = rng.uniform(x[0], x[-1], 6_000_000), rng.uniform(y[0], y[-1], 3_000_000)
    task = {
        "fit": lambda: ss.MonotoneQuintic(x, y),
        "evaluate": lambda: f(q),
        "inverse": lambda: f.inverse(v),
    }[work]
    threads.assert_others_run(task)
