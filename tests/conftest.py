# SPDX-License-Identifier: MIT OR Apache-2.0

"""Settings and fixtures that all tests share."""

import os
import signal
import sys

import hypothesis
import numpy as np
import pytest

# CI must decide the same about the same commit: no random seeds, no time limits on a busy machine.
hypothesis.settings.register_profile("ci", derandomize=True, deadline=None, max_examples=200)
hypothesis.settings.register_profile("dev", deadline=None)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "dev"))


@pytest.fixture
def rng() -> np.random.Generator:
    """Return a generator with a fixed seed."""
    return np.random.default_rng(20001013)


@pytest.fixture(autouse=True, scope="session")
def interrupts_are_heard():
    """A shell starts background jobs with SIGINT ignored; Python then never raises it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(autouse=True)
def figures_are_closed():
    """Figures of pyplot stay open until they are closed, and many are warned of."""
    yield
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close("all")
