# SPDX-License-Identifier: MIT OR Apache-2.0

"""The notebooks of python/examples run from above, and each draws something.

Their cells are executed here without Jupyter, which takes a fraction of the time; `make docs`
executes them with it. They are kept without outputs: what they show is what the installed version
makes, and a change of one shows as a change of its text.
"""

import json
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

NOTEBOOKS = sorted((Path(__file__).parent.parent / "python" / "examples").glob("*.ipynb"))


def cells(path, kind):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    return [c for c in notebook["cells"] if c["cell_type"] == kind]


def test_there_are_some():
    assert len(NOTEBOOKS) >= 6


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_it_runs_and_draws(path, tmp_path, monkeypatch):
    mpl.use("Agg")
    from matplotlib import pyplot as plt

    drawn = []

    def show():
        for number in plt.get_fignums():
            figure = plt.figure(number)
            figure.draw_without_rendering()
            drawn.append([len(a.lines) + len(a.collections) + len(a.patches) for a in figure.axes])
        plt.close("all")

    monkeypatch.setattr(plt, "show", show)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": path.stem}
    for number, cell in enumerate(cells(path, "code")):
        exec(compile("".join(cell["source"]), f"{path.name}, code cell {number}", "exec"), names)
    assert drawn
    assert np.concatenate(drawn).max() >= 2


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_it_is_kept_without_outputs_and_begins_with_a_title(path):
    assert "".join(cells(path, "markdown")[0]["source"]).startswith("# ")
    assert all(c["outputs"] == [] and c["execution_count"] is None for c in cells(path, "code"))
