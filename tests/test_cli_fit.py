# SPDX-License-Identifier: MIT OR Apache-2.0

"""shapespline fit: every family, on real files and bad ones; what it writes is read back."""

import io
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image

import cases
import polygons
import shapespline as ss
from shapespline import _cli
from shapespline._cli import progress, tables

COMMAND = Path(sys.executable).with_name("shapespline")
CURVES = {method: family for family, method in cases.METHODS.items()}
FUNCTIONS = {"quartic": ss.MonotoneQuartic, "quintic": ss.MonotoneQuintic}


@pytest.fixture
def run(capsys):
    """Return a function that runs the command line and returns status, output and errors."""

    def call(*arguments):
        status = _cli.main([str(a) for a in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return call


def csv(tmp_path, text, name="points.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def table(path):
    header, *rows = path.read_text(encoding="utf-8").splitlines()
    return header.split(","), np.array([[float(c) for c in row.split(",")] for row in rows])


# What is written


@pytest.mark.parametrize("method", CURVES)
@pytest.mark.parametrize("name", ["gm_feature_line", "gps_mojstrovka", "protein_1a8o_ca"])
def test_every_family_on_real_files(method, name, run, tmp_path):
    points = polygons.DATA / f"{name}.csv"
    out, curve, report = tmp_path / "o.csv", tmp_path / "c.json", tmp_path / "r.json"
    status, text, errors = run(
        "fit", points, "--method", method, "-o", out, "-o", curve, "--report", report
    )
    assert (status, errors) == (0, "")
    columns = polygons.load(name)
    expected = cases.preserving(CURVES[method])(
        polygons.load_points(name), **({"parameters": columns["u"]} if "u" in columns else {})
    )
    names, rows = table(out)
    assert names == ["u", "x", "y", "z"]
    assert len(rows) == 20 * (len(expected.points) - 1) + 1
    np.testing.assert_array_equal(rows[:, 1:], expected(rows[:, 0]))
    plain = json.loads(report.read_text(encoding="utf-8"))
    assert plain == expected.check().to_dict()
    assert text == f"{expected.check()}\n"
    assert run("check", points, curve) == (0, text, "")


@pytest.mark.parametrize("method", FUNCTIONS)
@pytest.mark.parametrize("name", ["akima", "rpn14"])
def test_monotone_functions_on_real_files(method, name, run, tmp_path):
    points = polygons.DATA / f"{name}.csv"
    out, curve, report = tmp_path / "o.csv", tmp_path / "c.json", tmp_path / "r.json"
    status, text, errors = run(
        "fit", points, "--method", method, "-o", out, "-o", curve, "--report", report
    )
    assert (status, errors) == (0, "")
    columns = polygons.load(name)
    f = FUNCTIONS[method](columns["x"], columns["y"])
    names, rows = table(out)
    assert names == ["x", "y"]
    np.testing.assert_array_equal(rows[:, 1], f(rows[:, 0]))
    assert np.diff(rows[:, 1]).min() >= 0
    assert json.loads(report.read_text(encoding="utf-8"))["counts"] == {
        "monotonicity": {"violated": 0, "applicable": len(f.x) - 1}
    }
    assert run("check", points, curve) == (0, text, "")


def test_options_reach_the_curve(run, tmp_path):
    case = cases.gm_line()
    start, end = (",".join(map(str, v)) for v in polygons.GM_TANGENTS)
    curve = tmp_path / "c.json"
    status, _, errors = run(
        "fit", polygons.DATA / "gm_feature_line.csv", f"--start-tangent={start}",
        f"--end-tangent={end}", "--method=nu", "--strategy=nussp", "--step=0.5", "-o", curve,
    )  # fmt: skip
    assert (status, errors) == (0, "")
    tension = json.loads(curve.read_text(encoding="utf-8"))["tension"]
    # Karavelas & Kaklis 2000, Example 2.
    assert tension == [0.5] * 7 + [0] * 7 + [2] * 4 + [0] * 2
    assert tension == case.preserve(strategy="nussp").tension.tolist()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--method", "nu", "--tension", "2"], lambda p: ss.NuSpline(p, tension=2)),
        (["--parameters", "0.25"], lambda p: ss.FairSpline(p, 0.25)),
        (["--energy", "bending"], lambda p: ss.FairSpline(p, energy="bending")),
        (
            ["--method", "tension", "--tangent-scale", "0.4", "--boundary", "circular"],
            lambda p: ss.TensionSpline(p, boundary="circular", tangent_scale=0.4),
        ),
        (
            ["--method=catmull-rom", "--continuity=G1", "--safety=0.5", "--parameters=uniform"],
            lambda p: ss.CatmullRom.shape_preserving(p, "uniform", continuity="G1", safety=0.5),
        ),
    ],
)
def test_options_of_each_family(arguments, expected, run, tmp_path):
    out = tmp_path / "c.json"
    points = polygons.DATA / "protein_1a8o_ca.csv"
    run("fit", points, *arguments, "-o", out)
    control = json.loads(out.read_text(encoding="utf-8"))["control"]
    np.testing.assert_array_equal(control, expected(polygons.load_points(points.stem)).bezier)


def test_options_of_functions(run, tmp_path):
    columns = polygons.load("rpn14")
    out = tmp_path / "o.csv"
    for arguments, f in (
        (["--method=quintic", "--slopes=fritsch-butland", "--energy=parametric"],
         ss.MonotoneQuintic(columns["x"], columns["y"], slopes="fritsch-butland",
                            energy="parametric")),
        (["--method=cubic", "--ends=natural", "--layer=0", "--min-slope=0.1"],
         ss.MonotoneCubic(columns["x"], columns["y"], ends="natural", layer=0, min_slope=0.1)),
        (["--method=quartic", "--shape=1"],
         ss.MonotoneQuartic(columns["x"], columns["y"], shape=1.0)),
    ):  # fmt: skip
        assert run("fit", polygons.DATA / "rpn14.csv", *arguments, "-o", out)[0] == 0
        _, rows = table(out)
        np.testing.assert_array_equal(rows[:, 1], f(rows[:, 0]))


def test_samples_on_standard_output_and_by_arc_length(run, tmp_path):
    points = csv(tmp_path, "0,0\n1,1\n2,0\n3,1\n")
    status, out, errors = run("fit", points, "-o", "-", "--samples", "5", "--by", "arc-length")
    assert status == 0
    assert errors.startswith("shape preserved")
    names, *rows = out.splitlines()
    assert names == "x,y"
    rows = np.loadtxt(io.StringIO("\n".join(rows)), delimiter=",")
    curve = ss.fit([[0, 0], [1, 1], [2, 0], [3, 1]])
    np.testing.assert_array_equal(rows, curve.sample(5, by="arc-length"))


def test_a_shape_that_is_not_kept_is_status_1_and_still_written(run, tmp_path):
    points = polygons.DATA / "protein_1a8o_ca.csv"
    curve = tmp_path / "c.json"
    status, text, errors = run("fit", points, "--method=nu", "--tension", "0", "-o", curve)
    assert (status, errors) == (1, "")
    assert text.startswith("shape violated on 69 segments\n")
    assert run("check", points, curve)[0] == 1
    # The limit of iterations: the last curve, its report, and why.
    for method in ("fair", "nu", "tension"):
        status, text, errors = run(
            "fit", points, "--method", method, "--max-iterations", "1", "-o", curve
        )
        assert status == 1
        assert text.startswith("shape violated")
        assert len(errors.splitlines()) == 1
        assert "iteration" in errors
        assert run("check", points, curve)[0] == 1


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
@pytest.mark.parametrize(("method", "name"), [("fair", "gm_feature_line"), ("quintic", "akima")])
def test_figures(ending, method, name, run, tmp_path):
    points = polygons.DATA / f"{name}.csv"
    first, second = (tmp_path / f"{i}.{ending}" for i in "ab")
    for path in (first, second):
        assert run("fit", points, "--method", method, "--plot", path)[0] == 0
    if ending == "png":
        pixels = image.imread(first)
        assert min(pixels.shape[:2]) > 600
        assert pixels.std() > 0.05
    # The same file from the same input: a figure under version control does not change by itself.
    assert first.read_bytes() == second.read_bytes()


# Tables as they come


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("x [mm],y [mm]\n0,0\n1,2\n2,0\n", ["x [mm]", "y [mm]"]),
        ("x (mm);y (mm)\n0;0\n1;2\n2;0\n", ["x (mm)", "y (mm)"]),
        ("# survey of 1999\nX/m\tY/m\n\n0\t0\n1\t2\n2\t0\n", ["X/m", "Y/m"]),
        ("x,y\nmm,mm\n0,0\n1,2\n2,0\n", ["x [mm]", "y [mm]"]),
        ("x y\n[m] [m]\n0 0\n1 2\n2 0\n", ["x [m]", "y [m]"]),
        ("x [mm] y [mm]\n0 0\n1 2\n2 0\n", ["x[mm]", "y[mm]"]),
        ("name;y [m];x [m]\nA;0;0\nB;2;1\nC;0;2\n", ["x [m]", "y [m]"]),
        ("0 0\n1 2\n2 0\n", ["x", "y"]),
    ],
)
def test_units_and_names_are_kept(text, names, run, tmp_path):
    out = tmp_path / "o.csv"
    status, _, errors = run("fit", csv(tmp_path, text), "-o", out, "--samples", "3")
    assert (status, errors) == (0, "")
    found, rows = table(out)
    assert found == ["u", *names]
    np.testing.assert_allclose(rows[:, 1:], [[0, 0], [1, 2], [2, 0]], atol=1e-12)
    # What is written is read back: points with their parameters.
    again = tables.read_points(out)
    np.testing.assert_array_equal(again.points, rows[:, 1:])
    np.testing.assert_array_equal(again.parameters, rows[:, 0])


def test_columns_by_name_and_number(run, tmp_path):
    text = "time [s],lon,lat,ele [m]\n0,1,2,3\n1,2,2,3\n2,2,3,4\n"
    points = csv(tmp_path, text)
    out = tmp_path / "o.csv"
    for columns, names in (
        ("lon,lat", ["lon", "lat"]),
        ("3, 2", ["lat", "lon"]),
    ):
        assert run("fit", points, "--columns", columns, "-o", out)[0] == 0
        assert table(out)[0] == ["u", *names]
    assert run("fit", points, "--method=quintic", "--columns", "time,ele", "-o", out)[0] == 0
    names, rows = table(out)
    assert names == ["time [s]", "ele [m]"]
    np.testing.assert_array_equal(rows[[0, -1]], [[0, 3], [2, 4]])


@pytest.mark.parametrize("text", ["t,level\n0,1\n1,2\n", "0 1\n1 2\n", "u;y\n0;1\n1;2\n"])
def test_a_function_takes_its_two_columns_whatever_they_are_called(text, run, tmp_path):
    assert run("fit", csv(tmp_path, text), "--method", "quintic")[0] == 0


# Bad input: one line, exit status 2


@pytest.mark.parametrize(
    ("text", "arguments", "line", "what"),
    [
        ("x,y\n0,0\n1,1\n1,1\n", [], 4, "points[2] repeats points[1]"),
        ("x,y\n0,0\n1,1\n1,2\n", ["--method=quintic"], 4, "x must be strictly increasing"),
        ("# c\n0 0\n\n1 1\n0.5 2\n", ["--method=quartic"], 5, "x must be strictly increasing"),
        ("u,x,y\n0,0,0\n2,1,1\n1,2,3\n", [], 4, "parameters[2]"),
        ("x,y\n0,0\n1,12 mm\n", [], 3, "'12 mm' in column y is not a number"),
        ("x,y\nmm,mm\n0,0\nmm,mm\n", [], 4, "'mm' in column x [mm] is not a number"),
        ("x,y\none,two\n0,0\n", [], 2, "'one' in column x is not a number"),
        ("x,y\n0,inf\n", [], 2, "'inf' in column y is not finite"),
        ("a,b,c,d\n1,2,3,4\n", [], 1, "the header must name columns x, y"),
        ("a,b\n0,0\n1,1\n", ["--columns", "a,c"], 1, "there is no column 'c'"),
        ("0,0\n1,1\n", ["--columns", "1,3"], 1, "there is no column '3'"),
        ("x,y,z\n0,0,0\n1,1,1\n", ["--method=quintic", "--columns", "1,2,3"], None, "two columns"),
        ("0,0,0\n1,1,1\n", ["--method=quintic"], 1, "a function has two columns, got 3"),
        ("0,0\n", [], None, "at least 2 points"),
        ("0,0\n", ["--method=quintic"], None, "at least 2"),
        ("", [], None, "holds no points"),
        ("0,0\n1,1\n2,2\n", ["--boundary", "periodic"], 3, "points[2]"),
    ],
)  # fmt: skip
def test_bad_points(text, arguments, line, what, run, tmp_path):
    path = csv(tmp_path, text)
    out = tmp_path / "o.csv"
    status, printed, errors = run("fit", path, *arguments, "-o", out)
    assert (status, printed) == (2, "")
    assert len(errors.splitlines()) == 1, errors
    assert what in errors
    assert not out.exists()
    if line:
        assert errors.startswith(f"shapespline: {path}, line {line}: ")


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--safety", "0.5"], "--safety is no option of method fair; its options are --parameters"),
        (["--tension", "1"], "methods that have it: nu, catmull-rom"),
        (["--method=quintic", "--tension", "1"], "--tension is no option of method quintic"),
        (["--method=nu", "--tension", "-1"], "tension"),
        (["--method=nu", "--tension", "1", "--step", "1"], "--step is for a search"),
        (["--coplanarity", "2"], "coplanarity"),
        (["--criteria", "beauty"], "criteria must be one of"),
        (["--parameters", "chordial"], "parameters must be"),
        (["--samples", "1"], "--samples must be at least 2"),
        (["--start-tangent", "1,0,0", "--boundary", "natural"], "go without --boundary"),
        (["--start-tangent=1,0,0", "--end-tangent=0,0,1"], "start"),
        (["--plot", "o.gif"], "o.gif: the ending must be one of .png, .svg, .pdf"),
        (["--method=quintic", "--by", "arc-length", "-o", "-"], "--by arc-length is for curves"),
        (["-o", "o.xls"], "o.xls: the ending must be"),
        (["-o", "no/such/place.csv"], "no/such/place.csv: cannot be written: No such file"),
        (["-o", "no/such/place.json"], "no/such/place.json: cannot be written: No such file"),
        (["--plot", "no/such/place.png"], "no/such/place.png: cannot be written: No such file"),
    ],
)
def test_bad_options(arguments, what, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, _, errors = run("fit", csv(tmp_path, "0,0\n1,1\n2,3\n"), *arguments)
    assert status == 2
    assert len(errors.splitlines()) == 1
    assert what in errors


def test_arguments_that_argparse_refuses(tmp_path):
    for arguments in (
        ["--method", "quadratic"],
        ["--boundary", "loose"],
        ["--start-tangent", "up"],
    ):
        done = subprocess.run(
            [COMMAND, "fit", csv(tmp_path, "0,0\n1,1\n"), *arguments],
            capture_output=True, text=True, check=False, timeout=60,
        )  # fmt: skip
        assert done.returncode == 2
        assert "Traceback" not in done.stderr


@pytest.mark.parametrize("out", [[], ["-o", "-"]])
def test_nobody_reads_the_output(tmp_path, out):
    """As `shapespline fit … | head -1` may end: no traceback."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            [COMMAND, "fit", csv(tmp_path, "0,0\n1,1\n2,0\n"), *out],
            stdout=write, stderr=subprocess.PIPE, text=True, check=False, timeout=60,
        )  # fmt: skip
    finally:
        os.close(write)
    assert done.returncode == 141
    assert "Traceback" not in done.stderr
    assert "Exception" not in done.stderr


# Progress


class Terminal(io.StringIO):
    """Standard error of somebody who is looking."""

    def isatty(self):
        return True


def test_long_work_shows_that_it_goes_on(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with progress.progress("fitting", after=0.0, every=0.01):
        time.sleep(0.2)
    text = terminal.getvalue()
    assert text.count("fitting … 0 s") >= 2
    assert re.search(r"\r +\r$", text), "the line is wiped at the end"


def test_short_work_and_files_stay_clean(monkeypatch):
    terminal, file = Terminal(), io.StringIO()
    for place in (terminal, file):
        monkeypatch.setattr(sys, "stderr", place)
        with progress.progress("fitting"):
            pass
    with progress.progress("fitting", after=0.0):
        pass
    assert terminal.getvalue() == file.getvalue() == ""
