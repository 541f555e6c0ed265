# SPDX-License-Identifier: MIT OR Apache-2.0

"""shapespline check: verdicts by exit status, files of many kinds, one line for what is wrong."""

import json
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, make_interp_spline

import cases
import polygons
import shapespline as ss
from shapespline import _cli
from shapespline._cli import files, tables

DOCS = Path(__file__).parent.parent / "python" / "docs"


@pytest.fixture
def run(capsys):
    """Return a function that runs the command line and returns status, output and errors."""

    def call(*arguments):
        status = _cli.main([str(a) for a in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return call


@pytest.fixture
def points(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text("x,y\n0,0\n1,1\n2,0\n3,1\n", encoding="utf-8")
    return path


def write(path, entries):
    path.write_text(entries if isinstance(entries, str) else json.dumps(entries), encoding="utf-8")
    return path


@pytest.fixture
def curve(tmp_path):
    path = tmp_path / "curve.json"
    files.write_curve(path, ss.NuSpline([[0, 0], [1, 1], [2, 0], [3, 1]]))
    return path


# Verdicts


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_what_is_written_is_judged_as_the_curve_itself(case, run, tmp_path):
    """0 where the shape holds, 1 where it does not; the same report, to the last bit."""
    csv, file, out = tmp_path / "p.csv", tmp_path / "c.json", tmp_path / "r.json"
    names = "x,y,z"[: 2 * case.points.shape[1] - 1]
    np.savetxt(csv, case.points, delimiter=",", header=names, comments="", fmt="%.17g")
    for made, expected in ((case.fit(), None), (case.preserve(), 0)):
        files.write_curve(file, made)
        own = made.check()
        status, text, errors = run("check", csv, file, "--report", out)
        assert errors == ""
        assert status == (0 if own.ok else 1)
        assert expected is None or status == expected
        found = json.loads(out.read_text(encoding="utf-8"))
        assert {k: found["counts"][k] for k in found["counts"]} == own.to_dict()["counts"]
        assert [(v["segment"], v["criterion"]) for v in found["violations"]] == [
            (v.segment, v.criterion) for v in own.violations
        ]
        assert text.startswith("shape preserved" if own.ok else "shape violated")


@pytest.mark.parametrize("repeats", [False, True], ids=["plain", "repeated"])
@pytest.mark.parametrize("method", ["nu", "tension", "catmull-rom"])
def test_closed_and_repeated_points(method, repeats, run, tmp_path):
    """The fit is that of Python; a check of its file needs no option, and one of another does."""
    csv, file, other = tmp_path / "p.csv", tmp_path / "c.json", tmp_path / "other.json"
    rows = polygons.random_walk(np.random.default_rng(5), 9, 3)
    given = rows.repeat([1, 2, 1, 1, 3, 1, 1, 1, 1], axis=0) if repeats else rows
    np.savetxt(csv, given, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    closed = ["--closed", *(["--repeated", "drop"] if repeats else [])]
    assert run("fit", csv, "--method", method, *closed, "-o", file)[0] == 0
    entries = json.loads(file.read_text(encoding="utf-8"))
    family = {"nu": ss.NuSpline, "tension": ss.TensionSpline, "catmull-rom": ss.CatmullRom}[method]
    expected = family.shape_preserving(rows, closed=True)
    np.testing.assert_array_equal(entries["control"], expected.bezier)
    assert len(entries["parameters"]) == len(given) + 1
    assert run("check", csv, file)[0] == 0
    write(other, {key: entries[key] for key in ("control", "breaks", "boundary")})
    status, _, errors = run("check", csv, other)
    assert status == 2
    assert ("10 breaks, but there are 12" if repeats else "pass closed=True") in errors
    assert run("check", csv, other, *closed)[0] == 0


def test_functions_are_not_closed(run, points):
    status, _, errors = run("fit", points, "--method", "quartic", "--closed")
    assert status == 2
    assert "--closed is no option of method quartic" in errors


def test_an_undecided_shape_is_not_kept(run, tmp_path):
    csv = write(tmp_path / "p.csv", "0 0 0\n1 0 0\n1 1 0\n0 1 1\n")
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]])
    control = [np.linspace(p, q, 6).tolist() for p, q in pairwise(corners)]
    file = write(tmp_path / "c.json", {"parameters": [0, 1, 2, 3], "control": control})
    status, _, errors = run("check", csv, file, "--criteria", "torsion")
    assert (status, errors) == (1, "")


def test_options(run, points, curve):
    assert run("check", points, curve, "--criteria", "inflection, global-convexity")[0] == 0
    assert run("check", points, curve, "--boundary", "circular")[0] in (0, 1)
    status, _, errors = run("check", points, curve, "--criteria", "beauty")
    assert status == 2
    assert "criteria must be one of" in errors
    status, _, errors = run("check", points, curve, "--tolerance", "2")
    assert status == 2
    assert errors == "shapespline: tolerance must be in [0, 1), got 2\n"


# Files of curves


def test_every_type_of_curve(run, tmp_path):
    data = polygons.load_points("protein_1a8o_ca")
    u = np.arange(70.0)
    csv = tmp_path / "p.csv"
    np.savetxt(csv, data)
    cubic = CubicSpline(u, data, bc_type="natural")
    spline = make_interp_spline(u, data, k=3, bc_type="natural")
    written = {
        "power": {"type": "power", "breaks": u.tolist(), "coefficients": cubic.c.tolist()},
        "bspline": {"degree": 3, "knots": spline.t.tolist(), "control": spline.c.tolist()},
        "bezier": {
            "parameters": u.tolist(),
            "control": ss._convert.piecewise(cubic).control.tolist(),
        },
    }
    expected = ss.check_shape(data, cubic)
    for kind, entries in written.items():
        status, text, errors = run("check", csv, write(tmp_path / f"{kind}.json", entries))
        assert (status, errors) == (1, ""), kind
        assert text == f"{expected}\n", kind


def test_a_nurbs_curve_in_a_file(run, tmp_path):
    csv = write(tmp_path / "p.csv", "1 0\n0 1\n-1 0\n0 -1\n1 0\n")
    half = 0.5**0.5
    circle = {
        "type": "bspline",
        "degree": 2,
        "knots": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
        "control": [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]],
        "weights": [1, half, 1, half, 1, half, 1, half, 1],
    }
    status, text, errors = run("check", csv, write(tmp_path / "c.json", circle))
    assert (status, errors) == (0, "")
    assert re.search(r"convexity +0 +4", text)
    # Without its weights it is another curve.
    del circle["weights"]
    assert run("check", csv, write(tmp_path / "c.json", circle))[0] == 0
    assert files.read_curve(tmp_path / "c.json").curve(0.5)[0] != pytest.approx(half)


def test_written_curves_come_back(tmp_path):
    file = tmp_path / "c.json"
    original = cases.gm_line().preserve()
    files.write_curve(file, original)
    again = files.read_curve(file)
    np.testing.assert_array_equal(again.curve.control, original.bezier)
    np.testing.assert_array_equal(again.parameters, original.parameters)
    assert again.boundary == original.boundary
    rational = ss.PiecewiseBezier([[[0, 0], [1, 1]]], [0, 1], weights=[[1, 2]])
    files.write_curve(file, rational)
    np.testing.assert_array_equal(files.read_curve(file).curve.weights, [[1, 2]])


# Tables of points

EXPECTED = np.array([[0.0, 0.5], [1.0, 1.25], [2.0, -3e-2]])


@pytest.mark.parametrize(
    "text",
    [
        "0,0.5\n1,1.25\n2,-3e-2\n",
        "0 0.5\n1\t 1.25\n2   -0.03",
        "0\t0.5\n1\t1.25\n2\t-0.03\n",
        "0;0,5\n1;1,25\n2;-3,0e-2\n",
        "0;0.5\r\n1;1.25\r\n2;-3e-2\r\n",
        "\ufeffx,y\n0,0.5\n1,1.25\n2,-3e-2\n",
        "# a comment\n\nX , Y\n0, .5\n\n% another\n1, 1.25\n2, -3e-2\n",
        '"x","y"\n"0","0.5"\n"1","1.25"\n"2","-3e-2"\n',
        "name;y;x\na;0.5;0\nb;1,25;1\nc;-3e-2;2\n",
        "lon,lat\n0,0.5\n1,1.25\n2,-3e-2\n",
        "x y\n0 0.5\n1 1.25\n2 -3e-2\n",
    ],
)
def test_tables(text, tmp_path):
    path = tmp_path / "p.csv"
    path.write_bytes(text.encode())
    found = tables.read_points(path)
    np.testing.assert_array_equal(found.points, EXPECTED)
    assert found.parameters is None


def test_a_table_with_parameters(run, tmp_path):
    found = tables.read_points(polygons.DATA / "gm_feature_line.csv")
    np.testing.assert_array_equal(found.points, polygons.load_points("gm_feature_line"))
    np.testing.assert_array_equal(found.parameters, polygons.load("gm_feature_line")["u"])
    # A quintic has fewer breaks than points: the column says where they are.
    quintic = make_interp_spline(found.parameters, found.points, k=5)
    entries = {"degree": 5, "knots": quintic.t.tolist(), "control": quintic.c.tolist()}
    file = write(tmp_path / "c.json", entries)
    status, _, errors = run("check", polygons.DATA / "gm_feature_line.csv", file)
    assert (status, errors) == (1, "")


# Bad input: one line, with file and line


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("x,y\n0,0\n1,one\n", 3, "'one' in column y is not a number"),
        ("0,0\n1,nan\n", 2, "'nan' in column 2 is not finite"),
        ("0,0\n1,1,1\n", 2, "2 columns expected, got 3"),
        ("# c\n\nx,y\n0,0\n1\n", 5, "2 columns expected, got 1"),
        ("0,0,0,0\n", 1, "got 4 columns without a header"),
        ("a,b,c,d\n0,0,0,0\n", 1, "the header must name columns x, y"),
        ("x,x,y\n0,0,0\n", 1, "two columns are called 'x'"),
        ("x,q\n0,0\n", 1, "the header must name"),
        ("0,0\n1,\n", 2, "'' in column 2 is not a number"),
        ("0,0\n1,1\n1,1\n3,1\n", 3, "points[2] repeats points[1]"),
        ("u,x,y\n0,0,0\n1,1,1\n1,2,0\n3,3,1\n", 4, "parameters[2] = 1 does not exceed"),
        ("0,0\n1,1\n2,9\n3,1\n", 3, "does not pass through points[2]"),
        ("0,0\n", None, "there are 1 points"),
        ("", None, "holds no points"),
        ("# nothing\nx,y\n", None, "holds no points"),
    ],
)
def test_bad_points(text, line, what, run, tmp_path, curve):
    entries = json.loads(curve.read_text(encoding="utf-8"))
    if text.startswith("u,") or what.startswith("there"):
        del entries["parameters"], entries["boundary"]
        write(curve, entries)
    path = write(tmp_path / "bad points.csv", text)
    status, out, errors = run("check", path, curve)
    assert status == 2
    assert out == ""
    assert len(errors.splitlines()) == 1
    assert what in errors
    if line:
        assert errors.startswith(f"shapespline: {path}, line {line}: ")


CONTROL = [[[0, 0], [1, 1], [2, 0]]]


@pytest.mark.parametrize(
    ("entries", "line", "what"),
    [
        ('{"type": "bezier",\n "control": [[[0, 0],]]}', 2, "is not JSON"),
        ("[1, 2]", None, "must hold one JSON object"),
        ("", 1, "is not JSON"),
        ('{\n "type": "circle"}', 2, "'type' must be 'bezier', 'bspline' or 'power', got 'circle'"),
        ({"control": CONTROL}, None, "has no entry 'parameters'"),
        (
            '{"parameters": [0, 1],\n\n "control": [[[0, 0], [1]]]}',
            3,
            "rows have different lengths",
        ),
        ('{"parameters": [0, 1],\n "control": [[["0", 0], [1, 1]]]}', 2, "must hold numbers only"),
        ('{\n"breaks": [0, 0],\n"control": [[[0, 0], [1, 1]]]}', 2, "must be strictly increasing"),
        (
            '{"breaks": [0, 1],\n"control": [[[0, 0], [NaN, 1]]]}',
            2,
            "control[0, 1, 0] must be finite",
        ),
        ({"breaks": [0, 1], "control": CONTROL, "weights": [[1, 0, 1]]}, 1, "must be positive"),
        ({"knots": [0, 0, 1, 1], "control": [[0, 0], [1, 1]]}, None, "'degree' must be an integer"),
        (
            {"knots": [0, 1], "control": [[0, 0], [1, 1]], "degree": 1},
            1,
            "knots must have length 4",
        ),
        (
            {"knots": [0, 1], "control": [[0, 0], [1, 1]], "degree": -1},
            1,
            "degree must be at least 1",
        ),
        ({"breaks": [0, 1], "control": CONTROL, "boundary": 3}, 1, "'boundary' must be a name"),
        (
            {"breaks": [0, 1], "control": CONTROL, "boundary": {"start": [0, 0], "end": [1, 1]}},
            1,
            "start must not be the zero vector",
        ),
        ({"breaks": [0, 1], "control": CONTROL}, None, "parameters must be given: the curve has 2"),
        ({"breaks": [0, 1], "control": [[[0, 0, 0], [1, 1, 1]]]}, None, "the curve has 3"),
        (
            {"breaks": [0, 1, 2, 3], "control": CONTROL * 3, "boundary": "loose"},
            None,
            "boundary must",
        ),
        (
            {"parameters": [0, 1, 2, 3], "breaks": [0, 1], "control": CONTROL},
            None,
            "outside the curve",
        ),
    ],
)
def test_bad_curves(entries, line, what, run, tmp_path, points):
    path = write(tmp_path / "bad curve.json", entries)
    status, out, errors = run("check", points, path)
    assert status == 2
    assert out == ""
    assert len(errors.splitlines()) == 1
    assert what in errors
    assert errors.startswith(f"shapespline: {path}" + (f", line {line}: " if line else ": "))


def test_files_that_cannot_be_read(run, tmp_path, points, curve):
    missing = tmp_path / "missing.csv"
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"0,0\n\xff\xfe\x00\n")
    for arguments, what in (
        ((missing, curve), f"{missing}: cannot be read: No such file or directory"),
        ((points, missing), f"{missing}: cannot be read: No such file or directory"),
        ((tmp_path, curve), f"{tmp_path}: cannot be read"),
        ((binary, curve), f"{binary}, line 2: is not text in UTF-8"),
        ((points, curve, "--report", tmp_path / "no" / "r.json"), "cannot be written"),
    ):
        status, _, errors = run("check", *arguments)
        assert status == 2
        assert len(errors.splitlines()) == 1
        assert what in errors


# The documentation


def test_the_examples_of_the_page_on_files(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (DOCS / "files.md").read_text(encoding="utf-8")
    fence = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    blocks = dict(fence.findall(text))
    write(tmp_path / "arc.json", blocks["json"])
    write(tmp_path / "arc.csv", "1 0\n0 1\n")
    assert run("check", "arc.csv", "arc.json")[0] == 0
    found = tables.read_points(write(tmp_path / "p.csv", blocks[""]))
    assert found.points.shape == (2, 3)
    exec(blocks["python"], {})
    write(tmp_path / "p.csv", "0 0\n1 2\n3 2\n4 0\n")
    assert run("check", "p.csv", "curve.json")[0] == 0
