# SPDX-License-Identifier: MIT OR Apache-2.0

"""What `import shapespline` brings along, and what a user's type checker says of it."""

import subprocess
import sys
from pathlib import Path

import pytest

import shapespline as ss
from shapespline import _core

#: Optional, or slow to import: whoever does not use them does not wait for them.
LATER = ("scipy", "matplotlib", "mpl_toolkits", "pandas", "argparse", "doctest", "unittest")


def run(code, *arguments):
    return subprocess.run(
        [sys.executable, *arguments, "-c", code],
        capture_output=True, text=True, check=True, timeout=60,
    ).stdout  # fmt: skip


def test_the_import_brings_only_numpy_and_what_the_module_is_made_of():
    """Times depend on the machine, so `make bench` measures them; modules do not."""
    listing = "import sys; before = set(sys.modules); import {}; print(*set(sys.modules) - before)"
    numpy = set(run(listing.format("numpy")).split())
    ours = set(run(listing.format("numpy, shapespline")).split()) - numpy
    assert not {name.partition(".")[0] for name in ours} & set(LATER)
    own = {name for name in ours if name.partition(".")[0] == "shapespline"}
    assert not {name for name in own if name.startswith("shapespline._cli")}
    assert len(ours - own) < 40, sorted(ours - own)


def test_nothing_outside_knows_the_command_line():
    package = Path(ss.__file__).parent
    files = {
        p.relative_to(package).as_posix()
        for p in package.rglob("*.py")
        if "_cli" in p.read_text(encoding="utf-8")
    }
    assert {name for name in files if not name.startswith("_cli/")} == {"__main__.py"}


def test_the_compiled_module_does_without_the_package():
    code = f"""
import importlib.util, sys
spec = importlib.util.spec_from_file_location("_core", {_core.__file__!r})
core = importlib.util.module_from_spec(spec)
spec.loader.exec_module(core)
curve = core.NuSpline([[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]])
report = curve.check()
print(bool(report.nodes), report.undecided, report.oscillations, curve.__reduce__()[0].__name__)
try:
    core.NuSpline([[0, 0]])
except core.InputError as error:
    print(error)
print([name for name in sys.modules if name.startswith("shapespline")])
"""
    first, second, third = run(code).splitlines()
    assert first.startswith("True [] [")
    assert first.endswith("_from_bytes")
    assert second.startswith("points must")
    assert third == "[]"


@pytest.mark.parametrize("name", LATER[:4])
def test_it_works_without(name):
    """A missing extra is an error only where it is used."""
    code = f"""
import sys
sys.modules[{name!r}] = None
import shapespline as ss
curve = ss.NuSpline.shape_preserving([[0, 0], [1, 1], [2, 0], [3, 1]])
assert curve.check().ok
ss.interchange.svg(curve)
ss.MonotoneQuintic([0, 1, 2], [0, 1, 1]).inverse
"""
    run(code)


USER = """
import numpy as np
import shapespline as ss

points = np.zeros((3, 3)) + np.arange(3.0)[:, None] ** [[1, 2, 3]]
curve: ss.NuSpline = ss.NuSpline.shape_preserving(points, "chordal", boundary="circular")
kappa: float = curve.curvature(0.5)
many = curve.curvature([0.5, 0.6])
reveal_type(many)
report: ss.ShapeReport = curve.check("convexity")
for record in report.segments:
    margin: float = record.margin
violated, applicable = report.counts()["convexity"]
fits = ss.fit_many(points, [0, 3], method="tension")
reveal_type(fits[0])
f = ss.MonotoneQuintic([0, 1, 2], [0, 1, 3], slopes="fritsch-butland")
slope = f.derivative()(0.5)
axes = ss.plot.curve(curve)
axes.set_title("typed")
text: str = ss.interchange.step(curve, unit="m")
"""

WRONG = """
import shapespline as ss

ss.NuSpline([[0, 0], [1, 1]], boundary="loose")
ss.NuSpline([[0, 0], [1, 1]]).tension = 3
ss.MonotoneQuintic([0, 1], [0, 1], energy="nice")
ss.interchange.step(3, unit=7)
"""


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """Run mypy once, over a right program and a wrong one; return what it says of each."""
    pytest.importorskip("mypy")
    place = tmp_path_factory.mktemp("typed")
    for name, text in (("right", USER), ("wrong", WRONG)):
        (place / f"{name}.py").write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--config-file=", "."],
        cwd=place, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    lines = done.stdout.splitlines()
    return {name: [line for line in lines if line.startswith(name)] for name in ("right", "wrong")}


def test_a_users_program_is_typed(judged):
    notes = judged["right"]
    assert [line for line in notes if ": error:" in line] == []
    revealed = " ".join(notes)
    assert "float64" in revealed
    assert "SpaceCurve | None" in revealed


def test_a_users_mistakes_are_found(judged):
    assert {int(line.split(":")[1]) for line in judged["wrong"] if ": error:" in line} == {
        4,
        5,
        6,
        7,
    }
