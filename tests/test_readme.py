"""The README's Python examples run as they stand, in the order of the page."""

import re
from pathlib import Path

import pytest

README = Path(__file__).parent.parent / "README.md"
FENCE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_examples(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)  # an example may write a file
    text = README.read_text(encoding="utf-8")
    blocks = list(FENCE.finditer(text))
    assert blocks, "the README has no Python example"
    names: dict[str, object] = {"__name__": "readme"}
    for block in blocks:
        # Line numbers of the page, so that a traceback points at the README.
        line = text.count("\n", 0, block.start(1))
        exec(compile("\n" * line + block.group(1), str(README), "exec"), names)


def test_links_and_pictures_exist():
    text = README.read_text(encoding="utf-8")
    targets = re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text)
    assert targets, "the README links to nothing"
    assert [target for target in targets if not (README.parent / target).exists()] == []
