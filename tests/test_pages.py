# SPDX-License-Identifier: MIT OR Apache-2.0

"""The README and the documentation: every example runs as it stands, in the order of its page."""

import doctest
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import polygons
import shapespline as ss
from shapespline import _cli

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / "python" / "docs").glob("*.md"))]
#: plain fences and the cells that the site executes
PYTHON = re.compile(r"^```(?:python|\{code-cell\} python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CONSOLE = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def name(page):
    return page.stem


@pytest.mark.parametrize(
    "page", [p for p in PAGES if PYTHON.search(p.read_text("utf-8"))], ids=name
)
def test_examples(page, tmp_path, monkeypatch):
    plt = pytest.importorskip("matplotlib.pyplot")
    plt.switch_backend("Agg")
    monkeypatch.chdir(tmp_path)  # an example may write a file
    text = page.read_text(encoding="utf-8")
    names: dict[str, object] = {"__name__": page.stem}
    for block in PYTHON.finditer(text):
        # Line numbers of the page, so that a traceback points at it.
        line = text.count("\n", 0, block.start(1))
        exec(compile("\n" * line + block.group(1), str(page), "exec"), names)
    plt.close("all")


@pytest.mark.parametrize(
    "page", [p for p in PAGES if CONSOLE.search(p.read_text("utf-8"))], ids=name
)
def test_commands(page, tmp_path, monkeypatch, capsys):
    """Commands print what the page says; ... stands for anything."""
    monkeypatch.chdir(tmp_path)
    for file in polygons.DATA.glob("*.csv"):
        shutil.copy(file, tmp_path)
    for block in CONSOLE.finditer(page.read_text(encoding="utf-8")):
        for part in re.split(r"^\$ ", block.group(1), flags=re.MULTILINE)[1:]:
            command, _, expected = part.partition("\n")
            program, *arguments = shlex.split(command)
            assert program == "shapespline"
            status = _cli.main(arguments)
            found = capsys.readouterr()
            assert found.err == ""
            assert status == ("shape violated" in found.out)
            flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
            same = doctest.OutputChecker().check_output(expected, found.out, flags)
            assert same, f"{command}\nprinted\n{found.out}\nexpected\n{expected}"


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_and_pictures_exist(page):
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text)
    targets += re.findall(r"^:::+\{figure\} (\S+)$", text, re.MULTILINE)
    drawn = "images/gallery/"  # by python/docs/scripts/gallery.py, when the site is built
    missing = [t for t in targets if not t.startswith(drawn) and not (page.parent / t).exists()]
    assert missing == []


def test_every_page_is_in_the_table_of_contents():
    index = (ROOT / "python" / "docs" / "index.md").read_text(encoding="utf-8")
    listed = {line.strip() for line in index.splitlines()}
    pages = {page.stem for page in PAGES} - {"README", "index", "performance-table"}
    assert pages <= listed
    notebooks = {f"../examples/{p.stem}" for p in (ROOT / "python" / "examples").glob("*.ipynb")}
    assert notebooks <= listed
    for entry in listed:
        if re.fullmatch(r"\.\./examples/\w+", entry):
            assert entry in notebooks


def test_the_gallery_shows_every_figure_that_is_drawn(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "python" / "docs" / "scripts"))
    import gallery

    drawn = {path.name for path in gallery.draw_all(tmp_path)}
    page = (ROOT / "python" / "docs" / "gallery.md").read_text(encoding="utf-8")
    assert drawn == set(re.findall(r"images/gallery/(\S+\.png)", page))


def test_the_picture_of_functions_shows_what_the_readme_says(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "python" / "docs" / "scripts"))
    import functions_picture

    functions_picture.draw(tmp_path / "functions.png")
    assert (tmp_path / "functions.png").stat().st_size > 20_000
    x, y = polygons.load("rpn14").values()
    u = np.linspace(x[0], x[-1], 100_001)
    cubic = CubicSpline(x, y, bc_type="natural")
    assert cubic(u).max() - y.max() == pytest.approx(0.1 * np.ptp(y), rel=0.05)  # "by a tenth"
    assert np.mean(cubic(u, 1) < 0) == pytest.approx(2 / 5, rel=0.1)  # "two fifths"
    assert ss.fit_monotone(x, y)(u, 1).min() >= 0
