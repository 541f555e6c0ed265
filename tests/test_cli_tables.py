# SPDX-License-Identifier: MIT OR Apache-2.0

"""Tables as people and their programs write them are read, or refused in one line; never wrong."""

import csv
import io
import json
import os
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import shapespline as ss
from scale import scaled
from shapespline import _cli
from shapespline._cli import fit, tables
from shapespline._cli.text_io import FileError

EXPECTED = np.array([[0.0, 0.5], [1.0, 1.25], [2000.0, -0.03]])


@pytest.fixture
def run(capsys):
    """Return a function that runs the command line and returns status, output and errors."""

    def call(*arguments):
        status = _cli.main([str(a) for a in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return call


def write(path, text, encoding="utf-8"):
    path.write_bytes(text.encode(encoding))
    return path


# What a person could read


@pytest.mark.parametrize(
    "text",
    [
        # Excel says what separates cells.
        "sep=;\nx;y\n0;0,5\n1;1,25\n2000;-0,03\n",
        '"sep=;"\n0;0,5\n1;1,25\n2000;-0,03\n',
        # Thousands between blanks, narrow ones, and apostrophes.
        "x;y\n0;0,5\n1;1,25\n2 000;-0,03\n",
        "x;y\n0;0.5\n1;1.25\n2\u202f000;\u22120.03\n",
        "0\t0.5\n1\t1.25\n2'000.0\t-0.03\n",
        "0 0,5\n1 1,25\n2\u00a0000 -0,03\n",
        "x\ty\tname\n0\t0.5\t\n1\t1.25\tb\n2000\t-0.03\t\n",
        "\tx\ty\n\t0\t0.5\na\t1\t1.25\n\t2000\t-0.03\n",
        "x y\n0 0.5\t\n1 1.25\n2000 -0.03\n",
        # Fortran.
        "0.0D+00 5.0D-01\n1.0d0 1.25D0\n2.0D+03 -3.0D-02\n",
        # Comments, also at the top; a title; a commented header, also with other columns.
        "// from the mill\n0,0.5\n// half\n1,1.25\n2000,-3e-2\n",
        "Survey of 1999\nx,y\n0,0.5\n1,1.25\n2000,-3e-2\n",
        "Survey of Mt Blanc\n\n0 0.5\n1 1.25\n2000 -0.03\n",
        '"Survey, 2nd part"\nx;y\n0;0,5\n1;1,25\n2000;-0,03\n',
        "# name t1 x y\na 9 0 0.5\nb 9 1 1.25\nc 9 2000 -0.03\n",
        "#x,y,t1,t2\n0,0.5,7,7\n1,1.25,7,7\n2000,-0.03,7,7\n",
        "x y\n0,0.5\n1,1.25\n2000,-0.03\n",
        # Quoted cells: separators, decimal commas and line breaks within them.
        '"0","0,5"\n"1","1,25"\n"2000","-0,03"\n',
        '"no, really";"x\n[mm]";"y\n[mm]"\n"a;b";0;0,5\n"c";1;1,25\n"""d""";2000;-0,03\n',
        '"x" , "y"\n"0" , 0.5\n 1, "1.25" \n2000,-0.03\n',
        'name,x,y\n5" pipe,0,0.5\nit\'s,1,1.25\n"say ""x""",2000,-0.03\n',
        '"x" "y"\n0 0.5\n1 1.25\n2000 -0.03\n',
        # Decimal commas between blanks.
        "0,0 0,5\n1,0 1,25\n2000,0 -0,03\n",
        # Line ends and trailing separators.
        "x,y\r0,0.5\r1,1.25\r2000,-0.03\r",
        "0,0.5,\n1,1.25,\n2000,-0.03,\n",
        "x,y,\n0,0.5,\n1,1.25,\n2000,-0.03,\n",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_tables_that_a_person_can_read(text, encoding, tmp_path):
    found = tables.read_points(write(tmp_path / "p.csv", text, encoding))
    np.testing.assert_array_equal(found.points, EXPECTED)
    assert found.parameters is None


def test_names_in_the_code_page_of_windows(tmp_path):
    found = tables.read_points(write(tmp_path / "p.csv", "x [µm];y [µm]\n0;1\n1;2\n", "cp1252"))
    assert found.names == ["x [µm]", "y [µm]"]


@pytest.mark.parametrize(
    "text", ["u;x;y\n0;0;1\n2;1;1\n3;2;2\n", "x,time [s],y\n0,0,1\n1,2,1\n2,3,2\n",
             "time,lon,lat\n0,0,1\n2,1,1\n3,2,2\n", "t y x\n0 1 0\n2 1 1\n3 2 2\n"],
)  # fmt: skip
def test_a_column_of_parameters(text, tmp_path):
    found = tables.read_points(write(tmp_path / "p.csv", text))
    np.testing.assert_array_equal(found.parameters, [0, 2, 3])
    np.testing.assert_array_equal(found.points, [[0, 1], [1, 1], [2, 2]])


@given(
    rows=st.lists(
        st.tuples(*[st.floats(-1e9, 1e9, allow_subnormal=False)] * 3), min_size=2, max_size=5
    ),
    name=st.text(max_size=6),
    separator=st.sampled_from([",", ";", "\t"]),
    quoting=st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]),
    comma=st.booleans(),
)
def test_what_csv_writes_is_read(rows, name, separator, quoting, comma, tmp_path_factory):
    """Any names, any quoting, decimal commas: the numbers to the last bit, or one line."""
    out = io.StringIO()
    writer = csv.writer(out, delimiter=separator, quoting=quoting)
    writer.writerow(["x", "y", "z", "name"])
    for row in rows:
        texts = [repr(value) for value in row]
        writer.writerow([*(t.replace(".", ",") if comma else t for t in texts), name])
    path = tmp_path_factory.mktemp("csv") / "p.csv"
    path.write_text(out.getvalue(), encoding="utf-8", newline="")
    try:
        found = tables.read_points(path).points
    except FileError:
        # "1,234" between commas may be a thousand.
        assert comma
        assert separator == ","
    else:
        np.testing.assert_array_equal(found, rows)


# What is refused


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("x,y\n1_0,2\n3,4\n", 2, "'1_0' in column x is not a number"),
        ("0,0\n１,2\n", 2, "'１' in column 1 is not a number"),
        ("0,0\n٣,2\n", 2, "'٣' in column 1 is not a number"),
        ("0,0\n0x1,2\n", 2, "'0x1' in column 1 is not a number"),
        ("0,0\n1e999,2\n", 2, "'1e999' in column 1 is not finite"),
        ('1,"1,234"\n2,"2,345"\n', 1, "'1,234' in column 2 is not a number"),
        ("x [mm],y [m]\n0,0\n1,1\n", 1, "columns x [mm], y [m] mix m and mm"),
        ("x,y\nmm,m\n0,0\n1,1\n", 1, "mix m and mm"),
        ("x/in,y/ft,z\n0,0,0\n1,1,1\n", 1, "mix ft and in"),
        ("lon,lat,ele\n9,45,100\n9.1,45,120\n", 1, "columns lon, lat, ele mix degrees and lengths"),
        ("Lon [°],Lat [°],h [m]\n9,45,100\n9.1,45,120\n", 1, "mix degrees and lengths"),
        ("0,0,0,0\n1,1,1,1\n", 1, "choose with --columns, as in --columns 1,2"),
        ("# a b c d\n0 0 0 0\n1 1 1 1\n", 2, "choose with --columns"),
        ("a,b,c,d\n0,0,0,0\n", 1, "or choose others with --columns"),
        ('x,y\n0,"0\n1,1\n', 2, "quotes that do not end"),
        ("x,y\n0,0,0\n1,1,1\n", 2, "2 columns expected, got 3"),
        ("0.5,abc\n1,2,3\n2,3,4\n", 2, "2 columns expected, got 3"),
        ("t,t,x,y\n0,0,0,0\n", 1, "two columns are called 't'"),
    ],
)
def test_tables_that_nobody_can_read(text, line, what, run, tmp_path):
    path = write(tmp_path / "p.csv", text)
    status, out, errors = run("fit", path)
    assert (status, out) == (2, "")
    assert errors.startswith(f"shapespline: {path}, line {line}: "), errors
    assert errors.count("\n") == 1
    assert what in errors
    again = run("check", path, write(tmp_path / "c.json", '{"control": [[[0, 0], [1, 1]]]}'))
    assert again[0] == 2


def test_decimal_commas_between_blanks_are_not_thousands(tmp_path):
    found = tables.read_points(write(tmp_path / "p.csv", "0,500 1,250\n1,500 2,250\n"))
    np.testing.assert_array_equal(found.points, [[0.5, 1.25], [1.5, 2.25]])


@pytest.mark.parametrize("columns", ["²,1", "1,٣", "9" * 5000 + ",1", "1,0", "x,q"])
def test_columns_that_are_not_there(columns, run, tmp_path):
    path = write(tmp_path / "p.csv", "x,y\n0,0\n1,1\n")
    status, _, errors = run("fit", path, "--columns", columns)
    assert status == 2
    assert errors.startswith(f"shapespline: {path}, line 1: there is no column '")
    assert errors.count("\n") == 1
    assert len(errors) < 600 + len(str(path))


#: enough for quadratic time to show
MANY = max(20_000, scaled(200_000))

HOSTILE = {
    "header with many inner blanks": "x" + " " * 100_000 + "x,y\n0,0\n1,1\n",
    "brackets that never end": "x" + " [(" * 50_000 + ",y\n0,0\n1,1\n",
    "blanks before a bracket": ("x" + " " * 1000 + "[") * 100 + " y\n0 0\n1 1\n",
    "a cell of 10 MB": "x,y\n0," + "9a" * 5_000_000 + "\n",
    "a name of 10 MB": "a,b,c," + "d" * 10_000_000 + "\n0,0,0,0\n1,1,1,1\n",
    "columns": ",".join("ab" for _ in range(MANY)) + "\n" + ",".join("0" * MANY),
    "digits with commas": "0,0\n" + "1," * 100_000 + "1\n",
    "a number of many digits": "x,y\n0," + "1" * 100_000 + "\n1,1\n",
    "digits that end in a letter": "x,y\n0," + "1" * 100_000 + "x\n1,1\n",
    "groups of thousands": "x;y\n0;1" + " 000" * 100_000 + "x\n1;1\n",
    "quotes": "x,y\n" + '"' * 100_001 + ",0\n",
    "quotes and blanks": "x,y\n" + ('"' + " " * 300 + "a") * 300 + ",0\n",
    "many quotes between blanks": "x y\n" + '" ' * 50_000 + '"\n',
    "titles": "a word\n" * MANY + "x,y\n0,0\n1,1\n",
    "comments": "# a comment, with cells\n" * MANY + "0,0,0,0\n1,1,1,1\n",
    "no line with numbers": "x, y and z\n" * MANY,
    "empty lines": "\n" * MANY + "0,0\n" + "\n" * MANY + "1,1\n",
    "nested brackets of JSON": "[" * 1_000_000,
    "an integer of JSON": '{"control": [[[0, 0], [1, ' + "1" * 5000 + "]]]}",
    "an integer of JSON as degree": '{"knots": [0, 1], "control": [[0, 0]], "degree": 1'
    + "0" * 5000
    + "}",
    "a version of JSON": '{"version": 1' + "0" * 5000 + "}",
    "a format of JSON": '{"format": "' + "x" * 10_000_000 + '"}',
    "many entries of JSON": "{"
    + ",".join(f'"{i}": 0' for i in range(MANY))
    + ', "1": 0, "control": 0}',
}


@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.parametrize("command", ["fit", "fit --method quintic", "check points", "check curve"])
def test_hostile_files_take_linear_time_and_one_short_line(name, command, run, tmp_path):
    good = write(tmp_path / "good.csv", "0,0\n1,1\n")
    curve = write(tmp_path / "good.json", '{"breaks": [0, 1], "control": [[[0, 0], [1, 1]]]}')
    hostile = write(tmp_path / "hostile", HOSTILE[name])
    verb, *rest = command.split()
    files = {"points": [hostile, curve], "curve": [good, hostile]}
    arguments = files[rest[0]] if verb == "check" else [hostile, *rest]
    start = time.process_time()
    status, _, errors = run(verb, *arguments)
    assert time.process_time() - start < 4 * MANY / 20_000
    assert status in (0, 1, 2)
    assert errors.count("\n") == (status == 2) or "empty lines" in errors
    assert len(errors) < 600 + len(str(tmp_path)), errors[:1000]


# Options


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--samples", "1" + "0" * 30], "argument --samples: must be an integer"),
        (["--samples", "1" + "0" * 5000], "argument --samples: must be an integer"),
        (["--samples", "1_0"], "argument --samples: must be an integer"),
        (["--samples", "٣"], "argument --samples: must be an integer"),
        (["--tension", "1_0"], "argument --tension: must be a number"),
        (["--tension", "１"], "argument --tension: must be a number"),
        (["--tension", "x" * 10_000], "argument --tension: must be a number"),
        (["--start-tangent", "1_0,1"], "argument --start-tangent: must be numbers"),
        (["--method", "q" * 10_000], "argument --method: invalid choice"),
        (["--no-such-option"], "unrecognized arguments"),
    ],
)
def test_arguments_are_refused_in_one_line(arguments, what, tmp_path, capsys):
    with pytest.raises(SystemExit) as caught:
        _cli.main(["fit", str(write(tmp_path / "p.csv", "0,0\n1,1\n")), *arguments])
    assert caught.value.code == 2
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    assert what in errors
    assert len(errors) < 600


FLAGS = [action.option_strings[-1] for action in _cli._parser()._actions[-1].choices["fit"]._actions
         if action.option_strings and action.dest not in ("help", "plot")]  # fmt: skip
VALUES = [
    "0", "1", "-1", "0.5", "nan", "inf", "1e308", "1e-320", "1,0", "1,0,0", "0,0,0", "nan,1,1",
    "x,y", "2,1", "x", "u", "periodic", "circular", "nu", "tension", "catmull-rom", "quartic",
    "quintic", "arc-length", "parameter", "torsion", "convexity,convexity", "fairest", "growth",
    "reduction", "nussp", "C1", "G1", "optimal", "fritsch-butland", "bending", "uniform", "o.csv",
    "o.json", "o.svg", "o.step", "-", "no/o.csv", "plane.csv", ".", "é.csv", "", "1" * 5000,
    "a\0b", "x" * 5000 + ".csv",
]  # fmt: skip
FILES = {
    "plane.csv": "x,y\n0,0\n1,1\n2,0\n3,1\n3,4\n",
    "space.csv": "u,x,y,z\n0,0,0,0\n1,1,1,0\n2,2,0,1\n4,3,1,3\n",
    "function.csv": "t,$f$\n0,0\n1,0\n2,5\n",
    "large.csv": "0,0\n1e300,1e300\n2e300,0\n",
    "small.csv": "x,y,z\n0,0,0\n1e-300,0,0\n2e-300,0,1e-300\n0,1e-301,3e-300\n",
    "far.csv": "0,1e15\n1e-3,1e15\n2e-3,1e15\n",
}


@given(
    file=st.sampled_from(sorted(FILES)),
    options=st.lists(st.tuples(st.sampled_from(FLAGS), st.sampled_from(VALUES)), max_size=4),
)
@settings(max_examples=scaled(3000))
def test_any_arguments_are_heeded_or_refused_in_one_line(file, options, tmp_path_factory):
    folder = tmp_path_factory.mktemp("arguments")
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    err, before = io.StringIO(), Path.cwd()
    os.chdir(folder)
    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(err):
            status = _cli.main(["fit", file, *(f"{flag}={value}" for flag, value in options)])
    except SystemExit as end:
        status = end.code
    finally:
        os.chdir(before)
    assert status in (0, 1, 2), err.getvalue()
    lines = err.getvalue().splitlines()
    if status == 2:
        assert len(lines) == 1, lines
        assert lines[0].startswith("shapespline")
    # Another table may be what the output is to be.
    outputs = {value for _, value in options} - {file}
    for name in FILES.keys() - outputs:
        text = (folder / name).read_text(encoding="utf-8")
        assert text == FILES[name], "inputs stay as they are"


@pytest.mark.parametrize(
    ("method", "name"),
    [("nu", "$_$"), ("nu", "点"), ("quintic", r"$\frac$"), ("quintic", "x" * 10_000)],
)
def test_names_of_columns_and_files_are_no_mathematics(method, name, run, tmp_path):
    points = write(tmp_path / "a$_$.csv", f"{name},{name}b\n0,0\n1,1\n2,3\n")
    status, _, errors = run("fit", points, "--method", method, "--plot", tmp_path / "f.svg")
    assert (status, errors) == (0, "")


@pytest.mark.parametrize("samples", [10**7 + 1, 10**17, -5, 0])
def test_numbers_of_samples(samples, run, tmp_path):
    status, _, errors = run(
        "fit", write(tmp_path / "p.csv", "0,0\n1,1\n"), f"--samples={samples}", "-o", "-"
    )
    assert status == 2
    assert "--samples must be at least 2 and at most 10,000,000, got" in errors


def test_few_samples_are_said(run, tmp_path, monkeypatch):
    points = write(tmp_path / "p.csv", "".join(f"{i},{i % 3}\n" for i in range(50)))
    out = tmp_path / "o.csv"
    assert run("fit", points, "-o", out)[2] == ""
    assert run("fit", points, "-o", out, "--samples", "50")[2] == ""
    status, _, errors = run("fit", points, "-o", out, "--samples", "49")
    assert (status, errors) == (0, "shapespline: 49 samples are fewer than the 50 points\n")
    monkeypatch.setattr("shapespline._cli.fit.MOST_UNASKED", 100)
    status, _, errors = run("fit", points, "-o", out)
    assert (status, errors) == (
        0, "shapespline: 100 samples, not 20 per segment, for 50 points; see --samples\n"
    )  # fmt: skip
    assert len(out.read_text().splitlines()) == 101


def test_blocks_and_times_are_said(run, tmp_path):
    path = write(tmp_path / "p.csv", "x,y\n\n0,0\n1,1\n\n\n2,0\n# no block\n3,1\n\n4,0\n\n")
    status, _, errors = run("fit", path)
    what = "line 6: empty lines between points are ignored: 3 blocks of points are taken as one"
    assert (status, errors) == (0, f"shapespline: {path}, {what}\n")
    text = "time,x,y\n2020-01-01T00:00:00Z,0,0\n2020-01-01T00:00:01Z,1,1\n2020,2,0\n"
    path = write(tmp_path / "p.csv", text)
    status, _, errors = run("fit", path)
    what = "column time holds '2020-01-01T00:00:00Z', no number: it is not used as parameters"
    assert (status, errors) == (0, f"shapespline: {path}, {what}\n")
    status, _, errors = run("fit", write(tmp_path / "p.csv", "time,x,y\n0,0,0\n1,1,1\n1,2,0\n"))
    assert status == 2
    assert "line 4: parameters must be strictly increasing" in errors
    assert "--parameters chordal leaves that column out" in errors
    assert run("fit", path, "--parameters", "chordal")[0] == 0


OUTPUTS = ["-o {}.csv", "-o {}.json", "-o {}.svg", "-o {}.step", "--report {}.csv", "--plot {}.svg"]


@pytest.mark.parametrize("how", ["same", "link", "dots"])
@pytest.mark.parametrize("output", OUTPUTS)
def test_nothing_is_written_over_the_input(output, how, run, tmp_path):
    option, name = output.format("p").split()
    text = "0,0\n1,1\n2,0\n"
    points = write(tmp_path / name, text)
    target = points
    if how == "link":
        target = tmp_path / f"other{points.suffix}"
        target.hardlink_to(points)
    elif how == "dots":
        (tmp_path / "sub").mkdir()
        target = tmp_path / "sub" / ".." / name
    status, _, errors = run("fit", points, option, target)
    assert (status, errors.count("\n")) == (2, 1)
    assert "is read by this command and must not be overwritten" in errors
    assert points.read_text(encoding="utf-8") == text


def test_nothing_is_written_twice_or_over_what_is_checked(run, tmp_path):
    points, out = write(tmp_path / "p.csv", "0,0\n1,1\n2,0\n"), tmp_path / "o.json"
    assert run("fit", points, "-o", out, "--report", out)[0] == 2
    assert run("fit", points, "-o", "-", "-o", "-")[0] == 2
    assert not out.exists()
    assert run("fit", points, "-o", out)[0] == 0
    curve = out.read_text(encoding="utf-8")
    for target in (points, out):
        status, _, errors = run("check", points, out, "--report", target)
        assert status == 2
        assert "must not be overwritten" in errors
    assert out.read_text(encoding="utf-8") == curve


def test_standard_input(tmp_path):
    def command(*arguments, text):
        return subprocess.run(
            [sys.executable, "-m", "shapespline", *map(str, arguments)],
            input=text, capture_output=True, check=False, timeout=60,
        )  # fmt: skip

    curve, figure = tmp_path / "c.json", tmp_path / "f.png"
    points = write(tmp_path / "p.csv", "x,y\n0,0\n1,1\n2,0\n3,1\n")
    outputs = ["-o", curve, "-o", "-", "--plot", figure]
    done = command("fit", "-", *outputs, text=points.read_bytes())
    assert done.returncode == 0, done.stderr
    assert done.stdout == command("fit", points, "-o", "-", text=b"").stdout
    assert figure.stat().st_size > 1000
    for arguments, text in (
        (["-", curve], points.read_bytes()),
        ([points, "-"], curve.read_bytes()),
    ):
        assert command("check", *arguments, text=text).returncode == 0
    done = command("check", "-", "-", text=b"")
    assert (done.returncode, done.stderr.count(b"\n")) == (2, 1)
    done = command("fit", "-", text=b"0,0\n1,x\n")
    assert done.returncode == 2
    assert done.stderr == b"shapespline: standard input, line 2: 'x' in column 2 is not a number\n"


def test_check_takes_columns(run, tmp_path):
    points, curve = write(tmp_path / "p.csv", "a,b,c\n9,0,0\n9,1,1\n9,2,0\n"), tmp_path / "c.json"
    assert run("fit", points, "--columns", "b,c", "-o", curve)[0] == 0
    assert run("check", points, curve, "--columns", "2,3")[0] == 0


def test_names_with_separators_are_written_so_that_they_are_read(run, tmp_path):
    points = write(tmp_path / "p.csv", '"x [mm, east]";"y [""up""]"\n0;0\n1;1\n2;0\n')
    out = tmp_path / "o.csv"
    assert run("fit", points, "-o", out)[0] == 0
    assert tables.read_points(out).names == ["x [mm, east]", 'y ["up"]']


@pytest.mark.parametrize(
    ("unit", "known"),
    [("mm", True), ("µm", True), ("um", True), ("in", False), ("px", False), ("m", True)],
)
def test_a_step_file_has_the_unit_of_the_points_or_none_is_written(unit, known, run, tmp_path):
    points = write(tmp_path / "p.csv", f"x [{unit}],y [{unit}]\n0,0\n1,1\n2,0\n")
    out = tmp_path / "o.step"
    status, _, errors = run("fit", points, "-o", out)
    assert status == (0 if known else 2)
    assert out.exists() == known
    assert known or "unit must be one of" in errors


# Curves

CURVE = {"breaks": [0, 1], "control": [[[0, 0], [1, 1]]]}


@pytest.mark.parametrize(
    ("entries", "what"),
    [
        ({"format": "other"}, "'format' must be 'shapespline-curve', got 'other'"),
        ({"format": 3}, "'format' must be"),
        ({"version": 99}, "'version' must be 1, got 99"),
        ({"version": True}, "'version' must be 1, got True"),
        ({"version": "1"}, "'version' must be 1, got '1'"),
        (
            {"breaks": [False, True, 2], "control": CURVE["control"] * 2},
            "'breaks' must hold numbers",
        ),
        ({"breaks": [0, True]}, "'breaks' must hold numbers only"),
        ({"control": [[[0, 0], [True, 1]]]}, "'control' must hold numbers only"),
        ({"parameters": [False, 1]}, "'parameters' must hold numbers only"),
        ({"weights": [[1, True]]}, "'weights' must hold numbers only"),
        ({"boundary": {"start": [True, 0], "end": [0, 1]}}, "'boundary' must hold numbers only"),
        ({"breaks": [0, 10**400]}, "breaks[1] must be finite, got inf"),
    ],
)
def test_curves_that_only_look_right_are_refused(entries, what, run, tmp_path):
    points = write(tmp_path / "p.csv", "0,0\n1,1\n")
    path = write(tmp_path / "c.json", json.dumps(CURVE))
    assert run("check", points, path)[0] == 0
    status, _, errors = run("check", points, write(path, json.dumps(CURVE | entries)))
    assert (status, errors.count("\n")) == (2, 1)
    assert what in errors
    assert errors.startswith(f"shapespline: {path}, line 1: ")


def test_an_entry_given_twice_is_refused(run, tmp_path):
    points = write(tmp_path / "p.csv", "0,0\n1,1\n")
    text = '{"breaks": [0, 1], "control": [[[0, 0], [9, 9]]], "control": [[[0, 0], [1, 1]]]}'
    status, _, errors = run("check", points, write(tmp_path / "c.json", text))
    assert status == 2
    assert "holds two entries 'control'" in errors


# Faults of the program


def test_a_fault_of_the_program_does_not_say_that_the_shape_is_lost(monkeypatch, tmp_path, capsys):
    def fail(*_):
        raise RuntimeError("no such thing")

    monkeypatch.setattr("shapespline._cli.fit._fit_curve", fail)
    status = _cli.main(["fit", str(write(tmp_path / "p.csv", "0,0\n1,1\n"))])
    assert status == 70
    assert "RuntimeError: no such thing" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("argument", "index", "expected"),
    [
        ("points", 1, "p.csv, line 3: no words"),
        ("points", None, "p.csv: no words"),
        ("parameters", 0, "p.csv, line 2: no words; --parameters chordal leaves that column out"),
        ("step", None, "no words"),
    ],
)
def test_no_text_of_an_error_is_parsed(argument, index, expected):
    """The attributes of `InputError` say what is refused, and where."""
    ones = np.ones(2)
    data = tables.Points(Path("p.csv"), np.ones((2, 2)), ones, [2, 3], ["x", "y"])
    found = fit.located(data, ss.InputError("no words", argument, index))
    assert str(found) == expected
