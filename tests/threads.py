# SPDX-License-Identifier: MIT OR Apache-2.0

"""Whether other Python threads run while the library works, and whether it hears Ctrl-C.

No test may fail because the machine is busy, with the tests of another process for one: so a busy
machine is told apart from a slow answer.
"""

import os
import signal
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest


def share_stood_still(task: Callable[[], object]) -> float:
    """Run the task in a thread; return the longest pause of this one as a part of its time."""
    done = threading.Event()
    seconds = []

    def timed() -> None:
        start = time.perf_counter()
        task()
        seconds.append(time.perf_counter() - start)
        done.set()

    thread = threading.Thread(target=timed)
    ticks = [time.perf_counter()]
    thread.start()
    while not done.is_set():
        time.sleep(0.001)
        ticks.append(time.perf_counter())
    thread.join()
    return float(max(np.diff(ticks)) / seconds[0])


def assert_others_run(task: Callable[[], object], share: float = 0.5) -> None:
    """Check that another thread never stands still for more than that share of the task's time.

    If the interpreter lock were held, it would stand still nearly all the time, and every time; a
    busy machine stops it now and then.
    """
    shares: list[float] = []
    while len(shares) < 4 and min(shares, default=1.0) >= share:
        shares.append(share_stood_still(task))
    assert min(shares) < share, shares


def assert_ctrl_c_ends(work: Callable[[], object], after: float = 0.3) -> None:
    """Check that a SIGINT ends the work within a second.

    Where other processes have the cores, within a second of what this one computes: all its threads
    together, so that it is at most as long on a quiet machine.
    """
    pressed = []

    def press() -> None:
        pressed.extend((time.perf_counter(), time.process_time()))
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, press)

    def wait() -> None:
        work()
        timer.join()  # a fast machine may be done before

    timer.start()
    with pytest.raises(KeyboardInterrupt):
        wait()
    passed = time.perf_counter() - pressed[0]
    computed = time.process_time() - pressed[1]
    assert min(passed, computed) < 1, (passed, computed)
    assert passed < 30
