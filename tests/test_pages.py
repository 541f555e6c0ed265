# SPDX-License-Identifier: MIT OR Apache-2.0

"""The README and the documentation: every example runs as it stands, in the order of its page."""

import doctest
import re
import shlex
import shutil
from pathlib import Path

import pytest

import polygons
from shapespline import cli

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
            status = cli.main(arguments)
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
