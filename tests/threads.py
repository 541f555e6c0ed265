"""Whether other Python threads run while the library works."""

import threading
import time
from collections.abc import Callable

import numpy as np


def share_stood_still(task: Callable[[], object]) -> float:
    """Run the task in a thread; return the longest pause of this one as a part of its time.

    If the interpreter lock were held, this thread would stand still nearly all the time.
    """
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
