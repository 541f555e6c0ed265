# SPDX-License-Identifier: MIT OR Apache-2.0

"""The command line, as a user types it."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

COMMAND = Path(sys.executable).with_name("shapespline")
SETS = ("GM feature line", "helix", "hiking track", "protein backbone")


def run(*arguments, **options):
    return subprocess.run(
        [COMMAND, *arguments], capture_output=True, text=True, timeout=120, check=False, **options
    )


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """Run the demo once, in an empty directory, without a display."""
    here = tmp_path_factory.mktemp("demo")
    return run("demo", "--out", "figures", cwd=here), here / "figures"


def test_demo_succeeds(demo):
    done, _ = demo
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert "Warning" not in done.stderr


@pytest.mark.parametrize("name", SETS)
def test_demo_prints_each_set(demo, name):
    assert name.lower() in demo[0].stdout.lower()


@pytest.mark.parametrize("family", ["FairSpline", "NuSpline", "TensionSpline", "CatmullRom"])
def test_demo_compares_the_families(demo, family):
    lines = demo[0].stdout.splitlines()
    header = next(line for line in lines if "CatmullRom" in line)
    assert family in header
    table = lines[lines.index(header) + 1 :]
    assert len(table) == len(SETS)
    assert all(line.count(" 0, κ ") == 4 for line in table)


def test_demo_draws_pictures_that_show_something(demo):
    from matplotlib import image

    pictures = sorted(demo[1].glob("*.png"))
    assert len(pictures) >= len(SETS)
    for picture in pictures:
        pixels = image.imread(picture)
        assert min(pixels.shape[:2]) >= 300, picture.name
        assert np.std(pixels) > 0.01, picture.name


def test_demo_writes_only_where_it_is_told(demo):
    assert [path.name for path in demo[1].parent.iterdir()] == ["figures"]


def test_help_names_the_commands():
    done = run("--help")
    assert done.returncode == 0
    assert "demo" in done.stdout


@pytest.mark.parametrize("arguments", [["no-such-command"], ["demo", "--no-such-option"]])
def test_a_wrong_command_is_bad_input(arguments):
    done = run(*arguments)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_a_place_that_cannot_be_written_is_bad_input(tmp_path):
    """One line that names the place; exit status 2 as for all bad input."""
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    done = run("demo", "--out", str(tmp_path / "file" / "figures"))
    assert done.returncode == 2
    assert str(tmp_path / "file") in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
