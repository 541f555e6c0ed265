# SPDX-License-Identifier: MIT OR Apache-2.0

"""Faults of the world around: forks, signals, damaged bytes, full disks, storms of threads, files.

Unusable numbers are in test_bad_input.py; the page python/docs/faults.md lists all of them.
"""

import contextlib
import io
import json
import os
import pickle
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import polygons
import shapespline as ss
import threads
from shapespline import _cli

posix = pytest.mark.skipif(os.name != "posix", reason="a matter of POSIX")

POINTS = polygons.random_walk(np.random.default_rng(5), 12)
X = np.arange(12.0)
Y = np.array([0.0, 1, 1, 4, 5, 5, 5, 9, 3, 2, 2, 8])


def objects():
    """One of everything that can be pickled."""
    nu = ss.NuSpline.shape_preserving(POINTS)
    return {
        "nu": nu,
        "tension": ss.TensionSpline.shape_preserving(POINTS),
        "catmull-rom": ss.CatmullRom.shape_preserving(POINTS),
        "fair": ss.FairSpline(POINTS),
        "report": nu.check(),
        "many": ss.fit_many(POINTS, [0, 5, 12]),
        "quartic": ss.MonotoneQuartic(X, Y),
        "quintic": ss.MonotoneQuintic(X, Y),
    }


def ask(thing):
    """Answer that shows whether an object works: numbers, from all of it."""
    if isinstance(thing, ss.ShapeReport):
        return np.array([v.margin for v in thing.segments])
    if isinstance(thing, (ss.MonotoneQuartic, ss.MonotoneQuintic)):
        return thing(np.linspace(-1, 12, 50))
    if isinstance(thing, ss.SpaceCurve):
        u = np.linspace(thing.parameters[0] - 1, thing.parameters[-1] + 1, 50)
        return np.hstack([thing(u).ravel(), thing.curvature(u), [thing.arc_length()]])
    return np.hstack([ask(curve) for curve in thing])


def script(text, *arguments, timeout=120, **options):
    """Run Python text in a process of its own, where the tests' modules are at hand."""
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-c", text, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
        env=os.environ | {"PYTHONPATH": path},
        **options,
    )


# Processes


def test_pickles_from_another_process(tmp_path):
    file = tmp_path / "objects.pickle"
    write = "import pickle, sys, test_faults as t; "
    write += "pickle.dump(t.objects(), open(sys.argv[1], 'wb'))"
    done = script(write, file)
    assert done.returncode == 0, done.stderr
    theirs = pickle.loads(file.read_bytes())
    for name, ours in objects().items():
        np.testing.assert_array_equal(ask(theirs[name]), ask(ours), err_msg=name)


AFTER_FORK = """
import os, sys, warnings
import numpy as np
import shapespline as ss
warnings.simplefilter("ignore")  # of Python 3.12: that a process with threads is forked

def work(n):
    t = np.linspace(0, n / 5, n)
    points = np.column_stack([np.cos(t), np.sin(t), 0.1 * t])
    for fit in (ss.FairSpline, *(family.shape_preserving for family in
                                 (ss.NuSpline, ss.TensionSpline, ss.CatmullRom))):
        curve = fit(points)
        u = np.random.default_rng(1).uniform(*curve.parameters[[0, -1]], 4 * n)
        curve(u), curve.curvature(u), curve.arc_length(), curve.sample(n, by="arc-length")
        report = curve.check()
        assert report.ok
        report.segments, report.nodes
    curve.fairness()
    if n == 4000:
        # Much of it fails at first: more ranges than are checked one by one.
        walk = np.random.default_rng(2).normal(size=(n, 3)).cumsum(axis=0)
        ss.NuSpline.shape_preserving(walk, strategy="growth")
    ss.check_shape(points, curve.to_bspline(), parameters=curve.parameters)
    ss.polygon_shape(points), ss.inflection_count(points[:500])
    ss.fit_many(points, np.arange(0, n + 1, n // 10))
    for function in (ss.MonotoneQuartic, ss.MonotoneQuintic):
        f = function(t, np.cumsum(t), axis=0)
        f(u), f.inverse(f(t[:50])), f.roots(), f.integrate(0, 1)
        function(t[:100], np.tile(t[:100, None], (1, 50)))

sizes = [60, 700, 4000, 6000, 40000]
for n in sizes:
    work(n)  # makes the parent's threads
child = os.fork()
if child == 0:
    for n in sizes:
        work(n)
    os._exit(0)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@posix
def test_everything_works_after_a_fork():
    done = script(AFTER_FORK)
    assert done.returncode == 0, done.stderr


def long_search(family):
    points = np.random.default_rng(0).normal(size=(3000, 3)).cumsum(axis=0)
    return lambda: family.shape_preserving(
        points, strategy="nussp", step=1e-6, max_iterations=10**9
    )


def long_function(function, n):
    x = np.arange(float(n))
    y = np.random.default_rng(0).exponential(size=n).cumsum()
    return lambda: function(x, y)


LONG = {
    "nu": lambda: long_search(ss.NuSpline),
    "tension": lambda: long_search(ss.TensionSpline),
    "quintic": lambda: long_function(ss.MonotoneQuintic, 600_000),
}


@posix
@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_returns_within_a_second(name):
    threads.assert_ctrl_c_ends(LONG[name]())


def test_a_storm_of_threads():
    expected = {name: ask(thing) for name, thing in objects().items()}
    shared = objects()

    def work(k):
        mine = objects() if k % 4 == 0 else pickle.loads(pickle.dumps(shared))
        for name, answer in expected.items():
            np.testing.assert_array_equal(ask(shared[name]), answer)
            np.testing.assert_array_equal(ask(mine[name]), answer)
        return k

    with ThreadPoolExecutor(64) as pool:
        assert list(pool.map(work, range(128))) == list(range(128))


# Files


def main(capsys, *arguments):
    status = _cli.main([str(a) for a in arguments])
    return status, capsys.readouterr().err


@posix
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
@pytest.mark.parametrize("output", ["-o o.csv", "-o o.json", "-o o.step", "--report r.json",
                                    "--plot p.png", "--plot p.svg"])  # fmt: skip
def test_a_full_disk(output, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    option, name = output.split()
    Path(name).symlink_to("/dev/full")
    points = polygons.DATA / "gm_feature_line.csv"
    status, error = main(capsys, "fit", points, option, name)
    assert status == 2
    assert error == f"shapespline: {name}: cannot be written: No space left on device\n"


@posix
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_behind_standard_output():
    points = polygons.DATA / "gm_feature_line.csv"
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [Path(sys.executable).with_name("shapespline"), "fit", points],
            stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False,
        )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr == "shapespline: standard output: cannot be written: " \
        "No space left on device\n"  # fmt: skip


NUMBER = st.sampled_from(
    ["0", "1", "-2.5", "1e300", "1e-300", "nan", "inf", "1_0", "0x1", "", "é", "0,5", "1 000",
     '"0,5"', '"1', "time", "x [mm]", "y [m]", "# 1", "// 1", "sep=;", "１", "\u2212" "1", "x", "y"]
)  # fmt: skip
CELL = st.one_of(NUMBER, st.floats().map(repr), st.text(max_size=4))
SEPARATOR = st.sampled_from([",", ";", "\t", " ", ", ", "\x00"])
LINE = st.builds(lambda cells, sep: sep.join(cells), st.lists(CELL, max_size=5), SEPARATOR)
HONEST = st.lists(st.floats(-9, 9), min_size=2, max_size=3).map(lambda r: ",".join(map(repr, r)))
TABLE = st.one_of(
    st.binary(max_size=200),
    st.lists(LINE, max_size=9).map(lambda rows: "\n".join(rows).encode("utf-16", "replace")),
    st.lists(LINE, max_size=12).map(lambda rows: "\n".join(rows).encode("utf-8", "replace")),
    st.lists(HONEST, max_size=12).map(lambda rows: "\r\n".join(rows).encode()),
    st.lists(st.one_of(HONEST, HONEST, LINE), max_size=9).map(
        lambda rows: "\n".join(["x,y,z", *rows]).encode("utf-8", "replace")
    ),
)


@given(table=TABLE, method=st.sampled_from(["nu", "tension", "catmull-rom", "quartic", "quintic"]))
@settings(max_examples=150, deadline=None)
def test_any_table_is_fitted_or_refused_in_one_line(table, method, tmp_path_factory):
    path = tmp_path_factory.mktemp("tables") / "points.csv"
    path.write_bytes(table)
    status, error = quiet("fit", path, "--method", method)
    refused_in_one_line(status, error, path)


VALUE = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3)
    ),
    max_leaves=8,
)
GOOD = {
    "type": "bezier",
    "parameters": [0, 1, 2],
    "breaks": [0, 1, 2],
    "control": [[[0, 0], [1, 0], [1, 1]], [[1, 1], [1, 2], [2, 2]]],
    "weights": [[1, 1, 1], [1, 1, 1]],
    "boundary": "natural",
    "degree": 2,
    "knots": [0, 0, 0, 1, 1, 1],
    "coefficients": [[[0, 0]], [[1, 0]]],
    "shape": "polygon",
}


@given(
    entries=st.dictionaries(st.sampled_from(sorted(GOOD)), VALUE, max_size=3),
    kind=st.sampled_from(["bezier", "bspline", "power"]),
    cut=st.integers(0, 400),
)
@settings(max_examples=200, deadline=None)
def test_any_json_is_judged_or_refused_in_one_line(entries, kind, cut, tmp_path_factory):
    folder = tmp_path_factory.mktemp("curves")
    points, curve = folder / "points.csv", folder / "curve.json"
    points.write_text("0,0\n1,1\n2,2\n", encoding="utf-8")
    text = json.dumps(GOOD | {"type": kind} | entries)
    curve.write_text(text[:-cut] if cut < 20 and cut else text, encoding="utf-8")
    status, error = quiet("check", points, curve)
    refused_in_one_line(status, error, folder)


def test_parameters_that_are_no_array(tmp_path):
    points, curve = tmp_path / "points.csv", tmp_path / "curve.json"
    points.write_text("0,0\n1,1\n2,2\n", encoding="utf-8")
    for kind in ("bezier", "bspline", "power"):
        curve.write_text(json.dumps(GOOD | {"type": kind, "parameters": 0}), encoding="utf-8")
        status, error = quiet("check", points, curve)
        assert status == 2
        assert "'parameters' must be an array of numbers" in error


def refused_in_one_line(status, error, path):
    """Check that bad input is one short line; else a line may say how the file was read."""
    assert status in (0, 1, 2)
    lines = error.splitlines()
    assert all(line.startswith("shapespline: ") for line in lines), error
    assert len(lines) == 1 if status == 2 else len(lines) <= 2, error
    assert len(error) < 600 + 2 * len(str(path)), error


def quiet(*arguments):
    """Run the command line without pytest's fixture, which one example cannot have alone."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as e:
        status = _cli.main([str(a) for a in arguments])
    return status, e.getvalue()


# Numbers


def test_arc_length_far_beyond_the_ends_returns():
    curve = ss.NuSpline(POINTS)
    start = time.process_time()
    lengths = [curve.arc_length(0, u) for u in (-1e3, 1e6, 1e15, -1e30)]
    assert time.process_time() - start < 1
    assert np.all(np.isfinite(lengths))


@pytest.mark.parametrize("function", [ss.MonotoneQuartic, ss.MonotoneQuintic])
@pytest.mark.parametrize("x", [[0, 5e-324], [0, 5e-324, 1e-323, 2e-323]])
def test_subnormal_abscissae_are_fitted_or_refused(function, x):
    y = np.arange(float(len(x)))
    try:
        f = function(x, y)
    except ValueError as error:
        refused = error
    else:
        np.testing.assert_array_equal(f(x), y)
        return
    assert "rescale the data" in str(refused)


def test_parameters_closer_than_a_reciprocal_are_refused():
    with pytest.raises(ValueError, match=r"parameters\[1\] exceeds parameters\[0\]"):
        ss.TensionSpline(POINTS[:3], [0, 5e-324, 1])
